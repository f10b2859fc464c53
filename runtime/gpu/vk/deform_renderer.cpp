#include "gpu/vk/deform_renderer.h"

#include "gpu/vk/frame_needs.h"

#include <algorithm>
#include <bit>

namespace fw::gpu::vk {
namespace {

// Does a group of its particles learn in this frame what has burnt? Of a sheet, which moves by
// steps of its own, every other one; every fourth one where frames are short: fire takes seconds.
bool recedes(uint32_t softSteps, const ObjectEntry& object, uint32_t group) noexcept {
    constexpr uint32_t kLongFrame = 4;  // steps
    const uint32_t turns = softSteps < kLongFrame ? 4 : 2;
    return (object.deform.flags & kDeformShell) == 0 || object.deforms.reset ||
           object.deforms.woke || (group - object.deforms.recedeTurn) % turns == 0;
}

constexpr uint64_t kSettleTicks = 12 * kTicksPerSecond;  // that a sheet may swing

uint32_t deformGroups(uint32_t items) noexcept { return (items + kDeformGroup - 1) / kDeformGroup; }

// Does it still move, as far as is known? A burning object does, until the last texel that caught
// has burnt out.
bool deforms(const BackendState& s, uint32_t slot, uint64_t now) noexcept {
    const ObjectEntry& object = s.scene.objects[slot];
    if (!object.live || !object.shown || object.deforms.skinPlus1) return false;
    if (object.deforms.reset) return true;
    if (object.deform.flags & kDeformShell) {
        const bool wind = s.simulation.wind[0] != 0 || s.simulation.wind[1] != 0 ||
                          s.simulation.wind[2] != 0 || object.record.zoneWind != 0;
        const bool hidden = (object.record.flags & kObjectHidden) != 0;
        if (!hidden && (wind || now <= object.deforms.softUntil)) return true;
    }
    if (!object.burn.touched) return false;
    uint64_t last = object.burn.lastEvent;
    if (slot < s.results.givenObjects.size())
        last = std::max<uint64_t>(last, s.results.givenObjects[slot].lastIgnition);
    return now <= last + object.deforms.ticks;
}

// Copies a host's vertex buffer into ours, and from there to the drawn vertices.
void recordGiven(BackendState& s, FrameRecorder& recorder, const ObjectEntry& object,
                 const Skin& skin) {
    const Table& vk = s.device.table;
    const FwVulkanVertices& from = skin.given;
    const uint64_t bytes = uint64_t(skin.words.units()) * 4;
    const uint64_t last = from.normalOffset ? uint64_t(from.normalOffset) + 12 : 12;
    const uint64_t used = uint64_t(from.vertexCount - 1) * from.stride + last;
    Typed<VkBufferMemoryBarrier> barrier;
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
    const VkBufferCopy copy{from.offset, uint64_t(skin.words.first()) * 4, std::min(used, bytes)};
    vk.CmdCopyBuffer(s.open.commands, from.buffer, s.buffers.buffer(FW_BIND_SKIN_GIVEN).handle, 1,
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
    push.sourceBase = s.scene.meshOf(object).skinSources.first();
    push.shownBase = object.shown.first();
    push.given = skin.words.first();
    push.stride = from.stride / 4;
    push.normal = from.normalOffset ? from.normalOffset / 4 : kNoneTexel;
    push.scaleX = std::bit_cast<uint32_t>(object.shape[0] * skin.metersPerUnit);
    push.scaleY = std::bit_cast<uint32_t>(object.shape[1] * skin.metersPerUnit);
    push.scaleZ = std::bit_cast<uint32_t>(object.shape[2] * skin.metersPerUnit);
    recordSkin(recorder, push);
}

}  // namespace

Skin& DeformRenderer::skinOf(const ObjectEntry& object) noexcept {
    FW_ASSERT(object.deforms.skinPlus1 > 0 && object.deforms.skinPlus1 <= skins.size(),
              "skin %u of %zu", object.deforms.skinPlus1, skins.size());
    return skins[object.deforms.skinPlus1 - 1];
}

// A hitch drops steps and never stretches one.
void DeformRenderer::advance(double ticks) noexcept {
    const auto now = uint64_t(ticks / kSoftTicks);
    softSteps = uint32_t(std::min<uint64_t>(now > softStep ? now - softStep : 0, kMaxSoftSteps));
    softStep = now;
}

void DeformRenderer::addNeeds(BackendState& s, uint32_t slot, uint64_t endTick,
                              FrameNeeds& needs) const {
    ObjectEntry& object = s.scene.objects[slot];
    const uint32_t vertexGroups = deformGroups(object.deform.vertexCount);
    if (object.soft && object.deforms.softUntil == 0)
        object.deforms.softUntil = endTick + kSettleTicks;
    object.deforms.woke = !object.deforms.now;
    object.deforms.now = deforms(s, slot, endTick);
    if (object.deforms.now) {
        const uint32_t groups = deformGroups(object.deform.particleCount);
        for (uint32_t group = 0; group < groups; ++group)
            needs.deform.nodes += recedes(softSteps, object, group) ? 1 : 0;
        if (object.deform.flags & kDeformShell) {
            needs.deform.sheets += groups;
            needs.sheetsBegin |= object.deforms.reset || object.deforms.woke;
        }
        if (object.deform.flags & kDeformExtended) needs.deform.extended += groups;
        needs.deform.vertices += vertexGroups;
        if (object.inner) needs.deform.inner += vertexGroups;
    }
    if (!object.deforms.skinPlus1) return;
    const Skin& skin = s.deforming.skinOf(object);
    if (!skin.dirty && !skin.givenDue) return;
    needs.skins = true;
    if (skin.dirty) needs.uploadBytes += uploaded(skin.shown.size() * sizeof(ShownVertex));
    // Normals that the host does not give follow the triangles.
    object.deforms.now = !skin.normals;
    if (object.deforms.now) needs.deform.vertices += vertexGroups;
}

void DeformRenderer::recordSkins(BackendState& s, FrameRecorder& recorder) {
    for (const uint32_t i : s.scene.awake) {
        const ObjectEntry& object = s.scene.objects[i];
        if (!object.live || !object.deforms.skinPlus1) continue;
        Skin& skin = skinOf(object);
        if (skin.givenDue) recordGiven(s, recorder, object, skin);
        if (skin.dirty)
            recorder.upload(FW_BIND_SHOWN, uint64_t(object.shown.first()) * sizeof(ShownVertex),
                            std::span<const ShownVertex>(skin.shown));
        skin.givenDue = skin.dirty = false;
    }
}

// The groups, in the order of DeformRecord.
Staged DeformRenderer::stageGroups(BackendState& s, FrameRecorder& recorder) const {
    Staged staged = recorder.beginStaged();
    const auto append = [&](const ObjectEntry& object, uint32_t items, bool recede = false) {
        const uint32_t marks = (object.deforms.reset ? kDeformReset : 0) |
                               (object.deforms.softOdd ? kDeformOdd : 0) |
                               (object.deforms.woke ? kDeformWoke : 0) |
                               ((s.crossing & kSwitchCrossing) ? kDeformCrosses : 0);
        for (uint32_t first = 0; first < items; first += kDeformGroup)
            if (!recede || recedes(softSteps, object, first / kDeformGroup))
                recorder.appendOne(staged, WakeGroup{object.deforms.range.first(), first | marks});
    };
    for (const uint32_t tier : {~0u, kDeformShell, kDeformExtended})
        for (const uint32_t i : s.scene.awake)
            if (const ObjectEntry& object = s.scene.objects[i];
                object.deforms.now && !object.deforms.skinPlus1 &&
                (tier == ~0u || (object.deform.flags & tier)))
                append(object, object.deform.particleCount, tier == ~0u);
    for (const uint32_t i : s.scene.awake)
        if (s.scene.objects[i].deforms.now)
            append(s.scene.objects[i], s.scene.objects[i].deform.vertexCount);
    for (const uint32_t i : s.scene.awake) {
        ObjectEntry& object = s.scene.objects[i];
        if (!object.deforms.now) continue;
        if (object.inner) append(object, object.deform.vertexCount);
        object.deforms.reset = false;
        ++object.deforms.recedeTurn;
        if (object.soft) object.deforms.softOdd ^= (softSteps & 1) != 0;
    }
    recorder.endStaged();
    return staged;
}

void DeformRenderer::record(BackendState& s, const FrameNeeds& needs, FrameRecorder& recorder) {
    DeformRecord deform;
    deform.count = needs.deform;
    deform.steps = softSteps;
    deform.bendSet = bendSet;
    deform.begins = needs.sheetsBegin;
    bendSet = (bendSet + softSteps) % kBendSets;
    if (needs.deform.vertices == 0) return;
    deform.groups = stageGroups(s, recorder);
    FW_ASSERT(deform.groups.count >= needs.deform.all(), "%u groups of %u", deform.groups.count,
              needs.deform.all());
    DeformPush& push = deform.push;
    push.now = s.open.endTick;
    push.step = float(kSoftTicks) / float(kTicksPerSecond);
    push.wind = {s.simulation.wind[0], s.simulation.wind[1], s.simulation.wind[2],
                 float(softStep % (4096 * 128)) * push.step};
    push.up = {s.limits.up[0], s.limits.up[1], s.limits.up[2],
               s.simulation.tickFraction * float(kStepTicks)};
    recordDeformation(recorder, deform);
}

}  // namespace fw::gpu::vk
