// The bindings that shaders declare, read from their SPIR-V: no pass lists its buffers again.
#pragma once
#include "gpu/passes/pass.h"

#include <memory_resource>

namespace fw::gpu {

// The bindings of a shader, or of several that share a pipeline layout.
class ShaderInterface {
 public:
    // Adds the declarations of the module `words`. Throws std::bad_alloc; FW_ERROR_INTERNAL if the
    // shaders together bind more than kMost.
    void add(std::span<const uint32_t> words, std::pmr::memory_resource* memory);

    static constexpr uint32_t kMost = 32;
    // Set 0. A buffer that some shader writes is one `write`, beside its `readTexels` if it is read
    // by texels.
    [[nodiscard]] std::span<const Use> uses() const noexcept { return {uses_.data(), count_}; }
    [[nodiscard]] uint32_t sets() const noexcept { return sets_; }  // of the pipeline layout
    [[nodiscard]] bool usesView() const noexcept;
    // Whether it does something else for each view.
    [[nodiscard]] bool isPerView() const noexcept;

 private:
    void add(const Use& use);
    std::array<Use, kMost> uses_{};
    uint32_t count_ = 0, sets_ = 1;
};

// The shader of a pass. `texels`: the device has texel buffers.
[[nodiscard]] std::span<const uint32_t> codeOf(const ComputePass& pass, bool texels);
[[nodiscard]] ShaderInterface interfaceOf(const ComputePass& pass, bool texels,
                                          std::pmr::memory_resource* memory);
[[nodiscard]] ShaderInterface interfaceOf(const DrawPass& pass, bool texels,
                                          std::pmr::memory_resource* memory);
// The embedded shader `name`. Throws FW_ERROR_INTERNAL if there is none.
[[nodiscard]] std::span<const uint32_t> shaderCode(std::string_view name);

}  // namespace fw::gpu
