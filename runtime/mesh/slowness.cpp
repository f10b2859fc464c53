// Raggedness of the front: a factor on slowness per texel, coherent in object space, so that seams
// do not show. Integer hashes and + - * / only: equal on every machine.
#include "core/hash.h"
#include "mesh/texels.h"

#include <cmath>

namespace fw::mesh {
namespace {

// A front finds the fast paths, so noise speeds it up. Its speed is divided by these factors,
// measured with this noise on planes at several tilts: features of half a texel, and of two texels
// or more (2 to 8 hardly differ).
constexpr double kAmplitudes[] = {0, 0.10, 0.15, 0.25, 0.50};
constexpr double kSpeedUpFine[] = {1, 1.005, 1.010, 1.024, 1.078};
constexpr double kSpeedUpCoarse[] = {1, 1.0093, 1.0172, 1.037, 1.106};

double speedUp(double amplitude, double featureTexels) {
    FW_ASSERT(amplitude >= 0 && amplitude <= 0.5, "amplitude %g", amplitude);
    size_t k = 1;
    while (k < 4 && amplitude > kAmplitudes[k]) ++k;
    const double s = (amplitude - kAmplitudes[k - 1]) / (kAmplitudes[k] - kAmplitudes[k - 1]);
    const double fine = kSpeedUpFine[k - 1] + s * (kSpeedUpFine[k] - kSpeedUpFine[k - 1]);
    const double coarse = kSpeedUpCoarse[k - 1] + s * (kSpeedUpCoarse[k] - kSpeedUpCoarse[k - 1]);
    return fine + std::clamp((featureTexels - 0.5) / 1.5, 0.0, 1.0) * (coarse - fine);
}

// [-1, 1] at a lattice point.
double lattice(int32_t x, int32_t y, int32_t z, uint32_t seed) {
    uint32_t h = core::hash32(uint32_t(x) + seed);
    h = core::hash32(h ^ (uint32_t(y) * 0x9E3779B9u));
    h = core::hash32(h ^ (uint32_t(z) * 0x85EBCA6Bu));
    return double(h >> 8) * (2.0 / 16777215.0) - 1;
}

double valueNoise(glm::dvec3 p, uint32_t seed) {
    const double fx = std::floor(p.x), fy = std::floor(p.y), fz = std::floor(p.z);
    const int32_t x = int32_t(fx), y = int32_t(fy), z = int32_t(fz);
    const double s = p.x - fx, t = p.y - fy, u = p.z - fz;
    double layers[2];
    for (int32_t k = 0; k < 2; ++k) {
        const double a = lattice(x, y, z + k, seed), b = lattice(x + 1, y, z + k, seed);
        const double c = lattice(x, y + 1, z + k, seed), d = lattice(x + 1, y + 1, z + k, seed);
        const double ab = a + (b - a) * s, cd = c + (d - c) * s;
        layers[k] = ab + (cd - ab) * t;
    }
    return layers[0] + (layers[1] - layers[0]) * u;
}

}  // namespace

void bakeSlowness(const BakeInput& input, const TexelGrid& grid, glm::dvec3 low, double extent,
                  std::pmr::vector<uint16_t>& slowness) {
    slowness.assign(grid.count(), 0);
    const double amplitude = double(input.noiseAmplitude);
    // The lattice must fit 32 bits, so invisibly small features are enlarged.
    const double farthest = std::max({std::abs(low.x), std::abs(low.y), std::abs(low.z)}) + extent;
    const double feature =
        std::max({double(input.noiseFeature), 1e-3 * grid.side, 1e-9 * farthest});
    const double mean = 128 * speedUp(amplitude, feature / grid.side);
    FW_ASSERT(feature > 0 && mean > 0, "features of %g m, mean %g", feature, mean);
    for (uint32_t texel = 0; texel < grid.count(); ++texel) {
        if (!grid.real(texel)) continue;
        const glm::dvec3 p = (low + glm::dvec3(grid.position[texel])) / feature;
        const double factor =
            amplitude > 0 ? mean * (1 + amplitude * valueNoise(p, input.noiseSeed)) : 128;
        slowness[texel] = uint16_t(std::clamp(std::floor(factor + 0.5), 1.0, 65535.0));
    }
}

}  // namespace fw::mesh
