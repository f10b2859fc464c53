// Events of texels that wait for the step in which they happen, water that fell, and questions of
// jets to the backend.
#pragma once
#include "components/fire_emitter.h"
#include "gpu/backend.h"

#include <array>

namespace fw::world {

// PendingTexel::texel of an event that addresses all texels of an object.
constexpr uint32_t kAllTexels = 0xFFFFFFFFu;

struct PendingTexel {  // an event that waits for its step; texel kAllTexels: of all of the object
    uint32_t object = 0, texel = 0, kind = 0, tick = 0, water = 0;  // g/m^2; of heat: W/m^2
    uint64_t order = 0;
    // Of heat that came through holes, if they are there: the last gate may have to be shut.
    std::array<components::JetGate, components::kJetGates> gates{};
    uint32_t gateCount = 0;
    bool shut = false;

    template <class A>
    void serialize(A& a) {
        a(object, texel, kind, tick, water, order, gateCount, shut);
        a.require(gateCount <= components::kJetGates, "number of holes that an event waits for");
        for (uint32_t i = 0; i < gateCount; ++i) a(gates[i]);
    }
};

// Water or dousing that reached an object: it falls on fuel that sticks there, too.
struct Splash {
    uint32_t slot = 0;
    float position[3] = {}, radius = 0;  // m, world
    uint32_t grams = 0;                  // per m^2
    uint32_t tick = 0;
};

// Asks whether what a ray of a jet struck still stands.
struct JetProbe {
    FwFireEmitterId emitter{};
    FwBurnableMeshId object{};
    uint32_t texel = 0, ray = 0;
    uint32_t holeTicks = 0;  // ticks from ignition to burn-through
    bool gone = false;       // the answer
};

inline bool isCarry(const PendingTexel& event) noexcept {
    return gpu::eventKind(event.kind) == gpu::kEventCarry;
}
inline uint32_t carriedFrom(const PendingTexel& event) noexcept {  // slot
    FW_ASSERT(isCarry(event), "kind 0x%x", event.kind);
    return (event.kind >> gpu::kEventKindBits) - 1;
}

}  // namespace fw::world
