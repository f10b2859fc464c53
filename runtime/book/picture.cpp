// Blocks of frames on shelves: the tallest first, side by side, the next shelf above. A block is as
// square as its frames allow.
#include "book/picture.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace fw::book {
namespace {

struct Block {
    uint32_t book = 0;
    bool motion = false;
    uint32_t columns = 1, width = 0, height = 0;  // texels
    uint32_t x = 0, y = 0;
};

constexpr uint32_t kBorder = 1;  // texels of nothing around a frame

Block blockOf(const Facts& f, uint32_t book, bool motion, uint32_t columns) {
    const uint32_t rows = (f.frames + columns - 1) / columns;
    Block block{book, motion, columns, 0, 0, 0, 0};
    block.width = columns * (motion ? f.motionWidth : f.width + 2 * kBorder);
    block.height = rows * (motion ? f.motionHeight : f.height + 2 * kBorder);
    return block;
}

// As high as the shelves come in a picture so wide.
uint32_t shelve(std::span<Block> blocks, uint32_t width) {
    uint32_t x = 0, y = 0, shelf = 0;
    for (Block& block : blocks) {
        if (x + block.width > width) x = 0, y += shelf, shelf = 0;
        block.x = x, block.y = y;
        x += block.width;
        shelf = std::max(shelf, block.height);
    }
    return y + shelf;
}

void copyFrames(const Facts& f, const Block& block, std::span<const uint8_t> from,
                Picture& picture) {
    const uint32_t border = block.motion ? 0 : kBorder, bytes = block.motion ? 2 : 4;
    const uint32_t w = block.motion ? f.motionWidth : f.width,
                   h = block.motion ? f.motionHeight : f.height;
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

Picture layBooks(std::span<const Book* const> books, std::pmr::memory_resource* memory) {
    std::pmr::vector<Block> blocks(memory);
    for (uint32_t i = 0; i < books.size(); ++i) {
        if (!books[i]) continue;
        const Facts& f = books[i]->facts;
        const uint32_t cell = f.width + 2 * kBorder;
        const double square = std::sqrt(double(f.frames) * (f.height + 2) / cell);
        const uint32_t columns =
            std::clamp(uint32_t(std::ceil(square)), 1u, std::min(f.frames, kMostPicture / cell));
        blocks.push_back(blockOf(f, i, false, columns));
        blocks.push_back(blockOf(f, i, true, columns));
    }
    std::stable_sort(blocks.begin(), blocks.end(),
                     [](const Block& a, const Block& b) { return a.height > b.height; });
    Picture picture(memory);
    for (picture.width = 256; picture.width <= kMostPicture; picture.width *= 2) {
        const bool fits = std::all_of(blocks.begin(), blocks.end(), [&](const Block& block) {
            return block.width <= picture.width;
        });
        if (!fits) continue;
        picture.height = std::max(shelve(blocks, picture.width), 1u);
        if (picture.height <= picture.width) break;
    }
    if (picture.width > kMostPicture)
        core::fail(FW_ERROR_OUT_OF_MEMORY,
                   "The world's flipbooks fill %u rows of %u texels; the limit is %u rows.",
                   picture.height, kMostPicture, kMostPicture);
    picture.texels.resize(size_t(4) * picture.width * picture.height);
    picture.words.resize(gpu::kBookWords);
    for (const Block& block : blocks) {
        const Book& book = *books[block.book];
        const Facts& f = book.facts;
        copyFrames(f, block, block.motion ? book.motion : book.texels, picture);
        gpu::BookRecord record{};
        uint32_t* words = picture.words.data() + size_t(block.book) * gpu::kBookRecordWords;
        std::memcpy(&record, words, sizeof record);
        const uint32_t border = block.motion ? 0 : kBorder;
        const uint32_t at = (block.x + border) | (block.y + border) << 16;
        (block.motion ? record.motionAt : record.at) = at;
        record.size = f.width | f.height << 16;
        record.motionSize = f.motionWidth | f.motionHeight << 16;
        record.frames = f.frames;
        record.columns = block.columns;
        record.flags = f.loops ? gpu::kBookLoops : 0u;
        record.motionMost = f.motionMost;
        record.seconds = f.seconds;
        std::memcpy(words, &record, sizeof record);
        uint32_t* rects =
            picture.words.data() + gpu::kBookRects + size_t(2) * block.book * gpu::kMostBookFrames;
        for (size_t i = 0; i < book.rects.size(); ++i) {
            const Rect& r = book.rects[i];
            rects[2 * i] = r.left | uint32_t(r.low) << 16;
            rects[2 * i + 1] = r.right | uint32_t(r.high) << 16;
        }
    }
    return picture;
}

}  // namespace fw::book
