// Surroundings bend fire: a gust passes over a camp fire in the open, one under a ceiling, one at a
// wall, and a moving torch. Window: drag to turn, wheel to zoom.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/gtc/type_ptr.hpp>

#include "common/camera.h"
#include "common/filming.h"
#include "common/fire_host.h"
#include "common/studio.h"

namespace {

struct Box {
    glm::vec3 center, half;  // m
};
// The fires stand on stones. A slab on two posts is the ceiling, a slab on edge the wall.
constexpr float kStone = 0.10f;  // m, height of the stones
const Box kStones[] = {
    {{-2.1f, 0.5f * kStone, 0}, {0.32f, 0.5f * kStone, 0.32f}},
    {{-0.5f, 0.5f * kStone, 0}, {0.32f, 0.5f * kStone, 0.32f}},
    {{1.0f, 0.5f * kStone, 0}, {0.32f, 0.5f * kStone, 0.32f}},
};
const Box kWalls[] = {
    {{-0.5f, 0.59f, 0}, {0.62f, 0.04f, 0.45f}},          // ceiling
    {{-1.06f, 0.275f, -0.38f}, {0.05f, 0.275f, 0.05f}},  // its posts
    {{0.06f, 0.275f, -0.38f}, {0.05f, 0.275f, 0.05f}},
    {{1.38f, 0.55f, 0}, {0.05f, 0.55f, 0.45f}},  // wall
};

// m/s, to the right: calm, a gust of 1.5 s, calm.
float gustAt(double seconds, float most) {
    const double rise = std::clamp((seconds - 1.0) / 0.3, 0.0, 1.0);
    const double fall = std::clamp((3.0 - seconds) / 0.6, 0.0, 1.0);
    const double waver =
        1.0 + 0.25 * std::sin(7.3 * seconds) + 0.15 * std::sin(17.9 * seconds + 1.0);
    return most * static_cast<float>(std::min(rise, fall) * waver);
}

// Returns the position of the torch on a slow swing.
glm::vec3 torchAt(double seconds) {
    const double a = 6.2832 * seconds / 2.4;
    return {2.45f + 0.42f * static_cast<float>(std::sin(a)), 0.55f,
            0.10f + 0.16f * static_cast<float>(std::cos(a))};
}

// Stands in for an engine's CPU copy of the scene's depth. Here each ray tests every box and the
// floor.
class SeenDepth {
 public:
    static constexpr uint32_t kColumns = 160, kRows = 50;

    void look(const FwView& view) {
        const glm::mat4 clip = glm::make_mat4(view.projection) * glm::make_mat4(view.view);
        const glm::mat4 back = glm::inverse(clip);
        for (uint32_t i = 0; i < kColumns * kRows; ++i) {
            const float x = 2.0f * (static_cast<float>(i % kColumns) + 0.5f) / kColumns - 1.0f;
            const float y = 2.0f * (static_cast<float>(i / kColumns) + 0.5f) / kRows - 1.0f;
            const glm::vec4 near = back * glm::vec4(x, y, 0, 1), far = back * glm::vec4(x, y, 1, 1);
            const glm::vec3 from = glm::vec3(near) / near.w,
                            direction = glm::vec3(far) / far.w - from;
            float part = direction.y < 0.0f ? std::min(-from.y / direction.y, 1.0f) : 1.0f;
            for (const Box& box : kStones) part = std::min(part, enters(box, from, direction));
            for (const Box& box : kWalls) part = std::min(part, enters(box, from, direction));
            const glm::vec4 seen = clip * glm::vec4(from + part * direction, 1);
            depths_[i] = std::clamp(seen.z / seen.w, 0.0f, 1.0f);
        }
    }
    FwFireColliderDef def(const FwView& view) const {
        FwFireColliderDef def = fwDefaultFireColliderDef();
        def.kind = FW_COLLIDER_DEPTH;
        def.columns = kColumns;
        def.rows = kRows;
        def.depths = depths_.data();
        std::copy_n(view.view, 16, def.view);
        std::copy_n(view.projection, 16, def.projection);
        return def;
    }

 private:
    // Returns the share of the segment at which a ray enters the box; 1: a miss.
    static float enters(const Box& box, const glm::vec3& from, const glm::vec3& direction) {
        const glm::vec3 a = (box.center - box.half - from) / direction;
        const glm::vec3 b = (box.center + box.half - from) / direction;
        const glm::vec3 in = glm::min(a, b), out = glm::max(a, b);
        const float first = std::max({in.x, in.y, in.z});
        const bool meets = first > 0.0f && first < std::min({out.x, out.y, out.z});
        return meets ? first : 1.0f;
    }
    std::array<float, kColumns * kRows> depths_{};
};

int run(const sample::Options& options, float seconds, const sample::FireLook& look, float gust,
        float haze, bool seenAlone) {
    sample::ValidationLog validation;
    {
        const sample::VulkanHost host(sample::hostRequest(options, validation));
        sample::StageRequest stageRequest;
        stageRequest.title = "Flamewright: wind and walls";
        stageRequest.capturesScene = true;  // heat haze needs the scene
        sample::Stage stage(host, options, stageRequest, sample::framesOf(options, seconds));
        sample::Studio studio(host, stage, {0, 0, 0}, 1.6f);
        for (const Box& box : kStones) studio.addBlock(box.center, box.half);
        for (const Box& box : kWalls) studio.addBlock(box.center, box.half);

        FwWorldDef worldDef = fwDefaultWorldDef();
        worldDef.seed = options.seed;
        sample::FireHost fire(host, worldDef);
        fire.registerTarget(stage);
        // Occluders block radiation and flames; flames also flow around them.
        for (const Box& box : kWalls) {
            if (seenAlone) break;
            FwHeatOccluderDef def = fwDefaultHeatOccluderDef();
            for (int i = 0; i < 3; ++i) {
                def.transform[12 + i] = box.center[i];
                def.halfSize[i] = box.half[i];
            }
            FwHeatOccluderId id{};
            fire.check(fwWorld_AddHeatOccluder(fire.world, &def, &id), "fwWorld_AddHeatOccluder");
        }
        FwFireColliderId groundId{}, seenId{};
        if (!seenAlone) {
            FwFireColliderDef ground = fwDefaultFireColliderDef();
            ground.kind = FW_COLLIDER_PLANE;
            fire.check(fwWorld_AddFireCollider(fire.world, &ground, &groundId),
                       "fwWorld_AddFireCollider");
        }
        SeenDepth seen;

        static constexpr const char* kNames[] = {"in the open", "under a ceiling", "at a wall",
                                                 "torch"};
        FwVolumetricFireId fires[4]{};
        for (int i = 0; i < 4; ++i) {
            FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
            fire.check(fwInitFirePreset(&def, i == 3 ? FW_FIRE_TORCH : FW_FIRE_CAMP),
                       "fwInitFirePreset");
            if (i < 3) {
                def.diameter = 0.34f;
                def.power = 36;
                def.position[0] = kStones[i].center.x;
                def.position[1] = kStone;
            } else {
                const glm::vec3 at = torchAt(0);
                for (int c = 0; c < 3; ++c) def.position[c] = at[c];
            }
            fire.check(fwWorld_CreateVolumetricFire(fire.world, &def, &fires[i]),
                       "fwWorld_CreateVolumetricFire");
        }

        FwView view = fwDefaultView();
        view.haze = haze;
        look.applyLight(view, 0.02f, 1.6f);
        sample::OrbitCamera orbit;
        orbit.target = {0.35f, 0.55f, 0};
        orbit.distance = 6.6f;
        orbit.yaw = 0.0f;
        orbit.pitch = glm::radians(7.0f);
        orbit.fieldOfView = 0.30f;

        sample::FilmRequest film;
        film.name = "wind_and_walls";
        film.animationWidth = 960;
        film.stripWidth = 1280;
        film.stripCount = 5;
        film.columns = 1;
        sample::Filming filming(stage, options, film);

        sample::StageFrame frame;
        float hottest = 0;
        while (stage.next(frame)) {
            orbit.turn(frame.input.dragX, frame.input.dragY);
            orbit.zoom(frame.input.wheel);
            sample::setCamera(view, look.camera(orbit, {kStones[0].center.x, kStone + 0.16f, 0}),
                              frame);
            const float wind[3] = {gustAt(frame.time, gust), 0, 0};
            fire.check(fwWorld_SetWind(fire.world, wind), "fwWorld_SetWind");
            if (seenAlone) {
                seen.look(view);
                const FwFireColliderDef def = seen.def(view);
                if (frame.number == 0)
                    fire.check(fwWorld_AddFireCollider(fire.world, &def, &seenId),
                               "fwWorld_AddFireCollider");
                else
                    fire.check(fwWorld_SetFireCollider(fire.world, seenId, &def),
                               "fwWorld_SetFireCollider");
            }
            const glm::vec3 at = torchAt(frame.time);
            const float place[3] = {at.x, at.y, at.z};
            fire.check(fwWorld_MoveVolumetricFire(fire.world, fires[3], place),
                       "fwWorld_MoveVolumetricFire");
            sample::showStudio(frame, stage, studio, fire, view);
            // A game queries what its characters feel: here a hand beside the wall.
            FwFireSample answer{};
            answer.structSize = sizeof answer;
            const float hand[3] = {1.6f, 0.9f, 0};
            fire.check(fwWorld_SampleVolumetricFires(fire.world, hand, &answer),
                       "fwWorld_SampleVolumetricFires");
            hottest = std::max(hottest, answer.heatFlux);
        }

        if (options.headless) {
            sample::Summary summary;
            summary.title = "Wind and walls";
            summary.rows.emplace_back("device", host.properties.deviceName);
            char line[96];
            for (int i = 0; i < 4; ++i) {
                FwVolumetricFireState state{};
                state.structSize = sizeof state;
                fire.check(fwWorld_GetVolumetricFireState(fire.world, fires[i], &state),
                           "fwWorld_GetVolumetricFireState");
                std::snprintf(line, sizeof line, "%.1f kW, %.1f kW of it into walls",
                              static_cast<double>(state.power),
                              static_cast<double>(state.contactPower));
                summary.rows.emplace_back(kNames[i], line);
            }
            std::snprintf(line, sizeof line, "%.1f kW/m^2", static_cast<double>(hottest) / 1000.0);
            summary.rows.emplace_back("most heat on a hand behind the wall", line);
            filming.finish(summary, fire);
        }
    }
    return validation.exitCode();
}

}  // namespace

int main(int argc, char** argv) {
    return sample::guardedMain("08_wind_and_walls", [&] {
        sample::Options options;
        options.fps = 30.0;
        options.width = 1280;
        options.height = 400;
        float seconds = 4, gust = 4, haze = 1;
        bool seenAlone = false;
        sample::FireLook look;
        sample::OptionParser parser(
            "08_wind_and_walls", "fires in a gust, under a ceiling, at a wall, and carried along");
        parser.addNumber("--seconds", "length of a headless run", seconds, 0.1f, 600.0f);
        parser.addNumber("--gust", "m/s, to the right", gust, -20.0f, 20.0f);
        parser.addNumber("--haze", "strength of the heat haze", haze, 0.0f, 8.0f);
        parser.addFlag("--seen", "flames find walls only in the scene's depth", seenAlone);
        look.addTo(parser);
        if (!parser.parse(argc, argv, options)) return 0;
        if (options.list) {
            std::printf("open\nceiling\nwall\ntorch\n");
            return 0;
        }
        return run(options, seconds, look, gust, haze, seenAlone);
    });
}
