// Jets of fire emitters: rays swept from the holder's side of the nozzle through colliders,
// occluders, cells of the heat-occlusion grid and burnable meshes. The first hit is heated when the
// stream has flown there, nothing behind it. Jets depend on the host's numbers alone and become
// events, the same on every backend. Particles use the same hits.
#include "mesh/bake.h"
#include "shared/exchange.h"
#include "world/burn_system.h"
#include "world/emitter_system.h"
#include "world/exchange_system.h"
#include "world/flame_system.h"
#include "world/geometry.h"
#include "world/recording.h"

#include <algorithm>
#include <cmath>

namespace fw::world {
namespace {

using components::FireEmitter;
using components::JetGate;
using components::JetHit;
using components::JetParcel;
using components::JetPatch;
using components::JetRay;
using volume::vec3;

constexpr uint32_t kRays = components::kJetRays;
// One in the middle, then rings of five and ten: x and y over the half angle that a jet takes.
constexpr float kPattern[kRays][2] = {{0, 0},
                                      {0, 0.5f},
                                      {0.4755f, 0.1545f},
                                      {0.2939f, -0.4045f},
                                      {-0.2939f, -0.4045f},
                                      {-0.4755f, 0.1545f},
                                      {1, 0},
                                      {0.8090f, 0.5878f},
                                      {0.3090f, 0.9511f},
                                      {-0.3090f, 0.9511f},
                                      {-0.8090f, 0.5878f},
                                      {-1, 0},
                                      {-0.8090f, -0.5878f},
                                      {-0.3090f, -0.9511f},
                                      {0.3090f, -0.9511f},
                                      {0.8090f, -0.5878f}};
constexpr float kClose = 0.01f, kMinStep = 0.02f, kFarStep = 1.0f;  // m
constexpr uint32_t kMostSteps = 96;                                 // of a ray
constexpr size_t kMaxPoints = 64;    // that a ray heats at once, unless it would be too hot
constexpr uint32_t kMaxGrowths = 6;  // of where a ray's power goes, until all of it does
constexpr float kOverlap = 0.1f;     // m that a parcel looks back: what moves into it is met
constexpr float kNano = 1e9f;        // of W and m^2
constexpr float kNearPatch = 0.45f;  // m within which fuel sticks to fuel
constexpr float kPastReach = 1.15f;  // a few particles come farther than most

uint32_t millimetres(float m) noexcept { return uint32_t(std::lround(std::max(m, 0.0f) * 1000)); }

// Through shapes: m to the first, or `most`.
float sweepShapes(std::span<const volume::Collider> shapes, vec3 from, vec3 way, float most,
                  vec3& normal) noexcept {
    if (shapes.empty()) return most;
    float at = 0;
    for (uint32_t i = 0; i < kMostSteps && at < most; ++i) {
        const volume::Surface surface = volume::nearestSurface(shapes, from + way * at);
        if (surface.distance < kClose) {
            normal = surface.normal;
            return at;
        }
        at += std::max(surface.distance, kMinStep);
    }
    return std::min(at, most);
}

// Where a ray is within a box, m; false: nowhere before `most`.
bool within(const float from[3], const float way[3], const float low[3], const float high[3],
            float pad, float& enter, float& leave) noexcept {
    for (int i = 0; i < 3; ++i) {
        const float a = low[i] - pad - from[i], b = high[i] + pad - from[i];
        if (std::abs(way[i]) < 1e-12f) {
            if (a > 0 || b < 0) return false;
            continue;
        }
        const float s = a / way[i], t = b / way[i];
        enter = std::max(enter, std::min(s, t));
        leave = std::min(leave, std::max(s, t));
    }
    return enter <= leave;
}

// Half the angle that a jet takes, rad.
float halfAngle(const FireEmitter& emitter) noexcept {
    return emitter.appearance.cone * 1.8f + 0.02f;
}

void jetRays(const FireEmitter& emitter, float (&ways)[kRays][3]) noexcept {
    const vec3 along = volume::vecOf(emitter.direction);
    vec3 r = glm::cross(along, std::abs(along.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0));
    r /= glm::length(r);
    const vec3 u = glm::cross(r, along);
    const float wide = halfAngle(emitter);
    for (uint32_t i = 0; i < kRays; ++i) {
        vec3 way = along + r * (kPattern[i][0] * wide) + u * (kPattern[i][1] * wide);
        way /= glm::length(way);
        for (int k = 0; k < 3; ++k) ways[i][k] = way[k];
    }
}

bool alike(const mesh::BurnDomain& domain, uint32_t a, uint32_t b) noexcept {  // face one way
    const gpu::ivec3 n = gpu::decodeNormal(domain.normals[a]);
    const gpu::ivec3 m = gpu::decodeNormal(domain.normals[b]);
    return int64_t(n.x) * m.x + int64_t(n.y) * m.y + int64_t(n.z) * m.z > 0;
}

// m^2 in the world from a point in object space to a texel at rest.
float squaredToTexel(const components::Pose& pose, const mesh::BurnDomain& domain, uint32_t texel,
                     const float point[3]) noexcept {
    float place[3], sum = 0;
    restPlace(domain, texel, place);
    for (int i = 0; i < 3; ++i) {
        const float d = (place[i] - point[i]) * pose.stretch[i] * pose.scale;
        sum += d * d;
    }
    return sum;
}

// Is a texel on the gate's side of its mesh, and within `far` m of it?
bool aroundGate(const mesh::BurnDomain& domain, const components::Pose& pose, uint32_t gate,
                uint32_t texel, float far) noexcept {
    float place[3];
    restPlace(domain, gate, place);
    return squaredToTexel(pose, domain, texel, place) < far * far && alike(domain, gate, texel);
}

// m over which power is spread that is no more than the least wide takes.
float footprintRadius(float least, float watts) noexcept {
    return std::max(least, std::sqrt(watts / (3.14159265f * float(gpu::kMaxFlux))));
}

}  // namespace

// The objects that rays from there may meet, for the sweeps that follow.
void EmitterSystem::listJetTargets(const float from[3], float reach) noexcept {
    FW_ASSERT(scene_.objects.live() <= jetSlots_.capacity(), "%u objects", scene_.objects.live());
    jetSlots_.clear();
    for (const uint32_t slot : scene_.objectsNear(from, reach + kFarStep)) {
        const Object& object = scene_.objectAt(slot);
        const components::Pose& pose = object.data.pose;
        const mesh::BurnDomain& domain = scene_.domainOf(object);
        float middle[3], at[3], wide = 0;
        middleOf(domain, middle);
        for (int i = 0; i < 3; ++i) {
            const float half = (domain.boundsHigh[i] - middle[i]) * pose.stretch[i] * pose.scale;
            wide += half * half;
        }
        components::toWorld(pose, middle, at);
        const float far =
            reach + std::sqrt(wide) + kFarStep + 4 * domain.texelSide * longestAxis(pose);
        if (object.skinMoved || squaredDistance(at, from) < far * far) jetSlots_.push_back(slot);
    }
}

// m to the nearest of jetSlots_ and colliders in the way of a ray, or `most`. passed: a texel that
// it went through, with what lies around it on the same side.
float EmitterSystem::sweepJet(const float start[3], const float way[3], float most, JetHit& hit,
                              const JetGate* passed) noexcept {
    const vec3 from = volume::vecOf(start), along = volume::vecOf(way);
    vec3 normal(-along);
    float nearest = sweepShapes(flames_.walls(), from, along, most, normal);
    if (const float cell =
            components::sweepOcclusion(exchange_.occlusionGrid(), start, way, nearest);
        cell < nearest) {
        nearest = cell;
        normal = -along;
    }
    hit = {};
    hit.met = nearest < most;
    for (const uint32_t slot : jetSlots_) {
        const Object& object = scene_.objectAt(slot);
        const components::Pose& pose = object.data.pose;
        const mesh::BurnDomain& domain = scene_.domainOf(object);
        const float least = shortestAxis(pose);
        // Closer than half a link between texels and it is struck; a stretched mesh's are longer
        // one way than the other.
        const float gap =
            std::clamp(0.55f * domain.linkMax, 0.75f * domain.texelSide, 4.0f * domain.texelSide);
        const float close = std::max(gap * longestAxis(pose), kMinStep);
        float enter = 0, leave = nearest;
        if (!object.skinMoved) {
            float a[3], b[3], end[3], local[3];
            components::toObject(pose, start, a);
            for (int i = 0; i < 3; ++i) end[i] = start[i] + way[i];
            components::toObject(pose, end, b);
            for (int i = 0; i < 3; ++i) local[i] = b[i] - a[i];
            if (!within(a, local, domain.boundsLow, domain.boundsHigh, close / least, enter, leave))
                continue;
        }
        float at = enter;
        for (uint32_t i = 0; i < kMostSteps && at <= leave; ++i) {
            float point[3], local[3], texel[3];
            for (int k = 0; k < 3; ++k) point[k] = start[k] + way[k] * at;
            components::toObject(pose, point, local);
            const uint32_t found = scene_.nearTexel(object, local, kFarStep / least);
            if (found == mesh::kNone) {
                at += 0.9f * kFarStep;
                continue;
            }
            scene_.texelPosition(object, found, texel);
            const float distance = std::sqrt(squaredDistance(texel, point));
            if (distance < close) {
                if (at >= nearest) break;
                if (passed && passed->object == object.slot &&
                    aroundGate(domain, pose, passed->texel, found, 3 * close)) {
                    at += 0.4f * close;
                    continue;
                }
                nearest = at;
                hit.met = true;
                hit.object = object.id;
                hit.texel = found;
                const gpu::ivec3 n = gpu::decodeNormal(domain.normals[found]);
                vec3 world;
                for (int k = 0; k < 3; ++k)
                    world[k] = pose.rotation[k][0] * float(n.x) + pose.rotation[k][1] * float(n.y) +
                               pose.rotation[k][2] * float(n.z);
                // Towards where it came from.
                const float turn = glm::dot(world, along) > 0 ? -1.0f : 1.0f;
                const float size = glm::length(world);
                normal = size > 0 ? world * (turn / size) : -along;
                break;
            }
            at += std::max(distance - 0.5f * close, 0.4f * close);
        }
    }
    hit.distance = nearest;
    for (int i = 0; i < 3; ++i) {
        hit.place[i] = start[i] + way[i] * nearest;
        hit.normal[i] = normal[i];
    }
    return nearest;
}

// All rays of a jet, the holder's side first: what stands between the two stops all of them.
// Once a frame: what a jet heats and what its particles meet are the same hits.
void EmitterSystem::sweepJets(FireEmitter& emitter) noexcept {
    if (emitter.swept == sweeps_) return;
    emitter.swept = sweeps_;
    listJetTargets(emitter.position,
                   std::max(emitter.def.behind, kPastReach * emitter.appearance.reach));
    const float behind = emitter.def.behind;
    float holder[3];
    for (int i = 0; i < 3; ++i) holder[i] = emitter.position[i] - emitter.direction[i] * behind;
    JetHit first;
    if (behind > 0 && sweepJet(holder, emitter.direction, behind, first) < behind) {
        emitter.hits.fill(first);
        for (JetHit& hit : emitter.hits) hit.distance = 0;
        return;
    }
    float ways[kRays][3];
    jetRays(emitter, ways);
    for (uint32_t i = 0; i < kRays; ++i)
        (void)sweepJet(emitter.position, ways[i], kPastReach * emitter.appearance.reach,
                       emitter.hits[i]);
}

// For the particles of a frame, and for the emitter's state.
void EmitterSystem::updateJetObstacles(FireEmitter& emitter, double now) noexcept {
    sweepJets(emitter);
    emitter.blockedRays = 0;
    emitter.clearDistance = kPastReach * emitter.appearance.reach;
    for (uint32_t i = 0; i < kRays; ++i) {
        JetHit hit = emitter.hits[i];
        if (const components::JetHole& hole = emitter.holes[i];
            hit.met && hole.object.index1 != 0 && same(hole.object, hit.object) &&
            hole.texel == hit.texel)
            passHole(emitter, hit);
        components::JetObstacle occluder;
        occluder.met = hit.met;
        std::copy_n(hit.place, 3, occluder.place);
        std::copy_n(hit.normal, 3, occluder.normal);
        occluder.radius = 0.10f + 0.6f * hit.distance * halfAngle(emitter);
        components::setJetObstacle(emitter, i, occluder, now);
        emitter.blockedRays += hit.met ? 1u : 0u;
        if (hit.met) emitter.clearDistance = std::min(emitter.clearDistance, hit.distance);
    }
}

void EmitterSystem::forgetObject(const Object& object) noexcept {
    for (auto [i, emitter] : emitters_.entries()) {
        forgetIn(emitter.touches, object.id);
        if (!emitter.stream) continue;
        forgetIn(emitter.stream->patches, object.id);
        forgetIn(emitter.stream->before, object.id);
        for (JetParcel& parcel : emitter.stream->parcels)
            for (JetRay& ray : parcel.rays) {
                if (ray.hit.object.index1 == object.id.index1) ray.hit = {};
                for (uint32_t g = 0; g < ray.gateCount; ++g)
                    if (ray.gates[g].object == object.slot) ray.gateCount = 0;
            }
    }
}

// Continues a ray beyond a hole, for particles. (For heat, the backend decides.)
void EmitterSystem::passHole(const FireEmitter& emitter, JetHit& hit) noexcept {
    JetGate gate;
    gate.object = (*scene_.objects.find(hit.object))->slot;
    gate.texel = hit.texel;
    const float passed = hit.distance;
    float start[3], way[3];
    std::copy_n(hit.place, 3, start);
    for (int i = 0; i < 3; ++i)
        way[i] = passed > 0 ? (hit.place[i] - emitter.position[i]) / passed : emitter.direction[i];
    const float left = std::max(kPastReach * emitter.appearance.reach - passed, 0.0f);
    listJetTargets(start, left);
    hit.distance = passed + sweepJet(start, way, left, hit, &gate);
}

void EmitterSystem::listProbes() noexcept {
    probes_.clear();
    for (auto [slot, emitter] : emitters_.entries()) {
        if (!components::isSwept(emitter.def) || !(emitter.def.power > 0)) continue;
        for (uint32_t i = 0; i < kRays; ++i) {
            const JetHit& hit = emitter.hits[i];
            if (!hit.met || !scene_.objects.find(hit.object)) continue;
            const uint32_t holeTicks = gateTicks(hit, uint32_t(context_.clock.tick) + 1);
            if (holeTicks == 0) continue;
            FW_ASSERT(probes_.size() < probes_.capacity(), "%zu probes", probes_.size());
            probes_.push_back({emitters_.idOf(slot), hit.object, hit.texel, i, holeTicks});
        }
    }
}

// At an exchange, before the steps of a frame are planned: what left the nozzle at earlier ones
// flies on, and another parcel leaves. A frame that failed may come again: then so does all of it.
void EmitterSystem::beginExchanges(uint32_t first) noexcept {
    if (emitters_.live() > 0) flames_.listShapes();
    for (auto [i, emitter] : emitters_.entries()) {
        if (!emitter.stream) continue;
        components::JetStream& stream = *emitter.stream;
        if (stream.patchedAt >= first && first > 0)
            stream.patches = stream.before;
        else
            stream.before = stream.patches;
    }
}

void EmitterSystem::heatObjects(uint32_t now) {
    for (auto [i, emitter] : emitters_.entries())
        if (emitter.def.flags & FW_EMITTER_IGNITES) heatObjects(emitter, now);
}

void EmitterSystem::heatObjects(FireEmitter& emitter, uint32_t now) {
    emitter.heated = 0;
    beginTouches(emitter.touches);
    burnPatches(emitter, now);
    if (emitter.def.power > 0) {
        sweepJets(emitter);
        auto& parcels = emitter.stream->parcels;
        launchJet(emitter, parcels[now / gpu::kExchangeTicks % parcels.size()], now);
    }
    for (JetParcel& parcel : emitter.stream->parcels)
        if (parcel.launched <= now &&
            now - parcel.launched < components::kJetParcels * gpu::kExchangeTicks)
            flyJet(emitter, parcel, now);
    endTouches(emitter.touches);
}

void EmitterSystem::launchJet(const FireEmitter& emitter, JetParcel& parcel,
                              uint32_t now) const noexcept {
    parcel.launched = now;
    const double watts = 1000.0 * double(emitter.def.power) * double(emitter.def.heat);
    parcel.power = uint64_t(watts / kRays * double(kNano));
    parcel.sticks = uint64_t(double(parcel.power) * double(emitter.def.stick));
    std::copy_n(emitter.position, 3, parcel.from);
    parcel.wide = halfAngle(emitter);
    parcel.most = millimetres(kPastReach * emitter.appearance.reach);
    parcel.flight = components::jetFlight(emitter.appearance);
    float ways[kRays][3];
    jetRays(emitter, ways);
    for (uint32_t i = 0; i < kRays; ++i) {
        JetRay& ray = parcel.rays[i];
        std::copy_n(ways[i], 3, ray.way);
        ray.hit = emitter.hits[i];
        ray.version = scene_.geometryVersion;
        ray.spent = components::kJetNever;
        ray.gateCount = 0;
    }
}

// Ticks until a texel that was struck gives way; 0: it never does, or no fire can have been there.
uint32_t EmitterSystem::gateTicks(const JetHit& hit, uint32_t tick) noexcept {
    if (hit.object.index1 == 0) return 0;
    const Object& object = **scene_.objects.find(hit.object);
    if (!components::hasHeat(object.data) || (object.firstEvent >= tick && !exchange_.isOn()))
        return 0;
    return components::holeTicks(object.data, scene_.texelMaterial(object, hit.texel),
                                 context_.def.paceFactor);
}

// Is what was struck there for sure? No fire can have been on it long enough to burn through.
bool EmitterSystem::stands(const JetHit& hit, uint32_t holeTicks, uint32_t tick) noexcept {
    if (holeTicks == 0) return true;
    const Object& object = **scene_.objects.find(hit.object);
    return !exchange_.isOn() && tick - std::min(object.firstEvent, tick) < holeTicks;
}

// On by one exchange. What was in the way as it left is, unless something moved since.
void EmitterSystem::flyJet(FireEmitter& emitter, JetParcel& parcel, uint32_t now) {
    const uint32_t exchange = (now - parcel.launched) / gpu::kExchangeTicks;
    const uint32_t from = parcel.flight[exchange];
    const uint32_t to = std::min(parcel.flight[exchange + 1], parcel.most);
    if (from >= to) return;
    bool listed = false;
    for (JetRay& ray : parcel.rays) {
        if (ray.spent < now) continue;
        ray.spent = components::kJetNever;
        while (ray.gateCount > 0 && ray.passed[ray.gateCount - 1] >= now) --ray.gateCount;
        while (flyRay(emitter, parcel, ray, from, to, now, listed)) {
        }
    }
}

// To what it meets before `to`, mm. True: it may pass there, and flies on.
bool EmitterSystem::flyRay(FireEmitter& emitter, const JetParcel& parcel, JetRay& ray,
                           uint32_t from, uint32_t to, uint32_t now, bool& listed) {
    JetHit hit = ray.hit;
    if (ray.version != scene_.geometryVersion || ray.gateCount > 0) {
        if (!listed) listJetTargets(parcel.from, float(to) / 1000);
        listed = true;
        const JetGate* passed = ray.gateCount > 0 ? &ray.gates[ray.gateCount - 1] : nullptr;
        const float back =
            std::max(float(from) / 1000 - kOverlap, passed ? passed->distance : 0.0f);
        float start[3];
        for (int i = 0; i < 3; ++i) start[i] = parcel.from[i] + ray.way[i] * back;
        hit.distance = back + sweepJet(start, ray.way, float(to) / 1000 - back, hit, passed);
    }
    if (!hit.met || millimetres(hit.distance) > to) return false;
    const uint32_t exchange = (now - parcel.launched) / gpu::kExchangeTicks;
    const uint32_t tick = parcel.launched + components::jetArrival(parcel.flight, exchange,
                                                                   millimetres(hit.distance));
    JetGate gate;
    gate.distance = hit.distance;
    gate.texel = hit.texel;
    if (ray.gateCount < components::kJetGates) gate.holeTicks = gateTicks(hit, tick);
    uint64_t power = parcel.power;
    if (parcel.sticks > 0 && ray.gateCount == 0 && stands(hit, gate.holeTicks, tick))
        power -= parcel.sticks - attachFuel(emitter, hit, parcel.sticks);
    if (hit.object.index1 != 0) {
        gate.object = (*scene_.objects.find(hit.object))->slot;
        heatByJet(emitter, parcel, ray, hit, gate, tick, power);
    }
    if (gate.holeTicks == 0) {
        ray.spent = now;
        return false;
    }
    FW_ASSERT(ray.gateCount < components::kJetGates, "%u gates", ray.gateCount);
    ray.passed[ray.gateCount] = now;
    ray.gates[ray.gateCount++] = gate;
    return true;
}

// Texels around a hit that face what came, or both ways where the one that was struck does.
void EmitterSystem::findFootprint(const Object& object, const JetHit& hit, float radius) {
    const components::Pose& pose = object.data.pose;
    const mesh::BurnDomain& domain = scene_.domainOf(object);
    float point[3];
    if (object.skinMoved)  // what was near at rest still is
        restPlace(domain, hit.texel, point);
    else
        components::toObject(pose, hit.place, point);
    const float least = shortestAxis(pose);
    scene_.found.clear();
    mesh::texelsNear(domain, point, radius / least, scene_.found);
    std::erase_if(scene_.found, [&](uint32_t texel) {
        return !alike(domain, texel, hit.texel) ||
               squaredToTexel(pose, domain, texel, point) > radius * radius;
    });
    if (scene_.found.empty()) scene_.found.push_back(hit.texel);
}

// All that a ray brings goes into the texels that it covers: where it is more than any fire gives,
// it spreads over more of them.
void EmitterSystem::heatByJet(FireEmitter& emitter, const JetParcel& parcel, const JetRay& ray,
                              const JetHit& hit, const JetGate& gate, uint32_t tick,
                              uint64_t brought) {
    Object& object = **scene_.objects.find(hit.object);
    if (object.texels == 0) return;
    const float watts = float(brought) / kNano;
    const float radius = footprintRadius(0.10f + 0.35f * hit.distance * parcel.wide, watts);
    const bool sure = ray.gateCount == 0;  // to get here
    if (!components::hasHeat(object.data)) {
        if (sure)  // else it would catch by our count alone, and we know of no hole
            heatStepThin(emitter, object, hit, radius, watts, tick);
        return;
    }
    const uint64_t power = brought + (sure ? emitter.stream->kept : 0);
    if (power == 0) return;
    PendingTexel event;
    event.gates = ray.gates;
    event.gateCount = ray.gateCount;
    event.shut = gate.holeTicks > 0;
    FW_ASSERT(event.gateCount < event.gates.size() || !event.shut, "%u gates", event.gateCount);
    if (event.shut) event.gates[event.gateCount++] = gate;
    uint64_t left = 0;
    const bool full =
        heatFootprint(object, hit, radius, power, tick, kMaxPoints >> ray.gateCount, event, left);
    if (!sure) return;
    emitter.stream->kept = full ? 0 : left;  // what even all of them cannot take goes past
    emitter.heated += float(power - left) / kNano;
}

// True: they took all that they can. `like`: where the events come from. left: nW that did not go.
bool EmitterSystem::heatFootprint(Object& object, const JetHit& hit, float radius, uint64_t power,
                                  uint32_t tick, size_t most, const PendingTexel& like,
                                  uint64_t& left) {
    const mesh::BurnDomain& domain = scene_.domainOf(object);
    const float square = object.data.pose.scale * object.data.pose.scale;
    const auto areaOf = [&](uint32_t texel) {
        return std::max<uint64_t>(uint64_t(std::llround(domain.areas[texel] * square * kNano)), 1);
    };
    uint64_t covered = 0;
    for (uint32_t i = 0; i < kMaxGrowths && covered * gpu::kMaxFlux < power; ++i) {
        findFootprint(object, hit, radius);
        covered = 0;
        for (const uint32_t texel : scene_.found) covered += areaOf(texel);
        radius *= 1.4f;
    }
    // Of very many a part at each exchange, in turn; as few as can take all of it.
    const size_t parts =
        std::min((scene_.found.size() + most - 1) / most,
                 size_t(covered * gpu::kMaxFlux / std::max(power * 5 / 4, uint64_t(1))));
    if (parts > 1) {
        size_t kept = 0;
        for (size_t i = tick / gpu::kExchangeTicks % parts; i < scene_.found.size(); i += parts)
            scene_.found[kept++] = scene_.found[i];
        scene_.found.resize(kept);
    }
    jetAreas_.clear();
    for (const uint32_t texel : scene_.found) jetAreas_.push_back(areaOf(texel));
    jetFlux_.resize(scene_.found.size());
    burn_.reservePending(scene_.found.size());
    FW_ASSERT(!scene_.found.empty() && jetAreas_.size() == jetFlux_.size(), "%zu texels",
              jetAreas_.size());
    left = components::updateJetShare(power, jetAreas_, jetFlux_);
    object.firstEvent = std::min(object.firstEvent, tick);
    PendingTexel event = like;
    event.object = object.slot;
    event.kind = gpu::kEventHeat;
    event.tick = tick;
    for (size_t i = 0; i < scene_.found.size(); ++i) {
        event.texel = scene_.found[i];
        event.water = jetFlux_[i];
        burn_.addPending(event);
    }
    return jetFlux_[0] >= gpu::kMaxFlux;
}

// ---- fuel that sticks -------------------------------------------------------------------------

// Where it struck, to what sticks near there already if there is any. What has no place comes back.
uint64_t EmitterSystem::attachFuel(FireEmitter& emitter, const JetHit& hit,
                                   uint64_t fuel) noexcept {
    JetPatch* nearest = nullptr;
    JetPatch* free = nullptr;
    float least = kNearPatch * kNearPatch;
    for (JetPatch& patch : emitter.stream->patches) {
        if (patch.left == 0) {
            free = free ? free : &patch;
            continue;
        }
        const float apart = squaredDistance(patch.place, hit.place);
        float along = 0;
        for (int i = 0; i < 3; ++i) along += patch.normal[i] * hit.normal[i];
        if (!same(patch.object, hit.object) || apart > least || along < 0) continue;
        least = apart;
        nearest = &patch;
    }
    JetPatch* patch = nearest ? nearest : free;
    if (!patch) return fuel;
    if (!nearest) {
        *patch = {};
        patch->object = hit.object;
        patch->texel = hit.texel;
        std::copy_n(hit.place, 3, patch->place);
        std::copy_n(hit.normal, 3, patch->normal);
    }
    const auto exchanges = uint32_t(std::lround(emitter.def.stickTime * 8));
    return components::feedPatch(*patch, fuel, std::max(exchanges, 1u));
}

void EmitterSystem::burnPatches(FireEmitter& emitter, uint32_t now) {
    components::JetStream& stream = *emitter.stream;
    stream.patchedAt = now;
    for (JetPatch& patch : stream.patches) {
        if (patch.left == 0) {
            patch.power = 0;
            continue;
        }
        auto* owned = scene_.objects.find(patch.object);
        if (patch.object.index1 != 0 && (!owned || (*owned)->texels == 0)) {
            patch = {};
            continue;
        }
        const uint64_t power = components::burnPatch(patch, now);
        if (patch.object.index1 == 0 || power == 0) continue;
        Object& object = **owned;
        JetHit hit;
        hit.met = true;
        hit.object = patch.object;
        hit.texel = patch.texel;
        float local[3];
        scene_.texelPlace(object, patch.texel, local);
        components::toWorld(object.data.pose, local, patch.place);
        std::copy_n(patch.place, 3, hit.place);
        std::copy_n(patch.normal, 3, hit.normal);
        const float watts = float(power) / kNano;
        const float radius = footprintRadius(components::kPatchRadius, watts);
        if (!components::hasHeat(object.data)) {
            heatStepThin(emitter, object, hit, radius, watts, now);
            continue;
        }
        uint64_t left = 0;
        (void)heatFootprint(object, hit, radius, power, now, kMaxPoints / 2, {}, left);
        // The next exchange gives what no texel could take, if there is one.
        if (patch.left > 0) patch.fuel += left;
        emitter.heated += float(power - left) / kNano;
    }
}

void EmitterSystem::wetPatches(std::span<const Splash> splashes, bool records) noexcept {
    for (const Splash& splash : splashes) {
        const FwBurnableMeshId object = scene_.objects.idOf(splash.slot);
        const auto isHit = [&](const JetPatch& patch) {
            const float far = splash.radius + components::kPatchRadius;
            return patch.left > 0 && same(patch.object, object) &&
                   squaredDistance(patch.place, splash.position) < far * far;
        };
        for (auto [i, emitter] : emitters_.entries())
            for (uint32_t k = 0; emitter.stream && k < components::kJetPatches; ++k) {
                JetPatch& patch = emitter.stream->patches[k];
                JetPatch& before = emitter.stream->before[k];
                if (isHit(before)) components::wetPatch(before, splash.grams, splash.tick);
                if (!isHit(patch)) continue;
                components::wetPatch(patch, splash.grams, splash.tick);
                if (records) context_.recorder.record(WetPatch{i, k, splash.grams, splash.tick});
            }
    }
}

// An object without heat catches after the time that its material takes.
void EmitterSystem::heatStepThin(FireEmitter& emitter, Object& object, const JetHit& hit,
                                 float radius, float watts, uint32_t now) {
    emitter.heated += watts;
    const uint32_t material = scene_.texelMaterial(object, hit.texel);
    if (!components::burns(object.data, material)) return;
    components::JetTouch* touch = touchOf(emitter.touches, object.id);
    if (!touch) return;
    if (touch->object.index1 == 0) *touch = {object.id, now};
    touch->seen = true;
    const float flux = watts / (3.14159265f * radius * radius);
    if (now - touch->since < burn_.ticksToCatch(object, material, double(flux))) return;
    FwIgnitionDef def{};
    def.kind = FW_IGNITE;
    std::copy_n(hit.place, 3, def.position);
    def.radius = radius;
    (void)burn_.igniteObject(object, def, now);
}

}  // namespace fw::world
