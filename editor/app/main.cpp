// flamewright-editor: the window's loop. Draws frames while something animates or the user acts;
// otherwise the program sleeps.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>
#include <thread>

#include "app/app.h"
#include "app/built_in.h"
#include "app/flame_page.h"
#include "app/output_page.h"
#include "app/paint_page.h"
#include "common/fire_host.h"
#include "common/options.h"
#include "script/script.h"
#include "shell/frames.h"
#include "shell/input_queue.h"

namespace {

using Clock = std::chrono::steady_clock;

struct StartOptions {
    std::string shot;     // picture to write before exit
    std::string page;     // "welcome", "scene", "flame", with "+keys", "+palette", ...
    std::string builtIn;  // name of a scene on the welcome page
    float scale = 0;      // 0: the monitor's scale
    float seconds = 0;    // s of burn before the picture
    bool report = false;  // prints actions line by line
    std::string lines;    // commands before the picture, separated by ;
    bool once = false;    // renders one frame and exits, to measure the start-up
    float autosave = 20;  // s
    bool keys = false;    // prints all keys and exits
};

constexpr float kLeastWidth = 850, kLeastHeight = 470;  // design pixels; minimum for all pages

float monitorScale(GLFWwindow* window, VkExtent2D extent) {
    float x = 1, y = 1;
    if (window) glfwGetWindowContentScale(window, &x, &y);
    if (x > 1.01f) return x;
    const float fit =
        std::min(float(extent.width) / 1280, float(extent.height) / 720);  // no scale reported
    return std::clamp(std::floor(fit * 4) / 4, 1.0f, 3.0f);
}

// s since the process started, libraries included. The kernel counts hundredths.
double sinceStart() {
    std::ifstream file("/proc/self/stat");
    const std::string line((std::istreambuf_iterator<char>(file)), {});
    std::istringstream fields(line.substr(line.rfind(')') + 1));  // the process name may contain
                                                                  // anything
    std::string field;
    for (int i = 3; i <= 22; ++i) fields >> field;  // see proc(5)
    timespec now{};
    clock_gettime(CLOCK_BOOTTIME, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec) -
           std::strtod(field.c_str(), nullptr) / double(sysconf(_SC_CLK_TCK));
}

// s of processor time over all threads, including those of a CPU device.
double processorTime() {
    timespec used{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
    return double(used.tv_sec) + 1e-9 * double(used.tv_nsec);
}

// ImGui requests cursor shapes; GLFW provides four of them.
struct Cursors {
    GLFWcursor* made[ImGuiMouseCursor_COUNT] = {};
    int shown = -1;
    Cursors() {
        made[ImGuiMouseCursor_TextInput] = glfwCreateStandardCursor(GLFW_IBEAM_CURSOR);
        made[ImGuiMouseCursor_ResizeEW] = glfwCreateStandardCursor(GLFW_HRESIZE_CURSOR);
        made[ImGuiMouseCursor_ResizeNS] = glfwCreateStandardCursor(GLFW_VRESIZE_CURSOR);
        made[ImGuiMouseCursor_Hand] = glfwCreateStandardCursor(GLFW_HAND_CURSOR);
    }
    void show(GLFWwindow* window) {
        const int wanted = ImGui::GetMouseCursor();
        if (wanted == shown) return;
        shown = wanted;
        glfwSetCursor(window, wanted > 0 ? made[wanted] : nullptr);
    }
};

class Program {
 public:
    Program(const sample::VulkanHost& host, VkExtent2D size, const StartOptions& start)
        : host_(host), frames_(host, "Flamewright", size), start_(start) {
        ImGui::CreateContext();
        ImGui::GetIO().IniFilename = nullptr;
        ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
        ui_ = std::make_unique<fwui::UiRenderer>(host, frames_.outputPass, fwui::Frames::kSlots);
        if (frames_.window) {
            input_.listen(frames_.window->handle());
            glfwSetWindowSizeLimits(frames_.window->handle(), 640, 400, GLFW_DONT_CARE,
                                    GLFW_DONT_CARE);
        }
        fwui::mapKeys(frames_.window ? frames_.window->handle() : nullptr);
        context_ = sample::createContext(host, false);  // the viewport prepares it, during the
                                                        // first page
        app_ = std::make_unique<fwapp::App>(host, context_, *ui_);
        rescale();
    }
    ~Program() {
        vkDeviceWaitIdle(host_.device);
        app_.reset();
        fwDestroyContext(context_);
        ui_.reset();
        ImGui::DestroyContext();
    }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    fwapp::App& app() { return *app_; }

    // Renders one frame of `deltaTime` s. Returns false if there was nothing to draw into.
    bool frame(float deltaTime) {
        rescale();
        fwapp::App& app = *app_;
        fwui::Frame frame;
        if (!frames_.begin(frame)) return false;
        ImGuiIO& io = ImGui::GetIO();
        io.DisplaySize = {float(frame.extent.width), float(frame.extent.height)};
        io.DeltaTime = std::max(1e-4f, deltaTime);
        input_.deliver();
        app.now += double(deltaTime);
        app.deltaTime = deltaTime;
        ImGui::NewFrame();
        fwapp::showApp(app);
        ImGui::Render();
        fwapp::recordPages(app, frame);
        const bool fresh = frames_.beginOutput(frame);
        ui_->draw(frame.commands, frame.slot, *ImGui::GetDrawData(), fresh);
        frames_.end(frame);
        return true;
    }

    void run() {
        GLFWwindow* window = frames_.window->handle();
        Cursors cursors;
        auto before = Clock::now();
        double quiet = 0;  // s since the last input
        uint32_t counted = 0;
        double countedFrom = 0;
        while (!app_->quit) {
            const bool lively = fwapp::isLively(*app_) || quiet < 0.7 || !app_->toasts.empty();
            if (lively) {
                glfwPollEvents();
            } else {
                glfwWaitEventsTimeout(1.0);
            }
            const auto now = Clock::now();
            const double passed = std::chrono::duration<double>(now - before).count();
            const bool touched = !input_.empty() || input_.exposed;
            input_.exposed = false;
            quiet = touched ? 0 : quiet + passed;
            before = now;
            if (glfwWindowShouldClose(window)) {
                glfwSetWindowShouldClose(window, GLFW_FALSE);
                fwapp::runWhenSaved(*app_, [this] { app_->quit = true; });
                quiet = 0;
            }
            if (!input_.dropped.empty()) {
                fwapp::openDropped(*app_, input_.dropped);
                input_.dropped.clear();
            }
            fwapp::autosave(*app_);
            if (fwapp::updateLink(*app_)) quiet = 0;
            if (!lively && !touched) {
                app_->now += passed;
                app_->framesPerSecond = 0;
                continue;
            }
            const bool drawn = frame(float(std::min(passed, 0.25)));
            if (start_.report && app_->live.isPreviewing()) {
                vkDeviceWaitIdle(host_.device);  // include the device's part of the latency
                previewTime_ = std::chrono::duration<double>(Clock::now() - now).count();
            }
            if (start_.report && drawn && !shownOnce_) {
                shownOnce_ = true;
                vkDeviceWaitIdle(host_.device);
                std::printf("first frame %.0f ms after the start\n", 1000 * sinceStart());
                std::fflush(stdout);
            }
            if (start_.report) report();
            if (!drawn) glfwWaitEventsTimeout(0.05);
            cursors.show(window);
            const std::string title =
                (fwedit::unsaved(app_->document) ? "● " : "") +
                (app_->page == fwapp::Page::kWelcome ? std::string("Flamewright")
                                                     : fwapp::sceneName(*app_) + " – Flamewright");
            if (title != title_) glfwSetWindowTitle(window, (title_ = title).c_str());
            ++counted;
            countedFrom += passed;
            if (countedFrom > 0.5) {
                app_->framesPerSecond = float(counted / countedFrom);
                counted = 0;
                countedFrom = 0;
            }
            frames_.window->limitRate(60);
        }
        fwapp::dropRecovery();
        fwapp::saveUserState(app_->user);
        if (start_.report && playedSeconds_ > 0)
            std::printf("played at %.1f frames a second, %.1f ms of processor time each\n",
                        playedFrames_ / playedSeconds_, 1000 * playedWork_ / playedFrames_);
    }

    // Headless: renders one frame as early as possible.
    void showOnce() {
        frame(1.0f / 30);
        vkDeviceWaitIdle(host_.device);
        std::_Exit(0);  // do not wait for background start-up work
    }

    // Headless: takes a picture of the requested page once all background work is done.
    void shoot() {
        constexpr float kStep = 1.0f / 30;
        app_->live.awaitPipelines();
        for (int i = 0; i < 4; ++i) frame(kStep);
        while (app_->page == fwapp::Page::kWelcome && app_->cardsLoading) frame(kStep);
        for (int i = 0; i < 2000 && (app_->live.isPreparing() || app_->live.isPreparingRest() ||
                                     app_->output->isLively() ||
                                     (app_->live.isComparing() && !app_->live.showsComparison()));
             ++i) {
            frame(kStep);
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        runLines();
        const auto& winds = app_->document.scene.winds;
        if (start_.page.find("wind") != std::string::npos && !winds.empty())
            fwapp::select(*app_, winds[0].id, false, false);
        app_->playing = start_.seconds > 0;
        for (float t = 0; t < start_.seconds; t += kStep) frame(kStep);
        app_->playing = false;
        if (start_.page.find("pin") != std::string::npos) pinMiddle();
        for (int i = 0; i < 3; ++i) frame(kStep);
        sample::writePng(start_.shot, frames_.picture());
    }

 private:
    // See document/command.h.
    void runLines() {
        std::istringstream lines(start_.lines);
        std::string message;
        for (std::string line; std::getline(lines, line, ';');)
            if (!fwedit::runLine(app_->document, line, message))
                throw sample::Failure("\"" + line + "\": " + message);
        for (int i = 0; i < 3 && !start_.lines.empty(); ++i) frame(1.0f / 30);
    }

    // Queries the spot in the centre of the picture and pins it.
    void pinMiddle() {
        fwview::LiveScene& live = app_->live;
        const fwview::SurfaceHit hit = live.pick(0.5f, 0.5f, false);
        if (!hit.hit) return;
        live.askWhy(hit.object, hit.position);
        for (int i = 0; i < 200 && !live.why.answered; ++i) frame(1.0f / 30);
        live.pinWhy();
    }

    // For scripts that drive the program: prints actions and the arrival of pictures.
    void report() {
        const fwapp::App& app = *app_;
        auto print = [](const std::string& line) {
            std::printf("%s\n", line.c_str());
            std::fflush(stdout);
        };
        if (app.resultTime != reportedResult_) print("did: " + app.result);
        reportedResult_ = app.resultTime;
        const std::string& why = app.live.why.answer.answer;
        if (!app.live.why.answered) reportedWhy_.clear();
        if (app.live.why.answered && reportedWhy_.empty())
            print("answered " + std::to_string(app.live.why.frames) + " frames later");
        if (app.live.why.answered && why != reportedWhy_) print("why: " + (reportedWhy_ = why));
        const bool paintable = app.page == fwapp::Page::kPaint && app.paint->surface;
        if (paintable && !reportedPaintable_) print("ready to paint");
        reportedPaintable_ = paintable;
        if (app.live.isPreviewing()) {
            const std::string shown = fwapp::clockText(app.live.time());
            if (shown != reportedPreview_)
                print("preview of " + shown + ", " + std::to_string(int(1000 * previewTime_)) +
                      " ms");
            reportedPreview_ = shown;
        }
        const bool ready = app.live.burn() && !app.live.isPreparing();
        if (ready && !reportedReady_) print("ready");
        reportedReady_ = ready;
        const int second = int(app.live.time());
        if (second != reportedSecond_) print("burn at " + std::to_string(second) + " s");
        reportedSecond_ = second;
        if (app.toasts.size() > reportedToasts_)
            print("message: " + app.toasts.back().title + ": " + app.toasts.back().text);
        reportedToasts_ = app.toasts.size();
        const double work = processorTime();
        if (app.playing && ready) {
            ++playedFrames_;
            playedSeconds_ += double(app.deltaTime);
            playedWork_ += work - workBefore_;
        }
        workBefore_ = work;
    }

    void rescale() {
        const VkExtent2D extent = frames_.extent();
        GLFWwindow* window = frames_.window ? frames_.window->handle() : nullptr;
        const float monitor = start_.scale > 0 ? start_.scale : monitorScale(window, extent);
        // Limit the size, so that panels do not overlap.
        const float fits =
            std::min(float(extent.width) / kLeastWidth, float(extent.height) / kLeastHeight);
        const float most = std::clamp(std::floor(fits * 4) / 4, 1.0f, 4.0f);
        app_->mostInterfaceSize = most / monitor;
        const float scale = std::clamp(monitor * app_->user.interfaceSize, 0.75f, most);
        if (scale == scale_) return;
        scale_ = scale;
        fwui::theme().scale = scale;
        std::string error;
        if (!fwui::loadFonts(error)) throw sample::Failure(error);
        fwui::applyStyle();
        ui_->uploadFonts();
    }

    const sample::VulkanHost& host_;
    fwui::Frames frames_;
    StartOptions start_;
    fwui::InputQueue input_;
    std::unique_ptr<fwui::UiRenderer> ui_;
    FwContext* context_ = nullptr;
    std::unique_ptr<fwapp::App> app_;
    float scale_ = 0;
    double reportedResult_ = -1e9, playedSeconds_ = 0;
    double playedWork_ = 0, workBefore_ = 0;  // s of processor time, including the device's
    bool reportedReady_ = false;
    std::string reportedWhy_, reportedPreview_;
    bool reportedPaintable_ = false;
    double previewTime_ = 0;  // s
    int reportedSecond_ = 0;
    size_t reportedToasts_ = 0;
    uint32_t playedFrames_ = 0;
    bool shownOnce_ = false;
    std::string title_;
};

void openPage(fwapp::App& app, const StartOptions& start) {
    auto asks = [&](const char* word) { return start.page.find(word) != std::string::npos; };
    if (asks("scene")) app.page = fwapp::Page::kScene;
    if (asks("paint")) app.page = fwapp::Page::kPaint;
    if (asks("flame")) app.page = fwapp::Page::kFlame;
    if (asks("export")) app.page = fwapp::Page::kOutput;
    if (asks("points")) app.flame->useCurves(true);
    if (asks("compare")) app.flame->compare(true);
    if (asks("keys")) app.keys = true;
    if (asks("about")) app.about = true;
    if (asks("palette")) fwapp::findAction(app, "Find anything")->run();
    if (asks("select") && !app.document.scene.sources.empty())
        fwapp::select(app, app.document.scene.sources[0].id, false, false);
    if (asks("mesh") && !app.document.scene.meshes.empty())
        fwapp::select(app, app.document.scene.meshes[0].id, false, false);
    if (asks("history")) app.leftTab = 1;
    if (asks("beside")) fwapp::findAction(app, "Compare")->run();
    app.bare = asks("bare");
}

int run(const sample::Options& options, const StartOptions& start) {
    sample::ValidationLog validation;
    {
        const sample::VulkanHost host(sample::hostRequest(options, validation));
        Program program(host, {options.width, options.height}, start);
        fwapp::App& app = program.app();
        app.autosaveEvery = start.autosave;
        for (const std::string& file : options.positional) fwapp::openDropped(app, {file});
        fwapp::Recovery left;
        if (!options.positional.empty() && fwapp::findRecovery(left))
            fwapp::toast(app, fwapp::Toast::Kind::kWarning, "Unsaved work was found",
                         "It stays until you look at it: File, Close scene.");
        for (size_t i = 0; i < fwapp::builtIns().size(); ++i)
            if (start.builtIn == fwapp::builtIns()[i].name) fwapp::openBuiltIn(app, int(i));
        openPage(app, start);
        if (start.keys) {
            std::fputs(fwapp::listKeys(app).c_str(), stdout);
            std::fflush(stdout);
            std::_Exit(0);  // do not wait for background start-up work
        }
        if (start.once) {
            program.showOnce();
        } else if (options.headless) {
            program.shoot();
        } else {
            program.run();
        }
    }
    return validation.exitCode();
}

}  // namespace

int main(int argc, char** argv) {
    for (int i = 1; i < argc; ++i)
        if (std::string_view(argv[i]) == "--script") return fwedit::scriptMain(argc, argv);
    return sample::guardedMain("flamewright-editor", [&] {
        sample::Options options;
        options.width = 1280;
        options.height = 720;
        StartOptions start;
        sample::OptionParser parser("flamewright-editor", "editor for burning scenes",
                                    "[FILE.fwscene | FILE.glb] | --script FILE [--headless]");
        parser.addText("--shot", "FILE.png",
                       "with --headless: writes a picture of the window and exits", start.shot);
        parser.addText("--page", "NAME",
                       "welcome, scene, paint, flame, export; scene+bare: the picture alone",
                       start.page);
        parser.addText("--scene", "NAME", "a scene of the welcome page, by its name",
                       start.builtIn);
        parser.addText("--do", "LINES", "with --shot: commands before it, separated by ;",
                       start.lines);
        parser.addFlag("--report", "print each action", start.report);
        parser.addFlag("--once", "with --headless: renders one frame and exits", start.once);
        parser.addFlag("--keys", "print page, keys and name of each command and exit", start.keys);
        parser.addNumber("--scale", "interface scale; 0: the monitor's scale", start.scale, 0, 4);
        parser.addNumber("--autosave", "seconds between copies of unsaved work", start.autosave,
                         0.05f, 25);
        parser.addNumber("--seconds", "seconds of burn before the picture", start.seconds, 0, 600);
        if (!parser.parse(argc, argv, options)) return 0;
        if (options.headless && start.shot.empty())
            start.shot = (options.out / "editor.png").string();
        if (options.headless && start.shot.find('/') != std::string::npos)
            std::filesystem::create_directories(std::filesystem::path(start.shot).parent_path());
        return run(options, start);
    });
}
