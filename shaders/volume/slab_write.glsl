// Output of a march: what each slab of a march pixel adds, and which slabs of a tile show. Needs
// `rays` and `march`.

// The tile that this group marches.
uint listedTile() {
    uint tiles = march.pixels / (kMarchTileSide * kMarchTileSide);
    return rays[march.tiles + kMarchTileList * tiles + gl_WorkGroupID.x];
}

// Stores what slab `s` adds to the light without it and those behind; where_: light, and its first
// and second moment in the slab. The nearest slabs then compose to exactly what one ray would show.
// Also stores the transmittance in front, which is the march pixel's weight among its neighbours.
vec4 keep(vec4 before, vec4 shown, uint s, uint pixel, vec3 where_) {
    float left = 1.0 / max(1.0 - before.a, 1e-4);
    vec4 color = max((shown - before) * left, 0.0);
    float middle = where_.y / max(where_.x, 1e-20);
    // Half width of a uniform range with that variance.
    float half_ = sqrt(3.0 * max(where_.z / max(where_.x, 1e-20) - middle * middle, 1e-4));
    half_ = min(half_, min(middle, 1.0 - middle));  // within the slab, around the same middle
    vec2 reach = vec2(middle - half_, middle + half_);
    uint at = march.samples + kMarchPixelWords * (march.pixels * s + pixel);
    rays[at] = packHalf2x16(color.rg);
    rays[at + 1u] = packHalf2x16(color.ba);
    rays[at + 2u] = packSlabRange(reach, 1.0 - before.a);
    return color;
}

void nothing(uint s, uint pixel, float through) {
    uint at = march.samples + kMarchPixelWords * (march.pixels * s + pixel);
    rays[at] = rays[at + 1u] = 0u;
    rays[at + 2u] = packSlabRange(vec2(0.0, 1.0), through);
}

bool shows(vec4 color) { return max(max(color.r, color.g), max(color.b, color.a)) > 1e-4; }

// bits: slabs that a march pixel of the tile shows.
void markTile(uint tile, uvec2 in_, uint bits) {
    // First and last column, first and last row of the tile.
    uint edges = (in_.x == 0u ? 1u : 0u) | (in_.x == kMarchTileSide - 1u ? 2u : 0u) |
                 (in_.y == 0u ? 4u : 0u) | (in_.y == kMarchTileSide - 1u ? 8u : 0u);
    if (bits != 0u) atomicOr(rays[march.tiles + tile], bits | (edges << kVolumeSlabs));
}
