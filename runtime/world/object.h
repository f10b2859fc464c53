// Records of meshes, images and burnable meshes that the systems of a world share.
#pragma once
#include "components/burnable_mesh.h"
#include "components/exchange_object.h"
#include "core/owned.h"
#include "gpu/backend.h"
#include "mesh/burn_domain.h"
#include "mesh/front/arrivals.h"
#include "mesh/hold.h"
#include "world/played.h"

#include <array>
#include <memory_resource>
#include <vector>

namespace fw::world {

enum class InnerSkin : uint8_t { unknown, none, there };

// Texels that the cut-outs of an object's images remove.
struct GoneTexels {
    std::array<FwImageId, gpu::kMaterialsPerObject> images{};  // by material; null: no cut-out
    std::pmr::vector<uint8_t> texels;                          // as components::makeCutOutMask
    explicit GoneTexels(std::pmr::memory_resource* memory) : texels(memory) {}
};

struct MeshEntry {
    core::Owned<mesh::BurnDomain> domain;
    core::Owned<mesh::DeformModel> deform;                      // once an object deforms
    std::array<uint32_t, gpu::kMaterialsPerObject> texelsOf{};  // real texels per material index
    uint32_t users = 0;                                         // objects, and shapes of it
    // A copy of another mesh in another shape, for objects whose scale is not uniform. It lives
    // while an object uses it.
    uint32_t parentPlus1 = 0;  // slot + 1 of that mesh; 0: the host made this one
    float shape[3] = {1, 1, 1};
    uint64_t hash = 0;             // of the domain; 0: not computed yet
    core::Owned<GoneTexels> gone;  // of the last object with cut-outs: most objects share theirs
    InnerSkin innerSkin = InnerSkin::unknown;  // of the backend
    float innerWall = 0;                       // m below the surface
    core::Owned<mesh::Pieces> pieces;          // once an object asks what breaks
    uint32_t refinements = 0;  // bit per depth that the backend has; 16 higher: by an extension
};

struct ImageEntry {
    uint32_t slot = 0;  // the backend's; outlives the id while an object uses it
    components::CutOut cutOut;
};

struct BurnMapCopy {  // of fwDebug_RequestBurnMap
    std::pmr::vector<uint32_t> ticks;
    std::pmr::vector<gpu::uvec2> heat;  // packed HeatTexel; empty: none
    uint64_t tick = 0;
    bool requested = false, pending = false, ready = false;
    explicit BurnMapCopy(std::pmr::memory_resource* memory) : ticks(memory), heat(memory) {}
};

// Of an object whose host asked when fire arrives.
struct Forecast {
    explicit Forecast(std::pmr::memory_resource* memory) : arrivals(memory) {}
    mesh::Arrivals arrivals;
    uint64_t tick = 0, frameIndex = 0;  // of the state that it began with
    // QuerySystem::changesOf of that state, and of the state that is on its way.
    uint64_t changes = 0, pendingChanges = 0;
    bool began = false;
    bool requested = false;  // the next frame reads the state back
    bool pending = false;    // the state is on its way
};

struct BreakState {
    float share = 0, area = 0;  // as in its def; 0: not asked
    bool shareReported = false;
    bool waits = false;  // some burning texels have not opened yet

    template <class A>
    void serialize(A& a) {
        a(share, area, shareReported, waits);
    }
};

// Of an object whose host asks what breaks, see breaks.cpp.
struct Breaks : BreakState {
    explicit Breaks(std::pmr::memory_resource* memory) : lost(memory) {}
    bool hangs = false;           // from its pins; else it stands
    std::array<FwPin, 8> pins{};  // object space
    uint32_t pinCount = 0;
    std::pmr::vector<bool> lost;       // by texel: nothing held it at the last check
    core::Owned<mesh::Pieces> pieces;  // of an object with cut-outs; null: its mesh's
    std::array<uint64_t, 8> checks{};  // frames that read its state back, oldest first
    uint32_t checkCount = 0;
};

// A frame whose readback is on its way: the count of steps and sleep follow from it.
struct InFlightFrame {
    uint64_t frameIndex = 0, end = 0;  // tick
    uint64_t roomsStirred = 0;         // tick
    uint32_t steps = 0;
    bool stirs = false;  // it had events
    bool never = false;  // a debug switch keeps the world awake
};

// The course of an object's fire as of a readback, and what events have reported of it.
struct BurnLifecycle {
    bool active = false;   // its front or flames may still move
    bool sawFire = false;  // since the last IGNITED
    bool ignitionKnown = false;
    uint64_t lastStimulus = 0;  // tick of the last event
    uint64_t lastDouse = 0;     // tick, 0: never
    uint32_t douseCause = 0;    // FwExtinguishCause of that
    // The most flames, and texels that went out with fuel left. Both halve with each second of the
    // fire, so that its last flames decide how it ended.
    uint32_t flames = 0, wentOut = 0;
    uint64_t halvedUntil = 0;     // tick
    uint32_t outCause = 0;        // FwExtinguishCause of the last that went out
    uint64_t lastBurning = 0;     // tick of the last readback with burning texels
    uint64_t firstIgnition = 0;   // tick of the ignition that started this fire
    float ignitionPoint[3] = {};  // m, object space
    uint32_t litReported = 0;     // litTick of the last SPREAD_TO
    uint32_t spotsReported = 0;
    uint32_t maxIgnited = 0;
    uint32_t clampsReported = 0;         // late clamps that an event reported
    uint64_t energy = 0, heatSteps = 0;  // 2^-20 J after so many heat steps
    float power = 0;                     // W, at pace 1; of objects with heat

    template <class A>
    void serialize(A& a) {
        a(active, sawFire, ignitionKnown, lastStimulus, lastDouse, douseCause, flames, wentOut,
          halvedUntil, outCause, lastBurning, firstIgnition, ignitionPoint, litReported,
          spotsReported, maxIgnited, clampsReported, energy, heatSteps, power);
    }
};

// Effects of one frame on an object's fire. They apply with the readback of that frame, so that
// events and saves do not depend on when readbacks come.
struct Stimulus {
    uint64_t frameIndex = 0;
    uint32_t slot = 0;
    bool first = false;   // the first that ever addressed the object
    bool starts = false;  // its front or flames may move
    bool ignites = false, douses = false;
    uint64_t heatSteps = 0;  // of `first`: steps of heat before it
    uint64_t latest = 0;     // of `starts`: tick of the last event
    uint64_t ignition = 0;   // of `ignites`: tick, and m in object space
    float ignitionPoint[3] = {};
    uint64_t douse = 0;       // of `douses`: tick
    uint32_t douseCause = 0;  // FwExtinguishCause of that
    uint32_t from1 = 0;       // slot + 1 of the object whose burn is carried to this one; 0: none
    core::Owned<BurnLifecycle>
        given{};  // of that object, if it is destroyed before the readback comes
};

// The part of an object that a save has as it is.
struct ObjectState {
    uint32_t firstEvent = 0xFFFFFFFFu;  // tick of the first event ever
    Play play;                          // the baked burn that it plays
    uint32_t zoneWind = 0;              // that zones add where it is, packed
    bool touched = false;               // an event addressed it: it filters wind and latches
    bool carried = false;               // from another: its energy so far is none of its own power
    bool exchangeDue = false;  // pose or def changed since its latch: it is in Scene::moved
    gpu::ExchangeObject exchangeObject{};  // as other objects see it, latched at each exchange
    BurnLifecycle lifecycle;
    gpu::ObjectCounters counters{};  // as of the last readback
};

struct Object : ObjectState {
    explicit Object(std::pmr::memory_resource* memory)
        : slowness(memory), map(memory), skin(memory), skinNormals(memory) {}

    components::BurnableMesh data;
    components::Latch latch;  // the wind and slope that its front sees
    uint32_t slot = 0;        // the backend's: its index in the pool
    FwBurnableMeshId id{};
    uint32_t texels = 0;      // that can burn
    components::Fuel fuel;    // when it was made; none: it keeps no energy ledger
    uint64_t firstFrame = 0;  // readbacks of older frames are of another object in the slot
    std::pmr::vector<uint16_t> slowness;  // per texel, Q7; empty: the mesh's own
    uint64_t memoryBytes = 0;             // that the world counts for it
    uint32_t stimuli = 0;                 // its entries in BurnState::stimuli
    uint32_t stimulusAt = mesh::kNone;    // of those, that of the frame being committed
    bool ignites = false;                 // some of those ignite it
    // As other objects see it, latched at each exchange.
    components::Governance governance;
    uint32_t reach = 0;            // mm
    uint32_t exchangeVersion = 0;  // grows with every latch; 0: never placed
    uint64_t planStamp = 0;        // of the plan whose latches hold it
    size_t latchIndex = 0;         // in the latches of that plan
    uint64_t sleepsUnder = 0;      // WindSystem::changes + 1 under which its latch rests; 0: none
    uint32_t room1 = 0;            // slot + 1 of the room that it is in; 0: none
    // As of the last readback.
    uint64_t countersFrame = 0;
    BurnMapCopy map;
    core::Owned<Forecast> forecast;  // null: never asked for
    core::Owned<Breaks> breaks;      // null: not asked for
    uint64_t changes = 0;            // events and poses that change what its fire will do
    // A burn is carried from or to it: its other events wait until the end of that step.
    uint32_t carryEnd = 0;  // tick
    // Of a skinned object: the host's vertices, m, in its mesh's shape; 3 each. Normals are
    // scratch.
    std::pmr::vector<float> skin, skinNormals;
    bool skinMoved = false;  // else they are at rest
};

}  // namespace fw::world
