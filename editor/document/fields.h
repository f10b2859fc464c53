// The fields of a scene's objects by name: one table that saving, loading, commands, undo's names
// and inspectors read. A field that is not in it is not saved and cannot be edited.
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
    double low = 0, high = 0;           // of each number
    uint32_t width = 1;                 // numbers in it; of Rows: in a row
    std::vector<const char*> choices;   // words of a Choice, in the order of their numbers
    double least = -1000, most = 1000;  // of a KeyList's values; low and high are of its times
};

// Flags, numbers and choices are numbers; objects too, by id. Vectors, keys and rows are lists of
// numbers, row after row.
using Value = std::variant<double, std::string, std::vector<double>>;

const char* kindKey(Kind kind);    // "source", in files and commands
const char* kindLabel(Kind kind);  // "Heat source"
bool kindOfKey(std::string_view key, Kind& kind);

std::span<const FieldInfo> fieldsOf(Kind kind);
// Null: there is none of that key.
const FieldInfo* findField(Kind kind, std::string_view key);

// `id` is of no meaning for Settings and Camera. False: no such object or field.
bool getField(const Scene& scene, Kind kind, ObjectId id, std::string_view key, Value& value);
// As setField, and says what it did to a value beyond its limits: `repair` is then not empty:
// "radius was -0.4 m, below 0 m; it is now 0 m". False: `error` says why nothing was set.
bool setField(Scene& scene, Kind kind, ObjectId id, std::string_view key, const Value& value,
              std::string& repair, std::string& error);

// As in commands: shortest text that reads back the same; texts in quotes, choices as words.
std::string printValue(const Scene& scene, const FieldInfo& field, const Value& value);
// False: `error` names the field, the value and what is allowed. Units after numbers are taken.
bool parseValue(const Scene& scene, const FieldInfo& field, std::span<const std::string> words,
                Value& value, std::string& error);
// How many of the words, from the first on, are a value of the field, its unit included.
size_t wordsOfValue(const FieldInfo& field, std::span<const std::string> words);

}  // namespace fwedit
