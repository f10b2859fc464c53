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

Error errorOf(FwResult result, const char* format, va_list arguments) noexcept {
    Error error;
    error.result = result;
    std::vsnprintf(error.marked, sizeof error.marked, format, arguments);
    writeLengths(error.marked, 1, error.message, sizeof error.message);
    return error;
}

}  // namespace

void fail(FwResult result, const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const Error error = errorOf(result, format, arguments);
    va_end(arguments);
    throw error;
}

void refuse(const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const Error error = errorOf(FW_ERROR_INVALID_ARGUMENT, format, arguments);
    va_end(arguments);
    throw error;
}

void failData(const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const Error error = errorOf(FW_ERROR_BAD_DATA, format, arguments);
    va_end(arguments);
    throw error;
}

}  // namespace fw::core
