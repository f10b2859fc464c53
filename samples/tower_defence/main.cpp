// The tower-defence slice: a village, a wave of straw men, one flamethrower tower, and the wind.
// The main program only: options, the camera, and the order of a frame.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>

#include "common/filming.h"
#include "common/fire_host.h"
#include "common/progress.h"
#include "common/stage.h"
#include "game.h"
#include "throwers.h"

namespace {

struct Choices {
    std::string light = "golden", ground = "parallax";
    float wind[3] = {-2.4f, 0.0f, -2.0f};  // m/s, from the sea behind the tower
    float pace = 14.0f;                    // how much faster than real thatch the fire runs
    bool antialias = false;
    float throwers = 0;     // flamethrower towers more
    bool holdFire = false;  // they stand there alone
};

tower::Daylight daylightOf(const std::string& name) {
    if (name == "golden") return tower::goldenHour();
    if (name == "noon") return tower::noon();
    if (name == "night") return tower::moonlight();
    throw sample::Failure("--light is \"" + name + "\"; it takes golden, noon or night");
}

tower::Ground groundOf(const std::string& name) {
    if (name == "bump") return tower::Ground::kBump;
    if (name == "parallax") return tower::Ground::kParallax;
    throw sample::Failure("--ground is \"" + name + "\"; it takes bump or parallax");
}

constexpr const char* kLights[] = {"golden", "noon", "night"};  // keys 1 to 3

// The strategy camera: always the same way round, 45 degrees down; pans and zooms.
struct Overview {
    glm::vec2 pan{0, 0};  // m, x and z, within +-8
    float zoom = 1;       // of the distance, [0.35, 1.3]

    sample::Camera camera() const {
        const glm::vec3 target(-1.5f + pan.x, 0.2f, -2.9f + pan.y);
        sample::Camera camera;
        camera.target = target;
        camera.eye = target + zoom * glm::vec3(0.0f, 35.8f, 36.3f);
        camera.fieldOfView = glm::radians(29.0f);
        camera.nearPlane = 4.0f;
        camera.farPlane = 150.0f;
        return camera;
    }
    void steer(const sample::Input& input, float deltaTime, VkExtent2D size) {
        const float metres = 47.0f * zoom / std::max(1.0f, float(size.width));  // per pixel
        pan.x += -metres * (input.dragX + input.panX) + 14 * zoom * deltaTime * input.moveRight;
        pan.y +=
            -1.4f * metres * (input.dragY + input.panY) - 14 * zoom * deltaTime * input.moveForward;
        pan = glm::clamp(pan, glm::vec2(-8), glm::vec2(8));
        zoom = std::clamp(zoom * std::pow(0.92f, input.wheel), 0.35f, 1.3f);
    }
    // Without a hand at the mouse: from the whole village slowly down to the fire.
    void follow(float share) {
        const float t = share * share * (3 - 2 * share);
        pan = glm::mix(glm::vec2(0.3f, 0.6f), glm::vec2(-1.7f, 8.6f), t);
        zoom = std::exp(std::log(1.0f) * (1 - t) + std::log(0.46f) * t);
    }
};

FwView fireView(const sample::Camera& camera, const tower::Daylight& light,
                const sample::StageFrame& frame) {
    FwView view = fwDefaultView();
    sample::setCamera(view, camera, frame);
    std::copy_n(&light.toSun[0], 3, view.sunDirection);
    std::copy_n(&light.sun[0], 3, view.sunColor);
    std::copy_n(&light.sky[0], 3, view.ambientSky);
    std::copy_n(&light.ground[0], 3, view.ambientGround);
    view.emissionScale = light.emission;
    return view;
}

// Lamps and braziers light their surroundings once it is dark.
std::vector<tower::PointLight> lampLights(const village::Scene& scene) {
    std::vector<tower::PointLight> lamps;
    for (const village::Instance& instance : scene.instances) {
        const bool lamp = village::Kit(instance.model) == village::Kit::kLampPost;
        if (!lamp && village::Kit(instance.model) != village::Kit::kBrazier) continue;
        const village::Vec3 p =
            instance.frame.point(lamp ? village::Vec3{0.55f, 1.7f, 0} : village::Vec3{0, 1.6f, 0});
        lamps.push_back({{p.x, p.y, p.z},
                         6.0f,
                         lamp ? glm::vec3(1.4f, 0.72f, 0.25f) : glm::vec3(1.8f, 0.60f, 0.13f),
                         0.5f});
    }
    return lamps;
}

std::vector<tower::PointLight> gatherLights(tower::FireVillage& fires, const tower::Game& game,
                                            const tower::Throwers& throwers,
                                            const std::vector<tower::PointLight>& lamps,
                                            const tower::Daylight& light) {
    constexpr size_t kMost = 10;
    // By eye, as a photographer would: at night the eye has opened.
    const bool dark = light.windows > 1;
    constexpr float kJetIntensity = 7.0f;
    const float firePerWatt = dark ? 4.5e-5f : 2e-5f;
    std::vector<tower::PointLight> all = game.jetLights(kJetIntensity);
    throwers.addLights(kJetIntensity, all);
    const auto burning = fires.lights(firePerWatt);
    all.insert(all.end(), burning.begin(), burning.end());
    if (dark) all.insert(all.end(), lamps.begin(), lamps.end());
    auto strength = [](const tower::PointLight& l) { return l.color.r + l.color.g + l.color.b; };
    std::stable_sort(all.begin(), all.end(),
                     [&](const auto& a, const auto& b) { return strength(a) > strength(b); });
    if (all.size() > kMost) all.resize(kMost);
    return all;
}

int run(const sample::Options& options, const Choices& choices) {
    tower::Daylight light = daylightOf(choices.light);
    constexpr double kStory = 10;  // s
    const uint32_t frames = sample::framesOf(options, kStory);
    sample::Progress startUp("painting the village", 2);
    village::Scene scene = village::makeVillage(options.seed);
    const auto turrets =
        tower::placeThrowers(scene, static_cast<uint32_t>(std::lround(choices.throwers)));
    const tower::PaintedVillage painted = tower::paintVillage(scene);
    startUp.update(1);

    sample::ValidationLog validation;
    {
        const sample::VulkanHost host(sample::hostRequest(options, validation));
        sample::StageRequest stageRequest;
        stageRequest.title = "Flamewright: tower defence";
        stageRequest.exposure = light.exposure;
        stageRequest.vignette = 0.3f;
        stageRequest.bloom = 0.08f;
        if (choices.antialias) stageRequest.samples = VK_SAMPLE_COUNT_4_BIT;
        FwWorldDef worldDef = fwDefaultWorldDef();
        worldDef.paceFactor = choices.pace;
        worldDef.seed = options.seed;
        std::copy_n(choices.wind, 3, worldDef.wind);
        sample::FireHost fire(host, worldDef);
        sample::Stage stage(host, options, stageRequest, frames);
        fire.registerTarget(stage);
        tower::Renderer renderer(host, stage, scene, painted, groundOf(choices.ground));
        tower::FireVillage fires(fire, scene, painted, options.seed);
        tower::Game game(scene, fires, options.seed,
                         {choices.wind[0], choices.wind[1], choices.wind[2]});
        constexpr float kThrowerPower = 700;  // kW
        tower::Throwers throwers(fire, scene, turrets, choices.holdFire ? 0 : kThrowerPower);
        const std::vector<tower::PointLight> lamps = lampLights(scene);
        startUp.update(2);
        startUp.finish();
        if (!options.headless)
            std::printf(
                "drag or arrow keys: pan; wheel: zoom; 1 2 3: golden hour, noon, night; Escape\n");

        sample::FilmRequest film;
        film.name = "tower_defence";
        film.animationEvery = 3;
        sample::Filming filming(stage, options, film);

        Overview overview;
        const clock_t began = std::clock();
        sample::StageFrame frame;
        while (stage.next(frame)) {
            if (options.headless)
                overview.follow(frames > 1 ? float(frame.number) / float(frames - 1) : 0.0f);
            else
                overview.steer(frame.input, frame.deltaTime, frame.extent);
            for (const int key : frame.input.keys) {
                if (key < '1' || key > '3') continue;
                light = daylightOf(kLights[key - '1']);
                stage.made.exposure = light.exposure;
            }
            game.advance(frame.deltaTime);
            throwers.advance(frame.deltaTime, game.placed());
            const glm::vec3 wind = game.wind();
            fire.check(fwWorld_SetWind(fire.world, &wind[0]), "fwWorld_SetWind");

            const sample::Camera camera = overview.camera();
            const FwView view = fireView(camera, light, frame);
            const auto lights = gatherLights(fires, game, throwers, lamps, light);
            const auto& jet = game.flames(glm::normalize(camera.target - camera.eye));
            renderer.prepare(frame, {camera, light, game.placed(), lights, jet});
            fire.recordOutside(frame, view);
            stage.beginScene(frame);
            renderer.drawSolid(frame);
            fire.recordInside(frame, view);
            renderer.drawJet(frame);
            stage.endScene(frame);
            stage.finish(frame);
        }
        vkDeviceWaitIdle(host.device);

        if (options.headless) {
            sample::Summary summary;
            summary.title = "The village under attack (" + choices.light + ")";
            char perFrame[64];
            std::snprintf(perFrame, sizeof perFrame, "%.0f ms a frame, pictures included",
                          1000 * filming.seconds() / frames);
            summary.rows = {
                {"device", host.properties.deviceName},
                {"size", std::to_string(options.width) + " x " + std::to_string(options.height) +
                             ", " + std::to_string(frames) + " frames"},
                {"fire", std::to_string(fires.caught()) + " things caught, " +
                             std::to_string(fires.burning()) + " still burn, " +
                             std::to_string(game.felled()) + " enemies down"},
                {"triangles", "at most " + std::to_string(renderer.mostTriangles()) + " in a view"},
                {"throwers", std::to_string(turrets.size()) +
                                 (choices.holdFire ? " that hold their fire" : "")},
                {"time", perFrame},
                {"processor",
                 std::to_string(int(1e3 * double(std::clock() - began) / CLOCKS_PER_SEC / frames)) +
                     " ms a frame, of all threads"}};
            filming.finish(summary, fire);
        }
    }
    return validation.exitCode();
}

}  // namespace

int main(int argc, char** argv) {
    return sample::guardedMain("tower_defence", [&] {
        sample::Options options;
        options.width = 1280;
        options.height = 720;
        options.fps = 0;  // not said
        Choices choices;
        sample::OptionParser parser("tower_defence", "a village under attack, and on fire");
        parser.addText("--light", "NAME", "golden, noon or night", choices.light);
        parser.addText("--ground", "NAME", "bump or parallax: how stones and grass stand out",
                       choices.ground);
        parser.addVector("--wind", "m/s, x east, z towards the camera", choices.wind);
        parser.addNumber("--pace", "how much faster than real thatch it burns", choices.pace, 0.1f,
                         1000.0f);
        parser.addNumber("--throwers", "flamethrower towers more, along the road", choices.throwers,
                         0.0f, 200.0f);
        parser.addFlag("--hold-fire", "those do not fire", choices.holdFire);
        parser.addFlag("--msaa", "four samples a pixel", choices.antialias);
        if (!parser.parse(argc, argv, options)) return 0;
        if (options.fps == 0) options.fps = options.headless ? 10.0 : 30.0;
        if (options.list) {
            std::printf("one scene, in three lights: --light golden, noon or night\n");
            return 0;
        }
        return run(options, choices);
    });
}
