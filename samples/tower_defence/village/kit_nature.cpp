// Plants and harvest: trees, fences, hay and small tufts.
#include "kit_parts.h"

namespace village {

// Two metres along x.
Model makeRailFence(uint32_t seed, bool broken) {
    MeshBuilder b(broken ? "broken rail" : "rail fence", seed, 96);
    useTimber(b, palette::kOldWood);
    for (int i = 0; i < 2; ++i)
        b.box({-1.0f + float(i), -0.3f, 0}, {0.14f, 1.4f, 0.14f}, 0.8f, {0, 1, 0}, kOpenBelow,
              b.random(-0.06f, 0.06f));
    for (float y : {0.42f, 0.85f}) {
        const float tilt = b.random(-0.05f, 0.05f);
        if (broken && y > 0.5f)
            b.beam({-1.05f, y, 0.08f}, {0.7f, 0.05f, 0.25f}, 0.12f, 0.06f);
        else
            b.beam({-1.08f, y + tilt, 0.08f}, {1.08f, y - tilt, 0.08f}, 0.12f, 0.06f);
    }
    return b.finish();
}

// Two metres along x, woven round three posts.
Model makeWattle(uint32_t seed) {
    MeshBuilder b("wattle", seed, 96);
    useTimber(b, palette::kOldWood);
    for (int i = 0; i < 3; ++i)
        b.box({-1.0f + 0.66f * float(i), -0.3f, 0}, {0.14f, 1.15f, 0.14f}, 0.8f, {0, 1, 0},
              kOpenBelow, b.random(-0.06f, 0.06f));
    b.use(Texture::kStraw, Material::kWood, palette::kOldWood);
    b.grid(6, 1, 0.8f, 2.0f, [](float u, float v) {
        return Vec3{2 * u - 1, 0.1f + 0.65f * v, 0.07f * std::cos(kPi * 3 * u)};
    });
    b.fine = true;  // from afar, the front side suffices
    b.grid(6, 1, 0.8f, 2.0f, [](float u, float v) {
        return Vec3{1 - 2 * u, 0.1f + 0.65f * v, 0.07f * std::cos(kPi * 3 * (1 - u)) - 0.02f};
    });
    return b.finish();
}

// A leaning trunk of the given height with limbs. The caller adds leaves, unless it is bare.
static void addTrunk(MeshBuilder& b, float height, float top, int limbs, float reach, bool bare) {
    b.sway.yield = bare ? 0 : 0.0008f;  // applies to the whole tree, or the crown would separate
                                        // from it
    b.use(Texture::kBark, Material::kWood, palette::kOldWood * 0.75f);
    const float lean = b.random(-0.25f, 0.25f);
    b.tube({{0, -0.3f, 0},
            {0.04f, 0.35f, 0},
            {lean * 0.5f, height * 0.35f, 0.1f},
            {lean, height * top, 0}},
           {0.42f, 0.26f, 0.2f, 0.1f}, 5, false);
    b.fine = !bare;  // leaves hide most limbs
    for (int i = 0; i < limbs; ++i) {
        const float t = float(i) * 2.4f + b.random(), y = height * (0.3f + 0.07f * float(i));
        const Vec3 root{lean * 0.6f, y, 0};
        const Vec3 knee =
            root + Vec3{reach * 0.55f * std::cos(t), reach * 0.5f, reach * 0.55f * std::sin(t)};
        const Vec3 tip = knee + Vec3{reach * 0.35f * std::cos(t + 0.5f), reach * 0.75f,
                                     reach * 0.35f * std::sin(t + 0.5f)};
        b.tube({root, knee, tip}, {0.12f, 0.075f, 0.015f}, 3, false);
    }
    b.fine = false;
}

// Leaves keep soft normals: almost no edge of a crown is hard.
static void useLeaf(MeshBuilder& b, Vec3 tint) {
    b.use(Texture::kLeaf, Material::kLeaf, tint);
    b.crease = 0.2f;
}

Model makeOak(const char* name, Vec3 leaf, uint32_t seed) {
    MeshBuilder b(name, seed, 256);
    constexpr float kHeight = 4.6f;
    addTrunk(b, kHeight, 0.6f, 2, 0.9f, false);
    useLeaf(b, leaf);
    b.blob({0, kHeight * 0.72f, 0}, {1.45f, 1.15f, 1.4f}, 7, 4, 0.13f);
    for (int i = 0; i < 3; ++i) {
        const float t = 2.1f * float(i) + b.random();
        b.tint = leaf * b.random(0.85f, 1.2f);
        const float y = kHeight * b.random(0.52f, 0.64f);
        b.blob({std::cos(t), y, std::sin(t)}, {1.0f, 0.8f, 0.95f}, 6, 3, 0.15f);
    }
    b.tint = leaf * 1.2f;
    b.blob({0.2f, kHeight * 0.9f, 0.1f}, {0.85f, 0.65f, 0.8f}, 6, 3, 0.15f);
    return b.finish();
}

Model makeDeadTree(uint32_t seed) {
    MeshBuilder b("dead tree", seed, 128);
    addTrunk(b, 4.6f, 0.62f, 5, 1.3f, true);
    return b.finish();
}

Model makeBush(uint32_t seed) {
    MeshBuilder b("bush", seed, 128);
    b.sway.yield = 0.03f;
    useLeaf(b, palette::kLeafOak);
    b.blob({0, 0.4f, 0}, {0.75f, 0.6f, 0.65f}, 6, 3, 0.18f);
    b.tint = palette::kLeafOak * 1.3f;
    b.blob({0.5f, 0.3f, 0.2f}, {0.45f, 0.4f, 0.45f}, 5, 3, 0.2f);
    return b.finish();
}

// A trunk whose leaves hide all but its foot.
static void addPlainTrunk(MeshBuilder& b) {
    b.sway.yield = 0.0008f;
    b.use(Texture::kBark, Material::kWood, palette::kOldWood * 0.75f);
    b.beam({0, -0.3f, 0}, {0, 2.6f, 0}, 0.4f, 0.4f, 0.5f, kSidesOnly);
}

Model makePoplar(uint32_t seed) {
    MeshBuilder b("poplar", seed, 256);
    addPlainTrunk(b);
    useLeaf(b, palette::kLeafPoplar);
    b.lathe({{0.2f, 0.9f}, {0.75f, 1.5f}, {1.0f, 2.6f}, {0.85f, 4.2f}, {0.5f, 5.6f}, {0, 6.9f}}, 6,
            0.3f);
    return b.finish();
}

// The far trees of the forest belt have a quarter of the triangles.
Model makeFarOak(const char* name, Vec3 leaf, uint32_t seed) {
    MeshBuilder b(name, seed, 128);
    addPlainTrunk(b);
    useLeaf(b, leaf);
    b.blob({0.35f, 3.5f, 0}, {1.4f, 1.2f, 1.35f}, 6, 3, 0.14f);
    b.tint = leaf * 1.12f;
    b.blob({-0.75f, 2.7f, 0.3f}, {1.1f, 0.85f, 1.0f}, 5, 3, 0.15f);
    return b.finish();
}

Model makeFarPine(uint32_t seed) {
    MeshBuilder b("far pine", seed, 128);
    addPlainTrunk(b);
    useLeaf(b, palette::kLeafPine);
    for (int i = 0; i < 3; ++i) {
        const float y = 1.1f + 1.6f * float(i), r = 1.75f - 0.48f * float(i);
        b.tint = palette::kLeafPine * (0.9f + 0.15f * float(i));
        std::vector<Vec2> tier{{r, y - 0.12f}, {r * 0.5f, y + 0.85f}, {0, y + 2.0f}};
        if (i > 0) tier.erase(tier.begin() + 1);  // only the lowest tier shows its waist
        b.lathe(tier, 5, 0.22f, 0.5f * float(i));
    }
    return b.finish();
}

Model makeRoundBale(uint32_t seed) {
    MeshBuilder b("round bale", seed, 128);
    b.use(Texture::kStraw, Material::kStraw, palette::kHay);
    b.frame = translate(0, 0.68f, 0) * rotateX(kPi / 2) * translate(0, -0.6f, 0);
    b.lathe({{0, -0.02f}, {0.69f, 0.04f}, {0.69f, 1.16f}, {0, 1.22f}}, 8, 0.04f);
    b.use(Texture::kCloth, Material::kCloth, palette::kCrimson * 0.5f);
    b.fine = true;
    for (float y : {0.35f, 0.85f}) b.lathe({{0.715f, y - 0.03f}, {0.715f, y + 0.03f}}, 8);
    return b.finish();
}

Model makeHayrick(uint32_t seed) {
    MeshBuilder b("hayrick", seed, 128);
    b.use(Texture::kStraw, Material::kStraw, palette::kHay);
    b.lathe(
        {{1.0f, -0.1f}, {1.25f, 0.5f}, {1.3f, 1.1f}, {1.0f, 1.75f}, {0.45f, 2.45f}, {0.1f, 2.7f}},
        8, 0.14f);
    useTimber(b, palette::kOldWood);
    b.beam({0, 2.4f, 0}, {0.05f, 3.3f, 0}, 0.09f, 0.09f);
    b.use(Texture::kCloth, Material::kCloth, palette::kWood);
    b.lathe({{1.35f, 1.0f}, {1.35f, 1.08f}}, 8);
    return b.finish();
}

Model makeBales(uint32_t seed) {
    MeshBuilder b("bales", seed, 128);
    b.use(Texture::kStraw, Material::kStraw, palette::kHay);
    const Frame places[] = {rotateY(0.1f), translate(0.1f, 0, 0.75f) * rotateY(-0.15f),
                            translate(0.05f, 0.5f, 0.35f) * rotateY(0.3f)};
    for (const Frame& place : places) {
        b.frame = place;
        b.use(Texture::kStraw, Material::kStraw, palette::kHay * b.random(0.9f, 1.15f));
        b.box({0, 0, 0}, {1.2f, 0.52f, 0.62f}, 0.96f, {1, 0, 0});
        b.use(Texture::kCloth, Material::kCloth, palette::kTimber);
        b.fine = true;
        constexpr FaceMask kRound = 0b001011;
        for (float q : {-0.3f, 0.3f})
            b.box({q, 0, 0}, {0.05f, 0.53f, 0.635f}, 0.96f, {0, 1, 0}, kRound);
        b.fine = false;
    }
    return b.finish();
}

// All blades share one normal, so they are lit as one.
static void useBlades(MeshBuilder& b, Material material, Vec3 tint) {
    b.use(Texture::kStraw, material, tint);
    b.crease = -1;
}

Model makeDryGrass(uint32_t seed) {
    MeshBuilder b("dry grass", seed, 64);
    b.sway.yield = 0.09f;
    useBlades(b, Material::kStraw, {0.46f, 0.33f, 0.11f});
    b.blades({0, 0, 0}, 4, 0.55f, 0.17f, 0.42f);
    b.fine = true;
    b.blades({0, 0, 0}, 3, 0.55f, 0.17f, 0.42f);
    return b.finish();
}

// A strip of 2 m along x.
Model makeWheat(uint32_t seed) {
    MeshBuilder b("wheat", seed, 64);
    b.sway.yield = 0.035f;
    const Vec3 tint{0.60f, 0.40f, 0.10f};
    useBlades(b, Material::kStraw, tint);
    for (int i = 0; i < 5; ++i) {
        b.tint = tint * b.random(0.85f, 1.15f);
        const float z = b.random(-0.12f, 0.12f);
        const Vec3 root{-0.94f + 0.44f * float(i), 0, z};
        b.fine = false;
        b.blades(root, 2, 0.98f, 0.33f, 0.34f);
        b.fine = true;
        b.blades(root, 1, 0.98f, 0.33f, 0.34f);
    }
    return b.finish();
}

Model makeReeds(uint32_t seed) {
    MeshBuilder b("reeds", seed, 64);
    b.sway.yield = 0.02f;
    useBlades(b, Material::kLeaf, {0.12f, 0.17f, 0.05f});
    b.blades({0, 0, 0}, 7, 1.3f, 0.09f, 0.3f);
    return b.finish();
}

Model makeFlowers(uint32_t seed) {
    MeshBuilder b("flowers", seed, 64);
    b.sway.yield = 0.12f;
    useBlades(b, Material::kLeaf, {0.10f, 0.16f, 0.04f});
    b.blades({0, 0, 0}, 5, 0.3f, 0.18f, 0.42f);
    for (int i = 0; i < 3; ++i) {
        const float t = float(i) * 2.1f;
        const Vec3 petal = i & 1 ? Vec3{0.7f, 0.66f, 0.55f} : Vec3{0.62f, 0.40f, 0.03f};
        b.use(Texture::kCloth, Material::kLeaf, petal);
        b.disc({0.28f * std::cos(t), 0.32f + 0.04f * float(i), 0.28f * std::sin(t)}, {0, 0, 1},
               {1, 0, 0}, 0.07f, 4);
    }
    return b.finish();
}

}  // namespace village
