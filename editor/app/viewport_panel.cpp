#include "app/viewport_panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "app/paint_page.h"
#include "shell/icons.h"

namespace fwapp {

using namespace fwui;
using fwedit::Kind;
using fwedit::ObjectId;

namespace {

constexpr float kGrab = 9;          // dp around a handle
constexpr float kArm = 74;          // dp, of the gizmo's arrows
constexpr float kSnapStep = 0.05f;  // m

// Action of the mouse from press to release.
enum class MouseAction { kNone, kOrbit, kPan, kAxis, kPlane, kBox, kClick, kTurn, kStretch };
struct MouseDrag {
    MouseAction busy = MouseAction::kNone;
    int axis =
        0;  // kAxis, kStretch: along this axis (3: all); kPlane: its normal; kTurn: around it
    std::vector<std::pair<ObjectId, fwedit::Vec3>> before;  // initial values of rotated or scaled
                                                            // objects
    float done = 0;                                         // degrees, or factor - 1
    ImVec2 press{};
    glm::vec3 from{0};  // initial position of the selection
    glm::vec3 grip{0};  // grabbed point
    glm::vec3 moved{0};
};
MouseDrag& mouseDrag() {
    static MouseDrag one;  // static, since there is one mouse
    return one;
}

glm::vec3 axisOf(int axis) {
    glm::vec3 v(0);
    v[axis] = 1;
    return v;
}

bool intersectPlane(const fwview::Ray& ray, glm::vec3 point, glm::vec3 normal, glm::vec3& hit) {
    const float facing = glm::dot(ray.direction, normal);
    if (std::fabs(facing) < 1e-4f) return false;
    const float distance = glm::dot(point - ray.origin, normal) / facing;
    if (distance <= 0) return false;
    hit = ray.origin + distance * ray.direction;
    return true;
}

// Returns the point of a line nearest to a ray.
bool findNearestOnAxis(const fwview::Ray& ray, glm::vec3 point, glm::vec3 axis, glm::vec3& hit) {
    const glm::vec3 across = glm::cross(ray.direction, axis);
    const glm::vec3 normal = glm::cross(across, axis);
    if (!intersectPlane(ray, point, glm::normalize(normal), hit)) return false;
    hit = point + glm::dot(hit - point, axis) * axis;
    return true;
}

float distanceTo(ImVec2 p, ImVec2 a, ImVec2 b) {
    const ImVec2 along = b - a;
    const float length = along.x * along.x + along.y * along.y;
    const float t =
        length > 0
            ? std::clamp(((p.x - a.x) * along.x + (p.y - a.y) * along.y) / length, 0.0f, 1.0f)
            : 0.0f;
    return std::hypot(p.x - a.x - t * along.x, p.y - a.y - t * along.y);
}

bool isMovable(const fwedit::Scene& scene, Kind kind, ObjectId id) {
    const fwedit::Wind* wind = fwedit::findIn(scene.winds, id);
    if (wind) return wind->shape != fwedit::WindEverywhere;
    return kind == Kind::Mesh || kind == Kind::Source || kind == Kind::Flame ||
           kind == Kind::Emitter || kind == Kind::Collider;
}

glm::vec3 placeOf(const App& app, ObjectId id) {
    return asVec(fwedit::worldPosition(app.document.scene, id, app.document.nodePose));
}

// The gizmo's position: centre of the movable selection.
bool pivotOf(const App& app, glm::vec3& pivot) {
    glm::vec3 sum(0);
    float count = 0;
    for (const ObjectId id : app.selection) {
        Kind kind{};
        const fwedit::Object* object = fwedit::findObject(app.document.scene, id, &kind);
        if (!object || object->locked || !isMovable(app.document.scene, kind, id)) continue;
        sum += placeOf(app, id);
        ++count;
    }
    if (count == 0) return false;
    pivot = sum / count;
    return true;
}

// Returns the metres that `pixels` span at a position.
float metresAt(const Picture& picture, glm::vec3 place, float pixels) {
    const float depth = fwview::onPicture(picture.view, place).z;
    const float scale = std::fabs(picture.view.projection[5]);
    return 2 * pixels * depth / (scale * picture.rect.height());
}

void drawArrow(ImDrawList* list, ImVec2 from, ImVec2 to, ImU32 color, bool hot) {
    const ImVec2 delta = to - from;
    const float length = std::hypot(delta.x, delta.y);
    if (length < dp(10)) {
        list->AddCircleFilled(to, dp(5), color, 16);
        return;
    }
    const ImVec2 along = delta / length, across(-along.y, along.x), neck = to - along * dp(13);
    list->AddLine(from, neck, IM_COL32(0, 0, 0, 120), dp(5));
    list->AddLine(from, neck, color, dp(hot ? 4 : 2.5f));
    list->AddTriangleFilled(to, neck + across * dp(hot ? 7 : 5.5f),
                            neck - across * dp(hot ? 7 : 5.5f), color);
}

struct Gizmo {
    bool there = false;
    ImVec2 origin{}, tips[3];
    ImVec2 planes[3][4];
    float arm = 0;  // m
    glm::vec3 pivot{0};
};

Gizmo makeGizmo(const Picture& picture, glm::vec3 pivot) {
    Gizmo gizmo;
    gizmo.pivot = pivot;
    if (!picture.at(pivot, gizmo.origin)) return gizmo;
    gizmo.there = true;
    gizmo.arm = metresAt(picture, pivot, dp(kArm));
    for (int i = 0; i < 3; ++i) {
        picture.at(pivot + gizmo.arm * axisOf(i), gizmo.tips[i]);
        const glm::vec3 u = gizmo.arm * axisOf((i + 1) % 3), v = gizmo.arm * axisOf((i + 2) % 3);
        constexpr float kNear = 0.32f, kFar = 0.58f;
        picture.at(pivot + kNear * u + kNear * v, gizmo.planes[i][0]);
        picture.at(pivot + kFar * u + kNear * v, gizmo.planes[i][1]);
        picture.at(pivot + kFar * u + kFar * v, gizmo.planes[i][2]);
        picture.at(pivot + kNear * u + kFar * v, gizmo.planes[i][3]);
    }
    return gizmo;
}

// Returns -1: none; 0..2: an arrow; 3..5: a plane.
int hitTest(const Gizmo& gizmo, ImVec2 mouse) {
    if (!gizmo.there) return -1;
    for (int i = 0; i < 3; ++i) {
        const ImVec2* q = gizmo.planes[i];
        if (ImTriangleContainsPoint(q[0], q[1], q[2], mouse) ||
            ImTriangleContainsPoint(q[0], q[2], q[3], mouse))
            return 3 + i;
    }
    int best = -1;
    float nearest = dp(kGrab);
    for (int i = 0; i < 3; ++i) {
        const float distance = distanceTo(mouse, gizmo.origin, gizmo.tips[i]);
        if (distance >= nearest) continue;
        nearest = distance;
        best = i;
    }
    return best;
}

void drawGizmo(ImDrawList* list, const Gizmo& gizmo, int hot) {
    if (!gizmo.there) return;
    for (int i = 0; i < 3; ++i) {
        const bool lit = hot == 3 + i;
        list->AddConvexPolyFilled(gizmo.planes[i], 4, faded(colors::axis[i], lit ? 0.8f : 0.4f));
        list->AddPolyline(gizmo.planes[i], 4, colors::axis[i], ImDrawFlags_Closed, dp(1));
    }
    for (int i = 0; i < 3; ++i)
        drawArrow(list, gizmo.origin, gizmo.tips[i], hot == i ? colors::white : colors::axis[i],
                  hot == i);
    list->AddCircleFilled(gizmo.origin, dp(4), colors::white, 20);
}

// Rings around the axes, or arms that end in boxes, with a centre box for uniform scale.
struct Handles {
    bool there = false;
    float arm = 0;  // m
    ImVec2 origin{}, tips[3];
    std::array<std::array<ImVec2, 48>, 3> rings;
};

Handles makeHandles(const Picture& picture, glm::vec3 pivot) {
    Handles handles;
    if (!picture.at(pivot, handles.origin)) return handles;
    handles.there = true;
    handles.arm = metresAt(picture, pivot, dp(kArm));
    for (int i = 0; i < 3; ++i) {
        picture.at(pivot + handles.arm * axisOf(i), handles.tips[i]);
        auto& ring = handles.rings[size_t(i)];
        for (size_t k = 0; k < ring.size(); ++k) {
            const float angle = float(k) * 6.2831853f / float(ring.size());
            picture.at(pivot + handles.arm * (std::cos(angle) * axisOf((i + 1) % 3) +
                                              std::sin(angle) * axisOf((i + 2) % 3)),
                       ring[k]);
        }
    }
    return handles;
}

// Returns -1: none; 0..2: an axis; 3: the centre (scale).
int hitTest(const Handles& handles, bool turns, ImVec2 mouse) {
    if (!handles.there) return -1;
    int best = -1;
    float nearest = dp(kGrab);
    for (int i = 0; i < 3; ++i) {
        float distance = 1e9f;
        if (turns) {
            const auto& ring = handles.rings[size_t(i)];
            for (size_t k = 0; k < ring.size(); ++k)
                distance =
                    std::min(distance, distanceTo(mouse, ring[k], ring[(k + 1) % ring.size()]));
        } else {
            distance = distanceTo(mouse, handles.origin, handles.tips[i]);
        }
        if (distance >= nearest) continue;
        nearest = distance;
        best = i;
    }
    const bool middle =
        std::hypot(mouse.x - handles.origin.x, mouse.y - handles.origin.y) < dp(kGrab);
    return !turns && middle ? 3 : best;
}

void drawHandles(ImDrawList* list, const Handles& handles, bool turns, int hot) {
    if (!handles.there) return;
    const auto box = [&](ImVec2 at, ImU32 color, float half) {
        list->AddRectFilled(at - dp(half + 1, half + 1), at + dp(half + 1, half + 1),
                            IM_COL32(0, 0, 0, 120));
        list->AddRectFilled(at - dp(half, half), at + dp(half, half), color);
    };
    for (int i = 0; i < 3; ++i) {
        const ImU32 color = hot == i ? colors::white : colors::axis[i];
        const float width = dp(hot == i ? 3.5f : 2.5f);
        if (turns) {
            const auto& ring = handles.rings[size_t(i)];
            list->AddPolyline(ring.data(), int(ring.size()), IM_COL32(0, 0, 0, 110),
                              ImDrawFlags_Closed, width + dp(2));
            list->AddPolyline(ring.data(), int(ring.size()), color, ImDrawFlags_Closed, width);
        } else {
            list->AddLine(handles.origin, handles.tips[i], IM_COL32(0, 0, 0, 120), width + dp(2));
            list->AddLine(handles.origin, handles.tips[i], color, width);
            box(handles.tips[i], color, 5);
        }
    }
    if (!turns) box(handles.origin, hot == 3 ? colors::white : colors::text, 6);
}

// Returns the field that rotates an object; null: it cannot rotate.
const char* turnField(Kind kind) {
    if (kind == Kind::Mesh || kind == Kind::Collider) return "rotation";
    if (kind == Kind::Source || kind == Kind::Emitter) return "direction";
    if (kind == Kind::Wind) return "velocity";
    return nullptr;
}

const char* stretchField(Kind kind) {
    if (kind == Kind::Mesh) return "scale";
    if (kind == Kind::Collider || kind == Kind::Wind) return "half_size";
    return nullptr;
}

std::vector<std::pair<ObjectId, fwedit::Vec3>> vectorsOf(const App& app, bool turns) {
    std::vector<std::pair<ObjectId, fwedit::Vec3>> found;
    for (const ObjectId id : app.selection) {
        Kind kind{};
        const fwedit::Object* object = fwedit::findObject(app.document.scene, id, &kind);
        const char* key = turns ? turnField(kind) : stretchField(kind);
        fwedit::Value value;
        if (!object || object->locked || !key ||
            !fwedit::getField(app.document.scene, kind, id, key, value))
            continue;
        const auto& list = std::get<std::vector<double>>(value);
        found.push_back({id, {float(list[0]), float(list[1]), float(list[2])}});
    }
    return found;
}

// Returns degrees around x, then y, then z, after rotating `before` around a world axis.
fwedit::Vec3 turnedAngles(const fwedit::Vec3& before, int axis, float degrees) {
    fwedit::Mesh mesh;
    mesh.rotation = before;
    const auto values = fwedit::transformOf(mesh);
    const glm::mat4 turn = glm::rotate(glm::mat4(1), glm::radians(degrees), axisOf(axis));
    const glm::mat4 m = turn * glm::make_mat4(values.data());
    const float level = std::hypot(m[0][0], m[0][1]);
    glm::vec3 angles(0, std::atan2(-m[0][2], level), 0);
    if (level > 1e-5f) {
        angles.x = std::atan2(m[1][2], m[2][2]);
        angles.z = std::atan2(m[0][1], m[0][0]);
    } else {
        angles.x = std::atan2(-m[2][1], m[1][1]);  // gimbal lock: z and x are one rotation
    }
    angles = glm::degrees(angles);
    return {angles.x, angles.y, angles.z};
}

struct Marker {
    ObjectId id;
    Kind kind;
    ImVec2 place;
};

std::vector<Marker> markersOf(const App& app, const Picture& picture) {
    std::vector<Marker> markers;
    fwedit::forEachList(app.document.scene, [&](Kind kind, const auto& list) {
        if (kind == Kind::Mesh) return;
        for (const auto& object : list) {
            ImVec2 place;
            if (object.hidden || !isMovable(app.document.scene, kind, object.id) ||
                !picture.at(placeOf(app, object.id), place))
                continue;
            if (picture.rect.holds(place)) markers.push_back({object.id, kind, place});
        }
    });
    return markers;
}

// Shows the range of a source as a ring around its direction.
void drawReach(const App& app, ImDrawList* list, const Picture& picture,
               const fwedit::HeatSource& source, ImU32 color) {
    const glm::vec3 place = placeOf(app, source.id);
    const glm::vec3 direction = asVec(
        fwedit::turnedBy(fwedit::parentPose(app.document.scene, source.id, app.document.nodePose),
                         source.direction));
    glm::vec3 axis = direction;
    const bool flat = source.shape == fwedit::SourceDisc || source.shape == fwedit::SourceRain;
    if (!flat || glm::length(axis) < 1e-5f)
        axis = glm::vec3(glm::inverse(glm::make_mat4(picture.view.view))[2]);
    axis = glm::normalize(axis);
    const glm::vec3 u = glm::normalize(
        glm::cross(axis, std::fabs(axis.y) > 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
    const glm::vec3 v = glm::cross(axis, u);
    std::array<ImVec2, 48> ring;
    for (size_t i = 0; i < ring.size(); ++i) {
        const float angle = float(i) * 6.2831853f / float(ring.size());
        if (!picture.at(place + source.radius * (std::cos(angle) * u + std::sin(angle) * v),
                        ring[i]))
            return;
    }
    list->AddPolyline(ring.data(), int(ring.size()), IM_COL32(0, 0, 0, 150), ImDrawFlags_Closed,
                      dp(4));
    list->AddPolyline(ring.data(), int(ring.size()), color, ImDrawFlags_Closed, dp(2));
    if (source.shape == fwedit::SourceFlamethrower || source.shape == fwedit::SourceLine) {
        ImVec2 a, b;
        const glm::vec3 heading =
            glm::length(direction) > 1e-5f ? glm::normalize(direction) : glm::vec3(0, 1, 0);
        const float reach = source.shape == fwedit::SourceLine ? 0.5f * source.length : 0.6f;
        const glm::vec3 back = source.shape == fwedit::SourceLine ? reach * heading : glm::vec3(0);
        if (picture.at(place - back, a) && picture.at(place + reach * heading, b))
            drawArrow(list, a, b, color, false);
    }
}

// Shows a wind zone: edges of a box, three rings of a ball, cone of a fan; and its direction.
void drawZone(const App& app, ImDrawList* list, const Picture& picture, const fwedit::Wind& wind,
              ImU32 color) {
    const glm::vec3 middle = placeOf(app, wind.id);
    const glm::vec3 velocity = asVec(wind.velocity);
    const glm::vec3 heading =
        glm::length(velocity) > 1e-5f ? glm::normalize(velocity) : glm::vec3(1, 0, 0);
    const auto edge = [&](glm::vec3 from, glm::vec3 to) {
        ImVec2 a, b;
        if (!picture.at(from, a) || !picture.at(to, b)) return;
        list->AddLine(a, b, IM_COL32(0, 0, 0, 110), dp(3));
        list->AddLine(a, b, color, dp(1.5f));
    };
    const auto ring = [&](glm::vec3 centre, glm::vec3 axis, float radius) {
        const glm::vec3 u = glm::normalize(
            glm::cross(axis, std::fabs(axis.y) > 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
        const glm::vec3 v = glm::cross(axis, u);
        constexpr int kParts = 32;
        const auto at = [&](int i) {
            const float angle = float(i) * 6.2831853f / kParts;
            return centre + radius * (std::cos(angle) * u + std::sin(angle) * v);
        };
        for (int i = 0; i < kParts; ++i) edge(at(i), at(i + 1));
        return std::array<glm::vec3, 4>{at(0), at(kParts / 4), at(kParts / 2), at(3 * kParts / 4)};
    };
    if (wind.shape == fwedit::WindBox) {
        const glm::vec3 half = asVec(wind.halfSize);
        for (int i = 0; i < 8; ++i)
            for (int axis = 0; axis < 3; ++axis) {
                if (i >> axis & 1) continue;
                glm::vec3 corner = glm::vec3(i & 1, i >> 1 & 1, i >> 2 & 1) * 2.0f - 1.0f;
                const glm::vec3 from = middle + corner * half;
                corner[axis] = 1;
                edge(from, middle + corner * half);
            }
    } else if (wind.shape == fwedit::WindBall) {
        for (int axis = 0; axis < 3; ++axis) ring(middle, axisOf(axis), wind.radius);
    } else {
        for (const glm::vec3 rim : ring(middle + wind.length * heading, heading, wind.radius))
            edge(middle, rim);
    }
    if (wind.flow == fwedit::WindOut) return;
    ImVec2 a, b;
    const float reach = wind.shape == fwedit::WindFan   ? 0.5f * wind.length
                        : wind.shape == fwedit::WindBox ? wind.halfSize[0]
                                                        : wind.radius;
    if (picture.at(middle, a) && picture.at(middle + reach * heading, b))
        drawArrow(list, a, b, color, false);
}

void drawMarkers(App& app, ImDrawList* list, const Picture& picture,
                 const std::vector<Marker>& markers) {
    for (const Marker& marker : markers) {
        const bool selected = isSelected(app, marker.id);
        if (selected && marker.kind == Kind::Source)
            drawReach(app, list, picture, *fwedit::findIn(app.document.scene.sources, marker.id),
                      colors::accent);
        if (selected && marker.kind == Kind::Wind)
            drawZone(app, list, picture, *fwedit::findIn(app.document.scene.winds, marker.id),
                     colors::accent);
        list->AddCircleFilled(marker.place, dp(11), hex(0x151618, 225), 32);
        list->AddCircle(marker.place, dp(11), selected ? colors::accent : hex(0xFFFFFF, 150), 32,
                        dp(selected ? 2 : 1));
        drawIcon(list, fonts().icon17, marker.place,
                 colorOf(app.document.scene, marker.kind, marker.id),
                 iconOf(app.document.scene, marker.kind, marker.id));
    }
}

void drawOutlines(App& app, ImDrawList* list, const Picture& picture) {
    std::vector<glm::vec2> lines;
    const ImVec2 size(picture.rect.width(), picture.rect.height());
    auto place = [&](glm::vec2 p) { return picture.rect.low() + ImVec2(p.x, p.y) * size; };
    for (const ObjectId id : app.selection) {
        app.live.outlineOf(id, size, lines);
        for (const auto& [color, width] :
             {std::pair{colors::accent, dp(3)}, std::pair{colors::white, dp(1)}}) {
            for (size_t i = 0; i + 1 < lines.size(); i += 2)
                list->AddLine(place(lines[i]), place(lines[i + 1]), color, width);
        }
    }
}

void moveSelection(App& app, glm::vec3 by) {
    fwedit::Command command;
    command.verb = fwedit::Verb::Move;
    for (const ObjectId id : app.selection) {
        Kind kind{};
        const fwedit::Object* object = fwedit::findObject(app.document.scene, id, &kind);
        if (object && !object->locked && isMovable(app.document.scene, kind, id))
            command.targets.push_back(id);
    }
    command.offset = {by.x, by.y, by.z};
    if (!command.targets.empty()) perform(app, command);
}

void endMove(App& app) {
    if (!app.document.dragging) return;
    fwedit::endDrag(app.document);
    setStatus(app, app.document.steps[app.document.at].name);
}

// Drags a handle. Measured from the grabbed point, so that errors do not accumulate.
void dragHandle(App& app, const Picture& picture, ImDrawList* list) {
    MouseDrag& state = mouseDrag();
    const ImGuiIO& io = ImGui::GetIO();
    const fwview::Ray ray = picture.ray(io.MousePos);
    glm::vec3 at(0);
    const glm::vec3 axis = axisOf(state.axis);
    const bool found = state.busy == MouseAction::kAxis
                           ? findNearestOnAxis(ray, state.from, axis, at)
                           : intersectPlane(ray, state.from, axis, at);
    if (found) {
        glm::vec3 delta = at - state.grip;
        if (io.KeyShift) delta *= 0.1f;
        if (io.KeyCtrl != app.snapping) {
            for (int i = 0; i < 3; ++i) {
                const bool free = (state.busy == MouseAction::kAxis) == (i == state.axis);
                if (!free) continue;
                delta[i] =
                    std::round((state.from[i] + delta[i]) / kSnapStep) * kSnapStep - state.from[i];
            }
        }
        if (glm::length(delta - state.moved) > 1e-6f) {
            if (!app.document.dragging) fwedit::beginDrag(app.document);
            moveSelection(app, delta - state.moved);
            state.moved = delta;
        }
    }
    char text[64];
    if (state.busy == MouseAction::kAxis) {
        std::snprintf(
            text, sizeof text, "%s m",
            formatNumber(state.from[state.axis] + state.moved[state.axis], "%.2f").c_str());
    } else {
        std::snprintf(text, sizeof text, "%s m",
                      formatNumber(glm::length(state.moved), "%.2f").c_str());
    }
    drawChip(list, io.MousePos + dp(0, -26), text);
    if (ImGui::IsKeyPressed(256, false) || io.MouseDown[1]) {
        fwedit::cancelDrag(app.document);
        state.busy = MouseAction::kNone;
    }
}

// Rotates around an axis, or scales along one, relative to the press.
void rotateOrScale(App& app, const Picture& picture, ImDrawList* list) {
    MouseDrag& state = mouseDrag();
    const ImGuiIO& io = ImGui::GetIO();
    const bool turns = state.busy == MouseAction::kTurn;
    const fwview::Ray ray = picture.ray(io.MousePos);
    float amount = state.done;
    glm::vec3 at(0);
    if (turns) {
        const glm::vec3 axis = axisOf(state.axis);
        if (intersectPlane(ray, state.from, axis, at)) {
            const glm::vec3 a = state.grip - state.from, b = at - state.from;
            amount = glm::degrees(std::atan2(glm::dot(glm::cross(a, b), axis), glm::dot(a, b)));
        }
    } else if (state.axis == 3) {
        amount = (io.MousePos.x - state.press.x - (io.MousePos.y - state.press.y)) / dp(100);
    } else if (findNearestOnAxis(ray, state.from, axisOf(state.axis), at)) {
        const float whole = state.grip[state.axis] - state.from[state.axis];
        if (std::fabs(whole) > 1e-6f)
            amount = (at[state.axis] - state.from[state.axis]) / whole - 1;
    }
    if (io.KeyShift) amount *= 0.1f;
    constexpr float kSnapTurn = 15, kSnapStretch = 0.1f;  // degrees, share
    if (io.KeyCtrl != app.snapping) {
        const float step = turns ? kSnapTurn : kSnapStretch;
        amount = std::round(amount / step) * step;
    }
    if (!turns) amount = std::max(amount, -0.95f);
    if (std::fabs(amount - state.done) > 1e-5f) {
        if (!app.document.dragging) fwedit::beginDrag(app.document);
        state.done = amount;
        for (const auto& [id, before] : state.before) {
            Kind kind{};
            if (!fwedit::findObject(app.document.scene, id, &kind)) continue;
            fwedit::Vec3 now = before;
            const char* key = turns ? turnField(kind) : stretchField(kind);
            if (turns && !std::strcmp(key, "direction")) {
                const glm::mat4 turn =
                    glm::rotate(glm::mat4(1), glm::radians(amount), axisOf(state.axis));
                const fwedit::Pose holder =
                    fwedit::parentPose(app.document.scene, id, app.document.nodePose);
                const glm::vec3 turned(turn *
                                       glm::vec4(asVec(fwedit::turnedBy(holder, before)), 0));
                now = fwedit::directionWithin(holder, {turned.x, turned.y, turned.z});
            } else if (turns) {
                now = turnedAngles(before, state.axis, amount);
            } else {
                for (int i = 0; i < 3; ++i)
                    if (state.axis == 3 || state.axis == i) now[size_t(i)] *= 1 + amount;
            }
            performSet(app, id, key,
                       std::vector<double>{double(now[0]), double(now[1]), double(now[2])});
        }
    }
    const std::string text = turns ? formatNumber(amount, "%.0f") + "°"
                                   : formatNumber(100 * (1 + amount), "%.0f") + " %";
    drawChip(list, io.MousePos + dp(0, -26), text.c_str());
    if (ImGui::IsKeyPressed(256, false) || io.MouseDown[1]) {
        fwedit::cancelDrag(app.document);
        state.busy = MouseAction::kNone;
    }
}

void placeSource(App& app, ImDrawList* list, const Picture& picture, ImVec2 mouse) {
    const glm::vec2 p = picture.share(mouse);
    fwview::SurfaceHit hit = app.live.pick(p.x, p.y, false);
    const float ground = app.document.scene.settings.ground;
    if (!hit.hit) {
        glm::vec3 at;
        if (intersectPlane(picture.ray(mouse), {0, ground, 0}, {0, 1, 0}, at)) {
            hit.position = at;
            hit.normal = {0, 1, 0};
        } else {
            intersectPlane(picture.ray(mouse), asVec(app.camera.target),
                           -picture.ray(mouse).direction, hit.position);
        }
    }
    const bool rain = app.placed == fwedit::SourceRain;
    const bool jet = app.placed == fwedit::SourceFlamethrower;
    ImVec2 spot, tip;
    const float arm = metresAt(picture, hit.position, dp(26));
    if (picture.at(hit.position, spot) && picture.at(hit.position + arm * hit.normal, tip)) {
        const ImU32 color = app.placed >= fwedit::SourceRain ? colors::wet : colors::heat;
        list->AddLine(spot, tip, IM_COL32(0, 0, 0, 150), dp(4));
        list->AddLine(spot, tip, colors::white, dp(2));
        list->AddCircle(spot, dp(10), IM_COL32(0, 0, 0, 150), 32, dp(4));
        list->AddCircle(spot, dp(10), color, 32, dp(2));
    }
    if (!ImGui::IsMouseReleased(0)) return;
    glm::vec3 position = hit.position;
    glm::vec3 direction = hit.normal;
    if (rain) position.y += 2;
    if (jet) {
        position += 0.8f * hit.normal;
        direction = -hit.normal;
    }
    constexpr const char* kNames[] = {"Match",        "Heat source", "Heat disc", "Heat line",
                                      "Flamethrower", "Rain",        "Water"};
    std::vector<fwedit::Assignment> fields = {
        {"shape", double(app.placed)},
        {"name", std::string(kNames[app.placed])},
        {"position",
         std::vector<double>{double(position.x), double(position.y), double(position.z)}}};
    if (!rain)
        fields.push_back({"direction", std::vector<double>{double(direction.x), double(direction.y),
                                                           double(direction.z)}});
    if (rain) fields.push_back({"radius", 1.0});
    addObject(app, Kind::Source, fields);
    app.placing = false;
}

void queryAt(App& app, const Picture& picture, ImVec2 mouse) {
    const glm::vec2 p = picture.share(mouse);
    const fwview::SurfaceHit hit = app.live.pick(p.x, p.y, false);
    if (hit.hit) {
        app.live.askWhy(hit.object, hit.position);
    } else {
        app.live.why = {};
        toast(app, Toast::Kind::kInfo, "Click on a surface", "It says why it does not burn there");
    }
}

// The heading of an answer, such as "Not lit", without its numbers.
std::string headOf(const std::string& answer) {
    return answer.substr(0, answer.find_first_of(":,"));
}

// Beside the spot, never over it: right of it, or left if there is no space.
void showWhy(App& app, ImDrawList* list, const Picture& picture) {
    fwview::WhyCard& why = app.live.why;
    ImVec2 spot;
    if (!why.open || !picture.at(why.position, spot)) return;
    const fwedit::WhyAnswer& answer = why.answer;
    const fwedit::Mesh* mesh = fwedit::findIn(app.document.scene.meshes, why.mesh);
    const Rect& rect = picture.rect;
    const float width = dp(296), inner = width - dp(28);
    float textHeight = 0;
    for (const std::string& cause : answer.causes)
        textHeight += dp(8) + drawTextWrapped(nullptr, fonts().body, {0, 0}, inner - dp(22), 0,
                                              cause.c_str());
    const std::string forecast =
        answer.forecast.empty() ? "Without changes it will not ignite" : answer.forecast;
    textHeight +=
        drawTextWrapped(nullptr, fonts().body, {0, 0}, inner - dp(22), 0, forecast.c_str());
    const bool unlit = why.answered && (!answer.forecast.empty() || !answer.causes.empty());
    const float height = unlit ? dp(164) + textHeight : dp(why.answered ? 134 : 82);
    const bool right = spot.x + dp(40) + width < rect.x1;
    ImVec2 low(right ? spot.x + dp(40) : spot.x - dp(40) - width, spot.y - height * 0.4f);
    low.x = std::floor(std::max(rect.x0 + dp(8), low.x));
    low.y = std::floor(
        std::clamp(low.y, rect.y0 + dp(8), std::max(rect.y0 + dp(8), rect.y1 - height - dp(8))));
    const ImVec2 high = low + ImVec2(width, height);
    list->AddLine(spot, {right ? low.x : high.x, std::clamp(spot.y, low.y + dp(8), high.y - dp(8))},
                  colors::white, dp(1.5f));
    list->AddCircleFilled(spot, dp(5), colors::white, 24);
    list->AddCircle(spot, dp(10), hex(0x000000, 140), 32, dp(3.5f));
    list->AddCircle(spot, dp(10), colors::white, 32, dp(1.5f));
    hit("why card", low, high - low);
    drawCard(list, low, high);
    const float x = low.x + dp(14), end = high.x - dp(14);
    float y = low.y;
    drawIcon(list, fonts().icon20, {x + dp(8), y + dp(23)}, colors::accent, icons::question);
    const std::string head = why.answered        ? headOf(answer.answer)
                             : why.error.empty() ? std::string("Querying the fire")
                                                 : std::string("No answer");
    drawTextFit(list, fonts().heading, x + dp(24), y + dp(22), inner - dp(74), colors::title,
                head.c_str());
    if (why.answered && iconButton("pin why", {high.x - dp(42), y + dp(22)}, icons::pin,
                                   colors::dim, "Keep this spot in the inspector")) {
        app.live.pinWhy();
        return;
    }
    if (iconButton("close why", {high.x - dp(18), y + dp(22)}, icons::close, colors::dim,
                   "Close")) {
        why = {};
        return;
    }
    const std::string where = (mesh ? mesh->name : std::string("Nothing")) + ", at " +
                              clockText(why.answered ? why.time : app.live.time());
    drawTextFit(list, fonts().small, x, y + dp(44), inner, colors::dim, where.c_str());
    drawRow(list, low.x + hairline(), high.x - hairline(), y + dp(58), colors::line);
    y += dp(74);
    if (!why.answered) {
        if (!why.error.empty())
            drawTextFit(list, fonts().body, x, y, inner, colors::text, why.error.c_str());
        return;
    }
    char text[48];
    if (!unlit) {
        const size_t colon = answer.answer.find_first_of(":,");
        const std::string rest =
            colon == std::string::npos ? answer.answer : answer.answer.substr(colon + 2);
        drawTextFit(list, fonts().body, x, y, inner, colors::text, rest.c_str());
        y += dp(20);
    } else {
        drawText(list, fonts().body, x, y, colors::text, "Heat so far");
        std::snprintf(text, sizeof text, "needs %.2f", double(answer.needs));
        drawTextRight(list, fonts().body, end, y, colors::dim, text);
        const float valueEnd = end - textSize(fonts().body, text).x - dp(6);
        std::snprintf(text, sizeof text, "%.2f", double(answer.heat));
        drawTextRight(list, fonts().semi, valueEnd, y, colors::title, text);
        progressBar(list, {x, y + dp(12)}, inner, dp(8),
                    std::min(1.0f, answer.heat / std::max(answer.needs, 0.01f)), colors::heat);
        y += dp(36);
        for (const std::string& cause : answer.causes) {
            drawIcon(list, fonts().icon17, {x + dp(7), y + dp(4)}, colors::dim, icons::right);
            y += dp(8) + drawTextWrapped(list, fonts().body, {x + dp(22), y - dp(4)},
                                         inner - dp(22), colors::text, cause.c_str());
        }
        y += dp(4);
        const bool comes = answer.arrivesIn < fwedit::kNeverLit;
        drawIcon(list, fonts().icon17, {x + dp(7), y}, comes ? colors::ok : colors::dim,
                 icons::timer);
        drawTextWrapped(list, fonts().body, {x + dp(22), y - dp(8)}, inner - dp(22), colors::title,
                        forecast.c_str());
    }
    y = high.y - dp(38);
    const float third = std::floor((inner - dp(12)) / 3);
    const bool comes = answer.arrivesIn < fwedit::kNeverLit;
    float at = x;
    if (comes) {
        const double then = why.time + double(answer.arrivesIn);
        if (button("why go", {at, y}, {third, dp(28)}, ("Go to " + clockText(then, false)).c_str()))
            app.live.seek(then);
        at += third + dp(6);
    }
    if (mesh && mesh->moisture > 0) {
        if (button("why dry", {at, y}, {third, dp(28)}, "Dry it"))
            performSet(app, mesh->id, "moisture", 0.0);
        at += third + dp(6);
    }
    if (button("why paint", {at, y}, {third, dp(28)}, "Paint here")) {
        select(app, why.mesh, false, false);
        app.camera.target = {why.position.x, why.position.y, why.position.z};
        app.page = Page::kPaint;
    }
}

void drawTimeLegend(const App& app, ImDrawList* list, ImVec2 low) {
    const ImVec2 high = low + dp(212, 56);
    const double duration = double(app.document.scene.settings.duration);
    drawBox(list, low, high, hex(0x151618, 215), 6);
    drawText(list, fonts().smallSemi, low.x + dp(10), low.y + dp(13), colors::title,
             app.live.knownTime() < 0 ? "Burn time: not known yet" : "Burn time");
    drawMap(list, low + dp(10, 24), low + dp(202, 34), kTimeMap);
    drawText(list, fonts().small, low.x + dp(10), low.y + dp(45), colors::text, "0:00");
    drawTextCentred(list, fonts().small, low.x + dp(106), low.y + dp(45), colors::text,
                    clockText(duration / 2, false).c_str());
    drawTextRight(list, fonts().small, low.x + dp(202), low.y + dp(45), colors::text,
                  clockText(duration, false).c_str());
}

// The pinned spots, with their numbers.
void drawPins(App& app, ImDrawList* list, const Picture& picture) {
    for (size_t i = 0; i < app.live.pins.size(); ++i) {
        ImVec2 spot;
        if (!picture.at(app.live.pins[i].position, spot)) continue;
        list->AddCircleFilled(spot, dp(9), colors::white, 24);
        list->AddCircle(spot, dp(9), hex(0x000000, 140), 24, dp(1.5f));
        drawTextCentred(list, fonts().smallSemi, spot.x, spot.y, hex(0x101113),
                        std::to_string(i + 1).c_str());
    }
}

// Names of the two halves, and the line between them.
void drawHalves(const App& app, ImDrawList* list, const Rect& rect, const Rect& worked) {
    if (!app.live.isComparing()) return;
    if (!app.live.showsComparison()) {
        drawChip(list, {rect.midX(), rect.y0 + dp(20)}, "Preparing the comparison");
        return;
    }
    list->AddRectFilled({worked.x0 - dp(1), rect.y0}, {worked.x0 + dp(1), rect.y1}, colors::gap);
    const auto name = [&](float x, float room, const char* letter, const char* what) {
        const float width = std::min(room - dp(24), textSize(fonts().body, what).x + dp(42));
        const ImVec2 low(x + dp(12), rect.y0 + dp(12));
        drawBox(list, low, low + ImVec2(width, dp(26)), hex(0x151618, 215), 6);
        drawText(list, fonts().semi, low.x + dp(10), low.y + dp(13), colors::accent, letter);
        drawTextFit(list, fonts().body, low.x + dp(28), low.y + dp(13), width - dp(38),
                    colors::title, what);
    };
    name(rect.x0, worked.x0 - rect.x0, "A", app.compared.c_str());
    name(worked.x0, worked.width() - dp(90), "B", "Now");
}

// A click selects the marker under it, otherwise the surface, otherwise nothing.
void pickAt(App& app, const Picture& picture, const std::vector<Marker>& markers, ImVec2 mouse) {
    const ImGuiIO& io = ImGui::GetIO();
    for (auto marker = markers.rbegin(); marker != markers.rend(); ++marker) {
        const fwedit::Object* object = fwedit::findObject(app.document.scene, marker->id);
        if (!app.showHelpers || !object || object->locked) continue;
        if (std::hypot(mouse.x - marker->place.x, mouse.y - marker->place.y) > dp(12)) continue;
        select(app, marker->id, io.KeyShift, io.KeyCtrl);
        return;
    }
    if (app.tool == Tool::kWhy) return queryAt(app, picture, mouse);
    const glm::vec2 p = picture.share(mouse);
    select(app, app.live.pick(p.x, p.y, true).object, io.KeyShift, io.KeyCtrl);
}

void pickBox(App& app, const Picture& picture, const std::vector<Marker>& markers, ImVec2 a,
             ImVec2 b) {
    const Rect box{std::min(a.x, b.x), std::min(a.y, b.y), std::max(a.x, b.x), std::max(a.y, b.y)};
    if (!ImGui::GetIO().KeyShift) app.selection.clear();
    for (const Marker& marker : markers)
        if (box.holds(marker.place)) select(app, marker.id, true, false);
    for (const fwedit::Mesh& mesh : app.document.scene.meshes) {
        ImVec2 place;
        if (!mesh.hidden && !mesh.locked && picture.at(asVec(mesh.position), place) &&
            box.holds(place))
            select(app, mesh.id, true, false);
    }
}

}  // namespace

bool Picture::at(glm::vec3 position, ImVec2& pixel) const {
    const glm::vec3 p = fwview::onPicture(view, position);
    pixel = {rect.x0 + p.x * rect.width(), rect.y0 + p.y * rect.height()};
    return p.z > 0;
}

glm::vec2 Picture::share(ImVec2 pixel) const {
    return {(pixel.x - rect.x0) / rect.width(), (pixel.y - rect.y0) / rect.height()};
}

fwview::Ray Picture::ray(ImVec2 pixel) const {
    const glm::vec2 p = share(pixel);
    return fwview::rayThrough(view, p.x, p.y);
}

bool showNavigationBall(App& app, ImDrawList* list, const Picture& picture) {
    const ImVec2 centre(picture.rect.x1 - dp(44), picture.rect.y0 + dp(46));
    const float radius = dp(26);
    const glm::mat4 view = glm::make_mat4(picture.view.view);
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const bool over = std::hypot(mouse.x - centre.x, mouse.y - centre.y) < radius + dp(9);
    list->AddCircleFilled(centre, radius + dp(9), hex(0x151618, over ? 200 : 150), 48);
    struct Ball {
        int axis;
        float sign, depth;
        ImVec2 place;
    };
    std::array<Ball, 6> balls;
    for (int i = 0; i < 6; ++i) {
        const glm::vec3 p(view * glm::vec4((i < 3 ? 1.0f : -1.0f) * axisOf(i % 3), 0));
        balls[size_t(i)] = {i % 3, i < 3 ? 1.0f : -1.0f, p.z, centre + ImVec2(p.x, -p.y) * radius};
    }
    std::sort(balls.begin(), balls.end(),
              [](const Ball& a, const Ball& b) { return a.depth < b.depth; });
    constexpr const char* kLetters[3] = {"X", "Y", "Z"};
    const Ball* hot = nullptr;
    for (const Ball& ball : balls) {
        const ImU32 color = colors::axis[ball.axis];
        if (ball.sign > 0) {
            list->AddLine(centre, ball.place, color, dp(2));
            list->AddCircleFilled(ball.place, dp(8), color, 24);
            drawTextCentred(list, fonts().smallSemi, ball.place.x, ball.place.y, hex(0x101113),
                            kLetters[ball.axis]);
        } else {
            list->AddCircleFilled(ball.place, dp(4), faded(color, 0.5f), 16);
        }
        if (std::hypot(mouse.x - ball.place.x, mouse.y - ball.place.y) < dp(9)) hot = &ball;
    }
    if (hot && ImGui::IsMouseClicked(0)) {
        const float turned = hot->sign > 0 ? 0.0f : 180.0f;
        if (hot->axis == 0) app.camera.yaw = 90 + turned;
        if (hot->axis == 2) app.camera.yaw = turned;
        app.camera.pitch = hot->axis == 1 ? 89 * hot->sign : 0;
    }
    return over;
}

void orbit(App& app, ImVec2 by) {
    app.camera.yaw -= 0.4f * by.x / theme().scale;
    app.camera.pitch = std::clamp(app.camera.pitch + 0.4f * by.y / theme().scale, -89.0f, 89.0f);
}

void pan(App& app, const Picture& picture, ImVec2 by) {
    const glm::mat4 back = glm::inverse(glm::make_mat4(picture.view.view));
    const float metres = metresAt(picture, asVec(app.camera.target), 1);
    const glm::vec3 delta = metres * (-by.x * glm::vec3(back[0]) + by.y * glm::vec3(back[1]));
    for (int i = 0; i < 3; ++i) app.camera.target[size_t(i)] += delta[i];
}

void zoom(App& app, float notches) {
    app.camera.distance = std::clamp(app.camera.distance * std::pow(0.88f, notches), 0.01f, 1e4f);
}

namespace {

// Returns the share of full resolution for a moving picture; re-evaluated every few frames.
float chooseMovingResolution(App& app) {
    constexpr float kShares[] = {1, 0.8f, 0.64f, 0.5f, 0.4f, 0.32f};
    constexpr float kMost = 1 / 18.0f;  // s per frame; the goal is 15 frames a second
    constexpr float kRoom = kMost * 0.64f * 0.64f * 0.9f;  // below it, the next higher resolution
                                                           // fits
    constexpr uint32_t kAppearances = 6;
    Pace& pace = app.pace;
    pace.seconds += app.deltaTime;
    if (++pace.frames >= kAppearances) {
        const float mean = pace.seconds / float(pace.frames);
        if (mean > kMost && pace.step + 1 < std::size(kShares)) ++pace.step;
        if (mean < kRoom && pace.step > 0) --pace.step;
        pace.frames = 0;
        pace.seconds = 0;
    }
    return kShares[pace.step];
}

// Before there is a picture of the scene: shows the progress, or that it was cancelled.
void showPreparing(App& app, ImDrawList* list, const Rect& rect, bool takesLong) {
    const float y = rect.midY();
    if (app.live.isCancelled()) {
        drawTextCentred(list, fonts().body, rect.midX(), y - dp(8), colors::dim,
                        "Preparation was cancelled");
        if (button("prepare", {rect.midX() - dp(60), y + dp(8)}, dp(120, 28), "Prepare it"))
            app.live.resume();
        return;
    }
    float share = 0;
    const std::string stage = app.live.stage(share);
    drawTextCentred(list, fonts().body, rect.midX(), y - dp(8), colors::dim,
                    stage.empty() ? "Preparing the scene" : stage.c_str());
    progressBar(list, {rect.midX() - dp(110), y + dp(8)}, dp(220), dp(6), share, colors::accent);
    if (takesLong && button("leave it", {rect.midX() - dp(46), y + dp(26)}, dp(92, 28), "Cancel"))
        app.live.cancel();
}

}  // namespace

void showPicture(App& app, const Rect& rect) {
    ImDrawList* list = beginPanel("##picture", rect, colors::gap);
    app.live.resize(uint32_t(rect.width()), uint32_t(rect.height()));
    if (app.live.burn() && app.live.target.texture())
        list->AddImage(app.live.target.texture(), rect.low(), rect.high());
    endPanel();
}

void showViewport(App& app, const Rect& rect) {
    // The picture covers everything below it, so nothing is painted there.
    const bool covered = app.live.burn() && app.live.target.texture();
    ImDrawList* list = beginPanel("##view", rect, covered ? 0 : colors::gap);
    constexpr double kStill = 0.3;  // s without motion before the full-resolution picture
    if (mouseDrag().busy != MouseAction::kNone || ImGui::GetIO().MouseWheel != 0)
        app.movedAt = app.now;
    const bool moves = app.playing || app.live.isSeeking() || app.live.isPreviewing() ||
                       app.now - app.movedAt < kStill;
    if (!moves) app.pace = {.step = app.pace.step};
    const float sharpness = app.slow && moves ? chooseMovingResolution(app) : 1.0f;
    app.live.resize(uint32_t(std::max(8.0f, rect.width() * sharpness)),
                    uint32_t(std::max(8.0f, rect.height() * sharpness)));
    // The right half of a comparison is the current scene.
    Rect worked = rect;
    if (app.live.showsComparison()) worked.x0 = std::floor(rect.midX());
    const Picture picture{worked, app.live.view};
    if (app.live.burn() && app.live.target.texture())
        list->AddImage(app.live.target.texture(), rect.low(), rect.high());

    // A long preparation shows a cancel button.
    constexpr double kLong = 1;  // s
    if (!app.live.isPreparing())
        app.preparingSince = -1;
    else if (app.preparingSince < 0)
        app.preparingSince = app.now;
    const bool takesLong = app.preparingSince >= 0 && app.now - app.preparingSince > kLong;

    const bool ready =
        app.live.burn() && app.live.view.structSize != 0 && app.live.view.projection[0] != 0;
    if (!ready) {
        showPreparing(app, list, rect, takesLong);
        endPanel();
        return;
    }
    hit("view", worked.low(), {worked.width(), worked.height()});
    const bool hovered = ImGui::IsItemHovered();
    const std::vector<Marker> markers = markersOf(app, picture);
    const ImGuiIO& io = ImGui::GetIO();
    const ImVec2 mouse = io.MousePos;
    MouseDrag& state = mouseDrag();

    list->PushClipRect(worked.low(), worked.high(), true);
    Gizmo gizmo;
    Handles handles;
    glm::vec3 pivot(0);
    const bool turns = app.tool == Tool::kRotate;
    if (app.showHelpers) {
        drawOutlines(app, list, picture);
        drawMarkers(app, list, picture, markers);
        if (app.tool == Tool::kMove && !app.placing && pivotOf(app, pivot))
            gizmo = makeGizmo(picture, pivot);
        if ((turns || app.tool == Tool::kScale) && !app.placing && !vectorsOf(app, turns).empty() &&
            pivotOf(app, pivot))
            handles = makeHandles(picture, pivot);
    }
    const bool overBall = showNavigationBall(app, list, picture);
    const int hot = hovered && !overBall && !io.KeyAlt && state.busy == MouseAction::kNone
                        ? handles.there ? hitTest(handles, turns, mouse) : hitTest(gizmo, mouse)
                        : -1;
    const bool holds = state.busy == MouseAction::kTurn || state.busy == MouseAction::kStretch;
    drawHandles(list, handles, turns, holds ? state.axis : hot);
    drawGizmo(list, gizmo,
              state.busy == MouseAction::kAxis    ? state.axis
              : state.busy == MouseAction::kPlane ? 3 + state.axis
                                                  : hot);
    if (hovered && io.MouseWheel != 0) zoom(app, io.MouseWheel);

    if (state.busy == MouseAction::kNone && hovered && !overBall) {
        state.press = mouse;
        if (ImGui::IsMouseClicked(2)) state.busy = MouseAction::kPan;
        if (ImGui::IsMouseClicked(1))
            state.busy = app.placing ? MouseAction::kNone : MouseAction::kOrbit;
        if (ImGui::IsMouseClicked(1) && app.placing) app.placing = false;
        if (ImGui::IsMouseClicked(0)) {
            if (io.KeyAlt) {
                state.busy = MouseAction::kOrbit;
            } else if (!app.placing && hot >= 0 && handles.there) {
                state.axis = hot;
                state.busy = turns ? MouseAction::kTurn : MouseAction::kStretch;
                state.from = state.grip = pivot;
                state.done = 0;
                state.before = vectorsOf(app, turns);
                const fwview::Ray ray = picture.ray(mouse);
                if (turns) {
                    intersectPlane(ray, pivot, axisOf(hot), state.grip);
                } else if (hot < 3) {
                    findNearestOnAxis(ray, pivot, axisOf(hot), state.grip);
                }
            } else if (!app.placing && hot >= 0) {
                state.axis = hot % 3;
                state.busy = hot < 3 ? MouseAction::kAxis : MouseAction::kPlane;
                state.from = pivot;
                state.moved = glm::vec3(0);
                state.grip = pivot;
                const fwview::Ray ray = picture.ray(mouse);
                if (hot < 3) {
                    findNearestOnAxis(ray, pivot, axisOf(state.axis), state.grip);
                } else {
                    intersectPlane(ray, pivot, axisOf(state.axis), state.grip);
                }
            } else if (!app.placing) {
                state.busy = MouseAction::kClick;
            }
        }
    }
    if (app.placing && hovered && !overBall && !io.KeyAlt) placeSource(app, list, picture, mouse);
    switch (state.busy) {
        case MouseAction::kOrbit:
            orbit(app, io.MouseDelta);
            if (!io.MouseDown[0] && !io.MouseDown[1]) state.busy = MouseAction::kNone;
            break;
        case MouseAction::kPan:
            pan(app, picture, io.MouseDelta);
            if (!io.MouseDown[2]) state.busy = MouseAction::kNone;
            break;
        case MouseAction::kTurn:
        case MouseAction::kStretch:
            rotateOrScale(app, picture, list);
            if (!io.MouseDown[0]) {
                endMove(app);
                state.busy = MouseAction::kNone;
            }
            break;
        case MouseAction::kAxis:
        case MouseAction::kPlane:
            dragHandle(app, picture, list);
            if (!io.MouseDown[0]) {
                endMove(app);
                state.busy = MouseAction::kNone;
            }
            break;
        case MouseAction::kClick:
            if (std::hypot(mouse.x - state.press.x, mouse.y - state.press.y) > dp(4))
                state.busy = MouseAction::kBox;
            if (!io.MouseDown[0]) {
                pickAt(app, picture, markers, mouse);
                state.busy = MouseAction::kNone;
            }
            break;
        case MouseAction::kBox:
            list->AddRectFilled(state.press, mouse, faded(colors::accent, 0.12f));
            list->AddRect(state.press, mouse, colors::accent, 0, 0, hairline());
            if (!io.MouseDown[0]) {
                pickBox(app, picture, markers, state.press, mouse);
                state.busy = MouseAction::kNone;
            }
            break;
        case MouseAction::kNone:
            break;
    }
    drawPins(app, list, picture);
    list->PopClipRect();
    list->PushClipRect(rect.low(), rect.high(), true);
    const ImVec2 legend(worked.x0 + dp(12), rect.y1 - dp(68));
    if (app.multipliers && app.showHelpers) {
        drawMultiplierLegend(
            list, legend, worked.x1 - dp(12) - legend.x,
            app.live.overlaid.empty() ? "Burn multiplier: nothing is painted" : "Burn multiplier");
    } else if (app.burnTimes && app.showHelpers) {
        drawTimeLegend(app, list, legend);
    }
    drawHalves(app, list, rect, worked);
    showWhy(app, list, picture);
    if (app.live.isPreparing()) {
        float share = 0;
        const std::string stage = app.live.stage(share);
        const std::string text = stage.empty() ? "Preparing" : stage;
        drawChip(list, {rect.midX(), rect.y1 - dp(22)}, text.c_str());
        if (takesLong &&
            button("leave it", {rect.midX() - dp(40), rect.y1 - dp(66)}, dp(80, 26), "Cancel"))
            app.live.cancel();
    } else if (app.live.isCancelled()) {
        drawChip(list, {rect.midX(), rect.y1 - dp(22)}, "The last change is not shown");
        if (button("show it", {rect.midX() - dp(40), rect.y1 - dp(66)}, dp(80, 26), "Show it"))
            app.live.resume();
    }
    if (app.document.scene.meshes.empty() && app.document.scene.flames.empty() &&
        app.document.scene.emitters.empty()) {
        const ImVec2 low(rect.midX() - dp(150), rect.midY() - dp(62));
        drawBox(list, low, low + dp(300, 124), hex(0x1E1F22, 235), 8, colors::edge);
        drawTextCentred(list, fonts().semi, rect.midX(), low.y + dp(28), colors::title,
                        "An empty scene");
        drawTextCentred(list, fonts().small, rect.midX(), low.y + dp(50), colors::dim,
                        "Drop a glTF file here, or");
        if (button("import", {rect.midX() - dp(134), low.y + dp(76)}, dp(130, 30), "Import mesh",
                   ButtonKind::kPrimary, icons::importFrom))
            findAction(app, "Import mesh…")->run();
        if (button("flame", {rect.midX() + dp(4), low.y + dp(76)}, dp(130, 30), "Add a flame",
                   ButtonKind::kPlain, icons::firepit))
            findAction(app, "Add flame")->run();
    }
    list->PopClipRect();
    endPanel();
}

}  // namespace fwapp
