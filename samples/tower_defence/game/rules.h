// The numbers of the game: enemies, towers, waves. All are integers: millimetres, ticks of 1/32 s,
// thousandths.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace game {

constexpr int32_t kTicksPerSecond = 32;
constexpr int32_t kLevels = 3;  // levels per tower

enum class EnemyKind : int32_t { kStrawMan, kYuleGoat, kLogKnight, kWickerGiant, kCount };
constexpr size_t kEnemyKinds = size_t(EnemyKind::kCount);

struct EnemyRule {
    const char* name;
    int32_t pace;    // mm per tick
    int32_t falls;   // thousandths burnt at which it falls
    int32_t bounty;  // coins
    int32_t lives;   // lives lost when it reaches the mill
    bool panics;     // runs while it burns
    int32_t most;    // most of them at a time
};
constexpr std::array<EnemyRule, kEnemyKinds> kEnemies{{
    {"straw man", 44, 450, 8, 1, true, 8},
    {"yule goat", 60, 500, 9, 1, true, 4},
    {"log knight", 26, 450, 18, 2, false, 4},
    {"wicker giant", 21, 550, 60, 5, false, 1},
}};
constexpr size_t kEnemySlots =
    size_t(kEnemies[0].most + kEnemies[1].most + kEnemies[2].most + kEnemies[3].most);

enum class TowerKind : int32_t {
    kNone,
    kFlamethrower,
    kEmberMortar,
    kWaterCannon,
    kWindFan,
    kCount
};
constexpr size_t kTowerKinds = size_t(TowerKind::kCount);

struct TowerRule {
    const char* name;
    std::array<int32_t, kLevels> price;     // coins, per level above the previous one
    std::array<int32_t, kLevels> range;     // mm
    std::array<int32_t, kLevels> strength;  // meaning by kind, see below
    int32_t nearest;                        // mm
    int32_t reload;                         // ticks between two shots; 0: a stream
};
constexpr std::array<TowerRule, kTowerKinds> kTowers{{
    {"nothing", {}, {}, {}, 0, 0},
    // strength: kW of its jet. The fuel sticks and keeps burning.
    {"flamethrower", {120, 90, 120}, {8600, 9200, 9800}, {500, 700, 1000}, 1500, 0},
    // strength: mm, radius of the fire where its ember lands, a little downwind of its aim
    {"ember mortar", {180, 130, 170}, {14000, 16000, 18000}, {700, 950, 1200}, 5000, 128},
    // strength: g/m^2 of water where it strikes, eight times a second
    {"water cannon", {100, 80, 100}, {15000, 17000, 19000}, {60, 110, 180}, 0, 4},
    // strength: mm/s added to the valley's wind. A fifth of it, as thousandths of pace, slows
    // nearby enemies.
    {"wind fan", {90, 70, 90}, {6500, 7000, 7500}, {1200, 1900, 2600}, 0, 0},
}};
constexpr int32_t kRefund = 700;  // thousandths of the price

struct Wave {
    std::array<int32_t, kEnemyKinds> count;
    int32_t gap;  // ticks between two enemies
};
constexpr std::array<Wave, 10> kWaves{{
    {{4, 0, 0, 0}, 72},
    {{6, 2, 0, 0}, 60},
    {{5, 4, 1, 0}, 56},
    {{8, 2, 3, 0}, 48},
    {{8, 6, 2, 0}, 40},
    {{6, 4, 5, 1}, 48},
    {{14, 6, 0, 0}, 28},
    {{8, 4, 8, 0}, 36},
    {{14, 8, 4, 1}, 28},
    {{16, 8, 8, 2}, 26},
}};
constexpr int32_t kBeforeWave = 20 * kTicksPerSecond;  // ticks of peace; the player may skip them
constexpr int32_t kCoinsAtStart = 320, kLivesAtStart = 20;
constexpr int32_t kCoinsPerSecondEarly = 1;  // bonus for calling a wave early
constexpr int32_t kCoinsPerWave = 40;        // bonus per finished wave

// The score: kills, unburnt village, lives left.
constexpr int32_t kScorePerCoin = 10, kScorePerLife = 100, kScorePerHouse = 500,
                  kScorePerWave = 200;
constexpr int32_t kScoreForFlash = 150;  // penalty per house that flashed over
constexpr int32_t kHouseIsLost = 500;    // thousandths burnt

// A roof does not touch its walls. Its falling beams ignite them, piece by piece.
constexpr int32_t kBeams = 32;                               // per house
constexpr int32_t kBeamsFallFrom = 60, kBeamsFallEvery = 8;  // thousandths burnt
constexpr int32_t kBeamBurns = 320;                          // mm around the landing point

}  // namespace game
