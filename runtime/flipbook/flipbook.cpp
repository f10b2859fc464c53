// Flipbooks: the file, whose reader trusts nothing, and samples.
#include "flipbook/flipbook.h"

#include "core/hash.h"
#include "core/stream.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace fw::flipbook {
namespace {

constexpr uint32_t kMagic = 0x4B425746;  // "FWBK"
constexpr uint32_t kVersion = 1;
constexpr size_t kSumEnd = 16, kHeaderBytes = kSumEnd + 40;

using core::wordAt;

float floatAt(std::span<const std::byte> bytes, size_t at) {
    const uint32_t word = wordAt(bytes, at);
    float value = 0;
    std::memcpy(&value, &word, 4);
    return value;
}

void check(const char* name, double value, double low, double high) {
    if (!(value >= low && value <= high))
        core::failData("the book's %s is %g; it must lie in [%g, %g].", name, value, low, high);
}

struct Sizes {
    size_t texels, motion;
};
Sizes sizesOf(const Facts& f) {
    return {size_t(4) * f.width * f.height * f.frames,
            size_t(2) * f.motionWidth * f.motionHeight * f.frames};
}

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

void checkFacts(const Facts& f) {
    check("kind", double(f.kind), 0, kKinds - 1);
    check("loops", f.loops, 0, 1);
    check("width", f.width, kMinSide, kMaxSide);
    check("height", f.height, kMinSide, kMaxSide);
    check("frames", f.frames, 2, kMaxFrames);
    check("motionWidth", f.motionWidth, 1, f.width);
    check("motionHeight", f.motionHeight, 1, f.height);
    check("maxMotion", double(f.maxMotion), 0, 1);
    check("seconds", double(f.seconds), 1e-3, 600);
}

std::pmr::vector<std::byte> cookFlipbook(const Flipbook& book, std::pmr::memory_resource* memory) {
    const Facts& f = book.facts;
    checkFacts(f);
    const Sizes sizes = sizesOf(f);
    if (book.texels.size() != sizes.texels || book.motion.size() != sizes.motion ||
        book.rects.size() != f.frames)
        core::failData(
            "the book has %zu, %zu and %zu bytes of texels, motion and rects; it needs %zu, "
            "%zu and %zu.",
            book.texels.size(), book.motion.size(), book.rects.size() * sizeof(Rect), sizes.texels,
            sizes.motion, f.frames * sizeof(Rect));
    std::pmr::vector<std::byte> out(memory);
    out.reserve(kHeaderBytes + f.frames * sizeof(Rect) + sizes.texels + sizes.motion);
    const auto put = [&](uint64_t value, uint32_t bytes) {
        for (uint32_t k = 0; k < bytes; ++k) out.push_back(std::byte(value >> (8 * k)));
    };
    const auto putFloat = [&](float value) {
        uint32_t word = 0;
        std::memcpy(&word, &value, 4);
        put(word, 4);
    };
    put(kMagic, 4), put(kVersion, 4), put(0, 8);
    for (const uint32_t word :
         {uint32_t(f.kind), f.loops, f.width, f.height, f.frames, f.motionWidth, f.motionHeight})
        put(word, 4);
    putFloat(f.maxMotion), putFloat(f.seconds), put(0, 4);
    for (const Rect& r : book.rects) put(r.left, 2), put(r.low, 2), put(r.right, 2), put(r.high, 2);
    for (const uint8_t byte : book.texels) out.push_back(std::byte(byte));
    for (const uint8_t byte : book.motion) out.push_back(std::byte(byte));
    const uint64_t sum = core::hashBytes(std::span(out).subspan(kSumEnd));
    for (uint32_t k = 0; k < 8; ++k) out[8 + k] = std::byte(sum >> (8 * k));
    return out;
}

void readFlipbook(std::span<const std::byte> bytes, Flipbook& book) {
    if (bytes.size() < kHeaderBytes)
        core::failData("the .fwbook has %zu bytes; its header alone has %zu.", bytes.size(),
                       kHeaderBytes);
    if (wordAt(bytes, 0) != kMagic)
        core::failData("the .fwbook begins with 0x%08x; it must begin with 0x%08x.",
                       wordAt(bytes, 0), kMagic);
    if (wordAt(bytes, 4) != kVersion)
        core::fail(FW_ERROR_VERSION, "the .fwbook has version %u; this library reads version %u.",
                   wordAt(bytes, 4), kVersion);
    Facts f;
    f.kind = Kind(wordAt(bytes, 16));
    f.loops = wordAt(bytes, 20);
    f.width = wordAt(bytes, 24), f.height = wordAt(bytes, 28);
    f.frames = wordAt(bytes, 32);
    f.motionWidth = wordAt(bytes, 36), f.motionHeight = wordAt(bytes, 40);
    f.maxMotion = floatAt(bytes, 44), f.seconds = floatAt(bytes, 48);
    checkFacts(f);
    if (wordAt(bytes, 52) != 0)
        core::failData("the book's reserved word is %u; it is zero.", wordAt(bytes, 52));
    const Sizes sizes = sizesOf(f);
    const size_t expected = kHeaderBytes + f.frames * sizeof(Rect) + sizes.texels + sizes.motion;
    if (bytes.size() != expected)
        core::failData("the .fwbook has %zu bytes; %u frames of %u x %u need %zu.", bytes.size(),
                       f.frames, f.width, f.height, expected);
    const uint64_t sum = wordAt(bytes, 8) | uint64_t(wordAt(bytes, 12)) << 32;
    const uint64_t found = core::hashBytes(bytes.subspan(kSumEnd));
    if (sum != found)
        core::failData("the .fwbook's checksum is 0x%016llx; its content has 0x%016llx.",
                       static_cast<unsigned long long>(sum),
                       static_cast<unsigned long long>(found));
    Flipbook made(book.texels.get_allocator().resource());
    made.facts = f;
    made.rects.resize(f.frames);
    made.texels.resize(sizes.texels);
    made.motion.resize(sizes.motion);
    size_t at = kHeaderBytes;
    for (uint32_t i = 0; i < f.frames; ++i, at += sizeof(Rect)) {
        const uint32_t low = wordAt(bytes, at), high = wordAt(bytes, at + 4);
        const Rect r{uint16_t(low), uint16_t(low >> 16), uint16_t(high), uint16_t(high >> 16)};
        if (r.left > r.right || r.right > f.width || r.low > r.high || r.high > f.height)
            core::failData("the book's rect %u is [%u, %u) x [%u, %u); a frame has %u x %u texels.",
                           i, r.left, r.right, r.low, r.high, f.width, f.height);
        made.rects[i] = r;
    }
    std::memcpy(made.texels.data(), bytes.data() + at, sizes.texels);
    std::memcpy(made.motion.data(), bytes.data() + at + sizes.texels, sizes.motion);
    book = std::move(made);
}

bool emitsAlone(const Flipbook& book) noexcept {
    for (size_t i = 2; i < book.texels.size(); i += 4)
        if (book.texels[i] != 0) return false;
    return true;
}

vec4 frameAt(const Flipbook& book, uint32_t frame, vec2 uv) noexcept {
    const Facts& f = book.facts;
    FW_ASSERT(frame < f.frames && book.texels.size() == sizesOf(f).texels, "frame %u of %u", frame,
              f.frames);
    return lookup<4>(book.texels.data() + size_t(4) * f.width * f.height * frame, f.width, f.height,
                     uv, false);
}

vec2 motionAt(const Flipbook& book, uint32_t frame, vec2 uv) noexcept {
    const Facts& f = book.facts;
    FW_ASSERT(frame < f.frames && book.motion.size() == sizesOf(f).motion, "frame %u of %u", frame,
              f.frames);
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
