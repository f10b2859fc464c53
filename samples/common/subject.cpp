// See subject.h.
#include "common/subject.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "common/toy.h"
#include "model/baked_map.h"

namespace {

glm::vec3 vertexOf(const fwimport::ImportedModel& model, uint32_t index) {
    return {model.positions[index * 3], model.positions[index * 3 + 1],
            model.positions[index * 3 + 2]};
}

// Centres the subject on the floor and scales it to a size that burns in a minute or two.
void placeInStudio(Subject& subject, float size, float wantedSize) {
    fwimport::ImportedModel& model = subject.model;
    // Burning depends on absolute size, so subjects of unusual size are scaled to 1 m.
    if (wantedSize > 0) {
        subject.scale = wantedSize / size;
    } else if (size < 0.05f || size > 10.0f) {
        subject.scale = 1.0f / size;
        char line[128];
        std::snprintf(line, sizeof line, "it is %.4g m large; scaled to 1 m", size);
        model.notes.emplace_back(line);
    }
    const float middleX = 0.5f * (model.low[0] + model.high[0]);
    const float middleZ = 0.5f * (model.low[2] + model.high[2]);
    const float offset[3] = {middleX, model.low[1], middleZ};
    for (size_t i = 0; i < model.positions.size(); ++i) {
        model.positions[i] = (model.positions[i] - offset[i % 3]) * subject.scale;
    }
    for (size_t c = 0; c < 3; ++c) {
        model.low[c] = (model.low[c] - offset[c]) * subject.scale;
        model.high[c] = (model.high[c] - offset[c]) * subject.scale;
    }
}

}  // namespace

float Subject::size() const {
    float side = 0;
    for (size_t c = 0; c < 3; ++c) side = std::max(side, model.high[c] - model.low[c]);
    return side;
}

float Subject::height() const { return model.high[1] - model.low[1]; }

Subject loadSubject(const std::filesystem::path& file, float wantedSize, bool asItStands) {
    Subject subject;
    if (file.empty()) {
        subject.name = "wooden toy";
        subject.model = makeToy();
    } else {
        subject.name = file.filename().string();
        std::string error;
        if (!fwimport::importGltf(file, subject.model, error)) throw sample::Failure(error);
    }
    const float size = subject.size();
    if (!(size > 0)) throw sample::Failure(subject.name + " has no extent");
    if (!asItStands) placeInStudio(subject, size, wantedSize);
    subject.surfaces = fwmodel::surfacesOf(subject.model);
    return subject;
}

SurfacePoint castRay(const Subject& subject, glm::vec3 origin, glm::vec3 direction) {
    SurfacePoint result;
    float nearest = 1e30f;
    const fwimport::ImportedModel& model = subject.model;
    for (size_t t = 0; t + 2 < model.indices.size(); t += 3) {
        const glm::vec3 a = vertexOf(model, model.indices[t]);
        const glm::vec3 ab = vertexOf(model, model.indices[t + 1]) - a;
        const glm::vec3 ac = vertexOf(model, model.indices[t + 2]) - a;
        const glm::vec3 h = glm::cross(direction, ac);
        const float determinant = glm::dot(ab, h);
        if (std::abs(determinant) < 1e-12f) continue;
        const glm::vec3 s = (origin - a) / determinant;
        const float u = glm::dot(s, h);
        if (u < 0 || u > 1) continue;
        const glm::vec3 q = glm::cross(s, ab);
        const float v = glm::dot(direction, q);
        if (v < 0 || u + v > 1) continue;
        const float distance = glm::dot(ac, q);
        if (distance <= 1e-4f || distance >= nearest) continue;
        nearest = distance;
        result.position = origin + distance * direction;
        result.normal = glm::normalize(glm::cross(ab, ac));
        result.hit = true;
    }
    return result;
}

SurfacePoint findIgnitionPoint(const Subject& subject, glm::vec3 eye) {
    // Prefers unoccluded triangles that face the viewer, low but above the floor, near the middle.
    const fwimport::ImportedModel& model = subject.model;
    struct Candidate {
        float score;
        glm::vec3 position, normal;
    };
    std::vector<Candidate> candidates;
    const glm::vec3 side = glm::normalize(glm::cross(eye, glm::vec3(0, 1, 0)) + glm::vec3(1e-9f));
    for (size_t t = 0; t + 2 < model.indices.size(); t += 3) {
        const glm::vec3 a = vertexOf(model, model.indices[t]);
        const glm::vec3 b = vertexOf(model, model.indices[t + 1]);
        const glm::vec3 c = vertexOf(model, model.indices[t + 2]);
        const glm::vec3 cross = glm::cross(b - a, c - a);
        const float length = glm::length(cross);
        if (!(length > 0)) continue;
        const glm::vec3 normal = cross / length, middle = (a + b + c) / 3.0f;
        const float facing = glm::dot(normal, glm::normalize(eye - middle));
        if (facing < 0.35f) continue;
        const float level = middle.y / std::max(1e-6f, subject.height());
        const float aside = std::abs(glm::dot(middle, side)) / subject.size();
        candidates.push_back(
            {std::abs(level - 0.22f) + 0.8f * aside - 0.3f * facing, middle, normal});
    }
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b) { return a.score < b.score; });
    for (size_t i = 0; i < std::min<size_t>(candidates.size(), 64); ++i) {
        const glm::vec3 offset = candidates[i].position - eye;
        const SurfacePoint seen = castRay(subject, eye, glm::normalize(offset));
        if (seen.hit &&
            glm::distance(seen.position, candidates[i].position) < 0.02f * subject.size()) {
            return {candidates[i].position, candidates[i].normal, true};
        }
    }
    // Flat or unusual mesh: fall back to its lowest corner.
    SurfacePoint lowest;
    for (uint32_t i = 0; i < model.vertexCount(); ++i) {
        const glm::vec3 p = vertexOf(model, i);
        if (!lowest.hit || p.y < lowest.position.y) lowest = {p, {0, -1, 0}, true};
    }
    return lowest;
}

sample::OrbitCamera orbitAround(const Subject& subject, float yaw, float pitch,
                                VkExtent2D picture) {
    constexpr float kFilled = 0.80f;  // share of the picture's height, or of its width
    sample::OrbitCamera orbit;
    orbit.target = {0, 0.5f * subject.height(), 0};
    orbit.yaw = glm::radians(yaw);
    orbit.pitch = glm::radians(pitch);
    orbit.fieldOfView = 0.5f;
    orbit.distance = 1.0f;
    const glm::vec3 back = orbit.camera().eye - orbit.target;
    const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0, 1, 0), back));
    const glm::vec3 up = glm::cross(back, right);
    const float tall = kFilled * std::tan(0.5f * orbit.fieldOfView);
    const float wide =
        tall * (static_cast<float>(picture.width) / static_cast<float>(picture.height));
    orbit.distance = 0.1f * subject.size();
    for (uint32_t i = 0; i < subject.model.vertexCount(); ++i) {
        const glm::vec3 p = vertexOf(subject.model, i) - orbit.target;
        const float away =
            std::max(std::abs(glm::dot(p, right)) / wide, std::abs(glm::dot(p, up)) / tall);
        orbit.distance = std::max(orbit.distance, away + glm::dot(p, back));
    }
    return orbit;
}

FwMeshId createMesh(sample::FireHost& fire, const Subject& subject, const BurnMapRequest& request,
                    std::string& note) {
    FwMeshDef def = fwmodel::meshDefOf(subject.model, subject.surfaces);
    def.mapSize = request.mapSize;
    def.texelsPerMetre = request.texelsPerMetre;
    const std::string key = fwmodel::bakeKeyOf(def);
    std::vector<char> bytes;
    FwMeshId id{};
    if (fwmodel::readBake(request.cache, key, bytes)) {
        const FwMeshDef cooked = fwmodel::cookedDefOf(bytes);
        if (fwWorld_CreateMesh(fire.world, &cooked, &id) == FW_OK) {
            note = "read from " + (request.cache / (key + ".fwburn")).string();
            return id;
        }
        // An unreadable cache is rebuilt.
    }
    std::string error;
    if (!fwmodel::cookMesh(fire.context, def, bytes, error))
        throw sample::Failure(subject.name + ": " + error);
    const FwMeshDef cooked = fwmodel::cookedDefOf(bytes);
    fire.check(fwWorld_CreateMesh(fire.world, &cooked, &id), "fwWorld_CreateMesh");
    note = "baked";
    if (!request.cache.empty())
        note += fwmodel::keepBake(request.cache, key, bytes)
                    ? ", cached in " + (request.cache / (key + ".fwburn")).string()
                    : " (the cache cannot be written)";
    return id;
}
