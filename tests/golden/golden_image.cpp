#include "golden/golden_image.h"

#include "support/bless.h"

#include <zlib.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace fw::test {
namespace {

namespace fs = std::filesystem;

void put32(std::vector<uint8_t>& out, uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) out.push_back(uint8_t(value >> shift));
}

uint32_t get32(const uint8_t* p) {
    return uint32_t(p[0]) << 24 | uint32_t(p[1]) << 16 | uint32_t(p[2]) << 8 | p[3];
}

void putChunk(std::vector<uint8_t>& out, const char* type, const std::vector<uint8_t>& body) {
    put32(out, uint32_t(body.size()));
    const size_t start = out.size();
    out.insert(out.end(), type, type + 4);
    out.insert(out.end(), body.begin(), body.end());
    put32(out, uint32_t(crc32(0, out.data() + start, uInt(out.size() - start))));
}

constexpr uint8_t kSignature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr uint8_t kFilterPaeth = 4;

uint8_t paeth(int a, int b, int c) {
    const int p = a + b - c, da = std::abs(p - a), db = std::abs(p - b), dc = std::abs(p - c);
    return uint8_t(da <= db && da <= dc ? a : db <= dc ? b : c);
}

// The Paeth filter's prediction of byte `x` of row `y`.
uint8_t predicted(const std::vector<uint8_t>& rgb, size_t row, size_t y, size_t x) {
    const int a = x >= 3 ? rgb[y * row + x - 3] : 0, b = y > 0 ? rgb[(y - 1) * row + x] : 0;
    const int c = x >= 3 && y > 0 ? rgb[(y - 1) * row + x - 3] : 0;
    return paeth(a, b, c);
}

// Beside the test program, in the build folder.
fs::path failureFolder() {
    std::error_code none;
    const fs::path program = fs::read_symlink("/proc/self/exe", none);
    return program.parent_path() / "golden";
}

}  // namespace

bool writePng(const std::string& path, const Picture& picture) {
    const size_t row = size_t{picture.width} * 3;
    std::vector<uint8_t> raw;
    for (size_t y = 0; y < picture.height; ++y) {
        raw.push_back(kFilterPaeth);
        for (size_t x = 0; x < row; ++x)
            raw.push_back(uint8_t(picture.rgb[y * row + x] - predicted(picture.rgb, row, y, x)));
    }
    uLongf size = compressBound(uLong(raw.size()));
    std::vector<uint8_t> packed(size);
    if (compress2(packed.data(), &size, raw.data(), uLong(raw.size()), 9) != Z_OK) return false;
    packed.resize(size);
    std::vector<uint8_t> head, out(std::begin(kSignature), std::end(kSignature));
    put32(head, picture.width);
    put32(head, picture.height);
    head.insert(head.end(), {8, 2, 0, 0, 0});
    putChunk(out, "IHDR", head);
    putChunk(out, "IDAT", packed);
    putChunk(out, "IEND", {});
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(out.data()), std::streamsize(out.size()));
    return bool(file);
}

bool readPng(const std::string& path, Picture& picture) {
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> chars((std::istreambuf_iterator<char>(file)), {});
    const auto* data = reinterpret_cast<const uint8_t*>(chars.data());
    if (chars.size() < 8 || std::memcmp(data, kSignature, 8) != 0) return false;
    std::vector<uint8_t> packed;
    for (size_t at = 8; at + 12 <= chars.size();) {
        const size_t size = get32(data + at);
        if (size > chars.size() - at - 12) return false;
        const uint8_t* body = data + at + 8;
        if (std::memcmp(data + at + 4, "IHDR", 4) == 0 && size == 13) {
            picture.width = get32(body);
            picture.height = get32(body + 4);
            if (body[8] != 8 || body[9] != 2) return false;
        } else if (std::memcmp(data + at + 4, "IDAT", 4) == 0) {
            packed.insert(packed.end(), body, body + size);
        }
        at += size + 12;
    }
    const size_t row = size_t{picture.width} * 3;
    if (row == 0 || picture.width > 4096 || picture.height > 4096) return false;
    std::vector<uint8_t> raw((row + 1) * picture.height);
    uLongf size = uLongf(raw.size());
    if (uncompress(raw.data(), &size, packed.data(), uLong(packed.size())) != Z_OK) return false;
    picture.rgb.assign(row * picture.height, 0);
    for (size_t y = 0; y < picture.height; ++y) {
        if (raw[y * (row + 1)] != kFilterPaeth) return false;
        for (size_t x = 0; x < row; ++x)
            picture.rgb[y * row + x] =
                uint8_t(raw[y * (row + 1) + 1 + x] + predicted(picture.rgb, row, y, x));
    }
    return true;
}

testing::AssertionResult picturesMatch(const Picture& actual, const Picture& expected,
                                       const PictureTolerance& tolerance) {
    if (actual.width != expected.width || actual.height != expected.height)
        return testing::AssertionFailure()
               << "the picture is " << actual.width << " x " << actual.height << ", expected "
               << expected.width << " x " << expected.height;
    uint64_t sum = 0, far = 0;
    for (size_t i = 0; i < actual.rgb.size(); i += 3) {
        int most = 0;
        for (size_t k = 0; k < 3; ++k) {
            const int d = std::abs(int(actual.rgb[i + k]) - int(expected.rgb[i + k]));
            sum += uint64_t(d);
            most = std::max(most, d);
        }
        far += most > tolerance.outlier;
    }
    const double mean = double(sum) / double(actual.rgb.size());
    const double share = double(far) * 3 / double(actual.rgb.size());
    const bool fine = mean <= tolerance.mean && share <= tolerance.outliers;
    return (fine ? testing::AssertionSuccess() : testing::AssertionFailure())
           << "mean difference " << mean << " (limit " << tolerance.mean << "), " << 100 * share
           << " % of the pixels are off by more than " << tolerance.outlier << " (limit "
           << 100 * tolerance.outliers << " %)";
}

testing::AssertionResult matchesGolden(const std::string& name, const Picture& actual,
                                       const PictureTolerance& tolerance) {
    const std::string path = std::string(FW_TEST_SOURCE_DIR) + "/golden/" + name + ".png";
    if (blessing()) {
        if (!writePng(path, actual)) return testing::AssertionFailure() << path << " not written";
        return testing::AssertionSuccess() << path << " written";
    }
    const fs::path folder = failureFolder();
    std::error_code none;
    fs::create_directories(folder, none);
    writePng((folder / (name + "_actual.png")).string(), actual);
    Picture expected;
    if (!readPng(path, expected))
        return testing::AssertionFailure() << path << " cannot be read; --bless writes it";
    const testing::AssertionResult result = picturesMatch(actual, expected, tolerance);
    if (result) return result;
    Picture difference = actual;
    if (expected.rgb.size() == actual.rgb.size()) {
        for (size_t i = 0; i < actual.rgb.size(); ++i)
            difference.rgb[i] =
                uint8_t(std::min(255, 4 * std::abs(int(actual.rgb[i]) - int(expected.rgb[i]))));
    }
    writePng((folder / (name + "_expected.png")).string(), expected);
    writePng((folder / (name + "_difference.png")).string(), difference);
    return testing::AssertionFailure()
           << name << ": " << result.message() << "; see " << folder.string();
}

}  // namespace fw::test
