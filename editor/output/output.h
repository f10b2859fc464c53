// A scene for use elsewhere: the files that a game loads, code that puts them together, and
// pictures for people. Each act says how far it is and can be stopped; a file is whole or the old
// one. Below any window, as scripts, tools and the output page need it.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "document/burn.h"
#include "document/inspect.h"
#include "import/float_picture.h"

namespace fwedit {

struct OutputInput {
    const Scene& scene;
    const PaintImages& images;
    std::filesystem::path folder;  // where the scene's relative paths begin
    std::string name;              // of the scene: "crate_yard"; empty: it has none yet
    Assets& assets;
};
// Stage and share of the whole, [0, 1]; false: stop. `error` is then kStopped. May be null.
using OutputProgress = std::function<bool(const std::string& stage, float share)>;
constexpr const char* kStopped = "stopped";

// ---- what a game loads

struct PlannedImage {
    std::string file;  // RGBA8, rows top first
    uint32_t width = 0, height = 0;
    const std::vector<uint8_t>* pixels = nullptr;  // of a model that the assets keep
    float alphaCutoff = 0;                         // as FwImageDef's
};
struct PlannedMesh {
    ObjectId mesh = 0;
    std::string map;            // .fwburn; of two alike the first one's
    std::string mapIdentifier;  // of it in code
    bool ownsMap = true;
    std::string multiplier;  // a byte for each texel of its paint; empty: nothing is painted
    std::vector<uint8_t> paint;
    uint32_t width = 0, height = 0;   // of the paint
    std::array<int32_t, 8> images{};  // of OutputPlan, by material; -1: none
    bool ownColors = false;           // its file's, in the burn map's vertices and in pictures
    bool twoSided = false;            // as ModelSurfaces::twoSided
};
// What there is to write, and what it is called there and in code.
struct OutputPlan {
    Scene scene;                   // placed
    std::string identifier, type;  // of the scene: crate_yard, CrateYard
    std::vector<PlannedMesh> meshes;
    std::vector<PlannedImage> images;
    std::map<ObjectId, std::string> shapes;       // .fwprofile of a flame that has its own
    std::map<ObjectId, std::string> identifiers;  // of objects
};
bool planOutput(const OutputInput& input, OutputPlan& plan, std::string& error);
// All files of the plan into a folder. `cpu`: a context of any backend.
bool cookScene(const OutputInput& input, const OutputPlan& plan, FwContext* cpu,
               const std::filesystem::path& out, const OutputProgress& progress,
               std::vector<std::filesystem::path>& files, std::string& error);

enum class SnippetLanguage { C, Cpp };
// Source that compiles by itself, with the plugin's header, and makes the scene of its files.
std::string snippetOf(const OutputPlan& plan, SnippetLanguage language);

// Seconds at which each texel catches, -1: never.
fwimport::FloatPicture arrivalPicture(const ArrivalField& field);
// When each texel catches: MESH_arrival.exr for each mesh, s, -1 never; and of those that did
// MESH_baked.fwburn, which fwWorld_CreateBurn takes.
bool writeArrivals(const OutputInput& input, FwContext* cpu, const std::filesystem::path& out,
                   const OutputProgress& progress, std::vector<std::filesystem::path>& files,
                   std::string& error);

// ---- pictures. `device`: a context with its own device

struct FilmstripDef {
    uint32_t count = 8, columns = 4;     // pictures, at even times over the timeline; [1, 256]
    uint32_t width = 320, height = 180;  // px, of each
    uint32_t gap = 2;                    // px between them
};
bool writeFilmstrip(const OutputInput& input, FwContext* device, const FilmstripDef& def,
                    const std::filesystem::path& file, const OutputProgress& progress,
                    std::string& error);
struct TurntableDef {
    uint32_t count = 24;                 // pictures of a whole turn, [1, 1024]
    uint32_t width = 640, height = 360;  // px
    double time = 0;                     // s, of the burn
};
// turn_001.png and on.
bool writeTurntable(const OutputInput& input, FwContext* device, const TurntableDef& def,
                    const std::filesystem::path& out, const OutputProgress& progress,
                    std::vector<std::filesystem::path>& files, std::string& error);
struct FlipbookDef {
    uint32_t frames = 32, side = 64;  // [2, 256]; texels, [8, 512]
    float seconds = 1.6f;             // of a turn
};
// A flame of the scene as a .fwbook that particles and far flames show.
bool writeFlipbook(const OutputInput& input, ObjectId flame, const FlipbookDef& def,
                   const std::filesystem::path& file, const OutputProgress& progress,
                   std::string& error);

// PNG, RGBA8 given, opaque.
bool writePixels(const std::filesystem::path& file, uint32_t width, uint32_t height,
                 const std::vector<uint8_t>& rgba, std::string& error);

}  // namespace fwedit
