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

constexpr uint32_t kCellsOfNumber = 24;  // a float holds them exactly
constexpr uint32_t kNumbersOfDeed = 12;
constexpr uint32_t kCellsOfDeed = kCellsOfNumber * kNumbersOfDeed;

// 24 cells from `first` on, as far as there are any.
uint32_t cellsFrom(std::span<const uint32_t> solid, uint32_t first) noexcept {
    const uint32_t word = first / 32, shift = first % 32;
    if (word >= solid.size()) return 0;
    uint64_t two = solid[word];
    if (word + 1 < solid.size()) two |= uint64_t(solid[word + 1]) << 32;
    return uint32_t(two >> shift) & ((1u << kCellsOfNumber) - 1);
}

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
    noteShield(def, made, slots);
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

// The grid's place, if it is another; then what of the host's cells is another; then all objects.
void World::noteShield(const FwHeatShieldDef& def, const components::HeatShield& made,
                       std::span<const uint32_t> slots) noexcept {
    if (!notes()) return;
    const bool stays = made.shape == shield_.grid.shape;
    if (!stays) noteDef(Deed::Kind::heatShield, 0, def);
    const std::span<const uint32_t> before =
        stays ? std::span<const uint32_t>(shield_.grid.solid) : std::span<const uint32_t>();
    for (uint32_t first = 0; first < made.shape.cells(); first += kCellsOfDeed) {
        Deed deed;
        deed.kind = Deed::Kind::shieldCells;
        deed.slot = first / kCellsOfDeed;
        bool other = false;
        for (uint32_t k = 0; k < kNumbersOfDeed; ++k) {
            const uint32_t cells = cellsFrom(made.solid, first + k * kCellsOfNumber);
            other |= cells != cellsFrom(before, first + k * kCellsOfNumber);
            deed.numbers[k] = float(cells);
        }
        if (other) note(deed);
    }
    Deed deed;
    deed.kind = Deed::Kind::shieldObject;
    for (size_t i = 0; i < slots.size(); ++i) {
        deed.slot = slots[i] + 1;
        deed.word = i + 1 == slots.size() ? 1 : 0;
        note(deed);
    }
    deed.slot = 0;
    deed.word = 1;
    if (slots.empty() && stays && !shield_.grid.baked.empty()) note(deed);
}

void World::takeShield(const Deed& deed) {
    mayChange();
    const FwHeatShieldDef def = heatShieldDefOf(deed);
    components::HeatShield made(memory_);
    if (def.counts[0] != 0) made.shape = components::makeShieldShape(def);
    made.solid.assign(made.shape.words(), 0);
    adoptShield(made);
    shield_.told.clear();
    note(deed);
}

void World::takeShieldCells(const Deed& deed) {
    mayChange();
    components::HeatShield& grid = shield_.grid;
    if (uint64_t{deed.slot} * kCellsOfDeed >= grid.shape.cells())
        core::fail(FW_ERROR_BAD_DATA, "A deed is of cells %u x %u of the shield, which has %u.",
                   deed.slot, kCellsOfDeed, grid.shape.cells());
    for (uint32_t k = 0; k < kNumbersOfDeed; ++k) {
        const float number = deed.numbers[k];
        if (!(number >= 0 && number < float(1u << kCellsOfNumber)) || number != std::floor(number))
            core::fail(FW_ERROR_BAD_DATA, "A deed has %g for cells of the shield.", double(number));
    }
    for (uint32_t i = 0; i < kCellsOfDeed; ++i) {
        const uint32_t cell = deed.slot * kCellsOfDeed + i;
        if (cell >= grid.shape.cells()) break;
        const uint32_t bit = 1u << cell % 32;
        const bool there = uint32_t(deed.numbers[i / kCellsOfNumber]) >> i % kCellsOfNumber & 1;
        grid.solid[cell / 32] = (grid.solid[cell / 32] & ~bit) | (there ? bit : 0u);
    }
    shieldChanged();
    note(deed);
}

void World::takeShieldObject(const Deed& deed) {
    mayChange();
    if (deed.slot != 0 && (deed.slot > objects_.slotCount() || !objects_.at(deed.slot - 1)))
        core::fail(FW_ERROR_BAD_DATA, "A deed shields by object %u, which is not there.",
                   deed.slot);
    if (deed.slot != 0 && shield_.told.size() >= objects_.live())
        core::fail(FW_ERROR_BAD_DATA,
                   "Commands name more objects for one shield than the %u that there are.",
                   objects_.live());
    if (deed.slot != 0) shield_.told.push_back(deed.slot - 1);
    if (deed.word != 0) {
        std::pmr::vector<uint32_t> slots(memory_);
        slots.swap(shield_.told);
        bakeHeatShield(shield_.grid.shape, slots, shield_.grid.baked);
        shield_.unsent = shield_.unpacked = true;
    }
    note(deed);
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
