// What the tools that take a scene share: their command line, progress, and how a file becomes a
// scene.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "script/script.h"

namespace fwtools {

// Exit codes of all of them.
enum Exit : int { ExitFine = 0, ExitRefused = 1, ExitUsage = 2 };

struct ToolOptions {
    std::string input;
    std::filesystem::path out = ".", cache;
    uint32_t part = 0, parts = 1;  // of --part i/n, i from 1
    uint32_t width = 640, height = 360;
    std::vector<double> times;  // s, of --at
    bool json = false, quiet = false;
};
// False: `code` is the exit code; help or what is wrong has been printed.
bool parseOptions(int count, char** words, const char* help, ToolOptions& options, int& code);

// Opens a .fwscene, or puts a glTF file alone into a new scene. False: `error`.
bool openInput(fwedit::ScriptHost& host, const ToolOptions& options, std::string& error);
// A bar on stderr; nothing with --quiet.
void showProgress(const ToolOptions& options, const std::string& what, double share);
// True: this item belongs to the part of the work that was asked for.
inline bool mine(const ToolOptions& options, size_t item) {
    return item % options.parts == options.part;
}

// {"a": "b", "n": 3}: one object a line, in the order given.
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
