// Pictures of burning things through the C ABI on a host's Vulkan 1.0 device without features,
// against the files beside this one. The simulation is exact; drawing may differ slightly between
// devices, hence the tolerances.
#include "golden/golden_image.h"
#include "support/burnable.h"
#include "support/host_context.h"
#include "support/meshes.h"

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <array>
#include <cstring>

namespace fw::test::golden_test {
namespace {

constexpr uint32_t kWidth = 320, kHeight = 180;
constexpr VkFormat kColor = VK_FORMAT_R8G8B8A8_UNORM, kDepth = VK_FORMAT_D32_SFLOAT;

void must(VkResult result) { ASSERT_EQ(result, VK_SUCCESS); }

// A host's pass with colour and depth, and a read-back of the picture.
class Golden : public HostContext {
 protected:
    void SetUp() override {
        HostContext::SetUp();
        if (!context_) return;
        if (device_->properties.deviceType != VK_PHYSICAL_DEVICE_TYPE_CPU) {
            still_ = {1, 0.01, 40};
            moving_ = {6, 0.04, 40};
        }
        color_ = device_->makeImage(
            kColor, {kWidth, kHeight}, 1,
            VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
        depth_ = device_->makeImage(
            kDepth, {kWidth, kHeight}, 1,
            VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
        makePass();
        VkBufferCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
        info.size = kWidth * kHeight * 4;
        info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
        must(vkCreateBuffer(device_->device, &info, nullptr, &pixels_));
        VkMemoryRequirements needs{};
        vkGetBufferMemoryRequirements(device_->device, pixels_, &needs);
        pixelMemory_ = allocate(
            needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
        must(vkBindBufferMemory(device_->device, pixels_, pixelMemory_, 0));

        ASSERT_EQ(fwContext_Prepare(context_), FW_OK);
        frames_ = std::make_unique<HostFrames>(*device_, 2);
    }

    void TearDown() override {
        if (frames_) frames_->waitAll();
        destroyContext();
        frames_.reset();
        if (device_) {
            const VkDevice d = device_->device;
            vkDestroyFramebuffer(d, framebuffer_, nullptr);
            vkDestroyRenderPass(d, pass_, nullptr);
            vkDestroyBuffer(d, pixels_, nullptr);
            vkFreeMemory(d, pixelMemory_, nullptr);
        }
        GpuTest::TearDown();
    }

    VkDeviceMemory allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags) {
        VkMemoryAllocateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
        info.allocationSize = needs.size;
        info.memoryTypeIndex = device_->memoryType(needs.memoryTypeBits, flags);
        VkDeviceMemory memory = VK_NULL_HANDLE;
        must(vkAllocateMemory(device_->device, &info, nullptr, &memory));
        return memory;
    }

    void makePass() {
        std::array<VkAttachmentDescription, 2> attachments{};
        attachments[0].format = kColor;
        attachments[0].finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
        attachments[1].format = kDepth;
        attachments[1].finalLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
        for (VkAttachmentDescription& a : attachments) {
            a.samples = VK_SAMPLE_COUNT_1_BIT;
            a.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
            a.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
            a.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
            a.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
        }
        const VkAttachmentReference color{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
        const VkAttachmentReference depth{1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
        VkSubpassDescription subpass{};
        subpass.colorAttachmentCount = 1;
        subpass.pColorAttachments = &color;
        subpass.pDepthStencilAttachment = &depth;
        std::array<VkSubpassDependency, 2> edges{};
        edges[0] = {VK_SUBPASS_EXTERNAL,
                    0,
                    VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                    VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT,
                    VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
                    VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT |
                        VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
                        VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                    0};
        edges[1] = {0,
                    VK_SUBPASS_EXTERNAL,
                    VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                    VK_PIPELINE_STAGE_TRANSFER_BIT,
                    VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                    VK_ACCESS_TRANSFER_READ_BIT,
                    0};
        VkRenderPassCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
        info.attachmentCount = 2;
        info.pAttachments = attachments.data();
        info.subpassCount = 1;
        info.pSubpasses = &subpass;
        info.dependencyCount = 2;
        info.pDependencies = edges.data();
        must(vkCreateRenderPass(device_->device, &info, nullptr, &pass_));
        const std::array<VkImageView, 2> views{color_.view, depth_.view};
        VkFramebufferCreateInfo frame{};
        frame.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
        frame.renderPass = pass_;
        frame.attachmentCount = 2;
        frame.pAttachments = views.data();
        frame.width = kWidth;
        frame.height = kHeight;
        frame.layers = 1;
        must(vkCreateFramebuffer(device_->device, &frame, nullptr, &framebuffer_));
    }

    FwTargetId makeTarget(bool reversed, uint32_t flags = 0) {
        FwVulkanTargetDef def = fwDefaultVulkanTargetDef();
        const bool composite = (flags & FW_TARGET_COMPOSITE) != 0;
        def.flags = flags | FW_TARGET_AS_NEEDED;
        def.renderPass = composite ? VK_NULL_HANDLE : pass_;
        def.colorFormat = kColor;
        def.depthFormat = kDepth;
        def.samples = 1;
        def.colorAttachmentCount = 1;
        def.depthMode = composite ? FW_DEPTH_SAMPLED : FW_DEPTH_TEST;
        def.reversedDepth = reversed;
        def.encoding = FW_OUTPUT_DISPLAY_UNORM;
        FwTargetId id{};
        EXPECT_EQ(fwContext_RegisterTarget(context_, &def, &id), FW_OK);
        return id;
    }

    FwWorld* makeWorld(float pace, float windX = 0) {
        FwWorldDef def = fwDefaultWorldDef();
        def.paceFactor = pace;
        def.maxStepsPerFrame = 32;
        def.wind[0] = windX;
        FwWorld* world = nullptr;
        EXPECT_EQ(fwCreateWorld(context_, &def, &world), FW_OK);
        return world;
    }

    // A standing sheet of `side` m, or a box of them, with detail coordinates, lit near a corner.
    void addThing(FwWorld* world, uint32_t preset, float side, float density, bool box,
                  uint32_t flags = 0, bool lid = true) {
        std::vector<float> positions, normals, details;
        std::vector<uint32_t> indices;
        const float h = 0.5f * side;
        const auto face = [&](glm::vec3 normal, glm::vec3 x, glm::vec3 y) {
            const uint32_t first = uint32_t(positions.size() / 3);
            for (int k = 0; k < 4; ++k) {
                const float u = (k & 1) ? h : -h, v = (k & 2) ? h : -h;
                const glm::vec3 p = normal * (box ? h : 0.0f) + x * u + y * v;
                positions.insert(positions.end(), {p.x, p.y, p.z});
                normals.insert(normals.end(), {normal.x, normal.y, normal.z});
                details.insert(details.end(), {u + float(first) * 0.37f, v});
            }
            for (const uint32_t k : {0u, 1u, 3u, 0u, 3u, 2u}) indices.push_back(first + k);
        };
        const glm::vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
        face(z, x, y);
        if (box) {
            face(-z, -x, y);
            face(x, -z, y);
            face(-x, z, y);
            if (lid) face(y, x, -z);
            face(-y, x, z);
        }
        FwMeshDef mesh = fwDefaultMeshDef();
        mesh.positions = positions.data();
        mesh.normals = normals.data();
        mesh.details = details.data();
        mesh.indices = indices.data();
        mesh.vertexCount = uint32_t(positions.size() / 3);
        mesh.indexCount = uint32_t(indices.size());
        mesh.texelsPerMetre = density;
        FwBurnableMeshDef object = fwDefaultBurnableMeshDef();
        object.flags = flags | (box ? 0 : FW_BURNABLE_TWO_SIDED);
        (void)addBurnable(world, mesh, preset, object);
        FwIgnitionDef match = fwDefaultIgnitionDef();
        match.position[0] = -0.2f * side;
        match.position[1] = -0.3f * side;
        match.position[2] = box ? h : 0.0f;
        match.radius = 0.03f;
        uint32_t texels = 0;
        ASSERT_EQ(fwWorld_Ignite(world, &match, &texels), FW_OK);
        ASSERT_GT(texels, 0u);
    }

    // A sheet with its middle at the origin that hangs from its upper edge and is lit below.
    void hang(FwWorld* world, uint32_t preset, float side, int cells, float density) {
        const Mesh sheet = makeSheet(double(side), cells);
        std::vector<float> details;
        for (uint32_t i = 0; i < sheet.vertexCount(); ++i)
            details.insert(details.end(), {sheet.positions[i * 3], sheet.positions[i * 3 + 1]});
        FwMeshDef mesh = fwDefaultMeshDef();
        mesh.positions = sheet.positions.data();
        mesh.details = details.data();
        mesh.indices = sheet.indices.data();
        mesh.vertexCount = sheet.vertexCount();
        mesh.indexCount = uint32_t(sheet.indices.size());
        mesh.texelsPerMetre = density;
        FwBurnableMeshDef object = fwDefaultBurnableMeshDef();
        object.flags = uint32_t{FW_BURNABLE_TWO_SIDED} | uint32_t{FW_BURNABLE_SHELL};
        FwPin pin{};
        pin.from[1] = pin.to[1] = pin.to[0] = side;
        pin.radius = 0.003f;
        object.pins = &pin;
        object.pinCount = 1;
        object.transform[12] = object.transform[13] = -0.5f * side;
        (void)addBurnable(world, mesh, preset, object);
        FwIgnitionDef match = fwDefaultIgnitionDef();
        match.position[0] = 0.1f * side;
        match.position[1] = -0.49f * side;
        match.radius = 0.02f;
        uint32_t texels = 0;
        ASSERT_EQ(fwWorld_Ignite(world, &match, &texels), FW_OK);
        ASSERT_GT(texels, 0u);
    }

    // Moving objects need steps of their own: a second as 24 frames.
    Picture playAndDraw(FwWorld* world, float seconds, const FwView& view) {
        for (int i = 0; i < int(seconds * 24); ++i) {
            const FwVulkanFrame frame = frames_->begin(1.0f / 24);
            EXPECT_EQ(fwWorld_RecordOutside(world, &frame, &view), FW_OK);
            frames_->submit();
        }
        return burnAndDraw(world, 0, view, false);
    }

    static FwView makeView(glm::vec3 eye, bool reversed, bool night) {
        FwView view = fwDefaultView();
        const glm::mat4 look = glm::lookAt(eye, glm::vec3(0), glm::vec3(0, 1, 0));
        constexpr float kNear = 0.05f, kFar = 50.0f;
        glm::mat4 projection(0.0f);
        const float zoom = 1.0f / std::tan(glm::radians(18.0f));
        projection[0][0] = zoom * float(kHeight) / float(kWidth);
        projection[1][1] = -zoom;
        projection[2][2] = reversed ? kNear / (kFar - kNear) : kFar / (kNear - kFar);
        projection[3][2] = reversed ? kFar * kNear / (kFar - kNear) : kFar * kNear / (kNear - kFar);
        projection[2][3] = -1.0f;
        std::memcpy(view.view, glm::value_ptr(look), sizeof view.view);
        std::memcpy(view.projection, glm::value_ptr(projection), sizeof view.projection);
        const glm::vec3 sun = glm::normalize(glm::vec3(-0.5f, 0.75f, 0.65f));
        std::memcpy(view.sunDirection, glm::value_ptr(sun), sizeof view.sunDirection);
        const float dim = night ? 0.06f : 1.0f;
        for (int i = 0; i < 3; ++i) {
            view.sunColor[i] = dim * std::array{1.65f, 1.43f, 1.15f}[size_t(i)];
            view.ambientSky[i] = dim * std::array{0.33f, 0.40f, 0.55f}[size_t(i)];
            view.ambientGround[i] = dim * std::array{0.22f, 0.20f, 0.18f}[size_t(i)];
        }
        return view;
    }

    // Burns for `seconds`, then draws. `soft`: surfaces in the host's pass, then flames over its
    // images. Of several `draws` the last counts, because the first one prepares later ones.
    Picture burnAndDraw(FwWorld* world, float seconds, FwView view, bool reversed,
                        bool soft = false, int draws = 1) {
        const FwTargetId target = makeTarget(reversed, soft ? FW_TARGET_NO_FLAMES : 0);
        const FwTargetId over = soft ? makeTarget(reversed, FW_TARGET_COMPOSITE) : FwTargetId{};
        int left = int(seconds + 0.5f);
        view.time = 3.0f;
        for (; left > 0; --left) {
            const FwVulkanFrame frame = frames_->begin(1.0f);
            EXPECT_EQ(fwWorld_RecordOutside(world, &frame, &view), FW_OK);
            frames_->submit();
        }
        for (int i = 0; i < 12; ++i) {  // prediction grows by a ring per frame
            const FwVulkanFrame frame = frames_->begin(0);
            EXPECT_EQ(fwWorld_RecordOutside(world, &frame, &view), FW_OK);
            if (i >= 12 - draws) drawInto(frame, world, target, over, view, reversed);
            frames_->submit();
        }
        frames_->waitAll();
        Picture picture{kWidth, kHeight, std::vector<uint8_t>(kWidth * kHeight * 3)};
        void* mapped = nullptr;
        must(vkMapMemory(device_->device, pixelMemory_, 0, VK_WHOLE_SIZE, 0, &mapped));
        const auto* rgba = static_cast<const uint8_t*>(mapped);
        for (size_t i = 0; i < picture.rgb.size(); ++i) picture.rgb[i] = rgba[i / 3 * 4 + i % 3];
        vkUnmapMemory(device_->device, pixelMemory_);
        return picture;
    }

    void drawInto(const FwVulkanFrame& frame, FwWorld* world, FwTargetId target, FwTargetId over,
                  const FwView& view, bool reversed) {
        std::array<VkClearValue, 2> clears{};
        clears[0].color = {{0.10f, 0.11f, 0.13f, 1.0f}};
        clears[1].depthStencil.depth = reversed ? 0.0f : 1.0f;
        VkRenderPassBeginInfo begin{};
        begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
        begin.renderPass = pass_;
        begin.framebuffer = framebuffer_;
        begin.renderArea.extent = {kWidth, kHeight};
        begin.clearValueCount = 2;
        begin.pClearValues = clears.data();
        vkCmdBeginRenderPass(frame.commandBuffer, &begin, VK_SUBPASS_CONTENTS_INLINE);
        const VkViewport viewport{0, 0, float(kWidth), float(kHeight), 0, 1};
        EXPECT_EQ(fwWorld_RecordInside(world, &frame, target, &view, &viewport), FW_OK);
        vkCmdEndRenderPass(frame.commandBuffer);
        if (over.index1) {
            FwVulkanComposite images = fwDefaultVulkanComposite();
            images.width = kWidth;
            images.height = kHeight;
            images.color = {
                color_.image,
                color_.view,
                VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                VK_PIPELINE_STAGE_TRANSFER_BIT,
                VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                VK_ACCESS_TRANSFER_READ_BIT};
            images.depth = {depth_.image,
                            depth_.view,
                            VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
                            VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
                            VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT,
                            VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT,
                            VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                            VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
            EXPECT_EQ(fwWorld_RecordComposite(world, &frame, over, &view, &images), FW_OK);
        }
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {kWidth, kHeight, 1};
        vkCmdCopyImageToBuffer(frame.commandBuffer, color_.image,
                               VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pixels_, 1, &region);
        VkMemoryBarrier toHost{};
        toHost.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
        toHost.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        toHost.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
        vkCmdPipelineBarrier(frame.commandBuffer, VK_PIPELINE_STAGE_TRANSFER_BIT,
                             VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &toHost, 0, nullptr, 0, nullptr);
    }

    // Half of each picture is fire: the mean finds a wrong look, the outliers a wrong shape. The
    // software device drew the goldens. GPUs round floats differently, so cosmetic motion drifts.
    // An H100 differs by 0.69 (still) and 4.4 (moving) at most.
    PictureTolerance still_{0.5, 0.005, 40}, moving_{1.5, 0.02, 40};
    std::unique_ptr<HostFrames> frames_;
    TestImage color_, depth_;
    VkRenderPass pass_ = VK_NULL_HANDLE;
    VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
    VkBuffer pixels_ = VK_NULL_HANDLE;
    VkDeviceMemory pixelMemory_ = VK_NULL_HANDLE;
};

TEST_F(Golden, PineSheetByDay) {
    FwWorld* world = makeWorld(40);
    addThing(world, FW_MATERIAL_PINE, 0.6f, 128, false);
    const FwView view = makeView({0.25f, 0.1f, 1.0f}, false, false);
    EXPECT_TRUE(matchesGolden("pine_sheet", burnAndDraw(world, 9, view, false), still_));
}

TEST_F(Golden, PaperBurnsThrough) {
    FwWorld* world = makeWorld(1);
    addThing(world, FW_MATERIAL_NEWSPAPER, 0.3f, 512, false);
    const FwView view = makeView({0.1f, 0.05f, 0.5f}, false, false);
    EXPECT_TRUE(matchesGolden("paper_hole", burnAndDraw(world, 11, view, false), still_));
}

TEST_F(Golden, ThatchByNight) {
    FwWorld* world = makeWorld(2, 1.5f);
    addThing(world, FW_MATERIAL_THATCH, 1.0f, 96, false);
    const FwView view = makeView({0.4f, 0.3f, 2.2f}, false, true);
    EXPECT_TRUE(matchesGolden("thatch_night", burnAndDraw(world, 7, view, false), still_));
}

// Charred leather is smaller: the sheet's outline recedes.
TEST_F(Golden, LeatherShrinksAndCracks) {
    FwWorld* world = makeWorld(8);
    hang(world, FW_MATERIAL_LEATHER, 0.3f, 36, 320);
    const FwView view = makeView({0.1f, 0.05f, 0.55f}, false, false);
    EXPECT_TRUE(matchesGolden("leather", playAndDraw(world, 8, view), moving_));
}

// Paper keeps its shape, curls where it chars, and loses its burnt parts.
TEST_F(Golden, PaperCurls) {
    FwWorld* world = makeWorld(1);
    hang(world, FW_MATERIAL_PAPER, 0.24f, 32, 640);
    const FwView view = makeView({0.16f, 0.02f, 0.44f}, false, false);
    playAndDraw(world, 3.75f, view);
    FwIgnitionDef end = fwDefaultIgnitionDef();  // its edges show without flames in front
    end.kind = FW_EXTINGUISH;
    end.radius = 1;
    ASSERT_EQ(fwWorld_Ignite(world, &end, nullptr), FW_OK);
    EXPECT_TRUE(matchesGolden("paper_curls", playAndDraw(world, 0.5f, view), moving_));
}

TEST_F(Golden, CottonBurnsThrough) {
    FwWorld* world = makeWorld(1);
    addThing(world, FW_MATERIAL_COTTON, 0.3f, 384, false);
    const FwView view = makeView({0.1f, 0.05f, 0.5f}, false, false);
    EXPECT_TRUE(matchesGolden("cotton", burnAndDraw(world, 5, view, false), still_));
}

TEST_F(Golden, WetPatchIsLeftOver) {
    FwWorld* world = makeWorld(60);
    addThing(world, FW_MATERIAL_PINE, 0.5f, 160, false);
    FwIgnitionDef water = fwDefaultIgnitionDef();
    water.kind = FW_WET;
    water.position[0] = 0.03f;
    water.position[1] = 0.06f;
    water.radius = 0.10f;
    ASSERT_EQ(fwWorld_Ignite(world, &water, nullptr), FW_OK);
    const FwView view = makeView({0.15f, 0.1f, 0.85f}, false, false);
    EXPECT_TRUE(matchesGolden("wet_patch", burnAndDraw(world, 9, view, false), still_));
}

// The edge of the water is soft before fire arrives, and it dries from there.
TEST_F(Golden, WetPatchBeforeTheFire) {
    FwWorld* world = makeWorld(1);
    addThing(world, FW_MATERIAL_PINE, 0.5f, 160, false);
    FwIgnitionDef water = fwDefaultIgnitionDef();
    water.kind = FW_WET;
    water.position[0] = 0.05f;
    water.position[1] = 0.06f;
    water.radius = 0.13f;
    ASSERT_EQ(fwWorld_Ignite(world, &water, nullptr), FW_OK);
    const FwView view = makeView({0.15f, 0.1f, 0.85f}, false, false);
    EXPECT_TRUE(matchesGolden("wet_fresh", burnAndDraw(world, 2, view, false), still_));
}

// Extinguished, it stays black, also above the char.
TEST_F(Golden, SootOutlivesItsFlame) {
    FwWorld* world = makeWorld(1);
    addThing(world, FW_MATERIAL_COTTON, 0.4f, 256, false);
    const FwView view = makeView({0.1f, 0.05f, 0.65f}, false, false);
    burnAndDraw(world, 3, view, false);
    FwIgnitionDef end = fwDefaultIgnitionDef();
    end.kind = FW_EXTINGUISH;
    end.radius = 1;
    ASSERT_EQ(fwWorld_Ignite(world, &end, nullptr), FW_OK);
    EXPECT_TRUE(matchesGolden("soot_stays", burnAndDraw(world, 3, view, false), still_));
}

TEST_F(Golden, BurntOpenBox) {
    FwWorld* world = makeWorld(60);
    addThing(world, FW_MATERIAL_PAINTED_WOOD, 0.5f, 128, true);
    const FwView view = makeView({-0.8f, 0.55f, 1.5f}, false, false);
    EXPECT_TRUE(matchesGolden("open_box", burnAndDraw(world, 16, view, false), still_));
}

// A receding box keeps its walls, thinner where they burn: the rest of a wall shows behind a hole.
TEST_F(Golden, BurntBoxThatRecedes) {
    FwWorld* world = makeWorld(60);
    addThing(world, FW_MATERIAL_PAINTED_WOOD, 0.5f, 128, true, FW_BURNABLE_RECEDE);
    const FwView view = makeView({-0.8f, 0.55f, 1.5f}, false, false);
    EXPECT_TRUE(matchesGolden("receding_box", burnAndDraw(world, 16, view, false), still_));
}

// Refined walls have thickness: an inner skin behind holes and along the open border.
TEST_F(Golden, InsideOfARefinedBox) {
    FwWorld* world = makeWorld(60);
    addThing(world, FW_MATERIAL_PAINTED_WOOD, 0.5f, 128, true, FW_BURNABLE_REFINE, false);
    const FwView view = makeView({-0.5f, 0.8f, 1.0f}, false, false);
    EXPECT_TRUE(matchesGolden("refined_box", burnAndDraw(world, 17, view, false), still_));
}

// Flames against the sampled depth of the surfaces below them.
TEST_F(Golden, SoftFlames) {
    FwWorld* world = makeWorld(60);
    addThing(world, FW_MATERIAL_PINE, 0.5f, 128, true);
    const FwView view = makeView({-0.8f, 0.55f, 1.5f}, true, true);
    EXPECT_TRUE(matchesGolden("soft_flames", burnAndDraw(world, 6, view, true, true), still_));
}

// A camp fire without a mesh, with thin smoke.
TEST_F(Golden, CampFireByNight) {
    FwWorld* world = makeWorld(1);
    FwVolumetricFireDef fire = fwDefaultVolumetricFireDef();
    fire.position[1] = -0.35f;
    fire.seed = 3;
    FwVolumetricFireId id{};
    ASSERT_EQ(fwWorld_CreateVolumetricFire(world, &fire, &id), FW_OK);
    const FwView view = makeView({0.4f, 0.3f, 2.4f}, false, true);
    EXPECT_TRUE(
        matchesGolden("camp_fire_night", burnAndDraw(world, 3, view, false, false, 2), still_));
}

TEST_F(Golden, ReversedDepthGivesTheSamePicture) {
    Picture pictures[2];
    for (int reversed = 0; reversed < 2; ++reversed) {
        FwWorld* world = makeWorld(60);
        addThing(world, FW_MATERIAL_PINE, 0.5f, 64, true);
        const FwView view = makeView({-0.8f, 0.55f, 1.5f}, reversed == 1, false);
        pictures[reversed] = burnAndDraw(world, 5, view, reversed == 1);
    }
    EXPECT_TRUE(picturesMatch(pictures[1], pictures[0], {0.3, 0.004, 40}));
    uint64_t bright = 0;  // the picture is not empty
    for (const uint8_t value : pictures[0].rgb) bright += value > 60;
    EXPECT_GT(bright, 5000u);
}

// The comparison must be able to fail.
TEST(GoldenImage, RoundTripAndDifference) {
    Picture picture{33, 7, std::vector<uint8_t>(33 * 7 * 3)};
    for (size_t i = 0; i < picture.rgb.size(); ++i) picture.rgb[i] = uint8_t(i * i * 31 + i);
    const std::string path = testing::TempDir() + "golden_round_trip.png";
    ASSERT_TRUE(writePng(path, picture));
    Picture read;
    ASSERT_TRUE(readPng(path, read));
    EXPECT_EQ(read.rgb, picture.rgb);
    EXPECT_TRUE(picturesMatch(read, picture, {0, 0, 0}));
    for (size_t i = 0; i < 30; ++i) read.rgb[i] ^= 0x80;
    EXPECT_FALSE(picturesMatch(read, picture, {0.5, 0.005, 40}));
    EXPECT_FALSE(readPng(path + ".missing", read));
}

}  // namespace
}  // namespace fw::test::golden_test
