// Particle fields of one view: a draw each, farthest first.
#include "shared/field_draw.h"
#include "gpu/passes/blend_order.h"
#include "gpu/passes/draw.h"

namespace fw::gpu {

bool fieldDrawn(const ViewParams& view, const FieldDraw& field, FieldItem& out) {
    const vec3 middle = vec3(field.place) + 0.5f * field.size.y * vec3(field.up) - vec3(view.eye);
    const float radius = 0.75f * glm::length(vec3(field.size));
    out.depth = glm::dot(middle, vec3(view.forward));
    out.pass = field.up.w <= 0.0f   ? draw::field_emitting
               : field.up.w <= 1.0f ? draw::field_absorbing
                                    : draw::field_refracting;
    out.vertices = field.shape == kFieldBillboard ? 6 : 6 * kFieldAround * kFieldUp;
    if (view.forward.w > 0.5f && out.depth < -radius) return false;
    return sphereInView(view, middle, radius);
}

void sortFields(std::span<FieldItem> items) noexcept {
    orderOnHost(
        items, [](const FieldItem& item) { return item.depth; },
        [](const FieldItem& item) { return item.draw; });
}

}  // namespace fw::gpu
