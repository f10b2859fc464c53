// Towers: one stone plinth, one accent colour and one unmistakable silhouette each.
#include "kit_parts.h"

namespace village {

static void addPlinth(MeshBuilder& b, Vec3 accent) {
    b.use(Texture::kStone, Material::kStone, palette::kStone * 1.15f);
    b.lathe(
        {{1.75f, -0.5f}, {1.7f, 0.35f}, {1.5f, 0.4f}, {1.45f, 0.95f}, {1.55f, 1.18f}, {0, 1.18f}},
        8, 0, 0.5f);
    for (int i = 0; i < 4; ++i) {
        b.frame = rotateY(kPi / 2 * i + kPi / 4);
        b.use(Texture::kCloth, Material::kCloth, accent);
        b.sway = {1.15f, 0.04f};
        b.grid(2, 2, 0.7f, 0.95f, [&](float u, float v) {
            float w = v < 0.2f ? 0.65f : 1;
            return Vec3{0.7f * (u - 0.5f) * w,
                        1.15f - (v < 0.01f && std::fabs(u - 0.5f) < 0.1f ? 1.02f : 0.85f) * (1 - v),
                        1.56f + 0.22f * (1 - v)};
        });
        b.sway = {};
        b.use(Texture::kMetal, Material::kMetal, palette::kBrass);
        b.fine = true;
        b.box({0, 1.1f, 1.5f}, {0.8f, 0.09f, 0.12f}, 1, {0, 1, 0}, kOpenBelowAndBehind);
        b.fine = false;
    }
    b.frame = Frame{};
}

Model makeFlamePlinth(uint32_t seed) {
    MeshBuilder b("flame plinth", seed, 512);
    addPlinth(b, palette::kVermilion);
    return b.finish();
}

// The turret only; it rotates on its plinth.
Model makeFlamethrower(uint32_t seed) {
    MeshBuilder b("flamethrower", seed, 512);
    b.use(Texture::kMetal, Material::kMetal, palette::kIron);
    b.lathe({{0.8f, 1.15f}, {0.7f, 1.4f}, {0.55f, 1.6f}}, 8);
    b.use(Texture::kMetal, Material::kMetal, palette::kCopper);
    b.blob({0, 2.2f, -0.1f}, {0.82f, 0.8f, 0.82f}, 10, 5, 0);
    b.use(Texture::kMetal, Material::kMetal, palette::kIron);
    b.lathe({{0.86f, 2.12f}, {0.86f, 2.3f}}, 10);
    b.use(Texture::kGlow, Material::kMetal, {0.3f, 0.05f, 0.01f}, 5);
    for (int i : {-1, 0, 1})
        b.box({0.28f * i, 1.8f, 0.62f}, {0.16f, 0.22f, 0.12f}, 1, {0, 1, 0}, kFrontOnly);
    b.use(Texture::kMetal, Material::kMetal, palette::kIron);
    b.tube({{-0.35f, 2.7f, -0.5f}, {-0.35f, 3.5f, -0.5f}, {-0.35f, 3.9f, -0.5f}},
           {0.2f, 0.17f, 0.17f}, 7, false);
    b.use(Texture::kMetal, Material::kMetal, palette::kBrass);
    b.frame = translate(-0.35f, 3.85f, -0.5f);
    b.lathe({{0.17f, 0}, {0.34f, 0.12f}, {0.1f, 0.42f}}, 7);
    b.frame = Frame{};
    b.tube(
        {{0, 2.45f, 0.4f}, {0, 2.7f, 1.1f}, {0, 2.72f, 1.9f}, {0, 2.72f, 2.15f}, {0, 2.72f, 2.5f}},
        {0.24f, 0.2f, 0.16f, 0.2f, 0.36f}, 8, false);
    b.use(Texture::kGlow, Material::kMetal, {0.2f, 0.04f, 0.01f}, 6);
    b.disc({0, 2.72f, 2.4f}, {1, 0, 0}, {0, 1, 0}, 0.27f, 8);
    b.use(Texture::kMetal, Material::kMetal, palette::kIron);
    for (float z : {1.2f, 1.75f}) {
        b.frame = translate(0, 2.71f, z) * rotateX(kPi / 2);
        b.lathe({{0.25f, -0.06f}, {0.25f, 0.06f}}, 8);
    }
    b.frame = Frame{};
    b.use(Texture::kPlank, Material::kPaint, palette::kVermilion);
    for (int k : {-1, 1})
        b.box({0.72f * k, 1.18f, 0.75f}, {0.12f, 0.95f, 0.9f}, 0.8f);  // firebox cheeks
    return b.finish();
}

Model makeEmberMortar(uint32_t seed) {
    MeshBuilder b("ember mortar", seed, 512);
    addPlinth(b, palette::kOchre);
    b.use(Texture::kBark, Material::kWood, palette::kWood * 0.7f);
    for (int i = 0; i < 9; ++i) {
        float t = 2 * kPi * (i + 0.5f) / 9;
        if (std::fabs(std::sin(t) - 1) < 0.15f) continue;
        Vec3 p{1.22f * std::cos(t), 1.1f, 1.22f * std::sin(t)};
        float h = b.random(0.7f, 0.9f);
        b.tube({p, p + Vec3{0, h, 0}, p + Vec3{0, h + 0.28f, 0}}, {0.2f, 0.19f, 0.02f}, 4, false);
    }
    b.frame = translate(0, 1.35f, -0.1f) * rotateX(0.55f);
    b.use(Texture::kMetal, Material::kMetal, palette::kIron * 1.3f);
    b.lathe({{0.62f, 0.05f},
             {0.72f, 0.5f},
             {0.6f, 1.1f},
             {0.58f, 1.75f},
             {0.72f, 1.85f},
             {0.72f, 2.1f},
             {0.5f, 2.1f},
             {0.45f, 1.5f}},
            10);
    b.use(Texture::kMetal, Material::kMetal, palette::kBrass);
    for (float y : {0.6f, 1.25f}) b.lathe({{0.69f, y - 0.08f}, {0.68f, y + 0.08f}}, 10);
    b.use(Texture::kGlow, Material::kMetal, {0.4f, 0.07f, 0.01f}, 6);
    b.lathe({{0.5f, 1.75f}, {0, 1.8f}}, 8);
    b.frame = Frame{};
    b.use(Texture::kPlank, Material::kPaint, palette::kOchre);
    for (int k : {-1, 1}) b.box({0.72f * k, 1.15f, -0.1f}, {0.16f, 1.0f, 1.2f}, 0.6f);
    b.use(Texture::kMetal, Material::kMetal, palette::kIron);
    b.frame = translate(1.0f, 1.15f, 0.9f);
    b.lathe({{0.2f, 0}, {0.34f, 0.4f}, {0.28f, 0.42f}}, 7);
    b.use(Texture::kGlow, Material::kWood, {0.35f, 0.06f, 0.01f}, 5);
    b.blob({0, 0.42f, 0}, {0.27f, 0.15f, 0.27f}, 6, 3, 0.3f);
    return b.finish();
}

Model makeWaterCannon(uint32_t seed) {
    MeshBuilder b("water cannon", seed, 512);
    addPlinth(b, palette::kSky);
    useTimber(b, palette::kWood * 0.8f);
    for (int x : {-1, 1})
        for (int z : {-1, 1})
            b.beam({0.95f * x, 1.1f, 0.95f * z}, {0.7f * x, 3.0f, 0.7f * z}, 0.2f, 0.2f);
    for (int k : {-1, 1}) {
        b.beam({-0.93f, 1.3f, 0.93f * k}, {0.75f, 2.8f, 0.75f * k}, 0.1f, 0.1f);
        b.beam({0.93f * k, 1.3f, 0.93f}, {0.75f * k, 2.8f, -0.75f}, 0.1f, 0.1f);
    }
    b.use(Texture::kPlank, Material::kWood, palette::kWood * 1.1f);
    b.lathe({{1.0f, 2.95f}, {1.12f, 3.5f}, {1.12f, 4.0f}, {1.0f, 4.55f}}, 10);
    b.use(Texture::kMetal, Material::kMetal, palette::kIron);
    for (float y : {3.2f, 4.3f}) b.lathe({{1.1f, y - 0.07f}, {1.1f, y + 0.07f}}, 10);
    b.use(Texture::kPlank, Material::kPaint, palette::kSky);
    b.lathe({{1.45f, 4.42f}, {1.42f, 4.55f}, {0.7f, 5.15f}, {0, 5.95f}}, 10);
    b.use(Texture::kMetal, Material::kMetal, palette::kBrass);
    b.lathe({{0.1f, 5.8f}, {0.16f, 6.0f}, {0, 6.35f}}, 6);
    b.use(Texture::kMetal, Material::kMetal, palette::kBrass);
    b.tube({{0, 2.95f, 0}, {0, 2.1f, 0.1f}, {0, 1.9f, 0.7f}}, {0.2f, 0.2f, 0.24f}, 7, false);
    b.tube({{0, 1.9f, 0.6f}, {0, 2.15f, 1.4f}, {0, 2.4f, 2.3f}, {0, 2.43f, 2.4f}},
           {0.34f, 0.26f, 0.16f, 0.23f}, 8, false);
    b.use(Texture::kWater, Material::kMetal, {0.05f, 0.2f, 0.35f});
    b.disc({0, 2.42f, 2.36f}, {1, 0, 0}, {0, 1, 0}, 0.17f, 7);
    b.use(Texture::kMetal, Material::kMetal, palette::kIron);
    b.frame = translate(0.3f, 2.0f, 0.75f) * rotateZ(kPi / 2);
    b.lathe({{0.28f, -0.1f}, {0.34f, -0.05f}, {0.34f, 0.03f}, {0.28f, 0.05f}}, 8);
    return b.finish();
}

Model makeWindFan(uint32_t seed) {
    MeshBuilder b("wind fan", seed, 512);
    addPlinth(b, palette::kMint);
    useTimber(b, palette::kWood * 0.85f);
    for (int x : {-1, 1})
        for (int z : {-1, 1})
            b.beam({0.9f * x, 1.1f, 0.9f * z}, {0.3f * x, 4.2f, 0.3f * z}, 0.18f, 0.18f);
    for (int i = 0; i < 2; ++i) {
        float y = 1.9f + i, q = mix(0.9f, 0.3f, (y - 1.1f) / 3.1f);
        for (int k : {-1, 1}) {
            b.beam({-q, y, q * k}, {q, y, q * k}, 0.12f, 0.12f);
            b.beam({q * k, y, -q}, {q * k, y, q}, 0.12f, 0.12f);
        }
    }
    b.use(Texture::kPlank, Material::kPaint, palette::kWhite);
    b.box({0, 4.0f, -0.1f}, {0.9f, 0.8f, 1.5f}, 0.8f, {0, 0, 1}, kAllFaces);
    b.use(Texture::kPlank, Material::kPaint, palette::kMint);
    b.box({0, 4.2f, -1.5f}, {0.08f, 1.2f, 1.2f}, 0.8f, {0, 0, 1}, kAllFaces);
    b.frame = translate(0, 4.4f, 0.95f);
    useTimber(b, palette::kWood);
    b.frame = b.frame * rotateX(kPi / 2);
    b.lathe({{1.75f, -0.16f}, {1.95f, -0.16f}, {1.95f, 0.16f}, {1.75f, 0.16f}, {1.75f, -0.16f}},
            14);
    b.frame = translate(0, 4.4f, 0.95f);
    for (int i = 0; i < 6; ++i) {
        b.frame = translate(0, 4.4f, 0.95f) * rotateZ(kPi / 3 * i + 0.2f);
        b.use(Texture::kCloth, Material::kCloth, i & 1 ? palette::kWhite : palette::kMint);
        b.grid(2, 2, 0.8f, 1.4f, [&](float u, float v) {
            return Vec3{(u - 0.35f) * mix(0.3f, 0.95f, v), 0.25f + 1.42f * v,
                        0.22f * (u - 0.5f) + 0.05f * std::sin(kPi * u)};
        });
        useTimber(b, palette::kOldWood);
        b.beam({0, 0, 0}, {0, 1.8f, 0}, 0.08f, 0.08f, 0.7f, kSidesOnly);
    }
    b.frame = translate(0, 4.4f, 0.95f);
    b.use(Texture::kMetal, Material::kMetal, palette::kBrass);
    b.blob({0, 0, 0.08f}, {0.3f, 0.3f, 0.3f}, 7, 3, 0);
    return b.finish();
}

}  // namespace village
