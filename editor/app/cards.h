// Pictures of the welcome page's scenes, embedded in the program. The target flamewright_guide
// renders them.
#pragma once

#include <span>
#include <vector>

#include "shell/ui_renderer.h"

namespace fwapp {

class Cards {
 public:
    Cards(const sample::VulkanHost& host, fwui::UiRenderer& ui, size_t count);
    ~Cards();
    Cards(const Cards&) = delete;
    Cards& operator=(const Cards&) = delete;

    // Loads one more picture while the page is visible. Returns false when all are loaded.
    bool loadNext();
    // Returns null if it is not loaded or missing. The aspect is kCardAspect.
    [[nodiscard]] void* texture(size_t card) const;

 private:
    struct Card {
        sample::Image image;
        void* texture = nullptr;
    };
    const sample::VulkanHost& host_;
    fwui::UiRenderer& ui_;
    std::vector<Card> cards_;
    size_t next_ = 0;
};

constexpr float kCardAspect = 1 / 0.62f;

// The embedded PNG; empty if the build has none.
std::span<const unsigned char> cardPicture(size_t card);

}  // namespace fwapp
