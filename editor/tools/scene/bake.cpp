// fw-bake: runs a scene's whole burn and writes ignition times and events.
#include <algorithm>
#include <cstdio>
#include <span>

#include "document/text.h"
#include "output/output.h"
#include "scene/tool.h"
#include "tools/whole_file.h"

namespace {

namespace fs = std::filesystem;

constexpr const char* kHelp =
    "fw-bake FILE [options]\n"
    "  FILE            a .fwscene\n"
    "  --out FOLDER    for MESH_arrival.exr (seconds; -1: never) and MESH_baked.fwburn, which a\n"
    "                  game plays (fwWorld_CreateBurn); default: the current folder\n"
    "  --part i/n      writes only part i of n of the meshes\n"
    "  --cache FOLDER  caches baked maps there\n"
    "  --json          a line of JSON per mesh and per event\n"
    "  --quiet         no progress, no notes\n"
    "Exit code: 0 done, 1 failed (prints the reason), 2 the command line is wrong.\n";

const char* eventName(uint32_t type) {
    switch (type) {
        case FW_EVENT_IGNITED:
            return "ignites";
        case FW_EVENT_BURNT_OUT:
            return "has burnt out";
        case FW_EVENT_EXTINGUISHED:
            return "has gone out";
        case FW_EVENT_SPREAD_TO:
            return "is lit by another";
        case FW_EVENT_SPOT_FIRE:
            return "is lit by embers";
        default:
            return "";
    }
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
    const Scene& scene = host.document.scene;
    FwContext* cpu = host.cpu(error);
    const double duration = static_cast<double>(scene.settings.duration);
    BurnRecord record;
    if (!cpu || !recordBurn(cpu, scene, host.document.images, baseFolder(host.document),
                            host.assets, record, error, [&](double time) {
                                showProgress(options, "Burning", time / duration);
                                return false;
                            }))
        return refuse(options, error);
    showProgress(options, "Burning", 1);
    std::error_code ignored;
    fs::create_directories(options.out, ignored);
    for (size_t i = 0; i < record.fields.size(); ++i) {
        if (!isInPart(options, i)) continue;
        const ArrivalField& field = record.fields[i];
        const Mesh& mesh = *findIn(scene.meshes, field.mesh);
        const fwimport::FloatPicture picture = arrivalPicture(field);
        const auto lit =
            std::ranges::count_if(field.seconds, [](float at) { return at < kNeverLit; });
        const std::string name =
            std::to_string(mesh.id) + "_" + fs::path(mesh.name).filename().string();
        const fs::path file = options.out / (name + "_arrival.exr");
        if (!fwimport::writePicture(file, picture, error)) return refuse(options, error);
        const fs::path baked = options.out / (name + "_baked.fwburn");
        if (!field.baked.empty())
            error = replaceFile(baked.string(), std::as_bytes(std::span(field.baked)));
        if (!error.empty()) return refuse(options, error);
        JsonLine line;
        line.text("mesh", mesh.name);
        line.text("arrival", file.string());
        if (!field.baked.empty()) line.text("baked", baked.string());
        line.number("lit_texels", double(lit));
        std::printf("%s\n", options.json ? line.done().c_str() : file.c_str());
    }
    for (size_t i = 0; i < record.events.size(); ++i) {
        const Mesh* mesh = findIn(scene.meshes, record.eventMeshes[i]);
        const char* what = eventName(record.events[i].type);
        if (!mesh || !what[0]) continue;
        JsonLine line;
        line.text("event", what);
        line.text("mesh", mesh->name);
        if (record.events[i].type == FW_EVENT_IGNITED)
            line.number("time", static_cast<double>(record.events[i].value));
        if (options.json)
            std::printf("%s\n", line.done().c_str());
        else
            std::printf("%s %s\n", mesh->name.c_str(), what);
    }
    return ExitFine;
}
