// 2D particle field: what a cell gives to its eight neighbours, and its state after a step.
// Integers only, so no particle is lost or created. It accesses no buffer.
//
// Units: cell side and step; a speed of 1 is one cell per step. Directions are a ring as in
// front.h: counter-clockwise from +x, odd ones diagonal, +y up.
// clang-format off
#ifndef FW_SHARED_FIELD_H
#define FW_SHARED_FIELD_H
#include "shared/types.h"

FW_SHARED_BEGIN

FW_CONST uint kFieldSources = 4u;         // of a field
FW_CONST uint kMaxFieldSide = 256u;      // cells
FW_CONST uint kMaxFieldCell = 32767u;    // particles of a cell
FW_CONST uint kFieldCellFull = 16384u;    // above it no more are emitted
FW_CONST uint kFieldAll = 32768u;         // Q15, share of all of a cell's particles
FW_CONST int kFieldStill = 128;           // byte of a mean motion of 0
FW_CONST int kFieldSpeed = 120;           // byte difference of one cell per step
FW_CONST uint kFieldWallCell = 0x8080FFFFu;  // word of a wall cell
FW_CONST uint kMaxFieldSpread = 4096u;   // Q15: an eighth; twice as much is unstable

FW_CONST uint kMaxFields = 256u;          // of a world
FW_CONST uint kMaxFieldRounds = 64u;      // of a frame: steps of a field, at most
FW_CONST uint kFieldUnits = 8u;  // units per group; a unit is eight strips of four columns
FW_CONST uint kFieldWall = 255u;  // of a cell's mask; below: strength of the paint there
// Bits of FieldRules::open: particles may leave the field there.
FW_CONST uint kFieldOpenLeft = 1u;
FW_CONST uint kFieldOpenRight = 2u;
FW_CONST uint kFieldOpenBottom = 4u;
FW_CONST uint kFieldOpenTop = 8u;
FW_CONST uint kFieldFresh = 0x80000000u;  // of a masked run's step: empties the field
FW_CONST uint kFieldRing = 16u;           // instead: left and right border are joined

struct FieldSource {     // rectangle of cells that emits
    ivec4 cells;         // first x, first y, end x, end y
    uint rate;           // Q8 particles per cell and step
    uint disc;           // 1: the inscribed disc instead of the rectangle
    uint pad0; uint pad1;
};
FW_SIZE(FieldSource, 32)

struct FieldRules {      // of one field
    // Q7, external force (wind, buoyancy, weight): 128 moves all particles one cell per step.
    int forceX;
    int forceY;
    uint inertia;        // Q8, weight of the cell's mean motion
    uint chaos;          // Q8, weight of a random direction, shared by 4 x 4 cells and 4 steps

    // Q15, [0, kMaxFieldSpread]: share of a difference that diffuses to each neighbour.
    uint spread;
    uint memory;         // Q7, share of its motion that a particle keeps per step
    uint death;          // Q16, share that dies per step
    uint seed;

    uint width;          // cells
    uint height;
    uint open;           // kFieldOpen bits; elsewhere borders are walls
    uint sourceCount;

    uint paint;          // Q8 particles per step of a cell whose mask is 254
    uint pad0; uint pad1; uint pad2;

    FieldSource sources[kFieldSources];
};
FW_SIZE(FieldRules, 192)

struct FieldPush {       // push constants of the field passes
    uint first;          // of the runs
    uint pad0; uint pad1; uint pad2;
};
FW_SIZE(FieldPush, 16)

// A cell: particles (15 bits; a wall has 0 and the 16th bit), mean motion, one byte per axis.
FW_FN uint fieldCell(uint n, uvec2 motion) { return n | (motion.x << 16u) | (motion.y << 24u); }
FW_FN uvec2 fieldMotionOf(uint cell) { return uvec2((cell >> 16u) & 255u, cell >> 24u); }
// All ones for a wall.
FW_FN uint fieldWalled(uint cell) { return uint(int(cell << 16u) >> 31u) & 0xFFFFu; }
FW_FN uint fieldNumber(uint cell) { return cell & ~fieldWalled(cell) & kMaxFieldCell; }

// Unit vector of direction k, Q7.
FW_FN ivec2 fieldDirection(uint k) {
    int diagonal = (k & 1u) != 0u ? 91 : 128;
    int x = (k == 2u || k == 6u) ? 0 : ((k > 2u && k < 6u) ? -diagonal : diagonal);
    int y = (k == 0u || k == 4u) ? 0 : (k > 4u ? -diagonal : diagonal);
    return ivec2(x, y);
}
FW_FN ivec2 fieldNeighbour(uint k) {  // the same in cells
    ivec2 d = fieldDirection(k);
    return ivec2(d.x == 0 ? 0 : (d.x > 0 ? 1 : -1), d.y == 0 ? 0 : (d.y > 0 ? 1 : -1));
}

// Random numbers of a step: one key per use, one number per pair of coordinates.
FW_FN uint fieldKey(uint step, uint seed, uint salt) {
    return hash32((seed * 0x9E3779B9u) ^ (step * 0x85EBCA6Bu + salt));
}
FW_FN uint fieldRandom(uint key, uint x, uint y) { return hash32((x | (y << 16u)) ^ key); }

// Random unit vector, Q7 (within 1 of it), uniform in angle: an eighth of a turn to both sides of
// an axis by the first terms of sine and cosine.
FW_FN ivec2 fieldChaos(uint h) {
    int a = int(h & 255u) - 128;
    a += a >= 0 ? 1 : 0;  // -128..-1, 1..128: no bias to one side
    int c = 128 - ((a * a * 75) >> 15u);
    int s = a * (1646592 - 10 * a * a);  // Q28
    s = s >= 0 ? (s >> 21u) : -((-s) >> 21u);
    ivec2 d = (h & 256u) != 0u ? ivec2(c, s) : ivec2(-s, c);
    return (h & 512u) != 0u ? d : ivec2(-d.x, -d.y);
}

// Four cells of a row, x = 4 i ..., share a random number: dither of shares, Q15, and of deaths,
// Q16.
FW_FN uint fieldDither(uint random, uint x) {
    return (((random >> (8u * (x & 3u))) & 255u) << 7u) + 64u;
}
FW_FN uint fieldWindow(uint random, uint x) {
    return ((x & 3u) == 3u ? (random >> 24u) | (random << 8u) : random >> (8u * (x & 3u))) &
           0xFFFFu;
}

struct FieldEight { uint k[8]; };  // of each direction

FW_FN int fieldLobe(int along) { return along > 0 ? along : 0; }

// Shares (Q15) that move particles; scaled down if their sum would exceed kFieldAll.
struct FieldWeights {
    FieldEight force;      // of each direction
    uint chance;           // of a cosine lobe
    uint inertia;          // cosine lobe of motion kFieldSpeed: Q7 more
    uint inertiaDiagonal;  // diagonals, of the sum of both components
};
FW_FN FieldWeights fieldWeights(FieldRules rules) {
    FieldWeights w;
    uint sum = 0u;
    FW_UNROLL for (uint k = 0u; k < 8u; ++k) {
        ivec2 u = fieldDirection(k);
        w.force.k[k] = (uint(fieldLobe(rules.forceX * u.x + rules.forceY * u.y)) * 210u) >> 8u;
        sum += w.force.k[k];
    }
    uint chance = rules.chaos << 7u, inertia = rules.inertia << 7u;
    // 0.41 of eight cosines is 1.0714 at most, and rounding lengthens motion by one part in 80.
    sum += ((chance + inertia) * 35u) >> 5u;
    uint most = kFieldAll - 64u;
    uint scale = sum > most ? divide(most << 16u, sum) : 65535u;
    FW_UNROLL for (uint k = 0u; k < 8u; ++k) w.force.k[k] = (w.force.k[k] * scale) >> 16u;
    w.chance = (((chance * scale) >> 16u) * 105u) >> 8u;
    w.inertia = (((inertia * scale) >> 16u) * 112u) >> 8u;
    w.inertiaDiagonal = (w.inertia * 181u) >> 8u;
    return w;
}

struct FieldRecord {     // of one field on a device
    FieldRules rules;
    FieldWeights weights;  // of the rules
    uint pad0;
    uint cellBase;       // into the cell buffers
    uint cellRoom;       // from its first cells to its second; even steps read the first
    uint pad1; uint pad2;
};
FW_SIZE(FieldRecord, 256)

struct FieldCounters {   // totals
    uint inside;         // particles, now
    uint pad0;
    uint emittedLow; uint emittedHigh;  // low + 2^32 high
    uint diedLow; uint diedHigh;
    uint leftLow; uint leftHigh;
    // Of the first and second cells: bit k is set if rows 8k.. hold particles.
    uint bands0; uint bands1;
    uint steps;
    uint pad1;
};
FW_SIZE(FieldCounters, 48)

// Shares by force and random vector, common to many cells, and their sum.
struct FieldPushes {
    FieldEight to;
    uint sum;
};
FW_FN FieldPushes fieldPushes(FieldWeights w, ivec2 random) {
    FieldPushes p;
    int x = random.x * 128, y = random.y * 128, a = (random.x + random.y) * 91,
        b = (random.x - random.y) * 91;
    p.to.k[0] = w.force.k[0] + ((uint(fieldLobe(x)) * w.chance) >> 14u);
    p.to.k[1] = w.force.k[1] + ((uint(fieldLobe(a)) * w.chance) >> 14u);
    p.to.k[2] = w.force.k[2] + ((uint(fieldLobe(y)) * w.chance) >> 14u);
    p.to.k[3] = w.force.k[3] + ((uint(fieldLobe(-b)) * w.chance) >> 14u);
    p.to.k[4] = w.force.k[4] + ((uint(fieldLobe(-x)) * w.chance) >> 14u);
    p.to.k[5] = w.force.k[5] + ((uint(fieldLobe(-a)) * w.chance) >> 14u);
    p.to.k[6] = w.force.k[6] + ((uint(fieldLobe(-y)) * w.chance) >> 14u);
    p.to.k[7] = w.force.k[7] + ((uint(fieldLobe(b)) * w.chance) >> 14u);
    p.sum = p.to.k[0] + p.to.k[1] + p.to.k[2] + p.to.k[3] + p.to.k[4] + p.to.k[5] + p.to.k[6] +
            p.to.k[7];
    return p;
}

// A giving cell: terms common to all directions. The masks tell the compiler value ranges: some
// devices multiply 16 bits faster than 32.
struct FieldGiver {
    uint n;
    uint own;        // particles times spread
    // Q15, limit of diffusion to each neighbour: an eighth of the particles that no force moves.
    uint most;
    // Shares by its motion, directions 0 to 3; negative: the opposite direction.
    int v0; int v1; int v2; int v3;
    uint ahead;      // first dithers, Q15: directions 7 0 1 2 and 3 4 5 6
    uint behind;
};
FW_FN FieldGiver fieldGiver(uint cell, uint pushed, uint spread, uint inertia, uint inertiaDiagonal,
                            uint dither) {
    FieldGiver g;
    uint mx = (cell >> 16u) & 255u, my = cell >> 24u;
    uint straight = inertia & 0x3FFFu, slant = inertiaDiagonal & 0x3FFFu;
    g.n = fieldNumber(cell);
    g.v0 = int(mx * straight - 128u * straight) >> 7u;
    g.v1 = int((mx + my) * slant - 256u * slant) >> 7u;
    g.v2 = int(my * straight - 128u * straight) >> 7u;
    g.v3 = int((256u - mx + my) * slant - 256u * slant) >> 7u;
    uint moves = pushed + uint(abs(g.v0) + abs(g.v1) + abs(g.v2) + abs(g.v3));
    g.own = g.n * (spread & 0x1FFFu);
    g.most = ((g.n * ((kFieldAll - 1u - moves) & 0x7FFFu)) >> 15u) * (spread & 0x1FFFu);
    g.ahead = dither;
    g.behind = 32767u - dither;
    return g;
}
// Flow in direction k, Q15. push: share of the direction; around: the neighbour's particles times
// spread (walls and cells beyond a border count as full); room: what the neighbour can take.
FW_FN uint fieldFlow(FieldGiver g, uint k, uint push, uint around, uint room) {
    int v = (k & 3u) == 0u ? g.v0 : ((k & 3u) == 1u ? g.v1 : ((k & 3u) == 2u ? g.v2 : g.v3));
    uint share = push + uint(k < 4u ? fieldLobe(v) : fieldLobe(v) - v);
    int less = fieldLobe(int(g.own - around));
    uint spreads = uint(less) < g.most ? uint(less) : g.most;
    uint flow = g.n * (share & 0x7FFFu) + spreads;
    return flow < room ? flow : room;
}
// Flows are rounded along two arcs of the ring, 7 0 1 2 and 3 4 5 6. Each remainder carries over to
// the next direction, and both first dithers sum up to one. So no more is given than exists, and
// each direction gets its flow on average. sum: of the arc so far, starting with its dither.
FW_FN uint fieldGiven(uint before, uint sum) { return ((sum >> 15u) - (before >> 15u)) & 4095u; }

// Flow that a cell of n particles takes per direction, Q15: an eighth of its free capacity.
FW_FN uint fieldRoom(uint n) { return ((kMaxFieldCell - n) << 12u) & ~32767u; }

// Motion of a particle that moves along u (component in cells: 0, 1, or 0.7 of diagonals) out of a
// cell of this motion: memory and displacement. Q7.
FW_FN uint fieldCarried(uint motion, int u, uint memory) {
    return motion * memory + uint(kFieldStill + u) * (128u - memory);
}
FW_FN int fieldSpeed(int direction) {
    int size = direction == 0 ? 0 : direction == 128 || direction == -128 ? kFieldSpeed : 85;
    return direction < 0 ? -size : size;
}

// Motion byte of n particles with the summed motion `sum`, rounded.
FW_FN uint fieldMean(uint sum, uint n) {
    uint t = (sum >> 7u) + (n >> 1u);  // below 2^23
#ifdef __cplusplus
    return n == 0u ? uint(kFieldStill) : t / n;
#else
    uint d = max(n, 1u);
    uint q = uint(float(t) * (1.0 / float(d)));  // within one of it
    int r = int(t) - int(q * d);
    q = r < 0 ? q - 1u : (r >= int(d) ? q + 1u : q);
    return n == 0u ? uint(kFieldStill) : q;
#endif
}

// Deaths among n particles. random: 16 bits.
FW_FN uint fieldDeaths(uint n, uint death, uint random) { return (n * death + random) >> 16u; }

// Particles emitted into a cell of n particles with this mask. random: 32 bits.
FW_FN uint fieldEmission(uint x, uint y, uint n, uint mask, FieldRules rules, uint random) {
    uint rate = (rules.paint * mask * 258u) >> 16u;
    FW_UNROLL for (uint k = 0u; k < kFieldSources; ++k) {
        ivec4 c = rules.sources[k].cells;
        bool within =
            k < rules.sourceCount && int(x) >= c.x && int(y) >= c.y && int(x) < c.z && int(y) < c.w;
        int a = 2 * int(x) + 1 - c.x - c.z, b = 2 * int(y) + 1 - c.y - c.w, wide = c.z - c.x;
        within = within && (rules.sources[k].disc == 0u || a * a + b * b <= wide * wide);
        rate += within ? rules.sources[k].rate : 0u;
    }
    return n < kFieldCellFull ? (rate + (random >> 24u)) >> 8u : 0u;
}

// ---- drawing: draw records and displayed cells

FW_CONST uint kFieldShowGroups = 8u;  // per field, by rows
FW_CONST uint kFieldBillboard = 0u;        // FieldDraw::shape, as FwFieldShape
FW_CONST uint kFieldSpheroid = 1u;
FW_CONST uint kFieldDisplaced = 2u;
FW_CONST uint kFieldAround = 32u;     // quads around a spheroid; kFieldUp: along its axis
FW_CONST uint kFieldUp = 16u;
FW_CONST float kFieldFull = 96.0f;    // particles of a cell displayed as full

struct FieldDraw {
    // m, world: middle of the lower edge; w: time since the last step, [0, 1] of a step.
    vec4 place;
    vec4 size;           // m: width, height, depth; w: opacity
    vec4 right;          // axes in the world; w: detail
    vec4 up;             // w: body
    vec4 forward;        // w: s, cosmetic time
    vec4 tint;           // w: steps a second
    uint cells;          // first cell that the last step wrote
    uint before;         // first cell that the last step read
    uint shown;
    uint width;          // cells
    uint height;
    uint shape;          // kFieldBillboard ...
    float tall;          // cells, mean height of the particles
    uint seed;
};
FW_SIZE(FieldDraw, 128)

// A displayed cell: density (0 to 2: root of its particles over kFieldFull), motion (cells per
// step, within 1.3), and the share of sunlight that reaches it.
FW_FN uint fieldShownPacked(float density, vec2 motion, float sun) {
    uint d = uint(clamp(density, 0.0f, 2.0f) * 511.5f + 0.5f);
    uint x = uint(clamp(motion.x * 48.0f + 64.5f, 0.0f, 127.0f));
    uint y = uint(clamp(motion.y * 48.0f + 64.5f, 0.0f, 127.0f));
    return d | (x << 10u) | (y << 17u) | (uint(clamp(sun, 0.0f, 1.0f) * 255.0f + 0.5f) << 24u);
}
FW_FN vec4 fieldShown(uint word) {
    return vec4(float(word & 1023u) * (1.0f / 511.5f),
                (float((word >> 10u) & 127u) - 64.0f) * (1.0f / 48.0f),
                (float((word >> 17u) & 127u) - 64.0f) * (1.0f / 48.0f),
                float(word >> 24u) * (1.0f / 255.0f));
}
FW_SHARED_END
#endif
