// Presets as the edge hands them out.
#pragma once
#include "flamewright/flamewright.h"

namespace fw::world {

FwMaterialDef presetDef(uint32_t preset) noexcept;  // of a known preset; structSize is set
const char* presetName(uint32_t preset) noexcept;   // never null

}  // namespace fw::world
