// Wind and gravity of fronts: filtered every step and latched at most four times a second, for
// objects that an event has touched. Others get fresh records at their first event.
#include "world/burn_system.h"
#include "world/exchange_system.h"
#include "world/wind_system.h"

#include <algorithm>

namespace fw::world {

void BurnSystem::addLatch(Object& object, const components::Latch& latch) noexcept {
    object.planStamp = state_.planStamp;
    object.latchIndex = frame_.latches.size();
    FW_ASSERT(frame_.latches.size() < frame_.latches.capacity(), "%zu latches",
              frame_.latches.size());
    frame_.latches.push_back({&object, latch});
}

// As if the wind that blows now had always blown.
void BurnSystem::addFreshLatch(Object& object, uint32_t now) noexcept {
    components::Latch latch = object.latch;
    components::resetLatch(object.data, wind_.driveInput(object, now), latch);
    latch.sent = object.latch.sent && components::sameDrive(object.data, latch, object.latch);
    addLatch(object, latch);
    frame_.latches.back().due = true;
}

void BurnSystem::sendRecords(Frame::LatchOf& entry, const components::DriveInput& drive) {
    const Object& object = *entry.object;
    const components::Records records =
        components::makeRecords(object.data, scene_.domainOf(object), drive, entry.latch);
    gpu::MaterialUpdate update;
    update.object = object.slot;
    std::copy(records.materials.begin(), records.materials.end(), update.materials);
    update.window = records.timing.window;
    update.substepShift = records.timing.substepShift;
    frame_.updates.push_back(update);
    entry.latch.sent = true;
}

// Whether other records change anything of an object that no event addresses. A readback may be
// late: an object at rest by one readback needs no records until the next can have come. Beyond the
// window nothing is corrected. Warm and wet texels use the records, too.
bool BurnSystem::needsRecords(const Object& object, uint32_t now) const noexcept {
    if (isActive(object)) return true;
    if (state_.counts.hot != 0 && components::hasHeat(object.data)) return true;
    const uint64_t last =
        std::max<uint64_t>(object.counters.lastIgnition, object.lifecycle.lastStimulus);
    return last != 0 && now <= last + 2 * (uint64_t(object.latch.window) + gpu::kStepTicks);
}

void BurnSystem::planLatches(uint32_t now, size_t firstEvent, bool placed) {
    // Objects whose first event is in this step, or whose latch was held back while they slept.
    for (size_t i = firstEvent; i < frame_.events.size(); ++i) {
        const uint32_t slot = frame_.events[i].object;
        if (i > firstEvent && frame_.events[i - 1].object == slot) continue;
        Object& object = scene_.objectAt(slot);
        if (object.planStamp != state_.planStamp) addFreshLatch(object, now);
        FW_ASSERT(object.latchIndex < frame_.latches.size(), "%zu of %zu latches",
                  object.latchIndex, frame_.latches.size());
        Frame::LatchOf& entry = frame_.latches[object.latchIndex];
        entry.due = true;
        if (!entry.latch.sent) sendRecords(entry, wind_.driveInput(object, now));
    }
    const bool fresh = firstEvent < frame_.events.size();
    if (fresh && !exchange_.isOn()) exchange_.forgetSpread();
    if (exchange_.isOn()) {
        if (fresh || placed) touchNear(now);
        // Nobody knows which of them the fire reaches first.
        if (fresh || placed)
            for (Frame::LatchOf& entry : frame_.latches)
                if (!entry.latch.sent) sendRecords(entry, wind_.driveInput(*entry.object, now));
    }
    // While anything burns or is hot, any of them may be next.
    const bool anyActive = exchange_.isOn() && (fresh || !state_.idle);
    const bool latchNow = now % fire::kWindLatchTicks == 0;
    for (Frame::LatchOf& entry : frame_.latches) {
        Object& object = *entry.object;
        const components::DriveInput drive = wind_.driveInput(object, now);
        components::filterLatch(object.data, scene_.domainOf(object), drive, entry.latch);
        if (!latchNow || !components::latchDrive(object.data, entry.latch)) continue;
        entry.latch.sent = false;
        turnPlay(object);
        if (needsRecords(object, now) || entry.due || anyActive) sendRecords(entry, drive);
    }
}

// Objects that fire may reach from touched ones must have the same wind on every backend, whether
// the readback that shows it is late or not.
void BurnSystem::touchNear(uint32_t now) {
    const auto add = [&](uint32_t slot) {
        auto* owned = scene_.objects.at(slot);
        if (owned && (*owned)->planStamp != state_.planStamp && !(*owned)->touched)
            addFreshLatch(**owned, now);
    };
    if (exchange_.transfer().flags & FW_WORLD_EMBERS) {
        for (const uint32_t slot : exchange_.transfer().waiting.slots()) add(slot);
        frame_.waitersTouched = true;
        return;
    }
    const auto addNear = [&](const Object& object) {
        for (const uint32_t entry : exchange_.transfer().neighbours.of(object.slot))
            add(entry & Neighbours::kSlot);
    };
    // Once all neighbours of touched objects are touched, only other lists and other objects can
    // bring more.
    if (!exchange_.transfer().spreadKnown)
        for (const Object* object : scene_.touched) addNear(*object);
    else
        for (const uint32_t slot : exchange_.transfer().neighbours.changed())
            if (const auto* owned = scene_.objects.at(slot);
                owned && ((*owned)->touched || (*owned)->planStamp == state_.planStamp))
                addNear(**owned);
    for (; frame_.spreadFrom < frame_.latches.size(); ++frame_.spreadFrom)
        addNear(*frame_.latches[frame_.spreadFrom].object);
    frame_.spreadFound = true;
}

}  // namespace fw::world
