// See gltf_left_out.h.
#include "import/gltf_left_out.h"

#include <algorithm>
#include <string_view>

namespace fwimport {
namespace {

using nlohmann::json;

template <size_t N>
bool among(const char* const (&names)[N], std::string_view name) {
    return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

// Supported, or safe to ignore.
constexpr const char* kRead[] = {
    "KHR_texture_transform",      "KHR_mesh_quantization",
    "KHR_draco_mesh_compression", "EXT_meshopt_compression",
    "KHR_meshopt_compression",    "EXT_mesh_gpu_instancing",
    "KHR_node_visibility",        "EXT_texture_webp",
    "MSFT_texture_dds",           "KHR_materials_pbrSpecularGlossiness"};

// On primitives and meshes, without effect on the shape.
constexpr const char* kHarmless[] = {
    "KHR_materials_variants", "EXT_mesh_features",     "EXT_structural_metadata",
    "EXT_feature_metadata",   "EXT_instance_features", "CESIUM_primitive_outline",
    "EXT_mesh_manifold",      "FB_geometry_metadata",  "KHR_xmp",
    "KHR_xmp_json_ld",        "KHR_materials_unlit"};

struct Found {
    std::string name, where;
};

// Collects every member of every "extensions" object, with its owner's path.
void collect(const json& value, const std::string& path, std::vector<Found>& found) {
    if (value.is_array()) {
        for (size_t i = 0; i < value.size(); ++i)
            if (value[i].is_structured()) collect(value[i], text(path, "[", i, "]"), found);
        return;
    }
    if (!value.is_object()) return;
    for (auto item = value.begin(); item != value.end(); ++item) {
        if (item.key() == "extras") continue;
        const std::string below = path.empty() ? item.key() : path + "." + item.key();
        if (item.key() == "extensions" && item->is_object())
            for (auto one = item->begin(); one != item->end(); ++one)
                found.push_back({one.key(), path.empty() ? "the root" : path});
        if (item->is_structured()) collect(*item, below, found);
    }
}

std::vector<std::string> requiredOf(const GltfFile& file) {
    std::vector<std::string> result;
    const Field list = file.root().list("extensionsRequired");
    for (size_t i = 0; i < list.size(); ++i) result.push_back(list.at(i).asString());
    return result;
}

// Returns true if the path contains shape data.
bool holdsShape(const std::string& path) {
    return path.starts_with("buffers[") || path.starts_with("bufferViews[") ||
           path.starts_with("accessors[") || path.starts_with("meshes[");
}

}  // namespace

void checkRequired(const GltfFile& file) {
    std::vector<Found> found;
    const std::vector<std::string> required = requiredOf(file);
    if (!required.empty()) collect(file.json(), "", found);
    for (const std::string& name : required) {
        if (among(kRead, name) || among(kHarmless, name)) continue;
        for (const Found& one : found)
            if (one.name == name && holdsShape(one.where))
                refuse("extensionsRequired names ", name.substr(0, 80), ", which ", one.where,
                       " uses and which is not read; export the file without it");
    }
}

void noteLeftOut(const GltfFile& file, Notes& notes) {
    std::vector<Found> found;
    collect(file.json(), "", found);
    for (const std::string& name : requiredOf(file)) {
        const bool used = std::any_of(found.begin(), found.end(),
                                      [&](const Found& one) { return one.name == name; });
        if (!used && !among(kRead, name)) found.push_back({name, "extensionsRequired"});
    }
    for (const Found& one : found) {
        if (among(kRead, one.name)) continue;
        if (one.name == "KHR_materials_unlit")
            notes.leaveOut(one.name, one.where, "is shown lit");
        else
            notes.leaveOut(one.name.substr(0, 80), one.where);
    }
    for (const char* kind : {"animations", "cameras"}) {
        const auto list = file.json().find(kind);
        const size_t count = list != file.json().end() && list->is_array() ? list->size() : 0;
        if (count)
            notes.add(
                text(kind, " (", count, ") are left out",
                     std::string_view(kind) == "animations" ? ": the rest pose is shown" : ""));
    }
}

}  // namespace fwimport
