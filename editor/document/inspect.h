// Queries a burn: when each point ignites, and why one did not. The whole burn runs once on the cpu
// backend; scrubbing then only compares times.
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
    std::vector<float> seconds;  // ignition time per burn map texel; kNeverLit: never
    std::vector<uint8_t> baked;  // the same for fwWorld_CreateBurn; empty: nothing ignited
};
struct BurnRecord {
    double duration = 0;  // s, simulated time
    std::vector<ArrivalField> fields;
    std::vector<FwEvent> events;  // events of the world, in order; Burn::meshes maps their ids to
                                  // objects
    std::vector<ObjectId> eventMeshes;
};
// Runs the whole burn. Calls `stop` regularly; true ends it with the results so far. Needs a cpu
// context.
bool recordBurn(FwContext* cpu, const Scene& scene, const PaintImages& images,
                const std::filesystem::path& folder, Assets& assets, BurnRecord& record,
                std::string& error, const std::function<bool(double time)>& stop = {});

// Returns the share of a mesh's texels that ignited by `time`, for the burn strip.
float litShare(const ArrivalField& field, float time);
// Returns ignition times as bytes for a heat map: 0 earliest to 254 latest within `duration`, 255
// never.
std::vector<uint8_t> burnTimeMap(const ArrivalField& field, float duration);

struct WhyAnswer {
    std::string answer;               // "Not lit: heat 0.62 of 0.70, wet 30 %, ..."
    std::vector<std::string> causes;  // largest first
    std::string forecast;             // "Arrives in 4.1 s from the left."
    float heat = 0, needs = 0;        // [0, 1] of the temperature rise to ignition
    float wet = 0;                    // share of the maximum
    float multiplier = 1;
    float arrivesIn = kNeverLit;  // s
};
struct WhyQuestion {  // a pending query
    ObjectId mesh = 0;
    Vec3 position{};  // m, world
    FwQueryId pointQuery{}, arrivalQuery{};
    FwPointState point{};
    bool pointKnown = false, asksArrival = false;
};
// Starts a query. The owner of the world then polls it after each frame (deltaTime may be 0).
// FW_OK: the answer is complete; FW_NOT_READY: poll again; otherwise see the context's message.
// Once pointKnown is set, only the forecast is missing. The forecast runs the burning front ahead,
// which can take many frames.
bool beginWhy(Burn& burn, ObjectId mesh, Vec3 worldPosition, WhyQuestion& question,
              std::string& error);
FwResult pollWhy(Burn& burn, const PaintImages& images, WhyQuestion& question, WhyAnswer& answer,
                 std::string& error);
// Returns the answer at once. Needs a world of the cpu backend at a fixed time (runBurn).
bool askWhy(Burn& burn, const PaintImages& images, ObjectId mesh, Vec3 worldPosition,
            WhyAnswer& answer, std::string& error);

}  // namespace fwedit
