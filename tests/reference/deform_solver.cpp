#include "reference/deform_solver.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>

namespace fw::mesh {
namespace {

using gpu::DeformMaterial;
using gpu::DeformParticle;
using gpu::ShownVertex;
using gpu::vec3;

vec3 placeOf(const ShownVertex& v) { return {v.x, v.y, v.z}; }
void place(ShownVertex& v, vec3 p) {
    v.x = p.x;
    v.y = p.y;
    v.z = p.z;
}
vec3 restOf(const DeformParticle& node) { return {node.x, node.y, node.z}; }

// `links`: neighbours and rest lengths, as packed; a length of 0 is no link.
struct Links {
    float rest[gpu::kDeformRing];
    explicit Links(const uint32_t (&lengths)[gpu::kDeformRing / 2]) {
        for (uint32_t i = 0; i < gpu::kDeformRing; ++i)
            rest[i] = gpu::unpackHalf2x16(lengths[i / 2])[int(i & 1)];
    }
};

// Around a particle, by its current position.
vec3 normalOf(const DeformParticle& node, const DeformState& state, uint32_t parity) {
    const vec3 x = state.soft[node.vertex].place[parity];
    vec3 turned(0), before(0), first(0);
    for (uint32_t k = 0; k < gpu::kDeformRing; ++k) {
        const vec3 arm = state.soft[node.ring[k]].place[parity] - x;
        turned += gpu::cross(before, arm);
        if (k == 0) first = arm;
        before = arm;
    }
    if (node.flags & gpu::kParticleClosed) turned += gpu::cross(before, first);
    const float size = gpu::length(turned);
    return size > 1e-18f ? turned / size : vec3(0);
}

float inSteps(float charred) { return std::floor(charred * gpu::kCharredSteps + 0.5f); }

void linkCachePass(const DeformModel& model, const gpu::DeformObject& object, DeformState& state) {
    for (const DeformParticle& node : model.particles)
        state.soft[node.vertex].burnt = state.shown[node.vertex].burnt;
    for (const DeformParticle& node : model.particles) {
        DeformState::Soft& self = state.soft[node.vertex];
        const auto number = uint32_t(&node - model.particles.data());
        const auto holds = [&](uint32_t other) {
            return gpu::linkHolds(self.burnt, state.soft[other].burnt,
                                  gpu::linkOdds(number, model.particleOf[other]));
        };
        const Links links(node.ringLength);
        self.holds = self.pinned = 0;
        uint32_t count = 0;
        for (uint32_t k = 0; k < gpu::kDeformRing; ++k) {
            if (!(links.rest[k] > 0)) continue;
            const DeformState::Soft& there = state.soft[node.ring[k]];
            self.pinned |=
                there.reach[state.parity] == 0 && there.burnt <= gpu::kPinBurns ? 1u << k : 0;
            if (!holds(node.ring[k])) continue;
            self.holds |= 1u << k;
            ++count;
        }
        for (uint32_t k = 0; k < 2 * gpu::kBendSets; ++k)
            if (node.bendEnds[k] != kNone && holds(node.bendEnds[k])) self.holds |= 1u << (k + 8);
        const uint32_t ring = node.flags >> gpu::kParticleRingShift & 15u;
        self.whole = (node.flags & gpu::kParticleClosed) && count == ring;
        float nearest = 1e30f;
        const vec3 x = self.place[state.parity];
        for (uint32_t i = 0; i < object.pinCount; ++i) {
            const vec3 point =
                gpu::pinPoint(x, vec3(object.pins[i * 2]), vec3(object.pins[i * 2 + 1]));
            const float away = gpu::length(x - point);
            if (away >= nearest) continue;
            nearest = away;
            self.anchor = gpu::vec4(point, object.pins[i * 2].w);
        }
    }
    state.tied = true;
}

// m, as devices store it.
vec3 unpackBendShare(vec3 share) {
    return gpu::unpackBendShare(gpu::packBendShare(share * gpu::kBendUnit)) / gpu::kBendUnit;
}

// Its own bends, and its shares of others' bends of the step before.
vec3 bendingOf(const DeformParticle& node, const DeformMaterial& material, const SheetDrive& drive,
               DeformState& state) {
    DeformState::Soft& self = state.soft[node.vertex];
    const uint32_t now = state.parity;
    const vec3 x = self.place[now];
    self.normal = normalOf(node, state, now);
    const float charred = gpu::charredShare(self.burnt);
    const float loose = material.bend;
    const float stiff = loose + (std::max(loose, 0.9f) - loose) * charred;
    const float curl = gpu::curlSide(self.normal, drive.up) * material.curl * charred;
    vec3 bending(0);
    const auto bend = [&](uint32_t kind, vec3 sum, float count, float rise, float relax, bool whole,
                          bool even) {
        const float mean = 1 / std::max(count, 1.0f);
        self.bend[kind] =
            whole ? gpu::bendOf(sum * mean, self.normal, rise, count, relax, even) : vec3(0);
        self.share[now ^ 1][kind] = unpackBendShare(self.bend[kind] * mean);
        bending += self.share[now ^ 1][kind] * count;
    };
    const Links links(node.ringLength);
    vec3 sum(0);
    float count = 0, squares = 0;
    for (uint32_t k = 0; k < gpu::kDeformRing; ++k) {
        if ((self.holds >> k & 1u) == 0) continue;
        const DeformState::Soft& there = state.soft[node.ring[k]];
        sum += there.place[now] - x;
        squares += links.rest[k] * links.rest[k];
        count += 1;
        bending -= there.share[now][0];
    }
    bend(0, sum, count, node.rise + gpu::curlRise(curl, squares / std::max(count, 1.0f)),
         stiff * gpu::kBendRelax, self.whole, (node.flags & gpu::kParticleEven) != 0);
    sum = vec3(0);
    count = squares = 0;
    float ends[2]{};
    for (uint32_t k = 0; k < 2; ++k) {
        const uint32_t arm = 2 * state.way + k, other = node.bendEnds[arm];
        if (other == kNone) continue;
        ends[k] = inSteps(gpu::charredShare(state.soft[other].burnt)) / gpu::kCharredSteps;
        const vec3 to = state.soft[other].place[now] - x;
        if ((self.holds >> (arm + 8) & 1u) == 0 ||
            gpu::length(to) > gpu::kBendTears * node.bendLength[arm])
            continue;
        sum += to;
        squares += node.bendLength[arm] * node.bendLength[arm];
        count += 1;
    }
    const float across = gpu::bendCurl(ends[0], ends[1]);
    bend(1, sum, count,
         node.bendRise[state.way] + gpu::kBendCurl * across * gpu::curlRise(curl, squares * 0.5f),
         gpu::bendStiffness(stiff, charred, across), count == 2,
         (node.flags & gpu::kParticleBendsEven << state.way) != 0);
    const uint32_t echoed = (state.way + gpu::kBendSets - 1) % gpu::kBendSets;
    for (uint32_t k = 0; k < 2; ++k)
        if (const uint32_t other = node.bendEnds[2 * echoed + k]; other != kNone)
            bending -= state.soft[other].share[now][1];
    return bending;
}

}  // namespace

void resetSoft(const DeformModel& model, const gpu::DeformObject& object, DeformState& state) {
    state.soft.assign(model.embeddings.size(), {});
    state.parity = state.way = 0;
    state.tied = false;
    for (const DeformParticle& node : model.particles) {
        DeformState::Soft& soft = state.soft[node.vertex];
        soft.place[0] = soft.place[1] = restOf(node);
        // Known from the start, or a sheet would fall until the distance to its pins has spread to
        // it.
        float reach = gpu::kNoPath;
        for (uint32_t i = 0; i < object.pinCount; ++i) {
            const vec3 point =
                gpu::pinPoint(restOf(node), vec3(object.pins[i * 2]), vec3(object.pins[i * 2 + 1]));
            const float away = gpu::length(restOf(node) - point) - object.pins[i * 2].w;
            reach = std::min(reach, std::max(away, 0.0f));
        }
        soft.reach[0] = soft.reach[1] = reach;
    }
}

void sheetStep(const DeformModel& model, const gpu::DeformObject& object, const SheetDrive& drive,
               DeformState& state) {
    if (!state.tied || gpu::updatesLinkCache(state.way)) linkCachePass(model, object, state);
    const uint32_t now = state.parity;
    for (const DeformParticle& node : model.particles) {
        DeformState::Soft& self = state.soft[node.vertex];
        ShownVertex& shown = state.shown[node.vertex];
        const DeformMaterial& material = object.materials[node.flags & 7u];
        const float charred = gpu::charredShare(self.burnt);
        const bool pinned = self.reach[now] == 0 && self.burnt <= gpu::kPinBurns;
        const vec3 x = self.place[now];
        const Links links(node.ringLength);
        const vec3 bending = bendingOf(node, material, drive, state);
        vec3 pushed(0);
        float reach = gpu::kNoPath;
        for (uint32_t k = 0; k < gpu::kDeformRing; ++k) {
            if ((self.holds >> k & 1u) == 0) continue;
            const DeformState::Soft& there = state.soft[node.ring[k]];
            const float shrunk = material.shrink * 0.5f / gpu::kCharredSteps;
            const float both = inSteps(charred) + inSteps(gpu::charredShare(there.burnt));
            pushed += gpu::linkCorrection(x, there.place[now], links.rest[k] * (1 - shrunk * both),
                                          (self.pinned >> k & 1u) ? 1.0f : 0.5f);
            reach = std::min(reach, there.reach[now] + links.rest[k]);
        }
        const float was = self.reach[now] == 0 && !pinned ? gpu::kNoPath : self.reach[now];
        const bool knew = self.known;
        self.known = knew || gpu::isPathKnown(reach, was);
        reach = pinned ? 0 : gpu::nextPath(reach, was, knew);
        const vec3 last = placeOf(shown);
        vec3 moved = x + pushed * gpu::relaxAt(gpu::kLinkRelax, drive.step) +
                     bending * gpu::relaxAt(1, drive.step);
        if (reach < 0.5f * gpu::kNoPath) {
            const vec3 anchor(self.anchor);
            const float away = gpu::length(moved - anchor);
            const float most = reach * gpu::kPathSlack + self.anchor.w;
            if (away > most) moved = anchor + (moved - anchor) * (most / away);
        }
        const float height = gpu::dot(moved, drive.up);
        const bool down = height < object.ground;
        if (down) moved += drive.up * (object.ground - height);
        vec3 velocity = gpu::limitSpeed((moved - last) / drive.step, gpu::kFastest);
        velocity *= down ? 0.5f : gpu::sheetDamping(charred, drive.step);
        const float slowed = material.drag * (1 + 2 * charred) * drive.step;
        const vec3 air = drive.wind * gpu::gustAt(x, 1, drive.time) +
                         drive.up * (drive.updraft * gpu::updraftAt(self.burnt));
        velocity += self.normal * (gpu::dot(self.normal, air - velocity) * slowed / (1 + slowed));
        velocity -= drive.up * (drive.gravity * drive.step);
        vec3 next = moved + velocity * drive.step;
        if (pinned) moved = next = restOf(node);
        place(shown, moved);
        self.place[now ^ 1] = next;
        self.reach[now ^ 1] = reach;
    }
    state.parity ^= 1;
    state.way = (state.way + 1) % gpu::kBendSets;
}

void springStep(const DeformModel& model, std::span<const reference::FarLinks> far, float stiffness,
                float step, std::span<const float> lost, float damping, DeformState& state) {
    const uint32_t now = state.parity;
    const float share = stiffness * gpu::kSpringShare;
    for (size_t i = 0; i < model.particles.size(); ++i) {
        const DeformParticle& node = model.particles[i];
        DeformState::Soft& self = state.soft[node.vertex];
        const vec3 x = self.place[now];
        const Links ring(node.ringLength);
        vec3 force(0);
        for (uint32_t k = 0; k < gpu::kDeformRing; ++k) {
            if (ring.rest[k] > 0)
                force +=
                    gpu::springPull(x, state.soft[node.ring[k]].place[now], ring.rest[k], share);
            if (far.empty() || !(far[i].length[k] > 0)) continue;
            const float rest = glm::unpackHalf1x16(glm::packHalf1x16(far[i].length[k]));
            force += gpu::springPull(x, state.soft[far[i].vertex[k]].place[now], rest, share);
        }
        if (!lost.empty())
            force += gpu::decayPull(normalOf(node, state, now), lost[i], step) * gpu::kDecayShare;
        const vec3 last = placeOf(state.shown[node.vertex]);
        const vec3 velocity = (x - last) * ((1 - damping) / step) + force * step;
        place(state.shown[node.vertex], x);
        self.place[now ^ 1] = x + velocity * step;
    }
    state.parity ^= 1;
}

void resetDeform(const DeformModel& model, DeformState& state) {
    state.shown.assign(model.embeddings.size(), ShownVertex{});
    for (const DeformParticle& node : model.particles)
        place(state.shown[node.vertex], restOf(node));
    skinVertices(model, state);
}

void recede(const DeformModel& model, const gpu::DeformObject& object,
            std::span<const uint32_t> states, uint32_t now, DeformState& state) {
    for (const DeformParticle& node : model.particles) {
        ShownVertex& shown = state.shown[node.vertex];
        const DeformMaterial& material = object.materials[node.flags & 7u];
        float sum = 0, known = 0;
        for (const uint32_t texel : node.texels) {
            if (texel == kNone) continue;
            sum += gpu::burntShare(states[texel], now, 0, material.charTicks);
            known += 1;
        }
        shown.burnt = std::max(shown.burnt, sum / std::max(known, 1.0f));
        shown.behind = 0;
        if (node.opposite != kNone)
            shown.behind = material.holeSeconds *
                           gpu::burntShare(states[node.opposite], now, 0, material.holeTicks);
        place(shown, restOf(node) + vec3(node.outX, node.outY, node.outZ) *
                                        gpu::recession(shown.burnt, material.depth, node.limit));
    }
}

void skinVertices(const DeformModel& model, DeformState& state, bool tears) {
    for (size_t i = 0; i < model.embeddings.size(); ++i) {
        const gpu::DeformEmbedding& embedding = model.embeddings[i];
        const ShownVertex& node = state.shown[embedding.particle];
        const vec3 at = placeOf(node);
        vec3 turned(0), before(0);
        float square = 0;
        for (const uint32_t neighbour : embedding.ring) {
            const vec3 arm = placeOf(state.shown[neighbour]) - at;
            turned += gpu::cross(before, arm);
            before = arm;
            square = std::max(square, gpu::dot(arm, arm));
        }
        const float size = gpu::length(turned);
        const vec3 rest = gpu::unpackDirection(embedding.normal);
        vec3 normal = rest;
        if (size > 1e-18f)
            normal = gpu::rotateNormal(
                rest, vec3(embedding.faceX, embedding.faceY, embedding.faceZ), turned / size);
        ShownVertex& shown = state.shown[i];
        shown.normal = normal == rest ? embedding.normal : gpu::packDirection(normal);
        shown.burnThrough = node.behind;
        if (tears)
            shown.burnThrough =
                std::max(shown.burnThrough, gpu::tornOffset(square, embedding.longest, node.burnt));
        shown.burnt = node.burnt;
        place(shown, at);
    }
}

}  // namespace fw::mesh
