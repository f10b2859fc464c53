#include "net/records.h"

#include <algorithm>

namespace fw::net {
namespace {

using Kind = world::Deed::Kind;

}  // namespace

void writeRecord(const Record& record, std::pmr::vector<std::byte>& out) {
    core::Writer writer(out);
    const uint32_t what = record.kind == RecordKind::deed ? uint32_t(record.deed.kind) : 0;
    writer.number(uint16_t(uint32_t(record.kind) | what << 8));
    writer.number(record.step);
    if (record.kind == RecordKind::deed) {
        world::putDeed(writer, record.deed);
    } else if (record.kind == RecordKind::hashes) {
        writer.number(record.tick);
        writer.number(record.first);
        writer.number(record.stride);
        for (uint32_t i = 0; i < record.hashCount; ++i) writer.number(record.hashes[i]);
    } else if (record.kind == RecordKind::capture) {
        writer.number(record.tick);
    } else {
        out.insert(out.end(), record.message.begin(), record.message.end());
    }
}

void readRecord(std::span<const std::byte> bytes, Record& record) {
    core::Reader reader(bytes, "record");
    uint16_t head = 0;
    reader.number(head);
    reader.number(record.step);
    const uint32_t kind = head & 0xFF, what = head >> 8;
    const bool isDeed = kind == uint32_t(RecordKind::deed);
    if (kind >= uint32_t(RecordKind::count) || (isDeed ? what >= uint32_t(Kind::count) : what != 0))
        core::fail(FW_ERROR_BAD_DATA, "The packet has a record of kind %u, %u.", kind, what);
    record.kind = RecordKind(kind);
    if (isDeed) {
        record.deed = {};
        record.deed.kind = Kind(what);
        world::putDeed(reader, record.deed);
    } else if (record.kind == RecordKind::hashes) {
        reader.number(record.tick);
        reader.number(record.first);
        reader.number(record.stride);
        const size_t count = reader.left() / sizeof(uint64_t);
        if (count > record.hashes.size() || record.stride == 0)
            core::fail(FW_ERROR_BAD_DATA, "The packet has %zu hashes of every %u objects.", count,
                       record.stride);
        record.hashCount = uint32_t(count);
        for (size_t i = 0; i < count; ++i) reader.number(record.hashes[i]);
    } else if (record.kind == RecordKind::capture) {
        reader.number(record.tick);
    } else {
        if (reader.left() > kMessageMost)
            core::fail(FW_ERROR_BAD_DATA, "The packet has a message of %zu bytes; the limit is %u.",
                       reader.left(), kMessageMost);
        record.message = reader.take(reader.left());
    }
    if (reader.left() != 0)
        core::fail(FW_ERROR_BAD_DATA, "%zu bytes follow a record of the packet.", reader.left());
}

void RecordLog::push(const Record& record) {
    const size_t before = bytes_.size();
    if (ends_.size() == ends_.capacity()) ends_.reserve(2 * ends_.size() + 64);
    try {
        writeRecord(record, bytes_);
    } catch (...) {
        bytes_.resize(before);
        throw;
    }
    ends_.push_back(bytes_.size());
}

void RecordLog::dropBefore(uint32_t record) noexcept {
    gone_ += record - first_;
    first_ = record;
    // Room is made now and then.
    if (gone_ < 64 || gone_ * 2 < ends_.size()) return;
    const size_t from = ends_[gone_ - 1];
    bytes_.erase(bytes_.begin(), bytes_.begin() + std::ptrdiff_t(from));
    ends_.erase(ends_.begin(), ends_.begin() + std::ptrdiff_t(gone_));
    for (size_t& end : ends_) end -= from;
    gone_ = 0;
}

}  // namespace fw::net
