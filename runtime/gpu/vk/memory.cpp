#include "gpu/vk/memory.h"

#include "core/assert.h"
#include "core/error.h"

#include <algorithm>

namespace fw::gpu::vk {
namespace {

constexpr VkDeviceSize kBlockSize = VkDeviceSize(16) << 20;
constexpr const char* kComponentNames[kComponentCount] = {
    "meshes", "objects", "lists",   "predict",  "heat",   "refine",
    "flames", "images",  "staging", "readback", "targets"};

}  // namespace

DeviceMemory::~DeviceMemory() {
    for (Block& block : blocks_) {
        if (block.memory) device_.destroy(device_.table.FreeMemory, block.memory);
    }
}

uint32_t DeviceMemory::typeFor(uint32_t allowed, MemoryKind kind, const char* name) const {
    const VkMemoryPropertyFlags host =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    VkMemoryPropertyFlags needed = 0, preferred = 0;
    if (kind == MemoryKind::device) preferred = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    if (kind == MemoryKind::upload) needed = host;
    if (kind == MemoryKind::readback) {
        needed = host;
        preferred = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    }
    const VkPhysicalDeviceMemoryProperties& types = device_.memoryProperties;
    for (const VkMemoryPropertyFlags flags : {needed | preferred, needed}) {
        for (uint32_t type = 0; type < types.memoryTypeCount; ++type) {
            if ((allowed >> type & 1u) && (types.memoryTypes[type].propertyFlags & flags) == flags)
                return type;
        }
    }
    core::fail(FW_ERROR_UNSUPPORTED_DEVICE,
               "The device has no memory type for %s: types 0x%x are allowed, none has flags 0x%x.",
               name, allowed, needed);
}

Piece DeviceMemory::allocate(const VkMemoryRequirements& needs, MemoryKind kind, bool image,
                             const char* name) {
    const uint32_t type = typeFor(needs.memoryTypeBits, kind, name);
    for (uint32_t i = 0; i < blocks_.size(); ++i) {
        Block& block = blocks_[i];
        if (!block.holds(type, image, kind != MemoryKind::device)) continue;
        const uint64_t at = block.bytes.allocate(needs.size, needs.alignment);
        if (at != RangeAllocator::kNoRange) return {i, at, needs.size};
    }
    VkDeviceSize size = std::max(needs.size, kBlockSize);
    // A sixteenth is the frames' own staging and readback: a world that is full still runs.
    const uint64_t budget = kind == MemoryKind::device ? budget_ - budget_ / 16 : budget_;
    if (budget_ && used_ + size > budget) size = needs.size;
    if (budget_ && used_ + size > budget)
        core::fail(FW_ERROR_OUT_OF_MEMORY,
                   "%s needs %llu bytes of GPU memory; %llu of the budget of %llu are in use.",
                   name, (unsigned long long)needs.size, (unsigned long long)used_,
                   (unsigned long long)budget_);

    uint32_t index = 0;
    while (index < blocks_.size() && blocks_[index].memory) ++index;
    if (index == blocks_.size()) blocks_.emplace_back(memory_);
    Block block(memory_);
    // Before the device's memory is there: nothing may throw after that.
    block.bytes.addCapacity(std::max(needs.size, kBlockSize));
    const uint64_t first = block.bytes.allocate(needs.size);
    Typed<VkMemoryAllocateInfo> info;
    info.allocationSize = size;
    info.memoryTypeIndex = type;
    const Table& vk = device_.table;
    VkResult result =
        vk.AllocateMemory(device_.handle, &info, device_.allocationCallbacks, &block.memory);
    if (result != VK_SUCCESS && size > needs.size) {
        info.allocationSize = size = needs.size;
        result =
            vk.AllocateMemory(device_.handle, &info, device_.allocationCallbacks, &block.memory);
    }
    if (result != VK_SUCCESS) {
        if (result == VK_ERROR_DEVICE_LOST) device_.check(result, "vkAllocateMemory");
        core::fail(FW_ERROR_OUT_OF_MEMORY,
                   "%s needs %llu bytes of GPU memory; the device refuses them (%s), with %llu "
                   "in use.",
                   name, (unsigned long long)size, resultName(result), (unsigned long long)used_);
    }
    if (kind != MemoryKind::device) {
        void* mapped = nullptr;
        result = vk.MapMemory(device_.handle, block.memory, 0, VK_WHOLE_SIZE, 0, &mapped);
        if (result != VK_SUCCESS) {
            device_.destroy(vk.FreeMemory, block.memory);
            device_.check(result, "vkMapMemory");
        }
        block.mapped = static_cast<std::byte*>(mapped);
    }
    block.type = type;
    block.image = image;
    block.bytes.dropCapacity(block.bytes.capacity() - size);
    blocks_[index] = std::move(block);
    used_ += size;
    return {index, first, needs.size};
}

void DeviceMemory::release(Piece& piece) noexcept {
    if (piece.block == 0xFFFFFFFFu) return;
    FW_ASSERT(piece.block < blocks_.size(), "block %u of %zu", piece.block, blocks_.size());
    Block& block = blocks_[piece.block];
    block.bytes.release(piece.offset, piece.size);
    piece = {};
    if (block.bytes.used() > 0) return;
    // One spare block per kind stays, so that a host that makes and destroys does not churn.
    const auto isSpare = [&](const Block& other) {
        return &other != &block && other.holds(block.type, block.image, block.mapped != nullptr) &&
               other.bytes.used() == 0;
    };
    if (std::none_of(blocks_.begin(), blocks_.end(), isSpare)) return;
    device_.destroy(device_.table.FreeMemory, block.memory);
    used_ -= block.bytes.capacity();
    block.bytes.dropCapacity(block.bytes.capacity());
    block.mapped = nullptr;
}

Buffer DeviceMemory::createBuffer(VkDeviceSize size, VkBufferUsageFlags usage, MemoryKind kind,
                                  Component component, const char* name) {
    const std::lock_guard lock(mutex_);
    const Table& vk = device_.table;
    if (usage & VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT)
        size = std::max(size, VkDeviceSize{16});  // a view of it is not empty
    Buffer buffer;
    buffer.size = size;
    buffer.component = component;
    Typed<VkBufferCreateInfo> info;
    info.size = size;
    info.usage = usage;
    buffer.handle = device_.create(vk.CreateBuffer, info, "vkCreateBuffer");
    try {
        VkMemoryRequirements needs{};
        vk.GetBufferMemoryRequirements(device_.handle, buffer.handle, &needs);
        buffer.memory = allocate(needs, kind, false, name);
        const Block& block = blocks_[buffer.memory.block];
        device_.check(
            vk.BindBufferMemory(device_.handle, buffer.handle, block.memory, buffer.memory.offset),
            "vkBindBufferMemory");
        if (kind != MemoryKind::device) buffer.mapped = block.mapped + buffer.memory.offset;
        if (usage & VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT) {
            Typed<VkBufferViewCreateInfo> view;
            view.buffer = buffer.handle;
            view.format = VK_FORMAT_R32G32B32A32_UINT;
            view.range = size & ~VkDeviceSize{15};
            buffer.texels = device_.create(vk.CreateBufferView, view, "vkCreateBufferView");
        }
    } catch (...) {
        device_.destroy(vk.DestroyBuffer, buffer.handle);
        release(buffer.memory);
        throw;
    }
    device_.name(VK_OBJECT_TYPE_BUFFER, uint64_t(buffer.handle), name);
    components_[component] += buffer.memory.size;
    return buffer;
}

Image DeviceMemory::createImage(const VkImageCreateInfo& info, VkImageAspectFlags aspect,
                                Component component, const char* name) {
    const std::lock_guard lock(mutex_);
    const Table& vk = device_.table;
    Image image;
    image.component = component;
    image.handle = device_.create(vk.CreateImage, info, "vkCreateImage");
    try {
        VkMemoryRequirements needs{};
        vk.GetImageMemoryRequirements(device_.handle, image.handle, &needs);
        image.memory = allocate(needs, MemoryKind::device, true, name);
        device_.check(vk.BindImageMemory(device_.handle, image.handle,
                                         blocks_[image.memory.block].memory, image.memory.offset),
                      "vkBindImageMemory");
        Typed<VkImageViewCreateInfo> view;
        view.image = image.handle;
        view.viewType = info.arrayLayers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
        view.format = info.format;
        view.subresourceRange = {aspect, 0, info.mipLevels, 0, info.arrayLayers};
        image.view = device_.create(vk.CreateImageView, view, "vkCreateImageView");
    } catch (...) {
        device_.destroy(vk.DestroyImage, image.handle);
        release(image.memory);
        throw;
    }
    device_.name(VK_OBJECT_TYPE_IMAGE, uint64_t(image.handle), name);
    components_[component] += image.memory.size;
    return image;
}

void DeviceMemory::destroy(Buffer& buffer) noexcept {
    if (!buffer.handle) return;
    const std::lock_guard lock(mutex_);
    components_[buffer.component] -= buffer.memory.size;
    if (buffer.texels) device_.destroy(device_.table.DestroyBufferView, buffer.texels);
    device_.destroy(device_.table.DestroyBuffer, buffer.handle);
    release(buffer.memory);
    buffer = {};
}

void DeviceMemory::destroy(Image& image) noexcept {
    if (!image.handle) return;
    const std::lock_guard lock(mutex_);
    components_[image.component] -= image.memory.size;
    device_.destroy(device_.table.DestroyImageView, image.view);
    device_.destroy(device_.table.DestroyImage, image.handle);
    release(image.memory);
    image = {};
}

uint64_t DeviceMemory::used() const noexcept {
    const std::lock_guard lock(mutex_);
    return used_;
}

void DeviceMemory::rows(std::pmr::vector<MemoryRow>& out) const {
    const std::lock_guard lock(mutex_);
    uint64_t pieces = 0;
    for (uint32_t i = 0; i < kComponentCount; ++i) {
        out.push_back({kComponentNames[i], components_[i], components_[i]});
        pieces += components_[i];
    }
    out.push_back({"blocks", pieces, used_});
}

}  // namespace fw::gpu::vk
