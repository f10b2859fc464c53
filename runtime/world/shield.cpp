// The shield between fires and what they would warm: given anew by the host, with what objects fill
// of it as they stand then. Whether such a cell is still there is the backends' to find, so that no
// call has to come in time.
#include "components/heat_shield.h"
#include "components/wind_zone.h"
#include "world/world.h"

#include <algorithm>
#include <cmath>

namespace fw::world {
namespace {

// Where it is, and as far around it as texels fill cells of it.
mesh::Box boxOf(const components::ShieldShape& shape) noexcept {
    mesh::Box box;
    for (size_t i = 0; i < 3; ++i) {
        const int64_t low = shape.origin[i], cell = shape.cell;
        box.low[i] = int(std::max<int64_t>(low - 3 * cell, -2000000000));
        box.high[i] = int(std::min<int64_t>(low + (shape.counts[i] + 3) * cell, 2000000000));
    }
    return box;
}

}  // namespace

components::ShieldObject World::shieldObjectOf(uint32_t slot) noexcept {
    const Object& object = **objects_.at(slot);
    components::ShieldObject made;
    made.slot = slot;
    made.domain = &domainOf(object);
    components::placeRemote(object.data.pose, *made.domain, made.place);
    double longest = 0;
    for (const float s : object.data.pose.stretch) longest = std::max(longest, std::abs(double(s)));
    made.texelSide = uint32_t(
        std::clamp(double(made.domain->texelSide) * double(object.data.pose.scale) * longest * 1000,
                   0.0, 1e6));
    for (uint32_t i = 0; i < components::kMaterials; ++i)
        if (components::holeTicks(object.data, i, def_.paceFactor) == 0) made.stays |= 1u << i;
    return made;
}

void World::bakeHeatShield(const components::ShieldShape& shape, std::pmr::vector<uint32_t>& slots,
                           std::pmr::vector<components::ShieldCell>& baked) {
    std::sort(slots.begin(), slots.end());
    slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
    std::pmr::vector<components::ShieldObject> objects(memory_);
    for (const uint32_t slot : slots) objects.push_back(shieldObjectOf(slot));
    components::bakeShield(shape, objects, baked);
}

void World::setHeatShield(const FwHeatShieldDef& def) {
    mayChange();
    components::HeatShield made(memory_);
    std::pmr::vector<uint32_t> slots(memory_);
    if (def.structSize != 0) {
        made.shape = components::makeShieldShape(def);
        if (def.objectCount != 0 && !def.objects)
            core::fail(FW_ERROR_INVALID_ARGUMENT,
                       "FwHeatShieldDef::objects is null, and objectCount is %u.", def.objectCount);
        for (uint32_t i = 0; i < def.objectCount; ++i)
            slots.push_back((*objects_.get(def.objects[i])).slot);
        if (def.flags & FW_HEAT_SHIELD_ALL_OBJECTS) {
            const std::span<const uint32_t> near = objectsNear(boxOf(made.shape), 0);
            slots.insert(slots.end(), near.begin(), near.end());
        }
        components::readShieldCells(def, made.shape, made.solid);
    }
    bakeHeatShield(made.shape, slots, made.baked);
    recordShield(made, slots);
    adoptShield(made);
}

void World::adoptShield(components::HeatShield& made) noexcept {
    shield_.grid.shape = made.shape;
    shield_.grid.solid.swap(made.solid);
    shield_.grid.baked.swap(made.baked);
    shieldChanged();
}

// The host's cells are others: jets end there, too.
void World::shieldChanged() noexcept {
    shield_.unsent = shield_.unpacked = true;
    ++geometry_;
}

// The grid's shape if it is another, then the words of the host's cells that differ, then all
// objects.
void World::recordShield(const components::HeatShield& made,
                         std::span<const uint32_t> slots) noexcept {
    if (!records()) return;
    const bool stays = made.shape == shield_.grid.shape;
    if (!stays) record(SetHeatShield{made.shape});
    const auto words = uint32_t(made.solid.size());
    for (uint32_t first = 0; first < words; first += SetShieldCells::kWords) {
        SetShieldCells command{first};
        bool differs = false;
        for (uint32_t k = 0; k < command.kWords && first + k < words; ++k) {
            command.words[k] = made.solid[first + k];
            differs |= command.words[k] != (stays ? shield_.grid.solid[first + k] : 0);
        }
        if (differs) record(command);
    }
    for (size_t i = 0; i < slots.size(); ++i)
        record(AddShieldObject{slots[i] + 1, i + 1 == slots.size()});
    if (slots.empty() && stays && !shield_.grid.baked.empty()) record(AddShieldObject{0, true});
}

void World::applyShield(const SetHeatShield& command) {
    mayChange();
    components::HeatShield made(memory_);
    made.shape = command.shape;
    made.solid.assign(made.shape.words(), 0);
    adoptShield(made);
    shield_.told.clear();
    record(command);
}

void World::applyShieldCells(const SetShieldCells& command) {
    mayChange();
    components::HeatShield& grid = shield_.grid;
    if (command.first >= grid.solid.size())
        core::fail(FW_ERROR_BAD_DATA, "A command is of word %u of the shield, which has %zu.",
                   command.first, grid.solid.size());
    std::copy_n(command.words.begin(),
                std::min<size_t>(command.kWords, grid.solid.size() - command.first),
                grid.solid.begin() + std::ptrdiff_t(command.first));
    if (const uint32_t over = grid.shape.cells() % 32; over != 0)
        grid.solid.back() &= (1u << over) - 1;
    shieldChanged();
    record(command);
}

void World::applyShieldObject(const AddShieldObject& command) {
    mayChange();
    if (command.object1 != 0) {
        if (command.object1 > objects_.slotCount() || !objects_.at(command.object1 - 1))
            core::fail(FW_ERROR_BAD_DATA, "A command shields by object %u, which is not there.",
                       command.object1);
        if (shield_.told.size() >= objects_.live())
            core::fail(FW_ERROR_BAD_DATA,
                       "Commands name more objects for one shield than the %u that there are.",
                       objects_.live());
        shield_.told.push_back(command.object1 - 1);
    }
    if (command.last) {
        std::pmr::vector<uint32_t> slots(memory_);
        slots.swap(shield_.told);
        bakeHeatShield(shield_.grid.shape, slots, shield_.grid.baked);
        shield_.unsent = shield_.unpacked = true;
    }
    record(command);
}

// Who is destroyed stands in nobody's way, and its slot may be another's.
void World::dropFromShield(uint32_t slot) noexcept {
    std::erase(shield_.told, slot);
    const size_t gone = std::erase_if(shield_.grid.baked, [&](const components::ShieldCell& cell) {
        return (cell.what & gpu::kShieldSlot) == slot;
    });
    if (gone != 0) shield_.unsent = shield_.unpacked = true;
}

void World::packHeatShield() {
    if (shield_.unpacked) components::packShield(shield_.grid, shield_.words);
    shield_.unpacked = false;
}

// For who is asked at once, and hears of texels some frames later: an object's cells are there
// until half of it has burnt.
components::ShieldView World::shieldView() {
    components::ShieldView view;
    packHeatShield();
    if (shield_.grid.shape.cells() == 0) return view;
    shield_.fallen.assign(objects_.slotCount(), 0);
    for (const Object* object : touched_) {  // nothing of the others has burnt
        const gpu::ObjectCounters& now = object->counters;
        const uint32_t burnt = now.ignited - std::min(now.ignited, now.burning);
        const bool holes = !(object->data.flags & FW_BURNABLE_NO_HOLES);
        shield_.fallen[object->slot] = holes && 2 * uint64_t{burnt} > object->texels ? 1 : 0;
    }
    view.shape = shield_.grid.shape;
    view.words = shield_.words;
    view.fallen = shield_.fallen;
    return view;
}

// awake: the step will run.
void World::planShield(gpu::StepPlan& step, bool awake) {
    if (!awake || !shield_.unsent || frame_.shieldSent) return;
    packHeatShield();
    const components::ShieldShape& shape = shield_.grid.shape;
    shield_.update.origin = {shape.origin[0], shape.origin[1], shape.origin[2]};
    shield_.update.cell = shape.cell;
    shield_.update.counts = components::countsOf(shape);
    shield_.update.words = shield_.words;
    step.shield = &shield_.update;
    frame_.shieldSent = true;
}

}  // namespace fw::world
