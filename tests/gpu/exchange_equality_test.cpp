// Heat transfer between objects on a device against the cpu backend: two worlds get the same calls,
// one reads back some frames later, and both end in equal texels.
#include "gpu/cpu/cpu_backend.h"
#include "support/burn_scene.h"
#include "support/sanitized.h"
#include "support/world_defs.h"
#include "world/world.h"

#include "fire/presets.h"
#include "flamewright_reference.h"

#include <random>

namespace fw::test {
namespace {

FwWorldDef worldDef(uint32_t flags) {
    FwWorldDef def = plainWorldDef(flags);
    def.paceFactor = 20;
    def.seed = 3;
    def.maxFlames = 64;
    return def;
}

void moved(float (&transform)[16], float x, float y, float z, float turn) {
    std::fill(std::begin(transform), std::end(transform), 0.0f);
    transform[0] = transform[10] = std::cos(turn);
    transform[8] = std::sin(turn);
    transform[2] = -transform[8];
    transform[5] = transform[15] = 1;
    transform[12] = x;
    transform[13] = y;
    transform[14] = z;
}

class ExchangeEquality : public GpuTest {
 protected:
    struct Both {
        explicit Both(TestDevice& device, const FwWorldDef& def)
            : rig(device),
              cpuBackend(std::pmr::get_default_resource(), 4),
              vk(def, rig.backend, log, std::pmr::get_default_resource()),
              cpu(def, cpuBackend, log, std::pmr::get_default_resource()) {}
        core::Log log{FwCallbacks{}};
        VkRig rig;
        gpu::cpu::CpuBackend cpuBackend;
        world::World vk, cpu;
        std::vector<FwBurnableMeshId> ids;

        template <class Call>
        void each(Call&& call) {
            call(vk);
            call(cpu);
        }
        void add(const Mesh& mesh, uint32_t preset, float x, float y, float z, float turn,
                 uint32_t flags, float moisture = 0,
                 const components::Governance& governance = {}) {
            FwBurnableMeshId id{};
            each([&](world::World& w) {
                FwMeshDef def = plainMeshDef(mesh, 48);
                def.noiseAmplitude = 0.15f;
                FwBurnableMeshDef object = plainBurnableDef(w.scene().createMesh(def));
                object.flags = flags;
                FwMaterialDef material = fire::presetDef(preset);
                object.materials[0] = w.scene().createMaterial(material);
                moved(object.transform, x, y, z, turn);
                object.moisture = moisture;
                object.spreadChance = governance.chance;
                object.maxHops = governance.hopsMost;
                object.maxBurningTiles = governance.maxTiles;
                object.timeToLive = governance.life;
                id = w.createBurnableMesh(object);
            });
            ids.push_back(id);
        }
        void step(float deltaTime) {
            const FwVulkanFrame frame = rig.frames.begin();
            ASSERT_TRUE(rig.backend.beginOutside(frame, rig.view));
            vk.advance(frame.frameIndex, deltaTime);
            rig.backend.endOutside();
            rig.frames.submit();
            cpu.advance(frame.frameIndex, deltaTime);
        }
        // Compares the maps of all objects, fetched at the end of the next frame.
        void compare(const std::string& when) {
            each([&](world::World& w) {
                for (const FwBurnableMeshId id : ids) w.queries().requestBurnMap(id);
            });
            for (int i = 0; i < 8; ++i) step(0);
            for (size_t i = 0; i < ids.size(); ++i) {
                const world::BurnMapCopy* a = vk.queries().fetchBurnMap(ids[i]);
                const world::BurnMapCopy* b = cpu.queries().fetchBurnMap(ids[i]);
                ASSERT_TRUE(a && b) << when;
                ASSERT_EQ(a->tick, b->tick) << when;
                size_t differ = 0, first = 0;
                for (size_t t = 0; t < a->ticks.size(); ++t)
                    if (a->ticks[t] != b->ticks[t] && differ++ == 0) first = t;
                ASSERT_EQ(0u, differ) << when << ", object " << i << ", texel " << first << ": "
                                      << a->ticks[first] << " for " << b->ticks[first];
                ASSERT_EQ(a->heat.size(), b->heat.size()) << when;
                for (size_t t = 0; t < a->heat.size(); ++t) {
                    ASSERT_EQ(a->heat[t].x, b->heat[t].x) << when << ", heat of " << i << ", " << t;
                    ASSERT_EQ(a->heat[t].y, b->heat[t].y) << when << ", heat of " << i << ", " << t;
                    wet += (b->heat[t].y & 0x3FFu) != 0 ? 1 : 0;
                }
                heats += a->heat.empty() ? 0 : 1;
                FwObjectState mine{}, theirs{};
                vk.queries().objectState(ids[i], mine);
                cpu.queries().objectState(ids[i], theirs);
                ASSERT_EQ(theirs.ignited, mine.ignited) << when << ", object " << i;
                ASSERT_EQ(theirs.energy, mine.energy) << when << ", object " << i;
            }
        }
        uint32_t heats = 0, wet = 0;  // compared objects with heat, and wet texels
    };

    static uint32_t burning(Both& both) {
        uint32_t caught = 0;
        for (const FwBurnableMeshId id : both.ids) {
            FwObjectState state{};
            both.cpu.queries().objectState(id, state);
            caught += state.ignited > 0 ? 1 : 0;
        }
        return caught;
    }
};

// One mesh whose fire must cross a gap.
Mesh twoBoxes() {
    Mesh both = makeCube(0.12, 2);
    const Mesh one = both;
    const uint32_t base = both.vertexCount();
    for (uint32_t i = 0; i < base; ++i)
        both.addVertex(one.positions[3 * i] + 0.13, one.positions[3 * i + 1],
                       one.positions[3 * i + 2], one.uvs[2 * i], one.uvs[2 * i + 1] + 4);
    for (const uint32_t index : one.indices) both.indices.push_back(base + index);
    return both;
}

// A ball is one event for each object it holds, beside events of texels of others.
TEST_F(ExchangeEquality, BallsAroundWholeObjectsAgree) {
    if (!device_) return;
    for (const uint32_t maxTiles : {0u, 6u}) {
        FwWorldDef def = worldDef(FW_WORLD_RADIATION);
        def.maxBurningTiles = maxTiles;
        Both both(*device_, def);
        const Mesh board = makePlane(0.5, 0.3), box = twoBoxes();
        both.add(board, FW_MATERIAL_PINE, 0, 0, 0, 0.3f, 0);
        both.add(box, FW_MATERIAL_PAPER, 0.5f, 0, 0, 1, 0);
        both.add(box, FW_MATERIAL_COTTON, 1, 0, 0, 2, FW_BURNABLE_LITE);
        both.add(board, FW_MATERIAL_PLYWOOD, 3, 0, 0, 0, 0);
        both.cpu.setSwitches(FW_DEBUG_SHUFFLE);
        const auto ball = [&](uint32_t kind, float x, float radius, float delay) {
            both.each([&](world::World& w) {
                FwIgnitionDef event{};
                event.structSize = sizeof event;
                event.kind = kind;
                event.position[0] = x;
                event.radius = radius;
                event.delay = delay;
                event.water = kind == FW_WET ? 40.0f : 0.0f;
                (void)w.burn().ignite(event);
            });
        };
        const auto steps = [&](int frames) {
            for (int i = 0; i < frames; ++i) both.step(1.0f / 24);
        };
        ball(FW_IGNITE, 0.1f, 0.05f, 0);
        ball(FW_IGNITE, 3.1f, 0.05f, 0);
        steps(30);
        ball(FW_WET, 0.5f, 1.6f, 0);  // all but the last
        steps(3);
        both.compare("after rain, of tiles at most " + std::to_string(maxTiles));
        ball(FW_DRY, 0.5f, 1.6f, 0.05f);
        ball(FW_IGNITE, 0.5f, 1.6f, 0.05f);  // in order, in one step
        steps(8);
        both.compare("dried and lit");
        ball(FW_IGNITE, 1, 0.1f, 0.02f);
        ball(FW_EXTINGUISH, 1, 50, 0.02f);  // together with texels of some of the same objects
        ball(FW_IGNITE, 3, 0.1f, 0.02f);
        steps(4);
        both.compare("put out");
        steps(40);
        both.compare("and left");
        EXPECT_GT(both.wet, 0u);
    }
}

TEST_F(ExchangeEquality, ThousandsOfStepsWithAllModesAgree) {
    if (!device_) return;
    FwWorldDef def = worldDef(15);
    def.maxBurningTiles = 90;
    def.maxHops = 6;
    def.spreadChance = 0.8f;
    Both both(*device_, def);
    std::mt19937 random(5);
    const auto one = [&](float most) { return float(random() % 1000) / 1000 * most; };
    const Mesh board = makePlane(0.5, 0.3), box = twoBoxes();
    const uint32_t presets[] = {FW_MATERIAL_PAPER, FW_MATERIAL_COTTON, FW_MATERIAL_DRY_LEAF,
                                FW_MATERIAL_PLYWOOD, FW_MATERIAL_PINE};
    for (int i = 0; i < 24; ++i) {
        components::Governance governance;
        if (i % 7 == 3) governance.life = 4;
        if (i % 7 == 4) governance.maxTiles = 5;
        if (i % 7 == 5) governance.hopsMost = 1;
        both.add(i % 3 == 0 ? box : board, presets[random() % 5], one(1.6f), one(0.6f), one(1.6f),
                 one(6), i % 8 == 1 ? uint32_t(FW_BURNABLE_LITE) : 0u, i % 5 == 2 ? 0.15f : 0.0f,
                 governance);
    }
    both.each([&](world::World& w) {
        FwHeatOccluderDef wall{};
        wall.structSize = sizeof wall;
        moved(wall.transform, 0.8f, 0.3f, 0.8f, 0.4f);
        wall.halfSize[0] = 0.02f;
        wall.halfSize[1] = wall.halfSize[2] = 0.3f;
        (void)w.exchange().addHeatOccluder(wall);
    });
    const auto ignite = [&](size_t i, uint32_t kind, float radius) {
        both.each([&](world::World& w) {
            const mesh::BurnDomain& domain = w.scene().objectDomain(both.ids[i]);
            std::vector<uint32_t> texels;
            uint32_t centre = uint32_t(i * 7919) % domain.texelCount();
            for (uint32_t t = 0; t < domain.texelCount(); ++t)
                if (domain.real(t) && (radius > 1 || (t >= centre && texels.size() < 12)))
                    texels.push_back(t);
            w.burn().pushTexels(both.ids[i], kind, texels);
        });
    };
    // The cpu shuffles its lists each step; the order must not matter.
    both.cpu.setSwitches(FW_DEBUG_SHUFFLE);
    ignite(0, FW_IGNITE, 0);
    uint32_t steps = 0, mostCaught = 0;
    for (uint32_t frame = 0; frame < rounds(700u, 300u); ++frame) {
        const uint32_t count = 1 + random() % 8;
        if (random() % 12 == 0) {
            const size_t i = random() % both.ids.size();
            float transform[16];
            moved(transform, one(1.6f), one(0.6f), one(1.6f), one(6));
            both.each([&](world::World& w) { w.setTransform(both.ids[i], transform); });
        }
        if (frame % 40 == 10) {  // at their current state: some have burnt away, others have moved
            const FwBurnableMeshId walls[] = {both.ids[0], both.ids[2], both.ids[7], both.ids[9]};
            uint8_t post[40 * 24 * 40] = {};
            for (int y = 0; y < 24; ++y) post[(12 * 24 + y) * 40 + 20] = 1;
            FwHeatOcclusionDef grid{};
            grid.structSize = sizeof grid;
            grid.counts[0] = grid.counts[2] = 40;
            grid.counts[1] = 24;
            grid.origin[0] = grid.origin[1] = grid.origin[2] = -0.2f;
            grid.cellSize = 0.05f;
            grid.cells = post;
            grid.objects = walls;
            grid.objectCount = frame % 80 == 10 ? 4 : 2;
            if (frame % 160 == 130) grid = {};
            both.each([&](world::World& w) { w.exchange().setHeatOcclusion(grid); });
        }
        if (random() % 15 == 0) {
            const float wind[3] = {one(6) - 3, 0, one(6) - 3};
            both.each([&](world::World& w) { w.wind().set(wind); });
        }
        if (random() % 60 == 0) {
            const size_t i = random() % both.ids.size();
            ignite(i, FW_EXTINGUISH, 2);
        }
        if (random() % 20 == 0) ignite(random() % both.ids.size(), FW_WET, 0);
        if (random() % 10 == 0) ignite(random() % both.ids.size(), FW_DRY, 2);
        if (random() % 15 == 0) ignite(random() % both.ids.size(), FW_IGNITE, 0);
        if (random() % 60 == 0) {
            const uint32_t flags = random() % 3 == 0 ? uint32_t(random() % 16) : 15u;
            both.each([&](world::World& w) { w.exchange().setFlags(flags); });
        }
        both.step(float(count) / 32);
        if (HasFatalFailure()) return;
        steps += count;
        if (frame % 50 != 49) continue;
        both.compare("after " + std::to_string(steps) + " steps");
        if (HasFatalFailure()) return;
        mostCaught = std::max(mostCaught, burning(both));
    }
    EXPECT_GT(mostCaught, 10u);
    EXPECT_GT(both.heats, 100u);
    EXPECT_GT(both.wet, 100u);
    std::printf("%u steps, %u of %zu objects alight\n", steps, mostCaught, both.ids.size());
}

// No more tiles burn than allowed, per object and per world, and both backends choose the same
// ones. They catch by front, heat, contact, embers, the reference kernel or a flame.
TEST_F(ExchangeEquality, BurningTilesStayWithinTheirLimits) {
    if (!device_) return;
    constexpr uint32_t kOfWorld = 30, kOfOne = 4;
    FwWorldDef def = worldDef(15);
    def.maxBurningTiles = kOfWorld;
    def.maxParticles = 16384;
    def.wind[0] = 1;
    Both both(*device_, def);
    std::mt19937 random(11);
    const auto one = [&](float most) { return float(random() % 1000) / 1000 * most; };
    const Mesh board = makePlane(0.5, 0.3), box = makeCube(0.25, 2);
    const uint32_t presets[] = {FW_MATERIAL_PAPER, FW_MATERIAL_COTTON, FW_MATERIAL_DRY_LEAF,
                                FW_MATERIAL_PLYWOOD};
    const uint32_t flags[] = {0, 0, FW_BURNABLE_LITE, FW_BURNABLE_PUBLISHED};
    for (int i = 0; i < 20; ++i) {
        components::Governance governance;
        if (i % 3 == 2) governance.maxTiles = kOfOne;
        both.add(i % 3 == 0 ? box : board, presets[random() % 4], one(1.2f), one(0.4f), one(1.2f),
                 one(6), flags[i % 4], 0, governance);
    }
    const auto light = [&](size_t i) {
        both.each([&](world::World& w) {
            const mesh::BurnDomain& domain = w.scene().objectDomain(both.ids[i]);
            for (uint32_t t = domain.texelCount() / 2; t < domain.texelCount(); ++t)
                if (domain.real(t)) {
                    w.burn().pushTexels(both.ids[i], FW_IGNITE, {&t, 1});
                    return;
                }
        });
    };
    for (const size_t i : {0, 1, 3, 5}) light(i);
    // A flame blows all the time on an object far from the others; without the limit it would
    // ignite LITE objects at once.
    components::Governance few;
    few.maxTiles = kOfOne;
    both.add(board, FW_MATERIAL_PAPER, 3, 0.2f, 3, 0, 0, 0, few);
    both.each([&](world::World& w) {
        FwFireEmitterDef jet = fwDefaultFireEmitterDef();
        jet.flags = FW_EMITTER_JET | FW_EMITTER_IGNITES;
        jet.power = 300;
        jet.position[0] = 3.25f;
        jet.position[1] = 0.35f;
        jet.position[2] = 3.6f;
        jet.direction[1] = 0;
        jet.direction[2] = -1;
        (void)w.emitters().create(jet);
    });
    both.cpu.setSwitches(FW_DEBUG_SHUFFLE);
    uint32_t most = 0, full = 0, mostOfOne = 0;
    for (uint32_t frame = 0; frame < rounds(480u, 240u); ++frame) {
        both.step(1.0f / 32);
        if (HasFatalFailure()) return;
        uint32_t all = 0;
        for (size_t i = 0; i < both.ids.size(); ++i) {
            const uint32_t tiles = both.cpuBackend.counters(both.ids[i].index1 - 1).burningTiles;
            all += tiles;
            if (i % 3 != 2) continue;
            ASSERT_LE(tiles, kOfOne) << "object " << i << ", frame " << frame;
            mostOfOne = std::max(mostOfOne, tiles);
        }
        ASSERT_LE(all, kOfWorld) << "frame " << frame;
        FwWorldStats stats{};
        both.vk.stats(stats);
        ASSERT_LE(stats.burningTiles, kOfWorld) << "frame " << frame;
        most = std::max(most, all);
        full += all == kOfWorld ? 1 : 0;
        if (frame % 60 == 59) both.compare("after " + std::to_string(frame + 1) + " frames");
        if (HasFatalFailure()) return;
    }
    EXPECT_EQ(kOfWorld, most);
    EXPECT_EQ(kOfOne, mostOfOne);
    FwObjectState blown{};
    both.cpu.queries().objectState(both.ids.back(), blown);
    EXPECT_GT(blown.ignited, 0u);
    EXPECT_GT(full, 30u);  // often enough at the limit
    EXPECT_GT(burning(both), 5u);
}

// With all modes on and objects coming and going within reach: once every pair has met, a frame
// allocates nothing on device or heap.
TEST_F(ExchangeEquality, SteadyFramesAllocateNothing) {
    if (!device_) return;
    core::Log log{FwCallbacks{}};
    VkRig rig(*device_, 2, 0, {}, countingEntry());
    FwWorldDef def = worldDef(15);
    def.paceFactor = 1;
    def.maxBurningTiles = 500;
    world::World world(def, rig.backend, log, &rig.memory);
    const Mesh board = makePlane(0.5, 0.3);
    FwBurnableMeshDef object = plainBurnableDef(world.scene().createMesh(plainMeshDef(board, 48)));
    object.materials[0] = world.scene().createMaterial(fire::presetDef(FW_MATERIAL_PLYWOOD));
    std::vector<FwBurnableMeshId> ids;
    for (int i = 0; i < 8; ++i) {
        moved(object.transform, float(i) * 0.52f, 0, 0, 0);
        ids.push_back(world.createBurnableMesh(object));
    }
    FwHeatOccluderDef wall{};
    wall.structSize = sizeof wall;
    moved(wall.transform, 1.5f, 0.5f, 0, 0);
    wall.halfSize[0] = wall.halfSize[1] = wall.halfSize[2] = 0.1f;
    const FwHeatOccluderId occluder = world.exchange().addHeatOccluder(wall);
    for (const size_t i : {size_t(0), size_t(4)}) {
        FwIgnitionDef ball{};
        ball.structSize = sizeof ball;
        ball.kind = FW_IGNITE;
        ball.object = ids[i];
        ball.position[0] = float(i) * 0.52f + 0.2f;
        ball.position[1] = 0.1f;
        ball.radius = 0.05f;
        ASSERT_LT(0u, world.burn().ignite(ball));
    }
    const auto frame = [&](int f) {
        float transform[16];
        const float far = f / 8 % 2 == 0 ? 0.0f : 0.2f;
        moved(transform, 7 * 0.52f + far, 0, 0, 0);
        world.setTransform(ids[7], transform);
        moved(transform, 1.5f, 0.5f + far, 0, 0);
        world.exchange().moveHeatOccluder(occluder, transform);
        const float wind[3] = {far * 5, 0, 0};
        world.wind().set(wind);
        const FwVulkanFrame begun = rig.frames.begin();
        ASSERT_TRUE(rig.backend.beginOutside(begun, rig.view));
        world.advance(begun.frameIndex, 1.0f / 32);
        rig.backend.endOutside();
        rig.frames.submit();
    };
    for (int f = 0; f < 96; ++f) frame(f);  // warm-up
    (void)takeCounts();
    const uint64_t allocations = rig.allocations;
    for (int f = 96; f < 96 + 320; ++f) frame(f);
    const VulkanCounts counts = takeCounts();
    EXPECT_EQ(counts.total(), 0u) << counts.submits << " submits, " << counts.waits << " waits, "
                                  << counts.memory << " allocations, " << counts.pipelines
                                  << " pipelines, " << counts.descriptorPools << " pools, "
                                  << counts.objects << " objects";
    EXPECT_EQ(rig.allocations, allocations);
    EXPECT_GT(counts.work, 320u);
}

}  // namespace
}  // namespace fw::test
