// Barriers between the passes of a frame, without a device.
#include "gpu/vk/barriers.h"

#include <gtest/gtest.h>

namespace fw::test::barriers_test {
namespace {

using gpu::Access;
using gpu::Use;

struct Recorded {
    uint32_t count = 0;
    VkAccessFlags from = 0, to = 0;  // of the last one
};
Recorded recorded;

void VKAPI_CALL recordBarrier(VkCommandBuffer, VkPipelineStageFlags, VkPipelineStageFlags,
                              VkDependencyFlags, uint32_t, const VkMemoryBarrier* barrier, uint32_t,
                              const VkBufferMemoryBarrier*, uint32_t, const VkImageMemoryBarrier*) {
    ++recorded.count;
    recorded.from = barrier->srcAccessMask;
    recorded.to = barrier->dstAccessMask;
}

class Barriers : public testing::Test {
 protected:
    Barriers() {
        table_.CmdPipelineBarrier = recordBarrier;
        tracker_.begin(table_, VK_NULL_HANDLE);
        recorded = {};
    }
    // The number of barriers before a pass.
    uint32_t pass(std::initializer_list<Use> uses) {
        recorded.count = 0;
        tracker_.use(table_, VK_NULL_HANDLE, {uses.begin(), uses.size()}, 0);
        return recorded.count;
    }

    gpu::vk::Table table_{};
    gpu::vk::BarrierTracker tracker_;
};

TEST_F(Barriers, SeparateAWriteFromEachLaterKindOfUseOnce) {
    EXPECT_EQ(0u, pass({{FW_BIND_COUNTERS, Access::write}}));
    EXPECT_EQ(1u, pass({{FW_BIND_COUNTERS, Access::read}}));
    EXPECT_EQ(0u, pass({{FW_BIND_COUNTERS, Access::read}}));
    EXPECT_EQ(1u, pass({{FW_BIND_COUNTERS, Access::indirect}}));
    EXPECT_EQ(0u, pass({{FW_BIND_COUNTERS, Access::indirect}}));
}

// Its groups are read before it writes, so that read says nothing about who sees the write.
TEST_F(Barriers, FollowAPassThatWritesToTheBufferOfItsOwnGroups) {
    EXPECT_EQ(0u, pass({{FW_BIND_COUNTERS, Access::write}}));
    EXPECT_EQ(1u, pass({{FW_BIND_COUNTERS, Access::write}, {FW_BIND_COUNTERS, Access::indirect}}));
    EXPECT_EQ(1u, pass({{FW_BIND_COUNTERS, Access::read}}));
    EXPECT_TRUE(recorded.from & VK_ACCESS_SHADER_WRITE_BIT);
    EXPECT_TRUE(recorded.to & VK_ACCESS_SHADER_READ_BIT);
}

}  // namespace
}  // namespace fw::test::barriers_test
