// Checks that the fields of a glTF's JSON that are read have the types that glTF gives them: its
// parser takes a wrongly typed optional field for an absent one and says nothing. No JSON parser:
// broken syntax passes, for whoever parses next to tell.
#pragma once
#include <cstdint>
#include <span>
#include <string>

namespace fwimport {

// Empty, or what is wrong: "nodes[3].translation is a string; it takes 3 numbers".
std::string findWrongType(std::span<const uint8_t> json);

}  // namespace fwimport
