// Loses the library's own device at one Vulkan call after another. The host hears of it once,
// everything is freed, and the fire continues bit by bit from the last mirror.
// FLAMEWRIGHT_LOSE_EVERY=1 in the environment tests every call.
#include "support/loss_scene.h"
#include "support/paths.h"
#include "support/sanitized.h"
#include "support/views.h"

#include <dlfcn.h>

#include <cstdio>

namespace fw::test::device_loss_test {
namespace {

using namespace host;

// Replaces the Vulkan loader before its first use: dlopen finds by name the library that is already
// loaded.
const struct Loader {
    LosingVulkan* vulkan = nullptr;
    void (*drop)() = nullptr;
    Loader() {
        void* library = dlopen(kLosingLoader, RTLD_NOW | RTLD_LOCAL);
        auto* give = library ? reinterpret_cast<LosingVulkan* (*)()>(dlsym(library, "losingVulkan"))
                             : nullptr;
        if (give) vulkan = give();
        drop = library ? reinterpret_cast<void (*)()>(dlsym(library, "losingDrop")) : nullptr;
    }
} loader;

FwResult takePicture(FwWorld* world) {
    static std::vector<unsigned char> pixels(64 * 36 * 4);
    FwOffscreenDef shot = fwDefaultOffscreenDef();
    shot.width = 64, shot.height = 36;
    shot.pixels = pixels.data();
    shot.view = viewAt({0.4f, 0.6f, 1.5f}, {0.4f, 0.1f, 0.1f}, 64.0f / 36);
    return fwWorld_RenderOffscreen(world, &shot);
}

// One run of a context until a Vulkan call fails.
struct Life {
    Host host;
    LossScene scene;
    FwContext* context = nullptr;
    FwResult result = FW_OK;
    bool made = false;   // the context exists
    int64_t frames = 0;  // Vulkan calls before the first frame

    Life() {
        scene.picture = takePicture;
        scene.calls = [] { return loader.vulkan->calls.load(); };
        FwContextDef def = fwDefaultContextDef();
        def.callbacks = host.callbacks();
        FwErrorInfo error{};
        result = fwCreateContext(&def, &context, &error);
        made = result == FW_OK;
        if (result == FW_OK) result = fwContext_Prepare(context);
        if (result == FW_OK) result = scene.make(context);
        frames = loader.vulkan->calls;
        if (result == FW_OK) result = scene.play();
    }
    Life(const Life&) = delete;
    Life& operator=(const Life&) = delete;
    ~Life() {
        fwDestroyContext(context);
        EXPECT_EQ(0, host.blocks);
        EXPECT_EQ(0, loader.vulkan->live) << "objects of the device leak";
    }
};

// Calls between two losses; a sanitized run takes four times as long.
constexpr int64_t kApart = fw::test::rounds(40, 80);

TEST(DeviceLoss, IsSurvivedAtEveryCallOfAnOwnDevice) {
    if (!*kLosingLoader) GTEST_SKIP() << "there is no libvulkan.so.1";
    ASSERT_TRUE(loader.vulkan && loader.vulkan->real) << "no loader between";
    LosingVulkan& vulkan = *loader.vulkan;
    LossReference reference;
    int64_t calls = 0, frames = 0;
    std::vector<int64_t> mirroredAt;
    vulkan.begin(-1);
    {
        Life whole;
        if (!whole.made) GTEST_SKIP() << "no Vulkan device";
        ASSERT_EQ(FW_OK, whole.result) << whole.host.lastError;
        calls = vulkan.calls;
        frames = whole.frames;
        mirroredAt = whole.scene.mirroredAt;
        ASSERT_GT(calls, 400) << "the library does not call through the table";
        ASSERT_EQ(reference.saves.rbegin()->second, whole.scene.mirror);
        EXPECT_EQ(reference.end, whole.scene.save());
    }
    const std::vector<int64_t> losses =
        chooseLosses(vulkan, frames, calls, mirroredAt, kApart, true);
    std::map<uint32_t, uint32_t> mirrors;  // mirrors by frame
    std::vector<Bytes> recovered;
    for (const int64_t call : losses) {
        SCOPED_TRACE("lost at call " + std::to_string(call) + ", " + vulkan.nameOf(call));
        vulkan.begin(call);
        Bytes mirror;
        uint32_t frame = 0;
        {
            Life life;
            ASSERT_TRUE(vulkan.lost) << "the call did not come";
            EXPECT_TRUE(host::reportsLoss(life.result, vulkan.nameOf(call)))
                << fwResultName(life.result) << ": " << life.host.lastError;
            if (life.scene.world) {  // the device stays lost, and the world returns what it has
                EXPECT_EQ(FW_ERROR_DEVICE_LOST, fwWorld_Step(life.scene.world, 0.1f));
                EXPECT_EQ(FW_ERROR_DEVICE_LOST, takePicture(life.scene.world));
                EXPECT_EQ(FW_OK, life.scene.completeSave()) << host::lastMessage(life.scene.world);
            }
            mirror = life.scene.mirror;
            frame = life.scene.mirrored;
        }
        vulkan.begin(-1);
        ++mirrors[frame];
        if (frame == 0) continue;
        EXPECT_EQ(reference.saves[frame], mirror) << "the mirror of frame " << frame;
        if (std::find(recovered.begin(), recovered.end(), mirror) != recovered.end()) continue;
        recovered.push_back(mirror);
        for (const uint32_t backend : {FW_BACKEND_CPU, FW_BACKEND_VULKAN}) {
            Host host;
            FwContextDef def = fwDefaultContextDef();
            def.backend = backend;
            def.callbacks = host.callbacks();
            FwContext* context = nullptr;
            FwErrorInfo error{};
            ASSERT_EQ(FW_OK, fwCreateContext(&def, &context, &error)) << error.message;
            LossScene scene;
            reference.expectRecovers(context, scene, mirror, frame);
            fwDestroyContext(context);
            EXPECT_EQ(0, host.blocks);
        }
    }
    host::printLosses(losses.size(), calls, mirrors);
    EXPECT_EQ(std::size(LossScene::kSaves), recovered.size());
    loader.drop();
}

}  // namespace
}  // namespace fw::test::device_loss_test
