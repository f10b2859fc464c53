// Finds the texels of the predict list's tiles whose predicted arrival may change and lists their
// rows for `predict`, rim texels for `predict_rim`; updates the fire's distance to wet texels.
// Known arrivals are revisited about every eighth frame. Skips objects that no view shows. Writes
// only what the next round reads. One thread per row.
#include "lib/compute.glsl"
FW_READ(TILE_WORDS) FW_READ(STATE_QUADS) FW_READ(PREDICT) FW_READ(PREDICT_QUADS)
FW_READ_WRITE(TILE_STATE) FW_READ_WRITE(COUNTERS) FW_WRITE(SCRATCH) FW_WRITE(SCRATCH_QUADS)
#include "lib/predict.glsl"
#include "lib/predict_touch.glsl"
#include "lib/predict_row.glsl"
#include "lib/gather.glsl"

// Bit i: column i - 1 of the row of eight texels from `at` on has a time. left, right: the row has
// texels there.
uint timesAt(uint at, bool left, bool right) {
    uvec4 a = predictQuads[at >> 2u], b = predictQuads[(at >> 2u) + 1u];
    uint p[10] = uint[10](left ? predict[at - 1u] : kNever, a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w,
                          right ? predict[at + 8u] : kNever);
    uint times = 0u;
    FW_UNROLL for (int i = 0; i < 10; ++i) times |= hasTime(p[i]) ? 1u << uint(i) : 0u;
    return times;
}

// Distance in texels from a wet texel to the fire, now or predicted; below 0: far. y: 1 while it
// approaches.
const float kWetReach = 24.0;
vec2 wetAhead(uint at, ivec2 place, uvec4 sizes, uint stride) {
    vec2 least = vec2(-1.0, 0.0);
    for (int k = 0; k < 9; ++k) {
        ivec2 off = ivec2(k % 3 - 1, k / 3 - 1);
        ivec2 to = place + off;
        if (k == 4 || to.x < 0 || to.y < 0 || to.x >= int(stride) || to.y >= int(sizes.y)) continue;
        uint n = uint(int(at) + off.y * int(stride) + off.x);
        uint time = predict[n];
        bool wet = time == kWet;
        uint word = gradient[n];
        if ((!hasTime(time) && !wet) || (wet && isAheadFar(word))) continue;
        int wait = wet ? 0 : max(int(time - push.now), 0);
        float pace = max(length(unpackGradient(word)), 1e-3);  // s/texel
        float far = wet ? unpackAhead(word) : float(wait) * (1.0 / 4096.0) / pace;
        far += off.x != 0 && off.y != 0 ? 1.4142 : 1.0;
        if (far < kWetReach && (least.x < 0.0 || far < least.x))
            least = vec2(far, wait > 0 ? 1.0 : 0.0);
    }
    return least;
}

void gatherRow(uint slot, uint row) {
    PredictRow r = predictRowOf(slot, row);
    uint worldTile = r.worldTile, tileX = r.tileX, tileY = r.tileY;
    uvec4 bases = r.bases, sizes = r.sizes;
    if (row == 0u) atomicAnd(tileState[worldTile].flag, ~(kTilePredict << push.predictParity));
    if (!r.shows) return;
    uint at = bases.y + r.texel;
    uvec4 ta = stateQuads[at >> 2u];
    uvec4 tb = stateQuads[(at >> 2u) + 1u];
    uvec4 pa = predictQuads[at >> 2u];
    uvec4 pb = predictQuads[(at >> 2u) + 1u];
    uint t[8] = uint[8](ta.x, ta.y, ta.z, ta.w, tb.x, tb.y, tb.z, tb.w);
    uint p[8] = uint[8](pa.x, pa.y, pa.z, pa.w, pb.x, pb.y, pb.z, pb.w);
    uint burns = 0u; // or has burnt
    uint lit = 0u;   // burns, but is not shown so
    uint open = 0u;  // unburnt: an arrival may be predicted
    uint known = 0u; // unburnt with a predicted time
    uint wet = 0u;
    FW_UNROLL for (int i = 0; i < 8; ++i) {
        uint bit = 1u << uint(i);
        bool differs = p[i] != t[i];
        burns |= isSource(t[i]) ? bit : 0u;
        lit |= isSource(t[i]) && differs ? bit : 0u;
        open |= t[i] == kNever ? bit : 0u;
        known |= t[i] == kNever && hasTime(p[i]) ? bit : 0u;
        wet |= t[i] == kWet ? bit : 0u;
    }
    if ((r.places.w & kObjectUnseen) != 0u) return;
    bool shownAgain = (r.places.w & kObjectShownAgain) != 0u;
    bool marks = (lit | known) != 0u;
    // About every fourth frame: distances to water change slowly.
    bool soon = wet != 0u;
    if (((hash32((push.now >> 7u) * 3u + worldTile) & 3u) != 0u)) wet = 0u;
    soon = soon && wet == 0u;
    uint nearer = 0u;
    for (; wet != 0u; wet &= wet - 1u) {
        uint i = uint(findLSB(wet));
        vec2 ahead = wetAhead(at + i, ivec2(tileX * 8u + i, tileY * 8u + row), sizes, bases.w);
        uint word = gradient[at + i];
        float before = min(unpackAhead(word), 2.0 * kWetReach);
        soon = soon || ahead.y > 0.0;
        if (ahead.x < 0.0 || ahead.x > before - 0.3) continue;
        gradient[at + i] = packAheadNext(word, ahead.x);
        nearer |= 1u << i;
    }
    if (nearer != 0u) {
        touchAround(worldTile, rowMask(row, nearer), r.object, tileX, tileY);
    } else if (soon) {
        predictTouch(push.predictParity ^ 1u, worldTile);
    }
    uint chosen = shownAgain ? lit | burns : lit;
    bool again = (hash32((push.now >> 7u) + worldTile) & 7u) == 0u;
    if (again) chosen |= known;
    else if (known != 0u) predictTouch(push.predictParity ^ 1u, worldTile);
    uint rim = 0u;
    uint fresh = open & ~known;
    if ((fresh | chosen) != 0u) rim = rimOfRow(sizes.x + r.local, row);
    if (fresh != 0u) {
        bool left = tileX > 0u;
        bool right = tileX + 1u < sizes.z;
        uint times = timesAt(at, left, right);
        if (tileY > 0u || row > 0u) times |= timesAt(at - bases.w, left, right);
        if (tileY * 8u + row + 1u < sizes.y) times |= timesAt(at + bases.w, left, right);
        chosen |= fresh & (rim | times | (times >> 1u) | (times >> 2u)) & 0xFFu;
    }
    if ((marks || (chosen & ~rim) != 0u) && (r.flag & kTileMarked) == 0u)
        atomicOr(tileState[worldTile].flag, kTileMarked);
    if ((chosen | nearer) == 0u) return;
    gatherItem(kRowPredict + push.predictParity,
               uvec4(worldTile * 8u + row, (chosen & ~rim) | nearer << 16u, r.texel, r.object),
               rim & chosen);
}

void main() { FW_STRIDE_ROWS(counters[kRowPredict + push.predictParity].listCount, gatherRow) }
