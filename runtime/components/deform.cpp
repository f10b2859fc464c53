#include "components/deform.h"

#include "components/appearance_table.h"
#include "core/error.h"
#include "core/reserved.h"

#include <algorithm>
#include <cmath>

namespace fw::components {
namespace {

constexpr uint32_t kTiers = FW_BURNABLE_RECEDE | FW_BURNABLE_SHELL | core::reserved::kSolver;
// Flags of which a def may have one.
constexpr uint32_t kOne = kTiers | FW_BURNABLE_REFINE | core::reserved::kRefinement;

// m/s at which a flat sheet of 0.08 kg/m^2 falls.
constexpr float kFlutter = 1.2f;

uint32_t ticksOf(float seconds) noexcept {
    return uint32_t(std::clamp(seconds * float(gpu::kTicksPerSecond), 1.0f, 4.0e9f));
}

gpu::DeformMaterial makeMaterial(const FwMaterialDef& def, const gpu::BurnMaterial& record,
                                 bool harmed, bool holes, bool sheet) noexcept {
    gpu::DeformMaterial made{};
    made.charTicks = made.holeTicks = gpu::kNoneTexel;
    const float weight = std::max(def.thickness * def.density, 0.02f);  // kg/m^2
    made.drag = 9.81f / (kFlutter * std::sqrt(weight / 0.08f));
    made.shrink = def.shrink;
    made.curl = def.curl;
    made.bend = freshBend(def.appearance);
    if (!(record.flags & 1) || !harmed) return made;
    made.charTicks = record.flameTicks;
    made.depth = def.recede * def.thickness;
    const float opens = materialAppearance(def.appearance).holeTime;
    if (holes && opens > 0 && record.timeScale > 0) {
        made.holeSeconds = opens;
        made.holeTicks = ticksOf(opens / record.timeScale);
        // A sheet curls before it has a hole.
        if (sheet) made.charTicks = uint32_t(float(made.holeTicks) * 1.15f);
    }
    return made;
}

}  // namespace

void checkDeform(const FwBurnableMeshDef& def) {
    if ((def.flags & FW_BURNABLE_SKINNED) && (def.flags & kOne))
        core::refuse(
            "FwBurnableMeshDef::flags is 0x%x; FW_BURNABLE_SKINNED moves what "
            "deformation or refinement would: one of them.",
            def.flags);
    const uint32_t tiers = def.flags & kOne;
    if (tiers & (tiers - 1))
        core::refuse(
            "FwBurnableMeshDef::flags is 0x%x; of REFINE, RECEDE, SHELL, 64 and 512 one is "
            "possible.",
            def.flags);
    checkLength(def.ground, "FwBurnableMeshDef::ground", -1e9f, 1e9f);
    checkWhole(def.pinCount, "FwBurnableMeshDef::pinCount", 0, gpu::kMaxPins);
    if (def.pinCount && !def.pins)
        core::refuse("FwBurnableMeshDef::pins is null but pinCount is %u.", def.pinCount);
    for (uint32_t i = 0; i < def.pinCount; ++i) {
        checkLengths(def.pins[i].from, 3, "FwPin::from", -1e6f, 1e6f);
        checkLengths(def.pins[i].to, 3, "FwPin::to", -1e6f, 1e6f);
        checkLength(def.pins[i].radius, "FwPin::radius", 0, 1e6f);
        checkValue(def.pins[i].reserved, "FwPin::reserved", 0, 0);
    }
}

bool deforms(const BurnableMesh& object) noexcept { return (object.flags & kTiers) != 0; }

gpu::DeformObject makeDeform(const FwBurnableMeshDef& def, const BurnableMesh& object,
                             const Records& records) noexcept {
    gpu::DeformObject made{};
    if (object.flags & FW_BURNABLE_RECEDE) made.flags |= gpu::kDeformRecede;
    if (object.flags & FW_BURNABLE_SHELL) made.flags |= gpu::kDeformShell;
    if (object.flags & core::reserved::kSolver) made.flags |= gpu::kDeformExtended;
    made.ground = def.ground;
    made.scale = object.pose.scale;
    FW_ASSERT(def.pinCount <= gpu::kMaxPins, "%u pins", def.pinCount);
    made.pinCount = def.pinCount;
    for (uint32_t i = 0; i < def.pinCount; ++i) {
        const FwPin& pin = def.pins[i];
        made.pins[i * 2] = gpu::vec4(pin.from[0], pin.from[1], pin.from[2], pin.radius);
        made.pins[i * 2 + 1] = gpu::vec4(pin.to[0], pin.to[1], pin.to[2], 0);
    }
    const bool sheet = (object.flags & FW_BURNABLE_SHELL) != 0;
    const bool holes = (object.flags & FW_BURNABLE_NO_HOLES) == 0;
    const bool harmed = (object.flags & FW_BURNABLE_NO_DAMAGE) == 0;
    for (uint32_t i = 0; i < kMaterials; ++i)
        if (object.materialMask >> i & 1)
            made.materials[i] =
                makeMaterial(object.materials[i], records.materials[i], harmed, holes, sheet);
    return made;
}

}  // namespace fw::components
