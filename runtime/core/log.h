// Messages to the host's log callback. Formats nothing without a callback.
#pragma once
#include "flamewright/flamewright.h"

namespace fw::core {

class Log {
 public:
    explicit Log(const FwCallbacks& callbacks) noexcept : callbacks_(callbacks) {}
    void write(FwLogLevel level, const char* format, ...) const noexcept
#if defined(__GNUC__)
        __attribute__((format(printf, 3, 4)))
#endif
        ;

 private:
    FwCallbacks callbacks_;
};

}  // namespace fw::core
