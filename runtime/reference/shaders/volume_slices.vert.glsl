// Sliced lattice of a volumetric flame: an instance is a plane across the view, far to near; it
// contains the polygon that the plane cuts out of each lattice piece.
#include "volume/flame.glsl"
#include "reference/slices_push.h"

layout(push_constant) uniform Push { SlicesPush draw; };

#include "reference/volume_slices.h"

layout(location = 0) centroid out vec4 outPlace;  // m: off the axis, along it, the tube's radius
layout(location = 1) centroid out vec3 outOff;          // m, relative to the camera
layout(location = 2) flat out vec2 outShows;
layout(location = 3) flat out float outDepth;  // m along the view
layout(location = 4) flat out uint outZero;
layout(location = 5) centroid out vec4 outSlope;        // of outPlace, per m along the view

void main() {
    uint vertex = uint(gl_VertexIndex);
    uint piece = vertex / kSliceVertices;
    uint zero = vertex >> 31u;  // not constant, see volume_march
    FlameRecord f = flame.record;
    f.smoke += float(zero);
    FlameNode a = FW_FLAME_NODE(flameNodeOf(piece));
    FlameNode b = FW_FLAME_NODE(flameNodeOf(piece + 1u));
    float depth =
        draw.front + draw.spacing * (float(draw.slices - 1u - uint(gl_InstanceIndex)) + 0.5);
    SlicePoint point = sliceVertex(f, a, b, view.eye.xyz, view.forward.xyz, depth,
                                   sliceFan(vertex - kSliceVertices * piece));
    FlamePlace place = slicePlace(a, b, point.at);
    outPlace = vec4(place.p, place.s, place.radius);
    // Half a slice further along the ray.
    vec3 ray = mix(view.forward.xyz, (point.at - view.eye.xyz) / max(depth, 1e-6), view.forward.w);
    vec3 beyond = point.at + 0.5 * draw.spacing * ray;
    place = flamePlaceAt(beyond, a, b, flamePlane(beyond, a), flamePlane(beyond, b));
    outSlope = (vec4(place.p, place.s, place.radius) - outPlace) / (0.5 * draw.spacing);
    outOff = point.at - view.eye.xyz;
    outShows = vec2(draw.from, draw.to) + float(zero);
    outDepth = depth;
    outZero = zero;
    float top = f.high.w * max(kFlameTop, f.smoke > 0.0 ? f.smokeTop : 0.0);
    bool shows = point.corners > 0u && a.along.w < top;
    vec4 clip = outOff.x * view.clip0 + outOff.y * view.clip1 + outOff.z * view.clip2 + view.clip3;
    gl_Position =
        shows ? vec4(clip.xy, clamp(clip.z, 0.0, clip.w), clip.w) : vec4(0.0, 0.0, 0.0, 1.0);
}
