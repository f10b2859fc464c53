#include "bundle/gpu_tests.h"

#include <algorithm>
#include <fstream>
#include <mutex>
#include <regex>
#include <set>
#include <sstream>
#include <thread>

using nlohmann::json;

namespace fw::bundle {
namespace {

struct Verdict {
    std::string name, verdict, message, alone;
};

std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> out;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) out.push_back(line);
    return out;
}

std::vector<std::string> listTests(const TestRun& run) {
    const std::string log = run.folder + "/list.txt";
    Child list({run.program, "--gtest_list_tests"}, log, run.environment, run.folder);
    if (!list.waitFor(60)) list.stop();
    const std::regex wanted(run.filter);
    std::vector<std::string> names;
    std::string suite;
    for (std::string line : linesOf(textOf(log))) {
        line = line.substr(0, line.find('#'));
        line.erase(line.find_last_not_of(' ') + 1);
        if (line.empty()) continue;
        if (line[0] != ' ') {
            suite = line.back() == '.' ? line : "";
            continue;
        }
        const std::string name = suite + line.substr(line.find_first_not_of(' '));
        if (suite.empty() || name.find("DISABLED_") != std::string::npos) continue;
        if (run.filter.empty() || std::regex_search(name, wanted)) names.push_back(name);
    }
    return names;
}

// The first lines that say why: from the test's part of the log.
std::string messageOf(const std::string& log, const std::string& name) {
    const std::vector<std::string> lines = linesOf(log);
    const auto begin = std::find(lines.begin(), lines.end(), "[ RUN      ] " + name);
    const auto isFailure = [](const std::string& line) {
        return line.find(": Failure") != std::string::npos;
    };
    auto at = std::find_if(begin, lines.end(), isFailure);
    if (at == lines.end()) at = lines.end() - std::min<std::ptrdiff_t>(4, lines.end() - begin);
    std::string out;
    for (int i = 0; i < 5 && at != lines.end() && at->find("[  FAILED") != 0; ++i, ++at)
        out += (out.empty() ? "" : " | ") +
               at->substr(at->find("/tests/") == std::string::npos ? 0 : at->find("/tests/") + 7);
    return out.substr(0, 600);
}

class Runner {
 public:
    explicit Runner(const TestRun& run) : run_(run) {}

    // One process after the other until each of `names` has a verdict.
    std::vector<Verdict> runPart(std::vector<std::string> names, const std::string& base) const {
        std::vector<Verdict> out;
        for (int turn = 0; !names.empty(); ++turn) {
            if (Clock::now() >= run_.end) break;
            const std::string file = base + "." + std::to_string(turn);
            const std::vector<Verdict> made = runProcess(names, file);
            if (made.empty()) {
                const std::string why = lastLines(textOf(file + ".log"), 3);
                for (const std::string& name : names)
                    out.push_back({name, "crashed", "no test began: " + why, ""});
                return out;
            }
            std::set<std::string> done;
            for (const Verdict& verdict : made) done.insert(verdict.name);
            std::erase_if(names, [&](const std::string& name) { return done.count(name) > 0; });
            out.insert(out.end(), made.begin(), made.end());
        }
        for (const std::string& name : names) out.push_back({name, "not run", "", ""});
        return out;
    }

 private:
    std::vector<Verdict> runProcess(const std::vector<std::string>& names,
                                    const std::string& file) const {
        {
            std::ofstream flags(file + ".flags");
            flags << "--gtest_filter=";
            for (const std::string& name : names) flags << name << ':';
        }
        Child::Environment environment = run_.environment;
        environment["FLAMEWRIGHT_TEST_RESULTS"] = file + ".results";
        Child child({run_.program, "--gtest_flagfile=" + file + ".flags", "--gtest_color=no"},
                    file + ".log", environment, run_.folder);
        size_t seen = 0;
        Clock::time_point since = Clock::now();
        std::string stopped;
        while (!child.waitFor(0.1)) {
            const size_t size = textOf(file + ".results").size();
            if (size != seen) since = Clock::now();
            seen = size;
            if (secondsSince(since) > run_.testSeconds)
                stopped = "hung";
            else if (Clock::now() >= run_.end)
                stopped = "not run";
            if (stopped.empty()) continue;
            child.stop();
            break;
        }
        std::vector<Verdict> out;
        std::string begun;
        const std::string log = textOf(file + ".log");
        for (const std::string& line : linesOf(textOf(file + ".results"))) {
            std::istringstream words(line);
            std::string verdict, name;
            words >> verdict >> name;
            std::string rest;
            std::getline(words, rest);
            if (!name.empty() && name.back() == ':') name.pop_back();
            begun = verdict == "begin" ? name : "";
            if (verdict == "failed") rest = messageOf(log, name);
            if (verdict == "skipped" && rest.size() > 1) rest = rest.substr(1);
            if (verdict != "begin") out.push_back({name, verdict, rest, ""});
        }
        if (!begun.empty())
            out.push_back({begun, stopped.empty() ? "crashed" : stopped,
                           stopped == "hung"
                               ? "stopped after " + std::to_string(int(run_.testSeconds)) + " s"
                               : child.fault() + ": " + messageOf(log, begun),
                           ""});
        else if (stopped.empty() && !out.empty() && child.fault() != "" &&
                 child.fault() != "status 1")
            out.push_back({"(end of a process)", "crashed", child.fault(), ""});
        return out;
    }

    const TestRun& run_;
};

bool isProblem(const Verdict& verdict) {
    return verdict.verdict != "passed" && verdict.verdict != "skipped" &&
           verdict.verdict != "not run";
}

}  // namespace

json runTests(const TestRun& run) {
    const Clock::time_point start = Clock::now();
    const std::vector<std::string> names = listTests(run);
    // Large parts first, whose neighbours share what they set up; single tests last.
    std::vector<std::vector<std::string>> parts;
    for (size_t at = 0; at < names.size();) {
        const size_t each = 2 * size_t{run.processes};
        const size_t count = (names.size() - at + each - 1) / each;
        parts.emplace_back(names.begin() + std::ptrdiff_t(at),
                           names.begin() + std::ptrdiff_t(at + count));
        at += count;
    }
    const Runner runner(run);
    std::vector<Verdict> verdicts;
    std::mutex mutex;
    size_t next = 0;
    const auto work = [&] {
        for (;;) {
            std::unique_lock lock(mutex);
            if (next == parts.size()) return;
            const size_t part = next++;
            lock.unlock();
            const auto made =
                runner.runPart(parts[part], run.folder + "/part" + std::to_string(part));
            lock.lock();
            verdicts.insert(verdicts.end(), made.begin(), made.end());
        }
    };
    std::vector<std::thread> threads;
    for (uint32_t i = 0; i < run.processes; ++i) threads.emplace_back(work);
    for (std::thread& thread : threads) thread.join();
    for (size_t i = 0, turn = 0; i < verdicts.size(); ++i) {
        Verdict& verdict = verdicts[i];
        if (!isProblem(verdict) || verdict.name[0] == '(' || verdict.verdict == "hung") continue;
        const auto again =
            runner.runPart({verdict.name}, run.folder + "/alone" + std::to_string(turn++));
        verdict.alone = again[0].verdict;
    }

    json out = {{"passed", 0}, {"failed", 0}, {"skipped", 0}, {"notRun", 0}};
    out["problems"] = json::array();
    std::map<std::string, int> skips;
    for (const Verdict& verdict : verdicts) {
        const char* kind = verdict.verdict == "passed"    ? "passed"
                           : verdict.verdict == "skipped" ? "skipped"
                           : verdict.verdict == "not run" ? "notRun"
                                                          : "failed";
        out[kind] = out[kind].get<int>() + 1;
        if (verdict.verdict == "skipped") ++skips[verdict.message];
        if (isProblem(verdict))
            out["problems"].push_back({{"name", verdict.name},
                                       {"verdict", verdict.verdict},
                                       {"message", verdict.message},
                                       {"alone", verdict.alone}});
    }
    if (names.empty())
        out["problems"].push_back({{"name", "(all)"},
                                   {"verdict", "crashed"},
                                   {"message", "the program lists no tests: " +
                                                   lastLines(textOf(run.folder + "/list.txt"), 3)},
                                   {"alone", ""}});
    out["skips"] = json::array();
    for (const auto& [message, count] : skips)
        out["skips"].push_back({{"message", message}, {"count", count}});
    out["seconds"] = secondsSince(start);
    return out;
}

}  // namespace fw::bundle
