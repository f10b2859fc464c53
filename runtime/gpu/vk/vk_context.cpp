// A host's device and what its worlds share: memory, pipelines, targets.
#include "gpu/vk/world_state.h"

#include <cstring>

namespace fw::gpu::vk {

Context::Context(const FwVulkanHost* host, uint64_t gpuMemoryBudget,
                 std::pmr::memory_resource* memory, const core::Log& log)
    : memory_(memory) {
    state_ = std::pmr::polymorphic_allocator<>(memory).new_object<State>(host, gpuMemoryBudget,
                                                                         memory, log);
}

Context::~Context() { std::pmr::polymorphic_allocator<>(memory_).delete_object(state_); }

void Context::prepare() { state_->pipelines.prepare(); }
bool Context::ready() const noexcept { return state_->pipelines.ready(); }
FwTargetId Context::registerTarget(const FwVulkanTargetDef& def) {
    return state_->pipelines.registerTarget(def);
}
void Context::unregisterTarget(FwTargetId id) { state_->pipelines.unregisterTarget(id); }
void Context::notifyDeviceLost() noexcept { state_->device.notifyLost(); }
bool Context::deviceLost() const noexcept { return state_->device.lost(); }
bool Context::ownDevice() const noexcept { return state_->device.own; }

void Context::fillInfo(FwContextInfo& info) const noexcept {
    const Device& device = state_->device;
    info.apiVersion = device.apiVersion;
    info.ownDevice = device.own ? 1 : 0;
    info.gpuTimers = device.timestamps ? 1 : 0;
    info.debugLabels = device.debugUtils ? 1 : 0;
    info.gpuMemoryUsed = state_->deviceMemory.used();
    info.gpuMemoryBudget = state_->deviceMemory.budget();
    std::strncpy(info.deviceName, device.properties.deviceName, sizeof info.deviceName - 1);
    info.deviceName[sizeof info.deviceName - 1] = 0;
}

void Context::wishes(FwVulkanWishes& wishes) noexcept {
    static constexpr const char* kInstanceExtensions[] = {"VK_EXT_debug_utils"};
    wishes.minimumApiVersion = VK_API_VERSION_1_0;
    wishes.extensionCount = 0;
    wishes.extensions = nullptr;
    wishes.instanceExtensionCount = 1;
    wishes.instanceExtensions = kInstanceExtensions;
    wishes.features = {};
    wishes.features.independentBlend = VK_TRUE;
    wishes.queueFlags = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
}

}  // namespace fw::gpu::vk
