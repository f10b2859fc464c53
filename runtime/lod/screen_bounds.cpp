// Volumetric flames of one view: their bounds on the screen, slabs and haze. If the host's depth
// can be sampled, a ray ends there. If it can only be tested, a flame is drawn in slabs, each
// tested at its place, so that a log in a flame hides only the part behind it.
#include "core/assert.h"
#include "lod/tiers.h"
#include "lod/volumes.h"
#include "shared/volume_haze.h"
#include "shared/volume_march.h"

#include <algorithm>
#include <cmath>

namespace fw::lod {
namespace {

constexpr float kFirstSlab = 1e-3f;  // m along the view, of the first slab
constexpr float kMinW = 1e-4f;  // of clip space: what is nearer is beside the camera or behind it
constexpr float kMinAway = 1e-4f;  // m: a plane that is nearer to the camera, or no more aslant
constexpr float kBeyond = 4.0f;    // depth of no plane
// Samples this far apart, in diameters: closer shows no more but for less grain.
constexpr float kSpacing = 0.05f;

// Column i of the matrix, as the shaders have it: what a world metre along axis i adds to x, y, z,
// w.
float along(const vec3& direction, const ViewParams& view, int component) {
    return view.clip0[component] * direction.x + view.clip1[component] * direction.y +
           view.clip2[component] * direction.z;
}

struct BoxShown {
    // x and y of the view, as if it had no edge; empty: nowhere.
    vec4 rect{1e30f, 1e30f, -1e30f, -1e30f};
    float near = 1e30f, far = -1e30f;  // m along the view
    bool around = false;               // some of it is beside or behind the camera
};

BoxShown showBox(const ViewParams& view, const vec3& low, const vec3& high) {
    const bool perspective = view.forward.w > 0.5f;
    const vec3 forward(view.forward), eye(view.eye);
    BoxShown shown;
    vec4 corners[8];  // of clip space
    const auto add = [&](const vec4& at) {
        const vec2 place = vec2(at) / at.w;
        shown.rect = vec4(glm::min(vec2(shown.rect), place),
                          glm::max(vec2(shown.rect.z, shown.rect.w), place));
    };
    for (int i = 0; i < 8; ++i) {
        const vec3 from =
            vec3((i & 1) ? high.x : low.x, (i & 2) ? high.y : low.y, (i & 4) ? high.z : low.z) -
            eye;
        const float depth = glm::dot(from, forward);
        shown.near = std::min(shown.near, depth);
        shown.far = std::max(shown.far, depth);
        corners[i] = from.x * view.clip0 + from.y * view.clip1 + from.z * view.clip2 + view.clip3;
        if (perspective && !(corners[i].w > kMinW))
            shown.around = true;
        else
            add(corners[i]);
    }
    // Of a box that is partly behind the camera, the view shows its edges before it.
    for (int i = 0; shown.around && i < 8; ++i) {
        if (!(corners[i].w > kMinW)) continue;
        for (int axis = 1; axis < 8; axis *= 2) {
            const vec4& other = corners[i ^ axis];
            if (other.w > kMinW) continue;
            add(glm::mix(other, corners[i], (kMinW - other.w) / (corners[i].w - other.w)));
        }
    }
    return shown;
}

}  // namespace

bool sphereInView(const ViewParams& view, vec3 middle, float radius) noexcept {
    const auto row = [&](int i) {
        return vec4(view.clip0[i], view.clip1[i], view.clip2[i], view.clip3[i]);
    };
    for (int axis = 0; axis < 2; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            const vec4 plane = row(3) + side * row(axis);
            if (glm::dot(vec3(plane), middle) + plane.w < -radius * glm::length(vec3(plane)))
                return false;
        }
    return true;
}

vec4 volumeClip(const ViewParams& view) noexcept {
    const vec3 forward(view.forward);
    if (view.forward.w <= 0.5f) return {along(forward, view, 2), view.clip3.z, 0.0f, view.clip3.w};
    const vec3 z(view.clip0.z, view.clip1.z, view.clip2.z),
        w(view.clip0.w, view.clip1.w, view.clip2.w);
    const float perDepth = along(forward, view, 3), a = glm::dot(z, w) / glm::dot(w, w);
    return {a * perDepth, view.clip3.z - a * view.clip3.w, perDepth, 0.0f};
}

bool volumeDraw(const ViewParams& view, const vec4& low, const vec4& high, uint32_t slabs,
                VolumeDraw& out, vec4* whole) {
    FW_ASSERT(slabs > 0);
    const bool perspective = view.forward.w > 0.5f;
    const vec3 forward(view.forward);
    const vec3 rows[4] = {vec3(view.clip0.x, view.clip1.x, view.clip2.x),
                          vec3(view.clip0.y, view.clip1.y, view.clip2.y),
                          vec3(view.clip0.z, view.clip1.z, view.clip2.z),
                          vec3(view.clip0.w, view.clip1.w, view.clip2.w)};
    const BoxShown shown = showBox(view, vec3(low), vec3(high));
    const vec4& rect = shown.rect;
    const float near = perspective ? std::max(shown.near, kFirstSlab) : shown.near;
    const float far = shown.far;
    if (!(far > near)) return false;
    if (whole) *whole = shown.around ? vec4(0.0f) : rect;
    out.rect = vec4(std::max(rect.x, -1.0f), std::max(rect.y, -1.0f), std::min(rect.z, 1.0f),
                    std::min(rect.w, 1.0f));
    if (!(out.rect.x < out.rect.z && out.rect.y < out.rect.w)) return false;

    // Rays, from x and y of the view and a depth of 1 (perspective) or 0.
    const glm::mat3 toClip = glm::transpose(glm::mat3(rows[0], rows[1], forward));
    const glm::mat3 fromClip = glm::inverse(toClip);
    const float perDepth = along(forward, view, 3);
    if (perspective) {
        out.rayX = vec4(fromClip[0] * perDepth, 0.0f);
        out.rayY = vec4(fromClip[1] * perDepth, 0.0f);
        out.rayO = vec4(fromClip[2], 0.0f);
    } else {
        out.rayX = vec4(fromClip[0] * view.clip3.w, 0.0f);
        out.rayY = vec4(fromClip[1] * view.clip3.w, 0.0f);
        out.rayO = vec4(-fromClip[0] * view.clip3.x - fromClip[1] * view.clip3.y, 0.0f);
    }
    out.clip = volumeClip(view);
    const bool rises = out.clip.x * out.clip.w > out.clip.y * out.clip.z;
    out.base = {rises ? kBeyond : -kBeyond, 0.0f, 0.0f, 1.0f};
    out.front = near;
    out.deep = (far - near) / float(slabs);
    out.slabs = slabs;
    out.mostSteps = kHighSteps;
    out.perPixel = 1;
    out.intervals = kFlameIntervals;
    out.wide = low.w;
    out.spacing = std::max(kSpacing * low.w, 1e-4f);
    return true;
}

vec4 volumeBasePlane(const FlameRecord& record, const FlameNode* nodes, uint32_t count) {
    FW_ASSERT(count > 0);
    const vec3 normal(nodes[0].along);
    float lowest = 0.0f;  // m, of what shows
    for (uint32_t k = 1; k < count; ++k) {
        const float s = nodes[k].along.w;
        float reach = s < kFlameTop * record.high.w ? nodes[k].centre.w : 0.0f;
        if (record.smoke > 0.0f && s > 0.6f * record.high.w && s < record.smokeTop * record.high.w)
            reach = std::max(reach, nodes[k].side.w * flamePlumeWide(record, s));
        const float upright = glm::dot(vec3(nodes[k].along), normal);
        const float aside = std::sqrt(std::max(1.0f - upright * upright, 0.0f));
        const float at = glm::dot(vec3(nodes[k].centre) - vec3(nodes[0].centre), normal);
        lowest = std::min(lowest, at - reach * aside);
    }
    return {normal, -glm::dot(vec3(nodes[0].centre), normal) - lowest};
}

void volumeBase(const ViewParams& view, const vec4& plane, VolumeDraw& out) noexcept {
    const vec3 normal(plane), forward(view.forward);
    const vec4& clip = out.clip;
    const auto awayFrom = [](float x) { return std::copysign(std::max(std::abs(x), kMinAway), x); };
    // By the view's 1, x and y.
    const vec3 rays(glm::dot(normal, vec3(out.rayO)), glm::dot(normal, vec3(out.rayX)),
                    glm::dot(normal, vec3(out.rayY)));
    const float height = glm::dot(normal, vec3(view.eye)) + plane.w;
    if (view.forward.w > 0.5f) {  // 1 / depth is -rays / height
        const float above = awayFrom(height);
        out.base = vec4(rays * (-clip.y / (clip.z * above)), above < 0.0f ? -1.0f : 1.0f);
        out.base.x += clip.x / clip.z;
    } else {  // depth is -(height + rays) / along
        const float along = awayFrom(glm::dot(normal, forward));
        out.base = vec4(rays * (-clip.x / (clip.w * along)), along > 0.0f ? -1.0f : 1.0f);
        out.base.x += (clip.y - clip.x * height / along) / clip.w;
    }
}

// kMarchedFlames flames, those that cover most of the view, get all their samples. The others get a
// few, which changes their grain and not their light.
void chooseVolumes(std::span<VolumeItem> items) {
    if (items.size() <= kMarchedFlames) return;
    const auto covers = [](const VolumeItem& item) {
        const vec4& r = item.draw.rect;
        return (r.z - r.x) * (r.w - r.y);
    };
    std::nth_element(items.begin(), items.begin() + kMarchedFlames, items.end(),
                     [&](const VolumeItem& a, const VolumeItem& b) {
                         const float x = covers(a), y = covers(b);
                         return x != y ? x > y : a.flame < b.flame;
                     });
    for (VolumeItem& item : items.subspan(kMarchedFlames)) item.draw.mostSteps = kFewSteps;
}

void volumeBounds(const FlameRecord& record, const FlameNode* nodes, uint32_t count, vec4& low,
                  vec4& high) {
    vec3 least(1e30f), most(-1e30f);
    for (uint32_t k = 0; k < count; ++k) {
        if (nodes[k].along.w > kFlameTop * record.high.w) break;
        const vec3 reach(kFlameReach * (1.0f + record.puff) * nodes[k].centre.w);
        least = glm::min(least, vec3(nodes[k].centre) - reach);
        most = glm::max(most, vec3(nodes[k].centre) + reach);
    }
    low = vec4(least, 0.0f), high = vec4(most, 0.0f);
}

void volumeSlabs(const ViewParams& view, const vec4& low, const vec4& high, VolumeDraw& out) {
    const vec3 forward(view.forward), eye(view.eye);
    const vec3 middle = 0.5f * (vec3(low) + vec3(high)) - eye, half = 0.5f * vec3(high - low);
    const float reach = glm::dot(glm::abs(forward), half), depth = glm::dot(forward, middle);
    const float least = view.forward.w > 0.5f ? kFirstSlab : -1e9f;
    const float near = std::max(depth - reach, least), far = depth + reach;
    if (!(far > near)) return;  // beside or behind the camera: its smoke alone is seen
    out.front = near;
    out.deep = (far - near) / float(out.slabs);
}

uint32_t volumeIntervals(const FlameNode* nodes, uint32_t count) {
    FW_ASSERT(count > 0);
    float bent = 0.0f;  // of neighbours' directions and radii, all together
    for (uint32_t k = 1; k < count; ++k) {
        const float radius = std::max(std::max(nodes[k].centre.w, nodes[k - 1].centre.w), 1e-6f);
        bent += glm::length(vec3(nodes[k].along) - vec3(nodes[k - 1].along)) +
                std::abs(nodes[k].centre.w - nodes[k - 1].centre.w) / radius;
        if (nodes[k].squeeze.w > 0.0f) bent += 1.0f;
    }
    return std::clamp(2u + uint32_t(4.0f * std::min(bent, 100.0f)), 2u, kFlameIntervals);
}

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
