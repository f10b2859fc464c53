// Checks an EXR file's header before OpenEXR reads it, which reserves what the header says.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace fwimport {

// Returns false with `error` if an attribute is larger than the file, or a side longer than `most`
// pixels. True for files of other formats.
bool checkExrHeader(std::span<const uint8_t> bytes, uint32_t most, std::string& error);

}  // namespace fwimport
