// The fuzzers: each hands arbitrary bytes to one reader of the product. tests/fuzz/program.cpp runs
// one under libFuzzer; replay_test.cpp runs the seeds and regressions of all without it.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "support/paths.h"

namespace fuzz {

using Bytes = std::vector<unsigned char>;
using Input = std::span<const uint8_t>;

struct Fuzzer {
    const char* name;
    std::vector<Bytes> (*seeds)();  // inputs that the product accepts
    bool (*take)(Input);            // returns whether the product accepted the input

    Fuzzer(const char* fuzzer, std::vector<Bytes> (*made)(), bool (*takes)(Input))
        : name(fuzzer), seeds(made), take(takes) {
        all().push_back(this);
    }
    static std::vector<const Fuzzer*>& all() {
        static std::vector<const Fuzzer*> list;
        return list;
    }
};

inline Bytes bytesOf(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}
inline Bytes fixture(const char* name) {
    return bytesOf(std::filesystem::path(fw::test::kTestFolder) / "fixtures" / name);
}
inline Bytes bytesIn(std::string_view text) { return {text.begin(), text.end()}; }
inline std::string_view textOf(Input input) {
    return {reinterpret_cast<const char*>(input.data()), input.size()};
}
inline bool startsWith(Input input, std::string_view magic) {
    return textOf(input).starts_with(magic);
}

// Regressions of a fuzzer: inputs that once failed.
inline std::vector<std::filesystem::path> regressionsOf(const Fuzzer& fuzzer) {
    std::vector<std::filesystem::path> files;
    const auto folder = std::filesystem::path(fw::test::kTestFolder) / "fuzz" / "regressions";
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().stem() == fuzzer.name) files.push_back(entry.path());
    return files;
}

// Records of a stream: a size (u16, little-endian) and that many bytes. The last may be cut.
inline void appendRecord(Bytes& stream, Input record) {
    stream.push_back(static_cast<unsigned char>(record.size()));
    stream.push_back(static_cast<unsigned char>(record.size() >> 8));
    stream.insert(stream.end(), record.begin(), record.end());
}
template <class Take>
void forEachRecord(Input stream, Take&& take) {
    while (stream.size() >= 2) {
        const size_t size = std::min<size_t>(stream[0] | stream[1] << 8, stream.size() - 2);
        take(Bytes(stream.begin() + 2, stream.begin() + 2 + std::ptrdiff_t(size)));
        stream = stream.subspan(2 + size);
    }
}

}  // namespace fuzz
