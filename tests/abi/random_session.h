// Sessions of a host drawn from a seed. The commands of each frame are known before any world runs,
// so several worlds can run the same session. Objects are named by numbers. Creation and
// destruction can run apart from the rest, as in a host that builds a world to load into.
#pragma once
#include "abi/busy_world.h"

#include <map>
#include <utility>

namespace host {

struct Act {
    enum Kind : uint32_t {
        // Commands that build a world.
        makeObject,
        dropObject,
        makeZone,
        dropZone,
        makeRoom,
        dropRoom,
        makeOccluder,
        dropOccluder,
        makeFire,
        dropFire,
        makeJet,
        dropJet,
        makeField,
        dropField,
        lastOfBuilding = dropField,
        // Commands whose effects a save holds.
        ignite,
        moveObject,
        wind,
        gusts,
        grid,
        flags,
        shield,
        setZone,
        setRoom,
        moveHeatOccluder,
        moveFire,
        firePower,
        firePoints,
        moveJet,
        jetPower,
        moveField,
        fieldAmount,
        tag,
        play,
        stopPlay,
        carry,
        shift,
        kinds
    };
    // Kinds of makeObject in a scripted game; smaller numbers are those of a random session.
    static constexpr uint32_t house = 4096, figure = 4097;
    Kind kind = ignite;
    uint32_t name = 0, other = 0;
    float numbers[12] = {};
};

struct Session {
    FwWorldDef world = fwDefaultWorldDef();
    bool sees = false;    // the host answers sight queries
    bool played = false;  // a scripted game with houses and figures
    std::vector<std::vector<Act>> frames;
    std::vector<float> times;  // s of each frame
    std::vector<bool> polls;   // the host polls after each frame
};

// A box without a floor that stands on y = 0, with unique UVs.
struct Block {
    std::vector<float> positions, uvs;
    std::vector<uint32_t> indices;

    Block(float x, float y, float z) {
        const float longest = 2 * std::max({x, y, z});
        const float corners[5][4][3] = {{{0, 0, z}, {x, 0, z}, {x, y, z}, {0, y, z}},
                                        {{x, 0, 0}, {0, 0, 0}, {0, y, 0}, {x, y, 0}},
                                        {{x, 0, z}, {x, 0, 0}, {x, y, 0}, {x, y, z}},
                                        {{0, 0, 0}, {0, 0, z}, {0, y, z}, {0, y, 0}},
                                        {{0, y, z}, {x, y, z}, {x, y, 0}, {0, y, 0}}};
        const float sizes[5][2] = {{x, y}, {x, y}, {z, y}, {z, y}, {x, z}};
        for (int face = 0; face < 5; ++face) {
            const auto first = uint32_t(positions.size() / 3);
            for (int k = 0; k < 4; ++k) {
                const float* at = corners[face][k];
                positions.insert(positions.end(), {at[0] - x / 2, at[1], at[2] - z / 2});
                const float u = k == 1 || k == 2 ? sizes[face][0] : 0.0f;
                const float v = k >= 2 ? sizes[face][1] : 0.0f;
                // Charts of the faces side by side in a 3 x 2 grid.
                uvs.insert(uvs.end(), {(float(face % 3) * 0.6f * longest + u) / (2 * longest),
                                       (float(face / 3) * 0.6f * longest + v) / (2 * longest)});
            }
            for (const uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) indices.push_back(first + k);
        }
    }
    [[nodiscard]] FwMeshDef def() const {
        FwMeshDef made = fwDefaultMeshDef();
        made.positions = positions.data();
        made.uvs = uvs.data();
        made.vertexCount = uint32_t(positions.size() / 3);
        made.indices = indices.data();
        made.indexCount = uint32_t(indices.size());
        made.noiseAmplitude = 0.2f;
        return made;
    }
};

class SessionDraw {
 public:
    // exact: without jets, fires and fields, whose hits depend on float results.
    explicit SessionDraw(uint64_t seed, bool exact = false)
        : state_(seed * 0x9E3779B97F4A7C15ull + 1), exact_(exact) {}

    Session draw(uint32_t frames) {
        Session made;
        FwWorldDef& def = made.world;
        def.flags = below(4) ? 15 : below(16);
        def.paceFactor = float(4 + below(16));
        def.seed = below(1000);
        def.wind[0] = between(-3, 3);
        if (once(3)) def.maxBurningTiles = 15 + below(40);
        if (once(4)) def.timeToLive = between(1, 5);
        if (once(4)) def.spreadChance = between(0.4f, 1);
        if (once(4)) def.maxHops = 1 + below(2);
        made.sees = once(3);
        made.frames.resize(frames);
        for (uint32_t frame = 0; frame < frames; ++frame) {
            std::vector<Act>& acts = made.frames[frame];
            now_ = &acts;
            if (frame == 0) begin();
            for (uint32_t i = below(4); i-- > 0;) one();
            const uint32_t kind = below(12);
            made.times.push_back(kind == 0   ? 0.0f
                                 : kind == 1 ? 1.0f / 60
                                 : kind == 2 ? between(0, 0.3f)
                                             : float(1 + below(4)) / 32);
            made.polls.push_back(once(2));
            carries_ = carries_ && made.times.back() < 1.0f / 32;
        }
        return made;
    }

 private:
    uint32_t next() {
        state_ ^= state_ << 13, state_ ^= state_ >> 7, state_ ^= state_ << 17;
        return uint32_t(state_ >> 32);
    }
    uint32_t below(uint32_t most) { return uint32_t((uint64_t(next()) * most) >> 32); }
    bool once(uint32_t in) { return below(in) == 0; }
    float between(float low, float high) { return low + (high - low) * float(below(4096)) / 4096; }
    Act& act(Act::Kind kind, uint32_t name = 0) {
        now_->push_back({kind, name, 0, {}});
        return now_->back();
    }
    uint32_t make(std::vector<uint32_t>& alive) {
        alive.push_back(++names_);
        return names_;
    }
    uint32_t any(const std::vector<uint32_t>& alive) {
        return alive[below(uint32_t(alive.size()))];
    }
    uint32_t drop(std::vector<uint32_t>& alive) {
        const uint32_t at = below(uint32_t(alive.size()));
        const uint32_t name = alive[at];
        alive.erase(alive.begin() + at);
        return name;
    }
    // Close together so that objects touch, seldom at the limits of space. In whole parts of a
    // metre, so a world with another origin has the same places.
    void place(float* at, bool far = true) {
        at[0] = 0.3125f * float(below(5)) + (once(3) ? between(0, 0.2f) : 0.0f);
        at[1] = once(3) ? between(-0.2f, 0.4f) : 0.0f;
        at[2] = 0.3125f * float(below(3)) + (once(3) ? between(0, 0.2f) : 0.0f);
        for (int i = 0; i < 3; ++i) at[i] = std::round(at[i] * 64) / 64;
        if (far && !exact_ && once(24)) at[below(3)] = once(2) ? 1e6f : -1e6f;
    }
    static void aside(float* at) {
        if (std::abs(at[2]) < 100) at[2] -= 0.8125f;
    }
    void object() {
        Act& made = act(Act::makeObject, make(objects_));
        place(made.numbers);
        made.other = below(4096);  // its kind
        made.numbers[3] = once(3) ? between(-1, 1) : 0.0f;
    }
    void begin() {
        for (int i = 0; i < 6; ++i) object();
        Act& fire = act(Act::ignite, objects_[0]);
        fire.numbers[3] = 0.4f;
        std::copy_n((*now_)[0].numbers, 3, fire.numbers);
    }
    void one() {
        const uint32_t kind = below(54);
        if (kind < 8) {
            Act& ball = act(Act::ignite, once(2) && !objects_.empty() ? any(objects_) : 0);
            place(ball.numbers);
            ball.numbers[3] = between(0, 0.4f);
            ball.numbers[4] = once(3) ? between(0, 0.6f) : 0.0f;  // delay
            const uint32_t what = below(8);
            ball.other = what < 5 ? FW_IGNITE : what == 5 ? FW_EXTINGUISH : FW_WET;
            if (ball.other == FW_WET) ball.numbers[5] = between(0, 300);
        } else if (kind < 14 && !objects_.empty()) {
            Act& move = act(Act::moveObject, any(objects_));
            place(move.numbers);
            move.numbers[3] = once(2) ? between(-1, 1) : 0.0f;
        } else if (kind < 17) {
            if (objects_.size() > 3 && !carries_) act(Act::dropObject, drop(objects_));
            if (objects_.size() < 8 && once(2)) object();
        } else if (kind == 17) {
            if (objects_.size() < 8) object();
        } else if (kind < 20) {
            Act& blow = act(Act::wind);
            for (int i = 0; i < 3; ++i) blow.numbers[i] = between(-5, 5);
        } else if (kind == 20) {
            Act& gusts = act(Act::gusts);
            gusts.numbers[0] = once(2) ? between(0, 1) : 0.0f;
            gusts.numbers[1] = between(1, 10);
        } else if (kind == 21) {
            Act& grid = act(Act::grid);
            grid.other = once(4) ? 0 : 1 + below(100);
        } else if (kind == 22) {
            act(Act::flags).other = once(4) ? below(16) : 15;
        } else if (kind == 23) {
            Act& cells = act(Act::shield, objects_.empty() || once(2) ? 0 : any(objects_));
            cells.other = once(4) ? 0 : 1 + below(100);
        } else if (kind < 26) {
            if (zones_.empty() || (zones_.size() < 3 && once(2)))
                place(act(Act::makeZone, make(zones_)).numbers);
            else if (once(3))
                act(Act::dropZone, drop(zones_));
            else
                place(act(Act::setZone, any(zones_)).numbers);
        } else if (kind < 28) {
            if (rooms_.empty() || (rooms_.size() < 2 && once(2)))
                place(act(Act::makeRoom, make(rooms_)).numbers, false);
            else if (once(3))
                act(Act::dropRoom, drop(rooms_));
            else
                place(act(Act::setRoom, any(rooms_)).numbers, false);
        } else if (kind < 30) {
            if (occluders_.empty() || (occluders_.size() < 3 && once(2)))
                place(act(Act::makeOccluder, make(occluders_)).numbers);
            else if (once(3))
                act(Act::dropOccluder, drop(occluders_));
            else
                place(act(Act::moveHeatOccluder, any(occluders_)).numbers);
        } else if (kind < 41 && exact_) {
            return;
        } else if (kind < 34) {
            fire();
        } else if (kind < 38) {
            jet();
        } else if (kind < 41) {
            if (fields_.empty())
                place(act(Act::makeField, make(fields_)).numbers, false);
            else if (once(5))
                act(Act::dropField, drop(fields_));
            else if (once(2))
                place(act(Act::moveField, any(fields_)).numbers);
            else
                act(Act::fieldAmount, any(fields_)).numbers[0] = between(0, 4);
        } else if (kind < 45 && !objects_.empty()) {
            Act& tag = act(Act::tag, any(objects_));
            place(tag.numbers);
            tag.other = below(50);
        } else if (kind == 48 && !objects_.empty()) {
            Act& carry = act(Act::carry, any(objects_));
            carry.other = any(objects_);
            carries_ = true;
        } else if (kind >= 50) {
            // Some shifts go back, and some add up.
            const float side = once(4) ? -1.0f : 1.0f;
            if (side > 0)
                for (float& metres : shift_)
                    metres = float(below(once(3) ? 30000 : 3000)) * (once(2) ? 1.0f : -1.0f);
            Act& shift = act(Act::shift);
            for (int i = 0; i < 3; ++i) shift.numbers[i] = side * shift_[i];
        } else if (!objects_.empty()) {
            const uint32_t name = any(objects_);
            Act& play = act(once(4) ? Act::stopPlay : Act::play, name);
            play.numbers[0] = once(2) ? between(0, 0.5f) : 0.0f;
            play.numbers[1] = between(0.5f, 4);
        }
    }
    void fire() {
        if (fires_.empty() || (fires_.size() < 2 && once(2))) {
            Act& made = act(Act::makeFire, make(fires_));
            place(made.numbers);
            made.numbers[3] = between(1, 200);
            return;
        }
        if (once(4)) {
            act(Act::dropFire, drop(fires_));
        } else if (once(3)) {
            place(act(Act::moveFire, any(fires_)).numbers);
        } else if (once(2)) {
            act(Act::firePower, any(fires_)).numbers[0] = between(0, 200);
        } else {
            Act& points = act(Act::firePoints, any(fires_));
            points.other = once(3) ? 0 : 2;
            place(points.numbers);
            place(points.numbers + 3);
        }
    }
    void jet() {
        if (jets_.empty() || (jets_.size() < 2 && once(2))) {
            Act& made = act(Act::makeJet, make(jets_));
            place(made.numbers);
            aside(made.numbers);
            made.numbers[3] = once(8) ? 100000.0f : between(50, 800);
            made.numbers[4] = once(2) ? between(0.2f, 1) : 0.0f;  // sticks
            return;
        }
        if (once(5)) {
            act(Act::dropJet, drop(jets_));
        } else if (once(2)) {
            Act& move = act(Act::moveJet, any(jets_));
            place(move.numbers);
            aside(move.numbers);
            move.numbers[3] = between(-0.5f, 0.5f);
            move.numbers[4] = 0.1f;
            move.numbers[5] = 1;
        } else {
            act(Act::jetPower, any(jets_)).numbers[0] = once(3) ? 0 : between(50, 800);
        }
    }

    uint64_t state_;
    bool exact_ = false;
    uint32_t names_ = 0;
    bool carries_ = false;  // the object that gives a burn stays until the step that applies it
    float shift_[3] = {};   // m, the last shift
    std::vector<Act>* now_ = nullptr;
    std::vector<uint32_t> objects_, zones_, rooms_, occluders_, fires_, jets_, fields_;
};

// A world that runs a session, or the part of it that builds a world.
class SessionWorld {
 public:
    SessionWorld(FwContext* context, const Session& given, const Bytes& burn = {})
        : session(given) {
        FwWorldDef def = given.world;
        if (given.sees) def.visibility = sees;
        ok(fwCreateWorld(context, &def, &world));
        makeMeshes();
        if (!burn.empty()) ok(fwWorld_CreateBurn(world, burn.data(), burn.size(), &burn_));
    }
    SessionWorld(const SessionWorld&) = delete;
    SessionWorld& operator=(const SessionWorld&) = delete;
    ~SessionWorld() { fwDestroyWorld(world); }

    void build(uint32_t frame) {
        for (const Act& act : session.frames[frame])
            if (act.kind <= Act::lastOfBuilding) doOne(here(act));
    }
    void act(uint32_t frame) {
        for (const Act& act : session.frames[frame]) doOne(here(act));
    }
    void step(uint32_t frame) { ok(fwWorld_Step(world, session.times[frame])); }
    void shift(double x, double y, double z) {
        const float by[3] = {float(x), float(y), float(z)};
        (void)fwWorld_ShiftOrigin(world, by, nullptr);
        ok(fwWorld_GetOrigin(world, origin));
    }
    // Runs other commands than the session, so that nothing is as it was at creation.
    void liveOtherwise(uint32_t frames) {
        const float wind[3] = {3, 1, -2};
        ok(fwWorld_SetWind(world, wind));
        FwIgnitionDef ball = fwDefaultIgnitionDef();
        ball.radius = 3;
        ok(fwWorld_Ignite(world, &ball, nullptr));
        ball.delay = 40;  // still pending when it loads
        ok(fwWorld_Ignite(world, &ball, nullptr));
        for (uint32_t i = 0; i < frames; ++i) {
            for (const auto& [name, id] : objects) {
                float at[16];
                poseAt(at, 0.3f * float(name % 4), 0.02f * float(i), 0.3f * float(name / 4 % 4),
                       0.1f * float(i));
                moveByOrigin(at + 12);
                ok(fwWorld_SetTransform(world, id, at));
                if (i == 0) ok(fwWorld_TagPoint(world, id, at + 12, 99));
            }
            ok(fwWorld_Step(world, 1.0f / 16));
            if (i == 2) shift(100, -20, 3);
        }
    }
    // Hashes every texel, its heat and the tick.
    uint64_t hash() {
        std::vector<FwBurnableMeshId> ids;
        for (const auto& [name, id] : objects) ids.push_back(id);
        return hashOf(world, ids);
    }
    struct Place {
        double at[3];  // m from the origin at creation
    };
    // Events since the last poll in words, without what depends on the frame number. `places`
    // receives their places, which are then left out of the words.
    std::vector<std::string> poll(std::vector<Place>* places = nullptr) {
        std::vector<std::string> reported;
        FwEvent events[64];
        for (uint32_t count; (count = fwWorld_PollEvents(world, events, 64)) != 0;)
            for (uint32_t i = 0; i < count; ++i) {
                const FwEvent& e = events[i];
                // No save holds events of destroyed objects.
                if (e.object.index1 != 0 && nameOf(e.object) == 0) continue;
                char text[200], where[100] = "";
                if (places && e.type != FW_EVENT_TIME_DROPPED)
                    places->push_back(
                        {{double(e.position[0]) - origin[0], double(e.position[1]) - origin[1],
                          double(e.position[2]) - origin[2]}});
                else
                    std::snprintf(where, sizeof where, " at %.9g %.9g %.9g", double(e.position[0]),
                                  double(e.position[1]), double(e.position[2]));
                std::snprintf(text, sizeof text, "type %u tag %u of %u by %u%s: %.9g", e.type,
                              e.tag, nameOf(e.object), nameOf(e.other), where, double(e.value));
                reported.emplace_back(text);
            }
        return reported;
    }
    // The state that a host reads, in words.
    std::string figures() {
        char text[400];
        const FwWorldStats s = getState(fwWorld_GetStats, world);
        std::snprintf(text, sizeof text,
                      "steps %llu tick %llu front %u burning %u of %u objects hot %u late %u "
                      "dropped %u\n",
                      static_cast<unsigned long long>(s.steps),
                      static_cast<unsigned long long>(s.tick), s.frontTiles, s.burningTiles,
                      s.burningObjects, s.hotTiles, s.lateClamps, s.droppedSteps);
        std::string all = text;
        const FwEnergyLedger b = getState(fwWorld_GetEnergyLedger, world);
        std::snprintf(text, sizeof text, "fuel %llu left %llu radiated %llu power %.9g\n",
                      static_cast<unsigned long long>(b.fuel),
                      static_cast<unsigned long long>(b.unburnt),
                      static_cast<unsigned long long>(b.radiated), double(b.power));
        all += text;
        for (const auto& [name, id] : objects) {
            const FwObjectState o = getState(fwWorld_GetObjectState, world, id);
            std::snprintf(text, sizeof text,
                          "object %u: ignited %u burning %u front %u power %.9g energy %.17g "
                          "plays %u\n",
                          name, o.ignited, o.burning, o.frontTiles, double(o.power), o.energy,
                          o.playsBakedBurn);
            all += text;
        }
        for (const auto& [name, id] : rooms) {
            const FwRoomState r = getState(fwWorld_GetRoomState, world, id);
            std::snprintf(text, sizeof text, "room %u: oxygen %.9g strength %.9g\n", name,
                          double(r.oxygen), double(r.strength));
            all += text;
        }
        return all;
    }
    // The host's places move with the origin of the save.
    FwResult load(const Bytes& bytes) {
        const FwResult result = fwWorld_Load(world, bytes.data(), bytes.size());
        ok(fwWorld_GetOrigin(world, origin));
        return result;
    }

    const Session& session;
    FwWorld* world = nullptr;
    double origin[3] = {};  // m
    std::map<uint32_t, FwBurnableMeshId> objects;
    std::map<uint32_t, FwRoomId> rooms;

 private:
    void ok(FwResult result) { ASSERT_LE(0, result) << lastMessage(world); }
    static float FW_CALL sees(void*, FwBurnableMeshId from, FwBurnableMeshId to) {
        return float((from.index1 * 7 + to.index1 * 3) % 5) / 4;
    }
    uint32_t nameOf(FwBurnableMeshId id) const {
        for (const auto& [name, mine] : objects)
            if (mine.index1 == id.index1 && mine.generation == id.generation) return name;
        return 0;
    }
    void makeMeshes() {
        const Sheet sheets[2] = {Sheet(0.3f, 0.3f, 2), Sheet(0.3f, 0.2f, 1)};
        for (int i = 0; i < 2; ++i) {
            const FwMeshDef def = sheets[i].def(40);
            ok(fwWorld_CreateMesh(world, &def, &meshes_[i]));
        }
        if (!session.played) return makeMaterials();
        const Block blocks[2] = {Block(1.0f, 0.8f, 0.9f), Block(0.3f, 0.6f, 0.2f)};
        for (int i = 0; i < 2; ++i) {
            FwMeshDef def = blocks[i].def();
            def.texelsPerMetre = i == 0 ? 16.0f : 24.0f;
            ok(fwWorld_CreateMesh(world, &def, &blocks_[i]));
        }
        makeMaterials();
    }
    // Houses have heat and report lost parts; figures are LITE and end charred.
    void makePlayed(uint32_t kind, FwBurnableMeshDef& def) const {
        const bool isHouse = kind == Act::house;
        def.mesh = blocks_[isHouse ? 0 : 1];
        def.materials[0] = isHouse ? thatch_ : materials_[1];
        def.flags = FW_BURNABLE_HIDDEN;
        if (isHouse) {
            def.breakShare = 0.2f;
            def.breakArea = 0.5f;
        } else {
            def.flags |= FW_BURNABLE_LITE | FW_BURNABLE_NO_HOLES;
        }
    }
    void makeMaterials() {
        static const uint32_t presets[3] = {FW_MATERIAL_PAPER, FW_MATERIAL_COTTON,
                                            FW_MATERIAL_PLYWOOD};
        for (int i = 0; i < 3; ++i) {
            FwMaterialDef material = materialOf(presets[i]);
            ok(fwWorld_CreateMaterial(world, &material, &materials_[i]));
            FwMaterialDef thatch = materialOf(FW_MATERIAL_THATCH);
            thatch.spreadRate *= 2;
            thatch.burnTime *= 1.7f;
            if (session.played) ok(fwWorld_CreateMaterial(world, &thatch, &thatch_));
        }
    }
    void moveByOrigin(float* place) const {
        // The limits of space are relative to the first origin.
        for (int i = 0; i < 3; ++i)
            if (std::abs(place[i]) < 1e5f) place[i] = float(double(place[i]) + origin[i]);
    }
    // A session's places are relative to the first origin.
    Act here(Act act) const {
        switch (act.kind) {
            case Act::makeObject:
            case Act::makeZone:
            case Act::makeRoom:
            case Act::makeOccluder:
            case Act::makeFire:
            case Act::makeJet:
            case Act::makeField:
            case Act::ignite:
            case Act::moveObject:
            case Act::setZone:
            case Act::setRoom:
            case Act::moveHeatOccluder:
            case Act::moveFire:
            case Act::moveJet:
            case Act::moveField:
            case Act::tag:
                moveByOrigin(act.numbers);
                break;
            case Act::firePoints:
                moveByOrigin(act.numbers);
                moveByOrigin(act.numbers + 3);
                break;
            default:
                break;
        }
        return act;
    }
    template <class Id>
    static Id idOf(const std::map<uint32_t, Id>& all, uint32_t name) {
        const auto found = all.find(name);
        return found == all.end() ? Id{} : found->second;
    }
    FwWindZoneDef zoneOf(const Act& act) const {
        FwWindZoneDef def = fwDefaultWindZoneDef();
        def.shape = act.name % 2 ? FW_WIND_SPHERE : FW_WIND_BOX;
        std::copy_n(act.numbers, 3, def.position);
        def.axis[0] = 1, def.axis[1] = def.axis[2] = 0;
        for (float& size : def.size) size = 0.8f;
        def.speed = 4;
        def.priority = int32_t(act.name % 3);
        if (act.numbers[6] != 0) {  // a fan
            def.shape = FW_WIND_CONE;
            std::copy_n(act.numbers + 3, 3, def.axis);
            def.size[0] = 2.5f;
            def.speed = act.numbers[6];
        }
        return def;
    }
    FwRoomDef roomOf(const Act& act) const {
        FwRoomDef def = fwDefaultRoomDef();
        std::copy_n(act.numbers, 3, def.position);
        for (float& half : def.halfSize) half = 0.7f;
        def.volume = 0.4f;
        def.vent = act.name % 2 ? 0.05f : 0.0f;
        if (session.played) def.volume = 6, def.vent = 2;  // houses burn for long
        return def;
    }
    void doOne(const Act& act) {
        const float* n = act.numbers;
        float at[16];
        switch (act.kind) {
            case Act::makeObject: {
                FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
                poseAt(def.transform, n[0], n[1], n[2], n[3]);
                if (act.other >= Act::house) {
                    makePlayed(act.other, def);
                    return ok(fwWorld_CreateBurnableMesh(world, &def, &objects[act.name]));
                }
                def.mesh = meshes_[act.other % 2];
                def.materials[0] = materials_[act.other / 2 % 3];
                if (act.other / 6 % 3 == 0) def.flags |= FW_BURNABLE_LITE;
                if (act.other / 18 % 4 == 0) def.maxBurningTiles = 4;
                if (act.other / 72 % 4 == 0) def.timeToLive = 2;
                if (act.other / 288 % 3 == 0) def.breakShare = 0.3f, def.breakArea = 0.002f;
                return ok(fwWorld_CreateBurnableMesh(world, &def, &objects[act.name]));
            }
            case Act::dropObject:
                ok(fwWorld_DestroyBurnableMesh(world, objects[act.name]));
                objects.erase(act.name);
                return;
            case Act::makeZone: {
                const FwWindZoneDef def = zoneOf(act);
                return ok(fwWorld_CreateWindZone(world, &def, &zones_[act.name]));
            }
            case Act::setZone: {
                const FwWindZoneDef def = zoneOf(act);
                return ok(fwWorld_SetWindZone(world, zones_[act.name], &def));
            }
            case Act::dropZone:
                return ok(fwWorld_DestroyWindZone(world, zones_[act.name]));
            case Act::makeRoom: {
                const FwRoomDef def = roomOf(act);
                return ok(fwWorld_CreateRoom(world, &def, &rooms[act.name]));
            }
            case Act::setRoom: {
                const FwRoomDef def = roomOf(act);
                return ok(fwWorld_SetRoom(world, rooms[act.name], &def));
            }
            case Act::dropRoom:
                ok(fwWorld_DestroyRoom(world, rooms[act.name]));
                rooms.erase(act.name);
                return;
            case Act::makeOccluder: {
                FwHeatOccluderDef def = fwDefaultHeatOccluderDef();
                poseAt(def.transform, n[0], n[1], n[2], 0);
                for (float& half : def.halfSize) half = 0.1f;
                return ok(fwWorld_AddHeatOccluder(world, &def, &occluders_[act.name]));
            }
            case Act::moveHeatOccluder:
                poseAt(at, n[0], n[1], n[2], 0.3f);
                return ok(fwWorld_MoveHeatOccluder(world, occluders_[act.name], at));
            case Act::dropOccluder:
                return ok(fwWorld_RemoveHeatOccluder(world, occluders_[act.name]));
            case Act::makeFire: {
                FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
                def.flags |= FW_FIRE_IGNITES;
                std::copy_n(n, 3, def.position);
                def.power = n[3];
                return ok(fwWorld_CreateVolumetricFire(world, &def, &fires_[act.name]));
            }
            case Act::moveFire:
                return ok(fwWorld_MoveVolumetricFire(world, fires_[act.name], n));
            case Act::firePower:
                return ok(fwWorld_SetVolumetricFirePower(world, fires_[act.name], n[0]));
            case Act::firePoints: {
                FwFirePoint points[2] = {};
                for (int i = 0; i < 2; ++i) {
                    std::copy_n(n + 3 * i, 3, points[i].position);
                    points[i].radius = 0.15f;
                }
                return ok(
                    fwWorld_SetVolumetricFirePoints(world, fires_[act.name], points, act.other));
            }
            case Act::dropFire:
                return ok(fwWorld_DestroyVolumetricFire(world, fires_[act.name]));
            case Act::makeJet: {
                FwFireEmitterDef def = fwDefaultFireEmitterDef();
                def.flags = FW_EMITTER_JET | FW_EMITTER_IGNITES;
                std::copy_n(n, 3, def.position);
                def.direction[0] = def.direction[1] = 0;
                def.direction[2] = 1;
                def.power = n[3];
                def.stick = n[4];
                def.stickTime = 2;
                def.maxParticles = 16;
                return ok(fwWorld_CreateFireEmitter(world, &def, &jets_[act.name]));
            }
            case Act::moveJet:
                return ok(fwWorld_MoveFireEmitter(world, jets_[act.name], n, n + 3));
            case Act::jetPower:
                return ok(fwWorld_SetFireEmitterPower(world, jets_[act.name], n[0]));
            case Act::dropJet:
                return ok(fwWorld_DestroyFireEmitter(world, jets_[act.name]));
            case Act::makeField: {
                FwParticleFieldDef def = fwDefaultParticleFieldDef();
                ok(fwInitFieldPreset(&def, FW_FIELD_WATER));
                def.flags |= FW_FIELD_WETS;
                std::copy_n(n, 3, def.position);
                def.width = def.height = 32;
                return ok(fwWorld_CreateParticleField(world, &def, &fields_[act.name]));
            }
            case Act::moveField:
                return ok(fwWorld_MoveParticleField(world, fields_[act.name], n, nullptr));
            case Act::fieldAmount:
                return ok(fwWorld_SetParticleFieldAmount(world, fields_[act.name], n[0]));
            case Act::dropField:
                return ok(fwWorld_DestroyParticleField(world, fields_[act.name]));
            case Act::ignite: {
                FwIgnitionDef def = fwDefaultIgnitionDef();
                def.kind = act.other;
                def.object = idOf(objects, act.name);
                std::copy_n(n, 3, def.position);
                def.radius = n[3];
                def.delay = n[4];
                def.water = n[5];
                return ok(fwWorld_Ignite(world, &def, nullptr));
            }
            case Act::moveObject:
                poseAt(at, n[0], n[1], n[2], n[3]);
                return ok(fwWorld_SetTransform(world, objects[act.name], at));
            case Act::wind:
                return ok(fwWorld_SetWind(world, n));
            case Act::gusts: {
                FwGustDef def = fwDefaultGustDef();
                def.strength = n[0];
                def.size = n[1];
                return ok(fwWorld_SetGusts(world, &def));
            }
            case Act::grid: {
                if (act.other == 0) return ok(fwWorld_SetWindGrid(world, nullptr));
                FwWindGridDef def = fwDefaultWindGridDef();
                def.counts[0] = 3, def.counts[1] = def.counts[2] = 2;
                for (float& value : def.origin) value = -0.3125f;
                moveByOrigin(def.origin);
                float velocities[36];
                for (uint32_t i = 0; i < 36; ++i) velocities[i] = float((i * act.other) % 9) - 4;
                def.velocities = velocities;
                return ok(fwWorld_SetWindGrid(world, &def));
            }
            case Act::flags:
                return ok(fwWorld_SetFlags(world, act.other));
            case Act::shield: {
                if (act.other == 0) return ok(fwWorld_SetHeatOcclusion(world, nullptr));
                FwHeatOcclusionDef def = fwDefaultHeatOcclusionDef();
                for (uint32_t& count : def.counts) count = 8;
                for (float& value : def.origin) value = -0.1875f;
                moveByOrigin(def.origin);
                def.cellSize = 0.2f;
                uint8_t cells[512];
                for (uint32_t i = 0; i < 512; ++i) cells[i] = (i * act.other) % 97 == 3;
                def.cells = cells;
                const FwBurnableMeshId own = idOf(objects, act.name);
                def.objects = &own;
                def.objectCount = own.index1 != 0 ? 1 : 0;
                return ok(fwWorld_SetHeatOcclusion(world, &def));
            }
            case Act::tag:
                (void)fwWorld_TagPoint(world, objects[act.name], n,
                                       act.other);  // too far: tags nothing
                return;
            case Act::play:  // refused on another mesh
                if (burn_.index1 != 0)
                    (void)fwWorld_PlayBurn(world, objects[act.name], burn_, n[0], n[1]);
                return;
            case Act::stopPlay:
                return ok(fwWorld_StopBurn(world, objects[act.name]));
            case Act::carry:  // refused if the two differ in shape
                (void)fwWorld_TransferBurn(world, objects[act.name], objects[act.other]);
                return;
            case Act::shift:  // refused if an object is at the limits of space
                return shift(double(n[0]), double(n[1]), double(n[2]));
            case Act::kinds:
                break;
        }
    }

    FwMeshId meshes_[2] = {}, blocks_[2] = {};
    FwMaterialId materials_[3] = {}, thatch_{};
    FwBurnId burn_{};
    std::map<uint32_t, FwWindZoneId> zones_;
    std::map<uint32_t, FwHeatOccluderId> occluders_;
    std::map<uint32_t, FwVolumetricFireId> fires_;
    std::map<uint32_t, FwFireEmitterId> jets_;
    std::map<uint32_t, FwParticleFieldId> fields_;
};

// Until all readbacks have arrived.
inline void settle(SessionWorld& w) {
    for (int i = 0; i < 6; ++i) EXPECT_EQ(FW_OK, fwWorld_Step(w.world, 0)) << lastMessage(w.world);
}

// True if a command changes where later reports of earlier events are.
inline bool drops(const Session& session, uint32_t frame) {
    return std::any_of(session.frames[frame].begin(), session.frames[frame].end(),
                       [](const Act& act) {
                           return act.kind == Act::dropObject || act.kind == Act::dropRoom ||
                                  act.kind == Act::moveObject || act.kind == Act::shift;
                       });
}

// A baked burn of the first mesh of every session.
inline Bytes burnOfSession(FwContext* context) {
    Session alone;
    alone.world.paceFactor = 10;
    alone.frames.resize(1);
    alone.frames[0].push_back({Act::makeObject, 1, 0, {}});
    SessionWorld w(context, alone);
    w.build(0);
    FwIgnitionDef ball = fwDefaultIgnitionDef();
    ball.object = w.objects[1];
    EXPECT_EQ(FW_OK, fwWorld_Ignite(w.world, &ball, nullptr));
    for (int i = 0; i < 60; ++i) EXPECT_EQ(FW_OK, fwWorld_Step(w.world, 1.0f / 32));
    EXPECT_EQ(FW_OK, fwWorld_RequestBurn(w.world, w.objects[1]));
    uint64_t size = 0;
    come(w.world, [&] { return fwWorld_FetchBurn(w.world, w.objects[1], nullptr, &size); });
    Bytes bytes(size);
    EXPECT_EQ(FW_OK, fwWorld_FetchBurn(w.world, w.objects[1], bytes.data(), &size));
    return bytes;
}

}  // namespace host
