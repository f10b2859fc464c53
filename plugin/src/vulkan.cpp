// Functions of flamewright_vulkan.h. The only file of this folder that uses Vulkan types.
#include "flamewright/flamewright_vulkan.h"

#include "components/appearance_table.h"
#include "components/appearance_textures.h"
#include "components/volumetric_fire.h"
#include "gpu/vk/vk_backend.h"
#include "objects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <span>

using namespace fw;
using edge::checkPointer;
using edge::onContext;
using edge::onWorld;

#define FW_EACH_VULKAN_DEF(ROW)                           \
    ROW(FwVulkanHost, FW_DEF_VULKAN_HOST)                 \
    ROW(FwVulkanTargetDef, FW_DEF_VULKAN_TARGET)          \
    ROW(FwVulkanFrame, FW_DEF_VULKAN_FRAME)               \
    ROW(FwVulkanRequirements, FW_DEF_VULKAN_REQUIREMENTS) \
    ROW(FwVulkanComposite, FW_DEF_VULKAN_COMPOSITE)       \
    ROW(FwVulkanVertices, FW_DEF_VULKAN_VERTICES)

namespace fw::edge {

FW_EACH_VULKAN_DEF(FW_STRUCT)
FW_STRUCT(FwPipelineProgress, 0)

namespace {

void defaults(FwVulkanHost& def) noexcept { def.apiVersion = VK_API_VERSION_1_0; }
void defaults(FwVulkanTargetDef& def) noexcept {
    def.samples = 1;
    def.colorAttachmentCount = 1;
    def.depthMode = FW_DEPTH_TEST;
    def.encoding = FW_OUTPUT_AUTO;
}
void defaults(FwVulkanFrame&) noexcept {}
void defaults(FwVulkanRequirements& def) noexcept { def.minimumApiVersion = VK_API_VERSION_1_0; }
void defaults(FwVulkanComposite&) noexcept {}
void defaults(FwVulkanVertices& def) noexcept { def.stride = 12; }

#define FW_ROW(T, number) {number, sizeof(T), &writeDefaultsOf<T, defaults>, nullptr},
constexpr DefRow kVulkanDefs[] = {FW_EACH_VULKAN_DEF(FW_ROW)};
#undef FW_ROW

// Advances the world in a frame that has begun; ends its outside views if that fails.
void advance(world::World& world, gpu::vk::VkBackend& backend, uint64_t frame, float deltaTime) {
    try {
        world.advance(frame, deltaTime);
    } catch (...) {
        backend.cancelOutside();
        throw;
    }
}

class VulkanDevice final : public Device {
 public:
    VulkanDevice(const FwVulkanHost* host, uint64_t budget, core::Memory& memory,
                 const core::Log& log)
        : memory_(memory),
          log_(log),
          context_(host, budget, &memory, log),
          appearanceTextures_(&memory),
          fireProfiles_(components::bakeFireProfiles(&memory)) {}

    gpu::Backend* createBackend(const FwWorldDef& def) override {
        gpu::vk::WorldLimits limits;
        limits.maxLights = def.maxLights;
        limits.maxFlames = def.maxFlames;
        limits.maxRefinedTriangles = def.maxRefinedTriangles;
        limits.volumePixelSize = def.volumePixelSize;
        limits.rayStepCount = def.rayStepCount;
        limits.seed = def.seed;
        std::copy_n(def.up, 3, limits.up);
        limits.paceFactor = def.paceFactor;
        limits.appearances.table = components::materialAppearances();
        limits.appearances.families = components::materialFamilies();
        limits.appearances.textures = appearanceTextures();
        limits.appearances.profiles = fireProfiles_;
        return std::pmr::polymorphic_allocator<>(&memory_).new_object<gpu::vk::VkBackend>(
            context_, limits, &memory_, log_);
    }
    void destroyBackend(gpu::Backend* backend) noexcept override {
        std::pmr::polymorphic_allocator<>(&memory_).delete_object(
            static_cast<gpu::vk::VkBackend*>(backend));
    }
    void fillInfo(FwContextInfo& info) const noexcept override { context_.fillInfo(info); }
    void memoryRows(std::pmr::vector<gpu::MemoryRow>& out) const override {
        context_.memoryRows(out);
    }
    void checkTarget(FwTargetId id) override {
        FwPipelineProgress unused{};
        (void)context_.targetReady(id, unused);
    }
    void unregisterTarget(FwTargetId id) override { context_.unregisterTarget(id); }
    void prepare() override {
        appearanceTextures();
        context_.prepare();
    }
    void step(gpu::Backend& given, world::World& world, float deltaTime) override {
        requireOwn();
        components::checkValue(deltaTime, "deltaTime", 0.0f, 10.0f);
        auto& backend = static_cast<gpu::vk::VkBackend&>(given);
        backend.beginOwn();
        advance(world, backend, world.lastFrame() + 1, deltaTime);
        backend.endOwn();
        world.collect();  // the submit has finished, so its readback is available
    }
    void renderOffscreen(gpu::Backend& backend, const FwOffscreenDef& def) override {
        requireOwn();
        static_cast<gpu::vk::VkBackend&>(backend).renderOffscreen(def);
    }
    [[nodiscard]] bool answersAtOnce() const noexcept override { return false; }
    void destroy() noexcept override {
        std::pmr::polymorphic_allocator<>(&memory_).delete_object(this);
    }

    gpu::vk::Context& context() noexcept { return context_; }

 private:
    // Baking takes 1/6 s, so the first world or fwContext_Prepare does it. Several threads may
    // create worlds.
    const std::pmr::vector<std::byte>& appearanceTextures() {
        const std::lock_guard lock(appearancesMutex_);
        if (appearanceTextures_.empty())
            appearanceTextures_ = components::bakeAppearanceTextures(&memory_);
        return appearanceTextures_;
    }
    void requireOwn() const {
        if (!context_.ownDevice())
            core::fail(FW_ERROR_WRONG_BACKEND,
                       "The context uses the host's device; record with fwWorld_RecordOutside and "
                       "submit the command buffer.");
    }

    core::Memory& memory_;
    const core::Log& log_;
    gpu::vk::Context context_;
    // Kept for later worlds: a backend copies them at its creation.
    std::mutex appearancesMutex_;
    std::pmr::vector<std::byte> appearanceTextures_, fireProfiles_;
};

VulkanDevice& vulkanOf(FwContext& context) {
    if (context.backend != FW_BACKEND_VULKAN)
        core::fail(FW_ERROR_WRONG_BACKEND,
                   "The context is on the cpu backend; the call needs FW_BACKEND_VULKAN.");
    return static_cast<VulkanDevice&>(*context.device);
}

// The backend of a world on a host device.
gpu::vk::VkBackend& hostBackendOf(FwWorld& world) {
    if (vulkanOf(*world.context).context().ownDevice())
        core::fail(FW_ERROR_WRONG_BACKEND,
                   "The context has its own device; use fwWorld_Step and "
                   "fwWorld_RenderOffscreen, or give a device in FwContextDef::vulkan.");
    return static_cast<gpu::vk::VkBackend&>(*world.backend);
}

void checkHost(const FwVulkanHost& host) {
    checkPointer(host.getInstanceProcAddr, "FwVulkanHost::getInstanceProcAddr");
    checkPointer(host.instance, "FwVulkanHost::instance");
    checkPointer(host.physicalDevice, "FwVulkanHost::physicalDevice");
    checkPointer(host.device, "FwVulkanHost::device");
    const auto names = [](uint32_t count, const char* const* list, const char* field) {
        if (count == 0) return;
        if (count > 4096) core::refuse("%sCount is %u; the limit is 4096.", field, count);
        checkPointer(list, field);
        for (uint32_t i = 0; i < count; ++i)
            if (!list[i]) core::refuse("%s[%u] is null.", field, i);
    };
    names(host.enabledExtensionCount, host.enabledExtensions, "FwVulkanHost::enabledExtensions");
    names(host.enabledInstanceExtensionCount, host.enabledInstanceExtensions,
          "FwVulkanHost::enabledInstanceExtensions");
}

void checkScissor(const VkRect2D& scissor) {
    using components::checkValue, components::checkWhole;
    checkValue(float(scissor.offset.x), "FwVulkanFrame::scissor.offset.x", 0, 32768);
    checkValue(float(scissor.offset.y), "FwVulkanFrame::scissor.offset.y", 0, 32768);
    checkWhole(scissor.extent.width, "FwVulkanFrame::scissor.extent.width", 0, 32768);
    checkWhole(scissor.extent.height, "FwVulkanFrame::scissor.extent.height", 0, 32768);
    if ((scissor.extent.width == 0) != (scissor.extent.height == 0))
        core::refuse(
            "FwVulkanFrame::scissor.extent is %u x %u; both are 0 (no scissor) or neither. "
            "Where nothing is to be drawn leave out the call.",
            scissor.extent.width, scissor.extent.height);
}

FwVulkanFrame checkedFrame(const FwVulkanFrame* given) {
    using components::checkWhole;
    const FwVulkanFrame frame = readDef(given);
    components::checkFlags(frame.flags, "FwVulkanFrame::flags",
                           FW_FRAME_SECONDARY | FW_FRAME_SLOT_PACING);
    checkPointer(frame.commandBuffer, "FwVulkanFrame::commandBuffer");
    for (const uint32_t word : {frame.reserved, frame.reserved1})
        if (word != 0)
            core::refuse("FwVulkanFrame::reserved%s is %u; it is zero.",
                         frame.reserved == 0 ? "1" : "", word);
    checkScissor(frame.scissor);
    components::checkValue(frame.transparency, "FwVulkanFrame::transparency", 0.0f, 1.0f);
    if (frame.frameIndex == 0) core::refuse("FwVulkanFrame::frameIndex is 0; it starts at 1.");
    if (frame.flags & FW_FRAME_SLOT_PACING) {
        checkWhole(frame.framesInFlight, "FwVulkanFrame::framesInFlight", 1, 16);
        if (frame.frameSlot >= frame.framesInFlight)
            core::refuse(
                "FwVulkanFrame::frameSlot is %u and framesInFlight is %u; the slot is "
                "smaller.",
                frame.frameSlot, frame.framesInFlight);
    } else if (frame.completedFrameIndex >= frame.frameIndex) {
        core::refuse(
            "FwVulkanFrame::completedFrameIndex is %llu and frameIndex is %llu; a frame "
            "cannot be complete before it is recorded.",
            static_cast<unsigned long long>(frame.completedFrameIndex),
            static_cast<unsigned long long>(frame.frameIndex));
    }
    return frame;
}

// Read by fwWorld_DestroyAfterFrame on any thread.
void recordFrameUse(FwWorld& world, const FwVulkanFrame& frame) noexcept {
    if (frame.frameIndex > world.newestFrame) world.newestFrame = frame.frameIndex;
}

FwView checkedView(const FwWorld& world, const FwView* given) {
    FwView view = readDef(given);
    validatedView(world.unit, view, "FwView");
    return view;
}

// The stride is the host's structSize, which may be smaller or larger than the library's.
std::span<FwView> checkedViews(const FwWorld& world, const FwView* given, uint32_t count,
                               std::array<FwView, FW_MAX_VIEWS>& out) {
    static_assert(FW_MAX_VIEWS == gpu::kMaxViews);
    checkPointer(given, "views");
    components::checkWhole(count, "viewCount", 1, FW_MAX_VIEWS);
    const uint32_t stride = given->structSize;
    for (uint32_t i = 0; i < count; ++i) {
        char name[24];
        std::snprintf(name, sizeof name, "views[%u]", i);
        const auto* bytes = reinterpret_cast<const std::byte*>(given) + size_t(i) * stride;
        out[i] = readDef(reinterpret_cast<const FwView*>(bytes));
        uint32_t size = 0;
        std::memcpy(&size, bytes, sizeof size);
        if (size != stride)
            core::refuse(
                "views[%u].structSize is %u and views[0].structSize is %u; it is the array's "
                "stride, so it is the same in all.",
                i, size, stride);
        validatedView(world.unit, out[i], name);
        for (uint32_t j = 0; j < i; ++j)
            if (out[j].viewId == out[i].viewId)
                core::refuse(
                    "views[%u].viewId and views[%u].viewId are both %u; give each view of a "
                    "frame its own number.",
                    j, i, out[i].viewId);
    }
    return std::span(out).first(count);
}

FwResult recordOutside(FwWorld& world, gpu::vk::VkBackend& backend, const FwVulkanFrame& frame,
                       std::span<const FwView> views) {
    world::World& w = *world.world;
    w.checkFrame(frame.frameIndex, frame.deltaTime);
    recordFrameUse(world, frame);
    destroyDoomed(world);
    if (!backend.beginOutside(frame, views)) return FW_NOT_READY;
    advance(w, backend, frame.frameIndex, frame.deltaTime);
    backend.endOutside();
    publish(world);
    return FW_OK;
}

// Runs body(backend, frame) of a call that records a frame of the host's.
template <class Body>
FwResult recordFrame(const char* function, FwWorld* world, const FwVulkanFrame* given,
                     const Body& body) noexcept {
    return onWorld(function, world, [&](world::World& w) {
        const Stopwatch time(w);
        gpu::vk::VkBackend& backend = hostBackendOf(*world);
        return body(backend, checkedFrame(given));
    });
}

const char* encodingName(uint32_t encoding) noexcept {
    return encoding == FW_OUTPUT_LINEAR      ? "FW_OUTPUT_LINEAR (0)"
           : encoding == FW_OUTPUT_SRGB_VIEW ? "FW_OUTPUT_SRGB_VIEW (1)"
                                             : "FW_OUTPUT_DISPLAY_UNORM (2)";
}

// A contradiction would only show as too dark or too bright a fire.
void checkEncoding(const FwVulkanTargetDef& def, const core::Log& log) {
    const uint32_t asked = gpu::vk::Context::encodingOf(def.colorFormat);
    if (def.encoding == FW_OUTPUT_AUTO || def.encoding == asked) return;
    if (asked == FW_OUTPUT_AUTO) {
        log.write(FW_LOG_WARNING,
                  "FwVulkanTargetDef::colorFormat is %d, which is not known to be float, sRGB or "
                  "UNORM; %s is used as given.",
                  int(def.colorFormat), encodingName(def.encoding));
        return;
    }
    core::refuse(
        "FwVulkanTargetDef::encoding is %s and colorFormat is %d, %s; use %s or "
        "FW_OUTPUT_AUTO (3).",
        encodingName(def.encoding), int(def.colorFormat),
        asked == FW_OUTPUT_LINEAR      ? "a float format"
        : asked == FW_OUTPUT_SRGB_VIEW ? "an sRGB format, which encodes by itself"
                                       : "a UNORM format, which ends at 1 and encodes nothing",
        encodingName(asked));
}

// Surfaces need written depth to hide each other.
void checkSurfaces(const FwVulkanTargetDef& def, const core::Log& log) {
    if (def.flags & FW_TARGET_NO_SURFACES) return;
    if (def.depthMode == FW_DEPTH_TEST_ONLY)
        core::refuse(
            "FwVulkanTargetDef::depthMode is FW_DEPTH_TEST_ONLY (2) and flags is 0x%x; "
            "surfaces that write no depth show their far sides. Use FW_DEPTH_TEST (1), or "
            "FW_TARGET_NO_SURFACES (4) and a target of another mode for them.",
            def.flags);
    if (def.depthMode == FW_DEPTH_NONE)
        log.write(FW_LOG_WARNING,
                  "FwVulkanTargetDef::depthMode is FW_DEPTH_NONE without FW_TARGET_NO_SURFACES; "
                  "meshes that overlap on the screen show their far sides.");
}

void checkTarget(const FwVulkanTargetDef& def, const core::Log& log) {
    constexpr uint32_t kNothing = FW_TARGET_NO_FLAMES | FW_TARGET_NO_SURFACES;
    components::checkFlags(def.flags, "FwVulkanTargetDef::flags",
                           FW_TARGET_COMPOSITE | kNothing | FW_TARGET_HAZE |
                               FW_TARGET_HALF_EFFECTS | FW_TARGET_AS_NEEDED |
                               FW_TARGET_TRANSPARENCY);
    const bool composite = (def.flags & FW_TARGET_COMPOSITE) != 0;
    const bool sampled = def.depthMode == FW_DEPTH_SAMPLED;
    if ((def.flags & FW_TARGET_HALF_EFFECTS) && !(sampled && composite))
        core::refuse(
            "FwVulkanTargetDef::flags is 0x%x and depthMode is %u; FW_TARGET_HALF_EFFECTS "
            "needs FW_TARGET_COMPOSITE and FW_DEPTH_SAMPLED (3).",
            def.flags, def.depthMode);
    if ((def.flags & FW_TARGET_HAZE) && !sampled)
        core::refuse(
            "FwVulkanTargetDef::flags has FW_TARGET_HAZE and depthMode is %u; haze needs "
            "FW_DEPTH_SAMPLED (3), or foreground would smear into it.",
            def.depthMode);
    if ((def.flags & kNothing) == kNothing)
        core::refuse(
            "FwVulkanTargetDef::flags is 0x%x; FW_TARGET_NO_FLAMES and "
            "FW_TARGET_NO_SURFACES together leave nothing to draw.",
            def.flags);
    if (!composite) checkPointer(def.renderPass, "FwVulkanTargetDef::renderPass");
    const struct {
        uint32_t value;
        const char* name;
        uint32_t low, most;
        bool isPower;  // of two, or 0
    } limits[] = {
        {def.samples, "FwVulkanTargetDef::samples", 1, 16, true},
        {def.depthSamples, "FwVulkanTargetDef::depthSamples", 0, 16, true},
        {def.colorAttachmentCount, "FwVulkanTargetDef::colorAttachmentCount", 1, 8, false},
        {def.viewMask, "FwVulkanTargetDef::viewMask", 0, 0, false},
        {def.depthMode, "FwVulkanTargetDef::depthMode", 0, FW_DEPTH_SAMPLED, false},
        {def.reversedDepth, "FwVulkanTargetDef::reversedDepth", 0, 1, false},
        {def.encoding, "FwVulkanTargetDef::encoding", 0, FW_OUTPUT_AUTO, false},
        {composite ? def.subpass : 0, "FwVulkanTargetDef::subpass", 0, 0, false},
    };
    for (const auto& one : limits) {
        components::checkWhole(one.value, one.name, one.low, one.most);
        if (one.isPower && (one.value & (one.value - 1)))
            core::refuse("%s is %u; it is a power of two in [%u, %u].", one.name, one.value,
                         one.low, one.most);
    }
    if (sampled && (def.flags & FW_TARGET_NO_FLAMES))
        core::refuse(
            "FwVulkanTargetDef::flags has FW_TARGET_NO_FLAMES and depthMode is "
            "FW_DEPTH_SAMPLED, which draws flames alone.");
    if (def.depthSamples && !sampled)
        core::refuse(
            "FwVulkanTargetDef::depthSamples is %u and depthMode is %u; it is for "
            "FW_DEPTH_SAMPLED alone.",
            def.depthSamples, def.depthMode);
    if (def.colorFormat == VK_FORMAT_UNDEFINED)
        core::refuse("FwVulkanTargetDef::colorFormat is VK_FORMAT_UNDEFINED.");
    if ((def.depthMode != FW_DEPTH_NONE) != (def.depthFormat != VK_FORMAT_UNDEFINED))
        core::refuse(
            "FwVulkanTargetDef::depthMode is %u and depthFormat is %d; a format is given if "
            "and only if there is depth.",
            def.depthMode, int(def.depthFormat));
    checkEncoding(def, log);
    checkSurfaces(def, log);
}

void checkVertices(const FwVulkanVertices& def) {
    checkPointer(def.buffer, "FwVulkanVertices::buffer");
    const auto limit = [](uint32_t value, const char* field) {
        if (value < 12 || value > 2048 || value % 4 != 0)
            core::refuse("FwVulkanVertices::%s is %u; it is a multiple of 4 in [12, 2048].", field,
                         value);
    };
    limit(def.stride, "stride");
    if (def.normalOffset) limit(def.normalOffset, "normalOffset");
    const auto stages = [](VkPipelineStageFlags given, const char* field, const char* which) {
        if (given == 0)
            core::refuse("FwVulkanVertices::%s is 0; name the stages that %s the buffer.", field,
                         which);
    };
    stages(def.stageBefore, "stageBefore", "wrote");
    stages(def.stageAfter, "stageAfter", "use");
    if (def.offset % 4 != 0)
        core::refuse("FwVulkanVertices::offset is %llu; it is a multiple of 4.",
                     static_cast<unsigned long long>(def.offset));
}

// False: the viewport is empty.
bool checkViewport(const VkViewport* given) {
    checkPointer(given, "viewport");
    components::checkValue(given->x, "viewport->x", -32768, 32767);
    components::checkValue(given->y, "viewport->y", -32768, 32767);
    components::checkValue(given->width, "viewport->width", 0, 32768);
    components::checkValue(given->height, "viewport->height", 0, 32768);
    components::checkValue(given->minDepth, "viewport->minDepth", 0, 1);
    components::checkValue(given->maxDepth, "viewport->maxDepth", 0, 1);
    return given->width > 0 && given->height > 0;
}

}  // namespace

std::span<const DefRow> vulkanDefRows() noexcept { return kVulkanDefs; }

Device* createVulkanDevice(const FwVulkanHost* given, uint64_t gpuMemoryBudget,
                           core::Memory& memory, const core::Log& log) {
    FwVulkanHost host;
    if (given) {
        host = readDef(given);
        checkHost(host);
    }
    return std::pmr::polymorphic_allocator<>(&memory).new_object<VulkanDevice>(
        given ? &host : nullptr, gpuMemoryBudget, memory, log);
}

}  // namespace fw::edge

extern "C" {

FwResult FW_CALL fwQueryVulkanRequirements(FwVulkanRequirements* requirements) {
    return edge::guardAlone(__func__, [&] {
        const uint32_t size = edge::checkInfo(requirements);
        FwVulkanRequirements filled{};
        edge::defaults(filled);
        gpu::vk::Context::requirements(filled);
        edge::writeInfo(requirements, size, filled);
    });
}

FwResult FW_CALL fwContext_RegisterTarget(FwContext* context, const FwVulkanTargetDef* given,
                                          FwTargetId* id) {
    return onContext(__func__, context, [&](FwContext& c) {
        checkPointer(id, "id");
        *id = {};
        auto& device = edge::vulkanOf(c);
        const FwVulkanTargetDef def = edge::readDef(given);
        edge::checkTarget(def, c.log);
        *id = device.context().registerTarget(def);
    });
}

FwResult FW_CALL fwContext_UnregisterTarget(FwContext* context, FwTargetId id) {
    return onContext(__func__, context, [&](FwContext& c) {
        edge::vulkanOf(c).context().unregisterTarget(id);
        const std::lock_guard lock(c.mutex);
        std::erase_if(c.deferred, [&](const edge::Deferred& one) {
            return one.target.index1 == id.index1 && one.target.generation == id.generation;
        });
        return FW_OK;
    });
}

FwResult FW_CALL fwTarget_IsReady(FwContext* context, FwTargetId id, FwPipelineProgress* progress) {
    return onContext(__func__, context, [&](FwContext& c) {
        const uint32_t size = progress ? edge::checkInfo(progress) : 0;
        FwPipelineProgress filled{};
        const bool ready = edge::vulkanOf(c).context().targetReady(id, filled);
        if (progress) edge::writeInfo(progress, size, filled);
        return ready ? FW_OK : FW_NOT_READY;
    });
}

void FW_CALL fwContext_NotifyDeviceLost(FwContext* context) {
    (void)onContext(__func__, context, [&](FwContext& c) {
        if (c.backend == FW_BACKEND_VULKAN) edge::vulkanOf(c).context().notifyDeviceLost();
    });
}

FwResult FW_CALL fwWorld_RecordOutside(FwWorld* world, const FwVulkanFrame* givenFrame,
                                       const FwView* givenView) {
    return edge::recordFrame(__func__, world, givenFrame, [&](auto& backend, const auto& frame) {
        const FwView view = edge::checkedView(*world, givenView);
        return edge::recordOutside(*world, backend, frame, {&view, 1});
    });
}

FwResult FW_CALL fwWorld_RecordOutsideViews(FwWorld* world, const FwVulkanFrame* givenFrame,
                                            const FwView* givenViews, uint32_t viewCount) {
    return edge::recordFrame(__func__, world, givenFrame, [&](auto& backend, const auto& frame) {
        std::array<FwView, FW_MAX_VIEWS> views;
        const std::span<FwView> checked = edge::checkedViews(*world, givenViews, viewCount, views);
        return edge::recordOutside(*world, backend, frame, checked);
    });
}

FwResult FW_CALL fwWorld_RecordInside(FwWorld* world, const FwVulkanFrame* givenFrame,
                                      FwTargetId target, const FwView* givenView,
                                      const VkViewport* viewport) {
    return edge::recordFrame(__func__, world, givenFrame, [&](auto& backend, const auto& frame) {
        const FwView view = edge::checkedView(*world, givenView);
        if (!edge::checkViewport(viewport)) return FW_OK;
        edge::recordFrameUse(*world, frame);
        return backend.recordInside(frame, target, view, *viewport) ? FW_OK : FW_NOT_READY;
    });
}

FwResult FW_CALL fwWorld_SetVertexBuffer(FwWorld* world, FwBurnableMeshId id,
                                         const FwVulkanVertices* given) {
    return onWorld(__func__, world, [&](world::World& w) {
        gpu::vk::VkBackend& backend = edge::hostBackendOf(*world);
        const FwVulkanVertices def = edge::readDef(given);
        edge::checkVertices(def);
        backend.setVertexBuffer(w.scene().skinnedSlot(id, def.vertexCount), def,
                                float(edge::objectUnit(*world, id).inverse().perMetre()));
    });
}

FwResult FW_CALL fwWorld_RecordComposite(FwWorld* world, const FwVulkanFrame* givenFrame,
                                         FwTargetId target, const FwView* givenView,
                                         const FwVulkanComposite* givenImages) {
    return edge::recordFrame(__func__, world, givenFrame, [&](auto& backend, const auto& frame) {
        const FwView view = edge::checkedView(*world, givenView);
        const FwVulkanComposite images = edge::readDef(givenImages);
        if (images.flags & ~uint32_t(FW_COMPOSITE_KEEP))
            core::refuse("FwVulkanComposite::flags is 0x%x; only bit 0 is known.", images.flags);
        if (frame.flags & FW_FRAME_SECONDARY)
            core::refuse(
                "FwVulkanFrame::flags has FW_FRAME_SECONDARY; a composite begins a render "
                "pass, which needs a primary command buffer.");
        edge::recordFrameUse(*world, frame);
        if (images.width == 0 || images.height == 0) return FW_OK;
        if (images.width > 32768 || images.height > 32768)
            core::refuse("FwVulkanComposite is %u x %u pixels; the limit is 32768.", images.width,
                         images.height);
        checkPointer(images.color.image, "FwVulkanComposite::color.image");
        checkPointer(images.color.view, "FwVulkanComposite::color.view");
        return backend.recordComposite(frame, target, view, images) ? FW_OK : FW_NOT_READY;
    });
}

}  // extern "C"
