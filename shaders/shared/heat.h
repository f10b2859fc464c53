// Heat, fuel and water of one texel over one heat step. Integers only, for C++ and GLSL; no buffer
// access and no neighbours. Arrival of the front is in front.h.
//
// One temperature stands for a surface skin. The skin of thick fuel deepens as heat soaks in: pi/2
// * k * (T - Ta) / |net flux|, the exact solution of a half-space at constant flux, without a
// stored profile. Fractions below a unit are rounded by a hash, so sums stay true.
// clang-format off
#ifndef FW_SHARED_HEAT_H
#define FW_SHARED_HEAT_H
#include "shared/front.h"

FW_SHARED_BEGIN

FW_CONST uint kFuelFull = 65535u;        // fuel of an unburnt texel
FW_CONST uint kBoiling = 5970u;          // 373 K, 1/16 K
FW_CONST uint kPyrolysisBegins = 6770u;  // 423 K: thick fuel begins to consume itself,
FW_CONST uint kPyrolysisSpan = 4800u;    // full rate 300 K above
FW_CONST uint kScorchBegins = 7568u;     // 473 K: begins to darken
FW_CONST uint kMaxFlux = 500000u;       // W/m^2, incoming or net: beyond any fire
FW_CONST uint kMaxFilm = 1023u;         // g/m^2
FW_CONST uint kMaxMoist = 255u;         // 1/128 kg/kg
// Steps of flaming under a film before the flame dies, minus one.
FW_CONST uint kSoakSteps = 3u;
FW_CONST uint kSleepTolerance = 16u;  // 1/16 K from ambient that still count as asleep
FW_CONST uint kColdWaterSteps =
    32u;  // steps from one update to the next of a tile that only has cold water
// Steps from one update to the next of a texel that is only warm: no flame, no water, too cold to
// char, and a flux too small to heat it much (wood needs 10 kW/m^2 to catch).
FW_CONST uint kSleepShift = 3u;
FW_CONST uint kSleepSteps = 1u << kSleepShift;
FW_CONST uint kSleepFlux = 4096u;         // W/m^2: from here on it is updated every step
// The longer interval below a flux of noon sun.
FW_CONST uint kLongSleepShift = 5u;
FW_CONST uint kLongSleepFlux = 1024u;          // W/m^2

// HeatTexel::phase
FW_CONST uint kPhaseFresh = 0u;
FW_CONST uint kPhaseBurning = 1u;
FW_CONST uint kPhaseBurnt = 2u;
FW_CONST uint kPhaseOut = 3u;            // extinguished, fuel left

// heatStep's result for its caller, which owns the front's state (bits).
FW_CONST uint kHeatIgnites = 1u;
FW_CONST uint kHeatExtinguishes = 2u;
FW_CONST uint kHeatBurnsOut = 4u;
FW_CONST uint kHeatDries = 8u;           // its film has dried

// HeatMaterial::flags
FW_CONST uint kHeatBurns = 1u;
FW_CONST uint kHeatThick = 2u;
// 9 bits, Q8: reduction of burning strength by lack of air.
FW_CONST uint kHeatLacksShift = 8u;

struct HeatTexel {
    uint fuel;     // kFuelFull .. 0
    uint heat;     // temperature, 1/16 K, [0, 65535]
    uint film;     // g/m^2 of water on the surface, [0, kMaxFilm]
    uint soaked;   // steps of flaming under a film, [0, kSoakSteps]
    uint moist;    // 1/128 kg/kg of water inside, [0, kMaxMoist]
    uint charred;  // [0, 255]: scorched to burnt; cosmetic
    uint epoch;    // re-ignitions, modulo 4
    uint phase;
};

struct HeatMaterial {     // one material for one step length and pace, baked by fire/heat.h
    uint absorbs;         // of incoming flux, Q8
    uint radiates;        // of black-body radiation, Q8
    uint convects;        // W/m^2/K, Q8
    uint ownFlux;         // W/m^2 of feedback from its own flame
    uint inertia;         // thick: pi/2 * k rho c / dt, W^2/m^4/K^2; thin: 0
    uint minCapacity;   // rho c depth / dt, W/m^2/K, Q8, of the thinnest skin; thin: of the sheet
    uint maxCapacity;    // of the full thickness
    uint ambient;         // 1/16 K
    uint burnRate;        // thick: fuel units per step, Q16, hot and uncharred, in still air
    uint charSpan;        // Q16 halvings of that rate under the char of all its fuel
    uint charFloor;       // Q16 of the rate that char cannot stop
    uint ignitesAt;       // 1/16 K, piloted ignition
    uint ignitesAlone;    // 1/16 K, spontaneous ignition
    uint diesAt;          // 1/16 K: below, the flame dies
    uint maxFilm;        // g/m^2; more runs off
    uint filmFlux;        // W/m^2 that evaporate 1 g/m^2 in a step
    uint moistFlux;       // W/m^2 that evaporate one unit of moisture in a step
    uint moistDies;       // moisture of extinction, 1/128
    uint flags;
    uint airDries;        // g/m^2 of film that dry per step in cold air, Q16
    uint moistureAtRest;     // 1/128
    uint burnTicks;       // thin: ticks that a whole texel flames
    uint energy;          // of a fuel unit of one texel, 2^-20 J
    float watts;          // thick: W per fuel unit and step (cosmetic)
};
FW_SIZE(HeatMaterial, 96)

FW_FN uvec2 packHeat(FW_IN(HeatTexel) x) {
    return uvec2(x.fuel | (x.heat << 16u), x.film | (x.soaked << 10u) | (x.moist << 12u) |
                                               (x.charred << 20u) | (x.epoch << 28u) |
                                               (x.phase << 30u));
}
FW_FN HeatTexel unpackHeat(uvec2 words) {
    HeatTexel x;
    x.fuel = words.x & 0xFFFFu;
    x.heat = words.x >> 16u;
    x.film = words.y & 0x3FFu;
    x.soaked = (words.y >> 10u) & 3u;
    x.moist = (words.y >> 12u) & 0xFFu;
    x.charred = (words.y >> 20u) & 0xFFu;
    x.epoch = (words.y >> 28u) & 3u;
    x.phase = words.y >> 30u;
    return x;
}

FW_FN uint minU(uint a, uint b) { return a < b ? a : b; }
FW_FN uint maxU(uint a, uint b) { return a > b ? a : b; }

// n / d, rounded up with the odds of the remainder: unbiased over many draws. n + d < 2^32.
FW_FN uint divideByChance(uint n, uint d, uint chance) {
    uint part, low;
    umulExtended(chance, d, part, low);
    return divide(n + part, d);
}

// Black-body radiation, W/m^2, of 1/16 K: sigma T^4.
FW_FN uint radiation(uint heat) {
    uint square = heat * heat;
    uint fourth, low;
    umulExtended(square, square, fourth, low);  // K^4 / 2^16
    return mulHighRound(fourth, 15960685u);     // sigma * 2^16, Q32
}
// Slope of radiation(), 4 sigma T^3, W/m^2/K, Q8.
FW_FN uint radiationSlope(uint heat) {
    uint cube = mulShift((heat * heat) >> 8u, heat, 16u);  // K^3 / 2^12
    return mulHighRound(cube, 1021483845u);                // 4 sigma * 2^20, Q32
}

// 2^-x, x and the result Q16.
FW_FN uint halvings(uint x) {
    uint whole = x >> 16u;
    if (whole > 16u) return 0u;
    uint f = x & 0xFFFFu;
    // error at most 0.0004
    uint r = 573u;
    r = 3637u - ((r * f) >> 16u);
    r = 15743u - ((r * f) >> 16u);
    r = 45426u - ((r * f) >> 16u);
    r = 65536u - ((r * f) >> 16u);
    return r >> whole;
}

// Share of the full pyrolysis rate at this temperature, Q12.
FW_FN uint pyrolysis(uint heat) {
    if (heat <= kPyrolysisBegins) return 0u;
    uint y = minU(divide((heat - kPyrolysisBegins) << 12u, kPyrolysisSpan), 4096u);
    return (((y * y) >> 12u) * (12288u - 2u * y)) >> 12u;
}

// Fuel left of thin material after `age` ticks of flaming, of `burnTicks`: 1 - smoothstep, so its
// rate rises and falls.
FW_FN uint thinFuel(uint age, uint burnTicks) {
    if (age >= burnTicks) return 0u;
    uint shift = 0u;
    while ((burnTicks >> shift) >= 65536u) shift += 1u;
    uint y = minU(divide((age >> shift) << 15u, maxU(burnTicks >> shift, 1u)), 32768u);  // Q15
    uint square = (y * y) >> 15u;
    uint gone = (square * (98304u - 2u * y)) >> 15u;  // Q15
    return kFuelFull - minU(gone * 2u, kFuelFull);
}
// Age at which this much fuel is left: a re-lit sheet continues from there.
FW_FN uint thinAge(uint fuel, uint burnTicks) {
    uint low = 0u, high = burnTicks;
    while (low < high) {
        uint middle = low + (high - low) / 2u;
        if (thinFuel(middle, burnTicks) <= fuel) high = middle;
        else low = middle + 1u;
    }
    return low;
}

// Flux from a point source at a receiver, W/m^2: share * power * cosine / (4 pi d^2). power: W;
// share: radiated fraction / (4 pi), Q16; cosine: Q8; distance2: cm^2, not 0.
FW_FN uint pointFlux(uint power, uint share, uint cosine, uint distance2) {
    uint sent = mulShift(power, share, 16u);  // W per sr
    uint whole = divide(sent, distance2);     // W/cm^2
    if (whole >= 0x10000u) return cosine == 0u ? 0u : kMaxFlux;
    uint rest = sent - whole * distance2;
    uint part =
        distance2 < 0x100000u ? divide(rest << 12u, distance2) : divide(rest, distance2 >> 12u);
    return minU(mulShift((whole << 12u) + part, 10000u * cosine, 20u), kMaxFlux);
}

// Adds water; more than the material's film runs off.
FW_FN void wetTexel(FW_INOUT(HeatTexel) x, uint grams, FW_IN(HeatMaterial) m) {
    x.film = minU(x.film + minU(grams, kMaxFilm), minU(m.maxFilm, kMaxFilm));
}

// The material in air of this burning strength (airStrength): it consumes and heats itself less.
FW_FN HeatMaterial materialInAir(FW_IN(HeatMaterial) m, uint strength) {
    HeatMaterial weak = m;
    weak.ownFlux = (m.ownFlux * strength) >> 8u;
    weak.burnRate = mulShift(m.burnRate, strength, 8u);
    weak.flags |= (kAirFull - strength) << kHeatLacksShift;
    return weak;
}
FW_FN uint airDeficit(FW_IN(HeatMaterial) m) { return m.flags >> kHeatLacksShift; }
FW_FN bool isSmothered(FW_IN(HeatMaterial) m) { return airDeficit(m) >= kAirFull; }

// Capacity of the skin, W/m^2/K, Q8. Water boils off at the least depth, as depth cannot follow;
// ash has a quarter of that. rise: 1/16 K from ambient; size: W/m^2, net flux.
FW_FN uint skinCapacity(FW_IN(HeatTexel) x, FW_IN(HeatMaterial) m, uint rise, uint size) {
    uint least = m.minCapacity >> (x.phase == kPhaseBurnt ? 2u : 0u);
    if (m.inertia == 0u || x.phase == kPhaseBurnt || (x.film != 0u && x.heat > kBoiling))
        return least;
    uint reach = divide(rise << 12u, maxU(size, 1u));  // K per W/m^2, Q16
    return minU(maxU(mulShift(m.inertia, reach, 8u), m.minCapacity), m.maxCapacity);
}
// W/m^2/K, Q8, against a change of temperature: capacity and losses, linearly implicit.
FW_FN uint heatResistance(FW_IN(HeatTexel) x, FW_IN(HeatMaterial) m, uint capacity) {
    return maxU(capacity + m.convects + mulShift(radiationSlope(x.heat), m.radiates, 8u), 1u);
}
// Water takes `spare` W/m^2 beyond boiling: first the film, then the moisture. Returns what it
// took.
FW_FN uint boilOff(FW_INOUT(HeatTexel) x, FW_IN(HeatMaterial) m, uint spare, uint chance,
                   FW_OUT(uint) evaporated) {
    evaporated =
        x.film == 0u ? 0u : minU(divideByChance(spare, m.filmFlux, hash32(chance)), x.film);
    x.film -= evaporated;
    uint spent = evaporated * m.filmFlux;
    if (x.moist == 0u || spent >= spare) return spent;
    uint units = minU(divideByChance(spare - spent, m.moistFlux, hash32(chance + 1u)), x.moist);
    x.moist -= units;
    return spent + units * m.moistFlux;
}

// One step. flux: W/m^2 from other objects; air: wind gain of the burning rate, Q8, 256 = still;
// pilot: a flame is near; chance: hash of texel and step. burnt: fuel units lost; evaporated: g/m^2
// of film evaporated by fire. Returns kHeat bits, already applied to x.
FW_FN uint heatStep(FW_INOUT(HeatTexel) x, FW_IN(HeatMaterial) m, uint flux, uint air, bool pilot,
                    uint chance, FW_OUT(uint) burnt, FW_OUT(uint) evaporated) {
    burnt = 0u;
    evaporated = 0u;
    uint result = 0u;
    bool flaming = x.phase == kPhaseBurning;

    // Balance, W/m^2.
    uint coming = ((minU(flux, kMaxFlux) * m.absorbs) >> 8u) + (flaming ? m.ownFlux : 0u);
    int above = int(x.heat) - int(m.ambient);
    int net = int(coming) + int(mulShift(radiation(m.ambient), m.radiates, 8u)) -
              int(mulShift(radiation(x.heat), m.radiates, 8u)) - ((int(m.convects) * above) >> 12);
    int most = int(kMaxFlux);
    net = net > most ? most : (net < -most ? -most : net);
    uint size = uint(net < 0 ? -net : net);

    uint rise = uint(above < 0 ? -above : above);
    uint resists = heatResistance(x, m, skinCapacity(x, m, rise, size));
    uint change = divideByChance(size << 12u, resists, chance);
    uint heat = net < 0 ? x.heat - minU(change, x.heat) : minU(x.heat + change, 65535u);

    if (heat > kBoiling && (x.film | x.moist) != 0u) {
        uint spare = minU(mulShift(heat - kBoiling, resists, 12u), 0x7FFFFFFu);  // W/m^2
        bool wet = x.film != 0u;
        uint spent = boilOff(x, m, spare, chance, evaporated);
        if (wet && x.film == 0u) result |= kHeatDries;
        uint cooled = divide(minU(spent, 0x7FFFFFFu) << 5u, maxU(resists >> 7u, 1u));
        heat = (x.film | x.moist) != 0u ? kBoiling : maxU(heat - minU(cooled, heat), kBoiling);
    }
    x.heat = heat;
    if (x.film != 0u) {
        uint dried = (m.airDries >> 16u) + ((m.airDries & 0xFFFFu) > (chance & 0xFFFFu) ? 1u : 0u);
        x.film -= minU(dried, x.film);
        if (x.film == 0u) result |= kHeatDries;
    }

    if (flaming) {
        if ((m.flags & kHeatThick) != 0u) {
            uint gone = kFuelFull - x.fuel;
            uint bare = halvings(mulShift(m.charSpan, gone, 16u));
            uint share = m.charFloor + (((65536u - m.charFloor) * (bare >> 1u)) >> 15u);  // Q16
            uint rate = mulShift(mulShift(m.burnRate, pyrolysis(heat) * air, 20u), share, 16u);
            burnt = minU((rate >> 16u) + ((rate & 0xFFFFu) > (chance >> 16u) ? 1u : 0u), x.fuel);
            x.fuel -= burnt;
        }
        x.soaked = x.film != 0u ? x.soaked + 1u : 0u;
        if (x.fuel == 0u) {
            x.phase = kPhaseBurnt;
            result |= kHeatBurnsOut;
        } else if (heat < m.diesAt || x.soaked > kSoakSteps || isSmothered(m)) {
            x.phase = kPhaseOut;
            result |= kHeatExtinguishes;
        }
        x.soaked = minU(x.soaked, kSoakSteps);
    } else {
        x.soaked = 0u;
        bool ready = (m.flags & kHeatBurns) != 0u && x.phase != kPhaseBurnt && x.fuel != 0u &&
                     x.film == 0u && x.moist < m.moistDies && !isSmothered(m);
        if (ready && heat >= (pilot ? m.ignitesAt : m.ignitesAlone)) {
            if (x.phase == kPhaseOut) x.epoch = (x.epoch + 1u) & 3u;
            x.phase = kPhaseBurning;
            result |= kHeatIgnites;
        }
    }

    uint scorch = heat <= kScorchBegins ? 0u : minU((heat - kScorchBegins) / 24u, 160u);
    uint eaten = (kFuelFull - x.fuel) >> 8u;
    if ((m.flags & kHeatBurns) != 0u) x.charred = maxU(x.charred, maxU(scorch, eaten));
    return result;
}

// ---- A texel and its state in the front. A texel under water, or too damp, is a barrier (kWet,
// kOutWet) exactly while it is that.

FW_FN bool isBarrierByWater(FW_IN(HeatTexel) x, FW_IN(HeatMaterial) m) {
    return x.film != 0u || x.moist >= m.moistDies;
}
FW_FN uint wetState(uint t, bool closed) {
    if (t == kNever || t == kWet) return closed ? kWet : kNever;
    if (t == kOut || t == kOutWet) return closed ? kOutWet : kOut;
    return t;
}

// An unheated texel. Material that cannot burn counts as burnt.
FW_FN HeatTexel unheatedTexel(FW_IN(HeatMaterial) m, bool burns) {
    HeatTexel x;
    x.fuel = kFuelFull;
    x.heat = m.ambient;
    x.film = 0u;
    x.soaked = 0u;
    x.moist = m.moistureAtRest;
    x.charred = 0u;
    x.epoch = 0u;
    x.phase = burns ? kPhaseFresh : kPhaseBurnt;
    return x;
}

// A jet gives `flux` W/m^2 for one step, in addition to the step itself: first to the water, then
// to the skin.
FW_FN void applyJetHeat(FW_INOUT(HeatTexel) x, FW_IN(HeatMaterial) m, uint flux, uint chance) {
    uint size = (minU(flux, kMaxFlux) * m.absorbs) >> 8u;
    uint rise = x.heat > m.ambient ? x.heat - m.ambient : 0u;
    uint resists = heatResistance(x, m, skinCapacity(x, m, rise, size));
    uint heat = minU(x.heat + divideByChance(size << 12u, resists, chance), 65535u);
    if (heat > kBoiling && (x.film | x.moist) != 0u) {
        uint spare = minU(mulShift(heat - kBoiling, resists, 12u), 0x7FFFFFFu);  // W/m^2
        uint evaporated;
        boilOff(x, m, spare, chance, evaporated);
        heat = maxU(minU(heat, kBoiling), x.heat);
    }
    x.heat = heat;
}

// Does a texel let a jet pass that met it as a gate (TexelEvent)? No event of the step can change
// the answer: neither phase nor ignition of a burnt-out texel changes.
FW_FN bool gateOpens(uint gateKind, uint holeTicks, FW_IN(HeatTexel) x, uint t, uint now) {
    bool gone =
        x.phase == kPhaseBurnt && x.fuel == 0u && isSource(t) && t <= now && now - t >= holeTicks;
    return gone == ((gateKind & kGateShut) == 0u);
}

// State copied from a texel of another object; the material is the receiver's.
FW_FN HeatTexel carriedTexel(FW_IN(HeatTexel) from, FW_IN(HeatMaterial) m) {
    HeatTexel x = from;
    x.film = minU(x.film, minU(m.maxFilm, kMaxFilm));
    return x;
}
// Can states be copied between these texels? Both can burn, or neither can.
FW_FN bool carries(uint from, uint to) { return from != kInert && to != kInert; }

// Effect of one event on a texel and its state. Water alone does not extinguish: heat steps do,
// when it takes more than the fire gives. tick: as TexelEvent, W/m^2 for kEventHeat; now: start of
// the step.
FW_FN uint heatEvent(FW_INOUT(HeatTexel) x, FW_IN(HeatMaterial) m, uint t, uint kind, uint tick,
                     uint now) {
    if (kind == kEventIgnite) return applyEvent(t, kind, tick, now);
    if (kind == kEventWet) wetTexel(x, tick, m);
    if (kind == kEventDry) x.film = 0u;
    if (kind == kEventHeat) {
        applyJetHeat(x, m, tick, hash32(x.heat * 0x9E3779B9u + now));
        t = wetState(t, isBarrierByWater(x, m));
        bool ready = (m.flags & kHeatBurns) != 0u && x.phase != kPhaseBurnt && x.fuel != 0u &&
                     !isBarrierByWater(x, m);
        return ready && x.heat >= m.ignitesAt ? applyEvent(t, kEventIgnite, now, now) : t;
    }
    if (kind == kEventExtinguish && isSource(t) && x.phase != kPhaseBurnt) {
        if (x.phase == kPhaseBurning) x.phase = kPhaseOut;
        x.heat = minU(x.heat, m.diesAt);
        t = kOut;
    }
    return wetState(t, isBarrierByWater(x, m));
}

// Random number per texel and step; `step`: a hash of the step's tick.
FW_FN uint heatChance(uint texel, uint step) { return hash32(texel * 0x9E3779B9u + step); }

// How often heat steps update a texel: never (0), at intervals if it has cold water
// (kWorkColdWater) or is only warm (kWorkWarm), or always (kWorkAlways).
FW_CONST uint kWorkColdWater = 1u;
FW_CONST uint kWorkWarm = 2u;
FW_CONST uint kWorkAlways = 4u;
FW_FN uint workOfFlux(uint flux) {
    return flux == 0u ? 0u : flux < kSleepFlux ? kWorkWarm : kWorkAlways;
}
FW_FN uint workOfTexel(FW_IN(HeatTexel) x, uint t, uint flux, uint ambient) {
    uint off = x.heat > ambient ? x.heat - ambient : ambient - x.heat;
    bool warm = off > kSleepTolerance || flux != 0u;
    bool flames = x.phase == kPhaseBurning || (isSource(t) && x.phase != kPhaseBurnt);
    if (flames || x.heat > kPyrolysisBegins || flux >= kSleepFlux || (warm && x.film != 0u))
        return kWorkAlways;
    return x.film != 0u ? kWorkColdWater : warm ? kWorkWarm : 0u;
}

// One heat step at tick `now` of a texel with state t. Returns the new state. burnt: fuel units.
FW_FN uint heatTexelStep(FW_INOUT(HeatTexel) x, FW_IN(HeatMaterial) m, uint t, uint now, uint flux,
                         bool pilot, uint air, uint chance, FW_OUT(uint) burnt) {
    bool lit = isSource(t) && t <= now;
    bool fresh = lit && (x.phase == kPhaseFresh || x.phase == kPhaseOut);  // the front lit it
    if (fresh) {
        x.epoch = (x.epoch + (x.phase == kPhaseOut ? 1u : 0u)) & 3u;
        x.phase = kPhaseBurning;
        x.heat = maxU(x.heat, m.ignitesAt);
    }
    // Bad air slows its clock: consumption, appearance, and the front's wait for it.
    uint passes = kHeatSteps * kStepTicks;
    uint waits = (passes * airDeficit(m)) >> 8u;
    if (lit && x.phase == kPhaseBurning) t += minU(waits, now - t);
    uint gone = 0u;
    if (lit && x.phase == kPhaseBurning && (m.flags & kHeatThick) == 0u) {
    // A re-lit sheet continues with the fuel it has.
        uint age = thinAge(x.fuel, x.epoch != 0u ? m.burnTicks : 0u);
        uint next = thinFuel(age + passes - waits, m.burnTicks);
        uint left = thinFuel(now - t, m.burnTicks);
        left = minU(x.epoch != 0u ? minU(left, next) : left, x.fuel);
        gone = x.fuel - left;
        x.fuel = left;
    }
    uint evaporated;
    uint result = heatStep(x, m, flux, air, pilot, chance, burnt, evaporated);
    burnt += gone;
    if ((result & kHeatExtinguishes) != 0u) t = kOut;
    if ((result & kHeatIgnites) != 0u) t = now;
    t = wetState(t, isBarrierByWater(x, m));
    // Exact return to ambient, so no trace of a past fire is kept or sent.
    if (workOfTexel(x, t, flux, m.ambient) == 0u) x.heat = m.ambient;
    return t;
}

// The material over all steps of a sleep interval at once; a burning texel takes one step.
FW_FN uint sleepShift(uint flux) { return flux < kLongSleepFlux ? kLongSleepShift : kSleepShift; }
FW_FN HeatMaterial heatMaterialOver(FW_IN(HeatMaterial) m, bool sleeps, uint flux) {
    uint shift = sleeps ? sleepShift(flux) : 0u;
    HeatMaterial long_ = m;
    long_.inertia = m.inertia == 0u ? 0u : maxU(m.inertia >> shift, 1u);
    long_.minCapacity = m.minCapacity >> shift;
    long_.maxCapacity = m.maxCapacity >> shift;
    long_.filmFlux = maxU(m.filmFlux >> shift, 1u);
    long_.moistFlux = maxU(m.moistFlux >> shift, 1u);
    long_.airDries = m.airDries << shift;
    return long_;
}
// The same for cold water, once in kColdWaterSteps steps.
FW_FN uint dryColdWater(FW_INOUT(HeatTexel) x, FW_IN(HeatMaterial) m, uint t, uint chance) {
    uint dries = m.airDries * kColdWaterSteps;
    uint dried = (dries >> 16u) + ((dries & 0xFFFFu) > (chance & 0xFFFFu) ? 1u : 0u);
    x.film -= minU(dried, x.film);
    return wetState(t, isBarrierByWater(x, m));
}

// Work classes of a tile that are due in this step. A tile's flux changes only where an interval of
// kSleepSteps steps ends, so the interval has one flux. Where a change alters the interval, some
// steps count twice or never, equally often.
FW_FN bool sleepEnds(uint tile, uint flux, uint now) {
    uint turn = now / (kStepTicks * kHeatSteps) + 1u;
    return ((turn - tile) & ((1u << sleepShift(flux)) - 1u)) == 0u;
}
FW_FN bool coldWaterTurn(uint object, uint tile, uint now) {
    uint turn = now / (kStepTicks * kHeatSteps) + hash32(object * 0x9E3779B9u + tile);
    return (turn & (kColdWaterSteps - 1u)) == 0u;
}
FW_FN uint workDue(bool warm, uint object, uint tile, uint flux, uint now) {
    return (warm ? kWorkAlways : 0u) | (sleepEnds(tile, flux, now) ? kWorkWarm : 0u) |
           (coldWaterTurn(object, tile, now) ? kWorkColdWater : 0u);
}
// Work of a texel under its tile's due classes: in a warm tile cold water takes every step, as an
// ordinary one. The texel is due if (work & turn) is not 0.
FW_FN uint workThisStep(uint work, uint turn) {
    return work == kWorkColdWater && (turn & kWorkAlways) != 0u ? kWorkAlways : work;
}

FW_SHARED_END
#endif
