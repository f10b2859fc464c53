// Fire profiles: resampling, and the cooked file, whose reader trusts nothing.
#include "volume/profile.h"

#include "core/hash.h"
#include "core/stream.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>

namespace fw::volume {
namespace {

using core::wordAt;

constexpr uint32_t kMagic = 0x50465746;  // "FWFP"
constexpr uint32_t kVersion = 1;
constexpr size_t kSumAt = 16, kHeaderBytes = 24;

constexpr uint32_t kW = gpu::kProfileWidth, kH = gpu::kProfileHeight;

float burning(gpu::vec2 v) noexcept { return std::max(std::min(v.x, 1.0f), v.y); }

void checkTexel(float kelvin, float soot, uint32_t x, uint32_t y) {
    if (!(kelvin >= 0.0f && kelvin <= kMaxProfileKelvin))
        core::failData(
            "temperature of texel (%u, %u) of the fire profile is %g K; it must lie in [0, %g].", x,
            y, double(kelvin), double(kMaxProfileKelvin));
    if (!(soot >= 0.0f && soot <= kMaxProfileSoot))
        core::failData("soot of texel (%u, %u) of the fire profile is %g; it must lie in [0, %g].",
                       x, y, double(soot), double(kMaxProfileSoot));
}

void checkSize(uint32_t width, uint32_t height) {
    if (width < kMinProfileSide || width > kMaxProfileSide || height < kMinProfileSide ||
        height > kMaxProfileSide)
        core::failData("the fire profile is %u x %u texels; each side must lie in [%u, %u].", width,
                       height, kMinProfileSide, kMaxProfileSide);
}

// Between texels, clamped at the borders; texel centres are whole numbers.
template <typename Read>
gpu::vec2 bilinear(uint32_t width, uint32_t height, float u, float v, const Read& read) {
    FW_ASSERT(width > 0 && height > 0, "%u x %u texels", width, height);
    u = std::max(u, 0.0f), v = std::max(v, 0.0f);
    const uint32_t x0 = std::min(uint32_t(u), width - 1), x1 = std::min(x0 + 1, width - 1);
    const uint32_t y0 = std::min(uint32_t(v), height - 1), y1 = std::min(y0 + 1, height - 1);
    const float fu = u - float(x0), fv = v - float(y0);
    return glm::mix(glm::mix(read(x0, y0), read(x1, y0), fu),
                    glm::mix(read(x0, y1), read(x1, y1), fu), fv);
}

// `read(x, y)`: a texel of the source. Texel centres on texel centres.
template <typename Read>
void resample(uint32_t width, uint32_t height, const Read& read, Profile& out) {
    Profile made;
    bool burns = false;
    for (uint32_t y = 0; y < kH; ++y)
        for (uint32_t x = 0; x < kW; ++x) {
            const float u = (float(x) + 0.5f) * float(width) / float(kW) - 0.5f;
            const float v = (float(y) + 0.5f) * float(height) / float(kH) - 0.5f;
            const gpu::vec2 texel = bilinear(width, height, u, v, read);
            burns = burns || burning(texel) > 0.0f;
            made.texels[y * kW + x] = glm::packHalf2x16(texel);
        }
    if (!burns)
        core::failData(
            "the fire profile holds neither soot nor hot gas; at least one texel must be above 0.");
    out = made;
}

// Covers everything except the checksum itself.
uint64_t checksum(std::span<const std::byte> bytes) {
    return core::hashBytes(bytes.subspan(kHeaderBytes), core::hashBytes(bytes.first(kSumAt)));
}

}  // namespace

gpu::vec2 Profile::sample(float rho, float y) const noexcept {
    if (y >= 1.0f || y < 0.0f) return gpu::vec2(0.0f);
    const float u = std::min(rho / gpu::kProfileReach * float(kW) - 0.5f, float(kW - 1));
    const float v = std::min(y * float(kH) - 0.5f, float(kH - 1));
    return bilinear(kW, kH, u, v, [&](uint32_t column, uint32_t row) {
        return glm::unpackHalf2x16(texels[row * kW + column]);
    });
}

void paintProfile(std::span<const float> kelvin, std::span<const float> soot, uint32_t width,
                  uint32_t height, Profile& profile) {
    checkSize(width, height);
    const size_t count = size_t(width) * height;
    if (kelvin.size() != count || soot.size() != count)
        core::failData(
            "the fire profile has %zu temperatures and %zu soot values; %u x %u texels need %zu.",
            kelvin.size(), soot.size(), width, height, count);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            checkTexel(kelvin[size_t(y) * width + x], soot[size_t(y) * width + x], x, y);
    const auto texel = [&](uint32_t x, uint32_t y) {
        const size_t k = size_t(y) * width + x;
        return gpu::vec2(0.001f * kelvin[k], soot[k]);
    };
    resample(width, height, texel, profile);
}

std::pmr::vector<std::byte> cookProfile(const Profile& profile, std::pmr::memory_resource* memory) {
    std::pmr::vector<std::byte> out(memory);
    out.reserve(kHeaderBytes + 4 * Profile::kTexels);
    core::Writer writer(out);
    for (const uint32_t word : {kMagic, kVersion, kW, kH}) writer.number(word);
    writer.number(uint64_t(0));
    for (const uint32_t texel : profile.texels) writer.number(texel);
    writer.numberAt(kSumAt, checksum(out));
    return out;
}

void readProfile(std::span<const std::byte> bytes, Profile& profile) {
    core::checkHead(bytes, ".fwprofile", kHeaderBytes, kMagic, kVersion);
    const uint32_t width = wordAt(bytes, 8), height = wordAt(bytes, 12);
    checkSize(width, height);
    const size_t expected = kHeaderBytes + size_t(4) * width * height;
    if (bytes.size() != expected)
        core::failData("the .fwprofile has %zu bytes; %u x %u texels need %zu.", bytes.size(),
                       width, height, expected);
    core::checkSum(".fwprofile", wordAt(bytes, kSumAt) | uint64_t(wordAt(bytes, kSumAt + 4)) << 32,
                   checksum(bytes));
    const auto texel = [&](uint32_t x, uint32_t y) {
        return glm::unpackHalf2x16(wordAt(bytes, kHeaderBytes + 4 * (size_t(y) * width + x)));
    };
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            checkTexel(1000.0f * texel(x, y).x, texel(x, y).y, x, y);
    resample(width, height, texel, profile);
}

}  // namespace fw::volume
