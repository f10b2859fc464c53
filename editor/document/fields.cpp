// The field tables come first. To give an object a field, add a line there.
#include "document/fields.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include "document/flame_curve.h"
#include "document/text.h"
#include "flamewright/flamewright.h"

namespace fwedit {
namespace {

using Slots = std::array<uint32_t, 8>;
using Pins = std::vector<std::array<float, 7>>;

template <typename T>
using Member = std::variant<bool T::*, uint32_t T::*, float T::*, std::string T::*, Vec3 T::*,
                            Slots T::*, Keys T::*, Pins T::*>;
template <typename T>
struct Entry {
    FieldInfo info;
    Member<T> member;
};
template <typename T>
struct Table {
    std::vector<FieldInfo> infos;
    std::vector<Member<T>> members;

    Table(std::vector<Entry<T>> entries) {
        for (Entry<T>& entry : entries) {
            infos.push_back(std::move(entry.info));
            members.push_back(entry.member);
        }
    }
};

constexpr double kFar = 1e6;           // m; the plugin's limit for positions
constexpr double kMostCelsius = 2700;  // for a flame

template <typename T>
Entry<T> flag(const char* key, const char* label, bool T::*member) {
    return {{key, label, "", FieldType::Flag, 0, 1, 1, {}}, member};
}
template <typename T>
Entry<T> whole(const char* key, const char* label, const char* unit, double low, double high,
               uint32_t T::*member) {
    return {{key, label, unit, FieldType::Whole, low, high, 1, {}}, member};
}
template <typename T>
Entry<T> number(const char* key, const char* label, const char* unit, double low, double high,
                float T::*member) {
    return {{key, label, unit, FieldType::Number, low, high, 1, {}}, member};
}
template <typename T>
Entry<T> choice(const char* key, const char* label, std::vector<const char*> words,
                uint32_t T::*member) {
    const double last = static_cast<double>(words.size()) - 1;
    return {{key, label, "", FieldType::Choice, 0, last, 1, std::move(words)}, member};
}
template <typename T>
Entry<T> words(const char* key, const char* label, FieldType type, std::string T::*member) {
    return {{key, label, "", type, 0, 0, 1, {}}, member};
}
template <typename T>
Entry<T> object(const char* key, const char* label, ObjectId T::*member) {
    return {{key, label, "", FieldType::Object, 0, 4294967295.0, 1, {}}, member};
}
template <typename T>
Entry<T> vector(const char* key, const char* label, const char* unit, double low, double high,
                Vec3 T::*member) {
    return {{key, label, unit, FieldType::Vector, low, high, 3, {}}, member};
}
template <typename T>
Entry<T> keys(const char* label, Keys T::*member) {
    return {{"keys", label, "", FieldType::KeyList, 0, 1e6, 2, {}}, member};
}
// Points of a line over [0, 1].
template <typename T>
Entry<T> points(const char* key, const char* label, double most, Keys T::*member) {
    return {{key, label, "", FieldType::KeyList, 0, 1, 2, {}, 0, most}, member};
}

template <typename T>
Table<T> withObject(std::vector<Entry<T>> own) {
    std::vector<Entry<T>> all = {words<T>("name", "Name", FieldType::Text, &T::name)};
    all.insert(all.end(), std::make_move_iterator(own.begin()), std::make_move_iterator(own.end()));
    all.push_back(flag<T>("hidden", "Hidden", &T::hidden));
    all.push_back(flag<T>("locked", "Locked", &T::locked));
    return Table<T>(std::move(all));
}

template <typename T>
const Table<T>& tableOf();

template <>
const Table<Mesh>& tableOf() {
    static const Table<Mesh> table = withObject<Mesh>({
        words("file", "File", FieldType::File, &Mesh::file),
        words("node", "Part of the file", FieldType::Text, &Mesh::node),
        vector("position", "Position", "m", -kFar, kFar, &Mesh::position),
        vector("rotation", "Rotation", "°", -3600, 3600, &Mesh::rotation),
        vector("scale", "Scale", "", -1000, 1000, &Mesh::scale),
        {{"materials", "Materials", "", FieldType::Choices, 0, FW_MATERIAL_PRESET_COUNT - 1, 8,
          materialWords()},
         &Mesh::materials},
        number("thickness", "Thickness", "m", 0, 10, &Mesh::thickness),
        number("moisture", "Moisture", "", 0, 2, &Mesh::moisture),
        vector("tint", "Tint", "", 0, 10, &Mesh::tint),
        choice("deform", "Changes shape", {"none", "recede", "sheet", "springs"}, &Mesh::deform),
        {{"pins", "Pins", "m", FieldType::Rows, -kFar, kFar, 7, {}}, &Mesh::pins},
        flag("refine", "Finer where it burns", &Mesh::refine),
        whole("refine_depth", "How much finer", "", 0, 5, &Mesh::refineDepth),
        flag("two_sided", "Two-sided", &Mesh::twoSided),
        flag("holes", "Breaks open", &Mesh::holes),
        flag("spreads", "Fire leaves it", &Mesh::spreads),
        number("spread_chance", "Chance of a jump", "", 0, 1, &Mesh::spreadChance),
        whole("map_size", "Size of the map", "px", 8, 4096, &Mesh::mapSize),
        number("texels_per_metre", "Sharpness of the map", "px/m", 0.01, 4096,
               &Mesh::texelsPerMetre),
    });
    return table;
}

template <typename T>
void addSpan(std::vector<Entry<T>>& entries, const char* keysLabel) {
    entries.push_back(number<T>("start", "Starts at", "s", 0, 1e6, &T::start));
    entries.push_back(number<T>("duration", "Lasts", "s", 0, 1e6, &T::duration));
    entries.push_back(keys<T>(keysLabel, &T::keys));
}

template <>
const Table<HeatSource>& tableOf() {
    static const Table<HeatSource> table = [] {
        std::vector<Entry<HeatSource>> own = {
            choice("shape", "Shape",
                   {"match", "point", "disc", "line", "flamethrower", "rain", "water"},
                   &HeatSource::shape),
            vector("position", "Position", "m", -kFar, kFar, &HeatSource::position),
            vector("direction", "Direction", "", -1000, 1000, &HeatSource::direction),
            number("output", "Output", "kW", 0, 100000, &HeatSource::output),
            number("radius", "Radius", "m", 0, 20, &HeatSource::radius),
            number("length", "Length", "m", 0, 100, &HeatSource::length),
        };
        addSpan(own, "Keys of the output");
        own.push_back(object("sticks_to", "Sticks to", &HeatSource::sticksTo));
        own.push_back(
            words("sticks_to_node", "At its part", FieldType::Text, &HeatSource::sticksToNode));
        return withObject<HeatSource>(std::move(own));
    }();
    return table;
}

template <>
const Table<Flame>& tableOf() {
    static const Table<Flame> table = [] {
        std::vector<Entry<Flame>> own = {
            choice("preset", "Look",
                   {"camp", "candle", "torch", "bonfire", "house", "gas_burner", "magic_blue",
                    "magic_green", "dying_embers"},
                   &Flame::preset),
            words("profile", "Flame shape", FieldType::File, &Flame::profile),
            points("outline", "Outline", double(kShapeReach), &Flame::outline),
            points("stops", "Temperatures", kMostCelsius, &Flame::stops),
            vector("position", "Position", "m", -kFar, kFar, &Flame::position),
            number("diameter", "Width", "m", 0.002, 20, &Flame::diameter),
            number("power", "Output", "kW", 0, 100000, &Flame::power),
            number("wind_response", "Bends in the wind", "", 0, 4, &Flame::windResponse),
            number("turbulence", "Break-up", "", 0, 3, &Flame::turbulence),
            number("speed", "Rise", "", 0, 4, &Flame::speed),
            number("density", "Density", "", 0, 10, &Flame::density),
            number("smoke", "Smoke", "", 0, 10, &Flame::smoke),
            number("blue", "Blue at its foot", "", 0, 10, &Flame::blue),
            vector("tint", "Own colour", "", 0, 1, &Flame::tint),
            number("tint_weight", "Share of own colour", "", 0, 1, &Flame::tintWeight),
            vector("core_tint", "Colour of its core", "", 0, 1, &Flame::coreTint),
            number("core_tint_weight", "Share of its core", "", 0, 1, &Flame::coreTintWeight),
            flag("ignites", "Lights what it touches", &Flame::ignites),
        };
        addSpan(own, "Keys of the output");
        own.push_back(object("sticks_to", "Sticks to", &Flame::sticksTo));
        own.push_back(
            words("sticks_to_node", "At its part", FieldType::Text, &Flame::sticksToNode));
        return withObject<Flame>(std::move(own));
    }();
    return table;
}

template <>
const Table<Emitter>& tableOf() {
    static const Table<Emitter> table = [] {
        std::vector<Entry<Emitter>> own = {
            choice("shape", "Shape", {"point", "disc", "line", "mesh"}, &Emitter::shape),
            vector("position", "Position", "m", -kFar, kFar, &Emitter::position),
            vector("direction", "Direction", "", -1000, 1000, &Emitter::direction),
            vector("extent", "Extent", "m", -100, 100, &Emitter::extent),
            number("radius", "Radius", "m", 0, 50, &Emitter::radius),
            number("power", "Output", "kW", 0, 100000, &Emitter::power),
            number("speed", "Speed", "m/s", 0, 200, &Emitter::speed),
            number("cone", "Spread", "rad", 0, 2, &Emitter::cone),
            number("life", "Life", "s", 0, 60, &Emitter::life),
            number("smoke", "Smoke", "", 0, 1, &Emitter::smoke),
            number("sparks", "Sparks", "", 0, 1, &Emitter::sparks),
            number("wind_response", "Bends in the wind", "", 0, 4, &Emitter::windResponse),
            number("turbulence", "Break-up", "", 0, 4, &Emitter::turbulence),
            flag("books", "Shows flipbooks", &Emitter::flipbooks),
        };
        addSpan(own, "Keys of the output");
        own.push_back(object("sticks_to", "Sticks to", &Emitter::sticksTo));
        own.push_back(
            words("sticks_to_node", "At its part", FieldType::Text, &Emitter::sticksToNode));
        return withObject<Emitter>(std::move(own));
    }();
    return table;
}

template <>
const Table<Wind>& tableOf() {
    static const Table<Wind> table = [] {
        std::vector<Entry<Wind>> own = {
            choice("shape", "Where", {"everywhere", "box", "ball", "fan"}, &Wind::shape),
            vector("velocity", "Wind", "m/s", -60, 60, &Wind::velocity),
            choice("flow", "Blows", {"along", "out", "around"}, &Wind::flow),
            vector("position", "Position", "m", -kFar, kFar, &Wind::position),
            vector("half_size", "Half size", "m", 0.01, 1000, &Wind::halfSize),
            number("radius", "Radius", "m", 0.01, 1000, &Wind::radius),
            number("length", "Reach", "m", 0.01, 1000, &Wind::length),
            number("falloff", "Fades", "", 0, 1, &Wind::falloff),
            flag("shelters", "Instead of other wind", &Wind::shelters)};
        addSpan(own, "Keys of the wind");
        own.push_back(object("sticks_to", "Sticks to", &Wind::sticksTo));
        return withObject<Wind>(std::move(own));
    }();
    return table;
}

template <>
const Table<Collider>& tableOf() {
    static const Table<Collider> table = withObject<Collider>({
        choice("shape", "Shape", {"ball", "capsule", "box", "floor"}, &Collider::shape),
        vector("position", "Position", "m", -kFar, kFar, &Collider::position),
        vector("rotation", "Rotation", "°", -3600, 3600, &Collider::rotation),
        vector("half_size", "Half size", "m", 0.001, 30, &Collider::halfSize),
        number("radius", "Radius", "m", 0.001, 1000, &Collider::radius),
        number("length", "Length", "m", 0, 1000, &Collider::length),
        flag("shields", "Stops heat", &Collider::shields),
        object("sticks_to", "Sticks to", &Collider::sticksTo),
    });
    return table;
}

template <>
const Table<PaintLayer>& tableOf() {
    static const Table<PaintLayer> table = withObject<PaintLayer>({
        object("mesh", "On", &PaintLayer::mesh),
        choice("kind", "Paints", {"multiplier", "moisture", "material"}, &PaintLayer::kind),
        words("image", "Picture", FieldType::File, &PaintLayer::image),
        number("strength", "Strength", "", 0, 1, &PaintLayer::strength),
        whole("size", "Size", "px", 8, 4096, &PaintLayer::size),
    });
    return table;
}

template <>
const Table<Event>& tableOf() {
    static const Table<Event> table = withObject<Event>({
        number("time", "Time", "s", 0, 1e6, &Event::time),
        words("note", "Note", FieldType::Text, &Event::note),
    });
    return table;
}

template <>
const Table<Settings>& tableOf() {
    static const Table<Settings> table({
        number("duration", "Duration", "s", 0.1, 100000, &Settings::duration),
        number("frames_per_second", "Frames a second", "", 1, 240, &Settings::framesPerSecond),
        number("pace", "Pace", "×", 0.1, 1000, &Settings::pace),
        whole("seed", "Seed", "", 0, 4294967295.0, &Settings::seed),
        vector("up", "Up", "", -1, 1, &Settings::up),
        vector("wind", "Wind", "m/s", -60, 60, &Settings::wind),
        choice("daylight", "Light", {"night", "dusk", "day"}, &Settings::daylight),
        number("light", "Brightness", "×", 0, 100, &Settings::light),
        vector("sun_direction", "Towards the sun", "", -1, 1, &Settings::sunDirection),
        number("exposure", "Exposure", "×", 0.001, 1000, &Settings::exposure),
        number("ground", "Ground", "m", -kFar, kFar, &Settings::ground),
        flag("radiation", "Fire jumps by its glow", &Settings::radiation),
        flag("plume", "Fire jumps by hot gas", &Settings::plume),
        flag("contact", "Fire jumps by touch", &Settings::contact),
        flag("embers", "Fire jumps by embers", &Settings::embers),
    });
    return table;
}

template <>
const Table<Camera>& tableOf() {
    static const Table<Camera> table({
        vector("target", "Looks at", "m", -kFar, kFar, &Camera::target),
        number("distance", "Distance", "m", 0.001, kFar, &Camera::distance),
        number("yaw", "Around", "°", -3600, 3600, &Camera::yaw),
        number("pitch", "Above", "°", -89.9, 89.9, &Camera::pitch),
        number("field_of_view", "Field of view", "°", 1, 150, &Camera::fieldOfView),
    });
    return table;
}

struct KindWords {
    const char *key, *label;
};
constexpr KindWords kKinds[] = {{"mesh", "Mesh"},         {"source", "Heat source"},
                                {"flame", "Flame"},       {"emitter", "Smoke and sparks"},
                                {"wind", "Wind"},         {"collider", "Wall"},
                                {"layer", "Layer"},       {"event", "Event"},
                                {"settings", "Settings"}, {"camera", "Camera"}};
static_assert(std::size(kKinds) == size_t(Kind::Count));

// Calls `visit(object, table)` with the object's own type. Returns false if there is none.
template <typename SceneT, typename Visit>
bool withTyped(SceneT& scene, Kind kind, ObjectId id, Visit&& visit) {
    if (kind == Kind::Settings) return visit(scene.settings, tableOf<Settings>()), true;
    if (kind == Kind::Camera) return visit(scene.camera, tableOf<Camera>()), true;
    bool found = false;
    forEachList(scene, [&](Kind which, auto& list) {
        if (which != kind) return;
        for (auto& one : list) {
            if (found || one.id != id) continue;
            found = true;
            visit(one, tableOf<std::remove_cvref_t<decltype(one)>>());
        }
    });
    return found;
}

size_t indexOf(std::span<const FieldInfo> infos, std::string_view key) {
    size_t i = 0;
    while (i < infos.size() && key != infos[i].key) ++i;
    return i;
}

template <typename... Fs>
struct Overloaded : Fs... {
    using Fs::operator()...;
};
template <typename... Fs>
Overloaded(Fs...) -> Overloaded<Fs...>;

template <typename T>
Value valueOf(const T& from, const Member<T>& member) {
    return std::visit(
        Overloaded{[&](bool T::*m) { return Value(from.*m ? 1.0 : 0.0); },
                   [&](uint32_t T::*m) { return Value(static_cast<double>(from.*m)); },
                   [&](float T::*m) { return Value(static_cast<double>(from.*m)); },
                   [&](std::string T::*m) { return Value(from.*m); },
                   [&](Vec3 T::*m) {
                       return Value(std::vector<double>((from.*m).begin(), (from.*m).end()));
                   },
                   [&](Slots T::*m) {
                       return Value(std::vector<double>((from.*m).begin(), (from.*m).end()));
                   },
                   [&](Keys T::*m) {
                       std::vector<double> flat;
                       for (const Key& key : from.*m)
                           flat.insert(flat.end(), {key.time, key.value});
                       return Value(flat);
                   },
                   [&](Pins T::*m) {
                       std::vector<double> flat;
                       for (const auto& pin : from.*m)
                           flat.insert(flat.end(), pin.begin(), pin.end());
                       return Value(flat);
                   }},
        member);
}

std::string withUnit(double value, const FieldInfo& info) {
    std::string text = printNumber(value);
    if (info.unit[0]) text += std::string(info.unit[0] == '\xc2' ? "" : " ") + info.unit;
    return text;
}

// Clamps to the field's limits and reports the first repair.
double bounded(double value, const FieldInfo& info, double low, double high, std::string& repair) {
    const double kept = std::clamp(value, low, high);
    if (kept != value && repair.empty())
        repair = std::string(info.key) + " was " + withUnit(value, info) +
                 (value < low ? ", below " : ", above ") + withUnit(kept, info) + "; it is now " +
                 withUnit(kept, info);
    return kept;
}

bool takeList(const Value& value, const FieldInfo& info, size_t most, std::vector<double>& list,
              std::string& error) {
    const auto* given = std::get_if<std::vector<double>>(&value);
    const bool open = info.type == FieldType::KeyList || info.type == FieldType::Rows;
    if (!given || (open ? given->size() % info.width != 0 : given->size() != info.width)) {
        error = std::string(info.key) + " takes " + std::to_string(info.width) + " numbers" +
                (open ? " in each row" : "");
        return false;
    }
    if (given->size() / info.width > most) {
        error = std::string(info.key) + " has " + std::to_string(given->size() / info.width) +
                " rows, above " + std::to_string(most);
        return false;
    }
    for (const double number : *given)
        if (!std::isfinite(number)) {
            error = std::string(info.key) + " holds a number that is not finite";
            return false;
        }
    list = *given;
    return true;
}

constexpr size_t kMostKeys = 1000, kMostPins = 8, kMostText = 400;

template <typename T>
bool store(T& into, const Member<T>& member, const FieldInfo& info, const Value& value,
           std::string& repair, std::string& error) {
    const auto needsNumber = [&](double& number) {
        const double* given = std::get_if<double>(&value);
        if (!given || !std::isfinite(*given)) {
            error = std::string(info.key) + " takes a finite number";
            return false;
        }
        number = *given;
        return true;
    };
    double number = 0;
    std::vector<double> list;
    return std::visit(
        Overloaded{
            [&](bool T::*m) {
                if (!needsNumber(number)) return false;
                into.*m = number != 0;
                return true;
            },
            [&](uint32_t T::*m) {
                if (!needsNumber(number)) return false;
                if (info.type == FieldType::Choice && (number < 0 || number > info.high)) {
                    error = std::string(info.key) + " is choice " + printNumber(number) +
                            "; the last is " + printNumber(info.high);
                    return false;
                }
                into.*m = static_cast<uint32_t>(
                    bounded(std::round(number), info, info.low, info.high, repair));
                return true;
            },
            [&](float T::*m) {
                if (!needsNumber(number)) return false;
                into.*m = static_cast<float>(bounded(number, info, info.low, info.high, repair));
                return true;
            },
            [&](std::string T::*m) {
                const auto* given = std::get_if<std::string>(&value);
                if (!given) {
                    error = std::string(info.key) + " takes a text";
                    return false;
                }
                into.*m = cleanText(*given, kMostText);
                if (into.*m != *given)
                    repair = std::string(info.key) +
                             " held characters that cannot be kept, or more than " +
                             std::to_string(kMostText) + " bytes; it is now \"" + into.*m + "\"";
                return true;
            },
            [&](Vec3 T::*m) {
                if (!takeList(value, info, 1, list, error)) return false;
                for (size_t k = 0; k < 3; ++k)
                    (into.*m)[k] =
                        static_cast<float>(bounded(list[k], info, info.low, info.high, repair));
                return true;
            },
            [&](Slots T::*m) {
                if (!takeList(value, info, 1, list, error)) return false;
                for (size_t k = 0; k < 8; ++k)
                    (into.*m)[k] = static_cast<uint32_t>(
                        bounded(std::round(list[k]), info, info.low, info.high, repair));
                return true;
            },
            [&](Keys T::*m) {
                if (!takeList(value, info, kMostKeys, list, error)) return false;
                Keys made;
                for (size_t i = 0; i < list.size(); i += 2)
                    made.push_back(
                        {static_cast<float>(bounded(list[i], info, info.low, info.high, repair)),
                         static_cast<float>(
                             bounded(list[i + 1], info, info.least, info.most, repair))});
                std::stable_sort(made.begin(), made.end(),
                                 [](const Key& a, const Key& b) { return a.time < b.time; });
                // Of two keys at the same time, the later entry counts.
                Keys single;
                for (const Key& key : made) {
                    if (!single.empty() && single.back().time == key.time) single.pop_back();
                    single.push_back(key);
                }
                into.*m = std::move(single);
                return true;
            },
            [&](Pins T::*m) {
                if (!takeList(value, info, kMostPins, list, error)) return false;
                Pins made(list.size() / 7);
                for (size_t i = 0; i < list.size(); ++i)
                    made[i / 7][i % 7] = static_cast<float>(
                        bounded(list[i], info, i % 7 == 6 ? 0 : info.low, info.high, repair));
                into.*m = std::move(made);
                return true;
            }},
        member);
}

// Returns the factor from the given unit to the field's own unit; 0: not a matching unit.
double unitFactor(std::string_view own, std::string_view given) {
    if (given == own) return 1;
    struct Row {
        std::string_view own, given;
        double factor;
    };
    static constexpr Row rows[] = {
        {"m", "mm", 0.001}, {"m", "cm", 0.01},  {"m", "km", 1000},
        {"kW", "W", 0.001}, {"kW", "MW", 1000}, {"kW", "kg/s", 1},
        {"s", "ms", 0.001}, {"s", "min", 60},   {"°", "deg", 1},
        {"", "%", 0.01},    {"×", "x", 1},      {"rad", "deg", 0.017453292519943295}};
    for (const Row& row : rows)
        if (row.own == own && row.given == given) return row.factor;
    return 0;
}

// "18", "18kW", "1/3".
bool readNumber(const FieldInfo& info, std::string_view text, double& value) {
    const char *from = text.data(), *end = from + text.size();
    if (from != end && *from == '+') ++from;
    auto [at, code] = std::from_chars(from, end, value);
    if (code != std::errc{}) return false;
    if (at != end && *at == '/') {
        double divisor = 0;
        const auto [after, fine] = std::from_chars(at + 1, end, divisor);
        if (fine != std::errc{} || divisor == 0) return false;
        value /= divisor;
        at = after;
    }
    if (at == end) return std::isfinite(value);
    const double factor = unitFactor(info.unit, {at, static_cast<size_t>(end - at)});
    value *= factor;
    return factor != 0 && std::isfinite(value);
}

std::string refusal(const FieldInfo& info, std::string_view text, const std::string& takes) {
    return std::string(info.key) + " is \"" + std::string(text) + "\"; it takes " + takes;
}

std::string wordList(const FieldInfo& info) {
    std::string list;
    for (const char* word : info.choices) list += (list.empty() ? "" : ", ") + std::string(word);
    return list;
}

bool readChoice(const FieldInfo& info, std::string_view text, double& value, std::string& error) {
    for (size_t i = 0; i < info.choices.size(); ++i)
        if (text == info.choices[i]) return value = static_cast<double>(i), true;
    error = refusal(info, text, wordList(info));
    return false;
}

const char* wordAt(const FieldInfo& info, double number) {
    return info.choices[static_cast<size_t>(std::clamp(number, 0.0, info.high))];
}

std::vector<std::string_view> split(std::string_view text, char by) {
    std::vector<std::string_view> parts;
    for (size_t at = 0; at <= text.size();) {
        const size_t next = std::min(text.find(by, at), text.size());
        parts.push_back(text.substr(at, next - at));
        at = next + 1;
    }
    return parts;
}

}  // namespace

const std::vector<const char*>& materialWords() {
    static const std::vector<std::string> kept = [] {
        std::vector<std::string> made;
        for (uint32_t i = 0; i < FW_MATERIAL_PRESET_COUNT; ++i) {
            made.emplace_back(fwMaterialPresetName(i));
            std::replace(made.back().begin(), made.back().end(), ' ', '_');
        }
        return made;
    }();
    static const std::vector<const char*> words = [] {
        std::vector<const char*> made;
        for (const std::string& word : kept) made.push_back(word.c_str());
        return made;
    }();
    return words;
}

const char* kindKey(Kind kind) { return kKinds[size_t(kind)].key; }
const char* kindLabel(Kind kind) { return kKinds[size_t(kind)].label; }
bool kindOfKey(std::string_view key, Kind& kind) {
    for (size_t i = 0; i < std::size(kKinds); ++i)
        if (key == kKinds[i].key) return kind = Kind(i), true;
    return false;
}

std::span<const FieldInfo> fieldsOf(Kind kind) {
    switch (kind) {
        case Kind::Mesh:
            return tableOf<Mesh>().infos;
        case Kind::Source:
            return tableOf<HeatSource>().infos;
        case Kind::Flame:
            return tableOf<Flame>().infos;
        case Kind::Emitter:
            return tableOf<Emitter>().infos;
        case Kind::Wind:
            return tableOf<Wind>().infos;
        case Kind::Collider:
            return tableOf<Collider>().infos;
        case Kind::Layer:
            return tableOf<PaintLayer>().infos;
        case Kind::Event:
            return tableOf<Event>().infos;
        case Kind::Settings:
            return tableOf<Settings>().infos;
        case Kind::Camera:
            return tableOf<Camera>().infos;
        case Kind::Count:
            break;
    }
    return {};
}

const FieldInfo* findField(Kind kind, std::string_view key) {
    const std::span<const FieldInfo> infos = fieldsOf(kind);
    const size_t i = indexOf(infos, key);
    return i < infos.size() ? &infos[i] : nullptr;
}

bool getField(const Scene& scene, Kind kind, ObjectId id, std::string_view key, Value& value) {
    bool found = false;
    withTyped(scene, kind, id, [&](const auto& one, const auto& table) {
        const size_t i = indexOf(table.infos, key);
        if (i == table.infos.size()) return;
        value = valueOf(one, table.members[i]);
        found = true;
    });
    return found;
}

bool setField(Scene& scene, Kind kind, ObjectId id, std::string_view key, const Value& value,
              std::string& repair, std::string& error) {
    bool done = false;
    const bool there = withTyped(scene, kind, id, [&](auto& one, const auto& table) {
        const size_t i = indexOf(table.infos, key);
        if (i == table.infos.size()) {
            error =
                std::string("A ") + kindKey(kind) + " has no field \"" + std::string(key) + "\"";
            return;
        }
        done = store(one, table.members[i], table.infos[i], value, repair, error);
    });
    if (!there) error = std::string("There is no ") + kindKey(kind) + " #" + std::to_string(id);
    return there && done;
}

std::string printValue(const Scene& scene, const FieldInfo& field, const Value& value) {
    const auto* list = std::get_if<std::vector<double>>(&value);
    const double* number = std::get_if<double>(&value);
    std::string text;
    switch (field.type) {
        case FieldType::Flag:
            return *number != 0 ? "yes" : "no";
        case FieldType::Whole:
            return std::to_string(static_cast<uint64_t>(std::clamp(*number, 0.0, 4294967295.0)));
        case FieldType::Number:
            return printNumber(*number);
        case FieldType::Choice:
            return wordAt(field, *number);
        case FieldType::Text:
        case FieldType::File:
            return inQuotes(std::get<std::string>(value));
        case FieldType::Object:
            if (!findObject(scene, static_cast<ObjectId>(*number))) return "none";
            return join("#", std::to_string(static_cast<ObjectId>(*number)));
        case FieldType::Vector:
            for (const double part : *list)
                text += join(text.empty() ? "" : " ", printNumber(part));
            return text;
        case FieldType::Choices:
            for (const double part : *list)
                text += join(text.empty() ? "" : "/", wordAt(field, part));
            return text;
        case FieldType::KeyList:
        case FieldType::Rows:
            if (list->empty()) return "none";
            for (size_t i = 0; i < list->size(); ++i)
                text += join(i == 0                 ? ""
                             : i % field.width == 0 ? " "
                                                    : ":",
                             printNumber((*list)[i]));
            return text;
    }
    return text;
}

bool parseValue(const Scene& scene, const FieldInfo& field, std::span<const std::string> words,
                Value& value, std::string& error) {
    if (words.empty()) {
        error = std::string(field.key) + " has no value";
        return false;
    }
    const std::string& first = words[0];
    double number = 0;
    switch (field.type) {
        case FieldType::Flag:
            if (first == "yes" || first == "no") return value = first == "yes" ? 1.0 : 0.0, true;
            error = refusal(field, first, "yes or no");
            return false;
        case FieldType::Choice:
            if (!readChoice(field, first, number, error)) return false;
            return value = number, true;
        case FieldType::Text:
        case FieldType::File:
            return value = first, true;
        case FieldType::Object: {
            if (first == "none") return value = 0.0, true;
            const ObjectId id = findByWord(scene, first);
            if (id == 0) {
                error = refusal(field, first, "none, or an object's name or #id");
                return false;
            }
            return value = static_cast<double>(id), true;
        }
        case FieldType::Whole:
        case FieldType::Number:
        case FieldType::Vector: {
            // "12 cm" is two words.
            double factor =
                words.size() == field.width + 1 ? unitFactor(field.unit, words[field.width]) : 1;
            if ((words.size() != field.width && words.size() != field.width + 1) || factor == 0) {
                error = refusal(field, first,
                                std::to_string(field.width) +
                                    (field.width == 1 ? " number" : " numbers") +
                                    (field.unit[0] ? std::string(" in ") + field.unit : ""));
                return false;
            }
            std::vector<double> list;
            for (uint32_t i = 0; i < field.width; ++i) {
                if (!readNumber(field, words[i], number)) {
                    error = refusal(field, words[i],
                                    std::string("a number") +
                                        (field.unit[0] ? std::string(" in ") + field.unit : ""));
                    return false;
                }
                list.push_back(number * factor);
            }
            if (field.type == FieldType::Vector) return value = list, true;
            return value = list[0], true;
        }
        case FieldType::Choices: {
            const auto parts = split(first, '/');
            if (parts.size() != 1 && parts.size() != field.width) {
                error = refusal(field, first, "one word or eight with / between them");
                return false;
            }
            std::vector<double> list;
            for (uint32_t i = 0; i < field.width; ++i) {
                if (!readChoice(field, parts[parts.size() == 1 ? 0 : i], number, error))
                    return false;
                list.push_back(number);
            }
            return value = list, true;
        }
        case FieldType::KeyList:
        case FieldType::Rows: {
            std::vector<double> list;
            if (first == "none") return value = list, true;
            for (const std::string& word : words) {
                const auto parts = split(word, ':');
                for (const std::string_view part : parts) {
                    if (parts.size() != field.width || !readNumber(field, part, number)) {
                        error =
                            refusal(field, word,
                                    std::to_string(field.width) + " numbers with : between them");
                        return false;
                    }
                    list.push_back(number);
                }
            }
            return value = list, true;
        }
    }
    return false;
}

size_t wordsOfValue(const FieldInfo& field, std::span<const std::string> words) {
    size_t count = 1;
    if (field.type == FieldType::KeyList || field.type == FieldType::Rows) {
        if (!words.empty() && words[0] == "none") return 1;
        while (count < words.size() && words[count].find(':') != std::string::npos) ++count;
        return std::min(count, words.size());
    }
    if (field.type == FieldType::Vector) count = field.width;
    const bool counts = field.type == FieldType::Vector || field.type == FieldType::Number ||
                        field.type == FieldType::Whole;
    if (counts && count < words.size() && !words[count].empty() &&
        unitFactor(field.unit, words[count]) != 0)
        ++count;
    return std::min(count, words.size());
}

}  // namespace fwedit
