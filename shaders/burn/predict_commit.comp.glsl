// Ends a prediction round: first the new times of the gathered rows and the fire's distance to wet
// texels; then, from times that no thread writes any more, the gradients. One thread per row.
#include "lib/compute.glsl"
FW_READ(COUNTERS) FW_READ(SCRATCH_QUADS) FW_READ_WRITE(PREDICT)
#include "lib/predict.glsl"

void writeTimes(uint at, uint changed, uint wet) {
    for (; changed != 0u; changed &= changed - 1u) {
        uint i = at + uint(findLSB(changed));
        uint known = state[i];
        predict[i] = known == kNever ? unpackTimeNext(gradient[i]) : known;
    }
    for (; wet != 0u; wet &= wet - 1u) {
        uint i = at + uint(findLSB(wet));
        gradient[i] = aheadTurned(gradient[i]);
    }
}

void main() {
    uint count = counters[kRowPredict + push.predictParity].workCount;
    for (uint work = gl_GlobalInvocationID.x; work < count; work += gl_NumWorkGroups.x * 64u) {
        uvec4 item = scratchQuads[work];
        uint changed = item.y >> 8u & 0xFFu, wet = item.y >> 16u & 0xFFu;
        if ((changed | wet) == 0u) continue;
        uvec4 bases = objectBases(item.w);
        uint at = bases.y + item.z;
        if (push.iteration == 0u) {
            writeTimes(at, changed, wet);
            continue;
        }
        uint y = divide(item.z, bases.w), x = item.z - y * bases.w;
        uint height = objectSizes(item.w).y;
        for (; changed != 0u; changed &= changed - 1u) {
            uint i = uint(findLSB(changed)), time = predict[at + i];
            gradient[at + i] = hasTime(time) ? gradientOf(at + i, x + i, y, bases.w, height, time)
                                   : gradient[at + i] & 0xFFu;
        }
    }
}
