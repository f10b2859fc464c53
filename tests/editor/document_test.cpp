// The editor's document without a window: files, commands, undo.
#include "document/document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "document/apply.h"
#include "document/clipboard.h"
#include "document/text.h"
#include "editor/text_of.h"
#include "support/sanitized.h"

namespace {

using namespace fwedit;
using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

struct Folder {
    fs::path path;
    Folder() {
        static int number = 0;
        path = fs::temp_directory_path() /
               ("fw_document_" + std::to_string(::getpid()) + "_" + std::to_string(number++));
        fs::create_directories(path);
    }
    ~Folder() { fs::remove_all(path); }
};

void mustRun(Document& document, const std::string& line) {
    std::string message;
    ASSERT_TRUE(runLine(document, line, message)) << line << "\n" << message;
}

std::string refusal(Document& document, const std::string& line) {
    const std::string before = printScene(document.scene);
    const size_t steps = document.steps.size();
    std::string message;
    EXPECT_FALSE(runLine(document, line, message)) << line;
    EXPECT_EQ(before, printScene(document.scene)) << line;
    EXPECT_EQ(steps, document.steps.size()) << line;
    return message;
}

// A flat sheet of 64 x 32 texels, one metre wide, whose unwrap has two islands: the right half is
// on the left of the map. A stroke across its middle crosses a seam.
const PaintSurface& sheet() {
    static const PaintSurface surface = [] {
        PaintSurface made;
        made.width = 64;
        made.height = 32;
        made.spacing = 1.0f / 64;
        for (uint32_t y = 0; y < 32; ++y)
            for (uint32_t x = 0; x < 64; ++x) {
                const uint32_t column = x < 32 ? x + 32 : x - 32;
                made.positions.insert(made.positions.end(), {(float(column) + 0.5f) / 64 - 0.5f,
                                                             (float(y) + 0.5f) / 64, 0});
                made.normals.insert(made.normals.end(), {0, 0, 1});
                made.real.push_back(1);
                made.island.push_back(x < 32 ? 0 : 1);
                made.piece.push_back(0);
                made.material.push_back(y < 16 ? 0 : 1);
            }
        indexSurface(made);
        return made;
    }();
    return surface;
}

Document paintable() {
    Document document = newDocument();
    document.surface = [](const Scene& scene, ObjectId mesh) {
        return findIn(scene.meshes, mesh) ? &sheet() : nullptr;
    };
    return document;
}

TEST(EditorCommands, AddsTheNamedObject) {
    Document document = newDocument();
    mustRun(document,
            "add source point name=\"Corner torch\" position 0.1 0.2 0.3 output 18 kW radius 5 cm");
    ASSERT_EQ(1u, document.scene.sources.size());
    const HeatSource& source = document.scene.sources[0];
    EXPECT_EQ("Corner torch", source.name);
    EXPECT_EQ((Vec3{0.1f, 0.2f, 0.3f}), source.position);
    EXPECT_EQ(18, source.output);
    EXPECT_EQ(0.05f, source.radius);
    EXPECT_EQ(SourcePoint, source.shape);
    EXPECT_EQ("Add heat source", document.steps[1].name);
}

TEST(EditorCommands, PrintedLinesRepeatTheCommand) {
    Document first = newDocument(), second = newDocument();
    for (const char* line :
         {"add source flamethrower name=\"A \\\"jet\\\"\" position 1 2 3 direction 0 0 -1",
          "import \"crates/gate.glb\" name=\"Gate\" materials "
          "pine/paper/pine/pine/pine/pine/pine/pine",
          "set \"Gate\" pins 0:1:0:1:1:0:0.02 0:0:0:0:1:0:0.1 deform sheet", "key \"Gate\" 1 2",
          "key #1 2.5 0.4", "key #1 1/3 1", "set settings wind 1 0 -2 up 0 0 1 pace 20",
          "set #1 sticks_to \"Gate\"", "duplicate #1 \"Gate\"", "order #1 7",
          "move #1 #2 0.1 0 1e-3", "add layer moisture mesh \"Gate\"", "rename #1 \"B\"",
          "unkey \"B\" 2.5", "add event time 3 note \"roof\"",
          "set #2 hidden yes locked no scale 1 2 1"}) {
        Command command;
        std::string error, message;
        if (!parseCommand(first.scene, line, command, error)) {
            EXPECT_TRUE(std::string(line).find("1/3") != std::string::npos ||
                        std::string(line) == "key \"Gate\" 1 2")
                << line << ": " << error;
            continue;
        }
        const std::string printed = printCommand(first.scene, command);
        const bool done = run(first, command, message);
        EXPECT_EQ(done, runLine(second, printed, error)) << printed << ": " << error;
        EXPECT_EQ(printScene(first.scene), printScene(second.scene)) << printed;
        Command again;
        if (done && command.verb != Verb::Add && command.verb != Verb::Import) {
            EXPECT_TRUE(parseCommand(first.scene, printed, again, error)) << printed << error;
        }
    }
    EXPECT_GE(first.steps.size(), 13u);
}

TEST(EditorCommands, RefusalsNameTheWordAndTheChoices) {
    Document document = newDocument();
    mustRun(document, "add source disc name=Torch");
    EXPECT_THAT(refusal(document, "ad source"), HasSubstr("\"ad\" is no command"));
    EXPECT_THAT(refusal(document, "set \"Lamp\" output 3"), HasSubstr("no object \"Lamp\""));
    EXPECT_THAT(refusal(document, "set \"Torch\" outptu 3"), HasSubstr("no field \"outptu\""));
    EXPECT_THAT(refusal(document, "set \"Torch\" output three"),
                HasSubstr("output is \"three\"; it takes a number in kW"));
    EXPECT_THAT(refusal(document, "set \"Torch\" output 3 cm"), HasSubstr("cm"));
    EXPECT_THAT(refusal(document, "set \"Torch\" shape round"), HasSubstr("match, point, disc"));
    EXPECT_THAT(refusal(document, "set \"Torch\" position 1 2"), HasSubstr("3 numbers in m"));
    EXPECT_THAT(refusal(document, "set \"Torch\" output nan"), HasSubstr("output"));
    EXPECT_THAT(refusal(document, "set \"Torch\" sticks_to \"Torch\""), HasSubstr("sticks to it"));
    EXPECT_THAT(refusal(document, "add source \"x"), HasSubstr("quote is not closed"));
    EXPECT_THAT(refusal(document, "move \"Torch\" 0 0"), HasSubstr("line ends"));
    EXPECT_THAT(refusal(document, "remove \"Torch\" now"), HasSubstr("an extra word"));
    EXPECT_THAT(refusal(document, "fill \"Torch\" value 1"), HasSubstr("no layer"));
}

TEST(EditorCommands, ValuesBeyondLimitsAreClampedAndReported) {
    Document document = newDocument();
    mustRun(document, "add source point name=Torch");
    std::string message;
    ASSERT_TRUE(runLine(document, "set \"Torch\" radius -0.4", message));
    EXPECT_EQ("radius was -0.4 m, below 0 m; it is now 0 m", message);
    EXPECT_EQ(0, document.scene.sources[0].radius);
}

TEST(EditorUndo, NamesAreVerbAndObject) {
    Document document = paintable();
    mustRun(document, "add source point name=\"Corner torch\"");
    mustRun(document, "import crate.glb name=Crate");
    mustRun(document, "add layer multiplier mesh Crate name=Dry");
    const std::pair<const char*, const char*> rows[] = {
        {"move \"Corner torch\" 1 0 0", "Move Corner torch"},
        {"set \"Corner torch\" output 20", "Output of Corner torch"},
        {"stroke Dry value 0.2 path 0:0.2:0", "Paint burn multiplier on Crate"},
        {"fill Dry value 1.5", "Fill burn multiplier on Crate"},
        {"set settings wind 3 0 0", "Wind of the scene"},
        {"set \"Corner torch\" hidden yes", "Hide Corner torch"},
        {"move \"Corner torch\" Crate 1 0 0", nullptr},
        {"rename \"Corner torch\" \"A name so long that no list of steps can show it\"",
         "Rename Corner torch"},
        {"remove #1", "Delete A name so long that no list of s…"}};
    for (const auto& [line, name] : rows) {
        std::string message;
        const bool done = runLine(document, line, message);
        if (!name) continue;
        ASSERT_TRUE(done) << line << message;
        EXPECT_EQ(name, document.steps.back().name);
    }
}

TEST(EditorUndo, ADragIsOneStepOrNone) {
    Document document = newDocument();
    mustRun(document, "add source point name=Torch");
    beginDrag(document);
    for (int i = 0; i < 50; ++i) mustRun(document, "move \"Torch\" 0.015625 0 0");
    endDrag(document);
    ASSERT_EQ(3u, document.steps.size());
    EXPECT_EQ("Move Torch", document.steps[2].name);
    const std::string after = printScene(document.scene);

    beginDrag(document);
    mustRun(document, "move \"Torch\" 1 0 0");
    mustRun(document, "move \"Torch\" -1 0 0");
    endDrag(document);
    EXPECT_EQ(3u, document.steps.size());

    beginDrag(document);
    mustRun(document, "set \"Torch\" output 99");
    cancelDrag(document);
    EXPECT_EQ(3u, document.steps.size());
    EXPECT_EQ(after, printScene(document.scene));
    EXPECT_TRUE(undo(document));
    EXPECT_EQ(0, document.scene.sources[0].position[0]);
}

TEST(EditorUndo, NudgesMergeWithin800Milliseconds) {
    Document document = newDocument();
    mustRun(document, "add source point name=Torch");
    const auto nudge = [&](const char* line, double now) {
        Command command;
        std::string error;
        ASSERT_TRUE(parseCommand(document.scene, line, command, error)) << error;
        ASSERT_TRUE(runNudge(document, command, now, error)) << error;
    };
    nudge("set \"Torch\" output 19", 1.0);
    nudge("set \"Torch\" output 20", 1.5);
    nudge("set \"Torch\" output 21", 2.2);
    EXPECT_EQ(3u, document.steps.size());
    nudge("set \"Torch\" output 22", 3.1);  // too late
    EXPECT_EQ(4u, document.steps.size());
    nudge("set \"Torch\" radius 0.1", 3.2);  // another field
    EXPECT_EQ(5u, document.steps.size());
    mustRun(document, "move \"Torch\" 1 0 0");  // another command in between
    nudge("set \"Torch\" radius 0.2", 3.3);
    EXPECT_EQ(7u, document.steps.size());
    nudge("set \"Torch\" radius 0.1", 3.4);  // restored to its first value: no step
    EXPECT_EQ(6u, document.steps.size());
}

TEST(EditorUndo, CameraMovesAreNotSteps) {
    Document document = newDocument();
    mustRun(document, "set camera yaw 90 distance 2");
    EXPECT_EQ(1u, document.steps.size());
    EXPECT_EQ(90, document.scene.camera.yaw);
}

// A line that may or may not be valid.
std::string randomLine(std::mt19937& random, const Scene& scene) {
    const auto pick = [&](uint32_t n) { return random() % n; };
    const auto number = [&] {
        return printNumber(std::ldexp(double(int32_t(random())), -int(20 + pick(14))));
    };
    std::vector<ObjectId> ids, layers;
    forEachList(scene, [&](Kind kind, const auto& list) {
        for (const auto& object : list) ids.push_back(object.id);
        for (const auto& object : list)
            if (kind == Kind::Layer) layers.push_back(object.id);
    });
    const auto target = [&] {
        return ids.empty() || pick(20) == 0 ? std::string("#999999")
                                            : "#" + std::to_string(ids[pick(uint32_t(ids.size()))]);
    };
    const auto assignment = [&](Kind kind) {
        const auto fields = fieldsOf(kind);
        const FieldInfo& field = fields[pick(uint32_t(fields.size()))];
        std::string text = std::string(" ") + field.key + " ";
        switch (field.type) {
            case FieldType::Flag:
                return text + (pick(2) ? "yes" : "no");
            case FieldType::Whole:
                return text + std::to_string(pick(5000));
            case FieldType::Number:
                return text + number();
            case FieldType::Choice:
                return text + field.choices[pick(uint32_t(field.choices.size()))];
            case FieldType::Text:
            case FieldType::File:
                return text + fwedit::inQuotes("n \"" + std::to_string(pick(9)) + "\\ ü");
            case FieldType::Object:
                return text + (pick(3) ? target() : "none");
            case FieldType::Vector:
                return text + number() + " " + number() + " " + number();
            case FieldType::Choices:
                return text + field.choices[pick(14)];
            case FieldType::KeyList:
                return pick(4) ? text + number() + ":" + number() + " 2:3 2:4" : text + "none";
            case FieldType::Rows:
                return text + "0:1:2:3:4:" + number() + ":0.5";
        }
        return text;
    };
    static const char* kinds[] = {"mesh", "source",   "flame", "emitter",
                                  "wind", "collider", "layer", "event"};
    switch (pick(16)) {
        case 0:
        case 1: {
            const uint32_t kind = pick(8);
            std::string line = std::string("add ") + kinds[kind];
            for (uint32_t i = pick(4); i > 0; --i) line += assignment(Kind(kind));
            return line;
        }
        case 2:
            return "move " + target() + " " + target() + " " + number() + " 0 " + number();
        case 3:
            return "key " + target() + " " + std::to_string(pick(9)) + " " + number();
        case 4:
            return "unkey " + target() + " " + std::to_string(pick(9));
        case 5:
            return "duplicate " + target();
        case 6:
            return "remove " + target();
        case 7:
            return "order " + target() + " " + std::to_string(pick(12));
        case 8:
            return "import \"a/b " + std::to_string(pick(5)) + ".glb\"";
        case 9:
            return "set settings" + assignment(Kind::Settings);
        case 10:
        case 11:
            if (layers.empty()) return "add layer multiplier mesh " + target();
            return "stroke #" + std::to_string(layers[pick(uint32_t(layers.size()))]) + " size " +
                   std::to_string(0.02 + 0.01 * pick(20)) + " value " + std::to_string(pick(2)) +
                   " mode " + (pick(4) ? "paint" : "smooth") + " path " +
                   std::to_string(pick(100) * 0.01 - 0.5) +
                   ":0.2:0 0:" + std::to_string(pick(50) * 0.01) + ":0";
        case 12:
            if (layers.empty()) return "add layer moisture";
            return "fill #" + std::to_string(layers[pick(uint32_t(layers.size()))]) + " value 0." +
                   std::to_string(pick(9)) + (pick(2) ? " by all" : " by island at 0.4 0.2 0");
        default: {
            if (ids.empty()) return "add source";
            Kind kind{};
            const ObjectId id = ids[pick(uint32_t(ids.size()))];
            findObject(scene, id, &kind);
            return "set #" + std::to_string(id) + assignment(kind) + assignment(kind);
        }
    }
}

std::string everythingOf(const Document& document) {
    Scene scene = document.scene;
    scene.camera = {};
    std::string text = printScene(scene);
    for (const auto& [layer, image] : document.images) {
        const auto values = image.flat();
        text += "\n" + std::to_string(layer) + ":";
        text.append(values.begin(), values.end());
    }
    return text;
}

TEST(EditorUndo, AThousandRandomStepsUndoAndRedoExactly) {
    for (uint32_t seed = 1; seed <= 2; ++seed) {
        std::mt19937 random(seed);
        Document document = paintable();
        mustRun(document, "import start.glb name=Start");
        mustRun(document, "add layer multiplier mesh Start");
        resetHistory(document);
        const std::string start = everythingOf(document);
        std::vector<std::string> after = {start};
        int tries = 0;
        while (document.steps.size() <= fw::test::rounds<size_t>(1000, 200)) {
            ASSERT_LT(++tries, 20000);
            std::string message;
            const size_t before = document.steps.size();
            const std::string line = randomLine(random, document.scene);
            if (!runLine(document, line, message)) {
                ASSERT_FALSE(message.empty()) << line;
                ASSERT_EQ(after.back(), everythingOf(document)) << line;
            }
            if (document.steps.size() > before) after.push_back(everythingOf(document));
            if (random() % 50 == 0 &&
                canUndo(document)) {  // sometimes undo, and continue from there
                for (uint32_t back = random() % 5; back > 0 && canUndo(document); --back) {
                    undo(document);
                }
                after.resize(document.at + 1);
                ASSERT_EQ(after.back(), everythingOf(document));
            }
            if (document.at + 1 < document.steps.size()) document.steps.resize(document.at + 1);
        }
        const std::string end = everythingOf(document);
        for (size_t i = document.at; i-- > 0;) {
            ASSERT_TRUE(undo(document));
            ASSERT_EQ(after[i], everythingOf(document)) << "seed " << seed << ", step " << i;
        }
        EXPECT_FALSE(canUndo(document));
        EXPECT_EQ(start, everythingOf(document));
        while (canRedo(document)) redo(document);
        EXPECT_EQ(end, everythingOf(document));
    }
}

TEST(EditorUndo, LinesOfTheStepsRebuildTheScene) {
    std::mt19937 random(7);
    Document first = paintable(), second = paintable();
    std::string message;
    while (first.steps.size() <= 300)
        (void)runLine(first, randomLine(random, first.scene), message);
    for (size_t i = 1; i < first.steps.size(); ++i)
        ASSERT_TRUE(runLine(second, first.steps[i].line, message))
            << first.steps[i].line << ": " << message;
    EXPECT_EQ(everythingOf(first), everythingOf(second));
}

// As text into the same scene and another one: unchanged but for name and id.
TEST(EditorClipboard, PastesAsOneStep) {
    Document document = newDocument();
    mustRun(document, "add mesh name=Crate file \"crate.glb\" position 1 0 0");
    mustRun(document,
            "add source disc name=\"Corner torch\" output 25 keys 0:0 1:1 sticks_to Crate");
    mustRun(document,
            "add flame magic_blue name=Rune tint 0.5 0 1 core_tint 1 1 0 outline 0:0.5 1:0.1");
    mustRun(document, "add layer multiplier name=Belt mesh Crate");
    std::vector<ObjectId> all;
    forEachList(document.scene, [&](Kind, const auto& list) {
        for (const auto& object : list) all.push_back(object.id);
    });
    const std::string text = copyObjects(document.scene, all);
    EXPECT_THAT(text, HasSubstr("shape disc"));
    EXPECT_THAT(text, Not(HasSubstr("layer")));

    const std::string before = everythingOf(document);
    const size_t step = document.at;
    std::vector<ObjectId> added;
    std::string message;
    ASSERT_TRUE(pasteObjects(document, text, added, message)) << message;
    EXPECT_EQ(step + 1, document.at);
    EXPECT_EQ("Paste 3 objects", document.steps[document.at].name);
    ASSERT_EQ(3u, added.size());
    ASSERT_EQ(2u, document.scene.sources.size());
    HeatSource copy = document.scene.sources[1];
    EXPECT_EQ("Corner torch 2", copy.name);
    copy.name = document.scene.sources[0].name;
    copy.id = document.scene.sources[0].id;
    EXPECT_EQ(document.scene.sources[0], copy);
    Flame rune = document.scene.flames[1];
    rune.name = "Rune";
    rune.id = document.scene.flames[0].id;
    EXPECT_EQ(document.scene.flames[0], rune);
    undo(document);
    EXPECT_EQ(before, everythingOf(document));

    // Without the crate the torch stands by itself.
    Document other = newDocument();
    ASSERT_TRUE(pasteObjects(other,
                             copyObjects(document.scene, std::vector{document.scene.sources[0].id}),
                             added, message))
        << message;
    EXPECT_EQ("Corner torch", other.scene.sources.at(0).name);
    EXPECT_EQ(0u, other.scene.sources[0].sticksTo);
    EXPECT_EQ("Paste Corner torch", other.steps[other.at].name);
}

TEST(EditorClipboard, InvalidTextChangesNothing) {
    Document document = newDocument();
    mustRun(document, "add source point");
    const std::string before = everythingOf(document);
    const size_t step = document.at;
    for (const char* text : {"", "hello", "remove #1", "add source point\nremove #1",
                             "add source point output torch", "add castle"}) {
        std::vector<ObjectId> added;
        std::string message;
        EXPECT_FALSE(pasteObjects(document, text, added, message)) << text;
        EXPECT_FALSE(message.empty()) << text;
        EXPECT_TRUE(added.empty()) << text;
        EXPECT_EQ(before, everythingOf(document)) << text;
        EXPECT_EQ(step, document.at) << text;
    }
}

TEST(EditorFile, ScenesRoundTrip) {
    std::mt19937 random(3);
    Document document = paintable();
    std::string message;
    while (document.steps.size() <= 400)
        (void)runLine(document, randomLine(random, document.scene), message);
    const std::string text = printScene(document.scene);
    Scene back;
    std::vector<std::string> repairs;
    std::string error;
    ASSERT_TRUE(readScene(text, "a.fwscene", back, repairs, error)) << error;
    EXPECT_THAT(repairs, ::testing::IsEmpty());
    EXPECT_TRUE(back == document.scene);
    EXPECT_EQ(text, printScene(back));
}

TEST(EditorFile, OneChangedValueIsOneChangedLine) {
    Document document = newDocument();
    mustRun(document, "add source point name=Torch position 1 2 3");
    const std::string before = printScene(document.scene);
    mustRun(document, "set \"Torch\" position 1 2 3.5");
    const std::string after = printScene(document.scene);
    std::istringstream a(before), b(after);
    std::string x, y;
    int lines = 0;
    while (std::getline(a, x) && std::getline(b, y)) lines += x != y;
    EXPECT_EQ(1, lines);
    EXPECT_THAT(after, HasSubstr("\"position\": [1, 2, 3.5]"));
}

TEST(EditorFile, SaveAndOpenKeepSceneAndPaint) {
    Folder folder;
    Document document = paintable();
    mustRun(document, "import \"" + (folder.path / "models/crate.glb").string() + "\" name=Crate");
    mustRun(document, "add layer multiplier name=Dry");
    mustRun(document, "stroke Dry size 0.1 value 0.2 path -0.2:0.2:0 0.2:0.3:0");
    std::string error;
    EXPECT_TRUE(unsaved(document));
    const fs::path file = folder.path / "yard.fwscene";
    ASSERT_TRUE(saveDocument(document, file, error)) << error;
    EXPECT_FALSE(unsaved(document));
    EXPECT_EQ("models/crate.glb", document.scene.meshes[0].file);
    EXPECT_EQ(textOf(file), printScene(document.scene));
    EXPECT_FALSE(fs::exists(file.string() + ".new"));

    Document back;
    std::vector<std::string> repairs;
    ASSERT_TRUE(openDocument(file, back, repairs, error)) << error;
    EXPECT_THAT(repairs, ::testing::IsEmpty());
    EXPECT_TRUE(back.scene == document.scene);
    EXPECT_TRUE(back.images == document.images);
    EXPECT_FALSE(unsaved(back));

    // In another folder: paths start there, the old file stays, and undo still reaches the start.
    const fs::path other = folder.path / "shots/night.fwscene";
    ASSERT_TRUE(saveDocument(document, other, error)) << error;
    EXPECT_EQ("../models/crate.glb", document.scene.meshes[0].file);
    ASSERT_TRUE(openDocument(file, back, repairs, error)) << error;
    EXPECT_TRUE(back.images == document.images);
    while (undo(document)) {
    }
    EXPECT_TRUE(document.scene.meshes.empty());
    EXPECT_TRUE(unsaved(document));
}

// A crash copy lies in another folder than its scene and has paths from there.
TEST(EditorFile, ARecoveryCopyIsUnsavedWorkOnItsOriginal) {
    Folder folder;
    Document document = paintable();
    const fs::path file = folder.path / "scenes/yard.fwscene",
                   copy = folder.path / "state/kept.fwscene";
    std::string error;
    document.folder = folder.path;
    mustRun(document, "import \"models/crate.glb\" name=Crate");
    mustRun(document, "add layer multiplier name=Dry");
    ASSERT_TRUE(saveDocument(document, file, error)) << error;
    mustRun(document, "fill Dry value 0.3");
    const std::string meshes = document.scene.meshes.at(0).file;
    ASSERT_TRUE(saveCopy(document, copy, error)) << error;
    EXPECT_TRUE(unsaved(document));
    // Each copy replaces the one before with its images.
    mustRun(document, "fill Dry value 0.7");
    ASSERT_TRUE(saveCopy(document, copy, error)) << error;
    EXPECT_EQ(2, std::distance(fs::directory_iterator(copy.parent_path()), {}));

    Document back;
    std::vector<std::string> repairs;
    ASSERT_TRUE(openCopy(copy, file, back, repairs, error)) << error;
    EXPECT_THAT(repairs, ::testing::IsEmpty());
    EXPECT_TRUE(unsaved(back));
    EXPECT_EQ(file, back.file);
    EXPECT_EQ(meshes, back.scene.meshes.at(0).file);  // from the original's folder
    EXPECT_TRUE(back.images == document.images);
    // Saving writes the work to the original; the copy's images may be deleted.
    ASSERT_TRUE(saveDocument(back, back.file, error)) << error;
    fs::remove_all(copy.parent_path());
    ASSERT_TRUE(openDocument(file, back, repairs, error)) << error;
    EXPECT_THAT(repairs, ::testing::IsEmpty());
    EXPECT_TRUE(back.images == document.images);
}

TEST(EditorFile, AFailedSaveExplainsAndKeepsTheOldFile) {
    Folder folder;
    Document document = newDocument();
    std::string error;
    EXPECT_FALSE(saveDocument(document, "/proc/nowhere/a.fwscene", error));
    EXPECT_THAT(error, HasSubstr("/proc/nowhere/a.fwscene is not saved"));
    std::ofstream(folder.path / "plain") << "x";
    EXPECT_FALSE(saveDocument(document, folder.path / "plain" / "a.fwscene", error));
    EXPECT_TRUE(document.file.empty());
}

TEST(EditorFile, AHundredKillsLeaveAValidFile) {
    Folder folder;
    const fs::path file = folder.path / "yard.fwscene";
    Document document = paintable();
    mustRun(document, "import crate.glb name=Crate");
    mustRun(document, "add layer multiplier name=Dry");
    std::string error;
    ASSERT_TRUE(saveDocument(document, file, error)) << error;
    const auto paintAndSave = [&](int kill, int i) {
        std::string ignored;
        runLine(document,
                "set Crate position " + std::to_string(kill) + " " + std::to_string(i) + " 0",
                ignored);
        runLine(document, "fill Dry value 0." + std::to_string(i % 10), ignored);
        return saveDocument(document, file, ignored);
    };
    // The child's time for its first saves, by its own clock, gives the range of kill times on any
    // machine and build.
    constexpr int kFirstSaves = 4;
    const pid_t first = ::fork();
    ASSERT_GE(first, 0);
    if (first == 0) {
        for (int i = 0; i < kFirstSaves; ++i)
            if (!paintAndSave(0, i)) ::_exit(1);
        ::_exit(0);
    }
    int ended = 0;
    rusage used{};
    ASSERT_EQ(first, ::wait4(first, &ended, 0, &used));
    ASSERT_TRUE(WIFEXITED(ended) && WEXITSTATUS(ended) == 0);
    const uint64_t whole = uint64_t(used.ru_utime.tv_sec + used.ru_stime.tv_sec) * 1'000'000'000 +
                           uint64_t(used.ru_utime.tv_usec + used.ru_stime.tv_usec) * 1'000;  // ns
    std::mt19937 random(5);
    size_t saves = 0;
    for (int kill = 1; kill <= 100; ++kill) {
        const pid_t child = ::fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            for (int i = 0;; ++i)
                if (!paintAndSave(kill, i)) ::_exit(1);
        }
        clockid_t clock{};
        ASSERT_EQ(0, ::clock_getcpuclockid(child, &clock));
        const uint64_t until = whole / 20 + random() % whole;  // ns
        uint64_t ran = 0;                                      // ns
        for (int waits = 0; waits < 100'000 && ran < until; ++waits) {
            ::usleep(200);
            timespec now{};
            if (::clock_gettime(clock, &now) != 0) break;
            ran = uint64_t(now.tv_sec) * 1'000'000'000 + uint64_t(now.tv_nsec);
        }
        ::kill(child, SIGKILL);
        int status = 0;
        ASSERT_EQ(child, ::waitpid(child, &status, 0));
        ASSERT_TRUE(WIFSIGNALED(status));
        Document back;
        std::vector<std::string> repairs;
        ASSERT_TRUE(openDocument(file, back, repairs, error)) << error;
        ASSERT_THAT(repairs, ::testing::IsEmpty());
        ASSERT_EQ("Crate", back.scene.meshes.at(0).name);
        // The paint belongs to the same step as the scene.
        if (back.scene.meshes[0].position[0] == float(kill)) {
            ++saves;
            const auto step = static_cast<uint32_t>(back.scene.meshes[0].position[1]);
            ASSERT_EQ(std::lround(0.1 * (step % 10) * 128), back.images.at(2).at(3, 3));
        }
    }
    EXPECT_GT(saves, 20u);
}

TEST(EditorCommands, DamagedLinesAreRefusedWithAMessage) {
    std::mt19937 random(17);
    Document document = paintable();
    std::string message;
    int done = 0, refused = 0;
    while (document.steps.size() <= 20)
        (void)runLine(document, randomLine(random, document.scene), message);
    for (int i = 0; i < 20000; ++i) {
        std::string line = randomLine(random, document.scene);
        for (uint32_t times = random() % 3; times > 0 && !line.empty(); --times) {
            const size_t at = random() % line.size();
            if (random() % 2)
                line[at] = static_cast<char>(random());
            else
                line.erase(at, random() % 6);
        }
        Command command;
        if (!parseCommand(document.scene, line, command, message)) {
            ++refused;
            ASSERT_FALSE(message.empty()) << line;
            continue;
        }
        Document copy = document;
        done += run(copy, command, message);
    }
    EXPECT_GT(done, 2000);
    EXPECT_GT(refused, 2000);
}

TEST(EditorFile, RepairsNameFileFieldValueAndLimit) {
    Document document = newDocument();
    mustRun(document, "add source point name=A");
    mustRun(document, "add source point name=B");
    mustRun(document, "add layer multiplier");
    std::string text = printScene(document.scene);
    const auto replace = [&](const std::string& from, const std::string& to) {
        const size_t at = text.find(from);
        ASSERT_NE(std::string::npos, at) << from;
        text.replace(at, from.size(), to);
    };
    replace("\"radius\": 0.05", "\"radius\": -0.4");
    replace("\"output\": 18", "\"output\": \"hot\"");
    replace("\"shape\": \"point\"", "\"shape\": \"round\"");
    replace("\"id\": 2", "\"id\": 1");
    replace("\"mesh\": 0", "\"mesh\": 77");
    replace("\"up\": [0, 1, 0]", "\"up\": [0, 1]");
    replace("\"length\": 1", "\"lenght\": 1");
    Scene scene;
    std::vector<std::string> repairs;
    std::string error;
    ASSERT_TRUE(readScene(text, "yard.fwscene", scene, repairs, error)) << error;
    const auto reported = [&](const char* part) {
        EXPECT_THAT(repairs, ::testing::Contains(HasSubstr(part)));
    };
    reported("yard.fwscene: sources[0].radius was -0.4 m, below 0 m; it is now 0 m.");
    reported("yard.fwscene: sources[0].output is a text; it takes a number");
    reported("sources[0].shape is \"round\"; it takes match, point, disc");
    reported("sources[1].id is 1, which another object has; it is now 4");
    reported("layers[0].mesh was #77, which is no mesh of the scene");
    reported("settings.up takes 3 numbers");
    reported("sources[0].lenght is not known here");
    reported("next_id is 4; it must be above every id; it is now 5");
    EXPECT_EQ(8u, repairs.size());
    repairs.clear();
    Scene again;
    ASSERT_TRUE(readScene(printScene(scene), "b", again, repairs, error));
    EXPECT_THAT(repairs, ::testing::IsEmpty());
    EXPECT_TRUE(scene == again);
}

TEST(EditorFile, RefusalsNameTheCause) {
    const auto why = [](std::string_view text) {
        Scene scene;
        scene.nextId = 77;
        std::vector<std::string> repairs;
        std::string error;
        EXPECT_FALSE(readScene(text, "x.fwscene", scene, repairs, error));
        EXPECT_EQ(77u, scene.nextId);
        return error;
    };
    EXPECT_THAT(why(""), HasSubstr("x.fwscene was not opened"));
    EXPECT_THAT(why("{\"fwscene\": 1"), HasSubstr("line 1"));
    EXPECT_THAT(why("[]"), HasSubstr("a list"));
    EXPECT_THAT(why("{}"), HasSubstr("has no scene version"));
    EXPECT_THAT(why("{\"fwscene\": 3}"), HasSubstr("fwscene is 3; this program reads up to 2"));
    EXPECT_THAT(why(std::string(200000, '[')), HasSubstr("not opened"));
    EXPECT_THAT(why("\x89PNG\r\n"), HasSubstr("not opened"));
    EXPECT_THAT(why(std::string(size_t{17} << 20, ' ')), HasSubstr("above 16777216"));
}

TEST(EditorFile, DamagedScenesAreRefusedOrRepaired) {
    std::mt19937 random(11);
    Document document = paintable();
    std::string message;
    while (document.steps.size() <= 25)
        (void)runLine(document, randomLine(random, document.scene), message);
    const std::string whole = printScene(document.scene);
    static const char* kSpoilt[] = {"null", "-1",      "1e400", "99999999999999999999",
                                    "\"\"", "[]",      "{}",    "true",
                                    "NaN",  "[[[1]]]", "0.5",   "\\u0000"};
    int refused = 0, mended = 0;
    for (int i = 0; i < fw::test::rounds(10000, 3000); ++i) {
        std::string text = whole;
        for (uint32_t times = 1 + random() % 4; times > 0; --times) {
            if (text.empty()) break;
            const size_t at = random() % text.size();
            switch (random() % 5) {
                case 0:
                    text[at] = static_cast<char>(random());
                    break;
                case 1:
                    text.erase(at, random() % 40);
                    break;
                case 2:
                    text.insert(at, kSpoilt[random() % std::size(kSpoilt)]);
                    break;
                case 3:
                    text.resize(at + 1);
                    break;
                default: {  // another value in place of one
                    const size_t colon = text.find(": ", at);
                    if (colon == std::string::npos) break;
                    const size_t end = text.find_first_of(",\n", colon);
                    text.replace(colon + 2, std::min(end, text.size()) - colon - 2,
                                 kSpoilt[random() % std::size(kSpoilt)]);
                }
            }
        }
        Scene scene;
        std::vector<std::string> repairs;
        std::string error;
        if (!readScene(text, "spoilt", scene, repairs, error)) {
            ++refused;
            ASSERT_THAT(error, HasSubstr("spoilt was not opened: "));
            continue;
        }
        mended += !repairs.empty();
        // A loaded scene is valid.
        Scene again;
        repairs.clear();
        const std::string printed = printScene(scene);
        ASSERT_TRUE(readScene(printed, "again", again, repairs, error)) << error << text;
        ASSERT_TRUE(repairs.empty()) << repairs[0];
        ASSERT_EQ(printed, printScene(again));
    }
    EXPECT_GT(refused, fw::test::rounds(1000, 300));
    EXPECT_GT(mended, fw::test::rounds(500, 150));
}

TEST(EditorScene, AttachedObjectsMoveWithTheirParentAndStayWithoutIt) {
    Document document = newDocument();
    mustRun(document, "import a.glb name=Box position 1 0 0 rotation 0 90 0 scale 2 2 2");
    mustRun(document, "add source point name=Torch position 1 0 -2");
    mustRun(document, "set \"Torch\" sticks_to \"Box\"");
    const auto near = [&](Vec3 expected) {
        const Vec3 at = worldPosition(document.scene, document.scene.sources[0].id);
        for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(expected[k], at[k], 1e-5f) << k;
    };
    near({1, 0, -2});
    EXPECT_NEAR(1.0f, document.scene.sources[0].position[0], 1e-5f);  // along the box's own x
    mustRun(document, "move \"Box\" 0 3 0");
    near({1, 3, -2});
    EXPECT_THAT(refusal(document, "set \"Torch\" sticks_to \"Torch\""), HasSubstr("sticks to it"));
    mustRun(document, "remove \"Box\"");
    EXPECT_EQ(0u, document.scene.sources[0].sticksTo);
    near({1, 3, -2});
}

// A file with one node at (1, 2, 3), rotated so that its z is the mesh's x.
bool poseOfTheHook(const Mesh&, std::string_view node, Pose& pose, std::string& error) {
    error = "a.glb: there is no such node";
    pose = {0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 2, 3, 1};
    return node == "hook";
}

void expectNear(Vec3 expected, Vec3 given) {
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(expected[k], given[k], 1e-5f) << k;
}

TEST(EditorScene, ObjectsAttachedToANodeFollowIt) {
    Document document = newDocument();
    document.nodePose = poseOfTheHook;
    const auto place = [&] { return worldPosition(document.scene, 2, document.nodePose); };
    const auto way = [&] {
        return turnedBy(parentPose(document.scene, 2, document.nodePose),
                        document.scene.sources[0].direction);
    };
    mustRun(document, "import a.glb name=Box position 10 0 0");
    mustRun(document,
            "add source flamethrower name=Jet direction 0 0 1 sticks_to Box sticks_to_node hook");
    expectNear({11, 2, 3}, place());
    expectNear({1, 0, 0}, way());
    mustRun(document, "set Box rotation 0 90 0");
    expectNear({13, 2, -1}, place());
    expectNear({0, 0, -1}, way());
    // Moving it by hand works in world space, and only once if its parent moves too.
    mustRun(document, "move Jet 1 0 0");
    expectNear({14, 2, -1}, place());
    mustRun(document, "move \"Jet\" \"Box\" 0 1 0");
    expectNear({14, 3, -1}, place());
    // Detached and attached again it stays in place.
    const HeatSource held = document.scene.sources[0];
    mustRun(document, "set Jet sticks_to none");
    EXPECT_EQ("", document.scene.sources[0].sticksToNode);
    expectNear({14, 3, -1}, document.scene.sources[0].position);
    expectNear({0, 0, -1}, document.scene.sources[0].direction);
    mustRun(document, "set Jet sticks_to Box sticks_to_node hook");
    EXPECT_EQ("Attach Jet", document.steps[document.at].name);
    expectNear(held.position, document.scene.sources[0].position);
    expectNear(held.direction, document.scene.sources[0].direction);

    const std::string before = printScene(document.scene);
    EXPECT_THAT(refusal(document, "set Jet sticks_to_node eye"),
                HasSubstr("sticks_to_node is \"eye\"; a.glb: there is no such node"));
    mustRun(document, "add source name=Loose");
    EXPECT_THAT(refusal(document, "set Loose sticks_to_node hook"),
                HasSubstr("a part of a mesh that \"Loose\" sticks to"));
    undo(document);
    EXPECT_EQ(before, printScene(document.scene));

    // A game's scene has no node, and everything else is unchanged.
    const Scene placed = placedScene(document.scene, document.nodePose);
    EXPECT_EQ("", placed.sources[0].sticksToNode);
    expectNear(place(), worldPosition(placed, 2));
    expectNear(way(), turnedBy(parentPose(placed, 2), placed.sources[0].direction));
    std::vector<std::string> problems;
    document.scene.sources[0].sticksToNode = "eye";
    (void)placedScene(document.scene, document.nodePose, &problems);
    ASSERT_EQ(1u, problems.size());
    EXPECT_THAT(problems[0], HasSubstr("\"Jet\" sticks to \"Box\" itself: a.glb"));
    document.scene.sources[0].sticksToNode = "hook";
    mustRun(document, "remove Box");
    expectNear({14, 3, -1}, document.scene.sources[0].position);
    expectNear({0, 0, -1}, document.scene.sources[0].direction);
}

// A parent of almost no size cannot carry distant objects: they stay within the file's limits.
TEST(EditorScene, ObjectsAttachedToATinyParentStayInRange) {
    Document document = newDocument();
    mustRun(document, "import a.glb name=Grain scale 1e-30 1e-30 1e-30 rotation 0 45 0");
    mustRun(document, "add emitter line position 5 0 0 direction 1000 0 1000 extent 100 0 100");
    mustRun(document, "set #2 sticks_to Grain");
    Scene again;
    std::vector<std::string> repairs;
    std::string error;
    ASSERT_TRUE(readScene(printScene(document.scene), "x", again, repairs, error)) << error;
    EXPECT_THAT(repairs, ::testing::IsEmpty());
    EXPECT_EQ(document.scene, again);
}

// A flame on a lamp on a node: each follows the one before.
TEST(EditorScene, ChainsMayEndAtANode) {
    Document document = newDocument();
    document.nodePose = poseOfTheHook;
    mustRun(document, "import a.glb name=Box scale 2 2 2");
    mustRun(document, "add source name=Lamp position 0 1 0 sticks_to Box sticks_to_node hook");
    mustRun(document, "add emitter line name=Sparks position 0 0 1 extent 0 0 2 sticks_to Lamp");
    const Vec3 place = worldPosition(document.scene, 3, document.nodePose);
    expectNear({4, 6, 6}, place);
    const Scene placed = placedScene(document.scene, document.nodePose);
    EXPECT_EQ(1u, placed.emitters[0].sticksTo);
    expectNear(place, worldPosition(placed, 3));
    expectNear({2, 0, 0}, placed.emitters[0].extent);
}

// A hundred in a chain, each a tenth of a metre from the one before: all of them count.
TEST(EditorScene, ChainsMayBeLong) {
    Document document = newDocument();
    constexpr int kRow = 100;
    for (int i = 0; i < kRow; ++i) {
        const std::string name = "T" + std::to_string(i);
        mustRun(document, "add source point name=" + name);
        if (i > 0) mustRun(document, "set " + name + " sticks_to T" + std::to_string(i - 1));
    }
    const std::vector<HeatSource>& row = document.scene.sources;
    ASSERT_EQ(size_t(kRow), row.size());
    EXPECT_EQ(size_t(kRow - 1), ancestorsOf(document.scene, row.back().sticksTo).size());
    for (HeatSource& one : document.scene.sources) one.position = {0.1f, 0, 0};
    const auto near = [&](float x) {
        EXPECT_NEAR(x, worldPosition(document.scene, row.back().id)[0], 1e-4f);
    };
    near(10);
    const std::string last = "T" + std::to_string(kRow - 1);
    mustRun(document, "move #" + std::to_string(row.front().id) + " #" +
                          std::to_string(row.back().id) + " 1 0 0");  // moves along, once
    near(11);
    EXPECT_THAT(refusal(document, "set T0 sticks_to " + last), HasSubstr("sticks to it"));
    mustRun(document, "add source point name=Tail position 0 1 0");
    mustRun(document, "set Tail sticks_to " + last);
    mustRun(document, "remove Tail");
    // A cycle in a file: only its members are reported.
    Scene cyclic = document.scene;
    cyclic.sources[2].sticksTo = cyclic.sources[4].id;
    const std::vector<ObjectId> holders = ancestorsOf(cyclic, row.back().id);
    EXPECT_EQ(size_t(kRow - 2) + 1, holders.size());
    EXPECT_EQ(row[4].id, holders.back());
    std::vector<std::string> repairs;
    EXPECT_TRUE(repairReferences(cyclic, &repairs));
    ASSERT_EQ(1u, repairs.size());
    EXPECT_THAT(repairs[0], HasSubstr("sources[2].sticks_to"));
}

TEST(EditorFile, LoadsVersion1AttachedEmitters) {
    Scene scene;
    std::vector<std::string> repairs;
    std::string error;
    ASSERT_TRUE(readScene(R"({"fwscene": 1, "next_id": 9,
        "meshes": [{"id": 1, "name": "Box", "rotation": [0, 90, 0]}],
        "sources": [{"id": 2, "name": "Jet", "direction": [1, 0, 0], "sticks_to": 1},
                    {"id": 3, "name": "Free", "direction": [1, 0, 0], "sticks_to_node": "hook"}]})",
                          "x", scene, repairs, error))
        << error;
    expectNear({1, 0, 0}, turnedBy(parentPose(scene, 2), scene.sources[0].direction));
    expectNear({0, 0, 1}, scene.sources[0].direction);
    EXPECT_EQ((Vec3{1, 0, 0}), scene.sources[1].direction);
    EXPECT_EQ("", scene.sources[1].sticksToNode);
    ASSERT_EQ(1u, repairs.size());
    EXPECT_THAT(repairs[0], HasSubstr("sources[1].sticks_to_node is \"hook\""));
    const std::string printed = printScene(scene);
    EXPECT_THAT(printed, HasSubstr("\"fwscene\": 2"));
    Scene again;
    ASSERT_TRUE(readScene(printed, "again", again, repairs, error)) << error;
    EXPECT_EQ(scene, again);
}

TEST(EditorScene, KeysInterpolateLinearly) {
    const Keys keys = {{1, 2}, {3, 4}};
    EXPECT_EQ(1, valueAt({}, 5));
    EXPECT_EQ(2, valueAt(keys, 0));
    EXPECT_EQ(3, valueAt(keys, 2));
    EXPECT_EQ(4, valueAt(keys, 9));
}

TEST(EditorPaint, StrokesCrossSeams) {
    Stroke stroke;
    stroke.size = 0.1f;
    stroke.value = 0;
    stroke.hardness = 1;
    stroke.path = {{0, 0.25f, 0}};  // at the seam between the two islands
    const PaintImage image =
        applyStroke(sheet(), PaintMultiplier, makePaintImage(PaintMultiplier, 64, 32), stroke);
    for (uint32_t y = 0; y < 32; ++y)
        for (uint32_t x = 0; x < 64; ++x) {
            const size_t i = size_t{y} * 64 + x;
            const float dx = sheet().positions[i * 3], dy = sheet().positions[i * 3 + 1] - 0.25f;
            const bool within = std::sqrt(dx * dx + dy * dy) < 0.1f;
            EXPECT_EQ(within ? 0 : 128, image.at(x, y)) << x << " " << y;
        }
    EXPECT_EQ(0, image.at(63, 16));  // right border of the map: left of the seam
    EXPECT_EQ(0, image.at(0, 16));
}

TEST(EditorPaint, StrokesDoNotDependOnTheirPieces) {
    Stroke stroke;
    stroke.value = 2;
    stroke.strength = 0.7f;
    stroke.path = {{-0.3f, 0.1f, 0}, {0, 0.3f, 0}, {0.2f, 0.1f, 0}};
    const PaintImage empty = makePaintImage(PaintMultiplier, 64, 32);
    const PaintImage whole = applyStroke(sheet(), PaintMultiplier, empty, stroke);
    StrokePainter painter(sheet(), PaintMultiplier, empty, stroke);
    PaintedArea all;
    for (const Vec3& point : stroke.path) {
        const PaintedArea area = painter.extend(point);
        EXPECT_FALSE(area.empty());
        all = area;
    }
    EXPECT_TRUE(whole == painter.image());
    // A path that goes back over itself is no stronger.
    stroke.path.insert(stroke.path.end(), {{0, 0.3f, 0}, {-0.3f, 0.1f, 0}});
    EXPECT_TRUE(whole == applyStroke(sheet(), PaintMultiplier, empty, stroke));
}

TEST(EditorPaint, FillsStayWithinTheirCriterion) {
    const PaintImage empty = makePaintImage(PaintMoisture, 64, 32);
    FillRequest fill;
    fill.value = 1;
    fill.by = FillBy::Island;
    fill.at = {0.4f, 0.2f, 0};
    PaintImage image = applyFill(sheet(), PaintMoisture, empty, fill, {0, 1, 0});
    EXPECT_EQ(255, image.at(10, 5));
    EXPECT_EQ(0, image.at(40, 5));
    fill.by = FillBy::Material;
    fill.material = 1;
    image = applyFill(sheet(), PaintMoisture, empty, fill, {0, 1, 0});
    EXPECT_EQ(0, image.at(10, 5));
    EXPECT_EQ(255, image.at(10, 20));
    fill.by = FillBy::Slope;  // the sheet stands upright: 90 degrees
    fill.slopeLow = 80;
    fill.slopeHigh = 100;
    image = applyFill(sheet(), PaintMoisture, empty, fill, {0, 1, 0});
    EXPECT_EQ(255, image.at(10, 5));
    fill.slopeHigh = 85;
    image = applyFill(sheet(), PaintMoisture, empty, fill, {0, 1, 0});
    EXPECT_EQ(0, image.at(10, 5));
}

TEST(EditorPaint, FillsByCurvatureFindEdgesAndHollows) {
    // A strip: flat, bent outwards with a radius of 0.1 m, flat, bent inwards.
    PaintSurface surface;
    surface.width = 120;
    surface.height = 16;
    surface.spacing = 0.01f;
    for (uint32_t y = 0; y < surface.height; ++y) {
        float x = 0, up = 0, angle = 0;  // along the strip
        for (uint32_t i = 0; i < surface.width; ++i) {
            surface.positions.insert(surface.positions.end(), {x, up, 0.01f * float(y)});
            surface.normals.insert(surface.normals.end(), {-std::sin(angle), std::cos(angle), 0});
            const float bend = i >= 30 && i < 60 ? 10.0f : i >= 90 ? -10.0f : 0.0f;
            angle -= bend * surface.spacing;
            x += surface.spacing * std::cos(angle);
            up += surface.spacing * std::sin(angle);
        }
    }
    surface.real.assign(size_t{surface.width} * surface.height, 1);
    indexSurface(surface);
    FillRequest fill;
    fill.value = 1;
    fill.by = FillBy::Curvature;
    const PaintImage empty = makePaintImage(PaintMoisture, surface.width, surface.height);
    const auto filled = [&](float low, float high) {
        fill.curveLow = low;
        fill.curveHigh = high;
        const PaintImage image = applyFill(surface, PaintMoisture, empty, fill, {0, 1, 0});
        std::string taken;  // in the middle of each of the four parts
        for (const uint32_t x : {15u, 45u, 75u, 105u}) taken += image.at(x, 8) ? 'x' : '.';
        return taken;
    };
    EXPECT_EQ(".x..", filled(2, 100));
    EXPECT_EQ("...x", filled(-100, -2));
    EXPECT_EQ("x.x.", filled(-0.5f, 0.5f));

    Document document = paintable();
    mustRun(document, "import crate.glb name=Crate");
    mustRun(document, "add layer multiplier name=Dry");
    const std::string line = "fill Dry value 1 by curvature curvature -50 -2";
    Command command;
    std::string error;
    ASSERT_TRUE(parseCommand(document.scene, line, command, error)) << error;
    EXPECT_THAT(printCommand(document.scene, command), HasSubstr("by curvature curvature -50 -2"));
}

TEST(EditorPaint, SmoothingWorksAcrossASeam) {
    std::vector<uint8_t> values(64 * 32, 0);
    for (size_t i = 0; i < values.size(); ++i)
        if (sheet().positions[i * 3] > 0) values[i] = 255;
    const PaintImage edge = paintImageOf(PaintMoisture, 64, 32, values);
    Stroke stroke;
    stroke.mode = BrushMode::Smooth;
    stroke.size = 0.2f;
    stroke.hardness = 1;
    stroke.path = {{0, 0.25f, 0}};
    const PaintImage image = applyStroke(sheet(), PaintMoisture, edge, stroke);
    EXPECT_GT(image.at(63, 16), 60);  // just left of the seam
    EXPECT_LT(image.at(0, 16), 195);  // just right of it
}

}  // namespace
