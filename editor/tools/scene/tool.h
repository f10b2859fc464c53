// Shared code of the scene tools: command line, progress, input.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "script/script.h"

namespace fwtools {

// Exit codes of all tools.
enum Exit : int { ExitFine = 0, ExitRefused = 1, ExitUsage = 2 };

struct ToolOptions {
    std::string input;
    std::filesystem::path out = ".", cache;
    uint32_t part = 0, parts = 1;  // from --part i/n, i from 1
    uint32_t width = 640, height = 360;
    std::vector<double> times;  // s, from --at
    bool json = false, quiet = false;
};
// On false, `code` is the exit code, and help or the problem has been printed.
bool parseOptions(int count, char** words, const char* help, ToolOptions& options, int& code);

// Opens a .fwscene, or imports a glTF file into a new scene. On failure returns false with `error`.
bool openInput(fwedit::ScriptHost& host, const ToolOptions& options, std::string& error);
// A bar on stderr; nothing with --quiet.
void showProgress(const ToolOptions& options, const std::string& what, double share);
// Returns true if this item belongs to the requested part of the work.
inline bool isInPart(const ToolOptions& options, size_t item) {
    return item % options.parts == options.part;
}

// Builds one JSON object per line in the given order, such as {"a": "b", "n": 3}.
class JsonLine {
 public:
    void text(const char* key, std::string_view value);
    void number(const char* key, double value);
    void list(const char* key, const std::vector<std::string>& values);
    [[nodiscard]] std::string done() const { return "{" + body_ + "}"; }

 private:
    void key(const char* name);
    std::string body_;
};

int refuse(const ToolOptions& options, const std::string& error);

}  // namespace fwtools
