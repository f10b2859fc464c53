// The host's lighting by time of day. Linear Rec.709. A sun's value is radiance x pi/2 into a
// Lambert/pi surface; ambient is a hemisphere around up.
#pragma once

#include <glm/glm.hpp>
#include <string>

namespace tower {

struct PointLight {
    glm::vec3 place;     // m
    float reach = 8;     // m, zero light beyond
    glm::vec3 color;     // linear, per unit distance
    float size = 0.75f;  // m, radius of the source
};

struct Daylight {
    glm::vec3 toSun;  // unit
    glm::vec3 sun, sky, ground, haze;
    float exposure;
    float windows;   // brightness of lit windows
    float emission;  // fire relative to the scene's light
};

inline Daylight mix(const Daylight& a, const Daylight& b, float t) {
    auto one = [t](float x, float y) { return x + (y - x) * t; };
    return {glm::normalize(glm::mix(a.toSun, b.toSun, t)),
            glm::mix(a.sun, b.sun, t),
            glm::mix(a.sky, b.sky, t),
            glm::mix(a.ground, b.ground, t),
            glm::mix(a.haze, b.haze, t),
            one(a.exposure, b.exposure),
            one(a.windows, b.windows),
            one(a.emission, b.emission)};
}
inline Daylight goldenHour() {
    return {glm::normalize(glm::vec3(-0.78f, 0.42f, 0.36f)),
            {6.2f, 3.35f, 1.42f},
            {0.74f, 0.80f, 1.12f},
            {0.52f, 0.36f, 0.20f},
            {0.95f, 0.62f, 0.36f},
            0.97f,
            0.45f,
            1.0f};
}
inline Daylight noon() {
    return {glm::normalize(glm::vec3(0.38f, 0.86f, 0.34f)),
            {5.0f, 4.75f, 4.25f},
            {0.78f, 0.98f, 1.30f},
            {0.34f, 0.32f, 0.22f},
            {0.62f, 0.75f, 0.88f},
            0.76f,
            0.12f,
            1.0f};
}
inline Daylight moonlight() {
    return {glm::normalize(glm::vec3(0.55f, 0.62f, -0.42f)),
            {0.20f, 0.29f, 0.50f},
            {0.055f, 0.085f, 0.17f},
            {0.022f, 0.028f, 0.04f},
            {0.035f, 0.055f, 0.10f},
            2.5f,
            1.6f,
            0.4f};
}

}  // namespace tower
