// Tests of the rules, on a straight road with scripted fires.
#include <gtest/gtest.h>

#include "bot.h"
#include "game.h"

namespace {

using namespace game;
using Type = Order::Type;

// A road of 80 m straight east; plots 4 m south of it, 8 m apart; houses 8 m north.
Ground straight() {
    Ground ground;
    for (int32_t i = 0; i <= 320; ++i) ground.road.push_back({i * Ground::kRoadStep, 0});
    for (size_t i = 0; i < kPlots; ++i) ground.plots[i] = {8000 + 8000 * int32_t(i), 4000};
    for (size_t i = 0; i < kHouses; ++i) ground.houses[i] = {8000 * int32_t(i), -8000};
    return ground;
}

struct Play {
    Ground ground = straight();
    State state = newGame(1);
    Burning burning;
    std::vector<Event> events;

    void run(int32_t ticks) {
        for (int32_t i = 0; i < ticks; ++i) tick(state, ground, burning, events);
    }
    size_t count(Event::Type type) const {
        return size_t(std::count_if(events.begin(), events.end(),
                                    [&](const Event& h) { return h.type == type; }));
    }
    // Calls a wave and returns its first enemy on the road.
    size_t first() {
        EXPECT_EQ(give(state, ground, {Type::kCallWave, 0, {}}), nullptr);
        run(1);
        for (size_t i = 0; i < kEnemySlots; ++i)
            if (state.enemies[i].phase == Phase::kMarches) return i;
        ADD_FAILURE() << "no enemy appeared";
        return 0;
    }
};

TEST(GameRules, OrdersCostTheirPriceAndRefusedOrdersChangeNothing) {
    Play play;
    const uint64_t before = hashOf(play.state);
    for (const Order& order :
         {Order{Type::kPlace, 99, TowerKind::kFlamethrower},
          Order{Type::kPlace, -1, TowerKind::kFlamethrower},
          Order{Type::kPlace, 0, TowerKind::kCount}, Order{Type::kPlace, 0, {}},
          Order{Type::kUpgrade, 0, {}}, Order{Type::kSell, 0, {}}}) {
        EXPECT_NE(give(play.state, play.ground, order), nullptr);
        EXPECT_EQ(hashOf(play.state), before);
    }
    EXPECT_EQ(give(play.state, play.ground, {Type::kPlace, 0, TowerKind::kFlamethrower}), nullptr);
    EXPECT_EQ(play.state.coins, kCoinsAtStart - 120);
    EXPECT_STREQ(give(play.state, play.ground, {Type::kPlace, 0, TowerKind::kWindFan}),
                 "there is a tower already");
    EXPECT_EQ(give(play.state, play.ground, {Type::kUpgrade, 0, {}}), nullptr);
    EXPECT_EQ(play.state.coins, kCoinsAtStart - 210);
    EXPECT_STREQ(give(play.state, play.ground, {Type::kUpgrade, 0, {}}), "not enough coins");
    EXPECT_EQ(give(play.state, play.ground, {Type::kSell, 0, {}}), nullptr);
    EXPECT_EQ(play.state.coins, kCoinsAtStart - 210 + 147);
    EXPECT_EQ(play.state.towers[0].kind, TowerKind::kNone);
}

TEST(GameRules, TowersHaveThreeLevels) {
    Play play;
    play.state.coins = 10000;
    ASSERT_EQ(give(play.state, play.ground, {Type::kPlace, 3, TowerKind::kEmberMortar}), nullptr);
    EXPECT_EQ(give(play.state, play.ground, {Type::kUpgrade, 3, {}}), nullptr);
    EXPECT_EQ(give(play.state, play.ground, {Type::kUpgrade, 3, {}}), nullptr);
    EXPECT_STREQ(give(play.state, play.ground, {Type::kUpgrade, 3, {}}),
                 "it has its highest level");
    EXPECT_EQ(priceOf(play.state.towers[3]), 0);
}

TEST(GameRules, AnEnemyFallsWhenEnoughOfItHasBurnt) {
    Play play;
    const size_t slot = play.first();
    const EnemyRule& rule = kEnemies[size_t(kindOf(slot))];
    play.burning.enemyAlight[slot] = true;
    play.burning.enemyBurnt[slot] = rule.falls - 1;
    play.run(5);
    EXPECT_EQ(play.state.enemies[slot].phase, Phase::kMarches);
    const int32_t coins = play.state.coins;
    play.burning.enemyBurnt[slot] = rule.falls;
    play.run(1);
    EXPECT_EQ(play.state.enemies[slot].phase, Phase::kFalls);
    EXPECT_EQ(play.state.coins, coins + rule.bounty);
    EXPECT_EQ(play.count(Event::Type::kFell), 1u);
}

TEST(GameRules, EnemiesAtTheMillCostLivesAndLoseTheGame) {
    Play play;
    int32_t guard = 100000;
    while (play.state.outcome == Outcome::kPlaying && --guard) play.run(1);
    EXPECT_EQ(play.state.outcome, Outcome::kLost);
    EXPECT_EQ(play.state.lives, 0);
    EXPECT_EQ(play.count(Event::Type::kFell), 0u);
    EXPECT_EQ(play.count(Event::Type::kOver), 1u);
    const uint64_t end = hashOf(play.state);
    play.run(10);
    EXPECT_EQ(hashOf(play.state), end);
}

TEST(GameRules, EveryWaveSpawnsItsListedEnemies) {
    Play play;
    play.burning.enemyBurnt.fill(1000);  // every enemy falls at once
    std::array<int32_t, kEnemyKinds> born{}, named{};
    int32_t guard = 200000;
    while (play.state.outcome == Outcome::kPlaying && --guard) play.run(1);
    ASSERT_EQ(play.state.outcome, Outcome::kWon);
    for (const Event& h : play.events)
        if (h.type == Event::Type::kBorn) ++born[size_t(kindOf(size_t(h.slot)))];
    for (const Wave& wave : kWaves)
        for (size_t k = 0; k < kEnemyKinds; ++k) named[k] += wave.count[k];
    EXPECT_EQ(born, named);
    EXPECT_EQ(play.state.lives, kLivesAtStart);
}

TEST(GameRules, FlamethrowersAimAtUnburntEnemies) {
    Play play;
    play.state.coins = 1000;
    ASSERT_EQ(give(play.state, play.ground, {Type::kPlace, 0, TowerKind::kFlamethrower}), nullptr);
    const size_t ahead = play.first();
    int32_t guard = 1000;
    size_t behind = ahead;
    while (--guard && play.state.enemies[ahead].along < 7000) play.run(1);
    for (size_t i = 0; i < kEnemySlots; ++i)
        if (i != ahead && play.state.enemies[i].phase == Phase::kMarches) behind = i;
    ASSERT_NE(behind, ahead);
    for (size_t i = 0; i < kEnemySlots; ++i)
        if (i != ahead && i != behind) play.state.enemies[i] = {};
    play.state.enemies[behind].along = 5000;
    play.run(1);
    EXPECT_EQ(play.state.towers[0].target, int32_t(ahead));
    play.burning.enemyAlight[ahead] = true;
    play.run(2);
    EXPECT_EQ(play.state.towers[0].target, int32_t(behind));
    play.burning.enemyAlight[behind] = true;  // all burn: back to the foremost
    play.run(2);
    EXPECT_EQ(play.state.towers[0].target, int32_t(ahead));
    EXPECT_GT(play.state.towers[0].streams, 0);
}

TEST(GameRules, EmbersLandAtTheirAimPlusWindDrift) {
    Play play;
    ASSERT_EQ(give(play.state, play.ground, {Type::kPlace, 1, TowerKind::kEmberMortar}), nullptr);
    play.first();
    int32_t guard = 3000;
    while (--guard && play.count(Event::Type::kEmberLands) == 0) play.run(1);
    ASSERT_EQ(play.count(Event::Type::kEmberLands), 1u);
    const Event& landed = play.events.back();
    const auto shot = std::find_if(play.events.begin(), play.events.end(),
                                   [](const Event& h) { return h.type == Event::Type::kShot; });
    EXPECT_EQ(landed.place.x, shot->place.x);
    EXPECT_EQ(landed.place.z, shot->place.z);
    EXPECT_LT(landed.place.z, 700 - 2000 / 8 + 1);  // the wind blows north, across the road
    EXPECT_EQ(landed.strength, 700);
}

TEST(GameRules, WaterGoesToTheHouseThatCanBeSaved) {
    Play play;
    ASSERT_EQ(give(play.state, play.ground, {Type::kPlace, 0, TowerKind::kWaterCannon}), nullptr);
    play.run(50);
    EXPECT_EQ(play.count(Event::Type::kSprays), 0u);
    play.burning.houseAlight[0] = play.burning.houseAlight[1] = true;
    play.burning.houseBurnt[1] = 400;
    play.run(200);
    EXPECT_EQ(play.state.towers[0].target, 0);
    EXPECT_GT(play.count(Event::Type::kSprays), 10u);
    for (const Event& h : play.events) {
        if (h.type != Event::Type::kSprays) continue;
        EXPECT_LT(std::abs(h.place.x), 5000);
        EXPECT_LT(std::abs(h.place.z + 8000), 5000);
    }
}

TEST(GameRules, FansTurnTheWindAndSlowEnemies) {
    Play with, without;
    ASSERT_EQ(give(with.state, with.ground, {Type::kPlace, 0, TowerKind::kWindFan}), nullptr);
    const Point calm = windOf(without.state, without.ground),
                blown = windOf(with.state, with.ground);
    EXPECT_EQ(blown.x, calm.x);
    EXPECT_EQ(blown.z, calm.z - 1200);  // towards the road
    const size_t slot = with.first();
    ASSERT_EQ(without.first(), slot);
    with.run(400);
    without.run(400);
    EXPECT_LT(with.state.enemies[slot].along, without.state.enemies[slot].along - 500);
}

TEST(GameRules, BeamsFallOnceEachWhileARoofBurns) {
    Play play;
    play.burning.houseBurnt[2] = kBeamsFallFrom + kBeamsFallEvery;
    play.run(2);
    EXPECT_EQ(play.count(Event::Type::kBeamFalls), 0u) << "its fire is out";
    Play burns;
    burns.burning.houseAlight[2] = true;
    for (const int32_t burnt : {kBeamsFallFrom - 1, kBeamsFallFrom + kBeamsFallEvery, 1000, 1000}) {
        burns.burning.houseBurnt[2] = burnt;
        burns.run(1);
    }
    std::vector<int32_t> beams;
    for (const Event& h : burns.events)
        if (h.type == Event::Type::kBeamFalls && h.slot == 2) beams.push_back(h.strength);
    ASSERT_EQ(beams.size(), size_t(kBeams));
    for (int32_t i = 0; i < kBeams; ++i) EXPECT_EQ(beams[size_t(i)], i);
}

TEST(GameRules, AFlashoverLightsTheWholeHouseOnceAndIsWateredLast) {
    Play play;
    ASSERT_EQ(give(play.state, play.ground, {Type::kPlace, 0, TowerKind::kWaterCannon}), nullptr);
    play.burning.houseAlight[0] = play.burning.houseAlight[1] = true;
    play.burning.houseBurnt[0] = kBeamsFallFrom;
    play.burning.houseBurnt[1] = kHouseIsLost - 1;
    play.run(1);
    EXPECT_EQ(play.state.towers[0].target, 0);
    const int32_t before = score(play.state);
    play.events.clear();
    play.burning.houseFlashed[0] = true;
    play.run(3);
    EXPECT_EQ(play.count(Event::Type::kFlashesOver), 1u);
    EXPECT_EQ(play.count(Event::Type::kBeamFalls), size_t(kBeams - 1)) << "one beam had fallen";
    EXPECT_EQ(score(play.state), before - kScoreForFlash);
    EXPECT_EQ(play.state.towers[0].target, 1) << "what can be saved comes first";
    play.burning.houseFlashed[0] = false;  // and again: the event comes once
    play.run(1);
    play.burning.houseFlashed[0] = true;
    play.burning.houseBurnt[0] = 1000;
    play.run(1);
    EXPECT_EQ(play.count(Event::Type::kFlashesOver), 1u);
    EXPECT_EQ(play.count(Event::Type::kBeamFalls), size_t(kBeams - 1));
    play.burning.houseAlight[1] = false;  // as the only burning house, it still gets water
    play.run(1);
    EXPECT_EQ(play.state.towers[0].target, 0);
}

TEST(GameRules, HousesAreLostOnceAndCount) {
    Play play;
    const int32_t before = score(play.state);
    play.burning.houseBurnt[4] = kHouseIsLost;
    play.run(3);
    EXPECT_EQ(play.count(Event::Type::kHouseLost), 1u);
    EXPECT_EQ(score(play.state), before - kScorePerHouse);
    EXPECT_EQ(standing(play.state), 1000 - 500 / int32_t(kHouses));
}

// The bot's game with fires that follow a jet: equal for equal seeds, different otherwise.
uint64_t botsGame(uint32_t seed, State* end) {
    Play play;
    play.state = newGame(seed);
    while (play.state.outcome == Outcome::kPlaying && play.state.tick < 60000) {
        give(play.state, play.ground, botsOrder(play.state));
        for (const Event& h : play.events)
            if (h.type == Event::Type::kBorn)
                play.burning.enemyBurnt[size_t(h.slot)] = play.burning.enemyAlight[size_t(h.slot)] =
                    0;
        play.events.clear();
        for (const Tower& tower : play.state.towers)
            if (tower.streams > 0 && tower.target >= 0)
                play.burning.enemyAlight[size_t(tower.target)] = true;
        for (size_t i = 0; i < kEnemySlots; ++i)
            if (play.burning.enemyAlight[i]) play.burning.enemyBurnt[i] += 5;
        play.run(1);
    }
    *end = play.state;
    return hashOf(play.state);
}

TEST(GameRules, TheBotWinsAndItsGameDependsOnItsSeed) {
    State end, again, other;
    const uint64_t hash = botsGame(7, &end);
    EXPECT_EQ(end.outcome, Outcome::kWon);
    EXPECT_GT(end.felled, 40);
    EXPECT_EQ(botsGame(7, &again), hash);
    EXPECT_NE(botsGame(8, &other), hash);
}

TEST(GameRules, ACopyRestoresTheGame) {
    Play play;
    play.first();
    play.run(300);
    const State then = play.state;
    play.run(500);
    const uint64_t end = hashOf(play.state);
    play.state = then;
    play.run(500);
    EXPECT_EQ(hashOf(play.state), end);
}

}  // namespace
