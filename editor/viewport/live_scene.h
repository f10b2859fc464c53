// The open scene, burning: a world made of the document, stepped and drawn into a picture of the
// interface. Made anew in the background whenever the document changes; the last picture stays.
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
    kRest  // as it is before anything burns, without flames: to paint on
};

// A spot of the surface and what the burn says of it.
struct WhyCard {
    bool open = false, answered = false, asks = false;
    uint32_t frames = 0;  // after the one it was asked in, until it was answered
    fwedit::ObjectId mesh = 0;
    glm::vec3 position{0};  // m, world
    double time = 0;        // s that the answer is of
    fwedit::WhyQuestion question;
    fwedit::WhyAnswer answer, next;  // next: on its way
    std::string error;
    uint32_t waited = 0;  // frames since it was asked
    // Of the burn map, nearest to the place; found when it is first needed.
    size_t texel = 0;
    const fwedit::PaintSurface* texelOf = nullptr;
};

class LiveScene {
 public:
    // The context is lent the host's device and outlives this.
    LiveScene(const sample::VulkanHost& host, FwContext* context, fwui::UiRenderer& ui);
    ~LiveScene();
    LiveScene(const LiveScene&) = delete;
    LiveScene& operator=(const LiveScene&) = delete;

    // Once a frame, before the panels: takes a finished world over, starts the next if the document
    // has changed and no drag is under way; while one is, things move in the world that is there.
    // `paints`: what only layers of paint change waits until the page of the burn is there again.
    void follow(const fwedit::Document& document, bool paints = false);
    void forget();  // another document: nothing of the old one stays
    // Goes to that time: forward by running on, back from the nearest moment that was kept. While
    // a hand holds it, a time that was simulated before is previewed at once; see BurnMemory.
    void seek(double time, bool held = false);
    // Steps by `deltaTime` s (0: stands still) and draws, unless the picture would be the same.
    void record(const fwui::Frame& frame, const fwedit::Camera& camera, float deltaTime);
    // Nothing of what is seen would change: no frame is needed for its sake.
    [[nodiscard]] bool settled() const {
        return !preparing() && !seeking() && !stale_ && !laid_ && !memory_.waits() &&
               overlay.settled() && !asks() && !otherLags();
    }
    // Beside this burn another one of the scene as it was: the picture is in two halves, the other
    // one at the left, and both are at one time. It stays as it is while the document changes.
    void compareWith(const fwedit::Scene& scene, const fwedit::PaintImages& images,
                     const std::filesystem::path& folder);
    void endCompare();
    [[nodiscard]] bool comparing() const { return compared_ != nullptr; }
    // Both halves are there; until then the picture is the burn alone.
    [[nodiscard]] bool comparesNow() const { return other_ && shown == Shown::kBurn; }
    // Pixels of the picture.
    void resize(uint32_t width, uint32_t height);

    [[nodiscard]] bool preparing() const { return work_.valid() || pipelines_.valid(); }
    // The context's pipelines are built while the first page is looked at; waits for them.
    void awaitPipelines();
    // What painting and scrubbing need is not there yet.
    [[nodiscard]] bool resting() const { return restWanted_ || restWork_.valid(); }
    [[nodiscard]] bool seeking() const {
        return burn_ && !previewed_ && burn_->time + 1e-4 < wanted_;
    }
    [[nodiscard]] bool previews() const { return preview_ >= 0; }
    [[nodiscard]] double time() const { return previews() ? preview_ : burn_ ? burn_->time : 0; }
    [[nodiscard]] const fwedit::Burn* burn() const { return burn_.get(); }
    // What the background does, and how far it is, [0, 1].
    std::string stage(float& share) const;
    // Leaves what is prepared: what was there before stays. Unwraps under way are finished first.
    void cancel() { stop_ = true; }
    // It was left; `goOn` takes it up again, as any change of the scene does.
    [[nodiscard]] bool stopped() const { return stopped_; }
    void goOn() { restart_ = true; }
    // The surface under a pixel, x and y in [0, 1]; locked things are looked through if wished.
    SurfaceHit pick(float x, float y, bool throughLocked) const;
    // The outline of a mesh as pairs of places in [0, 1] of a picture of so many pixels.
    void outlineOf(fwedit::ObjectId mesh, ImVec2 size, std::vector<glm::vec2>& lines);
    // Asks the burn of a spot; the answer comes some frames later, and anew as the fire goes on.
    void askWhy(fwedit::ObjectId mesh, glm::vec3 position);
    // Keeps the card's spot: it is asked on as the fire goes, and as a hand scrubs.
    void pinWhy();
    // s at which a spot catches, as far as it was simulated; < 0: not, or not known.
    double caughtAt(WhyCard& card) const;
    [[nodiscard]] const std::filesystem::path& cache() const { return assets_.cache; }
    // Texels to paint on; null: not made yet, or the mesh has none.
    [[nodiscard]] std::shared_ptr<const fwedit::PaintSurface> surfaceOf(
        fwedit::ObjectId mesh) const;
    // The overlay has changed: the picture is to be drawn again.
    void redraw() { stale_ = true; }
    // s until when it is known when each texel caught; < 0: not yet.
    [[nodiscard]] double knownTime() const { return rest_.burn ? memory_.known() : -1; }
    // Colours the overlay by when each texel caught, as far as it was simulated.
    void colorBurnTimes(std::span<const fwui::MapStop> map);
    bool bounds(glm::vec3& low, glm::vec3& high) const;    // of all meshes; false: there are none
    double milliseconds() const { return milliseconds_; }  // the device's, of the last frame
    std::vector<std::string> takeReport();                 // what was left out, for people

    SceneTarget target;
    FwView view{};  // of the last frame
    Shown shown = Shown::kBurn;
    WhyCard why;
    std::vector<WhyCard> pins;  // the first is number 1
    MapOverlay overlay;
    FilmStrip film;                          // of this burn, as far as it was seen
    std::vector<fwedit::ObjectId> laidOver;  // meshes whose map of the overlay is on the picture

 private:
    struct Outline {  // as it was last asked for
        glm::mat4 seen{0};
        glm::vec2 pixels{0};
        const fwimport::ImportedModel* model = nullptr;
        std::vector<glm::vec2> lines;
    };
    struct Made {
        std::unique_ptr<fwedit::Burn> burn;
        std::string error;
    };
    struct Rest {  // what painting and scrubbing need beside the burn
        std::unique_ptr<fwedit::Burn> burn;
        std::map<fwedit::ObjectId, std::shared_ptr<const fwedit::PaintSurface>> surfaces;
    };
    struct Half {  // a burn in its part of the picture
        fwedit::Burn& burn;
        sample::Studio& studio;
        const FwView& from;
        VkViewport viewport;
        bool ready;  // to be drawn
    };
    void adopt(Made made);
    void startRest();
    void adoptRest(Rest made);
    bool goBack();
    void preview();
    [[nodiscard]] bool canLayOver(bool moved) const;
    FwResult recordOutside(fwedit::Burn& burn, const FwVulkanFrame& frame, const FwView& from);
    void followWhy();
    void pollWhy(WhyCard& card);
    [[nodiscard]] std::vector<WhyCard*> cards();
    [[nodiscard]] bool asks() const;
    void adoptOther(Made made);
    void followOther();
    void stepOther(const FwVulkanFrame& frame);
    // The burn that is compared with is at another time, or not made yet.
    [[nodiscard]] bool otherLags() const;
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
    std::future<void> pipelines_;  // on their way; nothing of the plugin is shown before
    std::future<Made> work_;
    Rest rest_;
    std::future<Rest> restWork_;
    bool restWanted_ = false;
    bool restFresh_ = false;  // nothing of it was recorded yet
    fwedit::BurnMemory memory_;
    MapOverlay burnt_;        // of the preview
    bool laid_ = false;       // what lies over the preview has changed, and nothing else
    bool kept_ = false;       // the target keeps the picture below it
    double preview_ = -1;     // s that are shown from memory; < 0: none
    bool previewed_ = false;  // a hand holds the preview
    bool owesPaint_ = false;
    std::atomic<bool> stop_{false};
    bool stopped_ = false;
    mutable std::mutex stageMutex_;
    std::string stage_;
    float share_ = 0;
    fwedit::Scene scene_;  // as last followed
    fwedit::PaintImages images_;
    std::filesystem::path folder_;
    uint64_t seen_ = ~0ull;  // revision that the world, or the one on its way, is of
    bool restart_ = false;
    double wanted_ = 0;  // s, of seek
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
    FwView otherView_{};           // in its own light
    std::vector<uint8_t> values_;  // by texel, of what is coloured
    double milliseconds_ = 0;
    std::string studioKey_;
};

}  // namespace fwview
