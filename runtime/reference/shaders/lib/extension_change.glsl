// A texel of the published kernel is lit or put out: S * D, twice.
FW_BUFFER(EXTENSION_TILES, FW_BOTH, float, published)

void extensionChanged(uint object, uint texel, bool burns) {
    uint plane = objects[object].width * objects[object].height;
    uint base = objects[object].extensionBase + texel;
    float q = burns ? published[base + 2u * plane] : 0.0;
    published[base] = q;
    published[base + plane] = q;
}
