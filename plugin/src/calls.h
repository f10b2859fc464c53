// Calls of the C ABI that pass their arguments on to a member of a system: each converts what the
// host gives, calls the member, and converts what it answers.
#pragma once
#include "objects.h"

#include <functional>

namespace fw::edge {

// ---- arguments, as the host gives them

struct Place {  // three lengths or speeds; null is refused
    const float* given;
    const char* name;
};
struct Length {
    float given;
};
struct Bytes {
    const void* given;
    uint64_t size;
};
struct UnitsPerMetre {};  // of the world

// ---- the same, as systems take them

template <class T>
T argument(FwWorld&, T given) noexcept {
    return given;
}
template <class Def>
requires(StructOf<Def>::kType != 0) InMetres<Def> argument(FwWorld& world, const Def* given) {
    return {world, given};
}
inline Metres argument(FwWorld& world, const Place& place) {
    checkPointer(place.given, place.name);
    return {world.unit, place.given};
}
inline float argument(FwWorld& world, Length length) noexcept {
    Scale{world.unit}(length.given);
    return length.given;
}
inline float argument(FwWorld& world, UnitsPerMetre) noexcept {
    return float(world.unit.perMetre());
}
inline std::span<const std::byte> argument(FwWorld&, const Bytes& bytes) {
    checkPointer(bytes.given, "bytes");
    return {static_cast<const std::byte*>(bytes.given), size_t(bytes.size)};
}

template <class System, class Member, class... Given>
decltype(auto) invoke(FwWorld& world, Member System::*member, const Given&... given) {
    return std::invoke(member, systemOf<System>(*world.world), argument(world, given)...);
}

// ---- calls

template <class System, class Member, class... Given>
FwResult call(const char* function, FwWorld* world, Member System::*member, Given... given) {
    return onWorld(function, world, [&](world::World&) { invoke(*world, member, given...); });
}

// Stores what the member returns.
template <class Out, class System, class Member, class... Given>
FwResult callFor(const char* function, FwWorld* world, Out* out, const char* name,
                 Member System::*member, Given... given) {
    return onWorld(function, world, [&](world::World&) {
        checkPointer(out, name);
        *out = invoke(*world, member, given...);
    });
}
template <class Id, class System, class Member, class... Given>
FwResult create(const char* function, FwWorld* world, Id* id, Member System::*member,
                Given... given) {
    if (id) *id = {};
    return callFor(function, world, id, "id", member, given...);
}

// Fills a struct of the caller's; a member that returns false is not ready.
template <class Info, class System, class Member, class... Given>
FwResult fill(const char* function, FwWorld* world, Info* info, Member System::*member,
              Given... given) {
    return onWorld(function, world, [&](world::World&) {
        const uint32_t size = checkInfo(info);
        Info filled{};
        const auto fills = [&] { return invoke(*world, member, given..., std::ref(filled)); };
        if constexpr (std::is_void_v<decltype(fills())>)
            fills();
        else if (!fills())
            return FW_NOT_READY;
        fromMetres(world->unit, filled);
        writeInfo(info, size, filled);
        return FW_OK;
    });
}

// Fills a list of the caller's; returns how many it holds.
template <class Info, class System>
uint32_t list(const char* function, FwWorld* world, Info* infos, uint32_t capacity,
              const char* name, uint32_t (System::*member)(std::span<Info>)) {
    uint32_t count = 0;
    (void)onWorld(function, world, [&](world::World&) {
        if (capacity > 0) checkPointer(infos, name);
        count = invoke(*world, member, std::span(infos, capacity));
        for (uint32_t i = 0; i < count; ++i) fromMetres(world->unit, infos[i]);
    });
    return count;
}

// *size: room in `buffer`, then what there is; buffer null: the host asks for the size.
inline void giveBytes(std::span<const std::byte> bytes, const char* what, void* buffer,
                      uint64_t& size) {
    const uint64_t room = std::exchange(size, bytes.size());
    if (!buffer) return;
    if (room < bytes.size())
        core::refuse("*size is %llu and the %s has %zu bytes.",
                     static_cast<unsigned long long>(room), what, bytes.size());
    std::memcpy(buffer, bytes.data(), bytes.size());
}
// The member returns bytes, or null while they are not ready.
template <class System, class Member, class... Given>
FwResult fetch(const char* function, FwWorld* world, const char* what, void* buffer, uint64_t* size,
               Member System::*member, Given... given) {
    return onWorld(function, world, [&](world::World&) {
        checkPointer(size, "size");
        const std::pmr::vector<std::byte>* bytes = invoke(*world, member, given...);
        if (!bytes) return FW_NOT_READY;
        giveBytes(*bytes, what, buffer, *size);
        return FW_OK;
    });
}

}  // namespace fw::edge
