// See window.h.
#include "common/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

namespace sample {

Window::Window(const VulkanHost& host, const std::string& title, uint32_t width, uint32_t height)
    : host_(host) {
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window_ = glfwCreateWindow(static_cast<int>(width), static_cast<int>(height), title.c_str(),
                               nullptr, nullptr);
    if (!window_) throw Failure("the window cannot be created; use --headless");
    if (glfwCreateWindowSurface(host.instance, window_, nullptr, &surface_) != VK_SUCCESS) {
        glfwDestroyWindow(window_);
        throw Failure("the window has no Vulkan surface; use --headless");
    }
    // Registers a press that ends before a slow frame polls.
    glfwSetInputMode(window_, GLFW_STICKY_KEYS, GLFW_TRUE);
    glfwSetInputMode(window_, GLFW_STICKY_MOUSE_BUTTONS, GLFW_TRUE);
    glfwSetWindowUserPointer(window_, this);
    glfwSetScrollCallback(window_, [](GLFWwindow* window, double, double y) {
        static_cast<Window*>(glfwGetWindowUserPointer(window))->wheel_ += static_cast<float>(y);
    });
    glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int) {
        if (action != GLFW_PRESS) return;
        static_cast<Window*>(glfwGetWindowUserPointer(window))->keys_.push_back(key);
    });
    glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* window, int, int) {
        static_cast<Window*>(glfwGetWindowUserPointer(window))->stale_ = true;
    });
    makeSwapchain();
}

Window::~Window() {
    vkDeviceWaitIdle(host_.device);
    dropSwapchain();
    vkDestroySwapchainKHR(host_.device, swapchain_, nullptr);
    vkDestroySurfaceKHR(host_.instance, surface_, nullptr);
    glfwDestroyWindow(window_);
}

void Window::dropSwapchain() {
    for (VkImageView view : views) vkDestroyImageView(host_.device, view, nullptr);
    for (VkSemaphore semaphore : rendered_) vkDestroySemaphore(host_.device, semaphore, nullptr);
    views.clear();
    rendered_.clear();
}

bool Window::makeSwapchain() {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    if (width <= 0 || height <= 0) return false;
    checkVulkan(vkDeviceWaitIdle(host_.device), "vkDeviceWaitIdle");
    dropSwapchain();

    VkSurfaceCapabilitiesKHR surface{};
    checkVulkan(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(host_.physicalDevice, surface_, &surface),
                "vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
    uint32_t count = 0;
    vkGetPhysicalDeviceSurfaceFormatsKHR(host_.physicalDevice, surface_, &count, nullptr);
    std::vector<VkSurfaceFormatKHR> formats(count);
    vkGetPhysicalDeviceSurfaceFormatsKHR(host_.physicalDevice, surface_, &count, formats.data());
    if (formats.empty()) throw Failure("the window's surface offers no format");
    // UNORM: the last pass writes display values itself.
    VkSurfaceFormatKHR chosen = formats[0];
    for (const VkSurfaceFormatKHR& candidate : formats) {
        if (candidate.format == VK_FORMAT_B8G8R8A8_UNORM ||
            candidate.format == VK_FORMAT_R8G8B8A8_UNORM) {
            chosen = candidate;
            break;
        }
    }
    if (surface.currentExtent.width != 0xffffffffu) {
        extent = surface.currentExtent;
    } else {
        extent.width = std::clamp(static_cast<uint32_t>(width), surface.minImageExtent.width,
                                  surface.maxImageExtent.width);
        extent.height = std::clamp(static_cast<uint32_t>(height), surface.minImageExtent.height,
                                   surface.maxImageExtent.height);
    }
    if (extent.width == 0 || extent.height == 0) return false;

    VkSwapchainCreateInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR;
    info.surface = surface_;
    info.minImageCount = surface.minImageCount + 1;
    if (surface.maxImageCount)
        info.minImageCount = std::min(info.minImageCount, surface.maxImageCount);
    info.imageFormat = chosen.format;
    info.imageColorSpace = chosen.colorSpace;
    info.imageExtent = extent;
    info.imageArrayLayers = 1;
    info.imageUsage =
        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
        (surface.supportedUsageFlags & VkImageUsageFlags{VK_IMAGE_USAGE_TRANSFER_DST_BIT});
    takesCopies = (info.imageUsage & VK_IMAGE_USAGE_TRANSFER_DST_BIT) != 0;
    info.preTransform = surface.currentTransform;
    info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
    info.clipped = VK_TRUE;
    info.oldSwapchain = swapchain_;
    VkSwapchainKHR made = VK_NULL_HANDLE;
    checkVulkan(vkCreateSwapchainKHR(host_.device, &info, nullptr, &made), "vkCreateSwapchainKHR");
    vkDestroySwapchainKHR(host_.device, swapchain_, nullptr);
    swapchain_ = made;
    format = chosen.format;

    vkGetSwapchainImagesKHR(host_.device, swapchain_, &count, nullptr);
    images.resize(count);
    vkGetSwapchainImagesKHR(host_.device, swapchain_, &count, images.data());
    for (VkImage image : images) {
        VkImageViewCreateInfo viewInfo{};
        viewInfo.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
        viewInfo.image = image;
        viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
        viewInfo.format = format;
        viewInfo.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        VkImageView view = VK_NULL_HANDLE;
        checkVulkan(vkCreateImageView(host_.device, &viewInfo, nullptr, &view),
                    "vkCreateImageView");
        views.push_back(view);
        VkSemaphoreCreateInfo semaphoreInfo{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, nullptr, 0};
        VkSemaphore semaphore = VK_NULL_HANDLE;
        checkVulkan(vkCreateSemaphore(host_.device, &semaphoreInfo, nullptr, &semaphore),
                    "vkCreateSemaphore");
        rendered_.push_back(semaphore);
    }
    ++generation;
    stale_ = false;
    return true;
}

bool Window::poll(Input& input) {
    glfwPollEvents();
    input = {};
    input.wheel = wheel_;
    input.keys.swap(keys_);
    wheel_ = 0;
    double x = 0, y = 0;
    glfwGetCursorPos(window_, &x, &y);
    const bool left = glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS;
    const bool other = glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS ||
                       glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_MIDDLE) == GLFW_PRESS;
    const auto dx = static_cast<float>(x - lastX_), dy = static_cast<float>(y - lastY_);
    if (left && pressed_) input.dragX = dx, input.dragY = dy;
    if (other) input.panX = dx, input.panY = dy;
    if (left && !pressed_) pressX_ = x, pressY_ = y;
    int width = 1, height = 1;
    glfwGetWindowSize(window_, &width, &height);
    input.x = static_cast<float>(x / std::max(1, width));
    input.y = static_cast<float>(y / std::max(1, height));
    input.held = left;
    if (!left && pressed_ && std::hypot(x - pressX_, y - pressY_) < 4.0) {
        input.click = true;
        input.clickX = input.x;
        input.clickY = input.y;
    }
    pressed_ = left;
    lastX_ = x;
    lastY_ = y;
    auto held = [&](int key, int twin) {
        return glfwGetKey(window_, key) == GLFW_PRESS || glfwGetKey(window_, twin) == GLFW_PRESS
                   ? 1.0f
                   : 0.0f;
    };
    input.moveRight = held(GLFW_KEY_RIGHT, GLFW_KEY_D) - held(GLFW_KEY_LEFT, GLFW_KEY_A);
    input.moveForward = held(GLFW_KEY_UP, GLFW_KEY_W) - held(GLFW_KEY_DOWN, GLFW_KEY_S);
    input.turn = held(GLFW_KEY_E, GLFW_KEY_E) - held(GLFW_KEY_Q, GLFW_KEY_Q);
    if (glfwGetKey(window_, GLFW_KEY_ESCAPE) == GLFW_PRESS) return false;
    return !glfwWindowShouldClose(window_);
}

bool Window::acquire(VkSemaphore available, uint32_t& index) {
    for (int attempt = 0; attempt < 3; ++attempt) {
        if (stale_ && !makeSwapchain()) return false;
        const VkResult result = vkAcquireNextImageKHR(host_.device, swapchain_, ~0ull, available,
                                                      VK_NULL_HANDLE, &index);
        if (result == VK_ERROR_OUT_OF_DATE_KHR) {
            stale_ = true;
            continue;
        }
        // Draw the SUBOPTIMAL image, because its semaphore is already pending. Rebuild afterwards.
        if (result == VK_SUBOPTIMAL_KHR) {
            stale_ = true;
            return true;
        }
        checkVulkan(result, "vkAcquireNextImageKHR");
        return true;
    }
    return false;
}

void Window::present(uint32_t index) {
    VkPresentInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &rendered_[index];
    info.swapchainCount = 1;
    info.pSwapchains = &swapchain_;
    info.pImageIndices = &index;
    const VkResult result = vkQueuePresentKHR(host_.queue, &info);
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR) {
        stale_ = true;
    } else {
        checkVulkan(result, "vkQueuePresentKHR");
    }
}

void Window::limitRate(double framesPerSecond) {
    const double now = glfwGetTime();
    nextTime_ = std::max(nextTime_ + 1.0 / framesPerSecond, now - 0.1);
    if (nextTime_ > now) {
        std::this_thread::sleep_for(std::chrono::duration<double>(nextTime_ - now));
    }
}

}  // namespace sample
