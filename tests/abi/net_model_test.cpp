// A session survives a network of any delay, loss and rate. The corners of
// the grid are tests of every change; the whole grid is a row of tests/run --long.
#include "abi/net_model.h"

namespace {

using namespace host;

class NetModelCorner : public testing::TestWithParam<NetModelCell> {};

TEST_P(NetModelCorner, EveryClientCatchesUp) {
    NetModel model(GetParam());
    model.play();
    model.expectEqual();
}
INSTANTIATE_TEST_SUITE_P(TwoMinutes, NetModelCorner,
                         testing::Values(NetModelCell{0, 0, 5e3}, NetModelCell{0, 0, 1e6},
                                         NetModelCell{0, 0.6, 5e3}, NetModelCell{0, 0.6, 1e6},
                                         NetModelCell{2, 0, 5e3}, NetModelCell{2, 0, 1e6},
                                         NetModelCell{2, 0.6, 5e3}, NetModelCell{2, 0.6, 1e6}),
                         [](const auto& given) {
                             const NetModelCell& cell = given.param;
                             return "Delay" + std::to_string(int(cell.delay)) + "Loss" +
                                    std::to_string(int(100 * cell.loss)) + "Rate" +
                                    std::to_string(int(cell.rate));
                         });

// One cell of the grid, in FLAMEWRIGHT_NET_CELL: "delay loss rate seconds".
TEST(NetModel, DISABLED_OneCell) {
    const char* given = std::getenv("FLAMEWRIGHT_NET_CELL");
    NetModelCell cell;
    ASSERT_TRUE(given && std::sscanf(given, "%lf %lf %lf %lf", &cell.delay, &cell.loss, &cell.rate,
                                     &cell.seconds) == 4)
        << "FLAMEWRIGHT_NET_CELL is no cell.";
    NetModel model(cell);
    model.play();
    model.expectEqual();
    std::printf("cell: %.1f s | %u | %d | %.1f s | %lld kB\n", model.settled, model.resyncs(),
                int(model.overloaded), model.mostBehind,
                static_cast<long long>(model.memoryMost / 1024));
}

}  // namespace
