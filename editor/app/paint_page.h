// The paint page: paints burn multiplier, moisture and material on a mesh, in space and in its
// unwrap. A stroke shows while it is drawn. On release, the document records it as one step.
#pragma once

#include <memory>

#include "app/app.h"

namespace fwapp {

enum class PaintTool : int { kPaint, kErase, kSmooth, kFill, kPick };

struct PaintPage {
    PaintTool tool = PaintTool::kPaint;
    uint32_t kind = fwedit::PaintMultiplier;  // type of the painted layer
    float size = 64;                          // mm, diameter in the world
    float strength = 70, hardness = 35;       // %
    bool mirror = false, through = false;     // through: paints thin walls on both sides
    float multiplier = 1.85f, moisture = 30;  // factor, %
    int material = FW_MATERIAL_PAPER;         // FwMaterialPreset
    int fillBy = 1;                           // FillBy
    float slopeLow = 0, slopeHigh = 35;       // degrees from horizontal
    float curveLow = 5, curveHigh = 10000;    // 1/m
    int view = 1;                             // 3D, both, or unwrap
    float zoom = 1;                           // of the unwrap view
    ImVec2 shift{};                           // dp, of the unwrap view
    fwedit::ObjectId mesh = 0, layer = 0;     // current targets; 0: none
    fwedit::Vec3 up{0, 1, 0};

    // The stroke in progress.
    std::unique_ptr<fwedit::StrokePainter> painter;
    fwedit::Stroke stroke;
    std::shared_ptr<const fwedit::PaintSurface> surface;  // surface of `mesh`
    bool orbits = false, pans = false, slides = false;

    // End of the last stroke, for a straight line from it.
    fwedit::ObjectId endedOn = 0;
    fwedit::Vec3 ended{}, endedNormal{};  // object space
    bool mayLine = false;                 // Shift is down: a click draws a line, a drag smooths
    float pressX = 0, pressY = 0;

    // Brush position in space and in the unwrap, from the view under the mouse.
    bool aims = false;
    fwedit::Vec3 aim{}, aimNormal{};  // object space

    // State that the overlay's colours were computed from.
    uint64_t coloredRevision = ~0ull;
    fwedit::ObjectId coloredMesh = 0, coloredLayer = 0;
    const fwedit::PaintSurface* coloredSurface = nullptr;
    bool colored = false;
};

// Colours each mesh by the combined burn multiplier of all paint layers.
void colorMultipliers(App& app);
void drawMultiplierLegend(ImDrawList* list, ImVec2 low, float room,
                          const char* name = "Burn multiplier");
void addPaintActions(App& app, std::vector<Action>& list);

}  // namespace fwapp
