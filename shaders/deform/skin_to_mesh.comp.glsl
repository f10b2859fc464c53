// Skin-to-mesh: drawn vertices follow their particles, and rest normals rotate with their
// triangles. kDeformGroup vertices of one object per group.
#include "lib/deform.glsl"
FW_READ(DEFORM_EMBEDDINGS) FW_READ_WRITE(SHOWN) FW_BUFFER(SHOWN, writeonly, uint, shownWords)

void main() {
    DeformItem item = deformItem();
    uvec4 sizes = deformObjects[item.object];
    uvec4 bases = deformObjects[item.object + 1u];
    uint shownBase = bases.x;
    bool tears = (bases.z & kDeformShell) != 0u;

    uint last = min(item.end, sizes.w);
    uint number = item.number;
    if (number >= last) return;
    do {
        uint at = sizes.z * kDeformEmbeddingQuads + number;
        uvec2 embedding = deformEmbedding(at).xy;
        uvec4 face = deformEmbedding(at + 3u * sizes.w);
        uint particle = shownBase + embedding.x;
        vec3 place = shown(particle * kShownQuads).xyz;
        vec4 facts = shown(particle * kShownQuads + 1u);

        vec3 turned = vec3(0.0), before = vec3(0.0);
        float square = 0.0;
        FW_UNROLL for (uint q = 0u; q < kDeformRing / 4u; ++q) {
            uvec4 ring = deformEmbedding(at + (1u + q) * sizes.w);
            FW_UNROLL for (uint k = 0u; k < 4u; ++k) {
                vec3 edge = shown((shownBase + ring[k]) * kShownQuads).xyz - place;
                turned += cross(before, edge);
                square = max(square, dot(edge, edge));
                before = edge;
            }
        }
        float size = length(turned);
        vec3 rest = unpackDirection(embedding.y);
        vec3 normal = rest;
        if (size > 1e-18) normal = rotateNormal(rest, uintBitsToFloat(face.xyz), turned / size);
        float offset = facts.w;
        if (tears) offset = max(offset, tornOffset(square, uintBitsToFloat(face.w), facts.x));
        // Exact rest normals at rest.
        uint packed = all(equal(normal, rest)) ? embedding.y : packDirection(normal);
        uint self = shownBase + number;
        if (self == particle) {
            shownWords[self * kShownQuads * 4u + 3u] = packed;
            shownWords[self * kShownQuads * 4u + 11u] = floatBitsToUint(offset);
        } else {
            shownOut[self * kShownQuads] = floatBitsToUint(vec4(place, uintBitsToFloat(packed)));
            shownOut[self * kShownQuads + 2u] = floatBitsToUint(vec4(0.0, 0.0, 0.0, offset));
        }
        number += 64u;
    } while (number < last);
}
