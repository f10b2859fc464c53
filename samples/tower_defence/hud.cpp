#include "hud.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "shell/draw.h"
#include "shell/icons.h"
#include "shell/theme.h"

namespace tower {

using fwui::dp;
using fwui::fonts;
using fwui::hex;
using fwui::Rect;
using game::TowerKind;

namespace {

// Dark timber, thin brass, parchment ink; one accent per tower.
constexpr ImU32 kTimber = hex(0x1B130E, 222), kTimberLit = hex(0x33241A, 235),
                kBrass = hex(0x9E7847);
constexpr ImU32 kInk = hex(0xF5E6C7), kDim = hex(0xB39E85), kGold = hex(0xFFC74D),
                kRed = hex(0xE64024);
constexpr ImU32 kGreen = hex(0xA9CC52), kOrange = hex(0xFF8026), kTrack = hex(0x0F0A08),
                kUnlit = hex(0x4D4035);
constexpr ImU32 kAccents[game::kTowerKinds] = {kBrass, hex(0xF25C24), hex(0xE6A333), hex(0x4D9EF2),
                                               hex(0x6BD6C2)};
constexpr const char* kIcons[game::kTowerKinds] = {"", fwui::icons::flame, fwui::icons::brand,
                                                   fwui::icons::water, fwui::icons::wind};
constexpr const char* kNames[game::kTowerKinds] = {"", "FLAME", "MORTAR", "WATER", "WIND"};

// Minimum size, in dp(1), at which the panels fit side by side.
constexpr float kLayoutWidth = 920, kLayoutHeight = 290;

std::string text(const char* format, ...) __attribute__((format(printf, 1, 2)));
std::string text(const char* format, ...) {
    char out[160];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(out, sizeof out, format, arguments);
    va_end(arguments);
    return out;
}

ImVec2 im(glm::vec2 v) { return {v.x, v.y}; }
glm::vec3 onGround(village::Vec2 p, float above) {
    return {p.x, village::groundHeight(p) + above, p.y};
}

// Draws one frame and collects its requests.
struct Board {
    ImDrawList* list;
    const Lens& lens;
    const Battlefield& field;
    const Siege& siege;
    const FireNumbers& fires;
    Player& player;
    const game::State& state = siege.state();
    HudRequests requests{};
    bool overPanel = false;  // the mouse is over a panel

    void drawPanel(const Rect& r, ImU32 fill = kTimber, ImU32 rim = kBrass) {
        fwui::drawBox(list, r.low(), r.high(), fill, 7, rim);
        overPanel |= r.holds(ImGui::GetIO().MousePos);
    }
    bool pressed(const Rect& r, const char* name) {
        ImGui::SetCursorScreenPos(r.low());
        return ImGui::InvisibleButton(name, {r.width(), r.height()});
    }
    void drawText(ImFont* font, float x, float y, ImU32 color, const std::string& words) {
        fwui::drawText(list, font, x, y, color, words.c_str());
    }
    void drawBar(float x0, float x1, float y, float thick, float share, ImU32 color) {
        list->AddRectFilled({x0 - dp(1), y - thick - dp(1)}, {x1 + dp(1), y + thick + dp(1)},
                            kTrack, thick);
        if (share > 0)
            list->AddRectFilled({x0, y - thick},
                                {x0 + (x1 - x0) * std::min(share, 1.0f), y + thick}, color, thick);
    }
    void order(game::Order::Type type) {
        requests.orders.push_back({type, player.plot, player.chosen});
    }

    void drawRing(village::Vec2 centre, float radius, ImU32 color, float thick, bool dashed);
    void showPlots();
    void drawRanges();
    void drawHealthBars();
    void drawWave();
    void drawVillageBar();
    void drawHouse(float x, float y, size_t house);
    void drawPurse();
    void showTowerCards();
    void showSpeeds();
    void drawFireNumbers();
    void drawLedger();
    void showPlotMenu();
    void drawMessage(double time);
    void drawOutcome();
};

void Board::drawRing(village::Vec2 centre, float radius, ImU32 color, float thick, bool dashed) {
    constexpr int kPieces = 72;
    auto at = [&](int i) {
        const float a = 2 * village::kPi * float(i) / kPieces;
        return im(lens.project(
            onGround({centre.x + radius * std::cos(a), centre.y + radius * std::sin(a)}, 0.1f)));
    };
    for (int i = 0; i < kPieces; ++i)
        if (!dashed || i % 3 != 2) list->AddLine(at(i), at(i + 1), color, thick);
}

// Free plots glow while a tower is chosen. A click takes the one under the mouse.
void Board::showPlots() {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    int32_t under = -1;
    if (!overPanel) {
        const glm::vec3 at = lens.ground({mouse.x, mouse.y}, 0.6f);
        for (size_t i = 0; i < game::kPlots; ++i) {
            const village::Vec2 p = metres(field.ground.plots[i]);
            constexpr float kTaken = 2.0f;  // m from its centre
            if (village::length(village::Vec2{at.x - p.x, at.z - p.y}) < kTaken) under = int32_t(i);
        }
    }
    for (size_t i = 0; i < game::kPlots; ++i) {
        const bool free = state.towers[i].kind == TowerKind::kNone;
        const bool lit = int32_t(i) == under || int32_t(i) == player.plot;
        if (free && (player.chosen != TowerKind::kNone || lit))
            drawRing(metres(field.ground.plots[i]), 1.9f, lit ? kGold : fwui::faded(kGold, 0.55f),
                     dp(lit ? 2.5f : 1.5f), false);
        else if (lit)
            drawRing(metres(field.ground.plots[i]), 2.0f, kAccents[size_t(state.towers[i].kind)],
                     dp(2), false);
    }
    if (under >= 0 && player.chosen != TowerKind::kNone &&
        state.towers[size_t(under)].kind == TowerKind::kNone)
        drawRing(metres(field.ground.plots[size_t(under)]),
                 0.001f * float(game::kTowers[size_t(player.chosen)].range[0]),
                 kAccents[size_t(player.chosen)], dp(1.6f), true);
    if (!ImGui::IsMouseReleased(0) || overPanel || ImGui::IsAnyItemHovered() ||
        ImGui::GetIO().MouseDragMaxDistanceSqr[0] > 16)
        return;
    player.plot = under;
    if (under < 0 || player.chosen == TowerKind::kNone) return;
    if (state.towers[size_t(under)].kind == TowerKind::kNone) {
        order(game::Order::Type::kPlace);
        player.chosen = TowerKind::kNone;
    }
}

void Board::drawRanges() {
    if (player.plot < 0) return;
    const game::Tower& tower = state.towers[size_t(player.plot)];
    if (tower.kind == TowerKind::kNone) return;
    const game::TowerRule& rule = game::kTowers[size_t(tower.kind)];
    drawRing(metres(field.ground.plots[size_t(player.plot)]),
             0.001f * float(rule.range[size_t(tower.level)]), kAccents[size_t(tower.kind)],
             dp(1.8f), true);
}

// Shows the unburnt share of an enemy, relative to the share at which it falls.
void Board::drawHealthBars() {
    constexpr float kHeads[game::kEnemyKinds] = {3.2f, 2.8f, 3.5f, 6.4f};
    for (size_t i = 0; i < game::kEnemySlots; ++i) {
        const game::Enemy& enemy = state.enemies[i];
        if (enemy.phase != game::Phase::kMarches) continue;
        const auto kind = size_t(game::kindOf(i));
        const glm::vec2 p =
            lens.project(onGround(metres(game::placeOf(field.ground, enemy)), kHeads[kind]));
        const float share = 1 - float(enemy.burnt) / float(game::kEnemies[kind].falls);
        const float half = dp(game::kindOf(i) == game::EnemyKind::kWickerGiant ? 22.0f : 10.0f);
        drawBar(p.x - half, p.x + half, p.y, dp(1.6f), share,
                share > 0.6f   ? kGreen
                : share > 0.3f ? kGold
                               : kRed);
    }
}

void Board::drawWave() {
    const Rect r{dp(12), dp(10), dp(232), dp(60)};
    drawPanel(r);
    const auto waves = int32_t(game::kWaves.size());
    drawText(fonts().heading, r.x0 + dp(14), r.y0 + dp(17), kInk,
             text("WAVE %d/%d", std::min(state.wave + 1, waves), waves));
    const std::string next = state.marched > 0
                                 ? std::string("they come")
                                 : text("next in 0:%02d", state.untilWave / game::kTicksPerSecond);
    fwui::drawTextRight(list, fonts().small, r.x1 - dp(12), r.y0 + dp(18), kDim, next.c_str());
    const float apart = (r.width() - dp(24)) / float(waves);
    for (int32_t i = 0; i < waves; ++i) {
        const float x = r.x0 + dp(14) + apart * float(i);
        const bool comes = i == state.wave && state.marched > 0;
        list->AddRectFilled({x, r.y0 + dp(34)}, {x + apart - dp(5), r.y0 + dp(40)},
                            i < state.wave ? kGold
                            : comes        ? kRed
                                           : kUnlit,
                            dp(3));
    }
}

void Board::drawVillageBar() {
    const float middle = lens.size.x / 2;
    const Rect r{middle - dp(140), dp(10), middle + dp(140), dp(61)};
    drawPanel(r);
    drawText(fonts().smallSemi, r.x0 + dp(14), r.y0 + dp(13), kDim, "VILLAGE");
    const int32_t stands = game::standing(state);
    fwui::drawTextRight(list, fonts().smallSemi, r.x1 - dp(14), r.y0 + dp(13), kInk,
                        text("%d %%   mill %d", (stands + 5) / 10, state.lives).c_str());
    drawBar(r.x0 + dp(14), r.x1 - dp(14), r.y0 + dp(27), dp(3.5f), float(stands) / 1000,
            stands > 700   ? kGreen
            : stands > 400 ? kOrange
                           : kRed);
    // Each house: its unburnt share; lit from inside after flashover; without a roof once broken.
    const float apart = (r.width() - dp(28)) / float(game::kHouses);
    for (size_t house = 0; house < game::kHouses; ++house)
        drawHouse(r.x0 + dp(14) + apart * (float(house) + 0.5f), r.y0 + dp(41), house);
}

void Board::drawHouse(float x, float y, size_t house) {
    const int32_t burnt = state.houseBurnt[house];
    const ImU32 walls = burnt >= game::kHouseIsLost ? kUnlit : burnt > 0 ? kOrange : kGreen;
    const float half = dp(5), low = y + dp(6), eaves = y - dp(0.5f);
    list->AddRectFilled({x - half, eaves}, {x + half, low}, walls);
    if (!siege.broken(house))
        list->AddTriangleFilled({x - half - dp(2), eaves}, {x, y - dp(6)},
                                {x + half + dp(2), eaves}, walls);
    if (state.flashed[house]) list->AddCircleFilled({x, y + dp(3)}, dp(2.5f), kRed);
}

void Board::drawPurse() {
    const Rect r{lens.size.x - dp(232), dp(10), lens.size.x - dp(12), dp(60)};
    drawPanel(r);
    list->AddCircleFilled({r.x0 + dp(22), r.y0 + dp(17)}, dp(8), kGold);
    list->AddCircle({r.x0 + dp(22), r.y0 + dp(17)}, dp(5), hex(0xB57E20), 0, dp(1.5f));
    drawText(fonts().heading, r.x0 + dp(38), r.y0 + dp(17), kInk, text("%d", state.coins));
    drawText(fonts().small, r.x0 + dp(14), r.y0 + dp(37), kDim,
             text("score %d", game::score(state)));
    const village::Vec2 wind = metres(state.wind);
    const float speed = village::length(wind);
    const ImVec2 c{r.x1 - dp(86), r.midY()};
    list->AddCircle(c, dp(18), kBrass, 0, dp(1.2f));
    if (speed > 0.1f) {
        const ImVec2 d{wind.x / speed * dp(14), wind.y / speed * dp(14)},
            n{-d.y * 0.45f, d.x * 0.45f};
        list->AddLine({c.x - d.x, c.y - d.y}, c, kAccents[4], dp(2));
        list->AddTriangleFilled({c.x + d.x, c.y + d.y}, {c.x + n.x, c.y + n.y},
                                {c.x - n.x, c.y - n.y}, kAccents[4]);
    }
    drawText(fonts().small, r.x1 - dp(58), r.y0 + dp(16), kDim, "WIND");
    drawText(fonts().semi, r.x1 - dp(58), r.y0 + dp(34), kInk, text("%.1f m/s", double(speed)));
}

void Board::showTowerCards() {
    constexpr float kWide = 82, kHigh = 74, kApart = 88;
    for (size_t kind = 1; kind < game::kTowerKinds; ++kind) {
        const bool chosen = player.chosen == TowerKind(kind);
        const int32_t price = game::kTowers[kind].price[0];
        const float x = lens.size.x / 2 + dp(kApart * (float(kind) - 3)),
                    y = lens.size.y - dp(kHigh + 10 + (chosen ? 6 : 0));
        const Rect r{x, y, x + dp(kWide), y + dp(kHigh)};
        drawPanel(r, chosen ? kTimberLit : kTimber, chosen ? kAccents[kind] : kBrass);
        drawText(fonts().small, r.x0 + dp(7), r.y0 + dp(11), kDim, text("%d", int(kind)));
        const bool dear = price > state.coins;
        fwui::drawIcon(list, fonts().icon34, {r.midX(), r.y0 + dp(24)},
                       dear ? fwui::faded(kAccents[kind], 0.4f) : kAccents[kind], kIcons[kind]);
        fwui::drawTextCentred(list, fonts().smallSemi, r.midX(), r.y0 + dp(49), kInk, kNames[kind]);
        fwui::drawTextCentred(list, fonts().small, r.midX(), r.y0 + dp(64), dear ? kRed : kGold,
                              text("%d", price).c_str());
        if (pressed(r, kNames[kind])) player.chosen = chosen ? TowerKind::kNone : TowerKind(kind);
    }
}

void Board::showSpeeds() {
    const float y = lens.size.y - dp(62), right = lens.size.x - dp(12);
    const Rect r{right - dp(270), y, right, y + dp(52)};
    drawPanel(r);
    auto icon = [&](float x, const char* glyph, const char* name, bool lit) {
        const Rect b{r.x0 + dp(x), r.y0 + dp(8), r.x0 + dp(x + 36), r.y1 - dp(8)};
        fwui::drawIcon(list, fonts().icon20, {b.midX(), b.midY()}, lit ? kGold : kDim, glyph);
        return pressed(b, name);
    };
    requests.rewind |= icon(6, fwui::icons::history, "rewind", false);
    requests.pause |=
        icon(42, player.paused ? fwui::icons::play : fwui::icons::pause, "pause", player.paused);
    requests.faster |= icon(78, fwui::icons::toEnd, "faster", player.speed > 1);
    drawText(fonts().semi, r.x0 + dp(114), r.midY(), player.speed > 1 ? kGold : kDim,
             text("%dx", player.speed));
    const Rect call{r.x1 - dp(122), r.y0 + dp(9), r.x1 - dp(10), r.y1 - dp(9)};
    const bool may = state.marched == 0 && state.outcome == game::Outcome::kPlaying;
    fwui::drawBox(list, call.low(), call.high(), may ? hex(0x6B1A0F) : hex(0x33241A), 6,
                  may ? kRed : kBrass);
    fwui::drawTextCentred(list, fonts().smallSemi, call.midX(), call.midY(), may ? kInk : kDim,
                          "CALL WAVE");
    if (pressed(call, "call")) order(game::Order::Type::kCallWave);
}

void Board::drawFireNumbers() {
    const float y = lens.size.y - dp(86);
    const Rect r{dp(12), y, dp(202), y + dp(76)};
    drawPanel(r);
    fwui::drawIcon(list, fonts().icon17, {r.x0 + dp(18), r.y0 + dp(16)}, kOrange,
                   fwui::icons::flame);
    drawText(fonts().smallSemi, r.x0 + dp(32), r.y0 + dp(16), kInk,
             text("%u burn, %u caught", fires.burning, fires.caught));
    drawText(
        fonts().small, r.x0 + dp(14), r.y0 + dp(37), kDim,
        text("%.1f MW over %.0f m\xc2\xb2", double(fires.megawatts), double(fires.squareMetres)));
    drawText(fonts().small, r.x0 + dp(14), r.y0 + dp(57), kDim,
             text("%d felled, %d s", state.felled, state.tick / game::kTicksPerSecond));
}

// Shows where the fuel's energy went. The sum is computed from the displayed values.
void Board::drawLedger() {
    if (!player.showsLedger) return;
    const FwEnergyLedger& ledger = fires.ledger;
    const bool any = ledger.objects > 0;
    const Rect r{dp(12), dp(70), dp(262), any ? dp(204) : dp(128)};
    drawPanel(r);
    drawText(fonts().smallSemi, r.x0 + dp(14), r.y0 + dp(15), kInk, "ENERGY");
    if (!any) {
        drawText(fonts().small, r.x0 + dp(14), r.y0 + dp(38), kDim,
                 "no object has an energy ledger");
        return;
    }
    const auto apart =
        int64_t(ledger.fuel) - int64_t(ledger.unburnt + ledger.radiated + ledger.convected);
    fwui::drawTextRight(list, fonts().small, r.x1 - dp(14), r.y0 + dp(15),
                        apart == 0 ? kGreen : kRed,
                        text("closes to %.6g J", std::ldexp(double(apart), -20)).c_str());
    const struct {
        const char* name;
        uint64_t units;
        ImU32 color;
    } rows[] = {{"in fuel", ledger.unburnt, kGreen},
                {"radiated", ledger.radiated, kOrange},
                {"in hot gas", ledger.convected, kRed}};
    float y = r.y0 + dp(38);
    for (const auto& row : rows) {
        drawText(fonts().small, r.x0 + dp(14), y, kDim, row.name);
        fwui::drawTextRight(list, fonts().small, r.x1 - dp(14), y, kInk,
                            text("%.3f MJ", 1e-6 * std::ldexp(double(row.units), -20)).c_str());
        const double share = ledger.fuel ? double(row.units) / double(ledger.fuel) : 0;
        drawBar(r.x0 + dp(14), r.x1 - dp(14), y + dp(12), dp(2), float(share), row.color);
        y += dp(26);
    }
    drawText(fonts().small, r.x0 + dp(14), y, kDim,
             text("%u objects have an energy ledger", ledger.objects));
}

// Describes the selected tower and offers its actions.
void Board::showPlotMenu() {
    if (player.plot < 0) return;
    const game::Tower& tower = state.towers[size_t(player.plot)];
    if (tower.kind == TowerKind::kNone) return;
    const glm::vec2 p =
        lens.project(onGround(metres(field.ground.plots[size_t(player.plot)]), 4.5f));
    const float x = std::clamp(p.x - dp(86), dp(12), lens.size.x - dp(184));
    const float y = std::clamp(p.y - dp(90), dp(70), lens.size.y - dp(190));
    const Rect r{x, y, x + dp(172), y + dp(78)};
    drawPanel(r, kTimber, kAccents[size_t(tower.kind)]);
    drawText(fonts().smallSemi, r.x0 + dp(12), r.y0 + dp(15), kInk,
             text("%s  %d", kNames[size_t(tower.kind)], tower.level + 1));
    for (int32_t i = 0; i < game::kLevels; ++i)
        list->AddCircleFilled(
            {r.x1 - dp(16) - dp(13) * float(game::kLevels - 1 - i), r.y0 + dp(15)}, dp(4),
            i <= tower.level ? kGold : kUnlit);
    auto choice = [&](float x0, const char* name, const std::string& words, bool may) {
        const Rect b{r.x0 + dp(x0), r.y0 + dp(32), r.x0 + dp(x0 + 76), r.y1 - dp(8)};
        fwui::drawBox(list, b.low(), b.high(), kTimberLit, 5, kBrass);
        fwui::drawTextCentred(list, fonts().smallSemi, b.midX(), b.midY() - dp(8),
                              may ? kInk : kDim, name);
        fwui::drawTextCentred(list, fonts().small, b.midX(), b.midY() + dp(8), may ? kGold : kRed,
                              words.c_str());
        return pressed(b, name);
    };
    const int32_t price = game::priceOf(tower);
    if (choice(8, "Upgrade", price ? text("%d", price) : std::string("at its best"),
               price && price <= state.coins))
        order(game::Order::Type::kUpgrade);
    if (choice(88, "Sell", text("+%d", game::refundOf(tower)), true))
        order(game::Order::Type::kSell);
}

void Board::drawMessage(double time) {
    constexpr double kFor = 3;  // s
    if (!player.paused && time - player.messageTime >= kFor) return;
    ImFont* font = player.paused ? fonts().title : fonts().heading;
    const char* words = player.paused ? "paused" : player.said.c_str();
    const ImVec2 half{fwui::textSize(font, words).x / 2 + dp(18), dp(player.paused ? 26 : 18)};
    const ImVec2 at{lens.size.x / 2, dp(player.paused ? 96 : 80)};
    drawPanel({at.x - half.x, at.y - half.y, at.x + half.x, at.y + half.y});
    fwui::drawTextCentred(list, font, at.x, at.y, kInk, words);
}

void Board::drawOutcome() {
    if (state.outcome == game::Outcome::kPlaying) return;
    const ImVec2 c{lens.size.x / 2, lens.size.y / 2};
    const Rect r{c.x - dp(190), c.y - dp(70), c.x + dp(190), c.y + dp(70)};
    drawPanel(r);
    const bool won = state.outcome == game::Outcome::kWon;
    fwui::drawTextCentred(list, fonts().title, c.x, c.y - dp(32), won ? kGold : kRed,
                          won ? "The village stands" : "The mill is lost");
    fwui::drawTextCentred(list, fonts().heading, c.x, c.y + dp(8), kInk,
                          text("score %d", game::score(state)).c_str());
    fwui::drawTextCentred(list, fonts().small, c.x, c.y + dp(38), kDim,
                          text("%d felled, %d %% of the village, %d lives", state.felled,
                               game::standing(state) / 10, state.lives)
                              .c_str());
}

void handleKeys(const std::vector<int>& pressed, Board& board) {
    Player& player = board.player;
    for (const int key : pressed) {
        if (key >= '1' && key < '1' + int(game::kTowerKinds) - 1) {
            const auto kind = TowerKind(key - '0');
            player.chosen = player.chosen == kind ? TowerKind::kNone : kind;
        }
        board.requests.pause ^= key == ' ';
        board.requests.faster ^= key == 'F';
        board.requests.rewind |= key == 'R';
        board.requests.light ^= key == 'N';
        player.showsLedger ^= key == 'E';
        constexpr int kEnter = 257;  // GLFW's code
        if (key == kEnter) board.order(game::Order::Type::kCallWave);
        if (key == 'U' && player.plot >= 0) board.order(game::Order::Type::kUpgrade);
        if (key == 'X' && player.plot >= 0) board.order(game::Order::Type::kSell);
    }
}

}  // namespace

Hud::Hud(const sample::VulkanHost& host, sample::Stage& stage) : stage_(stage) {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    renderer_ =
        std::make_unique<fwui::UiRenderer>(host, stage.outputPass(), stage.made.framesInFlight);
    fwui::theme().scale = 0;  // no scale yet
    stage.overlay = [this](VkCommandBuffer commands) {
        if (shown_) renderer_->drawOver(commands, slot_, *ImGui::GetDrawData());
    };
}

Hud::~Hud() {
    stage_.overlay = {};
    renderer_.reset();
    ImGui::DestroyContext();
}

// Scales with the window: designed for 1280 pixels, legible down to about 700. Smaller windows
// shrink it until the panels fit side by side.
void Hud::fit(VkExtent2D extent) {
    const float wide = float(extent.width), high = float(extent.height);
    const float scale =
        std::min({std::clamp(wide / 1280, 0.6f, 3.0f), wide / kLayoutWidth, high / kLayoutHeight});
    if (scale == fwui::theme().scale) return;
    fwui::theme().scale = scale;
    std::string error;
    if (!fwui::loadFonts(error)) throw sample::Failure(error);
    fwui::applyStyle();
    renderer_->uploadFonts();
}

void Hud::takeInput(const sample::StageFrame& frame) {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {float(frame.extent.width), float(frame.extent.height)};
    io.DeltaTime = std::max(1e-4f, frame.deltaTime);
    io.MousePos = {frame.input.x * io.DisplaySize.x, frame.input.y * io.DisplaySize.y};
    io.MouseDown[0] = frame.input.held;
}

HudRequests Hud::show(const sample::StageFrame& frame, const Lens& lens, const Battlefield& field,
                      const Siege& siege, const FireNumbers& fires, Player& player) {
    slot_ = frame.slot;
    shown_ = frame.extent.width >= kLeastWidth && frame.extent.height >= kLeastHeight;
    if (!shown_) {
        Board blind{nullptr, lens, field, siege, fires, player};
        handleKeys(frame.input.keys, blind);
        return std::move(blind.requests);
    }
    fit(frame.extent);
    takeInput(frame);
    ImGui::NewFrame();
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize(ImGui::GetIO().DisplaySize);
    ImGui::Begin("hud", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground |
                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoNav);
    Board board{ImGui::GetWindowDrawList(), lens, field, siege, fires, player};
    handleKeys(frame.input.keys, board);
    board.drawRanges();
    board.drawHealthBars();
    board.drawWave();
    board.drawVillageBar();
    board.drawPurse();
    board.drawFireNumbers();
    board.drawLedger();
    board.showTowerCards();
    board.showSpeeds();
    board.showPlotMenu();
    board.showPlots();
    board.drawMessage(frame.time);
    board.drawOutcome();
    ImGui::End();
    ImGui::Render();
    return std::move(board.requests);
}

}  // namespace tower
