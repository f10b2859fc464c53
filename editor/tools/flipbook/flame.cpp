// Flipbooks of a volumetric flame. It burns for slightly more than one loop. Each frame stores its
// curve, and rays from the side sample it.
#include "finish.h"
#include "flame_flipbook.h"

#include "core/error.h"
#include "reference/flame_chord.h"
#include "volume/flame.h"

#include "shared/black_body.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <string>

namespace fwtools {
namespace {

using namespace fw;

struct Named {
    const char* name;
    volume::FlamePreset preset;
    float width, height;  // of the frame, relative to the flame's height
};
constexpr Named kFlames[] = {
    {"campfire", volume::FlamePreset::CampFire, 1.6f, 1.6f},
    {"torch", volume::FlamePreset::Torch, 1.6f, 1.6f},
    {"bonfire", volume::FlamePreset::Bonfire, 1.6f, 1.6f},
};

constexpr uint32_t kLastPreset = uint32_t(volume::FlamePreset::Count) - 1;

struct RecordedFlame {
    gpu::FlameRecord record;
    volume::FlameNodes nodes;
};

class FlameScene final : public Scene {
 public:
    // `view`: size of the frame relative to the flame's height.
    FlameScene(const BakeDef& def, const volume::FlamePresetDef& preset,
               const volume::Profile& profile, vec2 view)
        : def_(def), profile_(profile), diameter_(preset.diameter) {
        volume::FlameDef flame;
        flame.appearance = preset.appearance;
        flame.appearance.smoke = 0;  // smoke has its own flipbook
        flame.power = preset.power;
        flame.diameter = preset.diameter;
        flame.seed = def.seed;
        const flipbook::Facts& f = def.facts;
        faded_ = f.frames / 4;
        volume::Flame now;
        const volume::FlameAir air;
        volume::startFlame(now, flame, air);
        size_ = view * now.size.height;
        for (uint32_t i = 0; i < f.frames + faded_; ++i) {
            flames_.push_back({now.record, now.nodes});
            volume::advanceFlame(now, air, double(f.seconds) / f.frames);
        }
    }

    [[nodiscard]] uint32_t frames() const override { return uint32_t(flames_.size()); }

    void render(uint32_t frame, Frame& out) const override {
        const flipbook::Facts& f = def_.facts;
        const RecordedFlame& flame = flames_[frame];
        out.texels.assign(size_t(f.width) * f.height, vec4(0.0f));
        out.motion.clear();
        const auto count = float(def_.samples);
        for (uint32_t y = 0; y < f.height; ++y)
            for (uint32_t x = 0; x < f.width; ++x) {
                Seen sum;
                for (uint32_t k = 0; k < def_.samples; ++k) {
                    // Additive recurrence with the plastic number: uniform for any count.
                    const float a = std::fmod(0.5f + 0.7548777f * float(k), 1.0f);
                    const float b = std::fmod(0.5f + 0.5698403f * float(k), 1.0f);
                    const vec2 uv((float(x) + a) / float(f.width),
                                  (float(y) + b) / float(f.height));
                    const Seen one = look(flame, vec3((uv.x - 0.5f) * size_.x,
                                                      (uv.y - 0.05f) * size_.y, 10 * size_.y));
                    const float share = foot(uv);
                    sum.light += share * one.light, sum.soot += share * one.soot;
                    sum.hidden += share * one.hidden, sum.thin += share * one.thin;
                }
                const float soot = sum.soot / count;
                out.texels[size_t(y) * f.width + x] =
                    vec4(soot > 0 ? red(sum.light / sum.soot) : 0.0f, soot, sum.hidden / count,
                         sum.thin / count);
            }
    }

 private:
    struct Seen {
        float light = 0, soot = 0, hidden = 0, thin = 0;
    };
    // Returns the temperature of soot that emits `light` relative to its opacity.
    static float red(float light) {
        const float kelvin = 1 / (1 / 1600.0f - std::log2(std::max(light, 1e-9f)) / 34981.0f);
        return std::clamp((kelvin - gpu::kFlipbookMinKelvin) /
                              (gpu::kFlipbookMaxKelvin - gpu::kFlipbookMinKelvin),
                          0.0f, 1.0f);
    }
    // A free flame thins out at its foot instead of ending in a cut.
    [[nodiscard]] float foot(vec2 uv) const {
        const float out = (uv.x - 0.5f) * size_.x / (0.5f * diameter_);
        const float low = 0.02f + 0.07f * out * out;
        const float share = glm::smoothstep(low, low + 0.22f, uv.y);
        return share * share;
    }
    [[nodiscard]] Seen look(const RecordedFlame& flame, vec3 from) const {
        constexpr uint32_t kSteps = 56;
        const vec3 along(0, 0, -1);
        volume::RayKnots knots;
        const vec2 chord = volume::flameChord(flame.record, flame.nodes, from, along, 1e9f,
                                              gpu::kFlameIntervals, knots);
        Seen seen;
        if (!(chord.x < chord.y)) return seen;
        const float step = (chord.y - chord.x) / float(kSteps);
        float through = 1, tau = 0;
        for (uint32_t k = 0; k < kSteps && through > 0.002f; ++k) {
            const float u = (chord.x + step * (float(k) + 0.5f) - knots.from) / knots.gap;
            if ((knots.broken >> uint32_t(u)) & 1u) continue;
            const gpu::FlamePlace at = gpu::flameAlong(knots.first, knots.delta, u);
            const gpu::FlameLookup place = gpu::flameLookup(flame.record, at, 0.5f * step);
            if (!(place.lit > 0)) continue;
            const vec2 texel = profile_.sample(place.rho, place.y);
            const gpu::FlameMedium medium = gpu::flameMedium(flame.record, place, texel);
            const float depth = medium.soot * step, share = through * (1 - std::exp(-depth));
            const vec3 glow = gpu::sootRadiance(1000 * texel.x);
            seen.soot += share;
            seen.light += share * (0.2126f * glow.x + 0.7152f * glow.y + 0.0722f * glow.z);
            tau += depth;
            through *= std::exp(-depth);
        }
        seen.hidden = 1 - through;
        seen.thin = 1 - std::exp(-0.25f * tau);
        return seen;
    }

    BakeDef def_;
    volume::Profile profile_;
    std::vector<RecordedFlame> flames_;
    uint32_t faded_ = 0;
    float diameter_ = 1;  // m, at its foot
    vec2 size_{1.0f};
};

}  // namespace

std::unique_ptr<Scene> makeFlame(const BakeDef& def) {
    for (const Named& named : kFlames) {
        if (def.scene != named.name) continue;
        const volume::FlamePresetDef preset = volume::presetDef(named.preset);
        volume::Profile profile;
        volume::paintDefaultProfile(preset.appearance, profile);
        return std::make_unique<FlameScene>(def, preset, profile, vec2(named.width, named.height));
    }
    return nullptr;
}

namespace {

void readShape(const FlameFlipbookDef& def, const volume::FlamePresetDef& preset,
               volume::Profile& profile) {
    if (!def.cooked.empty()) {
        volume::readProfile(def.cooked, profile);
    } else if (!def.texels.empty()) {
        std::vector<float> planes[2];
        for (size_t i = 0; i < def.texels.size(); ++i) planes[i % 2].push_back(def.texels[i]);
        volume::paintProfile(planes[0], planes[1], def.width, def.height, profile);
    } else {
        volume::paintDefaultProfile(preset.appearance, profile);
    }
}

}  // namespace

bool bakeFlameFlipbook(const FlameFlipbookDef& def, const std::function<bool(float)>& progress,
                       std::vector<std::byte>& bytes, std::string& error) {
    error.clear();
    try {
        volume::FlamePresetDef preset =
            volume::presetDef(volume::FlamePreset(std::min(def.preset, kLastPreset)));
        preset.power = def.power;
        preset.diameter = def.diameter;
        volume::Profile profile;
        readShape(def, preset, profile);
        BakeDef bake;
        bake.seed = def.seed;
        bake.samples = def.samples;
        flipbook::Facts& facts = bake.facts;
        facts.frames = def.frames;
        facts.width = facts.height = def.side;
        facts.motionWidth = facts.motionHeight = std::max(def.side / 2, 4u);
        facts.seconds = def.seconds;
        const FlameScene scene(bake, preset, profile, vec2(1.6f));
        std::vector<Frame> frames(scene.frames());
        std::mutex mutex;
        std::atomic<uint32_t> done{0};
        std::atomic<bool> stopped{false};
        inParallel(scene.frames(), def.threads, [&](uint32_t i) {
            if (stopped) return;
            scene.render(i, frames[i]);
            const std::lock_guard<std::mutex> lock(mutex);
            stopped = stopped || !progress(float(++done) / float(frames.size()));
        });
        if (stopped) return false;
        const flipbook::Flipbook made =
            finishFlipbook(facts, frames, def.threads, std::pmr::get_default_resource());
        const auto cooked = flipbook::cookFlipbook(made, std::pmr::get_default_resource());
        bytes.assign(cooked.begin(), cooked.end());
        return true;
    } catch (const core::Error& failure) {
        error = failure.message;
        return false;
    }
}

}  // namespace fwtools
