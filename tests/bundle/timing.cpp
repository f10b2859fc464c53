#include "bundle/timing.h"

#include "bundle/child.h"
#include "bundle/scenes.h"
#include "common/yard.h"
#include "support/png_file.h"

#include <flamewright/flamewright_debug.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <stdexcept>

using nlohmann::json;

namespace fw::bundle {
namespace {

using test::Picture;

constexpr float kFrameTime = 1.0f / 60, kSetUpTime = 0.125f;  // s

// Milliseconds of each pass of one part of a frame: a step, or a picture, whose frame index is 0.
class PassSums {
 public:
    PassSums(const char* part, bool pictures) : part_(part), pictures_(pictures) {}
    // Times that are not of this part, or were added before, are of a frame that recorded nothing.
    double add(FwWorld* world) {
        std::vector<FwPassTime> times(fwDebug_GetPassTimes(world, nullptr, 0));
        times.resize(std::min<size_t>(
            fwDebug_GetPassTimes(world, times.data(), uint32_t(times.size())), times.size()));
        double sum = 0;
        uint64_t newest = last_;
        for (const FwPassTime& time : times) {
            if ((time.frameIndex == 0) != pictures_) continue;
            if (!pictures_ && time.frameIndex <= last_) continue;
            newest = std::max(newest, time.frameIndex);
            auto at = std::find_if(passes_.begin(), passes_.end(),
                                   [&](const auto& pass) { return pass.first == time.name; });
            if (at == passes_.end()) at = passes_.insert(at, {time.name, 0});
            at->second += time.milliseconds;
            sum += time.milliseconds;
        }
        last_ = newest;
        return sum;
    }
    void write(json& out, double frames) const {
        for (const auto& [name, milliseconds] : passes_)
            out.push_back({{"part", part_}, {"name", name}, {"ms", milliseconds / frames}});
    }

 private:
    const char* part_;
    bool pictures_;
    uint64_t last_ = 0;
    std::vector<std::pair<std::string, double>> passes_;  // in the order of a frame
};

Picture halfOf(const Picture& full) {
    Picture half{full.width / 2, full.height / 2, {}};
    half.rgb.resize(size_t{half.width} * half.height * 3);
    for (size_t y = 0; y < half.height; ++y)
        for (size_t x = 0; x < size_t{half.width} * 3; ++x) {
            const size_t row = size_t{full.width} * 3;
            const uint8_t* from = &full.rgb[2 * y * row + x / 3 * 6 + x % 3];
            half.rgb[y * half.width * 3 + x] =
                uint8_t((from[0] + from[3] + from[row] + from[row + 3] + 2) / 4);
        }
    return half;
}

void savePictures(const std::string& path, const FwOffscreenDef& shot) {
    const auto* pixels = static_cast<const uint8_t*>(shot.pixels);
    Picture full{shot.width, shot.height, {}};
    for (size_t i = 0; i < size_t{shot.width} * shot.height; ++i)
        full.rgb.insert(full.rgb.end(), pixels + i * 4, pixels + i * 4 + 3);
    const std::string small = path.substr(0, path.rfind('.')) + "_small.png";
    if (!test::writePng(path, full) || !test::writePng(small, halfOf(full)))
        throw std::runtime_error(path + " cannot be written");
}

json timeFrames(Scene& scene, const TimingRequest& request, uint32_t width, uint32_t height,
                bool picture) {
    std::vector<uint8_t> pixels(size_t{width} * height * 4);
    FwOffscreenDef shot = fwDefaultOffscreenDef();
    shot.width = width;
    shot.height = height;
    shot.pixels = pixels.data();
    constexpr float kDusk[3] = {0.010f, 0.014f, 0.024f};
    std::copy_n(kDusk, 3, shot.background);
    PassSums step("step", false), draws("picture", true);
    double wall = 0, sum = 0, most = 0;
    for (uint32_t frame = 0; frame < request.warmUp + request.frames; ++frame) {
        const Clock::time_point start = Clock::now();
        scene.advance(kFrameTime);
        const bool counts = frame >= request.warmUp;
        double all = counts ? step.add(scene.world) : 0;
        shot.view = scene.view(float(width) / float(height));
        check(fwWorld_RenderOffscreen(scene.world, &shot), scene.world);
        if (!counts) continue;
        all += draws.add(scene.world);
        wall += secondsSince(start) * 1e3;
        sum += all;
        most = std::max(most, all);
    }
    if (picture) savePictures(request.picture, shot);
    json out = {{"width", width},           {"height", height},
                {"frames", request.frames}, {"ms", sum / request.frames},
                {"mostMs", most},           {"wallMs", wall / request.frames},
                {"passes", json::array()}};
    step.write(out["passes"], request.frames);
    draws.write(out["passes"], request.frames);
    return out;
}

}  // namespace

json hashFacts(uint32_t backend) {
    json out;
    std::string device;
    for (const BurnHash& point : burnHashes(backend, device)) {
        char hash[17];
        std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(point.hash));
        out["points"].push_back({{"scene", point.scene},
                                 {"seconds", point.seconds},
                                 {"ignited", point.ignited},
                                 {"hash", hash}});
    }
    out["device"] = device;
    return out;
}

json timeScene(const TimingRequest& request) {
    const auto scenes = timedScenes();
    const auto found = std::find_if(scenes.begin(), scenes.end(), [&](const TimedScene& scene) {
        return scene.name == request.scene;
    });
    if (found == scenes.end())
        throw std::runtime_error("no scene is called \"" + request.scene + "\"");
    const Clock::time_point start = Clock::now();
    const std::unique_ptr<Scene> scene = found->make();
    for (float t = 0; t < found->seconds * request.burns; t += kSetUpTime)
        scene->advance(kSetUpTime);
    json out = {{"setUpSeconds", secondsSince(start)}, {"sizes", json::array()}};
    for (const auto& [width, height] : request.sizes)
        out["sizes"].push_back(timeFrames(*scene, request, width, height, out["sizes"].empty()));
    FwWorldStats stats{};
    stats.structSize = sizeof stats;
    check(fwWorld_GetStats(scene->world, &stats), scene->world);
    FwContextInfo info{};
    info.structSize = sizeof info;
    check(fwContext_GetInfo(scene->context, &info), scene->world);
    out["device"] = info.deviceName;
    out["gpuTimers"] = info.gpuTimers != 0;
    out["gpuMemoryMiB"] = info.gpuMemoryUsed >> 20;
    out["burningObjects"] = stats.burningObjects;
    out["quads"] = stats.flames;
    out["refinedTriangles"] = stats.refinedTriangles;
    return out;
}

}  // namespace fw::bundle
