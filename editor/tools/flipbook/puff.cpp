// Flipbooks of one-shot effects: a ball of burning gas or smoke, rolled up by a vortex ring and
// torn by eddies. Each point carries its origin, and its density is noise at that origin, so
// nothing blurs. Flipbook space: [-1, 1], y along the particle's motion, z away from the camera.
#include "scene.h"

#include "shared/volume.h"

#include <algorithm>
#include <cmath>

namespace fwtools {
namespace {

using namespace fw;
using glm::ivec3;
using glm::smoothstep;
using gpu::clamp;
using gpu::mix;

struct Shape {
    const char* name;
    flipbook::Kind kind;
    vec3 radii;
    float offset;                              // centre, upwards
    float ring, ringRadius, ringAt, ringCore;  // strength and position of a vortex ring
    float eddies, eddySize, pull, swell;       // of the flow; stretch along y, growth
    float rough, frequency, streaks, billow;   // of its noise; streaks < 1: stretched along y
    float eatenFirst, eatenLast, soft;         // erosion by noise over time
    float depth, cooling, core, creases;       // optical depth; temperature
    float seed;
};
constexpr Shape kPuffs[] = {
    {"tongue",
     flipbook::Kind::Fire,
     {.40f, .86f, .40f},
     -.02f,
     .25f,
     .22f,
     .45f,
     .18f,
     .55f,
     .55f,
     .20f,
     0,
     .52f,
     3.4f,
     .28f,
     .35f,
     .05f,
     .55f,
     .45f,
     5.5f,
     .15f,
     .55f,
     .18f,
     3},
    {"roll",
     flipbook::Kind::Fire,
     {.50f, .62f, .50f},
     -.10f,
     2.3f,
     .42f,
     .15f,
     .22f,
     .60f,
     .75f,
     0,
     .12f,
     .55f,
     2.6f,
     .80f,
     .60f,
     .02f,
     .66f,
     .26f,
     7.0f,
     .30f,
     .50f,
     .36f,
     11},
    {"curl",
     flipbook::Kind::Fire,
     {.50f, .62f, .50f},
     -.16f,
     1.8f,
     .36f,
     .15f,
     .22f,
     .80f,
     .60f,
     0,
     .12f,
     .55f,
     3.1f,
     .80f,
     .60f,
     .02f,
     .66f,
     .26f,
     7.0f,
     .30f,
     .50f,
     .36f,
     58},
    {"puff",
     flipbook::Kind::Fire,
     {.62f, .60f, .62f},
     0,
     .60f,
     .34f,
     0,
     .25f,
     1.25f,
     .62f,
     0,
     .15f,
     .60f,
     2.9f,
     1.0f,
     .50f,
     .05f,
     .58f,
     .30f,
     5.5f,
     .35f,
     .50f,
     .36f,
     23},
    {"smoke",
     flipbook::Kind::Smoke,
     {.66f, .64f, .66f},
     0,
     .45f,
     .34f,
     .05f,
     .25f,
     .40f,
     .70f,
     0,
     .10f,
     .55f,
     2.2f,
     1.0f,
     .85f,
     .05f,
     .22f,
     .55f,
     6.0f,
     .30f,
     .30f,
     .20f,
     37},
    {"haze",
     flipbook::Kind::Smoke,
     {.72f, .56f, .72f},
     -.04f,
     .30f,
     .40f,
     .05f,
     .30f,
     .62f,
     .80f,
     0,
     .08f,
     .62f,
     1.8f,
     1.0f,
     .70f,
     .06f,
     .34f,
     .70f,
     3.2f,
     .30f,
     .30f,
     .16f,
     91},
    // A streak: hot head, ragged tail.
    {"spark",
     flipbook::Kind::Spark,
     {.24f, .84f, .24f},
     .06f,
     0,
     .20f,
     .40f,
     .20f,
     .18f,
     .50f,
     .05f,
     0,
     .45f,
     3.0f,
     .30f,
     .40f,
     .00f,
     .35f,
     .60f,
     5.0f,
     .35f,
     .60f,
     .20f,
     5},
};

float noise(vec3 x) { return 1.25f * gpu::flameNoise(x); }

// Curl of three noises: divergence-free.
vec3 eddy(vec3 x) {
    constexpr float e = 0.12f;
    const auto potential = [](vec3 p) {
        return vec3(noise(p), noise(p + vec3(31.4f, 7.1f, 2.9f)),
                    noise(p + vec3(-11.7f, 17.3f, 43.1f)));
    };
    const vec3 dx = (potential(x + vec3(e, 0, 0)) - potential(x - vec3(e, 0, 0))) / (2 * e);
    const vec3 dy = (potential(x + vec3(0, e, 0)) - potential(x - vec3(0, e, 0))) / (2 * e);
    const vec3 dz = (potential(x + vec3(0, 0, e)) - potential(x - vec3(0, 0, e))) / (2 * e);
    return {dy.z - dz.y, dz.x - dx.z, dx.y - dy.x};
}

vec3 flow(const Shape& s, vec3 x, float t) {
    const float seed = s.seed;
    const vec3 w = x + 0.12f * vec3(noise(1.3f * x + seed), noise(1.3f * x + seed + 7.0f),
                                    noise(1.3f * x + seed + 13.0f));
    const float r = std::max(std::hypot(w.x, w.z), 1e-3f), radius = s.ringRadius * (1 + 0.35f * t);
    const vec2 a(r - radius, w.y - s.ringAt), b(r + radius, w.y - s.ringAt);
    const float core = s.ringCore * s.ringCore;
    const float near = 1 / (glm::dot(a, a) + core), far = 1 / (glm::dot(b, b) + core);
    const float strength = s.ring * s.ringCore * (1 - 0.5f * t);
    const float out = strength * (a.y * near - b.y * far);
    // Keeps the ring inside the frame.
    const float up =
        strength * (b.x * far - a.x * near) - 0.55f * strength / std::max(radius, 0.1f);
    vec3 u(out * w.x / r, up, out * w.z / r);
    const vec3 wide = eddy(x / s.eddySize + vec3(seed, seed - 1.3f * t, 3.1f + 0.5f * t));
    const vec3 fine = eddy(x / (0.45f * s.eddySize) + vec3(seed + 9.0f, -2.1f * t, 7.7f));
    u += s.eddies *
         (wide / (1 + 0.5f * glm::length(wide)) + 0.55f * fine / (1 + 0.5f * glm::length(fine)));
    u += s.pull * vec3(-0.5f * x.x, x.y, -0.5f * x.z) + s.swell * x;
    return u * (1 - smoothstep(0.75f, 1.05f, glm::length(x)));  // zero velocity at the border, so
                                                                // nothing is cut
}

// x: temperature's red; y: density. m: origin of the point x.
vec2 mediumAt(const Shape& s, vec3 m, vec3 x, float t) {
    const vec3 q = vec3(m.x, m.y - s.offset, m.z) / s.radii;
    const float r = glm::length(q);
    if (r > 1 + 1.2f * s.rough) return vec2(0.0f);
    vec3 at = vec3(m.x, m.y * s.streaks, m.z) * s.frequency + s.seed;
    float shape = 0, creases = 0, weight = 1;
    for (int octave = 0; octave < 4; ++octave) {
        const float n = noise(at + vec3(0, -0.35f * t * float(octave), 0.2f * t));
        const float billow = 2 * std::abs(n) - 0.36f;
        shape += weight * mix(1.4f * n, billow, s.billow);
        if (octave < 3) creases += weight * billow;
        weight *= 0.52f;
        at = 2.05f * at + vec3(5.1f, 2.7f, 9.3f);
    }
    const float d = 1 - r + s.rough * shape - mix(s.eatenFirst, s.eatenLast, t * t);
    const float side = std::max({std::abs(x.x), std::abs(x.y), glm::length(x)});
    const float density = smoothstep(0.0f, s.soft, d) * (1 - smoothstep(0.72f, 0.98f, side));
    const float red = 0.50f + s.core * (clamp(0.9f * d, 0.0f, 1.0f) - 0.35f) + s.creases * creases -
                      s.cooling * (t - 0.35f);
    return {clamp(red, 0.0f, 1.0f), density};
}

constexpr int kGrid = 40;
constexpr float kReach = 1.2f;
using Grid = std::vector<vec3>;

vec3 nodeAt(int x, int y, int z) {
    return (vec3(float(x), float(y), float(z)) + 0.5f) / float(kGrid) * (2 * kReach) - kReach;
}
vec3 between(const Grid& grid, vec3 x) {
    const vec3 g = clamp((x + kReach) / (2 * kReach) * float(kGrid) - 0.5f, vec3(0.0f),
                         vec3(float(kGrid) - 1.001f));
    const ivec3 i(g);
    const vec3 f = g - vec3(i);
    const auto at = [&](int dx, int dy, int dz) -> const vec3& {
        return grid[size_t(((i.z + dz) * kGrid + i.y + dy) * kGrid + i.x + dx)];
    };
    return mix(mix(mix(at(0, 0, 0), at(1, 0, 0), f.x), mix(at(0, 1, 0), at(1, 1, 0), f.x), f.y),
               mix(mix(at(0, 0, 1), at(1, 0, 1), f.x), mix(at(0, 1, 1), at(1, 1, 1), f.x), f.y),
               f.z);
}
template <typename Fill>
void fillGrid(Grid& grid, const Fill& fill) {
    grid.resize(size_t(kGrid) * kGrid * kGrid);
    size_t i = 0;
    for (int z = 0; z < kGrid; ++z)
        for (int y = 0; y < kGrid; ++y)
            for (int x = 0; x < kGrid; ++x) grid[i++] = fill(nodeAt(x, y, z));
}

class PuffScene final : public Scene {
 public:
    PuffScene(const BakeDef& def, const Shape& shape) : def_(def), shape_(shape) {
        shape_.seed += 19.0f * float(def.seed - 1);
        const uint32_t count = def.facts.frames;
        const float dt = 1 / float(count);
        Grid origin, next, velocity;
        fillGrid(origin, [](vec3 x) { return x; });
        for (uint32_t i = 0; i < count; ++i) {
            fillGrid(velocity, [&](vec3 x) { return flow(shape_, x, (float(i) + 0.5f) * dt); });
            origins_.push_back(origin);
            velocities_.push_back(velocity);
            fillGrid(next, [&](vec3 x) {
                const vec3 half = x - 0.5f * dt * between(velocity, x);
                return between(origin, x - dt * between(velocity, half));
            });
            origin.swap(next);
        }
    }

    [[nodiscard]] uint32_t frames() const override { return uint32_t(origins_.size()); }

    void render(uint32_t frame, Frame& out) const override {
        const flipbook::Facts& f = def_.facts;
        const uint32_t layers = 24 * std::min(def_.samples, 4u);
        const float t = (float(frame) + 0.5f) / float(f.frames), step = 2 / float(layers);
        out.texels.assign(size_t(f.width) * f.height, vec4(0.0f));
        out.motion.assign(out.texels.size(), vec2(0.0f));
        for (uint32_t y = 0; y < f.height; ++y)
            for (uint32_t x = 0; x < f.width; ++x) {
                float through = 1, soot = 0, red = 0, tau = 0, moving = 0;
                vec2 motion(0.0f);
                for (uint32_t k = 0; k < layers; ++k) {  // from the camera
                    const vec3 at(2 * (float(x) + 0.5f) / float(f.width) - 1,
                                  2 * (float(y) + 0.5f) / float(f.height) - 1,
                                  1 - step * (float(k) + 0.5f));
                    if (glm::dot(at, at) > 1.5f) continue;
                    const vec2 medium = mediumAt(shape_, between(origins_[frame], at), at, t);
                    const float depth = shape_.depth * medium.y * step,
                                share = 1 - std::exp(-depth);
                    if (depth <= 0) continue;
                    soot += through * share;
                    red += through * share * medium.x;
                    const float counts = through * share + 0.1f * share;
                    motion += counts * vec2(between(velocities_[frame], at));
                    moving += counts;
                    tau += depth;
                    through *= 1 - share;
                }
                const size_t i = size_t(y) * f.width + x;
                out.texels[i] = vec4(soot > 0 ? red / soot : 0.0f, soot, 1 - through,
                                     1 - std::exp(-0.25f * tau));
                if (shape_.kind == flipbook::Kind::Smoke) out.texels[i].y = 0;
                if (moving > 0) out.motion[i] = 0.5f * motion / (moving * float(f.frames));
            }
    }

 private:
    BakeDef def_;
    Shape shape_;
    std::vector<Grid> origins_, velocities_;  // by frame
};

}  // namespace

std::unique_ptr<Scene> makePuff(const BakeDef& def) {
    for (const Shape& shape : kPuffs)
        if (def.scene == shape.name) return std::make_unique<PuffScene>(def, shape);
    return nullptr;
}

std::vector<std::string_view> sceneNames() {
    std::vector<std::string_view> names{"campfire", "torch", "bonfire"};
    for (const Shape& shape : kPuffs) names.push_back(shape.name);
    return names;
}

bool sceneKind(std::string_view name, flipbook::Facts& facts) {
    facts.loops = 0;
    for (const Shape& shape : kPuffs)
        if (name == shape.name) return facts.kind = shape.kind, facts.seconds = 1, true;
    facts.loops = 1;
    facts.kind = flipbook::Kind::Fire;
    facts.seconds = 2;
    for (const char* flame : {"campfire", "torch", "bonfire"})
        if (name == flame) return true;
    return false;
}

std::unique_ptr<Scene> makeScene(const BakeDef& def) {
    std::unique_ptr<Scene> scene = makeFlame(def);
    return scene ? std::move(scene) : makePuff(def);
}

}  // namespace fwtools
