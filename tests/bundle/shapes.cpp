#include "bundle/shapes.h"

#include <algorithm>
#include <cmath>

namespace fw::bundle {
namespace {

struct Point {
    float x, y, z;
};

uint32_t addVertex(Shape& shape, Point p) {
    shape.positions.insert(shape.positions.end(), {p.x, p.y, p.z});
    return uint32_t(shape.positions.size() / 3) - 1;
}

// A polygon of three or four corners, counter-clockwise from outside.
void addSide(Shape& shape, std::vector<Point> corners, uint8_t material) {
    uint32_t first = 0;
    for (size_t i = 0; i < corners.size(); ++i) {
        const uint32_t added = addVertex(shape, corners[i]);
        if (i == 0) first = added;
    }
    for (uint32_t i = 2; i < corners.size(); ++i) {
        shape.indices.insert(shape.indices.end(), {first, first + i - 1, first + i});
        shape.materials.push_back(material);
    }
}

float length(Point p) { return std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z); }

// A lobe of the animal along `axis` (unit): adds `height` there and fades like cosine^16.
float lobe(Point direction, Point axis, float height) {
    float c = direction.x * axis.x + direction.y * axis.y + direction.z * axis.z;
    if (c <= 0) return 0;
    for (int i = 0; i < 4; ++i) c *= c;
    return height * c;
}

}  // namespace

FwMeshDef Shape::def() const {
    FwMeshDef out = fwDefaultMeshDef();
    out.positions = positions.data();
    out.vertexCount = uint32_t(positions.size() / 3);
    out.indices = indices.data();
    out.indexCount = uint32_t(indices.size());
    out.triangleMaterials = materials.empty() ? nullptr : materials.data();
    return out;
}

Shape makeHouse() {
    constexpr float x = 2, z = 2.5f, y = 2.4f, ridge = 4.2f, eaves = 2.4f, low = 2.04f;
    Shape shape;
    addSide(shape, {{-x, 0, z}, {x, 0, z}, {x, y, z}, {-x, y, z}}, 0);
    addSide(shape, {{x, 0, -z}, {-x, 0, -z}, {-x, y, -z}, {x, y, -z}}, 0);
    addSide(shape, {{x, 0, z}, {x, 0, -z}, {x, y, -z}, {x, y, z}}, 0);
    addSide(shape, {{-x, 0, -z}, {-x, 0, z}, {-x, y, z}, {-x, y, -z}}, 0);
    addSide(shape, {{-x, y, z}, {x, y, z}, {0, ridge, z}}, 0);
    addSide(shape, {{x, y, -z}, {-x, y, -z}, {0, ridge, -z}}, 0);
    addSide(shape, {{eaves, low, z}, {eaves, low, -z}, {0, ridge, -z}, {0, ridge, z}}, 1);
    addSide(shape, {{-eaves, low, -z}, {-eaves, low, z}, {0, ridge, z}, {0, ridge, -z}}, 1);
    return shape;
}

Shape makeAnimal(uint32_t cells) {
    Shape shape;
    const uint32_t side = cells + 1;
    const Point left{-0.34f, 0.92f, 0.19f}, right{0.34f, 0.92f, 0.19f}, nose{0, 0.5f, 0.87f};
    for (uint32_t face = 0; face < 6; ++face)
        for (uint32_t j = 0; j < side; ++j)
            for (uint32_t i = 0; i < side; ++i) {
                float c[3];
                const uint32_t axis = face / 2;
                const float outward = face % 2 ? 1.0f : -1.0f;
                c[axis] = outward;
                c[(axis + 1) % 3] = (2 * float(i) / float(cells) - 1) * outward;
                c[(axis + 2) % 3] = 2 * float(j) / float(cells) - 1;
                Point d{c[0], c[1], c[2]};
                const float size = length(d);
                d = {d.x / size, d.y / size, d.z / size};
                // Flat below, so that it stands.
                const float radius =
                    0.32f + lobe(d, left, 0.36f) + lobe(d, right, 0.36f) + lobe(d, nose, 0.1f);
                addVertex(shape, {radius * d.x, std::max(radius * d.y, -0.26f) + 0.26f,
                                  radius * d.z * 1.25f});
            }
    for (uint32_t face = 0; face < 6; ++face)
        for (uint32_t j = 0; j < cells; ++j)
            for (uint32_t i = 0; i < cells; ++i) {
                const uint32_t q = face * side * side + j * side + i, up = q + side;
                shape.indices.insert(shape.indices.end(), {q, q + 1, up + 1, q, up + 1, up});
            }
    return shape;
}

Shape makeSheet(float width, float height, uint32_t cells) {
    Shape shape;
    for (uint32_t j = 0; j <= cells; ++j)
        for (uint32_t i = 0; i <= cells; ++i)
            addVertex(shape, {width * (float(i) / float(cells) - 0.5f),
                              height * float(j) / float(cells), 0});
    for (uint32_t j = 0; j < cells; ++j)
        for (uint32_t i = 0; i < cells; ++i) {
            const uint32_t q = j * (cells + 1) + i, up = q + cells + 1;
            shape.indices.insert(shape.indices.end(), {q, q + 1, up + 1, q, up + 1, up});
        }
    return shape;
}

}  // namespace fw::bundle
