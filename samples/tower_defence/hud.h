// What the player sees over the picture and clicks on: by Dear ImGui, with the editor's fonts.
// Draws and answers; changes nothing of the game itself.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/stage.h"
#include "overview.h"
#include "shell/ui_renderer.h"
#include "siege.h"

namespace tower {

// How the player stands to the game.
struct Player {
    game::TowerKind chosen = game::TowerKind::kNone;  // to be placed with the next click
    int32_t plot = -1;                                // selected
    int32_t speed = 1;                                // 1, 2, 4
    bool paused = false;
    bool books = false;    // the book of energy is open
    std::string said;      // the last thing the game told him
    double saidAt = -100;  // s of the stage's clock
};

// The fires in numbers.
struct FireNumbers {
    uint32_t burning = 0, caught = 0;  // things
    float megawatts = 0, squareMetres = 0;
    FwEnergyBook book{};  // of the whole world
};

// What was pressed or clicked in this frame.
struct Wishes {
    std::vector<game::Order> orders;
    bool pause = false, faster = false, rewind = false, light = false;
};

class Hud {
 public:
    Hud(const sample::VulkanHost& host, sample::Stage& stage);
    ~Hud();
    Hud(const Hud&) = delete;
    Hud& operator=(const Hud&) = delete;

    // Pixels. A smaller window shows the game alone, which keys still play.
    static constexpr uint32_t kLeastWidth = 400, kLeastHeight = 150;

    // Lays out the frame, which the stage's overlay then draws.
    Wishes show(const sample::StageFrame& frame, const Lens& lens, const Battlefield& field,
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
