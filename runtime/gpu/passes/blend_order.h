// The one place that decides who sorts things that blend, farthest first: the host or the device.
#pragma once
#include "shared/appearance.h"

#include <algorithm>
#include <cstdint>
#include <span>

namespace fw::gpu {

// None: emission alone is added, and sums need no order. (Among things that occlude, it keeps its
// place: the device puts its quads there without sorting them.)
//
// Host: things that the host places, so that it knows their depth: fields, volumetric flames,
// regions of haze. There are some hundreds at most, and a sort takes microseconds. A sort on a
// device would cost an upload of their numbers and a pass of one group that the draw waits for.
//
// Device: quads of particles and of burning tiles. The device made them in this frame, and the host
// does not know where they are. A host sort would have to wait for a readback. A software device
// would sort them on the same cores as the host.
enum class Orderer : uint32_t { None, Host, Device };

enum class PlacedBy : uint32_t { Host, Device };

// `hiding`: the number of things that occlude others behind them, in one draw or in several that
// overlap.
[[nodiscard]] constexpr Orderer ordererOf(PlacedBy by, uint32_t hiding) noexcept {
    if (hiding == 0) return Orderer::None;
    return by == PlacedBy::Host ? Orderer::Host : Orderer::Device;
}

// Up to this number of quads a device sorts by comparing them in shared memory; beyond, digit by
// digit in a buffer (SortPush::few; only the device knows how many there are). On a software device
// both lie in the same caches, and from 1,024 on fewer steps win, as measured. Other devices
// compare as many as shared memory holds.
[[nodiscard]] constexpr uint32_t fewQuads(bool software) noexcept {
    return software ? 1024 : kMaxFewQuads;
}

// Sorts things that the host places and that occlude, farthest first, if that is the host's task.
// `depth`: of one, any unit. `number`: among things as far, the smaller one comes first in every
// frame.
template <class Item, class Depth, class Number>
void orderOnHost(std::span<Item> items, Depth depth, Number number) noexcept {
    if (ordererOf(PlacedBy::Host, uint32_t(items.size())) != Orderer::Host) return;
    std::sort(items.begin(), items.end(), [&](const Item& a, const Item& b) {
        return depth(a) != depth(b) ? depth(a) > depth(b) : number(a) < number(b);
    });
}

}  // namespace fw::gpu
