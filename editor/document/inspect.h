// Questions to a burn: when each spot catches, and why one did not. The whole burn is run once on
// the cpu backend; scrubbing then only compares times.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "document/burn.h"

namespace fwedit {

constexpr float kNeverLit = 3.0e38f;  // s

struct ArrivalField {  // of one mesh
    ObjectId mesh = 0;
    uint32_t width = 0, height = 0;
    std::vector<float> seconds;  // when each texel of the burn map caught; kNeverLit
    std::vector<uint8_t> baked;  // the same for fwWorld_CreateBurn; empty: nothing caught
};
struct BurnRecord {
    double duration = 0;  // s that were run
    std::vector<ArrivalField> fields;
    std::vector<FwEvent> events;  // of the world, in order; see Burn::meshes for whose
    std::vector<ObjectId> eventMeshes;
};
// `stop` is asked at times; true: ends with what is there so far. Needs a context of the cpu
// backend.
bool recordBurn(FwContext* cpu, const Scene& scene, const PaintImages& images,
                const std::filesystem::path& folder, Assets& assets, BurnRecord& record,
                std::string& error, const std::function<bool(double time)>& stop = {});

// Share of a mesh's texels that caught by `time`, for the burn strip.
float litShare(const ArrivalField& field, float time);
// Burn time as bytes for a heat map, 0 earliest to 254 latest of `duration`, 255 never.
std::vector<uint8_t> burnTimeMap(const ArrivalField& field, float duration);

struct WhyAnswer {
    std::string answer;               // "Not lit: heat 0.62 of 0.70, wet 30 %, ..."
    std::vector<std::string> causes;  // by size
    std::string forecast;             // "Arrives in 4.1 s from the left."
    float heat = 0, needs = 0;        // [0, 1] of its ignition temperature's rise
    float wet = 0;                    // share of what it can hold
    float multiplier = 1;
    float arrivesIn = kNeverLit;  // s
};
struct WhyQuestion {  // to a burn, on its way
    ObjectId mesh = 0;
    Vec3 position{};  // m, world
    FwQueryId pointQuery{}, arrivalQuery{};
    FwPointState point{};
    bool pointKnown = false, asksArrival = false;
};
// Begins a question; whoever records or steps the world then polls it after each frame, of no
// length if it stands still. The context's message says what is wrong; the answer is there with
// FW_OK, and FW_NOT_READY means later. Once pointKnown, all but the forecast is there already: that
// runs the front ahead, which can take many frames.
bool beginWhy(Burn& burn, ObjectId mesh, Vec3 worldPosition, WhyQuestion& question,
              std::string& error);
FwResult pollWhy(Burn& burn, const PaintImages& images, WhyQuestion& question, WhyAnswer& answer,
                 std::string& error);
// The same at once, of a world of the cpu backend that stands at a time (runBurn).
bool askWhy(Burn& burn, const PaintImages& images, ObjectId mesh, Vec3 worldPosition,
            WhyAnswer& answer, std::string& error);

}  // namespace fwedit
