#include "golden/golden_image.h"

#include "support/bless.h"
#include "support/test_data.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace fw::test {

namespace fs = std::filesystem;

testing::AssertionResult picturesMatch(const Picture& actual, const Picture& expected,
                                       const PictureTolerance& tolerance) {
    if (actual.width != expected.width || actual.height != expected.height)
        return testing::AssertionFailure()
               << "the picture is " << actual.width << " x " << actual.height << ", expected "
               << expected.width << " x " << expected.height;
    uint64_t sum = 0, far = 0;
    for (size_t i = 0; i < actual.rgb.size(); i += 3) {
        int most = 0;
        for (size_t k = 0; k < 3; ++k) {
            const int d = std::abs(int(actual.rgb[i + k]) - int(expected.rgb[i + k]));
            sum += uint64_t(d);
            most = std::max(most, d);
        }
        far += most > tolerance.outlier;
    }
    const double mean = double(sum) / double(actual.rgb.size());
    const double share = double(far) * 3 / double(actual.rgb.size());
    const bool fine = mean <= tolerance.mean && share <= tolerance.outliers;
    return (fine ? testing::AssertionSuccess() : testing::AssertionFailure())
           << "mean difference " << mean << " (limit " << tolerance.mean << "), " << 100 * share
           << " % of the pixels are off by more than " << tolerance.outlier << " (limit "
           << 100 * tolerance.outliers << " %)";
}

testing::AssertionResult matchesGolden(const std::string& name, const Picture& actual,
                                       const PictureTolerance& tolerance) {
    const std::string path = testFile("golden/" + name + ".png");
    if (blessing()) {
        if (!writePng(path, actual)) return testing::AssertionFailure() << path << " not written";
        return testing::AssertionSuccess() << path << " written";
    }
    const fs::path folder = testOutput() / "golden";
    std::error_code none;
    fs::create_directories(folder, none);
    writePng((folder / (name + "_actual.png")).string(), actual);
    Picture expected;
    if (!readPng(path, expected))
        return testing::AssertionFailure() << path << " cannot be read; --bless writes it";
    const testing::AssertionResult result = picturesMatch(actual, expected, tolerance);
    if (result) return result;
    Picture difference = actual;
    if (expected.rgb.size() == actual.rgb.size()) {
        for (size_t i = 0; i < actual.rgb.size(); ++i)
            difference.rgb[i] =
                uint8_t(std::min(255, 4 * std::abs(int(actual.rgb[i]) - int(expected.rgb[i]))));
    }
    writePng((folder / (name + "_expected.png")).string(), expected);
    writePng((folder / (name + "_difference.png")).string(), difference);
    return testing::AssertionFailure()
           << name << ": " << result.message() << "; see " << folder.string();
}

}  // namespace fw::test
