// The library's own assertions: what a failed one prints, and that a release build skips them.
#include "core/assert.h"

#include <gtest/gtest.h>

namespace {

TEST(Assert, AbortsWithExpressionValuesFileAndLine) {
#if FW_ASSERTIONS
    const unsigned used = 9, capacity = 8;
    EXPECT_DEATH(FW_ASSERT(used <= capacity, "%u of %u tiles", used, capacity),
                 "assertion failed: used <= capacity: 9 of 8 tiles\n.*assert_test.cpp:[0-9]+");
    EXPECT_DEATH(FW_ASSERT(used == capacity), "assertion failed: used == capacity\n");
#else
    GTEST_SKIP() << "this build has no assertions (FW_ASSERTIONS=ON has)";
#endif
}

TEST(Assert, EvaluatesItsConditionOnlyWhereAssertionsAreOn) {
    int evaluated = 0;
    FW_ASSERT(++evaluated > 0, "%d", evaluated);
    EXPECT_EQ(evaluated, FW_ASSERTIONS);
}

}  // namespace
