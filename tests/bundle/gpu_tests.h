// Runs a GoogleTest program in several processes. A test that crashes or hangs costs itself alone.
#pragma once
#include "bundle/child.h"

#include <nlohmann/json.hpp>

namespace fw::bundle {

struct TestRun {
    std::string program, folder;  // folder: for logs, and where it runs
    std::string filter;           // regular expression of names; empty: all
    Child::Environment environment;
    uint32_t processes = 1;
    double testSeconds = 75;  // limit of one test
    Clock::time_point end;    // of all of them
};
// {"passed", "failed", "skipped", "notRun", "seconds", "problems": [{"name", "verdict", "message",
// "alone"}], "skips": [{"message", "count"}]}. Tests that fail run once more, with nothing beside
// them: "alone" is that verdict.
nlohmann::json runTests(const TestRun& run);

}  // namespace fw::bundle
