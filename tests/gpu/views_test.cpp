// Frames recorded for several views: each view is drawn as if it were the only one, with a scene of
// everything that has state per view.
#include "support/views.h"
#include "flamewright/flamewright_vulkan.h"
#include "support/burnable.h"
#include "support/meshes.h"
#include "support/vulkan_device.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

namespace fw::test::views_test {
namespace {

using testing::HasSubstr;

constexpr uint32_t kWidth = 128, kHeight = 96;
constexpr uint32_t kWarmUp = 40;  // frames

using Pixels = std::vector<uint8_t>;  // RGBA8

// The camera of view `which` in frame `f`, moving around the fires.
FwView cameraOf(uint32_t which, uint32_t f) {
    const float turn = 0.01f * float(f) + (which == 1 ? 0.5f : which == 2 ? -0.6f : 0.0f);
    const float away = which == 1 ? 4.2f : 3.4f;
    FwView view = viewAt({away * std::sin(turn), 1.1f + 0.003f * float(f), away * std::cos(turn)},
                         {0, 0.55f, 0}, float(kWidth) / float(kHeight), 2.4f);
    view.time = float(f) / 32.0f;
    view.viewId = 7 + which;  // arbitrary numbers
    return view;
}

uint32_t mostAway(const Pixels& a, const Pixels& b) {
    uint32_t most = 0;
    for (size_t i = 0; i < a.size(); ++i)
        most = std::max(most, uint32_t(std::abs(int(a[i]) - int(b[i]))));
    return most;
}

double rms(const Pixels& a, const Pixels& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += std::pow(double(a[i]) - double(b[i]), 2);
    return std::sqrt(sum / double(a.size()));
}

uint32_t litOf(const Pixels& picture) {
    uint32_t count = 0;
    for (size_t i = 0; i < picture.size(); i += 4) count += picture[i] > 60 ? 1 : 0;
    return count;
}

class Views : public GpuTest {
 protected:
    struct Picture {  // what a view is drawn into
        TestImage color, depth;
        TestBuffer read;
        [[nodiscard]] Pixels pixels() const {
            const auto* bytes = static_cast<const uint8_t*>(read.mapped);
            return {bytes, bytes + kWidth * kHeight * 4};
        }
    };

    void SetUp() override {
        GpuTest::SetUp();
        if (!device_) return;
        FwVulkanHost host = device_->host();
        host.getInstanceProcAddr = countingEntry();
        FwContextDef def = fwDefaultContextDef();
        def.vulkan = &host;
        def.callbacks.userData = &allocations_;
        def.callbacks.allocate = [](void* count, size_t size, size_t alignment) {
            ++*static_cast<uint64_t*>(count);
            return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
        };
        def.callbacks.release = [](void*, void* memory, size_t, size_t) { std::free(memory); };
        FwErrorInfo error{};
        ASSERT_EQ(fwCreateContext(&def, &context_, &error), FW_OK) << error.message;
        ASSERT_EQ(fwContext_Prepare(context_), FW_OK);
        frames_ = std::make_unique<HostFrames>(*device_, 2);
    }

    void TearDown() override {
        if (device_) vkDeviceWaitIdle(device_->device);
        fwDestroyContext(context_);
        frames_.reset();
        GpuTest::TearDown();
    }

    // Volumetric fires near and far, one with smoke; a jet that throws sparks; a burning mesh.
    // `fireAlone`: a single volumetric fire with much smoke.
    FwWorld* makeWorld(bool fireAlone = false) {
        FwWorldDef def = fwDefaultWorldDef();
        def.wind[0] = 0.6f;
        FwWorld* world = nullptr;
        EXPECT_EQ(fwCreateWorld(context_, &def, &world), FW_OK);
        const auto fire = [&](uint32_t preset, uint32_t tier, float x, float z) {
            FwVolumetricFireDef one = fwDefaultVolumetricFireDef();
            EXPECT_EQ(fwInitFirePreset(&one, preset), FW_OK);
            one.tier = tier;
            if (fireAlone) one.smoke = 8;
            one.position[0] = x;
            one.position[2] = z;
            FwVolumetricFireId id{};
            EXPECT_EQ(fwWorld_CreateVolumetricFire(world, &one, &id), FW_OK);
        };
        fire(FW_FIRE_CAMP, FW_FIRE_TIER_AUTO, -0.7f, 0.2f);
        if (fireAlone) return world;
        fire(FW_FIRE_TORCH, FW_FIRE_TIER_AUTO, 0.2f, 0.7f);
        fire(FW_FIRE_CAMP, FW_FIRE_TIER_IMPOSTOR, -0.2f, -1.2f);
        FwFireEmitterDef jet = fwDefaultFireEmitterDef();
        jet.position[0] = 0.8f;
        jet.power = 40;
        jet.sparks = 0.5f;
        FwFireEmitterId emitter{};
        EXPECT_EQ(fwWorld_CreateFireEmitter(world, &jet, &emitter), FW_OK);
        const Mesh ball = makeCube(0.6, 6, true, false);
        FwMeshDef mesh = fwDefaultMeshDef();
        mesh.positions = ball.positions.data();
        mesh.indices = ball.indices.data();
        mesh.vertexCount = ball.vertexCount();
        mesh.indexCount = uint32_t(ball.indices.size());
        mesh.texelsPerMetre = 48;
        FwBurnableMeshDef object = fwDefaultBurnableMeshDef();
        object.transform[13] = 0.6f;
        (void)addBurnable(world, mesh, FW_MATERIAL_PAPER, object);
        FwIgnitionDef match = fwDefaultIgnitionDef();
        match.position[1] = 0.6f;
        match.position[2] = 0.4f;
        match.radius = 0.25f;
        EXPECT_EQ(fwWorld_Ignite(world, &match, nullptr), FW_OK);
        return world;
    }

    Picture makePicture() {
        Picture picture;
        picture.color = device_->makeImage(VK_FORMAT_R8G8B8A8_UNORM, {kWidth, kHeight}, 1,
                                           VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                               VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                               VK_IMAGE_USAGE_TRANSFER_DST_BIT);
        picture.depth =
            device_->makeImage(VK_FORMAT_D32_SFLOAT, {kWidth, kHeight}, 1,
                               VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                   VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
        picture.read = device_->makeBuffer(kWidth * kHeight * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
        return picture;
    }

    FwTargetId targetOf(uint32_t flags, FwDepthMode depthMode) {
        FwVulkanTargetDef def = fwDefaultVulkanTargetDef();
        def.flags = FW_TARGET_COMPOSITE | FW_TARGET_AS_NEEDED | flags;
        def.colorFormat = VK_FORMAT_R8G8B8A8_UNORM;
        def.depthFormat = VK_FORMAT_D32_SFLOAT;
        def.depthMode = depthMode;
        FwTargetId target{};
        EXPECT_EQ(fwContext_RegisterTarget(context_, &def, &target), FW_OK);
        return target;
    }

    // Draws `view` of the world over black and copies the picture to memory.
    static void draw(FwWorld* world, const FwVulkanFrame& frame, FwTargetId target,
                     const FwView& view, const Picture& picture) {
        const VkCommandBuffer commands = frame.commandBuffer;
        VkImageMemoryBarrier barriers[2]{};
        for (uint32_t i = 0; i < 2; ++i) {
            barriers[i].sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
            barriers[i].dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
            barriers[i].newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
            barriers[i].srcQueueFamilyIndex = barriers[i].dstQueueFamilyIndex =
                VK_QUEUE_FAMILY_IGNORED;
            barriers[i].image = i ? picture.depth.image : picture.color.image;
            barriers[i].subresourceRange = {
                VkImageAspectFlags(i ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT), 0, 1,
                0, 1};
        }
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                             VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr, 2,
                             barriers);
        const VkClearColorValue black{};
        const VkClearDepthStencilValue far{1, 0};
        vkCmdClearColorImage(commands, picture.color.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                             &black, 1, &barriers[0].subresourceRange);
        vkCmdClearDepthStencilImage(commands, picture.depth.image,
                                    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &far, 1,
                                    &barriers[1].subresourceRange);
        FwVulkanComposite images = fwDefaultVulkanComposite();
        images.flags = FW_COMPOSITE_KEEP;
        images.width = kWidth;
        images.height = kHeight;
        for (FwVulkanImage* image : {&images.color, &images.depth}) {
            image->layoutBefore = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
            image->layoutAfter = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
            image->stageBefore = image->stageAfter = VK_PIPELINE_STAGE_TRANSFER_BIT;
            image->accessBefore = VK_ACCESS_TRANSFER_WRITE_BIT;
            image->accessAfter = VK_ACCESS_TRANSFER_READ_BIT;
        }
        images.depth.layoutAfter = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        images.depth.accessAfter = VK_ACCESS_TRANSFER_WRITE_BIT;
        images.color.image = picture.color.image;
        images.color.view = picture.color.view;
        images.depth.image = picture.depth.image;
        images.depth.view = picture.depth.view;
        EXPECT_EQ(fwWorld_RecordComposite(world, &frame, target, &view, &images), FW_OK)
            << message(world);
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {kWidth, kHeight, 1};
        vkCmdCopyImageToBuffer(commands, picture.color.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                               picture.read.buffer, 1, &region);
        VkMemoryBarrier toHost{};
        toHost.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
        toHost.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        // The same memory may hold another picture next.
        toHost.dstAccessMask = VK_ACCESS_HOST_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                             VK_PIPELINE_STAGE_HOST_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 1,
                             &toHost, 0, nullptr, 0, nullptr);
    }

    static std::string message(FwWorld* world) {
        char text[512] = {};
        fwWorld_GetLastMessage(world, text, sizeof text);
        return text;
    }

    // Bytes of all buffers of view `number` of a frame, from 1.
    [[nodiscard]] uint64_t bytesOfView(uint32_t number) const {
        std::vector<FwMemoryRow> rows(256);
        rows.resize(std::min<size_t>(
            fwContext_GetMemoryReport(context_, rows.data(), uint32_t(rows.size())), rows.size()));
        uint64_t bytes = 0;
        for (const FwMemoryRow& row : rows) {
            const std::string name = row.name;
            const std::string end = ", view " + std::to_string(number);
            if (name.size() > end.size() && name.substr(name.size() - end.size()) == end)
                bytes += row.capacity;
        }
        return bytes;
    }

    uint64_t allocations_ = 0;
    FwContext* context_ = nullptr;
    std::unique_ptr<HostFrames> frames_;
};

TEST_F(Views, TwoViewsInOneRecordingEqualTwoWorlds) {
    if (!device_) return;
    const struct {
        const char* name;
        uint32_t flags;
        FwDepthMode depth;
    } kinds[] = {
        {"tested depth", 0, FW_DEPTH_TEST},
        {"half resolution", FW_TARGET_NO_SURFACES | FW_TARGET_HALF_EFFECTS, FW_DEPTH_SAMPLED}};
    for (const auto& kind : kinds) {
        const FwTargetId target = targetOf(kind.flags, kind.depth);
        FwWorld* const alone[2] = {makeWorld(), makeWorld()};
        FwWorld* const both = makeWorld();
        const Picture single[2] = {makePicture(), makePicture()};
        const Picture shared[2] = {makePicture(), makePicture()};
        uint32_t worst = 0, unlike = 0;
        for (uint32_t f = 0; f < kWarmUp + 6; ++f) {
            const FwView views[2] = {cameraOf(0, f), cameraOf(1, f)};
            const FwVulkanFrame frame = frames_->begin(1.0f / 32);
            for (uint32_t i = 0; i < 2; ++i)
                ASSERT_EQ(fwWorld_RecordOutside(alone[i], &frame, &views[i]), FW_OK);
            ASSERT_EQ(fwWorld_RecordOutsideViews(both, &frame, views, 2), FW_OK) << message(both);
            for (uint32_t i = 0; i < 2; ++i) {
                draw(alone[i], frame, target, views[i], single[i]);
                draw(both, frame, target, views[i], shared[i]);
            }
            frames_->submit();
            frames_->waitAll();
            if (f < kWarmUp) continue;
            for (uint32_t i = 0; i < 2; ++i)
                worst = std::max(worst, mostAway(single[i].pixels(), shared[i].pixels()));
            unlike = std::max(unlike, mostAway(single[0].pixels(), single[1].pixels()));
        }
        std::printf("           %s: at most %u of 255 off; the two are %u apart\n", kind.name,
                    worst, unlike);
        EXPECT_LE(worst, 2u) << kind.name;
        EXPECT_GT(unlike, 60u) << "the two views must differ";
        EXPECT_GT(litOf(single[0].pixels()), 200u) << "something burns";
        for (FwWorld* world : {alone[0], alone[1], both}) fwDestroyWorld(world);
        EXPECT_EQ(fwContext_UnregisterTarget(context_, target), FW_OK);
    }
}

// With two views and a late third one: once each was drawn, frames allocate nothing on device or
// heap.
TEST_F(Views, WarmViewsAllocateNothing) {
    if (!device_) return;
    FwWorld* const world = makeWorld();
    const FwTargetId target = targetOf(0, FW_DEPTH_TEST);
    const Picture picture = makePicture();
    const auto frame = [&](uint32_t f, uint32_t count) {
        const FwView views[4] = {cameraOf(0, f), cameraOf(1, f), cameraOf(2, f), cameraOf(3, f)};
        const FwVulkanFrame begun = frames_->begin(1.0f / 32);
        ASSERT_EQ(fwWorld_RecordOutsideViews(world, &begun, views, count), FW_OK) << message(world);
        for (uint32_t i = 0; i < count; ++i) draw(world, begun, target, views[i], picture);
        frames_->submit();
    };
    for (uint32_t f = 0; f < 48; ++f) frame(f, f % 3 == 0 ? 2 : 4);
    (void)takeCounts();
    const uint64_t before = allocations_;
    for (uint32_t f = 48; f < 96; ++f) frame(f, f % 3 == 0 ? 2 : 4);
    EXPECT_EQ(takeCounts().total(), 0u);
    EXPECT_EQ(allocations_, before);
    for (const uint32_t number : {2u, 3u, 4u}) EXPECT_GT(bytesOfView(number), 100000u) << number;
    EXPECT_EQ(bytesOfView(5), 0u);
    vkDeviceWaitIdle(device_->device);
    fwDestroyWorld(world);
}

// A removed view is drawn like one that was never given, frees its memory, and is as before when it
// returns.
TEST_F(Views, MayBeAddedAndRemoved) {
    if (!device_) return;
    FwWorld* const world = makeWorld();
    FwWorld* const alone = makeWorld();
    const FwTargetId target = targetOf(0, FW_DEPTH_TEST);
    const Picture first = makePicture(), second = makePicture(), third = makePicture();
    uint32_t f = 0;
    const auto frame = [&](uint32_t count, bool draws, const FwView* stale = nullptr) {
        const FwView views[2] = {cameraOf(0, f), cameraOf(1, f)};
        const FwVulkanFrame begun = frames_->begin(1.0f / 32);
        ASSERT_EQ(fwWorld_RecordOutsideViews(world, &begun, views, count), FW_OK) << message(world);
        ASSERT_EQ(fwWorld_RecordOutside(alone, &begun, &views[1]), FW_OK);
        if (draws) {
            draw(world, begun, target, views[0], first);
            draw(world, begun, target, stale ? stale[0] : views[1], second);
            draw(stale ? world : alone, begun, target, stale ? stale[1] : views[1], third);
        }
        frames_->submit();
        frames_->waitAll();
        ++f;
    };
    for (int i = 0; i < 24; ++i) frame(2, i >= 16);
    EXPECT_LE(mostAway(second.pixels(), third.pixels()), 2u);
    const uint64_t held = bytesOfView(2);
    EXPECT_GT(held, 100000u);
    // Its id stays known for a while but does not affect frames without it.
    for (int i = 0; i < 8; ++i) {
        FwView stale[2] = {cameraOf(1, f), cameraOf(1, f)};
        stale[1].viewId = 4711;
        frame(1, i >= 6, stale);
    }
    EXPECT_EQ(mostAway(second.pixels(), third.pixels()), 0u) << "a stale id equals an unknown id";
    EXPECT_GT(bytesOfView(2), 0u) << "it may come again";
    for (int i = 0; i < 64; ++i) frame(1, false);
    EXPECT_EQ(bytesOfView(2), 0u) << "it was absent for long";
    for (int i = 0; i < 24; ++i) frame(2, i >= 16);
    EXPECT_GT(bytesOfView(2), held / 2);
    EXPECT_LE(mostAway(second.pixels(), third.pixels()), 2u) << "it is as before";
    // More ids than capacity, one after another: the oldest is dropped.
    for (uint32_t id = 100; id < 116; ++id) {
        FwView views[2] = {cameraOf(0, f), cameraOf(1, f)};
        views[1].viewId = id;
        const FwVulkanFrame begun = frames_->begin(1.0f / 32);
        ASSERT_EQ(fwWorld_RecordOutsideViews(world, &begun, views, 2), FW_OK) << message(world);
        draw(world, begun, target, views[1], second);
        frames_->submit();
        ++f;
    }
    frames_->waitAll();
    EXPECT_GT(litOf(second.pixels()), 100u);
    for (FwWorld* one : {world, alone}) fwDestroyWorld(one);
}

// Each error names its cause and leaves the world unchanged.
TEST_F(Views, RefuseInvalidValues) {
    if (!device_) return;
    FwWorldDef def = fwDefaultWorldDef();
    FwWorld* world = nullptr;
    ASSERT_EQ(fwCreateWorld(context_, &def, &world), FW_OK);
    FwView views[FW_MAX_VIEWS + 1];
    for (uint32_t i = 0; i < FW_MAX_VIEWS + 1; ++i) views[i] = cameraOf(i, 0);
    const FwVulkanFrame frame = frames_->begin();
    const auto refuses = [&](const FwView* given, uint32_t count, const char* text) {
        EXPECT_EQ(fwWorld_RecordOutsideViews(world, &frame, given, count),
                  FW_ERROR_INVALID_ARGUMENT)
            << text;
        EXPECT_THAT(message(world), HasSubstr(text));
    };
    refuses(nullptr, 1, "views");
    refuses(views, 0, "viewCount is 0; the limits are [1, 4].");
    refuses(views, FW_MAX_VIEWS + 1, "viewCount is 5; the limits are [1, 4].");
    const auto with = [&](const auto& change, const char* text) {
        FwView changed[3] = {views[0], views[1], views[2]};
        change(changed[2]);
        refuses(changed, 3, text);
    };
    with([](FwView& view) { view.viewId = 8; },
         "views[1].viewId and views[2].viewId are both 8; give each view of a frame its own "
         "number.");
    with([](FwView& view) { view.projection[5] = NAN; }, "views[2].projection[5] is nan");
    with([](FwView& view) { view.structSize = uint32_t(sizeof(FwView)) - 4; },
         "views[2].structSize is");
    // An older host's views are shorter and lie closer together.
    constexpr size_t kShort = offsetof(FwView, viewId);
    std::vector<std::byte> old(2 * kShort);
    for (uint32_t i = 0; i < 2; ++i) {
        views[i].structSize = uint32_t(kShort);
        std::memcpy(old.data() + i * kShort, &views[i], kShort);
    }
    refuses(reinterpret_cast<const FwView*>(old.data()), 2, "are both 0");
    EXPECT_EQ(
        fwWorld_RecordOutsideViews(world, &frame, reinterpret_cast<const FwView*>(old.data()), 1),
        FW_OK)
        << message(world);
    frames_->submit();
    frames_->waitAll();
    fwDestroyWorld(world);
}

// A view that was not recorded is marched while it is drawn: almost the same picture, without a
// pixel pattern in its smoke.
TEST_F(Views, AnUnrecordedViewLooksTheSame) {
    if (!device_) return;
    // Distance of pixels of the upper half, which holds only smoke, from the mean of their
    // neighbours.
    const auto grain = [](const Pixels& picture) {
        const auto at = [&](uint32_t i, uint32_t j) {
            return double(picture[(j * kWidth + i) * 4]);
        };
        double sum = 0;
        for (uint32_t y = 1; y < kHeight / 2; ++y)
            for (uint32_t x = 1; x + 1 < kWidth; ++x)
                sum += std::pow(
                    at(x, y) - (at(x - 1, y) + at(x + 1, y) + at(x, y - 1) + at(x, y + 1)) / 4, 2);
        return std::sqrt(sum / double((kHeight / 2 - 1) * (kWidth - 2)));
    };
    FwView view =
        viewAt({-0.4f, 1.0f, 2.2f}, {-0.7f, 0.9f, 0.2f}, float(kWidth) / float(kHeight), 2.4f);
    view.time = 1;
    FwView other = view;
    other.viewId = 3;
    other.ambientSky[0] += 1e-6f;  // otherwise it would reuse the same march
    for (const FwDepthMode depth : {FW_DEPTH_TEST, FW_DEPTH_SAMPLED}) {
        FwWorld* const world = makeWorld(true);
        const FwTargetId target = targetOf(FW_TARGET_NO_SURFACES, depth);
        const Picture marched = makePicture(), direct = makePicture();
        for (uint32_t f = 0; f < kWarmUp; ++f) {
            const FwVulkanFrame frame = frames_->begin(1.0f / 32);
            ASSERT_EQ(fwWorld_RecordOutside(world, &frame, &view), FW_OK);
            if (f + 2 >= kWarmUp) {
                draw(world, frame, target, view, marched);
                draw(world, frame, target, other, direct);
            }
            frames_->submit();
        }
        frames_->waitAll();
        const double off = rms(marched.pixels(), direct.pixels());
        const double wanted = grain(marched.pixels()), grainy = grain(direct.pixels());
        std::printf("           depth mode %u: RMS %.2f of 255; grain %.2f, marched before %.2f\n",
                    uint32_t(depth), off, grainy, wanted);
        EXPECT_LT(grainy, 4 * wanted) << "depth mode " << depth;
        // With a tested depth, slabs are tone mapped one by one.
        EXPECT_LT(off, depth == FW_DEPTH_TEST ? 12 : 10) << "depth mode " << depth;
        vkDeviceWaitIdle(device_->device);
        fwDestroyWorld(world);
        EXPECT_EQ(fwContext_UnregisterTarget(context_, target), FW_OK);
    }
}

}  // namespace
}  // namespace fw::test::views_test
