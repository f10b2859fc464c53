// See app.h: what the pages' acts do.
#include "app/app.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "app/built_in.h"
#include "app/flame_page.h"
#include "app/output_page.h"
#include "app/paint_page.h"
#include "document/apply.h"
#include "document/clipboard.h"
#include "document/keys.h"
#include "shell/icons.h"

namespace fwapp {

namespace fs = std::filesystem;
namespace icons = fwui::icons;
using fwedit::Command;
using fwedit::Kind;
using fwedit::ObjectId;
using fwedit::Verb;

App::App(const sample::VulkanHost& hostGiven, FwContext* contextGiven, fwui::UiRenderer& uiGiven)
    : host(hostGiven),
      context(contextGiven),
      ui(uiGiven),
      document(fwedit::newDocument()),
      live(hostGiven, contextGiven, uiGiven),
      flame(std::make_unique<FlamePage>(hostGiven, contextGiven, uiGiven)),
      paint(std::make_unique<PaintPage>()),
      output(std::make_unique<OutputPage>()),
      cards(hostGiven, uiGiven, builtIns().size()) {
    const std::string name = host.properties.deviceName;
    slow = host.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    flame->slow = slow;
    device = slow ? "CPU renderer" : name;
    loadUserState(user);
    adoptDocument(*this, std::move(document));
    camera = document.scene.camera;
    actions = makeActions(*this);
}

App::~App() = default;

void adoptDocument(App& app, fwedit::Document document) {
    app.document = std::move(document);
    app.document.surface = [&app](const fwedit::Scene&, ObjectId mesh) {
        return app.live.surfaceOf(mesh).get();
    };
    app.document.nodePose = [&app](const fwedit::Mesh& mesh, std::string_view node,
                                   fwedit::Pose& pose, std::string& error) {
        if (app.live.burn()) return fwedit::nodePosesOf(*app.live.burn())(mesh, node, pose, error);
        error = "\"" + mesh.name + "\" is not in the scene yet";
        return false;
    };
    *app.paint = {};
    app.burnTimes = false;
}

void toast(App& app, Toast::Kind kind, const std::string& title, const std::string& text) {
    if (app.toasts.size() >= 3) app.toasts.erase(app.toasts.begin());
    app.toasts.push_back({kind, title, text, app.now});
}

void setStatus(App& app, const std::string& what) {
    app.result = what;
    app.resultTime = app.now;
}

bool perform(App& app, const Command& command, ObjectId* added) {
    std::string message;
    const bool done = fwedit::run(app.document, command, message, added);
    if (!done) {
        toast(app, Toast::Kind::kError, "The command failed", message);
    } else if (!message.empty()) {
        toast(app, Toast::Kind::kInfo, "A value was repaired", message);
    } else if (!app.document.dragging) {
        setStatus(app, app.document.steps[app.document.at].name);
    }
    return done;
}

bool performSet(App& app, ObjectId id, const char* key, const fwedit::Value& value) {
    Command command;
    command.verb = Verb::Set;
    if (id != 0) command.targets = {id};
    if (id == 0) command.kind = Kind::Settings;
    command.fields = {{key, value}};
    return perform(app, command);
}

bool isSelected(const App& app, ObjectId id) {
    return std::find(app.selection.begin(), app.selection.end(), id) != app.selection.end();
}

void select(App& app, ObjectId id, bool add, bool flip) {
    if (flip && isSelected(app, id)) {
        std::erase(app.selection, id);
        return;
    }
    if (!add && !flip) app.selection.clear();
    if (id != 0 && !isSelected(app, id)) app.selection.push_back(id);
}

ObjectId addObject(App& app, Kind kind, std::vector<fwedit::Assignment> fields) {
    Command command;
    command.verb = Verb::Add;
    command.kind = kind;
    command.fields = std::move(fields);
    ObjectId added = 0;
    if (perform(app, command, &added)) select(app, added, false, false);
    return added;
}

void copySelection(App& app) {
    const std::string text = fwedit::copyObjects(app.document.scene, app.selection);
    if (text.empty()) return;
    ImGui::SetClipboardText(text.c_str());
    setStatus(app, "Copied");
}

void paste(App& app) {
    const char* text = ImGui::GetClipboardText();
    std::vector<ObjectId> added;
    std::string message;
    if (!fwedit::pasteObjects(app.document, text ? text : "", added, message))
        return toast(app, Toast::Kind::kInfo, "Nothing was pasted", message);
    app.selection = added;
    setStatus(app, app.document.steps[app.document.at].name);
}

namespace {

// Factor of the paint page's camera distance, so that the scene page's wide picture fits into the
// narrow one beside the unwrap.
float paintDistanceFactor(const App& app) {
    constexpr float kWide = 0.95f;  // aspect at which nothing is cropped
    const VkExtent2D extent = app.live.target.extent();
    if (app.page != Page::kPaint || extent.width == 0) return 1;
    return std::clamp(kWide * float(extent.height) / float(extent.width), 1.0f, 2.5f);
}

}  // namespace

void frameSelection(App& app, bool all) {
    glm::vec3 low(0), high(0);
    bool any = false;
    auto take = [&](glm::vec3 p, float radius) {
        low = any ? glm::min(low, p - radius) : p - radius;
        high = any ? glm::max(high, p + radius) : p + radius;
        any = true;
    };
    const fwedit::Scene& scene = app.document.scene;
    for (const ObjectId id : app.selection) {
        if (all) break;
        if (fwedit::findIn(scene.meshes, id)) continue;
        const fwedit::Vec3 p = fwedit::worldPosition(scene, id, app.document.nodePose);
        take({p[0], p[1], p[2]}, 0.25f);
    }
    if (!any) {
        glm::vec3 a, b;
        if (app.live.bounds(a, b)) {
            take(a, 0);
            take(b, 0);
        }
        for (const fwedit::Flame& flame : scene.flames) {
            const fwedit::Vec3 p = fwedit::worldPosition(scene, flame.id, app.document.nodePose);
            take({p[0], p[1] + flame.diameter, p[2]}, flame.diameter);
        }
    }
    if (!any) return;
    const glm::vec3 middle = 0.5f * (low + high);
    app.camera.target = {middle.x, middle.y, middle.z};
    const float radius = std::max(0.05f, 0.5f * glm::length(high - low));
    // In a portrait picture, the width limits the view.
    const VkExtent2D extent = app.live.target.extent();
    const float aspect = extent.height > 0 ? float(extent.width) / float(extent.height) : 1.0f;
    const float half = 0.5f * glm::radians(std::max(5.0f, app.camera.fieldOfView));
    const float least = std::atan(std::tan(half) * std::min(1.0f, aspect));
    app.camera.distance = 1.15f * radius / std::sin(least) / paintDistanceFactor(app);
}

void compareStep(App& app, size_t step) {
    if (step >= app.document.steps.size()) return;
    fwedit::Document then = app.document;
    fwedit::goTo(then, step);
    app.live.compareWith(then.scene, then.images, fwedit::absoluteBase(app.document));
    const std::string& name = app.document.steps[step].name;
    app.compared = name.empty() ? "As it was opened" : "After: " + name;
    setStatus(app, "Compared side by side from here on");
}

std::string describePin(const App& app, fwview::WhyCard& pin) {
    const double caught = app.live.caughtAt(pin), now = app.live.time();
    if (caught >= 0 && caught > now) return "Catches at " + clockText(caught);
    if (caught >= 0) return "Caught at " + clockText(caught);
    if (!pin.error.empty()) return pin.error;
    if (!pin.answered) return "Querying the fire";
    return pin.answer.answer + (pin.answer.forecast.empty() ? "" : ". " + pin.answer.forecast);
}

const char* iconOf(const fwedit::Scene& scene, Kind kind, ObjectId id) {
    if (kind == Kind::Source) {
        const fwedit::HeatSource* source = fwedit::findIn(scene.sources, id);
        constexpr const char* kShapes[] = {icons::flame,   icons::srcPoint, icons::srcDisc,
                                           icons::srcLine, icons::srcJet,   icons::srcRain,
                                           icons::water};
        if (source && source->shape < std::size(kShapes)) return kShapes[source->shape];
        return icons::srcPoint;
    }
    switch (kind) {
        case Kind::Mesh:
            return icons::crate;
        case Kind::Flame:
            return icons::firepit;
        case Kind::Emitter:
            return icons::bolt;
        case Kind::Wind:
            return icons::wind;
        case Kind::Collider:
            return icons::mesh;
        case Kind::Layer:
            return icons::layers;
        case Kind::Event:
            return icons::event;
        default:
            return icons::tune;
    }
}

ImU32 colorOf(const fwedit::Scene& scene, Kind kind, ObjectId id) {
    if (kind == Kind::Source) {
        const fwedit::HeatSource* source = fwedit::findIn(scene.sources, id);
        return source && source->shape >= fwedit::SourceRain ? fwui::colors::wet
                                                             : fwui::colors::heat;
    }
    if (kind == Kind::Flame || kind == Kind::Emitter) return fwui::colors::heat;
    if (kind == Kind::Wind) return fwui::colors::wet;
    return fwui::colors::text;
}

std::string clockText(double seconds, bool tenths) {
    char text[32];
    const int minutes = int(seconds / 60);
    const double rest = std::max(0.0, seconds - 60.0 * minutes);
    if (tenths) {
        std::snprintf(text, sizeof text, "%d:%04.1f", minutes, std::floor(rest * 10 + 1e-3) / 10);
    } else {
        std::snprintf(text, sizeof text, "%d:%02d", minutes, int(rest + 1e-3));
    }
    return text;
}

std::string sceneName(const App& app) {
    return app.document.file.empty() ? "Untitled" : app.document.file.filename().string();
}

namespace {

void showDocument(App& app, fwedit::Document document) {
    adoptDocument(app, std::move(document));
    app.live.forget();
    app.selection.clear();
    app.strip.clear();
    app.camera = app.document.scene.camera;
    app.playing = false;
    app.placing = false;
    app.page = Page::kScene;
    app.savedRevision = app.document.revision;
    dropRecovery();
}

std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (size_t i = 0; i < lines.size() && i < 3; ++i) text += (i ? "\n" : "") + lines[i];
    if (lines.size() > 3) text += "\nand " + std::to_string(lines.size() - 3) + " more";
    return text;
}

}  // namespace

void newScene(App& app) {
    runWhenSaved(app, [&app] { showDocument(app, fwedit::newDocument()); });
}

void openScene(App& app, const fs::path& file) {
    runWhenSaved(app, [&app, file] {
        fwedit::Document document;
        std::vector<std::string> repairs;
        std::string error;
        if (!fwedit::openDocument(file, document, repairs, error)) {
            toast(app, Toast::Kind::kError, file.filename().string() + " was not opened", error);
            return;
        }
        showDocument(app, std::move(document));
        addRecent(app.user, file);
        if (!repairs.empty())
            toast(app, Toast::Kind::kWarning, file.filename().string() + " opened with repairs",
                  joined(repairs));
        setStatus(app, "Opened " + file.filename().string());
    });
}

void openBuiltIn(App& app, int which) {
    runWhenSaved(app, [&app, which] {
        fwedit::Document document = fwedit::newDocument();
        std::string error;
        if (!makeBuiltIn(which, stateFolder(), document, error)) {
            toast(app, Toast::Kind::kError, "The scene could not be created", error);
            return;
        }
        showDocument(app, std::move(document));
    });
}

void importMesh(App& app, const fs::path& file) {
    Command command;
    command.verb = Verb::Import;
    // A scene with a file stores nearby paths relative to it.
    command.file = fs::absolute(file).lexically_normal().string();
    if (!app.document.file.empty()) {
        const fs::path beside = fs::absolute(app.document.file).parent_path();
        const fs::path relative = fs::absolute(file).lexically_relative(beside);
        if (!relative.empty()) command.file = relative.string();
    }
    command.kind = Kind::Mesh;
    const fs::path stem = file.stem();
    command.fields = {{"name", stem.string()}};
    ObjectId added = 0;
    const bool first = app.document.scene.meshes.empty();
    if (app.page == Page::kWelcome) app.page = Page::kScene;
    if (!perform(app, command, &added)) return;
    if (added != 0) select(app, added, false, false);
    if (first) app.camera.distance = -1;  // frame it once it is loaded
}

bool save(App& app, bool elsewhere, std::function<void()> after) {
    auto write = [&app, after](fs::path file) {
        if (file.extension() != ".fwscene") file += ".fwscene";
        std::string error;
        if (!fwedit::saveDocument(app.document, file, error)) {
            toast(app, Toast::Kind::kError, "The scene is not saved", error);
            return false;
        }
        app.savedTime = app.now;
        app.savedRevision = app.document.revision;
        addRecent(app.user, file);
        dropRecovery();
        setStatus(app, "Saved " + file.filename().string());
        if (after) after();
        return true;
    };
    if (!elsewhere && !app.document.file.empty()) return write(app.document.file);
    FileDialog dialog;
    dialog.saves = true;
    dialog.title = "Save the scene";
    dialog.act = "Save";
    dialog.name = app.document.file.empty() ? "scene.fwscene" : sceneName(app);
    dialog.endings = {".fwscene"};
    dialog.done = [write](const fs::path& file) { write(file); };
    askFile(app, dialog);
    return false;
}

void runWhenSaved(App& app, std::function<void()> then) {
    if (!fwedit::unsaved(app.document)) {
        then();
        return;
    }
    app.guard = true;
    app.afterGuard = std::move(then);
}

void openDropped(App& app, const std::vector<fs::path>& files) {
    for (const fs::path& file : files) {
        const std::string ending = file.extension().string();
        if (ending == ".fwscene") {
            openScene(app, file);
        } else if (ending == ".glb" || ending == ".gltf") {
            importMesh(app, file);
        } else if (app.page == Page::kFlame) {
            app.flame->import(app, file);
        } else {
            toast(app, Toast::Kind::kWarning, file.filename().string() + " was not opened",
                  "Scenes (.fwscene) and meshes (.glb, .gltf) can be dropped here.");
        }
    }
}

namespace {

// Returns false if saving fails.
bool saveRecoveryCopy(App& app) {
    app.savedTime = app.now;
    app.savedRevision = app.document.revision;
    std::string error;
    if (stateFolder().empty() || !fwedit::saveCopy(app.document, recoveryFile(), error))
        return false;
    noteRecovery(app.document.file);
    return true;
}

}  // namespace

void autosave(App& app) {
    if (!fwedit::unsaved(app.document) || app.document.dragging) return;
    if (app.document.revision == app.savedRevision ||
        app.now - app.savedTime < double(app.autosaveEvery))
        return;
    saveRecoveryCopy(app);
}

void recover(App& app, const Recovery& recovery) {
    fwedit::Document document;
    std::vector<std::string> repairs;
    std::string error;
    if (!fwedit::openCopy(recovery.file, recovery.original, document, repairs, error)) {
        toast(app, Toast::Kind::kError, "The unsaved work cannot be read", error);
        return;
    }
    showDocument(app, std::move(document));
    if (!repairs.empty())
        toast(app, Toast::Kind::kWarning, "Unsaved work was recovered with repairs",
              joined(repairs));
    setStatus(app, "Recovered unsaved work");
    if (saveRecoveryCopy(app)) dropRecovery(recovery);  // only after our own copy is on disk
}

const Action* findAction(const App& app, const char* name) {
    for (const Action& action : app.actions)
        if (!std::strcmp(action.name, name)) return &action;
    return nullptr;
}

std::vector<Action> makeActions(App& app) {
    App* at = &app;
    const int scene = int(Page::kScene);
    const int opened = -3;
    auto hasSelection = [at] { return !at->selection.empty(); };
    auto sceneFile = [at](const char* title, const char* act, std::vector<std::string> endings,
                          auto done) {
        FileDialog dialog;
        dialog.title = title;
        dialog.act = act;
        dialog.endings = std::move(endings);
        dialog.done = done;
        askFile(*at, dialog);
    };
    auto place = [at](fwedit::SourceShape shape) {
        at->placing = true;
        at->placed = shape;
        at->page = Page::kScene;
    };
    auto atTarget = [at] {
        const fwedit::Vec3 p = at->camera.target;
        return std::vector<double>{p[0], p[1], p[2]};
    };
    auto seekBy = [at](double seconds) {
        at->playing = false;
        at->live.seek(at->live.time() + seconds);
    };
    auto many = [at](Verb verb) {
        Command command;
        command.verb = verb;
        command.targets = at->selection;
        ObjectId added = 0;
        if (!perform(*at, command, &added)) return;
        if (verb == Verb::Remove) at->selection.clear();
        if (verb == Verb::Duplicate && added) select(*at, added, false, false);
    };
    auto look = [at](float yaw, float pitch) {
        at->camera.yaw = yaw;
        at->camera.pitch = pitch;
    };
    std::vector<Action> list = {
        {"New scene", "File", "Ctrl+N", icons::newFile, [at] { newScene(*at); }},
        {"Open…", "File", "Ctrl+O", icons::open,
         [at, sceneFile] {
             sceneFile("Open a scene or a mesh", "Open", {".fwscene", ".glb", ".gltf"},
                       [at](const fs::path& file) { openDropped(*at, {file}); });
         }},
        {"Import mesh…", "File", "Ctrl+I", icons::importFrom,
         [at, sceneFile] {
             sceneFile("Import a mesh", "Import", {".glb", ".gltf"},
                       [at](const fs::path& file) { importMesh(*at, file); });
         }},
        {"Save", "File", "Ctrl+S", icons::save, [at] { save(*at, false); }, {}, opened, true},
        {"Save as…", "File", "Ctrl+Shift+S", nullptr, [at] { save(*at, true); }, {}, opened},
        {"Close scene",
         "File",
         "Ctrl+W",
         nullptr,
         [at] {
             runWhenSaved(*at, [at] {
                 adoptDocument(*at, fwedit::newDocument());
                 at->live.forget();
                 at->selection.clear();
                 at->page = Page::kWelcome;
                 dropRecovery();
             });
         },
         {},
         opened,
         true},
        {"Quit", "File", "Ctrl+Q", nullptr, [at] { runWhenSaved(*at, [at] { at->quit = true; }); }},

        {"Undo", "Edit", "Ctrl+Z", icons::undo,
         [at] {
             if (at->page == Page::kFlame) return at->flame->undo();
             if (fwedit::undo(at->document)) setStatus(*at, "Undone");
         },
         [at] {
             return at->page == Page::kFlame ? at->flame->at > 0 : fwedit::canUndo(at->document);
         },
         opened},
        {"Redo", "Edit", "Ctrl+Shift+Z", icons::redo,
         [at] {
             if (at->page == Page::kFlame) return at->flame->redo();
             if (fwedit::redo(at->document)) setStatus(*at, "Done again");
         },
         [at] {
             return at->page == Page::kFlame ? at->flame->at + 1 < at->flame->steps.size()
                                             : fwedit::canRedo(at->document);
         },
         opened},
        {"Duplicate", "Edit", "Ctrl+D", icons::copy, [many] { many(Verb::Duplicate); },
         hasSelection, scene, true},
        {"Copy", "Edit", "Ctrl+C", nullptr, [at] { copySelection(*at); }, hasSelection, scene},
        {"Paste", "Edit", "Ctrl+V", nullptr, [at] { paste(*at); }, {}, scene},
        {"Delete", "Edit", "Del", icons::trash, [many] { many(Verb::Remove); }, hasSelection,
         scene},
        {"Select all",
         "Edit",
         "Ctrl+A",
         nullptr,
         [at] {
             at->selection.clear();
             fwedit::forEachList(at->document.scene, [at](Kind kind, auto& objects) {
                 if (kind == Kind::Layer || kind == Kind::Event) return;
                 for (const auto& object : objects) at->selection.push_back(object.id);
             });
         },
         {},
         scene,
         true},
        {"Select nothing", "Edit", "", nullptr, [at] { at->selection.clear(); }, hasSelection,
         scene},

        {"Frame selection",
         "View",
         "F",
         icons::frame,
         [at] { frameSelection(*at, false); },
         {},
         scene},
        {"Frame all", "View", "A", nullptr, [at] { frameSelection(*at, true); }, {}, scene},
        {"Front", "View", "Num 1", icons::camera, [look] { look(0, 0); }, {}, scene, true},
        {"Side", "View", "Num 3", nullptr, [look] { look(90, 0); }, {}, scene},
        {"Top", "View", "Num 7", nullptr, [look] { look(0, 89); }, {}, scene},
        {"Keep this view in the scene",
         "View",
         "",
         nullptr,
         [at] {
             Command command;
             command.verb = Verb::Set;
             command.kind = Kind::Camera;
             const fwedit::Camera& c = at->camera;
             command.fields = {
                 {"target", std::vector<double>{c.target[0], c.target[1], c.target[2]}},
                 {"distance", double(c.distance)},
                 {"yaw", double(c.yaw)},
                 {"pitch", double(c.pitch)},
                 {"field_of_view", double(c.fieldOfView)}};
             perform(*at, command);
         },
         {},
         scene},
        {"Show marks and maps",
         "View",
         "H",
         icons::eye,
         [at] { at->showHelpers = !at->showHelpers; },
         {},
         scene,
         true},
        {"Show panels", "View", "Tab", nullptr, [at] { at->panels = !at->panels; }, {}, opened},
        {"Show burn times",
         "View",
         "O",
         icons::timer,
         [at] {
             at->burnTimes = !at->burnTimes;
             at->multipliers = false;
             if (at->burnTimes) at->showHelpers = true;
         },
         {},
         scene},
        {"Show burn multipliers",
         "View",
         "Shift+O",
         icons::brush,
         [at] {
             at->multipliers = !at->multipliers;
             at->burnTimes = false;
             if (at->multipliers) at->showHelpers = true;
         },
         {},
         scene},
        {"Larger interface", "View", "Ctrl+Plus", nullptr,
         [at] { at->user.interfaceSize = std::min(2.0f, at->user.interfaceSize + 0.25f); },
         [at] { return at->user.interfaceSize < std::min(2.0f, at->mostInterfaceSize); }, -2, true},
        {"Smaller interface", "View", "Ctrl+Minus", nullptr,
         [at] {
             const float seen = std::min(at->user.interfaceSize, at->mostInterfaceSize);
             at->user.interfaceSize = std::max(0.75f, seen - 0.25f);
         },
         [at] { return at->user.interfaceSize > 0.75f; }},

        {"Add heat source",
         "Scene",
         "Shift+A",
         icons::srcPoint,
         [place] { place(fwedit::SourcePoint); },
         {},
         scene},
        {"Add match",
         "Scene",
         "",
         icons::flame,
         [place] { place(fwedit::SourceMatch); },
         {},
         scene},
        {"Add heat disc",
         "Scene",
         "",
         icons::srcDisc,
         [place] { place(fwedit::SourceDisc); },
         {},
         scene},
        {"Add heat line",
         "Scene",
         "",
         icons::srcLine,
         [place] { place(fwedit::SourceLine); },
         {},
         scene},
        {"Add flamethrower",
         "Scene",
         "",
         icons::srcJet,
         [place] { place(fwedit::SourceFlamethrower); },
         {},
         scene},
        {"Add rain",
         "Scene",
         "",
         icons::srcRain,
         [place] { place(fwedit::SourceRain); },
         {},
         scene,
         true},
        {"Add water",
         "Scene",
         "",
         icons::water,
         [place] { place(fwedit::SourceWater); },
         {},
         scene},
        {"Add flame",
         "Scene",
         "",
         icons::firepit,
         [at, atTarget] {
             std::vector<double> p = atTarget();
             p[1] = double(at->document.scene.settings.ground);
             addObject(*at, Kind::Flame, {{"position", p}});
         },
         {},
         scene,
         true},
        {"Add smoke and sparks",
         "Scene",
         "",
         icons::bolt,
         [at, atTarget] {
             const fwedit::Scene& s = at->document.scene;
             const ObjectId id = at->selection.size() == 1 ? at->selection[0] : 0;
             // Show the fire of the selected mesh, otherwise an independent fire.
             if (fwedit::findIn(s.meshes, id)) {
                 addObject(*at, Kind::Emitter,
                           {{"shape", double(fwedit::EmitterMesh)}, {"sticks_to", double(id)}});
             } else {
                 addObject(*at, Kind::Emitter, {{"position", atTarget()}});
             }
         },
         {},
         scene},
        {"Add wind", "Scene", "", icons::wind, [at] { addObject(*at, Kind::Wind, {}); }, {}, scene},
        {"Add fan",
         "Scene",
         "",
         icons::wind,
         [at, atTarget] {
             addObject(*at, Kind::Wind,
                       {{"name", fwedit::freeName(at->document.scene, "Fan")},
                        {"shape", double(fwedit::WindFan)},
                        {"position", atTarget()}});
         },
         {},
         scene},
        {"Add wall",
         "Scene",
         "",
         icons::mesh,
         [at, atTarget] {
             addObject(*at, Kind::Collider, {{"position", atTarget()}});
         },
         {},
         scene},
        {"Drop to surface", "Scene", "D", icons::down,
         [at] {
             for (const ObjectId id : at->selection) {
                 const fwedit::Vec3 p =
                     fwedit::worldPosition(at->document.scene, id, at->document.nodePose);
                 if (!at->live.burn()) continue;
                 fwview::Ray ray;
                 ray.origin = {p[0], p[1] + 0.02f, p[2]};
                 ray.direction = {0, -1, 0};
                 float down = ray.origin.y - at->document.scene.settings.ground;
                 for (const fwedit::BurnMesh& mesh : at->live.burn()->meshes) {
                     const fwedit::Mesh* object =
                         fwedit::findIn(at->document.scene.meshes, mesh.id);
                     if (!object || mesh.id == id || !mesh.model) continue;
                     const auto pose = fwedit::transformOf(*object);
                     glm::mat4 matrix;
                     std::memcpy(&matrix[0][0], pose.data(), sizeof pose);
                     const fwview::SurfaceHit hit = fwview::castRay(*mesh.model, matrix, ray);
                     if (hit.hit) down = std::min(down, hit.distance);
                 }
                 Command command;
                 command.verb = Verb::Move;
                 command.targets = {id};
                 command.offset = {0, 0.02f - down, 0};
                 perform(*at, command);
             }
         },
         hasSelection, scene, true},

        {"Play, pause",
         "Time",
         "Space",
         icons::play,
         [at] { at->playing = !at->playing; },
         {},
         scene},
        {"Burn on from here",
         "Time",
         "Ctrl+Space",
         nullptr,
         [at] {
             at->live.seek(at->live.time());  // burn the previewed time for real
             at->playing = true;
             setStatus(*at, "Burns on from " + clockText(at->live.time()));
         },
         {},
         scene},
        {"Back one frame",
         "Time",
         ",",
         icons::stepBack,
         [at, seekBy] { seekBy(-1.0 / double(at->document.scene.settings.framesPerSecond)); },
         {},
         scene},
        {"On one frame",
         "Time",
         ".",
         icons::stepFwd,
         [at, seekBy] { seekBy(1.0 / double(at->document.scene.settings.framesPerSecond)); },
         {},
         scene},
        {"To start", "Time", "Home", icons::toStart, [at] { at->live.seek(0); }, {}, scene},
        {"To end",
         "Time",
         "End",
         icons::toEnd,
         [at] { at->live.seek(double(at->document.scene.settings.duration)); },
         {},
         scene},
        {"Compare",
         "Time",
         "C",
         icons::compare,
         [at] {
             if (at->live.isComparing()) return at->live.endCompare();
             compareStep(*at, at->document.at);
         },
         {},
         scene},
        {"Loop", "Time", "L", icons::loop, [at] { at->looping = !at->looping; }, {}, scene},
        {"Add event",
         "Time",
         "M",
         icons::event,
         [at] {
             addObject(*at, Kind::Event, {{"time", at->live.time()}});
         },
         {},
         scene,
         true},

        {"Select", "Tools", "Q", icons::select, [at] { at->tool = Tool::kSelect; }, {}, scene},
        {"Move", "Tools", "W", icons::move, [at] { at->tool = Tool::kMove; }, {}, scene},
        {"Rotate", "Tools", "E", icons::rotate, [at] { at->tool = Tool::kRotate; }, {}, scene},
        {"Scale", "Tools", "R", icons::scale, [at] { at->tool = Tool::kScale; }, {}, scene},
        {"Why does it not burn?",
         "Tools",
         "Y",
         icons::question,
         [at] {
             at->tool = at->tool == Tool::kWhy ? Tool::kMove : Tool::kWhy;
             if (at->tool != Tool::kWhy) at->live.why = {};
         },
         {},
         scene},

        {"Scene", "Pages", "1", icons::local, [at] { at->page = Page::kScene; }, {}, opened},
        {"Paint on meshes",
         "Pages",
         "2",
         icons::brush,
         [at] { at->page = Page::kPaint; },
         {},
         opened},
        {"Flame", "Pages", "3", icons::flame, [at] { at->page = Page::kFlame; }, {}, opened},
        {"Export", "Pages", "4", icons::exportTo, [at] { at->page = Page::kOutput; }, {}, opened},

        {"Find anything", "Help", "Ctrl+P", icons::search,
         [at] {
             at->palette = true;
             at->paletteFresh = true;
             at->paletteText.clear();
             at->paletteAt = 0;
         }},
        {"Keys", "Help", "F1", icons::keyboard, [at] { at->keys = !at->keys; }},
        {"What is this?", "Help", "Shift+F1", icons::question,
         [at] {
             fwui::asking() = !fwui::asking();
             if (fwui::asking()) setStatus(*at, "Point at what you ask about");
         }},
        {"About Flamewright", "Help", "", icons::info, [at] { at->about = true; }},
    };
    addPaintActions(app, list);
    addFlameActions(app, list);
    addOutputActions(app, list);
    for (Action& action : list) {
        action.standard = action.keys;
        const auto own = app.user.keys.find(action.name);
        if (own != app.user.keys.end()) action.keys = own->second;
    }
    return list;
}

const char* keysOf(const App& app, const char* name) {
    const Action* action = findAction(app, name);
    return action ? action->keys.c_str() : "";
}

bool rebind(App& app, size_t index, const std::string& keys, std::string& problem) {
    Action& action = app.actions[index];
    std::vector<fwedit::KeyUse> uses;
    for (const Action& other : app.actions) uses.push_back({other.name, other.keys, other.page});
    if (const auto wanted = fwedit::parseKeys(keys)) {
        const fwedit::KeyUse* taken = fwedit::keyConflict(uses, action.name, *wanted, action.page);
        if (taken) {
            problem = keys + " is “" + std::string(taken->command) + "”. Press other keys.";
            return false;
        }
    }
    action.keys = keys;
    if (keys == action.standard)
        app.user.keys.erase(action.name);
    else
        app.user.keys[action.name] = keys;
    saveUserState(app.user);
    problem.clear();
    setStatus(app, keys.empty() ? std::string(action.name) + " has no keys now"
                                : keys + " is " + action.name + " now");
    return true;
}

std::string listKeys(const App& app) {
    std::string text;
    for (const Action& action : app.actions)
        text += std::to_string(action.page) + "\t" + action.keys + "\t" + action.name + "\n";
    return text;
}

namespace {

bool keysPressed(const std::string& keys) {
    const ImGuiIO& io = ImGui::GetIO();
    const auto wanted = fwedit::parseKeys(keys);
    return wanted && io.KeyCtrl == wanted->ctrl && io.KeyShift == wanted->shift && !io.KeyAlt &&
           ImGui::IsKeyPressed(wanted->code, false);
}

// The next key press becomes the action's key.
void awaitKeys(App& app) {
    const ImGuiIO& io = ImGui::GetIO();
    for (int code = 0; code < IM_ARRAYSIZE(io.KeysDown); ++code) {
        if (!ImGui::IsKeyPressed(code, false)) continue;
        const std::string keys = fwedit::printKeys({code, io.KeyCtrl, io.KeyShift});
        if (keys.empty() || io.KeyAlt) continue;
        if (rebind(app, size_t(app.rebinding), keys, app.keysProblem)) app.rebinding = -1;
        return;
    }
}

}  // namespace

void runKeys(App& app) {
    const ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsKeyPressed(256, false)) {  // Esc closes the topmost overlay
        if (app.rebinding >= 0) {
            app.rebinding = -1;
            app.keysProblem.clear();
        } else if (fwui::asking()) {
            fwui::asking() = false;
        } else if (app.files.open) {
            app.files.open = false;
        } else if (app.palette) {
            app.palette = false;
        } else if (app.keys) {
            app.keys = false;
        } else if (app.about) {
            app.about = false;
        } else if (app.guard) {
            app.guard = false;
        } else if (app.placing) {
            app.placing = false;
        } else if (app.tool == Tool::kWhy && app.page == Page::kScene) {
            app.tool = Tool::kMove;
            app.live.why = {};
        } else if (!io.WantTextInput && !ImGui::IsAnyItemActive()) {
            app.selection.clear();
        }
        return;
    }
    if (app.rebinding >= 0) return awaitKeys(app);
    // A slow frame may receive several keys: one for a page, then one on that page.
    for (const Action& action : app.actions) {
        if (app.files.open || app.palette || app.guard || app.about) return;
        if (action.keys.empty() || !keysPressed(action.keys)) continue;
        // Text fields have their own undo and clipboard.
        if (io.WantTextInput && (!io.KeyCtrl || !std::strcmp(action.place, "Edit")) &&
            std::strcmp(action.name, "Keys"))
            continue;
        if (app.keys && std::strcmp(action.name, "Keys")) continue;
        if (action.page == -3 && app.page == Page::kWelcome) continue;
        if (action.page >= -1 && action.page != int(app.page)) continue;
        if (action.enabled && !action.enabled()) continue;
        action.run();
    }
}

void recordPages(App& app, const fwui::Frame& frame) {
    if (app.page == Page::kFlame) app.flame->record(frame, app.deltaTime);
    if (app.page != Page::kScene && app.page != Page::kPaint) return;
    const bool runs = app.page == Page::kScene && app.playing && !app.live.isPreparing();
    fwedit::Camera camera = app.camera;
    camera.distance *= paintDistanceFactor(app);
    app.live.record(frame, camera, runs ? app.deltaTime * app.speed : 0);
    if (app.live.milliseconds() <= 0) return;
    app.costs.push_back(float(app.live.milliseconds()));
    if (app.costs.size() > 64) app.costs.erase(app.costs.begin());
}

bool isLively(const App& app) {
    if (app.page == Page::kFlame && app.flame->isLively()) return true;
    if (app.output->isLively()) return true;
    if (app.page == Page::kWelcome && app.cardsLoading) return true;
    if (app.page != Page::kScene && app.page != Page::kPaint) return false;
    if (app.now - app.movedAt < 1) return true;  // until the full-resolution picture is ready
    return app.playing || !app.live.isSettled() || app.live.isPreparing() ||
           app.live.isPreparingRest();
}

void showApp(App& app) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    app.screen = {0, 0, size.x, size.y};
    ImGui::PushFont(fwui::fonts().body);
    runKeys(app);
    updateOutput(app);
    switch (app.page) {
        case Page::kWelcome:
            showWelcome(app, app.screen);
            break;
        case Page::kScene:
            if (app.bare)
                showBare(app, app.screen);
            else
                showScene(app, app.screen);
            break;
        case Page::kPaint:
            showPaint(app, app.screen);
            break;
        case Page::kFlame:
            showFlame(app, app.screen);
            break;
        case Page::kOutput:
            showOutput(app, app.screen);
            break;
    }
    showOverlays(app);
    ImGui::PopFont();
}

}  // namespace fwapp
