// Of a new object that an extension burns: the initial state of a texel. The shaders of an
// extension include its own file of this name.
void extensionReset(uint object, uint texel, uint material, uint slow, bool burns) {}
