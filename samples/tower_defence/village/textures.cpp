// The painters behind textures.h, one function per surface.
#include "textures.h"

namespace village {

// Boards 0.20 m wide: seams, grain, a tone per board and rain streaks.
static Surface planks(float x, float y, float footprint, Vec3 tint, uint32_t seed) {
    const float k = x / 0.20f;
    const int board = int(std::floor(k));
    const float f = k - float(board), edge = std::min(f, 1 - f) * 0.20f;
    const float seam = smoothStep(0.004f, 0.022f + 0.3f * footprint, edge);
    const float tone = random01(board, int(seed), 5);
    const float grain = fbm(x * 22, y * 1.6f + 31 * tone, 3, 6, footprint * 22);
    const float wear = fbm(x * 1.7f, y * 0.9f, 3, 8, footprint * 2);
    Surface s;
    s.albedo = tint * ((0.80f + 0.36f * tone) * (1 + 0.30f * grain) * mix(0.55f, 1, seam) *
                       (1 + 0.35f * wear));
    s.height = 0.012f * seam + 0.003f * grain;
    s.roughness = 0.8f;
    return s;
}

// A hewn beam: long grain and adze facets.
static Surface timber(float x, float y, float footprint, Vec3 tint) {
    const float grain = fbm(x * 16, y * 1.1f, 3, 12, footprint * 16);
    const float facet = noise(x * 5, y * 3.1f, 13);
    Surface s;
    s.albedo = tint * (1 + 0.55f * grain + 0.16f * facet);
    s.height = 0.006f * grain + 0.008f * facet;
    return s;
}

// Stretched ridges broken by cracks.
static Surface bark(float x, float y, float footprint, Vec3 tint) {
    const float warped = x * 9 + 0.8f * noise(x * 3, y * 1.4f, 21);
    const float ridge = std::fabs(noise(warped, y * 1.5f, 22));
    Surface s;
    s.albedo = tint * (0.55f + ridge + 0.25f * fbm(x * 6, y * 4, 2, 23, footprint * 6));
    s.height = 0.03f * ridge;
    s.roughness = 0.95f;
    return s;
}

// Bundles of 0.16 m in ragged courses of 0.36 m, weathered and mossy in broad patches.
static Surface thatch(float x, float y, float footprint, Vec3 tint, uint32_t seed) {
    const float rag = 0.10f * noise(x * 5.5f, y * 0.7f, 31) + 0.05f * noise(x * 14, y, 32);
    const float k = (y + rag) / 0.36f;
    const int row = int(std::floor(k));
    const float f = k - float(row);
    const float bundle = noise(x * 6.2f + float(row) * 7.3f, y * 0.8f, 33);
    const float streak = fbm(x * 15, y * 1.2f, 3, 34, footprint * 15) +
                         0.7f * fbm(x * 62 + 2 * bundle, y * 2.2f, 2, 39, footprint * 62);
    const float age = fbm(x * 0.55f, y * 0.55f, 3, 36 + seed % 7);
    const float lip = smoothStep(0.0f, 0.22f, f);  // the shadow of the course above
    const float moss = 0.55f * smoothStep(0.18f, 0.42f, fbm(x * 0.9f + 40, y * 0.9f, 3, 37));
    Vec3 base = mix(tint * 1.16f, tint * Vec3{0.62f, 0.60f, 0.58f}, smoothStep(-0.25f, 0.35f, age));
    base = mix(base, Vec3{0.115f, 0.125f, 0.040f}, moss);
    Surface s;
    s.albedo = base * ((0.62f + 0.38f * lip) * (1 + 0.26f * bundle) * (1 + 0.60f * streak));
    s.height = 0.035f * (1 - f) + 0.02f * bundle + 0.015f * streak;
    s.roughness = 0.95f;
    return s;
}

// Bright stalks with dark gaps. The gaps show only at close range.
static Surface straw(float x, float y, float footprint, Vec3 tint) {
    const float warped = x * 13 + 0.6f * noise(x * 2, y * 2, 41);
    const float stalks = fbm(warped, y * 1.3f, 3, 42, footprint * 13) +
                         0.8f * fbm(x * 58, y * 2.4f, 2, 45, footprint * 58);
    const float gap = smoothStep(0.12f, 0.40f, noise(x * 26, y * 2.1f, 43)) *
                      (1 - smoothStep(0.05f, 0.12f, footprint));
    const Vec3 dark = tint * Vec3{0.62f, 0.50f, 0.38f};
    Surface s;
    s.albedo = mix(dark, tint * 1.18f, clamp01(0.55f + 1.15f * stalks)) *
               ((1 - 0.5f * gap) * (1 + 0.18f * noise(x * 3, y * 2, 44)));
    s.height = 0.02f * stalks - 0.012f * gap;
    s.roughness = 0.9f;
    return s;
}

// Dabs in jittered cells. Each is a small lit dome with its own hue.
static Surface leaf(float x, float y, Vec3 tint) {
    constexpr float kCells = 4.2f;  // per metre
    const int i0 = int(std::floor(x * kCells)), j0 = int(std::floor(y * kCells));
    float best = 9, id = 0;
    for (int j = j0 - 1; j <= j0 + 1; ++j) {
        for (int i = i0 - 1; i <= i0 + 1; ++i) {
            const Vec2 d{x * kCells - float(i) - random01(i, j, 51),
                         y * kCells - float(j) - random01(i, j, 52)};
            const float l = dot(d, d) - 0.3f * random01(i, j, 53);
            if (l < best) {
                best = l;
                id = random01(i, j, 54);
            }
        }
    }
    const float dome = 1 - clamp01(best * 1.3f);
    const Vec3 warm = Vec3{0.030f, 0.022f, 0} * (id > 0.72f ? 1.0f : 0.0f);
    Surface s;
    s.albedo = tint * ((0.50f + 0.62f * dome) * (0.72f + 0.60f * id)) + warm;
    s.height = 0.11f * dome;
    s.roughness = 0.75f;
    return s;
}

// Broad folds and faded patches.
static Surface cloth(float x, float y, Vec3 tint) {
    const float fade = fbm(x * 2.1f, y * 2.1f, 3, 61), fold = noise(x * 4, y * 0.6f, 62);
    Surface s;
    s.albedo = mix(tint * (1 + 0.18f * fold), tint * 0.75f + Vec3{0.06f, 0.05f, 0.04f},
                   0.5f * smoothStep(0, 0.5f, fade));
    s.height = 0.012f * fold;
    s.roughness = 0.9f;
    return s;
}

// Coursed rubble: rows of 0.30 m, stones of 0.38 to 0.58 m, two centimetres of mortar.
static Surface stone(float x, float y, float footprint, Vec3 tint) {
    constexpr float kRow = 0.30f;  // m
    const float wobble = 0.035f * noise(x * 2.2f, y * 2.2f, 81), k = (x + wobble) / kRow;
    const int row = int(std::floor(k));
    const float fy = (k - float(row)) * kRow;
    const float width = mix(0.38f, 0.58f, random01(row, 0, 82));
    const float l = (y + 0.3f * random01(row, 1, 83) + wobble) / width;
    const int column = int(std::floor(l));
    const float fx = (l - float(column)) * width;
    const float edge = std::min({fy, kRow - fy, fx, width - fx});
    const float face = smoothStep(0.008f, 0.045f + 0.3f * footprint, edge);
    const float id = random01(row, column, 84), grit = fbm(x * 7, y * 7, 3, 85, footprint * 7);
    const Vec3 hue = mix(tint * Vec3{1.08f, 1.0f, 0.9f}, tint * Vec3{0.88f, 0.95f, 1.04f},
                         random01(row, column, 86));
    Surface s;
    s.albedo = mix(Vec3{0.20f, 0.18f, 0.15f}, hue * (0.74f + 0.5f * id + 0.35f * grit), face);
    s.height = 0.03f * face + 0.012f * grit;
    s.roughness = 0.9f;
    return s;
}

static Surface metal(float x, float y, float footprint, Vec3 tint) {
    const float grime = fbm(x * 3, y * 3, 3, 91, footprint * 3);
    Surface s;
    s.albedo = mix(tint * (1 + 0.5f * grime), Vec3{0.14f, 0.06f, 0.025f},
                   0.5f * smoothStep(0.1f, 0.4f, grime));
    s.roughness = 0.38f + 0.3f * clamp01(grime + 0.3f);
    s.metalness = 1;
    return s;
}

// Dark lumps between hot seams. A lit window uses only the tint.
static Surface coals(float x, float y, Vec3 tint) {
    const float v =
        std::fabs(noise(x * 9, y * 9, 95)) + 0.5f * std::fabs(noise(x * 19, y * 19, 96));
    Surface s;
    s.albedo = tint;
    s.height = 0.05f * v;
    s.roughness = 0.9f;
    s.heat = 1.25f - 1.6f * smoothStep(0.1f, 0.7f, v);
    return s;
}

struct Cobble {
    float height;  // [0, 1]
    float id;      // [0, 1], one per sett
};

// Brick rows of jittered round-topped setts, 0.30 x 0.25 m; x across the road, y along it.
static Cobble cobble(Vec2 q) {
    constexpr float kWidth = 0.30f, kLength = 0.25f;  // m
    q = q + Vec2{0.05f * noise(q.x * 1.1f, q.y * 1.1f, 3),
                 0.05f * noise(q.x * 1.3f + 9, q.y * 1.3f, 4)};
    float nearest = 9, second = 9, id = 0;
    const int j0 = int(std::floor(q.y / kLength));
    for (int j = j0 - 1; j <= j0 + 1; ++j) {
        const float shift = (j & 1) ? 0.5f : 0.0f;
        const int i0 = int(std::floor(q.x / kWidth - shift));
        for (int i = i0 - 1; i <= i0 + 1; ++i) {
            const Vec2 centre{
                (float(i) + shift + 0.5f + 0.28f * (random01(i, j, 71) - 0.5f)) * kWidth,
                (float(j) + 0.5f + 0.28f * (random01(i, j, 72) - 0.5f)) * kLength};
            const Vec2 e{(q.x - centre.x) / kWidth, (q.y - centre.y) / kLength};
            // Between a circle and a square: worn corners.
            const float xx = e.x * e.x, yy = e.y * e.y;
            const float d = std::sqrt(std::sqrt(xx * xx + yy * yy)) * 0.6f + 0.4f * length(e);
            if (d < nearest) {
                second = nearest;
                nearest = d;
                id = random01(i, j, 73);
            } else {
                second = std::min(second, d);
            }
        }
    }
    const float edge = smoothStep(0.02f, 0.30f, second - nearest);
    return {edge * (0.72f + 0.28f * id) * (1 - 0.35f * nearest * nearest), id};
}

static Surface cobbles(float x, float y, float footprint) {
    const Cobble c = cobble({x, y});
    const Vec3 warm{0.225f, 0.212f, 0.196f}, cool{0.182f, 0.185f, 0.196f};
    const Vec3 sett = mix(warm, cool, random01(int(c.id * 9999), 0, 101)) * (0.82f + 0.36f * c.id) *
                      (1 + 0.3f * fbm(x * 9, y * 9, 2, 102, footprint * 9));
    const float polish = smoothStep(0.35f, 0.8f, c.height);
    const Vec3 joint{0.098f, 0.078f, 0.056f};
    Surface s;
    s.albedo = mix(joint, sett * (0.9f + 0.2f * polish), smoothStep(0.12f, 0.42f, c.height));
    s.height = 0.045f * c.height;
    s.roughness = mix(0.95f, 0.62f, polish);
    return s;
}

static Surface water(float x, float y, Vec3 tint) {
    Surface s;
    s.albedo = tint;
    s.height = 0.018f * noise(x * 1.6f, y * 3.1f, 111) + 0.008f * noise(x * 5, y * 7, 112);
    s.roughness = 0.08f;
    return s;
}

Surface paintSurface(Texture texture, Vec2 metres, float footprint, Vec3 tint, uint32_t seed) {
    const float x = metres.x, y = metres.y;
    switch (texture) {
        case Texture::kPlank:
            return planks(x, y, footprint, tint, seed);
        case Texture::kTimber:
            return timber(x, y, footprint, tint);
        case Texture::kBark:
            return bark(x, y, footprint, tint);
        case Texture::kThatch:
            return thatch(x, y, footprint, tint, seed);
        case Texture::kStraw:
            return straw(x, y, footprint, tint);
        case Texture::kLeaf:
            return leaf(x, y, tint);
        case Texture::kCloth:
            return cloth(x, y, tint);
        case Texture::kStone:
            return stone(x, y, footprint, tint);
        case Texture::kMetal:
            return metal(x, y, footprint, tint);
        case Texture::kGlow:
            return coals(x, y, tint);
        case Texture::kCobble:
            return cobbles(x, y, footprint);
        case Texture::kGrass:
            return paintGround(metres, footprint, {});
        case Texture::kWater:
            return water(x, y, tint);
    }
    return {tint};
}

static bool flowerDot(Vec2 q, Vec3* tint) {
    constexpr float kCells = 2.2f;  // per metre
    const int i = int(std::floor(q.x * kCells)), j = int(std::floor(q.y * kCells));
    const Vec2 d{q.x * kCells - float(i) - 0.2f - 0.6f * random01(i, j, 241),
                 q.y * kCells - float(j) - 0.2f - 0.6f * random01(i, j, 242)};
    if (random01(i, j, 243) <= 0.86f || length(d) >= 0.15f) return false;
    *tint = random01(i, j, 244) > 0.5f ? Vec3{0.62f, 0.58f, 0.48f} : Vec3{0.60f, 0.40f, 0.035f};
    return true;
}

Surface paintGround(Vec2 q, float footprint, const Splat& k) {
    const float broad = fbm(q.x * 0.16f, q.y * 0.16f, 3, 201);
    const float mid = fbm(q.x * 1.1f, q.y * 1.1f, 3, 204, footprint * 1.1f);
    const float fine = fbm(q.x * 7, q.y * 4.5f, 3, 207, footprint * 7);
    const float tuft = smoothStep(0.05f, 0.5f, noise(q.x * 2.3f + mid, q.y * 2.3f, 210));
    const Vec3 lush = mix(Vec3{0.082f, 0.150f, 0.030f}, Vec3{0.150f, 0.195f, 0.040f},
                          smoothStep(-0.3f, 0.35f, broad + 0.45f * mid)) *
                      (1 + 0.55f * fine) * (1 - 0.20f * tuft);
    const Vec3 dry = mix(Vec3{0.34f, 0.245f, 0.080f}, Vec3{0.245f, 0.205f, 0.066f},
                         smoothStep(-0.2f, 0.3f, mid)) *
                     (1 + 0.6f * fine) * (1 - 0.15f * tuft);
    Vec3 dirt =
        mix(Vec3{0.20f, 0.130f, 0.075f}, Vec3{0.27f, 0.19f, 0.115f}, smoothStep(-0.3f, 0.3f, mid)) *
        (1 + 0.35f * fine);
    const float pebble = smoothStep(0.62f, 0.78f, noise(q.x * 6.5f, q.y * 6.5f, 220));
    dirt = mix(dirt, Vec3{0.30f, 0.28f, 0.25f},
               0.7f * pebble * (1 - smoothStep(0.06f, 0.14f, footprint)));
    const float furrow = q.y * 1.25f + 100 + 0.15f * noise(q.x * 0.7f, q.y, 230);
    const float row = std::fabs(std::fmod(furrow, 1.0f) - 0.5f) * 2;
    const Vec3 field = mix(Vec3{0.155f, 0.095f, 0.05f}, Vec3{0.46f, 0.32f, 0.09f},
                           smoothStep(0.25f, 0.8f, row + 0.4f * fine + 0.25f * mid));
    // The same noise breaks the edges between ground types, which avoids an airbrushed look.
    const float ragged = 0.5f * mid + 0.35f * fine;
    const float isDry = smoothStep(0.35f, 0.65f, k.dry + 0.5f * ragged + 0.35f * broad);
    const float isDirt = smoothStep(0.40f, 0.60f, k.dirt + 0.45f * ragged);
    const float isField = smoothStep(0.42f, 0.58f, k.field + 0.25f * ragged);
    const float isMud = smoothStep(0.4f, 0.7f, k.mud + 0.3f * ragged);
    Surface s;
    s.albedo = mix(mix(mix(lush, dry, isDry), field, isField), dirt, isDirt);
    s.albedo = mix(s.albedo, Vec3{0.125f, 0.098f, 0.062f}, isMud);
    s.height = mix(0.05f * fine + 0.06f * mid, 0.015f * fine, isDirt) + 0.08f * row * isField;
    s.roughness = 0.95f;
    Vec3 flower;
    const bool meadow = isDry < 0.3f && isDirt < 0.1f && isField < 0.1f && broad > -0.05f;
    if (meadow && k.mud < 0.1f && flowerDot(q, &flower)) s.albedo = flower;
    return s;
}

}  // namespace village
