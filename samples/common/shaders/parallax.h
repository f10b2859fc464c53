// Parallax occlusion mapping: where a ray meets a relief that lies below a drawn surface, what of
// a light gets down there, and where the relief ends in a silhouette. C++ too, for its tests.
// Whoever includes it says how deep the relief is:
//     float reliefDepth(vec2 at);  [0, 1] of the relief's depth, at a place on the picture
// Places on the picture are in any unit, the same in all that is said here.
#ifdef __cplusplus
#define RELIEF_FN inline
#define RELIEF_OUT(type) type&
#else
#define RELIEF_FN
#define RELIEF_OUT(type) out type
#endif

struct ReliefRay {
    vec2 at;      // where it enters
    vec2 along;   // how far it goes on the picture for each m of its way
    float depth;  // m below the surface where it enters
    float down;   // m deeper for each m of its way
    float sag;    // 1/m: the surface falls away below its tangent by sag * way^2; flat: 0
    float most;   // m of way: a border that the relief ends at
};

// m below the surface after `way`.
RELIEF_FN float reliefBelow(ReliefRay ray, float way) {
    return ray.depth + (ray.down - ray.sag * way) * way;
}

// m of way to the relief's bottom, to where the ray is out of a curved surface again, or to the
// border, whichever is first. deepest: m.
RELIEF_FN float reliefEnd(ReliefRay ray, float deepest, RELIEF_OUT(bool) atBottom) {
    float way = ray.most;
    atBottom = false;
    float half_ = 0.5f * ray.down;
    float leaves = half_ * half_ + ray.sag * ray.depth;             // of reliefBelow = 0
    float sinks = half_ * half_ - ray.sag * (deepest - ray.depth);  // of reliefBelow = deepest
    if (ray.sag > 1e-6f) {
        way = min(way, (half_ + sqrt(max(leaves, 0.0f))) / ray.sag);
    } else if (ray.down < 0.0f) {
        way = min(way, ray.depth / -ray.down);
    }
    if (ray.down > 0.0f && sinks >= 0.0f) {
        // (half - sqrt(sinks)) / sag, written so that a flat surface is no special case.
        float bottom = (deepest - ray.depth) / (half_ + sqrt(sinks));
        atBottom = bottom <= way;
        way = min(way, bottom);
    }
    return way;
}

// How many layers: fewer seen from above, more at a slant; never more than two for each texel that
// the ray crosses, for between texels a picture holds nothing.
RELIEF_FN int reliefLayers(float down, float texels, float least, float most) {
    float layers = mix(most, least, clamp(down, 0.0f, 1.0f));
    return int(clamp(min(layers, 2.0f * texels + 1.0f), min(least, 4.0f), most));
}

// m of way to the relief; negative: the ray passes it. deepest: m. Layers find the first one that
// the ray is under, three secant steps the place between it and the one before.
RELIEF_FN float reliefHit(ReliefRay ray, float deepest, int layers) {
    bool atBottom;
    float end = reliefEnd(ray, deepest, atBottom);
    float above = 0.0f, below = -1.0f;  // way
    float gapAbove = reliefDepth(ray.at) * deepest - ray.depth, gapBelow = 0.0f;
    if (gapAbove <= 0.0f) return 0.0f;  // it enters inside
    for (int i = 1; i <= layers && below < 0.0f; ++i) {
        float way = end * float(i) / float(layers);
        float gap = reliefDepth(ray.at + ray.along * way) * deepest - reliefBelow(ray, way);
        bool under = gap <= 0.0f || (atBottom && i == layers);
        below = under ? way : below;
        gapBelow = under ? min(gap, -1e-7f) : gapBelow;
        above = under ? above : way;
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

// [0, 1] of a light that reaches a place `depth` m below the surface: what stands between, the
// nearer the harder. along: on the picture for each m towards the light; up: m of height for the
// same; softness: 1 is a light about as wide as it is far.
RELIEF_FN float reliefLit(vec2 at, vec2 along, float up, float depth, float deepest, float softness,
                          int steps) {
    if (up <= 0.0f) return 0.0f;
    float out_ = depth / up, blocked = 0.0f;
    for (int i = 1; i <= steps; ++i) {
        float way = out_ * (float(i) - 0.5f) / float(steps);
        float over = (depth - up * way) - reliefDepth(at + along * way) * deepest;
        blocked = max(blocked, over * softness / way);
    }
    return out_ > 0.0f ? 1.0f - clamp(blocked, 0.0f, 1.0f) : 1.0f;
}

#ifdef RELIEF_CONES
// Whoever asks for these also says, of a place on the picture,
//     vec2 reliefCone(vec2 at);  its depth as above; and how far aside, on the picture, nothing
//                                stands in the open cone above it, for each m up

// Twice as wide as a cone that is empty is one that a ray seldom comes through something in.
const float kReliefRelaxed = 2.0f;
// Of the whole way: the least step. Past a stone's edge a ray would creep along it, and end there.
const float kReliefLeast = 1.0f / 24.0f;

// As reliefHit, in few steps: each goes to the side of the cone that the ray is in (J. Dummer, Cone
// Step Mapping, 2006; F. Policarpo, M. Oliveira, Relaxed Cone Stepping, GPU Gems 3). Two secant
// steps mend the last of them; reliefDepth is asked last where the relief is, but for a hair.
RELIEF_FN float reliefHitByCones(ReliefRay ray, float deepest, int steps) {
    bool atBottom;
    float end = reliefEnd(ray, deepest, atBottom), aside = length(ray.along);
    vec2 here = reliefCone(ray.at);
    float way = 0.0f, above = 0.0f, gap = here.x * deepest - ray.depth, gapAbove = gap;
    bool met = gap <= 0.0f, past = false;
    for (int i = 0; i < steps && !met && !past; ++i) {
        float falls = max(ray.down - 2.0f * ray.sag * way, 0.0f), cone = kReliefRelaxed * here.y;
        above = way;
        gapAbove = gap;
        way = min(way + max(cone * gap / (aside + cone * falls + 1e-6f), kReliefLeast * end), end);
        here = reliefCone(ray.at + ray.along * way);
        gap = here.x * deepest - reliefBelow(ray, way);
        met = gap <= 0.0f || (atBottom && way >= end);
        past = !met && way >= end;
    }
    float most = min(2.0f * way - above, end);
    for (int i = 0; i < 2; ++i) {
        float nearer = gapAbove - gap, next = way + (way - above) * gap / max(nearer, 1e-7f);
        next = nearer > 1e-7f ? clamp(next, above, most) : way;
        bool under = gap <= 0.0f;
        most = under ? way : most;
        above = under ? above : way;
        gapAbove = under ? gapAbove : gap;
        way = next;
        if (i == 0) gap = reliefDepth(ray.at + ray.along * way) * deepest - reliefBelow(ray, way);
    }
    return past ? -1.0f : way;
}

// [0, 1] of a light that reaches a place over its horizon, as reliefLit finds it step by step.
// horizon: t / (1 + t) of its tangents t, along u, along v and against them (N. Max, Horizon
// mapping, 1988). along, up: of the unit way to the light.
RELIEF_FN float reliefLitByHorizon(vec4 horizon, vec2 along, float up, float softness) {
    vec4 ways = max(vec4(along, -along), vec4(0.0f));  // squares of a unit way's parts are shares
    float square = max(dot(along, along), 1e-8f), told = dot(ways * ways, horizon);
    float over = told / max(square - told, 0.02f * square) * sqrt(square) - up;
    return up > 0.0f ? 1.0f - clamp(over * softness, 0.0f, 1.0f) : 0.0f;
}
#endif
