// Mass-spring model of deforming solids: structure and shear springs to a particle's neighbours,
// flexion springs to those two steps away, eqs. (3) to (8) of the paper
// (plugin/docs/references.md).
#ifndef FW_REFERENCE_SPRINGS_H
#define FW_REFERENCE_SPRINGS_H
#include "shared/deform.h"

FW_SHARED_BEGIN

FW_CONST float kSpringShare = 0.2f;     // alpha of eq. (3)
FW_CONST float kDecayShare = 1.0f;      // beta
FW_CONST float kSpringDamping = 0.08f;  // of the velocity, per step

// Eq. (4): force of one spring per unit mass.
FW_FN vec3 springPull(vec3 x, vec3 y, float rest, float stiffness) {
    return linkCorrection(x, y, rest, stiffness);
}
// Eqs. (5) to (8): recession by `depth` within one step of dt, as an acceleration.
FW_FN vec3 decayPull(vec3 normal, float depth, float dt) {
    return normal * (-2.0f * depth / (dt * dt));
}
// Stiffness at `share` of the stability bound of semi-implicit Euler: dt < 2 / w, w^2 <= 2 *
// springs * stiffness (Gershgorin).
FW_FN float springsAt(float share, float dt, float springs) {
    float w = 2.0f * share / dt;
    return w * w / (2.0f * springs);
}
// Of the neighbours and of those two steps away.
FW_FN float springStiffness() {
    return springsAt(0.7f, float(kSoftTicks) / float(kTicksPerSecond), 16.0f);
}

FW_SHARED_END
#endif
