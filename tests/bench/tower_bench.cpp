// Cost of flamethrowers in the tower-defence village: all objects burnable, seen as in the sample,
// with jets along the road that sweep sideways, 100 particles each. A frame is a sixtieth of a
// second and an offscreen picture. Time: all threads of this process. Interleaved: `ratio` to the
// same village burning on without jets; `ratio_unlit` to one without fire. step_ms: of the step
// before the picture; burning: objects on fire at the end.
#include <benchmark/benchmark.h>

#include "bench/bench_device.h"
#include "flamewright/flamewright.h"
#include "village/ground.h"
#include "village/layout.h"

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <cmath>
#include <cstring>
#include <vector>

namespace fw::test::tower_bench {
namespace {

using fw::test::cpuSeconds;

constexpr uint32_t kWidth = 1280, kHeight = 720;

class Scene {
 public:
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;
    explicit Scene(uint32_t throwers) : pixels_(size_t{kWidth} * kHeight * 4) {
        const FwContextDef contextDef = fwDefaultContextDef();
        FwWorldDef worldDef = fwDefaultWorldDef();
        worldDef.paceFactor = 14;
        worldDef.seed = 1;
        worldDef.wind[0] = -2.4f;
        worldDef.wind[2] = -2;
        FwErrorInfo info{};
        if (fwCreateContext(&contextDef, &context_, &info) != FW_OK ||
            fwCreateWorld(context_, &worldDef, &world_) != FW_OK)
            return;
        const village::Scene village = village::makeVillage(1);
        makeMaterials();
        if (!place(village)) return;
        for (uint32_t i = 0; i < throwers; ++i)
            if (!addThrower((float(i) + 0.5f) / float(throwers), i)) return;
        look();
        works_ = true;
        for (int i = 0; i < 30; ++i) step(0.1f);  // 3 s, until enough burns
        for (int i = 0; i < 2; ++i) frame();      // pipelines are compiled at first use
    }
    ~Scene() {
        fwDestroyWorld(world_);
        fwDestroyContext(context_);
    }
    void rest() {  // stops its flamethrowers, keeps its fires
        for (const Thrower& t : throwers_) fwWorld_DestroyFireEmitter(world_, t.jet);
        throwers_.clear();
    }
    struct Cost {
        double step = 0, all = 0;  // s, of all threads
    };
    Cost frame() {
        Cost cost;
        const double start = cpuSeconds();
        step(1.0f / 60);
        cost.step = cpuSeconds() - start;
        fwWorld_RenderOffscreen(world_, &shot_);
        cost.all = cpuSeconds() - start;
        return cost;
    }
    [[nodiscard]] uint32_t burning() const {
        FwWorldStats stats{};
        stats.structSize = sizeof stats;
        fwWorld_GetStats(world_, &stats);
        return stats.burningObjects;
    }
    [[nodiscard]] bool works() const { return works_; }

 private:
    struct Thrower {
        FwFireEmitterId jet{};
        float place[3] = {}, yaw = 0;
    };

    void makeMaterials() {
        using village::Material;
        const auto make = [&](Material slot, uint32_t preset) {
            FwMaterialDef def = fwDefaultMaterialDef();
            fwInitMaterialPreset(&def, preset);
            fwWorld_CreateMaterial(world_, &def, &materials_[size_t(slot)]);
        };
        make(Material::kWood, FW_MATERIAL_PINE);
        make(Material::kPaint, FW_MATERIAL_PAINTED_WOOD);
        make(Material::kThatch, FW_MATERIAL_THATCH);
        make(Material::kStraw, FW_MATERIAL_THATCH);
        make(Material::kLeaf, FW_MATERIAL_DRY_LEAF);
        make(Material::kCloth, FW_MATERIAL_COTTON);
    }
    // The first eight materials; the others are ground and water, which burn as little as stone.
    bool addModel(const village::Model& model, float texelsPerMetre, FwMeshId& id) {
        if (model.indices.empty()) return true;
        std::vector<float> positions;
        for (const village::Vertex& v : model.vertices)
            positions.insert(positions.end(), {v.position.x, v.position.y, v.position.z});
        std::vector<uint8_t> materials;
        for (const village::Material m : model.materials)
            materials.push_back(uint8_t(std::min<int>(int(m), 6)));
        FwMeshDef def = fwDefaultMeshDef();
        def.positions = positions.data();
        def.vertexCount = uint32_t(model.vertices.size());
        def.indices = model.indices.data();
        def.indexCount = uint32_t(model.indices.size());
        def.indexSize = 4;
        def.triangleMaterials = materials.data();
        def.texelsPerMetre = texelsPerMetre;
        def.mapSize = 256;
        return fwWorld_CreateMesh(world_, &def, &id) == FW_OK;
    }
    bool addThing(FwMeshId mesh, const village::Frame& f) {
        if (mesh.index1 == 0) return true;
        FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
        def.mesh = mesh;
        def.flags = FW_BURNABLE_LITE;
        std::copy_n(materials_, 6, def.materials);
        const float placed[16] = {f.x.x, f.x.y, f.x.z, 0, f.y.x,      f.y.y,      f.y.z,      0,
                                  f.z.x, f.z.y, f.z.z, 0, f.origin.x, f.origin.y, f.origin.z, 1};
        std::copy_n(placed, 16, def.transform);
        FwBurnableMeshId id{};
        return fwWorld_CreateBurnableMesh(world_, &def, &id) == FW_OK;
    }
    bool place(const village::Scene& village) {
        std::vector<FwMeshId> meshes(village.models.size());
        for (size_t i = 0; i < meshes.size(); ++i)
            if (!addModel(village.models[i], 12, meshes[i])) return false;
        for (const village::Instance& thing : village.instances)
            if (!addThing(meshes[size_t(thing.model)], thing.frame)) return false;
        return true;
    }
    bool addThrower(float share, uint32_t i) {
        village::Vec2 way;
        const village::Vec2 at = village::roadPoint(village::roadLength() * share, &way);
        const float side = i % 2 ? 2.3f : -2.3f;
        Thrower thrower;
        thrower.place[0] = at.x - way.y * side;
        thrower.place[2] = at.y + way.x * side;
        const float ground = village::groundHeight({thrower.place[0], thrower.place[2]});
        thrower.place[1] = ground + 2.5f;
        thrower.yaw = std::atan2(side * way.y, -side * way.x);
        FwFireEmitterDef def = fwDefaultFireEmitterDef();
        def.flags = FW_EMITTER_JET | FW_EMITTER_IGNITES | FW_EMITTER_GROUND;
        def.power = 700;
        def.maxParticles = 100;
        def.rate = 70;
        def.smokeLife = 1.2f;
        def.ground = ground;
        std::copy_n(thrower.place, 3, def.position);
        if (fwWorld_CreateFireEmitter(world_, &def, &thrower.jet) != FW_OK) return false;
        throwers_.push_back(thrower);
        return true;
    }
    void step(float seconds) {
        time_ += seconds;
        for (size_t i = 0; i < throwers_.size(); ++i) {
            const Thrower& t = throwers_[i];
            const float yaw = t.yaw + 0.8f * std::sin(1.3f * time_ + float(i));
            const float direction[3] = {std::sin(yaw), -0.2f, std::cos(yaw)};
            fwWorld_MoveFireEmitter(world_, t.jet, t.place, direction);
        }
        fwWorld_Step(world_, seconds);
    }
    void look() {
        const glm::vec3 target(-1.5f, 0.2f, -2.9f), eye = target + glm::vec3(0, 35.8f, 36.3f);
        const glm::mat4 view = glm::lookAt(eye, target, glm::vec3(0, 1, 0));
        glm::mat4 projection(0.0f);
        const float tall = 1 / std::tan(0.5f * glm::radians(29.0f));
        projection[0][0] = tall * float(kHeight) / float(kWidth);
        projection[1][1] = -tall;
        projection[2][2] = projection[2][3] = -1.0f;
        projection[3][2] = -4.0f;
        shot_.width = kWidth;
        shot_.height = kHeight;
        shot_.pixels = pixels_.data();
        shot_.view = fwDefaultView();
        std::memcpy(shot_.view.view, glm::value_ptr(view), sizeof shot_.view.view);
        std::memcpy(shot_.view.projection, glm::value_ptr(projection),
                    sizeof shot_.view.projection);
    }

    FwContext* context_ = nullptr;
    FwWorld* world_ = nullptr;
    FwMaterialId materials_[6]{};
    std::vector<Thrower> throwers_;
    std::vector<uint8_t> pixels_;
    FwOffscreenDef shot_ = fwDefaultOffscreenDef();
    float time_ = 0;  // s
    bool works_ = false;
};

void towerDefence(benchmark::State& state, uint32_t throwers) {
    Scene none(0), lit(throwers), some(throwers);
    if (!none.works() || !lit.works() || !some.works()) return state.SkipWithError("no device");
    lit.rest();
    lit.frame();
    Scene::Cost unlit, bare, with;
    for (auto _ : state) {
        const Scene::Cost a = none.frame(), b = lit.frame(), c = some.frame();
        unlit.all += a.all;
        bare.all += b.all;
        with.all += c.all;
        with.step += c.step;
        state.SetIterationTime(c.all);
    }
    state.counters["ratio_unlit"] = with.all / unlit.all;
    state.counters["step_ms"] = 1e3 * with.step / double(state.iterations());
    state.counters["ratio"] = with.all / bare.all;
    state.counters["burning"] = some.burning();
}
#define FW_TOWER_ROW(name, throwers)                \
    BENCHMARK_CAPTURE(towerDefence, name, throwers) \
        ->Name("scene/tower_defence/" #name)        \
        ->Unit(benchmark::kMillisecond)             \
        ->UseManualTime()                           \
        ->Iterations(9)
FW_TOWER_ROW(none, 0);
FW_TOWER_ROW(throwers10, 10);
FW_TOWER_ROW(throwers100, 100);

}  // namespace
}  // namespace fw::test::tower_bench
