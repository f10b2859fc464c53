// The state of a view of RecordOutside that the backend keeps from frame to frame: how its
// volumetric flames are marched and shown. Each view has its own quads and marches on the device,
// see resourceOf; all share the simulation, lights and meshes.
#pragma once
#include "core/owned.h"
#include "gpu/extension.h"
#include "gpu/vk/descriptors.h"
#include "lod/impostor_atlas.h"
#include "lod/tiers.h"

#include <array>

namespace fw::gpu::vk {

struct BackendState;

// Flames that are marched before they are drawn, on the screen that a draw of the view was last
// seen to have. Views that were not given to RecordOutside, and the first picture, march as they
// draw.
struct March {
    VolumeScreen screen;   // no size: none was seen
    uint64_t frame = 0;    // that saw it: of several screens in a frame the largest counts
    VolumeScreen made;     // of the buffer's content
    VolumeScreen unknown;  // that was last drawn before anything was marched for it
    FwView view{};         // and its view; in the buffer nothing: count is 0
    bool there = false;
    uint32_t count = 0;
    // Cards that are marched behind them.
    std::array<MarchedVolume, kVolumeWorks * kMaxVolumeFlames> items;
    uint32_t impostorCount = 0;
    std::array<VolumeImpostor, 4 * kMaxVolumeFlames>
        impostors;  // a flame may turn from atlas to impostor
    uint32_t callCount = 0;
    std::array<VolumeCall, kMaxVolumeFlames> calls;  // of flames that an extension draws
    VolumeOrder order;                               // of all of them
    TierLives lives;
    std::array<ImpostorPair, kMaxVolumeFlames> pairs;  // by life
    ImpostorAtlases atlases;
    std::array<AtlasCursor, kMaxVolumeFlames> cursors;  // by life
    uint32_t atlasCapacity = 0;                // atlases that space is requested for, behind pairs
    uint32_t atlasIdleFrames = 0;              // frames in which none was wanted
    bool atlasSpare = false;                   // the buffer has space for freed atlases
    uint32_t impostorSlot = 0;                 // of impostors: the first of theirs
    uint32_t atlasEncoding = 0;                // of their frames
    uint32_t slots = 0;                        // pairs that have space, before all else
    uint32_t capacity = 0;                     // of the buffer when they were made
    uint64_t passed = 0;                       // frames
    std::array<float, kMaxVolumeFlames> haze;  // by flame, [0, 1]: how much of it shows
};

struct OutsideView {
    explicit OutsideView(uint32_t of) : number(of) {}
    // A draw in `ringFrame` shows `shown` so.
    void recordScreen(const FwView& shown, const VolumeScreen& screen, uint64_t ringFrame) noexcept;
    // Whether the march is for `shown` on this screen; else flames are marched as they are drawn.
    [[nodiscard]] bool isMarchedFor(const FwView& shown, const VolumeScreen& screen) const noexcept;
    // Rays a side of a pixel, of the view as it is drawn: more where nobody could know its screen,
    // in the first picture and after a resize. A second screen of each frame takes them once.
    uint32_t minRays(const FwView& shown, const VolumeScreen& screen) noexcept;

    uint32_t number;     // of its resources and sets, [0, kMaxViews)
    uint64_t frame = 0;  // ring frame that was last recorded for it; 0: none
    bool given = false;  // the newest frame was recorded for it
    uint32_t place = 0;  // as which of that frame's views
    FwView view{};       // as that frame had it
    float height = 0;    // px, of its last draw; 0: it was never drawn
    March march;
};

// The views of RecordOutside, by number; null: not there. The first is always there.
struct OutsideViews {
    explicit OutsideViews(std::pmr::memory_resource* memory) : memory_(memory) {
        all[0] = core::Owned<OutsideView>::make(memory, 0u);
    }
    // The open frame is recorded for these. May throw.
    void open(BackendState& s, std::span<const FwView> from);
    // Buffers of the open frame's views; `marches`: they march so many flames.
    void makeRoom(BackendState& s, uint32_t flameCount, bool marches, uint64_t last) const;
    // Of the newest frame's views the one that a draw of `view` shows.
    [[nodiscard]] OutsideView& viewFor(const PassSets& sets, const FwView& view) const noexcept;

    std::array<core::Owned<OutsideView>, kMaxViews> all;

 private:
    OutsideView& freeView(std::span<OutsideView* const> taken, uint64_t ringFrame);
    std::pmr::memory_resource* memory_;
};

// Whether the march for one view is right for another.
[[nodiscard]] bool sameView(const FwView& a, const FwView& b) noexcept;

}  // namespace fw::gpu::vk
