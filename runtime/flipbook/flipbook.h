// A flipbook: side views of fire, smoke or sparks for particles and distant fires, with the motion
// between frames; its file (.fwbook) and reader. editor/tools bakes flipbooks.
#pragma once
#include "host_limits.h"
#include "shared/flipbook.h"

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace fw::flipbook {

constexpr uint32_t kMinSide = 8, kMaxSide = limits::kFlipbookSide,
                   kMaxFrames = limits::kFlipbookFrames;

enum class Kind : uint32_t { Fire, Smoke, Spark };
constexpr uint32_t kKinds = 3;

struct Facts {
    Kind kind = Kind::Fire;
    uint32_t loops = 1;                            // 0: plays once
    uint32_t width = 128, height = 128;            // texels of a frame, [8, 512]
    uint32_t frames = 64;                          // [2, 256]
    uint32_t motionWidth = 64, motionHeight = 64;  // [1, width], [1, height]
    float maxMotion = 0.0f;                        // uv per frame of a full motion texel, [0, 1]
    float seconds = 2.0f;                          // s, length, (0, 600]
};

struct Rect {  // texels, the ends not included
    uint16_t left = 0, low = 0, right = 0, high = 0;
};

// Rows from the bottom, frame after frame.
struct Flipbook {
    explicit Flipbook(std::pmr::memory_resource* memory)
        : texels(memory), motion(memory), rects(memory) {}
    Facts facts;
    // RGBA8: temperature (flipbookKelvin), opacity of glowing soot, total opacity, thickness
    // (1 - exp(-tau / 4)).
    std::pmr::vector<uint8_t> texels;
    std::pmr::vector<uint8_t> motion;  // RG8, decodeFlipbookMotion
    std::pmr::vector<Rect> rects;      // per frame: the visible part of it and of the next
};

// Throws core::Error naming the field, the value and the limit.
void checkFacts(const Facts& facts);

// .fwbook, little-endian: u32 magic 'FWBK', u32 version, u64 FNV-1a of the rest; u32 kind,
// loops, width, height, frames, motionWidth, motionHeight, f32 maxMotion, seconds, u32 0; rects
// (four u16 each), texels, motion.
std::pmr::vector<std::byte> cookFlipbook(const Flipbook& flipbook,
                                         std::pmr::memory_resource* memory);
// Throws core::Error; `book` is then unchanged.
void readFlipbook(std::span<const std::byte> bytes, Flipbook& flipbook);

// Whether no texel absorbs light: particles then add to the background in any order.
bool emitsAlone(const Flipbook& flipbook) noexcept;

}  // namespace fw::flipbook
