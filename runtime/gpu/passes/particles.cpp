// Particles of all fire emitters: births and motion; and the quads that show them, and sparks, to
// the frame's view, drawn with the flames of burning meshes: one order, one draw.
#include "gpu/passes/frame_graph.h"
#include "shared/spark.h"

namespace fw::gpu {
namespace {

constexpr Use kParticlesUses[] = {
    {FW_BIND_EMITTERS, Access::read},        {FW_BIND_EMITTER_GROUPS, Access::read},
    {FW_BIND_PARTICLES, Access::readTexels}, {FW_BIND_PARTICLES, Access::write},
    {FW_BIND_COUNTERS, Access::read},        {FW_BIND_BURN_TILES, Access::read},
};
constexpr Use kQuadUses[] = {
    {FW_BIND_EMITTERS, Access::read},        {FW_BIND_EMITTER_GROUPS, Access::read},
    {FW_BIND_PARTICLES, Access::readTexels}, {FW_BIND_FLAMES, Access::write},
    {FW_BIND_DRAW_ARGS, Access::write},      {FW_BIND_VIEW, Access::uniformView},
    {FW_BIND_BOOKS, Access::read},
};

constexpr Use kSparkUses[] = {
    {FW_BIND_SPARKS, Access::read},      {FW_BIND_SPARKS, Access::readTexels},
    {FW_BIND_COUNTERS, Access::read},    {FW_BIND_BURN_TILES, Access::read},
    {FW_BIND_FLAMES, Access::write},     {FW_BIND_DRAW_ARGS, Access::write},
    {FW_BIND_VIEW, Access::uniformView},
};

}  // namespace

const ComputePass kParticlesPass{"particles", "particles.comp", kParticlesUses,
                                 sizeof(ParticlePush), "particles_texels.comp"};
const ComputePass kParticleQuadsPass{"particle quads", "particle_quads.comp", kQuadUses,
                                     sizeof(ParticlePush), "particle_quads_texels.comp"};
const ComputePass kSparksPass{"sparks", "sparks.comp", kSparkUses, sizeof(SparkPush),
                              "sparks_texels.comp"};

}  // namespace fw::gpu
