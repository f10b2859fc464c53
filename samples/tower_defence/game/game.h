// The game: plain data, and free functions over it. Integers only; 32 ticks a second.
// It knows neither fire nor pictures. What burns is told to it each tick (Burning); what is to be
// done in the world is read from its state and from what happened. The same orders and the same
// fires make the same game, bit for bit, so that a copy of State is a point to come back to.
#pragma once

#include <span>
#include <type_traits>
#include <vector>

#include "rules.h"

namespace game {

struct Point {
    int32_t x = 0, z = 0;  // mm; x east, z south
};

// Where it is played: given once, the same for all of a game.
constexpr size_t kPlots = 8, kHouses = 9;
struct Ground {
    static constexpr int32_t kRoadStep = 250;  // mm between two points of the road
    std::vector<Point> road;                   // from the gate to the mill
    std::array<Point, kPlots> plots;
    std::array<Point, kHouses> houses;
};

enum class Phase : int32_t { kAway, kMarches, kFalls };
struct Enemy {
    Phase phase = Phase::kAway;
    int32_t along = 0, side = 0;  // mm on the road, and left of its middle
    int32_t alight = 0;           // ticks since it caught; 0: not yet
    int32_t burnt = 0;            // thousandths
    int32_t lies = 0;             // ticks since it fell
    int32_t born = 0;             // the how many-th enemy of the game it is, from 1
};

struct Tower {
    TowerKind kind = TowerKind::kNone;
    int32_t level = 0;    // from 0
    int32_t paid = 0;     // coins
    int32_t wait = 0;     // ticks to the next shot
    int32_t streams = 0;  // ticks that its valve stays open
    int32_t target = -1;  // an enemy's slot, or a house, or -1
    Point aim;            // where it points: it turns, it does not jump
    int32_t flies = 0;    // ticks until its ember is down; 0: none is in the air
    Point falls;          // where that will be
};

enum class Outcome : int32_t { kPlaying, kWon, kLost };
struct State {
    uint32_t seed = 0;
    int32_t tick = 0;
    Outcome outcome = Outcome::kPlaying;
    int32_t coins = kCoinsAtStart, lives = kLivesAtStart;
    int32_t felled = 0, earned = 0;   // enemies, coins for them
    int32_t wave = 0;                 // that comes, or came last once there is no more; from 0
    int32_t untilWave = kBeforeWave;  // ticks; while it marches in: until its next enemy
    int32_t marched = 0;              // of the wave's enemies; 0: it has not begun
    int32_t born = 0;
    Point wind, wanted;  // mm/s; as it is without fans, and where it turns to
    std::array<int32_t, kHouses> houseBurnt{};  // thousandths
    std::array<int32_t, kHouses> flashed{};     // 1: all that is in it has burnt at once
    std::array<Enemy, kEnemySlots> enemies;     // kindOf(slot) never changes
    std::array<Tower, kPlots> towers;
};
// So that its bytes may be compared, hashed and copied.
static_assert(std::has_unique_object_representations_v<State> &&
              std::is_trivially_copyable_v<State>);

// What the fires did to those who may burn, asked of the world before each tick.
struct Burning {
    std::array<int32_t, kEnemySlots> enemyBurnt{};  // thousandths
    std::array<bool, kEnemySlots> enemyAlight{};
    std::array<int32_t, kHouses> houseBurnt{};
    std::array<bool, kHouses> houseAlight{};
    std::array<bool, kHouses> houseFlashed{};  // its room has flashed over, and still burns so
};

// What the world has to do or may show; all else is in the state.
struct Happening {
    enum class Type : int32_t {
        kBorn,         // an enemy: `slot` is new, whatever burnt there before is gone
        kFell,         // an enemy burnt down
        kGotThrough,   // an enemy came to the mill
        kShot,         // a mortar's ember is in the air
        kEmberLands,   // `place`, `strength` mm about it
        kSprays,       // water at `place`, `strength` g/m^2
        kBeamFalls,    // from a burning roof, the `strength`-th of its house
        kFlashesOver,  // a house: what can still be saved of the village is elsewhere
        kHouseLost,
        kWaveBegins,
        kWaveOver,
        kOver,
    } type{};
    int32_t slot = 0;  // enemy, plot, house or wave
    Point place{};
    int32_t strength = 0;
};

struct Order {
    enum class Type : int32_t { kNone, kPlace, kUpgrade, kSell, kCallWave } type{};
    int32_t plot = 0;
    TowerKind kind = TowerKind::kNone;  // of kPlace
};

State newGame(uint32_t seed);
// Null: done. Else why not, in words for the player; then nothing has changed.
const char* give(State& state, const Ground& ground, const Order& order);
// Adds to `happened`.
void tick(State& state, const Ground& ground, const Burning& burning,
          std::vector<Happening>& happened);

EnemyKind kindOf(size_t enemySlot);
Point roadPoint(const Ground& ground, int32_t along,
                Point* direction);         // direction: of length 1000
int32_t roadLength(const Ground& ground);  // mm
Point placeOf(const Ground& ground, const Enemy& enemy);
Point nearestOfRoad(const Ground& ground, Point place);
// What a fan blows towards the road, mm/s; nothing where no fan stands.
Point fanOf(const State& state, const Ground& ground, size_t plot);
// What an ember meets on its way: the valley's wind and what all fans add. Fire meets a fan's where
// it blows alone.
Point windOf(const State& state, const Ground& ground);
int32_t priceOf(const Tower& tower);   // coins of its next level; 0: there is none
int32_t refundOf(const Tower& tower);  // coins for selling it
int32_t countOf(const Wave& wave);     // its enemies
int32_t standing(const State& state);  // thousandths of the village that have not burnt
int32_t score(const State& state);
uint64_t hashOf(const State& state);

}  // namespace game
