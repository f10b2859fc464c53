// What a host sees of its objects, on a device of the library's own: pictures by material slot,
// both sides of open meshes, and what objects of one mesh share. Skips aloud without a device.
#include "abi/abi_support.h"

#include <cstdlib>
#include <map>

namespace {

using host::Host;
using host::lastMessage;

struct Color {
    int r, g, b;
};

// A world on a device of its own; none where there is no Vulkan.
struct DrawnWorld {
    Host host;
    FwContext* context = nullptr;
    FwWorld* world = nullptr;

    explicit DrawnWorld(const FwWorldDef& worldDef = fwDefaultWorldDef()) {
        FwContextDef def = fwDefaultContextDef();
        def.callbacks = host.callbacks();
        FwErrorInfo error{};
        if (fwCreateContext(&def, &context, &error) != FW_OK) {
            EXPECT_EQ(FW_ERROR_UNSUPPORTED_DEVICE, error.result) << error.message;
            if (std::getenv("FLAMEWRIGHT_REQUIRE_GPU")) ADD_FAILURE() << error.message;
            return;
        }
        EXPECT_EQ(FW_OK, fwCreateWorld(context, &worldDef, &world)) << lastMessage(context);
    }
    DrawnWorld(const DrawnWorld&) = delete;
    DrawnWorld& operator=(const DrawnWorld&) = delete;
    ~DrawnWorld() {
        fwDestroyContext(context);
        EXPECT_EQ(0, host.blocks);
    }

    FwMaterialId material(uint32_t preset) {
        FwMaterialDef def = fwDefaultMaterialDef();
        EXPECT_EQ(FW_OK, fwInitMaterialPreset(&def, preset));
        FwMaterialId id{};
        EXPECT_EQ(FW_OK, fwWorld_CreateMaterial(world, &def, &id));
        return id;
    }
    FwImageId image(uint32_t pixel) {
        const uint32_t pixels[4] = {pixel, pixel, pixel, pixel};
        FwImageDef def = fwDefaultImageDef();
        def.width = def.height = 2;
        def.pixels = pixels;
        FwImageId id{};
        EXPECT_EQ(FW_OK, fwWorld_CreateImage(world, &def, &id)) << lastMessage(world);
        return id;
    }
    // 64 x 32 pixels straight down on a sheet of 1 x 0.5 m, or up at it from below.
    std::vector<Color> look(bool below = false) {
        FwOffscreenDef def = fwDefaultOffscreenDef();
        def.width = 64;
        def.height = 32;
        FwView& view = def.view;
        // Object x to the right; z down the picture from above, up it from below.
        const float side = below ? -1.0f : 1.0f;
        const float placed[16] = {1,
                                  0,
                                  0,
                                  0,
                                  0,
                                  0,
                                  side,
                                  0,
                                  0,
                                  -side,
                                  0,
                                  0,
                                  -0.5f,
                                  side * 0.25f,
                                  -side * (below ? -2.0f : 2.0f) * side,
                                  1};
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
bool blue(const Color& c) { return c.b > 2 * c.r && c.b > 2 * c.g && c.b > 60; }

TEST(AbiDrawn, EveryMaterialSlotHasItsPicture) {
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
    FwBurnableMeshId id{};
    ASSERT_EQ(FW_OK, fwWorld_CreateBurnableMesh(w.world, &def, &id)) << lastMessage(w.world);
    ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 0.1f));
    std::vector<Color> picture = w.look();
    EXPECT_EQ(15 * 32, count(picture, 0, 15, red));
    EXPECT_EQ(14 * 32, count(picture, 17, 31, blue)) << "baseColor where a slot has none";
    EXPECT_EQ(14 * 32, count(picture, 33, 47, green));
    EXPECT_EQ(15 * 32, count(picture, 49, 64, red));
    // A picture that goes leaves its slots to their material's own colour.
    ASSERT_EQ(FW_OK, fwWorld_DestroyImage(w.world, first));
    picture = w.look();
    EXPECT_EQ(0, count(picture, 0, 15, red));
    EXPECT_EQ(14 * 32, count(picture, 33, 47, green));
    // An id that is gone is refused and changes nothing.
    FwBurnableMeshId none{};
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_CreateBurnableMesh(w.world, &def, &none));
    EXPECT_EQ(FW_OK, fwWorld_DestroyBurnableMesh(w.world, id));
}

TEST(AbiDrawn, BothSidesOfAnOpenMeshBurnFromOneMap) {
    FwWorldDef worldDef = fwDefaultWorldDef();
    worldDef.paceFactor = 20;
    DRAWN_WORLD_OR_SKIP(w, worldDef);
    const host::Sheet sheet(1.0f, 0.5f, 4);
    const FwMeshDef mesh = sheet.def(64);
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    ASSERT_EQ(FW_OK, fwWorld_CreateMesh(w.world, &mesh, &def.mesh)) << lastMessage(w.world);
    def.flags = FW_BURNABLE_TWO_SIDED | FW_BURNABLE_NO_HOLES;
    for (FwMaterialId& id : def.materials) id = w.material(FW_MATERIAL_PINE);
    FwBurnableMeshId id{};
    ASSERT_EQ(FW_OK, fwWorld_CreateBurnableMesh(w.world, &def, &id)) << lastMessage(w.world);
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
    EXPECT_GT(sum(above), 5 * sum(below) / 4) << "the sun is above";
    FwIgnitionDef match = fwDefaultIgnitionDef();
    match.position[0] = match.position[2] = 0.25f;
    match.radius = 0.1f;
    ASSERT_EQ(FW_OK, fwWorld_Ignite(w.world, &match, nullptr));
    for (int i = 0; i < 30; ++i) ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 0.1f));
    // From below x runs as from above: the same half has burnt.
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
    EXPECT_GT(changed(under, below, 4, 28), 150) << "and its other side";
}

// What objects of one mesh share costs once: with more objects only their own planes grow, each by
// the same.
TEST(AbiDrawn, ObjectsOfAMeshShareItsPlanes) {
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
            FwBurnableMeshId id{};
            ASSERT_EQ(FW_OK, fwWorld_CreateBurnableMesh(w.world, &def, &id))
                << lastMessage(w.world);
            def.transform[13] += 1;
        }
    };
    add(1);
    const auto one = report();
    add(8);
    const auto nine = report();
    FwMeshInfo info{};
    info.structSize = sizeof info;
    ASSERT_EQ(FW_OK, fwWorld_GetMeshInfo(w.world, def.mesh, &info));
    const uint64_t texels = uint64_t(info.mapWidth) * info.mapHeight;
    for (const char* shared :
         {"texels", "normals", "tiles", "slowness", "links", "readers", "vertices", "indices"}) {
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
