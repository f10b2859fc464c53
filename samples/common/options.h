// The command line that every sample shares, plus what one sample adds to it.
// Not a general parser: values are flags, words, numbers and "x,y,z".
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace sample {

// What went wrong, for the user: names the thing, its value and what is allowed.
struct Failure : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct Options {
    bool headless = false;      // no window: pictures under `out`. Also when there is no display
    uint32_t frames = 0;        // frames to run; 0: the sample's own default, or until closed
    uint32_t width = 960;       // pixels, [1, 8192]
    uint32_t height = 540;      // pixels, [1, 8192]
    uint32_t seed = 1;          // of everything random
    double fps = 30.0;          // (0, 240]; simulated rate headless, limit of the window's rate
    bool validate = false;      // Vulkan validation layers; any message makes the sample fail
    bool noMsaa = false;        // one sample a pixel, of samples that take four
    bool lendScene = false;     // flames fade where they meet things: the scene's depth is lent
    bool halfEffects = false;   // the same, drawn at half resolution
    bool list = false;          // the sample says what it can show, and ends
    std::filesystem::path out;  // folder of the pictures; default out/<name>
    std::vector<std::string> positional;
};

class OptionParser {
 public:
    // `name` is the executable's, `about` one line, `positional` e.g. "[FILE.glb]" or "".
    OptionParser(std::string name, std::string about, std::string positional = "");

    void addFlag(const std::string& name, const std::string& help, bool& value);
    void addText(const std::string& name, const std::string& what, const std::string& help,
                 std::string& value);
    void addNumber(const std::string& name, const std::string& help, float& value, float low,
                   float high);
    // "x,y,z". `given`, if not null, says whether it was there.
    void addVector(const std::string& name, const std::string& help, float value[3],
                   bool* given = nullptr);

    // --lend and --half, of samples that can.
    void addLending(Options& options);

    // False: there was nothing more to do (--help was answered). Throws Failure.
    bool parse(int argc, char** argv, Options& options) const;
    void printHelp() const;

 private:
    struct Entry {
        std::string name, what, help;
        std::function<void(const std::string&)> take;
    };
    std::string name_, about_, positional_;
    std::vector<Entry> entries_;
};

// How many frames a run takes that shows so many seconds where the options name no number of
// frames; 0 with a window, which has no end.
uint32_t framesOf(const Options& options, double seconds);

// Throws Failure unless `text` is a whole number within [low, high].
uint32_t parseWhole(const std::string& name, const std::string& text, uint32_t low, uint32_t high);
// Throws Failure unless `text` is a finite number within [low, high].
double parseNumber(const std::string& name, const std::string& text, double low, double high);

// Runs `body`, prints what it throws, and returns the exit code: the whole of a sample's main().
int guardedMain(const char* name, const std::function<int()>& body);

}  // namespace sample
