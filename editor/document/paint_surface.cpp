// Builds the surface to paint on from the burn map's texels and the triangles below them.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <tuple>

#include "document/world_parts.h"
#include "flamewright/flamewright_debug.h"

namespace fwedit {
namespace {

using fwimport::ImportedModel;

Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vec3 corner(const ImportedModel& model, size_t index) {
    const size_t v = model.indices[index];
    return {model.positions[v * 3], model.positions[v * 3 + 1], model.positions[v * 3 + 2]};
}

float squareToTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 n = cross(minus(b, a), minus(c, a));
    const float nn = dot(n, n);
    const Vec3 corners[3] = {a, b, c};
    bool inside = nn > 0;
    float nearest = 1e30f;
    for (size_t i = 0; i < 3; ++i) {
        const Vec3 from = corners[i], edge = minus(corners[(i + 1) % 3], from);
        const Vec3 off = minus(p, from);
        inside = inside && dot(cross(edge, off), n) >= 0;
        const float length = dot(edge, edge);
        const float t = length > 0 ? std::clamp(dot(off, edge) / length, 0.0f, 1.0f) : 0.0f;
        const Vec3 rest = {off[0] - t * edge[0], off[1] - t * edge[1], off[2] - t * edge[2]};
        nearest = std::min(nearest, dot(rest, rest));
    }
    if (!inside) return nearest;
    const float height = dot(minus(p, a), n);
    return height * height / nn;
}

// Triangles by the grid cells that their boxes overlap.
struct TriangleGrid {
    Vec3 low{};
    float cell = 1;
    std::array<uint32_t, 3> cells{1, 1, 1};
    std::vector<uint32_t> begin, triangles;

    [[nodiscard]] std::array<uint32_t, 3> cellAt(const Vec3& p, float grown) const {
        std::array<uint32_t, 3> at{};
        for (size_t k = 0; k < 3; ++k) {
            const float along = std::floor((p[k] + grown - low[k]) / cell);
            at[k] =
                static_cast<uint32_t>(std::clamp(along, 0.0f, static_cast<float>(cells[k] - 1)));
        }
        return at;
    }
};

TriangleGrid gridOf(const ImportedModel& model, float spacing) {
    TriangleGrid grid;
    grid.low = model.low;
    float longest = 0;
    for (size_t k = 0; k < 3; ++k) longest = std::max(longest, model.high[k] - model.low[k]);
    const float preferred =
        longest / std::clamp(std::sqrt(static_cast<float>(model.triangleCount())), 8.0f, 96.0f);
    grid.cell = std::max({preferred, spacing, 1e-6f});
    for (size_t k = 0; k < 3; ++k)
        grid.cells[k] = static_cast<uint32_t>((model.high[k] - model.low[k]) / grid.cell) + 1;
    grid.begin.assign(size_t{grid.cells[0]} * grid.cells[1] * grid.cells[2] + 1, 0);
    const auto touched = [&](size_t t, auto&& visit) {
        Vec3 low = corner(model, t * 3), high = low;
        for (size_t i = 1; i < 3; ++i)
            for (size_t k = 0; k < 3; ++k) {
                low[k] = std::min(low[k], corner(model, t * 3 + i)[k]);
                high[k] = std::max(high[k], corner(model, t * 3 + i)[k]);
            }
        const auto from = grid.cellAt(low, -spacing), to = grid.cellAt(high, spacing);
        for (uint32_t z = from[2]; z <= to[2]; ++z)
            for (uint32_t y = from[1]; y <= to[1]; ++y)
                for (uint32_t x = from[0]; x <= to[0]; ++x)
                    visit((size_t{z} * grid.cells[1] + y) * grid.cells[0] + x);
    };
    for (size_t t = 0; t < model.triangleCount(); ++t)
        touched(t, [&](size_t cell) { ++grid.begin[cell + 1]; });
    std::partial_sum(grid.begin.begin(), grid.begin.end(), grid.begin.begin());
    grid.triangles.resize(grid.begin.back());
    std::vector<uint32_t> next(grid.begin.begin(), grid.begin.end() - 1);
    for (size_t t = 0; t < model.triangleCount(); ++t)
        touched(t, [&](size_t cell) { grid.triangles[next[cell]++] = static_cast<uint32_t>(t); });
    return grid;
}

uint32_t rootOf(std::vector<uint32_t>& parents, uint32_t at) {
    while (parents[at] != at) at = parents[at] = parents[parents[at]];
    return at;
}

// Assigns each triangle its connected part. Corners at equal positions are connected.
std::vector<uint32_t> piecesOf(const ImportedModel& model) {
    const size_t vertices = model.vertexCount();
    std::vector<uint32_t> order(vertices), parents(vertices);
    std::iota(order.begin(), order.end(), 0u);
    std::iota(parents.begin(), parents.end(), 0u);
    const auto place = [&](uint32_t v) { return model.positions.data() + size_t{v} * 3; };
    const auto before = [&](uint32_t a, uint32_t b) {
        return std::lexicographical_compare(place(a), place(a) + 3, place(b), place(b) + 3);
    };
    std::sort(order.begin(), order.end(), before);
    for (size_t i = 1; i < vertices; ++i)
        if (!before(order[i - 1], order[i]))
            parents[rootOf(parents, order[i])] = rootOf(parents, order[i - 1]);
    for (size_t i = 0; i < model.indices.size(); ++i)
        parents[rootOf(parents, model.indices[i])] = rootOf(parents, model.indices[i - i % 3]);
    std::vector<uint32_t> pieces(model.triangleCount());
    for (size_t t = 0; t < pieces.size(); ++t) pieces[t] = rootOf(parents, model.indices[t * 3]);
    return pieces;
}

// Texels that are adjacent in the map and on the surface form an island.
void findIslands(PaintSurface& surface) {
    surface.island.assign(surface.real.size(), ~0u);
    const float reach = 3 * surface.spacing;
    std::vector<size_t> open;
    uint32_t islands = 0;
    for (size_t start = 0; start < surface.real.size(); ++start) {
        if (!surface.real[start] || surface.island[start] != ~0u) continue;
        open = {start};
        surface.island[start] = islands;
        while (!open.empty()) {
            const size_t at = open.back();
            open.pop_back();
            const size_t x = at % surface.width, y = at / surface.width;
            const auto visit = [&](size_t other) {
                if (!surface.real[other] || surface.island[other] != ~0u) return;
                const Vec3 off = {surface.positions[at * 3] - surface.positions[other * 3],
                                  surface.positions[at * 3 + 1] - surface.positions[other * 3 + 1],
                                  surface.positions[at * 3 + 2] - surface.positions[other * 3 + 2]};
                if (dot(off, off) > reach * reach) return;
                surface.island[other] = islands;
                open.push_back(other);
            };
            if (x > 0) visit(at - 1);
            if (x + 1 < surface.width) visit(at + 1);
            if (y > 0) visit(at - surface.width);
            if (y + 1 < surface.height) visit(at + surface.width);
        }
        ++islands;
    }
    surface.islands = islands;
}

// Edges with only one triangle in the map.
void findSeams(PaintSurface& surface) {
    using Place = std::array<int32_t, 2>;
    struct Edge {
        Place low, high;
        uint32_t from, to;  // corners
    };
    const auto placeOf = [&](uint32_t corner) {
        constexpr float kFine = 64;  // subdivisions of a texel
        const float* place = surface.corners.data() + size_t{corner} * 5 + 3;
        return Place{static_cast<int32_t>(std::lround(place[0] * kFine)),
                     static_cast<int32_t>(std::lround(place[1] * kFine))};
    };
    const auto count = static_cast<uint32_t>(surface.corners.size() / 5);
    std::vector<Edge> edges;
    edges.reserve(count);
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t next = i % 3 == 2 ? i - 2 : i + 1;
        const Place a = placeOf(i), b = placeOf(next);
        edges.push_back({std::min(a, b), std::max(a, b), i, next});
    }
    const auto key = [](const Edge& edge) { return std::tie(edge.low, edge.high); };
    std::sort(edges.begin(), edges.end(),
              [&](const Edge& a, const Edge& b) { return key(a) < key(b); });
    for (size_t i = 0; i < edges.size();) {
        size_t end = i + 1;
        while (end < edges.size() && key(edges[end]) == key(edges[i])) ++end;
        if (end == i + 1) {
            const float* from = surface.corners.data() + size_t{edges[i].from} * 5;
            const float* to = surface.corners.data() + size_t{edges[i].to} * 5;
            surface.seams.push_back({{from[3], from[4]},
                                     {to[3], to[4]},
                                     {from[0], from[1], from[2]},
                                     {to[0], to[1], to[2]}});
        }
        i = end;
    }
}

}  // namespace

bool surfaceOfBake(FwContext* context, const std::vector<char>& bake, const ImportedModel& model,
                   const std::vector<uint8_t>& slots, PaintSurface& surface, std::string& error) {
    Burn burn;
    burn.context = context;
    const FwWorldDef worldDef = fwDefaultWorldDef();
    FwResult result = fwCreateWorld(context, &worldDef, &burn.world);
    FwMeshDef cooked = fwDefaultMeshDef();
    cooked.cooked = bake.data();
    cooked.cookedSize = bake.size();
    FwMeshId mesh{};
    if (result >= 0) result = fwWorld_CreateMesh(burn.world, &cooked, &mesh);
    FwMeshInfo info{};
    info.structSize = sizeof info;
    if (result >= 0) result = fwWorld_GetMeshInfo(burn.world, mesh, &info);
    const size_t texels = size_t{info.mapWidth} * info.mapHeight;
    std::vector<uint32_t> flags(texels);
    surface.positions.resize(texels * 3);
    uint64_t count = 0;
    if (result >= 0)
        result = fwDebug_GetTexelPositions(burn.world, mesh, surface.positions.data(), flags.data(),
                                           texels, &count);
    if (result >= 0) result = fwDebug_GetUnwrap(burn.world, mesh, nullptr, 0, &count);
    surface.corners.resize(count * 5);
    if (result >= 0)
        result = fwDebug_GetUnwrap(burn.world, mesh, surface.corners.data(), count, &count);
    if (result < 0) {
        error = worldProblem(burn, result);
        return false;
    }
    surface.width = info.mapWidth;
    surface.height = info.mapHeight;
    surface.spacing = info.texelsPerMetre > 0 ? 1 / info.texelsPerMetre : 0.01f;
    surface.real.resize(texels);
    for (size_t i = 0; i < texels; ++i) surface.real[i] = flags[i] != 0;

    const TriangleGrid grid = gridOf(model, surface.spacing);
    const std::vector<uint32_t> pieces = piecesOf(model);
    surface.normals.assign(texels * 3, 0.0f);
    surface.piece.assign(texels, 0);
    surface.material.assign(texels, 0);
    for (size_t i = 0; i < texels; ++i) {
        if (!surface.real[i]) continue;
        const Vec3 p = {surface.positions[i * 3], surface.positions[i * 3 + 1],
                        surface.positions[i * 3 + 2]};
        const auto at = grid.cellAt(p, 0);
        const size_t cell = (size_t{at[2]} * grid.cells[1] + at[1]) * grid.cells[0] + at[0];
        float nearest = 1e30f;
        uint32_t best = 0;
        for (uint32_t j = grid.begin[cell]; j < grid.begin[cell + 1]; ++j) {
            const size_t t = grid.triangles[j];
            const float square = squareToTriangle(p, corner(model, t * 3), corner(model, t * 3 + 1),
                                                  corner(model, t * 3 + 2));
            if (square < nearest) {
                nearest = square;
                best = static_cast<uint32_t>(t);
            }
        }
        const Vec3 a = corner(model, size_t{best} * 3);
        const Vec3 n = cross(minus(corner(model, size_t{best} * 3 + 1), a),
                             minus(corner(model, size_t{best} * 3 + 2), a));
        const float length = std::sqrt(dot(n, n));
        for (size_t k = 0; k < 3; ++k) surface.normals[i * 3 + k] = length > 0 ? n[k] / length : 0;
        surface.piece[i] = pieces[best];
        surface.material[i] = slots[best];
    }
    findIslands(surface);
    findSeams(surface);
    indexSurface(surface);
    return true;
}

std::vector<uint8_t> multiplierOf(const Scene& scene, const PaintImages& images, ObjectId mesh,
                                  uint32_t& width, uint32_t& height) {
    std::vector<float> product;
    const Mesh* owner = findIn(scene.meshes, mesh);
    width = height = 0;
    for (const PaintLayer& layer : scene.layers) {
        const auto found = images.find(layer.id);
        if (layer.mesh != mesh || layer.hidden || found == images.end() ||
            found->second.width == 0 || !owner)
            continue;
        const PaintImage& image = found->second;
        if (product.empty()) {
            width = image.width;
            height = image.height;
            product.assign(size_t{width} * height, 1.0f);
        }
        const PaintImage fitted = image.width == width && image.height == height
                                      ? image
                                      : resizedPaint(image, layer.kind, width, height);
        const std::vector<uint8_t> values = fitted.flat();
        FwMaterialDef own = fwDefaultMaterialDef();
        fwInitMaterialPreset(&own, owner->materials[0]);
        for (size_t i = 0; i < values.size(); ++i) {
            float factor = 1;
            if (layer.kind == PaintMultiplier) {
                factor = static_cast<float>(values[i]) / 128;
            } else if (layer.kind == PaintMoisture) {
                // Water in the fuel slows the fire and stops it above a limit.
                const float wet = static_cast<float>(values[i]) / 255;
                const float room = own.extinctionMoisture - own.moisture;
                factor = room > 0 ? std::clamp(1 - wet / room, 0.0f, 1.0f) : 1;
            } else if (values[i] > 0) {
                FwMaterialDef other = fwDefaultMaterialDef();
                fwInitMaterialPreset(&other, values[i] - 1u);
                factor = own.spreadRate > 0 ? other.spreadRate / own.spreadRate : 1;
            }
            product[i] *= 1 + (factor - 1) * layer.strength;
        }
    }
    std::vector<uint8_t> bytes(product.size());
    for (size_t i = 0; i < product.size(); ++i)
        bytes[i] = static_cast<uint8_t>(std::lround(std::clamp(product[i] * 128, 0.0f, 255.0f)));
    return bytes;
}

}  // namespace fwedit
