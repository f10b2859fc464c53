// One step of sheets: each particle moves by its links, bending constraints and pins, and on with
// the resulting velocity. It applies its own bend correction now and those of its neighbours from
// the last step, since theirs are only known after this step. kDeformGroup particles of one object
// per group.
#include "lib/deform.glsl"
FW_READ(DEFORM_PARTICLES) FW_READ_WRITE(SHOWN) FW_READ_WRITE(SOFT)
#include "lib/object_quads.glsl"

// World directions in object axes. facts: third quad of the DeformObject, which holds the object
// slot.
vec3 rowOf(uvec4 facts, uint row) {
    return uintBitsToFloat(objectQuads[facts.y * 10u + 5u + row].xyz);
}
vec3 toObject(uvec4 facts, vec3 v) {  // a direction, its length kept
    return (rowOf(facts, 0u) * v.x + rowOf(facts, 1u) * v.y + rowOf(facts, 2u) * v.z) /
           uintBitsToFloat(facts.z);
}
vec3 upHere(uvec4 facts) { return toObject(facts, push.up.xyz); }
vec4 heightHere(uvec4 facts) {  // m, world, along up: dot with (position, 1)
    vec4 h = vec4(0.0);
    FW_UNROLL for (uint row = 0u; row < 3u; ++row)
        h += push.up[row] * uintBitsToFloat(objectQuads[facts.y * 10u + 5u + row]);
    return h;
}

void main() {
    DeformItem item = deformItem();
    uvec2 sizes = deformObjects[item.object].xy;
    uvec4 bases = deformObjects[item.object + 1u];
    uvec4 facts2 = deformObjects[item.object + 2u];
    uint softBase = deformObjects[item.object + 3u].x;
    uvec4 material0 = deformObjects[item.object + 4u], more0 = deformObjects[item.object + 5u];
    float ground = uintBitsToFloat(facts2.x), scale = uintBitsToFloat(facts2.z);
    vec3 up = upHere(facts2);
    vec3 windHere = push.wind.xyz + 0.001 * vec3(unpackWind(objectQuads[facts2.y * 10u + 9u].w));
    vec3 wind = toObject(facts2, windHere) / scale;
    vec4 height = heightHere(facts2);
    uint set = push.parity >> 1u, echoed = (set + kBendSets - 1u) % kBendSets;

    uint last = min(item.end, sizes.y);
    uint number = item.number;
    if (number >= last) return;
    do {
        uint at = sizes.x * kDeformParticleQuads + number;
        uvec4 facts = deformParticle(at);
        uvec4 material = material0, more = more0;
        if ((facts.y & 7u) != 0u) {
            uint materialAt = item.object + 4u + (facts.y & 7u) * 2u;
            material = deformObjects[materialAt];
            more = deformObjects[materialAt + 1u];
        }
        float shrink = uintBitsToFloat(material.z), curl = uintBitsToFloat(material.w);
        float bend = uintBitsToFloat(more.z), drag = uintBitsToFloat(more.w);

        uint own = softBase * kSoftQuads + number, places = own - number + item.parity * sizes.y;
        uint seenAt = own - number + kSoftFacts * sizes.y;
        uvec4 self = soft(places + number);
        vec3 x = placeOf(self);
        uvec4 cache = soft(own + kSoftLinkCache * sizes.y);
        float burnt = burntOf(cache.w), charred = charredShare(burnt), reach = kNoPath;
        bool pinned = pinnedOf(cache.w) != 0u;
        // Both ends of a link use the same length.
        float shrunk = shrink * 0.5 / kCharredSteps, mine = floor(charred * kCharredSteps + 0.5);
        // Charring stiffens loose material.
        float stiff = mix(bend, max(bend, 0.9), charred);

        vec3 turned = vec3(0.0), before = vec3(0.0), first = vec3(0.0), nearSum = vec3(0.0);
        vec3 links = vec3(0.0), bending = vec3(0.0);
        vec2 nearSquares = vec2(0.0);  // of rest lengths, and how many
        uint turn = 0u, turns = linkPasses(facts.y);
        do {  // the neighbours
            uvec4 two = deformParticle(at + (kParticleLinks + turn) * sizes.y);
            FW_UNROLL for (uint i = 0u; i < kLinksPerPass; ++i) {
                uint k = turn * kLinksPerPass + i;
                float rest = unpackHalf2x16(two.z)[i];
                uvec4 there = soft(places + (two[i] & kDeformLinkIndex));
                vec3 y = placeOf(there), link = y - x;
                bool holds = (cache.x >> k & 1u) != 0u;
                // A particle with a parted link is not whole and gives no share.
                bending -= holds ? unpackBendShare(there.w) : vec3(0.0);
                nearSum += holds ? link : vec3(0.0);
                nearSquares += holds ? vec2(rest * rest, 1.0) : vec2(0.0);
                turned += cross(before, link);
                if (k == 0u) first = link;
                before = link;
                float theirs = float(cache.y >> (4u * k) & 15u);
                vec3 p = linkCorrection(x, y, rest * (1.0 - shrunk * (mine + theirs)),
                                  (cache.x >> (kLinkCachePinned + k) & 1u) != 0u ? 1.0 : 0.5);
                links += holds ? p : vec3(0.0);
                reach = holds ? min(reach, unpackPathLength(pathBits(there)) + rest) : reach;
            }
        } while (++turn < turns);
        // Not iterations of the loop: software devices would run the whole body for them.
        vec3 sum = vec3(0.0);
        vec2 squares = vec2(0.0);
        float rise = 0.0;
        bool reaches = bendPasses(facts.y) != 0u;
        if (reaches) {
            uvec4 bends = deformParticle(at + (kParticleBends + set) * sizes.y);
            uvec4 echo = deformParticle(at + (kParticleBends + echoed) * sizes.y);
            rise = uintBitsToFloat(bends.w);
            FW_UNROLL for (uint i = 0u; i < kLinksPerPass; ++i) {
                float rest = unpackHalf2x16(bends.z)[i];
                vec3 link = placeOf(soft(places + (bends[i] & kDeformLinkIndex))) - x;
                bool holds = (cache.x >> (kLinkCacheBends + set * kLinksPerPass + i) & 1u) != 0u &&
                             dot(link, link) <= kBendTears * kBendTears * rest * rest;
                sum += holds ? link : vec3(0.0);
                squares += holds ? vec2(rest * rest, 1.0) : vec2(0.0);
                // Corrections requested by the last step's set; particles without constraints
                // request none.
                uvec4 there = soft(seenAt + (echo[i] & kDeformLinkIndex));
                uint share = item.parity == 0u ? there.z : there.w;
                bending -= unpackHalf2x16(echo.z)[i] > 0.0 ? unpackBendShare(share) : vec3(0.0);
            }
        }

        if ((facts.y & kParticleClosed) != 0u) turned += cross(before, first);
        float size = length(turned);
        vec3 normal = size > 1e-18 ? turned / size : up;
        curl *= curlSide(normal, up) * scale * charred;
        float count = nearSquares.y, mean = 1.0 / max(count, 1.0);
        vec3 b = bendOf(nearSum * mean, normal,
                        uintBitsToFloat(facts.z) + curlRise(curl, nearSquares.x * mean), count,
                        stiff * kBendRelax, (facts.y & kParticleEven) != 0u);
        uint nearShare =
            packBendShare((cache.x & kLinkCacheWhole) != 0u ? b * (mean * kBendUnit) : vec3(0.0));
        bending += unpackBendShare(nearShare) * count;
        if (reaches) {
            uint ends = cache.z >> (set * kLinksPerPass * 4u);
            float across = bendCurl(float(ends & 15u) / kCharredSteps,
                                    float(ends >> 4u & 15u) / kCharredSteps);
            b = bendOf(
                sum * 0.5, normal, rise + kBendCurl * across * curlRise(curl, squares.x * 0.5), 2.0,
                bendStiffness(stiff, charred, across), (facts.y & kParticleBendsEven << set) != 0u);
            uint farShare = packBendShare(squares.y == 2.0 ? b * (0.5 * kBendUnit) : vec3(0.0));
            bending += unpackBendShare(farShare) * 2.0;
            if (item.parity == 0u) softOut[seenAt + number].w = farShare;
            else softOut[seenAt + number].z = farShare;
        }

        float was = unpackPathLength(pathBits(self));
        if (was == 0.0 && !pinned) was = kNoPath;
        bool knew = (pathBits(self) & kPathKnown) != 0u;
        bool known = knew || isPathKnown(reach, was);
        reach = pinned ? 0.0 : nextPath(reach, was, knew);

        uint shownAt = (bases.x + facts.x) * kShownQuads;
        vec3 last_ = shown(shownAt).xyz;
        vec3 moved = x + links * relaxAt(kLinkRelax, push.step) +
                     bending * (relaxAt(1.0, push.step) / kBendUnit);
        // Limits the distance to the nearest pin to the path length over holding links.
        if (reach < 0.5 * kNoPath) {
            vec4 anchor = uintBitsToFloat(soft(own + kSoftAnchor * sizes.y));
            float away = length(moved - anchor.xyz), most = reach * kPathSlack + anchor.w;
            if (away > most) moved = anchor.xyz + (moved - anchor.xyz) * (most / away);
        }
        float above = dot(height.xyz, moved) + height.w - ground;
        bool down = above < 0.0;
        if (down) moved -= up * (above / scale);

        vec3 velocity = limitSpeed((moved - last_) / push.step, kFastest / scale);
        velocity *= down ? 0.5 : sheetDamping(charred, push.step);
        vec3 air = wind * gustAt(x, scale, push.wind.w) + up * (updraftAt(burnt) / scale);
        float slowed = drag * (1.0 + 2.0 * charred) * push.step;
        velocity += normal * (dot(normal, air - velocity) * slowed / (1.0 + slowed));
        velocity -= up * (9.81 / scale * push.step);

        vec3 next = moved + velocity * push.step;
        if (pinned) moved = next = x;  // fixed from the start
        readBeforeWritten();
        shownOut[shownAt] = floatBitsToUint(vec4(moved, 0.0));
        softOut[own + (item.parity ^ 1u) * sizes.y] =
            uvec4(softPlace(next, packPathLength(reach, known)), nearShare);
        number += 64u;
    } while (number < last);
}
