// fw-cook: what a scene needs at run time, as the plugin's own files.
#include <cstdio>
#include <fstream>

#include "document/text.h"
#include "scene/tool.h"

namespace {

namespace fs = std::filesystem;

constexpr const char* kHelp =
    "fw-cook FILE [options]\n"
    "  FILE            a .fwscene, or a glTF file alone\n"
    "  --out FOLDER    of NAME.fwburn (burn maps) and NAME.multiplier.raw (paint); default here\n"
    "  --part i/n      the i-th of n shares of the meshes, for many machines\n"
    "  --cache FOLDER  keeps bakes there\n"
    "  --json          a line of JSON for each file\n"
    "  --quiet         no progress, no notes\n"
    "Exit code: 0 done, 1 refused (the reason is told), 2 the command line is wrong.\n";

bool write(const fs::path& file, const void* data, size_t size, std::string& error) {
    std::error_code ignored;
    fs::create_directories(file.parent_path(), ignored);
    const fs::path fresh = file.string() + ".new";
    std::ofstream stream(fresh, std::ios::binary);
    stream.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
    stream.close();
    if (stream) fs::rename(fresh, file, ignored);
    if (stream && !ignored) return true;
    error = file.string() + " cannot be written";
    return false;
}

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
    const Scene& scene = host.document.scene;
    for (size_t i = 0; i < scene.meshes.size(); ++i) {
        if (!mine(options, i)) continue;
        const Mesh& mesh = scene.meshes[i];
        showProgress(options, "Cooking " + mesh.name, double(i) / double(scene.meshes.size()));
        const auto surface =
            paintSurfaceOf(cpu, mesh, baseFolder(host.document), host.assets, error);
        if (!surface) return refuse(options, error);
        // paintSurfaceOf has left the bake that it read in the assets.
        std::string key;
        for (const auto& [made, kept] : host.assets.surfaces)
            if (kept == surface) key = made;
        const auto& bake = *host.assets.bakes.at(key);
        const std::string name =
            std::to_string(mesh.id) + "_" + fs::path(mesh.name).filename().string();
        const fs::path file = options.out / (name + ".fwburn");
        if (!write(file, bake.data(), bake.size(), error)) return refuse(options, error);
        uint32_t width = 0, height = 0;
        const auto multiplier = multiplierOf(scene, host.document.images, mesh.id, width, height);
        const fs::path paint = options.out / (name + ".multiplier.raw");
        if (!multiplier.empty() && !write(paint, multiplier.data(), multiplier.size(), error))
            return refuse(options, error);
        JsonLine line;
        line.text("mesh", mesh.name);
        line.text("burn_map", file.string());
        line.number("bytes", double(bake.size()));
        if (!multiplier.empty()) {
            line.text("multiplier", paint.string());
            line.number("width", width);
            line.number("height", height);
        }
        std::printf("%s\n", options.json ? line.done().c_str() : file.c_str());
    }
    showProgress(options, "Cooking", 1);
    return ExitFine;
}
