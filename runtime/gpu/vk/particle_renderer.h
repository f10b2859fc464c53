// Fire emitters' particles and sparks, and the quads that show them and burning tiles.
#pragma once
#include "gpu/vk/frame.h"

namespace fw::gpu::vk {

struct BackendState;

struct ParticleRenderer {
    explicit ParticleRenderer(float lights) : lightCount(lights) {}
    // Space for the frame's emitters, their particles and quads. May throw.
    void makeRoom(BackendState& s, const EmitterUpdate& update, uint64_t last);
    void record(const EmitterUpdate& update, FrameRecorder& recorder);
    [[nodiscard]] bool shows() const noexcept { return emitterGroups > 0 || sparkSources > 0; }
    // Flipbooks show all quads but sparks.
    [[nodiscard]] bool onlyFlipbooks(const BackendState& s) const noexcept;
    [[nodiscard]] SortPush quadRoom(const BackendState& s) const noexcept;

    float lightCount;            // on its way to detail's; its fraction is the last one's share
    float quadShare = 1;         // on its way to detail's
    uint32_t quadsShown = 0;     // by the last view whose readback came
    vec3 particlesMove{0.0f};    // m, with the next dispatch that moves particles
    uint32_t emitterGroups = 0;  // of the dispatch that moves particles; 0: there are none
    bool particlesByFlipbook = false;  // flipbooks show all fire and smoke of them
    uint32_t sparkSources = 0;         // that throw sparks
    float lightShare = 0.0f;           // of particles' quads: those that emit alone, [0, 1]
    bool emittersMove = false;         // in the open frame
    uint32_t flameFlipbooks = 0;       // as setTileFlipbooks has them
};

}  // namespace fw::gpu::vk
