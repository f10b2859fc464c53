// What the jets of fire emitters strike: rays swept from the holder's side of the nozzle through
// colliders, blockers and burnable meshes. What they strike first is heated and nothing behind it.
// By the host's numbers alone: events, the same on every backend. Particles see the same hits.
#include "mesh/bake.h"
#include "shared/exchange.h"
#include "world/world.h"

#include <algorithm>
#include <cmath>

namespace fw::world {
namespace {

using components::FireEmitter;
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
constexpr float kClose = 0.01f, kLeastStep = 0.02f, kFarStep = 1.0f;  // m
constexpr uint32_t kMostSteps = 96;                                   // of a ray
constexpr size_t kMostPoints = 48;                                    // that a ray heats
constexpr float kFluxUnit = 100;                                      // W/m^2 of a kEventHeat

vec3 vecOf(const float v[3]) noexcept { return {v[0], v[1], v[2]}; }

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
        at += std::max(surface.distance, kLeastStep);
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

}  // namespace

// m to the nearest thing in the way of a ray, or `most`.
float World::sweepJet(const float start[3], const float way[3], float most, JetHit& hit) noexcept {
    const vec3 from = vecOf(start), along = vecOf(way);
    vec3 normal(-along);
    float nearest = sweepShapes(fireShapes_, from, along, most, normal);
    hit = {};
    hit.met = nearest < most;
    for (uint32_t slot = 0; slot < objects_.slotCount(); ++slot) {
        const auto* owned = objects_.at(slot);
        if (!owned) continue;
        const Object& object = **owned;
        const components::Pose& pose = object.data.pose;
        const mesh::BurnDomain& domain = domainOf(object);
        const float least =
            pose.scale * std::min({std::abs(pose.stretch[0]), pose.stretch[1], pose.stretch[2]});
        const float most_ =
            pose.scale * std::max({std::abs(pose.stretch[0]), pose.stretch[1], pose.stretch[2]});
        // Closer than half a link between texels and it is struck; a stretched mesh's are longer
        // one way than the other.
        const float gap =
            std::clamp(0.55f * domain.linkMax, 0.75f * domain.texelSide, 4.0f * domain.texelSide);
        const float close = std::max(gap * most_, kLeastStep);
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
            const uint32_t found = nearTexel(object, local, kFarStep / least);
            if (found == mesh::kNone) {
                at += 0.9f * kFarStep;
                continue;
            }
            texelPosition(object, found, texel);
            float sum = 0;
            for (int k = 0; k < 3; ++k) sum += (texel[k] - point[k]) * (texel[k] - point[k]);
            const float distance = std::sqrt(sum);
            if (distance < close) {
                if (at >= nearest) break;
                nearest = at;
                hit.met = true;
                hit.object = object.id;
                hit.texel = found;
                const gpu::ivec3 n = gpu::decodeNormal(domain.normals[found]);
                float sign = 0, world[3];
                for (int k = 0; k < 3; ++k) {
                    world[k] = pose.rotation[k][0] * float(n.x) + pose.rotation[k][1] * float(n.y) +
                               pose.rotation[k][2] * float(n.z);
                    sign += world[k] * way[k];
                }
                const float turn = sign > 0 ? -1.0f : 1.0f;  // towards where it came from
                const float size =
                    std::sqrt(world[0] * world[0] + world[1] * world[1] + world[2] * world[2]);
                normal = size > 0 ? vec3(world[0], world[1], world[2]) * (turn / size) : -along;
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
void World::sweepJets(const FireEmitter& emitter, std::array<JetHit, kRays>& hits) noexcept {
    const float behind = emitter.def.behind;
    float holder[3];
    for (int i = 0; i < 3; ++i) holder[i] = emitter.position[i] - emitter.direction[i] * behind;
    JetHit first;
    if (behind > 0 && sweepJet(holder, emitter.direction, behind, first) < behind) {
        hits.fill(first);
        for (JetHit& hit : hits) hit.distance = 0;
        return;
    }
    const float* d = emitter.direction;
    const vec3 across = std::abs(d[1]) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0);
    const vec3 along = vecOf(d);
    vec3 r(along.y * across.z - along.z * across.y, along.z * across.x - along.x * across.z,
           along.x * across.y - along.y * across.x);
    r /= std::sqrt(r.x * r.x + r.y * r.y + r.z * r.z);
    const vec3 u(r.y * along.z - r.z * along.y, r.z * along.x - r.x * along.z,
                 r.x * along.y - r.y * along.x);
    const float wide = emitter.look.cone * 1.8f + 0.02f;
    for (uint32_t i = 0; i < kRays; ++i) {
        vec3 way = along + r * (kPattern[i][0] * wide) + u * (kPattern[i][1] * wide);
        way /= std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z);
        const float given[3] = {way.x, way.y, way.z};
        (void)sweepJet(emitter.position, given, 1.15f * emitter.look.reach, hits[i]);
    }
}

// For the particles of a frame, and for what is told of it.
void World::shieldJet(FireEmitter& emitter, double now) noexcept {
    std::array<JetHit, kRays> hits;
    sweepJets(emitter, hits);
    emitter.struck = 0;
    emitter.freeWay = 1.15f * emitter.look.reach;
    for (uint32_t i = 0; i < kRays; ++i) {
        components::JetShield shield;
        shield.met = hits[i].met;
        std::copy_n(hits[i].place, 3, shield.place);
        std::copy_n(hits[i].normal, 3, shield.normal);
        shield.radius = 0.10f + 0.6f * hits[i].distance * (emitter.look.cone * 1.8f + 0.02f);
        components::takeShield(emitter, i, shield, now);
        emitter.struck += hits[i].met ? 1u : 0u;
        if (hits[i].met) emitter.freeWay = std::min(emitter.freeWay, hits[i].distance);
    }
}

// At an exchange, before the steps of a frame are planned.
void World::touchByJet(FireEmitter& emitter, uint32_t now) {
    emitter.heated = 0;
    if (!(emitter.def.power > 0)) return;
    std::array<JetHit, kRays> hits;
    sweepJets(emitter, hits);
    for (components::JetTouch& touch : emitter.touches) touch.seen = false;
    const float watts = 1000.0f * emitter.def.power * emitter.def.heat / float(kRays);
    for (const JetHit& hit : hits) {
        if (!hit.met || hit.object.index1 == 0) continue;
        Object& object = **objects_.find(hit.object);
        const components::Pose& pose = object.data.pose;
        const mesh::BurnDomain& domain = domainOf(object);
        if (object.texels == 0) continue;
        // What a ray's share of the stream covers.
        const float radius = 0.10f + 0.35f * hit.distance * (emitter.look.cone * 1.8f + 0.02f);
        const float flux = watts / (3.14159265f * radius * radius);
        emitter.heated += watts;
        if (!components::hasHeat(object.data)) {
            heatLite(emitter, object, hit, radius, flux, now);
            continue;
        }
        const float least =
            pose.scale * std::min({std::abs(pose.stretch[0]), pose.stretch[1], pose.stretch[2]});
        float point[3];
        components::toObject(pose, hit.place, point);
        found_.clear();
        if (object.skinMoved)
            found_.push_back(hit.texel);
        else
            mesh::texelsNear(domain, point, radius / least, found_);
        std::sort(found_.begin(), found_.end());
        if (found_.empty()) found_.push_back(hit.texel);
        if (found_.size() > kMostPoints) {
            const size_t every = (found_.size() + kMostPoints - 1) / kMostPoints;
            size_t kept = 0;
            for (size_t i = 0; i < found_.size(); i += every) found_[kept++] = found_[i];
            found_.resize(kept);
        }
        const auto units = uint32_t(std::clamp(flux / kFluxUnit, 1.0f, 5000.0f));
        addPending(object, gpu::kEventHeat, now, units, found_);
    }
    for (components::JetTouch& touch : emitter.touches)
        if (!touch.seen) touch.object = {};
}

// What has no heat of its own catches after as long as its material takes.
void World::heatLite(FireEmitter& emitter, Object& object, const JetHit& hit, float radius,
                     float flux, uint32_t now) {
    const uint32_t material = texelMaterial(object, hit.texel);
    if (!components::burns(object.data, material)) return;
    components::JetTouch* touch = nullptr;
    for (components::JetTouch& one : emitter.touches)
        if (one.object.index1 == object.id.index1 && one.object.generation == object.id.generation)
            touch = &one;
    for (components::JetTouch& one : emitter.touches)
        if (!touch && one.object.index1 == 0) {
            touch = &one;
            *touch = {};
            touch->object = object.id;
            touch->since = now;
        }
    if (!touch) return;
    touch->seen = true;
    const FwMaterialDef& of = object.data.materials[material];
    if (now - touch->since <
        ticksToCatch(of, of.moisture + object.data.moisture, def_.paceFactor, double(flux)))
        return;
    FwIgnitionDef def{};
    def.kind = FW_IGNITE;
    std::copy_n(hit.place, 3, def.position);
    def.radius = radius;
    (void)igniteObject(object, def, now);
}

}  // namespace fw::world
