// The scenes of the welcome page, made from commands and a crate built here; no file is shipped.
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
// Writes meshes that it needs below `folder`. The document is without a file and counts as saved.
bool makeBuiltIn(int which, const std::filesystem::path& folder, fwedit::Document& document,
                 std::string& error);
// A crate of boards as glTF text, half a metre wide, standing on y = 0.
std::string crateGltf();

}  // namespace fwapp
