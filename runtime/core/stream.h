// Bytes of a file in a fixed order, little-endian. The reader trusts nothing: it checks every
// number against the bytes left before use, and its errors name the file.
#pragma once
#include "core/assert.h"
#include "core/error.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory_resource>
#include <span>
#include <type_traits>
#include <vector>

namespace fw::core {

template <typename T>
concept Number = std::is_arithmetic_v<T> && !std::is_same_v<T, bool> && sizeof(T) != 1;

template <typename T>
using WordOf = std::conditional_t<sizeof(T) == 8, uint64_t,
                                  std::conditional_t<sizeof(T) == 4, uint32_t, uint16_t>>;

// The word at a byte of a file; the caller checked the size.
inline uint32_t wordAt(std::span<const std::byte> bytes, size_t at) noexcept {
    FW_ASSERT(at + 4 <= bytes.size(), "byte %zu of %zu", at, bytes.size());
    uint32_t word = 0;
    for (size_t k = 0; k < 4; ++k) word |= uint32_t(bytes[at + k]) << (8 * k);
    return word;
}

// Visits the numbers of fields in order; a field may be an array.
template <class Visit, class... T>
void eachNumber(Visit&& visit, T&... fields) {
    const auto one = [&](auto& field) {
        if constexpr (requires { std::begin(field); })
            for (auto& value : field) visit(value);
        else
            visit(field);
    };
    (one(fields), ...);
}

class Writer {
 public:
    static constexpr bool kReads = false;
    explicit Writer(std::pmr::vector<std::byte>& out) : out_(out) {}
    template <Number T>
    void number(const T& value) {
        const auto word = std::bit_cast<WordOf<T>>(value);
        for (size_t k = 0; k < sizeof(T); ++k) out_.push_back(std::byte(word >> (8 * k)));
    }
    void number(bool value) { out_.push_back(std::byte(value ? 1 : 0)); }
    template <class... T>
    void numbers(const T&... values) {  // each a number, or an array of them
        eachNumber([&](const auto& value) { number(value); }, values...);
    }
    // Overwrites a number: a checksum of later bytes is known only after them.
    template <Number T>
    void numberAt(size_t at, const T& value) noexcept {
        FW_ASSERT(at + sizeof(T) <= out_.size(), "byte %zu of %zu", at, out_.size());
        const auto word = std::bit_cast<WordOf<T>>(value);
        for (size_t k = 0; k < sizeof(T); ++k) out_[at + k] = std::byte(word >> (8 * k));
    }
    [[nodiscard]] std::pmr::vector<std::byte>& bytes() noexcept { return out_; }

 private:
    std::pmr::vector<std::byte>& out_;
};

class Reader {
 public:
    static constexpr bool kReads = true;
    // `what` names the file in messages: "save". It must outlive the reader.
    Reader(std::span<const std::byte> bytes, const char* what) : bytes_(bytes), what_(what) {}
    template <Number T>
    void number(T& value) {
        const std::span<const std::byte> from = take(sizeof(T));
        WordOf<T> word = 0;
        for (size_t k = 0; k < sizeof(T); ++k)
            word = WordOf<T>(word | WordOf<T>(WordOf<T>(from[k]) << (8 * k)));
        value = std::bit_cast<T>(word);
    }
    void number(bool& value) {
        const uint32_t word = uint32_t(take(1)[0]);
        if (word > 1)
            fail(FW_ERROR_BAD_DATA, "Byte %zu of the %s is %u where a 0 or 1 is expected.", at_ - 1,
                 what_, word);
        value = word == 1;
    }
    template <class... T>
    void numbers(T&... values) {
        eachNumber([&](auto& value) { number(value); }, values...);
    }
    // A count of items of at least `bytesEach` bytes each.
    uint32_t count(const char* name, size_t bytesEach) {
        uint32_t value = 0;
        number(value);
        if (uint64_t(value) * bytesEach > left())
            fail(FW_ERROR_BAD_DATA, "The %s says that it has %u %s; %zu bytes are left.", what_,
                 value, name, left());
        return value;
    }
    std::span<const std::byte> take(size_t size) {
        if (left() < size)
            fail(FW_ERROR_BAD_DATA, "The %s ends after %zu bytes of its content.", what_,
                 bytes_.size());
        at_ += size;
        return bytes_.subspan(at_ - size, size);
    }
    [[nodiscard]] size_t left() const noexcept { return bytes_.size() - at_; }
    [[nodiscard]] const char* name() const noexcept { return what_; }

 private:
    std::span<const std::byte> bytes_;
    const char* what_;
    size_t at_ = 0;
};

// Heads of cooked files: u32 magic, u32 version, then what the kind of file has.
inline void checkHead(std::span<const std::byte> bytes, const char* name, size_t headBytes,
                      uint32_t magic, uint32_t version) {
    if (bytes.size() < headBytes)
        failData("the %s has %zu bytes; its header alone has %zu.", name, bytes.size(), headBytes);
    if (wordAt(bytes, 0) != magic)
        failData("the %s begins with 0x%08x; it must begin with 0x%08x.", name, wordAt(bytes, 0),
                 magic);
    if (wordAt(bytes, 4) != version)
        fail(FW_ERROR_VERSION, "the %s has version %u; this library reads version %u.", name,
             wordAt(bytes, 4), version);
}
inline void checkSum(const char* name, uint64_t sum, uint64_t found) {
    if (sum != found)
        failData("the %s's checksum is 0x%016llx; its content has 0x%016llx.", name,
                 static_cast<unsigned long long>(sum), static_cast<unsigned long long>(found));
}

}  // namespace fw::core
