#include "document/command.h"

#include <algorithm>
#include <charconv>

#include "document/text.h"

namespace fwedit {
namespace {

struct Word {
    std::string text;
    bool inQuotes = false;
};

bool split(std::string_view line, std::vector<Word>& words, std::string& error) {
    constexpr std::string_view kBlank = " \t\r\n";
    size_t at = 0;
    words.clear();
    while ((at = line.find_first_not_of(kBlank, at)) != std::string_view::npos) {
        if (line.substr(at, 2) == "//") break;
        Word word;
        bool open = false;
        for (; at < line.size() && (open || kBlank.find(line[at]) == std::string_view::npos);
             ++at) {
            if (line[at] == '"') {
                open = !open;
                word.inQuotes = true;
            } else if (open && line[at] == '\\' && at + 1 < line.size()) {
                word.text += line[++at];
            } else {
                word.text += line[at];
            }
        }
        if (open) {
            error = "A quote is not closed: \"" + word.text;
            return false;
        }
        words.push_back(std::move(word));
    }
    return true;
}

constexpr const char* kVerbs[] = {"add",    "set",   "move",   "key",    "unkey", "duplicate",
                                  "remove", "order", "import", "stroke", "fill"};
static_assert(std::size(kVerbs) == size_t(Verb::Count));
constexpr const char* kModes[] = {"paint", "erase", "smooth"};
constexpr const char* kFills[] = {"all", "island", "piece", "material", "slope", "curvature"};

template <size_t N>
size_t indexOf(const char* const (&words)[N], std::string_view word) {
    return static_cast<size_t>(std::find(words, words + N, word) - words);
}
template <size_t N>
std::string listOf(const char* const (&words)[N]) {
    std::string list;
    for (const char* word : words) list += (list.empty() ? "" : ", ") + std::string(word);
    return list;
}

// Reads the words of a line in order. Errors list the expected word.
class Reader {
 public:
    Reader(std::vector<Word> words, std::string& error) : words_(std::move(words)), error_(error) {}

    [[nodiscard]] bool done() const { return at_ == words_.size(); }
    [[nodiscard]] const Word& peek() const { return words_[at_]; }
    bool next(std::string& text, const char* needed) {
        if (done()) return refuse(std::string("The line ends where ") + needed + " is needed");
        text = words_[at_++].text;
        return true;
    }
    bool number(float& value, const char* name, double low, double high) {
        std::string text;
        if (!next(text, name)) return false;
        const char* end = text.data() + text.size();
        float read = 0;
        const auto [at, code] = std::from_chars(text.data(), end, read);
        if (code != std::errc{} || at != end || !(read >= low && read <= high))
            return refuse(std::string(name) + " is \"" + text + "\"; it takes a number from " +
                          printNumber(low) + " to " + printNumber(high));
        value = read;
        return true;
    }
    bool vector(Vec3& value, const char* name) {
        for (float& part : value)
            if (!number(part, name, -1e6, 1e6)) return false;
        return true;
    }
    // "1:2:3 4:5:6"
    bool points(std::vector<Vec3>& list, const char* name) {
        list.clear();
        while (!done() && peek().text.find(':') != std::string::npos) {
            const std::string text = words_[at_++].text;
            const char *from = text.data(), *end = from + text.size();
            Vec3 point{};
            for (size_t k = 0; k < 3; ++k) {
                const auto [at, code] = std::from_chars(from, end, point[k]);
                const bool last = k == 2;
                if (code != std::errc{} || !(std::abs(point[k]) <= 1e6f) ||
                    (last ? at != end : at == end || *at != ':'))
                    return refuse(std::string(name) + " holds \"" + text +
                                  "\"; it takes x:y:z, each within 1000000 m");
                from = at + 1;
            }
            list.push_back(point);
        }
        return true;
    }
    bool refuse(std::string why) {
        error_ = std::move(why);
        return false;
    }

    // Names in quotes and ids. The first name may be unquoted.
    bool targets(const Scene& scene, std::vector<ObjectId>& ids, bool several) {
        do {
            std::string text;
            if (!next(text, "an object's name or #id")) return false;
            const ObjectId id = findByWord(scene, text);
            if (id == 0) return refuse("There is no object \"" + text + "\" in this scene");
            if (std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
        } while (several && !done() &&
                 (peek().inQuotes || (!peek().text.empty() && peek().text[0] == '#')) &&
                 peek().text.find('=') == std::string::npos);
        return true;
    }

    // "field value ... field=value ..."
    bool fields(const Scene& scene, Kind kind, std::vector<Assignment>& assignments) {
        while (!done()) {
            std::string key;
            if (!next(key, "a field")) return false;
            std::vector<std::string> rest;
            const size_t equals = key.find('=');
            if (equals != std::string::npos) {
                rest.push_back(key.substr(equals + 1));
                key.resize(equals);
            }
            for (size_t i = at_; i < words_.size(); ++i) rest.push_back(words_[i].text);
            const FieldInfo* info = findField(kind, key);
            if (!info)
                return refuse(std::string("A ") + kindKey(kind) + " has no field \"" + key + "\"");
            const size_t count = wordsOfValue(*info, rest);
            Assignment made{key, {}};
            if (!parseValue(scene, *info, std::span(rest).first(count), made.value, error_))
                return false;
            at_ += count - (equals != std::string::npos ? 1 : 0);
            assignments.push_back(std::move(made));
        }
        return true;
    }

 private:
    std::vector<Word> words_;
    size_t at_ = 0;
    std::string& error_;
};

// The field whose value may follow the kind directly: "add source point".
const FieldInfo* leadingField(Kind kind) {
    for (const char* key : {"shape", "preset", "kind"})
        if (const FieldInfo* info = findField(kind, key)) return info;
    return nullptr;
}

bool parseAdd(Reader& reader, const Scene& scene, Command& command) {
    std::string word;
    if (!reader.next(word, "what to add")) return false;
    if (!kindOfKey(word, command.kind) || command.kind >= Kind::Settings)
        return reader.refuse("\"" + word +
                             "\" cannot be added; mesh, source, flame, emitter, wind, collider, "
                             "layer and event can");
    const FieldInfo* leading = leadingField(command.kind);
    if (leading && !reader.done() && !reader.peek().inQuotes)
        for (size_t i = 0; i < leading->choices.size(); ++i)
            if (reader.peek().text == leading->choices[i]) {
                command.fields.push_back({leading->key, static_cast<double>(i)});
                if (!reader.next(word, "a word")) return false;
                break;
            }
    return reader.fields(scene, command.kind, command.fields);
}

bool parseSet(Reader& reader, const Scene& scene, Command& command) {
    std::string word;
    if (!reader.done() && !reader.peek().inQuotes &&
        (reader.peek().text == "settings" || reader.peek().text == "camera")) {
        if (!reader.next(word, "a target")) return false;
        command.kind = word == "settings" ? Kind::Settings : Kind::Camera;
    } else {
        if (!reader.targets(scene, command.targets, true)) return false;
        findObject(scene, command.targets[0], &command.kind);
        for (const ObjectId id : command.targets) {
            Kind kind{};
            findObject(scene, id, &kind);
            // With several kinds, a field must have the same meaning in all of them. The first kind
            // parses it; all apply it by name.
            if (kind >= Kind::Settings) return reader.refuse("Settings are set by themselves");
        }
    }
    if (!reader.fields(scene, command.kind, command.fields)) return false;
    if (command.fields.empty()) return reader.refuse("set names no field");
    return true;
}

bool parseStroke(Reader& reader, Stroke& stroke) {
    while (!reader.done()) {
        std::string key, word;
        if (!reader.next(key, "a word")) return false;
        if (key == "mode") {
            if (!reader.next(word, "a mode")) return false;
            const size_t mode = indexOf(kModes, word);
            if (mode == std::size(kModes))
                return reader.refuse("mode is \"" + word + "\"; it takes " + listOf(kModes));
            stroke.mode = BrushMode(mode);
        } else if (key == "size") {
            if (!reader.number(stroke.size, "size", 0, 1000)) return false;
        } else if (key == "value") {
            if (!reader.number(stroke.value, "value", 0, 13)) return false;
        } else if (key == "strength") {
            if (!reader.number(stroke.strength, "strength", 0, 1)) return false;
        } else if (key == "hardness") {
            if (!reader.number(stroke.hardness, "hardness", 0, 1)) return false;
        } else if (key == "mirror") {
            if (!reader.next(word, "yes or no")) return false;
            if (word != "yes" && word != "no")
                return reader.refuse("mirror is \"" + word + "\"; it takes yes or no");
            stroke.mirror = word == "yes";
        } else if (key == "path") {
            if (!reader.points(stroke.path, "path")) return false;
        } else if (key == "normals") {
            if (!reader.points(stroke.normals, "normals")) return false;
        } else {
            return reader.refuse("A stroke has no \"" + key +
                                 "\"; it takes mode, size, value, strength, hardness, mirror, "
                                 "path, normals");
        }
    }
    if (stroke.path.empty()) return reader.refuse("The stroke's path has no points");
    if (!stroke.normals.empty() && stroke.normals.size() != stroke.path.size())
        return reader.refuse("The stroke has " + std::to_string(stroke.normals.size()) +
                             " normals for " + std::to_string(stroke.path.size()) + " points");
    return true;
}

bool parseFill(Reader& reader, FillRequest& fill) {
    while (!reader.done()) {
        std::string key, word;
        if (!reader.next(key, "a word")) return false;
        if (key == "by") {
            if (!reader.next(word, "what to fill by")) return false;
            const size_t by = indexOf(kFills, word);
            if (by == std::size(kFills))
                return reader.refuse("by is \"" + word + "\"; it takes " + listOf(kFills));
            fill.by = FillBy(by);
        } else if (key == "value") {
            if (!reader.number(fill.value, "value", 0, 13)) return false;
        } else if (key == "at") {
            if (!reader.vector(fill.at, "at")) return false;
        } else if (key == "slot") {
            float slot = 0;
            if (!reader.number(slot, "slot", 0, 7)) return false;
            fill.material = static_cast<uint32_t>(slot);
        } else if (key == "slope") {
            if (!reader.number(fill.slopeLow, "slope", 0, 180) ||
                !reader.number(fill.slopeHigh, "slope", 0, 180))
                return false;
        } else if (key == "curvature") {
            if (!reader.number(fill.curveLow, "curvature", -1e5, 1e5) ||
                !reader.number(fill.curveHigh, "curvature", -1e5, 1e5))
                return false;
        } else {
            return reader.refuse("A fill has no \"" + key +
                                 "\"; it takes by, value, at, slot, slope, curvature");
        }
    }
    return true;
}

std::string pointList(const std::vector<Vec3>& points) {
    std::string text;
    for (const Vec3& p : points)
        text += join(" ", printNumber(p[0]), ":", printNumber(p[1]), ":", printNumber(p[2]));
    return text;
}

std::string vectorWords(const Vec3& v) {
    return printNumber(v[0]) + " " + printNumber(v[1]) + " " + printNumber(v[2]);
}

std::string nameOf(const Scene& scene, const std::vector<ObjectId>& targets) {
    if (targets.size() != 1) return std::to_string(targets.size()) + " objects";
    const Object* object = findObject(scene, targets[0]);
    return object ? object->name : "";
}

std::string lower(std::string text) {
    if (!text.empty() && text[0] >= 'A' && text[0] <= 'Z')
        text[0] = static_cast<char>(text[0] + 32);
    return text;
}

std::string setName(const Scene& before, const Command& command) {
    const std::string& key = command.fields[0].field;
    const FieldInfo* info = findField(command.kind, key);
    const std::string label = info ? info->label : key;
    if (command.targets.empty())
        return command.kind == Kind::Camera ? "Move the camera" : label + " of the scene";
    const std::string who = nameOf(before, command.targets);
    const double* number = std::get_if<double>(&command.fields[0].value);
    const bool on = number && *number != 0;
    if (key == "name") return "Rename " + who;
    if (key == "position") return "Move " + who;
    if (key == "rotation") return "Turn " + who;
    if (key == "scale") return "Scale " + who;
    if (key == "hidden") return (on ? "Hide " : "Show ") + who;
    if (key == "locked") return (on ? "Lock " : "Unlock ") + who;
    if (key == "sticks_to_node") return "Attach " + who;
    if (key == "sticks_to") return (on ? "Attach " : "Detach ") + who;
    return label + " of " + who;
}

std::string paintName(const Scene& before, const Command& command, const std::string& verb) {
    const PaintLayer* layer =
        command.targets.empty() ? nullptr : findIn(before.layers, command.targets[0]);
    if (!layer) return verb;
    static constexpr const char* kWhat[] = {"burn multiplier", "moisture", "material"};
    const Mesh* mesh = findIn(before.meshes, layer->mesh);
    return verb + " " + kWhat[std::min<uint32_t>(layer->kind, 2)] +
           (mesh ? " on " + mesh->name : "");
}

}  // namespace

bool splitWords(std::string_view line, std::vector<std::string>& words, std::string& error) {
    std::vector<Word> read;
    if (!split(line, read, error)) return false;
    words.clear();
    for (Word& word : read) words.push_back(std::move(word.text));
    return true;
}

bool parseCommand(const Scene& scene, std::string_view line, Command& command, std::string& error) {
    std::vector<Word> words;
    if (!split(line, words, error)) return false;
    Reader reader(std::move(words), error);
    std::string verb, word;
    if (!reader.next(verb, "a command")) return false;
    Command made;
    const bool rename = verb == "rename";
    const size_t number = rename ? size_t(Verb::Set) : indexOf(kVerbs, verb);
    if (number == size_t(Verb::Count))
        return reader.refuse("\"" + verb + "\" is no command; there are " + listOf(kVerbs));
    made.verb = Verb(number);
    float value = 0;
    bool good = true;
    if (rename) {
        good = reader.targets(scene, made.targets, false) && reader.next(word, "a name");
        if (good) findObject(scene, made.targets[0], &made.kind);
        made.fields.push_back({"name", word});
    } else {
        switch (made.verb) {
            case Verb::Add:
                good = parseAdd(reader, scene, made);
                break;
            case Verb::Set:
                good = parseSet(reader, scene, made);
                break;
            case Verb::Move:
                good = reader.targets(scene, made.targets, true) &&
                       reader.vector(made.offset, "the offset");
                break;
            case Verb::Key:
            case Verb::Unkey:
                good = reader.targets(scene, made.targets, false) &&
                       reader.number(made.key.time, "time", 0, 1e6) &&
                       (made.verb == Verb::Unkey ||
                        reader.number(made.key.value, "value", -1000, 1000));
                break;
            case Verb::Duplicate:
            case Verb::Remove:
                good = reader.targets(scene, made.targets, true);
                break;
            case Verb::Order:
                good = reader.targets(scene, made.targets, false) &&
                       reader.number(value, "the place", 0, 100000);
                made.index = static_cast<uint32_t>(value);
                break;
            case Verb::Import:
                made.kind = Kind::Mesh;
                good = reader.next(made.file, "a file") &&
                       reader.fields(scene, Kind::Mesh, made.fields);
                break;
            case Verb::Stroke:
                good =
                    reader.targets(scene, made.targets, false) && parseStroke(reader, made.stroke);
                break;
            case Verb::Fill:
                good = reader.targets(scene, made.targets, false) && parseFill(reader, made.fill);
                break;
            case Verb::Count:
                return false;
        }
    }
    if (!good) return false;
    if (!reader.done()) return reader.refuse("\"" + reader.peek().text + "\" is an extra word");
    command = std::move(made);
    return true;
}

std::string printCommand(const Scene& scene, const Command& command) {
    std::string text = kVerbs[size_t(command.verb)];
    if (command.verb == Verb::Add) text += std::string(" ") + kindKey(command.kind);
    if (command.verb == Verb::Import) text += join(" ", inQuotes(command.file));
    if (command.verb == Verb::Set && command.targets.empty())
        text += std::string(" ") + kindKey(command.kind);
    for (const ObjectId id : command.targets) text += join(" #", std::to_string(id));
    for (const Assignment& made : command.fields) {
        const FieldInfo* info = findField(command.kind, made.field);
        if (info) text += join(" ", made.field, " ", printValue(scene, *info, made.value));
    }
    switch (command.verb) {
        case Verb::Move:
            return text + " " + vectorWords(command.offset);
        case Verb::Key:
            return text + " " + printNumber(command.key.time) + " " +
                   printNumber(command.key.value);
        case Verb::Unkey:
            return text + " " + printNumber(command.key.time);
        case Verb::Order:
            return text + " " + std::to_string(command.index);
        case Verb::Stroke: {
            const Stroke& stroke = command.stroke;
            text += std::string(" mode ") + kModes[size_t(stroke.mode)] + " size " +
                    printNumber(stroke.size) + " value " + printNumber(stroke.value) +
                    " strength " + printNumber(stroke.strength) + " hardness " +
                    printNumber(stroke.hardness) + " mirror " + (stroke.mirror ? "yes" : "no") +
                    " path" + pointList(stroke.path);
            return stroke.normals.empty() ? text : text + " normals" + pointList(stroke.normals);
        }
        case Verb::Fill: {
            const FillRequest& fill = command.fill;
            text +=
                std::string(" value ") + printNumber(fill.value) + " by " + kFills[size_t(fill.by)];
            if (fill.by == FillBy::Island || fill.by == FillBy::Piece)
                text += join(" at ", vectorWords(fill.at));
            if (fill.by == FillBy::Material) text += join(" slot ", std::to_string(fill.material));
            if (fill.by == FillBy::Slope)
                text += " slope " + printNumber(fill.slopeLow) + " " + printNumber(fill.slopeHigh);
            if (fill.by == FillBy::Curvature)
                text +=
                    " curvature " + printNumber(fill.curveLow) + " " + printNumber(fill.curveHigh);
            return text;
        }
        default:
            return text;
    }
}

std::string undoName(const Scene& before, const Command& command) {
    const std::string who = nameOf(before, command.targets);
    switch (command.verb) {
        case Verb::Add:
            return "Add " + lower(kindLabel(command.kind));
        case Verb::Set:
            return shortened(setName(before, command));
        case Verb::Move:
            return shortened("Move " + who);
        case Verb::Key:
            return shortened("Key output of " + who);
        case Verb::Unkey:
            return shortened("Remove a key of " + who);
        case Verb::Duplicate:
            return shortened("Duplicate " + who);
        case Verb::Remove:
            return shortened("Delete " + who);
        case Verb::Order:
            return shortened("Reorder " + who);
        case Verb::Import: {
            const size_t slash = command.file.find_last_of('/');
            return shortened("Import " + (slash == std::string::npos
                                              ? command.file
                                              : command.file.substr(slash + 1)));
        }
        case Verb::Stroke:
            return shortened(paintName(before, command,
                                       command.stroke.mode == BrushMode::Paint   ? "Paint"
                                       : command.stroke.mode == BrushMode::Erase ? "Erase"
                                                                                 : "Smooth"));
        case Verb::Fill:
            return shortened(paintName(before, command, "Fill"));
        case Verb::Count:
            break;
    }
    return "";
}

}  // namespace fwedit
