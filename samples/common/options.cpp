// See options.h.
#include "common/options.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace sample {
namespace {

bool displayPresent() {
    const char* x11 = std::getenv("DISPLAY");
    const char* wayland = std::getenv("WAYLAND_DISPLAY");
    return (x11 && *x11) || (wayland && *wayland);
}

bool environmentSwitch(const char* name) {
    const char* value = std::getenv(name);
    return value && *value && std::string(value) != "0";
}

}  // namespace

uint32_t parseWhole(const std::string& name, const std::string& text, uint32_t low, uint32_t high) {
    char* end = nullptr;
    const unsigned long long value = std::strtoull(text.c_str(), &end, 10);
    if (text.empty() || text[0] == '-' || *end != '\0' || value < low || value > high) {
        throw Failure(name + " is \"" + text + "\"; it takes a whole number from " +
                      std::to_string(low) + " to " + std::to_string(high));
    }
    return static_cast<uint32_t>(value);
}

double parseNumber(const std::string& name, const std::string& text, double low, double high) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0' || !std::isfinite(value) || value < low || value > high) {
        std::ostringstream message;
        message << name << " is \"" << text << "\"; it takes a number from " << low << " to "
                << high;
        throw Failure(message.str());
    }
    return value;
}

OptionParser::OptionParser(std::string name, std::string about, std::string positional)
    : name_(std::move(name)), about_(std::move(about)), positional_(std::move(positional)) {}

void OptionParser::addFlag(const std::string& name, const std::string& help, bool& value) {
    entries_.push_back({name, "", help, [&value](const std::string&) { value = true; }});
}

void OptionParser::addText(const std::string& name, const std::string& what,
                           const std::string& help, std::string& value) {
    entries_.push_back({name, what, help, [&value](const std::string& text) { value = text; }});
}

void OptionParser::addNumber(const std::string& name, const std::string& help, float& value,
                             float low, float high) {
    entries_.push_back({name, "N", help, [=, &value](const std::string& text) {
                            value = static_cast<float>(parseNumber(name, text, low, high));
                        }});
}

void OptionParser::addVector(const std::string& name, const std::string& help, float value[3],
                             bool* given) {
    entries_.push_back({name, "X,Y,Z", help, [=](const std::string& text) {
                            std::istringstream stream(text);
                            std::string part;
                            std::vector<float> parts;
                            while (std::getline(stream, part, ',')) {
                                parts.push_back(
                                    static_cast<float>(parseNumber(name, part, -1e6, 1e6)));
                            }
                            if (parts.size() != 3) {
                                throw Failure(name + " is \"" + text + "\"; it takes x,y,z");
                            }
                            std::copy(parts.begin(), parts.end(), value);
                            if (given) *given = true;
                        }});
}

void OptionParser::addCompositeFlags(Options& options) {
    addFlag("--composite", "composite over the scene: flames fade where they meet surfaces",
            options.compositeEffects);
    addFlag("--half", "the same, with flames and smoke at half resolution", options.halfEffects);
}

void OptionParser::printHelp() const {
    std::printf("%s: %s\n\nusage: %s [options] %s\n\n", name_.c_str(), about_.c_str(),
                name_.c_str(), positional_.c_str());
    auto line = [](const std::string& left, const std::string& help) {
        std::printf("  %-22s %s\n", left.c_str(), help.c_str());
    };
    for (const Entry& entry : entries_) line(entry.name + " " + entry.what, entry.help);
    line("--headless", "no window; write pictures (also without a display)");
    line("--frames N", "how many frames to run");
    line("--size WxH", "picture size in pixels");
    line("--fps N", "frame rate: simulated headless, upper limit in a window");
    line("--seed N", "seed of all random numbers");
    line("--out DIR", "folder for the pictures, default out/" + name_);
    line("--validate", "Vulkan validation layers; any message fails the sample");
    line("--list", "list the scenes and exit");
    line("--help", "print this text");
}

bool OptionParser::parse(int argc, char** argv, Options& options) const {
    if (options.out.empty()) options.out = std::filesystem::path("out") / name_;
    options.validate = options.validate || environmentSwitch("FLAMEWRIGHT_VALIDATION");
    for (int i = 1; i < argc; ++i) {
        std::string argument = argv[i];
        std::string inlineValue;
        bool hasInline = false;
        if (argument.rfind("--", 0) == 0) {
            if (const size_t equals = argument.find('='); equals != std::string::npos) {
                inlineValue = argument.substr(equals + 1);
                argument.resize(equals);
                hasInline = true;
            }
        }
        auto value = [&]() -> std::string {
            if (hasInline) return inlineValue;
            if (i + 1 >= argc) throw Failure(argument + " needs a value after it");
            return argv[++i];
        };
        if (argument == "--help" || argument == "-h") {
            printHelp();
            return false;
        } else if (argument == "--headless") {
            options.headless = true;
        } else if (argument == "--validate") {
            options.validate = true;
        } else if (argument == "--list") {
            options.list = true;
        } else if (argument == "--frames") {
            options.frames = parseWhole(argument, value(), 1, 1000000);
        } else if (argument == "--seed") {
            options.seed = parseWhole(argument, value(), 0, 0xffffffffu);
        } else if (argument == "--fps") {
            options.fps = parseNumber(argument, value(), 0.1, 240.0);
        } else if (argument == "--out") {
            options.out = value();
            if (options.out.empty()) throw Failure("--out is empty; it takes a folder");
        } else if (argument == "--size") {
            const std::string text = value();
            const size_t cross = text.find('x');
            if (cross == std::string::npos) {
                throw Failure("--size is \"" + text + "\"; it takes WIDTHxHEIGHT, as 1280x720");
            }
            options.width = parseWhole("--size width", text.substr(0, cross), 1, 8192);
            options.height = parseWhole("--size height", text.substr(cross + 1), 1, 8192);
        } else if (argument.rfind("-", 0) == 0 && argument.size() > 1) {
            const auto found =
                std::find_if(entries_.begin(), entries_.end(),
                             [&](const Entry& entry) { return entry.name == argument; });
            if (found == entries_.end()) {
                throw Failure("there is no option " + argument + "; --help lists them");
            }
            found->take(found->what.empty() ? std::string() : value());
        } else {
            if (positional_.empty()) {
                throw Failure("\"" + argument +
                              "\" is not expected here; --help lists the options");
            }
            options.positional.push_back(argument);
        }
    }
    options.headless = options.headless || !displayPresent();
    return true;
}

uint32_t framesOf(const Options& options, double seconds) {
    if (options.frames || !options.headless) return options.frames;
    return static_cast<uint32_t>(std::max(1L, std::lround(seconds * options.fps)));
}

int guardedMain(const char* name, const std::function<int()>& body) {
    try {
        return body();
    } catch (const std::exception& error) {
        std::fflush(stdout);
        std::fprintf(stderr, "\n%s: %s\n", name, error.what());
        return 1;
    }
}

}  // namespace sample
