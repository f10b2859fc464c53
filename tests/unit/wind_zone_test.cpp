// Wind zones: place, flow, fade and priority. Integers, so results are exact or off by a stated
// rounding.
#include "components/wind_zone.h"
#include "core/error.h"
#include "shared/burn.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace fw::test {
namespace {

using components::makeWindZone;
using components::WindZone;
using fire::WindVector;

FwWindZoneDef zoneDef(uint32_t shape, uint32_t flow, float size) {
    FwWindZoneDef def{};
    def.structSize = sizeof def;
    def.shape = shape;
    def.flow = flow;
    def.axis[0] = 1;
    for (float& value : def.size) value = size;
    def.speed = 10;
    return def;
}

WindVector blows(const std::vector<WindZone>& zones, float x, float y, float z,
                 const WindVector& around = {}) {
    const float place[3] = {x, y, z};
    return components::windIn(zones, around, components::windPlace(place));
}

void near(const WindVector& wind, float x, float y, float z) {
    const float expected[3] = {x, y, z};
    for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(expected[i] * 128, float(wind[i]), 2) << i;
}

TEST(WindZone, ABoxBlowsAlongItsAxisUpToItsEdge) {
    FwWindZoneDef def = zoneDef(FW_WIND_BOX, FW_WIND_ALONG, 2);
    def.position[1] = 5;
    def.axis[0] = 3;
    def.axis[2] = 4;  // of any length
    const std::vector<WindZone> zones{makeWindZone(def)};
    near(blows(zones, 0, 5, 0), 6, 0, 8);
    near(blows(zones, 1.99f, 5, 0), 6, 0, 8);
    EXPECT_EQ(WindVector{}, blows(zones, 2.001f, 5, 0));
    EXPECT_EQ(WindVector{}, blows(zones, 0, 2.9f, 0));
    EXPECT_EQ(WindVector{}, blows(zones, 1e6f, -1e6f, 1e6f));
}

TEST(WindZone, FadesOverItsLastPart) {
    FwWindZoneDef def = zoneDef(FW_WIND_SPHERE, FW_WIND_ALONG, 4);
    def.falloff = 0.5f;
    const std::vector<WindZone> zones{makeWindZone(def)};
    near(blows(zones, 0, 1.9f, 0), 10, 0, 0);
    near(blows(zones, 0, 3, 0), 5, 0, 0);
    near(blows(zones, 0, 0, -3.5f), 2.5f, 0, 0);
    EXPECT_EQ(WindVector{}, blows(zones, 0, 4, 0));
    float before = 11;
    for (float y = 0; y < 4; y += 0.01f) {  // without jumps
        const float now = float(blows(zones, 0, y, 0)[0]) / 128;
        EXPECT_LE(now, before);
        EXPECT_TRUE(before > 10.5f || before - now < 0.1f);
        before = now;
    }
}

TEST(WindZone, RadialBlowsOutwardsAndVortexAround) {
    FwWindZoneDef def = zoneDef(FW_WIND_SPHERE, FW_WIND_RADIAL, 10);
    near(blows({makeWindZone(def)}, 3, 0, 4), 6, 0, 8);
    EXPECT_EQ(WindVector{}, blows({makeWindZone(def)}, 0, 0, 0));
    def.speed = -10;
    near(blows({makeWindZone(def)}, 3, 0, 4), -6, 0, -8);
    def.speed = 10;
    def.flow = FW_WIND_VORTEX;
    def.axis[0] = 0;
    def.axis[1] = 1;
    near(blows({makeWindZone(def)}, 2, 1, 0), 0, 0, -10);
    near(blows({makeWindZone(def)}, 0, -1, 2), 10, 0, 0);
    EXPECT_EQ(WindVector{}, blows({makeWindZone(def)}, 0, 3, 0));
}

TEST(WindZone, AFanIsACone) {
    FwWindZoneDef def = zoneDef(FW_WIND_CONE, FW_WIND_ALONG, 0);
    def.size[0] = 10;
    def.size[1] = 2;
    std::vector<WindZone> zones{makeWindZone(def)};
    near(blows(zones, 5, 0.9f, 0), 10, 0, 0);
    EXPECT_EQ(WindVector{}, blows(zones, 5, 1.1f, 0));
    EXPECT_EQ(WindVector{}, blows(zones, -0.1f, 0, 0));
    EXPECT_EQ(WindVector{}, blows(zones, 10.1f, 0, 0));
    def.flow = FW_WIND_RADIAL;
    def.falloff = 1;
    zones = {makeWindZone(def)};
    EXPECT_GT(blows(zones, 2, 0.1f, 0)[0], 2 * blows(zones, 8, 0.1f, 0)[0]);
    EXPECT_GT(blows(zones, 5, 0.5f, 0)[1], 0);
    EXPECT_LT(blows(zones, 5, -0.5f, 0)[1], 0);
}

TEST(WindZone, AppliesHigherPrioritiesLater) {
    FwWindZoneDef add = zoneDef(FW_WIND_BOX, FW_WIND_ALONG, 5);
    FwWindZoneDef shelter = add;
    shelter.blend = FW_WIND_REPLACE;
    shelter.speed = 0;
    const WindVector around{0, 0, 256};
    std::vector<WindZone> zones{makeWindZone(shelter), makeWindZone(add)};
    near(blows(zones, 0, 0, 0, around), 10, 0, 0);  // shelter, then a wind inside it
    zones[0].priority = 1;
    components::sortWindZones(zones);
    EXPECT_EQ(WindVector{}, blows(zones, 0, 0, 0, around));
    EXPECT_EQ(around, blows(zones, 6, 0, 0, around));
    shelter.falloff = 1;
    shelter.priority = 1;
    near(blows({makeWindZone(add), makeWindZone(shelter)}, 2.5f, 0, 0, around), 5, 0, 1);
    // Equal priorities apply in list order.
    add.speed = 5;
    std::vector<WindZone> same{makeWindZone(add), makeWindZone(shelter), makeWindZone(add)};
    same[1].priority = 0;
    const std::vector<WindZone> listed = same;
    components::sortWindZones(same);
    EXPECT_EQ(listed, same);
}

TEST(WindZone, SumsStayWithinLimits) {
    std::vector<WindZone> zones;
    FwWindZoneDef def = zoneDef(FW_WIND_SPHERE, FW_WIND_ALONG, 1000);
    def.speed = 120;
    for (int i = 0; i < 64; ++i) zones.push_back(makeWindZone(def));
    EXPECT_EQ(120 * 128, blows(zones, 999, 0, 0, {120 * 128, 0, 0})[0]);
    for (WindZone& zone : zones) zone.speed = -zone.speed;
    EXPECT_EQ(-120 * 128, blows(zones, 0, -999, 0)[0]);
    for (uint32_t shape = 0; shape < FW_WIND_SHAPE_COUNT; ++shape)
        for (uint32_t flow = 0; flow < FW_WIND_FLOW_COUNT; ++flow)
            for (const float size : {0.01f, 1000.0f})
                for (const float at : {0.0f, 0.001f, 1e6f, -1e6f}) {
                    FwWindZoneDef most = zoneDef(shape, flow, size);
                    most.falloff = 1e-6f;
                    most.position[0] = at;
                    const WindZone zone = makeWindZone(most);
                    EXPECT_TRUE(zone.plausible());
                    for (const float x : {at, at + 1, -at})
                        for (const int32_t v : blows({zone}, x, size / 2, -size / 3))
                            EXPECT_LE(std::abs(v), 10 * 128 + 1);
                }
}

TEST(WindZone, PackingIsExactToAnEighth) {
    EXPECT_EQ(0u, components::packWind({}));
    EXPECT_EQ(0u, components::packWind({15, -15, 8}));
    for (int32_t v = -120 * 128; v <= 120 * 128; v += 37) {
        const gpu::ivec3 got = gpu::unpackWind(components::packWind({v, -v, v / 2}));
        EXPECT_NEAR(v / 128.0 * 1000, got.x, 126);
        EXPECT_NEAR(-v / 128.0 * 1000, got.y, 126);
        EXPECT_NEAR(v / 256.0 * 1000, got.z, 130);
    }
    EXPECT_EQ(gpu::ivec3(0, 0, 0), gpu::unpackWind(0));
}

TEST(WindZone, RefusesBadDefsByName) {
    const auto message = [](const FwWindZoneDef& def) -> std::string {
        try {
            (void)makeWindZone(def);
        } catch (const core::Error& error) {
            return error.message;
        }
        return "";
    };
    const FwWindZoneDef good = zoneDef(FW_WIND_BOX, FW_WIND_ALONG, 1);
    EXPECT_EQ("", message(good));
    FwWindZoneDef def = good;
    def.shape = 3;
    EXPECT_EQ("FwWindZoneDef::shape is 3; the limit is 2.", message(def));
    def = good;
    def.flow = 9;
    EXPECT_EQ("FwWindZoneDef::flow is 9; the limit is 2.", message(def));
    def = good;
    def.blend = 2;
    EXPECT_EQ("FwWindZoneDef::blend is 2; the limit is 1.", message(def));
    def = good;
    def.priority = 1001;
    EXPECT_EQ("FwWindZoneDef::priority is 1001; the limits are [-1000, 1000].", message(def));
    def = good;
    def.size[2] = 0;
    EXPECT_EQ("FwWindZoneDef::size[2] is 0; the limits are [0.01, 1000].", message(def));
    def.shape = FW_WIND_CONE;  // a cone has only two
    EXPECT_EQ("", message(def));
    def = good;
    def.axis[0] = 0;
    EXPECT_EQ("FwWindZoneDef::axis has a length of 0; it is a direction.", message(def));
    def = good;
    def.speed = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NE(std::string::npos, message(def).find("FwWindZoneDef::speed is ")) << message(def);
    def = good;
    def.falloff = 1.5f;
    EXPECT_EQ("FwWindZoneDef::falloff is 1.5; the limits are [0, 1].", message(def));
    def = good;
    def.flags = 1;
    EXPECT_EQ("FwWindZoneDef::flags is 0x1 and reserved is 0; both are zero.", message(def));
}

}  // namespace
}  // namespace fw::test
