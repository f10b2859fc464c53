// Shared by the prediction passes: their buffers, times and gradients. Needs `predict`.

#include "lib/gradient.glsl"
#include "lib/object_quads.glsl"
FW_READ(OBJECTS) FW_READ(STATE) FW_READ_WRITE(GRADIENT) FW_PUSH(StepPush)

bool hasTime(uint p) { return p < kLiveEnd; }

// Difference quotient over +-2 texels along one axis, s per texel; 0 if neither side is known.
float slope(uint centreAt, uint at, uint size, uint stride, uint centre) {
    uint low = centre;
    uint high = centre;
    int before = 0;
    int after = 0;
    FW_UNROLL for (uint d = 1u; d <= 2u; ++d) {
        uint q = at >= d ? predict[centreAt - d * stride] : kNever;
        uint r = at + d < size ? predict[centreAt + d * stride] : kNever;
        if (hasTime(q)) {
            low = q;
            before = int(d);
        }
        if (hasTime(r)) {
            high = r;
            after = int(d);
        }
    }
    int span = before + after;
    return span == 0 ? 0.0 : float(int(high - low)) / (float(span) * float(kTicksPerSecond));
}

// As packGradient; keeps the soot.
uint gradientOf(uint at, uint x, uint y, uint width, uint height, uint now) {
    return packGradient(vec2(slope(at, x, width, 1u, now), slope(at, y, height, width, now))) |
           (gradient[at] & 0xFFu);
}

// A round reads the times of the round before and nothing that it writes, so the result does not
// depend on the order of threads. A changed texel's new time is stored in its gradient (24 bits,
// ticks from `push.now`) and the gradient is computed afterwards.
const uint kNoTimeNext = 0x80000000u;
uint packTimeNext(uint word, uint time) {
    int ticks = clamp(int(time - push.now), -0x7FFFFF, 0x7FFFFF);
    return (word & 0xFFu) | (hasTime(time) ? uint(ticks) << 8u : kNoTimeNext);
}
uint unpackTimeNext(uint word) {
    if ((word & ~0xFFu) == kNoTimeNext) return kNever;
    return min(push.now + uint(int(word) >> 8), kLiveEnd - 1u);
}

// Is this change large enough to update neighbours? Rings would chase rounding forever; the further
// ahead, the larger a change must be.
bool concernsOthers(uint before, uint now) {
    int ahead = max(int(now - push.now), 0);
    return !(hasTime(now) && hasTime(before) && abs(int(now - before)) <= 64 + ahead / 8);
}
