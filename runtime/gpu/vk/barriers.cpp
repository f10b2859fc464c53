#include "gpu/vk/barriers.h"

namespace fw::gpu::vk {
namespace {

struct Scope {
    VkPipelineStageFlags stages;
    VkAccessFlags access;
    bool write;
};

Scope scopeOf(const Use& use) noexcept {
    if (use.resource == FW_BIND_VIEW) return {0, 0, false};  // the CPU wrote it before the submit
    switch (use.access) {
        case Access::read:
        case Access::readTexels:
            return {VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT, false};
        case Access::write:
            return {VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                    VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT, true};
        case Access::indirect:
            return {VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT, VK_ACCESS_INDIRECT_COMMAND_READ_BIT,
                    false};
        case Access::uniform:
            return {VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_UNIFORM_READ_BIT, false};
        case Access::copyRead:
            return {VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT, false};
        case Access::copyWrite:
            return {VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, true};
    }
    return {0, 0, false};
}

constexpr VkPipelineStageFlags kDrawStages =
    VK_PIPELINE_STAGE_VERTEX_INPUT_BIT | VK_PIPELINE_STAGE_VERTEX_SHADER_BIT |
    VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT;
constexpr VkPipelineStageFlags kOurStages =
    VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
constexpr VkAccessFlags kOurWrites = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;

void record(const Table& table, VkCommandBuffer commands, VkPipelineStageFlags srcStages,
            VkAccessFlags srcAccess, VkPipelineStageFlags dstStages, VkAccessFlags dstAccess) {
    Typed<VkMemoryBarrier> barrier;
    barrier.srcAccessMask = srcAccess;
    barrier.dstAccessMask = dstAccess;
    table.CmdPipelineBarrier(commands, srcStages, dstStages, 0, 1, &barrier, 0, nullptr, 0,
                             nullptr);
}

}  // namespace

void BarrierTracker::begin(const Table& table, VkCommandBuffer commands) {
    states_ = {};
    record(table, commands, kOurStages | kDrawStages, kOurWrites,
           kOurStages | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
           VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT |
               VK_ACCESS_TRANSFER_READ_BIT | kOurWrites);
}

void BarrierTracker::use(const Table& table, VkCommandBuffer commands, std::span<const Use> uses,
                         uint32_t view) {
    VkPipelineStageFlags srcStages = 0, dstStages = 0;
    VkAccessFlags srcAccess = 0, dstAccess = 0;
    const auto sees = [](const State& state, const Scope& scope) {
        return (state.visibleStages & scope.stages) == scope.stages &&
               (state.visibleAccess & scope.access) == scope.access;
    };
    for (const Use& one : uses) {
        const Scope scope = scopeOf(one);
        const State& state = states_[resourceOf(one.resource, view)];
        if (state.writeStages && (scope.write || !sees(state, scope))) {
            srcStages |= state.writeStages;
            srcAccess |= state.writeAccess;
        }
        if (scope.write) srcStages |= state.readStages;
        dstStages |= scope.stages;
        dstAccess |= scope.access;
    }
    if (srcStages) record(table, commands, srcStages, srcAccess, dstStages, dstAccess);
    for (const Use& one : uses) {
        const Scope scope = scopeOf(one);
        State& state = states_[resourceOf(one.resource, view)];
        if (scope.write) continue;
        state.readStages |= scope.stages;
        // A write that was not visible is among this barrier's sources.
        if (state.writeStages && !sees(state, scope)) {
            state.visibleStages |= dstStages;
            state.visibleAccess |= dstAccess;
        }
    }
    // Writes come last: a pass may write to the buffer that its own groups come from.
    for (const Use& one : uses)
        if (const Scope scope = scopeOf(one); scope.write)
            states_[resourceOf(one.resource, view)] = {scope.stages, scope.access & kOurWrites};
}

void BarrierTracker::end(const Table& table, VkCommandBuffer commands) {
    record(table, commands, kOurStages | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT, kOurWrites,
           kOurStages | kDrawStages | VK_PIPELINE_STAGE_HOST_BIT,
           VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_UNIFORM_READ_BIT |
               VK_ACCESS_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_VERTEX_ATTRIBUTE_READ_BIT |
               VK_ACCESS_INDEX_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_HOST_READ_BIT |
               kOurWrites);
}

}  // namespace fw::gpu::vk
