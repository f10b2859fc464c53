// The flame page: paints temperature and soot over radius and height, and previews the burning
// flame at night, by day and in wind. A profile belongs to a flame of the scene once it is saved
// for it. Until then it is a draft with its own undo.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/app.h"
#include "common/studio.h"
#include "document/flame_curve.h"
#include "document/flame_paint.h"
#include "viewport/scene_target.h"

namespace fwapp {

using fwedit::ProfilePaint;
using fwedit::ProfilePlane;
using fwedit::ProfileTool;

// A flame in progress, by brush or by points.
struct FlameDraft {
    ProfilePaint paint;
    bool curves = false;  // painted from `curve`
    fwedit::FlameCurve curve = fwedit::standardCurve();
    uint32_t preset = 0;
    float diameter = 0.6f, power = 60;  // m, kW
    float turbulence = 1, speed = 1;
    bool ownColors = false;  // instead of blackbody colours: linear, from edge to core
    std::array<float, 3> edge{0.2f, 0.45f, 1}, core{0.75f, 0.95f, 1};
    bool operator==(const FlameDraft&) const = default;
};

struct FlameCanvas;

struct FlamePage {
    FlamePage(const sample::VulkanHost& host, FwContext* context, fwui::UiRenderer& ui);
    ~FlamePage();
    FlamePage(const FlamePage&) = delete;
    FlamePage& operator=(const FlamePage&) = delete;

    bool import(App& app, const std::filesystem::path& file);
    bool exportTo(App& app, const std::filesystem::path& file);
    void usePreset(uint32_t preset);
    void useCurves(bool curves);                           // edit by points or by brush
    void curveChanged();                                   // repaints from the points
    bool loadFromScene(App& app, fwedit::ObjectId flame);  // copies a flame of the scene
    void applyToScene(App& app, fwedit::ObjectId flame, const std::string& profile);
    void compare(bool on);
    void swapWithOther();
    void recordStep(const char* name);
    void undo();
    void redo();
    void open();                         // creates worlds and targets when the page first opens
    void recreateFires();                // recreates the fires with the current profile
    [[nodiscard]] float height() const;  // m, height of the flame at night
    void record(const fwui::Frame& frame, float deltaTime);
    [[nodiscard]] bool isLively() const;

    struct View {
        std::unique_ptr<fwview::SceneTarget> target;
        FwWorld* world = nullptr;
        FwVolumetricFireId fire{};
        FwFireProfileId profile{};
        std::unique_ptr<sample::Studio> studio;
        fwui::Rect rect;
        float owed = 0;          // s, time not yet stepped
        uint64_t drawn = ~0ull;  // shown pictureRevision
        bool seen = false;
        float studioSize = 0;  // m
    };
    void sizeBackdrop(View& view, float distance);
    struct Step {
        std::string name;
        FlameDraft draft;
    };
    // A point of the outline or a stop, by its index; -1: none.
    struct Grip {
        int point = -1, stop = -1;
        bool operator==(const Grip&) const = default;
    };

    const sample::VulkanHost& host;
    FwContext* context;
    fwui::UiRenderer& ui;
    FwTargetId targetId{};
    View views[3];     // night, day, wind
    FlameDraft draft;  // A
    FlameDraft other;  // B, to compare with
    bool hasOther = false, compares = false;
    Grip chosen;  // selected grip of the curve
    bool gripped = false;
    std::vector<Step> steps;
    size_t at = 0;
    ProfileTool tool = ProfileTool::kPaint;
    ProfilePlane plane = ProfilePlane::kTemperature;
    float size = 12, strength = 60, softness = 70;  // cm, %, %
    float celsius = 1380, soot = 0.8f;
    float celsiusEnd = 700, sootEnd = 0.1f;  // end values of a gradient
    bool editsCore = false;                  // edits the core colour; false: the edge colour
    float wind = 4;                          // m/s, in the preview
    bool slow = false;                       // see App::slow
    bool paused = false, stroking = false, changed = true, opened = false;
    bool brushOpen = true, sizeOpen = true, lifeOpen = true, colorOpen = true;
    double time = 0;
    uint64_t pictureRevision = 0, drawnRevision = ~0ull;
    std::string problem;  // reason for a missing picture
    double relitAt = -1;
    float lastX = 0, lastY = 0;  // texels, last point of the stroke; for a gradient its start
    ProfilePaint underGradient;  // the paint below the gradient in progress
    // Shift was pressed after an earlier stroke: a click draws a line from its end, a drag smooths.
    bool ended = false, mayLine = false;
    float endedX = 0, endedY = 0;  // texels
    float pressX = 0, pressY = 0;
    float studioSize = 0;  // m
    uint64_t frameCount = 0;
    std::unique_ptr<FlameCanvas> canvas;
    std::vector<sample::Image> presetImages;
    std::vector<void*> presetTextures;
};

void addFlameActions(App& app, std::vector<Action>& list);

}  // namespace fwapp
