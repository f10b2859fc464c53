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

const uint kAheadFar = 0xFFFFFF00u;  // the fire is out of sight
uint packAhead(float texels) { return floatBitsToUint(texels) & ~0xFFu; }
float unpackAhead(uint word) {
    return (word & ~0xFFu) == kAheadFar ? 1e3 : min(uintBitsToFloat(word & ~0xFFu), 1e3);
}
#endif
