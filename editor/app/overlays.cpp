// Overlays: file dialogs, palette, keys, questions, messages.
#include <algorithm>
#include <cctype>
#include <cstring>
#include <fstream>

#include "app/app.h"
#include "shell/icons.h"

namespace fwapp {

using namespace fwui;
namespace fs = std::filesystem;

namespace {

ImDrawList* beginOverlay(const char* id, const Rect& screen, float share) {
    ImGui::SetNextWindowFocus();
    return beginPanel(id, screen, hex(0x08090A, unsigned(share * 255)), false, true);
}

std::string lower(std::string text) {
    for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

// ---- files

void listFolder(FileDialog& dialog) {
    dialog.entries.clear();
    dialog.listed = dialog.folder.string();
    std::error_code failed;
    for (const auto& entry : fs::directory_iterator(
             dialog.folder, fs::directory_options::skip_permission_denied, failed)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with(".")) continue;
        std::error_code ignored;
        const bool folder = entry.is_directory(ignored);
        const std::string ending = lower(entry.path().extension().string());
        const bool wanted =
            std::find(dialog.endings.begin(), dialog.endings.end(), ending) != dialog.endings.end();
        if (folder || wanted) dialog.entries.push_back(entry);
    }
    std::sort(dialog.entries.begin(), dialog.entries.end(), [](const auto& a, const auto& b) {
        std::error_code ignored;
        const bool x = a.is_directory(ignored), y = b.is_directory(ignored);
        if (x != y) return x;
        return lower(a.path().filename().string()) < lower(b.path().filename().string());
    });
}

void finishFile(App& app, const fs::path& chosen) {
    app.files.open = false;
    app.user.lastFolder = chosen.parent_path();
    saveUserState(app.user);
    const auto done = app.files.done;
    if (done) done(chosen);
}

void showFiles(App& app) {
    FileDialog& dialog = app.files;
    ImDrawList* list = beginOverlay("##files", app.screen, 0.62f);
    const ImVec2 size(std::min(dp(640), app.screen.width() - dp(40)),
                      std::min(dp(460), app.screen.height() - dp(40)));
    const ImVec2 low(std::floor(app.screen.midX() - size.x * 0.5f),
                     std::floor(app.screen.midY() - size.y * 0.5f));
    const ImVec2 high = low + size;
    drawCard(list, low, high);
    drawText(list, fonts().heading, low.x + dp(24), low.y + dp(30), colors::title,
             dialog.title.c_str());
    if (dialog.listed != dialog.folder.string()) listFolder(dialog);

    // Current path, and the parent folder.
    const float y = low.y + dp(54);
    if (button("up", {low.x + dp(24), y}, dp(64, 26), "Up", ButtonKind::kPlain) &&
        dialog.folder.has_parent_path())
        dialog.folder = dialog.folder.parent_path();
    drawTextFit(list, fonts().body, low.x + dp(98), y + dp(13), size.x - dp(122), colors::text,
                dialog.folder.c_str());

    const Rect area{low.x + dp(24), low.y + dp(90), high.x - dp(24), high.y - dp(104)};
    drawBox(list, area.low(), area.high(), colors::well, 4);
    ImGui::SetCursorScreenPos(area.low());
    ImGui::BeginChild("list", {area.width(), area.height()});
    ImDrawList* inner = ImGui::GetWindowDrawList();
    float row = area.y0 + dp(2) - ImGui::GetScrollY();
    fs::path entered;
    for (size_t i = 0; i < dialog.entries.size(); ++i) {
        const fs::directory_entry& entry = dialog.entries[i];
        std::error_code ignored;
        const bool folder = entry.is_directory(ignored);
        const std::string name = entry.path().filename().string();
        ImGui::PushID(int(i));
        const ListRow line =
            listRow("entry", area.x0, area.x1, row, !folder && name == dialog.name);
        ImGui::PopID();
        drawIcon(inner, fonts().icon17, {area.x0 + dp(16), line.midY},
                 folder ? colors::dim : colors::text, folder ? icons::group : icons::local);
        drawTextFit(inner, fonts().body, area.x0 + dp(32), line.midY, area.width() - dp(44),
                    colors::text, name.c_str());
        if (line.clicked && !folder) dialog.name = name;
        if (line.opened) entered = entry.path();
        row += dp(24);
    }
    ImGui::SetCursorScreenPos({area.x0, row});
    ImGui::Dummy({1, 1});
    if (dialog.entries.empty())
        drawTextCentred(inner, fonts().body, area.midX(), area.midY(), colors::dim,
                        "Nothing here that can be opened");
    ImGui::EndChild();
    if (!entered.empty()) {
        std::error_code ignored;
        if (fs::is_directory(entered, ignored)) {
            dialog.folder = entered;
        } else {
            dialog.name = entered.filename().string();
            finishFile(app, entered);
        }
    }
    // Absolute paths are accepted too.
    textField("name", {low.x + dp(24), high.y - dp(94)}, {size.x - dp(48), dp(28)}, dialog.name,
              "Name, or a whole path", nullptr, dialog.fresh);
    dialog.fresh = false;
    const bool enter = ImGui::IsKeyPressed(257, false) || ImGui::IsKeyPressed(335, false);
    const float bottom = high.y - dp(50);
    if (button("cancel", {high.x - dp(220), bottom}, dp(92, 30), "Cancel")) dialog.open = false;
    const bool act = button("act", {high.x - dp(120), bottom}, dp(96, 30), dialog.act.c_str(),
                            ButtonKind::kPrimary);
    if ((act || enter) && !dialog.name.empty() && dialog.open) {
        const fs::path chosen = fs::path(dialog.name).is_absolute() ? fs::path(dialog.name)
                                                                    : dialog.folder / dialog.name;
        std::error_code ignored;
        if (fs::is_directory(chosen, ignored)) {
            dialog.folder = chosen;
            dialog.name.clear();
        } else if (dialog.saves || fs::exists(chosen, ignored)) {
            finishFile(app, chosen);
        } else {
            toast(app, Toast::Kind::kWarning, "There is no such file", chosen.string());
        }
    }
    endPanel();
}

// ---- palette

struct Found {
    std::string name, place;
    const char *icon, *keys;
    std::function<void()> run;
    size_t at;  // position of the text in the name
};

std::vector<Found> findAnything(App& app) {
    std::vector<Found> found;
    const std::string wanted = lower(app.paletteText);
    auto consider = [&](const std::string& name, const std::string& place, const char* icon,
                        const char* keys, std::function<void()> run) {
        const size_t at = lower(name).find(wanted);
        if (at == std::string::npos) return;
        found.push_back({name, place, icon, keys, std::move(run), at});
    };
    for (const Action& action : app.actions) {
        if (action.page == -3 && app.page == Page::kWelcome) continue;
        if (action.page >= -1 && action.page != int(app.page)) continue;
        if (action.enabled && !action.enabled()) continue;
        if (!std::strcmp(action.name, "Find anything")) continue;
        consider(action.name, action.place, action.icon, action.keys.c_str(), action.run);
    }
    if (app.page != Page::kWelcome) {
        fwedit::forEachList(app.document.scene, [&](fwedit::Kind kind, const auto& list) {
            for (const auto& object : list) {
                const fwedit::ObjectId id = object.id;
                consider(object.name, "In this scene", iconOf(app.document.scene, kind, id), "",
                         [&app, id] {
                             app.page = Page::kScene;
                             select(app, id, false, false);
                             frameSelection(app, false);
                         });
            }
        });
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const Found& a, const Found& b) { return (a.at == 0) > (b.at == 0); });
    return found;
}

void showPalette(App& app) {
    ImDrawList* list = beginOverlay("##palette", app.screen, 0.45f);
    const float width = std::min(dp(580), app.screen.width() - dp(40));
    const ImVec2 low(std::floor(app.screen.midX() - width * 0.5f), app.screen.y0 + dp(84));
    const std::vector<Found> found = findAnything(app);
    // As many rows as fit above the status line.
    const float room = app.screen.y1 - dp(metrics::status + 8) - low.y - dp(50 + 46);
    const int most = std::clamp(int(room / dp(36)), 2, 8);
    const int count = int(found.size());
    const int rows = std::clamp(count, 1, most);
    const ImVec2 high(low.x + width, low.y + dp(50) + dp(36) * float(rows) + dp(46));
    drawCard(list, low, high);
    drawIcon(list, fonts().icon20, low + dp(24, 25), colors::dim, icons::search);
    const std::string before = app.paletteText;
    ImGui::PushFont(fonts().heading);
    ImGui::PushStyleColor(ImGuiCol_Text, asFloats(colors::title));
    ImGui::SetCursorScreenPos(low + dp(38, 8));
    ImGui::PushItemWidth(width - dp(60));
    ImGui::PushStyleColor(ImGuiCol_FrameBg, 0);
    if (app.paletteFresh) ImGui::SetKeyboardFocusHere();
    app.paletteFresh = false;
    char text[128];
    std::snprintf(text, sizeof text, "%s", app.paletteText.c_str());
    const bool entered = ImGui::InputTextWithHint("##find", "Find anything", text, sizeof text,
                                                  ImGuiInputTextFlags_EnterReturnsTrue);
    app.paletteText = text;
    ImGui::PopStyleColor(2);
    ImGui::PopItemWidth();
    ImGui::PopFont();
    if (app.paletteText != before) app.paletteAt = 0;
    if (ImGui::IsKeyPressed(264)) ++app.paletteAt;
    if (ImGui::IsKeyPressed(265)) --app.paletteAt;
    app.paletteAt = std::clamp(app.paletteAt, 0, std::max(0, count - 1));
    drawRow(list, low.x + hairline(), high.x - hairline(), low.y + dp(50), colors::line);
    float y = low.y + dp(54);
    const int first = std::clamp(app.paletteAt - most + 1, 0, std::max(0, count - most));
    std::function<void()> chosen;
    if (count == 0) {
        drawTextCentred(list, fonts().body, (low.x + high.x) * 0.5f, y + dp(16), colors::dim,
                        ("Nothing called ‘" + app.paletteText + "’").c_str());
    }
    for (int i = first; i < std::min(count, first + most); ++i) {
        const Found& one = found[size_t(i)];
        bool hovered = false;
        ImGui::PushID(i);
        if (hit("found", {low.x + dp(6), y}, {width - dp(12), dp(34)}, &hovered)) chosen = one.run;
        ImGui::PopID();
        const bool here = i == app.paletteAt;
        if (here || hovered)
            drawBox(list, {low.x + dp(6), y}, {high.x - dp(6), y + dp(34)},
                    here ? colors::accentSoft : hex(0xFFFFFF, 12), 5);
        const float mid = y + dp(17);
        if (one.icon)
            drawIcon(list, fonts().icon17, {low.x + dp(24), mid},
                     here ? colors::accent : colors::dim, one.icon);
        float x = low.x + dp(44);
        const size_t length = app.paletteText.size();
        x += drawText(list, fonts().body, x, mid, colors::text, one.name.substr(0, one.at).c_str());
        x += drawText(list, fonts().semi, x, mid, colors::accent,
                      one.name.substr(one.at, length).c_str());
        x += drawText(list, fonts().body, x, mid, colors::text,
                      one.name.substr(one.at + length).c_str());
        drawText(list, fonts().small, x + dp(10), mid, colors::dim, one.place.c_str());
        if (one.keys && *one.keys) drawKeys(list, high.x - dp(16), mid, one.keys, true);
        y += dp(36);
    }
    if (entered && count > 0) chosen = found[size_t(app.paletteAt)].run;
    drawRow(list, low.x + hairline(), high.x - hairline(), high.y - dp(34), colors::line);
    float x = low.x + dp(16);
    const float foot = high.y - dp(17);
    x += drawKeys(list, x, foot, "↑|↓") + dp(6);
    x += drawText(list, fonts().small, x, foot, colors::dim, "choose") + dp(14);
    x += drawKeys(list, x, foot, "Enter") + dp(6);
    x += drawText(list, fonts().small, x, foot, colors::dim, "do it") + dp(14);
    x += drawKeys(list, x, foot, "Esc") + dp(6);
    drawText(list, fonts().small, x, foot, colors::dim, "close");
    drawTextRight(list, fonts().small, high.x - dp(16), foot, colors::dim,
                  (std::to_string(count) + " found").c_str());
    const bool outside = ImGui::IsMouseClicked(0) &&
                         !Rect{low.x, low.y, high.x, high.y}.holds(ImGui::GetIO().MousePos);
    endPanel();
    if (outside) app.palette = false;
    if (!chosen) return;
    app.palette = false;
    chosen();
}

// ---- keys

void showKeys(App& app) {
    ImDrawList* list = beginOverlay("##keys", app.screen, 0.975f);
    const float x0 = app.screen.x0 + dp(40), x1 = app.screen.x1 - dp(40);
    const float y0 = app.screen.y0 + dp(44);
    drawText(list, fonts().title, x0, y0, colors::title, "Keys");
    const char* about = "Click a line to give it other keys, right click for those by design.";
    drawText(list, fonts().body, x0 + dp(88), y0 + dp(5),
             app.keysProblem.empty() ? colors::dim : colors::warn,
             app.keysProblem.empty() ? about : app.keysProblem.c_str());
    const float close = textSize(fonts().body, "close").x;
    drawTextRight(list, fonts().body, x1, y0, colors::dim, "close");
    drawKeys(list, x1 - close - dp(8), y0, "Esc", true);
    struct Line {
        std::string name, keys;
        int action = -1;  // < 0: fixed keys
    };
    struct Group {
        std::string name;
        std::vector<Line> lines;
        bool here = false;
    };
    std::vector<Group> groups;
    auto group = [&](const char* name) -> Group& {
        for (Group& known : groups)
            if (known.name == name) return known;
        groups.push_back({name, {}, false});
        return groups.back();
    };
    for (const char* place : {"File", "Edit", "Pages", "Help", "Tools", "Scene", "View", "Time",
                              "Paint", "Flame", "Export"}) {
        for (size_t i = 0; i < app.actions.size(); ++i) {
            const Action& action = app.actions[i];
            const bool keyed = !action.keys.empty() || !action.standard.empty();
            if (std::strcmp(action.place, place) || !keyed) continue;
            Group& to = group(place);
            to.lines.push_back({action.name, action.keys, int(i)});
            if (action.page == int(app.page)) to.here = true;
        }
    }
    Group& around = group("Look around");
    around.lines = {{"Orbit", "Alt+Drag|Right drag"},
                    {"Pan", "Middle drag"},
                    {"Zoom", "Wheel"},
                    {"Snap, fine", "Ctrl|Shift"}};
    for (const char* place : {"Paint", "Flame"})
        group(place).lines.push_back({"Straight line", "Shift+Click"});
    // As many columns as fit the longest lines. Taller content scrolls.
    constexpr float kLine = 23, kHead = 30, kRest = 14;
    const float gap = dp(28);
    const int columns = std::clamp(int((x1 - x0 + gap) / dp(232)), 1, 5);
    const float width = (x1 - x0 - gap * float(columns - 1)) / float(columns);
    float all = 0;
    for (const Group& one : groups) all += dp(kHead + kRest + kLine * float(one.lines.size()));
    const float begin = y0 + dp(30), end = app.screen.y1 - dp(4);
    ImGui::SetCursorScreenPos({x0 - dp(8), begin});
    ImGui::BeginChild("lines", {app.screen.x1 - x0 + dp(4), end - begin});
    list = ImGui::GetWindowDrawList();
    const float top = begin + dp(16) - ImGui::GetScrollY();
    const float bottom = top + std::max(end - begin - dp(24), all / float(columns) + dp(60));
    float x = x0, y = top, lowest = top;
    bool onLine = app.screen.x1 - ImGui::GetIO().MousePos.x < dp(16);  // or at the scroll bar
    for (const Group& one : groups) {
        // A group that does not fit starts in the next column if there is one, otherwise it
        // continues there.
        const float height = dp(kHead) + dp(kLine) * float(one.lines.size());
        const bool last = x + width + gap >= x1;
        if (y > top && y + height > bottom && !last) {
            x += width + gap;
            y = top;
        }
        const auto head = [&] {
            drawText(list, fonts().semi, x, y, one.here ? colors::accent : colors::title,
                     one.name.c_str());
            drawRow(list, x, x + width, y + dp(13), one.here ? colors::accent : colors::edge);
            y += dp(kHead);
        };
        head();
        for (const Line& line : one.lines) {
            if (y + dp(kLine * 0.5f) > bottom && x + width + gap < x1) {
                x += width + gap;
                y = top;
                head();
            }
            const bool waits = line.action >= 0 && line.action == app.rebinding;
            bool hovered = false;
            if (line.action >= 0) {
                ImGui::PushID(line.action);
                const ImVec2 low(x - dp(6), y - dp(kLine * 0.5f));
                if (hit("keys", low, {width + dp(12), dp(kLine)}, &hovered)) {
                    app.rebinding = line.action;
                    app.keysProblem.clear();
                }
                ImGui::PopID();
                if (hovered || waits)
                    drawBox(list, low, low + ImVec2(width + dp(12), dp(kLine)),
                            waits ? colors::accentSoft : colors::control);
                if (hovered && ImGui::IsMouseClicked(1))
                    rebind(app, size_t(line.action), app.actions[size_t(line.action)].standard,
                           app.keysProblem);
                onLine = onLine || hovered;
            }
            drawText(list, fonts().body, x, y, colors::text, line.name.c_str());
            lowest = std::max(lowest, y);
            if (waits) {
                drawTextRight(list, fonts().small, x + width, y, colors::accent, "Press keys");
            } else if (line.keys.empty()) {
                drawTextRight(list, fonts().small, x + width, y, colors::off, "none");
            } else {
                drawKeys(list, x + width, y, line.keys.c_str(), true);
            }
            y += dp(kLine);
        }
        y += dp(kRest);
    }
    ImGui::SetCursorScreenPos({x0, lowest + dp(kLine)});
    ImGui::Dummy({1, 1});
    ImGui::EndChild();
    endPanel();
    if (ImGui::IsMouseClicked(0) && !onLine && ImGui::GetTime() > 0) {
        app.keys = app.rebinding >= 0;
        app.rebinding = -1;
        app.keysProblem.clear();
    }
}

// ---- questions

void showGuard(App& app) {
    ImDrawList* list = beginOverlay("##guard", app.screen, 0.62f);
    const ImVec2 size = dp(440, 182);
    const ImVec2 low(std::floor(app.screen.midX() - size.x * 0.5f),
                     std::floor(app.screen.height() * 0.32f));
    drawCard(list, low, low + size);
    const std::string stem =
        app.document.file.empty() ? std::string("this scene") : app.document.file.stem().string();
    drawText(list, fonts().heading, low.x + dp(24), low.y + dp(32), colors::title,
             ("Save changes to " + stem + "?").c_str());
    const size_t steps = app.document.saved <= app.document.at
                             ? app.document.at - app.document.saved
                             : app.document.at;
    std::string what =
        steps == 1 ? "One step is not saved" : std::to_string(steps) + " steps are not saved";
    if (app.document.at < app.document.steps.size() &&
        !app.document.steps[app.document.at].name.empty())
        what += ", the last: " + app.document.steps[app.document.at].name;
    drawTextWrapped(list, fonts().body, low + dp(24, 56), size.x - dp(48), colors::text,
                    (what + ".").c_str());
    const float y = low.y + size.y - dp(56);
    auto then = app.afterGuard;
    if (button("drop", {low.x + dp(24), y}, dp(106, 32), "Don’t save", ButtonKind::kDanger)) {
        app.guard = false;
        app.document.saved = app.document.at;
        if (then) then();
    }
    if (button("cancel", {low.x + size.x - dp(238), y}, dp(90, 32), "Cancel")) app.guard = false;
    const bool enter = ImGui::IsKeyPressed(257, false);
    if (button("save", {low.x + size.x - dp(140), y}, dp(116, 32), "Save", ButtonKind::kPrimary,
               nullptr, "Enter") ||
        enter) {
        app.guard = false;
        save(app, false, then);
    }
    endPanel();
}

void showAbout(App& app) {
    ImDrawList* list = beginOverlay("##about", app.screen, 0.62f);
    const ImVec2 size = dp(520, 340);
    const ImVec2 low(std::floor(app.screen.midX() - size.x * 0.5f),
                     std::floor(app.screen.height() * 0.2f));
    drawCard(list, low, low + size);
    drawIcon(list, fonts().icon34, low + dp(40, 44), colors::heat, icons::flame);
    drawText(list, fonts().heading, low.x + dp(66), low.y + dp(36), colors::title, "Flamewright");
    const std::string version = "Version " + std::to_string(FW_VERSION_MAJOR) + "." +
                                std::to_string(FW_VERSION_MINOR) + "." +
                                std::to_string(FW_VERSION_PATCH) + ", on the " + app.device;
    drawText(list, fonts().small, low.x + dp(66), low.y + dp(56), colors::dim, version.c_str());
    const float used = drawTextWrapped(
        list, fonts().body, low + dp(24, 88), size.x - dp(48), colors::text,
        "Fire for games: what is made here burns the same in the game, by the same library.\n"
        "Made with Dear ImGui (MIT), GLFW (Zlib), FreeType (FTL), GLM (MIT), JSON for "
        "Modern C++ (MIT), OpenImageIO (BSD-3), Draco (Apache 2.0), meshoptimizer (MIT).");
    drawTextWrapped(list, fonts().small, low + ImVec2(dp(24), dp(100) + used), size.x - dp(48),
                    colors::dim,
                    "Letters: Inter, SIL Open Font License 1.1 "
                    "(/usr/share/doc/fonts-inter/copyright).\n"
                    "Icons: Material Icons by Google, Apache License 2.0 "
                    "(/usr/share/doc/fonts-material-design-icons-iconfont/copyright).\n"
                    "Code: DejaVu Sans Mono, Bitstream Vera License "
                    "(/usr/share/doc/fonts-dejavu-core/copyright).");
    if (button("close", low + size - dp(120, 52), dp(96, 30), "Close", ButtonKind::kPrimary))
        app.about = false;
    endPanel();
}

// ---- messages

void showToasts(App& app) {
    float bottom = app.screen.y1 - dp(metrics::status + 12);
    if (app.page == Page::kScene) bottom -= dp(app.user.timeline);
    for (size_t i = app.toasts.size(); i-- > 0;) {
        Toast& one = app.toasts[i];
        const float width = dp(380);
        const float text = one.text.empty()
                               ? 0
                               : drawTextWrapped(nullptr, fonts().body, {}, width - dp(68),
                                                 colors::text, one.text.c_str());
        const ImVec2 size(width, dp(46) + (text > 0 ? text + dp(8) : 0));
        const ImVec2 low(app.screen.x1 - dp(12) - width, bottom - size.y);
        const Rect room{low.x - dp(16), low.y - dp(12), app.screen.x1, bottom + dp(16)};
        ImGui::PushID(int(i));
        const std::string id = "##toast" + std::to_string(i);
        ImDrawList* list = beginPanel(id.c_str(), room, 0, false, true);
        drawCard(list, low, low + size);
        const bool error = one.kind == Toast::Kind::kError;
        const bool warning = one.kind == Toast::Kind::kWarning;
        drawIcon(list, fonts().icon20, low + dp(24, 24),
                 error     ? colors::error
                 : warning ? colors::warn
                           : colors::accent,
                 error     ? icons::error
                 : warning ? icons::warn
                           : icons::info);
        drawTextFit(list, fonts().semi, low.x + dp(44), low.y + dp(24), width - dp(80),
                    colors::title, one.title.c_str());
        if (text > 0)
            drawTextWrapped(list, fonts().body, low + dp(44, 40), width - dp(68), colors::text,
                            one.text.c_str());
        const bool closed = iconButton("close", {low.x + width - dp(18), low.y + dp(22)},
                                       icons::close, colors::dim, "Close");
        const Rect card{low.x, low.y, low.x + size.x, low.y + size.y};
        if (card.holds(ImGui::GetIO().MousePos)) one.born = std::max(one.born, app.now - 2);
        endPanel();
        ImGui::PopID();
        bottom = low.y - dp(10);
        const double life = error ? 1e9 : warning ? 9 : 4;
        if (closed || app.now - one.born > life) app.toasts.erase(app.toasts.begin() + long(i));
    }
}

}  // namespace

void askFile(App& app, FileDialog dialog) {
    dialog.open = true;
    dialog.fresh = true;
    if (dialog.folder.empty()) {
        dialog.folder =
            app.document.file.empty() ? app.user.lastFolder : app.document.file.parent_path();
        std::error_code failed;
        if (dialog.folder.empty() || !fs::is_directory(dialog.folder, failed))
            dialog.folder = fs::current_path();
    }
    dialog.folder = fs::absolute(dialog.folder).lexically_normal();
    app.files = std::move(dialog);
}

void showOverlays(App& app) {
    showToasts(app);
    if (app.files.open) showFiles(app);
    if (app.palette) showPalette(app);
    if (app.guard) showGuard(app);
    if (app.about) showAbout(app);
    if (app.keys) showKeys(app);
    if (asking())
        drawChip(ImGui::GetForegroundDrawList(), ImGui::GetIO().MousePos + dp(50, -22),
                 "What is this?");
}

}  // namespace fwapp
