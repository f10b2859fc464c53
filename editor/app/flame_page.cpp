// See flame_page.h.
#include "app/flame_page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "common/camera.h"
#include "core/error.h"
#include "flamewright/flamewright_vulkan.h"
#include "profile_picture.h"
#include "shell/icons.h"
#include "volume/look.h"
#include "whole_file.h"

namespace fwapp {

using namespace fwui;
namespace fs = std::filesystem;

namespace {

constexpr float kZeroCelsius = 273.15f, kMostKelvin = 3000, kMostSoot = 2;
constexpr float kCoolest = 330, kHottest = 1930;  // degrees Celsius, ends of the colour map
constexpr double kRefresh = 0.2;                  // s between pictures of a growing stroke
constexpr float kReach = 1.25f;                   // radii that a profile is wide

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
    fw::volume::paintLook(fw::volume::presetDef(fw::volume::FlamePreset(preset)).look, profile);
    return paintOf(profile);
}

void profileOf(const ProfilePaint& paint, fw::volume::Profile& profile) {
    fw::volume::paintProfile(paint.kelvin, paint.soot, ProfilePaint::kWidth, ProfilePaint::kHeight,
                             profile);
}

// Soot glows from 1000 K on; below, the temperature says how much clean gas burns.
float glowAt(const ProfilePaint& paint, size_t i) {
    return paint.kelvin[i] < 1000 ? paint.kelvin[i] / 1000 : 4 * paint.soot[i];
}

// By which a flame with little soot is brought to where it can be seen in a small picture.
float exposureOf(const ProfilePaint& paint) {
    constexpr float kBright = 0.9f, kMostExposure = 40;
    float most = 0;
    for (size_t i = 0; i < paint.kelvin.size(); ++i) most = std::max(most, glowAt(paint, i));
    return most > 0 ? std::clamp(kBright / most, 1.0f, kMostExposure) : 1.0f;
}

// How a texel looks on the canvas: its glow, as much as there is to glow.
ImU32 colorAt(const ProfilePaint& paint, ProfilePlane plane, size_t i, float exposure) {
    constexpr ImU32 kEmpty = hex(0x0C0D0F);
    if (plane == ProfilePlane::kSoot)
        return mix(kEmpty, hex(0xE8E4DA), std::sqrt(std::min(1.0f, paint.soot[i] / kMostSoot)));
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

void paintDab(ProfilePaint& paint, const Dab& dab) {
    auto& plane = dab.plane == ProfilePlane::kSoot ? paint.soot : paint.kelvin;
    const std::vector<float> before =
        dab.tool == ProfileTool::kSmooth ? plane : std::vector<float>();
    const float most = dab.plane == ProfilePlane::kSoot ? kMostSoot : kMostKelvin;
    for (int y = 0; y < ProfilePaint::kHeight; ++y) {
        for (int x = 0; x < ProfilePaint::kWidth; ++x) {
            // The flame is round: what is left of the axis is right of it too.
            const float dy = (float(y) + 0.5f - dab.y) / dab.radiusY;
            const float dx = (float(x) + 0.5f - std::fabs(dab.x)) / dab.radiusX;
            const float away = std::sqrt(dx * dx + dy * dy);
            if (away >= 1) continue;
            const float fall =
                dab.hardness >= 1 ? 1 : std::clamp((1 - away) / (1 - dab.hardness), 0.0f, 1.0f);
            const float share = dab.strength * fall * fall * (3 - 2 * fall);
            const auto texel = size_t(y * ProfilePaint::kWidth + x);
            float& value = plane[texel];
            float wanted = dab.tool == ProfileTool::kErase ? 0 : dab.value;
            if (dab.tool == ProfileTool::kSmooth) {
                float sum = 0, count = 0;
                for (int v = std::max(0, y - 1); v <= std::min(ProfilePaint::kHeight - 1, y + 1);
                     ++v) {
                    for (int u = std::max(0, x - 1); u <= std::min(ProfilePaint::kWidth - 1, x + 1);
                         ++u) {
                        sum += before[size_t(v * ProfilePaint::kWidth + u)];
                        ++count;
                    }
                }
                wanted = sum / count;
            }
            value = std::clamp(value + share * (wanted - value), 0.0f, most);
            // Heat shows by what glows in it: both are painted, and both go.
            if (dab.plane == ProfilePlane::kSoot) continue;
            if (dab.tool == ProfileTool::kPaint)
                paint.soot[texel] = std::max(paint.soot[texel], 0.6f * share);
            if (dab.tool == ProfileTool::kErase) paint.soot[texel] *= 1 - share;
        }
    }
}

// A picture of the interface that changes: copied in the frame that shows it.
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
    paint = presetPaint(0);
    steps.push_back({"As it was opened", paint});
}

FlamePage::~FlamePage() {
    vkDeviceWaitIdle(host.device);
    for (View& view : views) fwDestroyWorld(view.world);
    for (void* texture : presetTextures) ui.removeTexture(texture);
    for (sample::Image& image : presetImages) host.destroy(image);
    if (targetId.index1 != 0) fwContext_UnregisterTarget(context, targetId);
}

// Worlds, backdrops and targets: when the page is first seen.
void FlamePage::open() {
    opened = true;
    canvas = std::make_unique<FlameCanvas>(host, ui);
    for (uint32_t i = 0; i < FW_FIRE_PRESET_COUNT; ++i) {
        std::vector<uint8_t> half(FlameCanvas::kBytes), whole(2 * FlameCanvas::kBytes);
        const ProfilePaint standard = presetPaint(i);
        fillPixels(standard, ProfilePlane::kTemperature, half.data(), exposureOf(standard));
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
        def.volumeCell = i == 0 ? 2 : 3;
        def.volumeSteps = 40;
        fwCreateWorld(context, &def, &view.world);
    }
    FwVulkanTargetDef def = fwDefaultVulkanTargetDef();
    def.renderPass = views[0].target->pass().pass;
    def.colorFormat = views[0].target->pass().colorFormat;
    def.depthFormat = views[0].target->depthFormat();
    def.samples = 1;
    def.colorAttachmentCount = 1;
    def.depthMode = FW_DEPTH_TEST;
    def.encoding = FW_OUTPUT_LINEAR;
    fwContext_RegisterTarget(context, &def, &targetId);
    fwContext_Prepare(context);
}

// The fires anew, of the profile as it is.
void FlamePage::relight() {
    fw::volume::Profile profile;
    profileOf(paint, profile);
    const auto cooked = fw::volume::cookProfile(profile, std::pmr::get_default_resource());
    vkDeviceWaitIdle(host.device);
    for (int i = 0; i < 3; ++i) {
        View& view = views[i];
        if (!view.world) continue;
        if (view.fire.index1 != 0) fwWorld_DestroyVolumetricFire(view.world, view.fire);
        if (view.profile.index1 != 0) fwWorld_DestroyFireProfile(view.world, view.profile);
        view.fire = {};
        view.profile = {};
        FwFireProfileDef profileDef = fwDefaultFireProfileDef();
        profileDef.cooked = cooked.data();
        profileDef.cookedSize = cooked.size();
        fwWorld_CreateFireProfile(view.world, &profileDef, &view.profile);
        FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
        fwInitFirePreset(&def, preset);
        def.profile = view.profile;
        def.diameter = diameter;
        def.power = power;
        def.turbulence = turbulence;
        def.speed = speed;
        def.seed = 1;
        def.position[1] = 0.01f;
        fwWorld_CreateVolumetricFire(view.world, &def, &view.fire);
        const float blown[3] = {i == 2 ? wind : 0, 0, 0};
        fwWorld_SetWind(view.world, blown);
        const float wide = std::max(diameter * 1.2f, 0.02f);
        if (view.studio && wide == studioSize) continue;
        view.studio =
            std::make_unique<sample::Studio>(host, view.target->pass(), glm::vec3(0), wide);
    }
    studioSize = std::max(diameter * 1.2f, 0.02f);
    changed = false;
    relitAt = time;
}

float FlamePage::height() const {
    FwVolumetricFireState state{};
    state.structSize = sizeof state;
    if (views[0].world && views[0].fire.index1 != 0 &&
        fwWorld_GetVolumetricFireState(views[0].world, views[0].fire, &state) == FW_OK &&
        state.height > 0)
        return state.height;
    return 2 * diameter;
}

bool FlamePage::lively() const { return !paused || changed || drawnRevision != pictureRevision; }

void FlamePage::record(const fwui::Frame& frame, float deltaTime) {
    if (!opened) return;
    if (drawnRevision != pictureRevision) {
        canvas->update(frame, paint, plane);
        drawnRevision = pictureRevision;
    }
    time += double(deltaTime);
    if (changed && (!stroking || time - relitAt > kRefresh)) relight();
    const float tall = height();
    ++frameCount;
    for (int i = 0; i < 3; ++i) {
        View& view = views[i];
        if (!view.world || view.rect.width() < 8) continue;
        // They take turns: on a slow device all three, else the two small ones.
        const uint64_t turns = slow ? 3 : i == 0 ? 1 : 2;
        const bool due = (frameCount + uint64_t(i)) % turns == 0;
        view.owed += deltaTime;
        if (!due || (paused && view.drawn == pictureRevision && view.seen)) continue;
        FwView camera = fwDefaultView();
        sample::duskLight(camera, i == 0 ? 0.012f : i == 1 ? 2.0f : 0.1f);
        sample::OrbitCamera orbit;
        orbit.target = {i == 2 ? 0.25f * tall : 0.0f, 0.55f * tall, 0};
        orbit.yaw = 0.3f;
        orbit.pitch = 0.12f;
        orbit.fieldOfView = 0.5f;
        const VkExtent2D extent = view.target->extent();
        const float aspect = float(extent.width) / float(extent.height);
        const float wide = std::max(1.5f * tall, 1.7f * diameter / std::max(0.2f, aspect));
        orbit.distance = 0.5f * wide / std::tan(0.5f * orbit.fieldOfView);
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
        const VkViewport all = view.target->viewport();
        if (outside == FW_OK) fwWorld_RecordInside(view.world, &described, targetId, &camera, &all);
        view.target->end(frame);
        view.drawn = pictureRevision;
        view.seen = true;
    }
}

void FlamePage::keepStep(const char* name) {
    if (steps[at].paint == paint) return;
    steps.resize(at + 1);
    steps.push_back({name, paint});
    ++at;
    changed = true;
    ++pictureRevision;
}

void FlamePage::undo() {
    if (at == 0) return;
    paint = steps[--at].paint;
    changed = true;
    ++pictureRevision;
}

void FlamePage::redo() {
    if (at + 1 >= steps.size()) return;
    paint = steps[++at].paint;
    changed = true;
    ++pictureRevision;
}

void FlamePage::usePreset(uint32_t which) {
    preset = which;
    paint = presetPaint(which);
    FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
    fwInitFirePreset(&def, which);
    diameter = def.diameter;
    power = def.power;
    changed = true;
    keepStep("Start from a preset");
    ++pictureRevision;
}

void FlamePage::import(App& app, const fs::path& file) {
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
        return;
    }
    paint = paintOf(profile);
    keepStep("Import a flame shape");
    changed = true;
    ++pictureRevision;
    say(app, "Imported " + file.filename().string());
}

bool FlamePage::exportTo(App& app, const fs::path& file) {
    fw::volume::Profile profile;
    profileOf(paint, profile);
    std::string error;
    if (file.extension() == ".fwprofile") {
        const auto cooked = fw::volume::cookProfile(profile, std::pmr::get_default_resource());
        error = fwtools::writeWhole(file.string(), cooked);
    } else {
        const bool whole = file.extension() != ".exr";
        fwimport::writePicture(file, fwtools::pictureOfProfile(profile, whole), error);
    }
    if (!error.empty()) {
        toast(app, Toast::Kind::kError, file.filename().string() + " was not written", error);
        return false;
    }
    say(app, "Wrote " + file.filename().string());
    return true;
}

void addFlameActions(App& app, std::vector<Action>& list) {
    App* at = &app;
    const int page = int(Page::kFlame);
    auto pick = [at](ProfileTool tool) { return [at, tool] { at->flame->tool = tool; }; };
    auto resize = [at](float by) {
        return [at, by] { at->flame->size = std::clamp(at->flame->size * by, 1.0f, 100.0f); };
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
         {"Pick a value", "Flame", "I", icons::pick, pick(ProfileTool::kPick), {}, page},
         {"Larger brush", "Flame", "]", nullptr, resize(1.2f), {}, page},
         {"Smaller brush", "Flame", "[", nullptr, resize(1 / 1.2f), {}, page},
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
          [at] {
              FileDialog dialog;
              dialog.saves = true;
              dialog.title = "Save the flame shape for the scene";
              dialog.act = "Save";
              dialog.name = "flame.fwprofile";
              dialog.endings = {".fwprofile"};
              dialog.done = [at](fs::path file) {
                  if (file.extension() != ".fwprofile") file += ".fwprofile";
                  if (!at->flame->exportTo(*at, file)) return;
                  const fwedit::Scene& scene = at->document.scene;
                  fwedit::ObjectId id = 0;
                  for (const fwedit::Flame& flame : scene.flames)
                      if (id == 0 || isSelected(*at, flame.id)) id = flame.id;
                  if (id != 0) {
                      performSet(*at, id, "profile", file.string());
                  } else {
                      addObject(*at, fwedit::Kind::Flame,
                                {{"profile", file.string()},
                                 {"diameter", double(at->flame->diameter)},
                                 {"power", double(at->flame->power)}});
                  }
                  at->page = Page::kScene;
              };
              askFile(*at, dialog);
          },
          {},
          page}});
}

namespace {

void showFlameTools(App& app, const Rect& rect) {
    FlamePage& page = *app.flame;
    ImDrawList* list = beginPanel("##flame tools", rect, colors::header);
    const float y = rect.y0 + dp(5);
    float x = rect.x0 + dp(8);
    struct Item {
        ProfileTool tool;
        const char *icon, *name, *keys;
    };
    constexpr Item kTools[] = {{ProfileTool::kPaint, icons::brush, "Paint", "B"},
                               {ProfileTool::kErase, icons::erase, "Erase", "X"},
                               {ProfileTool::kSmooth, icons::smooth, "Smooth", "S"},
                               {ProfileTool::kPick, icons::pick, "Pick a value", "I"}};
    for (const Item& item : kTools) {
        ToolLook look{.icon = item.icon};
        look.active = page.tool == item.tool;
        if (item.tool != ProfileTool::kPick) look.label = item.name;
        if (item.tool == ProfileTool::kPick) look.label = "Pick";
        if (toolButton(item.name, {x, y}, look, item.name, item.keys)) page.tool = item.tool;
        x += toolButtonWidth(look) + dp(3);
    }
    x += dp(6);
    drawColumn(list, x, rect.y0 + dp(9), rect.y1 - dp(9), colors::edge);
    x += dp(8);
    int plane = int(page.plane);
    if (segments("plane", {x, y + dp(2)}, dp(190, 24), {"Temperature", "Soot"}, plane)) {
        page.plane = ProfilePlane(plane);
        ++page.pictureRevision;
    }
    float right = rect.x1 - dp(8);
    auto act = [&](const char* name, const char* icon, const char* label) {
        const ToolLook look{.icon = icon, .label = label};
        right -= toolButtonWidth(look);
        if (toolButton(name, {right, y}, look, name)) findAction(app, name)->run();
        right -= dp(4);
    };
    act("Use in the scene…", icons::firepit, "Use in scene");
    act("Export flame picture…", icons::exportTo, "Export");
    act("Save flame shape…", icons::save, "Save");
    act("Import flame shape…", icons::importFrom, "Import");
    endPanel();
}

void showFlameLeft(App& app, const Rect& rect) {
    FlamePage& page = *app.flame;
    ImDrawList* list = beginPanel("##flame left", rect, colors::panel, true);
    Rows rows{list, rect.x0 + dp(10), rect.x1 - dp(10), rect.y0 - ImGui::GetScrollY(), 88};
    if (section(rows, "Brush", page.brushOpen)) {
        numberRow(rows, "Size", page.size,
                  {.unit = "cm", .format = "%.0f", .lowest = 1, .highest = 100});
        numberRow(rows, "Strength", page.strength,
                  {.unit = "%", .format = "%.0f", .lowest = 0, .highest = 100});
        numberRow(rows, "Softness", page.softness,
                  {.unit = "%", .format = "%.0f", .lowest = 0, .highest = 100});
        if (page.plane == ProfilePlane::kTemperature) {
            numberRow(rows, "Temperature", page.celsius,
                      {.unit = "°C",
                       .format = "%.0f",
                       .lowest = 200,
                       .highest = 2200,
                       .snap = 10,
                       .fill = colors::heat});
        } else {
            numberRow(rows, "Soot", page.soot, {.format = "%.2f", .lowest = 0, .highest = 2});
        }
        rows.y += dp(4);
    }
    bool touched = false;
    if (section(rows, "Size of the flame", page.sizeOpen)) {
        touched |= numberRow(rows, "Width", page.diameter,
                             {.unit = "m", .format = "%.2f", .lowest = 0.01f, .highest = 3}) !=
                   Edit::kNone;
        touched |= numberRow(rows, "Output", page.power,
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
            numberRow(rows, "Break-up", page.turbulence,
                      {.unit = "×", .format = "%.2f", .lowest = 0, .highest = 3}) != Edit::kNone;
        touched |=
            numberRow(rows, "Rise", page.speed,
                      {.unit = "×", .format = "%.2f", .lowest = 0, .highest = 4}) != Edit::kNone;
        touched |=
            numberRow(rows, "Wind", page.wind,
                      {.unit = "m/s", .format = "%.1f", .lowest = 0, .highest = 15}) != Edit::kNone;
    }
    if (touched) page.changed = true;
    endPanel();
}

void showCanvas(App& app, const Rect& rect) {
    FlamePage& page = *app.flame;
    ImDrawList* list = beginPanel("##canvas", rect, colors::gap);
    const float top = rect.y0 + dp(18), bottom = rect.y1 - dp(78);
    const float height = bottom - top;
    const float width = std::min(height * 0.82f, rect.width() - dp(110));
    const ImVec2 low(std::floor(rect.midX() - width * 0.5f + dp(12)), top);
    const ImVec2 high(low.x + std::floor(width), bottom);
    const float axis = (low.x + high.x) * 0.5f;
    if (page.canvas) {
        list->AddImage(page.canvas->texture, {axis, low.y}, high);
        list->AddImage(page.canvas->texture, low, {axis, high.y}, {1, 0}, {0, 1});
    }
    const float metres = page.height(), radius = kReach * 0.5f * page.diameter;
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

    // The legend of what is painted.
    const float mapY = rect.y1 - dp(34), mapX0 = low.x, mapX1 = high.x;
    if (page.plane == ProfilePlane::kTemperature) {
        drawMap(list, {mapX0, mapY}, {mapX1, mapY + dp(10)}, kHeatMap);
        for (int i = 0; i <= 4; ++i) {
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
    Dab dab;
    dab.plane = page.plane;
    dab.x = (mouse.x - axis) / (0.5f * width) * float(ProfilePaint::kWidth);
    dab.y = (high.y - mouse.y) / height * float(ProfilePaint::kHeight);
    dab.radiusY = 0.5f * page.size * 0.01f / metres * float(ProfilePaint::kHeight);
    dab.radiusX = 0.5f * page.size * 0.01f / radius * float(ProfilePaint::kWidth);
    dab.radiusX = std::max(dab.radiusX, 0.8f);
    dab.radiusY = std::max(dab.radiusY, 0.8f);
    dab.strength = page.strength * 0.01f;
    dab.hardness = 1 - page.softness * 0.01f;
    dab.tool = io.KeyShift ? ProfileTool::kSmooth : io.KeyCtrl ? ProfileTool::kErase : page.tool;
    dab.value = page.plane == ProfilePlane::kTemperature ? page.celsius + kZeroCelsius : page.soot;
    const bool picks = page.tool == ProfileTool::kPick || io.KeyAlt;
    if (hovered && io.MouseWheel != 0)
        page.size = std::clamp(page.size * std::pow(1.12f, io.MouseWheel), 1.0f, 100.0f);
    if (held && picks) {
        const int x = std::clamp(int(std::fabs(dab.x)), 0, ProfilePaint::kWidth - 1);
        const int y = std::clamp(int(dab.y), 0, ProfilePaint::kHeight - 1);
        const size_t i = size_t(y * ProfilePaint::kWidth + x);
        if (page.plane == ProfilePlane::kSoot) page.soot = page.paint.soot[i];
        if (page.plane == ProfilePlane::kTemperature && page.paint.kelvin[i] > 0)
            page.celsius = std::max(200.0f, page.paint.kelvin[i] - kZeroCelsius);
    } else if (held) {
        // Along the way since the last frame, a third of a radius apart.
        const float fromX = page.stroking ? page.lastX : dab.x;
        const float fromY = page.stroking ? page.lastY : dab.y;
        const float way = std::hypot((dab.x - fromX) / dab.radiusX, (dab.y - fromY) / dab.radiusY);
        const int count = std::clamp(int(way * 3), 1, 200);
        const float toX = dab.x, toY = dab.y;
        if (!page.stroking || way > 0) {
            for (int i = 1; i <= count; ++i) {
                dab.x = fromX + (toX - fromX) * float(i) / float(count);
                dab.y = fromY + (toY - fromY) * float(i) / float(count);
                paintDab(page.paint, dab);
            }
            page.changed = true;
            ++page.pictureRevision;
        }
        page.lastX = toX;
        page.lastY = toY;
        page.stroking = true;
    }
    if (page.stroking && !io.MouseDown[0]) {
        page.stroking = false;
        page.keepStep(page.tool == ProfileTool::kErase    ? "Erase in the flame"
                      : page.tool == ProfileTool::kSmooth ? "Smooth the flame"
                                                          : "Paint the flame");
        say(app, page.steps[page.at].name);
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
        ring(mouse.x, hex(0x000000, 190), dp(3.5f));
        ring(mouse.x, hex(0xFFFFFF), dp(1.5f));
        ring(2 * axis - mouse.x, hex(0xFFFFFF, 90), dp(1));
        list->PopClipRect();
        char text[24];
        if (page.plane == ProfilePlane::kTemperature) {
            std::snprintf(text, sizeof text, "%.0f °C", double(page.celsius));
        } else {
            std::snprintf(text, sizeof text, "Soot %.2f", double(page.soot));
        }
        const char* what = picks                              ? "Pick"
                           : dab.tool == ProfileTool::kErase  ? "Erase"
                           : dab.tool == ProfileTool::kSmooth ? "Smooth"
                                                              : text;
        drawChip(list, {mouse.x, std::max(rect.y0 + dp(12), mouse.y - radii.y - dp(16))}, what);
    }
    endPanel();
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
    const Rect night = rect.cutLeft(std::floor(rect.width() * 0.6f));
    rect.cutLeft(dp(2));
    const Rect day = rect.cutTop(std::floor(rect.height() * 0.5f));
    rect.cutTop(dp(2));
    const Rect windy = rect;
    const Rect rects[3] = {night, day, windy};
    char blown[32];
    std::snprintf(blown, sizeof blown, "Wind, %.0f m/s", double(page.wind));
    const char* names[3] = {"Night", "Day", blown};
    const char* signs[3] = {icons::moon, icons::sun, icons::wind};
    for (int i = 0; i < 3; ++i) {
        FlamePage::View& view = page.views[i];
        view.rect = rects[i];
        if (view.target) {
            const float share = page.slow ? 0.5f : 1.0f;
            view.target->resize(uint32_t(std::max(8.0f, rects[i].width() * share)),
                                uint32_t(std::max(8.0f, rects[i].height() * share)));
            list->AddImage(view.target->texture(), rects[i].low(), rects[i].high());
        }
        const ImVec2 low = rects[i].low() + dp(8, 8);
        const float width = textSize(fonts().body, names[i]).x + dp(36);
        drawBox(list, low, low + ImVec2(width, dp(24)), hex(0x151618, 215));
        drawIcon(list, fonts().icon17, low + dp(14, 12), colors::text, signs[i]);
        drawText(list, fonts().body, low.x + dp(28), low.y + dp(12), colors::text, names[i]);
    }
    endPanel();
}

void showPresets(App& app, const Rect& rect) {
    FlamePage& page = *app.flame;
    ImDrawList* list = beginPanel("##presets", rect);
    const float head =
        drawText(list, fonts().semi, rect.x0 + dp(10), rect.y0 + dp(16), colors::title, "Flames");
    drawText(list, fonts().small, rect.x0 + dp(20) + head, rect.y0 + dp(16), colors::dim,
             "click to start from one");
    float x = rect.x0 + dp(10);
    for (uint32_t i = 0; i < FW_FIRE_PRESET_COUNT; ++i) {
        const ImVec2 low(x, rect.y0 + dp(31)), high = low + dp(84, 58);
        if (high.x > rect.x1 - dp(8)) break;
        ImGui::PushID(int(i));
        bool hovered = false;
        if (hit("preset", low, {dp(84), dp(80)}, &hovered)) page.usePreset(i);
        ImGui::PopID();
        const bool here = page.preset == i;
        drawBox(list, low, high, colors::well, 4);
        if (i < page.presetTextures.size())
            list->AddImageRounded(page.presetTextures[i], low + dp(14, 1), high - dp(14, 1), {0, 0},
                                  {1, 1}, colors::white, dp(3));
        if (here || hovered) drawBox(list, low, high, 0, 4, here ? colors::accent : colors::edge);
        drawTextCentred(list, fonts().small, low.x + dp(42), high.y + dp(12),
                        here ? colors::title : colors::dim, tidy(fwFirePresetName(i)).c_str());
        x += dp(94);
    }
    endPanel();
}

}  // namespace

void showFlame(App& app, Rect rect) {
    if (!app.flame->opened) app.flame->open();
    showTopBar(app, rect.cutTop(dp(metrics::topBar)));
    showFlameTools(app, rect.cutTop(dp(metrics::toolBar)));
    showStatus(app, rect.cutBottom(dp(metrics::status)),
               {{"Drag", "paint"},
                {"Ctrl", "take away"},
                {"Shift", "smooth"},
                {"Alt", "pick"},
                {"[ ]", "size"}});
    rect.y0 += dp(1);
    const Rect presets = rect.cutBottom(dp(116));
    rect.cutBottom(dp(2));
    const Rect left = rect.cutLeft(dp(236));
    rect.cutLeft(dp(2));
    const Rect preview = rect.cutRight(std::floor(std::min(dp(456), rect.width() * 0.45f)));
    rect.cutRight(dp(2));
    showFlameLeft(app, left);
    showCanvas(app, rect);
    if (!app.flame->problem.empty()) {
        toast(app, Toast::Kind::kError, "The preview stands still", app.flame->problem);
        app.flame->problem.clear();
    }
    showPreview(app, preview);
    showPresets(app, presets);
}

}  // namespace fwapp
