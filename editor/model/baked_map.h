// A disk cache of burn maps, keyed by a hash of the bake's input.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "flamewright/flamewright.h"

namespace fwmodel {

// Meshes with equal keys have equal burn maps. Indices have 4 bytes.
std::string bakeKeyOf(const FwMeshDef& def);
// Returns false if `folder` is empty or has no readable entry.
bool readBake(const std::filesystem::path& folder, const std::string& key,
              std::vector<char>& bytes);
// On failure returns false with the plugin's message in `error`.
bool cookMesh(FwContext* context, const FwMeshDef& def, std::vector<char>& bytes,
              std::string& error);
// Writes atomically. Returns false if writing fails or `folder` is empty.
bool keepBake(const std::filesystem::path& folder, const std::string& key,
              const std::vector<char>& bytes);
void dropBake(const std::filesystem::path& folder, const std::string& key);
// Points to bytes from readBake or cookMesh.
FwMeshDef cookedDefOf(const std::vector<char>& bytes);

}  // namespace fwmodel
