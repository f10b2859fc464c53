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

#if defined(__GNUC__)
#define FW_FORMAT(text, values) __attribute__((format(printf, text, values)))
#else
#define FW_FORMAT(text, values)
#endif
// Throws Error with a printf-style text, cut at 479 bytes.
[[noreturn]] void fail(FwResult result, const char* format, ...) FW_FORMAT(2, 3);
[[noreturn]] void refuse(const char* format, ...) FW_FORMAT(1, 2);    // FW_ERROR_INVALID_ARGUMENT
[[noreturn]] void failData(const char* format, ...) FW_FORMAT(1, 2);  // FW_ERROR_BAD_DATA

}  // namespace fw::core
