// Baked burns: the tick at which each texel of a mesh caught, as bytes, and the state of an object
// that plays one. No front runs on such an object: its texels catch at the ticks of the burn, and
// heat, flames, lights and exchange follow as for any other. A disturbance makes it live.
#pragma once
#include "core/assert.h"
#include "shared/burn.h"

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace fw::world {

struct Burn {
    explicit Burn(std::pmr::memory_resource* memory) : ticks(memory), order(memory) {}
    uint64_t mesh = 0;  // hash of its burn domain
    uint64_t hash = 0;  // of all of it
    uint32_t width = 0, height = 0;
    std::pmr::vector<uint32_t> ticks;  // by texel, since the first caught; kNever: it did not
    std::pmr::vector<uint32_t> order;  // texels that did, by tick
};

// `state`: an object's codes. Ticks count from the first ignition.
void writeBurn(std::span<const uint32_t> state, uint64_t mesh, uint32_t width, uint32_t height,
               std::pmr::vector<std::byte>& out);
// Throws FW_ERROR_BAD_DATA unless writeBurn wrote the bytes.
void readBurn(std::span<const std::byte> bytes, Burn& burn);

constexpr uint32_t kPlayRate = 1u << 16;  // of a burn that plays as fast as it burnt

struct Play {
    uint32_t burn1 = 0;  // slot + 1; 0: none
    uint32_t first = 0;  // tick of the burn's first ignition
    uint32_t rate = 0;   // speed in 1 / kPlayRate
    uint32_t began = 0;  // end of the step that began it; 0: that is the next
    uint32_t most = 0;   // texels that may catch in a frame; follows from the rest
    bool ends = false;   // with the next step: its wind or pose turned, or the host asks
    template <class A>
    void serialize(A& a) {
        a(burn1);
        if (burn1 != 0) a(first, rate, began, ends);
    }
    [[nodiscard]] uint64_t tickOf(uint32_t recorded) const noexcept {
        FW_ASSERT(rate > 0, "burn %u", burn1);
        return first + uint64_t(recorded) * kPlayRate / rate;
    }
};

}  // namespace fw::world
