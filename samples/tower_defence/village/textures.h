// Procedural surfaces as pure functions of metres on the unwrapped surface, V along the grain. A
// host bakes them into images.
#pragma once

#include "model.h"

namespace village {

struct Surface {
    Vec3 albedo;       // linear
    float height = 0;  // m above the face, for bumps
    float roughness = 0.85f;
    float metalness = 0;
    float heat = 0;  // coals only: heat of the lump, about [-0.4, 1.25]
};

// footprint: m, side of a texel; finer detail fades out. seed: varies the broad weathering.
Surface paintSurface(Texture texture, Vec2 metres, float footprint, Vec3 tint, uint32_t seed);

// Composition of the ground; each in [0, 1].
struct Splat {
    float dirt = 0, dry = 0, field = 0, mud = 0;
};
// Grass, dry grass, dirt and stubble at a position in world metres (x, z).
Surface paintGround(Vec2 place, float footprint, const Splat& splat);

}  // namespace village
