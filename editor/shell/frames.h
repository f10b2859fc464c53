// The editor's frames: a ring of command buffers and the output image of the interface. The output
// persists, so a frame draws only changes; the window shows a copy.
#pragma once

#include <memory>
#include <vector>

#include "common/picture.h"
#include "common/window.h"

namespace fwui {

struct Frame {
    VkCommandBuffer commands = VK_NULL_HANDLE;  // recording
    uint64_t index = 0;                         // from 1
    uint64_t completed = 0;  // the device has finished this frame and all earlier ones
    uint32_t slot = 0;
    VkExtent2D extent{};  // pixels of the output
};

class Frames {
 public:
    static constexpr uint32_t kSlots = 2;
    // Creates a window of that size if the host supports windows, otherwise renders pictures.
    Frames(const sample::VulkanHost& host, const char* title, VkExtent2D size);
    ~Frames();
    Frames(const Frames&) = delete;
    Frames& operator=(const Frames&) = delete;

    // Returns false if there is nothing to draw into.
    bool begin(Frame& frame);
    // Returns true if the output is still empty. Otherwise it holds the previous frame.
    bool beginOutput(const Frame& frame);
    // Ends the output pass, submits and presents.
    void end(const Frame& frame);
    // Headless: returns the last frame. Waits for the device.
    sample::Picture picture();

    std::unique_ptr<sample::Window> window;  // null: headless
    VkRenderPass outputPass = VK_NULL_HANDLE;
    [[nodiscard]] VkExtent2D extent() const { return window ? window->extent : size_; }

 private:
    struct Slot {
        VkCommandPool pool = VK_NULL_HANDLE;
        VkCommandBuffer commands = VK_NULL_HANDLE;
        VkFence fence = VK_NULL_HANDLE;
        VkSemaphore available = VK_NULL_HANDLE;
        uint64_t index = 0;
    };
    void makePass(VkFormat format);
    void makeOutput();
    void dropOutput();
    void copyToWindow(const Frame& frame) const;

    const sample::VulkanHost& host_;
    VkExtent2D size_;
    Slot slots_[kSlots];
    uint64_t index_ = 0, completed_ = 0;
    uint32_t imageIndex_ = 0, generation_ = 0;
    sample::Image output_;
    sample::Buffer readback_;
    VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
    bool fresh_ = false;
};

}  // namespace fwui
