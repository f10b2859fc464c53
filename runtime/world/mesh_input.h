// A public mesh def to a burn domain: widens what the host gives, then bakes or reads cooked bytes.
#pragma once
#include "core/owned.h"
#include "flamewright/flamewright.h"
#include "mesh/burn_domain.h"

#include <cstddef>

namespace fw::world {

core::Owned<mesh::BurnDomain> makeDomain(const FwMeshDef& def, std::pmr::memory_resource* memory);

// The cooked bytes of a def, and the key of its inputs (equal key, equal bytes).
uint64_t cookKey(const FwMeshDef& def, std::pmr::memory_resource* memory);
std::pmr::vector<std::byte> cook(const FwMeshDef& def, std::pmr::memory_resource* memory);

}  // namespace fw::world
