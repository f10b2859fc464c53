// Between the frames of a flipbook: which two are shown, and from where in each, so that what moves
// is seen once and not twice beside itself. What a texel says. It loads nothing.
// GLSL too, and laid out by hand.
// clang-format off
#ifndef FW_SHARED_BOOK_H
#define FW_SHARED_BOOK_H
#include "shared/types.h"

FW_SHARED_BEGIN
#ifdef __cplusplus
using glm::clamp;
using glm::floor;
using glm::mix;
#endif

FW_SHARED_CONST float kBookCold = 800.0f;   // K, of a texel's red: 0
FW_SHARED_CONST float kBookHot = 2000.0f;   // K, 1

struct BookPlace {
    uint before;  // frames
    uint after;
    float part;   // [0, 1) of the way
};
// time: turns of a book that loops (any number), else [0, 1] of its length.
FW_SHARED_FN BookPlace bookPlace(float time, uint frames, bool loops) {
    BookPlace p;
    float turn = loops ? time - floor(time) : clamp(time, 0.0f, 1.0f);
    float at = turn * float(loops ? frames : frames - 1u);
    p.before = uint(at) < frames ? uint(at) : frames - 1u;
    p.after = p.before + 1u < frames ? p.before + 1u : (loops ? 0u : p.before);
    p.part = clamp(at - float(p.before), 0.0f, 1.0f);
    return p;
}

// Of a motion texel, [0, 1] each: uv per frame. most: of the book, at full scale.
FW_SHARED_FN vec2 bookMotion(vec2 texel, float most) { return (texel * 255.0f - 128.0f) * (most / 127.0f); }
// Where to read the frame before and the one after. motion: each one's own at uv.
FW_SHARED_FN vec2 bookBefore(vec2 uv, vec2 motion, float part) { return uv - part * motion; }
FW_SHARED_FN vec2 bookAfter(vec2 uv, vec2 motion, float part) { return uv + (1.0f - part) * motion; }

FW_SHARED_FN float bookKelvin(float red) { return mix(kBookCold, kBookHot, red); }

// Of two texels with this much of the second: temperatures count by what glows.
FW_SHARED_FN vec4 bookMix(vec4 before, vec4 after, float part) {
    vec4 m = mix(before, after, part);
    float a = before.y * (1.0f - part), b = after.y * part;
    m.x = a + b > 1e-5f ? (before.x * a + after.x * b) / (a + b) : m.x;
    return m;
}

FW_SHARED_END
#endif
