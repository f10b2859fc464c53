// What a flipbook is baked from: a scene that any thread may render a frame of. Flames that loop
// are the volumetric ones, marched; puffs that happen once are carried by a flow. No files, no
// threads.
#pragma once
#include "book/book.h"

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

namespace fwtools {

using fw::gpu::vec2;
using fw::gpu::vec3;
using fw::gpu::vec4;

struct Frame {                 // rows from the bottom
    std::vector<vec4> texels;  // as Book's, not yet in bytes
    std::vector<vec2> motion;  // uv per frame, by texel; empty: it has to be found
};

struct BakeDef {
    std::string_view scene = "campfire";  // a name of sceneNames
    fw::book::Facts facts;                // motionMost is found
    uint32_t seed = 1;
    uint32_t samples = 2;  // rays per texel, [1, 16]
};

class Scene {
 public:
    virtual ~Scene() = default;
    // Frames to render: of a loop also those that its beginning is faded from.
    [[nodiscard]] virtual uint32_t frames() const = 0;
    virtual void render(uint32_t frame, Frame& out) const = 0;
};

std::vector<std::string_view> sceneNames();
// Whether a scene of this name loops, and what it is of; false: there is none.
bool sceneKind(std::string_view name, fw::book::Facts& facts);
// Of a scene whose name sceneKind knows.
std::unique_ptr<Scene> makeScene(const BakeDef& def);

std::unique_ptr<Scene> makeFlame(const BakeDef& def);  // flame.cpp
std::unique_ptr<Scene> makePuff(const BakeDef& def);   // puff.cpp

}  // namespace fwtools
