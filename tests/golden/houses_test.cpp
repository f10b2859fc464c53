// A hundred low-poly houses burn while a camera moves down their street, so that levels change and
// the triangle budget is short. The budget holds in every frame, nothing pops, and a frame costs
// little more than its draws. Popping is measured against the same frames at full detail: their
// difference may change little from frame to frame. FLAMEWRIGHT_MOTION=<folder> keeps the frames.
#include "support/houses.h"
#include "support/cpu_time.h"
#include "support/own_world.h"
#include "support/sanitized.h"

#include <cstdlib>

namespace fw::test::houses_test {
namespace {

constexpr uint32_t kWidth = 320, kHeight = 180, kBlock = 12;  // px
constexpr uint32_t kHouses = rounds(100, 12), kFrames = rounds(24, 5);
constexpr uint32_t kBudget = rounds(13500, 1500);
constexpr float kFrameTime = 1.0f / 30;
constexpr float kWarmUp = 6;  // s
constexpr float kSpeed = 6;   // m/s, of the camera

struct Popping {       // in 1/255
    double mean = 0;   // mean change of covered pixels over all frames
    double worst = 0;  // the frame that changes most
    double block = 0;  // the block of kBlock^2 px that changes most
    double share = 0;  // share of covered pixels that change by more than 48, in the worst frame
};

class Houses : public OwnDevice {
 protected:
    static Picture draw(const Village& village, const FwView& view) {
        return pictureOf(village.world, view, kWidth, kHeight);
    }
};

// Two pictures of one view, before and after a frame's time.
void addChange(const Picture& before, const Picture& after, Popping& p, uint32_t frames = kFrames) {
    constexpr uint32_t kAcross = kWidth / kBlock;
    std::vector<double> blocks(size_t{kAcross + 1} * (kHeight / kBlock + 1));
    uint64_t covered = 1, sum = 0, far = 0;
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            const size_t at = (size_t{y} * kWidth + x) * 3;
            int change = 0;
            for (size_t c = 0; c < 3; ++c)
                change =
                    std::max(change, std::abs(int(after.rgb[at + c]) - int(before.rgb[at + c])));
            covered += std::memcmp(&after.rgb[at], after.rgb.data(), 3) != 0;
            sum += uint64_t(change);
            far += change > 48;
            blocks[size_t{y / kBlock} * kAcross + x / kBlock] += change / double(kBlock * kBlock);
        }
    const double mean = double(sum) / double(covered);
    p.mean += mean / double(frames);
    p.worst = std::max(p.worst, mean);
    p.block = std::max(p.block, *std::max_element(blocks.begin(), blocks.end()));
    p.share = std::max(p.share, double(far) / double(covered));
}

TEST_F(Houses, AHundredHousesStayWithinTheBudgetWithoutPopping) {
    const float aspect = float(kWidth) / float(kHeight);
    const auto viewAt = [&](float way) {
        return streetView({0, 2.5f, 8 - way}, {2.0f, 1.2f, -4 - way}, aspect);
    };
    const auto warmUp = [&](const Village& village) {
        for (float t = kWarmUp; t > 0; t -= 0.25f) {
            ASSERT_EQ(fwWorld_Step(village.world, 0.25f), FW_OK);
            if (t < 2) draw(village, viewAt(0));
        }
        ASSERT_EQ(fwWorld_Step(village.world, 0),
                  FW_OK);  // brings the readback of the last picture
    };
    const auto lightsOf = [](const Village& village) {
        std::vector<FwLight> lights(64);
        lights.resize(fwWorld_GetLights(village.world, lights.data(), 64));
        return lights;
    };
    uint32_t requested = 0;
    std::vector<FwLight> lights;
    {
        Village free;
        ASSERT_TRUE(free.make(context_, kHouses, 16000000, 4));
        warmUp(free);
        requested = free.stats().refinedTriangles;
        lights = lightsOf(free);
    }
    Village village;
    ASSERT_TRUE(village.make(context_, kHouses, kBudget, 4));
    warmUp(village);
    // More clusters than compete to be lights: which do must not depend on thread order.
    const std::vector<FwLight> same = lightsOf(village);
    ASSERT_EQ(same.size(), lights.size());
    ASSERT_FALSE(same.empty());
    for (size_t i = 0; i < same.size(); ++i) {
        EXPECT_EQ(same[i].id, lights[i].id) << i;
        EXPECT_EQ(same[i].power, lights[i].power) << i;
    }
    Popping p;
    double refining = 0, drawing = 0;  // s of CPU for the same pictures
    uint32_t most = 0, least = ~0u, moves = 0, last = 0, burning = ~0u;
    for (uint32_t f = 0; f < kFrames; ++f) {
        const FwView view = viewAt(kSpeed * kFrameTime * float(f));
        const Picture before = draw(village, view);  // no time has passed
        ASSERT_EQ(fwWorld_Step(village.world, kFrameTime), FW_OK);
        const double start = cpuSeconds();
        const Picture after = draw(village, view);
        refining += cpuSeconds() - start;
        addChange(before, after, p);
        const double from = cpuSeconds();
        draw(village, view);  // refines nothing
        drawing += cpuSeconds() - from;
        if (const char* folder = std::getenv("FLAMEWRIGHT_MOTION"))
            writePng(std::string(folder) + "/houses" + std::to_string(f) + ".png", after);
        ASSERT_EQ(fwWorld_Step(village.world, 0), FW_OK);
        const FwWorldStats stats = village.stats();
        most = std::max(most, stats.refinedTriangles);
        least = std::min(least, stats.refinedTriangles);
        burning = std::min(burning, stats.burningObjects);
        moves += f > 0 && stats.refinedTriangles != last ? 1 : 0;
        last = stats.refinedTriangles;
    }
    std::printf(
        "\n%u houses: %u to %u triangles (budget %u, requested %u), moved in %u of %u frames; a "
        "frame changes the picture by %.2f, at most %.2f, a block by %.1f; %.2f %% beyond 48\n",
        burning, least, most, kBudget, requested, moves, kFrames, p.mean, p.worst, p.block,
        100 * p.share);
    std::printf("a picture costs %.2f of one for which nothing is refined\n", refining / drawing);
    EXPECT_EQ(burning, kHouses);
    EXPECT_LE(most, kBudget);
    EXPECT_GT(least, kBudget / 4);
    EXPECT_GT(requested, kBudget * 3 / 2);
    EXPECT_GE(moves, kFrames / 3);  // objects are refined in at least every third frame
    // 2.2 and 6.0 as measured. Per-pixel rims vary more than cut ones; the frames that change most
    // are those in which a light leaves one house for another.
    EXPECT_LT(p.mean, 2.4);
    EXPECT_LT(p.worst, 6.5);
    EXPECT_LT(p.block, rounds(45.0, 90.0));
    EXPECT_LT(p.share, rounds(0.02, 0.07));
    // Measured: 1.70 if all are refined whenever one is due, 1.44 round-robin. Soot is written in
    // the same step. Instrumented, the host's share differs.
    EXPECT_LT(refining / drawing, rounds(1.55, 3.0));
}

// FNV-1a over its state.
uint64_t stateOf(FwWorld* world, FwBurnableMeshId house) {
    uint64_t count = 0, hash = 0, tick = 0;
    EXPECT_EQ(fwDebug_RequestBurnMap(world, house), FW_OK);
    FwResult result = FW_NOT_READY;
    for (int i = 0; i < 8 && result == FW_NOT_READY; ++i) {
        fwWorld_Step(world, 0);
        result = fwDebug_FetchBurnMap(world, house, nullptr, 0, &count, &hash, &tick);
    }
    EXPECT_EQ(result, FW_OK);
    return hash;
}

// True if the last picture continued predictions.
bool predicts(FwWorld* world) {
    FwPassTime times[64];
    const uint32_t count = std::min(fwDebug_GetPassTimes(world, times, 64), 64u);
    return std::any_of(times, times + count,
                       [](const FwPassTime& t) { return std::strcmp(t.name, "predict") == 0; });
}

// Mean over all channels, 1/255.
double meanOff(const Picture& a, const Picture& b) {
    double sum = 0;
    for (size_t i = 0; i < a.rgb.size(); ++i) sum += std::abs(int(a.rgb[i]) - int(b.rgb[i]));
    return sum / double(a.rgb.size());
}

// Share of the worst block of kBlock^2 px in which only one of the pictures shows the background.
double holesOff(const Picture& a, const Picture& b) {
    constexpr uint32_t kAcross = kWidth / kBlock + 1;
    std::vector<uint32_t> blocks(size_t{kAcross} * (kHeight / kBlock + 1));
    const auto open = [](const Picture& p, size_t at) {
        return std::memcmp(&p.rgb[at], p.rgb.data(), 3) == 0;
    };
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            const size_t at = (size_t{y} * kWidth + x) * 3;
            blocks[size_t{y / kBlock} * kAcross + x / kBlock] += open(a, at) != open(b, at);
        }
    return *std::max_element(blocks.begin(), blocks.end()) / double(kBlock * kBlock);
}

// Houses that burnt before any picture, at the lowest level of an unreachable budget: they burn as
// at full detail, the visible holes are the same, and no frame jumps although predictions are
// queued, not even the second. The camera stands still, so every change is the fire's.
TEST_F(Houses, AtTheLowestLevelHousesBurnOnWithoutPopping) {
    constexpr uint32_t kFew = rounds(30, 10), kSettle = 32, kShown = rounds(10, 5);
    const FwView view = streetView({0, 2.5f, 5}, {1.0f, 1.2f, -7}, float(kWidth) / float(kHeight));
    Village villages[2];
    std::vector<Picture> shown[2];
    Popping first[2], popping[2];
    uint32_t predicted[2] = {};  // pictures that continued predictions
    uint32_t level[2] = {};
    for (const int held : {0, 1}) {
        Village& village = villages[held];
        const uint32_t budgeted = held ? kBudget * kFew / kHouses : kBudget;
        ASSERT_TRUE(village.make(context_, kFew, budgeted, 4));
        for (float t = 0; t < 4; t += 0.25f) ASSERT_EQ(fwWorld_Step(village.world, 0.25f), FW_OK);
        FwBudgetDef budget = fwDefaultBudgetDef();
        budget.gpuMilliseconds = held ? 0.001f : 0.0f;
        ASSERT_EQ(fwWorld_SetBudget(village.world, &budget), FW_OK);
        for (uint32_t f = 0; f < kSettle; ++f)
            ASSERT_EQ(fwWorld_Step(village.world, kFrameTime), FW_OK);
        for (uint32_t f = 0; f < kShown; ++f) {
            ASSERT_EQ(fwWorld_Step(village.world, kFrameTime), FW_OK);
            shown[held].push_back(draw(village, view));
            predicted[held] += predicts(village.world) ? 1 : 0;
            const Picture& now = shown[held].back();
            if (f == 1) addChange(shown[held][0], now, first[held], 1);
            if (f > 1) addChange(shown[held][f - 1], now, popping[held], kShown - 2);
            if (const char* folder = std::getenv("FLAMEWRIGHT_MOTION"))
                writePng(
                    std::string(folder) + (held ? "/held" : "/free") + std::to_string(f) + ".png",
                    now);
        }
        FwBudgetState state{};
        state.structSize = sizeof state;
        ASSERT_EQ(fwWorld_GetBudgetState(village.world, &state), FW_OK);
        level[held] = state.level;
    }
    double off = 0, holes = 0, light[2] = {};
    const Picture black{kWidth, kHeight, std::vector<uint8_t>(size_t{kWidth} * kHeight * 3)};
    for (uint32_t f = 0; f < kShown; ++f) {
        off += meanOff(shown[0][f], shown[1][f]) / kShown;
        holes = std::max(holes, holesOff(shown[0][f], shown[1][f]));
        for (const int held : {0, 1}) light[held] += meanOff(shown[held][f], black) / kShown;
    }
    std::printf(
        "\nlevel %u: a frame changes the picture by %.2f (all detail %.2f), at most %.2f (%.2f), a "
        "block by %.1f (%.1f); the first by %.2f (%.2f), a block by %.1f (%.1f); holes off by %.2f "
        "of a block, all by %.2f of %.1f, light %.3f; predicted %u times (%u)\n",
        level[1], popping[1].mean, popping[0].mean, popping[1].worst, popping[0].worst,
        popping[1].block, popping[0].block, first[1].mean, first[0].mean, first[1].block,
        first[0].block, holes, off, light[0], light[1] / light[0], predicted[1], predicted[0]);
    EXPECT_EQ(level[0], 0u);
    EXPECT_EQ(level[1], 7u);
    EXPECT_EQ(villages[1].stats().burningObjects, kFew);
    for (uint32_t i = 0; i < kFew; ++i)
        EXPECT_EQ(stateOf(villages[0].world, villages[0].houses[i]),
                  stateOf(villages[1].world, villages[1].houses[i]));
    EXPECT_LT(popping[1].mean, 1.3 * popping[0].mean + 0.1);
    EXPECT_LT(popping[1].worst, 1.5 * popping[0].worst + 0.5);
    EXPECT_LT(popping[1].block, 1.5 * popping[0].block + 5);
    for (const int held : {0, 1}) {
        EXPECT_LT(first[held].mean, 1.5 * popping[held].worst + 0.5);
        EXPECT_LT(first[held].block, 1.5 * popping[held].block + 10);
    }
    EXPECT_LT(holes, 0.6);
    EXPECT_LT(off, 0.1 * light[0]);
    EXPECT_NEAR(light[1] / light[0], 1, 0.05);
    EXPECT_EQ(predicted[0], kShown);
    EXPECT_LT(predicted[1], kShown / 2);
}

}  // namespace
}  // namespace fw::test::houses_test
