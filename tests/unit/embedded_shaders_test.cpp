// Every embedded shader is valid SPIR-V 1.0 that needs no device feature (Vulkan 1.0).
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <vector>

#include "embedded_shaders.h"
#include "gpu/extension.h"

namespace {

using fw::gpu::ShaderCode;

// The shaders of the library and of the reference methods.
std::vector<ShaderCode> allShaders() {
    const auto own = fw::gpu::embeddedShaders(), more = fw::gpu::extension()->shaders;
    std::vector<ShaderCode> all(own.begin(), own.end());
    all.insert(all.end(), more.begin(), more.end());
    return all;
}

constexpr std::uint32_t kMagic = 0x07230203u;
constexpr std::uint32_t kVersion10 = 0x00010000u;
constexpr std::size_t kHeaderWords = 5;
constexpr std::uint32_t kOpCapability = 17;
// Capabilities of Vulkan 1.0 without any feature.
const std::set<std::uint32_t> kFreeCapabilities{
    0,   // Matrix
    1,   // Shader
    43,  // Sampled1D
    44,  // Image1D
    46,  // SampledBuffer
    47,  // ImageBuffer
    50,  // ImageQuery
    51,  // DerivativeControl
};

// Shaders of the reference methods may have the names of the library's, which they replace.
TEST(EmbeddedShaders, NamesAreUniqueAndFound) {
    std::set<std::string> replaced;
    for (const auto shaders : {fw::gpu::extension()->shaders, fw::gpu::embeddedShaders()}) {
        std::set<std::string> names;
        for (const ShaderCode& shader : shaders) {
            EXPECT_TRUE(names.insert(shader.name).second) << shader.name << " is embedded twice";
            if (replaced.count(shader.name) == 0) {
                EXPECT_EQ(fw::gpu::findShader(shader.name)->words.data(), shader.words.data());
            }
        }
        replaced = names;
    }
    EXPECT_EQ(fw::gpu::findShader("no such shader.comp"), nullptr);
}

TEST(EmbeddedShaders, NeedNoDeviceFeature) {
    for (const ShaderCode& shader : allShaders()) {
        ASSERT_GT(shader.words.size(), kHeaderWords) << shader.name;
        EXPECT_EQ(shader.words[0], kMagic) << shader.name;
        EXPECT_EQ(shader.words[1], kVersion10) << shader.name;
        std::size_t at = kHeaderWords;
        while (at < shader.words.size() && (shader.words[at] & 0xffffu) == kOpCapability) {
            EXPECT_TRUE(kFreeCapabilities.contains(shader.words[at + 1]))
                << shader.name << " needs SPIR-V capability " << shader.words[at + 1];
            at += shader.words[at] >> 16;
        }
    }
}

// Drivers warn about each at pipeline creation, though the validator accepts some.
TEST(EmbeddedShaders, DecorateStructMembersAsDriversExpect) {
    // SpecId, Block, BufferBlock, ArrayStride, GLSLShared, GLSLPacked, CPacked, Invariant,
    // Restrict, Aliased, Constant, Index, Binding, DescriptorSet, LinkageAttributes, NoContraction,
    // InputAttachmentIndex
    const std::set<std::uint32_t> kOfWholes{1,  2,  3,  6,  8,  9,  10, 18, 19,
                                            20, 22, 32, 33, 34, 41, 42, 43};
    constexpr std::uint32_t kOpMemberDecorate = 72;
    for (const ShaderCode& shader : allShaders()) {
        for (std::size_t at = kHeaderWords; at < shader.words.size();) {
            const std::uint32_t op = shader.words[at] & 0xffffu, size = shader.words[at] >> 16;
            ASSERT_GT(size, 0u) << shader.name;
            const bool isWrong =
                op == kOpMemberDecorate && kOfWholes.contains(shader.words[at + 3]);
            EXPECT_FALSE(isWrong) << shader.name << " has decoration " << shader.words[at + 3]
                                  << " on a member";
            at += size;
        }
    }
}

TEST(EmbeddedShaders, PassTheValidator) {
    if (std::system("command -v spirv-val >/dev/null") != 0)
        GTEST_SKIP() << "spirv-val is not installed";
    const std::filesystem::path file =
        std::filesystem::path(::testing::TempDir()) / "flamewright_shader.spv";
    for (const ShaderCode& shader : allShaders()) {
        {
            std::ofstream out(file, std::ios::binary);
            out.write(reinterpret_cast<const char*>(shader.words.data()),
                      static_cast<std::streamsize>(shader.words.size_bytes()));
            ASSERT_TRUE(out.good()) << "cannot write " << file;
        }
        const std::string command = "spirv-val --target-env vulkan1.0 '" + file.string() + "'";
        EXPECT_EQ(std::system(command.c_str()), 0) << shader.name;
    }
    std::filesystem::remove(file);
}

}  // namespace
