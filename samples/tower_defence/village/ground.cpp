// The land's functions and its models.
#include "ground.h"

#include <array>
#include <vector>

#include "mesh_builder.h"
#include "palette.h"

namespace village {

namespace {

struct RoadLine {
    std::vector<Vec2> points;
    float length = 0;
};

// A Catmull-Rom curve through the bends. The first and last keys only define the end tangents.
RoadLine makeRoadLine() {
    const std::array<Vec2, 15> keys{{{-38, 7.2f},
                                     {-28, 8.6f},
                                     {-18, 9.6f},
                                     {-10, 10.2f},
                                     {-2.6f, 9.8f},
                                     {4.2f, 7.4f},
                                     {5.0f, 2.2f},
                                     {-0.4f, -1.0f},
                                     {-8.0f, -2.4f},
                                     {-11.6f, -6.6f},
                                     {-8.2f, -11.0f},
                                     {-0.4f, -11.6f},
                                     {6.2f, -10.0f},
                                     {10.4f, -8.9f},
                                     {13.0f, -9.4f}}};
    constexpr int kPieces = 8;
    RoadLine line;
    for (size_t i = 1; i + 1 < keys.size(); ++i) {
        const Vec2 p0 = keys[i - 1], p1 = keys[i], p2 = keys[i + 1];
        const Vec2 p3 = keys[std::min(i + 2, keys.size() - 1)];
        for (int s = 0; s < kPieces; ++s) {
            const float t = float(s) / float(kPieces);
            line.points.push_back(
                p0 * (t * (-0.5f + t * (1 - 0.5f * t))) + p1 * (1 + t * t * (-2.5f + 1.5f * t)) +
                p2 * (t * (0.5f + t * (2 - 1.5f * t))) + p3 * (t * t * (-0.5f + 0.5f * t)));
        }
    }
    line.points.push_back(keys.back());
    for (size_t i = 0; i + 1 < line.points.size(); ++i)
        line.length += village::length(line.points[i + 1] - line.points[i]);
    return line;
}

const RoadLine& roadLine() {
    static const RoadLine line = makeRoadLine();
    return line;
}

struct Yard {
    Vec2 centre;
    float radius;  // m
};
constexpr Yard kYards[] = {{{-4.6f, 5.0f}, 3.0f},  {{-12.2f, 4.4f}, 3.9f}, {{-18.0f, 2.6f}, 2.6f},
                           {{-4.4f, -6.0f}, 2.9f}, {{4.6f, -4.6f}, 3.6f},  {{12.0f, -0.8f}, 2.9f},
                           {{17.0f, -5.4f}, 2.6f}, {{0.0f, -6.6f}, 2.0f},  {kMillPlace, 3.4f},
                           {{-18.0f, -8.6f}, 2.9f}};

struct Field {
    Vec2 centre, halfSize;  // m
    float turn;             // rad
};
constexpr Field kFields[] = {{{-0.5f, -16.4f}, {5.6f, 2.4f}, 0.03f},
                             {{-12.6f, 14.2f}, {4.4f, 1.5f}, -0.03f}};

}  // namespace

float roadLength() { return roadLine().length; }

RoadPlace nearestRoad(Vec2 place) {
    const std::vector<Vec2>& points = roadLine().points;
    RoadPlace best;
    float walked = 0;
    for (size_t i = 0; i + 1 < points.size(); ++i) {
        const Vec2 step = points[i + 1] - points[i], offset = place - points[i];
        const float l = length(step), t = clamp01(dot(offset, step) / (l * l));
        const float distance = length(offset - step * t);
        if (distance < best.distance) best = {distance, walked + t * l, step * (1 / l)};
        walked += l;
    }
    return best;
}

Vec2 roadPoint(float along, Vec2* direction) {
    const std::vector<Vec2>& points = roadLine().points;
    float left = std::max(0.0f, along);
    for (size_t i = 0; i + 1 < points.size(); ++i) {
        const Vec2 step = points[i + 1] - points[i];
        const float l = length(step);
        *direction = step * (1 / l);
        if (left <= l) return points[i] + *direction * left;
        left -= l;
    }
    return points.back();
}

float pondDistance(Vec2 place) {
    const Vec2 d{(place.x - kPondCentre.x) / 4.3f, (place.y - kPondCentre.y) / 2.9f};
    return length(d) + 0.12f * noise(place.x * 0.5f, place.y * 0.5f, 401);
}

float groundHeight(Vec2 p) {
    const float away = std::max(smoothStep(17, 34, std::fabs(p.x)), smoothStep(-13, -30, p.y));
    float h = 0.5f * fbm(p.x * 0.08f, p.y * 0.08f, 3, 402);
    h += 4.5f * away * (0.6f + fbm(p.x * 0.06f, p.y * 0.06f, 2, 405));  // the far hills
    h += 1.5f * (1 - smoothStep(2.8f, 7.0f, length(p - kMillPlace)));   // the mill's mound
    const float road = nearestRoad(p).distance;
    h += 0.22f * fbm(p.x * 0.45f, p.y * 0.45f, 2, 407) * smoothStep(1.5f, 3.5f, road);
    h -= 0.06f * (1 - smoothStep(1.5f, 2.0f, road));
    const float pond = pondDistance(p);
    return mix(h, 0.05f, 1 - smoothStep(1.1f, 1.8f, pond)) -
           0.95f * (1 - smoothStep(0.62f, 1.05f, pond));
}

float fieldAt(Vec2 p) {
    float best = 0;
    for (const Field& f : kFields) {
        const Vec2 d = p - f.centre;
        const float c = std::cos(f.turn), s = std::sin(f.turn);
        const float outX = std::fabs(d.x * c + d.y * s) - f.halfSize.x;
        const float outY = std::fabs(-d.x * s + d.y * c) - f.halfSize.y;
        best = std::max(best, 1 - smoothStep(-0.3f, 0.3f, std::max(outX, outY)));
    }
    return best;
}

bool insideYard(Vec2 p, float share) {
    for (const Yard& yard : kYards)
        if (length(p - yard.centre) <= yard.radius * share) return true;
    return false;
}

Splat groundSplat(Vec2 p, const RoadPlace& road) {
    const float pond = pondDistance(p);
    Splat s;
    s.dirt = 1 - smoothStep(1.5f, 2.6f, road.distance);
    for (const Yard& yard : kYards) {
        const float reach = length(p - yard.centre);
        s.dirt =
            std::max(s.dirt, 0.95f - smoothStep(yard.radius * 0.55f, yard.radius * 1.15f, reach));
    }
    s.field = fieldAt(p);
    const float patches =
        0.75f * smoothStep(0.0f, 0.32f, fbm(p.x * 0.11f + 5, p.y * 0.11f, 2, 411));
    const float outskirts =
        smoothStep(13, 19, std::fabs(p.x)) * (0.52f + 0.9f * fbm(p.x * 0.17f, p.y * 0.17f, 3, 413));
    const float verge = 0.8f * (1 - smoothStep(1.9f, 3.2f, road.distance));
    s.dry = std::max({patches, outskirts, verge}) * smoothStep(1.1f, 1.6f, pond);
    s.mud = 1 - smoothStep(0.85f, 1.18f, pond);
    return s;
}

float roadEdge(Vec2 p, const RoadPlace& road) {
    const float toEnd = length(p - roadLine().points.back());
    const float ragged = road.distance + 0.22f * noise(p.x * 1.8f, p.y * 1.8f, 511) +
                         1.6f * (1 - smoothStep(0.2f, 2.4f, toEnd));
    return ragged / 1.48f;
}

Model makeTerrain() {
    MeshBuilder b("terrain", 1, 1024);
    b.use(Texture::kGrass, Material::kGround, {1, 1, 1});
    b.crease = -1;
    auto spread = [](float t) {  // finer in the centre, where the game takes place
        const float k = 2 * t - 1;
        return 36 * (0.62f * k + 0.38f * k * k * k);
    };
    b.grid(24, 22, 72, 72, [&](float u, float v) {
        const Vec2 p{spread(u), -spread(v) - 4};
        const float dip = 0.5f * (1 - smoothStep(0.9f, 1.2f, pondDistance(p)));
        return Vec3{p.x, groundHeight(p) - dip, p.y};
    });
    return b.finish();
}

Model makeRoad() {
    MeshBuilder b("road", 2, 1024);
    b.use(Texture::kCobble, Material::kStone, {1, 1, 1});
    b.crease = -1;
    const RoadLine& line = roadLine();
    const int last = int(line.points.size()) - 1;
    b.grid(2, last, kRoadWidth, line.length, [&](float u, float v) {
        const int i = int(std::lround(v * float(last)));
        const Vec2 d =
            line.points[size_t(std::min(i + 1, last))] - line.points[size_t(std::max(i - 1, 0))];
        const Vec2 side = Vec2{-d.y, d.x} * (1 / length(d));
        const float across = (u - 0.5f) * kRoadWidth;
        const Vec2 p = line.points[size_t(i)] + side * across;
        const float crown = 0.13f - 0.10f * std::pow(std::fabs(2 * u - 1), 3.0f);
        return Vec3{p.x, groundHeight(p) + crown, p.y};
    });
    return b.finish();
}

Model makePondWater() {
    MeshBuilder b("pond water", 3, 128);
    b.use(Texture::kWater, Material::kWater, {0.018f, 0.045f, 0.042f});
    b.grid(4, 3, 9.6f, 6.8f, [](float u, float v) {
        return Vec3{kPondCentre.x + 9.6f * (u - 0.5f), kWaterLevel,
                    kPondCentre.y - 6.8f * (v - 0.5f)};
    });
    return b.finish();
}

// Returns the point where a ray from the pond's centre reaches a given pond distance.
static Vec2 shorePoint(Vec2 direction, float distance) {
    float low = 0, high = 12;
    for (int k = 0; k < 24; ++k) {
        const float middle = (low + high) / 2;
        (pondDistance(kPondCentre + direction * middle) < distance ? low : high) = middle;
    }
    return kPondCentre + direction * low;
}

// A round bank over the coarse terrain, with lily pads and boulders. A steep bank would lie in the
// low sun's shade and read as a black crescent.
Model makePondShore() {
    MeshBuilder b("pond shore", 5, 256);
    b.use(Texture::kGrass, Material::kGround, {1, 1, 1});
    b.crease = -1;
    b.grid(28, 3, 24, 5, [](float u, float v) {
        constexpr float kDistance[] = {0.84f, 0.99f, 1.20f, 1.70f};
        constexpr float kHeight[] = {-0.34f, -0.15f, 0.03f, 0};
        const int i = int(std::lround(v * 3));
        const float t = -2 * kPi * std::fmod(u, 1.0f);
        const Vec2 p = shorePoint({std::cos(t), std::sin(t)}, kDistance[i]);
        return Vec3{p.x, i == 3 ? groundHeight(p) - 0.06f : kHeight[i], p.y};
    });
    b.use(Texture::kLeaf, Material::kLeaf, {0.07f, 0.16f, 0.04f});
    for (int i = 0; i < 9; ++i) {
        const float t = 2.4f * float(i), reach = 0.55f + 0.045f * float(i);
        const Vec3 c{kPondCentre.x + 3.0f * reach * std::cos(t), kWaterLevel + 0.025f,
                     kPondCentre.y + 2.0f * reach * std::sin(t)};
        b.disc(c, {0, 0, 1}, {1, 0, 0}, b.random(0.2f, 0.38f), 6);
    }
    b.use(Texture::kStone, Material::kStone, palette::kStone * 0.9f);
    for (int i = 0; i < 7; ++i) {
        const float t = 2 * kPi * (float(i) + b.random()) / 7;
        const float wide = b.random(0.25f, 0.5f), deep = b.random(0.25f, 0.45f);
        b.blob({kPondCentre.x + 4.4f * std::cos(t), -0.1f, kPondCentre.y + 3.0f * std::sin(t)},
               {wide, 0.25f, deep}, 5, 3, 0.2f);
    }
    return b.finish();
}

Model makeJetty() {
    MeshBuilder b("jetty", 4, 128);
    constexpr float kDeck = 0.08f;  // m
    b.use(Texture::kPlank, Material::kWood, palette::kOldWood);
    b.box({10.2f, kDeck, 7.6f}, {3.2f, 0.1f, 1.1f}, 1, {0, 0, 1}, kAllFaces);
    b.use(Texture::kTimber, Material::kWood, palette::kOldWood * 0.7f);
    for (float x : {8.9f, 10.2f, 11.5f})
        for (float z : {7.1f, 8.1f}) b.box({x, kDeck - 1.2f, z}, {0.14f, 1.5f, 0.14f});
    return b.finish();
}

}  // namespace village
