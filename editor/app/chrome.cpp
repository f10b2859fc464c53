// The frame around every page: menus and page tabs, status line, transport.
#include <algorithm>
#include <cstdio>
#include <cstring>

#include "app/app.h"
#include "shell/icons.h"

namespace fwapp {

using namespace fwui;

namespace {

constexpr const char* kMenus[] = {"File", "Edit", "View", "Scene", "Time", "Help"};

bool isAllowed(const App& app, const Action& action) {
    if (action.page == -3 && app.page == Page::kWelcome) return false;
    if (action.page >= -1 && action.page != int(app.page)) return false;
    return !action.enabled || action.enabled();
}

void showMenu(App& app, const char* name, ImVec2 at) {
    if (!beginMenu(name, at, dp(220))) return;
    bool first = true;
    for (const Action& action : app.actions) {
        if (std::strcmp(action.place, name)) continue;
        if (action.line && !first) menuLine();
        first = false;
        if (menuItem(action.name, action.icon, action.keys.c_str(), isAllowed(app, action)))
            action.run();
    }
    if (!std::strcmp(name, "File") && !app.user.recent.empty()) {
        menuLine();
        for (size_t i = 0; i < app.user.recent.size() && i < 5; ++i) {
            const std::filesystem::path file = app.user.recent[i];
            if (menuItem(file.filename().c_str(), icons::history)) openScene(app, file);
        }
    }
    endMenu();
}

}  // namespace

void showTopBar(App& app, const Rect& rect) {
    ImDrawList* list = beginPanel("##top", rect, colors::gap);
    const float y = rect.midY();
    drawIcon(list, fonts().icon20, {rect.x0 + dp(20), y}, colors::heat, icons::flame);
    float x = rect.x0 + dp(40);
    const bool anyOpen = std::any_of(std::begin(kMenus), std::end(kMenus),
                                     [](const char* name) { return ImGui::IsPopupOpen(name); });
    for (const char* name : kMenus) {
        const float width = textSize(fonts().body, name).x + dp(16);
        bool hovered = false;
        const bool pressed =
            hit(name, {x, rect.y0 + dp(6)}, {width, rect.height() - dp(12)}, &hovered);
        const bool open = ImGui::IsPopupOpen(name);
        if (hovered || open)
            drawBox(list, {x, rect.y0 + dp(6)}, {x + width, rect.y1 - dp(6)}, colors::hover);
        drawText(list, fonts().body, x + dp(8), y, hovered || open ? colors::title : colors::text,
                 name);
        const Rect area{x, rect.y0, x + width, rect.y1};
        if (pressed || (anyOpen && !open && area.holds(ImGui::GetIO().MousePos)))
            ImGui::OpenPopup(name);
        showMenu(app, name, {x, rect.y1 - dp(4)});
        x += width;
    }
    constexpr float kFindWidth = 192, kFindIcon = 28;  // dp
    float find = kFindWidth;
    if (app.page != Page::kWelcome) {
        struct Tab {
            Page page;
            const char *name, *icon;
        };
        constexpr Tab kTabs[] = {{Page::kScene, "Scene", icons::local},
                                 {Page::kPaint, "Paint", icons::brush},
                                 {Page::kFlame, "Flame", icons::flame},
                                 {Page::kOutput, "Export", icons::exportTo}};
        const float width = dp(92);
        const float tabs = width * float(std::size(kTabs));
        float at = std::max(std::floor(rect.midX() - tabs * 0.5f), std::ceil(x + dp(8)));
        for (const Tab& tab : kTabs) {
            const ImVec2 low(at, rect.y0 + dp(4)), high(at + width - dp(2), rect.y1);
            bool hovered = false;
            ImGui::PushID("page");
            if (hit(tab.name, low, high - low, &hovered)) app.page = tab.page;
            ImGui::PopID();
            const bool here = tab.page == app.page;
            if (here)
                list->AddRectFilled(low, high, colors::header, dp(6), ImDrawFlags_RoundCornersTop);
            const ImU32 color = here ? colors::title : hovered ? colors::text : colors::dim;
            const float textWidth = textSize(fonts().semi, tab.name).x;
            const float start = (low.x + high.x) * 0.5f - (textWidth + dp(22)) * 0.5f;
            drawIcon(list, fonts().icon17, {start + dp(8), y}, here ? colors::accent : color,
                     tab.icon);
            drawText(list, fonts().semi, start + dp(22), y, color, tab.name);
            at += width;
        }
        const std::string name = sceneName(app);
        // If space is short, the scene's name stays and the search shrinks to its icon.
        if (rect.x1 - dp(kFindWidth + 18) - (at + dp(20)) < dp(60)) find = kFindIcon;
        const float room = rect.x1 - dp(find + 18) - (at + dp(20));
        drawTextFit(list, fonts().body, at + dp(20), y, room, colors::text, name.c_str());
        if (fwedit::unsaved(app.document)) {
            const float end = at + dp(20) + std::min(room, textSize(fonts().body, name.c_str()).x);
            list->AddCircleFilled({end + dp(11), y}, dp(3), colors::warn, 16);
        }
    }
    const ImVec2 low(rect.x1 - dp(8 + find), rect.y0 + dp(6)),
        high(rect.x1 - dp(8), rect.y1 - dp(6));
    bool hovered = false;
    if (hit("find", low, high - low, &hovered)) findAction(app, "Find anything")->run();
    drawBox(list, low, high, colors::well, 4, hovered ? colors::edge : colors::line);
    drawIcon(list, fonts().icon17, {low.x + dp(14), y}, colors::dim, icons::search);
    if (find == kFindIcon) {
        tip("Find anything", keysOf(app, "Find anything"));
    } else {
        drawText(list, fonts().body, low.x + dp(28), y, colors::dim, "Find anything");
        drawTextRight(list, fonts().small, high.x - dp(8), y, colors::dim,
                      keysOf(app, "Find anything"));
    }
    endPanel();
}

void showStatus(App& app, const Rect& rect, std::initializer_list<Hint> hints) {
    ImDrawList* list = beginPanel("##status", rect, colors::gap);
    const float y = rect.midY();
    float x = rect.x0 + dp(10);
    const float stop = rect.x0 + rect.width() * 0.57f;
    for (const Hint& hint : hints) {
        const float width = textSize(fonts().smallSemi, hint.keys).x + dp(5) +
                            textSize(fonts().small, hint.what).x + dp(16);
        if (x + width > stop) break;
        x += drawText(list, fonts().smallSemi, x, y, colors::text, hint.keys) + dp(5);
        x += drawText(list, fonts().small, x, y, colors::dim, hint.what) + dp(16);
    }
    float right = rect.x1 - dp(10);
    auto word = [&](ImFont* font, ImU32 color, const char* text) {
        drawTextRight(list, font, right, y, color, text);
        right -= textSize(font, text).x + dp(14);
    };
    char text[64];
    const bool tells = !app.result.empty() && app.now - app.resultTime < 20;
    const bool brief = tells && rect.width() < dp(1100);  // leaves room for the last message
    if (!brief) word(fonts().small, colors::dim, app.device.c_str());
    if (app.framesPerSecond > 0) {
        std::snprintf(text, sizeof text, "%.0f fps", double(app.framesPerSecond));
        word(fonts().small, colors::dim, text);
    }
    if (!app.costs.empty() && app.page != Page::kWelcome) {
        std::snprintf(text, sizeof text, "GPU %.1f ms", double(app.costs.back()));
        word(fonts().smallSemi, colors::title, text);
    }
    if (!app.costs.empty() && app.page != Page::kWelcome && !brief) {
        const size_t count = std::min<size_t>(app.costs.size(), 18);
        float most = 1;
        for (size_t i = app.costs.size() - count; i < app.costs.size(); ++i)
            most = std::max(most, app.costs[i]);
        float bar = right - dp(4) * float(count) + dp(5);
        for (size_t i = app.costs.size() - count; i < app.costs.size(); ++i) {
            const float height = std::max(dp(2), dp(12) * app.costs[i] / most);
            list->AddRectFilled({bar, rect.y1 - dp(6) - height}, {bar + dp(3), rect.y1 - dp(6)},
                                colors::off);
            bar += dp(4);
        }
        right -= dp(4) * float(count) + dp(8);
    }
    if (tells) {
        const float from = rect.x0 + rect.width() * 0.58f;
        drawIcon(list, fonts().icon14, {from, y}, colors::ok, icons::checkOn);
        drawTextFit(list, fonts().small, from + dp(12), y, right - from - dp(16), colors::text,
                    app.result.c_str());
    }
    endPanel();
}

void showTransport(App& app, ImDrawList* list, const Rect& rect, bool marks) {
    const float y = rect.y0 + dp(3);
    float x = rect.x0 + dp(8);
    auto act = [&](const char* name, const char* icon, float width, bool active = false) {
        const Action* action = findAction(app, name);
        ToolLook look{.icon = icon};
        look.active = active;
        if (toolButton(name, {x, y}, look, action->name, action->keys.c_str())) action->run();
        x += dp(width);
    };
    act("To start", icons::toStart, 28);
    act("Back one frame", icons::stepBack, 30);
    bool hovered = false;
    if (hit("play", {x, y}, dp(36, 28), &hovered)) app.playing = !app.playing;
    drawBox(list, {x, y}, {x + dp(36), y + dp(28)},
            app.playing ? colors::accentFill
            : hovered   ? colors::press
                        : colors::control);
    drawIcon(list, fonts().icon20, {x + dp(18), y + dp(14)}, colors::white,
             app.playing ? icons::pause : icons::play);
    tip("Play or pause", keysOf(app, "Play, pause"));
    x += dp(38);
    act("On one frame", icons::stepFwd, 28);
    act("To end", icons::toEnd, 34);
    const std::string now = clockText(app.live.time());
    const std::string all = "of " + clockText(double(app.document.scene.settings.duration));
    drawText(list, fonts().heading, x, y + dp(14), colors::title, now.c_str());
    x += textSize(fonts().heading, "00:00.0").x + dp(4);
    x += drawText(list, fonts().body, x, y + dp(15), colors::dim, all.c_str()) + dp(16);
    act("Loop", icons::loop, 32, app.looping);
    constexpr const char* kSpeeds[] = {"¼×", "½×", "1×", "2×", "4×"};
    constexpr float kFactors[] = {0.25f, 0.5f, 1, 2, 4};
    int chosen = 2;
    for (int i = 0; i < 5; ++i)
        if (kFactors[i] == app.speed) chosen = i;
    if (choice("speed", {x, y + dp(2)}, dp(64, 24), kSpeeds, chosen)) app.speed = kFactors[chosen];
    tip("Speed of playing");
    x += dp(76);
    if (app.live.isSeeking() || app.live.isPreparing()) {
        float share = 0;
        const std::string stage = app.live.isPreparing() ? app.live.stage(share) : "Running on";
        drawText(list, fonts().small, x, y + dp(14), colors::dim,
                 stage.empty() ? "Preparing" : stage.c_str());
    }
    if (!marks) return;
    const Action* event = findAction(app, "Add event");
    const ToolLook look{.icon = icons::event, .label = "Event"};
    ToolLook beside{.icon = icons::compare, .label = "Compare"};
    beside.active = app.live.isComparing();
    float right = rect.x1 - dp(8) - toolButtonWidth(beside);
    if (toolButton("compare", {right, y}, beside,
                   beside.active ? "Back to one picture" : "Keep this beside what changes",
                   keysOf(app, "Compare")))
        findAction(app, "Compare")->run();
    right -= toolButtonWidth(look) + dp(4);
    if (toolButton("event", {right, y}, look, "Add an event here", event->keys.c_str()))
        event->run();
}

}  // namespace fwapp
