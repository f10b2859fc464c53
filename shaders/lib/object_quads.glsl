// An object's record by four words.
#ifndef FW_LIB_OBJECT_QUADS_GLSL
#define FW_LIB_OBJECT_QUADS_GLSL
FW_BUFFER(OBJECTS, readonly, uvec4, objectQuads)
uvec4 objectBases(uint object) { return objectQuads[object * 10u]; }  // texelBase .. width
uvec4 objectPlaces(uint object) { return objectQuads[object * 10u + 1u]; }  // .. flags
uvec4 objectSizes(uint object) { return objectQuads[object * 10u + 2u]; }  // tileBase .. tileCount
uvec4 objectTimes(uint object) { return objectQuads[object * 10u + 3u]; }  // window .. image
#endif
