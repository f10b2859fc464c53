// The raw side of a glTF file: its container, and the numbers behind an accessor. tinygltf parses
// the JSON and fetches the buffers but checks few ranges; here no offset, count or index of it is
// used before it has been compared with what there is. Knows nothing of meshes.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace fwimport {

// Why a file is not read, for the user: names the thing, its value and the limit.
struct Refusal : std::runtime_error {
    using std::runtime_error::runtime_error;
};

template <typename... Parts>
std::string text(const Parts&... parts) {
    std::ostringstream stream;
    (stream << ... << parts);
    return stream.str();
}

template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
    throw Refusal(text(parts...));
}

// Refuses deep nesting, which would exhaust the stack of a recursive reader.
void checkNesting(std::span<const uint8_t> json);
// The container's header and chunks; returns the JSON chunk.
std::span<const uint8_t> checkGlb(std::span<const uint8_t> bytes);

struct Bytes {
    const uint8_t* data = nullptr;
    uint64_t size = 0;
    uint64_t stride = 0;  // as the view says; 0: packed
};
// A buffer view's bytes, proved to lie within its buffer.
Bytes viewBytes(const tinygltf::Model& model, int index, const std::string& who);

struct Values {
    uint64_t count = 0, components = 0;
    std::vector<double> data;  // exact for every type that glTF has
};
// Reads an accessor whole, sparse substitution included. `who` is the attribute, for messages.
Values readAccessor(const tinygltf::Model& model, int index, const std::string& who);

}  // namespace fwimport
