// The tower-defence game: straw and wood march on the mill, and fire is both weapon and danger. The
// main program: options and the order of a frame. The rules are in game/game.h.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <optional>
#include <string>

#include "common/filming.h"
#include "common/fire_host.h"
#include "common/progress.h"
#include "common/stage.h"
#include "game/bot.h"
#include "hud.h"
#include "overview.h"
#include "recording.h"
#include "renderer.h"
#include "rewind.h"
#include "scripted.h"
#include "siege.h"
#include "soak.h"
#include "world_def.h"

namespace {

struct Choices {
    std::string light = "waves", ground = "parallax", backend = "vulkan", record, play;
    tower::ScriptedGame scripted;
    float waves = 0, soak = 0;
    bool bot = false, antialias = false, report = false, energy = false;
};

constexpr const char* kLights[] = {"golden", "noon", "night"};

tower::Daylight daylightOf(const std::string& name) {
    if (name == "golden") return tower::goldenHour();
    if (name == "noon") return tower::noon();
    if (name == "night") return tower::moonlight();
    throw sample::Failure("--light is \"" + name + "\"; it takes golden, noon, night or waves");
}

tower::Ground groundOf(const std::string& name) {
    if (name == "bump") return tower::Ground::kBump;
    if (name == "parallax") return tower::Ground::kParallax;
    throw sample::Failure("--ground is \"" + name + "\"; it takes bump or parallax");
}

// The time of day advances from wave to wave, unless the player or an option fixes it.
class Day {
 public:
    explicit Day(const std::string& name) : held_(name != "waves") {
        if (held_) now_ = from_ = to_ = daylightOf(name);
    }
    void follow(int32_t wave, float deltaTime) {
        constexpr float kDusk = 8;  // s
        if (!held_ && wave / 2 != stage_) {
            stage_ = wave / 2;
            turn(stage_ % 3);
        }
        passed_ = std::min(1.0f, passed_ + deltaTime / kDusk);
        now_ = passed_ < 1 ? tower::mix(from_, to_, passed_) : to_;
    }
    void next() {
        held_ = true;
        turn(light_ + 1);
        passed_ = 1;
    }
    const tower::Daylight& light() const { return now_; }

 private:
    void turn(int light) {
        light_ = light % 3;
        from_ = now_;
        to_ = daylightOf(kLights[light_]);
        passed_ = 0;
    }
    bool held_;
    int32_t stage_ = 0;
    int light_ = 0;
    float passed_ = 1;
    tower::Daylight from_ = tower::goldenHour(), to_ = from_, now_ = from_;
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

// Lamps and braziers light their surroundings after dark.
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

std::vector<tower::PointLight> gatherLights(tower::FireVillage& fires, const tower::Siege& siege,
                                            const std::vector<tower::PointLight>& lamps,
                                            const tower::Daylight& light) {
    constexpr size_t kMost = 10;
    // Exposure by eye: at night the camera is more sensitive.
    const bool dark = light.windows > 1;
    constexpr float kJetIntensity = 7.0f;
    const float firePerWatt = dark ? 4.5e-5f : 2e-5f;
    std::vector<tower::PointLight> all;
    siege.addLights(kJetIntensity, all);
    const auto burning = fires.lights(firePerWatt);
    all.insert(all.end(), burning.begin(), burning.end());
    if (dark) all.insert(all.end(), lamps.begin(), lamps.end());
    auto strength = [](const tower::PointLight& l) { return l.color.r + l.color.g + l.color.b; };
    std::stable_sort(all.begin(), all.end(),
                     [&](const auto& a, const auto& b) { return strength(a) > strength(b); });
    if (all.size() > kMost) all.resize(kMost);
    return all;
}

// `ledger`: also query the energy ledger, which visits every object.
tower::FireNumbers countFires(const tower::FireVillage& fires, FwWorld* world, bool ledger) {
    tower::FireNumbers numbers{fires.burning(), fires.caught(), 0, 0, {}};
    numbers.ledger.structSize = sizeof numbers.ledger;
    if (ledger)
        tower::checkFire(world, fwWorld_GetEnergyLedger(world, &numbers.ledger),
                         "fwWorld_GetEnergyLedger");
    for (const tower::Thing& thing : fires.things) {
        numbers.megawatts += 1e-6f * thing.state.power;
        numbers.squareMetres += thing.state.burningArea;
    }
    return numbers;
}

// Returns the message of an event for the player.
const char* messageFor(const game::Event& event) {
    switch (event.type) {
        case game::Event::Type::kGotThrough:
            return "One has come to the mill!";
        case game::Event::Type::kFlashesOver:
            return "A house flashes over!";
        case game::Event::Type::kHouseLost:
            return "A house is lost";
        case game::Event::Type::kWaveBegins:
            return "They come";
        case game::Event::Type::kWaveOver:
            return "The wave is over";
        default:
            return nullptr;
    }
}

const char* nameOf(game::Order::Type type) {
    constexpr const char* kNames[] = {"nothing", "place", "upgrade", "sell", "call wave"};
    return kNames[size_t(type)];
}

// Prints the pixel positions of the plots, for a script that drives the window.
void reportPlots(const tower::Lens& lens, const tower::Battlefield& field,
                 const std::function<void(const std::string&)>& report) {
    for (size_t plot = 0; plot < game::kPlots; ++plot) {
        const village::Vec2 p = tower::metres(field.ground.plots[plot]);
        const glm::vec2 at = lens.project({p.x, village::groundHeight(p) + 0.6f, p.y});
        report("plot " + std::to_string(plot) + " at " + std::to_string(std::lround(at.x)) + " " +
               std::to_string(std::lround(at.y)));
    }
    report("size " + std::to_string(std::lround(lens.size.x)) + "x" +
           std::to_string(std::lround(lens.size.y)));
}

// Converts seconds into whole ticks.
class Clock {
 public:
    int32_t ticksIn(float deltaTime, const tower::Player& player) {
        if (player.paused) return 0;
        constexpr int32_t kMost = 8;  // per frame; the world drops the excess
        due_ += deltaTime * float(player.speed) / tower::kTickSeconds;
        const int32_t ticks = std::min(int32_t(due_), kMost);
        due_ = std::min(due_ - float(ticks), 1.0f);
        return ticks;
    }

 private:
    float due_ = 0;
};

int play(const sample::Options& options, const Choices& choices) {
    Day day(choices.light);
    constexpr double kFilmSeconds = 10;  // s
    std::optional<tower::Recorder> recorder;
    std::optional<tower::Recording> played;
    if (!choices.record.empty()) recorder.emplace(choices.record, options.seed);
    if (!choices.play.empty()) played.emplace(choices.play, options.seed);
    if (choices.soak > 0 && std::fmod(double(game::kTicksPerSecond), options.fps) != 0)
        throw sample::Failure("--soak needs frames of whole ticks: --fps 4, 8, 16 or 32");
    const auto soakFrames =
        uint32_t(double(choices.soak) * 60 * options.fps / tower::Soak::kRounds);
    const uint32_t frames = played           ? played->frames()
                            : soakFrames > 0 ? tower::Soak::framesOf(soakFrames)
                                             : sample::framesOf(options, kFilmSeconds);
    const bool byHand = !options.headless || played;
    sample::Progress startUp("painting the village", 2);
    const tower::Battlefield field = tower::makeBattlefield(options.seed);
    const tower::PaintedVillage painted = tower::paintVillage(field.scene);
    startUp.update(1);

    sample::ValidationLog validation;
    {
        const sample::VulkanHost host(sample::hostRequest(options, validation));
        sample::StageRequest stageRequest;
        stageRequest.title = "Flamewright: tower defence";
        stageRequest.exposure = day.light().exposure;
        stageRequest.vignette = 0.3f;
        stageRequest.bloom = 0.08f;
        if (choices.antialias) stageRequest.samples = VK_SAMPLE_COUNT_4_BIT;
        const FwWorldDef worldDef = tower::villageWorld(options.seed, choices.scripted.pace);
        sample::FireHost fire(host, worldDef);
        sample::Stage stage(host, options, stageRequest, frames);
        fire.registerTarget(stage);
        tower::Renderer renderer(host, stage, field.scene, painted, groundOf(choices.ground));
        tower::FireVillage fires(fire.context, fire.world, field.scene, &painted);
        tower::Siege siege(fire.world, fires, field,
                           byHand ? game::newGame(options.seed)
                                  : game::gameInProgress(field.ground, options.seed));
        tower::Rewind rewind(fire.world, siege);
        tower::Hud hud(host, stage);
        tower::Player player;
        player.showsLedger = choices.energy;
        const std::vector<tower::PointLight> lamps = lampLights(field.scene);
        startUp.update(2);
        startUp.finish();
        const bool bot = choices.bot || !byHand;
        if (!options.headless)
            std::printf(
                "1 to 4 and a click: place a tower; a click on it: U upgrades, X sells\n"
                "Space: pause; F: fast-forward; R: ten seconds back; Enter: call the wave\n"
                "drag or arrow keys: pan; wheel: zoom; N: the time of day; E: energy; Escape: "
                "leave\n");
        // Prints each action, for a script that drives the window.
        auto report = [&](const std::string& what) {
            if (!choices.report) return;
            std::printf("did: %s\n", what.c_str());
            std::fflush(stdout);
        };

        sample::FilmRequest film;
        film.name = "tower_defence";
        film.animationEvery = 3;
        sample::Filming filming(stage, options, film);
        std::optional<tower::Soak> soak;
        if (options.headless && soakFrames > 0) {
            soak.emplace(fire.context, fire.world, siege, soakFrames);
            stage.onPicture = {};
        }
        if (played)  // a replay films only marked frames
            stage.onPicture = [&](uint32_t number, sample::Picture&& picture) {
                if (played->isMarked(number))
                    sample::writePng(options.out / (std::to_string(number) + ".png"), picture);
            };

        tower::Overview overview;
        Clock clock;
        VkExtent2D extent{};
        const clock_t began = std::clock();
        sample::StageFrame frame;
        double time = 0;  // s, stops during a pause
        constexpr uint32_t kFramesUntilStill =
            5;                // frames until the window shows the paused picture
        uint32_t paused = 0;  // frames
        while (stage.next(frame)) {
            if (soak) soak->beginFrame();
            if (played) played->put(frame);
            if (recorder) recorder->frame(frame);
            if (!player.paused) time += double(frame.deltaTime);
            frame.time = time;
            if (!byHand)
                overview.follow(soak         ? soak->share()
                                : frames > 1 ? float(frame.number) / float(frames - 1)
                                             : 0.0f);
            else
                overview.steer(frame.input, frame.deltaTime, frame.extent);
            const sample::Camera camera = overview.camera();

            const tower::Lens lens(camera, frame.extent);
            if (frame.extent.width != extent.width || frame.extent.height != extent.height) {
                extent = frame.extent;
                reportPlots(lens, field, report);
            }

            // Requests come from the HUD and the bot.
            tower::HudRequests requests =
                hud.show(frame, lens, field, siege,
                         countFires(fires, fire.world, player.showsLedger), player);
            auto say = [&](const std::string& what) {
                player.said = what;
                player.messageTime = frame.time;
            };
            if (bot) requests.orders.push_back(game::botsOrder(siege.state()));
            for (const game::Order& order : requests.orders) {
                if (order.type == game::Order::Type::kNone) continue;
                const char* refused = siege.give(order);
                if (refused) say(refused);
                report(std::string(nameOf(order.type)) + " " + std::to_string(order.plot) +
                       (refused ? std::string(": ") + refused : ""));
            }
            if (requests.pause) {
                if (player.paused && recorder) recorder->markPicture();
                player.paused = !player.paused;
                report(player.paused ? "pause" : "go on");
            }
            paused = player.paused ? paused + 1 : 0;
            if (paused == kFramesUntilStill) report("stands still");
            if (requests.faster) {
                player.speed = player.speed == 4 ? 1 : player.speed * 2;
                report("speed " + std::to_string(player.speed));
            }
            if (requests.light) day.next();
            if (requests.rewind) {
                const int32_t from = siege.state().tick;
                if (rewind.goBack()) {
                    say("Time went back");
                    char line[160];
                    std::snprintf(
                        line, sizeof line,
                        "rewind %d ticks in %.0f ms, %zu snapshots of %zu KB, saved in %.1f ms",
                        from - siege.state().tick, 1e3 * rewind.loadSeconds, rewind.snapshotCount(),
                        rewind.bytes() / 1024 / rewind.snapshotCount(), 1e3 * rewind.fetchSeconds);
                    report(line);
                } else {
                    say("There is nothing to go back to yet");
                    report("no rewind yet");
                }
            }

            // Advance the game, then the world by the same time, then draw.
            const int32_t ticks = clock.ticksIn(frame.deltaTime, player);
            const int32_t second = siege.state().tick / game::kTicksPerSecond;
            siege.advance(ticks);
            if (siege.state().tick / game::kTicksPerSecond != second)
                report("second " + std::to_string(second + 1));
            for (const game::Event& event : siege.events())
                if (const char* words = messageFor(event)) say(words);
            if (siege.brokenHouses() > 0) say("A roof comes down");
            if (byHand && ticks > 0) rewind.remember();
            if (soak) soak->afterAdvance();
            day.follow(siege.state().wave, frame.deltaTime);
            const tower::Daylight& light = day.light();
            stage.made.exposure = light.exposure;
            const FwView view = fireView(camera, light, frame);
            const auto lights = gatherLights(fires, siege, lamps, light);
            sample::StageFrame step = frame;
            step.deltaTime = float(ticks) * tower::kTickSeconds;
            renderer.prepare(frame, {camera, light, siege.placed(), lights, siege.wind()});
            fire.recordOutside(step, view);
            stage.beginScene(frame);
            renderer.drawSolid(frame);
            fire.recordInside(step, view);
            stage.endScene(frame);
            stage.finish(frame);
        }
        vkDeviceWaitIdle(host.device);
        report("quit");
        if (soak)
            if (const int status = soak->report()) return status;

        if (options.headless && !played && !soak) {
            const game::State& state = siege.state();
            sample::Summary summary;
            summary.title = "The village under attack (" + choices.light + ")";
            char perFrame[64];
            std::snprintf(perFrame, sizeof perFrame, "%.0f ms per frame, pictures included",
                          1000 * filming.seconds() / frames);
            summary.rows = {
                {"device", host.properties.deviceName},
                {"size", std::to_string(options.width) + " x " + std::to_string(options.height) +
                             ", " + std::to_string(frames) + " frames"},
                {"fire", std::to_string(fires.caught()) + " objects ignited, " +
                             std::to_string(fires.burning()) + " still burn"},
                {"game", "wave " + std::to_string(state.wave + 1) + ", " +
                             std::to_string(state.felled) + " enemies felled, score " +
                             std::to_string(game::score(state))},
                {"triangles", "at most " + std::to_string(renderer.mostTriangles()) + " in a view"},
                {"time", perFrame},
                {"processor",
                 std::to_string(int(1e3 * double(std::clock() - began) / CLOCKS_PER_SEC / frames)) +
                     " ms per frame, all threads"}};
            filming.finish(summary, fire);
        }
    }
    return validation.exitCode();
}

int run(const sample::Options& options, Choices choices) {
    if (choices.backend != "vulkan" && choices.backend != "cpu")
        throw sample::Failure("--backend is \"" + choices.backend + "\"; it takes vulkan or cpu");
    if (!choices.bot || !options.headless) return play(options, choices);
    choices.scripted.seed = options.seed;
    choices.scripted.waves = int32_t(choices.waves);
    choices.scripted.server = choices.backend == "cpu";
    return tower::playScripted(choices.scripted);
}

}  // namespace

int main(int argc, char** argv) {
    return sample::guardedMain("tower_defence", [&] {
        sample::Options options;
        options.width = 1280;
        options.height = 720;
        options.fps = 0;  // unset
        Choices choices;
        sample::OptionParser parser("tower_defence", "a game: a village under attack, on fire");
        parser.addText("--light", "NAME", "golden, noon or night; waves: changes with the waves",
                       choices.light);
        parser.addText("--ground", "NAME", "bump or parallax: relief of stones and grass",
                       choices.ground);
        parser.addNumber("--pace", "how many times faster than real thatch it burns",
                         choices.scripted.pace, 0.1f, 1000.0f);
        parser.addFlag("--bot",
                       "a scripted player plays; with --headless: the game alone, no "
                       "pictures, one line of result",
                       choices.bot);
        parser.addText("--backend", "NAME", "vulkan or cpu, of --bot --headless", choices.backend);
        parser.addNumber("--waves", "of --bot --headless: number of waves; 0: all", choices.waves,
                         0.0f, float(game::kWaves.size()));
        parser.addFlag("--rewind", "of --bot --headless: rewinds ten seconds once",
                       choices.scripted.rewind);
        parser.addFlag("--report", "prints each action", choices.report);
        parser.addFlag("--energy", "shows the energy ledger", choices.energy);
        parser.addText("--record", "FILE", "records the input of the window", choices.record);
        parser.addText("--play", "FILE",
                       "with --headless: replays recorded input; a picture at the end of "
                       "each pause, by its frame's number",
                       choices.play);
        parser.addNumber("--soak",
                         "with --headless: ten equal rounds of a game; compares the cost of the "
                         "last with the first",
                         choices.soak, 0.0f, 600.0f);
        parser.addFlag("--msaa", "four samples a pixel", choices.antialias);
        if (!parser.parse(argc, argv, options)) return 0;
        if (options.fps == 0)
            options.fps = !options.headless ? 30.0 : choices.soak > 0 ? 8.0 : 10.0;
        if (options.list) {
            std::printf("one game, in three lights: --light golden, noon or night\n");
            return 0;
        }
        return run(options, choices);
    });
}
