// Motion of a flame's curve: particles of hot gas that rise, lean, stray and meet walls; or a
// recorded track; or a mixture of both. Cosmetic, fixed step, repeatable by seed; no heap.
#pragma once
#include "volume/appearance.h"
#include "volume/collide.h"

#include <memory_resource>
#include <vector>

namespace fw::volume {

constexpr float kMotionStep = 1.0f / 128.0f;  // s
constexpr uint32_t kMaxMotionSteps = 32;      // of a frame; a hitch drops the rest
constexpr uint32_t kMotionPieces = 14;        // control points above the base
constexpr uint32_t kMotionParticles = 24;
constexpr uint32_t kPulseParts = 16;  // of a puff, for the mean of contact
constexpr float kTeleport = 100.0f;   // m/s; a base that moves faster is a teleport
constexpr float kAmbientKelvin = 293.0f;

struct MotionRules {
    FlameSize size;                          // visible height, power, diameter
    float top = 1.0f;                        // m, least length of the curve
    float tauStart = 0.02f, tauFree = 0.3f;  // m, of the record: gas and noise rise equally
    vec3 wind{0.0f};                         // m/s
    vec3 up{0.0f, 1.0f, 0.0f};               // unit, against gravity
    float dispersion = 0.35f;                // [0, 1] random sideways speed, of the gas's speed
    float entrainment = 0.12f;               // m wider per m, above the flame
    float puff = 0.15f;                      // amplitude of puffing
    float burn = 1.0f;                       // factor on all speeds
    vec3 pull{0.0f};                         // m/s, towards neighbours, at the visible height
    uint32_t seed = 1;
};

struct CurveParticle {
    vec3 position{0.0f}, velocity{0.0f}, stray{0.0f};  // m, m/s, m/s
    float age = 0.0f;                                  // s
    float risen = 0.0f;                                // m along its path
    float bulge = 0.0f;                                // [-1, 1], phase of puffing at its birth
    uint32_t number = 0;
    bool touches = false;  // a collider, in the last step
};

struct FlameMotion {
    std::array<CurveParticle, kMotionParticles> particles{};  // youngest first
    uint32_t count = 0, spawned = 0;
    vec3 base{0.0f}, baseVelocity{0.0f};
    float radius = 0.0f;                                   // m, of the base
    double sinceSpawn = 0.0, leftover = 0.0, phase = 0.0;  // s, s, [0, 1) of the puff
    // Mean contact over the last puff: kW into the surface, its place and normal. `contacts`: by
    // parts of a puff.
    std::array<float, kPulseParts> contacts{};
    float contactPower = 0.0f;
    vec3 contact{0.0f}, contactNormal{0.0f, 1.0f, 0.0f};
};

// Starts at full height.
void startMotion(FlameMotion& motion, const MotionRules& rules, vec3 base) noexcept;
// Moves all particles, m.
void carryMotion(FlameMotion& motion, vec3 by) noexcept;
void advanceMotion(FlameMotion& motion, const MotionRules& rules, vec3 base,
                   std::span<const Collider> colliders, double seconds) noexcept;
// The curve: kMotionPieces + 1 points at fixed ages, so that nothing jumps when particles are born
// or die.
uint32_t motionPoints(const FlameMotion& motion, const MotionRules& rules,
                      std::array<ControlPoint, kMaxControlPoints>& points) noexcept;
// Factor of puffing on the height, mean 1.
float motionPulse(const FlameMotion& motion, const MotionRules& rules) noexcept;

// A recorded curve: the same number of points in each key, Catmull-Rom between keys.
struct Track {
    explicit Track(std::pmr::memory_resource* memory) : times(memory), points(memory) {}
    std::pmr::vector<float> times;          // s, increasing
    std::pmr::vector<ControlPoint> points;  // key after key, from the fire's base
    uint32_t pointsPerKey = 0;
    bool loops = true;  // then the last key equals the first
};
// Throws core::Error; `track` is then unchanged.
void setTrack(Track& track, std::span<const float> times, std::span<const ControlPoint> points,
              uint32_t pointsPerKey, bool loops);
// Points of the host or a track: count in [1, 32], finite, radius >= 0. Throws core::Error.
void checkControlPoints(std::span<const ControlPoint> points);
uint32_t sampleTrack(const Track& track, double time,
                     std::array<ControlPoint, kMaxControlPoints>& points) noexcept;
// Blends two curves of any numbers of points by arc length; weight 0: the first. Returns the count.
uint32_t blendPoints(std::span<const ControlPoint> a, std::span<const ControlPoint> b, float weight,
                     vec3 up, std::array<ControlPoint, kMaxControlPoints>& out) noexcept;

}  // namespace fw::volume
