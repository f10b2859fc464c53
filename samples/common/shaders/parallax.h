// Parallax occlusion mapping: intersects rays with a relief below the drawn surface, shadows it,
// and ends it in a silhouette. Also compiles as C++ for its tests. The includer defines the relief:
//     float reliefDepth(vec2 at);  depth at a position on the picture, [0, 1] of the relief's depth
// Positions on the picture share one unit of the includer's choice.
#ifdef __cplusplus
#define RELIEF_FN inline
#define RELIEF_OUT(type) type&
#else
#define RELIEF_FN
#define RELIEF_OUT(type) out type
#endif

struct ReliefRay {
    vec2 at;      // entry point
    vec2 along;   // movement on the picture per m of ray
    float depth;  // m below the surface at the entry point
    float down;   // m of depth per m of ray
    float sag;    // 1/m: the surface drops below its tangent by sag * distance^2; flat: 0
    float most;   // m of ray up to the border of the relief
};

// Returns m below the surface after `travel` m of ray.
RELIEF_FN float reliefBelow(ReliefRay ray, float travel) {
    return ray.depth + (ray.down - ray.sag * travel) * travel;
}

// Returns m of ray to the first of: the relief's bottom, the exit from a curved surface, the
// border. deepest: m.
RELIEF_FN float reliefEnd(ReliefRay ray, float deepest, RELIEF_OUT(bool) atBottom) {
    float travel = ray.most;
    atBottom = false;
    float half_ = 0.5f * ray.down;
    float leaves = half_ * half_ + ray.sag * ray.depth;             // of reliefBelow = 0: exit
    float sinks = half_ * half_ - ray.sag * (deepest - ray.depth);  // of reliefBelow = deepest:
                                                                    // bottom
    if (ray.sag > 1e-6f) {
        travel = min(travel, (half_ + sqrt(max(leaves, 0.0f))) / ray.sag);
    } else if (ray.down < 0.0f) {
        travel = min(travel, ray.depth / -ray.down);
    }
    if (ray.down > 0.0f && sinks >= 0.0f) {
        // Written as a division, so that a flat surface needs no special case.
        float bottom = (deepest - ray.depth) / (half_ + sqrt(sinks));
        atBottom = bottom <= travel;
        travel = min(travel, bottom);
    }
    return travel;
}

// Returns the number of layers: fewer from above, more at grazing angles, and at most two per
// crossed texel, since a picture has no detail between texels.
RELIEF_FN int reliefLayers(float down, float texels, float least, float most) {
    float layers = mix(most, least, clamp(down, 0.0f, 1.0f));
    return int(clamp(min(layers, 2.0f * texels + 1.0f), min(least, 4.0f), most));
}

// Returns m of ray to the relief, or a negative value for a miss. deepest: m. Layers find the first
// sample below the relief. Three secant steps refine it.
RELIEF_FN float reliefHit(ReliefRay ray, float deepest, int layers) {
    bool atBottom;
    float end = reliefEnd(ray, deepest, atBottom);
    float above = 0.0f, below = -1.0f;  // travel
    float gapAbove = reliefDepth(ray.at) * deepest - ray.depth, gapBelow = 0.0f;
    if (gapAbove <= 0.0f) return 0.0f;  // the ray enters inside the relief
    for (int i = 1; i <= layers && below < 0.0f; ++i) {
        float travel = end * float(i) / float(layers);
        float gap = reliefDepth(ray.at + ray.along * travel) * deepest - reliefBelow(ray, travel);
        bool under = gap <= 0.0f || (atBottom && i == layers);
        below = under ? travel : below;
        gapBelow = under ? min(gap, -1e-7f) : gapBelow;
        above = under ? above : travel;
        gapAbove = under ? gapAbove : gap;
    }
    if (below < 0.0f) return -1.0f;
    float hit = below;
    for (int i = 0; i < 3; ++i) {
        hit = mix(above, below, gapAbove / (gapAbove - gapBelow));
        float gap = reliefDepth(ray.at + ray.along * hit) * deepest - reliefBelow(ray, hit);
        bool under = gap <= 0.0f;
        below = under ? hit : below;
        gapBelow = under ? min(gap, -1e-7f) : gapBelow;
        above = under ? above : hit;
        gapAbove = under ? gapAbove : max(gap, 1e-7f);
    }
    return hit;
}

// Returns the share of a light that reaches a point `depth` m below the surface, [0, 1]. Near
// occluders cast harder shadows. along: movement on the picture per m towards the light; up: m of
// height per m. softness 1: a light about as wide as it is far.
RELIEF_FN float reliefLit(vec2 at, vec2 along, float up, float depth, float deepest, float softness,
                          int steps) {
    if (up <= 0.0f) return 0.0f;
    float out_ = depth / up, blocked = 0.0f;
    for (int i = 1; i <= steps; ++i) {
        float travel = out_ * (float(i) - 0.5f) / float(steps);
        float over = (depth - up * travel) - reliefDepth(at + along * travel) * deepest;
        blocked = max(blocked, over * softness / travel);
    }
    return out_ > 0.0f ? 1.0f - clamp(blocked, 0.0f, 1.0f) : 1.0f;
}

#ifdef RELIEF_CONES
// reliefHitByCones and its users need one more function from the includer:
//     vec2 reliefCone(vec2 at);  x: depth as reliefDepth; y: open cone, movement on the picture per
// m up

// A cone of twice the empty width seldom skips an obstacle.
const float kReliefRelaxed = 2.0f;
// The least step, as a share of the whole ray. Smaller steps would creep along a stone's edge and
// stop there.
const float kReliefLeast = 1.0f / 24.0f;

// As reliefHit, in few steps: each step ends at the side of the current cone (J. Dummer, Cone Step
// Mapping, 2006; F. Policarpo, M. Oliveira, Relaxed Cone Stepping, GPU Gems 3). Two secant steps
// refine the last one. The last reliefDepth call is within a hair of the hit.
RELIEF_FN float reliefHitByCones(ReliefRay ray, float deepest, int steps) {
    bool atBottom;
    float end = reliefEnd(ray, deepest, atBottom), aside = length(ray.along);
    vec2 here = reliefCone(ray.at);
    float travel = 0.0f, above = 0.0f, gap = here.x * deepest - ray.depth, gapAbove = gap;
    bool met = gap <= 0.0f, past = false;
    for (int i = 0; i < steps && !met && !past; ++i) {
        float falls = max(ray.down - 2.0f * ray.sag * travel, 0.0f), cone = kReliefRelaxed * here.y;
        above = travel;
        gapAbove = gap;
        travel =
            min(travel + max(cone * gap / (aside + cone * falls + 1e-6f), kReliefLeast * end), end);
        here = reliefCone(ray.at + ray.along * travel);
        gap = here.x * deepest - reliefBelow(ray, travel);
        met = gap <= 0.0f || (atBottom && travel >= end);
        past = !met && travel >= end;
    }
    float most = min(2.0f * travel - above, end);
    for (int i = 0; i < 2; ++i) {
        float nearer = gapAbove - gap, next = travel + (travel - above) * gap / max(nearer, 1e-7f);
        next = nearer > 1e-7f ? clamp(next, above, most) : travel;
        bool under = gap <= 0.0f;
        most = under ? travel : most;
        above = under ? above : travel;
        gapAbove = under ? gapAbove : gap;
        travel = next;
        if (i == 0)
            gap = reliefDepth(ray.at + ray.along * travel) * deepest - reliefBelow(ray, travel);
    }
    return past ? -1.0f : travel;
}

// Returns the share of a light that clears the horizon, [0, 1], as reliefLit finds it by marching.
// horizon: t / (1 + t) of its tangents t along u, along v and against them (N. Max, Horizon
// mapping, 1988). along, up: parts of the unit direction to the light.
RELIEF_FN float reliefLitByHorizon(vec4 horizon, vec2 along, float up, float softness) {
    vec4 parts = max(vec4(along, -along), vec4(0.0f));  // the squared components of a unit vector
                                                        // sum to 1
    float square = max(dot(along, along), 1e-8f), weighted = dot(parts * parts, horizon);
    float over = weighted / max(square - weighted, 0.02f * square) * sqrt(square) - up;
    return up > 0.0f ? 1.0f - clamp(over * softness, 0.0f, 1.0f) : 0.0f;
}
#endif
