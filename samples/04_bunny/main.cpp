// The figure that papers on burning meshes show: a bunny of wood burns, from the chest, through
// holes, to what is left standing. Without the assets folder it is a toy that burns.
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "common/camera.h"
#include "common/filming.h"
#include "common/fire_host.h"
#include "common/studio.h"
#include "common/subject.h"

namespace {

constexpr float kFillingSeconds = 12;  // the run that the pace below is made for

std::filesystem::path bunnyFile() {
    if (const char* assets = std::getenv("FLAMEWRIGHT_ASSETS")) {
        const std::filesystem::path bunny = std::filesystem::path(assets) / "bunny_31k.glb";
        if (std::filesystem::exists(bunny)) return bunny;
    }
    return {};
}

int run(const sample::Options& options, float seconds, float turn) {
    Subject subject = loadSubject(bunnyFile(), 0.62f);
    sample::ValidationLog validation;
    {
        const sample::VulkanHost host(sample::hostRequest(options, validation));
        sample::StageRequest stageRequest;
        stageRequest.title = "Flamewright: " + subject.name;
        const uint32_t frames = sample::framesOf(options, seconds);
        sample::Stage stage(host, options, stageRequest, frames);
        sample::Studio studio(host, stage, {0, 0, 0}, subject.size());

        sample::OrbitCamera orbit = orbitAround(subject, -24.0f, 9.0f, stage.extent());

        FwWorldDef worldDef = fwDefaultWorldDef();
        worldDef.paceFactor = 150.0f * kFillingSeconds / std::max(1.0f, seconds);
        worldDef.seed = options.seed;
        worldDef.maxStepsPerFrame = 64;
        sample::FireHost fire(host, worldDef);
        fire.registerTarget(stage);
        BurnMapRequest mapRequest;
        mapRequest.mapSize = 1024;
        mapRequest.texelsPerMetre = 400;
        mapRequest.cache = options.out.parent_path() / "cache";
        std::string bakeNote;
        FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
        def.mesh = createMesh(fire, subject, mapRequest, bakeNote);
        FwMaterialDef material = fwDefaultMaterialDef();
        fire.check(fwInitMaterialPreset(&material, FW_MATERIAL_PINE), "fwInitMaterialPreset");
        material.thickness = 0.03f;
        FwMaterialId pine{};
        fire.check(fwWorld_CreateMaterial(fire.world, &material, &pine), "fwWorld_CreateMaterial");
        for (FwMaterialId& slot : def.materials) slot = pine;
        FwBurnableMeshId object{};
        fire.check(fwWorld_CreateBurnableMesh(fire.world, &def, &object),
                   "fwWorld_CreateBurnableMesh");

        FwView view = fwDefaultView();
        sample::duskLight(view);
        studio.castShadow(subject.model.positions, subject.model.indices, glm::mat4(1.0f),
                          {view.sunDirection[0], view.sunDirection[1], view.sunDirection[2]});
        const SurfacePoint match = matchPlace(subject, orbit.camera().eye);

        sample::FilmRequest film;
        film.name = "bunny";
        sample::Filming filming(stage, options, film);

        sample::StageFrame frame;
        while (stage.next(frame)) {
            orbit.turn(frame.input.dragX, frame.input.dragY);
            orbit.zoom(frame.input.wheel);
            orbit.yaw += glm::radians(turn) * frame.deltaTime;
            sample::setCamera(view, orbit.camera(), frame);
            if (frame.number == 1) {
                FwIgnitionDef ignition = fwDefaultIgnitionDef();
                for (int c = 0; c < 3; ++c) ignition.position[c] = match.position[c];
                ignition.radius = 0.02f * subject.size();
                fire.check(fwWorld_Ignite(fire.world, &ignition, nullptr), "fwWorld_Ignite");
            }
            sample::showStudio(frame, stage, studio, fire, view);
        }

        if (options.headless) {
            const FwObjectState state = fire.objectState(object);
            char line[160];
            sample::Summary summary;
            summary.title = "Burning " + subject.name;
            summary.rows.emplace_back("device", host.properties.deviceName);
            std::snprintf(line, sizeof line,
                          "pine, %.0f times as fast as real; %.0f %% caught fire",
                          static_cast<double>(worldDef.paceFactor),
                          static_cast<double>(100.0f * state.burntFraction));
            summary.rows.emplace_back("fire", line);
            summary.rows.emplace_back("burn map", bakeNote);
            filming.finish(summary, fire);
        }
    }
    return validation.exitCode();
}

}  // namespace

int main(int argc, char** argv) {
    return sample::guardedMain("04_bunny", [&] {
        sample::Options options;
        options.fps = 8.0;
        options.width = 768;
        options.height = 432;
        float seconds = kFillingSeconds, turn = 0;
        sample::OptionParser parser("04_bunny", "a wooden bunny burns");
        parser.addNumber("--seconds", "length of a headless run", seconds, 0.1f, 600.0f);
        parser.addNumber("--turn", "turntable, degrees a second", turn, -360.0f, 360.0f);
        if (!parser.parse(argc, argv, options)) return 0;
        if (options.list) {
            std::printf(
                "04_bunny shows one thing; FLAMEWRIGHT_ASSETS names the folder of "
                "bunny_31k.glb\n");
            return 0;
        }
        return run(options, seconds, turn);
    });
}
