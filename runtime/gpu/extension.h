// Passes and methods that a library linked with this one adds. The linker chooses: the shipped
// library links plugin/src/no_extension.cpp.
#pragma once
#include "gpu/passes/draw.h"
#include "shader_code.h"

#include <array>
#include <cstddef>
#include <span>

namespace fw::gpu {
namespace vk {
struct VkMethods;  // vk_extension.h
}
namespace cpu {
struct CpuMethods;  // cpu_state.h
}

struct VolumeCall {  // a draw of one volumetric flame, of vertices that the shader makes
    uint32_t flame = 0, vertices = 0, instances = 0;
    std::array<std::byte, 64> push{};
};

struct Extension {
    std::span<const ShaderCode> shaders;         // found before the library's
    std::span<const ComputePass> computePasses;  // numbered behind those of passes.inl
    std::span<const DrawPass> drawPasses;        // numbered behind kDrawPassCount
    // Volumetric flames of core::reserved::kFireTier, where an output with this FwOutputEncoding
    // can show them. `from`, `to`: thresholds of the fade between tiers.
    bool (*showsVolumes)(uint32_t encoding) noexcept;
    uint32_t volumePass;
    VolumeCall (*volumeCall)(const VolumeItem& item, float from, float to) noexcept;
    // Objects with kObjectDepthFirst are drawn into depth alone, by this pass, before they are
    // drawn.
    uint32_t depthPass;
    // Moves the particles of objects with kDeformExtended, in each step of solvers.
    ComputePassOf<DeformPush> deformPass;
    // Burns the texels of objects with kObjectExtended, in each step of the simulation.
    ComputePassOf<StepPush> stepPass;
    const vk::VkMethods* vulkan;
    const cpu::CpuMethods* cpu;
};

// Null: there is none.
[[nodiscard]] const Extension* extension() noexcept;

}  // namespace fw::gpu
