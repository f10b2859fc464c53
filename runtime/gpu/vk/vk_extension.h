// The part of an extension that works on a world of the Vulkan backend.
#pragma once
#include "gpu/vk/backend_state.h"

namespace fw::gpu::vk {

struct VkMethods {
    // Allocates and uploads what a new object needs beyond the library's own; may throw. Ranges in
    // `fresh` are released with it.
    void (*createObject)(BackendState& s, ObjectEntry& fresh, const ObjectInit& init,
                         uint64_t last);
    // Groups of Extension::stepPass for an object with kObjectExtended.
    uint32_t (*stepGroups)(const BurnObject& object) noexcept;
    // Forgets an object with RefineUse::extendedPlus1, a mesh.
    void (*destroyObject)(BackendState& s, ObjectEntry& object) noexcept;
    void (*destroyMesh)(BackendState& s, uint32_t mesh) noexcept;
    // Refinement: see Backend. A refined object has RefineUse::extendedPlus1.
    mesh::RefineOptions (*refineOptions)(uint32_t depth);
    void (*createRefinement)(BackendState& s, uint32_t mesh, uint32_t depth,
                             const mesh::BurnDomain& domain, const mesh::RefineModel& model);
    void (*startBoundary)(BackendState& s, ObjectEntry& object, const float point[3],
                          uint32_t tick) noexcept;
    // The bytes that the frame may upload for refined objects; may throw. Then records them.
    uint64_t (*planRefinement)(BackendState& s);
    void (*recordRefinement)(BackendState& s, FrameInFlight& slot);
    uint32_t (*refinedCount)(const BackendState& s, const ObjectEntry& object) noexcept;
};

}  // namespace fw::gpu::vk
