// One volumetric flame: its def, its motion, and its output for drawing, lighting and gameplay.
// Plain data and functions; owns no device memory and, except for a track, no heap.
#pragma once
#include "volume/motion.h"
#include "volume/neighbours.h"
#include "volume/profile.h"

namespace fw::volume {

enum class FlameDriver : uint32_t { Live, Track, Host };

// Parameters of a flame. A fire of the public def burns as one or many flames.
struct FlameDef {
    vec3 position{0.0f};        // m, of the fuel's middle
    vec3 up{0.0f, 1.0f, 0.0f};  // against gravity
    float power = 60.0f;        // kW, [0, 1e6]; 0: it goes out
    float diameter = 0.6f;      // m, (0, 100]
    float height = 0.0f;        // m, visible; 0: Heskestad's, from power and diameter
    FlameAppearance appearance;
    FlameDriver driver = FlameDriver::Live;
    float blend = 0.3f;   // s from one driver to another
    float weight = 1.0f;  // [0, 1] of the track or the host over the live motion
    uint32_t seed = 1;
    uint32_t profile = 0;  // layer of the fire-profile
};

struct FlameLight {       // one per flame
    vec3 position{0.0f};  // m
    float radius = 0.0f;  // m, of the luminous area
    vec3 colour{0.0f};    // linear, luminance 1
    float flux = 0.0f;    // lm
};

// m along the curve, end of the visible flame and smoke.
float topOf(const gpu::FlameRecord& flame) noexcept;
// Conservative bounds of the visible flame and smoke.
Bounds flameBounds(const gpu::FlameRecord& flame, std::span<const gpu::FlameNode> nodes) noexcept;
// The light of a new flame, without flicker.
FlameLight meanLight(const FlameDef& def) noexcept;

struct Flame {
    FlameDef def;
    double age = 0.0;        // s
    float power = 0.0f;      // kW, follows def.power in 0.3 s
    float tracked = 0.0f;    // [0, 1] weight of track or host over live
    double trackTime = 0.0;  // s
    // Points of the host, or of the track at its last time; m, world.
    std::array<ControlPoint, kMaxControlPoints> given{};
    uint32_t givenCount = 0;
    FlameMotion motion;
    FlameScroll scroll;
    // Output of advanceFlame.
    gpu::FlameRecord record{};
    FlameNodes nodes{};
    FlameSize size;
    Bounds bounds;
    FlameLight light;
};

struct FlameAir {              // around a flame, this frame
    vec3 wind{0.0f};           // m/s
    Neighbourhood neighbours;  // height 0: none
    std::span<const Collider> colliders;
    const Track* track = nullptr;
};

void startFlame(Flame& flame, const FlameDef& def,
                const FlameAir& air) noexcept;  // at full height
// Moves the flame and its history, m, world.
void carryFlame(Flame& flame, vec3 by) noexcept;
// A base that moves faster than kTeleport takes the whole flame along: gas that stayed behind would
// lie flat between the two places.
void followTeleport(Flame& flame, double seconds) noexcept;
void advanceFlame(Flame& flame, const FlameAir& air, double seconds) noexcept;

struct FlameAnswer {
    bool inside = false;         // in the mean luminous flame
    float s = 0.0f, rho = 0.0f;  // m along the axis, radii off it; 0, -1 outside the tube
    float kelvin = kAmbientKelvin;
    float heatFlux = 0.0f;  // W/m^2 on a small cold body, from gas and by radiation
    vec3 gas{0.0f};         // m/s of the gas
};
// `walls` stop radiation, not gas.
FlameAnswer queryFlame(const Flame& flame, const Profile& profile, vec3 point,
                       std::span<const Collider> walls = {}) noexcept;

struct FlamePush {
    vec3 force{0.0f};       // N on a sphere at rest
    float ignition = 0.0f;  // W into it
};
FlamePush pushOf(const Flame& flame, const Profile& profile, vec3 centre, float radius,
                 std::span<const Collider> walls = {}) noexcept;

}  // namespace fw::volume
