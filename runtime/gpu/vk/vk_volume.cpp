// Volumetric flames on their way to the device, and the order in which a view draws them.
#include "gpu/vk/frame_needs.h"
#include "shared/volume_flame.h"

#include <algorithm>
#include <cstring>

namespace fw::gpu::vk {

static_assert(kProfileBytes == kProfileWidth * kProfileHeight * 4);

void VkBackend::setFireProfile(uint32_t slot, std::span<const uint32_t> texels) {
    State& s = *state_;
    if (!s.profiles.live) return;
    PendingUpload& upload = s.stage(kProfileBytes, "fire profile");
    std::memcpy(upload.staging.mapped, texels.data(), kProfileBytes);
    upload.image = s.profiles.image.handle;
    upload.width = kProfileWidth;
    upload.height = kProfileHeight;
    upload.mips = upload.layers = 1;
    upload.firstLayer = kFirePresets + slot;
}

void recordVolumes(VkBackend::State& s, const VolumeUpdate& update, FrameRecorder& recorder,
                   UploadWriter& writer) {
    s.volumes.clear();  // room was made for all of them
    const std::span<const VolumeFlame> flames(update.flames, update.count);
    for (const VolumeFlame& flame : flames) {
        const FlameRecord& record = flame.record;
        vec3 low(1e30f), high(-1e30f);
        for (const FlameNode& node : flame.nodes) {
            if (node.along.w > kFlameTop * record.high.w) break;
            const vec3 reach(kFlameReach * (1.0f + record.puff) * node.centre.w);
            low = glm::min(low, vec3(node.centre) - reach);
            high = glm::max(high, vec3(node.centre) + reach);
        }
        s.volumes.push_back({record.low, record.high, vec4(low, 0.0f), vec4(high, 0.0f),
                             volumeIntervals(flame.nodes, kFlameNodes)});
    }
    if (flames.empty()) return;
    const Staged staged = writer.write(flames);
    recorder.copyIn(staged.at, FW_BIND_VOLUMES, 0, flames.size_bytes());
}

uint32_t VkBackend::State::orderVolumes(
    uint32_t slabs, std::array<VolumeItem, kMaxVolumeFlames>& out) const noexcept {
    if (!profiles.live) return 0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < volumes.size(); ++i) {
        VolumeItem& item = out[count];
        item.flame = i;
        if (!volumeDraw(seen, volumes[i].low, volumes[i].high, slabs, item.draw)) continue;
        volumeSlabs(seen, volumes[i].flameLow, volumes[i].flameHigh, item.draw);
        item.draw.intervals = volumes[i].intervals;
        ++count;
    }
    chooseVolumes({out.data(), count});
    // By their middles: what overlaps in depth has no right order as a whole.
    const auto middle = [](const VolumeItem& item) {
        return item.draw.front + 0.5f * item.draw.deep * float(item.draw.slabs);
    };
    std::sort(out.begin(), out.begin() + count, [&](const VolumeItem& a, const VolumeItem& b) {
        return middle(a) != middle(b) ? middle(a) > middle(b) : a.flame < b.flame;
    });
    return count;
}

}  // namespace fw::gpu::vk
