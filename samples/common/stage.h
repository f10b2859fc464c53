// The host's frame: a ring of frames in flight, the scene pass, tone mapping, and a window or
// picture files. The sample and the plugin both draw into its scene pass.
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
    // Format of the scene. The stage tone maps RGBA16F and adds bloom. RGBA8 SRGB and UNORM already
    // hold display values and pass through.
    VkFormat colorFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    bool reversedDepth = false;                          // clears to 0 and tests with GREATER
    float clearColor[4] = {0.02f, 0.02f, 0.025f, 1.0f};  // linear
    uint32_t framesInFlight = 2;                         // [1, 4]
    float bloom = 0.06f;         // share of light that spreads, [0, 1]; RGBA16F only
    float exposure = 1.0f;       // multiplies RGBA16F before the filmic curve
    float vignette = 0.15f;      // [0, 1]
    bool capturesScene = false;  // allows captureScene(); needs RGBA16F and one sample
    bool halfEffects = false;    // with capturesScene: flames and smoke at half resolution
    // Applies --composite and --half. Both reduce the scene to one sample per pixel.
    void applyOptions(const Options& options);
};

// The images of the finished scene, for effects that composite over it in their own pass.
struct CapturedScene {
    VkImage color = VK_NULL_HANDLE;  // TRANSFER_SRC_OPTIMAL on entry and exit
    VkImageView colorView = VK_NULL_HANDLE;
    VkImage depth = VK_NULL_HANDLE;  // DEPTH_STENCIL_ATTACHMENT_OPTIMAL on entry and exit
    VkImageView depthView = VK_NULL_HANDLE;
    VkImageView copy = VK_NULL_HANDLE;  // a copy of the colour, SHADER_READ_ONLY_OPTIMAL
};

// Describes a scene pass to the code that draws in it.
struct ScenePass {
    VkRenderPass pass = VK_NULL_HANDLE;
    VkFormat colorFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    VkCompareOp depthCompare = VK_COMPARE_OP_LESS_OR_EQUAL;
    uint32_t framesInFlight = 2;  // [1, 4]
};

struct StageFrame {
    VkCommandBuffer commands = VK_NULL_HANDLE;  // primary, recording
    uint64_t frameIndex = 0;                    // starts at 1
    uint64_t completedFrameIndex = 0;  // the GPU has finished this frame and all earlier ones
    uint32_t slot = 0, framesInFlight = 0;
    uint32_t number = 0;  // index of the frame in this run, from 0
    double time = 0;      // s since the start of the run
    float deltaTime = 0;  // s since the previous frame
    VkExtent2D extent{};  // pixels
    VkViewport viewport{};
    Input input;  // windowed runs only
};

class Stage {
 public:
    // `frames`: length of a headless run. A windowed run with 0 ends when the window closes.
    Stage(const VulkanHost& host, const Options& options, const StageRequest& request,
          uint32_t frames);
    ~Stage();
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    // Waits for the frame's slot and begins its command buffer. Returns false when the run is over
    // and all pictures are delivered.
    bool next(StageFrame& frame);
    // Begins the scene pass with cleared colour and depth. Sets viewport and scissor unless
    // `secondaries`.
    void beginScene(const StageFrame& frame, bool secondaries = false);
    void endScene(const StageFrame& frame);
    // Copies the colour of the scene. Call it after endScene.
    CapturedScene captureScene(const StageFrame& frame);
    // Tone maps, submits, and presents or reads back.
    void finish(const StageFrame& frame);

    // Secondary command buffers, for engines that record in parallel: begin, record, execute.
    VkCommandBuffer beginSecondary(const StageFrame& frame, bool insideScene);
    void executeSecondary(const StageFrame& frame, VkCommandBuffer commands);

    // Headless: receives each frame's picture in order, some frames after its recording.
    std::function<void(uint32_t number, Picture&& picture)> onPicture;

    // Records into the last pass, over the finished picture: display values, one attachment, no
    // depth.
    std::function<void(VkCommandBuffer commands)> overlay;

    StageRequest made;
    VkRenderPass outputPass() const { return postPass_; }
    VkRenderPass scenePass = VK_NULL_HANDLE;
    VkFormat depthFormat = VK_FORMAT_UNDEFINED;
    // A pipeline in the scene pass must use this compare operation.
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
        uint64_t frameIndex = 0;  // of the slot's last use
        uint32_t number = 0;
        bool pending = false;  // its picture is not delivered yet
    };
    void makePasses();
    void makeTargets();
    void destroyTargets();
    void createPostPass();
    void collect(Slot& slot);
    void downsampleBloom(const StageFrame& frame);
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
