// The world's flipbooks.
#include "shared/flipbook.h"
FW_READ(FLIPBOOKS)

// Makes a flipbook (`flipbook` - 1; 0: none) show a quad. True: it loops. life, age, own: as
// flipbookTime's.
bool showByFlipbook(inout FlameQuad quad, uint flipbook, float life, float age, float own) {
    if (flipbook == 0u) return false;
    uint at = (flipbook - 1u) * kFlipbookRecordWords;
    bool loops = (flipbooks[at + 6u] & kFlipbookLoops) != 0u;
    quad.phase = flipbookTime(loops, uintBitsToFloat(flipbooks[at + 8u]), life, age, own);
    quad.kind |= flipbook << kQuadFlipbookShift;
    return loops;
}
