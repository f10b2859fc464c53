// The shipped library has no extension: it refuses the bits that belong to one.
#include "core/error.h"
#include "core/reserved.h"
#include "gpu/extension.h"

namespace fw {
namespace {

struct Bit {
    uint32_t value;
    const char* name;
};

void refuseBit(uint32_t flags, const Bit& bit, const char* field) {
    if (flags & bit.value)
        core::refuse("%s is 0x%x; %s is not in this library. Link flamewright_reference instead.",
                     field, flags, bit.name);
}

}  // namespace

void core::reserved::checkBurnable(uint32_t flags) {
    for (const Bit& bit :
         {Bit{kBurning, "FW_BURNABLE_PUBLISHED"}, Bit{kRefinement, "FW_BURNABLE_REFINE_PUBLISHED"},
          Bit{kSolver, "FW_BURNABLE_SPRINGS"}, Bit{kDepth, "FW_BURNABLE_DEPTH_PEEL"}})
        refuseBit(flags, bit, "FwBurnableMeshDef::flags");
}

void core::reserved::checkField(uint32_t flags) {
    refuseBit(flags, {kFieldStill, "FW_FIELD_AS_PUBLISHED"}, "FwParticleFieldDef::flags");
}

void core::reserved::checkFireTier(uint32_t tier, const char* field) {
    if (tier == kFireTier) refuseBit(tier, {kFireTier, "FW_FIRE_TIER_SLICES"}, field);
}

void core::reserved::checkSwitches(uint32_t switches) {
    refuseBit(switches, {kSwitchNoDepth, "FW_DEBUG_NO_DEPTH_PEEL"}, "switches");
}

const gpu::Extension* gpu::extension() noexcept { return nullptr; }

}  // namespace fw
