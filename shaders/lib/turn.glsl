// Transforms a normal by the cofactors of a matrix given by rows, which does not mirror; not of
// unit length.
vec3 turnNormal(vec3 row0, vec3 row1, vec3 row2, vec3 n) {
    return vec3(dot(cross(row1, row2), n), dot(cross(row2, row0), n), dot(cross(row0, row1), n));
}
