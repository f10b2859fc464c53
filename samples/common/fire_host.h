// All that an engine with its own Vulkan device writes to have fire: lend the device, prepare,
// register the pass, then two calls a frame. Read this and fire_host.cpp as documentation.
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

// Where the frame is seen from, and when.
void setCamera(FwView& view, const Camera& camera, const StageFrame& frame, bool reversed = false);

// Lends the host's device and builds the pipelines, or leaves them to the caller, who prepares the
// context then. Throws Failure with the reason. The caller destroys the context, after a wait for
// the device.
FwContext* createContext(const VulkanHost& host, bool prepares = true);

// The images of a scene that is lent, for a pass of ours over it.
FwVulkanComposite compositeOf(const LentScene& scene, VkExtent2D extent);

class FireHost {
 public:
    // Lends the device, builds the pipelines, makes the world. Throws Failure with the reason.
    FireHost(const VulkanHost& host, const FwWorldDef& worldDef);
    ~FireHost();  // waits for the device first: nothing of ours may be in use when it goes
    FireHost(const FireHost&) = delete;
    FireHost& operator=(const FireHost&) = delete;

    // Tells the plugin about the stage's scene pass, or where the stage lends its scene about the
    // pass that we make over it. Once, and again if the pass changes. `surfaces`: where the
    // scene is lent, burning meshes are drawn in its pass before.
    void registerTarget(const Stage& stage, bool surfaces = false);
    // Outside any pass, before it, once per frame: simulates. `secondary` may be null.
    void recordOutside(const StageFrame& frame, const FwView& view,
                       VkCommandBuffer secondary = VK_NULL_HANDLE);
    // The same for several views, each with a viewId of its own.
    void recordOutside(const StageFrame& frame, std::span<const FwView> views,
                       VkCommandBuffer secondary = VK_NULL_HANDLE);
    // Inside the scene pass: draws; where the stage lends its scene the surfaces alone.
    void recordInside(const StageFrame& frame, const FwView& view,
                      VkCommandBuffer secondary = VK_NULL_HANDLE);
    // After the scene pass instead of recordInside, where the stage lends its scene: flames and
    // heat haze over it.
    void recordOver(const StageFrame& frame, const FwView& view, const LentScene& scene);
    // Throws Failure("<what>: <why>") unless result is FW_OK.
    void check(FwResult result, const char* what) const;

    // As of the last readback.
    FwObjectState objectState(FwBurnableMeshId object) const;
    // Mean milliseconds per pass over the frames so far, for the summary.
    std::vector<PassCost> passCosts() const { return costs_; }

    FwContext* context = nullptr;
    FwWorld* world = nullptr;
    FwTargetId target{};      // of what is drawn in the scene pass; null: nothing is
    FwTargetId overScene{};   // of what goes over a lent scene
    bool slotPacing = false;  // give slot and ring size instead of the completed frame's number

 private:
    FwVulkanFrame describe(const StageFrame& frame, VkCommandBuffer secondary) const;
    void countPasses();
    VkDevice device_ = VK_NULL_HANDLE;
    std::vector<PassCost> costs_;
    uint64_t lastTimed_ = 0;
};

}  // namespace sample
