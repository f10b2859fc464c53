// Eight materials burn side by side, boards and hanging sheets. Each has a time scale that makes
// all end together, and a wet patch that remains. Window: drag to turn, wheel to zoom.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/gtc/type_ptr.hpp>

#include "common/filming.h"
#include "common/fire_host.h"
#include "common/studio.h"
#include "common/turntable.h"
#include "panel.h"

namespace {

struct Exhibit {
    uint32_t preset;
    float thickness, bend;  // m, see makePanel
    float timeScale;        // time scale in a run of ten seconds
    float density;          // texels per metre
};

// From the left; the back row on its shelf first.
constexpr Exhibit kExhibits[] = {
    {FW_MATERIAL_PINE, 0.030f, 0, 135, 192},      {FW_MATERIAL_PAINTED_WOOD, 0.024f, 0, 115, 192},
    {FW_MATERIAL_PAPER, 0, 0.020f, 4.0f, 384},    {FW_MATERIAL_COTTON, 0, 0.016f, 4.2f, 320},
    {FW_MATERIAL_LEATHER, 0, 0.004f, 30, 256},    {FW_MATERIAL_THATCH, 0.060f, 0, 8, 192},
    {FW_MATERIAL_DRY_LEAF, 0, 0.014f, 2.6f, 320}, {FW_MATERIAL_PLASTIC, 0.012f, 0, 16, 192},
};
constexpr uint32_t kExhibitCount = sizeof kExhibits / sizeof kExhibits[0];
constexpr float kSide = 0.50f, kPitch = 0.60f, kShelf = 0.66f;  // m
constexpr float kLift = 0.04f, kRod = 0.006f;                   // m, of hanging sheets
constexpr uint32_t kBoardCells = 22, kSheetCells = 34;          // cells along a side of the front

bool hangs(const Exhibit& exhibit) { return !(exhibit.thickness > 0); }

glm::vec3 placeOf(uint32_t exhibit) {
    const float x = (static_cast<float>(exhibit % 4) - 1.5f) * kPitch;
    const float y = hangs(kExhibits[exhibit]) ? kLift : 0;
    return exhibit < 4 ? glm::vec3(x, kShelf + y, -0.24f) : glm::vec3(x, y, 0.24f);
}

void addRod(sample::Studio& studio, glm::vec3 place) {
    const float half = 0.5f * kSide + 2 * kRod, post = 0.5f * (kSide + kLift);
    studio.addBlock(place + glm::vec3(0, kSide, 0), {half, kRod, kRod});
    for (const float side : {-half, half})
        studio.addBlock(place + glm::vec3(side, post - kLift, 0), {kRod, post, kRod});
}

FwBurnableMeshId placeExhibit(sample::FireHost& fire, uint32_t number, float seconds) {
    const Exhibit& exhibit = kExhibits[number];
    const Panel panel = makePanel(kSide, kSide, exhibit.thickness, exhibit.bend,
                                  hangs(exhibit) ? kSheetCells : kBoardCells);
    FwMeshDef mesh = fwDefaultMeshDef();
    mesh.positions = panel.positions.data();
    mesh.normals = panel.normals.data();
    mesh.details = panel.details.data();
    mesh.indices = panel.indices.data();
    mesh.vertexCount = static_cast<uint32_t>(panel.positions.size() / 3);
    mesh.indexCount = static_cast<uint32_t>(panel.indices.size());
    mesh.mapSize = 1024;
    mesh.texelsPerMetre = exhibit.density;
    mesh.noiseSeed = number;
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    FwPin pin{};  // along the whole top edge
    if (hangs(exhibit)) {
        def.flags = uint32_t{FW_BURNABLE_TWO_SIDED} | uint32_t{FW_BURNABLE_SHELL};
        pin.from[0] = -0.5f * kSide;
        pin.to[0] = 0.5f * kSide;
        pin.from[1] = pin.to[1] = kSide;
        pin.radius = 0.004f + 1.1f * exhibit.bend;
        def.pins = &pin;
        def.pinCount = 1;
        def.ground = placeOf(number).y - kLift + 0.004f;
    }
    fire.check(fwWorld_CreateMesh(fire.world, &mesh, &def.mesh), "fwWorld_CreateMesh");
    FwMaterialDef material = fwDefaultMaterialDef();
    fire.check(fwInitMaterialPreset(&material, exhibit.preset), "fwInitMaterialPreset");
    const float timeScale = exhibit.timeScale * 10.0f / seconds;
    material.spreadRate *= timeScale;
    if (material.burnTime > 0) material.burnTime /= timeScale;
    // Thick fuel burns until it is consumed.
    if (!(material.burnTime > 0)) material.burnTime = 0.25f * seconds;
    fire.check(fwWorld_CreateMaterial(fire.world, &material, &def.materials[0]),
               "fwWorld_CreateMaterial");
    const glm::mat4 transform = glm::translate(glm::mat4(1.0f), placeOf(number));
    std::copy_n(glm::value_ptr(transform), 16, def.transform);
    FwBurnableMeshId object{};
    fire.check(fwWorld_CreateBurnableMesh(fire.world, &def, &object), "fwWorld_CreateBurnableMesh");
    return object;
}

void touch(sample::FireHost& fire, FwBurnableMeshId object, glm::vec3 position, float radius,
           FwIgnitionKind kind) {
    FwIgnitionDef def = fwDefaultIgnitionDef();
    def.kind = kind;
    def.object = object;
    for (int c = 0; c < 3; ++c) def.position[c] = position[c];
    def.radius = radius;
    fire.check(fwWorld_Ignite(fire.world, &def, nullptr), "fwWorld_Ignite");
}

int run(const sample::Options& options, float seconds, int only) {
    sample::ValidationLog validation;
    {
        const sample::VulkanHost host(sample::hostRequest(options, validation));
        sample::StageRequest stageRequest;
        stageRequest.title = "Flamewright: eight materials";
        stageRequest.samples = options.noMsaa ? VK_SAMPLE_COUNT_1_BIT : VK_SAMPLE_COUNT_4_BIT;
        const uint32_t frames = sample::framesOf(options, seconds);
        sample::Stage stage(host, options, stageRequest, frames);
        sample::Studio studio(host, stage, {0, 0, 0}, 2.4f);
        studio.addBlock({0, 0.5f * kShelf, -0.24f}, {2.1f * kPitch, 0.5f * kShelf, 0.10f});
        for (uint32_t i = 0; i < kExhibitCount; ++i) {
            const bool shown = only < 0 || only == static_cast<int>(i);
            if (shown && hangs(kExhibits[i])) addRod(studio, placeOf(i));
        }

        sample::FireHost fire(host, fwDefaultWorldDef());
        fire.registerTarget(stage);
        FwBurnableMeshId objects[kExhibitCount]{};
        for (uint32_t i = 0; i < kExhibitCount; ++i) {
            if (only < 0 || only == static_cast<int>(i))
                objects[i] = placeExhibit(fire, i, seconds);
        }

        sample::OrbitCamera orbit{.target = {0, 0.66f, 0},
                                  .distance = 4.05f,
                                  .yaw = glm::radians(12.0f),
                                  .pitch = glm::radians(7.0f),
                                  .fieldOfView = 0.42f};
        if (only >= 0) {
            orbit.target = placeOf(static_cast<uint32_t>(only)) + glm::vec3(0, 0.27f, 0);
            orbit.distance = 1.35f;
        }
        sample::Turntable table(stage, orbit);
        const FwView& view = table.view;
        const Panel panel = makePanel(kSide, kSide, 0.03f, 0, 1);
        std::vector<float> shadows;
        std::vector<uint32_t> shadowIndices;
        for (uint32_t i = 4; i < kExhibitCount; ++i) {
            const auto first = static_cast<uint32_t>(shadows.size() / 3);
            const glm::vec3 place = placeOf(i);
            for (size_t k = 0; k < panel.positions.size(); ++k)
                shadows.push_back(panel.positions[k] + place[static_cast<int>(k % 3)]);
            for (const uint32_t index : panel.indices) shadowIndices.push_back(first + index);
        }
        studio.castShadow(shadows, shadowIndices, glm::mat4(1.0f),
                          {view.sunDirection[0], view.sunDirection[1], view.sunDirection[2]});

        sample::Filming filming(stage, options,
                                {.name = "materials", .animationWidth = 640, .columns = 2});

        sample::StageFrame frame;
        while (table.next(frame)) {
            for (uint32_t i = 0; frame.number <= 1 && i < kExhibitCount; ++i) {
                if (objects[i].index1 == 0) continue;
                const glm::vec3 face = placeOf(i) + glm::vec3(0, 0, 0.5f * kExhibits[i].thickness);
                if (frame.number == 0)
                    touch(fire, objects[i], face + glm::vec3(0.12f, 0.36f, 0), 0.07f, FW_WET);
                else
                    touch(fire, objects[i], face + glm::vec3(-0.14f, 0.10f, 0), 0.02f, FW_IGNITE);
            }
            sample::showStudio(frame, stage, studio, fire, view);
        }

        if (options.headless) {
            sample::Summary summary;
            summary.title = "Eight materials";
            summary.rows.emplace_back("device", host.properties.deviceName);
            for (uint32_t i = 0; i < kExhibitCount; ++i) {
                if (objects[i].index1 == 0) continue;
                const FwObjectState state = fire.objectState(objects[i]);
                char line[160];
                std::snprintf(line, sizeof line, "%s; %.0f %% ignited",
                              fwMaterialPresetName(kExhibits[i].preset),
                              static_cast<double>(100.0f * state.burntFraction));
                static const char* const kPlaces[] = {
                    "back, 1st from left", "back, 2nd",  "back, 3rd",  "back, 4th",
                    "front, 1st",          "front, 2nd", "front, 3rd", "front, 4th"};
                summary.rows.emplace_back(kPlaces[i], line);
            }
            filming.finish(summary, fire);
        }
    }
    return validation.exitCode();
}

}  // namespace

int main(int argc, char** argv) {
    return sample::guardedMain("06_materials", [&] {
        sample::Options options;
        options.fps = 12.0;  // sheets fall correctly only at this rate or above
        options.width = 960;
        options.height = 540;
        float seconds = 8, only = 0;
        sample::OptionParser parser("06_materials", "eight materials side by side");
        parser.addNumber("--seconds", "length of a headless run", seconds, 0.1f, 600.0f);
        parser.addNumber("--only", "1 to 8: shows only that material, close up", only, 0.0f, 8.0f);
        parser.addFlag("--no-msaa", "one sample a pixel instead of four", options.noMsaa);
        if (!parser.parse(argc, argv, options)) return 0;
        if (options.list) {
            for (const Exhibit& exhibit : kExhibits)
                std::printf("%s\n", fwMaterialPresetName(exhibit.preset));
            return 0;
        }
        return run(options, seconds, static_cast<int>(std::lround(only)) - 1);
    });
}
