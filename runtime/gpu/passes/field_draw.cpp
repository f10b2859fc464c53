// Particle fields of one view: a draw each, farthest first. What emits alone, what absorbs and what
// refracts are variants, so that none pays for another.
#include "shared/field_draw.h"
#include "gpu/passes/blend_order.h"
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kFieldDrawUses[] = {
    {FW_BIND_VIEW, Access::uniformView},
    {FW_BIND_FIELD_SHOWN, Access::drawRead},
    {FW_BIND_FIELD_DRAWS, Access::drawRead},
};

constexpr DrawPass variant(uint32_t number) {
    return {.name = "field draw",
            .vertexShader = "field_draw.vert",
            .fragmentShader = "field_draw.frag",
            .uses = kFieldDrawUses,
            .vertexInput = VertexInput::none,
            .blend = Blend::premultiplied,
            .writeDepth = false,
            .pushBytes = 0,
            .variant = number,
            .softShader = "field_draw_soft.frag",
            .softShaderMultisampled = "field_draw_soft_ms.frag",
            .atHalf = AtHalf::soft};
}

}  // namespace

const DrawPass kFieldDrawPasses[kFieldVariants] = {variant(0), variant(1), variant(2)};

bool fieldDrawn(const ViewParams& view, const FieldDraw& field, FieldItem& out) {
    const vec3 middle = vec3(field.place) + 0.5f * field.size.y * vec3(field.up) - vec3(view.eye);
    const float radius = 0.75f * glm::length(vec3(field.size));
    out.depth = glm::dot(middle, vec3(view.forward));
    out.variant = field.up.w <= 0.0f ? 0 : field.up.w <= 1.0f ? 1 : 2;
    out.vertices = field.shape == kFieldCard ? 6 : 6 * kFieldAround * kFieldUp;
    if (view.forward.w > 0.5f && out.depth < -radius) return false;
    // Left or right of the view, above or below it, as a whole.
    const auto row = [&](int i) {
        return vec4(view.clip0[i], view.clip1[i], view.clip2[i], view.clip3[i]);
    };
    for (int axis = 0; axis < 2; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            const vec4 plane = row(3) + side * row(axis);
            const float away = glm::dot(vec3(plane), middle) + plane.w;
            if (away < -radius * glm::length(vec3(plane))) return false;
        }
    return true;
}

void sortFields(std::span<FieldItem> items) noexcept {
    orderOnHost(
        items, [](const FieldItem& item) { return item.depth; },
        [](const FieldItem& item) { return item.draw; });
}

}  // namespace fw::gpu
