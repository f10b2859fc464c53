// See game.h.
#include "game.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace game {

namespace {

constexpr int32_t kLeadTicks = 12;   // flight time of a jet
constexpr int32_t kEmberTicks = 44;  // flight time of an ember
constexpr int32_t kTurn = 300;       // mm per tick; turn rate of a tower's aim
constexpr int32_t kOnTarget = 1300;  // mm
constexpr int32_t kValve = 10;       // ticks for which a valve stays open
constexpr int32_t kWindTurns = 16;   // mm/s per tick
constexpr int32_t kPanics = 1500;    // thousandths of its pace
constexpr int32_t kRuns = 48;        // ticks that a burning enemy runs before it stumbles
constexpr int32_t kStumbles = 350;   // thousandths of its pace
constexpr int32_t kLies = 8 * kTicksPerSecond;  // ticks until a fallen enemy is removed
constexpr int32_t kFilesApart = 650;            // mm from the centre of the road

uint32_t mixBits(uint32_t a) {
    a ^= a >> 16;
    a *= 0x7feb352du;
    a ^= a >> 15;
    a *= 0x846ca68bu;
    return a ^ (a >> 16);
}

int64_t square(int64_t a) { return a * a; }
int64_t distance2(Point a, Point b) { return square(a.x - b.x) + square(a.z - b.z); }

// Integer square root, rounded down.
int32_t integerSqrt(int64_t value) {
    auto root = int64_t(std::sqrt(double(value)));
    while (root * root > value) --root;
    while ((root + 1) * (root + 1) <= value) ++root;
    return int32_t(root);
}

Point withLength(Point direction, int32_t length) {
    const int64_t now = std::max(1, integerSqrt(distance2(direction, {})));
    return {int32_t(direction.x * int64_t(length) / now),
            int32_t(direction.z * int64_t(length) / now)};
}

Point towards(Point from, Point to, int32_t most) {
    const Point offset{to.x - from.x, to.z - from.z};
    if (distance2(offset, {}) <= square(most)) return to;
    const Point step = withLength(offset, most);
    return {from.x + step.x, from.z + step.z};
}

const TowerRule& ruleOf(const Tower& tower) { return kTowers[size_t(tower.kind)]; }
int32_t ofLevel(const std::array<int32_t, kLevels>& values, const Tower& tower) {
    return values[size_t(tower.level)];
}

bool inRange(const Tower& tower, Point from, Point at) {
    const int64_t away = distance2(from, at);
    return away <= square(ofLevel(ruleOf(tower).range, tower)) &&
           away >= square(ruleOf(tower).nearest);
}

// Prefers enemies that do not burn yet; among equals, the foremost.
int32_t chooseEnemy(const State& state, const Ground& ground, const Tower& tower, Point from) {
    int32_t best = -1;
    for (size_t i = 0; i < kEnemySlots; ++i) {
        const Enemy& enemy = state.enemies[i];
        if (enemy.phase != Phase::kMarches || !inRange(tower, from, placeOf(ground, enemy)))
            continue;
        if (best >= 0) {
            const Enemy& other = state.enemies[size_t(best)];
            const bool fresh = enemy.alight == 0, otherFresh = other.alight == 0;
            if (fresh != otherFresh ? otherFresh : enemy.along <= other.along) continue;
        }
        best = int32_t(i);
    }
    return best;
}

// Prefers the least burnt of the burning houses, since it can be saved. Houses after flashover come
// last.
int32_t chooseHouse(const State& state, const Ground& ground, const Burning& burning,
                    const Tower& tower, Point from) {
    int32_t best = -1;
    for (size_t i = 0; i < kHouses; ++i) {
        if (!burning.houseAlight[i] || !inRange(tower, from, ground.houses[i])) continue;
        if (best >= 0) {
            const auto other = size_t(best);
            if (state.flashed[i] != state.flashed[other]
                    ? state.flashed[i] != 0
                    : state.houseBurnt[i] >= state.houseBurnt[other])
                continue;
        }
        best = int32_t(i);
    }
    return best;
}

Point ahead(const Ground& ground, const Enemy& enemy, int32_t ticks) {
    Enemy later = enemy;
    later.along += ticks * kEnemies[0].pace / 2;
    return placeOf(ground, later);
}

// Returns the pace, mm per tick.
int32_t paceOf(const State& state, const Ground& ground, size_t slot) {
    const EnemyRule& rule = kEnemies[size_t(kindOf(slot))];
    const Enemy& enemy = state.enemies[slot];
    int64_t pace = rule.pace;
    if (rule.panics && enemy.alight > 0)
        pace = pace * (enemy.alight < kRuns ? kPanics : kStumbles) / 1000;
    for (size_t i = 0; i < kPlots; ++i) {
        const Tower& tower = state.towers[i];
        if (tower.kind != TowerKind::kWindFan) continue;
        if (inRange(tower, ground.plots[i], placeOf(ground, enemy)))
            pace = pace * (1000 - ofLevel(ruleOf(tower).strength, tower) / 5) / 1000;
    }
    return int32_t(std::max<int64_t>(pace, 4));
}

void march(State& state, const Ground& ground, const Burning& burning, std::vector<Event>& events) {
    for (size_t i = 0; i < kEnemySlots; ++i) {
        Enemy& enemy = state.enemies[i];
        const EnemyRule& rule = kEnemies[size_t(kindOf(i))];
        if (enemy.phase == Phase::kFalls && ++enemy.lies > kLies) enemy = {};
        if (enemy.phase != Phase::kMarches) continue;
        enemy.burnt = std::max(enemy.burnt, burning.enemyBurnt[i]);
        if (enemy.alight > 0 || burning.enemyAlight[i]) ++enemy.alight;
        enemy.along += paceOf(state, ground, i);
        if (enemy.burnt >= rule.falls) {
            enemy.phase = Phase::kFalls;
            state.coins += rule.bounty;
            state.earned += rule.bounty;
            ++state.felled;
            events.push_back({Event::Type::kFell, int32_t(i), placeOf(ground, enemy), 0});
        } else if (enemy.along >= roadLength(ground)) {
            state.lives = std::max(0, state.lives - rule.lives);
            events.push_back({Event::Type::kGotThrough, int32_t(i), placeOf(ground, enemy), 0});
            enemy = {};
        }
    }
}

// Returns the kind of the wave's next enemy. The seed shuffles the kinds.
EnemyKind nextKind(const State& state) {
    const Wave& wave = kWaves[size_t(state.wave)];
    std::array<int32_t, kEnemyKinds> left = wave.count;
    int32_t sum = countOf(wave);
    uint32_t kind = 0;
    for (int32_t i = 0; i <= state.marched; ++i, --sum) {
        int32_t pick =
            int32_t(mixBits(state.seed ^ mixBits(uint32_t(state.wave * 64 + i))) % uint32_t(sum));
        for (kind = 0; pick >= left[kind]; ++kind) pick -= left[kind];
        --left[kind];
    }
    return EnemyKind(kind);
}

void spawnEnemies(State& state, std::vector<Event>& events) {
    if (size_t(state.wave) >= kWaves.size()) return;
    const Wave& wave = kWaves[size_t(state.wave)];
    if (state.untilWave > 0) --state.untilWave;
    if (state.marched == countOf(wave)) {  // all have appeared: the wave ends with its last enemy
        const bool any = std::any_of(state.enemies.begin(), state.enemies.end(),
                                     [](const Enemy& e) { return e.phase == Phase::kMarches; });
        if (any) return;
        events.push_back({Event::Type::kWaveOver, state.wave, {}, 0});
        state.coins += kCoinsPerWave;
        ++state.wave;
        state.marched = 0;
        state.untilWave = kBeforeWave;
        const uint32_t random = mixBits(state.seed + 77u * uint32_t(state.wave));
        const int32_t speed = 1500 + int32_t(random % 2500u);
        state.wanted = withLength(
            {int32_t(random >> 8 & 1023) - 512, int32_t(random >> 18 & 1023) - 512}, speed);
        return;
    }
    if (state.untilWave > 0) return;
    const EnemyKind kind = nextKind(state);
    for (size_t i = 0; i < kEnemySlots; ++i) {
        if (kindOf(i) != kind || state.enemies[i].phase != Phase::kAway) continue;
        if (state.marched == 0) events.push_back({Event::Type::kWaveBegins, state.wave, {}, 0});
        ++state.marched;
        Enemy& enemy = state.enemies[i];
        enemy = {};
        enemy.phase = Phase::kMarches;
        enemy.born = ++state.born;
        enemy.side = kind == EnemyKind::kWickerGiant ? 0
                     : state.born % 2                ? kFilesApart
                                                     : -kFilesApart;
        events.push_back({Event::Type::kBorn, int32_t(i), {}, 0});
        state.untilWave = wave.gap;
        return;
    }
}

void burn(State& state, const Ground& ground, size_t plot, std::vector<Event>& events) {
    Tower& tower = state.towers[plot];
    const Point from = ground.plots[plot];
    const bool mortar = tower.kind == TowerKind::kEmberMortar;
    tower.target = chooseEnemy(state, ground, tower, from);
    bool onTarget = false;
    if (tower.target >= 0) {
        const Enemy& enemy = state.enemies[size_t(tower.target)];
        const Point to = ahead(ground, enemy, mortar ? kEmberTicks : kLeadTicks);
        tower.aim = towards(tower.aim, to, kTurn);
        onTarget = distance2(tower.aim, to) < square(kOnTarget);
    }
    if (!mortar) {
        if (onTarget) tower.streams = kValve;
        return;
    }
    if (tower.flies > 0 && --tower.flies == 0)
        events.push_back({Event::Type::kEmberLands, int32_t(plot), tower.falls,
                          ofLevel(ruleOf(tower).strength, tower)});
    if (!onTarget || tower.wait > 0) return;
    const Point wind = windOf(state, ground);
    tower.wait = ruleOf(tower).reload;
    tower.flies = kEmberTicks;
    tower.falls = {tower.aim.x + wind.x / 8, tower.aim.z + wind.z / 8};
    events.push_back({Event::Type::kShot, int32_t(plot), tower.falls, 0});
}

void spray(State& state, const Ground& ground, const Burning& burning, size_t plot,
           std::vector<Event>& events) {
    Tower& tower = state.towers[plot];
    tower.target = chooseHouse(state, ground, burning, tower, ground.plots[plot]);
    if (tower.target < 0) return;
    // Sweeps the water over the roof.
    constexpr int32_t kReach = 2200, kTurnTicks = 40;
    const int32_t turn = state.tick % (4 * kTurnTicks);
    const int32_t sway = std::abs(turn - 2 * kTurnTicks) - kTurnTicks;  // a triangle wave
    const int32_t deep =
        std::abs((state.tick / 3) % (4 * kTurnTicks) - 2 * kTurnTicks) - kTurnTicks;
    Point to = ground.houses[size_t(tower.target)];
    to.x += sway * kReach / kTurnTicks;
    to.z += deep * kReach / kTurnTicks;
    tower.aim = towards(tower.aim, to, kTurn);
    if (distance2(tower.aim, to) > square(kOnTarget)) return;
    tower.streams = kValve;
    if (tower.wait > 0) return;
    tower.wait = ruleOf(tower).reload;
    events.push_back(
        {Event::Type::kSprays, int32_t(plot), tower.aim, ofLevel(ruleOf(tower).strength, tower)});
}

void work(State& state, const Ground& ground, const Burning& burning, std::vector<Event>& events) {
    for (size_t i = 0; i < kPlots; ++i) {
        Tower& tower = state.towers[i];
        tower.wait = std::max(0, tower.wait - 1);
        tower.streams = std::max(0, tower.streams - 1);
        switch (tower.kind) {
            case TowerKind::kFlamethrower:
            case TowerKind::kEmberMortar:
                burn(state, ground, i, events);
                break;
            case TowerKind::kWaterCannon:
                spray(state, ground, burning, i, events);
                break;
            default:
                break;
        }
    }
}

void countHouses(State& state, const Burning& burning, std::vector<Event>& events) {
    for (size_t i = 0; i < kHouses; ++i) {
        const int32_t before = state.houseBurnt[i];
        state.houseBurnt[i] = std::max(before, burning.houseBurnt[i]);
        // A flashover ignites everything inside, so the remaining beams fall now.
        const bool flashes = burning.houseFlashed[i] && state.flashed[i] == 0;
        for (int32_t beam = 0; beam < kBeams && burning.houseAlight[i]; ++beam) {
            const int32_t falls = kBeamsFallFrom + beam * kBeamsFallEvery;
            const bool fell = before >= falls || state.flashed[i] != 0;
            if (!fell && (flashes || state.houseBurnt[i] >= falls))
                events.push_back({Event::Type::kBeamFalls, int32_t(i), {}, beam});
        }
        if (flashes) {
            state.flashed[i] = 1;
            events.push_back({Event::Type::kFlashesOver, int32_t(i), {}, 0});
        }
        if (before < kHouseIsLost && state.houseBurnt[i] >= kHouseIsLost)
            events.push_back({Event::Type::kHouseLost, int32_t(i), {}, 0});
    }
}

const char* place(State& state, const Ground& ground, const Order& order) {
    Tower& tower = state.towers[size_t(order.plot)];
    if (tower.kind != TowerKind::kNone) return "there is a tower already";
    if (order.kind <= TowerKind::kNone || order.kind >= TowerKind::kCount) return "no such tower";
    const int32_t price = kTowers[size_t(order.kind)].price[0];
    if (price > state.coins) return "not enough coins";
    state.coins -= price;
    tower = {};
    tower.kind = order.kind;
    tower.paid = price;
    tower.aim = nearestOfRoad(ground, ground.plots[size_t(order.plot)]);
    return nullptr;
}

const char* upgrade(State& state, Tower& tower) {
    if (tower.kind == TowerKind::kNone) return "there is no tower";
    if (tower.level + 1 == kLevels) return "it has its highest level";
    const int32_t price = priceOf(tower);
    if (price > state.coins) return "not enough coins";
    state.coins -= price;
    tower.paid += price;
    ++tower.level;
    return nullptr;
}

}  // namespace

State newGame(uint32_t seed) {
    State state;
    state.seed = seed;
    state.wind = state.wanted = {-2400, -2000};  // wind from the sea
    return state;
}

EnemyKind kindOf(size_t slot) {
    size_t kind = 0;
    for (; kind + 1 < kEnemyKinds && slot >= size_t(kEnemies[kind].most); ++kind)
        slot -= size_t(kEnemies[kind].most);
    return EnemyKind(kind);
}

int32_t roadLength(const Ground& ground) {
    return int32_t(ground.road.size() - 1) * Ground::kRoadStep;
}

Point roadPoint(const Ground& ground, int32_t along, Point* direction) {
    along = std::clamp(along, 0, roadLength(ground) - 1);
    const auto i = size_t(along / Ground::kRoadStep);
    const int32_t rest = along % Ground::kRoadStep;
    const Point a = ground.road[i], b = ground.road[i + 1];
    if (direction) *direction = withLength({b.x - a.x, b.z - a.z}, 1000);
    return {a.x + (b.x - a.x) * rest / Ground::kRoadStep,
            a.z + (b.z - a.z) * rest / Ground::kRoadStep};
}

Point placeOf(const Ground& ground, const Enemy& enemy) {
    Point direction;
    const Point at = roadPoint(ground, enemy.along, &direction);
    return {at.x - direction.z * enemy.side / 1000, at.z + direction.x * enemy.side / 1000};
}

Point nearestOfRoad(const Ground& ground, Point place) {
    return *std::min_element(ground.road.begin(), ground.road.end(), [&](Point a, Point b) {
        return distance2(a, place) < distance2(b, place);
    });
}

Point fanOf(const State& state, const Ground& ground, size_t plot) {
    const Tower& tower = state.towers[plot];
    if (tower.kind != TowerKind::kWindFan) return {};
    const Point from = ground.plots[plot], to = nearestOfRoad(ground, from);
    return withLength({to.x - from.x, to.z - from.z}, ofLevel(ruleOf(tower).strength, tower));
}

Point windOf(const State& state, const Ground& ground) {
    Point wind = state.wind;
    for (size_t i = 0; i < kPlots; ++i) {
        const Point blows = fanOf(state, ground, i);
        wind = {wind.x + blows.x, wind.z + blows.z};
    }
    return wind;
}

int32_t priceOf(const Tower& tower) {
    if (tower.kind == TowerKind::kNone || tower.level + 1 == kLevels) return 0;
    return ruleOf(tower).price[size_t(tower.level) + 1];
}

int32_t refundOf(const Tower& tower) { return tower.paid * kRefund / 1000; }

int32_t countOf(const Wave& wave) {
    int32_t sum = 0;
    for (const int32_t count : wave.count) sum += count;
    return sum;
}

int32_t standing(const State& state) {
    int32_t burnt = 0;
    for (const int32_t house : state.houseBurnt) burnt += house;
    return 1000 - burnt / int32_t(kHouses);
}

int32_t score(const State& state) {
    const auto stand = std::count_if(state.houseBurnt.begin(), state.houseBurnt.end(),
                                     [](int32_t burnt) { return burnt < kHouseIsLost; });
    const auto flashed = std::count(state.flashed.begin(), state.flashed.end(), 1);
    return state.earned * kScorePerCoin + state.lives * kScorePerLife +
           int32_t(stand) * kScorePerHouse + state.wave * kScorePerWave -
           int32_t(flashed) * kScoreForFlash;
}

uint64_t hashOf(const State& state) {
    unsigned char bytes[sizeof state];
    std::memcpy(bytes, &state, sizeof state);
    uint64_t hash = 0xcbf29ce484222325ull;  // FNV-1a
    for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3ull;
    return hash;
}

const char* give(State& state, const Ground& ground, const Order& order) {
    if (order.type == Order::Type::kNone) return nullptr;
    if (state.outcome != Outcome::kPlaying) return "the game is over";
    if (order.type == Order::Type::kCallWave) {
        if (size_t(state.wave) >= kWaves.size() || state.marched > 0) return "a wave is on its way";
        state.coins += state.untilWave / kTicksPerSecond * kCoinsPerSecondEarly;
        state.untilWave = 0;
        return nullptr;
    }
    if (order.plot < 0 || size_t(order.plot) >= kPlots) return "no such plot";
    Tower& tower = state.towers[size_t(order.plot)];
    switch (order.type) {
        case Order::Type::kPlace:
            return place(state, ground, order);
        case Order::Type::kUpgrade:
            return upgrade(state, tower);
        default:
            if (tower.kind == TowerKind::kNone) return "there is no tower";
            state.coins += refundOf(tower);
            tower = {};
            return nullptr;
    }
}

void tick(State& state, const Ground& ground, const Burning& burning, std::vector<Event>& events) {
    if (state.outcome != Outcome::kPlaying) return;
    ++state.tick;
    state.wind = towards(state.wind, state.wanted, kWindTurns);
    countHouses(state, burning, events);
    march(state, ground, burning, events);
    spawnEnemies(state, events);
    work(state, ground, burning, events);
    if (state.lives == 0)
        state.outcome = Outcome::kLost;
    else if (size_t(state.wave) >= kWaves.size())
        state.outcome = Outcome::kWon;
    if (state.outcome != Outcome::kPlaying) events.push_back({Event::Type::kOver, 0, {}, 0});
}

}  // namespace game
