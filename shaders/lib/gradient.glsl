// A word of FW_BIND_GRADIENT. Low byte: soot. Texel with a time: its gradient. Wet texel: distance
// to the fire. Texel that was put out (kOut,
// kOutWet): ticks that it burnt until then, without soot.

// Two half floats without their last four bits.
uint packGradient(vec2 slope) {
    uint word = packHalf2x16(slope * (1.0 + 1.0 / 256.0));  // middle of the truncated range
    return (word & 0xFFF00000u) | ((word & 0xFFF0u) << 4u);
}
vec2 unpackGradient(uint word) {
    return unpackHalf2x16((word & 0xFFF00000u) | ((word >> 4u) & 0xFFF0u));
}

// Wet texel: 12 bits that are read, in 64ths of a texel, and below them 12 bits that the next round
// reads, see predict_commit.
const uint kAheadFar = 0xFFFFFF00u;  // the fire is out of sight
bool isAheadFar(uint word) { return (word & 0xFFF00000u) == (kAheadFar & 0xFFF00000u); }
uint packAheadNext(uint word, float texels) {
    return (word & 0xFFF000FFu) | min(uint(texels * 64.0 + 0.5), 0xFFEu) << 8u;
}
uint aheadTurned(uint word) { return (word & 0xFFFFFu) | (word << 12u & 0xFFF00000u); }
float unpackAhead(uint word) { return isAheadFar(word) ? 1e3 : float(word >> 20u) * (1.0 / 64.0); }
