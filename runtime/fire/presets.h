// The material presets: published spread and burning rates as FwMaterialDef records.
#pragma once
#include "flamewright/flamewright.h"

namespace fw::fire {

// Of a known preset (< FW_MATERIAL_PRESET_COUNT; others give pine); structSize is set.
FwMaterialDef presetDef(uint32_t preset) noexcept;
// Never null; "unknown" for an unknown one.
const char* presetName(uint32_t preset) noexcept;

// Spread rate of paper by its mass per area (g/m^2, > 0), m/s: the mass rate per width is a
// constant of paper, 0.44 g/m/s (0.35 to 0.56 measured).
float paperSpreadRate(float gramsPerSquareMetre) noexcept;

}  // namespace fw::fire
