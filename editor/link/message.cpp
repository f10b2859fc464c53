// See message.h.
#include "link/message.h"

#include <algorithm>

#include "import/content_hash.h"

namespace fwlink {
namespace {

uint32_t checkOf(std::span<const uint8_t> body) {
    fwimport::ContentHash hash;
    hash.add(body.data(), body.size());
    return static_cast<uint32_t>(hash.value ^ hash.value >> 32);
}

}  // namespace

void appendMessage(Bytes& out, Kind kind, std::span<const uint8_t> body) {
    BodyWriter head;
    head.number(kMark);
    head.number(kVersion);
    head.number(static_cast<uint16_t>(kind));
    head.number(static_cast<uint32_t>(body.size()));
    head.number(checkOf(body));
    out.insert(out.end(), head.body.begin(), head.body.end());
    out.insert(out.end(), body.begin(), body.end());
}

void MessageReader::feed(std::span<const uint8_t> bytes) {
    if (broken_) return;
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(at_));
    at_ = 0;
    waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
}

bool MessageReader::next(Message& message, std::string& error) {
    const auto rest = std::span<const uint8_t>(waiting_).subspan(at_);
    if (broken_ || rest.size() < kHeadSize) return false;
    BodyReader head(rest.first(kHeadSize));
    const auto mark = head.number<uint32_t>();
    const auto version = head.number<uint16_t>(), kind = head.number<uint16_t>();
    const auto size = head.number<uint32_t>(), check = head.number<uint32_t>();
    if (mark != kMark)
        error = "the data is not a message of a live link";
    else if (version != kVersion)
        error = "the other side speaks version " + std::to_string(version) + ", this one " +
                std::to_string(kVersion);
    else if (kind >= static_cast<uint16_t>(Kind::Count))
        error = "message of kind " + std::to_string(kind) + "; there are " +
                std::to_string(static_cast<uint16_t>(Kind::Count));
    else if (size > kMostBody)
        error = "a message of " + std::to_string(size) + " bytes; it may have " +
                std::to_string(kMostBody);
    broken_ = !error.empty();
    if (broken_ || rest.size() - kHeadSize < size) return false;
    const auto body = rest.subspan(kHeadSize, size);
    if (checkOf(body) != check) {
        error = "a message of " + std::to_string(size) + " bytes came damaged";
        broken_ = true;
        return false;
    }
    message.kind = static_cast<Kind>(kind);
    message.body.assign(body.begin(), body.end());
    at_ += kHeadSize + size;
    return true;
}

}  // namespace fwlink
