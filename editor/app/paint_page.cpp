#include "app/paint_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/gtc/type_ptr.hpp>

#include "app/viewport_panel.h"
#include "shell/icons.h"

namespace fwapp {

using namespace fwui;
using fwedit::Kind;
using fwedit::ObjectId;
using fwedit::Vec3;

namespace {

constexpr MapStop kMultiplierStops[] = {{0, hex(0x1F4E9E)},
                                        {0.25f, hex(0x6FA3DC)},
                                        {0.5f, hex(0xEFEDE8)},
                                        {0.75f, hex(0xF2A24E)},
                                        {1, hex(0xB8480C)}};
constexpr MapStop kMoistureStops[] = {
    {0, hex(0xF1F5F7)}, {0.33f, hex(0x9CCFE0)}, {0.67f, hex(0x3A93BF)}, {1, hex(0x0B3F73)}};
// Colours only distinguish neighbours, and repeat beyond the last one; materials are named.
constexpr ImU32 kMaterialColors[] = {hex(0x6E7681), hex(0xC79A5B), hex(0x8C5A3C), hex(0xC9C5B8),
                                     hex(0xF2EBD9), hex(0xB9CBE0), hex(0x7B6FC4), hex(0xB8862B),
                                     hex(0x5E9C4A), hex(0xE0C24B), hex(0xA8B84A), hex(0xD8A878),
                                     hex(0x9A4F4F), hex(0x3FA7A0)};
ImU32 materialColor(uint32_t preset) {
    return kMaterialColors[preset % std::size(kMaterialColors)];
}
constexpr float kAsIs = 128;  // neutral byte of the multiplier

std::string materialName(uint32_t preset) {
    std::string text = fwMaterialPresetName(preset);
    std::replace(text.begin(), text.end(), '_', ' ');
    if (!text.empty()) text[0] = char(std::toupper(static_cast<unsigned char>(text[0])));
    return text;
}

// Unpainted areas are transparent.
fwview::Palette paletteOf(uint32_t kind) {
    fwview::Palette palette{};
    for (uint32_t i = 0; i < 256; ++i) {
        const float value = float(i);
        if (kind == fwedit::PaintMultiplier) {
            const float share = std::min(1.0f, value / (2 * kAsIs));
            const float changed = std::min(1.0f, std::fabs(value / kAsIs - 1) * 2.2f);
            palette[i] = fwview::premultiplied(sampleMap(kMultiplierStops, share),
                                               changed * fwview::kOverlayOpacity * 1.2f);
        } else if (kind == fwedit::PaintMoisture) {
            palette[i] =
                fwview::premultiplied(sampleMap(kMoistureStops, value / 255),
                                      std::min(1.0f, value / 60) * fwview::kOverlayOpacity * 1.2f);
        } else if (i > 0) {
            palette[i] = fwview::premultiplied(materialColor(i - 1), 0.8f);
        }
    }
    return palette;
}

const char* kindName(uint32_t kind) {
    constexpr const char* kNames[] = {"Burn multiplier", "Moisture", "Material"};
    return kNames[std::min<uint32_t>(kind, 2)];
}

float valueOf(const PaintPage& page) {
    if (page.kind == fwedit::PaintMultiplier) return page.multiplier;
    if (page.kind == fwedit::PaintMoisture) return page.moisture * 0.01f;
    return float(page.material);
}

std::string valueText(uint32_t kind, float value) {
    char text[64];
    if (kind == fwedit::PaintMultiplier) {
        std::snprintf(text, sizeof text, "%.2f×", double(value));
    } else if (kind == fwedit::PaintMoisture) {
        std::snprintf(text, sizeof text, "%.0f %%", double(value * 100));
    } else {
        return materialName(uint32_t(value));
    }
    return text;
}

Vec3 asArray(glm::vec3 v) { return {v.x, v.y, v.z}; }

glm::mat4 poseOf(const fwedit::Mesh& mesh) {
    const auto values = fwedit::transformOf(mesh);
    return glm::make_mat4(values.data());
}

// Returns world metres per metre of the mesh.
float scaleOf(const fwedit::Mesh& mesh) {
    return std::cbrt(std::max(1e-9f, std::fabs(mesh.scale[0] * mesh.scale[1] * mesh.scale[2])));
}

float radiusOf(const PaintPage& page, const fwedit::Mesh& mesh) {
    return 0.0005f * page.size / scaleOf(mesh);
}

// Chooses the selected mesh, otherwise the previous one, otherwise the first.
void chooseMesh(App& app) {
    PaintPage& page = *app.paint;
    const fwedit::Scene& scene = app.document.scene;
    for (const ObjectId id : app.selection)
        if (fwedit::findIn(scene.meshes, id)) page.mesh = id;
    if (!fwedit::findIn(scene.meshes, page.mesh))
        page.mesh = scene.meshes.empty() ? 0 : scene.meshes[0].id;
    page.surface = page.mesh ? app.live.surfaceOf(page.mesh) : nullptr;
    const fwedit::PaintLayer* layer = fwedit::findIn(scene.layers, page.layer);
    if (layer && layer->mesh == page.mesh && layer->kind == page.kind) return;
    page.layer = 0;
    for (const fwedit::PaintLayer& other : scene.layers)
        if (other.mesh == page.mesh && other.kind == page.kind) page.layer = other.id;
}

void colorOverlay(App& app) {
    PaintPage& page = *app.paint;
    const bool same = page.colored && page.coloredRevision == app.document.revision &&
                      page.coloredMesh == page.mesh && page.coloredLayer == page.layer &&
                      page.coloredSurface == page.surface.get();
    if (same || page.painter || !page.surface) return;
    page.colored = true;
    page.coloredRevision = app.document.revision;
    page.coloredMesh = page.mesh;
    page.coloredLayer = page.layer;
    page.coloredSurface = page.surface.get();
    const uint32_t width = page.surface->width, height = page.surface->height;
    const auto found = app.document.images.find(page.layer);
    std::vector<uint8_t> values(size_t{width} * height, fwedit::emptyValue(page.kind));
    if (page.layer && found != app.document.images.end() && found->second.width != 0) {
        const fwedit::PaintImage& image = found->second;
        values = image.width == width && image.height == height
                     ? image.flat()
                     : fwedit::resizedPaint(image, page.kind, width, height).flat();
    }
    app.live.overlay.color(page.mesh, page.surface, values, paletteOf(page.kind),
                           {0, 0, width, height});
    app.live.overlaid = {page.mesh};
    app.live.redraw();
}

// Uses at most 212 dp of `room` (px).
void drawMapLegend(ImDrawList* list, ImVec2 low, float room, const char* name,
                   std::span<const MapStop> map, std::initializer_list<const char*> words) {
    const float right = low.x + std::min(room, dp(212)) - dp(10);
    drawBox(list, low, {right + dp(10), low.y + dp(56)}, hex(0x151618, 215), 6);
    drawText(list, fonts().smallSemi, low.x + dp(10), low.y + dp(13), colors::title, name);
    drawMap(list, low + dp(10, 24), {right, low.y + dp(34)}, map);
    const char* const* word = words.begin();
    drawText(list, fonts().small, low.x + dp(10), low.y + dp(45), colors::text, word[0]);
    drawTextCentred(list, fonts().small, 0.5f * (low.x + dp(10) + right), low.y + dp(45),
                    colors::text, word[1]);
    drawTextRight(list, fonts().small, right, low.y + dp(45), colors::text, word[2]);
}

ObjectId addLayer(App& app) {
    PaintPage& page = *app.paint;
    const std::vector<ObjectId> before = app.selection;
    const ObjectId id = addObject(app, Kind::Layer,
                                  {{"name", std::string(kindName(page.kind))},
                                   {"mesh", double(page.mesh)},
                                   {"kind", double(page.kind)}});
    app.selection = before;
    if (id) page.layer = id;
    return id;
}

fwedit::BrushMode modeOf(const PaintPage& page, bool line = false) {
    const ImGuiIO& io = ImGui::GetIO();
    if ((io.KeyShift && !line) || page.tool == PaintTool::kSmooth) return fwedit::BrushMode::Smooth;
    if (io.KeyCtrl || page.tool == PaintTool::kErase) return fwedit::BrushMode::Erase;
    return fwedit::BrushMode::Paint;
}

void extendStroke(App& app) {
    PaintPage& page = *app.paint;
    if (!page.stroke.path.empty() && page.stroke.path.back() == page.aim) return;
    page.stroke.path.push_back(page.aim);
    if (!page.through) page.stroke.normals.push_back(page.aimNormal);
    const fwedit::PaintedArea area =
        page.painter->extend(page.aim, page.through ? nullptr : &page.aimNormal);
    if (area.empty()) return;
    app.live.overlay.color(page.mesh, page.surface, page.painter->values(), paletteOf(page.kind),
                           area);
    app.live.redraw();
}

// Returns false if there is nothing to paint on.
bool prepareStroke(App& app, fwedit::BrushMode mode) {
    PaintPage& page = *app.paint;
    const fwedit::Mesh* mesh = fwedit::findIn(app.document.scene.meshes, page.mesh);
    if (!mesh || (page.layer == 0 && addLayer(app) == 0)) return false;
    const fwedit::PaintLayer* layer = fwedit::findIn(app.document.scene.layers, page.layer);
    if (layer->hidden || layer->locked) {
        toast(app, Toast::Kind::kWarning, "Nothing was painted",
              "\"" + layer->name + "\" is " + (layer->hidden ? "hidden" : "locked"));
        return false;
    }
    page.stroke = {};
    page.stroke.mode = mode;
    page.stroke.size = radiusOf(page, *mesh);
    page.stroke.value = valueOf(page);
    page.stroke.strength = page.strength * 0.01f;
    page.stroke.hardness = page.hardness * 0.01f;
    page.stroke.mirror = page.mirror;
    return true;
}

void beginStroke(App& app) {
    PaintPage& page = *app.paint;
    if (!prepareStroke(app, modeOf(page))) return;
    const auto found = app.document.images.find(page.layer);
    const fwedit::PaintImage blank =
        fwedit::makePaintImage(page.kind, page.surface->width, page.surface->height);
    page.painter = std::make_unique<fwedit::StrokePainter>(
        *page.surface, page.kind,
        found == app.document.images.end() || found->second.width == 0 ? blank : found->second,
        page.stroke);
    extendStroke(app);
}

void endStroke(App& app) {
    PaintPage& page = *app.paint;
    page.painter.reset();
    if (!page.stroke.path.empty()) {
        page.endedOn = page.mesh;
        page.ended = page.stroke.path.back();
        page.endedNormal =
            page.stroke.normals.empty() ? fwedit::Vec3{} : page.stroke.normals.back();
    }
    fwedit::Command command;
    command.verb = fwedit::Verb::Stroke;
    command.targets = {page.layer};
    command.stroke = std::move(page.stroke);
    page.stroke = {};
    page.colored = false;
    perform(app, command);
}

// Draws a line from the end of the last stroke to the brush.
void drawLineToBrush(App& app) {
    PaintPage& page = *app.paint;
    if (!page.aims || !prepareStroke(app, modeOf(page, true))) return;
    page.stroke.path = {page.ended, page.aim};
    if (!page.through && page.endedNormal != fwedit::Vec3{})
        page.stroke.normals = {page.endedNormal, page.aimNormal};
    endStroke(app);
}

void cancelStroke(PaintPage& page) {
    page.painter.reset();
    page.stroke = {};
    page.colored = false;
}

void fillAtBrush(App& app) {
    PaintPage& page = *app.paint;
    if (page.layer == 0 && addLayer(app) == 0) return;
    fwedit::Command command;
    command.verb = fwedit::Verb::Fill;
    command.targets = {page.layer};
    fwedit::FillRequest& fill = command.fill;
    fill.by = fwedit::FillBy(page.fillBy);
    fill.value = valueOf(page);
    fill.at = page.aim;
    fill.slopeLow = page.slopeLow;
    fill.slopeHigh = page.slopeHigh;
    fill.curveLow = page.curveLow;
    fill.curveHigh = page.curveHigh;
    const size_t texel = fwedit::nearestTexel(*page.surface, page.aim);
    if (texel < page.surface->material.size()) fill.material = page.surface->material[texel];
    perform(app, command);
}

void pickValueAtBrush(App& app) {
    PaintPage& page = *app.paint;
    const auto found = app.document.images.find(page.layer);
    const size_t texel = fwedit::nearestTexel(*page.surface, page.aim);
    if (texel >= page.surface->real.size()) return;
    uint8_t value = fwedit::emptyValue(page.kind);
    if (found != app.document.images.end() && found->second.width == page.surface->width)
        value = found->second.at(uint32_t(texel % page.surface->width),
                                 uint32_t(texel / page.surface->width));
    if (page.kind == fwedit::PaintMultiplier) page.multiplier = float(value) / kAsIs;
    if (page.kind == fwedit::PaintMoisture) page.moisture = float(value) / 2.55f;
    if (page.kind == fwedit::PaintMaterial && value > 0) page.material = value - 1;
}

// Applies the mouse to the brush at `page.aim`, in either view.
void applyBrush(App& app, bool hovered) {
    PaintPage& page = *app.paint;
    const ImGuiIO& io = ImGui::GetIO();
    if (page.painter) {
        if (page.aims) extendStroke(app);
        if (ImGui::IsKeyPressed(256, false) || io.MouseDown[1]) {
            cancelStroke(page);
        } else if (!io.MouseDown[0]) {
            endStroke(app);
        }
        return;
    }
    if (page.mayLine) {
        if (std::hypot(io.MousePos.x - page.pressX, io.MousePos.y - page.pressY) > dp(3)) {
            page.mayLine = false;
            if (page.aims) beginStroke(app);
        } else if (!io.MouseDown[0]) {
            page.mayLine = false;
            drawLineToBrush(app);
        }
        return;
    }
    if (!hovered || !page.aims || !ImGui::IsMouseClicked(0)) return;
    if (io.KeyAlt || page.tool == PaintTool::kPick) {
        pickValueAtBrush(app);
    } else if (page.tool == PaintTool::kFill) {
        fillAtBrush(app);
    } else if (io.KeyShift && page.endedOn == page.mesh) {
        page.mayLine = true;
        page.pressX = io.MousePos.x;
        page.pressY = io.MousePos.y;
    } else {
        beginStroke(app);
    }
}

void drawBrushChip(const App& app, ImDrawList* list, ImVec2 at) {
    const PaintPage& page = *app.paint;
    const ImGuiIO& io = ImGui::GetIO();
    std::string text = valueText(page.kind, valueOf(page));
    if (page.tool == PaintTool::kFill) text = "Fill " + text;
    if (page.tool == PaintTool::kPick || io.KeyAlt) {
        text = "Pick";
    } else if (modeOf(page) == fwedit::BrushMode::Smooth) {
        text = "Smooth";
    } else if (modeOf(page) == fwedit::BrushMode::Erase) {
        text = "Take away";
    }
    drawChip(list, at, text.c_str());
}

// The ring lies on the surface and shows the stroke's size from any camera.
void drawRing(ImDrawList* list, const Picture& picture, glm::vec3 at, glm::vec3 normal,
              float radius, float hardness) {
    const glm::vec3 aside = std::fabs(normal.y) > 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    const glm::vec3 u = glm::normalize(glm::cross(normal, aside)), v = glm::cross(normal, u);
    constexpr int kParts = 64;
    for (const float share : {1.0f, hardness}) {
        if (share * radius <= 0) continue;
        ImVec2 points[kParts];
        bool seen = true;
        for (int i = 0; i < kParts; ++i) {
            const float angle = float(i) * 6.2831853f / kParts;
            seen &= picture.at(at + share * radius * (std::cos(angle) * u + std::sin(angle) * v),
                               points[i]);
        }
        if (!seen) return;
        if (share == 1)
            list->AddPolyline(points, kParts, hex(0x000000, 190), ImDrawFlags_Closed, dp(3.5f));
        list->AddPolyline(points, kParts, hex(0xFFFFFF, share == 1 ? 255 : 140), ImDrawFlags_Closed,
                          dp(share == 1 ? 1.5f : 1));
    }
}

void drawLegend(const App& app, ImDrawList* list, ImVec2 low, float room) {
    const PaintPage& page = *app.paint;
    if (page.kind == fwedit::PaintMaterial) {
        const ImVec2 high(low.x + std::min(room, dp(190)), low.y + dp(30));
        drawBox(list, low, high, hex(0x151618, 215), 6);
        drawBox(list, low + dp(10, 9), low + dp(22, 21), materialColor(uint32_t(page.material)), 3);
        drawTextFit(list, fonts().smallSemi, low.x + dp(30), low.y + dp(15),
                    high.x - low.x - dp(40), colors::title,
                    materialName(uint32_t(page.material)).c_str());
        return;
    }
    const bool moisture = page.kind == fwedit::PaintMoisture;
    if (moisture)
        drawMapLegend(list, low, room, kindName(page.kind), kMoistureStops,
                      {"Dry", "50 %", "Wet through"});
    else
        drawMultiplierLegend(list, low, room);
}

void showMeshView(App& app, const Rect& rect) {
    PaintPage& page = *app.paint;
    ImDrawList* list = beginPanel("##paint view", rect, colors::gap);
    const bool turns = page.orbits || page.pans;
    if (turns || ImGui::GetIO().MouseWheel != 0) app.movedAt = app.now;
    const float sharpness = app.slow && (turns || page.painter) ? 0.5f : 1.0f;
    app.live.resize(uint32_t(std::max(8.0f, rect.width() * sharpness)),
                    uint32_t(std::max(8.0f, rect.height() * sharpness)));
    const fwedit::Mesh* mesh = fwedit::findIn(app.document.scene.meshes, page.mesh);
    if (!page.surface || !mesh) {
        const char* text = !mesh ? "Import a mesh to paint on it" : "Unwrapping the mesh";
        drawTextCentred(list, fonts().body, rect.midX(), rect.midY(), colors::dim, text);
        endPanel();
        return;
    }
    list->AddImage(app.live.target.texture(), rect.low(), rect.high());
    const Picture picture{rect, app.live.view};
    hit("paint view", rect.low(), {rect.width(), rect.height()});
    const bool hovered = ImGui::IsItemHovered();
    const ImGuiIO& io = ImGui::GetIO();
    list->PushClipRect(rect.low(), rect.high(), true);
    const bool overBall = showNavigationBall(app, list, picture);
    if (hovered && io.MouseWheel != 0) zoom(app, io.MouseWheel);
    if (hovered && !overBall && !page.painter) {
        if (ImGui::IsMouseClicked(1)) page.orbits = true;
        if (ImGui::IsMouseClicked(2)) page.pans = true;
    }
    if (page.orbits) orbit(app, io.MouseDelta);
    if (page.pans) pan(app, picture, io.MouseDelta);
    page.orbits &= io.MouseDown[1];
    page.pans &= io.MouseDown[2];

    const glm::mat4 pose = poseOf(*mesh);
    if ((hovered && !overBall) || page.painter) {
        const glm::vec2 p = picture.share(io.MousePos);
        const fwview::SurfaceHit hit = app.live.pick(p.x, p.y, false);
        if (hovered) page.aims = hit.hit && hit.object == page.mesh;
        if (hovered && page.aims) {
            page.aim = asArray(glm::vec3(glm::inverse(pose) * glm::vec4(hit.position, 1)));
            page.aimNormal = asArray(glm::normalize(glm::transpose(glm::mat3(pose)) * hit.normal));
        }
        if (hit.hit && hit.object != page.mesh && hovered && ImGui::IsMouseClicked(0) &&
            !page.painter)
            select(app, hit.object, false, false);
    }
    if (hovered && !overBall) {
        if (page.aims && !turns) {
            ImGui::SetMouseCursor(ImGuiMouseCursor_None);
            const glm::vec3 at(pose * glm::vec4(asVec(page.aim), 1));
            const glm::vec3 normal = glm::normalize(glm::transpose(glm::inverse(glm::mat3(pose))) *
                                                    asVec(page.aimNormal));
            drawRing(list, picture, at, normal, 0.0005f * page.size, page.hardness * 0.01f);
            list->AddCircleFilled(io.MousePos, dp(2), colors::white, 12);
            drawBrushChip(app, list, io.MousePos + dp(0, -44));
        }
    }
    if (hovered || page.painter) applyBrush(app, hovered && !overBall);
    drawLegend(app, list, {rect.x0 + dp(12), rect.y1 - dp(68)}, rect.width() - dp(24));
    list->PopClipRect();
    endPanel();
}

void showUnwrap(App& app, const Rect& rect) {
    PaintPage& page = *app.paint;
    ImDrawList* list = beginPanel("##unwrap", rect, hex(0x17181B));
    const fwedit::Mesh* mesh = fwedit::findIn(app.document.scene.meshes, page.mesh);
    void* texture = app.live.overlay.texture(page.mesh);
    if (!page.surface || !mesh || !texture) {
        endPanel();
        return;
    }
    const fwedit::PaintSurface& surface = *page.surface;
    hit("unwrap", rect.low(), {rect.width(), rect.height()});
    const bool hovered = ImGui::IsItemHovered();
    const ImGuiIO& io = ImGui::GetIO();
    if (hovered && io.MouseWheel != 0)
        page.zoom = std::clamp(page.zoom * std::pow(1.14f, io.MouseWheel), 0.5f, 16.0f);
    if (hovered && (ImGui::IsMouseClicked(1) || ImGui::IsMouseClicked(2))) page.slides = true;
    if (page.slides) page.shift = page.shift + io.MouseDelta / theme().scale;
    page.slides &= io.MouseDown[1] || io.MouseDown[2];

    const float room = std::min(rect.width() - dp(44), rect.height() - dp(96));
    const float scale =
        page.zoom * room / float(std::max(surface.width, surface.height));  // pixels per texel
    const ImVec2 size(scale * float(surface.width), scale * float(surface.height));
    const ImVec2 low(std::floor(rect.midX() - size.x * 0.5f + dp(page.shift.x)),
                     std::floor(rect.midY() + dp(8) - size.y * 0.5f + dp(page.shift.y)));
    const auto place = [&](float x, float y) { return low + ImVec2(x, y) * scale; };
    list->PushClipRect({rect.x0, rect.y0 + dp(40)}, {rect.x1, rect.y1 - dp(36)}, true);
    list->AddRectFilled(low, low + size, hex(0x212226));
    for (int i = 1; i < 8; ++i) {
        drawColumn(list, low.x + size.x * float(i) / 8, low.y, low.y + size.y, hex(0x292A2F));
        drawRow(list, low.x, low.x + size.x, low.y + size.y * float(i) / 8, hex(0x292A2F));
    }
    // Islands have the legend's colour for "as it is".
    const ImU32 ground = page.kind == fwedit::PaintMaterial   ? hex(0x8F8B82)
                         : page.kind == fwedit::PaintMoisture ? kMoistureStops[0].color
                                                              : kMultiplierStops[2].color;
    const size_t corners = surface.corners.size() / 5;
    const ImDrawListFlags smooth = list->Flags;
    list->Flags &= ~ImDrawListFlags_AntiAliasedFill;  // avoids seams within an island
    for (size_t i = 0; i + 2 < corners; i += 3) {
        const float* c = surface.corners.data() + i * 5;
        list->AddTriangleFilled(place(c[3], c[4]), place(c[8], c[9]), place(c[13], c[14]), ground);
    }
    list->Flags = smooth;
    list->AddImage(texture, low, low + size);
    const float radius = radiusOf(page, *mesh);
    bool crosses = false;
    for (const fwedit::Seam& seam : surface.seams) {
        const glm::vec3 a = asVec(seam.fromPosition), b = asVec(seam.toPosition),
                        p = asVec(page.aim);
        const float along = std::clamp(
            glm::dot(p - a, b - a) / std::max(1e-12f, glm::dot(b - a, b - a)), 0.0f, 1.0f);
        const bool lit = page.aims && glm::length(p - a - along * (b - a)) < radius;
        crosses |= lit;
        list->AddLine(place(seam.from[0], seam.from[1]), place(seam.to[0], seam.to[1]),
                      lit ? colors::accent : hex(0x0E0F11, 110), lit ? dp(3) : hairline());
    }
    list->AddRect(low, low + size, colors::edge, 0, 0, hairline());

    if (hovered && !page.slides) {
        const float x = (io.MousePos.x - low.x) / scale, y = (io.MousePos.y - low.y) / scale;
        page.aims = x >= 0 && y >= 0 && x < float(surface.width) && y < float(surface.height);
        const size_t texel =
            page.aims ? size_t(y) * surface.width + size_t(x) : surface.real.size();
        page.aims = page.aims && surface.real[texel];
        if (page.aims) {
            std::copy_n(surface.positions.begin() + std::ptrdiff_t(texel * 3), 3, page.aim.begin());
            std::copy_n(surface.normals.begin() + std::ptrdiff_t(texel * 3), 3,
                        page.aimNormal.begin());
        }
    }
    if (page.aims) {
        const size_t texel = fwedit::nearestTexel(surface, page.aim);
        if (texel < surface.real.size()) {
            const ImVec2 at =
                place(float(texel % surface.width) + 0.5f, float(texel / surface.width) + 0.5f);
            const float ring = scale * radius / std::max(surface.spacing, 1e-6f);
            list->AddCircle(at, ring, hex(0x000000, 190), 48, dp(3));
            list->AddCircle(at, ring, colors::white, 48, dp(1.5f));
        }
    }
    list->PopClipRect();
    if (hovered) applyBrush(app, true);

    drawText(list, fonts().semi, rect.x0 + dp(12), rect.y0 + dp(20), colors::title, "Unwrap");
    char text[96];
    std::snprintf(text, sizeof text, "%u islands, %u × %u, %.1f px per cm", surface.islands,
                  surface.width, surface.height,
                  double(0.01f / std::max(1e-6f, surface.spacing * scaleOf(*mesh))));
    if (rect.width() > dp(220))
        drawTextFit(list, fonts().small, rect.x0 + dp(72), rect.y0 + dp(20), rect.width() - dp(110),
                    colors::dim, text);
    if (iconButton("frame unwrap", {rect.x1 - dp(18), rect.y0 + dp(20)}, icons::frame, colors::text,
                   "Show all of it")) {
        page.zoom = 1;
        page.shift = {};
    }
    if (crosses) {
        const float y = rect.y1 - dp(18), x = rect.x0 + dp(14);
        list->AddLine({x, y}, {x + dp(18), y}, colors::accent, dp(3));
        drawTextFit(list, fonts().small, x + dp(24), y, rect.width() - dp(40), colors::dim,
                    "Seam under the brush: the stroke crosses it");
    }
    endPanel();
}

void showPaintTools(App& app, const Rect& rect) {
    PaintPage& page = *app.paint;
    ImDrawList* list = beginPanel("##paint tools", rect, colors::header);
    const float y = rect.y0 + dp(5);
    float x = rect.x0 + dp(8);
    struct Entry {
        const char *icon, *name, *action;
    };
    constexpr Entry kTools[] = {{icons::brush, "Paint", "Paint on the mesh"},
                                {icons::erase, "Erase", "Erase paint"},
                                {icons::smooth, "Smooth", "Smooth paint"},
                                {icons::fill, "Fill", "Fill with paint"},
                                {icons::pick, "Pick", "Pick paint"}};
    for (int i = 0; i < 5; ++i) {
        ToolLook look{.icon = kTools[i].icon, .label = kTools[i].name};
        look.active = int(page.tool) == i;
        if (toolButton(kTools[i].name, {x, y}, look, kTools[i].name, keysOf(app, kTools[i].action)))
            page.tool = PaintTool(i);
        x += toolButtonWidth(look) + dp(2);
    }
    x += dp(6);
    drawColumn(list, x, rect.y0 + dp(9), rect.y1 - dp(9), colors::edge);
    x += dp(9);
    ToolLook mirror{.icon = icons::symmetry, .label = "Mirror"};
    mirror.active = page.mirror;
    if (toolButton("mirror", {x, y}, mirror, "Both sides of the mesh's middle",
                   keysOf(app, "Mirror paint")))
        page.mirror = !page.mirror;
    x += toolButtonWidth(mirror) + dp(8);
    const float right = rect.x1 - dp(8);
    if (page.tool == PaintTool::kFill) {
        constexpr std::array<const char*, 6> kBy = {"All",      "Island", "Piece",
                                                    "Material", "Slope",  "Bend"};
        const bool wide = x + dp(440) < right - dp(220);
        if (wide || x + dp(170) < right - dp(220))
            x += drawText(list, fonts().body, x + dp(2), y + dp(14), colors::dim, "Fill by") +
                 dp(12);
        if (wide)
            segments("fill by", {x, y + dp(2)}, dp(380, 24),
                     {kBy[0], kBy[1], kBy[2], kBy[3], kBy[4], kBy[5]}, page.fillBy);
        else
            choice("fill by", {x, y + dp(2)}, {std::min(dp(100), right - dp(212) - x), dp(24)}, kBy,
                   page.fillBy);
    }
    segments("paint views", {right - dp(204), y + dp(2)}, dp(204, 24), {"3D", "Both", "Unwrap"},
             page.view);
    endPanel();
}

void showBrush(App& app, const Rect& rect) {
    PaintPage& page = *app.paint;
    ImDrawList* list = beginPanel("##brush", rect, colors::panel, true);
    const float top = rect.y0 - ImGui::GetScrollY();
    drawText(list, fonts().semi, rect.x0 + dp(10), top + dp(16), colors::title, "Brush");
    Rows rows{list, rect.x0 + dp(10), rect.x1 - dp(10), top + dp(34), 84};
    // Preview of the dab and its falloff.
    const ImVec2 low(rows.x0, rows.y), high(rows.x1, rows.y + dp(84));
    drawBox(list, low, high, colors::well, 6);
    const ImU32 color = page.kind == fwedit::PaintMaterial ? materialColor(uint32_t(page.material))
                        : page.kind == fwedit::PaintMoisture
                            ? sampleMap(kMoistureStops, page.moisture * 0.01f)
                            : sampleMap(kMultiplierStops, page.multiplier * 0.5f);
    const ImVec2 middle((low.x + rows.x1 - dp(90)) * 0.5f, (low.y + high.y) * 0.5f);
    const float hard = page.hardness * 0.01f, strong = page.strength * 0.01f;
    const auto cover = [&](float away) {
        if (away <= hard) return 1.0f;
        const float t = std::clamp(1 - (away - hard) / std::max(1e-4f, 1 - hard), 0.0f, 1.0f);
        return t * t * (3 - 2 * t);
    };
    constexpr int kRings = 32;
    for (int i = kRings; i > 0; --i) {
        const float share = strong * cover((float(i) - 0.5f) / kRings);
        list->AddCircleFilled(middle, dp(32) * float(i) / kRings, mix(colors::well, color, share),
                              48);
    }
    list->AddCircle(middle, dp(32), hex(0xFFFFFF, 130), 48, dp(1));
    ImVec2 last;
    for (int i = 0; i <= 40; ++i) {
        const float t = float(i) / 20 - 1;
        const ImVec2 at(rows.x1 - dp(92) + dp(84) * float(i) / 40,
                        high.y - dp(22) - dp(46) * strong * cover(std::fabs(t)));
        if (i > 0) {
            list->AddQuadFilled(last, at, {at.x, high.y - dp(22)}, {last.x, high.y - dp(22)},
                                faded(color, 0.25f));
            list->AddLine(last, at, color, dp(1.5f));
        }
        last = at;
    }
    drawTextCentred(list, fonts().small, rows.x1 - dp(50), high.y - dp(10), colors::dim, "Falloff");
    rows.y = high.y + dp(10);
    numberRow(rows, "Size", page.size,
              {.unit = "mm", .format = "%.0f", .lowest = 1, .highest = 500, .most = 20000});
    numberRow(rows, "Strength", page.strength,
              {.unit = "%", .format = "%.0f", .lowest = 0, .highest = 100});
    numberRow(rows, "Hardness", page.hardness,
              {.unit = "%", .format = "%.0f", .lowest = 0, .highest = 100});
    rows.label("Through");
    toggle("through", {rows.fieldX(), rows.y + dp(3)}, page.through);
    drawText(list, fonts().small, rows.fieldX() + dp(38), rows.midY(), colors::dim,
             "back faces too");
    rows.next(4);
    drawRow(list, rect.x0, rect.x1, rows.y, colors::gap);
    rows.y += dp(10);
    drawText(list, fonts().semi, rows.x0, rows.y + dp(8), colors::title, kindName(page.kind));
    rows.y += dp(26);
    if (page.kind == fwedit::PaintMaterial) {
        rows.label("Material");
        const std::string now = materialName(uint32_t(page.material));
        if (dropdown("paint material", {rows.fieldX(), rows.y}, {rows.fieldWidth(), dp(22)},
                     now.c_str()))
            ImGui::OpenPopup("paint materials");
        if (beginMenu("paint materials", {rows.fieldX(), rows.y + dp(24)}, rows.fieldWidth())) {
            for (int i = 0; i < FW_MATERIAL_PRESET_COUNT; ++i)
                if (menuItem(materialName(uint32_t(i)).c_str(), nullptr, nullptr, true,
                             i == page.material))
                    page.material = i;
            endMenu();
        }
        rows.next(4);
    } else {
        const bool moisture = page.kind == fwedit::PaintMoisture;
        const ImVec2 from(rows.x0, rows.y), to(rows.x1, rows.y + dp(14));
        bool held = false;
        hit("ramp", from, to - from, nullptr, &held);
        const float most = moisture ? 100.0f : 2.0f;
        float& value = moisture ? page.moisture : page.multiplier;
        if (held)
            value = most *
                    std::clamp((ImGui::GetIO().MousePos.x - from.x) / (to.x - from.x), 0.0f, 1.0f);
        if (moisture) {
            drawMap(list, from, to, kMoistureStops);
        } else {
            drawMap(list, from, to, kMultiplierStops);
        }
        const float at = from.x + (to.x - from.x) * value / most;
        list->AddRectFilled({at - dp(3), from.y - dp(4)}, {at + dp(3), to.y + dp(4)}, hex(0x0E0F11),
                            dp(2));
        list->AddRectFilled({at - dp(1), from.y - dp(2)}, {at + dp(1), to.y + dp(2)},
                            colors::white);
        rows.y += dp(27);
        drawText(list, fonts().small, rows.x0, rows.y, colors::dim,
                 moisture ? "Dry" : "Never burns");
        if (!moisture)
            drawTextCentred(list, fonts().small, (rows.x0 + rows.x1) * 0.5f, rows.y, colors::dim,
                            "As is");
        drawTextRight(list, fonts().small, rows.x1, rows.y, colors::dim,
                      moisture ? "Wet through" : "Twice as fast");
        rows.y += dp(14);
        if (moisture) {
            numberRow(rows, "Paint value", page.moisture,
                      {.unit = "%", .format = "%.0f", .lowest = 0, .highest = 100});
        } else {
            numberRow(rows, "Paint value", page.multiplier,
                      {.unit = "×", .format = "%.2f", .lowest = 0, .highest = 2});
        }
    }
    if (page.tool == PaintTool::kFill && fwedit::FillBy(page.fillBy) == fwedit::FillBy::Slope) {
        const NumberLook slope{.unit = "°", .format = "%.0f", .lowest = 0, .highest = 180};
        numberRow(rows, "Slope from", page.slopeLow, slope);
        numberRow(rows, "Slope to", page.slopeHigh, slope);
    }
    if (page.tool == PaintTool::kFill && fwedit::FillBy(page.fillBy) == fwedit::FillBy::Curvature) {
        constexpr float kMost = 200;  // 1/m, slider limit; typed values may exceed it
        const NumberLook bend{.unit = "/m",
                              .format = "%.0f",
                              .lowest = -kMost,
                              .highest = kMost,
                              .least = -10000,
                              .most = 10000};
        numberRow(rows, "Bend from", page.curveLow, bend);
        numberRow(rows, "Bend to", page.curveHigh, bend);
        rows.y += drawTextWrapped(rows.list, fonts().small, {rows.x0, rows.y}, rows.x1 - rows.x0,
                                  colors::dim, "Above 0: edges. Below 0: hollows. 0: flat.");
    }
    endPanel();
}

void showLayers(App& app, const Rect& rect) {
    PaintPage& page = *app.paint;
    ImDrawList* list = beginPanel("##layers", rect, colors::panel, true);
    const float top = rect.y0 - ImGui::GetScrollY();
    drawText(list, fonts().semi, rect.x0 + dp(10), top + dp(16), colors::title, "Layers");
    if (page.mesh && iconButton("new layer", {rect.x1 - dp(16), top + dp(16)}, icons::add,
                                colors::text, "New layer"))
        addLayer(app);
    if (page.layer && iconButton("delete layer", {rect.x1 - dp(40), top + dp(16)}, icons::trash,
                                 colors::dim, "Delete layer")) {
        fwedit::Command command;
        command.verb = fwedit::Verb::Remove;
        command.targets = {page.layer};
        perform(app, command);
        page.layer = 0;
    }
    int kind = int(page.kind);
    if (segments("kinds", {rect.x0 + dp(10), top + dp(38)}, {rect.width() - dp(20), dp(26)},
                 {"Multiplier", "Moisture", "Material"}, kind)) {
        page.kind = uint32_t(kind);
        page.layer = 0;
    }
    float y = top + dp(74);
    size_t shown = 0;
    const size_t count = app.document.scene.layers.size();
    for (size_t i = count; i-- > 0 && i < app.document.scene.layers.size();) {
        const fwedit::PaintLayer layer = app.document.scene.layers[i];
        if (layer.mesh != page.mesh || layer.kind != page.kind) continue;
        ++shown;
        ImGui::PushID(int(layer.id));
        const bool here = layer.id == page.layer;
        const ListRow row = listRow("layer", rect.x0, rect.x1, y, here, 44);
        const float middle = y + dp(22);
        if (row.clicked) page.layer = layer.id;
        if (iconButton("eye", {rect.x0 + dp(18), middle}, layer.hidden ? icons::eyeOff : icons::eye,
                       layer.hidden ? colors::off : colors::text, layer.hidden ? "Show" : "Hide"))
            performSet(app, layer.id, "hidden", layer.hidden ? 0.0 : 1.0);
        drawTextFit(list, fonts().body, rect.x0 + dp(40), middle - dp(8), rect.width() - dp(60),
                    layer.hidden ? colors::off
                    : here       ? colors::title
                                 : colors::text,
                    layer.name.c_str());
        char text[48];
        std::snprintf(text, sizeof text, "%s, %.0f %%",
                      layer.kind == fwedit::PaintMaterial ? "Replaces" : "Multiplies",
                      double(100 * layer.strength));
        drawText(list, fonts().small, rect.x0 + dp(40), middle + dp(8),
                 layer.hidden ? colors::off : colors::dim, text);
        ImGui::PopID();
        y += dp(45);
    }
    if (shown == 0) {
        drawIcon(list, fonts().icon34, {rect.midX(), y + dp(34)}, colors::off, icons::layers);
        drawTextCentred(list, fonts().body, rect.midX(), y + dp(68), colors::dim,
                        page.mesh ? "Paint starts a layer" : "There is no mesh");
        y += dp(96);
    }
    drawRow(list, rect.x0, rect.x1, y + dp(5), colors::gap);
    Rows rows{list, rect.x0 + dp(10), rect.x1 - dp(10), y + dp(16), 84};
    if (const fwedit::PaintLayer* layer = fwedit::findIn(app.document.scene.layers, page.layer)) {
        float percent = 100 * layer->strength;
        const Edit edit = numberRow(rows, "Opacity", percent,
                                    {.unit = "%", .format = "%.0f", .lowest = 0, .highest = 100});
        if (edit != Edit::kNone) {
            if (edit == Edit::kDragging && !app.document.dragging) fwedit::beginDrag(app.document);
            performSet(app, page.layer, "strength", double(percent) / 100);
            if (edit == Edit::kDone && app.document.dragging) fwedit::endDrag(app.document);
        }
    }
    const fwedit::Mesh* mesh = fwedit::findIn(app.document.scene.meshes, page.mesh);
    if (mesh && app.document.scene.meshes.size() > 1) {
        rows.label("On");
        drawTextFit(list, fonts().body, rows.fieldX(), rows.midY(), rows.fieldWidth(), colors::text,
                    mesh->name.c_str());
        rows.next();
        drawText(list, fonts().small, rows.x0, rows.midY(), colors::dim,
                 "Click another mesh to paint on it");
    }
    endPanel();
}

}  // namespace

void colorMultipliers(App& app) {
    app.live.overlaid.clear();
    for (const fwedit::Mesh& mesh : app.document.scene.meshes) {
        const auto surface = app.live.surfaceOf(mesh.id);
        if (!surface) continue;
        uint32_t width = 0, height = 0;
        std::vector<uint8_t> values =
            fwedit::multiplierOf(app.document.scene, app.document.images, mesh.id, width, height);
        if (values.empty()) continue;  // neutral everywhere
        if (width != surface->width || height != surface->height)
            values = fwedit::resizedPaint(
                         fwedit::paintImageOf(fwedit::PaintMultiplier, width, height, values),
                         fwedit::PaintMultiplier, surface->width, surface->height)
                         .flat();
        app.live.overlay.color(mesh.id, surface, values, paletteOf(fwedit::PaintMultiplier),
                               {0, 0, surface->width, surface->height});
        app.live.overlaid.push_back(mesh.id);
    }
    app.live.redraw();
}

void drawMultiplierLegend(ImDrawList* list, ImVec2 low, float room, const char* name) {
    drawMapLegend(list, low, room, name, kMultiplierStops, {"Never", "As is", "Twice"});
}

void addPaintActions(App& app, std::vector<Action>& list) {
    App* at = &app;
    const int page = int(Page::kPaint);
    auto pick = [at](PaintTool tool) { return [at, tool] { at->paint->tool = tool; }; };
    auto resize = [at](float by) {
        return [at, by] { at->paint->size = std::clamp(at->paint->size * by, 1.0f, 20000.0f); };
    };
    auto strengthen = [at](float by) {
        return
            [at, by] { at->paint->strength = std::clamp(at->paint->strength + by, 0.0f, 100.0f); };
    };
    list.insert(
        list.end(),
        {{"Paint on the mesh", "Paint", "B", icons::brush, pick(PaintTool::kPaint), {}, page},
         {"Erase paint", "Paint", "X", icons::erase, pick(PaintTool::kErase), {}, page},
         {"Smooth paint", "Paint", "S", icons::smooth, pick(PaintTool::kSmooth), {}, page},
         {"Fill with paint", "Paint", "G", icons::fill, pick(PaintTool::kFill), {}, page},
         {"Pick paint", "Paint", "I", icons::pick, pick(PaintTool::kPick), {}, page},
         {"Larger paint brush", "Paint", "]", nullptr, resize(1.2f), {}, page},
         {"Smaller paint brush", "Paint", "[", nullptr, resize(1 / 1.2f), {}, page},
         {"Stronger paint", "Paint", "Shift+]", nullptr, strengthen(10), {}, page},
         {"Weaker paint", "Paint", "Shift+[", nullptr, strengthen(-10), {}, page},
         {"Mirror paint",
          "Paint",
          "K",
          icons::symmetry,
          [at] { at->paint->mirror = !at->paint->mirror; },
          {},
          page},
         {"Frame the mesh",
          "Paint",
          "F",
          icons::frame,
          [at] { frameSelection(*at, true); },
          {},
          page}});
}

void showPaint(App& app, Rect rect) {
    PaintPage& page = *app.paint;
    app.live.follow(app.document, true);
    app.live.shown = fwview::Shown::kRest;
    app.burnTimesAt = -1;
    if (app.camera.distance < 0 && app.live.burn() && !app.live.isPreparing()) {
        app.camera.distance = 2;
        frameSelection(app, true);
    }
    chooseMesh(app);
    colorOverlay(app);
    showTopBar(app, rect.cutTop(dp(metrics::topBar)));
    showPaintTools(app, rect.cutTop(dp(metrics::toolBar)));
    showStatus(app, rect.cutBottom(dp(metrics::status)),
               {{"Drag", "paint"},
                {"Ctrl", "take away"},
                {"Shift", "smooth"},
                {"Shift+click", "line"},
                {"[ ]", "size"},
                {"Alt+click", "pick"},
                {"Right drag", "orbit"}});
    rect.y0 += dp(1);
    const float gap = dp(2);
    if (app.panels) {
        const Rect left = rect.cutLeft(dp(236));
        rect.cutLeft(gap);
        const Rect right = rect.cutRight(dp(252));
        rect.cutRight(gap);
        showBrush(app, left);
        showLayers(app, right);
    }
    if (page.view == 2) {
        showUnwrap(app, rect);
        return;
    }
    const Rect space = page.view == 0 ? rect : rect.cutLeft(std::floor(rect.width() * 0.55f));
    showMeshView(app, space);
    if (page.view == 0) return;
    rect.cutLeft(gap);
    showUnwrap(app, rect);
}

}  // namespace fwapp
