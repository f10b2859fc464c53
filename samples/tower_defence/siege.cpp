// See siege.h.
#include "siege.h"

#include <algorithm>
#include <cmath>

namespace tower {

using game::TowerKind;
using village::Vec2;
using village::Vec3;

namespace {

constexpr float kChest = 1.1f;          // m above the road: aim of the jets
constexpr Vec3 kMuzzle{0, 2.6f, 1.1f};  // of the ember mortar, in its model's space
constexpr Vec3 kSpout{0, 2.42f, 2.4f};  // of the water cannon
constexpr float kSprayRadius = 1.4f;    // m
constexpr float kSprayWide = 1.2f;      // m, of its sheet
constexpr float kSprayLong = 11.0f;     // m
constexpr float kRoof = 2.6f;           // m above the ground: aim of the water
constexpr float kFanHeight = 2;         // m, of its centre
constexpr float kFanReach = 2;          // factor of its range: the wind carries beyond the road
constexpr float kFanWidth = 0.6f;       // end radius of the wind zone, relative to its length
constexpr float kEmberPower = 40;       // kW
constexpr float kEmberSeconds = 44 * kTickSeconds;
constexpr Vec3 kCoals{0, 1.12f, 0};  // of a brazier, in its model's space
constexpr float kBrazierPower = 70;  // kW
constexpr float kAirOfSide = 0.06f;  // m^3/s into a house per m^2 of its walls

glm::vec3 onGround(game::Point point, float above) {
    const Vec2 place = metres(point);
    return {place.x, village::groundHeight(place) + above, place.y};
}

// Outside the world's fires: nothing burns down there.
village::Frame away() { return village::translate(0, -300, 0); }

}  // namespace

Siege::Siege(FwWorld* world, FireVillage& fires, const Battlefield& field, const game::State& state)
    : world_(world), fires_(fires), field_(field), state_(state) {
    for (const village::Instance& instance : field.scene.instances) {
        Placed placed;
        placed.model = instance.model;
        placed.frame = instance.frame;
        placed.tint = instance.tint;
        placed_.push_back(placed);
        if (village::Kit(instance.model) == village::Kit::kBrazier) lightBrazier(instance.frame);
    }
    for (const auto& kinds : field.towers)
        for (const size_t instance : kinds) placed_[instance].moves = true;
    for (const size_t instance : field.enemies) {
        placed_[instance].moves = true;
        fires_.move(fires_.thingOf(instance), away());
    }
    makeEmitters();
    makeRooms();
    moveEnemies();
    aimTowers();
}

// A permanent fire on its coals. lampLights() in main.cpp provides its light.
void Siege::lightBrazier(const village::Frame& frame) {
    FwFireEmitterDef fire = fwDefaultFireEmitterDef();
    fire.flags = FW_EMITTER_NO_LIGHT;
    fire.shape = FW_EMITTER_DISC;
    fire.radius = 0.3f;
    fire.power = kBrazierPower;
    fire.smoke = 0.12f;
    const glm::vec3 coals = toGlm(frame.point(kCoals));
    std::copy_n(&coals[0], 3, fire.position);
    FwFireEmitterId id{};
    check(fwWorld_CreateFireEmitter(world_, &fire, &id), "fwWorld_CreateFireEmitter");
}

void Siege::makeEmitters() {
    for (size_t plot = 0; plot < game::kPlots; ++plot) {
        const glm::vec3 place = onGround(field_.ground.plots[plot], 3);
        FwFireEmitterDef jet = fwDefaultFireEmitterDef();
        jet.flags = FW_EMITTER_JET | FW_EMITTER_IGNITES | FW_EMITTER_GROUND;
        jet.seed = uint32_t(plot) + 1;
        jet.power = float(game::kTowers[size_t(TowerKind::kFlamethrower)].strength.back());
        jet.maxParticles = 140;
        jet.rate = 85;
        jet.smokeLife = 1.2f;
        jet.behind = 0.3f;
        jet.stick = 0.5f;
        jet.stickTime = 4;
        jet.ground = place.y - 3;
        std::copy_n(&place[0], 3, jet.position);
        check(fwWorld_CreateFireEmitter(world_, &jet, &jets_[plot]), "fwWorld_CreateFireEmitter");

        FwFireEmitterDef ember = fwDefaultFireEmitterDef();
        ember.seed = uint32_t(plot) + 100;
        ember.power = kEmberPower;
        ember.maxParticles = 60;
        ember.inherit = 0.15f;
        std::copy_n(&place[0], 3, ember.position);
        check(fwWorld_CreateFireEmitter(world_, &ember, &embers_[plot]),
              "fwWorld_CreateFireEmitter");

        FwParticleFieldDef water = fwDefaultParticleFieldDef();
        check(fwInitFieldPreset(&water, FW_FIELD_WATER), "fwInitFieldPreset");
        water.seed = uint32_t(plot) + 1;
        water.width = 32;
        water.height = 64;
        water.rise = 2.2f;  // points along the sheet, in the direction of the water
        water.life = 2.0f;
        water.amount = 0;
        water.source = FW_FIELD_SOURCE_BASE;
        water.sourceSize = 0.5f;
        water.open = FW_FIELD_OPEN_LEFT | FW_FIELD_OPEN_RIGHT | FW_FIELD_OPEN_TOP;
        water.windResponse = 0;
        water.size[0] = kSprayWide;
        water.size[1] = kSprayLong;
        std::copy_n(&place[0], 3, water.position);
        check(fwWorld_CreateParticleField(world_, &water, &sprays_[plot]),
              "fwWorld_CreateParticleField");

        const FwWindZoneDef fan = windOfPlot(plot);
        check(fwWorld_CreateWindZone(world_, &fan, &fans_[plot]), "fwWorld_CreateWindZone");
    }
}

// Creates a compartment per house, which flashes over when its fire fills it.
void Siege::makeRooms() {
    for (size_t house = 0; house < game::kHouses; ++house) {
        const Thing& thing = houseThing(house);
        const Vec3 x = thing.frame.x, size = (thing.high - thing.low) * 0.5f;
        const float scale = std::sqrt(x.x * x.x + x.y * x.y + x.z * x.z);
        const glm::vec3 middle = toGlm(thing.frame.point((thing.high + thing.low) * 0.5f));
        const float half[3] = {size.x * scale, size.y * scale, size.z * scale};
        const float turned = std::atan2(-x.z, x.x);
        FwRoomDef room = fwDefaultRoomDef();
        std::copy_n(&middle[0], 3, room.position);
        std::copy_n(half, 3, room.halfSize);
        room.rotation[1] = std::sin(turned / 2);
        room.rotation[3] = std::cos(turned / 2);
        // Eaves, shutters and thatch admit so much air that the fire burns for long.
        const float sides = 8 * (half[0] * half[1] + half[1] * half[2] + half[2] * half[0]);
        room.vent = kAirOfSide * sides;
        check(fwWorld_CreateRoom(world_, &room, &rooms_[house]), "fwWorld_CreateRoom");
    }
}

const char* Siege::give(const game::Order& order) {
    const char* refused = game::give(state_, field_.ground, order);
    if (!refused) aimTowers();
    return refused;
}

game::Burning Siege::queryBurning() {
    game::Burning burning;
    for (size_t i = 0; i < game::kEnemySlots; ++i) {
        const Thing& thing = fires_.things[fires_.thingOf(field_.enemies[i])];
        burning.enemyBurnt[i] = thing.burnt();
        burning.enemyAlight[i] = thing.state.burning > 0;
    }
    for (size_t i = 0; i < game::kHouses; ++i) {
        const Thing& thing = houseThing(i);
        burning.houseBurnt[i] = thing.burnt();
        burning.houseAlight[i] = thing.state.burning > 0;
        // Reads the state instead of the event: saves contain the state, and a rewind misses no
        // event.
        FwRoomState room{};
        room.structSize = sizeof room;
        check(fwWorld_GetRoomState(world_, rooms_[i], &room), "fwWorld_GetRoomState");
        burning.houseFlashed[i] = room.flashedOver != 0;
    }
    return burning;
}

void Siege::apply(const game::Event& event) {
    using Type = game::Event::Type;
    switch (event.type) {
        case Type::kBorn:
            fires_.replace(fires_.thingOf(field_.enemies[size_t(event.slot)]));
            break;
        case Type::kEmberLands:
            fires_.ignite(onGround(event.place, 0.6f), 0.001f * float(event.strength));
            break;
        case Type::kBeamFalls:
            fires_.dropBeam(fires_.thingOf(field_.houses[size_t(event.slot)]),
                            size_t(event.strength));
            break;
        case Type::kSprays:
            fires_.wet(onGround(event.place, kRoof), kSprayRadius, float(event.strength));
            fires_.wet(onGround(event.place, kRoof + 1.6f), kSprayRadius, float(event.strength));
            break;
        default:
            break;
    }
}

void Siege::moveEnemies() {
    for (size_t i = 0; i < game::kEnemySlots; ++i) {
        const game::Enemy& enemy = state_.enemies[i];
        const size_t thing = fires_.thingOf(field_.enemies[i]);
        Placed& placed = placed_[field_.enemies[i]];
        const bool was = placed.there;
        placed.there = enemy.phase != game::Phase::kAway;
        if (placed.there) {
            // Varies the size by a tenth.
            const float size = 0.95f + 0.0125f * float(enemy.born * 5 % 8);
            placed.frame = enemyFrame(field_.ground, enemy, size);
            fires_.move(thing, placed.frame);
        } else if (was) {
            fires_.move(thing, away());
        }
    }
}

void Siege::aimJet(size_t plot) {
    const game::Tower& tower = state_.towers[plot];
    const bool fires = tower.kind == TowerKind::kFlamethrower && tower.streams > 0;
    const auto& rule = game::kTowers[size_t(TowerKind::kFlamethrower)];
    check(fwWorld_SetFireEmitterPower(world_, jets_[plot],
                                      fires ? float(rule.strength[size_t(tower.level)]) : 0),
          "fwWorld_SetFireEmitterPower");
    if (tower.kind != TowerKind::kFlamethrower) return;
    const village::Frame frame = towerFrame(field_.ground.plots[plot], tower.aim);
    const glm::vec3 nozzle = toGlm(frame.point(village::kNozzle));
    // Gravity bends the stream, so aim slightly higher.
    const glm::vec3 delta = onGround(tower.aim, kChest) - nozzle;
    const float flat = std::sqrt(delta.x * delta.x + delta.z * delta.z);
    const glm::vec3 direction(delta.x, delta.y + 0.02f * flat * flat, delta.z);
    check(fwWorld_MoveFireEmitter(world_, jets_[plot], &nozzle[0], &direction[0]),
          "fwWorld_MoveFireEmitter");
}

void Siege::flyEmber(size_t plot) {
    const game::Tower& tower = state_.towers[plot];
    const bool flies = tower.kind == TowerKind::kEmberMortar && tower.flies > 0;
    check(fwWorld_SetFireEmitterPower(world_, embers_[plot], flies ? kEmberPower : 0),
          "fwWorld_SetFireEmitterPower");
    if (!flies) return;
    const village::Frame frame = towerFrame(field_.ground.plots[plot], tower.aim);
    const glm::vec3 from = toGlm(frame.point(kMuzzle)), to = onGround(tower.falls, 0.5f);
    const float t = 1 - float(tower.flies) * kTickSeconds / kEmberSeconds;
    constexpr float kArc = 5.0f;  // m above the straight line
    const glm::vec3 place = glm::mix(from, to, t) + glm::vec3(0, 4 * kArc * t * (1 - t), 0);
    check(fwWorld_MoveFireEmitter(world_, embers_[plot], &place[0], nullptr),
          "fwWorld_MoveFireEmitter");
}

// Aims a sheet of water from the spout to its landing point.
void Siege::aimSpray(size_t plot) {
    const game::Tower& tower = state_.towers[plot];
    const bool cannon = tower.kind == TowerKind::kWaterCannon;
    const bool sprays = cannon && tower.streams > 0;
    check(fwWorld_SetParticleFieldAmount(world_, sprays_[plot], sprays ? 1.0f : 0.0f),
          "fwWorld_SetParticleFieldAmount");
    check(fwWorld_SetParticleFieldHidden(world_, sprays_[plot],
                                         !cannon || (tower.target < 0 && !sprays)),
          "fwWorld_SetParticleFieldHidden");
    if (!cannon) return;
    const village::Frame frame = towerFrame(field_.ground.plots[plot], tower.aim);
    const glm::vec3 spout = toGlm(frame.point(kSpout));
    const glm::vec3 delta = glm::normalize(onGround(tower.aim, kRoof) - spout);
    // The shortest rotation from up to that direction; water never points straight down.
    const glm::vec4 turn = glm::normalize(glm::vec4(delta.z, 0, -delta.x, 1 + delta.y));
    check(fwWorld_MoveParticleField(world_, sprays_[plot], &spout[0], &turn[0]),
          "fwWorld_MoveParticleField");
}

// Returns a wind cone that reaches slightly beyond the road.
FwWindZoneDef Siege::windOfPlot(size_t plot) const {
    const game::Tower& tower = state_.towers[plot];
    const Vec2 blows = metres(game::fanOf(state_, field_.ground, plot));
    const glm::vec3 place = onGround(field_.ground.plots[plot], kFanHeight);
    const float reach =
        0.001f * float(game::kTowers[size_t(TowerKind::kWindFan)].range[size_t(tower.level)]);
    FwWindZoneDef zone = fwDefaultWindZoneDef();
    zone.shape = FW_WIND_CONE;
    std::copy_n(&place[0], 3, zone.position);
    zone.speed = village::length(blows);
    if (zone.speed > 0) {
        zone.axis[0] = blows.x;
        zone.axis[2] = blows.y;
    }
    zone.size[0] = kFanReach * reach;
    zone.size[1] = kFanWidth * zone.size[0];
    zone.falloff = 0.6f;
    return zone;
}

void Siege::turnFan(size_t plot) {
    const FwWindZoneDef zone = windOfPlot(plot);
    check(fwWorld_SetWindZone(world_, fans_[plot], &zone), "fwWorld_SetWindZone");
}

void Siege::aimTowers() {
    for (size_t plot = 0; plot < game::kPlots; ++plot) {
        const game::Tower& tower = state_.towers[plot];
        for (size_t kind = 0; kind < game::kTowerKinds; ++kind) {
            Placed& placed = placed_[field_.towers[plot][kind]];
            const bool plinth = TowerKind(kind) == TowerKind::kNone;
            placed.there =
                plinth ? tower.kind == TowerKind::kNone || tower.kind == TowerKind::kFlamethrower
                       : tower.kind == TowerKind(kind);
            if (placed.there && !plinth)
                placed.frame = towerFrame(field_.ground.plots[plot], tower.aim);
        }
        aimJet(plot);
        flyEmber(plot);
        aimSpray(plot);
        turnFan(plot);
    }
}

void Siege::advance(int32_t ticks) {
    events_.clear();
    brokenHouses_ = 0;
    if (ticks == 0) return;
    fires_.observe();
    brokenHouses_ = fires_.broke();
    const game::Burning burning = queryBurning();
    for (int32_t i = 0; i < ticks; ++i) game::tick(state_, field_.ground, burning, events_);
    for (const game::Event& event : events_) apply(event);
    moveEnemies();
    aimTowers();
    const Vec2 wind = metres(state_.wind);
    wind_.velocity = {wind.x, wind.y};
    wind_.blown += wind_.velocity * (float(ticks) * kTickSeconds);
    const float metresPerSecond[3] = {wind.x, 0, wind.y};
    check(fwWorld_SetWind(world_, metresPerSecond), "fwWorld_SetWind");
    for (const Thing& thing : fires_.things) placed_[thing.instance].drawn = !thing.lit;
}

void Siege::restore(const Snapshot& snapshot) {
    check(fwWorld_Load(world_, snapshot.world.data(), snapshot.world.size()), "fwWorld_Load");
    state_ = snapshot.state;
    wind_ = snapshot.wind;
    fires_.restore(snapshot.flags);
    events_.clear();
    moveEnemies();
    aimTowers();
    for (const Thing& thing : fires_.things) placed_[thing.instance].drawn = !thing.lit;
}

void Siege::addLights(float scale, std::vector<PointLight>& lights) const {
    for (size_t plot = 0; plot < game::kPlots; ++plot) {
        const game::Tower& tower = state_.towers[plot];
        if (tower.kind != TowerKind::kFlamethrower || tower.streams == 0) continue;
        const village::Frame frame = towerFrame(field_.ground.plots[plot], tower.aim);
        const glm::vec3 nozzle = toGlm(frame.point(village::kNozzle));
        PointLight light;
        light.place = glm::mix(nozzle, onGround(tower.aim, kChest), 0.6f) + glm::vec3(0, 0.5f, 0);
        light.color = glm::vec3(1.0f, 0.40f, 0.095f) * scale;
        light.reach = 10;
        lights.push_back(light);
    }
}

}  // namespace tower
