// Table of the fields of all objects, by name, for saving, loading, commands, undo names and
// inspectors. Only fields in this table are saved and editable.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "document/scene.h"

namespace fwedit {

enum class FieldType : uint32_t {
    Flag,
    Whole,
    Number,
    Choice,
    Text,
    File,
    Object,
    Vector,
    Choices,
    KeyList,
    Rows
};

struct FieldInfo {
    const char* key = "";    // in files and commands: "wind_response"
    const char* label = "";  // in inspectors and undo names: "Wind response"
    const char* unit = "";   // "kW", "m", "°"; empty: none
    FieldType type{};
    double low = 0, high = 0;           // limits of each number
    uint32_t width = 1;                 // number of values; for Rows: per row
    std::vector<const char*> choices;   // words of a Choice, in numeric order
    double least = -1000, most = 1000;  // limits of a KeyList's values; low and high limit its
                                        // times
};

// Flags, numbers, choices and object ids are numbers. Vectors, keys and rows are flat lists of
// numbers, row by row.
using Value = std::variant<double, std::string, std::vector<double>>;

const char* kindKey(Kind kind);    // "source", in files and commands
const char* kindLabel(Kind kind);  // "Heat source"
bool kindOfKey(std::string_view key, Kind& kind);

// Words of the library's material presets, by FwMaterialPreset: "painted_wood".
const std::vector<const char*>& materialWords();

std::span<const FieldInfo> fieldsOf(Kind kind);
// Returns null if there is no such key.
const FieldInfo* findField(Kind kind, std::string_view key);

// Settings and Camera ignore `id`. Returns false if the object or the field does not exist.
bool getField(const Scene& scene, Kind kind, ObjectId id, std::string_view key, Value& value);
// Sets a field and clamps it to its limits. `repair` then says so: "radius was -0.4 m, below 0 m;
// it is now 0 m". On failure returns false with the reason in `error`.
bool setField(Scene& scene, Kind kind, ObjectId id, std::string_view key, const Value& value,
              std::string& repair, std::string& error);

// Prints a value as in commands: shortest text that parses back; texts in quotes, choices as words.
std::string printValue(const Scene& scene, const FieldInfo& field, const Value& value);
// Parses a value. Accepts units after numbers. On failure returns false; `error` has the field, the
// value and the allowed values.
bool parseValue(const Scene& scene, const FieldInfo& field, std::span<const std::string> words,
                Value& value, std::string& error);
// Returns the number of leading words that belong to a value of the field, including its unit.
size_t wordsOfValue(const FieldInfo& field, std::span<const std::string> words);

}  // namespace fwedit
