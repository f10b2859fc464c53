// Golden pictures: RGB8 PNG files beside the tests. A difference beyond the stated tolerance leaves
// actual, expected and difference in the build folder. FLAMEWRIGHT_BLESS=1 writes the expected
// files again.
#pragma once
#include "support/png_file.h"

#include <gtest/gtest.h>

#include <string>

namespace fw::test {

struct PictureTolerance {
    double mean = 1.0;       // mean absolute difference, in 1/255
    double outliers = 0.01;  // share of pixels with a channel off by more than `outlier`
    int outlier = 32;
};

testing::AssertionResult picturesMatch(const Picture& actual, const Picture& expected,
                                       const PictureTolerance& tolerance);
// Compares with tests/golden/<name>.png, or writes it.
testing::AssertionResult matchesGolden(const std::string& name, const Picture& actual,
                                       const PictureTolerance& tolerance);

}  // namespace fw::test
