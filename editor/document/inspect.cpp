// See inspect.h.
#include "document/inspect.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdio>

#include "document/world_parts.h"
#include "flamewright/flamewright_debug.h"

namespace fwedit {
namespace {

constexpr float kAir = 293;  // K

FwWorldStats statsOf(FwWorld* world) {
    FwWorldStats stats{};
    stats.structSize = sizeof stats;
    fwWorld_GetStats(world, &stats);
    return stats;
}

// Reads the ignition time of each texel. `start`: the world's first tick.
std::string readField(Burn& burn, const BurnMesh& mesh, uint64_t start, ArrivalField& field) {
    FwMeshInfo info{};
    info.structSize = sizeof info;
    FwResult result = fwWorld_GetMeshInfo(burn.world, mesh.mesh, &info);
    if (result >= 0) result = fwDebug_RequestBurnMap(burn.world, mesh.object);
    if (result < 0) return worldProblem(burn, result);
    std::vector<uint32_t> ticks(size_t{info.mapWidth} * info.mapHeight);
    uint64_t count = 0, hash = 0, now = 0;
    result = fwDebug_FetchBurnMap(burn.world, mesh.object, ticks.data(), ticks.size(), &count,
                                  &hash, &now);
    if (result < 0) return worldProblem(burn, result);
    if (result == FW_NOT_READY) return "The burn map is not ready";
    field.mesh = mesh.id;
    field.width = info.mapWidth;
    field.height = info.mapHeight;
    field.seconds.resize(ticks.size());
    for (size_t i = 0; i < ticks.size(); ++i)
        field.seconds[i] =
            ticks[i] >= kFirstCode
                ? kNeverLit
                : static_cast<float>(double(int64_t(ticks[i]) - int64_t(start)) / kTicksPerSecond);
    if (litShare(field, kNeverLit / 2) == 0) return "";
    uint64_t size = 0;
    result = fwWorld_FetchBurn(burn.world, mesh.object, nullptr, &size);
    if (result < 0) return worldProblem(burn, result);
    field.baked.resize(size);
    result = fwWorld_FetchBurn(burn.world, mesh.object, field.baked.data(), &size);
    return result < 0 ? worldProblem(burn, result) : "";
}

void drainEvents(Burn& burn, BurnRecord& record) {
    FwEvent events[64];
    for (uint32_t n; (n = fwWorld_PollEvents(burn.world, events, 64)) != 0;)
        for (uint32_t i = 0; i < n; ++i) {
            record.events.push_back(events[i]);
            record.eventMeshes.push_back(static_cast<ObjectId>(events[i].userData));
        }
}

std::string number(const char* form, double value) {
    char text[64];
    std::snprintf(text, sizeof text, form, value);
    return text;
}

// Seconds up to a minute, then m:ss.s.
std::string clock(double seconds) {
    if (seconds < 60) return number("%.1f s", seconds);
    const int minutes = static_cast<int>(seconds / 60);
    return std::to_string(minutes) + ":" + number("%04.1f", seconds - 60.0 * minutes);
}

const BurnMesh* burnMeshOf(const Burn& burn, ObjectId id) {
    for (const BurnMesh& mesh : burn.meshes)
        if (mesh.id == id) return &mesh;
    return nullptr;
}

// Returns the direction of a fire relative to the camera.
std::string sideOf(const Scene& scene, const Vec3& at, const Vec3& fire) {
    const FwView view = viewOf(scene, 16, 9, 0);
    float seen[3] = {};
    for (size_t r = 0; r < 3; ++r)
        for (size_t c = 0; c < 3; ++c) seen[r] += view.view[c * 4 + r] * (fire[c] - at[c]);
    const float x = std::abs(seen[0]), y = std::abs(seen[1]), z = std::abs(seen[2]);
    if (x >= y && x >= z) return seen[0] < 0 ? "from the left" : "from the right";
    if (y >= z) return seen[1] < 0 ? "from below" : "from above";
    return seen[2] > 0 ? "from the front" : "from behind";
}

// Describes a point in words. `arrival`: null while the forecast is pending.
void explain(Burn& burn, const PaintImages& images, const WhyQuestion& question,
             const FwArrivalState* arrival, WhyAnswer& answer) {
    const ObjectId meshId = question.mesh;
    const Vec3 worldPosition = question.position;
    const Mesh* mesh = findIn(burn.scene.meshes, meshId);
    const FwPointState& point = question.point;
    // Material of the point: slot and paint of the nearest texel.
    FwMaterialDef material = fwDefaultMaterialDef();
    uint32_t preset = mesh->materials[0];
    answer = {};
    if (const auto surface = burn.surfaceOf(*mesh)) {
        const size_t texel = nearestTexel(
            *surface, positionWithin(transformOf(*mesh),
                                     {point.position[0], point.position[1], point.position[2]}));
        if (texel < surface->material.size())
            preset = mesh->materials[surface->material[texel] & 7];
        uint32_t width = 0, height = 0;
        const std::vector<uint8_t> painted =
            multiplierOf(burn.scene, images, meshId, width, height);
        if (texel < painted.size() && width == surface->width)
            answer.multiplier = static_cast<float>(painted[texel]) / 128;
    }
    fwInitMaterialPreset(&material, preset);

    const float rise = material.ignitionTemperature - kAir;
    answer.heat = rise > 0 ? std::clamp((point.temperature - kAir) / rise, 0.0f, 9.99f) : 0;
    answer.needs = 1;
    answer.wet =
        material.waterHeld > 0 ? std::clamp(point.water / material.waterHeld, 0.0f, 1.0f) : 0;
    if (arrival && arrival->kind == FW_ARRIVAL_AHEAD) answer.arrivesIn = arrival->seconds;

    const std::string heat = "heat " + number("%.2f", double(answer.heat)) + " of " +
                             number("%.2f", double(answer.needs));
    const std::string wet =
        answer.wet > 0.005f ? ", wet " + number("%.0f %%", 100.0 * double(answer.wet)) : "";
    switch (point.kind) {
        case FW_POINT_BURNING:
            answer.answer = "Burning for " + clock(double(point.age)) + ", fuel left " +
                            number("%.0f %%", 100.0 * double(point.fuel));
            return;
        case FW_POINT_BURNT:
            answer.answer = "Burnt: caught " + clock(double(point.age)) + " ago";
            return;
        case FW_POINT_EXTINGUISHED:
            answer.answer = "Put out: " + heat + wet;
            break;
        case FW_POINT_INERT:
            answer.answer = "Never burns: " + heat + wet;
            break;
        default:
            answer.answer = "Not lit: " + heat + wet;
            break;
    }
    struct Cause {
        float size;
        std::string text;
    };
    std::vector<Cause> causes;
    if (preset == FW_MATERIAL_NONCOMBUSTIBLE || point.kind == FW_POINT_INERT)
        causes.push_back({3, answer.multiplier <= 0 ? "Burn multiplier is painted ×0: never burns"
                                                    : "Its material does not burn"});
    else if (answer.multiplier < 1)
        causes.push_back({1 - answer.multiplier, "Burn multiplier slows it to ×" +
                                                     number("%.2f", double(answer.multiplier))});
    if (answer.wet > 0.005f)
        causes.push_back({answer.wet, "Water on it: " + number("%.0f g/m²", double(point.water))});
    const float damp = material.moisture + mesh->moisture;
    if (material.extinctionMoisture > 0 && damp > 0.25f * material.extinctionMoisture)
        causes.push_back(
            {damp / material.extinctionMoisture,
             "Moisture in it: " + number("%.0f %%", 100.0 * double(damp)) + " of " +
                 number("%.0f %% that stop fire", 100.0 * double(material.extinctionMoisture))});
    const FwWorldStats stats = statsOf(burn.world);
    if (stats.burningObjects == 0) causes.push_back({2, "Nothing burns in the scene now"});
    std::stable_sort(causes.begin(), causes.end(),
                     [](const Cause& a, const Cause& b) { return a.size > b.size; });
    for (Cause& cause : causes) answer.causes.push_back(std::move(cause.text));
    if (answer.arrivesIn < kNeverLit) {
        answer.forecast = "Arrives in " + clock(double(answer.arrivesIn));
        FwLight lights[64];
        const uint32_t count = std::min(fwWorld_GetLights(burn.world, lights, 64), 64u);
        float nearest = FLT_MAX;
        Vec3 fire{};
        for (uint32_t i = 0; i < count; ++i) {
            float square = 0;
            for (size_t k = 0; k < 3; ++k) {
                const float off = lights[i].position[k] - worldPosition[k];
                square += off * off;
            }
            if (square >= nearest) continue;
            nearest = square;
            std::copy_n(lights[i].position, 3, fire.begin());
        }
        if (nearest < FLT_MAX) answer.forecast += " " + sideOf(burn.scene, worldPosition, fire);
        answer.answer += ", a" + answer.forecast.substr(1);
    } else if (question.asksArrival && !arrival) {
        answer.forecast = "Predicting when the fire arrives";
    } else if (question.asksArrival) {
        answer.forecast = "Without changes, no fire reaches this spot along the mesh";
    }
}

}  // namespace

bool recordBurn(FwContext* cpu, const Scene& scene, const PaintImages& images,
                const std::filesystem::path& folder, Assets& assets, BurnRecord& record,
                std::string& error, const std::function<bool(double time)>& stop) {
    const auto burn = createBurn(cpu, scene, images, folder, assets, error);
    if (!burn) return false;
    BurnRecord made;
    const uint64_t start = statsOf(burn->world).tick;
    const double end = static_cast<double>(scene.settings.duration);
    while (burn->time < end - 1e-6) {
        if (stop && stop(burn->time)) break;
        // Steps of a quarter second; sources and keys advance per frame within.
        if (!runBurn(*burn, std::min(end, burn->time + 0.25), error)) return false;
        drainEvents(*burn, made);
    }
    made.duration = burn->time;
    for (const BurnMesh& mesh : burn->meshes) {
        error = readField(*burn, mesh, start, made.fields.emplace_back());
        if (!error.empty()) return false;
    }
    record = std::move(made);
    return true;
}

float litShare(const ArrivalField& field, float time) {
    size_t lit = 0, ever = 0;
    for (const float seconds : field.seconds) {
        ever += seconds < kNeverLit;
        lit += seconds <= time;
    }
    return ever == 0 ? 0 : static_cast<float>(lit) / static_cast<float>(ever);
}

std::vector<uint8_t> burnTimeMap(const ArrivalField& field, float duration) {
    std::vector<uint8_t> map(field.seconds.size(), 255);
    for (size_t i = 0; i < map.size(); ++i)
        if (field.seconds[i] < kNeverLit)
            map[i] = static_cast<uint8_t>(std::lround(
                254 * std::clamp(field.seconds[i] / std::max(duration, 1e-3f), 0.0f, 1.0f)));
    return map;
}

bool beginWhy(Burn& burn, ObjectId meshId, Vec3 worldPosition, WhyQuestion& question,
              std::string& error) {
    const Mesh* mesh = findIn(burn.scene.meshes, meshId);
    const BurnMesh* made = burnMeshOf(burn, meshId);
    if (!mesh || !made) {
        error = mesh ? "\"" + mesh->name + "\" is not in the burn" : "Click on a surface";
        return false;
    }
    question = {};
    question.mesh = meshId;
    question.position = worldPosition;
    const FwResult result =
        fwWorld_RequestPoint(burn.world, made->object, worldPosition.data(), &question.pointQuery);
    if (result < 0) error = worldProblem(burn, result);
    return result >= 0;
}

FwResult pollWhy(Burn& burn, const PaintImages& images, WhyQuestion& question, WhyAnswer& answer,
                 std::string& error) {
    const BurnMesh* made = burnMeshOf(burn, question.mesh);
    if (!made || !findIn(burn.scene.meshes, question.mesh)) return FW_ERROR_INVALID_ARGUMENT;
    FwPointState& point = question.point;
    if (!question.pointKnown) {
        point.structSize = sizeof point;
        FwResult result = fwWorld_FetchPoint(burn.world, question.pointQuery, &point);
        if (result == FW_NOT_READY) return result;
        question.pointKnown = result >= 0;
        question.asksArrival = point.kind == FW_POINT_UNBURNT || point.kind == FW_POINT_WET;
        if (result >= 0 && question.asksArrival)
            result = fwWorld_RequestArrival(burn.world, made->object, question.position.data(),
                                            &question.arrivalQuery);
        if (result < 0) {
            error = worldProblem(burn, result);
            return result;
        }
        explain(burn, images, question, nullptr, answer);
    }
    if (!question.asksArrival) return FW_OK;
    FwArrivalState arrival{};
    arrival.structSize = sizeof arrival;
    const FwResult result = fwWorld_FetchArrival(burn.world, question.arrivalQuery, &arrival);
    if (result < 0) error = worldProblem(burn, result);
    if (result == FW_OK) explain(burn, images, question, &arrival, answer);
    return result;
}

bool askWhy(Burn& burn, const PaintImages& images, ObjectId mesh, Vec3 worldPosition,
            WhyAnswer& answer, std::string& error) {
    WhyQuestion question;
    if (!beginWhy(burn, mesh, worldPosition, question, error)) return false;
    // Each poll advances the forecast a little. The world itself stands still.
    constexpr int kMostSteps = 4000;
    FwResult result = FW_NOT_READY;
    for (int i = 0; i < kMostSteps && result == FW_NOT_READY; ++i) {
        result = pollWhy(burn, images, question, answer, error);
        if (result == FW_NOT_READY) fwWorld_Step(burn.world, 0);
    }
    if (result == FW_NOT_READY) error = "The query timed out";
    return result == FW_OK;
}

}  // namespace fwedit
