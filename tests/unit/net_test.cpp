// What packets are made of: heads that tell damage, numbers that came before, records that come
// back as they were, states in pieces over a way that loses them.
#include "net/packet.h"
#include "net/records.h"
#include "net/transfer.h"

#include <gtest/gtest.h>

#include <random>

namespace {

using namespace fw;
using Bytes = std::pmr::vector<std::byte>;

TEST(NetPacket, AnyFlippedBitIsFound) {
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

TEST(NetPacket, WhatCameIsKnown) {
    net::SequenceWindow window;
    EXPECT_FALSE(window.isNew(0));
    EXPECT_FALSE(window.isNew(1u << 20));  // nobody loses so many
    for (const uint32_t sequence : {3u, 1u, 70u, 69u}) {
        EXPECT_TRUE(window.isNew(sequence)) << sequence;
        EXPECT_EQ(sequence == 3 || sequence == 70, window.take(sequence));
        EXPECT_FALSE(window.isNew(sequence)) << sequence;
    }
    EXPECT_FALSE(window.isNew(2));  // too old to tell
    EXPECT_TRUE(window.isNew(68));
    EXPECT_TRUE(window.isNew(71));
}

TEST(NetRecords, ComeBackAsTheyWere) {
    net::RecordLog log(std::pmr::get_default_resource());
    for (uint32_t i = 0; i < 500; ++i) {
        net::Record record;
        record.step = i;
        record.kind = i % 3 == 0   ? net::RecordKind::hashes
                      : i % 3 == 1 ? net::RecordKind::deed
                                   : net::RecordKind::capture;
        record.deed.kind = world::Deed::Kind(i % uint32_t(world::Deed::Kind::count));
        record.deed.slot = i;
        record.deed.numbers.fill(float(i));
        record.tick = 1000 + i;
        record.stride = 16;
        record.hashCount = i % 5;
        record.hashes.fill(i);
        log.push(record);
        if (i % 7 == 6) log.dropBefore(i - 5);
    }
    EXPECT_EQ(500u, log.end());
    for (uint32_t i = log.begin(); i < log.end(); ++i) {
        net::Record record;
        net::readRecord(log.at(i), record);
        EXPECT_EQ(i, record.step);
        if (record.kind == net::RecordKind::deed) {
            EXPECT_EQ(world::Deed::Kind(i % uint32_t(world::Deed::Kind::count)), record.deed.kind);
            EXPECT_TRUE(record.deed.numbers[0] == float(i) ||
                        record.deed.kind == world::Deed::Kind::flags);
        } else {
            EXPECT_EQ(1000 + i, record.tick);
            EXPECT_EQ(record.kind == net::RecordKind::hashes ? i % 5 : 0, record.hashCount);
        }
    }
    log.dropBefore(log.end());
    EXPECT_EQ(0u, log.bytes());
    net::Record record;
    const Bytes cut(5);
    EXPECT_THROW(net::readRecord(cut, record), core::Error);
}

// A fifth is lost each way, pieces and answers; the state comes whole.
TEST(NetTransfer, AStateComesWhole) {
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
            const uint32_t piece = sender.next(now);
            if (piece == sender.count()) break;
            sender.sent(piece, now);
            ++sent;
            if (random() % 5 == 0) continue;
            Bytes packet;
            core::Writer writer(packet);
            net::writeChunk(writer, {{2, 10, 20, uint32_t(state.size())}, piece, kPiece}, state);
            core::Reader reader(packet, "packet");
            net::ChunkHead head;
            const std::span<const std::byte> bytes = net::readChunk(reader, head);
            EXPECT_TRUE(receiver.take(head, bytes));
        }
        if (random() % 5 != 0) {
            EXPECT_TRUE(sender.acknowledge(receiver.base(), receiver.came()));
        }
    }
    ASSERT_TRUE(receiver.whole());
    EXPECT_TRUE(std::equal(state.begin(), state.end(), receiver.bytes().begin()));
    EXPECT_LT(sent, 2 * count);
    EXPECT_FALSE(sender.acknowledge(count + 1, 0));
}

}  // namespace
