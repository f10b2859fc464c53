// Rasterises each chart, paints each texel, then derives slopes from the painted heights.
#include "paint.h"

#include <algorithm>
#include <cmath>

#include "rays.h"

namespace tower {

using village::Material;
using village::Model;
using village::Surface;
using village::Texture;
using village::Vec2;
using village::Vec3;

namespace {

float cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }

uint8_t toByte(float x) { return uint8_t(village::clamp01(x) * 255 + 0.5f); }

// A square root distributes the eight bits nearly as sRGB does, and one multiplication decodes it.
uint8_t toRoot(float x) { return toByte(std::sqrt(village::clamp01(x))); }

// Maps a texel to its triangle. Texels beside a chart belong to it too, so that filtering finds its
// colours there.
class Owners {
 public:
    Owners(uint32_t width, uint32_t height) : width_(int(width)), height_(int(height)) {
        owner_.assign(size_t(width) * height, -1);
    }
    int at(int x, int y) const { return owner_[size_t(y) * size_t(width_) + size_t(x)]; }

    void addTriangle(int id, Vec2 a, Vec2 b, Vec2 c) {
        const float area = cross(b - a, c - a);
        if (std::fabs(area) < 1e-6f) return;
        const int x0 = std::max(0, int(std::floor(std::min({a.x, b.x, c.x}) - 0.5f)));
        const int x1 = std::min(width_ - 1, int(std::ceil(std::max({a.x, b.x, c.x}))));
        const int y0 = std::max(0, int(std::floor(std::min({a.y, b.y, c.y}) - 0.5f)));
        const int y1 = std::min(height_ - 1, int(std::ceil(std::max({a.y, b.y, c.y}))));
        for (int y = y0; y <= y1; ++y) {
            for (int x = x0; x <= x1; ++x) {
                const Vec2 p = Vec2{float(x) + 0.5f, float(y) + 0.5f} - a;
                const float u = cross(p, c - a) / area, v = cross(b - a, p) / area;
                if (u < 0 || v < 0 || u + v > 1) continue;
                owner_[size_t(y) * size_t(width_) + size_t(x)] = id;
            }
        }
    }
    void widen() {
        const std::vector<int> before = owner_;
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x) {
                if (at(x, y) >= 0) continue;
                for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
                    const int nx = x + dx, ny = y + dy;
                    if (nx < 0 || ny < 0 || nx >= width_ || ny >= height_) continue;
                    const int near = before[size_t(ny) * size_t(width_) + size_t(nx)];
                    if (near >= 0) owner_[size_t(y) * size_t(width_) + size_t(x)] = near;
                }
            }
        }
    }

 private:
    int width_, height_;
    std::vector<int> owner_;
};

// Computes slopes from the heights of owned neighbours. A texel without one on each side is level.
void addRelief(Painting& p, const std::vector<float>& heights, const Owners& owners,
               Vec2 texelMetres) {
    const int w = int(p.width), h = int(p.height);
    auto slope = [&](int x, int y, int dx, int dy, float metres) {
        const int x0 = std::clamp(x - dx, 0, w - 1), x1 = std::clamp(x + dx, 0, w - 1);
        const int y0 = std::clamp(y - dy, 0, h - 1), y1 = std::clamp(y + dy, 0, h - 1);
        if (owners.at(x0, y0) < 0 || owners.at(x1, y1) < 0) return 0.0f;
        const float rise = heights[size_t(y1) * size_t(w) + size_t(x1)] -
                           heights[size_t(y0) * size_t(w) + size_t(x0)];
        return rise / (metres * float(x1 - x0 + y1 - y0));
    };
    for (int y = 0; y < h; ++y) {
        for (int x = 0; x < w; ++x) {
            uint8_t* out = &p.relief[(size_t(y) * size_t(w) + size_t(x)) * 4];
            if (owners.at(x, y) < 0) continue;
            out[0] = toByte(0.5f + 0.5f * slope(x, y, 1, 0, texelMetres.x) / kReliefRange);
            out[1] = toByte(0.5f + 0.5f * slope(x, y, 0, 1, texelMetres.y) / kReliefRange);
        }
    }
}

Painting blank(uint32_t width, uint32_t height) {
    Painting p;
    p.width = width;
    p.height = height;
    p.color.assign(size_t(width) * height * 4, 0);
    p.relief.assign(size_t(width) * height * 4, 128);
    return p;
}

void setTexel(Painting& p, size_t texel, const Surface& s, float colorAlpha, float reliefAlpha) {
    uint8_t* color = &p.color[texel * 4];
    color[0] = toRoot(s.albedo.x);
    color[1] = toRoot(s.albedo.y);
    color[2] = toRoot(s.albedo.z);
    color[3] = toByte(colorAlpha);
    uint8_t* relief = &p.relief[texel * 4];
    relief[2] = toByte(s.roughness);
    relief[3] = toByte(reliefAlpha);
}

// Fills the space between charts with the mean colour, because small mips read it.
void fillGaps(Painting& p, const Owners& owners) {
    uint64_t sum[3] = {0, 0, 0}, count = 0;
    auto each = [&](bool owned, auto&& body) {
        for (uint32_t y = 0; y < p.height; ++y)
            for (uint32_t x = 0; x < p.width; ++x)
                if ((owners.at(int(x), int(y)) >= 0) == owned)
                    body(&p.color[(size_t(y) * p.width + x) * 4]);
    };
    each(true, [&](const uint8_t* texel) {
        for (int k = 0; k < 3; ++k) sum[k] += texel[k];
        ++count;
    });
    each(false, [&](uint8_t* texel) {
        for (int k = 0; k < 3; ++k) texel[k] = uint8_t(sum[k] / std::max<uint64_t>(count, 1));
    });
}

uint32_t paintingSide(const Model& model) {
    constexpr float kTexelsPerMetre = 34;  // slightly more than one texel per pixel at the game's
                                           // distance
    const float side = model.atlasSide * kTexelsPerMetre;
    return uint32_t(std::clamp(int(std::ceil(side / 32)) * 32, 64, 640));
}

// Leaves inside and below the crown are darker.
float crownShade(const village::Vertex& v) {
    return v.material == Material::kLeaf && v.texture == Texture::kLeaf
               ? 0.80f + 0.35f * village::clamp01(v.normal.y + 0.2f)
               : 1.0f;
}

// A piece of ground that is a separate model, painted by its world position.
Surface bankSurface(const Model& model, int triangle, Vec2 uv) {
    const uint32_t* i = &model.indices[size_t(triangle) * 3];
    const Vec2 a = model.vertices[i[0]].uv;
    const Vec2 ab = model.vertices[i[1]].uv - a, ac = model.vertices[i[2]].uv - a;
    const float area = cross(ab, ac), u = cross(uv - a, ac) / area, v = cross(ab, uv - a) / area;
    const Vec3 p = model.vertices[i[0]].position * (1 - u - v) + model.vertices[i[1]].position * u +
                   model.vertices[i[2]].position * v;
    const Vec2 place{p.x, p.z};
    return village::paintGround(place, 0.05f,
                                village::groundSplat(place, village::nearestRoad(place)));
}

Painting paintModel(const Model& model) {
    const uint32_t side = paintingSide(model);
    Painting p = blank(side, side);
    Owners owners(side, side);
    const float scale = float(side);
    for (int t = 0; t < model.triangleCount(); ++t) {
        const uint32_t* corner = &model.indices[size_t(t) * 3];
        owners.addTriangle(t, model.vertices[corner[0]].uv * scale,
                           model.vertices[corner[1]].uv * scale,
                           model.vertices[corner[2]].uv * scale);
    }
    owners.widen();
    owners.widen();
    const float texel = model.atlasSide / scale;
    std::vector<float> heights(size_t(side) * side, 0);
    for (uint32_t y = 0; y < side; ++y) {
        for (uint32_t x = 0; x < side; ++x) {
            const int t = owners.at(int(x), int(y));
            if (t < 0) continue;
            const village::Vertex& v = model.vertices[model.indices[size_t(t) * 3]];
            const Vec2 metres{(float(x) + 0.5f) * texel, (float(y) + 0.5f) * texel};
            const Vec3 tint = v.tint * crownShade(v);
            const Surface s = v.texture == Texture::kGrass
                                  ? bankSurface(model, t, metres * (1 / model.atlasSide))
                                  : village::paintSurface(v.texture, metres, texel, tint, 0);
            const size_t i = size_t(y) * side + x;
            heights[i] = s.height;
            setTexel(p, i, s, (s.heat + 0.4f) / 1.7f, s.metalness);
        }
    }
    addRelief(p, heights, owners, {texel, texel});
    fillGaps(p, owners);
    return p;
}

RayTree modelTree(const Model& model) {
    std::vector<Vec3> corners;
    for (uint32_t i : model.indices) corners.push_back(model.vertices[i].position);
    // The ground below the model.
    const float r = 40;
    for (Vec3 p : {Vec3{-r, 0, -r}, Vec3{-r, 0, r}, Vec3{r, 0, r}, Vec3{-r, 0, -r}, Vec3{r, 0, r},
                   Vec3{r, 0, -r}})
        corners.push_back(p);
    return RayTree(std::move(corners));
}

std::vector<float> vertexSky(const Model& model) {
    const RayTree tree = modelTree(model);
    std::vector<Vec3> inwards(model.vertices.size());
    std::vector<float> weights(model.vertices.size(), 0);
    for (size_t i = 0; i < model.indices.size(); i += 3) {
        Vec3 middle{};
        for (size_t k = 0; k < 3; ++k)
            middle = middle + model.vertices[model.indices[i + k]].position * (1 / 3.0f);
        for (size_t k = 0; k < 3; ++k) {
            inwards[model.indices[i + k]] = inwards[model.indices[i + k]] + middle;
            weights[model.indices[i + k]] += 1;
        }
    }
    std::vector<float> open(model.vertices.size(), 1);
    for (size_t i = 0; i < open.size(); ++i) {
        const village::Vertex& v = model.vertices[i];
        const Vec3 middle = inwards[i] * (1 / std::max(1.0f, weights[i]));
        const Vec3 place = v.position + (middle - v.position) * 0.12f;
        open[i] = place.y < -0.05f ? 0.5f : openSky(tree, place, v.normal, 28, 3.2f);
    }
    return open;
}

// ---- ground and road: one chart each, painted by world position ------------------------------

// Returns the static instances as triangles in world space.
RayTree sceneTree(const village::Scene& scene) {
    std::vector<Vec3> corners;
    for (const village::Instance& instance : scene.instances) {
        const Model& model = scene.models[size_t(instance.model)];
        const bool tuft = model.high.y < 0.9f && model.high.x - model.low.x < 1.3f;
        if (instance.roadMetres >= 0 || tuft || instance.model == village::kShoreModel) continue;
        for (uint32_t i : model.indices)
            corners.push_back(instance.frame.point(model.vertices[i].position));
    }
    return RayTree(std::move(corners));
}

// Open sky over the play area, on a coarse grid.
class SkyGrid {
 public:
    explicit SkyGrid(const village::Scene& scene) : open_(size_t(kWide) * kDeep) {
        const RayTree tree = sceneTree(scene);
        inParallel(kDeep, [&](int j) {
            for (int i = 0; i < kWide; ++i) {
                const Vec2 p{kLow.x + kCell * float(i), kLow.y + kCell * float(j)};
                const Vec3 place{p.x, village::groundHeight(p), p.y};
                open_[size_t(j) * kWide + size_t(i)] = openSky(tree, place, {0, 1, 0}, 14, 3.2f);
            }
        });
    }
    float at(Vec2 p) const {
        const float x = std::clamp((p.x - kLow.x) / kCell, 0.0f, float(kWide) - 1.01f);
        const float y = std::clamp((p.y - kLow.y) / kCell, 0.0f, float(kDeep) - 1.01f);
        const int i = int(x), j = int(y);
        auto get = [&](int a, int b) { return open_[size_t(b) * kWide + size_t(a)]; };
        return village::mix(village::mix(get(i, j), get(i + 1, j), x - float(i)),
                            village::mix(get(i, j + 1), get(i + 1, j + 1), x - float(i)),
                            y - float(j));
    }

 private:
    static constexpr float kCell = 0.16f;  // m
    static constexpr Vec2 kLow{-28, -27};
    static constexpr int kWide = 350, kDeep = 288;
    std::vector<float> open_;
};

void chartBounds(const Model& model, Vec2* low, Vec2* high) {
    *low = {1e9f, 1e9f};
    *high = {-1e9f, -1e9f};
    for (const village::Vertex& v : model.vertices) {
        *low = {std::min(low->x, v.uv.x), std::min(low->y, v.uv.y)};
        *high = {std::max(high->x, v.uv.x), std::max(high->y, v.uv.y)};
    }
}

struct PlacedChart {
    Painting painting;
    Owners owners;
    std::vector<Vec3> corners;  // three corners per triangle, in image texels (x, y)
    Vec2 low, high;
};

PlacedChart placeChart(const Model& model, uint32_t width, uint32_t height) {
    PlacedChart chart{blank(width, height), Owners(width, height), {}, {}, {}};
    chartBounds(model, &chart.low, &chart.high);
    for (uint32_t i : model.indices) {
        const Vec2 uv = model.vertices[i].uv - chart.low;
        chart.corners.push_back({uv.x / (chart.high.x - chart.low.x) * float(width),
                                 uv.y / (chart.high.y - chart.low.y) * float(height), 0});
    }
    for (int t = 0; t < model.triangleCount(); ++t) {
        const Vec3* c = &chart.corners[size_t(t) * 3];
        chart.owners.addTriangle(t, {c[0].x, c[0].y}, {c[1].x, c[1].y}, {c[2].x, c[2].y});
    }
    chart.owners.widen();
    return chart;
}

// Returns the world position of a texel of triangle t.
Vec2 texelPlace(const Model& model, const PlacedChart& chart, int t, int x, int y) {
    const Vec3* c = &chart.corners[size_t(t) * 3];
    const Vec2 a{c[0].x, c[0].y}, ab = Vec2{c[1].x, c[1].y} - a, ac = Vec2{c[2].x, c[2].y} - a;
    const Vec2 p = Vec2{float(x) + 0.5f, float(y) + 0.5f} - a;
    const float area = cross(ab, ac), u = cross(p, ac) / area, v = cross(ab, p) / area;
    const uint32_t* i = &model.indices[size_t(t) * 3];
    const Vec3 place = model.vertices[i[0]].position * (1 - u - v) +
                       model.vertices[i[1]].position * u + model.vertices[i[2]].position * v;
    return {place.x, place.z};
}

Painting paintGroundChart(const Model& terrain, const SkyGrid& sky, Vec2* low, Vec2* high) {
    constexpr uint32_t kSide = 1536;
    PlacedChart chart = placeChart(terrain, kSide, kSide);
    *low = chart.low;
    *high = chart.high;
    Painting& p = chart.painting;
    std::vector<float> heights(size_t(kSide) * kSide, 0);
    inParallel(int(kSide), [&](int y) {
        village::RoadPlace road;
        village::Splat splat;
        for (int x = 0; x < int(kSide); ++x) {
            const int t = chart.owners.at(x, y);
            if (t < 0) continue;
            const Vec2 place = texelPlace(terrain, chart, t, x, y);
            // The masks are smooth, so every fourth texel suffices.
            if (x % 4 == 0) {
                road = village::nearestRoad(place);
                splat = village::groundSplat(place, road);
            }
            const Surface s = village::paintGround(place, 0.035f, splat);
            const size_t i = size_t(y) * kSide + size_t(x);
            heights[i] = s.height;
            setTexel(p, i, s, sky.at(place), heights[i] / kGroundRelief);
        }
    });
    addRelief(p, heights, chart.owners, {0.035f, 0.035f});
    return std::move(chart.painting);
}

Painting paintRoadChart(const Model& model, const SkyGrid& sky, Vec2* low, Vec2* high) {
    constexpr uint32_t kWide = 160, kLong = 4096;
    PlacedChart chart = placeChart(model, kWide, kLong);
    *low = chart.low;
    *high = chart.high;
    Painting& p = chart.painting;
    const Vec2 texel{village::kRoadWidth / float(kWide), village::roadLength() / float(kLong)};
    std::vector<float> heights(size_t(kWide) * kLong, 0);
    inParallel(int(kLong), [&](int y) {
        for (int x = 0; x < int(kWide); ++x) {
            const int t = chart.owners.at(x, y);
            if (t < 0) continue;
            const Vec2 place = texelPlace(model, chart, t, x, y);
            const village::RoadPlace road = village::nearestRoad(place);
            const float edge = village::roadEdge(place, road);
            const Vec2 metres{(float(x) + 0.5f) * texel.x, (float(y) + 0.5f) * texel.y};
            Surface s = village::paintSurface(Texture::kCobble, metres, texel.x, {1, 1, 1}, 0);
            // Grooves see less sky, and the verge is worn and dusty.
            const float groove = village::mix(0.62f, 1, s.height / 0.045f);
            const float dust = village::smoothStep(0.78f, 1.0f, edge);
            s.albedo = village::mix(s.albedo, Vec3{0.150f, 0.115f, 0.075f}, 0.55f * dust);
            const size_t i = size_t(y) * kWide + size_t(x);
            heights[i] = s.height * (1 - 0.5f * dust);
            setTexel(p, i, s, sky.at(place) * groove,
                     edge < 1 ? 0.25f + 0.75f * heights[i] / kRoadRelief : 0.0f);
        }
    });
    addRelief(p, heights, chart.owners, texel);
    return std::move(chart.painting);
}

}  // namespace

PaintedVillage paintVillage(const village::Scene& scene) {
    PaintedVillage painted;
    painted.models.resize(scene.models.size());
    inParallel(int(scene.models.size()), [&](int i) {
        const Model& model = scene.models[size_t(i)];
        painted.models[size_t(i)] = {paintModel(model), vertexSky(model)};
    });
    const SkyGrid sky(scene);
    painted.ground = paintGroundChart(scene.terrain, sky, &painted.groundLow, &painted.groundHigh);
    painted.road = paintRoadChart(scene.road, sky, &painted.roadLow, &painted.roadHigh);
    return painted;
}

}  // namespace tower
