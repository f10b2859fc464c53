// How a volumetric flame is drawn: what a draw is told, where a ray's samples lie. What burns there
// is in volume.h, and what a draw reads in volume_flame.h.
// GLSL too, and laid out by hand.
// clang-format off
#ifndef FW_SHARED_VOLUME_DRAW_H
#define FW_SHARED_VOLUME_DRAW_H
#ifdef __cplusplus
#include <cmath>
#endif
#include "shared/types.h"

FW_SHARED_BEGIN
#ifdef __cplusplus
using glm::clamp;
using glm::min;
using std::abs;
using std::floor;
#endif

FW_SHARED_CONST uint kMaxVolumeFlames = 256u;   // of a world, in a frame
FW_SHARED_CONST uint kFirePresets = 9u;         // first layers of the profiles
FW_SHARED_CONST uint kMaxFireProfiles = 23u;    // the host's, behind them
FW_SHARED_CONST uint kProfileBytes = 32768u;    // of a layer: 64 x 128 pairs of halfs
FW_SHARED_CONST uint kVolumeSlabs = 6u;         // of a flame where the host's depth is only tested
FW_SHARED_CONST float kVolumeWhite = 1.5f;      // of soot of luminance 1, in the host's units

FW_SHARED_CONST uint kVolumeFlameBytes = 1792u; // a multiple of 256: each is a uniform block of its own

// Push constants: the part of the view that shows a flame, and its slabs in depth. A ray at x, y of
// the view: perspective: depth * (rayO + x rayX + y rayY); else: rayO + x rayX + y rayY + depth * forward.
struct VolumeDraw {
    vec4 rect;            // low x, low y, high x, high y, [-1, 1] over the viewport
    vec4 rayX;            // m, from the eye
    vec4 rayY;
    vec4 rayO;
    vec4 clip;            // clip z = x * depth + y; clip w = z * depth + w
    float front;          // m along the view, where the nearest slab begins
    float deep;           // m, of a slab
    uint slabs;           // [1, kVolumeSlabs]
    uint mostSteps;       // of a ray
    float spacing;        // m, between samples where mostSteps allows it
    uint intervals;       // [1, kFlameIntervals], of a ray, between knots
    float wide;           // m, the flame's diameter
    uint perPixel;        // rays a side of a pixel; [1, 8]
    vec4 base;            // the plane through its base, see volumeBaseDepth
};
FW_SHARED_SIZE(VolumeDraw, 128)

// ---- where depth is only tested

// clip z / w of so many m along the view, and m along the view of a clip z / w. `clip`: as VolumeDraw's.
FW_SHARED_FN float volumeDepth(vec4 clip, float metres) {
    return (clip.x * metres + clip.y) / (clip.z * metres + clip.w);
}
FW_SHARED_FN float volumeMetres(vec4 clip, float depth) {
    float per = clip.x - depth * clip.z;
    float at = (depth * clip.w - clip.y) / (abs(per) > 1e-12f ? per : 1e-12f);
    return at > 0.0f ? at : 1e9f;  // at the far end of an infinite view
}

// A flame stands on the plane through its base, and often on ground that lies there. clip z / w of that plane at x, y
// of the view is linear there: base.x + base.y * x + base.z * y. base.w is 1 where the eye is on the flame's side of
// the plane: all of its light is nearer than the plane; -1: all of it is beyond.
FW_SHARED_FN float volumeBaseDepth(vec4 base, vec2 at) { return base.x + base.y * at.x + base.z * at.y; }

// Light between `front` and `front + deep` m along the view is tested at one depth: in its middle, or, where the base
// plane cuts it, in the middle of the part that is on the flame's side: ground in the plane never hides it, and what
// stands before it does. `whole` and `cut` are those depths; nearest counts, or farthest if `turn` is -1.
struct VolumeTest { float whole; float cut; float turn; };
FW_SHARED_FN VolumeTest volumeTest(vec4 base, vec4 clip, float front, float deep, vec2 at) {
    VolumeTest test;
    test.whole = volumeDepth(clip, front + 0.5f * deep);
    float end = clamp(volumeDepth(clip, front + (0.5f - 0.5f * base.w) * deep), 0.0f, 1.0f);
    test.cut = 0.5f * (end + volumeBaseDepth(base, at));
    // Depth grows along the view, or falls.
    test.turn = (clip.x * clip.w - clip.y * clip.z) * base.w < 0.0f ? -1.0f : 1.0f;
    return test;
}
// Of a corner. Between corners the device goes straight, so the ground stays behind.
FW_SHARED_FN float volumeTested(VolumeTest test) {
    return clamp(test.turn * min(test.turn * test.whole, test.turn * test.cut), 0.0f, 1.0f);
}
// Below 0 where the base plane cuts the light: linear over the view.
FW_SHARED_FN float volumeOver(vec4 base, vec4 clip, float front, float deep, vec2 at) {
    VolumeTest test = volumeTest(base, clip, front, deep, at);
    return test.turn * (test.cut - test.whole);
}

// A quad as two polygons, one on either side of a line: of vertex [0, kVolumeSplit) its place in the unit square.
// `over`: what is below 0 on the first one's side, at 0 0, 1 0, 1 1 and 0 1.
FW_SHARED_CONST uint kVolumeSplit = 18u;  // three triangles of each, some of them empty
FW_SHARED_FN vec2 volumeSplit(vec4 over, uint vertex) {
    float side = vertex < 9u ? 1.0f : -1.0f;
    uint fan = vertex < 9u ? vertex : vertex - 9u;
    uint turn = fan / 3u;
    uint wanted = fan - 3u * turn;
    if (wanted > 0u) wanted += turn;
    vec2 at = vec2(0.0f);
    uint count = 0u;
    FW_UNROLL
    for (uint k = 0u; k < 4u; ++k) {
        vec2 a = vec2(k == 1u || k == 2u ? 1.0f : 0.0f, k < 2u ? 0.0f : 1.0f);
        vec2 b = vec2(k < 2u ? 1.0f : 0.0f, k == 1u || k == 2u ? 1.0f : 0.0f);
        float da = over[k];
        float db = over[(k + 1u) & 3u];
        bool in_ = side * da <= 0.0f;
        if (in_ && count <= wanted) at = a;
        if (in_) ++count;
        bool crosses = in_ != (side * db <= 0.0f);
        if (crosses && count <= wanted) at = a + (b - a) * (da / (da - db));
        if (crosses) ++count;
    }
    return at;
}

FW_SHARED_CONST uint kVolumeTile = 8u;          // cells a side; a workgroup marches a tile
FW_SHARED_CONST uint kVolumeCellWords = 4u;     // of a cell in a slab, a texel: as halfs red and green, blue and
                                                // alpha; in slabs: see volumeLies; nothing yet

// Arguments of a flame's march and of its draw: a tile each of those that are worth a march. Zero before the probe.
struct VolumeWork {
    uint groups; uint groupsY; uint groupsZ; uint reserved;
    uint vertices; uint instances; uint firstVertex; uint firstInstance;
};
FW_SHARED_SIZE(VolumeWork, 32)

// What is known of a flame's tiles, array by array. Zero before the probe. First of each is a word per tile: a bit
// per slab that shows anything; behind them whether anything is in its first and last column, first and last row.
FW_SHARED_CONST uint kVolumeListed = 1u;        // 1: the tile is worth a march
FW_SHARED_CONST uint kVolumeList = 2u;          // of tiles that are
FW_SHARED_CONST uint kVolumeQuarter = 4u;       // cells a side of a tile's quarter; of each, by volumeQuarter:
FW_SHARED_CONST uint kVolumeBegins = 3u;        // all samples less the first that is worth a march
FW_SHARED_CONST uint kVolumeEnds = 7u;          // one and the last of them and one; 0: none is
FW_SHARED_CONST uint kVolumeTileWords = 12u;    // what a cell is begins after whole texels of these
FW_SHARED_FN uint volumeQuarter(uint x, uint y) { return (x & 1u) | (y & 1u) << 1u; }  // of quarters x, y

// Push constants of probe and march. A cell is a few pixels wide, or of a small flame a part of one; its ray goes
// through its middle (but see volumeShift): of cell x, y of the view, as above with rays from these. A flame's
// cells are tiles from its origin on, row by row of all,
// slab by slab. Samples lie in planes across the view, as many to each slab.
struct VolumeMarch {
    vec4 rayX;            // w: m, of a cell at a depth of 1 (perspective)
    vec4 rayY;            // w: m along the view, between samples
    vec4 rayO;            // w: m along the view, where the nearest slab begins
    uint slabs;
    uint turns;           // samples of a slab
    uint intervals;
    uint originX; uint originY; // cells of the view
    uint tilesX;
    uint cells;           // of a slab
    uint tiles;           // words of FW_BIND_VOLUME_RAYS: the first of what is known of its tiles
    uint samples;         // and of its cells
    uint encoding;        // FwOutputEncoding of who shows it
    uint flame;           // of VolumeWork
    uint apart;           // cells from a ray of the probe to the next: 1, 2, 4
    uint perPixel;        // as VolumeComposite's
    uint least;           // samples of a ray, see volumeCloser; 0: as many as are worth a march
    uint reserved0; uint reserved1;
};
FW_SHARED_SIZE(VolumeMarch, 112)

// n / d, exact below 2^22: software devices divide integers lane by lane.
FW_SHARED_FN uint volumeQuotient(uint n, uint d) { return uint((float(n) + 0.5f) / float(d)); }

// So many samples are taken for one where few (> 0) are worth a march: what is seen in few of them is thin,
// and was a row of beads as it came near the samples of one cell after another and left them again.
FW_SHARED_CONST uint kVolumeClosest = 4u;
FW_SHARED_FN uint volumeCloser(uint few, uint least) {
    uint closer = volumeQuotient(least + few / 2u, few);
    return closer < 1u ? 1u : closer < kVolumeClosest ? closer : kVolumeClosest;
}

// Workgroups of the probe side by side; each sees as many cells as eight rays.
FW_SHARED_FN uint volumeProbeBlocks(uint tiles, uint apart) { return (tiles + apart - 1u) / apart; }

// Push constants of who shows it.
struct VolumeComposite {
    vec4 place;           // x, y of the view: xy + zw * cells from the origin
    vec4 clip;            // as VolumeDraw's
    float front; float deep;
    uint slabs;
    uint tilesX; uint tilesY;
    uint flags; uint samples;
    uint perPixel;        // cells a side: 2, 4, 8, all of them in one tile; 0: a cell is a pixel or more
    float from; float to; // see volumeTurned
    uint reserved0; uint reserved1;
    vec4 window;          // low x, y, high x, y, cells from the origin: finer ones show the flame there
    vec4 base;            // as VolumeDraw's
};
FW_SHARED_SIZE(VolumeComposite, 112)

// A flame that was marched once and is shown for some frames: tiles of one slab, whose cells are
// kept as wide as they are in the world. Its words are what is known of its tiles, then its cells.
FW_SHARED_CONST uint kCardTiles = 128u;         // most
FW_SHARED_CONST uint kCardWords = kCardTiles * (kVolumeTileWords + kVolumeTile * kVolumeTile * kVolumeCellWords);

// Push constants of who shows it.
struct VolumeCard {
    vec4 place;           // x, y of the view: xy + zw * its cell's x + (upX, upY) * its y
    vec4 clip;            // as VolumeDraw's
    float front; float deep;
    float perX; float perY; // cells a pixel
    uint tilesX; uint tilesY;
    uint samples;         // first word of its cells
    float from; float to; // see volumeTurned
    float upX; float upY;
    uint reserved0;
    vec4 base;            // as VolumeDraw's
};
FW_SHARED_SIZE(VolumeCard, 96)

// Push constants of a flame that is drawn as slices of its lattice, see volume_slices.h.
struct VolumeSlices {
    vec4 clip;            // as VolumeDraw's
    float front;          // m along the view, where the nearest slice's part begins
    float spacing;        // m along the view, of a slice's part
    uint slices;          // [1, kVolumeSlices]
    float from; float to; // see volumeTurned
    uint reserved0; uint reserved1; uint reserved2;
};
FW_SHARED_SIZE(VolumeSlices, 48)
FW_SHARED_CONST uint kVolumeSlices = 96u;       // most of a flame

// Push constants of the haze over a flame.
struct VolumeHaze {
    vec4 rect;            // as VolumeDraw's, of the hot column
    vec4 rayX; vec4 rayY; vec4 rayO; vec4 clip;
    float strength;       // [0, 8]
    uint reserved0; uint reserved1; uint reserved2;
};
FW_SHARED_SIZE(VolumeHaze, 96)

// Whether a pixel shows what has the thresholds in [from, to) of [0, 1): two that share them lie in a
// fine pattern side by side, where laid over each other both would be too faint. Bayer's order.
FW_SHARED_FN bool volumeTurned(uint x, uint y, float from, float to) {
    uint a = (x ^ y) & 3u;
    uint b = y & 3u;
    uint order = ((a & 1u) << 3) | ((b & 1u) << 2) | (a & 2u) | ((b & 2u) >> 1);
    float threshold = (float(order) + 0.5f) * (1.0f / 16.0f);
    return threshold >= from && threshold < to;
}

// [0, 1): where in its steps a cell's samples lie: each of four in a square has its own quarter. One above
// the other are half a step apart: a tongue is upright and may be one cell wide, and where all its cells
// began near each other it would be seen now and not a little higher, as dashes.
// The same in all frames: what they show differs by what moves alone, and none needs those before it.
FW_SHARED_FN float volumePhase(uint x, uint y) {
    uint quarter = (x & 1u) | (2u * (y & 1u));
    return 0.085f + 0.25f * float(quarter);
}

// Cells [-0.5, 0.5] off its middle that a cell's ray goes where many cells are a pixel: a flame of few
// columns is seen at as many places as it has cells.
FW_SHARED_FN vec2 volumeShift(uint x, uint y) {
    float across = 0.61803399f * float(y);
    float along = 0.61803399f * float(x);
    return vec2(across - floor(across) - 0.5f, along - floor(along) - 0.5f);
}

// What the cell `step` (-1, 0, 1) from the nearest weighs, `off` cells [-0.5, 0.5] beyond its middle. However a
// pixel lies, even and odd cells weigh the same: it sees all four quarters alike, and no grain.
FW_SHARED_FN float volumeWeight(int step, float off) {
    return step == 0 ? 0.5f : 0.25f + 0.5f * float(step) * off;
}

// From where to where in a slab a cell's light lies, and how much of it the slabs before let through.
#ifndef __cplusplus
uint volumeLies(vec2 reach, float through) {
    uvec2 ends = uvec2(clamp(reach, 0.0, 1.0) * 255.0 + 0.5);
    return ends.x | (ends.y << 8u) | (uint(clamp(through, 0.0, 1.0) * 65535.0 + 0.5) << 16u);
}
float volumeThrough(uint lies) { return float(lies >> 16u) * (1.0 / 65535.0); }
// How much of it is nearer than `cut` slabs beyond this one's front.
float volumeNearer(uint lies, float cut) {
    vec2 ends = vec2(uvec2(lies, lies >> 8u) & 255u) * (1.0 / 255.0);
    return clamp((cut - ends.x) / max(ends.y - ends.x, 1e-2), 0.0, 1.0);
}
// How much of it is on the flame's side of the base, which is `cut` slabs beyond this one's front; `side`: VolumeDraw::
// base.w. A ray of its own has no light beyond: all of it counts until the base is nearer than its first eighth.
float volumeBeside(uint lies, float cut, float side) {
    vec2 ends = vec2(uvec2(lies, lies >> 8u) & 255u) * (1.0 / 255.0);
    float end = side < 0.0 ? ends.y : ends.x;
    return clamp(side * (cut - end) / max(0.125 * (ends.y - ends.x), 5e-3), 0.0, 1.0);
}
#endif

// m: of what a ray stands for where as many go through a pixel each way: detail as fine as a part of it is sampled,
// since what a pixel averages is many rays; of a large flame's one ray what is not finer than it.
FW_SHARED_FN float volumeFine(float pixel, uint perPixel) {
    return perPixel > 1u ? 0.25f * pixel / float(perPixel) : pixel;
}

// How many samples a ray takes over so many metres.
FW_SHARED_FN float volumeSteps(float metres, float spacing, uint most) {
    return clamp(floor(metres / spacing) + 1.0f, 4.0f, float(most));
}
FW_SHARED_END
#endif
