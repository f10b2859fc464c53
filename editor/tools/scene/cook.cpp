// fw-cook: writes the runtime files of a scene.
#include <cstdio>

#include "scene/tool.h"
#include "script/output_lines.h"
#include "tools/whole_file.h"

namespace {

namespace fs = std::filesystem;

constexpr const char* kHelp =
    "fw-cook FILE [options]\n"
    "  FILE            a .fwscene or a glTF file\n"
    "  --out FOLDER    for NAME.fwburn (burn maps), NAME.multiplier.raw (paint), NAME.color.rgba\n"
    "                  (images), NAME.fwprofile (flame shapes) and the code that loads them, in C\n"
    "                  and C++; default: the current folder\n"
    "  --part i/n      writes only part i of n of the meshes, to split the work over machines;\n"
    "                  part 1 also writes the other files\n"
    "  --cache FOLDER  caches baked maps there\n"
    "  --json          a line of JSON per file\n"
    "  --quiet         no progress, no notes\n"
    "Exit code: 0 done, 1 failed (prints the reason), 2 the command line is wrong.\n";

}  // namespace

int main(int count, char** words) {
    using namespace fwtools;
    using namespace fwedit;
    ToolOptions options;
    int code = 0;
    if (!parseOptions(count, words, kHelp, options, code)) return code;
    ScriptHost host(fs::current_path());
    std::string error;
    if (!openInput(host, options, error)) return refuse(options, error);
    FwContext* cpu = host.cpu(error);
    if (!cpu) return refuse(options, error);
    const OutputInput input = outputOf(host);
    OutputPlan plan;
    if (!planOutput(input, plan, error)) return refuse(options, error);
    OutputPlan mineOf = plan;
    mineOf.meshes.clear();
    for (size_t i = 0; i < plan.meshes.size(); ++i)
        if (isInPart(options, i)) mineOf.meshes.push_back(plan.meshes[i]);
    const bool rest = isInPart(options, 0);
    if (!rest) {
        mineOf.images.clear();
        mineOf.shapes.clear();
    }
    std::vector<fs::path> files;
    const auto progress = [&](const std::string& stage, float share) {
        showProgress(options, stage, double(share));
        return true;
    };
    if (!cookScene(input, mineOf, cpu, options.out, progress, files, error))
        return refuse(options, error);
    for (const SnippetLanguage language : {SnippetLanguage::C, SnippetLanguage::Cpp}) {
        if (!rest) break;
        const fs::path file =
            options.out / (plan.identifier + (language == SnippetLanguage::C ? ".c" : ".cpp"));
        const std::string text = snippetOf(plan, language);
        error = replaceFile(file.string(), std::as_bytes(std::span(text)));
        if (!error.empty()) return refuse(options, error);
        files.push_back(file);
    }
    for (const fs::path& file : files) {
        std::error_code ignored;
        JsonLine line;
        line.text("file", file.string());
        line.number("bytes", double(fs::file_size(file, ignored)));
        std::printf("%s\n", options.json ? line.done().c_str() : file.c_str());
    }
    showProgress(options, "Cooking", 1);
    return ExitFine;
}
