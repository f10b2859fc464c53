// A context on a host's own device.
#pragma once
#include "flamewright/flamewright_vulkan.h"
#include "support/vulkan_device.h"

#include <string>
#include <utility>

namespace fw::test {

class HostContext : public GpuTest {
 protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!device_) return;
        const FwVulkanHost host = device_->host();
        FwContextDef def = fwDefaultContextDef();
        def.vulkan = &host;
        def.callbacks.userData = this;
        def.callbacks.log = [](void* data, int32_t level, const char* message) {
            if (level == FW_LOG_WARNING) static_cast<HostContext*>(data)->warnings_ += message;
        };
        FwErrorInfo error{};
        ASSERT_EQ(FW_OK, fwCreateContext(&def, &context_, &error)) << error.message;
    }
    void TearDown() override {
        destroyContext();
        GpuTest::TearDown();
    }
    void destroyContext() { fwDestroyContext(std::exchange(context_, nullptr)); }

    FwContext* context_ = nullptr;
    std::string warnings_;
};

}  // namespace fw::test
