#include "world/context.h"

#include "world/object.h"
#include "world/shift.h"

#include <algorithm>

namespace fw::world {

void OriginShifts::add(const double (&by)[3], uint64_t lastFrame) noexcept {
    moveBy(moved, by);
    if (movedAfter(lastFrame)) {
        moveBy(pending[count - 1].by, by);
        return;
    }
    if (count == pending.size()) {  // rare: the two oldest count together
        for (int i = 0; i < 3; ++i) pending[1].by[i] += pending[0].by[i];
        std::copy(pending.begin() + 1, pending.end(), pending.begin());
        --count;
    }
    FW_ASSERT(count < pending.size(), "%u moves", count);
    Shift& shift = pending[count++];
    shift.frame = lastFrame;
    std::copy_n(by, 3, shift.by);
}

void OriginShifts::forgetBefore(uint64_t readbackFrame) noexcept {
    while (count > 0 && pending[0].frame < readbackFrame) {
        std::copy(pending.begin() + 1, pending.begin() + count, pending.begin());
        --count;
    }
}

void OriginShifts::movePlace(float (&place)[3], uint64_t frame) const noexcept {
    for (uint32_t k = 0; k < count; ++k)
        if (frame <= pending[k].frame) moveBy(place, pending[k].by);
}

void WorldContext::raise(uint32_t type, const Object* object, uint32_t tag, uint64_t frameIndex,
                         const float position[3], float value,
                         FwBurnableMeshId other) const noexcept {
    FwEvent event{};
    event.type = type;
    event.tag = tag;
    event.frameIndex = frameIndex;
    event.value = value;
    event.other = other;
    if (object) {
        event.userData = object->data.userData;
        event.object = object->id;
    } else {
        event.userData = def.userData;
    }
    std::copy_n(position, 3, event.position);
    events.push(event);
}

}  // namespace fw::world
