#include "world/material.h"

#include "fire/presets.h"

namespace fw::world {

FwMaterialDef presetDef(uint32_t preset) noexcept { return fire::presetDef(preset); }
const char* presetName(uint32_t preset) noexcept { return fire::presetName(preset); }

}  // namespace fw::world
