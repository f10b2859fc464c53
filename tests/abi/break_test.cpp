// FW_EVENT_STRUCTURE_BROKE: a board that burns through in the middle loses the part above, a sheet
// the part below. Each lost area is reported once, on both backends and across saves.
#include "abi/busy_world.h"

namespace fw::test::break_test {
namespace {

using namespace host;

constexpr float kWide = 0.4f, kHigh = 0.8f;
constexpr int kRows = 16;

// A board that stands on its short side, of stone except for two combustible bands at a quarter and
// three quarters of its height.
struct Board : HostedWorld {
    explicit Board(uint32_t backend, uint32_t flags = 0, float share = 0, float area = 0.01f,
                   bool pinned = false,
                   uint32_t cutOut = 0)  // bits: rows that its picture cuts out
        : HostedWorld(backend, pacedDef(10)), sheet(kWide, kHigh, kRows) {
        if (!world) return;
        for (size_t i = 1; i < sheet.uvs.size() && cutOut != 0; i += 2)
            sheet.uvs[i] *= kWide / kHigh;
        FwMeshDef meshDef = sheet.def(64);
        std::vector<uint8_t> of;
        for (int row = 0; row < kRows; ++row)
            of.insert(of.end(), size_t(kRows) * 2, row == 4 || row == 11 ? 0 : 1);
        meshDef.triangleMaterials = of.data();
        FwBurnableMeshDef made = fwDefaultBurnableMeshDef();
        std::vector<uint32_t> pixels;
        for (uint32_t i = 0; i < kRows * kRows; ++i)
            pixels.push_back(cutOut >> i / kRows & 1 ? 0x00FFFFFFu : 0xFFFFFFFFu);
        FwImageDef image = fwDefaultImageDef();
        image.width = image.height = kRows;
        image.pixels = pixels.data();
        image.alphaCutoff = 0.5f;
        if (cutOut != 0) ok(fwWorld_CreateImage(world, &image, &made.baseColor));
        made.flags |= flags;
        made.userData = 77;
        made.breakShare = share;
        made.breakArea = area;
        const float upright[16] = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1};
        std::copy_n(upright, 16, made.transform);
        FwPin pin{};
        pin.to[0] = kWide;
        pin.from[2] = pin.to[2] = kHigh;
        pin.radius = 0.03f;
        if (pinned) {
            made.flags |= FW_BURNABLE_SHELL;
            made.pins = &pin;
            made.pinCount = 1;
        }
        id = addBurnable(world, meshDef, FW_MATERIAL_PAPER, made);
    }
    void light(int row, float x = kWide / 2, float radius = 0.52f * kWide) {
        ignite({}, x, (float(row) + 0.5f) * kHigh / kRows, 0, radius);
    }
    void run(double seconds, float deltaTime = 1.0f / 32) {
        for (double t = 0; t < seconds - 1e-9; t += double(deltaTime)) {
            ok(fwWorld_Step(world, deltaTime));
            ++steps;
            poll();
        }
    }
    void poll() {
        FwEvent some[16];
        const uint32_t count = fwWorld_PollEvents(world, some, 16);
        for (uint32_t i = 0; i < count; ++i) {
            if (some[i].type == FW_EVENT_STRUCTURE_BROKE) broke.push_back(some[i]);
            heard.push_back({steps, some[i].type, some[i].tag, some[i].object.index1, some[i].value,
                             some[i].position[1]});
        }
    }

    Sheet sheet;
    FwBurnableMeshId id{};
    std::vector<FwEvent> broke;
    struct Heard {
        uint32_t step, type, tag, object;
        float value, height;
        bool operator==(const Heard&) const = default;
    };
    std::vector<Heard> heard;  // of all types
    uint32_t steps = 0;
};

constexpr float kRowArea = kWide * kHigh / kRows;
constexpr double kBurns = 20;  // s: one band burns through, with a margin

TEST(Breakage, ReportsTheUnsupportedPartOnce) {
    for (const uint32_t flags : {0u, uint32_t(FW_BURNABLE_LITE)}) {
        Board board(FW_BACKEND_CPU, flags);
        board.light(11, kWide / 2, 0.02f);
        board.run(kBurns);
        ASSERT_EQ(1u, board.broke.size());
        const FwEvent& top = board.broke[0];
        EXPECT_EQ(uint32_t(FW_BREAK_PART), top.tag);
        EXPECT_EQ(77u, top.userData);
        EXPECT_EQ(board.id.index1, top.object.index1);
        EXPECT_NEAR(4 * kRowArea, top.value, 0.3f * kRowArea);
        EXPECT_NEAR(14 * kHigh / kRows, top.position[1], 0.03f);
        EXPECT_NEAR(kWide / 2, top.position[0], 0.02f);
        board.light(4, kWide / 2, 0.02f);  // the part between the bands follows, without the top
        board.run(kBurns);
        ASSERT_EQ(2u, board.broke.size());
        EXPECT_NEAR(6 * kRowArea, board.broke[1].value, 0.5f * kRowArea);
        EXPECT_NEAR(8 * kHigh / kRows, board.broke[1].position[1], 0.03f);
    }
}

TEST(Breakage, SheetsHangFromTheirPins) {
    Board sheet(FW_BACKEND_CPU, 0, 0, 0.01f, true);
    sheet.light(11);
    sheet.run(kBurns);
    ASSERT_EQ(1u, sheet.broke.size());
    EXPECT_NEAR(11 * kRowArea, sheet.broke[0].value, 0.7f * kRowArea);
    EXPECT_NEAR(5.5f * kHigh / kRows, sheet.broke[0].position[1], 0.04f);
}

TEST(Breakage, ReportsOnlyRequestedKinds) {
    Board none(FW_BACKEND_CPU, 0, 0, 0), large(FW_BACKEND_CPU, 0, 0, 5 * kRowArea),
        whole(FW_BACKEND_CPU, FW_BURNABLE_NO_HOLES), share(FW_BACKEND_CPU, 0, 0.09f, 0);
    for (Board* board : {&none, &large, &whole, &share}) {
        board->light(11);
        board->run(kBurns);
    }
    EXPECT_TRUE(none.broke.empty());
    EXPECT_TRUE(large.broke.empty());
    EXPECT_TRUE(whole.broke.empty());
    EXPECT_TRUE(share.broke.empty());  // 6 % is lost
    for (Board* board : {&none, &large, &whole, &share}) {
        board->light(4);
        board->run(kBurns);
    }
    EXPECT_TRUE(none.broke.empty());
    EXPECT_EQ(1u, large.broke.size());
    EXPECT_TRUE(whole.broke.empty());
    ASSERT_EQ(1u, share.broke.size());
    EXPECT_EQ(uint32_t(FW_BREAK_SHARE), share.broke[0].tag);
    EXPECT_GT(share.broke[0].value, 0.09f * kWide * kHigh * 0.98f);
    EXPECT_NEAR(kHigh / 2, share.broke[0].position[1], 1e-5f);
}

// A band that is cut out supports nothing, does not count as area, and splits the board in two.
TEST(Breakage, CutOutsNeitherSupportNorCount) {
    Board part(FW_BACKEND_CPU, 0, 0, 0.01f, false, 3u << 7),
        share(FW_BACKEND_CPU, 0, 0.07f, 0, false, 63u << 5);  // more than a tenth
    for (Board* board : {&part, &share}) {
        board->light(4, kWide / 2, 0.02f);
        board->run(kBurns);
        ASSERT_EQ(1u, board->broke.size());
    }
    EXPECT_NEAR(2 * kRowArea, part.broke[0].value, 0.3f * kRowArea);
    EXPECT_NEAR(6 * kHigh / kRows, part.broke[0].position[1], 0.03f);
    EXPECT_EQ(uint32_t(FW_BREAK_SHARE), share.broke[0].tag);
    EXPECT_LT(share.broke[0].value, kRowArea);
}

// With equal frames; a loaded save continues as the original does.
TEST(Breakage, BothBackendsAgree) {
    Board cpu(FW_BACKEND_CPU, 0, 0.09f), device(FW_BACKEND_VULKAN, 0, 0.09f);
    if (!device.world) GTEST_SKIP() << "there is no such backend here";
    Bytes save;
    for (Board* board : {&cpu, &device}) {
        board->light(11);
        board->run(kBurns);
        board->light(4, 0, 0.02f);
        board->run(0.5);
        if (board == &cpu)
            save = saveOf(cpu.world);
        else
            (void)saveOf(device.world);
        board->run(kBurns);
        for (int i = 0; i < 4; ++i) {  // pending
            board->ok(fwWorld_Step(board->world, 0));
            board->poll();
        }
    }
    ASSERT_EQ(3u, cpu.broke.size());
    ASSERT_EQ(3u, device.broke.size());
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(cpu.broke[i].tag, device.broke[i].tag);
        EXPECT_EQ(cpu.broke[i].value, device.broke[i].value);
        EXPECT_EQ(cpu.broke[i].position[1], device.broke[i].position[1]);
    }
    Board loaded(FW_BACKEND_CPU, 0, 0.09f);
    loaded.ok(fwWorld_Load(loaded.world, save.data(), save.size()));
    loaded.run(kBurns);
    ASSERT_EQ(2u, loaded.broke.size());  // the top is not reported again
    for (size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(cpu.broke[i + 1].tag, loaded.broke[i].tag);
        EXPECT_EQ(cpu.broke[i + 1].value, loaded.broke[i].value);
    }
    // After going back in time, events are reported again.
    cpu.broke.clear();
    cpu.ok(fwWorld_Load(cpu.world, save.data(), save.size()));
    cpu.run(kBurns);
    EXPECT_EQ(2u, cpu.broke.size());
}

// For every frame of the save and every loading world, each event arrives once, at its original
// step. Events that were not polled arrive at once.
TEST(Breakage, PendingEventsKeepTheirStepAcrossSaves) {
    Board straight(FW_BACKEND_CPU, 0, 0.09f);
    const auto begin = [](Board& board) {
        board.light(11, kWide / 2, 0.02f);
        board.light(4, 0, 0.02f);
    };
    begin(straight);
    straight.run(kBurns);
    ASSERT_LE(3u, straight.broke.size());
    ASSERT_LE(5u, straight.heard.size());  // it caught and burnt out
    uint32_t firstBreak = 0;               // step of the first break
    for (const Board::Heard& one : straight.heard)
        if (firstBreak == 0 && one.type == FW_EVENT_STRUCTURE_BROKE) firstBreak = one.step;
    ASSERT_LT(20u, firstBreak);
    // The save is made 15 steps before the break (checked again since), 2 steps before, and in its
    // very frame.
    for (const uint32_t before : {15u, 2u, 0u}) {
        Board saver(FW_BACKEND_CPU, 0, 0.09f), loader(FW_BACKEND_CPU, 0, 0.09f);
        begin(saver);
        saver.run((firstBreak - before - 1) / 32.0);
        saver.ok(fwWorld_RequestSave(saver.world));
        saver.ok(fwWorld_Step(saver.world, 1.0f / 32));
        ++saver.steps;
        const std::vector<Board::Heard> past = saver.heard;
        uint64_t size = 0;
        saver.ok(fwWorld_FetchSave(saver.world, nullptr, &size));
        Bytes save(size);
        saver.ok(fwWorld_FetchSave(saver.world, save.data(), &size));
        for (const bool polled : {false, true}) {  // a loaded save stays loadable
            loader.ok(fwWorld_Load(loader.world, save.data(), save.size()));
            if (!polled) {
                EXPECT_EQ(save, saveOf(loader.world));
            }
            loader.heard = past;
            loader.steps = saver.steps;
            loader.poll();
            EXPECT_EQ(before == 0, loader.heard.size() > past.size()) << before;
            loader.run(kBurns - loader.steps / 32.0);
            EXPECT_EQ(straight.heard, loader.heard) << before;
        }
        saver.poll();
        saver.run(kBurns - saver.steps / 32.0);
        EXPECT_EQ(straight.heard, saver.heard) << "the save changed it, " << before;
    }
}

// A loading host that requests another kind gets no events of areas lost before.
TEST(Breakage, DoesNotReportOldLossesOfNewlyRequestedKinds) {
    Board asks(FW_BACKEND_CPU, 0, 0.09f), none(FW_BACKEND_CPU, 0, 0, 0),
        other(FW_BACKEND_CPU, 0, 0.02f);
    asks.light(11);
    asks.run(kBurns);
    ASSERT_EQ(1u, asks.broke.size());
    const Bytes save = saveOf(asks.world);
    for (Board* board : {&none, &other}) {
        board->ok(fwWorld_Load(board->world, save.data(), save.size()));
        board->light(4);
        board->run(kBurns);
    }
    EXPECT_TRUE(none.broke.empty());
    ASSERT_EQ(1u, other.broke.size());  // neither the top nor its 6 %
    EXPECT_EQ(uint32_t(FW_BREAK_PART), other.broke[0].tag);
}

TEST(Breakage, RefusesBadValuesByName) {
    SheetWorld w(evenMaterial(0.02f, 5));
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    EXPECT_EQ(0, def.breakShare);
    EXPECT_EQ(0, def.breakArea);
    def.mesh = w.mesh;
    FwBurnableMeshId id{};
    def.breakShare = 1.5f;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateBurnableMesh(w.world, &def, &id));
    EXPECT_NE(std::string::npos,
              lastMessage(w.world).find("FwBurnableMeshDef::breakShare is 1.5; the limits are"));
    def.breakShare = 0;
    def.breakArea = -1;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateBurnableMesh(w.world, &def, &id));
    EXPECT_NE(std::string::npos, lastMessage(w.world).find("FwBurnableMeshDef::breakArea is -1"));
}

}  // namespace
}  // namespace fw::test::break_test
