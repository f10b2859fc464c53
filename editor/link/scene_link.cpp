// See scene_link.h.
#include "link/scene_link.h"

#include <algorithm>
#include <tuple>

namespace fwlink {
namespace {

constexpr uint32_t kMostSide = 4096;  // px, of a layer
constexpr size_t kTileSize = std::tuple_size_v<fwedit::PaintImage::Tile>;

uint32_t tilesOf(uint32_t side) {
    return (side + fwedit::PaintImage::kTile - 1) / fwedit::PaintImage::kTile;
}

bool sameTile(const std::shared_ptr<const fwedit::PaintImage::Tile>& a,
              const std::shared_ptr<const fwedit::PaintImage::Tile>& b) {
    return a == b || (a && b && *a == *b);
}

// The tiles of a layer that the other side has not; it has `before`, or nothing of that size.
Bytes paintBody(fwedit::ObjectId layer, const fwedit::PaintImage& image,
                const fwedit::PaintImage* before) {
    const bool fits = before && before->width == image.width && before->height == image.height &&
                      before->empty == image.empty;
    std::vector<uint32_t> changed;
    for (uint32_t i = 0; i < image.tiles.size(); ++i)
        if (fits ? !sameTile(image.tiles[i], before->tiles[i]) : image.tiles[i] != nullptr)
            changed.push_back(i);
    BodyWriter body;
    body.number(layer);
    body.number(image.width);
    body.number(image.height);
    body.number(image.empty);
    body.number(static_cast<uint8_t>(fits));
    body.number(static_cast<uint32_t>(changed.size()));
    for (const uint32_t i : changed) {
        body.number(i);
        body.number(static_cast<uint8_t>(image.tiles[i] != nullptr));
        if (image.tiles[i]) body.bytes(*image.tiles[i]);
    }
    return std::move(body.body);
}

}  // namespace

bool SceneSender::connect(uint16_t port, std::string& error) {
    images_.clear();
    followed_ = ~0ull;
    sent_ = shown_ = 0;
    answer_.clear();
    return channel_.connect(port, error);
}

void SceneSender::follow(const fwedit::Document& document) {
    channel_.pump();
    for (Message message; channel_.next(message);) {
        BodyReader body(message.body);
        const auto number = body.number<uint64_t>();
        const std::string answer = body.text();
        if (message.kind != Kind::Taken || !body.whole() || number > sent_) {
            channel_.close();
            return;
        }
        shown_ = number;
        answer_ = answer;
    }
    if (!connected() || !channel_.drained() || document.revision == followed_) return;
    followed_ = document.revision;
    for (const auto& [layer, image] : document.images) {
        const auto before = images_.find(layer);
        if (before != images_.end() && before->second == image) continue;
        channel_.send(Kind::Paint,
                      paintBody(layer, image, before == images_.end() ? nullptr : &before->second));
    }
    images_ = document.images;
    BodyWriter body;
    body.number(++sent_);
    body.text(fwedit::absoluteBase(document).string());
    body.text(fwedit::printScene(document.scene));
    channel_.send(Kind::Scene, body.body);
    channel_.pump();
}

bool SceneReader::take(const Message& message, bool& whole, std::string& error) {
    BodyReader body(message.body);
    whole = message.kind == Kind::Scene;
    if (message.kind == Kind::Paint) return takePaint(body, error);
    if (whole) return takeScene(body, error);
    error = "a message that is for the editor";
    return false;
}

bool SceneReader::takePaint(BodyReader& body, std::string& error) {
    const auto layer = body.number<fwedit::ObjectId>();
    fwedit::PaintImage image;
    image.width = body.number<uint32_t>();
    image.height = body.number<uint32_t>();
    image.empty = body.number<uint8_t>();
    const auto goesOn = body.number<uint8_t>();
    const auto count = body.number<uint32_t>();
    if (!body.good || image.width < 1 || image.width > kMostSide || image.height < 1 ||
        image.height > kMostSide) {
        error = "paint of " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                " px; sides are 1 to " + std::to_string(kMostSide);
        return false;
    }
    image.tiles.resize(size_t{tilesOf(image.width)} * tilesOf(image.height));
    if (goesOn) {
        const auto before = images_.find(layer);
        if (before == images_.end() || before->second.tiles.size() != image.tiles.size()) {
            error = "paint that goes on from none that is here";
            return false;
        }
        image.tiles = before->second.tiles;
    }
    for (uint32_t i = 0; i < count && body.good; ++i) {
        const auto at = body.number<uint32_t>();
        const auto there = body.number<uint8_t>();
        const auto values = body.bytes(there ? kTileSize : 0);
        if (!body.good) break;
        if (at >= image.tiles.size()) {
            error = "tile " + std::to_string(at) + " of " + std::to_string(image.tiles.size());
            return false;
        }
        image.tiles[at] = nullptr;
        if (!there) continue;
        auto tile = std::make_shared<fwedit::PaintImage::Tile>();
        std::copy(values.begin(), values.end(), tile->begin());
        image.tiles[at] = std::move(tile);
    }
    if (!body.whole()) {
        error = "paint that ends before its tiles do, or after them";
        return false;
    }
    images_[layer] = std::move(image);
    return true;
}

bool SceneReader::takeScene(BodyReader& body, std::string& error) {
    LinkedScene made;
    made.number = body.number<uint64_t>();
    made.folder = body.text();
    const std::string text = body.text();
    if (!body.whole()) {
        error = "a scene that ends before its text does, or after it";
        return false;
    }
    std::vector<std::string> ignored;  // the editor's own scenes need none
    if (!fwedit::readScene(text, "The scene of the link", made.scene, ignored, error)) return false;
    std::erase_if(images_, [&](const auto& image) {
        return !fwedit::findIn(made.scene.layers, image.first);
    });
    made.images = images_;
    scene_ = std::move(made);
    return true;
}

bool SceneReceiver::poll(LinkedScene& scene, std::string& report) {
    report.clear();
    if (!channel_.open()) {
        if (met_) report = channel_.problem();
        met_ = false;
        if (Channel caller = listener_.accept(); caller.open()) {
            channel_ = std::move(caller);
            reader_ = {};
            met_ = true;
        }
    }
    channel_.pump();
    bool news = false;
    for (Message message; channel_.next(message);) {
        bool whole = false;
        std::string error;
        if (!reader_.take(message, whole, error)) {
            channel_.close();
            met_ = false;
            report = "The link is closed: " + error;
            break;
        }
        news |= whole;
    }
    if (news) scene = reader_.scene();  // of several the last
    return news;
}

void SceneReceiver::took(uint64_t number, const std::string& answer) {
    BodyWriter body;
    body.number(number);
    body.text(answer);
    channel_.send(Kind::Taken, body.body);
    channel_.pump();
}

}  // namespace fwlink
