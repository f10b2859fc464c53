// A mesh's tiles as sources and receivers of heat between objects, and the contacts of two objects:
// texels within kContactGap, where flames lick across. Geometry in integers; no state of a fire.
#pragma once
#include "mesh/burn_domain.h"
#include "shared/exchange.h"

namespace fw::mesh {

// One per tile, in their order; replaces `out`. Returns the number of their source cells.
uint32_t exchangeTiles(const BurnDomain& domain, std::pmr::vector<gpu::ExchangeTile>& out);
// The same count, from the tiles.
uint32_t sourceCells(std::span<const gpu::ExchangeTile> tiles) noexcept;

struct Box {  // mm, world; low > high: empty
    glm::ivec3 low{1}, high{0};
};
[[nodiscard]] Box placedBox(const gpu::ExchangeObject& place, const uint16_t (&low)[3],
                            const uint16_t (&high)[3]) noexcept;
// The largest of the three distances along an axis; < 0: they overlap.
[[nodiscard]] int gapOf(const Box& a, const Box& b) noexcept;

struct Contact {
    uint32_t texel = 0, fromTexel = 0;
    uint32_t gap = 0;  // mm, [0, kContactGap]
};

struct ContactSide {
    const BurnDomain* domain = nullptr;
    const gpu::ExchangeObject* place = nullptr;
    uint32_t burns = 0;  // bit i: its material i can burn
};

// Most contacts of one object; its further tiles have none.
constexpr size_t kMaxContacts = 8192;

// Memory that searches for contacts share, and the last search's contacts.
struct Contacts {
    struct Place {  // a burnable texel near the other object
        glm::ivec3 at{0};
        uint32_t texel = 0, block = 0;  // block: of 4 x 4 texels
        uint32_t cell = 0;              // of the search, where ContactCells::listed
    };
    explicit Contacts(std::pmr::memory_resource* memory)
        : found{std::pmr::vector<Contact>(memory), std::pmr::vector<Contact>(memory)},
          places{std::pmr::vector<Place>(memory), std::pmr::vector<Place>(memory)},
          byCell(memory) {}
    // [k]: per block of side k the texel nearest to a texel of the other side.
    std::pmr::vector<Contact> found[2];
    std::pmr::vector<Place> places[2], byCell;
};
void findContacts(const ContactSide (&sides)[2], Contacts& contacts);

}  // namespace fw::mesh
