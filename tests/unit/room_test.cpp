// Rooms: containment, oxygen use and recovery, and fire at low oxygen. Integers, so results are
// exact or off by a stated rounding.
#include "components/room.h"
#include "core/error.h"
#include "fire/heat.h"
#include "fire/presets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace fw::test::room_test {
namespace {

constexpr double kWhole = 4294967296.0;

FwRoomDef roomDef(float half, float volume = 0, float vent = 0) {
    FwRoomDef def{};
    def.structSize = sizeof def;
    def.rotation[3] = 1;
    for (float& value : def.halfSize) value = half;
    def.volume = volume;
    def.vent = vent;
    def.oxygen = 0.2095f;
    return def;
}

gpu::RoomAir airOf(uint32_t oxygen, uint32_t epoch) {
    gpu::RoomAir air{};
    air.oxygen = oxygen;
    air.epoch = epoch;
    return air;
}

bool holds(const FwRoomDef& def, float x, float y, float z) {
    const float place[3] = {x, y, z};
    return components::isIn(components::makeRoom(def), components::windPlace(place));
}

TEST(Room, IsAnOrientedBox) {
    FwRoomDef def = roomDef(1);
    def.position[0] = 10;
    def.halfSize[2] = 3;
    EXPECT_TRUE(holds(def, 10.99f, 0.99f, -2.99f));
    EXPECT_FALSE(holds(def, 11.01f, 0, 0));
    EXPECT_FALSE(holds(def, 10, 0, 3.01f));
    EXPECT_FALSE(holds(def, -1e6f, 1e6f, 1e6f));
    def.rotation[1] = def.rotation[3] = std::sqrt(0.5f);  // a quarter about y: z runs along x now
    EXPECT_TRUE(holds(def, 12.9f, 0, 0.9f));
    EXPECT_FALSE(holds(def, 10, 0, 2));
    def.rotation[1] = std::sin(0.3927f), def.rotation[3] = std::cos(0.3927f);  // an eighth
    EXPECT_TRUE(holds(def, 12, 0, 2));
    EXPECT_FALSE(holds(def, 12, 0, -2));
    EXPECT_TRUE(components::makeRoom(def).plausible());
}

// 13.1 MJ consume a kilogram of oxygen, 0.752 m^3.
TEST(Room, FireConsumesOxygen) {
    for (const float volume : {0.1f, 3.0f, 40.0f, 1e6f}) {
        const gpu::Room room = components::roomRecord(components::makeRoom(roomDef(1, volume)), 1,
                                                      airOf(gpu::kAirOutside, 7));
        gpu::RoomAir air{};
        gpu::stepRoomAir(air, room, 0, 0);
        EXPECT_EQ(gpu::kAirOutside, air.oxygen);
        EXPECT_EQ(7u, air.epoch);
        EXPECT_EQ(0u, air.stirs);
        gpu::stepRoomAir(air, room, 0, 0);
        EXPECT_EQ(0u, air.stirs);
        const auto joules = uint32_t(1e5f * volume);
        for (int i = 0; i < 10; ++i) gpu::stepRoomAir(air, room, joules / 10, 0);
        const double taken = double(joules) / 13.1e6 / 1.330 / double(volume);
        EXPECT_NEAR(0.2095 - taken, double(air.oxygen) / kWhole, 3e-5) << volume;
        EXPECT_EQ(joules / 10, air.drawn);
        gpu::stepRoomAir(air, room, 0xFFFFFFFFu, 0);
        if (volume < 1e4f) {
            EXPECT_EQ(0u, air.oxygen);
        }
    }
}

// An open door restores it to the last bit, equally fast at any pace.
TEST(Room, AirRecovers) {
    for (const float pace : {1.0f, 8.0f}) {
        const components::Room made = components::makeRoom(roomDef(1, 10, 0.5f));  // 20 s
        const gpu::Room room =
            components::roomRecord(made, pace, airOf(uint32_t(0.10 * kWhole), 1));
        gpu::RoomAir air{};
        const int after = int(20 * 8 / pace);
        for (int i = 0; i < after; ++i) gpu::stepRoomAir(air, room, 0, 0);
        EXPECT_NEAR(0.2095 - 0.1095 * std::exp(-1), double(air.oxygen) / kWhole, 1.5e-3);
        for (int i = 0; i < after * 30; ++i) gpu::stepRoomAir(air, room, 0, 0);
        EXPECT_EQ(gpu::kAirOutside, air.oxygen);
        EXPECT_EQ(0u, air.stirs);
    }
    const gpu::Room rich = components::roomRecord(components::makeRoom(roomDef(1, 1, 1e4f)), 100,
                                                  airOf(uint32_t(0.9 * kWhole), 1));
    gpu::RoomAir air{};
    for (int i = 0; i < 4; ++i) gpu::stepRoomAir(air, rich, 0, 0);
    EXPECT_NEAR(0.2095, double(air.oxygen) / kWhole, 1e-6);
    EXPECT_GE(air.oxygen, gpu::kAirOutside);
}

// Thomas (1981): 7.8 kW per m^2 of its sides, 378 kW per m^2.5 of A sqrt(h).
TEST(Room, FlashesOverAtThomasPower) {
    FwRoomDef def = roomDef(1);
    def.halfSize[0] = 2, def.halfSize[1] = 1.25f, def.halfSize[2] = 2.5f;
    EXPECT_EQ(7800u * 85, components::makeRoom(def).flashPower());
    def.vent = 0.4f * 2 * std::sqrt(2.0f);  // a door of 1 m by 2 m
    EXPECT_NEAR(7800.0 * 85 + 378000 * 2 * std::sqrt(2), components::makeRoom(def).flashPower(),
                1000);
    for (float& half : def.halfSize) half = 1000;
    def.volume = 1e6f;
    EXPECT_EQ(0u, components::roomRecord(components::makeRoom(def), 1, airOf(0, 1)).flashes);
}

TEST(Room, FlashesOverAgainOnlyBelowHalfThePower) {
    gpu::Room room{};
    room.epoch = 1;
    room.flashes = 1000;
    gpu::RoomAir air{};
    uint32_t now = 0;
    const auto burn = [&](uint32_t joules, int periods) {
        for (int i = 0; i < periods; ++i) {
            now += gpu::kRoomPeriod;
            gpu::stepRoomAir(air, room, joules, now);
        }
    };
    burn(990, 400);  // never reaches the power
    EXPECT_EQ(0u, air.flash);
    burn(1010, 400);
    EXPECT_EQ(1u, air.flash);
    const uint32_t when = air.flashTick;
    EXPECT_LT(when, now);
    burn(700, 400);  // less, but above half of it
    burn(1100, 400);
    EXPECT_EQ(1u, air.flash);
    EXPECT_EQ(when, air.flashTick);
    burn(400, 400);
    EXPECT_EQ(2u, air.flash);
    burn(900, 400);
    EXPECT_EQ(2u, air.flash);
    burn(1500, 1);  // a single flare does not count, two do
    EXPECT_EQ(2u, air.flash);
    burn(1500, 1);
    EXPECT_EQ(3u, air.flash);
    EXPECT_EQ(now, air.flashTick);
    burn(0, 10000);  // and it ends
    EXPECT_EQ(0u, air.power);
    EXPECT_EQ(0u, air.stirs);
    EXPECT_EQ(4u, air.flash);
    burn(0xFFFFFFFFu, 10000);  // extreme values do not wrap
    EXPECT_EQ(5u, air.flash);
    EXPECT_GT(air.power, gpu::kMaxFlash * 6);
    room.power = 7 * 900, room.flash = 5, room.epoch = 2;  // as a save holds it
    burn(900, 1);
    EXPECT_EQ(5u, air.flash);
    EXPECT_NEAR(7 * 900, air.power, 8);
    room.flashes = 0;
    burn(0, 1);
    EXPECT_EQ(6u, air.flash);
    burn(0xFFFFFFFFu, 100);
    EXPECT_EQ(6u, air.flash);
}

TEST(Room, FlameStrengthFallsLinearlyFrom15To12Percent) {
    const auto at = [](double part) { return gpu::burnStrengthOfOxygen(uint32_t(part * kWhole)); };
    EXPECT_EQ(256u, at(0.2095));
    EXPECT_EQ(256u, at(0.1501));
    EXPECT_EQ(192u, at(0.142501));
    EXPECT_EQ(128u, at(0.135001));
    EXPECT_EQ(0u, at(0.12));
    EXPECT_EQ(0u, at(0));
    uint32_t before = 0;
    for (uint32_t air = 0; air < 0xFFF00000u; air += 100000) {
        EXPECT_LE(before, gpu::burnStrengthOfOxygen(air));
        EXPECT_LE(gpu::burnStrengthOfOxygen(air), before + 1);
        before = gpu::burnStrengthOfOxygen(air);
    }
    EXPECT_EQ(256u, gpu::airStrength(0));  // in no room
    EXPECT_EQ(0u, gpu::airStrength(gpu::kAirKnown));
    EXPECT_EQ(256u, gpu::airStrength(0xFFFFFFFFu));
}

TEST(Room, ConservesEnergyBetweenPeriods) {
    uint32_t drawnLow = 5, drawnHigh = 0;
    uint64_t energy = 5, joules = 0;
    uint32_t draw = 1;
    for (int i = 0; i < 4000; ++i) {
        draw = gpu::hash32(draw + uint32_t(i));
        energy += i % 3 == 0 ? uint64_t(draw) * 200 : draw >> 12;
        joules +=
            gpu::takeWholeJoules(uint32_t(energy), uint32_t(energy >> 32), drawnLow, drawnHigh);
        const uint64_t drawn = uint64_t(drawnHigh) << 32 | drawnLow;
        ASSERT_EQ(joules << 20, drawn - 5);
        ASSERT_LT(energy - drawn, 1u << 20);
    }
    EXPECT_GT(joules, 1u << 20);
}

// A texel that burns at constant strength until it ends.
struct Burn {
    gpu::HeatMaterial material;
    gpu::HeatTexel texel;
    uint32_t state = 0, now = 0;
    uint32_t burnt = 0;

    explicit Burn(uint32_t preset) {
        material = fire::heatMaterial(fire::presetDef(preset), {1e-4f, 1, 0});
        texel = gpu::unheatedTexel(material, true);
    }
    void step(uint32_t strength) {
        uint32_t units = 0;
        state = gpu::heatTexelStep(texel, gpu::materialInAir(material, strength), state, now, 20000,
                                   true, 256, gpu::hash32(now), units);
        burnt += units;
        now += gpu::kRoomPeriod;
    }
    bool burns() const { return gpu::isSource(state) && texel.phase == gpu::kPhaseBurning; }
};

// A sheet at half strength burns twice as long and releases all of its fuel.
TEST(Room, ThinFuelBurnsSlowerInThinAir) {
    Burn well(FW_MATERIAL_PAPER), little(FW_MATERIAL_PAPER);
    int steps[2] = {};
    for (int k = 0; k < 2; ++k) {
        Burn& burn = k == 0 ? well : little;
        do burn.step(k == 0 ? 256 : 128);
        while (burn.burns() && ++steps[k] < 10000);
        EXPECT_EQ(gpu::kPhaseBurnt, burn.texel.phase);
        EXPECT_EQ(gpu::kFuelFull, burn.burnt);
    }
    EXPECT_GT(steps[0], 8);
    EXPECT_NEAR(2 * steps[0], steps[1], 2);
    // A burn that begins in thin air continues when air returns.
    Burn opened(FW_MATERIAL_PAPER);
    for (int i = 0; i < steps[0]; ++i) opened.step(128);
    const uint32_t left = opened.texel.fuel;
    EXPECT_NEAR(0.5 * gpu::kFuelFull, left, 0.03 * gpu::kFuelFull);
    opened.step(256);
    EXPECT_LT(left - opened.texel.fuel, gpu::kFuelFull / uint32_t(steps[0]) * 2);
    for (int i = 0; i < steps[0] / 2 + 2; ++i) opened.step(256);
    EXPECT_EQ(gpu::kPhaseBurnt, opened.texel.phase);
}

TEST(Room, WoodReleasesLessAndGoesOutWithoutAir) {
    uint32_t burnt[3] = {};
    for (const uint32_t strength : {256u, 128u, 0u}) {
        Burn burn(FW_MATERIAL_PINE);
        for (int i = 0; i < 240; ++i) burn.step(256);
        ASSERT_TRUE(burn.burns());
        const uint32_t before = burn.burnt;
        for (int i = 0; i < 80; ++i) burn.step(strength);
        burnt[strength / 128] = burn.burnt - before;
        EXPECT_EQ(strength != 0, burn.burns());
        if (strength != 0) continue;
        EXPECT_EQ(gpu::kPhaseOut, burn.texel.phase);
        EXPECT_EQ(gpu::kOut, burn.state);
        burn.step(256);  // hot enough, it reignites
        EXPECT_TRUE(burn.burns());
        for (int i = 0; i < 80; ++i) burn.step(256);
        EXPECT_TRUE(burn.burns());
        EXPECT_GT(burn.burnt, before);
    }
    EXPECT_EQ(0u, burnt[0]);
    EXPECT_GT(burnt[1], burnt[2] / 4);
    EXPECT_LT(burnt[1], burnt[2] * 3 / 5);
}

TEST(Room, RefusesBadDefsByName) {
    const auto message = [](const FwRoomDef& def) -> std::string {
        try {
            (void)components::makeRoom(def);
        } catch (const core::Error& error) {
            return error.message;
        }
        return "";
    };
    EXPECT_EQ("", message(roomDef(1)));
    FwRoomDef def = roomDef(1);
    def.flags = 6;
    EXPECT_EQ(
        "FwRoomDef::flags is 0x6 and reserved is 0; the known flags are 0x1, and reserved is zero.",
        message(def));
    def = roomDef(1);
    def.halfSize[1] = 0.01f;
    EXPECT_EQ("FwRoomDef::halfSize[1] is 0.01; the limits are [0.05, 1000].", message(def));
    EXPECT_EQ("FwRoomDef::volume is 0 m^3 and its box has 0.064; the limits are [0.1, 1e+06].",
              message(roomDef(0.2f)));
    EXPECT_EQ("", message(roomDef(0.2f, 0.1f)));
    EXPECT_NE("", message(roomDef(1000)));
    def = roomDef(1);
    def.vent = -1;
    EXPECT_EQ("FwRoomDef::vent is -1; the limits are [0, 10000].", message(def));
    def = roomDef(1);
    def.oxygen = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NE(std::string::npos, message(def).find("FwRoomDef::oxygen is "));
    def = roomDef(1);
    def.rotation[0] = 1;
    EXPECT_NE(std::string::npos, message(def).find("FwRoomDef::rotation has length 1.41421;"));
    components::Room room = components::makeRoom(roomDef(1));
    room.volume = 0;
    EXPECT_FALSE(room.plausible());
}

}  // namespace
}  // namespace fw::test::room_test
