// Picture files for the fuzzers: written by OpenImageIO, read back from a file of the right name.
#pragma once
#include "fuzz/fuzzer.h"
#include "import/float_picture.h"

#include <gtest/gtest.h>
#include <unistd.h>

namespace fuzz {

// A file in the folder of temporary files, deleted at the end.
struct TemporaryFile {
    explicit TemporaryFile(const std::string& extension)
        : path(std::filesystem::temp_directory_path() /
               ("fw_fuzz_" + std::to_string(::getpid()) + extension)) {}
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile() {
        std::error_code ignored;
        std::filesystem::remove(path, ignored);
    }
    std::filesystem::path path;
};

inline Bytes encoded(const fwimport::FloatPicture& picture, const char* extension) {
    const TemporaryFile file(extension);
    std::string error;
    EXPECT_TRUE(fwimport::writePicture(file.path, picture, error)) << error;
    return bytesOf(file.path);
}

inline fwimport::FloatPicture smallPicture(uint32_t channels, bool whole) {
    fwimport::FloatPicture picture;
    picture.width = 8;
    picture.height = 6;
    picture.channels = channels;
    picture.whole = whole;
    for (uint32_t i = 0; i < picture.width * picture.height * channels; ++i)
        picture.values.push_back(float(i % 17) / 16);
    return picture;
}

// Returns the extension by which OpenImageIO finds the reader; null: no format that artists use.
inline const char* extensionOf(Input input) {
    return startsWith(input, "\x89PNG")                          ? ".png"
           : startsWith(input, "\x76\x2f\x31\x01")               ? ".exr"
           : startsWith(input, "II*") || startsWith(input, "MM") ? ".tif"
           : startsWith(input, "#?")                             ? ".hdr"
                                                                 : nullptr;
}

}  // namespace fuzz
