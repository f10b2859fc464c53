// The front kernel over the gathered rows, one thread per row: a ring moves along the row, so that
// a texel loads one column. Writes arrivals to `pendingTick`, changed texels to masks, the earliest
// future arrival to the tile, and which texels are settled. Jacobi: reads states, writes none.
#include "lib/compute.glsl"
FW_READ(TEXELS) FW_READ(NORMALS) FW_READ(SLOWNESS) FW_READ(STATE) FW_READ(RUN)
FW_READ(SCRATCH_QUADS) FW_READ(COUNTERS) FW_READ_WRITE(TILE_STATE) FW_READ_WRITE(SCRATCH)
FW_READ_WRITE(MASK_WORDS) FW_READ_WRITE(SETTLED) FW_WRITE(PENDING) FW_PUSH(StepPush)
#include "lib/object_quads.glsl"
#include "lib/burn_material.glsl"

struct Column {  // three texels, from the row below to the row above
    uint tick[3];
    uvec2 place[3];
    uint burn[3];
};

// material, burnTicks: a cached material and its burn time.
Column columnAt(uint texel, uvec4 bases, uint materialBase, uint material, uint burnTicks) {
    Column c;
    FW_UNROLL for (int i = 0; i < 3; ++i) {
        uint at = texel + uint(i - 1) * bases.w;
        c.tick[i] = state[bases.y + at];
        c.place[i] = texels[bases.x + at];
        c.burn[i] = burnTicks;
        uint theirs = (c.place[i].y >> 16u) & 7u;
        if (isSource(c.tick[i]) && theirs != material)
            c.burn[i] = burnTicksOf(materialBase + theirs);
    }
    return c;
}

void arriveRow(uint work) {
    uvec4 item = scratchQuads[work];
    uint chosen = item.y & 0xFFu;
    if (chosen == 0u) return;
    uvec4 bases = objectBases(item.w);
    uvec4 times = objectTimes(item.w);
    uint end = iterationEnd(push.now, push.iteration, push.stepShift, times.y);
    uint floorTick = windowFloor(end - windowTicks(push.stepShift, times.y), times.x);
    uint materialBase = item.w * kMaterialsPerObject;
    uint x = uint(findLSB(chosen));
    uint last = uint(findMSB(chosen));
    uint held = (texels[bases.x + item.z + x].y >> 16u) & 7u;
    BurnMaterial m = burnMaterial(materialBase + held);
    Column left = columnAt(item.z + x - 1u, bases, materialBase, held, m.burnTicks);
    Column middle = columnAt(item.z + x, bases, materialBase, held, m.burnTicks);
    uint changed = 0u;
    uint lit = 0u;
    uint lateBits = 0u;
    uint wake = kNever;
    bool ahead = false;  // is something other than an arrival pending?
    bool uneven = false;
    uint settled = 0u;
    uint window = windowTicks(push.stepShift, times.y);
    do {
        uint texel = item.z + x;
        Column right = columnAt(texel + 1u, bases, materialBase, held, m.burnTicks);
        if ((chosen & (1u << x)) != 0u) {
            uint t = middle.tick[1];
            uvec2 me = middle.place[1];
            uint material = (me.y >> 16u) & 7u;
            if (material != held) {
                held = material;
                m = burnMaterial(materialBase + held);
            }
            ivec3 mine = decodePosition(me);
            FrontRing ring;
            ring.tick = uint[8](right.tick[1], right.tick[2], middle.tick[2], left.tick[2],
                                left.tick[1], left.tick[0], middle.tick[0], right.tick[0]);
            ring.burn = uint[8](right.burn[1], right.burn[2], middle.burn[2], left.burn[2],
                                left.burn[1], left.burn[0], middle.burn[0], right.burn[0]);
            ring.link = ivec3[8](
                mine - decodePosition(right.place[1]), mine - decodePosition(right.place[2]),
                mine - decodePosition(middle.place[2]), mine - decodePosition(left.place[2]),
                mine - decodePosition(left.place[1]), mine - decodePosition(left.place[0]),
                mine - decodePosition(middle.place[0]), mine - decodePosition(right.place[0]));
            uint pending = kNever;
            uint late = 0u;
            uint counts = countingSources(ring, 0xFFu, end, pending);
            uint future = pending;  // a source of the ring begins then and may correct the result
            FrontDrive p =
                prepareFront(decodeNormal(normals[bases.x + texel]), slownessAt(bases.z, texel), m);
            uint settledFrom = kNever;
            uint candidate = frontArrival(ring, counts, p, m.windowMax, end, floorTick, texel, true,
                                          pending, settledFrom);
            // Sources that just catch do so within one step before this texel's tick, at the
            // earliest.
            uint own = min(t, candidate);
            if (settledFrom <= own && own - settledFrom >= kStepTicks - 1u &&
                candidate >= floorTick && (isReceptive(t) || t <= end))
                settled |= 1u << x;
            uint decided = decideTick(t, candidate, end, floorTick, pending, late);
            uint known = isReceptive(t) ? candidate : kNever;
            if (decided != t) {
                known = decided;
                changed |= 1u << x;
                if (isReceptive(t)) lit |= 1u << x;
                uneven = uneven || !isReceptive(t) || decided <= end - window;
                lateBits |= late << x;
            } else {
                uint next = isReceptive(t) ? pending : future;
                ahead = ahead || next < known;
                wake = min(wake, next);
            }
            pendingTick[bases.y + texel] = known;
        }
        left = middle;
        middle = right;
        ++x;
    } while (x <= last);
    uint worldTile = run[item.x >> 3u].x;
    if (wake != kNever) atomicMin(tileState[worldTile].wake, wake);
    uint marks = (ahead ? kTilePendingUnknown : 0u) | (uneven ? kTileCorrected : 0u);
    if (marks != 0u) atomicOr(tileState[worldTile].flag, marks);
    uint at = (bases.y + item.z) >> 3u;
    settledRows[at] = (settledRows[at] & ~chosen) | settled;
    if (changed == 0u) return;
    scratch[work * 4u + 1u] = chosen | (changed << 8u) | (lateBits << 16u);
    uint row = item.x & 7u;
    uint word = (item.x >> 3u) * 4u + (row >> 2u);
    atomicOr(maskWords[word], changed << ((row & 3u) * 8u));
    if (lit != 0u) atomicOr(maskWords[word + 2u], lit << ((row & 3u) * 8u));
}

void main() { FW_STRIDE(counters[push.row].workCount, arriveRow) }
