// Hashes: lowbias32 for counter-based random numbers; FNV-1a over words for state hashes and over
// bytes for files.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace fw::core {

inline uint32_t hash32(uint32_t x) noexcept {  // "lowbias32", a public-domain integer hash
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

constexpr uint64_t kFnvOffset = 1469598103934665603ull;
constexpr uint64_t kFnvPrime = 1099511628211ull;

inline uint64_t hashWords(std::span<const uint32_t> words, uint64_t hash = kFnvOffset) noexcept {
    for (uint32_t word : words) {
        hash ^= word;
        hash *= kFnvPrime;
    }
    return hash;
}

inline uint64_t hashBytes(std::span<const std::byte> bytes, uint64_t hash = kFnvOffset) noexcept {
    for (const std::byte b : bytes) hash = (hash ^ uint64_t(b)) * kFnvPrime;
    return hash;
}

}  // namespace fw::core
