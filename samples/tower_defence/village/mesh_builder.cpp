// The shapes, the shelf packer and the normals of mesh_builder.h.
#include "mesh_builder.h"

#include <cstring>
#include <map>
#include <tuple>
#include <utility>

namespace village {

MeshBuilder::MeshBuilder(std::string name, uint32_t modelSeed, int burnTexels) : seed(modelSeed) {
    model_.name = std::move(name);
    model_.burnTexels = burnTexels;
}

void MeshBuilder::use(Texture texture, Material material, Vec3 newTint, float glow) {
    texture_ = texture;
    material_ = material;
    tint = newTint;
    glow_ = glow;
}

float MeshBuilder::random() { return float(hash(seed++ * 747796405u + 1)) * (1 / 4294967296.0f); }

float MeshBuilder::random(float low, float high) { return low + (high - low) * random(); }

int MeshBuilder::addChart(float width, float height) {
    charts_.push_back({width, height});
    return int(charts_.size()) - 1;
}

void MeshBuilder::addTriangle(Vec3 a, Vec3 b, Vec3 c, Vec2 uvA, Vec2 uvB, Vec2 uvC, int chart) {
    if (length(cross(b - a, c - a)) < 1e-6f)
        return;  // degenerate triangles at the poles of lathes
                 // and blobs
    const std::pair<Vec3, Vec2> points[3] = {{a, uvA}, {b, uvB}, {c, uvC}};
    for (const auto& [position, uv] : points) {
        Vertex vertex;
        vertex.position = position;
        vertex.uv = uv;
        vertex.tint = tint;
        vertex.glow = glow_;
        vertex.sway = sway.yield * (position.y - sway.root) * (position.y - sway.root);
        vertex.texture = texture_;
        vertex.material = material_;
        corners_.push_back({vertex, chart, group_, crease, fine});
    }
}

void MeshBuilder::grid(int columns, int rows, float width, float height,
                       const std::function<Vec3(float, float)>& place) {
    const int chart = sideways_ ? addChart(height, width) : addChart(width, height);
    ++group_;
    auto point = [&](int i, int j) {
        return frame.point(place(float(i) / float(columns), float(j) / float(rows)));
    };
    auto uv = [&](int i, int j) {
        const float u = width * float(i) / float(columns), v = height * float(j) / float(rows);
        return sideways_ ? Vec2{height - v, u} : Vec2{u, v};
    };
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const Vec3 a = point(i, j), b = point(i + 1, j);
            const Vec3 c = point(i + 1, j + 1), d = point(i, j + 1);
            addTriangle(a, b, c, uv(i, j), uv(i + 1, j), uv(i + 1, j + 1), chart);
            addTriangle(a, c, d, uv(i, j), uv(i + 1, j + 1), uv(i, j + 1), chart);
        }
    }
}

void MeshBuilder::polygon(std::span<const Vec3> points, Vec3 grain) {
    const Vec3 n = normalize(cross(points[1] - points[0], points[2] - points[0]));
    Vec3 v = grain - n * dot(grain, n);
    if (length(v) < 0.1f) v = Vec3{1, 0, 0} - n * n.x;
    if (length(v) < 0.1f) v = Vec3{0, 0, 1} - n * n.z;
    v = normalize(v);
    const Vec3 u = cross(v, n);
    Vec2 low{1e9f, 1e9f}, high{-1e9f, -1e9f};
    for (const Vec3& p : points) {
        low = {std::min(low.x, dot(p, u)), std::min(low.y, dot(p, v))};
        high = {std::max(high.x, dot(p, u)), std::max(high.y, dot(p, v))};
    }
    const int chart = addChart(high.x - low.x, high.y - low.y);
    ++group_;
    auto uv = [&](Vec3 p) { return Vec2{dot(p, u) - low.x, dot(p, v) - low.y}; };
    for (size_t i = 1; i + 1 < points.size(); ++i) {
        addTriangle(frame.point(points[0]), frame.point(points[i]), frame.point(points[i + 1]),
                    uv(points[0]), uv(points[i]), uv(points[i + 1]), chart);
    }
}

void MeshBuilder::quad(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 grain) {
    const Vec3 points[] = {a, b, c, d};
    polygon(points, grain);
}

void MeshBuilder::triangle(Vec3 a, Vec3 b, Vec3 c, Vec3 grain) {
    const Vec3 points[] = {a, b, c};
    polygon(points, grain);
}

void MeshBuilder::box(Vec3 base, Vec3 size, float taper, Vec3 grain, FaceMask faces, float lean) {
    const float a = size.x / 2, b = size.z / 2, topA = a * taper, topB = b * taper;
    const float y0 = base.y, y1 = base.y + size.y, x = base.x, z = base.z;
    const Vec3 p[8] = {{x - a, y0, z - b},
                       {x + a, y0, z - b},
                       {x + a, y0, z + b},
                       {x - a, y0, z + b},
                       {x - topA + lean, y1, z - topB},
                       {x + topA + lean, y1, z - topB},
                       {x + topA + lean, y1, z + topB},
                       {x - topA + lean, y1, z + topB}};
    if (faces & 0b100000) quad(p[2], p[1], p[5], p[6], grain);
    if (faces & 0b010000) quad(p[0], p[3], p[7], p[4], grain);
    if (faces & 0b001000) quad(p[7], p[6], p[5], p[4], grain);
    if (faces & 0b000100) quad(p[0], p[1], p[2], p[3], grain);
    if (faces & 0b000010) quad(p[3], p[2], p[6], p[7], grain);
    if (faces & 0b000001) quad(p[1], p[0], p[4], p[5], grain);
}

void MeshBuilder::beam(Vec3 a, Vec3 b, float width, float depth, float taper, FaceMask faces) {
    const Frame keep = frame;
    frame = frame * along(a, b);
    box({0, 0, 0}, {width, length(b - a), depth}, taper, {0, 1, 0}, faces);
    frame = keep;
}

void MeshBuilder::disc(Vec3 centre, Vec3 axisX, Vec3 axisY, float radius, int sides) {
    const int chart = addChart(2 * radius, 2 * radius);
    ++group_;
    auto ring = [&](int i) {
        const float t = 2 * kPi * float(i) / float(sides);
        return Vec2{radius * std::cos(t), radius * std::sin(t)};
    };
    auto point = [&](int i) { return frame.point(centre + axisX * ring(i).x + axisY * ring(i).y); };
    auto uv = [&](int i) { return ring(i) + Vec2{radius, radius}; };
    for (int i = 1; i + 1 < sides; ++i)
        addTriangle(point(0), point(i), point(i + 1), uv(0), uv(i), uv(i + 1), chart);
}

void MeshBuilder::tube(const std::vector<Vec3>& path, const std::vector<float>& radii, int sides,
                       bool capped, float ragged) {
    float total = 0, widest = 0;
    for (size_t i = 0; i < path.size(); ++i) {
        if (i) total += length(path[i] - path[i - 1]);
        widest = std::max(widest, radii[i]);
    }
    const int last = int(path.size()) - 1;
    const float keep = crease;
    crease = std::min(crease, 0.3f);
    auto ringFrame = [&](int i) {
        const Vec3 d =
            normalize(path[size_t(std::min(i + 1, last))] - path[size_t(std::max(i - 1, 0))]);
        return along(path[size_t(i)], path[size_t(i)] + d);
    };
    const uint32_t tear = seed++;
    grid(sides, last, 2 * kPi * widest, total, [&](float u, float v) {
        const int i = int(std::lround(v * float(last)));
        const int k = int(std::lround(u * float(sides))) % sides;
        const float t = -2 * kPi * float(k) / float(sides), r = radii[size_t(i)];
        const bool end = i == 0 || i == last;
        const float y = ragged > 0 && end ? ragged * (random01(k, i, tear) - 0.5f) : 0;
        return ringFrame(i).point({r * std::cos(t), y, r * std::sin(t)});
    });
    for (int i : {0, last}) {
        if (!capped || radii[size_t(i)] <= 0.02f) continue;
        const Frame f = ringFrame(i);
        disc(f.origin, i ? f.z : f.x, i ? f.x : f.z, radii[size_t(i)], sides);
    }
    crease = keep;
}

void MeshBuilder::lathe(const std::vector<Vec2>& profile, int sides, float ragged, float phase) {
    float total = 0, widest = 0;
    for (size_t i = 0; i < profile.size(); ++i) {
        if (i) total += length(profile[i] - profile[i - 1]);
        widest = std::max(widest, profile[i].x);
    }
    const int last = int(profile.size()) - 1;
    const uint32_t jitter = seed++;
    sideways_ = texture_ == Texture::kStone;
    grid(sides, last, 2 * kPi * widest, total, [&](float u, float v) {
        const int i = int(std::lround(v * float(last)));
        const int k = int(std::lround(u * float(sides))) % sides;
        const float t = -2 * kPi * (float(k) + phase) / float(sides);
        float r = profile[size_t(i)].x, y = profile[size_t(i)].y;
        if (r > 0.01f) {  // a tip stays a single point
            r += 0.5f * ragged * (random01(k, i, jitter + 99) - 0.5f);
            y += ragged * (random01(k, i, jitter) - 0.5f);
        }
        return Vec3{r * std::cos(t), y, r * std::sin(t)};
    });
    sideways_ = false;
}

void MeshBuilder::blob(Vec3 centre, Vec3 radius, int columns, int rows, float roughness) {
    const uint32_t jitter = seed++;
    grid(columns, rows, kPi * (radius.x + radius.z), kPi * radius.y, [&](float u, float v) {
        const int k = int(std::lround(u * float(columns))) % columns;
        const int j = int(std::lround(v * float(rows)));
        const float t = -2 * kPi * (float(k) + 0.5f * float(j & 1)) / float(columns);
        const float f = -kPi / 2 + kPi * float(j) / float(rows);
        const bool pole = j == 0 || j == rows;
        const float swell = 1 + roughness * (2 * random01(pole ? 0 : k, j, jitter) - 1);
        const Vec3 p{radius.x * std::cos(f) * std::cos(t), radius.y * std::sin(f),
                     radius.z * std::cos(f) * std::sin(t)};
        return centre + p * swell;
    });
}

void MeshBuilder::blades(Vec3 base, int count, float height, float width, float spread, Vec3 axis) {
    const Frame f = along(base, base + axis);
    for (int i = 0; i < count; ++i) {
        const float t = 2 * kPi * (float(i) + random()) / float(count);
        const float lean = spread * random(0.5f, 1.0f), rise = height * random(0.7f, 1.15f);
        const Vec3 side = f.direction({-std::sin(t), 0, std::cos(t)}) * (width / 2);
        const Vec3 out = f.direction({std::cos(t), 0, std::sin(t)});
        const Vec3 root = base + out * (0.25f * spread), tip = root + axis * rise + out * lean;
        const int chart = addChart(width, rise);
        ++group_;
        addTriangle(frame.point(root - side), frame.point(root + side), frame.point(tip), {0, 0},
                    {width, 0}, {width / 2, rise}, chart);
    }
}

Model MeshBuilder::finish() {
    packCharts();
    putFineLast();
    makeNormals();
    weld();
    return std::move(model_);
}

// Shelves of decreasing height. Charts keep their orientation: the grain must stay along V.
bool MeshBuilder::placeCharts(std::span<const int> order, float side) {
    const float gutter = side * 2 / float(model_.burnTexels);
    float x = gutter, y = gutter, shelf = 0;
    for (int i : order) {
        Chart& chart = charts_[size_t(i)];
        if (x + chart.width + gutter > side) {
            x = gutter;
            y += shelf + gutter;
            shelf = 0;
        }
        if (x + chart.width + gutter > side || y + chart.height + gutter > side) return false;
        chart.x = x;
        chart.y = y;
        x += chart.width + gutter;
        shelf = std::max(shelf, chart.height);
    }
    return true;
}

void MeshBuilder::packCharts() {
    std::vector<int> order(charts_.size());
    float area = 0;
    for (size_t i = 0; i < order.size(); ++i) {
        order[i] = int(i);
        area += charts_[i].width * charts_[i].height;
    }
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
        return charts_[size_t(a)].height > charts_[size_t(b)].height;
    });
    float side = std::sqrt(area) * 1.05f;
    while (!placeCharts(order, side)) side *= 1.04f;
    model_.atlasSide = side;
    for (Corner& c : corners_) {
        const Chart& chart = charts_[size_t(c.chart)];
        c.vertex.uv = (c.vertex.uv + Vec2{chart.x, chart.y}) * (1 / side);
    }
}

void MeshBuilder::putFineLast() {
    std::vector<Corner> ordered;
    ordered.reserve(corners_.size());
    for (bool wanted : {false, true}) {
        for (const Corner& c : corners_)
            if (c.fine == wanted) ordered.push_back(c);
        if (!wanted) model_.farTriangles = int(ordered.size() / 3);
    }
    corners_ = std::move(ordered);
}

// Smooth within a shape, hard across a crease. Faces weigh by their area.
void MeshBuilder::makeNormals() {
    using Place = std::tuple<int, int, int, int>;
    std::map<Place, std::vector<size_t>> meeting;
    std::vector<Vec3> faces(corners_.size() / 3);
    for (size_t i = 0; i < corners_.size(); ++i) {
        const Vec3 p = corners_[i].vertex.position;
        if (i % 3 == 0)
            faces[i / 3] =
                cross(corners_[i + 1].vertex.position - p, corners_[i + 2].vertex.position - p);
        auto steps = [](float metres) { return int(std::lround(metres * 500)); };
        meeting[{corners_[i].group, steps(p.x), steps(p.y), steps(p.z)}].push_back(i);
    }
    for (const auto& [place, list] : meeting) {
        for (size_t i : list) {
            const Vec3 own = normalize(faces[i / 3]);
            Vec3 sum{};
            for (size_t j : list)
                if (dot(own, normalize(faces[j / 3])) >= corners_[i].crease)
                    sum = sum + faces[j / 3];
            corners_[i].vertex.normal = normalize(sum);
        }
    }
}

void MeshBuilder::weld() {
    using Key = std::tuple<int, int, int, int, int, int, int, int, int>;
    std::map<Key, uint32_t> known;
    auto steps = [](float v) { return int(std::lround(v * 4000)); };
    for (size_t i = 0; i < corners_.size(); ++i) {
        const Vertex& v = corners_[i].vertex;
        const Key key{corners_[i].chart,   steps(v.position.x), steps(v.position.y),
                      steps(v.position.z), steps(v.normal.x),   steps(v.normal.y),
                      steps(v.normal.z),   steps(v.uv.x * 8),   steps(v.uv.y * 8)};
        const auto [found, fresh] = known.try_emplace(key, uint32_t(model_.vertices.size()));
        if (fresh) {
            model_.vertices.push_back(v);
            model_.low = minimum(model_.low, v.position);
            model_.high = maximum(model_.high, v.position);
        }
        model_.indices.push_back(found->second);
        if (i % 3 == 0) model_.materials.push_back(v.material);
    }
}

}  // namespace village
