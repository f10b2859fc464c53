// The material presets: published spread and burning rates as FwMaterialDef records.
#pragma once
#include "flamewright/flamewright.h"

namespace fw::fire {

// Of a known preset (< FW_MATERIAL_PRESET_COUNT; others give pine); structSize is set.
FwMaterialDef presetDef(uint32_t preset) noexcept;
// Never null; "unknown" for an unknown one.
const char* presetName(uint32_t preset) noexcept;

}  // namespace fw::fire
