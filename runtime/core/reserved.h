// Bits of the C API that belong to an extension: methods that a library linked with this one adds.
// Their values stay free in flamewright.h.
#pragma once
#include <cstdint>

namespace fw::core::reserved {

// FwBurnableFlags: burns by another rule, another refinement, another deformation, depth drawn
// before colour.
constexpr uint32_t kBurning = 4, kRefinement = 64, kSolver = 512, kDepth = 8192;
constexpr uint32_t kFieldStill = 2;       // FwParticleFieldFlags: not interpolated, at 10 Hz
constexpr uint32_t kFireTier = 4;         // FwFireTier
constexpr uint32_t kSwitchNoDepth = 256;  // FwDebugSwitch

// Throws FW_ERROR_INVALID_ARGUMENT if a field holds such bits and no extension is linked.
void checkBurnable(uint32_t flags);
void checkField(uint32_t flags);
void checkFireTier(uint32_t tier, const char* field);
void checkSwitches(uint32_t switches);

}  // namespace fw::core::reserved
