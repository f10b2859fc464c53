#version 450
// A quad of a flame, smoke, fire or a spark: stands along its axis and turns about it towards the
// eye. Seen along its axis it leans on the screen instead, or it would vanish from above. All quads
// are one draw of six vertices each: a device that draws instance by instance pays for each.
#extension GL_GOOGLE_include_directive : require
#include "shared/burn.h"
#include "shared/look.h"
#include "emitter/nearer.glsl"

layout(std430, set = 0, binding = FW_BIND_FLAMES) readonly buffer FlamesBuffer {
    FlameQuad flameQuad[];
};
layout(std430, set = 0, binding = FW_BIND_DRAW_ARGS) readonly buffer ArgsBuffer {
    uint drawArgs[];
};
layout(set = 0, binding = FW_BIND_VIEW, std140) uniform View { ViewParams view; };

layout(constant_id = 3) const uint kPart = kPartAll;

layout(location = 0) centroid out vec2 outPlace;        // x: -1..1, y: 0 foot .. 1 tip
layout(location = 1) flat out vec4 outState;   // opacity, phase, kelvin, length over half width
layout(location = 2) flat out uint outKind;
layout(location = 3) flat out float outWidth;  // m, half of it
layout(location = 4) flat out vec2 outSun;     // where the light comes from, in the quad's plane

#ifdef FW_BOOKS
#include "shared/book.h"
layout(std430, set = 0, binding = FW_BIND_BOOKS) readonly buffer BooksBuffer { uint books[]; };
layout(location = 5) flat out vec4 outFrames;   // texel of the frame before and of that after
layout(location = 6) flat out vec4 outMotions;  // the same of their motion
layout(location = 7) flat out vec4 outSizes;    // texels of a frame, of its motion
layout(location = 8) flat out vec2 outBetween;  // part of the way, most motion

BookRecord bookOf(uint i) {
    uint at = i * kBookRecordWords;
    BookRecord b;
    b.at = books[at];
    b.size = books[at + 1u];
    b.motionAt = books[at + 2u];
    b.motionSize = books[at + 3u];
    b.frames = books[at + 4u];
    b.columns = books[at + 5u];
    b.flags = books[at + 6u];
    b.motionMost = uintBitsToFloat(books[at + 7u]);
    return b;
}
vec2 halves(uint word) { return vec2(float(word & 0xFFFFu), float(word >> 16u)); }

// What the fragments read of a quad's book; of its corner, the one of what it shows. `pixels`: across.
vec2 openBook(FlameQuad quad, vec2 place, float pixels) {
    uint book = (quad.kind >> kQuadBook & 0xFFu) - 1u;
    BookRecord b = bookOf(book);
    BookPlace p = bookPlace(quad.phase, b.frames, (b.flags & kBookLoops) != 0u);
    vec2 texels = halves(b.size);
    uint level = bookLevel(texels.x, pixels, float(quad.kind >> kQuadSeed & 0xFFu) / 256.0);
    uint smaller = books[book * kBookRecordWords + kBookLevelWord + level];
    level = level > 0u && smaller != 0u ? level : 0u;
    b.at = level > 0u ? smaller : b.at;
    b.size = (b.size & 0xFFFFu) >> level | b.size >> (16u + level) << 16u;
    outFrames = vec4(vec2(bookCell(b, p.before)), vec2(bookCell(b, p.after)));
    outMotions = vec4(vec2(bookMotionCell(b, p.before)), vec2(bookMotionCell(b, p.after)));
    outSizes = vec4(halves(b.size), halves(b.motionSize));
    outBetween = vec2(p.part, b.motionMost);
    uint rect = kBookRects + 2u * (book * kMostBookFrames + p.before);
    // A texel of a smaller level reaches beyond what there is of larger ones.
    vec2 wider = vec2(float((1u << level) - 1u)) / texels;
    vec2 low = max(halves(books[rect]) / texels - wider, vec2(0.0));
    vec2 high = min(halves(books[rect + 1u]) / texels + wider, vec2(1.0));
    bool mirrored = (quad.kind >> kQuadSeed & 1u) != 0u;
    float x = place.x > 0.0 != mirrored ? high.x : low.x;
    return vec2((2.0 * x - 1.0) * (mirrored ? -1.0 : 1.0), place.y > 0.5 ? high.y : low.y);
}
#endif

const float kSmall = 24.0;  // px across: a triangle costs a software device less than two
const float kRoot3 = 1.7320508;

void main() {
    float perspective = view.forward.w;  // weighed with, not branched on, see ARCHITECTURE.md
    uint number = uint(gl_VertexIndex) / 6u, vertex = uint(gl_VertexIndex) % 6u;
    // Sparks add up in any order.
    FlameQuad quad = flameQuad[kPart == kPartSparks ? number : drawArgs[kFlameOrder + number]];
    uint corner = vertex < 3u ? vertex : vertex - 2u;
    vec2 place = vec2((corner & 1u) == 0u ? -1.0 : 1.0, (corner & 2u) == 0u ? 0.0 : 1.0);
    if (vertex == 3u) place = vec2(-1.0, 1.0);
    if (vertex == 4u) place = vec2(1.0, 0.0);
    if (vertex == 5u) place = vec2(1.0, 1.0);
    // A spark too thin for a pixel is as wide as one, and dimmer instead.
    if ((quad.kind & 3u) == kQuadSpark) {
        float far = mix(1.0, dot(quad.baseHeight.xyz - view.eye.xyz, view.forward.xyz), perspective);
        float wide = max(quad.axisWidth.w, 0.7 * view.eye.w * max(far, 0.05));
        float more = wide - quad.axisWidth.w;
        quad.baseHeight += vec4(quad.axisWidth.xyz * -more, 2.0 * more);
        quad.opacity *= quad.axisWidth.w / wide;
        quad.axisWidth.w = wide;
    }
    vec3 foot = quad.baseHeight.xyz - view.eye.xyz;
    vec3 middle = foot + quad.axisWidth.xyz * (0.5 * quad.baseHeight.w);
    float away = mix(1.0, max(dot(middle, view.forward.xyz), 0.01), perspective);
    float pixels = 2.0 * quad.axisWidth.w / (view.eye.w * away);
    // What shows nothing outside of a circle is, while small, the triangle around that.
    if (pixels < kSmall && (quad.kind & 3u) != kQuadTongue &&
        (quad.kind >> kQuadBook & 0xFFu) == 0u) {
        place = vec2(vertex == 0u ? 0.0 : vertex == 1u ? -kRoot3 : kRoot3, vertex == 0u ? 1.5 : 0.0);
        if (vertex > 2u) place = vec2(0.0);
    }
#ifdef FW_BOOKS
    outFrames = outMotions = outSizes = vec4(0.0);
    outBetween = vec2(0.0);
    if ((quad.kind >> kQuadBook & 0xFFu) != 0u) place = openBook(quad, place, pixels);
#endif
    vec3 toEye = -mix(view.forward.xyz, normalize(middle), perspective);
    vec3 axis = quad.axisWidth.xyz;
    float along = abs(dot(axis, toEye));
    vec3 screenUp = view.up.xyz - toEye * dot(view.up.xyz, toEye);
    screenUp = dot(screenUp, screenUp) > 1e-4 ? normalize(screenUp) : vec3(0.0, 0.0, 1.0);
    bool smoke = (quad.kind & 3u) == kQuadSmoke;
    vec3 flat_ = axis - toEye * dot(axis, toEye);
    // At least half of its length stays visible.
    axis = smoke ? screenUp
                 : mix(axis, normalize(flat_ + screenUp * 1e-3), smoothstep(0.6, 0.95, along));
    vec3 side = normalize(cross(axis, toEye) + vec3(1e-6, 0.0, 0.0));
    vec3 start = smoke ? middle - axis * (0.5 * quad.baseHeight.w) : foot;
    vec3 at = start + side * (place.x * quad.axisWidth.w) + axis * (place.y * quad.baseHeight.w);
    // Towards the eye, so that a wall behind does not cut the tongue's side.
    at += toEye * (smoke ? 0.0 : kQuadNearer * quad.axisWidth.w);
    outSun = vec2(dot(view.sunDirection.xyz, side), dot(view.sunDirection.xyz, axis));
    outPlace = place;
    outState = vec4(quad.opacity, quad.phase, quad.kelvin, quad.baseHeight.w / quad.axisWidth.w);
    outKind = quad.kind;
    outWidth = quad.axisWidth.w;
    gl_Position = view.clip0 * at.x + view.clip1 * at.y + view.clip2 * at.z + view.clip3;
    if (kPart != kPartAll && ((quad.kind & 3u) == kQuadSpark) != (kPart == kPartSparks))
        gl_Position = vec4(-2.0, -2.0, 0.0, 1.0);  // not of this part
}
