// Merges a file's scene into one mesh: nodes, instances, skins, morph targets. gltf_access.h reads
// and validates numbers, gltf_material.h materials.
#include "import/gltf_import.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <map>
#include <new>
#include <set>

#include "import/gltf_access.h"
#include "import/gltf_left_out.h"
#include "import/gltf_material.h"

namespace fwimport {
namespace {

// Memory of the model and of its making, with room that vectors keep in reserve.
constexpr uint64_t kVertexBytes = 96, kCornerBytes = 12;
constexpr uint64_t kShapeBytes = 64;       // of a vertex in a shape that is kept
constexpr uint64_t kInfluenceBytes = 112;  // of a vertex, for four joints and their weights

// A primitive in its local space, as triangles.
struct Shape {
    std::string name;  // "meshes[0].primitives[1]"
    uint32_t material = 0;
    uint64_t vertices = 0;
    std::vector<double> positions, normals;  // 3 per vertex; normals may be empty
    std::vector<float> uvs;                  // 2 per vertex, or empty
    std::vector<uint32_t> colors;            // RGBA8 per vertex, or empty
    std::vector<uint32_t> joints;            // `influences` per vertex, into the skin's joints
    std::vector<double> weights;
    size_t influences = 0;
    std::vector<uint32_t> corners;  // 3 per triangle
};

class Importer {
 public:
    Importer(GltfFile& file, ImportedModel& model, Notes& notes)
        : file_(file), model_(model), notes_(notes), materials_(file, model, notes) {
        const Field nodes = file.root().list("nodes");
        model_.nodes.resize(nodes.size());
        for (size_t i = 0; i < nodes.size(); ++i) model_.nodes[i].name = nodes.at(i).string("name");
        hidden_.assign(nodes.size(), false);
    }

    void run(std::string_view part) {
        placeNodes();
        takeMeshes(part);
        if (model_.indices.empty()) {
            notes_.finish();
            std::string why;
            for (const std::string& line : model_.notes) why += "\n - " + line;
            refuse("there is no triangle in it", why);
        }
        finish();
    }

 private:
    std::vector<int> childrenOf(const Field& from, const char* list) const {
        std::vector<int> result;
        const Field items = from.list(list);
        for (size_t i = 0; i < items.size(); ++i) {
            const int64_t index = items.at(i).asInteger();
            if (index < 0 || static_cast<size_t>(index) >= model_.nodes.size())
                refuse(from.path(), " names the child ", index, "; there are ",
                       model_.nodes.size());
            result.push_back(static_cast<int>(index));
        }
        return result;
    }

    std::vector<int> roots(const std::vector<std::vector<int>>& children) {
        const Field scenes = file_.root().list("scenes");
        if (scenes.size()) {
            const int scene = std::max(file_.root().index("scene", scenes.size()), 0);
            if (scenes.size() > 1) {
                notes_.add(text("scenes[", scene, "] is read, the other ", scenes.size() - 1,
                                " are left out"));
            }
            return childrenOf(scenes.at(static_cast<size_t>(scene)), "nodes");
        }
        notes_.add("there is no scene: every root node is read");
        std::vector<bool> child(children.size(), false);
        for (const std::vector<int>& list : children)
            for (const int index : list) child[static_cast<size_t>(index)] = true;
        std::vector<int> result;
        for (size_t i = 0; i < child.size(); ++i)
            if (!child[i]) result.push_back(static_cast<int>(i));
        if (result.empty() && !children.empty()) refuse("every node has a parent: a cycle");
        return result;
    }

    static glm::dmat4 localTransform(const Field& node) {
        const auto take = [&](const char* name, size_t size) {
            std::vector<double> values = node.numbers(name, size);
            for (const double value : values) {
                if (!std::isfinite(value) || std::abs(value) > 1e12) {
                    refuse(node.path(), ".", name, " holds ", value, ", which is no usable number");
                }
            }
            return values;
        };
        if (const auto matrix = take("matrix", 16); !matrix.empty())
            return glm::make_mat4(matrix.data());
        glm::dmat4 result(1.0);
        if (const auto values = take("translation", 3); !values.empty())
            result[3] = glm::dvec4(glm::make_vec3(values.data()), 1.0);
        if (const auto q = take("rotation", 4); !q.empty())
            result = result * rotationOf({q[3], q[0], q[1], q[2]});
        if (const auto values = take("scale", 3); !values.empty())
            for (int i = 0; i < 3; ++i) result[i] *= values[static_cast<size_t>(i)];
        return result;
    }

    static glm::dmat4 rotationOf(const glm::dquat& q) {
        return glm::length(q) > 1e-9 ? glm::mat4_cast(glm::normalize(q)) : glm::dmat4(1.0);
    }

    // Computes the world pose of every node. Joints outside the scene have a pose too.
    void placeNodes() {
        const Field nodes = file_.root().list("nodes");
        std::vector<std::vector<int>> children(nodes.size());
        std::vector<bool> hasParent(nodes.size(), false);
        for (size_t i = 0; i < nodes.size(); ++i) {
            children[i] = childrenOf(nodes.at(i), "children");
            for (const int child : children[i]) hasParent[static_cast<size_t>(child)] = true;
        }
        std::vector<bool> visited(nodes.size(), false);
        const auto walk = [&](int root, bool inScene) {
            struct Step {
                int node, parent;
            };
            std::vector<Step> open{{root, -1}};
            while (!open.empty()) {
                const auto [index, parent] = open.back();
                open.pop_back();
                const auto at = static_cast<size_t>(index);
                // A node has one parent. A second visit is a cycle or a shared child.
                if (visited[at])
                    refuse("nodes[", index, "] has more than one parent, or is its own ancestor");
                visited[at] = true;
                const Field node = nodes.at(at);
                glm::dmat4 world = localTransform(node);
                ImportedNode& placed = model_.nodes[at];
                placed.parent = parent;
                placed.inScene = inScene;
                hidden_[at] = !node.extension("KHR_node_visibility").flag("visible", true);
                if (parent >= 0) {
                    const auto above = static_cast<size_t>(parent);
                    world = glm::make_mat4(model_.nodes[above].pose.data()) * world;
                    hidden_[at] = hidden_[at] || hidden_[above];
                }
                std::copy_n(glm::value_ptr(world), 16, placed.pose.begin());
                if (inScene) order_.push_back(at);
                for (size_t i = children[at].size(); i-- > 0;)
                    open.push_back({children[at][i], index});
            }
        };
        std::vector<int> tops = roots(children);
        std::stable_partition(tops.begin(), tops.end(),
                              [&](int top) { return !hasParent[static_cast<size_t>(top)]; });
        for (const int top : tops) {
            const auto at = static_cast<size_t>(top);
            if (visited[at])
                notes_.leaveOut("scene's second mention of a node", nodes.at(at).path());
            else
                walk(top, true);
        }
        for (size_t i = 0; i < nodes.size(); ++i) {
            if (visited[i] || hasParent[i]) continue;
            walk(static_cast<int>(i), false);
        }
    }

    glm::dmat4 poseOf(size_t node) const { return glm::make_mat4(model_.nodes[node].pose.data()); }

    // Takes the meshes of all scene nodes, or of one subtree.
    void takeMeshes(std::string_view part) {
        std::string problem;
        const int32_t top = part.empty() ? -1 : findNode(model_.nodes, part, problem);
        if (!part.empty() && top < 0) refuse(problem);
        const Field nodes = file_.root().list("nodes");
        const size_t meshes = file_.count("meshes");
        std::map<int, size_t> users;                       // scene nodes of each mesh
        const bool oneScene = file_.count("scenes") == 1;  // only then a note is useful
        for (size_t i = 0; i < nodes.size(); ++i) {
            const Field node = nodes.at(i);
            if (!node.has("mesh")) continue;
            const bool inScene = model_.nodes[i].inScene;
            users[node.index("mesh", meshes)] += inScene ? 1 : 0;
            if (!inScene && oneScene)
                notes_.leaveOut("node", node.path(), "is left out: no scene holds it");
        }
        for (size_t i = 0; i < meshes; ++i)
            if (!users.contains(static_cast<int>(i)))
                notes_.leaveOut("mesh", text("meshes[", i, "]"), "is left out: no node shows it");
        std::vector<bool> taken(model_.nodes.size(), top < 0);
        for (const size_t index : order_) {  // parents precede their children
            const int32_t parent = model_.nodes[index].parent;
            if (static_cast<int32_t>(index) == top ||
                (parent >= 0 && taken[static_cast<size_t>(parent)]))
                taken[index] = true;
            const Field node = nodes.at(index);
            const int which = node.index("mesh", meshes);
            if (which < 0 || !taken[index]) continue;
            if (hidden_[index]) {
                notes_.leaveOut("node", node.path(), "is left out: KHR_node_visibility hides it");
                continue;
            }
            takeNode(index, which, users[which] > 1);
        }
    }

    void takeNode(size_t index, int which, bool keep) {
        const Field node = file_.item("nodes", static_cast<int>(index));
        const Field mesh = file_.item("meshes", which);
        const int skin = node.index("skin", file_.count("skins"));
        const bool ownWeights = node.has("weights");
        const std::vector<double> weights = (ownWeights ? node : mesh).numbers("weights", 0);
        std::vector<glm::dmat4> places{poseOf(index)};
        const Field instances = node.extension("EXT_mesh_gpu_instancing");
        if (instances.present() && skin >= 0)
            notes_.leaveOut("EXT_mesh_gpu_instancing of a skinned mesh", node.path());
        else if (instances.present())
            places = instancesOf(instances, places[0]);
        const Field primitives = mesh.list("primitives");
        for (size_t i = 0; i < primitives.size(); ++i) {
            const auto key = std::make_pair(which, i);
            const Shape* shape = nullptr;
            Shape own;
            if (const auto found = shapes_.find(key); found != shapes_.end() && !ownWeights) {
                shape = &found->second;
            } else if (keep && !ownWeights) {
                shape = &(shapes_[key] = readShape(primitives.at(i), weights));
                file_.reserve(shape->vertices * kShapeBytes + shape->corners.size() * 4,
                              shape->name);
            } else {
                own = readShape(primitives.at(i), weights);
                shape = &own;
            }
            if (shape->corners.empty()) continue;
            if (skin >= 0 && shape->influences) {
                addShape(*shape, skinOf(skin, *shape), places[0]);
            } else {
                for (const glm::dmat4& place : places) addShape(*shape, {}, place);
            }
        }
    }

    std::vector<glm::dmat4> instancesOf(const Field& instances, const glm::dmat4& world) {
        const Field attributes = instances.object("attributes");
        uint64_t count = 0;
        const auto take = [&](const char* name, uint64_t components) {
            Values values;
            if (!attributes.has(name)) return values;
            values = file_.accessor(attributes.integer(name, -1), attributes.path() + "." + name);
            if (values.components != components)
                refuse(attributes.path(), ".", name, " has ", values.components,
                       " components; it takes ", components);
            if (count && values.count != count)
                refuse(attributes.path(), ".", name, " has ", values.count,
                       " elements; the others have ", count);
            for (const double value : values.data)
                if (!std::isfinite(value) || std::abs(value) > 1e12)
                    refuse(attributes.path(), ".", name, " holds ", value,
                           ", which is no usable number");
            count = values.count;
            return values;
        };
        const Values moves = take("TRANSLATION", 3), turns = take("ROTATION", 4),
                     sizes = take("SCALE", 3);
        for (const std::string& name : attributes.names())
            if (name != "TRANSLATION" && name != "ROTATION" && name != "SCALE")
                notes_.leaveOut("attribute " + name + " of instances", instances.path());
        if (count == 0) return {world};
        if (count > kMaxVertices / 3)
            refuse(attributes.path(), " makes ", count, " instances; the limit is ",
                   kMaxVertices / 3);
        std::vector<glm::dmat4> result;
        file_.reserve(count * sizeof result[0], attributes.path());
        result.reserve(count);
        for (uint64_t i = 0; i < count; ++i) {
            glm::dmat4 local(1.0);
            if (moves.count) local[3] = glm::dvec4(glm::make_vec3(&moves.data[i * 3]), 1.0);
            if (turns.count) {
                const double* q = &turns.data[i * 4];
                local = local * rotationOf({q[3], q[0], q[1], q[2]});
            }
            if (sizes.count)
                for (int c = 0; c < 3; ++c) local[c] *= sizes.data[i * 3 + static_cast<size_t>(c)];
            result.push_back(world * local);
        }
        return result;
    }

    // Returns per joint the transform from the shape's space to the model's, in the rest pose.
    std::vector<glm::dmat4> skinOf(int index, const Shape& shape) {
        const Field skin = file_.item("skins", index);
        const Field joints = skin.list("joints");
        Values inverse;
        if (skin.has("inverseBindMatrices")) {
            inverse = file_.accessor(skin.integer("inverseBindMatrices", -1),
                                     skin.path() + ".inverseBindMatrices");
            if (inverse.components != 16)
                refuse(skin.path(), ".inverseBindMatrices has ", inverse.components,
                       " components; it takes 16");
            if (inverse.count < joints.size())
                refuse(skin.path(), ".inverseBindMatrices has ", inverse.count,
                       " elements; there are ", joints.size(), " joints");
        }
        std::vector<glm::dmat4> result;
        file_.reserve(joints.size() * sizeof result[0], skin.path());
        for (size_t i = 0; i < joints.size(); ++i) {
            const int64_t node = joints.at(i).asInteger();
            if (node < 0 || static_cast<size_t>(node) >= model_.nodes.size())
                refuse(joints.path(), "[", i, "] is ", node, "; there are ", model_.nodes.size());
            glm::dmat4 pose = poseOf(static_cast<size_t>(node));
            if (inverse.count) pose = pose * glm::make_mat4(&inverse.data[i * 16]);
            result.push_back(pose);
        }
        for (const uint32_t joint : shape.joints)
            if (joint >= result.size())
                refuse(shape.name, ".JOINTS names joint ", joint, "; ", skin.path(), " has ",
                       result.size());
        return result;
    }

    // Attributes of a primitive, from Draco data or accessors.
    struct Attributes {
        Field primitive, names;
        std::map<std::string, Values> unpacked;
        std::vector<uint32_t> corners;  // Draco only
        bool draco = false;
    };

    Attributes openPrimitive(const Field& primitive) {
        Attributes result;
        result.primitive = primitive;
        result.names = primitive.object("attributes");
        const Field draco = primitive.extension("KHR_draco_mesh_compression");
        if (!draco.present()) return result;
        const int position = result.names.has("POSITION")
                                 ? result.names.index("POSITION", file_.count("accessors"))
                                 : -1;
        if (!readsDraco() && position >= 0 && file_.accessorHasData(position)) return result;
        const Field ids = draco.object("attributes");
        std::map<std::string, DracoAttribute> wanted;
        for (const std::string& name : ids.names()) {
            if (!result.names.has(name.c_str())) continue;
            const int accessor = result.names.index(name.c_str(), file_.count("accessors"));
            wanted[name] = {ids.integer(name.c_str(), -1),
                            file_.item("accessors", accessor).flag("normalized", false)};
        }
        const Bytes bytes =
            file_.view(draco.index("bufferView", file_.count("bufferViews")), draco.path());
        DracoMesh mesh = readDraco(bytes.span(), wanted, primitive.path());
        result.unpacked = std::move(mesh.attributes);
        result.corners = std::move(mesh.indices);
        result.draco = true;
        return result;
    }

    // Returns an attribute with the primitive's morph targets applied; empty: missing. A length
    // that differs from POSITION is an error.
    Values readAttribute(const Attributes& from, const std::string& key, uint64_t least,
                         uint64_t most, uint64_t count, const std::vector<double>& weights) {
        const std::string name = from.primitive.path() + "." + key;
        Values values;
        if (const auto found = from.unpacked.find(key); found != from.unpacked.end())
            values = found->second;
        else if (from.names.has(key.c_str()))
            values = file_.accessor(from.names.integer(key.c_str(), -1), name);
        else
            return values;
        const auto check = [&](const Values& one, const std::string& of) {
            if (one.components < least || one.components > most) {
                refuse(of, " has ", one.components, " components; it takes ", least,
                       least == most ? "" : " or more");
            }
            if (count && one.count != count)
                refuse(of, " has ", one.count, " elements; POSITION has ", count);
        };
        check(values, name);
        const Field targets = from.primitive.list("targets");
        for (size_t i = 0; i < targets.size() && i < weights.size(); ++i) {
            const Field target = targets.at(i);
            if (weights[i] == 0 || !std::isfinite(weights[i]) || !target.has(key.c_str())) continue;
            const std::string of = target.path() + "." + key;
            const Values delta = file_.accessor(target.integer(key.c_str(), -1), of);
            if (delta.components != values.components || delta.count != values.count)
                refuse(of, " has ", delta.count, " elements of ", delta.components, " components; ",
                       key, " has ", values.count, " of ", values.components);
            for (size_t k = 0; k < delta.data.size(); ++k)
                values.data[k] += weights[i] * delta.data[k];
        }
        return values;
    }

    Shape readShape(const Field& primitive, const std::vector<double>& weights) {
        Shape shape;
        shape.name = primitive.path();
        const int64_t mode = primitive.integer("mode", 4);
        if (mode >= 0 && mode <= 3) {
            notes_.leaveOut(text("primitive of mode ", mode), shape.name,
                            "is left out: points and lines do not burn");
            return shape;
        }
        if (mode < 0 || mode > 6) refuse(shape.name, ".mode is ", mode, "; 0 to 6 exist");
        const Attributes from = openPrimitive(primitive);
        if (!from.names.has("POSITION")) {
            notes_.leaveOut("primitive", shape.name, "is left out: it has no POSITION");
            return shape;
        }
        if (!from.draco) {
            const int64_t accessor = from.names.integer("POSITION", -1);
            if (file_.isEmpty(accessor) || file_.isEmpty(primitive.integer("indices", -1))) {
                notes_.leaveOut("primitive", shape.name,
                                "is left out: its POSITION or its indices have a .count of 0");
                return shape;
            }
            if (accessor >= 0 && static_cast<size_t>(accessor) < file_.count("accessors") &&
                !file_.accessorHasData(static_cast<int>(accessor)))
                refuse("accessors[", accessor, "] (", shape.name,
                       ".POSITION) has neither a bufferView nor sparse values");
        }
        Values positions = readAttribute(from, "POSITION", 3, 3, 0, weights);
        shape.vertices = positions.count;
        if (shape.vertices > kMaxVertices)
            refuse(shape.name, " has ", shape.vertices, " vertices; the limit is ", kMaxVertices);
        const int material = primitive.index("material", file_.count("materials"));
        shape.material = materials_.indexOf(material);
        shape.positions = std::move(positions.data);
        shape.normals = readAttribute(from, "NORMAL", 3, 3, shape.vertices, weights).data;
        readUvs(from, shape, weights);
        readColors(from, shape, weights);
        readInfluences(from, shape);
        noteAttributes(from, shape);
        readCorners(from, shape, mode);
        dropCutOutTriangles(shape);
        dropUnusedVertices(shape);
        return shape;
    }

    // Images cut out by their own alpha only, so vertex alpha drops whole triangles.
    void dropCutOutTriangles(Shape& shape) {
        const ImportedMaterial& material = model_.materials[shape.material];
        if (material.alphaMode != AlphaMode::Mask || shape.corners.empty()) return;
        std::vector<uint32_t> kept;
        uint32_t least = 255;  // of the kept triangles
        for (size_t i = 0; i < shape.corners.size(); i += 3) {
            uint32_t low = 255, high = shape.colors.empty() ? 255 : 0;
            for (size_t k = i; k < i + 3 && !shape.colors.empty(); ++k) {
                const uint32_t alpha = shape.colors[shape.corners[k]] >> 24;
                low = std::min(low, alpha);
                high = std::max(high, alpha);
            }
            if (material.baseColor[3] * static_cast<float>(high) / 255 < material.alphaCutoff)
                continue;
            least = std::min(least, low);
            kept.insert(kept.end(), &shape.corners[i], &shape.corners[i] + 3);
        }
        shape.corners = std::move(kept);
        if (shape.corners.empty())
            notes_.leaveOut("primitive", shape.name,
                            "is left out: its alpha is below its alphaCutoff");
        else if (least < 255)
            notes_.leaveOut("alpha of COLOR_0", shape.name,
                            "is left out, but for triangles that are below the alphaCutoff");
    }

    // Several primitives may share a vertex list and use parts of it.
    static void dropUnusedVertices(Shape& shape) {
        constexpr uint32_t kUnused = UINT32_MAX;
        std::vector<uint32_t> places(shape.vertices, kUnused);
        for (const uint32_t corner : shape.corners) places[corner] = 0;
        uint32_t count = 0;
        for (uint32_t& place : places)
            if (place != kUnused) place = count++;
        if (count == shape.vertices) return;
        const auto keep = [&](auto& values, size_t each) {
            if (values.empty()) return;
            for (size_t i = 0; i < places.size(); ++i)
                if (places[i] != kUnused)
                    std::copy_n(&values[i * each], each, &values[places[i] * each]);
            values.resize(count * each);
        };
        keep(shape.positions, 3);
        keep(shape.normals, 3);
        keep(shape.uvs, 2);
        keep(shape.colors, 1);
        keep(shape.joints, shape.influences);
        keep(shape.weights, shape.influences);
        for (uint32_t& corner : shape.corners) corner = places[corner];
        shape.vertices = count;
    }

    void readUvs(const Attributes& from, Shape& shape, const std::vector<double>& weights) {
        const TextureUse& use = materials_.use(shape.material);
        const std::string key = text("TEXCOORD_", use.texCoord);
        const Values uvs = readAttribute(from, key, 2, 2, shape.vertices, weights);
        const bool pictured = model_.materials[shape.material].image >= 0;
        if (!uvs.count && pictured)
            notes_.leaveOut("picture", shape.name, text("is left out: there is no ", key));
        for (uint64_t i = 0; i < uvs.count; ++i) {
            const glm::dvec2 raw = glm::make_vec2(&uvs.data[i * 2]);
            if (!std::isfinite(raw.x) || !std::isfinite(raw.y) || std::abs(raw.x) > 1e6 ||
                std::abs(raw.y) > 1e6) {
                refuse(shape.name, ".", key, "[", i, "] is ", raw.x, ", ", raw.y,
                       "; it is finite and within 1e6");
            }
            const glm::dvec2 uv = use.apply(raw);
            for (int c = 0; c < 2; ++c) shape.uvs.push_back(static_cast<float>(uv[c]));
        }
    }

    void readColors(const Attributes& from, Shape& shape, const std::vector<double>& weights) {
        const Values colors = readAttribute(from, "COLOR_0", 3, 4, shape.vertices, weights);
        for (uint64_t i = 0; i < colors.count; ++i) {
            uint32_t color = 0;
            for (uint64_t c = 0; c < 4; ++c) {
                double value = c < colors.components ? colors.data[i * colors.components + c] : 1;
                value = std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : 1.0;
                color |= static_cast<uint32_t>(std::lround(value * 255.0)) << (8 * c);
            }
            shape.colors.push_back(color);
        }
    }

    void readInfluences(const Attributes& from, Shape& shape) {
        std::vector<Values> joints, weights;
        for (int set = 0; from.names.has(text("JOINTS_", set).c_str()) &&
                          from.names.has(text("WEIGHTS_", set).c_str());
             ++set) {
            file_.reserve(shape.vertices * kInfluenceBytes, text(shape.name, ".JOINTS_", set));
            joints.push_back(readAttribute(from, text("JOINTS_", set), 4, 4, shape.vertices, {}));
            weights.push_back(readAttribute(from, text("WEIGHTS_", set), 4, 4, shape.vertices, {}));
        }
        shape.influences = 4 * joints.size();
        for (uint64_t i = 0; i < shape.vertices && shape.influences; ++i) {
            double sum = 0;
            const size_t first = shape.weights.size();
            for (size_t set = 0; set < joints.size(); ++set) {
                for (uint64_t c = 0; c < 4; ++c) {
                    const double weight = weights[set].data[i * 4 + c];
                    const double joint = joints[set].data[i * 4 + c];
                    const bool used = std::isfinite(weight) && weight > 0;
                    // A joint with zero weight may have any index.
                    shape.joints.push_back(
                        used && joint >= 0 && joint < 65536 ? static_cast<uint32_t>(joint) : 0);
                    shape.weights.push_back(used ? weight : 0);
                    sum += shape.weights.back();
                }
            }
            if (sum <= 0) shape.weights[first] = sum = 1;
            for (size_t k = first; k < shape.weights.size(); ++k) shape.weights[k] /= sum;
        }
    }

    void noteAttributes(const Attributes& from, const Shape& shape) {
        const std::string uv = text("TEXCOORD_", materials_.use(shape.material).texCoord);
        const bool pictured = model_.materials[shape.material].image >= 0;
        for (const std::string& name : from.names.names()) {
            if (name == "POSITION" || name == "NORMAL" || name == "COLOR_0" || name == uv) continue;
            if (name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_")) continue;
            // Skip texture coordinates without an image.
            if (name.starts_with("TEXCOORD_") && !pictured) continue;
            notes_.leaveOut("attribute " + name, shape.name);
        }
    }

    void readCorners(const Attributes& from, Shape& shape, int64_t mode) {
        std::vector<uint32_t> order;
        if (from.draco) {
            order = from.corners;
            mode = 4;
        } else if (from.primitive.has("indices")) {
            const int64_t accessor = from.primitive.integer("indices", -1);
            const Values values = file_.accessor(accessor, shape.name + ".indices");
            const int64_t type =
                file_.item("accessors", static_cast<int>(accessor)).integer("componentType", 0);
            if (values.components != 1 || (type != 5121 && type != 5123 && type != 5125)) {
                refuse(shape.name, ".indices are of type ", type,
                       "; unsigned scalars (5121, 5123, 5125) are read");
            }
            order.reserve(values.count);
            for (uint64_t i = 0; i < values.count; ++i) {
                if (values.data[i] >= static_cast<double>(shape.vertices)) {
                    refuse(shape.name, ".indices[", i, "] is ",
                           static_cast<uint64_t>(values.data[i]), "; there are ", shape.vertices,
                           " vertices");
                }
                order.push_back(static_cast<uint32_t>(values.data[i]));
            }
        } else {
            order.resize(shape.vertices);
            for (uint64_t i = 0; i < shape.vertices; ++i) order[i] = static_cast<uint32_t>(i);
        }
        const size_t count = order.size();
        const bool strip = mode == 5, fan = mode == 6;
        const size_t triangles = strip || fan ? (count < 3 ? 0 : count - 2) : count / 3;
        if (!strip && !fan && count % 3 != 0) {
            notes_.add(text(shape.name, ": its ", count,
                            " indices are no whole number of triangles; the last ", count % 3,
                            " are left out"));
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
            if (corner[0] >= shape.vertices || corner[1] >= shape.vertices ||
                corner[2] >= shape.vertices)
                refuse(shape.name, ": a triangle names a vertex beyond the ", shape.vertices,
                       " that there are");
            // Strips use degenerate triangles to turn corners.
            if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) {
                repeatedCorners_ += strip ? 0 : 1;
                continue;
            }
            shape.corners.insert(shape.corners.end(), corner, corner + 3);
        }
    }

    // Returns true if the transform collapses everything onto a line or a point.
    static bool isFlattened(const glm::dmat3& linear) {
        double most = 0, area = 0;
        for (int c = 0; c < 3; ++c) {
            most = std::max(most, glm::length(linear[c]));
            area = std::max(area, glm::length(glm::cross(linear[c], linear[(c + 1) % 3])));
        }
        return area <= 1e-14 * most * most;
    }

    static glm::dmat3 normalMatrixOf(const glm::dmat3& linear) {
        return std::abs(glm::determinant(linear)) > 1e-30 ? glm::transpose(glm::inverse(linear))
                                                          : glm::dmat3(1.0);
    }

    // `skin`: by joint; empty: the whole shape is placed by `place`.
    void addShape(const Shape& shape, const std::vector<glm::dmat4>& skin,
                  const glm::dmat4& place) {
        if (skin.empty() && isFlattened(glm::dmat3(place))) {
            notes_.leaveOut("primitive", shape.name,
                            "is left out: the scale of its node squeezes it onto a line");
            return;
        }
        if (shape.corners.empty()) return;
        ++model_.parts;
        const size_t base = model_.vertexCount();
        if (base + shape.vertices > kMaxVertices) {
            refuse(shape.name, " brings the model to ", base + shape.vertices,
                   " vertices; the limit is ", kMaxVertices);
        }
        if (model_.triangleCount() + shape.corners.size() / 3 > kMaxTriangles) {
            refuse(shape.name, " brings the model to ",
                   model_.triangleCount() + shape.corners.size() / 3, " triangles; the limit is ",
                   kMaxTriangles);
        }
        file_.reserve(shape.vertices * kVertexBytes + shape.corners.size() * kCornerBytes,
                      shape.name);
        glm::dmat4 world = place;
        glm::dmat3 normalMatrix = normalMatrixOf(glm::dmat3(place));
        std::vector<bool> mirrored(1, glm::determinant(glm::dmat3(place)) < 0);
        if (!skin.empty()) mirrored.assign(shape.vertices, false);
        for (uint64_t i = 0; i < shape.vertices; ++i) {
            if (!skin.empty()) {
                world = glm::dmat4(0.0);
                for (size_t k = i * shape.influences; k < (i + 1) * shape.influences; ++k)
                    if (shape.weights[k] > 0) world += shape.weights[k] * skin[shape.joints[k]];
                normalMatrix = normalMatrixOf(glm::dmat3(world));
                mirrored[i] = glm::determinant(glm::dmat3(world)) < 0;
            }
            const glm::dvec3 local = glm::make_vec3(&shape.positions[i * 3]);
            const glm::dvec3 p(world * glm::dvec4(local, 1.0));
            for (int c = 0; c < 3; ++c) {
                if (!std::isfinite(p[c]) || std::abs(p[c]) > 1e9) {
                    refuse(shape.name, ".POSITION[", i, "] is ", local.x, ", ", local.y, ", ",
                           local.z, ", which its node puts at ", p.x, ", ", p.y, ", ", p.z,
                           "; a position is finite and within 1e9 m");
                }
                model_.positions.push_back(static_cast<float>(p[c]));
            }
            glm::dvec3 n(0);
            if (!shape.normals.empty()) {
                n = normalMatrix * glm::dvec3(glm::make_vec3(&shape.normals[i * 3]));
                const double length = glm::length(n);
                const bool good = std::isfinite(length) && length > 1e-12;
                n = good ? n / length : glm::dvec3(0);
                anyNormal_ = anyNormal_ || good;
                badNormals_ += good ? 0 : 1;
            }
            for (int c = 0; c < 3; ++c) model_.normals.push_back(static_cast<float>(n[c]));
        }
        if (shape.normals.empty()) missingNormals_ += 1;
        if (shape.uvs.empty()) everyUv_ = false;
        model_.uvs.insert(model_.uvs.end(), shape.uvs.begin(), shape.uvs.end());
        model_.uvs.resize(2 * model_.vertexCount(), 0.0f);
        if (!shape.colors.empty()) anyColor_ = true;
        model_.colors.insert(model_.colors.end(), shape.colors.begin(), shape.colors.end());
        model_.colors.resize(model_.vertexCount(), 0xffffffffu);
        for (size_t i = 0; i < shape.corners.size(); i += 3) {
            uint32_t corner[3];
            std::copy_n(&shape.corners[i], 3, corner);
            if (mirrored[skin.empty() ? 0 : corner[0]]) std::swap(corner[1], corner[2]);
            for (uint32_t k : corner) model_.indices.push_back(static_cast<uint32_t>(base) + k);
            model_.triangleMaterials.push_back(shape.material);
        }
    }

    // Vertices without a normal get the area-weighted mean of their triangles.
    void computeMissingNormals() {
        const auto at = [&](const std::vector<float>& values, size_t i) {
            return glm::dvec3(glm::make_vec3(&values[i * 3]));
        };
        std::vector<glm::dvec3> sums(model_.vertexCount(), glm::dvec3(0));
        for (size_t i = 0; i < model_.indices.size(); i += 3) {
            const uint32_t* corner = &model_.indices[i];
            const glm::dvec3 a = at(model_.positions, corner[0]);
            const glm::dvec3 area = glm::cross(at(model_.positions, corner[1]) - a,
                                               at(model_.positions, corner[2]) - a);
            for (int k = 0; k < 3; ++k) sums[corner[k]] += area;
        }
        for (size_t i = 0; i < sums.size(); ++i) {
            if (at(model_.normals, i) != glm::dvec3(0)) continue;
            const double length = glm::length(sums[i]);
            const glm::dvec3 n = length > 0 ? sums[i] / length : glm::dvec3(0, 1, 0);
            for (int c = 0; c < 3; ++c) model_.normals[i * 3 + size_t(c)] = float(n[c]);
        }
    }

    void finish() {
        if (repeatedCorners_)
            notes_.add(text(repeatedCorners_, " triangles with a repeated corner are left out"));
        if (badNormals_)
            notes_.add(text(badNormals_, " normals have no length: they are computed"));
        if (missingNormals_ && anyNormal_)
            notes_.add(text(missingNormals_, " primitives have no normals: they are computed"));
        if (anyNormal_ && (badNormals_ || missingNormals_)) computeMissingNormals();
        materials_.unwrapPictures();
        materials_.noteUnusedImages();
        notes_.finish();
        model_.hasNormals = anyNormal_;
        model_.hasUvs = everyUv_;
        model_.hasColors = anyColor_;
        for (size_t c = 0; c < 3; ++c) model_.low[c] = model_.high[c] = model_.positions[c];
        for (size_t i = 0; i < model_.positions.size(); ++i) {
            model_.low[i % 3] = std::min(model_.low[i % 3], model_.positions[i]);
            model_.high[i % 3] = std::max(model_.high[i % 3], model_.positions[i]);
        }
    }

    GltfFile& file_;
    ImportedModel& model_;
    Notes& notes_;
    Materials materials_;
    std::vector<bool> hidden_;
    std::vector<size_t> order_;                       // scene nodes; parents precede their children
    std::map<std::pair<int, size_t>, Shape> shapes_;  // of meshes that several nodes use
    uint64_t repeatedCorners_ = 0, badNormals_ = 0, missingNormals_ = 0;
    bool anyNormal_ = false, everyUv_ = true, anyColor_ = false;
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
    constexpr size_t kMaxListed = 12;
    size_t count = 0;
    std::string list;
    for (size_t i = 0; i < nodes.size(); ++i) {
        if (!nodes[i].inScene || ++count > kMaxListed) continue;
        list += list.empty() ? "" : ", ";
        list += nodes[i].name.empty() ? text("#", i) : nodes[i].name.substr(0, 80);
    }
    error = text(
        "there is no node \"", which.substr(0, 80), "\"; ",
        count == 0 ? "it has none" : text("its nodes are #0 to #", nodes.size() - 1, ": ", list),
        count > kMaxListed ? text(" and ", count - kMaxListed, " more") : "");
    return -1;
}

bool importGltfBytes(std::span<const uint8_t> bytes, const std::string& name,
                     const std::filesystem::path& folder, ImportedModel& model, std::string& error,
                     std::string_view part) {
    try {
        if (bytes.size() > kMaxFileBytes) {
            refuse("it is ", bytes.size(), " bytes; the limit is ", kMaxFileBytes);
        }
        ImportedModel result;
        Notes notes(result.notes);
        GltfFile file(bytes, folder, notes);
        checkRequired(file);
        noteLeftOut(file, notes);
        Importer(file, result, notes).run(part);
        model = std::move(result);
        return true;
    } catch (const Refusal& refusal) {
        error = name + ": " + refusal.what();
    } catch (const std::bad_alloc&) {
        error = name + ": there is not enough memory to read it";
    } catch (const std::exception& failure) {
        error = name + ": it cannot be read (" + failure.what() + ")";
    }
    return false;
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
