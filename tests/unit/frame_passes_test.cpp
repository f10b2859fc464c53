// The table of passes, the function that records a frame and its documentation say the same.
#include "embedded_shaders.h"
#include "gpu/passes/shader_interface.h"
#include "support/paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace fw::test {
namespace {

std::string textOf(const char* path) {
    std::ifstream file(std::string(kTestFolder) + "/../runtime/" + path);
    EXPECT_TRUE(file.good()) << path;
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

std::vector<std::string> passNames(bool plain = false) {
    std::vector<std::string> names;
    for (const gpu::ComputePass& pass : gpu::computePasses().first(gpu::pass::count))
        if (plain || pass.begins == gpu::FramePart::none) names.emplace_back(pass.name);
    return names;
}

// The first groups of all matches, each name once.
std::vector<std::string> namesIn(const std::string& text, const char* pattern) {
    std::vector<std::string> names;
    const std::regex search(pattern);
    for (std::sregex_iterator at(text.begin(), text.end(), search), end; at != end; ++at) {
        const std::string name = (*at)[1];
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    return names;
}

TEST(FramePasses, FrameRecordsThemInTheOrderOfTheTable) {
    EXPECT_EQ(passNames(), namesIn(textOf("gpu/vk/frame.cpp"), "pass::([a-z_]+)"));
}

TEST(FramePasses, ArchitectureListsThemInTheOrderOfTheTable) {
    std::string text = textOf("ARCHITECTURE.md");
    text.erase(0, text.find("## The passes of a frame"));
    text.erase(text.find("\n## "));
    std::vector<std::string> rows = namesIn(text, "\n\\| ([a-z_]+) \\|");
    ASSERT_FALSE(rows.empty());
    EXPECT_EQ("pass", rows.front());
    rows.erase(rows.begin());
    EXPECT_EQ(passNames(), rows);
}

TEST(FramePasses, EachHasAShaderAndEachComputeShaderIsAPass) {
    std::set<std::string> expected;
    for (const std::string& name : passNames(true)) {
        expected.insert(name + ".comp");
        if (gpu::findShader(name + "_texels.comp")) expected.insert(name + "_texels.comp");
    }
    std::set<std::string> embedded;
    for (const gpu::ShaderCode& shader : gpu::embeddedShaders())
        if (std::string(shader.name).ends_with(".comp")) embedded.insert(shader.name);
    EXPECT_EQ(expected, embedded);
}

TEST(FramePasses, ShaderInterfaceTellsReadersFromWriters) {
    const auto accessOf = [](const char* name, uint32_t resource, bool texels) {
        const auto passes = gpu::computePasses();
        const auto pass = std::find_if(passes.begin(), passes.end(), [&](const auto& one) {
            return std::string_view(one.name) == name;
        });
        std::multiset<gpu::Access> found;
        const auto shaders = gpu::interfaceOf(*pass, texels, std::pmr::new_delete_resource());
        for (const gpu::Use& use : shaders.uses())
            if (use.resource == resource) found.insert(use.access);
        return found;
    };
    using Accesses = std::multiset<gpu::Access>;
    using enum gpu::Access;
    EXPECT_EQ(Accesses{read}, accessOf("heat", FW_BIND_OBJECTS, false));
    EXPECT_EQ(Accesses{write}, accessOf("heat", FW_BIND_STATE, false)) << "by words and by four";
    EXPECT_EQ(Accesses{write}, accessOf("heat", FW_BIND_TILE_FIRE, false)) << "writeonly";
    EXPECT_EQ(Accesses{}, accessOf("heat", FW_BIND_PROBES, false));
    EXPECT_EQ(Accesses{write}, accessOf("soft", FW_BIND_SHOWN, false));
    EXPECT_EQ((Accesses{write, readTexels}), accessOf("soft", FW_BIND_SHOWN, true));
    EXPECT_EQ(Accesses{uniform}, accessOf("lights", FW_BIND_VIEW, false));
    EXPECT_EQ(Accesses{uniform}, accessOf("volume_march", FW_BIND_VOLUMES, false));
}

}  // namespace
}  // namespace fw::test
