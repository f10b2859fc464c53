#include "import/picture_header.h"

#include <webp/decode.h>

#include <algorithm>
#include <cstring>
#include <string_view>

namespace fwimport {
namespace {

// Reads the attributes of headers, little-endian. Reads beyond the end return zero and clear
// `good`.
struct HeaderReader {
    std::span<const uint8_t> left;
    bool good = true;

    std::string_view text() {
        const auto end = std::find(left.begin(), left.end(), uint8_t{0});
        good = good && end != left.end();
        if (!good) return {};
        const auto size = static_cast<size_t>(end - left.begin());
        const std::string_view value(reinterpret_cast<const char*>(left.data()), size);
        left = left.subspan(size + 1);
        return value;
    }
    int32_t number() {
        uint32_t value = 0;
        good = good && left.size() >= 4;
        if (!good) return 0;
        for (size_t i = 0; i < 4; ++i) value |= uint32_t{left[i]} << (8 * i);
        left = left.subspan(4);
        return static_cast<int32_t>(value);
    }
};

// OpenEXR reads a value of these types by its content, whatever size the attribute has.
struct TypeSize {
    std::string_view type;
    int32_t size;  // bytes
};
constexpr TypeSize kTypes[] = {{"box2f", 16},         {"box2i", 16},    {"chromaticities", 32},
                               {"compression", 1},    {"double", 8},    {"envmap", 1},
                               {"deepImageState", 1}, {"float", 4},     {"int", 4},
                               {"keycode", 28},       {"lineOrder", 1}, {"m33d", 72},
                               {"m33f", 36},          {"m44d", 128},    {"m44f", 64},
                               {"rational", 8},       {"tiledesc", 9},  {"timecode", 8},
                               {"v2d", 16},           {"v2f", 8},       {"v2i", 8},
                               {"v3d", 24},           {"v3f", 12},      {"v3i", 12}};

// The size that a value of a type must have.
int32_t sizeFor(std::string_view type, std::span<const uint8_t> value) {
    HeaderReader reader{value};
    if (type == "chlist") {  // channels of a name and 16 bytes, and an empty name
        while (!reader.text().empty())
            for (int i = 0; i < 4; ++i) (void)reader.number();
        return reader.good ? static_cast<int32_t>(value.size() - reader.left.size()) : -1;
    }
    if (type == "preview") {  // width, height and RGBA
        const auto width = static_cast<uint32_t>(reader.number());
        const auto height = static_cast<uint32_t>(reader.number());
        const uint64_t most = value.size() / 4;
        return width <= most && height <= most && uint64_t{width} * height <= most
                   ? static_cast<int32_t>(8 + 4 * width * height)
                   : -1;
    }
    for (const TypeSize& one : kTypes)
        if (one.type == type) return one.size;
    return static_cast<int32_t>(value.size());
}

bool checkExr(std::span<const uint8_t> bytes, const PictureLimit& limit, std::string& error) {
    constexpr uint8_t kMultipart = 0x10;
    const bool multipart = (bytes[5] & kMultipart) != 0;
    HeaderReader reader{bytes.subspan(8)};
    for (bool first = true;; first = false) {  // headers; an empty one ends those of several parts
        bool empty = true;
        for (std::string_view name = reader.text(); !name.empty(); name = reader.text()) {
            empty = false;
            const std::string_view type = reader.text();
            const int32_t size = reader.number();
            if (size < 0 || static_cast<size_t>(size) > reader.left.size() ||
                sizeFor(type, reader.left.first(static_cast<size_t>(size))) != size) {
                error = "its EXR attribute \"" + std::string(name.substr(0, 40)) + "\" has " +
                        std::to_string(size) + " bytes, of " + std::to_string(reader.left.size()) +
                        " in the file, which is no value of the type \"" +
                        std::string(type.substr(0, 40)) + "\"";
                return false;
            }
            HeaderReader value{reader.left.first(static_cast<size_t>(size))};
            reader.left = reader.left.subspan(static_cast<size_t>(size));
            if (name != "dataWindow") continue;
            const int64_t left = value.number(), top = value.number();
            const int64_t width = value.number() - left + 1, height = value.number() - top + 1;
            // The sides alone: memory depends on the channels, which the reader knows.
            if (!fits(width, height, 0, limit, error)) return false;
        }
        if (!reader.good) {
            error = "its EXR header is cut";
            return false;
        }
        if (!multipart || (empty && !first)) return true;
        if (empty) {
            error = "its EXR header is empty";
            return false;
        }
    }
}

}  // namespace

bool fits(int64_t width, int64_t height, uint64_t bytesPerPixel, const PictureLimit& limit,
          std::string& error) {
    const std::string size = std::to_string(width) + " x " + std::to_string(height) + " pixels";
    if (width < 1 || height < 1 || width > limit.side || height > limit.side) {
        error = "it is " + size + "; each side must lie in [1, " + std::to_string(limit.side) + "]";
        return false;
    }
    const uint64_t memory = uint64_t(width) * uint64_t(height) * bytesPerPixel;
    if (memory <= limit.bytes) return true;
    error = "its " + size + " take " + std::to_string(memory) +
            " bytes of memory; the limit for a file of its size is " + std::to_string(limit.bytes) +
            ". Make it smaller";
    return false;
}

bool checkHeader(std::span<const uint8_t> bytes, const PictureLimit& limit, std::string& error) {
    static constexpr uint8_t kExr[] = {0x76, 0x2f, 0x31, 0x01};
    if (bytes.size() >= 8 && std::memcmp(bytes.data(), kExr, 4) == 0)
        return checkExr(bytes, limit, error);
    // OpenImageIO decodes WebP when it opens it.
    int width = 0, height = 0;
    return !WebPGetInfo(bytes.data(), bytes.size(), &width, &height) ||
           fits(width, height, kPixelBytes, limit, error);
}

}  // namespace fwimport
