// The heat-occlusion grid: the host gives all of it at once, with the cells that objects fill as
// they stand then. Backends find out whether such a cell is still there, so that no call has to
// come in time.
#include "world/exchange_system.h"
#include "world/recording.h"

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

void ExchangeSystem::setHeatOcclusion(const FwHeatOcclusionDef& def, float unitsPerMetre) {
    context_.recorder.mayChange();
    components::HeatOcclusion made(context_.memory);
    std::pmr::vector<uint32_t> slots(context_.memory);
    if (def.structSize != 0) {
        made.shape = components::makeOcclusionGridShape(def);
        if (def.objectCount != 0 && !def.objects)
            core::refuse("FwHeatOcclusionDef::objects is null, and objectCount is %u.",
                         def.objectCount);
        for (uint32_t i = 0; i < def.objectCount; ++i)
            slots.push_back((*scene_.objects.get(def.objects[i])).slot);
        if (def.flags & FW_HEAT_OCCLUSION_ALL_OBJECTS) {
            const std::span<const uint32_t> near = scene_.objectsNear(boxOf(made.shape), 0);
            slots.insert(slots.end(), near.begin(), near.end());
        }
        components::readOcclusionCells(def, made.shape, unitsPerMetre, made.solid);
    }
    bakeHeatOcclusion(made.shape, slots, made.baked);
    uploadOcclusion(made, slots);
    adoptOcclusion(made);
}

void ExchangeSystem::adoptOcclusion(components::HeatOcclusion& made) noexcept {
    heatOcclusion_.grid = std::move(made);
    occlusionChanged();
}

// Jets end at the host's cells, too.
void ExchangeSystem::occlusionChanged() noexcept {
    heatOcclusion_.unsent = heatOcclusion_.unpacked = true;
    ++scene_.geometryVersion;
}

// The grid's shape, if it changed; then the words of the host's cells that changed; then all
// objects.
void ExchangeSystem::uploadOcclusion(const components::HeatOcclusion& made,
                                     std::span<const uint32_t> slots) noexcept {
    if (!context_.recorder.records()) return;
    const bool stays = made.shape == heatOcclusion_.grid.shape;
    if (!stays) context_.recorder.record(SetHeatOcclusion{made.shape});
    recordParts<SetOcclusionCells>(context_.recorder, made.solid, heatOcclusion_.grid.solid, stays);
    for (size_t i = 0; i < slots.size(); ++i)
        context_.recorder.record(AddOcclusionObject{slots[i] + 1, i + 1 == slots.size()});
    if (slots.empty() && stays && !heatOcclusion_.grid.baked.empty())
        context_.recorder.record(AddOcclusionObject{0, true});
}

void ExchangeSystem::apply(const SetHeatOcclusion& command) {
    context_.recorder.mayChange();
    components::HeatOcclusion made(context_.memory);
    made.shape = command.shape;
    made.solid.assign(made.shape.words(), 0);
    adoptOcclusion(made);
    heatOcclusion_.commandSlots.clear();
    context_.recorder.record(command);
}

void ExchangeSystem::apply(const SetOcclusionCells& command) {
    context_.recorder.mayChange();
    components::HeatOcclusion& grid = heatOcclusion_.grid;
    if (command.first >= grid.solid.size())
        core::failData("A command is of word %u of the heat-occlusion grid, which has %zu.",
                       command.first, grid.solid.size());
    std::copy_n(command.values.begin(),
                std::min<size_t>(command.kCount, grid.solid.size() - command.first),
                grid.solid.begin() + std::ptrdiff_t(command.first));
    if (const uint32_t over = grid.shape.cells() % 32; over != 0)
        grid.solid.back() &= (1u << over) - 1;
    occlusionChanged();
    context_.recorder.record(command);
}

void ExchangeSystem::apply(const AddOcclusionObject& command) {
    context_.recorder.mayChange();
    if (command.object1 != 0) {
        if (!scene_.objects.findSlot(command.object1 - 1))
            core::failData("A command occludes heat by object %u, which is not there.",
                           command.object1);
        if (heatOcclusion_.commandSlots.size() >= scene_.objects.live())
            core::failData(
                "Commands name more objects for one heat-occlusion grid than the %u that there "
                "are.",
                scene_.objects.live());
        heatOcclusion_.commandSlots.push_back(command.object1 - 1);
    }
    if (command.last) {
        std::pmr::vector<uint32_t> slots(context_.memory);
        slots.swap(heatOcclusion_.commandSlots);
        bakeHeatOcclusion(heatOcclusion_.grid.shape, slots, heatOcclusion_.grid.baked);
        heatOcclusion_.unsent = heatOcclusion_.unpacked = true;
    }
    context_.recorder.record(command);
}

// The slot of a destroyed object may become another's.
void ExchangeSystem::removeOccluderCells(uint32_t slot) noexcept {
    std::erase(heatOcclusion_.commandSlots, slot);
    const size_t gone =
        std::erase_if(heatOcclusion_.grid.baked, [&](const components::OcclusionCell& cell) {
            return (cell.what & gpu::kOcclusionSlotMask) == slot;
        });
    if (gone != 0) heatOcclusion_.unsent = heatOcclusion_.unpacked = true;
}

void ExchangeSystem::packHeatOcclusion() {
    if (heatOcclusion_.unpacked)
        components::packOcclusion(heatOcclusion_.grid, heatOcclusion_.words);
    heatOcclusion_.unpacked = false;
}

// For queries, which are answered at once while texels come some frames later: an object's cells
// are there until half of it has burnt.
components::OcclusionView ExchangeSystem::occlusionView() {
    components::OcclusionView view;
    packHeatOcclusion();
    if (heatOcclusion_.grid.shape.cells() == 0) return view;
    heatOcclusion_.fallen.assign(scene_.objects.slotCount(), 0);
    for (const Object* object : scene_.touched) {  // nothing of the others has burnt
        const gpu::ObjectCounters& now = object->counters;
        const uint32_t burnt = now.ignited - std::min(now.ignited, now.burning);
        const bool holes = !(object->data.flags & FW_BURNABLE_NO_HOLES);
        heatOcclusion_.fallen[object->slot] = holes && 2 * uint64_t{burnt} > object->texels ? 1 : 0;
    }
    view.shape = heatOcclusion_.grid.shape;
    view.words = heatOcclusion_.words;
    view.fallen = heatOcclusion_.fallen;
    return view;
}

// awake: the step will run.
void ExchangeSystem::planOcclusion(gpu::StepPlan& step, bool awake) {
    if (!awake || !heatOcclusion_.unsent || frame_.occlusionSent) return;
    packHeatOcclusion();
    const components::OcclusionGridShape& shape = heatOcclusion_.grid.shape;
    heatOcclusion_.update.origin = {shape.origin[0], shape.origin[1], shape.origin[2]};
    heatOcclusion_.update.cell = shape.cell;
    heatOcclusion_.update.counts = components::countsOf(shape);
    heatOcclusion_.update.words = heatOcclusion_.words;
    step.occlusionUpdate = &heatOcclusion_.update;
    frame_.occlusionSent = true;
}

}  // namespace fw::world
