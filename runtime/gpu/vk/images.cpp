// Base colours and appearance textures: images with their mips, and their way to the device.
#include "core/error.h"
#include "gpu/vk/backend_state.h"
#include "gpu/vk/device_objects.h"
#include "shared/volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace fw::gpu::vk {
namespace {

uint32_t mipsOf(uint32_t width, uint32_t height) noexcept {
    uint32_t mips = 1;
    while (std::max(width, height) >> mips) ++mips;
    return mips;
}

// Box-filtered RGBA8 sRGB mips in linear light, appended one behind the other.
struct SrgbTable {
    float toLinear[256];
    SrgbTable() {
        for (int i = 0; i < 256; ++i) {
            const float s = float(i) / 255.0f;
            toLinear[i] = s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
        }
    }
    static std::byte fromLinear(float value) {
        const float s =
            value <= 0.0031308f ? value * 12.92f : 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f;
        return std::byte(std::clamp(int(s * 255.0f + 0.5f), 0, 255));
    }
};

// `byAlpha`: transparent pixels do not change the colour.
void halveSrgb(const SrgbTable& table, const std::byte* from, uint32_t width, uint32_t height,
               std::byte* to, bool byAlpha) {
    const uint32_t w = std::max(width / 2, 1u), h = std::max(height / 2, 1u);
    for (uint32_t y = 0; y < h; ++y) {
        for (uint32_t x = 0; x < w; ++x) {
            const uint32_t x0 = std::min(x * 2, width - 1), x1 = std::min(x * 2 + 1, width - 1);
            const uint32_t y0 = std::min(y * 2, height - 1), y1 = std::min(y * 2 + 1, height - 1);
            const std::byte* taps[4] = {
                from + (size_t(y0) * width + x0) * 4, from + (size_t(y0) * width + x1) * 4,
                from + (size_t(y1) * width + x0) * 4, from + (size_t(y1) * width + x1) * 4};
            std::byte* out = to + (size_t(y) * w + x) * 4;
            uint32_t alpha = 0;
            for (const std::byte* tap : taps) alpha += uint8_t(tap[3]);
            const bool weighted = byAlpha && alpha > 0;
            for (int c = 0; c < 3; ++c) {
                float sum = 0;
                for (const std::byte* tap : taps)
                    sum += table.toLinear[uint8_t(tap[c])] *
                           (weighted ? float(uint8_t(tap[3])) / float(alpha) : 0.25f);
                out[c] = SrgbTable::fromLinear(sum);
            }
            out[3] = std::byte((alpha + 2) / 4);
        }
    }
}

// Transparent pixels take the colour of the next coarser level, so that the surroundings of a
// cut-out do not shine through its edge.
void fillGone(std::byte* pixels, uint32_t width, uint32_t height, const std::byte* coarser) {
    const uint32_t w = std::max(width / 2, 1u), h = std::max(height / 2, 1u);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            std::byte* pixel = pixels + (size_t(y) * width + x) * 4;
            if (pixel[3] != std::byte(0)) continue;
            const size_t at = size_t(std::min(y / 2, h - 1)) * w + std::min(x / 2, w - 1);
            std::copy_n(coarser + at * 4, 3, pixel);
        }
}

// Alpha in units in which 128 is where the picture begins: of `share` of the pixels it is so much
// or more. Mips would else lose thin leaves, or grow them together (Castano 2010, "Computing alpha
// mipmaps").
void centreAlpha(std::byte* pixels, size_t count, double share) {
    size_t histogram[256] = {};
    for (size_t i = 0; i < count; ++i) ++histogram[uint8_t(pixels[i * 4 + 3])];
    const double wanted = share * double(count);
    uint32_t cutoff = 255;
    double above = double(histogram[255]);
    while (cutoff > 1 &&
           std::abs(above + double(histogram[cutoff - 1]) - wanted) <= std::abs(above - wanted))
        above += double(histogram[--cutoff]);
    for (size_t i = 0; i < count; ++i) {
        const uint32_t alpha = uint8_t(pixels[i * 4 + 3]);
        const uint32_t centred = alpha >= cutoff
                                     ? 128 + 127 * (alpha - cutoff) / std::max(255 - cutoff, 1u)
                                     : 127 * alpha / cutoff;
        pixels[i * 4 + 3] = std::byte(std::min(centred, 255u));
    }
}

}  // namespace

void addImage(BackendState& s, ImageEntry& entry, uint32_t width, uint32_t height, uint32_t layers,
              uint32_t mips, VkFormat format, std::span<const std::byte> pixels, const char* name) {
    FW_ASSERT(!entry.live, "%s", name);
    s.retired.promise(1);
    VkImageCreateInfo info = imageInfo(
        format, width, height, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    info.mipLevels = mips;
    info.arrayLayers = layers;
    ImageEntry fresh;
    try {
        fresh.image =
            s.deviceMemory.createImage(info, VK_IMAGE_ASPECT_COLOR_BIT, kComponentImages, name);
        fresh.set = makeImageSet(s.device, s.context.pipelines, fresh.image.view);
        PendingUpload& upload = s.scene.uploads.stage(pixels.size(), name);
        std::memcpy(upload.staging.mapped, pixels.data(), pixels.size());
        upload.image = fresh.image.handle;
        upload.width = width;
        upload.height = height;
        upload.mips = mips;
        upload.layers = layers;
    } catch (...) {
        destroyImage(s, fresh);
        throw;
    }
    fresh.live = true;
    entry = fresh;
}

void destroyImage(BackendState& s, ImageEntry& entry) noexcept {
    s.deviceMemory.destroy(entry.image);
    s.device.destroy(s.device.table.DestroyDescriptorPool, entry.set.pool);
}

void dropImage(BackendState& s, ImageEntry& entry) noexcept {
    s.scene.uploads.dropFor(entry.image.handle);
    s.retired.push(s.ring.newest(), {.image = entry.image, .pool = entry.set.pool});
    entry = {};
}

void VkBackend::createImage(uint32_t slot, uint32_t width, uint32_t height,
                            std::span<const std::byte> pixels, float alphaCutoff) {
    BackendState& s = *state_;
    const uint32_t most = s.device.properties.limits.maxImageDimension2D;
    if (width > most || height > most)
        core::refuse("The image is %u x %u pixels; the device's maxImageDimension2D is %u.", width,
                     height, most);
    ImageEntry& entry = slotOf(s.scene.images, slot);
    const uint32_t mips = mipsOf(width, height);
    const auto sizeOf = [&](uint32_t mip) {
        return std::pair(std::max(width >> mip, 1u), std::max(height >> mip, 1u));
    };
    std::array<size_t, 33> starts{};  // of each mip, and their end
    for (uint32_t mip = 0; mip < mips; ++mip) {
        const auto [w, h] = sizeOf(mip);
        starts[mip + 1] = starts[mip] + size_t(w) * h * 4;
    }
    std::pmr::vector<std::byte> all(starts[mips], s.memory);
    std::memcpy(all.data(), pixels.data(), size_t(width) * height * 4);
    const bool cutOut = alphaCutoff > 0;
    const SrgbTable table;
    for (uint32_t mip = 0; mip + 1 < mips; ++mip) {
        const auto [w, h] = sizeOf(mip);
        halveSrgb(table, all.data() + starts[mip], w, h, all.data() + starts[mip + 1], cutOut);
    }
    if (cutOut) {
        for (uint32_t mip = mips - 1; mip-- > 0;) {
            const auto [w, h] = sizeOf(mip);
            fillGone(all.data() + starts[mip], w, h, all.data() + starts[mip + 1]);
        }
        const size_t count = size_t(width) * height;
        size_t there = 0;
        for (size_t i = 0; i < count; ++i)
            there += float(uint8_t(pixels[i * 4 + 3])) >= alphaCutoff * 255;
        for (uint32_t mip = 0; mip < mips; ++mip) {
            const auto [w, h] = sizeOf(mip);
            centreAlpha(all.data() + starts[mip], size_t(w) * h, double(there) / double(count));
        }
    } else {
        for (size_t i = 3; i < all.size(); i += 4) all[i] = std::byte(255);
    }
    addImage(s, entry, width, height, 1, mips, VK_FORMAT_R8G8B8A8_SRGB, all, "base colour");
}

void VkBackend::setFlipbooks(uint32_t width, uint32_t height, std::span<const std::byte> texels,
                             std::span<const uint32_t> words) {
    BackendState& s = *state_;
    if (!s.scene.appearanceTextures.live) return;  // nothing is ever drawn
    ImageEntry fresh;
    if (width > 0) {
        UploadGuard staged(s.scene.uploads);
        s.scene.uploads.stage(words.size_bytes(), "flipbooks").add(FW_BIND_FLIPBOOKS, 0, words);
        addImage(s, fresh, width, height, 1, 1, VK_FORMAT_R8G8B8A8_UNORM, texels, "flipbooks");
        staged.keep();
    }
    if (s.scene.flipbooks.live) dropImage(s, s.scene.flipbooks);
    s.scene.flipbooks = fresh;
}

// A fire profile of the host's comes behind those of presets.
void VkBackend::setFireProfile(uint32_t slot, std::span<const uint32_t> texels) {
    static_assert(kProfileBytes == kProfileWidth * kProfileHeight * 4);
    SceneTables& scene = state_->scene;
    if (!scene.profiles.live) return;
    FW_ASSERT(slot < kMaxFireProfiles && texels.size_bytes() >= kProfileBytes,
              "profile %u of %zu bytes", slot, texels.size_bytes());
    PendingUpload& upload = scene.uploads.stage(kProfileBytes, "fire profile");
    std::memcpy(upload.staging.mapped, texels.data(), kProfileBytes);
    upload.image = scene.profiles.image.handle;
    upload.width = kProfileWidth;
    upload.height = kProfileHeight;
    upload.firstLayer = kFirePresets + slot;
}

void VkBackend::destroyImage(uint32_t slot) {
    BackendState& s = *state_;
    ImageEntry& entry = s.scene.images[slot];
    if (!entry.live) return;
    const auto shows = [&](uint32_t image) { return image == slot + 1; };
    DrawPassSet passes = 0;
    for (const ObjectEntry& object : s.scene.objects)
        for (uint32_t m = 0; m < kMaterialsPerObject; ++m)
            if (shows(object.images[m]))
                passes |= surfacePasses(s.limits.appearances.familyOf(object.materials[m]), false);
    s.context.pipelines.need(passes);
    dropImage(s, entry);
    for (uint32_t i = 0; i < s.scene.objects.size(); ++i) {
        ObjectEntry& object = s.scene.objects[i];
        if (std::none_of(std::begin(object.images), std::end(object.images), shows)) continue;
        std::replace_if(std::begin(object.images), std::end(object.images), shows, 0u);
        s.scene.changed(i);
    }
}

}  // namespace fw::gpu::vk
