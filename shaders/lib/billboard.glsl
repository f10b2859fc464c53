// Axis of a quad that stands along `axis` and turns about it towards the camera. Seen along its
// axis it tilts on the screen, so that at least half of its length stays visible. toEye: unit.
// Needs `view`.
struct Billboard {
    vec3 axis, side, screenUp;
};
Billboard billboard(vec3 axis, vec3 toEye, bool upright) {
    Billboard b;
    float along = abs(dot(axis, toEye));
    b.screenUp = view.up.xyz - toEye * dot(view.up.xyz, toEye);
    b.screenUp = dot(b.screenUp, b.screenUp) > 1e-4 ? normalize(b.screenUp) : vec3(0.0, 0.0, 1.0);
    vec3 flat_ = axis - toEye * dot(axis, toEye);
    b.axis = upright
                 ? b.screenUp
                 : mix(axis, normalize(flat_ + b.screenUp * 1e-3), smoothstep(0.6, 0.95, along));
    b.side = normalize(cross(b.axis, toEye) + vec3(1e-6, 0.0, 0.0));
    return b;
}
