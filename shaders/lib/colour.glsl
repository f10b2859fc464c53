// Black-body colour and the film curve that maps deep orange to yellow-white. Hosts with their own
// tone mapper get linear values. Soot: black_body.h.
#include "shared/black_body.h"

// White balance of a camera exposed for fire, for volumes, fireballs and fields.
const vec3 kFireWhite = vec3(1.0, 1.25, 1.6);

// Luminance of glowing char in cd/m^2 (Wien); chromaticity linear in T. Valid 800..2500 K. Cameras
// record embers more orange than they are: the chromaticity is that of a hotter body.
const float kEmberHueShift = 250.0;

vec3 blackbodyChroma(float kelvin) {
    float g = max(0.0, (kelvin - 964.0) * 2.5e-4);
    float b = max(0.0, (kelvin - 1940.0) * 1.15e-4);
    return vec3(1.0, g, b) / (0.2126 + 0.7152 * g + 0.0722 * b);
}

vec3 emberRadiance(float kelvin) {
    float luminance = 2.67 * exp2(34797.8 * (0.001 - 1.0 / max(kelvin, 400.0)));
    return blackbodyChroma(kelvin + kEmberHueShift) * (kelvin < 760.0 ? 0.0 : luminance);
}

// Channel-mixing film curve (the well-known fit of the ACES reference rendering).
vec3 filmCurve(vec3 c) {
    const mat3 toFilm =
        mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
    const mat3 fromFilm =
        mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
    c = toFilm * c;
    c = (c * (c + 0.0245786) - 0.000090537) / (c * (0.983729 * c + 0.4329510) + 0.238081);
    return clamp(fromFilm * c, 0.0, 1.0);
}

vec3 encodeSrgb(vec3 c) {
    return mix(1.055 * pow(max(c, 0.0031308), vec3(1.0 / 2.4)) - 0.055, c * 12.92,
               lessThanEqual(c, vec3(0.0031308)));
}

// FwOutputEncoding: 0 linear, 1 tone mapped into an sRGB view, 2 tone mapped and encoded.
vec3 encodeOutput(vec3 linear, uint encoding) {
    if (encoding == 0u) return linear;
    vec3 shown = filmCurve(linear * 0.9);
    return encoding == 1u ? shown : encodeSrgb(shown);
}
