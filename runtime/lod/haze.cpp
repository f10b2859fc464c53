// Heat haze over volumetric flames, before anything else of a view that is not solid: what the host
// gives of its scene, bent by hot gas. Flames then go over it.
#include "lod/volumes.h"
#include "shared/volume_haze.h"

#include <algorithm>

namespace fw::lod {

void volumeHazeBounds(const FlameRecord& record, const FlameNode* nodes, uint32_t count, vec4& low,
                      vec4& high) {
    const float top = kHazeTop * record.high.w;
    vec3 least(1e30f), most(-1e30f);
    const auto add = [&](vec3 centre, float s) {
        const vec3 reach(kHazeReach * flamePlumeWide(record, s));
        least = glm::min(least, centre - reach), most = glm::max(most, centre + reach);
    };
    for (uint32_t k = 0; k < count; ++k) {
        const FlameNode& node = nodes[k];
        add(vec3(node.centre), node.along.w);
        if (node.along.w > top) break;
        if (k + 1 == count)  // it goes straight on
            add(vec3(node.centre) + (top - node.along.w) * vec3(node.along), top);
    }
    low = vec4(least, 0.0f), high = vec4(most, 0.0f);
}

bool makeHazePush(const ViewParams& view, const vec4& low, const vec4& high, float strength,
                  HazePush& out) noexcept {
    VolumeDraw draw{};
    if (!(strength > 0.0f) || !volumeDraw(view, low, high, 1, draw)) return false;
    out = {draw.rect, draw.rayX, draw.rayY, draw.rayO, draw.clip, strength, 0, 0, 0};
    return true;
}

}  // namespace fw::lod
