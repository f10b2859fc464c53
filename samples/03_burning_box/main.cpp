// A box of twelve triangles burns: refined just ahead of the fire, it recedes, chars and opens.
// Burnt-out parts become coarse again. --plain draws the twelve triangles; --published adds a
// second box, refined by the published scheme. 2,000 flame and 500 smoke flipbook particles rise
// from burning tiles; --tongues draws tile flames instead.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/filming.h"
#include "common/fire_host.h"
#include "common/studio.h"
#include "common/turntable.h"
#include "flamewright_reference.h"

namespace {

struct Settings {
    bool plain = false, published = false, tongues = false;
    float seconds = 12;      // length of a headless run
    float pace = 60;         // burns boards of 20 mm within the run
    float depth = 5;         // bisections of an edge
    float turn = 0;          // degrees per second
    float wall = 0.02f;      // m
    float distance = 2.35f;  // m
};

struct Box {
    std::vector<float> positions;
    std::vector<uint32_t> indices;
};

// Eight shared vertices, twelve triangles, counter-clockwise from outside.
Box makeBox(glm::vec3 low, glm::vec3 high) {
    Box box;
    for (int i = 0; i < 8; ++i)
        for (int c = 0; c < 3; ++c) box.positions.push_back((i >> c & 1) ? high[c] : low[c]);
    box.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                   2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    return box;
}

constexpr float kApart = 0.6f;  // m, of two boxes from the centre

FwBurnableMeshDef describeBox(sample::FireHost& fire, const Box& box, const Settings& settings) {
    FwMeshDef mesh = fwDefaultMeshDef();
    mesh.positions = box.positions.data();
    mesh.indices = box.indices.data();
    mesh.vertexCount = static_cast<uint32_t>(box.positions.size() / 3);
    mesh.indexCount = static_cast<uint32_t>(box.indices.size());
    mesh.texelsPerMetre = 128;
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    fire.check(fwWorld_CreateMesh(fire.world, &mesh, &def.mesh), "fwWorld_CreateMesh");
    FwMaterialDef pine = fwDefaultMaterialDef();
    pine.thickness = settings.wall;
    pine.spreadRate *= 2;  // dry kindling
    fire.check(fwWorld_CreateMaterial(fire.world, &pine, &def.materials[0]),
               "fwWorld_CreateMaterial");
    def.refineDepth = static_cast<uint32_t>(std::lround(settings.depth));
    return def;
}

FwBurnableMeshId placeBox(sample::FireHost& fire, FwBurnableMeshDef def, uint32_t refined,
                          glm::vec3 aside) {
    def.flags |= refined;
    for (int i = 0; i < 3; ++i) def.transform[12 + i] = aside[i];
    FwBurnableMeshId object{};
    fire.check(fwWorld_CreateBurnableMesh(fire.world, &def, &object), "fwWorld_CreateBurnableMesh");
    return object;
}

FwFlipbookId openFlipbook(sample::FireHost& fire, uint32_t preset) {
    FwFlipbookDef def = fwDefaultFlipbookDef();
    def.preset = preset;
    FwFlipbookId id{};
    fire.check(fwWorld_CreateFlipbook(fire.world, &def, &id), "fwWorld_CreateFlipbook");
    return id;
}

// Adds flames and smoke. The burning tiles feed both, and the device finds them.
void addParticles(sample::FireHost& fire, FwBurnableMeshId object) {
    FwFireEmitterDef flames = fwDefaultFireEmitterDef();
    flames.shape = FW_EMITTER_MESH;
    flames.object = object;
    flames.flags = FW_EMITTER_GROUND;
    flames.power = 220;  // about the peak power of the whole box
    flames.maxParticles = 2000;
    flames.life = 0.62f;
    flames.lifeVariance = 0.4f;
    flames.rate = 2000 / (1.1f * flames.life);
    flames.size0 = 0.085f;
    flames.size1 = 0.20f;
    flames.speed = 0.35f;
    flames.temperature = 1500;
    flames.sparks = 0.02f;
    flames.smoke = 0;
    flames.fireFlipbooks[0] = openFlipbook(fire, FW_FLIPBOOK_ROLL);
    flames.fireFlipbooks[1] = openFlipbook(fire, FW_FLIPBOOK_PUFF);
    flames.sparkFlipbook = openFlipbook(fire, FW_FLIPBOOK_SPARK);
    FwFireEmitterDef smoke = flames;
    smoke.maxParticles = 500;
    smoke.sparks = 0;
    smoke.smoke = 1;
    smoke.life = 0.55f;
    smoke.smokeLife = 5;
    smoke.smokeDensity = 0.9f;
    smoke.rate = 500 / (1.1f * smoke.life * (1 + smoke.smokeLife));
    smoke.size0 = 0.10f;
    smoke.size1 = 0.34f;
    smoke.smokeFlipbooks[0] = openFlipbook(fire, FW_FLIPBOOK_SMOKE);
    smoke.smokeFlipbooks[1] = openFlipbook(fire, FW_FLIPBOOK_HAZE);
    for (const FwFireEmitterDef* def : {&flames, &smoke}) {
        FwFireEmitterId id{};
        fire.check(fwWorld_CreateFireEmitter(fire.world, def, &id), "fwWorld_CreateFireEmitter");
    }
}

void light(sample::FireHost& fire, FwBurnableMeshId object, glm::vec3 aside) {
    FwIgnitionDef match = fwDefaultIgnitionDef();
    const glm::vec3 place = aside + glm::vec3(0.1f, 0.3f, 0.3f);
    for (int i = 0; i < 3; ++i) match.position[i] = place[i];
    match.radius = 0.02f;
    match.object = object;
    fire.check(fwWorld_Ignite(fire.world, &match, nullptr), "fwWorld_Ignite");
}

int run(const sample::Options& options, const Settings& settings) {
    const Box box = makeBox({-0.4f, 0, -0.3f}, {0.4f, 0.6f, 0.3f});
    sample::ValidationLog validation;
    {
        const sample::VulkanHost host(sample::hostRequest(options, validation));
        sample::StageRequest stageRequest;
        stageRequest.title = "Flamewright: a burning box";
        stageRequest.samples = options.noMsaa ? VK_SAMPLE_COUNT_1_BIT : VK_SAMPLE_COUNT_4_BIT;
        stageRequest.applyOptions(options);
        const uint32_t frames = sample::framesOf(options, settings.seconds);
        sample::Stage stage(host, options, stageRequest, frames);
        sample::Studio studio(host, stage, {0, 0, 0}, 0.8f);
        sample::Turntable table(
            stage,
            {.target = {0, settings.tongues ? 0.29f : 0.62f, 0},
             .distance = settings.distance * (settings.published ? 1.5f : 1.0f) *
                         (settings.tongues ? 1.0f : 1.45f),
             .yaw = glm::radians(32.0f),
             .pitch = glm::radians(20.0f),
             .fieldOfView = 0.5f},
            settings.turn);
        const FwView& view = table.view;

        FwWorldDef worldDef = fwDefaultWorldDef();
        worldDef.paceFactor = settings.pace;
        worldDef.seed = options.seed;
        worldDef.maxStepsPerFrame = 64;
        worldDef.maxRefinedTriangles = 60000;
        if (!settings.tongues) worldDef.maxFlames = 0;
        sample::FireHost fire(host, worldDef);
        fire.registerTarget(stage, true);
        const FwBurnableMeshDef def = describeBox(fire, box, settings);
        // To the right of the initial camera.
        const glm::vec3 right(std::cos(table.orbit.yaw), 0, -std::sin(table.orbit.yaw));
        const glm::vec3 aside = right * (settings.published ? kApart : 0.0f);
        const FwBurnableMeshId object =
            placeBox(fire, def, settings.plain ? 0u : uint32_t(FW_BURNABLE_REFINE), -aside);
        FwBurnableMeshId other{};
        if (settings.published) other = placeBox(fire, def, FW_BURNABLE_REFINE_PUBLISHED, aside);
        if (!settings.tongues) addParticles(fire, object);
        std::vector<float> positions = box.positions;
        std::vector<uint32_t> indices = box.indices;
        if (settings.published) {
            for (size_t i = 0; i < box.positions.size(); ++i)
                positions.push_back(box.positions[i] + aside[int(i % 3)]);
            for (size_t i = 0; i < box.positions.size(); ++i) positions[i] -= aside[int(i % 3)];
            for (const uint32_t i : box.indices)
                indices.push_back(i + static_cast<uint32_t>(box.positions.size() / 3));
        }
        studio.castShadow(positions, indices, glm::mat4(1.0f),
                          {view.sunDirection[0], view.sunDirection[1], view.sunDirection[2]});

        sample::Filming filming(stage, options, {.name = "burning_box"});
        uint32_t most[2] = {}, last[2] = {};  // triangles: this refinement, the published one
        sample::StageFrame frame;
        while (table.next(frame)) {
            if (frame.number == 1) {  // the first frame shows the unburnt box
                light(fire, object, -aside);
                if (settings.published) light(fire, other, aside);
            }
            sample::showStudio(frame, stage, studio, fire, view);
            for (int i = 0; i < (settings.published ? 2 : 1); ++i) {
                last[i] = fire.objectState(i ? other : object).refinedTriangles;
                most[i] = std::max(most[i], last[i]);
            }
        }
        if (options.headless) {
            const FwObjectState state = fire.objectState(object);
            char line[160];
            sample::Summary summary;
            summary.title = "A box of twelve triangles";
            summary.rows.emplace_back("device", host.properties.deviceName);
            std::snprintf(line, sizeof line, "%.0f times real speed; %.0f %% ignited",
                          settings.pace, 100.0f * state.burntFraction);
            summary.rows.emplace_back("fire", line);
            for (int i = 0; i < (settings.published ? 2 : 1); ++i) {
                std::snprintf(line, sizeof line, "at most %u triangles, %u at the end", most[i],
                              last[i]);
                summary.rows.emplace_back(i ? "as published" : "refined", line);
            }
            filming.finish(summary, fire);
        }
    }
    return validation.exitCode();
}

}  // namespace

int main(int argc, char** argv) {
    return sample::guardedMain("03_burning_box", [&] {
        sample::Options options;
        options.fps = 10.0;
        options.width = 640;
        options.height = 480;
        Settings settings;
        sample::OptionParser parser("03_burning_box", "twelve triangles burn");
        parser.addFlag("--plain", "without refinement", settings.plain);
        parser.addFlag("--published", "adds a box refined by the published scheme",
                       settings.published);
        parser.addFlag("--tongues", "tile flames instead of particles", settings.tongues);
        parser.addNumber("--depth", "bisections of an edge", settings.depth, 0.0f, 5.0f);
        parser.addNumber("--pace", "time scale of the burn", settings.pace, 0.1f, 1000.0f);
        parser.addNumber("--seconds", "length of a headless run", settings.seconds, 0.1f, 600.0f);
        parser.addNumber("--turn", "turntable, degrees a second", settings.turn, -360.0f, 360.0f);
        parser.addNumber("--wall", "thickness of the boards, m", settings.wall, 0.001f, 0.1f);
        parser.addNumber("--distance", "of the camera, m", settings.distance, 0.3f, 50.0f);
        parser.addFlag("--no-msaa", "one sample a pixel instead of four", options.noMsaa);
        parser.addCompositeFlags(options);
        if (!parser.parse(argc, argv, options)) return 0;
        if (options.list) {
            std::printf("one box\n");
            return 0;
        }
        settings.tongues |= settings.published;  // compare surfaces only
        return run(options, settings);
    });
}
