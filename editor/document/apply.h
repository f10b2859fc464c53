// Applies commands to a scene and its images. Independent of history and files.
#pragma once

#include "document/document.h"

namespace fwedit {

constexpr size_t kMostObjects = 4000;

// On failure returns false with the reason in `message`; scene and images may be half changed, so
// pass copies. On success `message` lists repairs, if any. `added`: set to the new object, if there
// is one.
bool applyCommand(const Document& document, const Command& command, Scene& scene,
                  PaintImages& images, std::string& message, ObjectId& added);
// Returns the first free name: "Crate", "Crate 2", "Crate 3".
std::string freeName(const Scene& scene, std::string name);
// Sets references that are missing, self-referential or circular to 0. Returns true if there were
// any.
bool repairReferences(Scene& scene, std::vector<std::string>* repairs);

}  // namespace fwedit
