// Vertices that move: objects that deform, and vertices that the host moves.
#pragma once
#include "flamewright/flamewright_vulkan.h"
#include "gpu/vk/frame.h"
#include "gpu/vk/world_buffers.h"
#include "shared/deform.h"

namespace fw::gpu::vk {

struct BackendState;
struct FrameNeeds;
struct ObjectEntry;

struct DeformUse {      // an object's deformation
    BufferRange range;  // of DeformObjects
    bool recordDirty = false, reset = false;
    bool now = false;         // it deforms in this frame
    bool woke = false;        // it did not move in the frame before
    bool softOdd = false;     // its places are the second ones
    uint32_t recedeTurn = 0;  // groups of a sheet that next take over burnt texels
    uint32_t ticks = 0;       // that something moves after the last texel caught
    uint64_t softUntil = 0;   // tick until which it is not yet at rest
    uint32_t skinPlus1 = 0;   // of a skinned object: its Skin
};

// Vertices that a host moves, as they go to the device with the next frame.
struct Skin {
    std::pmr::vector<ShownVertex> shown;  // by drawn vertex, in the device's order; empty: free
    std::pmr::vector<uint32_t> sources;   // the host's vertex of each
    bool dirty = false, normals = false;  // normals: the host's; else they follow the triangles
    // In place of `shown`: a buffer of the host's, which the next frame copies.
    FwVulkanVertices given{};
    float metersPerUnit = 1;  // of its positions
    bool givenDue = false;
    BufferRange words;  // where it is copied to
    explicit Skin(std::pmr::memory_resource* memory) : shown(memory), sources(memory) {}
    void free() noexcept {
        shown.clear();
        dirty = givenDue = false;
        words = {};
    }
};

struct DeformRenderer {
    explicit DeformRenderer(std::pmr::memory_resource* pmr) : skins(pmr) {}
    // Particles with a solver step at a rate of their own, up to `ticks` (with a fraction).
    void advance(double ticks) noexcept;
    // Adds the needs of object `slot` to deform or to be skinned in this frame; marks if it does.
    void addNeeds(BackendState& s, uint32_t slot, uint64_t endTick, FrameNeeds& needs) const;
    // Vertices as hosts have moved them.
    void recordSkins(BackendState& s, FrameRecorder& recorder);
    // Everything that deforms in this frame.
    void record(BackendState& s, const FrameNeeds& needs, FrameRecorder& recorder);
    // The skin of an object that has one.
    [[nodiscard]] Skin& skinOf(const ObjectEntry& object) noexcept;

    std::pmr::vector<Skin> skins;
    uint64_t softStep = 0;   // number of the step that particles with a solver have come to
    uint32_t softSteps = 0;  // that they take in the frame
    uint32_t bendSet = 0;    // which bending constraints the next one takes

 private:
    Staged stageGroups(BackendState& s, FrameRecorder& recorder) const;
};

}  // namespace fw::gpu::vk
