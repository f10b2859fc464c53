// Soot from a fire on surfaces above it, as dark as its current flames are tall. The soot pass
// makes it permanent on burnt objects; elsewhere it vanishes with the flames.

// Plume height, m, somewhat above the flame.
float plumeHeight(float power) { return 0.02 + 0.014 * pow(max(power, 1.0), 0.4); }

// Does any soot reach within `reach` of there?
bool plumeNear(vec3 d, float power, vec3 up, float reach) {
    float tall = plumeHeight(power), above = -dot(d, up) / tall, margin = reach / tall;
    float width = 2.7 * (0.25 + 0.12 * max(above, 0.0)) + margin;
    return above > -0.1 - margin && above < 6.0 + margin &&
           dot(d, d) / (tall * tall) - above * above < width * width;
}

// d: m, from the surface to the flames' light; power: W.
float plumeSoot(vec3 d, float power, vec3 up) {
    float tall = plumeHeight(power);
    float above = -dot(d, up) / tall;
    float aside2 = (dot(d, d) / (tall * tall) - above * above);
    float width = 0.25 + 0.12 * max(above, 0.0);
    float soot = 0.85 * smoothstep(-0.1, 0.5, above) * exp2(-0.9 * max(above, 0.0)) *
                 exp2(-aside2 / (width * width));
    return mix(0.0, soot, power > 0.0);  // 0: no light in this slot
}
