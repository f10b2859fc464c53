// The material presets: published spread and burning rates as FwMaterialDef records.
#pragma once
#include "flamewright/flamewright.h"

namespace fw::fire {

// The def of a preset; unknown presets (>= FW_MATERIAL_PRESET_COUNT) give pine. Sets structSize.
FwMaterialDef presetDef(uint32_t preset) noexcept;
// Never null; "unknown" for an unknown preset.
const char* presetName(uint32_t preset) noexcept;

}  // namespace fw::fire
