// A HeatMaterial by four words.
FW_BUFFER(HEAT_MATERIALS, readonly, uvec4, heatQuads)
HeatMaterial heatMaterial(uint material) {
    uvec4 q[6];
    FW_UNROLL for (uint i = 0u; i < 6u; ++i) q[i] = heatQuads[material * 6u + i];
    return HeatMaterial(q[0].x, q[0].y, q[0].z, q[0].w, q[1].x, q[1].y, q[1].z, q[1].w,
                        q[2].x, q[2].y, q[2].z, q[2].w, q[3].x, q[3].y, q[3].z, q[3].w,
                        q[4].x, q[4].y, q[4].z, q[4].w, q[5].x, q[5].y, q[5].z,
                        uintBitsToFloat(q[5].w));
}
