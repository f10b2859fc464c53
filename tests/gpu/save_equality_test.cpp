// Saves of a host device, which arrive some frames late, against those of the cpu backend: worlds
// loaded from either continue identically on both.
#include "gpu/cpu/cpu_backend.h"
#include "support/burn_scene.h"
#include "support/world_defs.h"
#include "world/world.h"

#include "core/hash.h"
#include "fire/presets.h"

#include <cmath>

namespace fw::test {
namespace {

using Bytes = std::pmr::vector<std::byte>;

FwWorldDef saveWorldDef() {
    FwWorldDef def =
        plainWorldDef(FW_WORLD_RADIATION | FW_WORLD_PLUME | FW_WORLD_CONTACT | FW_WORLD_EMBERS);
    def.paceFactor = 15;
    def.seed = 3;
    def.maxBurningTiles = 120;
    return def;
}

// A world on either backend, driven by frames with equal numbers.
class AWorld {
 public:
    AWorld(TestDevice* device, uint32_t inFlight = 3) {
        std::pmr::memory_resource* memory = std::pmr::get_default_resource();
        if (device) {
            rig_ = std::make_unique<VkRig>(*device, inFlight);
        } else {
            cpu_ = std::make_unique<gpu::cpu::CpuBackend>(memory, 4);
        }
        gpu::Backend& backend = rig_ ? static_cast<gpu::Backend&>(rig_->backend) : *cpu_;
        world_ = std::make_unique<world::World>(saveWorldDef(), backend, log_, memory);
        const Mesh board = makePlane(0.5, 0.3), box = makeCube(0.25, 2);
        const uint32_t presets[] = {FW_MATERIAL_PAPER, FW_MATERIAL_COTTON, FW_MATERIAL_DRY_LEAF,
                                    FW_MATERIAL_PLYWOOD, FW_MATERIAL_PINE};
        for (uint32_t i = 0; i < 12; ++i) {
            FwMeshDef def = plainMeshDef(i % 3 ? board : box, 40);
            def.noiseAmplitude = 0.15f;
            FwBurnableMeshDef object = plainBurnableDef(world_->scene().createMesh(def));
            object.flags = i % 5 == 4 ? uint32_t(FW_BURNABLE_LITE) : 0u;
            object.materials[0] = world_->scene().createMaterial(fire::presetDef(presets[i % 5]));
            float(&at)[16] = object.transform;
            const float turn = 0.4f * float(i);
            at[0] = at[10] = std::cos(turn);
            at[8] = std::sin(turn);
            at[2] = -at[8];
            at[5] = at[15] = 1;
            at[12] = 0.35f * float(i % 4);
            at[13] = 0.1f * float(i % 2);
            at[14] = 0.3f * float(i / 4);
            ids_.push_back(world_->createBurnableMesh(object));
        }
    }

    void step(float seconds) {
        if (!rig_) {
            world_->advance(++frame_, seconds);
            return;
        }
        const FwVulkanFrame frame = rig_->frames.begin();
        ASSERT_TRUE(rig_->backend.beginOutside(frame, rig_->view));
        world_->advance(frame.frameIndex, seconds);
        rig_->backend.endOutside();
        rig_->frames.submit();
    }
    void run(uint32_t from, uint32_t to) {
        for (uint32_t i = from; i < to; ++i) {
            act(i);
            step(1 / 20.0f);
            poll();
        }
    }
    // Events that the host received, without their frame.
    void poll() {
        FwEvent events[16];
        while (const uint32_t count = world_->queries().pollEvents(events))
            for (const FwEvent& event : std::span(events, count))
                heard.push_back({event.type, event.tag, event.object.index1, event.value});
    }
    // Of the world after the next frame, whose deltaTime is 0.
    Bytes save() {
        world_->persistence().requestSave();
        for (int i = 0; i < 8; ++i) step(0);
        const Bytes* bytes = world_->persistence().fetchSave();
        EXPECT_TRUE(bytes);
        return bytes ? *bytes : Bytes();
    }
    uint64_t hash() {
        for (const FwBurnableMeshId id : ids_) world_->queries().requestBurnMap(id);
        for (int i = 0; i < 8; ++i) step(0);
        uint64_t hash = core::kFnvOffset;
        for (const FwBurnableMeshId id : ids_) {
            const world::BurnMapCopy* map = world_->queries().fetchBurnMap(id);
            EXPECT_TRUE(map);
            if (!map) return 0;
            hash = core::hashWords(map->ticks, hash);
            for (const gpu::uvec2& texel : map->heat) {
                const uint32_t words[2] = {texel.x, texel.y};
                hash = core::hashWords(words, hash);
            }
            FwObjectState state{};
            world_->queries().objectState(id, state);
            const uint32_t words[] = {state.ignited, state.burning};
            hash = core::hashWords(words, hash);
            burnt_ += state.ignited;
        }
        return hash;
    }
    void load(const Bytes& bytes) { world_->persistence().load(bytes); }
    [[nodiscard]] uint64_t burnt() const { return burnt_; }
    world::World& world() { return *world_; }
    struct Heard {
        uint32_t type, tag, object;
        float value;
        bool operator==(const Heard&) const = default;
    };
    std::vector<Heard> heard;

 private:
    void act(uint32_t frame) {
        FwIgnitionDef ball{};
        if (frame == 1 || frame == 70) {
            ball.position[0] = frame == 1 ? 0.3f : 0.9f;
            ball.position[2] = 0.3f;
            ball.radius = 0.4f;
            ball.delay = frame == 70 ? 0.4f : 0.0f;
            world_->burn().ignite(ball);
        }
        if (frame == 50) {
            ball.kind = FW_WET;
            ball.water = 60;
            ball.position[0] = 0.2f;
            ball.radius = 0.3f;
            world_->burn().ignite(ball);
        }
        if (frame % 20 == 9) {
            const float wind[3] = {2 * std::cos(float(frame)), 0, 2 * std::sin(float(frame))};
            world_->wind().set(wind);
        }
    }

    core::Log log_{FwCallbacks{}};
    std::unique_ptr<VkRig> rig_;
    std::unique_ptr<gpu::cpu::CpuBackend> cpu_;
    std::unique_ptr<world::World> world_;
    std::vector<FwBurnableMeshId> ids_;
    uint64_t frame_ = 0, burnt_ = 0;
};

class SaveEquality : public GpuTest {};

TEST_F(SaveEquality, BothBackendsContinueFromEither) {
    if (!device_) return;
    AWorld device(device_.get()), cpu(nullptr);
    uint32_t at = 0;
    for (const uint32_t moment : {30u, 72u}) {
        device.run(at, moment);
        cpu.run(at, moment);
        const Bytes ofDevice = device.save(), ofCpu = cpu.save();
        const uint64_t then = cpu.hash();
        EXPECT_EQ(then, device.hash());
        const uint32_t end = moment + 45;
        AWorld plain(nullptr);  // never saved
        plain.run(0, end);
        const uint64_t later = plain.hash();
        EXPECT_GT(plain.burnt(), 1000u);
        EXPECT_NE(then, later);
        for (const Bytes* bytes : {&ofDevice, &ofCpu})
            for (TestDevice* on : {device_.get(), static_cast<TestDevice*>(nullptr)}) {
                AWorld other(on);
                other.load(*bytes);
                EXPECT_EQ(then, other.hash()) << moment << (on ? " device" : " cpu");
                EXPECT_EQ(*bytes, other.save()) << moment << (on ? " device" : " cpu");
                other.run(moment, end);
                EXPECT_EQ(later, other.hash()) << moment << (on ? " device" : " cpu");
            }
        at = moment;
    }
}

// Frames continue while a save is pending: it holds the requested frame. A load happens with frames
// in flight, whose readbacks belong to another past.
TEST_F(SaveEquality, HoldsTheRequestedFrame) {
    if (!device_) return;
    AWorld device(device_.get()), plain(nullptr);
    device.run(0, 40);
    device.world().persistence().requestSave();
    const std::vector<AWorld::Heard> past =
        device.heard;  // without the last frames before the save
    device.run(40, 60);
    const Bytes* bytes = device.world().persistence().fetchSave();
    ASSERT_TRUE(bytes);
    const Bytes kept = *bytes;
    plain.run(0, 41);
    const uint64_t then = plain.hash();
    plain.run(41, 80);
    const uint64_t later = plain.hash();
    device.run(60, 80);
    for (int i = 0; i < 8; ++i) device.step(0);  // flushes pending readbacks
    device.poll();
    const std::vector<AWorld::Heard> all = device.heard;
    device.load(kept);
    device.heard = past;
    EXPECT_EQ(then, device.hash());
    device.run(41, 80);
    EXPECT_EQ(later, device.hash());
    for (int i = 0; i < 8; ++i) device.step(0);
    device.poll();
    EXPECT_LT(past.size() + 3, all.size());
    EXPECT_EQ(all, device.heard);  // each of them once
}

// A timeline on the host's own frames: its keyframes arrive while other frames are in flight.
TEST_F(SaveEquality, SeeksAnyTickOfItsTimeline) {
    if (!device_) return;
    AWorld device(device_.get()), plain(nullptr);
    FwTimelineDef def = fwDefaultTimelineDef();
    def.interval = 0.5f;
    device.world().persistence().startTimeline(def);
    struct Expected {
        uint64_t tick, hash;
    };
    std::vector<Expected> expected;
    uint32_t at = 0;
    for (const uint32_t next : {13u, 34u, 55u, 66u}) {
        device.run(at, next);
        plain.run(at, next);
        expected.push_back({plain.world().tick(), plain.hash()});
        ASSERT_EQ(expected.back().tick, device.world().tick());
        at = next;
    }
    for (const size_t wanted : {2u, 0u, 3u, 1u}) {
        float seconds = 0;
        for (int i = 0; i < 400; ++i) {
            ASSERT_TRUE(device.world().persistence().seek(expected[wanted].tick, seconds));
            if (seconds == 0) break;
            device.step(std::min(seconds, 0.1f));
        }
        EXPECT_EQ(expected[wanted].tick, device.world().tick());
        EXPECT_EQ(expected[wanted].hash, device.hash()) << wanted;
    }
}

}  // namespace
}  // namespace fw::test
