// The editor's state, which its pages share. Pages are functions over one struct.
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

// An action of menus, keys and the palette.
struct Action {
    const char* name;   // "Add heat source"
    const char* place;  // menu: "File", "Edit", "View", "Scene", "Time", "Help", "Pages"
    std::string keys;   // "Ctrl+S"; empty: none
    const char* icon;   // may be null
    std::function<void()> run;
    std::function<bool()> enabled = {};
    int page = -2;              // only on this page; -2: on all, -3: on all with a scene
    bool line = false;          // draws a line above it in the menu
    std::string standard = {};  // default keys
};

struct FileDialog {
    bool open = false, saves = false;
    std::string title, name, act;
    std::filesystem::path folder;
    std::vector<std::string> endings;  // file endings to show, for example ".glb"
    std::function<void(const std::filesystem::path&)> done;
    std::vector<std::filesystem::directory_entry> entries;
    std::string listed;  // folder of the entries
    bool fresh = false;
};

// Resolution of a moving picture on a CPU device: the highest that allows 15 frames a second.
struct Pace {
    uint32_t step = 3;  // index into the shares in viewport_panel.cpp, highest first
    uint32_t frames = 0;
    float seconds = 0;  // s, frame time at this step
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
    bool cardsLoading = true;  // true: some pictures are still loading
    UserState user;
    float mostInterfaceSize = 2;  // limit from the window's size
    std::string device;           // device name for users
    bool slow = false;            // a CPU device: moving pictures render at lower resolution

    Page page = Page::kWelcome;
    Tool tool = Tool::kMove;
    bool snapping = false;
    bool placing = false;  // the next click places a heat source
    fwedit::SourceShape placed = fwedit::SourcePoint;
    std::vector<fwedit::ObjectId> selection;
    fwedit::Camera camera;
    bool playing = false, looping = false;
    float speed = 1;
    bool scrubbing = false;          // the user drags the playhead
    bool burnTimes = false;          // shows the map of burn times over the picture
    bool multipliers = false;        // shows the map of burn multipliers of all paint layers
    uint64_t multipliersOf = ~0ull;  // revision of its colours
    double burnTimesAt = -1;         // s, time of its colours
    Pace pace;
    double movedAt = -1e9;       // s, time of the last view change by the user
    std::string compared;        // name of the comparison's left half
    double preparingSince = -1;  // s; < 0: no preparation is running
    bool bare = false;           // shows only the picture of the scene
    bool panels = true;          // shows panels beside the picture
    bool showHelpers = true;     // shows marks, gizmo and outline over the picture
    int leftTab = 0;
    std::string filter;
    bool pinsOpen = true, placeOpen = true, mainOpen = true, timeOpen = true, moreOpen = false;
    std::vector<std::pair<float, float>> strip;  // time, share burnt, as recorded
    fwedit::ObjectId renaming = 0;
    std::string renamed;

    std::vector<Action> actions;
    std::vector<Toast> toasts;
    FileDialog files;
    bool palette = false, keys = false, about = false, guard = false, quit = false;
    int rebinding = -1;       // action that waits for new keys
    std::string keysProblem;  // problem of the last keys pressed
    std::string paletteText;
    int paletteAt = 0;
    bool paletteFresh = false;
    std::function<void()> afterGuard;
    std::string result;  // message of the last action, for the status line
    double resultTime = -1e9;

    double now = 0;       // s
    float deltaTime = 0;  // s since the previous frame
    float framesPerSecond = 0;
    std::vector<float> costs;  // ms of device time, newest last
    double savedTime = 0;
    uint64_t savedRevision = 0;  // revision of the last autosave
    float autosaveEvery = 20;    // s, at most 30; upper limit of lost work
    fwui::Rect screen;
};

// ---- services for pages
void toast(App& app, Toast::Kind kind, const std::string& title, const std::string& text = {});
void setStatus(App& app, const std::string& what);  // in the status line
bool perform(App& app, const fwedit::Command& command, fwedit::ObjectId* added = nullptr);
bool performSet(App& app, fwedit::ObjectId id, const char* key, const fwedit::Value& value);
bool isSelected(const App& app, fwedit::ObjectId id);
void select(App& app, fwedit::ObjectId id, bool add, bool flip);
fwedit::ObjectId addObject(App& app, fwedit::Kind kind, std::vector<fwedit::Assignment> fields);
void copySelection(App& app);  // as text, see document/clipboard.h
void paste(App& app);
void frameSelection(App& app, bool all);
// Compares that step of the history with the current scene, side by side.
void compareStep(App& app, size_t step);
// Describes a pinned spot at the shown time: "Catches at 0:12.4".
std::string describePin(const App& app, fwview::WhyCard& pin);
const char* iconOf(const fwedit::Scene& scene, fwedit::Kind kind, fwedit::ObjectId id);
ImU32 colorOf(const fwedit::Scene& scene, fwedit::Kind kind, fwedit::ObjectId id);
std::string clockText(double seconds, bool tenths = true);
std::string sceneName(const App& app);

void adoptDocument(App& app, fwedit::Document document);  // replaces the open document
void openScene(App& app, const std::filesystem::path& file);
void importMesh(App& app, const std::filesystem::path& file);
void newScene(App& app);
void openBuiltIn(App& app, int which);
bool save(App& app, bool elsewhere, std::function<void()> after = {});
void runWhenSaved(App& app, std::function<void()> then);  // asks first if there is unsaved work
void openDropped(App& app, const std::vector<std::filesystem::path>& files);
void autosave(App& app);
void recover(App& app, const Recovery& recovery);

std::vector<Action> makeActions(App& app);
void runKeys(App& app);
const Action* findAction(const App& app, const char* name);
const char* keysOf(const App& app, const char* name);  // current keys of that action
// Assigns these keys (empty: none) and saves them with the user's settings. Returns false if a
// command already uses them; `problem` has its name.
bool rebind(App& app, size_t action, const std::string& keys, std::string& problem);
// Returns one line per action: page, keys, name.
std::string listKeys(const App& app);

void askFile(App& app, FileDialog dialog);

// ---- pages and overlays; each draws itself
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

// Builds a frame's interface, between ImGui's NewFrame and Render.
void showApp(App& app);
// Records the fire pictures of the pages, before the interface is drawn.
void recordPages(App& app, const fwui::Frame& frame);
// Returns true if something animates, so the next frame is due without input.
bool isLively(const App& app);

}  // namespace fwapp
