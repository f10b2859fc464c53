// Offset of flame quads towards the camera, so that a wall behind does not cut them.
const float kQuadNearer = 0.35;  // half widths
