// A scripted world in which every feature runs at once, for the tests of saves and networks.
#pragma once
#include "abi/abi_support.h"

#include <algorithm>
#include <cstring>

namespace host {

// Writes the checksum of a save's header again, so that its content is checked.
inline void signSave(Bytes& bytes) {
    uint64_t hash = 1469598103934665603ull;
    size_t at = 24;
    for (; at + 8 <= bytes.size(); at += 8) {
        uint64_t word = 0;
        std::memcpy(&word, &bytes[at], 8);
        hash = (hash ^ word) * 1099511628211ull;
        hash ^= hash >> 29;
    }
    for (; at < bytes.size(); ++at) hash = (hash ^ bytes[at]) * 1099511628211ull;
    const uint64_t size = bytes.size() - 24;
    std::memcpy(&bytes[8], &size, 8);
    std::memcpy(&bytes[16], &hash, 8);
}

// Pose: turned about y by `turn` rad, at (x, y, z) m.
inline void poseAt(float (&at)[16], float x, float y, float z, float turn) {
    std::fill(std::begin(at), std::end(at), 0.0f);
    at[0] = at[10] = std::cos(turn);
    at[8] = std::sin(turn);
    at[2] = -at[8];
    at[5] = at[15] = 1;
    at[12] = x, at[13] = y, at[14] = z;
}

// Boxes and boards of several materials light each other. Gusts, a wind grid, water, a flamethrower
// and a fixed fire act on them, and a wetting field, a wall, occluders of both kinds and a tag.
// `exact`: all places are whole parts of a metre and no burn depends on float results, so a world
// with another origin burns identically.
class BusyWorld : public HostedWorld {
 public:
    explicit BusyWorld(uint32_t backend, float pace = 12, uint32_t things = 10, bool exact = false)
        : HostedWorld(backend, busyDef(pace)), exact_(exact) {
        if (!world) return;
        for (uint32_t i = 0; i < things; ++i) add(i);
        FwFireEmitterDef jetDef = fwDefaultFireEmitterDef();
        jetDef.flags = exact ? 0u : FW_EMITTER_JET | FW_EMITTER_IGNITES;
        putAt(jetDef.position, -1.2f, 0.15f, 0.1f);
        put(jetDef.direction, 1, 0, 0.05f);
        jetDef.power = 400;
        ok(fwWorld_CreateFireEmitter(world, &jetDef, &jet));
        FwVolumetricFireDef fireDef = fwDefaultVolumetricFireDef();
        if (!exact) fireDef.flags |= FW_FIRE_IGNITES;
        putAt(fireDef.position, 1.8f, 0, 0.55f);
        ok(fwWorld_CreateVolumetricFire(world, &fireDef, &fire));
        FwParticleFieldDef fieldDef = fwDefaultParticleFieldDef();
        ok(fwInitFieldPreset(&fieldDef, FW_FIELD_WATER));
        if (!exact) fieldDef.flags |= FW_FIELD_WETS;
        putAt(fieldDef.position, 0.9f, 0.0f, 0.5f);
        fieldDef.width = fieldDef.height = 32;
        ok(fwWorld_CreateParticleField(world, &fieldDef, &field));
        FwHeatOccluderDef wall = fwDefaultHeatOccluderDef();
        place(wall.transform, 1.0f, 0.3f, 0.25f, 0);
        put(wall.halfSize, 0.3f, 0.3f, 0.01f);
        ok(fwWorld_AddHeatOccluder(world, &wall, &occluder));
        FwWindZoneDef swirl = fwDefaultWindZoneDef();
        swirl.shape = FW_WIND_SPHERE;
        swirl.flow = FW_WIND_VORTEX;
        put(swirl.axis, 0, 1, 0);
        putAt(swirl.position, 1.4f, 0, 0.4f);
        swirl.size[0] = 0.8f;
        swirl.priority = 2;
        ok(fwWorld_CreateWindZone(world, &swirl, &zones[0]));
        const FwWindZoneDef fan = fanOf(0);
        ok(fwWorld_CreateWindZone(world, &fan, &zones[1]));
        const FwRoomDef closet = closetOf(0);
        ok(fwWorld_CreateRoom(world, &closet, &room));
    }
    static FwWorldDef busyDef(float pace) {
        FwWorldDef def =
            worldDef(FW_WORLD_RADIATION | FW_WORLD_PLUME | FW_WORLD_CONTACT | FW_WORLD_EMBERS, pace,
                     fwDefaultWorldDef().maxStepsPerFrame);
        def.seed = 5;
        def.maxBurningTiles = 250;
        return def;
    }

    // The commands of a frame depend only on its number. Frame rates vary.
    void run(uint32_t from, uint32_t to) {
        for (uint32_t frame = from; frame < to; ++frame) {
            act(frame);
            ok(fwWorld_Step(world, timeOf(frame)));
        }
    }
    static float timeOf(uint32_t frame) { return frame % 3 == 0 ? 1.0f / 60 : 1.0f / 24; }  // s
    uint64_t hash() { return hashOf(world, ids); }
    Bytes save() { return saveOf(world); }
    FwResult load(const Bytes& bytes) {
        const unsigned char none = 0;  // an empty vector has no address
        const FwResult result =
            fwWorld_Load(world, bytes.empty() ? &none : bytes.data(), bytes.size());
        ok(fwWorld_GetOrigin(world, origin));
        return result;
    }
    // The host's own places move too.
    void shift(float x, float y, float z) {
        const float by[3] = {x, y, z};
        float applied[3] = {};
        ok(fwWorld_ShiftOrigin(world, by, applied));
        for (int i = 0; i < 3; ++i) {
            EXPECT_EQ(std::round(by[i]), applied[i]);
            origin[i] += double(applied[i]);
        }
        double now[3] = {};
        ok(fwWorld_GetOrigin(world, now));
        for (int i = 0; i < 3; ++i) EXPECT_EQ(origin[i], now[i]);
    }
    uint32_t burning() {  // objects that caught
        uint32_t caught = 0;
        for (const FwBurnableMeshId id : ids) caught += state(id).ignited > 0 ? 1 : 0;
        return caught;
    }

    std::vector<FwBurnableMeshId> ids;
    FwFireEmitterId jet{};
    FwVolumetricFireId fire{};
    FwParticleFieldId field{};
    FwHeatOccluderId occluder{};
    FwWindZoneId zones[2] = {};
    FwRoomId room{};
    double origin[3] = {};  // m

 private:
    bool exact_ = false;

    static void put(float (&to)[3], float x, float y, float z) { to[0] = x, to[1] = y, to[2] = z; }
    void putAt(float* to, float x, float y, float z) const {
        const float at[3] = {x, y, z};
        for (int i = 0; i < 3; ++i)
            to[i] = float((exact_ ? std::round(at[i] * 64) / 64 : at[i]) + origin[i]);
    }
    void place(float (&at)[16], float x, float y, float z, float turn) const {
        poseAt(at, 0, 0, 0, turn);
        putAt(at + 12, x, y, z);
    }
    FwWindZoneDef fanOf(uint32_t frame) const {
        FwWindZoneDef fan = fwDefaultWindZoneDef();
        fan.shape = FW_WIND_CONE;
        fan.blend = FW_WIND_REPLACE;
        fan.priority = -3;
        putAt(fan.position, -0.4f, 0.1f, 0.2f);
        put(fan.axis, 1, 0, 0.2f * std::sin(float(frame)));
        put(fan.size, 2, 0.8f, 1);
        fan.speed = 3 + float(frame % 4);
        return fan;
    }
    // A room around some of the objects with little air; its door opens and shuts.
    FwRoomDef closetOf(uint32_t frame) const {
        FwRoomDef closet = fwDefaultRoomDef();
        putAt(closet.position, 0.7f, 0.1f, 0.3f);
        put(closet.halfSize, 0.7f, 1, 0.8f);
        closet.rotation[1] = std::sin(0.1f), closet.rotation[3] = std::cos(0.1f);
        closet.volume = 0.3f;
        closet.vent = frame % 2 ? 0.2f : 0.0f;
        closet.flags = frame == 120 ? FW_ROOM_REFILL : 0;
        return closet;
    }
    void add(uint32_t i) {
        static const uint32_t kPresets[] = {FW_MATERIAL_PLYWOOD, FW_MATERIAL_PAPER,
                                            FW_MATERIAL_COTTON, FW_MATERIAL_PINE,
                                            FW_MATERIAL_DRY_LEAF};
        const Sheet sheet(0.5f, 0.35f, 2);
        FwMeshDef meshDef = sheet.def(64);
        meshDef.noiseAmplitude = 0.15f;
        FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
        if (i == 4) def.flags |= FW_BURNABLE_LITE;
        place(def.transform, float(i % 5) * 0.45f, 0.12f * float(i % 3), float(i / 5) * 0.4f,
              0.2f * float(i));
        ids.push_back(addBurnable(world, meshDef, kPresets[i % 5], def));
    }
    // A wind grid over everything; later some of its points change.
    void blowGrid(uint32_t frame) {
        FwWindGridDef grid = fwDefaultWindGridDef();
        grid.counts[0] = 4;
        grid.blend = FW_WIND_ADD;
        putAt(grid.origin, -0.5f, -0.3f, -0.4f);
        grid.fade = 0.2f;
        float velocities[48] = {};
        for (uint32_t i = 0; i < 48; ++i)
            velocities[i] = float(i % 7) - 3 + (i > 30 && frame == 80 ? 1.25f : 0.0f);
        grid.velocities = velocities;
        ok(fwWorld_SetWindGrid(world, &grid));
    }
    // Heat occluders: a post away from the objects, a hill below some, and two of the objects.
    void shield(uint32_t frame) {
        FwHeatOcclusionDef cells = fwDefaultHeatOcclusionDef();
        putAt(cells.origin, -0.5f, -0.6f, -0.5f);
        cells.counts[0] = 60;
        cells.counts[1] = 20;
        cells.counts[2] = frame == 95 ? 31 : 33;
        cells.cellSize = 0.05f;
        std::vector<uint8_t> post(size_t{60} * 20 * cells.counts[2]);
        for (size_t y = 0; y < 20; ++y) post[(size_t{14} * 20 + y) * 60 + 43] = 1;
        cells.cells = post.data();
        float low = float((frame == 50 ? -0.453125 : -0.34375) + origin[1]);
        cells.distance = [](void* data, const float* place) {
            return place[1] - *static_cast<const float*>(data);
        };
        cells.distanceData = &low;
        const FwBurnableMeshId walls[] = {ids[1 % ids.size()], ids[7 % ids.size()]};
        cells.objects = walls;
        cells.objectCount = 2;
        ok(fwWorld_SetHeatOcclusion(world, &cells));
    }
    void act(uint32_t frame) {
        FwIgnitionDef ball = fwDefaultIgnitionDef();
        uint32_t texels = 0;
        if (frame == 2 || frame == 90) {
            ball.radius = 0.15f;
            ball.delay = frame == 90 ? 0.7f : 0.0f;
            putAt(ball.position, frame == 2 ? 0.6f : 1.4f, 0.1f, 0.2f);
            ok(fwWorld_Ignite(world, &ball, &texels));
        }
        if (frame == 60 || frame == 130) {
            ball.kind = frame == 60 ? FW_WET : FW_EXTINGUISH;
            ball.water = frame == 60 ? 80.0f : 0.0f;
            ball.radius = 0.2f;
            putAt(ball.position, 0.5f, 0.1f, 0.1f);
            ok(fwWorld_Ignite(world, &ball, &texels));
        }
        if (frame % 25 == 7) {
            const float wind[3] = {std::cos(float(frame)) * 3, 0, std::sin(float(frame)) * 3};
            ok(fwWorld_SetWind(world, wind));
        }
        if (frame % 40 == 11) {
            float at[16];
            place(at, 0.9f + 0.01f * float(frame % 7), 0.1f, 0.5f, 0.1f * float(frame));
            ok(fwWorld_SetTransform(world, ids[7 % ids.size()], at));
        }
        if (frame == 20 || frame == 105) {
            FwGustDef gusts = fwDefaultGustDef();
            gusts.strength = frame == 20 ? 0.6f : 0.0f;
            gusts.size = 1.5f;
            ok(fwWorld_SetGusts(world, &gusts));
        }
        if (frame == 33 || frame == 80) blowGrid(frame);
        if (frame == 28 || frame == 50 || frame == 95) shield(frame);
        if (frame == 145) ok(fwWorld_SetHeatOcclusion(world, nullptr));
        if (frame == 125) ok(fwWorld_SetWindGrid(world, nullptr));
        if (frame % 45 == 13) {
            const FwWindZoneDef fan = fanOf(frame);
            ok(fwWorld_SetWindZone(world, zones[1], &fan));
        }
        if (frame == 55 || frame == 120 || frame == 140) {
            const FwRoomDef closet = closetOf(frame);
            ok(fwWorld_SetRoom(world, room, &closet));
        }
        if (frame == 100) ok(fwWorld_SetFlags(world, FW_WORLD_RADIATION | FW_WORLD_CONTACT));
        if (frame == 150)
            ok(fwWorld_SetFlags(
                world, FW_WORLD_RADIATION | FW_WORLD_PLUME | FW_WORLD_CONTACT | FW_WORLD_EMBERS));
    }
};

inline bool there(const BusyWorld& w) { return w.world != nullptr; }

}  // namespace host
