// See gltf_import.h. What the file holds, as meshes; gltf_access.h reads and checks its numbers.
#include "import/gltf_import.h"

#include "import/gltf_access.h"
#include "import/gltf_types.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <map>

namespace fwimport {
namespace {

// Keeps the bytes of images that came by URI; those in a buffer are fetched later, with checks,
// because tinygltf hands out their range without any.
bool keepImage(tinygltf::Image* image, int, std::string*, std::string*, int, int,
               const unsigned char* bytes, int size, void*) {
    if (image->bufferView < 0 && bytes && size > 0) image->image.assign(bytes, bytes + size);
    return true;
}

struct TextureUse {
    int texCoord = 0;
    glm::dvec2 offset{0}, scale{1};
    double rotation = 0;
    bool transformed = false;
};

double numberOf(const tinygltf::Value& value, double otherwise) {
    return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
}

void checkExtensions(const tinygltf::Model& source) {
    for (const std::string& extension : source.extensionsRequired) {
        static const char* const kKnown[] = {"KHR_texture_transform", "KHR_mesh_quantization",
                                             "KHR_materials_unlit"};
        const bool known = std::any_of(std::begin(kKnown), std::end(kKnown),
                                       [&](const char* name) { return extension == name; });
        if (!known) refuse("extensionsRequired names ", extension, ", which is not read");
    }
}

class Importer {
 public:
    Importer(const tinygltf::Model& source, ImportedModel& model)
        : source_(source), model_(model), visited_(source.nodes.size(), false) {
        model_.nodes.resize(source.nodes.size());
        for (size_t i = 0; i < source.nodes.size(); ++i)
            model_.nodes[i].name = source.nodes[i].name;
    }

    void run(std::string_view part) {
        if (!source_.animations.empty()) note("animations are left out: the rest pose is used");
        if (!source_.skins.empty()) note("skins are left out: the bind pose is used");
        for (int root : roots()) place(root, -1, glm::dmat4(1.0), 0);
        takeMeshes(part);
        if (model_.indices.empty()) {
            std::string why;
            for (const std::string& line : model_.notes) why += "\n - " + line;
            refuse("there is no triangle in it", why);
        }
        finish();
    }

 private:
    void note(const std::string& line) {
        if (std::find(model_.notes.begin(), model_.notes.end(), line) == model_.notes.end() &&
            model_.notes.size() < 200) {
            model_.notes.push_back(line);
        }
    }

    std::vector<int> roots() {
        if (!source_.scenes.empty()) {
            const int scene = source_.defaultScene < 0 ? 0 : source_.defaultScene;
            if (static_cast<size_t>(scene) >= source_.scenes.size()) {
                refuse("scene is ", scene, "; there are ", source_.scenes.size());
            }
            if (source_.scenes.size() > 1) {
                note(text("scenes[", scene, "] is read, the other ", source_.scenes.size() - 1,
                          " are left out"));
            }
            return source_.scenes[static_cast<size_t>(scene)].nodes;
        }
        note("there is no scene: every root node is read");
        std::vector<bool> child(source_.nodes.size(), false);
        for (const tinygltf::Node& node : source_.nodes) {
            for (int index : node.children) {
                if (index >= 0 && static_cast<size_t>(index) < child.size()) {
                    child[static_cast<size_t>(index)] = true;
                }
            }
        }
        std::vector<int> result;
        for (size_t i = 0; i < child.size(); ++i) {
            if (!child[i]) result.push_back(static_cast<int>(i));
        }
        if (result.empty() && !source_.nodes.empty()) refuse("every node has a parent: a cycle");
        return result;
    }

    static glm::dmat4 localTransform(const tinygltf::Node& node, const std::string& name) {
        auto take = [&](const std::vector<double>& values, size_t size, const char* field) {
            if (!values.empty() && values.size() != size) {
                refuse(name, ".", field, " has ", values.size(), " numbers; it takes ", size);
            }
            for (double value : values) {
                if (!std::isfinite(value) || std::abs(value) > 1e12) {
                    refuse(name, ".", field, " holds ", value, ", which is no usable number");
                }
            }
            return !values.empty();
        };
        if (take(node.matrix, 16, "matrix")) return glm::make_mat4(node.matrix.data());
        glm::dmat4 result(1.0);
        if (take(node.translation, 3, "translation")) {
            result[3] = glm::dvec4(glm::make_vec3(node.translation.data()), 1.0);
        }
        if (take(node.rotation, 4, "rotation")) {
            const glm::dquat q(node.rotation[3], node.rotation[0], node.rotation[1],
                               node.rotation[2]);
            if (glm::length(q) > 1e-9) result = result * glm::mat4_cast(glm::normalize(q));
        }
        if (take(node.scale, 3, "scale")) {
            for (int i = 0; i < 3; ++i) result[i] *= node.scale[static_cast<size_t>(i)];
        }
        return result;
    }

    // Finds where a node and all below it stand.
    void place(int index, int parent, const glm::dmat4& above, int depth) {
        if (index < 0 || static_cast<size_t>(index) >= source_.nodes.size()) {
            refuse("a node names the child ", index, "; there are ", source_.nodes.size());
        }
        if (depth > 256) refuse("nodes[", index, "] is more than 256 levels deep");
        // A node may stand in one place only; a second visit is a cycle or a shared child.
        if (visited_[static_cast<size_t>(index)]) {
            refuse("nodes[", index, "] has more than one parent, or is its own ancestor");
        }
        visited_[static_cast<size_t>(index)] = true;
        order_.push_back(static_cast<size_t>(index));
        const tinygltf::Node& node = source_.nodes[static_cast<size_t>(index)];
        const glm::dmat4 world = above * localTransform(node, text("nodes[", index, "]"));
        ImportedNode& placed = model_.nodes[static_cast<size_t>(index)];
        placed.parent = parent;
        placed.inScene = true;
        std::copy_n(glm::value_ptr(world), 16, placed.pose.begin());
        for (int child : node.children) place(child, index, world, depth + 1);
    }

    // Of all nodes that are in the scene, or of one and what is below it.
    void takeMeshes(std::string_view part) {
        std::string problem;
        const int32_t top = part.empty() ? -1 : findNode(model_.nodes, part, problem);
        if (!part.empty() && top < 0) refuse(problem);
        std::vector<bool> taken(model_.nodes.size(), top < 0);
        for (const size_t index : order_) {  // parents come before their children
            const int32_t parent = model_.nodes[index].parent;
            if (static_cast<int32_t>(index) == top ||
                (parent >= 0 && taken[static_cast<size_t>(parent)]))
                taken[index] = true;
            const int which = source_.nodes[index].mesh;
            if (which < 0 || !taken[index]) continue;
            if (static_cast<size_t>(which) >= source_.meshes.size()) {
                refuse("nodes[", index, "].mesh is ", which, "; there are ", source_.meshes.size());
            }
            const tinygltf::Mesh& mesh = source_.meshes[static_cast<size_t>(which)];
            const glm::dmat4 world = glm::make_mat4(model_.nodes[index].pose.data());
            for (size_t i = 0; i < mesh.primitives.size(); ++i) {
                addPrimitive(mesh.primitives[i], world,
                             text("meshes[", which, "].primitives[", i, "]"));
            }
        }
    }

    int attribute(const tinygltf::Primitive& primitive, const std::string& name) const {
        const auto found = primitive.attributes.find(name);
        return found == primitive.attributes.end() ? -1 : found->second;
    }

    // Which of our materials this is; decodes its image the first time.
    uint32_t materialIndex(int index, const std::string& name) {
        if (const auto found = materials_.find(index); found != materials_.end()) {
            return found->second;
        }
        ImportedMaterial material;
        TextureUse use;
        if (index >= 0) {
            if (static_cast<size_t>(index) >= source_.materials.size()) {
                refuse(name, ".material is ", index, "; there are ", source_.materials.size());
            }
            const tinygltf::Material& from = source_.materials[static_cast<size_t>(index)];
            material.name = from.name;
            material.doubleSided = from.doubleSided;
            const auto& pbr = from.pbrMetallicRoughness;
            for (size_t i = 0; i < 4 && i < pbr.baseColorFactor.size(); ++i) {
                const double value = pbr.baseColorFactor[i];
                material.baseColor[i] =
                    std::isfinite(value) ? static_cast<float>(std::clamp(value, 0.0, 1.0)) : 1.0f;
            }
            if (std::isfinite(pbr.roughnessFactor)) {
                material.roughness = static_cast<float>(std::clamp(pbr.roughnessFactor, 0.0, 1.0));
            }
            if (pbr.baseColorTexture.index >= 0) {
                material.image = imageIndex(pbr.baseColorTexture.index,
                                            text("materials[", index, "].baseColorTexture"));
                use.texCoord = pbr.baseColorTexture.texCoord;
                readTransform(pbr.baseColorTexture, use);
            }
            readAlpha(from, material, text("materials[", index, "]"));
        } else {
            material.name = "default";
        }
        const auto result = static_cast<uint32_t>(model_.materials.size());
        model_.materials.push_back(material);
        textureUses_.push_back(use);
        materials_[index] = result;
        return result;
    }

    // Alpha that a Mask cannot show becomes the nearest thing that it can, with a note.
    void readAlpha(const tinygltf::Material& from, ImportedMaterial& material,
                   const std::string& name) {
        if (from.alphaMode == "MASK") {
            material.alphaMode = AlphaMode::Mask;
            if (std::isfinite(from.alphaCutoff))
                material.alphaCutoff = static_cast<float>(std::clamp(from.alphaCutoff, 0.0, 1.0));
            return;
        }
        if (from.alphaMode != "BLEND") return;
        const bool holes =
            material.image >= 0 && hasHoles(model_.images[static_cast<size_t>(material.image)]);
        if (holes) material.alphaMode = AlphaMode::Mask;
        note(text(name, ".alphaMode BLEND is shown ",
                  holes ? "as a cut-out: what has less than half its alpha is not there"
                        : "opaque"));
    }

    // True: some of it is more see-through than not, and some is not.
    static bool hasHoles(const DecodedImage& image) {
        bool hole = false, solid = false;
        for (size_t i = 3; i < image.rgba.size(); i += 4)
            (image.rgba[i] < 128 ? hole : solid) = true;
        return hole && solid;
    }

    static void readTransform(const tinygltf::TextureInfo& info, TextureUse& use) {
        const auto found = info.extensions.find("KHR_texture_transform");
        if (found == info.extensions.end() || !found->second.IsObject()) return;
        const tinygltf::Value& value = found->second;
        auto pair = [&](const char* key, glm::dvec2 otherwise) {
            if (!value.Has(key)) return otherwise;
            const tinygltf::Value& list = value.Get(key);
            if (!list.IsArray() || list.ArrayLen() < 2) return otherwise;
            const glm::dvec2 both(numberOf(list.Get(0), otherwise.x),
                                  numberOf(list.Get(1), otherwise.y));
            return std::isfinite(both.x) && std::isfinite(both.y) ? both : otherwise;
        };
        use.transformed = true;
        use.offset = pair("offset", glm::dvec2(0));
        use.scale = pair("scale", glm::dvec2(1));
        if (value.Has("rotation")) use.rotation = numberOf(value.Get("rotation"), 0.0);
        if (!std::isfinite(use.rotation)) use.rotation = 0;
        if (value.Has("texCoord")) {
            use.texCoord = static_cast<int>(numberOf(value.Get("texCoord"), use.texCoord));
        }
    }

    // Our image for a texture, or -1 with a note: a missing picture is no reason to refuse a mesh.
    int32_t imageIndex(int texture, const std::string& name) {
        if (static_cast<size_t>(texture) >= source_.textures.size()) {
            refuse(name, ".index is ", texture, "; there are ", source_.textures.size());
        }
        const int index = source_.textures[static_cast<size_t>(texture)].source;
        if (index < 0) {
            note(text("textures[", texture, "] has no image that can be read"));
            return -1;
        }
        if (static_cast<size_t>(index) >= source_.images.size()) {
            refuse("textures[", texture, "].source is ", index, "; there are ",
                   source_.images.size());
        }
        if (const auto found = images_.find(index); found != images_.end()) return found->second;
        const tinygltf::Image& image = source_.images[static_cast<size_t>(index)];
        std::span<const uint8_t> bytes(image.image);
        if (image.bufferView >= 0) {
            const Bytes view = viewBytes(source_, image.bufferView, text("images[", index, "]"));
            bytes = {view.data, static_cast<size_t>(view.size)};
        }
        int32_t result = -1;
        DecodedImage decoded;
        std::string error = "its file is missing";
        if (!bytes.empty() && decodeImage(bytes, decoded, error)) {
            result = static_cast<int32_t>(model_.images.size());
            model_.images.push_back(std::move(decoded));
        } else {
            note(text("images[", index, "] is left out: ", error));
        }
        images_[index] = result;
        return result;
    }

    void addPrimitive(const tinygltf::Primitive& primitive, const glm::dmat4& world,
                      const std::string& name) {
        if (primitive.mode >= 0 && primitive.mode <= 3) {
            note(text(name, " is left out: points and lines do not burn (mode ", primitive.mode,
                      ")"));
            return;
        }
        if (primitive.mode < 0 || primitive.mode > 6) {
            // tinygltf gives -1 where the field is absent, which means triangles.
            if (primitive.mode != -1) refuse(name, ".mode is ", primitive.mode, "; 0 to 6 exist");
        }
        if (!primitive.targets.empty()) note("morph targets are left out: the base shape is used");
        const int positionAccessor = attribute(primitive, "POSITION");
        if (positionAccessor < 0) {
            note(text(name, " is left out: it has no POSITION"));
            return;
        }
        const Values positions = readAccessor(source_, positionAccessor, name + ".POSITION");
        if (positions.components != 3) {
            refuse(name, ".POSITION has ", positions.components, " components; it takes 3");
        }
        const size_t base = model_.vertexCount();
        if (base + positions.count > kMaxVertices) {
            refuse(name, " brings the model to ", base + positions.count,
                   " vertices; the limit is ", kMaxVertices);
        }
        const uint32_t material = materialIndex(primitive.material, name);
        addVertices(primitive, positions, world, material, name);
        addTriangles(primitive, positions.count, base, material,
                     glm::determinant(glm::dmat3(world)) < 0, name);
    }

    void addVertices(const tinygltf::Primitive& primitive, const Values& positions,
                     const glm::dmat4& world, uint32_t material, const std::string& name) {
        // An attribute of another length than the positions cannot be matched to them.
        auto optional = [&](const std::string& key, uint64_t least, uint64_t most) {
            Values values;
            const int accessor = attribute(primitive, key);
            if (accessor < 0) return values;
            values = readAccessor(source_, accessor, name + "." + key);
            if (values.components < least || values.components > most) {
                refuse(name, ".", key, " has ", values.components, " components; it takes ", least,
                       least == most ? "" : " or more");
            }
            if (values.count != positions.count) {
                refuse(name, ".", key, " has ", values.count, " elements; POSITION has ",
                       positions.count);
            }
            return values;
        };
        const TextureUse& use = textureUses_[material];
        const Values normals = optional("NORMAL", 3, 3);
        const Values uvs = optional(text("TEXCOORD_", use.texCoord), 2, 2);
        const Values colors = optional("COLOR_0", 3, 4);
        const glm::dmat3 linear(world);
        const bool invertible = std::abs(glm::determinant(linear)) > 1e-30;
        const glm::dmat3 normalMatrix =
            invertible ? glm::transpose(glm::inverse(linear)) : glm::dmat3(1.0);
        const double cosine = std::cos(use.rotation), sine = std::sin(use.rotation);
        uint64_t badNormals = 0;
        for (uint64_t i = 0; i < positions.count; ++i) {
            const glm::dvec3 local = glm::make_vec3(&positions.data[i * 3]);
            const glm::dvec3 p(world * glm::dvec4(local, 1.0));
            for (int c = 0; c < 3; ++c) {
                if (!std::isfinite(p[c]) || std::abs(p[c]) > 1e9) {
                    refuse(name, ".POSITION[", i, "] is ", local.x, ", ", local.y, ", ", local.z,
                           "; a position is finite and within 1e9 m");
                }
                model_.positions.push_back(static_cast<float>(p[c]));
            }
            glm::dvec3 n(0);
            if (normals.count) {
                n = normalMatrix * glm::dvec3(glm::make_vec3(&normals.data[i * 3]));
                const double length = glm::length(n);
                if (std::isfinite(length) && length > 1e-12) {
                    n /= length;
                } else {
                    n = glm::dvec3(0);
                    ++badNormals;
                }
            } else {
                everyNormal_ = false;
            }
            for (int c = 0; c < 3; ++c) model_.normals.push_back(static_cast<float>(n[c]));
            glm::dvec2 uv(0);
            if (uvs.count) {
                uv = glm::make_vec2(&uvs.data[i * 2]);
                if (!std::isfinite(uv.x) || !std::isfinite(uv.y) || std::abs(uv.x) > 1e6 ||
                    std::abs(uv.y) > 1e6) {
                    refuse(name, ".TEXCOORD_", use.texCoord, "[", i, "] is ", uv.x, ", ", uv.y,
                           "; it is finite and within 1e6");
                }
                if (use.transformed) {
                    uv *= use.scale;
                    uv = glm::dvec2(cosine * uv.x + sine * uv.y, cosine * uv.y - sine * uv.x) +
                         use.offset;
                }
            } else {
                everyUv_ = false;
            }
            model_.uvs.push_back(static_cast<float>(uv.x));
            model_.uvs.push_back(static_cast<float>(uv.y));
            uint32_t color = 0xffffffffu;
            if (colors.count) {
                color = 0;
                for (uint64_t c = 0; c < 4; ++c) {
                    double value =
                        c < colors.components ? colors.data[i * colors.components + c] : 1;
                    value = std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : 1.0;
                    color |= static_cast<uint32_t>(std::lround(value * 255.0)) << (8 * c);
                }
                anyColor_ = true;
            }
            model_.colors.push_back(color);
        }
        if (badNormals) {
            note(text(name, ": ", badNormals,
                      " normals have no length; all normals are computed instead"));
            everyNormal_ = false;
        }
    }

    void addTriangles(const tinygltf::Primitive& primitive, uint64_t vertexCount, size_t base,
                      uint32_t material, bool mirrored, const std::string& name) {
        std::vector<uint32_t> order;
        if (primitive.indices >= 0) {
            const Values values = readAccessor(source_, primitive.indices, name + ".indices");
            const int type =
                source_.accessors[static_cast<size_t>(primitive.indices)].componentType;
            if (values.components != 1 || (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
                                           type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
                                           type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)) {
                refuse(name, ".indices are of type ", type,
                       "; unsigned scalars (5121, 5123, 5125) are read");
            }
            order.reserve(values.count);
            for (uint64_t i = 0; i < values.count; ++i) {
                if (values.data[i] >= static_cast<double>(vertexCount)) {
                    refuse(name, ".indices[", i, "] is ", static_cast<uint64_t>(values.data[i]),
                           "; there are ", vertexCount, " vertices");
                }
                order.push_back(static_cast<uint32_t>(values.data[i]));
            }
        } else {
            order.resize(vertexCount);
            for (uint64_t i = 0; i < vertexCount; ++i) order[i] = static_cast<uint32_t>(i);
        }
        const size_t count = order.size();
        const bool strip = primitive.mode == 5, fan = primitive.mode == 6;
        const size_t triangles = strip || fan ? (count < 3 ? 0 : count - 2) : count / 3;
        if (!strip && !fan && count % 3 != 0) {
            note(text(name, ": its ", count, " indices are no whole number of triangles; the last ",
                      count % 3, " are left out"));
        }
        if (model_.triangleCount() + triangles > kMaxTriangles) {
            refuse(name, " brings the model to ", model_.triangleCount() + triangles,
                   " triangles; the limit is ", kMaxTriangles);
        }
        for (size_t t = 0; t < triangles; ++t) {
            uint32_t corner[3];
            if (strip) {
                const size_t odd = t & 1;
                corner[0] = order[t];
                corner[1] = order[t + 1 + odd];
                corner[2] = order[t + 2 - odd];
            } else if (fan) {
                corner[0] = order[0];
                corner[1] = order[t + 1];
                corner[2] = order[t + 2];
            } else {
                std::copy_n(&order[3 * t], 3, corner);
            }
            // Strips turn corners with triangles that have no area.
            if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) {
                repeatedCorners_ += strip ? 0 : 1;
                continue;
            }
            if (mirrored) std::swap(corner[1], corner[2]);
            for (uint32_t k : corner) model_.indices.push_back(static_cast<uint32_t>(base) + k);
            model_.triangleMaterials.push_back(material);
        }
    }

    void finish() {
        if (repeatedCorners_) {
            note(text(repeatedCorners_, " triangles with a repeated corner are left out"));
        }
        model_.hasNormals = everyNormal_;
        model_.hasUvs = everyUv_;
        model_.hasColors = anyColor_;
        for (size_t c = 0; c < 3; ++c) model_.low[c] = model_.high[c] = model_.positions[c];
        for (size_t i = 0; i < model_.positions.size(); ++i) {
            model_.low[i % 3] = std::min(model_.low[i % 3], model_.positions[i]);
            model_.high[i % 3] = std::max(model_.high[i % 3], model_.positions[i]);
        }
    }

    const tinygltf::Model& source_;
    ImportedModel& model_;
    std::vector<bool> visited_;
    std::vector<size_t> order_;  // of the nodes as they were found
    std::map<int, uint32_t> materials_;
    std::map<int, int32_t> images_;
    std::vector<TextureUse> textureUses_;
    uint64_t repeatedCorners_ = 0;
    bool everyNormal_ = true, everyUv_ = true, anyColor_ = false;
};

}  // namespace

int32_t findNode(std::span<const ImportedNode> nodes, std::string_view which, std::string& error) {
    for (size_t i = 0; i < nodes.size(); ++i)
        if (nodes[i].inScene && nodes[i].name == which && !which.empty())
            return static_cast<int32_t>(i);
    if (which.starts_with('#')) {
        size_t number = 0;
        const char* end = which.data() + which.size();
        const auto [at, code] = std::from_chars(which.data() + 1, end, number);
        if (code == std::errc{} && at == end && number < nodes.size() && nodes[number].inScene)
            return static_cast<int32_t>(number);
    }
    constexpr size_t kMostListed = 12;
    size_t count = 0;
    std::string list;
    for (size_t i = 0; i < nodes.size(); ++i) {
        if (!nodes[i].inScene || ++count > kMostListed) continue;
        list += list.empty() ? "" : ", ";
        list += nodes[i].name.empty() ? text("#", i) : nodes[i].name.substr(0, 80);
    }
    error = text(
        "there is no node \"", which.substr(0, 80), "\"; ",
        count == 0 ? "it has none" : text("its nodes are #0 to #", nodes.size() - 1, ": ", list),
        count > kMostListed ? text(" and ", count - kMostListed, " more") : "");
    return -1;
}

bool importGltfBytes(std::span<const uint8_t> bytes, const std::string& name,
                     const std::filesystem::path& folder, ImportedModel& model, std::string& error,
                     std::string_view part) {
    try {
        if (bytes.size() > kMaxFileBytes) {
            refuse("it is ", bytes.size(), " bytes; the limit is ", kMaxFileBytes);
        }
        if (bytes.empty()) refuse("it is empty");
        const bool binary = bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
        const std::span<const uint8_t> json = binary ? checkGlb(bytes) : bytes;
        checkNesting(json);
        const std::string wrongType = findWrongType(json);

        tinygltf::TinyGLTF loader;
        loader.SetImageLoader(keepImage, nullptr);
        tinygltf::Model source;
        std::string problem, warning;
        const auto size = static_cast<unsigned int>(bytes.size());
        const bool good =
            binary ? loader.LoadBinaryFromMemory(&source, &problem, &warning, bytes.data(), size,
                                                 folder.string())
                   : loader.LoadASCIIFromString(&source, &problem, &warning,
                                                reinterpret_cast<const char*>(bytes.data()), size,
                                                folder.string());
        if (!good) {
            while (!problem.empty() && problem.back() == '\n') problem.pop_back();
            // A required extension is the likelier cause of whatever looked odd to the parser.
            checkExtensions(source);
            if (!wrongType.empty()) refuse(wrongType);
            refuse(problem.empty() ? "it is not glTF" : problem);
        }
        if (source.asset.version.rfind("2.", 0) != 0) {
            refuse("asset.version is \"", source.asset.version, "\"; 2.x is read");
        }
        checkExtensions(source);
        if (!wrongType.empty()) refuse(wrongType);
        ImportedModel result;
        Importer(source, result).run(part);
        model = std::move(result);
        return true;
    } catch (const std::exception& failure) {
        error = name + ": " + failure.what();
        return false;
    }
}

bool importGltf(const std::filesystem::path& path, ImportedModel& model, std::string& error,
                std::string_view part) {
    const std::string name = path.string();
    std::error_code code;
    const uint64_t size = std::filesystem::file_size(path, code);
    if (code) {
        error = name + ": it cannot be read: " + code.message();
        return false;
    }
    if (size > kMaxFileBytes) {
        error = name + ": it is " + std::to_string(size) + " bytes; the limit is " +
                std::to_string(kMaxFileBytes);
        return false;
    }
    std::vector<uint8_t> bytes(size);
    std::ifstream file(path, std::ios::binary);
    if (!file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size))) {
        error = name + ": it cannot be read";
        return false;
    }
    return importGltfBytes(bytes, name, path.parent_path(), model, error, part);
}

}  // namespace fwimport
