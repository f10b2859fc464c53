// A host with state of its own around our calls: it draws (or computes), calls us, sets again only
// what plugin/docs/integration.md says we change, and goes on. Its pixels and numbers are exactly
// those of the same frame without us. Through the C ABI.
#include "support/burn_scene.h"
#include "support/sanitized.h"

#include <array>
#include <cstring>
#include <set>

namespace fw::test {
namespace {

#include "host.comp.inc"
#include "host.frag.inc"
#include "host.vert.inc"

constexpr uint32_t kWidth = 96, kHeight = 64;
constexpr uint32_t kPixels = kWidth * kHeight;
constexpr float kHostDepth = 0.5f;  // nearer than the fire, reversed or not

void must(VkResult result, const char* what) { ASSERT_EQ(result, VK_SUCCESS) << what; }
#define FW_MUST(call) must(call, #call)

// What the published list names. A host that leaves one out sees it in its pixels.
enum Published : uint32_t {
    kPipeline = 1,
    kSets = 2,
    kPush = 4,
    kVertex0 = 8,
    kVertex1 = 16,
    kIndices = 32,
    kViewport = 64,
    kScissor = 128,
    kOtherDynamic = 256,
    kAll = 511
};

struct Case {
    uint32_t samples;
    bool reversed, srgb;
    [[nodiscard]] VkFormat format() const {
        return srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM;
    }
};

// One rectangle of the host's, in pixels.
struct Rect {
    int32_t x0, y0, x1, y1;
};
// Drawn before us, then after us. The first of each stands aside, the second before the fire, the
// third reaches over the host's scissor.
constexpr Rect kBefore[] = {{8, 8, 24, 56}, {40, 44, 56, 50}, {0, 0, 24, 6}};
constexpr Rect kAfter[] = {{72, 8, 88, 56}, {40, 28, 56, 36}, {16, 20, 84, 26}, {72, 58, 96, 64}};
constexpr VkRect2D kScissorRect{{6, 5}, {84, 54}};
constexpr VkViewport kHostViewport{4, 2, 88, 60, 0, 1};

class HostClobber : public GpuTest {
 protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!device_) return;
        const FwVulkanHost host = device_->host();
        FwContextDef def = fwDefaultContextDef();
        def.vulkan = &host;
        FwErrorInfo error{};
        ASSERT_EQ(fwCreateContext(&def, &context_, &error), FW_OK) << error.message;
        ASSERT_EQ(fwContext_Prepare(context_), FW_OK);
        frames_ = std::make_unique<HostFrames>(*device_, 2);
        makeWorld();
        makeLayouts();
    }

    void TearDown() override {
        if (device_) vkDeviceWaitIdle(device_->device);
        fwDestroyContext(context_);
        frames_.reset();
        for (auto drop = cleanup_.rbegin(); drop != cleanup_.rend(); ++drop) (*drop)();
        GpuTest::TearDown();
    }

    // A burning ball in the middle of the picture.
    void makeWorld() {
        const FwWorldDef worldDef = fwDefaultWorldDef();
        ASSERT_EQ(fwCreateWorld(context_, &worldDef, &world_), FW_OK);
        const Mesh ball = makeCube(1.0, 6, true, false);
        FwMeshDef mesh = fwDefaultMeshDef();
        mesh.positions = ball.positions.data();
        mesh.indices = ball.indices.data();
        mesh.vertexCount = ball.vertexCount();
        mesh.indexCount = uint32_t(ball.indices.size());
        mesh.texelsPerMetre = 48;
        FwBurnableMeshDef object = fwDefaultBurnableMeshDef();
        ASSERT_EQ(fwWorld_CreateMesh(world_, &mesh, &object.mesh), FW_OK);
        FwMaterialDef material = fwDefaultMaterialDef();
        ASSERT_EQ(fwInitMaterialPreset(&material, FW_MATERIAL_PAPER), FW_OK);
        ASSERT_EQ(fwWorld_CreateMaterial(world_, &material, &object.materials[0]), FW_OK);
        FwBurnableMeshId id{};
        ASSERT_EQ(fwWorld_CreateBurnableMesh(world_, &object, &id), FW_OK);
        FwIgnitionDef match = fwDefaultIgnitionDef();
        match.position[2] = 0.6f;
        match.radius = 0.25f;
        uint32_t texels = 0;
        ASSERT_EQ(fwWorld_Ignite(world_, &match, &texels), FW_OK);
        ASSERT_GT(texels, 0u);
        const float eye[3] = {0, 0, 3}, target[3] = {0, 0, 0};
        for (const bool reversed : {false, true})
            views_[reversed] = testView(eye, target, 40, float(kWidth) / kHeight, reversed);
        for (int f = 0; f < 16; ++f) {
            const FwVulkanFrame frame = frames_->begin(0.125f);
            ASSERT_EQ(fwWorld_RecordOutside(world_, &frame, views_.data()), FW_OK);
            frames_->submit();
        }
    }

    // Made once, of one kind: `make` fills the handle, `drop` is the vkDestroy of it.
    template <class Handle, class Info>
    Handle made(VkResult(VKAPI_PTR* make)(VkDevice, const Info*, const VkAllocationCallbacks*,
                                          Handle*),
                void(VKAPI_PTR* drop)(VkDevice, Handle, const VkAllocationCallbacks*),
                const Info& info) {
        Handle handle = VK_NULL_HANDLE;
        FW_MUST(make(device_->device, &info, nullptr, &handle));
        cleanup_.emplace_back(
            [device = device_->device, drop, handle] { drop(device, handle, nullptr); });
        return handle;
    }

    template <class T>
    TestBuffer makeBuffer(VkBufferUsageFlags usage, const std::vector<T>& content) {
        const TestBuffer out = device_->makeBuffer(content.size() * sizeof(T), usage);
        std::memcpy(out.mapped, content.data(), content.size() * sizeof(T));
        return out;
    }

    VkShaderModule makeModule(const uint32_t* words, size_t bytes) {
        VkShaderModuleCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
        info.codeSize = bytes;
        info.pCode = words;
        return made(vkCreateShaderModule, vkDestroyShaderModule, info);
    }

    // Two sets of one buffer each, and push constants; for drawing and for computing.
    void makeLayouts() {
        VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 2},
                                        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2}};
        VkDescriptorPoolCreateInfo poolInfo{};
        poolInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
        poolInfo.maxSets = 4;
        poolInfo.poolSizeCount = 2;
        poolInfo.pPoolSizes = sizes;
        pool_ = made(vkCreateDescriptorPool, vkDestroyDescriptorPool, poolInfo);

        const auto uniform = [&](std::vector<float> values) {
            return makeBuffer(VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, values);
        };
        const TestBuffer uniforms[2] = {uniform({0.9f, 0.8f, 0.7f, 1}),
                                        uniform({0.05f, 0.1f, 0.15f, 0})};
        layout_ = makeLayout(VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                             VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 20,
                             uniforms, sets_);

        const auto add = [](std::vector<float>& to, std::initializer_list<float> values) {
            to.insert(to.end(), values);
        };
        std::vector<float> positions, shades;
        std::vector<uint32_t> colors;
        std::vector<uint16_t> indices;
        const auto rectangle = [&](const Rect& rect, uint32_t color) {
            const auto first = uint16_t(positions.size() / 2);
            for (const int corner : {0, 1, 2, 3}) {
                const auto x = float(corner & 1 ? rect.x1 : rect.x0);
                const auto y = float(corner & 2 ? rect.y1 : rect.y0);
                add(positions, {(x - kHostViewport.x) / kHostViewport.width * 2 - 1,
                                (y - kHostViewport.y) / kHostViewport.height * 2 - 1});
                colors.push_back(color);
                add(shades, {1.0f - 0.1f * float(corner), 0.7f + 0.1f * float(corner), 0.9f, 1});
            }
            for (const int i : {0, 1, 2, 2, 1, 3}) indices.push_back(uint16_t(first + i));
        };
        for (const Rect& rect : kBefore) rectangle(rect, 0xFF40C0FFu);
        for (const Rect& rect : kAfter) rectangle(rect, 0xFFFFA080u);
        // A host that forgets its indices draws with ours: they must not lead out of its vertices.
        while (positions.size() < 2 * 4096) {
            add(positions, {2, 2});
            colors.push_back(0);
            add(shades, {1, 1, 1, 1});
        }
        const VkBufferUsageFlags vertex = VK_BUFFER_USAGE_VERTEX_BUFFER_BIT;
        vertices_[0] = makeBuffer(vertex, positions).buffer;
        vertices_[1] = makeBuffer(vertex, colors).buffer;
        vertices_[2] = makeBuffer(vertex, shades).buffer;
        vertices_[3] = makeBuffer(vertex, std::vector<float>{1, 0.9f, 0.95f, 1}).buffer;
        indices_ = makeBuffer(VK_BUFFER_USAGE_INDEX_BUFFER_BIT, indices).buffer;
        pixels_ = makeBuffer(VK_BUFFER_USAGE_TRANSFER_DST_BIT, std::vector<uint32_t>(3 * kPixels));

        VkFormatProperties properties{};
        vkGetPhysicalDeviceFormatProperties(device_->physicalDevice, VK_FORMAT_D32_SFLOAT_S8_UINT,
                                            &properties);
        if (!(properties.optimalTilingFeatures & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT))
            depthFormat_ = VK_FORMAT_D24_UNORM_S8_UINT;  // one of the two is always there
        VkQueryPoolCreateInfo queries{};
        queries.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
        queries.queryType = VK_QUERY_TYPE_OCCLUSION;
        queries.queryCount = 3;
        queries_ = made(vkCreateQueryPool, vkDestroyQueryPool, queries);
    }

    VkPipelineLayout makeLayout(VkDescriptorType type, VkShaderStageFlags stages, uint32_t push,
                                const TestBuffer (&buffers)[2], VkDescriptorSet (&sets)[2]) {
        const VkDescriptorSetLayoutBinding binding{0, type, 1, stages, nullptr};
        VkDescriptorSetLayoutCreateInfo setInfo{};
        setInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
        setInfo.bindingCount = 1;
        setInfo.pBindings = &binding;
        const VkDescriptorSetLayout one =
            made(vkCreateDescriptorSetLayout, vkDestroyDescriptorSetLayout, setInfo);
        const VkDescriptorSetLayout both[2] = {one, one};
        VkDescriptorSetAllocateInfo allocate{};
        allocate.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
        allocate.descriptorPool = pool_;
        allocate.descriptorSetCount = 2;
        allocate.pSetLayouts = both;
        FW_MUST(vkAllocateDescriptorSets(device_->device, &allocate, sets));
        for (int i = 0; i < 2; ++i) {
            const VkDescriptorBufferInfo whole{buffers[i].buffer, 0, VK_WHOLE_SIZE};
            VkWriteDescriptorSet write{};
            write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
            write.dstSet = sets[i];
            write.descriptorCount = 1;
            write.descriptorType = type;
            write.pBufferInfo = &whole;
            vkUpdateDescriptorSets(device_->device, 1, &write, 0, nullptr);
        }
        const VkPushConstantRange range{stages, 0, push};
        VkPipelineLayoutCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
        info.setLayoutCount = 2;
        info.pSetLayouts = both;
        info.pushConstantRangeCount = 1;
        info.pPushConstantRanges = &range;
        return made(vkCreatePipelineLayout, vkDestroyPipelineLayout, info);
    }

    // Everything dynamic: blending by constants, a stencil test that a reference of 0 fails, and a
    // strict depth test that only a biased depth passes where kHostDepth is there already.
    VkPipeline makePipeline(const Case& one, VkRenderPass pass) {
        VkPipelineShaderStageCreateInfo stages[2]{};
        stages[0].sType = stages[1].sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
        stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
        stages[0].module = makeModule(kHostVert, sizeof kHostVert);
        stages[1].module = makeModule(kHostFrag, sizeof kHostFrag);
        stages[0].pName = stages[1].pName = "main";
        const VkVertexInputBindingDescription bindings[] = {{0, 8, VK_VERTEX_INPUT_RATE_VERTEX},
                                                            {1, 4, VK_VERTEX_INPUT_RATE_VERTEX},
                                                            {2, 16, VK_VERTEX_INPUT_RATE_VERTEX},
                                                            {3, 16, VK_VERTEX_INPUT_RATE_INSTANCE}};
        const VkVertexInputAttributeDescription attributes[] = {
            {0, 0, VK_FORMAT_R32G32_SFLOAT, 0},
            {1, 1, VK_FORMAT_R8G8B8A8_UNORM, 0},
            {2, 2, VK_FORMAT_R32G32B32A32_SFLOAT, 0},
            {3, 3, VK_FORMAT_R32G32B32A32_SFLOAT, 0}};
        VkPipelineVertexInputStateCreateInfo input{};
        input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
        input.vertexBindingDescriptionCount = input.vertexAttributeDescriptionCount = 4;
        input.pVertexBindingDescriptions = bindings;
        input.pVertexAttributeDescriptions = attributes;
        VkPipelineInputAssemblyStateCreateInfo assembly{};
        assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
        assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
        VkPipelineViewportStateCreateInfo viewport{};
        viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
        viewport.viewportCount = viewport.scissorCount = 1;
        VkPipelineRasterizationStateCreateInfo raster{};
        raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
        raster.depthBiasEnable = VK_TRUE;
        raster.lineWidth = 1;
        VkPipelineMultisampleStateCreateInfo multisample{};
        multisample.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
        multisample.rasterizationSamples = VkSampleCountFlagBits(one.samples);
        VkPipelineDepthStencilStateCreateInfo depth{};
        depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
        depth.depthTestEnable = depth.depthWriteEnable = depth.stencilTestEnable = VK_TRUE;
        depth.depthCompareOp = one.reversed ? VK_COMPARE_OP_GREATER : VK_COMPARE_OP_LESS;
        depth.front.compareOp = VK_COMPARE_OP_GREATER;
        depth.front.passOp = VK_STENCIL_OP_INCREMENT_AND_CLAMP;
        depth.front.failOp = depth.front.depthFailOp = VK_STENCIL_OP_KEEP;
        depth.back = depth.front;
        VkPipelineColorBlendAttachmentState blend{};
        blend.blendEnable = VK_TRUE;
        blend.srcColorBlendFactor = VK_BLEND_FACTOR_CONSTANT_COLOR;
        blend.dstColorBlendFactor = VK_BLEND_FACTOR_ZERO;
        blend.srcAlphaBlendFactor = VK_BLEND_FACTOR_CONSTANT_ALPHA;
        blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_ZERO;
        blend.colorWriteMask = 15;
        VkPipelineColorBlendStateCreateInfo blends{};
        blends.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
        blends.attachmentCount = 1;
        blends.pAttachments = &blend;
        const VkDynamicState states[] = {
            VK_DYNAMIC_STATE_VIEWPORT,           VK_DYNAMIC_STATE_SCISSOR,
            VK_DYNAMIC_STATE_BLEND_CONSTANTS,    VK_DYNAMIC_STATE_STENCIL_REFERENCE,
            VK_DYNAMIC_STATE_STENCIL_WRITE_MASK, VK_DYNAMIC_STATE_STENCIL_COMPARE_MASK,
            VK_DYNAMIC_STATE_DEPTH_BIAS};
        VkPipelineDynamicStateCreateInfo dynamic{};
        dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
        dynamic.dynamicStateCount = 7;
        dynamic.pDynamicStates = states;
        VkGraphicsPipelineCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
        info.stageCount = 2;
        info.pStages = stages;
        info.pVertexInputState = &input;
        info.pInputAssemblyState = &assembly;
        info.pViewportState = &viewport;
        info.pRasterizationState = &raster;
        info.pMultisampleState = &multisample;
        info.pDepthStencilState = &depth;
        info.pColorBlendState = &blends;
        info.pDynamicState = &dynamic;
        info.layout = layout_;
        info.renderPass = pass;
        VkPipeline pipeline = VK_NULL_HANDLE;
        FW_MUST(vkCreateGraphicsPipelines(device_->device, VK_NULL_HANDLE, 1, &info, nullptr,
                                          &pipeline));
        cleanup_.emplace_back(
            [device = device_->device, pipeline] { vkDestroyPipeline(device, pipeline, nullptr); });
        return pipeline;
    }

    // Colour, depth with stencil, and a resolve with several samples; one pass after another.
    VkRenderPass makePass(const Case& one) {
        std::array<VkAttachmentDescription, 3> attachments{};
        const bool resolves = one.samples > 1;
        for (VkAttachmentDescription& a : attachments) {
            a.format = one.format();
            a.samples = VkSampleCountFlagBits(one.samples);
            a.loadOp = a.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
            a.finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        }
        attachments[1].format = depthFormat_;
        attachments[1].finalLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
        attachments[2].samples = VK_SAMPLE_COUNT_1_BIT;
        attachments[2].loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
        attachments[resolves ? 2 : 0].finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
        const VkAttachmentReference color{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
        const VkAttachmentReference depth{1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
        const VkAttachmentReference resolve{2, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
        VkSubpassDescription subpass{};
        subpass.colorAttachmentCount = 1;
        subpass.pColorAttachments = &color;
        subpass.pDepthStencilAttachment = &depth;
        if (resolves) subpass.pResolveAttachments = &resolve;
        constexpr VkPipelineStageFlags kTests =
            VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
        constexpr VkPipelineStageFlags kOutput = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
        constexpr VkAccessFlags kWrites =
            VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
        constexpr VkAccessFlags kReads =
            VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT;
        const VkSubpassDependency edges[] = {
            {VK_SUBPASS_EXTERNAL, 0, kOutput | kTests | VK_PIPELINE_STAGE_TRANSFER_BIT,
             kOutput | kTests, kWrites | VK_ACCESS_TRANSFER_READ_BIT, kWrites | kReads, 0},
            {0, VK_SUBPASS_EXTERNAL, kOutput, VK_PIPELINE_STAGE_TRANSFER_BIT, kWrites & ~0x400u,
             VK_ACCESS_TRANSFER_READ_BIT, 0}};
        VkRenderPassCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
        info.attachmentCount = resolves ? 3 : 2;
        info.pAttachments = attachments.data();
        info.subpassCount = 1;
        info.pSubpasses = &subpass;
        info.dependencyCount = 2;
        info.pDependencies = edges;
        return made(vkCreateRenderPass, vkDestroyRenderPass, info);
    }

    // What a case draws with and into; for several shots, since software devices compile for long.
    struct Stage {
        VkRenderPass pass = VK_NULL_HANDLE;
        VkPipeline pipeline = VK_NULL_HANDLE;
        VkFramebuffer framebuffer = VK_NULL_HANDLE;
        VkImage resolved = VK_NULL_HANDLE;
        FwTargetId target{};
        bool reversed = false;
    };

    // What the host binds of the list; the rest (vertex bindings 2 and 3) it binds once.
    void bind(VkCommandBuffer commands, const Stage& stage, uint32_t what) const {
        const VkDeviceSize zero = 0;
        if (what & kPipeline)
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, stage.pipeline);
        if (what & kSets)
            vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 2, sets_,
                                    0, nullptr);
        if (what & kPush) {
            const float push[5] = {1, 0.95f, 0.9f, 1, kHostDepth};
            vkCmdPushConstants(commands, layout_,
                               VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                               sizeof push, push);
        }
        if (what & kVertex0) vkCmdBindVertexBuffers(commands, 0, 1, &vertices_[0], &zero);
        if (what & kVertex1) vkCmdBindVertexBuffers(commands, 1, 1, &vertices_[1], &zero);
        if (what & kIndices) vkCmdBindIndexBuffer(commands, indices_, 0, VK_INDEX_TYPE_UINT16);
        if (what & kViewport) vkCmdSetViewport(commands, 0, 1, &kHostViewport);
        if (what & kScissor) vkCmdSetScissor(commands, 0, 1, &kScissorRect);
        if (what & kOtherDynamic) {
            const float constants[4] = {0.75f, 0.5f, 0.875f, 0.625f};
            vkCmdSetBlendConstants(commands, constants);
            vkCmdSetStencilCompareMask(commands, VK_STENCIL_FACE_FRONT_AND_BACK, 0x7F);
            vkCmdSetStencilWriteMask(commands, VK_STENCIL_FACE_FRONT_AND_BACK, 0x3F);
            vkCmdSetStencilReference(commands, VK_STENCIL_FACE_FRONT_AND_BACK, 2);
            vkCmdSetDepthBias(commands, stage.reversed ? 65536.0f : -65536.0f, 0, 0);
        }
    }
    void bindOnce(VkCommandBuffer commands) const {
        const VkDeviceSize zeros[2] = {0, 0};
        vkCmdBindVertexBuffers(commands, 2, 2, &vertices_[2], zeros);
    }

    struct Pictures {
        std::vector<uint32_t> alone, around, ours;  // the host alone, with us, and us alone
    };
    Stage makeStage(const Case& one) {
        Stage stage;
        stage.reversed = one.reversed;
        stage.pass = makePass(one);
        stage.pipeline = makePipeline(one, stage.pass);
        const bool resolves = one.samples > 1;
        const TestImage color =
            device_->makeImage(one.format(), {kWidth, kHeight}, one.samples,
                               VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                   (resolves ? 0u : uint32_t(VK_IMAGE_USAGE_TRANSFER_SRC_BIT)));
        const TestImage depth = device_->makeImage(depthFormat_, {kWidth, kHeight}, one.samples,
                                                   VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
        TestImage resolved = color;
        if (resolves)
            resolved = device_->makeImage(
                one.format(), {kWidth, kHeight}, 1,
                VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
        stage.resolved = resolved.image;
        const VkImageView attachments[3] = {color.view, depth.view, resolved.view};
        VkFramebufferCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
        info.renderPass = stage.pass;
        info.attachmentCount = resolves ? 3 : 2;
        info.pAttachments = attachments;
        info.width = kWidth;
        info.height = kHeight;
        info.layers = 1;
        stage.framebuffer = made(vkCreateFramebuffer, vkDestroyFramebuffer, info);

        FwVulkanTargetDef def = fwDefaultVulkanTargetDef();
        def.renderPass = stage.pass;
        def.colorFormat = one.format();
        def.depthFormat = depthFormat_;
        def.samples = one.samples;
        def.colorAttachmentCount = 1;
        def.depthMode = FW_DEPTH_TEST;
        def.reversedDepth = one.reversed;
        def.encoding = one.srgb ? FW_OUTPUT_SRGB_VIEW : FW_OUTPUT_DISPLAY_UNORM;
        EXPECT_EQ(fwContext_RegisterTarget(context_, &def, &stage.target), FW_OK);
        return stage;
    }

    // One frame with three passes. `rebound`: what of the list the host sets again after us.
    Pictures shoot(const Stage& stage, bool secondary, uint32_t rebound = kAll) {
        VkCommandBuffer seconds[3]{};
        if (secondary) {
            VkCommandBufferAllocateInfo info{};
            info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
            info.commandPool = device_->pool;
            info.level = VK_COMMAND_BUFFER_LEVEL_SECONDARY;
            info.commandBufferCount = 3;
            FW_MUST(vkAllocateCommandBuffers(device_->device, &info, seconds));
        }
        const FwView& view = views_[stage.reversed];
        FwVulkanFrame frame = frames_->begin(0);
        const VkCommandBuffer commands = frame.commandBuffer;
        bindOnce(commands);
        EXPECT_EQ(fwWorld_RecordOutside(world_, &frame, &view), FW_OK);
        vkCmdResetQueryPool(commands, queries_, 0, 3);
        for (uint32_t k = 0; k < 3; ++k) {
            VkClearValue clears[2]{};
            clears[0].color = {{0.1f, 0.2f, 0.3f, 1}};
            clears[1].depthStencil = {stage.reversed ? 0.0f : 1.0f, 0};
            VkRenderPassBeginInfo begin{};
            begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
            begin.renderPass = stage.pass;
            begin.framebuffer = stage.framebuffer;
            begin.renderArea.extent = {kWidth, kHeight};
            begin.clearValueCount = 2;
            begin.pClearValues = clears;
            vkCmdBeginRenderPass(commands, &begin,
                                 secondary ? VK_SUBPASS_CONTENTS_SECONDARY_COMMAND_BUFFERS
                                           : VK_SUBPASS_CONTENTS_INLINE);
            FwVulkanFrame inside = frame;
            if (secondary) {
                VkCommandBufferInheritanceInfo inherit{};
                inherit.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO;
                inherit.renderPass = stage.pass;
                VkCommandBufferBeginInfo info{};
                info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
                info.flags = VK_COMMAND_BUFFER_USAGE_RENDER_PASS_CONTINUE_BIT |
                             VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
                info.pInheritanceInfo = &inherit;
                FW_MUST(vkBeginCommandBuffer(seconds[k], &info));
                inside.commandBuffer = seconds[k];
                inside.flags |= FW_FRAME_SECONDARY;
                bindOnce(seconds[k]);
            }
            recordInside(inside, stage, view, k, rebound);
            if (secondary) {
                FW_MUST(vkEndCommandBuffer(seconds[k]));
                vkCmdExecuteCommands(commands, 1, &seconds[k]);
            }
            vkCmdEndRenderPass(commands);
            VkBufferImageCopy region{};
            region.bufferOffset = uint64_t(k) * kPixels * 4;
            region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            region.imageExtent = {kWidth, kHeight, 1};
            vkCmdCopyImageToBuffer(commands, stage.resolved, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                   pixels_.buffer, 1, &region);
        }
        toHost(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
        frames_->submit();
        frames_->waitAll();
        if (secondary) vkFreeCommandBuffers(device_->device, device_->pool, 3, seconds);

        uint64_t seen[3]{};  // queries begun before us and ended after us
        FW_MUST(vkGetQueryPoolResults(device_->device, queries_, 0, 3, sizeof seen, seen, 8,
                                      VK_QUERY_RESULT_64_BIT));
        for (const uint64_t samples : seen) EXPECT_GT(samples, 0u);
        Pictures out;
        const auto* all = static_cast<const uint32_t*>(pixels_.mapped);
        out.alone.assign(all, all + kPixels);
        out.around.assign(all + kPixels, all + 2 * kPixels);
        out.ours.assign(all + 2 * kPixels, all + 3 * kPixels);
        return out;
    }

    // Pass 0: the host alone; 1: the host, us, the host; 2: we alone.
    void recordInside(const FwVulkanFrame& frame, const Stage& stage, const FwView& view,
                      uint32_t number, uint32_t rebound) {
        const VkCommandBuffer commands = frame.commandBuffer;
        const bool hosts = number != 2, us = number != 0;
        vkCmdBeginQuery(commands, queries_, number, 0);
        // Depth on both sides is the host's own already: only its bias lets it draw there.
        VkClearAttachment clear{};
        clear.aspectMask = VK_IMAGE_ASPECT_DEPTH_BIT;
        clear.clearValue.depthStencil.depth = kHostDepth;
        const VkClearRect sides[] = {{{{0, 0}, {28, kHeight}}, 0, 1},
                                     {{{68, 0}, {28, kHeight}}, 0, 1}};
        vkCmdClearAttachments(commands, 1, &clear, 2, sides);
        constexpr uint32_t kFirst = 6 * std::size(kBefore), kSecond = 6 * std::size(kAfter);
        if (hosts) {
            bind(commands, stage, kAll);
            vkCmdDrawIndexed(commands, kFirst, 1, 0, 0, 0);
        }
        if (us) {
            const VkViewport viewport{0, 0, float(kWidth), float(kHeight), 0, 1};
            EXPECT_EQ(fwWorld_RecordInside(world_, &frame, stage.target, &view, &viewport), FW_OK);
        }
        if (hosts) {
            if (us) bind(commands, stage, rebound);
            vkCmdDrawIndexed(commands, kSecond, 1, kFirst, 0, 0);
        }
        vkCmdEndQuery(commands, queries_, number);
    }

    static void toHost(VkCommandBuffer commands, VkPipelineStageFlags stage, VkAccessFlags access) {
        VkMemoryBarrier barrier{};
        barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
        barrier.srcAccessMask = access;
        barrier.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
        vkCmdPipelineBarrier(commands, stage, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0,
                             nullptr, 0, nullptr);
    }

    struct Verdict {
        uint32_t hosts = 0, fire = 0, overFire = 0;  // pixels
        uint32_t wrong = 0;  // that are the host's, or nobody's, and are not as without us
    };
    // A pixel is ours where we draw when alone and the host, nearer, does not.
    static Verdict judge(const Pictures& p) {
        Verdict out;
        const uint32_t clear = p.alone[kPixels - 1];  // outside the host's scissor
        for (size_t i = 0; i < kPixels; ++i) {
            const bool host = p.alone[i] != clear, fire = p.ours[i] != clear;
            out.hosts += host;
            out.fire += fire && !host;
            out.overFire += fire && host;
            if (fire && !host)
                out.wrong += p.around[i] != p.ours[i];  // our pixels are as ever, too
            else
                out.wrong += p.around[i] != p.alone[i];
        }
        return out;
    }

    FwContext* context_ = nullptr;
    FwWorld* world_ = nullptr;
    std::unique_ptr<HostFrames> frames_;
    std::array<FwView, 2> views_{};  // normal, reversed depth
    VkFormat depthFormat_ = VK_FORMAT_D32_SFLOAT_S8_UINT;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkDescriptorSet sets_[2]{};
    VkBuffer vertices_[4]{}, indices_ = VK_NULL_HANDLE;
    VkQueryPool queries_ = VK_NULL_HANDLE;
    TestBuffer pixels_;
    std::vector<std::function<void()>> cleanup_;
};

TEST_F(HostClobber, ItsPixelsAreItsOwnAroundUs) {
    if (!device_) return;
    for (const uint32_t samples : {1u, 4u}) {
        for (const bool reversed : {false, true}) {
            for (const bool srgb : {false, true}) {
                // Sanitized: each two of the three in all ways, not all three.
                if (kSanitized && ((samples > 1) != reversed) != srgb) continue;
                const Stage stage = makeStage({samples, reversed, srgb});
                for (const bool secondary : {false, true}) {
                    SCOPED_TRACE(std::to_string(samples) + (samples > 1 ? " samples" : " sample") +
                                 (reversed ? ", reversed" : ", normal") +
                                 (srgb ? ", sRGB" : ", UNORM") +
                                 (secondary ? ", secondary" : ", primary"));
                    const Pictures pictures = shoot(stage, secondary);
                    const Verdict verdict = judge(pictures);
                    EXPECT_EQ(verdict.wrong, 0u);
                    EXPECT_GT(verdict.hosts, 1500u);
                    EXPECT_GT(verdict.fire, 300u);
                    EXPECT_GT(verdict.overFire, 200u) << "drawn over us and before us";
                    // Every rectangle of the host's is there, so that nothing it sets is idle.
                    const std::set<uint32_t> colors(pictures.alone.begin(), pictures.alone.end());
                    EXPECT_GT(colors.size(), 20u);
                }
            }
        }
    }
}

// The same host, forgetting one thing of the list: its pixels show each. Validation has nothing to
// say but of the dynamic state that our pipelines hold fixed, which it says is no longer set.
TEST_F(HostClobber, WhatIsForgottenShows) {
    if (!device_) return;
    const Stage stage = makeStage({1, false, false});
    for (const auto& [left, name] : {std::pair{kVertex0, "vertex binding 0"},
                                     {kIndices, "index buffer"},
                                     {kViewport, "viewport"},
                                     {kScissor, "scissor"}}) {
        const Verdict verdict = judge(shoot(stage, false, kAll & ~uint32_t(left)));
        EXPECT_GT(verdict.wrong, 0u) << name;
    }
    for (const std::string& message : device_->takeMessages()) ADD_FAILURE() << message;
    const Verdict verdict = judge(shoot(stage, false, kAll & ~uint32_t(kOtherDynamic)));
    EXPECT_GT(verdict.wrong, 0u) << "other dynamic state";
    for (const std::string& message : device_->takeMessages()) {
        if (message.find("state not set") == std::string::npos) ADD_FAILURE() << message;
    }
}

TEST_F(HostClobber, ItsNumbersAreItsOwnAroundOurWork) {
    if (!device_) return;
    constexpr uint32_t kCount = 4096;
    std::vector<uint32_t> in(kCount), want(kCount);
    for (uint32_t i = 0; i < kCount; ++i) {
        in[i] = i * 2654435761u;
        want[i] = i ^ 0x5A5A;
    }
    const TestBuffer buffers[2] = {makeBuffer(VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, in),
                                   makeBuffer(VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, want)};
    VkDescriptorSet sets[2]{};
    const VkPipelineLayout layout = makeLayout(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                               VK_SHADER_STAGE_COMPUTE_BIT, 4, buffers, sets);
    VkComputePipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = makeModule(kHostComp, sizeof kHostComp);
    info.stage.pName = "main";
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    FW_MUST(
        vkCreateComputePipelines(device_->device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline));
    cleanup_.emplace_back(
        [device = device_->device, pipeline] { vkDestroyPipeline(device, pipeline, nullptr); });

    for (uint32_t f = 0; f < 8; ++f) {
        const FwVulkanFrame frame = frames_->begin(0.0625f);  // two steps
        const VkCommandBuffer commands = frame.commandBuffer;
        for (const bool before : {true, false}) {
            const uint32_t add = before ? 7 : 1000003 * (f + 1);
            VkMemoryBarrier barrier{};
            barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
            barrier.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT;
            barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
            vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                                 VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 1, &barrier, 0, nullptr,
                                 0, nullptr);
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
            vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 2, sets, 0,
                                    nullptr);
            vkCmdPushConstants(commands, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, 4, &add);
            vkCmdDispatch(commands, kCount / 64, 1, 1);
            if (before) {
                EXPECT_EQ(fwWorld_RecordOutside(world_, &frame, views_.data()), FW_OK);
            }
            for (uint32_t i = 0; i < kCount; ++i) want[i] = want[i] * 3 + in[i] + add;
        }
        toHost(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT);
        frames_->submit();
    }
    frames_->waitAll();
    EXPECT_EQ(std::memcmp(buffers[0].mapped, in.data(), kCount * 4), 0);
    EXPECT_EQ(std::memcmp(buffers[1].mapped, want.data(), kCount * 4), 0);
}

}  // namespace
}  // namespace fw::test
