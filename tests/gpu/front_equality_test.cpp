// The device against the cpu backend, bit for bit: random fires, extinguishing, drying and wind on
// many meshes at once, under validation and synchronization validation.
#include "gpu/cpu/cpu_backend.h"
#include "support/burn_scene.h"
#include "support/sanitized.h"

#include "flamewright/flamewright_debug.h"

namespace fw::test {
namespace {

class FrontEquality : public GpuTest {
 protected:
    struct Outcome {
        bool equal = true;
        uint32_t step = 0, object = 0, texel = 0;
        uint64_t ignitions = 0, lost = 0;  // fuel units
        uint32_t compared = 0, runTiles = 0;
    };

    // An object's energy account equals the loss of its texels.
    static uint64_t checkBook(const BurnScene& scene, const gpu::cpu::CpuBackend& cpu,
                              uint32_t object) {
        const SceneObject& what = scene.objects[object];
        const mesh::BurnDomain& domain = scene.domains[what.mesh];
        uint64_t energy = 0, units = 0;
        for (uint32_t i = 0; i < cpu.heat(object).size(); ++i) {
            if (!domain.real(i)) continue;
            const uint64_t gone = gpu::kFuelFull - gpu::unpackHeat(cpu.heat(object)[i]).fuel;
            energy += gone * what.heat[domain.texels[i].materialFlags & 7].energy;
            units += gone;
        }
        const gpu::ObjectCounters& counters = cpu.counters(object);
        EXPECT_EQ(energy, uint64_t(counters.energyHigh) << 32 | counters.energyLow) << object;
        return units;
    }

    // Runs the same plans on both; the device may get other switches.
    Outcome compare(const BurnScene& scene, uint32_t steps, uint32_t stepsPerFrame,
                    uint32_t mapEvery, uint32_t seed, uint32_t vkSwitches = 0) {
        Outcome outcome;
        VkRig rig(*device_);
        gpu::cpu::CpuBackend cpu(std::pmr::get_default_resource(), 16);
        scene.create(rig.backend);
        scene.create(cpu);
        PlanMaker maker(scene, seed);
        std::vector<FrameAnswer> expected;
        size_t at = 0;
        const auto check = [&](const std::vector<FrameAnswer>& got) {
            for (const FrameAnswer& answer : got) {
                if (answer.frameIndex == 0) continue;
                while (at < expected.size() && expected[at].frameIndex < answer.frameIndex) ++at;
                if (at == expected.size()) {
                    ADD_FAILURE() << "an unexpected answer of frame " << answer.frameIndex;
                    return;
                }
                const FrameAnswer& want = expected[at];
                ASSERT_EQ(want.frameIndex, answer.frameIndex);
                compareAnswer(want, answer, outcome);
                outcome.runTiles += answer.runTiles;
            }
        };
        const uint32_t frames = steps / stepsPerFrame;
        for (uint32_t f = 0; f < frames && outcome.equal; ++f) {
            OwnedPlan plan = maker.next(stepsPerFrame, f % mapEvery == mapEvery - 1);
            cpu.run(plan.plan);
            while (const gpu::Readback* readback = cpu.nextReadback())
                expected.push_back(copyAnswer(*readback));
            plan.plan.switches |= vkSwitches;
            rig.run(plan.plan);
            check(rig.applyAnswers());
        }
        check(rig.finish());
        for (uint32_t o = 0; o < scene.objects.size(); ++o)
            outcome.ignitions += cpu.counters(o).ignited;
        for (uint32_t o = 0; o < scene.objects.size(); ++o)
            outcome.lost += checkBook(scene, cpu, o);
        return outcome;
    }

    static void compareAnswer(const FrameAnswer& want, const FrameAnswer& got, Outcome& outcome) {
        if (!outcome.equal) return;
        const auto differ = [&](uint32_t object, uint32_t texel) {
            outcome.equal = false;
            outcome.step = uint32_t(want.frameIndex);
            outcome.object = object;
            outcome.texel = texel;
        };
        for (size_t o = 0; o < want.maps.size(); ++o) {
            for (size_t i = 0; i < want.maps[o].size(); ++i) {
                if (want.maps[o][i] != got.maps[o][i]) return differ(uint32_t(o), uint32_t(i));
            }
            for (size_t i = 0; i < want.heat[o].size(); ++i) {
                if (want.heat[o][i] != got.heat[o][i]) return differ(uint32_t(o), uint32_t(i));
            }
            ++outcome.compared;
        }
        for (size_t i = 0; i < want.answers.size(); ++i) {
            const gpu::ProbeAnswer &a = want.answers[i], &b = got.answers[i];
            if (a.state != b.state || a.heatX != b.heatX || a.heatY != b.heatY || a.heat != b.heat)
                return differ(0xFFFFFFFFu, uint32_t(i));
        }
        if (want.hotTiles != got.hotTiles) return differ(0xFFFFFFFEu, got.hotTiles);
        for (size_t o = 0; o < want.counters.size(); ++o) {
            const gpu::ObjectCounters &a = want.counters[o], &b = got.counters[o];
            if (a.ignited != b.ignited) return differ(uint32_t(o), 0xFFFFFFFEu);
            if (a.energyLow != b.energyLow || a.energyHigh != b.energyHigh)
                return differ(uint32_t(o), 0xFFFFFFFDu);
        }
    }
};

std::string text(uint32_t frame, uint32_t object, uint32_t texel) {
    return "frame " + std::to_string(frame) + ", object " + std::to_string(object) + ", texel " +
           std::to_string(texel);
}

TEST_F(FrontEquality, TenThousandStepsAreEqual) {
    if (!device_) return;
    const BurnScene scene = BurnScene::make(11, 0.6);
    ASSERT_GE(scene.domains.size(), 5u);
    const uint32_t steps = rounds(10000u, 2400u);
    const Outcome outcome = compare(scene, steps, 8, 10, 1);
    EXPECT_TRUE(outcome.equal) << text(outcome.step, outcome.object, outcome.texel);
    EXPECT_GT(outcome.compared, steps / 20);
    EXPECT_GT(outcome.ignitions, 1000u);
    std::printf("%zu objects, %u steps, %u maps compared, %u tiles run\n", scene.objects.size(),
                steps, outcome.compared, outcome.runTiles);
}

TEST_F(FrontEquality, OneStepPerFrameIsEqual) {
    if (!device_) return;
    const BurnScene scene = BurnScene::make(12);
    const Outcome outcome = compare(scene, 300, 1, 3, 2);
    EXPECT_TRUE(outcome.equal) << text(outcome.step, outcome.object, outcome.texel);
}

TEST_F(FrontEquality, DenseEqualsSparse) {
    if (!device_) return;
    const BurnScene scene = BurnScene::make(13, 0.6);
    const Outcome outcome = compare(scene, 320, 4, 10, 3, FW_DEBUG_DENSE);
    EXPECT_TRUE(outcome.equal) << text(outcome.step, outcome.object, outcome.texel);
}

TEST_F(FrontEquality, HeatAndWaterAreEqual) {
    if (!device_) return;
    BurnScene scene = BurnScene::make(16, 0.5);
    scene.addHeat();
    const uint32_t steps = rounds(4000u, 1600u);
    const Outcome outcome = compare(scene, steps, 8, 5, 6);
    EXPECT_TRUE(outcome.equal) << text(outcome.step, outcome.object, outcome.texel);
    EXPECT_GT(outcome.ignitions, 1000u);
    EXPECT_GT(outcome.lost, uint64_t(1000) * gpu::kFuelFull);
    std::printf("heat of %zu objects, %u steps, %u maps compared, %u tiles run\n",
                scene.objects.size(), steps, outcome.compared, outcome.runTiles);
}

// The reference kernel uses floats and must still be equal.
TEST_F(FrontEquality, ReferenceKernelIsEqual) {
    if (!device_) return;
    BurnScene scene = BurnScene::make(15, 0.6);
    for (size_t i = 0; i < scene.objects.size(); ++i) {
        SceneObject& object = scene.objects[i];
        if (i % 4 == 3) continue;  // includes an object of the product front
        object.flags |= gpu::kObjectExtended;
        const auto& slowness = scene.domains[object.mesh].slowness;
        object.slowness.assign(slowness.begin(), slowness.end());
        for (uint16_t& value : object.slowness) value = uint16_t((value + 15) / (i % 2 ? 16 : 64));
    }
    const uint32_t steps = rounds(1600u, 800u);
    const Outcome outcome = compare(scene, steps, 4, 4, 5);
    EXPECT_TRUE(outcome.equal) << text(outcome.step, outcome.object, outcome.texel);
    EXPECT_GT(outcome.ignitions, steps / 4 * scene.objects.size());
    std::printf("%zu objects, %u steps, %u maps compared, %llu ignitions\n", scene.objects.size(),
                steps, outcome.compared, (unsigned long long)outcome.ignitions);
}

TEST_F(FrontEquality, EqualityTestCatchesMutants) {
    if (!device_) return;
    const BurnScene scene = BurnScene::make(14);
    for (const uint32_t mutant :
         {FW_DEBUG_NO_SEAM_WAKE, FW_DEBUG_WRONG_DEPENDENTS, FW_DEBUG_NO_WIND_WAKE}) {
        const Outcome outcome = compare(scene, 1600, 4, 4, 4, uint32_t(mutant));
        EXPECT_FALSE(outcome.equal) << "switch " << mutant << " goes unnoticed";
        std::printf("mutant %u: noticed in frame %u\n", uint32_t(mutant), outcome.step);
    }
}

}  // namespace
}  // namespace fw::test
