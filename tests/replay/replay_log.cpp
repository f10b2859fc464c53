#include "replay/replay_log.h"

#include <cinttypes>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace fw::test {
namespace {

constexpr uint32_t kStepTicks = 128;

struct VerbForm {
    const char* word;
    ReplayVerb verb;
    const char* words;  // o: object, m: mesh, p: material preset
    int numbers;
    bool mayNameObject;  // one more word at the end
};
constexpr VerbForm kForms[] = {
    {"wind", ReplayVerb::Wind, "", 3, false},
    {"object", ReplayVerb::Object, "omp", 4, false},
    {"pose", ReplayVerb::Pose, "o", 5, false},
    {"destroy", ReplayVerb::Destroy, "o", 0, false},
    {"ignite", ReplayVerb::Ignite, "", 4, true},
    {"wet", ReplayVerb::Wet, "", 4, true},
    {"dry", ReplayVerb::Dry, "", 4, true},
    {"extinguish", ReplayVerb::Extinguish, "", 4, true},
};

bool readMesh(std::istringstream& in, ReplayMesh& mesh) {
    if (!(in >> mesh.name >> mesh.density >> mesh.noise >> mesh.generator)) return false;
    for (double number = 0; in >> number;) mesh.numbers.push_back(number);
    return in.eof();
}

bool readCommand(std::istringstream& in, const std::string& word, ReplayCommand& command) {
    for (const VerbForm& form : kForms) {
        if (word != form.word) continue;
        command.verb = form.verb;
        for (const char* kind = form.words; *kind; ++kind) {
            std::string& to = *kind == 'o'   ? command.object
                              : *kind == 'm' ? command.mesh
                                             : command.material;
            if (!(in >> to)) return false;
        }
        for (int i = 0; i < form.numbers; ++i)
            if (!(in >> command.numbers[i])) return false;
        if (form.mayNameObject) in >> command.object;
        // Only ball events carry a delay; all else happens between two steps.
        return form.mayNameObject || command.tick % kStepTicks == 0;
    }
    return false;
}

bool readLine(const std::string& text, ReplayLog& log, int line) {
    std::istringstream in(text);
    std::string word;
    in >> word;
    if (word == "pace") return bool(in >> log.pace);
    if (word == "mesh") return readMesh(in, log.meshes.emplace_back());
    if (word == "end") return bool(in >> log.steps);
    ReplayCommand command;
    command.line = line;
    char* rest = nullptr;
    command.tick = uint32_t(std::strtoul(word.c_str(), &rest, 10));
    if (word.empty() || *rest != 0) return false;
    if (!log.commands.empty() && log.commands.back().tick > command.tick) return false;
    if (!(in >> word) || !readCommand(in, word, command)) return false;
    log.commands.push_back(command);
    std::string more;
    return !(in >> more);
}

}  // namespace

bool readReplayLog(const std::string& path, ReplayLog& log, std::string& error) {
    log = {};
    std::ifstream file(path);
    if (!file) {
        error = path + " cannot be read";
        return false;
    }
    std::string text;
    for (int line = 1; std::getline(file, text); ++line) {
        text.erase(std::min(text.find('#'), text.size()));
        if (text.find_first_not_of(" \t\r") == std::string::npos) continue;
        if (readLine(text, log, line)) continue;
        error = path + ":" + std::to_string(line) + ": \"" + text + "\" is no line of a log";
        return false;
    }
    if (log.steps == 0) error = path + " has no end";
    return log.steps > 0;
}

bool readReplayHashes(const std::string& path, std::vector<ReplayHash>& hashes,
                      std::string& error) {
    hashes.clear();
    std::ifstream file(path);
    std::string text;
    while (std::getline(file, text)) {
        ReplayHash one;
        if (std::sscanf(text.c_str(), "%" SCNu32 " %" SCNu32 " %" SCNx64, &one.step, &one.objects,
                        &one.hash) != 3) {
            error = path + ": \"" + text + "\" is not \"step objects hash\"";
            return false;
        }
        hashes.push_back(one);
    }
    if (hashes.empty()) error = path + " holds nothing; --bless records it";
    return !hashes.empty();
}

bool writeReplayHashes(const std::string& path, const std::vector<ReplayHash>& hashes) {
    std::FILE* file = std::fopen(path.c_str(), "w");
    if (!file) return false;
    for (const ReplayHash& one : hashes)
        std::fprintf(file, "%" PRIu32 " %" PRIu32 " %016" PRIx64 "\n", one.step, one.objects,
                     one.hash);
    return std::fclose(file) == 0;
}

}  // namespace fw::test
