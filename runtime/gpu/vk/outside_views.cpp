#include "gpu/vk/backend_state.h"

#include <algorithm>
#include <cstring>

namespace fw::gpu::vk {
namespace {

constexpr uint64_t kViewKept = 60;  // frames from when a view was last given

bool contains(std::span<OutsideView* const> views, const OutsideView* one) noexcept {
    return std::find(views.begin(), views.end(), one) != views.end();
}

}  // namespace

// For a view that has none. One that nobody gives any more loses its history with it.
OutsideView& OutsideViews::freeView(std::span<OutsideView* const> taken, uint64_t ringFrame) {
    const auto isStale = [&](const OutsideView& of) {
        return of.frame == 0 || of.frame + kViewKept < ringFrame;
    };
    OutsideView* best = nullptr;
    for (const core::Owned<OutsideView>& of : all) {
        if (!of || contains(taken, of.get())) continue;
        if (!best || (isStale(*of) && !isStale(*best)) ||
            (isStale(*of) == isStale(*best) && of->frame < best->frame))
            best = of.get();
    }
    for (uint32_t number = 1; number < kMaxViews && (!best || !isStale(*best)); ++number) {
        if (all[number]) continue;
        all[number] = core::Owned<OutsideView>::make(memory_, number);
        return *all[number];
    }
    FW_ASSERT(best, "%zu views are taken", taken.size());
    const uint32_t number = best->number;
    std::destroy_at(best);
    return *std::construct_at(best, number);
}

void OutsideViews::open(BackendState& s, std::span<const FwView> from) {
    FW_ASSERT(from.size() <= kMaxViews, "%zu views", from.size());
    std::array<OutsideView*, kMaxViews> taken{};
    // Views that were given before keep what they have; new ones take the rest.
    for (size_t i = 0; i < from.size(); ++i)
        for (const core::Owned<OutsideView>& of : all)
            if (of && of->frame != 0 && of->view.viewId == from[i].viewId) taken[i] = of.get();
    const uint64_t ringFrame = s.open.ringFrame;
    for (size_t i = 0; i < from.size(); ++i)
        if (!taken[i]) taken[i] = &freeView(taken, ringFrame);
    for (core::Owned<OutsideView>& of : all) {
        if (!of) continue;
        of->given = contains(taken, of.get());
        if (of->given || of->number == 0 || of->frame + kViewKept >= ringFrame) continue;
        s.buffers.dropView(of->number, s.ring.newest());
        s.sets.drop(of->number, s.ring.newest());
        of = {};
    }
    s.open.viewCount = uint32_t(from.size());
    for (size_t i = 0; i < from.size(); ++i) {
        taken[i]->view = from[i];
        taken[i]->frame = ringFrame;
        taken[i]->place = uint32_t(i);
        s.open.views[i] = taken[i];
    }
}

void OutsideViews::makeRoom(BackendState& s, uint32_t flameCount, bool marches,
                            uint64_t last) const {
    marches = marches && flameCount > 0;
    for (OutsideView* const of : s.seenFrom()) {
        if (of->number > 0) {
            s.buffers.makeView(of->number, last);
            s.buffers.fit(poolOf(kPoolFlames, of->number), s.buffers.capacity(kPoolFlames),
                          s.detail.memory < 1, last);
            s.buffers.atLeast(poolOf(kPoolVolumes, of->number), kVolumeWorks * flameCount, last);
        }
        if (marches) s.flames.makeMarchRoom(s, *of, flameCount, last);
    }
    // A limit on memory also holds without a view.
    if (s.seenFrom().empty() && marches) s.flames.makeMarchRoom(s, *all[0], flameCount, last);
}

OutsideView& OutsideViews::viewFor(const PassSets& sets, const FwView& view) const noexcept {
    OutsideView* best = all[0].get();
    int most = -int(kMaxViews);
    for (const core::Owned<OutsideView>& of : all) {
        if (!of || !of->given || !sets.has(of->number)) continue;
        const int alike = (sameView(view, of->view) ? 2 * int(kMaxViews) : 0) +
                          (view.viewId == of->view.viewId ? int(kMaxViews) : 0) - int(of->place);
        if (alike <= most) continue;
        most = alike;
        best = of.get();
    }
    return *best;
}

bool sameView(const FwView& a, const FwView& b) noexcept {
    const auto same = [](const auto& x, const auto& y) {
        return std::memcmp(&x, &y, sizeof x) == 0;
    };
    return same(a.view, b.view) && same(a.projection, b.projection) &&
           same(a.sunColor, b.sunColor) && same(a.ambientSky, b.ambientSky) &&
           same(a.ambientGround, b.ambientGround) && same(a.exposure, b.exposure) &&
           same(a.emissionScale, b.emissionScale);
}

void OutsideView::recordScreen(const FwView& shown, const VolumeScreen& screen,
                               uint64_t ringFrame) noexcept {
    if (!sameView(shown, view)) return;
    const auto area = [](const VolumeScreen& s) { return s.size.x * s.size.y; };
    if (march.frame == ringFrame && area(screen) <= area(march.screen)) return;
    march.screen = screen;
    march.frame = ringFrame;
}

bool OutsideView::isMarchedFor(const FwView& shown, const VolumeScreen& screen) const noexcept {
    return given && march.there && screen == march.made && sameView(shown, march.view);
}

uint32_t OutsideView::minRays(const FwView& shown, const VolumeScreen& screen) noexcept {
    // A side of a pixel: all four places at which samples begin, or it is grain.
    constexpr uint32_t kUnknownRays = 2;
    if (!sameView(shown, view) || screen == march.unknown) return 1;
    march.unknown = screen;
    return kUnknownRays;
}

}  // namespace fw::gpu::vk
