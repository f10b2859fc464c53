// See surface_ray.h.
#include "viewport/surface_ray.h"

#include <cmath>
#include <glm/gtc/type_ptr.hpp>

namespace fwview {

SurfaceHit castRay(const fwimport::ImportedModel& model, const glm::mat4& transform,
                   const Ray& ray) {
    const glm::mat4 back = glm::inverse(transform);
    const glm::vec3 origin(back * glm::vec4(ray.origin, 1));
    const glm::vec3 direction(back * glm::vec4(ray.direction, 0));  // not normalised, so that t is
                                                                    // in metres
    auto vertex = [&](size_t i) {
        return glm::make_vec3(&model.positions[3 * size_t(model.indices[i])]);
    };
    SurfaceHit result;
    for (size_t i = 0; i + 2 < model.indices.size(); i += 3) {
        const glm::vec3 a = vertex(i), ab = vertex(i + 1) - a, ac = vertex(i + 2) - a;
        const glm::vec3 h = glm::cross(direction, ac);
        const float determinant = glm::dot(ab, h);
        if (std::fabs(determinant) < 1e-12f) continue;
        const glm::vec3 s = (origin - a) / determinant;
        const float u = glm::dot(s, h);
        if (u < 0 || u > 1) continue;
        const glm::vec3 q = glm::cross(s, ab);
        const float v = glm::dot(direction, q);
        if (v < 0 || u + v > 1) continue;
        const float distance = glm::dot(ac, q);
        if (distance <= 1e-4f || (result.hit && distance >= result.distance)) continue;
        result.hit = true;
        result.distance = distance;
        result.position = ray.origin + distance * ray.direction;
        result.normal = glm::transpose(glm::mat3(back)) * glm::cross(ab, ac);
    }
    if (result.hit) {
        result.normal = glm::normalize(result.normal);
        if (glm::dot(result.normal, ray.direction) > 0) result.normal = -result.normal;
    }
    return result;
}

Ray rayThrough(const FwView& view, float x, float y) {
    const glm::mat4 back =
        glm::inverse(glm::make_mat4(view.projection) * glm::make_mat4(view.view));
    auto at = [&](float depth) {
        const glm::vec4 p = back * glm::vec4(2 * x - 1, 2 * y - 1, depth, 1);
        return glm::vec3(p) / p.w;
    };
    Ray ray;
    ray.origin = glm::vec3(glm::inverse(glm::make_mat4(view.view))[3]);
    ray.direction = glm::normalize(at(0.5f) - ray.origin);
    return ray;
}

glm::vec3 onPicture(const FwView& view, glm::vec3 position) {
    const glm::vec4 clip =
        glm::make_mat4(view.projection) * glm::make_mat4(view.view) * glm::vec4(position, 1);
    if (clip.w <= 1e-6f) return {0, 0, -1};
    return {0.5f + 0.5f * clip.x / clip.w, 0.5f + 0.5f * clip.y / clip.w, clip.w};
}

}  // namespace fwview
