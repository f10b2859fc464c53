// Exports a scene: the files that a game loads, code that sets it up, and pictures. Each export
// reports progress and can be cancelled; files are replaced atomically. Independent of windows, for
// scripts, tools and the output page.
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
    std::filesystem::path folder;  // base of the scene's relative paths
    std::string name;              // name of the scene: "crate_yard"; empty: none yet
    Assets& assets;
};
// Receives the stage and the total progress, [0, 1]. Returning false cancels with `error` =
// kStopped. May be null.
using OutputProgress = std::function<bool(const std::string& stage, float share)>;
constexpr const char* kStopped = "stopped";

// ---- runtime files

struct PlannedImage {
    std::string file;  // RGBA8, rows from the top
    uint32_t width = 0, height = 0;
    const std::vector<uint8_t>* pixels = nullptr;  // in a model that the assets own
    float alphaCutoff = 0;                         // as in FwImageDef
};
struct PlannedMesh {
    ObjectId mesh = 0;
    std::string map;            // .fwburn; equal meshes share one
    std::string mapIdentifier;  // identifier in code
    bool ownsMap = true;
    std::string multiplier;  // a byte per texel of its paint; empty: not painted
    std::vector<uint8_t> paint;
    uint32_t width = 0, height = 0;   // size of the paint
    std::array<int32_t, 8> images{};  // indices into OutputPlan, by material; -1: none
    bool ownColors = false;           // has vertex colours or images from its file
    bool twoSided = false;            // as ModelSurfaces::twoSided
};
// The files to write, and their names on disk and in code.
struct OutputPlan {
    Scene scene;                   // the placed scene
    std::string identifier, type;  // names of the scene: crate_yard, CrateYard
    std::vector<PlannedMesh> meshes;
    std::vector<PlannedImage> images;
    std::map<ObjectId, std::string> shapes;       // .fwprofile of flames with a custom shape
    std::map<ObjectId, std::string> identifiers;  // identifiers of the objects
};
bool planOutput(const OutputInput& input, OutputPlan& plan, std::string& error);
// Writes all files of the plan into a folder. `cpu`: a context of any backend.
bool cookScene(const OutputInput& input, const OutputPlan& plan, FwContext* cpu,
               const std::filesystem::path& out, const OutputProgress& progress,
               std::vector<std::filesystem::path>& files, std::string& error);

enum class SnippetLanguage { C, Cpp };
// Returns a complete source file that creates the scene from its files with the plugin's header.
std::string snippetOf(const OutputPlan& plan, SnippetLanguage language);

// s, ignition time per texel; -1: never.
fwimport::FloatPicture arrivalPicture(const ArrivalField& field);
// Writes MESH_arrival.exr per mesh (s; -1: never), and MESH_baked.fwburn for fwWorld_CreateBurn if
// it ignited.
bool writeArrivals(const OutputInput& input, FwContext* cpu, const std::filesystem::path& out,
                   const OutputProgress& progress, std::vector<std::filesystem::path>& files,
                   std::string& error);

// ---- pictures. `device`: a context with its own device

struct FilmstripDef {
    uint32_t count = 8, columns = 4;     // pictures at equal intervals over the timeline; [1, 256]
    uint32_t width = 320, height = 180;  // px, per picture
    uint32_t gap = 2;                    // px between pictures
};
bool writeFilmstrip(const OutputInput& input, FwContext* device, const FilmstripDef& def,
                    const std::filesystem::path& file, const OutputProgress& progress,
                    std::string& error);
struct TurntableDef {
    uint32_t count = 24;                 // pictures per full turn, [1, 1024]
    uint32_t width = 640, height = 360;  // px
    double time = 0;                     // s, burn time
};
// Writes turn_001.png and so on.
bool writeTurntable(const OutputInput& input, FwContext* device, const TurntableDef& def,
                    const std::filesystem::path& out, const OutputProgress& progress,
                    std::vector<std::filesystem::path>& files, std::string& error);
struct FlipbookDef {
    uint32_t frames = 32, side = 64;  // [2, 256]; texels, [8, 512]
    float seconds = 1.6f;             // of a loop
};
// Bakes a flame of the scene into a .fwbook for particles and far flames.
bool writeFlipbook(const OutputInput& input, ObjectId flame, const FlipbookDef& def,
                   const std::filesystem::path& file, const OutputProgress& progress,
                   std::string& error);

// Writes an opaque PNG from RGBA8.
bool writePixels(const std::filesystem::path& file, uint32_t width, uint32_t height,
                 const std::vector<uint8_t>& rgba, std::string& error);

}  // namespace fwedit
