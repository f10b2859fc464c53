// Particle fields: ids, what the host changes and asks, and which of them step in a frame.
#include "world/field_system.h"

#include "shared/exchange.h"
#include "shared/field.h"
#include "world/burn_system.h"
#include "world/geometry.h"
#include "world/recording.h"
#include "world/wind_system.h"

#include <algorithm>
#include <cmath>

namespace fw::world {
namespace {

constexpr uint32_t kBlock = 4;         // cells of a side that wet as one
constexpr uint32_t kFewest = 6;        // particles of a cell, on average, that wet anything
constexpr uint32_t kGramsOfFull = 40;  // per m^2 and exchange
constexpr float kDepth = 0.125f;       // of a card's width, to both sides

}  // namespace

FieldSystem::FieldSystem(const WorldContext& context, Scene& scene, const WindSystem& wind,
                         BurnSystem& burn)
    : context_(context), scene_(scene), wind_(wind), burn_(burn) {}

FwParticleFieldId FieldSystem::create(const FwParticleFieldDef& def) {
    checkRoom(fields_, gpu::kMaxFields, "particle fields");
    auto field = core::Owned<Field>::make(context_.memory, context_.memory);
    components::makeParticleField(def, context_.def.seed * 0x9E3779B9u + made_ + 1, field->data);
    field->began = context_.clock.tick;
    field->firstFrame = context_.lastFrame + 1;
    // A field steps at most once in a step of the world.
    runs_.reserve(size_t(fields_.live() + 1) * kMaxSteps);
    rounds_.reserve(kMaxSteps);
    draws_.reserve(gpu::kMaxFields);
    drawn_.reserve(gpu::kMaxFields);
    if (def.flags & FW_FIELD_WETS) {
        field->cells = core::Owned<field::Field>::make(context_.memory, context_.memory);
        field::startField(*field->cells, def.width, def.height);
        field::maskField(*field->cells, field->data.masks);
    }
    const Field& made = *field;
    const FwParticleFieldId id = fields_.create(std::move(field));
    try {
        context_.backend.createField(id.index1 - 1, rulesOf(made.data), made.data.masks);
    } catch (...) {
        fields_.destroy(id);
        throw;
    }
    ++made_;
    return id;
}

void FieldSystem::destroy(FwParticleFieldId id) {
    (void)fields_.get(id);
    context_.backend.destroyField(id.index1 - 1);
    fields_.destroy(id);
}

void FieldSystem::move(FwParticleFieldId id, const float position[3], const float rotation[4]) {
    components::ParticleField& field = fields_.get(id)->data;
    const bool wets = (field.flags & FW_FIELD_WETS) != 0;
    if (wets) context_.recorder.mayChange();
    components::setFieldPlace(field, position, rotation);
    context_.backend.setFieldRules(id.index1 - 1, rulesOf(field));
    if (wets) context_.recorder.record(MoveField(id.index1 - 1, position, rotation));
}

void FieldSystem::setAmount(FwParticleFieldId id, float amount) {
    components::ParticleField& field = fields_.get(id)->data;
    const bool wets = (field.flags & FW_FIELD_WETS) != 0;
    if (wets) context_.recorder.mayChange();
    components::setFieldAmount(field, amount);
    context_.backend.setFieldRules(id.index1 - 1, rulesOf(field));
    if (wets) context_.recorder.record(SetFieldAmount{{id.index1 - 1, amount}});
}

void FieldSystem::paint(FwParticleFieldId id, const uint8_t* paint, const uint8_t* walls) {
    components::ParticleField& field = fields_.get(id)->data;
    components::ParticleField before(context_.memory);
    before.painted = field.painted, before.walled = field.walled, before.masks = field.masks;
    components::paintField(field, paint, walls);
    try {
        context_.backend.setFieldMasks(id.index1 - 1, field.masks);
        if (auto& cells = fields_.get(id)->cells) field::maskField(*cells, field.masks);
    } catch (...) {
        field.painted.swap(before.painted);
        field.walled.swap(before.walled);
        field.masks.swap(before.masks);
        throw;
    }
}

void FieldSystem::fillState(FwParticleFieldId id, FwParticleFieldState& state) {
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
    state.bytes = context_.backend.fieldBytes(id.index1 - 1);
}

field::FieldRules FieldSystem::rulesOf(const components::ParticleField& field) const noexcept {
    return components::rulesOf(field, wind_.steadyAt(field.position).data());
}

void FieldSystem::sendRules() noexcept {
    sentUnder_ = wind_.state().updates;
    for (auto [i, field] : fields_.entries())
        context_.backend.setFieldRules(i, rulesOf(field.data));
}

void FieldSystem::plan(const HostFrame& frame, gpu::FramePlan& plan) noexcept {
    const uint64_t end = frame.end();
    if (sentUnder_ != wind_.state().updates) sendRules();
    runs_.clear();
    rounds_.clear();
    for (uint32_t round = 0; round < kMaxSteps; ++round) {
        for (auto [i, field] : fields_.entries()) {
            const uint32_t step = field.steps + round;
            FW_ASSERT(runs_.size() < runs_.capacity(), "%zu runs", runs_.size());
            if (step < components::fieldSteps(field.data, end - field.began))
                runs_.push_back({i, step - field.shownBase});
        }
        const auto count = uint32_t(runs_.size());
        if (count == (round > 0 ? rounds_.back() : 0)) break;
        rounds_.push_back(count);
    }
    update_.runs = runs_;
    update_.rounds = rounds_;
    const Clock& now = frame.time.after;
    const double ticks = double(now.tick) +
                         double(now.fraction) / double(Clock::kStepUnits) * double(gpu::kStepTicks);
    draws_.clear();
    drawn_.clear();
    for (auto [i, field] : fields_.entries()) {
        if ((field.data.flags & FW_FIELD_HIDDEN)) continue;
        draws_.push_back(
            components::fieldDraw(field.data, ticks - double(field.began),
                                  components::fieldSteps(field.data, end - field.began), ticks));
        drawn_.push_back(i);
    }
    update_.draws = draws_.data();
    update_.drawn = drawn_;
    if (fields_.live() > 0 || shown_ > 0) plan.fields = &update_;
}

void FieldSystem::commit(const HostFrame& frame) noexcept {
    const uint64_t end = frame.end();
    FW_ASSERT(draws_.size() <= gpu::kMaxFields && draws_.size() == drawn_.size(), "%zu fields",
              draws_.size());
    shown_ = uint32_t(draws_.size());
    for (auto [i, field] : fields_.entries()) {
        field.steps = components::fieldSteps(field.data, end - field.began);
        stepCells(field, end);  // before the host changes its rules
    }
}

void FieldSystem::onReadback(const gpu::Readback& readback) noexcept {
    const size_t count = std::min<size_t>(fields_.slotCount(), readback.fields.size());
    for (uint32_t i = 0; i < count; ++i) {
        auto* field = fields_.at(i);
        if (!field || (*field)->firstFrame > readback.frameIndex) continue;
        (*field)->counters = readback.fields[i];
        (*field)->countersFrame = readback.frameIndex;
    }
}

void FieldSystem::stepCells(Field& field, uint64_t tick) noexcept {
    if (!field.cells) return;
    const uint32_t steps = components::fieldSteps(field.data, tick - field.began);
    if (field.cells->step >= steps) return;
    const field::FieldRules rules = rulesOf(field.data);
    while (field.cells->step < steps) field::stepField(*field.cells, rules);
}

void FieldSystem::wetObjects(uint32_t now) {
    for (auto [i, field] : fields_.entries())
        if (field.cells) wetObjects(field, now);
}

void FieldSystem::wetObjects(Field& field, uint32_t now) {
    stepCells(field, now);
    const components::ParticleField& data = field.data;
    const uint32_t width = data.def.width, height = data.def.height;
    float middle[3], far = 0;
    components::cellPlace(data, 0.5f, 0.5f, middle);
    for (const float side : data.size) far += side * side;
    const float wide = data.size[0] * float(kBlock) / float(width);
    const float tall = data.size[1] * float(kBlock) / float(height);
    const bool card = data.shape == FW_FIELD_BILLBOARD;
    FwIgnitionDef def{};
    def.kind = FW_WET;
    def.radius = std::max(0.75f * std::max(card ? wide : 3.1415927f * wide, tall),
                          card ? kDepth * data.size[0] : 0.0f);
    const float reach = std::sqrt(far) + def.radius;
    for (const uint32_t slot : scene_.objectsNear(middle, reach)) {
        Object& object = scene_.objectAt(slot);
        if (object.texels == 0) continue;
        const components::Pose& pose = object.data.pose;
        const float least = shortestAxis(pose);
        float local[3];
        components::toObject(pose, middle, local);
        if (!object.skinMoved && scene_.nearTexel(object, local, reach / least) == mesh::kNone)
            continue;
        for (uint32_t y = 0; y < height; y += kBlock)
            for (uint32_t x = 0; x < width; x += kBlock) {
                uint32_t held = 0;
                const uint32_t endY = std::min(y + kBlock, height), endX = x + kBlock;
                for (uint32_t cy = y; cy < endY; ++cy)
                    for (uint32_t cx = x; cx < endX; ++cx)
                        held += field::cellAt(*field.cells, cx, cy);
                const uint32_t cells = (endY - y) * kBlock;
                if (held < kFewest * cells) continue;
                const uint32_t full = uint32_t(gpu::kFieldFull) * cells;
                def.water = float(std::max(std::min(held, full) * kGramsOfFull / full, 1u));
                components::cellPlace(data, (float(x) + 0.5f * kBlock) / float(width),
                                      0.5f * float(y + endY) / float(height), def.position);
                (void)burn_.igniteObject(object, def, now);
            }
    }
}

// ---- saves ------------------------------------------------------------------------------------

void FieldSystem::capture(SlottedList<FieldSnapshot>& to) const {
    captureSlots(fields_, to, [&](const Field& field, FieldSnapshot& made) {
        made.width = field.data.def.width;
        made.height = field.data.def.height;
        made.began = field.began;
        std::copy_n(field.data.position, 3, made.position);
        std::copy_n(field.data.rotation, 4, made.rotation);
        made.amount = field.data.def.appearance.amount;
        if (!field.cells) return;
        made.cells = core::Owned<field::FieldCells>::make(context_.memory, context_.memory);
        *made.cells = *field.cells;
    });
}

void FieldSystem::checkSnapshot(const SlottedList<FieldSnapshot>& from, uint64_t tick) const {
    checkSlots(from, fields_, "particle field", "particle fields");
    for (const Slotted<FieldSnapshot>& one : from) {
        const Field& mine = **fields_.at(one.slot);
        const auto fits = [&](const auto& size) {
            return size.width == one.width && size.height == one.height;
        };
        checkSame(bool(mine.cells) == bool(one.cells) && fits(mine.data.def) && one.began <= tick &&
                      (!one.cells || fits(*one.cells)),
                  "particle field", one.slot);
    }
}

void FieldSystem::restore(SlottedList<FieldSnapshot>& from) noexcept {
    for (Slotted<FieldSnapshot>& one : from) {
        Field& field = **fields_.at(one.slot);
        // The backend counts its own steps, and continues from them.
        const uint32_t ran = field.steps - field.shownBase;
        field.began = one.began;
        std::copy_n(one.position, 3, field.data.position);
        std::copy_n(one.rotation, 4, field.data.rotation);
        field.data.def.appearance.amount = one.amount;
        field.steps = components::fieldSteps(field.data, context_.clock.tick - field.began);
        field.shownBase = field.steps - ran;
        if (one.cells) static_cast<field::FieldCells&>(*field.cells) = std::move(*one.cells);
    }
    sendRules();
}

}  // namespace fw::world
