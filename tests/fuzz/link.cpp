// The editor's live link: a stream of messages as a sample gets it.
#include "fuzz/fuzzer.h"
#include "link/scene_link.h"

#include <gtest/gtest.h>

namespace fuzz {
namespace {

// Makes the checksums of the stream's messages right.
Bytes signedMessages(Input input) {
    Bytes stream(input.begin(), input.end());
    for (size_t at = 0; at + fwlink::kHeadSize <= stream.size();) {
        const auto rest = Input(stream).subspan(at);
        fwlink::BodyReader head(rest.first(fwlink::kHeadSize));
        (void)head.bytes(8);
        const size_t size = head.number<uint32_t>();
        if (size > rest.size() - fwlink::kHeadSize) break;
        fwlink::Bytes good;
        fwlink::appendMessage(good, fwlink::Kind::Scene, rest.subspan(fwlink::kHeadSize, size));
        std::memcpy(&stream[at + 12], &good[12], 4);
        at += fwlink::kHeadSize + size;
    }
    return stream;
}

std::vector<Bytes> linkSeeds() {
    // As SceneSender writes them: the tiles of layer 2, then the scene that uses them.
    fwlink::BodyWriter paint, scene;
    for (const uint32_t number : {2u, 64u, 64u}) paint.number(number);
    for (const uint8_t number : {255, 0}) paint.number(number);   // empty texels; no update
    for (const uint32_t number : {1u, 0u}) paint.number(number);  // one tile, the first
    paint.number(uint8_t{1});
    paint.bytes(std::vector<uint8_t>(sizeof(fwedit::PaintImage::Tile), 90));
    scene.number(uint64_t{1});
    scene.text("/nonexistent");
    scene.text(textOf(fixture("yard.fwscene")));
    Bytes onlyScene, both;
    fwlink::appendMessage(onlyScene, fwlink::Kind::Scene, scene.body);
    fwlink::appendMessage(both, fwlink::Kind::Paint, paint.body);
    fwlink::appendMessage(both, fwlink::Kind::Scene, scene.body);
    return {onlyScene, both};
}

const Fuzzer kLink{
    "link", linkSeeds, [](Input input) {
        const Bytes stream = signedMessages(input);
        fwlink::MessageReader messages;
        fwlink::SceneReader scenes;
        std::string error;
        bool accepted = false;
        for (size_t at = 0; at < stream.size(); at += 1000) {
            messages.feed(Input(stream).subspan(at, std::min<size_t>(1000, stream.size() - at)));
            for (fwlink::Message message; messages.next(message, error);) {
                bool whole = false;
                const bool taken = scenes.take(message, whole, error);
                EXPECT_TRUE(taken || !error.empty());
                if (!taken) return false;
                accepted |= whole;
            }
        }
        EXPECT_LE(scenes.paintBytes(), fwlink::SceneReader::kMostPaint);
        for (const auto& [layer, image] : scenes.scene().images) {
            EXPECT_EQ(size_t{image.width} * image.height, image.flat().size()) << layer;
            break;  // one is enough: each may take 16 MiB
        }
        return accepted;
    }};

}  // namespace
}  // namespace fuzz
