#include "gpu/vk/timers.h"

#include <algorithm>
#include <cstring>

namespace fw::gpu::vk {

void FrameTimers::create(Device& device) {
    if (!device.timestamps || pool_) return;
    Typed<VkQueryPoolCreateInfo> info;
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = kMaxSpans * 2;
    pool_ = device.create(device.table.CreateQueryPool, info, "vkCreateQueryPool");
}

void FrameTimers::destroy(Device& device) noexcept {
    device.destroy(device.table.DestroyQueryPool, pool_);
}

void FrameTimers::reset(const Device& device, VkCommandBuffer commands) {
    spans_ = 0;
    open_ = false;
    armed_ = pool_ != VK_NULL_HANDLE;
    if (armed_) device.table.CmdResetQueryPool(commands, pool_, 0, kMaxSpans * 2);
}

void FrameTimers::begin(const Device& device, VkCommandBuffer commands, const char* name) {
    if (device.debugUtils && device.table.CmdBeginDebugUtilsLabelEXT) {
        Typed<VkDebugUtilsLabelEXT> label;
        label.pLabelName = name;
        device.table.CmdBeginDebugUtilsLabelEXT(commands, &label);
    }
    open_ = armed_ && spans_ < kMaxSpans;
    if (!open_) return;
    names_[spans_] = name;
    device.table.CmdWriteTimestamp(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, pool_, spans_ * 2);
}

void FrameTimers::end(const Device& device, VkCommandBuffer commands) {
    if (open_) {
        device.table.CmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, pool_,
                                       spans_ * 2 + 1);
        ++spans_;
        open_ = false;
    }
    if (device.debugUtils && device.table.CmdEndDebugUtilsLabelEXT)
        device.table.CmdEndDebugUtilsLabelEXT(commands);
}

void FrameTimers::read(Device& device, uint64_t frameIndex, std::pmr::vector<PassTime>& out) {
    if (spans_ == 0) return;
    std::array<uint64_t, kMaxSpans * 2> stamps{};
    const VkResult result = device.table.GetQueryPoolResults(
        device.handle, pool_, 0, spans_ * 2, spans_ * 2 * sizeof(uint64_t), stamps.data(),
        sizeof(uint64_t), VK_QUERY_RESULT_64_BIT);
    const uint32_t spans = spans_;
    spans_ = 0;
    if (result == VK_ERROR_DEVICE_LOST) device.notifyLost();
    if (result != VK_SUCCESS) return;  // the host's word was early: no times rather than a wait
    out.clear();
    const double period = double(device.properties.limits.timestampPeriod) * 1e-6;
    for (uint32_t i = 0; i < spans; ++i) {
        const auto same = [&](const PassTime& time) {
            return std::strcmp(time.name, names_[i]) == 0;
        };
        auto at = std::find_if(out.begin(), out.end(), same);
        if (at == out.end()) {
            PassTime fresh;
            std::strncpy(fresh.name, names_[i], sizeof fresh.name - 1);
            fresh.frameIndex = frameIndex;
            at = out.insert(out.end(), fresh);
        }
        at->milliseconds += double(stamps[i * 2 + 1] - stamps[i * 2]) * period;
        at->count += 1;
    }
}

float sumOf(std::span<const PassTime> times, uint64_t frameIndex) noexcept {
    double sum = 0;
    bool any = false;
    for (const PassTime& time : times) {
        if (time.frameIndex != frameIndex) continue;
        sum += time.milliseconds;
        any = true;
    }
    return any ? float(sum) : -1.0f;
}

}  // namespace fw::gpu::vk
