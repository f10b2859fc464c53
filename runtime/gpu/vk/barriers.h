// Turns the accesses that passes declare into pipeline barriers: one global memory barrier before a
// pass that needs one. Vulkan 1.0 stages and accesses only. Knows nothing of images.
#pragma once
#include "gpu/passes/pass.h"
#include "gpu/vk/table.h"

#include <array>
#include <span>

namespace fw::gpu::vk {

class BarrierTracker {
 public:
    // Start of our part of a command buffer: everything before, of whatever frame, is waited for.
    void begin(const Table& table, VkCommandBuffer commands);
    // Before a pass or copy for view `view`. Records at most one barrier.
    void use(const Table& table, VkCommandBuffer commands, std::span<const Use> uses,
             uint32_t view = 0);
    // End of it: our writes become visible to draws, to later frames and to the host.
    void end(const Table& table, VkCommandBuffer commands);

 private:
    struct State {
        VkPipelineStageFlags writeStages = 0;  // of the last write, 0: none since begin
        VkAccessFlags writeAccess = 0;
        VkPipelineStageFlags readStages = 0;     // since that write
        VkPipelineStageFlags visibleStages = 0;  // where that write is visible already
        VkAccessFlags visibleAccess = 0;
    };
    std::array<State, kResourceCount> states_{};
};

}  // namespace fw::gpu::vk
