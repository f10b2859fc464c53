// Fire emitters: their particles, sparks and jets. Particles are cosmetic; jets that ignite heat
// what they strike, by the host's numbers alone: events, the same on every backend.
#pragma once
#include "components/fire_emitter.h"
#include "shared/particle.h"
#include "shared/spark.h"
#include "world/command.h"
#include "world/pending.h"
#include "world/scene.h"
#include "world/slotted.h"

namespace fw::world {

class BurnSystem;
class ExchangeSystem;
class FlameSystem;
class WindSystem;

struct EmitterSnapshot {
    uint32_t flags = 0;  // FW_EMITTER_JET, FW_EMITTER_IGNITES
    float position[3] = {}, direction[3] = {}, power = 0;
    std::array<components::JetTouch, 8> touches{};
    core::Owned<components::JetStream> stream;

    template <class A>
    void serialize(A& a) {
        a(flags, position, direction, power, touches);
        a.optional(stream);
        a.range("fire emitter's place", position, -1e6, 1e6);
        a.range("fire emitter's direction", direction, -1e6, 1e6);
        a.range("fire emitter's power", power, 0, components::kMaxPower);
    }
};

class EmitterSystem {
 public:
    EmitterSystem(const WorldContext& context, Scene& scene, const WindSystem& wind,
                  const ExchangeSystem& exchange, FlameSystem& flames, BurnSystem& burn);

    FwFireEmitterId create(const FwFireEmitterDef& def);
    void destroy(FwFireEmitterId id);
    void move(FwFireEmitterId id, const float position[3], const float* direction);
    void setPower(FwFireEmitterId id, float power);
    void setHidden(FwFireEmitterId id, bool hidden) {
        setFlag(emitters_.get(id).def.flags, FW_EMITTER_HIDDEN, hidden);
    }
    void fillState(FwFireEmitterId id, FwFireEmitterState& state);

    void beginFrame() noexcept { ++sweeps_; }
    // Before the exchanges of a frame, the first of them at tick `first`.
    void beginExchanges(uint32_t first) noexcept;
    void heatObjects(uint32_t now);  // at an exchange
    void plan(const HostFrame& frame, gpu::FramePlan& plan) noexcept;
    void commit(const HostFrame& frame) noexcept;
    // Lists where jets strike. Particles pass what is gone 2 to 3 frames later.
    void listProbes() noexcept;
    [[nodiscard]] std::span<const JetProbe> probes() const noexcept { return probes_; }
    [[nodiscard]] size_t mostProbes() const noexcept { return probes_.capacity(); }
    void onProbes(std::span<const JetProbe> answers) noexcept;
    void forgetObject(const Object& object) noexcept;  // that goes
    // `records`: the host's water is recorded; a field's follows from the field.
    void wetPatches(std::span<const Splash> splashes, bool records) noexcept;
    void reserveSlots();  // throws std::bad_alloc
    // visit(place, name, slot) for all that a shift of the origin moves and may refuse.
    template <class Visit>
    void eachPlace(const Visit& visit) {
        for (auto [i, emitter] : emitters_.entries()) visit(emitter.position, "fire emitter", i);
    }
    void shiftOrigin(const double (&by)[3]) noexcept;  // all else

    void apply(const MoveEmitter& command) {
        move(emitters_.findId(command.slot), command.position,
             command.turns ? command.direction : nullptr);
    }
    void apply(const SetEmitterPower& command) {
        setPower(emitters_.findId(command.slot), command.value);
    }
    void apply(const WetPatch& command);
    void capture(SlottedList<EmitterSnapshot>& to) const;
    // Throws unless restore takes it. `tick`: of the save.
    void checkSnapshot(const SlottedList<EmitterSnapshot>& from, uint64_t tick) const;
    void restore(const SlottedList<EmitterSnapshot>& from) noexcept;

    [[nodiscard]] const auto& emitters() const noexcept { return emitters_; }
    [[nodiscard]] double time() const noexcept { return time_; }
    [[nodiscard]] components::EmitterAir airOf(const components::FireEmitter& emitter,
                                               float ahead) const noexcept;

 private:
    [[nodiscard]] bool shows() const noexcept {  // in the planned frame
        return !records_.empty() || !sparks_.empty();
    }
    [[nodiscard]] float burningShare(const components::FireEmitter& emitter) noexcept;
    uint32_t findRing(uint32_t particles);
    void sampleGround(gpu::SparkSource& source) const noexcept;
    // jets.cpp
    float sweepJet(const float start[3], const float way[3], float most, components::JetHit& hit,
                   const components::JetGate* passed = nullptr) noexcept;
    uint32_t gateTicks(const components::JetHit& hit, uint32_t tick) noexcept;
    bool stands(const components::JetHit& hit, uint32_t holeTicks, uint32_t tick) noexcept;
    void listJetTargets(const float from[3], float reach) noexcept;
    void sweepJets(components::FireEmitter& emitter) noexcept;
    void updateJetObstacles(components::FireEmitter& emitter, double now) noexcept;
    void heatObjects(components::FireEmitter& emitter, uint32_t now);
    void passHole(const components::FireEmitter& emitter, components::JetHit& hit) noexcept;
    void launchJet(const components::FireEmitter& emitter, components::JetParcel& parcel,
                   uint32_t now) const noexcept;
    void flyJet(components::FireEmitter& emitter, components::JetParcel& parcel, uint32_t now);
    bool flyRay(components::FireEmitter& emitter, const components::JetParcel& parcel,
                components::JetRay& ray, uint32_t from, uint32_t to, uint32_t now, bool& listed);
    void heatByJet(components::FireEmitter& emitter, const components::JetParcel& parcel,
                   const components::JetRay& ray, const components::JetHit& hit,
                   const components::JetGate& gate, uint32_t tick, uint64_t brought);
    bool heatFootprint(Object& object, const components::JetHit& hit, float radius, uint64_t power,
                       uint32_t tick, size_t most, const PendingTexel& like, uint64_t& left);
    uint64_t attachFuel(components::FireEmitter& emitter, const components::JetHit& hit,
                        uint64_t fuel) noexcept;
    void burnPatches(components::FireEmitter& emitter, uint32_t now);
    void heatStepThin(components::FireEmitter& emitter, Object& object,
                      const components::JetHit& hit, float radius, float watts, uint32_t now);
    void findFootprint(const Object& object, const components::JetHit& hit, float radius);

    const WorldContext& context_;
    Scene& scene_;
    const WindSystem& wind_;
    const ExchangeSystem& exchange_;
    FlameSystem& flames_;
    BurnSystem& burn_;
    core::HandlePool<FwFireEmitterId, components::FireEmitter> emitters_{"Fire emitter",
                                                                         context_.memory};
    double time_ = 0;  // s
    // Of a frame; room for all of it is reserved with each emitter.
    std::pmr::vector<gpu::ParticleEmitter> records_{context_.memory};
    std::pmr::vector<gpu::uvec2> groups_{context_.memory};
    std::pmr::vector<std::pair<uint32_t, uint32_t>> rings_{
        context_.memory};  // scratch: first, ring
    std::pmr::vector<gpu::SparkSource> sparks_{context_.memory};
    std::pmr::vector<JetProbe> probes_{context_.memory};
    gpu::EmitterUpdate update_;
    uint32_t made_ = 0;   // since ever
    bool shown_ = false;  // the backend has some
    // Scratch of a jet's ray: of the texels found, 1e-9 m^2 and W/m^2.
    std::pmr::vector<uint64_t> jetAreas_{context_.memory};
    std::pmr::vector<uint32_t> jetFlux_{context_.memory};
    std::pmr::vector<uint32_t> jetSlots_{context_.memory};  // objects that a jet may meet
    uint64_t sweeps_ = 0;  // frames begun: a jet is swept once in each
};

}  // namespace fw::world
