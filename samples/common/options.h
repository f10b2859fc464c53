// The command line that all samples share, plus the options of one sample. Values are flags, words,
// numbers and "x,y,z".
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace sample {

// A message for the user: names the item, its value and the allowed values.
struct Failure : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct Options {
    bool headless = false;  // no window, pictures in `out`; also without a display
    uint32_t frames = 0;    // frames to run; 0: the sample's default, or until the window closes
    uint32_t width = 960;   // pixels, [1, 8192]
    uint32_t height = 540;  // pixels, [1, 8192]
    uint32_t seed = 1;      // of all random numbers
    double fps = 30.0;      // (0, 240]; simulated rate headless, upper limit in a window
    bool validate = false;  // Vulkan validation layers; any message fails the sample
    bool noMsaa = false;    // one sample per pixel in samples that use four
    bool compositeEffects =
        false;                  // flames composite over the scene and fade where they meet surfaces
    bool halfEffects = false;   // the same at half resolution
    bool list = false;          // lists the sample's scenes and exits
    std::filesystem::path out;  // folder of the pictures, default out/<name>
    std::vector<std::string> positional;
};

class OptionParser {
 public:
    // `name`: the executable's; `about`: one line; `positional`: for example "[FILE.glb]", or "".
    OptionParser(std::string name, std::string about, std::string positional = "");

    void addFlag(const std::string& name, const std::string& help, bool& value);
    void addText(const std::string& name, const std::string& what, const std::string& help,
                 std::string& value);
    void addNumber(const std::string& name, const std::string& help, float& value, float low,
                   float high);
    // "x,y,z". If `given` is not null, it reports whether the option was present.
    void addVector(const std::string& name, const std::string& help, float value[3],
                   bool* given = nullptr);

    // Adds --composite and --half.
    void addCompositeFlags(Options& options);

    // Returns false if nothing is left to do (--help was answered). Throws Failure.
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

// Returns the number of frames that show `seconds`, unless the options set a number. Returns 0 with
// a window, which has no fixed end.
uint32_t framesOf(const Options& options, double seconds);

// Throws Failure unless `text` is a whole number within [low, high].
uint32_t parseWhole(const std::string& name, const std::string& text, uint32_t low, uint32_t high);
// Throws Failure unless `text` is a finite number within [low, high].
double parseNumber(const std::string& name, const std::string& text, double low, double high);

// Runs `body`, prints its exception, and returns the exit code. It is the whole of a sample's
// main().
int guardedMain(const char* name, const std::function<int()>& body);

}  // namespace sample
