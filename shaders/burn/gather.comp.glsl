// Finds the texels of due tiles that may change and lists their rows densely for `arrival`: few
// rows of a tile have any, and a software device pays for idle lanes. Rim texels go to
// `arrival_rim` unseen. A tile that woke for a known arrival needs no kernel: its other arrivals
// are known too. Where texels just caught, settled texels are skipped. One thread per row.
#include "lib/compute.glsl"
FW_READ(TILE_WORDS) FW_READ(STATE_QUADS) FW_READ(STATE) FW_READ(RUN) FW_READ(PENDING_QUADS)
FW_READ(SETTLED) FW_READ_WRITE(TILE_STATE) FW_READ_WRITE(MASK_WORDS) FW_READ_WRITE(COUNTERS)
FW_WRITE(SCRATCH) FW_WRITE(SCRATCH_QUADS) FW_PUSH(StepPush)
#include "lib/object_quads.glsl"
#include "lib/gather.glsl"

// Ten texels of a row, from the one left of a tile to the one right of it.
struct Row {
    uint sources;     // bits: burning by the window's end
    uint walls;       // bits: barriers
    uint future[10];  // ticks of those that ignite later, kNever: none
    uint tick[10];
};

// left, right: the texels beside the tile are needed.
Row rowAt(uint at, bool left, bool right, uint end) {
    uvec4 a = stateQuads[at >> 2u], b = stateQuads[(at >> 2u) + 1u];
    uint t[10] = uint[10](left ? state[at - 1u] : kInert, a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w,
                          right ? state[at + 8u] : kInert);
    Row r;
    r.sources = 0u;
    r.walls = 0u;
    r.tick = t;
    FW_UNROLL for (int i = 0; i < 10; ++i) {
        r.sources |= t[i] <= end ? 1u << uint(i) : 0u;
        r.walls |= isBarrier(t[i]) ? 1u << uint(i) : 0u;
        r.future[i] = isSource(t[i]) && t[i] > end ? t[i] : kNever;
    }
    return r;
}

void gatherRow(uint slot, uint row) {
    uvec4 tile = run[slot];
    uvec4 bases = objectBases(tile.y);
    uvec4 times = objectTimes(tile.y);
    uint end = iterationEnd(push.now, push.iteration, push.stepShift, times.y);
    uint before = end - windowTicks(push.stepShift, times.y);
    uint floorTick = windowFloor(before, times.x);
    bool woken = (tile.z & kRunWoken) != 0u;
    uint texel = (tile.z & ~kRunBits) + row * bases.w;
    uint at = bases.y + texel;
    uvec4 a = stateQuads[at >> 2u];
    uvec4 b = stateQuads[(at >> 2u) + 1u];
    uint own[8] = uint[8](a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w);
    uint eligible = 0u;
    FW_UNROLL for (int i = 0; i < 8; ++i)
        eligible |= isFrontEligible(own[i], floorTick) ? 1u << uint(i) : 0u;
    if (eligible == 0u) return;
    uint rim = rimOfRow(tile.w, row);
    uint inner = eligible & ~rim;
    rim &= eligible;
    uint chosen = 0u;
    uint lit = 0u;
    uint pending = kNever;
    if (inner != 0u) {
        bool left = (inner & 1u) != 0u;
        bool right = (inner & 0x80u) != 0u;
        Row m = rowAt(at, left, right, end);
        Row d = rowAt(at - bases.w, left, right, end);
        Row u = rowAt(at + bases.w, left, right, end);
        // countingSources for eight texels at once: bit i is the texel in column i + 1.
        uint straight = m.sources | (m.sources >> 2u) | (u.sources >> 1u) | (d.sources >> 1u);
        uint openUp = ~(u.walls >> 1u);
        uint openDown = ~(d.walls >> 1u);
        uint openLeft = ~m.walls;
        uint openRight = ~(m.walls >> 2u);
        uint diagonal =
            (u.sources & (openUp | openLeft)) | ((u.sources >> 2u) & (openUp | openRight)) |
            (d.sources & (openDown | openLeft)) | ((d.sources >> 2u) & (openDown | openRight));
        chosen = inner & (straight | diagonal);
        // A source from before this iteration was evaluated after an older source beside it caught,
        // so its settled bit is valid.
        uint settled = (tile.z & kRunLitBeside) != 0u ? settledRows[at >> 3u] : 0u;
        FW_UNROLL for (int i = 0; i < 8; ++i) {
            uint least = min(min(m.tick[i], m.tick[i + 2]), min(d.tick[i + 1], u.tick[i + 1]));
            if (own[i] > before || least > own[i] || own[i] - least < kStepTicks)
                settled &= ~(1u << uint(i));
        }
        chosen &= ~settled;
        uint quiet = inner & ~chosen;
        uint column[10];
        FW_UNROLL for (int i = 0; i < 10; ++i)
            column[i] = min(m.future[i], min(d.future[i], u.future[i]));
        FW_UNROLL for (int i = 0; i < 8; ++i)
            if ((quiet & (1u << uint(i))) != 0u)
                pending = min(pending, min(min(column[i], column[i + 2]),
                                           min(d.future[i + 1], u.future[i + 1])));
        if (pending != kNever) atomicOr(tileState[tile.x].flag, kTilePendingUnknown);
        if (woken) {
            uvec4 pa = pendingQuads[at >> 2u];
            uvec4 pb = pendingQuads[(at >> 2u) + 1u];
            uint tick[8] = uint[8](pa.x, pa.y, pa.z, pa.w, pb.x, pb.y, pb.z, pb.w);
            FW_UNROLL for (int i = 0; i < 8; ++i) {
                bool known = (chosen & (1u << uint(i))) != 0u && isReceptive(own[i]);
                uint t = known ? tick[i] : kNever;
                lit |= t <= end ? 1u << uint(i) : 0u;
                pending = min(pending, t > end ? t : kNever);
            }
            chosen = 0u;
        }
    }
    if (pending != kNever) atomicMin(tileState[tile.x].wake, pending);
    if ((chosen | lit | rim) == 0u) return;
    if (lit != 0u) {
        uint word = slot * 4u + (row >> 2u);
        atomicOr(maskWords[word], lit << ((row & 3u) * 8u));
        atomicOr(maskWords[word + 2u], lit << ((row & 3u) * 8u));
    }
    gatherItem(push.row, uvec4(slot * 8u + row, chosen | (lit << 8u), texel, tile.y), rim);
}

void main() { FW_STRIDE_ROWS(counters[push.row].runCount, gatherRow) }
