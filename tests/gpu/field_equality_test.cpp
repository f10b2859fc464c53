// Particle fields on a device equal the library's step cell by cell: presets, sizes, walls, paint,
// rings, many fields in one dispatch.
#include "gpu/passes/field_units.h"
#include "reference/field_scene.h"
#include "support/pass_rig.h"
#include "support/sanitized.h"

#include <random>

namespace fw::test::field_equality_test {
namespace {

using field::Field;
using gpu::FieldCounters;
using gpu::FieldPush;
using gpu::FieldRecord;
using gpu::FieldRules;
using gpu::uvec2;

constexpr uint32_t kBindings[] = {FW_BIND_FIELDS, FW_BIND_FIELD_CELLS, FW_BIND_FIELD_MASKS,
                                  FW_BIND_FIELD_COUNTERS, FW_BIND_FIELD_RUNS};
constexpr uint32_t kTexels[] = {FW_BIND_FIELD_CELLS};

struct Pair {  // the library's field and its place on the device
    Field field{std::pmr::get_default_resource()};
    FieldRules rules{};
    std::vector<uint8_t> masks;
    uint32_t base = 0, room = 0;
};

class FieldComparison : public GpuTest {
 protected:
    Pair make(uint32_t preset, uint32_t width, uint32_t height, uint32_t open, bool walls,
              bool painted) {
        Pair made;
        field::FieldDef def;
        def.width = width;
        def.height = height;
        def.appearance = field::fieldPreset(field::FieldPreset(preset));
        def.open = open;
        def.wind = {0.2f * float(preset), 0};
        def.seed = 5 + preset;
        made.rules = field::fieldRules(def);
        field::addDefaultSource(made.rules, def.appearance);
        made.rules.sources[1] = made.rules.sources[0];  // and a disc
        made.rules.sources[1].disc = 1;
        made.rules.sources[1].cells = {int(width / 3), int(height / 2), int(width / 3) + 7,
                                       int(height / 2) + 7};
        made.rules.sourceCount = 2;
        made.rules.paint = painted ? 700 : 0;
        made.masks.resize(size_t(width) * height);
        std::mt19937 random(preset);
        for (uint8_t& mask : made.masks) {
            if (painted && random() % 90 == 0) mask = uint8_t(random() % 255);
            if (walls && random() % 9 == 0) mask = gpu::kFieldWall;
        }
        field::startField(made.field, width, height);
        field::maskField(made.field, made.masks);
        return made;
    }

    void upload(std::vector<Pair>& pairs, bool byTexels) {
        rig_ = std::make_unique<PassRig>(*device_, kBindings, uint32_t(sizeof(FieldPush)), kTexels);
        uint32_t cells = 0;
        for (Pair& pair : pairs) {
            pair.base = cells;
            pair.room = uint32_t(pair.masks.size() + 63) / 64 * 64;
            cells += pair.room;
        }
        rig_->make(FW_BIND_FIELDS, pairs.size() * sizeof(FieldRecord));
        rig_->make(FW_BIND_FIELD_CELLS, size_t(cells) * 8);
        rig_->make(FW_BIND_FIELD_MASKS, cells);
        rig_->make(FW_BIND_FIELD_COUNTERS, pairs.size() * sizeof(FieldCounters));
        rig_->make(FW_BIND_FIELD_RUNS, pairs.size() * gpu::kFieldUnits * sizeof(uvec2));
        step_ = rig_->add(byTexels ? "field_texels.comp" : "field.comp");
        mask_ = rig_->add("field_mask.comp");
        std::fill_n(rig_->of<uint32_t>(FW_BIND_FIELD_CELLS).data(), cells * 2, 0xABCDEF01u);
        send(pairs);
        dispatch(mask_, pairs, gpu::kFieldFresh);
    }
    void send(const std::vector<Pair>& pairs) {
        for (size_t i = 0; i < pairs.size(); ++i) {
            rig_->of<FieldRecord>(FW_BIND_FIELDS)[i] = {pairs[i].rules,
                                                        gpu::fieldWeights(pairs[i].rules),
                                                        0,
                                                        pairs[i].base,
                                                        pairs[i].room,
                                                        0,
                                                        0};
            std::copy(pairs[i].masks.begin(), pairs[i].masks.end(),
                      &rig_->of<uint8_t>(FW_BIND_FIELD_MASKS)[pairs[i].base]);
        }
    }
    void dispatch(uint32_t pass, const std::vector<Pair>& pairs, uint32_t flag) {
        std::vector<gpu::FieldRun> runs, units;
        for (uint32_t i = 0; i < pairs.size(); ++i) runs.push_back({i, pairs[i].field.step | flag});
        auto groups = uint32_t(runs.size());
        if (pass == step_)
            groups = gpu::fieldUnits(
                runs, [&](uint32_t i) { return pairs[i].field.width; },
                [&](const gpu::FieldRun& unit) { units.push_back(unit); });
        else
            units = runs;
        std::copy(units.begin(), units.end(), rig_->of<gpu::FieldRun>(FW_BIND_FIELD_RUNS).begin());
        const FieldPush push{};
        device_->run([&](VkCommandBuffer commands) {
            rig_->begin(commands);
            rig_->dispatch(commands, pass, &push, groups);
        });
    }
    void step(std::vector<Pair>& pairs) {
        dispatch(step_, pairs, 0);
        for (Pair& pair : pairs) field::stepField(pair.field, pair.rules);
    }
    void expectEqual(const std::vector<Pair>& pairs) {
        for (size_t i = 0; i < pairs.size(); ++i) {
            const Pair& pair = pairs[i];
            const auto cells = rig_->of<uint32_t>(FW_BIND_FIELD_CELLS)
                                   .subspan(2 * pair.base + (pair.field.step & 1) * pair.room);
            for (size_t c = 0; c < pair.masks.size(); ++c)
                ASSERT_EQ(cells[c], pair.field.cells[c])
                    << "field " << i << " cell " << c << " after " << pair.field.step << " steps";
            const FieldCounters& now = rig_->of<FieldCounters>(FW_BIND_FIELD_COUNTERS)[i];
            const auto whole = [](uint32_t low, uint32_t high) {
                return uint64_t(high) << 32 | low;
            };
            EXPECT_EQ(now.inside, field::total(pair.field));
            EXPECT_EQ(whole(now.emittedLow, now.emittedHigh), pair.field.emitted);
            EXPECT_EQ(whole(now.diedLow, now.diedHigh), pair.field.died);
            EXPECT_EQ(whole(now.leftLow, now.leftHigh), pair.field.left);
            EXPECT_EQ(now.steps, pair.field.step);
        }
    }

    void TearDown() override {
        rig_.reset();
        GpuTest::TearDown();
    }
    std::unique_ptr<PassRig> rig_;
    uint32_t step_ = 0, mask_ = 0;
};

class FieldEquality : public FieldComparison, public ::testing::WithParamInterface<bool> {};

TEST_P(FieldEquality, EveryCellEqualsTheLibrary) {
    if (!device_) return;
    std::vector<Pair> pairs;
    for (uint32_t preset = 0; preset < field::kFieldPresets; ++preset) {
        pairs.push_back(make(preset, 64, 64, gpu::kFieldOpenTop, false, false));
        pairs.push_back(make(preset, 36, 47, 15, true, true));
        pairs.push_back(make(preset, 32, 40, gpu::kFieldRing, true, preset == 1));
    }
    pairs.push_back(make(1, 256, 32, gpu::kFieldOpenLeft, true, false));
    upload(pairs, GetParam());
    expectEqual(pairs);
    const uint32_t steps = rounds(300u, 20u);
    for (uint32_t s = 0; s < steps; ++s) {
        if (s % 50 == 30) {  // changed winds and walls, a source that stops
            for (Pair& pair : pairs) {
                pair.rules.forceX = int(s % 3) * 90 - 90;
                pair.rules.sourceCount = s % 100 == 30 ? 0 : 2;
                std::rotate(pair.masks.begin(), pair.masks.begin() + 5, pair.masks.end());
                field::maskField(pair.field, pair.masks);
            }
            send(pairs);
            dispatch(mask_, pairs, 0);
        }
        step(pairs);
        if (s % 10 == 0) expectEqual(pairs);
        if (HasFatalFailure()) return;
    }
    expectEqual(pairs);
}

INSTANTIATE_TEST_SUITE_P(Words, FieldEquality, ::testing::Values(false));
INSTANTIATE_TEST_SUITE_P(Texels, FieldEquality, ::testing::Values(true));

}  // namespace
}  // namespace fw::test::field_equality_test
