// The refinement pass of the reference implementation on a device against the library: vertices of
// its triangles, consumed triangles, vertex positions.
#include "reference/pattern_frame.h"
#include "support/pass_rig.h"
#include "support/refine_scene.h"

namespace fw::test::refine_reference_test {
namespace {

constexpr uint32_t kBindings[] = {FW_BIND_PREDICT,          FW_BIND_GRADIENT,
                                  FW_BIND_EXTENSION_GROUPS, FW_BIND_EXTENSION_WORDS,
                                  FW_BIND_REFINE_OBJECTS,   FW_BIND_REFINE_TRIANGLES,
                                  FW_BIND_REFINE_SLOTS,     FW_BIND_REFINE_VERTICES,
                                  FW_BIND_REFINE_INDICES,   FW_BIND_VERTICES};
constexpr float kRecede = 0.6f;

class RefinePublishedEquality : public GpuTest {
 protected:
    static gpu::RefineVertex placeOf(const RefineScene& scene, const gpu::RefineSlot& slot,
                                     float now, uint32_t tick) {
        const auto arrival = [&](uint32_t base, uint32_t weights) {
            const uint32_t* t = &scene.ticks[base];
            const uint32_t* up = t + scene.model.textureWidth;
            return gpu::refineArrival({t[0], t[1], up[0], up[1]}, weights, tick, kStartTick);
        };
        const float own = arrival(slot.texel & 0xFFFFFFu, slot.weights);
        const float opposite =
            slot.opposite == gpu::kRefineOpposed
                ? gpu::kRefineNever
                : arrival(slot.opposite & 0xFFFFFFu, gpu::refineOppositeWeights(slot.opposite));
        const glm::vec4 v = gpu::evaluateSlot(slot, own, opposite, now, kBurnSeconds, kRecede);
        return {v.x, v.y, v.z, v.w};
    }
};

TEST_F(RefinePublishedEquality, TrianglesAndPositionsEqualTheLibrarys) {
    if (!device_) return;
    auto* memory = std::pmr::new_delete_resource();
    const uint32_t depth = 4;
    RefineScene scene(gridBox(0.8, 0.6, 0.02, 1, 1, 1, 11), reference::patternOptions(depth), 96);
    scene.light({0.2, 0.2, 0.02}, 0.05, 0.15);
    const mesh::RefineModel& m = scene.model;
    const reference::PatternModel pattern =
        reference::makePatternModel(scene.domain, m, depth, memory);
    const reference::PatternSettings settings = reference::patternSettings(pattern, 0, 0, 0.05f);
    reference::PatternState state(memory);
    state.reset(pattern);
    reference::ignitePattern(pattern, settings, {0.2f, 0.2f, 0.02f}, kStartTick, state);

    PassRig rig(*device_, kBindings, sizeof(gpu::PatternPush));
    const auto make = [&](uint32_t binding, const auto& data) {
        rig.make(binding, data.size() * sizeof data[0], data.data());
    };
    make(FW_BIND_REFINE_TRIANGLES, m.triangles);
    make(FW_BIND_REFINE_SLOTS, m.slots);
    make(FW_BIND_PREDICT, scene.ticks);
    rig.make(FW_BIND_GRADIENT, scene.ticks.size() * 4);
    std::vector<mesh::RenderVertex> vertices(m.draws.size());
    for (uint32_t d = 0; d < m.draws.size(); ++d) vertices[d].material = m.draws[d].slot;
    make(FW_BIND_VERTICES, vertices);
    const auto slots = uint32_t(m.slots.size());
    const uint32_t placeGroups = (slots + 63) / 64, nameGroups = (pattern.most() + 63) / 64;
    rig.make(FW_BIND_REFINE_VERTICES, slots * sizeof(gpu::RefineVertex));
    rig.make(FW_BIND_EXTENSION_WORDS, size_t(nameGroups) * 256);
    rig.make(FW_BIND_REFINE_INDICES, size_t(nameGroups) * 768);
    rig.make(FW_BIND_REFINE_OBJECTS, sizeof(gpu::RefineObject));
    std::vector<gpu::uvec2> groups;
    for (uint32_t g = 0; g < placeGroups; ++g) groups.push_back({0, g * 64});
    for (uint32_t g = 0; g < nameGroups; ++g) groups.push_back({0, g * 64});
    make(FW_BIND_EXTENSION_GROUPS, groups);
    const uint32_t pass = rig.add("refine_pattern.comp");

    uint32_t consumed = 0, coarser = 0, frames = 0;
    double worst = 0;
    for (float now = 0; now < scene.end + 6; now += 0.9f, ++frames) {
        const uint32_t tick = kStartTick + uint32_t(now * 4096);
        const reference::PatternView view{{0.2f, 0.2f, 1.5f}, frames % 3 == 2 ? 150.0f : 0.0f};
        reference::advancePattern(pattern, settings, tick, view, false, state);
        gpu::RefineObject object{};
        object.cornerCount = slots;
        object.textureWidth = m.textureWidth;
        object.epochTick = kStartTick;
        object.now = now;
        object.burnSeconds0 = gpu::vec4(kBurnSeconds);
        rig.of<gpu::RefineObject>(FW_BIND_REFINE_OBJECTS)[0] = object;
        const auto list = rig.of<uint32_t>(FW_BIND_EXTENSION_WORDS);
        std::fill(list.begin(), list.end(), gpu::kPatternEmpty);
        std::copy(state.list.begin(), state.list.end(), list.begin());
        device_->run([&](VkCommandBuffer commands) {
            rig.begin(commands);
            gpu::PatternPush push{0, tick, 0, kRecede};
            rig.dispatch(commands, pass, &push, placeGroups);
            push = {1, tick, placeGroups, kRecede};
            rig.dispatch(commands, pass, &push, nameGroups);
        });
        const auto places = rig.of<gpu::RefineVertex>(FW_BIND_REFINE_VERTICES);
        for (uint32_t s = 0; s < slots; ++s) {
            const gpu::RefineVertex v = placeOf(scene, m.slots[s], now, tick);
            worst = std::max({worst, double(std::abs(v.x - places[s].x)),
                              double(std::abs(v.y - places[s].y)),
                              double(std::abs(v.z - places[s].z))});
            ASSERT_NEAR(v.hole, places[s].hole, 1e-3) << "slot " << s;
        }
        const auto indices = rig.of<uint32_t>(FW_BIND_REFINE_INDICES);
        for (size_t i = 0; i < state.list.size(); ++i) {
            const uint32_t word = state.list[i];
            const bool finest = gpu::patternHalvings(word) == depth;
            uint32_t drawn[6] = {}, gone = 0;
            for (uint32_t k = 0; k < (finest ? 3u : 6u); ++k) {
                const gpu::uvec2 c = gpu::patternPoint(word, depth, k);
                drawn[k] = gpu::patternDrawVertex(m.triangles[gpu::patternCoarse(word)], c.x, c.y);
                gone |= (places[m.draws[drawn[k]].slot].hole <= now ? 1u : 0u) << k;
            }
            const bool hidden = gpu::isPatternConsumed(gone, finest);
            consumed += hidden;
            coarser += hidden && !finest;
            for (uint32_t k = 0; k < 3; ++k)
                ASSERT_EQ(hidden ? drawn[0] : drawn[k], indices[i * 3 + k]) << "triangle " << i;
        }
    }
    EXPECT_LT(worst, 1e-5) << "m";
    EXPECT_GT(consumed, 100u);
    EXPECT_GT(coarser, 0u);
    std::printf(
        "published: %u frames equal, %u times a triangle was consumed, places within %.1e m\n",
        frames, consumed, worst);
}

}  // namespace
}  // namespace fw::test::refine_reference_test
