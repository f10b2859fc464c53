// The nine presets of volumetric fires in a row, by night, by day, against the sky, from above,
// from inside, or with a painted profile. Window: drag to turn, wheel to zoom.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "common/camera.h"
#include "common/filming.h"
#include "common/fire_host.h"
#include "common/studio.h"

namespace {

struct Exhibit {
    uint32_t preset;
    float diameter, height;  // m
};
// The appearance scales with the flame. These sizes keep each preset's shape.
constexpr Exhibit kExhibits[] = {
    {FW_FIRE_CANDLE, 0.065f, 0.40f},     {FW_FIRE_TORCH, 0.15f, 0.36f},
    {FW_FIRE_GAS_BURNER, 0.12f, 0.34f},  {FW_FIRE_DYING_EMBERS, 0.36f, 0.0f},
    {FW_FIRE_CAMP, 0.38f, 0.40f},        {FW_FIRE_BONFIRE, 0.40f, 0.52f},
    {FW_FIRE_HOUSE, 0.52f, 0.42f},       {FW_FIRE_MAGIC_BLUE, 0.36f, 0.42f},
    {FW_FIRE_MAGIC_GREEN, 0.36f, 0.42f},
};
constexpr float kSpacing = 0.58f;  // m
constexpr float kStone = 0.12f;    // m, height of the stones below the fires

float placeOf(size_t i) {
    return kSpacing * (static_cast<float>(i) - 0.5f * static_cast<float>(std::size(kExhibits) - 1));
}

// Inverts Heskestad's flame height.
float powerFor(float height, float diameter) {
    return std::pow((height + 1.02f * diameter) / 0.235f, 2.5f);
}

// Loads a .fwprofile. Returns null if no file is named.
FwFireProfileId loadProfile(sample::FireHost& fire, const std::string& path) {
    if (path.empty()) return {};
    std::ifstream file(path, std::ios::binary);
    if (!file) throw sample::Failure(path + " cannot be read.");
    const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), {});
    FwFireProfileDef def = fwDefaultFireProfileDef();
    def.cooked = bytes.data();
    def.cookedSize = bytes.size();
    FwFireProfileId id{};
    fire.check(fwWorld_CreateFireProfile(fire.world, &def, &id), path.c_str());
    return id;
}

int run(const sample::Options& options, float seconds, const sample::FireLook& look, float wind,
        float haze, const std::string& profilePath) {
    sample::ValidationLog validation;
    {
        const sample::VulkanHost host(sample::hostRequest(options, validation));
        sample::StageRequest stageRequest;
        stageRequest.title = "Flamewright: volumetric fires";
        stageRequest.applyOptions(options);
        stageRequest.capturesScene = true;  // heat haze needs the scene
        sample::Stage stage(host, options, stageRequest, sample::framesOf(options, seconds));
        sample::Studio studio(host, stage, {0, 0, 0}, 1.6f);
        for (size_t i = 0; i < std::size(kExhibits); ++i) {
            const float half = 0.62f * kExhibits[i].diameter + 0.02f;
            studio.addBlock({placeOf(i), 0.5f * kStone, 0}, {half, 0.5f * kStone, half});
        }

        FwWorldDef worldDef = fwDefaultWorldDef();
        worldDef.seed = options.seed;
        worldDef.wind[0] = wind;
        sample::FireHost fire(host, worldDef);
        fire.registerTarget(stage);
        const FwFireProfileId profile = loadProfile(fire, profilePath);
        FwVolumetricFireId fires[std::size(kExhibits)]{};
        for (size_t i = 0; i < std::size(kExhibits); ++i) {
            FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
            fire.check(fwInitFirePreset(&def, kExhibits[i].preset), "fwInitFirePreset");
            def.profile = profile;
            def.tier = FW_FIRE_TIER_MARCH_HIGH;  // the camera is close to them
            def.position[0] = placeOf(i);
            def.position[1] = kStone;
            def.diameter = kExhibits[i].diameter;
            def.power = kExhibits[i].height > 0.0f
                            ? powerFor(kExhibits[i].height, kExhibits[i].diameter)
                            : 1.5f;
            fire.check(fwWorld_CreateVolumetricFire(fire.world, &def, &fires[i]),
                       "fwWorld_CreateVolumetricFire");
        }

        FwView view = fwDefaultView();
        view.haze = haze;
        look.applyLight(view, 0.012f, 2.0f);
        sample::OrbitCamera orbit;
        orbit.target = {0, 0.47f, 0};
        orbit.distance = 6.4f;
        orbit.yaw = 0.0f;
        orbit.pitch = glm::radians(6.0f);
        orbit.fieldOfView = 0.22f;

        sample::FilmRequest film;
        film.name = "volumetric_fire";
        film.animationWidth = 960;
        film.stripWidth = 1280;
        film.stripCount = 4;
        film.columns = 1;
        sample::Filming filming(stage, options, film);

        sample::StageFrame frame;
        while (stage.next(frame)) {
            orbit.turn(frame.input.dragX, frame.input.dragY);
            orbit.zoom(frame.input.wheel);
            sample::setCamera(view, look.camera(orbit, {placeOf(4), kStone + 0.16f, 0}), frame);
            sample::showStudio(frame, stage, studio, fire, view);
        }

        if (options.headless) {
            sample::Summary summary;
            summary.title = "Volumetric fires";
            summary.rows.emplace_back("device", host.properties.deviceName);
            for (size_t i = 0; i < std::size(kExhibits); ++i) {
                FwVolumetricFireState state{};
                state.structSize = sizeof state;
                fire.check(fwWorld_GetVolumetricFireState(fire.world, fires[i], &state),
                           "fwWorld_GetVolumetricFireState");
                char line[96];
                std::snprintf(line, sizeof line, "%.1f kW, %.2f m high, %.1f pulses a second",
                              static_cast<double>(state.power), static_cast<double>(state.height),
                              static_cast<double>(state.pulseRate));
                summary.rows.emplace_back(fwFirePresetName(kExhibits[i].preset), line);
            }
            filming.finish(summary, fire);
        }
    }
    return validation.exitCode();
}

}  // namespace

int main(int argc, char** argv) {
    return sample::guardedMain("07_volumetric_fire", [&] {
        sample::Options options;
        options.fps = 30.0;
        options.width = 1280;
        options.height = 300;
        float seconds = 2, wind = 0, haze = 1;
        std::string profile;
        sample::FireLook look;
        sample::OptionParser parser("07_volumetric_fire", "volumetric fires of nine kinds");
        parser.addNumber("--seconds", "length of a headless run", seconds, 0.1f, 600.0f);
        parser.addNumber("--wind", "m/s, to the right", wind, -20.0f, 20.0f);
        parser.addNumber("--haze", "strength of the heat haze", haze, 0.0f, 8.0f);
        parser.addText("--profile", "FILE", "a .fwprofile for all nine", profile);
        look.addTo(parser);
        parser.addFlag("--half", "flames and smoke at half resolution", options.halfEffects);
        if (!parser.parse(argc, argv, options)) return 0;
        if (options.list) {
            for (const Exhibit& exhibit : kExhibits)
                std::printf("%s\n", fwFirePresetName(exhibit.preset));
            return 0;
        }
        return run(options, seconds, look, wind, haze, profile);
    });
}
