// Copies states that are no arrival (wet, put out, ...) to the predicted buffer of the predict
// list's tiles. For an object that no view shows, burning texels are copied, too; an object that a
// view shows again drops its predictions. A thread writes its own row only.
#include "lib/compute.glsl"
FW_READ(STATE_QUADS) FW_READ(COUNTERS) FW_READ(PREDICT_LISTS) FW_READ_WRITE(TILE_STATE)
FW_READ_WRITE(PREDICT)
#include "lib/predict.glsl"
#include "lib/predict_row.glsl"

void passRow(uint slot, uint row) {
    PredictRow r = predictRowOf(slot, row);
    if (!r.shows) return;
    uint at = r.bases.y + r.texel;
    uvec4 a = stateQuads[at >> 2u], b = stateQuads[(at >> 2u) + 1u];
    uint codes[8] = uint[8](a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w);
    bool unseen = (r.places.w & kObjectUnseen) != 0u;
    bool shownAgain = (r.places.w & kObjectShownAgain) != 0u;
    bool marks = false;
    for (uint x = 0u; x < 8u; ++x) {
        uint i = at + x, code = codes[x], time = predict[i];
        if (code == time) continue;
        bool open = code == kNever, source = isSource(code);
        if (open || source) {
            // `predict` handles visible texels.
            bool forgets = shownAgain ? open && time < kLiveEnd : unseen && source;
            if (forgets) predict[i] = code;
            marks = marks || forgets;
            continue;
        }
        // An extinguished texel keeps its age, stored as its gradient. A texel that was not shown
        // burning gets 1; 0 would mean unknown.
        if (code == kWet) gradient[i] = kAheadFar | (gradient[i] & 0xFFu);
        else if (time < kLiveEnd) gradient[i] = time < push.now ? push.now - time : 1u;
        else if (time == kNever || time == kWet) gradient[i] = 1u;
        predict[i] = code;
        marks = true;
    }
    if (marks && (r.flag & kTileMarked) == 0u)
        atomicOr(tileState[r.worldTile].flag, kTileMarked);
}

void main() { FW_STRIDE_ROWS(counters[kRowPredict + push.predictParity].listCount, passRow) }
