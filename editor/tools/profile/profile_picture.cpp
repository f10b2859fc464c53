#include "profile_picture.h"

#include "core/error.h"

#include <glm/gtc/packing.hpp>
#include <sstream>

namespace fwtools {

using fwimport::FloatPicture;
using namespace fw;

bool profileOfPicture(const FloatPicture& picture, volume::Profile& profile, std::string& error) {
    int channels[2] = {picture.channel("temperature"), picture.channel("soot")};
    if (channels[0] < 0 || channels[1] < 0) {
        channels[0] = picture.channel("R");
        channels[1] = picture.channel("G");
    }
    if (channels[0] < 0 || channels[1] < 0) {
        std::ostringstream text;
        text << "its channels are";
        for (const std::string& name : picture.names) text << " \"" << name << '"';
        text << "; it needs R and G, or temperature and soot";
        error = text.str();
        return false;
    }
    constexpr float kMost[2] = {volume::kMaxProfileKelvin, volume::kMaxProfileSoot};
    constexpr const char* kUnit[2] = {" K", ""};
    std::vector<float> planes[2];
    for (int plane = 0; plane < 2; ++plane) {
        const float scale = picture.whole ? kMost[plane] : 1.0f;
        for (uint32_t row = 0; row < picture.height; ++row)
            for (uint32_t x = 0; x < picture.width; ++x) {
                const uint32_t y = picture.height - 1 - row;  // the base row first
                const float value = scale * picture.at(x, y, uint32_t(channels[plane]));
                if (!(value >= 0 && value <= kMost[plane])) {
                    std::ostringstream text;
                    text << "channel \"" << picture.names[size_t(channels[plane])]
                         << "\" of pixel (" << x << ", " << y << ") is " << value << kUnit[plane]
                         << "; it must lie in [0, " << kMost[plane] << "]";
                    error = text.str();
                    return false;
                }
                planes[plane].push_back(value);
            }
    }
    try {
        volume::paintProfile(planes[0], planes[1], picture.width, picture.height, profile);
        return true;
    } catch (const core::Error& failure) {
        error = failure.message;
        return false;
    }
}

FloatPicture pictureOfProfile(const volume::Profile& profile, bool whole) {
    FloatPicture picture;
    picture.width = gpu::kProfileWidth;
    picture.height = gpu::kProfileHeight;
    picture.channels = 3;
    picture.whole = whole;
    picture.names = {"R", "G", "B"};
    for (uint32_t y = picture.height; y-- > 0;)
        for (uint32_t x = 0; x < picture.width; ++x) {
            const gpu::vec2 texel = glm::unpackHalf2x16(profile.texels[y * gpu::kProfileWidth + x]);
            const float kelvin = 1000.0f * texel.x;
            picture.values.push_back(whole ? kelvin / volume::kMaxProfileKelvin : kelvin);
            picture.values.push_back(whole ? texel.y / volume::kMaxProfileSoot : texel.y);
            picture.values.push_back(0.0f);
        }
    return picture;
}

}  // namespace fwtools
