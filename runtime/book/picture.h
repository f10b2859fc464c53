// All flipbooks of a world as a device has them: one picture of their frames, of those at smaller
// sizes, which is what far ones show, and of motion; and the
// words that say where each lies (shared/book.h).
#pragma once
#include "book/book.h"

namespace fw::book {

struct Picture {
    explicit Picture(std::pmr::memory_resource* memory) : texels(memory), words(memory) {}
    uint32_t width = 1, height = 1;
    std::pmr::vector<uint8_t> texels;  // RGBA8; rows as the frames', from the bottom
    std::pmr::vector<uint32_t> words;  // gpu::kBookWords
};

constexpr uint32_t kMostPicture = 4096;  // texels a side: every device has them

// `books` by slot, at most gpu::kMaxBooks; null: there is none. Throws core::Error where they do
// not fit.
Picture layBooks(std::span<const Book* const> books, std::pmr::memory_resource* memory);

}  // namespace fw::book
