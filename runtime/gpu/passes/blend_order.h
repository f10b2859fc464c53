// Who brings what blends into order, farthest first: decided here for everything that does, and
// nowhere else.
#pragma once
#include <algorithm>
#include <cstdint>
#include <span>

namespace fw::gpu {

// None: what only emits is added to what is there, and sums do not ask for an order. (Between
// things that hide, it keeps its place: the device lays quads there without sorting them.)
//
// Host: what the host itself places, and so knows the depth of: fields, volumetric flames, what
// haze bends. Some hundreds at most: a sort is microseconds, and on a device its numbers would have
// to be brought there first, for a pass of one group that the draw waits for.
//
// Device: quads of particles and of burning tiles. The device made them in this frame, and no host
// knows where they are: to sort them there one would wait for them to come back, and a software
// device, which has them in the host's memory, would sort them on the same cores that it has
// itself. No device gives a particle to the host.
enum class Orderer : uint32_t { None, Host, Device };

enum class PlacedBy : uint32_t { Host, Device };

// Of `hiding` things that hide something of what is behind them, in one draw or several that
// overlap.
[[nodiscard]] constexpr Orderer ordererOf(PlacedBy by, uint32_t hiding) noexcept {
    if (hiding == 0) return Orderer::None;
    return by == PlacedBy::Host ? Orderer::Host : Orderer::Device;
}

// Up to how many quads a device sorts by comparing them in shared memory; beyond, digit by digit in
// a buffer (SortPush::few; how many there are the device alone knows). For a software device both
// lie in the same caches, and from 1,024 on the fewer steps win, as measured; for others shared
// memory is the nearer one, and they compare as many as it holds.
[[nodiscard]] uint32_t fewQuads(bool software) noexcept;

// Things that the host places and that hide, farthest first where that is the host's to do.
// `depth`: of one, any unit; `number`: of those as far, the lesser comes first, in every frame.
template <class Item, class Depth, class Number>
void orderOnHost(std::span<Item> items, Depth depth, Number number) noexcept {
    if (ordererOf(PlacedBy::Host, uint32_t(items.size())) != Orderer::Host) return;
    std::sort(items.begin(), items.end(), [&](const Item& a, const Item& b) {
        return depth(a) != depth(b) ? depth(a) > depth(b) : number(a) < number(b);
    });
}

}  // namespace fw::gpu
