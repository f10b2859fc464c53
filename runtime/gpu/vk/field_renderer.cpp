#include "gpu/vk/field_renderer.h"

#include "gpu/passes/blend_order.h"
#include "gpu/passes/field_units.h"
#include "gpu/vk/frame_needs.h"
#include "shared/field.h"

#include <cstring>

namespace fw::gpu::vk {
namespace {

uint32_t cellUnits(const FieldRules& rules) noexcept {
    return (rules.width * rules.height + kFieldUnit - 1) / kFieldUnit;
}

void stageMasks(BackendState& s, const BufferRange& cells, std::span<const uint8_t> masks) {
    const size_t bytes = size_t(cells.units()) * kFieldUnit;
    FW_ASSERT(masks.size_bytes() <= bytes, "%zu masks of %zu cells", masks.size(), bytes);
    std::byte* const to =
        s.scene.uploads.stage(bytes, "field masks")
            .region(FW_BIND_FIELD_MASKS, uint64_t(cells.first()) * kFieldUnit, bytes);
    std::memset(to, 0, bytes);
    std::memcpy(to, masks.data(), masks.size_bytes());
}

// False: the view does not show it.
bool fieldDrawn(const ViewParams& view, const FieldDraw& field, FieldItem& out) {
    const vec3 middle = vec3(field.place) + 0.5f * field.size.y * vec3(field.up) - vec3(view.eye);
    const float radius = 0.75f * glm::length(vec3(field.size));
    out.depth = glm::dot(middle, vec3(view.forward));
    out.pass = field.up.w <= 0.0f   ? draw::field_emitting
               : field.up.w <= 1.0f ? draw::field_absorbing
                                    : draw::field_refracting;
    out.vertices = field.shape == kFieldBillboard ? 6 : 6 * kFieldAround * kFieldUp;
    if (view.forward.w > 0.5f && out.depth < -radius) return false;
    return sphereInView(view, middle, radius);
}

}  // namespace

void VkBackend::createField(uint32_t slot, const FieldRules& rules,
                            std::span<const uint8_t> masks) {
    BackendState& s = *state_;
    FieldRenderer& renderer = s.particleFields;
    const uint64_t last = s.ring.newest();
    (void)slotOf(renderer.fields, slot);
    s.buffers.atLeast(kPoolFields, uint32_t(renderer.fields.size()), last);
    FieldEntry field;
    field.cells = s.buffers.allocate(kPoolFieldCells, cellUnits(rules), last);
    stageMasks(s, field.cells, masks);
    field.live = field.recordDirty = field.masksDue = field.fresh = true;
    field.rules = rules;
    renderer.fields[slot] = std::move(field);
    renderer.fieldsDirty = true;
}

void VkBackend::destroyField(uint32_t slot) noexcept {
    std::pmr::vector<FieldEntry>& fields = state_->particleFields.fields;
    if (slot < fields.size()) fields[slot] = {};
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
    constexpr uint64_t kOfACell = 2 * 4 + 1 + 4;  // two states, its mask, its shown value
    return uint64_t(state_->particleFields.fields[slot].cells.units()) * kFieldUnit * kOfACell +
           sizeof(FieldDraw) + sizeof(FieldRecord) + sizeof(FieldCounters);
}

void FieldRenderer::addNeeds(const FramePlan& plan, FrameNeeds& needs) const {
    // Less than half of a group is idle, but of the last one of a round.
    if (plan.fields)
        for (const FieldRun& run : plan.fields->runs)
            needs.fieldRuns += 2 * fieldUnitsOf(fields[run.field].rules.width);
    if (plan.fields) needs.fieldRuns += kFieldUnits * uint32_t(plan.fields->rounds.size());
    for (const FieldEntry& field : fields) {
        if (field.recordDirty) needs.uploadBytes += uploaded(sizeof(FieldRecord));
        if (field.masksDue) ++needs.fieldRuns;
    }
    needs.readback |= needs.fieldRuns > 0;
    // An own device's picture is a frame without a plan.
    needs.fieldsShow = !fieldDraws.empty() || (plan.fields && !plan.fields->drawn.empty());
    if (plan.fields) needs.uploadBytes += uploaded(plan.fields->drawn.size() * sizeof(FieldDraw));
    needs.uploadBytes += uploaded(uint64_t(needs.fieldRuns) * sizeof(FieldRun));
}

void FieldRenderer::record(const FramePlan& plan, FrameRecorder& recorder) {
    FieldsRecord frame;
    frame.runs = recorder.beginStaged();
    for (uint32_t i = 0; fieldsDirty && i < fields.size(); ++i) {
        FieldEntry& field = fields[i];
        if (!field.masksDue) continue;
        recorder.appendOne(frame.runs, FieldRun{i, field.steps | (field.fresh ? kFieldFresh : 0u)});
        ++frame.masked;
        field.masksDue = field.fresh = false;
    }
    if (plan.fields) {
        FW_ASSERT(plan.fields->rounds.size() <= kMaxFieldRounds, "%zu rounds",
                  plan.fields->rounds.size());
        const std::span<const FieldRun> all = plan.fields->runs;
        uint32_t first = 0;
        for (const uint32_t end : plan.fields->rounds) {
            frame.groups[frame.rounds++] = fieldUnits(
                all.subspan(first, end - first),
                [&](uint32_t field) { return fields[field].rules.width; },
                [&](const FieldRun& unit) { recorder.appendOne(frame.runs, unit); });
            first = end;
        }
        for (const FieldRun& run : all) fields[run.field].steps = run.step + 1;
    }
    recorder.endStaged();
    for (uint32_t i = 0; fieldsDirty && i < fields.size(); ++i) {
        FieldEntry& field = fields[i];
        if (!field.recordDirty) continue;
        FieldRecord device{};
        device.rules = field.rules;
        device.weights = fieldWeights(field.rules);
        device.cellBase = field.cells.first() * kFieldUnit;
        device.cellRoom = field.cells.units() * kFieldUnit;
        recorder.uploadOne(FW_BIND_FIELDS, uint64_t(i) * sizeof device, device);
        field.recordDirty = false;
    }
    fieldsDirty = false;
    recordFields(recorder, frame);
    if (plan.frameIndex == 0) return;  // a picture of the present state
    fieldDraws.clear();                // makeRoom reserved for them
    for (size_t i = 0; plan.fields && i < plan.fields->drawn.size(); ++i) {
        const FieldEntry& field = fields[plan.fields->drawn[i]];
        FieldDraw draw = plan.fields->draws[i];
        const uint32_t cells = 2 * field.cells.first() * kFieldUnit;
        const uint32_t room = field.cells.units() * kFieldUnit, odd = field.steps & 1;
        draw.cells = cells + odd * room;
        draw.before = cells + (odd ^ 1) * room;
        draw.shown = field.cells.first() * kFieldUnit;
        FW_ASSERT(fieldDraws.size() < fieldDraws.capacity(), "%zu draws", fieldDraws.size());
        fieldDraws.push_back(draw);
    }
    recorder.upload(FW_BIND_FIELD_DRAWS, 0, std::span<const FieldDraw>(fieldDraws));
}

uint32_t FieldRenderer::order(const BackendState& s,
                              std::array<FieldItem, kMaxFields>& out) const noexcept {
    if (!s.scene.profiles.live) return 0;
    FW_ASSERT(fieldDraws.size() <= out.size(), "%zu fields", fieldDraws.size());
    uint32_t count = 0;
    for (uint32_t i = 0; i < fieldDraws.size(); ++i) {
        out[count].draw = i;
        if (fieldDrawn(s.seen, fieldDraws[i], out[count])) ++count;
    }
    orderOnHost(
        std::span(out.data(), count), [](const FieldItem& item) { return item.depth; },
        [](const FieldItem& item) { return item.draw; });
    return count;
}

}  // namespace fw::gpu::vk
