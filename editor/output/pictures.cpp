// Writes film strips, turntables and flipbooks.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <thread>

#include "import/float_picture.h"
#include "output/output.h"
#include "tools/flipbook/flame_flipbook.h"
#include "tools/whole_file.h"

namespace fwedit {
namespace {

namespace fs = std::filesystem;

void makeFolderOf(const fs::path& file) {
    std::error_code ignored;
    if (file.has_parent_path()) fs::create_directories(file.parent_path(), ignored);
}

std::unique_ptr<Burn> burnOf(const OutputInput& input, FwContext* device, std::string& error) {
    return createBurn(device, input.scene, input.images, input.folder, input.assets, error);
}

// Runs frame by frame, so that it can be cancelled. Progress goes from `from` to `to`.
bool runTo(Burn& burn, double time, float from, float to, const OutputProgress& progress,
           std::string& error) {
    const double start = burn.time, span = std::max(time - start, 1e-6);
    const double frame = 1 / static_cast<double>(burn.scene.settings.framesPerSecond);
    while (burn.time < time - 1e-6) {
        const auto done = static_cast<float>((burn.time - start) / span);
        if (progress && !progress("Burning", from + (to - from) * done)) {
            error = kStopped;
            return false;
        }
        // Whole frames from zero, as the burn itself runs.
        if (!runBurn(burn, std::min(time, burn.time + frame), error)) return false;
    }
    return true;
}

}  // namespace

bool writePixels(const fs::path& file, uint32_t width, uint32_t height,
                 const std::vector<uint8_t>& rgba, std::string& error) {
    fwimport::FloatPicture picture;
    picture.width = width;
    picture.height = height;
    picture.channels = 3;
    picture.whole = true;
    picture.names = {"R", "G", "B"};
    picture.values.reserve(rgba.size() / 4 * 3);
    for (size_t i = 0; i < rgba.size(); i += 4)
        for (size_t c = 0; c < 3; ++c)
            picture.values.push_back(static_cast<float>(rgba[i + c]) / 255.0f);
    makeFolderOf(file);
    return fwimport::writePicture(file, picture, error);
}

bool writeFilmstrip(const OutputInput& input, FwContext* device, const FilmstripDef& def,
                    const fs::path& file, const OutputProgress& progress, std::string& error) {
    const auto burn = burnOf(input, device, error);
    if (!burn) return false;
    const uint32_t columns = std::clamp(def.columns, 1u, def.count);
    const uint32_t rows = (def.count + columns - 1) / columns;
    const uint32_t width = columns * (def.width + def.gap) - def.gap;
    const uint32_t height = rows * (def.height + def.gap) - def.gap;
    std::vector<uint8_t> strip(size_t{width} * height * 4, 16), one;
    const auto duration = static_cast<double>(input.scene.settings.duration);
    for (uint32_t i = 0; i < def.count; ++i) {
        const auto before = static_cast<float>(i) / static_cast<float>(def.count);
        const auto after = static_cast<float>(i + 1) / static_cast<float>(def.count);
        // The first picture shows the start, the last one the end.
        const double time = def.count > 1 ? duration * i / (def.count - 1) : 0;
        if (!runTo(*burn, time, before, after, progress, error) ||
            !shootBurn(*burn, def.width, def.height, one, error))
            return false;
        const uint32_t left = i % columns * (def.width + def.gap);
        const uint32_t top = i / columns * (def.height + def.gap);
        for (uint32_t y = 0; y < def.height; ++y)
            std::memcpy(&strip[(size_t{top + y} * width + left) * 4],
                        &one[size_t{y} * def.width * 4], size_t{def.width} * 4);
    }
    return writePixels(file, width, height, strip, error);
}

bool writeTurntable(const OutputInput& input, FwContext* device, const TurntableDef& def,
                    const fs::path& out, const OutputProgress& progress,
                    std::vector<fs::path>& files, std::string& error) {
    const auto burn = burnOf(input, device, error);
    constexpr float kBurning = 0.5f;  // share of the work before the first picture
    if (!burn || !runTo(*burn, def.time, 0, kBurning, progress, error)) return false;
    std::vector<uint8_t> rgba;
    for (uint32_t i = 0; i < def.count; ++i) {
        const auto share = static_cast<float>(i) / static_cast<float>(def.count);
        if (progress && !progress("Taking pictures", kBurning + (1 - kBurning) * share)) {
            error = kStopped;
            return false;
        }
        burn->scene.camera.yaw = input.scene.camera.yaw + 360 * share;
        char name[32];
        std::snprintf(name, sizeof name, "turn_%03u.png", i + 1);
        if (!shootBurn(*burn, def.width, def.height, rgba, error) ||
            !writePixels(out / name, def.width, def.height, rgba, error))
            return false;
        files.push_back(out / name);
    }
    return true;
}

bool writeFlipbook(const OutputInput& input, ObjectId id, const FlipbookDef& def,
                   const fs::path& file, const OutputProgress& progress, std::string& error) {
    const Flame* flame = findIn(input.scene.flames, id);
    if (!flame) {
        error = "there is no such flame in the scene";
        return false;
    }
    FlameShape shape;
    if (hasShape(*flame) && !shapeOf(*flame, input.folder, shape, error)) return false;
    fwtools::FlameFlipbookDef flipbook;
    flipbook.preset = flame->preset;
    flipbook.power = flame->power;
    flipbook.diameter = flame->diameter;
    flipbook.texels = shape.texels;
    flipbook.width = shape.width;
    flipbook.height = shape.height;
    flipbook.cooked = std::as_bytes(std::span(shape.cooked));
    flipbook.frames = def.frames;
    flipbook.side = def.side;
    flipbook.seconds = def.seconds;
    flipbook.threads = std::max(1u, std::thread::hardware_concurrency());
    std::vector<std::byte> bytes;
    const auto reportStage = [&](float share) {
        return !progress || progress("Looking at " + flame->name, share);
    };
    if (!fwtools::bakeFlameFlipbook(flipbook, reportStage, bytes, error)) {
        if (error.empty()) error = kStopped;
        return false;
    }
    makeFolderOf(file);
    error = fwtools::replaceFile(file.string(), bytes);
    return error.empty();
}

}  // namespace fwedit
