// See film_strip.h.
#include "viewport/film_strip.h"

#include <algorithm>
#include <cmath>

namespace fwview {
namespace {

constexpr uint32_t kColumns = 4, kRows = FilmStrip::kPictures / kColumns;

}  // namespace

FilmStrip::FilmStrip(const sample::VulkanHost& host, fwui::UiRenderer& ui) : host_(host), ui_(ui) {
    sample::ImageRequest request;
    request.width = kColumns * kWidth;
    request.height = kRows * kHeight;
    request.format = fwui::kUiFormat;
    request.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    pictures_ = host.createImage(request);
    host.runNow([&](VkCommandBuffer commands) {
        sample::imageBarrier(commands, pictures_.image, VK_IMAGE_LAYOUT_UNDEFINED,
                             VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                             VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, 0,
                             VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
    });
    texture_ = ui.addTexture(pictures_.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    forget();
}

FilmStrip::~FilmStrip() {
    vkDeviceWaitIdle(host_.device);
    ui_.removeTexture(texture_);
    host_.destroy(pictures_);
}

void FilmStrip::forget() { distance_.fill(1); }

bool FilmStrip::empty() const {
    return std::all_of(distance_.begin(), distance_.end(), [](float d) { return d >= 1; });
}

void FilmStrip::take(const fwui::Frame& frame, const SceneTarget& target, float share) {
    const float at = std::clamp(share, 0.0f, 1.0f) * kPictures;
    const uint32_t index = std::min(uint32_t(at), kPictures - 1);
    const float distance = std::fabs(at - float(index) - 0.5f);
    if (distance >= distance_[index]) return;
    distance_[index] = distance;

    // Full height or full width, whichever limits.
    const VkExtent2D from = target.extent();
    constexpr float kAspect = float(kWidth) / float(kHeight);
    const auto width = std::min(int32_t(from.width), int32_t(float(from.height) * kAspect));
    const auto height = std::min(int32_t(from.height), int32_t(float(from.width) / kAspect));
    const int32_t x = (int32_t(from.width) - width) / 2, y = (int32_t(from.height) - height) / 2;
    VkImageBlit blit{};
    blit.srcSubresource = blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    blit.srcOffsets[0] = {x, y, 0};
    blit.srcOffsets[1] = {x + width, y + height, 1};
    const auto left = int32_t(index % kColumns * kWidth), top = int32_t(index / kColumns * kHeight);
    blit.dstOffsets[0] = {left, top, 0};
    blit.dstOffsets[1] = {left + int32_t(kWidth), top + int32_t(kHeight), 1};
    const auto turn = [&](VkImage image, VkImageLayout before, VkImageLayout after, bool ends) {
        constexpr VkPipelineStageFlags kShown =
            VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
        constexpr VkAccessFlags kCopied =
            VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
        constexpr VkAccessFlags kUsed = VK_ACCESS_SHADER_READ_BIT |
                                        VK_ACCESS_COLOR_ATTACHMENT_READ_BIT |
                                        VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
        if (ends)
            sample::imageBarrier(frame.commands, image, before, after,
                                 VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                                 kShown, kUsed);
        else
            sample::imageBarrier(frame.commands, image, before, after, kShown,
                                 VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                                 VK_PIPELINE_STAGE_TRANSFER_BIT, kCopied);
    };
    constexpr VkImageLayout kSampled = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    turn(target.shownImage(), kSampled, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, false);
    turn(pictures_.image, kSampled, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, false);
    vkCmdBlitImage(frame.commands, target.shownImage(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                   pictures_.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit,
                   VK_FILTER_LINEAR);
    turn(target.shownImage(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, kSampled, true);
    turn(pictures_.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, kSampled, true);
}

void FilmStrip::place(uint32_t index, float aspect, ImVec2& low, ImVec2& high) const {
    constexpr float kOwn = float(kWidth) / float(kHeight);
    const float width = std::min(1.0f, aspect / kOwn), height = std::min(1.0f, kOwn / aspect);
    const ImVec2 cell(1.0f / kColumns, 1.0f / kRows);
    const float x = float(index % kColumns), y = float(index / kColumns);
    low = {(x + 0.5f - 0.5f * width) * cell.x, (y + 0.5f - 0.5f * height) * cell.y};
    high = {(x + 0.5f + 0.5f * width) * cell.x, (y + 0.5f + 0.5f * height) * cell.y};
}

}  // namespace fwview
