// What particle fields of water wet: burnable meshes where their cells hold any. By the cells that
// the world steps itself, integers that equal the backend's, never by what is seen of them.
#include "world/world.h"

#include "shared/exchange.h"
#include "shared/field_draw.h"

#include <algorithm>
#include <cmath>

namespace fw::world {
namespace {

constexpr uint32_t kBlock = 4;         // cells of a side that wet as one
constexpr uint32_t kFewest = 6;        // particles of a cell, on average, that wet anything
constexpr uint32_t kGramsOfFull = 40;  // per m^2 and exchange
constexpr float kDepth = 0.125f;       // of a card's width, to both sides

}  // namespace

void World::stepCells(Field& field, uint64_t tick) noexcept {
    if (!field.cells) return;
    const uint32_t steps = components::fieldSteps(field.data, tick - field.began);
    if (field.cells->step >= steps) return;
    const field::FieldRules rules = rulesOf(field.data);
    while (field.cells->step < steps) field::stepField(*field.cells, rules);
}

// At an exchange, before the steps of a frame are planned.
void World::touchByField(Field& field, uint32_t now) {
    if (!field.cells) return;
    stepCells(field, now);
    const components::ParticleField& data = field.data;
    const uint32_t width = data.def.width, height = data.def.height;
    float middle[3], far = 0;
    components::cellPlace(data, 0.5f, 0.5f, middle);
    for (const float side : data.size) far += side * side;
    const float wide = data.size[0] * float(kBlock) / float(width);
    const float tall = data.size[1] * float(kBlock) / float(height);
    const bool card = data.shape == FW_FIELD_CARD;
    FwIgnitionDef def{};
    def.kind = FW_WET;
    def.radius = std::max(0.75f * std::max(card ? wide : 3.1415927f * wide, tall),
                          card ? kDepth * data.size[0] : 0.0f);
    const float reach = std::sqrt(far) + def.radius;
    for (const uint32_t slot : objectsNear(middle, reach)) {
        Object& object = **objects_.at(slot);
        if (object.texels == 0) continue;
        const components::Pose& pose = object.data.pose;
        const float least =
            pose.scale * std::min({std::abs(pose.stretch[0]), pose.stretch[1], pose.stretch[2]});
        float local[3];
        components::toObject(pose, middle, local);
        if (!object.skinMoved && nearTexel(object, local, reach / least) == mesh::kNone) continue;
        for (uint32_t y = 0; y < height; y += kBlock)
            for (uint32_t x = 0; x < width; x += kBlock) {
                uint32_t held = 0;
                const uint32_t endY = std::min(y + kBlock, height), endX = x + kBlock;
                for (uint32_t cy = y; cy < endY; ++cy)
                    for (uint32_t cx = x; cx < endX; ++cx)
                        held += field::cellAt(*field.cells, cx, cy);
                const uint32_t cells = (endY - y) * kBlock;
                if (held < kFewest * cells) continue;
                const uint32_t full = uint32_t(gpu::kFieldFull) * cells;
                def.water = float(std::max(std::min(held, full) * kGramsOfFull / full, 1u));
                components::cellPlace(data, (float(x) + 0.5f * kBlock) / float(width),
                                      0.5f * float(y + endY) / float(height), def.position);
                (void)igniteObject(object, def, now);
            }
    }
}

}  // namespace fw::world
