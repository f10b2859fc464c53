// Several objects on several meshes, random plans for them, and a backend on a test device that
// runs these plans. For the equality tests of the backends.
#pragma once
#include "core/memory.h"
#include "gpu/vk/vk_backend.h"
#include "shared/volume.h"
#include "support/meshes.h"
#include "support/vulkan_device.h"

#include <atomic>
#include <functional>
#include <random>

namespace fw::test {

struct SceneObject {
    uint32_t mesh = 0;
    std::array<gpu::BurnMaterial, gpu::kMaterialsPerObject> materials{};
    std::vector<uint16_t> slowness;  // empty: the mesh's own
    uint32_t window = 512, substepShift = 0;
    uint32_t flags = 0;      // kObject..., beyond live
    bool refine = false;     // down to 4 halvings
    bool reference = false;  // refined by the reference pattern
    float refinePixelsPerEdge = 8;
    gpu::DeformObject deform{};           // without flags it does not deform
    std::vector<gpu::HeatMaterial> heat;  // empty: none
};

struct BurnScene {
    std::vector<mesh::BurnDomain> domains;
    std::vector<SceneObject> objects;
    std::vector<mesh::DeformModel> models;  // one per domain if an object deforms
    bool refinesByReference = false;        // an object of the first mesh does

    // `densityScale` 1: some 2000 texels per mesh. With $FLAMEWRIGHT_ASSETS also two loaded meshes.
    static BurnScene make(uint32_t seed, double densityScale = 1);
    // Gives all objects heat: thick wood and thin cloth, damp and dry, at some 100 times the pace.
    void addHeat();
    // Builds the reference refinement model of two halvings.
    void refineByReference();
    void create(gpu::Backend& backend) const;
    [[nodiscard]] gpu::ObjectInit init(uint32_t object) const;
};

// A material without preset: speeds in m/s, times in s, drive in its own unit.
gpu::BurnMaterial plainMaterial(const mesh::BurnDomain& domain, double rate, double gain = 0,
                                double burnTime = -1);

// Owns the data that a FramePlan points to.
struct OwnedPlan {
    gpu::FramePlan plan;
    std::vector<gpu::StepPlan> steps;
    std::vector<std::vector<gpu::TexelEvent>> events;
    std::vector<std::vector<gpu::MaterialUpdate>> updates;
    std::vector<gpu::Probe> probes;
    std::vector<uint32_t> maps;
    void point();  // points the spans at the filled vectors
};

// Random ignitions, extinguishing, drying and wind latches; the fire never dies out.
class PlanMaker {
 public:
    PlanMaker(const BurnScene& scene, uint32_t seed) : scene_(scene), random_(seed) {}
    // `maps`: also reads back every object's whole state.
    OwnedPlan next(uint32_t steps, bool maps, uint32_t switches = 0);
    [[nodiscard]] uint32_t now() const { return now_; }
    double latches = 0.1, events = 0.25;  // probabilities per step

 private:
    uint32_t pick(uint32_t count) { return uint32_t(random_() % count); }
    bool chance(double p) { return double(random_() % 100000) < p * 100000; }
    void ball(std::vector<gpu::TexelEvent>& out, uint32_t object, uint32_t kind, float radius);

    const BurnScene& scene_;
    std::mt19937 random_;
    uint32_t now_ = 4096, step_ = 0;
    uint64_t frame_ = 0;
};

// Tables, textures and view block of the components as the C edge passes them to a backend.
gpu::AppearanceSources testAppearances();
// From `eye` to `target`, vertical field of view in degrees; Vulkan clip space.
FwView testView(const float eye[3], const float target[3], float degrees, float aspect,
                bool reversedDepth);

// The first flame of a lone volumetric fire in still air, `seconds` after creation.
gpu::VolumeFlame flameAlone(const FwVolumetricFireDef& def, float seconds);

// A copy of a backend's answer about one frame.
struct FrameAnswer {
    uint64_t frameIndex = 0;
    std::vector<std::vector<uint32_t>> maps;  // by object
    std::vector<std::vector<gpu::uvec2>> heat;
    std::vector<gpu::ObjectCounters> counters;
    std::vector<gpu::ProbeAnswer> answers;
    uint32_t hotTiles = 0;
    uint32_t frontTiles = 0, runTiles = 0, burningTiles = 0;
};
FrameAnswer copyAnswer(const gpu::Readback& readback);

// A context and a backend on a test device, driven like a host does.
class VkRig {
 public:
    explicit VkRig(TestDevice& device, uint32_t inFlight = 2, uint64_t budget = 0,
                   const gpu::vk::WorldLimits& limits = {},
                   PFN_vkGetInstanceProcAddr entry = nullptr);
    // Records and submits one frame; its answers come some frames later.
    void run(const gpu::FramePlan& plan);
    // Recorded in the same command buffer, after the outside part.
    std::function<void(const FwVulkanFrame&)> alsoRecord;
    std::vector<FrameAnswer> applyAnswers() { return std::exchange(answers_, {}); }
    // Waits and fetches the outstanding answers.
    std::vector<FrameAnswer> finish();

    FwVulkanHost host;
    std::atomic<uint64_t> allocations{0};  // through `memory`
    core::Memory memory;
    core::Log log;
    gpu::vk::Context context;
    gpu::vk::VkBackend backend;
    HostFrames frames;
    FwView view{};

 private:
    void collect();
    std::vector<FrameAnswer> answers_;
};

}  // namespace fw::test
