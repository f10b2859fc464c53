// Converts the scene to display values: bloom, filmic curve, sRGB, dither.
#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
layout(binding = 0) uniform sampler2D scene;
layout(binding = 1) uniform sampler2D spread;  // from bloom.frag
layout(push_constant) uniform Push {
    float mode;  // 0: scene-referred floats, 1: an sRGB view, 2: display values
    float exposure;
    float bloom;
    float vignette;
    float aspect;
} push;

// Rec.709 to and from the curve's space, with S. Hill's fit of the ACES curve.
vec3 filmCurve(vec3 c) {
    const mat3 into = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566,
                           0.83777);
    const mat3 back = mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367,
                           -0.00605, 1.07602);
    c = into * c;
    c = (c * (c + 0.0245786) - 0.000090537) / (c * (0.983729 * c + 0.4329510) + 0.238081);
    return clamp(back * c, 0.0, 1.0);
}

vec3 encodeSrgb(vec3 c) {
    return mix(12.92 * c, 1.055 * pow(max(c, vec3(1e-8)), vec3(1.0 / 2.4)) - 0.055,
               step(0.0031308, c));
}

void main() {
    vec3 c = textureLod(scene, uv, 0.0).rgb;
    if (push.mode < 0.5) {
        if (push.bloom > 0.0) c = mix(c, textureLod(spread, uv, 0.0).rgb, push.bloom);
        c *= push.exposure;
        vec2 away = (uv - 0.5) * vec2(1.0, 1.0 / push.aspect);
        c *= 1.0 - push.vignette * smoothstep(0.15, 0.75, length(away));
        c = encodeSrgb(filmCurve(max(c, vec3(0.0))));
    } else if (push.mode < 1.5) {
        c = encodeSrgb(clamp(c, 0.0, 1.0));
    }
    // A fixed one-step dither hides banding in the dark and keeps animations small.
    uint h = uint(gl_FragCoord.x) * 1664525u ^ uint(gl_FragCoord.y) * 22695477u;
    h ^= h >> 15;
    h *= 0x2c1b3c6du;
    h ^= h >> 12;
    if (push.mode < 0.5) c += (float(h & 0xffffu) / 65535.0 - 0.5) / 255.0;
    color = vec4(c, 1.0);
}
