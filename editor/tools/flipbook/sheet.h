// Converts a flipbook sheet, frames in a grid, to the frames of a flipbook. See
// import/float_picture.h for file input and finish.h for encoding.
#pragma once
#include "import/float_picture.h"
#include "scene.h"

#include <string>

namespace fwtools {

struct SheetDef {
    uint32_t columns = 8, rows = 8;  // [1, 256] each; frames run to the right, then down
    uint32_t side = 0;               // texels per frame; 0: the sheet's size
    // kind, loops, seconds and the number of frames (0: the whole grid); the rest is computed
    fw::flipbook::Facts facts;
};

// Integer images are sRGB with straight alpha; float images are linear and premultiplied. Without
// alpha, black is empty. For fire, the hue becomes temperature (red 1300 K; yellow, green = 0.8
// red, 1780 K) and the brightness becomes the amount of glow. For smoke, only alpha counts, since
// the renderer lights it. On failure returns false; `error` has the problem, the value and the
// limit, and nothing changes.
bool framesOfSheet(const fwimport::FloatPicture& picture, SheetDef& def, std::vector<Frame>& frames,
                   std::string& error);

}  // namespace fwtools
