// New masks of particle fields, one group per field: walls and painted emission. Particles under a
// new wall die. A fresh field becomes empty.
#include "field/field.glsl"
FW_READ_WRITE(FIELD_CELLS)

shared uint sumDied;

uint masked(uint cell, bool wall, bool fresh) {
    bool empty = fresh || cell == kFieldWallCell;
    return wall ? kFieldWallCell : (empty ? fieldCell(0u, uvec2(uint(kFieldStill))) : cell);
}

void main() {
    uvec2 run = runs[push.first + gl_WorkGroupID.x];
    bool fresh = (run.y & kFieldFresh) != 0u;
    uint slot = run.x, thread = gl_LocalInvocationID.x;
    FieldRecord f = fields[slot];
    uint count = f.rules.width * f.rules.height;
    uint now = fieldCells(f, run.y), other = fieldCells(f, run.y + 1u);
    if (thread == 0u) sumDied = 0u;
    barrier();
    uint died = 0u;
    for (uint i = thread; i < count; i += 64u) {
        bool wall = fieldMask(f.cellBase + i) == kFieldWall;
        uint a = cells[now + i], b = cells[other + i];
        died += wall && !fresh ? fieldNumber(a) : 0u;
        cells[now + i] = masked(a, wall, fresh);
        cells[other + i] = masked(b, wall, fresh);
    }
    if (died != 0u) atomicAdd(sumDied, died);
    barrier();
    if (thread != 0u) return;
    FieldCounters c = counters[slot];
    if (fresh) c = FieldCounters(0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u);
    if (!fresh) {
        c.inside -= sumDied;
        c.diedLow += sumDied;
        c.diedHigh += c.diedLow < sumDied ? 1u : 0u;
    }
    counters[slot] = c;
}
