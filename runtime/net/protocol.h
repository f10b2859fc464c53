// The protocol as one table: the phases of a peer, what the server sends in each phase, and the
// phase that each event leads to. A packet whose event the table does not have is refused.
#pragma once
#include "core/assert.h"
#include "flamewright/flamewright.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace fw::net {

enum class PeerPhase : uint8_t {
    calling,         // it has not greeted
    joining,         // it has no state and asks for none yet
    waitsForState,   // a capture for it is to come
    loadsState,      // pieces of a capture are on their way
    follows,         // it has a state, from which records go on
    waitsForTiles,   // it follows; a capture is to come, or its hashes of it
    loadsTiles,      // it follows; tiles of a capture are on their way
    outdated,        // it has a state from which the server's records do not go on
    waitsForReload,  // its state is wrong or outdated; a capture is to come
    loadsReload,     // its state is wrong or outdated; pieces of a capture are on their way
    count
};

enum class PeerEvent : uint8_t {
    greets,
    requestsNothing,  // the requests in the order of Request
    requestsState,
    requestsTiles,
    loads,   // it has loaded a state or tiles that it was given
    begins,  // the server begins to send it a state or tiles
    falls,   // it is too far behind, or the server's world has another past
    count
};

struct PeerRule {
    const char* name;
    bool hasState;  // it gets records
    bool waits;     // for a capture
    bool takes;     // pieces of a state or of tiles
    FwNetPhase shown;
    std::array<PeerPhase, size_t(PeerEvent::count)> after;  // by event; count: refused
};

constexpr PeerPhase kRefused = PeerPhase::count;

constexpr std::array<PeerRule, size_t(PeerPhase::count)> kPeerRules = [] {
    using enum PeerPhase;
    constexpr PeerPhase none = kRefused;
    return std::array<PeerRule, size_t(PeerPhase::count)>{{
        // clang-format off
        // name, hasState, waits, takes, shown,
        //     {greets, requestsNothing, requestsState, requestsTiles, loads, begins, falls}
        {"calling", false, false, false, FW_NET_CALLING,
         {joining, none, none, none, none, none, calling}},
        {"joining", false, false, false, FW_NET_LOADING,
         {joining, joining, waitsForState, none, follows, none, joining}},
        {"waiting for a state", false, true, false, FW_NET_LOADING,
         {waitsForState, joining, waitsForState, none, follows, loadsState, waitsForState}},
        {"taking a state", false, false, true, FW_NET_LOADING,
         {loadsState, joining, loadsState, none, follows, none, waitsForState}},
        {"following", true, false, false, FW_NET_FOLLOWING,
         {follows, follows, waitsForReload, waitsForTiles, follows, none, outdated}},
        {"waiting for tiles", true, true, false, FW_NET_FOLLOWING,
         {waitsForTiles, follows, waitsForReload, waitsForTiles, follows, loadsTiles, outdated}},
        {"taking tiles", true, false, true, FW_NET_FOLLOWING,
         {loadsTiles, follows, waitsForReload, loadsTiles, follows, none, outdated}},
        {"outdated", true, false, false, FW_NET_LOADING,
         {outdated, outdated, waitsForReload, outdated, follows, none, outdated}},
        {"waiting for another state", true, true, false, FW_NET_LOADING,
         {waitsForReload, outdated, waitsForReload, none, follows, loadsReload, waitsForReload}},
        {"taking another state", true, false, true, FW_NET_LOADING,
         {loadsReload, outdated, loadsReload, none, follows, none, waitsForReload}},
        // clang-format on
    }};
}();

constexpr const PeerRule& ruleOf(PeerPhase phase) noexcept { return kPeerRules[size_t(phase)]; }
constexpr PeerEvent eventOf(uint16_t request) noexcept {
    FW_ASSERT(request <= 2, "request %u", uint32_t(request));
    return PeerEvent(uint16_t(PeerEvent::requestsNothing) + request);
}
constexpr PeerPhase phaseAfter(PeerPhase phase, PeerEvent event) noexcept {
    return ruleOf(phase).after[size_t(event)];
}

}  // namespace fw::net
