// Front kernel: when a texel catches fire from the eight texels of its ring. Integers only, for C++
// and GLSL. It accesses no buffer. Lists and tiles are driven by shaders/burn and runtime/gpu/cpu.
//
// Slowness along a unit vector v is A * (1 - e.v), exactly an ellipse. Times inside the kernel are
// 1/16 tick after the earliest counting source of the ring.
// clang-format off
#ifndef FW_SHARED_FRONT_H
#define FW_SHARED_FRONT_H
#include "shared/burn.h"
#include "shared/types.h"


FW_SHARED_BEGIN

// Ring order: counter-clockwise from +x, odd = diagonal (as mesh::kRingX).

FW_CONST int kFrontTimeMax = 0x1FFFFFFF;   // of one link, 1/16 ticks: 2.3 h
FW_CONST uint kFrontDelayMax = 0x1FFFFFFu; // between sources of a ring, ticks: 2.3 h
FW_CONST uint kFrontEpsMax = 16200u;       // Q14: head/back slowness ratio 178
FW_CONST uint kDriveLimit = 65000u;        // |drive|, Q10
// TileState::lastChange of a tile that never changed.
FW_CONST uint kNeverChanged = 0x80000000u;

struct FrontDrive {  // slowness of one texel: A * (1 - e.v)
    uint A;         // Q22 ticks per 1/8 position unit
    ivec3 e;        // Q14
};

struct FrontRing {  // the ring of a texel
    uint tick[8];   // states
    ivec3 link[8];  // own position minus theirs, position units; counting sources only
    uint burn[8];   // ticks that they flame, kNoneTexel: unlimited; counting sources only
};

// Can a texel with these material flags (texel word >> 16) burn?
FW_FN bool canTexelBurn(uint materialFlags, uint slowness, uint burnFlags) {
    return (materialFlags & kTexelReal) != 0u && slowness != 0u && (burnFlags & 1u) != 0u;
}

// Does a texel of state t flame at tick `now`?
FW_FN bool flames(uint t, uint now, uint flameTicks) {
    return isSource(t) && t <= now && (flameTicks == kNoneTexel || now - t < flameTicks);
}

// Modulo 2^32: exact while the sum fits, and never undefined.
FW_FN uint squaredLength(ivec3 a) {
    return uint(a.x) * uint(a.x) + uint(a.y) * uint(a.y) + uint(a.z) * uint(a.z);
}
FW_FN int dotInt(ivec3 a, ivec3 b) {
    return int(uint(a.x) * uint(b.x) + uint(a.y) * uint(b.y) + uint(a.z) * uint(b.z));
}

// Nearest integer to the root of n, n < 2^32 - 2^17. The float seed may be off by one; integers
// correct it.
FW_FN uint isqrtNear(uint n) {
    uint r = uint(sqrt(float(n)));
    uint square = r * r;
    uint rest = n - square;
    if (square > n) {
        r -= 1u;
        rest += 2u * r + 1u;
    }
    if (rest > 2u * r) {
        rest -= 2u * r + 1u;
        r += 1u;
    }
    return rest > r ? r + 1u : r;
}

// (a * b) >> s, 0 < s < 32; saturates.
FW_FN uint mulShift(uint a, uint b, uint s) {
    uint high, low;
    umulExtended(a, b, high, low);
    return (high >> s) != 0u ? 0xFFFFFFFFu : ((high << (32u - s)) | (low >> s));
}
// (a * b) >> 32, rounded.
FW_FN uint mulHighRound(uint a, uint b) {
    uint high, low;
    umulExtended(a, b, high, low);
    return high + (low >> 31u);
}

// Signed 11:11:10 (1023, 1023, 511 = 1) to Q14.
FW_FN ivec3 decodeNormal(uint packedNormal) {
    int x = int(packedNormal << 21u) >> 21;
    int y = int(packedNormal << 10u) >> 21;
    int z = int(packedNormal) >> 22;
    return ivec3((x * 16400 + 512) >> 10, (y * 16400 + 512) >> 10, (z * 32832 + 512) >> 10);
}

FW_FN ivec3 decodePosition(uvec2 texel) {
    return ivec3(int(texel.x & 0xFFFFu), int(texel.x >> 16u), int(texel.y & 0xFFFFu));
}

// Spread law at one texel. normal: Q14; noise: Q7 slowness factor, not 0.
FW_FN FrontDrive prepareFront(ivec3 normal, uint noise, FW_IN(BurnMaterial) m) {
    FrontDrive p;
    ivec3 drive = ivec3(m.driveX, m.driveY, m.driveZ);
    ivec3 n12 = ivec3(normal.x >> 2, normal.y >> 2, normal.z >> 2);
    uint s0 = mulShift(m.sigma0, noise, 7u);
    if (m.ceiling != 0u) {
        // Q10.
        int down =
            -(dotInt(ivec3(int(m.upCeiling.x), int(m.upCeiling.y), int(m.upCeiling.z)), n12) >> 12);
        if (down > 0) {
            uint faster = 1024u + ((m.ceiling * uint(down < 1024 ? down : 1024)) >> 8u);
            s0 = mulShift(s0, divide(1u << 30u, faster), 20u);
        }
    }
    p.A = s0;
    p.e = ivec3(0, 0, 0);
    if ((m.driveX | m.driveY | m.driveZ) == 0) return p;
    int along = dotInt(drive, n12) >> 12;
    ivec3 u = ivec3(drive.x - ((along * normal.x + 8192) >> 14),
                    drive.y - ((along * normal.y + 8192) >> 14),
                    drive.z - ((along * normal.z + 8192) >> 14));
    uint s = isqrtNear(squaredLength(u));
    uint capped = s < m.driveMax ? s : m.driveMax;
    uint head = 1024u + ((m.headGain * capped) >> 8u);  // Q10
    uint back = 1024u + ((m.backGain * s) >> 8u);
    uint slowHead = mulShift(s0, divide(1u << 30u, head), 20u);
    uint slowBack = mulShift(s0, back, 10u);
    uint slowest = mulShift(slowHead, m.breadthMax, 8u);
    slowBack = slowBack < slowest ? slowBack : slowest;
    p.A = (slowHead >> 1u) + (slowBack >> 1u) + (slowHead & slowBack & 1u);
    if (s > 0u && slowBack > slowHead) {
        uint d = slowBack - slowHead;
        uint t = (slowBack >> 1u) + (slowHead >> 1u);
        while (d >= (1u << 18u)) {
            d >>= 1u;
            t >>= 1u;
        }
        uint eps = divide(d << 13u, t > 0u ? t : 1u);  // Q14: d / (2t)
        eps = eps < kFrontEpsMax ? eps : kFrontEpsMax;
        uint perUnit = divide(eps << 14u, s);  // Q14, |u| <= s
        p.e = ivec3(int(uint(u.x) * perUnit + 8192u) >> 14, int(uint(u.y) * perUnit + 8192u) >> 14,
                    int(uint(u.z) * perUnit + 8192u) >> 14);
    }
    return p;
}

// Travel time, 1/16 ticks, over a link in 1/8 units. square, along: the link's square and its
// product with p.e.
FW_FN int travelTime(uint square, uint along, FW_IN(FrontDrive) p) {
    int y = int((isqrtNear(square) << 14u) - along);
    uint t = mulHighRound(p.A, uint(y > 0 ? y : 0));
    return int(t < uint(kFrontTimeMax) ? t : uint(kFrontTimeMax));
}
// link8: own position minus the source's, 1/8 units.
FW_FN int linkCost(ivec3 link8, FW_IN(FrontDrive) p) {
    return travelTime(squaredLength(link8), uint(dotInt(link8, p.e)), p);
}

// Start time of fire at the point between two sources: a with weight w/64, b with the rest.
FW_FN int pairStart(int ra, int rb, int w) {
    int dr = ra - rb;
    return rb + (dr >> 6) * w + (((dr & 63) * w + 32) >> 6);
}

// Slope of the travel time from source a to source b, 1/16 ticks over the whole distance.
// Arrival is convex along it: if the slope does not outweigh the delay of b, a alone is best. l:
// length of a, 1/8 units.
FW_CONST int kPairFalls = -0x7FFFFFFF;  // for any delay
FW_FN int pairChange(ivec3 a, ivec3 b, uint l, FW_IN(FrontDrive) p) {
    ivec3 side = ivec3(b.x - a.x, b.y - a.y, b.z - a.z);
    if (l == 0u) return kPairFalls;
    // Change of distance over the whole segment at this rate: side . a / |a|, in whole units.
    int along = int(uint(dotInt(side, a)) * 8u);
    int stretch = int(divide(uint(along < 0 ? -along : along), l));
    stretch = along < 0 ? -stretch : stretch;
    int y = int((uint(stretch) << 16u) - (uint(dotInt(side, p.e)) << 2u));  // Q13 of 1/8 units
    uint t = mulHighRound(p.A, uint(y < 0 ? -y : y));
    int change = int(t < 0x0FFFFFFFu ? t : 0x0FFFFFFFu) * 2;
    return y < 0 ? -change : change;
}

// Best arrival over the segment between two sources: three weights, one parabola step, one more.
// The ends cost ga and gb.
FW_FN int bestOfPair(int ra, int rb, int ga, int gb, ivec3 a, ivec3 b, FW_IN(FrontDrive) p) {
    // The link from weight w is b + (a - b) w/64: squares and products follow from three each.
    ivec3 d = ivec3(a.x - b.x, a.y - b.y, a.z - b.z);
    uint bb = squaredLength(b) * 64u, bd = uint(dotInt(b, d)) * 32u, dd = squaredLength(d) * 4u;
    uint be = uint(dotInt(b, p.e)) * 8u, de = uint(dotInt(d, p.e)) * 2u;
    int g1 = pairStart(ra, rb, 16) + travelTime(bb + bd + dd, be + de, p);
    int g2 = pairStart(ra, rb, 32) + travelTime(bb + bd * 2u + dd * 4u, be + de * 2u, p);
    int g3 = pairStart(ra, rb, 48) + travelTime(bb + bd * 3u + dd * 9u, be + de * 3u, p);
    int best = g1 < g2 ? g1 : g2;
    best = g3 < best ? g3 : best;
    int lo, mid, hi, w;
    if (g2 <= g1 && g2 <= g3) {
        lo = g1; mid = g2; hi = g3; w = 32;
    } else if (g1 < g3) {
        lo = gb; mid = g1; hi = g2; w = 16;
    } else {
        lo = g2; mid = g3; hi = ga; w = 48;
    }
    int den = (lo - mid) + (hi - mid);
    int num = lo - hi;
    if (den > 0 && num != 0) {
        int size = num < 0 ? -num : num;
        if (size >= (1 << 26)) {
            size >>= 6;
            den = (den >> 6) + 1;
        }
        int off = int(divide(uint(size) * 8u, uint(den)));  // num/den * half a step of 16
        off = off > 15 ? 15 : off;
        off = num < 0 ? -off : off;
        if (off != 0) {
            int weight = w + off;
            ivec3 link8 =
                ivec3(b.x * 8 + ((weight * d.x + 4) >> 3), b.y * 8 + ((weight * d.y + 4) >> 3),
                      b.z * 8 + ((weight * d.z + 4) >> 3));
            int g = pairStart(ra, rb, weight) + linkCost(link8, p);
            best = g < best ? g : best;
        }
    }
    return best;
}

// Sources of the ring that count: burning by the window's end, and not diagonals cut off by two
// barriers. Bit k of `present`: the ring has a k-th texel. `wake` is lowered to the tick of a
// coming source; it matters for receptive texels only, here and in frontArrival.
FW_FN uint countingSources(FW_IN(FrontRing) ring, uint present, uint windowEnd,
                           FW_INOUT(uint) wake) {
    uint counts = 0u, walls = 0u;
    FW_UNROLL for (int k = 0; k < 8; ++k) {
        uint t = ring.tick[k];
        if (isSource(t)) {
            if (t <= windowEnd) counts |= 1u << uint(k);
            else wake = t < wake ? t : wake;
        } else if (isBarrier(t)) {
            walls |= 1u << uint(k);
        }
    }
    walls &= present;  // a missing link must not cut a diagonal
    uint cut = (walls << 1u) & (walls >> 1u) & 0x2Au;
    if ((walls & 0x41u) == 0x41u) cut |= 0x80u;
    return counts & ~cut;
}

// One of eight by selects: cheaper on devices that would index an array in memory.
#ifdef __cplusplus
inline int pick(const int (&of)[8], int k) { return of[k]; }
inline ivec3 pickLink(const FrontRing& ring, int k) { return ring.link[k]; }
#else
#define FW_PICK4(of, k, i)                                             \
    (((k) & 2) == 0 ? (((k) & 1) == 0 ? of(i) : of((i) + 1))           \
                    : (((k) & 1) == 0 ? of((i) + 2) : of((i) + 3)))
#define FW_PICK(of, k) (((k) & 4) == 0 ? FW_PICK4(of, k, 0) : FW_PICK4(of, k, 4))
int pick(int of[8], int k) {
#define FW_ONE(i) of[i]
    return FW_PICK(FW_ONE, k);
#undef FW_ONE
}
ivec3 pickLink(FrontRing ring, int k) {
#define FW_ONE(i) ring.link[i]
    return FW_PICK(FW_ONE, k);
#undef FW_ONE
}
#endif

// Arrival tick from the counting sources; kNever if none is left. A source that burnt out before it
// could light this texel is dropped. `wake` is then lowered to the tick after which it cannot count
// again under another wind: until then the texel's tile stays listed. settles: also computes
// `settledFrom`, the tick from which another source of this ring would not change the result;
// kNever: unknown. It needs all eight links.
FW_FN uint frontArrival(FW_IN(FrontRing) ring, uint counts, FW_IN(FrontDrive) p, uint windowMax,
                        uint windowEnd, uint floorTick, uint texel, bool settles,
                        FW_INOUT(uint) wake, FW_INOUT(uint) settledFrom) {
    int cost[8];
    uint base = kNever;
    FW_UNROLL for (int k = 0; k < 8; ++k) {
        bool counting = (counts & (1u << uint(k))) != 0u;
        if (counting || settles) {
            ivec3 l = ring.link[k];
            cost[k] = linkCost(ivec3(l.x * 8, l.y * 8, l.z * 8), p);
        }
        if (counting) {
            uint t = ring.tick[k];
            uint end = ring.burn[k] != kNoneTexel ? t + ring.burn[k] : kNever;
            uint reach = t + (uint(cost[k] + 8) >> 4u);
            if (end < (reach > floorTick ? reach : floorTick)) {
                counts &= ~(1u << uint(k));
                uint hold = end + windowMax + 1u;
                if (hold > windowEnd) wake = hold < wake ? hold : wake;
            } else {
                base = t < base ? t : base;
            }
        }
    }
    if (counts == 0u) return kNever;
    int rel[8];
    int best = 0x7FFFFFFF;
    int bestK = 0;
    int idle = 0x3FFFFFFF;  // least cost of those that do not count
    FW_UNROLL for (int k = 0; k < 8; ++k) {
        if ((counts & (1u << uint(k))) != 0u) {
            uint delay = ring.tick[k] - base;
            rel[k] = int(delay < kFrontDelayMax ? delay : kFrontDelayMax) * 16;
            cost[k] += rel[k];
            if (cost[k] < best) {
                best = cost[k];
                bestK = k;
            }
        } else {
            rel[k] = 0;
            if (settles) idle = cost[k] < idle ? cost[k] : idle;
        }
    }
    int hop = best;
    bool hasC = (counts & (1u << uint((bestK + 1) & 7))) != 0u;
    bool hasA = (counts & (1u << uint((bestK + 7) & 7))) != 0u;
    int c = hasC || settles ? (bestK + 1) & 7 : bestK;
    int a = hasA || settles ? (bestK + 7) & 7 : bestK;
    int relB = pick(rel, bestK), relC = pick(rel, c), relA = pick(rel, a);
    ivec3 linkB = pickLink(ring, bestK), linkC = pickLink(ring, c), linkA = pickLink(ring, a);
    uint l = isqrtNear(squaredLength(linkB) * 64u);
    int changeC = hasC || settles ? pairChange(linkB, linkC, l, p) : 0;
    int changeA = hasA || settles ? pairChange(linkB, linkA, l, p) : 0;
    bool byC = hasC && changeC < relB - relC;
    bool byA = hasA && changeA < relB - relA;
    if (settles && hop < (1 << 28)) {
        // Another source would have to be the best hop, or to make a pair with it.
        int bound = hop - idle + 1;
        int soonC = relB - (changeC > -(1 << 29) ? changeC : -(1 << 29));
        int soonA = relB - (changeA > -(1 << 29) ? changeA : -(1 << 29));
        bound = !hasC && soonC > bound ? soonC : bound;
        bound = !hasA && soonA > bound ? soonA : bound;
        int ticks = (bound + 15) >> 4;
        uint before = uint(ticks < 0 ? -ticks : 0);
        settledFrom = ticks >= 0 ? base + uint(ticks) : base - (before < base ? before : base);
    }
    if (byC) {
        int g = bestOfPair(relB, relC, hop, pick(cost, c), linkB, linkC, p);
        best = g < best ? g : best;
    }
    if (byA) {
        int g = bestOfPair(relB, relA, hop, pick(cost, a), linkB, linkA, p);
        best = g < best ? g : best;
    }
    // Hashed rounding: whole ticks would bias fast fires.
    return base + (uint(best + int(hash32(texel) & 15u)) >> 4u);
}

FW_FN uint windowFloor(uint now, uint window) { return now > window ? now - window : 0u; }

// May this texel still change? It is receptive, or young enough for a correction.
FW_FN bool isFrontEligible(uint t, uint floorTick) {
    return isReceptive(t) || (isSource(t) && (t > floorTick || floorTick == 0u));
}

// State after candidate tick `candidate`: the new tick, or t. `wake` is lowered to a pending
// arrival. late: 1 if the candidate came too late and was moved to the window's floor.
FW_FN uint decideTick(uint t, uint candidate, uint windowEnd, uint floorTick, FW_INOUT(uint) wake,
                      FW_OUT(uint) late) {
    late = 0u;
    bool fresh = isReceptive(t);
    if (candidate == kNever || (!fresh && candidate >= t)) return t;
    if (candidate > windowEnd) {
        if (fresh) wake = candidate < wake ? candidate : wake;
        return t;
    }
    if (candidate < floorTick) {
        if (!fresh && floorTick >= t) return t;
        candidate = floorTick;
        late = 1u;
    }
    return candidate;
}

// Iteration k of a step (2^stepShift iterations). An object with fewer substeps (`shift`) runs in
// every 2^(stepShift - shift)-th iteration.
FW_FN bool runsInIteration(uint k, uint stepShift, uint shift) {
    uint skip = stepShift - (shift < stepShift ? shift : stepShift);
    return (k & ((1u << skip) - 1u)) == 0u;
}
FW_FN uint windowTicks(uint stepShift, uint shift) {
    return kStepTicks >> (shift < stepShift ? shift : stepShift);
}

// End tick of the window of iteration k for an object with `shift`.
FW_FN uint iterationEnd(uint stepNow, uint k, uint stepShift, uint shift) {
    uint own = shift < stepShift ? shift : stepShift;
    return stepNow + ((k >> (stepShift - own)) + 1u) * (kStepTicks >> own);
}

// Must a latch of the drive at tick `now` touch this tile? A pending tile is listed; a source that
// may still be corrected is younger than the window, so its tile changed since. Unsigned:
// kNeverChanged is far in the past.
FW_FN bool latchReaches(bool listed, uint lastChange, uint now, uint window) {
    return listed || now - lastChange <= window + kStepTicks;
}

// Grid neighbours of a tile that depend on a texel of this mask (lane = y * 8 + x), one bit each.
FW_FN uint dependentNeighbours(uint maskLow, uint maskHigh) {
    uint all = maskLow | maskHigh;
    bool right = (all & 0x80808080u) != 0u;
    bool left = (all & 0x01010101u) != 0u;
    bool top = (maskHigh & 0xFF000000u) != 0u;   // row 7
    bool bottom = (maskLow & 0x000000FFu) != 0u; // row 0
    uint corners = ((maskHigh >> 31u) << 1u) | ((maskHigh >> 21u) & 8u) |
                   ((maskLow << 5u) & 32u) | (maskLow & 0x80u);
    return corners | (right ? 1u : 0u) | (top ? 4u : 0u) | (left ? 16u : 0u) | (bottom ? 64u : 0u);
}

FW_SHARED_END
#endif
