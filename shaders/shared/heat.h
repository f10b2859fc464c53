// Heat, fuel and water of one texel over one heat step. Integers only, one text for C++ and GLSL;
// it loads nothing and knows no neighbour. Not the front (front.h): that says when a texel catches.
//
// The surface is one temperature over a skin. Thick fuel's skin deepens as heat soaks in, pi/2 *
// k * (T - Ta) / |net flux|: at constant flux that is the exact solution of a half-space, without
// a profile to store. What is less than a unit is decided by a hash: sums stay true.
// GLSL too, and laid out by hand.
// clang-format off
#ifndef FW_SHARED_HEAT_H
#define FW_SHARED_HEAT_H
#include "shared/front.h"

FW_SHARED_BEGIN

FW_SHARED_CONST uint kFuelFull = 65535u;        // a texel's whole fuel
FW_SHARED_CONST uint kBoiling = 5970u;          // 373 K, 1/16 K
FW_SHARED_CONST uint kPyrolysisBegins = 6770u;  // 423 K: thick fuel consumes itself from here,
FW_SHARED_CONST uint kPyrolysisSpan = 4800u;    // fully 300 K above
FW_SHARED_CONST uint kScorchBegins = 7568u;     // 473 K: darkens from here
FW_SHARED_CONST uint kFluxMost = 500000u;       // W/m^2, in or net: beyond any fire
FW_SHARED_CONST uint kFilmMost = 1023u;         // g/m^2
FW_SHARED_CONST uint kMoistMost = 255u;         // 1/128 kg/kg
FW_SHARED_CONST uint kSoaksOut = 3u;            // steps under a film before a flame dies: one more
FW_SHARED_CONST uint kLukewarm = 16u;           // 1/16 K off the ambient that still count as at rest
FW_SHARED_CONST uint kDozes = 32u;              // steps between those of a tile with cold water only
// Steps between those of a texel that is only warm: no flame, no water, too cold to char, and too
// little comes to it to make it much warmer (wood needs 10 kW/m^2 to catch).
FW_SHARED_CONST uint kRestsShift = 3u;
FW_SHARED_CONST uint kRests = 1u << kRestsShift;
FW_SHARED_CONST uint kRestFlux = 4096u;         // W/m^2: from here on it takes every step
// And of one that less than the sun of noon comes to.
FW_SHARED_CONST uint kNapsShift = 5u;
FW_SHARED_CONST uint kNapFlux = 1024u;          // W/m^2

// HeatTexel::phase
FW_SHARED_CONST uint kPhaseFresh = 0u;
FW_SHARED_CONST uint kPhaseBurning = 1u;
FW_SHARED_CONST uint kPhaseBurnt = 2u;
FW_SHARED_CONST uint kPhaseOut = 3u;            // extinguished with fuel left

// What heatStep tells its caller, who owns the front's state (bits).
FW_SHARED_CONST uint kHeatIgnites = 1u;
FW_SHARED_CONST uint kHeatExtinguishes = 2u;
FW_SHARED_CONST uint kHeatBurnsOut = 4u;
FW_SHARED_CONST uint kHeatDries = 8u;           // its film is gone

// HeatMaterial::flags
FW_SHARED_CONST uint kHeatBurns = 1u;
FW_SHARED_CONST uint kHeatThick = 2u;
FW_SHARED_CONST uint kHeatLacksShift = 8u;      // 9 bits, Q8: what its fire lacks of its strength, for want of air

struct HeatTexel {
    uint fuel;     // kFuelFull .. 0
    uint heat;     // temperature, 1/16 K, [0, 65535]
    uint film;     // water on it, g/m^2, [0, kFilmMost]
    uint soaked;   // steps that it flamed under a film, [0, kSoaksOut]
    uint moist;    // water in it, 1/128 kg per kg, [0, kMoistMost]
    uint charred;  // for looks, [0, 255]: scorched to burnt
    uint epoch;    // re-ignitions, modulo 4
    uint phase;
};

struct HeatMaterial {     // one material, one step length and one pace: fire/heat.h bakes it
    uint absorbs;         // of incoming flux, Q8
    uint radiates;        // of black-body radiation, Q8
    uint convects;        // W/m^2/K, Q8
    uint ownFlux;         // W/m^2 that its own flame gives back
    uint inertia;         // thick: pi/2 * k rho c / dt, W^2/m^4/K^2; thin: 0
    uint capacityLeast;   // rho c depth / dt, W/m^2/K, Q8: of the least skin; thin: of the sheet
    uint capacityMost;    // of the whole thickness
    uint ambient;         // 1/16 K
    uint burnRate;        // thick: fuel units a step, Q16, hot and not yet charred, in still air
    uint charSpan;        // Q16 halvings of that rate under the char of all its fuel
    uint charFloor;       // Q16 of the rate that no char stops
    uint ignitesAt;       // 1/16 K with a flame near
    uint ignitesAlone;    // 1/16 K without
    uint diesAt;          // 1/16 K: below, a flame goes out
    uint filmMost;        // g/m^2; the rest runs off
    uint filmFlux;        // W/m^2 that take 1 g/m^2 in a step
    uint moistFlux;       // W/m^2 that take one unit of moisture in a step
    uint moistDies;       // moisture of extinction, 1/128
    uint flags;
    uint airDries;        // g/m^2 of film that go a step in cold air, Q16
    uint moistAtRest;     // 1/128
    uint burnTicks;       // thin: ticks that a whole texel flames
    uint energy;          // of a fuel unit of one texel, 2^-20 J
    float watts;          // thick: of a fuel unit a step (looks)
};
FW_SHARED_SIZE(HeatMaterial, 96)

FW_SHARED_FN uvec2 packHeat(FW_IN(HeatTexel) x) {
    return uvec2(x.fuel | (x.heat << 16u),
                 x.film | (x.soaked << 10u) | (x.moist << 12u) | (x.charred << 20u) |
                     (x.epoch << 28u) | (x.phase << 30u));
}
FW_SHARED_FN HeatTexel unpackHeat(uvec2 words) {
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

FW_SHARED_FN uint leastOf(uint a, uint b) { return a < b ? a : b; }
FW_SHARED_FN uint mostOf(uint a, uint b) { return a > b ? a : b; }

// n / d, up with the odds of the remainder: over many draws nothing is lost or made. n + d < 2^32.
FW_SHARED_FN uint divideByChance(uint n, uint d, uint chance) {
    uint part, low;
    umulExtended(chance, d, part, low);
    return divide(n + part, d);
}

// Black-body radiation, W/m^2, of 1/16 K: sigma T^4.
FW_SHARED_FN uint radiation(uint heat) {
    uint square = heat * heat;
    uint fourth, low;
    umulExtended(square, square, fourth, low);  // K^4 / 2^16
    return mulHighRound(fourth, 15960685u);     // sigma * 2^16, Q32
}
// Its slope, 4 sigma T^3, W/m^2/K, Q8.
FW_SHARED_FN uint radiationSlope(uint heat) {
    uint cube = mulShift((heat * heat) >> 8u, heat, 16u);  // K^3 / 2^12
    return mulHighRound(cube, 1021483845u);                // 4 sigma * 2^20, Q32
}

// 2^-x, x and the result Q16.
FW_SHARED_FN uint halvings(uint x) {
    uint whole = x >> 16u;
    if (whole > 16u) return 0u;
    uint f = x & 0xFFFFu;
    // 1 - 0.69315 f + 0.24023 f^2 - 0.05550 f^3 + 0.00874 f^4: 0.0004 too much at most.
    uint r = 573u;
    r = 3637u - ((r * f) >> 16u);
    r = 15743u - ((r * f) >> 16u);
    r = 45426u - ((r * f) >> 16u);
    r = 65536u - ((r * f) >> 16u);
    return r >> whole;
}

// Share of the full pyrolysis rate at this temperature, Q12.
FW_SHARED_FN uint pyrolysis(uint heat) {
    if (heat <= kPyrolysisBegins) return 0u;
    uint y = leastOf(divide((heat - kPyrolysisBegins) << 12u, kPyrolysisSpan), 4096u);
    return (((y * y) >> 12u) * (12288u - 2u * y)) >> 12u;
}

// Fuel that thin stuff has left after `age` ticks of flaming, of `burnTicks`: 1 - smoothstep, so
// its rate rises and falls.
FW_SHARED_FN uint thinFuel(uint age, uint burnTicks) {
    if (age >= burnTicks) return 0u;
    uint shift = 0u;
    while ((burnTicks >> shift) >= 65536u) shift += 1u;
    uint y = leastOf(divide((age >> shift) << 15u, mostOf(burnTicks >> shift, 1u)), 32768u);  // Q15
    uint square = (y * y) >> 15u;
    uint gone = (square * (98304u - 2u * y)) >> 15u;  // Q15
    return kFuelFull - leastOf(gone * 2u, kFuelFull);
}
// The age at which it has this much left: a re-lit sheet goes on from there.
FW_SHARED_FN uint thinAge(uint fuel, uint burnTicks) {
    uint low = 0u, high = burnTicks;
    while (low < high) {
        uint middle = low + (high - low) / 2u;
        if (thinFuel(middle, burnTicks) <= fuel) high = middle;
        else low = middle + 1u;
    }
    return low;
}

// Flux at a receiver from a point source, W/m^2: share * power * cosine / (4 pi d^2).
// power: W; share: radiated fraction / (4 pi), Q16; cosine: Q8; distance2: cm^2, not 0.
FW_SHARED_FN uint pointFlux(uint power, uint share, uint cosine, uint distance2) {
    uint sent = mulShift(power, share, 16u);  // W per sr
    uint whole = divide(sent, distance2);     // W/cm^2
    if (whole >= 0x10000u) return cosine == 0u ? 0u : kFluxMost;
    uint rest = sent - whole * distance2;
    uint part = distance2 < 0x100000u ? divide(rest << 12u, distance2)
                                      : divide(rest, distance2 >> 12u);
    return leastOf(mulShift((whole << 12u) + part, 10000u * cosine, 20u), kFluxMost);
}

// Water that lands: what exceeds the material's film runs off.
FW_SHARED_FN void heatWets(FW_INOUT(HeatTexel) x, uint grams, FW_IN(HeatMaterial) m) {
    x.film = leastOf(x.film + leastOf(grams, kFilmMost), leastOf(m.filmMost, kFilmMost));
}

// The material in air that fire burns in as strongly (airStrength): it consumes and warms itself less.
FW_SHARED_FN HeatMaterial heatInAir(FW_IN(HeatMaterial) m, uint strength) {
    HeatMaterial weak = m;
    weak.ownFlux = (m.ownFlux * strength) >> 8u;
    weak.burnRate = mulShift(m.burnRate, strength, 8u);
    weak.flags |= (kAirFull - strength) << kHeatLacksShift;
    return weak;
}
FW_SHARED_FN uint heatLacks(FW_IN(HeatMaterial) m) { return m.flags >> kHeatLacksShift; }
FW_SHARED_FN bool heatChokes(FW_IN(HeatMaterial) m) { return heatLacks(m) >= kAirFull; }

// One step. flux: W/m^2 from elsewhere; air: wind's gain of the burning rate, Q8, 256 = still;
// pilot: a flame is near; chance: a hash of texel and step. burnt: fuel units that went;
// evaporated: g/m^2 of film that took fire's heat. Returns kHeat bits, already worked into x.
FW_SHARED_FN uint heatStep(FW_INOUT(HeatTexel) x, FW_IN(HeatMaterial) m, uint flux, uint air,
                           bool pilot, uint chance, FW_OUT(uint) burnt, FW_OUT(uint) evaporated) {
    burnt = 0u;
    evaporated = 0u;
    uint told = 0u;
    bool flaming = x.phase == kPhaseBurning;

    // What comes in and goes out, W/m^2.
    uint coming = ((leastOf(flux, kFluxMost) * m.absorbs) >> 8u) + (flaming ? m.ownFlux : 0u);
    int above = int(x.heat) - int(m.ambient);
    int net = int(coming) + int(mulShift(radiation(m.ambient), m.radiates, 8u)) -
              int(mulShift(radiation(x.heat), m.radiates, 8u)) - ((int(m.convects) * above) >> 12);
    int most = int(kFluxMost);
    net = net > most ? most : (net < -most ? -most : net);
    uint size = uint(net < 0 ? -net : net);

    // What it takes to warm the skin: linearly implicit, so no step is too long. What boils water
    // off has the least, as depth cannot follow; ash a quarter of that.
    uint capacity = m.capacityLeast >> (x.phase == kPhaseBurnt ? 2u : 0u);
    if (m.inertia != 0u && x.phase != kPhaseBurnt && (x.film == 0u || x.heat <= kBoiling)) {
        uint rise = uint(above < 0 ? -above : above);
        uint reach = divide(rise << 12u, mostOf(size, 1u));  // K per W/m^2, Q16
        capacity = mulShift(m.inertia, reach, 8u);
        capacity = leastOf(mostOf(capacity, m.capacityLeast), m.capacityMost);
    }
    uint slope = mulShift(radiationSlope(x.heat), m.radiates, 8u);
    uint resists = mostOf(capacity + m.convects + slope, 1u);
    uint change = divideByChance(size << 12u, resists, chance);
    uint heat = net < 0 ? x.heat - leastOf(change, x.heat) : leastOf(x.heat + change, 65535u);

    // Beyond boiling, water takes the heat first: the film, then what is soaked in.
    if (heat > kBoiling && (x.film | x.moist) != 0u) {
        uint spare = leastOf(mulShift(heat - kBoiling, resists, 12u), 0x7FFFFFFu);  // W/m^2
        uint spent = 0u;
        if (x.film != 0u) {
            evaporated = leastOf(divideByChance(spare, m.filmFlux, hash32(chance)), x.film);
            x.film -= evaporated;
            spent = evaporated * m.filmFlux;
            if (x.film == 0u) told |= kHeatDries;
        }
        if (x.moist != 0u && spent < spare) {
            uint units = divideByChance(spare - spent, m.moistFlux, hash32(chance + 1u));
            units = leastOf(units, x.moist);
            x.moist -= units;
            spent += units * m.moistFlux;
        }
        uint cooled = divide(leastOf(spent, 0x7FFFFFFu) << 5u, mostOf(resists >> 7u, 1u));
        heat = (x.film | x.moist) != 0u ? kBoiling
                                        : mostOf(heat - leastOf(cooled, heat), kBoiling);
    }
    x.heat = heat;
    if (x.film != 0u) {
        uint dried = (m.airDries >> 16u) + ((m.airDries & 0xFFFFu) > (chance & 0xFFFFu) ? 1u : 0u);
        x.film -= leastOf(dried, x.film);
        if (x.film == 0u) told |= kHeatDries;
    }

    if (flaming) {
        if ((m.flags & kHeatThick) != 0u) {
            uint gone = kFuelFull - x.fuel;
            uint bare = halvings(mulShift(m.charSpan, gone, 16u));
            uint share = m.charFloor + (((65536u - m.charFloor) * (bare >> 1u)) >> 15u);  // Q16
            uint rate = mulShift(mulShift(m.burnRate, pyrolysis(heat) * air, 20u), share, 16u);
            burnt = leastOf((rate >> 16u) + ((rate & 0xFFFFu) > (chance >> 16u) ? 1u : 0u), x.fuel);
            x.fuel -= burnt;
        }
        x.soaked = x.film != 0u ? x.soaked + 1u : 0u;
        if (x.fuel == 0u) {
            x.phase = kPhaseBurnt;
            told |= kHeatBurnsOut;
        } else if (heat < m.diesAt || x.soaked > kSoaksOut || heatChokes(m)) {
            x.phase = kPhaseOut;
            told |= kHeatExtinguishes;
        }
        x.soaked = leastOf(x.soaked, kSoaksOut);
    } else {
        x.soaked = 0u;
        bool ready = (m.flags & kHeatBurns) != 0u && x.phase != kPhaseBurnt && x.fuel != 0u &&
                     x.film == 0u && x.moist < m.moistDies && !heatChokes(m);
        if (ready && heat >= (pilot ? m.ignitesAt : m.ignitesAlone)) {
            if (x.phase == kPhaseOut) x.epoch = (x.epoch + 1u) & 3u;
            x.phase = kPhaseBurning;
            told |= kHeatIgnites;
        }
    }

    uint scorch = heat <= kScorchBegins ? 0u : leastOf((heat - kScorchBegins) / 24u, 160u);
    uint eaten = (kFuelFull - x.fuel) >> 8u;
    if ((m.flags & kHeatBurns) != 0u) x.charred = mostOf(x.charred, mostOf(scorch, eaten));
    return told;
}

// ---- A texel and its state in the front ----------------------------------------------------------
// The state stays the front's: these say what it becomes. A texel under water, or too damp, is a
// barrier (kWet, kOutWet) exactly while it is that.

FW_SHARED_FN bool heatClosed(FW_IN(HeatTexel) x, FW_IN(HeatMaterial) m) {
    return x.film != 0u || x.moist >= m.moistDies;
}
FW_SHARED_FN uint wetState(uint t, bool closed) {
    if (t == kNever || t == kWet) return closed ? kWet : kNever;
    if (t == kOut || t == kOutWet) return closed ? kOutWet : kOut;
    return t;
}

// A new texel. What cannot burn is as good as burnt.
FW_SHARED_FN HeatTexel heatRests(FW_IN(HeatMaterial) m, bool burns) {
    HeatTexel x;
    x.fuel = kFuelFull;
    x.heat = m.ambient;
    x.film = 0u;
    x.soaked = 0u;
    x.moist = m.moistAtRest;
    x.charred = 0u;
    x.epoch = 0u;
    x.phase = burns ? kPhaseFresh : kPhaseBurnt;
    return x;
}

// A flame that blows on it gives `flux` W/m^2 for a step, beside what the step itself does: its
// water first, then its skin.
FW_SHARED_FN void heatBlows(FW_INOUT(HeatTexel) x, FW_IN(HeatMaterial) m, uint flux, uint chance) {
    uint size = (leastOf(flux, kFluxMost) * m.absorbs) >> 8u;
    uint capacity = m.capacityLeast >> (x.phase == kPhaseBurnt ? 2u : 0u);
    if (m.inertia != 0u && x.phase != kPhaseBurnt && (x.film == 0u || x.heat <= kBoiling)) {
        uint rise = x.heat > m.ambient ? x.heat - m.ambient : 0u;
        uint reach = divide(rise << 12u, mostOf(size, 1u));
        capacity = leastOf(mostOf(mulShift(m.inertia, reach, 8u), m.capacityLeast), m.capacityMost);
    }
    uint slope = mulShift(radiationSlope(x.heat), m.radiates, 8u);
    uint resists = mostOf(capacity + m.convects + slope, 1u);
    uint heat = leastOf(x.heat + divideByChance(size << 12u, resists, chance), 65535u);
    if (heat > kBoiling && (x.film | x.moist) != 0u) {
        uint spare = leastOf(mulShift(heat - kBoiling, resists, 12u), 0x7FFFFFFu);  // W/m^2
        uint gone = leastOf(divideByChance(spare, m.filmFlux, hash32(chance)), x.film);
        x.film -= gone;
        uint spent = gone * m.filmFlux;
        if (x.moist != 0u && spent < spare)
            x.moist -= leastOf(divideByChance(spare - spent, m.moistFlux, hash32(chance + 1u)),
                               x.moist);
        heat = mostOf(leastOf(heat, kBoiling), x.heat);
    }
    x.heat = heat;
}

// Does a texel let pass what came to it as `gate` (TexelEvent)? No event of the step can change
// that: of what has burnt out neither phase nor ignition does.
FW_SHARED_FN bool gateLets(uint gateKind, uint holeTicks, FW_IN(HeatTexel) x, uint t, uint now) {
    bool gone = x.phase == kPhaseBurnt && x.fuel == 0u && isSource(t) && t <= now &&
                now - t >= holeTicks;
    return gone == ((gateKind & kGateShut) == 0u);
}

// Takes over what has become of a texel of another object; the material is its own.
FW_SHARED_FN HeatTexel heatCarried(FW_IN(HeatTexel) from, FW_IN(HeatMaterial) m) {
    HeatTexel x = from;
    x.film = leastOf(x.film, leastOf(m.filmMost, kFilmMost));
    return x;
}
// Both can burn, or do not.
FW_SHARED_FN bool carries(uint from, uint to) { return from != kInert && to != kInert; }

// What one event makes of texel and state. Water does not put out by itself: heat steps do, when it
// takes more than the fire gives. tick: as TexelEvent, W/m^2 of kEventHeat; now: start of the step.
FW_SHARED_FN uint heatEvent(FW_INOUT(HeatTexel) x, FW_IN(HeatMaterial) m, uint t, uint kind,
                            uint tick, uint now) {
    if (kind == kEventIgnite) return applyEvent(t, kind, tick, now);
    if (kind == kEventWet) heatWets(x, tick, m);
    if (kind == kEventDry) x.film = 0u;
    if (kind == kEventHeat) {
        heatBlows(x, m, tick, hash32(x.heat * 0x9E3779B9u + now));
        t = wetState(t, heatClosed(x, m));
        bool ready = (m.flags & kHeatBurns) != 0u && x.phase != kPhaseBurnt && x.fuel != 0u &&
                     !heatClosed(x, m);
        return ready && x.heat >= m.ignitesAt ? applyEvent(t, kEventIgnite, now, now) : t;
    }
    if (kind == kEventExtinguish && isSource(t) && x.phase != kPhaseBurnt) {
        if (x.phase == kPhaseBurning) x.phase = kPhaseOut;
        x.heat = leastOf(x.heat, m.diesAt);
        t = kOut;
    }
    return wetState(t, heatClosed(x, m));
}

// A draw of its own for every texel and step; `step`: a hash of the step's tick.
FW_SHARED_FN uint heatChance(uint texel, uint step) { return hash32(texel * 0x9E3779B9u + step); }

// What heat steps have to do with a texel: nothing; or once in a while, as with cold water
// (kWorkDozes) or what is only warm (kWorkRests); or in each of them (kWorkAlways).
FW_SHARED_CONST uint kWorkDozes = 1u;
FW_SHARED_CONST uint kWorkRests = 2u;
FW_SHARED_CONST uint kWorkAlways = 4u;
FW_SHARED_FN uint fluxWork(uint flux) {
    return flux == 0u ? 0u : flux < kRestFlux ? kWorkRests : kWorkAlways;
}
FW_SHARED_FN uint heatWork(FW_IN(HeatTexel) x, uint t, uint flux, uint ambient) {
    uint off = x.heat > ambient ? x.heat - ambient : ambient - x.heat;
    bool warm = off > kLukewarm || flux != 0u;
    bool flames = x.phase == kPhaseBurning || (isSource(t) && x.phase != kPhaseBurnt);
    if (flames || x.heat > kPyrolysisBegins || flux >= kRestFlux || (warm && x.film != 0u))
        return kWorkAlways;
    return x.film != 0u ? kWorkDozes : warm ? kWorkRests : 0u;
}

// One heat step at tick `now`, of a texel with state t; the new state comes back. burnt: fuel units.
FW_SHARED_FN uint heatTexelStep(FW_INOUT(HeatTexel) x, FW_IN(HeatMaterial) m, uint t, uint now,
                                uint flux, bool pilot, uint air, uint chance,
                                FW_OUT(uint) burnt) {
    bool lit = isSource(t) && t <= now;
    bool fresh = lit && (x.phase == kPhaseFresh || x.phase == kPhaseOut);  // the front lit it
    if (fresh) {
        x.epoch = (x.epoch + (x.phase == kPhaseOut ? 1u : 0u)) & 3u;
        x.phase = kPhaseBurning;
        x.heat = mostOf(x.heat, m.ignitesAt);
    }
    // In bad air its time passes slower: what it consumes, how it looks, and when the front that
    // waits for it comes.
    uint passes = kHeatSteps * kStepTicks;
    uint waits = (passes * heatLacks(m)) >> 8u;
    if (lit && x.phase == kPhaseBurning) t += leastOf(waits, now - t);
    uint gone = 0u;
    if (lit && x.phase == kPhaseBurning && (m.flags & kHeatThick) == 0u) {
        // Re-lit, it goes on from the fuel it has. (Nothing to search where it is not.)
        uint age = thinAge(x.fuel, x.epoch != 0u ? m.burnTicks : 0u);
        uint next = thinFuel(age + passes - waits, m.burnTicks);
        uint left = thinFuel(now - t, m.burnTicks);
        left = leastOf(x.epoch != 0u ? leastOf(left, next) : left, x.fuel);
        gone = x.fuel - left;
        x.fuel = left;
    }
    uint evaporated;
    uint told = heatStep(x, m, flux, air, pilot, chance, burnt, evaporated);
    burnt += gone;
    if ((told & kHeatExtinguishes) != 0u) t = kOut;
    if ((told & kHeatIgnites) != 0u) t = now;
    t = wetState(t, heatClosed(x, m));
    // What is at rest again is so to the last bit: no trace of a fire long over is kept or sent.
    if (heatWork(x, t, flux, m.ambient) == 0u) x.heat = m.ambient;
    return t;
}

// The material over as many steps at once as a texel waits that rests. What burns takes one.
FW_SHARED_FN uint restShift(uint flux) { return flux < kNapFlux ? kNapsShift : kRestsShift; }
FW_SHARED_FN HeatMaterial heatOver(FW_IN(HeatMaterial) m, bool rests, uint flux) {
    uint shift = rests ? restShift(flux) : 0u;
    HeatMaterial long_ = m;
    long_.inertia = m.inertia == 0u ? 0u : mostOf(m.inertia >> shift, 1u);
    long_.capacityLeast = m.capacityLeast >> shift;
    long_.capacityMost = m.capacityMost >> shift;
    long_.filmFlux = mostOf(m.filmFlux >> shift, 1u);
    long_.moistFlux = mostOf(m.moistFlux >> shift, 1u);
    long_.airDries = m.airDries << shift;
    return long_;
}
// The same for cold water, once in kDozes steps.
FW_SHARED_FN uint heatDozes(FW_INOUT(HeatTexel) x, FW_IN(HeatMaterial) m, uint t, uint chance) {
    uint dries = m.airDries * kDozes;
    uint dried = (dries >> 16u) + ((dries & 0xFFFFu) > (chance & 0xFFFFu) ? 1u : 0u);
    x.film -= leastOf(dried, x.film);
    return wetState(t, heatClosed(x, m));
}

// Of which work a tile's texels take this step. What comes to a tile changes only where a rest of
// kRests steps ends, so all of the time between is under one flux; where a change makes the rests
// longer or shorter, some of it counts twice or never, which is as often this as that.
FW_SHARED_FN bool restEnds(uint tile, uint flux, uint now) {
    uint turn = now / (kStepTicks * kHeatSteps) + 1u;
    return ((turn - tile) & ((1u << restShift(flux)) - 1u)) == 0u;
}
FW_SHARED_FN bool dozeEnds(uint object, uint tile, uint now) {
    uint turn = now / (kStepTicks * kHeatSteps) + hash32(object * 0x9E3779B9u + tile);
    return (turn & (kDozes - 1u)) == 0u;
}
FW_SHARED_FN uint heatTurn(bool warm, uint object, uint tile, uint flux, uint now) {
    return (warm ? kWorkAlways : 0u) | (restEnds(tile, flux, now) ? kWorkRests : 0u) |
           (dozeEnds(object, tile, now) ? kWorkDozes : 0u);
}
// A texel's work as its tile's turn has it: in a warm tile what dozes takes every step, as a plain
// one. Its turn it is where (work & turn) is not 0.
FW_SHARED_FN uint workInTurn(uint work, uint turn) {
    return work == kWorkDozes && (turn & kWorkAlways) != 0u ? kWorkAlways : work;
}

FW_SHARED_END
#endif
