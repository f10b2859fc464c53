// Particles on a device move as the library's code says, and their quads are drawn in order.
#include "gpu/passes/blend_order.h"
#include "gpu/passes/draw.h"
#include "shared/flipbook.h"
#include "shared/particle.h"
#include "support/burn_scene.h"
#include "support/particle_reference.h"
#include "support/pass_rig.h"
#include "support/spark_reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

namespace fw::test {
namespace {

using gpu::vec3;

constexpr uint32_t kTiles = 64;  // quads of burning meshes, at most
constexpr uint32_t kBurnTiles = 40;

class ParticlePass : public GpuTest {
 protected:
    // `lights`: additive quads in a range of their own.
    void makeRig(uint32_t quads, bool byTexels = false, uint32_t lights = 0) {
        static constexpr uint32_t kBindings[] = {
            FW_BIND_EMITTERS,  FW_BIND_EMITTER_GROUPS, FW_BIND_PARTICLES,
            FW_BIND_FLAMES,    FW_BIND_DRAW_ARGS,      FW_BIND_VIEW,
            FW_BIND_FLIPBOOKS, FW_BIND_COUNTERS,       FW_BIND_BURN_TILES};
        static constexpr uint32_t kUniforms[] = {FW_BIND_VIEW};
        static constexpr uint32_t kTexels[] = {FW_BIND_PARTICLES};
        rig_ = std::make_unique<PassRig>(
            *device_, kBindings, uint32_t(sizeof(gpu::ParticlePush)),
            byTexels ? std::span<const uint32_t>(kTexels) : std::span<const uint32_t>(), kUniforms);
        room_ = {kTiles, quads, lights, gpu::fewQuads(true)};
        rig_->make(FW_BIND_EMITTERS, 4 * sizeof(gpu::ParticleEmitter));
        rig_->make(FW_BIND_EMITTER_GROUPS, 8192 * sizeof(gpu::uvec2));
        rig_->make(FW_BIND_PARTICLES, std::max(end_, 1u) * sizeof(gpu::ParticleWords));
        const uint32_t all = kTiles + quads + lights;
        rig_->make(FW_BIND_FLAMES, all * sizeof(gpu::FlameQuad));
        rig_->make(FW_BIND_DRAW_ARGS, (gpu::kFlameOrder + 2 * all) * 4);
        rig_->make(FW_BIND_FLIPBOOKS, gpu::kFlipbookWords * 4);
        rig_->make(FW_BIND_COUNTERS, sizeof(gpu::IterationCounters));
        rig_->make(FW_BIND_BURN_TILES, kBurnTiles * sizeof(gpu::BurnTile));
        gpu::ViewInput input;
        input.view = &view_;
        input.viewport[2] = input.viewport[3] = 512;
        input.flameCapacity = kTiles;
        const gpu::ViewParams params = gpu::makeViewParams(input);
        rig_->make(FW_BIND_VIEW, sizeof params, &params);
        particles_ = rig_->add(byTexels ? "particles_texels.comp" : "particles.comp");
        quads_ = rig_->add(byTexels ? "particle_quads_texels.comp" : "particle_quads.comp");
        sort_ = rig_->add("flame_sort.comp");
    }
    void SetUp() override {
        GpuTest::SetUp();
        const float eye[3] = {4, 2, 9}, at[3] = {4, 1, 0};
        view_ = testView(eye, at, 50, 1, false);
    }
    void TearDown() override {
        rig_.reset();
        GpuTest::TearDown();
    }
    ParticleReference& add(const FwFireEmitterDef& def) {
        references_.push_back(
            std::make_unique<ParticleReference>(def, uint32_t(5 + references_.size())));
        ParticleReference& one = *references_.back();
        one.emitter.first = end_;
        end_ += one.emitter.ring;
        return one;
    }
    // A frame on both sides.
    void frame(float seconds) {
        uint32_t records = 0;
        groups_ = 0;
        for (auto& one : references_) {
            if (!one->step(seconds)) continue;
            for (uint32_t at = 0; at < one->record.ring; at += gpu::kParticleGroup)
                rig_->of<gpu::uvec2>(FW_BIND_EMITTER_GROUPS)[groups_++] = {records, at};
            gpu::ParticleEmitter& record =
                rig_->of<gpu::ParticleEmitter>(FW_BIND_EMITTERS)[records++];
            record = one->record;
            record.from += gpu::vec4(moved_, 0);
            record.place += gpu::vec4(moved_, 0);
            record.heat.w = moved_.x, record.stuck.z = moved_.y, record.stuck.w = moved_.z;
        }
        dispatch(false);
        moves_ = vec3(0.0f);
    }
    // Moves all places of the device from the next frame on; the library's stay.
    void move(vec3 by) { moved_ += by, moves_ += by; }
    void dispatch(bool still) {
        std::fill_n(rig_->of<uint32_t>(FW_BIND_DRAW_ARGS).begin(), gpu::kFlameOrder, 0u);
        gpu::ParticlePush push{};
        push.quads = room_.particles;
        push.firstQuad = room_.tiles;
        push.lights = room_.lights;
        push.burnRow = 0;
        push.moved = gpu::vec4(moves_, 0);
        device_->run([&](VkCommandBuffer commands) {
            rig_->begin(commands);
            if (groups_ && !still) rig_->dispatch(commands, particles_, &push, groups_);
            if (groups_) rig_->dispatch(commands, quads_, &push, groups_);
            rig_->dispatch(commands, sort_, &room_, 1);
        });
    }
    void sortAlone() {
        device_->run([&](VkCommandBuffer commands) {
            rig_->begin(commands);
            rig_->dispatch(commands, sort_, &room_, 1);
        });
    }
    template <class T>
    std::span<const T> of(uint32_t binding) const {
        return rig_->of<T>(binding);
    }
    [[nodiscard]] gpu::Particle particle(uint32_t i) const {
        return gpu::particleUnpacked(of<gpu::ParticleWords>(FW_BIND_PARTICLES)[i]);
    }
    [[nodiscard]] std::span<const uint32_t> arguments() const {
        return of<uint32_t>(FW_BIND_DRAW_ARGS);
    }
    [[nodiscard]] uint32_t quads() const { return arguments()[0] / 6; }
    // Depths of the quads in draw order.
    [[nodiscard]] std::vector<float> depths() const {
        const auto view = [&](const gpu::FlameQuad& q) {
            const vec3 at = vec3(q.baseHeight) + vec3(q.axisWidth) * (0.5f * q.baseHeight.w);
            const float* m = view_.view;
            return -(m[2] * at.x + m[6] * at.y + m[10] * at.z + m[14]);
        };
        std::vector<float> out;
        for (uint32_t i = 0; i < quads(); ++i)
            out.push_back(
                view(of<gpu::FlameQuad>(FW_BIND_FLAMES)[arguments()[gpu::kFlameOrder + i]]));
        return out;
    }
    // Each quad appears once, from the first particle quad on.
    void expectAll(uint32_t first) const {
        std::vector<uint32_t> order;
        for (uint32_t i = 0; i < quads(); ++i) order.push_back(arguments()[gpu::kFlameOrder + i]);
        std::sort(order.begin(), order.end());
        for (uint32_t i = 0; i < order.size(); ++i) ASSERT_EQ(first + i, order[i]);
    }

    std::unique_ptr<PassRig> rig_;
    std::vector<std::unique_ptr<ParticleReference>> references_;
    uint32_t end_ = 0;
    FwView view_{};

    gpu::SortPush room_{};
    vec3 moved_{0.0f};

 private:
    vec3 moves_{0.0f};
    uint32_t particles_ = 0, quads_ = 0, sort_ = 0, groups_ = 0;
};

FwFireEmitterDef emitterDef(uint32_t flags, float power) {
    FwFireEmitterDef def = fwDefaultFireEmitterDef();
    def.flags = flags;
    def.power = power;
    def.position[1] = 1;
    if (flags & FW_EMITTER_JET) def.direction[0] = 1;
    return def;
}

class ParticleMotion : public ParticlePass, public testing::WithParamInterface<bool> {};
INSTANTIATE_TEST_SUITE_P(, ParticleMotion, testing::Values(false, true), [](const auto& way) {
    return std::string(way.param ? "ByTexels" : "ByWords");
});

TEST_P(ParticleMotion, MoveLikeTheLibrary) {
    FwFireEmitterDef sticky =
        emitterDef(FW_EMITTER_JET | FW_EMITTER_IGNITES | FW_EMITTER_GROUND, 500);
    sticky.stick = 0.3f;
    ParticleReference& jet = add(sticky);
    jet.emitter.stream = core::Owned<components::JetStream>::make(std::pmr::get_default_resource());
    for (uint32_t i = 0; i < 2; ++i) {  // fuel on a wall far from the stream
        components::JetPatch& patch = jet.emitter.stream->patches[2 * i + 1];
        patch.left = 1000;
        patch.power = 30000000000000u;
        patch.place[2] = 20 + 2 * float(i);
        patch.place[1] = 1;
        patch.normal[0] = -1;
    }
    ParticleReference& fire = add(emitterDef(0, 80));
    fire.air.wind[2] = 2;
    makeRig(512, GetParam());
    for (int i = 0; i < 40; ++i) {
        const float place[3] = {0.02f * float(i), 1, 0};
        components::moveFireEmitter(jet.emitter, place, nullptr);
        if (i == 30) components::setEmitterPower(fire.emitter, 20);
        frame(i % 9 == 8 ? 0.09f : 0.02f);
    }
    uint32_t alive = 0, stuck[2] = {};
    for (const auto& one : references_) {
        for (uint32_t i = 0; i < one->record.ring; ++i) {
            if (!one->alive(i)) continue;
            ++alive;
            const gpu::Particle p = particle(one->emitter.first + i);
            ASSERT_NEAR(one->particles[i].placeAge.w, p.placeAge.w, 1e-4f) << i;
            // Sines and roots differ in the last bits.
            ASSERT_LT(glm::length(one->place(i) - vec3(p.placeAge)), 5e-3f) << i;
            for (uint32_t k = 0; k < 2; ++k)
                stuck[k] += std::abs(p.placeAge.z - 20 - 2 * float(k)) < 1 ? 1u : 0u;
        }
    }
    EXPECT_LT(5u, stuck[0]);  // stuck fuel burns
    EXPECT_LT(5u, stuck[1]);
    EXPECT_LT(60u, alive);
    EXPECT_LT(40u, quads());
    // A second picture of the same time shows the same.
    const uint32_t shown = quads();
    dispatch(true);
    EXPECT_EQ(shown, quads());
}

// A shift of the origin loses no particle, and each continues its path.
TEST_P(ParticleMotion, FollowAShiftedOrigin) {
    add(emitterDef(FW_EMITTER_JET | FW_EMITTER_GROUND, 500));
    add(emitterDef(0, 80));
    makeRig(512, GetParam());
    for (int i = 0; i < 40; ++i) {
        if (i == 20 || i == 33) move(vec3(512, 0, -1024));
        frame(0.02f);
    }
    uint32_t alive = 0;
    for (const auto& one : references_)
        for (uint32_t i = 0; i < one->record.ring; ++i) {
            if (!one->alive(i)) continue;
            ++alive;
            const gpu::Particle p = particle(one->emitter.first + i);
            ASSERT_NEAR(one->particles[i].placeAge.w, p.placeAge.w, 1e-4f) << i;
            ASSERT_LT(glm::length(one->place(i) + moved_ - vec3(p.placeAge)), 0.02f) << i;
        }
    EXPECT_LT(60u, alive);
}

// With tiles of two meshes, particles use only their own mesh's, in proportion to power.
TEST_F(ParticlePass, AreBornOnTheTilesOfTheirMeshByPower) {
    FwFireEmitterDef def = emitterDef(0, 60);
    def.shape = FW_EMITTER_MESH;
    def.object.index1 = 5;
    def.rate = 4000;
    def.life = 3;
    def.speed = 0.01f;
    def.buoyancy = def.turbulence = 0;
    def.smoke = def.sparks = 0;
    ParticleReference& fire = add(def);
    makeRig(16384);
    const auto tiles = rig_->of<gpu::BurnTile>(FW_BIND_BURN_TILES);
    for (uint32_t i = 0; i < kBurnTiles; ++i) {
        tiles[i] = {};
        tiles[i].object = i % 2 ? 4 : 2;
        tiles[i].positionArea = {10.0f * float(i), 1, 0, 0.01f};
        tiles[i].normalPower = {0, 0, 1, i % 4 == 1 ? 300.0f : 100.0f};
    }
    rig_->of<gpu::IterationCounters>(FW_BIND_COUNTERS)[0].runCount = kBurnTiles;
    for (int i = 0; i < 30; ++i) frame(1.0f / 60);
    uint32_t weak = 0, strong = 0, elsewhere = 0, lost = 0;
    for (uint32_t i = 0; i < fire.emitter.ring; ++i) {
        if (fire.births(i) >= fire.record.filled) continue;
        const gpu::Particle p = particle(fire.emitter.first + i);
        if (p.placeAge.w > 1e5f) {
            ++lost;
            continue;
        }
        const auto tile = uint32_t(p.placeAge.x / 10 + 0.5f);
        const float off = p.placeAge.x - 10 * float(tile);
        ASSERT_LT(std::abs(off), 0.4f) << i;
        ++(tile % 2 == 0 ? elsewhere : tile % 4 == 1 ? strong : weak);
    }
    std::printf("[   FIGURE ] births on strong tiles %u, on weak ones %u, elsewhere %u, none %u\n",
                strong, weak, elsewhere, lost);
    EXPECT_EQ(0u, elsewhere);
    EXPECT_GT(strong + weak, 1800u);
    EXPECT_LT(lost, 20u);
    EXPECT_NEAR(double(strong) / weak, 3,
                0.75);  // with few hits strong tiles are chosen less often
    // When nothing burns any more, new particles are invisible.
    const uint32_t serial = fire.record.serial;
    rig_->of<gpu::IterationCounters>(FW_BIND_COUNTERS)[0].runCount = 0;
    frame(1.0f / 60);
    ASSERT_GT(fire.record.serial, serial);
    for (uint32_t i = 0; i < fire.emitter.ring; ++i) {
        if (fire.births(i) >= fire.record.fresh) continue;
        EXPECT_GT(particle(fire.emitter.first + i).placeAge.w, 1e5f);
    }
}

TEST_F(ParticlePass, QuadsAreDrawnFarthestFirst) {
    for (const float rate : {600.0f, 2000.0f, 9000.0f}) {
        references_.clear();
        end_ = 0;
        FwFireEmitterDef def = emitterDef(0, 100);
        def.rate = rate;
        def.life = 1;
        def.cone = 1.2f;
        def.speed = 3;
        add(def);
        makeRig(20000);
        for (int i = 0; i < 20; ++i) frame(0.05f);
        if (rate < 1000)
            EXPECT_LT(quads(), gpu::fewQuads(true));
        else
            EXPECT_GT(quads(), rate < 5000 ? gpu::fewQuads(true) + 500u : gpu::kFlameCapacity);
        EXPECT_LT(450u, quads());
        expectAll(kTiles);
        const std::vector<float> d = depths();
        for (size_t i = 1; i < d.size(); ++i)
            ASSERT_GE(d[i - 1], d[i] * (1 - 1.0f / 2000)) << i << " of " << d.size();
    }
}

// A puff that reached into the ground would end in a straight line without soft depth.
TEST_F(ParticlePass, SmokeOfAJetLiesOnTheGround) {
    FwFireEmitterDef def = emitterDef(FW_EMITTER_JET | FW_EMITTER_GROUND, 500);
    def.direction[1] = -0.5f;
    add(def);
    makeRig(8192);
    for (int i = 0; i < 60; ++i) frame(0.04f);
    uint32_t puffs = 0, lying = 0;
    for (uint32_t i = 0; i < quads(); ++i) {
        const auto& quad = of<gpu::FlameQuad>(FW_BIND_FLAMES)[arguments()[gpu::kFlameOrder + i]];
        if ((quad.kind & 3u) != gpu::kQuadSmoke) continue;
        ++puffs;
        const float middle = quad.baseHeight.y + 0.5f * quad.baseHeight.w * quad.axisWidth.y;
        const float above = middle / (0.5f * quad.baseHeight.w);  // in quad radii
        ASSERT_GT(above, 0.88f);
        lying += above < 0.9f;
    }
    EXPECT_GT(puffs, 50u);
    EXPECT_GT(lying, 4u);
    std::printf("[   FIGURE ] puffs %u, lying on the ground %u\n", puffs, lying);
}

// Nor at a wall: puffs move away from the hit wall as they grow.
TEST_F(ParticlePass, SmokeOfAJetHangsInFrontOfTheWall) {
    constexpr float kWall = 3;  // m, along x
    add(emitterDef(FW_EMITTER_JET, 500));
    makeRig(8192);
    components::JetObstacle wall;
    wall.met = true;
    wall.place[0] = kWall;
    wall.normal[0] = -1;
    wall.radius = 6;
    for (int i = 0; i < 60; ++i) {
        components::setJetObstacle(references_[0]->emitter, 0, wall, references_[0]->air.now);
        frame(0.04f);
    }
    uint32_t puffs = 0, hanging = 0;
    float all = 0, within = 0;  // sums of opacity
    for (uint32_t i = 0; i < quads(); ++i) {
        const auto& quad = of<gpu::FlameQuad>(FW_BIND_FLAMES)[arguments()[gpu::kFlameOrder + i]];
        if ((quad.kind & 3u) != gpu::kQuadSmoke) continue;
        ++puffs;
        const float off =
            (kWall - quad.baseHeight.x) / (0.5f * quad.baseHeight.w);  // in quad radii
        all += quad.opacity;
        within += off < 0.85f ? quad.opacity : 0.0f;
        hanging += off < 1.3f;
    }
    std::printf(
        "[   FIGURE ] puffs %u, close to the wall %u; of their smoke %.3f reaches into it\n", puffs,
        hanging, double(within / all));
    EXPECT_GT(puffs, 50u);
    EXPECT_GT(hanging, puffs / 4);
    EXPECT_LT(within, 0.1f * all);
}

// At lower detail fewer quads show, each larger, and all of them were visible before.
TEST_F(ParticlePass, LowerDetailShowsFewerAndLargerQuads) {
    FwFireEmitterDef def = emitterDef(0, 100);
    def.rate = 2000;
    add(def);
    makeRig(8192);
    for (int i = 0; i < 30; ++i) frame(0.04f);
    const auto measure = [&](float share, uint32_t& count, double& area) {
        rig_->of<gpu::ViewParams>(FW_BIND_VIEW)[0].quads = {share, 1 / std::sqrt(share), 0, 0};
        dispatch(true);
        count = quads();
        area = 0;
        for (uint32_t i = 0; i < count; ++i) {
            const auto& quad =
                of<gpu::FlameQuad>(FW_BIND_FLAMES)[arguments()[gpu::kFlameOrder + i]];
            area += double(quad.axisWidth.w) * double(quad.baseHeight.w) * double(quad.opacity);
        }
    };
    uint32_t all = 0, few = 0, none = 0;
    double allArea = 0, fewArea = 0, noArea = 0;
    measure(1, all, allArea);
    EXPECT_GT(all, 800u);
    for (const float share : {0.7f, 0.35f}) {
        measure(share, few, fewArea);
        const double some = double(share) * 13 / 12;  // includes partly visible ones
        EXPECT_NEAR(some, double(few) / all, 0.04) << few << " of " << all;
        EXPECT_NEAR(fewArea / allArea, 1, 0.15);
    }
    measure(1, none, noArea);
    EXPECT_EQ(all, none);
    EXPECT_DOUBLE_EQ(allArea, noArea);
}

TEST_F(ParticlePass, TheRadixSortIsStable) {
    FwFireEmitterDef def = emitterDef(0, 100);
    def.rate = 9000;
    def.life = 5;
    def.smoke = def.sparks = def.turbulence = 0;
    def.buoyancy = 0;
    def.shape = FW_EMITTER_DISC;
    def.radius = 0;
    def.speed = 1e-5f;
    def.size0 = def.size1 = 1e-4f;  // all at one place
    add(def);
    makeRig(10000);
    for (int i = 0; i < 15; ++i) frame(0.05f);
    ASSERT_GT(quads(), gpu::fewQuads(true));
    for (uint32_t i = 0; i < quads(); ++i) ASSERT_EQ(kTiles + i, arguments()[gpu::kFlameOrder + i]);
}

// Random depths, equal depths, reversed depths; equal ones keep their order.
TEST_F(ParticlePass, TheRadixSortOrdersSixtyThousandQuads) {
    constexpr uint32_t kQuads = 60000, kDepths = 700;
    makeRig(kQuads);
    const float* m = view_.view;  // its third row points towards the camera
    const vec3 back(m[2], m[6], m[10]);
    const auto depthOf = [](uint32_t kind, uint32_t i) {
        const uint32_t chance = gpu::hash32(i) % kDepths;
        return kind == 0   ? 2 + 0.05f * float(chance)
               : kind == 1 ? 7.0f
                           : 2 + 0.5f * float(i * uint64_t(kDepths) / kQuads);
    };
    for (uint32_t kind = 0; kind < 3; ++kind) {
        for (uint32_t i = 0; i < kQuads; ++i) {
            gpu::FlameQuad& quad = rig_->of<gpu::FlameQuad>(FW_BIND_FLAMES)[kTiles + i];
            quad = {};
            quad.baseHeight = gpu::vec4(back * (-depthOf(kind, i) - m[14]), 0);
        }
        rig_->of<uint32_t>(FW_BIND_DRAW_ARGS)[gpu::kFlameTileQuads] = 0;
        rig_->of<uint32_t>(FW_BIND_DRAW_ARGS)[gpu::kFlameParticleQuads] = kQuads;
        sortAlone();
        ASSERT_EQ(kQuads, quads());
        expectAll(kTiles);
        float last = 1e9f;
        std::map<float, uint32_t> lastOf;  // last quad of each depth
        for (uint32_t i = 0; i < kQuads; ++i) {
            const uint32_t quad = arguments()[gpu::kFlameOrder + i];
            const float depth = depthOf(kind, quad - kTiles);
            ASSERT_LE(depth, last * (1 + 1.0f / 2000)) << kind << " " << i;
            ASSERT_LT(lastOf[depth], quad) << kind << " " << i;
            lastOf[depth] = quad;
            last = depth;
        }
    }
}

TEST_F(ParticlePass, QuadsBeyondTheCapacityAreOmitted) {
    FwFireEmitterDef def = emitterDef(0, 100);
    def.rate = 20000;
    add(def);
    makeRig(5000);
    for (int i = 0; i < 3; ++i) frame(0.3f);
    EXPECT_EQ(5000u, quads());
    expectAll(kTiles);
    const std::vector<float> d = depths();
    for (size_t i = 1; i < d.size(); ++i) ASSERT_GE(d[i - 1], d[i] * (1 - 1.0f / 2000)) << i;
}

// Random depths of covering and additive quads.
class AdditiveQuads : public ParticlePass {
 protected:
    static float depthOf(uint32_t quad) { return 2 + 30 * gpu::hashUnit(quad * 31 + 7); }
    // The draw order of so many of both.
    std::vector<uint32_t> order(uint32_t hiding, uint32_t lights, uint32_t few) {
        makeRig(std::max(hiding, 1u), false, lights);
        room_.few = few;
        const float* m = view_.view;  // its third row points towards the camera
        const auto put = [&](uint32_t place) {
            gpu::FlameQuad& quad = rig_->of<gpu::FlameQuad>(FW_BIND_FLAMES)[place];
            quad = {};
            quad.baseHeight = gpu::vec4(vec3(m[2], m[6], m[10]) * (-depthOf(place) - m[14]), 0);
        };
        for (uint32_t i = 0; i < hiding; ++i) put(kTiles + i);
        firstLight_ = kTiles + std::max(hiding, 1u);
        for (uint32_t i = 0; i < lights; ++i) put(firstLight_ + i);
        const auto words = rig_->of<uint32_t>(FW_BIND_DRAW_ARGS);
        std::fill_n(words.begin(), words.size(), 0xFFFFFFFFu);
        words[gpu::kFlameTileQuads] = 0;
        words[gpu::kFlameParticleQuads] = hiding;
        words[gpu::kFlameEmissiveQuads] = lights;
        sortAlone();
        EXPECT_EQ(hiding + lights, quads());
        std::vector<uint32_t> out(arguments().begin() + gpu::kFlameOrder,
                                  arguments().begin() + gpu::kFlameOrder + quads());
        std::vector<uint32_t> seen = out;
        std::sort(seen.begin(), seen.end());
        for (uint32_t i = 0; i < seen.size(); ++i)
            EXPECT_EQ(i < hiding ? kTiles + i : firstLight_ + i - hiding, seen[i]);
        return out;
    }
    uint32_t firstLight_ = 0;
};

TEST_F(AdditiveQuads, AreNotSortedWithoutCoveringQuads) {
    const std::vector<uint32_t> found = order(0, 5000, gpu::fewQuads(true));
    for (uint32_t i = 0; i < found.size(); ++i) ASSERT_EQ(firstLight_ + i, found[i]);
}

// Each is behind nearer covering quads and in front of farther ones: the transmitted light equals
// that of a full sort. With more than 1,024 covering quads, to within a run of them.
TEST_F(AdditiveQuads, AreOrderedAgainstCoveringQuads) {
    struct {
        uint32_t hiding, lights, few;
    } const cases[] = {{1, 1, 1024},       {1, 700, 1024},     {300, 40, 1024},
                       {1024, 3000, 1024}, {1500, 900, 2048},  {2048, 2048, 2048},
                       {1025, 500, 1024},  {5000, 2000, 1024}, {20000, 4000, 1024}};
    for (const auto& c : cases) {
        SCOPED_TRACE(testing::Message() << c.hiding << " " << c.lights << " " << c.few);
        const std::vector<uint32_t> found = order(c.hiding, c.lights, c.few);
        std::vector<float> sorted;  // of the covering quads
        for (const uint32_t quad : found)
            if (quad < firstLight_) sorted.push_back(depthOf(quad));
        for (size_t i = 1; i < sorted.size(); ++i)
            ASSERT_GE(sorted[i - 1], sorted[i] * (1 - 1.0f / 2000)) << i;
        const size_t run = (c.hiding + 1023) / 1024;
        size_t before = 0;
        for (const uint32_t quad : found) {
            if (quad < firstLight_) {
                ++before;
                continue;
            }
            const float depth = depthOf(quad);
            // Covered but drawn later: at most those of one run, or equally far up to rounding.
            const auto wrong = [&](float d, bool drawn) {
                return drawn ? d < depth * (1 - 1.0f / 1000) : d > depth * (1 + 1.0f / 1000);
            };
            size_t off = 0;
            for (size_t i = 0; i < sorted.size(); ++i) off += wrong(sorted[i], i < before);
            ASSERT_LT(off, run) << quad;
        }
    }
}

// Creation order is draw order: in two frames with equal covering quads and different additive
// ones, no covering quad changes its rank.
TEST_F(AdditiveQuads, DoNotReorderCoveringQuads) {
    const auto hiding = [&](std::vector<uint32_t> all) {
        std::erase_if(all, [&](uint32_t quad) { return quad >= firstLight_; });
        return all;
    };
    for (const uint32_t count : {900u, 3000u}) {
        const auto alone = hiding(order(count, 0, 1024));
        EXPECT_EQ(alone, hiding(order(count, 1, 1024)));
        EXPECT_EQ(alone, hiding(order(count, 2500, 1024)));
    }
}

// An additive flipbook keeps an emitter's fire out of the sort; its smoke is sorted.
TEST_P(ParticleMotion, AdditiveFireIsNotSorted) {
    FwFireEmitterDef def = emitterDef(0, 100);
    def.rate = 400;
    def.life = 1;
    def.smoke = 1;
    def.sparks = 0;
    ParticleReference& one = add(def);
    one.emitter.flipbooks.fire = 1;
    one.emitter.flipbooks.fireEmits = true;
    makeRig(2000, GetParam(), 2000);
    std::fill_n(rig_->of<uint32_t>(FW_BIND_FLIPBOOKS).begin(), gpu::kFlipbookWords, 0u);
    for (int i = 0; i < 30; ++i) frame(0.05f);
    const uint32_t hiding = arguments()[gpu::kFlameParticleQuads];
    const uint32_t lights = arguments()[gpu::kFlameEmissiveQuads];
    EXPECT_GT(lights, 200u);
    EXPECT_GT(hiding, 100u);
    ASSERT_EQ(hiding + lights, quads());
    for (uint32_t i = 0; i < quads(); ++i) {
        const uint32_t place = arguments()[gpu::kFlameOrder + i];
        const uint32_t kind = of<gpu::FlameQuad>(FW_BIND_FLAMES)[place].kind;
        const bool light = place >= kTiles + 2000;
        EXPECT_EQ(light ? gpu::kQuadFire : gpu::kQuadSmoke, kind & 3u);
        EXPECT_EQ(light, (kind & gpu::kQuadEmits) != 0);
    }
}

class SparkPass : public GpuTest {
 protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!device_) return;
        static constexpr uint32_t kBindings[] = {FW_BIND_SPARKS,    FW_BIND_FLAMES,
                                                 FW_BIND_DRAW_ARGS, FW_BIND_VIEW,
                                                 FW_BIND_COUNTERS,  FW_BIND_BURN_TILES};
        static constexpr uint32_t kTexels[] = {FW_BIND_SPARKS}, kUniforms[] = {FW_BIND_VIEW};
        rig_ = std::make_unique<PassRig>(*device_, kBindings, uint32_t(sizeof(gpu::SparkPush)),
                                         kTexels, kUniforms);
        rig_->make(FW_BIND_SPARKS, sizeof(gpu::SparkSource));
        rig_->make(FW_BIND_FLAMES, kQuads * sizeof(gpu::FlameQuad));
        rig_->make(FW_BIND_DRAW_ARGS, gpu::kFlameOrder * 4);
        rig_->make(FW_BIND_COUNTERS, sizeof(gpu::IterationCounters));
        rig_->make(FW_BIND_BURN_TILES, kBurnTiles * sizeof(gpu::BurnTile));
        const float eye[3] = {0, 2, 9}, at[3] = {0, 1, 0};
        const FwView view = testView(eye, at, 50, 1, false);
        gpu::ViewInput input;
        input.view = &view;
        input.viewport[2] = input.viewport[3] = 512;
        const gpu::ViewParams params = gpu::makeViewParams(input);
        rig_->make(FW_BIND_VIEW, sizeof params, &params);
        pass_ = rig_->add("sparks.comp");
        byTexels_ = rig_->add("sparks_texels.comp");
    }
    void TearDown() override {
        rig_.reset();
        GpuTest::TearDown();
    }
    // Quads of a frame by their seed bits; duplicates are left out.
    std::map<uint32_t, gpu::FlameQuad> shown(const gpu::SparkSource& source,
                                             bool byTexels = false) {
        rig_->of<gpu::SparkSource>(FW_BIND_SPARKS)[0] = source;
        const auto arguments = rig_->of<uint32_t>(FW_BIND_DRAW_ARGS);
        std::fill_n(arguments.begin(), gpu::kFlameOrder, 0u);
        const gpu::SparkPush push{kQuads, 0, 0, 0};
        device_->run([&](VkCommandBuffer commands) {
            rig_->begin(commands);
            rig_->dispatch(commands, byTexels ? byTexels_ : pass_, &push, gpu::kSparkGroups);
        });
        std::map<uint32_t, gpu::FlameQuad> out;
        std::map<uint32_t, int> met;
        EXPECT_EQ(0u, arguments[gpu::kFlameParticleQuads]);  // the sort sees none of them
        count_ = arguments[gpu::kFlameEmissiveQuads];
        for (uint32_t i = 0; i < std::min(count_, kQuads); ++i) {
            const gpu::FlameQuad& quad = rig_->of<gpu::FlameQuad>(FW_BIND_FLAMES)[i];
            EXPECT_EQ(gpu::kQuadSpark, quad.kind & 3u);
            out[quad.kind >> gpu::kQuadSeed] = quad;
            ++met[quad.kind >> gpu::kQuadSeed];
        }
        for (const auto& one : met)
            if (one.second > 1) out.erase(one.first);
        return out;
    }
    static vec3 placeOf(const gpu::FlameQuad& quad) {
        return vec3(quad.baseHeight) +
               vec3(quad.axisWidth) * (quad.baseHeight.w - quad.axisWidth.w);
    }

    static constexpr uint32_t kQuads = 4096;
    std::unique_ptr<PassRig> rig_;
    uint32_t pass_ = 0, byTexels_ = 0, count_ = 0;
};

// By words and by texels.
TEST_F(SparkPass, FollowTheLibrarysHeightfield) {
    if (!device_) return;
    SparkRig rig(200);
    for (int i = 0; i < 150; ++i) ASSERT_TRUE(rig.step(1 / 30.0f));
    rig.makeHill();
    rig.record.flags &= ~gpu::kSparkGround;
    rig.record.up.w = -1e9f;
    const std::vector<Spark> wanted = rig.sparks();
    for (const bool byTexels : {false, true}) {
        const auto seen = shown(rig.record, byTexels);
        size_t found = 0, bounced = 0;
        for (const Spark& one : wanted) {
            const auto at = seen.find(one.now.seed & 0xFFFFu);
            if (at == seen.end()) continue;  // too faded to show
            ++found;
            bounced += one.leg.began > 0;
            EXPECT_LT(glm::length(placeOf(at->second) - one.place), 0.04f) << one.slot;
        }
        EXPECT_LT(150u, found);
        EXPECT_LT(10u, bounced);
    }
}

// At the library's places; the same time shows the same sparks, whatever ran in between.
TEST_F(SparkPass, DependOnTheClockOnly) {
    if (!device_) return;
    SparkRig rig(200);
    for (int i = 0; i < 150; ++i) ASSERT_TRUE(rig.step(1 / 30.0f));
    const gpu::SparkSource then = rig.record;
    const std::vector<Spark> wanted = rig.sparks();
    const auto first = shown(then);
    size_t found = 0;
    for (const auto& [seed, quad] : first) {
        // A streak of a fiftieth of a second, as thin as a pixel.
        EXPECT_LT(quad.axisWidth.w, 0.03f);
        EXPECT_LT(quad.baseHeight.w, 0.6f);
        EXPECT_LE(quad.opacity, 1.0f);
        EXPECT_GT(quad.kelvin, 850.0f);
    }
    for (const Spark& one : wanted) {
        const auto at = first.find(one.now.seed & 0xFFFFu);
        if (at == first.end()) continue;  // too faded to show
        ++found;
        // A bounce a moment earlier or later is at most that far away.
        EXPECT_LT(glm::length(placeOf(at->second) - one.place), 0.03f) << one.slot;
        EXPECT_GT(placeOf(at->second).y, 0.5f);
    }
    EXPECT_LT(150u, found);
    ASSERT_TRUE(rig.step(0.7f));
    const auto other = shown(rig.record);
    const auto again = shown(then);
    ASSERT_EQ(first.size(), again.size());
    for (const auto& [seed, quad] : first)
        EXPECT_EQ(0, std::memcmp(&quad, &again.at(seed), sizeof quad));
    size_t moved = 0;
    for (const auto& [seed, quad] : first)
        moved += !other.count(seed) || placeOf(other.at(seed)) != placeOf(quad);
    EXPECT_EQ(moved, first.size());
}

// With tiles of two meshes, sparks use only their own mesh's, in proportion to power.
TEST_F(SparkPass, AreThrownByTheTilesOfTheirMeshByPower) {
    if (!device_) return;
    SparkRig rig(100);
    ASSERT_TRUE(rig.step(3));
    gpu::SparkSource source = rig.record;
    source.object = 5;
    for (gpu::vec4& key : source.keys) key.w = 1;
    source.up.w = -1;  // the ground is far below
    const auto tiles = rig_->of<gpu::BurnTile>(FW_BIND_BURN_TILES);
    for (uint32_t i = 0; i < kBurnTiles; ++i) {
        tiles[i] = {};
        tiles[i].object = i % 2 ? 4 : 2;
        tiles[i].tile = i;
        tiles[i].positionArea = {100.0f * float(i), 1, 0, 0.01f};
        tiles[i].normalPower = {0, 0, 1, i % 4 == 1 ? 900.0f : 300.0f};
    }
    rig_->of<gpu::IterationCounters>(FW_BIND_COUNTERS)[0].runCount = kBurnTiles;
    uint32_t weak = 0, strong = 0, elsewhere = 0;
    for (uint32_t turn = 0; turn < 40; ++turn) {
        source.turn = turn;
        source.part = 0.618f * float(turn) - std::floor(0.618f * float(turn));
        for (const auto& [seed, quad] : shown(source)) {
            const auto tile = uint32_t(std::max(placeOf(quad).x + 50, 0.0f) / 100);
            ++(tile % 2 == 0 ? elsewhere : tile % 4 == 1 ? strong : weak);
        }
    }
    std::printf("[   FIGURE ] sparks of strong tiles %u, of weak ones %u, of others %u\n", strong,
                weak, elsewhere);
    EXPECT_EQ(0u, elsewhere);
    EXPECT_LT(100u, weak);
    EXPECT_NEAR(double(strong) / weak, 3, 0.6);
    rig_->of<gpu::IterationCounters>(FW_BIND_COUNTERS)[0].runCount = 0;
    (void)shown(source);
    EXPECT_EQ(0u, count_);
}

}  // namespace
}  // namespace fw::test
