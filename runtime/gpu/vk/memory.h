// Device memory: a few blocks per memory type, cut into pieces; buffers and images on top of it.
// Counted per component and held under a budget.
#pragma once
#include "gpu/backend.h"
#include "gpu/vk/device.h"
#include "gpu/vk/range_allocator.h"

#include <vector>

namespace fw::gpu::vk {

constexpr uint64_t alignUp(uint64_t value, uint64_t alignment) noexcept {
    return (value + alignment - 1) / alignment * alignment;
}

enum class MemoryKind : uint8_t {
    device,    // only the GPU reads and writes
    upload,    // written by the CPU, coherent
    readback,  // read by the CPU, coherent, cached where there is such a type
};

struct Piece {  // of a block
    uint32_t block = 0xFFFFFFFFu;
    VkDeviceSize offset = 0, size = 0;
};

struct Buffer {
    VkBuffer handle = VK_NULL_HANDLE;
    VkBufferView texels = VK_NULL_HANDLE;  // all of it by four words, if its usage has them
    Piece memory;
    VkDeviceSize size = 0;
    std::byte* mapped = nullptr;  // upload and readback: for as long as it lives
    uint32_t component = 0;
};

struct Image {
    VkImage handle = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    Piece memory;
    uint32_t component = 0;
};

// The parts that hold memory, in the report's order.
enum Component : uint32_t {
    kComponentMeshes,
    kComponentObjects,
    kComponentLists,
    kComponentPredict,
    kComponentHeat,
    kComponentRefine,
    kComponentFlames,
    kComponentImages,
    kComponentStaging,
    kComponentReadback,
    kComponentTargets,
    kComponentCount,
};

// [any]: locks inside.
class DeviceMemory {
 public:
    DeviceMemory(Device& device, uint64_t budget, std::pmr::memory_resource* memory)
        : device_(device), budget_(budget), blocks_(memory), memory_(memory) {}
    ~DeviceMemory();  // frees the blocks, whatever is still in them
    DeviceMemory(const DeviceMemory&) = delete;
    DeviceMemory& operator=(const DeviceMemory&) = delete;

    // Throw core::Error FW_ERROR_OUT_OF_MEMORY with the purpose, the size and the budget.
    Buffer createBuffer(VkDeviceSize size, VkBufferUsageFlags usage, MemoryKind kind,
                        Component component, const char* name);
    Image createImage(const VkImageCreateInfo& info, VkImageAspectFlags aspect, Component component,
                      const char* name);
    void destroy(Buffer& buffer) noexcept;
    void destroy(Image& image) noexcept;

    [[nodiscard]] uint64_t used() const noexcept;  // bytes of all blocks
    [[nodiscard]] uint64_t budget() const noexcept { return budget_; }
    void rows(std::pmr::vector<MemoryRow>& out) const;

 private:
    struct Block {
        VkDeviceMemory memory = VK_NULL_HANDLE;
        uint32_t type = 0;
        bool image = false;  // images and buffers never share a block: no granularity to respect
        std::byte* mapped = nullptr;
        RangeAllocator bytes;
        explicit Block(std::pmr::memory_resource* pmr) : bytes(pmr) {}
        [[nodiscard]] bool holds(uint32_t ofType, bool images, bool isMapped) const noexcept {
            return memory && type == ofType && image == images && (mapped != nullptr) == isMapped;
        }
    };
    Piece allocate(const VkMemoryRequirements& needs, MemoryKind kind, bool image,
                   const char* name);
    void release(Piece& piece) noexcept;
    uint32_t typeFor(uint32_t allowed, MemoryKind kind, const char* name) const;

    Device& device_;
    uint64_t budget_;
    std::pmr::vector<Block> blocks_;  // freed ones stay as empty entries and are reused
    std::pmr::memory_resource* memory_;
    uint64_t used_ = 0;
    uint64_t components_[kComponentCount] = {};
    mutable std::mutex mutex_;
};

}  // namespace fw::gpu::vk
