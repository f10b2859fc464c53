// The clipboard format: one `add` command per object, so that text can be pasted across windows,
// stored and sent.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "document/document.h"

namespace fwedit {

// Skips layers, because their content is an image. Returns an empty string if nothing can be
// copied.
std::string copyObjects(const Scene& scene, std::span<const ObjectId> objects);
// Adds all objects as one step, with free names. A copy sticks to its parent where an object of
// that name exists. On failure returns false with the reason in `message`.
bool pasteObjects(Document& document, std::string_view text, std::vector<ObjectId>& added,
                  std::string& message);

}  // namespace fwedit
