// Uniforms that relief.vert, relief.frag and relief.cpp share. std140.
layout(std140, set = 0, binding = 0) uniform Block {
    mat4 viewProjection;
    vec4 eye;            // m; w: exposure
    vec4 sunDirection;   // towards the sun; w: number of fires
    vec4 sunColor;
    vec4 ambientSky;
    vec4 ambientGround;
    vec4 firePlace[4];  // m; w: radius, m
    vec4 fireColor[4];   // irradiance at 1 m
} block;
