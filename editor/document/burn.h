// Builds a world of the plugin from a scene, through the public C headers only, as a game would.
// The owner of the context steps or records the world; feedBurn applies timed changes.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "document/document.h"
#include "flamewright/flamewright.h"
#include "import/gltf_import.h"
#include "model/model_surfaces.h"
#include "model/neutral_stage.h"

namespace fwedit {

constexpr double kTicksPerSecond = 4096;      // of fwDebug_FetchBurnMap
constexpr uint32_t kFirstCode = 0xfffffff0u;  // this code and above: texels without an ignition
                                              // tick

// Imported files and baked burn maps, cached across burns. One instance per program.
struct Assets {
    std::filesystem::path cache;  // folder of baked maps; empty: no cache on disk
    std::map<std::string, std::shared_ptr<const fwimport::ImportedModel>> models;  // by full path
    std::map<std::string, std::shared_ptr<const std::vector<char>>> bakes;         // by hash
    std::map<std::string, std::shared_ptr<const PaintSurface>> surfaces;           // by hash
    // Reports the stage and its progress, [0, 1]. Returns false to cancel. May be null.
    std::function<bool(const std::string& stage, float share)> progress;
};

struct BurnMesh {
    ObjectId id = 0;
    FwMeshId mesh{};
    FwBurnableMeshId object{};
    std::shared_ptr<const fwimport::ImportedModel> model;
    std::string bake;    // key into Assets::bakes and surfaces
    uint32_t slots = 1;  // number of entries of Mesh::materials in use
};
struct BurnPart {  // an active source, flame, emitter, collider or wind zone
    ObjectId id = 0;
    std::vector<FwVolumetricFireId> fires;
    FwFireEmitterId emitter{};
    FwFireColliderId collider{};
    FwHeatOccluderId occluder{};
    FwWindZoneId zone{};
    float lastFactor = -1;
};
struct BurnShared;  // materials, images, shapes and flipbooks that the objects of a burn share

struct Burn {
    FwContext* context = nullptr;  // not owned
    FwWorld* world = nullptr;
    Scene scene;      // the placed scene that it was built from
    double time = 0;  // s, world time
    std::vector<BurnMesh> meshes;
    std::vector<BurnPart> parts;
    std::unique_ptr<BurnShared> shared;
    std::vector<std::string> report;  // skipped objects, with reasons
    // Returns the texels of a mesh's burn map, for paint queries. Set by createBurn.
    std::function<std::shared_ptr<const PaintSurface>(const Mesh&)> surfaceOf;

    Burn();
    ~Burn();
    Burn(const Burn&) = delete;
    Burn& operator=(const Burn&) = delete;
};

// Creates a world. `folder`: base of relative paths. `assets` must outlive the burn. Skips and
// reports meshes that cannot be loaded. Returns null with the reason in `error` if there is no
// world.
std::unique_ptr<Burn> createBurn(FwContext* context, const Scene& scene, const PaintImages& images,
                                 const std::filesystem::path& folder, Assets& assets,
                                 std::string& error);
// Applies sources, keys and wind of [time, time + deltaTime), and advances burn.time. Call it right
// before each fwWorld_Step or fwWorld_RecordOutside with the same deltaTime.
bool feedBurn(Burn& burn, float deltaTime, std::string& error);
// Requests the hashes of the ignition maps. fetchHashes has them after the next step or some frames
// later (deltaTime may be 0): "Crate: 1b0c2f... at tick 640" per mesh. Until then it returns
// FW_NOT_READY.
void requestHashes(const Burn& burn);
FwResult fetchHashes(const Burn& burn, std::vector<std::string>& lines);
// For contexts that step themselves (own device, cpu): feeds and steps to `time`, in frames of the
// scene. Returns false with `error`. To go back in time, create a new burn.
bool runBurn(Burn& burn, double time, std::string& error);
// Applies the changed scene to the running burn: wind, light, camera, sources, flames and their
// shapes, colliders, mesh positions. Returns false and changes nothing if a new burn is necessary:
// other meshes, materials or heat-transfer modes, or a match that has already ignited. Ignores
// paint. `folder`: base of relative paths.
bool reviseBurn(Burn& burn, const Scene& scene, const std::filesystem::path& folder);
// Describes the surroundings of a picture: centre of the floor, largest side of the burning objects
// (m), and all visible shadow-casting triangles in world space.
struct Backdrop {
    bool any = false;  // false: there are no meshes, so the size is a guess
    Vec3 middle{};
    float size = 1;
    std::vector<float> positions;
    std::vector<uint32_t> indices;
    bool operator==(const Backdrop&) const = default;
};
Backdrop backdropOf(const Burn& burn);
// Returns the scene's camera and light. `time`: s, for flicker.
FwView viewOf(const Scene& scene, uint32_t width, uint32_t height, double time);
// Renders RGBA8 sRGB with rows from the top. Own device only.
bool shootBurn(Burn& burn, uint32_t width, uint32_t height, std::vector<uint8_t>& rgba,
               std::string& error);
// Renders all meshes unburnt on the neutral stage. Own device only.
bool shootNeutral(Burn& burn, const fwmodel::NeutralCamera& camera, uint32_t width, uint32_t height,
                  std::vector<uint8_t>& rgba, std::string& error);

// The custom shape of a flame: texels as in FwFireProfileDef, or a cooked file.
struct FlameShape {
    uint32_t width = 0, height = 0;
    std::vector<float> texels;
    std::vector<char> cooked;
};
[[nodiscard]] inline bool hasShape(const Flame& flame) {
    return !flame.profile.empty() || !flame.outline.empty() || !flame.stops.empty();
}
// Returns false with the problem of the file in `error`.
bool shapeOf(const Flame& flame, const std::filesystem::path& folder, FlameShape& shape,
             std::string& error);
FwFireProfileDef profileDefOf(const FlameShape& shape);  // The result points into `shape`.

// Computes the world bounds of all meshes. Returns false if there are none.
bool sceneBounds(const Scene& scene, const std::filesystem::path& folder, Assets& assets, Vec3& low,
                 Vec3& high);
// Imports and caches. Returns null with `error` on failure.
std::shared_ptr<const fwimport::ImportedModel> modelOf(const Mesh& mesh,
                                                       const std::filesystem::path& folder,
                                                       Assets& assets, std::string& error);
// For NodePoseOf. Returns false; `error` lists the file, the node and the available nodes.
bool nodePoseOf(const fwimport::ImportedModel& model, const Mesh& mesh, std::string_view node,
                Pose& pose, std::string& error);
// Reads the models of the burn's meshes. The result refers to the burn.
NodePoseOf nodePosesOf(const Burn& burn);
// Returns the cooked burn map from memory or the disk cache, or bakes it, and its key in
// Assets::bakes. Returns null with `error` on failure.
std::shared_ptr<const std::vector<char>> bakeOf(FwContext* context, const Mesh& mesh,
                                                const fwimport::ImportedModel& model,
                                                Assets& assets, std::string& key,
                                                std::string& error);
// Returns the key only. Meshes with equal keys share a burn map.
std::string bakeKeyOf(const Mesh& mesh, const fwimport::ImportedModel& model);
// Returns the texels to paint on. Bakes if necessary.
std::shared_ptr<const PaintSurface> paintSurfaceOf(FwContext* context, const Mesh& mesh,
                                                   const std::filesystem::path& folder,
                                                   Assets& assets, std::string& error);
// Combines the layers of a mesh for FwBurnableMeshDef::multiplier. Empty: nothing is painted.
std::vector<uint8_t> multiplierOf(const Scene& scene, const PaintImages& images, ObjectId mesh,
                                  uint32_t& width, uint32_t& height);

}  // namespace fwedit
