// Places an object's mesh. Positions are relative to the camera, so derivatives stay precise far
// from the world's origin. Lights small triangles per vertex.
#include "surface/surface.glsl"
FW_BUFFER(REFINE_VERTICES, readonly, vec4, places)
FW_BUFFER(TILE_STATE, readonly, uvec4, tileStates)

layout(location = 0) in vec3 inPosition;  // m, object space, as displayed
layout(location = 1) in uint inNormal;  // signed 11:11:10
layout(location = 2) in vec2 inAtlas;
layout(location = 3) in vec2 inTexture;
layout(location = 4) in vec2 inDetail;
layout(location = 5) in vec4 inTint;
layout(location = 6) in uint inSlot;   // of refined vertices
layout(location = 7) in float inOffset;  // burn-through offset, appearance seconds
layout(location = 8) in vec3 inRest;   // m, object space, before deformation

#include "lib/turn.glsl"
#include "surface/place.glsl"

uint flags;

// Adds a flame's light and its share of the mean direction.
void addFlame(BurnLight light, vec3 position, vec3 normal, inout vec3 color, inout vec4 towards) {
    vec3 d = light.positionRadius.xyz - view.eye.xyz - position;
    float r2 = dot(d, d);
    float radius = light.positionRadius.w;
    vec3 to = d * inversesqrt(max(r2, 1e-8));
    float facing = dot(normal, to);
    if ((flags & kObjectTwoSided) != 0u) facing = abs(facing);  // thin: both sides are lit
    float e = light.colorIntensity.w / (r2 + max(radius * radius * 0.25, 0.004));
    e *= clamp(4.0 * facing + 1.0, 0.0, 1.0);  // none from behind
    color += light.colorIntensity.rgb * e;
    towards += vec4(to, 1.0) * e;
    // Burnt objects store soot in texels.
    if ((kVariant & (kSurfaceBurns | kSurfaceCold)) == 0u)
        vSootOffset.x += plumeSoot(d, light.power, view.up.xyz);
}

// Has fire, heat, water or soot left a mark within reach?
bool markedNear(vec2 texel) {
    ivec2 last = (ivec2(int(draw.size & 0xFFFFu), int(draw.size >> 16u)) - 1) >> 3;
    ivec2 low = ivec2(max(texel - draw.nearness, 0.0)) >> 3;
    ivec2 high = min(ivec2(texel + draw.nearness) >> 3, last);
    uint flags = 0u;
    for (int i = 0; i < 16; ++i) {
        ivec2 tile = min(low + ivec2(i & 3, i >> 2), high);
        flags |= tileStates[(draw.stateBase >> 6u) + uint(tile.y * (last.x + 1) + tile.x)].y;
    }
    return (flags & kTileMarked) != 0u;
}

void main() {
    // A zero that is not constant: a software device recompiles a shader, in milliseconds per draw,
    // for each set of constants that alone decide its branches.
    uint zero = uint(gl_VertexIndex) >> 31u;
    flags = draw.flags | zero;
    float scale = length(draw.row0.xyz);
    int n = int(inNormal);
    vec3 normal = vec3(float((n << 21) >> 21), float((n << 10) >> 21), float(n >> 22) * 2.0);

    vec3 rest = inPosition;
    float offset = inOffset;
    bool placed = (flags & kDrawPlaced) != 0u;
    while (placed) {  // a branch would cost every mesh the load
        vec4 place = places[draw.places + inSlot];
        vec4 inner = places[draw.places + draw.inner + inSlot];
        rest = (flags & kDrawInner) != 0u ? inner.xyz : place.xyz;
        // Time to its hole, or how long the opposite wall has burnt.
        float behind = draw.inner != 0u ? draw.now - inner.w : -1000.0;
        offset = (flags & kDrawCut) != 0u ? clamp(place.w - draw.now, 0.0, 1000.0)
                                          : clamp(behind * draw.timeScale, -1000.0, 1000.0);
        placed = false;
    }
    vec3 position = fromEye(rest);
    normal = normalize(turnNormal(draw.row0.xyz, draw.row1.xyz, draw.row2.xyz, normal));
    vSootOffset = vec2(0.0, offset);
    vec3 color = vec3(0.0);
    vec4 towards = vec4(0.0, 0.0, 0.0, 1e-6);
    // A loop, not a branch: a software device would execute the branch masked; a loop that ends at
    // once costs one test.
    uint count = (flags & kDrawVertexLight) != 0u ? view.lightCount | zero : 0u;
    for (uint i = 0u; i < count; ++i) addFlame(lights[i], position, normal, color, towards);
    towards.xyz /= towards.w;

    vPositionFire = vec4(position, color.r);
    vRestFire = vec4(inRest * scale, color.g);
    vNormalFire = vec4(normal, color.b);
    vTexture = vec4(inAtlas, inTexture);
    vDetail = vec4(inDetail * scale, towards.xy);
    vTint = vec4(inTint.rgb * vec3(draw.tintR, draw.tintG, draw.tintB), towards.z);
#ifdef FW_MULTISAMPLED
    vMiddle = position;
    vMiddleUv = vec4(vTexture.xy, vDetail.xy);
#endif
    gl_Position = clipPlace(position);
    // Moves marked corners beyond the far plane: triangles with three such corners are clipped,
    // fragments of others are discarded, and remaining samples lie behind the burning surface.
    if ((kVariant & kSurfaceCold) != 0u && (offset >= 1e-3 || markedNear(inAtlas))) {
        vSootOffset.x = 1.0;
        gl_Position.z = view.wind.w * gl_Position.w;
    }
}
