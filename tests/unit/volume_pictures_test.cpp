// Pictures of every preset, marched on the CPU. FLAMEWRIGHT_FLAME_PICTURES names a folder for .ppm
// files; small ones are always made and checked by numbers.
#include "volume_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

namespace {

using namespace volume_scene;

void writePpm(const std::string& path, const std::vector<vec3>& linear, int width, int height,
              float exposure, vec3 white) {
    FILE* file = std::fopen(path.c_str(), "wb");
    ASSERT_NE(file, nullptr) << path;
    std::fprintf(file, "P6\n%d %d\n255\n", width, height);
    for (const vec3& p : linear) {
        const vec3 c = film(p * exposure * white);
        for (int k = 0; k < 3; ++k) {
            const float e =
                c[k] <= 0.0031308f ? 12.92f * c[k] : 1.055f * std::pow(c[k], 1 / 2.4f) - 0.055f;
            std::fputc(int(255.0f * std::min(std::max(e, 0.0f), 1.0f) + 0.5f), file);
        }
    }
    std::fclose(file);
}

struct Night {
    float size;
    std::pair<vec3, float> operator()(vec3 eye, vec3 d) const {
        if (d.y >= 0.0f) return {vec3(0.0012f, 0.0017f, 0.0032f), 1e9f};
        const float t = -eye.y / d.y;
        const vec3 p = eye + d * t;
        const float fall = 1.0f / (1.0f + glm::dot(p, p) / (0.5f * size * size));
        return {vec3(0.05f, 0.022f, 0.008f) * fall, t};
    }
};

Camera cameraFor(const Shown& f, float heights = 2.0f) {
    const float tall = std::max(heights * f.size.height, 1.3f * f.size.diameter);
    const float away = 4.0f * tall;
    return {vec3(0, 0.62f * tall, away), vec3(0, 0.46f * tall, 0), 0.56f * tall / away};
}

TEST(VolumePictures, EveryPresetHasItsAppearance) {
    const char* folder = std::getenv("FLAMEWRIGHT_FLAME_PICTURES");
    const int width = folder ? 160 : 24, height = folder ? 320 : 48;
    for (uint32_t k = 0; k < uint32_t(FlamePreset::Count); ++k) {
        const FlamePreset preset = FlamePreset(k);
        const std::string name = presetName(preset);
        Shown f = Shown::preset(preset);
        MarchRules rules;
        rules.steps = folder ? 72 : 24, rules.jitter = -1.0f, rules.smoke = folder != nullptr;
        const Camera camera = cameraFor(f);
        f.run(2.0);
        auto image = picture(f, camera, width, height, rules, Night{f.size.diameter});
        if (folder) {
            std::string file = name;
            std::replace(file.begin(), file.end(), ' ', '_');
            writePpm(std::string(folder) + "/" + file + ".ppm", image, width, height, 1.5f,
                     f.appearance.tint[3] > 0.0f ? vec3(1.0f) : vec3(1.0f, 1.25f, 1.6f));
        }
        rules.smoke = false;
        image = picture(f, camera, width, height, rules, [](vec3, vec3) {
            return std::pair{vec3(0.0f), 1e9f};
        });
        vec3 sum(0.0f);
        double light = 0, moment = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const vec3 p = image[size_t(y * width + x)];
                ASSERT_TRUE(std::isfinite(p.r + p.g + p.b)) << name;
                sum += p;
                const float l = p.r + p.g + p.b;
                // Approximate metres above the base.
                const float up =
                    camera.target.y + camera.tangent * 4.0f * 2.0f * f.size.height *
                                          (1.0f - 2.0f * (float(y) + 0.5f) / float(height));
                light += double(l), moment += double(l * up);
            }
        ASSERT_GT(light, 0.0) << name;
        // Turbulent flames are brightest in the lower half.
        if (f.appearance.painter == Painter::Fire) {
            EXPECT_LT(moment / light, 0.5 * double(std::max(f.size.height, f.size.diameter)))
                << name;
        }
        const bool blue = preset == FlamePreset::MagicBlue || preset == FlamePreset::GasBurner;
        const bool green = preset == FlamePreset::MagicGreen;
        EXPECT_EQ(sum.b > sum.r && sum.b > sum.g, blue) << name;
        EXPECT_EQ(sum.g > sum.r && sum.g > sum.b, green) << name;
        if (!blue && !green) {
            EXPECT_GT(sum.r, 2.0f * sum.g) << name << ": deep orange, white only by exposure";
        }
    }
}

// Strips to look at: still, in wind, under a ceiling, at a wall, swung, split.
TEST(VolumePictures, WritesStripsOfMovingFlames) {
    const char* folder = std::getenv("FLAMEWRIGHT_FLAME_PICTURES");
    const int frames = folder ? 5 : 1, width = folder ? 180 : 12, height = folder ? 200 : 14;
    Collider ceiling, wall;
    ceiling.kind = wall.kind = ColliderKind::Plane;
    ceiling.place = vec3(0, 0.5f, 0), ceiling.extent = vec3(0, -1, 0);
    wall.place = vec3(0.22f, 0, 0), wall.extent = vec3(-1, 0, 0);
    for (const std::string what : {"still", "wind", "ceiling", "wall", "swung", "embers"}) {
        FlameDef d;
        const FlamePreset preset = what == "swung"    ? FlamePreset::Torch
                                   : what == "embers" ? FlamePreset::DyingEmbers
                                                      : FlamePreset::CampFire;
        const FlamePresetDef p = presetDef(preset);
        std::array<Flamelet, kMaxFlamelets> parts;
        const uint32_t n = splitFire(p.power, p.diameter, parts);
        FlameAir air;
        if (what == "wind") air.wind = vec3(3, 0, 0);
        if (what == "ceiling") air.colliders = std::span(&ceiling, 1);
        if (what == "wall") air.colliders = std::span(&wall, 1);
        std::vector<Flame> flames(n);
        for (uint32_t k = 0; k < n; ++k) {
            d.appearance = p.appearance, d.power = parts[k].power, d.diameter = parts[k].diameter,
            d.seed = 1 + k;
            d.position = vec3(parts[k].x, 0, parts[k].z);
            startFlame(flames[k], d, air);
        }
        std::vector<vec3> strip(size_t(width * frames * height));
        for (int frame = 0; frame < frames; ++frame) {
            for (int k = 0; k < (frame == 0 ? 120 : 8); ++k)
                for (Flame& f : flames) {
                    if (what == "swung") f.def.position.x = 0.5f * std::sin(float(f.age) * 5.0f);
                    advanceFlame(f, air, 1.0 / 60.0);
                }
            MarchRules rules;
            rules.steps = folder ? 72 : 16, rules.jitter = -1.0f;
            const float tall = what == "embers" ? 0.5f : 1.3f;
            const Camera camera{{0.1f, 0.5f * tall, 4.0f * tall}, {0.1f, 0.38f * tall, 0}, 0.13f};
            std::vector<vec3> image(size_t(width * height));
            for (uint32_t k = 0; k < n; ++k) {
                const Shown shown(flames[k]);
                const auto one =
                    picture(shown, camera, width, height, rules, [&](vec3 eye, vec3 dir) {
                        return k == 0 ? Night{p.diameter}(eye, dir) : std::pair{vec3(0.0f), 1e9f};
                    });
                for (size_t i = 0; i < image.size(); ++i) image[i] += one[i];
            }
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) {
                    const vec3 c = image[size_t(y * width + x)];
                    ASSERT_TRUE(std::isfinite(c.r + c.g + c.b)) << what;
                    strip[size_t(y * width * frames + frame * width + x)] = c;
                }
        }
        if (folder)
            writePpm(std::string(folder) + "/strip_" + what + ".ppm", strip, width * frames, height,
                     1.5f, vec3(1.0f, 1.25f, 1.6f));
    }
}

}  // namespace
