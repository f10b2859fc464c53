// Parts of the world: clock, event queue, poses, and plans as a backend receives them.
#include "world/world.h"
#include "components/pose.h"
#include "fire/presets.h"
#include "world/clock.h"
#include "world/event_queue.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <deque>

namespace {

using namespace fw;

TEST(Clock, SplitsTimeWithoutDrift) {
    for (const float dt : {1.0f / 120, 1.0f / 60, 1.0f / 7, 0.0013f, 0.37f}) {
        world::Clock clock;
        const int frames = 20000;
        for (int i = 0; i < frames; ++i) clock = world::advance(clock, dt, 64).after;
        const double total = double(dt) * frames;
        EXPECT_NEAR(total, double(clock.tick) / 4096 + double(clock.fraction) / std::pow(2.0, 44),
                    1e-7 * total)
            << dt;
        EXPECT_EQ(0u, clock.tick % gpu::kStepTicks);
    }
}

TEST(Clock, DropsExcessTimeAndKeepsTheFraction) {
    world::Clock clock;
    const world::ClockAdvance step = world::advance(clock, 1.0f + 1.0f / 64, 8);
    EXPECT_EQ(8u, step.steps);
    EXPECT_EQ(24u, step.dropped);
    EXPECT_EQ(8u * 128, step.after.tick);
    EXPECT_EQ(world::Clock::kStepUnits / 2, step.after.fraction);
    EXPECT_EQ(8u * 128 + 64, step.after.hostTick());
}

TEST(Clock, StopsBeforeTheReservedTicks) {
    world::Clock clock;
    clock.tick = world::Clock::kLastTick - 256;
    clock = world::advance(clock, 10, 64).after;
    EXPECT_EQ(world::Clock::kLastTick, clock.tick);
    EXPECT_EQ(0u, world::advance(clock, 10, 64).steps);
    EXPECT_LT(world::Clock::kLastTick + 8192, uint64_t(gpu::kLiveEnd));
}

TEST(EventQueue, KeepsTheNewestInOrder) {
    world::EventQueue queue(std::pmr::new_delete_resource());
    FwEvent event{};
    for (uint32_t i = 0; i < world::EventQueue::kCapacity + 10; ++i) {
        event.tag = i;
        queue.push(event);
    }
    EXPECT_EQ(10u, queue.takeDropped());
    EXPECT_EQ(0u, queue.takeDropped());
    std::vector<FwEvent> out(100);
    uint32_t next = 10;
    while (const uint32_t count = queue.poll(out))
        for (uint32_t i = 0; i < count; ++i) EXPECT_EQ(next++, out[i].tag);
    EXPECT_EQ(world::EventQueue::kCapacity + 10, next);
    // Polled events stay readable until others replace them.
    EXPECT_EQ(queue.end(), queue.next());
    EXPECT_EQ(10u, queue.oldest());
    EXPECT_EQ(10u, queue.at(10).tag);
    queue.push(event);
    queue.clear();
    EXPECT_EQ(0u, queue.poll(out));
    EXPECT_EQ(11u, queue.oldest());
    queue.push(event);
    EXPECT_EQ(1u, queue.poll(out));
}

TEST(Pose, TransformsThereAndBack) {
    const float c = std::cos(0.7f) * 2, s = std::sin(0.7f) * 2;
    const float matrix[16] = {c, 0, -s, 0, 0, 2, 0, 0, s, 0, c, 0, 5, -3, 1, 1};
    const components::Pose pose = components::makePose(matrix, "m");
    EXPECT_NEAR(2.0f, pose.scale, 1e-6f);
    const float point[3] = {0.3f, -0.2f, 0.9f};
    float world[3], back[3];
    components::toWorld(pose, point, world);
    EXPECT_NEAR(c * 0.3f + s * 0.9f + 5, world[0], 1e-5f);
    EXPECT_NEAR(-3.4f, world[1], 1e-5f);
    components::toObject(pose, world, back);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(point[i], back[i], 1e-5f);
}

// Records its input. Answers when the test says so, frames later, like a device.
class Recorder final : public gpu::Backend {
 public:
    void restore(std::span<const gpu::RestoredObject>, uint32_t) override {}
    struct Frame {
        uint64_t index = 0;
        std::vector<gpu::StepPlan> steps;
        std::vector<std::vector<gpu::TexelEvent>> events;
        std::vector<std::vector<gpu::MaterialUpdate>> updates;
        std::vector<gpu::Probe> probes;
        std::vector<uint32_t> maps;
        uint32_t endTick = 0;
    };
    struct Answer {
        gpu::Readback readback;
        std::vector<gpu::ObjectCounters> counters;
        std::vector<gpu::ProbeAnswer> answers;
    };
    std::vector<Frame> frames;
    std::deque<Answer> ready;
    bool fail = false;
    int images = 0, meshes = 0, objects = 0;

    // Answers frame `index` with these counters of object slot 0.
    void answer(size_t frame, gpu::ObjectCounters counters, uint32_t front, uint32_t burning,
                uint32_t code = gpu::kNever) {
        Answer made;
        made.counters = {counters};
        made.answers.assign(frames[frame].probes.size(), gpu::ProbeAnswer{code, 0, 0, 0});
        made.readback.frameIndex = frames[frame].index;
        made.readback.endTick = frames[frame].endTick;
        made.readback.frontTiles = front;
        made.readback.burningTiles = burning;
        ready.push_back(std::move(made));
    }

    void createMesh(uint32_t, const mesh::BurnDomain&) override { ++meshes; }
    void destroyMesh(uint32_t) noexcept override { --meshes; }
    void createObject(uint32_t, const gpu::ObjectInit& init) override {
        last = init.record;
        ++objects;
    }
    void destroyObject(uint32_t) noexcept override { --objects; }
    void setVertices(uint32_t, std::span<const float>, std::span<const float>) noexcept override {}
    void setRoom(uint32_t, const gpu::Room&) noexcept override {}
    void setObjectPose(uint32_t, const gpu::vec4*, const gpu::vec4&, uint32_t flags) override {
        lastFlags = flags;
    }
    void createImage(uint32_t, uint32_t, uint32_t, std::span<const std::byte>, float) override {
        ++images;
    }
    void destroyImage(uint32_t) noexcept override { --images; }
    void run(const gpu::FramePlan& plan) override {
        if (fail) core::fail(FW_ERROR_DEVICE_LOST, "The device is lost.");
        Frame frame;
        frame.index = plan.frameIndex;
        frame.endTick = plan.endTick;
        for (const gpu::StepPlan& step : plan.steps) {
            frame.steps.push_back(step);
            frame.events.emplace_back(step.events.begin(), step.events.end());
            frame.updates.emplace_back(step.materials.begin(), step.materials.end());
        }
        frame.probes.assign(plan.probes.begin(), plan.probes.end());
        frame.maps.assign(plan.burnMaps.begin(), plan.burnMaps.end());
        frames.push_back(std::move(frame));
    }
    const gpu::Readback* nextReadback() override {
        if (ready.empty()) return nullptr;
        current = std::move(ready.front());
        ready.pop_front();
        current.readback.objects = current.counters;
        current.readback.answers = current.answers;
        return &current.readback;
    }
    std::span<const gpu::PassTime> passTimes() override { return {}; }
    void memoryRows(std::pmr::vector<gpu::MemoryRow>&) const override {}

    Answer current;
    gpu::BurnObject last{};
    uint32_t lastFlags = 0;
};

class PlannedWorld : public ::testing::Test {
 protected:
    PlannedWorld() {
        FwWorldDef def{};
        def.structSize = sizeof def;
        def.up[1] = 1;
        def.paceFactor = 1;
        def.maxStepsPerFrame = 8;
        def.maxLights = 16;
        def.maxRefinedTriangles = 400000;
        def.volumePixelSize = 2;
        def.rayStepCount = 64;
        def.arrivalTiles = 1024;
        def.volumeOctaves = 4;
        world.emplace(def, backend, log, std::pmr::new_delete_resource());
        FwMeshDef mesh{};
        mesh.structSize = sizeof mesh;
        mesh.positions = positions;
        mesh.vertexCount = 4;
        mesh.indices = indices;
        mesh.indexCount = 6;
        mesh.indexSize = 4;
        mesh.mapSize = 256;
        mesh.texelsPerMetre = 64;
        mesh.noiseFeature = 0.01f;
        meshId = world->scene().createMesh(mesh);
        FwMaterialDef material = fire::presetDef(FW_MATERIAL_PAPER);
        object.structSize = sizeof object;
        object.mesh = meshId;
        object.materials[0] = world->scene().createMaterial(material);
        for (int i = 0; i < 4; ++i) object.transform[i * 5] = 1;
        object.tint[0] = object.tint[1] = object.tint[2] = 1;
        object.refinePixelsPerEdge = 8;
        id = world->createBurnableMesh(object);
    }
    uint32_t ignite(float x, float delay = 0, uint32_t kind = FW_IGNITE) {
        FwIgnitionDef def{};
        def.structSize = sizeof def;
        def.kind = kind;
        def.object = id;
        def.position[0] = x;
        def.position[2] = 0.125f;
        def.radius = 0.03f;
        def.delay = delay;
        return world->burn().ignite(def);
    }
    void step(float dt) { world->advance(world->lastFrame() + 1, dt); }
    std::vector<FwEvent> events() {
        std::vector<FwEvent> out(64);
        out.resize(world->queries().pollEvents(out));
        return out;
    }

    const float positions[12] = {0, 0, 0, 1, 0, 0, 1, 0, 0.25f, 0, 0, 0.25f};
    const uint32_t indices[6] = {0, 2, 1, 0, 3, 2};
    core::Log log{FwCallbacks{}};
    Recorder backend;
    std::optional<world::World> world;
    FwMeshId meshId{};
    FwBurnableMeshDef object{};
    FwBurnableMeshId id{};
};

TEST_F(PlannedWorld, EventsAreSortedIntoTheStepOfTheirTick) {
    const uint32_t late = ignite(0.2f, 0.1f);  // tick 410: step 3
    const uint32_t early = ignite(0.8f);
    const uint32_t both = ignite(0.8f, 0, FW_WET);
    step(0.25f);
    ASSERT_EQ(1u, backend.frames.size());
    const Recorder::Frame& frame = backend.frames[0];
    ASSERT_EQ(8u, frame.steps.size());
    EXPECT_EQ(early + both, frame.events[0].size());
    EXPECT_EQ(late, frame.events[3].size());
    EXPECT_EQ(0u, frame.events[1].size());
    for (size_t s = 0; s < 8; ++s) {
        EXPECT_EQ(128 * s, frame.steps[s].now);
        EXPECT_EQ(s % 4 == 3, frame.steps[s].reduce);
        for (size_t i = 1; i < frame.events[s].size(); ++i) {
            const gpu::TexelEvent &a = frame.events[s][i - 1], &b = frame.events[s][i];
            EXPECT_LE(a.texel, b.texel);
            if (a.texel == b.texel) {
                EXPECT_LE(a.kind, b.kind);  // in call order
            }
        }
    }
    EXPECT_EQ(410u, frame.events[3][0].tick);
    EXPECT_EQ(1024u, frame.endTick);
}

TEST_F(PlannedWorld, AFailedFrameChangesNothing) {
    const uint32_t texels = ignite(0.5f);
    backend.fail = true;
    EXPECT_THROW(step(0.125f), core::Error);
    EXPECT_THROW(step(0.125f), core::Error);
    backend.fail = false;
    step(0.125f);
    ASSERT_EQ(1u, backend.frames.size());
    EXPECT_EQ(1u, backend.frames[0].index);
    EXPECT_EQ(0u, backend.frames[0].steps[0].now);
    EXPECT_EQ(texels, backend.frames[0].events[0].size());
    EXPECT_THROW(world->advance(1, 0.1f), core::Error);  // the index grows
    EXPECT_THROW(world->advance(9, NAN), core::Error);
}

TEST_F(PlannedWorld, WindIsLatchedFourTimesASecondForLitObjects) {
    const float wind[3] = {3, 0, 0};
    world->wind().set(wind);
    for (int i = 0; i < 8; ++i) step(0.25f);
    for (const Recorder::Frame& frame : backend.frames)
        for (const auto& updates : frame.updates) EXPECT_TRUE(updates.empty());
    backend.frames.clear();
    ignite(0.5f);
    step(0.25f);
    // Its first event carries the current wind.
    ASSERT_EQ(1u, backend.frames[0].updates[0].size());
    EXPECT_NE(0, backend.frames[0].updates[0][0].materials[0].driveX);
    const float other[3] = {0, 0, 5};
    world->wind().set(other);
    backend.frames.clear();
    for (int i = 0; i < 16; ++i) step(0.25f);
    size_t updates = 0;
    for (const Recorder::Frame& frame : backend.frames)
        for (size_t s = 0; s < frame.updates.size(); ++s) {
            updates += frame.updates[s].size();
            if (!frame.updates[s].empty()) {
                EXPECT_EQ(0u, frame.steps[s].now % 1024);
            }
        }
    EXPECT_LE(4u, updates);
    EXPECT_GE(16u, updates);
    // Filtered: the drive turns over time.
    const auto firstUpdate = [&](size_t from) -> const gpu::MaterialUpdate& {
        for (size_t i = from; i < backend.frames.size(); ++i)
            for (const auto& u : backend.frames[i].updates)
                if (!u.empty()) return u[0];
        return backend.frames.back().updates[0].at(0);
    };
    EXPECT_LT(0, firstUpdate(0).materials[0].driveX);
    // A pose latches gravity too.
    float pose[16] = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const float calm[3] = {};
    world->wind().set(calm);
    for (int i = 0; i < 400; ++i) step(0.25f);
    backend.frames.clear();
    for (int i = 0; i < 4; ++i) step(0.25f);
    for (const Recorder::Frame& frame : backend.frames)
        for (const auto& u : frame.updates) EXPECT_TRUE(u.empty());
    world->setTransform(id, pose);
    step(0.25f);
    step(0.25f);
    EXPECT_EQ(1024, firstUpdate(4).materials[0].driveX);
}

TEST_F(PlannedWorld, LateReadbacksRaiseEventsAndEndInSleep) {
    ignite(0.5f);
    for (int i = 0; i < 3; ++i) step(1.0f / 32);
    EXPECT_TRUE(events().empty());
    gpu::ObjectCounters burning{};
    burning.ignited = 12;
    burning.burning = 12;
    burning.frontTiles = 4;
    backend.answer(0, burning, 4, 1);
    step(1.0f / 32);
    std::vector<FwEvent> heard = events();
    ASSERT_EQ(1u, heard.size());
    EXPECT_EQ(uint32_t(FW_EVENT_IGNITED), heard[0].type);
    EXPECT_EQ(1u, heard[0].frameIndex);
    EXPECT_NEAR(0.5f, heard[0].position[0], 0.05f);
    for (int i = 0; i < 40; ++i) step(1.0f / 32);
    EXPECT_EQ(1u, backend.frames.back().steps.size());
    gpu::ObjectCounters over{};
    over.ignited = 12;
    over.lastIgnition = 128;
    backend.answer(backend.frames.size() - 2, over, 0, 0);
    step(1.0f / 32);
    heard = events();
    ASSERT_EQ(1u, heard.size());
    EXPECT_EQ(uint32_t(FW_EVENT_BURNT_OUT), heard[0].type);
    step(1.0f / 32);
    EXPECT_EQ(0u, backend.frames.back().steps.size());  // asleep, while time continues
    EXPECT_EQ(backend.frames[backend.frames.size() - 2].endTick + 128,
              backend.frames.back().endTick);
    ignite(0.1f);
    step(1.0f / 32);
    EXPECT_EQ(1u, backend.frames.back().steps.size());
}

// At a transfer, readbacks may be outstanding. Only the lit object reports its ignition, also if it
// is already destroyed. The target's fire continues as its own.
TEST_F(PlannedWorld, TransferredBurnsIgniteOnceForAnyReadbackDelay) {
    for (const bool destroys : {false, true}) {
        const FwBurnableMeshId from = world->createBurnableMesh(object);
        const FwBurnableMeshId to = world->createBurnableMesh(object);
        id = from;
        ignite(0.5f);
        const size_t first = backend.frames.size();
        step(1.0f / 32);
        world->burn().transferBurn(from, to);
        step(1.0f / 32);
        step(1.0f / 32);
        gpu::ObjectCounters burning{};
        burning.ignited = burning.burning = 12;
        burning.frontTiles = 4;
        std::vector<FwEvent> heard;
        for (size_t frame = first; frame < first + 3; ++frame) {
            if (frame == first + 1 && destroys) world->destroyBurnableMesh(from);
            backend.answer(frame, {}, 4, 1);
            backend.ready.back().counters.resize(to.index1);
            backend.ready.back().counters[from.index1 - 1] = burning;
            if (frame > first) backend.ready.back().counters[to.index1 - 1] = burning;
            step(1.0f / 32);
            for (const FwEvent& event : events()) heard.push_back(event);
        }
        ASSERT_EQ(1u, heard.size()) << destroys;
        EXPECT_EQ(uint32_t(FW_EVENT_IGNITED), heard[0].type);
        EXPECT_EQ(from.index1, heard[0].object.index1);
        FwObjectState state{};
        world->queries().objectState(to, state);
        EXPECT_EQ(12u, state.burning);
        if (!destroys) world->destroyBurnableMesh(from);
        world->destroyBurnableMesh(to);
    }
}

// For commands of a log or a server: one occluder list names each object once.
TEST_F(PlannedWorld, OccluderCommandsNameEachObjectOnce) {
    world->persistence().apply(world::AddOcclusionObject{id.index1, false});
    EXPECT_THROW(world->persistence().apply(world::AddOcclusionObject{id.index1, false}),
                 core::Error);
    world->persistence().apply(world::AddOcclusionObject{0, true});
}

TEST_F(PlannedWorld, ProbesAnswerTagsAndQueriesOfTheirFrame) {
    const float point[3] = {0.7f, 0, 0.1f};
    world->queries().tagPoint(id, point, 5);
    const FwQueryId query = world->queries().requestPoint(id, point);
    step(1.0f / 32);
    step(1.0f / 32);
    ASSERT_EQ(2u, backend.frames[0].probes.size());
    ASSERT_EQ(1u, backend.frames[1].probes.size());  // only the tag: the query was asked already
    FwPointState state{};
    EXPECT_FALSE(world->queries().fetchPoint(query, state));
    // The object is lit in between; the older frame still says no.
    backend.answer(0, {}, 0, 0, gpu::kNever);
    backend.answer(1, {}, 0, 0, 64);
    step(1.0f / 32);
    ASSERT_TRUE(world->queries().fetchPoint(query, state));
    EXPECT_EQ(uint32_t(FW_POINT_UNBURNT), state.kind);
    EXPECT_EQ(1u, state.frameIndex);
    EXPECT_THROW((void)world->queries().fetchPoint(query, state), core::Error);
    const std::vector<FwEvent> heard = events();
    ASSERT_EQ(1u, heard.size());
    EXPECT_EQ(uint32_t(FW_EVENT_TAG_REACHED), heard[0].type);
    EXPECT_EQ(5u, heard[0].tag);
    EXPECT_FLOAT_EQ(64.0f / 4096, heard[0].value);
    // Once only, although another frame in flight reports it too.
    backend.answer(2, {}, 0, 0, 64);
    step(1.0f / 32);
    EXPECT_TRUE(events().empty());
    EXPECT_TRUE(backend.frames.back().probes.empty());
}

TEST_F(PlannedWorld, IgnoresReadbacksOfAnOlderObjectInTheSlot) {
    ignite(0.5f);
    step(1.0f / 32);
    world->destroyBurnableMesh(id);
    id = world->createBurnableMesh(object);
    ASSERT_EQ(1u, id.index1);
    gpu::ObjectCounters burning{};
    burning.ignited = burning.burning = 12;
    backend.answer(0, burning, 1, 1);
    ignite(0.5f);
    step(1.0f / 32);
    EXPECT_TRUE(events().empty());
    FwObjectState state{};
    world->queries().objectState(id, state);
    EXPECT_EQ(0u, state.ignited);
}

TEST_F(PlannedWorld, FreesEverything) {
    EXPECT_EQ(1, backend.objects);
    EXPECT_EQ(1, backend.meshes);
    world->scene().setHidden(id, true);
    EXPECT_NE(0u, backend.lastFlags & gpu::kObjectHidden);
    world->scene().setHidden(id, false);
    EXPECT_EQ(0u, backend.lastFlags & gpu::kObjectHidden);
    world.reset();
    EXPECT_EQ(0, backend.objects);
    EXPECT_EQ(0, backend.meshes);
    EXPECT_EQ(0, backend.images);
}

}  // namespace
