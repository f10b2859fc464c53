#include "save/plane.h"

#include "save/stream.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace fw::save {
namespace {

constexpr uint32_t kContexts = 18;     // by how much the neighbours differ, in powers of two
constexpr uint32_t kUnaryMost = 24;    // then the value follows as it is
constexpr uint32_t kForgetAfter = 64;  // values, in a context

// What a cell's neighbours tell of it. Without left, upper and upper left: what of them there is,
// and at last the value before.
struct Seen {
    uint32_t guess = 0;
    uint32_t context = 0;
    bool flat = false;  // they are all alike
};

class Neighbours {
 public:
    Neighbours(std::span<const uint32_t> values, uint32_t width, PlaneMask mask)
        : values_(values), mask_(mask), width_(width) {}

    [[nodiscard]] bool has(size_t cell) const noexcept { return mask_.empty() || mask_[cell] != 0; }

    [[nodiscard]] Seen at(size_t cell, uint32_t x, uint32_t last) const noexcept {
        const bool left = x > 0 && has(cell - 1);
        const bool up = cell >= width_ && has(cell - width_);
        const bool corner = x > 0 && cell >= width_ && has(cell - width_ - 1);
        Seen seen;
        if (!left && !up) {
            seen.guess = last;
            seen.context = kContexts - 1;
            return seen;
        }
        const uint32_t a = left ? values_[cell - 1] : values_[cell - width_];
        const uint32_t b = up ? values_[cell - width_] : a;
        const uint32_t c = corner ? values_[cell - width_ - 1] : (left && up ? std::min(a, b) : a);
        seen.flat = a == b && b == c;
        const bool right = up && x + 1 < width_ && has(cell - width_ + 1);
        const uint32_t d = right ? values_[cell - width_ + 1] : b;
        // The plane through the three, kept within what lies around it by the slope beyond.
        const int64_t plane = int64_t(a) + int64_t(b) - int64_t(c);
        const int64_t low = std::min(a, b), high = std::max(a, b);
        int64_t guess = plane;
        if (!corner) guess = (int64_t(a) + int64_t(b)) / 2;
        const int64_t slack =
            high - low + std::max<int64_t>(int64_t(d) - int64_t(b), int64_t(b) - int64_t(d));
        guess = std::clamp(guess, low - slack, high + slack);
        seen.guess = uint32_t(std::clamp<int64_t>(guess, 0, 0xFFFFFFFF));
        const auto apart = [](uint32_t p, uint32_t q) { return p > q ? p - q : q - p; };
        const uint64_t spread = uint64_t(apart(a, c)) + apart(c, b) + apart(b, d);
        seen.context = std::min<uint32_t>(uint32_t(std::bit_width(spread)), kContexts - 2);
        return seen;
    }

 private:
    std::span<const uint32_t> values_;
    PlaneMask mask_;
    uint32_t width_;
};

struct Context {
    uint64_t sum = 16;  // of what was missed
    uint32_t count = 1;
    [[nodiscard]] uint32_t rice() const noexcept {
        uint32_t k = 0;
        while (k < 24 && (uint64_t(count) << k) * 16 < sum * 11) ++k;  // ln 2 of the mean
        return k;
    }
    void learn(uint32_t missed) noexcept {
        sum += missed;
        if (++count < kForgetAfter) return;
        sum >>= 1;
        count >>= 1;
    }
};

uint32_t folded(uint32_t difference) noexcept {  // signs to odd and even
    return (difference << 1) ^ (0u - (difference >> 31));
}
uint32_t unfolded(uint32_t value) noexcept { return (value >> 1) ^ (0u - (value & 1)); }

// Lengths of runs adapt to those before: as many bits as the last ones had.
struct RunLengths {
    uint32_t bits = 4;
    void learn(uint32_t length) noexcept {
        const auto had = uint32_t(std::bit_width(length));
        bits = std::clamp<uint32_t>((bits * 3 + had + 2) / 4, 0, 20);
    }
};

void putRice(BitWriter& out, uint32_t value, uint32_t k) {
    const uint32_t high = value >> k;
    if (high >= kUnaryMost) {
        out.put((1u << kUnaryMost) - 1, kUnaryMost);
        out.put(value, 32);
        return;
    }
    out.put((1u << high) - 1, high + 1);  // ones, then a zero
    out.put(k > 0 ? value & ((1u << k) - 1) : 0, k);
}

uint32_t getRice(BitReader& in, uint32_t k) {
    uint32_t high = 0;
    while (high < kUnaryMost && in.get(1) != 0) ++high;
    if (high == kUnaryMost) return in.get(32);
    return (high << k) | in.get(k);
}

}  // namespace

uint64_t checksum(std::span<const std::byte> bytes) noexcept {
    uint64_t hash = 1469598103934665603ull;
    size_t at = 0;
    for (; at + 8 <= bytes.size(); at += 8) {
        uint64_t word = 0;
        for (size_t k = 0; k < 8; ++k) word |= uint64_t(bytes[at + k]) << (8 * k);
        hash = (hash ^ word) * 1099511628211ull;
        hash ^= hash >> 29;
    }
    for (; at < bytes.size(); ++at) hash = (hash ^ uint64_t(bytes[at])) * 1099511628211ull;
    return hash;
}

void writePlane(std::span<const uint32_t> values, uint32_t width, PlaneMask mask,
                std::pmr::vector<std::byte>& out) {
    BitWriter bits(out);
    const Neighbours around(values, width, mask);
    std::array<Context, kContexts> contexts{};
    RunLengths lengths;
    uint32_t last = 0, run = 0, x = 0;
    bool running = false;
    const auto endRun = [&] {
        putRice(bits, run, lengths.bits);
        lengths.learn(run);
        running = false;
        run = 0;
    };
    for (size_t cell = 0; cell < values.size(); ++cell, x = x + 1 == width ? 0 : x + 1) {
        if (!around.has(cell)) continue;
        const uint32_t value = values[cell];
        const Seen seen = around.at(cell, x, last);
        last = value;
        const bool flat = seen.flat || running;
        if (flat && value == seen.guess) {
            running = true;
            ++run;
            continue;
        }
        const bool told = flat;  // that it is not what was guessed
        if (flat) endRun();
        Context& context = contexts[seen.context];
        const uint32_t missed = folded(value - seen.guess);
        const uint32_t coded = told ? missed - 1 : missed;
        putRice(bits, coded, context.rice());
        context.learn(coded);
    }
    if (running) endRun();
    bits.finish();
}

bool readPlane(std::span<const std::byte> bytes, uint32_t width, PlaneMask mask,
               std::span<uint32_t> values) {
    BitReader bits(bytes);
    const Neighbours around(values, width, mask);
    std::array<Context, kContexts> contexts{};
    RunLengths lengths;
    uint32_t last = 0, run = 0, x = 0;
    bool running = false;
    for (size_t cell = 0; cell < values.size(); ++cell, x = x + 1 == width ? 0 : x + 1) {
        if (!around.has(cell)) continue;
        const Seen seen = around.at(cell, x, last);
        if ((seen.flat || running) && !running) {
            running = true;
            run = getRice(bits, lengths.bits);
            lengths.learn(run);
        }
        if (running && run > 0) {
            --run;
            last = values[cell] = seen.guess;
            continue;
        }
        const bool told = running;
        running = false;
        Context& context = contexts[seen.context];
        const uint32_t coded = getRice(bits, context.rice());
        context.learn(coded);
        last = values[cell] = seen.guess + unfolded(told ? coded + 1 : coded);
        if (bits.ended()) return false;
    }
    return bits.all();
}

}  // namespace fw::save
