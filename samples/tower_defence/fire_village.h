// All burnable objects of the village, created through the public C ABI. The library decides how
// fire spreads. This class decides which side draws each object, and turns the fires into lights.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "flamewright/flamewright.h"
#include "light.h"
#include "paint.h"

namespace tower {

struct Thing {            // an instance that can burn
    size_t instance = 0;  // into Scene::instances
    FwBurnableMeshId id{};
    village::Frame frame;     // model to world, as last sent to the library
    village::Vec3 low, high;  // m, model space
    bool lit = false;         // has ignited; from then on the library draws it
    bool over = false;        // burnt out
    bool broken = false;      // a house that lost its roof, or a part without support
    FwObjectState state{};
    int32_t burnt() const {  // share burnt, thousandths
        return state.texels ? int32_t(uint64_t{state.ignited} * 1000 / state.texels) : 0;
    }
};

// Throws sample::Failure with the world's last message.
void checkFire(FwWorld* world, FwResult result, const char* what);

class FireVillage {
 public:
    // Cooks the meshes on all cores, then creates materials, images and objects. Without `painted`,
    // for a world without a view, creates no images. Throws sample::Failure.
    FireVillage(FwContext* context, FwWorld* world, const village::Scene& scene,
                const PaintedVillage* painted);

    std::vector<Thing> things;
    // Returns the object of an instance, or kNone if it cannot burn.
    static constexpr size_t kNone = ~size_t{0};
    size_t thingOf(size_t instance) const { return thingOf_[instance]; }

    // Ignites all objects that a ball touches, or wets them (water: g/m^2).
    void ignite(glm::vec3 place, float radius);
    void wet(glm::vec3 place, float radius, float water);
    // Ignites the walls where beam number `beam` of the roof lands. Beams fall in order of height,
    // the highest first.
    void dropBeam(size_t thing, size_t beam);
    void move(size_t thing, const village::Frame& frame);
    // Replaces the object with an unburnt one.
    void replace(size_t thing);
    // Reads events and states. Call it after Step or RecordOutside of the previous frame.
    void observe();
    // Sets `lit`, `over` and `broken`, which a loaded world does not report.
    void restore(std::span<const uint8_t> flags);
    std::vector<uint8_t> flags() const;
    // Returns the fires that the library reports, strongest first. scale: intensity per watt.
    std::span<const PointLight> lights(float scale);

    uint32_t burning() const { return burning_; }
    uint32_t caught() const { return caught_; }
    uint32_t broke() const { return broke_; }  // in the last observe()

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
    std::vector<FwMeshId> meshes_;  // by model; null if it cannot burn
    std::vector<FwImageId> images_;
    std::vector<std::vector<glm::vec3>> beams_;  // by model, m: landing points
    std::vector<size_t> thingOf_;                // by instance
    std::vector<village::Instance> instances_;
    std::vector<PointLight> lights_;
    uint32_t burning_ = 0, caught_ = 0, broke_ = 0;
};

// Returns true if the model has fuel and lies in the play area.
bool canBurn(int model);

}  // namespace tower
