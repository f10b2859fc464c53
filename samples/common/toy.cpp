// See toy.h.
#include "common/toy.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <unordered_map>

namespace {

constexpr float kScale = 1.4f;    // from the units of the model below to metres
constexpr float kCell = 0.0088f;  // in units of the model

float ball(glm::vec3 p, glm::vec3 center, glm::vec3 radii) {
    const glm::vec3 q = (p - center) / radii;
    const float k = glm::length(q), g = glm::length(q / radii);
    return g > 0 ? k * (k - 1.0f) / g : -std::min({radii.x, radii.y, radii.z});
}

// A rod with a linearly varying radius.
float rod(glm::vec3 p, glm::vec3 a, glm::vec3 b, float radiusA, float radiusB) {
    const glm::vec3 ab = b - a;
    const float t = std::clamp(glm::dot(p - a, ab) / glm::dot(ab, ab), 0.0f, 1.0f);
    return glm::length(p - a - t * ab) - glm::mix(radiusA, radiusB, t);
}

float blend(float a, float b, float width) {
    const float h = std::max(width - std::abs(a - b), 0.0f) / width;
    return std::min(a, b) - 0.25f * width * h * h;
}

// Approximate signed distance to the elephant, negative inside. It looks along +x.
float elephant(glm::vec3 p) {
    const glm::vec3 m(p.x, p.y, std::abs(p.z));  // symmetric in z
    float d = ball(p, {0.0f, 0.235f, 0.0f}, {0.175f, 0.125f, 0.115f});
    d = blend(d, ball(p, {-0.07f, 0.24f, 0.0f}, {0.12f, 0.12f, 0.11f}), 0.05f);
    d = blend(d, ball(p, {0.19f, 0.305f, 0.0f}, {0.088f, 0.092f, 0.078f}), 0.05f);
    d = blend(d, rod(p, {0.25f, 0.285f, 0.0f}, {0.305f, 0.195f, 0.0f}, 0.044f, 0.034f), 0.04f);
    d = blend(d, rod(p, {0.305f, 0.195f, 0.0f}, {0.325f, 0.105f, 0.0f}, 0.034f, 0.027f), 0.02f);
    d = blend(d, rod(p, {0.325f, 0.105f, 0.0f}, {0.375f, 0.075f, 0.0f}, 0.027f, 0.021f), 0.02f);
    d = blend(d, rod(m, {0.235f, 0.245f, 0.045f}, {0.31f, 0.215f, 0.072f}, 0.014f, 0.006f), 0.015f);
    // Ears: thin, leaning back and out.
    glm::vec3 q = m - glm::vec3(0.135f, 0.315f, 0.098f);
    q = glm::vec3(0.88f * q.x + 0.47f * q.z, q.y, -0.47f * q.x + 0.88f * q.z);
    d = blend(d, ball(q, glm::vec3(0), {0.082f, 0.098f, 0.021f}), 0.02f);
    d = blend(d, rod(m, {0.105f, 0.17f, 0.062f}, {0.11f, 0.0f, 0.064f}, 0.047f, 0.043f), 0.03f);
    d = blend(d, rod(m, {-0.105f, 0.17f, 0.062f}, {-0.11f, 0.0f, 0.064f}, 0.05f, 0.044f), 0.03f);
    d = blend(d, rod(p, {-0.17f, 0.275f, 0.0f}, {-0.225f, 0.16f, 0.0f}, 0.016f, 0.010f), 0.02f);
    d = blend(d, ball(p, {-0.228f, 0.15f, 0.0f}, {0.016f, 0.028f, 0.016f}), 0.01f);
    return std::max(d, 0.004f - p.y);  // flat below
}

}  // namespace

fwimport::ImportedModel makeToy() {
    const glm::vec3 low(-0.27f, -0.02f, -0.18f), high(0.42f, 0.44f, 0.18f);
    const glm::ivec3 cells = glm::ivec3((high - low) / kCell) + 1;
    const glm::ivec3 points = cells + 1;
    auto indexOf = [&](glm::ivec3 c) {
        return static_cast<uint32_t>((c.z * points.y + c.y) * points.x + c.x);
    };
    auto placeOf = [&](glm::ivec3 c) { return low + kCell * glm::vec3(c); };
    std::vector<float> field(static_cast<size_t>(points.x * points.y * points.z));
    for (int z = 0; z < points.z; ++z) {
        for (int y = 0; y < points.y; ++y) {
            for (int x = 0; x < points.x; ++x) {
                const float d = elephant(placeOf({x, y, z}));
                // A corner exactly on the surface would create triangles without area.
                field[indexOf({x, y, z})] = std::abs(d) < 1e-5f ? 1e-5f : d;
            }
        }
    }

    fwimport::ImportedModel model;
    std::unordered_map<uint64_t, uint32_t> vertices;  // by the grid edge that they lie on
    auto vertexOn = [&](glm::ivec3 a, glm::ivec3 b) {
        uint64_t i = indexOf(a), j = indexOf(b);
        if (i > j) std::swap(i, j), std::swap(a, b);
        const auto [found, fresh] =
            vertices.emplace(i << 32 | j, static_cast<uint32_t>(model.vertexCount()));
        if (!fresh) return found->second;
        const float da = field[i], db = field[j];
        // Keep the cut off the ends, so that slivers stay rare.
        const float t = std::clamp(da / (da - db), 0.05f, 0.95f);
        const glm::vec3 p = glm::mix(placeOf(a), placeOf(b), t);
        constexpr float kStep = 0.002f;
        const glm::vec3 gradient(
            elephant(p + glm::vec3(kStep, 0, 0)) - elephant(p - glm::vec3(kStep, 0, 0)),
            elephant(p + glm::vec3(0, kStep, 0)) - elephant(p - glm::vec3(0, kStep, 0)),
            elephant(p + glm::vec3(0, 0, kStep)) - elephant(p - glm::vec3(0, 0, kStep)));
        const glm::vec3 n = glm::normalize(gradient + glm::vec3(1e-9f));
        for (int c = 0; c < 3; ++c) {
            model.positions.push_back(kScale * (p[c] - (c == 1 ? 0.004f : 0.0f)));
            model.normals.push_back(n[c]);
        }
        return found->second;
    };
    auto triangle = [&](uint32_t a, uint32_t b, uint32_t c) {
        model.indices.insert(model.indices.end(), {a, b, c});
        model.triangleMaterials.push_back(0);
    };
    // Six tetrahedra around the diagonal of a cell, all with the same orientation.
    constexpr int kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                   {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    for (int z = 0; z < cells.z; ++z) {
        for (int y = 0; y < cells.y; ++y) {
            for (int x = 0; x < cells.x; ++x) {
                for (int k = 0; k < 6; ++k) {
                    glm::ivec3 corner[4];
                    corner[0] = {x, y, z};
                    for (int i = 0; i < 3; ++i) {
                        corner[i + 1] = corner[i];
                        ++corner[i + 1][kOrders[k][i]];
                    }
                    if (k >= 3) std::swap(corner[1], corner[2]);
                    int in[4], out[4], ins = 0, outs = 0;
                    for (int i = 0; i < 4; ++i) {
                        if (field[indexOf(corner[i])] < 0) {
                            in[ins++] = i;
                        } else {
                            out[outs++] = i;
                        }
                    }
                    if (ins == 0 || outs == 0) continue;
                    // An even permutation of the corners keeps the winding.
                    int order[4];
                    std::copy(in, in + ins, order);
                    std::copy(out, out + outs, order + ins);
                    bool odd = false;
                    for (int i = 0; i < 4; ++i) {
                        for (int j = i + 1; j < 4; ++j) odd ^= order[i] > order[j];
                    }
                    auto cut = [&](int i, int j) { return vertexOn(corner[i], corner[j]); };
                    // The cut is a triangle around a single corner, or a quad between two pairs.
                    std::vector<uint32_t> ring;
                    if (ins == 1) {
                        ring = {cut(in[0], out[0]), cut(in[0], out[1]), cut(in[0], out[2])};
                    } else if (ins == 3) {
                        ring = {cut(in[0], out[0]), cut(in[1], out[0]), cut(in[2], out[0])};
                    } else {
                        ring = {cut(in[0], out[0]), cut(in[0], out[1]), cut(in[1], out[1]),
                                cut(in[1], out[0])};
                    }
                    if (odd) std::reverse(ring.begin(), ring.end());
                    for (size_t i = 1; i + 1 < ring.size(); ++i) {
                        triangle(ring[0], ring[i], ring[i + 1]);
                    }
                }
            }
        }
    }
    model.materials.resize(1);
    model.materials[0].name = "wood";
    model.hasNormals = true;
    for (size_t c = 0; c < 3; ++c) model.low[c] = model.high[c] = model.positions[c];
    for (size_t i = 0; i < model.positions.size(); ++i) {
        model.low[i % 3] = std::min(model.low[i % 3], model.positions[i]);
        model.high[i % 3] = std::max(model.high[i % 3], model.positions[i]);
    }
    return model;
}
