// Wind and gravity on their way to a front: filtered every step, latched at most four times a
// second, for objects that an event has touched. The others get fresh records at their first event.
#include "world/world.h"

#include <algorithm>

namespace fw::world {

void World::addLatch(Object& object, const components::Latch& latch, bool due) noexcept {
    object.planStamp = planStamp_;
    object.latchIndex = frame_.latches.size();
    frame_.latches.push_back({&object, latch, due});  // room was found at its creation
}

// May other records change anything of an object that no event addresses? A readback may be late,
// so who is surely at rest by one of them must need none for as long as another may still be on its
// way: beyond the window nothing is corrected, and what is warm or wet goes by its records, too.
bool World::needsRecords(const Object& object, uint32_t now) const noexcept {
    if (isActive(object)) return true;
    if (hotTiles_ != 0 && components::hasHeat(object.data)) return true;
    const uint64_t last =
        std::max<uint64_t>(object.counters.lastIgnition, object.story.lastStimulus);
    return last != 0 && now <= last + 2 * (uint64_t(object.latch.window) + gpu::kStepTicks);
}

void World::planLatches(uint32_t now, size_t firstEvent, bool placed) {
    const auto sendRecords = [&](Object& object, const components::DriveInput& drive,
                                 components::Latch& latch) {
        const components::Records records =
            components::makeRecords(object.data, domainOf(object), drive, latch);
        gpu::MaterialUpdate update;
        update.object = object.slot;
        std::copy(records.materials.begin(), records.materials.end(), update.materials);
        update.window = records.timing.window;
        update.substepShift = records.timing.substepShift;
        frame_.updates.push_back(update);
        latch.sent = true;
    };
    // Objects whose first event is in this step, or whose latch was held back while they slept.
    for (size_t i = firstEvent; i < frame_.events.size(); ++i) {
        const uint32_t slot = frame_.events[i].object;
        if (i > firstEvent && frame_.events[i - 1].object == slot) continue;
        Object& object = **objects_.at(slot);
        if (object.planStamp == planStamp_) {
            Frame::LatchOf& known = frame_.latches[object.latchIndex];
            known.due = true;
            if (!known.latch.sent) sendRecords(object, driveInput(object, now), known.latch);
            continue;
        }
        components::Latch latch = object.latch;
        const components::DriveInput drive = driveInput(object, now);
        components::resetLatch(object.data, drive, latch);
        latch.sent = object.latch.sent && components::sameDrive(object.data, latch, object.latch);
        if (!latch.sent) sendRecords(object, drive, latch);
        addLatch(object, latch, true);
    }
    const bool fresh = firstEvent < frame_.events.size();
    remote_.spreadKnown &= remoteOn() || !fresh;
    if (remoteOn()) {
        if (fresh || placed) touchNear(now);
        // Nobody knows which of them the fire reaches first.
        if (fresh || placed)
            for (Frame::LatchOf& entry : frame_.latches)
                if (!entry.latch.sent)
                    sendRecords(*entry.object, driveInput(*entry.object, now), entry.latch);
    }
    // While anything burns or is hot, any of them may be next.
    const bool anyActive = remoteOn() && (fresh || !idle_);
    const bool latchNow = now % fire::kWindLatchTicks == 0;
    for (Frame::LatchOf& entry : frame_.latches) {
        Object& object = *entry.object;
        const components::DriveInput drive = driveInput(object, now);
        components::filterLatch(object.data, domainOf(object), drive, entry.latch);
        if (!latchNow || !components::latchDrive(object.data, entry.latch)) continue;
        entry.latch.sent = false;
        turnPlay(object);
        if (needsRecords(object, now) || entry.due || anyActive)
            sendRecords(object, drive, entry.latch);
    }
}

}  // namespace fw::world
