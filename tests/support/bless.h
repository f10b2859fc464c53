// True if tests write their expected results instead of comparing: tests/run --bless.
#pragma once
#include <cstdlib>
#include <cstring>

namespace fw::test {

inline bool blessing() {
    const char* value = std::getenv("FLAMEWRIGHT_BLESS");
    return value && std::strcmp(value, "1") == 0;
}

}  // namespace fw::test
