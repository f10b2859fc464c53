#include "net/records.h"

#include "core/assert.h"

#include <algorithm>

namespace fw::net {

uint32_t RecordRuns::pastRun(uint32_t record) const noexcept {
    FW_ASSERT(count <= list.size(), "%u runs", uint32_t(count));
    const auto end = list.begin() + count;
    const auto run =
        std::find_if(list.begin(), end, [&](const RecordRun& one) { return record < one.end; });
    return run != end && run->first <= record ? run->end : record;
}

void writeRecord(const Record& record, std::pmr::vector<std::byte>& out) {
    core::Writer writer(out);
    FW_ASSERT(record.hashCount <= record.hashes.size() && record.message.size() <= kMaxMessage,
              "%u hashes, %zu bytes", record.hashCount, record.message.size());
    const bool isCommand = record.kind == RecordKind::command;
    const auto command = uint32_t(isCommand ? record.command.index() : 0);
    writer.numbers(uint16_t(uint32_t(record.kind) | command << 8), record.step);
    if (isCommand) {
        world::writeCommand(record.command, out);
    } else if (record.kind == RecordKind::hashes) {
        writer.numbers(record.tick, record.first, record.stride);
        for (uint32_t i = 0; i < record.hashCount; ++i) writer.number(record.hashes[i]);
    } else if (record.kind == RecordKind::message) {
        out.insert(out.end(), record.message.begin(), record.message.end());
    } else {
        writer.number(record.tick);
    }
}

void readRecord(std::span<const std::byte> bytes, Record& record) {
    core::Reader reader(bytes, "packet");
    uint16_t head = 0;
    reader.numbers(head, record.step);
    const uint32_t kind = head & 0xFF, command = head >> 8;
    const bool isCommand = kind == uint32_t(RecordKind::command);
    if (kind >= uint32_t(RecordKind::count) || (!isCommand && command != 0))
        core::failData("The packet has a record of kind %u, %u.", kind, command);
    record.kind = RecordKind(kind);
    if (isCommand) {
        world::readCommand(command, reader.take(reader.left()), record.command);
    } else if (record.kind == RecordKind::hashes) {
        reader.numbers(record.tick, record.first, record.stride);
        record.hashCount = uint32_t(reader.left() / sizeof(uint64_t));
        if (record.hashCount > record.hashes.size() || record.stride == 0)
            core::failData("The packet has %u hashes of every %u objects.", record.hashCount,
                           record.stride);
        for (uint32_t i = 0; i < record.hashCount; ++i) reader.number(record.hashes[i]);
    } else if (record.kind == RecordKind::message) {
        if (reader.left() > kMaxMessage)
            core::failData("The packet has a message of %zu bytes; the limit is %u.", reader.left(),
                           kMaxMessage);
        record.message = reader.take(reader.left());
    } else {
        reader.number(record.tick);
        if (record.tick == 0 || record.tick > 0xFFFFFFFFu)
            core::failData("The packet has a record of kind %u and number %llu.", kind,
                           static_cast<unsigned long long>(record.tick));
    }
    endPacket(reader, "a record");
}

uint32_t RecordLog::recordBeforeLast(size_t most) const noexcept {
    const size_t from = bytes_.size() - std::min(most, bytes());
    const auto after = std::upper_bound(marks_.begin() + std::ptrdiff_t(gone_), marks_.end(), from,
                                        [](size_t at, const Mark& mark) { return at < mark.end; });
    const auto before = uint32_t(after - marks_.begin()) - uint32_t(gone_);
    const bool begins = markBefore(first_ + before).end >= from;
    return first_ + before + (begins || after == marks_.end() ? 0 : 1);
}

void RecordLog::push(const Record& record, double now) {
    const size_t before = bytes_.size();
    if (marks_.size() == marks_.capacity()) marks_.reserve(2 * marks_.size() + 64);
    try {
        writeRecord(record, bytes_);
    } catch (...) {
        bytes_.resize(before);
        throw;
    }
    Mark mark = markBefore(end());
    if (record.kind != RecordKind::message) mark.skippable += bytes_.size() - before;
    mark.end = bytes_.size();
    mark.at = now;
    marks_.push_back(mark);
}

void RecordLog::dropBefore(uint32_t record, uint32_t messagesFrom) {
    FW_ASSERT(record <= end(), "record %u of %u", record, end());
    for (; first_ < record; ++first_, ++gone_) {
        if (first_ < messagesFrom || !isMessage(first_)) continue;
        const std::span<const std::byte> bytes = at(first_);
        kept_.push_back({first_, {bytes.begin(), bytes.end(), kept_.get_allocator()}});
        keptBytes_ += bytes.size();
    }
    // Room is made now and then.
    if (gone_ < 64 || gone_ * 2 < marks_.size()) return;
    const Mark from = marks_[gone_ - 1];
    bytes_.erase(bytes_.begin(), bytes_.begin() + std::ptrdiff_t(from.end));
    marks_.erase(marks_.begin(), marks_.begin() + std::ptrdiff_t(gone_));
    for (Mark& mark : marks_) {
        mark.end -= from.end;
        mark.skippable -= from.skippable;
    }
    gone_ = 0;
}

void RecordLog::dropMessagesBefore(uint32_t record) noexcept {
    while (!kept_.empty() && kept_.front().record < record) (void)dropOldestMessage();
}

uint32_t RecordLog::dropOldestMessage() noexcept {
    FW_ASSERT(!kept_.empty() && keptBytes_ >= kept_.front().bytes.size());
    const uint32_t record = kept_.front().record;
    keptBytes_ -= kept_.front().bytes.size();
    kept_.pop_front();
    return record;
}

RecordLog::Entry RecordLog::entryAt(uint32_t record, uint32_t skipsBefore) const noexcept {
    FW_ASSERT(record < this->end(), "record %u of %u", record, this->end());
    constexpr uint32_t kMaxScanned = 4096;
    uint32_t end = record;
    if (record < first_) {
        const auto next =
            std::lower_bound(kept_.begin(), kept_.end(), record,
                             [](const Kept& kept, uint32_t at) { return kept.record < at; });
        if (next != kept_.end() && next->record == record) return {next->bytes, 1};
        end = next != kept_.end() ? next->record : first_;
        if (end < first_) return {{}, end - record};
    }
    for (uint32_t i = 0; i < kMaxScanned && end < std::min(skipsBefore, this->end()); ++i, ++end)
        if (isMessage(end)) break;
    if (end == record) return {at(record), 1};
    return {{}, end - record};
}

}  // namespace fw::net
