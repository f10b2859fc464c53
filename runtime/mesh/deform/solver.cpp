#include "mesh/deform/solver.h"

#include <algorithm>
#include <cmath>

namespace fw::mesh {
namespace {

using gpu::DeformMaterial;
using gpu::DeformNode;
using gpu::ShownVertex;
using gpu::vec3;

constexpr float kCharredSteps = 15;  // in which nodes know of others'

vec3 placeOf(const ShownVertex& v) { return {v.x, v.y, v.z}; }
void place(ShownVertex& v, vec3 p) {
    v.x = p.x;
    v.y = p.y;
    v.z = p.z;
}
vec3 restOf(const DeformNode& node) { return {node.x, node.y, node.z}; }

// `links`: neighbours and rest lengths, as packed; a length of 0 is no link.
struct Links {
    float rest[gpu::kDeformRing];
    explicit Links(const uint32_t (&lengths)[gpu::kDeformRing / 2]) {
        for (uint32_t i = 0; i < gpu::kDeformRing; ++i)
            rest[i] = gpu::unpackHalf2x16(lengths[i / 2])[int(i & 1)];
    }
};

// Around a node, by its present places.
vec3 normalOf(const DeformNode& node, const DeformState& state, uint32_t parity) {
    const vec3 x = state.soft[node.vertex].place[parity];
    vec3 turned(0), before(0), first(0);
    for (uint32_t k = 0; k < gpu::kDeformRing; ++k) {
        const vec3 arm = state.soft[node.ring[k]].place[parity] - x;
        turned += gpu::cross(before, arm);
        if (k == 0) first = arm;
        before = arm;
    }
    if (node.flags & gpu::kNodeClosed) turned += gpu::cross(before, first);
    const float size = gpu::length(turned);
    return size > 1e-18f ? turned / size : vec3(0);
}

void bendPass(const DeformModel& model, const gpu::DeformObject& object, const SheetDrive& drive,
              DeformState& state) {
    for (const DeformNode& node : model.nodes) {
        DeformState::Soft& self = state.soft[node.vertex];
        const auto number = uint32_t(&node - model.nodes.data());
        const DeformMaterial& material = object.materials[node.flags & 7u];
        const float burnt = state.shown[node.vertex].burnt;
        const vec3 x = self.place[state.parity];
        self.normal = normalOf(node, state, state.parity);
        const float charred = gpu::charredShare(burnt);
        const float stiff = gpu::mixF(material.bend, std::max(material.bend, 0.9f), charred);
        const float curl = gpu::curlSide(self.normal, drive.up) * material.curl * charred;
        self.holds = 0;
        const auto holds = [&](uint32_t other) {
            return gpu::linkHolds(burnt, state.shown[other].burnt,
                                  gpu::linkOdds(number, model.nodeOf[other]));
        };
        const auto bend = [&](uint32_t kind, vec3 sum, float count, float rise, float relax,
                              bool whole, bool even) {
            const float mean = 1 / std::max(count, 1.0f);
            self.bend[kind] =
                whole ? gpu::bendOf(sum * mean, self.normal, rise, count, relax, even) : vec3(0);
            self.share[kind] = self.bend[kind] * mean;
        };
        const Links links(node.ringLength);
        vec3 sum(0);
        float count = 0, squares = 0;
        for (uint32_t k = 0; k < gpu::kDeformRing; ++k) {
            const float rest = links.rest[k];
            if (!(rest > 0) || !holds(node.ring[k])) continue;
            self.holds |= 1u << k;
            sum += state.soft[node.ring[k]].place[state.parity] - x;
            squares += rest * rest;
            count += 1;
        }
        const uint32_t ring = node.flags >> gpu::kNodeRingShift & 15u;
        bend(0, sum, count, node.rise + gpu::curlRise(curl, squares / std::max(count, 1.0f)),
             stiff * gpu::kBendRelax, (node.flags & gpu::kNodeClosed) && count == float(ring),
             (node.flags & gpu::kNodeEven) != 0);
        sum = vec3(0);
        count = squares = 0;
        float ends[2]{};
        for (uint32_t k = 0; k < 2; ++k) {
            const uint32_t other = node.arms[2 * state.way + k];
            if (other == kNone || !holds(other)) continue;
            const float rest = node.armLength[2 * state.way + k];
            const vec3 arm = state.soft[other].place[state.parity] - x;
            if (gpu::length(arm) > gpu::kArmTears * rest) continue;
            self.holds |= 1u << (k + 8);
            ends[k] =
                std::floor(gpu::charredShare(state.shown[other].burnt) * kCharredSteps + 0.5f) /
                kCharredSteps;
            sum += arm;
            squares += rest * rest;
            count += 1;
        }
        const float across = gpu::armCurl(ends[0], ends[1]);
        bend(
            1, sum, count,
            node.armRise[state.way] + gpu::kArmCurls * across * gpu::curlRise(curl, squares * 0.5f),
            gpu::armFirm(stiff, charred, across), count == 2,
            (node.flags & gpu::kNodeArmsEven << state.way) != 0);
    }
}

}  // namespace

void resetSoft(const DeformModel& model, const gpu::DeformObject& object, DeformState& state) {
    state.soft.assign(model.coats.size(), {});
    state.parity = state.way = 0;
    for (const DeformNode& node : model.nodes) {
        DeformState::Soft& soft = state.soft[node.vertex];
        soft.place[0] = soft.place[1] = restOf(node);
        // Known from the start, or a sheet would fall until word of its pins came to it.
        float reach = gpu::kReachNone;
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
    bendPass(model, object, drive, state);
    const uint32_t now = state.parity;
    for (const DeformNode& node : model.nodes) {
        DeformState::Soft& self = state.soft[node.vertex];
        ShownVertex& shown = state.shown[node.vertex];
        const DeformMaterial& material = object.materials[node.flags & 7u];
        if (self.reach[now] == 0 && shown.burnt > gpu::kPinBurns) self.reach[now] = gpu::kReachNone;
        const float charred = gpu::charredShare(shown.burnt);
        const vec3 x = self.place[now];
        const Links links(node.ringLength);
        vec3 pushed(0), bending = self.bend[0] + self.bend[1];
        float reach = gpu::kReachNone;
        for (uint32_t k = 0; k < gpu::kDeformRing; ++k) {
            const uint32_t other = node.ring[k];
            const ShownVertex& facts = state.shown[other];
            if ((self.holds >> k & 1u) == 0) continue;
            const DeformState::Soft& there = state.soft[other];
            const float wanted =
                links.rest[k] *
                (1 - material.shrink * 0.5f * (charred + gpu::charredShare(facts.burnt)));
            pushed +=
                gpu::linkPush(x, there.place[now], wanted, there.reach[now] == 0 ? 1.0f : 0.5f);
            bending -= there.share[0];
            reach = std::min(reach, there.reach[now] + links.rest[k]);
        }
        reach = std::min(reach, gpu::kReachNone);
        const float was = self.reach[now], way = reach;
        reach = gpu::reachNext(way, was, self.known);
        self.known = self.known || gpu::reachKnown(way, was);
        for (uint32_t k = 0; k < 2; ++k)
            if (self.holds >> (k + 8) & 1u)
                bending -= state.soft[node.arms[2 * state.way + k]].share[1];
        const vec3 last = placeOf(shown);
        vec3 moved = x + pushed * gpu::relaxAt(gpu::kLinkRelax, drive.step) +
                     bending * gpu::relaxAt(1, drive.step);
        if (reach < 0.5f * gpu::kReachNone) {
            float nearest = 1e30f, radius = 0;
            vec3 anchor(0);
            for (uint32_t i = 0; i < object.pinCount; ++i) {
                const vec3 point =
                    gpu::pinPoint(moved, vec3(object.pins[i * 2]), vec3(object.pins[i * 2 + 1]));
                const float d = gpu::length(moved - point);
                if (d >= nearest) continue;
                nearest = d;
                anchor = point;
                radius = object.pins[i * 2].w;
            }
            const float most = reach * gpu::kReachSlack + radius;
            if (nearest < 1e29f && nearest > most)
                moved = anchor + (moved - anchor) * (most / nearest);
        }
        const float height = gpu::dot(moved, drive.up);
        const bool down = height < object.ground;
        if (down) moved += drive.up * (object.ground - height);
        vec3 velocity = gpu::noFasterThan((moved - last) / drive.step, gpu::kFastest);
        velocity *= down ? 0.5f : gpu::sheetDamping(charred, drive.step);
        const float slowed = material.drag * (1 + 2 * charred) * drive.step;
        const vec3 air = drive.wind * gpu::gustAt(x, 1, drive.time) +
                         drive.up * (drive.updraft * gpu::updraftAt(shown.burnt));
        velocity += self.normal * (gpu::dot(self.normal, air - velocity) * slowed / (1 + slowed));
        velocity -= drive.up * (drive.gravity * drive.step);
        vec3 next = moved + velocity * drive.step;
        if (self.reach[now] == 0) {
            moved = next = restOf(node);
            reach = 0;
        }
        place(shown, moved);
        self.place[now ^ 1] = next;
        self.reach[now ^ 1] = reach;
    }
    state.parity ^= 1;
    state.way = (state.way + 1) % gpu::kArmWays;
}

void springStep(const DeformModel& model, const gpu::DeformObject& object, float step,
                std::span<const float> lost, float damping, DeformState& state) {
    const uint32_t now = state.parity;
    const float stiffness = object.springs * gpu::kSpringShare;
    for (size_t i = 0; i < model.nodes.size(); ++i) {
        const DeformNode& node = model.nodes[i];
        DeformState::Soft& self = state.soft[node.vertex];
        const vec3 x = self.place[now];
        const Links ring(node.ringLength), cross(node.crossLength);
        vec3 force(0);
        for (uint32_t k = 0; k < gpu::kDeformRing; ++k) {
            if (ring.rest[k] > 0)
                force += gpu::springPull(x, state.soft[node.ring[k]].place[now], ring.rest[k],
                                         stiffness);
            if (cross.rest[k] > 0)
                force += gpu::springPull(x, state.soft[node.cross_[k]].place[now], cross.rest[k],
                                         stiffness);
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
    state.shown.assign(model.coats.size(), ShownVertex{});
    for (const DeformNode& node : model.nodes) place(state.shown[node.vertex], restOf(node));
    drape(model, state);
}

void recede(const DeformModel& model, const gpu::DeformObject& object,
            std::span<const uint32_t> states, uint32_t now, DeformState& state) {
    for (const DeformNode& node : model.nodes) {
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

void drape(const DeformModel& model, DeformState& state, bool tears) {
    for (size_t i = 0; i < model.coats.size(); ++i) {
        const gpu::DeformCoat& coat = model.coats[i];
        const ShownVertex& node = state.shown[coat.node];
        const vec3 at = placeOf(node);
        vec3 turned(0), before(0);
        float square = 0;
        for (const uint32_t neighbour : coat.ring) {
            const vec3 arm = placeOf(state.shown[neighbour]) - at;
            turned += gpu::cross(before, arm);
            before = arm;
            square = std::max(square, gpu::dot(arm, arm));
        }
        const float size = gpu::length(turned);
        const vec3 rest = gpu::unpackDirection(coat.normal);
        vec3 normal = rest;
        if (size > 1e-18f)
            normal =
                gpu::turnedNormal(rest, vec3(coat.faceX, coat.faceY, coat.faceZ), turned / size);
        ShownVertex& shown = state.shown[i];
        shown.normal = normal == rest ? coat.normal : gpu::packDirection(normal);
        shown.lead = node.behind;
        if (tears)
            shown.lead = std::max(shown.lead, gpu::tornLead(square, coat.longest, node.burnt));
        shown.burnt = node.burnt;
        place(shown, at);
    }
}

}  // namespace fw::mesh
