// All code that an engine with its own Vulkan device needs for fire: pass the device, prepare,
// register the scene pass, then two calls per frame. Read it with fire_host.cpp as documentation.
#pragma once

#include <span>
#include <vector>

#include "common/camera.h"
#include "common/progress.h"
#include "common/stage.h"
#include "flamewright/flamewright.h"
#include "flamewright/flamewright_debug.h"
#include "flamewright/flamewright_vulkan.h"

namespace sample {

// Fills the view's camera and time.
void setCamera(FwView& view, const Camera& camera, const StageFrame& frame, bool reversed = false);

// Creates a context on the host's device and builds the pipelines. With `prepares` false, the
// caller prepares the context. The caller waits for the device, then destroys the context. Throws
// Failure with the reason.
FwContext* createContext(const VulkanHost& host, bool prepares = true);

// Describes the scene's images to a composite pass of the plugin.
FwVulkanComposite describeComposite(const CapturedScene& scene, VkExtent2D extent);

class FireHost {
 public:
    // Creates the context, builds the pipelines, creates the world. Throws Failure with the reason.
    FireHost(const VulkanHost& host, const FwWorldDef& worldDef);
    ~FireHost();  // waits for the device, because destruction requires idle resources
    FireHost(const FireHost&) = delete;
    FireHost& operator=(const FireHost&) = delete;

    // Registers the stage's scene pass, or the composite pass over the captured scene. Call it
    // once, and again whenever the pass changes. `surfaces`: also draw burning meshes in the scene
    // pass when the scene is captured.
    void registerTarget(const Stage& stage, bool surfaces = false);
    // Simulates. Call it once per frame, before and outside any pass. `secondary` may be null.
    void recordOutside(const StageFrame& frame, const FwView& view,
                       VkCommandBuffer secondary = VK_NULL_HANDLE);
    // The same for several views, each with its own viewId.
    void recordOutside(const StageFrame& frame, std::span<const FwView> views,
                       VkCommandBuffer secondary = VK_NULL_HANDLE);
    // Draws inside the scene pass. If the stage captures its scene, draws the surfaces only.
    void recordInside(const StageFrame& frame, const FwView& view,
                      VkCommandBuffer secondary = VK_NULL_HANDLE);
    // Composites flames and heat haze over a captured scene. Call it after the scene pass instead
    // of recordInside.
    void recordOver(const StageFrame& frame, const FwView& view, const CapturedScene& scene);
    // Throws Failure("<what>: <why>") unless result is FW_OK.
    void check(FwResult result, const char* what) const;

    // State as of the last readback.
    FwObjectState objectState(FwBurnableMeshId object) const;
    // Mean milliseconds per pass so far, for the summary.
    std::vector<PassCost> passCosts() const { return costs_; }

    FwContext* context = nullptr;
    FwWorld* world = nullptr;
    FwTargetId target{};      // target in the scene pass; null: none
    FwTargetId overScene{};   // target of the composite pass over a captured scene
    bool slotPacing = false;  // pass slot and ring size instead of the completed frame's number

 private:
    FwVulkanFrame describe(const StageFrame& frame, VkCommandBuffer secondary) const;
    void countPasses();
    VkDevice device_ = VK_NULL_HANDLE;
    std::vector<PassCost> costs_;
    uint64_t lastTimed_ = 0;
};

}  // namespace sample
