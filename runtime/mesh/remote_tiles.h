// A mesh's tiles as places that give and receive fire at a distance, and the texels of two objects
// that come so near that flames lick across. Integers; not who burns, nor what is received.
#pragma once
#include "mesh/burn_domain.h"
#include "shared/exchange.h"

namespace fw::mesh {

// One per tile, in their order; replaces `out`. Returns how many source cells they are in.
uint32_t remoteTiles(const BurnDomain& domain, std::pmr::vector<gpu::RemoteTile>& out);
// The same count, without the tiles.
uint32_t sourceCells(const BurnDomain& domain) noexcept;

struct Box {  // mm, world; low > high: empty
    int low[3] = {1, 1, 1}, high[3] = {0, 0, 0};
};
[[nodiscard]] Box placedBox(const gpu::RemoteObject& place, const uint16_t (&low)[3],
                            const uint16_t (&high)[3]) noexcept;
// The largest of the three distances along an axis; < 0: they overlap.
[[nodiscard]] int gapOf(const Box& a, const Box& b) noexcept;

struct Contact {
    uint32_t texel = 0, fromTexel = 0;
    uint32_t gap = 0;  // mm, [0, kContactGap]
};

struct ContactSide {
    const BurnDomain* domain = nullptr;
    const gpu::RemoteObject* place = nullptr;
    uint32_t burns = 0;  // bit i: its material i can burn
};

// Contacts of one object take no more; the rest of its tiles is left out.
constexpr size_t kMostContacts = 8192;

// Memory that searches for contacts share, and what the last of them found.
struct Contacts {
    struct Place {  // a burnable texel near the other object
        int at[3] = {};
        uint32_t texel = 0, block = 0;  // block: of 4 x 4 texels
        uint32_t cell = 0;              // of the search, if it lists its cells
    };
    explicit Contacts(std::pmr::memory_resource* memory)
        : found{std::pmr::vector<Contact>(memory), std::pmr::vector<Contact>(memory)},
          places{std::pmr::vector<Place>(memory), std::pmr::vector<Place>(memory)},
          byCell(memory) {}
    // [k]: per block of side k its texel that is nearest to one of the other side.
    std::pmr::vector<Contact> found[2];
    std::pmr::vector<Place> places[2], byCell;
};
void findContacts(const ContactSide (&sides)[2], Contacts& contacts);

}  // namespace fw::mesh
