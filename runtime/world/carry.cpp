// A burn that goes on on another object: what each of its texels gets is found here, once; the step
// that begins next copies it, on whatever backend.
#include "core/reserved.h"
#include "mesh/bake.h"
#include "world/burn_system.h"
#include "world/recording.h"

#include <algorithm>
#include <cmath>

namespace fw::world {
namespace {

constexpr float kReachOfBox = 0.05f, kReachOfTexel = 2;  // of its diagonal, and of a texel's side

uint32_t endOfStep(uint32_t tick) noexcept {
    return (tick / gpu::kStepTicks + 1) * gpu::kStepTicks;
}

}  // namespace

void BurnSystem::transferBurn(FwBurnableMeshId fromId, FwBurnableMeshId toId) {
    context_.recorder.mayChange();
    Object &from = *scene_.objects.get(fromId), &to = *scene_.objects.get(toId);
    if (&from == &to) core::refuse("Burnable mesh %u gives its burn to itself.", fromId.index1);
    if ((from.data.flags | to.data.flags) & core::reserved::kBurning)
        core::refuse("Burnable mesh %u or %u burns by an extension; such burns are not carried.",
                     fromId.index1, toId.index1);
    if (components::hasHeat(from.data) != components::hasHeat(to.data))
        core::refuse("Burnable mesh %u %s FW_BURNABLE_LITE and %u %s; both have it or neither.",
                     fromId.index1, components::hasHeat(from.data) ? "lacks" : "has", toId.index1,
                     components::hasHeat(to.data) ? "lacks" : "has");
    for (const Object* one : {&from, &to}) {
        if (one->play.burn1 != 0)
            core::refuse("Burnable mesh %u plays a baked burn; fwWorld_StopBurn makes it live.",
                         one->id.index1);
        if (one->carryEnd > context_.clock.tick)
            core::refuse("Burnable mesh %u is part of another transfer until the next step.",
                         one->id.index1);
    }
    const mesh::BurnDomain &source = scene_.domainOf(from), &target = scene_.domainOf(to);
    float diagonal = 0;
    for (int i = 0; i < 3; ++i) {
        const float side = target.boundsHigh[i] - target.boundsLow[i];
        diagonal += side * side;
    }
    const float reach = kReachOfBox * std::sqrt(diagonal) +
                        kReachOfTexel * std::max(source.texelSide, target.texelSide);
    std::pmr::vector<uint32_t> match(context_.memory);
    const uint32_t matched = mesh::matchTexels(source, target, reach, match);
    if (matched * 2 < target.report.realTexels)
        core::failData(
            "%u of %u texels of burnable mesh %u have one of %u within %g m; at least half "
            "of them must. The meshes are of one shape.",
            matched, target.report.realTexels, toId.index1, fromId.index1, double(reach));
    reservePending(matched);
    const auto now = uint32_t(context_.clock.tick);
    const uint32_t kind = gpu::kEventCarry | (from.slot + 1) << gpu::kEventKindBits;
    for (uint32_t i = 0; i < match.size(); ++i)
        if (match[i] != mesh::kNone)
            state_.pending.push_back({to.slot, i, kind, now, match[i], state_.order++});
    to.firstEvent = std::min(to.firstEvent, now);
    from.carryEnd = to.carryEnd = endOfStep(now);
    state_.carriesUntil = std::max<uint64_t>(state_.carriesUntil, to.carryEnd);
    context_.recorder.record(TransferBurn{to.slot, from.slot});
}

// With the readback of the frame that carried it: its fire is the other's, its own counts stay.
void BurnSystem::continueBurn(Object& to, const BurnLifecycle& from) noexcept {
    BurnLifecycle& lifecycle = to.lifecycle;
    const BurnLifecycle before = lifecycle;
    lifecycle = from;
    lifecycle.maxIgnited = before.maxIgnited;
    lifecycle.clampsReported = before.clampsReported;
    lifecycle.spotsReported = before.spotsReported;
    lifecycle.energy = before.energy;
    lifecycle.heatSteps = before.heatSteps;
    lifecycle.flames = lifecycle.wentOut = 0;
    to.carried = true;
}

void BurnSystem::checkGone(const Object& object) const {
    if (context_.clock.tick < state_.carriesUntil &&
        std::ranges::any_of(state_.pending, [&](const PendingTexel& event) {
            return isCarry(event) && carriedFrom(event) == object.slot;
        }))
        core::refuse(
            "Burnable mesh %u gives its burn to another one with the next step; destroy it after "
            "that.",
            object.id.index1);
}

void BurnSystem::keepGiven(const Object& from) {
    for (Stimulus& one : state_.stimuli)
        if (one.from1 == from.slot + 1)
            one.given = core::Owned<BurnLifecycle>::make(context_.memory, from.lifecycle);
}

// Of a save. Throws FW_ERROR_BAD_DATA.
void BurnSystem::checkCarry(const PendingTexel& event, const Clock& clock) {
    const uint32_t slot = carriedFrom(event);
    const auto* owned = scene_.objects.findSlot(slot);
    const Object& to = scene_.objectAt(event.object);
    if (!owned || slot == event.object || event.tick > clock.tick ||
        event.water >= scene_.domainOf(**owned).texelCount() ||
        !scene_.domainOf(**owned).real(event.water) ||
        (((*owned)->data.flags | to.data.flags) & core::reserved::kBurning) != 0 ||
        components::hasHeat((*owned)->data) != components::hasHeat(to.data))
        core::failData(
            "The save carries the burn of burnable mesh %u, texel %u, to burnable mesh %u at "
            "tick %u, and is of tick %llu. That cannot be.",
            slot + 1, event.water, event.object + 1, event.tick,
            static_cast<unsigned long long>(clock.tick));
}

// Within a step no other event may be of a texel that is copied, nor pass through one as a hole.
void BurnSystem::waitForTransfers() noexcept {
    if (context_.clock.tick >= state_.carriesUntil) return;
    for (PendingTexel& event : state_.pending) {
        if (isCarry(event)) continue;
        const auto waitFor = [&](uint32_t slot) {
            if (const auto* object = scene_.objects.at(slot))
                event.tick = std::max(event.tick, (*object)->carryEnd);
        };
        waitFor(event.object);
        for (uint32_t k = 0; k < event.gateCount; ++k) waitFor(event.gates[k].object);
    }
}

void BurnSystem::settlePending() noexcept {
    state_.carriesUntil = state_.wetUntil = 0;
    for (const PendingTexel& event : state_.pending) {
        if (event.kind == FW_WET)
            state_.wetUntil =
                std::max<uint64_t>(state_.wetUntil, event.tick + uint64_t(gpu::kStepTicks));
        if (isCarry(event))
            for (const uint32_t slot : {event.object, carriedFrom(event)}) {
                scene_.objectAt(slot).carryEnd = endOfStep(event.tick);
                state_.carriesUntil =
                    std::max<uint64_t>(state_.carriesUntil, endOfStep(event.tick));
            }
    }
}

}  // namespace fw::world
