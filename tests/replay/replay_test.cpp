// Recorded input logs, played through the C ABI: after every step the maps equal the recorded ones,
// on the cpu backend and on a host Vulkan device. See README.md.
#include "core/hash.h"
#include "flamewright/flamewright_debug.h"
#include "replay/replay_log.h"
#include "support/bless.h"
#include "support/mesh_def.h"
#include "support/test_data.h"
#include "support/vulkan_device.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>

namespace fw::test::replay_test {
namespace {

constexpr float kStepSeconds = 1.0f / 32;
constexpr uint32_t kStepTicks = 128;

std::string pathOf(const std::string& name, const char* ending) {
    return testFile("replay/" + name + ending);
}

Mesh generate(const ReplayMesh& recipe) {
    const auto number = [&](size_t i, double fallback) {
        return i < recipe.numbers.size() ? recipe.numbers[i] : fallback;
    };
    const auto count = [&](size_t i, double fallback) { return int(number(i, fallback)); };
    if (recipe.generator == "plane")
        return makePlane(number(0, 1), number(1, 1), number(2, 0), number(3, 1), number(4, 0),
                         count(5, 1));
    if (recipe.generator == "cube") return makeCube(number(0, 1), count(1, 2));
    if (recipe.generator == "sphere") return makeCube(number(0, 1), count(1, 8), true);
    if (recipe.generator == "cylinder")
        return makeCylinder(number(0, 0.2), number(1, 1), count(2, 16), count(3, 4), count(4, 3),
                            true);
    if (recipe.generator == "confetti")
        return makeConfetti(number(0, 0.5), count(1, 4), number(2, 0.02));
    ADD_FAILURE() << "no mesh generator is called " << recipe.generator;
    return makePlane(1, 1);
}

uint32_t presetOf(std::string name) {
    std::replace(name.begin(), name.end(), '_', ' ');
    for (uint32_t i = 0; i < FW_MATERIAL_PRESET_COUNT; ++i)
        if (name == fwMaterialPresetName(i)) return i;
    ADD_FAILURE() << "no material preset is called " << name;
    return 0;
}

// A context and a world that plays a log. Each backend steps it in its own way.
class Player {
 public:
    Player(const FwVulkanHost* vulkan, uint32_t stepsPerFrame) : stepsPerFrame_(stepsPerFrame) {
        FwContextDef def = fwDefaultContextDef();
        def.backend = vulkan ? FW_BACKEND_VULKAN : FW_BACKEND_CPU;
        def.vulkan = vulkan;
        FwErrorInfo error{};
        EXPECT_EQ(FW_OK, fwCreateContext(&def, &context_, &error)) << error.message;
        EXPECT_EQ(FW_OK, fwContext_Prepare(context_));
    }
    Player(const Player&) = delete;
    Player& operator=(const Player&) = delete;
    virtual ~Player() { fwDestroyContext(context_); }

    // Hashes after every `every`-th step and after the last.
    std::vector<ReplayHash> play(const ReplayLog& log, uint32_t every) {
        begin(log);
        std::vector<ReplayHash> hashes;
        size_t next = 0;
        for (uint32_t step = 0; step < log.steps && !::testing::Test::HasFatalFailure();) {
            for (; next < log.commands.size() && log.commands[next].tick / kStepTicks == step;
                 ++next)
                apply(log.commands[next], step);
            // To the next command, hash or end.
            uint32_t until = std::min(log.steps, (step / every + 1) * every);
            if (next < log.commands.size())
                until = std::min(until, log.commands[next].tick / kStepTicks);
            while (step < until) {
                const uint32_t now = std::min(until - step, stepsPerFrame_);
                step += now;
                frame(world_, float(now) * kStepSeconds);
            }
            if (step % every == 0 || step == log.steps) hashes.push_back(hashNow(step));
        }
        return hashes;
    }

 protected:
    virtual void frame(FwWorld* world, float deltaTime) = 0;

    std::string said() {
        char text[512] = {};
        (void)fwWorld_GetLastMessage(world_, text, sizeof text);
        return text;
    }
    FwContext* context_ = nullptr;

 private:
    struct Living {
        uint32_t number = 0;  // in the order of creation
        FwBurnableMeshId id{};
    };

    void begin(const ReplayLog& log) {
        meshes_.clear();
        materials_.clear();
        objects_.clear();
        created_ = 0;
        FwWorldDef def = fwDefaultWorldDef();
        def.paceFactor = float(log.pace);
        ASSERT_EQ(FW_OK, fwCreateWorld(context_, &def, &world_));
        for (const ReplayMesh& recipe : log.meshes) {
            const Mesh mesh = generate(recipe);
            FwMeshDef meshDef = meshDefOf(mesh);
            meshDef.normals = nullptr;
            meshDef.texelsPerMetre = float(recipe.density);
            meshDef.noiseAmplitude = float(recipe.noise);
            ASSERT_EQ(FW_OK, fwWorld_CreateMesh(world_, &meshDef, &meshes_[recipe.name])) << said();
        }
    }

    FwMaterialId materialOf(const std::string& preset) {
        const auto known = materials_.find(preset);
        if (known != materials_.end()) return known->second;
        FwMaterialDef def = fwDefaultMaterialDef();
        EXPECT_EQ(FW_OK, fwInitMaterialPreset(&def, presetOf(preset)));
        FwMaterialId id{};
        EXPECT_EQ(FW_OK, fwWorld_CreateMaterial(world_, &def, &id)) << said();
        materials_[preset] = id;
        return id;
    }

    static void place(float (&transform)[16], const double (&numbers)[6], double degrees) {
        const double angle = degrees * std::numbers::pi / 180, scale = numbers[3];
        const double c = std::cos(angle) * scale, s = std::sin(angle) * scale;
        const double made[16] = {c, s, 0,     0, -s,         c,          0,          0,
                                 0, 0, scale, 0, numbers[0], numbers[1], numbers[2], 1};
        std::copy_n(made, 16, transform);
    }

    void apply(const ReplayCommand& command, uint32_t step) {
        SCOPED_TRACE("line " + std::to_string(command.line));
        const double(&numbers)[6] = command.numbers;
        const auto named = objects_.find(command.object);
        if (command.verb != ReplayVerb::Object && !command.object.empty()) {
            ASSERT_NE(objects_.end(), named) << command.object << " does not live";
        }
        switch (command.verb) {
            case ReplayVerb::Wind: {
                const float wind[3] = {float(numbers[0]), float(numbers[1]), float(numbers[2])};
                ASSERT_EQ(FW_OK, fwWorld_SetWind(world_, wind)) << said();
                break;
            }
            case ReplayVerb::Object: {
                ASSERT_EQ(objects_.end(), named) << command.object << " lives already";
                FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
                ASSERT_EQ(1u, meshes_.count(command.mesh)) << command.mesh;
                def.mesh = meshes_[command.mesh];
                def.materials[0] = materialOf(command.material);
                place(def.transform, numbers, 0);
                FwBurnableMeshId id{};
                ASSERT_EQ(FW_OK, fwWorld_CreateBurnableMesh(world_, &def, &id)) << said();
                objects_[command.object] = {created_++, id};
                break;
            }
            case ReplayVerb::Pose: {
                float transform[16];
                place(transform, numbers, numbers[4]);
                ASSERT_EQ(FW_OK, fwWorld_SetTransform(world_, named->second.id, transform))
                    << said();
                break;
            }
            case ReplayVerb::Destroy:
                ASSERT_EQ(FW_OK, fwWorld_DestroyBurnableMesh(world_, named->second.id)) << said();
                objects_.erase(named);
                break;
            default: {
                static_assert(int(ReplayVerb::Extinguish) - int(ReplayVerb::Ignite) ==
                              FW_EXTINGUISH);
                FwIgnitionDef def = fwDefaultIgnitionDef();
                def.kind = uint32_t(command.verb) - uint32_t(ReplayVerb::Ignite);
                if (!command.object.empty()) def.object = named->second.id;
                for (int i = 0; i < 3; ++i) def.position[i] = float(numbers[i]);
                def.radius = float(numbers[3]);
                def.delay = float(command.tick - step * kStepTicks) / 4096.0f;
                ASSERT_LE(FW_OK, fwWorld_Ignite(world_, &def, nullptr)) << said();
                break;
            }
        }
    }

    ReplayHash hashNow(uint32_t step) {
        std::vector<const Living*> order;
        for (const auto& [name, living] : objects_) {
            EXPECT_EQ(FW_OK, fwDebug_RequestBurnMap(world_, living.id)) << said();
            order.push_back(&living);
        }
        std::sort(order.begin(), order.end(),
                  [](const Living* a, const Living* b) { return a->number < b->number; });
        std::vector<uint32_t> words;
        for (const Living* living : order) {
            uint64_t hash = 0, tick = 0;
            FwResult result = FW_NOT_READY;
            for (int i = 0; i < 8 && result == FW_NOT_READY; ++i) {
                if (i > 0) frame(world_, 0);  // flushes pending readbacks
                result =
                    fwDebug_FetchBurnMap(world_, living->id, nullptr, 0, nullptr, &hash, &tick);
            }
            EXPECT_EQ(FW_OK, result) << said();
            EXPECT_EQ(uint64_t(step) * kStepTicks, tick);
            words.insert(words.end(), {living->number, uint32_t(hash), uint32_t(hash >> 32)});
        }
        return {step, uint32_t(order.size()), core::hashWords(words)};
    }

    const uint32_t stepsPerFrame_;
    FwWorld* world_ = nullptr;
    std::map<std::string, FwMeshId> meshes_;
    std::map<std::string, FwMaterialId> materials_;
    std::map<std::string, Living> objects_;
    uint32_t created_ = 0;
};

class CpuPlayer final : public Player {
 public:
    CpuPlayer() : Player(nullptr, 1) {}

 private:
    void frame(FwWorld* world, float deltaTime) override {
        ASSERT_EQ(FW_OK, fwWorld_Step(world, deltaTime));
    }
};

class VkPlayer final : public Player {
 public:
    VkPlayer(TestDevice& device, const FwVulkanHost& host) : Player(&host, 4), frames_(device, 2) {}
    ~VkPlayer() override { frames_.waitAll(); }

 private:
    void frame(FwWorld* world, float deltaTime) override {
        const FwVulkanFrame frame = frames_.begin(deltaTime);
        const FwView view = fwDefaultView();
        EXPECT_EQ(FW_OK, fwWorld_RecordOutside(world, &frame, &view));
        frames_.submit();
    }
    HostFrames frames_;
};

// The first step at which two logs differ, 0 if none.
uint32_t firstDifference(const std::vector<ReplayHash>& want, const std::vector<ReplayHash>& got) {
    for (const ReplayHash& one : got) {
        if (one.step == 0 || one.step > want.size()) return one.step;
        if (!(want[one.step - 1] == one)) return one.step;
    }
    return 0;
}

class Replay : public ::testing::TestWithParam<const char*> {
 protected:
    void SetUp() override {
        std::string error;
        ASSERT_TRUE(readReplayLog(pathOf(GetParam(), ".log"), log_, error)) << error;
    }
    ReplayLog log_;
};

TEST_P(Replay, CpuMatchesTheHashOfEveryStep) {
    const std::vector<ReplayHash> got = CpuPlayer().play(log_, 1);
    ASSERT_EQ(log_.steps, got.size());
    if (blessing()) {
        ASSERT_TRUE(writeReplayHashes(pathOf(GetParam(), ".hashes"), got));
        std::printf("           recorded %zu hashes\n", got.size());
    }
    std::vector<ReplayHash> want;
    std::string error;
    ASSERT_TRUE(readReplayHashes(pathOf(GetParam(), ".hashes"), want, error)) << error;
    ASSERT_EQ(log_.steps, want.size());
    EXPECT_EQ(0u, firstDifference(want, got))
        << "is the first step that ends differently. If a change of bake or front is meant to: "
           "tests/run --filter Replay --bless";
    // A useful log: most of its steps change something.
    uint32_t changes = 0;
    for (size_t i = 1; i < got.size(); ++i) changes += got[i].hash != got[i - 1].hash ? 1u : 0u;
    EXPECT_LT(log_.steps / 2, changes);
}

class ReplayOnDevice : public GpuTest, public ::testing::WithParamInterface<const char*> {};

TEST_P(ReplayOnDevice, MatchesTheCpu) {
    if (!device_) return;
    ReplayLog log;
    std::vector<ReplayHash> want;
    std::string error;
    ASSERT_TRUE(readReplayLog(pathOf(GetParam(), ".log"), log, error)) << error;
    ASSERT_TRUE(readReplayHashes(pathOf(GetParam(), ".hashes"), want, error)) << error;
    const FwVulkanHost host = device_->host();
    const std::vector<ReplayHash> got = VkPlayer(*device_, host).play(log, 16);
    EXPECT_LE(log.steps / 16, got.size());
    EXPECT_EQ(0u, firstDifference(want, got)) << "is the first that was found different";
}

constexpr const char* kLogs[] = {"turning_wind", "doused_and_lit_again", "many_come_and_go"};
const auto nameOf = [](const ::testing::TestParamInfo<const char*>& info) {
    return std::string(info.param);
};
INSTANTIATE_TEST_SUITE_P(Logs, Replay, ::testing::ValuesIn(kLogs), nameOf);
INSTANTIATE_TEST_SUITE_P(Logs, ReplayOnDevice, ::testing::ValuesIn(kLogs), nameOf);

// One input of a log changed: equal until then, different afterwards.
TEST(ReplayCheck, DetectsOneChangedInput) {
    const auto differsAt = [](const char* name, const auto& change, uint32_t steps) {
        ReplayLog log;
        std::string error;
        EXPECT_TRUE(readReplayLog(pathOf(name, ".log"), log, error)) << error;
        const std::vector<ReplayHash> want = CpuPlayer().play(log, 1);
        const uint32_t tick = change(log);
        log.steps = std::min(log.steps, tick / kStepTicks + steps);
        const uint32_t first = firstDifference(want, CpuPlayer().play(log, 1));
        EXPECT_LT(tick / kStepTicks, first) << name;  // not earlier
        return first == 0 ? 0u : first - tick / kStepTicks;
    };
    const auto find = [](ReplayLog& log, ReplayVerb verb) -> ReplayCommand& {
        return *std::find_if(log.commands.rbegin(), log.commands.rend(),
                             [&](const ReplayCommand& c) { return c.verb == verb; });
    };
    // A tick earlier: the same step differs.
    EXPECT_EQ(1u, differsAt(
                      "doused_and_lit_again",
                      [&](ReplayLog& log) { return --find(log, ReplayVerb::Ignite).tick; }, 4));
    // Ignition instead of water.
    EXPECT_EQ(1u, differsAt(
                      "doused_and_lit_again",
                      [&](ReplayLog& log) {
                          ReplayCommand& command = find(log, ReplayVerb::Wet);
                          command.verb = ReplayVerb::Ignite;
                          return command.tick;
                      },
                      4));
    // Wind from another direction: differs from its next latch on.
    const uint32_t latched = differsAt(
        "turning_wind",
        [&](ReplayLog& log) {
            ReplayCommand& command = find(log, ReplayVerb::Wind);
            command.numbers[0] += 4;
            return command.tick;
        },
        64);
    EXPECT_LT(0u, latched);
    EXPECT_GE(32u, latched);
}

TEST(ReplayCheck, RefusesFilesThatAreNoLogs) {
    const std::string path = ::testing::TempDir() + "no.log";
    for (const char* text :
         {"", "end 0\n", "0 ignite 1 2\nend 4\n", "5 wind 1 2 3\nend 4\n", "0 jump 1 2 3\nend 4\n",
          "256 ignite 0 0 0 1\n128 ignite 0 0 0 1\nend 4\n", "0 destroy\nend 4\n",
          "x wind 1 2 3\nend 4\n", "0 wind 1 2 3 4\nend 4\n", "mesh a 64 0\nend 4\n"}) {
        std::FILE* file = std::fopen(path.c_str(), "w");
        ASSERT_NE(nullptr, file);
        std::fputs(text, file);
        std::fclose(file);
        ReplayLog log;
        std::string error;
        EXPECT_FALSE(readReplayLog(path, log, error)) << text;
        EXPECT_NE(std::string::npos, error.find("no.log")) << error;
    }
    std::remove(path.c_str());
}

}  // namespace
}  // namespace fw::test::replay_test
