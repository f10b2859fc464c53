// Objects on a clipboard: as the commands that add them, a line each, so that they go from window
// to window and may be read, kept and sent as text.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "document/document.h"

namespace fwedit {

// Of layers only their picture would be of use, and that is no text: they are left out. Empty:
// there was nothing to copy.
std::string copyObjects(const Scene& scene, std::span<const ObjectId> objects);
// All of them as one step, under names of their own; what a copy stuck to it sticks to where there
// is such an object. False: `message` says why nothing was added.
bool pasteObjects(Document& document, std::string_view text, std::vector<ObjectId>& added,
                  std::string& message);

}  // namespace fwedit
