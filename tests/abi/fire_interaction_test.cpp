// Volumetric fires and a game, on the cpu backend: colliders, scripts, profiles, queries, pushes,
// neighbours, and ignition of objects.
#include "abi/fire_world.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace {

using host::created;
using host::FireWorld;
using host::getState;
using host::lastMessage;
using host::presetDef;
using ::testing::HasSubstr;

FwFireColliderId add(FireWorld& w, const FwFireColliderDef& def) {
    return created(fwWorld_AddFireCollider, w.world, def);
}

FwFireSample ask(FireWorld& w, float x, float y, float z) {
    const float point[3] = {x, y, z};
    return getState(fwWorld_SampleVolumetricFires, w.world, point);
}

// One collider of each kind, each with its lowest point 0.4 m above the base.
struct Shape {
    const char* name;
    FwFireColliderDef def;
};
float ceilingDistance(void*, const float point[3], float normal[3]) {
    normal[0] = normal[2] = 0;
    normal[1] = -1;
    return 0.4f - point[1];
}
// The same ceiling as seen by a camera 0.2 m above the ground, 2 m in front of the fire.
FwFireColliderDef ceilingSeen() {
    constexpr uint32_t kColumns = 64, kRows = 48;
    static const std::vector<float> depths = [] {
        std::vector<float> all;
        for (uint32_t row = 0; row < kRows; ++row) {
            const float y = 1 - (float(row) + 0.5f) / kRows * 2;  // m up per m ahead
            all.insert(all.end(), kColumns, y > 0 ? 1 - 0.01f * y / 0.2f : 1.0f);
        }
        return all;
    }();
    FwFireColliderDef def = fwDefaultFireColliderDef();
    def.kind = FW_COLLIDER_DEPTH;
    def.columns = kColumns;
    def.rows = kRows;
    def.depths = depths.data();
    def.view[13] = -0.2f;
    def.view[14] = -2;
    def.projection[0] = float(kRows) / kColumns;
    def.projection[5] = -1;
    def.projection[10] = def.projection[11] = -1;
    def.projection[14] = -0.01f;
    def.projection[15] = 0;
    return def;
}
std::vector<Shape> shapesAbove() {
    std::vector<Shape> all;
    const auto made = [&](const char* name, FwFireColliderKind kind) -> FwFireColliderDef& {
        all.push_back({name, fwDefaultFireColliderDef()});
        all.back().def.kind = kind;
        return all.back().def;
    };
    made("sphere", FW_COLLIDER_SPHERE).position[1] = 0.9f;
    FwFireColliderDef& capsule = made("capsule", FW_COLLIDER_CAPSULE);
    capsule.position[0] = -1;
    capsule.end[0] = 1;
    capsule.position[1] = capsule.end[1] = 0.9f;
    FwFireColliderDef& box = made("box", FW_COLLIDER_BOX);
    box.position[1] = 0.5f;
    box.halfSize[0] = box.halfSize[2] = 2;
    box.halfSize[1] = 0.1f;
    FwFireColliderDef& plane = made("plane", FW_COLLIDER_PLANE);
    plane.position[1] = 0.4f;
    plane.normal[1] = -1;
    made("distance", FW_COLLIDER_DISTANCE).distance = &ceilingDistance;
    all.push_back({"depth", ceilingSeen()});
    return all;
}

TEST(FireInteraction, FlamesGoAroundColliders) {
    FireWorld free;
    const FwVolumetricFireId alone = free.make(fwDefaultVolumetricFireDef());
    free.run(2);
    const FwVolumetricFireState before = free.state(alone);
    EXPECT_EQ(0.0f, before.contactPower);
    EXPECT_GT(before.tip[1], 0.5f);
    for (const Shape& shape : shapesAbove()) {
        FireWorld w;
        const FwFireColliderId id = add(w, shape.def);
        const FwVolumetricFireId fire = w.make(fwDefaultVolumetricFireDef());
        w.run(2);
        const FwVolumetricFireState state = w.state(fire);
        EXPECT_GT(state.contactPower, 1.0f) << shape.name;
        EXPECT_LE(state.contactPower, state.power) << shape.name;
        EXPECT_NEAR(state.contact[1], 0.4f, 0.2f) << shape.name;
        // Around a ball the tip may regain its height, but it has moved aside.
        const float aside = std::hypot(state.tip[0], state.tip[2]);
        EXPECT_TRUE(aside > 0.1f || state.tip[1] < 0.45f)
            << shape.name << ": " << aside << " m aside, " << state.tip[1] << " m high";
        // Without the collider it recovers.
        EXPECT_EQ(FW_OK, fwWorld_RemoveFireCollider(w.world, id));
        w.run(2);
        EXPECT_EQ(0.0f, w.state(fire).contactPower) << shape.name;
        EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_RemoveFireCollider(w.world, id));
    }
}

TEST(FireInteraction, CollidesWithHeightfieldsAndOccluders) {
    // A slope east of the fire with wind onto it: the flame climbs it.
    std::vector<float> heights;
    for (int z = 0; z < 9; ++z)
        for (int x = 0; x < 9; ++x) heights.push_back(std::max(0.0f, float(x - 4)));
    FireWorld flat(4), hill(4);
    FwFireColliderDef def = fwDefaultFireColliderDef();
    def.kind = FW_COLLIDER_HEIGHT_FIELD;
    def.position[0] = def.position[2] = -2;
    def.cellSize = 0.5f;
    def.columns = def.rows = 9;
    def.heights = heights.data();
    const FwFireColliderId id = add(hill, def);
    std::fill(heights.begin(), heights.end(), NAN);  // copied
    const FwVolumetricFireId a = flat.make(fwDefaultVolumetricFireDef());
    const FwVolumetricFireId b = hill.make(fwDefaultVolumetricFireDef());
    flat.run(2);
    hill.run(2);
    EXPECT_GT(hill.state(b).tip[1], flat.state(a).tip[1] + 0.05f);
    float most = 0;  // it slides along and touches now and then
    for (int k = 0; k < 64; ++k) {
        hill.run(1.0f / 32);
        most = std::max(most, hill.state(b).contactPower);
    }
    EXPECT_GT(most, 0.0f);
    def.heights = nullptr;  // moved; keeps its heights
    def.position[0] = 20;
    EXPECT_EQ(FW_OK, fwWorld_SetFireCollider(hill.world, id, &def)) << lastMessage(hill.world);
    hill.run(2);
    EXPECT_EQ(0.0f, hill.state(b).contactPower);
    def.columns = 8;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SetFireCollider(hill.world, id, &def));
    EXPECT_THAT(lastMessage(hill.world), HasSubstr("FwFireColliderDef::heights is null"));

    FireWorld w;
    FwHeatOccluderDef occluder =
        fwDefaultHeatOccluderDef();  // turned a quarter about z: its x is up
    const float turned[16] = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0.5f, 0, 1};
    std::copy_n(turned, 16, occluder.transform);
    occluder.halfSize[0] = 0.1f;
    occluder.halfSize[1] = occluder.halfSize[2] = 2;
    const FwHeatOccluderId wall = created(fwWorld_AddHeatOccluder, w.world, occluder);
    FwVolumetricFireDef fire = fwDefaultVolumetricFireDef();
    const FwVolumetricFireId under = w.make(fire);
    fire.flags = FW_FIRE_NO_COLLISION;
    fire.position[0] = 40;
    const FwVolumetricFireId through = w.make(fire);
    const float there[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 40, 0.5f, 0, 1};
    w.run(1);
    EXPECT_GT(w.state(under).contactPower, 1.0f);
    EXPECT_EQ(FW_OK, fwWorld_MoveHeatOccluder(w.world, wall, there));
    w.run(2);
    EXPECT_EQ(0.0f, w.state(under).contactPower);
    EXPECT_EQ(0.0f, w.state(through).contactPower);
}

// A depth image of a wall bends flames and does nothing else. A new one each frame allocates
// nothing.
TEST(FireInteraction, DepthCollidersAffectFlamesOnly) {
    FireWorld w;
    const FwVolumetricFireId fire = w.make(fwDefaultVolumetricFireDef());
    w.run(1);
    FwFireColliderDef def = fwDefaultFireColliderDef();  // a wall 1.2 m beside the fire
    const float heat = ask(w, 1.6f, 0.3f, 0).heatFlux;
    EXPECT_GT(heat, 10.0f);
    def.kind = FW_COLLIDER_BOX;
    def.position[0] = 1.2f;
    def.halfSize[0] = 0.02f;
    def.halfSize[1] = def.halfSize[2] = 5;
    const FwFireColliderId wall = add(w, def);
    EXPECT_LT(ask(w, 1.6f, 0.3f, 0).heatFlux, 0.9f * heat) << "the wall must make a difference";
    EXPECT_EQ(FW_OK, fwWorld_RemoveFireCollider(w.world, wall));
    def = ceilingSeen();
    const FwFireColliderId seen = add(w, def);
    const float above = 1.5f;
    const float there = ask(w, 0, above, 0).heatFlux;
    EXPECT_GT(there, 10.0f) << "a depth collider does not block radiation";
    const int64_t before = w.host.allocations;
    for (int k = 0; k < 16; ++k) {
        def.view[14] = -2 - 0.01f * float(k);
        EXPECT_EQ(FW_OK, fwWorld_SetFireCollider(w.world, seen, &def));
        w.run(1.0f / 32);
    }
    EXPECT_EQ(before, w.host.allocations);
    EXPECT_GT(w.state(fire).contactPower, 0.0f);
}

TEST(FireInteraction, RefusesInvalidColliders) {
    FireWorld w;
    FwFireColliderId id{};
    const auto refused = [&](const FwFireColliderDef& def, const char* text) {
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_AddFireCollider(w.world, &def, &id));
        EXPECT_THAT(lastMessage(w.world), HasSubstr(text));
    };
    FwFireColliderDef def = fwDefaultFireColliderDef();
    def.kind = 7;
    refused(def, "kind is 7; the limits are [0, 6]");
    def = fwDefaultFireColliderDef();
    def.radius = 0;
    refused(def, "radius is 0");
    def.kind = FW_COLLIDER_BOX;
    def.rotation[3] = 0.5f;
    refused(def, "rotation of the box");
    def = fwDefaultFireColliderDef();
    def.kind = FW_COLLIDER_PLANE;
    def.normal[1] = 0;
    refused(def, "normal of the plane");
    def.kind = FW_COLLIDER_DISTANCE;
    refused(def, "distance is null");
    def.kind = FW_COLLIDER_HEIGHT_FIELD;
    refused(def, "0 columns and 0 rows");
    def.columns = def.rows = 2;
    refused(def, "heights is null");
    const float heights[4] = {0, 0, INFINITY, 0};
    def.heights = heights;
    refused(def, "heights[2] is inf");
    def = ceilingSeen();
    def.depths = nullptr;
    refused(def, "depths is null");
    def = ceilingSeen();
    def.columns = 513;
    refused(def, "513 columns and 48 rows; the limits are [2, 512]");
    def = ceilingSeen();
    def.radius = 0;
    refused(def, "radius is 0");
    def = ceilingSeen();
    def.projection[3] = NAN;
    refused(def, "projection[3] is nan");
    def = ceilingSeen();
    std::fill_n(def.projection, 16, 0.0f);
    refused(def, "have no inverse");
    def = ceilingSeen();
    const std::vector<float> far(size_t{64} * 48, 1.5f);
    def.depths = far.data();
    refused(def, "depths[0] is 1.5");
    def = fwDefaultFireColliderDef();
    def.position[2] = NAN;
    refused(def, "position[2] is nan");
    def = fwDefaultFireColliderDef();
    for (int i = 0; i < 64; ++i) (void)add(w, def);
    refused(def, "64 fire colliders");
}

TEST(FireInteraction, FollowsAScriptAndReturns) {
    FireWorld w;
    FwVolumetricFireDef fire = fwDefaultVolumetricFireDef();
    fire.position[0] = 5;
    fire.blend = 0.5f;
    const FwVolumetricFireId id = w.make(fire);
    w.run(1);
    EXPECT_NEAR(w.state(id).tip[0], 5, 0.15f);
    // To the east in the first second, to the west in the next.
    std::vector<FwFirePoint> points;
    for (const float side : {1.0f, -1.0f, 1.0f})
        for (int i = 0; i < 3; ++i) points.push_back({{side * 0.6f * float(i), 0.2f, 0}, 0.2f});
    const float times[3] = {0, 1, 2};
    FwFireTrackDef track = fwDefaultFireTrackDef();
    track.keyCount = track.pointsPerKey = 3;
    track.flags = FW_FIRE_TRACK_LOOP;
    track.times = times;
    track.points = points.data();
    ASSERT_EQ(FW_OK, fwWorld_SetVolumetricFireTrack(w.world, id, &track)) << lastMessage(w.world);
    w.run(0.125f);
    EXPECT_LT(w.state(id).tip[0], 5.7f) << "it blends";
    w.run(0.875f);
    EXPECT_NEAR(w.state(id).tip[0], 5 - 1.2f, 0.15f);
    w.run(1);
    EXPECT_NEAR(w.state(id).tip[0], 5 + 1.2f, 0.15f);
    EXPECT_NEAR(w.state(id).height, 1.2f, 0.05f) << "as high as its path is long";
    w.run(1);
    EXPECT_NEAR(w.state(id).tip[0], 5 - 1.2f, 0.15f) << "it loops";
    // Half weight: between its own motion and the script.
    track.weight = 0.5f;
    ASSERT_EQ(FW_OK, fwWorld_SetVolumetricFireTrack(w.world, id, &track));
    w.run(2);
    EXPECT_GT(w.state(id).tip[0], 5.2f);
    EXPECT_LT(w.state(id).tip[0], 5.9f);
    ASSERT_EQ(FW_OK, fwWorld_SetVolumetricFireTrack(w.world, id, nullptr));
    const float from = w.state(id).tip[0];
    w.run(1.0f / 32);
    EXPECT_NEAR(w.state(id).tip[0], from, 0.1f) << "no jump";
    w.run(3);
    EXPECT_NEAR(w.state(id).tip[0], 5, 0.15f);
    const auto refused = [&](const FwFireTrackDef& def, const char* text) {
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SetVolumetricFireTrack(w.world, id, &def));
        EXPECT_THAT(lastMessage(w.world), HasSubstr(text));
    };
    track = fwDefaultFireTrackDef();
    refused(track, "keyCount is 0; the limits are [1, 4096]");
    track.keyCount = 1;
    refused(track, "pointsPerKey is 0; the limits are [2, 32]");
    track.pointsPerKey = 2;
    refused(track, "times is null");
    track.times = times;
    refused(track, "points is null");
    track.points = points.data();
    track.weight = 2;
    refused(track, "weight is 2");
    track.weight = 1;
    track.keyCount = 2;
    const float backwards[2] = {1, 1};
    track.times = backwards;
    refused(track, "time of key 1 is 1");
}

TEST(FireInteraction, UsesTheHostsProfile) {
    FireWorld w;
    std::vector<float> texels;  // emits in the lower half only
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 8; ++x) {
            texels.push_back(1500);
            texels.push_back(y < 8 ? 1.0f : 0.0f);
        }
    FwFireProfileDef def = fwDefaultFireProfileDef();
    def.width = 8;
    def.height = 16;
    def.texels = texels.data();
    FwFireProfileId painted{}, cooked{};
    ASSERT_EQ(FW_OK, fwWorld_CreateFireProfile(w.world, &def, &painted)) << lastMessage(w.world);
    uint64_t size = 0;
    ASSERT_EQ(FW_OK, fwCookFireProfile(w.context, &def, nullptr, &size));
    std::vector<unsigned char> bytes(size);
    --size;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwCookFireProfile(w.context, &def, bytes.data(), &size));
    size = bytes.size();
    ASSERT_EQ(FW_OK, fwCookFireProfile(w.context, &def, bytes.data(), &size));
    FwFireProfileDef again = fwDefaultFireProfileDef();
    again.cooked = bytes.data();
    again.cookedSize = bytes.size();
    ASSERT_EQ(FW_OK, fwWorld_CreateFireProfile(w.world, &again, &cooked)) << lastMessage(w.world);

    const FwVolumetricFireId preset = w.make(fwDefaultVolumetricFireDef());
    FwVolumetricFireDef fire = fwDefaultVolumetricFireDef();
    fire.profile = painted;
    fire.position[0] = 50;
    const FwVolumetricFireId own = w.make(fire);
    fire.profile = cooked;
    fire.position[0] = 100;
    (void)w.make(fire);
    w.run(1);
    const float high = 0.75f * w.state(preset).height;
    const FwVolumetricFireState now = w.state(preset);
    EXPECT_TRUE(ask(w, 0.75f * now.tip[0], high, 0.75f * now.tip[2]).inside);
    EXPECT_FALSE(ask(w, 50, high, 0).inside);
    EXPECT_TRUE(ask(w, 50, 0.2f, 0).inside);
    EXPECT_TRUE(ask(w, 100, 0.2f, 0).inside);
    EXPECT_FALSE(ask(w, 100, high, 0).inside);

    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_DestroyFireProfile(w.world, painted));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("is used by 1 fire"));
    EXPECT_EQ(FW_OK, fwWorld_DestroyVolumetricFire(w.world, own));
    EXPECT_EQ(FW_OK, fwWorld_DestroyFireProfile(w.world, painted));
    fire.profile = painted;
    FwVolumetricFireId id{};
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_CreateVolumetricFire(w.world, &fire, &id));

    const auto refused = [&](const FwFireProfileDef& bad, FwResult result, const char* text) {
        FwFireProfileId made{};
        EXPECT_EQ(result, fwWorld_CreateFireProfile(w.world, &bad, &made));
        EXPECT_THAT(lastMessage(w.world), HasSubstr(text));
    };
    bytes[40] ^= 1;
    refused(again, FW_ERROR_BAD_DATA, "checksum");
    again.cookedSize = 7;
    refused(again, FW_ERROR_BAD_DATA, "has 7 bytes");
    def.width = 7;
    refused(def, FW_ERROR_INVALID_ARGUMENT, "width is 7; the limits are [8, 512]");
    def.width = 8;
    texels[3] = NAN;
    refused(def, FW_ERROR_BAD_DATA, "nan");
    def.texels = nullptr;
    refused(def, FW_ERROR_INVALID_ARGUMENT, "texels is null");
    texels[3] = 0;
    def.texels = texels.data();
    FwFireProfileId made{};
    for (int i = 0; i < 22; ++i)
        ASSERT_EQ(FW_OK, fwWorld_CreateFireProfile(w.world, &def, &made)) << i;
    refused(def, FW_ERROR_INVALID_ARGUMENT, "23 fire profiles");
}

TEST(FireInteraction, ReportsHeatAtAPoint) {
    FireWorld w;
    EXPECT_EQ(293.0f, ask(w, 0, 0, 0).temperature);
    FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
    const FwVolumetricFireId id = w.make(def);
    w.run(1);
    const FwFireSample in = ask(w, 0, 0.3f, 0), above = ask(w, 0, 1.4f, 0),
                       beside = ask(w, 1, 0.4f, 0), far = ask(w, 200, 0, 0);
    EXPECT_TRUE(in.inside);
    EXPECT_GT(in.temperature, 900.0f);
    EXPECT_GT(in.heatFlux, 20000.0f);
    EXPECT_GT(in.gas[1], 1.0f);
    EXPECT_EQ(in.fire.index1, id.index1);
    EXPECT_EQ(in.fire.generation, id.generation);
    EXPECT_FALSE(above.inside);
    EXPECT_GT(above.temperature, 320.0f);
    EXPECT_LT(above.temperature, in.temperature);
    EXPECT_GT(above.gas[1], 0.5f);
    EXPECT_FALSE(beside.inside);
    EXPECT_NEAR(beside.temperature, 293.0f, 5.0f);
    EXPECT_GT(beside.heatFlux, 800.0f) << "a metre from 60 kW: some 1.5 kW/m^2";
    EXPECT_LT(beside.heatFlux, 4000.0f);
    EXPECT_LT(far.heatFlux, 1.0f);
    // Two fires give more heat than one.
    def.position[0] = 2;
    (void)w.make(def);
    w.run(1);
    EXPECT_GT(ask(w, 1, 0.4f, 0).heatFlux, 1.6f * beside.heatFlux);
    const float centre[3] = {0, 0.3f, 0};
    FwFireForce small{}, large{};
    small.structSize = large.structSize = sizeof(FwFireForce);
    ASSERT_EQ(FW_OK, fwWorld_GetVolumetricFireForce(w.world, centre, 0.05f, &small));
    ASSERT_EQ(FW_OK, fwWorld_GetVolumetricFireForce(w.world, centre, 0.1f, &large));
    EXPECT_GT(small.force[1], 0.0f);
    EXPECT_NEAR(large.force[1] / small.force[1], 4.0f, 0.01f);
    EXPECT_GT(large.ignitionPower, 500.0f);
    const float nowhere[3] = {0, INFINITY, 0};
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT,
              fwWorld_GetVolumetricFireForce(w.world, nowhere, 1, &small));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT,
              fwWorld_GetVolumetricFireForce(w.world, centre, -1, &small));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("radius is -1"));
    FwFireSample answer{};
    answer.structSize = sizeof answer;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SampleVolumetricFires(w.world, nowhere, &answer));
}

float ridgeDistance(void*, const float point[3], float normal[3]) {  // a slab at x = 0.7
    normal[0] = point[0] < 0.7f ? -1.0f : 1.0f;
    normal[1] = normal[2] = 0;
    return std::abs(point[0] - 0.7f) - 0.06f;
}

// A wall blocks radiation.
TEST(FireInteraction, WallsBlockRadiation) {
    FireWorld w;
    (void)w.make(fwDefaultVolumetricFireDef());
    w.run(1);
    const float open = ask(w, 1.2f, 0.3f, 0).heatFlux;
    EXPECT_GT(open, 500.0f);
    std::vector<float> ridge;
    for (int z = 0; z < 9; ++z)
        for (int x = 0; x < 9; ++x) ridge.push_back(x == 4 ? 2.0f : 0.0f);
    const auto shaded = [&](const FwFireColliderDef& def, float height = 0.3f) {
        const FwFireColliderId id = add(w, def);
        const float flux = ask(w, 1.2f, height, 0).heatFlux / open;
        EXPECT_EQ(FW_OK, fwWorld_RemoveFireCollider(w.world, id));
        EXPECT_FLOAT_EQ(ask(w, 1.2f, 0.3f, 0).heatFlux, open) << "at once";
        return flux;
    };
    FwFireColliderDef def = fwDefaultFireColliderDef();
    def.position[0] = 0.7f;
    def.radius = 0.02f;
    EXPECT_FLOAT_EQ(shaded(def), 1.0f) << "the collider lies on the ground";
    def.position[1] = 0.3f;
    def.radius = 0.28f;
    EXPECT_LT(shaded(def), 0.3f) << "sphere";
    def.position[0] = 1.2f;
    EXPECT_FLOAT_EQ(shaded(def), 1.0f) << "a body does not shade itself";
    def.position[0] = 0.0f;
    EXPECT_FLOAT_EQ(shaded(def), 1.0f) << "a body in the fire does not block it";
    def.kind = FW_COLLIDER_CAPSULE;
    def.radius = 0.1f;
    def.position[0] = def.end[0] = 0.7f;
    def.position[1] = 0;
    def.end[1] = 2;
    EXPECT_LT(shaded(def), 0.01f) << "capsule";
    def.end[1] = 0.12f;
    EXPECT_GT(shaded(def), 0.2f) << "a low one";
    EXPECT_LT(shaded(def), 0.99f);
    def = fwDefaultFireColliderDef();
    def.kind = FW_COLLIDER_BOX;
    def.position[0] = 0.7f;
    def.halfSize[0] = 0.01f;
    def.halfSize[1] = def.halfSize[2] = 2;
    EXPECT_LT(shaded(def), 0.01f) << "a thin box";
    def.rotation[1] = std::sqrt(0.5f);  // a quarter about y: now it lies along x
    def.rotation[3] = std::sqrt(0.5f);
    def.position[2] = 0.3f;
    EXPECT_FLOAT_EQ(shaded(def), 1.0f) << "beside it";
    def = fwDefaultFireColliderDef();
    def.kind = FW_COLLIDER_PLANE;
    EXPECT_FLOAT_EQ(shaded(def), 1.0f) << "the ground";
    EXPECT_LT(shaded(def, -0.5f), 0.01f) << "below the ground";
    def.kind = FW_COLLIDER_DISTANCE;
    def.distance = &ridgeDistance;
    EXPECT_LT(shaded(def), 0.01f) << "distance";
    def = fwDefaultFireColliderDef();
    def.kind = FW_COLLIDER_HEIGHT_FIELD;
    def.position[0] = -1.3f;
    def.position[2] = -2;
    def.cellSize = 0.5f;
    def.columns = def.rows = 9;
    def.heights = ridge.data();
    EXPECT_LT(shaded(def), 0.01f) << "a ridge";
    std::fill(ridge.begin(), ridge.end(), 0.0f);
    EXPECT_FLOAT_EQ(shaded(def), 1.0f) << "flat";

    FwHeatOccluderDef occluder = fwDefaultHeatOccluderDef();
    occluder.transform[12] = 0.7f;
    occluder.halfSize[0] = 0.05f;
    occluder.halfSize[1] = occluder.halfSize[2] = 2;
    const FwHeatOccluderId wall = created(fwWorld_AddHeatOccluder, w.world, occluder);
    EXPECT_LT(ask(w, 1.2f, 0.3f, 0).heatFlux, 0.01f * open);
    const float centre[3] = {1.2f, 0.3f, 0};
    const FwFireForce push = getState(fwWorld_GetVolumetricFireForce, w.world, centre, 0.1f);
    EXPECT_LT(push.ignitionPower, 0.01f * open * 0.0314f);
    ASSERT_EQ(FW_OK, fwWorld_RemoveHeatOccluder(w.world, wall));
    EXPECT_FLOAT_EQ(ask(w, 1.2f, 0.3f, 0).heatFlux, open);
}

// Gas reaches a ceiling in puffs; the reported contact power is averaged over them.
TEST(FireInteraction, ContactPowerIsSteady) {
    FireWorld w;
    FwFireColliderDef def = fwDefaultFireColliderDef();
    def.kind = FW_COLLIDER_PLANE;
    def.position[1] = 0.45f;
    def.normal[1] = -1;
    (void)add(w, def);
    const FwVolumetricFireId id = w.make(fwDefaultVolumetricFireDef());
    w.run(2);
    double sum = 0, square = 0, leap = 0, before = double(w.state(id).contactPower);
    constexpr int kFrames = 128;
    for (int k = 0; k < kFrames; ++k) {
        w.run(1.0f / 32);
        const double now = double(w.state(id).contactPower);
        sum += now, square += now * now, leap = std::max(leap, std::abs(now - before));
        before = now;
    }
    const double mean = sum / kFrames, spread = std::sqrt(square / kFrames - mean * mean);
    std::printf("           %.2f kW, spread %.3f, leap %.3f\n", mean, spread / mean, leap / mean);
    EXPECT_GT(mean, 5.0);
    EXPECT_LT(spread, 0.12 * mean);
    EXPECT_LT(leap, 0.08 * mean);
}

TEST(FireInteraction, NeighboursLeanTogetherAndGrowTaller) {
    FireWorld apart, close;
    FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
    FwVolumetricFireId a[2], b[2];
    for (int i = 0; i < 2; ++i) {
        def.position[0] = i ? 10.0f : -10.0f;
        a[i] = apart.make(def);
        def.position[0] = i ? 0.4f : -0.4f;
        b[i] = close.make(def);
    }
    float lean[2] = {};
    for (int k = 0; k < 8; ++k) {
        apart.run(0.25f);
        close.run(0.25f);
        lean[0] += (apart.state(a[0]).tip[0] + 10) / 8;
        lean[1] += (close.state(b[0]).tip[0] + 0.4f) / 8;
    }
    EXPECT_GT(lean[1], lean[0] + 0.03f);
    EXPECT_GT(close.state(b[0]).height, 1.1f * apart.state(a[0]).height);
}

// Varying power does not split a wide fire differently; a weakening fire dies down in place.
TEST(FireInteraction, WideWeakFiresKeepTheirPieces) {
    FireWorld w;
    FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
    def.diameter = 2;
    def.power = 10;
    const FwVolumetricFireId id = w.make(def);
    w.run(0.5f);
    const uint32_t many = w.state(id).flames;
    EXPECT_LT(8u, many);
    for (const float power : {10.5f, 9.6f, 10.3f, 9.9f}) {
        EXPECT_EQ(FW_OK, fwWorld_SetVolumetricFirePower(w.world, id, power));
        w.run(0.1f);
        EXPECT_EQ(many, w.state(id).flames);
    }
    float before = w.state(id).lightIntensity;
    EXPECT_EQ(FW_OK, fwWorld_SetVolumetricFirePower(w.world, id, 4000));
    for (int k = 0; k < 64; ++k) {
        w.run(1.0f / 32);
        const float now = w.state(id).lightIntensity;
        EXPECT_LT(now - before, 0.25f * 4000.0f * 1000 * 0.35f / 12.57f) << "it grows, frame " << k;
        before = now;
    }
    w.run(6);
    EXPECT_EQ(1u, w.state(id).flames);
    EXPECT_NEAR(w.state(id).power, 4000, 40);
}

// A combustible sheet with a fire below it.
struct Kindling {
    host::SheetWorld sheets;
    FwVolumetricFireId fire{};
    explicit Kindling(uint32_t flags, float height = 0.3f, float pace = 1)
        : sheets(
              [] {
                  FwMaterialDef paper = fwDefaultMaterialDef();
                  (void)fwInitMaterialPreset(&paper, FW_MATERIAL_PAPER);
                  return paper;
              }(),
              1.0f, 0.25f, 64,
              [&] {
                  FwWorldDef def = fwDefaultWorldDef();
                  def.paceFactor = pace;
                  return def;
              }()) {
        FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
        (void)fwInitFirePreset(&def, FW_FIRE_TORCH);
        def.flags = flags;
        def.position[0] = 0.2f;
        def.position[1] = -height;
        def.position[2] = 0.12f;
        EXPECT_EQ(FW_OK, fwWorld_CreateVolumetricFire(sheets.world, &def, &fire));
    }
};

TEST(FireInteraction, IgnitesObjectsAfterEnoughContactTime) {
    Kindling never(0), far(FW_FIRE_IGNITES, 3), near(FW_FIRE_IGNITES);
    for (Kindling* k : {&never, &far, &near}) k->sheets.run(6);
    EXPECT_EQ(0u, never.sheets.state().ignited);
    EXPECT_EQ(0u, far.sheets.state().ignited);
    EXPECT_GT(near.sheets.state().ignited, 0u);
    // Not at once; sooner in a faster world; not while it passes by.
    Kindling slow(FW_FIRE_IGNITES), fast(FW_FIRE_IGNITES, 0.3f, 20), passing(FW_FIRE_IGNITES);
    slow.sheets.run(0.2);
    EXPECT_EQ(0u, slow.sheets.state().ignited);
    fast.sheets.run(0.5);
    EXPECT_GT(fast.sheets.state().ignited, 0u);
    float place[3] = {-0.5f, -0.3f, 0.12f};
    for (int k = 0; k < 32; ++k) {
        place[0] += 0.06f;
        EXPECT_EQ(FW_OK, fwWorld_MoveVolumetricFire(passing.sheets.world, passing.fire, place));
        passing.sheets.run(1.0 / 32);
    }
    EXPECT_EQ(0u, passing.sheets.state().ignited);
    // A fire that is out lights nothing; wind may blow it onto an object.
    Kindling out(FW_FIRE_IGNITES);
    EXPECT_EQ(FW_OK, fwWorld_SetVolumetricFirePower(out.sheets.world, out.fire, 0));
    out.sheets.run(4);
    EXPECT_EQ(0u, out.sheets.state().ignited);
    Kindling blown(FW_FIRE_IGNITES);
    const float aside[3] = {-0.25f, -0.05f, 0.12f}, wind[3] = {12, 0, 0};
    EXPECT_EQ(FW_OK, fwWorld_MoveVolumetricFire(blown.sheets.world, blown.fire, aside));
    blown.sheets.run(6);
    EXPECT_EQ(0u, blown.sheets.state().ignited);
    EXPECT_EQ(FW_OK, fwWorld_SetWind(blown.sheets.world, wind));
    blown.sheets.run(6);
    EXPECT_GT(blown.sheets.state().ignited, 0u);
}

TEST(FireInteraction, IgnitionIsDeterministic) {
    uint64_t hashes[2] = {};
    for (uint64_t& hash : hashes) {
        Kindling k(FW_FIRE_IGNITES, 0.3f, 5);
        k.sheets.run(3);
        hash = k.sheets.hash();
    }
    EXPECT_EQ(hashes[0], hashes[1]);
}

}  // namespace
