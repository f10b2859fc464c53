// Volumetric fires, and what they need: profiles, flipbooks and the bodies that flames flow around.
// Cosmetic, but for the meshes that a fire ignites: those depend on the host's numbers alone.
#pragma once
#include "components/fire_emitter.h"
#include "components/fire_flames.h"
#include "flipbook/flipbook.h"
#include "volume/depth_picture.h"
#include "world/command.h"
#include "world/fire_bodies.h"
#include "world/scene.h"
#include "world/slotted.h"

namespace fw::world {

class BurnSystem;
class ExchangeSystem;
class WindSystem;

// A burnable mesh within a fire's flame, since when and where; of fires that ignite.
struct FireTouch {
    FwBurnableMeshId object{};
    uint64_t since = 0;      // tick
    float fireAt[3] = {};    // m, the fire's base then
    float objectAt[3] = {};  // and the object's
    bool lit = false;        // it caught already
    bool seen = false;       // in this exchange

    template <class A>
    void serialize(A& a) {
        a.object("a flame", object);
        if (object.index1 != 0) a(since, fireAt, objectAt, lit);
    }
};

struct FireSnapshot : components::FireControls {
    uint32_t flags = 0;  // FW_FIRE_IGNITES
    std::array<FireTouch, 8> touches{};

    template <class A>
    void serialize(A& a) {
        components::FireControls::serialize(a);
        a(flags, touches);
    }
};

struct Fire {
    explicit Fire(std::pmr::memory_resource* memory) : data(memory) {}
    components::VolumetricFire data;
    std::array<FireTouch, 8> touches{};
};

struct FireProfileEntry {
    uint32_t layer = 0, users = 0;
};

struct FlipbookEntry {
    core::Owned<flipbook::Flipbook> data;
    uint32_t users = 0;
    bool emits = false;  // it hides nothing
};

struct FireColliderEntry {
    explicit FireColliderEntry(std::pmr::memory_resource* memory)
        : heights(memory), picture(memory) {}
    volume::Collider shape;
    std::pmr::vector<float> heights;
    float(FW_CALL* distance)(void*, const float*, float*) = nullptr;
    void* distanceData = nullptr;
    float unitsPerMetre = 1;  // what the host's function gets and gives
    volume::DepthPicture picture;
};

class FlameSystem {
 public:
    FlameSystem(const WorldContext& context, Scene& scene, const WindSystem& wind,
                const ExchangeSystem& exchange, BurnSystem& burn);

    FwVolumetricFireId create(const FwVolumetricFireDef& def);
    void destroy(FwVolumetricFireId id);
    void move(FwVolumetricFireId id, const float position[3]);
    void setPower(FwVolumetricFireId id, float power);
    void setPoints(FwVolumetricFireId id, const FwFirePoint* points, uint32_t count);
    void setHidden(FwVolumetricFireId id, bool hidden) {
        setFlag(fires_.get(id)->data.flags, FW_FIRE_HIDDEN, hidden);
    }
    void setTier(FwVolumetricFireId id, uint32_t tier) {
        components::setFireTier(fires_.get(id)->data, tier, "tier");
    }
    void setTrack(FwVolumetricFireId id, const FwFireTrackDef* def);
    void fillState(FwVolumetricFireId id, FwVolumetricFireState& state);
    void ask(const float point[3], FwFireSample& answer);
    void push(const float centre[3], float radius, FwFireForce& push);
    FwFlipbookId createFlipbook(const FwFlipbookDef& def);
    void destroyFlipbook(FwFlipbookId id);
    void setFlipbooks(FwFlipbookId fire, FwFlipbookId smoke);
    FwFireProfileId createProfile(const FwFireProfileDef& def);
    void destroyProfile(FwFireProfileId id);
    FwFireColliderId addCollider(const FwFireColliderDef& def, float unitsPerMetre = 1);
    void setCollider(FwFireColliderId id, const FwFireColliderDef& def, float unitsPerMetre = 1);
    void removeCollider(FwFireColliderId id);

    // At an exchange, before the steps of a frame are planned.
    void igniteObjects(uint32_t now);
    void plan(const HostFrame& frame, gpu::FramePlan& plan) noexcept;
    void commit() noexcept;
    void forgetObject(const Object& object) noexcept;  // that goes
    // visit(place, name, slot) for all that a shift of the origin moves and may refuse.
    template <class Visit>
    void eachPlace(const Visit& visit) {
        for (auto [i, fire] : fires_.entries()) {
            visit(fire.data.position, "volumetric fire", i);
            for (uint32_t k = 0; k < fire.data.pointCount; ++k)
                visit(fire.data.points[k].position, "a point of volumetric fire", i);
        }
        for (auto [i, collider] : colliders_.entries()) {
            visit(collider.shape.place, "fire collider", i);
            if (collider.shape.kind == volume::ColliderKind::Capsule)
                visit(collider.shape.extent, "fire collider", i);
        }
    }
    void shiftOrigin(const double (&by)[3]) noexcept;  // all else

    void apply(const MoveFire& command) { move(fires_.findId(command.slot), command.position); }
    void apply(const SetFirePower& command) {
        setPower(fires_.findId(command.slot), command.value);
    }
    void capture(SlottedList<FireSnapshot>& to) const;
    // Throws unless restore takes it; then it needs no memory.
    void checkSnapshot(const SlottedList<FireSnapshot>& from);
    void restore(const SlottedList<FireSnapshot>& from) noexcept;

    [[nodiscard]] const auto& fires() const noexcept { return fires_; }
    // Reserves room for a frame with `more` flames; throws std::bad_alloc.
    void reserve(uint32_t more);
    void listShapes() noexcept;
    // Of the listed shapes, those that are bodies to all, not to flames alone.
    [[nodiscard]] std::span<const volume::Collider> walls() const noexcept {
        return std::span(shapes_).subspan(pictures_);
    }
    [[nodiscard]] const components::FireFlames& burning() const noexcept { return burning_; }
    [[nodiscard]] std::span<const core::Owned<volume::Profile>> profiles() const noexcept {
        return profiles_;
    }
    // The highest of the host's height fields at a place; false: none is there.
    template <class Visit>
    void eachHeightField(Visit visit) const {
        for (auto [slot, entry] : colliders_.entries())
            if (entry.shape.kind == volume::ColliderKind::HeightField) visit(entry.shape);
    }
    components::EmitterFlipbooks flipbooksOf(const FwFireEmitterDef& def);
    void countFlipbookUsers(const FwFireEmitterDef& def, int by) noexcept;

 private:
    static constexpr uint32_t kMaxShapes = 64 + gpu::kMaxHeatOccluders;  // colliders and occluders
    void predictAhead(components::VolumetricFire& fire) noexcept;
    uint32_t profileLayer(const FwVolumetricFireDef& def);
    void igniteObjects(Fire& fire, uint32_t now);
    void sendFlipbooks(uint32_t slot, const flipbook::Flipbook* fresh);
    uint32_t flipbookByte(FwFlipbookId id, const char* name, flipbook::Kind kind);

    const WorldContext& context_;
    Scene& scene_;
    const WindSystem& wind_;
    const ExchangeSystem& exchange_;
    BurnSystem& burn_;
    core::HandlePool<FwVolumetricFireId, core::Owned<Fire>> fires_{"Volumetric fire",
                                                                   context_.memory};
    core::HandlePool<FwFireProfileId, FireProfileEntry> profileIds_{"Fire profile",
                                                                    context_.memory};
    core::HandlePool<FwFlipbookId, FlipbookEntry> flipbooks_{"Flipbook", context_.memory};
    FwFlipbookId flameFlipbooks_[2] = {};  // of burning meshes' flames: fire's, smoke's
    core::HandlePool<FwFireColliderId, core::Owned<FireColliderEntry>> colliders_{"Fire collider",
                                                                                  context_.memory};
    std::pmr::vector<core::Owned<volume::Profile>> profiles_;  // by layer; null: none needed it
    // Of a frame: pictures of depth, which flames alone see, colliders, occluders.
    std::pmr::vector<volume::Collider> shapes_{context_.memory};
    uint32_t pictures_ = 0;
    components::FireFlames burning_{context_.memory};
    std::pmr::vector<gpu::VolumeFlame> flames_{context_.memory};  // room for a frame's flames
    FireBodies bodies_;
    gpu::VolumeUpdate update_;  // of `flames_`
    uint32_t shown_ = 0;        // that the backend draws
    uint32_t made_ = 0;         // since ever
};

}  // namespace fw::world
