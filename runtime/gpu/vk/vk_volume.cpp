// Volumetric flames on their way to the device, and the order in which a view draws them.
#include "core/error.h"
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
        VkBackend::State::VolumeBox box{
            record.low, record.high, {}, {}, volumeIntervals(flame.nodes, kFlameNodes)};
        volumeBounds(record, flame.nodes, kFlameNodes, box.flameLow, box.flameHigh);
        s.volumes.push_back(box);
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

namespace {

// Whether what was marched for one view is what another shows.
bool sameView(const FwView& a, const FwView& b) noexcept {
    const auto same = [](const auto& x, const auto& y) {
        return std::memcmp(&x, &y, sizeof x) == 0;
    };
    return same(a.view, b.view) && same(a.projection, b.projection) &&
           same(a.sunColor, b.sunColor) && same(a.ambientSky, b.ambientSky) &&
           same(a.ambientGround, b.ambientGround) && same(a.exposure, b.exposure) &&
           same(a.emissionScale, b.emissionScale);
}

}  // namespace

VolumeScreen VkBackend::State::screenOf(const TargetKey& target, vec2 size) const noexcept {
    return {size, target.depthMode == FW_DEPTH_NONE ? 1 : kVolumeSlabs, limits.volumeCell,
            limits.volumeSteps, uint32_t(target.encoding)};
}

void VkBackend::State::noteScreen(const FwView& view, const VolumeScreen& screen,
                                  uint64_t frame) noexcept {
    if (!sameView(view, outside)) return;
    const auto area = [](const VolumeScreen& s) { return s.size.x * s.size.y; };
    if (march.frame == frame && area(screen) <= area(march.screen)) return;
    march.screen = screen;
    march.frame = frame;
}

void VkBackend::State::makeMarchRoom(uint64_t last) {
    if (!profiles.live) return;
    try {
        planes.atLeast(kSpaceVolumeRays, volumeRayWords(march.screen), last);
    } catch (const core::Error& error) {
        if (error.result != FW_ERROR_OUT_OF_MEMORY) throw;
    }
}

void VkBackend::State::marchVolumes(FrameRecorder& recorder) noexcept {
    march.count = 0;
    if (!(march.screen.size.x >= 1.0f && march.screen.size.y >= 1.0f)) return;
    std::array<VolumeItem, kMaxVolumeFlames> items;
    const uint32_t count = orderVolumes(march.screen.slabs, items);
    if (count == 0) return;
    // `seen` is a view of one pixel.
    const uint32_t words =
        layVolumes({items.data(), count}, march.screen, seen.eye.w / march.screen.size.y,
                   planes.capacity(kSpaceVolumeRays), march.items);
    if (words == 0) return;
    march.made = march.screen;
    march.view = outside;
    march.count = count;
    recordVolumeMarch(recorder, {march.items.data(), count}, words);
}

std::span<const MarchedVolume> VkBackend::State::marchedFor(const FwView& view,
                                                            const VolumeScreen& screen) noexcept {
    if (march.count == 0 || !(screen == march.made) || !sameView(view, march.view)) return {};
    return {march.items.data(), march.count};
}

}  // namespace fw::gpu::vk
