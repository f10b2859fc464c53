// How far flames and fire stand before where they are, so that a wall behind does not cut their side.
const float kQuadNearer = 0.35;  // half widths, towards the eye
