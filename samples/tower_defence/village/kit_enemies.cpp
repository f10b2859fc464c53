// Enemies: fresh yellow straw or pale logs, one faction colour (crimson), ember eyes.
#include "kit_parts.h"

namespace village {

// Two slanted ember eyes at +-dx of c.
static void addEyes(MeshBuilder& b, Vec3 c, float dx, float s) {
    b.use(Texture::kGlow, Material::kStraw, {0.25f, 0.03f, 0.0f}, 5);
    for (int k : {-1, 1})
        b.triangle(c + Vec3{dx * k - s, -s * 0.3f * k, 0}, c + Vec3{dx * k + s, s * 0.3f * k, 0},
                   c + Vec3{dx * k, s * 1.2f, -0.02f}, {0, 1, 0});
}

Model makeStrawMan(uint32_t seed) {
    MeshBuilder b("straw man", seed, 160);
    b.use(Texture::kStraw, Material::kStraw, palette::kStraw);
    for (int k : {-1, 1}) {
        float f = k > 0 ? 0.28f : -0.22f;
        b.tube({{0.2f * k, 0, f}, {0.2f * k, 0.14f, f * 0.8f}, {0.13f * k, 0.85f, 0}},
               {0.22f, 0.10f, 0.16f}, 4, false, 0.1f);
    }
    b.lathe({{0.52f, 0.55f}, {0.36f, 0.82f}, {0.22f, 1.03f}, {0.40f, 1.38f}, {0.36f, 1.58f}}, 6,
            0.1f);
    b.tube({{0.3f, 1.5f, 0}, {0.68f, 1.28f, 0.1f}, {0.98f, 1.5f, 0.42f}}, {0.16f, 0.10f, 0.09f}, 4,
           false);
    b.tube({{-0.3f, 1.5f, 0}, {-0.66f, 1.4f, 0.12f}, {-0.96f, 1.72f, 0.38f}}, {0.16f, 0.10f, 0.09f},
           4, false);
    b.tint = palette::kStraw * 1.1f;
    b.fine = true;
    b.blades({0.98f, 1.5f, 0.42f}, 4, 0.36f, 0.1f, 0.22f, normalize({0.3f, 0.3f, 0.4f}));
    b.blades({-0.96f, 1.72f, 0.38f}, 4, 0.36f, 0.1f, 0.22f, normalize({-0.3f, 0.5f, 0.3f}));
    b.use(Texture::kCloth, Material::kCloth, palette::kTimber * 1.4f);
    b.lathe({{0.245f, 0.98f}, {0.245f, 1.08f}}, 6);
    b.fine = false;
    b.use(Texture::kCloth, Material::kCloth, palette::kCrimson);
    b.lathe({{0.41f, 1.49f}, {0.22f, 1.80f}}, 6, 0.04f);
    b.grid(1, 2, 0.34f, 0.8f, [&](float u, float v) {
        return Vec3{0.18f + 0.3f * (u - 0.5f), 1.66f - 0.75f * (1 - v),
                    -0.34f - 0.3f * (1 - v) + 0.06f * std::sin(6 * v)};
    });
    b.use(Texture::kCloth, Material::kCloth, {0.20f, 0.145f, 0.085f});
    b.lathe({{0.24f, 1.76f}, {0.27f, 2.06f}}, 6, 0.04f);
    addEyes(b, {0, 1.92f, 0.30f}, 0.11f, 0.075f);
    b.use(Texture::kStraw, Material::kStraw, palette::kStraw * 0.85f);
    b.lathe({{0.58f, 2.02f}, {0.3f, 2.2f}, {0.17f, 2.5f}, {0.0f, 2.85f}}, 6, 0.06f);
    b.use(Texture::kCloth, Material::kCloth, palette::kCrimson);
    b.lathe({{0.315f, 2.19f}, {0.26f, 2.34f}}, 6);
    return b.finish();
}

Model makeYuleGoat(uint32_t seed) {
    MeshBuilder b("yule goat", seed, 128);
    b.use(Texture::kStraw, Material::kStraw, palette::kStraw * 1.05f);
    b.tube(
        {{0, 1.0f, -0.85f}, {0, 1.02f, -0.7f}, {0, 0.98f, 0}, {0, 1.05f, 0.5f}, {0, 1.1f, 0.68f}},
        {0.2f, 0.34f, 0.30f, 0.36f, 0.2f}, 6, true, 0.08f);
    for (int x : {-1, 1})
        for (int z : {-1, 1})
            b.tube({{0.24f * x, 0, 0.52f * z + 0.12f * x * z},
                    {0.24f * x, 0.1f, 0.5f * z + 0.1f * x * z},
                    {0.2f * x, 0.95f, 0.42f * z}},
                   {0.16f, 0.1f, 0.17f}, 4, false, 0.06f);
    b.tube({{0, 1.05f, 0.45f}, {0, 1.45f, 0.78f}, {0, 1.72f, 0.9f}}, {0.28f, 0.17f, 0.16f}, 6,
           false);
    b.tube({{0, 1.78f, 0.75f}, {0, 1.7f, 1.0f}, {0, 1.5f, 1.32f}}, {0.17f, 0.19f, 0.1f}, 6, true);
    b.fine = true;
    b.blades({0, 1.45f, 1.2f}, 4, 0.35f, 0.08f, 0.12f, {0, -1, 0});
    b.blades({0, 1.15f, -0.85f}, 5, 0.4f, 0.09f, 0.2f, normalize({0, 0.8f, -0.5f}));
    b.fine = false;
    b.tint = palette::kStraw * 0.7f;
    for (int k : {-1, 1})
        b.tube({{0.1f * k, 1.85f, 0.88f},
                {0.2f * k, 2.15f, 0.80f},
                {0.29f * k, 2.33f, 0.56f},
                {0.43f * k, 2.1f, 0.07f},
                {0.52f * k, 1.66f, 0.2f}},
               {0.13f, 0.13f, 0.12f, 0.09f, 0.02f}, 3, false);
    b.use(Texture::kCloth, Material::kCloth, palette::kCrimson);
    for (float z : {-0.4f, 0.12f}) {
        b.frame = translate(0, 0.99f, z) * rotateX(kPi / 2);
        b.lathe({{0.36f, -0.07f}, {0.36f, 0.07f}}, 6);
    }
    b.frame = translate(0, 1.4f, 0.74f) * rotateX(0.65f);
    b.lathe({{0.235f, -0.08f}, {0.22f, 0.08f}}, 6);
    b.frame = rotateX(0.35f);
    addEyes(b, {0, 1.30f, 1.74f}, 0.12f, 0.06f);
    return b.finish();
}

Model makeLogKnight(uint32_t seed) {
    MeshBuilder b("log knight", seed, 160);
    enum Ends { kNone, kFar, kBoth };  // visible ends
    auto log = [&](Vec3 a, Vec3 c, float r0, float r1, int n, Ends ends) {
        b.use(Texture::kBark, Material::kWood, palette::kPeeledLog);
        b.tube({a, c}, {r0, r1}, n, false);
        if (ends == kNone) return;
        b.use(Texture::kTimber, Material::kWood, palette::kWood * 2.2f);
        Frame f = along(a, c);
        b.disc(c, f.z, f.x, r1, n);
        if (ends == kBoth) b.disc(a, f.x, f.z, r0, n);
    };
    for (int k : {-1, 1}) {
        log({0.26f * k, 0, 0.1f * k}, {0.24f * k, 0.85f, 0}, 0.2f, 0.18f, 7, kNone);
        log({0.55f * k, 1.7f, 0}, {0.72f * k, 1.05f, 0.3f}, 0.17f, 0.15f, 7, kFar);
    }
    log({0, 0.8f, 0}, {0, 1.75f, 0}, 0.42f, 0.5f, 9, kFar);
    log({-0.78f, 1.72f, 0}, {0.78f, 1.72f, 0}, 0.2f, 0.2f, 7, kBoth);
    log({0, 1.85f, 0.02f}, {0, 2.45f, 0.05f}, 0.27f, 0.29f, 8, kFar);
    b.use(Texture::kMetal, Material::kMetal, palette::kIron);
    for (float y : {1.0f, 1.5f})
        b.lathe(
            {{mix(0.43f, 0.51f, y - 0.8f), y - 0.06f}, {mix(0.45f, 0.53f, y - 0.8f), y + 0.06f}},
            9);
    b.fine = true;
    b.lathe({{0.295f, 2.28f}, {0.305f, 2.4f}}, 8);
    b.fine = false;
    b.use(Texture::kGlow, Material::kWood, {0.01f, 0.0f, 0.0f}, 0);
    b.box({0, 2.08f, 0.28f}, {0.42f, 0.15f, 0.05f}, 1, {1, 0, 0}, kFrontAndTop);
    addEyes(b, {0, 2.09f, 0.33f}, 0.11f, 0.06f);
    b.frame = translate(0.55f, 0.5f, 0.55f) * rotateY(0.25f);
    b.use(Texture::kPlank, Material::kPaint, palette::kCrimson * 0.9f);
    b.box({0, 0, 0}, {0.95f, 1.35f, 0.09f});
    b.use(Texture::kPlank, Material::kPaint, palette::kWhite);
    b.box({0, 0.1f, 0.06f}, {0.14f, 1.15f, 0.03f}, 1, {0, 1, 0}, kFrontAndTop);
    b.box({0, 0.75f, 0.06f}, {0.75f, 0.14f, 0.03f}, 1, {1, 0, 0}, kFrontAndTop);
    useTimber(b);
    b.box({0, -0.03f, 0}, {1.03f, 0.1f, 0.14f}, 1, {1, 0, 0});
    b.box({0, 1.28f, 0}, {1.03f, 0.1f, 0.14f}, 1, {1, 0, 0});
    b.frame = Frame{};
    b.use(Texture::kTimber, Material::kWood, palette::kWood);
    b.beam({-0.72f, 0.5f, 0.4f}, {-0.8f, 2.3f, 0.35f}, 0.09f, 0.09f);
    b.use(Texture::kBark, Material::kWood, palette::kOldWood);
    b.tube({{-0.79f, 2.0f, 0.36f}, {-0.8f, 2.25f, 0.35f}, {-0.82f, 2.75f, 0.34f}},
           {0.13f, 0.22f, 0.16f}, 6);
    b.use(Texture::kLeaf, Material::kLeaf, palette::kLeafPoplar);
    b.fine = true;
    b.blades({0, 2.45f, 0.05f}, 5, 0.4f, 0.14f, 0.3f);
    return b.finish();
}

// The boss.
Model makeWickerGiant(uint32_t seed) {
    MeshBuilder b("wicker giant", seed, 256);
    const Vec3 w = palette::kWicker;
    b.use(Texture::kStraw, Material::kWood, w);
    for (int k : {-1, 1}) {
        float f = 0.35f * k;
        b.tube({{0.65f * k, 0, f},
                {0.62f * k, 0.35f, f},
                {0.55f * k, 1.1f, 0.1f * k},
                {0.42f * k, 2.0f, 0}},
               {0.52f, 0.34f, 0.36f, 0.46f}, 8, false, 0.1f);
        b.tube({{0.85f * k, 3.6f, 0},
                {1.4f * k, 2.9f, 0.15f},
                {1.6f * k, 2.1f, 0.75f},
                {1.65f * k, 1.75f, 0.95f}},
               {0.42f, 0.3f, 0.3f, 0.36f}, 7, true, 0.1f);
        b.use(Texture::kStraw, Material::kStraw, palette::kStraw);
        b.blades({1.65f * k, 1.8f, 0.95f}, 6, 0.55f, 0.16f, 0.3f,
                 normalize({0.1f * k, -0.6f, 0.3f}));
        b.use(Texture::kStraw, Material::kWood, w);
    }
    b.lathe({{0.85f, 1.5f},
             {0.7f, 1.95f},
             {0.62f, 2.2f},
             {0.85f, 2.7f},
             {1.1f, 3.3f},
             {1.0f, 3.75f},
             {0.35f, 4.0f}},
            10, 0.08f);
    b.use(Texture::kStraw, Material::kStraw, palette::kStraw);
    b.lathe({{1.08f, 1.35f}, {0.72f, 2.05f}, {0.64f, 2.1f}}, 10, 0.25f);
    for (int k : {-1, 1})
        b.blades({0.9f * k, 3.65f, 0}, 7, 0.75f, 0.2f, 0.6f, normalize({0.5f * k, 1, 0}));
    useTimber(b, palette::kOldWood * 0.7f);
    for (int i = 0; i < 8; ++i) {
        float t = kPi * (i + 0.5f) / 4;
        b.beam({0.66f * std::cos(t), 2.2f, 0.66f * std::sin(t)},
               {1.1f * std::cos(t), 3.35f, 1.1f * std::sin(t)}, 0.1f, 0.08f, 1, kSidesOnly);
    }
    b.use(Texture::kCloth, Material::kCloth, palette::kCrimson);
    b.lathe({{0.68f, 2.0f}, {0.66f, 2.25f}}, 10);
    b.grid(2, 4, 0.7f, 1.3f, [&](float u, float v) {
        return Vec3{0.65f * (u - 0.5f) * (0.7f + 0.3f * v), 2.15f - 1.3f * (1 - v),
                    0.74f + 0.25f * (1 - v) + 0.06f * std::sin(7 * v)};
    });
    b.use(Texture::kCloth, Material::kCloth, palette::kCrimson);
    b.tube({{-0.95f, 3.9f, 0.05f}, {-0.3f, 3.3f, 1.0f}, {0.75f, 2.35f, 0.72f}},
           {0.16f, 0.2f, 0.14f}, 5, false);
    b.tube({{-0.95f, 3.9f, 0}, {-0.2f, 3.2f, -1.05f}, {0.75f, 2.35f, -0.68f}}, {0.16f, 0.2f, 0.14f},
           5, false);
    b.use(Texture::kStraw, Material::kStraw, palette::kStraw * 0.95f);
    b.blob({0, 4.45f, 0.1f}, {0.58f, 0.66f, 0.54f}, 8, 4, 0.05f);
    addEyes(b, {0, 4.42f, 0.64f}, 0.2f, 0.13f);
    b.use(Texture::kGlow, Material::kStraw, {0.25f, 0.03f, 0}, 3);
    b.quad({-0.25f, 4.15f, 0.62f}, {0.25f, 4.15f, 0.62f}, {0.12f, 4.25f, 0.64f},
           {-0.12f, 4.25f, 0.64f}, {0, 1, 0});
    useTimber(b, palette::kOldWood);
    for (int k : {-1, 1}) {
        b.tube({{0.35f * k, 4.75f, 0}, {0.75f * k, 5.15f, -0.05f}, {0.8f * k, 5.75f, 0}},
               {0.13f, 0.09f, 0.02f}, 5, false);
        b.tube({{0.7f * k, 5.1f, 0}, {1.1f * k, 5.3f, 0.05f}}, {0.07f, 0.015f}, 4, false);
    }
    return b.finish();
}

}  // namespace village
