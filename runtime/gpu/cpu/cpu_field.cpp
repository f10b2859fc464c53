// Particle fields on the CPU: the library's step.
#include "gpu/cpu/cpu_state.h"

namespace fw::gpu::cpu {

void CpuBackend::createField(uint32_t slot, const FieldRules& rules,
                             std::span<const uint8_t> masks) {
    State& s = *state_;
    auto made = core::Owned<CpuField>::make(s.memory, s.memory);
    field::startField(made->field, rules.width, rules.height);
    field::maskField(made->field, masks);
    FW_ASSERT(masks.size() == size_t(rules.width) * rules.height, "%zu masks", masks.size());
    made->rules = rules;
    if (slot >= s.fields.size()) s.fields.resize(slot + 1);
    s.fields[slot] = std::move(made);
}

void CpuBackend::destroyField(uint32_t slot) noexcept {
    if (slot < state_->fields.size()) state_->fields[slot] = core::Owned<CpuField>();
}

void CpuBackend::setFieldRules(uint32_t slot, const FieldRules& rules) noexcept {
    state_->fieldAt(slot).rules = rules;
}

void CpuBackend::setFieldMasks(uint32_t slot, std::span<const uint8_t> masks) {
    field::maskField(state_->fieldAt(slot).field, masks);
}

uint64_t CpuBackend::fieldBytes(uint32_t slot) const noexcept {
    const field::Field& f = state_->fieldAt(slot).field;
    return sizeof(CpuField) + (f.cells.size() + f.next.size()) * sizeof f.cells[0] +
           f.given.size() * sizeof f.given[0] + f.masks.size();
}

const field::Field& CpuBackend::field(uint32_t slot) const { return state_->fieldAt(slot).field; }

void CpuBackend::State::stepFields(const FieldUpdate& update) noexcept {
    for (const FieldRun& run : update.runs)
        field::stepField(fieldAt(run.field).field, fieldAt(run.field).rules);
}

void CpuBackend::State::countFields(std::span<FieldCounters> out) const noexcept {
    FW_ASSERT(out.size() == fields.size(), "%zu of %zu fields", out.size(), fields.size());
    for (size_t i = 0; i < out.size(); ++i) {
        out[i] = {};
        if (!fields[i]) continue;
        const field::Field& f = fields[i]->field;
        FieldCounters& c = out[i];
        c.inside = uint32_t(field::total(f));
        c.emittedLow = uint32_t(f.emitted), c.emittedHigh = uint32_t(f.emitted >> 32);
        c.diedLow = uint32_t(f.died), c.diedHigh = uint32_t(f.died >> 32);
        c.leftLow = uint32_t(f.left), c.leftHigh = uint32_t(f.left >> 32);
        c.steps = f.step;
    }
}

}  // namespace fw::gpu::cpu
