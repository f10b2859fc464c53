// Everything of the village that can burn, handed to the fire library through its public C ABI.
// Who lights whom is the library's; here is what is drawn by whom, and the fires as lights.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "flamewright/flamewright.h"
#include "light.h"
#include "paint.h"

namespace tower {

struct Thing {            // one instance that can burn
    size_t instance = 0;  // into Scene::instances
    FwBurnableMeshId id{};
    village::Frame frame;     // model to world, as the library last heard
    village::Vec3 low, high;  // m, model space
    bool lit = false;         // has caught; from then on the library draws it
    bool over = false;        // burnt out
    bool broken = false;      // of a house: its roof is gone, or a part of it hung on nothing
    FwObjectState state{};
    int32_t burnt() const {  // thousandths
        return state.texels ? int32_t(uint64_t{state.ignited} * 1000 / state.texels) : 0;
    }
};

// Throws sample::Failure with the world's own words.
void checkFire(FwWorld* world, FwResult result, const char* what);

class FireVillage {
 public:
    // Cooks the meshes on all cores, then makes materials, pictures and objects. Throws
    // sample::Failure. Without `painted`, for a world that nobody sees, no pictures.
    FireVillage(FwContext* context, FwWorld* world, const village::Scene& scene,
                const PaintedVillage* painted);

    std::vector<Thing> things;
    // The thing of an instance, or npos if that cannot burn.
    static constexpr size_t kNone = ~size_t{0};
    size_t thingOf(size_t instance) const { return thingOf_[instance]; }

    // A ball of flame, or of water (g/m^2), against all that it touches.
    void ignite(glm::vec3 place, float radius);
    void wet(glm::vec3 place, float radius, float water);
    // What of its roof falls on its walls, and lights them there; of kBeams, from above downward.
    void dropBeam(size_t thing, size_t beam);
    void move(size_t thing, const village::Frame& frame);
    // As if it had never burnt: another object in the old one's place.
    void renew(size_t thing);
    // Reads events and states. After Step or RecordOutside of the frame before.
    void observe();
    // What a world that has been loaded does not say: `lit`, `over` and `broken` are as given.
    void restore(std::span<const uint8_t> flags);
    std::vector<uint8_t> flags() const;
    // The fires as the library reports them, strongest first. scale: intensity per watt.
    std::span<const PointLight> lights(float scale);

    uint32_t burning() const { return burning_; }
    uint32_t caught() const { return caught_; }
    uint32_t broke() const { return broke_; }  // in the last observe

 private:
    void look();
    void makeMaterials();
    void makeModel(size_t model, const village::Model& source, const PaintedModel* painted,
                   const std::vector<uint8_t>& cooked);
    void makeThings(const village::Scene& scene);
    void createObject(Thing& thing);
    void touch(uint32_t kind, glm::vec3 place, float radius, float water);
    void check(FwResult result, const char* what) const { checkFire(world_, result, what); }

    FwContext* context_;
    FwWorld* world_;
    FwMaterialId materials_[8]{};
    std::vector<FwMeshId> meshes_;  // by model; null where it cannot burn
    std::vector<FwImageId> images_;
    std::vector<std::vector<glm::vec3>> beams_;  // by model, m: where they land
    std::vector<size_t> thingOf_;                // by instance
    std::vector<village::Instance> instances_;
    std::vector<PointLight> lights_;
    uint32_t burning_ = 0, caught_ = 0, broke_ = 0;
};

// Whether the model is worth burning at all: has fuel and stands in the play area.
bool canBurn(int model);

}  // namespace tower
