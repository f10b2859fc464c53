// The pretend engine's frame: a ring of frames in flight, the scene pass, tone mapping, and either
// a window or pictures. A sample draws into it; the plugin draws into the same pass.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "common/picture.h"
#include "common/vulkan_host.h"
#include "common/window.h"

namespace sample {

struct StageRequest {
    std::string title = "Flamewright";
    // Of the scene. RGBA16F is tone mapped by the stage, with bloom; RGBA8 SRGB and UNORM hold
    // display values already and pass through.
    VkFormat colorFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    bool reversedDepth = false;                          // clear to 0, GREATER wins
    float clearColor[4] = {0.02f, 0.02f, 0.025f, 1.0f};  // linear
    uint32_t framesInFlight = 2;                         // [1, 4]
    float bloom = 0.06f;       // [0, 1] share of light spread around; RGBA16F only
    float exposure = 1.0f;     // multiplies RGBA16F before the film curve
    float vignette = 0.15f;    // [0, 1]
    bool lendScene = false;    // lendScene() may be called; RGBA16F and one sample only
    bool halfEffects = false;  // with it: flames and smoke go over it at half resolution
    // Of the sample's command line; then the scene has one sample a pixel.
    void lendAs(const Options& options);
};

// The scene after its pass, for who draws over it in a pass of its own.
struct LentScene {
    VkImage color = VK_NULL_HANDLE;  // TRANSFER_SRC_OPTIMAL, before and after
    VkImageView colorView = VK_NULL_HANDLE;
    VkImage depth = VK_NULL_HANDLE;  // DEPTH_STENCIL_ATTACHMENT_OPTIMAL, before and after
    VkImageView depthView = VK_NULL_HANDLE;
    VkImageView copy = VK_NULL_HANDLE;  // of the colour, SHADER_READ_ONLY_OPTIMAL
};

// A scene pass, for what draws in it.
struct ScenePass {
    VkRenderPass pass = VK_NULL_HANDLE;
    VkFormat colorFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    VkCompareOp depthCompare = VK_COMPARE_OP_LESS_OR_EQUAL;
    uint32_t framesInFlight = 2;  // [1, 4]
};

struct StageFrame {
    VkCommandBuffer commands = VK_NULL_HANDLE;  // primary, recording
    uint64_t frameIndex = 0;                    // from 1, grows by one
    uint64_t completedFrameIndex = 0;           // the GPU is done with this and all before
    uint32_t slot = 0, framesInFlight = 0;
    uint32_t number = 0;  // from 0: which frame of the run this is
    double time = 0;      // s since the run began
    float deltaTime = 0;  // s since the frame before
    VkExtent2D extent{};  // pixels
    VkViewport viewport{};
    Input input;  // windowed only
};

class Stage {
 public:
    // `frames`: how many to run headless; with a window 0 runs until it is closed.
    Stage(const VulkanHost& host, const Options& options, const StageRequest& request,
          uint32_t frames);
    ~Stage();
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    // Waits for the frame's slot and begins its command buffer. False: the run is over (all
    // pictures have been delivered).
    bool next(StageFrame& frame);
    // The scene pass: colour and depth cleared, viewport and scissor set (unless `secondaries`).
    void beginScene(const StageFrame& frame, bool secondaries = false);
    void endScene(const StageFrame& frame);
    // After endScene. Copies its colour.
    LentScene lendScene(const StageFrame& frame);
    // Tone maps, submits, and presents or reads back.
    void finish(const StageFrame& frame);

    // Secondary buffers for engines that record in parallel: begin, record, then execute.
    VkCommandBuffer beginSecondary(const StageFrame& frame, bool insideScene);
    void executeSecondary(const StageFrame& frame, VkCommandBuffer commands);

    // Headless: every frame's picture, in order, some frames after it was recorded.
    std::function<void(uint32_t number, Picture&& picture)> onPicture;

    // Inside the last pass, over the finished picture: display values, one attachment, no depth.
    std::function<void(VkCommandBuffer commands)> overlay;

    StageRequest made;
    VkRenderPass outputPass() const { return postPass_; }
    VkRenderPass scenePass = VK_NULL_HANDLE;
    VkFormat depthFormat = VK_FORMAT_UNDEFINED;
    // What a pipeline in the scene pass needs to agree with the stage.
    VkCompareOp depthCompare() const {
        return made.reversedDepth ? VK_COMPARE_OP_GREATER_OR_EQUAL : VK_COMPARE_OP_LESS_OR_EQUAL;
    }
    ScenePass describePass() const {
        return {scenePass, made.colorFormat, made.samples, depthCompare(),
                static_cast<uint32_t>(slots_.size())};
    }
    VkExtent2D extent() const { return extent_; }
    uint32_t frames() const { return frameLimit_; }

 private:
    struct Slot {
        VkCommandPool pool = VK_NULL_HANDLE;
        VkCommandBuffer commands = VK_NULL_HANDLE;
        std::vector<VkCommandBuffer> secondaries;
        uint32_t secondariesUsed = 0;
        VkFence fence = VK_NULL_HANDLE;
        VkSemaphore available = VK_NULL_HANDLE;
        Buffer readback;
        uint64_t frameIndex = 0;  // of its last use
        uint32_t number = 0;
        bool pending = false;  // its picture has not been delivered
    };
    void makePasses();
    void makeTargets();
    void dropTargets();
    void makePost();
    void collect(Slot& slot);
    void spreadLight(const StageFrame& frame);
    void drawPost(const StageFrame& frame, VkPipeline pipeline, VkRenderPass pass,
                  VkFramebuffer framebuffer, VkExtent2D extent,
                  const std::function<void(VkCommandBuffer)>& over = {});

    const VulkanHost& host_;
    double fps_;
    uint32_t frameLimit_, sceneMips_ = 1;
    std::unique_ptr<Window> window_;
    uint32_t windowGeneration_ = 0, imageIndex_ = 0;
    VkExtent2D extent_{};
    std::vector<Slot> slots_;
    uint64_t frameIndex_ = 0, completed_ = 0;
    uint32_t number_ = 0;
    double time_ = 0, lastClock_ = 0;

    Image color_, multisampled_, depth_, copy_, bloom_, output_;
    VkFormat outputFormat_ = VK_FORMAT_R8G8B8A8_UNORM;
    VkFramebuffer sceneFramebuffer_ = VK_NULL_HANDLE, bloomFramebuffer_ = VK_NULL_HANDLE;
    std::vector<VkFramebuffer> outputFramebuffers_;
    VkRenderPass postPass_ = VK_NULL_HANDLE, bloomPass_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout postSetLayout_ = VK_NULL_HANDLE;
    VkDescriptorPool descriptorPool_ = VK_NULL_HANDLE;
    VkDescriptorSet postSet_ = VK_NULL_HANDLE;
    VkPipelineLayout postLayout_ = VK_NULL_HANDLE;
    VkPipeline postPipeline_ = VK_NULL_HANDLE, bloomPipeline_ = VK_NULL_HANDLE;
    VkSampler sampler_ = VK_NULL_HANDLE;
};

}  // namespace sample
