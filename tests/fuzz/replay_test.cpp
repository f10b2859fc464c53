// Every fuzzer without libFuzzer: the product accepts its seeds, refuses bytes without meaning, and
// handles each input that once failed.
#include "fuzz/fuzzer.h"
#include "support/sanitized.h"

#include <gtest/gtest.h>

#include <chrono>

namespace {

class FuzzReplay : public testing::TestWithParam<const fuzz::Fuzzer*> {};

TEST_P(FuzzReplay, AcceptsItsSeeds) {
    const std::vector<fuzz::Bytes> seeds = GetParam()->seeds();
    ASSERT_FALSE(seeds.empty());
    for (size_t i = 0; i < seeds.size(); ++i)
        EXPECT_TRUE(GetParam()->take(seeds[i])) << "seed " << i + 1;
}

TEST_P(FuzzReplay, RefusesBytesWithoutMeaning) {
    EXPECT_FALSE(GetParam()->take({}));
    EXPECT_FALSE(GetParam()->take(fuzz::Bytes(64, 0xA5)));
}

TEST_P(FuzzReplay, HandlesInputsThatOnceFailed) {
    for (const auto& file : fuzz::regressionsOf(*GetParam())) {
        SCOPED_TRACE(file.filename().string());
        const auto start = std::chrono::steady_clock::now();
        (void)GetParam()->take(fuzz::bytesOf(file));
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
        if (!fw::test::kSanitized) {
            EXPECT_LT(time.count(), 5.0);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Fuzzers, FuzzReplay, testing::ValuesIn(fuzz::Fuzzer::all()),
                         [](const auto& fuzzer) { return std::string(fuzzer.param->name); });

}  // namespace
