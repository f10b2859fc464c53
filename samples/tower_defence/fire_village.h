// Everything of the village that can burn, handed to the fire library through its public C ABI.
// Keeps what a game adds: who lights whom, what is drawn by whom, and the fires as lights.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "common/fire_host.h"
#include "paint.h"
#include "renderer.h"

namespace tower {

struct Thing {            // one instance that can burn
    size_t instance = 0;  // into Scene::instances
    FwBurnableMeshId id{};
    village::Frame frame;     // model to world, as the library last heard
    village::Vec3 low, high;  // m, model space
    bool lit = false;         // has caught; from then on the library draws it
    bool over = false;        // burnt out
    bool moves = false;
    float rest = 0;       // s until a flame is worth testing against it again
    float dose = 0;       // kJ/m^2 taken up from neighbours
    glm::vec3 origin{0};  // m, model space: where it first caught
    float reach = 0.3f;   // m, how far flames lick from there to other parts
    FwObjectState state{};
};

class FireVillage {
 public:
    // Cooks the meshes on all cores, then makes materials, pictures and objects. Throws
    // sample::Failure.
    FireVillage(sample::FireHost& fire, const village::Scene& scene, const PaintedVillage& painted,
                uint32_t seed);

    std::vector<Thing> things;
    // The thing of an instance, or npos if that cannot burn.
    static constexpr size_t kNone = ~size_t{0};
    size_t thingOf(size_t instance) const { return thingOf_[instance]; }

    // A ball of flame; false if no fuel of the thing is within reach.
    bool ignite(size_t thing, glm::vec3 place, float radius);
    void move(size_t thing, const village::Frame& frame);
    // Reads events and states, then lets burning things heat their neighbours. After Step or
    // RecordOutside of the frame before.
    void advance(float deltaTime, glm::vec3 wind);
    // The fires as the library reports them, strongest first. scale: intensity per watt.
    std::span<const PointLight> lights(float scale);

    uint32_t burning() const { return burning_; }
    uint32_t caught() const { return caught_; }
    glm::vec3 fireCentre(const Thing& thing) const;  // m, world; about where it burns

 private:
    void makeMaterials();
    void makeModel(size_t model, const village::Model& source, const PaintedModel& painted,
                   const std::vector<uint8_t>& cooked);
    void makeThings(const village::Scene& scene);
    void pollEvents();
    void heatNeighbours(float deltaTime, glm::vec3 wind);
    void throwBrands(uint32_t slot, glm::vec3 wind);
    void landBrand(glm::vec3 place);
    void lickOtherParts(uint32_t slot);

    sample::FireHost& fire_;
    FwMaterialId materials_[8]{};
    std::vector<FwMeshId> meshes_;  // by model; null where it cannot burn
    std::vector<FwImageId> images_;
    std::vector<size_t> thingOf_;  // by instance
    std::vector<PointLight> lights_;
    uint32_t seed_;
    float time_ = 0;  // s
    uint32_t burning_ = 0, caught_ = 0;
};

// Whether the model is worth burning at all: has fuel and stands in the play area.
bool canBurn(int model);

}  // namespace tower
