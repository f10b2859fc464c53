// What moves a flame's curve: particles of hot gas that rise, lean, stray and meet walls; or a
// script; or a mixture of both. Cosmetic, fixed step, repeatable by seed; no heap.
#pragma once
#include "volume/collide.h"
#include "volume/look.h"

#include <memory_resource>
#include <vector>

namespace fw::volume {

constexpr float kMotionStep = 1.0f / 128.0f;  // s
constexpr uint32_t kMostMotionSteps = 32;     // of a frame; a hitch drops the rest
constexpr uint32_t kMotionPieces = 14;        // control points above the base
constexpr uint32_t kMotionParticles = 24;
constexpr uint32_t kPulseParts = 16;  // of a puff, that contact is averaged over
constexpr float kTeleport = 100.0f;   // m/s: a base that moves faster was put there
constexpr float kAmbientKelvin = 293.0f, kFlameKelvin = 1300.0f;

struct MotionRules {
    FlameSize size;                          // the height that is seen, the power, the diameter
    float top = 1.0f;                        // m, how far up the curve must reach
    float tauStart = 0.02f, tauFree = 0.3f;  // m, of the record: gas and noise rise alike
    vec3 wind{0.0f};                         // m/s
    vec3 up{0.0f, 1.0f, 0.0f};               // unit, against gravity
    float dispersion = 0.35f;                // [0, 1] how far gas strays, of its speed
    float entrainment = 0.12f;               // m wider per m, above the flame
    float puff = 0.15f;                      // amplitude of the rhythm
    float burn = 1.0f;                       // of all speeds
    vec3 pull{0.0f};                         // m/s, towards neighbours at the height that is seen
    uint32_t seed = 1;
};

struct CurveParticle {
    vec3 position{0.0f}, velocity{0.0f}, stray{0.0f};  // m, m/s, m/s
    float age = 0.0f;                                  // s
    float risen = 0.0f;                                // m along its way
    float bulge = 0.0f;                                // [-1, 1] of the puff it began in
    uint32_t number = 0;
    bool touches = false;  // a collider, in the last step
};

struct FlameMotion {
    std::array<CurveParticle, kMotionParticles> particles{};  // youngest first
    uint32_t count = 0, spawned = 0;
    vec3 base{0.0f}, baseVelocity{0.0f};
    float radius = 0.0f;                                   // m, of the base
    double sinceSpawn = 0.0, leftover = 0.0, phase = 0.0;  // s, s, [0, 1) of the puff
    // What it touched in the last pulse, on the mean: kW that go into it, where, and the surface's
    // normal. By parts of the pulse, each as it was last.
    std::array<float, kPulseParts> contacts{};
    float contactPower = 0.0f;
    vec3 contact{0.0f}, contactNormal{0.0f, 1.0f, 0.0f};
};

// As if it had burnt for long.
void startMotion(FlameMotion& motion, const MotionRules& rules, vec3 base) noexcept;
// Everything moves along, as if it had always burnt there.
void carryMotion(FlameMotion& motion, vec3 by) noexcept;
void advanceMotion(FlameMotion& motion, const MotionRules& rules, vec3 base,
                   std::span<const Collider> colliders, double seconds) noexcept;
// The curve now: kMotionPieces + 1 points at fixed ages, so that nothing jumps when gas is born or
// dies.
uint32_t motionPoints(const FlameMotion& motion, const MotionRules& rules,
                      std::array<ControlPoint, kMaxControlPoints>& points) noexcept;
// What puffing does to the height now, mean 1.
float motionPulse(const FlameMotion& motion, const MotionRules& rules) noexcept;

// A recorded curve: the same number of points in each key, Catmull-Rom between keys.
struct Track {
    explicit Track(std::pmr::memory_resource* memory) : times(memory), points(memory) {}
    std::pmr::vector<float> times;          // s, increasing
    std::pmr::vector<ControlPoint> points;  // key after key, from the fire's base
    uint32_t pointsPerKey = 0;
    bool loops = true;  // the last key is then the first again
};
// Throws core::Error; `track` is then unchanged.
void setTrack(Track& track, std::span<const float> times, std::span<const ControlPoint> points,
              uint32_t pointsPerKey, bool loops);
// Points of the host or a track: count in [1, 32], finite, radius >= 0. Throws core::Error.
void checkControlPoints(std::span<const ControlPoint> points);
uint32_t sampleTrack(const Track& track, double time,
                     std::array<ControlPoint, kMaxControlPoints>& points) noexcept;
// Of two curves with any numbers of points, by arc length. 0 is the first. Result in `out`.
uint32_t blendPoints(std::span<const ControlPoint> a, std::span<const ControlPoint> b, float weight,
                     vec3 up, std::array<ControlPoint, kMaxControlPoints>& out) noexcept;

}  // namespace fw::volume
