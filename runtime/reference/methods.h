// The methods of papers that Flamewright is compared with, as an extension of the library.
#pragma once
#include "gpu/cpu/cpu_state.h"
#include "gpu/extension.h"
#include "gpu/vk/vk_extension.h"

namespace fw::reference {

// Draw passes, numbered from kDrawPassCount.
enum DrawNumber : uint32_t { kDepthPeel, kVolumeSlices };
constexpr uint32_t numberOf(DrawNumber pass) noexcept { return gpu::kDrawPassCount + pass; }

// slices.cpp
bool showsSlices(uint32_t encoding) noexcept;
gpu::VolumeCall drawSlices(const gpu::VolumeItem& item, float from, float to) noexcept;

// Compute passes, numbered from pass::count.
enum ComputeNumber : uint32_t { kSprings, kRefinePattern, kPublished };
template <class Push>
constexpr gpu::ComputePassOf<Push> passOf(ComputeNumber pass) noexcept {
    return {uint32_t{gpu::pass::count} + uint32_t{pass}};
}

// cpu_published.cpp: see gpu::cpu::CpuMethods
void createPublished(gpu::cpu::CpuObject& object);
void publishedEvent(gpu::cpu::CpuObject& object, uint32_t texel, bool burns) noexcept;
void publishedStep(gpu::cpu::CpuBackend::State& s, uint32_t now) noexcept;

// springs.cpp
void createSprings(gpu::vk::BackendState& s, gpu::vk::ObjectEntry& fresh,
                   const gpu::ObjectInit& init, uint64_t last);

// vk_pattern.cpp: see gpu::vk::VkMethods
void createPatternModel(gpu::vk::BackendState& s, uint32_t mesh, uint32_t depth,
                        const mesh::BurnDomain& domain, const mesh::RefineModel& model);
void dropPatternModels(gpu::vk::BackendState& s, uint32_t mesh) noexcept;
void createPattern(gpu::vk::BackendState& s, gpu::vk::ObjectEntry& fresh,
                   const gpu::ObjectInit& init, uint64_t last);
void dropPattern(gpu::vk::BackendState& s, gpu::vk::ObjectEntry& object) noexcept;
void startPatternBoundary(gpu::vk::BackendState& s, gpu::vk::ObjectEntry& object,
                          const float point[3], uint32_t tick) noexcept;
uint64_t planPatterns(gpu::vk::BackendState& s);
void recordPatterns(gpu::vk::BackendState& s, gpu::vk::FrameInFlight& slot);
uint32_t listedCount(const gpu::vk::BackendState& s, const gpu::vk::ObjectEntry& object) noexcept;

}  // namespace fw::reference
