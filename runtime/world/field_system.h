// Particle fields: what the host changes and asks, which of them step in a frame, and the meshes
// that fields of water wet.
#pragma once
#include "components/particle_field.h"
#include "world/command.h"
#include "world/scene.h"
#include "world/slotted.h"

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

struct FieldSnapshot {
    uint32_t width = 0, height = 0;
    uint64_t began = 0;  // tick
    float position[3] = {}, rotation[4] = {}, amount = 0;
    core::Owned<field::FieldCells> cells;  // of one that wets

    template <class A>
    void serialize(A& a) {
        a(width, height, began, position, rotation, amount);
        a.optional(cells);
        a.range("particle field's place", position, -1e6, 1e6);
        a.range("particle field's amount", amount, 0, 4);
        double length = 0;
        for (const float value : rotation) length += double(value) * double(value);
        a.range("square of the length of a particle field's rotation", length, 0.99, 1.01);
    }
};

class FieldSystem {
 public:
    FieldSystem(const WorldContext& context, Scene& scene, const WindSystem& wind,
                BurnSystem& burn);

    FwParticleFieldId create(const FwParticleFieldDef& def);
    void destroy(FwParticleFieldId id);
    void move(FwParticleFieldId id, const float position[3], const float rotation[4]);
    void setAmount(FwParticleFieldId id, float amount);
    void setHidden(FwParticleFieldId id, bool hidden) {
        setFlag(fields_.get(id)->data.flags, FW_FIELD_HIDDEN, hidden);
    }
    void paint(FwParticleFieldId id, const uint8_t* paint, const uint8_t* walls);
    void fillState(FwParticleFieldId id, FwParticleFieldState& state);

    // At an exchange, before the steps of a frame are planned.
    void wetObjects(uint32_t now);
    void plan(const HostFrame& frame, gpu::FramePlan& plan) noexcept;
    void commit(const HostFrame& frame) noexcept;
    void onReadback(const gpu::Readback& readback) noexcept;
    // visit(place, name, slot) for all that a shift of the origin moves and may refuse.
    template <class Visit>
    void eachPlace(const Visit& visit) {
        for (auto [i, field] : fields_.entries()) visit(field.data.position, "particle field", i);
    }

    void apply(const MoveField& command) {
        move(fields_.findId(command.slot), command.position,
             command.turns ? command.direction : nullptr);
    }
    void apply(const SetFieldAmount& command) {
        setAmount(fields_.findId(command.slot), command.value);
    }
    void capture(SlottedList<FieldSnapshot>& to) const;
    // Throws unless restore takes it. `tick`: of the save.
    void checkSnapshot(const SlottedList<FieldSnapshot>& from, uint64_t tick) const;
    void restore(SlottedList<FieldSnapshot>& from) noexcept;

    [[nodiscard]] const auto& fields() const noexcept { return fields_; }

 private:
    static constexpr uint32_t kMaxSteps = gpu::kMaxFieldRounds;  // of a frame
    [[nodiscard]] field::FieldRules rulesOf(const components::ParticleField& field) const noexcept;
    void sendRules() noexcept;
    void stepCells(Field& field, uint64_t tick) noexcept;
    void wetObjects(Field& field, uint32_t now);

    const WorldContext& context_;
    Scene& scene_;
    const WindSystem& wind_;
    BurnSystem& burn_;
    core::HandlePool<FwParticleFieldId, core::Owned<Field>> fields_{"Particle field",
                                                                    context_.memory};
    uint32_t made_ = 0;       // since ever
    uint32_t shown_ = 0;      // that the backend draws
    uint64_t sentUnder_ = 0;  // WindState::updates of the rules that the backend has
    // Of a frame; there is room for all of it.
    std::pmr::vector<gpu::FieldRun> runs_{context_.memory};
    std::pmr::vector<uint32_t> rounds_{context_.memory};
    std::pmr::vector<gpu::FieldDraw> draws_{context_.memory};
    std::pmr::vector<uint32_t> drawn_{context_.memory};
    gpu::FieldUpdate update_;
};

}  // namespace fw::world
