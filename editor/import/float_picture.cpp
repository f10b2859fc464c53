#include "import/float_picture.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cctype>
#include <exception>
#include <fstream>
#include <memory>
#include <system_error>

#include "import/image_decode.h"
#include "import/picture_header.h"

namespace fwimport {
namespace {

std::string lowered(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

// The first line only: some libraries report each row of pixels.
std::string reasonOf(const std::string& text) {
    const std::string line = text.substr(0, text.find('\n'));
    return line.empty() ? "it cannot be read" : line;
}

// The whole file if it is EXR, otherwise its first bytes.
std::vector<uint8_t> headOf(const std::filesystem::path& path, uint64_t size) {
    constexpr uint64_t kHead = 64;
    std::ifstream file(path, std::ios::binary);
    std::vector<uint8_t> bytes(std::min(size, kHead));
    file.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
    if (bytes.size() < 2 || bytes[0] != 0x76 || bytes[1] != 0x2f) return bytes;
    bytes.resize(size);
    file.seekg(0);
    file.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size));
    return bytes;
}

bool refused(const std::filesystem::path& path, const std::string& what, std::string& error) {
    error = path.string() + ": " + what;
    return false;
}

}  // namespace

int FloatPicture::channel(const std::string& name) const {
    for (size_t i = 0; i < names.size(); ++i)
        if (lowered(names[i]) == lowered(name)) return int(i);
    return -1;
}

bool readPicture(const std::filesystem::path& path, FloatPicture& picture, std::string& error) {
    try {
        std::error_code absent;  // which the reader reports
        const uint64_t size = std::filesystem::file_size(path, absent);
        const PictureLimit limit{kMaxPictureSide, mostUnpacked(absent ? 0 : size)};
        std::string unfit;
        if (!absent && !checkHeader(headOf(path, size), limit, unfit))
            return refused(path, unfit, error);
        OIIO::ImageSpec request;
        request["oiio:UnassociatedAlpha"] = 1;
        const auto input = OIIO::ImageInput::open(path.string(), &request);
        if (!input) return refused(path, reasonOf(OIIO::geterror()), error);
        input->threads(1);
        const OIIO::ImageSpec spec = input->spec();
        if (spec.depth > 1)
            return refused(path,
                           "it is " + std::to_string(spec.depth) + " slices deep; it must be flat",
                           error);
        if (spec.nchannels < 1 || spec.nchannels > int(kMaxPictureChannels))
            return refused(path,
                           "it has " + std::to_string(spec.nchannels) +
                               " channels; their number must lie in [1, " +
                               std::to_string(kMaxPictureChannels) + "]",
                           error);
        if (spec.deep) return refused(path, "its pixels are deep; they must be flat", error);
        const uint64_t bytesPerPixel = sizeof(float) * uint64_t(spec.nchannels);
        if (!fits(spec.width, spec.height, bytesPerPixel, limit, unfit))
            return refused(path, unfit, error);
        FloatPicture read;
        read.width = uint32_t(spec.width);
        read.height = uint32_t(spec.height);
        read.channels = uint32_t(spec.nchannels);
        read.whole = !spec.format.is_floating_point();
        read.names.assign(spec.channelnames.begin(), spec.channelnames.end());
        read.names.resize(read.channels);
        read.values.resize(size_t(read.width) * read.height * read.channels);
        // Some readers report a problem and still return true.
        if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT,
                               read.values.data()) ||
            input->has_error())
            return refused(path, reasonOf(input->geterror()), error);
        picture = std::move(read);
        return true;
    } catch (const std::exception& failure) {
        return refused(path, failure.what(), error);
    }
}

bool writePicture(const std::filesystem::path& path, const FloatPicture& picture,
                  std::string& error) {
    // Write to a temporary file with the same extension, then rename it.
    std::filesystem::path fresh = path;
    fresh.replace_filename(".new-" + path.filename().string());
    try {
        const auto output = OIIO::ImageOutput::create(path.string());
        if (!output) return refused(path, reasonOf(OIIO::geterror()), error);
        OIIO::ImageSpec spec(int(picture.width), int(picture.height), int(picture.channels),
                             picture.whole ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::FLOAT);
        if (picture.names.size() == picture.channels)
            spec.channelnames.assign(picture.names.begin(), picture.names.end());
        spec["oiio:UnassociatedAlpha"] = 1;  // straight alpha, as readPicture expects
        const bool good = output->open(fresh.string(), spec) &&
                          output->write_image(OIIO::TypeDesc::FLOAT, picture.values.data());
        const std::string why = good ? std::string() : reasonOf(output->geterror());
        const bool closed = output->close();
        std::error_code failure;
        if (good && closed) std::filesystem::rename(fresh, path, failure);
        if (good && closed && !failure) return true;
        const std::string reason = !good     ? why
                                   : !closed ? reasonOf(output->geterror())
                                             : failure.message();
        std::filesystem::remove(fresh, failure);
        return refused(path, reason, error);
    } catch (const std::exception& failure) {
        return refused(path, failure.what(), error);
    }
}

}  // namespace fwimport
