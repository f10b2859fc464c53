// All flipbooks of a world as one picture for the device: their frames, smaller copies for distant
// particles, and motion; and the words with the place of each (shared/flipbook.h).
#pragma once
#include "flipbook/flipbook.h"

namespace fw::flipbook {

struct Picture {
    explicit Picture(std::pmr::memory_resource* memory) : texels(memory), words(memory) {}
    uint32_t width = 1, height = 1;
    std::pmr::vector<uint8_t> texels;  // RGBA8; rows as the frames', from the bottom
    std::pmr::vector<uint32_t> words;  // gpu::kFlipbookWords
};

constexpr uint32_t kMaxPicture = 4096;  // texels a side; every device supports it

// `flipbooks` by slot, at most gpu::kMaxFlipbooks; null: an empty slot. Throws core::Error if they
// do not fit.
Picture packFlipbooks(std::span<const Flipbook* const> flipbooks,
                      std::pmr::memory_resource* memory);

}  // namespace fw::flipbook
