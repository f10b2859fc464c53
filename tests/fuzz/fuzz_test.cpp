// Random hosts from fixed seeds.
#include "fuzz/random_host.h"

#include <cstdio>

namespace {

class HostFuzz : public ::testing::TestWithParam<int> {};

TEST_P(HostFuzz, SurvivesRandomHosts) {
    host::RandomHost fuzz{host::Random(uint64_t(GetParam()))};
    fuzz.run(12000);
    EXPECT_LT(400u, fuzz.accepted);
    EXPECT_LT(400u, fuzz.refused);
    // The session must have reached every feature.
    EXPECT_LT(10u, fuzz.meshes);
    EXPECT_LT(20u, fuzz.objects);
    EXPECT_LT(20u, fuzz.flames);
    EXPECT_LT(3u, fuzz.fires);
    EXPECT_LT(0u, fuzz.sought);
    std::printf(
        "           %llu accepted, %llu refused, %llu meshes, %llu objects, %llu fires\n",
        static_cast<unsigned long long>(fuzz.accepted),
        static_cast<unsigned long long>(fuzz.refused), static_cast<unsigned long long>(fuzz.meshes),
        static_cast<unsigned long long>(fuzz.objects), static_cast<unsigned long long>(fuzz.fires));
}
INSTANTIATE_TEST_SUITE_P(Seeds, HostFuzz, ::testing::Range(1, 9));

}  // namespace
