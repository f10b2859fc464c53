// The raw layer of a glTF file: container, buffers, views, accessor values. Every offset, count and
// index is validated before use. Buffers load on demand. No knowledge of meshes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "import/gltf_json.h"
#include "import/image_decode.h"
#include "import/mesh_codecs.h"

namespace fwimport {

// User messages, each once and limited in number, and counted skipped features.
class Notes {
 public:
    explicit Notes(std::vector<std::string>& lines) : lines_(lines) {}
    void add(const std::string& line);
    // finish() turns it into "normalTexture is left out (materials[0] and 4 more)".
    void leaveOut(const std::string& what, const std::string& where,
                  const std::string& how = "is left out");
    void finish();

 private:
    struct Group {
        std::string what, how, first, last;
        uint64_t count = 0;
    };
    std::vector<std::string>& lines_;
    std::vector<Group> groups_;
    uint64_t unlisted_ = 0;
};

struct Bytes {
    const uint8_t* data = nullptr;
    uint64_t size = 0;
    uint64_t stride = 0;  // from the view; 0: packed
    std::span<const uint8_t> span() const { return {data, static_cast<size_t>(size)}; }
};

class GltfFile {
 public:
    // Throws Refusal, as do all members. `bytes` must outlive this object.
    GltfFile(std::span<const uint8_t> bytes, std::filesystem::path folder, Notes& notes);

    [[nodiscard]] const nlohmann::json& json() const { return json_; }
    [[nodiscard]] Field root() const { return {json_, ""}; }
    // root().list(name).at(index)
    [[nodiscard]] Field item(const char* name, int64_t index) const;
    [[nodiscard]] size_t count(const char* name) const { return root().list(name).size(); }

    // Returns a buffer view's bytes, validated and decompressed. `index`: as in the file, possibly
    // out of range.
    Bytes view(int64_t index, const std::string& who);
    // Reads a whole accessor with sparse substitution. `who`: the attribute, for messages. `index`:
    // as in the file, possibly out of range.
    Values accessor(int64_t index, const std::string& who);
    // Returns true if it has values that are not all zero by definition.
    [[nodiscard]] bool accessorHasData(int index) const;
    // Returns true if its count is 0, which the standard forbids.
    [[nodiscard]] bool isEmpty(int64_t index) const;
    // Adds a note if it lies outside the folder.
    std::vector<uint8_t> uri(const std::string& uri, const std::string& field);

    // Counts memory of the model and of its making; none is given back. Refuses more than a file of
    // this size may unpack to (mostUnpacked). `who`: what the memory is for, in the error.
    void reserve(uint64_t bytes, const std::string& who);
    [[nodiscard]] bool tryReserve(uint64_t bytes);  // the same, but returns false
    // Bytes that can still be reserved.
    [[nodiscard]] uint64_t memoryLeft() const { return mostUnpacked(packedBytes_) - reserved_; }

 private:
    std::span<const uint8_t> buffer(int index);
    void readContainer(std::span<const uint8_t> bytes);
    Bytes range(const Field& field, const char* name);

    std::filesystem::path folder_;
    Notes& notes_;
    nlohmann::json json_;
    std::span<const uint8_t> binary_;  // of a GLB
    bool hasBinary_ = false;
    uint64_t packedBytes_ = 0;  // of the file and of the others that it names
    std::set<std::string> otherFiles_;
    uint64_t reserved_ = 0, valuesRead_ = 0;
    std::map<int64_t, std::vector<uint8_t>> buffers_, unpacked_;  // by URI; of compressed views
};

}  // namespace fwimport
