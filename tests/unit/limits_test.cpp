// plugin/docs/limits.md states the limits of runtime/host_limits.h. With FLAMEWRIGHT_BLESS the page
// is written instead of compared.
#include "host_limits.h"

#include "fire/wind_filter.h"
#include "flamewright/flamewright_vulkan.h"
#include "support/paths.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

namespace {

namespace limits = fw::limits;
using namespace fw;

static_assert(limits::kWind == uint32_t(fire::kMaxWind) && limits::kPreparedViews == FW_MAX_VIEWS);

std::string page() {
    std::string text =
        "# Limits\n\nEvery limit that a host can meet. Calls beyond a limit fail with the limit in "
        "their message.\nRanges of single fields stand beside the fields in `flamewright.h`. This "
        "page is generated from `runtime/host_limits.inl`\n(`FLAMEWRIGHT_BLESS=1` writes it; a "
        "test "
        "compares it).\n";
    std::string group;
    for (const limits::Row& row : limits::kRows) {
        if (group != row.group) {
            group = row.group;
            text += "\n## " + group + "\n\n| at most | unit | |\n|---:|---|---|\n";
        }
        text += "| " + std::to_string(row.value) + " | " + row.unit + " | " + row.meaning + " |\n";
    }
    return text;
}

TEST(Limits, DocumentationStatesTheLimitsOfTheLibrary) {
    const std::string path = std::string(fw::test::kTestFolder) + "/../plugin/docs/limits.md";
    if (std::getenv("FLAMEWRIGHT_BLESS")) {
        std::ofstream(path) << page();
        GTEST_SKIP() << "wrote " << path;
    }
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    EXPECT_EQ(text.str(), page()) << "FLAMEWRIGHT_BLESS=1 writes plugin/docs/limits.md again";
}

}  // namespace
