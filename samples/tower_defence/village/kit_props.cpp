// Props: barrels, carts, the well, the stall, lamps, the gate and the like.
#include "kit_parts.h"

namespace village {

// A wheel in the yz plane around c.
static void addWheel(MeshBuilder& b, Vec3 c, float radius) {
    const Frame keep = b.frame;
    b.frame = b.frame * translate(c.x, c.y, c.z) * rotateZ(kPi / 2) * translate(0, -0.05f, 0);
    useTimber(b, palette::kWood * 0.7f);
    b.lathe({{radius * 0.8f, 0}, {radius, 0}, {radius, 0.1f}, {radius * 0.8f, 0.1f}}, 8);
    for (int i = 0; i < 3; ++i) {
        float t = kPi * i / 3;
        b.beam({radius * 0.85f * std::cos(t), 0.05f, radius * 0.85f * std::sin(t)},
               {-radius * 0.85f * std::cos(t), 0.05f, -radius * 0.85f * std::sin(t)}, 0.07f, 0.06f,
               1, kSidesOnly);
    }
    b.frame = keep;
}

Model makeBarrel(uint32_t seed) {
    MeshBuilder b("barrel", seed, 96);
    b.use(Texture::kPlank, Material::kWood, palette::kWood);
    b.lathe({{0.3f, 0}, {0.38f, 0.3f}, {0.38f, 0.6f}, {0.3f, 0.9f}, {0, 0.86f}}, 9);
    b.use(Texture::kMetal, Material::kMetal, palette::kIron);
    b.fine = true;
    for (float y : {0.2f, 0.7f}) b.lathe({{0.37f, y - 0.04f}, {0.37f, y + 0.04f}}, 9);
    return b.finish();
}

Model makeCrate(uint32_t seed) {
    MeshBuilder b("crate", seed, 96);
    b.use(Texture::kPlank, Material::kWood, palette::kWood * 1.1f);
    b.box({0, 0, 0}, {0.8f, 0.8f, 0.8f});
    useTimber(b, palette::kOldWood);
    for (int x : {-1, 1})
        for (int z : {-1, 1}) b.box({0.38f * x, 0, 0.38f * z}, {0.13f, 0.84f, 0.13f});
    return b.finish();
}

Model makeHayCart(uint32_t seed) {
    MeshBuilder b("hay cart", seed, 192);
    b.use(Texture::kPlank, Material::kWood, palette::kWood);
    b.box({0, 0.7f, 0}, {1.4f, 0.1f, 2.4f}, 1, {0, 0, 1}, kAllFaces);
    for (int k : {-1, 1}) {
        b.box({0.7f * k, 0.75f, 0}, {0.08f, 0.5f, 2.4f}, 1, {0, 0, 1});
        b.beam({0.45f * k, 0.7f, 1.2f}, {0.35f * k, 0.35f, 2.7f}, 0.09f, 0.09f);
        addWheel(b, {0.85f * k, 0.6f, -0.3f}, 0.6f);
    }
    b.use(Texture::kStraw, Material::kStraw, palette::kHay * 1.1f);
    b.blob({0, 1.15f, -0.1f}, {0.8f, 0.6f, 1.2f}, 8, 4, 0.12f);
    return b.finish();
}

Model makeWell(uint32_t seed) {
    MeshBuilder b("well", seed, 192);
    b.use(Texture::kStone, Material::kStone, palette::kStone * 1.1f);
    b.lathe({{1.0f, -0.3f}, {0.95f, 0.8f}, {0.65f, 0.82f}, {0.65f, 0.3f}}, 10);
    b.use(Texture::kWater, Material::kWater, {0.02f, 0.05f, 0.06f});
    b.lathe({{0.66f, 0.4f}, {0, 0.4f}}, 10);
    useTimber(b);
    for (int k : {-1, 1}) b.beam({0.8f * k, 0.5f, 0}, {0.8f * k, 2.1f, 0}, 0.14f, 0.14f);
    b.beam({-0.95f, 1.75f, 0}, {0.95f, 1.75f, 0}, 0.1f, 0.1f);
    b.use(Texture::kPlank, Material::kPaint, palette::kBlue * 0.8f);
    for (int s : {-1, 1})
        b.grid(1, 1, 2.2f, 1.0f, [&](float u, float v) {
            return Vec3{s * (u - 0.5f) * 2.2f, mix(1.95f, 2.65f, v), s * mix(0.95f, 0, v)};
        });
    for (int s : {-1, 1})
        b.grid(1, 1, 2.2f, 1.0f, [&](float u, float v) {
            return Vec3{-s * (u - 0.5f) * 2.2f, mix(1.9f, 2.6f, v), s * mix(0.95f, 0, v)};
        });
    return b.finish();
}

Model makeMarketStall(uint32_t seed) {
    MeshBuilder b("market stall", seed, 160);
    useTimber(b, palette::kWood);
    for (int x : {-1, 1})
        for (int z : {-1, 1})
            b.beam({1.15f * x, 0, 0.75f * z}, {1.15f * x, z > 0 ? 1.9f : 2.4f, 0.75f * z}, 0.1f,
                   0.1f);
    b.use(Texture::kPlank, Material::kWood, palette::kWood);
    b.box({0, 0.75f, 0.25f}, {2.2f, 0.1f, 1.0f}, 1, {1, 0, 0}, kAllFaces);
    b.box({0, 0.1f, 0.6f}, {2.2f, 0.65f, 0.06f});
    for (int i = 0; i < 6; ++i) {
        b.use(Texture::kCloth, Material::kCloth,
              i & 1 ? palette::kWhite : palette::kVermilion * 0.8f);
        float x = -1.3f + 0.433f * i;
        b.grid(1, 4, 0.433f, 2.2f, [&](float u, float v) {
            float z = mix(1.05f, -0.95f, v);
            return Vec3{x + 0.433f * u,
                        v < 0.1f ? 1.62f : mix(1.85f, 2.5f, v) - 0.06f * std::sin(kPi * v),
                        v < 0.1f ? 1.05f : z};
        });
    }
    for (int i = 0; i < 4; ++i) {
        b.use(Texture::kLeaf, Material::kLeaf,
              i & 1 ? Vec3{0.55f, 0.22f, 0.02f} : Vec3{0.4f, 0.05f, 0.02f});
        b.blob({-0.8f + 0.5f * i, 0.95f, 0.3f}, {0.2f, 0.16f, 0.2f}, 5, 3, 0.1f);
    }
    return b.finish();
}

Model makeScarecrow(uint32_t seed) {
    MeshBuilder b("scarecrow", seed, 128);
    useTimber(b, palette::kOldWood);
    b.beam({0, -0.2f, 0}, {0, 2.0f, 0}, 0.09f, 0.09f);
    b.beam({-0.95f, 1.45f, 0}, {0.95f, 1.5f, 0}, 0.07f, 0.07f);
    b.use(Texture::kCloth, Material::kCloth, palette::kBlue * 0.7f);
    b.lathe({{0.5f, 0.6f}, {0.34f, 1.1f}, {0.3f, 1.5f}, {0.1f, 1.62f}}, 7, 0.1f);
    b.tube({{-0.75f, 1.45f, 0}, {0, 1.47f, 0}, {0.75f, 1.49f, 0}}, {0.15f, 0.17f, 0.15f}, 5);
    b.use(Texture::kStraw, Material::kStraw, palette::kStraw * 0.8f);
    b.blob({0, 1.85f, 0}, {0.24f, 0.26f, 0.24f}, 7, 4, 0.05f);
    b.lathe({{0.5f, 1.98f}, {0.24f, 2.05f}, {0, 2.5f}}, 8, 0.05f);
    b.blades({0.8f, 1.48f, 0}, 4, 0.3f, 0.07f, 0.15f, {1, 0, 0});
    b.blades({-0.8f, 1.45f, 0}, 4, 0.3f, 0.07f, 0.15f, {-1, 0, 0});
    return b.finish();
}

Model makeLampPost(uint32_t seed) {
    MeshBuilder b("lamp post", seed, 128);
    useTimber(b);
    b.beam({0, -0.2f, 0}, {0, 2.6f, 0}, 0.14f, 0.14f, 0.7f);
    b.beam({0, 2.35f, 0}, {0.65f, 2.5f, 0}, 0.09f, 0.09f);
    b.use(Texture::kMetal, Material::kMetal, palette::kIron);
    b.beam({0.55f, 2.46f, 0}, {0.55f, 2.25f, 0}, 0.03f, 0.03f);
    b.frame = translate(0.55f, 0, 0);
    b.lathe({{0.22f, 2.2f}, {0.04f, 2.38f}}, 6);
    b.use(Texture::kGlow, Material::kMetal, {0.5f, 0.35f, 0.15f}, 3);
    b.lathe({{0.11f, 1.9f}, {0.16f, 2.2f}}, 6);
    return b.finish();
}

Model makeWoodpile(uint32_t seed) {
    MeshBuilder b("woodpile", seed, 128);
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 5 - j; ++i) {
            float x = -0.8f + 0.4f * i + 0.2f * j, y = 0.2f + 0.34f * j;
            b.use(Texture::kBark, Material::kWood, palette::kOldWood * b.random(0.7f, 1.1f));
            b.tube({{x, y, -0.6f}, {x, y, 0.6f}}, {0.2f, 0.2f}, 6, false);
            b.use(Texture::kTimber, Material::kWood, palette::kWood * 1.9f);
            b.disc({x, y, 0.6f}, {1, 0, 0}, {0, 1, 0}, 0.2f, 6);
        }
    return b.finish();
}

Model makeGateArch(uint32_t seed) {
    MeshBuilder b("gate arch", seed, 224);
    useTimber(b, palette::kOldWood * 0.8f);
    for (int k : {-1, 1}) {
        b.beam({2.1f * k, -0.3f, 0}, {1.95f * k, 4.2f, 0}, 0.42f, 0.42f, 0.8f);
        b.beam({2.05f * k, 3.0f, 0}, {1.2f * k, 3.85f, 0}, 0.2f, 0.2f);
        b.use(Texture::kCloth, Material::kCloth, palette::kCrimson);
        b.sway = {3.4f, 0.02f};
        b.grid(2, 4, 0.7f, 1.6f, [&](float u, float v) {
            return Vec3{1.65f * k + 0.7f * (u - 0.5f),
                        3.4f - 1.7f * (1 - v) + 0.25f * (1 - v) * (u - 0.5f) * k,
                        0.3f + 0.12f * std::sin(4 * v + k)};
        });
        b.sway = {};
        useTimber(b, palette::kOldWood * 0.8f);
    }
    b.beam({-2.9f, 3.95f, 0}, {2.9f, 4.1f, 0}, 0.4f, 0.4f);
    b.use(Texture::kStraw, Material::kStraw, palette::kStraw);
    b.blob({0, 4.85f, 0}, {0.6f, 0.65f, 0.5f}, 8, 4, 0.1f);
    b.use(Texture::kGlow, Material::kStraw, {0.02f, 0.0f, 0.0f}, 2);
    for (int k : {-1, 1})
        b.triangle({0.22f * k - 0.14f, 4.85f, 0.5f}, {0.22f * k + 0.14f, 4.85f - 0.05f * k, 0.5f},
                   {0.22f * k, 5.05f, 0.46f}, {0, 1, 0});
    b.use(Texture::kStraw, Material::kStraw, palette::kStraw * 0.8f);
    for (int k : {-1, 1})
        b.tube({{0.45f * k, 5.1f, 0}, {1.0f * k, 5.4f, 0}, {1.1f * k, 6.0f, 0}},
               {0.2f, 0.14f, 0.02f}, 5, false);
    b.blades({0, 5.4f, 0}, 7, 0.7f, 0.2f, 0.5f);
    return b.finish();
}

Model makeBrazier(uint32_t seed) {
    MeshBuilder b("brazier", seed, 128);
    b.use(Texture::kMetal, Material::kMetal, palette::kIron);
    for (int i = 0; i < 3; ++i) {
        float t = 2.1f * i;
        b.beam({0.45f * std::cos(t), 0, 0.45f * std::sin(t)},
               {0.2f * std::cos(t), 0.9f, 0.2f * std::sin(t)}, 0.07f, 0.07f);
    }
    b.lathe({{0.2f, 0.8f}, {0.5f, 1.05f}, {0.42f, 1.08f}}, 8);
    b.use(Texture::kGlow, Material::kWood, {0.3f, 0.08f, 0.02f}, 4);
    b.blob({0, 1.05f, 0}, {0.4f, 0.16f, 0.4f}, 7, 3, 0.3f);
    return b.finish();
}

}  // namespace village
