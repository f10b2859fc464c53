// Tiles and texels of objects.

// A world tile as its object sees it. Entries of a destroyed object are met in lists until the next
// pass drops them: `alive` is false for those.
struct TileRef {
    uint object, local;
    bool alive;
};
TileRef tileRef(uint worldTile) {
    TileRef r;
    r.object = tileState[worldTile].object;
    r.local = worldTile - objects[r.object].worldTileBase;
    r.alive = (objects[r.object].flags & kObjectLive) != 0u &&
              r.local < objects[r.object].tileCount;
    return r;
}
// Is the object of a burning tile still there? Another may have its slot before `reduce` lists the
// tiles again.
bool burnTileAlive(uint object, uint local) {
    return (objects[object].flags & kObjectLive) != 0u && local < objects[object].tileCount;
}
// Texel of a lane of a tile, in the object's own map.
uint texelOf(uint object, uint local, uint lane) {
    uint tilesX = objects[object].tilesX;
    return ((local / tilesX) * 8u + (lane >> 3u)) * objects[object].width +
           (local % tilesX) * 8u + (lane & 7u);
}
