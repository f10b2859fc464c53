// Presets are written as differences from a near relative.
#include "components/appearance_table.h"

#include "flamewright/flamewright.h"

#include <array>
#include <span>

namespace fw::components {
namespace {

using gpu::MaterialAppearance;
using gpu::MaterialFamily;
using gpu::vec4;

using M = MaterialAppearance;

struct Number {
    float M::*field;
    float value;
};
struct Colour {
    vec4 M::*field;
    float value[4];
};

// Never burns; still wet, sooty and lit like everything else.
constexpr Number kStone[] = {
    {&M::charTime, 1.0f},   {&M::crackTime, 1.0f},   {&M::facePeak, 1.0f},  {&M::faceDecay, 1.0f},
    {&M::crackLife, 1.0f},  {&M::ashEnd, 1.0f},      {&M::cellX, 0.02f},    {&M::cellY, 0.02f},
    {&M::rimWidth, 0.001f}, {&M::thickness, 0.001f}, {&M::holeTiles, 7.0f}, {&M::holeFine, 1.0f},
    {&M::drip, 1.0f},       {&M::wetDark, 0.5f},     {&M::wetGloss, 0.3f},  {&M::baseScale, 1.0f}};
constexpr Colour kStoneColours[] = {{&M::charColor, {0.03f, 0.03f, 0.03f, 0.6f}},
                                    {&M::ashColor, {0.5f, 0.5f, 0.5f, 0.0f}}};
constexpr Number kPine[] = {
    {&M::spreadRate, 0.0006f},   {&M::warpLarge, 0.012f},    {&M::warpSmall, 0.003f},
    {&M::jitter, 8.0f},          {&M::scorchWidth, 0.030f},  {&M::scorchGain, 1.5f},
    {&M::charTime, 30.0f},       {&M::sheen, 0.8f},          {&M::cellX, 0.019f},
    {&M::cellY, 0.023f},         {&M::crackWidth, 0.0021f},  {&M::crackDepth, 0.0045f},
    {&M::crackTime, 42.0f},      {&M::faceKelvin, 1010.0f},  {&M::facePeak, 12.0f},
    {&M::faceDecay, 26.0f},      {&M::crackKelvin, 1125.0f}, {&M::crackLife, 180.0f},
    {&M::glowVariation, 170.0f}, {&M::ashMax, 0.6f},         {&M::ashStart, 260.0f},
    {&M::ashEnd, 1100.0f},       {&M::holeTime, 620.0f},     {&M::holeVariation, 260.0f},
    {&M::rimKelvin, 1190.0f},    {&M::rimWidth, 0.018f},     {&M::thickness, 0.018f},
    {&M::wetDark, 0.6f},         {&M::wetGloss, 0.35f},      {&M::holeTiles, 2.6f},
    {&M::holeFine, 0.08f},       {&M::flame, 1.35f},         {&M::smoke, 1.0f}};
constexpr Colour kPineColours[] = {{&M::charColor, {0.030f, 0.029f, 0.029f, 0.50f}},
                                   {&M::ashColor, {0.25f, 0.245f, 0.24f, 0.0f}}};
constexpr Number kPaintedWood[] = {
    {&M::warpSmall, 0.005f}, {&M::jitter, 4.0f},   {&M::scorchWidth, 0.06f}, {&M::blister, 0.0032f},
    {&M::wetDark, 0.15f},    {&M::wetGloss, 0.9f}, {&M::smoke, 1.6f}};
constexpr Colour kPaintedWoodColours[] = {{&M::ashColor, {0.25f, 0.245f, 0.24f, 0.0006f}}};
constexpr Number kPlywood[] = {
    {&M::holeTime, 420.0f}, {&M::holeVariation, 220.0f}, {&M::thickness, 0.012f}};
constexpr Number kPaper[] = {{&M::spreadRate, 0.0055f},   {&M::warpLarge, 0.010f},
                             {&M::warpSmall, 0.0022f},    {&M::jitter, 0.08f},
                             {&M::scorchWidth, 0.011f},   {&M::scorchGain, 1.5f},
                             {&M::charTime, 0.7f},        {&M::sheen, 0.5f},
                             {&M::crumple, 0.0011f},      {&M::faceKelvin, 960.0f},
                             {&M::facePeak, 0.35f},       {&M::faceDecay, 0.5f},
                             {&M::glowVariation, 170.0f}, {&M::wormKelvin, 1080.0f},
                             {&M::ashMax, 0.35f},         {&M::ashStart, 1.5f},
                             {&M::ashEnd, 5.0f},          {&M::holeTime, 3.0f},
                             {&M::holeVariation, 2.2f},   {&M::holeFine, 0.3f},
                             {&M::rimKelvin, 1280.0f},    {&M::rimWidth, 0.0024f},
                             {&M::thickness, 0.0008f},    {&M::curl, 0.8f},
                             {&M::wetDark, 0.55f},        {&M::wetGloss, 0.15f},
                             {&M::flame, 1.1f},           {&M::smoke, 0.4f}};
constexpr Colour kPaperColours[] = {{&M::charColor, {0.028f, 0.027f, 0.028f, 0.7f}},
                                    {&M::ashColor, {0.36f, 0.36f, 0.37f, 0.0f}}};
constexpr Number kCotton[] = {
    {&M::spreadRate, 0.008f}, {&M::warpLarge, 0.014f},   {&M::warpSmall, 0.003f},
    {&M::jitter, 0.25f},      {&M::scorchWidth, 0.012f}, {&M::charTime, 1.2f},
    {&M::sheen, 0.15f},       {&M::crumple, 0.0014f},    {&M::faceKelvin, 1000.0f},
    {&M::facePeak, 0.7f},     {&M::faceDecay, 1.2f},     {&M::glowVariation, 160.0f},
    {&M::ashMax, 0.6f},       {&M::ashStart, 2.5f},      {&M::ashEnd, 7.0f},
    {&M::holeTime, 5.0f},     {&M::holeVariation, 3.4f}, {&M::holeFine, 0.4f},
    {&M::rimKelvin, 1230.0f}, {&M::rimWidth, 0.0036f},   {&M::thickness, 0.0014f},
    {&M::curl, 0.35f},        {&M::wetDark, 0.75f},      {&M::wetGloss, 0.05f},
    {&M::smoke, 0.6f}};
constexpr Colour kCottonColours[] = {{&M::charColor, {0.026f, 0.026f, 0.026f, 0.85f}},
                                     {&M::ashColor, {0.40f, 0.39f, 0.38f, 0.0f}}};
constexpr Number kPlastic[] = {
    {&M::spreadRate, 0.003f},  {&M::warpLarge, 0.012f},    {&M::warpSmall, 0.002f},
    {&M::scorchWidth, 0.035f}, {&M::scorchGain, 0.9f},     {&M::charTime, 9.0f},
    {&M::blister, 0.0025f},    {&M::sheen, 0.2f},          {&M::faceKelvin, 600.0f},
    {&M::facePeak, 2.0f},      {&M::faceDecay, 5.0f},      {&M::glowVariation, 60.0f},
    {&M::holeTime, 34.0f},     {&M::holeVariation, 18.0f}, {&M::rimWidth, 0.004f},
    {&M::thickness, 0.004f},   {&M::lip, 0.003f},          {&M::wetDark, 0.0f},
    {&M::wetGloss, 1.0f},      {&M::melt, 1.0f},           {&M::holeTiles, 5.0f},
    {&M::holeFine, 0.0f},      {&M::drip, 2.2f},           {&M::blur, 0.006f},
    {&M::flame, 1.1f},         {&M::smoke, 3.0f}};
constexpr Colour kPlasticColours[] = {{&M::charColor, {0.018f, 0.018f, 0.018f, 0.30f}}};
// Cloth that shrinks and melts: the pattern of cotton, the edges of plastic.
constexpr Number kPolyester[] = {
    {&M::spreadRate, 0.005f}, {&M::charTime, 3.0f}, {&M::blister, 0.0008f},
    {&M::scorchWidth, 0.02f}, {&M::holeTime, 3.5f}, {&M::holeVariation, 2.4f},
    {&M::thickness, 0.0012f}, {&M::lip, 0.0012f},   {&M::holeTiles, 8.0f},
    {&M::drip, 1.6f},         {&M::blur, 0.003f},   {&M::crumple, 0.001f},
    {&M::wetDark, 0.5f},      {&M::wetGloss, 0.2f}};
constexpr Number kDryLeaf[] = {
    {&M::spreadRate, 0.004f}, {&M::warpLarge, 0.008f},   {&M::warpSmall, 0.0025f},
    {&M::jitter, 0.9f},       {&M::scorchWidth, 0.014f}, {&M::scorchGain, 1.4f},
    {&M::charTime, 1.4f},     {&M::sheen, 0.4f},         {&M::crumple, 0.0016f},
    {&M::facePeak, 0.7f},     {&M::faceDecay, 0.8f},     {&M::wormKelvin, 1050.0f},
    {&M::ashMax, 0.6f},       {&M::ashStart, 2.0f},      {&M::ashEnd, 6.0f},
    {&M::holeTime, 4.2f},     {&M::holeVariation, 2.6f}, {&M::holeFine, 0.5f},
    {&M::rimKelvin, 1180.0f}, {&M::rimWidth, 0.0026f},   {&M::thickness, 0.0009f},
    {&M::curl, 0.9f},         {&M::wetDark, 0.25f},      {&M::wetGloss, 0.8f},
    {&M::smoke, 0.8f}};
constexpr Colour kDryLeafColours[] = {{&M::charColor, {0.024f, 0.023f, 0.021f, 0.6f}},
                                      {&M::ashColor, {0.42f, 0.42f, 0.40f, 0.0f}}};
constexpr Number kGreenLeaf[] = {
    {&M::spreadRate, 0.0022f}, {&M::scorchWidth, 0.012f}, {&M::charTime, 2.6f},
    {&M::facePeak, 1.2f},      {&M::faceDecay, 1.2f},     {&M::holeTime, 8.0f},
    {&M::holeVariation, 4.5f}, {&M::flame, 0.8f},         {&M::smoke, 2.0f}};
constexpr Colour kGreenLeafColours[] = {{&M::wiltColor, {0.17f, 0.145f, 0.05f, 0.025f}}};
constexpr Number kThatch[] = {
    {&M::spreadRate, 0.006f}, {&M::warpLarge, 0.030f},    {&M::warpSmall, 0.010f},
    {&M::jitter, 4.4f},       {&M::scorchWidth, 0.022f},  {&M::scorchGain, 1.4f},
    {&M::charTime, 2.6f},     {&M::sheen, 0.3f},          {&M::faceKelvin, 1120.0f},
    {&M::facePeak, 1.4f},     {&M::faceDecay, 4.4f},      {&M::glowVariation, 210.0f},
    {&M::ashMax, 0.45f},      {&M::ashStart, 16.0f},      {&M::ashEnd, 46.0f},
    {&M::holeTime, 46.0f},    {&M::holeVariation, 30.0f}, {&M::rimKelvin, 1130.0f},
    {&M::rimWidth, 0.006f},   {&M::thickness, 0.02f},     {&M::wetDark, 0.6f},
    {&M::wetGloss, 0.3f},     {&M::holeTiles, 9.0f},      {&M::holeFine, 0.5f},
    {&M::drip, 5.0f},         {&M::flame, 1.2f},          {&M::smoke, 0.9f}};
constexpr Colour kThatchColours[] = {{&M::charColor, {0.028f, 0.026f, 0.024f, 0.7f}},
                                     {&M::ashColor, {0.20f, 0.19f, 0.178f, 0.0f}}};
constexpr Number kDryGrass[] = {
    {&M::spreadRate, 0.012f},  {&M::jitter, 2.2f},      {&M::charTime, 1.3f}, {&M::facePeak, 0.7f},
    {&M::faceDecay, 2.2f},     {&M::ashStart, 3.0f},    {&M::ashEnd, 9.0f},   {&M::holeTime, 8.0f},
    {&M::holeVariation, 6.0f}, {&M::thickness, 0.004f}, {&M::ashMax, 0.5f}};
constexpr Number kLeather[] = {{&M::spreadRate, 0.0015f},  {&M::warpLarge, 0.010f},
                               {&M::warpSmall, 0.003f},    {&M::scorchWidth, 0.020f},
                               {&M::scorchGain, 1.2f},     {&M::charTime, 8.0f},
                               {&M::sheen, 0.5f},          {&M::cellX, 0.022f},
                               {&M::cellY, 0.022f},        {&M::crackWidth, 0.0008f},
                               {&M::crackDepth, 0.0014f},  {&M::crackTime, 25.0f},
                               {&M::crumple, 0.002f},      {&M::isotropic, 1.0f},
                               {&M::faceKelvin, 985.0f},   {&M::facePeak, 5.0f},
                               {&M::faceDecay, 9.0f},      {&M::crackKelvin, 1065.0f},
                               {&M::crackLife, 45.0f},     {&M::glowVariation, 150.0f},
                               {&M::ashMax, 0.28f},        {&M::ashStart, 45.0f},
                               {&M::ashEnd, 150.0f},       {&M::holeTime, 95.0f},
                               {&M::holeVariation, 60.0f}, {&M::rimKelvin, 1100.0f},
                               {&M::rimWidth, 0.0045f},    {&M::thickness, 0.003f},
                               {&M::curl, 0.7f},           {&M::wetDark, 0.45f},
                               {&M::wetGloss, 0.5f},       {&M::holeTiles, 4.0f},
                               {&M::holeFine, 0.16f},      {&M::flame, 0.8f},
                               {&M::smoke, 1.5f}};
constexpr Colour kLeatherColours[] = {{&M::charColor, {0.016f, 0.015f, 0.0145f, 0.42f}},
                                      {&M::ashColor, {0.34f, 0.32f, 0.31f, 0.0f}}};

struct Row {
    uint32_t like;  // the preset that it differs from; its own number: none
    gpu::uint base;
    MaterialFamily family;
    float bend;  // stiffness against bending of a fresh sheet, [0, 1]
    std::span<const Number> numbers;
    std::span<const Colour> colours = {};
};
// clang-format off
constexpr Row kRows[] = {  // by FwMaterialPreset
    {FW_MATERIAL_NONCOMBUSTIBLE, gpu::kBaseStone, MaterialFamily::wood, 0.8f, kStone, kStoneColours},
    {FW_MATERIAL_NONCOMBUSTIBLE, gpu::kBaseWood, MaterialFamily::wood, 0.8f, kPine, kPineColours},
    {FW_MATERIAL_PINE, gpu::kBasePaint, MaterialFamily::paint, 0.8f, kPaintedWood, kPaintedWoodColours},
    {FW_MATERIAL_PAPER, gpu::kBasePrint, MaterialFamily::sheet, 0.8f, {}},
    {FW_MATERIAL_NONCOMBUSTIBLE, gpu::kBasePaper, MaterialFamily::sheet, 0.8f, kPaper, kPaperColours},
    {FW_MATERIAL_PAPER, gpu::kBaseWeave, MaterialFamily::sheet, 0.3f, kCotton, kCottonColours},
    {FW_MATERIAL_PLASTIC, gpu::kBaseWeave, MaterialFamily::hide, 0.05f, kPolyester},
    {FW_MATERIAL_PAPER, gpu::kBaseLeaf, MaterialFamily::plant, 0.8f, kDryLeaf, kDryLeafColours},
    {FW_MATERIAL_DRY_LEAF, gpu::kBaseLeaf, MaterialFamily::plant, 0.8f, kGreenLeaf, kGreenLeafColours},
    {FW_MATERIAL_NONCOMBUSTIBLE, gpu::kBaseStraw, MaterialFamily::plant, 0.8f, kThatch, kThatchColours},
    {FW_MATERIAL_THATCH, gpu::kBaseStraw, MaterialFamily::plant, 0.8f, kDryGrass},
    {FW_MATERIAL_PINE, gpu::kBaseWood, MaterialFamily::wood, 0.8f, kPlywood},
    {FW_MATERIAL_NONCOMBUSTIBLE, gpu::kBaseLeather, MaterialFamily::hide, 0.4f, kLeather, kLeatherColours},
    {FW_MATERIAL_NONCOMBUSTIBLE, gpu::kBasePlastic, MaterialFamily::hide, 0.8f, kPlastic, kPlasticColours},
};
// clang-format on
static_assert(std::size(kRows) == FW_MATERIAL_PRESET_COUNT);

constexpr MaterialAppearance appearanceOf(uint32_t preset) {
    const Row& row = kRows[preset];
    MaterialAppearance appearance = row.like == preset ? M{} : appearanceOf(row.like);
    appearance.base = row.base;
    for (const Number& number : row.numbers) appearance.*number.field = number.value;
    for (const auto& [field, v] : row.colours) appearance.*field = vec4(v[0], v[1], v[2], v[3]);
    return appearance;
}

template <class F>
constexpr auto byPreset(F of) {
    std::array<decltype(of(0)), std::size(kRows)> made{};
    for (uint32_t i = 0; i < made.size(); ++i) made[i] = of(i);
    return made;
}
constexpr auto kAppearances = byPreset(appearanceOf);
constexpr auto kFamilies = byPreset([](uint32_t preset) { return kRows[preset].family; });

constexpr uint32_t rowOf(uint32_t preset) noexcept {
    return preset < std::size(kRows) ? preset : uint32_t(FW_MATERIAL_NONCOMBUSTIBLE);
}

}  // namespace

std::span<const MaterialAppearance> materialAppearances() noexcept { return kAppearances; }
std::span<const MaterialFamily> materialFamilies() noexcept { return kFamilies; }

MaterialAppearance materialAppearance(uint32_t preset) noexcept {
    return kAppearances[rowOf(preset)];
}

float freshBend(uint32_t preset) noexcept { return kRows[rowOf(preset)].bend; }

float holeEndSeconds(
    const gpu::MaterialAppearance& appearance) noexcept {  // holeDelay, appearance.glsl
    return appearance.holeTime +
           0.45f * appearance.holeVariation * (0.9f + 0.8f * appearance.holeFine) +
           2.3f * appearance.jitter;
}

mesh::RefineHoles holesOf(const gpu::MaterialAppearance& appearance) noexcept {
    mesh::RefineHoles holes;
    if (!(appearance.holeTime > 0)) return holes;
    holes.variation = appearance.holeVariation / appearance.holeTime;
    holes.wood = appearance.base == gpu::kBaseWood || appearance.base == gpu::kBasePaint;
    holes.tilesX = holes.wood ? 2.6f : appearance.holeTiles;
    holes.tilesY = holes.wood ? 0.3f * 2.6f : appearance.holeTiles / appearance.drip;
    return holes;
}

}  // namespace fw::components
