// Radiance of glowing soot. Film curve and ember hue: lib/colour.glsl.
// clang-format off
#ifndef FW_SHARED_BLACK_BODY_H
#define FW_SHARED_BLACK_BODY_H
#include "shared/types.h"

FW_SHARED_BEGIN

// Radiance of thin soot, linear Rec.709. Luminance is 1 at 1600 K (black body: 21300 cd/m^2). Error
// against the CIE 1931 observer: 2 % for 1200..1800 K, 5 % at 2000 K.
FW_FN vec3 sootColour(float kelvin, float luminance) {
    float g = max(0.0f, 2.85e-4f * (kelvin - 940.0f));
    float b = max(0.0f, 1.35e-4f * (kelvin - 1815.0f));
    return vec3(1.0f, g, b) * (luminance / (0.2126f + 0.7152f * g + 0.0722f * b));
}
FW_FN vec3 sootRadiance(float kelvin) {
    return sootColour(kelvin, exp2(34981.0f * (1.0f / 1600.0f - 1.0f / max(kelvin, 400.0f))));
}
FW_SHARED_END
#endif
