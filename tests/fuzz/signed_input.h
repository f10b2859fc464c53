// Makes an input's sizes and checksums right, so that its content is read.
#pragma once
#include "abi/net_session.h"
#include "core/hash.h"
#include "fuzz/fuzzer.h"

namespace fuzz {

// The hash of the first `before` bytes and of those from `after` on.
inline uint64_t hashAround(Input bytes, size_t before, size_t after) {
    const auto all = std::as_bytes(bytes);
    return fw::core::hashBytes(all.subspan(after), fw::core::hashBytes(all.first(before)));
}

inline Bytes signedInput(Input input) {
    Bytes bytes(input.begin(), input.end());
    const auto write = [&](size_t at, uint64_t value) { std::memcpy(&bytes[at], &value, 8); };
    if (bytes.size() < 32) return bytes;
    if (startsWith(input, "FWSV")) host::signSave(bytes);
    if (startsWith(input, "FWLG")) write(16, hashAround(bytes, 0, 24));
    if (startsWith(input, "FWBB")) write(8, hashAround(bytes, 0, 16));
    if (startsWith(input, "FWBK")) write(8, hashAround(bytes, 0, 16));
    if (startsWith(input, "FWFP")) write(16, hashAround(bytes, 16, 24));
    if (startsWith(input, "FWBD")) {
        write(16, bytes.size() - 32);
        write(24, hashAround(bytes, 24, 32));
    }
    return bytes;
}

}  // namespace fuzz
