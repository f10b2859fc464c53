// Pictures of objects on the library's own device: images by material slot, both sides of open
// meshes, buffers shared by objects of one mesh. Skips with a message if there is no device.
#include "abi/abi_support.h"

#include <cstdlib>
#include <map>

namespace {

using host::created;
using host::getState;
using host::Host;
using host::lastMessage;
using host::materialOf;

struct Color {
    int r, g, b;
};

// A world on its own device; null without Vulkan.
struct DrawnWorld : host::HostedWorld {
    explicit DrawnWorld(const FwWorldDef& worldDef = fwDefaultWorldDef())
        : HostedWorld(FW_BACKEND_VULKAN, worldDef) {}

    FwMaterialId material(uint32_t preset) {
        FwMaterialDef def = materialOf(preset);
        return created(fwWorld_CreateMaterial, world, def);
    }
    FwImageId image(uint32_t pixel) {
        const uint32_t pixels[4] = {pixel, pixel, pixel, pixel};
        FwImageDef def = fwDefaultImageDef();
        def.width = def.height = 2;
        def.pixels = pixels;
        return created(fwWorld_CreateImage, world, def);
    }
    // 64 x 32 pixels that look straight down on a sheet of 1 x 0.5 m, or up at it from below.
    std::vector<Color> look(bool below = false) {
        FwOffscreenDef def = fwDefaultOffscreenDef();
        def.width = 64;
        def.height = 32;
        FwView& view = def.view;
        // Object x points right. z points down in the picture from above and up from below.
        const float side = below ? -1.0f : 1.0f;
        const float placed[16] = {1, 0, 0, 0, 0, 0, side, 0, 0, -side, 0, 0, -0.5f, side * 0.25f,
                                  0, 1};
        std::copy_n(placed, 16, view.view);
        view.view[14] = -2;
        std::fill_n(view.projection, 16, 0.0f);
        view.projection[0] = 2;  // orthographic, 1 m wide
        view.projection[5] = -4;
        view.projection[10] = -0.25f;
        view.projection[15] = 1;
        std::vector<uint32_t> pixels(64 * 32);
        def.pixels = pixels.data();
        EXPECT_EQ(FW_OK, fwWorld_RenderOffscreen(world, &def)) << lastMessage(world);
        std::vector<Color> out;
        for (const uint32_t p : pixels)
            out.push_back({int(p & 255), int(p >> 8 & 255), int(p >> 16 & 255)});
        return out;
    }
};

#define DRAWN_WORLD_OR_SKIP(name, ...) \
    DrawnWorld name{__VA_ARGS__};      \
    if (!name.world) GTEST_SKIP() << "no Vulkan device"

template <class Test>
int count(const std::vector<Color>& picture, int x0, int x1, const Test& test) {
    int found = 0;
    for (int y = 0; y < 32; ++y)
        for (int x = x0; x < x1; ++x) found += test(picture[size_t(y * 64 + x)]) ? 1 : 0;
    return found;
}
bool red(const Color& c) { return c.r > 2 * c.g && c.r > 2 * c.b && c.r > 60; }
bool green(const Color& c) { return 2 * c.g > 3 * c.r && c.g > 2 * c.b && c.g > 60; }
bool wooden(const Color& c) { return c.r > c.g && c.g > c.b && c.b > 20; }
bool blue(const Color& c) { return c.b > 2 * c.r && c.b > 2 * c.g && c.b > 60; }

TEST(DrawnMesh, EveryMaterialSlotShowsItsImage) {
    DRAWN_WORLD_OR_SKIP(w);
    const host::Sheet sheet(1.0f, 0.5f, 4);
    FwMeshDef mesh = sheet.def(32);
    std::vector<uint8_t> materials;
    for (int z = 0; z < 4; ++z)
        for (int x = 0; x < 4; ++x) materials.insert(materials.end(), 2, uint8_t(x));
    mesh.triangleMaterials = materials.data();
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    ASSERT_EQ(FW_OK, fwWorld_CreateMesh(w.world, &mesh, &def.mesh)) << lastMessage(w.world);
    for (FwMaterialId& id : def.materials) id = w.material(FW_MATERIAL_PINE);
    const FwImageId first = w.image(0xFF0000FFu), other = w.image(0xFF00FF00u);
    def.baseColor = w.image(0xFFFF0000u);
    def.baseColors[0] = first;
    def.baseColors[2] = other;
    def.baseColors[3] = first;
    const FwBurnableMeshId id = created(fwWorld_CreateBurnableMesh, w.world, def);
    ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 0.1f));
    std::vector<Color> picture = w.look();
    EXPECT_EQ(15 * 32, count(picture, 0, 15, red));
    EXPECT_EQ(14 * 32, count(picture, 17, 31, blue)) << "baseColor where a slot has no image";
    EXPECT_EQ(14 * 32, count(picture, 33, 47, green));
    EXPECT_EQ(15 * 32, count(picture, 49, 64, red));
    // A destroyed image leaves its slots to the material's own colour.
    ASSERT_EQ(FW_OK, fwWorld_DestroyImage(w.world, first));
    picture = w.look();
    EXPECT_EQ(0, count(picture, 0, 15, red));
    EXPECT_EQ(15 * 32, count(picture, 0, 15, wooden));
    EXPECT_EQ(14 * 32, count(picture, 33, 47, green));
    // A stale id is refused and changes nothing.
    FwBurnableMeshId none{};
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_CreateBurnableMesh(w.world, &def, &none));
    EXPECT_EQ(FW_OK, fwWorld_DestroyBurnableMesh(w.world, id));
}

// Share of the 64 x 32 pixels in which the sheet is drawn. Its picture has discs 8 pixels apart
// that are opaque by their alpha.
double shareDrawn(DrawnWorld& w, float alphaCutoff, int radius, bool below = false) {
    std::vector<uint32_t> pixels;
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 256; ++x) {
            const int dx = x % 32 - 16, dy = y % 32 - 16;
            pixels.push_back(dx * dx + dy * dy < radius * radius ? 0xFF0000FFu : 0x00FF0000u);
        }
    FwImageDef image = fwDefaultImageDef();
    image.width = image.height = 256;
    image.pixels = pixels.data();
    image.alphaCutoff = alphaCutoff;
    const host::Sheet sheet(1.0f, 0.5f, 4);
    const FwMeshDef mesh = sheet.def(32);
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    EXPECT_EQ(FW_OK, fwWorld_CreateImage(w.world, &image, &def.baseColor)) << lastMessage(w.world);
    EXPECT_EQ(FW_OK, fwWorld_CreateMesh(w.world, &mesh, &def.mesh)) << lastMessage(w.world);
    def.materials[0] = w.material(FW_MATERIAL_PINE);
    def.flags = FW_BURNABLE_TWO_SIDED;
    const FwBurnableMeshId id = created(fwWorld_CreateBurnableMesh, w.world, def);
    EXPECT_EQ(FW_OK, fwWorld_Step(w.world, 0.1f));
    const std::vector<Color> picture = w.look(below);
    EXPECT_EQ(FW_OK, fwWorld_DestroyBurnableMesh(w.world, id));
    const int drawn = count(picture, 0, 64, [](const Color& c) { return c.r + c.g + c.b > 15; });
    // Where a pixel has a colour, it is the picture's: no colour bleeds in from around it.
    if (alphaCutoff > 0) {
        EXPECT_EQ(drawn, count(picture, 0, 64,
                               [](const Color& c) { return c.r > 2 * c.g && c.r > 2 * c.b; }));
    }
    return drawn / (64.0 * 32);
}

TEST(DrawnMesh, CutOutsAreDrawnWhereAlphaExceedsTheCutoff) {
    DRAWN_WORLD_OR_SKIP(w);
    EXPECT_EQ(1, shareDrawn(w, 0, 12)) << "alpha is ignored";
    // Four pixels of the picture per pixel of the screen: mips keep the covered share.
    for (const int radius : {4, 8, 12, 15}) {
        const double share = 3.14159 * radius * radius / (32.0 * 32.0);
        EXPECT_NEAR(share, shareDrawn(w, 0.5f, radius), 0.06) << radius;
        EXPECT_NEAR(share, shareDrawn(w, 0.5f, radius, true), 0.06) << radius << " from below";
    }
}

// Frames skip idle objects; changes made meanwhile apply when the object burns.
TEST(DrawnMesh, AnObjectMovedWhileAsleepBurnsAtItsNewPlace) {
    FwWorldDef worldDef = fwDefaultWorldDef();
    worldDef.paceFactor = 20;
    DRAWN_WORLD_OR_SKIP(w, worldDef);
    const host::Sheet sheet(1.0f, 0.5f, 4);
    const FwMeshDef mesh = sheet.def(32);
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    ASSERT_EQ(FW_OK, fwWorld_CreateMesh(w.world, &mesh, &def.mesh)) << lastMessage(w.world);
    def.materials[0] = w.material(FW_MATERIAL_PAPER);
    def.baseColor = w.image(0xFF00FF00u);
    def.flags = 0;  // objects with refined borders never sleep
    FwBurnableMeshId id = created(fwWorld_CreateBurnableMesh, w.world, def);
    const auto wait = [&](int frames) {
        for (int i = 0; i < frames; ++i) ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 0.1f));
    };
    // Mean position of its flames' light when it is lit at `x`; -1: no light.
    const auto lit = [&](float x) {
        FwIgnitionDef fire = fwDefaultIgnitionDef();
        fire.position[0] = x;
        fire.radius = 0.2f;
        uint32_t texels = 0;
        EXPECT_EQ(FW_OK, fwWorld_Ignite(w.world, &fire, &texels));
        EXPECT_GT(texels, 0u);
        wait(8);
        FwLight lights[16];
        const uint32_t count = fwWorld_GetLights(w.world, lights, 16);
        float sum = 0;
        for (uint32_t i = 0; i < count; ++i) sum += lights[i].position[0];
        return count ? sum / float(count) : -1.0f;
    };
    wait(5);
    const int all = count(w.look(), 0, 64, green);
    EXPECT_GT(all, 1500);
    def.transform[12] = 5;
    ASSERT_EQ(FW_OK, fwWorld_SetTransform(w.world, id, def.transform));
    wait(5);
    EXPECT_EQ(0, count(w.look(), 0, 64, green));
    EXPECT_NEAR(lit(5.2f), 5.2f, 0.4f);
    // Another object in its slot, which fire has not reached.
    ASSERT_EQ(FW_OK, fwWorld_DestroyBurnableMesh(w.world, id));
    wait(5);
    def.transform[12] = 0;
    ASSERT_EQ(FW_OK, fwWorld_CreateBurnableMesh(w.world, &def, &id)) << lastMessage(w.world);
    wait(5);
    EXPECT_EQ(all, count(w.look(), 0, 64, green));
    EXPECT_NEAR(lit(0.2f), 0.2f, 0.4f);
}

TEST(DrawnMesh, BothSidesOfAnOpenMeshShowOneBurnMap) {
    FwWorldDef worldDef = fwDefaultWorldDef();
    worldDef.paceFactor = 20;
    DRAWN_WORLD_OR_SKIP(w, worldDef);
    const host::Sheet sheet(1.0f, 0.5f, 4);
    const FwMeshDef mesh = sheet.def(64);
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    ASSERT_EQ(FW_OK, fwWorld_CreateMesh(w.world, &mesh, &def.mesh)) << lastMessage(w.world);
    def.flags = FW_BURNABLE_TWO_SIDED | FW_BURNABLE_NO_HOLES;
    for (FwMaterialId& id : def.materials) id = w.material(FW_MATERIAL_PINE);
    (void)created(fwWorld_CreateBurnableMesh, w.world, def);
    ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 0.1f));
    const auto light = [](const Color& c) { return c.r + c.g + c.b > 45; };
    const auto sum = [](const std::vector<Color>& picture) {
        int all = 0;
        for (const Color& c : picture) all += c.r + c.g + c.b;
        return all;
    };
    const std::vector<Color> above = w.look(), below = w.look(true);
    EXPECT_EQ(64 * 32, count(above, 0, 64, light));
    EXPECT_EQ(64 * 32, count(below, 0, 64, light));
    EXPECT_GT(sum(above), 5 * sum(below) / 4) << "the sun shines from above";
    FwIgnitionDef match = fwDefaultIgnitionDef();
    match.position[0] = match.position[2] = 0.25f;
    match.radius = 0.1f;
    ASSERT_EQ(FW_OK, fwWorld_Ignite(w.world, &match, nullptr));
    for (int i = 0; i < 30; ++i) ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 0.1f));
    // From below, x runs as from above: the same half has burnt.
    const std::vector<Color> burnt = w.look(), under = w.look(true);
    const auto changed = [&](const std::vector<Color>& now, const std::vector<Color>& then, int x0,
                             int x1) {
        int many = 0;
        for (size_t i = 0; i < now.size(); ++i) {
            const int x = int(i % 64);
            const int d = std::abs(now[i].r - then[i].r) + std::abs(now[i].g - then[i].g) +
                          std::abs(now[i].b - then[i].b);
            many += x >= x0 && x < x1 && d > 16 ? 1 : 0;
        }
        return many;
    };
    EXPECT_GT(changed(burnt, above, 4, 28), 150);
    EXPECT_GT(changed(under, below, 4, 28), 150) << "and the other side";
}

// Bends a strip into a half pipe while it burns.
void bend(const host::Sheet& sheet, float turn, float lift, std::vector<float>& out) {
    out.resize(sheet.positions.size());
    for (size_t i = 0; i < out.size(); i += 3) {
        const float x = sheet.positions[i] - 0.5f;
        const float radius = 1 / std::max(turn, 1e-3f);
        out[i] = 0.5f + radius * std::sin(x / radius);
        out[i + 1] = lift + radius * (1 - std::cos(x / radius));
        out[i + 2] = sheet.positions[i + 2];
    }
}

TEST(DrawnMesh, SkinnedStripsBurnAtTheirCurrentPlace) {
    FwWorldDef worldDef = fwDefaultWorldDef();
    worldDef.paceFactor = 10;
    DRAWN_WORLD_OR_SKIP(w, worldDef);
    const host::Sheet sheet(1.0f, 0.5f, 16);
    const FwMeshDef mesh = sheet.def(64);
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    ASSERT_EQ(FW_OK, fwWorld_CreateMesh(w.world, &mesh, &def.mesh)) << lastMessage(w.world);
    def.flags = FW_BURNABLE_SKINNED | FW_BURNABLE_TWO_SIDED | FW_BURNABLE_NO_HOLES;
    for (FwMaterialId& id : def.materials) id = w.material(FW_MATERIAL_PINE);
    const FwBurnableMeshId id = created(fwWorld_CreateBurnableMesh, w.world, def);
    ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 0.1f));
    const auto lit = [](const Color& c) { return c.r + c.g + c.b > 30; };
    EXPECT_EQ(64 * 32, count(w.look(), 0, 64, lit)) << "in the rest pose";
    std::vector<float> places;
    const auto count3 = uint32_t(sheet.positions.size() / 3);
    bend(sheet, 3.14159f, 0.5f, places);  // a half circle 0.64 m wide, 0.5 m up
    ASSERT_EQ(FW_OK, fwWorld_SetVertexPositions(w.world, id, places.data(), nullptr, count3))
        << lastMessage(w.world);
    ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 0.0f));
    std::vector<Color> picture = w.look();
    EXPECT_EQ(0, count(picture, 0, 10, lit));
    EXPECT_EQ(0, count(picture, 54, 64, lit));
    EXPECT_EQ(36 * 32, count(picture, 14, 50, lit));
    // The floor faces the sun and the walls turn away: normals follow the triangles.
    const auto sum = [&](int x0, int x1) {
        int all = 0;
        count(picture, x0, x1, [&](const Color& c) { return all += c.r + c.g + c.b, true; });
        return all / (x1 - x0);
    };
    EXPECT_GT(sum(30, 34), sum(47, 51) * 6 / 5);
    // The match lights the bent strip, not its rest pose; the light is there too.
    FwIgnitionDef match = fwDefaultIgnitionDef();
    match.object = id;
    match.position[0] = 0.5f;
    match.position[2] = 0.25f;
    match.radius = 0.1f;
    uint32_t texels = 1;
    ASSERT_EQ(FW_NOTHING_THERE, fwWorld_Ignite(w.world, &match, &texels));
    EXPECT_EQ(0u, texels) << "nothing is at its rest pose";
    match.position[1] = 0.5f;
    ASSERT_EQ(FW_OK, fwWorld_Ignite(w.world, &match, &texels));
    EXPECT_GT(texels, 60u);
    for (int i = 0; i < 12; ++i) ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 0.125f));
    FwLight lights[64];
    const uint32_t known = fwWorld_GetLights(w.world, lights, 64);
    ASSERT_GT(known, 0u);
    for (uint32_t i = 0; i < known; ++i) {
        EXPECT_GT(lights[i].position[1], 0.4f) << i;
        EXPECT_LT(lights[i].position[1], 1.2f) << i;
    }
    // With the host's normals, which all point up, the walls are as bright as the floor.
    std::vector<float> up(places.size(), 0.0f);
    for (size_t i = 1; i < up.size(); i += 3) up[i] = 2;
    ASSERT_EQ(FW_OK, fwWorld_SetVertexPositions(w.world, id, places.data(), up.data(), count3));
    picture = w.look();
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT,
              fwWorld_SetVertexPositions(w.world, id, places.data(), nullptr, count3 - 1));
    EXPECT_NE(std::string::npos, lastMessage(w.world).find("vertexCount is"));
    places[7] = std::nanf("");
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT,
              fwWorld_SetVertexPositions(w.world, id, places.data(), nullptr, count3));
    EXPECT_NE(std::string::npos, lastMessage(w.world).find("positions[7]"));
    EXPECT_EQ(FW_OK, fwWorld_DestroyBurnableMesh(w.world, id));
}

// A burnt sheet of paper leaves nothing. Without damage all of it stays, without holes a charred
// sheet.
TEST(DrawnMesh, ABurntSheetWithoutDamageLooksUnburnt) {
    FwWorldDef worldDef = fwDefaultWorldDef();
    worldDef.paceFactor = 20;
    worldDef.maxLights = 0;
    DRAWN_WORLD_OR_SKIP(w, worldDef);
    const host::Sheet sheet(0.2f, 0.5f, 8);
    const FwMeshDef mesh = sheet.def(64);
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    ASSERT_EQ(FW_OK, fwWorld_CreateMesh(w.world, &mesh, &def.mesh)) << lastMessage(w.world);
    for (FwMaterialId& id : def.materials) id = w.material(FW_MATERIAL_PAPER);
    FwPin pin{};  // the whole sheet, so that it never moves
    pin.radius = 2;
    def.pins = &pin;
    const struct {
        uint32_t world, object;
        bool harmed;
    } cases[4] = {{0, 0, true},
                  {0, FW_BURNABLE_NO_DAMAGE, false},
                  {FW_WORLD_NO_DAMAGE, FW_BURNABLE_SHELL, false},
                  {FW_WORLD_NO_HOLES, 0, true}};
    FwBurnableMeshId ids[4] = {};
    for (int i = 0; i < 4; ++i) {
        ASSERT_EQ(FW_OK, fwWorld_SetFlags(w.world, cases[i].world)) << lastMessage(w.world);
        def.flags = FW_BURNABLE_TWO_SIDED | cases[i].object;
        def.pinCount = cases[i].object & FW_BURNABLE_SHELL ? 1u : 0u;
        def.transform[12] = float(i) * 0.25f + 0.025f;
        ASSERT_EQ(FW_OK, fwWorld_CreateBurnableMesh(w.world, &def, &ids[i]))
            << lastMessage(w.world);
    }
    ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 0.1f));
    const std::vector<Color> fresh = w.look();
    for (int i = 0; i < 4; ++i) {
        FwIgnitionDef match = fwDefaultIgnitionDef();
        match.object = ids[i];
        match.position[0] = float(i) * 0.25f + 0.125f;
        match.position[2] = 0.25f;
        match.radius = 0.05f;
        uint32_t texels = 0;
        ASSERT_EQ(FW_OK, fwWorld_Ignite(w.world, &match, &texels));
        EXPECT_LT(0u, texels);
    }
    for (int k = 0; k < 60; ++k) ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 0.25f));
    const std::vector<Color> burnt = w.look();
    const auto there = [](const Color& c) { return c.r + c.g + c.b > 3; };
    FwObjectState first{};
    for (int i = 0; i < 4; ++i) {
        int changed = 0;
        for (int y = 0; y < 32; ++y)
            for (int x = i * 16; x < i * 16 + 16; ++x) {
                const size_t p = size_t(y * 64 + x);
                changed += std::abs(fresh[p].r - burnt[p].r) > 12 ? 1 : 0;
            }
        if (cases[i].harmed) {
            EXPECT_GT(changed, 12 * 32 / 2) << i;
        } else {
            EXPECT_EQ(0, changed) << i;
        }
        const FwObjectState state = getState(fwWorld_GetObjectState, w.world, ids[i]);
        if (i == 0) first = state;
        EXPECT_EQ(first.ignited, state.ignited) << "the fire is the same";
        EXPECT_LT(300u, state.ignited);
        const int before = count(fresh, i * 16, i * 16 + 16, there);
        const int after = count(burnt, i * 16, i * 16 + 16, there);
        if (i == 3) {
            EXPECT_EQ(before, after);
        }
        if (i == 0) {
            EXPECT_LT(after, before / 4);
        }
    }
}

TEST(SkinnedMesh, DoesNotChangeTheBurn) {
    uint64_t hashes[2] = {};
    for (const bool skinned : {false, true}) {
        host::SheetWorld w(host::evenMaterial(0.05f, 10), 1.0f, 0.5f, 64);
        FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
        def.mesh = w.mesh;
        def.materials[0] = w.materialId;
        def.flags = skinned ? FW_BURNABLE_SKINNED : 0;
        ASSERT_EQ(FW_OK, fwWorld_CreateBurnableMesh(w.world, &def, &w.object));
        EXPECT_GT(w.ball(FW_IGNITE, 0.3f, 0, 0.25f, 0.05f), 10u);
        std::vector<float> places = w.sheet.positions;
        for (int i = 0; i < 40; ++i) {
            if (skinned) {
                for (size_t k = 1; k < places.size(); k += 3) places[k] += 0.05f;
                ASSERT_EQ(FW_OK, fwWorld_SetVertexPositions(w.world, w.object, places.data(),
                                                            nullptr, uint32_t(places.size() / 3)))
                    << lastMessage(w.world);
            }
            w.run(0.125);
        }
        hashes[skinned] = w.hash();
        if (!skinned) continue;
        // Queries use the skinned pose, two metres up.
        const FwPointState point = w.point(0.3f, 2.0f, 0.25f);
        EXPECT_EQ(uint32_t(FW_POINT_BURNING), point.kind);
        EXPECT_NEAR(2.0f, point.position[1], 1e-3f);
        EXPECT_LT(point.distance, 0.02f);
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    host::SheetWorld plain(host::evenMaterial(0.05f, 10));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT,
              fwWorld_SetVertexPositions(plain.world, plain.object, plain.sheet.positions.data(),
                                         nullptr, 4));
    EXPECT_NE(std::string::npos, lastMessage(plain.world).find("without FW_BURNABLE_SKINNED"));
}

// Objects of one mesh share its buffers: each further object costs only its own, all the same
// amount.
TEST(DrawnMesh, ObjectsOfAMeshShareItsBuffers) {
    DRAWN_WORLD_OR_SKIP(w);
    const host::Sheet sheet(1.0f, 0.5f, 4);
    const FwMeshDef mesh = sheet.def(64);
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    ASSERT_EQ(FW_OK, fwWorld_CreateMesh(w.world, &mesh, &def.mesh)) << lastMessage(w.world);
    for (FwMaterialId& id : def.materials) id = w.material(FW_MATERIAL_PINE);
    const auto report = [&] {
        std::vector<FwMemoryRow> rows(128);
        rows.resize(fwContext_GetMemoryReport(w.context, rows.data(), uint32_t(rows.size())));
        std::map<std::string, uint64_t> out;
        for (const FwMemoryRow& row : rows) out[row.name] = row.bytes;
        return out;
    };
    const auto add = [&](int objects) {
        for (int i = 0; i < objects; ++i) {
            (void)created(fwWorld_CreateBurnableMesh, w.world, def);
            def.transform[13] += 1;
        }
    };
    add(1);
    const auto one = report();
    add(8);
    const auto nine = report();
    const FwMeshInfo info = getState(fwWorld_GetMeshInfo, w.world, def.mesh);
    const uint64_t texels = uint64_t(info.mapWidth) * info.mapHeight;
    for (const char* shared :
         {"texels", "normals", "tiles", "slowness", "links", "dependents", "vertices", "indices"}) {
        ASSERT_TRUE(one.count(shared)) << shared;
        EXPECT_EQ(one.at(shared), nine.at(shared)) << shared;
    }
    EXPECT_EQ(8 * texels, one.at("texels"));
    for (const char* own : {"state", "gradient"}) {
        ASSERT_TRUE(one.count(own)) << own;
        EXPECT_EQ(4 * texels, one.at(own)) << own;
        EXPECT_EQ(9 * one.at(own), nine.at(own)) << own;
    }
}

}  // namespace
