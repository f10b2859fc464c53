// Entry point of every GoogleTest suite. Writes one line per test to the file named by
// FLAMEWRIGHT_TEST_RESULTS, at once, so that tests/run can count even when a test crashes.
#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "sanitized.h"

namespace {

// "begin NAME", then "passed NAME", "failed NAME" or "skipped NAME: reason".
class ResultFile : public ::testing::EmptyTestEventListener {
 public:
    explicit ResultFile(std::FILE* file) : file_(file) {}
    ~ResultFile() override { std::fclose(file_); }
    ResultFile(const ResultFile&) = delete;
    ResultFile& operator=(const ResultFile&) = delete;

    void OnTestStart(const ::testing::TestInfo& info) override {
        write("begin", info, "");
        reason_.clear();
    }

    void OnTestPartResult(const ::testing::TestPartResult& part) override {
        if (part.skipped() && part.message() != nullptr) reason_ = part.message();
    }

    void OnTestEnd(const ::testing::TestInfo& info) override {
        const ::testing::TestResult& result = *info.result();
        if (result.Failed()) {
            write("failed", info, "");
        } else if (result.Skipped()) {
            for (char& c : reason_) {
                if (c == '\n') c = ' ';
            }
            write("skipped", info, ": " + reason_);
        } else {
            write("passed", info, "");
        }
    }

 private:
    void write(const char* verdict, const ::testing::TestInfo& info, const std::string& rest) {
        std::fprintf(file_, "%s %s.%s%s\n", verdict, info.test_suite_name(), info.name(),
                     rest.c_str());
        std::fflush(file_);
    }

    std::FILE* file_;
    std::string reason_;
};

}  // namespace

int main(int argc, char** argv) {
    // The loader unloads driver and layers with the last instance. What they keep until exit would
    // then look like leaks without a name, so they stay; where they are not installed, nothing is.
    if constexpr (fw::test::kSanitized) {
        for (const char* name : {"libVkLayer_khronos_validation.so", "libvulkan_lvp.so"})
            (void)dlopen(name, RTLD_LAZY | RTLD_NODELETE);
    }
    ::testing::InitGoogleMock(&argc, argv);
    if (const char* path = std::getenv("FLAMEWRIGHT_TEST_RESULTS")) {
        std::FILE* file = std::fopen(path, "a");
        if (file == nullptr) {
            std::fprintf(stderr, "FLAMEWRIGHT_TEST_RESULTS: cannot write %s\n", path);
            return 2;
        }
        ::testing::UnitTest::GetInstance()->listeners().Append(new ResultFile(file));
    }
    return RUN_ALL_TESTS();
}
