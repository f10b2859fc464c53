// The edge: nothing thrown leaves the library. Every entry point runs its body inside `guard`,
// which turns a failure into a result and one text, the same for the log and for GetLastMessage.
#pragma once
#include "core/error.h"
#include "core/log.h"
#include "core/memory.h"
#include "units.h"

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <new>
#include <span>
#include <stdexcept>

namespace fw::edge {

// Last failure of a context or a world. Any thread may read while another one fails.
class LastMessage {
 public:
    void set(const char* text) noexcept {
        const std::lock_guard lock(mutex_);
        std::snprintf(text_, sizeof text_, "%s", text);
    }
    // Writes at most `capacity` bytes with the zero; returns the length needed without it.
    size_t copy(char* out, size_t capacity) noexcept {
        const std::lock_guard lock(mutex_);
        const size_t length = std::strlen(text_);
        if (out && capacity > 0) {
            const size_t part = length < capacity ? length : capacity - 1;
            std::memcpy(out, text_, part);
            out[part] = 0;
        }
        return length;
    }

 private:
    std::mutex mutex_;
    char text_[sizeof FwErrorInfo::message] = {};
};

// "Message\n - While calling fwX." in `out`, cut so that the last line always fits; its lengths in
// the host's unit.
inline void composeMessage(char (&out)[sizeof FwErrorInfo::message], const char* marked,
                           const char* function, const Unit& unit) noexcept {
    char message[sizeof out];
    core::writeLengths(marked, unit.perMetre(), message, sizeof message);
    char tail[96];
    const int tailLength = std::snprintf(tail, sizeof tail, "\n - While calling %s.", function);
    const int room = int(sizeof out) - 1 - tailLength;
    std::snprintf(out, sizeof out, "%.*s%s", room, message, tail);
}

inline constexpr char kNoMemoryText[] =
    "Memory is exhausted: the allocator refused a request. Nothing was changed.";

// Runs `body` (which returns FwResult or nothing) and hands any failure to report(result, text),
// whose lengths are in the unit that `unit` then is.
template <class Body, class Report>
FwResult guard(const char* function, const Report& report, Body&& body,
               const Unit& unit = {}) noexcept {
    FwResult result = FW_ERROR_INTERNAL;
    char text[sizeof FwErrorInfo::message];
    try {
        if constexpr (std::is_void_v<std::invoke_result_t<Body>>) {
            body();
            return FW_OK;
        } else {
            return body();
        }
    } catch (const core::Error& error) {
        result = error.result;
        composeMessage(text, error.marked, function, unit);
    } catch (const std::bad_alloc&) {
        result = FW_ERROR_OUT_OF_MEMORY;
        composeMessage(text, kNoMemoryText, function, unit);
    } catch (const std::length_error&) {
        result = FW_ERROR_OUT_OF_MEMORY;
        composeMessage(text, kNoMemoryText, function, unit);
    } catch (...) {
        composeMessage(text, "The library fails for a reason it does not know.", function, unit);
    }
    report(result, text);
    return result;
}

// The same of a call without a context or world, which has nowhere to report to.
template <class Body>
FwResult guardAlone(const char* function, Body&& body) noexcept {
    return guard(
        function, [](FwResult, const char*) {}, body);
}

inline constexpr uint32_t kLargestStruct = 64 * 1024;  // bytes: beyond it structSize is garbage

// ---- defs: what an older or newer host gives ---------------------------------------------------

struct DefRow {  // a def by its FwDefType
    uint32_t type;
    size_t size;
    void (*writeDefaults)(void* def) noexcept;
    // Turns the lengths of a host's def from metres into its unit. Null: the def has none.
    void (*fromMetres)(const Unit& unit, void* def);
};
const DefRow* findDef(uint32_t type) noexcept;     // null: unknown
std::span<const DefRow> vulkanDefRows() noexcept;  // vulkan.cpp

// A def of zeros but for its size and what kFill sets, to where there is room for one.
template <class Def, void (*kFill)(Def&) noexcept>
void writeDefaultsOf(void* out) noexcept {
    Def def;
    std::memset(&def, 0, sizeof def);
    kFill(def);
    def.structSize = sizeof def;
    std::memcpy(out, &def, sizeof def);
}

// Copies a def whose first word is structSize over one of defaults, which keeps what the host does
// not know.
template <class Def>
void overlayDef(Def& def, const Def* given, const char* name) {
    if (!given) core::refuse("%s is null.", name);
    uint32_t size = 0;
    std::memcpy(&size, given, sizeof size);
    if (size < 8 || size % alignof(Def) != 0 || size > kLargestStruct)
        core::fail(FW_ERROR_VERSION,
                   "%s::structSize is %u; it is a multiple of %zu in [8, %u] and %zu in this "
                   "version. Take the struct from its fwDefault function.",
                   name, size, alignof(Def), kLargestStruct, sizeof(Def));
    if (size > sizeof(Def)) {
        const auto* bytes = reinterpret_cast<const unsigned char*>(given);
        for (uint32_t at = sizeof(Def); at < size; ++at)
            if (bytes[at] != 0)
                core::fail(FW_ERROR_VERSION,
                           "%s::structSize is %u and byte %u is %u; this library knows %zu bytes "
                           "and the rest must be zero.",
                           name, size, at, bytes[at], sizeof(Def));
    }
    std::memcpy(&def, given, size < sizeof def ? size : sizeof def);
    def.structSize = sizeof def;
}

// The def of a host whose lengths are in `unit`; those that are left out are the defaults' metres.
template <class Def>
Def readDef(const Def* given, const Unit& unit = {}, const char* name = StructOf<Def>::kName) {
    Def def;
    findDef(StructOf<Def>::kType)->writeDefaults(&def);
    fromMetres(unit, def);
    overlayDef(def, given, name);
    toMetres(unit, def);
    return def;
}

// Checks a struct that the library fills; returns how many bytes the caller has.
template <class Info>
uint32_t checkInfo(const Info* info) {
    constexpr const char* name = StructOf<Info>::kName;
    if (!info) core::refuse("%s is null.", name);
    uint32_t size = 0;
    std::memcpy(&size, info, sizeof size);
    if (size < 8 || size > kLargestStruct)
        core::fail(FW_ERROR_VERSION,
                   "%s::structSize is %u; set it to sizeof(%s), which is %zu in this version.",
                   name, size, name, sizeof(Info));
    return size;
}

// Writes the caller's first bytes and zero beyond what this library knows; keeps structSize.
template <class Info>
void writeInfo(Info* out, uint32_t size, Info filled) {
    filled.structSize = size;
    const size_t known = size < sizeof filled ? size : sizeof filled;
    std::memcpy(out, &filled, known);
    if (size > known) std::memset(reinterpret_cast<char*>(out) + known, 0, size - known);
}

// view.cpp. Throws unless every number of a camera can be used; turns its lengths into metres.
void validatedView(const Unit& unit, FwView& view, const char* name);

}  // namespace fw::edge
