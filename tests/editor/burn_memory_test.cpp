// The recorded history of a burn that the editor scrubs through, on the cpu backend, which reports
// at once.
#include "document/burn_memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "editor/yard.h"

namespace {

using namespace fwtest;

// The burning board with a memory.
struct Remembered {
    Yard yard;
    std::unique_ptr<Burn> burn;
    BurnMemory memory;
    std::shared_ptr<const PaintSurface> surface;
    ObjectId board = 0;

    explicit Remembered(const std::string& more = "") {
        yard.run(kBoard);
        yard.run(more);
        std::string error;
        FwContext* cpu = yard.host->cpu(error);
        const Document& document = yard.host->document;
        burn =
            createBurn(cpu, document.scene, document.images, yard.folder, yard.host->assets, error);
        board = document.scene.meshes[0].id;
        surface =
            paintSurfaceOf(cpu, document.scene.meshes[0], yard.folder, yard.host->assets, error);
        EXPECT_TRUE(burn && surface) << error;
        memory.begin(*burn);
    }
    void runTo(double time) {
        constexpr float kStep = 0.125f;
        std::string error;
        while (burn->time < time - 1e-6) {
            memory.beforeFrame(*burn, kStep);
            ASSERT_TRUE(feedBurn(*burn, kStep, error)) << error;
            ASSERT_EQ(FW_OK, fwWorld_Step(burn->world, kStep));
            memory.afterFrame(*burn);
        }
    }
    // Frames after the burn went to sleep.
    void rest() {
        for (int i = 0; i < 4 && memory.isPending(); ++i) {
            memory.beforeFrame(*burn, 0);
            ASSERT_EQ(FW_OK, fwWorld_Step(burn->world, 0));
            memory.afterFrame(*burn);
        }
    }
    std::vector<uint8_t> ages(double time) const {
        std::vector<uint8_t> values;
        EXPECT_TRUE(memory.agesAt(*burn, board, *surface, time, values));
        return values;
    }
};

size_t litOf(const std::vector<uint8_t>& ages) {
    return size_t(std::count_if(ages.begin(), ages.end(), [](uint8_t age) { return age > 0; }));
}

TEST(BurnMemory, IsEmptyBeforeTheFirstFrame) {
    Remembered one;
    EXPECT_FALSE(one.memory.isKnown(0));
    std::vector<uint8_t> values;
    EXPECT_FALSE(one.memory.agesAt(*one.burn, one.board, *one.surface, 0, values));
    EXPECT_FALSE(one.memory.timesOf(*one.burn, one.board, values));
    EXPECT_FALSE(one.memory.restore(*one.burn, 0));
}

TEST(BurnMemory, AgesGrowWithTimeAndMatchTheWholeBurn) {
    Remembered one;
    one.runTo(6);
    one.rest();
    EXPECT_FALSE(one.memory.isPending());
    EXPECT_NEAR(6, one.memory.known(), 1e-6);
    EXPECT_TRUE(one.memory.isKnown(3));
    EXPECT_FALSE(one.memory.isKnown(7));
    EXPECT_EQ(0u, litOf(one.ages(-0.1)));
    const auto early = one.ages(2), late = one.ages(5);
    EXPECT_GT(litOf(early), 20u);
    EXPECT_GT(litOf(late), litOf(early));
    for (size_t i = 0; i < early.size(); ++i) EXPECT_LE(early[i], late[i]) << i;
    // Equal to a separately recorded burn.
    one.yard.run("burn\n");
    const ArrivalField& field = one.yard.host->record.fields[0];
    ASSERT_EQ(field.seconds.size(), late.size());
    size_t off = 0;
    for (size_t i = 0; i < late.size(); ++i)
        off += one.surface->real[i] && (late[i] > 0) != (field.seconds[i] <= 5);
    EXPECT_LE(off, late.size() / 1000);
}

TEST(BurnMemory, ReportsWhenASpotCaught) {
    Remembered one;
    one.runTo(6);
    one.rest();
    one.yard.run("burn\n");
    const ArrivalField& field = one.yard.host->record.fields[0];
    size_t lit = 0, off = 0;
    for (size_t i = 0; i < field.seconds.size(); ++i) {
        if (!one.surface->real[i]) continue;
        const double caught = one.memory.caughtAt(one.board, i);
        lit += caught >= 0;
        off += caught >= 0 ? std::fabs(caught - double(field.seconds[i])) > 1.0 / 32
                           : field.seconds[i] < 5.9f;
    }
    EXPECT_GT(lit, 100u);
    EXPECT_LE(off, lit / 100);
    EXPECT_LT(one.memory.caughtAt(one.board, field.seconds.size()), 0);
    EXPECT_LT(one.memory.caughtAt(one.board + 9, 0), 0);
}

TEST(BurnMemory, StoresTimesAsSharesOfTheTimeline) {
    Remembered one("set settings duration 10\n");
    one.runTo(5);
    one.rest();
    std::vector<uint8_t> times;
    ASSERT_TRUE(one.memory.timesOf(*one.burn, one.board, times));
    const auto ages = one.ages(5);
    uint8_t latest = 0;
    for (size_t i = 0; i < times.size(); ++i) {
        EXPECT_EQ(ages[i] == 0, times[i] == 255) << i;
        if (times[i] < 255) latest = std::max(latest, times[i]);
    }
    EXPECT_GT(latest, 100);  // half of the timeline is 127
    EXPECT_LE(latest, 128);
}

TEST(BurnMemory, RestoresTheLatestKeyframeAndContinues) {
    Remembered one("set settings duration 24\n");
    one.runTo(12);
    one.rest();
    const auto before = one.ages(12);
    ASSERT_TRUE(one.memory.restore(*one.burn, 8));
    EXPECT_GT(one.burn->time, 0);  // not from the start
    EXPECT_LE(one.burn->time, 8);
    EXPECT_TRUE(one.memory.isKnown(12));  // the seen history stays
    EXPECT_EQ(before, one.ages(12));
    one.runTo(12);
    one.rest();
    EXPECT_EQ(before, one.ages(12));
    ASSERT_TRUE(one.memory.restore(*one.burn, 0.01));
    EXPECT_NEAR(0, one.burn->time, 0.2);
}

TEST(BurnMemory, CanBeCleared) {
    Remembered one;
    one.runTo(2);
    one.rest();
    EXPECT_TRUE(one.memory.isKnown(1));
    one.memory.forget();
    EXPECT_FALSE(one.memory.isKnown(0));
    EXPECT_FALSE(one.memory.restore(*one.burn, 1));
}

}  // namespace
