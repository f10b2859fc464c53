// A scene with a little of every feature, for losing a device at one call after another. A failing
// call ends it; the last save is the mirror.
#pragma once
#include "abi/abi_support.h"
#include "support/losing_vulkan.h"

#include <algorithm>
#include <functional>
#include <map>
#include <memory>

namespace host {

using Bytes = std::vector<unsigned char>;

class LossScene {
 public:
    static constexpr uint32_t kFrames = 9;
    static constexpr uint32_t kSaves[] = {2, 5};  // requested before these frames

    // Records a frame or makes a picture, on an own device, a host device or none.
    std::function<FwResult(FwWorld*, float seconds)> step = fwWorld_Step;
    std::function<FwResult(FwWorld*)> picture;  // null: none
    // Number of Vulkan calls so far, and the count when each mirror arrived; null: not counted.
    std::function<int64_t()> calls;
    std::vector<int64_t> mirroredAt;

    // In a context that the caller destroys.
    FwResult make(FwContext* context) {
        FwWorldDef def = fwDefaultWorldDef();
        def.flags = FW_WORLD_RADIATION | FW_WORLD_CONTACT | FW_WORLD_EMBERS;
        def.paceFactor = 12;
        def.seed = 3;
        FwResult result = fwCreateWorld(context, &def, &world);
        const uint32_t presets[] = {FW_MATERIAL_PAPER, FW_MATERIAL_COTTON, FW_MATERIAL_PINE};
        const uint32_t flags[] = {FW_BURNABLE_REFINE, FW_BURNABLE_SHELL, 0};
        for (uint32_t i = 0; i < 3 && result == FW_OK; ++i) result = add(presets[i], flags[i], i);
        FwFireEmitterDef jet = fwDefaultFireEmitterDef();
        jet.flags = FW_EMITTER_JET | FW_EMITTER_IGNITES;
        jet.position[1] = 0.3f;
        jet.direction[0] = 1, jet.direction[1] = 0;
        jet.power = 100;
        FwFireEmitterId emitter{};
        if (result == FW_OK) result = fwWorld_CreateFireEmitter(world, &jet, &emitter);
        FwVolumetricFireDef fire = fwDefaultVolumetricFireDef();
        fire.position[0] = 0.6f;
        FwVolumetricFireId fireId{};
        if (result == FW_OK) result = fwWorld_CreateVolumetricFire(world, &fire, &fireId);
        FwParticleFieldDef field = fwDefaultParticleFieldDef();
        (void)fwInitFieldPreset(&field, FW_FIELD_WATER);
        field.flags |= FW_FIELD_WETS;
        field.width = field.height = 32;
        FwParticleFieldId fieldId{};
        if (result == FW_OK) result = fwWorld_CreateParticleField(world, &field, &fieldId);
        return result;
    }

    // From frame `from` to the end. Each arriving save becomes the mirror.
    FwResult play(uint32_t from = 0) {
        FwResult result = FW_OK;
        for (uint32_t frame = from; frame < kFrames && result == FW_OK; ++frame) {
            if (frame == 0) {
                FwIgnitionDef ball = fwDefaultIgnitionDef();
                ball.position[0] = 0.15f, ball.position[2] = 0.1f;
                ball.radius = 0.1f;
                uint32_t texels = 0;
                result = fwWorld_Ignite(world, &ball, &texels);
            }
            if (const auto* one = std::find(std::begin(kSaves), std::end(kSaves), frame);
                one != std::end(kSaves) && result == FW_OK && (requested = *one) > from)
                result = fwWorld_RequestSave(world);
            if (result == FW_OK) result = step(world, 1.0f / 16);
            completeSave();
            if (result == FW_OK && picture && frame % 3 == 1) result = picture(world);
        }
        return result;
    }
    // Takes a new save; FW_OK, or a valid result if there is none.
    FwResult completeSave() {
        if (requested == 0) return FW_OK;
        uint64_t size = 0;
        FwResult result = fwWorld_FetchSave(world, nullptr, &size);
        if (result != FW_OK) return result == FW_NOT_READY ? FW_OK : result;
        mirror.resize(size);
        result = fwWorld_FetchSave(world, mirror.data(), &size);
        if (mirrored != requested && calls) mirroredAt.push_back(calls());
        mirrored = requested;
        return result;
    }
    // A save of now, waiting as long as needed; empty if there is none.
    Bytes save() {
        Bytes bytes;
        uint64_t size = 0;
        if (fwWorld_RequestSave(world) != FW_OK) return bytes;
        for (int i = 0; i < 8 && fwWorld_FetchSave(world, nullptr, &size) == FW_NOT_READY; ++i)
            if (step(world, 0) != FW_OK) return bytes;
        bytes.resize(size);
        if (fwWorld_FetchSave(world, bytes.data(), &size) != FW_OK) bytes.clear();
        return bytes;
    }

    FwWorld* world = nullptr;
    Bytes mirror;
    uint32_t requested = 0, mirrored = 0;  // frame of the last request, and of `mirror`; 0: none

 private:
    FwResult add(uint32_t preset, uint32_t flags, uint32_t i) {
        const Sheet sheet(0.3f, 0.2f, 3);
        const FwMeshDef mesh = sheet.def(64);
        FwMaterialDef material = fwDefaultMaterialDef();
        (void)fwInitMaterialPreset(&material, preset);
        FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
        def.flags |= flags;
        def.transform[12] = 0.32f * float(i);
        FwBurnableMeshId id{};
        FwResult result = fwWorld_CreateMesh(world, &mesh, &def.mesh);
        if (result == FW_OK) result = fwWorld_CreateMaterial(world, &material, &def.materials[0]);
        if (result == FW_OK) result = fwWorld_CreateBurnableMesh(world, &def, &id);
        return result;
    }
};

// The same scene on the cpu backend, which cannot be lost: the correct saves by frame.
struct LossReference {
    std::map<uint32_t, Bytes> saves;
    Bytes end;
    Host host;

    LossReference() {
        FwContext* context = createCpuContext(host);
        LossScene scene;
        EXPECT_EQ(FW_OK, scene.make(context));
        scene.step = [&](FwWorld* world, float seconds) {
            const FwResult result = fwWorld_Step(world, seconds);
            uint64_t size = 0;
            if (scene.requested && !saves.contains(scene.requested) &&
                fwWorld_FetchSave(world, nullptr, &size) == FW_OK) {
                saves[scene.requested].resize(size);
                EXPECT_EQ(FW_OK, fwWorld_FetchSave(world, saves[scene.requested].data(), &size));
            }
            return result;
        };
        EXPECT_EQ(FW_OK, scene.play());
        end = scene.save();
        EXPECT_EQ(std::size(LossScene::kSaves), saves.size());
        fwDestroyContext(context);
    }
    // A world on `context` continues from the mirror as if no device had been lost.
    void expectRecovers(FwContext* context, LossScene& scene, const Bytes& mirror, uint32_t frame) {
        ASSERT_EQ(FW_OK, scene.make(context)) << lastMessage(context);
        ASSERT_EQ(FW_OK, fwWorld_Load(scene.world, mirror.data(), mirror.size()))
            << lastMessage(scene.world);
        EXPECT_EQ(mirror, scene.save()) << "saved after the load";
        ASSERT_EQ(FW_OK, scene.play(frame + 1)) << lastMessage(scene.world);
        EXPECT_EQ(end, scene.save()) << "from frame " << frame;
    }
};

// Chooses the calls at which to lose the device from those of a whole run. FLAMEWRIGHT_LOSE_EVERY
// in the environment: every n-th call from the first; 1: each. Otherwise every `apart`-th from
// `frames` (the first frame), those at which a mirror arrived, and the last call of every other
// entry. `odd` selects the remaining entries, so that two tests share them.
inline std::vector<int64_t> chooseLosses(const fw::test::LosingVulkan& vulkan, int64_t frames,
                                         int64_t calls, std::vector<int64_t> mirroredAt,
                                         int64_t apart, bool odd) {
    const char* asked = std::getenv("FLAMEWRIGHT_LOSE_EVERY");
    const bool all = asked && *asked;
    if (all) apart = std::max<int64_t>(std::atoll(asked), 1);
    std::vector<int64_t> chosen;
    if (!all) chosen = std::move(mirroredAt);
    for (int64_t i = all ? 0 : frames; i < calls; i += apart) chosen.push_back(i);
    if (all) return chosen;
    std::map<std::string, int64_t> last;
    for (int64_t i = 0; i < calls; ++i) last[vulkan.nameOf(i)] = i;
    bool takes = odd;
    for (const auto& [name, call] : last) {
        takes = !takes;
        if (takes) chosen.push_back(call);
    }
    std::sort(chosen.begin(), chosen.end());
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    return chosen;
}
// Timestamps are read from a completed frame, so their loss need not fail the next frame.
inline bool mayPass(const char* name) { return std::strcmp(name, "vkGetQueryPoolResults") == 0; }
// True if `result` is valid after a loss at the call `name`.
inline bool reportsLoss(FwResult result, const char* name) {
    return result == FW_ERROR_DEVICE_LOST || (result == FW_OK && mayPass(name));
}
// `mirrors`: how many runs continued from the mirror of each frame; 0: from none.
inline void printLosses(size_t losses, int64_t calls, std::map<uint32_t, uint32_t>& mirrors) {
    std::printf("%zu of %lld calls; without a mirror %u, with the first %u, with the second %u\n",
                losses, static_cast<long long>(calls), mirrors[0], mirrors[LossScene::kSaves[0]],
                mirrors[LossScene::kSaves[1]]);
}

}  // namespace host
