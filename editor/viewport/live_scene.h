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
#include "document/burn.h"
#include "viewport/outline.h"
#include "viewport/scene_target.h"
#include "viewport/surface_ray.h"

namespace fwview {

class LiveScene {
 public:
    // The context is lent the host's device and outlives this.
    LiveScene(const sample::VulkanHost& host, FwContext* context, fwui::UiRenderer& ui);
    ~LiveScene();
    LiveScene(const LiveScene&) = delete;
    LiveScene& operator=(const LiveScene&) = delete;

    // Once a frame, before the panels: takes a finished world over, starts the next if the document
    // has changed and no drag is under way; while one is, things move in the world that is there.
    void follow(const fwedit::Document& document);
    void forget();  // another document: nothing of the old one stays
    // Goes to that time: forward by running on, back by starting anew and running on.
    void seek(double time);
    // Steps by `deltaTime` s (0: stands still) and draws, unless the picture would be the same.
    void record(const fwui::Frame& frame, const fwedit::Camera& camera, float deltaTime);
    // Nothing of what is seen would change: no frame is needed for its sake.
    [[nodiscard]] bool settled() const { return !preparing() && !seeking() && !stale_; }
    // Pixels of the picture.
    void resize(uint32_t width, uint32_t height);

    [[nodiscard]] bool preparing() const { return work_.valid(); }
    [[nodiscard]] bool seeking() const { return burn_ && burn_->time + 1e-4 < wanted_; }
    [[nodiscard]] double time() const { return burn_ ? burn_->time : 0; }
    [[nodiscard]] const fwedit::Burn* burn() const { return burn_.get(); }
    // What the background does, and how far it is, [0, 1].
    std::string stage(float& share) const;
    void cancel() { stop_ = true; }
    // The surface under a pixel, x and y in [0, 1]; locked things are looked through if wished.
    SurfaceHit pick(float x, float y, bool throughLocked) const;
    // The outline of a mesh as pairs of places in [0, 1] of a picture of so many pixels.
    void outlineOf(fwedit::ObjectId mesh, ImVec2 size, std::vector<glm::vec2>& lines);
    bool bounds(glm::vec3& low, glm::vec3& high) const;    // of all meshes; false: there are none
    double milliseconds() const { return milliseconds_; }  // the device's, of the last frame
    std::vector<std::string> takeReport();                 // what was left out, for people

    SceneTarget target;
    FwView view{};  // of the last frame

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
    void adopt(Made made);
    void setUpStudio();
    void moveDragged(const fwedit::Document& document);

    const sample::VulkanHost& host_;
    FwContext* context_;
    FwTargetId targetId_{};
    fwedit::Assets assets_;
    std::unique_ptr<fwedit::Burn> burn_;
    std::unique_ptr<sample::Studio> studio_;
    std::future<Made> work_;
    std::atomic<bool> stop_{false};
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
    double milliseconds_ = 0;
    std::string studioKey_;
};

}  // namespace fwview
