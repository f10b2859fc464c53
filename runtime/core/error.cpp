#include "core/error.h"

namespace fw::core {

void fail(FwResult result, const char* format, ...) {
    Error error;
    error.result = result;
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(error.message, sizeof error.message, format, arguments);
    va_end(arguments);
    throw error;
}

}  // namespace fw::core
