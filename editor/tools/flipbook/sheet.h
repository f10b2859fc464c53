// An artist's flipbook sheet, frames in a grid, as the frames of a book. Not how it is read from
// its file (import/float_picture.h), nor how frames become a book (finish.h).
#pragma once
#include "import/float_picture.h"
#include "scene.h"

#include <string>

namespace fwtools {

struct SheetDef {
    uint32_t columns = 8, rows = 8;  // [1, 256] each; frames run to the right, then down
    uint32_t side = 0;               // texels of a frame; 0: as the sheet has it
    // kind, loops, seconds and, unless 0, how many frames of the grid there are; the rest is found.
    fw::book::Facts facts;
};

// Whole numbers are sRGB beside their alpha, floats linear and multiplied by it; where there is no
// alpha, black is nothing. Of fire its hue becomes temperature, as film shows it: red is 1300 K,
// yellow (as much green as 0.8 of red) 1780 K; its brightness becomes how much of it glows. Smoke
// is its alpha alone, for the renderer lights it. False: `error` names what is wrong, the value and
// the limit; nothing is changed then.
bool framesOfSheet(const fwimport::FloatPicture& picture, SheetDef& def, std::vector<Frame>& frames,
                   std::string& error);

}  // namespace fwtools
