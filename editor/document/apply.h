// What a command does to a scene and its pictures. Knows nothing of history or files.
#pragma once

#include "document/document.h"

namespace fwedit {

constexpr size_t kMostObjects = 4000;

// False: `message` says why; scene and images may be half changed then, so give copies. True:
// `message` says what was repaired, if anything. `added`: the new object, else untouched.
bool applyCommand(const Document& document, const Command& command, Scene& scene,
                  PaintImages& images, std::string& message, ObjectId& added);
// "Crate", "Crate 2", "Crate 3": the first that is free.
std::string freeName(const Scene& scene, std::string name);
// A reference that points nowhere, to itself or around in a circle becomes 0; true: one did.
bool mendReferences(Scene& scene, std::vector<std::string>* repairs);

}  // namespace fwedit
