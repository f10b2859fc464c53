#include "support/burn_scene.h"

#include "components/appearance_table.h"
#include "components/appearance_textures.h"
#include "components/fire_flames.h"
#include "fire/heat.h"
#include "fire/presets.h"

#include <glm/gtc/matrix_transform.hpp>
#include <new>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace fw::test {
namespace {

mesh::BurnDomain bakeOf(const Mesh& mesh, double density, bool trust) {
    mesh::BakeInput input = mesh.input(density, 4096);
    input.trustUvs = trust;
    input.noiseAmplitude = 0.15f;
    return mesh::bake(input, std::pmr::get_default_resource());
}

}  // namespace

gpu::BurnMaterial plainMaterial(const mesh::BurnDomain& domain, double rate, double gain,
                                double burnTime) {
    gpu::BurnMaterial m{};
    m.sigma0 = uint32_t(std::lround(4096 / rate * double(domain.quantum) / 8 * 4194304));
    m.headGain = uint32_t(std::lround(gain * 256));
    m.backGain = uint32_t(std::lround(gain * 256));
    m.driveMax = 60 * 1024;
    m.breadthMax = 14 * 256;
    m.burnTicks = burnTime < 0 ? gpu::kNoneTexel : uint32_t(std::lround(burnTime * 4096));
    m.flameTicks = burnTime < 0 ? 40u * 4096u : m.burnTicks;
    m.upCeiling = {0, 1024, 0, 0};
    m.ceiling = 77;
    m.flags = 1;
    m.windowMax = 1u << 20;
    m.air = 256;
    m.powerPerArea = 1e5f;
    m.timeScale = 1;
    return m;
}

BurnScene BurnScene::make(uint32_t seed, double scale) {
    BurnScene scene;
    std::mt19937 random(seed);
    scene.domains.push_back(bakeOf(makePlane(1, 0.7, 33), 48 * scale, true));
    scene.domains.push_back(bakeOf(makeCube(0.4, 3, true), 64 * scale, true));
    scene.domains.push_back(bakeOf(makeCylinder(0.12, 0.6, 24, 6, 4, true), 64 * scale, true));
    scene.domains.push_back(bakeOf(makeConfetti(0.5, 8, 0.02), 64 * scale, true));
    scene.domains.push_back(bakeOf(makeStrips(0.5, 9, 0.02), 64 * scale, true));
    for (const char* name : {"bunny_4k.glb", "spot.glb"}) {
        Mesh mesh;
        std::string error;
        if (!assetPath(name).empty() && loadGlb(name, mesh, error)) {
            const mesh::BurnDomain probe = bakeOf(mesh, 8, false);
            const double extent = std::max({probe.boundsHigh[0] - probe.boundsLow[0],
                                            probe.boundsHigh[1] - probe.boundsLow[1],
                                            probe.boundsHigh[2] - probe.boundsLow[2]});
            scene.domains.push_back(bakeOf(mesh, 40 * scale / extent, false));
        } else {
            std::printf("[ NOTE     ] %s: not there; the other meshes are used\n", name);
        }
    }
    const auto meshes = uint32_t(scene.domains.size());
    for (uint32_t i = 0; i < meshes + 3; ++i) {
        SceneObject object;
        object.mesh = i % meshes;
        const mesh::BurnDomain& domain = scene.domains[object.mesh];
        object.substepShift = i % 3;
        // About half a link per iteration at the fastest.
        const double step = 1.0 / 32 / (1u << object.substepShift);
        const double gain = i % 4 == 0 ? 0 : 1.0;
        const double rate =
            0.35 * double(domain.texelSide) / step / (1 + gain) / (1 + double(random() % 4));
        for (uint32_t m = 0; m < gpu::kMaterialsPerObject; ++m)
            object.materials[m] = plainMaterial(domain, rate, gain, i % 2 ? 1.5 : -1.0);
        object.window = std::max(512u, uint32_t(double(domain.texelSide) / rate * 4096));
        if (i >= meshes) {  // painted: a different slowness map with holes
            object.slowness.assign(domain.slowness.begin(), domain.slowness.end());
            for (uint16_t& value : object.slowness) {
                if (value && random() % 16 == 0) value = 0;
            }
        }
        scene.objects.push_back(object);
    }
    return scene;
}

void BurnScene::addHeat() {
    for (uint32_t o = 0; o < objects.size(); ++o) {
        SceneObject& object = objects[o];
        for (uint32_t m = 0; m < gpu::kMaterialsPerObject; ++m) {
            const uint32_t number = o + m;
            FwMaterialDef def = fire::presetDef(number % 2 ? FW_MATERIAL_COTTON : FW_MATERIAL_PINE);
            if (number % 3 == 1) def.moisture = 1.5f * def.extinctionMoisture;
            if (number % 5 == 2) def.flameFeedback = 9000;
            fire::HeatPlace place;
            place.texelArea = domains[object.mesh].texelSide * domains[object.mesh].texelSide;
            place.pace = number % 2 ? 10.0f : 150.0f;
            gpu::HeatMaterial heat = fire::heatMaterial(def, place);
            if (!(heat.flags & gpu::kHeatThick)) heat.burnTicks = object.materials[m].flameTicks;
            object.heat.push_back(heat);
        }
    }
}

namespace {
constexpr uint32_t kReferenceDepth = 2;
}

void BurnScene::refineByReference() { refinesByReference = true; }

gpu::ObjectInit BurnScene::init(uint32_t index) const {
    const SceneObject& object = objects[index];
    const mesh::BurnDomain& domain = domains[object.mesh];
    gpu::ObjectInit init{};
    init.mesh = object.mesh;
    init.record.flags = gpu::kObjectLive | object.flags;
    init.record.window = object.window;
    init.record.substepShift = object.substepShift;
    init.record.horizon = 8192;
    init.record.originQuantum = {domain.origin[0], domain.origin[1], domain.origin[2],
                                 domain.quantum};
    init.record.worldRow0 = {1, 0, 0, 2.0f * float(index)};
    init.record.worldRow1 = {0, 1, 0, 0};
    init.record.worldRow2 = {0, 0, 1, 0};
    init.record.tint = {1, 1, 1, domain.texelSide * domain.texelSide};
    init.materials = object.materials;
    init.slowness = object.slowness;
    init.heat = object.heat;
    init.refine = object.refine;
    init.refineDepth = 4;
    init.refinePixelsPerEdge = object.refinePixelsPerEdge;
    if (object.reference) {
        init.refine = true;
        init.refineDepth = kReferenceDepth;
        init.refineExtended = true;
        init.boundary.speed = 0.3f;
    }
    if (object.deform.flags || (object.flags & gpu::kObjectSkinned)) {
        init.deformModel = &models[object.mesh];
        init.deform = &object.deform;
        init.inner = object.deform.wall > 0;
    }
    return init;
}

void BurnScene::create(gpu::Backend& backend) const {
    for (uint32_t i = 0; i < domains.size(); ++i) backend.createMesh(i, domains[i]);
    std::vector<bool> refined(domains.size()), hollow(domains.size());
    for (const SceneObject& object : objects) {
        if (object.deform.wall <= 0 || hollow[object.mesh]) continue;
        std::vector<glm::vec3> places;  // around its origin
        for (const mesh::RenderVertex& v : domains[object.mesh].vertices)
            places.push_back(0.8f * glm::vec3(v.position[0], v.position[1], v.position[2]));
        backend.createInnerSkin(object.mesh, domains[object.mesh], places);
        hollow[object.mesh] = true;
    }
    for (const SceneObject& object : objects) {
        if (!object.refine || refined[object.mesh]) continue;
        mesh::RefineOptions options;
        options.depth = 4;
        const mesh::BurnDomain& domain = domains[object.mesh];
        backend.createRefinement(
            object.mesh, 4, false, domain,
            mesh::bakeRefine(domain, options, std::pmr::get_default_resource()),
            std::array<mesh::RefineHoles, 1>{{{0.4f, 2.6f, 0.8f, true}}});
        refined[object.mesh] = true;
    }
    if (refinesByReference) {
        auto* memory = std::pmr::get_default_resource();
        backend.createRefinement(
            0, kReferenceDepth, true, domains[0],
            mesh::bakeRefine(domains[0], backend.extendedRefineOptions(kReferenceDepth), memory),
            {});
    }
    for (uint32_t i = 0; i < objects.size(); ++i) backend.createObject(i, init(i));
}

void OwnedPlan::point() {
    for (size_t i = 0; i < steps.size(); ++i) {
        steps[i].events = events[i];
        steps[i].materials = updates[i];
    }
    plan.steps = steps;
    plan.probes = probes;
    plan.burnMaps = maps;
}

void PlanMaker::ball(std::vector<gpu::TexelEvent>& out, uint32_t object, uint32_t kind,
                     float radius) {
    const mesh::BurnDomain& domain = scene_.domains[scene_.objects[object].mesh];
    uint32_t centre = pick(domain.texelCount());
    for (int tries = 0; tries < 64 && !domain.real(centre); ++tries)
        centre = pick(domain.texelCount());
    const mesh::TexelPosition& t = domain.texels[centre];
    const float point[3] = {domain.origin[0] + domain.quantum * float(t.x),
                            domain.origin[1] + domain.quantum * float(t.y),
                            domain.origin[2] + domain.quantum * float(t.z)};
    std::pmr::vector<uint32_t> texels;
    mesh::texelsNear(domain, point, radius * domain.texelSide, texels);
    for (const uint32_t texel : texels)
        out.push_back({object, texel, kind,
                       kind == gpu::kEventWet    ? 1 + pick(300)
                       : kind == gpu::kEventHeat ? 1 + pick(500000)
                                                 : now_ + 1 + pick(gpu::kStepTicks)});
}

OwnedPlan PlanMaker::next(uint32_t count, bool maps, uint32_t switches) {
    OwnedPlan out;
    out.plan.frameIndex = ++frame_;
    out.plan.switches = switches;
    const auto objects = uint32_t(scene_.objects.size());
    for (uint32_t s = 0; s < count; ++s) {
        gpu::StepPlan step;
        step.now = now_;
        for (const SceneObject& object : scene_.objects)
            step.substepShift = std::max(step.substepShift, object.substepShift);
        step.reduce = step_ % 4 == 0;
        step.heat = step_ % gpu::kHeatSteps == 2;
        std::vector<gpu::TexelEvent> texels;
        if (step_ == 0) {
            for (uint32_t o = 0; o < objects; ++o) ball(texels, o, gpu::kEventIgnite, 3);
        }
        if (chance(events)) {
            const uint32_t object = pick(objects);
            const uint32_t kinds[] = {
                gpu::kEventIgnite, gpu::kEventIgnite,     gpu::kEventIgnite, gpu::kEventWet,
                gpu::kEventDry,    gpu::kEventExtinguish, gpu::kEventHeat,   gpu::kEventExtinguish};
            const uint32_t kind = kinds[pick(8)];
            const float reach = kind == gpu::kEventIgnite ? 3.0f : 12.0f;
            ball(texels, object, kind, 0.5f + reach * float(pick(1000)) / 1000.0f);
            if (chance(0.3)) ball(texels, object, kinds[pick(8)], 4.0f);
        }
        if (chance(0.004)) {  // much is extinguished so that much can burn again
            const uint32_t object = pick(objects);
            ball(texels, object, gpu::kEventDry, 1000);
            ball(texels, object, gpu::kEventExtinguish, 1000);
            ball(texels, object, gpu::kEventIgnite, 2);
        }
        std::stable_sort(texels.begin(), texels.end(),
                         [](const gpu::TexelEvent& a, const gpu::TexelEvent& b) {
                             return a.object != b.object ? a.object < b.object : a.texel < b.texel;
                         });
        // Some heat passes through holes.
        const size_t sorted = texels.size();
        for (size_t i = 0; i < sorted; ++i) {
            if (texels[i].kind != gpu::kEventHeat || chance(0.3)) continue;
            texels[i].kind |= uint32_t(texels.size() + 1) << gpu::kEventKindBits;
            const uint32_t gates = 1 + pick(gpu::kGates);
            for (uint32_t k = 0; k < gates; ++k) {
                const uint32_t object = pick(objects);
                const uint32_t shut = chance(0.5) ? gpu::kGateShut : 0;
                const uint32_t more = k + 1 < gates ? gpu::kGateMore : 0;
                texels.push_back({object,
                                  pick(scene_.domains[scene_.objects[object].mesh].texelCount()),
                                  gpu::kEventGate | shut | more, pick(2 * gpu::kTicksPerSecond)});
            }
        }
        std::vector<gpu::MaterialUpdate> updates;
        if (chance(latches)) {
            const uint32_t object = pick(objects);
            gpu::MaterialUpdate update{};
            update.object = object;
            update.window = scene_.objects[object].window;
            update.substepShift = scene_.objects[object].substepShift;
            const int drive[3] = {int(pick(1025)) - 512, int(pick(1025)) - 512,
                                  int(pick(1025)) - 512};
            for (uint32_t m = 0; m < gpu::kMaterialsPerObject; ++m) {
                update.materials[m] = scene_.objects[object].materials[m];
                update.materials[m].driveX = drive[0];
                update.materials[m].driveY = drive[1];
                update.materials[m].driveZ = drive[2];
                update.materials[m].air = 256 + uint32_t(drive[0] + 512) / 8;
            }
            updates.push_back(update);
        }
        out.steps.push_back(step);
        out.events.push_back(std::move(texels));
        out.updates.push_back(std::move(updates));
        now_ += gpu::kStepTicks;
        ++step_;
    }
    out.plan.endTick = now_;
    if (chance(0.5)) {
        for (int i = 0; i < 5; ++i) {
            const uint32_t object = pick(objects);
            out.probes.push_back(
                {object, pick(scene_.domains[scene_.objects[object].mesh].texelCount())});
        }
    }
    if (maps) {
        for (uint32_t o = 0; o < objects; ++o) out.maps.push_back(o);
    }
    out.point();
    return out;
}

gpu::AppearanceSources testAppearances() {
    static const std::pmr::vector<std::byte> textures =
        components::bakeAppearanceTextures(std::pmr::get_default_resource());
    gpu::AppearanceSources sources;
    sources.table = components::materialAppearances();
    sources.families = components::materialFamilies();
    sources.textures = textures;
    static const std::pmr::vector<std::byte> profiles =
        components::bakeFireProfiles(std::pmr::get_default_resource());
    sources.profiles = profiles;
    return sources;
}

FwView testView(const float eye[3], const float target[3], float degrees, float aspect,
                bool reversedDepth) {
    const glm::mat4 view =
        glm::lookAt(glm::vec3(eye[0], eye[1], eye[2]), glm::vec3(target[0], target[1], target[2]),
                    glm::vec3(0, 1, 0));
    const float near = 0.05f, far = 50.0f, focal = 1 / std::tan(glm::radians(degrees) / 2);
    glm::mat4 projection(0.0f);
    projection[0][0] = focal / aspect;
    projection[1][1] = -focal;  // y down
    projection[2][3] = -1;
    projection[2][2] = reversedDepth ? near / (far - near) : far / (near - far);
    projection[3][2] = reversedDepth ? near * far / (far - near) : near * far / (near - far);
    FwView out = fwDefaultView();
    std::copy_n(&view[0][0], 16, out.view);
    std::copy_n(&projection[0][0], 16, out.projection);
    return out;
}

gpu::VolumeFlame flameAlone(const FwVolumetricFireDef& def, float seconds) {
    std::pmr::memory_resource* memory = std::pmr::get_default_resource();
    components::VolumetricFire fire(memory);
    components::makeVolumetricFire(def, 1, fire);
    components::FireFlames flames(memory);
    flames.reserveFlames(fire.partCount);
    gpu::VolumeFlame flame{};
    for (float t = 0; t < seconds; t += 0.1f) {
        flames.begin();
        flames.settle(fire, {});
        flames.advance({}, 0.1f);
        (void)flames.write({&flame, 1});
        flames.commit();
        fire.state = fire.nextState;
    }
    return flame;
}

FrameAnswer copyAnswer(const gpu::Readback& readback) {
    FrameAnswer answer;
    answer.frameIndex = readback.frameIndex;
    answer.counters.assign(readback.objects.begin(), readback.objects.end());
    answer.answers.assign(readback.answers.begin(), readback.answers.end());
    answer.maps.resize(readback.burnMaps.empty() ? 0 : readback.objects.size());
    answer.heat.resize(answer.maps.size());
    for (const gpu::ObjectImage& map : readback.burnMaps) {
        answer.maps[map.object].assign(map.ticks.begin(), map.ticks.end());
        answer.heat[map.object].assign(map.heat.begin(), map.heat.end());
    }
    answer.frontTiles = readback.frontTiles;
    answer.runTiles = readback.runTiles;
    answer.burningTiles = readback.burningTiles;
    answer.hotTiles = readback.hotTiles;
    return answer;
}

// Callbacks that count allocations.
static FwCallbacks countingMemory(std::atomic<uint64_t>& count) {
    FwCallbacks callbacks{};
    callbacks.userData = &count;
    callbacks.allocate = [](void* counted, size_t size, size_t alignment) -> void* {
        ++*static_cast<std::atomic<uint64_t>*>(counted);
        return ::operator new(size, std::align_val_t(alignment), std::nothrow);
    };
    callbacks.release = [](void*, void* memory, size_t, size_t alignment) {
        ::operator delete(memory, std::align_val_t(alignment));
    };
    return callbacks;
}

VkRig::VkRig(TestDevice& device, uint32_t inFlight, uint64_t budget,
             const gpu::vk::WorldLimits& limits, PFN_vkGetInstanceProcAddr entry)
    : host(device.host()),
      memory(countingMemory(allocations)),
      log(FwCallbacks{}),
      context((entry ? host.getInstanceProcAddr = entry : nullptr, &host), budget, &memory, log),
      backend(context, limits, &memory, log),
      frames(device, inFlight) {
    context.prepare();
    view = fwDefaultView();
}

void VkRig::collect() {
    while (const gpu::Readback* readback = backend.nextReadback())
        answers_.push_back(copyAnswer(*readback));
}

void VkRig::run(const gpu::FramePlan& plan) {
    const FwVulkanFrame frame = frames.begin();
    ASSERT_TRUE(backend.beginOutside(frame, view));
    collect();
    backend.run(plan);
    backend.endOutside();
    if (alsoRecord) alsoRecord(frame);
    frames.submit();
}

std::vector<FrameAnswer> VkRig::finish() {
    frames.waitAll();
    gpu::FramePlan nothing;  // an empty frame that only completes the others
    run(nothing);
    frames.waitAll();
    return applyAnswers();
}

}  // namespace fw::test
