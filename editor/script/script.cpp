// See script.h.
#include "script/script.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <thread>

#include "document/text.h"
#include "import/float_picture.h"
#include "script/output_lines.h"

namespace fwedit {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

bool numberOf(const std::string& word, double& value) {
    const char* end = word.data() + word.size();
    const auto [at, code] = std::from_chars(word.data(), end, value);
    return code == std::errc{} && at == end && std::isfinite(value);
}

bool times(const Words& words, uint32_t& count, std::string& error) {
    double value = 1;
    if (!need(words, 1, 2, "a number of steps", error)) return false;
    if (words.size() == 2 && (!numberOf(words[1], value) || value < 0 || value > 1e6)) {
        error = "\"" + words[1] + "\" is no number of steps from 0 to 1000000";
        return false;
    }
    count = static_cast<uint32_t>(value);
    return true;
}

bool openScene(ScriptHost& host, const Words& words, std::string& error) {
    std::vector<std::string> repairs;
    if (!need(words, 2, 2, "open FILE", error) ||
        !openDocument(host.folder / words[1], host.document, repairs, error))
        return false;
    for (const std::string& repair : repairs) host.say(repair);
    host.burn = nullptr;
    return true;
}

bool saveScene(ScriptHost& host, const Words& words, std::string& error) {
    if (!need(words, 1, 2, "save [FILE]", error)) return false;
    const fs::path file = words.size() == 2 ? host.folder / words[1] : host.document.file;
    if (file.empty()) {
        error = "the scene has no file yet";
        return false;
    }
    return saveDocument(host.document, file, error);
}

bool play(ScriptHost& host, const Words& words, std::string& error) {
    double to = 0;
    if (!need(words, 2, 2, "play SECONDS", error)) return false;
    if (!numberOf(words[1], to) || to < 0 || to > 100000) {
        error = "\"" + words[1] + "\" is no time from 0 to 100000 s";
        return false;
    }
    host.playhead = to;
    return true;
}

bool shot(ScriptHost& host, const Words& words, std::string& error) {
    constexpr const char* kUsage = "shot FILE [WIDTHxHEIGHT] [neutral [YAW PITCH]]";
    uint32_t width = 640, height = 360;
    if (!need(words, 2, 6, kUsage, error)) return false;
    size_t at = 2;
    if (at < words.size() && words[at] != "neutral" &&
        !parseSize(words[at++], width, height, error))
        return false;
    if (at == words.size()) return writeShot(host, host.folder / words[1], width, height, error);
    fwmodel::NeutralCamera camera;
    const bool turned = at + 3 == words.size();
    double yaw = 0, pitch = 0;
    if (words[at] != "neutral" || (!turned && at + 1 != words.size()) ||
        (turned && (!numberOf(words[at + 1], yaw) || !numberOf(words[at + 2], pitch)))) {
        error = std::string("it takes: ") + kUsage;
        return false;
    }
    if (turned) camera = {static_cast<float>(yaw), static_cast<float>(pitch)};
    FwContext* context = host.device(error);
    std::vector<uint8_t> rgba;
    return context && burnToPlayhead(host, context, error) &&
           shootNeutral(*host.burn, camera, width, height, rgba, error) &&
           writePixels(host.folder / words[1], width, height, rgba, error);
}

bool recorded(ScriptHost& host, std::string& error) {
    if (host.recordRevision == host.document.revision) return true;
    FwContext* cpu = host.cpu(error);
    if (!cpu || !recordBurn(cpu, host.document.scene, host.document.images,
                            baseFolder(host.document), host.assets, host.record, error))
        return false;
    host.recordRevision = host.document.revision;
    return true;
}

bool why(ScriptHost& host, const Words& words, std::string& error) {
    double x = 0, y = 0, z = 0;
    if (!need(words, 5, 5, "why MESH X Y Z", error)) return false;
    const ObjectId mesh = findByWord(host.document.scene, words[1]);
    if (!numberOf(words[2], x) || !numberOf(words[3], y) || !numberOf(words[4], z)) {
        error = "a place is three numbers in m";
        return false;
    }
    FwContext* cpu = host.cpu(error);
    if (!cpu || !burnToPlayhead(host, cpu, error)) return false;
    WhyAnswer answer;
    if (!askWhy(*host.burn, host.document.images, mesh,
                {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)}, answer,
                error))
        return false;
    host.say(answer.answer);
    for (const std::string& cause : answer.causes) host.say("  " + cause);
    if (!answer.forecast.empty()) host.say("  " + answer.forecast);
    return true;
}

bool expectCount(ScriptHost& host, const Words& words, std::string& error) {
    Kind kind{};
    double wanted = 0;
    if (!need(words, 4, 4, "expect count KIND NUMBER", error)) return false;
    if (!kindOfKey(words[2], kind) || kind >= Kind::Settings || !numberOf(words[3], wanted)) {
        error = "\"" + words[2] + " " + words[3] + "\" is no kind of object and number";
        return false;
    }
    size_t count = 0;
    forEachList(host.document.scene, [&](Kind which, const auto& list) {
        if (which == kind) count = list.size();
    });
    if (static_cast<double>(count) == wanted) return true;
    error = "there are " + std::to_string(count) + ", not " + words[3];
    return false;
}

bool expectLit(ScriptHost& host, const Words& words, std::string& error) {
    double limit = 0;
    if (!need(words, 5, 5, "expect lit MESH above|below SHARE", error)) return false;
    if ((words[3] != "above" && words[3] != "below") || !numberOf(words[4], limit)) {
        error = "it takes: expect lit MESH above|below SHARE";
        return false;
    }
    if (!recorded(host, error)) return false;
    const ObjectId mesh = findByWord(host.document.scene, words[2]);
    for (const ArrivalField& field : host.record.fields) {
        if (field.mesh != mesh) continue;
        const double share = litShare(field, static_cast<float>(host.playhead));
        if (words[3] == "above" ? share > limit : share < limit) return true;
        error = std::to_string(share) + " of \"" + words[2] + "\" caught by " +
                std::to_string(host.playhead) + " s";
        return false;
    }
    error = "\"" + words[2] + "\" is no mesh that burns";
    return false;
}

bool expectField(ScriptHost& host, const Words& words, std::string& error) {
    if (words.size() < 4) return need(words, 4, 4, "expect OBJECT FIELD VALUE", error);
    const Scene& scene = host.document.scene;
    Kind kind{};
    ObjectId id = 0;
    if (words[1] == "settings" || words[1] == "camera") {
        kindOfKey(words[1], kind);
    } else {
        id = findByWord(scene, words[1]);
        if (!findObject(scene, id, &kind)) {
            error = "there is no object \"" + words[1] + "\"";
            return false;
        }
    }
    const FieldInfo* info = findField(kind, words[2]);
    if (!info) {
        error = "a " + std::string(kindKey(kind)) + " has no field \"" + words[2] + "\"";
        return false;
    }
    Value is, wanted;
    const std::vector<std::string> rest(words.begin() + 3, words.end());
    if (!parseValue(scene, *info, rest, wanted, error)) return false;
    getField(scene, kind, id, words[2], is);
    const std::string text = printValue(scene, *info, is);
    if (text == printValue(scene, *info, wanted)) return true;
    error = words[2] + " is " + text;
    return false;
}

// Compares two images of equal size by their mean difference, [0, 1].
bool expectAlike(ScriptHost& host, const Words& words, std::string& error) {
    double limit = 0;
    fwimport::FloatPicture a, b;
    if (!need(words, 5, 5, "expect alike FILE FILE SHARE", error)) return false;
    if (!numberOf(words[4], limit) || limit < 0) {
        error = "\"" + words[4] + "\" is no share from 0 on";
        return false;
    }
    if (!fwimport::readPicture(host.folder / words[2], a, error) ||
        !fwimport::readPicture(host.folder / words[3], b, error))
        return false;
    if (a.width != b.width || a.height != b.height || a.channels != b.channels) {
        error = "the pictures differ in size";
        return false;
    }
    double sum = 0;
    for (size_t i = 0; i < a.values.size(); ++i)
        sum += std::fabs(double{a.values[i]} - double{b.values[i]});
    const double mean = sum / static_cast<double>(std::max<size_t>(a.values.size(), 1));
    host.say("the pictures differ by " + std::to_string(mean));
    error = "they differ by " + std::to_string(mean) + ", more than " + words[4];
    return mean <= limit;
}

// Compares the two halves of an image by their mean difference.
bool expectHalves(ScriptHost& host, const Words& words, std::string& error) {
    double limit = 0;
    fwimport::FloatPicture picture;
    if (!need(words, 5, 5, "expect halves FILE above|below SHARE", error)) return false;
    if ((words[3] != "above" && words[3] != "below") || !numberOf(words[4], limit)) {
        error = "it takes: expect halves FILE above|below SHARE";
        return false;
    }
    if (!fwimport::readPicture(host.folder / words[2], picture, error)) return false;
    double sum = 0;
    const uint32_t half = picture.width / 2;
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < half; ++x)
            for (uint32_t c = 0; c < picture.channels; ++c)
                sum += std::fabs(double{picture.at(x, y, c)} - double{picture.at(x + half, y, c)});
    const double mean = sum / std::max(1.0, double(picture.height) * half * picture.channels);
    host.say("the halves differ by " + std::to_string(mean));
    error = "the halves differ by " + std::to_string(mean);
    return words[3] == "above" ? mean > limit : mean < limit;
}

bool expect(ScriptHost& host, const Words& words, std::string& error) {
    if (words.size() < 2) return need(words, 2, 2, "expect WHAT ...", error);
    const Document& document = host.document;
    if (words[1] == "count") return expectCount(host, words, error);
    if (words[1] == "lit") return expectLit(host, words, error);
    if (words[1] == "alike") return expectAlike(host, words, error);
    if (words[1] == "halves") return expectHalves(host, words, error);
    if (words.size() == 3 && words[1] == "unsaved") {
        if ((words[2] == "yes") == unsaved(document)) return true;
        error = std::string("the scene is ") + (unsaved(document) ? "not saved" : "saved");
        return false;
    }
    if (words.size() == 3 && words[1] == "step") {
        const std::string& name = document.steps[document.at].name;
        if (name == words[2]) return true;
        error = "the last step is \"" + name + "\"";
        return false;
    }
    if (words.size() == 3 && words[1] == "same") {
        std::ifstream stream(host.folder / words[2], std::ios::binary);
        const std::string text((std::istreambuf_iterator<char>(stream)), {});
        if (text == printScene(document.scene)) return true;
        error = "the scene is not the same as " + words[2];
        return false;
    }
    return expectField(host, words, error);
}

bool drag(ScriptHost& host, const Words& words, std::string& error) {
    if (!need(words, 2, 2, "drag begin|end|cancel", error)) return false;
    if (words[1] == "begin")
        beginDrag(host.document);
    else if (words[1] == "end")
        endDrag(host.document);
    else if (words[1] == "cancel")
        cancelDrag(host.document);
    else {
        error = "\"" + words[1] + "\" is none of begin, end, cancel";
        return false;
    }
    return true;
}

bool refuse(ScriptHost& host, const std::string& line, std::string& error) {
    const size_t at = line.find("refuse") + 6;
    std::string message;
    if (runLine(host.document, std::string_view(line).substr(at), message)) {
        error = "the command succeeded";
        return false;
    }
    host.say("refused: " + message);
    return true;
}

bool printReport(ScriptHost& host, std::string& error) {
    FwContext* cpu = host.cpu(error);
    if (!cpu || !burnToPlayhead(host, cpu, error)) return false;
    for (const std::string& line : host.burn->report) host.say(line);
    for (const BurnMesh& mesh : host.burn->meshes)
        for (const std::string& line : mesh.model->notes) host.say(line);
    return true;
}

bool printHashes(ScriptHost& host, std::string& error) {
    FwContext* cpu = host.cpu(error);
    std::vector<std::string> lines;
    if (!cpu || !burnToPlayhead(host, cpu, error)) return false;
    requestHashes(*host.burn);
    if (fwWorld_Step(host.burn->world, 0) < 0 || fetchHashes(*host.burn, lines) != FW_OK) {
        error = "the burn maps cannot be read";
        return false;
    }
    for (const std::string& line : lines) host.say(line);
    return true;
}

// Waits until the sample shows the current scene.
bool awaitLink(ScriptHost& host, std::string& error) {
    constexpr auto kPatience = std::chrono::seconds(60);
    const auto begun = std::chrono::steady_clock::now();
    while (!host.link.shown(host.document)) {
        host.link.follow(host.document);
        if (!host.link.connected()) {
            error = host.link.problem().empty() ? "there is no link" : host.link.problem();
            return false;
        }
        if (std::chrono::steady_clock::now() - begun > kPatience) {
            error = "the sample does not answer";
            return false;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    if (!host.link.answer().empty()) host.say(host.link.answer());
    return true;
}

bool link(ScriptHost& host, const Words& words, std::string& error) {
    double port = 0;
    if (!need(words, 2, 2, "link PORT|wait|off", error)) return false;
    if (words[1] == "wait") return awaitLink(host, error);
    if (words[1] == "off") {
        host.link.disconnect();
        return true;
    }
    if (!numberOf(words[1], port) || port < 1 || port > 65535 || port != std::floor(port)) {
        error = "\"" + words[1] + "\" is no port from 1 to 65535, nor wait or off";
        return false;
    }
    return host.link.connect(static_cast<uint16_t>(port), error);
}

// Runs commands that exist only in scripts. `known` false: a document command.
bool runOwn(ScriptHost& host, const Words& words, const std::string& line, bool& known,
            std::string& error) {
    const std::string& verb = words[0];
    uint32_t count = 0;
    if (verb == "new") {
        Document fresh = newDocument();
        fresh.surface = host.document.surface;
        fresh.nodePose = host.document.nodePose;
        fresh.folder = host.folder;
        fresh.revision = host.document.revision + 1;
        host.document = std::move(fresh);
        host.burn = nullptr;
        host.playhead = 0;
        return true;
    }
    if (verb == "open") return openScene(host, words, error);
    if (verb == "save") return saveScene(host, words, error);
    if (verb == "undo" || verb == "redo") {
        if (!times(words, count, error)) return false;
        for (uint32_t i = 0; i < count; ++i)
            if (!(verb == "undo" ? undo(host.document) : redo(host.document))) {
                error = "there is nothing more to " + verb;
                return false;
            }
        return true;
    }
    if (verb == "drag") return drag(host, words, error);
    if (verb == "play") return play(host, words, error);
    if (verb == "shot") return shot(host, words, error);
    if (verb == "frame") return frameScene(host, error);
    if (verb == "burn") return recorded(host, error);
    if (verb == "why") return why(host, words, error);
    if (verb == "report") return printReport(host, error);
    if (verb == "hash") return printHashes(host, error);
    if (verb == "link") return link(host, words, error);
    if (verb == "expect") return expect(host, words, error);
    if (verb == "refuse") return refuse(host, line, error);
    return runOutputLine(host, words, known, error);
}

}  // namespace

ScriptHost::ScriptHost(fs::path begin) : folder(std::move(begin)), document(newDocument()) {
    say = [](const std::string&) {};
    document.folder = folder;
    document.surface = [this](const Scene& scene, ObjectId mesh) -> const PaintSurface* {
        const Mesh* found = findIn(scene.meshes, mesh);
        std::string error;
        FwContext* context = cpu(error);
        if (!found || !context) return nullptr;
        const auto surface = paintSurfaceOf(context, *found, baseFolder(document), assets, error);
        if (!surface) say(error);
        return surface.get();  // the assets own it
    };
    document.nodePose = [this](const Mesh& mesh, std::string_view node, Pose& pose,
                               std::string& error) {
        const auto model = modelOf(mesh, baseFolder(document), assets, error);
        return model && nodePoseOf(*model, mesh, node, pose, error);
    };
}

ScriptHost::~ScriptHost() {
    burn = nullptr;
    fwDestroyContext(device_);
    fwDestroyContext(cpu_);
}

FwContext* ScriptHost::device(std::string& error) {
    if (device_) return device_;
    const FwContextDef def = fwDefaultContextDef();
    FwErrorInfo info{};
    if (fwCreateContext(&def, &device_, &info) < 0) error = info.message;
    return device_;
}

FwContext* ScriptHost::cpu(std::string& error) {
    if (cpu_) return cpu_;
    FwContextDef def = fwDefaultContextDef();
    def.backend = FW_BACKEND_CPU;
    FwErrorInfo info{};
    if (fwCreateContext(&def, &cpu_, &info) < 0) error = info.message;
    return cpu_;
}

bool burnToPlayhead(ScriptHost& host, FwContext* context, std::string& error) {
    const bool stale = !host.burn || host.burnRevision != host.document.revision ||
                       host.burn->context != context || host.burn->time > host.playhead + 1e-6;
    if (stale) {
        host.burn = nullptr;
        host.burn = createBurn(context, host.document.scene, host.document.images,
                               baseFolder(host.document), host.assets, error);
        if (!host.burn) return false;
        host.burnRevision = host.document.revision;
        for (const std::string& line : host.burn->report) host.say(line);
    }
    return runBurn(*host.burn, host.playhead, error);
}

bool parseSize(const std::string& word, uint32_t& width, uint32_t& height, std::string& error) {
    unsigned w = 0, h = 0;
    char rest = 0;
    if (std::sscanf(word.c_str(), "%ux%u%c", &w, &h, &rest) != 2 || w < 1 || h < 1 || w > 8192 ||
        h > 8192) {
        error = "\"" + word + "\" is no size from 1x1 to 8192x8192";
        return false;
    }
    width = w;
    height = h;
    return true;
}

bool writeShot(ScriptHost& host, const fs::path& file, uint32_t width, uint32_t height,
               std::string& error) {
    FwContext* context = host.device(error);
    std::vector<uint8_t> rgba;
    if (!context || !burnToPlayhead(host, context, error) ||
        !shootBurn(*host.burn, width, height, rgba, error))
        return false;
    return writePixels(file, width, height, rgba, error);
}

bool frameScene(ScriptHost& host, std::string& error) {
    Vec3 low, high;
    if (!sceneBounds(host.document.scene, baseFolder(host.document), host.assets, low, high)) {
        error = "the scene has no mesh";
        return false;
    }
    Camera& camera = host.document.scene.camera;
    float square = 0;
    for (size_t k = 0; k < 3; ++k) {
        camera.target[k] = 0.5f * (low[k] + high[k]);
        square += (high[k] - low[k]) * (high[k] - low[k]);
    }
    // The bounding sphere fills the picture's height, with space for flames above.
    const float radius = 0.5f * std::sqrt(square);
    camera.distance = 1.15f * radius / std::sin(0.5f * camera.fieldOfView * 0.017453292f);
    camera.target[1] += 0.15f * radius;
    ++host.document.revision;
    return true;
}

namespace {

bool runLineAlone(ScriptHost& host, const std::string& line, std::string& error) {
    Words words;
    error.clear();
    if (!splitWords(line, words, error)) return false;
    if (words.empty()) return true;
    bool known = true;
    const bool done = runOwn(host, words, line, known, error);
    if (known) return done;
    if (words[0] == "import") {
        // An unreadable file becomes no object.
        Command command;
        if (!parseCommand(host.document.scene, line, command, error)) return false;
        Mesh mesh;
        mesh.name = command.file;
        mesh.file = command.file;
        const auto model = modelOf(mesh, baseFolder(host.document), host.assets, error);
        if (!model) return false;
        for (const std::string& note : model->notes) host.say(note);
    }
    std::string message;
    const bool good = runLine(host.document, line, message);
    if (!good)
        error = message;
    else if (!message.empty())
        host.say(message);
    return good;
}

}  // namespace

bool runScriptLine(ScriptHost& host, const std::string& line, std::string& error) {
    const bool done = runLineAlone(host, line, error);
    if (host.link.connected()) host.link.follow(host.document);
    return done;
}

bool runScript(ScriptHost& host, const fs::path& file, std::string& error) {
    std::ifstream stream(file);
    if (!stream) {
        error = file.string() + " cannot be read";
        return false;
    }
    std::string line;
    for (size_t number = 1; std::getline(stream, line); ++number) {
        if (runScriptLine(host, line, error)) continue;
        error = file.string() + ":" + std::to_string(number) + ": " + line + "\n  " + error;
        return false;
    }
    return true;
}

int scriptMain(int count, char** words) {
    static constexpr const char* kHelp =
        "--script FILE --headless [--cache FOLDER] [--quiet]\n"
        "  Runs the commands of FILE, one per line, without a window. Paths are relative to FILE's "
        "folder.\n"
        "  --cache FOLDER  caches baked maps there\n"
        "Exit code: 0 success, 1 a line failed (prints it), 2 the command line is "
        "wrong.\n";
    fs::path script, cache;
    bool quiet = false;
    for (int i = 1; i < count; ++i) {
        const std::string word = words[i];
        if (word == "--help") return std::fputs(kHelp, stdout), 0;
        if (word == "--headless") continue;
        if (word == "--quiet") {
            quiet = true;
        } else if ((word == "--script" || word == "--cache") && i + 1 < count) {
            (word == "--script" ? script : cache) = words[++i];
        } else {
            std::fprintf(stderr, "\"%s\" is unknown\n%s", word.c_str(), kHelp);
            return 2;
        }
    }
    if (script.empty()) return std::fprintf(stderr, "No script is given\n%s", kHelp), 2;
    std::error_code ignored;
    ScriptHost host(fs::absolute(script, ignored).parent_path());
    host.assets.cache = cache;
    if (!quiet) host.say = [](const std::string& line) { std::printf("%s\n", line.c_str()); };
    std::string error;
    if (runScript(host, script, error)) return 0;
    std::fprintf(stderr, "%s\n", error.c_str());
    return 1;
}

}  // namespace fwedit
