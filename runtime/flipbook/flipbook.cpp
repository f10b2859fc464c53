// The flipbook file, whose reader trusts nothing.
#include "flipbook/flipbook.h"

#include "core/hash.h"
#include "core/stream.h"

#include <span>

namespace fw::flipbook {
namespace {

constexpr uint32_t kMagic = 0x4B425746;  // "FWBK"
constexpr uint32_t kVersion = 1;
constexpr size_t kSumAt = 8, kSumEnd = 16, kHeaderBytes = kSumEnd + 40;

// The numbers of a head behind its checksum, in their order.
template <class Stream, class F>
void visitFacts(Stream& stream, F& f) {
    auto kind = uint32_t(f.kind), unused = 0u;
    const auto visit = [&](auto&... numbers) { (stream.number(numbers), ...); };
    visit(kind, f.loops, f.width, f.height, f.frames, f.motionWidth, f.motionHeight, f.maxMotion,
          f.seconds, unused);
    if constexpr (Stream::kReads) f.kind = Kind(kind);
    if (unused != 0) core::failData("the flipbook's reserved word is %u; it is zero.", unused);
}
template <class Stream, class R>
void visitRect(Stream& stream, R& r) {
    stream.number(r.left), stream.number(r.low), stream.number(r.right), stream.number(r.high);
}

void check(const char* name, double value, double low, double high) {
    if (!(value >= low && value <= high))
        core::failData("the flipbook's %s is %g; it must lie in [%g, %g].", name, value, low, high);
}

struct Sizes {
    size_t texels, motion;
};
Sizes sizesOf(const Facts& f) {
    return {size_t(4) * f.width * f.height * f.frames,
            size_t(2) * f.motionWidth * f.motionHeight * f.frames};
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

std::pmr::vector<std::byte> cookFlipbook(const Flipbook& flipbook,
                                         std::pmr::memory_resource* memory) {
    const Facts& f = flipbook.facts;
    checkFacts(f);
    const Sizes sizes = sizesOf(f);
    if (flipbook.texels.size() != sizes.texels || flipbook.motion.size() != sizes.motion ||
        flipbook.rects.size() != f.frames)
        core::failData(
            "the flipbook has %zu, %zu and %zu bytes of texels, motion and rects; it needs %zu, "
            "%zu and %zu.",
            flipbook.texels.size(), flipbook.motion.size(), flipbook.rects.size() * sizeof(Rect),
            sizes.texels, sizes.motion, f.frames * sizeof(Rect));
    std::pmr::vector<std::byte> out(memory);
    out.reserve(kHeaderBytes + f.frames * sizeof(Rect) + sizes.texels + sizes.motion);
    core::Writer writer(out);
    writer.number(kMagic), writer.number(kVersion), writer.number(uint64_t(0));
    visitFacts(writer, f);
    for (const Rect& rect : flipbook.rects) visitRect(writer, rect);
    for (const std::span<const uint8_t> plane :
         {std::span(flipbook.texels), std::span(flipbook.motion)})
        for (const uint8_t byte : plane) out.push_back(std::byte(byte));
    writer.numberAt(kSumAt, core::hashBytes(std::span(out).subspan(kSumEnd)));
    return out;
}

void readFlipbook(std::span<const std::byte> bytes, Flipbook& flipbook) {
    core::checkHead(bytes, ".fwbook", kHeaderBytes, kMagic, kVersion);
    core::Reader reader(bytes.subspan(kSumAt), ".fwbook");
    Flipbook made(flipbook.texels.get_allocator().resource());
    Facts& f = made.facts;
    uint64_t sum = 0;
    reader.number(sum);
    visitFacts(reader, f);
    checkFacts(f);
    const Sizes sizes = sizesOf(f);
    const size_t expected = kHeaderBytes + f.frames * sizeof(Rect) + sizes.texels + sizes.motion;
    if (bytes.size() != expected)
        core::failData("the .fwbook has %zu bytes; %u frames of %u x %u need %zu.", bytes.size(),
                       f.frames, f.width, f.height, expected);
    core::checkSum(".fwbook", sum, core::hashBytes(bytes.subspan(kSumEnd)));
    made.rects.resize(f.frames);
    for (Rect& r : made.rects) {
        visitRect(reader, r);
        if (r.left > r.right || r.right > f.width || r.low > r.high || r.high > f.height)
            core::failData(
                "the flipbook's rect %zu is [%u, %u) x [%u, %u); a frame has %u x %u texels.",
                size_t(&r - made.rects.data()), r.left, r.right, r.low, r.high, f.width, f.height);
    }
    const auto take = [&](size_t size, std::pmr::vector<uint8_t>& plane) {
        const auto* from = reinterpret_cast<const uint8_t*>(reader.take(size).data());
        plane.assign(from, from + size);
    };
    take(sizes.texels, made.texels);
    take(sizes.motion, made.motion);
    flipbook = std::move(made);
}

bool emitsAlone(const Flipbook& flipbook) noexcept {
    for (size_t i = 2; i < flipbook.texels.size(); i += 4)
        if (flipbook.texels[i] != 0) return false;
    return true;
}

}  // namespace fw::flipbook
