// The open scene as a burning world, stepped and drawn into a texture of the interface. Each
// document change rebuilds it in the background while the last picture stays.
#pragma once

#include <imgui.h>

#include <atomic>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "common/studio.h"
#include "document/burn_memory.h"
#include "document/inspect.h"
#include "viewport/film_strip.h"
#include "viewport/map_overlay.h"
#include "viewport/outline.h"
#include "viewport/scene_target.h"
#include "viewport/surface_ray.h"

namespace fwview {

enum class Shown : uint32_t {
    kBurn,
    kRest  // unburnt and without flames, for painting
};

// A spot on the surface and the burn's answer for it.
struct WhyCard {
    bool open = false, answered = false, asks = false;
    uint32_t frames = 0;  // frames from the query to the answer
    fwedit::ObjectId mesh = 0;
    glm::vec3 position{0};  // m, world
    double time = 0;        // s, time of the answer
    fwedit::WhyQuestion question;
    fwedit::WhyAnswer answer, next;  // next: pending
    std::string error;
    uint32_t waited = 0;  // frames since the query
    // Nearest burn map texel; resolved on first use.
    size_t texel = 0;
    const fwedit::PaintSurface* texelOf = nullptr;
};

class LiveScene {
 public:
    // The context uses the host's device and must outlive this object.
    LiveScene(const sample::VulkanHost& host, FwContext* context, fwui::UiRenderer& ui);
    ~LiveScene();
    LiveScene(const LiveScene&) = delete;
    LiveScene& operator=(const LiveScene&) = delete;

    // Call it once per frame before the panels. Adopts a finished world and starts the next one if
    // the document changed. During a drag, objects move in the current world instead. `paints`:
    // changes of paint layers wait until the page that shows the burn is active.
    void follow(const fwedit::Document& document, bool paints = false);
    void forget();  // drops all state of the previous document
    // Goes to that time: forward by simulation, backward from the nearest snapshot. `held`: a
    // simulated time is previewed at once; see BurnMemory.
    void seek(double time, bool held = false);
    // Steps by `deltaTime` s (0: paused) and draws, unless the picture would be equal.
    void record(const fwui::Frame& frame, const fwedit::Camera& camera, float deltaTime);
    // Nothing visible would change, so no frame is necessary.
    [[nodiscard]] bool isSettled() const {
        return !isPreparing() && !isSeeking() && !stale_ && !overlayStale_ &&
               !memory_.isPending() && overlay.isSettled() && !hasOpenQuestion() &&
               !isOtherBehind();
    }
    // Compares with another scene: the picture has two halves at the same time, the other scene on
    // the left. The other scene ignores document changes.
    void compareWith(const fwedit::Scene& scene, const fwedit::PaintImages& images,
                     const std::filesystem::path& folder);
    void endCompare();
    [[nodiscard]] bool isComparing() const { return compared_ != nullptr; }
    // Both halves are ready. Until then the picture shows this burn alone.
    [[nodiscard]] bool showsComparison() const { return other_ && shown == Shown::kBurn; }
    // Size of the picture in pixels.
    void resize(uint32_t width, uint32_t height);

    [[nodiscard]] bool isPreparing() const { return work_.valid() || pipelines_.valid(); }
    // Waits for the context's pipelines, which are built during the first page.
    void awaitPipelines();
    // Data for painting and scrubbing is still being prepared.
    [[nodiscard]] bool isPreparingRest() const { return restWanted_ || restWork_.valid(); }
    [[nodiscard]] bool isSeeking() const {
        return burn_ && !previewed_ && burn_->time + 1e-4 < wanted_;
    }
    [[nodiscard]] bool isPreviewing() const { return preview_ >= 0; }
    [[nodiscard]] double time() const {
        return isPreviewing() ? preview_ : burn_ ? burn_->time : 0;
    }
    [[nodiscard]] const fwedit::Burn* burn() const { return burn_.get(); }
    // Returns the background stage and its progress, [0, 1].
    std::string stage(float& share) const;
    // Cancels the preparation and keeps the previous state. Running unwraps finish first.
    void cancel() { stop_ = true; }
    // The preparation was cancelled. `resume` or a change of the scene resumes it.
    [[nodiscard]] bool isCancelled() const { return stopped_; }
    void resume() { restart_ = true; }
    // Returns the surface under a pixel, x and y in [0, 1]. `throughLocked`: ignores locked
    // objects.
    SurfaceHit pick(float x, float y, bool throughLocked) const;
    // Returns the outline of a mesh as pairs of points in [0, 1] of a picture of `size` pixels.
    void outlineOf(fwedit::ObjectId mesh, ImVec2 size, std::vector<glm::vec2>& lines);
    // Queries the burn about a spot. The answer comes some frames later and updates as the fire
    // goes on.
    void askWhy(fwedit::ObjectId mesh, glm::vec3 position);
    // Pins the card's spot: its answer updates during playback and scrubbing.
    void pinWhy();
    // s, ignition time of a spot as far as simulated; < 0: none or unknown.
    double caughtAt(WhyCard& card) const;
    [[nodiscard]] const std::filesystem::path& cache() const { return assets_.cache; }
    // Returns the texels to paint on; null: not ready, or the mesh has none.
    [[nodiscard]] std::shared_ptr<const fwedit::PaintSurface> surfaceOf(
        fwedit::ObjectId mesh) const;
    // The overlay has changed, so the picture must be redrawn.
    void redraw() { stale_ = true; }
    // s until which ignition times are known; < 0: not ready.
    [[nodiscard]] double knownTime() const { return rest_.burn ? memory_.known() : -1; }
    // Colours the overlay by ignition time, as far as simulated.
    void colorBurnTimes(std::span<const fwui::MapStop> map);
    bool bounds(glm::vec3& low, glm::vec3& high) const;    // bounds of all meshes; false: there are
                                                           // none
    double milliseconds() const { return milliseconds_; }  // device time of the last frame
    std::vector<std::string> takeReport();                 // skipped objects, messages for the user

    SceneTarget target;
    FwView view{};  // view of the last frame
    Shown shown = Shown::kBurn;
    WhyCard why;
    std::vector<WhyCard> pins;  // numbered from 1
    MapOverlay overlay;
    FilmStrip film;                          // of this burn, as far as played
    std::vector<fwedit::ObjectId> overlaid;  // meshes whose overlay map is visible

 private:
    struct Outline {  // as last requested
        glm::mat4 seen{0};
        glm::vec2 pixels{0};
        const fwimport::ImportedModel* model = nullptr;
        std::vector<glm::vec2> lines;
    };
    struct Made {
        std::unique_ptr<fwedit::Burn> burn;
        std::string error;
    };
    struct Rest {  // data for painting and scrubbing
        std::unique_ptr<fwedit::Burn> burn;
        std::map<fwedit::ObjectId, std::shared_ptr<const fwedit::PaintSurface>> surfaces;
    };
    struct Half {  // a burn in its half of the picture
        fwedit::Burn& burn;
        sample::Studio& studio;
        const FwView& from;
        VkViewport viewport;
        bool ready;  // ready to draw
    };
    void adopt(Made made);
    void startRest();
    void adoptRest(Rest made);
    bool goBack();
    void preview();
    [[nodiscard]] bool canRedrawOverlay(bool moved) const;
    FwResult recordOutside(fwedit::Burn& burn, const FwVulkanFrame& frame, const FwView& from);
    void followWhy();
    void pollWhy(WhyCard& card);
    [[nodiscard]] std::vector<WhyCard*> cards();
    [[nodiscard]] bool hasOpenQuestion() const;
    void adoptOther(Made made);
    void followOther();
    void stepOther(const FwVulkanFrame& frame);
    // The comparison's burn is at another time, or not ready.
    [[nodiscard]] bool isOtherBehind() const;
    std::unique_ptr<sample::Studio> makeStudio(const fwedit::Burn& burn) const;
    void drawSolids(const fwui::Frame& frame, const Half& part, const FwVulkanFrame& described);
    void recordInside(const Half& part, const FwVulkanFrame& described, FwTargetId id);
    [[nodiscard]] VkViewport half(bool right) const;
    void drawOverlays(const fwui::Frame& frame);
    void warmPreview(const fwui::Frame& frame);
    void setUpStudio();
    void moveDragged(const fwedit::Document& document);

    const sample::VulkanHost& host_;
    FwContext* context_;
    FwTargetId solids_{}, flames_{};
    fwedit::Assets assets_;
    std::unique_ptr<fwedit::Burn> burn_;
    std::unique_ptr<sample::Studio> studio_;
    std::future<void> pipelines_;  // pending; the plugin draws nothing before
    std::future<Made> work_;
    Rest rest_;
    std::future<Rest> restWork_;
    bool restWanted_ = false;
    bool restFresh_ = false;  // nothing has been recorded since it was created
    fwedit::BurnMemory memory_;
    MapOverlay burnt_;           // overlay of the preview
    bool overlayStale_ = false;  // only the overlays over the preview changed
    bool kept_ = false;          // the target has a copy of the picture below the overlays
    double preview_ = -1;        // s, time shown from memory; < 0: none
    bool previewed_ = false;     // the user holds the preview
    bool owesPaint_ = false;
    std::atomic<bool> stop_{false};
    bool stopped_ = false;
    mutable std::mutex stageMutex_;
    std::string stage_;
    float share_ = 0;
    fwedit::Scene scene_;  // as of the last follow()
    fwedit::PaintImages images_;
    std::filesystem::path folder_;
    uint64_t seen_ = ~0ull;  // revision of the current or pending world
    bool restart_ = false;
    double wanted_ = 0;  // s, target of seek
    bool stale_ = true;
    fwedit::Camera camera_;
    std::map<fwedit::ObjectId, Outline> outlines_;
    std::vector<std::string> report_;
    struct Compared {
        fwedit::Scene scene;
        fwedit::PaintImages images;
        std::filesystem::path folder;
    };
    std::unique_ptr<Compared> compared_;
    std::unique_ptr<fwedit::Burn> other_;
    std::unique_ptr<sample::Studio> otherStudio_;
    std::future<Made> otherWork_;
    fwedit::BurnMemory otherMemory_;
    FwResult otherOutside_ = FW_OK;
    FwView otherView_{};           // with its own light
    std::vector<uint8_t> values_;  // by texel, of the map in progress
    double milliseconds_ = 0;
    std::string studioKey_;
};

}  // namespace fwview
