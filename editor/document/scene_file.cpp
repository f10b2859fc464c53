// The .fwscene format. The writer emits JSON directly, with a fixed key order and one value per
// line. The reader uses nlohmann's parser and validates everything.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "document/apply.h"
#include "document/document.h"
#include "document/text.h"

namespace fwedit {
namespace {

using nlohmann::json;

// 2: objects that stick to a mesh rotate with it, and may stick to a node of its file.
constexpr int kVersion = 2;
constexpr size_t kMostBytes = size_t{16} << 20;
constexpr size_t kMostRepairs = 100;

// ---- writing

std::string jsonText(std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        result += c;  // scene texts never contain control characters
    }
    return result + '"';
}

std::string listName(Kind kind) {
    return join(kindKey(kind), kind >= Kind::Settings ? "" : kind == Kind::Mesh ? "es" : "s");
}

std::string jsonValue(const FieldInfo& field, const Value& value, const std::string& indent) {
    const auto* list = std::get_if<std::vector<double>>(&value);
    const double* number = std::get_if<double>(&value);
    std::string text;
    switch (field.type) {
        case FieldType::Flag:
            return *number != 0 ? "true" : "false";
        case FieldType::Object:
        case FieldType::Whole:
            return std::to_string(static_cast<uint64_t>(*number));
        case FieldType::Number:
            return printNumber(*number);
        case FieldType::Choice:
            return jsonText(field.choices[static_cast<size_t>(*number)]);
        case FieldType::Text:
        case FieldType::File:
            return jsonText(std::get<std::string>(value));
        case FieldType::Vector:
            for (const double part : *list) text += (text.empty() ? "" : ", ") + printNumber(part);
            return join("[", text, "]");
        case FieldType::Choices:
            for (const double part : *list)
                text +=
                    (text.empty() ? "" : ", ") + jsonText(field.choices[static_cast<size_t>(part)]);
            return join("[", text, "]");
        case FieldType::KeyList:
        case FieldType::Rows:
            if (list->empty()) return "[]";
            for (size_t i = 0; i < list->size(); ++i) {
                const bool first = i % field.width == 0;
                if (first) text += (i == 0 ? "\n" : "],\n") + indent + "  [";
                text += (first ? "" : ", ") + printNumber((*list)[i]);
            }
            return join("[", text, "]\n", indent, "]");
    }
    return text;
}

void printFields(const Scene& scene, Kind kind, ObjectId id, const std::string& indent,
                 std::string& out) {
    bool first = true;
    if (id != 0) {
        out += indent + "\"id\": " + std::to_string(id);
        first = false;
    }
    for (const FieldInfo& field : fieldsOf(kind)) {
        Value value;
        if (!getField(scene, kind, id, field.key, value)) continue;
        out += (first ? "" : ",\n") + indent + "\"" + field.key +
               "\": " + jsonValue(field, value, indent);
        first = false;
    }
    out += "\n";
}

// ---- reading

class SceneReader {
 public:
    SceneReader(std::string name, std::vector<std::string>& repairs)
        : name_(std::move(name)), repairs_(repairs) {}

    bool read(const json& root, Scene& scene, std::string& error) {
        if (!root.is_object())
            return refuse(error, "its root is " + typeOf(root) + ", not an object");
        const auto version = root.find("fwscene");
        if (version == root.end() || !version->is_number_integer())
            return refuse(error, "it has no scene version (\"fwscene\")");
        if (version->get<int64_t>() < 1 || version->get<int64_t>() > kVersion)
            return refuse(error, "fwscene is " + version->dump() + "; this program reads up to " +
                                     std::to_string(kVersion));
        for (const auto& [key, value] : root.items()) noteUnknown(key);
        readFields(root, Kind::Settings, scene, 0, "settings.", "settings");
        readFields(root, Kind::Camera, scene, 0, "camera.", "camera");
        size_t objects = 0;
        bool tooMany = false;
        forEachList(scene, [&](Kind kind, auto& list) {
            const std::string key = listName(kind);
            const auto found = root.find(key);
            if (found == root.end() || tooMany) return;
            if (!found->is_array()) {
                reportRepair(key + " is " + typeOf(*found) + ", not a list; it is now empty");
                return;
            }
            objects += found->size();
            tooMany = objects > kMostObjects;
            if (tooMany) return;
            for (size_t i = 0; i < found->size(); ++i)
                readObject((*found)[i], kind, i, list, scene);
        });
        if (tooMany)
            return refuse(error, "it has more than " + std::to_string(kMostObjects) +
                                     " objects, the most a scene can have");
        repairIds(scene, root);
        std::vector<std::string> references;
        repairReferences(scene, &references);
        for (const std::string& repair : references) reportRepair(repair);
        if (version->get<int64_t>() == 1) convertDirectionsToLocal(scene);
        if (repairCount_ > kMostRepairs)
            repairs_.push_back(name_ + ": " + std::to_string(repairCount_ - kMostRepairs) +
                               " more repairs of this kind");
        return true;
    }

 private:
    bool refuse(std::string& error, const std::string& why) {
        error = name_ + " was not opened: " + why + ".";
        return false;
    }
    void reportRepair(const std::string& what) {
        if (++repairCount_ <= kMostRepairs) repairs_.push_back(name_ + ": " + what + ".");
    }
    static std::string typeOf(const json& value) {
        return std::string(value.is_array()     ? "a list"
                           : value.is_object()  ? "an object"
                           : value.is_string()  ? "a text"
                           : value.is_boolean() ? "true or false"
                           : value.is_null()    ? "null"
                                                : "a number");
    }
    void noteUnknown(const std::string& key) {
        bool known = key == "fwscene" || key == "next_id" || key == "settings" || key == "camera";
        for (uint32_t kind = 0; kind < uint32_t(Kind::Settings); ++kind)
            known = known || key == listName(Kind(kind));
        if (!known)
            reportRepair("\"" + cleanText(key, 80) + "\" is not known here and is left out");
    }

    template <typename T>
    void readObject(const json& from, Kind kind, size_t index, std::vector<T>& list, Scene& scene) {
        const std::string where = listName(kind) + "[" + std::to_string(index) + "]";
        if (!from.is_object()) {
            reportRepair(where + " is " + typeOf(from) + ", not an object; it is left out");
            return;
        }
        T& object = list.emplace_back();
        // While reading, use positions as ids, because setField finds objects by id.
        const auto id = static_cast<ObjectId>(4294967295u - ids_.size());
        object.id = id;
        const auto given = from.find("id");
        const bool fine = given != from.end() && given->is_number_integer() &&
                          given->get<int64_t>() > 0 && given->get<int64_t>() < 2147483648;
        if (!fine)
            reportRepair(where + ".id is " +
                         (given == from.end() ? "missing" : "not an integer above 0") +
                         "; it gets a new one");
        ids_.push_back({id, fine ? static_cast<ObjectId>(given->get<int64_t>()) : 0, where});
        readFields(from, kind, scene, id, where + ".", "");
        if (object.name.empty()) object.name = kindLabel(kind);
    }

    // `member`: of `from`, with the fields; empty: `from` itself.
    void readFields(const json& from, Kind kind, Scene& scene, ObjectId id,
                    const std::string& where, const std::string& member) {
        const json* fields = &from;
        if (!member.empty()) {
            const auto found = from.find(member);
            if (found == from.end()) return;
            if (!found->is_object()) {
                reportRepair(member + " is " + typeOf(*found) +
                             ", not an object; it keeps its defaults");
                return;
            }
            fields = &*found;
        }
        for (const auto& [key, given] : fields->items()) {
            if (key == "id") continue;
            const FieldInfo* info = findField(kind, key);
            if (!info) {
                reportRepair(where + cleanText(key, 80) + " is not known here and is left out");
                continue;
            }
            Value value;
            std::string repair, error;
            if (!valueOf(given, *info, value, error) ||
                !setField(scene, kind, id, key, value, repair, error))
                reportRepair(where + error + "; it keeps the default of a new " + kindKey(kind));
            else if (!repair.empty())
                reportRepair(where + repair);
        }
    }

    static bool valueOf(const json& given, const FieldInfo& info, Value& value,
                        std::string& error) {
        const auto wrong = [&](const char* takes) {
            error = std::string(info.key) + " is " + typeOf(given) + "; it takes " + takes;
            return false;
        };
        switch (info.type) {
            case FieldType::Flag:
                if (!given.is_boolean()) return wrong("true or false");
                return value = given.get<bool>() ? 1.0 : 0.0, true;
            case FieldType::Object:
            case FieldType::Whole:
            case FieldType::Number:
                if (!given.is_number()) return wrong("a number");
                return value = given.get<double>(), true;
            case FieldType::Choice: {
                double number = 0;
                if (!choiceOf(given, info, number, error)) return false;
                return value = number, true;
            }
            case FieldType::Text:
            case FieldType::File:
                if (!given.is_string()) return wrong("a text");
                return value = given.get<std::string>(), true;
            case FieldType::Vector:
            case FieldType::Choices:
            case FieldType::KeyList:
            case FieldType::Rows:
                break;
        }
        if (!given.is_array()) return wrong("a list");
        std::vector<double> list;
        for (const json& part : given) {
            const bool rows = info.type == FieldType::KeyList || info.type == FieldType::Rows;
            double number = 0;
            if (info.type == FieldType::Choices) {
                if (!choiceOf(part, info, number, error)) return false;
                list.push_back(number);
            } else if (!rows) {
                if (!part.is_number()) return wrong("numbers");
                list.push_back(part.get<double>());
            } else {
                if (!part.is_array() || part.size() != info.width) {
                    error = std::string(info.key) + " takes rows of " + std::to_string(info.width) +
                            " numbers";
                    return false;
                }
                for (const json& one : part) {
                    if (!one.is_number()) return wrong("rows of numbers");
                    list.push_back(one.get<double>());
                }
            }
        }
        return value = list, true;
    }

    static bool choiceOf(const json& given, const FieldInfo& info, double& number,
                         std::string& error) {
        const std::string word = given.is_string() ? given.get<std::string>() : "";
        for (size_t i = 0; i < info.choices.size(); ++i)
            if (word == info.choices[i]) return number = static_cast<double>(i), true;
        std::string all;
        for (const char* choice : info.choices)
            all += (all.empty() ? "" : ", ") + std::string(choice);
        error = std::string(info.key) + " is " +
                (given.is_string() ? "\"" + cleanText(word, 80) + "\"" : typeOf(given)) +
                "; it takes " + all;
        return false;
    }

    // Assigns the file's ids. Objects with duplicate or missing ids get new ones.
    void repairIds(Scene& scene, const json& root) {
        std::vector<ObjectId> used;
        ObjectId highest = 0;
        for (const Given& given : ids_) highest = std::max(highest, given.id);
        for (Given& given : ids_) used.push_back(given.id);
        std::sort(used.begin(), used.end());
        std::vector<ObjectId> seen;
        for (Given& given : ids_) {
            const auto range = std::equal_range(used.begin(), used.end(), given.id);
            const bool shared = given.id != 0 && range.second - range.first > 1;
            if (shared) {
                // The first object keeps it.
                if (std::find(seen.begin(), seen.end(), given.id) != seen.end()) {
                    reportRepair(given.where + ".id is " + std::to_string(given.id) +
                                 ", which another object has; it is now " +
                                 std::to_string(highest + 1));
                    given.id = ++highest;
                } else {
                    seen.push_back(given.id);
                }
            }
            if (given.id == 0) given.id = ++highest;
            if (Object* object = findObject(scene, given.place)) object->id = given.id;
        }
        scene.nextId = highest + 1;
        const auto next = root.find("next_id");
        if (next != root.end() && next->is_number_integer() && next->get<int64_t>() > highest &&
            next->get<int64_t>() < 4000000000)
            scene.nextId = static_cast<ObjectId>(next->get<int64_t>());
        else if (next != root.end())
            reportRepair("next_id is " + cleanText(next->dump(-1, ' ', true), 80) +
                         "; it must be above every id; it is now " + std::to_string(scene.nextId));
    }

    // Version 1 stored world directions for attached objects.
    static void convertDirectionsToLocal(Scene& scene) {
        forEachList(scene, [&](Kind, auto& list) {
            for (auto& object : list) {
                if constexpr (requires { object.direction; }) {
                    const Vec3 position = object.position;
                    keepInWorld(scene, object.id, kWorldPose, parentPose(scene, object.id));
                    object.position = position;  // already local
                }
            }
        });
    }

    struct Given {
        ObjectId place, id;
        std::string where;
    };
    std::string name_;
    std::vector<std::string>& repairs_;
    size_t repairCount_ = 0;
    std::vector<Given> ids_;
};

}  // namespace

std::string printScene(const Scene& scene) {
    std::string out = "{\n  \"fwscene\": " + std::to_string(kVersion) + ",\n";
    out += "  \"next_id\": " + std::to_string(scene.nextId) + ",\n";
    for (const Kind kind : {Kind::Settings, Kind::Camera}) {
        out += std::string("  \"") + kindKey(kind) + "\": {\n";
        printFields(scene, kind, 0, "    ", out);
        out += "  },\n";
    }
    forEachList(scene, [&](Kind kind, const auto& list) {
        out += "  \"" + listName(kind) + "\": [";
        for (size_t i = 0; i < list.size(); ++i) {
            out += i == 0 ? "\n    {\n" : ",\n    {\n";
            printFields(scene, kind, list[i].id, "      ", out);
            out += "    }";
        }
        out += std::string(list.empty() ? "]" : "\n  ]") + (kind == Kind::Event ? "\n" : ",\n");
    });
    return out + "}\n";
}

bool readScene(std::string_view text, const std::string& name, Scene& scene,
               std::vector<std::string>& repairs, std::string& error) {
    if (text.size() > kMostBytes) {
        error = name + " was not opened: it has " + std::to_string(text.size()) + " bytes, above " +
                std::to_string(kMostBytes) + ".";
        return false;
    }
    try {
        const json root = json::parse(text);
        Scene fresh;
        if (!SceneReader(name, repairs).read(root, fresh, error)) return false;
        scene = std::move(fresh);
        return true;
    } catch (const json::exception& failure) {
        std::string why = failure.what();
        const size_t bracket = why.find("] ");
        if (bracket != std::string::npos) why = why.substr(bracket + 2);
        error = name + " was not opened: " + cleanText(why, 300) + ".";
    }
    return false;
}

}  // namespace fwedit
