// The commands that change a scene. Each has a textual form of one line:
//   add source point name="Corner torch" position 0.1 0.2 0.3 output 18 kW
//   set "Corner torch" output 20
//   set settings wind 3 0 0
//   move "Corner torch" 0 0.1 0
//   key "Corner torch" 2.5 0.4          unkey "Corner torch" 2.5
//   duplicate "Corner torch"            remove "Corner torch" #7
//   order "Corner torch" 0              rename "Corner torch" "Back torch"
//   import "gate.glb" name="Gate"
//   stroke "Dry side" size 0.05 value 0.2 strength 1 hardness 0.5 path 0:1:0.2 0.1:1:0.2
//   fill "Dry side" value 0.5 by all
// Targets are quoted names or #id. A duplicate name means the first object. // begins a comment.
#pragma once

#include <string>
#include <vector>

#include "document/fields.h"
#include "document/paint.h"

namespace fwedit {

enum class Verb : uint32_t {
    Add,
    Set,
    Move,
    Key,
    Unkey,
    Duplicate,
    Remove,
    Order,
    Import,
    Stroke,
    Fill,
    Count
};

struct Assignment {
    std::string field;
    Value value;
    bool operator==(const Assignment&) const = default;
};

struct Command {
    Verb verb = Verb::Set;
    Kind kind = Kind::Source;  // for Add; Settings and Camera have no targets
    std::vector<ObjectId> targets;
    std::vector<Assignment> fields;  // for Add, Set, Import
    Vec3 offset{};                   // for Move
    Key key;                         // for Key, Unkey
    uint32_t index = 0;              // for Order
    std::string file;                // for Import
    Stroke stroke;                   // for Stroke
    FillRequest fill;                // for Fill
};

// Parses one line. On failure returns false; `error` has the word, its problem and the allowed
// values.
bool parseCommand(const Scene& scene, std::string_view line, Command& command, std::string& error);
std::string printCommand(const Scene& scene, const Command& command);
// Returns at most 40 characters: "Move Corner torch", "Output of Corner torch", "Add heat source".
std::string undoName(const Scene& before, const Command& command);

// Splits a line into words. Quotes may contain spaces, \" and \\. // at the start of a word begins
// a comment.
bool splitWords(std::string_view line, std::vector<std::string>& words, std::string& error);

}  // namespace fwedit
