// The stream of a jet: arrival time, conservation of power, independence from frame rate and mesh
// stretch.
#include "components/jet.h"
#include "fire/presets.h"
#include "shared/exchange.h"
#include "support/particle_reference.h"
#include "support/world_defs.h"
#include "world/world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>
#include <optional>

namespace fw::test {
namespace {

FwFireEmitterDef flamethrower() {
    FwFireEmitterDef def{};
    def.stickTime = 6;
    def.flags = FW_EMITTER_JET | FW_EMITTER_IGNITES;
    def.position[1] = 1;
    def.direction[0] = 1;
    def.power = 2000;
    def.lifeVariance = 0.33f;
    def.buoyancy = def.windResponse = def.turbulence = def.smokeDensity = 1;
    def.behind = 0.5f;
    def.heat = 0.35f;
    return def;
}

// Half of the visible fire has travelled as far as the stream's heat, within a twelfth.
TEST(JetStream, MovesWithItsParticles) {
    for (const float power : {300.0f, 2000.0f, 20000.0f}) {
        FwFireEmitterDef def = flamethrower();
        def.power = power;
        def.sparks = def.turbulence = 0;
        ParticleReference jet(def);
        const components::JetFlight flight = components::jetFlight(jet.emitter.appearance);
        jet.emitter.ring = 400;
        jet.particles.resize(400);
        jet.emitter.appearance.rate = 10000;
        jet.step(1 / 50.0f);  // a puff
        jet.emitter.def.power = 0;
        for (uint32_t k = 1; k <= 6; ++k) {
            for (int i = 0; i < 5; ++i) jet.step(0.025f);
            std::vector<float> ways;
            for (uint32_t i = 0; i < jet.record.ring; ++i)
                if (jet.births(i) < jet.record.filled) ways.push_back(jet.place(i).x);
            ASSERT_LT(100u, ways.size());
            std::sort(ways.begin(), ways.end());
            const float middle = ways[ways.size() / 2];
            // The puff is 10 ms older on average than the parcel.
            const float seconds = 0.125f * float(k) + 0.01f;
            const float part = seconds / 0.125f;
            const auto whole = uint32_t(part);
            const float way = 0.001f * std::lerp(float(flight[whole]), float(flight[whole + 1]),
                                                 part - float(whole));
            EXPECT_NEAR(1, way / middle, 1 / 12.0f) << power << " kW after " << seconds << " s";
        }
    }
}

TEST(JetStream, ArrivesInOrderAndBeforeItsNextExchange) {
    components::EmitterAppearance look;
    look.speed = 12;
    look.dragStream = 1.5f;
    look.dragTorn = 0.45f;
    look.life = 1;
    const components::JetFlight flight = components::jetFlight(look);
    EXPECT_NEAR(1440, flight[1], 60);
    uint32_t last = 0;
    for (uint32_t way = 0, k = 0; way < 6000; ++way) {
        while (flight[k + 1] <= way) ++k;
        const uint32_t tick = components::jetArrival(flight, k, way);
        EXPECT_GE(tick, last);
        EXPECT_GE(tick, k * gpu::kExchangeTicks);
        EXPECT_LT(tick, (k + 1) * gpu::kExchangeTicks);
        last = tick;
    }
}

TEST(JetStream, DistributesAllOfItsPower) {
    uint32_t seed = 1;
    const auto pick = [&](uint32_t below) { return (seed = gpu::hash32(seed)) % below; };
    for (int turn = 0; turn < 2000; ++turn) {
        std::vector<uint64_t> areas(1 + pick(200));
        for (uint64_t& area : areas) area = 1 + pick(turn % 2 ? 700000u : 60u);
        const uint64_t all = std::accumulate(areas.begin(), areas.end(), uint64_t(0));
        const bool much = turn % 7 == 0;
        const uint64_t power =
            much ? all * gpu::kMaxFlux + pick(100000) : all * pick(400000) + pick(100000);
        std::vector<uint32_t> flux(areas.size());
        const uint64_t left = components::updateJetShare(power, areas, flux);
        uint64_t given = 0;
        for (size_t i = 0; i < areas.size(); ++i) given += areas[i] * flux[i];
        EXPECT_EQ(power, given + left);
        const auto [low, high] = std::minmax_element(flux.begin(), flux.end());
        EXPECT_LE(*high - *low, 1u);
        if (much) {
            EXPECT_EQ(gpu::kMaxFlux, *low);
        } else if (power < all * gpu::kMaxFlux) {
            EXPECT_LT(left, *std::max_element(areas.begin(), areas.end()));
        }
    }
}

// Sums the heat that a world sends to its backend, in nW, while nothing has burnt through.
class HeatBook final : public gpu::Backend {
 public:
    void restore(std::span<const gpu::RestoredObject>, uint32_t) override {}
    void createMesh(uint32_t, const mesh::BurnDomain&) override {}
    void destroyMesh(uint32_t) noexcept override {}
    void createObject(uint32_t, const gpu::ObjectInit&) override {}
    void destroyObject(uint32_t) noexcept override {}
    void setVertices(uint32_t, std::span<const float>, std::span<const float>) noexcept override {}
    void setRoom(uint32_t, const gpu::Room&) noexcept override {}
    void setObjectPose(uint32_t, const gpu::vec4*, const gpu::vec4&, uint32_t) override {}
    void createImage(uint32_t, uint32_t, uint32_t, std::span<const std::byte>, float) override {}
    void destroyImage(uint32_t) noexcept override {}
    void run(const gpu::FramePlan& plan) override {
        for (const gpu::StepPlan& step : plan.steps)
            for (const gpu::TexelEvent& event : step.events)
                if (gpu::eventKind(event.kind) == gpu::kEventHeat && stands(step.events, event)) {
                    heat[event.object] += areas.at(event.object).at(event.texel) * event.tick;
                    list.push_back({step.now, event.object, event.texel, event.tick});
                }
    }
    const gpu::Readback* nextReadback() override { return nullptr; }
    std::span<const gpu::PassTime> passTimes() override { return {}; }
    void memoryRows(std::pmr::vector<gpu::MemoryRow>&) const override {}

    // Every gate it passed would have to be burnt through.
    static bool stands(std::span<const gpu::TexelEvent> batch, const gpu::TexelEvent& event) {
        const uint32_t gate = event.kind >> gpu::kEventKindBits;
        return gate == 0 || (batch[gate - 1].kind & gpu::kGateShut) != 0;
    }

    std::map<uint32_t, std::vector<uint64_t>> areas;  // 1e-9 m^2, by object and texel
    std::map<uint32_t, uint64_t> heat;
    std::vector<std::array<uint32_t, 4>> list;
};

// Walls across x, 2 x 2 m, of a sheet stretched by its transform.
struct Range {
    explicit Range(float texelsPerMetre = 40) {
        FwWorldDef worldDef = plainWorldDef(0);
        worldDef.maxParticles = 4096;
        world.emplace(worldDef, book, log, std::pmr::new_delete_resource());
        sheet.positions = {0, 0, 0, 0, 0, 1, 0, 1, 1, 0, 1, 0};
        sheet.indices = {0, 1, 2, 0, 2, 3};
        FwMeshDef def = plainMeshDef(sheet, texelsPerMetre);
        def.mapSize = 1024;
        mesh = world->scene().createMesh(def);
        material = world->scene().createMaterial(fire::presetDef(FW_MATERIAL_PINE));
    }
    FwBurnableMeshId wall(float x, float wide = 2, float high = 2) {
        FwBurnableMeshDef def = plainBurnableDef(mesh);
        def.materials[0] = material;
        const float placed[16] = {1, 0, 0, 0, 0, high, 0, 0, 0, 0, wide, 0, x, 0, -wide / 2, 1};
        std::copy_n(placed, 16, def.transform);
        const FwBurnableMeshId id = world->createBurnableMesh(def);
        // The mean of the axes is the scale; the rest is in the shape.
        const float scale = components::makePose(placed, "placed").scale;
        std::vector<uint64_t>& areas = book.areas[id.index1 - 1];
        for (const float area : world->scene().objectDomain(id).areas)
            areas.push_back(
                std::max<uint64_t>(uint64_t(std::llround(area * (scale * scale) * 1e9f)), 1));
        return id;
    }
    void run(double seconds, float dt) {
        for (double t = 0; t < seconds - 1e-9; t += double(dt))
            world->advance(world->lastFrame() + 1, dt);
    }
    Mesh sheet;
    core::Log log{FwCallbacks{}};
    HeatBook book;
    std::optional<world::World> world;
    FwMeshId mesh{};
    FwMaterialId material{};
};

// Conserves every ray's power to the nanowatt except a texel's pending share of 1 W/m^2. Over few
// and very many texels, at every distance, on any stretch.
TEST(JetStream, ConservesPowerOnStretchedMeshes) {
    struct Case {
        float x, wide, high, texels;
    };
    for (const Case& c : {Case{3, 2, 2, 40}, Case{3, 2, 2, 12}, Case{1.5f, 4, 2, 100},
                          Case{2, 6, 1.5f, 40}, Case{5, 3, 3, 64}, Case{0.2f, 1, 8, 25}}) {
        Range r(c.texels);
        const FwBurnableMeshId id = r.wall(c.x, c.wide, c.high);
        r.wall(c.x + 1);
        const FwFireEmitterId jet = r.world->emitters().create(flamethrower());
        r.run(1.5, 1 / 32.0f);
        FwFireEmitterState state{};
        r.world->emitters().fillState(jet, state);
        ASSERT_EQ(16u, state.blockedRays) << c.x;
        r.world->emitters().setPower(jet, 0);
        r.run(2.5, 1 / 32.0f);  // the stream in flight arrives
        const uint64_t ray = uint64_t(2000000.0 * double(0.35f) / 16 * 1e9);
        const uint64_t all = ray * 16 * 12;  // exchanges in 1.5 s
        const uint64_t given = r.book.heat[id.index1 - 1];
        const auto& areas = r.book.areas[id.index1 - 1];
        EXPECT_LE(given, all);
        EXPECT_LT(all - given, *std::max_element(areas.begin(), areas.end())) << c.x;
        EXPECT_EQ(0u, r.book.heat.count(1)) << "the wall behind is not heated";
    }
}

// Ticks and amounts of heat are equal at every frame rate that the steps divide.
TEST(JetStream, IsIndependentOfTheFrameRate) {
    std::optional<std::vector<std::array<uint32_t, 4>>> first;
    for (const float dt : {1 / 128.0f, 1 / 32.0f, 1 / 8.0f, 0.5f}) {
        Range r;
        r.wall(3.0f);
        r.world->emitters().create(flamethrower());
        r.run(1.5, dt);
        EXPECT_EQ(first.value_or(r.book.list), r.book.list) << dt;
        first = r.book.list;
    }
    ASSERT_FALSE(first->empty());
    // 3 m at 12 m/s, slightly slower at the end.
    EXPECT_GE(first->front()[0], uint32_t(4096 * 3 / 12.0f) - gpu::kStepTicks);
    EXPECT_LE(first->front()[0], uint32_t(4096 * 3 / 9.5f));
}

// A wall that moves in between is hit; a removed wall no longer stops fuel still in flight.
TEST(JetStream, HitsTheSceneAtArrivalTime) {
    for (const bool comes : {false, true}) {
        Range r;
        r.wall(5);
        FwHeatOccluderDef door{};
        door.structSize = sizeof door;
        for (int i = 0; i < 4; ++i) door.transform[i * 5] = 1;
        door.halfSize[1] = door.halfSize[2] = 3;
        door.halfSize[0] = 0.02f;
        door.transform[12] = 4.5f;
        FwHeatOccluderId id{};
        if (!comes) id = r.world->exchange().addHeatOccluder(door);
        const FwFireEmitterId jet = r.world->emitters().create(flamethrower());
        r.run(0.125, 1 / 32.0f);
        r.world->emitters().setPower(jet, 0);
        r.run(0.125, 1 / 32.0f);  // it has travelled some 2.8 m
        if (comes)
            r.world->exchange().addHeatOccluder(door);
        else
            r.world->exchange().removeHeatOccluder(id);
        r.run(1, 1 / 32.0f);
        EXPECT_EQ(comes, r.book.list.empty());
    }
}

}  // namespace
}  // namespace fw::test
