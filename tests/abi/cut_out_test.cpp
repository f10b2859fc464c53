// Cut-outs: the alpha of a picture says where an object exists. Includes public headers only.
#include "abi/abi_support.h"

namespace {

using host::created;
using host::lastMessage;
using host::SheetWorld;

constexpr uint32_t kNeverLit = 0xfffffff0u;  // greater ticks: never lit

// 64 x 64 pixels; `there` takes a column.
template <class There>
FwImageId stripes(FwWorld* world, float alphaCutoff, There&& there) {
    std::vector<uint32_t> pixels;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) pixels.push_back(there(x) ? 0xFF0000FFu : 0x000000FFu);
    FwImageDef def = fwDefaultImageDef();
    EXPECT_EQ(0, def.alphaCutoff);
    def.width = def.height = 64;
    def.pixels = pixels.data();
    def.alphaCutoff = alphaCutoff;
    return created(fwWorld_CreateImage, world, def);
}

struct Burnt {
    int gone = 0, left = 0, right = 0;  // burnt texels in the gap, left and right of it
    int leftAll = 0, rightAll = 0;
    float fraction = 0;
};

// Lights a 1 m sheet at its left end. The picture has a gap from x = 0.4375 to 0.5625 m.
Burnt burn(float alphaCutoff) {
    SheetWorld w(host::evenMaterial(0.05f, 5));
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    def.mesh = w.mesh;
    def.materials[0] = w.materialId;
    def.flags = FW_BURNABLE_LITE | FW_BURNABLE_NO_SPREAD;
    def.baseColor = stripes(w.world, alphaCutoff, [](int x) { return x < 28 || x >= 36; });
    (void)fwWorld_DestroyBurnableMesh(w.world, w.object);
    EXPECT_EQ(FW_OK, fwWorld_CreateBurnableMesh(w.world, &def, &w.object)) << lastMessage(w.world);
    EXPECT_GT(w.ball(FW_IGNITE, 0.02f, 0, 0.1f, 0.05f), 0u);
    w.run(40);
    EXPECT_EQ(FW_OK, fwDebug_RequestBurnMap(w.world, w.object));
    uint64_t count = 0;
    EXPECT_EQ(FW_OK, fwDebug_FetchBurnMap(w.world, w.object, nullptr, 0, &count, nullptr, nullptr));
    std::vector<uint32_t> ticks(count), flags(count);
    std::vector<float> places(count * 3);
    EXPECT_EQ(FW_OK, fwDebug_FetchBurnMap(w.world, w.object, ticks.data(), count, nullptr, nullptr,
                                          nullptr));
    EXPECT_EQ(FW_OK, fwDebug_GetTexelPositions(w.world, w.mesh, places.data(), flags.data(), count,
                                               &count));
    Burnt result;
    for (size_t i = 0; i < count; ++i) {
        if (flags[i] == 0) continue;
        const float x = places[i * 3];
        const bool lit = ticks[i] < kNeverLit;
        if (x < 0.42f) result.left += lit, ++result.leftAll;
        if (x > 0.58f) result.right += lit, ++result.rightAll;
        if (x > 0.46f && x < 0.54f) result.gone += lit;
    }
    result.fraction = w.state().burntFraction;
    return result;
}

TEST(CutOut, FireStopsAtTransparentTexels) {
    const Burnt whole = burn(0);
    EXPECT_EQ(whole.leftAll, whole.left);
    EXPECT_EQ(whole.rightAll, whole.right);
    EXPECT_GT(whole.gone, 0);
    EXPECT_NEAR(1, whole.fraction, 1e-3);

    const Burnt cut = burn(0.5f);
    EXPECT_EQ(cut.leftAll, cut.left);
    EXPECT_EQ(0, cut.gone);
    EXPECT_EQ(0, cut.right);
    EXPECT_NEAR(0.5, cut.fraction, 0.02) << "half of the opaque area";
}

TEST(CutOut, IgnitingATransparentTexelLightsNothing) {
    SheetWorld w(host::evenMaterial(0.05f, 5));
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    def.mesh = w.mesh;
    def.materials[0] = w.materialId;
    def.baseColor = stripes(w.world, 0.5f, [](int x) { return x < 28 || x >= 36; });
    ASSERT_EQ(FW_OK, fwWorld_CreateBurnableMesh(w.world, &def, &w.object)) << lastMessage(w.world);
    FwIgnitionDef match = fwDefaultIgnitionDef();
    match.object = w.object;
    match.position[0] = 0.5f;
    match.position[2] = 0.1f;
    match.radius = 0.02f;
    uint32_t texels = 0;
    EXPECT_EQ(FW_NOTHING_THERE, fwWorld_Ignite(w.world, &match, &texels));
    EXPECT_GT(texels, 0u);
    EXPECT_NE(std::string::npos, lastMessage(w.world).find("cut out")) << lastMessage(w.world);
    match.position[0] = 0.3f;
    EXPECT_EQ(FW_OK, fwWorld_Ignite(w.world, &match, &texels)) << lastMessage(w.world);
}

TEST(CutOut, ATexelBurnsIfAnyPartOfItIsOpaque) {
    // Lines one pixel wide: each texel holds one of them.
    SheetWorld w(host::evenMaterial(0.05f, 5), 1.0f, 0.25f, 16);
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    def.mesh = w.mesh;
    def.materials[0] = w.materialId;
    def.baseColor = stripes(w.world, 0.5f, [](int x) { return x % 4 == 1; });
    ASSERT_EQ(FW_OK, fwWorld_CreateBurnableMesh(w.world, &def, &w.object)) << lastMessage(w.world);
    w.run(0.1);
    EXPECT_GT(w.ball(FW_IGNITE, 0.02f, 0, 0.1f, 0.05f), 0u);
    w.run(40);
    EXPECT_NEAR(1, w.state().burntFraction, 1e-3);
}

TEST(CutOut, RefusesACutoffOutOfRange) {
    SheetWorld w(host::evenMaterial(0.05f, 5));
    const uint32_t pixels[4] = {};
    FwImageDef def = fwDefaultImageDef();
    def.width = def.height = 2;
    def.pixels = pixels;
    def.alphaCutoff = 1.5f;
    FwImageId id{};
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateImage(w.world, &def, &id));
    EXPECT_NE(std::string::npos, lastMessage(w.world).find("FwImageDef::alphaCutoff is 1.5"));
}

}  // namespace
