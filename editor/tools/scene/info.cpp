// fw-info: prints the content of a file.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string_view>

#include "scene/tool.h"

namespace {

constexpr const char* kHelp =
    "fw-info FILE [--json] [--quiet]\n"
    "  FILE  a .fwscene, a glTF file, or a .fwburn: a cooked burn map, or a baked burn\n"
    "Prints size, content and skipped features of meshes.\n"
    "Exit code: 0 fine, 1 failed (prints the reason), 2 the command line is wrong.\n";

}  // namespace

int main(int count, char** words) {
    using namespace fwtools;
    using namespace fwedit;
    ToolOptions options;
    int code = 0;
    if (!parseOptions(count, words, kHelp, options, code)) return code;
    ScriptHost host(std::filesystem::current_path());
    // The notes are part of this tool's output.
    ToolOptions quiet = options;
    quiet.quiet = true;
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
            uint32_t sides[2];  // after magic, version, checksum and the mesh's hash
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
        if (!openInput(host, quiet, error)) return refuse(options, error);
        const Scene& scene = host.document.scene;
        forEachList(scene, [&](Kind kind, const auto& list) {
            row(kindKey(kind), static_cast<double>(list.size()));
        });
        size_t nodes = 0, parts = 0, materials = 0, pictures = 0, triangles = 0, vertices = 0;
        std::vector<std::string> notes;
        std::string sizes;
        const bool several = scene.meshes.size() > 1;
        for (const Mesh& mesh : scene.meshes) {
            const auto model = modelOf(mesh, baseFolder(host.document), host.assets, error);
            if (!model) return refuse(options, error);
            nodes += static_cast<size_t>(std::count_if(model->nodes.begin(), model->nodes.end(),
                                                       [](const auto& n) { return n.inScene; }));
            parts += model->parts;
            materials += model->materials.size();
            pictures += model->images.size();
            triangles += model->triangleCount();
            vertices += model->vertexCount();
            const std::string from = several ? mesh.name + ": " : "";
            for (const std::string& note : model->notes) notes.push_back(from + note);
            char text[96];
            std::snprintf(text, sizeof text, "%.6g x %.6g x %.6g m",
                          static_cast<double>(model->high[0] - model->low[0]),
                          static_cast<double>(model->high[1] - model->low[1]),
                          static_cast<double>(model->high[2] - model->low[2]));
            sizes += "size                 " + from + text + "\n";
            if (several) continue;
            for (size_t c = 0; c < 3; ++c) {
                constexpr const char* kSizes[] = {"size_x", "size_y", "size_z"};
                json.number(kSizes[c], static_cast<double>(model->high[c] - model->low[c]));
            }
        }
        plain += sizes;
        row("nodes", static_cast<double>(nodes));
        row("parts", static_cast<double>(parts));
        row("mesh_materials", static_cast<double>(materials));
        row("mesh_pictures", static_cast<double>(pictures));
        row("vertices", static_cast<double>(vertices));
        row("triangles", static_cast<double>(triangles));
        row("duration", static_cast<double>(scene.settings.duration));
        json.list("notes", notes);
        for (const std::string& note : notes) plain += "note: " + note + "\n";
    }
    std::printf("%s", options.json ? (json.done() + "\n").c_str() : plain.c_str());
    return ExitFine;
}
