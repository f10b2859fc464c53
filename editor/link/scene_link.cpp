// See scene_link.h.
#include "link/scene_link.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "document/apply.h"

namespace fwlink {
namespace {

constexpr uint32_t kMostSide = 4096;        // px, of a layer
constexpr size_t kMostAnswer = 64u << 10;   // bytes
constexpr size_t kMostUnsent = 1u << 20;    // bytes of answers
constexpr uint32_t kMostScenesAtOnce = 16;  // limit per caller and frame
constexpr size_t kTileSize = std::tuple_size_v<fwedit::PaintImage::Tile>;

uint32_t tilesOf(uint32_t side) {
    return (side + fwedit::PaintImage::kTile - 1) / fwedit::PaintImage::kTile;
}

bool sameTile(const std::shared_ptr<const fwedit::PaintImage::Tile>& a,
              const std::shared_ptr<const fwedit::PaintImage::Tile>& b) {
    return a == b || (a && b && *a == *b);
}

// Encodes the tiles that the peer lacks. The peer has `before`, or nothing of that size.
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

void addLine(std::string& report, const std::string& line) {
    if (!report.empty() && !line.empty()) report += '\n';
    report += line;
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
        if (message.kind != Kind::Taken || !body.whole() || number > sent_ ||
            answer.size() > kMostAnswer)
            return channel_.fail(
                "The link is closed: an answer that is none, is to a scene that was not "
                "sent, or is longer than " +
                std::to_string(kMostAnswer) + " bytes");
        shown_ = number;
        answer_ = answer;
    }
    if (!connected() || !channel_.isDrained() || document.revision == followed_) return;
    followed_ = document.revision;
    for (const auto& [layer, image] : document.images) {
        const auto before = images_.find(layer);
        if (before != images_.end() && before->second == image) continue;
        channel_.send(Kind::Paint,
                      paintBody(layer, image, before == images_.end() ? nullptr : &before->second));
    }
    // A layer whose first paint was undone is sent without tiles.
    for (const auto& [layer, image] : images_)
        if (!document.images.contains(layer) && fwedit::findIn(document.scene.layers, layer))
            channel_.send(Kind::Paint,
                          paintBody(layer, {image.width, image.height, image.empty, {}}, nullptr));
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
    LayerPaint head;
    head.width = body.number<uint32_t>();
    head.height = body.number<uint32_t>();
    head.empty = body.number<uint8_t>();
    const auto isUpdate = body.number<uint8_t>();
    const auto count = body.number<uint32_t>();
    if (!body.good || head.width < 1 || head.width > kMostSide || head.height < 1 ||
        head.height > kMostSide) {
        error = "paint of " + std::to_string(head.width) + "x" + std::to_string(head.height) +
                " px; sides are 1 to " + std::to_string(kMostSide);
        return false;
    }
    const auto before = paint_.find(layer);
    if (isUpdate && (before == paint_.end() || before->second.width != head.width ||
                     before->second.height != head.height || before->second.empty != head.empty)) {
        error = "an update of paint that is not here, or that has another size";
        return false;
    }
    if (before == paint_.end() && paint_.size() >= fwedit::kMostObjects) {
        error = "paint for more than " + std::to_string(fwedit::kMostObjects) +
                " layers; a scene has no more objects than that";
        return false;
    }
    // Decode the whole body before applying any of it.
    const uint32_t most = tilesOf(head.width) * tilesOf(head.height);
    std::vector<std::pair<uint32_t, std::span<const uint8_t>>> sent;
    size_t made = 0;  // new tiles
    for (uint32_t i = 0; i < count && body.good; ++i) {
        const auto at = body.number<uint32_t>();
        const auto there = body.number<uint8_t>();
        const auto values = body.bytes(there ? kTileSize : 0);
        if (!body.good) break;
        if (at >= most) {
            error = "tile " + std::to_string(at) + " of " + std::to_string(most);
            return false;
        }
        sent.emplace_back(at, values);
        made += there ? 1 : 0;
    }
    if (!body.whole()) {
        error = "paint that ends before its tiles do, or after them";
        return false;
    }
    if ((tiles_ + made) * kTileSize > kMostPaint) {
        error = "more than " + std::to_string(kMostPaint >> 20) + " MiB of paint";
        return false;
    }
    LayerPaint& paint = paint_[layer];
    tiles_ -= paint.tiles.size();
    if (!isUpdate) paint = std::move(head);
    for (const auto& [at, values] : sent) {
        if (values.empty()) {
            paint.tiles.erase(at);
            continue;
        }
        auto tile = std::make_shared<fwedit::PaintImage::Tile>();
        std::copy(values.begin(), values.end(), tile->begin());
        paint.tiles[at] = std::move(tile);
    }
    tiles_ += paint.tiles.size();
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
    std::vector<std::string> ignored;  // the editor's own scenes need no repairs
    if (!fwedit::readScene(text, "The scene of the link", made.scene, ignored, error)) return false;
    std::erase_if(
        paint_, [&](const auto& paint) { return !fwedit::findIn(made.scene.layers, paint.first); });
    tiles_ = 0;
    for (const auto& [layer, paint] : paint_) {
        // A table of 4096 x 4096 px takes 64 KiB, so a layer without tiles gets none.
        if (paint.tiles.empty()) continue;
        fwedit::PaintImage& image = made.images[layer];
        image.width = paint.width;
        image.height = paint.height;
        image.empty = paint.empty;
        image.tiles.resize(size_t{tilesOf(paint.width)} * tilesOf(paint.height));
        for (const auto& [at, tile] : paint.tiles) image.tiles[at] = tile;
        tiles_ += paint.tiles.size();
    }
    scene_ = std::move(made);
    return true;
}

void SceneReceiver::acceptCallers() {
    for (size_t i = 0; i < kMostCallers; ++i) {
        Channel channel = listener_.accept();
        if (!channel.open()) break;
        // If all places are taken, drop the caller that sent least.
        if (callers_.size() == kMostCallers)
            callers_.erase(std::ranges::min_element(
                callers_, {}, [](const Caller& caller) { return caller.channel.received(); }));
        callers_.push_back({std::move(channel), {}});
    }
}

bool SceneReceiver::readCaller(Caller& caller, std::string& report) {
    caller.channel.pump();
    bool whole = false;
    uint32_t scenes = 0;  // limit per frame; the rest waits
    for (Message message; scenes < kMostScenesAtOnce && caller.channel.next(message);) {
        bool isScene = false;
        std::string error;
        if (!caller.reader.take(message, isScene, error)) {
            caller.channel.fail("The link is closed: " + error);
            whole = false;
            break;
        }
        whole |= isScene;
        scenes += isScene ? 1 : 0;
    }
    if (!caller.channel.open()) addLine(report, caller.channel.takeProblem());
    return whole;
}

bool SceneReceiver::poll(LinkedScene& scene, std::string& report) {
    report.clear();
    acceptCallers();
    bool isNew = readCaller(editor_, report);
    for (Caller& caller : callers_) {
        if (!readCaller(caller, report)) continue;
        if (editor_.channel.open()) addLine(report, "Another editor has taken over the link.");
        editor_ = std::move(caller);  // the moved-from channel is closed and removed below
        isNew = true;
    }
    std::erase_if(callers_, [](const Caller& caller) { return !caller.channel.open(); });
    if (isNew) scene = editor_.reader.scene();  // of several, the last one counts
    return isNew;
}

void SceneReceiver::took(uint64_t number, const std::string& answer) {
    BodyWriter body;
    body.number(number);
    body.text(std::string_view(answer).substr(0, kMostAnswer));
    if (editor_.channel.unsent() > kMostUnsent)
        return editor_.channel.fail("The link is closed: the editor does not read its answers");
    editor_.channel.send(Kind::Taken, body.body);
    editor_.channel.pump();
}

}  // namespace fwlink
