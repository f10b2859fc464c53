// A failure with a reason. Thrown inside the library only; the C edge turns it into a result and a
// message (present tense: the name, the value and the limit). std::bad_alloc is the other failure.
#pragma once
#include "flamewright/flamewright.h"

#include <cstdarg>
#include <cstddef>
#include <cstdio>

namespace fw::core {

struct Error {
    FwResult result = FW_ERROR_INVALID_ARGUMENT;
    char message[480] = {};
    char marked[480] = {};  // the message with its lengths marked, for writeLengths
};

// In formats of failures: a length (a double, m) and the name of its unit. `message` has lengths in
// metres; the edge writes `marked` in the unit of the host's world.
#define FW_LENGTH "\001%.9g\002"
#define FW_LENGTH_UNIT "\003"
// Writes `text` with lengths times unitsPerMetre and the unit's name; cuts it at `size` - 1 bytes.
void writeLengths(const char* text, double unitsPerMetre, char* out, size_t size) noexcept;

// Throws Error with a printf-style text, cut at 479 bytes.
[[noreturn]] void fail(FwResult result, const char* format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 2, 3)))
#endif
    ;

}  // namespace fw::core
