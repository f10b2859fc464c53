// The game: plain data and free functions. Integers only; 32 ticks per second. Independent of fire
// and rendering: Burning is its input each tick, the state and the events are its output. Equal
// orders and equal fires give bit-equal games, so a copy of State is a snapshot.
#pragma once

#include <span>
#include <type_traits>
#include <vector>

#include "rules.h"

namespace game {

struct Point {
    int32_t x = 0, z = 0;  // mm; x east, z south
};

// The playing field, constant during a game.
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
    int32_t along = 0, side = 0;  // mm on the road, and left of its centre
    int32_t alight = 0;           // ticks since ignition; 0: not ignited
    int32_t burnt = 0;            // thousandths
    int32_t lies = 0;             // ticks since it fell
    int32_t born = 0;             // serial number among the enemies of the game, from 1
};

struct Tower {
    TowerKind kind = TowerKind::kNone;
    int32_t level = 0;    // from 0
    int32_t paid = 0;     // coins paid
    int32_t wait = 0;     // ticks until the next shot
    int32_t streams = 0;  // ticks for which its valve stays open
    int32_t target = -1;  // an enemy's slot, or a house, or -1
    Point aim;            // current aim; turns at a limited rate
    int32_t flies = 0;    // ticks until its ember lands; 0: none in flight
    Point falls;          // landing point
};

enum class Outcome : int32_t { kPlaying, kWon, kLost };
struct State {
    uint32_t seed = 0;
    int32_t tick = 0;
    Outcome outcome = Outcome::kPlaying;
    int32_t coins = kCoinsAtStart, lives = kLivesAtStart;
    int32_t felled = 0, earned = 0;   // enemies felled, and coins for them
    int32_t wave = 0;                 // the next wave, or the last one; from 0
    int32_t untilWave = kBeforeWave;  // ticks; during a wave: until its next enemy
    int32_t marched = 0;              // enemies of the wave that appeared; 0: not started
    int32_t born = 0;
    Point wind, wanted;                         // mm/s; without fans, and its target value
    std::array<int32_t, kHouses> houseBurnt{};  // thousandths
    std::array<int32_t, kHouses> flashed{};     // 1: the house has flashed over
    std::array<Enemy, kEnemySlots> enemies;     // kindOf(slot) is constant
    std::array<Tower, kPlots> towers;
};
// Allows comparing, hashing and copying its bytes.
static_assert(std::has_unique_object_representations_v<State> &&
              std::is_trivially_copyable_v<State>);

// Effects of the fires, queried from the world before each tick.
struct Burning {
    std::array<int32_t, kEnemySlots> enemyBurnt{};  // thousandths
    std::array<bool, kEnemySlots> enemyAlight{};
    std::array<int32_t, kHouses> houseBurnt{};
    std::array<bool, kHouses> houseAlight{};
    std::array<bool, kHouses> houseFlashed{};  // its compartment has flashed over and still burns
                                               // fully
};

// Events that the world must apply or may show. Everything else is in the state.
struct Event {
    enum class Type : int32_t {
        kBorn,         // an enemy: `slot` is new, and its previous object is gone
        kFell,         // an enemy burnt down
        kGotThrough,   // an enemy reached the mill
        kShot,         // a mortar's ember is in flight
        kEmberLands,   // radius `strength` mm around `place`
        kSprays,       // water at `place`, `strength` g/m^2
        kBeamFalls,    // from a burning roof; `strength`: number of the beam in its house
        kFlashesOver,  // a house: it is lost, water helps only elsewhere
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
// Returns null if the order is applied. Otherwise returns the reason for the player and changes
// nothing.
const char* give(State& state, const Ground& ground, const Order& order);
// Appends to `events`.
void tick(State& state, const Ground& ground, const Burning& burning, std::vector<Event>& events);

EnemyKind kindOf(size_t enemySlot);
Point roadPoint(const Ground& ground, int32_t along,
                Point* direction);         // unit direction, scaled to 1000
int32_t roadLength(const Ground& ground);  // mm
Point placeOf(const Ground& ground, const Enemy& enemy);
Point nearestOfRoad(const Ground& ground, Point place);
// Returns the wind that a fan adds towards the road, mm/s; zero without a fan.
Point fanOf(const State& state, const Ground& ground, size_t plot);
// Returns the wind on an ember in flight: the valley's wind plus all fans. Fire only meets a fan's
// wind inside its zone.
Point windOf(const State& state, const Ground& ground);
int32_t priceOf(const Tower& tower);   // coins for the next level; 0: none
int32_t refundOf(const Tower& tower);  // coins for selling it
int32_t countOf(const Wave& wave);     // number of enemies
int32_t standing(const State& state);  // unburnt share of the village, thousandths
int32_t score(const State& state);
uint64_t hashOf(const State& state);

}  // namespace game
