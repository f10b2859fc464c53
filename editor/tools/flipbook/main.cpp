// flamewright_flipbook: bakes and shows .fwbook files. See --help.
#include "finish.h"
#include "sheet.h"
#include "store.h"
#include "whole_file.h"

#include "core/error.h"

#include <OpenImageIO/imageio.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string>
#include <thread>

namespace {

using namespace fw;
using namespace fwtools;

constexpr const char* kHelp =
    "flamewright_flipbook SCENE OUT.fwbook [options]   bakes a flipbook\n"
    "flamewright_flipbook --import SHEET OUT.fwbook [options]   imports an artist's sheet\n"
    "flamewright_flipbook --sheet OUT.png FLIPBOOK... a picture with eight frames of each\n"
    "  --frames N      [2, 256], default 64\n"
    "  --size N        texels per side, [8, 512], default 128\n"
    "  --seconds S     duration, (0, 600], default: 2 for loops, 1 for one-shots\n"
    "  --samples N     rays per texel, [1, 16], default 2\n"
    "  --seed N        default 1\n"
    "  --threads N     frames at a time, default: number of processors\n"
    "  --quiet         no progress\n"
    "An interrupted bake leaves OUT.fwbook.part and resumes from it.\n"
    "A sheet (PNG, EXR, TIFF, ...) has its frames in a grid, to the right, then down:\n"
    "  --grid CxR      columns and rows, [1, 256] each, default 8x8\n"
    "  --kind KIND     fire, smoke or spark, default fire\n"
    "  --once          it does not loop\n"
    "  --frames N      default: the whole grid;  --size N  default: the sheet's size\n"
    "Integer images are sRGB with straight alpha; float images are linear and premultiplied.\n"
    "Without alpha, black is empty. Float images with zero alpha everywhere are additive.\n"
    "The hue of a fire becomes its temperature: red 1370 K, yellow 1780 K.\n";

struct Options {
    std::string scene, out, sheet, picture;
    std::vector<std::string> flipbooks;
    BakeDef bake;
    SheetDef grid;  // for `picture`
    float seconds = 0;
    uint32_t threads = std::max(std::thread::hardware_concurrency(), 1u);
    bool quiet = false;
};

int refuse(const std::string& what) {
    std::fprintf(stderr, "flamewright_flipbook: %s\n", what.c_str());
    return 2;
}

// Parses an integer option. Returns false if it is invalid or out of range.
bool number(const char* name, const char* text, uint32_t low, uint32_t high, uint32_t& value) {
    char* end = nullptr;
    const unsigned long read = std::strtoul(text, &end, 10);
    if (*text >= '0' && *text <= '9' && *end == 0 && read >= low && read <= high) {
        value = uint32_t(read);
        return true;
    }
    (void)refuse(std::string(name) + " is " + text + "; it must lie in [" + std::to_string(low) +
                 ", " + std::to_string(high) + "]");
    return false;
}

// Parses "8x4". Returns false if it is invalid.
bool grid(const std::string& text, SheetDef& def) {
    const size_t by = text.find('x');
    if (by == std::string::npos) {
        (void)refuse("--grid is " + text + "; it must be columns and rows, as in 8x4");
        return false;
    }
    return number("--grid's columns", text.substr(0, by).c_str(), 1, 256, def.columns) &&
           number("--grid's rows", text.substr(by + 1).c_str(), 1, 256, def.rows);
}

bool kindOf(const std::string& text, flipbook::Kind& kind) {
    constexpr const char* kNames[flipbook::kKinds] = {"fire", "smoke", "spark"};
    for (uint32_t i = 0; i < flipbook::kKinds; ++i)
        if (text == kNames[i]) {
            kind = flipbook::Kind(i);
            return true;
        }
    (void)refuse("--kind is " + text + "; it must be fire, smoke or spark");
    return false;
}

// Returns 0 to continue, otherwise the exit status.
int parse(int count, char** words, Options& options) {
    flipbook::Facts& facts = options.bake.facts;
    uint32_t side = 0;
    facts.frames = 0;
    std::vector<std::string> plain;
    for (int i = 1; i < count; ++i) {
        const std::string word = words[i];
        const auto is = [&](const char* name) { return word == name && i + 1 < count; };
        const struct {
            const char* name;
            uint32_t low, high;
            uint32_t& value;
        } numbers[] = {{"--frames", 2, flipbook::kMaxFrames, facts.frames},
                       {"--size", flipbook::kMinSide, flipbook::kMaxSide, side},
                       {"--samples", 1, 16, options.bake.samples},
                       {"--seed", 1, 1000000, options.bake.seed},
                       {"--threads", 1, 256, options.threads}};
        bool known = false;
        for (const auto& one : numbers)
            if (is(one.name)) {
                known = true;
                if (!number(one.name, words[++i], one.low, one.high, one.value)) return 2;
                break;
            }
        if (known) continue;
        if (word == "--seconds" && i + 1 < count) {
            options.seconds = float(std::atof(words[++i]));
            if (!(options.seconds > 0 && options.seconds <= 600))
                return refuse("--seconds is " + std::string(words[i]) +
                              "; it must lie in (0, 600]");
        } else if (word == "--sheet" && i + 1 < count) {
            options.sheet = words[++i];
        } else if (word == "--import" && i + 1 < count) {
            options.picture = words[++i];
        } else if (word == "--grid" && i + 1 < count) {
            if (!grid(words[++i], options.grid)) return 2;
        } else if (word == "--kind" && i + 1 < count) {
            if (!kindOf(words[++i], options.grid.facts.kind)) return 2;
        } else if (word == "--once") {
            options.grid.facts.loops = 0;
        } else if (word == "--quiet") {
            options.quiet = true;
        } else if (word == "--help") {
            std::fputs(kHelp, stdout);
            std::fputs("Scenes:", stdout);
            for (const std::string_view name : sceneNames())
                std::printf(" %s", std::string(name).c_str());
            std::fputs("\n", stdout);
            std::exit(0);
        } else if (word.rfind("--", 0) == 0) {
            return refuse("there is no option " + word + "; see --help");
        } else {
            plain.push_back(word);
        }
    }
    if (!options.sheet.empty()) {
        options.flipbooks = plain;
        return plain.empty() ? refuse("--sheet needs flipbooks; see --help") : 0;
    }
    if (!options.picture.empty()) {
        options.grid.side = side;
        options.grid.facts.frames = facts.frames;
        if (plain.size() != 1) return refuse("--import needs a sheet and a flipbook; see --help");
        options.out = plain[0];
        return 0;
    }
    if (facts.frames == 0) facts.frames = flipbook::Facts().frames;
    if (side == 0) side = flipbook::Facts().width;
    facts.width = facts.height = side;
    facts.motionWidth = facts.motionHeight = std::max(side / 2, 4u);
    if (plain.size() != 2) return refuse("a scene and a file are needed; see --help");
    options.scene = plain[0];
    options.out = plain[1];
    return 0;
}

uint64_t settingsOf(const Options& o) {
    const flipbook::Facts& f = o.bake.facts;
    uint64_t hash = 1469598103934665603ull;
    const auto add = [&](const void* data, size_t bytes) {
        for (size_t i = 0; i < bytes; ++i)
            hash = (hash ^ static_cast<const uint8_t*>(data)[i]) * 1099511628211ull;
    };
    constexpr uint32_t kBake = 2;  // increase it with every change of the bake
    add(o.scene.data(), o.scene.size());
    for (const uint32_t word : {kBake, f.frames, f.width, f.height, o.bake.seed, o.bake.samples})
        add(&word, sizeof word);
    add(&f.seconds, sizeof f.seconds);
    return hash;
}

class Progress {
 public:
    Progress(uint32_t count, uint32_t there, bool quiet)
        : count_(count), there_(there), done_(there), quiet_(quiet) {}
    void step() {
        const std::lock_guard<std::mutex> lock(mutex_);
        ++done_;
        if (quiet_) return;
        const double spent =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
        const double left = spent / (done_ - there_) * (count_ - done_);
        const uint32_t marks = 32 * done_ / count_;
        std::fprintf(stderr, "\r[%.*s%.*s] %u of %u frames, %.0f s left ", int(marks),
                     "################################", int(32 - marks),
                     "................................", done_, count_, left);
        if (done_ == count_) std::fputs("\n", stderr);
    }

 private:
    std::mutex mutex_;
    uint32_t count_, there_, done_;
    bool quiet_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Finishes the frames and writes the file. Returns the exit status.
int finish(const Options& options, const flipbook::Facts& facts, std::vector<Frame>& frames) {
    const flipbook::Flipbook made =
        finishFlipbook(facts, frames, options.threads, std::pmr::get_default_resource());
    const auto bytes = flipbook::cookFlipbook(made, std::pmr::get_default_resource());
    const std::string error = replaceFile(options.out, bytes);
    if (!error.empty()) return refuse(error);
    std::printf("%s: %u frames of %u x %u, %s, motion up to %.3f of the frame, %.1f MiB\n",
                options.out.c_str(), facts.frames, facts.width, facts.height,
                facts.loops ? "a loop" : "once", double(made.facts.maxMotion),
                double(bytes.size()) / (1 << 20));
    return 0;
}

int bake(Options& options) {
    flipbook::Facts& facts = options.bake.facts;
    if (!sceneKind(options.scene, facts))
        return refuse("there is no scene " + options.scene + "; see --help");
    if (options.seconds > 0) facts.seconds = options.seconds;
    options.bake.scene = options.scene;
    const std::unique_ptr<Scene> scene = makeScene(options.bake);
    std::string error;
    FrameStore store(options.out + ".part", settingsOf(options), scene->frames(),
                     facts.width * facts.height, facts.loops == 0, error);
    if (!error.empty()) return refuse(error);
    uint32_t there = 0;
    for (uint32_t i = 0; i < scene->frames(); ++i) there += store.has(i);
    if (there > 0 && !options.quiet) std::fprintf(stderr, "%u frames are there already\n", there);
    Progress progress(scene->frames(), there, options.quiet);
    std::atomic<bool> whole{true};
    inParallel(scene->frames(), options.threads, [&](uint32_t i) {
        if (store.has(i)) return;
        Frame frame;
        scene->render(i, frame);
        if (!store.put(i, frame)) whole = false;
        progress.step();
    });
    std::vector<Frame> frames(scene->frames());
    for (uint32_t i = 0; i < scene->frames(); ++i) whole = whole && store.get(i, frames[i]);
    if (!whole) return refuse(options.out + ".part cannot be written or read");
    const int status = finish(options, facts, frames);
    if (status == 0) store.forget();
    return status;
}

int import(const Options& options) {
    fwimport::FloatPicture picture;
    std::string error;
    if (!fwimport::readPicture(options.picture, picture, error)) return refuse(error);
    SheetDef def = options.grid;
    if (options.seconds > 0)
        def.facts.seconds = options.seconds;
    else
        def.facts.seconds = def.facts.loops ? 2.0f : 1.0f;
    std::vector<Frame> frames;
    if (!framesOfSheet(picture, def, frames, error)) return refuse(options.picture + ": " + error);
    return finish(options, def.facts, frames);
}

int sheet(const Options& options) {
    std::vector<flipbook::Flipbook> flipbooks;
    for (const std::string& path : options.flipbooks) {
        std::vector<std::byte> bytes;
        const std::string error = readWhole(path, bytes);
        if (!error.empty()) return refuse(error);
        flipbooks.emplace_back(std::pmr::get_default_resource());
        try {
            flipbook::readFlipbook(bytes, flipbooks.back());
        } catch (const core::Error& e) {
            return refuse(path + ": " + e.message);
        }
    }
    const Picture picture = makeSheet(flipbooks);
    const auto out = OIIO::ImageOutput::create(options.sheet);
    const OIIO::ImageSpec spec(int(picture.width), int(picture.height), 3, OIIO::TypeDesc::UINT8);
    if (!out || !out->open(options.sheet, spec) ||
        !out->write_image(OIIO::TypeDesc::UINT8, picture.rgb.data()) || !out->close())
        return refuse(options.sheet + " cannot be written");
    std::printf("%s: %zu flipbooks\n", options.sheet.c_str(), flipbooks.size());
    return 0;
}

}  // namespace

int main(int count, char** words) {
    Options options;
    const int status = parse(count, words, options);
    if (status != 0) return status;
    try {
        if (!options.sheet.empty()) return sheet(options);
        return options.picture.empty() ? bake(options) : import(options);
    } catch (const core::Error& e) {
        return refuse(e.message);
    }
}
