// What goes over a live link: whole messages, each with a head that says what and how much it is.
// Little-endian. Whatever comes is checked before it is believed: a wrong mark, version, kind, size
// or check ends the link, and a body is read within its bounds.
//   head, 16 bytes: mark "FWLK", version u16, kind u16, size of the body u32, check of the body u32
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fwlink {

constexpr uint32_t kMark = 0x4b4c5746;     // "FWLK"
constexpr uint16_t kVersion = 1;           // of heads and bodies; both sides have the same
constexpr uint32_t kHeadSize = 16;         // bytes
constexpr uint32_t kMostBody = 32u << 20;  // bytes; all tiles of a layer of 4096^2 are 16 MiB
using Bytes = std::vector<uint8_t>;

enum class Kind : uint16_t {
    Paint,  // tiles of a layer's picture: editor to sample
    Scene,  // what is open now, and that all before it belongs to it: editor to sample
    Taken,  // a scene is shown: sample to editor
    Count
};
struct Message {
    Kind kind{};
    Bytes body;
};

// A whole message at the end of `out`. The body is at most kMostBody.
void appendMessage(Bytes& out, Kind kind, std::span<const uint8_t> body);

// Cuts what comes, in whatever pieces, into messages.
class MessageReader {
 public:
    void feed(std::span<const uint8_t> bytes);
    // False: none is whole yet, or `error` says why there will never be one again.
    bool next(Message& message, std::string& error);
    // At least one message waits whole, whatever its size: nothing more need be fed.
    [[nodiscard]] bool full() const { return waiting_.size() - at_ >= kHeadSize + kMostBody; }

 private:
    Bytes waiting_;
    size_t at_ = 0;  // of waiting_ that is read
    bool broken_ = false;
};

// ---- bodies, field by field
class BodyWriter {
 public:
    template <typename T>
    void number(T value) {
        for (size_t i = 0; i < sizeof value; ++i)
            body.push_back(static_cast<uint8_t>(uint64_t{value} >> (8 * i)));
    }
    void text(std::string_view value) {
        number(static_cast<uint32_t>(value.size()));
        body.insert(body.end(), value.begin(), value.end());
    }
    void bytes(std::span<const uint8_t> value) {
        body.insert(body.end(), value.begin(), value.end());
    }
    Bytes body;
};

// Beyond the end all reads give zero and `good` falls.
class BodyReader {
 public:
    explicit BodyReader(std::span<const uint8_t> body) : left_(body) {}
    template <typename T>
    T number() {
        const auto from = bytes(sizeof(T));
        uint64_t value = 0;
        for (size_t i = 0; i < from.size(); ++i) value |= uint64_t{from[i]} << (8 * i);
        return static_cast<T>(value);
    }
    std::string text() {
        const auto from = bytes(number<uint32_t>());
        return {from.begin(), from.end()};
    }
    std::span<const uint8_t> bytes(size_t count) {
        good = good && count <= left_.size();
        if (!good) return {};
        const auto taken = left_.first(count);
        left_ = left_.subspan(count);
        return taken;
    }
    // All of it was read, and nothing beyond.
    [[nodiscard]] bool whole() const { return good && left_.empty(); }
    bool good = true;

 private:
    std::span<const uint8_t> left_;
};

}  // namespace fwlink
