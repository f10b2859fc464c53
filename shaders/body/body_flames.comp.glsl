// The cells of a body to its flames, as this view sees them. Words of a flame: 0 foot, radius; 4
// normal, height; 8 draw, strength; 12 share; 13 1 if there is one; 16 march pixels of the view, low
// x, y, high x, y.
#include "lib/compute.glsl"
#include "body/body.glsl"
FW_READ(OBJECTS) FW_READ(BODIES) FW_READ(BODY_CELLS) FW_READ_WRITE(VOLUME_RAYS) FW_READ(APPEARANCES)
FW_PUSH(MarchPush)
#include "emitter/flame_laws.glsl"
#include "lib/turn.glsl"

struct BodyFlame {
    vec3 foot;     // m, world
    float radius;  // m
    vec3 normal;   // of the surface
    float height;  // m, of this flame alone
    vec3 draw;     // m, across up: where its neighbours draw its top
    float strength;  // 0 whole, -kBodyFoot out
    float share;   // of gas: more where it stands for many
};

uint wordsOf(uint cell) { return (push.body * kBodyCells + cell) * kBodyCellWords; }
vec3 placeOf(FlameBody body, uint at) {
    float weight = float(bodyCells[at]);
    vec3 sum = vec3(int(bodyCells[at + 1u]), int(bodyCells[at + 2u]), int(bodyCells[at + 3u]));
    return body.low.xyz + sum * (body.low.w / (float(kBodyCellUnits) * weight));
}
vec3 inWorld(BurnObject object, vec3 rest) {
    vec4 at = vec4(rest, 1.0);
    return vec3(dot(object.worldRow0, at), dot(object.worldRow1, at), dot(object.worldRow2, at));
}
// March pixels of the view.
vec2 marchPlace(vec3 at, out float away) {
    bool perspective = view.forward.w > 0.5;
    vec3 d = at - view.eye.xyz;
    away = dot(d, view.forward.xyz);
    vec3 q = (perspective ? d / max(away, 1e-3) : d - away * view.forward.xyz) - push.rayO.xyz;
    return vec2(dot(q, push.rayX.xyz) / dot(push.rayX.xyz, push.rayX.xyz),
                dot(q, push.rayY.xyz) / dot(push.rayY.xyz, push.rayY.xyz));
}
void widen(vec3 at, float radius, inout vec4 rect) {
    float away;
    vec2 place = marchPlace(at, away);
    float scale = view.forward.w > 0.5 ? max(away - radius, 1e-3) : 1.0;
    vec2 reach = radius / (scale * vec2(length(push.rayX.xyz), length(push.rayY.xyz)));
    bool around = view.forward.w > 0.5 && away < radius + 0.01;
    rect = around ? vec4(-1e6, -1e6, 1e6, 1e6)
                  : vec4(min(rect.xy, place - reach), max(rect.zw, place + reach));
}

void main() {
    uint cell = gl_GlobalInvocationID.x;
    FlameBody body = bodies[push.body];
    uint at = wordsOf(cell), to = push.flames + cell * kBodyFlameWords;
    float weight = float(bodyCells[at]);
    for (uint k = 0u; k < kBodyFlameWords; ++k) rays[to + k] = 0u;
    if (cell >= body.cells || weight == 0.0) return;
    BurnObject object = objects[body.object];
    float scale = pow(max(dot(cross(object.worldRow0.xyz, object.worldRow1.xyz),
                              object.worldRow2.xyz), 1e-12), 1.0 / 3.0);
    BodyFlame one;
    one.foot = inWorld(object, placeOf(body, at));
    vec3 n = vec3(int(bodyCells[at + 4u]), int(bodyCells[at + 5u]), int(bodyCells[at + 6u])) /
             (127.0 * weight);
    n = turnNormal(object.worldRow0.xyz, object.worldRow1.xyz, object.worldRow2.xyz, n);
    one.normal = n / max(length(n), 1e-6);
    float side = body.low.w * scale;
    float area = float(bodyCells[at + 7u]) * 1e-6, burns = float(bodyCells[at + 9u]) * 1e-6;
    one.radius = clamp(0.9 * sqrt(area), 0.35 * side, 1.1 * side);
    // Its neighbours draw it, and draw it up.
    float near = 0.0, nearArea = 0.0, all = 0.0;
    vec3 middle = vec3(0.0);
    for (uint j = 0u; j < body.cells; ++j) {
        uint other = wordsOf(j);
        if (bodyCells[other] == 0u) continue;
        vec3 d = (inWorld(object, placeOf(body, other)) - one.foot) / side;
        float w = exp(-0.3 * dot(d, d));
        near += w * float(bodyCells[other + 8u]) * (1.0 / 16.0);
        nearArea += w * float(bodyCells[other + 9u]) * 1e-6;
        w = exp(-0.12 * dot(d, d)) * float(bodyCells[other + 9u]);
        middle += w * d * side;
        all += w;
    }
    one.height = max(kBodyAlone * flameLength(near, nearArea), 0.25 * one.radius);
    vec3 draw = 0.6 * acrossUp(middle / max(all, 1e-6));
    float into = min(dot(draw, one.normal), 0.0);
    one.draw = draw - 0.75 * into * one.normal;
    uint seed = hash32(push.body * 7919u + cell);
    float young = smoothstep(0.05, 0.5, burns / area), own = hashUnit(seed);
    one.strength = -kBodyFoot * 0.95 * (1.0 - young) - 0.6 * own;
    one.share = 5.1 * area / (one.radius * one.height) * clamp(one.height / (5.1 * one.radius), 0.2, 1.0);
    float most = one.strength + kBodyFoot;  // ln of the gas at its foot
    if (most + log(one.share) < -0.7) return;

    vec3 wind = flame.record.air.rgb;
    float rises = max((most + kBodyEnd) / kBodyFoot, 0.3) * one.height;
    vec4 rect = vec4(1e6, 1e6, -1e6, -1e6);
    float reach = one.radius * sqrt((most + kBodyEnd) / kBodyNarrow);
    widen(one.foot, reach, rect);
    for (float k = 0.5; k < 1.1; k += 0.5) {
        float s = k * rises, y = s / one.height;
        vec3 axis = view.up.xyz * s + wind * bodyLag(s, one.height) + one.draw * bodyEase(y) +
                    acrossUp(one.normal) * (0.5 * one.radius + 0.1 * s);
        widen(one.foot + axis, reach * (1.0 + kBodyWiden * y), rect);
    }
    float words[kBodyFlameWords] = float[](
        one.foot.x, one.foot.y, one.foot.z, one.radius, one.normal.x, one.normal.y, one.normal.z,
        one.height, one.draw.x, one.draw.y, one.draw.z, one.strength, one.share, 1.0, 0.0, 0.0,
        rect.x, rect.y, rect.z, rect.w);
    for (uint k = 0u; k < kBodyFlameWords; ++k) rays[to + k] = floatBitsToUint(words[k]);
}
