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
