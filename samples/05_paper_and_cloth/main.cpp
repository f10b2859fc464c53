// A sheet of paper and a cloth hang from rods in a light wind; both are lit below. --compare: two
// cloths, the left one deformed by the published springs. Window: drag to turn, wheel to zoom.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/gtc/type_ptr.hpp>

#include "common/filming.h"
#include "common/fire_host.h"
#include "common/studio.h"
#include "common/turntable.h"
#include "flamewright_reference.h"

namespace {

struct Sheet {
    std::vector<float> positions, details;
    std::vector<uint32_t> indices;
};

// `width` x `height` m, lower left corner at the origin, in the plane z = 0 plus soft waves.
Sheet makeSheet(float width, float height, float cell, float waves) {
    Sheet sheet;
    const auto columns = static_cast<uint32_t>(std::lround(width / cell));
    const auto rows = static_cast<uint32_t>(std::lround(height / cell));
    for (uint32_t y = 0; y <= rows; ++y)
        for (uint32_t x = 0; x <= columns; ++x) {
            const float u = static_cast<float>(x) / static_cast<float>(columns);
            const float v = static_cast<float>(y) / static_cast<float>(rows);
            const float z = waves * std::sin(18.0f * u) * (1.2f - v) + 0.3f * waves * v * v;
            sheet.positions.insert(sheet.positions.end(), {u * width, v * height, z});
            sheet.details.insert(sheet.details.end(), {u * width, v * height});
        }
    for (uint32_t y = 0; y < rows; ++y)
        for (uint32_t x = 0; x < columns; ++x) {
            const uint32_t a = y * (columns + 1) + x, b = a + 1, c = a + columns + 1, d = c + 1;
            if ((x + y) % 2)
                sheet.indices.insert(sheet.indices.end(), {a, b, c, b, d, c});
            else
                sheet.indices.insert(sheet.indices.end(), {a, b, d, a, d, c});
        }
    return sheet;
}

struct Exhibit {
    const char* name;
    uint32_t preset;
    float width, height, cell, waves;  // m
    glm::vec3 place;                   // m, lower left corner
    float turn;                        // degrees about the vertical
    float timeScale;                   // time scale in a run of ten seconds
    glm::vec3 match;                   // m, from the lower left corner; ignition point
    uint32_t tier = FW_BURNABLE_SHELL;
};
constexpr Exhibit kExhibits[] = {
    {"paper",
     FW_MATERIAL_PAPER,
     0.21f,
     0.297f,
     0.0075f,
     0.0f,
     {-0.42f, 0.36f, 0.05f},
     0,
     4.0f,
     {0.16f, 0.0f, 0}},
    {"cotton",
     FW_MATERIAL_COTTON,
     0.44f,
     0.56f,
     0.0125f,
     0.010f,
     {0.02f, 0.12f, 0},
     -8,
     4.5f,
     {0.30f, 0.0f, 0}},
};

constexpr float kApart = 0.58f;  // m, between two cloths

glm::mat4 poseOf(const Exhibit& exhibit) {
    return glm::rotate(glm::translate(glm::mat4(1.0f), exhibit.place), glm::radians(exhibit.turn),
                       glm::vec3(0, 1, 0));
}

FwBurnableMeshId placeExhibit(sample::FireHost& fire, const Exhibit& exhibit, float seconds) {
    const Sheet sheet = makeSheet(exhibit.width, exhibit.height, exhibit.cell, exhibit.waves);
    FwMeshDef mesh = fwDefaultMeshDef();
    mesh.positions = sheet.positions.data();
    mesh.details = sheet.details.data();
    mesh.indices = sheet.indices.data();
    mesh.vertexCount = static_cast<uint32_t>(sheet.positions.size() / 3);
    mesh.indexCount = static_cast<uint32_t>(sheet.indices.size());
    mesh.mapSize = 512;
    mesh.texelsPerMetre = 512;
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    def.flags = uint32_t{FW_BURNABLE_TWO_SIDED} | exhibit.tier;
    fire.check(fwWorld_CreateMesh(fire.world, &mesh, &def.mesh), "fwWorld_CreateMesh");
    FwMaterialDef material = fwDefaultMaterialDef();
    fire.check(fwInitMaterialPreset(&material, exhibit.preset), "fwInitMaterialPreset");
    const float timeScale = exhibit.timeScale * 10.0f / seconds;
    material.spreadRate *= timeScale;
    material.burnTime /= timeScale;
    fire.check(fwWorld_CreateMaterial(fire.world, &material, &def.materials[0]),
               "fwWorld_CreateMaterial");
    // Pin the top edge.
    FwPin pin{};
    pin.from[1] = pin.to[1] = exhibit.height;
    pin.to[0] = exhibit.width;
    pin.from[2] = pin.to[2] = 0.3f * exhibit.waves;
    pin.radius = 0.004f + 1.2f * exhibit.waves;
    if (exhibit.tier == FW_BURNABLE_SHELL) {
        def.pins = &pin;
        def.pinCount = 1;
    }
    def.ground = 0.004f;
    std::copy_n(glm::value_ptr(poseOf(exhibit)), 16, def.transform);
    FwBurnableMeshId object{};
    fire.check(fwWorld_CreateBurnableMesh(fire.world, &def, &object), "fwWorld_CreateBurnableMesh");
    return object;
}

void light(sample::FireHost& fire, FwBurnableMeshId object, const Exhibit& exhibit) {
    FwIgnitionDef def = fwDefaultIgnitionDef();
    def.object = object;
    const glm::vec4 at = poseOf(exhibit) * glm::vec4(exhibit.match, 1);
    for (int c = 0; c < 3; ++c) def.position[c] = at[c];
    def.radius = 0.012f;
    fire.check(fwWorld_Ignite(fire.world, &def, nullptr), "fwWorld_Ignite");
}

// Returns paper and cloth, or the published springs' cloth and this solver's.
std::array<Exhibit, 2> exhibitsOf(bool compare) {
    std::array<Exhibit, 2> shown = {kExhibits[0], kExhibits[1]};
    if (compare) {
        shown[0] = kExhibits[1];
        shown[0].name = "cotton, published springs";
        shown[0].tier = FW_BURNABLE_SPRINGS;
        shown[0].place.x -= kApart;
    }
    return shown;
}

void addCottonRod(sample::Studio& studio, float x) {
    studio.addBlock({x + 0.245f, 0.684f, -0.03f}, {0.27f, 0.005f, 0.005f});
    studio.addBlock({x + 0.52f, 0.34f, -0.07f}, {0.008f, 0.35f, 0.008f});
}

int run(const sample::Options& options, float seconds, bool compare) {
    const std::array<Exhibit, 2> exhibits = exhibitsOf(compare);
    sample::ValidationLog validation;
    {
        const sample::VulkanHost host(sample::hostRequest(options, validation));
        sample::StageRequest stageRequest;
        stageRequest.title = "Flamewright: paper and cloth";
        stageRequest.samples = options.noMsaa ? VK_SAMPLE_COUNT_1_BIT : VK_SAMPLE_COUNT_4_BIT;
        const uint32_t frames = sample::framesOf(options, seconds);
        sample::Stage stage(host, options, stageRequest, frames);
        sample::Studio studio(host, stage, {0, 0, 0}, 1.1f);
        // Two rods and their stands.
        addCottonRod(studio, 0);
        if (compare) {
            addCottonRod(studio, -kApart);
        } else {
            studio.addBlock({-0.32f, 0.662f, 0.02f}, {0.124f, 0.005f, 0.005f});
            studio.addBlock({-0.44f, 0.33f, 0.02f}, {0.006f, 0.33f, 0.006f});
        }

        FwWorldDef worldDef = fwDefaultWorldDef();
        worldDef.wind[0] = 0.25f;
        worldDef.wind[2] = 0.35f;
        worldDef.seed = options.seed;
        sample::FireHost fire(host, worldDef);
        fire.registerTarget(stage);
        FwBurnableMeshId objects[2]{};
        for (size_t i = 0; i < 2; ++i) objects[i] = placeExhibit(fire, exhibits[i], seconds);

        sample::Turntable table(stage, {.target = {compare ? -0.02f : 0.05f, 0.37f, 0},
                                        .distance = 1.95f,
                                        .yaw = glm::radians(18.0f),
                                        .pitch = glm::radians(8.0f),
                                        .fieldOfView = 0.46f});
        sample::Filming filming(
            stage, options, {.name = compare ? "compared" : "paper_and_cloth", .stripCount = 9});

        sample::StageFrame frame;
        while (table.next(frame)) {
            // Ignite once both hang still.
            if (frame.number == static_cast<uint32_t>(1 + frames / 12))
                for (size_t i = 0; i < 2; ++i) light(fire, objects[i], exhibits[i]);
            sample::showStudio(frame, stage, studio, fire, table.view);
        }

        if (options.headless) {
            sample::Summary summary;
            summary.title = "Paper and cloth";
            summary.rows.emplace_back("device", host.properties.deviceName);
            for (size_t i = 0; i < 2; ++i) {
                const FwObjectState state = fire.objectState(objects[i]);
                char line[96];
                std::snprintf(line, sizeof line, "%.0f %% ignited",
                              static_cast<double>(100.0f * state.burntFraction));
                summary.rows.emplace_back(exhibits[i].name, line);
            }
            filming.finish(summary, fire);
        }
    }
    return validation.exitCode();
}

}  // namespace

int main(int argc, char** argv) {
    return sample::guardedMain("05_paper_and_cloth", [&] {
        sample::Options options;
        options.fps = 24.0;
        options.width = 640;
        options.height = 400;
        float seconds = 10;
        bool compare = false;
        sample::OptionParser parser("05_paper_and_cloth", "sheets that curl, shrink and fall");
        parser.addNumber("--seconds", "length of a headless run", seconds, 0.1f, 600.0f);
        parser.addFlag("--compare", "two cloths, the left one with published springs", compare);
        parser.addFlag("--no-msaa", "one sample a pixel instead of four", options.noMsaa);
        if (!parser.parse(argc, argv, options)) return 0;
        if (options.list) {
            for (const Exhibit& exhibit : kExhibits) std::printf("%s\n", exhibit.name);
            return 0;
        }
        return run(options, seconds, compare);
    });
}
