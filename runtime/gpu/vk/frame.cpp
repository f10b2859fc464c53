#include "gpu/vk/frame.h"

#include "gpu/extension.h"
#include "gpu/vk/backend_state.h"
#include "shared/exchange.h"

#include <algorithm>

namespace fw::gpu::vk {
namespace {

constexpr uint64_t kRowBytes = sizeof(IterationCounters);
constexpr uint64_t kListPart = offsetof(IterationCounters, listX);

void zeroRow(FrameRecorder& r, uint32_t row) {
    r.fillZero(FW_BIND_COUNTERS, row * kRowBytes, kRowBytes);
}

// The plain passes of a part of the frame.
void beginPart(FrameRecorder& r, FramePart part) {
    const std::span<const ComputePass> passes = computePasses();
    for (uint32_t i = 0; i < passes.size(); ++i)
        if (passes[i].begins == part) r.dispatch(ComputePassOf<NoPush>{i}, NoPush{}, 1);
}

template <class Push>
void setLists(const FrameLists& lists, Push& push) noexcept {
    push.row = lists.row;
    push.parity = lists.parity;
    push.burnParity = lists.burnParity;
    push.predictParity = lists.predictParity;
    push.hotParity = lists.hotParity;
}

StepPush pushOf(const FrameLists& lists, const StepRecord& step) {
    StepPush push{};
    setLists(lists, push);
    push.now = step.now;
    push.stepShift = step.substepShift;
    push.switches = step.switches | (step.governed ? kSwitchGoverned : 0u) |
                    (step.capped ? kSwitchCapped : 0u) | (step.plays ? kSwitchPlayback : 0u);
    push.maxTiles = step.rules.maxTiles;
    return push;
}

StepPush pushOf(const TileShare& share) {
    StepPush push{};
    push.count = share.ticks;
    push.object = share.first;
    push.iteration = share.count;
    return push;
}

// Records `light`, passes that light texels. Where the number of burning tiles is limited they run
// first to request tiles (kSwitchRequests in `switches`), `burn_budget` allots them, then they
// light.
template <class Grant, class Light>
void recordLighting(bool capped, uint32_t& switches, const Grant& allotBudget, const Light& light) {
    if (capped) {
        switches |= kSwitchRequests;
        light();
        switches &= ~kSwitchRequests;
        allotBudget();
    }
    light();
}

// Calls `record(first, rows)` for runs of the list of events in which each first one concerns all
// texels of an object, with few events of single texels between two of those.
template <class Record>
void forWholeObjects(const StepRecord& step, const Record& record) {
    constexpr uint32_t kMostBetween = 16;
    const auto count = uint32_t(step.allTiles != 0 ? step.events.size() : 0);
    for (uint32_t first = 0, end = 0; first < count; first = end) {
        end = first + 1;
        if (!addressesAll(step.events[first])) continue;
        for (uint32_t i = end; i < count && i <= end + kMostBetween && i - first < kMaxGroups; ++i)
            if (addressesAll(step.events[i])) end = i + 1;
        record(first, end - first);
    }
}

void recordExchange(FrameRecorder& r, const FrameLists& lists, const StepRecord& step,
                    const StepPush& budgetPush);

}  // namespace

bool addressesAll(const TexelEvent& event) noexcept {
    const uint32_t kind = eventKind(event.kind);
    return event.texel == kNoneTexel && kind != kEventGate && kind != kEventPlaybackSpan;
}

// --- Changes since the last frame ---

void recordReset(FrameRecorder& r, uint32_t object, uint32_t tiles) {
    StepPush push{};
    push.object = object;
    r.fillZero(FW_BIND_OBJECT_COUNTERS, object * sizeof(ObjectCounters), sizeof(ObjectCounters));
    r.dispatch(pass::reset, push, tiles);
}

void recordRestore(FrameRecorder& r, const FrameLists& lists, uint32_t object, uint32_t tiles) {
    StepPush push{};
    setLists(lists, push);
    push.object = object;
    r.dispatchItems(pass::restore, push, tiles);
}

void recordFields(FrameRecorder& r, const FieldsRecord& fields) {
    if (fields.runs.count == 0) return;
    r.copyIn(fields.runs, FW_BIND_FIELD_RUNS);
    FieldPush push{};
    if (fields.masked) r.dispatch(pass::field_mask, push, fields.masked);
    push.first = fields.masked;
    for (uint32_t i = 0; i < fields.rounds; ++i) {
        if (fields.groups[i] > 0) r.dispatch(pass::field, push, fields.groups[i]);
        push.first += fields.groups[i] * kFieldUnits;
    }
}

void recordSkin(FrameRecorder& r, const SkinPush& push) {
    r.dispatchItems(pass::skin, push, push.count);
}

// --- Simulation ---

void recordCounters(FrameRecorder& r, FrameLists& lists, uint32_t iterations) {
    if (lists.row != kRowIteration)
        r.copyBetween({FW_BIND_COUNTERS, lists.row * kRowBytes + kListPart},
                      {FW_BIND_COUNTERS, kRowIteration * kRowBytes + kListPart},
                      kRowBytes - kListPart);
    r.fillZero(FW_BIND_COUNTERS, kRowIteration * kRowBytes, kListPart);
    if (iterations)
        r.fillZero(FW_BIND_COUNTERS, (kRowIteration + 1) * kRowBytes, iterations * kRowBytes);
    lists.row = kRowIteration;
}

void recordSimulation(FrameRecorder& r, FrameLists& lists, const StepRecord& step) {
    beginPart(r, FramePart::simulation);
    const bool dense = (step.switches & kSwitchDense) != 0;
    StepPush push = pushOf(lists, step);
    const auto allotBudget = [&] { r.dispatch(pass::burn_budget, push, 1); };
    const auto lighting = [&](const auto& light) {
        recordLighting(step.capped, push.switches, allotBudget, light);
    };
    if (step.wakeGroups.count) {
        r.copyIn(step.wakeGroups, FW_BIND_WAKE_GROUPS);
        push.count = step.wakeGroups.count;
        if (!dense) r.dispatch(pass::wake, push, push.count);
    }
    if (step.staged.count) {
        r.copyIn(step.staged, FW_BIND_EVENTS);
        push.count = step.staged.count;
        lighting([&] {
            r.dispatchItems(pass::events, push, push.count);
            forWholeObjects(step, [&](uint32_t first, uint32_t rows) {
                push.object = first;
                r.dispatch(pass::events_all, push, step.allTiles, rows);
            });
        });
    }
    if (step.rooms) {
        push = pushOf(lists, step);
        push.count = step.objectSlots;
        r.dispatch(pass::rooms, push, 1);
    }
    if (step.heat) {
        push = pushOf(lists, step);
        zeroRow(r, kRowHot + (lists.hotParity ^ 1));
        lighting(
            [&] { r.dispatchRow(pass::heat, push, kRowHot + lists.hotParity, RowPart::list); });
        lists.hotParity ^= 1;
    }
    for (uint32_t k = 0; step.iterate && k < 1u << step.substepShift; ++k) {
        push = pushOf(lists, step);
        push.iteration = k;
        push.count = step.wakeGroups.count;
        if (dense) r.dispatch(pass::schedule, push, std::max(push.count, 1u));
        if (!dense) r.dispatchRow(pass::schedule, push, lists.row, RowPart::list);
        r.dispatchRow(pass::gather, push, lists.row, RowPart::run);
        r.dispatchRow(pass::arrival, push, lists.row, RowPart::work);
        r.dispatchRow(pass::arrival_rim, push, lists.row, RowPart::rim);
        if (step.capped) {
            push.switches |= kSwitchRequests;
            allotBudget();
            push.switches &= ~kSwitchRequests;
        }
        r.dispatchRow(pass::commit, push, lists.row, RowPart::work);
        lists.row += 1;
        lists.parity ^= 1;
    }
    push = pushOf(lists, step);
    if (!step.extended.empty())
        lighting([&] {
            for (const ExtendedStep& object : step.extended) {
                push.object = object.object;
                push.extensionParity = object.parity;
                r.dispatch(extension()->stepPass, push, object.groups);
            }
        });
    if (!step.reduce) return;
    push = pushOf(lists, step);
    push.now = step.now + kStepTicks;
    push.count = step.objectSlots;
    zeroRow(r, kRowBurn + (lists.burnParity ^ 1));
    r.dispatchItems(pass::reduce_clear, push, push.count);
    r.dispatchRow(pass::reduce_front, push, lists.row, RowPart::list);
    r.dispatchRow(pass::reduce, push, kRowBurn + lists.burnParity, RowPart::list);
    lists.burnParity ^= 1;
    if (!step.exchange) return;
    push = pushOf(lists, step);
    push.now = step.now + kStepTicks;
    recordExchange(r, lists, step, push);
}

namespace {

// Heat from object to object. `budgetPush`: the push of pass burn_budget.
void recordExchange(FrameRecorder& r, const FrameLists& lists, const StepRecord& step,
                    const StepPush& budgetPush) {
    ExchangePush push = step.rules;
    push.now = budgetPush.now;
    setLists(lists, push);
    push.switches = budgetPush.switches;
    push.count = step.objectSlots;
    zeroRow(r, kRowExchange);
    r.dispatchRow(pass::fire_cells, push, kRowBurn + lists.burnParity, RowPart::run);
    r.dispatchItems(pass::fire_sources, push, push.count);
    if (push.warms != 0) {
        r.dispatchItems(pass::receivers, push, push.count);
        if (push.occlusionCell == 0)
            r.dispatchRow(pass::exchange, push, kRowExchange, RowPart::run);
        if (push.occlusionCell != 0)
            r.dispatchRow(pass::exchange_occlusion, push, kRowExchange, RowPart::run);
    }
    const bool touches = (push.flags & kExchangeContact) && step.links;
    const bool parts = (push.flags & kExchangeContact) && step.parts;
    const bool throws = (push.flags & kExchangeEmbers) != 0;
    if (throws) r.dispatchItems(pass::ember_paths, push, push.count);
    if (!touches && !parts && !throws) return;
    const auto allot = [&] { r.dispatch(pass::burn_budget, budgetPush, 1); };
    recordLighting(step.capped, push.switches, allot, [&] {
        push.count = step.links;
        if (touches) r.dispatchItems(pass::contacts, push, step.links);
        push.count = step.objectSlots;
        if (parts) r.dispatchRow(pass::parts, push, kRowBurn + lists.burnParity, RowPart::run);
        if (throws) r.dispatchItems(pass::embers, push, push.count);
    });
}

}  // namespace

void recordShownTiles(FrameRecorder& r, const FrameLists& lists, uint32_t tick) {
    const uint32_t row = kRowBurn + lists.burnParity;
    r.fillZero(FW_BIND_COUNTERS, row * kRowBytes + offsetof(IterationCounters, runX),
               4 * sizeof(uint32_t));
    StepPush push{};
    push.burnParity = lists.burnParity;
    push.now = tick;
    push.switches = kSwitchDisplayOnly;
    r.dispatchRow(pass::reduce, push, row, RowPart::list);
}

// --- Prediction: arrival ahead of the front, and which burnt pieces fall. Cosmetic. ---

void recordPredictRestart(FrameRecorder& r, const FrameLists& lists, uint32_t object,
                          uint32_t tiles) {
    StepPush push{};
    push.object = object;
    push.predictParity = lists.predictParity;
    r.dispatchItems(pass::predict_restart, push, tiles);
}

void recordPrediction(FrameRecorder& r, FrameLists& lists, uint32_t endTick, bool seen) {
    beginPart(r, FramePart::prediction);
    StepPush push{};
    push.now = endTick;
    push.predictParity = lists.predictParity;
    zeroRow(r, kRowPredict + (lists.predictParity ^ 1));
    const uint32_t row = kRowPredict + lists.predictParity;
    r.dispatchRow(pass::predict_states, push, row, RowPart::list);
    r.dispatchRow(pass::predict_gather, push, row, RowPart::list);
    if (seen) {
        r.dispatchRow(pass::predict, push, row, RowPart::work);
        r.dispatchRow(pass::predict_rim, push, row, RowPart::rim);
        for (push.iteration = 0; push.iteration < 2; ++push.iteration)
            r.dispatchRow(pass::predict_commit, push, row, RowPart::work);
    }
    lists.predictParity ^= 1;
}

void recordSupport(FrameRecorder& r, uint32_t endTick, const TileShare& share) {
    StepPush push = pushOf(share);
    push.now = endTick;
    for (push.row = 0; push.row < 2; ++push.row) r.dispatchItems(pass::support, push, share.count);
}

// --- Deformation ---

void recordDeformation(FrameRecorder& r, const DeformRecord& deform) {
    if (deform.groups.count == 0) return;
    beginPart(r, FramePart::deformation);
    r.copyIn(deform.groups, FW_BIND_DEFORM_GROUPS);
    const auto dispatch = [&](ComputePassOf<DeformPush> pass, uint32_t first, uint32_t groups,
                              uint32_t parity) {
        DeformPush push = deform.push;
        push.parity = parity;
        for (uint32_t done = 0; done < groups; done += kMaxGroups) {
            push.first = first + done;
            r.dispatch(pass, push, groups - done);
        }
    };
    const uint32_t sheets = deform.count.nodes, extended = sheets + deform.count.sheets;
    dispatch(pass::recede, 0, deform.count.nodes, deform.steps << 1);
    // A sheet that did not move in the frame before knows of no link yet.
    if (deform.begins && !(deform.steps > 0 && updatesLinkCache(deform.bendSet)))
        dispatch(pass::link_cache, sheets, deform.count.sheets, 0);
    for (uint32_t i = 0; i < deform.steps; ++i) {
        const uint32_t bendSet = (deform.bendSet + i) % kBendSets;
        if (updatesLinkCache(bendSet))
            dispatch(pass::link_cache, sheets, deform.count.sheets, i & 1);
        dispatch(pass::soft, sheets, deform.count.sheets, (i & 1) | bendSet << 1);
        if (deform.count.extended)
            dispatch(extension()->deformPass, extended, deform.count.extended, i & 1);
    }
    const uint32_t vertices = extended + deform.count.extended;
    dispatch(pass::skin_to_mesh, vertices, deform.count.vertices, 0);
    dispatch(pass::inner, vertices + deform.count.vertices, deform.count.inner, 0);
}

void recordProbes(FrameRecorder& r, const Staged& probes) {
    if (probes.count == 0) return;
    StepPush push{};
    push.count = probes.count;
    r.copyIn(probes, FW_BIND_PROBES);
    r.dispatchItems(pass::probe, push, probes.count);
}

// --- Effects ---

namespace {

// Zeroes the words that the march of `march` accumulates into.
void clearMarch(FrameRecorder& r, const MarchRecord& march) {
    if (march.end > march.first)
        r.fillZero(FW_BIND_VOLUME_RAYS, uint64_t(march.first) * 4,
                   uint64_t(march.end - march.first) * 4);
    // Cells of impostors that no tile has are read too.
    for (const MarchedVolume& one : march.volumes.last(march.impostors))
        r.fillZero(FW_BIND_VOLUME_RAYS, uint64_t(one.march.tiles) * 4,
                   uint64_t(kImpostorWords) * 4);
    uint32_t last = 0;
    for (const MarchedVolume& one : march.volumes) last = std::max(last, one.march.flame);
    r.fillZero(FW_BIND_VOLUME_WORK, 0, (last + 1) * sizeof(VolumeWork));
}

// The burning objects whose flames are one body, and what burns in their cells.
void recordBodies(BackendState& s, FrameRecorder& r, StepPush push) {
    r.fillZero(FW_BIND_BODY_OF, 0, uint64_t(s.buffers.capacity(kPoolObjects)) * 4);
    if (s.flames.bodyCount == 0) return;
    push.count = s.flames.bodyCount;
    r.fillZero(FW_BIND_BODY_CELLS, 0,
               uint64_t(s.flames.bodyCount) * kBodyCells * kBodyCellWords * 4);
    r.dispatchItems(pass::body_numbers, push, push.count);
    r.dispatch(pass::body_cells, push, 16);
}

}  // namespace

void recordEffects(BackendState& s, FrameInFlight& slot) {
    const std::span<OutsideView* const> from = s.seenFrom();
    const bool looked = !from.empty(), emits = s.particles.shows(), burns = !s.simulation.burnEmpty;
    const bool fieldsShow = looked && !s.particleFields.fieldDraws.empty(),
               marches = looked && !s.flames.volumes.empty();
    if ((!burns && !marches && !emits && !fieldsShow) || !s.scene.appearanceTextures.live) return;
    const VkViewport whole{0, 0, 1, 1, 0, 1};
    // A step of an own device has no view: lights alone, which flicker with simulated time.
    FwView none{};
    none.time = float(double(s.open.endTick) / kTicksPerSecond);
    const uint32_t firstOffset = s.pushView(slot, looked ? from[0]->view : none, whole);
    FrameRecorder r(s, slot, 0, firstOffset);
    beginPart(r, FramePart::effects);
    StepPush push{};
    push.now = s.open.endTick;
    push.burnParity = s.simulation.lists.burnParity;
    if (burns && looked) recordBodies(s, r, push);
    if (burns) r.dispatch(pass::lights, push, 1);
    const TileShare soot =
        burns ? s.simulation.sootShare(s.buffers.capacity(kPoolObjectTiles), s.open.endTick, looked)
              : TileShare{};
    if (soot.count > 0) r.dispatch(pass::soot, pushOf(soot), (soot.count + 7) / 8);
    const SortPush room = s.particles.quadRoom(s);
    ParticlePush moving{};
    moving.quads = room.particles;
    moving.firstQuad = room.tiles;
    moving.lights = room.lights;
    moving.burnRow = burns ? kRowBurn + s.simulation.lists.burnParity : kNoBurnRow;
    moving.moved = vec4(s.particles.particlesMove, 0.0f);
    if (emits && s.particles.emittersMove && s.particles.emitterGroups > 0) {
        r.dispatch(pass::particles, moving, s.particles.emitterGroups);
        s.particles.particlesMove = vec3(0.0f);
    }
    push.count = s.scene.flipbooks.live ? s.particles.flameFlipbooks : 0;
    const SparkPush sparks{room.lights, room.tiles + room.particles, moving.burnRow, 0};
    for (OutsideView* const of : from) {
        FrameRecorder view(s, slot, of->number,
                           of == from[0] ? firstOffset : s.pushView(slot, of->view, whole));
        // The lights begin the first view's quads.
        if ((emits && !burns) || (burns && of->number != 0))
            view.fillZero(FW_BIND_DRAW_ARGS, 0, kFlameOrder * 4);
        const MarchRecord march = marches ? s.flames.march(s, *of) : MarchRecord{};
        const bool bodies = !march.volumes.empty() && slot.frameIndex >= s.flames.quadsUntil;
        push.switches = bodies ? kSwitchBodies : 0u;
        if (burns) view.dispatch(pass::flame_quads, push, 16);
        if (s.particles.emitterGroups > 0)
            view.dispatch(pass::particle_quads, moving, s.particles.emitterGroups);
        if (s.particles.sparkSources > 0)
            view.dispatch(pass::sparks, sparks, s.particles.sparkSources * kSparkGroups);
        if (burns || emits) view.dispatch(pass::flame_sort, room, 1);
        if (!march.volumes.empty()) {
            clearMarch(view, march);
            view.dispatchVolumes(pass::volume_probe, march.volumes, VolumesOf::all);
            view.dispatchVolumes(pass::volume_march, march.volumes, VolumesOf::clear);
            view.dispatchVolumes(pass::volume_smoke, march.volumes, VolumesOf::smoke);
            view.dispatchVolumes(pass::body_flames, march.volumes, VolumesOf::bodyFlames);
            view.dispatchVolumes(pass::body_tiles, march.volumes, VolumesOf::bodyTiles);
            view.dispatchVolumes(pass::body_field, march.volumes, VolumesOf::bodies);
            view.dispatchVolumes(pass::body_march, march.volumes, VolumesOf::bodies);
        }
    }
    if (fieldsShow)
        r.dispatch(pass::field_show, NoPush{},
                   uint32_t(s.particleFields.fieldDraws.size()) * kFieldShowGroups);
}

// --- Refinement ---

namespace {

// Heat to levels, levels to triangles; moving vertices are listed to be placed.
void recordLevels(FrameRecorder& r, const FrameLists& lists, const RefineRecord& refine) {
    RefinePush push = refine.push;
    push.row = lists.row;
    push.parity = lists.parity;
    r.dispatchRow(pass::refine_heat, push, lists.row, RowPart::list);
    push.row = kRowBurn + lists.burnParity;
    push.parity = 2 + lists.burnParity;
    r.dispatchRow(pass::refine_heat, push, push.row, RowPart::list);
    push.parity = kRefineFreshHeat;
    if (refine.fresh) r.dispatch(pass::refine_heat, push, push.objects);
    const uint32_t items = push.edgeGroups + push.triangleGroups, triangles = push.triangleGroups;
    const uint32_t groups[5] = {items, push.budget ? triangles : 0, push.budget ? 1u : 0, items,
                                triangles};
    for (push.phase = 0; push.phase < 5; ++push.phase)
        if (groups[push.phase]) r.dispatch(pass::refine_levels, push, groups[push.phase]);
    r.dispatch(pass::refine_scan, push, push.objects);
    r.dispatchIndirect(pass::refine_emit, push, FW_BIND_REFINE_WORK, kRefineWorkEmit * 4);
}

}  // namespace

void recordRefinement(FrameRecorder& r, const FrameLists& lists, const RefineRecord& refine) {
    beginPart(r, FramePart::refinement);
    if (refine.turn) recordLevels(r, lists, refine);
    RefinePush push = refine.push;
    push.phase = 0;
    r.dispatch(pass::refine_place, push, push.cornerGroups);
    for (const uint32_t list : {kRefineWorkEdges, kRefineWorkPlace, kRefineWorkMorph}) {
        ++push.phase;
        r.dispatchIndirect(pass::refine_place, push, FW_BIND_REFINE_WORK, list * 4);
    }
    if (!refine.turn || !refine.cuts) return;
    push.phase = 0;
    r.dispatch(pass::refine_cut, push, push.triangleGroups);
    push.phase = 1;
    r.dispatchIndirect(pass::refine_cut, push, FW_BIND_REFINE_WORK, kRefineWorkCut * 4);
    push.phase = 2;
    r.dispatchItems(pass::refine_cut, push, push.objects * kMaterialsPerObject);
}

}  // namespace fw::gpu::vk
