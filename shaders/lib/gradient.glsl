// What a texel's word in FW_BIND_GRADIENT says besides its soot, the low byte: of a texel with a time
// its gradient, of a wet one how far the fire is. One that was put out has no soot: see burn.h.
#ifndef FW_LIB_GRADIENT_GLSL
#define FW_LIB_GRADIENT_GLSL

// Two halves without their last four bits.
uint packGradient(vec2 slope) {
    uint word = packHalf2x16(slope * (1.0 + 1.0 / 256.0));  // the middle of what is cut off
    return (word & 0xFFF00000u) | ((word & 0xFFF0u) << 4u);
}
vec2 unpackGradient(uint word) {
    return unpackHalf2x16((word & 0xFFF00000u) | ((word >> 4u) & 0xFFF0u));
}

// Of a wet texel: 12 bits that are read, in 64ths of a texel, and below them 12 that the next round
// reads, see predict_commit.
const uint kAheadFar = 0xFFFFFF00u;  // the fire is out of sight
bool isAheadFar(uint word) { return (word & 0xFFF00000u) == (kAheadFar & 0xFFF00000u); }
uint packAheadNext(uint word, float texels) {
    return (word & 0xFFF000FFu) | min(uint(texels * 64.0 + 0.5), 0xFFEu) << 8u;
}
uint aheadTurned(uint word) { return (word & 0xFFFFFu) | (word << 12u & 0xFFF00000u); }
float unpackAhead(uint word) { return isAheadFar(word) ? 1e3 : float(word >> 20u) * (1.0 / 64.0); }
#endif
