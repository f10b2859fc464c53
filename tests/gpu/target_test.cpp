// Targets, views and frames as the C edge checks them on a host device: an error that would only
// show as a wrong picture is refused or reported.
#include "support/host_context.h"
#include "support/views.h"

#include <gmock/gmock.h>

#include <functional>
#include <limits>
#include <thread>

namespace fw::test {
namespace {

using testing::HasSubstr;

class Targets : public HostContext {
 protected:
    void TearDown() override {
        destroyContext();
        if (pass_) vkDestroyRenderPass(device_->device, pass_, nullptr);
        GpuTest::TearDown();
    }

    // Surfaces only, created as needed: fast, because no object needs any.
    static FwVulkanTargetDef surfacesOver(VkFormat color) {
        FwVulkanTargetDef def = fwDefaultVulkanTargetDef();
        def.flags = FW_TARGET_COMPOSITE | FW_TARGET_NO_FLAMES | FW_TARGET_AS_NEEDED;
        def.colorFormat = color;
        def.depthFormat = VK_FORMAT_D32_SFLOAT;
        return def;
    }
    static FwVulkanTargetDef flamesOver(VkFormat color) {
        FwVulkanTargetDef def = surfacesOver(color);
        def.flags = FW_TARGET_COMPOSITE | FW_TARGET_NO_SURFACES;
        return def;
    }
    // The message of a refusal; empty if the target was registered, which is undone at once.
    std::string refusal(const FwVulkanTargetDef& def) {
        FwTargetId id{};
        const FwResult result = fwContext_RegisterTarget(context_, &def, &id);
        if (result == FW_OK) {
            EXPECT_EQ(FW_OK, fwContext_UnregisterTarget(context_, id));
            return {};
        }
        char text[512] = "";
        (void)fwContext_GetLastMessage(context_, text, sizeof text);
        return text;
    }
    [[nodiscard]] bool blends(VkFormat color) const {
        VkFormatProperties format{};
        vkGetPhysicalDeviceFormatProperties(device_->physicalDevice, color, &format);
        return (format.optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT) != 0;
    }

    VkRenderPass pass_ = VK_NULL_HANDLE;
};

TEST_F(Targets, EncodingMustFitTheFormat) {
    if (!device_) return;
    const struct {
        VkFormat color;
        FwOutputEncoding fits;
    } formats[] = {{VK_FORMAT_R8G8B8A8_UNORM, FW_OUTPUT_DISPLAY_UNORM},
                   {VK_FORMAT_B8G8R8A8_UNORM, FW_OUTPUT_DISPLAY_UNORM},
                   {VK_FORMAT_A2B10G10R10_UNORM_PACK32, FW_OUTPUT_DISPLAY_UNORM},
                   {VK_FORMAT_R8G8B8A8_SRGB, FW_OUTPUT_SRGB_VIEW},
                   {VK_FORMAT_B8G8R8A8_SRGB, FW_OUTPUT_SRGB_VIEW},
                   {VK_FORMAT_R16G16B16A16_SFLOAT, FW_OUTPUT_LINEAR},
                   {VK_FORMAT_B10G11R11_UFLOAT_PACK32, FW_OUTPUT_LINEAR}};
    for (const auto& format : formats) {
        if (!blends(format.color)) continue;
        FwVulkanTargetDef def = surfacesOver(format.color);
        EXPECT_EQ(uint32_t(FW_OUTPUT_AUTO), def.encoding) << "the default encoding";
        EXPECT_EQ("", refusal(def)) << format.color;
        for (uint32_t encoding = 0; encoding < 3; ++encoding) {
            def.encoding = encoding;
            if (encoding == uint32_t(format.fits))
                EXPECT_EQ("", refusal(def)) << format.color;
            else
                EXPECT_THAT(refusal(def),
                            AllOf(HasSubstr("FwVulkanTargetDef::encoding is FW_OUTPUT_"),
                                  HasSubstr(std::to_string(format.color)),
                                  HasSubstr("or FW_OUTPUT_AUTO (3)")));
        }
    }
    EXPECT_EQ("", warnings_);
    // An unknown format: the host must state the encoding, and the message says so.
    FwVulkanTargetDef odd = surfacesOver(VK_FORMAT_R8G8B8A8_SNORM);
    if (!blends(odd.colorFormat)) return;
    EXPECT_THAT(refusal(odd),
                HasSubstr("is not known to be float, sRGB or UNORM; name the encoding"));
    odd.encoding = FW_OUTPUT_LINEAR;
    EXPECT_EQ("", refusal(odd));
    EXPECT_THAT(warnings_, HasSubstr("FW_OUTPUT_LINEAR (0) is used as given"));
}

TEST_F(Targets, SurfacesNeedAWritableDepth) {
    if (!device_) return;
    FwVulkanTargetDef def = flamesOver(VK_FORMAT_R8G8B8A8_UNORM);
    def.depthMode = FW_DEPTH_TEST_ONLY;
    EXPECT_EQ("", refusal(def)) << "flames only";
    def = surfacesOver(VK_FORMAT_R8G8B8A8_UNORM);
    def.depthMode = FW_DEPTH_TEST_ONLY;
    EXPECT_THAT(refusal(def), HasSubstr("surfaces that write no depth show their far sides"));
    EXPECT_EQ("", warnings_);
    // Flat sheets are correct without depth, so this is reported and not refused.
    def.depthMode = FW_DEPTH_NONE;
    def.depthFormat = VK_FORMAT_UNDEFINED;
    EXPECT_EQ("", refusal(def));
    EXPECT_THAT(warnings_, HasSubstr("FW_DEPTH_NONE without FW_TARGET_NO_SURFACES"));
}

TEST_F(Targets, PassInfoRefusesWrongFields) {
    if (!device_) return;
    VkAttachmentDescription attachments[2]{};
    for (VkAttachmentDescription& one : attachments) {
        one.samples = VK_SAMPLE_COUNT_4_BIT;
        one.loadOp = one.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
        one.storeOp = one.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    }
    attachments[0].format = VK_FORMAT_D32_SFLOAT;  // colour comes second
    attachments[0].finalLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    attachments[1].format = VK_FORMAT_R8G8B8A8_UNORM;
    attachments[1].finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    const VkAttachmentReference color{1, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depth{0, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &color;
    subpass.pDepthStencilAttachment = &depth;
    VkRenderPassCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    info.attachmentCount = 2;
    info.pAttachments = attachments;
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    ASSERT_EQ(VK_SUCCESS, vkCreateRenderPass(device_->device, &info, nullptr, &pass_));

    FwVulkanTargetDef right = fwDefaultVulkanTargetDef();
    right.flags = FW_TARGET_NO_FLAMES | FW_TARGET_AS_NEEDED;
    right.renderPass = pass_;
    right.renderPassInfo = &info;
    right.colorFormat = VK_FORMAT_R8G8B8A8_UNORM;
    right.depthFormat = VK_FORMAT_D32_SFLOAT;
    right.samples = 4;
    EXPECT_EQ("", refusal(right));
    const auto wrong = [&](const std::function<void(FwVulkanTargetDef&)>& spoil) {
        FwVulkanTargetDef def = right;
        spoil(def);
        return refusal(def);
    };
    EXPECT_THAT(wrong([](auto& d) { d.samples = 1; }),
                HasSubstr("FwVulkanTargetDef::samples is 1 and the pass of renderPassInfo has 4"));
    EXPECT_THAT(wrong([](auto& d) { d.colorFormat = VK_FORMAT_B8G8R8A8_UNORM; }),
                HasSubstr("FwVulkanTargetDef::colorFormat is 44"));
    EXPECT_THAT(wrong([](auto& d) { d.depthFormat = VK_FORMAT_D16_UNORM; }),
                HasSubstr("FwVulkanTargetDef::depthFormat is 124"));
    EXPECT_THAT(wrong([](auto& d) { d.subpass = 1; }),
                HasSubstr("FwVulkanTargetDef::subpass is 1"));
    subpass.pDepthStencilAttachment = nullptr;
    EXPECT_THAT(wrong([](auto&) {}), HasSubstr("has no depth attachment"));
    subpass.pDepthStencilAttachment = &depth;
    VkApplicationInfo other{};
    EXPECT_THAT(wrong([&](auto& d) { d.renderPassInfo = &other; }), HasSubstr("has sType 0"));
    // The library owns a composite's pass: the host cannot name a subpass.
    FwVulkanTargetDef composite = surfacesOver(VK_FORMAT_R8G8B8A8_UNORM);
    composite.subpass = 1;
    EXPECT_THAT(refusal(composite), HasSubstr("FwVulkanTargetDef::subpass is 1"));
}

TEST_F(Targets, AreReadyOncePreparedAndReportProgress) {
    if (!device_) return;
    const auto ask = [&](FwTargetId id, FwPipelineProgress& progress) {
        progress = {};
        progress.structSize = sizeof progress;
        return fwTarget_IsReady(context_, id, &progress);
    };
    FwPipelineProgress all{}, own{};
    EXPECT_EQ(FW_NOT_READY, ask({}, all));
    EXPECT_EQ(0u, all.made);
    EXPECT_LT(10u, all.total);
    const FwVulkanTargetDef def = flamesOver(VK_FORMAT_R8G8B8A8_UNORM);
    const FwTargetId target = created(fwContext_RegisterTarget, context_, def);
    EXPECT_EQ(FW_NOT_READY, ask(target, own)) << "nothing is prepared: record calls do nothing";
    EXPECT_LT(0u, own.made);
    EXPECT_EQ(all.total, own.total - own.made);
    // Another thread sees the progress without blocking.
    std::thread worker([&] { EXPECT_EQ(FW_OK, fwContext_Prepare(context_)); });
    uint32_t seen = 0;
    while (ask(target, own) == FW_NOT_READY) {
        EXPECT_LE(seen, own.made);
        seen = own.made;
        std::this_thread::yield();
    }
    worker.join();
    EXPECT_EQ(FW_OK, ask(target, own));
    EXPECT_EQ(own.total, own.made);
    EXPECT_EQ(FW_OK, ask({}, all));
    EXPECT_EQ(all.total, all.made);
    // Destroyed with a frame: it exists until then.
    ASSERT_EQ(FW_OK, fwContext_UnregisterTargetAfterFrame(context_, target, 5));
    EXPECT_EQ(1u, fwContext_Collect(context_, 4));
    EXPECT_EQ(FW_OK, ask(target, own));
    EXPECT_EQ(0u, fwContext_Collect(context_, 5));
    EXPECT_EQ(FW_ERROR_STALE_ID, ask(target, own));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwContext_UnregisterTargetAfterFrame(context_, target, 5));
    const uint32_t before = all.made;
    EXPECT_EQ(FW_OK, ask({}, all));
    EXPECT_GT(before, all.made) << "its pipelines no longer count";
}

TEST_F(Targets, RefuseViewsAndFramesThatShowNothing) {
    if (!device_) return;
    ASSERT_EQ(FW_OK, fwContext_Prepare(context_));
    const FwWorldDef worldDef = fwDefaultWorldDef();
    FwWorld* world = nullptr;
    ASSERT_EQ(FW_OK, fwCreateWorld(context_, &worldDef, &world));
    HostFrames frames(*device_, 1);
    const FwVulkanFrame frame = frames.begin(0);
    const FwView right = viewAt({0, 1, 3}, {0, 0, 0}, 1.5f);
    const auto refused = [&](const FwView& view, const FwVulkanFrame& with) -> std::string {
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_RecordOutside(world, &with, &view));
        char text[512] = "";
        (void)fwWorld_GetLastMessage(world, text, sizeof text);
        return text;
    };
    FwView rows = right;
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 4; ++k) rows.view[4 * i + k] = right.view[4 * k + i];
    EXPECT_THAT(refused(rows, frame), HasSubstr("Matrices are column-major"));
    FwView flat = right;
    flat.view[0] = flat.view[1] = flat.view[2] = 0;
    EXPECT_THAT(refused(flat, frame), HasSubstr("FwView.view has determinant 0"));
    FwView empty = right;
    std::fill(std::begin(empty.projection), std::end(empty.projection), 0.0f);
    EXPECT_THAT(refused(empty, frame), HasSubstr("FwView.projection has zeros in all of row 0"));
    FwVulkanFrame clipped = frame;
    clipped.scissor = {{-1, 0}, {4, 4}};
    EXPECT_THAT(refused(right, clipped), HasSubstr("FwVulkanFrame::scissor.offset.x is -1"));
    clipped.scissor = {{0, 0}, {4, 0}};
    EXPECT_THAT(refused(right, clipped), HasSubstr("leave out the call"));
    FwVulkanFrame faint = frame;
    for (const float wrong : {-0.1f, 1.5f, std::numeric_limits<float>::quiet_NaN()}) {
        faint.transparency = wrong;
        EXPECT_THAT(refused(right, faint), HasSubstr("transparency is "));
    }
    EXPECT_EQ(FW_OK, fwWorld_RecordOutside(world, &frame, &right));
    frames.submit();
    frames.waitAll();
}

// Each component once for any number of worlds; buffers are summed over worlds.
TEST_F(Targets, MemoryReportCountsEachWorldOnce) {
    if (!device_) return;
    const auto report = [&] {
        std::vector<FwMemoryRow> rows(256);
        rows.resize(fwContext_GetMemoryReport(context_, rows.data(), uint32_t(rows.size())));
        return rows;
    };
    const auto row = [](const std::vector<FwMemoryRow>& rows, const std::string& name) {
        for (const FwMemoryRow& one : rows)
            if (name == one.name) return one;
        ADD_FAILURE() << "no row " << name;
        return FwMemoryRow{};
    };
    uint64_t buffer = 0, objects = 0;
    for (uint64_t worlds = 1; worlds <= 3; ++worlds) {
        const FwWorldDef worldDef = fwDefaultWorldDef();
        FwWorld* world = nullptr;
        ASSERT_EQ(FW_OK, fwCreateWorld(context_, &worldDef, &world));
        const std::vector<FwMemoryRow> rows = report();
        const FwContextInfo info = getState(fwContext_GetInfo, context_);
        EXPECT_EQ(info.gpuMemoryUsed, row(rows, "blocks").capacity);
        uint64_t components = 0;
        for (const FwMemoryRow& one : rows) {
            if (std::string(one.name) == "blocks") break;
            components += one.bytes;
        }
        EXPECT_EQ(components, row(rows, "blocks").bytes);
        EXPECT_LE(components, info.gpuMemoryUsed);
        if (worlds == 1) {
            buffer = row(rows, "state").capacity;
            objects = row(rows, "objects").bytes;
        }
        EXPECT_EQ(worlds * buffer, row(rows, "state").capacity);
        EXPECT_EQ(worlds * objects, row(rows, "objects").bytes);
        for (size_t i = 0; i < rows.size(); ++i)
            for (size_t k = 0; k < i; ++k) EXPECT_STRNE(rows[i].name, rows[k].name);
    }
}

}  // namespace
}  // namespace fw::test
