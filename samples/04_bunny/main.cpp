// The figure of papers on burning meshes: a wooden bunny burns from the chest, through holes, to
// its remains. Without the assets folder, a toy burns.
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "common/filming.h"
#include "common/fire_host.h"
#include "common/studio.h"
#include "common/subject.h"
#include "common/turntable.h"
#include "flamewright_reference.h"

namespace {

constexpr float kFillingSeconds = 12;  // length of the run that the time scale below fits

std::filesystem::path bunnyFile() {
    if (const char* assets = std::getenv("FLAMEWRIGHT_ASSETS")) {
        const std::filesystem::path bunny = std::filesystem::path(assets) / "bunny_31k.glb";
        if (std::filesystem::exists(bunny)) return bunny;
    }
    return {};
}

// Places a second copy as the papers model it: their 16-tap kernel spreads the fire, and a thin
// skin without heat of its own burns.
FwBurnableMeshId placePublished(sample::FireHost& fire, FwBurnableMeshDef def, float aside) {
    FwMaterialDef material = fwDefaultMaterialDef();
    fire.check(fwInitMaterialPreset(&material, FW_MATERIAL_PINE), "fwInitMaterialPreset");
    material.thickness = 0.002f;
    FwMaterialId skin{};
    fire.check(fwWorld_CreateMaterial(fire.world, &material, &skin), "fwWorld_CreateMaterial");
    for (FwMaterialId& slot : def.materials) slot = skin;
    def.flags = FW_BURNABLE_PUBLISHED | uint32_t{FW_BURNABLE_LITE};
    def.transform[12] = aside;
    FwBurnableMeshId object{};
    fire.check(fwWorld_CreateBurnableMesh(fire.world, &def, &object), "fwWorld_CreateBurnableMesh");
    return object;
}

int run(const sample::Options& options, float seconds, float turn, bool compare) {
    Subject subject = loadSubject(bunnyFile(), 0.62f);
    sample::ValidationLog validation;
    {
        const sample::VulkanHost host(sample::hostRequest(options, validation));
        sample::StageRequest stageRequest;
        stageRequest.title = "Flamewright: " + subject.name;
        stageRequest.samples = options.noMsaa ? VK_SAMPLE_COUNT_1_BIT : VK_SAMPLE_COUNT_4_BIT;
        const uint32_t frames = sample::framesOf(options, seconds);
        sample::Stage stage(host, options, stageRequest, frames);
        sample::Studio studio(host, stage, {0, 0, 0}, subject.size());

        sample::OrbitCamera orbit = orbitAround(subject, -24.0f, 9.0f, stage.extent());
        const SurfacePoint match = findIgnitionPoint(subject, orbit.camera().eye);
        // This solver's copy stands on the right.
        const float aside = compare ? 0.62f * subject.size() : 0.0f;
        if (compare) orbit.yaw = 0;
        if (compare) orbit.distance *= 1.15f;
        sample::Turntable table(stage, orbit, turn);
        const FwView& view = table.view;

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
        if (compare) placePublished(fire, def, -aside);
        def.transform[12] = aside;
        FwBurnableMeshId object{};
        fire.check(fwWorld_CreateBurnableMesh(fire.world, &def, &object),
                   "fwWorld_CreateBurnableMesh");

        std::vector<float> shadows = subject.model.positions;
        std::vector<uint32_t> shadowIndices = subject.model.indices;
        if (compare) {
            const auto count = static_cast<uint32_t>(shadows.size() / 3);
            shadows.insert(shadows.end(), subject.model.positions.begin(),
                           subject.model.positions.end());
            for (size_t i = 0; i < shadows.size(); i += 3)
                shadows[i] += i < shadows.size() / 2 ? -aside : aside;
            for (const uint32_t index : subject.model.indices)
                shadowIndices.push_back(count + index);
        }
        studio.castShadow(shadows, shadowIndices, glm::mat4(1.0f),
                          {view.sunDirection[0], view.sunDirection[1], view.sunDirection[2]});

        sample::Filming filming(
            stage, options, {.name = compare ? "compared" : "bunny", .columns = compare ? 2u : 3u});

        sample::StageFrame frame;
        while (table.next(frame)) {
            if (frame.number == 1) {
                FwIgnitionDef ignition = fwDefaultIgnitionDef();
                for (int c = 0; c < 3; ++c) ignition.position[c] = match.position[c];
                ignition.radius = 0.02f * subject.size();
                ignition.position[0] = match.position[0] + aside;
                fire.check(fwWorld_Ignite(fire.world, &ignition, nullptr), "fwWorld_Ignite");
                ignition.position[0] = match.position[0] - aside;
                if (compare)
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
            std::snprintf(line, sizeof line, "pine, %.0f times real speed; %.0f %% ignited",
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
        bool compare = false;
        sample::OptionParser parser("04_bunny", "a wooden bunny burns");
        parser.addNumber("--seconds", "length of a headless run", seconds, 0.1f, 600.0f);
        parser.addNumber("--turn", "turntable, degrees a second", turn, -360.0f, 360.0f);
        parser.addFlag("--compare", "adds the papers' model on the left", compare);
        parser.addFlag("--no-msaa", "one sample a pixel instead of four", options.noMsaa);
        if (!parser.parse(argc, argv, options)) return 0;
        if (options.list) {
            std::printf(
                "04_bunny shows one thing; FLAMEWRIGHT_ASSETS names the folder of "
                "bunny_31k.glb\n");
            return 0;
        }
        return run(options, seconds, turn, compare);
    });
}
