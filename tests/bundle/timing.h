// The parts of flamewright-check that use the device, each for a process of its own.
#pragma once
#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace fw::bundle {

// The burn hashes of one backend: {"device", "points": [{"scene", "seconds", "ignited", "hash"}]}.
nlohmann::json hashFacts(uint32_t backend);

struct TimingRequest {
    std::string scene;    // a name of timedScenes()
    std::string picture;  // PNG file of the first size; "_small" before the ending: half of it
    std::vector<std::pair<uint32_t, uint32_t>> sizes;  // px
    float burns = 1;                                   // share of TimedScene::seconds
    uint32_t warmUp = 1, frames = 1;                   // per size
};
// Mean milliseconds per pass over the frames, by the device's timers. Throws std::runtime_error.
nlohmann::json timeScene(const TimingRequest& request);

}  // namespace fw::bundle
