// A flamethrower against nine walls, one screen each. The target burns, and the object behind it
// must not. Window: drag to turn, wheel to zoom.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <vector>

#include "common/camera.h"
#include "common/cube.h"
#include "common/filming.h"
#include "common/fire_host.h"
#include "common/studio.h"

namespace {

struct Box {
    glm::vec3 center, half;  // m
    float turn = 0;          // rad about y
    bool wall = true;        // false: the object that must, or must not, ignite
};

constexpr float kPower = 700;   // kW
constexpr float kFlows = 0.8f;  // share of a case's time with the jet on; afterwards stuck fuel
                                // burns

struct Case {
    const char* name;
    glm::vec3 nozzle, direction;
    glm::vec3 swing;  // m, amplitude of its motion to either side over the case's time
    std::vector<Box> boxes;
    bool through;  // the object behind must burn
};

const std::vector<Case>& cases() {
    const glm::vec3 nozzle{-1.6f, 1.0f, 0}, ahead{1, 0, 0}, still{0};
    const Box behind{{3.0f, 0.75f, 0}, {0.07f, 0.75f, 0.5f}, 0, false};
    const Box wall{{1.6f, 0.9f, 0}, {0.08f, 0.9f, 1.2f}};
    static const std::vector<Case> all = {
        {"closed wall", nozzle, ahead, still, {wall, behind}, false},
        {"hole",
         nozzle,
         ahead,
         still,
         {{{1.6f, 0.9f, -0.85f}, {0.08f, 0.9f, 0.5f}},
          {{1.6f, 0.9f, 0.85f}, {0.08f, 0.9f, 0.5f}},
          behind},
         true},
        {"corner",
         nozzle,
         ahead,
         still,
         {{{1.9f, 0.9f, -0.5f}, {0.08f, 0.9f, 0.75f}, 0.75f},
          {{1.9f, 0.9f, 0.5f}, {0.08f, 0.9f, 0.75f}, -0.75f},
          behind},
         false},
        {"grazing",
         nozzle,
         {1, 0, 0.22f},
         still,
         {{{1.5f, 0.9f, 0.75f}, {1.2f, 0.9f, 0.08f}},
          {{1.8f, 0.75f, 1.3f}, {0.6f, 0.75f, 0.06f}, 0, false}},
         false},
        {"nozzle in the wall", {1.62f, 1.0f, 0}, ahead, still, {wall, behind}, false},
        {"door beside the jet",
         nozzle,
         ahead,
         still,
         {{{0.6f, 0.9f, 0.62f}, {0.7f, 0.9f, 0.06f}}, behind},
         true},
        {"thin wall",
         nozzle,
         ahead,
         {0, 0, 0.5f},  // the whole stream hits the wall
         {{{1.6f, 0.9f, 0}, {0.07f, 0.9f, 1.1f}}, behind},
         false},
        {"the occluder burns",
         nozzle,
         ahead,
         still,
         {{{1.4f, 0.75f, 0}, {0.07f, 0.75f, 0.7f}, 0, false}, behind},
         false},
        {"moving owner",
         nozzle,
         ahead,
         {0, 0, 1.6f},
         {{{1.6f, 0.9f, -0.9f}, {0.08f, 0.9f, 0.8f}}, behind},
         true},
    };
    return all;
}

struct Range {  // the current case
    std::vector<FwBurnableMeshId> boxes;
    FwFireEmitterId jet{};
    size_t shown = ~size_t(0);
    std::vector<float> burnt;  // m^2 that ever burnt, of the object behind each wall
};

void setUp(sample::FireHost& fire, FwMeshId cube, const FwMaterialId materials[2], size_t number,
           Range& range) {
    const auto ended = [&] {
        if (range.shown == ~size_t(0)) return;
        range.burnt.push_back(fire.objectState(range.boxes.back()).burntFraction);
        for (const FwBurnableMeshId box : range.boxes)
            fire.check(fwWorld_DestroyBurnableMesh(fire.world, box), "fwWorld_DestroyBurnableMesh");
        fire.check(fwWorld_DestroyFireEmitter(fire.world, range.jet), "fwWorld_DestroyFireEmitter");
        range.boxes.clear();
    };
    ended();
    range.shown = number;
    if (number >= cases().size()) return;
    const Case& what = cases()[number];
    for (const Box& box : what.boxes) {
        FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
        def.mesh = cube;
        def.materials[0] = materials[box.wall ? 0 : 1];
        const float s = std::sin(box.turn), c = std::cos(box.turn);
        const glm::vec3 size = 2.0f * box.half;
        const float placed[16] = {size.x * c,
                                  0,
                                  -size.x * s,
                                  0,
                                  0,
                                  size.y,
                                  0,
                                  0,
                                  size.z * s,
                                  0,
                                  size.z * c,
                                  0,
                                  box.center.x,
                                  box.center.y,
                                  box.center.z,
                                  1};
        std::memcpy(def.transform, placed, sizeof placed);
        FwBurnableMeshId id{};
        fire.check(fwWorld_CreateBurnableMesh(fire.world, &def, &id), "fwWorld_CreateBurnableMesh");
        range.boxes.push_back(id);
    }
    FwFireEmitterDef jet = fwDefaultFireEmitterDef();
    jet.flags = FW_EMITTER_JET | FW_EMITTER_IGNITES | FW_EMITTER_GROUND;
    jet.power = kPower;
    jet.stick = 0.3f;
    jet.stickTime = 4;
    for (int i = 0; i < 3; ++i) {
        jet.position[i] = what.nozzle[i];
        jet.direction[i] = what.direction[i];
    }
    fire.check(fwWorld_CreateFireEmitter(fire.world, &jet, &range.jet),
               "fwWorld_CreateFireEmitter");
}

int run(const sample::Options& options, float seconds, const sample::FireLook& look) {
    sample::ValidationLog validation;
    {
        const sample::VulkanHost host(sample::hostRequest(options, validation));
        sample::StageRequest stageRequest;
        stageRequest.title = "Flamewright: flamethrower";
        stageRequest.applyOptions(options);
        const auto count = static_cast<float>(cases().size());
        sample::Stage stage(host, options, stageRequest,
                            sample::framesOf(options, seconds * count));
        sample::Studio studio(host, stage, {0.8f, 0, 0}, 4.0f);
        FwWorldDef worldDef = fwDefaultWorldDef();
        worldDef.seed = options.seed;
        worldDef.paceFactor = 12;
        sample::FireHost fire(host, worldDef);
        fire.registerTarget(stage, true);
        const FwMeshId cube = sample::makeCube(fire);
        FwMaterialId materials[2]{};
        for (int i = 0; i < 2; ++i) {
            FwMaterialDef def = fwDefaultMaterialDef();
            fire.check(fwInitMaterialPreset(&def, i ? FW_MATERIAL_THATCH : FW_MATERIAL_PINE),
                       "fwInitMaterialPreset");
            fire.check(fwWorld_CreateMaterial(fire.world, &def, &materials[i]),
                       "fwWorld_CreateMaterial");
        }

        FwView view = fwDefaultView();
        look.applyLight(view, 0.06f, 2.0f);
        sample::OrbitCamera orbit;
        orbit.target = {0.9f, 0.95f, 0};
        orbit.distance = 9.0f;
        orbit.yaw = glm::radians(-24.0f);
        orbit.pitch = glm::radians(14.0f);
        orbit.fieldOfView = 0.36f;
        sample::FilmRequest film;
        film.name = "flamethrower";
        film.animationWidth = 720;
        film.stripWidth = 1280;
        film.stripCount = static_cast<uint32_t>(cases().size());
        film.columns = 3;
        sample::Filming filming(stage, options, film);

        Range range;
        sample::StageFrame frame;
        while (stage.next(frame)) {
            orbit.turn(frame.input.dragX, frame.input.dragY);
            orbit.zoom(frame.input.wheel);
            sample::setCamera(view, look.camera(orbit, {0, 1, 0}), frame);
            const double at = frame.time / static_cast<double>(seconds);
            const size_t number = static_cast<size_t>(at) % cases().size();
            if (number != range.shown) setUp(fire, cube, materials, number, range);
            const Case& what = cases()[number];
            const auto part = static_cast<float>(at - std::floor(at));
            const glm::vec3 place = what.nozzle + what.swing * std::sin(6.2832f * part);
            const float position[3] = {place.x, place.y, place.z};
            fire.check(fwWorld_MoveFireEmitter(fire.world, range.jet, position, nullptr),
                       "fwWorld_MoveFireEmitter");
            fire.check(
                fwWorld_SetFireEmitterPower(fire.world, range.jet, part < kFlows ? kPower : 0),
                "fwWorld_SetFireEmitterPower");
            sample::showStudio(frame, stage, studio, fire, view);
        }

        if (options.headless) {
            setUp(fire, cube, materials, cases().size(), range);
            sample::Summary summary;
            summary.title = "A flamethrower against nine walls";
            summary.rows.emplace_back("device", host.properties.deviceName);
            for (size_t i = 0; i < range.burnt.size() && i < cases().size(); ++i) {
                const bool burnt = range.burnt[i] > 0;
                summary.rows.emplace_back(
                    cases()[i].name,
                    std::string(burnt ? "object behind burns" : "object behind does not burn") +
                        (burnt == cases()[i].through ? ", as expected" : ": WRONG"));
            }
            filming.finish(summary, fire);
        }
    }
    return validation.exitCode();
}

}  // namespace

int main(int argc, char** argv) {
    return sample::guardedMain("09_flamethrower", [&] {
        sample::Options options;
        options.fps = 30.0;
        options.width = 640;
        options.height = 360;
        float seconds = 3;
        sample::FireLook look;
        sample::OptionParser parser("09_flamethrower", "a flamethrower against nine walls");
        parser.addNumber("--seconds", "time per wall", seconds, 0.2f, 60.0f);
        look.addTo(parser);
        parser.addCompositeFlags(options);
        if (!parser.parse(argc, argv, options)) return 0;
        if (options.list) {
            for (const Case& what : cases()) std::printf("%s\n", what.name);
            return 0;
        }
        return run(options, seconds, look);
    });
}
