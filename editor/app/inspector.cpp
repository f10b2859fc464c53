#include "app/inspector.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "flamewright/flamewright.h"
#include "shell/icons.h"

namespace fwapp {

using namespace fwui;
using fwedit::FieldInfo;
using fwedit::FieldType;
using fwedit::Kind;
using fwedit::ObjectId;

namespace {

// Slider ranges where a field's limits exceed practical values, and number formats.
struct Range {
    const char* key;
    float low, high;
    const char* format;
    bool heat = false;
    const char* zero = nullptr;  // text for 0 if 0 has a special meaning
    bool percent = false;        // a share, shown as a percentage
};
constexpr Range kRanges[] = {{"output", 0, 60, "%.1f", true},
                             {"power", 0, 400, "%.1f", true},
                             {"radius", 0, 1, "%.3f"},
                             {"length", 0, 5, "%.2f"},
                             {"start", 0, 60, "%.1f"},
                             {"duration", 0, 120, "%.1f", false, "To the end"},
                             {"time", 0, 120, "%.1f"},
                             {"diameter", 0.002f, 3, "%.3f"},
                             {"thickness", 0, 0.1f, "%.3f", false, "As the material"},
                             {"moisture", 0, 1, "%.0f", false, "As the material", true},
                             {"speed", 0, 4, "%.2f"},
                             {"life", 0, 10, "%.2f", false, "By itself"},
                             {"cone", 0, 3.14f, "%.2f", false, "By itself"},
                             {"pace", 0.1f, 60, "%.1f"},
                             {"light", 0, 4, "%.2f"},
                             {"exposure", 0, 4, "%.2f"},
                             {"ground", -2, 2, "%.2f"},
                             {"texels_per_metre", 0, 1024, "%.0f"},
                             {"seed", 0, 1000, "%.0f"},
                             {"frames_per_second", 1, 120, "%.0f"},
                             {"map_size", 64, 2048, "%.0f"}};

NumberLook appearanceOf(const FieldInfo& field) {
    NumberLook look;
    look.unit = field.unit;
    look.least = float(field.low);
    look.most = float(field.high);
    if (field.type == FieldType::Whole) look.format = "%.0f";
    for (const Range& range : kRanges) {
        if (std::strcmp(range.key, field.key)) continue;
        look.lowest = std::max(range.low, look.least);
        look.highest = std::min(range.high, look.most);
        look.format = range.format;
        if (range.heat) look.fill = colors::heat;
        look.zero = range.zero;
        if (range.percent) {
            look.unit = "%";
            look.lowest *= 100;
            look.highest *= 100;
            look.least *= 100;
            look.most *= 100;
        }
        return look;
    }
    if (field.high - field.low <= 100 && field.type != FieldType::Vector) {
        look.lowest = float(field.low);
        look.highest = float(field.high);
    }
    return look;
}

std::string readableName(const char* key) {
    std::string text = key;
    std::replace(text.begin(), text.end(), '_', ' ');
    if (!text.empty()) text[0] = char(std::toupper(static_cast<unsigned char>(text[0])));
    return text;
}

// One undo step from press to release.
void applyEdit(App& app, ObjectId id, const char* key, const fwedit::Value& value, Edit edit) {
    if (edit == Edit::kDragging && !app.document.dragging) fwedit::beginDrag(app.document);
    if (edit == Edit::kDragging || edit == Edit::kTyped) performSet(app, id, key, value);
    if (edit == Edit::kDone && app.document.dragging) {
        fwedit::endDrag(app.document);
        setStatus(app, app.document.steps[app.document.at].name);
    }
}

void showObjectChoice(App& app, const Rows& rows, ObjectId id, const FieldInfo& field,
                      ObjectId chosen) {
    const fwedit::Object* object = fwedit::findObject(app.document.scene, chosen);
    dropdown(field.key, {rows.fieldX(), rows.y}, {rows.fieldWidth(), dp(metrics::row)},
             object ? object->name.c_str() : "Nothing", icons::link);
    if (!beginMenu(field.key, {rows.fieldX(), rows.y + dp(24)}, rows.fieldWidth())) return;
    if (menuItem("Nothing", nullptr, nullptr, true, chosen == 0))
        performSet(app, id, field.key, 0.0);
    const std::vector<fwedit::Mesh> meshes = app.document.scene.meshes;
    for (const fwedit::Mesh& mesh : meshes) {
        if (mesh.id == id) continue;
        ImGui::PushID(int(mesh.id));
        if (menuItem(mesh.name.c_str(), icons::crate, nullptr, true, mesh.id == chosen))
            performSet(app, id, field.key, double(mesh.id));
        ImGui::PopID();
    }
    endMenu();
}

// Returns the mesh whose nodes the field chooses from; 0: the field chooses no node.
ObjectId nodeHolder(const fwedit::Scene& scene, Kind kind, ObjectId id, const char* key) {
    if (kind == Kind::Mesh) return std::strcmp(key, "node") ? 0 : id;
    fwedit::Value parent;
    if (std::strcmp(key, "sticks_to_node") ||
        !fwedit::getField(scene, kind, id, "sticks_to", parent))
        return 0;
    const auto mesh = ObjectId(std::get<double>(parent));
    return fwedit::findIn(scene.meshes, mesh) ? mesh : 0;
}

// Returns the display name of a file's node.
std::string nodeLabel(const fwimport::ImportedModel& model, const std::string& node) {
    std::string ignored;
    const int32_t index = fwimport::findNode(model.nodes, node, ignored);
    if (index < 0) return node + " (gone)";
    const std::string& name = model.nodes[size_t(index)].name;
    return name.empty() ? "Part " + std::to_string(index) : name;
}

// Chooses a node of the file of `mesh` from its hierarchy.
void showNodeChoice(App& app, const Rows& rows, ObjectId id, const FieldInfo& field, ObjectId mesh,
                    const char* whole) {
    std::shared_ptr<const fwimport::ImportedModel> model;
    if (app.live.burn())
        for (const fwedit::BurnMesh& made : app.live.burn()->meshes)
            if (made.id == mesh) model = made.model;
    fwedit::Value value;
    Kind kind{};
    if (!fwedit::findObject(app.document.scene, id, &kind) ||
        !fwedit::getField(app.document.scene, kind, id, field.key, value))
        return;
    const std::string chosen = std::get<std::string>(value);
    const std::string shown = chosen.empty() ? whole : model ? nodeLabel(*model, chosen) : chosen;
    dropdown(field.key, {rows.fieldX(), rows.y}, {rows.fieldWidth(), dp(metrics::row)},
             shown.c_str(), icons::link);
    if (!beginMenu(field.key, {rows.fieldX(), rows.y + dp(24)}, rows.fieldWidth())) return;
    if (menuItem(whole, icons::crate, nullptr, true, chosen.empty()))
        performSet(app, id, field.key, std::string());
    for (size_t i = 0; model && i < model->nodes.size(); ++i) {
        const fwimport::ImportedNode& node = model->nodes[i];
        if (!node.inScene) continue;
        std::string ignored;
        const bool first =
            fwimport::findNode(model->nodes, node.name, ignored) == static_cast<int32_t>(i);
        const std::string named = first ? node.name : "#" + std::to_string(i);
        std::string label;
        for (int32_t above = node.parent; above >= 0; above = model->nodes[size_t(above)].parent)
            label += "   ";
        label += nodeLabel(*model, named);
        ImGui::PushID(int(i));
        if (menuItem(label.c_str(), nullptr, nullptr, true, named == chosen))
            performSet(app, id, field.key, named);
        ImGui::PopID();
    }
    endMenu();
}

void showField(App& app, Rows& rows, Kind kind, ObjectId id, const FieldInfo& field) {
    fwedit::Value value;
    if (!fwedit::getField(app.document.scene, kind, id, field.key, value)) return;
    const ImVec2 at(rows.fieldX(), rows.y), size(rows.fieldWidth(), dp(metrics::row));
    switch (field.type) {
        case FieldType::Flag: {
            bool on = std::get<double>(value) != 0;
            drawTextFit(rows.list, fonts().body, rows.x0, rows.midY(), rows.x1 - rows.x0 - dp(36),
                        colors::dim, field.label);
            if (toggle(field.key, {rows.x1 - dp(28), rows.y + dp(3)}, on))
                performSet(app, id, field.key, on ? 1.0 : 0.0);
            rows.next();
            break;
        }
        case FieldType::Whole:
        case FieldType::Number: {
            NumberLook look = appearanceOf(field);
            if (kind == Kind::Settings || kind == Kind::Event) look.zero = nullptr;
            if (kind == Kind::Emitter && !std::strcmp(field.key, "speed")) look.zero = "By itself";
            const double share = look.unit == std::string_view("%") && field.high <= 2 ? 100 : 1;
            auto number = float(std::get<double>(value) * share);
            const Edit edit = numberRow(rows, field.label, number, look);
            double wanted = double(number) / share;
            if (field.type == FieldType::Whole) wanted = std::round(wanted);
            if (edit != Edit::kNone) applyEdit(app, id, field.key, wanted, edit);
            break;
        }
        case FieldType::Choice: {
            std::vector<std::string> names;
            for (const char* word : field.choices) names.push_back(readableName(word));
            std::vector<const char*> shown;
            for (const std::string& name : names) shown.push_back(name.c_str());
            int chosen = int(std::get<double>(value));
            rows.label(field.label);
            if (choice(field.key, at, size, shown, chosen))
                performSet(app, id, field.key, double(chosen));
            rows.next();
            break;
        }
        case FieldType::Vector: {
            const auto& list = std::get<std::vector<double>>(value);
            float numbers[3];
            for (size_t i = 0; i < 3; ++i) numbers[i] = i < list.size() ? float(list[i]) : 0;
            NumberLook look = appearanceOf(field);
            look.snap = 0.05f;
            if (!std::strcmp(field.unit, "°")) {
                look.format = "%.0f°";
                look.unit = nullptr;
                look.step = 0.5f;
                look.snap = 15;
            }
            const Edit edit = vectorRow(rows, field.label, numbers, look);
            if (edit != Edit::kNone)
                applyEdit(
                    app, id, field.key,
                    std::vector<double>{double(numbers[0]), double(numbers[1]), double(numbers[2])},
                    edit);
            break;
        }
        case FieldType::Object:
            rows.label(field.label);
            showObjectChoice(app, rows, id, field, ObjectId(std::get<double>(value)));
            rows.next();
            break;
        case FieldType::Text: {
            rows.label(field.label);
            const ObjectId mesh = nodeHolder(app.document.scene, kind, id, field.key);
            if (mesh != 0) {
                showNodeChoice(app, rows, id, field, mesh,
                               mesh == id ? "The whole file" : "The whole of it");
                rows.next();
                break;
            }
            static ImGuiID editing = 0;  // static, since there is one keyboard
            static std::string text;
            const ImGuiID own = ImGui::GetID(field.key);
            if (editing != own) text = std::get<std::string>(value);
            std::string shown = editing == own ? text : std::get<std::string>(value);
            const bool done = textField(field.key, at, size, shown, "");
            if (ImGui::IsItemActive()) {
                editing = own;
                text = shown;
            }
            if (done && shown != std::get<std::string>(value))
                performSet(app, id, field.key, shown);
            if (done) editing = 0;
            rows.next();
            break;
        }
        case FieldType::File: {
            rows.label(field.label);
            const std::string file = std::get<std::string>(value);
            const std::string name = std::filesystem::path(file).filename().string();
            if (button(field.key, at, size, name.empty() ? "Choose…" : name.c_str())) {
                FileDialog dialog;
                dialog.title = field.label;
                dialog.act = "Choose";
                dialog.endings = kind == Kind::Mesh
                                     ? std::vector<std::string>{".glb", ".gltf"}
                                     : std::vector<std::string>{".fwprofile", ".png", ".exr"};
                App* open = &app;
                const std::string key = field.key;
                dialog.done = [open, id, key](const std::filesystem::path& chosen) {
                    performSet(*open, id, key.c_str(), chosen.string());
                };
                askFile(app, dialog);
            }
            tip(file.empty() ? field.label : file.c_str());
            rows.next();
            break;
        }
        case FieldType::Choices: {
            // For a mesh: the materials of the slots in use.
            const auto& list = std::get<std::vector<double>>(value);
            size_t slots = 1;
            if (app.live.burn()) {
                for (const fwedit::BurnMesh& mesh : app.live.burn()->meshes)
                    if (mesh.id == id) slots = mesh.slots;
            }
            std::vector<std::string> names;
            for (const char* word : field.choices) names.push_back(readableName(word));
            std::vector<const char*> shown;
            for (const std::string& name : names) shown.push_back(name.c_str());
            for (size_t i = 0; i < slots && i < list.size(); ++i) {
                const std::string label =
                    slots == 1 ? "Material" : "Material " + std::to_string(i + 1);
                int chosen = int(list[i]);
                rows.label(label.c_str());
                ImGui::PushID(int(i));
                if (choice(field.key, {rows.fieldX(), rows.y}, size, shown, chosen,
                           icons::material)) {
                    std::vector<double> changed = list;
                    changed[i] = chosen;
                    performSet(app, id, field.key, changed);
                }
                ImGui::PopID();
                rows.next();
            }
            break;
        }
        default:
            break;  // keys and rows have their own editors
    }
}

// Shows a factor over the scene's time as a polyline. Drag moves a point, double click adds one,
// right click removes one.
void showKeys(App& app, Rows& rows, Kind kind, ObjectId id, const FieldInfo& field) {
    fwedit::Value value;
    if (!fwedit::getField(app.document.scene, kind, id, field.key, value)) return;
    const auto list = std::get<std::vector<double>>(value);
    fwedit::Keys keys;
    for (size_t i = 0; i + 1 < list.size(); i += 2)
        keys.push_back({float(list[i]), float(list[i + 1])});
    constexpr float kHeight = 72;
    const float duration = std::max(0.1f, app.document.scene.settings.duration);
    float most = 2;
    for (const fwedit::Key& key : keys) most = std::max(most, key.value);
    const ImVec2 low(rows.x0, rows.y + dp(18)), high(rows.x1, rows.y + dp(18 + kHeight));
    const auto place = [&](const fwedit::Key& key) {
        return ImVec2(low.x + (high.x - low.x) * std::min(1.0f, key.time / duration),
                      high.y - dp(6) - (high.y - low.y - dp(12)) * key.value / most);
    };
    const auto keyAt = [&](ImVec2 at) {
        fwedit::Key key;
        key.time = duration * std::clamp((at.x - low.x) / (high.x - low.x), 0.0f, 1.0f);
        key.value =
            most * std::clamp((high.y - dp(6) - at.y) / (high.y - low.y - dp(12)), 0.0f, 1.0f);
        key.time = std::round(key.time * 100) / 100;
        key.value = std::round(key.value * 100) / 100;
        return key;
    };
    const auto performKey = [&](fwedit::Verb verb, const fwedit::Key& key) {
        fwedit::Command command;
        command.verb = verb;
        command.targets = {id};
        command.key = key;
        return perform(app, command);
    };
    ImDrawList* draw = rows.list;
    drawText(draw, fonts().body, rows.x0, rows.y + dp(8), colors::dim, field.label);
    const auto now = float(app.live.time());
    const bool keyed = std::any_of(keys.begin(), keys.end(), [&](const fwedit::Key& key) {
        return std::fabs(key.time - now) < 0.011f;
    });
    if (iconButton("key", {rows.x1 - dp(8), rows.y + dp(8)}, icons::add,
                   keyed ? colors::off : colors::text, "Key this moment") &&
        !keyed)
        performKey(fwedit::Verb::Key, {now, fwedit::valueAt(keys, now)});
    drawBox(draw, low, high, colors::well, 4);
    const float one = high.y - dp(6) - (high.y - low.y - dp(12)) / most;
    drawRow(draw, low.x, high.x, one, hex(0xFFFFFF, 26));
    drawTextRight(draw, fonts().small, high.x - dp(4), one - dp(8), colors::off, "1×");
    bool held = false, hovered = false;
    hit("keys", low, high - low, &hovered, &held);
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    static float heldTime = -1;  // time of the dragged key
    int near = -1;
    for (size_t i = 0; i < keys.size(); ++i) {
        const ImVec2 at = place(keys[i]);
        if (std::hypot(at.x - mouse.x, at.y - mouse.y) < dp(8)) near = int(i);
    }
    ImVec2 last(low.x, place({0, fwedit::valueAt(keys, 0)}).y);
    for (const fwedit::Key& key : keys) {
        draw->AddLine(last, place(key), colors::heat, dp(1.5f));
        last = place(key);
    }
    draw->AddLine(last, {high.x, last.y}, colors::heat, dp(1.5f));
    for (size_t i = 0; i < keys.size(); ++i) {
        const ImVec2 at = place(keys[i]);
        const bool lit = hovered && near == int(i);
        draw->AddCircleFilled(at, dp(lit ? 5 : 4), lit ? colors::white : colors::heat, 16);
    }
    const float head = low.x + (high.x - low.x) * std::min(1.0f, now / duration);
    drawColumn(draw, head, low.y, high.y, colors::accent);
    if (hovered && near >= 0 && ImGui::IsMouseClicked(1)) {
        performKey(fwedit::Verb::Unkey, keys[size_t(near)]);
    } else if (hovered && near < 0 && ImGui::IsMouseDoubleClicked(0)) {
        performKey(fwedit::Verb::Key, keyAt(mouse));
    } else if (hovered && near >= 0 && ImGui::IsMouseClicked(0)) {
        heldTime = keys[size_t(near)].time;
    }
    if (held && heldTime >= 0) {
        const fwedit::Key to = keyAt(mouse);
        const auto found = std::find_if(
            keys.begin(), keys.end(), [&](const fwedit::Key& key) { return key.time == heldTime; });
        if (found != keys.end() && !(*found == to)) {
            if (!app.document.dragging) fwedit::beginDrag(app.document);
            performKey(fwedit::Verb::Unkey, *found);
            performKey(fwedit::Verb::Key, to);
            heldTime = to.time;
        }
        char text[48];
        std::snprintf(text, sizeof text, "%s, %.2f×", clockText(double(to.time)).c_str(),
                      double(to.value));
        drawChip(draw, {mouse.x, low.y - dp(8)}, text);
    } else if (heldTime >= 0) {
        heldTime = -1;
        if (app.document.dragging) fwedit::endDrag(app.document);
    }
    if (keys.empty())
        drawTextCentred(draw, fonts().small, (low.x + high.x) * 0.5f, high.y - dp(14), colors::dim,
                        "Double-click to add a point");
    rows.y = high.y + dp(8);
}

enum class Part { kPlace, kMain, kTime, kMore };

Part sectionOf(Kind kind, const char* key) {
    auto is = [&](std::initializer_list<const char*> keys) {
        return std::any_of(keys.begin(), keys.end(),
                           [&](const char* one) { return !std::strcmp(one, key); });
    };
    if (kind == Kind::Settings) {
        if (is({"duration", "frames_per_second", "pace"})) return Part::kTime;
        if (is({"wind", "daylight", "light", "exposure"})) return Part::kMain;
        return Part::kMore;
    }
    if (is({"position", "rotation", "scale", "sticks_to", "sticks_to_node", "direction", "extent"}))
        return Part::kPlace;
    if (is({"start", "duration", "time", "keys"})) return Part::kTime;
    if (kind == Kind::Mesh && !is({"file", "materials", "moisture", "thickness"}))
        return Part::kMore;
    if (kind == Kind::Flame && is({"density", "blue", "smoke", "tint", "tint_weight", "core_tint",
                                   "core_tint_weight", "ignites"}))
        return Part::kMore;
    return Part::kMain;
}

// Returns true for fields that the object's shape or kind ignores.
bool isIgnored(const fwedit::Scene& scene, Kind kind, ObjectId id, const char* key) {
    auto is = [&](const char* one) { return !std::strcmp(one, key); };
    if (is("name") || is("hidden") || is("locked")) return true;
    if (kind == Kind::Event && is("note")) return false;
    if (kind == Kind::Source) {
        const fwedit::HeatSource* source = fwedit::findIn(scene.sources, id);
        if (!source) return false;
        const uint32_t shape = source->shape;
        const bool line = shape == fwedit::SourceLine || shape == fwedit::SourceRain;
        if (is("length")) return !line;
        if (is("direction"))
            return shape != fwedit::SourceLine && shape != fwedit::SourceFlamethrower &&
                   shape != fwedit::SourceDisc;
        if (is("output")) return shape == fwedit::SourceMatch;
        if (is("duration") || is("keys")) return shape == fwedit::SourceMatch;
    }
    if (kind == Kind::Emitter) {
        const fwedit::Emitter* emitter = fwedit::findIn(scene.emitters, id);
        if (!emitter) return false;
        if (is("extent")) return emitter->shape != fwedit::EmitterLine;
        if (is("radius")) return emitter->shape != fwedit::EmitterDisc;
        if (is("sticks_to_node") && emitter->shape == fwedit::EmitterMesh) return true;
    }
    if (kind == Kind::Collider) {
        const fwedit::Collider* collider = fwedit::findIn(scene.colliders, id);
        if (!collider) return false;
        const uint32_t shape = collider->shape;
        if (is("half_size") || is("shields")) return shape != fwedit::ColliderBox;
        if (is("radius")) return shape != fwedit::ColliderBall && shape != fwedit::ColliderCapsule;
        if (is("length")) return shape != fwedit::ColliderCapsule;
    }
    if (kind == Kind::Wind) {
        const fwedit::Wind* wind = fwedit::findIn(scene.winds, id);
        if (!wind) return false;
        if (is("position") || is("sticks_to") || is("flow") || is("falloff") || is("shelters"))
            return wind->shape == fwedit::WindEverywhere;
        if (is("half_size")) return wind->shape != fwedit::WindBox;
        if (is("radius")) return wind->shape != fwedit::WindBall && wind->shape != fwedit::WindFan;
        if (is("length")) return wind->shape != fwedit::WindFan;
    }
    if (is("sticks_to_node")) return nodeHolder(scene, kind, id, key) == 0;
    if (kind == Kind::Mesh && is("refine_depth")) {
        const fwedit::Mesh* mesh = fwedit::findIn(scene.meshes, id);
        return mesh && !mesh->refine;
    }
    return false;
}

bool hasFieldOf(const fwedit::Scene& scene, Kind kind, ObjectId id, Part part) {
    const auto fields = fwedit::fieldsOf(kind);
    return std::any_of(fields.begin(), fields.end(), [&](const FieldInfo& field) {
        return sectionOf(kind, field.key) == part && !isIgnored(scene, kind, id, field.key) &&
               field.type != FieldType::KeyList && field.type != FieldType::Rows;
    });
}

void showParts(App& app, Rows& rows, Kind kind, ObjectId id) {
    struct Heading {
        Part part;
        const char* name;
        bool* open;
    };
    const char* main = kind == Kind::Source     ? "Heat"
                       : kind == Kind::Mesh     ? "Material"
                       : kind == Kind::Flame    ? "Flame"
                       : kind == Kind::Emitter  ? "Fire"
                       : kind == Kind::Wind     ? "Wind"
                       : kind == Kind::Settings ? "Light and wind"
                                                : "Shape";
    const Heading headings[] = {{Part::kPlace, "Place", &app.placeOpen},
                                {Part::kMain, main, &app.mainOpen},
                                {Part::kTime, "Time", &app.timeOpen},
                                {Part::kMore, "More", &app.moreOpen}};
    for (const Heading& heading : headings) {
        if (!hasFieldOf(app.document.scene, kind, id, heading.part)) continue;
        if (!section(rows, heading.name, *heading.open)) continue;
        // The label column fits this section, within limits.
        float widest = dp(metrics::label);
        for (const FieldInfo& field : fwedit::fieldsOf(kind)) {
            if (sectionOf(kind, field.key) != heading.part || field.type == FieldType::Flag ||
                field.type == FieldType::Vector ||
                isIgnored(app.document.scene, kind, id, field.key))
                continue;
            widest = std::max(widest, textSize(fonts().body, field.label).x + dp(10));
        }
        rows.labelWidth = std::min(widest / theme().scale, 156.0f);
        for (const FieldInfo& field : fwedit::fieldsOf(kind)) {
            if (sectionOf(kind, field.key) != heading.part) continue;
            if (isIgnored(app.document.scene, kind, id, field.key)) continue;
            if (field.type == FieldType::KeyList) {
                showKeys(app, rows, kind, id, field);
            } else {
                showField(app, rows, kind, id, field);
            }
        }
        rows.y += dp(4);
    }
}

// The pinned spots, with the state of the fire at the shown time.
void showPins(App& app, Rows& rows) {
    std::vector<fwview::WhyCard>& pins = app.live.pins;
    if (pins.empty() || !section(rows, "Pinned spots", app.pinsOpen)) return;
    size_t closed = pins.size();
    for (size_t i = 0; i < pins.size(); ++i) {
        ImGui::PushID(int(i));
        const fwedit::Mesh* mesh = fwedit::findIn(app.document.scene.meshes, pins[i].mesh);
        const ImVec2 middle(rows.x0 + dp(9), rows.y + dp(10));
        rows.list->AddCircleFilled(middle, dp(9), colors::title, 24);
        drawTextCentred(rows.list, fonts().smallSemi, middle.x, middle.y, colors::gap,
                        std::to_string(i + 1).c_str());
        const float x = rows.x0 + dp(26), width = rows.x1 - x - dp(24);
        drawTextFit(rows.list, fonts().body, x, rows.y + dp(10), width, colors::title,
                    mesh ? mesh->name.c_str() : "Its mesh is gone");
        if (iconButton("unpin", {rows.x1 - dp(8), rows.y + dp(10)}, icons::close, colors::dim,
                       "Unpin"))
            closed = i;
        rows.y += dp(22);
        const std::string words = mesh ? describePin(app, pins[i]) : std::string();
        rows.y += drawTextWrapped(rows.list, fonts().small, {x, rows.y}, width, colors::text,
                                  words.c_str()) +
                  dp(8);
        ImGui::PopID();
    }
    if (closed < pins.size()) pins.erase(pins.begin() + std::ptrdiff_t(closed));
}

}  // namespace

void showInspector(App& app, Rect rect) {
    std::erase_if(app.selection,
                  [&](ObjectId id) { return !fwedit::findObject(app.document.scene, id); });
    const Rect head = rect.cutTop(dp(42));
    ImDrawList* list = beginPanel("##inspector head", head);
    list->AddRectFilled(head.low(), head.high(), colors::header);
    Kind kind = Kind::Settings;
    const ObjectId id = app.selection.size() == 1 ? app.selection[0] : 0;
    const fwedit::Object* object = fwedit::findObject(app.document.scene, id, &kind);
    const fwedit::Object shown = object ? *object : fwedit::Object{};
    if (!object) kind = Kind::Settings;
    const bool several = app.selection.size() > 1;
    const std::string title = object    ? shown.name
                              : several ? std::to_string(app.selection.size()) + " things"
                                        : std::string("Scene");
    drawIcon(list, fonts().icon20, head.low() + dp(20, 21),
             object ? colorOf(app.document.scene, kind, id) : colors::text,
             object ? iconOf(app.document.scene, kind, id) : icons::tune);
    drawTextFit(list, fonts().semi, head.x0 + dp(38), head.y0 + dp(14), head.width() - dp(130),
                colors::title, title.c_str());
    drawText(list, fonts().small, head.x0 + dp(38), head.y0 + dp(30), colors::dim,
             object    ? fwedit::kindLabel(kind)
             : several ? "Moved, duplicated and deleted together"
                       : "Time, light and wind of all of it");
    if (object) {
        if (iconButton("eye", {head.x1 - dp(64), head.midY()},
                       shown.hidden ? icons::eyeOff : icons::eye,
                       shown.hidden ? colors::off : colors::text, shown.hidden ? "Show" : "Hide"))
            performSet(app, id, "hidden", shown.hidden ? 0.0 : 1.0);
        if (iconButton("lock", {head.x1 - dp(40), head.midY()},
                       shown.locked ? icons::lock : icons::unlock, colors::text,
                       shown.locked ? "Unlock" : "Lock"))
            performSet(app, id, "locked", shown.locked ? 0.0 : 1.0);
        if (iconButton("delete", {head.x1 - dp(16), head.midY()}, icons::trash, colors::dim,
                       "Delete"))
            findAction(app, "Delete")->run();
    }
    endPanel();
    list = beginPanel("##inspector", rect, colors::panel, true);
    if (several) {
        drawIcon(list, fonts().icon34, {rect.midX(), rect.y0 + dp(70)}, colors::off, icons::layers);
        drawTextCentred(list, fonts().body, rect.midX(), rect.y0 + dp(104), colors::dim,
                        "Select one to edit it");
        if (button("duplicate", {rect.midX() - dp(98), rect.y0 + dp(124)}, dp(94, 28), "Duplicate"))
            findAction(app, "Duplicate")->run();
        if (button("delete", {rect.midX() + dp(4), rect.y0 + dp(124)}, dp(94, 28), "Delete",
                   ButtonKind::kDanger))
            findAction(app, "Delete")->run();
        endPanel();
        return;
    }
    ImGui::PushID(int(id));
    Rows rows{list, rect.x0 + dp(10), rect.x1 - dp(10), rect.y0 - ImGui::GetScrollY()};
    showPins(app, rows);
    showParts(app, rows, kind, id);
    ImGui::SetCursorScreenPos({rect.x0, rows.y + dp(8)});
    ImGui::Dummy({1, 1});
    ImGui::PopID();
    // A drag whose field vanished (object deleted) ends.
    if (app.document.dragging && !ImGui::IsAnyMouseDown()) fwedit::endDrag(app.document);
    endPanel();
}

}  // namespace fwapp
