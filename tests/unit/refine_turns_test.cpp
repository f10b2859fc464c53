// An object is refined again when the front has moved half a pixel or the camera a fiftieth of its
// distance, and after a fifteenth of a second.
#include "mesh/refine/turns.h"

#include <gtest/gtest.h>

namespace fw::test {
namespace {

constexpr double kSecond = gpu::kTicksPerSecond;

// A fire of 0.1 m/s at distance `away`, in a picture of 1000 px per m at 1 m.
mesh::RefineTurn turnOf(float away) {
    mesh::RefineTurn turn;
    turn.away = away;
    turn.pixels = 1000;
    turn.speed = 0.1 / kSecond;
    return turn;
}

// s until it is due; negative: not within ten.
double secondsOf(mesh::RefineTurn turn) {
    for (double s = 0; s < 10; s += 1.0 / 4096)
        if (turn.since = s * kSecond; mesh::refineDue(turn)) return s;
    return -1;
}

TEST(RefineTurns, IsDueWhenTheFrontMovesHalfAPixel) {
    EXPECT_NEAR(secondsOf(turnOf(2)), 0.010, 5e-4);  // 50 px/s
    EXPECT_NEAR(secondsOf(turnOf(8)), 0.040, 5e-4);
    mesh::RefineTurn fast = turnOf(8);
    fast.speed *= 4;
    EXPECT_NEAR(secondsOf(fast), 0.010, 5e-4);
    mesh::RefineTurn parallel = turnOf(8);
    parallel.perspective = false;
    parallel.pixels = 500;
    EXPECT_NEAR(secondsOf(parallel), 0.010, 5e-4)
        << "distance does not matter in parallel projection";
    EXPECT_LT(secondsOf(turnOf(0)), 1e-3) << "camera inside the object";
}

TEST(RefineTurns, IsDueAfterAFifteenthOfASecond) {
    EXPECT_NEAR(secondsOf(turnOf(100)), 1 / 15.0, 5e-4);
    mesh::RefineTurn out = turnOf(2);
    out.speed = 0;
    EXPECT_NEAR(secondsOf(out), 1 / 15.0, 5e-4);
}

TEST(RefineTurns, IsDueWhenTheCameraMovesAFiftiethOfItsDistance) {
    mesh::RefineTurn turn = turnOf(10);
    turn.speed = 0;
    turn.moved = 0.19f;
    EXPECT_FALSE(mesh::refineDue(turn));
    turn.moved = 0.21f;
    EXPECT_TRUE(mesh::refineDue(turn));
    turn.away = 20;
    EXPECT_FALSE(mesh::refineDue(turn));
    turn.away = 0;
    turn.perspective = false;
    EXPECT_FALSE(mesh::refineDue(turn)) << "no level depends on the camera's place";
}

}  // namespace
}  // namespace fw::test
