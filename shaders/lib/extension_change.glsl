// Of an object that an extension burns: a texel changed. The shaders of an extension include its
// own file of this name.
void extensionChanged(uint object, uint texel, bool burns) {}
