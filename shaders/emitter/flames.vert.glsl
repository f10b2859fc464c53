// A quad of flame, smoke, fire or spark: stands along its axis and turns about it towards the
// camera (see billboard). All quads are one draw of six vertices each: some devices pay per
// instance.
#include "emitter/flames.glsl"
FW_READ(FLAMES) FW_READ(DRAW_ARGS)
#ifdef FW_FLIPBOOKS
#include "emitter/flipbooks.glsl"
#endif
#include "lib/billboard.glsl"

layout(constant_id = 3) const uint kPart = kPartAll;

#ifdef FW_FLIPBOOKS

FlipbookRecord flipbookOf(uint i) {
    uint at = i * kFlipbookRecordWords;
    FlipbookRecord b;
    b.at = flipbooks[at];
    b.size = flipbooks[at + 1u];
    b.motionAt = flipbooks[at + 2u];
    b.motionSize = flipbooks[at + 3u];
    b.frames = flipbooks[at + 4u];
    b.columns = flipbooks[at + 5u];
    b.flags = flipbooks[at + 6u];
    b.maxMotion = uintBitsToFloat(flipbooks[at + 7u]);
    return b;
}
vec2 halves(uint word) { return vec2(float(word & 0xFFFFu), float(word >> 16u)); }

// Outputs a quad's flipbook frames. Returns its corner in the occupied rectangle of the frame.
// pixels: width on the screen.
vec2 openFlipbook(FlameQuad quad, vec2 place, float pixels) {
    uint flipbook = (quad.kind >> kQuadFlipbookShift & 0xFFu) - 1u;
    FlipbookRecord b = flipbookOf(flipbook);
    FlipbookPlace p = flipbookPlaceAt(quad.phase, b.frames, (b.flags & kFlipbookLoops) != 0u);
    vec2 texels = halves(b.size);
    uint level = flipbookLevel(texels.x, pixels, float(quad.kind >> kQuadSeed & 0xFFu) / 256.0);
    uint smaller = flipbooks[flipbook * kFlipbookRecordWords + kFlipbookLevelWord + level];
    level = level > 0u && smaller != 0u ? level : 0u;
    b.at = level > 0u ? smaller : b.at;
    b.size = (b.size & 0xFFFFu) >> level | b.size >> (16u + level) << 16u;
    vFrames = vec4(vec2(flipbookFrameOrigin(b, p.before)), vec2(flipbookFrameOrigin(b, p.after)));
    vMotions =
        vec4(vec2(flipbookMotionOrigin(b, p.before)), vec2(flipbookMotionOrigin(b, p.after)));
    vSizes = vec4(halves(b.size), halves(b.motionSize));
    vBetween = vec2(p.part, b.maxMotion);
    uint rect = kFlipbookRects + 2u * (flipbook * kMaxFlipbookFrames + p.before);
    // A texel of a mip covers more than the occupied texels of mip 0.
    vec2 wider = vec2(float((1u << level) - 1u)) / texels;
    vec2 low = max(halves(flipbooks[rect]) / texels - wider, vec2(0.0));
    vec2 high = min(halves(flipbooks[rect + 1u]) / texels + wider, vec2(1.0));
    bool mirrored = (quad.kind >> kQuadSeed & 1u) != 0u;
    float x = place.x > 0.0 != mirrored ? high.x : low.x;
    return vec2((2.0 * x - 1.0) * (mirrored ? -1.0 : 1.0), place.y > 0.5 ? high.y : low.y);
}
#endif

const float kSmall = 24.0;  // px across: below, a triangle is cheaper than two on a software device
const float kRoot3 = 1.7320508;

void main() {
    float perspective = view.forward.w;  // a weight instead of a branch, see ARCHITECTURE.md
    uint number = uint(gl_VertexIndex) / 6u, vertex = uint(gl_VertexIndex) % 6u;
    // Sparks add up in any order.
    FlameQuad quad = flameQuad[kPart == kPartSparks ? number : drawArgs[kFlameOrder + number]];
    uint corner = vertex < 3u ? vertex : vertex - 2u;
    vec2 place = vec2((corner & 1u) == 0u ? -1.0 : 1.0, (corner & 2u) == 0u ? 0.0 : 1.0);
    if (vertex == 3u) place = vec2(-1.0, 1.0);
    if (vertex == 4u) place = vec2(1.0, 0.0);
    if (vertex == 5u) place = vec2(1.0, 1.0);
    // A spark thinner than a pixel is drawn one pixel wide, and dimmer.
    if ((quad.kind & 3u) == kQuadSpark) {
        float far =
            mix(1.0, dot(quad.baseHeight.xyz - view.eye.xyz, view.forward.xyz), perspective);
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
    // A small quad that is empty outside a circle is drawn as one triangle.
    if (pixels < kSmall && (quad.kind & 3u) != kQuadTongue &&
        (quad.kind >> kQuadFlipbookShift & 0xFFu) == 0u) {
        place = vec2(vertex == 0u   ? 0.0
                     : vertex == 1u ? -kRoot3
                                    : kRoot3,
                     vertex == 0u ? 1.5 : 0.0);
        if (vertex > 2u) place = vec2(0.0);
    }
#ifdef FW_FLIPBOOKS
    vFrames = vMotions = vSizes = vec4(0.0);
    vBetween = vec2(0.0);
    if ((quad.kind >> kQuadFlipbookShift & 0xFFu) != 0u) place = openFlipbook(quad, place, pixels);
#endif
    vec3 toEye = -mix(view.forward.xyz, normalize(middle), perspective);
    bool smoke = (quad.kind & 3u) == kQuadSmoke;
    Billboard b = billboard(quad.axisWidth.xyz, toEye, smoke);
    vec3 axis = b.axis, side = b.side;
    vec3 start = smoke ? middle - axis * (0.5 * quad.baseHeight.w) : foot;
    vec3 at = start + side * (place.x * quad.axisWidth.w) + axis * (place.y * quad.baseHeight.w);
    // Towards the camera, so that a wall behind does not cut the tongue.
    at += toEye * (smoke ? 0.0 : kQuadNearer * quad.axisWidth.w);
    vSun = vec2(dot(view.sunDirection.xyz, side), dot(view.sunDirection.xyz, axis));
    vPlace = place;
    vState = vec4(quad.opacity, quad.phase, quad.kelvin, quad.baseHeight.w / quad.axisWidth.w);
    vKind = quad.kind;
    vWidth = quad.axisWidth.w;
    gl_Position = view.clip0 * at.x + view.clip1 * at.y + view.clip2 * at.z + view.clip3;
    if (kPart != kPartAll && ((quad.kind & 3u) == kQuadSpark) != (kPart == kPartSparks))
        gl_Position = vec4(-2.0, -2.0, 0.0, 1.0);  // belongs to the other part
    if (view.quads.w > 0.5 && (quad.kind & kQuadOfBody) != 0u)
        gl_Position = vec4(-2.0, -2.0, 0.0, 1.0);
}
