// One volumetric flame: what is asked of it, what moves it, and what it gives to drawing, lighting
// and gameplay. Plain data and functions; owns no device memory and, but for a track, no heap.
#pragma once
#include "volume/march.h"
#include "volume/motion.h"
#include "volume/neighbours.h"

namespace fw::volume {

enum class FlameDriver : uint32_t { Live, Track, Host };

// What a host asks for. Maps one to one to the public def.
struct FlameDef {
    vec3 position{0.0f};        // m, of the fuel's middle
    vec3 up{0.0f, 1.0f, 0.0f};  // against gravity
    float power = 60.0f;        // kW, [0, 1e6]; 0: it goes out
    float diameter = 0.6f;      // m, (0, 100]
    float height = 0.0f;        // m that is seen; 0: Heskestad's, of power and diameter
    FlameLook look;
    FlameDriver driver = FlameDriver::Live;
    float blend = 0.3f;   // s from one driver to another
    float weight = 1.0f;  // [0, 1] of the track or the host over what is live
    uint32_t seed = 1;
    uint32_t profile = 0;  // layer of the fire-profile
};
// Throws core::Error that names the field, the value and the limit.
void checkFlame(const FlameDef& def);

struct FlameLight {       // one per flame
    vec3 position{0.0f};  // m
    float radius = 0.0f;  // m, of the area that shines
    vec3 colour{0.0f};    // linear, luminance 1
    float flux = 0.0f;    // lm
};

// Of a flame that has not been advanced yet, without flicker.
FlameLight meanLight(const FlameDef& def) noexcept;

struct Flame {
    FlameDef def;
    double age = 0.0;        // s
    float power = 0.0f;      // kW, follows def.power in 0.3 s
    float tracked = 0.0f;    // [0, 1] weight of track or host over live
    double trackTime = 0.0;  // s
    // By the host, or of the track as it was last; m in the world.
    std::array<ControlPoint, kMaxControlPoints> given{};
    uint32_t givenCount = 0;
    FlameMotion motion;
    FlameScroll scroll;
    // What it gives, made by advanceFlame.
    gpu::FlameRecord record{};
    FlameNodes nodes{};
    FlameSize size;
    Bounds bounds;
    FlameLight light;
};

struct FlameAir {              // around a flame, this frame
    vec3 wind{0.0f};           // m/s
    Neighbourhood neighbours;  // height 0: it is alone
    std::span<const Collider> colliders;
    const Track* track = nullptr;
};

void startFlame(Flame& flame, const FlameDef& def,
                const FlameAir& air) noexcept;  // as if it had burnt for long
// Moves all of it, its history included, by m in the world.
void carryFlame(Flame& flame, vec3 by) noexcept;
// A base that is farther off than kTeleport allows in these seconds takes the whole flame along:
// gas that stayed behind would lie flat towards where the base was.
void followTeleport(Flame& flame, double seconds) noexcept;
void advanceFlame(Flame& flame, const FlameAir& air, double seconds) noexcept;

// Whether anything of it is on the good side of all planes (xyz normal inward, w distance).
bool isSeen(const Bounds& bounds, std::span<const vec4> planes) noexcept;

struct FlameAnswer {
    bool inside = false;         // in the luminous flame, on the mean
    float s = 0.0f, rho = 0.0f;  // m along, radii off the axis; 0, -1 where it is in no tube
    float kelvin = kAmbientKelvin;
    float heatFlux = 0.0f;  // W/m^2 on a small cold body there, from gas and by radiation
    vec3 gas{0.0f};         // m/s of the gas there
};
// `walls` shade radiation; gas is where the flame is.
FlameAnswer askFlame(const Flame& flame, const Profile& profile, vec3 point,
                     std::span<const Collider> walls = {}) noexcept;

struct FlamePush {
    vec3 force{0.0f};       // N on a sphere that stands still
    float ignition = 0.0f;  // W into it
};
FlamePush pushOf(const Flame& flame, const Profile& profile, vec3 centre, float radius,
                 std::span<const Collider> walls = {}) noexcept;

}  // namespace fw::volume
