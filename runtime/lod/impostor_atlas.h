// Books of volumetric flames: of flames that are alike one is marched as a card in each frame, and
// the last frames of it are a book. The others show its pages, each some frames late, as wide and
// as high as they are and leaning as they do. What a page looks like is volume_card's.
#pragma once
#include "lod/volumes.h"

#include <array>
#include <cstdint>
#include <span>

namespace fw::lod {

constexpr uint32_t kVolumeBooks = 4;
constexpr uint32_t kBookPages = 32;
constexpr uint32_t kBookTurn = 8;  // frames from one flame's pages to another's
constexpr uint32_t kVolumeBookWords = kBookPages * kCardWords;
constexpr uint32_t kNoBook = ~0u;

// What makes flames alike, whatever their size, seed and place.
struct BookKind {
    uint32_t look = 0;   // hash of all that is the same for any size
    float wide = 0;      // m, diameter
    float tall = 0;      // diameters, mean height
    float facing = 0;    // cosine between its axis and the way from the eye to it
    bool plain = false;  // nothing stands in its way, it burns whole, its line is nearly straight
};
// `tip`: m, from its base to where its mean height ends; `facing` is the view's.
BookKind bookKind(const FlameRecord& record, const FlameNode* nodes, uint32_t count, vec3& tip);

struct BookItem {  // a flame that a view shows
    BookKind kind;
    uint32_t key = 0;
    float covers = 0;    // of the view, any unit
    bool wants = false;  // a book, if there is one
    bool fits = false;   // a card, see cardFits
};

struct BookPage {
    VolumeCardShape card;
    vec3 middle{};  // m across the view, and along it, from where the flame stands to its middle
    vec2 tip{};     // m across the view, from where it stands
    float wide = 0;
    uint32_t run = 0;  // a number for all pages of one flame, one after the other
};

struct VolumeBook {
    bool used = false;
    BookKind kind;         // its flame's
    uint32_t key = 0;      // its flame
    uint32_t run = 0;      // of the next page
    uint32_t shares = 0;   // flames that want it
    uint64_t written = 0;  // pages; the newest is `written - 1`, in its place modulo kBookPages
    std::array<BookPage, kBookPages> pages;
    [[nodiscard]] bool whole() const noexcept { return written >= kBookPages; }
};
using VolumeBookShelf = std::array<VolumeBook, kVolumeBooks>;

// Which of the first `room` books each item may show (kNoBook: none), and whose flame each book is
// of. had[i]: the book that the item has shown, or kNoBook. Books that nobody wants are gone.
void chooseBooks(std::span<const BookItem> items, std::span<const uint32_t> had, uint32_t room,
                 VolumeBookShelf& books, std::span<uint32_t> out) noexcept;

// Where a flame is in its book, from frame to frame.
struct BookReader {
    uint32_t key = 0;  // the flame
    uint32_t book = kNoBook;
    uint64_t at = 0;  // page
    bool mirrored = false;
    uint64_t before = 0;  // where it was before it turned over
    uint32_t bookBefore = kNoBook;
    bool mirroredBefore = false;
    uint32_t turned = kBookTurn;  // frames ago
    // In a frame for which `book` has its newest page. The book's own flame shows that, others an
    // older one each, by their key; it goes on page by page, and from one flame's to another's in
    // kBookTurn frames.
    void read(uint32_t number, const VolumeBookShelf& books) noexcept;
};

// As layCard, into a page.
void layPage(const ViewParams& view, const VolumeItem& item, const VolumeScreen& screen,
             uint32_t slot, BookPage& page, MarchedVolume& out) noexcept;
// As showCard; the page is turned, stretched and widened to what the item is.
bool showPage(const ViewParams& view, const VolumeItem& item, const VolumeScreen& screen,
              uint32_t slot, const BookPage& page, bool mirrored, VolumeCard& out) noexcept;

}  // namespace fw::lod
