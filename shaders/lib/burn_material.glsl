// A material's record by four words, as far as the spread law needs it.
FW_BUFFER(MATERIALS, readonly, uvec4, materialQuads)
BurnMaterial burnMaterial(uint material) {
    uvec4 a = materialQuads[material * 7u];
    uvec4 b = materialQuads[material * 7u + 1u];
    uvec4 c = materialQuads[material * 7u + 2u];
    BurnMaterial m;
    m.sigma0 = a.x;
    m.headGain = a.y;
    m.backGain = a.z;
    m.driveMax = a.w;
    m.breadthMax = b.x;
    m.burnTicks = b.y;
    m.ceiling = b.z;
    m.driveX = int(c.x);
    m.driveY = int(c.y);
    m.driveZ = int(c.z);
    m.upCeiling = materialQuads[material * 7u + 5u];
    m.windowMax = materialQuads[material * 7u + 6u].y;
    return m;
}
uint burnTicksOf(uint material) { return materialQuads[material * 7u + 1u].y; }
