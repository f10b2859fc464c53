// fw-shot: renders pictures of a scene at given times.
#include <algorithm>
#include <cstdio>

#include "scene/tool.h"

namespace {

constexpr const char* kHelp =
    "fw-shot FILE [options]\n"
    "  FILE            a .fwscene or a glTF file\n"
    "  --at T,T,...    seconds; default 0\n"
    "  --out FOLDER    for the pictures, NAME_TIME.png; default: the current folder\n"
    "  --size WxH      pixels; default 640x360\n"
    "  --part i/n      renders only part i of n of the pictures, to split the work over machines\n"
    "  --cache FOLDER  caches baked maps there\n"
    "  --json          a line of JSON per picture\n"
    "  --quiet         no progress, no notes\n"
    "Exit code: 0 done, 1 failed (prints the reason), 2 the command line is wrong.\n";

}  // namespace

int main(int count, char** words) {
    using namespace fwtools;
    ToolOptions options;
    int code = 0;
    if (!parseOptions(count, words, kHelp, options, code)) return code;
    if (options.times.empty()) options.times = {0};
    std::sort(options.times.begin(), options.times.end());
    fwedit::ScriptHost host(std::filesystem::current_path());
    std::string error;
    if (!openInput(host, options, error)) return refuse(options, error);
    const std::string stem = std::filesystem::path(options.input).stem().string();
    for (size_t i = 0; i < options.times.size(); ++i) {
        if (!isInPart(options, i)) continue;
        showProgress(options, "Pictures", double(i) / double(options.times.size()));
        char name[64];
        std::snprintf(name, sizeof name, "_%07.2f.png", options.times[i]);
        const std::filesystem::path file = options.out / (stem + name);
        host.playhead = options.times[i];
        if (!fwedit::writeShot(host, file, options.width, options.height, error))
            return refuse(options, error);
        JsonLine line;
        line.text("picture", file.string());
        line.number("time", options.times[i]);
        std::printf("%s\n", options.json ? line.done().c_str() : file.c_str());
    }
    showProgress(options, "Pictures", 1);
    return ExitFine;
}
