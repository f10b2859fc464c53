// See subject.h.
#include "common/subject.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "common/toy.h"
#include "import/content_hash.h"

namespace {

glm::vec3 vertexOf(const fwimport::ImportedModel& model, uint32_t index) {
    return {model.positions[index * 3], model.positions[index * 3 + 1],
            model.positions[index * 3 + 2]};
}

// Mean colour of a picture, linear.
glm::vec3 meanColor(const fwimport::DecodedImage& image) {
    glm::dvec3 sum(0);
    const size_t count = image.rgba.size() / 4, step = std::max<size_t>(1, count / 4096);
    size_t taken = 0;
    for (size_t i = 0; i < count; i += step, ++taken) {
        for (int c = 0; c < 3; ++c) {
            sum[c] += std::pow(image.rgba[i * 4 + static_cast<size_t>(c)] / 255.0, 2.2);
        }
    }
    return glm::vec3(sum / static_cast<double>(std::max<size_t>(1, taken)));
}

// Every picture gets a material slot of the burn map to itself; colours, and pictures that find no
// slot, are folded into the vertex colours.
void foldColors(Subject& subject) {
    fwimport::ImportedModel& model = subject.model;
    bool plain = true, unpictured = false;
    for (const fwimport::ImportedMaterial& material : model.materials) {
        const auto& factor = material.baseColor;
        plain = plain && factor[0] == factor[1] && factor[1] == factor[2];
        unpictured = unpictured || material.image < 0;
    }
    const size_t pictures = model.images.size();
    const size_t most = pictures + (unpictured ? 1 : 0) > subject.pictures.size()
                            ? subject.pictures.size() - 1
                            : pictures;
    subject.pictures.fill(-1);
    for (size_t i = 0; i < most; ++i) subject.pictures[i] = static_cast<int32_t>(i);
    const auto pictured = [&](const fwimport::ImportedMaterial& material) {
        return material.image >= 0 && static_cast<size_t>(material.image) < most;
    };
    for (const fwimport::ImportedMaterial& material : model.materials) {
        const size_t slot = pictured(material) ? static_cast<size_t>(material.image) : most;
        subject.slots.push_back(static_cast<uint8_t>(std::min<size_t>(slot, 7)));
    }
    subject.ownColors = !plain || model.hasColors || !model.images.empty();
    if (!subject.ownColors) return;
    std::vector<bool> done(model.vertexCount(), false);
    for (size_t i = 0; i < model.indices.size(); ++i) {
        const uint32_t vertex = model.indices[i];
        if (done[vertex]) continue;
        done[vertex] = true;
        const auto& material = model.materials[model.triangleMaterials[i / 3]];
        glm::vec3 color(material.baseColor[0], material.baseColor[1], material.baseColor[2]);
        if (material.image >= 0 && !pictured(material)) {
            color *= meanColor(model.images[static_cast<size_t>(material.image)]);
        }
        uint32_t packed = 0xff000000u;
        for (int c = 0; c < 3; ++c) {
            const uint32_t own = model.colors.empty() ? 255 : model.colors[vertex] >> (8 * c) & 255;
            const float value = color[c] * static_cast<float>(own);
            packed |= static_cast<uint32_t>(std::lround(std::clamp(value, 0.0f, 255.0f)))
                      << (8 * c);
        }
        if (model.colors.empty()) model.colors.assign(model.vertexCount(), 0xffffffffu);
        model.colors[vertex] = packed;
    }
}

}  // namespace

float Subject::size() const {
    float side = 0;
    for (size_t c = 0; c < 3; ++c) side = std::max(side, model.high[c] - model.low[c]);
    return side;
}

float Subject::height() const { return model.high[1] - model.low[1]; }

Subject loadSubject(const std::filesystem::path& file, float wantedSize) {
    Subject subject;
    if (file.empty()) {
        subject.name = "wooden toy";
        subject.model = makeToy();
    } else {
        subject.name = file.filename().string();
        std::string error;
        if (!fwimport::importGltf(file, subject.model, error)) throw sample::Failure(error);
    }
    fwimport::ImportedModel& model = subject.model;
    // Burning is a matter of metres: what is far from the size of things is brought to one metre.
    const float size = subject.size();
    if (!(size > 0)) throw sample::Failure(subject.name + " has no extent");
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
    foldColors(subject);
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

SurfacePoint matchPlace(const Subject& subject, glm::vec3 eye) {
    // Triangles that face the viewer, low but not at the very floor, near the middle; of those that
    // nothing hides, the best.
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
        const glm::vec3 way = candidates[i].position - eye;
        const SurfacePoint seen = castRay(subject, eye, glm::normalize(way));
        if (seen.hit &&
            glm::distance(seen.position, candidates[i].position) < 0.02f * subject.size()) {
            return {candidates[i].position, candidates[i].normal, true};
        }
    }
    // A flat or odd mesh: its lowest corner will do.
    SurfacePoint lowest;
    for (uint32_t i = 0; i < model.vertexCount(); ++i) {
        const glm::vec3 p = vertexOf(model, i);
        if (!lowest.hit || p.y < lowest.position.y) lowest = {p, {0, -1, 0}, true};
    }
    return lowest;
}

sample::OrbitCamera orbitAround(const Subject& subject, float yaw, float pitch,
                                VkExtent2D picture) {
    constexpr float kFilled = 0.80f;  // of the picture's height, or of its width
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
    const fwimport::ImportedModel& model = subject.model;
    std::vector<uint8_t> triangleMaterials(model.triangleCount());
    for (size_t i = 0; i < triangleMaterials.size(); ++i) {
        triangleMaterials[i] = subject.slots[model.triangleMaterials[i]];
    }
    FwMeshDef def = fwDefaultMeshDef();
    def.positions = model.positions.data();
    def.normals = model.hasNormals ? model.normals.data() : nullptr;
    // Parts without UVs have none that a picture needs.
    def.uvs = model.hasUvs || !model.images.empty() ? model.uvs.data() : nullptr;
    def.colors = subject.ownColors ? model.colors.data() : nullptr;
    def.indices = model.indices.data();
    def.triangleMaterials = triangleMaterials.data();
    def.vertexCount = static_cast<uint32_t>(model.vertexCount());
    def.indexCount = static_cast<uint32_t>(model.indices.size());
    def.mapSize = request.mapSize;
    def.texelsPerMetre = request.texelsPerMetre;
    FwMeshId id{};
    if (request.cache.empty()) {
        fire.check(fwWorld_CreateMesh(fire.world, &def, &id), "fwWorld_CreateMesh");
        note = "baked";
        return id;
    }

    fwimport::ContentHash hash;
    hash.addValue(fwGetVersion());
    hash.addValue(def.mapSize);
    hash.addValue(def.texelsPerMetre);
    hash.add(model.positions);
    if (def.normals) hash.add(model.normals);
    if (def.uvs) hash.add(model.uvs);
    if (def.colors) hash.add(model.colors);
    hash.add(model.indices);
    hash.add(triangleMaterials);
    char name[64];
    std::snprintf(name, sizeof name, "%016llx.fwburn", static_cast<unsigned long long>(hash.value));
    const std::filesystem::path path = request.cache / name;
    FwMeshDef cooked = fwDefaultMeshDef();
    if (std::ifstream file(path, std::ios::binary | std::ios::ate); file) {
        std::vector<char> bytes(static_cast<size_t>(file.tellg()));
        file.seekg(0);
        file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        cooked.cooked = bytes.data();
        cooked.cookedSize = bytes.size();
        if (file && fwWorld_CreateMesh(fire.world, &cooked, &id) == FW_OK) {
            note = "read from " + path.string();
            return id;
        }
        // A cache that cannot be read is made again.
    }
    uint64_t size = 0;
    fire.check(fwCookMesh(fire.context, &def, nullptr, &size), "fwCookMesh");
    std::vector<char> bytes(size);
    fire.check(fwCookMesh(fire.context, &def, bytes.data(), &size), "fwCookMesh");
    cooked.cooked = bytes.data();
    cooked.cookedSize = size;
    fire.check(fwWorld_CreateMesh(fire.world, &cooked, &id), "fwWorld_CreateMesh");
    std::error_code ignored;
    std::filesystem::create_directories(request.cache, ignored);
    std::ofstream file(path, std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(size));
    note = file ? "baked, kept in " + path.string() : "baked (the cache cannot be written)";
    return id;
}
