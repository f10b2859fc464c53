// The unit of a world. One session in metres and in another unit burns bit for bit the same. Every
// length that the host gives or gets differs by the unit only. The headers list the numbers: one
// that is in neither list below, or a length that the session omits, fails.
#include "abi/busy_world.h"
#include "flamewright/flamewright.hpp"
#include "support/paths.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

using host::Bytes;
using host::lastMessage;
using host::materialOf;
using testing::HasSubstr;
using Names = std::set<std::string>;

// ---- lengths and speeds of the ABI

struct Owner {  // a struct or a function, and some of its numbers
    const char *name, *numbers;
};

const Owner kLengths[] = {
    {"FwWorldDef", "wind"},
    {"FwHeatOccluderDef", "transform halfSize"},
    {"FwHeatOcclusionDef", "origin cellSize distance"},
    {"FwWindZoneDef", "position size speed"},
    {"FwWindGridDef", "origin cellSize fade velocities"},
    {"FwGustDef", "size"},
    {"FwRoomDef", "position halfSize"},
    {"FwMeshDef", "positions details"},
    {"FwMeshInfo", "boundsLow boundsHigh"},
    {"FwPin", "from to radius"},
    {"FwBurnableMeshDef", "transform ground"},
    {"FwIgnitionDef", "position radius"},
    {"FwFirePoint", "position radius"},
    {"FwVolumetricFireDef", "position diameter"},
    {"FwVolumetricFireState", "height boundsLow boundsHigh tip lightPosition contact"},
    {"FwFireColliderDef", "position end halfSize radius cellSize heights distance view projection"},
    {"FwFireSample", "gas"},
    {"FwFireEmitterDef", "position extent radius speed size0 size1 ground behind"},
    {"FwFireEmitterState", "speed reach lightPosition clearDistance"},
    {"FwParticleFieldDef", "position size"},
    {"FwView", "view projection"},
    {"FwEvent", "position"},
    {"FwPointState", "distance position"},
    {"FwArrivalState", "distance position"},
    {"FwLight", "position radius"},
    {"FwSurroundings", "nearest nearestPosition"},
    {"fwWorld_SetWind", "wind"},
    {"fwWorld_ShiftOrigin", "offset applied"},
    {"fwWorld_GetOrigin", "origin"},
    {"fwWorld_MoveHeatOccluder", "transform"},
    {"fwWorld_GetWindAt", "point wind"},
    {"fwWorld_SetTransform", "transform"},
    {"fwWorld_SetVertexPositions", "positions"},
    {"fwWorld_MoveVolumetricFire", "position"},
    {"fwWorld_SampleVolumetricFires", "point"},
    {"fwWorld_GetVolumetricFireForce", "centre radius"},
    {"fwWorld_MoveFireEmitter", "position"},
    {"fwWorld_MoveParticleField", "position"},
    {"fwWorld_TagPoint", "position"},
    {"fwWorld_RequestPoint", "position"},
    {"fwWorld_RequestArrival", "position"},
    {"fwWorld_SampleSurroundings", "point"},
    {"fwWorld_SampleVisibility", "from to"},
    {"fwWorld_MakeSafetyMask", "corner columnStep rowStep"},
    {"fwDebug_GetTexelPositions", "positions"},
    {"fwDebug_GetUnwrap", "corners"},
};

const Owner kOthers[] = {
    {"FwWorldDef", "up paceFactor spreadChance timeToLive visibility metersPerUnit"},
    {"FwWindZoneDef", "axis falloff"},
    {"FwGustDef", "strength"},
    {"FwRoomDef", "rotation volume vent oxygen"},
    {"FwRoomState", "oxygen strength power flashOverPower"},
    {"FwMaterialDef",
     "spreadRate windGain upGain headGain backGain driveMax lengthToBreadth ceilingGain "
     "burnTime moisture extinctionMoisture thickness heatOfCombustion burningFlux "
     "baseColor baseRoughness density specificHeat conductivity ignitionTemperature "
     "autoIgnitionTemperature flameFeedback charFloor waterHeld radiantFraction sootYield "
     "recede shrink curl"},
    {"FwImageDef", "alphaCutoff reserved"},
    {"FwMeshDef", "normals uvs texelsPerMetre noiseAmplitude noiseFeature metersPerUnit"},
    {"FwMeshInfo", "area texelArea texelsPerMetre bakeMilliseconds"},
    {"FwPin", "reserved"},
    {"FwBurnableMeshDef",
     "moisture tint refinePixelsPerEdge spreadChance timeToLive heatPsi heatStep "
     "breakShare breakArea"},
    {"FwIgnitionDef", "delay water"},
    {"FwVolumetricFireDef",
     "power windResponse turbulence speed density smoke blue tint tintWeight blend "
     "coreTint coreTintWeight"},
    {"FwVolumetricFireState", "power pulseRate contactPower lightIntensity"},
    {"FwFireTrackDef", "times weight"},
    {"FwFireProfileDef", "texels"},
    {"FwFireColliderDef", "normal rotation depths"},
    {"FwFireSample", "temperature heatFlux"},
    {"FwFireForce", "ignitionPower force"},
    {"FwFireEmitterDef",
     "direction power rate cone life lifeVariance drag buoyancy windResponse turbulence "
     "inherit smoke smokeLife smokeDensity sparks temperature heat stick stickTime"},
    {"FwFireEmitterState", "power rate life lightIntensity heated stuckFuel stuckPower"},
    {"FwParticleFieldDef",
     "rotation amount rise spread memory chaos life detail body windResponse sourceSize "
     "sourceAt tint opacity"},
    {"FwView",
     "sunDirection sunColor ambientSky ambientGround exposure emissionScale time haze "
     "reserved"},
    {"FwOffscreenDef", "background"},
    {"FwEvent", "value"},
    {"FwObjectState", "burntFraction burningArea power reserved1 energy"},
    {"FwPointState", "age reserved temperature fuel charred water"},
    {"FwArrivalState", "seconds reserved"},
    {"FwTimelineDef", "interval maxInterval"},
    {"FwTimelineState", "interval"},
    {"FwNetDef", "interval delay"},
    {"FwNetAction", "deltaTime"},
    {"FwNetState", "behind silent changeRate backlog roundTrip"},
    {"FwLight", "color intensity power reserved"},
    {"FwSurroundings", "heatFlux temperature smoke danger nearestPower"},
    {"FwEnergyLedger", "power burningArea"},
    {"FwBudgetDef", "gpuMilliseconds cpuMilliseconds measuredMilliseconds"},
    {"FwBudgetState", "gpuMilliseconds cpuMilliseconds quads"},
    {"fwWorld_SetVertexPositions", "normals"},
    {"fwWorld_SetVolumetricFirePower", "power"},
    {"fwWorld_MoveFireEmitter", "direction"},
    {"fwWorld_SetFireEmitterPower", "power"},
    {"fwWorld_MoveParticleField", "rotation"},
    {"fwWorld_SetParticleFieldAmount", "amount"},
    {"fwWorld_Step", "deltaTime"},
    {"fwWorld_PlayCommandLog", "seconds"},
    {"fwWorld_Seek", "seconds"},
    {"fwWorld_PlayBurn", "delay speed"},
    {"fwNet_Update", "deltaTime"},
    {"fwWorld_SampleVisibility", "seen"},
    {"FwVulkanFrame", "deltaTime transparency"},
    {"FwPassTime", "milliseconds"},
};

Names namesOf(const Owner* first, const Owner* last) {
    Names all;
    for (; first != last; ++first) {
        std::istringstream words(first->numbers);
        for (std::string word; words >> word;) all.insert(std::string(first->name) + "::" + word);
    }
    return all;
}

std::string replaced(const std::string& text, const char* pattern, const char* by) {
    return std::regex_replace(text, std::regex(pattern), by);
}

// "Struct::field" and "function::argument" of every float and double that a header declares.
void readNumbers(const std::string& path, Names& all) {
    std::ifstream file(path);
    ASSERT_TRUE(file) << path;
    std::string text((std::istreambuf_iterator<char>(file)), {});
    for (size_t at; (at = text.find("/*")) != std::string::npos;)
        text.replace(at, text.find("*/", at) + 2 - at, " ");
    const std::regex number("\\b(float|double)\\b");
    const auto names = [](const std::string& declaration) {
        std::istringstream parts(replaced(
            declaration, "\\b(const|float|double|FwWorld|FwContext)\\b|\\*|\\[[^\\]]*\\]", " "));
        std::vector<std::string> found;
        for (std::string part; std::getline(parts, part, ',');) {
            std::istringstream words(part);
            std::string word, last;
            while (words >> word) last = word;
            found.push_back(last);
        }
        return found;
    };
    const std::regex structs("typedef struct (Fw\\w+) \\{([^}]*)\\}");
    for (std::sregex_iterator one(text.begin(), text.end(), structs), end; one != end; ++one) {
        std::istringstream fields((*one)[2].str());
        for (std::string field; std::getline(fields, field, ';');) {
            if (!std::regex_search(field, number)) continue;
            std::smatch callback;
            if (std::regex_search(field, callback, std::regex("FW_CALL\\* (\\w+)\\)")))
                all.insert((*one)[1].str() + "::" + callback[1].str());
            else
                for (const std::string& name : names(field))
                    all.insert((*one)[1].str() + "::" + name);
        }
    }
    const std::regex functions("FW_CALL (fw\\w+)\\(([^;{]*)\\);");
    for (std::sregex_iterator one(text.begin(), text.end(), functions), end; one != end; ++one) {
        std::istringstream arguments((*one)[2].str());
        for (std::string argument; std::getline(arguments, argument, ',');)
            if (std::regex_search(argument, number))
                all.insert((*one)[1].str() + "::" + names(argument)[0]);
    }
}

Names difference(const Names& a, const Names& b) {
    Names left;
    std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::inserter(left, left.end()));
    return left;
}

TEST(WorldUnit, EveryNumberOfTheHeadersIsClassified) {
    Names declared;
    for (const char* header : {"flamewright.h", "flamewright_vulkan.h", "flamewright_debug.h"})
        readNumbers(std::string(fw::test::kIncludeFolder) + "/flamewright/" + header, declared);
    EXPECT_GT(declared.size(), 280u);
    const Names lengths = namesOf(std::begin(kLengths), std::end(kLengths));
    Names known = namesOf(std::begin(kOthers), std::end(kOthers));
    for (const std::string& name : lengths)
        EXPECT_TRUE(known.insert(name).second) << name << " is in both lists";
    EXPECT_EQ(Names{}, difference(declared, known)) << "classify these as lengths or not";
    EXPECT_EQ(Names{}, difference(known, declared)) << "these are not in the headers";
}

// ---- one session in two units

struct Got {
    std::string name;
    double value = 0;
    bool length = false;
};

// Numbers of few bits in metres, so that they convert exactly to centimetres.
class Session {
 public:
    // `wrong` names a number that the session gives too large by `factor`.
    Session(uint32_t backend, float metersPerUnit, std::string wrong = {})
        : unit(metersPerUnit),
          per(float(std::round(1 / double(metersPerUnit)))),
          wrong_(std::move(wrong)) {
        FwContextDef contextDef = fwDefaultContextDef();
        contextDef.backend = backend;
        contextDef.callbacks = host_.callbacks();
        FwErrorInfo error{};
        if (fwCreateContext(&contextDef, &context, &error) != FW_OK) return;
        FwWorldDef def = fwDefaultWorldDef();
        def.metersPerUnit = metersPerUnit;
        def.flags = FW_WORLD_RADIATION | FW_WORLD_PLUME | FW_WORLD_CONTACT | FW_WORLD_EMBERS;
        def.paceFactor = 12;
        give("FwWorldDef::wind", def.wind, {1.5f, 0, 0.25f});
        ok(fwCreateWorld(context, &def, &world));
        ok(fwWorld_StartCommandLog(world));
        createMeshes();
        createSurroundings();
        createFires();
    }
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;
    ~Session() {
        fwDestroyContext(context);
        EXPECT_EQ(0, host_.blocks);
    }

    // Runs while its results equal those of `twin` (null: to the end) and nothing is refused.
    void run(int frames, const Session* twin = nullptr) {
        for (int frame = 0; frame < frames && !refused_; ++frame) {
            act(frame);
            ok(fwWorld_Step(world, 1.0f / 32));
            if (frame % 6 == 5) ask(frame == 5);
            if (twin && differs(*twin)) return;
        }
    }
    // The first result that differs from `metres` (lengths scaled by the unit); empty if there is
    // none.
    [[nodiscard]] std::string difference(const Session& metres) const {
        if (refused_) return "a refusal";
        for (size_t i = 0; i < std::min(got.size(), metres.got.size()); ++i) {
            const Got &a = metres.got[i], &b = got[i];
            const bool scaled = a.length && std::abs(a.value) != double(FLT_MAX);
            const double expected = scaled ? double(float(a.value * double(per))) : a.value;
            if (a.name == b.name && expected == b.value) continue;
            std::ostringstream text;
            text.precision(9);
            text << a.name << ", number " << i << ": " << b.value << ", not " << expected;
            return text.str();
        }
        return {};
    }
    [[nodiscard]] bool differs(const Session& metres) const { return !difference(metres).empty(); }
    Bytes log() {
        uint64_t size = 0;
        ok(fwWorld_FetchCommandLog(world, nullptr, &size));
        Bytes bytes(size);
        ok(fwWorld_FetchCommandLog(world, bytes.data(), &size));
        return bytes;
    }
    Bytes picture() {
        Bytes pixels(size_t{160} * 120 * 4);
        FwOffscreenDef def = fwDefaultOffscreenDef();
        def.width = 160, def.height = 120;
        def.pixels = pixels.data();
        camera("FwView::view", def.view.view, "FwView::projection", def.view.projection);
        ok(fwWorld_RenderOffscreen(world, &def));
        return pixels;
    }

    const float unit, per;  // m per unit; units per m
    FwContext* context = nullptr;
    FwWorld* world = nullptr;
    Names given, asked;  // names of numbers given and received
    std::vector<Got> got;

 private:
    void ok(FwResult result) {
        if (!wrong_.empty() && result < FW_OK)
            refused_ = true;
        else
            ASSERT_LE(FW_OK, result) << lastMessage(world);
    }
    // Units per metre where `name` is a length, else 1; times the factor of a wrong number.
    float units(const char* name) {
        given.insert(name);
        return name == wrong_ ? per * per : per;
    }
    float give(const char* name, float metres) { return metres * units(name); }
    template <size_t N>
    void give(const char* name, float (&out)[N], const std::array<float, N>& metres) {
        for (size_t i = 0; i < N; ++i) out[i] = give(name, metres[i]);
    }
    // World transform of an object space of `space` units per metre.
    void transform(const char* name, float (&out)[16], float x, float y, float z, float space) {
        for (int i = 0; i < 16; ++i) out[i] = i == 15 ? 1 : i % 5 == 0 ? per / space : 0.0f;
        out[12] = give(name, x), out[13] = give(name, y), out[14] = give(name, z);
    }
    // 4 m in front of the middle, beside and above; left-handed view, so that w is the distance.
    void camera(const char* viewName, float (&view)[16], const char* projectionName,
                float (&projection)[16]) {
        for (int i = 0; i < 16; ++i) view[i] = projection[i] = 0;
        view[0] = view[10] = view[15] = 1;
        view[5] = 1;
        view[12] = give(viewName, -0.5f);
        view[13] = give(viewName, -0.25f);
        view[14] = give(viewName, 4);
        const float near = give(projectionName, 0.125f), far = 512 * near;
        projection[0] = 1.5f, projection[5] = -2;
        projection[10] = far / (far - near), projection[11] = 1;
        projection[14] = -near * far / (far - near);
    }
    void get(const char* name, double value) {
        asked.insert(name);
        got.push_back({name, value, true});
    }
    template <size_t N>
    void get(const char* name, const float (&values)[N]) {
        for (const float value : values) get(name, double(value));
    }
    void same(const char* name, double value) { got.push_back({name, value, false}); }
    template <class Info>
    static Info info() {
        Info made{};
        made.structSize = sizeof made;
        return made;
    }

    float metres(const char* name, float space) {
        const float inWorld = units(name);
        return space == per ? inWorld : space;
    }
    FwMeshId createMesh(float space) {  // object space of `space` units per metre
        host::Sheet sheet(0.5f, 0.375f, 2);
        std::vector<float> details(sheet.uvs.size());
        for (size_t i = 0; i < details.size(); ++i)
            details[i] = sheet.uvs[i] * 16384 * metres("FwMeshDef::details", space);
        for (float& value : sheet.positions)
            value = (value + 0.0625f) * metres("FwMeshDef::positions", space);
        FwMeshDef def = sheet.def(64);
        def.details = details.data();
        if (space != per) def.metersPerUnit = 1 / space;
        FwMeshId id{};
        ok(fwWorld_CreateMesh(world, &def, &id));
        positions_ = sheet.positions;
        return id;
    }
    FwBurnableMeshId createObject(FwMeshId mesh, float space, uint32_t flags, float x, float z) {
        FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
        def.mesh = mesh;
        def.flags = flags;
        FwMaterialDef material = materialOf(FW_MATERIAL_PLYWOOD);
        ok(fwWorld_CreateMaterial(world, &material, &def.materials[0]));
        transform("FwBurnableMeshDef::transform", def.transform, x, 0.125f, z, space);
        def.ground = give("FwBurnableMeshDef::ground", -16777216);
        FwPin pin{};
        give("FwPin::from", pin.from, {-16384, 0, 0});
        give("FwPin::to", pin.to, {16384, 0, 0});
        pin.radius = give("FwPin::radius", 16384);
        def.pins = flags & FW_BURNABLE_SHELL ? &pin : nullptr;
        def.pinCount = def.pins ? 1 : 0;
        def.breakShare = 0.25f;
        FwBurnableMeshId id{};
        ok(fwWorld_CreateBurnableMesh(world, &def, &id));
        return id;
    }
    void createMeshes() {
        mesh_ = createMesh(per);
        metric_ = createMesh(1);  // an asset in metres
        objects_.push_back(createObject(metric_, 1, 0, 1.125f, 0));
        objects_.push_back(createObject(mesh_, per, 0, 0.5625f, 0));
        objects_.push_back(createObject(mesh_, per, FW_BURNABLE_SHELL, 0, 0.5f));
        objects_.push_back(createObject(mesh_, per, FW_BURNABLE_SKINNED, 0.5625f, 0.5f));
        objects_.push_back(createObject(metric_, 1, FW_BURNABLE_SKINNED, 1.125f, 0.5f));
        objects_.push_back(createObject(mesh_, per, 0, 0, 0));
    }
    void createSurroundings() {
        FwHeatOccluderDef wall = fwDefaultHeatOccluderDef();
        transform("FwHeatOccluderDef::transform", wall.transform, 2, 0.5f, 0.25f, per);
        give("FwHeatOccluderDef::halfSize", wall.halfSize, {0.0625f, 0.5f, 0.5f});
        ok(fwWorld_AddHeatOccluder(world, &wall, &wall_));
        FwWindZoneDef zone = fwDefaultWindZoneDef();
        give("FwWindZoneDef::position", zone.position, {0.5f, 0, 0.25f});
        give("FwWindZoneDef::size", zone.size, {1, 0.5f, 0.75f});
        zone.speed = give("FwWindZoneDef::speed", 2.5f);
        FwWindZoneId zoneId{};
        ok(fwWorld_CreateWindZone(world, &zone, &zoneId));
        zone.speed = give("FwWindZoneDef::speed", 3);
        ok(fwWorld_SetWindZone(world, zoneId, &zone));
        FwWindGridDef grid = fwDefaultWindGridDef();
        give("FwWindGridDef::origin", grid.origin, {-2, -1, -2});
        grid.cellSize = give("FwWindGridDef::cellSize", 4);
        grid.fade = give("FwWindGridDef::fade", 0.5f);
        float velocities[24];
        for (int i = 0; i < 24; ++i)
            velocities[i] = give("FwWindGridDef::velocities", float(i % 5) * 0.5f);
        grid.velocities = velocities;
        grid.blend = FW_WIND_ADD;
        ok(fwWorld_SetWindGrid(world, &grid));
        FwGustDef gusts = fwDefaultGustDef();
        gusts.strength = 0.5f;
        gusts.size = give("FwGustDef::size", 2);
        ok(fwWorld_SetGusts(world, &gusts));
        FwRoomDef room = fwDefaultRoomDef();
        give("FwRoomDef::position", room.position, {0.25f, 0, 0.25f});
        give("FwRoomDef::halfSize", room.halfSize, {0.5f, 1, 0.5f});
        FwRoomId roomId{};
        ok(fwWorld_CreateRoom(world, &room, &roomId));
        ok(fwWorld_SetRoom(world, roomId, &room));
        FwHeatOcclusionDef shield = fwDefaultHeatOcclusionDef();
        for (uint32_t& count : shield.counts) count = 12;
        give("FwHeatOcclusionDef::origin", shield.origin, {-1, -0.5f, -1});
        shield.cellSize = give("FwHeatOcclusionDef::cellSize", 0.25f);
        shield.distanceData = this;
        shield.distance = [](void* data, const float* place) {
            auto& self = *static_cast<Session*>(data);
            const float side = place[1] < -0.25f * self.per ? -0.5f : 0.0625f;  // both solid
            return self.give("FwHeatOcclusionDef::distance", side);
        };
        ok(fwWorld_SetHeatOcclusion(world, &shield));
        createColliders();
    }
    void createColliders() {
        const auto add = [&](const FwFireColliderDef& def) {
            FwFireColliderId id{};
            ok(fwWorld_AddFireCollider(world, &def, &id));
            ok(fwWorld_SetFireCollider(world, id, &def));
        };
        FwFireColliderDef def = fwDefaultFireColliderDef();
        def.kind = FW_COLLIDER_CAPSULE;
        give("FwFireColliderDef::position", def.position, {2.5f, 0.75f, 1});
        give("FwFireColliderDef::end", def.end, {3.5f, 0.75f, 1});
        def.radius = give("FwFireColliderDef::radius", 0.125f);
        add(def);
        def.kind = FW_COLLIDER_BOX;
        give("FwFireColliderDef::halfSize", def.halfSize, {0.25f, 0.0625f, 0.25f});
        give("FwFireColliderDef::position", def.position, {3, 1.25f, 1});
        add(def);
        def.kind = FW_COLLIDER_HEIGHT_FIELD;
        give("FwFireColliderDef::position", def.position, {2, -0.25f, 0});
        def.cellSize = give("FwFireColliderDef::cellSize", 1);
        def.columns = def.rows = 3;
        float heights[9];
        for (int i = 0; i < 9; ++i)
            heights[i] = give("FwFireColliderDef::heights", 0.0625f * float(i % 3));
        def.heights = heights;
        add(def);
        def.kind = FW_COLLIDER_DISTANCE;
        def.distanceData = this;
        def.distance = [](void* data, const float* point, float* normal) {
            auto& self = *static_cast<Session*>(data);
            if (self.requested_ < 8) {
                for (int i = 0; i < 3; ++i)
                    self.get("FwFireColliderDef::distance", double(point[i]));
                ++self.requested_;
            }
            normal[0] = normal[2] = 0;
            normal[1] = 1;
            return self.give("FwFireColliderDef::distance", 0.5f);
        };
        add(def);
        def.kind = FW_COLLIDER_DEPTH;
        def.columns = def.rows = 8;
        def.radius = give("FwFireColliderDef::radius", 0.5f);
        const std::vector<float> depths(64, 0.9765625f);
        def.depths = depths.data();
        camera("FwFireColliderDef::view", def.view, "FwFireColliderDef::projection",
               def.projection);
        // Along x, so that wind drives a flame into the visible wall at x = 3.4 m.
        def.view[0] = def.view[10] = 0;
        def.view[2] = 1, def.view[8] = -1;
        def.view[12] = give("FwFireColliderDef::view", 1);
        def.view[14] = give("FwFireColliderDef::view", 1.5f);
        add(def);
    }
    void createFires() {
        FwVolumetricFireDef fire = fwDefaultVolumetricFireDef();
        fire.seed = 3;
        give("FwVolumetricFireDef::position", fire.position, {3, 0, 1});
        fire.diameter = give("FwVolumetricFireDef::diameter", 0.75f);
        fire.power = 100;
        ok(fwWorld_CreateVolumetricFire(world, &fire, &fires_[0]));
        FwFirePoint points[3];
        for (int i = 0; i < 3; ++i) {
            give("FwFirePoint::position", points[i].position,
                 {4, 0.5f * float(i), 0.25f * float(i)});
            points[i].radius = give("FwFirePoint::radius", 0.25f);
        }
        fire.points = points;
        fire.pointCount = 3;
        ok(fwWorld_CreateVolumetricFire(world, &fire, &fires_[1]));
        fire.points = nullptr;
        fire.pointCount = 0;
        ok(fwWorld_CreateVolumetricFire(world, &fire, &fires_[2]));
        ok(fwWorld_SetVolumetricFirePoints(world, fires_[2], points, 3));
        ok(fwWorld_CreateVolumetricFire(world, &fire, &fires_[3]));
        FwFireTrackDef track = fwDefaultFireTrackDef();
        const float times[1] = {0};
        track.keyCount = 1;
        track.pointsPerKey = 3;
        track.times = times;
        track.points = points;
        ok(fwWorld_SetVolumetricFireTrack(world, fires_[3], &track));
        FwFireEmitterDef emitter = fwDefaultFireEmitterDef();
        emitter.seed = 5;
        emitter.flags = FW_EMITTER_JET | FW_EMITTER_IGNITES;
        give("FwFireEmitterDef::position", emitter.position, {-1.25f, 0.125f, 0.125f});
        emitter.direction[0] = 1, emitter.direction[1] = 0;
        emitter.behind = give("FwFireEmitterDef::behind", 0.25f);
        emitter.power = 400;
        ok(fwWorld_CreateFireEmitter(world, &emitter, &emitters_[0]));
        emitter = fwDefaultFireEmitterDef();
        emitter.seed = 6;
        emitter.flags = FW_EMITTER_GROUND;
        emitter.shape = FW_EMITTER_LINE;
        give("FwFireEmitterDef::position", emitter.position, {5, 0, 1});
        give("FwFireEmitterDef::extent", emitter.extent, {2, 0, 0.25f});
        emitter.ground = give("FwFireEmitterDef::ground", -16384);
        emitter.speed = give("FwFireEmitterDef::speed", 3);
        emitter.size0 = give("FwFireEmitterDef::size0", 0.75f);
        emitter.size1 = give("FwFireEmitterDef::size1", 1);
        ok(fwWorld_CreateFireEmitter(world, &emitter, &emitters_[1]));
        emitter.shape = FW_EMITTER_DISC;
        emitter.radius = give("FwFireEmitterDef::radius", 1);
        FwFireEmitterId disc{};
        ok(fwWorld_CreateFireEmitter(world, &emitter, &disc));
        FwParticleFieldDef field = fwDefaultParticleFieldDef();
        ok(fwInitFieldPreset(&field, FW_FIELD_WATER));
        field.flags = FW_FIELD_WETS;
        field.width = field.height = 32;
        give("FwParticleFieldDef::position", field.position, {1.25f, 0, 0.25f});
        give("FwParticleFieldDef::size", field.size, {1, 0.75f, 16});
        ok(fwWorld_CreateParticleField(world, &field, &field_));
    }

    void act(int frame) {
        if (frame == 1) {
            FwIgnitionDef ball = fwDefaultIgnitionDef();
            give("FwIgnitionDef::position", ball.position, {0.75f, 0.125f, 0.125f});
            ball.radius = give("FwIgnitionDef::radius", 0.125f);
            uint32_t texels = 0;
            ok(fwWorld_Ignite(world, &ball, &texels));
            same("texels lit", texels);
            const float place[3] = {give("fwWorld_TagPoint::position", 0.9375f), per * 0.125f,
                                    per * 0.125f};
            ok(fwWorld_TagPoint(world, objects_[1], place, 7));
        }
        if (frame == 8) {
            float wind[3], at[16], vertices[27];
            give("fwWorld_SetWind::wind", wind, {0.5f, 0, 1.25f});
            ok(fwWorld_SetWind(world, wind));
            transform("fwWorld_MoveHeatOccluder::transform", at, 2.25f, 0.5f, 0.25f, per);
            ok(fwWorld_MoveHeatOccluder(world, wall_, at));
            transform("fwWorld_SetTransform::transform", at, 1.25f, 0.125f, 0, 1);
            ok(fwWorld_SetTransform(world, objects_[0], at));
            for (int skinned = 3; skinned < 5; ++skinned) {
                const float space =
                    skinned == 3 ? units("fwWorld_SetVertexPositions::positions") : 1;
                for (int i = 0; i < 27; ++i)
                    vertices[i] = positions_[size_t(i)] * space + (i % 3 == 1 ? 0.125f * space : 0);
                ok(fwWorld_SetVertexPositions(world, objects_[size_t(skinned)], vertices, nullptr,
                                              9));
            }
            give("fwWorld_MoveVolumetricFire::position", wind, {3, 0.125f, 1.125f});
            ok(fwWorld_MoveVolumetricFire(world, fires_[0], wind));
            give("fwWorld_MoveFireEmitter::position", wind, {-1.125f, 0.125f, 0.125f});
            ok(fwWorld_MoveFireEmitter(world, emitters_[0], wind, nullptr));
            give("fwWorld_MoveParticleField::position", wind, {1.5f, 0, 0.25f});
            ok(fwWorld_MoveParticleField(world, field_, wind, nullptr));
        }
        if (frame == 20) {
            const float offset[3] = {give("fwWorld_ShiftOrigin::offset", 8), 0, -64 * per};
            float applied[3];
            ok(fwWorld_ShiftOrigin(world, offset, applied));
            get("fwWorld_ShiftOrigin::applied", applied);
            shift_ = 8;
        }
    }
    // A place of the session, independent of the origin.
    std::array<float, 3> at(const char* name, float x, float y, float z) {
        return {give(name, x + shift_), y * per, (z - 8 * shift_) * per};
    }
    void ask(bool first) {
        for (const FwBurnableMeshId id : objects_) {
            uint64_t hash = 0;
            ok(fwDebug_RequestBurnMap(world, id));
            ok(fwDebug_FetchBurnMap(world, id, nullptr, 0, nullptr, &hash, nullptr));
            same("burn map", double(hash >> 12));
            auto state = info<FwObjectState>();
            ok(fwWorld_GetObjectState(world, id, &state));
            same("burning area", double(state.burningArea));
            same("power", double(state.power));
        }
        if (refused_) return;
        uint32_t sum = 0;
        for (const unsigned char byte : host::saveOf(world)) sum = sum * 31 + byte;
        same("save", sum);
        FwEvent events[64];
        const uint32_t count = fwWorld_PollEvents(world, events, 64);
        for (uint32_t i = 0; i < count; ++i) {
            same("event", events[i].type);
            same("event's value", double(events[i].value));
            get("FwEvent::position", events[i].position);
        }
        FwLight lights[16];
        const uint32_t shining = fwWorld_GetLights(world, lights, 16);
        for (uint32_t i = 0; i < shining; ++i) {
            get("FwLight::position", lights[i].position);
            get("FwLight::radius", double(lights[i].radius));
            same("light's intensity", double(lights[i].intensity));
        }
        auto fire = info<FwVolumetricFireState>();
        for (const FwVolumetricFireId id : fires_) {
            ok(fwWorld_GetVolumetricFireState(world, id, &fire));
            get("FwVolumetricFireState::height", double(fire.height));
            get("FwVolumetricFireState::boundsLow", fire.boundsLow);
            get("FwVolumetricFireState::boundsHigh", fire.boundsHigh);
            get("FwVolumetricFireState::tip", fire.tip);
            get("FwVolumetricFireState::lightPosition", fire.lightPosition);
            get("FwVolumetricFireState::contact", fire.contact);
        }
        auto emitter = info<FwFireEmitterState>();
        for (const FwFireEmitterId id : emitters_) {
            ok(fwWorld_GetFireEmitterState(world, id, &emitter));
            get("FwFireEmitterState::speed", double(emitter.speed));
            get("FwFireEmitterState::reach", double(emitter.reach));
            get("FwFireEmitterState::clearDistance", double(emitter.clearDistance));
            get("FwFireEmitterState::lightPosition", emitter.lightPosition);
            same("heated", double(emitter.heated));
        }
        queryPlaces();
        if (first) queryMeshes();
    }
    void queryPlaces() {
        FwQueryId query{};
        auto place = at("fwWorld_RequestPoint::position", 0.875f, 0.25f, 0.125f);
        ok(fwWorld_RequestPoint(world, objects_[1], place.data(), &query));
        auto point = info<FwPointState>();
        ok(fwWorld_FetchPoint(world, query, &point));
        get("FwPointState::distance", double(point.distance));
        get("FwPointState::position", point.position);
        same("temperature", double(point.temperature));
        for (const size_t skinned : {3u, 4u}) {
            ok(fwWorld_RequestPoint(world, objects_[skinned], place.data(), &query));
            ok(fwWorld_FetchPoint(world, query, &point));
            get("FwPointState::position", point.position);
        }
        place = at("fwWorld_RequestArrival::position", 0.5f, 0.25f, 0.75f);
        ok(fwWorld_RequestArrival(world, objects_[1], place.data(), &query));
        auto arrival = info<FwArrivalState>();
        for (int i = 0; i < 8 && fwWorld_FetchArrival(world, query, &arrival) == FW_NOT_READY; ++i)
            ok(fwWorld_Step(world, 0));
        get("FwArrivalState::distance", double(arrival.distance));
        get("FwArrivalState::position", arrival.position);
        same("arrives in", double(arrival.seconds));
        auto answer = info<FwFireSample>();
        place = at("fwWorld_SampleVolumetricFires::point", 3, 0.5f, 1);
        ok(fwWorld_SampleVolumetricFires(world, place.data(), &answer));
        get("FwFireSample::gas", answer.gas);
        same("heat flux", double(answer.heatFlux));
        auto push = info<FwFireForce>();
        place = at("fwWorld_GetVolumetricFireForce::centre", 3, 0.75f, 1);
        ok(fwWorld_GetVolumetricFireForce(
            world, place.data(), give("fwWorld_GetVolumetricFireForce::radius", 0.25f), &push));
        same("force", double(push.force[1]));
        auto around = info<FwSurroundings>();
        place = at("fwWorld_SampleSurroundings::point", 6, 2.5f, -3);
        ok(fwWorld_SampleSurroundings(world, place.data(), &around));
        get("FwSurroundings::nearest", double(around.nearest));
        get("FwSurroundings::nearestPosition", around.nearestPosition);
        same("smoke", double(around.smoke));
        const auto to = at("fwWorld_SampleVisibility::to", 4, 1.5f, 1);
        place = at("fwWorld_SampleVisibility::from", -1, 1, 1);
        float seen = 0;
        ok(fwWorld_SampleVisibility(world, place.data(), to.data(), &seen));
        same("seen", double(seen));
        uint8_t mask[16];
        place = at("fwWorld_MakeSafetyMask::corner", 2, 0.5f, 0);
        float column[3], row[3];
        give("fwWorld_MakeSafetyMask::columnStep", column, {0.5f, 0, 0});
        give("fwWorld_MakeSafetyMask::rowStep", row, {0, 0, 0.5f});
        ok(fwWorld_MakeSafetyMask(world, place.data(), column, row, 4, 4, mask));
        for (const uint8_t danger : mask) same("danger", danger);
        float wind[3];
        place = at("fwWorld_GetWindAt::point", 0.5f, 0.25f, 0.25f);
        ok(fwWorld_GetWindAt(world, place.data(), wind));
        get("fwWorld_GetWindAt::wind", wind);
        double origin[3];
        ok(fwWorld_GetOrigin(world, origin));
        for (const double value : origin) get("fwWorld_GetOrigin::origin", value);
    }
    // In the mesh's own unit: an asset in metres reports metres in both worlds.
    void queryMeshes() {
        auto of = info<FwMeshInfo>();
        ok(fwWorld_GetMeshInfo(world, mesh_, &of));
        get("FwMeshInfo::boundsLow", of.boundsLow);
        get("FwMeshInfo::boundsHigh", of.boundsHigh);
        same("area", double(of.area));
        same("texels per metre", double(of.texelsPerMetre));
        same("map", of.mapWidth * of.mapHeight);
        ok(fwWorld_GetMeshInfo(world, metric_, &of));
        for (const float value : of.boundsHigh) same("bounds in metres", double(value));
        same("map", of.mapWidth * of.mapHeight);
        float places[30], corners[30];
        uint64_t count = 0;
        ok(fwDebug_GetTexelPositions(world, mesh_, places, nullptr, 10, &count));
        get("fwDebug_GetTexelPositions::positions", places);
        ok(fwDebug_GetUnwrap(world, mesh_, corners, 6, &count));
        for (int i = 0; i < 30; ++i)
            i % 5 < 3 ? get("fwDebug_GetUnwrap::corners", double(corners[i]))
                      : same("place in the map", double(corners[i]));
    }

    host::Host host_;
    FwMeshId mesh_{}, metric_{};
    std::vector<float> positions_;  // of the mesh in metres, which is created last
    std::vector<FwBurnableMeshId> objects_;
    FwHeatOccluderId wall_{};
    FwVolumetricFireId fires_[4] = {};
    FwFireEmitterId emitters_[2] = {};
    FwParticleFieldId field_{};
    float shift_ = 0;
    int requested_ = 0;
    const std::string wrong_;
    bool refused_ = false;
};

TEST(WorldUnit, ASessionInAnotherUnitBurnsIdentically) {
    Session metres(FW_BACKEND_CPU, 1);
    metres.run(72);
    const Bytes save = host::saveOf(metres.world), log = metres.log();
    Names idle = metres.asked;  // got only zeros, which are equal in every unit
    for (const Got& one : metres.got)
        if (one.value != 0 && std::abs(one.value) != double(FLT_MAX)) idle.erase(one.name);
    EXPECT_EQ(Names{}, idle);
    for (const float unit : {0.01f, 0.0625f}) {  // centimetres, and a unit that is exact in floats
        Session units(FW_BACKEND_CPU, unit);
        units.run(72);
        EXPECT_EQ("", units.difference(metres)) << unit << " m in a unit";
        EXPECT_EQ(metres.got.size(), units.got.size());
        EXPECT_EQ(save, host::saveOf(units.world)) << "saves are in metres";
        EXPECT_EQ(log, units.log()) << "logs and packets are in metres";
        EXPECT_EQ(FW_OK, fwWorld_Load(units.world, save.data(), save.size()))
            << lastMessage(units.world);
        Names took = units.given;
        took.insert(units.asked.begin(), units.asked.end());
        took.insert({"FwView::view", "FwView::projection"});  // the picture below
        EXPECT_EQ(Names{}, difference(namesOf(std::begin(kLengths), std::end(kLengths)), took))
            << "the session omits these lengths";
    }
}

// The session above tests a length only if a wrong value changes its results.
TEST(WorldUnit, TheSessionDetectsEachUnconvertedLength) {
    Session metres(FW_BACKEND_CPU, 1);
    metres.run(24);
    for (const std::string& name : metres.given) {
        Session units(FW_BACKEND_CPU, 0.01f, name);
        units.run(24, &metres);
        EXPECT_TRUE(units.differs(metres)) << name;
    }
}

TEST(WorldUnit, ASessionInAnotherUnitLooksTheSame) {
    Session metres(FW_BACKEND_VULKAN, 1), units(FW_BACKEND_VULKAN, 0.01f);
    if (!metres.world) GTEST_SKIP() << "there is no Vulkan device here";
    for (Session* one : {&metres, &units})
        for (int i = 0; i < 40; ++i) ASSERT_EQ(FW_OK, fwWorld_Step(one->world, 1.0f / 32));
    const Bytes a = metres.picture(), b = units.picture();
    int differ = 0, most = 0, shown = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        const int by = std::abs(int(a[i]) - int(b[i]));
        differ += by > 2;
        most = std::max(most, by);
        shown += i % 4 == 0 && a[i] > 40;
    }
    EXPECT_GT(shown, 200) << "fires are in the picture";
    EXPECT_LE(differ, int(a.size() / 1000)) << "most " << most;
}

// ---- the unit itself

class UnitWorld {
 public:
    explicit UnitWorld(float metersPerUnit) : context(host::createCpuContext(host)) {
        FwWorldDef def = fwDefaultWorldDef();
        def.metersPerUnit = metersPerUnit;
        result = fwCreateWorld(context, &def, &world);
    }
    UnitWorld(const UnitWorld&) = delete;
    UnitWorld& operator=(const UnitWorld&) = delete;
    ~UnitWorld() { fwDestroyContext(context); }
    host::Host host;
    FwContext* context;
    FwWorld* world = nullptr;
    FwResult result = FW_OK;
};

TEST(WorldUnit, DefaultsToTheMetre) {
    EXPECT_EQ(1.0f, fwDefaultWorldDef().metersPerUnit);
    for (const float unit : {0.0f, 1.0f}) {
        UnitWorld w(unit);
        ASSERT_EQ(FW_OK, w.result);
        FwGustDef gusts = fwDefaultGustDef();
        ASSERT_EQ(FW_OK, fwWorld_ConvertDef(w.world, FW_DEF_GUSTS, &gusts));
        EXPECT_EQ(12, gusts.size);
    }
    for (const float wrong : {-1.0f, 0.00009f, 1001.0f, NAN, INFINITY}) {
        UnitWorld w(wrong);
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, w.result);
        EXPECT_THAT(lastMessage(w.context), HasSubstr("FwWorldDef::metersPerUnit is"));
    }
}

TEST(WorldUnit, MessagesStateLimitsInTheUnit) {
    UnitWorld w(0.01f);
    ASSERT_EQ(FW_OK, w.result);
    FwRoomDef room = fwDefaultRoomDef();  // 2 units, which are 2 cm here
    FwRoomId id{};
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateRoom(w.world, &room, &id));
    EXPECT_THAT(lastMessage(w.world),
                HasSubstr("FwRoomDef::halfSize[0] is 2; the limits are [5, 100000]."));
    const float far[3] = {0, 2e8f, 0};
    float wind[3];
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_GetWindAt(w.world, far, wind));
    EXPECT_THAT(lastMessage(w.world),
                HasSubstr("point[1] is 2e+08; the limits are [-1e+08, 1e+08]"));
    FwIgnitionDef match = fwDefaultIgnitionDef();
    match.radius = 20;
    EXPECT_EQ(FW_NOTHING_THERE, fwWorld_Ignite(w.world, &match, nullptr));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("The ball of 20 units at (0, 0, 0)"));
    FwWorldDef windy = fwDefaultWorldDef();
    windy.metersPerUnit = 0.01f;
    windy.wind[0] = 13000;
    FwWorld* none = nullptr;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwCreateWorld(w.context, &windy, &none));
    EXPECT_THAT(lastMessage(w.context),
                HasSubstr("FwWorldDef::wind[0] is 13000; the limits are [-12000, 12000]."));
    // A mesh may have its own unit.
    const host::Sheet dot(0.00001f, 0.00001f);
    FwMeshDef meshDef = dot.def(64);
    FwMeshId mesh{};
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateMesh(w.world, &meshDef, &mesh));
    EXPECT_THAT(lastMessage(w.world),
                HasSubstr("longest side is 1e-05 units; it must lie in [0.01, 1e+07] units."));
    meshDef.metersPerUnit = 1;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateMesh(w.world, &meshDef, &mesh));
    EXPECT_THAT(lastMessage(w.world),
                HasSubstr("longest side is 1e-05 m; it must lie in [0.0001, 100000] m."));
    meshDef.metersPerUnit = 2000;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateMesh(w.world, &meshDef, &mesh));
    EXPECT_THAT(lastMessage(w.world),
                HasSubstr("FwMeshDef::metersPerUnit is 2000; the limits are"));
}

TEST(WorldUnit, DefaultsAndPresetsAreConverted) {
    UnitWorld w(0.01f);
    FwFireEmitterDef jet = fwDefaultFireEmitterDef();
    ASSERT_EQ(FW_OK, fwWorld_ConvertDef(w.world, FW_DEF_FIRE_EMITTER, &jet));
    EXPECT_EQ(50, jet.behind);
    EXPECT_EQ(60, jet.power);
    FwHeatOccluderDef wall = fwDefaultHeatOccluderDef();
    ASSERT_EQ(FW_OK, fwWorld_ConvertDef(w.world, FW_DEF_HEAT_OCCLUDER, &wall));
    EXPECT_EQ(50, wall.halfSize[1]);
    EXPECT_EQ(1, wall.transform[0]);
    FwMeshDef mesh = fwDefaultMeshDef(), same = mesh;
    ASSERT_EQ(FW_OK, fwWorld_ConvertDef(w.world, FW_DEF_MESH, &mesh));
    EXPECT_EQ(0, std::memcmp(&mesh, &same, sizeof mesh))
        << "its defaults are the same in every unit";
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_ConvertDef(w.world, 4711, &mesh));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("defType is 4711"));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_ConvertDef(w.world, FW_DEF_ROOM, nullptr));

    // An older host's shorter struct: missing fields take the default in metres.
    FwFireEmitterDef old = fwDefaultFireEmitterDef();
    old.structSize = offsetof(FwFireEmitterDef, behind);
    old.flags = FW_EMITTER_JET;
    FwFireEmitterId id{};
    EXPECT_EQ(FW_OK, fwWorld_CreateFireEmitter(w.world, &old, &id)) << lastMessage(w.world);

    const fw::Context context = [] {
        FwContextDef def = fwDefaultContextDef();
        def.backend = FW_BACKEND_CPU;
        return fw::createContext(def);
    }();
    FwWorldDef def = fwDefaultWorldDef();
    def.metersPerUnit = 0.3048f;
    const fw::World feet = fw::createWorld(context, def);
    EXPECT_FLOAT_EQ(2 / 0.3048f, fw::def<FwRoomDef>(feet).halfSize[0]);
    EXPECT_FLOAT_EQ(fw::preset(FW_FIRE_HOUSE).diameter / 0.3048f,
                    fw::preset(feet, FW_FIRE_HOUSE).diameter);
}

TEST(WorldUnit, CookedMeshesHoldMetresAndLoadInEveryUnit) {
    UnitWorld cm(0.01f), metres(1);
    host::Sheet sheet(0.5f, 0.375f, 2);
    FwMeshDef def = sheet.def(64);
    std::vector<float> details = sheet.uvs;
    def.details = details.data();
    const auto cook = [&] {
        uint64_t size = 0;
        EXPECT_EQ(FW_OK, fwCookMesh(cm.context, &def, nullptr, &size)) << lastMessage(cm.context);
        Bytes bytes(size);
        EXPECT_EQ(FW_OK, fwCookMesh(cm.context, &def, bytes.data(), &size));
        return bytes;
    };
    const Bytes ofMetres = cook();
    for (float& value : sheet.positions) value *= 100;
    for (float& value : details) value *= 100;
    def.metersPerUnit = 0.01f;
    const Bytes ofCentimetres = cook();
    EXPECT_EQ(ofMetres, ofCentimetres);
    for (UnitWorld* w : {&cm, &metres}) {
        FwMeshDef cooked = fwDefaultMeshDef();
        cooked.cooked = ofMetres.data();
        cooked.cookedSize = ofMetres.size();
        FwMeshId id{};
        ASSERT_EQ(FW_OK, fwWorld_CreateMesh(w->world, &cooked, &id)) << lastMessage(w->world);
        auto info = fw::info<FwMeshInfo>();
        ASSERT_EQ(FW_OK, fwWorld_GetMeshInfo(w->world, id, &info));
        EXPECT_EQ(w == &cm ? 50.0f : 0.5f, info.boundsHigh[0]);
        EXPECT_FLOAT_EQ(0.1875f, info.area);
        // A reused slot has the unit of its new mesh.
        ASSERT_EQ(FW_OK, fwWorld_DestroyMesh(w->world, id));
        cooked.metersPerUnit = 0.25f;
        ASSERT_EQ(FW_OK, fwWorld_CreateMesh(w->world, &cooked, &id));
        ASSERT_EQ(FW_OK, fwWorld_GetMeshInfo(w->world, id, &info));
        EXPECT_EQ(2, info.boundsHigh[0]);
        ASSERT_EQ(FW_OK, fwWorld_DestroyMesh(w->world, id));
        cooked.metersPerUnit = 0;
        ASSERT_EQ(FW_OK, fwWorld_CreateMesh(w->world, &cooked, &id));
        ASSERT_EQ(FW_OK, fwWorld_GetMeshInfo(w->world, id, &info));
        EXPECT_EQ(w == &cm ? 50.0f : 0.5f, info.boundsHigh[0]);
    }
}

// ---- projections of other clip spaces

using Matrix = std::array<float, 16>;

std::array<double, 4> times(const Matrix& m, const std::array<double, 4>& v) {
    std::array<double, 4> out{};
    for (size_t r = 0; r < 4; ++r)
        for (size_t c = 0; c < 4; ++c) out[r] += double(m[c * 4 + r]) * v[c];
    return out;
}

// As glFrustum builds it, and an orthographic one: y up, depth -1 to 1.
Matrix openGlProjection(bool orthographic) {
    Matrix m{};
    const float near = 0.5f, far = 100;
    m[0] = 1.2f, m[5] = 1.7f, m[8] = 0.1f;
    if (orthographic) {
        m[8] = 0;
        m[10] = -2 / (far - near), m[14] = -(far + near) / (far - near), m[15] = 1;
    } else {
        m[10] = -(far + near) / (far - near), m[11] = -1, m[14] = -2 * far * near / (far - near);
    }
    return m;
}

TEST(ClipSpace, ConvertsOpenGlProjections) {
    for (const bool orthographic : {false, true}) {
        const Matrix gl = openGlProjection(orthographic);
        const Matrix converted = fw::convertedProjection(gl, FW_CLIP_OPENGL);
        const Matrix reversed = fw::convertedProjection(gl, FW_CLIP_OPENGL | FW_CLIP_REVERSE_DEPTH);
        for (const double depth : {0.5, 1.0, 7.0, 100.0}) {
            const std::array<double, 4> point = {0.3, -0.2, -depth, 1};
            const auto a = times(gl, point), b = times(converted, point),
                       c = times(reversed, point);
            EXPECT_NEAR(a[0] / a[3], b[0] / b[3], 1e-6);
            EXPECT_NEAR(-a[1] / a[3], b[1] / b[3], 1e-6) << "y points down";
            EXPECT_NEAR((a[2] / a[3] + 1) / 2, b[2] / b[3], 1e-6) << "as in the depth buffer of GL";
            EXPECT_NEAR(1 - b[2] / b[3], c[2] / c[3], 1e-6);
            EXPECT_NEAR(a[3], b[3], 1e-6);
        }
        const auto near = times(converted, {0, 0, -0.5, 1}),
                   far = times(converted, {0, 0, -100, 1});
        EXPECT_NEAR(0, near[2] / near[3], 1e-6);
        EXPECT_NEAR(1, far[2] / far[3], 1e-6);
    }
}

TEST(ClipSpace, ConvertsEachDifferenceIndependently) {
    const Matrix gl = openGlProjection(false);
    EXPECT_EQ(gl, fw::convertedProjection(gl, 0));
    const Matrix flipped = fw::convertedProjection(gl, FW_CLIP_Y_UP);
    Matrix expected = gl;
    for (const size_t i : {1u, 5u, 9u, 13u}) expected[i] = -expected[i];
    EXPECT_EQ(expected, flipped);
    EXPECT_EQ(gl, fw::convertedProjection(flipped, FW_CLIP_Y_UP)) << "converting twice restores it";
    // A reversed, infinite camera with Vulkan's depth changes only in y.
    Matrix infinite{};
    infinite[0] = 1, infinite[5] = 1, infinite[11] = -1, infinite[14] = 0.1f;
    const auto at = times(fw::convertedProjection(infinite, FW_CLIP_Y_UP), {0, 1, -0.1, 1});
    EXPECT_NEAR(1, at[2] / at[3], 1e-6) << "near stays 1";
    EXPECT_LT(at[1], 0);
}

}  // namespace
