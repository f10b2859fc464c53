// Packs blocks of frames on shelves: tallest first, side by side, the next shelf above. A block is
// as square as its frames allow.
#include "flipbook/picture.h"

#include "core/assert.h"
#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace fw::flipbook {
namespace {

struct Block {
    uint32_t flipbook = 0, level = 0;
    bool motion = false;
    uint32_t columns = 1, width = 0, height = 0;  // texels
    uint32_t x = 0, y = 0;
};

constexpr uint32_t kBorder = 1;  // empty texels around a frame

Block blockOf(const Facts& f, uint32_t flipbook, uint32_t level, bool motion, uint32_t columns) {
    const uint32_t rows = (f.frames + columns - 1) / columns;
    Block block{flipbook, level, motion, columns, 0, 0, 0, 0};
    block.width = columns * (motion ? f.motionWidth : (f.width >> level) + 2 * kBorder);
    block.height = rows * (motion ? f.motionHeight : (f.height >> level) + 2 * kBorder);
    return block;
}

// Whether frames have this smaller level: each texel is the mean of four.
bool hasLevel(const Facts& f, uint32_t level) {
    constexpr uint32_t kLeast = 4;  // texels
    const uint32_t parts = (1u << level) - 1;
    return ((f.width | f.height) & parts) == 0 && std::min(f.width, f.height) >> level >= kLeast;
}

// All frames at half the size. Temperatures are weighted by the glowing soot.
std::pmr::vector<uint8_t> halved(std::span<const uint8_t> from, uint32_t width, uint32_t height,
                                 uint32_t frames, std::pmr::memory_resource* memory) {
    FW_ASSERT(from.size() == size_t(4) * width * height * frames, "%zu bytes", from.size());
    const uint32_t w = width / 2, h = height / 2;
    std::pmr::vector<uint8_t> out(size_t(4) * w * h * frames, memory);
    for (uint32_t row = 0; row < h * frames; ++row)
        for (uint32_t x = 0; x < w; ++x) {
            uint32_t sums[4] = {}, kelvin = 0;
            for (uint32_t k = 0; k < 4; ++k) {
                const size_t at = size_t(width) * (2 * row + k / 2) + 2 * x + k % 2;
                const uint8_t* texel = from.data() + 4 * at;
                for (uint32_t c = 0; c < 4; ++c) sums[c] += texel[c];
                kelvin += uint32_t(texel[0]) * texel[1];
            }
            uint8_t* texel = out.data() + 4 * (size_t(w) * row + x);
            for (uint32_t c = 0; c < 4; ++c) texel[c] = uint8_t((sums[c] + 2) / 4);
            if (sums[1] > 0) texel[0] = uint8_t((kelvin + sums[1] / 2) / sums[1]);
        }
    return out;
}

// Places the blocks in a picture of this width; returns the shelves' height.
uint32_t shelve(std::span<Block> blocks, uint32_t width) {
    uint32_t x = 0, y = 0, shelf = 0;
    for (Block& block : blocks) {
        if (x + block.width > width) x = 0, y += shelf, shelf = 0;
        block.x = x, block.y = y;
        x += block.width;
        shelf = std::max(shelf, block.height);
    }
    FW_ASSERT(std::all_of(blocks.begin(), blocks.end(),
                          [&](const Block& b) { return b.x + b.width <= width; }));
    return y + shelf;
}

void copyFrames(const Facts& f, const Block& block, std::span<const uint8_t> from,
                Picture& picture) {
    const uint32_t border = block.motion ? 0 : kBorder, bytes = block.motion ? 2 : 4;
    const uint32_t w = block.motion ? f.motionWidth : f.width >> block.level,
                   h = block.motion ? f.motionHeight : f.height >> block.level;
    FW_ASSERT(from.size() == size_t(bytes) * w * h * f.frames, "%zu bytes", from.size());
    for (uint32_t frame = 0; frame < f.frames; ++frame) {
        const uint32_t x = block.x + frame % block.columns * (w + 2 * border) + border;
        const uint32_t y = block.y + frame / block.columns * (h + 2 * border) + border;
        for (uint32_t j = 0; j < h; ++j) {
            const uint8_t* row = from.data() + size_t(bytes) * w * (size_t(frame) * h + j);
            uint8_t* out = picture.texels.data() + 4 * (size_t(y + j) * picture.width + x);
            for (uint32_t i = 0; i < w; ++i)
                std::memcpy(out + size_t(4) * i, row + size_t(bytes) * i, bytes);
        }
    }
}

}  // namespace

Picture packFlipbooks(std::span<const Flipbook* const> flipbooks,
                      std::pmr::memory_resource* memory) {
    std::pmr::vector<Block> blocks(memory);
    for (uint32_t i = 0; i < flipbooks.size(); ++i) {
        if (!flipbooks[i]) continue;
        const Facts& f = flipbooks[i]->facts;
        const uint32_t cell = f.width + 2 * kBorder;
        const double square = std::sqrt(double(f.frames) * (f.height + 2) / cell);
        const uint32_t columns =
            std::clamp(uint32_t(std::ceil(square)), 1u, std::min(f.frames, kMaxPicture / cell));
        for (uint32_t level = 0; level < gpu::kFlipbookLevels && hasLevel(f, level); ++level)
            blocks.push_back(blockOf(f, i, level, false, columns));
        blocks.push_back(blockOf(f, i, 0, true, columns));
    }
    std::stable_sort(blocks.begin(), blocks.end(),
                     [](const Block& a, const Block& b) { return a.height > b.height; });
    Picture picture(memory);
    for (picture.width = 256; picture.width <= kMaxPicture; picture.width *= 2) {
        const bool fits = std::all_of(blocks.begin(), blocks.end(), [&](const Block& block) {
            return block.width <= picture.width;
        });
        if (!fits) continue;
        picture.height = std::max(shelve(blocks, picture.width), 1u);
        if (picture.height <= picture.width) break;
    }
    if (picture.width > kMaxPicture)
        core::fail(FW_ERROR_OUT_OF_MEMORY,
                   "The world's flipbooks fill %u rows of %u texels; the limit is %u rows.",
                   picture.height, kMaxPicture, kMaxPicture);
    picture.texels.resize(size_t(4) * picture.width * picture.height);
    picture.words.resize(gpu::kFlipbookWords);
    FW_ASSERT(flipbooks.size() <= gpu::kMaxFlipbooks, "%zu flipbooks", flipbooks.size());
    for (const Block& block : blocks) {
        const Flipbook& flipbook = *flipbooks[block.flipbook];
        const Facts& f = flipbook.facts;
        if (block.motion) {
            copyFrames(f, block, flipbook.motion, picture);
        } else if (block.level == 0) {
            copyFrames(f, block, flipbook.texels, picture);
        } else {
            std::pmr::vector<uint8_t> smaller(memory);
            for (uint32_t level = 0; level < block.level; ++level)
                smaller = halved(level ? std::span<const uint8_t>(smaller) : flipbook.texels,
                                 f.width >> level, f.height >> level, f.frames, memory);
            copyFrames(f, block, smaller, picture);
        }
        gpu::FlipbookRecord record{};
        uint32_t* words = picture.words.data() + size_t(block.flipbook) * gpu::kFlipbookRecordWords;
        std::memcpy(&record, words, sizeof record);
        const uint32_t border = block.motion ? 0 : kBorder;
        const uint32_t at = (block.x + border) | (block.y + border) << 16;
        uint32_t* const levels[] = {&record.at, &record.at1, &record.at2, &record.at3};
        *(block.motion ? &record.motionAt : levels[block.level]) = at;
        record.size = f.width | f.height << 16;
        record.motionSize = f.motionWidth | f.motionHeight << 16;
        record.frames = f.frames;
        record.columns = block.columns;
        record.flags = f.loops ? gpu::kFlipbookLoops : 0u;
        record.maxMotion = f.maxMotion;
        record.seconds = f.seconds;
        std::memcpy(words, &record, sizeof record);
        uint32_t* rects = picture.words.data() + gpu::kFlipbookRects +
                          size_t(2) * block.flipbook * gpu::kMaxFlipbookFrames;
        for (size_t i = 0; i < flipbook.rects.size(); ++i) {
            const Rect& r = flipbook.rects[i];
            rects[2 * i] = r.left | uint32_t(r.low) << 16;
            rects[2 * i + 1] = r.right | uint32_t(r.high) << 16;
        }
    }
    return picture;
}

}  // namespace fw::flipbook
