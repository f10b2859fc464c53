// Books of volumetric flames: of flames that are alike one is marched as a card in each frame, and
// the last frames of it are a book. The others show its pages, each some frames late, as wide and
// as high as they are and leaning as they do. What a page looks like is volume_impostor's.
#pragma once
#include "lod/volumes.h"

#include <array>
#include <cstdint>
#include <span>

namespace fw::lod {

constexpr uint32_t kMaxImpostorAtlases = 4;
constexpr uint32_t kAtlasFrames = 32;
constexpr uint32_t kAtlasFrameStep = 8;  // frames from one flame's pages to another's
constexpr uint32_t kImpostorAtlasWords = kAtlasFrames * kImpostorWords;
constexpr uint32_t kNoAtlas = ~0u;

// What makes flames alike, whatever their size, seed and place.
struct AtlasKind {
    uint32_t look = 0;   // hash of all that is the same for any size
    float wide = 0;      // m, diameter
    float tall = 0;      // diameters, mean height
    float facing = 0;    // cosine between its axis and the way from the eye to it
    bool plain = false;  // nothing stands in its way, it burns whole, its line is nearly straight
};
// `tip`: m, from its base to where its mean height ends; `facing` is the view's.
AtlasKind atlasKind(const FlameRecord& record, const FlameNode* nodes, uint32_t count, vec3& tip);

struct AtlasItem {  // a flame that a view shows
    AtlasKind kind;
    uint32_t key = 0;
    float covers = 0;    // of the view, any unit
    bool wants = false;  // a book, if there is one
    bool fits = false;   // a card, see impostorFits
};

struct AtlasFrame {
    ImpostorShape card;
    vec3 middle{};  // m across the view, and along it, from where the flame stands to its middle
    vec2 tip{};     // m across the view, from where it stands
    float wide = 0;
    uint32_t run = 0;  // a number for all pages of one flame, one after the other
};

struct ImpostorAtlas {
    bool used = false;
    AtlasKind kind;        // its flame's
    uint32_t key = 0;      // its flame
    uint32_t run = 0;      // of the next page
    uint32_t shares = 0;   // flames that want it
    uint64_t written = 0;  // pages; the newest is `written - 1`, in its place modulo kAtlasFrames
    std::array<AtlasFrame, kAtlasFrames> pages;
    [[nodiscard]] bool whole() const noexcept { return written >= kAtlasFrames; }
};
using ImpostorAtlases = std::array<ImpostorAtlas, kMaxImpostorAtlases>;

// Which of the first `room` books each item may show (kNoAtlas: none), and whose flame each book is
// of. had[i]: the book that the item has shown, or kNoAtlas. Books that nobody wants are gone.
void chooseAtlases(std::span<const AtlasItem> items, std::span<const uint32_t> had, uint32_t room,
                   ImpostorAtlases& books, std::span<uint32_t> out) noexcept;

// Where a flame is in its book, from frame to frame.
struct AtlasCursor {
    uint32_t key = 0;  // the flame
    uint32_t book = kNoAtlas;
    uint64_t at = 0;  // page
    bool mirrored = false;
    uint64_t before = 0;  // where it was before it turned over
    uint32_t bookBefore = kNoAtlas;
    bool mirroredBefore = false;
    uint32_t turned = kAtlasFrameStep;  // frames ago
    // In a frame for which `book` has its newest page. The book's own flame shows that, others an
    // older one each, by their key; it goes on page by page, and from one flame's to another's in
    // kAtlasFrameStep frames.
    void read(uint32_t number, const ImpostorAtlases& books) noexcept;
};

// As placeImpostor, into a page.
void placeAtlasFrame(const ViewParams& view, const VolumeItem& item, const VolumeScreen& screen,
                     uint32_t slot, AtlasFrame& page, MarchedVolume& out) noexcept;
// As showImpostor; the page is turned, stretched and widened to what the item is.
bool showAtlasFrame(const ViewParams& view, const VolumeItem& item, const VolumeScreen& screen,
                    uint32_t slot, const AtlasFrame& page, bool mirrored,
                    VolumeImpostor& out) noexcept;

}  // namespace fw::lod
