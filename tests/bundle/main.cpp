// flamewright-check: checks and times the library on this machine's Vulkan device, and writes
// report.html, report.json and pictures. Each part runs in a process of its own, with a time limit.
#include "bundle/child.h"
#include "bundle/device_facts.h"
#include "bundle/gpu_tests.h"
#include "bundle/report.h"
#include "bundle/scenes.h"
#include "bundle/timing.h"

#include <flamewright/flamewright.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <thread>

using nlohmann::json;
namespace fs = std::filesystem;

namespace fw::bundle {
namespace {

constexpr const char* kUsage = R"(usage: flamewright-check OUT [options]
       flamewright-check --record FILE

Writes OUT/report.html, OUT/report.json, OUT/pictures and, in OUT/logs, the output of each part.
Exit status: 0 all is well, 1 something differs or fails, 2 wrong arguments.

  --steps LIST    which of conformance,passes,bench,tests to run (default: all)
  --seconds N     limit of all of them (default 230 on a GPU, 840 on a software device)
  --data FOLDER   that holds recorded.hashes, about, bin, tests and layers (default: the parent of
                  this program's folder)
  --record FILE   writes the burn hashes of the cpu backend to FILE, to be compared with from now on
)";

struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

fs::path ownProgram() { return fs::read_symlink("/proc/self/exe"); }

void writeText(const fs::path& path, const std::string& text) {
    // A reader never sees half of it, whenever this program is stopped.
    const fs::path part = path.string() + ".part";
    std::ofstream file(part, std::ios::binary);
    file << text;
    file.close();
    if (!file) throw std::runtime_error(path.string() + " cannot be written");
    fs::rename(part, path);
}

// ---- recorded hashes --------------------------------------------------------------------------

std::string keyOf(const json& point) {
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, "%g", point["seconds"].get<double>());
    return point["scene"].get<std::string>() + " " + seconds;
}

void record(const fs::path& file) {
    std::ostringstream out;
    out << "# Burn hashes of flamewright-check: scene, seconds, hash. Written by\n"
           "# flamewright-check --record on the cpu backend.\n";
    const json facts = hashFacts(FW_BACKEND_CPU);
    for (const json& point : facts["points"])
        out << keyOf(point) << ' ' << point["hash"].get<std::string>() << '\n';
    writeText(file, out.str());
}

std::map<std::string, std::string> recordedHashes(const fs::path& file) {
    std::map<std::string, std::string> out;
    std::istringstream lines(textOf(file));
    for (std::string line; std::getline(lines, line);) {
        const size_t at = line.rfind(' ');
        if (!line.empty() && line[0] != '#' && at != std::string::npos)
            out[line.substr(0, at)] = line.substr(at + 1);
    }
    if (out.empty()) throw std::runtime_error(file.string() + " holds no recorded hashes");
    return out;
}

// ---- the parts --------------------------------------------------------------------------------

class Check {
 public:
    Check(const fs::path& out, const fs::path& data, const std::set<std::string>& steps,
          double seconds)
        : out_(fs::absolute(out)), data_(data), steps_(steps), seconds_(seconds) {
        for (const char* folder : {"pictures", "logs"}) {
            fs::remove_all(out_ / folder);
            fs::create_directories(out_ / folder);
        }
        recorded_ = recordedHashes(data_ / "recorded.hashes");
    }

    int run() {
        findFacts();
        const bool usable = !report_.contains("problem");
        if (wants("conformance")) step("conformance", [&] { checkConformance(usable); });
        if (usable && wants("passes")) step("passes", [&] { timePasses(); });
        if (usable && wants("bench")) step("bench", [&] { runBench(); });
        if (usable && wants("tests")) step("tests", [&] { checkTests(); });
        report_["seconds"] = secondsSince(start_);
        report_["complete"] = true;
        write();
        const bool good = usable && verdict();
        say(good ? "all is well" : "something differs or fails");
        say("open " + (out_ / "report.html").string());
        return good ? 0 : 1;
    }

 private:
    [[nodiscard]] bool wants(const std::string& step) const { return steps_.count(step) > 0; }
    void say(const std::string& text) const {
        std::printf("[%4.0f s] %s\n", secondsSince(start_), text.c_str());
        std::fflush(stdout);
    }
    // Never more than is left of the whole.
    [[nodiscard]] double share(double of) const {
        return std::max(1.0, std::min(of * seconds_, seconds_ - secondsSince(start_)));
    }
    [[nodiscard]] std::string log(const std::string& name) const {
        return (out_ / "logs" / name).string();
    }
    template <class Work>
    void step(const std::string& name, const Work& work) {
        say(name);
        try {
            work();
        } catch (const std::exception& error) {  // the other parts still run
            report_["problems"].push_back(name + ": " + error.what());
            say(name + ": " + error.what());
        }
        write();
    }
    void write() {
        // Output of other programs may hold anything.
        writeText(out_ / "report.json",
                  report_.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
        writeText(out_ / "report.html", htmlOf(report_, out_.string()));
    }

    void findFacts() {
        report_ = deviceFacts();
        report_["format"] = 1;
        report_["machine"] = machineFacts();
        report_["problems"] = json::array();
        const uint32_t version = fwGetVersion();
        report_["library"] = std::to_string(version >> 22) + "." +
                             std::to_string(version >> 12 & 1023) + "." +
                             std::to_string(version & 4095);
        const std::string about = textOf(data_ / "about");
        report_["build"] = about.empty() ? "a build folder" : lastLines(about, 1);
        char date[32];
        const std::time_t now = std::time(nullptr);
        std::strftime(date, sizeof date, "%Y-%m-%d %H:%M UTC", std::gmtime(&now));
        report_["date"] = date;
        if (report_.contains("problem")) {
            say(report_["problem"]);
        } else {
            const json& device = report_["devices"][0];
            software_ = device["type"] == "software device";
            say(device["name"].get<std::string>() + ", " + device["type"].get<std::string>());
        }
        if (seconds_ == 0) seconds_ = software_ ? 840 : 230;
        findLayer();
    }
    // The system's validation layer, else the bundle's.
    void findLayer() {
        layer_ = "system";
        if (hasValidationLayer()) return;
        layer_ = "bundle";
        const char* given = std::getenv("VK_LAYER_PATH");
        const std::string path =
            (data_ / "layers").string() + (given ? ":" + std::string(given) : "");
        setenv("VK_LAYER_PATH", path.c_str(), 1);
        if (!hasValidationLayer()) layer_ = "none";
    }

    // Runs this program's part `words` and returns the JSON that it writes; "fault" without it.
    json runPart(const std::string& name, std::vector<std::string> words, double seconds,
                 const Child::Environment& environment = {}) const {
        const std::string file = log(name + ".json");
        words.insert(words.begin(), {ownProgram().string(), "--part", file});
        Child child(words, log(name + ".log"), environment, out_.string());
        std::string fault;
        if (!child.waitFor(seconds)) {
            child.stop();
            fault = "stopped after " + std::to_string(int(seconds)) + " s";
        } else {
            fault = child.fault();
        }
        json out = json::parse(textOf(file), nullptr, false);
        if (out.is_object() && fault.empty()) return out;
        const std::string said = lastLines(textOf(log(name + ".log")), 3);
        return {
            {"fault", (fault.empty() ? "no result" : fault) + (said.empty() ? "" : ": " + said)}};
    }

    void checkConformance(bool usable) {
        json result;
        const json cpu = runPart("hashes_cpu", {"hashes", "cpu"}, share(0.3));
        json device = json::object();
        if (usable) device = hashesOfDevice();
        for (const json* backend : {&cpu, static_cast<const json*>(&device)})
            if (backend->contains("fault"))
                report_["problems"].push_back(
                    (backend == &cpu ? "hashes, cpu backend: " : "hashes, device: ") +
                    (*backend)["fault"].get<std::string>());
        result["device"] = device.value("device", "");
        const auto find = [](const json& backend, const std::string& key) -> json {
            for (const json& point : backend.value("points", json::array()))
                if (keyOf(point) == key) return point;
            return {{"hash", ""}, {"ignited", 0}};
        };
        size_t equal = 0, burnt = 0;
        result["rows"] = json::array();
        for (const auto& [key, hash] : recorded_) {
            const json here = find(cpu, key), there = find(device, key);
            const bool same = here["hash"] == hash && there["hash"] == hash;
            equal += same;
            burnt += here["ignited"].get<int>() > 0;
            result["rows"].push_back({{"scene", key.substr(0, key.find(' '))},
                                      {"seconds", std::stod(key.substr(key.find(' ')))},
                                      {"ignited", here["ignited"]},
                                      {"recorded", hash},
                                      {"cpu", here["hash"]},
                                      {"device", there["hash"]},
                                      {"equal", same}});
        }
        std::stable_sort(
            result["rows"].begin(), result["rows"].end(), [](const json& a, const json& b) {
                return std::pair(a["scene"], a["seconds"]) < std::pair(b["scene"], b["seconds"]);
            });
        // Scenes in which nothing burns, or which nobody recorded, prove nothing.
        const size_t points = cpu.value("points", json::array()).size();
        result["equal"] = equal == recorded_.size() && burnt == equal && points == equal;
        report_["conformance"] = result;
        say(std::to_string(equal) + " of " + std::to_string(recorded_.size()) +
            " burn hashes are equal on the cpu backend, on the device and as recorded");
    }
    json hashesOfDevice() {
        json& validation = report_["validation"];
        validation = {{"layer", layer_}, {"messages", json::array()}, {"count", 0}};
        const std::vector<std::string> words = {"hashes", "device"};
        if (layer_ == "none") return runPart("hashes_device", words, share(0.3));
        json device = runPart(
            "hashes_validated", words, share(0.4),
            {{"VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation"},
             {"VK_LAYER_ENABLES", "VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT"}});
        static const std::regex message("VUID-|SYNC-HAZARD|UNASSIGNED-|Validation (Error|Warning)");
        // Newer layers have other names for their settings and remark on the old ones.
        static const std::regex remark("VALIDATION-SETTINGS");
        std::istringstream lines(textOf(log("hashes_validated.log")));
        int count = 0;
        for (std::string line; std::getline(lines, line);) {
            if (!std::regex_search(line, message) || std::regex_search(line, remark)) continue;
            if (count++ < 8) validation["messages"].push_back(line.substr(0, 500));
        }
        validation["count"] = count;
        say(std::to_string(count) + " validation messages");
        if (!device.contains("fault")) return device;
        validation["fault"] = device["fault"];
        return runPart("hashes_device", words, share(0.3));
    }

    void timePasses() {
        std::vector<std::string> rest = {"0.4", "1", "1", "1280x720"};
        if (!software_) rest = {"1", "24", "48", "1920x1080", "3840x2160"};
        report_["passes"] = json::array();
        for (const TimedScene& scene : timedScenes()) {
            std::vector<std::string> words = {
                "scene", scene.name,
                (out_ / "pictures" / (std::string(scene.name) + ".png")).string()};
            words.insert(words.end(), rest.begin(), rest.end());
            json result = runPart(std::string("scene_") + scene.name, words, share(0.15));
            result["name"] = scene.name;
            result["title"] = scene.title;
            std::string text = std::string(scene.name) + ": ";
            for (const json& size : result.value("sizes", json::array())) {
                char one[64];
                std::snprintf(one, sizeof one, "%.3f ms at %dx%d  ", size["ms"].get<double>(),
                              size["width"].get<int>(), size["height"].get<int>());
                text += one;
            }
            say(result.contains("fault") ? text + result["fault"].get<std::string>() : text);
            report_["passes"].push_back(result);
            write();
        }
    }

    [[nodiscard]] fs::path packed(const char* program) const { return data_ / "bin" / program; }

    void runBench() {
        const fs::path bench = packed("flamewright_device_bench");
        if (!fs::exists(bench)) throw std::runtime_error(bench.string() + " is not there");
        const std::regex wanted(software_ ? "^(front/sparse3/256|particles/sim/10k|field/64x64x64)$"
                                          : "^(front/(dense|sparse3)|volume|particles|field|refine/"
                                            "(full|adaptive)/20k|houses100/frame|world|views)");
        const double end = secondsSince(start_) + share(0.25);
        const std::string list = log("bench_rows.txt");
        Child lister({bench.string(), "--benchmark_list_tests"}, list, {}, out_.string());
        if (!lister.waitFor(30)) lister.stop();
        std::map<std::string, std::string> groups;  // prefix: regular expression of its rows
        std::istringstream lines(textOf(list));
        for (std::string line; std::getline(lines, line);)
            if (std::regex_search(line, wanted)) {
                std::string& group = groups[line.substr(0, line.find('/'))];
                group += (group.empty() ? "" : "|") + line;
            }
        json rows = json::array();
        size_t left = groups.size();
        for (const auto& [group, names] : groups) {
            const double fair = (end - secondsSince(start_)) / double(left--);
            const std::string file = log("bench_" + group + ".json");
            Child child({bench.string(), "--benchmark_filter=^(" + names + ")(/|$)",
                         "--benchmark_min_time=0.02", "--json", file},
                        log("bench_" + group + ".log"), {}, out_.string());
            if (!child.waitFor(std::max(1.0, fair))) child.stop();
            const json result = json::parse(textOf(file), nullptr, false);
            if (!result.is_object()) {
                rows.push_back({{"name", group + "/..."}, {"fault", child.fault()}});
                continue;
            }
            for (const json& row : result["benchmarks"]) rows.push_back(benchRow(row));
        }
        report_["bench"] = rows;
        say(std::to_string(rows.size()) + " rows of the bench");
    }
    static json benchRow(const json& row) {
        static const std::set<std::string> known = {"family_index", "per_family_instance_index",
                                                    "repetitions",  "repetition_index",
                                                    "threads",      "iterations",
                                                    "real_time",    "cpu_time"};
        json out = {{"name", row["name"]}};
        if (row.value("error_occurred", false)) {
            out["fault"] = row.value("error_message", "failed");
            return out;
        }
        out["time"] = row["real_time"];
        out["unit"] = row["time_unit"];
        for (const auto& [key, value] : row.items())
            if (value.is_number() && known.count(key) == 0) out["counters"][key] = value;
        return out;
    }

    void checkTests() {
        const fs::path program = packed("flamewright_gpu_tests");
        if (!fs::exists(program)) throw std::runtime_error(program.string() + " is not there");
        TestRun run;
        run.program = program.string();
        run.folder = log("tests");
        fs::create_directories(run.folder);
        run.environment = {{"FLAMEWRIGHT_REQUIRE_GPU", "1"},
                           {"FLAMEWRIGHT_TEST_DATA", (data_ / "tests").string()},
                           {"FLAMEWRIGHT_TEST_OUT", run.folder}};
        // Software devices: what shows a fault of the library, not of a picture, within minutes.
        if (software_)
            run.filter =
                "(^|/)[A-Za-z]*Equality\\.|^Logs/ReplayOnDevice\\.|^(VkContract|VkContractFloor|"
                "VkThreads|Targets|HostClobber|VertexUnits|ParticlePass)\\.";
        const uint32_t threads = std::max(1u, uint32_t(std::thread::hardware_concurrency()));
        run.processes = software_ ? std::min(threads, 4u) : std::clamp(threads - 2, 1u, 8u);
        run.testSeconds = software_ ? 200 : 60;
        run.end = start_ + std::chrono::milliseconds(int64_t(seconds_ * 1000));
        report_["tests"] = runTests(run);
        const json& tests = report_["tests"];
        say(tests["passed"].dump() + " tests passed, " + tests["failed"].dump() + " failed, " +
            tests["skipped"].dump() + " skipped, " + tests["notRun"].dump() + " not run");
    }

    [[nodiscard]] bool verdict() const {
        if (!report_["problems"].empty()) return false;
        if (wants("conformance") &&
            (!report_["conformance"]["equal"] || report_["validation"]["count"] != 0 ||
             report_["validation"].contains("fault")))
            return false;
        if (wants("passes"))
            for (const json& scene : report_["passes"])
                if (scene.contains("fault")) return false;
        return !wants("tests") || report_["tests"]["problems"].empty();
    }

    Clock::time_point start_ = Clock::now();
    fs::path out_, data_;
    std::set<std::string> steps_;
    double seconds_;
    std::map<std::string, std::string> recorded_;
    bool software_ = false;
    std::string layer_;
    json report_;
};

// ---- the command line -------------------------------------------------------------------------

// A part for a process of its own: FILE hashes BACKEND, or
// FILE scene NAME PICTURE BURNS WARMUP FRAMES SIZE...
int runPartHere(const std::vector<std::string>& words) {
    json result;
    if (words.size() == 3 && words[1] == "hashes") {
        result = hashFacts(words[2] == "cpu" ? FW_BACKEND_CPU : FW_BACKEND_VULKAN);
    } else if (words.size() >= 8 && words[1] == "scene") {
        TimingRequest request;
        request.scene = words[2];
        request.picture = words[3];
        request.burns = std::stof(words[4]);
        request.warmUp = uint32_t(std::stoul(words[5]));
        request.frames = uint32_t(std::stoul(words[6]));
        for (size_t i = 7; i < words.size(); ++i) {
            auto& [width, height] = request.sizes.emplace_back();
            if (std::sscanf(words[i].c_str(), "%ux%u", &width, &height) != 2)
                throw UsageError("--part: \"" + words[i] + "\" is not a size such as 1280x720");
        }
        result = timeScene(request);
    } else {
        throw UsageError("--part is only for this program itself");
    }
    writeText(words[0], result.dump(1));
    return 0;
}

std::set<std::string> stepsOf(const std::string& list) {
    std::set<std::string> out;
    std::istringstream words(list);
    for (std::string word; std::getline(words, word, ',');) {
        if (word != "conformance" && word != "passes" && word != "bench" && word != "tests")
            throw UsageError("--steps: \"" + word +
                             "\" is none of conformance, passes, bench, tests");
        out.insert(word);
    }
    return out;
}

int runCheck(const std::vector<std::string>& words) {
    std::string out;
    fs::path data = ownProgram().parent_path().parent_path();
    std::set<std::string> steps = stepsOf("conformance,passes,bench,tests");
    double seconds = 0;
    for (size_t i = 0; i < words.size(); ++i) {
        const std::string& word = words[i];
        if (word == "-h" || word == "--help") {
            std::fputs(kUsage, stdout);
            return 0;
        }
        if (word[0] != '-') {
            if (!out.empty()) throw UsageError("\"" + word + "\" is one argument too many");
            out = word;
            continue;
        }
        if (i + 1 == words.size()) throw UsageError(word + " is unknown or needs a value");
        const std::string& value = words[++i];
        if (word == "--part") return runPartHere({words.begin() + std::ptrdiff_t(i), words.end()});
        if (word == "--record") {
            record(value);
            return 0;
        }
        if (word == "--steps")
            steps = stepsOf(value);
        else if (word == "--data")
            data = value;
        else if (word == "--seconds") {
            char* end = nullptr;
            seconds = std::strtod(value.c_str(), &end);
            if (*end || !(seconds >= 10 && seconds <= 36000))
                throw UsageError("--seconds is \"" + value + "\"; it is a number in [10, 36000]");
        } else
            throw UsageError("unknown option \"" + word + "\"");
    }
    if (out.empty()) throw UsageError("OUT, the folder of the report, is missing");
    return Check(out, data, steps, seconds).run();
}

}  // namespace
}  // namespace fw::bundle

int main(int argc, char** argv) {
    try {
        return fw::bundle::runCheck({argv + 1, argv + argc});
    } catch (const fw::bundle::UsageError& error) {
        std::fprintf(stderr, "flamewright-check: %s\n%s", error.what(), fw::bundle::kUsage);
        return 2;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "flamewright-check: %s\n", error.what());
        return 1;
    }
}
