// Links of the mass-spring model from each particle straight on over its neighbours: the ends of
// flexion springs. No other deformation needs them.
#pragma once
#include "mesh/deform/model.h"
#include "reference/springs.h"

#include <memory_resource>
#include <span>
#include <vector>

namespace fw::reference {

struct FarLinks {  // of a particle, over its neighbours: kNone is none, a length of 0 no spring
    uint32_t vertex[gpu::kDeformRing];
    float length[gpu::kDeformRing]{};
};
std::pmr::vector<FarLinks> makeFarLinks(const mesh::BurnDomain& domain,
                                        const mesh::DeformModel& model,
                                        std::pmr::memory_resource* memory);
// In the device's order: pass 0 of all particles, then pass 1.
void packFarLinks(const mesh::DeformModel& model, std::span<const FarLinks> links,
                  std::span<gpu::DeviceLinks> out) noexcept;

}  // namespace fw::reference
