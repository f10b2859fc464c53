// How much of a long test a sanitized build runs: the same code and fewer rounds, since the release
// build runs all of it. Not for checks; those are the same everywhere.
#pragma once

namespace fw::test {

// By tests/CMakeLists.txt: the compiler's own macros say how the test is compiled, not the library.
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
