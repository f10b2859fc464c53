// A GLFW window and its swapchain. Rebuilds it on resize, on SUBOPTIMAL and on OUT_OF_DATE. The
// frame loop is in stage.h.
#pragma once

#include <string>
#include <vector>

#include "common/vulkan_host.h"

struct GLFWwindow;

namespace sample {

// User input since the last poll.
struct Input {
    float dragX = 0, dragY = 0;            // pixels, left button held
    float panX = 0, panY = 0;              // pixels, right or middle button held
    float wheel = 0;                       // notches, up is positive
    float moveRight = 0, moveForward = 0;  // keys held, -1..1 (arrows or WASD)
    float turn = 0;                        // keys held, -1..1 (Q and E)
    bool click = false;                    // left button pressed and released without a drag
    float clickX = 0, clickY = 0;          // [0, 1] of the window from its top left
    float x = 0, y = 0;                    // mouse position, in units of clickX and clickY
    bool held = false;                     // left button is down
    std::vector<int> keys;  // keys pressed since the last poll, as GLFW key codes (letters are
                            // ASCII capitals)
};

class Window {
 public:
    Window(const VulkanHost& host, const std::string& title, uint32_t width, uint32_t height);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    bool poll(Input& input);  // false: the user closed the window
    // Returns false if there is nothing to draw into (minimised): poll and try again. A changed
    // `generation` means that `extent` and `views` are new.
    bool acquire(VkSemaphore available, uint32_t& index);
    void present(uint32_t index);
    VkSemaphore rendered(uint32_t index) const { return rendered_[index]; }
    // Sleeps so that frames come at most `framesPerSecond` times a second. FIFO does not pace every
    // driver.
    void limitRate(double framesPerSecond);

    // For a host that installs its own GLFW callbacks instead of poll(). The window's user pointer
    // stays reserved; callbacks use `guest`.
    GLFWwindow* handle() const { return window_; }
    void* guest = nullptr;

    VkFormat format = VK_FORMAT_UNDEFINED;
    VkExtent2D extent{};
    std::vector<VkImage> images;
    std::vector<VkImageView> views;
    bool takesCopies = false;  // swapchain images accept copies
    uint32_t generation = 0;

 private:
    bool makeSwapchain();
    void dropSwapchain();

    const VulkanHost& host_;
    GLFWwindow* window_ = nullptr;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
    std::vector<VkSemaphore> rendered_;
    bool stale_ = true;
    double lastX_ = 0, lastY_ = 0, pressX_ = 0, pressY_ = 0;
    bool pressed_ = false;
    float wheel_ = 0;
    std::vector<int> keys_;
    double nextTime_ = 0;  // s on GLFW's clock
};

}  // namespace sample
