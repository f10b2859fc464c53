// A camp fire on cobbles between charred logs. The left half uses bump mapping, the right half
// parallax occlusion, whose depth occludes the flames. Window: drag to turn, wheel to zoom.
#include <cstdio>

#include "common/camera.h"
#include "common/filming.h"
#include "common/fire_host.h"
#include "common/relief_pictures.h"
#include "common/studio.h"
#include "common/turntable.h"

namespace {

constexpr float kRoad = 4.0f;  // m, side of the paved square

std::vector<sample::ReliefModel> makeScene() {
    std::vector<sample::ReliefModel> models(2);
    models[0].picture = sample::cobbles(1024, kRoad);
    sample::addReliefBlock(models[0], {0, 0, 0}, {kRoad, kRoad});
    models[1].picture = sample::charredWood(512, 0.32f, 5);
    models[1].repeats = true;
    models[1].length = 0.8f;
    const auto log = [&](float angle, float off, float height, float radius) {
        const float half = 0.5f * models[1].length;
        const glm::vec3 along(std::cos(angle), 0, std::sin(angle));
        const glm::vec3 middle(-std::sin(angle) * off, height, std::cos(angle) * off);
        sample::addReliefLog(models[1], middle - along * half, middle + along * half, radius);
    };
    log(0.35f, 0.26f, 0.055f, 0.065f);
    log(2.3f, 0.25f, 0.050f, 0.060f);
    log(4.35f, 0.27f, 0.058f, 0.068f);
    log(1.2f, 0.02f, 0.160f, 0.050f);
    return models;
}

int run(const sample::Options& options, float seconds, const std::string& mode, float light,
        sample::OrbitCamera orbit) {
    sample::ValidationLog validation;
    {
        const sample::VulkanHost host(sample::hostRequest(options, validation));
        sample::StageRequest stageRequest;
        stageRequest.title = "Flamewright: parallax";
        sample::Stage stage(host, options, stageRequest, sample::framesOf(options, seconds));
        const std::vector<sample::ReliefModel> models = makeScene();
        sample::Relief relief(host, stage, models);
        relief.fireGain = 0.04f;

        FwWorldDef worldDef = fwDefaultWorldDef();
        worldDef.seed = options.seed;
        sample::FireHost fire(host, worldDef);
        fire.registerTarget(stage);
        FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
        fire.check(fwInitFirePreset(&def, FW_FIRE_CAMP), "fwInitFirePreset");
        def.position[1] = -0.03f;  // between the stones
        def.diameter = 0.42f;
        def.power = 32;
        FwVolumetricFireId id{};
        fire.check(fwWorld_CreateVolumetricFire(fire.world, &def, &id),
                   "fwWorld_CreateVolumetricFire");

        FwView view = fwDefaultView();
        sample::duskLight(view, light);

        sample::FilmRequest film;
        film.name = "parallax";
        film.animationWidth = 960;
        film.stripWidth = 1280;
        film.stripCount = 4;
        film.columns = 2;
        sample::Filming filming(stage, options, film);

        sample::StageFrame frame;
        while (stage.next(frame)) {
            orbit.turn(frame.input.dragX, frame.input.dragY);
            orbit.zoom(frame.input.wheel);
            if (options.headless) orbit.yaw += 0.25f * frame.deltaTime;
            sample::setCamera(view, orbit.camera(), frame);
            FwLight lights[4];
            const uint32_t count = fwWorld_GetLights(fire.world, lights, 4);
            fire.recordOutside(frame, view);
            relief.prepare(frame, view, {lights, count});
            stage.beginScene(frame);
            const uint32_t half = mode == "both"   ? frame.extent.width / 2
                                  : mode == "bump" ? frame.extent.width
                                                   : 0;
            const uint32_t rest = frame.extent.width - half, high = frame.extent.height;
            if (half > 0) relief.draw(frame, sample::ReliefMode::kBump, {{0, 0}, {half, high}});
            if (rest > 0)
                relief.draw(frame, sample::ReliefMode::kParallax,
                            {{static_cast<int32_t>(half), 0}, {rest, high}});
            fire.recordInside(frame, view);
            stage.endScene(frame);
            stage.finish(frame);
        }

        if (options.headless) {
            sample::Summary summary;
            summary.title = "Parallax occlusion, and bump mapping";
            summary.rows.emplace_back("device", host.properties.deviceName);
            summary.rows.emplace_back("ground", mode);
            filming.finish(summary, fire);
        }
    }
    return validation.exitCode();
}

}  // namespace

int main(int argc, char** argv) {
    return sample::guardedMain("11_parallax", [&] {
        sample::Options options;
        options.fps = 30.0;
        float seconds = 2, light = 0.06f, yaw = 20, pitch = 14, distance = 3.2f;
        std::string mode = "both";
        sample::OptionParser parser("11_parallax", "a fire on a relief, by bumps and by parallax");
        parser.addText("--ground", "NAME", "bump, parallax, or both: left and right", mode);
        parser.addNumber("--seconds", "length of a headless run", seconds, 0.1f, 600.0f);
        parser.addNumber("--daylight", "share of evening light", light, 0.0f, 4.0f);
        parser.addNumber("--yaw", "camera around it, degrees", yaw, -360.0f, 360.0f);
        parser.addNumber("--pitch", "camera above it, degrees", pitch, 1.0f, 85.0f);
        parser.addNumber("--distance", "camera distance, m", distance, 0.6f, 20.0f);
        if (!parser.parse(argc, argv, options)) return 0;
        if (options.list) {
            std::printf("bump\nparallax\nboth\n");
            return 0;
        }
        if (mode != "bump" && mode != "parallax" && mode != "both")
            throw sample::Failure("--ground is \"" + mode + "\"; it is bump, parallax or both.");
        sample::OrbitCamera orbit;
        orbit.target = {0, 0.16f, 0};
        orbit.distance = distance;
        orbit.yaw = glm::radians(yaw);
        orbit.pitch = glm::radians(pitch);
        orbit.fieldOfView = 0.5f;
        return run(options, seconds, mode, light, orbit);
    });
}
