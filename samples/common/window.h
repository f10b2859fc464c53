// A GLFW window and its swapchain. Made anew on resize, on SUBOPTIMAL and on OUT_OF_DATE.
// Not a frame loop: that is stage.h.
#pragma once

#include <string>
#include <vector>

#include "common/vulkan_host.h"

struct GLFWwindow;

namespace sample {

// What the user did since the last poll.
struct Input {
    float dragX = 0, dragY = 0;            // pixels, left button held
    float panX = 0, panY = 0;              // pixels, right or middle button held
    float wheel = 0;                       // notches, up is positive
    float moveRight = 0, moveForward = 0;  // keys held, -1..1 (arrows or WASD)
    float turn = 0;                        // keys held, -1..1 (Q and E)
    bool click = false;                    // left button pressed and released without dragging
    float clickX = 0, clickY = 0;          // 0..1 of the window, from its top left
    float x = 0, y = 0;                    // where the mouse is, as clickX and clickY
    bool held = false;                     // left button is down
    std::vector<int> keys;  // pressed since, as GLFW key codes (letters are ASCII capitals)
};

class Window {
 public:
    Window(const VulkanHost& host, const std::string& title, uint32_t width, uint32_t height);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    bool poll(Input& input);  // false: the user closed it
    // False: nothing to draw into just now (minimised); poll and try again. A changed `generation`
    // says that `extent` and `views` are new.
    bool acquire(VkSemaphore available, uint32_t& index);
    void present(uint32_t index);
    VkSemaphore rendered(uint32_t index) const { return rendered_[index]; }
    // Sleeps so that calls come at most `framesPerSecond` apart: FIFO does not pace every driver.
    void limitRate(double framesPerSecond);

    // For a host that takes GLFW's callbacks itself instead of poll(). GLFW's user pointer of the
    // window stays ours; `guest` is for them.
    GLFWwindow* handle() const { return window_; }
    void* guest = nullptr;

    VkFormat format = VK_FORMAT_UNDEFINED;
    VkExtent2D extent{};
    std::vector<VkImage> images;
    std::vector<VkImageView> views;
    bool takesCopies = false;  // the images may be copied to
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
