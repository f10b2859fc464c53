#include "gpu/passes/shader_interface.h"

#include "core/assert.h"
#include "core/error.h"
#include "embedded_shaders.h"
#include "gpu/extension.h"

#include <algorithm>
#include <string>
#include <vector>

namespace fw::gpu {
namespace {

// SPIR-V 1.0: opcodes and decorations that name a module's bindings.
enum Op : uint32_t {
    kOpTypeStruct = 30,
    kOpTypePointer = 32,
    kOpFunction = 54,
    kOpVariable = 59,
    kOpDecorate = 71,
    kOpMemberDecorate = 72,
};
enum Decoration : uint32_t {
    kBufferBlock = 3,  // a storage buffer; other blocks are uniform buffers
    kNonWritable = 24,
    kBinding = 33,
    kDescriptorSet = 34,
};
constexpr uint32_t kHeaderWords = 5, kBoundWord = 3;

struct Id {
    uint32_t binding = ~0u, set = 0;  // of a variable
    uint32_t pointsTo = 0;            // of a pointer type
    uint32_t members = 0, readonlyMembers = 0;
    bool storage = false, readonly = false;
};

}  // namespace

void ShaderInterface::add(std::span<const uint32_t> words, std::pmr::memory_resource* memory) {
    std::pmr::vector<Id> ids(words[kBoundWord], memory);
    for (size_t at = kHeaderWords; at < words.size(); at += words[at] >> 16) {
        const uint32_t* const word = &words[at];
        FW_ASSERT(*word >> 16 > 0 && at + (*word >> 16) <= words.size(), "word %zu", at);
        switch (*word & 0xFFFFu) {
            case kOpDecorate: {
                Id& id = ids[word[1]];
                if (word[2] == kBufferBlock) id.storage = true;
                if (word[2] == kNonWritable) id.readonly = true;
                if (word[2] == kBinding) id.binding = word[3];
                if (word[2] == kDescriptorSet) id.set = word[3];
                break;
            }
            case kOpMemberDecorate:  // a readonly block's members are, each
                if (word[3] == kNonWritable) ++ids[word[1]].readonlyMembers;
                break;
            case kOpTypeStruct:
                ids[word[1]].members = (*word >> 16) - 2;
                break;
            case kOpTypePointer:
                ids[word[1]].pointsTo = word[3];
                break;
            case kOpVariable: {
                const Id& variable = ids[word[2]];
                if (variable.binding == ~0u) break;
                sets_ = std::max(sets_, variable.set + 1);
                if (variable.set != 0) break;
                const Id& block = ids[ids[word[1]].pointsTo];
                const bool readonly =
                    variable.readonly || (block.members && block.readonlyMembers == block.members);
                if (variable.binding >= FW_BIND_COUNT)
                    add({variable.binding - FW_BIND_COUNT, Access::readTexels});
                else
                    add({variable.binding, !block.storage ? Access::uniform
                                           : readonly     ? Access::read
                                                          : Access::write});
                break;
            }
            case kOpFunction:
                return;  // declarations end here
            default:
                break;
        }
    }
}

// A buffer may be declared by words, by four words and by records; it is bound once.
void ShaderInterface::add(const Use& use) {
    const auto texels = [](const Use& one) { return one.access == Access::readTexels; };
    for (Use& one : std::span(uses_).first(count_)) {
        if (one.resource != use.resource || texels(one) != texels(use)) continue;
        if (use.access == Access::write) one.access = Access::write;
        return;
    }
    if (count_ == kMost)
        core::fail(FW_ERROR_INTERNAL, "A pass binds more than %u buffers; that is the limit.",
                   kMost);
    uses_[count_++] = use;
}

bool ShaderInterface::usesView() const noexcept {
    return std::any_of(uses().begin(), uses().end(),
                       [](const Use& use) { return use.resource == FW_BIND_VIEW; });
}

bool ShaderInterface::isPerView() const noexcept {
    return std::any_of(uses().begin(), uses().end(),
                       [](const Use& use) { return resourceOf(use.resource, 1) != use.resource; });
}

const ShaderCode* findShader(std::string_view name) noexcept {
    const auto find = [&](std::span<const ShaderCode> shaders) -> const ShaderCode* {
        const auto at = std::find_if(shaders.begin(), shaders.end(),
                                     [&](const ShaderCode& shader) { return name == shader.name; });
        return at == shaders.end() ? nullptr : &*at;
    };
    const ShaderCode* const own = extension() ? find(extension()->shaders) : nullptr;
    return own ? own : find(embeddedShaders());
}

std::span<const uint32_t> shaderCode(std::string_view name) {
    const ShaderCode* const code = findShader(name);
    if (!code)
        core::fail(FW_ERROR_INTERNAL, "Shader \"%.*s\" is not embedded.", int(name.size()),
                   name.data());
    return code->words;
}

std::span<const uint32_t> codeOf(const ComputePass& pass, bool texels) {
    const std::string name(pass.name);
    const ShaderCode* const code = texels ? findShader(name + "_texels.comp") : nullptr;
    return code ? code->words : shaderCode(name + ".comp");
}

ShaderInterface interfaceOf(const ComputePass& pass, bool texels,
                            std::pmr::memory_resource* memory) {
    ShaderInterface out;
    out.add(codeOf(pass, texels), memory);
    return out;
}

ShaderInterface interfaceOf(const DrawPass& pass, bool texels, std::pmr::memory_resource* memory) {
    ShaderInterface out;
    const auto add = [&](const char* shader) {
        if (shader) out.add(shaderCode(shader), memory);
    };
    add(pass.vertexShader);
    add(pass.multisampledVertex);
    add(pass.multisampledFragment);
    if (texels && pass.texelShaders) {
        for (int i = 0; i < 3; ++i) add(pass.texelShaders[i]);
    } else {
        for (const char* shader :
             {pass.fragmentShader, pass.softShader, pass.softShaderMultisampled})
            add(shader);
    }
    return out;
}

}  // namespace fw::gpu
