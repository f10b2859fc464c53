// Checks the header of a picture before a library reads the file, which reserves what the header
// says.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace fwimport {

struct PictureLimit {
    uint32_t side;   // pixels
    uint64_t bytes;  // of memory, to read the picture
};

// Memory per pixel: the result in bytes, and as much again for each of two copies in the reader.
constexpr uint64_t kPixelBytes = 12;

// Returns false with `error` if a picture is beyond `limit`.
bool fits(int64_t width, int64_t height, uint64_t bytesPerPixel, const PictureLimit& limit,
          std::string& error);

// Returns false with `error` if an attribute of an EXR is larger than the file, a side of it beyond
// `limit`, or a WebP beyond `limit`. True for files of other formats, whose readers reserve nothing
// before the size is known. `bytes`: an EXR whole, of others at least the first 64.
bool checkHeader(std::span<const uint8_t> bytes, const PictureLimit& limit, std::string& error);

}  // namespace fwimport
