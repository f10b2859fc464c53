// A scene as a world of the plugin, through its public C headers alone: what a game would show.
// Whoever holds the context steps or records the world; feedBurn says what happens on the way.
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
constexpr uint32_t kFirstCode = 0xfffffff0u;  // from it on: texels without an ignition tick

// Imported files and baked burn maps, kept from burn to burn. One per program.
struct Assets {
    std::filesystem::path cache;  // folder of bakes; empty: none are kept
    std::map<std::string, std::shared_ptr<const fwimport::ImportedModel>> models;  // by full path
    std::map<std::string, std::shared_ptr<const std::vector<char>>> bakes;         // by hash
    std::map<std::string, std::shared_ptr<const PaintSurface>> surfaces;           // by hash
    // Stage by name and share of it, [0, 1]; false: stop. May be null.
    std::function<bool(const std::string& stage, float share)> progress;
};

struct BurnMesh {
    ObjectId id = 0;
    FwMeshId mesh{};
    FwBurnableMeshId object{};
    std::shared_ptr<const fwimport::ImportedModel> model;
    std::string bake;    // key into Assets::bakes and surfaces
    uint32_t slots = 1;  // of Mesh::materials that its triangles use
};
struct BurnPart {  // a source, flame, emitter, collider or zone of wind at work
    ObjectId id = 0;
    std::vector<FwVolumetricFireId> fires;
    FwFireEmitterId emitter{};
    FwFireColliderId collider{};
    FwBlockerId blocker{};
    FwWindZoneId zone{};
    float lastFactor = -1;
};
struct BurnShared;  // materials, pictures, shapes and books that objects of a burn have in common

struct Burn {
    FwContext* context = nullptr;  // not ours
    FwWorld* world = nullptr;
    Scene scene;      // that it was made of, placed
    double time = 0;  // s, of the world
    std::vector<BurnMesh> meshes;
    std::vector<BurnPart> parts;
    std::unique_ptr<BurnShared> shared;
    std::vector<std::string> report;  // what was left out, and why
    // Texels of a mesh's burn map, for questions about paint; set by createBurn.
    std::function<std::shared_ptr<const PaintSurface>(const Mesh&)> surfaceOf;

    Burn();
    ~Burn();
    Burn(const Burn&) = delete;
    Burn& operator=(const Burn&) = delete;
};

// `folder`: where relative paths begin. `assets` outlives the burn. A mesh that cannot be had is
// left out and reported. Null: `error` says why there is no world.
std::unique_ptr<Burn> createBurn(FwContext* context, const Scene& scene, const PaintImages& images,
                                 const std::filesystem::path& folder, Assets& assets,
                                 std::string& error);
// Call right before each fwWorld_Step or fwWorld_RecordOutside with its deltaTime: sources, keys
// and wind of [time, time + deltaTime). Moves burn.time on.
bool feedBurn(Burn& burn, float deltaTime, std::string& error);
// Wishes the ignition maps' hashes; fetchHashes has them after the next step or some frames later,
// if it be of no time: "Crate: 1b0c2f... at tick 640" for each mesh. FW_NOT_READY: not yet.
void requestHashes(const Burn& burn);
FwResult fetchHashes(const Burn& burn, std::vector<std::string>& lines);
// Contexts that step themselves (own device, cpu): feeds and steps on to `time`, in frames of the
// scene. False: `error`. Back in time: create it anew.
bool runBurn(Burn& burn, double time, std::string& error);
// Goes on with the scene changed, from this moment: wind, light and camera, what heats, wets and
// blows, flames and their shapes, walls, where meshes stand. False, and nothing is changed, where
// it takes a new burn: other meshes, materials or ways to spread, or a match that has lit already.
// Paint is not looked at. `folder`: where relative paths begin.
bool reviseBurn(Burn& burn, const Scene& scene, const std::filesystem::path& folder);
// What a picture stands on: the middle of the floor, the largest side of what burns (m), and the
// triangles of all that is seen and casts a shadow, in world space.
struct Backdrop {
    bool any = false;  // there are meshes; else the size is a guess
    Vec3 middle{};
    float size = 1;
    std::vector<float> positions;
    std::vector<uint32_t> indices;
    bool operator==(const Backdrop&) const = default;
};
Backdrop backdropOf(const Burn& burn);
// The scene's camera and light. `time`: s, for flicker.
FwView viewOf(const Scene& scene, uint32_t width, uint32_t height, double time);
// Own device: RGBA8 sRGB, rows top first.
bool shootBurn(Burn& burn, uint32_t width, uint32_t height, std::vector<uint8_t>& rgba,
               std::string& error);
// As it is: on the neutral stage, all meshes in the picture. Own device.
bool shootNeutral(Burn& burn, const fwmodel::NeutralCamera& camera, uint32_t width, uint32_t height,
                  std::vector<uint8_t>& rgba, std::string& error);

// What a flame has for a shape of its own: texels as FwFireProfileDef has them, or a cooked file.
struct FlameShape {
    uint32_t width = 0, height = 0;
    std::vector<float> texels;
    std::vector<char> cooked;
};
[[nodiscard]] inline bool hasShape(const Flame& flame) {
    return !flame.profile.empty() || !flame.outline.empty() || !flame.stops.empty();
}
// False: `error` says what is wrong with its file.
bool shapeOf(const Flame& flame, const std::filesystem::path& folder, FlameShape& shape,
             std::string& error);
FwFireProfileDef profileDefOf(const FlameShape& shape);  // points into it

// The bounds of all meshes of the scene in world space; false: there are none.
bool sceneBounds(const Scene& scene, const std::filesystem::path& folder, Assets& assets, Vec3& low,
                 Vec3& high);
// Null: `error`. Imports and caches.
std::shared_ptr<const fwimport::ImportedModel> modelOf(const Mesh& mesh,
                                                       const std::filesystem::path& folder,
                                                       Assets& assets, std::string& error);
// Of a model for NodePoseOf. False: `error` names its file, the node and those there are.
bool nodePoseOf(const fwimport::ImportedModel& model, const Mesh& mesh, std::string_view node,
                Pose& pose, std::string& error);
// By the models of a burn's meshes, which it points to.
NodePoseOf nodePosesOf(const Burn& burn);
// The cooked burn map: from memory, the cache, or baked now, and its key in Assets::bakes. Null:
// `error`.
std::shared_ptr<const std::vector<char>> bakeOf(FwContext* context, const Mesh& mesh,
                                                const fwimport::ImportedModel& model,
                                                Assets& assets, std::string& key,
                                                std::string& error);
// The key alone. Meshes with the same one have the same burn map.
std::string bakeKeyOf(const Mesh& mesh, const fwimport::ImportedModel& model);
// The texels to paint on: bakes if need be.
std::shared_ptr<const PaintSurface> paintSurfaceOf(FwContext* context, const Mesh& mesh,
                                                   const std::filesystem::path& folder,
                                                   Assets& assets, std::string& error);
// The layers of a mesh put together for FwBurnableMeshDef::multiplier; empty: nothing is painted.
std::vector<uint8_t> multiplierOf(const Scene& scene, const PaintImages& images, ObjectId mesh,
                                  uint32_t& width, uint32_t& height);

}  // namespace fwedit
