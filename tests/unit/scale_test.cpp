// Cost must follow moving and burning objects: boxes found by place, lists per object, balls over
// whole objects. Work is counted, never timed.
#include "components/exchange_object.h"
#include "core/error.h"
#include "core/growth.h"
#include "fire/presets.h"
#include "gpu/cpu/cpu_backend.h"
#include "mesh/exchange_tiles.h"
#include "support/world_defs.h"
#include "world/box_grid.h"
#include "world/list_pool.h"
#include "world/neighbours.h"
#include "world/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>

namespace fw::test::scale_test {
namespace {

std::pmr::memory_resource* memory() { return std::pmr::new_delete_resource(); }

using Random = std::mt19937;

// Boxes of the size of crates, houses and grounds, near and far.
mesh::Box randomBox(Random& random) {
    const int sides[] = {1, 300, 8000, 400000};
    const int side = sides[random() % 4], around = random() % 8 == 0 ? 1900000000 : 60000;
    mesh::Box box;
    for (int i = 0; i < 3; ++i) {
        const int size = 1 + int(random() % uint32_t(side));
        const int middle = (int(random() % uint32_t(around / 50)) - around / 100) * 100;
        box.low[i] = middle - size / 2;
        box.high[i] = box.low[i] + size;
    }
    return box;
}

struct Placed {
    mesh::Box box;
    uint32_t reach = 0;
    bool there = false;
};

bool near(const Placed& a, const Placed& b) {
    return mesh::gapOf(a.box, b.box) <= int64_t(std::max(a.reach, b.reach));
}

TEST(BoxGrid, FindsBoxesWithinReach) {
    Random random(5);
    world::BoxGrid grid(memory());
    std::vector<Placed> placed(600);
    for (int turn = 0; turn < 3000; ++turn) {
        const uint32_t slot = random() % placed.size();
        Placed& one = placed[slot];
        one.there = random() % 8 != 0;
        if (one.there) {
            one.box = randomBox(random);
            one.reach = random() % 20000;
            grid.place(slot, one.box, one.reach);
        } else {
            grid.remove(slot);
        }
        EXPECT_EQ(one.there, grid.has(slot));
        Placed asks;
        asks.box = randomBox(random);
        asks.reach = random() % 5000;
        std::vector<uint32_t> found, expected;
        grid.each(asks.box, asks.reach, [&](uint32_t other) { found.push_back(other); });
        for (uint32_t i = 0; i < placed.size(); ++i)
            if (placed[i].there && near(asks, placed[i])) expected.push_back(i);
        std::sort(found.begin(), found.end());
        ASSERT_EQ(expected, found) << turn;
    }
    grid.clear();
    grid.each(randomBox(random), 2000000000, [&](uint32_t) { ADD_FAILURE(); });
}

TEST(BoxGrid, VisitsFewOfManyBoxes) {
    world::BoxGrid grid(memory());
    const auto boxAt = [](int x, int z) {
        mesh::Box box;
        box.low[0] = x * 700, box.low[1] = 0, box.low[2] = z * 700;
        box.high[0] = x * 700 + 400, box.high[1] = 400, box.high[2] = z * 700 + 400;
        return box;
    };
    for (int i = 0; i < 10000; ++i) grid.place(uint32_t(i), boxAt(i % 100, i / 100), 0);
    uint32_t found = 0;
    grid.each(boxAt(50, 50), 1000, [&](uint32_t) { ++found; });
    EXPECT_EQ(25u, found);  // boxes two rows away are at 1 m
    EXPECT_LT(grid.examined(), 100u);
}

TEST(ListPool, KeepsListsApartAndReportsChanges) {
    Random random(11);
    world::ListPool<uint32_t> pool(memory(), ~0u);
    pool.addLists(40);
    std::vector<std::vector<uint32_t>> lists(40);
    std::vector<uint32_t> copy;  // as a backend holds it
    std::pmr::vector<gpu::ExchangeUpdate::Range> ranges(memory());
    for (int turn = 0; turn < 4000; ++turn) {
        const uint32_t i = random() % uint32_t(lists.size());
        std::vector<uint32_t>& list = lists[i];
        if (random() % 40 == 0) {
            pool.drop(i);
            list.clear();
        } else if (!list.empty() && random() % 3 == 0) {
            const uint32_t at = random() % uint32_t(list.size());
            pool.erase(i, at);
            list.erase(list.begin() + at);
        } else {
            const uint32_t at = random() % (uint32_t(list.size()) + 1), value = random() % 1000;
            pool.reserve(i, uint32_t(list.size()) + 1);
            pool.insert(i, at, value);
            list.insert(list.begin() + at, value);
        }
        if (random() % 5 == 0) {
            pool.listChanges(ranges);
            copy.resize(pool.all().size());
            for (const auto& range : ranges)
                std::copy_n(pool.all().begin() + range.first, range.count,
                            copy.begin() + range.first);
            pool.settle();
            ASSERT_TRUE(std::equal(copy.begin(), copy.end(), pool.all().begin())) << turn;
            size_t used = 0;
            for (uint32_t k = 0; k < lists.size(); ++k) {
                const auto stored = pool.of(k);
                ASSERT_TRUE(
                    std::equal(lists[k].begin(), lists[k].end(), stored.begin(), stored.end()));
                used += lists[k].size();
            }
            ASSERT_EQ(used, size_t(std::count_if(copy.begin(), copy.end(),
                                                 [](uint32_t v) { return v != ~0u; })));
        }
    }
    EXPECT_LT(pool.all().size(), 40u * 400);
}

TEST(Neighbours, EqualBruteForceAfterEveryMove) {
    Random random(7);
    world::Neighbours neighbours(memory());
    std::vector<Placed> placed(150);
    for (int turn = 0; turn < 2000; ++turn) {
        const uint32_t slot = random() % placed.size();
        Placed& one = placed[slot];
        one.there = random() % 10 != 0;
        if (one.there) {
            one.box = randomBox(random);
            one.reach = 100 + random() % 9000;
            neighbours.place(slot, one.box, one.reach);
        } else {
            neighbours.remove(slot);
        }
        if (turn % 20 != 0) continue;
        for (uint32_t i = 0; i < placed.size(); ++i) {
            std::vector<uint32_t> expected, found;
            for (uint32_t k = 0; k < placed.size(); ++k)
                if (k != i && placed[i].there && placed[k].there && near(placed[i], placed[k]))
                    expected.push_back(k);
            for (const uint32_t entry : neighbours.of(i)) {
                found.push_back(entry & world::Neighbours::kSlot);
                EXPECT_EQ(255u, entry >> 24);
            }
            ASSERT_EQ(expected, found) << turn << ", " << i;
        }
    }
}

TEST(GrowTo, GrowsGeometrically) {
    std::pmr::vector<int> values(memory());
    size_t moves = 0;
    for (int i = 0; i < 10000; ++i) {
        const int* before = values.data();
        core::growTo(values, values.size() + 1);
        moves += before != values.data() ? 1 : 0;
        values.push_back(i);
    }
    EXPECT_LT(moves, 20u);
}

// ---- worlds

// Counts requested bytes.
class CountingMemory : public std::pmr::memory_resource {
 public:
    uint64_t bytes = 0;

 private:
    void* do_allocate(size_t size, size_t alignment) override {
        bytes += size;
        return std::pmr::new_delete_resource()->allocate(size, alignment);
    }
    void do_deallocate(void* block, size_t size, size_t alignment) override {
        std::pmr::new_delete_resource()->deallocate(block, size, alignment);
    }
    bool do_is_equal(const memory_resource& other) const noexcept override {
        return this == &other;
    }
};

constexpr uint32_t kAllModes =
    FW_WORLD_RADIATION | FW_WORLD_PLUME | FW_WORLD_CONTACT | FW_WORLD_EMBERS;

struct Square {  // a square of crates
    CountingMemory memory;
    core::Log log{FwCallbacks{}};
    gpu::cpu::CpuBackend backend{&memory, 4};
    std::unique_ptr<world::World> world;
    FwBurnableMeshDef def{};
    std::vector<FwBurnableMeshId> ids;
    uint32_t side = 0;
    float apart = 0.7f;
    uint64_t frame = 0;

    explicit Square(uint32_t count, uint32_t flags = kAllModes, float apart_ = 0.7f,
                    uint32_t preset = FW_MATERIAL_PINE)
        : apart(apart_) {
        FwWorldDef worldDef = plainWorldDef(flags);
        worldDef.paceFactor = 10;
        world = std::make_unique<world::World>(worldDef, backend, log, &memory);
        const Mesh crate = makeCube(0.4, 1);
        FwMeshDef mesh = plainMeshDef(crate, 20);
        mesh.mapSize = 64;
        def = plainBurnableDef(world->scene().createMesh(mesh));
        def.materials[0] = world->scene().createMaterial(fire::presetDef(preset));
        for (const int i : {0, 5, 10, 15}) def.transform[i] = 1;
        while (side * side < count) ++side;
        for (uint32_t i = 0; i < count; ++i) {
            place(i, 0);
            ids.push_back(world->createBurnableMesh(def));
        }
    }
    void place(uint32_t i, float shift) {
        def.transform[12] = apart * float(i % side) + shift;
        def.transform[14] = apart * float(i / side);
    }
    void move(uint32_t i, float shift) {
        place(i, shift);
        world->setTransform(ids[i], def.transform);
    }
    void step(uint32_t count = 1) {
        for (uint32_t i = 0; i < count; ++i) world->advance(++frame, 1.0f / 32);
    }
    uint32_t ball(uint32_t kind, float x, float y, float z, float radius, uint32_t object1 = 0) {
        FwIgnitionDef ignition{};
        ignition.kind = kind;
        ignition.position[0] = x, ignition.position[1] = y, ignition.position[2] = z;
        ignition.radius = radius;
        if (object1 != 0) ignition.object = ids[object1 - 1];
        return world->burn().ignite(ignition);
    }
    void light() {
        ASSERT_GT(ball(FW_IGNITE, 0, 0.2f, 0, 0.1f, 1), 0u);
        step(8);
    }
};

uint64_t pairsOfOneWalk(uint32_t count) {
    Square square(count);
    square.light();
    const uint64_t before = square.world->exchange().pairsExamined();
    for (uint32_t i = 0; i < 8; ++i) {
        square.move(count / 2, 0.02f * float(i + 1));
        square.step(4);
    }
    return square.world->exchange().pairsExamined() - before;
}

TEST(World, ComparesAMovingObjectWithItsNeighboursOnly) {
    const uint64_t few = pairsOfOneWalk(400), many = pairsOfOneWalk(1600);
    std::printf("[   FIGURE ] 8 moves: %llu boxes compared among 400 crates, %llu among 1600\n",
                static_cast<unsigned long long>(few), static_cast<unsigned long long>(many));
    EXPECT_GT(few, 0u);
    EXPECT_LT(many, 3 * few);
    EXPECT_LT(many, 8u * 1600);
}

TEST(World, ComparesNothingWhileNothingMoves) {
    Square square(100);
    square.light();
    const uint64_t before = square.world->exchange().pairsExamined();
    square.step(32);
    EXPECT_EQ(before, square.world->exchange().pairsExamined());
}

TEST(World, ExplainsAMissByNearbyCratesOnly) {
    Square square(1600);
    const uint64_t before = square.world->scene().places.examined();
    FwIgnitionDef match{};
    match.position[0] = 10 * square.apart + 0.35f;
    match.position[1] = 1.5f;
    match.position[2] = 10 * square.apart;
    match.radius = 0.1f;
    char text[256];
    square.world->burn().explainMiss(match, 0, text);
    EXPECT_NE(std::string::npos, std::string(text).find("the nearest burnable mesh")) << text;
    const uint64_t compared = square.world->scene().places.examined() - before;
    std::printf("[   FIGURE ] %llu boxes of 1600 crates\n",
                static_cast<unsigned long long>(compared));
    EXPECT_GT(compared, 0u);
    EXPECT_LT(compared, 800u);
}

TEST(World, MemoryOfRainIsProportionalToCrates) {
    uint64_t bytes[2];
    for (const bool twice : {false, true}) {
        Square square(twice ? 800 : 400, 0);
        square.step();
        const uint64_t before = square.memory.bytes;
        EXPECT_GT(square.ball(FW_WET, 5, 0, 5, 1000), 0u);
        square.step();
        bytes[twice] = square.memory.bytes - before;
    }
    EXPECT_LT(bytes[1], 3 * bytes[0] + 65536);
}

TEST(World, MemoryOfPartialBallsIsProportionalToTexels) {
    uint64_t bytes[2];
    for (const bool twice : {false, true}) {
        Square square(1, 0);
        const uint64_t before = square.memory.bytes;
        for (uint32_t i = 0; i < (twice ? 2000u : 1000u); ++i)
            EXPECT_GT(square.ball(FW_IGNITE, 0.2f, 0, 0, 0.25f, 1), 0u);
        bytes[twice] = square.memory.bytes - before;
    }
    EXPECT_LT(bytes[1], 3 * bytes[0]);
}

// A ball around an object is one event that equals one event per texel.
TEST(World, ABallAroundAnObjectEqualsEventsOfItsTexels) {
    for (const uint32_t kind : {FW_IGNITE, FW_WET, FW_DRY, FW_EXTINGUISH})
        for (const uint32_t preset : {FW_MATERIAL_PINE, FW_MATERIAL_PAPER})
            for (const bool mixed : {false, true}) {
                Square ball(1, 0, 1, preset), texels(1, 0, 1, preset);
                const mesh::BurnDomain& domain = ball.world->scene().objectDomain(ball.ids[0]);
                std::vector<uint32_t> all;
                for (uint32_t i = 0; i < domain.texelCount(); ++i)
                    if (domain.real(i)) all.push_back(i);
                for (Square* one : {&ball, &texels}) {
                    one->ball(FW_IGNITE, 0.2f, 0.2f, 0.2f, 0.15f, 1);
                    one->step(40);
                    one->ball(FW_WET, -0.2f, 0, 0, 0.1f, 1);
                    one->step(2);
                }
                EXPECT_EQ(all.size(), ball.ball(kind, 0.5f, 0, 0, 100));
                texels.world->burn().pushTexels(texels.ids[0], kind, all);
                for (Square* one : {&ball, &texels}) {
                    if (mixed) one->ball(FW_IGNITE, 0, 0.2f, 0, 0.1f, 1);
                    one->step(1);
                }
                for (int i = 0; i < 3; ++i) {
                    const auto a = ball.backend.state(0), b = texels.backend.state(0);
                    ASSERT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()))
                        << kind << ", " << preset << ", " << mixed << ", " << i;
                    const auto c = ball.backend.heat(0), d = texels.backend.heat(0);
                    ASSERT_TRUE(std::equal(c.begin(), c.end(), d.begin(), d.end()));
                    EXPECT_EQ(ball.backend.counters(0).ignited, texels.backend.counters(0).ignited);
                    EXPECT_EQ(ball.backend.counters(0).lastIgnition,
                              texels.backend.counters(0).lastIgnition);
                    ball.step(16);
                    texels.step(16);
                }
            }
}

TEST(World, ABallReachesObjectsFarFromItsCentre) {
    for (const uint32_t kind : {FW_IGNITE, FW_WET, FW_DRY, FW_EXTINGUISH})
        for (const float away : {1.0f, 17.0f, 25.0f, 400.0f, 30000.0f, 900000.0f}) {
            Square square(1, 0);
            const uint32_t texels =
                square.world->scene().objectDomain(square.ids[0]).report.realTexels;
            EXPECT_EQ(texels, square.ball(kind, away, 0, 0, 1.1f * away + 1)) << kind << away;
            EXPECT_EQ(texels, square.ball(kind, away, 0, 0, 1.1f * away + 1, 1)) << kind << away;
            EXPECT_EQ(0u, square.ball(kind, away, 0, 0, 0.4f * away)) << kind << away;
        }
}

// Half of a crate, by a ball whose centre is many crates away.
TEST(World, ADistantBallReachesOnlyTheTexelsInside) {
    for (const float away : {20.0f, 300.0f}) {
        Square square(1, 0);
        const uint32_t all = square.world->scene().objectDomain(square.ids[0]).report.realTexels;
        const uint32_t some = square.ball(FW_WET, away, 0, 0, away);
        EXPECT_GT(some, all / 4) << away;
        EXPECT_LT(some, 3 * all / 4) << away;
    }
}

TEST(World, PointQueryFindsTheNearestTexelOfAFarObject) {
    for (const float away : {20.0f, 5000.0f, 900000.0f}) {
        Square square(1, 0);
        const float point[3] = {away, 0.1f, 0};
        EXPECT_NO_THROW(square.world->queries().tagPoint(square.ids[0], point, 1)) << away;
        const FwQueryId query = square.world->queries().requestPoint(square.ids[0], point);
        square.step(2);
        FwPointState state{};
        ASSERT_TRUE(square.world->queries().fetchPoint(query, state));
        EXPECT_NEAR(away - 0.2f, state.distance, 0.05f + 1e-6f * away);
    }
}

TEST(BurnDomain, NearestTexelIsFoundFromAnyDistance) {
    Square square(1, 0);
    const mesh::BurnDomain& domain = square.world->scene().objectDomain(square.ids[0]);
    for (const float away : {3.0f, 50.0f, 1e4f, 1e6f, 1e9f}) {
        const float point[3] = {-away, 0.15f, 0.1f};
        const uint32_t texel = mesh::nearestTexel(domain, point, 1.01f * away);
        ASSERT_NE(mesh::kNone, texel) << away;
        EXPECT_EQ(mesh::kNone, mesh::nearestTexel(domain, point, 0.9f * away - 0.5f)) << away;
        if (away > 1e6f) continue;  // at that distance floats cannot resolve a crate
        EXPECT_LT(domain.texels[texel].x * double(domain.quantum), 0.05) << away;
    }
}

// Lists updated per object must equal those that a world builds from a save.
TEST(World, IncrementalListsEqualThoseOfALoadedWorld) {
    for (const uint32_t flags : {kAllModes, uint32_t(FW_WORLD_RADIATION | FW_WORLD_CONTACT)}) {
        constexpr uint32_t kCount = 36;
        Square first(kCount, flags, 0.42f, FW_MATERIAL_PAPER);
        Square second(kCount, flags, 0.42f, FW_MATERIAL_PAPER);
        Random random(3);
        for (const uint32_t object1 : {1u, 15u})
            EXPECT_GT(first.ball(FW_IGNITE, 0.42f * float((object1 - 1) % 6), 0.2f,
                                 0.42f * float((object1 - 1) / 6), 0.3f, object1),
                      0u);
        std::vector<float> shifts(kCount, 0.0f);
        const auto play = [&](std::vector<Square*> squares, uint32_t frames) {
            for (uint32_t i = 0; i < frames; ++i) {
                for (uint32_t k = 0; k < 6; ++k) {
                    const uint32_t slot = random() % kCount;
                    shifts[slot] = float(random() % 100) * 0.002f - 0.1f;
                    for (Square* one : squares) one->move(slot, shifts[slot]);
                }
                for (Square* one : squares) one->step(3);
            }
        };
        play({&first}, 30);
        first.world->persistence().requestSave();
        first.step();
        const std::pmr::vector<std::byte>* save = first.world->persistence().fetchSave();
        ASSERT_TRUE(save);
        second.step(uint32_t(first.frame));
        second.world->persistence().load(*save);
        play({&first, &second}, 60);
        uint32_t caught = 0;
        for (uint32_t slot = 0; slot < kCount; ++slot) {
            const auto a = first.backend.state(slot), b = second.backend.state(slot);
            ASSERT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end())) << slot;
            caught += first.backend.counters(slot).ignited > 0 ? 1 : 0;
        }
        EXPECT_GT(caught, 3u);
    }
}

// 2^20 cells of 50 mm from the origin, where cell numbers gain a bit.
TEST(Contacts, AreFoundAnywhereInTheWorld) {
    Square square(1, 0);
    const mesh::BurnDomain& domain = square.world->scene().objectDomain(square.ids[0]);
    const auto count = [&](float at) {
        gpu::ExchangeObject places[2] = {};
        for (int i = 0; i < 2; ++i) {
            components::Pose pose;
            pose.translation[0] = at + 0.42f * float(i);
            pose.translation[1] = pose.translation[2] = at;
            components::placeExchangeObject(pose, domain, places[i]);
        }
        mesh::Contacts contacts(memory());
        mesh::findContacts({{&domain, &places[0], 1}, {&domain, &places[1], 1}}, contacts);
        return contacts.found[0].size();
    };
    const size_t here = count(0);
    EXPECT_GT(here, 0u);
    for (const float at : {-52428.8f, 52428.8f, 104857.6f, -900000.0f})
        EXPECT_NEAR(double(here), double(count(at)), 0.5 * double(here)) << at;
}

TEST(World, RefusesAnOccluderScaledTooLarge) {
    Square square(1, 0);
    FwHeatOccluderDef def{};
    def.structSize = sizeof def;
    for (const int i : {0, 5, 10}) def.transform[i] = 4;
    def.transform[15] = 1;
    for (float& half : def.halfSize) half = 7;
    const FwHeatOccluderId id = square.world->exchange().addHeatOccluder(def);  // 28 m
    for (const int i : {0, 5, 10}) def.transform[i] = 5;
    EXPECT_THROW((void)square.world->exchange().addHeatOccluder(def), core::Error);
    EXPECT_THROW(square.world->exchange().moveHeatOccluder(id, def.transform), core::Error);
}

TEST(World, DestroyedNeighboursAreForgotten) {
    Square square(25, kAllModes, 0.42f);
    square.light();
    square.step(40);
    for (const uint32_t slot : {6u, 7u, 12u, 1u})
        square.world->destroyBurnableMesh(square.ids[slot]);
    square.step(9);
    for (const uint32_t slot : {1u, 6u, 12u}) {
        square.place(slot, 0);
        square.ids[slot] = square.world->createBurnableMesh(square.def);
        square.step(3);
    }
    square.world->persistence().requestSave();
    square.step();
    EXPECT_TRUE(square.world->persistence().fetchSave());
    square.step(64);
}

}  // namespace
}  // namespace fw::test::scale_test
