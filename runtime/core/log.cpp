#include "core/log.h"

#include <cstdarg>
#include <cstdio>

namespace fw::core {

void Log::write(FwLogLevel level, const char* format, ...) const noexcept {
    if (!callbacks_.log) return;
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    callbacks_.log(callbacks_.userData, level, text);
}

}  // namespace fw::core
