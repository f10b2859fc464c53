// Particle fields: ids, what the host changes and asks, and which of them step in a frame.
#include "world/world.h"

#include <algorithm>

namespace fw::world {

FwParticleFieldId World::createParticleField(const FwParticleFieldDef& def) {
    if (fields_.live() >= gpu::kMaxFields)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "%u particle fields are there; the limit is %u.",
                   fields_.live(), gpu::kMaxFields);
    auto field = core::Owned<Field>::make(memory_, memory_);
    components::makeParticleField(def, def_.seed * 0x9E3779B9u + fieldsMade_ + 1, field->data);
    field->began = clock_.tick;
    field->firstFrame = lastFrame_ + 1;
    // A field steps at most once in a step of the world.
    frame_.fieldRuns.reserve(size_t(fields_.live() + 1) * kMaxSteps);
    frame_.fieldRounds.reserve(kMaxSteps);
    frame_.fieldDraws.reserve(gpu::kMaxFields);
    frame_.fieldsDrawn.reserve(gpu::kMaxFields);
    if (def.flags & FW_FIELD_WETS) {
        field->cells = core::Owned<field::Field>::make(memory_, memory_);
        field::startField(*field->cells, def.width, def.height);
        field::maskField(*field->cells, field->data.masks);
    }
    const Field& made = *field;
    const FwParticleFieldId id = fields_.create(std::move(field));
    try {
        backend_.createField(id.index1 - 1, rulesOf(made.data), made.data.masks);
    } catch (...) {
        fields_.destroy(id);
        throw;
    }
    ++fieldsMade_;
    return id;
}

void World::destroyParticleField(FwParticleFieldId id) {
    (void)fields_.get(id);
    backend_.destroyField(id.index1 - 1);
    fields_.destroy(id);
}

void World::moveParticleField(FwParticleFieldId id, const float position[3],
                              const float rotation[4]) {
    components::ParticleField& field = fields_.get(id)->data;
    const bool wets = (field.flags & FW_FIELD_WETS) != 0;
    if (wets) mayChange();
    components::setFieldPlace(field, position, rotation);
    backend_.setFieldRules(id.index1 - 1, rulesOf(field));
    if (!wets) return;
    MoveField command{id.index1 - 1, rotation != nullptr};
    std::copy_n(position, 3, command.position);
    if (rotation) std::copy_n(rotation, 4, command.rotation);
    record(command);
}

void World::setParticleFieldAmount(FwParticleFieldId id, float amount) {
    components::ParticleField& field = fields_.get(id)->data;
    const bool wets = (field.flags & FW_FIELD_WETS) != 0;
    if (wets) mayChange();
    components::setFieldAmount(field, amount);
    backend_.setFieldRules(id.index1 - 1, rulesOf(field));
    if (wets) record(SetFieldAmount{id.index1 - 1, amount});
}

void World::setParticleFieldHidden(FwParticleFieldId id, bool hidden) {
    uint32_t& flags = fields_.get(id)->data.flags;
    flags = (flags & ~uint32_t(FW_FIELD_HIDDEN)) | (hidden ? uint32_t(FW_FIELD_HIDDEN) : 0u);
}

void World::paintParticleField(FwParticleFieldId id, const uint8_t* paint, const uint8_t* walls) {
    components::ParticleField& field = fields_.get(id)->data;
    components::ParticleField before(memory_);
    before.paint = field.paint, before.walls = field.walls, before.masks = field.masks;
    components::paintField(field, paint, walls);
    try {
        backend_.setFieldMasks(id.index1 - 1, field.masks);
        if (auto& cells = fields_.get(id)->cells) field::maskField(*cells, field.masks);
    } catch (...) {
        field.paint.swap(before.paint);
        field.walls.swap(before.walls);
        field.masks.swap(before.masks);
        throw;
    }
}

void World::particleFieldState(FwParticleFieldId id, FwParticleFieldState& state) {
    const Field& field = *fields_.get(id);
    const auto whole = [](uint32_t low, uint32_t high) { return uint64_t(high) << 32 | low; };
    const gpu::FieldCounters& now = field.counters;
    state.userData = field.data.userData;
    state.frameIndex = field.countersFrame;
    state.inside = now.inside;
    state.emitted = whole(now.emittedLow, now.emittedHigh);
    state.dead = whole(now.diedLow, now.diedHigh);
    state.out = whole(now.leftLow, now.leftHigh);
    state.steps = now.steps;
    state.bytes = backend_.fieldBytes(id.index1 - 1);
}

field::FieldRules World::rulesOf(const components::ParticleField& field) const noexcept {
    return components::rulesOf(field, steadyWindAt(field.position).data());
}

void World::sendFieldRules() noexcept {
    for (uint32_t i = 0; i < fields_.slotCount(); ++i)
        if (const auto* field = fields_.at(i)) backend_.setFieldRules(i, rulesOf((*field)->data));
}

void World::planFields(const ClockAdvance& time) noexcept {
    const uint64_t end = time.after.tick;
    frame_.fieldRuns.clear();
    frame_.fieldRounds.clear();
    for (uint32_t round = 0; round < kMaxSteps; ++round) {
        for (uint32_t i = 0; fields_.live() > 0 && i < fields_.slotCount(); ++i) {
            const auto* field = fields_.at(i);
            if (!field) continue;
            const uint32_t step = (*field)->steps + round;
            if (step < components::fieldSteps((*field)->data, end - (*field)->began))
                frame_.fieldRuns.push_back({i, step - (*field)->shownBase});
        }
        const auto count = uint32_t(frame_.fieldRuns.size());
        if (count == (round > 0 ? frame_.fieldRounds.back() : 0)) break;
        frame_.fieldRounds.push_back(count);
    }
    frame_.fields.runs = frame_.fieldRuns;
    frame_.fields.rounds = frame_.fieldRounds;
    planFieldDraws(time.after);
    frame_.fieldsDue = fields_.live() > 0 || fieldsShown_ > 0;
}

void World::planFieldDraws(const Clock& now) noexcept {
    frame_.fieldDraws.clear();
    frame_.fieldsDrawn.clear();
    const double ticks = double(now.tick) +
                         double(now.fraction) / double(Clock::kStepUnits) * double(gpu::kStepTicks);
    for (uint32_t i = 0; i < fields_.slotCount(); ++i) {
        const auto* entry = fields_.at(i);
        if (!entry || ((*entry)->data.flags & FW_FIELD_HIDDEN)) continue;
        const Field& field = **entry;
        frame_.fieldDraws.push_back(components::fieldDraw(
            field.data, ticks - double(field.began),
            components::fieldSteps(field.data, now.tick - field.began), ticks));
        frame_.fieldsDrawn.push_back(i);
    }
    frame_.fields.draws = frame_.fieldDraws.data();
    frame_.fields.drawn = frame_.fieldsDrawn;
}

void World::commitFields(uint64_t end) noexcept {
    fieldsShown_ = uint32_t(frame_.fieldDraws.size());
    for (uint32_t i = 0; i < fields_.slotCount(); ++i)
        if (auto* field = fields_.at(i)) {
            (*field)->steps = components::fieldSteps((*field)->data, end - (*field)->began);
            stepCells(**field, end);  // before the host changes its rules
        }
}

void World::takeFields(const gpu::Readback& readback) noexcept {
    const size_t count = std::min<size_t>(fields_.slotCount(), readback.fields.size());
    for (uint32_t i = 0; i < count; ++i) {
        auto* field = fields_.at(i);
        if (!field || (*field)->firstFrame > readback.frameIndex) continue;
        (*field)->counters = readback.fields[i];
        (*field)->countersFrame = readback.frameIndex;
    }
}

}  // namespace fw::world
