// Entry point of every GoogleTest suite. Writes a line per test immediately to the file
// FLAMEWRIGHT_TEST_RESULTS, so that tests/run counts correctly even after a crash.
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
    // The loader unloads driver and layers with the last instance, and their remaining memory would
    // look like unnamed leaks. So they stay loaded if they are installed.
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
