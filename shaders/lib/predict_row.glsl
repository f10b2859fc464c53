// A row of eight texels of a tile of the predict list.
struct PredictRow {
    bool shows;  // false: its object is gone, or `support` writes the tile's display
    uint worldTile, flag, object, local, tileX, tileY;
    uint texel;  // first of the row, in the object's map
    uvec4 bases, places, sizes;  // of the object
};
PredictRow predictRowOf(uint slot, uint row) {
    PredictRow r;
    r.worldTile = predictLists[2u * slot + push.predictParity];
    r.flag = tileState[r.worldTile].flag;
    r.object = tileState[r.worldTile].object;
    r.bases = objectBases(r.object);
    r.places = objectPlaces(r.object);
    r.sizes = objectSizes(r.object);
    r.local = r.worldTile - r.places.x;
    r.tileY = divide(r.local, r.sizes.z);
    r.tileX = r.local - r.tileY * r.sizes.z;
    r.texel = (r.tileY * r.bases.w + r.tileX) * 8u + row * r.bases.w;
    r.shows = (r.flag & kTileFalling) == 0u && (r.places.w & kObjectLive) != 0u &&
              r.local < r.sizes.w;
    return r;
}
