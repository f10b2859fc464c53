// How long and how high burning material flames.
#include "shared/types.h"

// Wood flames as long as it lasts, but most heat is released near the front. age: ticks since
// ignition; share: of the duration.
float flameFade(BurnMaterial material, float age, float share) {
    float lasting = share * max(6.0 * appearances[material.appearance].charTime, 8.0);
    return 0.04 + 0.96 * exp(-age * (1.0 / 4096.0) * material.timeScale / lasting);
}
// Ticks that a texel of the material flames on an object of these flags: thin materials burn at hole
// edges while the hole grows.
float flameLasts(BurnMaterial material, uint objectFlags) {
    MaterialAppearance appearance = appearances[material.appearance];
    float lasts = material.flameTicks == kNoneTexel ? 1e9 : float(material.flameTicks);
    float hole = (appearance.holeTime - 0.5 * appearance.holeVariation) * 4096.0 / material.timeScale;
    bool holes = appearance.holeTime > 0.0 && (objectFlags & kObjectNoHoles) == 0u;
    return holes ? min(lasts, hole) : lasts;
}
// Flame height by Heskestad, m; a wide weak fire counts as many small ones.
float flameLength(float watts, float area) {
    float tall = 0.235 * pow(max(watts, 1.0) * 1e-3, 0.4), diameter = sqrt(area * 1.273);
    return max(tall - 0.6 * diameter, 0.45 * tall);
}
