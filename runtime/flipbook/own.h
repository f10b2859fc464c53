// The library's built-in flipbooks, baked by flamewright_flipbook (own/bake.sh).
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <vector>

namespace fw::flipbook {

// The .fwbook of an FwFlipbookPreset except FW_FLIPBOOK_CUSTOM.
std::pmr::vector<std::byte> presetFlipbook(uint32_t preset, std::pmr::memory_resource* memory);

}  // namespace fw::flipbook
