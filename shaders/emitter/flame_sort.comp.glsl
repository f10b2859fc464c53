// Sorts the quads that hide what is behind them, farthest first, of burning tiles and particles
// together. One group: few quads use a bitonic sort in shared memory, more a stable radix sort (a
// third of the work for 2,500 on a software device). Emissive quads may come in any order:
// placeLights interleaves them.
#define FW_THREADS 128
#include "lib/compute.glsl"
#include "lib/view.glsl"
FW_READ(FLAMES) FW_READ_WRITE(DRAW_ARGS) FW_PUSH(SortPush)

const uint kThreads = FW_THREADS, kDigits = 16u;
const uint kDepthBits = 16u;  // of a radix key, above the number of its quad
const uint kMarks = 1024u;    // depths among which an emissive quad finds its place

shared uint keys[(kDigits + 1u) * kThreads];
shared uint nearest, farthest;  // bits of depths: positive floats sort like their bits

// Words of one half of the sort's scratch.
uint half_() { return push.tiles + push.particles + push.lights; }
// Buffer place of the i-th quad that hides.
uint placeOf(uint i, uint tiles) { return i < tiles ? i : push.tiles + (i - tiles); }
float depthOf(uint place) {
    vec3 d = flameQuad[place].baseHeight.xyz +
             flameQuad[place].axisWidth.xyz * (0.5 * flameQuad[place].baseHeight.w) - view.eye.xyz;
    return clamp(dot(d, view.forward.xyz), 0.0, 1e6);
}

// Is quad a drawn before b of the same depth? Buffer places depend on thread order and would change
// the picture from run to run. Equal quads keep their order.
bool before(uint a, uint b) {
    uint kindA = flameQuad[a].kind, kindB = flameQuad[b].kind;
    if (kindA != kindB) return kindA < kindB;
    uvec3 at = floatBitsToUint(flameQuad[a].baseHeight.xyz);
    uvec3 other = floatBitsToUint(flameQuad[b].baseHeight.xyz);
    if (at.x != other.x) return at.x < other.x;
    if (at.y != other.y) return at.y < other.y;
    return at.z != other.z ? at.z < other.z : a < b;
}
const uint kMaxTies = 64u;  // quads of one depth that are compared; more keep their places

// Writes the places of sorted quads from `to` on, with ties ordered by before().
#define FW_ORDER_TIES(depthAt, placeAt, to)                                                       \
    for (uint i = me; i < count; i += kThreads) {                                                 \
        uint depth = depthAt(i), place = placeAt(i), first = i, end = i + 1u, at = 0u;            \
        while (first > 0u && depthAt(first - 1u) == depth && i - first < kMaxTies) --first;       \
        while (end < count && depthAt(end) == depth && end - first <= kMaxTies) ++end;            \
        bool few = end - first <= kMaxTies;                                                       \
        for (uint k = first; few && k < end; ++k)                                                 \
            at += k != i && before(placeAt(k), place) ? 1u : 0u;                                  \
        drawArgs[(to) + (few ? first + at : i)] = place;                                          \
    }

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
#define FW_DEPTH(i) (keys[i] >> 12u)
#define FW_PLACE(i) placeOf(keys[i] & 0xFFFu, tiles)
    FW_ORDER_TIES(FW_DEPTH, FW_PLACE, kFlameOrder)
#undef FW_DEPTH
#undef FW_PLACE
}

// 16 bits of the depth range, but at most 12 bits of mantissa, so that close quads do not swap from
// frame to frame. Four bits per pass; each thread keeps a run in order.
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
        syncBuffers();
        for (uint j = 0u; j < each; ++j) {
            uint i = begin + j;
            uint digit = drawArgs[from + min(i, count - 1u)] >> shift & 15u;
            if (i < end) ++keys[digit * kThreads + me];
        }
        barrier();
        // Exclusive sums: all smaller digits, and the same digit of earlier threads.
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
        FW_SUM_UP(keys, sums, me)
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
    syncBuffers();
#define FW_DEPTH(i) (drawArgs[kFlameOrder + (i)] >> kDepthBits)
#define FW_PLACE(i) placeOf(drawArgs[kFlameOrder + (i)] & 0xFFFFu, tiles)
    FW_ORDER_TIES(FW_DEPTH, FW_PLACE, kFlameOrder + other)
#undef FW_DEPTH
#undef FW_PLACE
    syncBuffers();
    for (uint i = me; i < count; i += kThreads)
        drawArgs[kFlameOrder + i] = drawArgs[kFlameOrder + other + i];
}

// Places each emissive quad before all hiding quads that are not farther away: after those behind
// it, so that quads in front attenuate it. With more than kMarks hiding quads, a run of them counts
// as one depth.
void placeLights(uint me, uint hiding, uint lights) {
    uint first = push.tiles + push.particles, work = kFlameOrder + half_();
    if (hiding == 0u) {
        for (uint i = me; i < lights; i += kThreads) drawArgs[kFlameOrder + i] = first + i;
        return;
    }
    uint run = (hiding + kMarks - 1u) / kMarks, marks = (hiding + run - 1u) / run;
    syncBuffers();
    // keys: depths of the marks, farthest first, then the number of emissive quads before each mark
    // and at the end.
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
    // Inclusive sums.
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
    syncBuffers();
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
    uint tiles = min(drawArgs[kFlameTileQuads], min(push.tiles, view.flameCapacity));
    uint hiding = tiles + min(drawArgs[kFlameParticleQuads], push.particles);
    uint lights = min(drawArgs[kFlameEmissiveQuads], push.lights);
    if (hiding <= push.few)  // gpu/passes/draw_order.h decides
        sortFew(me, hiding, tiles);
    else
        sortMany(me, hiding, tiles);
    if (lights > 0u) placeLights(me, hiding, lights);
    uint count = hiding + lights;
    syncBuffers();
    if (me == 0u) {
        drawArgs[0] = 6u * count;  // vertices
        drawArgs[1] = 1u;
        drawArgs[2] = drawArgs[3] = 0u;
        drawArgs[kFlameEmissiveDraw] = 6u * lights;
        drawArgs[kFlameEmissiveDraw + 1u] = 1u;
        drawArgs[kFlameEmissiveDraw + 2u] = 6u * (push.tiles + push.particles);
        drawArgs[kFlameEmissiveDraw + 3u] = 0u;
    }
}
