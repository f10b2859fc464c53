// The outline of a projected model. It is found on a mask that is filled like a rasteriser would,
// so that boards inside a crate draw no lines.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace fwview {

// `corners`: three per triangle, pixels of a picture of width x height, [1, 8192]; without
// triangles that have a corner behind the camera. `lines`: pairs of points in [0, 1].
void findOutline(std::span<const glm::vec2> corners, uint32_t width, uint32_t height,
                 std::vector<glm::vec2>& lines);

}  // namespace fwview
