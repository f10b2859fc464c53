// Presets as the edge hands them out.
#pragma once
#include "fire/presets.h"

namespace fw::world {

using fire::presetDef;
using fire::presetName;

}  // namespace fw::world
