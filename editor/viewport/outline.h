// The outline of a model as seen: where its shape on the picture ends. Found on a mask that is
// filled as a device would fill it, so that boards inside a crate draw no lines.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace fwview {

// `corners`: three for each triangle, pixels of a picture of width x height, [1, 8192]; a triangle
// with a corner behind the eye is left out by the caller. `lines`: pairs of places in [0, 1].
void findOutline(std::span<const glm::vec2> corners, uint32_t width, uint32_t height,
                 std::vector<glm::vec2>& lines);

}  // namespace fwview
