// See output.h: what a game loads.
#include <algorithm>
#include <cctype>
#include <set>
#include <span>

#include "output/output.h"
#include "tools/whole_file.h"

namespace fwedit {
namespace {

namespace fs = std::filesystem;

// Reserved words of C and C++.
const std::set<std::string> kTaken = {
    "auto",    "bool",    "break",    "case",     "char",     "class",  "const",  "context",
    "def",     "default", "delete",   "do",       "double",   "else",   "enum",   "extern",
    "false",   "float",   "folder",   "for",      "goto",     "if",     "inline", "int",
    "long",    "new",     "register", "restrict", "result",   "return", "scene",  "short",
    "signed",  "sizeof",  "static",   "struct",   "switch",   "this",   "time",   "true",
    "typedef", "union",   "unsigned", "void",     "volatile", "while",  "world"};

// Converts "Corner torch (2)" to corner_torch_2. Drops invalid characters.
std::string identifierOf(const std::string& name, const std::string& otherwise) {
    std::string text;
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 128 && std::isalnum(byte))
            text += static_cast<char>(std::tolower(byte));
        else if (byte < 128 && !text.empty() && text.back() != '_')
            text += '_';
    }
    while (!text.empty() && text.back() == '_') text.pop_back();
    if (text.empty()) text = otherwise;
    if (std::isdigit(static_cast<unsigned char>(text[0])) || kTaken.contains(text))
        text = otherwise + "_" + text;
    return text;
}

std::string typeOf(const std::string& identifier) {
    std::string text;
    bool upper = true;
    for (const char c : identifier) {
        if (c != '_') text += upper ? static_cast<char>(std::toupper(c)) : c;
        upper = c == '_';
    }
    return text;
}

class Names {
 public:
    std::string unique(const std::string& wanted) {
        std::string name = wanted;
        for (size_t number = 2; !taken_.insert(name).second; ++number)
            name = wanted + "_" + std::to_string(number);
        return name;
    }

 private:
    std::set<std::string> taken_;
};

template <typename T>
bool writeAll(const fs::path& file, const std::vector<T>& values, std::vector<fs::path>& files,
              std::string& error) {
    error = fwtools::replaceFile(file.string(), std::as_bytes(std::span(values)));
    if (error.empty()) files.push_back(file);
    return error.empty();
}

bool reportStage(const OutputProgress& progress, const std::string& stage, size_t done, size_t all,
                 std::string& error) {
    const float share = static_cast<float>(done) / static_cast<float>(std::max<size_t>(all, 1));
    if (!progress || progress(stage, share)) return true;
    error = kStopped;
    return false;
}

bool cookShape(const OutputInput& input, FwContext* context, const Flame& flame,
               const fs::path& file, std::vector<fs::path>& files, std::string& error) {
    FlameShape shape;
    if (!shapeOf(flame, input.folder, shape, error)) return false;
    if (shape.cooked.empty()) {
        const FwFireProfileDef def = profileDefOf(shape);
        uint64_t size = 0;
        std::vector<char> cooked;
        FwResult result = fwCookFireProfile(context, &def, nullptr, &size);
        cooked.resize(size);
        if (result >= 0) result = fwCookFireProfile(context, &def, cooked.data(), &size);
        if (result < 0) {
            char text[1024] = "";
            fwContext_GetLastMessage(context, text, sizeof text);
            error = "The flame shape of \"" + flame.name + "\" cannot be written: " + text;
            return false;
        }
        shape.cooked = std::move(cooked);
    }
    return writeAll(file, shape.cooked, files, error);
}

}  // namespace

bool planOutput(const OutputInput& input, OutputPlan& plan, std::string& error) {
    const Scene& scene = input.scene;
    plan = {};
    plan.identifier = identifierOf(input.name, "fire_scene");
    plan.type = typeOf(plan.identifier);
    Names names;
    forEachList(scene, [&](Kind kind, const auto& list) {
        if (kind == Kind::Layer || kind == Kind::Event) return;
        for (const auto& object : list)
            plan.identifiers[object.id] = names.unique(identifierOf(object.name, kindKey(kind)));
    });
    std::map<std::string, const PlannedMesh*> maps;             // by bake key
    std::map<std::pair<const void*, float>, int32_t> images;    // by image and its cut-off
    std::map<ObjectId, const fwimport::ImportedModel*> models;  // owned by the assets
    plan.meshes.reserve(scene.meshes.size());
    for (const Mesh& mesh : scene.meshes) {
        const auto model = modelOf(mesh, input.folder, input.assets, error);
        if (!model) return false;
        models[mesh.id] = model.get();
        const std::string& name = plan.identifiers[mesh.id];
        PlannedMesh& planned = plan.meshes.emplace_back();
        planned.mesh = mesh.id;
        const PlannedMesh*& first = maps[bakeKeyOf(mesh, *model)];
        planned.ownsMap = !first;
        planned.map = first ? first->map : name + ".fwburn";
        planned.mapIdentifier = first ? first->mapIdentifier : names.unique(name + "_map");
        if (!first) first = &planned;
        planned.paint = multiplierOf(scene, input.images, mesh.id, planned.width, planned.height);
        if (!planned.paint.empty()) planned.multiplier = name + ".multiplier.raw";
        const fwmodel::ModelSurfaces surfaces = fwmodel::surfacesOf(*model);
        planned.ownColors = surfaces.ownColors();
        planned.twoSided = surfaces.twoSided;
        planned.images.fill(-1);
        for (size_t slot = 0; slot < planned.images.size(); ++slot) {
            const fwmodel::SlotPicture& picture = surfaces.pictures[slot];
            if (picture.image < 0) continue;
            const auto& decoded = model->images[static_cast<size_t>(picture.image)];
            const auto [found, fresh] = images.try_emplace(
                {&decoded, picture.alphaCutoff}, static_cast<int32_t>(plan.images.size()));
            planned.images[slot] = found->second;
            if (fresh)
                plan.images.push_back(
                    {name + ".color" + std::to_string(plan.images.size()) + ".rgba", decoded.width,
                     decoded.height, &decoded.rgba, picture.alphaCutoff});
        }
    }
    std::vector<std::string> problems;
    plan.scene = placedScene(
        scene,
        [&](const Mesh& mesh, std::string_view node, Pose& pose, std::string& why) {
            return nodePoseOf(*models.at(mesh.id), mesh, node, pose, why);
        },
        &problems);
    if (!problems.empty()) {
        error = problems.front();
        return false;
    }
    for (const Flame& flame : scene.flames)
        if (hasShape(flame)) plan.shapes[flame.id] = plan.identifiers[flame.id] + ".fwprofile";
    return true;
}

bool cookScene(const OutputInput& input, const OutputPlan& plan, FwContext* cpu,
               const fs::path& out, const OutputProgress& progress, std::vector<fs::path>& files,
               std::string& error) {
    std::error_code ignored;
    fs::create_directories(out, ignored);
    const size_t all = plan.meshes.size() + plan.images.size() + plan.shapes.size();
    size_t done = 0;
    for (const PlannedMesh& planned : plan.meshes) {
        const Mesh& mesh = *findIn(input.scene.meshes, planned.mesh);
        if (!reportStage(progress, "Unwrapping " + mesh.name, done++, all, error)) return false;
        if (planned.ownsMap) {
            std::string key;
            const auto model = modelOf(mesh, input.folder, input.assets, error);
            const auto bake = model ? bakeOf(cpu, mesh, *model, input.assets, key, error) : nullptr;
            if (model && !bake) error = mesh.file + ": " + error;
            if (!bake || !writeAll(out / planned.map, *bake, files, error)) return false;
        }
        if (!planned.paint.empty() &&
            !writeAll(out / planned.multiplier, planned.paint, files, error))
            return false;
    }
    for (const PlannedImage& image : plan.images)
        if (!reportStage(progress, "Writing pictures", done++, all, error) ||
            !writeAll(out / image.file, *image.pixels, files, error))
            return false;
    for (const auto& [id, file] : plan.shapes) {
        const Flame& flame = *findIn(input.scene.flames, id);
        if (!reportStage(progress, "Writing the shape of " + flame.name, done++, all, error) ||
            !cookShape(input, cpu, flame, out / file, files, error))
            return false;
    }
    return reportStage(progress, "Done", all, all, error);
}

fwimport::FloatPicture arrivalPicture(const ArrivalField& field) {
    fwimport::FloatPicture picture;
    picture.width = field.width;
    picture.height = field.height;
    picture.channels = 1;
    picture.names = {"Y"};
    for (const float seconds : field.seconds)
        picture.values.push_back(seconds < kNeverLit ? seconds : -1.0f);
    return picture;
}

bool writeArrivals(const OutputInput& input, FwContext* cpu, const fs::path& out,
                   const OutputProgress& progress, std::vector<fs::path>& files,
                   std::string& error) {
    const auto duration = static_cast<double>(input.scene.settings.duration);
    bool stopped = false;
    BurnRecord record;
    if (!recordBurn(cpu, input.scene, input.images, input.folder, input.assets, record, error,
                    [&](double time) {
                        stopped =
                            stopped || !reportStage(progress, "When each spot catches",
                                                    static_cast<size_t>(1000 * time),
                                                    static_cast<size_t>(1000 * duration), error);
                        return stopped;
                    }))
        return false;
    if (stopped) {
        error = kStopped;
        return false;
    }
    OutputPlan plan;
    if (!planOutput(input, plan, error)) return false;
    std::error_code ignored;
    fs::create_directories(out, ignored);
    for (const ArrivalField& field : record.fields) {
        const fs::path file = out / (plan.identifiers[field.mesh] + "_arrival.exr");
        if (!fwimport::writePicture(file, arrivalPicture(field), error)) return false;
        files.push_back(file);
        const fs::path baked = out / (plan.identifiers[field.mesh] + "_baked.fwburn");
        if (!field.baked.empty() && !writeAll(baked, field.baked, files, error)) return false;
    }
    return true;
}

}  // namespace fwedit
