// Inner skin of receding meshes: drawn vertices seen from inside. It stays in place while the outer
// wall burns away, and recedes when little of the wall is left. Holes open in both skins at once.
// kDeformGroup vertices of one object per group.
#include "lib/deform.glsl"
FW_READ(DEFORM_EMBEDDINGS) FW_READ_WRITE(SHOWN) FW_READ(VERTICES)

void main() {
    DeformItem item = deformItem();
    uvec4 sizes = deformObjects[item.object];
    uint shownBase = deformObjects[item.object + 1u].x;
    uvec4 facts3 = deformObjects[item.object + 3u];
    uint innerFirst = facts3.y;
    float wall = uintBitsToFloat(facts3.z), thinnest = kThinnestWall * wall;

    uint last = min(item.end, sizes.w);
    uint number = item.number;
    if (number >= last) return;
    do {
        uint particle = shownBase + deformEmbedding(sizes.z * kDeformEmbeddingQuads + number).x;
        uint self = shownBase + number, inner = self + sizes.w;
        vec4 outside = shown(self * kShownQuads);
        float receded = shown(particle * kShownQuads + 1u).z;
        float offset = shown(self * kShownQuads + 2u).w;
        vec3 inside = uintBitsToFloat(meshVertices[(innerFirst + number) * kShownQuads].xyz);
        // A mesh vertex and a shown vertex have the same size.
        vec3 thin = outside.xyz - unpackDirection(floatBitsToUint(outside.w)) * thinnest;
        vec3 place = mix(thin, inside, saturate((wall - receded) / thinnest - 1.0));
        shownOut[inner * kShownQuads] = floatBitsToUint(vec4(place, outside.w));
        shownOut[inner * kShownQuads + 2u] = floatBitsToUint(vec4(0.0, 0.0, 0.0, offset));
        number += 64u;
    } while (number < last);
}
