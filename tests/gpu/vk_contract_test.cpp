// Promises of the vk backend to its host: no submit, wait, allocation or pipeline in a steady
// frame, clear refusals, pools that grow under a fire, idle worlds that record nothing.
#include "abi/abi_support.h"
#include "core/error.h"
#include "flamewright/flamewright_debug.h"
#include "gpu/cpu/cpu_backend.h"
#include "gpu/passes/shader_interface.h"
#include "support/burn_scene.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <set>
#include <span>
#include <thread>

namespace fw::test {
namespace {

using testing::HasSubstr;

template <class Call>
core::Error errorOf(Call&& call) {
    try {
        call();
    } catch (const core::Error& error) {
        return error;
    }
    ADD_FAILURE() << "no error";
    return {};
}

void expectEqual(const FrameAnswer& want, const FrameAnswer& got, const char* what) {
    ASSERT_EQ(want.frameIndex, got.frameIndex) << what;
    for (size_t o = 0; o < want.maps.size(); ++o)
        ASSERT_TRUE(want.maps[o] == got.maps[o])
            << what << ": object " << o << ", frame " << want.frameIndex;
}

class VkContract : public GpuTest {};

// 1.0 without features, unless another version was requested.
TEST_F(VkContract, TestsRunOnVulkan1_0) {
    if (!device_) return;
    const char* asked = std::getenv("FLAMEWRIGHT_API");
    const uint32_t want = asked && *asked ? testApiVersion()
                          : gpuAssisted() ? VK_API_VERSION_1_1
                                          : VK_API_VERSION_1_0;
    EXPECT_EQ(device_->options.apiVersion, want);
    EXPECT_EQ(device_->options.independentBlend && want < VK_API_VERSION_1_3, false);
    VkRig rig(*device_);
    FwContextInfo info{};
    rig.context.fillInfo(info);
    EXPECT_EQ(info.ownDevice, 0u);
    EXPECT_STREQ(info.deviceName, device_->properties.deviceName);
}

// Equal burns on another API version, with slot pacing of three frames in flight.
TEST_F(VkContract, BurnsIdenticallyOnVulkan1_3) {
    makeDevice({.apiVersion = VK_API_VERSION_1_3});
    if (!device_) return;
    const BurnScene scene = BurnScene::make(3, 0.6);
    VkRig rig(*device_, 3);
    gpu::cpu::CpuBackend cpu(std::pmr::get_default_resource(), 16);
    scene.create(rig.backend);
    scene.create(cpu);
    PlanMaker maker(scene, 5);
    FrameAnswer want;
    for (int f = 0; f < 20; ++f) {
        const OwnedPlan plan = maker.next(4, f == 19);
        cpu.run(plan.plan);
        while (const gpu::Readback* readback = cpu.nextReadback()) want = copyAnswer(*readback);
        rig.run(plan.plan);
    }
    const std::vector<FrameAnswer> answers = rig.finish();
    for (const FrameAnswer& answer : answers) {
        if (answer.frameIndex == 20) expectEqual(want, answer, "1.3");
    }
}

TEST_F(VkContract, SteadyFramesAllocateNothing) {
    if (!device_) return;
    BurnScene scene = BurnScene::make(21, 0.6);
    scene.objects[0].reference = true;  // the first object uses the reference refinement
    scene.refineByReference();
    gpu::vk::WorldLimits limits;
    limits.appearances = testAppearances();
    VkRig rig(*device_, 2, 0, limits, countingEntry());
    scene.create(rig.backend);
    const float* low = scene.domains[0].boundsLow;
    rig.backend.startBoundary(0, low, 4096 + 60 * gpu::kStepTicks);
    PlanMaker maker(scene, 6);
    maker.events = 0.1;
    for (int f = 0; f < 40; ++f) rig.run(maker.next(1, false).plan);  // warm-up
    (void)takeCounts();
    const uint64_t allocations = rig.allocations;
    for (int f = 0; f < 300; ++f) {
        rig.run(maker.next(1, false).plan);
    }
    const VulkanCounts counts = takeCounts();
    EXPECT_EQ(counts.total(), 0u) << counts.submits << " submits, " << counts.waits << " waits, "
                                  << counts.memory << " allocations, " << counts.pipelines
                                  << " pipelines, " << counts.descriptorPools << " pools, "
                                  << counts.objects << " objects";
    EXPECT_EQ(rig.allocations, allocations);
    EXPECT_GT(counts.work, 300u);
}

TEST_F(VkContract, IdleWorldsRecordNothing) {
    if (!device_) return;
    const BurnScene scene = BurnScene::make(22, 0.4);
    VkRig rig(*device_, 2, 0, {}, countingEntry());
    scene.create(rig.backend);
    uint32_t now = 4096;
    uint64_t index = 0;
    const auto frame = [&](uint32_t kind, uint32_t count) {
        gpu::StepPlan step;
        step.now = now;
        step.reduce = true;
        std::vector<gpu::TexelEvent> events;
        const mesh::BurnDomain& domain = scene.domains[0];
        for (uint32_t i = 0; i < domain.texelCount() && count; ++i) {
            if (domain.real(i)) {
                events.push_back({0, i, kind, now + 1});
                --count;
            }
        }
        step.events = events;
        gpu::FramePlan plan;
        plan.frameIndex = ++index;
        plan.steps = {&step, 1};
        plan.endTick = now += gpu::kStepTicks;
        rig.run(plan);
    };
    for (int i = 0; i < 4; ++i) frame(0, 0);
    (void)takeCounts();
    for (int i = 0; i < 4; ++i) frame(0, 0);
    VulkanCounts counts = takeCounts();
    EXPECT_EQ(counts.work + counts.barriers, 0u) << "nothing ever burned";
    frame(gpu::kEventIgnite, 40);
    for (int i = 0; i < 4; ++i) frame(0, 0);
    counts = takeCounts();
    EXPECT_GT(counts.work, 30u) << "it burns";
    frame(gpu::kEventExtinguish, 0xFFFFFFFFu);
    for (int i = 0; i < 100; ++i) frame(0, 0);  // predictions expire too
    (void)takeCounts();
    for (int i = 0; i < 4; ++i) frame(0, 0);
    counts = takeCounts();
    EXPECT_EQ(counts.work + counts.barriers, 0u) << "it is out";
    for (const gpu::PassTime& time : rig.backend.passTimes())
        if (counts.work) std::printf("frame %d: %s\n", int(time.frameIndex), time.name);
    const std::vector<FrameAnswer> answers = rig.finish();
    ASSERT_FALSE(answers.empty());
    EXPECT_EQ(answers.back().counters[0].burning, 0u);
}

// Objects come and go while others burn: ranges are reused, pools grow, and no burn changes.
TEST_F(VkContract, PoolsGrowWithoutChangingAFire) {
    if (!device_) return;
    BurnScene scene = BurnScene::make(23, 0.6);
    const size_t first = scene.objects.size();
    VkRig rig(*device_);
    gpu::cpu::CpuBackend cpu(std::pmr::get_default_resource(), 16);
    scene.create(rig.backend);
    scene.create(cpu);
    PlanMaker maker(scene, 7);
    std::vector<FrameAnswer> want, got;
    std::mt19937 random(8);
    uint64_t before = 0, after = 0;
    const auto capacity = [&] {
        std::pmr::vector<gpu::MemoryRow> rows;
        rig.backend.memoryRows(rows);
        for (const gpu::MemoryRow& row : rows)
            if (std::string_view(row.name) == "state") return row.capacity;
        return uint64_t(0);
    };
    for (int f = 0; f < 60; ++f) {
        if (f == 5) before = capacity();
        if (f % 2 == 1 && f < 50) {  // a new object now and then
            SceneObject object = scene.objects[random() % first];
            scene.objects.push_back(object);
            const auto slot = uint32_t(scene.objects.size() - 1);
            rig.backend.createObject(slot, scene.init(slot));
            cpu.createObject(slot, scene.init(slot));
        }
        if (f % 6 == 5) {  // an object that is out returns unburnt in the same slot
            const uint32_t slot = uint32_t(random() % first);
            rig.backend.destroyObject(slot);
            cpu.destroyObject(slot);
            rig.backend.createObject(slot, scene.init(slot));
            cpu.createObject(slot, scene.init(slot));
        }
        const OwnedPlan plan = maker.next(3, f % 5 == 4);
        cpu.run(plan.plan);
        while (const gpu::Readback* readback = cpu.nextReadback())
            want.push_back(copyAnswer(*readback));
        rig.run(plan.plan);
        for (FrameAnswer& answer : rig.applyAnswers()) got.push_back(std::move(answer));
    }
    for (FrameAnswer& answer : rig.finish()) got.push_back(std::move(answer));
    after = capacity();
    EXPECT_GT(after, before) << "the scene is too small to make a pool grow";
    size_t compared = 0;
    for (const FrameAnswer& answer : got) {
        if (answer.frameIndex == 0 || answer.frameIndex > want.size()) continue;
        expectEqual(want[answer.frameIndex - 1], answer, "growing");
        if (HasFatalFailure()) return;
        compared += answer.maps.size();
    }
    EXPECT_GT(compared, 100u);
}

TEST_F(VkContract, ExceedingTheBudgetFailsAndChangesNothing) {
    if (!device_) return;
    const mesh::BurnDomain domain = [&] {
        mesh::BakeInput input = makePlane(1, 1).input(600, 4096);
        const Mesh mesh = makePlane(1, 1);
        input = mesh.input(600, 4096);
        input.trustUvs = true;
        return mesh::bake(input, std::pmr::get_default_resource());
    }();
    VkRig rig(*device_, 2, uint64_t(160) << 20);
    rig.backend.createMesh(0, domain);
    BurnScene scene;
    scene.domains.push_back(domain);
    scene.objects.emplace_back();
    for (auto& material : scene.objects[0].materials) material = plainMaterial(domain, 0.01);
    uint32_t made = 0;
    core::Error error;
    for (; made < 64; ++made) {
        try {
            rig.backend.createObject(made, scene.init(0));
        } catch (const core::Error& caught) {
            error = caught;
            break;
        }
    }
    ASSERT_LT(made, 64u) << "the budget never stopped it";
    ASSERT_GT(made, 0u) << error.message;
    EXPECT_EQ(error.result, FW_ERROR_OUT_OF_MEMORY);
    EXPECT_THAT(error.message, HasSubstr("budget"));
    FwContextInfo info{};
    rig.context.fillInfo(info);
    EXPECT_LE(info.gpuMemoryUsed, info.gpuMemoryBudget);
    // Existing objects still burn.
    gpu::StepPlan step;
    step.now = 4096;
    gpu::TexelEvent event{0, domain.width * (domain.height / 2) + domain.width / 2, 0, 4097};
    step.events = {&event, 1};
    gpu::FramePlan plan;
    plan.frameIndex = 1;
    plan.steps = {&step, 1};
    plan.endTick = 4096 + gpu::kStepTicks;
    rig.run(plan);
    const std::vector<FrameAnswer> answers = rig.finish();
    ASSERT_FALSE(answers.empty());
    EXPECT_EQ(answers[0].counters[0].ignited, 1u);
    // Memory returns once the lists were processed.
    rig.backend.destroyObject(made - 1);
    for (uint64_t f = 2; f < 6; ++f) {
        gpu::StepPlan next;
        next.now = plan.endTick;
        next.reduce = true;
        plan.frameIndex = f;
        plan.steps = {&next, 1};
        plan.endTick += gpu::kStepTicks;
        rig.run(plan);
    }
    rig.backend.createObject(made - 1, scene.init(0));
}

TEST_F(VkContract, RefusesInvalidFramePacing) {
    if (!device_) return;
    VkRig rig(*device_);
    const auto refused = [&](const FwVulkanFrame& frame, const char* field) {
        const core::Error error = errorOf([&] { (void)rig.backend.beginOutside(frame, rig.view); });
        EXPECT_EQ(error.result, FW_ERROR_INVALID_ARGUMENT);
        EXPECT_THAT(error.message, HasSubstr(field));
    };
    device_->run([&](VkCommandBuffer commands) {
        FwVulkanFrame frame{};
        frame.commandBuffer = commands;
        refused(frame, "frameIndex");
        frame.frameIndex = 3;
        frame.completedFrameIndex = 3;
        refused(frame, "completedFrameIndex");
        frame.completedFrameIndex = 0;
        frame.flags = FW_FRAME_SLOT_PACING;
        refused(frame, "framesInFlight");
        frame.framesInFlight = 2;
        frame.frameSlot = 2;
        refused(frame, "frameSlot");
        frame.flags = 0x80;
        refused(frame, "flags");
        frame.flags = 0;
        frame.commandBuffer = VK_NULL_HANDLE;
        refused(frame, "commandBuffer");
        frame.commandBuffer = commands;
        ASSERT_TRUE(rig.backend.beginOutside(frame, rig.view));
        gpu::FramePlan plan;
        plan.frameIndex = 3;
        rig.backend.run(plan);
        rig.backend.endOutside();
        refused(frame, "frameIndex");  // once per frame
        frame.frameIndex = 2;
        refused(frame, "frameIndex");
        frame.frameIndex = 4;
        frame.completedFrameIndex = 2;
        ASSERT_TRUE(rig.backend.beginOutside(frame, rig.view));
        rig.backend.cancelOutside();
        ASSERT_TRUE(rig.backend.beginOutside(frame, rig.view))
            << "a cancelled frame may come again";
        rig.backend.run(plan);
        rig.backend.endOutside();
        frame.frameIndex = 5;
        frame.completedFrameIndex = 1;
        refused(frame, "completedFrameIndex");
    });
}

TEST_F(VkContract, SlotPacingReportsCompletedFrames) {
    if (!device_) return;
    const BurnScene scene = BurnScene::make(24, 0.4);
    VkRig rig(*device_);
    scene.create(rig.backend);
    PlanMaker maker(scene, 9);
    uint32_t answers = 0;
    for (uint64_t f = 1; f <= 6; ++f) {
        const OwnedPlan plan = maker.next(1, false);
        device_->run([&](VkCommandBuffer commands) {
            FwVulkanFrame frame{};
            frame.flags = FW_FRAME_SLOT_PACING;
            frame.commandBuffer = commands;
            frame.frameIndex = f;
            frame.framesInFlight = 2;
            frame.frameSlot = uint32_t(f % 2);
            ASSERT_TRUE(rig.backend.beginOutside(frame, rig.view));
            while (rig.backend.nextReadback()) ++answers;
            rig.backend.run(plan.plan);
            rig.backend.endOutside();
        });
    }
    EXPECT_EQ(answers, 4u);  // as far as the library knows, the last two are in flight
}

TEST_F(VkContract, ALostDeviceStaysLost) {
    if (!device_) return;
    const BurnScene scene = BurnScene::make(25, 0.4);
    VkRig rig(*device_);
    scene.create(rig.backend);
    PlanMaker maker(scene, 10);
    rig.run(maker.next(1, false).plan);
    rig.frames.waitAll();
    rig.context.notifyDeviceLost();
    EXPECT_TRUE(rig.context.deviceLost());
    FwVulkanFrame frame{};
    frame.frameIndex = 99;
    const core::Error error = errorOf([&] { (void)rig.backend.beginOutside(frame, rig.view); });
    EXPECT_EQ(error.result, FW_ERROR_DEVICE_LOST);
    rig.backend.destroyObject(0);  // the rig destroys the rest
}

// Devices need 17 storage buffers per stage (gpu/vk/device.cpp): no pass may bind more.
TEST(VkContractFloor, NoPassBindsMoreStorageBuffersThanRequired) {
    const auto countOf = [](const gpu::ShaderInterface& shaders, bool texels) {
        return std::count_if(
            shaders.uses().begin(), shaders.uses().end(), [&](const gpu::Use& use) {
                return texels ? use.access == gpu::Access::readTexels
                              : use.access == gpu::Access::read || use.access == gpu::Access::write;
            });
    };
    std::ptrdiff_t most = 0;
    for (const bool texels : {false, true}) {
        for (const gpu::ComputePass& pass : gpu::computePasses()) {
            const auto shaders = gpu::interfaceOf(pass, texels, std::pmr::new_delete_resource());
            EXPECT_LE(countOf(shaders, false), 17) << pass.name;
            EXPECT_LE(countOf(shaders, true), texels ? 4 : 0)
                << pass.name << ": maxPerStageDescriptorStorageImages";
            most = std::max(most, countOf(shaders, false));
        }
        for (const gpu::DrawPass& pass : gpu::drawPasses())
            EXPECT_LE(
                countOf(gpu::interfaceOf(pass, texels, std::pmr::new_delete_resource()), false), 17)
                << pass.name;
    }
    EXPECT_EQ(most, 17) << "the device requirement can be lowered";
}

TEST_F(VkContract, RefusesInvalidHosts) {
    if (!device_) return;
    core::Memory memory{FwCallbacks{}};
    core::Log log{FwCallbacks{}};
    const auto refused = [&](const FwVulkanHost& host, const char* word) {
        const core::Error error =
            errorOf([&] { gpu::vk::Context context(&host, 0, &memory, log); });
        EXPECT_THAT(error.message, HasSubstr(word));
    };
    FwVulkanHost host = device_->host();
    host.queueFamilyIndex = 77;
    refused(host, "queueFamilyIndex");
    host = device_->host();
    host.device = VK_NULL_HANDLE;
    refused(host, "device");
    host = device_->host();
    host.getInstanceProcAddr = nullptr;
    refused(host, "getInstanceProcAddr");
    host.getInstanceProcAddr = [](VkInstance, const char*) -> PFN_vkVoidFunction {
        return nullptr;
    };
    refused(host, "vkGetDeviceProcAddr");
    EXPECT_EQ(memory.bytes(), 0u);
}

// Each error of a frame or a view is named, nothing is recorded, and the next frame is valid.
TEST_F(VkContract, RefusesInvalidFramesAndViews) {
    if (!device_) return;
    const FwVulkanHost host = device_->host();
    FwContextDef def = fwDefaultContextDef();
    def.vulkan = &host;
    FwContext* context = nullptr;
    FwErrorInfo error{};
    ASSERT_EQ(fwCreateContext(&def, &context, &error), FW_OK) << error.message;
    ASSERT_EQ(fwContext_Prepare(context), FW_OK);
    const FwWorldDef worldDef = fwDefaultWorldDef();
    FwWorld* world = nullptr;
    ASSERT_EQ(fwCreateWorld(context, &worldDef, &world), FW_OK) << ::host::lastMessage(context);
    device_->run([&](VkCommandBuffer commands) {
        FwVulkanFrame good = fwDefaultVulkanFrame();
        good.commandBuffer = commands;
        good.frameIndex = 1;
        const FwView lit = fwDefaultView();
        const auto refused = [&](const FwVulkanFrame& frame, const FwView& view,
                                 const char* words) {
            EXPECT_EQ(fwWorld_RecordOutside(world, &frame, &view), FW_ERROR_INVALID_ARGUMENT);
            EXPECT_THAT(::host::lastMessage(world), HasSubstr(words));
        };
        for (const uint32_t bad : {1u, 0xFFFFFFFFu}) {
            FwVulkanFrame frame = good;
            frame.reserved = bad;
            const std::string said =
                "FwVulkanFrame::reserved is " + std::to_string(bad) + "; it is zero.";
            refused(frame, lit, said.c_str());
        }
        for (const float bad : {-0.01f, 8.01f, std::nanf(""), HUGE_VALF}) {
            FwView view = lit;
            view.haze = bad;
            refused(good, view, "FwView.haze is ");
            view = lit;
            view.reserved = bad;
            refused(good, view, "FwView.reserved is ");
        }
        for (const float edge : {0.0f, 8.0f}) {
            FwView view = lit;
            view.haze = edge;
            EXPECT_EQ(fwWorld_RecordOutside(world, &good, &view), FW_OK)
                << ::host::lastMessage(world);
            ++good.frameIndex;
        }
    });
    fwDestroyContext(context);
}

// Also for the thread sanitizer: tests/run --tsan --suite gpu --filter VkThreads.
using VkThreads = VkContract;

TEST_F(VkThreads, NotReadyBeforePrepare) {
    if (!device_) return;
    core::Memory memory{FwCallbacks{}};
    core::Log log{FwCallbacks{}};
    {
        const FwVulkanHost host = device_->host();
        gpu::vk::Context context(&host, 0, &memory, log);
        gpu::vk::VkBackend backend(context, {}, &memory, log);
        FwVulkanFrame frame{};
        frame.frameIndex = 1;
        EXPECT_FALSE(backend.beginOutside(frame, fwDefaultView()));
        std::thread worker([&] { context.prepare(); });
        worker.join();
        EXPECT_TRUE(context.ready());
    }
    EXPECT_EQ(memory.bytes(), 0u) << "memory leaks";
}

TEST_F(VkThreads, TargetsMayBeRegisteredWhileFramesRecord) {
    if (!device_) return;
    const BurnScene scene = BurnScene::make(28, 0.4);
    gpu::vk::WorldLimits limits;
    limits.appearances = testAppearances();
    VkRig rig(*device_, 2, 0, limits);
    scene.create(rig.backend);
    std::atomic<bool> stop = false;
    uint32_t registered = 0;
    std::thread worker([&] {
        FwVulkanTargetDef def{};
        def.flags = FW_TARGET_COMPOSITE;
        def.colorFormat = VK_FORMAT_R8G8B8A8_UNORM;
        def.samples = def.colorAttachmentCount = 1;
        do {
            def.flags ^= FW_TARGET_AS_NEEDED;
            const FwTargetId id = rig.context.registerTarget(def);
            FwContextInfo info{};
            rig.context.fillInfo(info);
            rig.context.unregisterTarget(id);
            ++registered;
        } while (!stop || registered < 2);
    });
    PlanMaker maker(scene, 13);
    constexpr FwMaterialPreset kKinds[] = {FW_MATERIAL_THATCH, FW_MATERIAL_LEATHER,
                                           FW_MATERIAL_PAPER};
    for (int f = 0; f < 30; ++f) {
        rig.run(maker.next(1, false).plan);
        if (f % 10 != 0) continue;  // a material family that targets of the other thread still lack
        gpu::ObjectInit init = scene.init(0);
        auto materials = scene.objects[0].materials;
        for (gpu::BurnMaterial& material : materials) material.appearance = kKinds[f / 10];
        init.materials = materials;
        rig.backend.createObject(uint32_t(scene.objects.size()) + uint32_t(f) / 10, init);
    }
    stop = true;
    worker.join();
    EXPECT_LE(2u, registered);
    EXPECT_FALSE(rig.finish().empty());
}

TEST_F(VkThreads, TwoContextsOnTwoDevicesAreIndependent) {
    if (!device_) return;
    std::string reason;
    const std::unique_ptr<TestDevice> other = TestDevice::make({}, reason);
    ASSERT_TRUE(other) << reason;
    const BurnScene scene = BurnScene::make(26, 0.4);
    std::vector<FrameAnswer> results[2];
    const auto burn = [&](TestDevice& device, std::vector<FrameAnswer>& out) {
        VkRig rig(device);
        scene.create(rig.backend);
        PlanMaker maker(scene, 11);
        for (int f = 0; f < 20; ++f) rig.run(maker.next(2, f == 19).plan);
        out = rig.finish();
    };
    std::thread second([&] { burn(*other, results[1]); });
    burn(*device_, results[0]);
    second.join();
    ASSERT_FALSE(results[0].empty());
    const auto last = [](const std::vector<FrameAnswer>& answers) {
        const FrameAnswer* found = nullptr;
        for (const FrameAnswer& answer : answers)
            if (!answer.maps.empty()) found = &answer;
        return found;
    };
    ASSERT_TRUE(last(results[0]) && last(results[1]));
    expectEqual(*last(results[0]), *last(results[1]), "two devices");
    for (const std::string& message : other->takeMessages()) ADD_FAILURE() << message;
}

TEST_F(VkContract, TimesEveryPass) {
    if (!device_) return;
    const BurnScene scene = BurnScene::make(27, 0.4);
    VkRig rig(*device_);
    scene.create(rig.backend);
    PlanMaker maker(scene, 12);
    for (int f = 0; f < 8; ++f) rig.run(maker.next(1, false).plan);
    (void)rig.finish();
    FwContextInfo info{};
    rig.context.fillInfo(info);
    if (!info.gpuTimers) GTEST_SKIP() << "the queue family has no timestamps";
    bool arrival = false;
    for (const gpu::PassTime& time : rig.backend.passTimes()) {
        EXPECT_GE(time.milliseconds, 0);
        EXPECT_LT(time.milliseconds, 10000);
        arrival |= std::string_view(time.name) == "arrival" && time.count > 0;
    }
    EXPECT_TRUE(arrival);
}

}  // namespace
}  // namespace fw::test
