// Records shared by the drawing passes: appearance of a burning material, view, flame quad. Lengths
// in m, times in appearance seconds (see BurnMaterial::timeScale), temperatures in K.
// clang-format off
#ifndef FW_SHARED_APPEARANCE_H
#define FW_SHARED_APPEARANCE_H
#include "shared/types.h"

FW_SHARED_BEGIN

// Pattern of the unburnt material where no image is given.
FW_CONST uint kBasePlain = 0u;
FW_CONST uint kBaseWood = 1u;
FW_CONST uint kBasePaint = 2u;
FW_CONST uint kBasePaper = 3u;
FW_CONST uint kBasePrint = 4u;
FW_CONST uint kBaseWeave = 5u;
FW_CONST uint kBaseLeaf = 6u;
FW_CONST uint kBaseStraw = 7u;
FW_CONST uint kBaseLeather = 8u;
FW_CONST uint kBasePlastic = 9u;
FW_CONST uint kBaseStone = 10u;

// Variants of the surface pass: families of materials, and states.
FW_CONST uint kSurfaceWood = 1u;   // char blocks, grain
FW_CONST uint kSurfaceSheet = 2u;  // paper, cloth: sparks, wrinkles
FW_CONST uint kSurfacePlant = 4u;  // leaf, straw
FW_CONST uint kSurfaceHide = 8u;   // leather, plastic
FW_CONST uint kSurfaceBurns = 16u; // an event has reached the object
FW_CONST uint kSurfacePaint = 32u; // on wood: film, blisters
FW_CONST uint kSurfaceImage = 64u; // the object's image instead of a pattern
FW_CONST uint kSurfaceCold = 128u; // only triangles far from all traces of fire

#ifdef __cplusplus
// The part of a material that selects its pipeline, besides its image; stone is drawn as wood.
enum class MaterialFamily : uint8_t { wood, paint, sheet, plant, hide };
#endif

// Layers of the appearance texture array: 512^2 RGBA8, tiling, with mips.
FW_CONST float kLayerNoise = 0.0f;   // R fBm, G ridged fBm, B fine fBm, A flake id
// R primary crack distance, G secondary, BA slopes of cracks.
FW_CONST float kLayerChar = 1.0f;
FW_CONST float kLayerRelief = 2.0f;  // RG slopes of crumpling
FW_CONST float kAppearanceTextureSide = 512.0f;
FW_CONST float kCrackSlopeRange = 12.0f;   // per cell, at texel value 1
FW_CONST float kCrumpleSlopeRange = 48.0f; // per tile, at texel value 1

struct MaterialAppearance {        // zero switches a feature off
    float spreadRate;        // m/s at which the seconds below were tuned
    float warpLarge;         // m, raggedness of the front, features of about 60 mm
    float warpSmall;         // m, features of about 8 mm
    float jitter;            // s, weight of the delay per strand, vein or thread

    float scorchWidth;       // m, browned band ahead of the front
    float scorchGain;        // strength of browning at the front
    float charTime;          // s, from the front to black
    float blister;           // m, height of paint blisters and bubbles

    vec4 charColor;          // w: roughness of char

    float sheen;             // [0, 1] graphite gleam of char
    float cellX;             // m, char block across the grain
    float cellY;             // m, along the grain
    float crackWidth;        // m, when open

    float crackDepth;        // m
    float crackTime;         // s, when cracks are open
    float crumple;           // m, wrinkles of charred sheets
    float isotropic;         // 0 blocks along the grain, 1 irregular cells

    float faceKelvin;        // K, face of the char just behind the front
    float facePeak;          // s
    float faceDecay;         // s
    float crackKelvin;       // K, floor of the cracks

    float crackLife;         // s, Gaussian
    float glowVariation;     // K
    float wormKelvin;        // K, crawling sparks in thin char
    float ashMax;            // [0, 1]

    float ashStart;          // s
    float ashEnd;            // s
    float holeTime;          // s from ignition to a hole
    float holeVariation;     // s

    vec4 ashColor;           // w: m, thickness of a paint film that peels

    float rimKelvin;         // K at the edge of a hole
    float rimWidth;          // m, e-folding length of that
    float thickness;         // m, of the rim
    float lip;               // m, bead of molten material

    float curl;              // tilt of the normal at the rim
    float wetDark;           // exponent added when soaked
    float wetGloss;          // [0, 1]
    float melt;              // [0, 1] gloss and flow instead of char

    float holeTiles;         // tiles per metre of the hole noise
    float holeFine;          // [0, 1] weight of crumbs
    float drip;              // stretch of the hole noise along y, 1: none
    float blur;              // m, least noise footprint

    vec4 wiltColor;          // w: m, width of the wilted band of living tissue

    uint base;               // kBase...
    float baseScale;         // scale of the procedural pattern, 1
    float flame;             // flame height relative to wood
    float smoke;             // smoke relative to wood
};
FW_SIZE(MaterialAppearance, 224)

struct ViewParams {          // uniform block, one per view
    vec4 clip0;              // columns of camera-relative world to clip space
    vec4 clip1;
    vec4 clip2;
    vec4 clip3;
    vec4 eye;                // m, world; w: m per pixel at clip w = 1
    vec4 forward;            // unit; w: 1 perspective, 0 orthographic
    vec4 sunDirection;       // towards the sun; w: exposure
    vec4 sunColor;           // w: emission scale
    vec4 ambientSky;         // w: s, cosmetic time, wraps at 4096
    vec4 ambientGround;      // w: ticks since the current tick, [0, 1)
    vec4 up;                 // world up; w: pace factor of the world
    vec4 wind;               // m/s; w: clip z over w of geometry clipped beyond the far plane
    uint now;                // tick
    uint lightCount;         // limit of lights
    uint flameCapacity;      // limit of flame quads
    uint seed;
    vec4 viewport;           // px: x, y, width, height
    vec4 quads;  // x: visible share of flames and particles; y: widening that compensates it; z:
                 // share of its own fires that the last light represents; w: 1 where bodies show
                 // the flames of their objects, 0: quads do
};
FW_SIZE(ViewParams, 240)

// Opacity of the item with random number `own` in [0, 1) where a share of all is visible: 0 or 1,
// with a short fade so that no item pops.
FW_FN float shownShare(float share, float own) { return saturate((share - own) * 12.0f + share); }

// Emission of 40 cd/m^2 shows as 1 in the host's linear units, at emission scale 1.
FW_CONST float kWhiteLuminance = 40.0f;

FW_CONST uint kAppearanceRows = 16u; // of the appearance table

// kSurfaceCold classifies triangles by the marks of the tiles within `coldReach` texels of their
// corners: no point is farther than 0.58 edges from a corner, or sampled beyond 1.5 texels. At most
// kColdReach.
FW_CONST float kColdReach = 12.0f;
FW_FN float coldReach(float edge) { return 0.58f * edge + 1.5f; }

// Only the strongest lights light surfaces.
FW_CONST uint kSurfaceLights = 16u;

// Push constants of the surface pass: one object, one material. Per-draw constants never come from
// storage buffers: software devices gather those word by word and lane by lane.
struct SurfaceDraw {
    vec4 row0;               // object to world
    vec4 row1;
    vec4 row2;
    vec4 colorRough;         // linear albedo, roughness
    float tintR;
    float tintG;
    float tintB;
    float timeScale;         // as BurnMaterial
    float thickness;         // m
    float horizon;           // s that the prediction reaches ahead
    uint appearance;               // row of the appearance table
    uint stateBase;          // as BurnObject
    uint size;               // texels: width, << 16: height
    uint flags;              // kObject..., kDrawVertexLight
    uint places;             // with kDrawPlaced: first refined position
    uint inner;              // offset to its position on the inner skin; 0: none
    uint heatBase;           // as BurnObject; with kDrawHeat, kDrawWet
    float maxFilm;          // g/m^2 of water that the surface holds; 0: no heat buffer
    float now;               // with kDrawPlaced: s on the clock of its holes
    // With kDrawCut: 0 (cut and discarded rims must match) to 1; kSurfaceCold: texels, coldReach.
    float nearness;
};
FW_SIZE(SurfaceDraw, 128)
// SurfaceDraw::flags beyond kObject...: triangles are small, flames light their corners.
FW_CONST uint kDrawVertexLight = 0x10000u;
// Vertices come from the refinement's positions.
FW_CONST uint kDrawPlaced = 0x20000u;
// Temperature and char depth come from its heat buffer.
FW_CONST uint kDrawHeat = 0x40000u;
// Water or heat from other objects has reached it.
FW_CONST uint kDrawWet = 0x80000u;
// It chars through from the surface.
FW_CONST uint kDrawThick = 0x100000u;
// Holes are cut out of the triangles: vertices hold the time until each point burns through.
FW_CONST uint kDrawCut = 0x200000u;
// Walls along open edges without cut triangles: texels hold the time until each point burns
// through.
FW_CONST uint kDrawPerPixelHoles = 0x400000u;
// Placed vertices on the inner skin.
FW_CONST uint kDrawInner = 0x800000u;
// Share of a wall by which refined faces recede; the rest is char, visible at rims.
FW_CONST float kRefineRecede = 0.6f;

struct FlameQuad {
    vec4 baseHeight;         // m, world, foot of the quad; w: height m
    vec4 axisWidth;          // unit, foot to tip; w: half width m
    float opacity;           // [0, 1]
    float phase;  // s of scroll, offset by the seed; kQuadFire: its life, [0, 1]; with a flipbook:
                  // flipbookPlaceAt's time
    float kelvin;            // K of the hottest part; kQuadSmoke: share lit by fire, [0, 1]
    uint kind;               // kQuad... | seed << 2 | flipbook + 1 << 18 (0: none) | kQuadEmits
};
FW_SIZE(FlameQuad, 48)

FW_CONST uint kQuadTongue = 0u;  // of a burning tile
FW_CONST uint kQuadSmoke = 1u;
FW_CONST uint kQuadFire = 2u;    // of a particle
FW_CONST uint kQuadSpark = 3u;
FW_CONST uint kQuadSeed = 2u;   // shifts
FW_CONST uint kQuadFlipbookShift = 18u;
FW_CONST uint kQuadOfBody = 1u << 30;  // of an object whose flames a view may show as one body
FW_CONST uint kQuadEmits = 1u << 31;  // hides nothing; implied for kQuadSpark
// Half widths by which flame quads are nearer to the camera: a wall behind does not cut them.
FW_CONST float kQuadNearer = 0.35f;

// Draw arguments of the flames, their draw order, then as many words of scratch for the sort. Quads
// are first those of burning tiles (at most kFlameCapacity), then of particles, then emissive ones:
// sparks, and flipbook fire that hides nothing. Emissive quads are not sorted but placed between
// those that hide, farthest first.
FW_CONST uint kFlameTileQuads = 4u;       // word: requested quads of tiles
FW_CONST uint kFlameParticleQuads = 5u;   // word: quads of particles that hide
FW_CONST uint kFlameEmissiveQuads = 6u;      // word: emissive quads
// words: draw arguments of the emissive quads, in buffer order.
FW_CONST uint kFlameEmissiveDraw = 8u;
FW_CONST uint kFlameOrder = 12u;      // first word of the order
FW_CONST uint kFlameCapacity = 4096u; // limit of drawn tile quads
FW_CONST uint kMaxQuads = 65536u;    // of all
FW_CONST uint kMaxFewQuads = 2048u;  // capacity of the sort in shared memory

// Specialization constant 3 of quad draws. A half-resolution target takes all but sparks, which are
// as thin as a pixel and are drawn at full resolution.
FW_CONST uint kPartAll = 0u;
FW_CONST uint kPartSoft = 1u;
FW_CONST uint kPartSparks = 2u;

struct SortPush {
    uint tiles;      // quads of tiles, at most
    uint particles;  // of particles, at most
    uint lights;     // of those that emit alone, at most
    uint few;        // to sort, <= kMaxFewQuads: more use the radix sort
};
FW_SIZE(SortPush, 16)

// Hash grid of heat-release clusters: kClusterHeader words, then cells of kClusterWords.
FW_CONST uint kClusterSlots = 4096u;
// Key, power / 16 W, 3 weighted offsets, area / 0.1 cm^2, side, 3 cell coordinates, level, unused.
FW_CONST uint kClusterWords = 12u;
FW_CONST uint kClusterHeader = 16u; // [0]: requested quads, in 1/16

FW_SHARED_END
#endif
