#version 450
// Places one object's drawn mesh. Positions leave it relative to the eye, so that derivatives of
// them stay precise far from the world's origin.
#extension GL_GOOGLE_include_directive : require
#include "shared/burn.h"
#include "shared/look.h"

layout(set = 0, binding = FW_BIND_OBJECTS, std430) readonly buffer Objects {
    BurnObject objects[];
};
layout(set = 0, binding = FW_BIND_MATERIALS, std430) readonly buffer Materials {
    BurnMaterial materials[];
};
layout(set = 0, binding = FW_BIND_LOOKS, std430) readonly buffer Looks { MaterialLook looks[]; };
layout(set = 0, binding = FW_BIND_VIEW, std140) uniform View { ViewParams view; };
layout(push_constant) uniform Push { uint objectSlot; };

layout(location = 0) in vec3 inPosition;
layout(location = 1) in uint inNormal;  // signed 11:11:10
layout(location = 2) in vec2 inAtlas;
layout(location = 3) in vec2 inTexture;
layout(location = 4) in vec2 inDetail;
layout(location = 5) in vec4 inTint;
layout(location = 6) in uint inMaterial;

layout(location = 0) out vec3 outPosition;  // m, world, from the eye
layout(location = 1) out vec3 outRest;      // m, object axes, world scale
layout(location = 2) out vec3 outNormal;
layout(location = 3) out vec2 outAtlas;     // texels
layout(location = 4) out vec4 outTexture;   // xy: UV; zw: m, detail
layout(location = 5) out vec3 outTint;
layout(location = 6) flat out uvec2 outMaterial;  // index; kBase...

void main() {
    vec4 row0 = objects[objectSlot].worldRow0;
    vec4 row1 = objects[objectSlot].worldRow1;
    vec4 row2 = objects[objectSlot].worldRow2;
    float scale = length(row0.xyz);
    int n = int(inNormal);
    vec3 normal = vec3(float((n << 21) >> 21), float((n << 10) >> 21), float(n >> 22) * 2.0);

    vec3 offset = vec3(row0.w, row1.w, row2.w) - view.eye.xyz;
    outPosition = vec3(dot(row0.xyz, inPosition), dot(row1.xyz, inPosition),
                       dot(row2.xyz, inPosition)) + offset;
    outRest = inPosition * scale;
    outNormal = vec3(dot(row0.xyz, normal), dot(row1.xyz, normal), dot(row2.xyz, normal));
    outAtlas = inAtlas;
    outTexture = vec4(inTexture, inDetail * scale);
    outTint = inTint.rgb * objects[objectSlot].tint.rgb;
    outMaterial = uvec2(inMaterial,
                        looks[materials[objectSlot * kMaterialsPerObject + inMaterial].look].base);
    gl_Position = view.clip0 * outPosition.x + view.clip1 * outPosition.y +
                  view.clip2 * outPosition.z + view.clip3;
}
