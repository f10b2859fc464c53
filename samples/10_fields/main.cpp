// Particle fields: fire, smoke and water at 64 x 64 and at 32 x 32 cells, as billboards (behind, on
// blocks) and as spheroids (in front). On the right, two boards ignite alike; water extinguishes
// one. Window: drag to turn, wheel to zoom.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "common/camera.h"
#include "common/cube.h"
#include "common/filming.h"
#include "common/fire_host.h"
#include "common/studio.h"

namespace {

struct Exhibit {
    uint32_t preset, shape, cells;  // cells: per side
    float x, z, width, height;      // m
};
constexpr float kStone = 0.62f;  // m, height of the blocks
constexpr Exhibit kExhibits[] = {
    {FW_FIELD_FIRE, FW_FIELD_BILLBOARD, 64, -2.75f, -1.1f, 1.0f, 1.35f},
    {FW_FIELD_FIRE, FW_FIELD_BILLBOARD, 32, -1.65f, -1.1f, 1.0f, 1.35f},
    {FW_FIELD_SMOKE, FW_FIELD_BILLBOARD, 64, -0.55f, -1.1f, 1.2f, 1.7f},
    {FW_FIELD_SMOKE, FW_FIELD_BILLBOARD, 32, 0.55f, -1.1f, 1.2f, 1.7f},
    {FW_FIELD_WATER, FW_FIELD_BILLBOARD, 64, 1.65f, -1.1f, 1.1f, 1.3f},
    {FW_FIELD_WATER, FW_FIELD_BILLBOARD, 32, 2.75f, -1.1f, 1.1f, 1.3f},
    {FW_FIELD_FIRE, FW_FIELD_SPHEROID, 64, -2.3f, 0.5f, 0.8f, 1.0f},
    {FW_FIELD_FIRE, FW_FIELD_DISPLACED, 32, -1.4f, 0.5f, 0.8f, 1.0f},
    {FW_FIELD_SMOKE, FW_FIELD_SPHEROID, 64, -0.45f, 0.5f, 0.85f, 0.95f},
    {FW_FIELD_SMOKE, FW_FIELD_DISPLACED, 32, 0.45f, 0.5f, 0.85f, 0.95f},
    {FW_FIELD_WATER, FW_FIELD_SPHEROID, 64, 1.4f, 0.5f, 0.85f, 0.8f},
    {FW_FIELD_WATER, FW_FIELD_DISPLACED, 32, 2.3f, 0.5f, 0.85f, 0.8f},
};

FwParticleFieldDef defOf(const Exhibit& exhibit, const sample::FireHost& fire) {
    FwParticleFieldDef def = fwDefaultParticleFieldDef();
    fire.check(fwInitFieldPreset(&def, exhibit.preset), "fwInitFieldPreset");
    def.shape = exhibit.shape;
    def.width = def.height = exhibit.cells;
    // Speeds are in cells per second, so half the cells take half the time.
    def.life *=
        static_cast<float>(exhibit.cells) / (exhibit.shape == FW_FIELD_BILLBOARD ? 32.0f : 22.0f);
    def.position[0] = exhibit.x;
    def.position[1] = exhibit.shape == FW_FIELD_BILLBOARD ? kStone : 0.03f;
    def.position[2] = exhibit.z;
    def.size[0] = def.size[2] = exhibit.width;
    def.size[1] = exhibit.height;
    if (exhibit.shape != FW_FIELD_BILLBOARD) def.sourceSize = 1;
    return def;
}

// Two straw boards that face the camera, as the water's billboard does. They ignite before the
// water reaches the first one.
constexpr float kBoardX[] = {3.75f, 4.75f}, kBoardZ = -0.5f, kBoardSide = 0.8f,
                kBoardThick = 0.09f;  // m
constexpr float kBoardTurn = -0.26f;  // rad about y
constexpr double kLitAfter = 0.4;     // s

// Returns a point `out` m before the centre of a board's base.
glm::vec3 beforeBoard(float x, float out) {
    return {x + out * std::sin(kBoardTurn), 0, kBoardZ + out * std::cos(kBoardTurn)};
}

struct Boards {
    FwBurnableMeshId boards[2]{};
    bool lit = false;
};

Boards makeBoards(sample::FireHost& fire) {
    Boards made;
    FwMaterialDef straw = fwDefaultMaterialDef();
    fire.check(fwInitMaterialPreset(&straw, FW_MATERIAL_THATCH), "fwInitMaterialPreset");
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    def.mesh = sample::makeCube(fire);
    fire.check(fwWorld_CreateMaterial(fire.world, &straw, &def.materials[0]),
               "fwWorld_CreateMaterial");
    for (int i = 0; i < 2; ++i) {
        const float across = std::cos(kBoardTurn), ahead = std::sin(kBoardTurn);
        def.transform[0] = kBoardSide * across;
        def.transform[2] = kBoardSide * -ahead;
        def.transform[5] = 1.5f * kBoardSide;
        def.transform[8] = kBoardThick * ahead;
        def.transform[10] = kBoardThick * across;
        def.transform[12] = kBoardX[i];
        def.transform[13] = 0.75f * kBoardSide;
        def.transform[14] = kBoardZ;
        fire.check(fwWorld_CreateBurnableMesh(fire.world, &def, &made.boards[i]),
                   "fwWorld_CreateBurnableMesh");
    }
    FwParticleFieldDef water = fwDefaultParticleFieldDef();
    fire.check(fwInitFieldPreset(&water, FW_FIELD_WATER), "fwInitFieldPreset");
    water.flags |= FW_FIELD_WETS;
    const glm::vec3 place = beforeBoard(kBoardX[0], kBoardThick);
    std::copy_n(&place[0], 3, water.position);
    water.rotation[1] = std::sin(0.5f * kBoardTurn);
    water.rotation[3] = std::cos(0.5f * kBoardTurn);
    water.size[0] = 1.2f * kBoardSide;
    water.size[1] = 1.6f * kBoardSide;
    water.sourceSize = 1;
    FwParticleFieldId id{};
    fire.check(fwWorld_CreateParticleField(fire.world, &water, &id), "fwWorld_CreateParticleField");
    return made;
}

void lightBoards(sample::FireHost& fire, Boards& boards) {
    boards.lit = true;
    for (const float x : kBoardX) {
        FwIgnitionDef match = fwDefaultIgnitionDef();
        const glm::vec3 place = beforeBoard(x, 0.5f * kBoardThick);
        std::copy_n(&place[0], 3, match.position);
        match.position[1] = 0.6f * kBoardSide;
        match.radius = 0.08f;
        fire.check(fwWorld_Ignite(fire.world, &match, nullptr), "fwWorld_Ignite");
    }
}

int run(const sample::Options& options, float seconds, float dusk, float wind) {
    sample::ValidationLog validation;
    {
        const sample::VulkanHost host(sample::hostRequest(options, validation));
        sample::StageRequest stageRequest;
        stageRequest.title = "Flamewright: particle fields";
        sample::Stage stage(host, options, stageRequest, sample::framesOf(options, seconds));
        sample::Studio studio(host, stage, {0, 0, 0}, 1.6f);
        for (const Exhibit& exhibit : kExhibits)
            if (exhibit.shape == FW_FIELD_BILLBOARD)
                studio.addBlock({exhibit.x, 0.5f * kStone, exhibit.z},
                                {0.36f, 0.5f * kStone, 0.22f});

        FwWorldDef worldDef = fwDefaultWorldDef();
        worldDef.seed = options.seed;
        worldDef.wind[0] = wind;
        worldDef.paceFactor = 8;  // boards burn within seconds
        sample::FireHost fire(host, worldDef);
        fire.registerTarget(stage);
        FwParticleFieldId fields[std::size(kExhibits)]{};
        for (size_t i = 0; i < std::size(kExhibits); ++i) {
            const FwParticleFieldDef def = defOf(kExhibits[i], fire);
            fire.check(fwWorld_CreateParticleField(fire.world, &def, &fields[i]),
                       "fwWorld_CreateParticleField");
        }

        Boards boards = makeBoards(fire);

        FwView view = fwDefaultView();
        sample::duskLight(view, dusk);
        sample::OrbitCamera orbit;
        orbit.target = {1.0f, 0.95f, -0.2f};
        orbit.distance = 10.6f;
        orbit.yaw = 0.0f;
        orbit.pitch = glm::radians(9.0f);
        orbit.fieldOfView = 0.36f;

        sample::FilmRequest film;
        film.name = "fields";
        film.animationWidth = 960;
        film.stripWidth = 1280;
        film.stripCount = 4;
        film.columns = 1;
        sample::Filming filming(stage, options, film);

        sample::StageFrame frame;
        while (stage.next(frame)) {
            orbit.turn(frame.input.dragX, frame.input.dragY);
            orbit.zoom(frame.input.wheel);
            sample::setCamera(view, orbit.camera(), frame);
            if (!boards.lit && frame.time >= kLitAfter) lightBoards(fire, boards);
            sample::showStudio(frame, stage, studio, fire, view);
        }

        if (options.headless) {
            sample::Summary summary;
            summary.title = "Particle fields";
            summary.rows.emplace_back("device", host.properties.deviceName);
            for (size_t i = 0; i < std::size(kExhibits); ++i) {
                FwParticleFieldState state{};
                state.structSize = sizeof state;
                fire.check(fwWorld_GetParticleFieldState(fire.world, fields[i], &state),
                           "fwWorld_GetParticleFieldState");
                char name[64], line[128];
                constexpr const char* kShapes[] = {"billboard", "spheroid", "displaced"};
                std::snprintf(name, sizeof name, "%s, %s %u",
                              fwFieldPresetName(kExhibits[i].preset), kShapes[kExhibits[i].shape],
                              kExhibits[i].cells);
                std::snprintf(line, sizeof line, "%llu particles of %llu emitted, %.0f KiB",
                              static_cast<unsigned long long>(state.inside),
                              static_cast<unsigned long long>(state.emitted),
                              static_cast<double>(state.bytes) / 1024.0);
                summary.rows.emplace_back(name, line);
            }
            for (int i = 0; i < 2; ++i) {
                const FwObjectState state = fire.objectState(boards.boards[i]);
                const bool dry = i == 1, caught = state.ignited > 0, burns = state.burning > 0;
                summary.rows.emplace_back(dry ? "dry board" : "board under water",
                                          std::string(!caught ? "did not ignite"
                                                      : burns ? "burns"
                                                              : "ignited and went out") +
                                              (caught && burns == dry ? "" : ": WRONG"));
            }
            filming.finish(summary, fire);
        }
    }
    return validation.exitCode();
}

}  // namespace

int main(int argc, char** argv) {
    return sample::guardedMain("10_fields", [&] {
        sample::Options options;
        options.fps = 30.0;
        options.width = 1280;
        options.height = 560;
        float seconds = 6, dusk = 1.2f, wind = 0;
        sample::OptionParser parser("10_fields", "particle fields: fire, smoke and water");
        parser.addNumber("--seconds", "length of a headless run", seconds, 0.1f, 600.0f);
        parser.addNumber("--daylight", "light of the scene, 1: dusk", dusk, 0.0f, 10.0f);
        parser.addNumber("--wind", "m/s, to the right", wind, -20.0f, 20.0f);
        if (!parser.parse(argc, argv, options)) return 0;
        if (options.list) {
            for (uint32_t i = 0; i < FW_FIELD_PRESET_COUNT; ++i)
                std::printf("%s\n", fwFieldPresetName(i));
            return 0;
        }
        return run(options, seconds, dusk, wind);
    });
}
