// Orders the quads of a view that hide what is behind them, farthest first: burning tiles' and
// particles' together, or one would show through the other. One group: a bitonic sort in shared
// memory of few of them, of more a radix sort, which is stable, and on a software device a third of
// the work for 2,500. What emits alone may come in any order: it is not sorted, but laid where those
// that hide leave it, see layLights.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 128) in;
#include "shared/burn.h"
#include "shared/look.h"
layout(std430, set = 0, binding = FW_BIND_FLAMES) readonly buffer FlamesBuffer {
    FlameQuad flameQuad[];
};
layout(std430, set = 0, binding = FW_BIND_DRAW_ARGS) buffer ArgsBuffer { uint drawArgs[]; };
layout(set = 0, binding = FW_BIND_VIEW, std140) uniform View { ViewParams view; };
layout(push_constant) uniform Push { SortPush push; };

const uint kThreads = 128u, kDigits = 16u;
const uint kDepthBits = 16u;  // of a key of many, above the number of its quad
const uint kMarks = 1024u;    // depths among which what emits alone looks for its own

shared uint keys[(kDigits + 1u) * kThreads];
shared uint nearest, farthest;  // bits of depths: positive floats sort as their bits do

// Of the words that the sort works in.
uint half_() { return push.tiles + push.particles + push.lights; }
// Of the i-th quad that hides.
uint placeOf(uint i, uint tiles) { return i < tiles ? i : push.tiles + (i - tiles); }
float depthOf(uint place) {
    vec3 d = flameQuad[place].baseHeight.xyz +
             flameQuad[place].axisWidth.xyz * (0.5 * flameQuad[place].baseHeight.w) - view.eye.xyz;
    return clamp(dot(d, view.forward.xyz), 0.0, 1e6);
}

// Whether quad a is drawn before b of the same depth: their places are those of threads that happened to be
// first, and would change the picture from run to run. Equal quads keep the order of their places.
bool before(uint a, uint b) {
    uint kindA = flameQuad[a].kind, kindB = flameQuad[b].kind;
    if (kindA != kindB) return kindA < kindB;
    uvec3 at = floatBitsToUint(flameQuad[a].baseHeight.xyz);
    uvec3 other = floatBitsToUint(flameQuad[b].baseHeight.xyz);
    if (at.x != other.x) return at.x < other.x;
    if (at.y != other.y) return at.y < other.y;
    return at.z != other.z ? at.z < other.z : a < b;
}
const uint kMostTies = 64u;  // of one depth that are compared with each other; more keep their places

void sortFew(uint me, uint count, uint tiles) {
    uint size = 2u;
    while (size < count) size <<= 1u;
    for (uint i = me; i < size; i += kThreads) {
        uint key = 0xFFFFFFFFu;
        if (i < count) {
            // 12 mantissa bits are 1 part in 4000.
            uint depth = floatBitsToUint(depthOf(placeOf(i, tiles)));
            key = (0xFFFFFu - (depth >> 11u & 0xFFFFFu)) << 12u | i;
        }
        keys[i] = key;
    }
    barrier();
    for (uint block = 2u; block <= size; block <<= 1u) {
        for (uint step = block >> 1u; step > 0u; step >>= 1u) {
            for (uint k = me; k < size / 2u; k += kThreads) {
                uint i = 2u * k - (k & (step - 1u)), j = i + step;
                uint low = keys[i], high = keys[j];
                bool ascending = (i & block) == 0u;
                if ((low > high) == ascending) {
                    keys[i] = high;
                    keys[j] = low;
                }
            }
            barrier();
        }
    }
    for (uint i = me; i < count; i += kThreads) {
        uint depth = keys[i] >> 12u, place = placeOf(keys[i] & 0xFFFu, tiles), at = 0u;
        uint first = i, end = i + 1u;
        while (first > 0u && keys[first - 1u] >> 12u == depth && i - first < kMostTies) --first;
        while (end < count && keys[end] >> 12u == depth && end - first <= kMostTies) ++end;
        if (end - first > kMostTies) {
            drawArgs[kFlameOrder + i] = place;
            continue;
        }
        for (uint k = first; k < end; ++k)
            at += k != i && before(placeOf(keys[k] & 0xFFFu, tiles), place) ? 1u : 0u;
        drawArgs[kFlameOrder + first + at] = place;
    }
}

// Of the depths that there are 16 bits, but no more than 12 of a mantissa, or quads in one place would
// change places with each other from frame to frame. Four bits a turn; each thread keeps a run in order.
void sortMany(uint me, uint count, uint tiles) {
    uint other = half_(), each = (count + kThreads - 1u) / kThreads;
    uint begin = me * each, end = min(begin + each, count);
    if (me == 0u) {
        nearest = 0xFFFFFFFFu;
        farthest = 0u;
    }
    barrier();
    uint low = 0xFFFFFFFFu, high = 0u;
    for (uint i = begin; i < end; ++i) {
        uint depth = floatBitsToUint(depthOf(placeOf(i, tiles)));
        drawArgs[kFlameOrder + i] = depth;
        low = min(low, depth);
        high = max(high, depth);
    }
    atomicMin(nearest, low);
    atomicMax(farthest, high);
    barrier();
    uint least = nearest, most = farthest;
    uint spare = uint(max(findMSB(most - least) + 1 - int(kDepthBits), 11));
    for (uint i = begin; i < end; ++i) {
        uint near = (most - drawArgs[kFlameOrder + i]) >> spare;
        drawArgs[kFlameOrder + i] = near << kDepthBits | i;
    }
    for (uint turn = 0u; turn < 4u; ++turn) {
        uint from = kFlameOrder + (turn & 1u) * other, to = kFlameOrder + (~turn & 1u) * other;
        uint shift = kDepthBits + 4u * turn;
        for (uint d = 0u; d < kDigits; ++d) keys[d * kThreads + me] = 0u;
        memoryBarrierBuffer();
        barrier();
        for (uint j = 0u; j < each; ++j) {
            uint i = begin + j;
            uint digit = drawArgs[from + min(i, count - 1u)] >> shift & 15u;
            if (i < end) ++keys[digit * kThreads + me];
        }
        barrier();
        // How many come before each: of smaller digits all, of its own those of threads before.
        uint sum = 0u;
        for (uint d = 0u; d < kDigits; ++d) {
            uint here = me * kDigits + d;
            uint found = keys[here];
            keys[here] = sum;
            sum += found;
        }
        uint sums = kDigits * kThreads;
        keys[sums + me] = sum;
        barrier();
        for (uint reach = 1u; reach < kThreads; reach <<= 1u) {
            uint more = me >= reach ? keys[sums + me - reach] : 0u;
            barrier();
            keys[sums + me] += more;
            barrier();
        }
        uint before = keys[sums + me] - sum;
        for (uint d = 0u; d < kDigits; ++d) keys[me * kDigits + d] += before;
        barrier();
        for (uint j = 0u; j < each; ++j) {
            uint i = begin + j;
            if (i >= end) continue;
            uint key = drawArgs[from + i];
            uint at = (key >> shift & 15u) * kThreads + me;
            uint place = keys[at];
            keys[at] = place + 1u;
            drawArgs[to + place] = key;
        }
    }
    memoryBarrierBuffer();
    barrier();
    for (uint i = me; i < count; i += kThreads) {
        uint key = drawArgs[kFlameOrder + i], depth = key >> kDepthBits;
        uint place = placeOf(key & 0xFFFFu, tiles), first = i, end = i + 1u, at = 0u;
        while (first > 0u && drawArgs[kFlameOrder + first - 1u] >> kDepthBits == depth &&
               i - first < kMostTies)
            --first;
        while (end < count && drawArgs[kFlameOrder + end] >> kDepthBits == depth &&
               end - first <= kMostTies)
            ++end;
        if (end - first > kMostTies) {
            drawArgs[kFlameOrder + other + i] = place;
            continue;
        }
        for (uint k = first; k < end; ++k)
            at += k != i && before(placeOf(drawArgs[kFlameOrder + k] & 0xFFFFu, tiles), place)
                      ? 1u : 0u;
        drawArgs[kFlameOrder + other + first + at] = place;
    }
    memoryBarrierBuffer();
    barrier();
    for (uint i = me; i < count; i += kThreads)
        drawArgs[kFlameOrder + i] = drawArgs[kFlameOrder + other + i];
}

// What emits alone goes before all that hide from no farther away than itself: after those behind it,
// so that it shows through what is before it as much as that lets through. With more than kMarks that
// hide, those of a run count as one. `hiding` lie in their order.
void layLights(uint me, uint hiding, uint lights) {
    uint first = push.tiles + push.particles, work = kFlameOrder + half_();
    if (hiding == 0u) {
        for (uint i = me; i < lights; i += kThreads) drawArgs[kFlameOrder + i] = first + i;
        return;
    }
    uint run = (hiding + kMarks - 1u) / kMarks, marks = (hiding + run - 1u) / run;
    memoryBarrierBuffer();
    barrier();
    // keys: depths of the marks, farthest first, then how many come before each, and behind all.
    for (uint g = me; g < marks; g += kThreads)
        keys[g] = floatBitsToUint(depthOf(drawArgs[kFlameOrder + g * run]));
    for (uint g = me; g <= marks; g += kThreads) keys[kMarks + g] = 0u;
    for (uint i = me; i < hiding; i += kThreads) drawArgs[work + i] = drawArgs[kFlameOrder + i];
    barrier();
    for (uint i = me; i < lights; i += kThreads) {
        uint depth = floatBitsToUint(depthOf(first + i)), low = 0u, high = marks;
        while (low < high) {
            uint middle = (low + high) >> 1u;
            bool behind = keys[middle] > depth;
            low = behind ? middle + 1u : low;
            high = behind ? high : middle;
        }
        drawArgs[work + hiding + i] = low << 17u | atomicAdd(keys[kMarks + low], 1u);
    }
    barrier();
    // Sums of all up to each.
    for (uint reach = 1u; reach <= marks; reach <<= 1u) {
        uint sums[kMarks / kThreads + 1u];
        uint own = 0u;
        for (uint g = me; g <= marks; g += kThreads)
            sums[own++] = keys[kMarks + g] + (g >= reach ? keys[kMarks + g - reach] : 0u);
        barrier();
        own = 0u;
        for (uint g = me; g <= marks; g += kThreads) keys[kMarks + g] = sums[own++];
        barrier();
    }
    memoryBarrierBuffer();
    barrier();
    for (uint i = me; i < hiding; i += kThreads)
        drawArgs[kFlameOrder + i + keys[kMarks + i / run]] = drawArgs[work + i];
    for (uint i = me; i < lights; i += kThreads) {
        uint found = drawArgs[work + hiding + i], gap = found >> 17u;
        uint before = gap > 0u ? keys[kMarks + gap - 1u] : 0u;
        drawArgs[kFlameOrder + min(gap * run, hiding) + before + (found & 0x1FFFFu)] = first + i;
    }
}

void main() {
    uint me = gl_LocalInvocationID.x;
    uint tiles = min(drawArgs[kFlameTiles], min(push.tiles, view.flameCapacity));
    uint hiding = tiles + min(drawArgs[kFlameParticles], push.particles);
    uint lights = min(drawArgs[kFlameLights], push.lights);
    if (hiding <= push.few)  // gpu/passes/draw_order.h decides
        sortFew(me, hiding, tiles);
    else
        sortMany(me, hiding, tiles);
    if (lights > 0u) layLights(me, hiding, lights);
    uint count = hiding + lights;
    memoryBarrierBuffer();
    barrier();
    if (me == 0u) {
        drawArgs[0] = 6u * count;  // vertices
        drawArgs[1] = 1u;
        drawArgs[2] = drawArgs[3] = 0u;
        drawArgs[kFlameLightDraw] = 6u * lights;
        drawArgs[kFlameLightDraw + 1u] = 1u;
        drawArgs[kFlameLightDraw + 2u] = 6u * (push.tiles + push.particles);
        drawArgs[kFlameLightDraw + 3u] = 0u;
    }
}
