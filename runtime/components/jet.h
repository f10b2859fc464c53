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

struct JetHit {  // of one ray of a jet
    bool met = false;
    float distance = 0;  // m from where the ray began
    float place[3] = {}, normal[3] = {};
    FwBurnableMeshId object{};  // null: a collider or blocker
    uint32_t texel = 0;
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
};

struct JetParcel {
    uint32_t launched = kJetNever;  // tick
    uint64_t power = 0;             // nW of each ray
    float from[3] = {};             // m, world
    float wide = 0;                 // rad, half
    uint32_t most = 0;              // mm that it comes
    JetFlight flight{};
    std::array<JetRay, kJetRays> rays{};
};

struct JetStream {
    std::array<JetParcel, kJetParcels> parcels{};
    uint64_t kept = 0;  // nW that no texel was small enough for: given with the next
};

// W/m^2 for each of the texels, whose areas are in 1e-9 m^2, that together are `power` nW but for
// what comes back: less than the smallest of them takes for 1 W/m^2, unless all have
// gpu::kFluxMost.
uint64_t shareJet(uint64_t power, std::span<const uint64_t> areas,
                  std::span<uint32_t> flux) noexcept;

}  // namespace fw::components
