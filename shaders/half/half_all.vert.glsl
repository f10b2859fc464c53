// Covers the viewport.
void main() {
    uint corner = uint(gl_VertexIndex) % 6u;
    corner = corner < 3u ? corner : 6u - corner;  // 0 1 2, 3 2 1
    gl_Position = vec4(2.0 * vec2(float(corner & 1u), float(corner >> 1u)) - 1.0, 0.0, 1.0);
}
