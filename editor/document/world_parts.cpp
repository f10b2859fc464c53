#include "document/world_parts.h"

#include "flamewright_reference.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace fwedit {
namespace {

constexpr float kSmallestFlame = 0.02f;  // m, diameter

void copy(float* to, const Vec3& from) { std::copy(from.begin(), from.end(), to); }

float peakOf(const Keys& keys) {
    float peak = keys.empty() ? 1.0f : 0.0f;
    for (const Key& key : keys) peak = std::max(peak, key.value);
    return peak;
}

Vec3 unit(const Vec3& v, const Vec3& otherwise) {
    const float length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (!(length > 1e-6f)) return otherwise;
    return {v[0] / length, v[1] / length, v[2] / length};
}

// Returns a rotation in degrees, in the convention of transformOf, without position and scale.
std::array<float, 16> turned(const Vec3& rotation) {
    Mesh mesh;
    mesh.rotation = rotation;
    return transformOf(mesh);
}

void quaternionOf(const std::array<float, 16>& m, float* q) {
    // Take the largest component first, to avoid division by almost zero.
    const float trace[4] = {m[0] - m[5] - m[10], m[5] - m[0] - m[10], m[10] - m[0] - m[5],
                            m[0] + m[5] + m[10]};
    const auto i = static_cast<size_t>(std::max_element(trace, trace + 4) - trace);
    const float largest = 0.5f * std::sqrt(std::max(0.0f, 1 + trace[i]));
    const float share = 0.25f / largest;
    const float xy = (m[1] + m[4]) * share, yz = (m[6] + m[9]) * share, zx = (m[8] + m[2]) * share;
    const float wx = (m[6] - m[9]) * share, wy = (m[8] - m[2]) * share, wz = (m[1] - m[4]) * share;
    const float rows[4][4] = {
        {largest, xy, zx, wx}, {xy, largest, yz, wy}, {zx, yz, largest, wz}, {wx, wy, wz, largest}};
    std::copy(rows[i], rows[i] + 4, q);
}

}  // namespace

std::string worldProblem(const Burn& burn, FwResult result) {
    if (result >= 0) return "";
    char text[1024] = "";
    if (burn.world) fwWorld_GetLastMessage(burn.world, text, sizeof text);
    if (!text[0]) fwContext_GetLastMessage(burn.context, text, sizeof text);
    return text[0] ? text : fwResultName(result);
}

FwWorldDef worldDefOf(const Scene& scene) {
    const Settings& settings = scene.settings;
    FwWorldDef def = fwDefaultWorldDef();
    def.flags = (settings.radiation ? uint32_t{FW_WORLD_RADIATION} : 0u) |
                (settings.plume ? uint32_t{FW_WORLD_PLUME} : 0u) |
                (settings.contact ? uint32_t{FW_WORLD_CONTACT} : 0u) |
                (settings.embers ? uint32_t{FW_WORLD_EMBERS} : 0u);
    copy(def.up, unit(settings.up, {0, 1, 0}));
    copy(def.wind, settings.wind);
    def.paceFactor = settings.pace;
    def.seed = settings.seed;
    def.maxStepsPerFrame = 64;
    def.maxRefinedTriangles = 60000;
    return def;
}

FwFireEmitterDef jetDefOf(const Scene& scene, const HeatSource& source) {
    FwFireEmitterDef def = fwDefaultFireEmitterDef();
    def.flags = uint32_t{FW_EMITTER_JET} | uint32_t{FW_EMITTER_IGNITES} |
                (source.hidden ? uint32_t{FW_EMITTER_HIDDEN} : 0u);
    def.seed = source.id;
    copy(def.position, worldPosition(scene, source.id));
    copy(def.direction, unit(turnedBy(parentPose(scene, source.id), source.direction), {0, 1, 0}));
    def.power = std::min(kMaxPower, source.output * peakOf(source.keys));
    return def;
}

FwFireEmitterDef emitterDefOf(const Scene& scene, const Emitter& emitter) {
    FwFireEmitterDef def = fwDefaultFireEmitterDef();
    def.shape = emitter.shape;
    def.flags = emitter.hidden ? uint32_t{FW_EMITTER_HIDDEN} : 0u;
    def.seed = emitter.id;
    copy(def.position, worldPosition(scene, emitter.id));
    const Pose holder = parentPose(scene, emitter.id);
    copy(def.direction, unit(turnedBy(holder, emitter.direction), {0, 1, 0}));
    copy(def.extent, turnedBy(holder, emitter.extent));
    def.radius = emitter.radius;
    def.power = std::min(kMaxPower, emitter.power * peakOf(emitter.keys));
    def.speed = emitter.speed;
    def.cone = emitter.cone;
    def.life = emitter.life;
    def.smoke = emitter.smoke;
    def.sparks = emitter.sparks;
    def.windResponse = emitter.windResponse;
    def.turbulence = emitter.turbulence;
    return def;
}

FwVolumetricFireDef fireDefOf(const Scene& scene, const Flame& flame) {
    FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
    fwInitFirePreset(&def, flame.preset);
    def.flags = (flame.hidden ? uint32_t{FW_FIRE_HIDDEN} : 0u) |
                (flame.ignites ? uint32_t{FW_FIRE_IGNITES} : 0u);
    def.seed = flame.id;
    copy(def.position, worldPosition(scene, flame.id));
    def.diameter = flame.diameter;
    def.power = flame.power;
    def.windResponse = flame.windResponse;
    def.turbulence = flame.turbulence;
    def.speed = flame.speed;
    def.density = flame.density;
    def.smoke = flame.smoke;
    def.blue = flame.blue;
    copy(def.tint, flame.tint);
    def.tintWeight = flame.tintWeight;
    copy(def.coreTint, flame.coreTint);
    def.coreTintWeight = flame.coreTintWeight;
    return def;
}

std::vector<FwVolumetricFireDef> sourceFiresOf(const Scene& scene, const HeatSource& source) {
    FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
    fwInitFirePreset(&def, source.shape == SourcePoint ? FW_FIRE_TORCH : FW_FIRE_CAMP);
    def.flags = uint32_t{FW_FIRE_IGNITES} | (source.hidden ? uint32_t{FW_FIRE_HIDDEN} : 0u);
    def.seed = source.id;
    def.diameter = std::clamp(2 * source.radius, kSmallestFlame, 20.0f);
    const Vec3 middle = worldPosition(scene, source.id);
    if (source.shape != SourceLine) {
        def.power = source.output;
        copy(def.position, middle);
        return {def};
    }
    const Vec3 along = unit(turnedBy(parentPose(scene, source.id), source.direction), {1, 0, 0});
    const auto count = static_cast<uint32_t>(
        std::clamp(std::ceil(source.length / std::max(def.diameter, 0.05f)), 1.0f, 16.0f));
    std::vector<FwVolumetricFireDef> fires(count, def);
    for (uint32_t i = 0; i < count; ++i) {
        const float at =
            source.length * ((static_cast<float>(i) + 0.5f) / static_cast<float>(count) - 0.5f);
        for (size_t k = 0; k < 3; ++k) fires[i].position[k] = middle[k] + at * along[k];
        fires[i].power = source.output / static_cast<float>(count);
        fires[i].seed = source.id * 16 + i + 1;
    }
    return fires;
}

FwBurnableMeshDef burnableDefOf(const Mesh& mesh) {
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    const std::array<float, 16> transform = transformOf(mesh);
    std::copy(transform.begin(), transform.end(), def.transform);
    const auto flag = [&](bool on, uint32_t which) {
        if (on) def.flags |= which;
    };
    flag(mesh.hidden, FW_BURNABLE_HIDDEN);
    flag(mesh.twoSided, FW_BURNABLE_TWO_SIDED);
    flag(!mesh.holes, FW_BURNABLE_NO_HOLES);
    flag(mesh.refine, FW_BURNABLE_REFINE);
    flag(!mesh.spreads, FW_BURNABLE_NO_SPREAD);
    flag(mesh.deform == DeformRecede, FW_BURNABLE_RECEDE);
    flag(mesh.deform == DeformSheet, FW_BURNABLE_SHELL);
    flag(mesh.deform == DeformSprings, FW_BURNABLE_SPRINGS);
    def.moisture = mesh.moisture;
    copy(def.tint, mesh.tint);
    def.refineDepth = mesh.refineDepth;
    def.spreadChance = mesh.spreadChance;
    def.userData = mesh.id;
    return def;
}

FwFireColliderDef colliderDefOf(const Scene& scene, const Collider& collider) {
    FwFireColliderDef def = fwDefaultFireColliderDef();
    static constexpr uint32_t kKinds[] = {FW_COLLIDER_SPHERE, FW_COLLIDER_CAPSULE, FW_COLLIDER_BOX,
                                          FW_COLLIDER_PLANE};
    def.kind = kKinds[std::min<uint32_t>(collider.shape, 3)];
    const Vec3 middle = worldPosition(scene, collider.id);
    const std::array<float, 16> turn = turned(collider.rotation);
    copy(def.position, middle);
    copy(def.halfSize, collider.halfSize);
    def.radius = collider.radius;
    for (size_t k = 0; k < 3; ++k) {
        const float axis = turn[4 + k];  // its own y
        def.normal[k] = axis;
        def.end[k] = middle[k] + 0.5f * collider.length * axis;
        if (collider.shape == ColliderCapsule)
            def.position[k] = middle[k] - 0.5f * collider.length * axis;
    }
    quaternionOf(turn, def.rotation);
    return def;
}

FwWindZoneDef windZoneDefOf(const Scene& scene, const Wind& wind, float factor) {
    FwWindZoneDef def = fwDefaultWindZoneDef();
    static constexpr FwWindShape kShapes[] = {FW_WIND_BOX, FW_WIND_BOX, FW_WIND_SPHERE,
                                              FW_WIND_CONE};
    static constexpr FwWindFlow kFlows[] = {FW_WIND_ALONG, FW_WIND_RADIAL, FW_WIND_VORTEX};
    def.shape = kShapes[wind.shape];
    def.flow = kFlows[wind.flow];
    def.blend = wind.shelters ? FW_WIND_REPLACE : FW_WIND_ADD;
    copy(def.position, worldPosition(scene, wind.id));
    const float speed = std::hypot(wind.velocity[0], wind.velocity[1], wind.velocity[2]);
    if (speed > 0) copy(def.axis, wind.velocity);
    copy(def.size, wind.shape == WindBox   ? wind.halfSize
                   : wind.shape == WindFan ? Vec3{wind.length, wind.radius, wind.radius}
                                           : Vec3{wind.radius, wind.radius, wind.radius});
    def.speed = std::min(speed * factor, kMaxWind);
    def.falloff = wind.falloff;
    return def;
}

FwHeatOccluderDef heatOccluderDefOf(const Scene& scene, const Collider& collider) {
    FwHeatOccluderDef def = fwDefaultHeatOccluderDef();
    const std::array<float, 16> turn = turned(collider.rotation);
    std::copy(turn.begin(), turn.end(), def.transform);
    copy(def.transform + 12, worldPosition(scene, collider.id));
    copy(def.halfSize, collider.halfSize);
    return def;
}

}  // namespace fwedit
