// Exports a scene as code, with one function per object. Timed events are applied before each
// frame. Numbers print without loss and are combined as in burn.cpp, so that the game's fire equals
// the editor's.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <set>

#include "document/fields.h"
#include "document/world_parts.h"
#include "output/output.h"

namespace fwedit {
namespace {

std::string number(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}

std::string literal(float value) {
    std::string text = number(static_cast<double>(value));
    if (text.find_first_of(".en") == std::string::npos) text += ".0";
    return text + "f";
}
std::string literal(uint32_t value) { return std::to_string(value) + "u"; }
std::string literal(uint64_t value) { return std::to_string(value) + "u"; }

std::string seconds(double value) {
    const std::string text = number(value);
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string words(const std::string& text) {
    std::string safe;
    for (const char c : text)
        if (c != '\\' && static_cast<unsigned char>(c) >= 32)
            safe += c == '/' || c == '*' ? ' ' : c;
    return safe;
}

// `%` stands for the part that differs between the languages.
struct Dialect {
    bool cpp;
    const char *scene, *argument, *member, *world, *folder, *copy, *null;
};
constexpr Dialect kC = {false,          "CrateYard* scene",   "scene",  "scene->",
                        "scene->world", "const char* folder", "memcpy", "NULL"};
constexpr Dialect kCpp = {true,
                          "CrateYard& scene",
                          "scene",
                          "scene.",
                          "scene.world.get()",
                          "const std::filesystem::path& folder",
                          "std::memcpy",
                          "nullptr"};

// The fields of a def that differ from the defaults, one per line.
class Fields {
 public:
    Fields(std::string& out, const char* copy) : out_(out), copy_(copy) {}

    template <typename T>
    void one(const char* name, T value, T standard) {
        if (value != standard) line(std::string("def.") + name + " = " + literal(value));
    }
    template <size_t N>
    void list(const char* name, const float (&values)[N], const float (&standard)[N]) {
        if (std::equal(values, values + N, standard)) return;
        out_ += "    {\n        static const float values[" + std::to_string(N) + "] = {";
        for (size_t i = 0; i < N; ++i)
            out_ += (i == 0                ? N > 8 ? "\n            " : ""
                     : N > 8 && i % 4 == 0 ? ",\n            "
                                           : ", ") +
                    literal(values[i]);
        out_ += "};\n        " + std::string(copy_) + "(def." + name +
                ", values, sizeof values);\n    }\n";
    }
    void line(const std::string& text) { out_ += "    " + text + ";\n"; }

 private:
    std::string& out_;
    const char* copy_;
};

#define FW_ONE(name) fields.one(#name, def.name, standard.name)
#define FW_LIST(name) fields.list(#name, def.name, standard.name)

void printFields(Fields& fields, const FwWorldDef& def) {
    const FwWorldDef standard = fwDefaultWorldDef();
    FW_ONE(flags);
    FW_LIST(up);
    FW_ONE(paceFactor);
    FW_LIST(wind);
    FW_ONE(seed);
    FW_ONE(maxStepsPerFrame);
    FW_ONE(maxRefinedTriangles);
}

void printFields(Fields& fields, const FwBurnableMeshDef& def) {
    const FwBurnableMeshDef standard = fwDefaultBurnableMeshDef();
    FW_ONE(flags);
    FW_LIST(transform);
    FW_ONE(moisture);
    FW_LIST(tint);
    FW_ONE(refineDepth);
    FW_ONE(ground);
    FW_ONE(spreadChance);
    FW_ONE(userData);
}

void printFields(Fields& fields, const FwVolumetricFireDef& def) {
    const FwVolumetricFireDef standard = fwDefaultVolumetricFireDef();
    FW_ONE(flags);
    FW_ONE(preset);
    FW_ONE(seed);
    FW_LIST(position);
    FW_ONE(diameter);
    FW_ONE(power);
    FW_ONE(windResponse);
    FW_ONE(turbulence);
    FW_ONE(speed);
    FW_ONE(density);
    FW_ONE(smoke);
    FW_ONE(blue);
    FW_LIST(tint);
    FW_ONE(tintWeight);
    FW_LIST(coreTint);
    FW_ONE(coreTintWeight);
}

void printFields(Fields& fields, const FwFireEmitterDef& def) {
    const FwFireEmitterDef standard = fwDefaultFireEmitterDef();
    FW_ONE(flags);
    FW_ONE(shape);
    FW_ONE(seed);
    FW_LIST(position);
    FW_LIST(direction);
    FW_LIST(extent);
    FW_ONE(radius);
    FW_ONE(power);
    FW_ONE(speed);
    FW_ONE(cone);
    FW_ONE(life);
    FW_ONE(smoke);
    FW_ONE(sparks);
    FW_ONE(windResponse);
    FW_ONE(turbulence);
}

void printFields(Fields& fields, const FwFireColliderDef& def) {
    const FwFireColliderDef standard = fwDefaultFireColliderDef();
    FW_ONE(kind);
    FW_LIST(position);
    FW_LIST(end);
    FW_LIST(halfSize);
    FW_LIST(rotation);
    FW_LIST(normal);
    FW_ONE(radius);
}

void printFields(Fields& fields, const FwWindZoneDef& def) {
    const FwWindZoneDef standard = fwDefaultWindZoneDef();
    FW_ONE(shape);
    FW_ONE(flow);
    FW_ONE(blend);
    FW_LIST(position);
    FW_LIST(axis);
    FW_LIST(size);
    FW_ONE(speed);
    FW_ONE(falloff);
}

void printFields(Fields& fields, const FwHeatOccluderDef& def) {
    const FwHeatOccluderDef standard = fwDefaultHeatOccluderDef();
    FW_LIST(transform);
    FW_LIST(halfSize);
}

#undef FW_ONE
#undef FW_LIST

// "painted_wood"; the constant is FW_MATERIAL_PAINTED_WOOD.
std::string materialWord(uint32_t preset) {
    return materialWords()[std::min<uint32_t>(preset, FW_MATERIAL_PRESET_COUNT - 1)];
}
std::string materialConstant(uint32_t preset) {
    std::string word = "FW_MATERIAL_" + materialWord(preset);
    std::transform(word.begin(), word.end(), word.begin(),
                   [](unsigned char c) { return char(std::toupper(c)); });
    return word;
}

// The library's flipbooks that emitters show, as in burn.cpp.
struct FlipbookMember {
    const char *member, *preset, *slot;
};
constexpr FlipbookMember kFlipbooks[] = {
    {"roll_flipbook", "FW_FLIPBOOK_ROLL", "fireFlipbooks[0]"},
    {"puff_flipbook", "FW_FLIPBOOK_PUFF", "fireFlipbooks[1]"},
    {"smoke_flipbook", "FW_FLIPBOOK_SMOKE", "smokeFlipbooks[0]"},
    {"spark_flipbook", "FW_FLIPBOOK_SPARK", "sparkFlipbook"}};

class Writer {
 public:
    Writer(const OutputPlan& plan, const Dialect& dialect)
        : scene_(plan.scene), plan_(plan), is_(dialect) {}

    std::string write() {
        addShared();
        for (const PlannedMesh& mesh : plan_.meshes) addMesh(mesh);
        for (const HeatSource& source : scene_.sources) addSource(source);
        for (const Flame& flame : scene_.flames) addFlame(flame);
        for (const Emitter& emitter : scene_.emitters) addEmitter(emitter);
        for (const Collider& collider : scene_.colliders) addCollider(collider);
        for (const Wind& wind : scene_.winds)
            if (!wind.hidden || wind.shape == WindEverywhere)
                wind.shape == WindEverywhere ? addGust(wind) : addZone(wind);
        const std::string create = createFunction(), advance = advanceFunctions();
        std::string text =
            head() + members() + helpers() + functions_ + advance + moveFunctions() + create;
        if (!is_.cpp)
            text += "void " + named("destroy") + "(" + is_.scene +
                    ") {\n    fwDestroyWorld(scene->world);\n    scene->world = NULL;\n}\n";
        // The dialects use CrateYard as a placeholder for the scene's type.
        for (size_t at = 0; (at = text.find("CrateYard", at)) != std::string::npos;
             at += plan_.type.size())
            text.replace(at, 9, plan_.type);
        return text;
    }

 private:
    std::string nameOf(ObjectId id) const { return plan_.identifiers.at(id); }
    std::string named(const char* act) const {
        return is_.cpp ? std::string(act) : plan_.identifier + "_" + act;
    }
    std::string in(const std::string& member) const { return is_.member + member; }
    std::string world() const { return is_.world; }
    void member(const std::string& type, const std::string& name) {
        members_ += "    " + type + " " + name + ";\n";
    }

    // Opens a function that adds one object; `reads`: it needs the folder.
    void open(const std::string& function, bool reads, const std::string& what) {
        calls_ += "    if (result >= 0) result = " + function + "(" + is_.argument +
                  (reads ? ", folder" : "") + ");\n";
        functions_ += "/* " + words(what) + " */\nstatic FwResult " + function + "(" + is_.scene +
                      (reads ? std::string(", ") + is_.folder : "") + ") {\n";
    }
    void line(const std::string& text) { functions_ += "    " + text + "\n"; }
    template <typename Def>
    void def(const char* type, const Def& made) {
        line(std::string("Fw") + type + "Def def = fwDefault" + type + "Def();");
        Fields fields(functions_, is_.copy);
        printFields(fields, made);
    }

    void addShared() {
        std::set<std::string> seen;
        std::string body;
        for (const PlannedMesh& planned : plan_.meshes) {
            const Mesh& mesh = *findIn(scene_.meshes, planned.mesh);
            for (const uint32_t preset : mesh.materials) {
                const std::string name = material(preset, mesh.thickness, planned.ownColors);
                if (!seen.insert(name).second) continue;
                member("FwMaterialId", name);
                body += "    fwInitMaterialPreset(&def, " + materialConstant(preset) + ");\n";
                if (planned.ownColors)
                    body += "    def.baseColor[0] = def.baseColor[1] = def.baseColor[2] = 1.0f;\n";
                if (mesh.thickness > 0)
                    body += "    def.thickness = " + literal(mesh.thickness) + ";\n";
                body += "    if (result >= 0) result = fwWorld_CreateMaterial(" + world() +
                        ", &def, &" + in(name) + ");\n";
            }
        }
        if (!seen.empty()) {
            open("add_materials", false, "Materials.");
            functions_ +=
                "    FwMaterialDef def = fwDefaultMaterialDef();\n"
                "    FwResult result = FW_OK;\n" +
                body + "    return result;\n}\n\n";
        }
        if (!plan_.images.empty()) addImages();
        const bool flipbooks =
            std::any_of(scene_.emitters.begin(), scene_.emitters.end(),
                        [](const Emitter& one) { return one.flipbooks; }) ||
            std::any_of(scene_.sources.begin(), scene_.sources.end(),
                        [](const HeatSource& one) { return one.shape == SourceFlamethrower; });
        if (!flipbooks) return;
        open("add_flipbooks", false, "Flipbooks of the particles, from the library.");
        line("FwFlipbookDef def = fwDefaultFlipbookDef();");
        line("FwResult result = FW_OK;");
        for (const FlipbookMember& flipbook : kFlipbooks) {
            member("FwFlipbookId", flipbook.member);
            line(std::string("def.preset = ") + flipbook.preset + ";");
            line("if (result >= 0) result = fwWorld_CreateFlipbook(" + world() + ", &def, &" +
                 in(flipbook.member) + ");");
        }
        functions_ += "    return result;\n}\n\n";
    }

    void addImages() {
        reads_ = true;
        member("FwImageId", "colors[" + std::to_string(plan_.images.size()) + "]");
        open("add_images", true, "Images of the unburnt objects.");
        line("FwImageDef def = fwDefaultImageDef();");
        line("FwResult result = FW_OK;");
        if (!is_.cpp) {
            line("void* bytes;");
            line("uint64_t size;");
        }
        const bool cutOuts = std::any_of(plan_.images.begin(), plan_.images.end(),
                                         [](const auto& one) { return one.alphaCutoff > 0; });
        for (size_t i = 0; i < plan_.images.size(); ++i) {
            const PlannedImage& image = plan_.images[i];
            functions_ += openFile(image.file, i == 0, false);
            line("def.width = " + literal(image.width) + ";");
            line("def.height = " + literal(image.height) + ";");
            line(std::string("def.pixels = ") + (is_.cpp ? "bytes.data();" : "bytes;"));
            if (cutOuts) line("def.alphaCutoff = " + literal(image.alphaCutoff) + ";");
            line("result = " + sizeIs(uint64_t{4} * image.width * image.height) +
                 " ? fwWorld_CreateImage(" + world() + ", &def, &" +
                 in("colors[" + std::to_string(i) + "]") + ") : FW_ERROR_BAD_DATA;");
            closeFile();
            line("if (result < 0) return result;");
        }
        functions_ += "    return result;\n}\n\n";
    }

    // Emits code that reads a file into `bytes` and returns on failure.
    std::string openFile(const std::string& file, bool first, bool declares) const {
        if (is_.cpp)
            return std::string("    ") + (first ? "std::vector<char> " : "") +
                   "bytes = read_file(folder / \"" + file + "\");\n" +
                   "    if (bytes.empty()) return FW_ERROR_BAD_DATA;\n";
        return std::string(declares ? "    uint64_t size = 0;\n    void* bytes = "
                                    : "    bytes = ") +
               "read_file(folder, \"" + file +
               "\", &size);\n    if (!bytes) return FW_ERROR_BAD_DATA;\n";
    }
    void closeFile() {
        if (!is_.cpp) line("free(bytes);");
    }
    std::string sizeIs(uint64_t bytes) const {
        return std::string(is_.cpp ? "bytes.size()" : "size") + " == " + std::to_string(bytes);
    }

    // `colored`: base colour 1, for meshes with their own colours.
    std::string material(uint32_t preset, float thickness, bool colored) const {
        std::string name = materialWord(preset);
        if (colored) name += "_colored";
        if (thickness <= 0) return "material_" + name;
        std::string size = number(static_cast<double>(thickness));
        for (char& c : size)
            if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
        return "material_" + name + "_" + size;
    }

    void addMesh(const PlannedMesh& planned) {
        const Mesh& mesh = *findIn(scene_.meshes, planned.mesh);
        const std::string name = nameOf(mesh.id);
        if (planned.ownsMap) {
            reads_ = true;
            member("FwMeshId", planned.mapIdentifier);
            open("load_" + planned.mapIdentifier, true, planned.map + ": where fire can go.");
            line("FwMeshDef def = fwDefaultMeshDef();");
            line("FwResult result;");
            functions_ += openFile(planned.map, true, true);
            if (is_.cpp) {
                line("def.cooked = bytes.data();");
                line("def.cookedSize = bytes.size();");
            } else {
                line("def.cooked = bytes;");
                line("def.cookedSize = size;");
            }
            line("result = fwWorld_CreateMesh(" + world() + ", &def, &" +
                 in(planned.mapIdentifier) + ");");
            closeFile();
            functions_ += "    return result;\n}\n\n";
        }
        const bool painted = !planned.multiplier.empty();
        reads_ = reads_ || painted;
        member("FwBurnableMeshId", name);
        open("add_" + name, painted, mesh.name);
        FwBurnableMeshDef made = burnableDefOf(mesh);
        made.ground = scene_.settings.ground;
        if (planned.twoSided) made.flags |= static_cast<uint32_t>(FW_BURNABLE_TWO_SIDED);
        def("BurnableMesh", made);
        line("FwResult result;");
        line("def.mesh = " + in(planned.mapIdentifier) + ";");
        for (size_t slot = 0; slot < 8; ++slot) {
            const std::string at = "[" + std::to_string(slot) + "] = ";
            line("def.materials" + at +
                 in(material(mesh.materials[slot], mesh.thickness, planned.ownColors)) + ";");
            if (planned.images[slot] >= 0)
                line("def.baseColors" + at +
                     in("colors[" + std::to_string(planned.images[slot]) + "]") + ";");
        }
        if (!mesh.pins.empty()) addPins(mesh);
        if (painted) {
            functions_ += openFile(planned.multiplier, true, true);
            line(std::string("def.multiplier = ") +
                 (is_.cpp ? "reinterpret_cast<const uint8_t*>(bytes.data());"
                          : "(const uint8_t*)bytes;"));
            line("def.multiplierWidth = " + literal(planned.width) + ";");
            line("def.multiplierHeight = " + literal(planned.height) + ";");
        }
        const std::string create =
            "fwWorld_CreateBurnableMesh(" + world() + ", &def, &" + in(name) + ")";
        line("result = " +
             (painted ? sizeIs(uint64_t{planned.width} * planned.height) + " ? " + create +
                            " : FW_ERROR_BAD_DATA"
                      : create) +
             ";");
        if (painted) closeFile();
        functions_ += "    return result;\n}\n\n";
    }

    void addPins(const Mesh& mesh) {
        line("static const FwPin pins[" + std::to_string(mesh.pins.size()) + "] = {");
        for (const auto& pin : mesh.pins) {
            std::string row = "    {{";
            for (size_t i = 0; i < 7; ++i)
                row += (i == 0 ? "" : i == 3 ? "}, {" : i == 6 ? "}, " : ", ") + literal(pin[i]);
            line(row + ", 0.0f},");
        }
        line("};");
        line("def.pins = pins;");
        line("def.pinCount = " + literal(static_cast<uint32_t>(mesh.pins.size())) + ";");
    }

    void addSource(const HeatSource& source) {
        if (source.shape == SourceMatch) return addMatch(source);
        if (source.shape == SourceRain || source.shape == SourceWater) return addWater(source);
        const std::string name = nameOf(source.id);
        if (source.shape == SourceFlamethrower) {
            const FwFireEmitterDef made = jetDefOf(scene_, source);
            emitter(source.id, source.name, made, true, 0);
            carry(source.id, "fwWorld_MoveFireEmitter", in(name), made.position, made.direction);
            power(source, source.output, "fwWorld_SetFireEmitterPower", in(name));
            return;
        }
        const std::vector<FwVolumetricFireDef> fires = sourceFiresOf(scene_, source);
        member("FwVolumetricFireId", name + "[" + std::to_string(fires.size()) + "]");
        for (size_t i = 0; i < fires.size(); ++i) {
            const std::string at = "[" + std::to_string(i) + "]";
            open("add_" + name + (fires.size() > 1 ? "_" + std::to_string(i + 1) : ""), false,
                 source.name);
            def("VolumetricFire", fires[i]);
            line("return fwWorld_CreateVolumetricFire(" + world() + ", &def, &" + in(name) + at +
                 ");");
            functions_ += "}\n\n";
            carry(source.id, "fwWorld_MoveVolumetricFire", in(name) + at, fires[i].position);
            power(source, 1 / static_cast<float>(fires.size()) * source.output,
                  "fwWorld_SetVolumetricFirePower", in(name) + at);
        }
    }

    void addFlame(const Flame& flame) {
        const std::string name = nameOf(flame.id);
        const auto shape = plan_.shapes.find(flame.id);
        const bool shaped = shape != plan_.shapes.end();
        member("FwVolumetricFireId", name);
        open("add_" + name, shaped, flame.name);
        def("VolumetricFire", fireDefOf(scene_, flame));
        if (shaped) {
            reads_ = true;
            line("FwFireProfileDef shape = fwDefaultFireProfileDef();");
            line("FwResult result;");
            functions_ += openFile(shape->second, true, true);
            line(std::string("shape.cooked = ") + (is_.cpp ? "bytes.data();" : "bytes;"));
            line(std::string("shape.cookedSize = ") + (is_.cpp ? "bytes.size();" : "size;"));
            line("result = fwWorld_CreateFireProfile(" + world() + ", &shape, &def.profile);");
            closeFile();
            line("if (result < 0) return result;");
        }
        line("return fwWorld_CreateVolumetricFire(" + world() + ", &def, &" + in(name) + ");");
        functions_ += "}\n\n";
        power(flame, flame.power, "fwWorld_SetVolumetricFirePower", in(name));
    }

    void emitter(ObjectId id, const std::string& called, const FwFireEmitterDef& made,
                 bool flipbooks, ObjectId object) {
        const std::string name = nameOf(id);
        member("FwFireEmitterId", name);
        open("add_" + name, false, called);
        def("FireEmitter", made);
        for (const FlipbookMember& flipbook : kFlipbooks)
            if (flipbooks)
                line(std::string("def.") + flipbook.slot + " = " + in(flipbook.member) + ";");
        if (object) line("def.object = " + in(nameOf(object)) + ";");
        line("return fwWorld_CreateFireEmitter(" + world() + ", &def, &" + in(name) + ");");
        functions_ += "}\n\n";
    }

    void addEmitter(const Emitter& one) {
        const bool sticks = findIn(scene_.meshes, one.sticksTo) != nullptr;
        if (one.shape == EmitterMesh && !sticks)
            return;  // a mesh emitter without a mesh has no
                     // fire
        const FwFireEmitterDef made = emitterDefOf(scene_, one);
        emitter(one.id, one.name, made, one.flipbooks, sticks ? one.sticksTo : 0);
        if (one.shape != EmitterMesh)
            carry(one.id, "fwWorld_MoveFireEmitter", in(nameOf(one.id)), made.position,
                  made.direction);
        power(one, one.power, "fwWorld_SetFireEmitterPower", in(nameOf(one.id)));
    }

    void addCollider(const Collider& collider) {
        const std::string name = nameOf(collider.id);
        member("FwFireColliderId", name);
        open("add_" + name, false, collider.name);
        def("FireCollider", colliderDefOf(scene_, collider));
        line("return fwWorld_AddFireCollider(" + world() + ", &def, &" + in(name) + ");");
        functions_ += "}\n\n";
        if (!collider.shields || collider.shape != ColliderBox) return;
        member("FwHeatOccluderId", name + "_shield");
        open("occlusion_" + name, false, collider.name + ": heat and embers do not pass either.");
        def("HeatOccluder", heatOccluderDefOf(scene_, collider));
        line("return fwWorld_AddHeatOccluder(" + world() + ", &def, &" + in(name + "_shield") +
             ");");
        functions_ += "}\n\n";
    }

    // ---- timed events

    void addMatch(const HeatSource& match) {
        const Vec3 at = worldPosition(scene_, match.id);
        advance_ += "    if (from <= " + seconds(static_cast<double>(match.start)) + " && to > " +
                    seconds(static_cast<double>(match.start)) + ") { /* " + words(match.name) +
                    " */\n        FwIgnitionDef def = fwDefaultIgnitionDef();\n" + position(at) +
                    "        def.radius = " + literal(match.radius) + ";\n        def.delay = " +
                    toFloat(seconds(static_cast<double>(match.start)) + " - from") +
                    ";\n        result = fwWorld_Ignite(" + world() + ", &def, " + is_.null +
                    ");\n        if (result < 0) return result;\n    }\n";
    }

    void addWater(const HeatSource& source) {
        pours_ = times_ = true;
        const Vec3 at = worldPosition(scene_, source.id);
        const float fall = source.shape == SourceRain ? source.length : 0;
        std::string place;
        for (const float part : at) place += (place.empty() ? "" : ", ") + literal(part);
        advance_ += "    { /* " + words(source.name) + " */\n" + keyTable(source.keys, "        ") +
                    "        static const float place[3] = {" + place + "};\n" +
                    "        double at = ceil(from / kWateringStep) * kWateringStep;\n" +
                    "        for (; at < to; at += kWateringStep) {\n" +
                    "            result = pour(" + world() + ", place, " + literal(fall) + ", " +
                    literal(std::max(source.radius, 0.01f)) + ", " + literal(source.output) +
                    " * " + factor(source, "at") + ", at, at - from);\n" +
                    "            if (result < 0) return result;\n        }\n    }\n";
    }

    void addGust(const Wind& wind) {
        times_ = gusts_ = true;
        std::string velocity;
        for (const float part : wind.velocity)
            velocity += (velocity.empty() ? "" : ", ") + literal(part);
        blow_ += "    { /* " + words(wind.name) + " */\n" + keyTable(wind.keys, "        ") +
                 "        static const float velocity[3] = {" + velocity +
                 "};\n        const float share = " + factor(wind, "from") +
                 ";\n        for (int i = 0; i < 3; ++i)\n"
                 "            wind[i] = within(wind[i] + velocity[i] * share, " +
                 literal(kMaxWind) + ");\n    }\n";
    }

    void addZone(const Wind& wind) {
        const std::string name = nameOf(wind.id);
        const bool changes = wind.start > 0 || wind.duration > 0 || !wind.keys.empty();
        const FwWindZoneDef made = windZoneDefOf(scene_, wind, 1);
        member("FwWindZoneId", name);
        if (changes) member("FwWindZoneDef", name + "_zone");
        open("add_" + name, false, wind.name);
        def("WindZone", made);
        if (changes) line(in(name + "_zone") + " = def;");
        line("return fwWorld_CreateWindZone(" + world() + ", &def, &" + in(name) + ");");
        functions_ += "}\n\n";
        if (!changes) return;
        times_ = parts_ = true;
        powers_ += "    { /* " + words(wind.name) + " */\n" + keyTable(wind.keys, "        ") +
                   "        FwResult result;\n        " + in(name + "_zone") + ".speed = within(" +
                   literal(made.speed) + " * " + factor(wind, "time") + ", " + literal(kMaxWind) +
                   ");\n        result = fwWorld_SetWindZone(" + world() + ", " + in(name) + ", &" +
                   in(name + "_zone") + ");\n        if (result < 0) return result;\n    }\n";
    }

    // Objects that stick to a mesh move with it when the game moves it.
    void carry(ObjectId id, const std::string& function, const std::string& part,
               const float (&position)[3], const float* direction = nullptr) {
        const Mesh* mesh = meshHolding(scene_, id);
        if (!mesh) return;
        const Pose pose = transformOf(*mesh);
        const auto list = [](const Vec3& v) {
            return "{" + literal(v[0]) + ", " + literal(v[1]) + ", " + literal(v[2]) + "}";
        };
        std::string& text = carried_[mesh->id];
        text += "    if (result >= 0) {\n        static const float own[3] = " +
                list(positionWithin(pose, {position[0], position[1], position[2]})) + ";\n";
        if (direction)
            text += "        static const float ahead[3] = " +
                    list(offsetWithin(pose, {direction[0], direction[1], direction[2]})) +
                    ";\n        float direction[3];\n        within_pose(transform, ahead, 0, "
                    "direction);\n";
        text += "        within_pose(transform, own, 1, place);\n        result = " + function +
                "(" + world() + ", " + part + ", place" + (direction ? ", direction" : "") +
                ");\n    }\n";
    }
    std::string moveFunctions() const {
        std::string text;
        for (const auto& [id, parts] : carried_)
            text +=
                "/* " + words(findIn(scene_.meshes, id)->name) +
                ": moves it and everything that sticks to it (object to world, column-major). */\n"
                "FwResult " +
                named(("move_" + nameOf(id)).c_str()) + "(" + is_.scene +
                ", const float transform[16]) {\n    float place[3];\n    FwResult result = "
                "fwWorld_SetTransform(" +
                world() + ", " + in(nameOf(id)) + ", transform);\n" + parts +
                "    return result;\n}\n\n";
        return text;
    }

    // Emits the output over time for objects with times or keys.
    template <typename T>
    void power(const T& object, float output, const std::string& function, const std::string& id) {
        if (object.start <= 0 && object.duration <= 0 && object.keys.empty()) return;
        times_ = parts_ = true;
        powers_ += "    { /* " + words(object.name) + " */\n" + keyTable(object.keys, "        ") +
                   "        const float power = within(" + literal(output) + " * " +
                   factor(object, "time") + ", " + literal(kMaxPower) + ");\n        " +
                   "const FwResult result = " + function + "(" + world() + ", " + id +
                   ", power);\n        if (result < 0) return result;\n    }\n";
    }

    static std::string keyTable(const Keys& keys, const std::string& indent) {
        if (keys.empty()) return "";
        std::string text = indent + "static const float keys[][2] = {";
        for (size_t i = 0; i < keys.size(); ++i)
            text += (i == 0 ? "{" : ", {") + literal(keys[i].time) + ", " + literal(keys[i].value) +
                    "}";
        return text + "};\n";
    }
    template <typename T>
    std::string factor(const T& object, const std::string& time) const {
        return "factor_at(" + toFloat(time) + ", " + literal(object.start) + ", " +
               literal(object.duration) + ", " + (object.keys.empty() ? is_.null : "keys") + ", " +
               std::to_string(object.keys.size()) + ")";
    }
    std::string toFloat(const std::string& value) const {
        return is_.cpp ? "static_cast<float>(" + value + ")" : "(float)(" + value + ")";
    }
    static std::string position(const Vec3& at) {
        std::string text;
        for (size_t i = 0; i < 3; ++i)
            text += "        def.position[" + std::to_string(i) + "] = " + literal(at[i]) + ";\n";
        return text;
    }

    // ---- parts of the file

    std::string head() const {
        const std::string create = named("create"), advance = named("advance");
        const std::string world = is_.cpp ? "scene.world.get()" : "scene.world";
        const std::string at = is_.cpp ? "scene" : "&scene";
        return "/* " + plan_.identifier +
               ": a scene of the Flamewright editor. Compile this file with your game. Its files "
               "are in one folder,\n * as the editor wrote them.\n * Once, with your "
               "context: " +
               create + "(context, \"FOLDER\", " + at + ");\n * Before each frame: " + advance +
               "(" + at + ", seconds); then record " + world +
               " as any world\n * (fwWorld_RecordOutside), or fwWorld_Step(" + world +
               ", seconds) without a host device.\n" +
               (is_.cpp ? " * Destroying the scene destroys the world. */\n"
                        : " * At the end: " + named("destroy") + "(" + at + "); */\n") +
               includes();
    }

    std::string includes() const {
        const std::string text = is_.cpp ? "#include <flamewright/flamewright.hpp>\n\n"
                                         : "#include <flamewright/flamewright.h>\n\n";
        if (is_.cpp)
            return text +
                   "#include <cmath>\n#include <cstring>\n#include <filesystem>\n"
                   "#include <fstream>\n#include <iterator>\n#include <vector>\n\n";
        return text +
               "#include <math.h>\n#include <stdio.h>\n#include <stdlib.h>\n"
               "#include <string.h>\n\n";
    }

    std::string members() const {
        const std::string body = "    double time; /* s, world time */\n" + members_;
        if (is_.cpp)
            return "struct CrateYard {\n    fw::World world;\n    double time = 0;  // s, world "
                   "time\n" +
                   initialised(members_) + "};\n\n";
        return "typedef struct CrateYard {\n    FwWorld* world;\n" + body + "} CrateYard;\n\n";
    }
    static std::string initialised(std::string text) {
        for (size_t at = 0; (at = text.find(";\n", at)) != std::string::npos; at += 4)
            text.replace(at, 1, "{};");
        return text;
    }

    std::string helpers() const {
        std::string text;
        if (reads_)
            text +=
                is_.cpp
                    ? "static std::vector<char> read_file(const std::filesystem::path& path) {\n"
                      "    std::ifstream file(path, std::ios::binary);\n"
                      "    return {std::istreambuf_iterator<char>(file), "
                      "std::istreambuf_iterator<char>()};\n}\n\n"
                    : "/* Reads a file; free the result. Null: it cannot be read. */\n"
                      "static void* read_file(const char* folder, const char* name, uint64_t* "
                      "size) {\n"
                      "    char path[1024];\n    FILE* file;\n    void* bytes = NULL;\n    long "
                      "length;\n"
                      "    if (snprintf(path, sizeof path, \"%s/%s\", folder, name) >= (int)sizeof "
                      "path) return NULL;\n"
                      "    file = fopen(path, \"rb\");\n    if (!file) return NULL;\n"
                      "    if (fseek(file, 0, SEEK_END) == 0 && (length = ftell(file)) > 0 &&\n"
                      "        fseek(file, 0, SEEK_SET) == 0 && (bytes = malloc((size_t)length)) "
                      "!= NULL) {\n"
                      "        *size = fread(bytes, 1, (size_t)length, file);\n"
                      "        if (*size != (uint64_t)length) {\n            free(bytes);\n"
                      "            bytes = NULL;\n        }\n    }\n    fclose(file);\n    return "
                      "bytes;\n}\n\n";
        if (gusts_ || parts_)
            text +=
                "static float within(float value, float most) {\n"
                "    return value < -most ? -most : value > most ? most : value;\n}\n\n";
        if (times_)
            text +=
                "/* 0 while inactive, otherwise the factor of its keys, linearly interpolated. */\n"
                "static float factor_at(float time, float start, float duration, const float "
                "(*keys)[2], int count) {\n"
                "    float value = 1.0f;\n    int i;\n"
                "    if (time < start || (duration > 0 && time >= start + duration)) return 0.0f;\n"
                "    if (count > 0) value = time <= keys[0][0] ? keys[0][1] : keys[count - 1][1];\n"
                "    for (i = 1; i < count; ++i) {\n"
                "        const float *a = keys[i - 1], *b = keys[i];\n"
                "        if (time <= keys[0][0] || time >= b[0]) continue;\n"
                "        value = a[1] + (b[1] - a[1]) * (time - a[0]) / (b[0] - a[0]);\n        "
                "break;\n    }\n"
                "    return value > 0 ? value : 0.0f;\n}\n\n";
        if (!carried_.empty())
            text +=
                "/* Transforms a position by a pose, or a direction with 0 for `moves`. */\n"
                "static void within_pose(const float pose[16], const float own[3], float moves, "
                "float* out) {\n    int i;\n    for (i = 0; i < 3; ++i)\n"
                "        out[i] = pose[i] * own[0] + pose[4 + i] * own[1] + pose[8 + i] * own[2] + "
                "pose[12 + i] * moves;\n}\n\n";
        if (pours_) text += pour();
        return text;
    }

    // Equals water() in burn.cpp.
    std::string pour() const {
        const auto call = [&](const char* name) {
            return is_.cpp ? std::string("std::") + name
                   : std::string(name) == "round" || std::string(name) == "fmod"
                       ? std::string(name)
                       : std::string(name) + "f";
        };
        std::string up;
        for (const float part : scene_.settings.up) up += (up.empty() ? "" : ", ") + literal(part);
        return "static const double kWateringStep = " + seconds(kWateringStep) + "; /* s */\n\n" +
               "/* `rate` kg/s onto a disc, for one watering step. Less than 1 g/m^2 "
               "accumulates until "
               "it is one. */\n"
               "static FwResult pour(FwWorld* world, const float place[3], float fall, float "
               "radius, float rate,\n"
               "                     double at, double delay) {\n"
               "    static const float up[3] = {" +
               up + "};\n" +
               "    FwIgnitionDef def = fwDefaultIgnitionDef();\n    float grams, down;\n    "
               "double every;\n"
               "    int i;\n    if (!(rate > 0)) return FW_OK;\n"
               "    grams = rate * 1000 * " +
               toFloat("kWateringStep") +
               " / (3.14159265f * radius * radius);\n"
               "    every = " +
               call("ceil") +
               "(1 / (grams > 1e-6f ? grams : 1e-6f));\n"
               "    if (every < 1) every = 1;\n"
               "    if (every > 1e6 || " +
               call("fmod") + "(" + call("round") +
               "(at / kWateringStep), every) != 0) return FW_OK;\n"
               "    grams *= " +
               toFloat("every") +
               ";\n"
               "    def.kind = FW_WET;\n    def.radius = radius;\n"
               "    def.delay = " +
               toFloat("delay > 0 ? delay : 0") +
               ";\n"
               "    def.water = grams < 1 ? 1.0f : grams > 1023 ? 1023.0f : grams;\n"
               "    for (down = 0; down <= fall; down += 1.5f * radius) {\n"
               "        FwResult result;\n"
               "        for (i = 0; i < 3; ++i) def.position[i] = place[i] - down * up[i];\n"
               "        result = fwWorld_Ignite(world, &def, " +
               is_.null +
               ");\n"
               "        if (result < 0) return result;\n    }\n    return FW_OK;\n}\n\n";
    }

    std::string advanceFunctions() const {
        std::string text;
        if (parts_)
            text += "/* Sets all outputs for that time. */\nstatic FwResult set_powers(" +
                    std::string(is_.scene) + ", double time) {\n" + powers_ +
                    "    return FW_OK;\n}\n\n";
        text +=
            "/* Applies the events of the next `step` seconds. Call it right before they are "
            "stepped or "
            "recorded. */\n"
            "FwResult " +
            named("advance") + "(" + is_.scene + ", float step) {\n";
        const bool asks = !advance_.empty() || parts_ || gusts_;
        if (asks) {
            text += "    const double from = " + in("time") + ";\n";
            if (!advance_.empty()) text += "    const double to = from + step;\n";
            text += "    FwResult result = FW_OK;\n";
        }
        text += advance_;
        if (parts_)
            text += "    result = set_powers(" + std::string(is_.argument) +
                    ", from);\n    if (result < 0) return result;\n";
        if (gusts_) {
            std::string wind;
            for (const float part : scene_.settings.wind)
                wind += (wind.empty() ? "" : ", ") + literal(part);
            text += "    {\n    float wind[3] = {" + wind + "};\n" + blow_ +
                    "    result = fwWorld_SetWind(" + world() +
                    ", wind);\n    if (result < 0) return result;\n    }\n";
        }
        return text + "    " + in("time") + " += " + (is_.cpp ? "double(step)" : "step") +
               ";\n    return " + (asks ? "result" : "FW_OK") + ";\n}\n\n";
    }

    std::string createFunction() {
        const std::string world_ = is_.cpp ? "world" : "scene->world";
        std::string text =
            "/* On failure returns a negative result and creates nothing; see "
            "fwWorld_GetLastMessage. */\nFwResult " +
            named("create") + "(FwContext* context, " + is_.folder + ", " + is_.scene + ") {\n";
        text += "    FwWorldDef def = fwDefaultWorldDef();\n    FwResult result;\n";
        Fields fields(text, is_.copy);
        printFields(fields, worldDefOf(scene_));
        const bool reads = calls_.find("folder") != std::string::npos;
        if (is_.cpp)
            text += std::string("    scene = {};\n") + (reads ? "" : "    (void)folder;\n") +
                    "    FwWorld* world = nullptr;\n    result = fwCreateWorld(context, &def, "
                    "&world);\n"
                    "    scene.world.reset(world);\n";
        else
            text += std::string(reads ? "" : "    (void)folder;\n") +
                    "    memset(scene, 0, sizeof *scene);\n"
                    "    result = fwCreateWorld(context, &def, &scene->world);\n";
        text += calls_;
        if (parts_)
            text +=
                "    if (result >= 0) result = set_powers(" + std::string(is_.argument) + ", 0);\n";
        text += is_.cpp ? "    if (result < 0) scene.world.reset();\n"
                        : "    if (result < 0) {\n        fwDestroyWorld(scene->world);\n"
                          "        scene->world = NULL;\n    }\n";
        return text + "    return result;\n}\n" + (is_.cpp ? "" : "\n");
    }

    const Scene& scene_;
    const OutputPlan& plan_;
    const Dialect& is_;
    std::string members_, functions_, calls_, advance_, powers_, blow_;
    std::map<ObjectId, std::string> carried_;  // by mesh
    // Required helper functions.
    bool reads_ = false, times_ = false, parts_ = false, pours_ = false, gusts_ = false;
};

}  // namespace

std::string snippetOf(const OutputPlan& plan, SnippetLanguage language) {
    return Writer(plan, language == SnippetLanguage::Cpp ? kCpp : kC).write();
}

}  // namespace fwedit
