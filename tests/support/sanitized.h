// Number of rounds of long tests in sanitized builds: the same code with fewer rounds, because the
// release build runs all of them. Checks never change.
#pragma once

namespace fw::test {

// Set by tests/CMakeLists.txt: compiler macros describe the test's build, not the library's.
#ifdef FW_SANITIZED
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

// Rounds of a test that has `all` of them.
template <class T>
constexpr T rounds(T all, T sanitized) {
    return kSanitized ? sanitized : all;
}

}  // namespace fw::test
