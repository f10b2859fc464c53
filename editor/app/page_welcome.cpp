// The first page: new, open, recent files, crash recovery, and scenes to start from.
#include <algorithm>
#include <cstdlib>

#include "app/app.h"
#include "app/built_in.h"
#include "shell/icons.h"

namespace fwapp {

using namespace fwui;
namespace fs = std::filesystem;

namespace {

std::string ago(const fs::path& file) {
    std::error_code failed;
    const auto written = fs::last_write_time(file, failed);
    if (failed) return "not found";
    const double seconds =
        std::chrono::duration<double>(fs::file_time_type::clock::now() - written).count();
    if (seconds < 90) return "just now";
    if (seconds < 5400) return std::to_string(int(seconds / 60)) + " min ago";
    if (seconds < 36 * 3600) return std::to_string(int(seconds / 3600)) + " h ago";
    return std::to_string(int(seconds / 86400)) + " days ago";
}

float showRecovery(App& app, ImDrawList* list, float x, float y, float width) {
    // Checks the folder once per second.
    static Recovery found;
    static bool any = false;
    static double lookedAt = -1e9;
    if (app.now - lookedAt > 1) {
        any = findRecovery(found);
        lookedAt = app.now;
    }
    if (!any) return y;
    const ImVec2 low(x, y), high(x + width, y + dp(88));
    drawBox(list, low, high, mix(colors::header, colors::warn, 0.08f), 8,
            mix(colors::header, colors::warn, 0.5f));
    drawIcon(list, fonts().icon20, low + dp(20, 18), colors::warn, icons::history);
    drawText(list, fonts().semi, x + dp(34), y + dp(18), colors::title, "Unsaved work found");
    const std::string what =
        (found.original.empty() ? "Untitled" : found.original.stem().string()) + ", " +
        ago(found.file);
    drawTextFit(list, fonts().small, x + dp(34), y + dp(38), width - dp(44), colors::text,
                what.c_str());
    if (button("recover", {x + dp(34), y + dp(54)}, dp(84, 24), "Recover", ButtonKind::kPrimary)) {
        recover(app, found);
        lookedAt = -1e9;
    }
    if (button("discard", {x + dp(126), y + dp(54)}, dp(76, 24), "Discard", ButtonKind::kGhost)) {
        dropRecovery(found);
        lookedAt = -1e9;
    }
    return high.y + dp(20);
}

void showLeft(App& app, Rect rect) {
    ImDrawList* list = beginPanel("##start", rect, colors::header);
    const float x = rect.x0 + dp(36), width = rect.width() - dp(72);
    float y = rect.y0 + dp(58);
    drawIcon(list, fonts().icon34, {x + dp(13), y}, colors::heat, icons::flame);
    drawText(list, fonts().title, x + dp(35), y, colors::title, "Flamewright");
    y += dp(42);
    auto act = [&](const char* name) { findAction(app, name)->run(); };
    if (button("new", {x, y}, {width, dp(34)}, "New scene", ButtonKind::kPrimary, icons::newFile,
               "Ctrl+N"))
        act("New scene");
    y += dp(42);
    const float half = std::floor((width - dp(6)) * 0.5f);
    if (button("open", {x, y}, {half, dp(34)}, "Open", ButtonKind::kPlain, icons::open))
        act("Open…");
    if (button("import", {x + half + dp(6), y}, {half, dp(34)}, "Import mesh", ButtonKind::kPlain,
               icons::importFrom))
        act("Import mesh…");
    y += dp(52);
    y = showRecovery(app, list, x, y, width);

    drawText(list, fonts().semi, x, y + dp(8), colors::title, "Recent");
    y += dp(26);
    if (app.user.recent.empty())
        drawText(list, fonts().small, x, y + dp(8), colors::dim, "Scenes you open appear here");
    for (size_t i = 0; i < app.user.recent.size(); ++i) {
        if (y + dp(42) > rect.y1) break;
        const fs::path file = app.user.recent[i];
        const std::string when = ago(file);
        const bool there = when != "not found";
        ImGui::PushID(int(i));
        bool hovered = false;
        const bool pressed =
            hit("recent", {x - dp(8), y - dp(2)}, {width + dp(16), dp(40)}, &hovered);
        ImGui::PopID();
        if (hovered)
            drawBox(list, {x - dp(8), y - dp(2)}, {x + width + dp(8), y + dp(38)}, colors::control);
        const float whenWidth = textSize(fonts().small, when.c_str()).x;
        drawTextFit(list, fonts().body, x, y + dp(9), width - whenWidth - dp(10),
                    there ? colors::title : colors::dim, file.filename().c_str());
        drawTextRight(list, fonts().small, x + width, y + dp(9), there ? colors::dim : colors::warn,
                      when.c_str());
        drawTextFit(list, fonts().small, x, y + dp(27), width, colors::dim,
                    abbreviateHome(file.parent_path()).c_str());
        if (pressed && there) {
            openScene(app, file);
            break;
        }
        if (pressed) {
            std::erase(app.user.recent, file);
            saveUserState(app.user);
            break;
        }
        y += dp(44);
    }
    endPanel();
}

void showCards(App& app, Rect rect) {
    ImDrawList* list = beginPanel("##cards", rect, colors::panel, true);
    const float x0 = rect.x0 + dp(36);
    float y = rect.y0 + dp(40);
    drawText(list, fonts().heading, x0, y, colors::title, "Start from a scene");
    drawText(list, fonts().body, x0, y + dp(23), colors::dim,
             "Each opens as a copy. Nothing you change here touches the original.");
    y += dp(50);
    const float gap = dp(16);
    const int columns = std::clamp(int((rect.width() - dp(72)) / dp(220)), 1, 4);
    const float width =
        std::floor((rect.width() - dp(72) - gap * float(columns - 1)) / float(columns));
    const float picture = std::floor(width / kCardAspect), height = picture + dp(60);
    const auto cards = builtIns();
    for (size_t i = 0; i < cards.size(); ++i) {
        const BuiltIn& card = cards[i];
        const ImVec2 low(x0 + float(int(i) % columns) * (width + gap),
                         y + float(int(i) / columns) * (height + gap));
        const ImVec2 high = low + ImVec2(width, height);
        ImGui::PushID(int(i));
        bool hovered = false;
        if (hit("card", low, high - low, &hovered)) openBuiltIn(app, int(i));
        ImGui::PopID();
        drawBox(list, low, high, hovered ? colors::control : colors::raised, 8);
        const ImVec2 end(high.x, low.y + picture);
        list->AddRectFilled(low, end, colors::well, dp(8), ImDrawFlags_RoundCornersTop);
        if (void* texture = app.cards.texture(i))
            list->AddImageRounded(texture, low, end, {0, 0}, {1, 1}, colors::white, dp(8),
                                  ImDrawFlags_RoundCornersTop);
        else
            drawIcon(list, fonts().icon34, {(low.x + end.x) * 0.5f, (low.y + end.y) * 0.5f},
                     faded(colors::heat, 0.8f), card.icon);
        drawText(list, fonts().semi, low.x + dp(12), end.y + dp(20), colors::title, card.name);
        drawTextFit(list, fonts().small, low.x + dp(12), end.y + dp(39), width - dp(24),
                    colors::dim, card.about);
        if (hovered) list->AddRect(low, high, colors::accent, dp(8), 0, dp(2));
    }
    endPanel();
}

}  // namespace

void showWelcome(App& app, Rect rect) {
    if (app.cardsLoading && app.now > 0.05) app.cardsLoading = app.cards.loadNext();
    showTopBar(app, rect.cutTop(dp(metrics::topBar)));
    showStatus(app, rect.cutBottom(dp(metrics::status)),
               {{"Ctrl+O", "open"}, {"Ctrl+N", "new scene"}, {"F1", "all keys"}});
    showLeft(app, rect.cutLeft(dp(330)));
    showCards(app, rect);
}

}  // namespace fwapp
