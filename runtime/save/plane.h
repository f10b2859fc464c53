// Lossless compression of a plane of whole numbers that vary smoothly where they vary, and are
// constant over wide parts: arrival ticks, temperatures, char. A predictor of three neighbours and
// an adaptive Rice code of what it misses by; run lengths where all is flat (after LOCO-I,
// Weinberger et al. 2000, without its bias terms).
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace fw::save {

class BitWriter {
 public:
    explicit BitWriter(std::pmr::vector<std::byte>& out) : out_(out) {}
    void put(uint32_t bits, uint32_t count) {  // count: [0, 32]
        held_ |= uint64_t(bits) << filled_;
        filled_ += count;
        while (filled_ >= 8) {
            out_.push_back(std::byte(held_));
            held_ >>= 8;
            filled_ -= 8;
        }
    }
    void finish() {
        if (filled_ > 0) out_.push_back(std::byte(held_));
        held_ = 0;
        filled_ = 0;
    }

 private:
    std::pmr::vector<std::byte>& out_;
    uint64_t held_ = 0;
    uint32_t filled_ = 0;
};

class BitReader {
 public:
    explicit BitReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
    // Past the end come zeros; ended() tells.
    uint32_t get(uint32_t count) {
        while (filled_ < count) {
            held_ |= uint64_t(at_ < bytes_.size() ? bytes_[at_] : std::byte(0)) << filled_;
            ++at_;
            filled_ += 8;
        }
        const auto bits = uint32_t(held_ & ((uint64_t(1) << count) - 1));
        held_ >>= count;
        filled_ -= count;
        return bits;
    }
    [[nodiscard]] bool ended() const noexcept { return at_ > bytes_.size(); }
    [[nodiscard]] bool all() const noexcept { return at_ == bytes_.size(); }

 private:
    std::span<const std::byte> bytes_;
    size_t at_ = 0;
    uint64_t held_ = 0;
    uint32_t filled_ = 0;
};

// Which cells have a value: the others are neither written nor read, and predict nothing. All of
// them where it is empty; else one byte per cell, 0: none.
using PlaneMask = std::span<const uint8_t>;

// Appends to `out`, whole bytes. Rows of `width`.
void writePlane(std::span<const uint32_t> values, uint32_t width, PlaneMask mask,
                std::pmr::vector<std::byte>& out);
// From the whole of `bytes`; cells outside of the mask stay. False: it is none of writePlane's.
[[nodiscard]] bool readPlane(std::span<const std::byte> bytes, uint32_t width, PlaneMask mask,
                             std::span<uint32_t> values);

}  // namespace fw::save
