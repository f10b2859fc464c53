// The stream of a jet, as far as it heats what it strikes: parcels that left the nozzle one
// exchange apart, where each is by now, and how the power of a ray is shared out. Times and power
// are integers: the same on every backend and at every rate of frames. Not the particles that are
// seen.
#pragma once
#include "flamewright/flamewright.h"
#include "shared/burn.h"

#include <array>
#include <cstdint>
#include <span>

namespace fw::components {

struct EmitterLook;

constexpr uint32_t kJetRays = 16;
constexpr uint32_t kJetParcels = 16;  // in flight at a time: two seconds of stream
constexpr uint32_t kJetNever = 0xFFFFFFFFu;

constexpr double kJetReach = 4e6;  // m: what a jet strikes lies beyond where it stands

struct JetHit {  // of one ray of a jet
    bool met = false;
    float distance = 0;  // m from where the ray began
    float place[3] = {}, normal[3] = {};
    FwBurnableMeshId object{};  // null: a collider or blocker
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

// mm that a parcel has flown at each exchange after it left: as particles of the stream do, slowed
// by the air while they tear.
using JetFlight = std::array<uint32_t, kJetParcels + 1>;
[[nodiscard]] JetFlight jetFlight(const EmitterLook& look) noexcept;
// Ticks after it left that it has come `way` mm, which it does before exchange `exchange` + 1.
[[nodiscard]] uint32_t jetArrival(const JetFlight& flight, uint32_t exchange,
                                  uint32_t way) noexcept;

// A texel that may have burnt away when a ray comes to it: the backend knows, we do not. So what
// stands there is heated if it still does, and what lies behind if it does not.
struct JetGate {
    uint32_t object = 0, texel = 0;  // slot
    uint32_t holeTicks = 0;          // from its ignition until it gives way
    float distance = 0;              // m from where the ray began
    bool operator==(const JetGate&) const = default;

    template <class A>
    void serialize(A& a) {
        a.texel("a hole", object, texel);
        a(holeTicks, distance);
    }
};
constexpr uint32_t kJetGates = gpu::kGates;  // that a ray passes; then it is spent

struct JetRay {
    float way[3] = {};  // of length 1
    JetHit hit;         // in what the world was at `version` of its geometry
    uint64_t version = 0;
    uint32_t spent = kJetNever;  // exchange at which it struck something, a tick
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
    uint64_t power = 0;             // nW of each ray, and of it
    uint64_t sticks = 0;            // nW that stay as fuel
    float from[3] = {};             // m, world
    float wide = 0;                 // rad, half
    uint32_t most = 0;              // mm that it comes
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

// Fuel that sticks where rays struck. Counted in nW for the time of an exchange.
constexpr uint32_t kJetPatches = 16;
constexpr float kPatchRadius = 0.25f;                  // m
constexpr uint64_t kPatchMost = uint64_t(1) << 61;     // of fuel
constexpr uint64_t kPatchUnitsPerJoule = 8000000000u;  // exchanges a second, nW in a W
constexpr uint64_t kPatchJoulesPerGram = 2600;         // that water takes: warmed and boiled off
struct JetPatch {
    FwBurnableMeshId object{};  // null: of a collider
    uint32_t texel = 0;
    uint32_t left = 0;             // exchanges that it burns on; 0: there is none
    uint64_t fuel = 0, power = 0;  // power: what it gave at the last exchange
    uint64_t water = 0;            // fuel that water takes at the first exchange from `waterAt` on
    uint32_t waterAt = 0;          // tick
    float place[3] = {}, normal[3] = {};  // m, world

    template <class A>
    void serialize(A& a) {
        a(left);
        if (left == 0) return;
        a.texel("fuel that sticks", object, texel);
        a(fuel, power, water, waterAt, place, normal);
        a.range("fuel that sticks", fuel, 0, double(kPatchMost));
        a.range("water on fuel that sticks", water, 0, double(kPatchMost));
        a.range("place of fuel that sticks", place, -kJetReach, kJetReach);
        a.range("normal of fuel that sticks", normal, -1e6, 1e6);
    }
};
using JetPatches = std::array<JetPatch, kJetPatches>;
// One exchange of one: what it gives. With the last of its time goes the last of its fuel.
uint64_t burnPatch(JetPatch& patch, uint32_t now) noexcept;
// Adds what came, and starts its time anew; what it has no room for comes back.
uint64_t feedPatch(JetPatch& patch, uint64_t fuel, uint32_t exchanges) noexcept;
// g/m^2 of water that fall on it at a tick; kPatchDrowned: all that it takes.
constexpr uint32_t kPatchDrowned = 0xFFFFFFFFu;
void wetPatch(JetPatch& patch, uint32_t grams, uint32_t tick) noexcept;

struct JetStream {
    std::array<JetParcel, kJetParcels> parcels{};
    uint64_t kept = 0;  // nW that no texel was small enough for: given with the next
    // As of exchange `patchedAt`, and as the last frame left them: one that failed comes again.
    JetPatches patches{}, before{};
    uint32_t patchedAt = 0;  // tick

    template <class A>
    void serialize(A& a) {
        a(parcels, kept, patches, patchedAt);
    }
};

// W/m^2 for each of the texels, whose areas are in 1e-9 m^2, that together are `power` nW but for
// what comes back: less than the smallest of them takes for 1 W/m^2, unless all have
// gpu::kFluxMost.
uint64_t shareJet(uint64_t power, std::span<const uint64_t> areas,
                  std::span<uint32_t> flux) noexcept;

}  // namespace fw::components
