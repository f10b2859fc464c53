#include "sample.h"

#include "core/assert.h"

#include <algorithm>
#include <cmath>

namespace fw::flipbook {
namespace {

// Four texels around uv of a layer of `channels` bytes, bilinear.
template <int kChannels>
vec4 lookup(const uint8_t* layer, uint32_t width, uint32_t height, vec2 uv, bool clamped) {
    const float x = uv.x * float(width) - 0.5f, y = uv.y * float(height) - 0.5f;
    const float lowX = std::floor(x), lowY = std::floor(y);
    vec4 sum(0.0f);
    for (int k = 0; k < 4; ++k) {
        int i = int(lowX) + k % 2, j = int(lowY) + k / 2;
        const float share = (k % 2 ? x - lowX : 1 - x + lowX) * (k / 2 ? y - lowY : 1 - y + lowY);
        const bool inside = i >= 0 && j >= 0 && i < int(width) && j < int(height);
        if (!inside && !clamped) continue;
        i = std::clamp(i, 0, int(width) - 1), j = std::clamp(j, 0, int(height) - 1);
        const uint8_t* texel = layer + kChannels * (size_t(j) * width + size_t(i));
        for (int c = 0; c < kChannels; ++c) sum[c] += share * float(texel[c]) / 255.0f;
    }
    return sum;
}

}  // namespace

vec4 frameAt(const Flipbook& book, uint32_t frame, vec2 uv) noexcept {
    const Facts& f = book.facts;
    FW_ASSERT(frame < f.frames && book.texels.size() == size_t(4) * f.width * f.height * f.frames,
              "frame %u of %u", frame, f.frames);
    return lookup<4>(book.texels.data() + size_t(4) * f.width * f.height * frame, f.width, f.height,
                     uv, false);
}

vec2 motionAt(const Flipbook& book, uint32_t frame, vec2 uv) noexcept {
    const Facts& f = book.facts;
    FW_ASSERT(frame < f.frames &&
                  book.motion.size() == size_t(2) * f.motionWidth * f.motionHeight * f.frames,
              "frame %u of %u", frame, f.frames);
    const vec4 m =
        lookup<2>(book.motion.data() + size_t(2) * f.motionWidth * f.motionHeight * frame,
                  f.motionWidth, f.motionHeight, uv, true);
    return gpu::decodeFlipbookMotion(vec2(m), f.maxMotion);
}

vec4 sampleFlipbook(const Flipbook& book, float time, vec2 uv) noexcept {
    const gpu::FlipbookPlace p =
        gpu::flipbookPlaceAt(time, book.facts.frames, book.facts.loops != 0);
    const vec2 before = gpu::flipbookUvBefore(uv, motionAt(book, p.before, uv), p.part);
    const vec2 after = gpu::flipbookUvAfter(uv, motionAt(book, p.after, uv), p.part);
    return gpu::mixFlipbookTexels(frameAt(book, p.before, before), frameAt(book, p.after, after),
                                  p.part);
}

}  // namespace fw::flipbook
