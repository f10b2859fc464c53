// Entry point of flamewright_bench: Google Benchmark's flags, and --table (Markdown in place of
// console lines) and --json FILE. Repetitions of rows are interleaved, so compared rows see the
// same machine.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

namespace {

using Runs = std::vector<benchmark::BenchmarkReporter::Run>;

// A row's name "group/case/size" is a contract: without the settings that Google Benchmark adds. A
// row's single argument, if any, is its size. Also strips a listed name such as
// "group/case/size/iterations:12/manual_time".
std::string plainName(std::string name) {
    for (const char* setting : {"/iterations:", "/repeats:", "/min_time:", "/min_warmup_time:",
                                "/manual_time", "/real_time", "/process_time", "/threads:"}) {
        const size_t at = name.find(setting);
        if (at != std::string::npos) name.resize(at);
    }
    return name;
}

Runs plainNames(Runs runs) {
    for (auto& run : runs) {
        benchmark::BenchmarkName& name = run.run_name;
        name = {name.function_name, name.args, "", "", "", "", "", ""};
    }
    return runs;
}

class PlainConsole : public benchmark::ConsoleReporter {
 public:
    void ReportRuns(const Runs& runs) override { ConsoleReporter::ReportRuns(plainNames(runs)); }
};

class PlainJson : public benchmark::JSONReporter {
 public:
    void ReportRuns(const Runs& runs) override { JSONReporter::ReportRuns(plainNames(runs)); }
};

class TableReporter : public benchmark::BenchmarkReporter {
 public:
    bool ReportContext(const Context&) override {
        std::printf("| row | time | cpu | iterations | counters |\n|---|---:|---:|---:|---|\n");
        return true;
    }

    void ReportRuns(const Runs& runs) override {
        for (const Run& run : plainNames(runs)) {
            if (run.error_occurred) {
                std::printf("| %s | failed: %s | | | |\n", run.benchmark_name().c_str(),
                            run.error_message.c_str());
                continue;
            }
            const char* unit = benchmark::GetTimeUnitString(run.time_unit);
            std::printf("| %s | %.3f %s | %.3f %s | %lld |", run.benchmark_name().c_str(),
                        run.GetAdjustedRealTime(), unit, run.GetAdjustedCPUTime(), unit,
                        static_cast<long long>(run.iterations));
            for (const auto& [name, counter] : run.counters) {
                std::printf(" %s %.4g", name.c_str(), counter.value);
            }
            std::printf(" |\n");
        }
        std::fflush(stdout);
    }
};

}  // namespace

int main(int argc, char** argv) {
    std::vector<std::string> words{argv[0], "--benchmark_enable_random_interleaving=true"};
    bool list = false;
    bool table = false;
    bool json = false;
    for (int i = 1; i < argc; ++i) {
        if (std::strcmp(argv[i], "--table") == 0) {
            table = true;
        } else if (std::strcmp(argv[i], "--json") == 0) {
            if (++i == argc) {
                std::fprintf(stderr, "flamewright_bench: --json needs a file name\n");
                return 2;
            }
            words.push_back(std::string("--benchmark_out=") + argv[i]);
            json = true;
        } else {
            list |= std::strncmp(argv[i], "--benchmark_list_tests", 22) == 0 &&
                    std::strcmp(argv[i], "--benchmark_list_tests=false") != 0;
            words.push_back(argv[i]);
        }
    }
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    int count = static_cast<int>(arguments.size());
    benchmark::Initialize(&count, arguments.data());
    if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;

    TableReporter markdown;
    PlainConsole console;
    PlainJson file;
    benchmark::BenchmarkReporter* display = &console;
    if (table) display = &markdown;
    std::ostringstream listed;
    if (list) display->SetOutputStream(&listed);
    const std::size_t rows = benchmark::RunSpecifiedBenchmarks(display, json ? &file : nullptr);
    benchmark::Shutdown();
    if (list) {
        std::istringstream lines(listed.str());
        for (std::string line; std::getline(lines, line);) std::puts(plainName(line).c_str());
    }
    if (rows == 0) {
        std::fprintf(stderr, "flamewright_bench: no row matches\n");
        return 1;
    }
    return 0;
}
