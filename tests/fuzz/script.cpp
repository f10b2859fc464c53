// Scripts of fw-script, line by line in a folder of their own. Lines that need a device, a network
// or another folder are left out, and burns are kept small.
#include "editor/yard.h"
#include "fuzz/fuzzer.h"

#include <algorithm>
#include <array>
#include <sstream>

namespace fuzz {
namespace {

bool leavesOut(const std::string& line) {
    static constexpr std::array<std::string_view, 6> kVerbs = {"shot",      "link",     "filmstrip",
                                                               "turntable", "flipbook", "snippet"};
    std::istringstream words(line);
    std::string verb;
    words >> verb;
    std::erase(verb, '"');
    std::erase(verb, '\\');
    return line.find('/') != std::string::npos || verb.find("..") != std::string::npos ||
           std::find(kVerbs.begin(), kVerbs.end(), verb) != kVerbs.end();
}

void keepSmall(fwedit::ScriptHost& host) {
    fwedit::Scene& scene = host.document.scene;
    host.playhead = std::min(host.playhead, 2.0);
    scene.settings.duration = std::min(scene.settings.duration, 2.0f);
    scene.settings.framesPerSecond = std::min(scene.settings.framesPerSecond, 10.0f);
    for (fwedit::Mesh& mesh : scene.meshes) {
        mesh.mapSize = std::min(mesh.mapSize, 64u);
        mesh.texelsPerMetre = std::min(mesh.texelsPerMetre, 32.0f);
    }
}

const Fuzzer kScript{
    "script",
    [] {
        return std::vector<Bytes>{
            bytesIn(fwtest::kBoard),
            bytesIn("import board.glb name=Board materials paper map_size 64 texels_per_metre 32\n"
                    "set settings pace 20 duration 2\n"
                    "add source match name=Match position -0.5 0.2 0 radius 0.04\n"
                    "play 1\nexpect lit Board above 0.01\nreport\nhash\nwhy Board 0 0.2 0\n"
                    "cook game\nbake burn\nsave yard.fwscene\nopen yard.fwscene\n"
                    "expect same yard.fwscene\n"),
            bytesIn("import board.glb name=Board materials paper\n"
                    "add layer multiplier name=Belt mesh Board size 64\nfill Belt value 0.5\n"
                    "stroke Belt value 0 size 0.06 hardness 1 path 0:-0.05:0 0:0.45:0\n"
                    "undo 2\nredo\ndrag begin\nmove Board 0.1 0 0\ndrag end\n"
                    "expect step \"Move Board\"\nremove Belt\nrefuse set Nobody output 1\n"),
            bytesIn("add flame name=Fire position 0 1 0\nadd emitter name=Jet\nadd wind\n"
                    "add collider\nadd event\nset Fire output 20\nexpect count flame 1\n"
                    "expect Fire output 20\nexpect unsaved yes\nnew\n")};
    },
    [](Input input) {
        fwtest::Yard yard;
        std::istringstream stream{
            std::string(textOf(input.first(std::min<size_t>(input.size(), 4096))))};
        std::string line, error;
        bool accepted = false;
        for (int i = 0; i < 40 && std::getline(stream, line); ++i) {
            if (leavesOut(line)) continue;
            const bool good = fwedit::runScriptLine(*yard.host, line, error);
            EXPECT_TRUE(good || !error.empty()) << line;
            accepted |= good && !line.empty();
            if (!good && i == 0) return false;
            keepSmall(*yard.host);
        }
        return accepted;
    }};

}  // namespace
}  // namespace fuzz
