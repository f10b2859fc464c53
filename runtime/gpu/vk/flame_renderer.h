// Volumetric flames: their boxes, the march of each view, and the order in which a view draws them.
#pragma once
#include "gpu/vk/frame.h"
#include "gpu/vk/outside_views.h"
#include "gpu/vk/pipelines.h"

namespace fw::gpu::vk {

struct BackendState;

struct VolumeBox {  // as in FlameRecord
    vec4 low{}, high{};
    vec4 flameLow{}, flameHigh{};  // without its smoke
    uint32_t intervals = 1;        // see VolumeDraw
    vec3 base{};                   // where it stands
    uint32_t key = 0, tier = 0;
    bool smokes = false;
    uint32_t body1 = 0;          // its number + 1, of a burning object's; 0: a flame
    vec4 hazeLow{}, hazeHigh{};  // of its column of hot gas
    AtlasKind kind;
    vec3 tip{};        // as VolumeItem's
    vec4 basePlane{};  // as volumeBasePlane has it
};

struct FlameRenderer {
    explicit FlameRenderer(std::pmr::memory_resource* pmr) : volumes(pmr) {}
    // The flames of the frame, as they are drawn until the next ones come.
    void record(const VolumeUpdate& update, FrameRecorder& recorder);
    // Before the first command: space for the march of a view; less space makes it coarser.
    void makeMarchRoom(BackendState& s, OutsideView& of, uint32_t flameCount, uint64_t last) const;
    // For the view that was last pushed, which is `of`'s.
    [[nodiscard]] MarchRecord march(const BackendState& s, OutsideView& of) const noexcept;
    // The flames that the view that was last pushed shows, farthest first; returns their number.
    uint32_t order(const BackendState& s, uint32_t slabs,
                   std::array<VolumeItem, kMaxVolumeFlames>& out) const noexcept;
    // The hot gas that distorts the view that was last pushed, farthest first; returns their
    // number. `march`: the march that shows the flames, or null.
    uint32_t orderHazes(const BackendState& s, const March* march, float strength,
                        std::array<HazedVolume, kMaxVolumeFlames>& out) const noexcept;
    // The screen of a march for a target of `size` px.
    [[nodiscard]] VolumeScreen screenOf(const BackendState& s, const TargetKey& target,
                                        vec2 size) const noexcept;
    // Bytes of device memory that follow a plan's Detail::memory.
    [[nodiscard]] uint64_t detailBytes(const BackendState& s) const noexcept;

    std::pmr::vector<VolumeBox> volumes;  // that draws show
    uint32_t bodyCount = 0;               // of those, the last
    bool bodiesShow = false;              // in the view that is recorded
    uint64_t quadsUntil = 0;  // ring frame: a view was drawn without its march, and may be again
    uint32_t volumeStepsNow = Detail{}.rayStepCount;  // on its way to detail's
};

}  // namespace fw::gpu::vk
