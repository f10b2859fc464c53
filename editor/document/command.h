// What can be done to a scene, each with a line of text that does the same:
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
// Targets are names in quotes, or #id. A name that several have means the first. // begins a
// comment.
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
    Kind kind = Kind::Source;  // of Add; Settings and Camera have no targets
    std::vector<ObjectId> targets;
    std::vector<Assignment> fields;  // of Add, Set, Import
    Vec3 offset{};                   // of Move
    Key key;                         // of Key, Unkey
    uint32_t index = 0;              // of Order
    std::string file;                // of Import
    Stroke stroke;                   // of Stroke
    FillRequest fill;                // of Fill
};

// One line. False: `error` says what is wrong with which word and what is allowed.
bool parseCommand(const Scene& scene, std::string_view line, Command& command, std::string& error);
std::string printCommand(const Scene& scene, const Command& command);
// "Move Corner torch", "Output of Corner torch", "Add heat source"; at most 40 characters.
std::string undoName(const Scene& before, const Command& command);

// Words of a line: quotes hold spaces, \" and \\ within them; // at a word's start begins a
// comment.
bool splitWords(std::string_view line, std::vector<std::string>& words, std::string& error);

}  // namespace fwedit
