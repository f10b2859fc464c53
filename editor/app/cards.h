// The pictures of the welcome page's scenes, made by the build of the program as it is (target
// flamewright_guide) and kept in the program.
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

    // One more of them; they come while the page is looked at already. False: all are there.
    bool loadNext();
    // Null: not there yet, or there is none. Width over height is kCardAspect.
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

// A PNG as the build has it; empty: it was not made yet.
std::span<const unsigned char> cardPicture(size_t card);

}  // namespace fwapp
