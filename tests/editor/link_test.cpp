// The live link: edits arrive complete and only as far as they changed, invalid messages are
// refused, and either side may leave at any time.
#include "document/apply.h"
#include "link/scene_link.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <thread>

#include "editor/yard.h"

namespace {

using namespace fwtest;
using fwlink::Bytes;
using fwlink::Channel;
using fwlink::Kind;
using fwlink::LinkedScene;
using fwlink::Listener;
using fwlink::Message;
using fwlink::MessageReader;
using fwlink::SceneReader;
using fwlink::SceneReceiver;
using fwlink::SceneSender;
using ::testing::HasSubstr;

constexpr const char* kPainted =
    "import board.glb name=Board materials paper map_size 128 texels_per_metre 64\n"
    "add layer multiplier name=Belt mesh Board size 512\n";

// Polls for up to two seconds.
template <typename Predicate>
bool soon(Predicate&& predicate) {
    for (int i = 0; i < 1000; ++i) {
        if (predicate()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
}

// An editor with a painted board and a game that listens for it.
struct LinkedYard {
    LinkedYard() {
        yard.run(kPainted);
        EXPECT_TRUE(receiver.listen(0, error)) << error;
    }
    void link() { yard.run("link " + std::to_string(receiver.port()) + "\n"); }
    bool poll() { return receiver.poll(scene, report); }

    Yard yard;
    SceneReceiver receiver;
    LinkedScene scene;
    std::string error, report;
};

TEST(EditorLink, MessagesArriveWholeInAnyPieces) {
    Bytes stream;
    for (uint8_t i = 0; i < 40; ++i)
        fwlink::appendMessage(stream, i % 2 ? Kind::Scene : Kind::Paint, Bytes(size_t{i} * 7, i));
    std::mt19937 random(5);
    MessageReader reader;
    std::string error;
    uint32_t came = 0;
    for (size_t at = 0; at < stream.size();) {
        const size_t size = std::min<size_t>(1 + random() % 90, stream.size() - at);
        reader.feed({stream.data() + at, size});
        at += size;
        for (Message message; reader.next(message, error); ++came) {
            EXPECT_EQ(came % 2 ? Kind::Scene : Kind::Paint, message.kind);
            EXPECT_EQ(Bytes(size_t{came} * 7, uint8_t(came)), message.body);
        }
    }
    EXPECT_EQ("", error);
    EXPECT_EQ(40u, came);
}

TEST(EditorLink, InvalidMessagesAreRefused) {
    Bytes good;
    fwlink::appendMessage(good, Kind::Scene, Bytes{1, 2, 3});
    const auto refused = [&](size_t at, uint8_t value) {
        Bytes spoilt = good;
        spoilt[at] = value;
        MessageReader reader;
        reader.feed(spoilt);
        Message message;
        std::string error, later;
        EXPECT_FALSE(reader.next(message, error));
        reader.feed(good);  // nothing is accepted after that
        EXPECT_FALSE(reader.next(message, later));
        return error;
    };
    EXPECT_THAT(refused(0, 'G'), HasSubstr("not a message of a live link"));
    EXPECT_THAT(refused(4, 9), HasSubstr("speaks version 9, this one 1"));
    EXPECT_THAT(refused(6, 77), HasSubstr("kind 77; there are 3"));
    EXPECT_THAT(refused(11, 0x7f), HasSubstr("it may have 33554432"));
    EXPECT_THAT(refused(17, 9), HasSubstr("came damaged"));
}

// All messages of an editor about a scene with paint.
std::vector<Message> messagesOf(const Document& document, SceneSender& sender, Listener& listener,
                                Channel& channel) {
    std::string error;
    if (!sender.connected()) {
        EXPECT_TRUE(sender.connect(listener.port(), error)) << error;
        EXPECT_TRUE(soon([&] {
            if (!channel.open()) channel = listener.accept();
            return channel.open();
        }));
    }
    std::vector<Message> messages;
    EXPECT_TRUE(soon([&] {
        sender.follow(document);
        channel.pump();
        for (Message message; channel.next(message);) messages.push_back(message);
        return !messages.empty() && messages.back().kind == Kind::Scene;
    }));
    return messages;
}

TEST(EditorLink, SendsOnlyChangedTiles) {
    Yard yard;
    yard.run(kPainted);
    Document& document = yard.host->document;
    Listener listener;
    std::string error;
    ASSERT_TRUE(listener.listen(0, error)) << error;
    SceneSender sender;
    Channel channel;
    SceneReader reader;
    bool whole = false;
    const auto take = [&](const std::vector<Message>& messages) {
        for (const Message& message : messages)
            EXPECT_TRUE(reader.take(message, whole, error)) << error;
        EXPECT_TRUE(whole);
        EXPECT_EQ(document.scene, reader.scene().scene);
        EXPECT_EQ(document.images, reader.scene().images);
        EXPECT_EQ(yard.folder, reader.scene().folder);
    };
    yard.run("fill Belt value 0.5\n");
    const auto first = messagesOf(document, sender, listener, channel);
    ASSERT_EQ(2u, first.size());
    take(first);
    // A dab touches one of three tiles; a change without paint sends none.
    yard.run("stroke Belt value 0 size 0.02 path 0:0.2:0.01 0.02:0.2:0.01\n");
    const auto second = messagesOf(document, sender, listener, channel);
    ASSERT_EQ(2u, second.size());
    EXPECT_LT(second[0].body.size(), first[0].body.size() / 2);
    take(second);
    yard.run("set settings wind 3 0 0\n");
    const auto third = messagesOf(document, sender, listener, channel);
    EXPECT_EQ(1u, third.size());
    take(third);
    yard.run("undo 2\n");
    take(messagesOf(document, sender, listener, channel));
    yard.run("undo\n");  // the fill: the layer exists with nothing painted
    EXPECT_TRUE(document.images.empty());
    take(messagesOf(document, sender, listener, channel));
    yard.run("remove Belt\n");
    take(messagesOf(document, sender, listener, channel));
    EXPECT_TRUE(reader.scene().images.empty());
}

TEST(EditorLink, DamagedBodiesAreRefusedOrValid) {
    Yard yard;
    yard.run(kPainted);
    yard.run("fill Belt value 0.5\n");
    Listener listener;
    std::string error;
    ASSERT_TRUE(listener.listen(0, error)) << error;
    SceneSender sender;
    Channel channel;
    const std::vector<Message> good = messagesOf(yard.host->document, sender, listener, channel);
    std::mt19937 random(7);
    uint32_t refused = 0;
    for (int i = 0; i < 10000; ++i) {
        SceneReader reader;
        bool whole = false;
        for (Message message : good) {
            if (message.body.size() > 4096) message.body.resize(4096 + random() % 64);
            for (uint32_t k = random() % 4; k > 0 && !message.body.empty(); --k) {
                const size_t at = random() % std::min<size_t>(message.body.size(), 96);
                message.body[at] = uint8_t(random());
            }
            if (random() % 5 == 0) message.body.resize(random() % (message.body.size() + 1));
            message.kind = Kind(random() % 9 ? uint16_t(message.kind) : random() % 3);
            error.clear();
            if (reader.take(message, whole, error)) continue;
            ++refused;
            EXPECT_FALSE(error.empty());
        }
        for (const auto& [layer, image] : reader.scene().images)
            EXPECT_EQ(size_t{image.width} * image.height, image.flat().size()) << layer;
    }
    EXPECT_GT(refused, 5000u);
}

TEST(EditorLink, ReportsItsSceneAndEitherSideMayLeave) {
    Yard yard;
    yard.run(kPainted);
    auto receiver = std::make_unique<SceneReceiver>();
    std::string error, report;
    ASSERT_TRUE(receiver->listen(0, error)) << error;
    const std::string port = std::to_string(receiver->port());
    LinkedScene scene;
    const auto comes = [&] { return receiver->poll(scene, report); };
    yard.run("link " + port + "\n");
    ASSERT_TRUE(soon(comes));
    EXPECT_EQ(yard.host->document.scene, scene.scene);
    // The artist's lines continue without answers; the latest counts.
    yard.run("set settings wind 1 0 0\nset settings wind 2 0 0\n");
    std::thread sample([&] {
        receiver->took(scene.number, "");
        for (int i = 0; i < 2000 && receiver->connected(); ++i) {
            if (comes()) receiver->took(scene.number, "One mesh is left out");
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    });
    yard.run("link wait\n");
    EXPECT_EQ("One mesh is left out", yard.said.back());
    yard.run("link off\n");
    sample.join();
    EXPECT_FALSE(receiver->connected());
    EXPECT_EQ(2, scene.scene.settings.wind[0]);
    EXPECT_THAT(yard.fails("link wait"), HasSubstr("there is no link"));

    // Another editor connects; then the sample leaves.
    yard.run("link " + port + "\n");
    ASSERT_TRUE(soon(comes));
    receiver = nullptr;
    yard.run("set settings wind 3 0 0\n");
    EXPECT_THAT(yard.fails("link wait"), HasSubstr("disconnected"));
    EXPECT_THAT(yard.fails("link " + port), HasSubstr("Nobody answers on port " + port));
    EXPECT_THAT(yard.fails("link 70000"), HasSubstr("no port from 1 to 65535"));
}

TEST(EditorLink, AStrangerIsDisconnectedAndTheNextIsServed) {
    LinkedYard w;
    std::string said;
    Channel stranger;
    ASSERT_TRUE(stranger.connect(w.receiver.port(), w.error)) << w.error;
    // Neither a browser's request nor an editor-only message is valid here.
    stranger.send(Kind::Taken, Bytes{1, 2, 3});
    EXPECT_TRUE(soon([&] {
        stranger.pump();
        EXPECT_FALSE(w.poll());
        said += w.report;
        return !stranger.open();
    }));
    EXPECT_THAT(said, HasSubstr("a message that is for the editor"));
    w.link();
    EXPECT_TRUE(soon([&] { return w.poll(); }));
}

// A paint message's body of 18 bytes: no tile, for a layer of 4096 x 4096.
Bytes emptyPaint(uint32_t layer) {
    fwlink::BodyWriter body;
    body.number(fwedit::ObjectId{layer});
    body.number(uint32_t{4096});
    body.number(uint32_t{4096});
    body.number(uint8_t{0});
    body.number(uint8_t{0});
    body.number(uint32_t{0});
    return body.body;
}

TEST(EditorLink, PaintWithoutASceneIsLimitedToItsBytes) {
    SceneReader reader;
    bool whole = false;
    std::string error;
    for (uint32_t i = 0; i < fwedit::kMostObjects; ++i)
        ASSERT_TRUE(reader.take({Kind::Paint, emptyPaint(1000 + i)}, whole, error)) << error;
    EXPECT_EQ(fwedit::kMostObjects, reader.layers());
    EXPECT_EQ(0u, reader.paintBytes());  // no tile arrived
    EXPECT_FALSE(reader.take({Kind::Paint, emptyPaint(7)}, whole, error));
    EXPECT_THAT(error, HasSubstr("paint for more than 4000 layers"));
    // Repeated messages for a known layer count once.
    EXPECT_TRUE(reader.take({Kind::Paint, emptyPaint(1000)}, whole, error)) << error;
    // It has no tile table either until a scene names it.
    Yard yard;
    yard.run(kPainted);
    reader = {};
    const auto layer = yard.host->document.scene.layers.at(0).id;
    ASSERT_TRUE(reader.take({Kind::Paint, emptyPaint(layer)}, whole, error)) << error;
    fwlink::BodyWriter scene;
    scene.number(uint64_t{1});
    scene.text("");
    scene.text(fwedit::printScene(yard.host->document.scene));
    ASSERT_TRUE(reader.take({Kind::Scene, scene.body}, whole, error)) << error;
    EXPECT_EQ(1u, reader.layers());
    EXPECT_TRUE(reader.scene().images.empty());
}

TEST(EditorLink, TilesAreLimitedAndFreedTilesNoLongerCount) {
    constexpr uint32_t kTiles = 4096;  // of a layer of 4096 x 4096: 16 MiB
    const auto paint = [](uint32_t layer, bool update, bool there) {
        fwlink::BodyWriter body;
        body.number(fwedit::ObjectId{layer});
        body.number(uint32_t{4096});
        body.number(uint32_t{4096});
        body.number(uint8_t{0});
        body.number(uint8_t(update));
        body.number(kTiles);
        const Bytes tile(4096, 9);
        for (uint32_t i = 0; i < kTiles; ++i) {
            body.number(i);
            body.number(uint8_t(there));
            if (there) body.bytes(tile);
        }
        return Message{Kind::Paint, std::move(body.body)};
    };
    SceneReader reader;
    bool whole = false;
    std::string error;
    const uint32_t layers = uint32_t(SceneReader::kMostPaint >> 24);
    for (uint32_t i = 0; i < layers; ++i)
        ASSERT_TRUE(reader.take(paint(i + 1, false, true), whole, error)) << error;
    EXPECT_EQ(SceneReader::kMostPaint, reader.paintBytes());
    EXPECT_FALSE(reader.take(paint(99, false, true), whole, error));
    EXPECT_THAT(error, HasSubstr("more than 256 MiB of paint"));
    ASSERT_TRUE(reader.take(paint(1, true, false), whole, error)) << error;
    EXPECT_EQ(SceneReader::kMostPaint - (size_t{16} << 20), reader.paintBytes());
    EXPECT_TRUE(reader.take(paint(99, false, true), whole, error)) << error;
}

TEST(EditorLink, SilentClientsBlockNobodyAndTheLastSceneWins) {
    LinkedYard w;
    std::vector<Channel> silent(3 * SceneReceiver::kMostCallers);
    for (Channel& channel : silent) {
        ASSERT_TRUE(channel.connect(w.receiver.port(), w.error)) << w.error;
        EXPECT_FALSE(w.poll()) << w.report;
    }
    EXPECT_FALSE(w.receiver.connected());
    w.link();
    ASSERT_TRUE(soon([&] { return w.poll(); })) << w.report;
    EXPECT_TRUE(w.receiver.connected());
    // An editor that hangs is replaced by the next that sends a scene.
    Yard other;
    other.run(kPainted);
    other.run("set settings wind 7 0 0\nlink " + std::to_string(w.receiver.port()) + "\n");
    ASSERT_TRUE(soon([&] { return w.poll(); })) << w.report;
    EXPECT_THAT(w.report, HasSubstr("Another editor has taken over the link"));
    EXPECT_EQ(7, w.scene.scene.settings.wind[0]);
}

TEST(EditorLink, AnEditorThatReadsNoAnswersIsDropped) {
    LinkedYard w;
    w.link();
    ASSERT_TRUE(soon([&] { return w.poll(); })) << w.report;
    const std::string answer(60000, 'a');
    for (int i = 0; i < 1000 && w.receiver.connected(); ++i)
        w.receiver.took(w.scene.number, answer);
    EXPECT_FALSE(w.receiver.connected());
}

TEST(EditorLink, InvalidAnswersEndTheLinkWithAMessage) {
    for (const bool isLong : {true, false}) {
        Yard yard;
        yard.run(kPainted);
        Listener listener;
        std::string error;
        ASSERT_TRUE(listener.listen(0, error)) << error;
        SceneSender sender;
        Channel channel;
        (void)messagesOf(yard.host->document, sender, listener, channel);
        fwlink::BodyWriter body;
        body.number(uint64_t{isLong ? 1u : 77u});
        body.text(std::string(isLong ? 100000 : 1, 'a'));
        channel.send(Kind::Taken, body.body);
        EXPECT_TRUE(soon([&] {
            channel.pump();
            sender.follow(yard.host->document);
            return !sender.connected();
        }));
        EXPECT_THAT(sender.problem(), HasSubstr("65536 bytes"));
    }
}

// ---- burns of a linked sample

std::string hashOf(Burn& burn) {
    std::vector<std::string> lines;
    requestHashes(burn);
    EXPECT_EQ(FW_OK, fwWorld_Step(burn.world, 0));
    EXPECT_EQ(FW_OK, fetchHashes(burn, lines));
    return lines.empty() ? "" : lines[0];
}

TEST(EditorBurn, ContinuesAChangedSceneAsIfItHadAlwaysBeenSo) {
    Yard yard;
    yard.run(kBoard);
    std::string error;
    ASSERT_TRUE(burnToPlayhead(*yard.host, yard.host->cpu(error), error)) << error;
    Burn& burn = *yard.host->burn;
    const auto revise = [&] { return reviseBurn(burn, yard.host->document.scene, yard.folder); };
    ASSERT_TRUE(runBurn(burn, 1, error)) << error;
    // Later events: a second match, and water ahead of the first fire.
    yard.run(
        "add source match name=Later position 0.4 0.2 0 radius 0.04 start 2\n"
        "add source water position 0 0.2 0 radius 0.3 output 0.2 start 2\n"
        "add flame camp name=Campfire position 0 0 3\nadd collider box position 0 0 6\n"
        "add emitter disc position 0 0 4\nadd wind velocity 1 0 0 start 50\n");
    ASSERT_TRUE(revise());
    EXPECT_EQ(6u, burn.parts.size());
    yard.run("set Campfire power 200 position 0 0 3.5\nset Match name Struck\n");
    ASSERT_TRUE(revise());
    yard.run("set Campfire diameter 1 outline 0:0.7 1:0.05 stops 0:900 1:1500\n");
    ASSERT_TRUE(revise());
    yard.run("set Campfire stops 0:1000 1:1500\n");
    ASSERT_TRUE(revise());
    EXPECT_EQ(6u, burn.parts.size());
    ASSERT_TRUE(runBurn(burn, 6, error)) << error;
    auto rebuilt = createBurn(yard.host->cpu(error), yard.host->document.scene, {}, yard.folder,
                              yard.host->assets, error);
    ASSERT_TRUE(rebuilt && runBurn(*rebuilt, 6, error)) << error;
    EXPECT_EQ(hashOf(*rebuilt), hashOf(burn));

    // Properties that a burn was created with cannot change.
    for (const char* line :
         {"set Board moisture 0.4", "set settings pace 30", "set Struck position 0 0 0",
          "add layer multiplier mesh Board", "remove Board"}) {
        yard.run(std::string(line) + "\n");
        EXPECT_FALSE(revise()) << line;
        yard.run("undo\n");
    }
    yard.run("set Board position 0 0 1\nset settings daylight night\nset Later start 9\n");
    EXPECT_FALSE(revise());  // that match was struck at 2 s
    yard.run("undo\n");
    EXPECT_TRUE(revise());
    yard.run("remove Campfire\n");
    EXPECT_TRUE(revise());
    EXPECT_EQ(5u, burn.parts.size());
}

}  // namespace
