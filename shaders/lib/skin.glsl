// Position of a texel on moving vertices: the host's, or a sheet's. Every thread loads; objects
// without them read the first records.
FW_READ(SKIN_TEXELS) FW_BUFFER(SHOWN, readonly, vec4, skinShown)

struct SkinPlace {
    vec3 place, normal;  // m, object space; of the triangle, Q14 as decodeNormal's
};
SkinPlace skinPlace(bool skinned, uint skinTexel, uint shownBase) {
    uvec4 of = skinTexels[skinned ? skinTexel : 0u];
    vec2 weight = unpackUnorm2x16(of.w);
    vec3 a = skinShown[skinned ? (shownBase + of.x) * 3u : 0u].xyz;
    vec3 b = skinShown[skinned ? (shownBase + of.y) * 3u : 0u].xyz;
    vec3 c = skinShown[skinned ? (shownBase + of.z) * 3u : 0u].xyz;
    SkinPlace found;
    found.place = a * weight.x + b * weight.y + c * (1.0 - weight.x - weight.y);
    vec3 across = cross(b - a, c - a);
    found.normal = across * (16384.0 * inversesqrt(max(dot(across, across), 1e-30)));
    return found;
}

// Position of a texel at rest, m, object space.
vec3 restOf(uint object, uvec2 texel) {
    return objects[object].originQuantum.xyz + objects[object].originQuantum.w *
               vec3(texel.x & 0xFFFFu, texel.x >> 16u, texel.y & 0xFFFFu);
}
vec3 inWorld(uint object, vec3 rest) {
    vec4 at = vec4(rest, 1.0);
    return vec3(dot(objects[object].worldRow0, at), dot(objects[object].worldRow1, at),
                dot(objects[object].worldRow2, at));
}
