// Burns any glTF mesh in a studio: imports it, bakes a burn map, ignites the front, films it.
// Window: drag to turn, wheel to zoom, click to ignite; V makes the click pour water, F fire.
// --neutral: renders one picture of the unburnt mesh on a neutral stage.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <glm/gtc/type_ptr.hpp>

#include "common/filming.h"
#include "common/fire_host.h"
#include "common/studio.h"
#include "common/subject.h"
#include "common/turntable.h"
#include "model/neutral_stage.h"

namespace {

struct Settings {
    std::string material = "pine";
    float ignite[3] = {0, 0, 0};  // m, in the studio; valid if `igniteGiven`
    bool igniteGiven = false, noCache = false, reversed = false, msaa = false, neutral = false;
    float pace = 0;      // 0: the run shows the whole burn
    float seconds = 10;  // length of a headless run
    float turn = 0;      // degrees per second, turntable
    float wind[3] = {0, 0, 0};
    float size = 0;              // m; 0: the file's size
    float mapSize = 1024;        // texels
    float yaw = 30, pitch = 14;  // degrees
};

uint32_t findPreset(const std::string& name) {
    std::string known;
    for (uint32_t i = 0; i < FW_MATERIAL_PRESET_COUNT; ++i) {
        std::string preset = fwMaterialPresetName(i);
        std::replace(preset.begin(), preset.end(), ' ', '_');
        if (preset == name) return i;
        known += (i ? ", " : "") + preset;
    }
    throw sample::Failure("--material is \"" + name + "\"; the materials are " + known);
}

// The named file, else a bunny of the assets folder, else the toy.
std::filesystem::path chooseFile(const sample::Options& options) {
    if (options.positional.size() > 1) {
        throw sample::Failure("one file at a time; " + options.positional[1] + " is extra");
    }
    if (!options.positional.empty()) return options.positional[0];
    if (const char* assets = std::getenv("FLAMEWRIGHT_ASSETS")) {
        const std::filesystem::path bunny = std::filesystem::path(assets) / "bunny_31k.glb";
        if (std::filesystem::exists(bunny)) return bunny;
    }
    return {};
}

FwBurnableMeshId placeSubject(sample::FireHost& fire, const Subject& subject, FwMeshId mesh,
                              uint32_t preset) {
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    def.mesh = mesh;
    if (subject.surfaces.twoSided) def.flags |= static_cast<uint32_t>(FW_BURNABLE_TWO_SIDED);
    const FwMaterialDef material = fwmodel::materialDefOf(preset, subject.surfaces.ownColors());
    FwMaterialId id{};
    fire.check(fwWorld_CreateMaterial(fire.world, &material, &id), "fwWorld_CreateMaterial");
    for (FwMaterialId& slot : def.materials) slot = id;
    for (size_t slot = 0; slot < fwmodel::kSlots; ++slot) {
        const fwmodel::SlotPicture& picture = subject.surfaces.pictures[slot];
        if (picture.image < 0) continue;
        const FwImageDef image = fwmodel::imageDefOf(subject.model, picture);
        fire.check(fwWorld_CreateImage(fire.world, &image, &def.baseColors[slot]),
                   "fwWorld_CreateImage");
    }
    FwBurnableMeshId object{};
    fire.check(fwWorld_CreateBurnableMesh(fire.world, &def, &object), "fwWorld_CreateBurnableMesh");
    return object;
}

void touch(sample::FireHost& fire, glm::vec3 position, float radius, FwIgnitionKind kind) {
    FwIgnitionDef def = fwDefaultIgnitionDef();
    def.kind = kind;
    for (int c = 0; c < 3; ++c) def.position[c] = position[c];
    def.radius = radius;
    fire.check(fwWorld_Ignite(fire.world, &def, nullptr), "fwWorld_Ignite");
}

BurnMapRequest mapRequestOf(const sample::Options& options, const Settings& settings, float size) {
    BurnMapRequest request;
    request.mapSize = static_cast<uint32_t>(settings.mapSize);
    request.texelsPerMetre =
        std::clamp(0.5f * static_cast<float>(request.mapSize) / size, 32.0f, 512.0f);
    if (!settings.noCache) request.cache = options.out.parent_path() / "cache";
    return request;
}

Subject loadAndReport(const sample::Options& options, const Settings& settings) {
    Subject subject = loadSubject(chooseFile(options), settings.size, settings.neutral);
    for (const auto* notes : {&subject.model.notes, &subject.surfaces.notes})
        for (const std::string& line : *notes)
            std::printf("%s: %s\n", subject.name.c_str(), line.c_str());
    return subject;
}

int showNeutral(sample::Options options, const Settings& settings) {
    const uint32_t preset = findPreset(settings.material);
    const Subject subject = loadAndReport(options, settings);
    options.headless = true;
    sample::ValidationLog validation;
    {
        const sample::VulkanHost host(sample::hostRequest(options, validation));
        sample::StageRequest request;
        request.colorFormat = VK_FORMAT_R8G8B8A8_SRGB;
        request.samples = settings.msaa ? VK_SAMPLE_COUNT_4_BIT : VK_SAMPLE_COUNT_1_BIT;
        std::copy(fwmodel::kNeutralBackground.begin(), fwmodel::kNeutralBackground.end(),
                  request.clearColor);
        sample::Stage stage(host, options, request, 1);
        sample::FireHost fire(host, fwDefaultWorldDef());
        fire.registerTarget(stage);
        std::string bakeNote;
        const FwMeshId mesh =
            createMesh(fire, subject, mapRequestOf(options, settings, subject.size()), bakeNote);
        placeSubject(fire, subject, mesh, preset);
        const std::filesystem::path file = options.out / "neutral.png";
        stage.onPicture = [&](uint32_t, sample::Picture&& picture) {
            sample::writePng(file, picture);
        };
        const FwView view = fwmodel::neutralView(subject.model.low, subject.model.high,
                                                 {settings.yaw, settings.pitch},
                                                 stage.extent().width, stage.extent().height);
        sample::StageFrame frame;
        while (stage.next(frame)) {
            fire.recordOutside(frame, view);
            stage.beginScene(frame);
            fire.recordInside(frame, view);
            stage.endScene(frame);
            stage.finish(frame);
        }
        std::printf("%s\n", file.string().c_str());
    }
    return validation.exitCode();
}

int run(const sample::Options& options, const Settings& settings) {
    const uint32_t preset = findPreset(settings.material);
    const Subject subject = loadAndReport(options, settings);
    sample::ValidationLog validation;
    {
        const sample::VulkanHost host(sample::hostRequest(options, validation));
        sample::StageRequest stageRequest;
        stageRequest.title = "Flamewright: " + subject.name;
        stageRequest.reversedDepth = settings.reversed;
        stageRequest.samples = settings.msaa ? VK_SAMPLE_COUNT_4_BIT : VK_SAMPLE_COUNT_1_BIT;
        const uint32_t frames = sample::framesOf(options, settings.seconds);
        sample::Stage stage(host, options, stageRequest, frames);
        sample::Studio studio(host, stage, {0, 0, 0}, subject.size());

        sample::Turntable table(stage,
                                orbitAround(subject, settings.yaw, settings.pitch, stage.extent()),
                                settings.turn);
        const FwView& view = table.view;

        // Burns faster than wood, so that the fire consumes the subject within the run.
        FwMaterialDef material = fwDefaultMaterialDef();
        fwInitMaterialPreset(&material, preset);
        float pace = settings.pace;
        if (!(pace > 0)) {
            const float seconds =
                options.headless ? static_cast<float>(frames / options.fps) : 25.0f;
            const float rate = std::max(1e-5f, material.spreadRate);
            pace =
                std::clamp(subject.size() / (2.2f * rate * std::max(4.0f, seconds)), 1.0f, 400.0f);
        }
        FwWorldDef worldDef = fwDefaultWorldDef();
        worldDef.flags = FW_WORLD_CONTACT;  // connected parts burn as one
        worldDef.paceFactor = pace;
        worldDef.seed = options.seed;
        worldDef.maxStepsPerFrame = 64;
        for (int c = 0; c < 3; ++c) worldDef.wind[c] = settings.wind[c];
        sample::FireHost fire(host, worldDef);
        fire.registerTarget(stage);
        std::string bakeNote;
        const FwMeshId mesh =
            createMesh(fire, subject, mapRequestOf(options, settings, subject.size()), bakeNote);
        const FwBurnableMeshId object = placeSubject(fire, subject, mesh, preset);

        const fwmodel::SolidTriangles solid =
            fwmodel::solidTrianglesOf(subject.model, subject.surfaces);
        studio.castShadow(solid.positions, solid.indices, glm::mat4(1.0f),
                          {view.sunDirection[0], view.sunDirection[1], view.sunDirection[2]});
        const float matchRadius = 0.03f * subject.size();
        glm::vec3 match(settings.ignite[0], settings.ignite[1], settings.ignite[2]);
        if (!settings.igniteGiven)
            match = findIgnitionPoint(subject, table.orbit.camera().eye).position;

        sample::Filming filming(stage, options, {.name = "burning_mesh"});

        FwIgnitionKind hand = FW_IGNITE;
        float dropped = 0;  // s that the simulation skipped
        sample::StageFrame frame;
        while (table.next(frame)) {
            // The first frame shows the unburnt subject.
            if (frame.number == 1) touch(fire, match, matchRadius, FW_IGNITE);
            for (int key : frame.input.keys) {
                if (key == 'F') hand = FW_IGNITE;
                if (key == 'V') hand = FW_WET;
            }
            if (frame.input.click) {
                const glm::vec4 far =
                    glm::inverse(glm::make_mat4(view.projection) * glm::make_mat4(view.view)) *
                    glm::vec4(2 * frame.input.clickX - 1, 2 * frame.input.clickY - 1, 0.5f, 1);
                const glm::vec3 eye = table.orbit.camera().eye;
                const glm::vec3 direction = glm::normalize(glm::vec3(far) / far.w - eye);
                const SurfacePoint point = castRay(subject, eye, direction);
                if (point.hit) touch(fire, point.position, matchRadius, hand);
            }
            FwEvent events[32];
            while (const uint32_t count = fwWorld_PollEvents(fire.world, events, 32)) {
                for (uint32_t i = 0; i < count; ++i) {
                    if (events[i].type == FW_EVENT_TIME_DROPPED) dropped += events[i].value;
                }
            }
            sample::showStudio(frame, stage, studio, fire, view);
        }

        if (options.headless) {
            FwMeshInfo info{};
            info.structSize = sizeof info;
            fwWorld_GetMeshInfo(fire.world, mesh, &info);
            const FwObjectState state = fire.objectState(object);
            char line[160];
            sample::Summary summary;
            summary.title = "Burning " + subject.name;
            summary.rows.emplace_back("device", host.properties.deviceName);
            std::snprintf(line, sizeof line, "%u vertices, %u triangles, %.2f m, %.2f m^2",
                          info.vertices, info.triangles, subject.size(), info.area);
            summary.rows.emplace_back("mesh", line);
            std::snprintf(line, sizeof line, "%u x %u, %u texels in %u charts, %.0f per metre",
                          info.mapWidth, info.mapHeight, info.texels, info.charts,
                          info.texelsPerMetre);
            summary.rows.emplace_back("burn map", line);
            summary.rows.emplace_back("", bakeNote);
            std::snprintf(line, sizeof line, "%s, %.0f times real speed; %.0f %% ignited",
                          settings.material.c_str(), pace, 100.0f * state.burntFraction);
            summary.rows.emplace_back("fire", line);
            if (dropped > 0) {
                std::snprintf(line, sizeof line, "%.1f s of time were dropped: lower --pace",
                              dropped);
                summary.rows.emplace_back("", line);
            }
            std::snprintf(line, sizeof line, "%u x %u, %u frames in %.0f s", options.width,
                          options.height, frames, filming.seconds());
            summary.rows.emplace_back("run", line);
            filming.finish(summary, fire);
        }
    }
    return validation.exitCode();
}

}  // namespace

int main(int argc, char** argv) {
    return sample::guardedMain("02_burning_mesh", [&] {
        sample::Options options;
        options.fps = 8.0;
        options.width = 768;
        options.height = 432;
        Settings settings;
        sample::OptionParser parser("02_burning_mesh", "any glTF mesh burns", "[FILE.glb]");
        parser.addText("--material", "NAME", "its material; --list names them", settings.material);
        parser.addVector("--ignite", "ignition point, m, floor is 0", settings.ignite,
                         &settings.igniteGiven);
        parser.addNumber("--pace", "time scale of the burn", settings.pace, 0.1f, 1000.0f);
        parser.addNumber("--seconds", "length of a headless run", settings.seconds, 0.1f, 600.0f);
        parser.addNumber("--turn", "turntable, degrees a second", settings.turn, -360.0f, 360.0f);
        parser.addNumber("--yaw", "camera around it, degrees", settings.yaw, -360.0f, 360.0f);
        parser.addNumber("--pitch", "camera above it, degrees", settings.pitch, -5.0f, 85.0f);
        parser.addVector("--wind", "m/s", settings.wind);
        parser.addNumber("--scale-to", "largest side, m", settings.size, 0.05f, 20.0f);
        parser.addNumber("--map", "side of the burn map, texels", settings.mapSize, 8.0f, 4096.0f);
        parser.addFlag("--no-cache", "bake again", settings.noCache);
        parser.addFlag("--msaa", "four samples", settings.msaa);
        parser.addFlag("--reversed", "reversed depth", settings.reversed);
        parser.addFlag("--neutral",
                       "one picture of the unburnt mesh in even light before grey, into "
                       "neutral.png",
                       settings.neutral);
        if (!parser.parse(argc, argv, options)) return 0;
        if (options.list) {
            std::printf("materials:");
            for (uint32_t i = 0; i < FW_MATERIAL_PRESET_COUNT; ++i) {
                std::string preset = fwMaterialPresetName(i);
                std::replace(preset.begin(), preset.end(), ' ', '_');
                std::printf(" %s", preset.c_str());
            }
            std::printf("\n");
            return 0;
        }
        return settings.neutral ? showNeutral(options, settings) : run(options, settings);
    });
}
