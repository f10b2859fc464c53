// Houses: thatched huts, the round hut, the barn and the windmill.
#include <cmath>

#include "kit_parts.h"

namespace village {

// A closed thatched roof: rounded-rectangle rings, lofted from eave to ridge in stepped courses
// with ragged lips.
struct Thatch {
    float length, width;  // m, of the walls below
    float eave, ridge;    // m, heights
    float hip;            // m, inset of the ridge's ends
    int courses;
    int sides;
    Vec3 tint;
    bool cone = false;  // a round roof without a ridge: length equals width
};

struct ThatchRing {
    float slope;   // 0 at the ridge, 1 at the eave
    float lift;    // m, off the roof's plane
    float ragged;  // [0, 1], how torn the ring is
};

static std::vector<ThatchRing> thatchRings(int courses) {
    std::vector<ThatchRing> rings;
    rings.push_back({1.02f, -0.06f, 1});
    for (int c = 0; c < courses; ++c) {
        const float slope = 1 - float(c) / float(courses);
        if (c) rings.push_back({slope + 0.035f, 0.10f, 1});
        rings.push_back({slope, 0.25f, 0.4f});
    }
    rings.push_back({0.0f, 0.16f, 0});
    return rings;
}

static void addThatchShell(MeshBuilder& b, const Thatch& roof) {
    constexpr float kOverhang = 0.36f;  // m; more would hide the walls from above
    const std::vector<ThatchRing> rings = thatchRings(roof.courses);
    const float drop = length(Vec2{roof.ridge - roof.eave, roof.width / 2 + kOverhang});
    const float around = 2 * (roof.length + roof.width) + 4 * kOverhang;
    const int rows = int(rings.size()) - 1;
    const uint32_t jitter = b.seed++;
    b.use(Texture::kThatch, Material::kThatch, roof.tint);
    b.crease = 0.45f;
    b.grid(roof.sides, rows, around, drop * 1.25f, [&](float u, float v) {
        const int j = int(std::lround(v * float(rows)));
        const int k = int(std::lround(u * float(roof.sides))) % roof.sides;
        const ThatchRing& ring = rings[size_t(j)];
        const float angle = -2 * kPi * (float(k) + 0.5f) / float(roof.sides);
        const float t = ring.slope + ring.ragged * 0.055f * (random01(k, j, jitter) - 0.35f);
        const float off = ring.lift + ring.ragged * 0.05f * (random01(k, j, jitter + 7) - 0.5f);
        const float a =
            mix(roof.length / 2 - roof.hip, roof.length / 2 + kOverhang, t) + off * 0.55f;
        const float w = mix(0.05f, roof.width / 2 + kOverhang, t) + off * 0.55f;
        // A superellipse: boxy at the eave above the walls, round towards the ridge.
        const float power = roof.cone ? 1.0f : mix(0.75f, 0.42f, t);
        const float c = std::cos(angle), s = std::sin(angle);
        Vec3 p{a * std::copysign(std::pow(std::fabs(c), power), c), 0,
               w * std::copysign(std::pow(std::fabs(s), power), s)};
        const float sag = roof.cone ? 0 : 0.16f * (1 - (p.x * p.x) / (a * a)) * (1 - t);
        p.y = roof.ridge + (roof.eave - roof.ridge) * std::pow(t, 0.92f) + off * 0.8f - sag;
        return p;
    });
}

static void addThatchRidge(MeshBuilder& b, const Thatch& roof) {
    const float a = roof.length / 2 - roof.hip + 0.22f;
    auto crest = [&](float x) { return roof.ridge + 0.16f - 0.16f * (1 - x * x / (a * a)); };
    std::vector<Vec3> path;
    std::vector<float> radii;
    for (int i = 0; i <= 4; ++i) {
        const float x = -a + a * float(i) / 2;
        path.push_back({x, crest(x), 0});
        radii.push_back(i & 1 ? 0.20f : 0.235f);
    }
    b.use(Texture::kStraw, Material::kThatch, palette::kStraw * 0.55f);
    b.tube(path, radii, 6, true, 0.05f);
    b.fine = true;
    useTimber(b, palette::kOldWood * 0.7f);
    for (int i = 0; i < 3; ++i) {  // crossed spars
        const float x = a * 0.7f * float(i - 1), y = crest(x);
        for (float k : {-1.0f, 1.0f})
            b.beam({x + 0.05f * k, y - 0.34f, 0.52f * k}, {x, y + 0.46f, -0.16f * k}, 0.075f, 0.06f,
                   1, kSidesOnly);
    }
    b.fine = false;
}

static void addThatch(MeshBuilder& b, const Thatch& roof) {
    addThatchShell(b, roof);
    if (roof.cone) {
        const float y = roof.ridge;
        b.use(Texture::kStraw, Material::kStraw, palette::kStraw * 0.7f);
        b.lathe({{0.34f, y - 0.10f}, {0.12f, y + 0.22f}, {0.18f, y + 0.42f}, {0.0f, y + 0.75f}}, 7,
                0.04f);
    } else {
        addThatchRidge(b, roof);
    }
    b.crease = 0.6f;
}

// A window on a wall that faces +z.
static void addWindow(MeshBuilder& b, Vec3 c, Vec3 shutter, bool flowers) {
    b.use(Texture::kGlow, Material::kPaint, {0.10f, 0.075f, 0.045f}, 1);
    b.quad(c + Vec3{-0.27f, -0.32f, 0.02f}, c + Vec3{0.27f, -0.32f, 0.02f},
           c + Vec3{0.27f, 0.32f, 0.02f}, c + Vec3{-0.27f, 0.32f, 0.02f}, {0, 1, 0});
    useTimber(b);
    b.box(c + Vec3{0, 0.32f, 0.03f}, {0.74f, 0.09f, 0.10f}, 1, {1, 0, 0}, kOpenBelowAndBehind);
    b.fine = true;
    b.box(c + Vec3{0, -0.03f, 0.03f}, {0.54f, 0.05f, 0.04f}, 1, {1, 0, 0}, kFrontAndTop);
    b.box(c + Vec3{0, -0.32f, 0.03f}, {0.05f, 0.64f, 0.04f}, 1, {0, 1, 0}, kFrontAndSides);
    b.fine = false;
    b.use(Texture::kPlank, Material::kPaint, shutter);
    for (float k : {-1.0f, 1.0f})
        b.box(c + Vec3{0.46f * k, -0.36f, 0.05f}, {0.34f, 0.72f, 0.06f}, 1, {0, 1, 0},
              kOpenBelowAndBehind);
    if (flowers) {
        b.use(Texture::kPlank, Material::kWood, palette::kWood);
        b.box(c + Vec3{0, -0.52f, 0.12f}, {0.72f, 0.16f, 0.2f}, 1.1f, {1, 0, 0}, kFrontAndSides);
        b.use(Texture::kLeaf, Material::kLeaf, {0.42f, 0.06f, 0.05f});
        b.blob(c + Vec3{0, -0.33f, 0.14f}, {0.38f, 0.13f, 0.13f}, 5, 2, 0.2f);
    } else {
        useTimber(b);
        b.box(c + Vec3{0, -0.42f, 0.03f}, {0.8f, 0.09f, 0.14f}, 1, {1, 0, 0}, kOpenBelowAndBehind);
    }
}

// Height of the stone plinth below the walls.
constexpr float kSill = 0.35f;

// Dark timbers protrude from the limewash. The back faces away from the camera and has only corner
// posts.
static void addHutFrame(MeshBuilder& b, const HutStyle& s) {
    const float y0 = kSill, y1 = kSill + s.wallHeight, a = s.length / 2, w = s.width / 2;
    useTimber(b);
    auto post = [&](float x, float z) {
        b.beam({x, y0, z}, {x, y1, z}, 0.17f, 0.17f, 0.9f, kSidesOnly);
    };
    b.beam({-a - 0.06f, y0 + 0.08f, w}, {a + 0.06f, y0 + 0.08f, w}, 0.13f, 0.16f);
    for (int i = 0; i <= s.bays; ++i) post(-a + s.length * float(i) / float(s.bays), w);
    for (float k : {-1.0f, 1.0f}) {
        post(a * k, -w);
        b.beam({a * k, y0 + 0.1f, w}, {(a - 0.75f) * k, y1 - 0.15f, w}, 0.12f, 0.11f, 1,
               kSidesOnly);
    }
    for (float x : {-a, a}) {
        b.beam({x, y0, 0}, {x, y1, 0}, 0.15f, 0.15f, 1, kSidesOnly);
        b.beam({x, y0 + 0.75f, -w}, {x, y0 + 0.75f, w}, 0.11f, 0.12f, 1, kSidesOnly);
    }
}

static void addHutDoor(MeshBuilder& b, const HutStyle& s, float x, float z) {
    const float y0 = kSill;
    b.use(Texture::kPlank, Material::kPaint, s.trim * 0.8f);
    b.box({x, y0 - 0.05f, z + 0.02f}, {0.82f, 1.5f, 0.08f}, 1, {0, 1, 0}, kOpenBelowAndBehind);
    useTimber(b);
    for (float k : {-1.0f, 1.0f})
        b.box({x + 0.47f * k, y0 - 0.08f, z + 0.03f}, {0.13f, 1.62f, 0.14f}, 1, {0, 1, 0},
              kFrontAndSides);
    b.box({x, y0 + 1.48f, z + 0.04f}, {1.16f, 0.15f, 0.18f}, 1, {1, 0, 0}, kOpenBelowAndBehind);
    b.use(Texture::kMetal, Material::kMetal, palette::kIron);
    b.fine = true;
    for (float y : {0.25f, 1.1f})
        b.box({x - 0.08f, y0 + y, z + 0.07f}, {0.6f, 0.06f, 0.02f}, 1, {1, 0, 0}, kFrontAndTop);
    b.fine = false;
    b.use(Texture::kStone, Material::kStone, palette::kStone * 1.1f);
    b.box({x, -0.3f, z + 0.42f}, {1.2f, 0.45f, 0.6f}, 0.95f, {1, 0, 0}, kOpenBelowAndBehind);
}

Model makeHut(const char* name, const HutStyle& s, uint32_t seed) {
    MeshBuilder b(name, seed, 448);
    const float eave = kSill + s.wallHeight;
    b.use(Texture::kStone, Material::kStone, palette::kStone);
    b.box({0, -0.4f, 0}, {s.length + 0.22f, 0.75f, s.width + 0.22f}, 0.985f, {1, 0, 0});
    b.use(Texture::kPlank, Material::kPaint, s.wall);
    b.box({0, kSill, 0}, {s.length, s.wallHeight, s.width}, 1, {0, 1, 0}, kSidesOnly);
    addHutFrame(b, s);
    for (int i = 0; i < s.bays; ++i) {
        const float x = -s.length / 2 + s.length / float(s.bays) * (float(i) + 0.5f);
        if (i == s.bays / 2)
            addHutDoor(b, s, x, s.width / 2);
        else
            addWindow(b, {x, kSill + 1.02f, s.width / 2}, s.trim, true);
    }
    const float x = -s.length * 0.28f, top = eave + s.rise + 0.45f;
    b.use(Texture::kStone, Material::kStone, palette::kStone * 0.9f);
    b.box({x, eave + 0.2f, -0.55f}, {0.66f, top - eave - 0.2f, 0.62f}, 0.86f, {1, 0, 0},
          kFrontAndSides);
    b.box({x, top - 0.16f, -0.55f}, {0.74f, 0.2f, 0.7f}, 1, {1, 0, 0});
    addThatch(b, {s.length, s.width, eave - 0.18f, eave + s.rise, s.hip, 3, s.length > 5 ? 18 : 14,
                  s.roof});
    return b.finish();
}

Model makeRoundHut(uint32_t seed) {
    MeshBuilder b("round hut", seed, 384);
    b.use(Texture::kStone, Material::kStone, palette::kStone);
    b.lathe({{1.85f, -0.4f}, {1.8f, 0.55f}, {1.6f, 0.6f}}, 12);
    b.use(Texture::kPlank, Material::kPaint, palette::kLime * 0.92f);
    b.lathe({{1.62f, 0.5f}, {1.58f, 1.75f}}, 12);
    useTimber(b);
    for (int i = 0; i < 8; ++i) {
        if (i == 5 || i == 6) continue;  // hidden behind
        const float t = kPi * (float(i) + 0.5f) / 4, c = std::cos(t), s = std::sin(t);
        b.beam({1.62f * c, 0.55f, 1.62f * s}, {1.58f * c, 1.8f, 1.58f * s}, 0.14f, 0.14f, 1,
               kSidesOnly);
    }
    b.use(Texture::kPlank, Material::kPaint, palette::kMustard * 0.8f);
    b.box({0, 0.2f, 1.56f}, {0.85f, 1.4f, 0.16f}, 1, {0, 1, 0}, kOpenBelowAndBehind);
    useTimber(b);
    b.box({0, 1.55f, 1.6f}, {1.15f, 0.14f, 0.22f}, 1, {1, 0, 0});
    for (float k : {-1.0f, 1.0f}) b.box({0.48f * k, 0.1f, 1.58f}, {0.13f, 1.5f, 0.2f});
    b.frame = rotateY(0.8f);
    addWindow(b, {0, 1.22f, 1.55f}, palette::kMustard, false);
    b.frame = Frame{};
    addThatch(b, {3.5f, 3.5f, 1.55f, 4.5f, 1.70f, 4, 12, palette::kGreyThatch, true});
    return b.finish();
}

Model makeBarn(uint32_t seed) {
    MeshBuilder b("barn", seed, 448);
    float L = 6.2f, W = 4.2f, H = 2.5f, R = 2.1f, a = L / 2, w = W / 2;
    b.use(Texture::kStone, Material::kStone, palette::kStone);
    b.box({0, -0.4f, 0}, {L + 0.2f, 0.7f, W + 0.2f}, 0.99f, {1, 0, 0});
    b.use(Texture::kPlank, Material::kPaint, palette::kBarn);
    b.box({0, 0.3f, 0}, {L, H, W}, 1, {0, 1, 0}, kSidesOnly);
    for (int k : {-1, 1}) {
        Vec3 p{a * k, H + 0.3f, w * k}, q{a * k, H + 0.3f, -w * k}, t{a * k, H + 0.3f + R, 0};
        b.triangle(p, q, t, {0, 1, 0});
    }
    b.use(Texture::kPlank, Material::kPaint, palette::kWhite);
    for (int kx : {-1, 1})
        for (int kz : {-1, 1}) b.box({a * kx, 0.3f, w * kz}, {0.2f, H, 0.2f});
    for (int k : {-1, 1})
        for (int z : {-1, 1})
            b.beam({(a + 0.03f) * k, H + 0.2f, (w + 0.05f) * z}, {(a + 0.03f) * k, H + R + 0.2f, 0},
                   0.18f, 0.12f);
    b.box({-0.05f, 0.25f, w + 0.02f}, {2.5f, 2.2f, 0.10f}, 1, {0, 1, 0}, kOpenBelowAndBehind);
    b.use(Texture::kPlank, Material::kPaint, palette::kBarn * 0.72f);
    for (int k : {-1, 1})
        b.box({0.58f * k - 0.05f, 0.3f, w + 0.06f}, {1.06f, 2.0f, 0.10f}, 1, {0, 1, 0},
              kFrontAndTop);
    b.use(Texture::kPlank, Material::kPaint, palette::kWhite);
    for (int k : {-1, 1}) {
        float x = 0.58f * k - 0.05f;
        b.beam({x - 0.46f, 0.45f, w + 0.13f}, {x + 0.46f, 2.15f, w + 0.13f}, 0.11f, 0.05f, 1,
               kSidesOnly);
        b.beam({x + 0.46f, 0.45f, w + 0.13f}, {x - 0.46f, 2.15f, w + 0.13f}, 0.11f, 0.05f, 1,
               kSidesOnly);
    }
    b.frame = rotateY(kPi / 2);
    b.use(Texture::kGlow, Material::kPaint, {0.05f, 0.035f, 0.02f}, 0.6f);
    b.box({0, H + 0.5f, a + 0.02f}, {0.9f, 0.9f, 0.04f}, 1, {0, 1, 0}, kFrontOnly);
    b.use(Texture::kStraw, Material::kStraw, palette::kHay);
    b.blob({0, H + 0.55f, a + 0.1f}, {0.5f, 0.25f, 0.3f}, 7, 3, 0.25f);
    b.frame = Frame{};
    b.use(Texture::kPlank, Material::kWood, palette::kOldWood * 0.8f);
    // A board roof in two stepped courses per slope; its ridge sags slightly.
    for (int s : {-1, 1})
        for (int c : {0, 1}) {
            float t0 = c ? 0 : 0.46f, t1 = c ? 0.56f : 1.17f, y = c ? 0.1f : 0;
            b.grid(6, 1, L + 0.8f, 1.7f, [&](float u, float v) {
                float t = mix(t1, t0, v), x = (s > 0 ? 1 : -1) * (u - 0.5f) * (L + 0.8f);
                return Vec3{x, H + 0.3f + R * (1 - t) + 0.12f + y - 0.07f * std::sin(kPi * u),
                            w * t * s};
            });
            b.grid(6, 1, L + 0.8f, 0.12f, [&](float u, float v) {
                float x = (s > 0 ? 1 : -1) * (u - 0.5f) * (L + 0.8f);
                return Vec3{x, H + 0.3f + R * (1 - t1) + y - 0.07f * std::sin(kPi * u) + 0.12f * v,
                            w * t1 * s};
            });
        }
    b.beam({-a - 0.45f, H + R + 0.5f, 0}, {a + 0.45f, H + R + 0.5f, 0}, 0.3f, 0.14f);
    return b.finish();
}

Model makeWindmill(uint32_t seed) {
    MeshBuilder b("windmill", seed, 512);
    b.use(Texture::kStone, Material::kStone, palette::kStone * 1.05f);
    b.lathe({{2.5f, -0.6f}, {2.35f, 2.0f}, {2.5f, 2.05f}, {2.5f, 2.3f}, {1.9f, 2.3f}}, 8, 0, 0.5f);
    b.use(Texture::kPlank, Material::kPaint, palette::kWhite * 0.92f);
    b.crease = 0.9f;
    b.lathe({{2.0f, 2.2f}, {1.7f, 4.4f}, {1.42f, 6.8f}}, 8, 0, 0.5f);
    b.crease = 0.6f;
    useTimber(b);
    for (int i = 0; i < 8; ++i) {
        if (i == 5 || i == 6) continue;  // hidden behind
        float t = kPi * (i + 0.5f) / 4, c = std::cos(t), s = std::sin(t);
        b.beam({2.02f * c, 2.2f, 2.02f * s}, {1.43f * c, 6.8f, 1.43f * s}, 0.15f, 0.15f, 0.9f,
               kSidesOnly);
    }
    for (float y : {4.4f, 6.55f}) {
        float q = mix(2.03f, 1.46f, (y - 2.2f) / 4.6f);
        b.crease = 0.9f;
        b.lathe({{q, y - 0.08f}, {q, y + 0.1f}}, 8, 0, 0.5f);
        b.crease = 0.6f;
    }
    b.use(Texture::kPlank, Material::kPaint, palette::kBlue);
    b.box({0, -0.1f, 2.28f}, {1.1f, 1.9f, 0.2f}, 0.95f, {0, 1, 0}, kOpenBelowAndBehind);
    useTimber(b);
    b.box({0, 1.8f, 2.26f}, {1.5f, 0.2f, 0.35f}, 1, {1, 0, 0});
    for (int k : {-1, 1}) b.box({0.64f * k, -0.1f, 2.25f}, {0.16f, 1.95f, 0.3f});
    addWindow(b, {0, 3.7f, 1.68f}, palette::kBlue, false);
    addWindow(b, {0, 5.5f, 1.46f}, palette::kBlue, false);
    b.use(Texture::kThatch, Material::kThatch, palette::kThatch);
    b.crease = 0.45f;
    b.lathe({{1.95f, 6.6f},
             {1.98f, 6.85f},
             {1.62f, 7.4f},
             {1.68f, 7.3f},
             {1.66f, 7.55f},
             {1.1f, 8.15f},
             {1.15f, 8.08f},
             {1.05f, 8.35f},
             {0.3f, 8.9f},
             {0.0f, 9.0f}},
            10, 0.06f);
    b.crease = 0.6f;
    b.use(Texture::kMetal, Material::kMetal, palette::kBrass);
    b.lathe({{0.07f, 8.9f}, {0.05f, 9.5f}, {0.14f, 9.6f}, {0.0f, 9.85f}}, 5);
    useTimber(b, palette::kOldWood);
    b.beam({0, 7.3f, 0.6f}, {0, 7.45f, 2.55f}, 0.34f, 0.34f);
    b.use(Texture::kMetal, Material::kMetal, palette::kIron);
    b.blob({0, 7.45f, 2.55f}, {0.28f, 0.28f, 0.22f}, 7, 3, 0);
    Frame hub = translate(0, 7.45f, 2.45f) * rotateZ(0.62f);
    for (int i = 0; i < 4; ++i) {
        b.frame = hub * rotateZ(kPi / 2 * i);
        useTimber(b, palette::kOldWood * 0.8f);
        b.beam({0, 0, 0}, {0, 4.6f, 0}, 0.15f, 0.13f, 0.6f);
        b.fine = true;
        for (int k = 0; k < 5; ++k)
            b.beam({-0.12f, 1.1f + 0.8f * k, 0}, {1.08f, 1.1f + 0.8f * k, -0.02f}, 0.06f, 0.06f, 1,
                   kSidesOnly);
        b.fine = false;
        b.beam({1.05f, 1.05f, 0}, {1.05f, 4.35f, 0}, 0.06f, 0.06f, 1, kSidesOnly);
        b.use(Texture::kCloth, Material::kCloth,
              i & 1 ? palette::kWhite : palette::kCrimson * 1.1f);
        b.grid(1, 4, 1.0f, 3.2f, [&](float u, float v) {
            return Vec3{
                0.08f + 0.95f * u, 1.1f + 3.2f * v,
                0.05f + 0.10f * std::sin(kPi * std::fmod(v * 2.0f + 0.01f, 1.0f)) * (1 - u * 0.5f)};
        });
    }
    return b.finish();
}

}  // namespace village
