// Ray casts against an imported model, and the ray through a pixel.
#pragma once

#include <glm/glm.hpp>

#include "document/scene.h"
#include "flamewright/flamewright.h"
#include "import/gltf_import.h"

namespace fwview {

struct Ray {
    glm::vec3 origin{0}, direction{0, 0, -1};  // direction: unit
};
struct SurfaceHit {
    bool hit = false;
    glm::vec3 position{0}, normal{0, 1, 0};  // m, world
    float distance = 0;                      // m along the ray
    fwedit::ObjectId object = 0;
};

// Returns the nearest hit on a model placed by `transform`.
SurfaceHit castRay(const fwimport::ImportedModel& model, const glm::mat4& transform,
                   const Ray& ray);
// x, y: [0, 1] from the top left of the picture.
Ray rayThrough(const FwView& view, float x, float y);
// Projects a point: x, y in [0, 1]; z: m in front of the camera, > 0.
glm::vec3 onPicture(const FwView& view, glm::vec3 position);

}  // namespace fwview
