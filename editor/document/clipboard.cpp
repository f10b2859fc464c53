// See clipboard.h.
#include "document/clipboard.h"

#include <algorithm>
#include <cstring>
#include <sstream>

#include "document/apply.h"
#include "document/text.h"

namespace fwedit {
namespace {

constexpr size_t kMostPasted = size_t{1} << 20;  // bytes

// Prints only fields that differ from a new object.
std::string lineOf(const Scene& scene, Kind kind, ObjectId id) {
    Scene plain;
    PaintImages none;
    std::string message;
    ObjectId fresh = 0;
    Command add;
    add.verb = Verb::Add;
    add.kind = kind;
    applyCommand(newDocument(), add, plain, none, message, fresh);
    std::string parent;
    for (const FieldInfo& field : fieldsOf(kind)) {
        Value value, standard;
        if (!getField(scene, kind, id, field.key, value) ||
            (getField(plain, kind, fresh, field.key, standard) && value == standard))
            continue;
        if (!std::strcmp(field.key, "sticks_to_node")) {  // written after the mesh that has the
                                                          // node
            parent += std::string(" ") + field.key + " " + inQuotes(std::get<std::string>(value));
            continue;
        }
        if (field.type != FieldType::Object) {
            add.fields.push_back({field.key, std::move(value)});
            continue;
        }
        // By name, because ids differ between scenes.
        const Object* object = findObject(scene, static_cast<ObjectId>(std::get<double>(value)));
        if (object) parent = std::string(" ") + field.key + " " + inQuotes(object->name);
    }
    return printCommand(scene, add) + parent + "\n";
}

// Drops a "sticks_to" of a name that does not exist in this scene.
bool parseLine(const Scene& scene, const std::string& line, Command& command,
               std::string& message) {
    if (parseCommand(scene, line, command, message)) return true;
    const size_t parent = line.rfind(" sticks_to ");
    std::string ignored;
    return parent != std::string::npos &&
           parseCommand(scene, line.substr(0, parent), command, ignored);
}

}  // namespace

std::string copyObjects(const Scene& scene, std::span<const ObjectId> objects) {
    std::string text;
    for (const ObjectId id : objects) {
        Kind kind{};
        if (findObject(scene, id, &kind) && kind != Kind::Layer) text += lineOf(scene, kind, id);
    }
    return text;
}

bool pasteObjects(Document& document, std::string_view text, std::vector<ObjectId>& added,
                  std::string& message) {
    added.clear();
    const char* const kNone = "The clipboard contains no object of a scene";
    message = kNone;
    if (text.size() > kMostPasted) return false;
    std::istringstream lines{std::string(text)};
    beginDrag(document);
    bool good = true;
    for (std::string line; good && std::getline(lines, line);) {
        if (line.empty()) continue;
        Command command;
        good = line.starts_with("add ");
        if (!good) message = kNone;
        good = good && parseLine(document.scene, line, command, message);
        if (!good) break;
        for (Assignment& field : command.fields)
            if (std::string* name = std::get_if<std::string>(&field.value);
                name && field.field == "name")
                *name = freeName(document.scene, *name);
        ObjectId id = 0;
        good = run(document, command, message, &id);
        if (good) added.push_back(id);
    }
    if (!good || added.empty()) {
        cancelDrag(document);
        added.clear();
        return false;
    }
    const Object* first = findObject(document.scene, added.front());
    document.dragName = added.size() == 1 ? shortened("Paste " + first->name)
                                          : "Paste " + std::to_string(added.size()) + " objects";
    endDrag(document);
    message.clear();
    return true;
}

}  // namespace fwedit
