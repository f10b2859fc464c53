// Drawing of volumetric flames: push constants and sample positions of rays. Emission is in
// volume.h, and so is uniform data.
// clang-format off
#ifndef FW_SHARED_VOLUME_DRAW_H
#define FW_SHARED_VOLUME_DRAW_H
#include "shared/types.h"

FW_SHARED_BEGIN

FW_CONST uint kMaxVolumeFlames = 256u;   // of a world, in a frame
FW_CONST uint kFirePresets = 9u;         // first layers of the profile texture
FW_CONST uint kMaxFireProfiles = 23u;    // the host's, behind them
FW_CONST uint kProfileBytes = 32768u;    // per layer: 64 x 128 pairs of half floats
FW_CONST uint kVolumeSlabs = 6u;  // slabs of a flame where the host's depth is only tested
FW_CONST uint kVolumeFlameBytes = 1792u; // a multiple of 256: each flame is a uniform block
FW_CONST float kVolumeWhite = 1.5f;      // host units of soot of luminance 1


// Push constants: screen rectangle of a flame, and its depth slabs. Ray at x, y of the view:
// perspective: depth * (rayO + x rayX + y rayY); orthographic: rayO + x rayX + y rayY + depth *
// forward.
struct VolumeDraw {
    vec4 rect;            // low x, low y, high x, high y, [-1, 1] over the viewport
    vec4 rayX;            // m, from the camera
    vec4 rayY;
    vec4 rayO;
    vec4 clip;            // clip z = x * depth + y; clip w = z * depth + w
    float front;          // m along the view, near distance of the nearest slab
    float deep;           // m, depth of a slab
    uint slabs;           // [1, kVolumeSlabs]
    uint mostSteps;       // per ray, at most
    float spacing;        // m between samples, as far as mostSteps allows
    uint intervals;       // [1, kFlameIntervals], between knots of a ray
    float wide;           // m, the flame's diameter
    uint perPixel;        // rays per side of a pixel; [1, 8]
    vec4 base;            // plane through its base, see volumeBaseDepth
};
FW_SIZE(VolumeDraw, 128)

// ---- depth test without reading depth

// clip z / w of a distance along the view, and its inverse, m. clip: VolumeDraw::clip.
FW_FN float depthOfMetres(vec4 clip, float metres) {
    return (clip.x * metres + clip.y) / (clip.z * metres + clip.w);
}
FW_FN float metresOfDepth(vec4 clip, float depth) {
    float per = clip.x - depth * clip.z;
    float at = (depth * clip.w - clip.y) / (abs(per) > 1e-12f ? per : 1e-12f);
    return at > 0.0f ? at : 1e9f;  // far end of an infinite view
}

// A flame stands on the plane through its base, often on ground in that plane. The plane's clip z /
// w is linear in x, y of the view: base.x + base.y * x + base.z * y. base.w is 1 if the camera is
// on the flame's side of the plane (all light is nearer than the plane), else -1 (all light is
// beyond).
FW_FN float volumeBaseDepth(vec4 base, vec2 at) { return base.x + base.y * at.x + base.z * at.y; }

// A slab from `front` to `front + deep` m is tested at one depth: its middle, or, where the base
// plane cuts it, the middle of the part on the flame's side. So ground in the plane never hides it,
// and objects in front do. whole, cut: those depths; the nearest counts, or the farthest if turn is
// -1.
struct DepthTest { float whole; float cut; float turn; };
FW_FN DepthTest makeDepthTest(vec4 base, vec4 clip, float front, float deep, vec2 at) {
    DepthTest test;
    test.whole = depthOfMetres(clip, front + 0.5f * deep);
    float end = clamp(depthOfMetres(clip, front + (0.5f - 0.5f * base.w) * deep), 0.0f, 1.0f);
    test.cut = 0.5f * (end + volumeBaseDepth(base, at));
    test.turn = (clip.x * clip.w - clip.y * clip.z) * base.w < 0.0f ? -1.0f : 1.0f;
    return test;
}
// Depth of a corner. Interpolation between corners is linear, so the ground stays behind.
FW_FN float testedDepth(DepthTest test) {
    return clamp(test.turn * min(test.turn * test.whole, test.turn * test.cut), 0.0f, 1.0f);
}
// Negative where the base plane cuts the slab; linear over the view.
FW_FN float baseSide(vec4 base, vec4 clip, float front, float deep, vec2 at) {
    DepthTest test = makeDepthTest(base, clip, front, deep, at);
    return test.turn * (test.cut - test.whole);
}

// Splits a quad into two polygons along a line. Returns the place of vertex [0,
// kVolumeSplitVertices) in the unit square. over: negative on the first polygon's side, at 0 0, 1
// 0, 1 1 and 0 1.
FW_CONST uint kVolumeSplitVertices = 18u;  // three triangles each, some degenerate
FW_FN vec2 splitQuadVertex(vec4 over, uint vertex) {
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

FW_CONST uint kMarchTileSide = 8u;  // march pixels per side; a workgroup marches a tile
FW_CONST uint kMarchPixelWords = 4u;  // per march pixel and slab: half floats red and green,
                                             // blue and alpha; packSlabRange; unused

// Indirect arguments of a flame's march and draw, one tile each. Zeroed before the probe.
struct VolumeWork {
    uint groups; uint groupsY; uint groupsZ; uint reserved;
    uint vertices; uint instances; uint firstVertex; uint firstInstance;
};
FW_SIZE(VolumeWork, 32)

// Tile data of a flame, array by array, zeroed before the probe. First a word per tile: one bit per
// visible slab, then whether its first and last column, first and last row are visible.
FW_CONST uint kMarchTileListed = 1u;        // 1: the tile is marched
FW_CONST uint kMarchTileList = 2u;          // marched tiles
// March pixels per side of a tile's quarter; per quarter, by marchQuarter:
FW_CONST uint kMarchQuarterSide = 4u;
FW_CONST uint kMarchQuarterBegins = 3u;        // all samples minus the first that is marched
FW_CONST uint kMarchQuarterEnds = 7u;          // last marched sample + 1; 0: none
// Of a body: kBodyMaskWords words instead, one bit per flame.
FW_CONST uint kMarchBodyMask = 3u;
FW_CONST uint kMarchTileWords = 16u;    // pixels begin after whole texels of these
// Quarter x, y.
FW_FN uint marchQuarter(uint x, uint y) { return (x & 1u) | (y & 1u) << 1u; }

// Push constants of probe and march. A march pixel covers a few pixels, or a part of one for a
// small flame; its ray passes through its middle (but see marchRayShift). A flame's march pixels
// are tiles from its origin, row by row over all tiles, slab by slab. Samples lie in planes across
// the view, equally many per slab.
struct MarchPush {
    vec4 rayX;            // w: m, width of a march pixel at depth 1 (perspective)
    vec4 rayY;            // w: m along the view, between samples
    vec4 rayO;            // w: m along the view, near distance of the nearest slab
    uint slabs;
    uint turns;           // samples per slab
    uint intervals;
    uint originX; uint originY; // march pixels of the view
    uint tilesX;
    uint pixels;          // per slab
    uint tiles;           // words of FW_BIND_VOLUME_RAYS: first of its tile data
    uint samples;         // first of its march pixels
    uint encoding;        // FwOutputEncoding of the target
    uint flame;           // index in VolumeWork
    uint apart;           // march pixels between rays of the probe: 1, 2, 4
    uint perPixel;        // as CompositePush's
    uint least;           // least samples per ray, see sampleRefinement; 0: no minimum
    uint body;            // of a burning object's fire: its number, and
    uint flames;          // words of FW_BIND_VOLUME_RAYS: first of its flames, then of its nodes
};
FW_SIZE(MarchPush, 112)

// n / d, exact below 2^22: software devices divide integers lane by lane.
FW_FN uint quotient22(uint n, uint d) { return uint((float(n) + 0.5f) / float(d)); }

// Sample refinement where only `few` (> 0) samples are worth a march. A thin flame would otherwise
// appear as a row of beads, as it alternately meets and misses the samples.
FW_CONST uint kVolumeClosest = 4u;
FW_FN uint sampleRefinement(uint few, uint least) {
    uint closer = quotient22(least + few / 2u, few);
    return closer < 1u ? 1u : closer < kVolumeClosest ? closer : kVolumeClosest;
}

// Probe workgroups per row; each covers the march pixels of eight rays.
FW_FN uint probeBlockCount(uint tiles, uint apart) { return (tiles + apart - 1u) / apart; }

// Push constants of the composite pass.
struct CompositePush {
    vec4 place;           // x, y of the view: xy + zw * march pixels from the origin
    vec4 clip;            // as VolumeDraw's
    float front; float deep;
    uint slabs;
    uint tilesX; uint tilesY;
    uint flags; uint samples;
    // March pixels per side of a pixel: 2, 4, 8, in one tile; 0: a march pixel is a pixel or more.
    uint perPixel;
    float from; float to; // see passesDither
    float nearer;         // m by which its light counts as nearer than it is
    uint reserved0;
    // Low x, y, high x, y, march pixels from the origin: a finer march shows the flame there.
    vec4 window;
    vec4 base;            // as VolumeDraw's
};
FW_SIZE(CompositePush, 112)

// Billboard impostor: a flame that is marched once and shown for several frames. Tiles of one slab
// with a constant world size per march pixel. Words: tile data, then march pixels.
FW_CONST uint kMaxImpostorTiles = 128u;         // at most
FW_CONST uint kImpostorWords =
    kMaxImpostorTiles * (kMarchTileWords + kMarchTileSide * kMarchTileSide * kMarchPixelWords);

// Push constants of the impostor pass.
struct VolumeImpostor {
    vec4 place;           // x, y of the view: xy + zw * its march pixel's x + (upX, upY) * its y
    vec4 clip;            // as VolumeDraw's
    float front; float deep;
    float perX; float perY; // march pixels per pixel
    uint tilesX; uint tilesY;
    uint samples;         // first word of its march pixels
    float from; float to; // see passesDither
    float upX; float upY;
    uint reserved0;
    vec4 base;            // as VolumeDraw's
};
FW_SIZE(VolumeImpostor, 96)

// Push constants of the haze over a flame.
struct HazePush {
    vec4 rect;            // VolumeDraw::rect of the hot column
    vec4 rayX; vec4 rayY; vec4 rayO; vec4 clip;
    float strength;       // [0, 8]
    uint reserved0; uint reserved1; uint reserved2;
};
FW_SIZE(HazePush, 96)

// Ordered dither (Bayer): does a pixel show the threshold range [from, to) of [0, 1)? Two impostors
// that share a range interleave; blended over each other, both would be too faint.
FW_FN bool passesDither(uint x, uint y, float from, float to) {
    uint a = (x ^ y) & 3u;
    uint b = y & 3u;
    uint order = ((a & 1u) << 3) | ((b & 1u) << 2) | (a & 2u) | ((b & 2u) >> 1);
    float threshold = (float(order) + 0.5f) * (1.0f / 16.0f);
    return threshold >= from && threshold < to;
}

// Phase, [0, 1), of a march pixel's samples within a step: four phases in a square. Vertical
// neighbours differ by half a step: an upright tongue may be one march pixel wide and would appear
// dashed otherwise. The phase is constant over frames, so a frame needs no history.
FW_FN float marchSamplePhase(uint x, uint y) {
    return 0.085f + 0.25f * float(marchQuarter(x, y));
}

// Offset, [-0.5, 0.5] march pixels, of a ray where many march pixels cover a pixel: a narrow flame
// is then sampled at as many places as it has march pixels.
FW_FN vec2 marchRayShift(uint x, uint y) {
    float across = 0.61803399f * float(y);
    float along = 0.61803399f * float(x);
    return vec2(across - floor(across) - 0.5f, along - floor(along) - 0.5f);
}

// Weight of the march pixel `step` (-1, 0, 1) from the nearest, `off` [-0.5, 0.5] beyond its
// middle. Even and odd ones weigh the same for any pixel position, so all four phases count alike
// and no grain shows.
FW_FN float neighbourWeight(int step, float off) {
    return step == 0 ? 0.5f : 0.25f + 0.5f * float(step) * off;
}

// Packs the range of a march pixel's light within a slab, and the transmittance of the slabs in
// front.
#ifndef __cplusplus
uint packSlabRange(vec2 reach, float through) {
    uvec2 ends = uvec2(clamp(reach, 0.0, 1.0) * 255.0 + 0.5);
    return ends.x | (ends.y << 8u) | (uint(clamp(through, 0.0, 1.0) * 65535.0 + 0.5) << 16u);
}
vec2 slabEnds(uint lies) { return vec2(uvec2(lies, lies >> 8u) & 255u) * (1.0 / 255.0); }
float slabTransmittance(uint lies) { return float(lies >> 16u) * (1.0 / 65535.0); }
// Share of its light nearer than `cut` slabs beyond this slab's front.
float slabShareNearer(uint lies, float cut) {
    vec2 ends = slabEnds(lies);
    return clamp((cut - ends.x) / max(ends.y - ends.x, 1e-2), 0.0, 1.0);
}
// Share of its light on the flame's side of the base, `cut` slabs beyond this slab's front; side:
// VolumeDraw::base.w. A march pixel's own ray has no light beyond, so all counts until the base is
// nearer than its first eighth.
float slabShareBeside(uint lies, float cut, float side) {
    vec2 ends = slabEnds(lies);
    float end = side < 0.0 ? ends.y : ends.x;
    return clamp(side * (cut - end) / max(0.125 * (ends.y - ends.x), 5e-3), 0.0, 1.0);
}
#endif

// Sample footprint, m, for rays of which perPixel^2 cover a pixel: finer than a ray's share, since
// the pixel averages many rays; a single ray uses its own width.
FW_FN float sampleFootprint(float pixel, uint perPixel) {
    return perPixel > 1u ? 0.25f * pixel / float(perPixel) : pixel;
}

// Number of samples of a ray over `metres`.
FW_FN float rayStepCount(float metres, float spacing, uint most) {
    return clamp(floor(metres / spacing) + 1.0f, 4.0f, float(most));
}
FW_SHARED_END
#endif
