// Flipbooks: frame selection, motion-compensated blending of two frames, and the meaning of a
// texel.
// clang-format off
#ifndef FW_SHARED_FLIPBOOK_H
#define FW_SHARED_FLIPBOOK_H
#include "shared/types.h"

FW_SHARED_BEGIN

FW_CONST float kFlipbookMinKelvin = 800.0f;   // K where a texel's red is 0
FW_CONST float kFlipbookMaxKelvin = 2000.0f;   // K where it is 1

// Device layout: all frames and motion vectors share one texture. The flipbook buffer holds
// kMaxFlipbooks records (FlipbookRecord), then two words per frame: left | low << 16, right | high
// << 16.
FW_CONST uint kMaxFlipbooks = 32u;         // of a world
FW_CONST uint kMaxFlipbookFrames = 256u;
FW_CONST uint kFlipbookRecordWords = 16u;
// First word of the rectangles.
FW_CONST uint kFlipbookRects = kMaxFlipbooks * kFlipbookRecordWords;
FW_CONST uint kFlipbookWords = kFlipbookRects + kMaxFlipbooks * kMaxFlipbookFrames * 2u;
FW_CONST uint kFlipbookLoops = 1u;   // FlipbookRecord::flags: plays in a loop

struct FlipbookRecord {
    uint at;             // first texel of frame 0 in the texture: x | y << 16
    uint size;           // texels of a frame: width | height << 16
    uint motionAt;       // as `at`, of the motion vectors
    uint motionSize;
    uint frames;
    uint columns;        // frames per row in the texture, for colour and motion
    uint flags;
    float maxMotion;    // uv per frame of a full-scale motion texel
    float seconds;       // s, one cycle
    uint at1; uint at2; uint at3;  // as `at`, of the mip at 1/2, 1/4 and 1/8 size; 0: no mip
    uint reserved0; uint reserved1; uint reserved2; uint reserved3;
};
FW_SIZE(FlipbookRecord, 64)
FW_CONST uint kFlipbookLevels = 4u;
FW_CONST uint kFlipbookLevelWord = 8u;  // word of the record where at1 follows
// Mip for a quad of `pixels` that shows frames of `texels`. `own`, [0, 1), dithers the switch per
// quad, so that the quads of a fire do not change mips at the same distance.
FW_FN uint flipbookLevel(float texels, float pixels, float own) {
    float off = log2(max(texels / max(pixels, 1e-3f), 1.0f)) + 0.25f + 0.5f * own;
    return uint(min(off, float(kFlipbookLevels - 1u)));
}
// First texel of a frame. One empty texel separates frames, so reads beyond a border return
// nothing.
FW_FN uvec2 flipbookFrameOrigin(FlipbookRecord b, uint frame) {
    return uvec2((b.at & 0xFFFFu) + frame % b.columns * ((b.size & 0xFFFFu) + 2u),
                 (b.at >> 16) + frame / b.columns * ((b.size >> 16) + 2u));
}
FW_FN uvec2 flipbookMotionOrigin(FlipbookRecord b, uint frame) {
    return uvec2((b.motionAt & 0xFFFFu) + frame % b.columns * (b.motionSize & 0xFFFFu),
                 (b.motionAt >> 16) + frame / b.columns * (b.motionSize >> 16));
}

// Playback time of a particle. Once: `life`, [0, 1]. Loop: `age` in s, with the phase `own`, [0,
// 1).
FW_FN float flipbookTime(bool loops, float seconds, float life, float age, float own) {
    return loops ? age / seconds + 7.0f * own : clamp(life, 0.0f, 1.0f);
}

struct FlipbookPlace {
    uint before;  // frame
    uint after;
    float part;   // blend weight of `after`, [0, 1)
};
// time: cycles of a looping flipbook (any value), else [0, 1] of its length.
FW_FN FlipbookPlace flipbookPlaceAt(float time, uint frames, bool loops) {
    FlipbookPlace p;
    float turn = loops ? time - floor(time) : clamp(time, 0.0f, 1.0f);
    float at = turn * float(loops ? frames : frames - 1u);
    p.before = uint(at) < frames ? uint(at) : frames - 1u;
    p.after = p.before + 1u < frames ? p.before + 1u : (loops ? 0u : p.before);
    p.part = clamp(at - float(p.before), 0.0f, 1.0f);
    return p;
}

// Decodes a motion texel ([0, 1] each) to uv per frame. most: uv per frame at full scale.
FW_FN vec2 decodeFlipbookMotion(vec2 texel, float most) {
    return (texel * 255.0f - 128.0f) * (most / 127.0f);
}
// uv to read in the frame before and in the frame after. motion: sampled at uv in the same frame.
FW_FN vec2 flipbookUvBefore(vec2 uv, vec2 motion, float part) { return uv - part * motion; }
FW_FN vec2 flipbookUvAfter(vec2 uv, vec2 motion, float part) { return uv + (1.0f - part) * motion; }

FW_FN float flipbookKelvin(float red) { return mix(kFlipbookMinKelvin, kFlipbookMaxKelvin, red); }

// Blends two texels. The temperature is weighted by the soot of each.
FW_FN vec4 mixFlipbookTexels(vec4 before, vec4 after, float part) {
    vec4 m = mix(before, after, part);
    float a = before.y * (1.0f - part), b = after.y * part;
    m.x = a + b > 1e-5f ? (before.x * a + after.x * b) / (a + b) : m.x;
    return m;
}

FW_SHARED_END
#endif
