// flamewright/flamewright.hpp: a thin C++20 wrapper: owners, spans and default defs, without
// exceptions or state of its own. The host compiles it, so that no C++ crosses the library's ABI.
// All else is the C API; get() gives its pointers and ids.
#ifndef FLAMEWRIGHT_FLAMEWRIGHT_HPP
#define FLAMEWRIGHT_FLAMEWRIGHT_HPP
#include "flamewright/flamewright.h"

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>

namespace fw {

struct Close {
    void operator()(FwContext* context) const noexcept { fwDestroyContext(context); }
    void operator()(FwWorld* world) const noexcept { fwDestroyWorld(world); }
};
// Declare a world after its context, so that it is destroyed first.
using Context = std::unique_ptr<FwContext, Close>;
using World = std::unique_ptr<FwWorld, Close>;

// ---- defs: `auto def = fw::def<FwWorldDef>();`

template <class Def>
inline constexpr uint32_t kDefType = 0;
// clang-format off
template <> inline constexpr uint32_t kDefType<FwContextDef> = FW_DEF_CONTEXT;
template <> inline constexpr uint32_t kDefType<FwWorldDef> = FW_DEF_WORLD;
template <> inline constexpr uint32_t kDefType<FwHeatOccluderDef> = FW_DEF_HEAT_OCCLUDER;
template <> inline constexpr uint32_t kDefType<FwHeatOcclusionDef> = FW_DEF_HEAT_OCCLUSION;
template <> inline constexpr uint32_t kDefType<FwWindZoneDef> = FW_DEF_WIND_ZONE;
template <> inline constexpr uint32_t kDefType<FwWindGridDef> = FW_DEF_WIND_GRID;
template <> inline constexpr uint32_t kDefType<FwGustDef> = FW_DEF_GUSTS;
template <> inline constexpr uint32_t kDefType<FwRoomDef> = FW_DEF_ROOM;
template <> inline constexpr uint32_t kDefType<FwMaterialDef> = FW_DEF_MATERIAL;
template <> inline constexpr uint32_t kDefType<FwImageDef> = FW_DEF_IMAGE;
template <> inline constexpr uint32_t kDefType<FwMeshDef> = FW_DEF_MESH;
template <> inline constexpr uint32_t kDefType<FwBurnableMeshDef> = FW_DEF_BURNABLE_MESH;
template <> inline constexpr uint32_t kDefType<FwIgnitionDef> = FW_DEF_IGNITION;
template <> inline constexpr uint32_t kDefType<FwVolumetricFireDef> = FW_DEF_VOLUMETRIC_FIRE;
template <> inline constexpr uint32_t kDefType<FwFireTrackDef> = FW_DEF_FIRE_TRACK;
template <> inline constexpr uint32_t kDefType<FwFireProfileDef> = FW_DEF_FIRE_PROFILE;
template <> inline constexpr uint32_t kDefType<FwFireColliderDef> = FW_DEF_FIRE_COLLIDER;
template <> inline constexpr uint32_t kDefType<FwFlipbookDef> = FW_DEF_FLIPBOOK;
template <> inline constexpr uint32_t kDefType<FwFireEmitterDef> = FW_DEF_FIRE_EMITTER;
template <> inline constexpr uint32_t kDefType<FwParticleFieldDef> = FW_DEF_PARTICLE_FIELD;
template <> inline constexpr uint32_t kDefType<FwView> = FW_DEF_VIEW;
template <> inline constexpr uint32_t kDefType<FwOffscreenDef> = FW_DEF_OFFSCREEN;
template <> inline constexpr uint32_t kDefType<FwTimelineDef> = FW_DEF_TIMELINE;
template <> inline constexpr uint32_t kDefType<FwNetDef> = FW_DEF_NET;
template <> inline constexpr uint32_t kDefType<FwBudgetDef> = FW_DEF_BUDGET;
// clang-format on

template <class Def>
[[nodiscard]] Def def() noexcept {
    static_assert(kDefType<Def> != 0, "not a def of flamewright.h");
    Def result;
    fwInitDef(kDefType<Def>, &result, uint32_t(sizeof result));
    return result;
}

// Bits of the FwDefTypes whose defaults contain lengths of a world.
inline constexpr uint32_t kDefsWithLengths =
    1u << FW_DEF_BURNABLE_MESH | 1u << FW_DEF_HEAT_OCCLUDER | 1u << FW_DEF_HEAT_OCCLUSION |
    1u << FW_DEF_WIND_ZONE | 1u << FW_DEF_WIND_GRID | 1u << FW_DEF_GUSTS | 1u << FW_DEF_ROOM |
    1u << FW_DEF_VOLUMETRIC_FIRE | 1u << FW_DEF_FIRE_COLLIDER | 1u << FW_DEF_FIRE_EMITTER |
    1u << FW_DEF_PARTICLE_FIELD;

// A default def with its lengths in the unit of a world: `auto room = fw::def<FwRoomDef>(world);`.
// See fwWorld_ConvertDef.
template <class Def>
[[nodiscard]] Def def(const World& world) noexcept {
    static_assert((kDefsWithLengths >> kDefType<Def> & 1u) != 0,
                  "this def has no lengths of a world");
    Def result = def<Def>();
    (void)fwWorld_ConvertDef(world.get(), kDefType<Def>, &result);
    return result;
}

// An empty struct for the library to fill, e.g. fw::info<FwMeshInfo>().
template <class Info>
[[nodiscard]] Info info() noexcept {
    Info result{};
    result.structSize = uint32_t(sizeof result);
    return result;
}

[[nodiscard]] inline FwMaterialDef preset(FwMaterialPreset which) noexcept {
    FwMaterialDef result = fwDefaultMaterialDef();
    (void)fwInitMaterialPreset(&result, uint32_t(which));
    return result;
}

[[nodiscard]] inline FwVolumetricFireDef preset(FwFirePreset which) noexcept {
    FwVolumetricFireDef result = fwDefaultVolumetricFireDef();
    (void)fwInitFirePreset(&result, uint32_t(which));
    return result;
}

// A preset with its lengths in the unit of a world.
[[nodiscard]] inline FwVolumetricFireDef preset(const World& world, FwFirePreset which) noexcept {
    FwVolumetricFireDef result = preset(which);
    (void)fwWorld_ConvertDef(world.get(), FW_DEF_VOLUMETRIC_FIRE, &result);
    return result;
}

[[nodiscard]] inline FwParticleFieldDef preset(FwFieldPreset which) noexcept {
    FwParticleFieldDef result = fwDefaultParticleFieldDef();
    (void)fwInitFieldPreset(&result, uint32_t(which));
    return result;
}

// ---- creation

// Returns null if it fails; `error` (may be null) says why.
[[nodiscard]] inline Context createContext(const FwContextDef& def,
                                           FwErrorInfo* error = nullptr) noexcept {
    FwContext* context = nullptr;
    (void)fwCreateContext(&def, &context, error);
    return Context(context);
}
// Returns null if it fails; lastMessage(context) says why.
[[nodiscard]] inline World createWorld(const Context& context,
                                       const FwWorldDef& def = fwDefaultWorldDef()) noexcept {
    FwWorld* world = nullptr;
    (void)fwCreateWorld(context.get(), &def, &world);
    return World(world);
}

[[nodiscard]] inline std::string lastMessage(const Context& context) {
    std::string text(fwContext_GetLastMessage(context.get(), nullptr, 0), '\0');
    (void)fwContext_GetLastMessage(context.get(), text.data(), text.size() + 1);
    return text;
}
[[nodiscard]] inline std::string lastMessage(const World& world) {
    std::string text(fwWorld_GetLastMessage(world.get(), nullptr, 0), '\0');
    (void)fwWorld_GetLastMessage(world.get(), text.data(), text.size() + 1);
    return text;
}

// ---- ids: null tests, comparison, and owners that destroy

template <class Id>
concept GenerationalId = requires(Id id) {
    { id.index1 } -> std::convertible_to<uint32_t>;
    { id.generation } -> std::convertible_to<uint32_t>;
};
template <GenerationalId Id>
[[nodiscard]] constexpr bool isNull(Id id) noexcept {
    return id.index1 == 0;
}
template <GenerationalId Id>
[[nodiscard]] constexpr bool same(Id a, Id b) noexcept {
    return a.index1 == b.index1 && a.generation == b.generation;
}

// Owns an id and destroys its object. The world must outlive the owner.
template <GenerationalId Id, FwResult(FW_CALL* Destroy)(FwWorld*, Id)>
class Owned {
 public:
    Owned() = default;
    Owned(FwWorld* world, Id id) noexcept : world_(world), id_(id) {}
    Owned(Owned&& other) noexcept : world_(other.world_), id_(other.release()) {}
    Owned& operator=(Owned&& other) noexcept {
        if (this != &other) {
            reset();
            world_ = other.world_;
            id_ = other.release();
        }
        return *this;
    }
    Owned(const Owned&) = delete;
    Owned& operator=(const Owned&) = delete;
    ~Owned() { reset(); }

    [[nodiscard]] Id get() const noexcept { return id_; }
    explicit operator bool() const noexcept { return !isNull(id_); }
    Id release() noexcept { return std::exchange(id_, Id{}); }
    void reset() noexcept {
        if (!isNull(id_)) (void)Destroy(world_, std::exchange(id_, Id{}));
    }

 private:
    FwWorld* world_ = nullptr;
    Id id_{};
};
using Material = Owned<FwMaterialId, fwWorld_DestroyMaterial>;
using Image = Owned<FwImageId, fwWorld_DestroyImage>;
using Mesh = Owned<FwMeshId, fwWorld_DestroyMesh>;
using BurnableMesh = Owned<FwBurnableMeshId, fwWorld_DestroyBurnableMesh>;
using VolumetricFire = Owned<FwVolumetricFireId, fwWorld_DestroyVolumetricFire>;
using ParticleField = Owned<FwParticleFieldId, fwWorld_DestroyParticleField>;
using FireProfile = Owned<FwFireProfileId, fwWorld_DestroyFireProfile>;
using Flipbook = Owned<FwFlipbookId, fwWorld_DestroyFlipbook>;
using FireCollider = Owned<FwFireColliderId, fwWorld_RemoveFireCollider>;
using FireEmitter = Owned<FwFireEmitterId, fwWorld_DestroyFireEmitter>;

[[nodiscard]] inline Material createMaterial(const World& world, const FwMaterialDef& def) {
    FwMaterialId id{};
    (void)fwWorld_CreateMaterial(world.get(), &def, &id);
    return {world.get(), id};
}
[[nodiscard]] inline Image createImage(const World& world, uint32_t width, uint32_t height,
                                       std::span<const std::byte> rgba) {
    FwImageId id{};
    FwImageDef def = fwDefaultImageDef();
    def.width = width;
    def.height = height;
    def.pixels = rgba.size() == size_t(width) * height * 4 ? rgba.data() : nullptr;
    (void)fwWorld_CreateImage(world.get(), &def, &id);
    return {world.get(), id};
}
[[nodiscard]] inline Mesh createMesh(const World& world, const FwMeshDef& def) {
    FwMeshId id{};
    (void)fwWorld_CreateMesh(world.get(), &def, &id);
    return {world.get(), id};
}
[[nodiscard]] inline BurnableMesh createBurnableMesh(const World& world,
                                                     const FwBurnableMeshDef& def) {
    FwBurnableMeshId id{};
    (void)fwWorld_CreateBurnableMesh(world.get(), &def, &id);
    return {world.get(), id};
}

[[nodiscard]] inline VolumetricFire createVolumetricFire(const World& world,
                                                         const FwVolumetricFireDef& def) {
    FwVolumetricFireId id{};
    (void)fwWorld_CreateVolumetricFire(world.get(), &def, &id);
    return {world.get(), id};
}

[[nodiscard]] inline FireEmitter createFireEmitter(const World& world,
                                                   const FwFireEmitterDef& def) {
    FwFireEmitterId id{};
    (void)fwWorld_CreateFireEmitter(world.get(), &def, &id);
    return {world.get(), id};
}

[[nodiscard]] inline ParticleField createParticleField(const World& world,
                                                       const FwParticleFieldDef& def) {
    FwParticleFieldId id{};
    (void)fwWorld_CreateParticleField(world.get(), &def, &id);
    return {world.get(), id};
}

[[nodiscard]] inline FireProfile createFireProfile(const World& world,
                                                   const FwFireProfileDef& def) {
    FwFireProfileId id{};
    (void)fwWorld_CreateFireProfile(world.get(), &def, &id);
    return {world.get(), id};
}

[[nodiscard]] inline Flipbook createFlipbook(const World& world, const FwFlipbookDef& def) {
    FwFlipbookId id{};
    (void)fwWorld_CreateFlipbook(world.get(), &def, &id);
    return {world.get(), id};
}

[[nodiscard]] inline FireCollider addFireCollider(const World& world,
                                                  const FwFireColliderDef& def) {
    FwFireColliderId id{};
    (void)fwWorld_AddFireCollider(world.get(), &def, &id);
    return {world.get(), id};
}

// Converts a projection to Vulkan's clip space, e.g. fw::convertedProjection(m, FW_CLIP_OPENGL).
[[nodiscard]] inline std::array<float, 16> convertedProjection(std::span<const float, 16> given,
                                                               uint32_t clipSpace) noexcept {
    std::array<float, 16> result{};
    for (size_t i = 0; i < 16; ++i) result[i] = given[i];
    fwConvertProjection(result.data(), clipSpace);
    return result;
}

// Ignites the texels within `radius` m of `place` (m, world) on every object. FW_OK: some ignite.
// FW_NOTHING_THERE: none does, and lastMessage(world) says why. Negative: refused.
inline FwResult ignite(const World& world, const float (&place)[3], float radius) noexcept {
    FwIgnitionDef def = fwDefaultIgnitionDef();
    for (int i = 0; i < 3; ++i) def.position[i] = place[i];
    def.radius = radius;
    return fwWorld_Ignite(world.get(), &def, nullptr);
}

// A mesh def that points to the host's arrays. They must live until the def is used.
[[nodiscard]] inline FwMeshDef meshDef(std::span<const float> positions,
                                       std::span<const uint32_t> indices) noexcept {
    FwMeshDef result = fwDefaultMeshDef();
    result.positions = positions.data();
    result.vertexCount = uint32_t(positions.size() / 3);
    result.indices = indices.data();
    result.indexCount = uint32_t(indices.size());
    result.indexSize = 4;
    return result;
}

// ---- heat occlusion

// Sets the heat-occlusion grid (see fwWorld_SetHeatOcclusion) from a distance function,
// float(const float place[3]). The library calls it once for each cell before this returns. It must
// not throw.
template <std::invocable<const float*> Distance>
FwResult setHeatOcclusion(const World& world, FwHeatOcclusionDef def, Distance distance) noexcept {
    def.distance = [](void* data, const float* place) -> float {
        return (*static_cast<Distance*>(data))(place);
    };
    def.distanceData = std::addressof(distance);
    return fwWorld_SetHeatOcclusion(world.get(), &def);
}

// ---- running

// Moves a world to a tick of its timeline (see fwWorld_Seek). For contexts that fwWorld_Step
// serves: the cpu backend or an own device.
[[nodiscard]] inline FwResult seek(const World& world, uint64_t untilTick) noexcept {
    float seconds = 0;
    FwResult result = fwWorld_Seek(world.get(), untilTick, &seconds);
    while (result == FW_OK && seconds > 0) {
        result = fwWorld_Step(world.get(), seconds);
        if (result == FW_OK) result = fwWorld_Seek(world.get(), untilTick, &seconds);
    }
    return result;
}

// ---- events and lights

// Returns the part of `buffer` that was filled.
[[nodiscard]] inline std::span<const FwEvent> pollEvents(const World& world,
                                                         std::span<FwEvent> buffer) noexcept {
    return buffer.first(fwWorld_PollEvents(world.get(), buffer.data(), uint32_t(buffer.size())));
}
[[nodiscard]] inline std::span<const FwLight> lights(const World& world,
                                                     std::span<FwLight> buffer) noexcept {
    return buffer.first(fwWorld_GetLights(world.get(), buffer.data(), uint32_t(buffer.size())));
}
// As fwWorld_ReadLights, from any thread. Empty until a frame has copied the lights.
[[nodiscard]] inline std::span<const FwLight> readLights(const World& world,
                                                         std::span<FwLight> buffer) noexcept {
    auto count = uint32_t(buffer.size());
    (void)fwWorld_ReadLights(world.get(), buffer.data(), &count);
    return buffer.first(count);
}

// ---- deferred destruction, from any thread

// Releases the world from its owner; fwContext_Collect destroys it. See fwWorld_DestroyAfterFrame.
inline void destroyAfterFrame(World& world, uint64_t frameIndex = 0) noexcept {
    if (fwWorld_DestroyAfterFrame(world.get(), frameIndex) == FW_OK) (void)world.release();
}

[[nodiscard]] constexpr FwObjectKind kindOf(FwMaterialId) noexcept { return FW_OBJECT_MATERIAL; }
[[nodiscard]] constexpr FwObjectKind kindOf(FwImageId) noexcept { return FW_OBJECT_IMAGE; }
[[nodiscard]] constexpr FwObjectKind kindOf(FwMeshId) noexcept { return FW_OBJECT_MESH; }
[[nodiscard]] constexpr FwObjectKind kindOf(FwBurnableMeshId) noexcept {
    return FW_OBJECT_BURNABLE_MESH;
}
[[nodiscard]] constexpr FwObjectKind kindOf(FwHeatOccluderId) noexcept { return FW_OBJECT_HEAT_OCCLUDER; }
[[nodiscard]] constexpr FwObjectKind kindOf(FwVolumetricFireId) noexcept {
    return FW_OBJECT_VOLUMETRIC_FIRE;
}
[[nodiscard]] constexpr FwObjectKind kindOf(FwFireProfileId) noexcept {
    return FW_OBJECT_FIRE_PROFILE;
}
[[nodiscard]] constexpr FwObjectKind kindOf(FwFireColliderId) noexcept {
    return FW_OBJECT_FIRE_COLLIDER;
}
[[nodiscard]] constexpr FwObjectKind kindOf(FwFireEmitterId) noexcept {
    return FW_OBJECT_FIRE_EMITTER;
}
[[nodiscard]] constexpr FwObjectKind kindOf(FwFlipbookId) noexcept { return FW_OBJECT_FLIPBOOK; }
[[nodiscard]] constexpr FwObjectKind kindOf(FwParticleFieldId) noexcept {
    return FW_OBJECT_PARTICLE_FIELD;
}
[[nodiscard]] constexpr FwObjectKind kindOf(FwWindZoneId) noexcept { return FW_OBJECT_WIND_ZONE; }
[[nodiscard]] constexpr FwObjectKind kindOf(FwRoomId) noexcept { return FW_OBJECT_ROOM; }
[[nodiscard]] constexpr FwObjectKind kindOf(FwBurnId) noexcept { return FW_OBJECT_BURN; }
// Schedules the destruction of an object: see fwWorld_DestroyLater.
template <GenerationalId Id>
FwResult destroyLater(FwWorld* world, Id id) noexcept {
    const FwObjectRef object{uint32_t(kindOf(id)), id.index1, id.generation, 0};
    return fwWorld_DestroyLater(world, &object);
}

}  // namespace fw
#endif
