// Source of a flipbook: a scene whose frames can be rendered on any thread. Looping flames are
// ray-marched volumes; one-shot puffs are advected by a flow. No files, no threads.
#pragma once
#include "flipbook/flipbook.h"

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

namespace fwtools {

using fw::gpu::vec2;
using fw::gpu::vec3;
using fw::gpu::vec4;

struct Frame {                 // rows from the bottom
    std::vector<vec4> texels;  // as in the flipbook, before encoding
    std::vector<vec2> motion;  // uv per frame, by texel; empty: unknown
};

struct BakeDef {
    std::string_view scene = "campfire";  // one of sceneNames
    fw::flipbook::Facts facts;            // maxMotion is computed
    uint32_t seed = 1;
    uint32_t samples = 2;  // rays per texel, [1, 16]
};

class Scene {
 public:
    virtual ~Scene() = default;
    // Number of frames to render, including those that fade into a loop's start.
    [[nodiscard]] virtual uint32_t frames() const = 0;
    virtual void render(uint32_t frame, Frame& out) const = 0;
};

std::vector<std::string_view> sceneNames();
// Fills kind and loop flag of a named scene. Returns false for an unknown name.
bool sceneKind(std::string_view name, fw::flipbook::Facts& facts);
// The name must be valid, see sceneKind.
std::unique_ptr<Scene> makeScene(const BakeDef& def);

std::unique_ptr<Scene> makeFlame(const BakeDef& def);  // flame.cpp
std::unique_ptr<Scene> makePuff(const BakeDef& def);   // puff.cpp

}  // namespace fwtools
