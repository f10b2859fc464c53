#include "import/image_decode.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <string_view>

#include "import/picture_header.h"

namespace fwimport {
namespace {

// Returns the file name that selects OpenImageIO's reader; null: unsupported format.
const char* nameFor(std::span<const uint8_t> bytes) {
    struct Signature {
        size_t at;
        std::string_view bytes;
        const char* name;
    };
    using namespace std::string_view_literals;
    static constexpr Signature kSignatures[] = {{0, "\x89PNG\r\n\x1a\n"sv, "memory.png"},
                                                {0, "\xff\xd8\xff"sv, "memory.jpg"},
                                                {0, "\x76\x2f\x31\x01"sv, "memory.exr"},
                                                {0, "II*\0"sv, "memory.tif"},
                                                {0, "MM\0*"sv, "memory.tif"},
                                                {0, "#?R"sv, "memory.hdr"},
                                                {0, "DDS "sv, "memory.dds"},
                                                {8, "WEBP"sv, "memory.webp"}};
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (const Signature& one : kSignatures)
        if (text.size() > one.at && text.substr(one.at).starts_with(one.bytes)) return one.name;
    return nullptr;
}

// Encodes linear light as sRGB bytes, four to a pixel.
void encodeSrgb(std::span<const float> linear, size_t channels, std::span<uint8_t> rgba) {
    for (size_t i = 0; i < linear.size(); ++i) {
        const float value = linear[i] > 0 ? std::min(linear[i], 1.0f) : 0.0f;  // NaN becomes 0
        const bool alpha = channels % 2 == 0 && i % channels == channels - 1;
        const double shown = alpha ? double(value) : toSrgb(double(value));
        rgba[i / channels * 4 + i % channels] = static_cast<uint8_t>(std::lround(255 * shown));
    }
}

// Converts to straight alpha; `stride`: values per pixel, `most`: value of full scale.
template <typename T>
void divideByAlpha(std::span<T> values, size_t channels, size_t stride, float most) {
    for (size_t i = 0; i + stride <= values.size(); i += stride) {
        const auto alpha = static_cast<float>(values[i + channels - 1]) / most;
        for (size_t c = 0; c + 1 < channels && alpha > 0; ++c)
            values[i + c] =
                static_cast<T>(std::min(static_cast<float>(values[i + c]) / alpha, most));
    }
}

}  // namespace

double toLinear(double stored) {
    return stored <= 0.04045 ? stored / 12.92 : std::pow((stored + 0.055) / 1.055, 2.4);
}

double toSrgb(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

bool decodeImage(std::span<const uint8_t> bytes, DecodedImage& image, std::string& error,
                 uint64_t mostMemory) {
    const char* name = nameFor(bytes);
    if (!name) {
        using namespace std::string_view_literals;
        const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        const bool ktx = text.starts_with("\xabKTX"sv);
        error = ktx             ? "it is KTX; convert it to PNG or JPEG"
                : bytes.empty() ? "it is empty"
                                : "it is none of PNG, JPEG, EXR, TIFF, HDR, DDS and WebP";
        return false;
    }
    const PictureLimit limit{kMaxImageSide, std::min(mostUnpacked(bytes.size()), mostMemory)};
    if (!checkHeader(bytes, limit, error)) return false;
    try {
        OIIO::Filesystem::IOMemReader memory(const_cast<uint8_t*>(bytes.data()), bytes.size());
        // Disables premultiplication, which is the default. The DDS reader never multiplies, and
        // cannot combine a configuration with memory input.
        OIIO::ImageSpec config;
        config.attribute("oiio:UnassociatedAlpha", 1);
        // With a configuration, the memory proxy must be part of it.
        OIIO::Filesystem::IOProxy* proxy = &memory;
        config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, static_cast<void*>(&proxy));
        const bool isDds = std::string_view(name).ends_with(".dds");
        auto input = OIIO::ImageInput::open(name, isDds ? nullptr : &config, &memory);
        if (!input) {
            error = "it cannot be decoded: " + OIIO::geterror();
            return false;
        }
        const OIIO::ImageSpec spec = input->spec();
        const int channels = spec.nchannels;
        if (channels < 1 || channels > 4) {
            error = "it has " + std::to_string(channels) + " channels; 1 to 4 are read";
            return false;
        }
        const auto stride = static_cast<size_t>(channels);
        const bool light = spec.format.basetype == OIIO::TypeDesc::FLOAT ||
                           spec.format.basetype == OIIO::TypeDesc::HALF;
        const uint64_t bytesPerPixel = kPixelBytes + (light ? sizeof(float) * stride : 0);
        if (!fits(spec.width, spec.height, bytesPerPixel, limit, error)) return false;
        const size_t pixels = static_cast<size_t>(spec.width) * static_cast<size_t>(spec.height);
        DecodedImage result;
        result.width = static_cast<uint32_t>(spec.width);
        result.height = static_cast<uint32_t>(spec.height);
        result.rgba.assign(pixels * 4, 255);
        std::vector<float> linear(light ? pixels * stride : 0);
        const bool read =
            light ? input->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, linear.data())
                  : input->read_image(0, 0, 0, channels, OIIO::TypeDesc::UINT8, result.rgba.data(),
                                      4);
        if (!read) {
            error = "it cannot be decoded: " + input->geterror();
            return false;
        }
        // EXR stores premultiplied colours, TIFF may do so.
        const std::string_view kind = input->format_name();
        const bool multiplied =
            channels % 2 == 0 &&
            (kind == "openexr" ||
             (kind == "tiff" && spec.get_int_attribute("oiio:UnassociatedAlpha") == 0));
        if (multiplied && light) divideByAlpha<float>(linear, stride, stride, 1.0f);
        if (multiplied && !light) divideByAlpha<uint8_t>(result.rgba, stride, 4, 255.0f);
        if (light) encodeSrgb(linear, stride, result.rgba);
        for (size_t i = 0; i < pixels && channels <= 2; ++i) {
            uint8_t* pixel = &result.rgba[i * 4];
            if (channels == 2) pixel[3] = pixel[1];
            pixel[1] = pixel[2] = pixel[0];
        }
        image = std::move(result);
        return true;
    } catch (const std::exception& failure) {
        error = std::string("it cannot be decoded: ") + failure.what();
        return false;
    }
}

}  // namespace fwimport
