// Shared by a frame's shaders: the uniform block and the shadow map. FrameUniform in renderer.cpp
// mirrors it.
const int kMaxLights = 16;

layout(set = 0, binding = 0) uniform Frame {
    mat4 viewProjection;
    mat4 shadowMatrix;   // world to the shadow map: xy in [0, 1], z its depth
    vec4 eye;            // w: the shadow map's side, texels
    vec4 toSun;          // w: shadow texel, m
    vec4 sun;            // radiance x pi/2 into a Lambert/pi surface; w: lights in use
    vec4 sky;  // w: brightness of lit windows
    vec4 ground;
    vec4 haze;
    vec4 cameraRight;  // of the billboards; w: emission of the jet relative to the scene's light
    vec4 cameraUp;       // w: time, s
    vec4 wind;  // m/s along x and z; zw: m, distance that gusts have moved
    vec4 lightPlaces[kMaxLights];  // w: reach, m
    vec4 lightColors[kMaxLights];  // w: radius of the source, m
} frame;

layout(set = 0, binding = 1) uniform sampler2D shadowMap;
