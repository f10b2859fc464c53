// See tool.h.
#include "scene/tool.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "document/text.h"

namespace fwtools {
namespace fs = std::filesystem;

bool parseOptions(int count, char** words, const char* help, ToolOptions& options, int& code) {
    const auto wrong = [&](const std::string& what) {
        std::fprintf(stderr, "%s\n%s", what.c_str(), help);
        code = ExitUsage;
        return false;
    };
    for (int i = 1; i < count; ++i) {
        const std::string word = words[i];
        const auto value = [&]() -> std::string { return i + 1 < count ? words[++i] : ""; };
        char rest = 0;
        if (word == "--help") {
            std::fputs(help, stdout);
            code = ExitFine;
            return false;
        } else if (word == "--json") {
            options.json = true;
        } else if (word == "--quiet") {
            options.quiet = true;
        } else if (word == "--out") {
            options.out = value();
        } else if (word == "--cache") {
            options.cache = value();
        } else if (word == "--size") {
            const std::string size = value();
            if (std::sscanf(size.c_str(), "%ux%u%c", &options.width, &options.height, &rest) != 2 ||
                options.width - 1 > 8191 || options.height - 1 > 8191)
                return wrong("--size is \"" + size + "\"; it takes 1x1 to 8192x8192");
        } else if (word == "--part") {
            const std::string part = value();
            unsigned i1 = 0;
            if (std::sscanf(part.c_str(), "%u/%u%c", &i1, &options.parts, &rest) != 2 || i1 < 1 ||
                options.parts > 100000 || i1 > options.parts)
                return wrong("--part is \"" + part + "\"; it takes i/n, i from 1 to n");
            options.part = i1 - 1;
        } else if (word == "--at") {
            const std::string times = value();
            for (size_t at = 0; at <= times.size();) {
                const size_t end = std::min(times.find(',', at), times.size());
                const std::string one = times.substr(at, end - at);
                double time = 0;
                if (std::sscanf(one.c_str(), "%lf%c", &time, &rest) != 1 || !(time >= 0) ||
                    !(time <= 100000))
                    return wrong("--at is \"" + times + "\"; it takes seconds, as 0,2.5,10");
                options.times.push_back(time);
                at = end + 1;
            }
        } else if (word.size() > 1 && word[0] == '-') {
            return wrong("\"" + word + "\" is unknown");
        } else if (options.input.empty()) {
            options.input = word;
        } else {
            return wrong("\"" + word + "\" is an extra file");
        }
    }
    return options.input.empty() ? wrong("No file is given") : true;
}

bool openInput(fwedit::ScriptHost& host, const ToolOptions& options, std::string& error) {
    host.assets.cache = options.cache;
    if (!options.quiet)
        host.say = [](const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); };
    host.assets.progress = [&options](const std::string& stage, float share) {
        showProgress(options, stage, static_cast<double>(share));
        return true;
    };
    const std::string kind = fs::path(options.input).extension().string();
    const std::string file = fwedit::inQuotes(fs::absolute(options.input).string());
    if (kind == ".glb" || kind == ".gltf")
        return fwedit::runScriptLine(host, "import " + file, error) &&
               fwedit::runScriptLine(host, "frame", error);
    return fwedit::runScriptLine(host, "open " + file, error);
}

void showProgress(const ToolOptions& options, const std::string& what, double share) {
    if (options.quiet || ::isatty(STDERR_FILENO) == 0) return;
    const int filled = static_cast<int>(std::lround(30 * std::min(1.0, std::max(0.0, share))));
    std::fprintf(stderr, "\r%-30.30s [%.*s%*s] %3.0f %%%s", what.c_str(), filled,
                 "##############################", 30 - filled, "", 100 * share,
                 share >= 1 ? "\n" : "");
}

void JsonLine::key(const char* name) {
    if (!body_.empty()) body_ += ", ";
    body_ += fwedit::inQuotes(name);
    body_ += ": ";
}
void JsonLine::text(const char* name, std::string_view value) {
    key(name);
    body_ += fwedit::inQuotes(fwedit::cleanText(value, 1 << 20));
}
void JsonLine::list(const char* name, const std::vector<std::string>& values) {
    key(name);
    std::string items;
    for (const std::string& value : values) {
        if (!items.empty()) items += ", ";
        items += fwedit::inQuotes(fwedit::cleanText(value, 1 << 20));
    }
    body_ += "[" + items + "]";
}
void JsonLine::number(const char* name, double value) {
    key(name);
    body_ += std::isfinite(value) ? fwedit::printNumber(value) : "null";
}

int refuse(const ToolOptions& options, const std::string& error) {
    if (options.json) {
        JsonLine line;
        line.text("error", error);
        std::printf("%s\n", line.done().c_str());
    }
    std::fprintf(stderr, "%s\n", error.c_str());
    return ExitRefused;
}

}  // namespace fwtools
