// Output of a scene: its files and code compile, link and run, and the game's fire equals the
// editor's; pictures match the scene; every output can be cancelled.
#include "output/output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>

#include "editor/boards.h"
#include "editor/text_of.h"
#include "editor/yard.h"
#include "flamewright/flamewright_debug.h"
#include "import/float_picture.h"
#include "support/paths.h"
#include "support/sanitized.h"

namespace {

using namespace fwtest;
using ::testing::HasSubstr;

// Every kind of object that burns, heats, wets and blows, with its times.
constexpr const char* kEverything =
    "set Board refine yes tint 1 0.9 0.8 moisture 0.02\n"
    "import board.glb name=\"Second board\" materials pine map_size 128 texels_per_metre 64 "
    "position 0 0 1 rotation 10 20 30 thickness 0.01\n"
    "import board.glb name=Sheet materials cotton map_size 64 texels_per_metre 32 position 3 0 0 "
    "deform sheet pins 0:0:0:1:1:0:0.02\n"
    "add layer multiplier name=Belt mesh Board\n"
    "stroke Belt value 0 size 0.04 path 0.1:0:0 0.1:0.2:0\n"
    "set Match start 0.3\n"
    "add source point name=\"Corner torch\" position 0.3 0 1.1 output 30 radius 0.1 start 0.5 "
    "duration 1.5\n"
    "add source point name=Lamp output 30 radius 0.05 sticks_to Board sticks_to_node wick\n"
    "add source flamethrower name=Nozzle direction 0 0 1 output 100 sticks_to \"Second board\" "
    "sticks_to_node hook\n"
    "add source line position 0 0 0.3 direction 1 0 0 length 1 output 50 radius 0.08\n"
    "add source flamethrower name=Register position -1 0.2 0 direction 1 0 0 output 300 "
    "keys 0:0 1:1 2:0.25\n"
    "add source rain name=\"Rain, light\" position 0 1 0 radius 0.5 output 0.1 length 1 start 1\n"
    "add source water position 0.5 0.2 0 radius 0.1 output 0.05 keys 0:1 2:0\n"
    "add flame camp name=Campfire position 1 0 0 ignites yes tint 0.2 0.5 1 tint_weight 0.5 "
    "core_tint 1 0.9 0.3 core_tint_weight 0.7 "
    "outline 0:0.7 0.5:0.4 1:0.05 stops 0:900 1:1500\n"
    "add emitter mesh name=\"2 sparks\" sticks_to Board\n"
    "add emitter disc position 0 0 1 duration 2\n"
    "add wind velocity 3 0 0 start 0.5 duration 1 keys 0:0 1:1\n"
    "add wind velocity 0 0 1\n"
    "add wind fan name=Fan velocity 4 0 0 position -1 0.2 0 length 3 radius 1 start 0.5 "
    "keys 0:0 1:1\n"
    "add wind box name=Lee velocity 0 0 0 position 3 0 0 shelters yes\n"
    "add collider box name=Wall position 0 0 5 rotation 10 20 30\n"
    "add collider floor position 0 -0.1 0\n";

// Runs a command and returns its output. Fails on a status other than 0.
std::string runCommand(const std::string& command) {
    std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
    std::string text;
    std::array<char, 512> buffer{};
    while (pipe && std::fgets(buffer.data(), buffer.size(), pipe)) text += buffer.data();
    EXPECT_EQ(0, pipe ? pclose(pipe) : -1) << command << "\n" << text;
    return text;
}

constexpr uint32_t kFrames = 30;
constexpr float kFrame = 0.125f;

// Hashes of the ignition maps of a world's first objects.
std::string hashesOf(FwWorld* world, const std::vector<FwBurnableMeshId>& objects) {
    std::string text;
    for (const FwBurnableMeshId object : objects) {
        uint64_t count = 0, hash = 0, tick = 0;
        EXPECT_EQ(FW_OK, fwDebug_RequestBurnMap(world, object));
        EXPECT_EQ(FW_OK, fwWorld_Step(world, 0));
        EXPECT_EQ(FW_OK, fwDebug_FetchBurnMap(world, object, nullptr, 0, &count, &hash, &tick));
        char line[64];
        std::snprintf(line, sizeof line, "%llx at %llu\n", static_cast<unsigned long long>(hash),
                      static_cast<unsigned long long>(tick));
        text += line;
    }
    return text;
}

// A game around a snippet, on the cpu backend, for the time of the test's burn.
constexpr const char* kGame = R"(
#include <flamewright/flamewright_debug.h>
#include <stdio.h>
int main(void) {
    FwContextDef contextDef = fwDefaultContextDef();
    FwContext* context = 0;
    FwErrorInfo info;
    int i;
    contextDef.backend = FW_BACKEND_CPU;
    if (fwCreateContext(&contextDef, &context, &info) < 0) return 2;
    {
        Yard yard;
        static const float pose[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0.05f, 0.02f, 1};
        if (CREATE < 0) return 3;
        if (MOVE < 0) return 6;
        for (i = 0; i < 30; ++i)
            if (ADVANCE < 0 || fwWorld_Step(WORLD, 0.125f) < 0) return 4;
        {
            const FwBurnableMeshId objects[] = {yard.board, yard.second_board, yard.sheet};
            for (i = 0; i < 3; ++i) {
                uint64_t count, hash, tick;
                if (fwDebug_RequestBurnMap(WORLD, objects[i]) < 0 || fwWorld_Step(WORLD, 0) < 0 ||
                    fwDebug_FetchBurnMap(WORLD, objects[i], 0, 0, &count, &hash, &tick) < 0)
                    return 5;
                printf("%llx at %llu\n", (unsigned long long)hash, (unsigned long long)tick);
            }
        }
        DESTROY;
    }
    fwDestroyContext(context);
    return 0;
}
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

TEST(EditorOutput, CAndCppSnippetsBurnLikeTheEditor) {
    Yard yard;
    yard.run(kBoard);
    yard.run(kEverything);
    yard.run("save yard.fwscene\ncook game\nsnippet game/yard.c\nsnippet game/yard.cpp\n");
    // The game moves a board with attached objects as the editor does.
    yard.run("move Board 0 0.05 0.02\nplay 0\n");
    std::string error;
    FwContext* cpu = yard.host->cpu(error);
    ASSERT_TRUE(burnToPlayhead(*yard.host, cpu, error)) << error;
    Burn& burn = *yard.host->burn;
    ASSERT_THAT(burn.report, ::testing::IsEmpty());
    for (uint32_t i = 0; i < kFrames; ++i) ASSERT_TRUE(runBurn(burn, burn.time + kFrame, error));
    std::vector<FwBurnableMeshId> objects;
    for (const BurnMesh& mesh : burn.meshes) objects.push_back(mesh.object);
    ASSERT_EQ(3u, objects.size());
    const std::string wanted = hashesOf(burn.world, objects);
    FwObjectState state{};
    state.structSize = sizeof state;
    ASSERT_EQ(FW_OK, fwWorld_GetObjectState(burn.world, objects[0], &state));
    ASSERT_GT(state.ignited, 100u);  // enough happened to show a difference

    const std::string library = fw::test::kLibrary, include = fw::test::kIncludeFolder;
    const std::string folder = (yard.folder / "game").string();
    const std::string tail = " -I" + include + " " + library + " -lm -Wl,-rpath," +
                             fs::path(library).parent_path().string();
    // A sanitized library needs a sanitized program.
    const std::string strict = std::string(" -Wall -Wextra -Wpedantic -Werror -O1") +
                               (fw::test::kSanitized ? " -fsanitize=address,undefined" : "");
    std::string c = replaced(kGame, "CREATE", "yard_create(context, \"" + folder + "\", &yard)");
    c = replaced(replaced(c, "ADVANCE", "yard_advance(&yard, 0.125f)"), "WORLD", "yard.world");
    c = replaced(c, "MOVE", "yard_move_board(&yard, pose)");
    std::ofstream(yard.folder / "main.c") << "#include \"game/yard.c\"\n"
                                          << replaced(c, "DESTROY", "yard_destroy(&yard)");
    runCommand("cc -std=c11" + strict + " -o " + (yard.folder / "in_c").string() + " " +
               (yard.folder / "main.c").string() + tail);
    EXPECT_EQ(wanted, runCommand((yard.folder / "in_c").string()));

    std::string cpp = replaced(kGame, "CREATE", "create(context, \"" + folder + "\", yard)");
    cpp = replaced(replaced(cpp, "ADVANCE", "advance(yard, 0.125f)"), "WORLD", "yard.world.get()");
    cpp = replaced(cpp, "MOVE", "move_board(yard, pose)");
    std::ofstream(yard.folder / "main.cpp") << "#include \"game/yard.cpp\"\n"
                                            << replaced(cpp, "DESTROY", "(void)0");
    runCommand("c++ -std=c++20" + strict + " -o " + (yard.folder / "in_cpp").string() + " " +
               (yard.folder / "main.cpp").string() + tail);
    EXPECT_EQ(wanted, runCommand((yard.folder / "in_cpp").string()));

    // Without its files it reports them.
    fs::remove(yard.folder / "game" / "campfire.fwprofile");
    EXPECT_NE(0, std::system(((yard.folder / "in_c").string() + " >/dev/null").c_str()));
}

TEST(EditorOutput, SnippetsOfSmallScenesCompile) {
    // Each helper is emitted only where it is used.
    const char* scenes[] = {"",
                            "add flame camp\n",
                            "add source rain\n",
                            "add wind velocity 1 0 0\n",
                            "add source flamethrower keys 0:0 1:1\n",
                            "add collider box\n",
                            "add source match name=\"/* a */ \\\\\" start 2\n",
                            "import leaves.gltf materials dry_leaf\n"};
    Yard yard;
    writeBoardRow(yard.folder, "leaves",
                  {{{1, 1, 1}, leavesPng(), ",\"alphaMode\":\"MASK\",\"doubleSided\":true", ""},
                   {{1, 0, 0}, {}, "", ""}});
    std::string c, cpp;
    int number = 0;
    for (const char* scene : scenes) {
        const std::string name = "small" + std::to_string(number++);
        yard.run("new\n");
        yard.run(scene);
        yard.run("snippet " + name + ".c\nsnippet " + name + ".cpp\n");
        EXPECT_THAT(textOf(yard.folder / (name + ".c")), HasSubstr("FwResult fire_scene_create("));
        c += " " + (yard.folder / (name + ".c")).string();
        cpp += " " + (yard.folder / (name + ".cpp")).string();
    }
    const std::string strict = std::string(" -Wall -Wextra -Wpedantic -Werror -fsyntax-only -I") +
                               fw::test::kIncludeFolder;
    runCommand("cc -std=c11" + strict + c);
    runCommand("c++ -std=c++20" + strict + cpp);
}

TEST(EditorOutput, RefusalsNameTheWord) {
    Yard yard;
    yard.run(kBoard);
    yard.run("add flame camp name=Campfire\n");
    EXPECT_THAT(yard.fails("snippet a.txt"), HasSubstr("neither .c nor .cpp"));
    EXPECT_THAT(yard.fails("filmstrip a.png 0"), HasSubstr("\"0\"; it takes 1 to 256"));
    EXPECT_THAT(yard.fails("filmstrip a.png 4 9"), HasSubstr("1x1 to 8192x8192"));
    EXPECT_THAT(yard.fails("turntable"), HasSubstr("turntable FOLDER"));
    EXPECT_THAT(yard.fails("flipbook a.fwbook Board"), HasSubstr("no flame"));
    EXPECT_THAT(yard.fails("flipbook a.fwbook Campfire 1"), HasSubstr("2 to 256"));
    fs::remove(yard.folder / "board.glb");
    yard.host->assets.models.clear();
    EXPECT_THAT(yard.fails("cook game"), HasSubstr("board.glb"));
    EXPECT_FALSE(fs::exists(yard.folder / "game"));
}

TEST(EditorOutput, CancelledOutputKeepsTheOldFile) {
    Yard yard;
    yard.run(kBoard);
    yard.run("add flame camp name=Campfire\n");
    std::ofstream(yard.folder / "fire.fwbook") << "old";
    int asked = 0;
    yard.host->progress = [&](const std::string&, float share) {
        EXPECT_GE(share, 0);
        EXPECT_LE(share, 1);
        return ++asked < 3;
    };
    EXPECT_EQ(kStopped, yard.fails("flipbook fire.fwbook Campfire 8 16"));
    EXPECT_EQ("old", textOf(yard.folder / "fire.fwbook"));
    asked = 2;
    EXPECT_EQ(kStopped, yard.fails("cook game"));
    asked = 0;
    EXPECT_EQ(kStopped, yard.fails("bake burn"));
    EXPECT_FALSE(fs::exists(yard.folder / "burn"));
}

TEST(EditorOutput, FlamesBakeToFlipbooksOfTheirShape) {
    Yard yard;
    yard.run(
        "add flame camp name=Campfire\n"
        "add flame camp name=Thin outline 0:0.2 1:0.05 stops 0:1000 1:1400\n"
        "flipbook a.fwbook Campfire 6 24\nflipbook b.fwbook Thin 6 24\n");
    std::string error;
    FwContext* cpu = yard.host->cpu(error);
    FwWorld* world = nullptr;
    const FwWorldDef worldDef = fwDefaultWorldDef();
    ASSERT_EQ(FW_OK, fwCreateWorld(cpu, &worldDef, &world));
    for (const char* name : {"a.fwbook", "b.fwbook"}) {
        const std::string bytes = textOf(yard.folder / name);
        FwFlipbookDef def = fwDefaultFlipbookDef();
        def.cooked = bytes.data();
        def.cookedSize = bytes.size();
        FwFlipbookId id{};
        EXPECT_EQ(FW_OK, fwWorld_CreateFlipbook(world, &def, &id)) << name;
    }
    fwDestroyWorld(world);
    EXPECT_NE(textOf(yard.folder / "a.fwbook"), textOf(yard.folder / "b.fwbook"));
}

TEST(EditorOutput, BakesHoldTheTimeOfEachSpot) {
    Yard yard;
    yard.run(kBoard);
    yard.run("bake burn\nburn\n");
    fwimport::FloatPicture picture;
    std::string error;
    ASSERT_TRUE(fwimport::readPicture(yard.folder / "burn/board_arrival.exr", picture, error))
        << error;
    const ArrivalField& field = yard.host->record.fields[0];
    ASSERT_EQ(field.seconds.size(), picture.values.size());
    size_t lit = 0;
    for (size_t i = 0; i < field.seconds.size(); ++i) {
        const bool never = field.seconds[i] >= kNeverLit;
        lit += !never;
        EXPECT_EQ(never ? -1.0f : field.seconds[i], picture.values[i]);
    }
    EXPECT_GT(lit, 1000u);
    const std::string baked = textOf(yard.folder / "burn/board_baked.fwburn");
    FwWorld* world = nullptr;
    const FwWorldDef worldDef = fwDefaultWorldDef();
    ASSERT_EQ(FW_OK, fwCreateWorld(yard.host->cpu(error), &worldDef, &world));
    FwBurnId burn{};
    EXPECT_EQ(FW_OK, fwWorld_CreateBurn(world, baked.data(), baked.size(), &burn));
    fwDestroyWorld(world);
}

TEST(EditorOutput, FilmstripsAndTurntablesShowTheFire) {
    Yard yard;
    std::string error;
    if (!yard.host->device(error)) GTEST_SKIP() << "no Vulkan device: " << error;
    yard.run(kBoard);
    yard.run(
        "set settings daylight night pace 60 duration 2\nset Board materials pine\n"
        "set Match radius 0.15\nframe\n"
        "filmstrip strip.png 4 64x36 2\nplay 1\nturntable turn 3 64x36\n");
    fwimport::FloatPicture strip;
    ASSERT_TRUE(fwimport::readPicture(yard.folder / "strip.png", strip, error)) << error;
    EXPECT_EQ(2 * 64 + 2u, strip.width);
    EXPECT_EQ(2 * 36 + 2u, strip.height);
    const auto light = [](const fwimport::FloatPicture& picture, uint32_t x0, uint32_t y0) {
        double sum = 0;
        for (uint32_t y = y0; y < y0 + 36; ++y)
            for (uint32_t x = x0; x < x0 + 64; ++x) sum += double(picture.at(x, y, 0));
        return sum / (64 * 36);
    };
    EXPECT_GT(light(strip, 66, 38), light(strip, 0, 0) + 0.01);  // the end against the beginning
    std::vector<fwimport::FloatPicture> turn(3);
    for (int i = 0; i < 3; ++i)
        ASSERT_TRUE(fwimport::readPicture(
            yard.folder / "turn" / ("turn_00" + std::to_string(i + 1) + ".png"), turn[size_t(i)],
            error))
            << error;
    EXPECT_NE(turn[0].values, turn[1].values);
    EXPECT_FALSE(fs::exists(yard.folder / "turn/turn_004.png"));
}

}  // namespace
