// Light of glowing soot. The lens-side curves (film, ember hue) are in lib/colour.glsl.
// GLSL too, and laid out by hand.
// clang-format off
#ifndef FW_SHARED_BLACK_BODY_H
#define FW_SHARED_BLACK_BODY_H
#include "shared/types.h"

#ifdef __cplusplus
#include <cmath>
#endif

FW_SHARED_BEGIN
#ifdef __cplusplus
using glm::max;
using std::exp2;
#endif

// Thin soot, linear Rec.709, luminance 1 at 1600 K (of a black body: 21300 cd/m^2). Within 2 % of
// the luminance that follows from the CIE 1931 observer for 1200..1800 K, 5 % at 2000 K.
FW_SHARED_FN vec3 sootRadiance(float kelvin) {
    float luminance = exp2(34981.0f * (1.0f / 1600.0f - 1.0f / max(kelvin, 400.0f)));
    float g = max(0.0f, 2.85e-4f * (kelvin - 940.0f));
    float b = max(0.0f, 1.35e-4f * (kelvin - 1815.0f));
    return vec3(1.0f, g, b) * (luminance / (0.2126f + 0.7152f * g + 0.0722f * b));
}
FW_SHARED_END
#endif
