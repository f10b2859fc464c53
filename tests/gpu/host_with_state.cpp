#include "gpu/host_with_state.h"

#include "support/burnable.h"

namespace fw::test {
namespace {

#include "host.frag.inc"
#include "host.vert.inc"

}  // namespace

// A burning ball in the middle of the picture.
void HostWithState::makeWorld() {
    const FwWorldDef worldDef = fwDefaultWorldDef();
    ASSERT_EQ(fwCreateWorld(context_, &worldDef, &world_), FW_OK);
    const Mesh ball = makeCube(1.0, 6, true, false);
    FwMeshDef mesh = fwDefaultMeshDef();
    mesh.positions = ball.positions.data();
    mesh.indices = ball.indices.data();
    mesh.vertexCount = ball.vertexCount();
    mesh.indexCount = uint32_t(ball.indices.size());
    mesh.texelsPerMetre = 48;
    (void)addBurnable(world_, mesh, FW_MATERIAL_PAPER);
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

VkShaderModule HostWithState::makeModule(const uint32_t* words, size_t bytes) {
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = bytes;
    info.pCode = words;
    return made(vkCreateShaderModule, vkDestroyShaderModule, info);
}

// Two sets of one buffer each and push constants, for drawing and for computing.
void HostWithState::makeLayouts() {
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
    layout_ =
        makeLayout(VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                   VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 20, uniforms, sets_);

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
    // A host that does not rebind its indices draws with ours: they must not read past its
    // vertices.
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
        depthFormat_ = VK_FORMAT_D24_UNORM_S8_UINT;  // one of the two always exists
    VkQueryPoolCreateInfo queries{};
    queries.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    queries.queryType = VK_QUERY_TYPE_OCCLUSION;
    queries.queryCount = 3;
    queries_ = made(vkCreateQueryPool, vkDestroyQueryPool, queries);
}

VkPipelineLayout HostWithState::makeLayout(VkDescriptorType type, VkShaderStageFlags stages,
                                           uint32_t push, const TestBuffer (&buffers)[2],
                                           VkDescriptorSet (&sets)[2]) {
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

VkPipeline HostWithState::makePipeline(const Case& one, VkRenderPass pass) {
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
    FW_MUST(
        vkCreateGraphicsPipelines(device_->device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline));
    cleanup_.emplace_back(
        [device = device_->device, pipeline] { vkDestroyPipeline(device, pipeline, nullptr); });
    return pipeline;
}

VkRenderPass HostWithState::makePass(const Case& one) {
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

HostWithState::Stage HostWithState::makeStage(const Case& one) {
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
    def.flags = FW_TARGET_AS_NEEDED;
    EXPECT_EQ(fwContext_RegisterTarget(context_, &def, &stage.target), FW_OK);
    return stage;
}

}  // namespace fw::test
