// A flame for measurements without a device: a straight or given curve, a preset, a picture.
#pragma once
#include "core/error.h"
#include "reference/flame_march.h"
#include "volume/flame.h"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace volume_scene {

using namespace fw::volume;

inline FlameDef campFire() {
    FlameDef d;
    d.appearance = presetDef(FlamePreset::CampFire).appearance;
    return d;
}

// The message with which `act` fails.
template <typename Do>
std::string failure(const Do& act) {
    try {
        act();
    } catch (const fw::core::Error& e) {
        return e.message;
    }
    return "nothing failed";
}

struct Shown {
    FlameAppearance appearance;
    FlameSize size;
    FlameScroll scroll;
    uint32_t seed = 1;
    std::shared_ptr<Profile> profile = std::make_shared<Profile>();
    fw::gpu::FlameRecord record{};
    FlameNodes nodes{};

    Shown(const FlameAppearance& l, float power, float diameter, float height) : appearance(l) {
        size = {power, diameter, height, 1.0f};
        paintDefaultProfile(appearance, *profile);
        describe();
        stand();
    }
    static Shown preset(FlamePreset preset) {
        const FlamePresetDef d = presetDef(preset);
        std::array<Flamelet, kMaxFlamelets> parts;
        splitFire(d.power, d.diameter, parts);
        return {d.appearance, parts[0].power, parts[0].diameter, parts[0].height};
    }
    void describe() {
        record = describeFlame(appearance, size, scroll, seed);
        record.glow = vec4(0.0f, 0.4f * size.height, 0.0f, 0.06f * size.diameter * size.diameter);
    }
    void stand() {  // straight up
        Curve curve;
        const float r = 0.5f * size.diameter;
        const ControlPoint points[] = {{vec3(0), r}, {vec3(0, size.height, 0), r}};
        curve.set(points, vec3(0, 1, 0));
        placeFlameNodes(curve, topOf(record), nodes);
    }
    explicit Shown(const Flame& flame) : appearance(flame.def.appearance) {  // as it burns now
        size = flame.size;
        paintDefaultProfile(appearance, *profile);
        record = flame.record;
        nodes = flame.nodes;
    }
    void run(double seconds) {
        advanceScroll(scroll, appearance, record, seconds);
        describe();
    }
};

inline vec3 film(vec3 c) {  // the curve of lib/colour.glsl
    const auto row = [&](float a, float b, float d) { return a * c.r + b * c.g + d * c.b; };
    c = vec3(row(0.59719f, 0.35458f, 0.04823f), row(0.07600f, 0.90834f, 0.01566f),
             row(0.02840f, 0.13383f, 0.83777f));
    c = (c * (c + 0.0245786f) - 0.000090537f) / (c * (c * 0.983729f + 0.4329510f) + 0.238081f);
    c = vec3(row(1.60475f, -0.53108f, -0.07367f), row(-0.10208f, 1.10813f, -0.00605f),
             row(-0.00327f, -0.07276f, 1.07602f));
    return glm::clamp(c, 0.0f, 1.0f);
}

inline float seen(vec3 radiance) {  // luminance, which counts as flame above 0.1
    const vec3 c = film(radiance * 1.5f * vec3(1.0f, 1.25f, 1.6f));
    return 0.3f * c.r + 0.6f * c.g;
}

struct Camera {
    vec3 eye{0.0f}, target{0.0f};
    float tangent = 0.3f;  // of half the picture's height
};

// Linear radiance, top row first.
template <typename Background>
std::vector<vec3> picture(const Shown& f, const Camera& camera, int width, int height,
                          const MarchRules& rules, const Background& background) {
    const vec3 ahead = glm::normalize(camera.target - camera.eye);
    const vec3 right = glm::normalize(glm::cross(ahead, vec3(0, 1, 0))),
               up = glm::cross(right, ahead);
    std::vector<vec3> out(size_t(width) * size_t(height));
    MarchRules r = rules;
    r.pixel = 2.0f * camera.tangent / float(height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float u = (float(x) + 0.5f - 0.5f * float(width)) / (0.5f * float(height));
            const float v = -(float(y) + 0.5f - 0.5f * float(height)) / (0.5f * float(height));
            const vec3 d = glm::normalize(ahead + camera.tangent * (u * right + v * up));
            const auto [behind, far] = background(camera.eye, d);
            r.farthest = far;
            if (rules.jitter < 0.0f) {
                uint32_t h = uint32_t(x) * 73856093u ^ uint32_t(y) * 19349663u;
                h = (h ^ (h >> 13)) * 0x846ca68bu;
                r.jitter = float((h ^ (h >> 16)) >> 8) / 16777216.0f;
            }
            const fw::gpu::FlameRay ray = marchRay(f.record, f.nodes, *f.profile, camera.eye, d, r);
            out[size_t(y) * size_t(width) + size_t(x)] = ray.radiance + ray.through * behind;
        }
    return out;
}

}  // namespace volume_scene
