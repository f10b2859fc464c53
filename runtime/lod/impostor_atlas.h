// Shared impostors: among volumetric flames that are alike, one is marched as an impostor in each
// frame. Its last frames are an atlas, which the others show: each some frames late, scaled to its
// own width and height, and leaning as it does. The pass volume_impostor draws them.
#pragma once
#include "lod/volumes.h"

#include <array>
#include <cstdint>
#include <span>

namespace fw::lod {

constexpr uint32_t kMaxImpostorAtlases = 4;
constexpr uint32_t kAtlasFrames = 32;
constexpr uint32_t kAtlasFrameStep = 8;  // frames from one flame's frames to another's
constexpr uint32_t kImpostorAtlasWords = kAtlasFrames * kImpostorWords;
constexpr uint32_t kNoAtlas = ~0u;

// The properties that make flames alike, whatever their size, seed and place.
struct AtlasKind {
    uint32_t appearance = 0;  // hash of all that is the same for any size
    float wide = 0;           // m, diameter
    float tall = 0;           // diameters, mean height
    float facing = 0;         // cosine between its axis and the direction from the camera
    bool plain = false;       // no collider bends it, it burns whole, its line is nearly straight
};
// `tip`: m, from its base to where its mean height ends; `facing` is the view's.
AtlasKind atlasKind(const FlameRecord& record, const FlameNode* nodes, uint32_t count, vec3& tip);

struct AtlasItem {  // a flame that a view shows
    AtlasKind kind;
    uint32_t key = 0;
    float covers = 0;    // of the view, any unit
    bool wants = false;  // an atlas, if there is one
    bool fits = false;   // an impostor, see impostorFits
};

struct AtlasFrame {
    ImpostorShape impostor;
    vec3 middle{};  // m across the view, and along it, from where the flame stands to its middle
    vec2 tip{};     // m across the view, from where it stands
    float wide = 0;
    uint32_t run = 0;  // a number for all frames of one flame, one after the other
};

struct ImpostorAtlas {
    bool used = false;
    AtlasKind kind;        // its flame's
    uint32_t key = 0;      // its flame
    uint32_t run = 0;      // of the next frame
    uint32_t shares = 0;   // flames that want it
    uint64_t written = 0;  // frames; the newest is `written - 1`, in its place modulo kAtlasFrames
    std::array<AtlasFrame, kAtlasFrames> frames;
    [[nodiscard]] bool whole() const noexcept { return written >= kAtlasFrames; }
};
using ImpostorAtlases = std::array<ImpostorAtlas, kMaxImpostorAtlases>;

// Chooses which of the first `room` atlases each item may show (kNoAtlas: none), and which flame
// each atlas follows. had[i]: the atlas that the item has shown, or kNoAtlas. An atlas that no item
// wants is freed.
void chooseAtlases(std::span<const AtlasItem> items, std::span<const uint32_t> had, uint32_t room,
                   ImpostorAtlases& atlases, std::span<uint32_t> out) noexcept;

// Where a flame is in its atlas, from frame to frame.
struct AtlasCursor {
    uint32_t key = 0;  // the flame
    uint32_t atlas = kNoAtlas;
    uint64_t at = 0;  // frame
    bool mirrored = false;
    uint64_t before = 0;  // where it was before it turned over
    uint32_t atlasBefore = kNoAtlas;
    bool mirroredBefore = false;
    uint32_t turned = kAtlasFrameStep;  // frames ago
    // Once a frame, after the atlas `number` has its newest frame. The atlas's own flame shows that
    // one; each other flame shows an older one, by its key. A cursor goes on frame by frame, and
    // fades from one flame's frames to another's in kAtlasFrameStep frames.
    void read(uint32_t number, const ImpostorAtlases& atlases) noexcept;
};

// As placeImpostor, into a frame.
void placeAtlasFrame(const ViewParams& view, const VolumeItem& item, const VolumeScreen& screen,
                     uint32_t slot, AtlasFrame& frame, MarchedVolume& out) noexcept;
// As showImpostor; the frame is turned, stretched and widened to what the item is.
bool showAtlasFrame(const ViewParams& view, const VolumeItem& item, const VolumeScreen& screen,
                    uint32_t slot, const AtlasFrame& frame, bool mirrored,
                    VolumeImpostor& out) noexcept;

}  // namespace fw::lod
