// Fire emitters on their way to the device, and room for their particles and quads.
#include "core/error.h"
#include "gpu/passes/blend_order.h"
#include "gpu/vk/frame_needs.h"
#include "shared/spark.h"

#include <algorithm>
#include <cmath>

namespace fw::gpu::vk {

uint32_t VkBackend::State::tileQuads() const noexcept {
    return std::clamp(limits.maxFlames, 1u, kFlameCapacity);
}

// Some particles show twice while fire turns to smoke; who finds no quad is not seen.
void VkBackend::State::makeEmitterRoom(const EmitterUpdate& update, uint64_t last) {
    particles.lightShare = 0.0f;
    if (update.count == 0 && update.sparkCount == 0) return;
    buffers.atLeast(kPoolParticles, update.particleEnd, last);
    buffers.atLeast(kPoolEmitters, update.count, last);
    buffers.atLeast(kPoolEmitterGroups, uint32_t(update.groups.size()), last);
    buffers.atLeast(kPoolSparks, update.sparkCount, last);
    const uint32_t tiles = tileQuads();
    const uint32_t hiding = update.particles + update.particles / 4 + 16;
    const uint32_t lights = update.sparkQuads + update.lightParticles;
    const uint32_t requested = hiding + lights;
    particles.lightShare = float(lights) / float(requested);
    // Who finds no quad is not seen, so that under a limit there is room for those that show:
    // a twelfth of them does in part (shownShare).
    const float share = detail.memory < 1 ? std::min(detail.quads * 13.0f / 12.0f, 1.0f) : 1.0f;
    const auto shown = uint32_t(float(requested) * share);
    buffers.fit(kPoolFlames, quadUnits(std::min(tiles + shown, kMaxQuads)), detail.memory < 1,
                last);
}

void recordEmitters(VkBackend::State& s, const EmitterUpdate& update, FrameRecorder& recorder,
                    UploadWriter& writer) {
    s.particles.emitterGroups = uint32_t(update.groups.size());
    s.particles.sparkSources = update.sparkCount;
    if (update.sparkCount > 0) {
        const std::span<const SparkSource> sparks(update.sparks, update.sparkCount);
        const Staged at = writer.write(sparks);
        recorder.copyIn(at.at, FW_BIND_SPARKS, 0, sparks.size_bytes());
    }
    if (update.count == 0) return;
    const std::span<const ParticleEmitter> emitters(update.records, update.count);
    s.particles.particlesByFlipbook =
        std::all_of(emitters.begin(), emitters.end(), [](const ParticleEmitter& emitter) {
            return emitter.fireFlipbooks != 0 &&
                   (emitter.smokeFlipbooks != 0 || emitter.life.w == 0);
        });
    const Staged records = writer.write(emitters);
    recorder.copyIn(records.at, FW_BIND_EMITTERS, 0, emitters.size_bytes());
    const Staged groups = writer.write(update.groups);
    recorder.copyIn(groups.at, FW_BIND_EMITTER_GROUPS, 0, update.groups.size_bytes());
}

bool VkBackend::State::onlyFlipbooks() const noexcept {
    const bool tiles = simulation.burnEmpty || ((particles.flameFlipbooks & 0xFFu) != 0 &&
                                                particles.flameFlipbooks >> 8 != 0);
    return scene.books.live && tiles &&
           (particles.emitterGroups == 0 || particles.particlesByFlipbook);
}

SortPush VkBackend::State::quadRoom() const noexcept {
    SortPush room{};
    room.tiles = tileQuads();
    const uint32_t all = std::min(buffers.capacity(kPoolFlames) - quadUnits(0), kMaxQuads);
    // What emits alone has places of its own; an emitter with more or fewer than requested has
    // both.
    const uint32_t behind = all - std::min(all, room.tiles);
    room.lights = std::min(uint32_t(std::ceil(float(behind) * particles.lightShare)), behind);
    room.particles = behind - room.lights;
    room.few = fewQuads(device.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU);
    return room;
}

}  // namespace fw::gpu::vk
