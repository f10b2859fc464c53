#include "components/sparks.h"

#include "core/assert.h"
#include "shared/spark.h"

#include <algorithm>
#include <cmath>

namespace fw::components {
namespace {

using gpu::vec4;

constexpr float kPlume = 1.7f;      // m/s of a fire of 1 kW, as its power to 0.2 (McCaffrey)
constexpr float kJetPlume = 0.15f;  // of a jet's speed
constexpr float kBrighter = 290;    // K above the flame's temperature at its base
constexpr float kTileSpeed = 1.0f;  // m/s off burning tiles

static_assert(kSparkNotes == gpu::kSparkKeys - 1);

int64_t stepOf(double seconds) noexcept {
    return int64_t(std::floor(seconds / double(gpu::kSparkKeyStep)));
}

// 1/s; on a mesh 1/s per kW of its burning tiles.
float sparkRate(const FireEmitter& emitter) noexcept {
    const FwFireEmitterDef& def = emitter.def;
    if (!(def.power > 0)) return 0;
    return def.shape == FW_EMITTER_MESH ? def.sparks : def.sparks * def.power;
}

void note(SparkHistory& history, const float place[3], float rate) noexcept {
    std::copy_backward(history.notes.begin(), history.notes.end() - 1, history.notes.end());
    history.notes[0] = {place[0], place[1], place[2], rate};
}

// Sparks meet one wall: the mean of the discs that stop the jet.
void findWall(const FireEmitter& emitter, gpu::SparkSource& record) noexcept {
    gpu::vec3 place(0.0f), normal(0.0f);
    float count = 0, radius = 0;
    for (const JetObstacle& obstacle : emitter.obstacles) {
        if (!obstacle.met) continue;
        place += gpu::vec3(obstacle.place[0], obstacle.place[1], obstacle.place[2]);
        normal += gpu::vec3(obstacle.normal[0], obstacle.normal[1], obstacle.normal[2]);
        radius = std::max(radius, obstacle.radius);
        count += 1;
    }
    const float length = glm::length(normal);
    if (count == 0 || length < 0.7f * count) return;  // the discs of a corner disagree
    record.flags |= gpu::kSparkWall;
    record.wall = vec4(place / count, 2 * radius);
    record.wallNormal = vec4(normal / length, 0);
}

}  // namespace

void settleSparks(FireEmitter& emitter, double now) noexcept {
    SparkHistory& history = emitter.births.sparks;
    for (auto& one : history.notes)
        one = {emitter.position[0], emitter.position[1], emitter.position[2], sparkRate(emitter)};
    history.step = stepOf(now);
    history.begun = true;
}

bool advanceSparks(FireEmitter& emitter, const EmitterAir& air, float seconds,
                   gpu::SparkSource& record) noexcept {
    const FwFireEmitterDef& def = emitter.def;
    const FireEmitter::Births& last = emitter.births;
    SparkHistory& history = emitter.next.sparks;
    history = last.sparks;
    const float rate = sparkRate(emitter);
    const double start = air.now - double(seconds);
    const float* from = last.placed ? last.position : emitter.position;
    float moved = 0;
    for (int i = 0; i < 3; ++i) moved = std::hypot(moved, emitter.position[i] - from[i]);
    if (!history.begun || moved > kTeleport * seconds) {
        // A teleport ends the sparks at the old place.
        for (auto& one : history.notes)
            one = {emitter.position[0], emitter.position[1], emitter.position[2], 0};
        history.step = history.begun ? stepOf(air.now) : stepOf(start);
        history.begun = true;
        from = emitter.position;
    }
    FW_ASSERT(seconds >= 0, "%g s", double(seconds));
    const int64_t step = stepOf(air.now);
    history.step = std::max(history.step, step - int64_t(gpu::kSparkKeys));
    while (history.step < step) {
        const double at = double(++history.step) * double(gpu::kSparkKeyStep);
        const float part = seconds > 0 ? float((at - start) / double(seconds)) : 1.0f;
        float place[3];
        for (int i = 0; i < 3; ++i)
            place[i] = from[i] + (emitter.position[i] - from[i]) * std::clamp(part, 0.0f, 1.0f);
        note(history, place, rate);
    }

    float most = rate;
    for (const auto& one : history.notes) most = std::max(most, one[3]);
    if (!(most > 0) || (def.flags & FW_EMITTER_HIDDEN)) return false;
    FW_ASSERT(history.step >= step, "step %lld of %lld", static_cast<long long>(history.step),
              static_cast<long long>(step));
    record = {};
    record.keys[0] = {emitter.position[0], emitter.position[1], emitter.position[2], rate};
    for (uint32_t i = 0; i < kSparkNotes; ++i) {
        const auto& one = history.notes[i];
        record.keys[i + 1] = {one[0], one[1], one[2], one[3]};
    }
    const EmitterAppearance& appearance = emitter.appearance;
    const bool jet = (def.flags & FW_EMITTER_JET) != 0, onMesh = def.shape == FW_EMITTER_MESH;
    if (isSwept(def)) findWall(emitter, record);
    const float* along = emitter.direction;
    record.direction = {along[0], along[1], along[2], appearance.cone};
    record.half_.w = onMesh ? kTileSpeed : appearance.speed;
    if (def.shape == FW_EMITTER_LINE)
        record.half_ = {def.extent[0], def.extent[1], def.extent[2], appearance.speed};
    record.up = {air.up[0], air.up[1], air.up[2], def.ground};
    record.wind = {air.wind[0] * def.windResponse, air.wind[1] * def.windResponse,
                   air.wind[2] * def.windResponse,
                   jet ? kJetPlume * appearance.speed
                       : kPlume * std::pow(std::max(def.power, 0.01f), 0.2f) * def.buoyancy};
    record.wallNormal.w = onMesh ? 0 : def.inherit;
    record.radius = def.shape == FW_EMITTER_DISC ? def.radius
                    : jet                        ? 0.1f * appearance.size0
                                                 : 0.2f * appearance.diameter;
    const double turns = air.now / double(gpu::kSparkTurn), whole = std::floor(turns);
    record.part = float(turns - whole);
    record.turn = uint32_t(int64_t(whole));
    record.keyAge = float(air.now - double(step) * double(gpu::kSparkKeyStep));
    record.kelvin = appearance.kelvin0 + kBrighter;
    record.seed = emitter.seed;
    record.slots =
        std::min(uint32_t(std::ceil(double(most) * double(gpu::kSparkTurn))), gpu::kMaxSparks);
    if (def.flags & FW_EMITTER_GROUND) record.flags |= gpu::kSparkGround;
    record.flipbook = emitter.flipbooks.spark;
    record.object = onMesh ? def.object.index1 : 0;
    return !onMesh || record.object != 0;
}

uint32_t sparkQuads(const gpu::SparkSource& record) noexcept {
    return record.object ? gpu::kMaxTileSparks : record.slots;
}

}  // namespace fw::components
