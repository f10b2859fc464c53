#include "app/flame_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <numeric>
#include <utility>

#include "common/camera.h"
#include "core/error.h"
#include "flamewright/flamewright_vulkan.h"
#include "profile_picture.h"
#include "shell/icons.h"
#include "volume/appearance.h"
#include "whole_file.h"

namespace fwapp {

using namespace fwui;
namespace fs = std::filesystem;

namespace {

constexpr float kZeroCelsius = 273.15f;
constexpr float kCoolest = 330, kHottest = 1930;  // degrees Celsius, range of the colour map
constexpr double kRefresh = 0.2;                  // s between pictures while a stroke grows
constexpr float kReach = 1.25f;                   // width of a profile in radii

ProfilePaint paintOf(const fw::volume::Profile& profile) {
    ProfilePaint paint;
    for (size_t i = 0; i < profile.texels.size(); ++i) {
        const glm::vec2 values = glm::unpackHalf2x16(profile.texels[i]);
        paint.kelvin[i] = 1000 * values.x;
        paint.soot[i] = values.y;
    }
    return paint;
}

ProfilePaint presetPaint(uint32_t preset) {
    fw::volume::Profile profile;
    fw::volume::paintDefaultProfile(
        fw::volume::presetDef(fw::volume::FlamePreset(preset)).appearance, profile);
    return paintOf(profile);
}

void profileOf(const ProfilePaint& paint, fw::volume::Profile& profile) {
    fw::volume::paintProfile(paint.kelvin, paint.soot, ProfilePaint::kWidth, ProfilePaint::kHeight,
                             profile);
}

// Soot glows above 1000 K. Below, the temperature encodes how much clean gas burns.
float glowAt(const ProfilePaint& paint, size_t i) {
    return paint.kelvin[i] < 1000 ? paint.kelvin[i] / 1000 : 4 * paint.soot[i];
}

// Exposure that makes a flame with little soot visible in a small picture.
float exposureOf(const ProfilePaint& paint) {
    constexpr float kBright = 0.9f, kMostExposure = 40;
    float most = 0;
    for (size_t i = 0; i < paint.kelvin.size(); ++i) most = std::max(most, glowAt(paint, i));
    return most > 0 ? std::clamp(kBright / most, 1.0f, kMostExposure) : 1.0f;
}

// Colour of a texel on the canvas: its glow.
ImU32 colorAt(const ProfilePaint& paint, ProfilePlane plane, size_t i, float exposure) {
    constexpr ImU32 kEmpty = hex(0x0C0D0F);
    if (plane == ProfilePlane::kSoot)
        return mix(kEmpty, hex(0xE8E4DA),
                   std::sqrt(std::min(1.0f, paint.soot[i] / ProfilePaint::kMostSoot)));
    const float celsius = paint.kelvin[i] - kZeroCelsius;
    const float there = std::clamp(exposure * glowAt(paint, i), 0.0f, 1.0f);
    const ImU32 glow = sampleMap(kHeatMap, (celsius - kCoolest) / (kHottest - kCoolest));
    return mix(kEmpty, glow, there);
}

void fillPixels(const ProfilePaint& paint, ProfilePlane plane, uint8_t* rgba, float exposure = 1) {
    for (int y = 0; y < ProfilePaint::kHeight; ++y) {
        for (int x = 0; x < ProfilePaint::kWidth; ++x) {
            const ImU32 color =
                colorAt(paint, plane, size_t(y * ProfilePaint::kWidth + x), exposure);
            const int row = ProfilePaint::kHeight - 1 - y;
            std::memcpy(rgba + 4 * size_t(row * ProfilePaint::kWidth + x), &color, 4);
        }
    }
}

std::string tidy(const char* name) {
    std::string text = name;
    std::replace(text.begin(), text.end(), '_', ' ');
    if (!text.empty()) text[0] = char(std::toupper(static_cast<unsigned char>(text[0])));
    return text;
}

}  // namespace

// A texture of the interface that changes; uploaded in the frame that shows it.
struct FlameCanvas {
    FlameCanvas(const sample::VulkanHost& hostGiven, fwui::UiRenderer& uiGiven)
        : host(hostGiven), ui(uiGiven) {
        sample::ImageRequest request;
        request.width = ProfilePaint::kWidth;
        request.height = ProfilePaint::kHeight;
        request.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
        image = host.createImage(request);
        for (sample::Buffer& buffer : staging)
            buffer = host.createBuffer(kBytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, true);
        texture = ui.addTexture(image.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
        host.runNow([&](VkCommandBuffer commands) {
            sample::imageBarrier(commands, image.image, VK_IMAGE_LAYOUT_UNDEFINED,
                                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                 VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, 0,
                                 VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
        });
    }
    ~FlameCanvas() {
        ui.removeTexture(texture);
        host.destroy(image);
        for (sample::Buffer& buffer : staging) host.destroy(buffer);
    }
    FlameCanvas(const FlameCanvas&) = delete;
    FlameCanvas& operator=(const FlameCanvas&) = delete;

    void update(const fwui::Frame& frame, const ProfilePaint& paint, ProfilePlane plane) {
        sample::Buffer& buffer = staging[frame.slot];
        fillPixels(paint, plane, static_cast<uint8_t*>(buffer.mapped));
        sample::imageBarrier(frame.commands, image.image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                             VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                             VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT,
                             VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {ProfilePaint::kWidth, ProfilePaint::kHeight, 1};
        vkCmdCopyBufferToImage(frame.commands, buffer.buffer, image.image,
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        sample::imageBarrier(frame.commands, image.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                             VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                             VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                             VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
    }

    static constexpr VkDeviceSize kBytes = 4ull * ProfilePaint::kWidth * ProfilePaint::kHeight;
    const sample::VulkanHost& host;
    fwui::UiRenderer& ui;
    sample::Image image;
    sample::Buffer staging[fwui::Frames::kSlots];
    void* texture = nullptr;
};

FlamePage::FlamePage(const sample::VulkanHost& hostGiven, FwContext* contextGiven,
                     fwui::UiRenderer& uiGiven)
    : host(hostGiven), context(contextGiven), ui(uiGiven) {
    draft.paint = presetPaint(0);
    steps.push_back({"As it was opened", draft});
}

FlamePage::~FlamePage() {
    vkDeviceWaitIdle(host.device);
    for (View& view : views) fwDestroyWorld(view.world);
    for (void* texture : presetTextures) ui.removeTexture(texture);
    for (sample::Image& image : presetImages) host.destroy(image);
    if (targetId.index1 != 0) fwContext_UnregisterTarget(context, targetId);
}

namespace {

// Tints a preset's picture with the preset's own colour, if it has one.
void tintPixels(uint32_t preset, std::vector<uint8_t>& rgba) {
    const fw::volume::FlameAppearance look =
        fw::volume::presetDef(fw::volume::FlamePreset(preset)).appearance;
    const float weight = look.tint[3];
    if (!(weight > 0)) return;
    // Without soot there is little glow to tint.
    const float gain = look.painter == fw::volume::Painter::Burner ? 3.0f : 1.0f;
    float tint[3];  // display-encoded
    for (size_t c = 0; c < 3; ++c)
        tint[c] = gain * std::pow(std::clamp(look.tint[c], 0.0f, 1.0f), 1 / 2.2f);
    for (size_t i = 0; i + 3 < rgba.size(); i += 4) {
        const float bright = float(std::max({rgba[i], rgba[i + 1], rgba[i + 2]}));
        for (size_t c = 0; c < 3; ++c) {
            const float value = float(rgba[i + c]);
            rgba[i + c] = uint8_t(std::min(255.0f, value + weight * (bright * tint[c] - value)));
        }
    }
}

}  // namespace

// Creates worlds, backdrops and targets when the page first opens.
void FlamePage::open() {
    opened = true;
    canvas = std::make_unique<FlameCanvas>(host, ui);
    for (uint32_t i = 0; i < FW_FIRE_PRESET_COUNT; ++i) {
        std::vector<uint8_t> half(FlameCanvas::kBytes), whole(2 * FlameCanvas::kBytes);
        const ProfilePaint standard = presetPaint(i);
        fillPixels(standard, ProfilePlane::kTemperature, half.data(), exposureOf(standard));
        tintPixels(i, half);
        constexpr size_t kWidth = ProfilePaint::kWidth;
        for (size_t y = 0; y < size_t(ProfilePaint::kHeight); ++y) {
            for (size_t x = 0; x < kWidth; ++x) {
                const uint8_t* from = &half[4 * (y * kWidth + x)];
                std::memcpy(&whole[4 * (y * 2 * kWidth + kWidth + x)], from, 4);
                std::memcpy(&whole[4 * (y * 2 * kWidth + kWidth - 1 - x)], from, 4);
            }
        }
        presetImages.push_back(
            host.createTexture(2 * kWidth, ProfilePaint::kHeight, whole.data(), false));
        presetTextures.push_back(
            ui.addTexture(presetImages.back().view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL));
    }
    for (int i = 0; i < 3; ++i) {
        View& view = views[i];
        view.target = std::make_unique<fwview::SceneTarget>(host, ui);
        FwWorldDef def = fwDefaultWorldDef();
        def.volumePixelSize = i == 0 ? 2 : 3;
        def.rayStepCount = 40;
        fwCreateWorld(context, &def, &view.world);
    }
    const FwVulkanTargetDef def = views[0].target->flames();
    fwContext_RegisterTarget(context, &def, &targetId);
    fwContext_Prepare(context);
}

// Recreates the fires with the current profile.
void FlamePage::recreateFires() {
    vkDeviceWaitIdle(host.device);
    const float room = std::max(draft.diameter * 1.2f, 0.02f);
    const bool sameRoom = room == std::exchange(studioSize, room);
    for (int i = 0; i < 3; ++i) {
        View& view = views[i];
        if (!view.world) continue;
        const FlameDraft& shown = compares && i == 1 ? other : draft;
        fw::volume::Profile profile;
        profileOf(shown.paint, profile);
        const auto cooked = fw::volume::cookProfile(profile, std::pmr::get_default_resource());
        if (view.fire.index1 != 0) fwWorld_DestroyVolumetricFire(view.world, view.fire);
        if (view.profile.index1 != 0) fwWorld_DestroyFireProfile(view.world, view.profile);
        view.fire = {};
        view.profile = {};
        FwFireProfileDef profileDef = fwDefaultFireProfileDef();
        profileDef.cooked = cooked.data();
        profileDef.cookedSize = cooked.size();
        fwWorld_CreateFireProfile(view.world, &profileDef, &view.profile);
        FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
        fwInitFirePreset(&def, shown.preset);
        def.profile = view.profile;
        def.diameter = shown.diameter;
        def.power = shown.power;
        def.turbulence = shown.turbulence;
        def.speed = shown.speed;
        def.seed = 1;
        def.position[1] = 0.01f;
        if (shown.ownColors) {
            std::copy(shown.edge.begin(), shown.edge.end(), def.tint);
            std::copy(shown.core.begin(), shown.core.end(), def.coreTint);
            def.tintWeight = def.coreTintWeight = 1;
        }
        fwWorld_CreateVolumetricFire(view.world, &def, &view.fire);
        const float blown[3] = {i == 2 ? wind : 0, 0, 0};
        fwWorld_SetWind(view.world, blown);
        if (!sameRoom) view.studio.reset();
    }
    changed = false;
    relitAt = time;
}

// Sizes the backdrop so that the camera is inside it.
void FlamePage::sizeBackdrop(View& view, float distance) {
    constexpr float kInside = 6;  // maximum camera distance from its centre, in backdrop sizes
    if (view.studio && view.studioSize * kInside >= distance) return;
    vkDeviceWaitIdle(host.device);
    view.studioSize = std::max(studioSize, 1.2f * distance / kInside);
    view.studio =
        std::make_unique<sample::Studio>(host, view.target->pass(), glm::vec3(0), view.studioSize);
}

float FlamePage::height() const {
    FwVolumetricFireState state{};
    state.structSize = sizeof state;
    if (views[0].world && views[0].fire.index1 != 0 &&
        fwWorld_GetVolumetricFireState(views[0].world, views[0].fire, &state) == FW_OK &&
        state.height > 0)
        return state.height;
    return 2 * draft.diameter;
}

bool FlamePage::isLively() const { return !paused || changed || drawnRevision != pictureRevision; }

void FlamePage::record(const fwui::Frame& frame, float deltaTime) {
    if (!opened) return;
    if (drawnRevision != pictureRevision) {
        canvas->update(frame, draft.paint, plane);
        drawnRevision = pictureRevision;
    }
    time += double(deltaTime);
    if (changed && (!stroking || time - relitAt > kRefresh)) recreateFires();
    const float tall = height();
    ++frameCount;
    for (int i = 0; i < 3; ++i) {
        View& view = views[i];
        if (!view.world || view.rect.width() < 8) continue;
        // Round-robin updates: on a slow device all three views, otherwise the two small ones.
        const uint64_t turns = slow ? 3 : i == 0 ? 1 : 2;
        // An empty picture is drawn at once.
        const bool due = !view.seen || (frameCount + uint64_t(i)) % turns == 0;
        view.owed += deltaTime;
        if (!due || (paused && view.drawn == pictureRevision && view.seen)) continue;
        FwView camera = fwDefaultView();
        sample::duskLight(camera, i == 0 || compares ? 0.012f : i == 1 ? 2.0f : 0.1f);
        sample::OrbitCamera orbit;
        orbit.target = {i == 2 ? 0.25f * tall : 0.0f, 0.55f * tall, 0};
        orbit.yaw = 0.3f;
        orbit.pitch = 0.12f;
        orbit.fieldOfView = 0.5f;
        const VkExtent2D extent = view.target->extent();
        const float aspect = float(extent.width) / float(extent.height);
        const float wide = std::max(1.5f * tall, 1.7f * draft.diameter / std::max(0.2f, aspect));
        orbit.distance = 0.5f * wide / std::tan(0.5f * orbit.fieldOfView);
        sizeBackdrop(view, orbit.distance);
        sample::StageFrame stage;
        stage.commands = frame.commands;
        stage.slot = frame.slot;
        stage.extent = extent;
        stage.time = time;
        sample::setCamera(camera, orbit.camera(), stage);
        FwVulkanFrame described = fwDefaultVulkanFrame();
        described.commandBuffer = frame.commands;
        described.frameIndex = frame.index;
        described.completedFrameIndex = frame.completed;
        described.deltaTime = paused ? 0 : std::min(view.owed, 0.25f);
        view.owed = 0;
        FwLight lights[4];
        const uint32_t count = fwWorld_GetLights(view.world, lights, 4);
        const FwResult outside = fwWorld_RecordOutside(view.world, &described, &camera);
        view.target->begin(frame);
        view.studio->draw(stage, frame.commands, camera, {lights, count});
        view.target->beginFlames(frame);
        view.target->setSampledDepth(described);
        const VkViewport all = view.target->viewport();
        if (outside == FW_OK) fwWorld_RecordInside(view.world, &described, targetId, &camera, &all);
        view.target->end(frame);
        view.drawn = pictureRevision;
        view.seen = true;
    }
}

void FlamePage::recordStep(const char* name) {
    if (steps[at].draft == draft) return;
    steps.resize(at + 1);
    steps.push_back({name, draft});
    ++at;
    changed = true;
    ++pictureRevision;
}

void FlamePage::undo() {
    if (at == 0) return;
    draft = steps[--at].draft;
    chosen = {};
    changed = true;
    ++pictureRevision;
}

void FlamePage::redo() {
    if (at + 1 >= steps.size()) return;
    draft = steps[++at].draft;
    chosen = {};
    changed = true;
    ++pictureRevision;
}

void FlamePage::usePreset(uint32_t which) {
    draft.preset = which;
    draft.paint = presetPaint(which);
    draft.curves = draft.ownColors = false;
    FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
    fwInitFirePreset(&def, which);
    draft.diameter = def.diameter;
    draft.power = def.power;
    changed = true;
    recordStep("Start from a preset");
    ++pictureRevision;
}

void FlamePage::curveChanged() {
    const std::vector<float> texels = fwedit::texelsOfCurve(draft.curve);
    static_assert(fwedit::kShapeWidth == uint32_t(ProfilePaint::kWidth) &&
                  fwedit::kShapeHeight == uint32_t(ProfilePaint::kHeight));
    for (size_t i = 0; i < draft.paint.kelvin.size(); ++i) {
        draft.paint.kelvin[i] = texels[2 * i];
        draft.paint.soot[i] = texels[2 * i + 1];
    }
    changed = true;
    ++pictureRevision;
}

void FlamePage::useCurves(bool curves) {
    if (draft.curves == curves) return;
    draft.curves = curves;
    chosen = {};
    if (curves) curveChanged();  // the painted version stays one undo step back
    recordStep(curves ? "Shape the flame by points" : "Paint the flame by hand");
}

bool FlamePage::loadFromScene(App& app, fwedit::ObjectId id) {
    const fwedit::Flame* flame = fwedit::findIn(app.document.scene.flames, id);
    if (!flame) return false;
    if (fwedit::hasShape(*flame) && !fwedit::hasCurve(*flame)) {
        if (!import(app, fwedit::baseFolder(app.document) / flame->profile)) return false;
    } else if (!fwedit::hasCurve(*flame)) {
        draft.paint = presetPaint(flame->preset);
    }
    draft.preset = flame->preset;
    draft.diameter = flame->diameter;
    draft.power = flame->power;
    draft.turbulence = flame->turbulence;
    draft.speed = flame->speed;
    draft.ownColors = flame->tintWeight > 0;
    if (draft.ownColors) {
        const float paler =
            fw::volume::FlameAppearance{}.tintWhite;  // a core without its own colour
        for (size_t i = 0; i < 3; ++i) {
            draft.edge[i] = flame->tint[i];
            draft.core[i] = std::lerp(std::lerp(flame->tint[i], 1.0f, paler), flame->coreTint[i],
                                      flame->coreTintWeight);
        }
    }
    draft.curves = fwedit::hasCurve(*flame);
    if (draft.curves) {
        draft.curve = fwedit::curveOf(*flame);
        curveChanged();
    }
    recordStep("Take a flame from the scene");
    setStatus(app, "Took " + flame->name + " from the scene");
    return true;
}

namespace {

std::vector<double> numbersOf(const fwedit::Keys& keys) {
    std::vector<double> numbers;
    for (const fwedit::Key& key : keys)
        numbers.insert(numbers.end(), {double(key.time), double(key.value)});
    return numbers;
}

}  // namespace

// Changes the scene in one step. `profile`: file of the painted profile; empty: made by points.
void FlamePage::applyToScene(App& app, fwedit::ObjectId id, const std::string& profile) {
    const bool byPoints = profile.empty();
    std::vector<fwedit::Assignment> fields = {
        {"profile", profile},
        {"outline", byPoints ? numbersOf(draft.curve.outline) : std::vector<double>()},
        {"stops", byPoints ? numbersOf(draft.curve.stops) : std::vector<double>()},
        {"preset", double(draft.preset)},
        {"diameter", double(draft.diameter)},
        {"power", double(draft.power)},
        {"turbulence", double(draft.turbulence)},
        {"speed", double(draft.speed)},
        {"tint_weight", draft.ownColors ? 1.0 : 0.0},
        {"core_tint_weight", draft.ownColors ? 1.0 : 0.0}};
    if (draft.ownColors) {
        fields.push_back({"tint", std::vector<double>(draft.edge.begin(), draft.edge.end())});
        fields.push_back({"core_tint", std::vector<double>(draft.core.begin(), draft.core.end())});
    }
    if (id == 0) {
        addObject(app, fwedit::Kind::Flame, std::move(fields));
        return;
    }
    fwedit::Command command;
    command.verb = fwedit::Verb::Set;
    command.kind = fwedit::Kind::Flame;
    command.targets = {id};
    command.fields = std::move(fields);
    perform(app, command);
}

void FlamePage::compare(bool on) {
    if (on && !hasOther) {
        other = draft;
        hasOther = true;
    }
    compares = on;
    changed = true;
}

void FlamePage::swapWithOther() {
    if (!hasOther) return;
    std::swap(draft, other);
    chosen = {};
    recordStep("Swap A and B");
    changed = true;
    ++pictureRevision;
}

bool FlamePage::import(App& app, const fs::path& file) {
    fw::volume::Profile profile;
    std::string error;
    if (file.extension() == ".fwprofile") {
        std::vector<std::byte> bytes;
        error = fwtools::readWhole(file.string(), bytes);
        if (error.empty()) {
            try {
                fw::volume::readProfile(bytes, profile);
            } catch (const fw::core::Error& failure) {
                error = failure.message;
            }
        }
    } else {
        fwimport::FloatPicture picture;
        if (fwimport::readPicture(file, picture, error))
            fwtools::profileOfPicture(picture, profile, error);
    }
    if (!error.empty()) {
        toast(app, Toast::Kind::kError, file.filename().string() + " was not imported", error);
        return false;
    }
    draft.paint = paintOf(profile);
    draft.curves = false;
    recordStep("Import a flame shape");
    changed = true;
    ++pictureRevision;
    setStatus(app, "Imported " + file.filename().string());
    return true;
}

bool FlamePage::exportTo(App& app, const fs::path& file) {
    fw::volume::Profile profile;
    profileOf(draft.paint, profile);
    std::string error;
    if (file.extension() == ".fwprofile") {
        const auto cooked = fw::volume::cookProfile(profile, std::pmr::get_default_resource());
        error = fwtools::replaceFile(file.string(), cooked);
    } else {
        const bool whole = file.extension() != ".exr";
        fwimport::writePicture(file, fwtools::pictureOfProfile(profile, whole), error);
    }
    if (!error.empty()) {
        toast(app, Toast::Kind::kError, file.filename().string() + " was not written", error);
        return false;
    }
    setStatus(app, "Wrote " + file.filename().string());
    return true;
}

void addFlameActions(App& app, std::vector<Action>& list) {
    App* at = &app;
    const int page = int(Page::kFlame);
    auto pick = [at](ProfileTool tool) { return [at, tool] { at->flame->tool = tool; }; };
    auto resize = [at](float by) {
        return [at, by] { at->flame->size = std::clamp(at->flame->size * by, 1.0f, 100.0f); };
    };
    auto strengthen = [at](float by) {
        return
            [at, by] { at->flame->strength = std::clamp(at->flame->strength + by, 0.0f, 100.0f); };
    };
    // Returns the selected flame of the scene, otherwise the first; 0: none.
    auto target = [at] {
        fwedit::ObjectId id = 0;
        for (const fwedit::Flame& flame : at->document.scene.flames)
            if (id == 0 || isSelected(*at, flame.id)) id = flame.id;
        return id;
    };
    auto write = [at](const char* title, const char* act, const char* name,
                      std::vector<std::string> endings) {
        FileDialog dialog;
        dialog.saves = true;
        dialog.title = title;
        dialog.act = act;
        dialog.name = name;
        dialog.endings = std::move(endings);
        dialog.done = [at, name](fs::path file) {
            if (!file.has_extension()) file += fs::path(name).extension();
            at->flame->exportTo(*at, file);
        };
        askFile(*at, dialog);
    };
    list.insert(
        list.end(),
        {{"Paint", "Flame", "B", icons::brush, pick(ProfileTool::kPaint), {}, page},
         {"Erase", "Flame", "X", icons::erase, pick(ProfileTool::kErase), {}, page},
         {"Smooth", "Flame", "S", icons::smooth, pick(ProfileTool::kSmooth), {}, page},
         {"Smear", "Flame", "F", icons::smear, pick(ProfileTool::kSmear), {}, page},
         {"Gradient", "Flame", "G", icons::gradient, pick(ProfileTool::kGradient), {}, page},
         {"Pick a value", "Flame", "I", icons::pick, pick(ProfileTool::kPick), {}, page},
         {"Larger brush", "Flame", "]", nullptr, resize(1.2f), {}, page},
         {"Smaller brush", "Flame", "[", nullptr, resize(1 / 1.2f), {}, page},
         {"Stronger brush", "Flame", "Shift+]", nullptr, strengthen(10), {}, page},
         {"Weaker brush", "Flame", "Shift+[", nullptr, strengthen(-10), {}, page},
         {"Pause the preview",
          "Flame",
          "Space",
          icons::pause,
          [at] { at->flame->paused = !at->flame->paused; },
          {},
          page},
         {"Import flame shape…",
          "Flame",
          "",
          icons::importFrom,
          [at] {
              FileDialog dialog;
              dialog.title = "Import a flame shape";
              dialog.act = "Import";
              dialog.endings = {".fwprofile", ".png", ".exr", ".tif", ".tiff"};
              dialog.done = [at](const fs::path& file) { at->flame->import(*at, file); };
              askFile(*at, dialog);
          },
          {},
          page},
         {"Save flame shape…",
          "Flame",
          "",
          icons::save,
          [write] { write("Save the flame shape", "Save", "flame.fwprofile", {".fwprofile"}); },
          {},
          page},
         {"Export flame picture…",
          "Flame",
          "",
          icons::exportTo,
          [write] {
              write("Export the flame as a picture", "Export", "flame.png", {".png", ".exr"});
          },
          {},
          page},
         {"Use in the scene…",
          "Flame",
          "",
          icons::firepit,
          [at, target] {
              if (at->flame->draft.curves) {
                  at->flame->applyToScene(*at, target(), "");
                  at->page = Page::kScene;
                  return;
              }
              FileDialog dialog;
              dialog.saves = true;
              dialog.title = "Save the flame shape for the scene";
              dialog.act = "Save";
              dialog.name = "flame.fwprofile";
              dialog.endings = {".fwprofile"};
              dialog.done = [at, target](fs::path file) {
                  if (file.extension() != ".fwprofile") file += ".fwprofile";
                  if (!at->flame->exportTo(*at, file)) return;
                  at->flame->applyToScene(*at, target(), file.string());
                  at->page = Page::kScene;
              };
              askFile(*at, dialog);
          },
          {},
          page},
         {"Take from the scene", "Flame", "", icons::link,
          [at, target] { at->flame->loadFromScene(*at, target()); },
          [at] { return !at->document.scene.flames.empty(); }, page},
         {"By points or by brush",
          "Flame",
          "P",
          icons::curve,
          [at] { at->flame->useCurves(!at->flame->draft.curves); },
          {},
          page},
         {"Compare A and B",
          "Flame",
          "C",
          icons::compare,
          [at] { at->flame->compare(!at->flame->compares); },
          {},
          page},
         {"Keep this as B",
          "Flame",
          "",
          nullptr,
          [at] {
              at->flame->other = at->flame->draft;
              at->flame->hasOther = at->flame->changed = true;
              setStatus(*at, "Kept as B");
          },
          {},
          page},
         {"Swap A and B", "Flame", "", nullptr, [at] { at->flame->swapWithOther(); },
          [at] { return at->flame->hasOther; }, page}});
}

namespace {

void showFlameTools(App& app, const Rect& rect) {
    FlamePage& page = *app.flame;
    beginPanel("##flame tools", rect, colors::header);
    const float y = rect.y0 + dp(5);
    float x = rect.x0 + dp(8);
    int by = page.draft.curves ? 1 : 0;
    if (segments("by", {x, y + dp(2)}, dp(140, 24), {"Brush", "Points"}, by))
        page.useCurves(by == 1);
    tip("Made by the brush or by points", keysOf(app, "By points or by brush"));
    x += dp(148);
    int plane = int(page.plane);
    if (segments("plane", {x, y + dp(2)}, dp(184, 24), {"Temperature", "Soot"}, plane)) {
        page.plane = ProfilePlane(plane);
        ++page.pictureRevision;
    }
    x += dp(192);
    int own = page.draft.ownColors ? 1 : 0;
    if (segments("glow", {x, y + dp(2)}, dp(176, 24), {"Real glow", "Own colours"}, own)) {
        page.draft.ownColors = own == 1;
        page.recordStep(own == 1 ? "Own colours for the flame" : "Real glow for the flame");
    }
    struct Act {
        const char* name;
        ToolLook look;
    };
    std::array<Act, 5> acts = {
        {{"Import flame shape…", {.icon = icons::importFrom, .label = "Import"}},
         {"Save flame shape…", {.icon = icons::save, .label = "Save"}},
         {"Export flame picture…", {.icon = icons::exportTo, .label = "Export"}},
         {"Compare A and B", {.icon = icons::compare, .label = "Compare", .active = page.compares}},
         {"Use in the scene…", {.icon = icons::firepit, .label = "Use in scene"}}}};
    const auto widthOf = [&] {
        return std::accumulate(acts.begin(), acts.end(), dp(4), [](float sum, const Act& act) {
            return sum + toolButtonWidth(act.look) + dp(4);
        });
    };
    // In a narrow window, only the tooltips have labels.
    x += dp(184);
    if (x + widthOf() > rect.x1)
        for (Act& act : acts) act.look.label = nullptr;
    x = rect.x1 - widthOf();
    for (const Act& act : acts) {
        const Action* action = findAction(app, act.name);
        if (toolButton(act.name, {x, y}, act.look, act.name, action->keys.c_str())) action->run();
        x += toolButtonWidth(act.look) + dp(4);
    }
    endPanel();
}

// Values of the selected point or stop.
void showPoint(FlamePage& page, Rows& rows) {
    if (!section(rows, "Chosen point", page.brushOpen)) return;
    fwedit::FlameCurve& curve = page.draft.curve;
    bool touched = false;
    if (page.chosen.point >= 0 && size_t(page.chosen.point) < curve.outline.size()) {
        fwedit::Key& point = curve.outline[size_t(page.chosen.point)];
        const float tall = page.height(), radius = 0.5f * page.draft.diameter;
        float height = point.time * tall, out = point.value * radius;
        rows.label("Height");
        char text[32];
        std::snprintf(text, sizeof text, "%.2f m", double(height));
        drawTextRight(rows.list, fonts().body, rows.x1 - dp(7), rows.midY(), colors::dim, text);
        rows.next();
        touched = numberRow(rows, "Radius", out,
                            {.unit = "m",
                             .format = "%.3f",
                             .lowest = 0,
                             .highest = fwedit::kShapeReach * radius}) != Edit::kNone;
        point.value = out / radius;
    } else if (page.chosen.stop >= 0 && size_t(page.chosen.stop) < curve.stops.size()) {
        fwedit::Key& stop = curve.stops[size_t(page.chosen.stop)];
        touched = numberRow(rows, "Temperature", stop.value,
                            {.unit = "°C",
                             .format = "%.0f",
                             .lowest = 500,
                             .highest = 2200,
                             .snap = 10,
                             .fill = colors::heat}) != Edit::kNone;
    } else {
        rows.y += drawTextWrapped(rows.list, fonts().small, {rows.x0, rows.y}, rows.x1 - rows.x0,
                                  colors::dim,
                                  "Click a point of the outline or a temperature below it.") +
                  dp(4);
    }
    if (touched) page.curveChanged();
    rows.y += dp(4);
}

// Converts to display values.
ImU32 screenColor(const std::array<float, 3>& linear) {
    const auto part = [&](size_t i) {
        return unsigned(std::lround(255 * std::sqrt(std::clamp(linear[i], 0.0f, 1.0f))));
    };
    return IM_COL32(part(0), part(1), part(2), 255);
}

// The flame's own colours, from coolest to hottest. Returns true if one changed.
bool showColors(FlamePage& page, Rows& rows) {
    const ImU32 edge = screenColor(page.draft.edge), core = screenColor(page.draft.core);
    rows.list->AddRectFilledMultiColor({rows.x0, rows.y}, {rows.x1, rows.y + dp(14)}, edge, core,
                                       core, edge);
    rows.y += dp(20);
    int which = page.editsCore ? 1 : 0;
    if (segments("which colour", {rows.x0, rows.y}, {rows.x1 - rows.x0, dp(24)}, {"Edge", "Core"},
                 which))
        page.editsCore = which == 1;
    rows.y += dp(30);
    std::array<float, 3>& color = page.editsCore ? page.draft.core : page.draft.edge;
    constexpr const char* kParts[] = {"Red", "Green", "Blue"};
    bool touched = false;
    for (size_t i = 0; i < 3; ++i) {
        float percent = 100 * color[i];
        if (numberRow(rows, kParts[i], percent,
                      {.unit = "%", .format = "%.0f", .lowest = 0, .highest = 100}) == Edit::kNone)
            continue;
        color[i] = 0.01f * percent;
        touched = true;
    }
    return touched;
}

// Two tools side by side, with labels.
void showBrushTools(App& app, Rows& rows) {
    FlamePage& page = *app.flame;
    struct Item {
        ProfileTool tool;
        const char *icon, *name;  // icon and name of its action
    };
    constexpr Item kTools[] = {{ProfileTool::kPaint, icons::brush, "Paint"},
                               {ProfileTool::kErase, icons::erase, "Erase"},
                               {ProfileTool::kSmooth, icons::smooth, "Smooth"},
                               {ProfileTool::kSmear, icons::smear, "Smear"},
                               {ProfileTool::kGradient, icons::gradient, "Gradient"},
                               {ProfileTool::kPick, icons::pick, "Pick a value"}};
    const float half = std::floor((rows.x1 - rows.x0) * 0.5f);
    for (size_t i = 0; i < std::size(kTools); ++i) {
        const Item& item = kTools[i];
        const ToolLook look{
            .icon = item.icon, .label = item.name, .active = page.tool == item.tool};
        if (toolButton(item.name, {rows.x0 + float(i % 2) * half, rows.y}, look, item.name,
                       keysOf(app, item.name)))
            page.tool = item.tool;
        if (i % 2 == 1) rows.y += dp(32);
    }
    rows.y += dp(4);
}

void showFlameLeft(App& app, const Rect& rect) {
    FlamePage& page = *app.flame;
    ImDrawList* list = beginPanel("##flame left", rect, colors::panel, true);
    Rows rows{list, rect.x0 + dp(10), rect.x1 - dp(10), rect.y0 - ImGui::GetScrollY(), 88};
    bool touched = false;
    if (page.draft.curves) {
        showPoint(page, rows);
    } else if (section(rows, "Brush", page.brushOpen)) {
        showBrushTools(app, rows);
        numberRow(rows, "Size", page.size,
                  {.unit = "cm", .format = "%.0f", .lowest = 1, .highest = 100});
        numberRow(rows, "Strength", page.strength,
                  {.unit = "%", .format = "%.0f", .lowest = 0, .highest = 100});
        numberRow(rows, "Softness", page.softness,
                  {.unit = "%", .format = "%.0f", .lowest = 0, .highest = 100});
        const bool ramps = page.tool == ProfileTool::kGradient;
        const auto valueRow = [&](const char* name, float& celsius, float& soot) {
            if (page.plane == ProfilePlane::kTemperature)
                numberRow(rows, name, celsius,
                          {.unit = "°C",
                           .format = "%.0f",
                           .lowest = 200,
                           .highest = 2200,
                           .snap = 10,
                           .fill = colors::heat});
            else
                numberRow(rows, name, soot, {.format = "%.2f", .lowest = 0, .highest = 2});
        };
        const char* what = page.plane == ProfilePlane::kTemperature ? "Temperature" : "Soot";
        valueRow(ramps ? "From" : what, page.celsius, page.soot);
        if (ramps) valueRow("To", page.celsiusEnd, page.sootEnd);
        rows.y += dp(4);
    }
    if (page.draft.ownColors && section(rows, "Own colours", page.colorOpen))
        touched |= showColors(page, rows);
    if (section(rows, "Size of the flame", page.sizeOpen)) {
        touched |= numberRow(rows, "Width", page.draft.diameter,
                             {.unit = "m", .format = "%.2f", .lowest = 0.01f, .highest = 3}) !=
                   Edit::kNone;
        touched |= numberRow(rows, "Output", page.draft.power,
                             {.unit = "kW",
                              .format = "%.1f",
                              .lowest = 0.05f,
                              .highest = 400,
                              .fill = colors::heat}) != Edit::kNone;
        rows.label("Height");
        char text[32];
        std::snprintf(text, sizeof text, "%.2f m", double(page.height()));
        drawTextRight(list, fonts().body, rows.x1 - dp(7), rows.midY(), colors::dim, text);
        rows.next(4);
    }
    if (section(rows, "Life", page.lifeOpen)) {
        touched |=
            numberRow(rows, "Break-up", page.draft.turbulence,
                      {.unit = "×", .format = "%.2f", .lowest = 0, .highest = 3}) != Edit::kNone;
        touched |=
            numberRow(rows, "Rise", page.draft.speed,
                      {.unit = "×", .format = "%.2f", .lowest = 0, .highest = 4}) != Edit::kNone;
        touched |=
            numberRow(rows, "Wind", page.wind,
                      {.unit = "m/s", .format = "%.1f", .lowest = 0, .highest = 15}) != Edit::kNone;
    }
    if (touched) page.changed = true;
    if (!ImGui::GetIO().MouseDown[0] && !page.gripped && !page.stroking &&
        !ImGui::IsAnyItemActive())
        page.recordStep("Numbers of the flame");
    endPanel();
}

// ---- by points

constexpr float kGrip = 9;       // dp, radius to grab a point
constexpr float kApart = 0.02f;  // minimum distance between two points, relative to their line

// Clamps a point between its neighbours. The ends of an outline stay at foot and tip.
float clampBetween(const fwedit::Keys& keys, size_t i, float wanted, bool endsStay) {
    if (endsStay && (i == 0 || i + 1 == keys.size())) return keys[i].time;
    const float low = i == 0 ? 0 : keys[i - 1].time + kApart;
    const float high = i + 1 == keys.size() ? 1 : keys[i + 1].time - kApart;
    return std::clamp(wanted, std::min(low, high), std::max(low, high));
}

// Inserts a point if there is space. Returns its index, or -1.
int addPoint(fwedit::Keys& keys, fwedit::Key point) {
    size_t i = 0;
    while (i < keys.size() && keys[i].time < point.time) ++i;
    if ((i > 0 && point.time - keys[i - 1].time < kApart) ||
        (i < keys.size() && keys[i].time - point.time < kApart))
        return -1;
    keys.insert(keys.begin() + long(i), point);
    return int(i);
}

bool removePoint(fwedit::Keys& keys, int i, bool endsStay) {
    const bool end = i == 0 || i + 1 == int(keys.size());
    if (i < 0 || keys.size() <= 2 || (endsStay && end)) return false;
    keys.erase(keys.begin() + i);
    return true;
}

struct CanvasPlace {
    ImVec2 low, high;
    float axis;
    Rect stops;  // the temperature bar
    ImVec2 of(const fwedit::Key& point, float side = 1) const {
        return {axis + side * (high.x - axis) * point.value / fwedit::kShapeReach,
                high.y - (high.y - low.y) * point.time};
    }
    fwedit::Key outlineAt(ImVec2 place) const {
        return {std::clamp((high.y - place.y) / (high.y - low.y), 0.0f, 1.0f),
                std::clamp(std::fabs(place.x - axis) / (high.x - axis), 0.0f, 1.0f) *
                    fwedit::kShapeReach};
    }
    float stopX(float at) const { return stops.x0 + stops.width() * at; }
};

void drawPoint(ImDrawList* list, ImVec2 at, bool chosen, bool hot) {
    const float half = dp(hot || chosen ? 5 : 4);
    list->AddRectFilled(at - ImVec2(half + dp(1), half + dp(1)),
                        at + ImVec2(half + dp(1), half + dp(1)), IM_COL32(0, 0, 0, 190));
    list->AddRectFilled(at - ImVec2(half, half), at + ImVec2(half, half),
                        chosen ? colors::accent : colors::white);
}

void drawOutline(ImDrawList* list, const FlamePage& page, const CanvasPlace& place) {
    constexpr int kParts = 96;
    for (const float side : {-1.0f, 1.0f}) {
        std::array<ImVec2, kParts + 1> line;
        for (int i = 0; i <= kParts; ++i) {
            const float height = float(i) / kParts;
            line[size_t(i)] =
                place.of({height, fwedit::radiusAt(page.draft.curve.outline, height)}, side);
        }
        list->AddPolyline(line.data(), int(line.size()), IM_COL32(0, 0, 0, 150), 0, dp(3.5f));
        list->AddPolyline(line.data(), int(line.size()),
                          side > 0 ? colors::white : hex(0xFFFFFF, 110), 0, dp(1.5f));
    }
}

void drawStops(ImDrawList* list, const FlamePage& page, const CanvasPlace& place,
               const FlamePage::Grip& hot) {
    const Rect& bar = place.stops;
    constexpr int kParts = 64;
    const fwedit::Keys& stops = page.draft.curve.stops;
    const auto colorOf = [&](float celsius) {
        return sampleMap(kHeatMap, (celsius - kCoolest) / (kHottest - kCoolest));
    };
    for (int i = 0; i < kParts; ++i) {
        const float a = float(i) / kParts, b = float(i + 1) / kParts;
        const ImU32 left = colorOf(fwedit::valueAt(stops, a));
        const ImU32 right = colorOf(fwedit::valueAt(stops, b));
        list->AddRectFilledMultiColor({place.stopX(a), bar.y0}, {place.stopX(b), bar.y1}, left,
                                      right, right, left);
    }
    const float beside = (bar.y0 + bar.y1) * 0.5f;
    drawTextRight(list, fonts().small, bar.x0 - dp(14), beside, colors::text, "Edge, °C");
    drawText(list, fonts().small, bar.x1 + dp(14), beside, colors::text, "Core");
    for (size_t i = 0; i < stops.size(); ++i) {
        const float x = place.stopX(stops[i].time);
        const bool chosen = page.chosen.stop == int(i);
        const ImU32 rim = chosen               ? colors::accent
                          : hot.stop == int(i) ? colors::white
                                               : colors::dim;
        list->AddTriangleFilled({x, bar.y1 - dp(1)}, {x - dp(7), bar.y1 + dp(7)},
                                {x + dp(7), bar.y1 + dp(7)}, rim);
        list->AddRectFilled({x - dp(7), bar.y1 + dp(7)}, {x + dp(7), bar.y1 + dp(17)}, rim);
        list->AddRectFilled({x - dp(5), bar.y1 + dp(7)}, {x + dp(5), bar.y1 + dp(15)},
                            colorOf(stops[i].value));
        char text[16];
        std::snprintf(text, sizeof text, "%.0f", double(stops[i].value));
        drawTextCentred(list, fonts().small, x, bar.y1 + dp(26),
                        chosen ? colors::title : colors::dim, text);
    }
}

FlamePage::Grip under(const FlamePage& page, const CanvasPlace& place, ImVec2 mouse) {
    FlamePage::Grip found;
    float nearest = dp(kGrip);
    const auto consider = [&](ImVec2 at, int point, int stop) {
        const float away = std::hypot(at.x - mouse.x, at.y - mouse.y);
        if (away >= nearest) return;
        nearest = away;
        found = {point, stop};
    };
    const fwedit::FlameCurve& curve = page.draft.curve;
    for (size_t i = 0; i < curve.outline.size(); ++i) {
        consider(place.of(curve.outline[i]), int(i), -1);
        consider(place.of(curve.outline[i], -1), int(i), -1);
    }
    for (size_t i = 0; i < curve.stops.size(); ++i)
        consider({place.stopX(curve.stops[i].time), place.stops.y1 + dp(9)}, -1, int(i));
    return found;
}

// Points over the picture and stops below it. Drag moves, double click adds, right click or Del
// removes.
void editCurve(App& app, ImDrawList* list, const CanvasPlace& place) {
    FlamePage& page = *app.flame;
    fwedit::FlameCurve& curve = page.draft.curve;
    const ImGuiIO& io = ImGui::GetIO();
    bool overCanvas = false, overStops = false, heldCanvas = false, heldStops = false;
    hit("points", place.low - dp(6, 6), place.high - place.low + dp(12, 12), &overCanvas,
        &heldCanvas);
    hit("stops", {place.stops.x0 - dp(8), place.stops.y0},
        {place.stops.width() + dp(16), place.stops.height() + dp(34)}, &overStops, &heldStops);
    const bool over = overCanvas || overStops;
    const FlamePage::Grip hot = over ? under(page, place, io.MousePos) : FlamePage::Grip{};
    if (over && ImGui::IsMouseDoubleClicked(0) && hot == FlamePage::Grip{}) {
        if (overCanvas) page.chosen = {addPoint(curve.outline, place.outlineAt(io.MousePos)), -1};
        if (overStops) {
            const float at =
                std::clamp((io.MousePos.x - place.stops.x0) / place.stops.width(), 0.0f, 1.0f);
            page.chosen = {-1, addPoint(curve.stops, {at, fwedit::valueAt(curve.stops, at)})};
        }
        page.curveChanged();
        page.recordStep(overCanvas ? "Add a point to the outline" : "Add a temperature");
    } else if (over && ImGui::IsMouseClicked(0)) {
        page.chosen = hot;
        page.gripped = !(hot == FlamePage::Grip{});
    }
    const bool erases = (over && ImGui::IsMouseClicked(1)) ||
                        (ImGui::IsKeyPressed(261, false) && !io.WantTextInput);
    if (erases) {
        const FlamePage::Grip which = io.MouseClicked[1] ? hot : page.chosen;
        if (removePoint(curve.outline, which.point, true) ||
            removePoint(curve.stops, which.stop, false)) {
            page.chosen = {};
            page.curveChanged();
            page.recordStep("Take a point away");
        }
    }
    if (page.gripped && (heldCanvas || heldStops)) {
        const fwedit::FlameCurve before = curve;
        if (page.chosen.point >= 0) {
            const auto i = size_t(page.chosen.point);
            const fwedit::Key wanted = place.outlineAt(io.MousePos);
            curve.outline[i] = {clampBetween(curve.outline, i, wanted.time, true),
                                std::max(0.01f, wanted.value)};
        } else if (page.chosen.stop >= 0) {
            const auto i = size_t(page.chosen.stop);
            curve.stops[i].time = clampBetween(
                curve.stops, i, (io.MousePos.x - place.stops.x0) / place.stops.width(), false);
        }
        if (!(before == curve)) {
            page.curveChanged();
            page.stroking = true;  // update the preview occasionally
        }
    } else if (page.gripped) {
        page.gripped = page.stroking = false;
        page.recordStep(page.chosen.point >= 0 ? "Outline point of the flame"
                                               : "Temperature of the flame");
        setStatus(app, page.steps[page.at].name);
    }
    if (overStops && hot.stop >= 0 && io.MouseWheel != 0) {
        float& celsius = curve.stops[size_t(hot.stop)].value;
        celsius = std::clamp(celsius + 10 * io.MouseWheel, 500.0f, 2200.0f);
        page.chosen = hot;
        page.curveChanged();
    }
    drawOutline(list, page, place);
    for (size_t i = 0; i < curve.outline.size(); ++i)
        drawPoint(list, place.of(curve.outline[i]), page.chosen.point == int(i),
                  hot.point == int(i));
    drawStops(list, page, place, hot);
}

// Places dabs from the previous position to the current one, a third of a radius apart.
void paintAlong(FlamePage& page, fwedit::Dab dab, float fromX, float fromY) {
    const float toX = dab.x, toY = dab.y;
    const float length = std::hypot((toX - fromX) / dab.radiusX, (toY - fromY) / dab.radiusY);
    const int count = std::clamp(int(length * 3), 1, 200);
    dab.alongX = (toX - fromX) / float(count);
    dab.alongY = (toY - fromY) / float(count);
    for (int i = 1; i <= count; ++i) {
        dab.x = fromX + (toX - fromX) * float(i) / float(count);
        dab.y = fromY + (toY - fromY) * float(i) / float(count);
        paintDab(page.draft.paint, dab);
    }
    page.lastX = toX;
    page.lastY = toY;
    page.changed = true;
    ++page.pictureRevision;
}

void showCanvas(App& app, const Rect& rect) {
    FlamePage& page = *app.flame;
    ImDrawList* list = beginPanel("##canvas", rect, colors::gap);
    const float top = rect.y0 + dp(18), bottom = rect.y1 - dp(page.draft.curves ? 88 : 78);
    const float height = bottom - top;
    const float width = std::min(height * 0.82f, rect.width() - dp(110));
    const ImVec2 low(std::floor(rect.midX() - width * 0.5f + dp(12)), top);
    const ImVec2 high(low.x + std::floor(width), bottom);
    const float axis = (low.x + high.x) * 0.5f;
    if (page.canvas) {
        list->AddImage(page.canvas->texture, {axis, low.y}, high);
        list->AddImage(page.canvas->texture, low, {axis, high.y}, {1, 0}, {0, 1});
    }
    const float metres = page.height(), radius = kReach * 0.5f * page.draft.diameter;
    for (int i = 0; i <= 6; ++i) {
        const float y = high.y - (high.y - low.y) * float(i) / 6;
        if (i > 0 && i < 6) drawRow(list, low.x, high.x, y, hex(0xFFFFFF, 14));
        char text[16];
        std::snprintf(text, sizeof text, metres < 0.5f ? "%.2f" : "%.1f",
                      double(metres * float(i) / 6));
        drawTextRight(list, fonts().small, low.x - dp(8),
                      y + dp(i == 6   ? 5
                             : i == 0 ? -5
                                      : 0),
                      colors::dim, text);
    }
    drawTextRight(list, fonts().small, low.x - dp(8), low.y - dp(10), colors::text, "Height, m");
    drawColumn(list, axis, low.y, high.y, hex(0xFFFFFF, 26));
    list->AddRect(low, high, colors::edge, 0, 0, hairline());
    for (int i = -2; i <= 2; ++i) {
        char text[16];
        std::snprintf(text, sizeof text, radius < 0.5f ? "%.2f" : "%.1f",
                      double(radius * float(std::abs(i)) / 2));
        drawTextCentred(list, fonts().small, axis + width * 0.25f * float(i), high.y + dp(11),
                        colors::dim, i == 0 ? "0" : text);
    }
    drawTextCentred(list, fonts().small, axis, high.y + dp(27), colors::text,
                    "Distance from the middle, m");

    if (page.draft.curves) {
        const CanvasPlace place{
            low, high, axis, {low.x, rect.y1 - dp(44), high.x, rect.y1 - dp(34)}};
        editCurve(app, list, place);
        endPanel();
        return;
    }
    // The legend of the painted quantity.
    const float mapY = rect.y1 - dp(34), mapX0 = low.x, mapX1 = high.x;
    if (page.plane == ProfilePlane::kTemperature) {
        drawMap(list, {mapX0, mapY}, {mapX1, mapY + dp(10)}, kHeatMap);
        const int every = mapX1 - mapX0 < dp(240) ? 2 : 1;  // avoid overlapping numbers
        for (int i = 0; i <= 4; i += every) {
            const float celsius = kCoolest + (kHottest - kCoolest) * float(i) / 4;
            char text[24];
            std::snprintf(text, sizeof text, i == 4 ? "%.0f °C" : "%.0f", double(celsius));
            const float x = mapX0 + (mapX1 - mapX0) * float(i) / 4;
            if (i == 0) drawText(list, fonts().small, x, mapY + dp(20), colors::dim, text);
            if (i > 0 && i < 4)
                drawTextCentred(list, fonts().small, x, mapY + dp(20), colors::dim, text);
            if (i == 4) drawTextRight(list, fonts().small, x, mapY + dp(20), colors::dim, text);
        }
        const float at = std::clamp((page.celsius - kCoolest) / (kHottest - kCoolest), 0.0f, 1.0f);
        const float x = mapX0 + (mapX1 - mapX0) * at;
        list->AddTriangleFilled({x, mapY}, {x - dp(5), mapY - dp(7)}, {x + dp(5), mapY - dp(7)},
                                colors::white);
    } else {
        list->AddRectFilledMultiColor({mapX0, mapY}, {mapX1, mapY + dp(10)}, hex(0x0C0D0F),
                                      hex(0xE8E4DA), hex(0xE8E4DA), hex(0x0C0D0F));
        drawText(list, fonts().small, mapX0, mapY + dp(20), colors::dim, "No soot");
        drawTextRight(list, fonts().small, mapX1, mapY + dp(20), colors::dim, "Thick");
    }

    bool hovered = false, held = false;
    hit("canvas", low, high - low, &hovered, &held);
    const ImGuiIO& io = ImGui::GetIO();
    const ImVec2 mouse = io.MousePos;
    fwedit::Dab dab;
    dab.plane = page.plane;
    dab.x = (mouse.x - axis) / (0.5f * width) * float(ProfilePaint::kWidth);
    dab.y = (high.y - mouse.y) / height * float(ProfilePaint::kHeight);
    dab.radiusY = 0.5f * page.size * 0.01f / metres * float(ProfilePaint::kHeight);
    dab.radiusX = 0.5f * page.size * 0.01f / radius * float(ProfilePaint::kWidth);
    dab.radiusX = std::max(dab.radiusX, 0.8f);
    dab.radiusY = std::max(dab.radiusY, 0.8f);
    dab.strength = page.strength * 0.01f;
    dab.hardness = 1 - page.softness * 0.01f;
    const bool picks = page.tool == ProfileTool::kPick || io.KeyAlt;
    const bool ramps = page.tool == ProfileTool::kGradient && !picks;
    if (hovered && ImGui::IsMouseClicked(0) && io.KeyShift && page.ended && !picks && !ramps) {
        page.mayLine = true;
        page.pressX = mouse.x;
        page.pressY = mouse.y;
    }
    dab.tool = io.KeyShift && !page.mayLine ? ProfileTool::kSmooth
               : io.KeyCtrl                 ? ProfileTool::kErase
                                            : page.tool;
    dab.value = page.plane == ProfilePlane::kTemperature ? page.celsius + kZeroCelsius : page.soot;
    const bool draws = held || page.stroking;  // includes the release position of a slow frame
    if (hovered && io.MouseWheel != 0)
        page.size = std::clamp(page.size * std::pow(1.12f, io.MouseWheel), 1.0f, 100.0f);
    if (held && picks) {
        const int x = std::clamp(int(std::fabs(dab.x)), 0, ProfilePaint::kWidth - 1);
        const int y = std::clamp(int(dab.y), 0, ProfilePaint::kHeight - 1);
        const size_t i = size_t(y * ProfilePaint::kWidth + x);
        if (page.plane == ProfilePlane::kSoot) page.soot = page.draft.paint.soot[i];
        if (page.plane == ProfilePlane::kTemperature && page.draft.paint.kelvin[i] > 0)
            page.celsius = std::max(200.0f, page.draft.paint.kelvin[i] - kZeroCelsius);
    } else if (draws && ramps) {
        if (!page.stroking) {
            page.underGradient = page.draft.paint;
            page.lastX = dab.x;
            page.lastY = dab.y;
        }
        page.draft.paint = page.underGradient;
        const bool heat = page.plane == ProfilePlane::kTemperature;
        paintGradient(page.draft.paint,
                      {.plane = page.plane,
                       .fromX = page.lastX,
                       .fromY = page.lastY,
                       .toX = dab.x,
                       .toY = dab.y,
                       .fromValue = heat ? page.celsius + kZeroCelsius : page.soot,
                       .toValue = heat ? page.celsiusEnd + kZeroCelsius : page.sootEnd,
                       .strength = page.strength * 0.01f,
                       .aspect = 0.5f * width / float(ProfilePaint::kWidth) /
                                 (height / float(ProfilePaint::kHeight))});
        page.changed = page.stroking = true;
        ++page.pictureRevision;
    } else if (page.mayLine) {
        if (std::hypot(mouse.x - page.pressX, mouse.y - page.pressY) > dp(3)) {
            page.mayLine = false;  // a drag, which smooths
        } else if (!io.MouseDown[0]) {
            paintAlong(page, dab, page.endedX, page.endedY);
            page.stroking = true;
        }
    } else if (draws) {
        // Along the path since the last frame.
        if (!page.stroking || dab.x != page.lastX || dab.y != page.lastY)
            paintAlong(page, dab, page.stroking ? page.lastX : dab.x,
                       page.stroking ? page.lastY : dab.y);
        page.stroking = true;
    }
    if (page.stroking && !io.MouseDown[0]) {
        page.stroking = page.mayLine = false;
        page.ended = !ramps;
        page.endedX = page.lastX;
        page.endedY = page.lastY;
        page.recordStep(page.tool == ProfileTool::kErase      ? "Erase in the flame"
                        : page.tool == ProfileTool::kSmooth   ? "Smooth the flame"
                        : page.tool == ProfileTool::kSmear    ? "Smear the flame"
                        : page.tool == ProfileTool::kGradient ? "Gradient in the flame"
                                                              : "Paint the flame");
        setStatus(app, page.steps[page.at].name);
    }
    if (hovered || held) {
        ImGui::SetMouseCursor(ImGuiMouseCursor_None);
        list->PushClipRect(low, high, true);
        const ImVec2 radii(dab.radiusX / float(ProfilePaint::kWidth) * 0.5f * width,
                           dab.radiusY / float(ProfilePaint::kHeight) * height);
        auto ring = [&](float x, ImU32 color, float thick) {
            ImVec2 points[48];
            for (int i = 0; i < 48; ++i) {
                const float angle = float(i) * 6.2831853f / 48;
                points[i] = {x + radii.x * std::cos(angle), mouse.y + radii.y * std::sin(angle)};
            }
            list->AddPolyline(points, 48, color, ImDrawFlags_Closed, thick);
        };
        if (ramps) {
            const ImVec2 from =
                page.stroking
                    ? ImVec2(axis + page.lastX * 0.5f * width / float(ProfilePaint::kWidth),
                             high.y - page.lastY * height / float(ProfilePaint::kHeight))
                    : mouse;
            list->AddLine(from, mouse, hex(0x000000, 190), dp(3.5f));
            list->AddLine(from, mouse, hex(0xFFFFFF), dp(1.5f));
            for (const ImVec2 end : {from, mouse}) {
                list->AddCircleFilled(end, dp(5), hex(0x000000, 190));
                list->AddCircleFilled(end, dp(4), colors::white);
            }
        } else {
            ring(mouse.x, hex(0x000000, 190), dp(3.5f));
            ring(mouse.x, hex(0xFFFFFF), dp(1.5f));
            ring(2 * axis - mouse.x, hex(0xFFFFFF, 90), dp(1));
        }
        list->PopClipRect();
        char text[24];
        const bool ends = ramps && page.stroking;  // the value at the mouse
        if (page.plane == ProfilePlane::kTemperature) {
            std::snprintf(text, sizeof text, "%.0f °C",
                          double(ends ? page.celsiusEnd : page.celsius));
        } else {
            std::snprintf(text, sizeof text, "Soot %.2f", double(ends ? page.sootEnd : page.soot));
        }
        const char* what = picks                              ? "Pick"
                           : dab.tool == ProfileTool::kErase  ? "Erase"
                           : dab.tool == ProfileTool::kSmooth ? "Smooth"
                           : dab.tool == ProfileTool::kSmear  ? "Smear"
                                                              : text;
        const float above = ramps ? dp(8) : radii.y;
        drawChip(list, {mouse.x, std::max(rect.y0 + dp(12), mouse.y - above - dp(16))}, what);
    }
    endPanel();
}

void showView(FlamePage& page, ImDrawList* list, int i, const Rect& rect, const char* name,
              const char* sign) {
    FlamePage::View& view = page.views[i];
    view.rect = rect;
    if (view.target) {
        const float share = page.slow ? 0.5f : 1.0f;
        const VkExtent2D before = view.target->extent();
        view.target->resize(uint32_t(std::max(8.0f, rect.width() * share)),
                            uint32_t(std::max(8.0f, rect.height() * share)));
        const VkExtent2D now = view.target->extent();
        if (before.width != now.width || before.height != now.height) view.seen = false;
        if (view.world) list->AddImage(view.target->texture(), rect.low(), rect.high());
    }
    const ImVec2 low = rect.low() + dp(8, 8);
    const float most = rect.width() - dp(16);
    std::string words = name;  // in little space, omit the value
    if (textSize(fonts().body, name).x + dp(36) > most)
        words.resize(std::min(words.find(','), words.size()));
    const float width = std::min(textSize(fonts().body, words.c_str()).x + dp(36), most);
    drawBox(list, low, low + ImVec2(width, dp(24)), hex(0x151618, 215));
    drawIcon(list, fonts().icon17, low + dp(14, 12), colors::text, sign);
    drawTextFit(list, fonts().body, low.x + dp(28), low.y + dp(12), width - dp(32), colors::text,
                words.c_str());
}

// The draft and the saved variant, with equal light and size.
void showSides(FlamePage& page, ImDrawList* list, std::array<Rect, 2> rects) {
    showView(page, list, 0, rects[0], "A, now", icons::moon);
    showView(page, list, 1, rects[1], "B, kept", icons::moon);
    page.views[2].rect = {};
}

void showPreview(App& app, Rect rect) {
    FlamePage& page = *app.flame;
    ImDrawList* list = beginPanel("##preview", rect, colors::gap);
    const Rect head = rect.cutTop(dp(30));
    list->AddRectFilled(head.low(), head.high(), colors::header);
    drawText(list, fonts().semi, head.x0 + dp(10), head.midY(), colors::title, "Live preview");
    if (iconButton("pause", {head.x1 - dp(16), head.midY()},
                   page.paused ? icons::play : icons::pause, colors::text,
                   page.paused ? "Go on" : "Freeze"))
        page.paused = !page.paused;
    rect.y0 += dp(2);
    const float gap = dp(2);
    const bool tall = !page.compares && rect.height() > 2 * rect.width();  // stacked vertically
    const Rect night =
        tall ? rect.cutTop(std::floor(rect.height() * 0.6f) - dp(1))
             : rect.cutLeft(std::floor(rect.width() * (page.compares ? 0.5f : 0.6f)) - dp(1));
    tall ? rect.cutTop(gap) : rect.cutLeft(gap);
    if (page.compares) {
        showSides(page, list, {night, rect});
        endPanel();
        return;
    }
    const Rect day = tall ? rect.cutLeft(std::floor(rect.width() * 0.5f) - dp(1))
                          : rect.cutTop(std::floor(rect.height() * 0.5f));
    tall ? rect.cutLeft(gap) : rect.cutTop(gap);
    const Rect windy = rect;
    const Rect rects[3] = {night, day, windy};
    char blown[32];
    std::snprintf(blown, sizeof blown, "Wind, %.0f m/s", double(page.wind));
    const char* names[3] = {"Night", "Day", blown};
    const char* signs[3] = {icons::moon, icons::sun, icons::wind};
    for (int i = 0; i < 3; ++i) showView(page, list, i, rects[i], names[i], signs[i]);
    endPanel();
}

void showPresets(App& app, const Rect& rect) {
    FlamePage& page = *app.flame;
    ImDrawList* list = beginPanel("##presets", rect);
    const float head =
        drawText(list, fonts().semi, rect.x0 + dp(10), rect.y0 + dp(16), colors::title, "Flames");
    drawText(list, fonts().small, rect.x0 + dp(20) + head, rect.y0 + dp(16), colors::dim,
             "click to start from one");
    const float end = rect.x1 - dp(216);
    drawColumn(list, end, rect.y0 + dp(10), rect.y1 - dp(10), colors::line);
    drawText(list, fonts().semi, end + dp(12), rect.y0 + dp(16), colors::title, "Compare");
    drawTextRight(list, fonts().small, rect.x1 - dp(10), rect.y0 + dp(16), colors::dim,
                  page.hasOther ? "C shows A beside B" : "B is not kept yet");
    const float wide = dp(194);
    if (button("keep", {end + dp(12), rect.y0 + dp(34)}, {wide, dp(28)}, "Keep this as B"))
        findAction(app, "Keep this as B")->run();
    if (page.hasOther &&
        button("swap", {end + dp(12), rect.y0 + dp(68)}, {wide, dp(28)}, "Swap A and B"))
        page.swapWithOther();
    float x = rect.x0 + dp(10);
    const float gap = dp(10);  // all of them fit at any width
    const float card = std::min(dp(84), (end + dp(2) - x) / float(FW_FIRE_PRESET_COUNT) - gap);
    bool twoLines = false;  // names then take two lines
    for (uint32_t i = 0; i < FW_FIRE_PRESET_COUNT; ++i)
        twoLines |= textSize(fonts().small, tidy(fwFirePresetName(i)).c_str()).x > card + dp(6);
    const float tall = dp(twoLines ? 46 : 58);
    const float inset = std::max(dp(1), 0.5f * (card - (tall - dp(2))));
    for (uint32_t i = 0; i < FW_FIRE_PRESET_COUNT; ++i) {
        const ImVec2 low(x, rect.y0 + dp(31)), high = low + ImVec2(card, tall);
        const std::string name = tidy(fwFirePresetName(i));
        ImGui::PushID(int(i));
        bool hovered = false;
        if (hit("preset", low, {card, dp(80)}, &hovered)) page.usePreset(i);
        tip(name.c_str());
        ImGui::PopID();
        const bool here = page.draft.preset == i;
        drawBox(list, low, high, colors::well, 4);
        if (i < page.presetTextures.size())
            list->AddImageRounded(page.presetTextures[i], low + ImVec2(inset, dp(1)),
                                  high - ImVec2(inset, dp(1)), {0, 0}, {1, 1}, colors::white,
                                  dp(3));
        if (here || hovered) drawBox(list, low, high, 0, 4, here ? colors::accent : colors::edge);
        const size_t space = twoLines ? name.find(' ') : std::string::npos;
        float line = high.y + dp(12);
        for (const std::string& words :
             {name.substr(0, space), space == std::string::npos ? "" : name.substr(space + 1)}) {
            const float width = textSize(fonts().small, words.c_str()).x;
            const float spare = std::max(0.0f, card + dp(6) - width);
            drawTextFit(list, fonts().small, low.x - dp(3) + 0.5f * spare, line, card + dp(6),
                        here ? colors::title : colors::dim, words.c_str());
            line += dp(14);
        }
        x += card + gap;
    }
    endPanel();
}

}  // namespace

void showFlame(App& app, Rect rect) {
    if (!app.flame->opened) {
        app.live.awaitPipelines();
        app.flame->open();
    }
    showTopBar(app, rect.cutTop(dp(metrics::topBar)));
    showFlameTools(app, rect.cutTop(dp(metrics::toolBar)));
    const Rect status = rect.cutBottom(dp(metrics::status));
    if (app.flame->draft.curves)
        showStatus(app, status,
                   {{"Drag", "move a point"},
                    {"Double click", "add one"},
                    {"Right click", "take it away"},
                    {"Wheel", "hotter, cooler"}});
    else if (app.flame->tool == fwedit::ProfileTool::kGradient)
        showStatus(app, status, {{"Drag", "from one value to the other"}, {"Alt", "pick"}});
    else
        showStatus(app, status,
                   {{"Drag", "paint"},
                    {"Ctrl", "take away"},
                    {"Shift", "smooth"},
                    {"Shift+click", "line"},
                    {"Alt", "pick"},
                    {"[ ]", "size"}});
    rect.y0 += dp(1);
    Rect presets, left;
    if (app.panels) {
        presets = rect.cutBottom(dp(116));
        rect.cutBottom(dp(2));
        left = rect.cutLeft(dp(236));
        rect.cutLeft(dp(2));
    }
    const Rect preview = rect.cutRight(std::floor(std::min(dp(456), rect.width() * 0.45f)));
    rect.cutRight(dp(2));
    if (app.panels) showFlameLeft(app, left);
    showCanvas(app, rect);
    if (!app.flame->problem.empty()) {
        toast(app, Toast::Kind::kError, "The preview stands still", app.flame->problem);
        app.flame->problem.clear();
    }
    showPreview(app, preview);
    if (app.panels) showPresets(app, presets);
}

}  // namespace fwapp
