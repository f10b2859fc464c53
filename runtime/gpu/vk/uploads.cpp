#include "gpu/vk/uploads.h"

#include "core/growth.h"
#include "gpu/vk/device_objects.h"

#include <algorithm>

namespace fw::gpu::vk {
namespace {

void recordImageUpload(const Table& vk, VkCommandBuffer commands, const PendingUpload& upload) {
    VkImageMemoryBarrier barrier = imageBarrier(upload.image, VK_IMAGE_ASPECT_COLOR_BIT);
    barrier.srcAccessMask = barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.subresourceRange.levelCount = upload.mips;
    barrier.subresourceRange.baseArrayLayer = upload.firstLayer;
    barrier.subresourceRange.layerCount = upload.layers;
    // Draws of earlier frames may still read a layer that gets other texels.
    constexpr VkPipelineStageFlags kReads =
        VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    recordBarriers(vk, commands, VK_PIPELINE_STAGE_TRANSFER_BIT | kReads,
                   VK_PIPELINE_STAGE_TRANSFER_BIT, {&barrier, 1});
    uint64_t at = 0;
    for (uint32_t layer = 0; layer < upload.layers; ++layer)
        for (uint32_t mip = 0; mip < upload.mips; ++mip) {
            VkBufferImageCopy region{};
            region.bufferOffset = at;
            region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip, upload.firstLayer + layer,
                                       1};
            region.imageExtent = {std::max(upload.width >> mip, 1u),
                                  std::max(upload.height >> mip, 1u), 1};
            vk.CmdCopyBufferToImage(commands, upload.staging.handle, upload.image,
                                    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
            at += uint64_t(region.imageExtent.width) * region.imageExtent.height * 4;
        }
    FW_ASSERT(at <= upload.staging.size, "%llu bytes of texels", (unsigned long long)at);
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
    barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    recordBarriers(vk, commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                   VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | kReads, {&barrier, 1});
}

}  // namespace

PendingUpload& UploadQueue::stage(uint64_t bytes, const char* name) {
    core::growTo(uploads_, uploads_.size() + 1);
    retired_.promise(1);
    PendingUpload upload;
    upload.staging = deviceMemory_.createBuffer(bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                                MemoryKind::upload, kComponentStaging, name);
    uploads_.push_back(upload);
    return uploads_.back();
}

void UploadQueue::drop(size_t kept) noexcept {
    for (; uploads_.size() > kept; uploads_.pop_back())
        deviceMemory_.destroy(uploads_.back().staging);
}

void UploadQueue::dropFirst(size_t count) noexcept {
    FW_ASSERT(count <= uploads_.size(), "%zu of %zu uploads", count, uploads_.size());
    const auto end = uploads_.begin() + std::ptrdiff_t(count);
    for (auto one = uploads_.begin(); one != end; ++one) deviceMemory_.destroy(one->staging);
    uploads_.erase(uploads_.begin(), end);
}

void UploadQueue::dropFor(VkImage image) noexcept {
    const auto isFor = [&](const PendingUpload& upload) { return upload.image == image; };
    for (PendingUpload& upload : uploads_)
        if (isFor(upload)) deviceMemory_.destroy(upload.staging);
    std::erase_if(uploads_, isFor);
}

void UploadQueue::record(const Device& device, VkCommandBuffer commands, BarrierTracker& barriers,
                         const WorldBuffers& buffers, uint64_t frameIndex) noexcept {
    for (PendingUpload& upload : uploads_) {
        if (upload.image) recordImageUpload(device.table, commands, upload);
        for (const PendingUpload::Region& region :
             std::span(upload.regions).first(upload.regionCount)) {
            const Use uses[] = {{region.resource, Access::copyWrite}};
            barriers.use(device.table, commands, uses);
            const Buffer& to = buffers.buffer(region.resource);
            FW_ASSERT(region.at + region.bytes <= to.size, "%llu bytes of %llu",
                      (unsigned long long)(region.at + region.bytes), (unsigned long long)to.size);
            const VkBufferCopy copy{region.from, region.at, region.bytes};
            device.table.CmdCopyBuffer(commands, upload.staging.handle, to.handle, 1, &copy);
        }
        retired_.push(frameIndex, upload.staging);
    }
    uploads_.clear();
}

}  // namespace fw::gpu::vk
