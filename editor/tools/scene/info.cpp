// fw-info: what a file holds.
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string_view>

#include "scene/tool.h"

namespace {

constexpr const char* kHelp =
    "fw-info FILE [--json] [--quiet]\n"
    "  FILE  a .fwscene, a glTF file, or a .fwburn: a cooked burn map, or a baked burn\n"
    "Exit code: 0 fine, 1 refused (the reason is told), 2 the command line is wrong.\n";

}  // namespace

int main(int count, char** words) {
    using namespace fwtools;
    using namespace fwedit;
    ToolOptions options;
    int code = 0;
    if (!parseOptions(count, words, kHelp, options, code)) return code;
    ScriptHost host(std::filesystem::current_path());
    std::string error;
    JsonLine json;
    std::string plain;
    const auto row = [&](const char* name, double value) {
        json.number(name, value);
        char text[96];
        std::snprintf(text, sizeof text, "%-20s %.6g\n", name, value);
        plain += text;
    };
    if (std::filesystem::path(options.input).extension() == ".fwburn") {
        std::ifstream stream(options.input, std::ios::binary);
        const std::vector<char> bytes((std::istreambuf_iterator<char>(stream)), {});
        if (!stream && bytes.empty()) return refuse(options, options.input + " cannot be read");
        FwContext* cpu = host.cpu(error);
        FwWorld* world = nullptr;
        const FwWorldDef worldDef = fwDefaultWorldDef();
        if (!cpu || fwCreateWorld(cpu, &worldDef, &world) < 0) return refuse(options, error);
        const auto refuseFile = [&] {
            char text[1024] = "";
            fwWorld_GetLastMessage(world, text, sizeof text);
            return refuse(options, options.input + ": " + text);
        };
        if (std::string_view(bytes.data(), bytes.size()).starts_with("FWBB")) {  // a baked burn
            FwBurnId burn{};
            if (fwWorld_CreateBurn(world, bytes.data(), bytes.size(), &burn) < 0)
                return refuseFile();
            uint32_t sides[2];  // behind magic, version, checksum and the mesh's hash
            std::memcpy(sides, bytes.data() + 24, sizeof sides);
            row("baked_width", sides[0]);
            row("baked_height", sides[1]);
            std::printf("%s", options.json ? (json.done() + "\n").c_str() : plain.c_str());
            return ExitFine;
        }
        FwMeshDef def = fwDefaultMeshDef();
        def.cooked = bytes.data();
        def.cookedSize = bytes.size();
        FwMeshId mesh{};
        FwMeshInfo info{};
        info.structSize = sizeof info;
        if (fwWorld_CreateMesh(world, &def, &mesh) < 0 ||
            fwWorld_GetMeshInfo(world, mesh, &info) < 0)
            return refuseFile();
        row("map_width", info.mapWidth);
        row("map_height", info.mapHeight);
        row("texels", info.texels);
        row("charts", info.charts);
        row("vertices", info.vertices);
        row("triangles", info.triangles);
        row("area", static_cast<double>(info.area));
        row("texels_per_metre", static_cast<double>(info.texelsPerMetre));
    } else {
        if (!openInput(host, options, error)) return refuse(options, error);
        const Scene& scene = host.document.scene;
        forEachList(scene, [&](Kind kind, const auto& list) {
            row(kindKey(kind), static_cast<double>(list.size()));
        });
        size_t triangles = 0, vertices = 0;
        for (const Mesh& mesh : scene.meshes) {
            const auto model = modelOf(mesh, baseFolder(host.document), host.assets, error);
            if (!model) return refuse(options, error);
            triangles += model->triangleCount();
            vertices += model->vertexCount();
        }
        row("vertices", static_cast<double>(vertices));
        row("triangles", static_cast<double>(triangles));
        row("duration", static_cast<double>(scene.settings.duration));
    }
    std::printf("%s", options.json ? (json.done() + "\n").c_str() : plain.c_str());
    return ExitFine;
}
