// Shows an editor scene in a game's window. With --link it listens on a local port, and an editor
// pushes changes into the running fire. Wind, light, flames, heat and water apply at once. Meshes,
// paint and materials need a second burn that catches up in the background. Window: drag to turn,
// wheel to zoom, R to restart the burn.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include "common/filming.h"
#include "common/fire_host.h"
#include "common/studio.h"
#include "document/burn.h"
#include "flamewright/flamewright_vulkan.h"
#include "link/scene_link.h"

namespace {

struct Settings {
    float seconds = 10;  // length of a headless run; with --link, the time at which playback stops
    std::string port;    // empty: no link
};

constexpr float kCatchUpStep = 0.5f;  // s per frame, for a burn that catches up
constexpr uint32_t kLastFrames = 8;   // frames until the last burn's readback arrives

std::filesystem::path cacheFolder(const sample::Options& options) {
    return options.out.parent_path() / "cache";
}

// Shows one scene while the next one catches up.
class Player {
 public:
    Player(const sample::VulkanHost& host, sample::Stage& stage, const std::filesystem::path& cache)
        : host_(host), stage_(stage), context_(sample::createContext(host, false)) {
        assets_.cache = cache;
        // Draws surfaces in the stage's pass. Flames composite over it in a separate pass, so that
        // they fade at surfaces.
        FwVulkanTargetDef solids = fwDefaultVulkanTargetDef();
        solids.colorFormat = stage.made.colorFormat;
        solids.depthFormat = stage.depthFormat;
        solids.samples = 1;
        solids.colorAttachmentCount = 1;
        solids.encoding = FW_OUTPUT_LINEAR;
        FwVulkanTargetDef flames = solids;
        solids.renderPass = stage.scenePass;
        solids.depthMode = FW_DEPTH_TEST;
        solids.flags = FW_TARGET_NO_FLAMES | FW_TARGET_AS_NEEDED;
        flames.depthMode = FW_DEPTH_SAMPLED;
        flames.flags = FW_TARGET_COMPOSITE;
        if (fwContext_RegisterTarget(context_, &solids, &solids_) < 0 ||
            fwContext_RegisterTarget(context_, &flames, &flames_) < 0 ||
            fwContext_Prepare(context_) < 0) {
            char text[512] = "";
            fwContext_GetLastMessage(context_, text, sizeof text);
            fwDestroyContext(context_);
            throw sample::Failure(std::string("The scene cannot be rendered: ") + text);
        }
    }
    ~Player() {
        vkDeviceWaitIdle(host_.device);
        studio_.reset();
        burn_.reset();
        next_.reset();
        fwDestroyContext(context_);
    }
    Player(const Player&) = delete;
    Player& operator=(const Player&) = delete;

    // Switches to this scene. Returns an empty string, or the reason why the previous scene stays.
    std::string show(const fwlink::LinkedScene& wanted) {
        const bool samePaint = !shown_.folder.empty() && shown_.images == wanted.images &&
                               shown_.folder == wanted.folder;
        if (shown_.scene.camera != wanted.scene.camera || !burn_) camera_ = wanted.scene.camera;
        if (samePaint && !next_ && burn_ &&
            fwedit::reviseBurn(*burn_, wanted.scene, wanted.folder)) {
            shown_ = wanted;
            setUpStudio();
            return "";
        }
        const std::string problem = begin(wanted);
        if (problem.empty() && !burn_) adopt();
        return problem;
    }
    void restart() {
        if (begin(shown_).empty()) adopt();
    }
    [[nodiscard]] bool catchesUp() const { return next_ != nullptr; }
    [[nodiscard]] const fwedit::Burn& burn() const { return *burn_; }

    // Renders a frame that advances by `step` s.
    void draw(const sample::StageFrame& frame, float step) {
        turn(frame.input);
        fwedit::Scene seen;  // viewOf reads only these fields
        seen.settings = shown_.scene.settings;
        seen.camera = camera_;
        const FwView view =
            fwedit::viewOf(seen, frame.extent.width, frame.extent.height, burn_->time);
        if (next_) {
            const double left = burn_->time + double{step} - next_->time;
            advance(*next_, frame, view, std::clamp(float(left), 0.0f, kCatchUpStep));
            if (left <= double{kCatchUpStep}) {
                adopt();
            } else {
                advance(*burn_, frame, view, step);
            }
        } else {
            advance(*burn_, frame, view, step);
        }
        FwLight lights[8];
        const uint32_t count = fwWorld_GetLights(burn_->world, lights, 8);
        stage_.beginScene(frame);
        studio_->draw(frame, frame.commands, view, {lights, count});
        const FwVulkanFrame described = describe(frame, step);
        check(*burn_,
              fwWorld_RecordInside(burn_->world, &described, solids_, &view, &frame.viewport));
        stage_.endScene(frame);
        const FwVulkanComposite over =
            sample::describeComposite(stage_.captureScene(frame), frame.extent);
        check(*burn_, fwWorld_RecordComposite(burn_->world, &described, flames_, &view, &over));
        stage_.finish(frame);
    }

 private:
    static void check(const fwedit::Burn& burn, FwResult result) {
        if (result >= 0) return;
        char text[512] = "";
        fwWorld_GetLastMessage(burn.world, text, sizeof text);
        throw sample::Failure(std::string("The fire: ") + text);
    }
    static FwVulkanFrame describe(const sample::StageFrame& frame, float step) {
        FwVulkanFrame described = fwDefaultVulkanFrame();
        described.commandBuffer = frame.commands;
        described.frameIndex = frame.frameIndex;
        described.completedFrameIndex = frame.completedFrameIndex;
        described.deltaTime = step;
        return described;
    }
    void advance(fwedit::Burn& burn, const sample::StageFrame& frame, const FwView& view,
                 float step) {
        std::string error;
        if (step > 0 && !fwedit::feedBurn(burn, step, error)) throw sample::Failure(error);
        const FwVulkanFrame described = describe(frame, step);
        check(burn, fwWorld_RecordOutside(burn.world, &described, &view));
    }
    // Starts a burn in the background. Returns an empty string, or the reason of failure.
    std::string begin(const fwlink::LinkedScene& wanted) {
        std::string error;
        auto made = fwedit::createBurn(context_, wanted.scene, wanted.images, wanted.folder,
                                       assets_, error);
        if (!made) return error;
        for (const std::string& line : made->report) std::printf("%s\n", line.c_str());
        vkDeviceWaitIdle(host_.device);
        next_ = std::move(made);
        if (&wanted != &shown_) shown_ = wanted;
        return "";
    }
    void adopt() {
        vkDeviceWaitIdle(host_.device);
        burn_ = std::move(next_);
        setUpStudio();
    }
    void turn(const sample::Input& input) {
        camera_.yaw -= 0.45f * input.dragX;
        camera_.pitch = std::clamp(camera_.pitch + 0.45f * input.dragY, -5.0f, 85.0f);
        camera_.distance *= std::pow(0.9f, input.wheel);
    }
    void setUpStudio() {
        fwedit::Backdrop backdrop = fwedit::backdropOf(*burn_);
        const fwedit::Vec3 sun = shown_.scene.settings.sunDirection;
        if (studio_ && backdrop == backdrop_ && sun == sun_) return;
        vkDeviceWaitIdle(host_.device);
        const auto& middle = backdrop.middle;
        studio_ = std::make_unique<sample::Studio>(
            host_, stage_, glm::vec3(middle[0], middle[1], middle[2]), backdrop.size);
        if (backdrop.any)
            studio_->castShadow(backdrop.positions, backdrop.indices, glm::mat4(1),
                                glm::normalize(glm::vec3(sun[0], sun[1], sun[2])));
        backdrop_ = std::move(backdrop);
        sun_ = sun;
    }

    const sample::VulkanHost& host_;
    sample::Stage& stage_;
    FwContext* context_;
    FwTargetId solids_{}, flames_{};
    fwedit::Assets assets_;
    std::unique_ptr<fwedit::Burn> burn_, next_;  // next_: catches up in the background
    fwlink::LinkedScene shown_;
    fwedit::Camera camera_;
    std::unique_ptr<sample::Studio> studio_;
    fwedit::Backdrop backdrop_;
    fwedit::Vec3 sun_{};
};

fwlink::LinkedScene sceneOf(const std::filesystem::path& file) {
    fwedit::Document document;
    std::vector<std::string> repairs;
    std::string error;
    if (!fwedit::openDocument(file, document, repairs, error)) throw sample::Failure(error);
    for (const std::string& line : repairs) std::printf("%s\n", line.c_str());
    return {0, document.scene, document.images, std::filesystem::absolute(file).parent_path()};
}

// The sample's side of a link. Measures how soon a received change is visible.
class Link {
 public:
    explicit Link(const std::string& port) {
        if (port.empty()) return;
        std::string error;
        if (!receiver_.listen(uint16_t(sample::parseWhole("--link", port, 0, 65535)), error))
            throw sample::Failure(error);
        std::printf("waiting for an editor on local port %u\n", receiver_.port());
        std::fflush(stdout);
        listens_ = true;
    }
    [[nodiscard]] bool listens() const { return listens_; }
    [[nodiscard]] bool connected() const { return receiver_.connected(); }
    // Returns true if there is a new scene to show.
    bool poll(fwlink::LinkedScene& scene) {
        if (!listens_) return false;
        std::string report;
        const bool isNew = receiver_.poll(scene, report);
        if (!report.empty()) say(report);
        return isNew;
    }
    void takes(const fwlink::LinkedScene& scene, std::string problem) {
        taken_ = scene.number;
        frames_ = 0;
        problem_ = std::move(problem);
        if (!problem_.empty()) say(problem_);
    }
    // Call it after each frame. `settled`: the received scene is visible in it.
    void afterFrame(bool settled) {
        ++frames_;
        if (taken_ == 0 || !settled) return;
        receiver_.took(taken_, problem_);
        say("scene " + std::to_string(taken_) + " is shown after " + std::to_string(frames_) +
            (frames_ == 1 ? " frame" : " frames"));
        taken_ = 0;
    }

 private:
    static void say(const std::string& line) {
        std::printf("%s\n", line.c_str());
        std::fflush(stdout);
    }
    fwlink::SceneReceiver receiver_;
    bool listens_ = false;
    uint64_t taken_ = 0;  // serial of the scene without a reply yet; 0: none
    uint32_t frames_ = 0;
    std::string problem_;
};

// Headless: advances to --seconds and stops there while scenes arrive. Ends when the editor
// disconnects. Saves the last picture and prints the hash of the burn.
void playForEditor(Player& player, sample::Stage& stage, Link& link, const Settings& settings,
                   const sample::Options& options) {
    sample::Picture last;
    stage.onPicture = [&](uint32_t, sample::Picture&& picture) { last = std::move(picture); };
    sample::StageFrame frame;
    fwlink::LinkedScene scene;
    const double end = double{settings.seconds};
    const auto show = [&](bool waits) {
        const bool isNew = link.poll(scene);
        if (isNew) link.takes(scene, player.show(scene));
        if (!isNew && waits) std::this_thread::sleep_for(std::chrono::milliseconds(2));
        return isNew;
    };
    const auto draw = [&] {
        if (!stage.next(frame)) throw sample::Failure("there are no more frames");
        const double left = end - player.burn().time;
        player.draw(frame, std::clamp(float(left), 0.0f, frame.deltaTime));
        link.afterFrame(!player.catchesUp());
    };
    for (;;) {
        const bool moves = player.burn().time + 1e-4 < end || player.catchesUp();
        if (show(!moves) || moves)
            draw();
        else if (!link.connected())
            break;
    }
    std::vector<std::string> lines;
    fwedit::requestHashes(player.burn());
    for (uint32_t i = 0; i < kLastFrames; ++i) draw();
    if (fwedit::fetchHashes(player.burn(), lines) != FW_OK)
        throw sample::Failure("the burn maps did not come");
    sample::writePng(options.out / "scene.png", last);
    for (const std::string& line : lines) std::printf("%s\n", line.c_str());
}

void play(Player& player, sample::Stage& stage, Link& link, const sample::Options& options) {
    std::unique_ptr<sample::Film> film;
    if (options.headless)
        film = std::make_unique<sample::Film>(sample::FilmRequest{.folder = options.out,
                                                                  .name = "scene",
                                                                  .framesPerSecond = options.fps,
                                                                  .frames = stage.frames()});
    sample::Progress progress("scene", std::max(1u, stage.frames()));
    if (film)
        stage.onPicture = [&](uint32_t number, sample::Picture&& picture) {
            film->add(number, picture);
            progress.update(number + 1);
        };
    sample::StageFrame frame;
    fwlink::LinkedScene scene;
    while (stage.next(frame)) {
        if (link.poll(scene)) link.takes(scene, player.show(scene));
        for (const int key : frame.input.keys)
            if (key == 'R') player.restart();
        player.draw(frame, frame.deltaTime);
        link.afterFrame(!player.catchesUp());
    }
    if (!film) return;
    progress.finish();
    sample::Summary summary;
    summary.title = "A scene of the editor";
    summary.files = film->close();
    sample::printSummary(summary);
}

int run(const sample::Options& options, const Settings& settings) {
    if (options.positional.size() > 1)
        throw sample::Failure("one scene at a time; " + options.positional[1] + " is extra");
    sample::ValidationLog validation;
    {
        const sample::VulkanHost host(sample::hostRequest(options, validation));
        sample::StageRequest request;
        request.title = "Flamewright: a scene";
        request.vignette = 0.1f;  // as in the editor's picture
        request.capturesScene = true;
        Link link(settings.port);
        const bool forEditor = options.headless && link.listens();
        sample::Stage stage(host, options, request,
                            forEditor ? 0 : sample::framesOf(options, double{settings.seconds}));
        Player player(host, stage, cacheFolder(options));
        fwlink::LinkedScene scene;
        if (forEditor && options.positional.empty()) {
            while (!link.poll(scene)) std::this_thread::sleep_for(std::chrono::milliseconds(2));
            const std::string problem = player.show(scene);
            if (!problem.empty()) throw sample::Failure(problem);
            link.takes(scene, "");
        } else {
            const std::string problem = player.show(
                sceneOf(options.positional.empty() ? FW_SAMPLE_SCENE : options.positional[0]));
            if (!problem.empty()) throw sample::Failure(problem);
        }
        if (forEditor)
            playForEditor(player, stage, link, settings, options);
        else
            play(player, stage, link, options);
    }
    return validation.exitCode();
}

}  // namespace

int main(int argc, char** argv) {
    return sample::guardedMain("14_scene", [&] {
        sample::Options options;
        Settings settings;
        sample::OptionParser parser("14_scene", "shows an editor scene in a game",
                                    "[FILE.fwscene]");
        parser.addNumber("--seconds", "length of a headless run", settings.seconds, 0.1f, 600.0f);
        parser.addText("--link", "PORT", "local port for changes from an editor; 0: any free port",
                       settings.port);
        if (!parser.parse(argc, argv, options)) return 0;
        return run(options, settings);
    });
}
