#include "core/error.h"

#include <cstdlib>

namespace fw::core {

void writeLengths(const char* text, double unitsPerMetre, char* out, size_t size) noexcept {
    size_t at = 0;
    const auto put = [&](char one) {
        if (at + 1 < size) out[at++] = one;
    };
    const auto write = [&](const char* words) {
        for (; *words; ++words) put(*words);
    };
    while (*text) {
        if (*text == '\001') {
            char* end = nullptr;
            const double metres = std::strtod(text + 1, &end);
            char number[32];
            std::snprintf(number, sizeof number, "%g", metres * unitsPerMetre);
            write(number);
            text = *end == '\002' ? end + 1 : end;  // a cut text may end within a number
        } else if (*text == '\003') {
            write(unitsPerMetre == 1 ? "m" : "units");
            ++text;
        } else {
            put(*text++);
        }
    }
    if (size > 0) out[at] = 0;
}

namespace {

// Ends the arguments.
[[noreturn]] void raise(FwResult result, const char* format, va_list& arguments) {
    Error error;
    error.result = result;
    std::vsnprintf(error.marked, sizeof error.marked, format, arguments);
    va_end(arguments);
    writeLengths(error.marked, 1, error.message, sizeof error.message);
    throw error;
}

}  // namespace

void fail(FwResult result, const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    raise(result, format, arguments);
}

void refuse(const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    raise(FW_ERROR_INVALID_ARGUMENT, format, arguments);
}

void failData(const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    raise(FW_ERROR_BAD_DATA, format, arguments);
}

}  // namespace fw::core
