// A scene as an artist makes it: plain data. Meshes that burn, what heats and wets them, flames,
// wind, things in the way, layers of paint, marks on the timeline. What is saved, undone and
// compared is this and the pictures of its layers (paint.h); everything else follows from it.
// Metres, seconds, degrees, kilowatts; y is up unless the settings say otherwise.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace fwedit {

using Vec3 = std::array<float, 3>;
using Pose = std::array<float, 16>;  // column-major, as the plugin takes it
inline float dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
constexpr Pose kWorldPose = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
using ObjectId = uint32_t;  // stable while the scene lives, saved with it; 0: none

// What every object of a scene has. Names are for people; two may be alike.
struct Object {
    ObjectId id = 0;
    std::string name;
    bool hidden = false;  // not in the picture. A hidden mesh still burns
    bool locked = false;  // not picked in the viewport
    bool operator==(const Object&) const = default;
};

struct Key {  // of a factor over time; straight lines between keys, the ends go on
    float time = 0, value = 1;
    bool operator==(const Key&) const = default;
};
using Keys = std::vector<Key>;  // times increase. None: 1 all the time
float valueAt(const Keys& keys, float time);

enum Deform : uint32_t { DeformNone, DeformRecede, DeformSheet, DeformSprings };
enum SourceShape : uint32_t {
    SourceMatch,         // lights what is within its radius at once
    SourcePoint,         // a small flame that heats what it touches until that catches
    SourceDisc,          // the same over a disc
    SourceLine,          // the same along a line
    SourceFlamethrower,  // a jet
    SourceRain,          // wets what is below a disc
    SourceWater,         // wets what is within its radius
};
enum EmitterShape : uint32_t { EmitterPoint, EmitterDisc, EmitterLine, EmitterMesh };
enum ColliderShape : uint32_t { ColliderBall, ColliderCapsule, ColliderBox, ColliderFloor };
enum WindShape : uint32_t { WindEverywhere, WindBox, WindBall, WindFan };
enum WindFlow : uint32_t { WindAlong, WindOut, WindAround };
enum PaintKind : uint32_t { PaintMultiplier, PaintMoisture, PaintMaterial };
enum Daylight : uint32_t { DaylightNight, DaylightDusk, DaylightDay };

struct Mesh : Object {            // something that burns, from a glTF file
    std::string file;             // relative to the scene's file
    std::string node;             // what hangs on it alone; empty: the whole file
    Vec3 position{}, rotation{};  // m; degrees, about x, then y, then z
    Vec3 scale{1, 1, 1};
    std::array<uint32_t, 8> materials{1, 1, 1, 1, 1, 1, 1, 1};  // FwMaterialPreset, by slot
    float thickness = 0;                                        // m; 0: the material's
    float moisture = 0;  // share of its dry mass, added to the material's, [0, 2]
    Vec3 tint{1, 1, 1};
    uint32_t deform = DeformNone;
    std::vector<std::array<float, 7>> pins;  // of sheets: from, to, radius; m, object space
    bool refine = false;                     // finer triangles where it burns
    uint32_t refineDepth = 5;
    bool twoSided = false, holes = true, spreads = true;
    float spreadChance = 1;
    uint32_t mapSize = 1024;     // px, of its burn map
    float texelsPerMetre = 256;  // sharpness that is wished for
    bool operator==(const Mesh&) const = default;
};

struct HeatSource : Object {  // heat, or against it water
    uint32_t shape = SourcePoint;
    Vec3 position{}, direction{0, 1, 0};  // m; of a jet, a line; across a disc
    float output = 18;                    // kW; of rain and water kg/s
    float radius = 0.05f;                 // m
    float length = 1;                     // m, of a line, of a rain's fall
    float start = 0, duration = 0;        // s; duration 0: to the end
    Keys keys;                            // of the output
    // Moves with that object, and turns with it if it is a mesh: position and direction are its own
    // then. Of a mesh's file it may be one node, by its name or as "#3".
    ObjectId sticksTo = 0;
    std::string sticksToNode;
    bool operator==(const HeatSource&) const = default;
};

struct Flame : Object {     // a volumetric fire
    uint32_t preset = 0;    // FwFirePreset
    std::string profile;    // .fwprofile or picture, relative; empty: the preset's
    Keys outline, stops;    // its shape by points instead, see flame_curve.h
    Vec3 position{};        // m, the middle of its base
    float diameter = 0.6f;  // m
    float power = 60;       // kW
    float windResponse = 1, turbulence = 1, speed = 1, density = 1, smoke = 1, blue = 1;
    Vec3 tint{1, 1, 1};
    float tintWeight = 0;
    Vec3 coreTint{1, 1, 1};  // of its hottest gas
    float coreTintWeight = 0;
    bool ignites = false;
    float start = 0, duration = 0;
    Keys keys;  // of the power
    ObjectId sticksTo = 0;
    std::string sticksToNode;
    bool operator==(const Flame&) const = default;
};

struct Emitter : Object {  // fire, smoke and sparks as particles
    uint32_t shape = EmitterPoint;
    Vec3 position{}, direction{0, 1, 0}, extent{0.5f, 0, 0};
    float radius = 0.3f, power = 60;
    float speed = 0, cone = 0, life = 0;  // m/s, rad, s; 0: as such a fire has it
    float smoke = 0.32f, sparks = 0.04f;  // shares
    float windResponse = 1, turbulence = 1;
    bool books = true;  // shows flipbooks; else noise
    float start = 0, duration = 0;
    Keys keys;
    ObjectId sticksTo = 0;  // of EmitterMesh: the mesh whose fire it shows
    std::string sticksToNode;
    bool operator==(const Emitter&) const = default;
};

struct Wind : Object {  // blows while it works: a gust everywhere, or in a zone of its own
    uint32_t shape = WindEverywhere;
    uint32_t flow = WindAlong;
    Vec3 velocity{3, 0, 0};  // m/s; of zones that blow out or around its length counts
    Vec3 position{};         // m, of a zone: its middle; of a fan where it stands
    Vec3 halfSize{1, 1, 1};  // m, of a box
    float radius = 1;        // m, of a ball; of a fan at its end
    float length = 3;        // m, that a fan reaches
    float falloff = 0.5f;    // [0, 1], how much of the way to its edge it fades on
    bool shelters = false;   // instead of the wind around it, not added to it
    float start = 0, duration = 0;
    Keys keys;
    ObjectId sticksTo = 0;
    bool operator==(const Wind&) const = default;
};

struct Collider : Object {  // what flames flow around and heat does not pass
    uint32_t shape = ColliderBox;
    Vec3 position{}, rotation{};
    Vec3 halfSize{0.5f, 0.5f, 0.5f};  // m, of a box
    float radius = 0.5f;              // m, of a ball, a capsule
    float length = 1;                 // m, of a capsule, along its own y
    bool shields = true;              // of a box: radiation and embers do not pass either
    ObjectId sticksTo = 0;
    bool operator==(const Collider&) const = default;
};

struct PaintLayer : Object {  // over the unwrap of one mesh; the lowest first
    ObjectId mesh = 0;
    uint32_t kind = PaintMultiplier;
    std::string image;     // PNG beside the scene's file, relative
    float strength = 1;    // [0, 1]
    uint32_t size = 1024;  // px, of its sides
    bool operator==(const PaintLayer&) const = default;
};

struct Event : Object {  // a mark on the timeline
    float time = 0;
    std::string note;
    bool operator==(const Event&) const = default;
};

struct Settings {
    float duration = 60;  // s, of the timeline
    float framesPerSecond = 30;
    float pace = 1;  // how much faster than wood, [0.1, 1000]
    uint32_t seed = 1;
    Vec3 up{0, 1, 0}, wind{};
    uint32_t daylight = DaylightDusk;
    float light = 1;  // factor of that light
    Vec3 sunDirection{-0.45f, 0.8f, 0.4f};
    float exposure = 1;
    float ground = 0;                                                    // m along up
    bool radiation = true, plume = true, contact = true, embers = true;  // how fire jumps
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

// Calls `visit(kind, list)` for each list of objects, in the order of the file.
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

// Null: there is no such object.
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

// Where a node of a mesh's file stands within the mesh, at rest. False: `error` says why it has no
// place. Empty: nobody has read the files, and each node counts as the mesh itself.
using NodePoseOf =
    std::function<bool(const Mesh& mesh, std::string_view node, Pose& pose, std::string& error)>;

// What an object's own place is given in: what it sticks to, or the world.
Pose holderPose(const Scene& scene, ObjectId id, const NodePoseOf& nodePose = {});
// What an object sticks to; 0: nothing.
ObjectId holderOf(const Scene& scene, ObjectId id);
// `parent`, what that sticks to, and so on to what sticks to nothing, however long. A row that is
// knotted (of a scene by another hand) ends with the first that is in it a second time.
std::vector<ObjectId> holdersOf(const Scene& scene, ObjectId parent);
Vec3 placedBy(const Pose& holder, const Vec3& position);
Vec3 turnedBy(const Pose& holder, const Vec3& direction);  // as long as before
// The other way; of a holder without volume: 0.
Vec3 positionWithin(const Pose& holder, const Vec3& world);
Vec3 offsetWithin(const Pose& holder, const Vec3& world);
Vec3 directionWithin(const Pose& holder, const Vec3& world);
// Position of anything that has one, what it sticks to included; the middle of the scene else.
Vec3 worldPosition(const Scene& scene, ObjectId id, const NodePoseOf& nodePose = {});
// The mesh that an object sticks to, be it through others; null: none.
const Mesh* meshHolding(const Scene& scene, ObjectId id);
// Sets position, direction and extent of an object so that they are in the world what they are now
// within `before`, once `after` holds it.
void keepInWorld(Scene& scene, ObjectId id, const Pose& before, const Pose& after);
// The scene without nodes: what sticks to one sticks to its mesh, there where the node is.
// `problems`: of nodes that have no place, whole sentences; may be null.
Scene placedScene(const Scene& scene, const NodePoseOf& nodePose,
                  std::vector<std::string>* problems = nullptr);

}  // namespace fwedit
