// A particle field's body, generated from the vertex number: a billboard that turns about its up
// axis, or a spheroid around which the field is wound, displaced by density if requested.
#include "field/field_draw.glsl"
FW_READ(FIELD_DRAWS)
#include "lib/billboard.glsl"

const float kPi = 3.14159265;
const float kBulge = 0.22;

float densityAt(FieldDraw d, vec2 place) {
    vec2 at = place * vec2(float(d.width), float(d.height)) - 0.5;
    vec2 low = floor(at), part = at - low;
    int x = int(low.x), y = int(low.y), w = int(d.width), h = int(d.height);
    int x0 = x < 0 ? x + w : x, x1 = x + 1 >= w ? x + 1 - w : x + 1;
    int y0 = clamp(y, 0, h - 1), y1 = clamp(y + 1, 0, h - 1);
    vec4 n = vec4(
        shown[d.shown + uint(y0 * w + x0)] & 1023u, shown[d.shown + uint(y0 * w + x1)] & 1023u,
        shown[d.shown + uint(y1 * w + x0)] & 1023u, shown[d.shown + uint(y1 * w + x1)] & 1023u);
    vec2 rows = mix(n.xz, n.yw, part.x);
    return mix(rows.x, rows.y, part.y) * (1.0 / 511.5);
}

void main() {
    FieldDraw d = draws[gl_InstanceIndex];
    uint quad = uint(gl_VertexIndex) / 6u, corner = uint(gl_VertexIndex) % 6u;
    corner = corner < 3u ? corner : 6u - corner;  // 0 1 2, 3 2 1
    vec2 turn = vec2((corner & 1u) != 0u ? 1.0 : 0.0, corner >= 2u ? 1.0 : 0.0);
    bool flat_ = d.shape == kFieldBillboard;

    vec3 foot = d.place.xyz - view.eye.xyz;
    vec3 middle = foot + d.up.xyz * (0.5 * d.size.y);
    float perspective = view.forward.w;  // a weight instead of a branch, see ARCHITECTURE.md
    vec3 toEye = -mix(view.forward.xyz, normalize(middle), perspective);
    Billboard b = billboard(d.up.xyz, toEye, false);
    vec3 axis = b.axis, side = b.side;
    float sense = dot(side, d.right.xyz) < 0.0 ? -1.0 : 1.0;  // the wind keeps its direction
    vec3 onBillboard = foot + side * ((turn.x - 0.5) * d.size.x) + axis * (turn.y * d.size.y);
    vec2 billboardPlace = vec2(sense * (turn.x - 0.5) + 0.5, turn.y);

    vec2 ballPlace = vec2((float(quad % kFieldAround) + turn.x) / float(kFieldAround),
                          (float(quad / kFieldAround) + turn.y) / float(kFieldUp));
    // Longitude by angle; latitude half by height and half by angle, so cells keep their shape in
    // the middle and the poles do not dominate.
    float lon = 2.0 * kPi * ballPlace.x, lat = kPi * (ballPlace.y - 0.5);
    vec3 ball = vec3(cos(lat) * cos(lon), sin(lat), -cos(lat) * sin(lon));
    vec3 normal = normalize(d.right.xyz * (ball.x / d.size.x) + d.up.xyz * (ball.y / d.size.y) +
                            d.forward.xyz * (ball.z / d.size.z));
    vec3 onBall =
        middle + 0.5 * (d.right.xyz * (ball.x * d.size.x) + d.up.xyz * (ball.y * d.size.y) +
                        d.forward.xyz * (ball.z * d.size.z));
    float bulge = d.shape == kFieldDisplaced
                      ? kBulge * min(min(d.size.x, d.size.y), d.size.z) * cos(lat)
                      : 0.0;
    onBall += normal * (bulge * (densityAt(d, ballPlace) - 0.35));

    vec3 at = flat_ ? onBillboard : onBall;
    vPlace = flat_ ? billboardPlace : ballPlace;
    vNormal = flat_ ? normalize(cross(side, axis)) : normal;
    vToEye = -mix(view.forward.xyz, at, perspective);
    vAlong = flat_ ? side * sense
                     : normalize(-d.right.xyz * (sin(lon) * d.size.x) -
                                 d.forward.xyz * (cos(lon) * d.size.z));
    vBody = vec4(d.right.w, d.up.w, d.forward.w, d.size.w);
    vTint = d.tint;
    vField = uvec4(d.shown, d.width, d.height, flat_ ? 0u : 1u);
    vSize = vec4(d.size.x / float(d.width) * (flat_ ? 1.0 : kPi), d.tall,
                   flat_ ? 0.5 * d.size.x : d.size.z, float(d.seed & 1023u));
    gl_Position = view.clip0 * at.x + view.clip1 * at.y + view.clip2 * at.z + view.clip3;
}
