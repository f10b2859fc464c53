#include "gpu/vk/particle_renderer.h"

#include "gpu/passes/blend_order.h"
#include "gpu/vk/backend_state.h"
#include "shared/spark.h"

#include <algorithm>
#include <cmath>

namespace fw::gpu::vk {
namespace {

uint32_t tileQuads(const WorldLimits& limits) noexcept {
    return std::clamp(limits.maxFlames, 1u, kFlameCapacity);
}

}  // namespace

// Some particles show twice while fire turns to smoke. A particle that finds no quad is not drawn.
void ParticleRenderer::makeRoom(BackendState& s, const EmitterUpdate& update, uint64_t last) {
    lightShare = 0.0f;
    if (update.count == 0 && update.sparkCount == 0) return;
    s.buffers.atLeast(kPoolParticles, update.particleEnd, last);
    s.buffers.atLeast(kPoolEmitters, update.count, last);
    s.buffers.atLeast(kPoolEmitterGroups, uint32_t(update.groups.size()), last);
    s.buffers.atLeast(kPoolSparks, update.sparkCount, last);
    const uint32_t hiding = update.particles + update.particles / 4 + 16;
    const uint32_t lights = update.sparkQuads + update.lightParticles;
    const uint32_t requested = hiding + lights;
    lightShare = float(lights) / float(requested);
    // Under a limit there is space for the particles that show: a twelfth of them does in part
    // (shownShare).
    const bool limited = s.detail.memory < 1;
    const float share = limited ? std::min(s.detail.quads * 13.0f / 12.0f, 1.0f) : 1.0f;
    const auto shown = uint32_t(float(requested) * share);
    s.buffers.fit(kPoolFlames, quadUnits(std::min(tileQuads(s.limits) + shown, kMaxQuads)), limited,
                  last);
}

void ParticleRenderer::record(const EmitterUpdate& update, FrameRecorder& recorder) {
    emitterGroups = uint32_t(update.groups.size());
    sparkSources = update.sparkCount;
    recorder.upload(FW_BIND_SPARKS, 0,
                    std::span<const SparkSource>(update.sparks, update.sparkCount));
    if (update.count == 0) return;
    const std::span<const ParticleEmitter> emitters(update.records, update.count);
    particlesByFlipbook =
        std::all_of(emitters.begin(), emitters.end(), [](const ParticleEmitter& emitter) {
            return emitter.fireFlipbooks != 0 &&
                   (emitter.smokeFlipbooks != 0 || emitter.life.w == 0);
        });
    recorder.upload(FW_BIND_EMITTERS, 0, emitters);
    recorder.upload(FW_BIND_EMITTER_GROUPS, 0, update.groups);
}

bool ParticleRenderer::onlyFlipbooks(const BackendState& s) const noexcept {
    const bool tiles =
        s.simulation.burnEmpty || ((flameFlipbooks & 0xFFu) != 0 && flameFlipbooks >> 8 != 0);
    return s.scene.flipbooks.live && tiles && (emitterGroups == 0 || particlesByFlipbook);
}

SortPush ParticleRenderer::quadRoom(const BackendState& s) const noexcept {
    SortPush room{};
    room.tiles = tileQuads(s.limits);
    const uint32_t all = std::min(s.buffers.capacity(kPoolFlames) - quadUnits(0), kMaxQuads);
    // Particles that only emit have places of their own; an emitter with more or fewer than
    // requested has both.
    const uint32_t behind = all - std::min(all, room.tiles);
    room.lights = std::min(uint32_t(std::ceil(float(behind) * lightShare)), behind);
    room.particles = behind - room.lights;
    room.few = fewQuads(s.device.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU);
    return room;
}

}  // namespace fw::gpu::vk
