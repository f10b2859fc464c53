// Position of a drawn point, bit-identical for all passes that compare depth. `precise` ensures it:
// `invariant` would decorate a member of gl_PerVertex, which drivers warn about. Needs `view` and
// `draw`.
vec3 fromEye(vec3 rest) {  // m, world, relative to the camera, from object space
    precise vec3 offset = vec3(draw.row0.w, draw.row1.w, draw.row2.w) - view.eye.xyz;
    precise vec3 turned = vec3(draw.row0.x, draw.row1.x, draw.row2.x) * rest.x +
                          vec3(draw.row0.y, draw.row1.y, draw.row2.y) * rest.y +
                          vec3(draw.row0.z, draw.row1.z, draw.row2.z) * rest.z;
    precise vec3 place = turned + offset;
    return place;
}
vec4 clipPlace(vec3 position) {
    precise vec4 place =
        view.clip0 * position.x + view.clip1 * position.y + view.clip2 * position.z + view.clip3;
    return place;
}
