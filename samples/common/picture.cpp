// See picture.h. The still pictures go through OpenImageIO; the animation is PNG chunks of our own.
#include "common/picture.h"

#include <OpenImageIO/imageio.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>

#include "common/options.h"

namespace sample {
namespace {

void putBig32(std::vector<uint8_t>& out, uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8)
        out.push_back(static_cast<uint8_t>(value >> shift));
}

void putBig16(std::vector<uint8_t>& out, uint32_t value) {
    out.push_back(static_cast<uint8_t>(value >> 8));
    out.push_back(static_cast<uint8_t>(value));
}

void putChunk(std::vector<uint8_t>& out, const char* type, const std::vector<uint8_t>& body) {
    putBig32(out, static_cast<uint32_t>(body.size()));
    const size_t start = out.size();
    out.insert(out.end(), type, type + 4);
    out.insert(out.end(), body.begin(), body.end());
    putBig32(out, static_cast<uint32_t>(
                      crc32(0, out.data() + start, static_cast<uInt>(out.size() - start))));
}

// Applies one PNG filter to a row. Returns the sum of differences, which is small for rows that
// compress well.
template <int kFilter>
uint64_t applyFilter(const uint8_t* row, const uint8_t* above, size_t bytes, uint8_t* out) {
    constexpr size_t kPixel = 4;
    uint64_t cost = 0;
    *out++ = kFilter;
    for (size_t i = 0; i < bytes; ++i) {
        const int left = i >= kPixel ? row[i - kPixel] : 0;
        const int up = above[i];
        int predicted = 0;
        if constexpr (kFilter == 1) predicted = left;
        if constexpr (kFilter == 2) predicted = up;
        if constexpr (kFilter == 4) {
            const int corner = i >= kPixel ? above[i - kPixel] : 0;
            const int dl = std::abs(up - corner), du = std::abs(left - corner);
            const int dc = std::abs(left + up - 2 * corner);
            predicted = dl <= du && dl <= dc ? left : du <= dc ? up : corner;
        }
        const auto difference = static_cast<uint8_t>(row[i] - predicted);
        out[i] = difference;
        cost += difference < 128 ? difference : 256u - difference;
    }
    return cost;
}

std::vector<uint8_t> deflatePicture(const uint8_t* rgba, uint32_t width, uint32_t height) {
    const size_t bytes = size_t{width} * 4;
    const std::vector<uint8_t> blank(bytes, 0);
    std::vector<uint8_t> filtered((bytes + 1) * height), trial(bytes + 1);
    for (uint32_t y = 0; y < height; ++y) {
        const uint8_t* row = rgba + y * bytes;
        const uint8_t* above = y ? row - bytes : blank.data();
        uint8_t* out = &filtered[y * (bytes + 1)];
        uint64_t best = applyFilter<0>(row, above, bytes, out);
        for (auto* filter : {applyFilter<1>, applyFilter<2>, applyFilter<4>}) {
            const uint64_t cost = filter(row, above, bytes, trial.data());
            if (cost < best) {
                best = cost;
                std::copy(trial.begin(), trial.end(), out);
            }
        }
    }
    uLongf size = compressBound(static_cast<uLong>(filtered.size()));
    std::vector<uint8_t> packed(size);
    compress2(packed.data(), &size, filtered.data(), static_cast<uLong>(filtered.size()), 6);
    packed.resize(size);
    return packed;
}

void prepareFolder(const std::filesystem::path& path) {
    if (path.has_parent_path()) {
        std::error_code error;
        std::filesystem::create_directories(path.parent_path(), error);
        if (error) {
            throw Failure("the folder " + path.parent_path().string() +
                          " cannot be created: " + error.message());
        }
    }
}

std::vector<uint8_t> frameControl(uint32_t sequence, uint32_t x, uint32_t y, uint32_t width,
                                  uint32_t height, uint32_t delayMilliseconds, bool over) {
    std::vector<uint8_t> body;
    putBig32(body, sequence);
    putBig32(body, width);
    putBig32(body, height);
    putBig32(body, x);
    putBig32(body, y);
    putBig16(body, std::min(delayMilliseconds, 65535u));
    putBig16(body, 1000);
    body.push_back(0);             // dispose: keep the frame on screen
    body.push_back(over ? 1 : 0);  // blend: over, or replace
    return body;
}

}  // namespace

void writePng(const std::filesystem::path& path, const Picture& picture) {
    prepareFolder(path);
    auto file = OIIO::ImageOutput::create(path.string());
    if (!file) throw Failure(path.string() + " cannot be written: " + OIIO::geterror());
    OIIO::ImageSpec spec(static_cast<int>(picture.width), static_cast<int>(picture.height), 3,
                         OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("png:compressionLevel", 4);
    if (!file->open(path.string(), spec) ||
        !file->write_image(OIIO::TypeDesc::UINT8, picture.rgba.data(), 4) || !file->close()) {
        throw Failure(path.string() + " cannot be written: " + file->geterror());
    }
}

Picture resized(const Picture& picture, uint32_t width, uint32_t height) {
    Picture result{width, height, std::vector<uint8_t>(size_t{width} * height * 4)};
    const double stepX = double(picture.width) / width, stepY = double(picture.height) / height;
    for (uint32_t y = 0; y < height; ++y) {
        const double top = y * stepY, bottom = std::min<double>((y + 1) * stepY, picture.height);
        for (uint32_t x = 0; x < width; ++x) {
            const double left = x * stepX, right = std::min<double>((x + 1) * stepX, picture.width);
            double sum[4] = {}, weight = 0;
            for (auto j = static_cast<uint32_t>(top); j < picture.height && j < bottom; ++j) {
                const double h = std::min<double>(j + 1, bottom) - std::max<double>(j, top);
                for (auto i = static_cast<uint32_t>(left); i < picture.width && i < right; ++i) {
                    const double w = std::min<double>(i + 1, right) - std::max<double>(i, left);
                    const uint8_t* from = &picture.rgba[(size_t{j} * picture.width + i) * 4];
                    for (int c = 0; c < 4; ++c) sum[c] += w * h * from[c];
                    weight += w * h;
                }
            }
            uint8_t* to = &result.rgba[(size_t{y} * width + x) * 4];
            for (int c = 0; c < 4; ++c) {
                to[c] = static_cast<uint8_t>(std::lround(sum[c] / std::max(weight, 1e-9)));
            }
        }
    }
    return result;
}

Picture contactSheet(std::span<const Picture> pictures, uint32_t columns, uint32_t gap) {
    Picture sheet;
    if (pictures.empty()) return sheet;
    columns = std::clamp<uint32_t>(columns, 1, static_cast<uint32_t>(pictures.size()));
    const auto rows = static_cast<uint32_t>((pictures.size() + columns - 1) / columns);
    const uint32_t width = pictures[0].width, height = pictures[0].height;
    sheet.width = columns * width + (columns - 1) * gap;
    sheet.height = rows * height + (rows - 1) * gap;
    sheet.rgba.assign(size_t{sheet.width} * sheet.height * 4, 12);
    for (size_t i = 0; i < pictures.size(); ++i) {
        if (pictures[i].width != width || pictures[i].height != height) {
            throw Failure("the pictures of a contact sheet must have one size");
        }
        const size_t left = (i % columns) * (width + gap), top = (i / columns) * (height + gap);
        for (uint32_t y = 0; y < height; ++y) {
            std::memcpy(&sheet.rgba[((top + y) * sheet.width + left) * 4],
                        &pictures[i].rgba[size_t{y} * width * 4], size_t{width} * 4);
        }
    }
    return sheet;
}

AnimationWriter::AnimationWriter(std::filesystem::path path, double framesPerSecond)
    : path_(std::move(path)), framesPerSecond_(framesPerSecond) {}

void AnimationWriter::add(const Picture& picture) {
    const auto delay = static_cast<uint32_t>(std::lround(1000.0 / framesPerSecond_));
    if (frameCount_ == 0) {
        width_ = picture.width;
        height_ = picture.height;
        shown_ = picture.rgba;
        for (size_t i = 3; i < shown_.size(); i += 4) shown_[i] = 255;
        lastControl_ = chunks_.size();
        putChunk(chunks_, "fcTL", frameControl(sequence_++, 0, 0, width_, height_, delay, false));
        putChunk(chunks_, "IDAT", deflatePicture(shown_.data(), width_, height_));
        frameCount_ = 1;
        return;
    }
    if (picture.width != width_ || picture.height != height_) {
        throw Failure("the pictures of an animation must have one size");
    }
    // Stores only pixels that differ visibly from the screen; the rest is transparent. Comparing
    // with the screen instead of the last frame keeps slow changes.
    constexpr int kVisible = 2;
    uint32_t left = width_, right = 0, top = height_, bottom = 0;
    std::vector<uint8_t> changed(shown_.size(), 0);
    for (uint32_t y = 0; y < height_; ++y) {
        for (uint32_t x = 0; x < width_; ++x) {
            const size_t at = (size_t{y} * width_ + x) * 4;
            const uint8_t* now = &picture.rgba[at];
            const uint8_t* was = &shown_[at];
            if (std::abs(now[0] - was[0]) <= kVisible && std::abs(now[1] - was[1]) <= kVisible &&
                std::abs(now[2] - was[2]) <= kVisible) {
                continue;
            }
            std::memcpy(&shown_[at], now, 3);
            std::memcpy(&changed[at], now, 3);
            changed[at + 3] = 255;
            left = std::min(left, x);
            right = std::max(right, x + 1);
            top = std::min(top, y);
            bottom = std::max(bottom, y + 1);
        }
    }
    if (right == 0) left = top = 0, right = bottom = 1;  // a frame must contain a pixel
    const uint32_t width = right - left, height = bottom - top;
    std::vector<uint8_t> part(size_t{width} * height * 4);
    for (uint32_t y = 0; y < height; ++y) {
        std::memcpy(&part[size_t{y} * width * 4], &changed[((size_t{top} + y) * width_ + left) * 4],
                    size_t{width} * 4);
    }
    lastControl_ = chunks_.size();
    putChunk(chunks_, "fcTL", frameControl(sequence_++, left, top, width, height, delay, true));
    const std::vector<uint8_t> packed = deflatePicture(part.data(), width, height);
    std::vector<uint8_t> body;
    body.reserve(4 + packed.size());
    putBig32(body, sequence_++);
    std::copy(packed.begin(), packed.end(), std::back_inserter(body));
    putChunk(chunks_, "fdAT", body);
    ++frameCount_;
}

void AnimationWriter::close(double holdSeconds) {
    if (frameCount_ == 0) return;
    // The last frame's delay becomes the pause before the loop, so rewrite it and its checksum.
    constexpr size_t kBody = 8, kDelay = 20, kControlSize = 26;
    const auto hold = static_cast<uint32_t>(std::clamp(holdSeconds * 1000.0, 1.0, 65000.0));
    uint8_t* control = chunks_.data() + lastControl_;
    control[kBody + kDelay] = static_cast<uint8_t>(hold >> 8);
    control[kBody + kDelay + 1] = static_cast<uint8_t>(hold);
    const auto sum = static_cast<uint32_t>(crc32(0, control + 4, 4 + kControlSize));
    for (int i = 0; i < 4; ++i) {
        control[kBody + kControlSize + static_cast<size_t>(i)] =
            static_cast<uint8_t>(sum >> (24 - 8 * i));
    }

    std::vector<uint8_t> head = {137, 80, 78, 71, 13, 10, 26, 10};
    std::vector<uint8_t> body;
    putBig32(body, width_);
    putBig32(body, height_);
    for (uint8_t byte : {8, 6, 0, 0, 0}) body.push_back(byte);  // 8 bits, RGBA
    putChunk(head, "IHDR", body);
    putChunk(head, "sRGB", {0});
    body.clear();
    putBig32(body, frameCount_);
    putBig32(body, 0);  // loop for ever
    putChunk(head, "acTL", body);
    std::vector<uint8_t> tail;
    putChunk(tail, "IEND", {});

    prepareFolder(path_);
    std::FILE* file = std::fopen(path_.string().c_str(), "wb");
    if (!file) throw Failure(path_.string() + " cannot be written");
    bool good = true;
    for (const auto* part : {&head, &chunks_, &tail}) {
        good = good && std::fwrite(part->data(), 1, part->size(), file) == part->size();
    }
    good = std::fclose(file) == 0 && good;
    if (!good) throw Failure(path_.string() + " cannot be written; is the disk full?");
    frameCount_ = 0;
    chunks_.clear();
}

}  // namespace sample
