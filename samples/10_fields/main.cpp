// Particle fields: fire, smoke and water, each at 64 x 64 and at 32 x 32 cells, on cards (behind,
// on blocks) and on spheroids (in front). In a window: drag to turn, wheel to zoom.
#include <cstdio>
#include <iterator>

#include "common/camera.h"
#include "common/filming.h"
#include "common/fire_host.h"
#include "common/studio.h"

namespace {

struct Exhibit {
    uint32_t preset, shape, cells;  // cells: of a side
    float x, z, width, height;      // m
};
constexpr float kStone = 0.62f;  // m, height of the blocks
constexpr Exhibit kExhibits[] = {
    {FW_FIELD_FIRE, FW_FIELD_CARD, 64, -2.75f, -1.1f, 1.0f, 1.35f},
    {FW_FIELD_FIRE, FW_FIELD_CARD, 32, -1.65f, -1.1f, 1.0f, 1.35f},
    {FW_FIELD_SMOKE, FW_FIELD_CARD, 64, -0.55f, -1.1f, 1.2f, 1.7f},
    {FW_FIELD_SMOKE, FW_FIELD_CARD, 32, 0.55f, -1.1f, 1.2f, 1.7f},
    {FW_FIELD_WATER, FW_FIELD_CARD, 64, 1.65f, -1.1f, 1.1f, 1.3f},
    {FW_FIELD_WATER, FW_FIELD_CARD, 32, 2.75f, -1.1f, 1.1f, 1.3f},
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
    // Speeds are in cells: with half as many the same takes half as long.
    def.life *=
        static_cast<float>(exhibit.cells) / (exhibit.shape == FW_FIELD_CARD ? 32.0f : 22.0f);
    def.position[0] = exhibit.x;
    def.position[1] = exhibit.shape == FW_FIELD_CARD ? kStone : 0.03f;
    def.position[2] = exhibit.z;
    def.size[0] = def.size[2] = exhibit.width;
    def.size[1] = exhibit.height;
    if (exhibit.shape != FW_FIELD_CARD) def.sourceSize = 1;
    return def;
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
            if (exhibit.shape == FW_FIELD_CARD)
                studio.addBlock({exhibit.x, 0.5f * kStone, exhibit.z},
                                {0.36f, 0.5f * kStone, 0.22f});

        FwWorldDef worldDef = fwDefaultWorldDef();
        worldDef.seed = options.seed;
        worldDef.wind[0] = wind;
        sample::FireHost fire(host, worldDef);
        fire.registerTarget(stage);
        FwParticleFieldId fields[std::size(kExhibits)]{};
        for (size_t i = 0; i < std::size(kExhibits); ++i) {
            const FwParticleFieldDef def = defOf(kExhibits[i], fire);
            fire.check(fwWorld_CreateParticleField(fire.world, &def, &fields[i]),
                       "fwWorld_CreateParticleField");
        }

        FwView view = fwDefaultView();
        sample::duskLight(view, dusk);
        sample::OrbitCamera orbit;
        orbit.target = {0, 0.95f, -0.2f};
        orbit.distance = 7.6f;
        orbit.yaw = 0.0f;
        orbit.pitch = glm::radians(9.0f);
        orbit.fieldOfView = 0.36f;

        sample::FilmRequest film;
        film.name = "fields";
        film.animationWidth = 960;
        film.stripWidth = 1280;
        film.moments = 4;
        film.columns = 1;
        sample::Filming filming(stage, options, film);

        sample::StageFrame frame;
        while (stage.next(frame)) {
            orbit.turn(frame.input.dragX, frame.input.dragY);
            orbit.zoom(frame.input.wheel);
            sample::setCamera(view, orbit.camera(), frame);
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
                constexpr const char* kShapes[] = {"card", "spheroid", "displaced"};
                std::snprintf(name, sizeof name, "%s, %s %u",
                              fwFieldPresetName(kExhibits[i].preset), kShapes[kExhibits[i].shape],
                              kExhibits[i].cells);
                std::snprintf(line, sizeof line, "%llu particles of %llu emitted, %.0f KiB",
                              static_cast<unsigned long long>(state.inside),
                              static_cast<unsigned long long>(state.emitted),
                              static_cast<double>(state.bytes) / 1024.0);
                summary.rows.emplace_back(name, line);
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
        float seconds = 3, dusk = 1.2f, wind = 0;
        sample::OptionParser parser("10_fields", "particle fields: fire, smoke and water");
        parser.addNumber("--seconds", "length of a headless run", seconds, 0.1f, 600.0f);
        parser.addNumber("--daylight", "of the scene, 1: dusk", dusk, 0.0f, 10.0f);
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
