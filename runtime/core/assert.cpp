#include "core/assert.h"

#include <cstdarg>
#include <cstdio>
#include <cstdlib>

namespace fw::core {

void assertionFailed(const char* expression, const char* file, int line, const char* format,
                     ...) noexcept {
    char values[256] = {};
    if (format) {
        va_list arguments;
        va_start(arguments, format);
        std::vsnprintf(values, sizeof values, format, arguments);
        va_end(arguments);
    }
    std::fprintf(stderr, "Flamewright: assertion failed: %s%s%s\n - At %s:%d.\n", expression,
                 format ? ": " : "", values, file, line);
    std::fflush(stderr);
    std::abort();
}

}  // namespace fw::core
