// Particle fields: what the host changes and asks, which of them step in a frame, and the meshes
// that fields of water wet.
#pragma once
#include "components/particle_field.h"
#include "world/scene.h"

namespace fw::world {

class BurnSystem;
class WindSystem;

struct Field {
    explicit Field(std::pmr::memory_resource* memory) : data(memory) {}
    components::ParticleField data;
    uint64_t began = 0;       // tick
    uint32_t steps = 0;       // that it has come to
    uint32_t shownBase = 0;   // the backend has run all but these
    uint64_t firstFrame = 0;  // readbacks of older frames speak of another field
    gpu::FieldCounters counters{};
    uint64_t countersFrame = 0;
    // The same cells as the backend's, of one that wets: what it touches is ours to know.
    core::Owned<field::Field> cells;
};

struct FieldState {
    explicit FieldState(std::pmr::memory_resource* memory) : fields("Particle field", memory) {}
    core::HandlePool<FwParticleFieldId, core::Owned<Field>> fields;
};

class FieldSystem {
 public:
    FieldSystem(const WorldContext& context, Scene& scene, const WindSystem& wind,
                BurnSystem& burn);

    FwParticleFieldId create(const FwParticleFieldDef& def);
    void destroy(FwParticleFieldId id);
    void move(FwParticleFieldId id, const float position[3], const float rotation[4]);
    void setAmount(FwParticleFieldId id, float amount);
    void setHidden(FwParticleFieldId id, bool hidden);
    void paint(FwParticleFieldId id, const uint8_t* paint, const uint8_t* walls);
    void fillState(FwParticleFieldId id, FwParticleFieldState& state);

    // At an exchange, before the steps of a frame are planned.
    void wetObjects(uint32_t now);
    void plan(const ClockAdvance& time, gpu::FramePlan& plan) noexcept;
    void commit(uint64_t end) noexcept;
    void onReadback(const gpu::Readback& readback) noexcept;
    void checkShift(const double (&by)[3]) const;  // throws
    void shiftOrigin(const double (&by)[3]) noexcept;

    [[nodiscard]] const FieldState& state() const noexcept { return state_; }
    void sendRules() noexcept;  // the wind is another

 private:
    friend class PersistenceSystem;
    static constexpr uint32_t kMaxSteps = gpu::kMaxFieldRounds;  // of a frame
    [[nodiscard]] field::FieldRules rulesOf(const components::ParticleField& field) const noexcept;
    void planDraws(const Clock& now) noexcept;
    void stepCells(Field& field, uint64_t tick) noexcept;
    void wetObjects(Field& field, uint32_t now);

    const WorldContext& context_;
    Scene& scene_;
    const WindSystem& wind_;
    BurnSystem& burn_;
    FieldState state_{context_.memory};
    uint32_t made_ = 0;   // since ever
    uint32_t shown_ = 0;  // that the backend draws
    // Of a frame; there is room for all of it.
    std::pmr::vector<gpu::FieldRun> runs_{context_.memory};
    std::pmr::vector<uint32_t> rounds_{context_.memory};
    std::pmr::vector<gpu::FieldDraw> draws_{context_.memory};
    std::pmr::vector<uint32_t> drawn_{context_.memory};
    gpu::FieldUpdate update_;
};

}  // namespace fw::world
