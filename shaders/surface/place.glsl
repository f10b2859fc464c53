// Where a drawn point is, for all that draw the same surface: to the last bit, as they are compared
// by depth. Needs `view` and `draw`.
#ifndef FW_SURFACE_PLACE_GLSL
#define FW_SURFACE_PLACE_GLSL
invariant gl_Position;

vec3 fromEye(vec3 rest) {  // m, world, from the eye, of object space
    vec3 offset = vec3(draw.row0.w, draw.row1.w, draw.row2.w) - view.eye.xyz;
    return vec3(dot(draw.row0.xyz, rest), dot(draw.row1.xyz, rest), dot(draw.row2.xyz, rest)) +
           offset;
}
vec4 clipPlace(vec3 position) {
    return view.clip0 * position.x + view.clip1 * position.y + view.clip2 * position.z + view.clip3;
}
#endif
