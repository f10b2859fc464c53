// The outside part of a frame: what waits is uploaded, the plan's steps are recorded, and the
// readback is copied. Everything that can fail comes before the first command.
#include "core/error.h"
#include "flamewright/flamewright_debug.h"
#include "gpu/vk/world_state.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace fw::gpu::vk {
namespace {

constexpr uint32_t kMaxGroups = 65535;     // of a dispatch at the floor
constexpr uint64_t kUploadAlignment = 16;  // bytes

uint64_t alignUp(uint64_t value, uint64_t alignment) noexcept {
    return (value + alignment - 1) / alignment * alignment;
}

uint64_t uploaded(uint64_t bytes) noexcept { return alignUp(bytes, kUploadAlignment); }

// A host-visible buffer of at least `bytes`; never shrinks. Throws and then left the old one.
void ensure(VkBackend::State& s, Buffer& buffer, uint64_t bytes, VkBufferUsageFlags usage,
            MemoryKind kind, Component component, const char* name) {
    if (buffer.size >= bytes) return;
    Buffer fresh = s.deviceMemory.createBuffer(std::max<uint64_t>(bytes + bytes / 2, 65536), usage,
                                               kind, component, name);
    s.deviceMemory.destroy(buffer);  // its frame is done: the slot was free
    buffer = fresh;
}

// Linear writes into the frame's upload buffer.
class UploadWriter {
 public:
    explicit UploadWriter(FrameInFlight& slot) : slot_(slot) {}
    template <class T>
    Staged write(std::span<const T> data) {
        Staged staged = begin();
        append(staged, data);
        end();
        return staged;
    }
    // Piece by piece: begin, append any number of times, end.
    [[nodiscard]] Staged begin() const { return {slot_.uploadUsed, 0}; }
    template <class T>
    void append(Staged& staged, std::span<const T> data) {
        if (!data.empty())
            std::memcpy(slot_.upload.mapped + slot_.uploadUsed, data.data(), data.size_bytes());
        slot_.uploadUsed += data.size_bytes();
        staged.count += uint32_t(data.size());
    }
    void end() { slot_.uploadUsed = uploaded(slot_.uploadUsed); }

 private:
    FrameInFlight& slot_;
};

struct WakeGroup {
    uint32_t object, firstTile;
};

uint32_t wakeGroupsOf(const ObjectEntry& object) noexcept {
    return (object.record.tileCount + 63) / 64;
}

bool bringsNews(const StepPlan& step) noexcept {
    return !step.events.empty() || !step.materials.empty();
}

// Does a group of its nodes learn in this frame what has burnt? Of a sheet, which moves by steps of
// its own, every other one.
bool recedes(const ObjectEntry& object, uint32_t group) noexcept {
    return (object.deform.flags & kDeformShell) == 0 || object.deformReset ||
           (group & 1) == (object.recedeOdd ? 1u : 0u);
}

constexpr uint64_t kSettleTicks = 12 * kTicksPerSecond;  // that a sheet may swing

uint32_t groupsOf(uint32_t items) noexcept { return (items + kDeformGroup - 1) / kDeformGroup; }

// Does it still move, as far as is known? What burns does, until the last texel that caught has
// burnt out.
bool deforms(const VkBackend::State& s, uint32_t slot, uint64_t now) noexcept {
    const ObjectEntry& object = s.objects[slot];
    if (!object.live || object.shown.units == 0 || object.skinPlus1) return false;
    if (object.deformReset) return true;
    if (object.deform.flags & kDeformShell) {
        const bool wind = s.wind[0] != 0 || s.wind[1] != 0 || s.wind[2] != 0;
        const bool hidden = (object.record.flags & kObjectHidden) != 0;
        if (!hidden && (wind || now <= object.softUntil)) return true;
    }
    if (!object.touched) return false;
    uint64_t last = object.lastEvent;
    if (slot < s.givenObjects.size())
        last = std::max<uint64_t>(last, s.givenObjects[slot].lastIgnition);
    return now <= last + object.deformTicks;
}

// --- Before the first command ---

// What a plan asks of its frame: how much room, and which passes have anything to do.
struct FrameNeeds {
    bool dense = false, never = false;    // debug switches: every tile; never idle
    uint64_t uploadBytes = 0;             // at most
    uint64_t iterations = 0;              // of all steps
    uint32_t events = 0, wakeGroups = 0;  // of the largest step
    uint32_t neighbours = 0, links = 0;   // of the largest remote update
    bool placing = false;                 // there is one
    bool exchanges = false;               // fire may come from other objects
    bool stimulus = false;                // an event or a latch
    bool findsAnew = false;               // the first step wakes what forgets
    bool burning = false, predicting = false, publishedRuns = false, heating = false;
    bool falling = false;  // burnt pieces may lose their hold
    uint32_t nodeGroups = 0, sheetGroups = 0, springGroups = 0, vertexGroups = 0;  // what deforms
    bool skins = false;                   // a host moved vertices
    bool readback = false, work = false;  // no work: nothing is recorded
    [[nodiscard]] uint32_t deformGroups() const noexcept {
        return nodeGroups + sheetGroups + springGroups + vertexGroups;
    }
};

// Also marks what objects `forget`, and fills `published`; throws where a limit is exceeded.
FrameNeeds needsOf(VkBackend::State& s, const FramePlan& plan) {
    FrameNeeds needs;
    needs.dense = (plan.switches & kSwitchDense) != 0;
    needs.never = (plan.switches & FW_DEBUG_NEVER_IDLE) != 0;
    uint64_t denseGroups = 0;
    s.published.clear();
    for (uint32_t i = 0; i < s.objects.size(); ++i) {
        ObjectEntry& object = s.objects[i];
        if (object.recordDirty) needs.uploadBytes += uploaded(sizeof(BurnObject));
        if (object.materialsDirty)
            needs.uploadBytes += uploaded(sizeof object.materials) + uploaded(sizeof object.heat);
        if (object.deformDirty) needs.uploadBytes += uploaded(sizeof object.deform);
        if (object.soft.units && object.softUntil == 0)
            object.softUntil = plan.endTick + kSettleTicks;
        object.deformsNow = deforms(s, i, plan.endTick);
        if (object.deformsNow) {
            const uint32_t groups = groupsOf(object.deform.nodeCount);
            for (uint32_t group = 0; group < groups; ++group)
                needs.nodeGroups += recedes(object, group) ? 1 : 0;
            if (object.deform.flags & kDeformShell) needs.sheetGroups += groups;
            if (object.deform.flags & kDeformSprings) needs.springGroups += groups;
            needs.vertexGroups += groupsOf(object.deform.vertexCount);
        }
        const Skin* moved = object.skinPlus1 ? &s.skins[object.skinPlus1 - 1] : nullptr;
        if (moved && (moved->dirty || moved->givenDue)) {
            const Skin& skin = *moved;
            needs.skins = true;
            if (skin.dirty) needs.uploadBytes += uploaded(skin.shown.size() * sizeof(ShownVertex));
            // Normals that the host does not give follow the triangles.
            object.deformsNow = !skin.normals;
            if (object.deformsNow) needs.vertexGroups += groupsOf(object.deform.vertexCount);
        }
        if (!object.live) continue;
        if (needs.dense) denseGroups += wakeGroupsOf(object);
        if (object.record.flags & kObjectPublished)
            s.published.push_back({i, publishedGroups(object.record), 0});
    }
    const bool anyStep = !plan.steps.empty();
    // What burns may light something anew, where no front is left.
    bool iterates = !s.frontEmpty || needs.dense || needs.never;
    for (const StepPlan& step : plan.steps) {
        iterates |= step.exchange && !s.burnEmpty;
        if (step.events.size() > size_t(kMaxGroups) * 64)
            core::fail(FW_ERROR_INVALID_ARGUMENT, "One step has %zu texel events; the limit is %u.",
                       step.events.size(), kMaxGroups * 64);
        uint64_t wake = needs.dense ? denseGroups : 0;
        for (const MaterialUpdate& update : step.materials) {
            needs.uploadBytes += uploaded(sizeof update.materials) + kUploadAlignment;
            if (!needs.dense) wake += wakeGroupsOf(s.objects[update.object]);
        }
        if (step.remote) {
            const RemoteUpdate& update = *step.remote;
            needs.placing = true;
            needs.neighbours = std::max(needs.neighbours, uint32_t(update.neighbours.size()));
            needs.links = std::max(needs.links, uint32_t(update.links.size()));
            needs.uploadBytes += update.objects.size() * uploaded(sizeof(RemoteObject)) +
                                 uploaded(update.neighbours.size_bytes()) +
                                 uploaded(update.links.size_bytes()) +
                                 uploaded(update.blockers.size_bytes());
        }
        needs.exchanges |= step.exchange;
        needs.events = std::max(needs.events, uint32_t(step.events.size()));
        needs.wakeGroups = std::max(needs.wakeGroups, uint32_t(wake));
        needs.uploadBytes +=
            uploaded(step.events.size_bytes()) + uploaded(wake * sizeof(WakeGroup));
        for (const TexelEvent& event : step.events) {
            s.noteFire(event.object, plan.endTick);
            if (event.kind != kEventWet && event.kind != kEventExtinguish) continue;
            ObjectEntry& object = s.objects[event.object];
            object.lastDouse = s.open.ringFrame;
            object.douseEnds = step.now;  // water takes some heat steps
            if (object.record.flags & kObjectHeat)
                object.douseEnds += (kSoaksOut + 2) * kHeatSteps * kStepTicks;
        }
        needs.stimulus |= bringsNews(step);
        iterates |= bringsNews(step);
        if (iterates) needs.iterations += uint64_t(1) << step.substepShift;
    }
    // Once a dousing is over, what its object sees coming is forgotten and found anew: predictions
    // that lost their fire would keep each other alive.
    bool forgets = false;
    uint64_t forgetGroups = 0;
    for (ObjectEntry& object : s.objects) {
        object.forget = object.live && object.lastDouse != 0 &&
                        object.lastDouse < s.open.ringFrame && (anyStep || s.frontEmpty) &&
                        (plan.endTick > object.douseEnds || s.frontEmpty);
        if (!object.forget) continue;
        forgets = true;
        forgetGroups += wakeGroupsOf(object);
    }
    needs.findsAnew = forgets && anyStep && !s.frontEmpty && !needs.dense;
    if (needs.findsAnew) {
        needs.wakeGroups += uint32_t(forgetGroups);
        needs.uploadBytes += uploaded(forgetGroups * sizeof(WakeGroup));
    }
    needs.uploadBytes += uploaded(uint64_t(needs.deformGroups()) * 8);
    needs.uploadBytes += uploaded(plan.probes.size_bytes());
    if (plan.burnMaps.size() > ReadbackLayout::kMaxMaps)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "%zu burn maps are asked for; the limit is %u.",
                   plan.burnMaps.size(), ReadbackLayout::kMaxMaps);
    const auto mostIterations = uint64_t(s.planes.capacity(kSpaceIterations)) - kRowIteration - 1;
    if (needs.iterations > mostIterations)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "A frame has %llu iterations; the limit is %llu.",
                   (unsigned long long)needs.iterations, (unsigned long long)mostIterations);
    needs.publishedRuns =
        anyStep &&
        std::any_of(s.published.begin(), s.published.end(), [&](const PublishedStep& one) {
            return needs.stimulus || needs.exchanges || s.objects[one.object].publishedTouched;
        });
    needs.burning = !s.burnEmpty || needs.stimulus || needs.never;
    needs.heating =
        !s.hotEmpty || (needs.exchanges && needs.burning) || needs.stimulus || needs.never;
    needs.predicting =
        !s.predictEmpty || (needs.exchanges && needs.burning) || needs.stimulus || needs.never;
    needs.falling =
        anyStep && s.limits.looks.viewParams && (needs.burning || plan.endTick < s.supportUntil);
    needs.readback = needs.burning || needs.predicting || needs.heating || needs.iterations > 0 ||
                     needs.publishedRuns || !plan.probes.empty() || !plan.burnMaps.empty();
    const uint64_t refineBytes = s.planRefine(plan);
    needs.uploadBytes += refineBytes;
    needs.work = needs.readback || needs.falling || needs.vertexGroups > 0 || needs.skins ||
                 refineBytes > 0 || forgets || needs.placing || s.recordsDirty ||
                 !s.uploads.empty() || s.planes.movesPending();
    return needs;
}

// Where the pieces of the frame's readback will lie; `bytes`: all of it.
ReadbackLayout layoutOf(const VkBackend::State& s, const FramePlan& plan, const FrameNeeds& needs,
                        uint64_t& bytes) {
    ReadbackLayout layout;
    layout.frameIndex = plan.frameIndex;
    layout.endTick = plan.endTick;
    layout.objects = uint32_t(s.objects.size());
    layout.answers = uint32_t(plan.probes.size());
    layout.lights = s.limits.maxLights;
    bytes = 0;
    const auto place = [&](uint64_t size) {
        const uint64_t at = bytes;
        bytes = alignUp(bytes + size, 16);
        return at;
    };
    const uint64_t lastRow = needs.iterations ? kRowIteration + needs.iterations : s.lists.row;
    layout.countersAt = place((lastRow + 1) * sizeof(IterationCounters));
    layout.objectsAt = place(layout.objects * sizeof(ObjectCounters));
    layout.answersAt = place(uint64_t(layout.answers) * sizeof(ProbeAnswer));
    layout.lightsAt = place(uint64_t(layout.lights) * sizeof(BurnLight));
    layout.flamesAt = place(16);
    for (const uint32_t object : plan.burnMaps) {
        ReadbackLayout::MapAt& map = layout.maps[layout.mapCount++];
        map.object = object;
        map.texels = s.objects[object].record.width * s.objects[object].record.height;
        map.at = place(uint64_t(map.texels) * 4);
        map.heat = (s.objects[object].record.flags & kObjectHeat) != 0;
        if (map.heat) map.heatAt = place(uint64_t(map.texels) * sizeof(uvec2));
    }
    return layout;
}

// All that may fail: buffers of the size that the frame needs, and sets that name them.
FrameInFlight& makeRoom(VkBackend::State& s, const FramePlan& plan, const FrameNeeds& needs) {
    const uint64_t last = s.ring.newest();
    s.planes.atLeast(kSpaceEvents, needs.events, last);
    s.planes.atLeast(kSpaceWakeGroups, needs.wakeGroups, last);
    s.planes.atLeast(kSpaceProbes, uint32_t(plan.probes.size()), last);
    s.planes.atLeast(kSpaceDeformGroups, needs.deformGroups(), last);
    s.planes.atLeast(kSpaceNeighbours, needs.neighbours, last);
    s.planes.atLeast(kSpaceContacts, needs.links, last);
    FrameInFlight& slot = s.ring.slotFor(s.open.ringFrame);
    uint64_t readbackBytes = 0;
    const ReadbackLayout layout = layoutOf(s, plan, needs, readbackBytes);
    if (slot.upload.size < needs.uploadBytes ||
        (needs.readback && slot.readback.size < readbackBytes))
        slot.readbackPending = false;
    ensure(s, slot.upload, needs.uploadBytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryKind::upload,
           kComponentStaging, "frame upload");
    if (needs.readback)
        ensure(s, slot.readback, readbackBytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
               MemoryKind::readback, kComponentReadback, "frame readback");
    s.sets.update(s.planes, s.views.handle, sizeof(ViewParams), last);
    slot.layout = layout;
    return slot;
}

// --- Commands ---

void recordImageUpload(const Table& vk, VkCommandBuffer commands, const PendingUpload& upload) {
    auto barrier = typed<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
    barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = upload.image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, upload.mips, 0, upload.layers};
    vk.CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
                          VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr, 1, &barrier);
    uint64_t at = 0;
    for (uint32_t layer = 0; layer < upload.layers; ++layer) {
        for (uint32_t mip = 0; mip < upload.mips; ++mip) {
            VkBufferImageCopy region{};
            region.bufferOffset = at;
            region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip, layer, 1};
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
    vk.CmdPipelineBarrier(
        commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
        VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0, 0, nullptr,
        0, nullptr, 1, &barrier);
}

// Meshes, images, painted maps: what was created since the last frame.
void recordUploads(VkBackend::State& s) {
    const Table& vk = s.device.table;
    for (PendingUpload& upload : s.uploads) {
        if (upload.image) recordImageUpload(vk, s.open.commands, upload);
        for (uint32_t i = 0; i < upload.regionCount; ++i) {
            const PendingUpload::Region& region = upload.regions[i];
            const Use uses[] = {{region.resource, Access::copyWrite}};
            s.barriers.use(vk, s.open.commands, uses);
            const VkBufferCopy copy{region.from, region.at, region.bytes};
            vk.CmdCopyBuffer(s.open.commands, upload.staging.handle,
                             s.planes.buffer(region.resource).handle, 1, &copy);
        }
        s.retired.push(s.open.ringFrame, upload.staging);
    }
    s.uploads.clear();
}

bool looksBurnt(const ObjectEntry& object) noexcept {
    return object.touched && (object.record.flags & kObjectNoDamage) == 0;
}

SurfaceDraw drawOf(const VkBackend::State& s, const ObjectEntry& object, uint32_t material) {
    const vec4 row = object.record.worldRow0;
    const float scale = std::sqrt(row.x * row.x + row.y * row.y + row.z * row.z);
    return surfaceDraw(object.record, object.materials[material], object.heat[material],
                       s.meshes[object.mesh].edge * scale, object.refine.slots.first,
                       object.doused);
}

// Records of objects that are new, moved or gone, and the list of what draws show.
void recordObjects(VkBackend::State& s, FrameRecorder& recorder, UploadWriter& writer) {
    for (uint32_t i = 0; i < s.objects.size(); ++i) {
        ObjectEntry& object = s.objects[i];
        if (object.resetDue ||
            (object.recordDirty && !object.live))  // until it is placed others do not see it
            recorder.fillZero(FW_BIND_REMOTE_OBJECTS, i * sizeof(RemoteObject),
                              sizeof(RemoteObject));
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
        if (object.deformDirty) {
            const Staged staged = writer.write(std::span<const DeformObject>(&object.deform, 1));
            recorder.copyIn(staged.at, FW_BIND_DEFORM_OBJECTS,
                            uint64_t(object.deformer.first) * sizeof(DeformObject),
                            sizeof(DeformObject));
        }
        object.recordDirty = object.materialsDirty = object.deformDirty = false;
    }
    s.drawItems.clear();
    for (uint32_t i = 0; i < s.objects.size(); ++i) {
        ObjectEntry& object = s.objects[i];
        if (object.resetDue) {
            recordReset(recorder, i, object.record.tileCount);
            recorder.fillZero(FW_BIND_SOURCES, object.sources.first * sizeof(FireSource),
                              object.sources.units * sizeof(FireSource));
        }
        object.resetDue = false;
        if (!object.live || (object.record.flags & kObjectHidden)) continue;
        const MeshEntry& mesh = s.meshes[object.mesh];
        uint32_t first = 0;
        for (uint32_t m = 0; m < kMaterialsPerObject; ++m) {
            const uint32_t end = mesh.materialEnd[m];
            if (end != first)
                s.drawItems.push_back(
                    {i, m, mesh.indexRange.first + first, end - first,
                     int32_t(mesh.vertexRange.first),
                     object.shown.units ? object.shown.first : kNoneTexel, object.images[m],
                     surfaceVariant(object.materials[m], object.images[m] != 0, looksBurnt(object)),
                     object.refine.started, object.refine.cut, drawOf(s, object, m)});
            first = end;
        }
    }
    s.recordsDirty = false;
}

void recordForgetting(VkBackend::State& s, FrameRecorder& recorder) {
    for (ObjectEntry& object : s.objects) {
        if (!object.forget) continue;
        recorder.copyBetween(FW_BIND_STATE, FW_BIND_PREDICT, uint64_t(object.record.stateBase) * 4,
                             uint64_t(object.record.width) * object.record.height * 4);
        object.lastDouse = 0;
    }
}

// New records of a step's latches.
void recordMaterials(VkBackend::State& s, std::span<const MaterialUpdate> updates,
                     FrameRecorder& recorder, UploadWriter& writer) {
    for (const MaterialUpdate& update : updates) {
        ObjectEntry& object = s.objects[update.object];
        std::copy(std::begin(update.materials), std::end(update.materials),
                  std::begin(object.materials));
        object.record.window = update.window;
        object.record.substepShift = update.substepShift;
        for (DrawItem& item : s.drawItems) {
            if (item.object == update.object) item.draw = drawOf(s, object, item.material);
        }
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
void recordRemote(VkBackend::State& s, const RemoteUpdate& update, FrameRecorder& recorder,
                  UploadWriter& writer) {
    for (const RemoteUpdate::Placed& placed : update.objects) {
        RemoteObject record = placed.record;
        record.sourceBase = s.objects[placed.object].sources.first;
        record.sourceCount = s.objects[placed.object].sources.units;
        const Staged staged = writer.write(std::span<const RemoteObject>(&record, 1));
        recorder.copyIn(staged.at, FW_BIND_REMOTE_OBJECTS, uint64_t(placed.object) * sizeof record,
                        sizeof record);
    }
    const auto copy = [&](auto data, uint32_t resource) {
        if (data.empty()) return;
        const Staged staged = writer.write(data);
        recorder.copyIn(staged.at, resource, 0, data.size_bytes());
    };
    copy(update.neighbours, FW_BIND_NEIGHBOURS);
    copy(update.links, FW_BIND_CONTACTS);
    copy(update.blockers, FW_BIND_BLOCKERS);
    s.links = uint32_t(update.links.size());
    s.blockers = uint32_t(update.blockers.size());
}

// The tiles that a step looks at anew: those of latched objects and of forgetful ones, or all.
Staged writeWakeGroups(const VkBackend::State& s, std::span<const MaterialUpdate> updates,
                       bool dense, bool findsAnew, UploadWriter& writer) {
    Staged staged = writer.begin();
    const auto append = [&](uint32_t object) {
        const uint32_t groups = wakeGroupsOf(s.objects[object]);
        for (uint32_t g = 0; g < groups; ++g) {
            const WakeGroup group{object, g * 64};
            writer.append(staged, std::span<const WakeGroup>(&group, 1));
        }
    };
    for (uint32_t i = 0; dense && i < s.objects.size(); ++i) {
        if (s.objects[i].live) append(i);
    }
    if (!dense) {
        for (const MaterialUpdate& update : updates) append(update.object);
    }
    for (uint32_t i = 0; findsAnew && i < s.objects.size(); ++i) {
        if (s.objects[i].forget) append(i);
    }
    writer.end();
    return staged;
}

// An object that an event reaches is drawn as one that may burn from now on.
void noteEvent(VkBackend::State& s, const TexelEvent& event) {
    ObjectEntry& object = s.objects[event.object];
    object.publishedTouched |= (object.record.flags & kObjectPublished) != 0;
    object.lastEvent = std::max<uint64_t>(object.lastEvent, event.tick);
    const bool douses = event.kind != kEventIgnite && !object.doused;
    if (object.touched && !douses) return;
    object.touched = true;
    object.doused = object.doused || douses;
    for (DrawItem& item : s.drawItems) {
        if (item.object != event.object) continue;
        item.variant =
            surfaceVariant(object.materials[item.material], item.image != 0, looksBurnt(object));
        item.draw = drawOf(s, object, item.material);
    }
}

// Burnt pieces that lost their hold: a part of all tiles each frame, in turn.
void recordFalling(VkBackend::State& s, const FramePlan& plan, bool burning,
                   FrameRecorder& recorder) {
    constexpr uint32_t kMostTiles = 16384;
    if (burning) {
        float latest = 0;
        for (const ObjectEntry& object : s.objects) {
            if (!object.live || !object.touched) continue;
            for (const BurnMaterial& material : object.materials)
                if (material.holeTicks) latest = std::max(latest, material.baseColor.w);
        }
        // After the last flame: until all is gone, and as long as it takes to notice.
        s.supportUntil = plan.endTick + uint32_t(1.2f * latest) + 16 * kTicksPerSecond;
        if (latest == 0) return;
    }
    const uint32_t tiles = s.planes.capacity(kSpaceObjectTiles);
    const uint32_t parts = std::max((tiles + kMostTiles - 1) / kMostTiles, 1u);
    const uint32_t first = s.supportFirst < tiles ? s.supportFirst : 0;
    const uint32_t count = std::min(tiles - first, kMostTiles);
    s.supportFirst = first + count;
    const auto ticks = uint32_t(plan.steps.size()) * kStepTicks * parts;
    if (count) recordSupport(recorder, plan.endTick, ticks, first, count);
}

// Soot above this frame's flames: a part of all tiles each frame, in turn.
void recordSooting(VkBackend::State& s, FrameRecorder& recorder) {
    constexpr uint32_t kMostTiles = 1024;
    const uint32_t tiles = s.planes.capacity(kSpaceObjectTiles);
    const uint32_t parts = std::max((tiles + kMostTiles - 1) / kMostTiles, 1u);
    const uint32_t first = s.sootFirst < tiles ? s.sootFirst : 0;
    const uint32_t count = std::min(tiles - first, kMostTiles);
    const uint32_t ticks = std::min(s.open.endTick - s.sootTick, kTicksPerSecond);
    s.sootTick = s.open.endTick;
    if (count == 0 || ticks == 0) return;
    s.sootFirst = first + count;
    recordSoot(recorder, ticks * parts, first, count);
}

// A host's vertex buffer into our plane, and from there to what is drawn.
void recordGiven(VkBackend::State& s, FrameRecorder& recorder, const ObjectEntry& object,
                 const Skin& skin) {
    const Table& vk = s.device.table;
    const FwVulkanVertices& from = skin.given;
    const uint64_t bytes = uint64_t(skin.words.units) * 4;
    const uint64_t last = from.normalOffset ? uint64_t(from.normalOffset) + 12 : 12;
    const uint64_t used = uint64_t(from.vertexCount - 1) * from.stride + last;
    auto barrier = typed<VkBufferMemoryBarrier>(VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER);
    barrier.srcAccessMask = from.accessBefore;
    barrier.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.buffer = from.buffer;
    barrier.offset = from.offset;
    barrier.size = used;
    const VkPipelineStageFlags before =
        from.stageBefore ? from.stageBefore
                         : VkPipelineStageFlags(VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT);
    vk.CmdPipelineBarrier(s.open.commands, before, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 1,
                          &barrier, 0, nullptr);
    const Use uses[] = {{FW_BIND_SKIN_GIVEN, Access::copyWrite}};
    s.barriers.use(vk, s.open.commands, uses);
    const VkBufferCopy copy{from.offset, uint64_t(skin.words.first) * 4, std::min(used, bytes)};
    vk.CmdCopyBuffer(s.open.commands, from.buffer, s.planes.buffer(FW_BIND_SKIN_GIVEN).handle, 1,
                     &copy);
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
    barrier.dstAccessMask = from.accessAfter;
    const VkPipelineStageFlags after =
        from.stageAfter ? from.stageAfter
                        : VkPipelineStageFlags(VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT);
    vk.CmdPipelineBarrier(s.open.commands, VK_PIPELINE_STAGE_TRANSFER_BIT, after, 0, 0, nullptr, 1,
                          &barrier, 0, nullptr);
    SkinPush push{};
    push.count = object.deform.vertexCount;
    push.sourceBase = s.meshes[object.mesh].skinSources.first;
    push.shownBase = object.shown.first;
    push.given = skin.words.first;
    push.stride = from.stride / 4;
    push.normal = from.normalOffset ? from.normalOffset / 4 : kNoneTexel;
    push.scaleX = std::bit_cast<uint32_t>(object.shape[0]);
    push.scaleY = std::bit_cast<uint32_t>(object.shape[1]);
    push.scaleZ = std::bit_cast<uint32_t>(object.shape[2]);
    recordSkin(recorder, push);
}

// Vertices as hosts have moved them.
void recordSkins(VkBackend::State& s, FrameRecorder& recorder, UploadWriter& writer) {
    for (const ObjectEntry& object : s.objects) {
        if (!object.live || !object.skinPlus1) continue;
        Skin& skin = s.skins[object.skinPlus1 - 1];
        if (skin.givenDue) recordGiven(s, recorder, object, skin);
        skin.givenDue = false;
        if (!skin.dirty) continue;
        const Staged staged = writer.write(std::span<const ShownVertex>(skin.shown));
        recorder.copyIn(staged.at, FW_BIND_SHOWN,
                        uint64_t(object.shown.first) * sizeof(ShownVertex),
                        skin.shown.size() * sizeof(ShownVertex));
        skin.dirty = false;
    }
}

// What deforms in this frame, in the order of DeformRecord; `steps`: that it moves by.
Staged writeDeformGroups(VkBackend::State& s, uint32_t steps, UploadWriter& writer) {
    Staged staged = writer.begin();
    const auto append = [&](const ObjectEntry& object, uint32_t items, bool recede = false) {
        const uint32_t marks =
            (object.deformReset ? kDeformReset : 0) | (object.softOdd ? kDeformOdd : 0);
        for (uint32_t first = 0; first < items; first += kDeformGroup) {
            if (recede && !recedes(object, first / kDeformGroup)) continue;
            const WakeGroup group{object.deformer.first, first | marks};
            writer.append(staged, std::span<const WakeGroup>(&group, 1));
        }
    };
    for (const uint32_t tier : {~0u, kDeformShell, kDeformSprings})
        for (const ObjectEntry& object : s.objects)
            if (object.deformsNow && !object.skinPlus1 &&
                (tier == ~0u || (object.deform.flags & tier)))
                append(object, object.deform.nodeCount, tier == ~0u);
    for (ObjectEntry& object : s.objects) {
        if (!object.deformsNow) continue;
        append(object, object.deform.vertexCount);
        object.deformReset = false;
        object.recedeOdd = !object.recedeOdd;
        if (object.soft.units) object.softOdd ^= (steps & 1) != 0;
    }
    writer.end();
    return staged;
}

}  // namespace

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
    target.planes = &planes;
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
                   FrameRing::kMaxViews);
    ViewInput input;
    input.view = &view;
    input.viewport[0] = viewport.x;
    input.viewport[1] = viewport.y;
    input.viewport[2] = viewport.width;
    input.viewport[3] = viewport.height;
    input.now = shownTick;
    input.tickFraction = tickFraction;
    for (int i = 0; i < 3; ++i) {
        input.wind[i] = wind[i];
        input.up[i] = limits.up[i];
    }
    input.paceFactor = limits.paceFactor;
    input.lightCount = limits.maxLights;
    input.flameCapacity = std::min(limits.maxFlames, kFlameCapacity);
    input.seed = limits.seed;
    ViewParams params{};
    if (limits.looks.viewParams) limits.looks.viewParams(input, params);
    const uint32_t offset = (ring.indexOf(slot) * FrameRing::kMaxViews + slot.views) * viewStride;
    std::memcpy(views.mapped + offset, &params, sizeof params);
    ++slot.views;
    return offset;
}

void VkBackend::State::run(const FramePlan& plan) {
    if (!open.open || open.ran)
        core::fail(FW_ERROR_INTERNAL, "A frame's plan is run once, after the frame is begun.");
    const FrameNeeds needs = needsOf(*this, plan);
    open.planFrame = plan.frameIndex;
    open.endTick = plan.endTick;
    open.readback = needs.readback;
    std::copy(std::begin(plan.wind), std::end(plan.wind), std::begin(wind));
    tickFraction = plan.tickFraction;
    // Sheets and springs step at a rate of their own; a hitch drops steps and never stretches one.
    const double ticks = double(plan.endTick) + double(plan.tickFraction) * kStepTicks;
    const auto softNow = uint64_t(ticks / kSoftTicks);
    const auto softSteps =
        uint32_t(std::min<uint64_t>(softNow > softStep ? softNow - softStep : 0, kMostSoftSteps));
    softStep = softNow;
    if (!needs.work) {
        open.ran = true;
        shownTick = plan.endTick;
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
    const Table& vk = device.table;
    open.ran = true;
    open.slot = &slot;
    open.recording = true;
    barriers.begin(vk, open.commands);
    slot.timers.reset(device, open.commands);
    FrameRecorder recorder(recordTarget(slot, open.commands));
    UploadWriter writer(slot);
    if (planes.recordMoves(vk, open.commands, open.ringFrame))
        barriers.begin(vk, open.commands);  // rare: waits for all of the moves
    if (!initialized) {
        for (const uint32_t resource :
             {FW_BIND_COUNTERS, FW_BIND_OBJECT_COUNTERS, FW_BIND_LIGHTS, FW_BIND_LIGHT_CELLS,
              FW_BIND_DRAW_ARGS, FW_BIND_OBJECTS, FW_BIND_REFINE_OBJECTS, FW_BIND_REMOTE_OBJECTS})
            recorder.fillZero(resource, 0, VK_WHOLE_SIZE);
        initialized = true;
    }
    recordUploads(*this);
    if (recordsDirty) recordObjects(*this, recorder, writer);
    recordForgetting(*this, recorder);
    drawVertices = planes.buffer(kResourceVertices).handle;
    drawIndices = planes.buffer(kResourceIndices).handle;
    drawShown = planes.buffer(FW_BIND_SHOWN).handle;
    if (needs.skins) recordSkins(*this, recorder, writer);

    if (needs.iterations) recordCounters(recorder, lists, uint32_t(needs.iterations));
    slot.layout.firstRow = lists.row;
    bool iterates = !frontEmpty || needs.dense || needs.never;
    for (const StepPlan& planned : plan.steps) {
        iterates |= bringsNews(planned) || (planned.exchange && !burnEmpty);
        StepRecord step;
        step.now = planned.now;
        step.stepShift = planned.substepShift;
        step.switches = plan.switches;
        step.objectSlots = uint32_t(objects.size());
        step.iterate = iterates;
        step.reduce = planned.reduce && needs.burning;
        step.heat = planned.heat && needs.heating;
        step.exchange = step.reduce && planned.exchange;
        step.governed = planned.governed;
        step.rules = planned.rules;
        if (planned.remote) recordRemote(*this, *planned.remote, recorder, writer);
        step.links = links;
        step.rules.blockers = blockers;
        recordMaterials(*this, planned.materials, recorder, writer);
        const bool findsAnew = needs.findsAnew && &planned == plan.steps.data();
        step.wakeGroups = writeWakeGroups(*this, planned.materials, needs.dense, findsAnew, writer);
        step.events = writer.write(planned.events);
        for (const TexelEvent& event : planned.events) noteEvent(*this, event);
        if (needs.publishedRuns) {
            for (PublishedStep& one : published) {
                one.parity = objects[one.object].publishedParity;
                objects[one.object].publishedParity ^= 1;
            }
            step.published = published;
        }
        recordStep(recorder, lists, step);
        frontWalks += step.iterate ? 1 : 0;
        burnWalks += step.reduce ? 1 : 0;
        hotWalks += step.heat ? 1 : 0;
    }
    slot.layout.rows = lists.row;
    slot.layout.burnParity = lists.burnParity;
    slot.layout.hotParity = lists.hotParity;
    if (needs.stimulus) {
        lastStimulus = open.ringFrame;
        frontEmpty = burnEmpty = predictEmpty = hotEmpty = false;
    }
    shownTick = plan.endTick;
    if (needs.predicting) {
        // A ring a round: long frames need more to stay ahead of a fast front.
        const size_t rounds = std::clamp<size_t>(plan.steps.size() * 2, 2, 9) - 1;
        for (size_t i = 0; i < rounds; ++i) recordPredict(recorder, lists, plan.endTick);
        predictWalks += uint32_t(rounds);
    }
    if (needs.falling) recordFalling(*this, plan, needs.burning, recorder);
    slot.layout.predictParity = lists.predictParity;
    if (needs.vertexGroups) {
        DeformRecord deform;
        deform.nodeGroups = needs.nodeGroups;
        deform.sheetGroups = needs.sheetGroups;
        deform.springGroups = needs.springGroups;
        deform.steps = softSteps;
        deform.vertexGroups = needs.vertexGroups;
        deform.groups = writeDeformGroups(*this, softSteps, writer);
        deform.push.now = plan.endTick;
        deform.push.step = float(kSoftTicks) / float(kTicksPerSecond);
        deform.push.wind = {wind[0], wind[1], wind[2],
                            float(softStep % (4096 * 128)) * deform.push.step};
        deform.push.up = {limits.up[0], limits.up[1], limits.up[2],
                          tickFraction * float(kStepTicks)};
        recordDeform(recorder, deform);
    }
    if (!plan.probes.empty()) recordProbes(recorder, writer.write(plan.probes));
}

void VkBackend::State::closeFrame(const FwView* view) {
    if (!open.recording) {
        open = {};
        return;
    }
    const Table& vk = device.table;
    FrameInFlight& slot = *open.slot;
    RecordTarget target = recordTarget(slot, open.commands);
    if (!burnEmpty && limits.looks.viewParams) {
        // A step of an own device has no view: lights alone, which flicker with simulated time.
        FwView none{};
        none.time = float(double(open.endTick) / kTicksPerSecond);
        const VkViewport whole{0, 0, 1, 1, 0, 1};
        target.viewOffset = pushView(slot, view ? *view : none, whole);
        FrameRecorder looks(target);
        recordLights(looks, lists, open.endTick);
        recordSooting(*this, looks);
        if (view) recordFlameQuads(looks, lists, open.endTick);
    }
    if (view)
        recordRefinement(slot, *view);
    else
        showRefined();
    FrameRecorder recorder(target);
    if (open.readback && open.planFrame) {
        const ReadbackLayout& layout = slot.layout;
        // Counters before the lists: rows that this frame used, and the one its list ended in.
        recorder.copyOut(FW_BIND_COUNTERS, 0, layout.countersAt,
                         uint64_t(layout.rows + 1) * sizeof(IterationCounters));
        if (layout.objects)
            recorder.copyOut(FW_BIND_OBJECT_COUNTERS, 0, layout.objectsAt,
                             layout.objects * sizeof(ObjectCounters));
        if (layout.answers)
            recorder.copyOut(FW_BIND_ANSWERS, 0, layout.answersAt,
                             uint64_t(layout.answers) * sizeof(ProbeAnswer));
        if (layout.lights)
            recorder.copyOut(FW_BIND_LIGHTS, 0, layout.lightsAt,
                             uint64_t(layout.lights) * sizeof(BurnLight));
        recorder.copyOut(FW_BIND_DRAW_ARGS, 0, layout.flamesAt, 16);
        for (uint32_t i = 0; i < layout.mapCount; ++i) {
            const ReadbackLayout::MapAt& map = layout.maps[i];
            const BurnObject& object = objects[map.object].record;
            recorder.copyOut(FW_BIND_STATE, uint64_t(object.stateBase) * 4, map.at,
                             uint64_t(map.texels) * 4);
            if (map.heat)
                recorder.copyOut(FW_BIND_HEAT, uint64_t(object.heatBase) * sizeof(uvec2),
                                 map.heatAt, uint64_t(map.texels) * sizeof(uvec2));
        }
        slot.readbackPending = true;
        PendingReadback one;
        one.ringFrame = open.ringFrame;
        one.slot = int32_t(ring.indexOf(slot));
        one.frameIndex = open.planFrame;
        one.endTick = open.endTick;
        pushPending(one);
    }
    barriers.end(vk, open.commands);
    open = {};
}

}  // namespace fw::gpu::vk
