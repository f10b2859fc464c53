// Links between the parts of one mesh, read from BurnDomain::partLinks: see linkParts.
#pragma once
#include "mesh/burn_domain.h"
#include "shared/burn.h"

#include <span>

namespace fw::mesh {

struct PartLink {
    uint32_t lane = 0;          // lane of `from` in its tile
    uint32_t from = 0, to = 0;  // texels
};
// `link`: the word of block `block` of the tile, not kNone.
[[nodiscard]] PartLink readPartLink(const BurnDomain& domain, uint32_t tile, uint32_t block,
                                    uint32_t link) noexcept;

struct PartPath {  // fire's path over a link
    const gpu::BurnMaterial *left = nullptr, *reached = nullptr;
    uint32_t delay = gpu::kNever;  // ticks; kNever: the material reached does not burn
};
// `materials`: the object's, kMaterialsPerObject of them.
[[nodiscard]] PartPath partPath(const BurnDomain& domain,
                                std::span<const gpu::BurnMaterial> materials,
                                const PartLink& link) noexcept;

}  // namespace fw::mesh
