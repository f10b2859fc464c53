// The head-up display: Dear ImGui with the editor's fonts. Returns the player's requests and never
// changes the game.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/stage.h"
#include "overview.h"
#include "shell/ui_renderer.h"
#include "siege.h"

namespace tower {

// The player's view state.
struct Player {
    game::TowerKind chosen = game::TowerKind::kNone;  // tower for the next click
    int32_t plot = -1;                                // selected
    int32_t speed = 1;                                // 1, 2, 4
    bool paused = false;
    bool showsLedger = false;   // the energy ledger is open
    std::string said;           // the last message
    double messageTime = -100;  // s of the stage's clock
};

// Summary of all fires.
struct FireNumbers {
    uint32_t burning = 0, caught = 0;  // objects
    float megawatts = 0, squareMetres = 0;
    FwEnergyLedger ledger{};  // of the whole world
};

// Requests of the player in this frame.
struct HudRequests {
    std::vector<game::Order> orders;
    bool pause = false, faster = false, rewind = false, light = false;
};

class Hud {
 public:
    Hud(const sample::VulkanHost& host, sample::Stage& stage);
    ~Hud();
    Hud(const Hud&) = delete;
    Hud& operator=(const Hud&) = delete;

    // Pixels. A smaller window hides the HUD; keys still work.
    static constexpr uint32_t kLeastWidth = 400, kLeastHeight = 150;

    // Lays out the frame. The stage's overlay draws it.
    HudRequests show(const sample::StageFrame& frame, const Lens& lens, const Battlefield& field,
                     const Siege& siege, const FireNumbers& fires, Player& player);

 private:
    void fit(VkExtent2D extent);
    void takeInput(const sample::StageFrame& frame);

    std::unique_ptr<fwui::UiRenderer> renderer_;
    sample::Stage& stage_;
    uint32_t slot_ = 0;
    bool shown_ = false;
};

}  // namespace tower
