// What moves vertices: which objects deform or are skinned in a frame, and what their passes are
// given.
#include "gpu/vk/frame_needs.h"

#include <algorithm>
#include <bit>

namespace fw::gpu::vk {
namespace {

// Does a group of its nodes learn in this frame what has burnt? Of a sheet, which moves by steps of
// its own, every other one; every fourth one where frames are short: fire takes seconds.
bool recedes(const VkBackend::State& s, const ObjectEntry& object, uint32_t group) noexcept {
    constexpr uint32_t kLongFrame = 4;  // steps
    const uint32_t turns = s.deforming.softSteps < kLongFrame ? 4 : 2;
    return (object.deform.flags & kDeformShell) == 0 || object.deforms.reset ||
           object.deforms.woke || (group - object.deforms.recedeTurn) % turns == 0;
}

constexpr uint64_t kSettleTicks = 12 * kTicksPerSecond;  // that a sheet may swing

uint32_t deformGroups(uint32_t items) noexcept { return (items + kDeformGroup - 1) / kDeformGroup; }

// Does it still move, as far as is known? What burns does, until the last texel that caught has
// burnt out.
bool deforms(const VkBackend::State& s, uint32_t slot, uint64_t now) noexcept {
    const ObjectEntry& object = s.scene.objects[slot];
    if (!object.live || object.shown.units == 0 || object.deforms.skinPlus1) return false;
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

// A host's vertex buffer into our buffer, and from there to what is drawn.
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
    push.sourceBase = s.scene.meshes[object.mesh].skinSources.first;
    push.shownBase = object.shown.first;
    push.given = skin.words.first;
    push.stride = from.stride / 4;
    push.normal = from.normalOffset ? from.normalOffset / 4 : kNoneTexel;
    push.scaleX = std::bit_cast<uint32_t>(object.shape[0] * skin.metersPerUnit);
    push.scaleY = std::bit_cast<uint32_t>(object.shape[1] * skin.metersPerUnit);
    push.scaleZ = std::bit_cast<uint32_t>(object.shape[2] * skin.metersPerUnit);
    recordSkin(recorder, push);
}

}  // namespace

void addDeformNeeds(VkBackend::State& s, uint32_t slot, uint64_t endTick, FrameNeeds& needs) {
    ObjectEntry& object = s.scene.objects[slot];
    if (object.soft.units && object.deforms.softUntil == 0)
        object.deforms.softUntil = endTick + kSettleTicks;
    object.deforms.woke = !object.deforms.now;
    object.deforms.now = deforms(s, slot, endTick);
    if (object.deforms.now) {
        const uint32_t groups = deformGroups(object.deform.nodeCount);
        for (uint32_t group = 0; group < groups; ++group)
            needs.deform.nodes += recedes(s, object, group) ? 1 : 0;
        if (object.deform.flags & kDeformShell) {
            needs.deform.sheets += groups;
            needs.sheetsBegin |= object.deforms.reset || object.deforms.woke;
        }
        if (object.deform.flags & kDeformSprings) needs.deform.springs += groups;
        needs.deform.vertices += deformGroups(object.deform.vertexCount);
        if (object.inner) needs.deform.inner += deformGroups(object.deform.vertexCount);
    }
    const Skin* moved =
        object.deforms.skinPlus1 ? &s.deforming.skins[object.deforms.skinPlus1 - 1] : nullptr;
    if (moved && (moved->dirty || moved->givenDue)) {
        const Skin& skin = *moved;
        needs.skins = true;
        if (skin.dirty) needs.uploadBytes += uploaded(skin.shown.size() * sizeof(ShownVertex));
        // Normals that the host does not give follow the triangles.
        object.deforms.now = !skin.normals;
        if (object.deforms.now) needs.deform.vertices += deformGroups(object.deform.vertexCount);
    }
}

void recordSkins(VkBackend::State& s, FrameRecorder& recorder, UploadWriter& writer) {
    for (const uint32_t i : s.scene.awake) {
        const ObjectEntry& object = s.scene.objects[i];
        if (!object.live || !object.deforms.skinPlus1) continue;
        Skin& skin = s.deforming.skins[object.deforms.skinPlus1 - 1];
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

Staged writeDeformGroups(VkBackend::State& s, UploadWriter& writer) {
    Staged staged = writer.begin();
    const auto append = [&](const ObjectEntry& object, uint32_t items, bool recede = false) {
        const uint32_t marks = (object.deforms.reset ? kDeformReset : 0) |
                               (object.deforms.softOdd ? kDeformOdd : 0) |
                               (object.deforms.woke ? kDeformWoke : 0) |
                               ((s.crossing & kSwitchCrossing) ? kDeformCrosses : 0);
        for (uint32_t first = 0; first < items; first += kDeformGroup) {
            if (recede && !recedes(s, object, first / kDeformGroup)) continue;
            const WakeGroup group{object.deforms.range.first, first | marks};
            writer.append(staged, std::span<const WakeGroup>(&group, 1));
        }
    };
    for (const uint32_t tier : {~0u, kDeformShell, kDeformSprings})
        for (const uint32_t i : s.scene.awake)
            if (const ObjectEntry& object = s.scene.objects[i];
                object.deforms.now && !object.deforms.skinPlus1 &&
                (tier == ~0u || (object.deform.flags & tier)))
                append(object, object.deform.nodeCount, tier == ~0u);
    for (const uint32_t i : s.scene.awake)
        if (s.scene.objects[i].deforms.now)
            append(s.scene.objects[i], s.scene.objects[i].deform.vertexCount);
    for (const uint32_t i : s.scene.awake) {
        ObjectEntry& object = s.scene.objects[i];
        if (!object.deforms.now) continue;
        if (object.inner) append(object, object.deform.vertexCount);
        object.deforms.reset = false;
        ++object.deforms.recedeTurn;
        if (object.soft.units) object.deforms.softOdd ^= (s.deforming.softSteps & 1) != 0;
    }
    writer.end();
    return staged;
}

}  // namespace fw::gpu::vk
