// See image_decode.h.
#include "import/image_decode.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cstring>
#include <exception>

namespace fwimport {
namespace {

// The file name OpenImageIO should believe in; null for what is not a picture we take.
const char* nameFor(std::span<const uint8_t> bytes) {
    auto begins = [&](const char* signature, size_t size) {
        return bytes.size() > size && std::memcmp(bytes.data(), signature, size) == 0;
    };
    if (begins("\x89PNG\r\n\x1a\n", 8)) return "memory.png";
    if (begins("\xff\xd8\xff", 3)) return "memory.jpg";
    return nullptr;
}

}  // namespace

bool decodeImage(std::span<const uint8_t> bytes, DecodedImage& image, std::string& error) {
    const char* name = nameFor(bytes);
    if (!name) {
        error = "it is neither PNG nor JPEG";
        return false;
    }
    try {
        OIIO::Filesystem::IOMemReader memory(const_cast<uint8_t*>(bytes.data()), bytes.size());
        auto input = OIIO::ImageInput::open(name, nullptr, &memory);
        if (!input) {
            error = "it cannot be decoded: " + OIIO::geterror();
            return false;
        }
        const OIIO::ImageSpec spec = input->spec();
        const auto limit = static_cast<int>(kMaxImageSide);
        if (spec.width < 1 || spec.height < 1 || spec.width > limit || spec.height > limit) {
            error = "it is " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                    " pixels; the limit is " + std::to_string(limit) + " a side";
            return false;
        }
        const int channels = spec.nchannels;
        if (channels < 1 || channels > 4) {
            error = "it has " + std::to_string(channels) + " channels; 1 to 4 are read";
            return false;
        }
        const size_t pixels = static_cast<size_t>(spec.width) * static_cast<size_t>(spec.height);
        const auto stride = static_cast<size_t>(channels);
        std::vector<uint8_t> raw(pixels * stride);
        if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::UINT8, raw.data())) {
            error = "it cannot be decoded: " + input->geterror();
            return false;
        }
        DecodedImage result;
        result.width = static_cast<uint32_t>(spec.width);
        result.height = static_cast<uint32_t>(spec.height);
        result.rgba.assign(pixels * 4, 255);
        for (size_t i = 0; i < pixels; ++i) {
            const uint8_t* from = &raw[i * stride];
            uint8_t* to = &result.rgba[i * 4];
            const bool grey = channels <= 2;
            to[0] = from[0];
            to[1] = from[grey ? 0 : 1];
            to[2] = from[grey ? 0 : 2];
            if (channels == 2) to[3] = from[1];
            if (channels == 4) to[3] = from[3];
        }
        image = std::move(result);
        return true;
    } catch (const std::exception& failure) {
        error = std::string("it cannot be decoded: ") + failure.what();
        return false;
    }
}

}  // namespace fwimport
