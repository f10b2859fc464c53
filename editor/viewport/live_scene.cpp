#include "viewport/live_scene.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <glm/gtc/type_ptr.hpp>

#include "common/fire_host.h"
#include "flamewright/flamewright_debug.h"

namespace fwview {
namespace {

constexpr float kSeekStep = 1.0f / 8;  // s of burn time per catch-up step
constexpr uint32_t kSeekSteps = 4;     // such steps per frame
constexpr size_t kMostPins = 9;

std::filesystem::path cacheFolder() {
    if (const char* given = std::getenv("XDG_CACHE_HOME"); given && *given)
        return std::filesystem::path(given) / "flamewright";
    if (const char* home = std::getenv("HOME"); home && *home)
        return std::filesystem::path(home) / ".cache/flamewright";
    return {};
}

// Palette for BurnMemory::agesAt: glowing front, embers, char.
const Palette& burntPalette() {
    static const Palette palette = [] {
        constexpr fwui::MapStop kStops[] = {{0, fwui::hex(0xFFE2A0)},
                                            {0.04f, fwui::hex(0xFF9A3C)},
                                            {0.2f, fwui::hex(0xB8400E)},
                                            {0.6f, fwui::hex(0x4A1C10)},
                                            {1, fwui::hex(0x1A1412)}};
        Palette made{};
        for (uint32_t i = 1; i < 256; ++i)
            made[i] = premultiplied(fwui::sampleMap(kStops, float(i - 1) / 254), 0.9f);
        return made;
    }();
    return palette;
}

glm::mat4 poseOf(const fwedit::Mesh& mesh) {
    const std::array<float, 16> values = fwedit::transformOf(mesh);
    return glm::make_mat4(values.data());
}

std::string lastMessage(FwWorld* world) {
    char text[512] = "";
    fwWorld_GetLastMessage(world, text, sizeof text);
    return text;
}

// Returns the parts that require a new world. Names, marks and the camera do not.
fwedit::Scene withoutLabels(const fwedit::Scene& scene, bool paints) {
    fwedit::Scene plain = scene;
    if (paints) plain.layers.clear();
    plain.camera = {};
    plain.events.clear();
    plain.nextId = 0;
    fwedit::forEachList(plain, [](fwedit::Kind, auto& list) {
        for (auto& object : list) {
            object.name.clear();
            object.locked = false;
        }
    });
    return plain;
}

}  // namespace

LiveScene::LiveScene(const sample::VulkanHost& host, FwContext* context, fwui::UiRenderer& ui)
    : target(host, ui),
      overlay(host, ui, target.overPass()),
      film(host, ui),
      host_(host),
      context_(context),
      burnt_(host, ui, target.overPass()) {
    assets_.cache = cacheFolder();
    assets_.progress = [this](const std::string& stage, float share) {
        const std::lock_guard lock(stageMutex_);
        stage_ = stage;
        share_ = share;
        return !stop_;
    };
    pipelines_ = std::async(std::launch::async, [this, context] {
        const FwVulkanTargetDef solids = target.solids(), flames = target.flames();
        if (fwContext_RegisterTarget(context, &solids, &solids_) == FW_OK &&
            fwContext_RegisterTarget(context, &flames, &flames_) == FW_OK &&
            fwContext_Prepare(context) == FW_OK)
            return;
        char text[512] = "";
        fwContext_GetLastMessage(context, text, sizeof text);
        throw sample::Failure(std::string("The viewport cannot be rendered: ") + text);
    });
}

void LiveScene::awaitPipelines() {
    if (pipelines_.valid()) pipelines_.get();  // rethrows their failure
}

LiveScene::~LiveScene() {
    stop_ = true;
    if (pipelines_.valid()) pipelines_.wait();
    if (work_.valid()) work_.wait();
    if (restWork_.valid()) restWork_.wait();
    if (otherWork_.valid()) otherWork_.wait();
    vkDeviceWaitIdle(host_.device);
    work_ = {};
    otherWork_ = {};
    restWork_ = {};
    burn_.reset();
    other_.reset();
    rest_ = {};
    for (const FwTargetId id : {solids_, flames_}) fwContext_UnregisterTarget(context_, id);
}

void LiveScene::forget() {
    stop_ = true;
    if (work_.valid()) work_.get();
    if (restWork_.valid()) restWork_.get();
    vkDeviceWaitIdle(host_.device);
    burn_.reset();
    rest_ = {};
    restWanted_ = false;
    memory_.forget();
    film.forget();
    overlay.clear();
    burnt_.clear();
    overlaid.clear();
    why = {};
    pins.clear();
    endCompare();
    preview_ = -1;
    previewed_ = owesPaint_ = false;
    studio_.reset();
    studioKey_.clear();
    outlines_.clear();
    seen_ = ~0ull;
    scene_ = {};
    wanted_ = 0;
    restart_ = true;
    stale_ = true;
}

void LiveScene::follow(const fwedit::Document& document, bool paints) {
    const auto done = [](const auto& work) {
        return work.valid() && work.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    };
    if (pipelines_.valid() && !done(pipelines_)) return;
    awaitPipelines();
    if (done(work_)) adopt(work_.get());
    if (done(restWork_)) adoptRest(restWork_.get());
    if (done(otherWork_)) adoptOther(otherWork_.get());
    if (work_.valid() || otherWork_.valid()) return;
    followOther();
    if (otherWork_.valid()) return;
    if (document.revision == seen_ && !restart_ && (paints || !owesPaint_)) {
        startRest();
        return;
    }
    if (document.dragging) {
        moveDragged(document);
        return;
    }
    if (restWork_.valid()) return;  // the background uses the assets
    seen_ = document.revision;
    stale_ = true;
    const bool sameScene = withoutLabels(document.scene, paints) == withoutLabels(scene_, paints);
    if (paints && burn_ && sameScene && !restart_) {
        owesPaint_ = true;
        return;
    }
    owesPaint_ = false;
    const bool same = burn_ && sameScene && document.images == images_;
    scene_ = document.scene;
    images_ = document.images;
    if (same && !restart_) return;
    // A change shows at the current time.
    if (!restart_ && burn_) wanted_ = std::max(wanted_, burn_->time);
    restart_ = false;
    folder_ = document.file.empty() ? std::filesystem::current_path()
                                    : std::filesystem::absolute(document.file).parent_path();
    stop_ = stopped_ = false;
    work_ =
        std::async(std::launch::async, [this, scene = scene_, images = images_, folder = folder_] {
            Made made;
            made.burn = fwedit::createBurn(context_, scene, images, folder, assets_, made.error);
            return made;
        });
}

void LiveScene::adopt(Made made) {
    stale_ = true;
    stopped_ = stop_;
    if (stopped_) {
        vkDeviceWaitIdle(host_.device);  // its results are dropped
        return;
    }
    if (!made.burn) {
        report_.push_back(made.error);
        return;
    }
    vkDeviceWaitIdle(host_.device);
    report_.insert(report_.end(), made.burn->report.begin(), made.burn->report.end());
    for (const fwedit::BurnMesh& mesh : made.burn->meshes) {
        const auto isOfMesh = [&](const fwedit::BurnMesh& at) { return at.model == mesh.model; };
        if (burn_ && std::ranges::any_of(burn_->meshes, isOfMesh)) continue;  // already reported
        report_.insert(report_.end(), mesh.model->notes.begin(), mesh.model->notes.end());
    }
    burn_ = std::move(made.burn);
    // The background owns the assets; its results are here.
    burn_->surfaceOf = [this](const fwedit::Mesh& mesh) { return surfaceOf(mesh.id); };
    for (WhyCard* card : cards()) {
        card->asks = false;
        card->time = -1e9;  // the answer is about another fire
        card->error.clear();
        card->texelOf = nullptr;
    }
    memory_.begin(*burn_);
    film.forget();
    preview_ = -1;
    previewed_ = false;
    restWanted_ = true;
    setUpStudio();
}

// Prepares the unburnt scene and the texels of its meshes, once the burn itself is ready.
void LiveScene::startRest() {
    if (!restWanted_ || restWork_.valid() || !burn_) return;
    restWanted_ = false;
    restWork_ = std::async(std::launch::async, [this, scene = burn_->scene, folder = folder_] {
        Rest made;
        std::string ignored;  // the burn already reported skipped objects
        made.burn = fwedit::createBurn(context_, scene, {}, folder, assets_, ignored);
        if (!made.burn) return made;
        for (const fwedit::BurnPart& part : made.burn->parts) {
            for (const FwVolumetricFireId fire : part.fires)
                fwWorld_SetVolumetricFireHidden(made.burn->world, fire, 1);
            if (part.emitter.index1 != 0)
                fwWorld_SetFireEmitterHidden(made.burn->world, part.emitter, 1);
        }
        for (const fwedit::Mesh& mesh : scene.meshes)
            if (auto surface = fwedit::paintSurfaceOf(context_, mesh, folder, assets_, ignored))
                made.surfaces[mesh.id] = std::move(surface);
        return made;
    });
}

void LiveScene::adoptRest(Rest made) {
    vkDeviceWaitIdle(host_.device);
    rest_ = std::move(made);
    // Prepare, so that the first scrub does not wait.
    for (const auto& [mesh, surface] : rest_.surfaces) burnt_.prepare(mesh, surface);
    restFresh_ = rest_.burn != nullptr;
    stale_ = true;
}

std::shared_ptr<const fwedit::PaintSurface> LiveScene::surfaceOf(fwedit::ObjectId mesh) const {
    const auto found = rest_.surfaces.find(mesh);
    return found == rest_.surfaces.end() ? nullptr : found->second;
}

// The backdrop lies below the meshes and receives their shadow.
void LiveScene::setUpStudio() {
    std::string key;
    for (const fwedit::BurnMesh& mesh : burn_->meshes) {
        const fwedit::Mesh* object = fwedit::findIn(burn_->scene.meshes, mesh.id);
        key += mesh.bake;
        if (object) {
            const std::array<float, 16> pose = fwedit::transformOf(*object);
            key.append(reinterpret_cast<const char*>(pose.data()), sizeof pose);
        }
    }
    for (const fwedit::Flame& flame : burn_->scene.flames) {
        if (!burn_->meshes.empty()) break;  // its size follows the meshes
        const fwedit::Vec3 place = fwedit::worldPosition(burn_->scene, flame.id);
        const float values[] = {place[0], place[1], place[2], flame.diameter, flame.power};
        key.append(reinterpret_cast<const char*>(values), sizeof values);
    }
    const fwedit::Vec3 sun = burn_->scene.settings.sunDirection;
    key.append(reinterpret_cast<const char*>(sun.data()), sizeof sun);
    if (studio_ && key == studioKey_) return;
    studioKey_ = key;
    studio_ = makeStudio(*burn_);
}

std::unique_ptr<sample::Studio> LiveScene::makeStudio(const fwedit::Burn& burn) const {
    const fwedit::Backdrop backdrop = fwedit::backdropOf(burn);
    auto studio = std::make_unique<sample::Studio>(
        host_, target.pass(), glm::make_vec3(backdrop.middle.data()), backdrop.size);
    if (backdrop.any)
        studio->castShadow(backdrop.positions, backdrop.indices, glm::mat4(1),
                           glm::normalize(glm::make_vec3(burn.scene.settings.sunDirection.data())));
    return studio;
}

// ---- the other burn of a comparison

void LiveScene::compareWith(const fwedit::Scene& scene, const fwedit::PaintImages& images,
                            const std::filesystem::path& folder) {
    endCompare();
    compared_ = std::make_unique<Compared>(Compared{scene, images, folder});
    stale_ = true;
}

void LiveScene::endCompare() {
    if (otherWork_.valid()) otherWork_.get();
    if (other_) vkDeviceWaitIdle(host_.device);
    compared_.reset();
    other_.reset();
    otherStudio_.reset();
    otherMemory_.forget();
    stale_ = true;
}

bool LiveScene::isOtherBehind() const {
    return compared_ && (!other_ || (burn_ && std::fabs(other_->time - burn_->time) > 1e-4));
}

// Creates its world, and recreates it if it is past the time without an earlier snapshot.
void LiveScene::followOther() {
    if (!compared_ || otherWork_.valid() || restWork_.valid() || !burn_) return;
    if (other_ &&
        (other_->time <= burn_->time + 1e-4 || otherMemory_.restore(*other_, burn_->time)))
        return;
    stop_ = false;
    otherWork_ = std::async(std::launch::async, [this, compared = *compared_] {
        Made made;
        made.burn = fwedit::createBurn(context_, compared.scene, compared.images, compared.folder,
                                       assets_, made.error);
        return made;
    });
}

void LiveScene::adoptOther(Made made) {
    vkDeviceWaitIdle(host_.device);
    if (!made.burn) {
        report_.push_back(made.error);
        compared_.reset();
        return;
    }
    other_ = std::move(made.burn);
    otherMemory_.begin(*other_);
    otherStudio_ = makeStudio(*other_);
    stale_ = true;
}

// Steps towards the time of the burn itself. Call it after that one.
void LiveScene::stepOther(const FwVulkanFrame& frame) {
    FwVulkanFrame described = frame;
    described.deltaTime =
        std::clamp(float(burn_->time - other_->time), 0.0f, kSeekStep * kSeekSteps);
    std::string error;
    if (described.deltaTime > 0 && !fwedit::feedBurn(*other_, described.deltaTime, error))
        report_.push_back(error);
    otherMemory_.beforeFrame(*other_, described.deltaTime);
    otherOutside_ = recordOutside(*other_, described, otherView_);
    otherMemory_.afterFrame(*other_);
}

VkViewport LiveScene::half(bool right) const {
    VkViewport viewport = target.viewport();
    viewport.width = std::floor(0.5f * viewport.width);
    if (right) viewport.x = viewport.width;
    return viewport;
}

// During a drag, the current world shows the moved objects.
void LiveScene::moveDragged(const fwedit::Document& document) {
    if (!burn_) return;
    for (const fwedit::BurnMesh& mesh : burn_->meshes) {
        const fwedit::Mesh* object = fwedit::findIn(document.scene.meshes, mesh.id);
        if (!object) continue;
        const std::array<float, 16> pose = fwedit::transformOf(*object);
        fwWorld_SetTransform(burn_->world, mesh.object, pose.data());
    }
    for (const fwedit::BurnPart& part : burn_->parts) {
        if (!fwedit::findObject(document.scene, part.id)) continue;
        const fwedit::Vec3 place =
            fwedit::worldPosition(document.scene, part.id, document.nodePose);
        for (const FwVolumetricFireId fire : part.fires)
            fwWorld_MoveVolumetricFire(burn_->world, fire, place.data());
    }
    stale_ = true;
}

void LiveScene::resize(uint32_t width, uint32_t height) {
    const VkExtent2D before = target.extent();
    target.resize(width, height);
    stale_ |= before.width != target.extent().width || before.height != target.extent().height;
}

void LiveScene::seek(double time, bool held) {
    wanted_ = std::max(0.0, time);
    previewed_ = false;
    if (!burn_) return;
    if (held && rest_.burn && !isComparing() && memory_.isKnown(wanted_)) {
        (isPreviewing() ? overlayStale_ : stale_) = true;
        preview_ = wanted_;
        previewed_ = true;
        preview();
        return;
    }
    stale_ = true;
    // Without a preview, the last picture stays until the release.
    if (held && wanted_ + 1e-4 < burn_->time) {
        wanted_ = 0;
        return;
    }
    if (wanted_ + 1e-4 < burn_->time && !goBack()) restart_ = true;
}

// Restores the last snapshot before the target time.
bool LiveScene::goBack() { return memory_.restore(*burn_, wanted_); }

void LiveScene::preview() {
    for (const fwedit::BurnMesh& mesh : burn_->meshes) {
        const auto surface = surfaceOf(mesh.id);
        if (!surface || !memory_.agesAt(*burn_, mesh.id, *surface, preview_, values_)) continue;
        burnt_.color(mesh.id, surface, values_, burntPalette(),
                     {0, 0, surface->width, surface->height});
    }
}

void LiveScene::colorBurnTimes(std::span<const fwui::MapStop> map) {
    overlaid.clear();
    if (!burn_) return;
    const Palette palette = rampPalette(map, kOverlayOpacity);
    for (const fwedit::BurnMesh& mesh : burn_->meshes) {
        const auto surface = surfaceOf(mesh.id);
        if (!surface || !memory_.timesOf(*burn_, mesh.id, values_)) continue;
        overlay.color(mesh.id, surface, values_, palette, {0, 0, surface->width, surface->height});
        overlaid.push_back(mesh.id);
    }
    stale_ = true;
}

void LiveScene::askWhy(fwedit::ObjectId mesh, glm::vec3 position) {
    why = {};
    why.open = true;
    why.mesh = mesh;
    why.position = position;
    followWhy();
    stale_ = true;
}

void LiveScene::pinWhy() {
    if (!why.open) return;
    if (pins.size() >= kMostPins) pins.erase(pins.begin());
    pins.push_back(std::exchange(why, {}));
    stale_ = true;
}

double LiveScene::caughtAt(WhyCard& card) const {
    const auto surface = surfaceOf(card.mesh);
    const fwedit::Mesh* mesh = burn_ ? fwedit::findIn(burn_->scene.meshes, card.mesh) : nullptr;
    if (!surface || !mesh) return -1;
    if (card.texelOf != surface.get()) {
        const glm::vec3 place(glm::inverse(poseOf(*mesh)) * glm::vec4(card.position, 1));
        card.texel = fwedit::nearestTexel(*surface, {place.x, place.y, place.z});
        card.texelOf = surface.get();
    }
    return memory_.caughtAt(card.mesh, card.texel);
}

std::vector<WhyCard*> LiveScene::cards() {
    std::vector<WhyCard*> all;
    if (why.open) all.push_back(&why);
    for (WhyCard& pin : pins) all.push_back(&pin);
    return all;
}

bool LiveScene::hasOpenQuestion() const {
    return why.asks ||
           std::any_of(pins.begin(), pins.end(), [](const auto& pin) { return pin.asks; });
}

// One query at a time; the open card has priority.
void LiveScene::followWhy() {
    constexpr double kAskAgain = 0.5;  // s of burn time
    if (!burn_ || isPreviewing()) return;
    const std::vector<WhyCard*> all = cards();
    for (WhyCard* card : all)
        if (card->asks) return pollWhy(*card);
    for (WhyCard* card : all) {
        const bool fresh = card->answered && std::fabs(burn_->time - card->time) < kAskAgain;
        if (!card->error.empty() || fresh) continue;
        const glm::vec3& at = card->position;
        card->asks =
            fwedit::beginWhy(*burn_, card->mesh, {at.x, at.y, at.z}, card->question, card->error);
        card->time = burn_->time;
        card->waited = 0;
        if (card->asks) return;
    }
}

void LiveScene::pollWhy(WhyCard& card) {
    ++card.waited;
    // While a query repeats, the old answer stays until the new one is complete.
    fwedit::WhyAnswer& answer = card.answered ? card.next : card.answer;
    const bool knew = card.question.pointKnown;
    const FwResult result = fwedit::pollWhy(*burn_, images_, card.question, answer, card.error);
    if (!card.answered && card.question.pointKnown && !knew) {
        card.answered = result >= 0;
        card.frames = card.waited - 1;
        stale_ = true;  // the card shows with the next frame
    }
    if (result == FW_NOT_READY) return;
    if (&answer == &card.next && result == FW_OK) card.answer = card.next;
    card.asks = false;
    card.answered = result == FW_OK;
    stale_ = true;
}

FwResult LiveScene::recordOutside(fwedit::Burn& burn, const FwVulkanFrame& frame,
                                  const FwView& from) {
    const FwResult result = fwWorld_RecordOutside(burn.world, &frame, &from);
    if (result < 0) report_.push_back(lastMessage(burn.world));
    return result;
}

// The kept picture is current, so only the overlays must be drawn.
bool LiveScene::canRedrawOverlay(bool moved) const {
    return kept_ && overlayStale_ && !stale_ && !moved && isPreviewing() && !isSeeking();
}

void LiveScene::record(const fwui::Frame& frame, const fwedit::Camera& camera, float deltaTime) {
    if (!burn_ || !studio_ || target.extent().width == 0) return;
    if (preview_ >= 0 && !previewed_ && !isSeeking()) {
        preview_ = -1;
        stale_ = true;
    }
    const bool rests = shown == Shown::kRest || isPreviewing();
    if (rests && !rest_.burn) return;
    const bool moved = !(camera == camera_);
    const bool catchesUp = isSeeking();
    const bool compares = showsComparison() && !rests;
    if (deltaTime <= 0 && !moved && !stale_ && !overlayStale_ && !catchesUp &&
        !memory_.isPending() && !hasOpenQuestion() && !(compares && isOtherBehind()))
        return;
    const bool fresh = stale_, redrawsOverlay = canRedrawOverlay(moved);
    stale_ = overlayStale_ = false;
    camera_ = camera;

    fwedit::Scene seen;  // viewOf reads only these fields
    seen.settings = scene_.settings;
    if (shown == Shown::kRest) seen.settings.daylight = fwedit::DaylightDay;
    seen.camera = camera;
    std::string error;
    FwVulkanFrame described = fwDefaultVulkanFrame();
    described.commandBuffer = frame.commands;
    described.frameIndex = frame.index;
    described.completedFrameIndex = frame.completed;
    float step = deltaTime;
    if (catchesUp) {
        step = std::min(float(wanted_ - burn_->time), kSeekStep * kSeekSteps);
    } else if (!isPreparing() && !isPreviewing()) {
        wanted_ = 0;
    }
    view = fwedit::viewOf(seen, target.extent().width / (compares ? 2 : 1), target.extent().height,
                          rests ? 0.0 : burn_->time);
    if (step > 0 && !fwedit::feedBurn(*burn_, step, error)) report_.push_back(error);
    described.deltaTime = step;

    FwResult outside = FW_OK;
    memory_.beforeFrame(*burn_, step);
    if (!rests || step > 0 || memory_.isPending() || hasOpenQuestion())
        outside = recordOutside(*burn_, described, view);
    memory_.afterFrame(*burn_);
    if (compares) {
        fwedit::Scene other;  // with its own light
        other.settings = other_->scene.settings;
        other.camera = camera;
        otherView_ =
            fwedit::viewOf(other, target.extent().width / 2, target.extent().height, burn_->time);
        stepOther(described);
    }
    if (restFresh_ && rest_.burn && !rests) {
        FwVulkanFrame still = described;
        still.deltaTime = 0;
        recordOutside(*rest_.burn, still, view);
    }
    const bool warms = restFresh_;
    restFresh_ = false;
    burn_->scene.camera = camera;  // directions in answers are relative to the camera
    followWhy();
    // A preview stays while the burn catches up behind it.
    if (isPreviewing() && catchesUp && !moved && !fresh) return;
    overlay.upload(frame);
    burnt_.upload(frame);
    if (redrawsOverlay) {
        target.restore(frame);
        drawOverlays(frame);
        return;
    }
    fwedit::Burn& drawn = rests ? *rest_.burn : *burn_;
    if (rests) {
        described.deltaTime = 0;
        outside = recordOutside(drawn, described, view);
    }
    std::vector<Half> halves;
    if (compares)
        halves.push_back({*other_, *otherStudio_, otherView_, half(false), otherOutside_ == FW_OK});
    halves.push_back(
        {drawn, *studio_, view, compares ? half(true) : target.viewport(), outside == FW_OK});
    target.begin(frame);
    for (const Half& part : halves) drawSolids(frame, part, described);
    target.beginFlames(frame);
    target.setSampledDepth(described);
    for (const Half& part : halves)
        if (part.ready) recordInside(part, described, flames_);
    target.end(frame);
    kept_ = isPreviewing();
    if (kept_) target.keep(frame);
    if (!rests && !compares)
        film.take(frame, target,
                  float(burn_->time) / std::max(0.1f, burn_->scene.settings.duration));
    drawOverlays(frame);
    if (warms) warmPreview(frame);

    FwPassTime times[64];
    const uint32_t count = std::min(fwDebug_GetPassTimes(drawn.world, times, 64), 64u);
    double sum = 0;
    for (uint32_t i = 0; i < count; ++i) sum += times[i].milliseconds;
    if (count > 0) milliseconds_ = sum;
}

// Draws the burn's surfaces and its surroundings.
void LiveScene::drawSolids(const fwui::Frame& frame, const Half& part,
                           const FwVulkanFrame& described) {
    FwLight lights[8];
    const uint32_t lightCount = fwWorld_GetLights(part.burn.world, lights, 8);
    sample::StageFrame stage;
    stage.commands = frame.commands;
    stage.slot = frame.slot;
    const VkRect2D pixels{{int32_t(part.viewport.x), 0},
                          {uint32_t(part.viewport.width), uint32_t(part.viewport.height)}};
    vkCmdSetViewport(frame.commands, 0, 1, &part.viewport);
    vkCmdSetScissor(frame.commands, 0, 1, &pixels);
    part.studio.draw(stage, frame.commands, part.from, {lights, lightCount});
    if (part.ready) recordInside(part, described, solids_);
}

void LiveScene::recordInside(const Half& part, const FwVulkanFrame& described, FwTargetId id) {
    const FwResult inside =
        fwWorld_RecordInside(part.burn.world, &described, id, &part.from, &part.viewport);
    if (inside < 0) report_.push_back(lastMessage(part.burn.world));
}

void LiveScene::drawOverlays(const fwui::Frame& frame) {
    if (!isPreviewing() && overlaid.empty()) return;
    const glm::mat4 seen = glm::make_mat4(view.projection) * glm::make_mat4(view.view);
    target.beginOver(frame);
    if (showsComparison()) {
        const VkViewport right = half(true);
        vkCmdSetViewport(frame.commands, 0, 1, &right);
    }
    for (const fwedit::BurnMesh& mesh : burn_->meshes) {
        const fwedit::Mesh* object = fwedit::findIn(scene_.meshes, mesh.id);
        if (!object || object->hidden) continue;
        const glm::mat4 clip = seen * poseOf(*object);
        if (isPreviewing()) burnt_.draw(frame, mesh.id, clip, 1);
        if (std::find(overlaid.begin(), overlaid.end(), mesh.id) != overlaid.end())
            overlay.draw(frame, mesh.id, clip, 1);
    }
    target.endOver(frame);
}

// Draws a preview's maps once off screen: a driver may finish a pipeline at its first draw, which
// would delay the first scrub.
void LiveScene::warmPreview(const fwui::Frame& frame) {
    target.beginOver(frame);
    for (const auto& [mesh, surface] : rest_.surfaces) burnt_.draw(frame, mesh, glm::mat4(0), 0);
    target.endOver(frame);
}

std::string LiveScene::stage(float& share) const {
    const std::lock_guard lock(stageMutex_);
    share = share_;
    return stage_;
}

SurfaceHit LiveScene::pick(float x, float y, bool throughLocked) const {
    SurfaceHit nearest;
    if (!burn_) return nearest;
    const Ray ray = rayThrough(view, x, y);
    for (const fwedit::BurnMesh& mesh : burn_->meshes) {
        const fwedit::Mesh* object = fwedit::findIn(scene_.meshes, mesh.id);
        if (!object || object->hidden || (throughLocked && object->locked) || !mesh.model) continue;
        SurfaceHit hit = castRay(*mesh.model, poseOf(*object), ray);
        if (!hit.hit || (nearest.hit && hit.distance >= nearest.distance)) continue;
        nearest = hit;
        nearest.object = mesh.id;
    }
    return nearest;
}

void LiveScene::outlineOf(fwedit::ObjectId id, ImVec2 size, std::vector<glm::vec2>& lines) {
    lines.clear();
    if (!burn_) return;
    const fwedit::Mesh* object = fwedit::findIn(scene_.meshes, id);
    const auto found = std::find_if(burn_->meshes.begin(), burn_->meshes.end(),
                                    [&](const fwedit::BurnMesh& mesh) { return mesh.id == id; });
    if (!object || found == burn_->meshes.end() || !found->model) return;
    const glm::mat4 seen =
        glm::make_mat4(view.projection) * glm::make_mat4(view.view) * poseOf(*object);
    Outline& kept = outlines_[id];
    const glm::vec2 pixels(size.x, size.y);
    if (kept.seen == seen && kept.pixels == pixels && kept.model == found->model.get()) {
        lines = kept.lines;
        return;
    }
    const fwimport::ImportedModel& model = *found->model;
    std::vector<glm::vec3> places(model.vertexCount());
    for (size_t i = 0; i < places.size(); ++i) {
        const glm::vec4 clip = seen * glm::vec4(glm::make_vec3(&model.positions[3 * i]), 1);
        const glm::vec2 share = 0.5f + 0.5f * glm::vec2(clip) / std::max(clip.w, 1e-6f);
        places[i] = glm::vec3(share * pixels, clip.w);
    }
    std::vector<glm::vec2> corners;
    corners.reserve(model.indices.size());
    for (size_t i = 0; i + 2 < model.indices.size(); i += 3) {
        const glm::vec3 &a = places[model.indices[i]], &b = places[model.indices[i + 1]],
                        &c = places[model.indices[i + 2]];
        if (std::min({a.z, b.z, c.z}) <= 1e-6f) continue;
        corners.insert(corners.end(), {glm::vec2(a), glm::vec2(b), glm::vec2(c)});
    }
    findOutline(corners, uint32_t(std::clamp(size.x, 1.0f, 8192.0f)),
                uint32_t(std::clamp(size.y, 1.0f, 8192.0f)), kept.lines);
    kept.seen = seen;
    kept.pixels = pixels;
    kept.model = &model;
    lines = kept.lines;
}

bool LiveScene::bounds(glm::vec3& low, glm::vec3& high) const {
    if (!burn_) return false;
    bool any = false;
    for (const fwedit::BurnMesh& mesh : burn_->meshes) {
        const fwedit::Mesh* object = fwedit::findIn(burn_->scene.meshes, mesh.id);
        if (!object || !mesh.model) continue;
        const glm::mat4 pose = poseOf(*object);
        for (int corner = 0; corner < 8; ++corner) {
            glm::vec3 p;
            for (int c = 0; c < 3; ++c)
                p[c] = (corner >> c & 1) ? mesh.model->high[size_t(c)] : mesh.model->low[size_t(c)];
            p = glm::vec3(pose * glm::vec4(p, 1));
            low = any ? glm::min(low, p) : p;
            high = any ? glm::max(high, p) : p;
            any = true;
        }
    }
    return any;
}

std::vector<std::string> LiveScene::takeReport() {
    std::vector<std::string> taken;
    taken.swap(report_);
    return taken;
}

}  // namespace fwview
