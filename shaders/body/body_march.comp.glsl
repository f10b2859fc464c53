// March of a burning object's body of fire: a sample in each slab that has gas. Kept slab by slab, as
// volumetric flames are.
#include "body/body.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
FW_READ_WRITE(VOLUME_RAYS)
layout(set = 1, binding = 0) uniform sampler2DArray profiles;
layout(push_constant) uniform Push { MarchPush march; };

#include "lib/colour.glsl"
#include "volume/ray.glsl"
#include "volume/slab_write.glsl"

const float kRoot3 = 1.7320508;  // half a uniform range over its spread
const float kDetail = 0.06;      // of that half, that a sample blurs

struct BodyPlace {
    float u, share, middle, spread, s, y;
    vec2 draw;
};

struct Node {
    vec4 a, b;
};
Node nodeAt(uint at) {
    return Node(vec4(unpackHalf2x16(rays[at]), unpackHalf2x16(rays[at + 1u])),
                vec4(unpackHalf2x16(rays[at + 2u]), unpackHalf2x16(rays[at + 3u])));
}
Node mixNodes(Node a, Node b, float part) { return Node(mix(a.a, b.a, part), mix(a.b, b.b, part)); }
// Means count by the gas that they are of.
BodyPlace placeAt(uint at, vec2 part) {
    Node n0 = nodeAt(at), n1 = nodeAt(at + kBodyNodeWords);
    Node n2 = nodeAt(at + 3u * kBodyNodeWords), n3 = nodeAt(at + 4u * kBodyNodeWords);
    vec4 w = vec4((1.0 - part.x) * (1.0 - part.y), part.x * (1.0 - part.y),
                  (1.0 - part.x) * part.y, part.x * part.y);
    float u = dot(w, vec4(n0.a.x, n1.a.x, n2.a.x, n3.a.x));
    w *= exp(clamp(vec4(n0.a.x, n1.a.x, n2.a.x, n3.a.x), -3.0, 3.0)) + 1e-4;
    w /= dot(w, vec4(1.0));
    vec4 a = w.x * n0.a + w.y * n1.a + w.z * n2.a + w.w * n3.a;
    vec4 b = w.x * n0.b + w.y * n1.b + w.z * n2.b + w.w * n3.b;
    return BodyPlace(u, a.y, a.z, a.w, b.x, b.y, b.zw);
}

// The medium at x, where most of the gas is. size: footprint of the sample, m.
FlameMedium bodyMedium(FlameRecord f, BodyPlace at, vec3 x, float size) {
    FlameMedium m = FlameMedium(0.0, 0.0, 0.5, vec3(0.0));
    float y = at.y, s = at.s;
    // 1 in the middle of the foot, 0 at the flame's surface.
    float v = at.u / max(at.u + kBodyFoot * y, 0.7);
    if (v < -1.1) return m;
    float grow = smoothstep(0.0, 0.5, y), root = sqrt(min(y, 1.0));
    vec3 across = acrossAxis(), up = view.up.xyz, ahead = cross(across, up);
    float h = max(s / max(y, 0.05), 0.02);
    vec3 wind = f.air.rgb;
    vec2 p = vec2(dot(x, across), dot(x, ahead)) -
             vec2(dot(wind, across), dot(wind, ahead)) * bodyLag(s, h) - at.draw * bodyEase(y);
    float z = (dot(x, up) - s + f.speed * flameTau(s, f.tauStart, f.tauFree)) / f.stretch;
    vec3 eddy = flameEddy(f, p, z);
    p += vec2(eddy.x, eddy.z) * (f.warp * f.lambdaWarp * grow);
    float vw = v + eddy.y * (0.25 * f.warp * grow);
    // Tongues of unequal height.
    float column = flameColumn(f, p, z);
    column = mix(column, 2.0 * (kFlameMeanAbs - abs(column)), 0.6);
    vw = 1.0 - (1.0 - vw) / max(0.3, 1.0 + f.columns * (column + 0.06) * smoothstep(0.0, 0.45, y));
    if (vw < -0.75) return m;
    FlameTurbulence noise = flameTurbulence(f, p, z, f.lambda / (2.0 * size));
    float vv = vw + f.turbulence * (0.25 + 0.75 * root) * smoothstep(0.0, 0.12, y) * noise.rough;
    float soot = smoothstep(0.0, 0.16, vv);
    float erode = f.erode * smoothstep(0.2, 1.2, 1.0 - v);
    soot = max(soot - erode, 0.0) / (1.0 - erode);
    soot *= smoothstep(0.0, 0.30, y + 0.10 * column + 0.05 * noise.rough);  // dark, then yellow
    float filament = flameFilament(f, noise.sheet, 0.7 * size / f.lambda, 1.0 - v);
    soot *= mix(1.0, f.filamentBase + (1.6 - f.filamentBase) * filament,
                f.filament * smoothstep(0.02, 0.25, y));
    m.soot = f.soot * soot;
    // Folds are cooler than sheets, or thick fire would be one flat yellow.
    float fold = (1.0 - min(filament, 1.0)) * smoothstep(0.05, 0.4, y);
    float cold = clamp(0.5 * (1.0 - vv) + 0.4 * min(y, 1.4) + 0.35 * fold, 0.0, 1.2);
    m.emission = m.soot * flameRadiance(f, mix(f.tintHigh, f.tintLow, cold));
    float rim = vv / 0.22 - 0.5;
    m.emission += f.blue * flameExp2(-1.442695 * rim * rim) * (1.0 - smoothstep(0.05, 0.22, y)) *
                  vec3(0.03, 0.12, 1.0);
    return m;
}

void main() {
    FlameRecord f = flame.record;
    uint zero = gl_GlobalInvocationID.x >> 31u;
    addZero(f, zero);
    uint tile = listedTile();
    uint slabs = march.slabs | zero, encoding = march.encoding | zero;
    uint row = quotient22(tile, march.tilesX);
    uvec2 in_ = gl_LocalInvocationID.xy;
    uvec2 place = uvec2(tile - row * march.tilesX, row) * kMarchTileSide + in_;
    uint pixel = place.y * (march.tilesX * kMarchTileSide) + place.x;
    place += uvec2(march.originX, march.originY);
    vec2 at_ = vec2(place);
    ViewRay ray = viewRay(march.rayO.xyz + at_.x * march.rayX.xyz + at_.y * march.rayY.xyz);
    vec3 white = flameWhite(f, view.sunColor.w);
    float deep = march.rayY.w * float(march.turns), footprint = march.rayX.w * ray.perMetre;
    vec2 grid = (vec2(in_) + 0.5) * 0.25;
    uvec2 cell = uvec2(grid);
    uint node = march.flames + kBodyWords +
                (tile * march.slabs * kBodyNodes + cell.y * 3u + cell.x) * kBodyNodeWords;
    vec2 part = grid - vec2(cell);
    FlameRay one = FlameRay(vec3(0.0), vec3(1.0));
    vec4 before = vec4(0.0);
    uint bits = 0u, s = 0u;
    // One sample where most of a slab's gas is. Loops of no turn cost a software device nothing,
    // branches not taken do.
    do {
        BodyPlace b = placeAt(node + s * kBodyNodes * kBodyNodeWords, part);
        nothing(s, pixel, 1.0 - before.a);
        uint lit = b.u > -2.0 && b.share > 0.003 ? 1u | zero : 0u;
        float depth = deep * (float(s) + 0.5) + b.middle, t = (march.rayO.w + depth) * ray.perDepth;
        float reach = kRoot3 * b.spread;
        while (lit > 0u) {
            FlameMedium m = bodyMedium(f, b, ray.from + ray.direction * t,
                                       max(kDetail * reach, footprint * t));
            m.soot *= b.share;
            m.emission *= b.share;
            one = flameStep(one, m, vec3(0.0), 2.0 * reach);
            // Where in the slab its light is: a uniform range of that spread.
            float inSlab = clamp(depth / deep - float(s), 0.0, 1.0);
            float wide = reach / (deep * ray.perDepth);
            vec3 where_ = vec3(1.0, inSlab, inSlab * inSlab + wide * wide / 3.0);
            vec4 shown = flameShown(one, vec3(0.0), white * view.sunDirection.w, encoding);
            bits |= shows(keep(before, shown, s, pixel, where_)) ? 1u << s : 0u;
            before = shown;
            lit = 0u;
        }
        s += 1u;
    } while (s < slabs);
    markTile(tile, in_, bits);
}
