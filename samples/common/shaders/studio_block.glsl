// Uniforms that studio.vert, studio.frag and studio.cpp share. std140.
layout(std140, set = 0, binding = 0) uniform Block {
    mat4 viewProjection;
    vec4 sunDirection;     // towards the sun; w: exposure
    vec4 sunColor;  // w: metres per tile of the plaster
    vec4 ambientSky;       // w: half side of the shadow map, m
    vec4 ambientGround;    // w: number of fires
    vec4 center;           // of the floor, m; w: radius of the room, m
    vec4 firePlace[8];     // m; w: squared radius, m^2
    vec4 fireColor[8];     // irradiance at 1 m
} block;
