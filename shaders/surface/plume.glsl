// Soot that a fire leaves on what stands above it, as dark as its flames are tall: those of the
// moment. `soot` makes it stay where something has burnt; elsewhere it goes where they go.

// m, somewhat over the flame.
float plumeHeight(float power) { return 0.02 + 0.014 * pow(max(power, 1.0), 0.4); }

// Whether any of it comes within `reach` of there.
bool plumeNear(vec3 d, float power, vec3 up, float reach) {
    float tall = plumeHeight(power), above = -dot(d, up) / tall, margin = reach / tall;
    float width = 2.7 * (0.25 + 0.12 * max(above, 0.0)) + margin;
    return above > -0.1 - margin && above < 6.0 + margin &&
           dot(d, d) / (tall * tall) - above * above < width * width;
}

// `d`: m, from the surface to the light of the flames; `power`: W.
float plumeSoot(vec3 d, float power, vec3 up) {
    float tall = plumeHeight(power);
    float above = -dot(d, up) / tall;
    float aside2 = (dot(d, d) / (tall * tall) - above * above);
    float width = 0.25 + 0.12 * max(above, 0.0);
    float soot = 0.85 * smoothstep(-0.1, 0.5, above) * exp2(-0.9 * max(above, 0.0)) *
                 exp2(-aside2 / (width * width));
    return mix(0.0, soot, power > 0.0);  // else no light is here
}
