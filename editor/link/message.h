// Messages of a live link. Each has a header with type and size. Little-endian. All input is
// validated: a wrong magic, version, kind, size or checksum ends the link, and bodies are read with
// bounds checks.
//   header, 16 bytes: magic "FWLK", version u16, kind u16, body size u32, body checksum u32
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fwlink {

constexpr uint32_t kMark = 0x4b4c5746;     // "FWLK"
constexpr uint16_t kVersion = 1;           // of headers and bodies; both sides must match
constexpr uint32_t kHeadSize = 16;         // bytes
constexpr uint32_t kMostBody = 32u << 20;  // bytes; all tiles of a layer of 4096^2 are 16 MiB
using Bytes = std::vector<uint8_t>;

enum class Kind : uint16_t {
    Paint,  // tiles of a layer image: editor to sample
    Scene,  // the open scene, which uses all earlier messages: editor to sample
    Taken,  // a scene is visible: sample to editor
    Count
};
struct Message {
    Kind kind{};
    Bytes body;
};

// Appends a complete message to `out`. The body has at most kMostBody bytes.
void appendMessage(Bytes& out, Kind kind, std::span<const uint8_t> body);

// Splits a byte stream into messages.
class MessageReader {
 public:
    void feed(std::span<const uint8_t> bytes);
    // Returns false if no message is complete. A non-empty `error` is permanent.
    bool next(Message& message, std::string& error);
    // At least one message of any size is complete, so no more input is necessary.
    [[nodiscard]] bool full() const { return waiting_.size() - at_ >= kHeadSize + kMostBody; }

 private:
    Bytes waiting_;
    size_t at_ = 0;  // read part of waiting_
    bool broken_ = false;
};

// ---- message bodies, field by field
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

// Reads beyond the end return zero and clear `good`.
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
    // The body was read exactly to its end.
    [[nodiscard]] bool whole() const { return good && left_.empty(); }
    bool good = true;

 private:
    std::span<const uint8_t> left_;
};

}  // namespace fwlink
