// The outside part of a frame: what waits is uploaded, the plan's steps are recorded, and the
// readback is copied. Everything that can fail comes before the first command: vk_needs.cpp.
#include "core/error.h"
#include "flamewright/flamewright_debug.h"
#include "gpu/vk/frame_needs.h"
#include "shared/spark.h"

#include <algorithm>
#include <cmath>

namespace fw::gpu::vk {
namespace {

constexpr float kQuadsTurn = 1.0f / 32;  // a frame: none comes or goes at once
constexpr float kLightsTurn = 1.0f / 16;

void recordImageUpload(const Table& vk, VkCommandBuffer commands, const PendingUpload& upload) {
    auto barrier = typed<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
    barrier.srcAccessMask = barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = upload.image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, upload.mips, upload.firstLayer,
                                upload.layers};
    // Draws of earlier frames may still look at a layer that gets other texels.
    vk.CmdPipelineBarrier(commands,
                          VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT |
                              VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                          VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr, 1, &barrier);
    uint64_t at = 0;
    for (uint32_t layer = 0; layer < upload.layers; ++layer) {
        for (uint32_t mip = 0; mip < upload.mips; ++mip) {
            VkBufferImageCopy region{};
            region.bufferOffset = at;
            region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip, upload.firstLayer + layer,
                                       1};
            region.imageExtent = {std::max(upload.width >> mip, 1u),
                                  std::max(upload.height >> mip, 1u), 1};
            vk.CmdCopyBufferToImage(commands, upload.staging.handle, upload.image,
                                    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
            at += uint64_t(region.imageExtent.width) * region.imageExtent.height * 4;
        }
    }
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
    barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    vk.CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                          VK_PIPELINE_STAGE_VERTEX_SHADER_BIT |
                              VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT |
                              VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                          0, 0, nullptr, 0, nullptr, 1, &barrier);
}

// Meshes, images, painted maps: what was created since the last frame.
void recordUploads(VkBackend::State& s) {
    const Table& vk = s.device.table;
    for (PendingUpload& upload : s.scene.uploads) {
        if (upload.image) recordImageUpload(vk, s.open.commands, upload);
        recordRegions(vk, s, upload);
        s.retired.push(s.open.ringFrame, upload.staging);
    }
    s.scene.uploads.clear();
}

bool looksBurnt(const ObjectEntry& object) noexcept {
    return (object.burn.touched || object.burn.warmed) &&
           (object.record.flags & kObjectNoDamage) == 0;
}

// Before anything reached it nothing of it can have crossed.
bool zPassed(const ObjectEntry& object) noexcept {
    return looksBurnt(object) && (object.record.flags & kObjectZPass) != 0;
}

// How `item`'s material is drawn: whether fire may show on it, and its triangles far from fire
// apart.
void chooseSurface(const VkBackend::State& s, const ObjectEntry& object, DrawItem& item) {
    item.family = familyOf(object.materials[item.material].look);
    item.burns = looksBurnt(object);
    item.selfIntersects = zPassed(object);
    item.coldReach = coldReach(s.scene.meshes[object.mesh].texelEdge);
    const bool tells =
        (object.record.flags & kObjectPublished) == 0 && item.coldReach <= kColdReach;
    item.coldApart = item.burns && tells && !object.burn.charred && !item.selfIntersects;
}

SurfaceDraw drawOf(const VkBackend::State& s, const ObjectEntry& object, uint32_t material) {
    const vec4 row = object.record.worldRow0;
    const float scale = std::sqrt(row.x * row.x + row.y * row.y + row.z * row.z);
    const MeshEntry& mesh = s.scene.meshes[object.mesh];
    SurfaceDraw draw = surfaceDraw(object.record, object.materials[material], object.heat[material],
                                   mesh.edge * scale, object.refine.slots.first, object.burn.doused,
                                   object.burn.warmed);
    return draw;
}

// They are listed object by object.
std::span<DrawItem> drawItemsOf(VkBackend::State& s, uint32_t object) noexcept {
    const auto first =
        std::lower_bound(s.surfaces.drawItems.begin(), s.surfaces.drawItems.end(), object,
                         [](const DrawItem& item, uint32_t slot) { return item.object < slot; });
    auto end = first;
    while (end != s.surfaces.drawItems.end() && end->object == object) ++end;
    return {first, end};
}

// Records of objects that are new, moved or gone, and the list of what draws show.
void recordObjects(VkBackend::State& s, FrameRecorder& recorder, UploadWriter& writer) {
    for (const uint32_t i : s.scene.awake) {
        ObjectEntry& object = s.scene.objects[i];
        if (object.resetDue ||
            (object.recordDirty && !object.live))  // until it is placed others do not see it
            recorder.fillZero(FW_BIND_EXCHANGE_OBJECTS, i * sizeof(ExchangeObject),
                              sizeof(ExchangeObject));
        if (object.recordDirty) {
            const Staged staged = writer.write(std::span<const BurnObject>(&object.record, 1));
            recorder.copyIn(staged.at, FW_BIND_OBJECTS, uint64_t(i) * sizeof(BurnObject),
                            sizeof(BurnObject));
        }
        if (object.materialsDirty) {
            const Staged staged = writer.write(std::span<const BurnMaterial>(object.materials));
            recorder.copyIn(staged.at, FW_BIND_MATERIALS, i * sizeof object.materials,
                            sizeof object.materials);
            if (object.record.flags & kObjectHeat) {
                const Staged heat = writer.write(std::span<const HeatMaterial>(object.heat));
                recorder.copyIn(heat.at, FW_BIND_HEAT_MATERIALS, i * sizeof object.heat,
                                sizeof object.heat);
            }
        }
        if (object.deforms.recordDirty) {
            const Staged staged = writer.write(std::span<const DeformObject>(&object.deform, 1));
            recorder.copyIn(staged.at, FW_BIND_DEFORM_OBJECTS,
                            uint64_t(object.deforms.range.first) * sizeof(DeformObject),
                            sizeof(DeformObject));
        }
        object.recordDirty = object.materialsDirty = object.deforms.recordDirty = false;
    }
    s.surfaces.drawItems.clear();
    s.surfaces.surfacesDirty = true;
    for (uint32_t i = 0; i < s.scene.objects.size(); ++i) {
        ObjectEntry& object = s.scene.objects[i];
        if (object.resetDue) {
            recordReset(recorder, i, object.record.tileCount);
            recorder.fillZero(FW_BIND_SOURCES, object.sources.first * sizeof(FireSource),
                              object.sources.units * sizeof(FireSource));
        }
        object.resetDue = false;
        if (!object.live || (object.record.flags & kObjectHidden)) continue;
        const MeshEntry& mesh = s.scene.meshes[object.mesh];
        uint32_t first = 0;
        for (uint32_t m = 0; m < kMaterialsPerObject; ++m) {
            const uint32_t end = mesh.materialEnd[m];
            if (end != first) {
                DrawItem item{};
                item.object = i;
                item.material = m;
                item.firstIndex = mesh.indexRange.first + first;
                item.indexCount = end - first;
                item.vertexOffset = int32_t(mesh.vertexRange.first);
                item.shown = object.shown.units ? object.shown.first : kNoneTexel;
                item.insideShown = object.inner && object.shown.units;
                if (object.inner)
                    item.inside = item.insideShown ? object.shown.first + mesh.vertices
                                                   : mesh.innerVertices.first;
                item.image = object.images[m];
                chooseSurface(s, object, item);
                item.inner = object.refine.inner;
                item.draw = drawOf(s, object, m);
                showRefined(object.refine, item);
                s.surfaces.drawItems.push_back(item);
            }
            first = end;
        }
    }
    s.scene.recordsDirty = false;
}

void recordForgetting(VkBackend::State& s, FrameRecorder& recorder) {
    for (const uint32_t i : s.scene.awake) {
        ObjectEntry& object = s.scene.objects[i];
        if (!object.burn.forget) continue;
        recorder.copyBetween(FW_BIND_STATE, FW_BIND_PREDICT, uint64_t(object.record.stateBase) * 4,
                             uint64_t(object.record.width) * object.record.height * 4);
        object.burn.lastDouse = 0;
    }
}

// New records of a step's latches.
void recordMaterials(VkBackend::State& s, std::span<const MaterialUpdate> updates,
                     FrameRecorder& recorder, UploadWriter& writer) {
    for (const MaterialUpdate& update : updates) {
        ObjectEntry& object = s.scene.objects[update.object];
        std::copy(std::begin(update.materials), std::end(update.materials),
                  std::begin(object.materials));
        object.record.window = update.window;
        object.record.substepShift = update.substepShift;
        for (DrawItem& item : drawItemsOf(s, update.object))
            item.draw = drawOf(s, object, item.material);
        const Staged materials = writer.write(std::span<const BurnMaterial>(object.materials));
        recorder.copyIn(materials.at, FW_BIND_MATERIALS,
                        uint64_t(update.object) * sizeof object.materials, sizeof object.materials);
        const uint32_t timing[2] = {update.window, update.substepShift};
        static_assert(offsetof(BurnObject, substepShift) == offsetof(BurnObject, window) + 4);
        const Staged staged = writer.write(std::span<const uint32_t>(timing));
        recorder.copyIn(staged.at, FW_BIND_OBJECTS,
                        uint64_t(update.object) * sizeof(BurnObject) + offsetof(BurnObject, window),
                        sizeof timing);
    }
}

// Who is where from this step on. A record is known without sources: those are ours.
void recordExchangeUpdate(VkBackend::State& s, const ExchangeUpdate& update,
                          FrameRecorder& recorder, UploadWriter& writer) {
    for (const ExchangeUpdate::Placed& placed : update.objects) {
        ExchangeObject record = placed.record;
        record.sourceBase = s.scene.objects[placed.object].sources.first;
        record.sourceCount = s.scene.objects[placed.object].sources.units;
        const Staged staged = writer.write(std::span<const ExchangeObject>(&record, 1));
        recorder.copyIn(staged.at, FW_BIND_EXCHANGE_OBJECTS,
                        uint64_t(placed.object) * sizeof record, sizeof record);
    }
    const auto copy = [&](auto data, uint32_t resource, uint32_t first) {
        if (data.empty()) return;
        const Staged staged = writer.write(data);
        recorder.copyIn(staged.at, resource, first * sizeof(data[0]), data.size_bytes());
    };
    for (const ExchangeUpdate::Range& range : update.neighbourRanges)
        copy(update.neighbours.subspan(range.first, range.count), FW_BIND_NEIGHBOURS, range.first);
    for (const ExchangeUpdate::Range& range : update.linkRanges)
        copy(update.links.subspan(range.first, range.count), FW_BIND_CONTACTS, range.first);
    copy(update.occluders, FW_BIND_HEAT_OCCLUDERS, 0);
    s.simulation.links = uint32_t(update.links.size());
    s.simulation.occluders = uint32_t(update.occluders.size());
}

void uploadOcclusion(VkBackend::State& s, const OcclusionUpdate& update, FrameRecorder& recorder,
                     UploadWriter& writer) {
    s.simulation.shield = update;
    s.simulation.shield.words = {};
    if (update.words.empty()) return;
    const Staged staged = writer.write(update.words);
    recorder.copyIn(staged.at, FW_BIND_HEAT_OCCLUSION, 0, update.words.size_bytes());
}

void recordRooms(VkBackend::State& s, FrameRecorder& recorder, UploadWriter& writer) {
    const Staged staged = writer.write(std::span<const Room>(s.scene.rooms));
    recorder.copyIn(staged.at, FW_BIND_ROOMS, 0, sizeof s.scene.rooms);
    s.scene.roomsDirty = false;
}

// The tiles that a step looks at again: those of latched objects and of objects that restart their
// prediction, or all.
Staged writeWakeGroups(const VkBackend::State& s, std::span<const MaterialUpdate> updates,
                       bool dense, bool rebuildsPrediction, UploadWriter& writer) {
    Staged staged = writer.begin();
    const auto append = [&](uint32_t object) {
        const uint32_t groups = appendWakeGroups(s.scene.objects[object]);
        for (uint32_t g = 0; g < groups; ++g) {
            const WakeGroup group{object, g * 64};
            writer.append(staged, std::span<const WakeGroup>(&group, 1));
        }
    };
    for (uint32_t i = 0; dense && i < s.scene.objects.size(); ++i) {
        if (s.scene.objects[i].live) append(i);
    }
    if (!dense) {
        for (const MaterialUpdate& update : updates) append(update.object);
    }
    for (const uint32_t i : s.scene.awake) {
        if (rebuildsPrediction && s.scene.objects[i].burn.forget) append(i);
    }
    writer.end();
    return staged;
}

// An object that an event reaches is drawn as one that may burn from now on.
void markObjectOfEvent(VkBackend::State& s, const TexelEvent& event, uint32_t now) {
    ObjectEntry& object = s.scene.objects[event.object];
    object.publishedTouched |= (object.record.flags & kObjectPublished) != 0;
    object.burn.lastEvent = std::max<uint64_t>(object.burn.lastEvent, now + kStepTicks);
    const uint32_t kind = eventKind(event.kind);
    const bool douses = (kind == kEventWet || kind == kEventDry || kind == kEventExtinguish ||
                         kind == kEventCarry) &&
                        !object.burn.doused;
    const bool lights = kind == kEventIgnite || kind == kEventCarry;
    object.burn.catches |= lights && !object.burn.lit;
    object.burn.lit |= lights;
    if (object.burn.touched && !douses) return;
    object.burn.touched = true;
    object.burn.doused = object.burn.doused || douses;
    s.surfaces.surfacesDirty = true;
    for (DrawItem& item : drawItemsOf(s, event.object)) {
        chooseSurface(s, object, item);
        item.draw = drawOf(s, object, item.material);
    }
}

// Burnt pieces that lost their hold: a part of the tiles each frame, in turn, from the first object
// that fire came to up to the last one.
void recordFalling(VkBackend::State& s, const FramePlan& plan, bool burning,
                   FrameRecorder& recorder) {
    constexpr uint32_t kMaxTiles = 16384;
    uint32_t begin = kNoneTexel, end = 0;
    float latest = 0;
    for (const uint32_t i : s.scene.awake) {
        const ObjectEntry& object = s.scene.objects[i];
        if (!object.live || !object.burn.touched) continue;
        begin = std::min(begin, object.record.worldTileBase);
        end = std::max(end, object.record.worldTileBase + object.record.tileCount);
        for (const BurnMaterial& material : object.materials)
            if (material.holeTicks) latest = std::max(latest, material.baseColor.w);
    }
    if (burning) {
        // After the last flame: until all is gone, and as long as it takes to notice.
        s.simulation.supportUntil = plan.endTick + uint32_t(1.2f * latest) + 16 * kTicksPerSecond;
        if (latest == 0) return;
    }
    if (end <= begin) return;
    const uint32_t parts = (end - begin + kMaxTiles - 1) / kMaxTiles;
    const bool goesOn = s.simulation.supportFirst > begin && s.simulation.supportFirst < end;
    const uint32_t first = goesOn ? s.simulation.supportFirst : begin;
    const uint32_t count = std::min(end - first, kMaxTiles);
    s.simulation.supportFirst = first + count;
    const auto ticks = uint32_t(plan.steps.size()) * kStepTicks * parts;
    recordSupport(recorder, plan.endTick, {first, count, ticks});
}

// Records objects created, moved or restored since the last frame, and the plan's changes outside
// of steps.
void recordChanges(VkBackend::State& s, const FramePlan& plan, const FrameNeeds& needs,
                   FrameRecorder& recorder, UploadWriter& writer) {
    const Table& vk = s.device.table;
    if (s.buffers.recordMoves(vk, s.open.commands, s.open.ringFrame))
        s.barriers.begin(vk, s.open.commands);  // rare: waits for all of the moves
    if (!s.scene.initialized) {
        for (const uint32_t resource :
             {FW_BIND_COUNTERS, FW_BIND_OBJECT_COUNTERS, FW_BIND_LIGHTS, FW_BIND_LIGHT_CELLS,
              FW_BIND_DRAW_ARGS, FW_BIND_OBJECTS, FW_BIND_REFINE_OBJECTS, FW_BIND_EXCHANGE_OBJECTS,
              FW_BIND_ROOMS, FW_BIND_ROOM_AIR})
            recorder.fillZero(resource, 0, VK_WHOLE_SIZE);
        s.scene.initialized = true;
    }
    recordUploads(s);
    if (s.scene.recordsDirty) recordObjects(s, recorder, writer);
    if (s.scene.roomsDirty) recordRooms(s, recorder, writer);
    recordRestores(s, recorder);
    recordMovedTiles(s, recorder);
    recordForgetting(s, recorder);
    s.surfaces.drawVertices = s.buffers.buffer(kResourceVertices).handle;
    s.surfaces.drawIndices = s.buffers.buffer(kResourceIndices).handle;
    s.surfaces.drawShown = s.buffers.buffer(FW_BIND_SHOWN).handle;
    recordFieldSteps(s, plan, recorder, writer);
    if (plan.volumes) recordVolumes(s, *plan.volumes, recorder, writer);
    s.particles.emittersMove = plan.emitters != nullptr;
    if (plan.emitters) recordEmitters(s, *plan.emitters, recorder, writer);
    if (needs.skins) recordSkins(s, recorder, writer);
}

// Uploads what step `planned` brings. `first`: the plan's first; `iterate`: its front may move.
StepRecord stepOf(VkBackend::State& s, const FramePlan& plan, const StepPlan& planned,
                  const FrameNeeds& needs, bool first, bool iterate, FrameRecorder& recorder,
                  UploadWriter& writer) {
    StepRecord step;
    step.now = planned.now;
    step.stepShift = planned.substepShift;
    step.switches = plan.switches;
    step.objectSlots = uint32_t(s.scene.objects.size());
    step.iterate = iterate;
    step.reduce = planned.reduce && needs.burning;
    step.heat = planned.heat && needs.heating;
    step.rooms = planned.rooms;
    s.scene.airs = s.scene.airs || planned.rooms;
    step.exchange = step.reduce && planned.exchange;
    step.governed = planned.governed;
    step.capped = planned.capped;
    step.plays = planned.plays;
    step.rules = planned.rules;
    if (planned.remote) recordExchangeUpdate(s, *planned.remote, recorder, writer);
    step.links = s.simulation.links;
    step.parts = s.scene.partMeshes != 0;
    if (planned.shield) uploadOcclusion(s, *planned.shield, recorder, writer);
    step.rules.occluders = s.simulation.occluders;
    setOcclusionPush(s.simulation.shield, step.rules);
    recordMaterials(s, planned.materials, recorder, writer);
    step.wakeGroups = writeWakeGroups(s, planned.materials, needs.dense,
                                      needs.rebuildsPrediction && first, writer);
    step.events = writer.write(planned.events);
    step.eventList = planned.events;
    for (const TexelEvent& event : planned.events) {
        markObjectOfEvent(s, event, planned.now);
        if (addressesAll(event))
            step.allTiles = std::max(step.allTiles, s.scene.objects[event.object].record.tileCount);
    }
    if (!needs.publishedRuns) return step;
    for (PublishedStep& one : s.simulation.published) {
        one.parity = s.scene.objects[one.object].publishedParity;
        s.scene.objects[one.object].publishedParity ^= 1;
    }
    step.published = s.simulation.published;
    return step;
}

void recordSteps(VkBackend::State& s, const FramePlan& plan, const FrameNeeds& needs,
                 FrameRecorder& recorder, UploadWriter& writer) {
    ReadbackLayout& layout = s.open.slot->layout;
    if (needs.iterations) recordCounters(recorder, s.simulation.lists, uint32_t(needs.iterations));
    layout.firstRow = s.simulation.lists.row;
    bool iterates = !s.simulation.frontEmpty || needs.dense || needs.never;
    for (const StepPlan& planned : plan.steps) {
        iterates |= changesState(planned) || (planned.exchange && !s.simulation.burnEmpty);
        const bool first = &planned == plan.steps.data();
        const StepRecord step = stepOf(s, plan, planned, needs, first, iterates, recorder, writer);
        recordSimulation(recorder, s.simulation.lists, step);
        s.simulation.frontWalks += step.iterate ? 1 : 0;
        s.simulation.burnWalks += step.reduce ? 1 : 0;
        s.simulation.hotWalks += step.heat ? 1 : 0;
    }
    layout.rows = s.simulation.lists.row;
    layout.burnParity = s.simulation.lists.burnParity;
    layout.hotParity = s.simulation.lists.hotParity;
    if (!needs.stimulus) return;
    s.simulation.lastStimulus = s.open.ringFrame;
    s.simulation.frontEmpty = s.simulation.burnEmpty = s.simulation.predictEmpty =
        s.simulation.hotEmpty = false;
}

DeformRecord deformationOf(VkBackend::State& s, const FrameNeeds& needs, UploadWriter& writer) {
    DeformRecord deform;
    deform.count = needs.deform;
    deform.steps = s.deforming.softSteps;
    deform.way = s.deforming.bendSet;
    deform.begins = needs.sheetsBegin;
    deform.groups = writeDeformGroups(s, writer);
    DeformPush& push = deform.push;
    push.now = s.open.endTick;
    push.step = float(kSoftTicks) / float(kTicksPerSecond);
    push.wind = {s.simulation.wind[0], s.simulation.wind[1], s.simulation.wind[2],
                 float(s.deforming.softStep % (4096 * 128)) * push.step};
    push.up = {s.limits.up[0], s.limits.up[1], s.limits.up[2],
               s.simulation.tickFraction * float(kStepTicks)};
    return deform;
}

}  // namespace

void recordRegions(const Table& vk, VkBackend::State& s, const PendingUpload& upload) {
    for (uint32_t i = 0; i < upload.regionCount; ++i) {
        const PendingUpload::Region& region = upload.regions[i];
        const Use uses[] = {{region.resource, Access::copyWrite}};
        s.barriers.use(vk, s.open.commands, uses);
        const VkBufferCopy copy{region.from, region.at, region.bytes};
        vk.CmdCopyBuffer(s.open.commands, upload.staging.handle,
                         s.buffers.buffer(region.resource).handle, 1, &copy);
    }
}

// Soot above this frame's flames: of many tiles a part each frame, in turn, and then no more of it
// than hides where that part ends. Where nobody looks it is laid a few times a second.
TileShare VkBackend::State::sootShare(bool looked) noexcept {
    constexpr uint32_t kMaxTiles = 4096, kUnseenTicks = kTicksPerSecond / 4;
    const uint32_t mostTicksOfAPart = looked ? kTicksPerSecond / 64 : kTicksPerSecond;
    if (!looked && open.endTick - simulation.sootTick < kUnseenTicks) return {};
    const uint32_t tiles = buffers.capacity(kPoolObjectTiles);
    const uint32_t parts = std::max((tiles + kMaxTiles - 1) / kMaxTiles, 1u);
    TileShare share;
    share.first = simulation.sootFirst < tiles ? simulation.sootFirst : 0;
    share.count = std::min(tiles - share.first, kMaxTiles);
    share.ticks = std::min(open.endTick - simulation.sootTick, kTicksPerSecond);
    simulation.sootTick = open.endTick;
    if (share.count == 0 || share.ticks == 0) return {};
    simulation.sootFirst = share.first + share.count;
    if (parts > 1) share.ticks = std::min(share.ticks * parts, mostTicksOfAPart);
    return share;
}

void VkBackend::State::openFrame(VkCommandBuffer commands, uint64_t ringFrame) {
    open = {};
    open.open = true;
    open.commands = commands;
    open.ringFrame = ringFrame;
}

RecordTarget VkBackend::State::recordTarget(FrameInFlight& slot,
                                            VkCommandBuffer commands) noexcept {
    RecordTarget target;
    target.device = &device;
    target.pipelines = &context.pipelines;
    target.sets = &sets;
    target.buffers = &buffers;
    target.barriers = &barriers;
    target.slot = &slot;
    target.commands = commands;
    return target;
}

uint32_t VkBackend::State::pushView(FrameInFlight& slot, const FwView& view,
                                    const VkViewport& viewport) {
    if (slot.views == FrameRing::kMaxViews)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "A frame is drawn with more than %u views; that is the limit.",
                   FrameRing::kMaxDrawn);
    ViewInput input;
    input.view = &view;
    input.viewport[0] = viewport.x;
    input.viewport[1] = viewport.y;
    input.viewport[2] = viewport.width;
    input.viewport[3] = viewport.height;
    input.now = simulation.shownTick;
    input.tickFraction = simulation.tickFraction;
    for (int i = 0; i < 3; ++i) {
        input.wind[i] = simulation.wind[i];
        input.up[i] = limits.up[i];
    }
    input.paceFactor = limits.paceFactor;
    input.lightCount = uint32_t(std::ceil(particles.lightCount));
    input.lastLight =
        particles.lightCount > 0 ? particles.lightCount - float(input.lightCount - 1) : 1;
    input.flameCapacity = std::min(limits.maxFlames, kFlameCapacity);
    input.quadShare = particles.quadShare;
    input.seed = limits.seed;
    ViewParams params{};
    if (limits.looks.viewParams) limits.looks.viewParams(input, params);
    seen = params;
    const uint32_t offset = (ring.indexOf(slot) * FrameRing::kMaxViews + slot.views) * viewStride;
    std::memcpy(views.mapped + offset, &params, sizeof params);
    ++slot.views;
    return offset;
}

// Moves the detail shown toward the plan's detail, a bounded amount per frame.
void VkBackend::State::followDetail(const Detail& planned) noexcept {
    const auto toward = [](auto& now, auto wanted, auto turn) {
        now = now > wanted ? std::max(now - turn, wanted) : std::min(now + turn, wanted);
    };
    detail = planned;
    toward(flames.volumeStepsNow, detail.rayStepCount, kStepsTurn);
    toward(particles.quadShare, detail.quads, kQuadsTurn);
    toward(particles.lightCount, float(lightsOf(detail, limits.maxLights)), kLightsTurn);
}

void VkBackend::State::run(const FramePlan& plan) {
    if (!open.open || open.ran)
        core::fail(FW_ERROR_INTERNAL, "A frame's plan is run once, after the frame is begun.");
    // Sheets and springs step at a rate of their own; a hitch drops steps and never stretches one.
    const double ticks = double(plan.endTick) + double(plan.tickFraction) * kStepTicks;
    const auto softNow = uint64_t(ticks / kSoftTicks);
    deforming.softSteps = uint32_t(std::min<uint64_t>(
        softNow > deforming.softStep ? softNow - deforming.softStep : 0, kMaxSoftSteps));
    deforming.softStep = softNow;
    const FrameNeeds needs = needsOf(*this, plan);
    open.planFrame = plan.frameIndex;
    open.endTick = plan.endTick;
    open.readback = needs.readback;
    std::copy(std::begin(plan.wind), std::end(plan.wind), std::begin(simulation.wind));
    simulation.tickFraction = plan.tickFraction;
    followDetail(plan.detail);
    crossing = plan.switches & (kSwitchCrossing | kSwitchNoZPass);
    if (!needs.work) {
        open.ran = true;
        simulation.shownTick = plan.endTick;
        if (plan.frameIndex == 0) return;
        PendingReadback same;
        same.ringFrame = open.ringFrame;
        same.frameIndex = plan.frameIndex;
        same.endTick = plan.endTick;
        pushPending(same);
        return;
    }
    FrameInFlight& slot = makeRoom(*this, plan, needs);

    // From here on nothing fails.
    open.ran = true;
    open.slot = &slot;
    open.recording = true;
    barriers.begin(device.table, open.commands);
    slot.timers.reset(device, open.commands);
    FrameRecorder recorder(recordTarget(slot, open.commands));
    UploadWriter writer(slot);
    recordChanges(*this, plan, needs, recorder, writer);
    recordSteps(*this, plan, needs, recorder, writer);
    simulation.shownTick = plan.endTick;
    if (needs.predicting && predictsNow(*this, needs, plan.endTick))
        recordPredictions(*this, plan, recorder, writer);
    if (needs.falling) recordFalling(*this, plan, needs.burning, recorder);
    slot.layout.predictParity = simulation.lists.predictParity;
    if (needs.deform.vertices) recordDeformation(recorder, deformationOf(*this, needs, writer));
    deforming.bendSet = (deforming.bendSet + deforming.softSteps) % kBendSets;
    settle();
    if (!plan.probes.empty()) recordProbes(recorder, writer.write(plan.probes));
}

void VkBackend::State::closeFrame() {
    const std::span<OutsideView* const> from = seenFrom();
    for (const OutsideView* const of : from) look(of->view, of->height, open.ringFrame);
    if (!from.empty() && simulation.burnEmpty && !showsEmitters()) particles.quadsShown = 0;
    if (!open.recording) {
        open = {};
        return;
    }
    FrameInFlight& slot = *open.slot;
    recordEffects(slot);
    if (!from.empty()) {
        refineObjects(slot);
        refineAsPublished(slot);
    }
    for (DrawItem& item : surfaces.drawItems)
        if (scene.awake.contains(item.object)) showRefined(scene.objects[item.object].refine, item);
    recordReadback(slot);
    if (open.planFrame) {
        PendingReadback one;
        one.ringFrame = open.ringFrame;
        (open.readback ? one.slot : one.looks) = int32_t(ring.indexOf(slot));
        one.frameIndex = open.planFrame;
        one.endTick = open.endTick;
        pushPending(one);
    }
    barriers.end(device.table, open.commands);
    open = {};
}

}  // namespace fw::gpu::vk
