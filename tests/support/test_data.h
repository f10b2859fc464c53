// Folders of the tests: where they read their files and where failures leave theirs. Elsewhere than
// where they were compiled, FLAMEWRIGHT_TEST_DATA and FLAMEWRIGHT_TEST_OUT name them.
#pragma once
#include <cstdlib>
#include <filesystem>
#include <string>

#include "support/paths.h"

namespace fw::test {

// `name`: as below tests/.
inline std::string testFile(const std::string& name) {
    const char* folder = std::getenv("FLAMEWRIGHT_TEST_DATA");
    return std::string(folder ? folder : kTestFolder) + "/" + name;
}

// Default: that of the test program, in the build folder.
inline std::filesystem::path testOutput() {
    if (const char* folder = std::getenv("FLAMEWRIGHT_TEST_OUT")) return folder;
    std::error_code none;
    return std::filesystem::read_symlink("/proc/self/exe", none).parent_path();
}

}  // namespace fw::test
