// Inter-object heat transfer: radiation and plume at a receiver, ignition rules between objects,
// and ember flight. Integers only, for C++ and GLSL; it accesses no buffer. The receiver's response
// is in heat.h. World positions are mm; a pair further apart than kExchangeFar does not interact.
// clang-format off
#ifndef FW_SHARED_EXCHANGE_H
#define FW_SHARED_EXCHANGE_H
#include "shared/heat.h"
#include "shared/burn.h"

FW_SHARED_BEGIN

FW_CONST int kExchangeFar = 32767;       // mm, along each axis
FW_CONST uint kExchangeSteps = 4u;       // steps from one exchange to the next
FW_CONST uint kExchangeTicks = kExchangeSteps * kStepTicks;
// Exchanges until all tiles of a receiver have been updated.
FW_CONST uint kExchangeRounds = kSleepSteps;
FW_CONST uint kSourcesPerReceiver = 64u;
// Cells along the longest side of an object, for its sources.
FW_CONST uint kSourceGrid = 4u;
FW_CONST uint kSourcesPerObject = 64u;   // at most
FW_CONST uint kMaxHeatOccluders = 64u;
// Cells along an axis of the occlusion grid, at most.
FW_CONST uint kMaxOcclusionSide = 256u;
FW_CONST uint kMaxOcclusionCells = 2097152u;   // cells of the grid, at most
FW_CONST uint kMaxBakedOcclusionCells = 262144u;    // cells filled by objects, at most
// Slot; number of sources; then source | visible share, of 255, << 24.
FW_CONST uint kReceiverWords = 66u;
FW_CONST uint kRadiantShare = 1721u;     // 0.33 / (4 pi), Q16
FW_CONST uint kPlumeTransfer = 25u;      // W/m^2/K
FW_CONST uint kNearest = 300u;           // mm: distances below half of this count as that
FW_CONST uint kPilotReach = 100u;        // mm around a flame in which it ignites vapours
FW_CONST uint kContactGap = 50u;         // mm that a flame bridges
FW_CONST uint kChanceOne = 65536u;       // probability 1

// ExchangePush::flags, as FwWorldFlags.
FW_CONST uint kExchangeRadiation = 1u;
FW_CONST uint kExchangePlume = 2u;
FW_CONST uint kExchangeContact = 4u;
FW_CONST uint kExchangeEmbers = 8u;
// ExchangeObject::flags
FW_CONST uint kExchangeLive = 1u;
FW_CONST uint kExchangeGives = 2u;         // its fire may reach other objects
FW_CONST uint kExchangeTwoSided = 4u;      // both sides receive

struct ExchangeObject {  // object data of the exchange, latched at a step's start, all integers
    ivec4 row0;        // world mm = w + (xyz . position >> shift); position: mesh units
    ivec4 row1;
    ivec4 row2;
    ivec4 rotation0;   // xyz: its rotation, Q12; w: low corner of its world box, mm
    ivec4 rotation1;
    ivec4 rotation2;
    ivec4 high;        // xyz: the other corner; w: wind of the zones there, see unpackWind
    uvec4 power0;      // 1/16 W of a flaming texel, by material
    uvec4 power1;
    uint shift;
    uint flags;
    uint sourceBase;   // into sources
    uint sourceCount;
    uint neighbourFirst;  // into neighbours
    uint neighbourCount;
    uint chance;       // probability of each jump to another object, of kChanceOne
    uint hopsMost;     // passes fire on only below this many jumps; kNoneTexel: no limit
    uint lifeTicks;    // ticks from ignition until its front stops; kNoneTexel: never
    uint maxTiles;    // limit of its burning tiles; kNoneTexel: no limit
    uint catches;      // embers: damping by its moisture, Q8
    uint texelArea;    // mm^2
};
FW_SIZE(ExchangeObject, 192)

struct ExchangeTile {    // one tile of a mesh, as source and receiver
    uint xy;           // middle of its texels, position units
    uint z;            // z | source cell << 16 | material << 24
    uint normal;       // mean normal, signed 11:11:10
    uint texels;       // real ones; 0: the tile is empty
    uvec4 parts;  // per 4 x 4 block: source lane and target texel of a link to another part of the
                  // mesh, see partFrom; kNoneTexel: none
};
FW_SIZE(ExchangeTile, 32)
FW_CONST uint kPartTexels = 1u << 28u;  // limit of a link's target texel

struct FireSource {    // fire in one cell of an object
    uint power;        // 1/16 W, summed by fire_cells
    uint texels;       // flaming
    uint tiles;        // that contain them
    uint sumX;         // sum of the tiles' middles, 4 position units
    uint sumY;
    uint sumZ;
    uint object;       // slot
    uint watts;        // from here on written by fire_sources; 0: no fire, or it is not passed on
    ivec4 place;       // xyz: mm, world; w: height of the flame, mm
    uint diameter;     // mm
    uint scale;        // watts^0.4, Q8
    uint ember;        // hash of the ember of this exchange; 0: none
    uint hops;         // jumps that brought the fire here
};
FW_SIZE(FireSource, 64)

struct HeatOccluder {       // box that stops radiation, plumes and embers
    ivec4 rotation0;   // xyz: row of its rotation, world to box, Q12; w: middle, mm
    ivec4 rotation1;
    ivec4 rotation2;
    uvec4 size;        // xyz: half of its sides, mm, [0, 30000]; w: 1 = in place
};
FW_SIZE(HeatOccluder, 64)

struct ContactLink {   // texel that another object's texel may light across a gap
    uint object;       // slot that catches
    uint texel;
    uint fromObject;
    uint fromTexel;
    uint delay;        // ticks
    uint since;        // tick at which both came together
    uint reserved0;
    uint reserved1;
};
FW_SIZE(ContactLink, 32)

struct ExchangePush {  // push constants of the passes that exchange
    uint now;          // tick after the step
    uint flags;        // kExchange... of the world
    uint burnParity;
    uint row;          // counters row of the front list, appended to
    uint parity;
    uint predictParity;
    uint switches;
    uint count;        // object slots, or links
    int upX;           // Q12
    int upY;
    int upZ;
    int windX;         // mm/s
    int windY;
    int windZ;
    uint chance;       // of the world, of kChanceOne
    uint hopsMost;
    uint maxTiles;
    uint lifeTicks;
    uint seed;
    uint occluders;
    uint brands;       // embers per 1/16 W and exchange, Q32
    uint ambient;      // 1/16 K
    uint hotParity;
    uint warms;        // 1: an object may be heated by others
    int occlusionX;       // low corner of the occlusion grid, mm
    int occlusionY;
    int occlusionZ;
    uint occlusionCell;   // cell side, mm; 0: no grid
    uint occlusionCounts; // cells along x | y << 10 | z << 20
    uint reserved0;
    uint reserved1;
    uint reserved2;
};
FW_SIZE(ExchangePush, 128)

// ---- positions

FW_FN int dotRow(ivec4 row, ivec3 p) { return row.x * p.x + row.y * p.y + row.z * p.z; }
FW_FN ivec3 dotRows(ivec4 row0, ivec4 row1, ivec4 row2, ivec3 p) {
    return ivec3(dotRow(row0, p), dotRow(row1, p), dotRow(row2, p));
}
FW_FN ivec3 toWorldMm(FW_IN(ExchangeObject) o, ivec3 p) {
    return ivec3(o.row0.w, o.row1.w, o.row2.w) +
           (dotRows(o.row0, o.row1, o.row2, p) >> int(o.shift));
}
// Q12. n: normal in Q14.
FW_FN ivec3 turnToWorld(FW_IN(ExchangeObject) o, ivec3 n) {
    return dotRows(o.rotation0, o.rotation1, o.rotation2, n) >> 14;
}
FW_FN ivec3 tileMiddle(FW_IN(ExchangeTile) t) {
    return ivec3(int(t.xy & 0xFFFFu), int(t.xy >> 16u), int(t.z & 0xFFFFu));
}
FW_FN uint tileCluster(FW_IN(ExchangeTile) t) { return (t.z >> 16u) & 0xFFu; }
FW_FN uint tileMaterial(FW_IN(ExchangeTile) t) { return t.z >> 24u; }

FW_FN bool isWithinExchangeRange(ivec3 d) {
    return d.x <= kExchangeFar && d.x >= -kExchangeFar && d.y <= kExchangeFar &&
           d.y >= -kExchangeFar && d.z <= kExchangeFar && d.z >= -kExchangeFar;
}
FW_FN uint absolute(int v) { return uint(v < 0 ? -v : v); }

// Does the segment from a to b, without its ends, intersect the box?
FW_FN bool occluderBlocks(FW_IN(HeatOccluder) k, ivec3 a, ivec3 b) {
    if (k.size.w == 0u) return false;
    ivec3 c = ivec3(k.rotation0.w, k.rotation1.w, k.rotation2.w);
    ivec3 d = (b - a) / 2;
    ivec3 m = a - c + d;
    uint far = maxU(maxU(absolute(m.x), absolute(m.y)), absolute(m.z));
    uint reach = maxU(maxU(absolute(d.x), absolute(d.y)), absolute(d.z));
    if (far > 131071u || reach > 65535u) return false;
    // The last 6 cm at each end do not count, so a box does not block what is attached to it.
    uint length = isqrtNear(squaredLength(d / 4)) * 4u;
    uint spare = minU(60u, length / 2u);
    int kept = length == 0u ? 0 : int(divide((length - spare) << 12u, length));  // Q12
    d = (d / 4 * kept) / 1024;
    // In the box's frame, 4 mm a unit: products stay below 2^31.
    ivec3 o = dotRows(k.rotation0, k.rotation1, k.rotation2, m) / 16384;
    ivec3 h = dotRows(k.rotation0, k.rotation1, k.rotation2, d) / 16384;
    uint ex = (k.size.x + 3u) >> 2u, ey = (k.size.y + 3u) >> 2u, ez = (k.size.z + 3u) >> 2u;
    uint hx = absolute(h.x), hy = absolute(h.y), hz = absolute(h.z);
    if (absolute(o.x) > ex + hx || absolute(o.y) > ey + hy || absolute(o.z) > ez + hz) return false;
    return absolute(o.y * h.z - o.z * h.y) <= ey * hz + ez * hy &&
           absolute(o.z * h.x - o.x * h.z) <= ez * hx + ex * hz &&
           absolute(o.x * h.y - o.y * h.x) <= ex * hy + ey * hx;
}

// ---- heat-occlusion grid: cells that stop radiation, plumes and embers
//
// Layout: one bit per solid cell (x fastest, then y, then z). Then, per 32 cells, the bits of those
// that objects fill and the number of such cells before these. Then two words for each of them:
// object key and texel. A cell of an object is solid while that texel stands.
// Of a cell that never gives way; | slot | material << 24.
FW_CONST uint kOcclusionPermanent = 0x80000000u;
FW_CONST uint kOcclusionSlotMask = 0xFFFFFFu;

FW_FN uint occlusionSide(uint counts, uint axis) { return (counts >> (10u * axis)) & 0x3FFu; }
FW_FN uint occlusionWords(uint counts) {  // of one bit per cell
    return (occlusionSide(counts, 0u) * occlusionSide(counts, 1u) * occlusionSide(counts, 2u) +
            31u) >>
           5u;
}

struct OcclusionWalk {  // visits the cells that a segment crosses, face by face, to 3 mm
    bool within;     // within the grid and the segment
    uint cell;       // current cell
    uint whole;      // mm, length of the segment
    uint passed;     // position on the segment, out of `of`, where it entered this cell
    uint of;
    ivec3 strides;   // to the next cell
    ivec3 room;      // cells left in the grid, per axis
    uvec3 ahead;     // mm along the axis from the start to the next face
    uvec3 span;      // mm along the axis, whole segment
};

struct OcclusionAxis {
    int cell;
    int stride;
    int room;
    uint ahead;
};
// begins, at: mm in the grid, start of the segment and entry point.
FW_FN OcclusionAxis makeOcclusionAxis(int begins, int at, int d, int cells, int side) {
    OcclusionAxis a;
    int inside = at < 0 ? 0 : (at >= cells * side ? cells * side - 1 : at);
    a.cell = int(divide(uint(inside), uint(side)));
    a.stride = d > 0 ? 1 : (d < 0 ? -1 : 0);
    a.room = d > 0 ? cells - 1 - a.cell : (d < 0 ? a.cell : 0);
    int face = d > 0 ? (a.cell + 1) * side - begins : begins - a.cell * side;
    a.ahead = d == 0 || face < 0 ? 1u : uint(face);
    return a;
}
// Position on the segment, Q14, where it enters the slab of an axis; above 16384: never.
FW_FN uint occlusionEntry(int begins, int d, int size) {
    uint outside = begins < 0 ? uint(-begins) : (begins >= size ? uint(begins - size + 1) : 0u);
    if (outside == 0u) return 0u;
    bool comes = begins < 0 ? d > 0 : d < 0;
    if (!comes || outside > absolute(d)) return 16385u;
    return divide(outside << 14u, absolute(d));
}

FW_FN OcclusionWalk beginOcclusionWalk(FW_IN(ExchangePush) g, ivec3 a, ivec3 b) {
    OcclusionWalk w;
    w.within = false;
    w.cell = 0u;
    w.whole = 0u;
    w.passed = 0u;
    w.of = 16384u;
    w.strides = ivec3(0, 0, 0);
    w.room = ivec3(0, 0, 0);
    w.ahead = uvec3(1u, 1u, 1u);
    w.span = uvec3(0u, 0u, 0u);
    ivec3 d = b - a;
    if (g.occlusionCell == 0u || !isWithinExchangeRange(d)) return w;
    ivec3 low = ivec3(g.occlusionX, g.occlusionY, g.occlusionZ);
    ivec3 off = a / 2 - low / 2;  // halves: positions and grid may be 3e9 mm apart
    uint far = maxU(maxU(absolute(off.x), absolute(off.y)), absolute(off.z));
    if (far > 1500000u) return w;
    ivec3 s = a - low;
    int side = int(g.occlusionCell);
    ivec3 n =
        ivec3(int(occlusionSide(g.occlusionCounts, 0u)), int(occlusionSide(g.occlusionCounts, 1u)),
              int(occlusionSide(g.occlusionCounts, 2u)));
    uint enters =
        maxU(maxU(occlusionEntry(s.x, d.x, n.x * side), occlusionEntry(s.y, d.y, n.y * side)),
             occlusionEntry(s.z, d.z, n.z * side));
    if (enters > 16384u) return w;
    int t = int(enters);
    ivec3 at = s + d * t / 16384;
    OcclusionAxis x = makeOcclusionAxis(s.x, at.x, d.x, n.x, side);
    OcclusionAxis y = makeOcclusionAxis(s.y, at.y, d.y, n.y, side);
    OcclusionAxis z = makeOcclusionAxis(s.z, at.z, d.z, n.z, side);
    w.whole = isqrtNear(squaredLength(d));
    w.passed = enters;
    w.cell = uint((z.cell * n.y + y.cell) * n.x + x.cell);
    w.strides = ivec3(x.stride, y.stride * n.x, z.stride * n.x * n.y);
    w.room = ivec3(x.room, y.room, z.room);
    w.ahead = uvec3(x.ahead, y.ahead, z.ahead);
    w.span = uvec3(absolute(d.x), absolute(d.y), absolute(d.z));
    // Rounding may place the entry beside the grid: then it never is within.
    w.within = at.x >= -1 && at.y >= -1 && at.z >= -1 && at.x <= n.x * side && at.y <= n.y * side &&
               at.z <= n.z * side;
    return w;
}

// Moves to the next cell. Products of a length and a distance ahead stay below 2^31.
FW_FN void stepOcclusionWalk(FW_INOUT(OcclusionWalk) w, uint side) {
    bool alongX = w.ahead.x * w.span.y < w.ahead.y * w.span.x;
    uint ahead = alongX ? w.ahead.x : w.ahead.y, span = alongX ? w.span.x : w.span.y;
    bool alongZ = w.ahead.z * span < ahead * w.span.z;
    w.passed = alongZ ? w.ahead.z : ahead;
    w.of = alongZ ? w.span.z : span;
    int room = alongZ ? w.room.z : (alongX ? w.room.x : w.room.y);
    w.within = room > 0 && w.passed < w.of;
    w.cell += uint(alongZ ? w.strides.z : (alongX ? w.strides.x : w.strides.y));
    ivec3 along = alongZ ? ivec3(0, 0, 1) : (alongX ? ivec3(1, 0, 0) : ivec3(0, 1, 0));
    w.room -= along;
    w.ahead += uvec3(along) * side;
}

// Objects at both ends, and the distance within which their own cells do not count.
struct OcclusionEnds {
    uint from;       // slot
    uint to;
    uint fromSpare;  // mm
    uint toSpare;
};
// Is the current cell too near to an end? Everything within one cell of an end is, so what supports
// a fire does not block it. slot: owner of the cell; kNoneTexel: the host, which counts as either
// end.
FW_FN bool isNearWalkEnd(FW_IN(OcclusionWalk) w, FW_IN(OcclusionEnds) e, uint slot, uint side) {
    uint at = (w.whole * divide(w.passed << 12u, w.of)) >> 12u;
    uint from = slot == e.from || slot == kNoneTexel ? e.fromSpare : side;
    uint to = slot == e.to || slot == kNoneTexel ? e.toSpare : side;
    return at < from || w.whole < at + to + side / 2u;
}
FW_FN OcclusionEnds emberOcclusionEnds(FW_IN(FireSource) s, uint to, uint side) {
    OcclusionEnds e;
    e.from = s.object;
    e.to = to;
    e.fromSpare = side * 2u + minU(s.diameter / 2u, 1000u);
    e.toSpare = side * 2u;
    return e;
}
// From a flame to a surface. Own walls: a source stands for many texels, and flux that arrives at a
// grazing angle crosses many cells of its own surface.
FW_FN OcclusionEnds flameOcclusionEnds(FW_IN(FireSource) s, ivec3 flame, uint to, ivec3 at,
                                       ivec3 normal, uint side) {
    OcclusionEnds e = emberOcclusionEnds(s, to, side);
    ivec3 d = flame - at;
    if (!isWithinExchangeRange(d)) return e;
    uint over = absolute((normal.x / 4) * d.x + (normal.y / 4) * d.y + (normal.z / 4) * d.z) >> 10u;
    // mm until one cell above it.
    uint leaves = divide(side * isqrtNear(squaredLength(d)), maxU(over, 1u));
    e.toSpare = maxU(e.toSpare, minU(leaves + leaves / 2u, side * 6u));
    return e;
}

// ---- flames

// x^0.4, Q8; 0 for 0.
FW_FN uint power04(uint x) {
    if (x == 0u) return 0u;
    uint fours = 0u;
    while (x >= 32768u) {  // x^0.4 of a 32nd is a 4th
        x >>= 5u;
        fours += 2u;
    }
    uint k = uint(findMSB(x));
    uint f = ((x << 15u) >> k) & 0x7FFFu;  // Q15
    uint rest = k % 5u;
    // 2^(0.4 rest), Q12
    uint base = rest == 0u   ? 4096u
                : rest == 1u ? 5405u
                : rest == 2u ? 7132u
                : rest == 3u ? 9410u
                             : 12417u;
    // Q15.
    uint m = 32768u + ((10470u * f) >> 15u) + ((2140u * ((f * (32768u - f)) >> 15u)) >> 15u);
    return ((base * m) >> 19u) << (k / 5u * 2u + fours);
}

// Diameter in mm of a disc of `area` mm^2.
FW_FN uint fireDiameter(uint area) {
    return isqrtNear(minU(mulShift(area, 83443u, 16u), 0xFFFC0000u));
}
// Flame height in mm (Heskestad); a wide weak fire counts as many small ones. scale:
// power04(watts).
FW_FN uint flameHeight(uint scale, uint diameter) {
    uint tall = mulShift(scale, 3796u, 16u);
    uint less = diameter + diameter / 50u;
    return maxU(tall - minU(less, tall), tall / 3u);
}

// Turns sums into a source in the world. An empty source stays empty.
FW_FN void settleSource(FW_INOUT(FireSource) s, FW_IN(ExchangeObject) o) {
    s.watts = s.tiles == 0u ? 0u : s.power >> 4u;
    if (s.watts == 0u) return;
    ivec3 middle = ivec3(int(divide(s.sumX, s.tiles) * 4u), int(divide(s.sumY, s.tiles) * 4u),
                         int(divide(s.sumZ, s.tiles) * 4u));
    ivec3 at = toWorldMm(o, middle);
    s.scale = power04(s.watts);
    s.diameter = fireDiameter(mulShift(minU(s.texels, 0x7FFFFFu) << 8u, o.texelArea, 8u));
    s.place = ivec4(at.x, at.y, at.z, int(minU(flameHeight(s.scale, s.diameter), 30000u)));
}

FW_FN ivec3 alongFlame(FW_IN(FireSource) s, ivec3 up, int eighths) {
    int h = (s.place.w * eighths) >> 3;
    return ivec3(s.place.x, s.place.y, s.place.z) + ((up * h) >> 12);
}

// Radiation from one point of a flame. normal: Q12; nearest: mm.
FW_FN uint fluxFrom(ivec3 flame, uint watts, uint nearest, ivec3 at, ivec3 normal, bool both) {
    ivec3 d = flame - at;
    if (!isWithinExchangeRange(d)) return 0u;
    uint length = maxU(isqrtNear(squaredLength(d)), 1u);
    int along = (normal.x / 4) * d.x + (normal.y / 4) * d.y + (normal.z / 4) * d.z;  // Q10
    if (along <= 0 && !both) return 0u;
    uint cosine = minU(divide(absolute(along), length) >> 2u, 256u);
    uint far = maxU(length, nearest);
    return pointFlux(watts, kRadiantShare, cosine, divide(far * far + 50u, 100u));
}

// W/m^2 that a flame sends to a surface there.
FW_FN uint radiantFlux(FW_IN(FireSource) s, ivec3 up, ivec3 at, ivec3 normal, bool both) {
    uint nearest = maxU(s.diameter, kNearest) / 2u;
    ivec3 middle = alongFlame(s, up, 4);
    ivec3 d = middle - at;
    if (!isWithinExchangeRange(d)) return 0u;
    uint size = maxU(s.diameter, uint(s.place.w)) * 2u;
    bool row =
        size >= 65535u || squaredLength(d) <= size * size;  // near: four points along the flame
    // A loop, not a branch: a software device would execute both sides of a branch.
    uint part = row ? s.watts / 4u : s.watts, sum = 0u;
    int end = row ? 8 : 5, apart = row ? 2 : 4, eighths = row ? 1 : 4;
    do {
        sum += fluxFrom(alongFlame(s, up, eighths), part, nearest, at, normal, both);
        eighths += apart;
    } while (eighths < end);
    return minU(sum, kMaxFlux);
}

// K above ambient on a plume's axis, z mm above its base: McCaffrey's three zones.
FW_FN uint plumeRise(uint z, uint scale) {
    if (scale == 0u) return 0u;
    uint q = divide(minU(z, 65535u) * 4057u, scale);  // 1/1000 of z / Q^0.4
    if (q < 80u) return 800u;
    if (q < 200u) return divide(63000u, q);
    uint rise = 315u << 8u;  // Q8, falls with the power 5/3: factor 0.315 an octave
    while (q >= 400u) {
        q = (q + 1u) >> 1u;
        rise = (rise * 20643u) >> 16u;
    }
    uint x = q - 200u;  // [0, 200): piecewise linear, Q12
    uint part = x < 50u    ? 4096u - ((x * 1272u) / 50u)
                : x < 100u ? 2824u - (((x - 50u) * 740u) / 50u)
                : x < 150u ? 2084u - (((x - 100u) * 472u) / 50u)
                           : 1612u - (((x - 150u) * 322u) / 50u);
    return (rise * part) >> 20u;
}

struct FlameFrame {  // a receiver in a flame's frame
    int above;       // mm above its base
    uint beside2;    // mm^2 from its axis
    bool near;       // within kExchangeFar
};
FW_FN FlameFrame flameFrame(FW_IN(FireSource) s, ivec3 up, ivec3 at) {
    FlameFrame f;
    ivec3 d = at - ivec3(s.place.x, s.place.y, s.place.z);
    f.near = isWithinExchangeRange(d);
    f.above = 0;
    f.beside2 = 0xFFFFFFFFu;
    if (!f.near) return f;
    f.above = (up.x * d.x + up.y * d.y + up.z * d.z) / 4096;
    uint square = squaredLength(d), high = absolute(f.above) * absolute(f.above);
    f.beside2 = square - minU(high, square);
    return f;
}

// W/m^2 from a plume to a surface at `heat`, 1/16 K; ambient: 1/16 K.
FW_FN uint plumeFlux(FW_IN(FireSource) s, FW_IN(FlameFrame) f, uint heat, uint ambient) {
    uint width = (uint(f.above) * 492u) / 4096u + s.diameter / 2u;  // mm: 0.12 z + D/2
    width = minU(maxU(width, 10u), 20000u);
    uint square = width * width, flux = 0u;
    // A loop costs nothing where no plume arrives.
    for (bool within = f.near && f.above > 0 && f.beside2 < square * 9u; within; within = false) {
        uint x = divide(f.beside2, (square >> 12u) + 1u) * 23u;  // (r/b)^2 log2(e), Q16
        uint gas = (plumeRise(uint(f.above), s.scale) * halvings(x)) >> 12u;  // 1/16 K
        uint mine = heat > ambient ? heat - ambient : 0u;
        flux = gas > mine ? ((gas - mine) * kPlumeTransfer) >> 4u : 0u;
    }
    return flux;
}

// Does this flame ignite the vapours of a hot surface there?
FW_FN bool flameLights(FW_IN(FireSource) s, FW_IN(FlameFrame) f) {
    if (!f.near || f.above < -int(kPilotReach) || f.above > s.place.w) return false;
    uint reach = s.diameter / 2u + kPilotReach;
    return f.beside2 <= reach * reach;
}

FW_FN ivec3 boxMiddle(FW_IN(ExchangeObject) o) {
    ivec3 low = ivec3(o.rotation0.w, o.rotation1.w, o.rotation2.w);
    return low + (ivec3(o.high.x, o.high.y, o.high.z) - low) / 2;
}

struct Received {
    uint flux;   // W/m^2
    uint pilot;  // 1: a flame is near
};
// Heat from one source at a position, under the world's switches. seen: visible share, of 255.
FW_FN Received receivedFrom(FW_IN(FireSource) s, uint flags, uint ambient, ivec3 up, ivec3 at,
                            ivec3 normal, bool both, uint seen) {
    Received r;
    FlameFrame f = flameFrame(s, up, at);
    uint flux = 0u;
    if ((flags & kExchangeRadiation) != 0u) flux += radiantFlux(s, up, at, normal, both);
    if ((flags & kExchangePlume) != 0u) flux += plumeFlux(s, f, ambient, ambient);
    r.flux = divide(minU(flux, kMaxFlux) * minU(seen, 255u), 255u);
    r.pilot = (flags & (kExchangeRadiation | kExchangePlume)) != 0u && flameLights(s, f) ? 1u : 0u;
    return r;
}

// Weight of a source at a position, to choose among many; about W/cm^2.
FW_FN uint sourceWeight(FW_IN(FireSource) s, ivec3 at) {
    ivec3 d = ivec3(s.place.x, s.place.y, s.place.z) - at;
    if (s.watts == 0u || !isWithinExchangeRange(d)) return 0u;
    uint square = maxU(divide(squaredLength(d), 100u), 100u);
    return divide(minU(s.watts, 0xFFFFFFu) << 8u, square) + 1u;
}

// ---- ignition rules

FW_FN uint multiplyChances(uint a, uint b) { return mulShift(a, b, 16u); }
FW_FN bool drawn(uint hash, uint chance) { return (hash >> 16u) < chance; }
FW_FN uint mixed(uint a, uint b) { return hash32(a ^ (hash32(b) + 0x9E3779B9u)); }

// Decided once per pair and fire. caught: tick at which the source object was found alight.
FW_FN bool mayReach(uint seed, uint from, uint to, uint caught, uint chance) {
    return drawn(mixed(mixed(mixed(seed, from), to), caught), chance);
}
FW_FN bool mayTransfer(FW_IN(ExchangeObject) o, uint hops, uint maxWorldHops) {
    return (o.flags & kExchangeGives) != 0u && hops < minU(o.hopsMost, maxWorldHops);
}

// Updates an object's lit and stop ticks at an exchange.
FW_FN void recordFire(FW_INOUT(ObjectCounters) c, FW_IN(ExchangeObject) o,
                      FW_IN(ExchangePush) rules) {
    c.spotTexel &= ~kSpotFresh;
    if (c.ignited == 0u) {
        // An object that heats it may light it by the next exchange.
        if ((c.held & kHeldWarm) == 0u) c.litBy = 0u;
        c.litTick = 0u;
        c.stopTick = 0u;
    } else if (c.litTick == 0u) {
        uint life = minU(o.lifeTicks, rules.lifeTicks);
        c.litTick = rules.now;
        c.stopTick = life > 0xF0000000u ? 0u : rules.now + life;
    }
}

// Key of the object that lit another: fewest jumps win, then the lowest slot, in any order. 0: none
// yet.
FW_CONST uint kLitByHand = 0xFFFFFFFFu;
FW_FN uint litBy(uint hops, uint from) {
    return ~((minU(hops + 1u, 254u) << 24u) | (from & 0xFFFFFFu)) & 0xFFFFFFFFu;
}
FW_FN uint hopsOf(uint by) { return (by == 0u || by == kLitByHand) ? 0u : (~by) >> 24u; }
FW_FN uint igniterOf(uint by) {  // slot, or kNoneTexel
    return (by == 0u || by == kLitByHand) ? kNoneTexel : (~by) & 0xFFFFFFu;
}

FW_FN bool stoppedAt(uint stopTick, uint now) { return stopTick != 0u && now >= stopTick; }
// Is a tile that does not burn held back by a limit? Counts are those before the iteration.
FW_FN bool holdsTile(uint tileFlag, uint burning, uint maxWorld, uint objectBurning,
                     uint objectFlags, uint maxObject) {
    if ((tileFlag & kTileBurning) != 0u) return false;
    return burning >= maxWorld ||
           ((objectFlags & kExchangeLive) != 0u && objectBurning >= maxObject);
}
// kHeld bits of an object at an exchange.
FW_FN uint heldBits(uint burning, uint maxWorld, uint objectBurning, uint maxObject, uint stopTick,
                    uint now) {
    uint held = (burning >= maxWorld || objectBurning >= maxObject) ? kHeldByLimit : 0u;
    return held | (stoppedAt(stopTick, now) ? kHeldStopped : 0u);
}
// May another object light a tile with this flag?
FW_FN bool mayCatch(uint held, uint tileFlag) {
    return (held & kHeldStopped) == 0u &&
           ((held & kHeldByLimit) == 0u || (tileFlag & kTileBurning) != 0u);
}

// Tick at which fire crossed a contact, or kNever. t: state of the source texel. It must have burnt
// at the exchange before, so texels lit in the current one do not count, in any order.
FW_FN uint contactTick(uint t, uint flameTicks, uint delay, uint since, uint now) {
    if (!isSource(t) || t + kExchangeTicks >= now) return kNever;
    uint begins = maxU(t, since);
    uint arrives = begins + delay;
    if (arrives > now || !flames(t, arrives, flameTicks)) return kNever;
    return arrives + kExchangeTicks < now ? now : arrives;
}

// Lane of a tile's block from which fire leaves over a link between two parts of a mesh. The target
// is `link` % kPartTexels.
FW_FN uint partFrom(uint link, uint block) {
    uint lane = link >> 28u;
    return ((block >> 1u) * 4u + (lane >> 2u)) * 8u + (block & 1u) * 4u + (lane & 3u);
}
// Ticks over such a link: those of an ordinary link of that length, in position units, in still
// air.
FW_FN uint partDelay(FW_IN(BurnMaterial) to, ivec3 gap) {
    return mulShift(to.sigma0, isqrtNear(squaredLength(gap)) * 8u, 22u);
}
// Has fire crossed it? t: state of the source texel, lit before the last exchange, as for a
// contact.
FW_FN bool partCrossed(uint t, uint flameTicks, uint delay, uint now) {
    return isSource(t) && t + kExchangeTicks < now && delay <= now - t &&
           flames(t, now, flameTicks);
}
// Tick of the exchange that finds fire at the target.
FW_FN uint partArrives(uint t, uint delay) {
    uint arrives = maxU(t + delay, t + kExchangeTicks + 1u);
    return (arrives + kExchangeTicks - 1u) / kExchangeTicks * kExchangeTicks;
}

// ---- embers

// World axis most parallel to `up`: axis * 2 | 1 if it points down.
FW_FN uint upAxis(ivec3 up) {
    uint ux = absolute(up.x), uy = absolute(up.y), uz = absolute(up.z);
    uint axis = (uy >= ux && uy >= uz) ? 1u : ux >= uz ? 0u : 2u;
    int along = axis == 0u ? up.x : axis == 1u ? up.y : up.z;
    return axis * 2u + (along < 0 ? 1u : 0u);
}
FW_FN int heightOf(ivec3 p, uint axis) {
    int h = axis < 2u ? p.x : axis < 4u ? p.y : p.z;
    return (axis & 1u) != 0u ? -h : h;
}
FW_FN ivec3 acrossUp(ivec3 p, uint axis) {
    return axis < 2u ? ivec3(0, p.y, p.z) : axis < 4u ? ivec3(p.x, 0, p.z) : ivec3(p.x, p.y, 0);
}
// Height of an object's top below a position, mm; kNoTop: the position is beside or under it.
FW_CONST int kNoTop = -2147483647;
FW_FN int topBelow(FW_IN(ExchangeObject) o, ivec3 at, uint axis) {
    ivec3 low = acrossUp(ivec3(o.rotation0.w, o.rotation1.w, o.rotation2.w), axis);
    ivec3 high = acrossUp(ivec3(o.high.x, o.high.y, o.high.z), axis);
    ivec3 p = acrossUp(at, axis);
    if (p.x < low.x || p.y < low.y || p.z < low.z || p.x > high.x || p.y > high.y || p.z > high.z)
        return kNoTop;
    int top = (axis & 1u) != 0u ? heightOf(ivec3(o.rotation0.w, o.rotation1.w, o.rotation2.w), axis)
                                : heightOf(ivec3(o.high.x, o.high.y, o.high.z), axis);
    return top <= heightOf(at, axis) ? top : kNoTop;
}
// How badly a tile matches a landing position, [0, kMisses]: least wins.
FW_CONST uint kMisses = 16383u;
FW_FN uint landingMiss(FW_IN(ExchangeObject) o, FW_IN(ExchangeTile) tile, ivec3 at, int top,
                       uint axis) {
    if (tile.texels == 0u) return kMisses;
    int facing = heightOf(turnToWorld(o, decodeNormal(tile.normal)), axis);
    if ((o.flags & kExchangeTwoSided) != 0u) facing = facing < 0 ? -facing : facing;
    if (facing < 512) return kMisses;
    ivec3 p = toWorldMm(o, tileMiddle(tile));
    ivec3 d = acrossUp(p - at, axis);
    if (absolute(d.x) > 2000u || absolute(d.y) > 2000u || absolute(d.z) > 2000u) return kMisses;
    uint beside = isqrtNear(squaredLength(d));
    int below = top - heightOf(p, axis);
    uint miss = beside * 2u + uint(below < 0 ? 0 : (below > 16000 ? 16000 : below)) / 2u;
    return minU(miss, kMisses);
}

struct Ember {
    uint flight;     // ticks of flight: an ember that lands now started then
    uint energy;     // J left
    ivec3 landing;   // mm; its height is the start plus the loft
};

// Hash of the ember that the source sends in this exchange; 0: none.
FW_FN uint emberOf(uint seed, uint from, uint cell, uint now, uint power, uint brands) {
    uint roll = mixed(mixed(seed ^ 0x5EEDE3BEu, from * kSourcesPerObject + cell), now);
    uint high, low;
    umulExtended(power, brands, high, low);
    uint chance = high != 0u ? 0xFFFFFFFFu : low;
    return roll < chance ? (hash32(roll) | 1u) : 0u;
}

// A char disc, 1 to 4 mm thick, lofted one to four flame heights, falling at terminal speed.
FW_FN Ember flyingEmber(FW_IN(FireSource) s, uint hash, ivec3 up, ivec3 wind) {
    Ember e;
    uint a = hash32(hash), b = hash32(hash + 1u), c = hash32(hash + 2u);
    uint thick = (a & 3u);
    uint falls = thick == 0u ? 1410u : thick == 1u ? 2000u : thick == 2u ? 2450u : 2830u;  // mm/s
    uint loft =
        minU((maxU(uint(s.place.w), 50u) * (256u + ((b & 0xFFFFu) * 768u >> 16u))) >> 8u, 30000u);
    uint seconds = minU(divide(loft << 12u, falls), 20u << 12u);  // Q12: ticks, too
    e.flight = seconds;
    // Lateral spread: a quarter of the loft. Wind carries it 28 m at most.
    int spread = int(loft / 4u) + int(s.diameter / 2u);
    int jx = (int(c & 0xFFFFu) - 32768) * (spread >> 2) / 8192;
    int jz = (int(c >> 16u) - 32768) * (spread >> 2) / 8192;
    ivec3 carried = (wind / 8) * int(seconds >> 4u) / 32;
    // Jitter lies across `up`, along the two world axes least parallel to it.
    uint axis = upAxis(up);
    ivec3 jitter = axis < 2u ? ivec3(0, jx, jz) : axis < 4u ? ivec3(jx, 0, jz) : ivec3(jx, jz, 0);
    ivec3 shift = carried + jitter;
    shift = clamp(shift, ivec3(-28000), ivec3(28000));
    e.landing = ivec3(s.place.x, s.place.y, s.place.z) + shift + ((up * int(loft)) >> 12);
    uint life = (thick + 1u) * (10u << 12u);  // it loses 0.1 mm a second
    uint whole = (thick + 1u) * 225u;         // J
    e.energy = seconds >= life ? 0u : divide(whole * ((life - seconds) >> 4u), life >> 4u);
    return e;
}

// Horizontal distance of a texel from a position, mm, [0, 65535].
FW_FN uint besidePlace(FW_IN(ExchangeObject) o, ivec3 position, ivec3 at, uint axis) {
    ivec3 p = toWorldMm(o, position);
    ivec3 d = acrossUp(p - at, axis);
    return isWithinExchangeRange(d) ? isqrtNear(squaredLength(d)) : 65535u;
}
// Is `other` in the disc that an ember on `lane` of the same tile lights?
FW_FN bool besideLane(uint lane, uint other) {
    int dx = int(lane & 7u) - int(other & 7u), dy = int(lane >> 3u) - int(other >> 3u);
    return dx >= -1 && dx <= 1 && dy >= -1 && dy <= 1;
}

// Ignition probability of kChanceOne: 1 - exp(-E / 200 J), damped by moisture.
FW_FN uint emberLights(uint energy, uint catches) {
    uint unlit = halvings(minU(energy, 4000u) * 473u);  // Q16: log2(e) / 200
    return ((65536u - minU(unlit, 65536u)) * minU(catches, 256u)) >> 8u;
}

// ---- burn budget: which of the tiles that request to burn may do so, see lib/burn_budget.glsl

// Set beside kSwitchGoverned: the number of burning tiles is limited.
FW_CONST uint kSwitchCapped = 0x20000u;
// The pass only requests and lights nothing. In `burn_budget`: the front's due tiles request
// through it.
FW_CONST uint kSwitchRequests = 0x40000u;

// Tiles that may still start to burn.
FW_FN uint remainingTiles(uint burning, uint most) { return most - minU(burning, most); }
// Allocation order: by hash, then by place, so the order of requests does not matter.
FW_FN uint requestOrder(uint object, uint local, uint now) {
    return mixed(mixed(now, object), local);
}
FW_FN bool requestPrecedes(FW_IN(uvec4) a, FW_IN(uvec4) b) {  // order, object, local tile
    if (a.x != b.x) return a.x < b.x;
    return a.y != b.y ? a.y < b.y : a.z < b.z;
}
FW_SHARED_END
#endif
