#include "net/transfer.h"

#include "core/assert.h"

#include <algorithm>
#include <bit>

namespace fw::net {
namespace {

constexpr double kNeverSent = -1e9;

// A head's fields, written or read: the order is that of the packet.
template <class Stream, class Head>
void eachOf(Stream& stream, Head& head) {
    stream.numbers(head.state.id, head.state.step, head.state.record, head.state.size, head.index,
                   head.bytes);
}

}  // namespace

void writeChunk(core::Writer& writer, const ChunkHead& head, std::span<const std::byte> state) {
    eachOf(writer, head);
    const size_t from = size_t(head.index) * head.bytes;
    FW_ASSERT(from < state.size(), "piece %u of %zu bytes", head.index, state.size());
    const auto piece = state.subspan(from, std::min<size_t>(head.bytes, state.size() - from));
    writer.bytes().insert(writer.bytes().end(), piece.begin(), piece.end());
}

std::span<const std::byte> readChunk(core::Reader& reader, ChunkHead& head) {
    eachOf(reader, head);
    const uint64_t from = uint64_t(head.index) * head.bytes;
    if (head.state.id == 0 || head.state.size == 0 || head.state.size > kMaxState ||
        head.bytes < kMinChunk || from >= head.state.size ||
        reader.left() != std::min<uint64_t>(head.bytes, head.state.size - from))
        core::failData("The packet has piece %u, %zu of %u bytes, of a state of %u bytes.",
                       head.index, reader.left(), uint32_t(head.bytes), head.state.size);
    return reader.take(reader.left());
}

void ChunkSender::begin(uint32_t count) noexcept {
    count_ = count;
    base_ = sentEnd_ = 0;
    came_ = 0;
    sentAt_.fill(kNeverSent);
}

bool ChunkSender::canHave(uint32_t base, uint64_t came) const noexcept {
    if (base > sentEnd_) return false;
    const uint32_t rest = sentEnd_ - base;
    return rest >= 64 || (came >> rest) == 0;
}

void ChunkSender::acknowledge(uint32_t base, uint64_t came, uint32_t answered) noexcept {
    if (base < base_) return;  // an old one says less
    for (uint32_t piece = base_; piece < std::min(base, base_ + kChunkWindow); ++piece)
        sentAt_[piece % kChunkWindow] = kNeverSent;  // its place is another's now
    came_ = base == base_ ? came_ | came : came;
    base_ = base;
    for (uint32_t piece = base_; piece < std::min(sentEnd_, base_ + kChunkWindow); ++piece)
        if ((came_ >> (piece - base_) & 1) == 0 && sentIn_[piece % kChunkWindow] < answered)
            sentAt_[piece % kChunkWindow] = kNeverSent;
}

uint32_t ChunkSender::next(double now, double after) const noexcept {
    FW_ASSERT(base_ <= sentEnd_ && sentEnd_ <= count_, "%u, %u of %u pieces", base_, sentEnd_,
              count_);
    const uint32_t end = std::min(count_, base_ + kChunkWindow);
    for (uint32_t piece = base_; piece < end; ++piece)
        if ((came_ >> (piece - base_) & 1) == 0 && now - sentAt_[piece % kChunkWindow] >= after)
            return piece;
    return count_;
}

void ChunkReceiver::forget() noexcept {
    state_ = {};
    count_ = base_ = 0;
    came_ = 0;
    bytes_.clear();
}

bool ChunkReceiver::take(const ChunkHead& head, std::span<const std::byte> piece, bool newest) {
    if (head.state.id != state_.id) {
        if (state_.id != 0 && !newest) return true;  // of one before
        forget();
        state_ = head.state;
        chunkBytes_ = head.bytes;
        count_ = (head.state.size + head.bytes - 1) / head.bytes;
    }
    if (head.bytes != chunkBytes_ || head.state.size != state_.size ||
        head.state.step != state_.step || head.state.record != state_.record)
        return false;
    if (head.index < base_ || head.index - base_ >= kChunkWindow) return true;
    FW_ASSERT(head.index < count_, "piece %u of %u", head.index, count_);
    // Room grows with what comes, not with what is claimed.
    const size_t from = size_t(head.index) * chunkBytes_;
    if (bytes_.size() < from + piece.size()) bytes_.resize(from + piece.size());
    std::copy(piece.begin(), piece.end(), bytes_.begin() + std::ptrdiff_t(from));
    came_ |= uint64_t(1) << (head.index - base_);
    const auto run = uint32_t(std::countr_one(came_));
    base_ += run;
    came_ = run < 64 ? came_ >> run : 0;
    return true;
}

}  // namespace fw::net
