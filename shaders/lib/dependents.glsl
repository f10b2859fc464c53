// Tiles that depend on the texels of a tile: those beside it, and over seams.
FW_READ(TILES) FW_READ(DEPENDENTS)

// Bits of a lane of a tile.
uvec2 laneMask(uint lane) {
    return lane < 32u ? uvec2(1u << lane, 0u) : uvec2(0u, 1u << (lane - 32u));
}
// The same for texels of a row, by bits.
uvec2 rowMask(uint row, uint bits) {
    bits <<= (row & 3u) * 8u;
    return row < 4u ? uvec2(bits, 0u) : uvec2(0u, bits);
}
// Local tile `k` of the eight beside tile (tileX, tileY), or kNoneTexel.
uint besideTile(int tilesX, int tilesY, int tileX, int tileY, uint k) {
    // The ring (front.h) packed in words: `k` is not constant, and devices index arrays slowly.
    int x = tileX + int((0x901Au >> (2u * k)) & 3u) - 1;
    int y = tileY + int((0x01A9u >> (2u * k)) & 3u) - 1;
    return x < 0 || y < 0 || x >= tilesX || y >= tilesY ? kNoneTexel : uint(y * tilesX + x);
}
