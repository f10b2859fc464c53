// See fire_host.h.
#include "common/fire_host.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <string>

namespace sample {
namespace {

void FW_CALL printLog(void*, int32_t level, const char* message) {
    if (level < FW_LOG_WARNING) return;
    std::fprintf(stderr, "\nflamewright %s: %s\n", level >= FW_LOG_ERROR ? "error" : "warning",
                 message);
}

}  // namespace

void setCamera(FwView& view, const Camera& camera, const StageFrame& frame, bool reversed) {
    const float aspect =
        static_cast<float>(frame.extent.width) / static_cast<float>(frame.extent.height);
    const glm::mat4 matrix = viewMatrix(camera);
    const glm::mat4 projection = projectionMatrix(camera, aspect, reversed);
    std::memcpy(view.view, &matrix[0][0], sizeof view.view);
    std::memcpy(view.projection, &projection[0][0], sizeof view.projection);
    view.time = static_cast<float>(frame.time);
}

FwContext* createContext(const VulkanHost& host, bool prepares) {
    // Report every enabled feature and extension: the plugin treats unlisted ones as disabled.
    FwVulkanHost vulkanHost = fwDefaultVulkanHost();
    vulkanHost.apiVersion = host.made.apiVersion;
    vulkanHost.getInstanceProcAddr = vkGetInstanceProcAddr;
    vulkanHost.instance = host.instance;
    vulkanHost.physicalDevice = host.physicalDevice;
    vulkanHost.device = host.device;
    vulkanHost.queueFamilyIndex = host.queueFamily;
    vulkanHost.enabledExtensions = host.made.deviceExtensions.data();
    vulkanHost.enabledExtensionCount = static_cast<uint32_t>(host.made.deviceExtensions.size());
    vulkanHost.enabledInstanceExtensions = host.made.instanceExtensions.data();
    vulkanHost.enabledInstanceExtensionCount =
        static_cast<uint32_t>(host.made.instanceExtensions.size());
    vulkanHost.enabledFeatures = &host.made.features;
    vulkanHost.enabledFeatureChain = host.made.featureChain;

    FwContextDef def = fwDefaultContextDef();
    def.callbacks.log = printLog;
    def.vulkan = &vulkanHost;
    FwContext* context = nullptr;
    FwErrorInfo error{};
    if (fwCreateContext(&def, &context, &error) != FW_OK) {
        throw Failure(std::string("fwCreateContext: ") + error.message);
    }
    if (prepares && fwContext_Prepare(context) != FW_OK) {  // a loading screen would run this
        char text[512] = "";
        fwContext_GetLastMessage(context, text, sizeof text);
        fwDestroyContext(context);
        throw Failure(std::string("fwContext_Prepare: ") + text);
    }
    return context;
}

FwVulkanComposite describeComposite(const CapturedScene& scene, VkExtent2D extent) {
    FwVulkanComposite images = fwDefaultVulkanComposite();
    images.width = extent.width;
    images.height = extent.height;
    images.color.image = scene.color;
    images.color.view = scene.colorView;
    images.color.layoutBefore = images.color.layoutAfter = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    images.color.stageBefore = images.color.stageAfter = VK_PIPELINE_STAGE_TRANSFER_BIT;
    images.color.accessBefore = images.color.accessAfter = VK_ACCESS_TRANSFER_READ_BIT;
    images.depth.image = scene.depth;
    images.depth.view = scene.depthView;
    images.depth.layoutBefore = images.depth.layoutAfter =
        VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    images.depth.stageBefore = images.depth.stageAfter =
        VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
    images.depth.accessBefore = images.depth.accessAfter =
        VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    return images;
}

FireHost::FireHost(const VulkanHost& host, const FwWorldDef& worldDef)
    : context(createContext(host)), device_(host.device) {
    try {
        check(fwCreateWorld(context, &worldDef, &world), "fwCreateWorld");
    } catch (...) {
        fwDestroyContext(context);
        throw;
    }
}

FireHost::~FireHost() {
    vkDeviceWaitIdle(device_);
    fwDestroyContext(context);
}

void FireHost::registerTarget(const Stage& stage, bool surfaces) {
    for (FwTargetId* old : {&target, &overScene}) {
        if (old->index1 != 0) check(fwContext_UnregisterTarget(context, *old), "unregister");
        *old = {};
    }
    FwVulkanTargetDef def = fwDefaultVulkanTargetDef();
    def.renderPass = stage.scenePass;
    def.subpass = 0;
    def.colorFormat = stage.made.colorFormat;
    def.depthFormat = stage.depthFormat;
    def.samples = static_cast<uint32_t>(stage.made.samples);
    def.colorAttachmentCount = 1;
    def.depthMode = FW_DEPTH_TEST;
    def.reversedDepth = stage.made.reversedDepth ? 1u : 0u;
    def.encoding = FW_OUTPUT_DISPLAY_UNORM;
    if (stage.made.colorFormat == VK_FORMAT_R8G8B8A8_SRGB) def.encoding = FW_OUTPUT_SRGB_VIEW;
    if (stage.made.colorFormat == VK_FORMAT_R16G16B16A16_SFLOAT) def.encoding = FW_OUTPUT_LINEAR;
    def.flags = FW_TARGET_AS_NEEDED;
    if (stage.made.capturesScene) def.flags |= FW_TARGET_NO_FLAMES;
    if (!stage.made.capturesScene || surfaces)
        check(fwContext_RegisterTarget(context, &def, &target), "fwContext_RegisterTarget");
    if (stage.made.capturesScene) {
        def.renderPass = VK_NULL_HANDLE;
        def.flags = FW_TARGET_AS_NEEDED | FW_TARGET_COMPOSITE | FW_TARGET_HAZE;
        if (stage.made.halfEffects) def.flags |= FW_TARGET_HALF_EFFECTS;
        def.depthMode = FW_DEPTH_SAMPLED;
        check(fwContext_RegisterTarget(context, &def, &overScene), "fwContext_RegisterTarget");
    }
    check(fwContext_Prepare(context), "fwContext_Prepare");
}

FwVulkanFrame FireHost::describe(const StageFrame& frame, VkCommandBuffer secondary) const {
    FwVulkanFrame described = fwDefaultVulkanFrame();
    if (secondary) described.flags |= FW_FRAME_SECONDARY;
    described.commandBuffer = secondary ? secondary : frame.commands;
    described.frameIndex = frame.frameIndex;
    described.completedFrameIndex = frame.completedFrameIndex;
    if (slotPacing) {
        described.flags |= FW_FRAME_SLOT_PACING;
        described.completedFrameIndex = 0;
        described.frameSlot = frame.slot;
        described.framesInFlight = frame.framesInFlight;
    }
    described.deltaTime = frame.deltaTime;
    return described;
}

void FireHost::recordOutside(const StageFrame& frame, const FwView& view,
                             VkCommandBuffer secondary) {
    recordOutside(frame, {&view, 1}, secondary);
}

void FireHost::recordOutside(const StageFrame& frame, std::span<const FwView> views,
                             VkCommandBuffer secondary) {
    const FwVulkanFrame described = describe(frame, secondary);
    const FwResult result = fwWorld_RecordOutsideViews(world, &described, views.data(),
                                                       static_cast<uint32_t>(views.size()));
    if (result != FW_NOT_READY) check(result, "fwWorld_RecordOutsideViews");
    countPasses();
}

void FireHost::recordInside(const StageFrame& frame, const FwView& view,
                            VkCommandBuffer secondary) {
    if (target.index1 == 0) return;
    const FwVulkanFrame described = describe(frame, secondary);
    const FwResult result = fwWorld_RecordInside(world, &described, target, &view, &frame.viewport);
    if (result != FW_NOT_READY) check(result, "fwWorld_RecordInside");
}

void FireHost::recordOver(const StageFrame& frame, const FwView& view, const CapturedScene& scene) {
    FwVulkanFrame described = describe(frame, VK_NULL_HANDLE);
    described.sampledColor = scene.copy;
    described.sampledColorLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const FwVulkanComposite images = describeComposite(scene, frame.extent);
    const FwResult result = fwWorld_RecordComposite(world, &described, overScene, &view, &images);
    if (result != FW_NOT_READY) check(result, "fwWorld_RecordComposite");
}

void FireHost::check(FwResult result, const char* what) const {
    if (result == FW_OK || result == FW_NOTHING_THERE) return;
    // The world has the most specific message. During creation only the context exists.
    char text[1024] = "";
    if (world) fwWorld_GetLastMessage(world, text, sizeof text);
    if (!text[0]) fwContext_GetLastMessage(context, text, sizeof text);
    throw Failure(std::string(what) + ": " + (text[0] ? text : fwResultName(result)));
}

FwObjectState FireHost::objectState(FwBurnableMeshId object) const {
    FwObjectState state{};
    state.structSize = sizeof state;
    check(fwWorld_GetObjectState(world, object, &state), "fwWorld_GetObjectState");
    return state;
}

void FireHost::countPasses() {
    FwPassTime times[64];
    const uint32_t count = std::min(fwDebug_GetPassTimes(world, times, 64), 64u);
    if (count == 0 || times[0].frameIndex == lastTimed_) return;
    lastTimed_ = times[0].frameIndex;
    for (uint32_t i = 0; i < count; ++i) {
        auto found = std::find_if(costs_.begin(), costs_.end(),
                                  [&](const PassCost& cost) { return cost.name == times[i].name; });
        if (found == costs_.end()) found = costs_.insert(costs_.end(), {times[i].name, 0.0, 0});
        found->milliseconds =
            (found->milliseconds * found->frames + times[i].milliseconds) / (found->frames + 1);
        ++found->frames;
    }
}

}  // namespace sample
