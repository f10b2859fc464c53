// The paint page: burn multiplier, moisture and material painted on a mesh, in space and in its
// unwrap alike. A stroke shows as it is drawn; the document gets it whole, as one step, when the
// hand lets go.
#pragma once

#include <memory>

#include "app/app.h"

namespace fwapp {

enum class PaintTool : int { kPaint, kErase, kSmooth, kFill, kPick };

struct PaintPage {
    PaintTool tool = PaintTool::kPaint;
    uint32_t kind = fwedit::PaintMultiplier;  // of layer that is painted
    float size = 64;                          // mm across, in the world
    float strength = 70, hardness = 35;       // %
    bool mirror = false, through = false;     // through: thin walls on both sides
    float multiplier = 1.85f, moisture = 30;  // times, %
    int material = FW_MATERIAL_PAPER;         // FwMaterialPreset
    int fillBy = 1;                           // FillBy
    float slopeLow = 0, slopeHigh = 35;       // degrees from level
    float curveLow = 5, curveHigh = 10000;    // 1/m
    int view = 1;                             // 3D, both, unwrap
    float zoom = 1;                           // of the unwrap
    ImVec2 shift{};                           // dp, of the unwrap
    fwedit::ObjectId mesh = 0, layer = 0;     // that are painted; 0: none
    fwedit::Vec3 up{0, 1, 0};

    // The stroke under way.
    std::unique_ptr<fwedit::StrokePainter> painter;
    fwedit::Stroke stroke;
    std::shared_ptr<const fwedit::PaintSurface> surface;  // of `mesh`
    bool orbits = false, pans = false, slides = false;

    // Where the last stroke ended, for a straight line from there.
    fwedit::ObjectId endedOn = 0;
    fwedit::Vec3 ended{}, endedNormal{};  // object space
    bool mayLine = false;                 // Shift is down: a click draws the line, a drag smooths
    float pressX = 0, pressY = 0;

    // Where the brush is, in space and in the unwrap; from the view under the mouse.
    bool aims = false;
    fwedit::Vec3 aim{}, aimNormal{};  // object space

    // What the overlay was coloured with.
    uint64_t coloredRevision = ~0ull;
    fwedit::ObjectId coloredMesh = 0, coloredLayer = 0;
    const fwedit::PaintSurface* coloredSurface = nullptr;
    bool colored = false;
};

// Lays what all layers of paint make of each mesh's speed over it.
void colorMultipliers(App& app);
void drawMultiplierLegend(ImDrawList* list, ImVec2 low, float room,
                          const char* name = "Burn multiplier");
void addPaintActions(App& app, std::vector<Action>& list);

}  // namespace fwapp
