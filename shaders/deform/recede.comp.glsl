// Burnt share of each particle, and its recession. kDeformGroup particles of one object per group.
#include "lib/deform.glsl"
FW_READ(STATE) FW_READ(DEFORM_PARTICLES) FW_READ_WRITE(SHOWN) FW_READ_WRITE(SOFT)

void main() {
    DeformItem item = deformItem();
    uvec2 sizes = deformObjects[item.object].xy;
    uvec4 bases = deformObjects[item.object + 1u];
    uint softBase = deformObjects[item.object + 3u].x;
    uvec2 material0 = deformObjects[item.object + 4u].xy,
          holes0 = deformObjects[item.object + 5u].xy;
    bool moves = (bases.z & (kDeformShell | kDeformExtended)) != 0u;

    uint last = min(item.end, sizes.y);
    uint number = item.number;
    if (number >= last) return;
    do {
        uint at = sizes.x * kDeformParticleQuads + number;
        uvec4 facts = deformParticle(at), rest = deformParticle(at + kParticleRest * sizes.y);
        uvec2 material = material0, holes = holes0;
        if ((facts.y & 7u) != 0u) {
            uint materialAt = item.object + 4u + (facts.y & 7u) * 2u;
            material = deformObjects[materialAt].xy;
            holes = deformObjects[materialAt + 1u].xy;
        }

        float sum = 0.0, known = 0.0;
        FW_UNROLL for (uint q = 0u; q < kDeformTexels / 4u; ++q) {
            uvec4 texels = deformParticle(at + (kParticleTexels + q) * sizes.y);
            FW_UNROLL for (uint k = 0u; k < 4u; ++k) {
                bool there = texels[k] != kNoneTexel;
                uint t = state[bases.y + (there ? texels[k] : 0u)];
                sum += there ? burntShare(t, push.now, push.up.w, material.x) : 0.0;
                known += there ? 1.0 : 0.0;
            }
        }
        uint vertex = (bases.x + facts.x) * kShownQuads;
        // The share never falls: extinguished material stays burnt.
        float before_ = item.reset ? 0.0 : shown(vertex + 1u).x;
        float burnt = max(before_, sum / max(known, 1.0));

        float behind = 0.0;
        if (facts.w != kNoneTexel && !item.crosses)
            behind = uintBitsToFloat(holes.y) *
                     burntShare(state[bases.y + facts.w], push.now, push.up.w, holes.x);

        vec3 place = uintBitsToFloat(rest.xyz);
        float depth = uintBitsToFloat(material.y), lost = 0.0, kept = 0.0;
        if (!moves) {
            vec4 out_ = uintBitsToFloat(deformParticle(at + kParticleRecession * sizes.y));
            kept = recession(burnt, depth, item.crosses ? 1e9 : out_.w);
            place += out_.xyz * kept;
        }
        // The solver owns positions: this pass reports burnt shares to it, and the rest pose at
        // first.
        if (moves) {
            uint own = softBase * kSoftQuads + number, seenAt = own + kSoftFacts * sizes.y;
            uint placeAt = own + item.parity * sizes.y;
            uvec4 seen = soft(seenAt);
            float path = unpackPathLength(pathBits(soft(placeAt)));
            if (item.reset) {
                path = kNoPath;
                for (uint i = 0u; i < bases.w; ++i) {
                    vec4 from = uintBitsToFloat(deformObjects[item.object + 20u + i * 2u]);
                    vec4 to = uintBitsToFloat(deformObjects[item.object + 21u + i * 2u]);
                    // Known from the start: otherwise a sheet would fall until its pins' distances
                    // have spread.
                    float away = length(place - pinPoint(place, from.xyz, to.xyz)) - from.w;
                    path = min(path, max(away, 0.0));
                }
                bool sheet = (bases.z & kDeformShell) != 0u;
                softOut[placeAt] =
                    uvec4(sheet ? softPlace(place, packPathLength(path, false)) : rest.xyz, 0u);
            }
        // Bend shares from before it slept belong to another bending set.
            softOut[seenAt] = uvec4(packParticleFacts(burnt, path == 0.0), 0u,
                                    item.reset || item.woke ? uvec2(0u) : seen.zw);
            if (!item.reset) place = shown(vertex).xyz;
            // Recession since the last frame, in equal parts for the steps.
            float steps = float(push.parity >> 1u);
            kept = (item.reset ? 0.0 : shown(vertex + 1u).z) + depth * (burnt - before_);
            if (item.reset) kept = 0.0;
            if (steps > 0.5) {
                lost = kept / steps;
                kept = 0.0;
            }
        }
        readBeforeWritten();
        shownOut[vertex] = floatBitsToUint(vec4(place, 0.0));
        shownOut[vertex + 1u] = floatBitsToUint(vec4(burnt, lost, kept, behind));
        number += 64u;
    } while (number < last);
}
