#include "bot.h"

namespace game {

namespace {

struct PlannedTower {
    int32_t plot;
    TowerKind kind;
    int32_t level;  // from 0
};
// Ordered by priority; bought as coins allow. Plots as in battlefield.cpp.
constexpr PlannedTower kPlan[] = {
    {0, TowerKind::kFlamethrower, 0}, {4, TowerKind::kFlamethrower, 0},
    {2, TowerKind::kWaterCannon, 0},  {1, TowerKind::kEmberMortar, 0},
    {0, TowerKind::kFlamethrower, 1}, {3, TowerKind::kWindFan, 0},
    {7, TowerKind::kFlamethrower, 0}, {4, TowerKind::kFlamethrower, 1},
    {6, TowerKind::kFlamethrower, 0}, {1, TowerKind::kEmberMortar, 1},
    {5, TowerKind::kEmberMortar, 0},  {2, TowerKind::kWaterCannon, 1},
    {0, TowerKind::kFlamethrower, 2}, {7, TowerKind::kFlamethrower, 1},
    {6, TowerKind::kFlamethrower, 1}, {4, TowerKind::kFlamethrower, 2},
};

}  // namespace

Order botsOrder(const State& state) {
    for (const PlannedTower& planned : kPlan) {
        const Tower& tower = state.towers[size_t(planned.plot)];
        if (tower.kind == TowerKind::kNone) {
            if (state.coins < kTowers[size_t(planned.kind)].price[0]) break;
            return {Order::Type::kPlace, planned.plot, planned.kind};
        }
        if (tower.level >= planned.level) continue;
        if (state.coins < priceOf(tower)) break;
        return {Order::Type::kUpgrade, planned.plot, planned.kind};
    }
    // Calling a wave early earns coins, once the first towers stand.
    constexpr int32_t kEarlyCallTicks = 5 * kTicksPerSecond;
    if (state.marched == 0 && state.untilWave > kEarlyCallTicks &&
        state.untilWave < kBeforeWave - 2 * kTicksPerSecond)
        return {Order::Type::kCallWave, 0, TowerKind::kNone};
    return {};
}

State gameInProgress(const Ground& ground, uint32_t seed) {
    constexpr int32_t kWave = 3, kSeconds = 22;
    State state = newGame(seed);
    state.wave = kWave;
    state.coins = 900;
    while (true) {
        const Order order = botsOrder(state);
        if (order.type == Order::Type::kNone) break;
        give(state, ground, order);
    }
    state.untilWave = 0;
    std::vector<Event> events;
    for (int32_t i = 0; i < kSeconds * kTicksPerSecond; ++i) tick(state, ground, {}, events);
    return state;
}

}  // namespace game
