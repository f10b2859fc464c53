// The scenes of the welcome page, built from commands and a generated crate. No files are shipped.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "document/document.h"

namespace fwapp {

struct BuiltIn {
    const char *name, *about, *icon;
};
std::span<const BuiltIn> builtIns();
// Writes the required meshes below `folder`. The document has no file and counts as saved.
bool makeBuiltIn(int which, const std::filesystem::path& folder, fwedit::Document& document,
                 std::string& error);
// Returns a crate of boards as glTF text, half a metre wide, standing on y = 0.
std::string crateGltf();

}  // namespace fwapp
