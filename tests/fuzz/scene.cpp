// .fwscene files: read, written and read again alike, then burnt as far as they need no other file.
#include "document/apply.h"
#include "document/burn.h"
#include "fuzz/fuzzer.h"

#include <gtest/gtest.h>

namespace fuzz {
namespace {

FwContext* cpuContext() {
    static FwContext* const context = [] {
        FwContextDef def = fwDefaultContextDef();
        def.backend = FW_BACKEND_CPU;
        FwContext* made = nullptr;
        EXPECT_EQ(FW_OK, fwCreateContext(&def, &made, nullptr));
        return made;
    }();
    return context;
}

const Fuzzer kScene{
    "scene",
    [] {
        return std::vector<Bytes>{fixture("yard.fwscene"), fixture("crate_version1.fwscene")};
    },
    [](Input input) {
        fwedit::Scene scene, again;
        std::vector<std::string> repairs;
        std::string error;
        if (!fwedit::readScene(textOf(input), "fuzz.fwscene", scene, repairs, error)) {
            EXPECT_FALSE(error.empty());
            return false;
        }
        const std::string text = fwedit::printScene(scene);
        EXPECT_TRUE(fwedit::readScene(text, "fuzz.fwscene", again, repairs, error)) << error;
        EXPECT_EQ(text, fwedit::printScene(again));
        for (const fwedit::Mesh& mesh : scene.meshes)
            if (mesh.file.find('/') != std::string::npos) return true;
        for (const fwedit::Flame& flame : scene.flames)
            if (flame.profile.find('/') != std::string::npos) return true;
        fwedit::Assets assets;
        const auto burn =
            fwedit::createBurn(cpuContext(), scene, {}, "/nonexistent", assets, error);
        if (burn) (void)fwedit::runBurn(*burn, 0.1, error);
        return true;
    }};

}  // namespace
}  // namespace fuzz
