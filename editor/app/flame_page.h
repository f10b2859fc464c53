// The flame page: temperature and soot over radius and height, painted with a brush, seen burning
// beside it at night, by day and in wind. A profile belongs to a flame of the scene once it is
// saved for it; until then it is a draft of its own, with its own undo.
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

// A flame as it is being made, by the brush or by points.
struct FlameDraft {
    ProfilePaint paint;
    bool curves = false;  // made of `curve`, which paints it
    fwedit::FlameCurve curve = fwedit::standardCurve();
    uint32_t preset = 0;
    float diameter = 0.6f, power = 60;  // m, kW
    float turbulence = 1, speed = 1;
    bool ownColors = false;  // instead of a hot body's: linear, from its edge to its core
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
    void useCurves(bool curves);                      // by points or by the brush
    void curveChanged();                              // its points paint it anew
    bool takeFrom(App& app, fwedit::ObjectId flame);  // a flame of the scene
    void putInto(App& app, fwedit::ObjectId flame, const std::string& profile);
    void compare(bool on);
    void swapWithOther();
    void keepStep(const char* name);
    void undo();
    void redo();
    void open();                         // worlds and targets, when the page is first seen
    void relight();                      // the fires anew, of the profile as it is
    [[nodiscard]] float height() const;  // m, of the flame at night
    void record(const fwui::Frame& frame, float deltaTime);
    [[nodiscard]] bool lively() const;

    struct View {
        std::unique_ptr<fwview::SceneTarget> target;
        FwWorld* world = nullptr;
        FwVolumetricFireId fire{};
        FwFireProfileId profile{};
        std::unique_ptr<sample::Studio> studio;
        fwui::Rect rect;
        float owed = 0;          // s that it has not been stepped
        uint64_t drawn = ~0ull;  // pictureRevision that it shows
        bool seen = false;
        float studioSize = 0;  // m
    };
    void standAround(View& view, float distance);
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
    Grip chosen;  // of the curve
    bool gripped = false;
    std::vector<Step> steps;
    size_t at = 0;
    ProfileTool tool = ProfileTool::kPaint;
    ProfilePlane plane = ProfilePlane::kTemperature;
    float size = 12, strength = 60, softness = 70;  // cm, %, %
    float celsius = 1380, soot = 0.8f;
    float celsiusEnd = 700, sootEnd = 0.1f;  // where a gradient goes
    bool editsCore = false;                  // of the own colours; else that of the edge
    float wind = 4;                          // m/s, of the preview
    bool slow = false;                       // see App::slow
    bool paused = false, stroking = false, changed = true, opened = false;
    bool brushOpen = true, sizeOpen = true, lifeOpen = true, colorOpen = true;
    double time = 0;
    uint64_t pictureRevision = 0, drawnRevision = ~0ull;
    std::string problem;  // why there is no picture
    double relitAt = -1;
    float lastX = 0, lastY = 0;  // texels, of the stroke under way; of a gradient its begin
    ProfilePaint underGradient;  // what was there before it
    // A press with Shift where a stroke has ended before: a line from there, unless it drags.
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
