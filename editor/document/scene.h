// A scene as plain data: burnable meshes, heat and water sources, flames, wind, colliders, paint
// layers, timeline marks. Saving, undo and comparison cover this and the layer images (paint.h);
// everything else derives from it. Metres, seconds, degrees, kilowatts; y is up unless the settings
// differ.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace fwedit {

using Vec3 = std::array<float, 3>;
using Pose = std::array<float, 16>;  // column-major, as in the plugin
inline float dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
constexpr Pose kWorldPose = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
using ObjectId = uint32_t;  // stable within the scene and saved with it; 0: none

// Common fields of all objects. Names are for users and need not be unique.
struct Object {
    ObjectId id = 0;
    std::string name;
    bool hidden = false;  // not drawn; a hidden mesh still burns
    bool locked = false;  // cannot be picked in the viewport
    bool operator==(const Object&) const = default;
};

struct Key {  // a factor over time; linear between keys, constant outside
    float time = 0, value = 1;
    bool operator==(const Key&) const = default;
};
using Keys = std::vector<Key>;  // ascending times; empty: constant 1
float valueAt(const Keys& keys, float time);

enum Deform : uint32_t { DeformNone, DeformRecede, DeformSheet, DeformSprings };
enum SourceShape : uint32_t {
    SourceMatch,         // ignites everything within its radius at once
    SourcePoint,         // a small flame that heats its contacts until they ignite
    SourceDisc,          // the same over a disc
    SourceLine,          // the same along a line
    SourceFlamethrower,  // a jet
    SourceRain,          // wets everything below a disc
    SourceWater,         // wets everything within its radius
};
enum EmitterShape : uint32_t { EmitterPoint, EmitterDisc, EmitterLine, EmitterMesh };
enum ColliderShape : uint32_t { ColliderBall, ColliderCapsule, ColliderBox, ColliderFloor };
enum WindShape : uint32_t { WindEverywhere, WindBox, WindBall, WindFan };
enum WindFlow : uint32_t { WindAlong, WindOut, WindAround };
enum PaintKind : uint32_t { PaintMultiplier, PaintMoisture, PaintMaterial };
enum Daylight : uint32_t { DaylightNight, DaylightDusk, DaylightDay };

struct Mesh : Object {            // a burnable mesh from a glTF file
    std::string file;             // relative to the scene's file
    std::string node;             // only this node's subtree; empty: the whole file
    Vec3 position{}, rotation{};  // m; degrees, around x, then y, then z
    Vec3 scale{1, 1, 1};
    std::array<uint32_t, 8> materials{1, 1, 1, 1, 1, 1, 1, 1};  // FwMaterialPreset, by slot
    float thickness = 0;                                        // m; 0: the material's value
    float moisture = 0;  // share of its dry mass, added to the material's, [0, 2]
    Vec3 tint{1, 1, 1};
    uint32_t deform = DeformNone;
    std::vector<std::array<float, 7>> pins;  // for sheets: from, to, radius; m, object space
    bool refine = false;                     // refines triangles near the fire
    uint32_t refineDepth = 5;
    bool twoSided = false, holes = true, spreads = true;
    float spreadChance = 1;
    uint32_t mapSize = 1024;     // px, side of its burn map
    float texelsPerMetre = 256;  // requested resolution
    bool operator==(const Mesh&) const = default;
};

struct HeatSource : Object {  // a heat source, or water
    uint32_t shape = SourcePoint;
    Vec3 position{}, direction{0, 1, 0};  // m; of a jet, a line; normal of a disc
    float output = 18;                    // kW; for rain and water kg/s
    float radius = 0.05f;                 // m
    float length = 1;                     // m, length of a line or depth of rain
    float start = 0, duration = 0;        // s; duration 0: to the end
    Keys keys;                            // factor of the output
    // Parent object. The source moves and, if the parent is a mesh, rotates with it; position and
    // direction are then local. A node of the mesh's file may be chosen by name or as "#3".
    ObjectId sticksTo = 0;
    std::string sticksToNode;
    bool operator==(const HeatSource&) const = default;
};

struct Flame : Object {     // a volumetric fire
    uint32_t preset = 0;    // FwFirePreset
    std::string profile;    // .fwprofile or image, relative; empty: the preset's shape
    Keys outline, stops;    // shape by points instead, see flame_curve.h
    Vec3 position{};        // m, centre of its base
    float diameter = 0.6f;  // m
    float power = 60;       // kW
    float windResponse = 1, turbulence = 1, speed = 1, density = 1, smoke = 1, blue = 1;
    Vec3 tint{1, 1, 1};
    float tintWeight = 0;
    Vec3 coreTint{1, 1, 1};  // for the hottest gas
    float coreTintWeight = 0;
    bool ignites = false;
    float start = 0, duration = 0;
    Keys keys;  // factor of the power
    ObjectId sticksTo = 0;
    std::string sticksToNode;
    bool operator==(const Flame&) const = default;
};

struct Emitter : Object {  // fire, smoke and sparks as particles
    uint32_t shape = EmitterPoint;
    Vec3 position{}, direction{0, 1, 0}, extent{0.5f, 0, 0};
    float radius = 0.3f, power = 60;
    float speed = 0, cone = 0, life = 0;  // m/s, rad, s; 0: default of the fire type
    float smoke = 0.32f, sparks = 0.04f;  // shares
    float windResponse = 1, turbulence = 1;
    bool flipbooks = true;  // shows flipbooks; false: noise
    float start = 0, duration = 0;
    Keys keys;
    ObjectId sticksTo = 0;  // for EmitterMesh: the mesh that provides its fire
    std::string sticksToNode;
    bool operator==(const Emitter&) const = default;
};

struct Wind : Object {  // a temporary wind: a gust everywhere, or in a zone
    uint32_t shape = WindEverywhere;
    uint32_t flow = WindAlong;
    Vec3 velocity{3, 0, 0};  // m/s; radial and swirl zones use its length only
    Vec3 position{};         // m, of a zone: centre; of a fan: origin
    Vec3 halfSize{1, 1, 1};  // m, of a box
    float radius = 1;        // m, of a ball; of a fan: end radius
    float length = 3;        // m, reach of a fan
    float falloff = 0.5f;    // [0, 1], share of the distance to the edge over which it fades
    bool shelters = false;   // replaces the surrounding wind instead of adding to it
    float start = 0, duration = 0;
    Keys keys;
    ObjectId sticksTo = 0;
    bool operator==(const Wind&) const = default;
};

struct Collider : Object {  // deflects flames and blocks heat
    uint32_t shape = ColliderBox;
    Vec3 position{}, rotation{};
    Vec3 halfSize{0.5f, 0.5f, 0.5f};  // m, of a box
    float radius = 0.5f;              // m, of a ball, a capsule
    float length = 1;                 // m, of a capsule, along its local y
    bool shields = true;              // for a box: also blocks radiation and embers
    ObjectId sticksTo = 0;
    bool operator==(const Collider&) const = default;
};

struct PaintLayer : Object {  // over the unwrap of one mesh; lowest first
    ObjectId mesh = 0;
    uint32_t kind = PaintMultiplier;
    std::string image;     // a PNG beside the scene file, relative
    float strength = 1;    // [0, 1]
    uint32_t size = 1024;  // px, side length
    bool operator==(const PaintLayer&) const = default;
};

struct Event : Object {  // a mark on the timeline
    float time = 0;
    std::string note;
    bool operator==(const Event&) const = default;
};

struct Settings {
    float duration = 60;  // s, length of the timeline
    float framesPerSecond = 30;
    float pace = 1;  // burn speed relative to wood, [0.1, 1000]
    uint32_t seed = 1;
    Vec3 up{0, 1, 0}, wind{};
    uint32_t daylight = DaylightDusk;
    float light = 1;  // factor of the preset light
    Vec3 sunDirection{-0.45f, 0.8f, 0.4f};
    float exposure = 1;
    float ground = 0;  // m along the up axis
    bool radiation = true, plume = true, contact = true,
         embers = true;  // active heat-transfer modes
    bool operator==(const Settings&) const = default;
};

struct Camera {
    Vec3 target{0, 0.5f, 0};
    float distance = 3, yaw = 25, pitch = 12;  // m, degrees
    float fieldOfView = 34;                    // degrees, vertical
    bool operator==(const Camera&) const = default;
};

struct Scene {
    Settings settings;
    Camera camera;
    std::vector<Mesh> meshes;
    std::vector<HeatSource> sources;
    std::vector<Flame> flames;
    std::vector<Emitter> emitters;
    std::vector<Wind> winds;
    std::vector<Collider> colliders;
    std::vector<PaintLayer> layers;
    std::vector<Event> events;
    ObjectId nextId = 1;
    bool operator==(const Scene&) const = default;
};

enum class Kind : uint32_t {
    Mesh,
    Source,
    Flame,
    Emitter,
    Wind,
    Collider,
    Layer,
    Event,
    Settings,
    Camera,
    Count
};

// Calls `visit(kind, list)` for each list of objects, in file order.
template <typename SceneT, typename Visit>
void forEachList(SceneT& scene, Visit&& visit) {
    visit(Kind::Mesh, scene.meshes);
    visit(Kind::Source, scene.sources);
    visit(Kind::Flame, scene.flames);
    visit(Kind::Emitter, scene.emitters);
    visit(Kind::Wind, scene.winds);
    visit(Kind::Collider, scene.colliders);
    visit(Kind::Layer, scene.layers);
    visit(Kind::Event, scene.events);
}

// Returns null if there is no such object.
const Object* findObject(const Scene& scene, ObjectId id, Kind* kind = nullptr);
Object* findObject(Scene& scene, ObjectId id, Kind* kind = nullptr);
template <typename T>
const T* findIn(const std::vector<T>& list, ObjectId id) {
    for (const T& object : list)
        if (object.id == id) return &object;
    return nullptr;
}

// Object to world.
Pose transformOf(const Mesh& mesh);

// Returns the rest pose of a node within its mesh. On failure returns false with the reason in
// `error`. An empty function: files are not loaded, and every node counts as the mesh.
using NodePoseOf =
    std::function<bool(const Mesh& mesh, std::string_view node, Pose& pose, std::string& error)>;

// Returns the coordinate frame of an object's position: its parent, or the world.
Pose parentPose(const Scene& scene, ObjectId id, const NodePoseOf& nodePose = {});
// Returns the parent of an object; 0: none.
ObjectId parentOf(const Scene& scene, ObjectId id);
// Returns `parent` and all its ancestors. In a circular chain (from a damaged file), it stops at
// the first repetition.
std::vector<ObjectId> ancestorsOf(const Scene& scene, ObjectId parent);
Vec3 placedBy(const Pose& holder, const Vec3& position);
Vec3 turnedBy(const Pose& holder, const Vec3& direction);  // keeps its length
// Inverse transform; 0 for a parent without volume.
Vec3 positionWithin(const Pose& holder, const Vec3& world);
Vec3 offsetWithin(const Pose& holder, const Vec3& world);
Vec3 directionWithin(const Pose& holder, const Vec3& world);
// Returns the world position of an object, including its parents; otherwise the scene's centre.
Vec3 worldPosition(const Scene& scene, ObjectId id, const NodePoseOf& nodePose = {});
// Returns the direct or indirect parent mesh of an object; null: none.
const Mesh* meshHolding(const Scene& scene, ObjectId id);
// Converts position, direction and extent from the frame `before` to the frame `after`, so that
// they stay constant in the world.
void keepInWorld(Scene& scene, ObjectId id, const Pose& before, const Pose& after);
// Returns the scene without nodes: children of a node become children of its mesh at the node's
// position. `problems`: sentences about nodes without a pose; may be null.
Scene placedScene(const Scene& scene, const NodePoseOf& nodePose,
                  std::vector<std::string>* problems = nullptr);

}  // namespace fwedit
