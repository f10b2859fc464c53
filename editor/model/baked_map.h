// Burn maps that are baked once and kept in a folder, by a hash of all that the bake reads.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "flamewright/flamewright.h"

namespace fwmodel {

// Meshes with the same key have the same burn map. Indices are of 4 bytes.
std::string bakeKeyOf(const FwMeshDef& def);
// `folder` empty, or nothing there that can be read: false.
bool readBake(const std::filesystem::path& folder, const std::string& key,
              std::vector<char>& bytes);
// False: `error` is the plugin's message.
bool cookMesh(FwContext* context, const FwMeshDef& def, std::vector<char>& bytes,
              std::string& error);
// False: it cannot be written, or `folder` is empty. The file is whole or not there.
bool keepBake(const std::filesystem::path& folder, const std::string& key,
              const std::vector<char>& bytes);
void dropBake(const std::filesystem::path& folder, const std::string& key);
// Of bytes that readBake or cookMesh gave; points to them.
FwMeshDef cookedDefOf(const std::vector<char>& bytes);

}  // namespace fwmodel
