// A failure with a reason. Thrown inside the library only; the C edge turns it into a result and a
// message (present tense: the name, the value and the limit). std::bad_alloc is the other failure.
#pragma once
#include "flamewright/flamewright.h"

#include <cstdarg>
#include <cstdio>

namespace fw::core {

struct Error {
    FwResult result = FW_ERROR_INVALID_ARGUMENT;
    char message[480] = {};
};

// Throws Error with a printf-style text. Texts are cut at 479 bytes.
[[noreturn]] void fail(FwResult result, const char* format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 2, 3)))
#endif
    ;

}  // namespace fw::core
