// The scene page: tools, outliner and history, the picture, inspector, timeline.
#include <algorithm>
#include <cstring>

#include "app/app.h"
#include "app/inspector.h"
#include "app/paint_page.h"
#include "app/viewport_panel.h"
#include "shell/icons.h"

namespace fwapp {

using namespace fwui;
using fwedit::Kind;
using fwedit::ObjectId;

namespace {

void drawSeparator(ImDrawList* list, float& x, const Rect& rect) {
    x += dp(6);
    drawColumn(list, x, rect.y0 + dp(9), rect.y1 - dp(9), colors::edge);
    x += dp(7);
}

void showTools(App& app, const Rect& rect) {
    ImDrawList* list = beginPanel("##tools", rect, colors::header);
    const float y = rect.y0 + dp(5);
    float x = rect.x0 + dp(8);
    auto act = [&](const char* name) { findAction(app, name)->run(); };
    ToolLook look{.icon = icons::select};
    look.active = app.tool == Tool::kSelect;
    look.mirrored = true;
    if (toolButton("select", {x, y}, look, "Select", keysOf(app, "Select"))) act("Select");
    x += dp(30);
    look = {.icon = icons::move};
    look.active = app.tool == Tool::kMove;
    if (toolButton("move", {x, y}, look, "Move", keysOf(app, "Move"))) act("Move");
    x += dp(30);
    look = {.icon = icons::rotate};
    look.active = app.tool == Tool::kRotate;
    if (toolButton("rotate", {x, y}, look, "Rotate", keysOf(app, "Rotate"))) act("Rotate");
    x += dp(30);
    look = {.icon = icons::scale};
    look.active = app.tool == Tool::kScale;
    if (toolButton("scale", {x, y}, look, "Scale", keysOf(app, "Scale"))) act("Scale");
    x += dp(30);
    drawSeparator(list, x, rect);
    look = {.icon = icons::snap, .label = "Snap"};
    look.active = app.snapping;
    if (toolButton("snap", {x, y}, look, "Snap to 5 cm, 15° and 10 %", "hold Ctrl"))
        app.snapping = !app.snapping;
    x += toolButtonWidth(look);
    drawSeparator(list, x, rect);
    x += drawText(list, fonts().body, x + dp(2), y + dp(14), colors::dim, "Add") + dp(10);
    look = {.icon = icons::srcPoint, .label = "Heat"};
    look.drops = true;
    look.active = app.placing;
    if (toolButton("heat", {x, y}, look, "Add a heat source: then click where",
                   keysOf(app, "Add heat source")))
        ImGui::OpenPopup("heat menu");
    if (beginMenu("heat menu", {x, rect.y1 - dp(3)}, dp(180))) {
        for (const char* name : {"Add heat source", "Add match", "Add heat disc", "Add heat line",
                                 "Add flamethrower"}) {
            const Action* action = findAction(app, name);
            if (menuItem(name + 4, action->icon, action->keys.c_str())) action->run();
        }
        endMenu();
    }
    x += toolButtonWidth(look) + dp(4);
    struct Adder {
        const char *icon, *label, *action;
    };
    constexpr Adder kAdders[] = {{icons::firepit, "Flame", "Add flame"},
                                 {icons::wind, "Wind", "Add wind"},
                                 {icons::srcRain, "Rain", "Add rain"},
                                 {icons::water, "Water", "Add water"},
                                 {icons::mesh, "Wall", "Add wall"}};
    const ToolLook why{.icon = icons::question, .label = "Why?", .active = app.tool == Tool::kWhy};
    const ToolLook times{.icon = icons::timer, .label = "Burn times", .active = app.burnTimes};
    const float apart = dp(4), light = dp(162), edge = rect.x1 - dp(8);
    const float others = toolButtonWidth(why) + apart + toolButtonWidth(times) + dp(10) + light;
    float all = 0;
    for (const Adder& adder : kAdders)
        all += toolButtonWidth({.icon = adder.icon, .label = adder.label}) + apart;
    if (x + all + others <= edge) {
        for (const Adder& adder : kAdders) {
            look = {.icon = adder.icon, .label = adder.label};
            if (toolButton(adder.action, {x, y}, look, adder.action)) act(adder.action);
            x += toolButtonWidth(look) + apart;
        }
    } else {  // in a narrow window the camera menu needs the space
        look = {.icon = icons::add, .label = "More", .drops = true};
        if (toolButton("more", {x, y}, look, "Add a flame, wind, rain, water or a wall"))
            ImGui::OpenPopup("more menu");
        if (beginMenu("more menu", {x, rect.y1 - dp(3)}, dp(180))) {
            for (const Adder& adder : kAdders)
                if (menuItem(adder.label, adder.icon, keysOf(app, adder.action))) act(adder.action);
            endMenu();
        }
        x += toolButtonWidth(look) + apart;
    }
    float right = edge - toolButtonWidth(why);
    if (toolButton("why", {right, y}, why, "Ask a spot why it does not burn",
                   keysOf(app, "Why does it not burn?")))
        act("Why does it not burn?");
    if (right - dp(10) - light - apart - toolButtonWidth(times) > x) {
        right -= toolButtonWidth(times) + apart;
        if (toolButton("burn times", {right, y}, times, "When each spot caught",
                       keysOf(app, "Show burn times")))
            act("Show burn times");
    }
    right -= dp(10) + light;
    int chosen = int(app.document.scene.settings.daylight);
    if (right > x &&
        segments("light", {right, y + dp(2)}, {light, dp(24)}, {"Night", "Dusk", "Day"}, chosen))
        performSet(app, 0, "daylight", double(chosen));
    endPanel();
}

bool matchesFilter(const std::string& name, const std::string& filter) {
    if (filter.empty()) return true;
    auto lower = [](char c) { return char(std::tolower(static_cast<unsigned char>(c))); };
    const auto found = std::search(name.begin(), name.end(), filter.begin(), filter.end(),
                                   [&](char a, char b) { return lower(a) == lower(b); });
    return found != name.end();
}

void showObjectMenu(App& app, ObjectId id, const fwedit::Object& object) {
    if (!beginMenu("object menu", ImGui::GetMousePosOnOpeningCurrentPopup(), dp(170))) return;
    if (menuItem("Rename", nullptr, "F2")) {
        app.renaming = id;
        app.renamed = object.name;
    }
    for (const char* name : {"Frame selection", "Duplicate", "Delete"}) {
        const Action* action = findAction(app, name);
        if (menuItem(name, action->icon, action->keys.c_str())) action->run();
    }
    endMenu();
}

void showOutlinerRow(App& app, ImDrawList* list, const Rect& rect, float& y, Kind kind,
                     const fwedit::Object& object, float indent) {
    const fwedit::Scene& scene = app.document.scene;
    const ObjectId id = object.id;
    ImGui::PushID(int(id));
    const ListRow row = listRow("row", rect.x0, rect.x1, y, isSelected(app, id));
    const ImGuiIO& io = ImGui::GetIO();
    if (row.clicked) select(app, id, io.KeyShift, io.KeyCtrl);
    if (row.hovered && ImGui::IsMouseClicked(1)) {
        if (!isSelected(app, id)) select(app, id, false, false);
        ImGui::OpenPopup("object menu");
    }
    if (row.opened || (isSelected(app, id) && app.selection.size() == 1 && !io.WantTextInput &&
                       ImGui::IsKeyPressed(291, false))) {  // F2: rename
        app.renaming = id;
        app.renamed = object.name;
    }
    const float x = rect.x0 + dp(10 + indent);
    drawIcon(list, fonts().icon17, {x + dp(8), row.midY},
             object.hidden ? colors::off : colorOf(scene, kind, id), iconOf(scene, kind, id));
    if (app.renaming == id) {
        if (textField("name", {x + dp(20), y + dp(1)}, {rect.x1 - dp(26) - x - dp(20), dp(22)},
                      app.renamed, "", nullptr, !ImGui::IsAnyItemActive())) {
            if (!app.renamed.empty() && app.renamed != object.name)
                performSet(app, id, "name", app.renamed);
            app.renaming = 0;
        }
    } else {
        const bool marked = object.locked || object.hidden;
        const float room = rect.x1 - dp(row.hovered ? 50 : marked ? 48 : 28) - (x + dp(20));
        const ImU32 color = isSelected(app, id) ? colors::title
                            : object.hidden     ? colors::off
                                                : colors::text;
        drawTextFit(list, fonts().body, x + dp(20), row.midY, room, color, object.name.c_str());
        const bool shows = kind != Kind::Wind && kind != Kind::Event;
        if (row.hovered || object.locked) {
            if (iconButton("lock", {rect.x1 - dp(36), row.midY},
                           object.locked ? icons::lock : icons::unlock,
                           object.locked ? colors::text : colors::dim,
                           object.locked ? "Unlock" : "Lock: not picked in the picture"))
                performSet(app, id, "locked", object.locked ? 0.0 : 1.0);
        }
        if (shows && (row.hovered || object.hidden)) {
            if (iconButton(
                    "eye", {rect.x1 - dp(14), row.midY}, object.hidden ? icons::eyeOff : icons::eye,
                    object.hidden ? colors::off : colors::dim, object.hidden ? "Show" : "Hide"))
                performSet(app, id, "hidden", object.hidden ? 0.0 : 1.0);
        }
    }
    showObjectMenu(app, id, object);
    ImGui::PopID();
    y += dp(24);
}

void showEmpty(ImDrawList* list, const Rect& rect, const char* icon, const char* text) {
    const float y = rect.y0 + std::min(dp(90), rect.height() * 0.4f);
    drawIcon(list, fonts().icon34, {rect.midX(), y}, colors::off, icon);
    drawTextCentred(list, fonts().body, rect.midX(), y + dp(34), colors::dim, text);
}

void showHistory(App& app, const Rect& rect) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    if (app.document.steps.size() <= 1) {
        showEmpty(list, rect, icons::history, "No changes yet");
        return;
    }
    float y = rect.y0 + dp(6) - ImGui::GetScrollY();
    for (size_t i = 0; i < app.document.steps.size(); ++i) {
        ImGui::PushID(int(i));
        const bool here = i == app.document.at;
        const ListRow row = listRow("step", rect.x0, rect.x1, y, here);
        const bool undone = i > app.document.at;
        drawTextFit(list, fonts().body, rect.x0 + dp(14), row.midY, rect.width() - dp(24),
                    undone ? colors::off
                    : here ? colors::title
                           : colors::text,
                    i == 0 ? "As it was opened" : app.document.steps[i].name.c_str());
        if (row.clicked) fwedit::goTo(app.document, i);
        if (row.hovered && ImGui::IsMouseClicked(1)) ImGui::OpenPopup("step menu");
        if (beginMenu("step menu", ImGui::GetMousePosOnOpeningCurrentPopup(), dp(190))) {
            if (menuItem("Go back to this", icons::history)) fwedit::goTo(app.document, i);
            if (menuItem("Compare with this", icons::compare)) compareStep(app, i);
            endMenu();
        }
        ImGui::PopID();
        y += dp(24);
    }
}

void showLeftPanel(App& app, Rect rect) {
    const Rect head = rect.cutTop(dp(app.leftTab == 1 ? 30 : 64));
    ImDrawList* list = beginPanel("##left", head);
    Rect tabs = head;
    tabs.y1 = tabs.y0 + dp(30);
    panelTabs(list, tabs, {"Outliner", "History"}, app.leftTab);
    if (app.leftTab == 1) {
        endPanel();
        beginPanel("##history", rect, colors::panel, true);
        showHistory(app, rect);
        endPanel();
        return;
    }
    if (iconButton("add", {tabs.x1 - dp(16), tabs.midY()}, icons::add, colors::text,
                   "Add to the scene"))
        ImGui::OpenPopup("add menu");
    if (beginMenu("add menu", {tabs.x1 - dp(30), tabs.y1}, dp(190))) {
        for (const Action& action : app.actions) {
            if (std::strncmp(action.name, "Add ", 4) || std::strcmp(action.place, "Scene"))
                continue;
            if (action.line) menuLine();
            std::string name = action.name + 4;
            name[0] = char(std::toupper(static_cast<unsigned char>(name[0])));
            if (menuItem(name.c_str(), action.icon, action.keys.c_str())) action.run();
        }
        menuLine();
        if (menuItem("Mesh from a file…", icons::importFrom))
            findAction(app, "Import mesh…")->run();
        endMenu();
    }
    const Rect search{head.x0, tabs.y1, head.x1, head.y1};
    textField("filter", search.low() + dp(8, 5), {search.width() - dp(16), dp(24)}, app.filter,
              "Filter", icons::search);
    endPanel();

    list = beginPanel("##objects", rect, colors::panel, true);
    const fwedit::Scene& scene = app.document.scene;
    float y = rect.y0 - ImGui::GetScrollY();
    size_t shown = 0;
    struct Group {
        Kind kind;
        const char* name;
    };
    fwedit::forEachList(app.document.scene, [&](Kind kind, const auto& objects) {
        if (kind == Kind::Event || kind == Kind::Layer) return;
        // Rows may change the document, so use indices and keep no reference.
        for (size_t i = 0; i < objects.size(); ++i) {
            const fwedit::Object object = objects[i];
            if (!matchesFilter(object.name, app.filter)) continue;
            showOutlinerRow(app, list, rect, y, kind, object, 0);
            ++shown;
            if (kind != Kind::Mesh) continue;
            for (size_t k = 0; k < scene.layers.size(); ++k) {
                if (scene.layers[k].mesh != object.id) continue;
                const fwedit::Object layer = scene.layers[k];
                showOutlinerRow(app, list, rect, y, Kind::Layer, layer, 16);
            }
        }
    });
    ImGui::SetCursorScreenPos({rect.x0, y + dp(8)});
    ImGui::Dummy({1, 1});
    if (shown == 0) {
        showEmpty(list, rect, icons::crate,
                  app.filter.empty() ? "Nothing here yet" : "Nothing is called that");
        const float at = rect.y0 + std::min(dp(90), rect.height() * 0.4f) + dp(54);
        if (app.filter.empty() && button("import", {rect.midX() - dp(62), at}, dp(124, 28),
                                         "Import mesh", ButtonKind::kPlain, icons::importFrom))
            findAction(app, "Import mesh…")->run();
    }
    endPanel();
}

// Maps time to x on a strip.
struct TimeScale {
    float x0, x1;
    double duration;
    float x(double t) const { return x0 + (x1 - x0) * float(t / duration); }
    double t(float x) const {
        return std::clamp(double(x - x0) / double(x1 - x0), 0.0, 1.0) * duration;
    }
};

void showRuler(ImDrawList* list, const Rect& rect, const TimeScale& scale, double now) {
    list->AddRectFilled(rect.low(), rect.high(), colors::header);
    constexpr double kSteps[] = {0.1, 0.5, 1, 2, 5, 10, 30, 60, 300, 600, 3600};
    double step = kSteps[10];
    for (const double candidate : kSteps) {
        if ((scale.x1 - scale.x0) * float(candidate / scale.duration) < dp(56)) continue;
        step = candidate;
        break;
    }
    const int marks = int(scale.duration / step * 5 + 1e-6);
    for (int i = 0; i <= marks; ++i) {
        const double t = step * i / 5;
        const float x = std::floor(scale.x(t));
        const bool big = i % 5 == 0;
        drawColumn(list, x, rect.y1 - dp(big ? 8 : 4), rect.y1, big ? colors::off : colors::line);
        const float head = scale.x(now);
        if (!big || x > scale.x1 - dp(30) || (x + dp(40) > head - dp(28) && x < head + dp(28)))
            continue;
        drawText(list, fonts().small, x + dp(4), rect.midY() - dp(1), colors::dim,
                 clockText(t, step < 1).c_str());
    }
}

struct Mark {
    double time;
    std::string name;
    const char* icon;
    ImU32 color;
    ObjectId id;
};

std::vector<Mark> marksOf(const fwedit::Scene& scene) {
    std::vector<Mark> marks;
    auto starts = [&](Kind kind, const auto& list) {
        for (const auto& object : list)
            if (!object.hidden)
                marks.push_back({double(object.start), object.name, iconOf(scene, kind, object.id),
                                 colorOf(scene, kind, object.id), object.id});
    };
    starts(Kind::Source, scene.sources);
    starts(Kind::Flame, scene.flames);
    starts(Kind::Emitter, scene.emitters);
    starts(Kind::Wind, scene.winds);
    for (const fwedit::Event& event : scene.events)
        marks.push_back({double(event.time), event.name, icons::event, colors::warn, event.id});
    std::stable_sort(marks.begin(), marks.end(),
                     [](const Mark& a, const Mark& b) { return a.time < b.time; });
    return marks;
}

// Shows names if there is space. A name that would overlap the next mark is dropped, never cut.
void showMarks(App& app, ImDrawList* list, const Rect& rect, const TimeScale& scale) {
    const std::vector<Mark> marks = marksOf(app.document.scene);
    // Marks with equal times stand side by side.
    std::vector<float> places;
    for (const Mark& mark : marks) {
        const float x = scale.x(std::min(mark.time, scale.duration));
        places.push_back(places.empty() ? x : std::max(x, places.back() + dp(20)));
    }
    for (size_t i = 0; i < marks.size(); ++i) {
        const Mark& mark = marks[i];
        if (mark.time > scale.duration || places[i] > scale.x1) break;
        const float x = places[i];
        const float end = i + 1 < marks.size() ? places[i + 1] - dp(12) : scale.x1 + dp(20);
        ImGui::PushID(int(mark.id));
        if (hit("mark", {x - dp(9), rect.midY() - dp(9)}, dp(18, 18)))
            select(app, mark.id, false, false);
        ImGui::PopID();
        tip(mark.name.c_str(), clockText(mark.time).c_str());
        list->AddCircleFilled({x, rect.midY()}, dp(9), faded(mark.color, 0.22f), 24);
        if (isSelected(app, mark.id))
            list->AddCircle({x, rect.midY()}, dp(9), colors::accent, 24, dp(1.5f));
        drawIcon(list, fonts().icon14, {x, rect.midY()}, mark.color, mark.icon);
        if (x + dp(13) + textSize(fonts().small, mark.name.c_str()).x < end)
            drawText(list, fonts().small, x + dp(13), rect.midY(), colors::text, mark.name.c_str());
    }
}

// Right of the playhead, so that it does not cross the text; left of it at the end of the strip.
void showShare(ImDrawList* list, const Rect& rect, const TimeScale& scale, double now,
               const char* text) {
    const float width = textSize(fonts().small, text).x, head = scale.x(now);
    float x = head + dp(8);
    if (x + width > scale.x1 - dp(4)) x = head - dp(8) - width;
    drawText(list, fonts().small, x, rect.y0 + dp(12), colors::text, text);
}

// Shows the burnt share of all meshes over the recorded time.
void showStrip(const App& app, ImDrawList* list, const Rect& rect, const TimeScale& scale) {
    list->AddRectFilled({scale.x0, rect.y0 + dp(2)}, {scale.x1, rect.y1 - dp(4)}, colors::well);
    const float low = rect.y1 - dp(4), height = rect.height() - dp(6);
    for (size_t i = 1; i < app.strip.size(); ++i) {
        const auto [t0, s0] = app.strip[i - 1];
        const auto [t1, s1] = app.strip[i];
        const float x0 = scale.x(double(t0)), x1 = std::min(scale.x1, scale.x(double(t1)));
        if (x0 >= scale.x1) break;
        list->AddQuadFilled({x0, low - height * s0}, {x1, low - height * s1}, {x1, low}, {x0, low},
                            mix(colors::well, colors::heat, 0.55f));
        list->AddLine({x0, low - height * s0}, {x1, low - height * s1}, colors::heat, dp(1.5f));
    }
    if (app.strip.size() > 1) {
        char text[48];
        std::snprintf(text, sizeof text, "%.0f %% burnt", double(100 * app.strip.back().second));
        showShare(list, rect, scale, std::min(app.live.time(), scale.duration), text);
    } else if (app.document.scene.meshes.empty()) {
        drawText(list, fonts().small, scale.x0 + dp(8), rect.midY() - dp(1), colors::dim,
                 "Burning meshes show here");
    } else {
        drawText(list, fonts().small, scale.x0 + dp(8), rect.midY() - dp(1), colors::dim,
                 "Play to see it burn");
    }
}

// Thumbnails of the burn over the recorded time.
void showFilm(const App& app, ImDrawList* list, const Rect& rect, const TimeScale& scale) {
    const fwview::FilmStrip& film = app.live.film;
    const float y0 = rect.y0, y1 = rect.y1 - dp(4);
    if (film.empty() || !app.live.burn()) {
        list->AddRectFilled({scale.x0, y0}, {scale.x1, y1}, colors::well);
        drawText(list, fonts().small, scale.x0 + dp(8), 0.5f * (y0 + y1), colors::dim,
                 "Pictures of the played burn show here");
        return;
    }
    const float width = (scale.x1 - scale.x0) / float(film.kPictures);
    for (uint32_t i = 0; i < film.kPictures; ++i) {
        const ImVec2 low(std::floor(scale.x0 + width * float(i)), y0);
        const ImVec2 high(std::floor(scale.x0 + width * float(i + 1)) - hairline(), y1);
        list->AddRectFilled(low, high, colors::well);
        if (!film.has(i)) continue;
        ImVec2 from, to;
        film.place(i, (high.x - low.x) / (high.y - low.y), from, to);
        list->AddImage(film.texture(), low, high, from, to);
    }
}

void recordStrip(App& app) {
    const fwedit::Burn* burn = app.live.burn();
    if (!burn || app.live.isPreparing()) return;
    const auto time = float(burn->time);
    if (!app.strip.empty() && time < app.strip.back().first)
        std::erase_if(app.strip, [&](const auto& at) { return at.first > time; });
    if (!app.strip.empty() && time < app.strip.back().first + 0.1f) return;
    float burnt = 0, all = 0;
    for (const fwedit::BurnMesh& mesh : burn->meshes) {
        FwObjectState state{};
        state.structSize = sizeof state;
        if (fwWorld_GetObjectState(burn->world, mesh.object, &state) != FW_OK) continue;
        burnt += float(state.ignited);
        all += float(state.texels);
    }
    if (all > 0) app.strip.emplace_back(time, burnt / all);
}

void showTimeline(App& app, Rect rect) {
    recordStrip(app);
    ImDrawList* list = beginPanel("##timeline", rect);
    const Rect transport = rect.cutTop(dp(34));
    list->AddRectFilled(transport.low(), transport.high(), colors::header);
    showTransport(app, list, transport, true);
    if (rect.height() < dp(40)) {
        endPanel();
        return;
    }
    const TimeScale scale{rect.x0 + dp(92), rect.x1 - dp(24),
                          double(app.document.scene.settings.duration)};
    const double now = std::min(app.live.time(), scale.duration);
    const Rect ruler = rect.cutTop(dp(22));
    const Rect events = rect.cutTop(std::min(dp(26), rect.height()));
    showRuler(list, ruler, scale, now);
    list->AddRectFilled(ruler.low(), {scale.x0 - dp(12), ruler.y1}, colors::header);

    // A drag anywhere changes the time; marks lie above and take their clicks first.
    const float bottom = rect.y1;
    showMarks(app, list, events, scale);
    bool held = false;
    hit("scrub", {scale.x0 - dp(6), ruler.y0}, {scale.x1 - scale.x0 + dp(12), bottom - ruler.y0},
        nullptr, &held);
    const double wanted = scale.t(ImGui::GetIO().MousePos.x);
    if (held) {
        app.playing = false;
        app.scrubbing = true;
        if (std::fabs(wanted - app.live.time()) > 0.02) app.live.seek(wanted, true);
    } else if (app.scrubbing) {
        app.scrubbing = false;
        app.live.seek(wanted);
    }
    drawText(list, fonts().small, rect.x0 + dp(10), events.midY(), colors::dim, "Events");
    // If the height is small, only the strip shows; the film takes the rest.
    if (rect.height() > dp(14)) {
        const Rect strip = rect.cutTop(std::min(dp(26), rect.height()));
        drawText(list, fonts().small, strip.x0 + dp(10), strip.midY() - dp(1), colors::dim,
                 "Burn strip");
        showStrip(app, list, strip, scale);
    }
    if (rect.height() > dp(18)) {
        drawText(list, fonts().small, rect.x0 + dp(10), rect.midY() - dp(2), colors::dim,
                 "Filmstrip");
        showFilm(app, list, rect, scale);
    }
    const float x = std::floor(scale.x(now));
    list->AddRectFilled({x, ruler.y0 + dp(10)}, {x + dp(1.5f), bottom - dp(3)}, colors::accent);
    const std::string text = clockText(now);
    const float width = textSize(fonts().smallSemi, text.c_str()).x + dp(12);
    drawBox(list, {x - width * 0.5f, ruler.y0 + dp(2)}, {x + width * 0.5f, ruler.y0 + dp(20)},
            colors::accentFill);
    drawTextCentred(list, fonts().smallSemi, x, ruler.y0 + dp(11), colors::white, text.c_str());
    endPanel();
}

// Updates the map over the picture: burn multipliers, or burn times, which grow with the burn.
void updateMaps(App& app) {
    if (app.multipliers && app.showHelpers) {
        app.burnTimesAt = -1;
        if (app.multipliersOf == app.document.revision || app.live.isPreparing()) return;
        app.multipliersOf = app.document.revision;
        colorMultipliers(app);
        return;
    }
    app.multipliersOf = ~0ull;
    if (!app.burnTimes || !app.showHelpers) {
        if (!app.live.overlaid.empty()) app.live.redraw();
        app.live.overlaid.clear();
        app.burnTimesAt = -1;
        return;
    }
    const double known = app.live.knownTime();
    if (known == app.burnTimesAt) return;
    app.burnTimesAt = known;
    app.live.colorBurnTimes(kTimeMap);
}

}  // namespace

void showBare(App& app, const Rect& rect) {
    app.live.follow(app.document);
    app.live.shown = fwview::Shown::kBurn;
    showPicture(app, rect);
}

void showScene(App& app, Rect rect) {
    app.live.follow(app.document);
    app.live.shown = fwview::Shown::kBurn;
    updateMaps(app);
    app.paint->colored = false;  // this page takes over the overlay
    for (const std::string& line : app.live.takeReport())
        toast(app, Toast::Kind::kWarning, "Something was left out", line);
    if (app.camera.distance < 0 && app.live.burn() && !app.live.isPreparing()) {
        app.camera.distance = 2;
        frameSelection(app, true);
    }
    showTopBar(app, rect.cutTop(dp(metrics::topBar)));
    showTools(app, rect.cutTop(dp(metrics::toolBar)));
    const Rect status = rect.cutBottom(dp(metrics::status));
    if (app.tool == Tool::kWhy && !app.placing) {
        showStatus(app, status,
                   {{"Click", "ask why"},
                    {"Alt+drag", "orbit"},
                    {keysOf(app, "Play, pause"), "play"},
                    {"Esc", "done"}});
    } else if (app.placing) {
        showStatus(app, status, {{"Click", "place it"}, {"Esc", "cancel"}});
    } else if (app.selection.empty()) {
        showStatus(app, status,
                   {{"Click", "select"},
                    {"Alt+drag", "orbit"},
                    {"Wheel", "zoom"},
                    {keysOf(app, "Add heat source"), "add heat"},
                    {keysOf(app, "Play, pause"), "play"}});
    } else {
        showStatus(app, status,
                   {{"Drag", "move"},
                    {"Ctrl", "snap"},
                    {"Alt+drag", "orbit"},
                    {keysOf(app, "Drop to surface"), "drop to surface"},
                    {keysOf(app, "Frame selection"), "frame"}});
    }
    rect.y0 += dp(1);
    const float gap = dp(2), whole = rect.x1;
    // In a small window the timeline folds first, then the left panel hides.
    const bool low = rect.height() < dp(380) || !app.panels;
    const bool narrow = rect.width() < dp(900) || !app.panels;
    const float timeline = low ? dp(34) : dp(app.user.timeline);
    const Rect bottom = rect.cutBottom(timeline);
    rect.cutBottom(gap);
    const Rect left = narrow ? Rect{} : rect.cutLeft(dp(app.user.left));
    if (!narrow) rect.cutLeft(gap);
    const Rect right = app.panels ? rect.cutRight(dp(app.user.right)) : Rect{};
    if (app.panels) rect.cutRight(gap);
    showTimeline(app, bottom);
    if (!narrow) showLeftPanel(app, left);
    if (app.panels) showInspector(app, right);
    showViewport(app, rect);
    if (!narrow)
        splitter("##split left",
                 {.vertical = true,
                  .at = left.x1,
                  .from = left.y0,
                  .to = left.y1,
                  .design = 216,
                  .lowest = 160,
                  .highest = 420,
                  .sign = 1},
                 app.user.left);
    if (app.panels)
        splitter("##split right",
                 {.vertical = true,
                  .at = right.x0 - gap,
                  .from = right.y0,
                  .to = right.y1,
                  .design = 296,
                  .lowest = 264,
                  .highest = 460,
                  .sign = -1},
                 app.user.right);
    if (!low)
        splitter("##split time",
                 {.vertical = false,
                  .at = bottom.y0 - gap,
                  .from = bottom.x0,
                  .to = whole,
                  .design = 144,
                  .lowest = 92,
                  .highest = 340,
                  .sign = -1},
                 app.user.timeline);
    if (app.playing && !app.live.isSeeking() &&
        app.live.time() >= double(app.document.scene.settings.duration)) {
        if (app.looping) {
            app.live.seek(0);
        } else {
            app.playing = false;
        }
    }
}

}  // namespace fwapp
