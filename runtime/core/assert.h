// FW_ASSERT(condition) or FW_ASSERT(condition, "%zu of %zu tiles", used, capacity): an invariant of
// the library itself. A failed assertion prints expression, values, file and line, then aborts.
// Never for what a host passes in: bad input is an Error. Off in a release library, where the
// condition is not evaluated; on in Debug and with the CMake option FW_ASSERTIONS.
#pragma once

#if !defined(FW_ASSERTIONS)
#define FW_ASSERTIONS 0
#endif

namespace fw::core {

// `format` may be null: then the expression says it all.
[[noreturn]] void assertionFailed(const char* expression, const char* file, int line,
                                  const char* format = nullptr, ...) noexcept
#if defined(__GNUC__)
    __attribute__((cold, format(printf, 4, 5)))
#endif
    ;

}  // namespace fw::core

#if FW_ASSERTIONS
// clang-format off
#define FW_ASSERT(condition, ...) \
    ((condition) ? static_cast<void>(0) \
                 : ::fw::core::assertionFailed(#condition, __FILE__, __LINE__ __VA_OPT__(,) __VA_ARGS__))
// clang-format on
#else
#define FW_ASSERT(condition, ...) static_cast<void>(sizeof((condition) ? 1 : 0))
#endif
