// The editor's state and what its pages share. One struct; pages are functions over it.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/cards.h"
#include "app/user_state.h"
#include "document/document.h"
#include "shell/widgets.h"
#include "viewport/live_scene.h"

namespace fwapp {

struct FlamePage;
struct OutputPage;
struct PaintPage;

enum class Page : int { kWelcome = -1, kScene = 0, kPaint = 1, kFlame = 2, kOutput = 3 };
enum class Tool : int { kSelect, kMove, kRotate, kScale, kWhy };

struct Toast {
    enum class Kind { kInfo, kWarning, kError } kind{};
    std::string title, text;
    double born = 0;
};

// What a menu, a key and the palette do alike.
struct Action {
    const char* name;   // "Add heat source"
    const char* place;  // of the menu: "File", "Edit", "View", "Scene", "Time", "Help", "Pages"
    std::string keys;   // "Ctrl+S"; empty: none
    const char* icon;   // may be null
    std::function<void()> run;
    std::function<bool()> enabled = {};
    int page = -2;              // only there; -2: on all, -3: on all with a scene
    bool line = false;          // a line above it in the menu
    std::string standard = {};  // keys that it has by design
};

struct FileDialog {
    bool open = false, saves = false;
    std::string title, name, act;
    std::filesystem::path folder;
    std::vector<std::string> endings;  // ".glb"; what is shown
    std::function<void(const std::filesystem::path&)> done;
    std::vector<std::filesystem::directory_entry> entries;
    std::string listed;  // folder that the entries are of
    bool fresh = false;
};

// How sharp a moving picture is on a device of the CPU's: as sharp as 15 frames a second allow.
struct Pace {
    uint32_t step = 3;  // of the shares in viewport_panel.cpp, the sharpest first
    uint32_t frames = 0;
    float seconds = 0;  // that these took
};

struct App {
    App(const sample::VulkanHost& host, FwContext* context, fwui::UiRenderer& ui);
    ~App();
    App(const App&) = delete;
    App& operator=(const App&) = delete;

    const sample::VulkanHost& host;
    FwContext* context;
    fwui::UiRenderer& ui;
    fwedit::Document document;
    fwview::LiveScene live;
    std::unique_ptr<FlamePage> flame;
    std::unique_ptr<PaintPage> paint;
    std::unique_ptr<OutputPage> output;
    Cards cards;
    bool cardsCome = true;  // some are still to be loaded
    UserState user;
    float mostInterfaceSize = 2;  // that the window has room for
    std::string device;           // as people call it
    bool slow = false;            // a device of the CPU's: pictures that move are drawn smaller

    Page page = Page::kWelcome;
    Tool tool = Tool::kMove;
    bool snapping = false;
    bool placing = false;  // the next click puts a heat source there
    fwedit::SourceShape placed = fwedit::SourcePoint;
    std::vector<fwedit::ObjectId> selection;
    fwedit::Camera camera;
    bool playing = false, looping = false;
    float speed = 1;
    bool scrubbing = false;          // a hand holds the playhead
    bool burnTimes = false;          // the map of burn times lies over the picture
    bool multipliers = false;        // that of burn multipliers does, of all layers of paint
    uint64_t multipliersOf = ~0ull;  // revision that it was coloured at
    double burnTimesAt = -1;         // s that it was coloured at
    Pace pace;
    double movedAt = -1e9;       // s, when the view last moved by hand
    std::string compared;        // what the left half of a comparison is
    double preparingSince = -1;  // s; < 0: nothing is prepared
    bool bare = false;           // the picture of the scene and nothing else
    bool panels = true;          // beside the picture
    bool showHelpers = true;     // marks, gizmo and outline over the picture
    int leftTab = 0;
    std::string filter;
    bool pinsOpen = true, placeOpen = true, mainOpen = true, timeOpen = true, moreOpen = false;
    std::vector<std::pair<float, float>> strip;  // time, share burnt, as it was seen
    fwedit::ObjectId renaming = 0;
    std::string renamed;

    std::vector<Action> actions;
    std::vector<Toast> toasts;
    FileDialog files;
    bool palette = false, keys = false, about = false, guard = false, quit = false;
    int rebinding = -1;       // action whose new keys are awaited
    std::string keysProblem;  // with the last that were pressed
    std::string paletteText;
    int paletteAt = 0;
    bool paletteFresh = false;
    std::function<void()> afterGuard;
    std::string result;  // of the last act, for the status line
    double resultTime = -1e9;

    double now = 0;       // s
    float deltaTime = 0;  // s since the frame before
    float framesPerSecond = 0;
    std::vector<float> costs;  // ms of the device, the newest last
    double savedTime = 0;
    uint64_t savedRevision = 0;  // by autosave
    float autosaveEvery = 20;    // s; at most so much work is lost, and no more than 30 s of it
    fwui::Rect screen;
};

// ---- what pages call
void toast(App& app, Toast::Kind kind, const std::string& title, const std::string& text = {});
void say(App& app, const std::string& what);  // in the status line
bool perform(App& app, const fwedit::Command& command, fwedit::ObjectId* added = nullptr);
bool performSet(App& app, fwedit::ObjectId id, const char* key, const fwedit::Value& value);
bool isSelected(const App& app, fwedit::ObjectId id);
void select(App& app, fwedit::ObjectId id, bool add, bool flip);
fwedit::ObjectId addObject(App& app, fwedit::Kind kind, std::vector<fwedit::Assignment> fields);
void copySelection(App& app);  // as text, see document/clipboard.h
void paste(App& app);
void frameSelection(App& app, bool all);
// Lays the scene after that step of the history beside what it is now.
void compareStep(App& app, size_t step);
// What is known of a pinned spot at the time that is shown: "Catches at 0:12.4".
std::string pinWords(const App& app, fwview::WhyCard& pin);
const char* iconOf(const fwedit::Scene& scene, fwedit::Kind kind, fwedit::ObjectId id);
ImU32 colorOf(const fwedit::Scene& scene, fwedit::Kind kind, fwedit::ObjectId id);
std::string clockText(double seconds, bool tenths = true);
std::string sceneName(const App& app);

void adoptDocument(App& app, fwedit::Document document);  // instead of the one before
void openScene(App& app, const std::filesystem::path& file);
void importMesh(App& app, const std::filesystem::path& file);
void newScene(App& app);
void openBuiltIn(App& app, int which);
bool save(App& app, bool elsewhere, std::function<void()> after = {});
void ifSaved(App& app, std::function<void()> then);  // asks first where there is unsaved work
void takeDropped(App& app, const std::vector<std::filesystem::path>& files);
void autosave(App& app);
void recover(App& app, const Recovery& recovery);

std::vector<Action> makeActions(App& app);
void runKeys(App& app);
const Action* findAction(const App& app, const char* name);
const char* keysOf(const App& app, const char* name);  // of that action, as they are now
// Gives it these keys (empty: none) and keeps them with the user's settings. False: `problem` says
// which command has them.
bool rebind(App& app, size_t action, const std::string& keys, std::string& problem);
// A line an action: its page, its keys, its name.
std::string listKeys(const App& app);

void askFile(App& app, FileDialog dialog);

// ---- pages and what lies over them; each draws itself
void showWelcome(App& app, fwui::Rect rect);
void showScene(App& app, fwui::Rect rect);
void showBare(App& app, const fwui::Rect& rect);
void showPaint(App& app, fwui::Rect rect);
void showFlame(App& app, fwui::Rect rect);
void showOutput(App& app, fwui::Rect rect);
void showTopBar(App& app, const fwui::Rect& rect);
struct Hint {
    const char *keys, *what;
};
void showStatus(App& app, const fwui::Rect& rect, std::initializer_list<Hint> hints);
void showTransport(App& app, ImDrawList* list, const fwui::Rect& rect, bool marks);
void showOverlays(App& app);

// A frame's interface, between ImGui's NewFrame and Render.
void showApp(App& app);
// What pages show of fire, into the frame, before the interface is drawn.
void recordPages(App& app, const fwui::Frame& frame);
// Something moves by itself: the next frame is due without input.
bool isLively(const App& app);

}  // namespace fwapp
