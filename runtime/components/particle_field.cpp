#include "components/particle_field.h"

#include "components/pose.h"
#include "core/assert.h"
#include "core/error.h"
#include "core/reserved.h"

#include <algorithm>
#include <cmath>

namespace fw::components {
namespace {

constexpr uint32_t kStillRate = 10;  // Hz
constexpr uint32_t kTicksPerSecond = 4096;
constexpr float kMaxWind = 1.5f;  // cells a step
constexpr uint32_t kFlags = FW_FIELD_HIDDEN | core::reserved::kFieldStill | FW_FIELD_WETS;
constexpr uint32_t kOpen =
    FW_FIELD_OPEN_LEFT | FW_FIELD_OPEN_RIGHT | FW_FIELD_OPEN_BOTTOM | FW_FIELD_OPEN_TOP;
static_assert(FW_FIELD_OPEN_LEFT == gpu::kFieldOpenLeft &&
              FW_FIELD_OPEN_RIGHT == gpu::kFieldOpenRight &&
              FW_FIELD_OPEN_BOTTOM == gpu::kFieldOpenBottom &&
              FW_FIELD_OPEN_TOP == gpu::kFieldOpenTop);

}  // namespace

void setFieldPreset(FwParticleFieldDef& def, uint32_t preset) noexcept {
    const field::FieldAppearance appearance = field::fieldPreset(field::FieldPreset(preset));
    def.amount = appearance.amount;
    def.rise = appearance.rise;
    def.spread = appearance.spread;
    def.memory = appearance.memory;
    def.chaos = appearance.chaos;
    def.life = appearance.life;
    def.detail = appearance.detail;
    def.body = appearance.body;
    def.sourceSize = preset == FW_FIELD_FIRE ? 0.5f : 0.2f;
}

const char* fieldPresetName(uint32_t preset) noexcept {
    constexpr const char* kNames[] = {"fire", "smoke", "water"};
    return preset < FW_FIELD_PRESET_COUNT ? kNames[preset] : "an unknown field preset";
}

void makeParticleField(const FwParticleFieldDef& def, uint32_t ownSeed, ParticleField& field) {
    checkFlags(def.flags, "FwParticleFieldDef::flags", kFlags);
    core::reserved::checkField(def.flags);
    checkWhole(def.shape, "FwParticleFieldDef::shape", 0, FW_FIELD_DISPLACED);
    checkLengths(def.position, 3, "FwParticleFieldDef::position", -1e6f, 1e6f);
    checkLengths(def.size, 3, "FwParticleFieldDef::size", 1e-3f, 1000.0f);
    checkRotation(def.rotation, "FwParticleFieldDef::rotation");
    checkWhole(def.width, "FwParticleFieldDef::width", 32, gpu::kMaxFieldSide);
    if (def.width % 4 != 0)
        core::refuse("FwParticleFieldDef::width is %u; it is a multiple of 4.", def.width);
    checkWhole(def.height, "FwParticleFieldDef::height", 32, gpu::kMaxFieldSide);
    checkWhole(def.stepRate, "FwParticleFieldDef::stepRate", 20, 30);
    checkWhole(def.open, "FwParticleFieldDef::open", 0, kOpen);
    checkValue(def.amount, "FwParticleFieldDef::amount", 0.0f, 4.0f);
    checkValue(def.rise, "FwParticleFieldDef::rise", -4.0f, 4.0f);
    checkValue(def.spread, "FwParticleFieldDef::spread", 0.0f, 1.0f);
    checkValue(def.memory, "FwParticleFieldDef::memory", 0.0f, 1.0f);
    checkValue(def.chaos, "FwParticleFieldDef::chaos", 0.0f, 4.0f);
    checkValue(def.life, "FwParticleFieldDef::life", 0.05f, 1000.0f);
    checkValue(def.detail, "FwParticleFieldDef::detail", 0.0f, 1.0f);
    checkValue(def.body, "FwParticleFieldDef::body", 0.0f, 2.0f);
    checkValue(def.windResponse, "FwParticleFieldDef::windResponse", 0.0f, 4.0f);
    checkWhole(def.source, "FwParticleFieldDef::source", 0, FW_FIELD_SOURCE_PAINTED);
    checkValue(def.sourceSize, "FwParticleFieldDef::sourceSize", 1e-3f, 1.0f);
    checkValues(def.sourceAt, 2, "FwParticleFieldDef::sourceAt", 0.0f, 1.0f);
    checkWhole(def.reserved, "FwParticleFieldDef::reserved", 0, 0);
    checkValues(def.tint, 3, "FwParticleFieldDef::tint", 0.0f, 10.0f);
    checkValue(def.opacity, "FwParticleFieldDef::opacity", 0.0f, 10.0f);

    static_cast<FwParticleFieldDef&>(field) = def;
    field.paint = field.walls = nullptr;  // the host's
    const bool ring = def.shape != FW_FIELD_BILLBOARD;
    field.def.width = def.width;
    field.def.height = def.height;
    field.def.appearance = {def.amount, def.rise, def.spread, def.memory,
                            def.chaos,  def.life, def.detail, def.body};
    field.def.stepRate = def.flags & core::reserved::kFieldStill ? kStillRate : def.stepRate;
    field.def.open =
        ring ? (def.open & (gpu::kFieldOpenTop | gpu::kFieldOpenBottom)) | gpu::kFieldRing
             : def.open;
    field.def.seed = def.seed ? def.seed : ownSeed;
    if (ring) field.windResponse = 0;
    for (auto* cells : {&field.painted, &field.walled, &field.masks})
        cells->resize(size_t(def.width) * def.height);
    paintField(field, def.paint, def.walls);
}

void setFieldPlace(ParticleField& field, const float position[3], const float rotation[4]) {
    checkLengths(position, 3, "position", -1e6f, 1e6f);
    if (rotation) checkRotation(rotation, "rotation");
    std::copy_n(position, 3, field.position);
    if (rotation) std::copy_n(rotation, 4, field.rotation);
}

void cellPlace(const ParticleField& field, float u, float v, float (&out)[3]) noexcept {
    const float* q = field.rotation;
    gpu::vec3 p((u - 0.5f) * field.size[0], v * field.size[1], 0);
    if (field.shape != FW_FIELD_BILLBOARD) {  // as field_draw.vert
        // Doubles: C libraries differ in the last bit of the cosine of a float.
        const auto lon = double(6.2831853f * u), lat = double(3.1415927f * (v - 0.5f));
        const auto level = float(std::cos(lat));
        p = gpu::vec3(level * float(std::cos(lon)) * field.size[0],
                      (float(std::sin(lat)) + 1) * field.size[1],
                      -level * float(std::sin(lon)) * field.size[2]) *
            0.5f;
    }
    const gpu::vec3 axis(q[0], q[1], q[2]);
    p += 2.0f * glm::cross(axis, glm::cross(axis, p) + q[3] * p);
    for (int i = 0; i < 3; ++i) out[i] = field.position[i] + p[i];
}

void setFieldAmount(ParticleField& field, float amount) {
    checkValue(amount, "amount", 0.0f, 4.0f);
    field.def.appearance.amount = amount;
}

void paintField(ParticleField& field, const uint8_t* paint, const uint8_t* walls) noexcept {
    if (paint) std::copy_n(paint, field.painted.size(), field.painted.begin());
    if (walls) std::copy_n(walls, field.walled.size(), field.walled.begin());
    FW_ASSERT(
        field.painted.size() == field.masks.size() && field.walled.size() == field.masks.size(),
        "%zu, %zu and %zu cells", field.painted.size(), field.walled.size(), field.masks.size());
    for (size_t i = 0; i < field.masks.size(); ++i)
        field.masks[i] = field.walled[i] ? uint8_t(gpu::kFieldWall)
                                         : std::min<uint8_t>(field.painted[i], gpu::kFieldWall - 1);
}

field::FieldRules rulesOf(const ParticleField& field, const float wind[3]) noexcept {
    field::FieldDef def = field.def;
    // The wind along the field's own x axis.
    const float* q = field.rotation;
    const float x[3] = {1 - 2 * (q[1] * q[1] + q[2] * q[2]), 2 * (q[0] * q[1] + q[2] * q[3]),
                        2 * (q[0] * q[2] - q[1] * q[3])};
    const float along = wind[0] * x[0] + wind[1] * x[1] + wind[2] * x[2];
    def.wind.x = std::clamp(along * field.windResponse, -kMaxWind, kMaxWind);
    field::FieldRules rules = field::fieldRules(def);
    const int w = int(def.width), h = int(def.height);
    FW_ASSERT(w > 0 && h > 0, "%d x %d cells", w, h);
    const uint32_t rate = field::emissionRate(def.appearance.amount);
    if (field.source == FW_FIELD_SOURCE_PAINTED) {
        rules.paint = rate;
        return rules;
    }
    gpu::FieldSource& source = rules.sources[0];
    rules.sourceCount = 1;
    source.rate = rate;
    if (field.source == FW_FIELD_SOURCE_DISC) {
        const int wide = std::max(int(field.sourceSize * float(std::min(w, h)) + 0.5f), 1);
        const int left = int(std::lround(field.sourceAt[0] * float(w) - 0.5f * float(wide)));
        const int low = int(std::lround(field.sourceAt[1] * float(h) - 0.5f * float(wide)));
        source.cells = {left, low, left + wide, low + wide};
        source.disc = 1;
        return rules;
    }
    const int wide = std::clamp(int(field.sourceSize * float(w) + 0.5f), 1, w);
    // The same number of rows at any resolution, so that cells fill equally.
    const int rows = 2, left = (w - wide) / 2;
    const bool falls = def.appearance.rise < 0;
    source.cells = {left, falls ? h - rows : 0, left + wide, falls ? h : rows};
    return rules;
}

uint32_t fieldSteps(const ParticleField& field, uint64_t ticks) noexcept {
    return uint32_t(ticks * field.def.stepRate / kTicksPerSecond);
}

gpu::FieldDraw fieldDraw(const ParticleField& field, double ticks, uint32_t steps,
                         double clock) noexcept {
    FW_ASSERT(field.def.stepRate > 0 && field.def.width % 4 == 0, "%u Hz", field.def.stepRate);
    constexpr double kWrap = 819.2;  // s, whole periods of the noise
    const bool still = (field.flags & core::reserved::kFieldStill) != 0;
    const double into = ticks * field.def.stepRate / kTicksPerSecond - double(steps);
    const float* q = field.rotation;
    const auto axis = [&](float x, float y, float z, float w) {
        const gpu::vec3 v(x, y, z), u(q[0], q[1], q[2]);
        return gpu::vec4(v + 2.0f * glm::cross(u, glm::cross(u, v) + q[3] * v), w);
    };
    gpu::FieldDraw draw{};
    draw.place = {field.position[0], field.position[1], field.position[2],
                  still ? 1.0f : float(std::clamp(into, 0.0, 1.0))};
    draw.size = {field.size[0], field.size[1], field.size[2], field.opacity};
    draw.right = axis(1, 0, 0, field.def.appearance.detail);
    draw.up = axis(0, 1, 0, field.def.appearance.body);
    draw.forward = axis(0, 0, 1, float(std::fmod(clock / kTicksPerSecond, kWrap)));
    draw.tint = {field.tint[0], field.tint[1], field.tint[2], float(field.def.stepRate)};
    draw.width = field.def.width;
    draw.height = field.def.height;
    draw.shape = field.shape;
    const field::FieldAppearance& appearance = field.def.appearance;
    const float life = appearance.life * float(field.def.stepRate);
    draw.tall = std::clamp(std::fabs(appearance.rise) * life, 4.0f, float(field.def.height));
    draw.seed = field.def.seed;
    return draw;
}

}  // namespace fw::components
