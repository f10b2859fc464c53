// Heat haze: refraction by hot gas in and above a volumetric flame. Light bends towards denser air,
// by the gradient of n - 1 = 2.9e-4 Ta / T across its path (Gladstone and Dale).
// clang-format off
#ifndef FW_SHARED_VOLUME_HAZE_H
#define FW_SHARED_VOLUME_HAZE_H
#include "shared/volume.h"

FW_SHARED_BEGIN

FW_CONST float kHazeTop = 3.2f;        // y at which the column no longer refracts
FW_CONST float kHazeReach = 1.35f;     // half widths of the plume from the axis to its end
// Rad, at the greatest contrast and noise slope: air's 2.9e-4, exaggerated.
FW_CONST float kHazeBend = 0.012f;
FW_CONST uint kHazeColumns = 18u;      // of the grid on whose corners it is evaluated
FW_CONST uint kHazeRows = 28u;
FW_CONST float kHazeAir = 293.0f;      // K
FW_CONST float kHazePixels = 12.0f;    // largest displacement

// Ta (T - Ta) / T^2 on the plume's axis. McCaffrey's excess: 800 K in the flame, then 1 / z, in the
// plume z^(-5/3). The visible flame is about 1.7 times as high as its profile.
FW_FN float flameHazeContrast(FlameRecord f, float s) {
    float z = max(s, 0.0f) / (1.7f * f.high.w);
    float excess =
        800.0f * min(1.0f, 0.4f / max(z, 0.4f) * min(1.0f, pow(max(z, 1.0f), -0.6666667f)));
    float kelvin = kHazeAir + excess;
    return kHazeAir * excess / (kelvin * kelvin);
}

// Deflection of light that passes the axis there, rad: along side, along, across it. Eddies rise
// with the gas.
FW_FN vec3 flameHaze(FlameRecord f, FlamePlace at) {
    float y = at.s / f.high.w;
    float wide = flamePlumeWide(f, at.s);
    float off2 = dot(at.p, at.p) / (wide * wide);
    float body = exp(-1.2f * off2) *
                 (1.0f - smoothstep(0.5f * kHazeReach * kHazeReach, kHazeReach * kHazeReach, off2));
    body *= smoothstep(0.0f, 0.2f, y) * (1.0f - smoothstep(0.6f * kHazeTop, kHazeTop, y)) * f.air.w;
    float scale = 0.45f * wide;  // lateral only: along, it would shear
    float rise =
        f.speed * flameTau(at.s, f.tauStart, f.tauFree) / (0.75f * f.low.w) - f.smokeScroll;
    vec3 x = vec3(at.p.x / scale + f.place.x, 2.0f * rise + f.place.y, at.p.y / scale + f.place.z);
    vec3 slope; vec3 other;
    flameSlopes(x, slope, other);
    return kHazeBend * 4.0f * flameHazeContrast(f, at.s) * body * slope;
}
FW_SHARED_END
#endif
