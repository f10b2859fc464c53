// Views of RecordOutside: which of what is kept from frame to frame is theirs, and which of them a
// draw shows.
#include "gpu/vk/outside_view.h"

#include "gpu/vk/world_state.h"

#include <algorithm>

namespace fw::gpu::vk {
namespace {

constexpr uint64_t kViewKept = 60;  // frames from when a view was last given

bool contains(std::span<OutsideView* const> views, const OutsideView* one) noexcept {
    return std::find(views.begin(), views.end(), one) != views.end();
}

}  // namespace

// For a view that has none. One that nobody gives any more loses its history with it.
OutsideView& VkBackend::State::validatedView(std::span<OutsideView* const> taken) {
    const auto isStale = [&](const OutsideView& of) {
        return of.frame == 0 || of.frame + kViewKept < open.ringFrame;
    };
    OutsideView* best = nullptr;
    for (const core::Owned<OutsideView>& of : flames.outsideViews) {
        if (!of || contains(taken, of.get())) continue;
        if (!best || (isStale(*of) && !isStale(*best)) ||
            (isStale(*of) == isStale(*best) && of->frame < best->frame))
            best = of.get();
    }
    for (uint32_t number = 1; number < kMaxViews && (!best || !isStale(*best)); ++number) {
        if (flames.outsideViews[number]) continue;
        flames.outsideViews[number] = core::Owned<OutsideView>::make(memory, number);
        return *flames.outsideViews[number];
    }
    const uint32_t number = best->number;
    std::destroy_at(best);
    return *std::construct_at(best, number);
}

void VkBackend::State::openViews(std::span<const FwView> from) {
    std::array<OutsideView*, kMaxViews> taken{};
    // Views that were given before keep what they have; new ones take the rest.
    for (size_t i = 0; i < from.size(); ++i)
        for (const core::Owned<OutsideView>& of : flames.outsideViews)
            if (of && of->frame != 0 && of->view.viewId == from[i].viewId) taken[i] = of.get();
    for (size_t i = 0; i < from.size(); ++i)
        if (!taken[i]) taken[i] = &validatedView(taken);
    for (core::Owned<OutsideView>& of : flames.outsideViews) {
        if (!of) continue;
        of->given = contains(taken, of.get());
        if (of->given || of->number == 0 || of->frame + kViewKept >= open.ringFrame) continue;
        buffers.dropView(of->number, ring.newest());
        sets.drop(of->number, ring.newest());
        of = {};
    }
    open.viewCount = uint32_t(from.size());
    for (size_t i = 0; i < from.size(); ++i) {
        taken[i]->view = from[i];
        taken[i]->frame = open.ringFrame;
        taken[i]->place = uint32_t(i);
        open.views[i] = taken[i];
    }
}

void VkBackend::State::makeViewRoom(uint32_t flameCount, bool marches, uint64_t last) {
    for (OutsideView* const of : seenFrom()) {
        if (of->number > 0) {
            buffers.makeView(of->number, last);
            buffers.fit(poolOf(kPoolFlames, of->number), buffers.capacity(kPoolFlames),
                        detail.memory < 1, last);
            buffers.atLeast(poolOf(kPoolVolumes, of->number), kVolumeWorks * flameCount, last);
        }
        if (marches && flameCount > 0) makeMarchRoom(*of, flameCount, last);
    }
    // A limit on memory also holds while nobody looks.
    if (seenFrom().empty() && marches && flameCount > 0)
        makeMarchRoom(*flames.outsideViews[0], flameCount, last);
}

OutsideView& VkBackend::State::viewFor(const FwView& view) const noexcept {
    OutsideView* best = flames.outsideViews[0].get();
    int most = -int(kMaxViews);
    for (const core::Owned<OutsideView>& of : flames.outsideViews) {
        if (!of || !of->given || !sets.has(of->number)) continue;
        const int alike = (sameView(view, of->view) ? 2 * int(kMaxViews) : 0) +
                          (view.viewId == of->view.viewId ? int(kMaxViews) : 0) - int(of->place);
        if (alike <= most) continue;
        most = alike;
        best = of.get();
    }
    return *best;
}

}  // namespace fw::gpu::vk
