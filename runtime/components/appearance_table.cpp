// Presets are written as differences from a near relative.
#include "components/appearance_table.h"

#include "flamewright/flamewright.h"

namespace fw::components {
namespace {

using gpu::MaterialAppearance;
using gpu::vec4;

static_assert(kLookCount == FW_MATERIAL_PRESET_COUNT);

// Never burns; still wet, sooty and lit like everything else.
MaterialAppearance stone() {
    MaterialAppearance m{};
    m.charTime = m.crackTime = m.facePeak = m.faceDecay = m.crackLife = m.ashEnd = 1.0f;
    m.charColor = vec4(0.03f, 0.03f, 0.03f, 0.6f);
    m.ashColor = vec4(0.5f, 0.5f, 0.5f, 0.0f);
    m.cellX = m.cellY = 0.02f;
    m.rimWidth = m.thickness = 0.001f;
    m.holeTiles = 7.0f;
    m.holeFine = 1.0f;
    m.drip = 1.0f;
    m.wetDark = 0.5f;
    m.wetGloss = 0.3f;
    m.base = gpu::kBaseStone;
    m.baseScale = 1.0f;
    return m;
}

MaterialAppearance pine() {
    MaterialAppearance m = stone();
    m.spreadRate = 0.0006f;
    m.warpLarge = 0.012f;
    m.warpSmall = 0.003f;
    m.jitter = 8.0f;
    m.scorchWidth = 0.030f;
    m.scorchGain = 1.5f;
    m.charTime = 30.0f;
    m.charColor = vec4(0.030f, 0.029f, 0.029f, 0.50f);
    m.sheen = 0.8f;
    m.cellX = 0.019f;
    m.cellY = 0.023f;
    m.crackWidth = 0.0021f;
    m.crackDepth = 0.0045f;
    m.crackTime = 42.0f;
    m.faceKelvin = 1010.0f;
    m.facePeak = 12.0f;
    m.faceDecay = 26.0f;
    m.crackKelvin = 1125.0f;
    m.crackLife = 180.0f;
    m.glowVariation = 170.0f;
    m.ashMax = 0.6f;
    m.ashStart = 260.0f;
    m.ashEnd = 1100.0f;
    m.ashColor = vec4(0.25f, 0.245f, 0.24f, 0.0f);
    m.holeTime = 620.0f;
    m.holeVariation = 260.0f;
    m.rimKelvin = 1190.0f;
    m.rimWidth = 0.018f;
    m.thickness = 0.018f;
    m.wetDark = 0.6f;
    m.wetGloss = 0.35f;
    m.holeTiles = 2.6f;
    m.holeFine = 0.08f;
    m.base = gpu::kBaseWood;
    m.flame = 1.35f;
    m.smoke = 1.0f;
    return m;
}

MaterialAppearance paintedWood() {
    MaterialAppearance m = pine();
    m.warpSmall = 0.005f;
    m.jitter = 4.0f;
    m.scorchWidth = 0.06f;
    m.blister = 0.0032f;
    m.ashColor.w = 0.0006f;
    m.wetDark = 0.15f;
    m.wetGloss = 0.9f;
    m.base = gpu::kBasePaint;
    m.smoke = 1.6f;
    return m;
}

MaterialAppearance plywood() {
    MaterialAppearance m = pine();
    m.holeTime = 420.0f;
    m.holeVariation = 220.0f;
    m.thickness = 0.012f;
    return m;
}

MaterialAppearance paper() {
    MaterialAppearance m = stone();
    m.spreadRate = 0.0055f;
    m.warpLarge = 0.010f;
    m.warpSmall = 0.0022f;
    m.jitter = 0.08f;
    m.scorchWidth = 0.011f;
    m.scorchGain = 1.5f;
    m.charTime = 0.7f;
    m.charColor = vec4(0.028f, 0.027f, 0.028f, 0.7f);
    m.sheen = 0.5f;
    m.crumple = 0.0011f;
    m.faceKelvin = 960.0f;
    m.facePeak = 0.35f;
    m.faceDecay = 0.5f;
    m.glowVariation = 170.0f;
    m.wormKelvin = 1080.0f;
    m.ashMax = 0.35f;
    m.ashStart = 1.5f;
    m.ashEnd = 5.0f;
    m.ashColor = vec4(0.36f, 0.36f, 0.37f, 0.0f);
    m.holeTime = 3.0f;
    m.holeVariation = 2.2f;
    m.holeFine = 0.3f;
    m.rimKelvin = 1280.0f;
    m.rimWidth = 0.0024f;
    m.thickness = 0.0008f;
    m.curl = 0.8f;
    m.wetDark = 0.55f;
    m.wetGloss = 0.15f;
    m.base = gpu::kBasePaper;
    m.flame = 1.1f;
    m.smoke = 0.4f;
    return m;
}

MaterialAppearance newspaper() {
    MaterialAppearance m = paper();
    m.base = gpu::kBasePrint;
    return m;
}

MaterialAppearance cotton() {
    MaterialAppearance m = paper();
    m.spreadRate = 0.008f;
    m.warpLarge = 0.014f;
    m.warpSmall = 0.003f;
    m.jitter = 0.25f;
    m.scorchWidth = 0.012f;
    m.charTime = 1.2f;
    m.charColor = vec4(0.026f, 0.026f, 0.026f, 0.85f);
    m.sheen = 0.15f;
    m.crumple = 0.0014f;
    m.faceKelvin = 1000.0f;
    m.facePeak = 0.7f;
    m.faceDecay = 1.2f;
    m.glowVariation = 160.0f;
    m.ashMax = 0.6f;
    m.ashStart = 2.5f;
    m.ashEnd = 7.0f;
    m.ashColor = vec4(0.40f, 0.39f, 0.38f, 0.0f);
    m.holeTime = 5.0f;
    m.holeVariation = 3.4f;
    m.holeFine = 0.4f;
    m.rimKelvin = 1230.0f;
    m.rimWidth = 0.0036f;
    m.thickness = 0.0014f;
    m.curl = 0.35f;
    m.wetDark = 0.75f;
    m.wetGloss = 0.05f;
    m.base = gpu::kBaseWeave;
    m.smoke = 0.6f;
    return m;
}

MaterialAppearance plastic() {
    MaterialAppearance m = stone();
    m.spreadRate = 0.003f;
    m.warpLarge = 0.012f;
    m.warpSmall = 0.002f;
    m.scorchWidth = 0.035f;
    m.scorchGain = 0.9f;
    m.charTime = 9.0f;
    m.blister = 0.0025f;
    m.charColor = vec4(0.018f, 0.018f, 0.018f, 0.30f);
    m.sheen = 0.2f;
    m.faceKelvin = 600.0f;
    m.facePeak = 2.0f;
    m.faceDecay = 5.0f;
    m.glowVariation = 60.0f;
    m.holeTime = 34.0f;
    m.holeVariation = 18.0f;
    m.rimWidth = 0.004f;
    m.thickness = 0.004f;
    m.lip = 0.003f;
    m.wetDark = 0.0f;
    m.wetGloss = 1.0f;
    m.melt = 1.0f;
    m.holeTiles = 5.0f;
    m.holeFine = 0.0f;
    m.drip = 2.2f;
    m.blur = 0.006f;
    m.base = gpu::kBasePlastic;
    m.flame = 1.1f;
    m.smoke = 3.0f;
    return m;
}

// Cloth that shrinks and melts: the pattern of cotton, the edges of plastic.
MaterialAppearance polyester() {
    MaterialAppearance m = plastic();
    m.spreadRate = 0.005f;
    m.charTime = 3.0f;
    m.blister = 0.0008f;
    m.scorchWidth = 0.02f;
    m.holeTime = 3.5f;
    m.holeVariation = 2.4f;
    m.thickness = 0.0012f;
    m.lip = 0.0012f;
    m.holeTiles = 8.0f;
    m.drip = 1.6f;
    m.blur = 0.003f;
    m.crumple = 0.001f;
    m.wetDark = 0.5f;
    m.wetGloss = 0.2f;
    m.base = gpu::kBaseWeave;
    return m;
}

MaterialAppearance dryLeaf() {
    MaterialAppearance m = paper();
    m.spreadRate = 0.004f;
    m.warpLarge = 0.008f;
    m.warpSmall = 0.0025f;
    m.jitter = 0.9f;
    m.scorchWidth = 0.014f;
    m.scorchGain = 1.4f;
    m.charTime = 1.4f;
    m.charColor = vec4(0.024f, 0.023f, 0.021f, 0.6f);
    m.sheen = 0.4f;
    m.crumple = 0.0016f;
    m.facePeak = 0.7f;
    m.faceDecay = 0.8f;
    m.wormKelvin = 1050.0f;
    m.ashMax = 0.6f;
    m.ashStart = 2.0f;
    m.ashEnd = 6.0f;
    m.ashColor = vec4(0.42f, 0.42f, 0.40f, 0.0f);
    m.holeTime = 4.2f;
    m.holeVariation = 2.6f;
    m.holeFine = 0.5f;
    m.rimKelvin = 1180.0f;
    m.rimWidth = 0.0026f;
    m.thickness = 0.0009f;
    m.curl = 0.9f;
    m.wetDark = 0.25f;
    m.wetGloss = 0.8f;
    m.base = gpu::kBaseLeaf;
    m.smoke = 0.8f;
    return m;
}

MaterialAppearance greenLeaf() {
    MaterialAppearance m = dryLeaf();
    m.spreadRate = 0.0022f;
    m.scorchWidth = 0.012f;
    m.charTime = 2.6f;
    m.facePeak = 1.2f;
    m.faceDecay = 1.2f;
    m.holeTime = 8.0f;
    m.holeVariation = 4.5f;
    m.wiltColor = vec4(0.17f, 0.145f, 0.05f, 0.025f);
    m.flame = 0.8f;
    m.smoke = 2.0f;
    return m;
}

MaterialAppearance thatch() {
    MaterialAppearance m = stone();
    m.spreadRate = 0.006f;
    m.warpLarge = 0.030f;
    m.warpSmall = 0.010f;
    m.jitter = 4.4f;
    m.scorchWidth = 0.022f;
    m.scorchGain = 1.4f;
    m.charTime = 2.6f;
    m.charColor = vec4(0.028f, 0.026f, 0.024f, 0.7f);
    m.sheen = 0.3f;
    m.faceKelvin = 1120.0f;
    m.facePeak = 1.4f;
    m.faceDecay = 4.4f;
    m.glowVariation = 210.0f;
    m.ashMax = 0.45f;
    m.ashStart = 16.0f;
    m.ashEnd = 46.0f;
    m.ashColor = vec4(0.20f, 0.19f, 0.178f, 0.0f);
    m.holeTime = 46.0f;
    m.holeVariation = 30.0f;
    m.rimKelvin = 1130.0f;
    m.rimWidth = 0.006f;
    m.thickness = 0.02f;
    m.wetDark = 0.6f;
    m.wetGloss = 0.3f;
    m.holeTiles = 9.0f;
    m.holeFine = 0.5f;
    m.drip = 5.0f;
    m.base = gpu::kBaseStraw;
    m.flame = 1.2f;
    m.smoke = 0.9f;
    return m;
}

MaterialAppearance dryGrass() {
    MaterialAppearance m = thatch();
    m.spreadRate = 0.012f;
    m.jitter = 2.2f;
    m.charTime = 1.3f;
    m.facePeak = 0.7f;
    m.faceDecay = 2.2f;
    m.ashStart = 3.0f;
    m.ashEnd = 9.0f;
    m.holeTime = 8.0f;
    m.holeVariation = 6.0f;
    m.thickness = 0.004f;
    m.ashMax = 0.5f;
    return m;
}

MaterialAppearance leather() {
    MaterialAppearance m = stone();
    m.spreadRate = 0.0015f;
    m.warpLarge = 0.010f;
    m.warpSmall = 0.003f;
    m.scorchWidth = 0.020f;
    m.scorchGain = 1.2f;
    m.charTime = 8.0f;
    m.charColor = vec4(0.016f, 0.015f, 0.0145f, 0.42f);
    m.sheen = 0.5f;
    m.cellX = m.cellY = 0.022f;
    m.crackWidth = 0.0008f;
    m.crackDepth = 0.0014f;
    m.crackTime = 25.0f;
    m.crumple = 0.002f;
    m.isotropic = 1.0f;
    m.faceKelvin = 985.0f;
    m.facePeak = 5.0f;
    m.faceDecay = 9.0f;
    m.crackKelvin = 1065.0f;
    m.crackLife = 45.0f;
    m.glowVariation = 150.0f;
    m.ashMax = 0.28f;
    m.ashStart = 45.0f;
    m.ashEnd = 150.0f;
    m.ashColor = vec4(0.34f, 0.32f, 0.31f, 0.0f);
    m.holeTime = 95.0f;
    m.holeVariation = 60.0f;
    m.rimKelvin = 1100.0f;
    m.rimWidth = 0.0045f;
    m.thickness = 0.003f;
    m.curl = 0.7f;
    m.wetDark = 0.45f;
    m.wetGloss = 0.5f;
    m.holeTiles = 4.0f;
    m.holeFine = 0.16f;
    m.base = gpu::kBaseLeather;
    m.flame = 0.8f;
    m.smoke = 1.5f;
    return m;
}

}  // namespace

MaterialAppearance materialLook(uint32_t preset) noexcept {
    switch (preset) {
        case FW_MATERIAL_PINE:
            return pine();
        case FW_MATERIAL_PAINTED_WOOD:
            return paintedWood();
        case FW_MATERIAL_NEWSPAPER:
            return newspaper();
        case FW_MATERIAL_PAPER:
            return paper();
        case FW_MATERIAL_COTTON:
            return cotton();
        case FW_MATERIAL_POLYESTER:
            return polyester();
        case FW_MATERIAL_DRY_LEAF:
            return dryLeaf();
        case FW_MATERIAL_GREEN_LEAF:
            return greenLeaf();
        case FW_MATERIAL_THATCH:
            return thatch();
        case FW_MATERIAL_DRY_GRASS:
            return dryGrass();
        case FW_MATERIAL_PLYWOOD:
            return plywood();
        case FW_MATERIAL_LEATHER:
            return leather();
        case FW_MATERIAL_PLASTIC:
            return plastic();
        default:
            return stone();
    }
}

float lookHoleEnd(const gpu::MaterialAppearance& look) noexcept {  // holeDelay, appearance.glsl
    return look.holeTime + 0.45f * look.holeVariation * (0.9f + 0.8f * look.holeFine) +
           2.3f * look.jitter;
}

mesh::RefineHoles holesOf(const gpu::MaterialAppearance& look) noexcept {
    mesh::RefineHoles holes;
    if (!(look.holeTime > 0)) return holes;
    holes.variation = look.holeVariation / look.holeTime;
    holes.wood = look.base == gpu::kBaseWood || look.base == gpu::kBasePaint;
    holes.tilesX = holes.wood ? 2.6f : look.holeTiles;
    holes.tilesY = holes.wood ? 0.3f * 2.6f : look.holeTiles / look.drip;
    return holes;
}

float lookSpreadRate(uint32_t preset) noexcept { return materialLook(preset).spreadRate; }

}  // namespace fw::components
