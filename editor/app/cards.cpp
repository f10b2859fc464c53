// See cards.h.
#include "app/cards.h"

#include "import/image_decode.h"

namespace fwapp {

namespace {
#include "card_pictures.inc"
}  // namespace

std::span<const unsigned char> cardPicture(size_t card) {
    return card < std::size(kCardPictures) ? kCardPictures[card] : std::span<const unsigned char>();
}

Cards::Cards(const sample::VulkanHost& host, fwui::UiRenderer& ui, size_t count)
    : host_(host), ui_(ui), cards_(count) {}

Cards::~Cards() {
    vkDeviceWaitIdle(host_.device);
    for (Card& card : cards_) {
        if (card.texture) ui_.removeTexture(card.texture);
        host_.destroy(card.image);
    }
}

bool Cards::loadNext() {
    if (next_ >= cards_.size()) return false;
    Card& card = cards_[next_];
    fwimport::DecodedImage picture;
    std::string error;  // a card without a picture shows its icon
    const auto bytes = cardPicture(next_);
    if (!bytes.empty() && fwimport::decodeImage({bytes.data(), bytes.size()}, picture, error)) {
        card.image = host_.createTexture(picture.width, picture.height, picture.rgba.data(), false);
        card.texture = ui_.addTexture(card.image.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    }
    return ++next_ < cards_.size();
}

void* Cards::texture(size_t card) const {
    return card < cards_.size() ? cards_[card].texture : nullptr;
}

}  // namespace fwapp
