// Packets and their parts: heads with a checksum, the window of received numbers, records that
// round-trip, and states in pieces over a lossy link.
#include "net/packet.h"
#include "net/protocol.h"
#include "net/records.h"
#include "net/round_trip.h"
#include "net/transfer.h"

#include <gtest/gtest.h>

#include <random>

namespace {

using namespace fw;
using Bytes = std::pmr::vector<std::byte>;

TEST(NetPacket, DetectsAnyFlippedBit) {
    Bytes packet;
    core::Writer writer = net::beginPacket(packet, {net::PacketKind::status, 7, 8, 9});
    writer.number(uint64_t(0x1234567890ABCDEF));
    net::sealPacket(packet);
    core::Reader reader(packet, "packet");
    const net::PacketHead head = net::openPacket(packet, reader);
    EXPECT_EQ(net::PacketKind::status, head.kind);
    EXPECT_EQ(7u, head.session);
    EXPECT_EQ(8u, head.client);
    EXPECT_EQ(9u, head.sequence);
    EXPECT_EQ(8u, reader.left());
    for (size_t bit = 0; bit < packet.size() * 8; ++bit) {
        Bytes wrong = packet;
        wrong[bit / 8] ^= std::byte(1u << (bit % 8));
        core::Reader other(wrong, "packet");
        EXPECT_THROW((void)net::openPacket(wrong, other), core::Error) << bit;
    }
}

TEST(NetPacket, ReportsReceivedPackets) {
    net::SequenceWindow window;
    EXPECT_FALSE(window.isNew(0));
    EXPECT_FALSE(window.isNew(1u << 20));  // more than can be lost
    for (const uint32_t sequence : {3u, 1u, 70u, 69u}) {
        EXPECT_TRUE(window.isNew(sequence)) << sequence;
        EXPECT_EQ(sequence == 3 || sequence == 70, window.take(sequence));
        EXPECT_FALSE(window.isNew(sequence)) << sequence;
    }
    EXPECT_FALSE(window.isNew(2));  // too old to know
    EXPECT_TRUE(window.isNew(68));
    EXPECT_TRUE(window.isNew(71));
}

template <uint32_t... I>
world::Command ofKind(uint32_t kind, std::integer_sequence<uint32_t, I...>) {
    world::Command command;
    ((kind == I ? void(command.emplace<I>()) : void()), ...);
    return command;
}
world::Command commandOf(uint32_t i) {
    if (i % 2 == 0) {
        world::IgniteTexels command{i, {FW_WET, 3 * i, 20}, {}};
        for (const uint32_t texel : {i, i + 1, i + 7}) EXPECT_TRUE(command.texels.add(texel));
        return command;
    }
    return ofKind(i % world::kCommandKinds,
                  std::make_integer_sequence<uint32_t, world::kCommandKinds>());
}

TEST(NetRecords, RoundTrip) {
    net::RecordLog log(std::pmr::get_default_resource());
    for (uint32_t i = 0; i < 500; ++i) {
        net::Record record;
        record.step = i;
        record.kind = i % 3 == 0   ? net::RecordKind::hashes
                      : i % 3 == 1 ? net::RecordKind::command
                                   : net::RecordKind::capture;
        record.command = commandOf(i);
        record.tick = 1000 + i;
        record.stride = 16;
        record.hashCount = i % 5;
        record.hashes.fill(i);
        log.push(record, i);
        if (i % 7 == 6) log.dropBefore(i - 5, i);
    }
    EXPECT_EQ(500u, log.end());
    for (uint32_t i = log.begin(); i < log.end(); ++i) {
        net::Record record;
        net::readRecord(log.at(i), record);
        EXPECT_EQ(i, record.step);
        if (record.kind == net::RecordKind::command) {
            EXPECT_EQ(commandOf(i).index(), record.command.index());
            Bytes expected, found;
            world::writeCommand(commandOf(i), expected);
            world::writeCommand(record.command, found);
            EXPECT_EQ(expected, found);
        } else {
            EXPECT_EQ(1000 + i, record.tick);
            EXPECT_EQ(record.kind == net::RecordKind::hashes ? i % 5 : 0, record.hashCount);
        }
    }
    log.dropBefore(log.end(), log.end());
    EXPECT_EQ(0u, log.bytes());
    net::Record record;
    const Bytes cut(5);
    EXPECT_THROW(net::readRecord(cut, record), core::Error);
}

// A fifth of pieces and answers is lost; the state still arrives completely.
TEST(NetTransfer, ReassemblesAState) {
    std::mt19937 random(4);
    Bytes state(150000);
    for (std::byte& b : state) b = std::byte(random());
    constexpr uint16_t kPiece = 1150;
    const auto count = uint32_t((state.size() + kPiece - 1) / kPiece);
    net::ChunkSender sender;
    sender.begin(count);
    net::ChunkReceiver receiver(std::pmr::get_default_resource());
    uint32_t sent = 0;
    for (double now = 0; now < 30 && !receiver.whole(); now += 0.05) {
        for (int i = 0; i < 16; ++i) {
            const uint32_t piece = sender.next(now, 0.25);
            if (piece == sender.count()) break;
            sender.sent(piece, now, sent);
            ++sent;
            if (random() % 5 == 0) continue;
            Bytes packet;
            core::Writer writer(packet);
            net::writeChunk(writer, {{2, 10, 20, uint32_t(state.size())}, piece, kPiece}, state);
            core::Reader reader(packet, "packet");
            net::ChunkHead head;
            const std::span<const std::byte> bytes = net::readChunk(reader, head);
            EXPECT_TRUE(receiver.take(head, bytes, true));
        }
        if (random() % 5 != 0) {
            EXPECT_TRUE(sender.canHave(receiver.base(), receiver.came()));
            sender.acknowledge(receiver.base(), receiver.came(), 0);
        }
    }
    ASSERT_TRUE(receiver.whole());
    EXPECT_TRUE(std::equal(state.begin(), state.end(), receiver.bytes().begin()));
    EXPECT_LT(sent, 2 * count);
    EXPECT_FALSE(sender.canHave(count + 1, 0));
}

// Only pieces that were sent can be acknowledged.
TEST(NetTransfer, RefusesAcknowledgementsOfUnsentPieces) {
    net::ChunkSender sender;
    sender.begin(100);
    EXPECT_TRUE(sender.canHave(0, 0));
    EXPECT_FALSE(sender.canHave(1, 0));
    EXPECT_FALSE(sender.canHave(0, 1));
    for (uint32_t piece = 0; piece < 5; ++piece) sender.sent(piece, 0, 10 + piece);
    EXPECT_TRUE(sender.canHave(0, 0x1F));
    EXPECT_TRUE(sender.canHave(2, 0x7));
    EXPECT_TRUE(sender.canHave(5, 0));
    EXPECT_FALSE(sender.canHave(2, 0x8));
    EXPECT_FALSE(sender.canHave(6, 0));
    EXPECT_FALSE(sender.canHave(0xFFFFFFFFu, 0));
    // Pieces 0 and 2 did not arrive; packets before number 12 are settled.
    EXPECT_EQ(5u, sender.next(0.1, 1));
    sender.acknowledge(0, 0x1A, 12);
    EXPECT_EQ(0u, sender.next(0.1, 1));
    sender.sent(0, 0.1, 15);
    EXPECT_EQ(5u, sender.next(0.2, 1));
    sender.acknowledge(0, 0x1A, 13);
    EXPECT_EQ(2u, sender.next(0.2, 1));
}

net::Record captureAt(uint64_t tick) {
    net::Record record;
    record.kind = net::RecordKind::capture;
    record.tick = tick;
    return record;
}
net::Record messageOf(std::span<const std::byte> text) {
    net::Record record;
    record.kind = net::RecordKind::message;
    record.message = text;
    return record;
}

// A client that gets a state instead of records still gets each message between them.
TEST(NetRecords, MessagesOutliveTheRecordsAroundThem) {
    net::RecordLog log(std::pmr::get_default_resource());
    const Bytes text(3);
    const net::Record capture = captureAt(1);
    for (uint32_t i = 0; i < 1000; ++i) log.push(i % 100 == 50 ? messageOf(text) : capture, i);
    const auto walk = [&](uint32_t from, uint32_t skipsBefore) {
        std::vector<uint32_t> messages;
        for (uint32_t at = from; at < log.end();) {
            const net::RecordLog::Entry entry = log.entryAt(at, skipsBefore);
            EXPECT_GT(entry.count, 0u);
            if (!entry.bytes.empty()) {
                EXPECT_EQ(1u, entry.count);
                net::Record record;
                net::readRecord(entry.bytes, record);
                if (record.kind == net::RecordKind::message) messages.push_back(at);
            }
            at += entry.count;
        }
        return messages;
    };
    const std::vector<uint32_t> all = {50, 150, 250, 350, 450, 550, 650, 750, 850, 950};
    EXPECT_EQ(all, walk(0, 0));
    EXPECT_EQ(all, walk(0, 1000));
    log.dropBefore(700, 200);
    EXPECT_EQ(700u, log.begin());
    EXPECT_EQ((std::vector<uint32_t>{250, 350, 450, 550, 650, 750, 850, 950}), walk(0, 0));
    EXPECT_EQ((std::vector<uint32_t>{450, 550, 650, 750, 850, 950}), walk(450, 800));
    log.dropMessagesBefore(500);
    EXPECT_EQ((std::vector<uint32_t>{550, 650, 750, 850, 950}), walk(0, 0));
    EXPECT_EQ(550u, log.dropOldestMessage());
    log.dropBefore(1000, 900);
    EXPECT_EQ((std::vector<uint32_t>{650, 950}), walk(0, 0));
    EXPECT_EQ(0u, log.bytes());
}

TEST(NetRecords, CountBytesAndRecordsThatAStateReplaces) {
    net::RecordLog log(std::pmr::get_default_resource());
    const Bytes text(10);
    const net::Record capture = captureAt(1);
    for (uint32_t i = 0; i < 10; ++i) log.push(i == 4 ? messageOf(text) : capture, 0.5 * i);
    EXPECT_EQ(9u * 14 + 16, log.bytes());
    EXPECT_EQ(6u * 14 + 16, log.bytesFrom(3));
    EXPECT_EQ(6u * 14, log.skippableFrom(3));
    EXPECT_EQ(1.5, log.pushedAt(3));
    EXPECT_EQ(8u, log.recordBeforeLast(28));
    EXPECT_EQ(9u, log.recordBeforeLast(27));
    EXPECT_EQ(10u, log.recordBeforeLast(0));
    EXPECT_EQ(0u, log.recordBeforeLast(10000));
    log.dropBefore(5, 10);
    EXPECT_EQ(5u, log.recordBeforeLast(10000));
    EXPECT_EQ(5u * 14, log.bytes());
}

// The table is the protocol: phases that send records have a state, and each phase that receives or
// waits can fall back.
TEST(NetProtocol, TransitionsLeadToDefinedPhases) {
    using net::PeerEvent, net::PeerPhase;
    for (uint32_t i = 0; i < uint32_t(PeerPhase::count); ++i) {
        const auto phase = PeerPhase(i);
        const net::PeerRule& rule = net::ruleOf(phase);
        EXPECT_FALSE(rule.waits && rule.takes) << rule.name;
        EXPECT_NE(net::kRefused, net::phaseAfter(phase, PeerEvent::greets)) << rule.name;
        const PeerPhase fallen = net::phaseAfter(phase, PeerEvent::falls);
        ASSERT_NE(net::kRefused, fallen) << rule.name;
        EXPECT_EQ(rule.hasState, net::ruleOf(fallen).hasState) << rule.name;
        EXPECT_FALSE(net::ruleOf(fallen).takes) << rule.name;
        if (rule.waits) {
            EXPECT_NE(net::kRefused, net::phaseAfter(phase, PeerEvent::begins)) << rule.name;
        }
        if (!rule.hasState) {
            EXPECT_EQ(net::kRefused, net::phaseAfter(phase, PeerEvent::requestsTiles)) << rule.name;
        }
    }
    EXPECT_EQ(net::kRefused, net::phaseAfter(PeerPhase::calling, PeerEvent::loads));
}

TEST(NetRoundTrip, FollowsTheDelayAndBacksOff) {
    net::RoundTrip trip;
    EXPECT_EQ(0.5, trip.timeout());
    double now = 0;
    for (uint32_t i = 1; i < 200; ++i, now += 0.1) {
        trip.sent(i, now);
        if (i > 20) trip.answered(i - 20, now);  // 2 s later
    }
    EXPECT_NEAR(2.0, trip.seconds(), 0.2);
    EXPECT_GT(trip.timeout(), trip.seconds());
    EXPECT_LT(trip.timeout(), 3.0);
}

}  // namespace
