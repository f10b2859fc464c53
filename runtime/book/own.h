// The library's own flipbooks, baked by flamewright_flipbook (own/bake.sh) and part of the library.
#pragma once
#include <cstdint>
#include <memory_resource>
#include <vector>

#include <cstddef>

namespace fw::book {

// The .fwbook of an FwFlipbookPreset but FW_FLIPBOOK_CUSTOM.
std::pmr::vector<std::byte> ownBook(uint32_t preset, std::pmr::memory_resource* memory);

}  // namespace fw::book
