// The raw side of a glTF file: its container, buffers, views, and the numbers behind an accessor.
// No offset, count or index of it is used before it has been compared with what there is. Buffers
// are read when something needs them. Knows nothing of meshes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "import/gltf_json.h"
#include "import/mesh_codecs.h"

namespace fwimport {

// Lines for the user, each once, at most so many; and things that are left out, counted.
class Notes {
 public:
    explicit Notes(std::vector<std::string>& lines) : lines_(lines) {}
    void add(const std::string& line);
    // "normalTexture is left out (materials[0] and 4 more)", once finish() is called.
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
    uint64_t stride = 0;  // as the view says; 0: packed
    std::span<const uint8_t> span() const { return {data, static_cast<size_t>(size)}; }
};

class GltfFile {
 public:
    // Throws Refusal, as all of it does. `bytes` must outlive it.
    GltfFile(std::span<const uint8_t> bytes, std::filesystem::path folder, Notes& notes);

    [[nodiscard]] const nlohmann::json& json() const { return json_; }
    [[nodiscard]] Field root() const { return {json_, ""}; }
    // root().list(name).at(index)
    [[nodiscard]] Field item(const char* name, int64_t index) const;
    [[nodiscard]] size_t count(const char* name) const { return root().list(name).size(); }

    // A buffer view's bytes, proved to lie within its buffer; uncompressed if need be.
    // `index` is what the file says, in range or not.
    Bytes view(int64_t index, const std::string& who);
    // Reads an accessor whole, sparse substitution included. `who` is the attribute, for messages.
    // `index` is what the file says, in range or not.
    Values accessor(int64_t index, const std::string& who);
    // True: it has values that are not all zero by definition.
    [[nodiscard]] bool accessorHasData(int index) const;
    // True: it is there and its count is 0, which the standard forbids.
    [[nodiscard]] bool isEmpty(int64_t index) const;
    // With a note if it lies outside the folder.
    std::vector<uint8_t> uri(const std::string& uri, const std::string& field);

 private:
    std::span<const uint8_t> buffer(int index);
    void readContainer(std::span<const uint8_t> bytes);
    Bytes range(const Field& field, const char* name);

    std::filesystem::path folder_;
    Notes& notes_;
    nlohmann::json json_;
    std::span<const uint8_t> binary_;  // the GLB's
    bool hasBinary_ = false;
    uint64_t valuesRead_ = 0;
    std::map<int64_t, std::vector<uint8_t>> buffers_, unpacked_;  // of URIs; of compressed views
};

}  // namespace fwimport
