#include "support/meshes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <numbers>
#include <numeric>
#include <random>

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

namespace fw::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

void addQuads(Mesh& mesh, uint32_t base, int columns, int rows) {
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const uint32_t q = base + uint32_t(j * (columns + 1) + i), up = uint32_t(columns) + 1;
            mesh.addTriangle(q, q + 1, q + up + 1);
            mesh.addTriangle(q, q + up + 1, q + up);
        }
}

}  // namespace

uint32_t Mesh::addVertex(double x, double y, double z, double u, double v) {
    for (double c : {x, y, z}) positions.push_back(float(c));
    for (double c : {u, v}) uvs.push_back(float(c));
    return vertexCount() - 1;
}

void Mesh::addTriangle(uint32_t a, uint32_t b, uint32_t c) {
    indices.insert(indices.end(), {a, b, c});
}

mesh::BakeInput Mesh::input(double texelsPerMetre, uint32_t maxSide) const {
    mesh::BakeInput in;
    in.positions = positions;
    in.normals = normals;
    in.uvs = uvs;
    in.indices = indices;
    in.texelsPerMetre = texelsPerMetre;
    in.maxSide = maxSide;
    in.noiseAmplitude = 0;
    return in;
}

Mesh makePlane(double width, double height, double turnDegrees, double stretch, double tiltDegrees,
               int cells) {
    Mesh mesh;
    const double c = std::cos(turnDegrees * kDegree), s = std::sin(turnDegrees * kDegree);
    const double ct = std::cos(tiltDegrees * kDegree), st = std::sin(tiltDegrees * kDegree);
    for (int j = 0; j <= cells; ++j)
        for (int i = 0; i <= cells; ++i) {
            const double x = width * i / cells, y = height * j / cells;
            const double u = x * std::sqrt(stretch), v = y / std::sqrt(stretch);
            mesh.addVertex(x, y * ct, y * st, u * c - v * s, u * s + v * c);
        }
    addQuads(mesh, 0, cells, cells);
    return mesh;
}

Mesh makeCube(double size, int cells, bool sphere, bool turned, double gap) {
    Mesh mesh;
    for (int face = 0; face < 6; ++face) {
        const uint32_t base = mesh.vertexCount();
        const int axis = face / 2;
        const double sign = face & 1 ? 1 : -1, angle = turned ? face * 13 * kDegree : 0;
        const double step = 1 + gap + (turned ? 0.45 : 0);
        for (int j = 0; j <= cells; ++j)
            for (int i = 0; i <= cells; ++i) {
                const double a = 2.0 * i / cells - 1, b = 2.0 * j / cells - 1;
                const double wide = sphere ? std::tan(a * std::numbers::pi / 4) : a;
                const double tall = sphere ? std::tan(b * std::numbers::pi / 4) : b;
                double p[3];
                p[axis] = sign;
                p[(axis + 1) % 3] = wide * sign;
                p[(axis + 2) % 3] = tall;
                const double length =
                    sphere ? std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) : 1;
                for (double& v : p) v *= size / 2 / length;
                const double u = a / 2, v = b / 2;
                mesh.addVertex(p[0], p[1], p[2],
                               u * std::cos(angle) - v * std::sin(angle) + step * (face % 3),
                               u * std::sin(angle) + v * std::cos(angle) + step * (face / 3));
            }
        addQuads(mesh, base, cells, cells);
    }
    return mesh;
}

Mesh makeSheet(double size, int cells) {
    Mesh mesh;
    for (int y = 0; y <= cells; ++y)
        for (int x = 0; x <= cells; ++x)
            mesh.addVertex(size * x / cells, size * y / cells, 0, double(x) / cells,
                           double(y) / cells);
    for (int y = 0; y < cells; ++y)
        for (int x = 0; x < cells; ++x) {
            const uint32_t a = uint32_t(y * (cells + 1) + x), b = a + 1;
            const uint32_t c = a + uint32_t(cells) + 1, d = c + 1;
            if ((x + y) & 1) {
                mesh.addTriangle(a, b, c);
                mesh.addTriangle(b, d, c);
            } else {
                mesh.addTriangle(a, b, d);
                mesh.addTriangle(a, d, c);
            }
        }
    return mesh;
}

Mesh makeCylinder(double radius, double height, int segments, int rows, int cuts, bool turned) {
    Mesh mesh;
    double offset = 0;
    for (int cut = 0; cut < cuts; ++cut) {
        const int from = segments * cut / cuts, count = segments * (cut + 1) / cuts - from;
        const uint32_t base = mesh.vertexCount();
        const double angle = turned ? (17 + 29 * cut) * kDegree : 0;
        const double width = 2 * std::numbers::pi * radius * count / segments;
        for (int j = 0; j <= rows; ++j)
            for (int i = 0; i <= count; ++i) {
                const double a = 2 * std::numbers::pi * (from + i) / segments;
                const double u = width * i / count, v = height * j / rows;
                mesh.addVertex(radius * std::cos(a), height * j / rows, radius * std::sin(a),
                               offset + u * std::cos(angle) - v * std::sin(angle),
                               u * std::sin(angle) + v * std::cos(angle));
            }
        addQuads(mesh, base, count, rows);
        offset += std::hypot(width, height) * 2 + 0.1;
    }
    return mesh;
}

Mesh makeConfetti(double size, int cells, double gap) {
    Mesh mesh;
    std::mt19937 random(5);
    const double c = size / cells;
    const int per = int(std::ceil(std::sqrt(2.0 * cells * cells)));
    std::vector<int> slots(size_t(per) * size_t(per));
    std::iota(slots.begin(), slots.end(), 0);
    for (size_t i = slots.size() - 1; i > 0; --i) std::swap(slots[i], slots[random() % (i + 1)]);
    size_t next = 0;
    for (int j = 0; j < cells; ++j)
        for (int i = 0; i < cells; ++i)
            for (int half = 0; half < 2; ++half) {
                const double corners[2][3][2] = {{{0, 0}, {1, 0}, {1, 1}},
                                                 {{0, 0}, {1, 1}, {0, 1}}};
                const int slot = slots[next++];
                const double angle = double(random() % 4) * std::numbers::pi / 2 + 0.3;
                const uint32_t base = mesh.vertexCount();
                for (const auto& corner : corners[half]) {
                    const double u = (corner[0] - 0.5) * c, v = (corner[1] - 0.5) * c;
                    const double pitch = c * 1.45 + gap;
                    mesh.addVertex(
                        (i + corner[0]) * c, (j + corner[1]) * c, 0,
                        u * std::cos(angle) - v * std::sin(angle) + (slot % per) * pitch,
                        u * std::sin(angle) + v * std::cos(angle) + (slot / per) * pitch);
                }
                mesh.addTriangle(base, base + 1, base + 2);
            }
    return mesh;
}

Mesh makeStrips(double size, int strips, double gap) {
    Mesh mesh;
    const double c = size / strips;
    for (int i = 0; i < strips; ++i) {
        const uint32_t base = mesh.vertexCount();
        for (int q = 0; q < 4; ++q) {
            const double x = (q & 1) * c, y = (q >> 1) * size;
            mesh.addVertex(i * c + x, y, 0, i * (c * 1.2 + gap) + x, y);
        }
        mesh.addTriangle(base, base + 1, base + 3);
        mesh.addTriangle(base, base + 3, base + 2);
    }
    return mesh;
}

Mesh makeSoup(uint32_t seed) {
    Mesh mesh;
    std::mt19937 random(seed * 2654435761u + 9);
    const uint32_t vertices = 4 + random() % 40, triangles = 1 + random() % 80;
    for (uint32_t i = 0; i < vertices; ++i) {
        const double flat = random() % 5 == 0 ? 0 : 1;
        const double x = double(random() % 100) / 100 * flat, y = double(random() % 100) / 100;
        const double z = double(random() % 100) / 100, u = double(random() % 30) / 30;
        mesh.addVertex(x, y, z, u, double(random() % 30) / 30 * flat);
    }
    for (uint32_t i = 0; i < triangles; ++i) {
        const uint32_t a = random() % vertices, b = random() % vertices, c = random() % vertices;
        mesh.addTriangle(a, b, c);
    }
    return mesh;
}

Mesh randomUnwrap(const Mesh& mesh, uint32_t seed, uint32_t islandTriangles) {
    std::mt19937 random(seed);
    const uint32_t count = mesh.triangleCount();
    using Point = std::array<float, 3>;
    const auto pointOf = [&](uint32_t vertex) {
        return Point{mesh.positions[vertex * 3], mesh.positions[vertex * 3 + 1],
                     mesh.positions[vertex * 3 + 2]};
    };
    const auto normalOf = [&](uint32_t t) {
        std::array<double, 3> e1{}, e2{};
        for (size_t k = 0; k < 3; ++k) {
            const double a = double(pointOf(mesh.indices[t * 3])[k]);
            e1[k] = double(pointOf(mesh.indices[t * 3 + 1])[k]) - a;
            e2[k] = double(pointOf(mesh.indices[t * 3 + 2])[k]) - a;
        }
        return std::array<double, 3>{e1[1] * e2[2] - e1[2] * e2[1], e1[2] * e2[0] - e1[0] * e2[2],
                                     e1[0] * e2[1] - e1[1] * e2[0]};
    };
    const auto lengthOf = [](const std::array<double, 3>& v) {
        return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    };
    std::map<std::pair<Point, Point>, std::vector<uint32_t>> edges;
    for (uint32_t t = 0; t < count; ++t)
        for (uint32_t e = 0; e < 3; ++e) {
            Point a = pointOf(mesh.indices[t * 3 + e]),
                  b = pointOf(mesh.indices[t * 3 + (e + 1) % 3]);
            if (b < a) std::swap(a, b);
            edges[{a, b}].push_back(t);
        }
    std::vector<std::vector<uint32_t>> beside(count);
    for (const auto& [edge, users] : edges)
        for (uint32_t a : users)
            for (uint32_t b : users)
                if (a != b) beside[a].push_back(b);

    std::vector<uint32_t> seeds(count), island(count, count);
    std::iota(seeds.begin(), seeds.end(), 0u);
    for (size_t i = seeds.size() - 1; i > 0; --i) std::swap(seeds[i], seeds[random() % (i + 1)]);
    Mesh out;
    double x = 0, y = 0, rowHeight = 0, total = 0;
    for (uint32_t t = 0; t < count; ++t) total += lengthOf(normalOf(t)) / 2;
    const double rowWidth = std::sqrt(total) * 1.6;
    for (uint32_t seed0 : seeds) {
        if (island[seed0] != count) continue;
        std::vector<uint32_t> members{seed0};
        island[seed0] = seed0;
        const auto axis = normalOf(seed0);
        const double axisLength = std::max(lengthOf(axis), 1e-30);
        for (size_t head = 0; head < members.size() && members.size() < islandTriangles; ++head)
            for (uint32_t n : beside[members[head]]) {
                const auto normal = normalOf(n);
                const double cosine =
                    (normal[0] * axis[0] + normal[1] * axis[1] + normal[2] * axis[2]) /
                    std::max(1e-30, lengthOf(normal) * axisLength);
                if (island[n] != count || cosine < 0.75) continue;
                island[n] = seed0;
                members.push_back(n);
            }
        // Flattens along the axis, rotates, places in rows.
        const size_t least = std::abs(axis[0]) < std::abs(axis[1])
                                 ? (std::abs(axis[0]) < std::abs(axis[2]) ? 0 : 2)
                                 : (std::abs(axis[1]) < std::abs(axis[2]) ? 1 : 2);
        std::array<double, 3> helper{}, u{}, v{};
        helper[least] = 1;
        for (size_t k = 0; k < 3; ++k)
            u[k] =
                helper[(k + 1) % 3] * axis[(k + 2) % 3] - helper[(k + 2) % 3] * axis[(k + 1) % 3];
        const double uLength = std::max(lengthOf(u), 1e-30);
        for (double& c : u) c /= uLength;
        for (size_t k = 0; k < 3; ++k)
            v[k] = (axis[(k + 1) % 3] * u[(k + 2) % 3] - axis[(k + 2) % 3] * u[(k + 1) % 3]) /
                   axisLength;
        const double angle = double(random() % 3600) / 10 * kDegree;
        std::vector<std::array<double, 2>> flat;
        std::array<double, 2> low{1e30, 1e30}, high{-1e30, -1e30};
        for (uint32_t t : members)
            for (uint32_t k = 0; k < 3; ++k) {
                const Point p = pointOf(mesh.indices[t * 3 + k]);
                double s = 0, w = 0;
                for (size_t c = 0; c < 3; ++c) {
                    s += double(p[c]) * u[c];
                    w += double(p[c]) * v[c];
                }
                flat.push_back({s * std::cos(angle) - w * std::sin(angle),
                                s * std::sin(angle) + w * std::cos(angle)});
                for (size_t c = 0; c < 2; ++c) {
                    low[c] = std::min(low[c], flat.back()[c]);
                    high[c] = std::max(high[c], flat.back()[c]);
                }
            }
        const double gap = 0.02;
        if (x + high[0] - low[0] > rowWidth) {
            x = 0;
            y += rowHeight + gap;
            rowHeight = 0;
        }
        std::map<std::pair<uint32_t, uint32_t>, uint32_t> made;
        for (size_t i = 0; i < flat.size(); ++i) {
            const uint32_t vertex = mesh.indices[members[i / 3] * 3 + i % 3];
            auto [it, isNew] = made.try_emplace({vertex, seed0}, 0u);
            if (isNew) {
                const Point p = pointOf(vertex);
                it->second = out.addVertex(double(p[0]), double(p[1]), double(p[2]),
                                           x + flat[i][0] - low[0], y + flat[i][1] - low[1]);
            }
            out.indices.push_back(it->second);
        }
        x += high[0] - low[0] + gap;
        rowHeight = std::max(rowHeight, high[1] - low[1]);
    }
    return out;
}

std::string assetPath(const std::string& name) {
    const char* folder = std::getenv("FLAMEWRIGHT_ASSETS");
    return folder && *folder ? std::string(folder) + "/" + name : std::string();
}

bool loadGlb(const std::string& nameOrPath, Mesh& mesh, std::string& error) {
    const std::string path = nameOrPath.starts_with("/") ? nameOrPath : assetPath(nameOrPath);
    if (path.empty()) {
        error = "FLAMEWRIGHT_ASSETS is not set, so " + nameOrPath + " is not there";
        return false;
    }
    tinygltf::Model model;
    tinygltf::TinyGLTF loader;
    std::string warning;
    loader.SetImageLoader([](tinygltf::Image*, const int, std::string*, std::string*, int, int,
                             const unsigned char*, int, void*) { return true; },
                          nullptr);
    if (!loader.LoadBinaryFromFile(&model, &error, &warning, path)) return false;
    const auto data = [&](int accessor, size_t& stride) {
        const auto& a = model.accessors[size_t(accessor)];
        const auto& view = model.bufferViews[size_t(a.bufferView)];
        stride = size_t(a.ByteStride(view));
        return model.buffers[size_t(view.buffer)].data.data() + view.byteOffset + a.byteOffset;
    };
    mesh = {};
    bool allNormals = true, allUvs = true;
    for (const auto& part : model.meshes)
        for (const auto& primitive : part.primitives) {
            allNormals &= primitive.attributes.count("NORMAL") > 0;
            allUvs &= primitive.attributes.count("TEXCOORD_0") > 0;
        }
    for (const auto& part : model.meshes)
        for (const auto& primitive : part.primitives) {
            const uint32_t base = mesh.vertexCount();
            const int position = primitive.attributes.at("POSITION");
            const size_t count = model.accessors[size_t(position)].count;
            const auto append = [&](int accessor, size_t width, std::vector<float>& to) {
                size_t stride = 0;
                const unsigned char* from = data(accessor, stride);
                for (size_t i = 0; i < count; ++i) {
                    float v[3];
                    std::memcpy(v, from + i * stride, width * sizeof(float));
                    to.insert(to.end(), v, v + width);
                }
            };
            append(position, 3, mesh.positions);
            if (allNormals) append(primitive.attributes.at("NORMAL"), 3, mesh.normals);
            if (allUvs) append(primitive.attributes.at("TEXCOORD_0"), 2, mesh.uvs);
            size_t stride = 0;
            const unsigned char* from = data(primitive.indices, stride);
            const auto& accessor = model.accessors[size_t(primitive.indices)];
            for (size_t i = 0; i < accessor.count; ++i) {
                uint32_t index = 0;  // 8, 16 or 32 bits, little-endian
                std::memcpy(&index, from + i * stride, std::min<size_t>(stride, 4));
                mesh.indices.push_back(base + index);
            }
        }
    return true;
}

}  // namespace fw::test
