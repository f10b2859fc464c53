// Defs of the Vulkan header, for code without Vulkan types. Implemented in vulkan.cpp.
#pragma once
#include <cstddef>
#include <cstdint>

namespace fw::edge {

size_t vulkanDefSize(uint32_t type) noexcept;                 // 0: unknown
bool writeVulkanDefaults(uint32_t type, void* def) noexcept;  // false: unknown

}  // namespace fw::edge
