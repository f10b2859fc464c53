// Sources: paper from mass rates per width of 3.5-5.6 mg/cm/s (Stott; Atallah, in Thomas & Law
// 1965); cotton and polyester from vertical panels (Mathur, Vikas, Kale); grass from head fires at
// 20 % of the wind (Cruz, Alexander, Kilinc 2022); softwood char 0.65 mm/min (EN 1995-1-2). The
// rest are starting points. Rates are as measured, so moisture is 0 except for green leaves.
#include "fire/presets.h"

#include <algorithm>
#include <iterator>

namespace fw::fire {
namespace {

// Columns of the tables.
constexpr float FwMaterialDef::*kBurning[] = {
    &FwMaterialDef::spreadRate,         &FwMaterialDef::windGain,  &FwMaterialDef::upGain,
    &FwMaterialDef::headGain,           &FwMaterialDef::backGain,  &FwMaterialDef::driveMax,
    &FwMaterialDef::lengthToBreadth,    &FwMaterialDef::burnTime,  &FwMaterialDef::moisture,
    &FwMaterialDef::extinctionMoisture, &FwMaterialDef::thickness, &FwMaterialDef::heatOfCombustion,
    &FwMaterialDef::burningFlux};
constexpr float FwMaterialDef::*kSurface[] = {&FwMaterialDef::baseRoughness, &FwMaterialDef::recede,
                                              &FwMaterialDef::shrink, &FwMaterialDef::curl};
constexpr float FwMaterialDef::*kWarming[] = {&FwMaterialDef::density,
                                              &FwMaterialDef::specificHeat,
                                              &FwMaterialDef::conductivity,
                                              &FwMaterialDef::ignitionTemperature,
                                              &FwMaterialDef::autoIgnitionTemperature,
                                              &FwMaterialDef::waterHeld,
                                              &FwMaterialDef::radiantFraction,
                                              &FwMaterialDef::sootYield};

struct Preset {
    const char* name;
    float burning[std::size(kBurning)], baseColor[3], surface[std::size(kSurface)];
};

// clang-format off
constexpr Preset kPresets[FW_MATERIAL_PRESET_COUNT] = {
    //  name            rate     wind   up    head  back  max   L/B   burn  M     Mx     thick    J/kg    flux    colour                   rough  recede shrink curl
    {"noncombustible",  {0.0f,    0.0f,  0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.3f,  0.05f,   0.0f,   0.0f}, {0.45f, 0.44f, 0.42f}, {0.8f, 0.0f, 0.0f, 0.0f}},
    {"pine",            {0.0003f, 0.35f, 1.0f, 8.0f, 2.0f, 4.0f, 2.0f, 0.0f, 0.0f, 0.4f,  0.02f,   15.0e6f, 0.0075f}, {0.50f, 0.33f, 0.18f}, {0.7f, 0.3f, 0.0f, 0.0f}},
    {"painted wood",    {0.0004f, 0.35f, 1.0f, 8.0f, 2.0f, 4.0f, 2.0f, 0.0f, 0.0f, 0.4f,  0.02f,   16.0e6f, 0.0085f}, {0.35f, 0.10f, 0.07f}, {0.5f, 0.3f, 0.0f, 0.0f}},
    {"newspaper",       {0.009f,  0.35f, 1.0f, 7.0f, 3.0f, 4.0f, 2.0f, 4.0f, 0.0f, 0.3f, 0.00008f, 15.6e6f, 0.017f}, {0.62f, 0.60f, 0.54f}, {0.9f, 1.0f, 0.04f, 45.0f}},
    {"paper",           {0.0055f, 0.35f, 1.0f, 7.0f, 3.0f, 4.0f, 2.0f, 7.0f, 0.0f, 0.3f, 0.0001f, 15.6e6f, 0.017f}, {0.80f, 0.79f, 0.75f}, {0.8f, 1.0f, 0.05f, 35.0f}},
    {"cotton",          {0.011f,  0.35f, 1.0f, 7.2f, 4.5f, 4.0f, 3.5f, 9.0f, 0.0f, 0.3f, 0.0005f, 15.6e6f, 0.018f}, {0.62f, 0.58f, 0.50f}, {0.9f, 1.0f, 0.10f, 12.0f}},
    {"polyester",       {0.010f,  0.35f, 1.0f, 1.0f, 0.3f, 4.0f, 3.5f, 15.0f, 0.0f, 0.3f, 0.0005f, 20.0e6f, 0.015f}, {0.15f, 0.22f, 0.42f}, {0.6f, 1.0f, 0.25f, 25.0f}},
    {"dry leaf",        {0.012f,  0.5f,  1.0f, 6.0f, 2.5f, 4.0f, 2.0f, 3.0f, 0.0f, 0.35f, 0.0002f, 17.0e6f, 0.015f}, {0.32f, 0.19f, 0.07f}, {0.7f, 1.0f, 0.12f, 70.0f}},
    {"green leaf",      {0.012f,  0.5f,  1.0f, 6.0f, 2.5f, 4.0f, 2.0f, 5.0f, 0.7f, 1.2f,  0.0003f, 17.0e6f, 0.010f}, {0.08f, 0.18f, 0.04f}, {0.5f, 1.0f, 0.15f, 50.0f}},
    {"thatch",          {0.006f,  0.5f,  1.0f, 7.0f, 2.5f, 6.0f, 2.5f, 60.0f, 0.0f, 0.35f, 0.15f, 15.6e6f, 0.02f}, {0.42f, 0.31f, 0.15f}, {0.95f, 0.8f, 0.05f, 10.0f}},
    {"dry grass",       {0.020f,  1.0f,  0.6f, 10.0f, 1.0f, 63.0f, 3.5f, 10.0f, 0.0f, 0.25f, 0.001f, 15.6e6f, 0.03f}, {0.45f, 0.36f, 0.15f}, {0.95f, 1.0f, 0.1f, 30.0f}},
    {"plywood",         {0.001f,  0.35f, 1.0f, 8.0f, 2.0f, 4.0f, 2.0f, 300.0f, 0.0f, 0.4f, 0.005f, 15.0e6f, 0.0085f}, {0.55f, 0.40f, 0.24f}, {0.6f, 0.3f, 0.0f, 0.0f}},
    {"leather",         {0.0015f, 0.35f, 1.0f, 4.0f, 2.0f, 4.0f, 2.0f, 60.0f, 0.0f, 0.4f, 0.003f, 18.0e6f, 0.012f}, {0.20f, 0.09f, 0.04f}, {0.5f, 0.3f, 0.20f, 12.0f}},
    {"plastic",         {0.002f,  0.35f, 1.0f, 5.0f, 1.5f, 4.0f, 2.0f, 120.0f, 0.0f, 0.3f, 0.003f, 30.0e6f, 0.015f}, {0.30f, 0.32f, 0.34f}, {0.35f, 0.8f, 0.20f, 15.0f}},
};

// Wood: EN 1995-1-2 and Babrauskas (2001), piloted at 300 to 365 C. Paper's auto-ignition is of a
// sheet in the open, not the 233 C of an oven.
constexpr float kHeat[FW_MATERIAL_PRESET_COUNT][std::size(kWarming)] = {
    //                  kg/m^3  J/kgK    W/mK   Tig     Tauto   g/m^2   rad    soot
    /* noncombustible*/ {2300.0f, 880.0f, 1.0f, 2000.0f, 3000.0f, 150.0f, 0.0f, 0.0f},
    /* pine          */ {450.0f, 2500.0f, 0.12f, 623.0f, 873.0f, 200.0f, 0.30f, 0.015f},
    /* painted wood  */ {450.0f, 2500.0f, 0.12f, 633.0f, 873.0f, 120.0f, 0.32f, 0.03f},
    /* newspaper     */ {600.0f, 1400.0f, 0.06f, 540.0f, 690.0f, 80.0f, 0.25f, 0.01f},
    /* paper         */ {800.0f, 1400.0f, 0.08f, 540.0f, 700.0f, 100.0f, 0.25f, 0.01f},
    /* cotton        */ {300.0f, 1300.0f, 0.06f, 560.0f, 690.0f, 400.0f, 0.25f, 0.01f},
    /* polyester     */ {400.0f, 1200.0f, 0.10f, 650.0f, 760.0f, 100.0f, 0.35f, 0.06f},
    /* dry leaf      */ {500.0f, 1800.0f, 0.10f, 550.0f, 700.0f, 100.0f, 0.28f, 0.01f},
    /* green leaf    */ {700.0f, 2500.0f, 0.20f, 570.0f, 720.0f, 100.0f, 0.28f, 0.02f},
    /* thatch        */ {100.0f, 1600.0f, 0.06f, 560.0f, 720.0f, 500.0f, 0.30f, 0.015f},
    /* dry grass     */ {100.0f, 1600.0f, 0.06f, 560.0f, 720.0f, 200.0f, 0.30f, 0.01f},
    /* plywood       */ {550.0f, 2300.0f, 0.12f, 623.0f, 873.0f, 150.0f, 0.30f, 0.02f},
    /* leather       */ {900.0f, 1500.0f, 0.16f, 650.0f, 800.0f, 200.0f, 0.28f, 0.03f},
    /* plastic       */ {1050.0f, 1700.0f, 0.20f, 640.0f, 760.0f, 40.0f, 0.38f, 0.10f},
};
// clang-format on

}  // namespace

FwMaterialDef presetDef(uint32_t preset) noexcept {
    const uint32_t row = preset < FW_MATERIAL_PRESET_COUNT ? preset : uint32_t(FW_MATERIAL_PINE);
    const Preset& p = kPresets[row];
    FwMaterialDef def{};
    def.structSize = uint32_t(sizeof def);
    def.appearance = row;
    const auto fill = [&](const auto& columns, const float* values) {
        for (const auto column : columns) def.*column = *values++;
    };
    fill(kBurning, p.burning);
    fill(kSurface, p.surface);
    fill(kWarming, kHeat[row]);
    std::copy_n(p.baseColor, 3, def.baseColor);
    def.ceilingGain = 0.3f;
    def.flameFeedback = 25000;
    def.charFloor = 0.38f;
    return def;
}

const char* presetName(uint32_t preset) noexcept {
    return preset < FW_MATERIAL_PRESET_COUNT ? kPresets[preset].name : "unknown";
}

}  // namespace fw::fire
