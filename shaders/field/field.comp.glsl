// One step of particle fields. A thread walks up a strip of four columns and computes for each row
// what its six columns (one left to one right of the strip) give, so threads exchange nothing.
// Emission comes last. Eight strips are a unit; a group holds units of whole fields.
#include "field/field.glsl"
FW_READ_WRITE(FIELD_QUADS)  // four cells of a row
#ifdef FW_TEXELS
FW_TEXEL_BUFFER(FIELD_CELLS, readonly, quadsIn)
#define FW_QUAD(at) imageLoad(quadsIn, int(at))
#else
#define FW_QUAD(at) quads[at]
#endif

shared uvec4 tallies[64];  // per thread: particles, emitted, died, occupied bands of eight rows

const uint kNoLimit = 0x7FFF8000u;
const uint kRows = 4u;  // rows that share a random direction

uint height, strips, spread, open;
uint from, to;             // first quads
uint strip, left, right;   // of the thread, and beside it
uint leftOpen, rightOpen;  // capacity of columns beyond a border
bool hasLeft, hasRight;

struct Row {        // from one column left of the strip to one right of it
    uint cell[6];   // fieldCell
};
Row rowAt(uint y) {  // also beyond the field
    bool within = y < height;
    uint at = from + min(y, height - 1u) * strips;
    uvec4 own = FW_QUAD(at + strip);
    uint a = FW_QUAD(at + left).w, b = FW_QUAD(at + right).x;
    return Row(uint[6](within && hasLeft ? a : kFieldWallCell, within ? own.x : kFieldWallCell,
                     within ? own.y : kFieldWallCell, within ? own.z : kFieldWallCell,
                     within ? own.w : kFieldWallCell, within && hasRight ? b : kFieldWallCell));
}
struct Seen {       // of a row, for its neighbours
    uint full[6];   // particles times spread
    uint room[6];
};
Seen seenAt(Row row, uint y) {
    bool within = y < height;
    uint border =
        !within && (open & (y == height ? kFieldOpenTop : kFieldOpenBottom)) != 0u ? kNoLimit : 0u;
    uint all = within ? kNoLimit : border;
    Seen s;
    FW_UNROLL for (uint j = 0u; j < 6u; ++j) {
        uint full = row.cell[j] & kMaxFieldCell;
        s.full[j] = full * (spread & 0x1FFFu);
        s.room[j] = fieldRoom(full) | border;
    }
    // Corners beyond a border are open if both borders are.
    s.room[0] = hasLeft ? s.room[0] : leftOpen & all;
    s.room[5] = hasRight ? s.room[5] : rightOpen & all;
    return s;
}

struct Sums {     // of a strip's cells: particles and their motion
    uint n[4];
    uint x[4];
    uint y[4];
};
#define FW_ADD(to, i, count, motionX, motionY) \
    to.n[i] += count;                          \
    to.x[i] += count * (motionX);              \
    to.y[i] += count * (motionY);
const Sums kNothing =
    Sums(uint[4](0u, 0u, 0u, 0u), uint[4](0u, 0u, 0u, 0u), uint[4](0u, 0u, 0u, 0u));

FieldPushes pushesAt(FieldWeights w, uint key, uint quad, uint rows) {
    return fieldPushes(w, fieldChaos(fieldRandom(key, quad, rows)));
}

// Rows that may change: around occupied ones, emitting ones, and those that the output cells held
// two steps ago. In fours.
uvec2 activeRows(uint now, uint before, uvec2 sources) {
    uvec2 rows = uvec2(0xFFFFu, 0u);
    if (now != 0u) rows = uvec2(8u * uint(findLSB(now)), 8u * uint(findMSB(now)) + 9u);
    rows.x -= min(rows.x, 1u);
    if (before != 0u)
        rows = uvec2(min(rows.x, 8u * uint(findLSB(before))),
                     max(rows.y, 8u * uint(findMSB(before)) + 8u));
    if (sources.y != 0u) rows = uvec2(min(rows.x, sources.x), max(rows.y, sources.y));
    rows.y = min(rows.y, height);
    rows.x &= ~(kRows - 1u);
    return rows.x < rows.y ? rows : uvec2(0u);
}

void add64(inout uint low, inout uint high, uint more) {
    low += more;
    high += low < more ? 1u : 0u;
}

void main() {
    uint thread = gl_LocalInvocationID.x;
    uvec2 run = runs[push.first + gl_WorkGroupID.x * kFieldUnits + thread / 8u];
    uint slot = run.x & 0xFFFFu;
    FieldRecord f = fields[slot];
    FieldRules rules = f.rules;
    height = rules.height;
    spread = rules.spread;
    open = rules.open;
    strips = rules.width >> 2u;
    from = fieldCells(f, run.y) >> 2u;
    to = fieldCells(f, run.y + 1u) >> 2u;
    strip = (run.x >> 16u) * 8u + (thread & 7u);  // beyond the last strip: idle
    bool odd = (run.y & 1u) != 0u, works = strip < strips;
    strip = min(strip, strips - 1u);

    uvec2 sources = uvec2(0xFFFFu, 0u);
    FW_UNROLL for (uint k = 0u; k < kFieldSources; ++k) {
        ivec4 c = rules.sources[k].cells;
        if (k < rules.sourceCount && c.y < c.w)
            sources = uvec2(min(sources.x, uint(max(c.y, 0))), max(sources.y, uint(max(c.w, 0))));
    }
    if (rules.paint != 0u) sources = uvec2(0u, height);
    uint bands0 = counters[slot].bands0, bands1 = counters[slot].bands1;
    uvec2 rows = activeRows(odd ? bands1 : bands0, odd ? bands0 : bands1, sources);
    if (!works) rows = uvec2(0u);

    bool ring = (open & kFieldRing) != 0u;
    hasLeft = strip > 0u || ring;
    hasRight = strip + 1u < strips || ring;
    left = strip > 0u ? strip - 1u : (ring ? strips - 1u : strip);
    right = strip + 1u < strips ? strip + 1u : (ring ? 0u : strip);
    leftOpen = (open & kFieldOpenLeft) != 0u ? kNoLimit : 0u;
    rightOpen = (open & kFieldOpenRight) != 0u ? kNoLimit : 0u;

    uint giving = fieldKey(run.y, rules.seed, 0u), chance = fieldKey(run.y >> 2u, rules.seed, 1u);
    uint dying = fieldKey(run.y, rules.seed, 2u), emitting = fieldKey(run.y, rules.seed, 3u);
    uint memory = rules.memory & 255u, fresh = 128u - memory;
    // Displacement by component: none, whole, diagonal to both sides.
    uint still = uint(kFieldStill) * fresh, whole = uint(kFieldSpeed) * fresh, slant = 85u * fresh;

    uvec4 tally = uvec4(0u);
    uint y = rows.x - 1u;
    Row below = rowAt(y - 1u), here = rowAt(y);
    Sums under = kNothing;  // row below, without the flow from this row
    Sums sums = kNothing;   // this row, from the row below
    while (int(y) <= int(rows.y)) {
        uint fours = (y + 1u) >> 2u;
        FieldPushes pushes[3];
        pushes[0] = pushesAt(f.weights, chance, left, fours);
        pushes[1] = pushesAt(f.weights, chance, strip, fours);
        pushes[2] = pushesAt(f.weights, chance, right, fours);
        uint row = 0u;
        do {
            Row above = rowAt(y + 1u);
            Seen seenBelow = seenAt(below, y - 1u), seen = seenAt(here, y),
                 seenAbove = seenAt(above, y + 1u);
            uint random[3] = uint[3](fieldRandom(giving, left, y), fieldRandom(giving, strip, y),
                                     fieldRandom(giving, right, y));
            Sums next = kNothing;  // row above
            FW_UNROLL for (int j = 0; j < 6; ++j) {
                const int q = j == 0 ? 0 : (j == 5 ? 2 : 1), l = max(j - 1, 0), r = min(j + 1, 5);
                FieldPushes p = pushes[q];
                FieldGiver g =
                    fieldGiver(here.cell[j], p.sum, spread, f.weights.inertia,
                               f.weights.inertiaDiagonal, fieldDither(random[q], uint(j + 3)));
                // Motion carried, below 2^15.
                uint x0 = ((here.cell[j] >> 16u) & 255u) * (memory & 255u) + still;
                uint y0 = (here.cell[j] >> 24u) * (memory & 255u) + still;
                uint flat_ = y0 & 0x7FFFu, up = (y0 + slant) & 0x7FFFu,
                     down = (y0 - slant) & 0x7FFFu;
                uint stays = g.n;
                if (j <= 4) {
                    uint s0 =
                        g.ahead + fieldFlow(g, 7u, p.to.k[7], seenBelow.full[r], seenBelow.room[r]);
                    uint s1 = s0 + fieldFlow(g, 0u, p.to.k[0], seen.full[r], seen.room[r]);
                    uint s2 =
                        s1 + fieldFlow(g, 1u, p.to.k[1], seenAbove.full[r], seenAbove.room[r]);
                    if (j <= 3) {
                        uint a = fieldGiven(g.ahead, s0), b = fieldGiven(s0, s1),
                             c = fieldGiven(s1, s2);
                        uint along = (x0 + slant) & 0x7FFFu;
                        FW_ADD(under, j, a, along, down)
                        FW_ADD(sums, j, b, ((x0 + whole) & 0x7FFFu), flat_)
                        FW_ADD(next, j, c, along, up)
                    }
                    if (j >= 1) {
                        uint s3 =
                            s2 + fieldFlow(g, 2u, p.to.k[2], seenAbove.full[j], seenAbove.room[j]);
                        uint d = fieldGiven(s2, s3);
                        FW_ADD(next, j - 1, d, (x0 & 0x7FFFu), ((y0 + whole) & 0x7FFFu))
                        stays -= s3 >> 15u;
                    }
                }
                if (j >= 1) {
                    uint s0 = g.behind +
                              fieldFlow(g, 3u, p.to.k[3], seenAbove.full[l], seenAbove.room[l]);
                    uint s1 = s0 + fieldFlow(g, 4u, p.to.k[4], seen.full[l], seen.room[l]);
                    uint s2 =
                        s1 + fieldFlow(g, 5u, p.to.k[5], seenBelow.full[l], seenBelow.room[l]);
                    if (j >= 2) {
                        uint a = fieldGiven(g.behind, s0), b = fieldGiven(s0, s1),
                             c = fieldGiven(s1, s2);
                        uint along = (x0 - slant) & 0x7FFFu;
                        FW_ADD(next, j - 2, a, along, up)
                        FW_ADD(sums, j - 2, b, ((x0 - whole) & 0x7FFFu), flat_)
                        FW_ADD(under, j - 2, c, along, down)
                    }
                    if (j <= 4) {
                        uint s3 =
                            s2 + fieldFlow(g, 6u, p.to.k[6], seenBelow.full[j], seenBelow.room[j]);
                        uint d = fieldGiven(s2, s3);
                        FW_ADD(under, j - 1, d, (x0 & 0x7FFFu), ((y0 - whole) & 0x7FFFu))
                        stays = (stays - (s3 >> 15u)) & kMaxFieldCell;
                        FW_ADD(sums, j - 1, stays, (x0 & 0x7FFFu), flat_)
                    }
                }
            }
            // The row below is complete.
            uint done = y - 1u;
            uint random2 = fieldRandom(dying, strip, done);
            uvec4 result = uvec4(0u);
            bool mine = done + 1u > rows.x && done < rows.y;
            uint held = 0u, dead = 0u;
            FW_UNROLL for (int j = 0; j < 4; ++j) {
                uint n = under.n[j];
                uint gone = fieldDeaths(n, rules.death, fieldWindow(random2, uint(j)));
                uvec2 motion = uvec2(fieldMean(under.x[j], n), fieldMean(under.y[j], n));
                result[j] = fieldCell(n - gone, motion) | fieldWalled(below.cell[j + 1]);
                held += n - gone;
                dead += gone;
            }
            if (mine) quads[to + done * strips + strip] = result;
            uint counts = mine ? 0xFFFFFFFFu : 0u;
            tally.x += held & counts;
            tally.z += dead & counts;
            tally.w |= mine && held > 0u ? 1u << (done >> 3u) : 0u;
            below = here;
            here = above;
            under = sums;
            sums = next;
            y += 1u;
        } while (++row < kRows);
    }

    // Emission into the strip's own cells.
    uint source = max(sources.x, rows.x), sourceEnd = min(sources.y, rows.y);
    for (uint i = 4u * source; i < 4u * sourceEnd; ++i) {
        uint cellY = i >> 2u, cellX = 4u * strip + (i & 3u), at = to + cellY * strips + strip;
        uint cell = quads[at][i & 3u];
        uint random = fieldRandom(emitting, cellX, cellY);
        uint n = fieldEmission(cellX, cellY, fieldNumber(cell),
                               fieldMask(f.cellBase + cellY * rules.width + cellX), rules, random);
        n = cell == kFieldWallCell ? 0u : n;
        if (n != 0u) quads[at][i & 3u] = cell + n;
        tally.x += n;
        tally.y += n;
        tally.w |= n != 0u ? 1u << (cellY >> 3u) : 0u;
    }
    tallies[thread] = tally;
    barrier();
    if (strip != 0u || !works) return;
    uvec4 sum = uvec4(0u);
    for (uint i = 0u; i < strips; ++i) {
        uvec4 one = tallies[thread + i];
        sum = uvec4(sum.xyz + one.xyz, sum.w | one.w);
    }
    FieldCounters c = counters[slot];
    uint was = c.inside;
    c.inside = sum.x;
    add64(c.emittedLow, c.emittedHigh, sum.y);
    add64(c.diedLow, c.diedHigh, sum.z);
    add64(c.leftLow, c.leftHigh, was + sum.y - sum.z - sum.x);
    if (odd)
        c.bands0 = sum.w;
    else
        c.bands1 = sum.w;
    c.steps = run.y + 1u;
    counters[slot] = c;
}
