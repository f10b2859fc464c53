// The SPIR-V of a shader, embedded as words.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>

namespace fw::gpu {

struct ShaderCode {
    const char* name;  // as the file without ".glsl": "arrival.comp", "surface.frag"
    std::span<const std::uint32_t> words;
};

// Looks in the extension first, if there is one. Null: no shader has that name.
[[nodiscard]] const ShaderCode* findShader(std::string_view name) noexcept;

}  // namespace fw::gpu
