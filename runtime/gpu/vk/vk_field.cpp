// Particle fields on the device: their places in the buffers, and what a frame has to do for them.
#include "gpu/passes/field_units.h"
#include "gpu/vk/frame_needs.h"

#include <cstring>

namespace fw::gpu::vk {
namespace {

uint32_t cellUnits(const FieldRules& rules) noexcept {
    return (rules.width * rules.height + kFieldUnit - 1) / kFieldUnit;
}

void stageMasks(VkBackend::State& s, const RangeOf& cells, std::span<const uint8_t> masks) {
    PendingUpload& upload = s.stage(uint64_t(cells.units) * kFieldUnit, "field masks");
    std::memset(upload.staging.mapped, 0, size_t(cells.units) * kFieldUnit);
    std::memcpy(upload.staging.mapped, masks.data(), masks.size_bytes());
    upload.regions[upload.regionCount++] = {FW_BIND_FIELD_MASKS, 0,
                                            uint64_t(cells.first) * kFieldUnit,
                                            uint64_t(cells.units) * kFieldUnit};
}

}  // namespace

void VkBackend::createField(uint32_t slot, const FieldRules& rules,
                            std::span<const uint8_t> masks) {
    State& s = *state_;
    const uint64_t last = s.ring.newest();
    (void)slotOf(s.particleFields.fields, slot);
    s.buffers.atLeast(kPoolFields, uint32_t(s.particleFields.fields.size()), last);
    FieldEntry field;
    field.cells.units = cellUnits(rules);
    field.cells.first = s.buffers.allocate(kPoolFieldCells, field.cells.units, last);
    try {
        stageMasks(s, field.cells, masks);
    } catch (...) {
        s.buffers.release(kPoolFieldCells, field.cells.first, field.cells.units);
        throw;
    }
    field.live = field.recordDirty = field.masksDue = field.fresh = true;
    field.rules = rules;
    s.particleFields.fields[slot] = field;
    s.particleFields.fieldsDirty = true;
}

void VkBackend::destroyField(uint32_t slot) noexcept {
    State& s = *state_;
    if (slot >= s.particleFields.fields.size() || !s.particleFields.fields[slot].live) return;
    FieldEntry& field = s.particleFields.fields[slot];
    s.buffers.release(kPoolFieldCells, field.cells.first, field.cells.units);
    field = {};
}

void VkBackend::setFieldRules(uint32_t slot, const FieldRules& rules) noexcept {
    FieldEntry& field = state_->particleFields.fields[slot];
    if (std::memcmp(&field.rules, &rules, sizeof rules) == 0) return;
    field.rules = rules;
    field.recordDirty = true;
    state_->particleFields.fieldsDirty = true;
}

void VkBackend::setFieldMasks(uint32_t slot, std::span<const uint8_t> masks) {
    FieldEntry& field = state_->particleFields.fields[slot];
    stageMasks(*state_, field.cells, masks);
    field.masksDue = true;
    state_->particleFields.fieldsDirty = true;
}

uint64_t VkBackend::fieldBytes(uint32_t slot) const noexcept {
    constexpr uint64_t kOfACell = 2 * 4 + 1 + 4;  // twice, its mask, what it shows
    return uint64_t(state_->particleFields.fields[slot].cells.units) * kFieldUnit * kOfACell +
           sizeof(FieldDraw) + sizeof(FieldRecord) + sizeof(FieldCounters);
}

void addFieldNeeds(const VkBackend::State& s, const FramePlan& plan, FrameNeeds& needs) {
    // Less than half of a group is idle, but of the last one of a round.
    if (plan.fields)
        for (const FieldRun& run : plan.fields->runs)
            needs.fieldRuns += 2 * fieldUnitsOf(s.particleFields.fields[run.field].rules.width);
    if (plan.fields) needs.fieldRuns += kFieldUnits * uint32_t(plan.fields->rounds.size());
    for (const FieldEntry& field : s.particleFields.fields) {
        if (field.recordDirty) needs.uploadBytes += uploaded(sizeof(FieldRecord));
        if (field.masksDue) ++needs.fieldRuns;
    }
    needs.readback |= needs.fieldRuns > 0;
    // An own device's picture is a frame without a plan.
    needs.fieldsShow =
        !s.particleFields.fieldDraws.empty() || (plan.fields && !plan.fields->drawn.empty());
    if (plan.fields) needs.uploadBytes += uploaded(plan.fields->drawn.size() * sizeof(FieldDraw));
    needs.uploadBytes += uploaded(uint64_t(needs.fieldRuns) * sizeof(FieldRun));
}

void recordFieldSteps(VkBackend::State& s, const FramePlan& plan, FrameRecorder& recorder,
                      UploadWriter& writer) {
    FieldsRecord record;
    Staged runs = writer.begin();
    for (uint32_t i = 0; s.particleFields.fieldsDirty && i < s.particleFields.fields.size(); ++i) {
        FieldEntry& field = s.particleFields.fields[i];
        if (!field.masksDue) continue;
        const FieldRun run{i, field.steps | (field.fresh ? kFieldFresh : 0u)};
        writer.append(runs, std::span<const FieldRun>(&run, 1));
        ++record.masked;
        field.masksDue = field.fresh = false;
    }
    if (plan.fields) {
        const std::span<const FieldRun> all = plan.fields->runs;
        uint32_t first = 0;
        for (const uint32_t end : plan.fields->rounds) {
            record.groups[record.rounds++] = fieldUnits(
                all.subspan(first, end - first),
                [&](uint32_t field) { return s.particleFields.fields[field].rules.width; },
                [&](const FieldRun& unit) {
                    writer.append(runs, std::span<const FieldRun>(&unit, 1));
                });
            first = end;
        }
        for (const FieldRun& run : all) s.particleFields.fields[run.field].steps = run.step + 1;
    }
    writer.end();
    record.runs = runs;
    for (uint32_t i = 0; s.particleFields.fieldsDirty && i < s.particleFields.fields.size(); ++i) {
        FieldEntry& field = s.particleFields.fields[i];
        if (!field.recordDirty) continue;
        FieldRecord device{};
        device.rules = field.rules;
        device.weights = fieldWeights(field.rules);
        device.cellBase = field.cells.first * kFieldUnit;
        device.cellRoom = field.cells.units * kFieldUnit;
        const Staged staged = writer.write(std::span<const FieldRecord>(&device, 1));
        recorder.copyIn(staged.at, FW_BIND_FIELDS, uint64_t(i) * sizeof device, sizeof device);
        field.recordDirty = false;
    }
    s.particleFields.fieldsDirty = false;
    recordFields(recorder, record);
    if (plan.frameIndex == 0) return;     // a picture of what is there
    s.particleFields.fieldDraws.clear();  // there is room for them
    for (size_t i = 0; plan.fields && i < plan.fields->drawn.size(); ++i) {
        const FieldEntry& field = s.particleFields.fields[plan.fields->drawn[i]];
        FieldDraw draw = plan.fields->draws[i];
        const uint32_t cells = 2 * field.cells.first * kFieldUnit;
        const uint32_t room = field.cells.units * kFieldUnit, odd = field.steps & 1;
        draw.cells = cells + odd * room;
        draw.before = cells + (odd ^ 1) * room;
        draw.shown = field.cells.first * kFieldUnit;
        s.particleFields.fieldDraws.push_back(draw);
    }
    if (s.particleFields.fieldDraws.empty()) return;
    const Staged staged = writer.write(std::span<const FieldDraw>(s.particleFields.fieldDraws));
    recorder.copyIn(staged.at, FW_BIND_FIELD_DRAWS, 0,
                    s.particleFields.fieldDraws.size() * sizeof(FieldDraw));
}

uint32_t VkBackend::State::orderFields(std::array<FieldItem, kMaxFields>& out) const noexcept {
    if (!scene.profiles.live) return 0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < particleFields.fieldDraws.size(); ++i) {
        out[count].draw = i;
        if (fieldDrawn(seen, particleFields.fieldDraws[i], out[count])) ++count;
    }
    sortFields({out.data(), count});
    return count;
}

}  // namespace fw::gpu::vk
