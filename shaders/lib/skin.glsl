// Position of a texel on moving vertices: the host's, or a sheet's. Every thread loads; objects
// without them read the first records.
FW_READ(SKIN_TEXELS) FW_BUFFER(SHOWN, readonly, vec4, skinShown)

// Moves the place (m, object space) and the normal (Q14, as decodeNormal's) of a texel at rest.
void moveWithSkin(uint object, uint texel, inout vec3 place, inout vec3 normal) {
    bool skinned = (objects[object].flags & kObjectSkinned) != 0u;
    uint base = objects[object].shownBase;
    uvec4 of = skinTexels[skinned ? objects[object].skinBase + texel : 0u];
    vec2 weight = unpackUnorm2x16(of.w);
    vec3 a = skinShown[skinned ? (base + of.x) * 3u : 0u].xyz;
    vec3 b = skinShown[skinned ? (base + of.y) * 3u : 0u].xyz;
    vec3 c = skinShown[skinned ? (base + of.z) * 3u : 0u].xyz;
    vec3 across = cross(b - a, c - a);
    if (!skinned) return;
    place = a * weight.x + b * weight.y + c * (1.0 - weight.x - weight.y);
    normal = across * (16384.0 * inversesqrt(max(dot(across, across), 1e-30)));
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
