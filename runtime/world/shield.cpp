// The heat-occlusion grid: the host gives all of it at once, with the cells that objects fill as
// they stand then. Backends find out whether such a cell is still there, so that no call has to
// come in time.
#include "world/exchange_system.h"
#include "world/persistence.h"

#include <algorithm>
#include <cmath>

namespace fw::world {
namespace {

// Where it is, and as far around it as texels fill cells of it.
mesh::Box boxOf(const components::OcclusionGridShape& shape) noexcept {
    mesh::Box box;
    for (size_t i = 0; i < 3; ++i) {
        const int64_t low = shape.origin[i], cell = shape.cell;
        box.low[i] = int(std::max<int64_t>(low - 3 * cell, -2000000000));
        box.high[i] = int(std::min<int64_t>(low + (shape.counts[i] + 3) * cell, 2000000000));
    }
    return box;
}

}  // namespace

components::OcclusionObject ExchangeSystem::occlusionObjectOf(uint32_t slot) noexcept {
    const Object& object = scene_.objectAt(slot);
    components::OcclusionObject made;
    made.slot = slot;
    made.domain = &scene_.domainOf(object);
    components::placeExchangeObject(object.data.pose, *made.domain, made.place);
    double longest = 0;
    for (const float s : object.data.pose.stretch) longest = std::max(longest, std::abs(double(s)));
    made.texelSide = uint32_t(
        std::clamp(double(made.domain->texelSide) * double(object.data.pose.scale) * longest * 1000,
                   0.0, 1e6));
    for (uint32_t i = 0; i < components::kMaterials; ++i)
        if (components::holeTicks(object.data, i, context_.def.paceFactor) == 0)
            made.stays |= 1u << i;
    return made;
}

void ExchangeSystem::bakeHeatOcclusion(const components::OcclusionGridShape& shape,
                                       std::pmr::vector<uint32_t>& slots,
                                       std::pmr::vector<components::OcclusionCell>& baked) {
    std::sort(slots.begin(), slots.end());
    slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
    std::pmr::vector<components::OcclusionObject> objects(context_.memory);
    for (const uint32_t slot : slots) objects.push_back(occlusionObjectOf(slot));
    components::bakeOcclusion(shape, objects, baked);
}

void ExchangeSystem::setHeatOcclusion(const FwHeatOcclusionDef& def) {
    context_.recorder.mayChange();
    components::HeatOcclusion made(context_.memory);
    std::pmr::vector<uint32_t> slots(context_.memory);
    if (def.structSize != 0) {
        made.shape = components::makeOcclusionGridShape(def);
        if (def.objectCount != 0 && !def.objects)
            core::fail(FW_ERROR_INVALID_ARGUMENT,
                       "FwHeatOcclusionDef::objects is null, and objectCount is %u.",
                       def.objectCount);
        for (uint32_t i = 0; i < def.objectCount; ++i)
            slots.push_back((*scene_.objects.get(def.objects[i])).slot);
        if (def.flags & FW_HEAT_OCCLUSION_ALL_OBJECTS) {
            const std::span<const uint32_t> near = scene_.objectsNear(boxOf(made.shape), 0);
            slots.insert(slots.end(), near.begin(), near.end());
        }
        components::readOcclusionCells(def, made.shape, made.solid);
    }
    bakeHeatOcclusion(made.shape, slots, made.baked);
    uploadOcclusion(made, slots);
    adoptOcclusion(made);
}

void ExchangeSystem::adoptOcclusion(components::HeatOcclusion& made) noexcept {
    state_.shield.grid.shape = made.shape;
    state_.shield.grid.solid.swap(made.solid);
    state_.shield.grid.baked.swap(made.baked);
    occlusionChanged();
}

// Jets end at the host's cells, too.
void ExchangeSystem::occlusionChanged() noexcept {
    state_.shield.unsent = state_.shield.unpacked = true;
    ++scene_.geometryVersion;
}

// The grid's shape, if it changed; then the words of the host's cells that changed; then all
// objects.
void ExchangeSystem::uploadOcclusion(const components::HeatOcclusion& made,
                                     std::span<const uint32_t> slots) noexcept {
    if (!context_.recorder.records()) return;
    const bool stays = made.shape == state_.shield.grid.shape;
    if (!stays) context_.recorder.record(SetHeatShield{made.shape});
    const auto words = uint32_t(made.solid.size());
    for (uint32_t first = 0; first < words; first += SetShieldCells::kWords) {
        SetShieldCells command{first};
        bool differs = false;
        for (uint32_t k = 0; k < command.kWords && first + k < words; ++k) {
            command.words[k] = made.solid[first + k];
            differs |= command.words[k] != (stays ? state_.shield.grid.solid[first + k] : 0);
        }
        if (differs) context_.recorder.record(command);
    }
    for (size_t i = 0; i < slots.size(); ++i)
        context_.recorder.record(AddShieldObject{slots[i] + 1, i + 1 == slots.size()});
    if (slots.empty() && stays && !state_.shield.grid.baked.empty())
        context_.recorder.record(AddShieldObject{0, true});
}

void ExchangeSystem::applyShield(const SetHeatShield& command) {
    context_.recorder.mayChange();
    components::HeatOcclusion made(context_.memory);
    made.shape = command.shape;
    made.solid.assign(made.shape.words(), 0);
    adoptOcclusion(made);
    state_.shield.commandSlots.clear();
    context_.recorder.record(command);
}

void ExchangeSystem::applyShieldCells(const SetShieldCells& command) {
    context_.recorder.mayChange();
    components::HeatOcclusion& grid = state_.shield.grid;
    if (command.first >= grid.solid.size())
        core::fail(FW_ERROR_BAD_DATA, "A command is of word %u of the shield, which has %zu.",
                   command.first, grid.solid.size());
    std::copy_n(command.words.begin(),
                std::min<size_t>(command.kWords, grid.solid.size() - command.first),
                grid.solid.begin() + std::ptrdiff_t(command.first));
    if (const uint32_t over = grid.shape.cells() % 32; over != 0)
        grid.solid.back() &= (1u << over) - 1;
    occlusionChanged();
    context_.recorder.record(command);
}

void ExchangeSystem::applyShieldObject(const AddShieldObject& command) {
    context_.recorder.mayChange();
    if (command.object1 != 0) {
        if (command.object1 > scene_.objects.slotCount() || !scene_.objects.at(command.object1 - 1))
            core::fail(FW_ERROR_BAD_DATA, "A command shields by object %u, which is not there.",
                       command.object1);
        if (state_.shield.commandSlots.size() >= scene_.objects.live())
            core::fail(FW_ERROR_BAD_DATA,
                       "Commands name more objects for one shield than the %u that there are.",
                       scene_.objects.live());
        state_.shield.commandSlots.push_back(command.object1 - 1);
    }
    if (command.last) {
        std::pmr::vector<uint32_t> slots(context_.memory);
        slots.swap(state_.shield.commandSlots);
        bakeHeatOcclusion(state_.shield.grid.shape, slots, state_.shield.grid.baked);
        state_.shield.unsent = state_.shield.unpacked = true;
    }
    context_.recorder.record(command);
}

// The slot of a destroyed object may become another's.
void ExchangeSystem::removeFromShield(uint32_t slot) noexcept {
    std::erase(state_.shield.commandSlots, slot);
    const size_t gone =
        std::erase_if(state_.shield.grid.baked, [&](const components::OcclusionCell& cell) {
            return (cell.what & gpu::kOcclusionSlotMask) == slot;
        });
    if (gone != 0) state_.shield.unsent = state_.shield.unpacked = true;
}

void ExchangeSystem::packHeatOcclusion() {
    if (state_.shield.unpacked) components::packOcclusion(state_.shield.grid, state_.shield.words);
    state_.shield.unpacked = false;
}

// For queries, which are answered at once while texels come some frames later: an object's cells
// are there until half of it has burnt.
components::OcclusionView ExchangeSystem::occlusionView() {
    components::OcclusionView view;
    packHeatOcclusion();
    if (state_.shield.grid.shape.cells() == 0) return view;
    state_.shield.fallen.assign(scene_.objects.slotCount(), 0);
    for (const Object* object : scene_.touched) {  // nothing of the others has burnt
        const gpu::ObjectCounters& now = object->counters;
        const uint32_t burnt = now.ignited - std::min(now.ignited, now.burning);
        const bool holes = !(object->data.flags & FW_BURNABLE_NO_HOLES);
        state_.shield.fallen[object->slot] = holes && 2 * uint64_t{burnt} > object->texels ? 1 : 0;
    }
    view.shape = state_.shield.grid.shape;
    view.words = state_.shield.words;
    view.fallen = state_.shield.fallen;
    return view;
}

// awake: the step will run.
void ExchangeSystem::planOcclusion(gpu::StepPlan& step, bool awake) {
    if (!awake || !state_.shield.unsent || frame_.occlusionSent) return;
    packHeatOcclusion();
    const components::OcclusionGridShape& shape = state_.shield.grid.shape;
    state_.shield.update.origin = {shape.origin[0], shape.origin[1], shape.origin[2]};
    state_.shield.update.cell = shape.cell;
    state_.shield.update.counts = components::countsOf(shape);
    state_.shield.update.words = state_.shield.words;
    step.shield = &state_.shield.update;
    frame_.occlusionSent = true;
}

}  // namespace fw::world
