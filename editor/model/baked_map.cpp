#include "model/baked_map.h"

#include <cstdio>
#include <fstream>
#include <iterator>

#include "import/content_hash.h"

namespace fwmodel {
namespace {

namespace fs = std::filesystem;

fs::path fileOf(const fs::path& folder, const std::string& key) {
    return folder / (key + ".fwburn");
}

}  // namespace

std::string bakeKeyOf(const FwMeshDef& def) {
    const size_t vertices = def.vertexCount, indices = def.indexCount;
    fwimport::ContentHash hash;
    hash.addValue(fwGetVersion());
    hash.addValue(def.mapSize);
    hash.addValue(def.texelsPerMetre);
    const auto addAll = [&](const auto* values, size_t count) {
        if (values) hash.add(values, count * sizeof *values);
    };
    addAll(def.positions, vertices * 3);
    addAll(def.normals, vertices * 3);
    addAll(def.uvs, vertices * 2);
    addAll(def.colors, vertices);
    addAll(static_cast<const uint32_t*>(def.indices), indices);
    addAll(def.triangleMaterials, indices / 3);
    char name[40];
    std::snprintf(name, sizeof name, "%016llx", static_cast<unsigned long long>(hash.value));
    return name;
}

bool readBake(const fs::path& folder, const std::string& key, std::vector<char>& bytes) {
    bytes.clear();
    if (folder.empty()) return false;
    std::ifstream stream(fileOf(folder, key), std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(stream), {});
    return !bytes.empty();
}

bool cookMesh(FwContext* context, const FwMeshDef& def, std::vector<char>& bytes,
              std::string& error) {
    uint64_t size = 0;
    FwResult result = fwCookMesh(context, &def, nullptr, &size);
    if (result >= 0) {
        bytes.resize(size);
        result = fwCookMesh(context, &def, bytes.data(), &size);
    }
    if (result >= 0) return true;
    char text[1024] = "";
    fwContext_GetLastMessage(context, text, sizeof text);
    error = text;
    return false;
}

bool keepBake(const fs::path& folder, const std::string& key, const std::vector<char>& bytes) {
    if (folder.empty()) return false;
    std::error_code problem;
    fs::create_directories(folder, problem);
    const fs::path file = fileOf(folder, key), fresh = file.string() + ".new";
    std::ofstream stream(fresh, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) return false;
    fs::rename(fresh, file, problem);
    return !problem;
}

void dropBake(const fs::path& folder, const std::string& key) {
    std::error_code ignored;
    if (!folder.empty()) fs::remove(fileOf(folder, key), ignored);
}

FwMeshDef cookedDefOf(const std::vector<char>& bytes) {
    FwMeshDef def = fwDefaultMeshDef();
    def.cooked = bytes.data();
    def.cookedSize = bytes.size();
    return def;
}

}  // namespace fwmodel
