// Ring of a rim texel, anywhere in the object's map. tile: row of `tiles`; lane: of the texel in
// its tile.
uint[8] rimRing(uint object, uint tile, uint lane) {
    uvec4 rim = tiles[tile * 2u + 1u];
    uint below = lane < 32u ? uint(bitCount(rim.x & ((1u << lane) - 1u)))
                            : uint(bitCount(rim.x) + bitCount(rim.y & ((1u << (lane - 32u)) - 1u)));
    uint record = (objects[object].linkBase + rim.z + below) * 2u;
    uvec4 a = linkQuads[record];
    uvec4 b = linkQuads[record + 1u];
    return uint[8](a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w);
}
