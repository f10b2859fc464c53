#include "document/apply.h"

#include <algorithm>

#include "document/text.h"

namespace fwedit {
namespace {

size_t objectCount(const Scene& scene) {
    size_t count = 0;
    forEachList(scene, [&](Kind, const auto& list) { count += list.size(); });
    return count;
}

bool nameTaken(const Scene& scene, const std::string& name) {
    bool taken = false;
    forEachList(scene, [&](Kind, const auto& list) {
        for (const auto& object : list) taken = taken || object.name == name;
    });
    return taken;
}

ObjectId addObject(Scene& scene, Kind kind) {
    const ObjectId id = scene.nextId++;
    forEachList(scene, [&](Kind which, auto& list) {
        if (which != kind) return;
        auto& object = list.emplace_back();
        object.id = id;
    });
    return id;
}

bool hasPosition(const Scene& scene, ObjectId id) {
    Kind kind{};
    return findObject(scene, id, &kind) && findField(kind, "position");
}

// Returns an empty string, or the reason why `child` cannot stick to `parent`.
std::string attachProblem(const Scene& scene, ObjectId child, ObjectId parent) {
    if (parent == 0) return "";
    const Object* object = findObject(scene, parent);
    if (!object) return "sticks_to is #" + std::to_string(parent) + ", which is not in the scene";
    if (!hasPosition(scene, parent)) return "\"" + object->name + "\" has no place to stick to";
    const std::vector<ObjectId> holders = ancestorsOf(scene, parent);
    if (std::find(holders.begin(), holders.end(), child) != holders.end())
        return "\"" + object->name + "\" sticks to it already, directly or through others";
    return "";
}

// Returns null for objects that cannot stick to a node.
std::string* nodeOf(Scene& scene, ObjectId id) {
    std::string* node = nullptr;
    forEachList(scene, [&](Kind, auto& list) {
        for (auto& object : list)
            if constexpr (requires { object.sticksToNode; })
                if (object.id == id) node = &object.sticksToNode;
    });
    return node;
}

// Returns an empty string, or the reason why `child` cannot stick to that node.
std::string nodeProblem(const Scene& scene, ObjectId child, std::string_view node,
                        const NodePoseOf& nodePose) {
    if (node.empty()) return "";
    const Mesh* mesh = findIn(scene.meshes, parentOf(scene, child));
    std::string error;
    if (!mesh)
        error = "it takes a part of a mesh that \"" + findObject(scene, child)->name +
                "\" sticks to, and that is none";
    Pose ignored;
    if (!mesh || (nodePose && !nodePose(*mesh, node, ignored, error)))
        return "sticks_to_node is \"" + cleanText(std::string(node), 80) + "\"; " + error;
    return "";
}

bool setFields(Scene& scene, Kind kind, ObjectId id, const std::vector<Assignment>& fields,
               bool keepPlace, const NodePoseOf& nodePose, std::string& repair,
               std::string& error) {
    for (const Assignment& made : fields) {
        std::string fieldRepair;
        const bool attaches = made.field == "sticks_to" || made.field == "sticks_to_node";
        const bool keeps = attaches && keepPlace && findField(kind, "position");
        const Pose before = keeps ? parentPose(scene, id, nodePose) : Pose{};
        const ObjectId parent = attaches ? parentOf(scene, id) : 0;
        if (const double* number = std::get_if<double>(&made.value)) {
            const auto to = static_cast<ObjectId>(std::clamp(*number, 0.0, 4294967295.0));
            if (made.field == "sticks_to") error = attachProblem(scene, id, to);
            if (made.field == "mesh" && kind == Kind::Layer && to && !findIn(scene.meshes, to))
                error = "mesh is #" + std::to_string(to) + ", which is no mesh of the scene";
            if (!error.empty()) return false;
        }
        if (made.field == "sticks_to_node")
            if (const auto* node = std::get_if<std::string>(&made.value)) {
                error = nodeProblem(scene, id, *node, nodePose);
                if (!error.empty()) return false;
            }
        if (!setField(scene, kind, id, made.field, made.value, fieldRepair, error)) return false;
        if (!fieldRepair.empty() && repair.empty()) repair = fieldRepair;
        // A node belongs to its previous mesh.
        std::string* node = nodeOf(scene, id);
        if (attaches && node && parentOf(scene, id) != parent) node->clear();
        if (keeps) keepInWorld(scene, id, before, parentPose(scene, id, nodePose));
    }
    return true;
}

void removeObject(Scene& scene, PaintImages& images, ObjectId id, const NodePoseOf& nodePose) {
    // Children keep their world position.
    forEachList(scene, [&](Kind, auto& list) {
        for (auto& object : list)
            if constexpr (requires { object.sticksTo; })
                if (object.sticksTo == id) {
                    keepInWorld(scene, object.id, parentPose(scene, object.id, nodePose),
                                kWorldPose);
                    object.sticksTo = 0;
                    if constexpr (requires { object.sticksToNode; }) object.sticksToNode.clear();
                }
    });
    for (const PaintLayer& layer : scene.layers)
        if (layer.mesh == id) images.erase(layer.id);
    std::erase_if(scene.layers, [&](const PaintLayer& layer) { return layer.mesh == id; });
    forEachList(scene, [&](Kind, auto& list) {
        std::erase_if(list, [&](const auto& object) { return object.id == id; });
    });
    images.erase(id);
}

// Returns true if the targets include a direct or indirect parent of `id`.
bool holdsAny(const Scene& scene, const std::vector<ObjectId>& targets, ObjectId id) {
    const std::vector<ObjectId> holders = ancestorsOf(scene, parentOf(scene, id));
    return std::find_first_of(holders.begin(), holders.end(), targets.begin(), targets.end()) !=
           holders.end();
}

bool applyKey(Scene& scene, const Command& command, std::string& error) {
    const ObjectId id = command.targets[0];
    Kind kind{};
    findObject(scene, id, &kind);
    Value value;
    if (!getField(scene, kind, id, "keys", value)) {
        error = std::string("A ") + kindKey(kind) + " has nothing to key";
        return false;
    }
    auto& flat = std::get<std::vector<double>>(value);
    bool there = false;
    for (size_t i = 0; i < flat.size(); i += 2)
        if (static_cast<float>(flat[i]) == command.key.time) {
            there = true;
            flat.erase(flat.begin() + static_cast<std::ptrdiff_t>(i),
                       flat.begin() + static_cast<std::ptrdiff_t>(i) + 2);
            break;
        }
    if (command.verb == Verb::Key)
        flat.insert(flat.end(), {command.key.time, command.key.value});
    else if (!there) {
        error = "There is no key at " + printNumber(command.key.time) + " s";
        return false;
    }
    std::string repair;
    return setField(scene, kind, id, "keys", value, repair, error);
}

bool applyPaint(const Document& document, const Command& command, const Scene& scene,
                PaintImages& images, std::string& error) {
    const PaintLayer* layer = findIn(scene.layers, command.targets[0]);
    if (!layer) {
        error = "\"" + findObject(scene, command.targets[0])->name + "\" is no layer to paint on";
        return false;
    }
    if (layer->hidden || layer->locked) {
        error = "Nothing was painted. \"" + layer->name + "\" is " +
                (layer->hidden ? "hidden" : "locked");
        return false;
    }
    const PaintSurface* surface = document.surface ? document.surface(scene, layer->mesh) : nullptr;
    if (!surface) {
        const Mesh* mesh = findIn(scene.meshes, layer->mesh);
        error = "Nothing was painted. " + (mesh ? "\"" + mesh->name + "\" has no unwrap yet"
                                                : std::string("The layer is on no mesh"));
        return false;
    }
    PaintImage& image = images[layer->id];
    if (image.width != surface->width || image.height != surface->height)
        image = resizedPaint(image, layer->kind, surface->width, surface->height);
    image = command.verb == Verb::Stroke
                ? applyStroke(*surface, layer->kind, image, command.stroke)
                : applyFill(*surface, layer->kind, image, command.fill, scene.settings.up);
    return true;
}

bool needTargets(const Scene& scene, const Command& command, std::string& error) {
    for (const ObjectId id : command.targets)
        if (!findObject(scene, id)) {
            error = "There is no object #" + std::to_string(id) + " in this scene";
            return false;
        }
    const bool none = command.verb == Verb::Add || command.verb == Verb::Import ||
                      (command.verb == Verb::Set && command.kind >= Kind::Settings);
    if (none != command.targets.empty()) {
        error = none ? "The command names no target" : "The command names no object";
        return false;
    }
    if (command.verb == Verb::Set && command.fields.empty()) {
        error = "set names no field";
        return false;
    }
    return true;
}

std::string fileStem(const std::string& file) {
    const size_t slash = file.find_last_of('/');
    const std::string last = slash == std::string::npos ? file : file.substr(slash + 1);
    const size_t dot = last.find_last_of('.');
    return dot == std::string::npos || dot == 0 ? last : last.substr(0, dot);
}

bool applyAdd(const Command& command, Scene& scene, const NodePoseOf& nodePose,
              std::string& message, std::string& error, ObjectId& added) {
    if (objectCount(scene) >= kMostObjects) {
        error = "The scene has " + std::to_string(objectCount(scene)) + " objects, the most it can";
        return false;
    }
    const Kind kind = command.verb == Verb::Import ? Kind::Mesh : command.kind;
    if (kind >= Kind::Settings) {
        error = "Only objects can be added";
        return false;
    }
    const ObjectId id = addObject(scene, kind);
    if (!setFields(scene, kind, id, command.fields, false, nodePose, message, error)) return false;
    Object& object = *findObject(scene, id);
    if (command.verb == Verb::Import) {
        Mesh& mesh = scene.meshes.back();
        mesh.file = cleanText(command.file, 4096);
        if (mesh.name.empty()) mesh.name = freeName(scene, cleanText(fileStem(mesh.file), 100));
    }
    if (object.name.empty()) object.name = freeName(scene, kindLabel(kind));
    if (kind == Kind::Layer && scene.layers.back().mesh == 0 && scene.meshes.size() == 1)
        scene.layers.back().mesh = scene.meshes[0].id;
    added = id;
    return true;
}

void duplicate(Scene& scene, PaintImages& images, ObjectId id, ObjectId& added) {
    forEachList(scene, [&](Kind, auto& list) {
        for (size_t i = 0; i < list.size(); ++i) {
            if (list[i].id != id) continue;
            auto copy = list[i];
            copy.id = scene.nextId++;
            copy.name = freeName(scene, copy.name);
            added = copy.id;
            if (const auto image = images.find(id); image != images.end())
                images[copy.id] = PaintImage(image->second);
            list.insert(list.begin() + static_cast<std::ptrdiff_t>(i) + 1, std::move(copy));
            return;
        }
    });
}

}  // namespace

std::string freeName(const Scene& scene, std::string name) {
    if (!nameTaken(scene, name)) return name;
    const size_t space = name.find_last_of(' ');
    if (space != std::string::npos && space + 1 < name.size() &&
        name.find_first_not_of("0123456789", space + 1) == std::string::npos)
        name.resize(space);
    for (size_t number = 2;; ++number) {
        const std::string tried = name + " " + std::to_string(number);
        if (!nameTaken(scene, tried)) return tried;
    }
}

bool repairReferences(Scene& scene, std::vector<std::string>* repairs) {
    bool anyRepaired = false;
    forEachList(scene, [&](Kind kind, auto& list) {
        for (size_t i = 0; i < list.size(); ++i) {
            auto& object = list[i];
            std::string why;
            const std::string where =
                join(kindKey(kind), kind == Kind::Mesh ? "es[" : "s[", std::to_string(i), "].");
            if constexpr (requires { object.sticksTo; }) {
                why = attachProblem(scene, object.id, object.sticksTo);
                if (!why.empty()) {
                    object.sticksTo = 0;
                    if (repairs)
                        repairs->push_back(where + "sticks_to: " + why + "; it is now none");
                    anyRepaired = true;
                }
            }
            if constexpr (requires { object.sticksToNode; }) {
                why = nodeProblem(scene, object.id, object.sticksToNode, {});
                if (!why.empty()) {
                    object.sticksToNode.clear();
                    if (repairs) repairs->push_back(where + why + "; it is now none");
                    anyRepaired = true;
                }
            }
            if constexpr (requires { object.mesh; }) {
                if (object.mesh == 0 || findIn(scene.meshes, object.mesh)) continue;
                if (repairs)
                    repairs->push_back(where + "mesh was #" + std::to_string(object.mesh) +
                                       ", which is no mesh of the scene; it is now none");
                object.mesh = 0;
                anyRepaired = true;
            }
        }
    });
    return anyRepaired;
}

bool applyCommand(const Document& document, const Command& command, Scene& scene,
                  PaintImages& images, std::string& message, ObjectId& added) {
    std::string error, repair;
    message.clear();
    bool good = needTargets(scene, command, error);
    if (good) switch (command.verb) {
            case Verb::Add:
            case Verb::Import:
                good = applyAdd(command, scene, document.nodePose, repair, error, added);
                break;
            case Verb::Set:
                if (command.targets.empty())
                    good = setFields(scene, command.kind, 0, command.fields, true,
                                     document.nodePose, repair, error);
                for (const ObjectId id : command.targets) {
                    Kind kind{};
                    findObject(scene, id, &kind);
                    good = good && setFields(scene, kind, id, command.fields, true,
                                             document.nodePose, repair, error);
                }
                break;
            case Verb::Move:
                for (const ObjectId id : command.targets) {
                    Kind kind{};
                    const Object* object = findObject(scene, id, &kind);
                    Value value;
                    if (good && !getField(scene, kind, id, "position", value)) {
                        error = "\"" + object->name + "\" has no place that could move";
                        good = false;
                    }
                    if (!good) break;
                    if (holdsAny(scene, command.targets, id)) continue;  // it moves with its parent
                    auto& position = std::get<std::vector<double>>(value);
                    const Vec3 by =
                        offsetWithin(parentPose(scene, id, document.nodePose), command.offset);
                    for (size_t k = 0; k < 3; ++k) position[k] += double(by[k]);
                    good = setField(scene, kind, id, "position", value, repair, error);
                }
                break;
            case Verb::Key:
            case Verb::Unkey:
                good = applyKey(scene, command, error);
                break;
            case Verb::Duplicate:
                if (objectCount(scene) + command.targets.size() > kMostObjects) {
                    error = "The scene can have " + std::to_string(kMostObjects) + " objects";
                    good = false;
                    break;
                }
                for (const ObjectId id : command.targets) duplicate(scene, images, id, added);
                break;
            case Verb::Remove:
                for (const ObjectId id : command.targets)
                    removeObject(scene, images, id, document.nodePose);
                break;
            case Verb::Order:
                forEachList(scene, [&](Kind, auto& list) {
                    const auto at = std::find_if(list.begin(), list.end(), [&](const auto& one) {
                        return one.id == command.targets[0];
                    });
                    if (at == list.end()) return;
                    auto moved = std::move(*at);
                    list.erase(at);
                    const size_t place = std::min<size_t>(command.index, list.size());
                    list.insert(list.begin() + static_cast<std::ptrdiff_t>(place),
                                std::move(moved));
                });
                break;
            case Verb::Stroke:
            case Verb::Fill:
                good = applyPaint(document, command, scene, images, error);
                break;
            case Verb::Count:
                good = false;
                break;
        }
    message = good ? repair : error;
    return good;
}

}  // namespace fwedit
