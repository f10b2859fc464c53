// The heating stream of a jet: parcels that leave the nozzle one exchange apart, their flight, and
// the share of a ray's power per texel. Times and power are integers, equal on every backend and at
// every frame rate. The visible particles are fire_emitter's.
#pragma once
#include "flamewright/flamewright.h"
#include "shared/burn.h"

#include <array>
#include <cstdint>
#include <span>

namespace fw::components {

struct EmitterAppearance;

constexpr uint32_t kJetRays = 16;
constexpr uint32_t kJetParcels = 16;  // in flight at once: two seconds of stream
constexpr uint32_t kJetNever = 0xFFFFFFFFu;

constexpr double kJetReach = 4e6;  // m: what a jet strikes lies beyond where it stands

struct JetHit {  // of one ray of a jet
    bool met = false;
    float distance = 0;  // m from the ray's start
    float place[3] = {}, normal[3] = {};
    FwBurnableMeshId object{};  // null: a collider or occluder
    uint32_t texel = 0;

    template <class A>
    void serialize(A& a) {
        a(met, distance, place, normal);
        a.texel("a jet's ray", object, texel);
        a.range("ray's distance", distance, -1e6, 1e6);
        a.range("ray's place", place, -kJetReach, kJetReach);
        a.range("ray's normal", normal, -1e6, 1e6);
    }
};
using JetHits = std::array<JetHit, kJetRays>;

// mm that a parcel has flown at each exchange after its launch. Air slows it as it slows the
// stream's particles.
using JetFlight = std::array<uint32_t, kJetParcels + 1>;
[[nodiscard]] JetFlight jetFlight(const EmitterAppearance& appearance) noexcept;
// Ticks from launch until the parcel has flown `millimetres`, between `exchange` and `exchange`
// + 1.
[[nodiscard]] uint32_t jetArrival(const JetFlight& flight, uint32_t exchange,
                                  uint32_t millimetres) noexcept;

// A texel that may have burnt away before a ray reaches it; only the backend knows. The ray heats
// the texel if it still stands, and the surface behind it if not.
struct JetGate {
    uint32_t object = 0, texel = 0;  // slot
    uint32_t holeTicks = 0;          // ticks from ignition to burn-through
    float distance = 0;              // m from the ray's start
    bool operator==(const JetGate&) const = default;

    template <class A>
    void serialize(A& a) {
        a.texel("a hole", object, texel);
        a(holeTicks, distance);
    }
};
constexpr uint32_t kJetGates = gpu::kGates;  // a ray ends at a further gate

struct JetRay {
    float way[3] = {};  // direction, unit
    JetHit hit;         // in the world's geometry of `version`
    uint64_t version = 0;
    uint32_t spent = kJetNever;  // tick of the exchange at which it ended
    std::array<JetGate, kJetGates> gates{};
    std::array<uint32_t, kJetGates> passed{};  // exchanges, ticks
    uint32_t gateCount = 0;

    // Of its version whether it is the present one: 1 or 0 while it is saved.
    template <class A>
    void serialize(A& a) {
        bool present = version != 0;
        a(way, hit, present, spent, gateCount);
        version = present ? 1 : 0;
        a.range("ray's direction", way, -1e6, 1e6);
        a.require(gateCount <= kJetGates, "number of holes that a ray passed");
        for (uint32_t i = 0; i < gateCount; ++i) a(gates[i], passed[i]);
    }
};

struct JetParcel {
    uint32_t launched = kJetNever;  // tick
    uint64_t power = 0;             // nW of each ray
    uint64_t sticks = 0;            // nW of that, which stays as stuck fuel
    float from[3] = {};             // m, world
    float wide = 0;                 // rad, half angle
    uint32_t most = 0;              // mm, length of its flight
    JetFlight flight{};
    std::array<JetRay, kJetRays> rays{};

    template <class A>
    void serialize(A& a) {
        a(launched);
        if (launched == kJetNever) return;
        a(power, sticks, from, wide, most, flight, rays);
        a.range("jet's origin", from, -2e6, 2e6);
        a.range("jet's angle", wide, 0, 4);
        a.range("jet's length", most, 0, 1e7);
    }
};

// Stuck fuel where rays struck, in nW times the length of an exchange.
constexpr uint32_t kJetPatches = 16;
constexpr float kPatchRadius = 0.25f;                  // m
constexpr uint64_t kMaxPatch = uint64_t(1) << 61;      // of fuel
constexpr uint64_t kPatchUnitsPerJoule = 8000000000u;  // exchanges a second, nW in a W
constexpr uint64_t kPatchJoulesPerGram = 2600;         // heat to warm and boil off water
struct JetPatch {
    FwBurnableMeshId object{};  // null: of a collider
    uint32_t texel = 0;
    uint32_t left = 0;             // exchanges until burnt out; 0: an empty patch
    uint64_t fuel = 0, power = 0;  // power: of the last exchange
    uint64_t water = 0;    // fuel that water removes at the first exchange from `waterAt` on
    uint32_t waterAt = 0;  // tick
    float place[3] = {}, normal[3] = {};  // m, world

    template <class A>
    void serialize(A& a) {
        a(left);
        if (left == 0) return;
        a.texel("fuel that sticks", object, texel);
        a(fuel, power, water, waterAt, place, normal);
        a.range("fuel that sticks", fuel, 0, double(kMaxPatch));
        a.range("water on fuel that sticks", water, 0, double(kMaxPatch));
        a.range("place of fuel that sticks", place, -kJetReach, kJetReach);
        a.range("normal of fuel that sticks", normal, -1e6, 1e6);
    }
};
using JetPatches = std::array<JetPatch, kJetPatches>;
// Burns a patch for one exchange and returns its power. The last exchange burns the last fuel.
uint64_t burnPatch(JetPatch& patch, uint32_t now) noexcept;
// Adds fuel and restarts the patch's time. Returns the fuel beyond kMaxPatch.
uint64_t feedPatch(JetPatch& patch, uint64_t fuel, uint32_t exchanges) noexcept;
// `grams`: g/m^2 of water at a tick; kPatchDrowned: enough to put the patch out.
constexpr uint32_t kPatchDrowned = 0xFFFFFFFFu;
void wetPatch(JetPatch& patch, uint32_t grams, uint32_t tick) noexcept;

struct JetStream {
    std::array<JetParcel, kJetParcels> parcels{};
    uint64_t kept = 0;  // nW too small for any texel: added to the next exchange
    // As of exchange `patchedAt`, and before it: a failed frame is repeated from there.
    JetPatches patches{}, before{};
    uint32_t patchedAt = 0;  // tick

    template <class A>
    void serialize(A& a) {
        a(parcels, kept, patches, patchedAt);
    }
};

// Shares `power` nW as W/m^2 over texels with `areas` in 1e-9 m^2. Returns the rest: less than the
// smallest texel takes for 1 W/m^2, unless all texels have gpu::kMaxFlux.
uint64_t updateJetShare(uint64_t power, std::span<const uint64_t> areas,
                        std::span<uint32_t> flux) noexcept;

}  // namespace fw::components
