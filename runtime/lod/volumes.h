// Where a view shows its volumetric flames on the screen, and how the passes draw each. tiers.h
// chooses between a march and an impostor.
#pragma once
#include "shared/appearance.h"
#include "shared/volume_draw.h"

#include <array>
#include <cstdint>
#include <span>

namespace fw::gpu {
struct FlameNode;  // shared/volume.h
struct FlameRecord;
}  // namespace fw::gpu

namespace fw::lod {

using namespace gpu;  // what shaders share

struct VolumeItem {  // a volumetric flame that a view may show
    uint32_t flame = 0;
    VolumeDraw draw{};
    vec4 whole{};  // VolumeDraw::rect as if the view had no edge; empty: it is around the camera
    vec3 middle{}, base{};    // m, world: of its bounds; where it stands
    vec3 tip{};               // m, from there to where its mean height ends
    float near = 0, far = 0;  // m along the view: of all that it shows, smoke too
    bool smokes = false;
    uint32_t body1 = 0;        // number + 1 of a burning object's body of fire; 0: a flame
    bool highQuality = false;  // FW_FIRE_TIER_MARCH_HIGH was requested for
    vec4 burns{};  // as VolumeDraw::rect, of the flame without its smoke; empty: that is not seen
};
// Whether some of a sphere is between the planes of the view's four sides. `middle`: m, from the
// camera.
bool sphereInView(const ViewParams& view, vec3 middle, float radius) noexcept;
// Where the view shows it, in so many slabs; false: nowhere.
bool volumeDraw(const ViewParams& view, const vec4& low, const vec4& high, uint32_t slabs,
                VolumeDraw& out, vec4* whole = nullptr);
// The plane through its base: dot(xyz, x) + w is m on the flame's side. Lower where it leans below
// its base: nothing that it shows is beyond.
vec4 volumeBasePlane(const FlameRecord& record, const FlameNode* nodes, uint32_t count);
// VolumeDraw::base of such a plane, of a draw that volumeDraw made: that has none.
void volumeBase(const ViewParams& view, const vec4& plane, VolumeDraw& out) noexcept;
// VolumeDraw::clip, which turns depth into distance.
vec4 volumeClip(const ViewParams& view) noexcept;
// Divides samples among flames that are marched as they are drawn.
void chooseVolumes(std::span<VolumeItem> items);
// VolumeDraw::intervals for a curve.
uint32_t volumeIntervals(const FlameNode* nodes, uint32_t count);
// Of the flame without its smoke.
void volumeBounds(const FlameRecord& record, const FlameNode* nodes, uint32_t count, vec4& low,
                  vec4& high);
// Slabs are for the flame: smoke before and behind it is in the outermost. Bounds of the flame
// alone.
void volumeSlabs(const ViewParams& view, const vec4& low, const vec4& high, VolumeDraw& out);

struct MarchedVolume {  // one whose rays are marched before the drawing, and how it is shown
    uint32_t flame = 0;
    bool smokes = false;  // marched by volume_smoke
    bool window = false;  // finer cells where it burns, of the one before it
    bool body = false;    // a burning object's, marched by the passes of bodies
    MarchPush march{};
    CompositePush composite{};
};
// Of VolumeWork per flame: it, its impostor, where it burns, its atlas's frame.
constexpr uint32_t kVolumeWorks = 4;
struct VolumeScreen {     // on which a marched view is shown
    vec2 size{};          // px
    uint32_t slabs = 1;   // of a flame
    uint32_t cell = 2;    // px, at least
    uint32_t steps = 64;  // of a ray, at most
    uint32_t encoding = 0;
    bool operator==(const VolumeScreen&) const = default;
};
// Words of FW_BIND_VOLUME_RAYS that a screen is worth: flames over all of it and half as much
// again.
uint32_t volumeRayWords(const VolumeScreen& screen);
// px, across a flame.
float volumeWide(const VolumeDraw& draw, const VolumeScreen& screen) noexcept;
// Rays and samples of a flame that is marched as it is drawn: as many as if it were before.
void volumeRays(const VolumeScreen& screen, VolumeDraw& draw) noexcept;
// Allocates march pixels for all `items`, in their order, behind the first `first` words. They are
// as fine as `words` allow; flames of most tiles get larger ones first. `perPixel`: m per pixel at
// a depth of 1. If memory is short, smoke yields to fire: a flame that smokes gets large march
// pixels, and behind it in `out` fine ones where it burns. So `out` has capacity for twice as many.
struct VolumeAllocation {
    uint32_t end = 0;    // of the words that are known of tiles; 0: they do not fit
    uint32_t count = 0;  // of `out`
};
VolumeAllocation allocateVolumes(std::span<const VolumeItem> items, const VolumeScreen& screen,
                                 float perPixel, uint32_t words, std::span<MarchedVolume> out,
                                 uint32_t first = 0);

struct ImpostorShape {  // the content of an impostor's words
    bool there = false;
    uint32_t key = 0;    // whose
    uint64_t frame = 0;  // that marched it
    vec3 middle{};       // m, from where the flame stands
    vec3 direction{};    // unit, from the camera
    vec2 low{};          // m across the view, from the middle: of its first cell
    float cell = 0;      // m
    uint32_t tilesX = 0, tilesY = 0, encoding = 0;
};
// A flame's billboard impostor fades, pixel by pixel, from one march to the next.
struct ImpostorPair {
    std::array<ImpostorShape, 2> shapes;
    uint32_t newest = 0;  // of them
    uint32_t over = 1;    // frames from when it was marched until it shows alone
};
bool impostorFits(const VolumeItem& item) noexcept;
// How the impostor in `slot`, a half of a pair, is marched, from where it is seen now.
void placeImpostor(const ViewParams& view, const VolumeItem& item, const VolumeScreen& screen,
                   uint32_t slot, ImpostorShape& impostor, MarchedVolume& out) noexcept;
// False: it is behind the camera.
bool showImpostor(const ViewParams& view, const VolumeItem& item, const VolumeScreen& screen,
                  uint32_t slot, const ImpostorShape& impostor, VolumeImpostor& out) noexcept;

struct HazedVolume {  // one whose heat distorts the picture behind it
    uint32_t flame = 0;
    float away = 0;  // m along the view
    HazePush draw{};
};
// Of the column of hot gas in and above a flame.
void volumeHazeBounds(const FlameRecord& record, const FlameNode* nodes, uint32_t count, vec4& low,
                      vec4& high);
// False: the view shows none of it.
bool makeHazePush(const ViewParams& view, const vec4& low, const vec4& high, float strength,
                  HazePush& out) noexcept;

}  // namespace fw::lod
