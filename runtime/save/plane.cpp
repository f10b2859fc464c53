#include "save/plane.h"

#include "core/assert.h"

#include <algorithm>
#include <array>
#include <bit>
#include <type_traits>

namespace fw::save {
namespace {

constexpr uint32_t kContexts = 18;  // by how much the neighbours differ, in powers of two

// The prediction of a cell from its left, upper and upper left neighbours, from those of them that
// there are, or else from the value before.
struct Seen {
    uint32_t guess = 0;
    uint32_t context = 0;
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

// ---- the range coder: bits by what was seen before them
// ------------------------------------------

constexpr uint32_t kChanceBits = 15, kLearn = 5;
constexpr uint32_t kTop = 1u << 24;  // below it a byte is due
using Chance = uint16_t;             // of a zero, of 1 << kChanceBits
constexpr Chance kEven = 1u << (kChanceBits - 1);

void learn(Chance& chance, uint32_t bit) noexcept {
    if (bit == 0)
        chance = Chance(chance + (((1u << kChanceBits) - chance) >> kLearn));
    else
        chance = Chance(chance - (chance >> kLearn));
}

class Encoder {
 public:
    explicit Encoder(std::pmr::vector<std::byte>& out) : out_(out) {}
    uint32_t bit(Chance& chance, uint32_t value) {
        FW_ASSERT(range_ >= kTop && value <= 1, "range %u", range_);
        const uint32_t bound = (range_ >> kChanceBits) * chance;
        if (value == 0) {
            range_ = bound;
        } else {
            low_ += bound;
            range_ -= bound;
        }
        learn(chance, value);
        while (range_ < kTop) shift();
        return value;
    }
    uint32_t even(uint32_t value) {
        range_ >>= 1;
        if (value != 0) low_ += range_;
        while (range_ < kTop) shift();
        return value;
    }
    void finish() {
        for (int i = 0; i < 5; ++i) shift();
    }

 private:
    void shift() {
        // A byte that may still take a carry waits, and those of all ones behind it.
        if (low_ < 0xFF000000u || low_ > 0xFFFFFFFFu) {
            const auto carry = uint32_t(low_ >> 32);
            for (uint64_t i = 0; i < waiting_; ++i)
                out_.push_back(std::byte((i == 0 ? first_ : 0xFFu) + carry));
            waiting_ = 0;
            first_ = uint32_t(low_ >> 24) & 0xFFu;
        }
        ++waiting_;
        low_ = (low_ & 0x00FFFFFFu) << 8;
        range_ <<= 8;
    }

    std::pmr::vector<std::byte>& out_;
    uint64_t low_ = 0, waiting_ = 1;
    uint32_t range_ = 0xFFFFFFFFu, first_ = 0;
};

class Decoder {
 public:
    explicit Decoder(std::span<const std::byte> bytes) : bytes_(bytes) {
        for (int i = 0; i < 5; ++i) code_ = (code_ << 8) | next();
    }
    uint32_t bit(Chance& chance, uint32_t = 0) {
        const uint32_t bound = (range_ >> kChanceBits) * chance;
        const uint32_t value = code_ < bound ? 0 : 1;
        if (value == 0) {
            range_ = bound;
        } else {
            code_ -= bound;
            range_ -= bound;
        }
        learn(chance, value);
        shift();
        return value;
    }
    uint32_t even(uint32_t = 0) {
        range_ >>= 1;
        const uint32_t value = code_ < range_ ? 0 : 1;
        if (value != 0) code_ -= range_;
        shift();
        return value;
    }
    [[nodiscard]] bool all() const noexcept { return at_ == bytes_.size(); }
    [[nodiscard]] bool ended() const noexcept { return at_ > bytes_.size(); }

 private:
    uint32_t next() noexcept {  // past the end come zeros
        const uint32_t byte = at_ < bytes_.size() ? uint32_t(bytes_[at_]) : 0;
        ++at_;
        return byte;
    }
    void shift() noexcept {
        while (range_ < kTop) {
            code_ = (code_ << 8) | next();
            range_ <<= 8;
        }
    }

    std::span<const std::byte> bytes_;
    size_t at_ = 0;
    uint32_t range_ = 0xFFFFFFFFu, code_ = 0;
};

// What was missed by, in a context: whether anything, how many bits it has, its two highest.
struct Models {
    std::array<Chance, 2> zero;
    std::array<Chance, 64> size;                  // a tree
    std::array<std::array<Chance, 4>, 33> upper;  // by size, a tree
    Models() {
        zero.fill(kEven);
        size.fill(kEven);
        for (auto& tree : upper) tree.fill(kEven);
    }
};

// Both ways: a coder's bit() gives back what it was given, or what there is. `before`: the value
// before was missed.
template <class Coder>
uint32_t code(Coder& coder, Models& models, uint32_t before, uint32_t missed) {
    if (coder.bit(models.zero[before], missed != 0 ? 1 : 0) == 0) return 0;
    const auto wanted = uint32_t(std::bit_width(missed));  // [1, 32]
    uint32_t node = 1;
    for (int i = 5; i >= 0; --i) node = node * 2 + coder.bit(models.size[node], (wanted >> i) & 1);
    const uint32_t size = std::clamp<uint32_t>(node & 63, 1, 32);
    uint32_t value = 1;
    node = 1;
    for (uint32_t i = 1; i < size; ++i) {
        const uint32_t wish = (missed >> (size - 1 - i)) & 1;
        uint32_t bit = 0;
        if (i <= 2) {
            bit = coder.bit(models.upper[size][node], wish);
            node = node * 2 + bit;
        } else {
            bit = coder.even(wish);
        }
        value = value * 2 + bit;
    }
    return value;
}

uint32_t folded(uint32_t difference) noexcept {  // signs to odd and even
    return (difference << 1) ^ (0u - (difference >> 31));
}
uint32_t unfolded(uint32_t value) noexcept { return (value >> 1) ^ (0u - (value & 1)); }

// Both ways, like code(). True: some cell has a value.
template <class Coder, class Value>
bool codeCells(Coder& coder, std::span<Value> values, uint32_t width, PlaneMask mask) {
    FW_ASSERT(width > 0 && (mask.empty() || mask.size() == values.size()),
              "%zu cells in rows of %u", values.size(), width);
    constexpr bool kWrites = std::is_const_v<Value>;
    const Neighbours around(values, width, mask);
    std::array<Models, kContexts> models;
    uint32_t last = 0, before = 0, x = 0;
    bool any = false;
    for (size_t cell = 0; cell < values.size(); ++cell, x = x + 1 == width ? 0 : x + 1) {
        if (!around.has(cell)) continue;
        any = true;
        const Seen seen = around.at(cell, x, last);
        const uint32_t wanted = kWrites ? folded(values[cell] - seen.guess) : 0;
        const uint32_t missed = code(coder, models[seen.context], before, wanted);
        last = seen.guess + unfolded(missed);
        before = missed != 0 ? 1 : 0;
        if constexpr (!kWrites) {
            values[cell] = last;
            if (coder.ended()) break;
        }
    }
    return any;
}

}  // namespace

void writePlane(std::span<const uint32_t> values, uint32_t width, PlaneMask mask,
                std::pmr::vector<std::byte>& out) {
    Encoder coder(out);
    if (codeCells(coder, values, width, mask)) coder.finish();
}

bool readPlane(std::span<const std::byte> bytes, uint32_t width, PlaneMask mask,
               std::span<uint32_t> values) {
    Decoder coder(bytes);
    return codeCells(coder, values, width, mask) ? coder.all() : bytes.empty();
}

}  // namespace fw::save
