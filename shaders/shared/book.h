// Between the frames of a flipbook: which two are shown, and from where in each, so that what moves
// is seen once and not twice beside itself. What a texel says. It loads nothing.
// GLSL too, and laid out by hand.
// clang-format off
#ifndef FW_SHARED_BOOK_H
#define FW_SHARED_BOOK_H
#include "shared/types.h"

#ifdef __cplusplus
#include <cmath>
#endif

FW_SHARED_BEGIN
#ifdef __cplusplus
using glm::clamp;
using glm::floor;
using glm::max;
using glm::min;
using std::log2;
using glm::mix;
#endif

FW_SHARED_CONST float kBookCold = 800.0f;   // K, of a texel's red: 0
FW_SHARED_CONST float kBookHot = 2000.0f;   // K, 1

// Books on the device: frames lie in one picture, motion too; a record says where. Words: records
// (BookRecord), then rects of all frames of a book, two words each: left | low << 16, right | high.
FW_SHARED_CONST uint kMaxBooks = 32u;         // of a world
FW_SHARED_CONST uint kMostBookFrames = 256u;
FW_SHARED_CONST uint kBookRecordWords = 16u;
FW_SHARED_CONST uint kBookRects = kMaxBooks * kBookRecordWords;  // first word
FW_SHARED_CONST uint kBookWords = kBookRects + kMaxBooks * kMostBookFrames * 2u;
FW_SHARED_CONST uint kBookLoops = 1u;   // BookRecord::flags

struct BookRecord {
    uint at;             // texel of the picture: x | y << 16, first frame's first texel
    uint size;           // width | height << 16 of a frame
    uint motionAt;       // the same of motion
    uint motionSize;
    uint frames;
    uint columns;        // frames of a row in the picture; of motion the same
    uint flags;
    float motionMost;    // uv per frame of a full motion texel
    float seconds;       // a turn
    uint at1; uint at2; uint at3;  // as `at`, of the frames at half the size, a quarter, an eighth;
                                   // 0: there are none
    uint reserved0; uint reserved1; uint reserved2; uint reserved3;
};
FW_SHARED_SIZE(BookRecord, 64)
FW_SHARED_CONST uint kBookLevels = 4u;
FW_SHARED_CONST uint kBookLevelWord = 8u;  // of the record: `at1` is the next one
// Level that a quad of so many pixels shows of frames of so many texels. `own`, [0, 1), of the quad:
// not all of a fire change at once as the eye goes away.
FW_SHARED_FN uint bookLevel(float texels, float pixels, float own) {
    float off = log2(max(texels / max(pixels, 1e-3f), 1.0f)) + 0.25f + 0.5f * own;
    return uint(min(off, float(kBookLevels - 1u)));
}
// Between frames of the picture lies a texel of nothing, so that what is read beyond a border is that.
FW_SHARED_FN uvec2 bookCell(BookRecord b, uint frame) {
    return uvec2((b.at & 0xFFFFu) + frame % b.columns * ((b.size & 0xFFFFu) + 2u),
                 (b.at >> 16) + frame / b.columns * ((b.size >> 16) + 2u));
}
FW_SHARED_FN uvec2 bookMotionCell(BookRecord b, uint frame) {
    return uvec2((b.motionAt & 0xFFFFu) + frame % b.columns * (b.motionSize & 0xFFFFu),
                 (b.motionAt >> 16) + frame / b.columns * (b.motionSize >> 16));
}

// A particle that is shown by a book: `life` [0, 1] of what it shows once; `age` s and `own` [0, 1)
// its phase in a loop.
FW_SHARED_FN float bookTime(bool loops, float seconds, float life, float age, float own) {
    return loops ? age / seconds + 7.0f * own : clamp(life, 0.0f, 1.0f);
}

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
