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
