// See battlefield.h.
#include "battlefield.h"

#include <algorithm>
#include <cmath>

namespace tower {

using village::Kit;
using village::Vec2;

namespace {

// Plots lie beside the road, with space for a plinth and no other object.
constexpr std::array<Vec2, game::kPlots> kPlotPlaces{
    {village::kFlamethrowerPlace,  // inside the first bend
     {-8.3f, -6.4f},               // inside the second
     {8.8f, 4.6f},                 // by the pond
     {-15.0f, -3.6f},              // west of the middle leg
     {-3.5f, 13.2f},               // south of the front leg
     {8.2f, 10.4f},                // south of the first bend
     {-12.4f, -13.0f},             // north of the second
     {-4.4f, 1.4f}}};              // between the legs

constexpr std::array<Kit, game::kEnemyKinds> kEnemyKits{Kit::kStrawMan, Kit::kYuleGoat,
                                                        Kit::kLogKnight, Kit::kWickerGiant};
constexpr std::array<Kit, game::kTowerKinds> kTowerKits{
    Kit::kFlamePlinth, Kit::kFlamethrower, Kit::kEmberMortar, Kit::kWaterCannon, Kit::kWindFan};
constexpr std::array<Kit, 5> kHouseKits{Kit::kCottage, Kit::kLonghouse, Kit::kRoundHut, Kit::kBarn,
                                        Kit::kWindmill};

template <size_t kCount>
bool isAnyOf(const std::array<Kit, kCount>& kits, int model) {
    return std::find(kits.begin(), kits.end(), Kit(model)) != kits.end();
}

game::Point millimetres(Vec2 place) {
    return {int32_t(std::lround(1000 * place.x)), int32_t(std::lround(1000 * place.y))};
}

size_t put(village::Scene& scene, Kit model, const village::Frame& frame) {
    village::Instance instance;
    instance.model = int(model);
    instance.frame = frame;
    instance.seed = uint32_t(scene.instances.size());
    scene.instances.push_back(instance);
    return scene.instances.size() - 1;
}

}  // namespace

bool isHouse(int model) { return isAnyOf(kHouseKits, model); }

village::Vec2 metres(game::Point point) {
    return {0.001f * float(point.x), 0.001f * float(point.z)};
}

village::Frame towerFrame(game::Point plot, game::Point aim) {
    const Vec2 place = metres(plot), direction = metres({aim.x - plot.x, aim.z - plot.z});
    return village::translate(place.x, village::groundHeight(place), place.y) *
           village::rotateY(std::atan2(direction.x, direction.y));
}

village::Frame enemyFrame(const game::Ground& ground, const game::Enemy& enemy, float size) {
    constexpr float kFallTicks = 22, kStride = 4.2f;  // rad of its step per metre
    const float down = std::min(1.0f, float(enemy.lies) / kFallTicks), going = 1 - down;
    const float step = kStride * 0.001f * float(enemy.along) / size + float(enemy.born);
    game::Point direction;
    const Vec2 middle = metres(game::roadPoint(ground, enemy.along, &direction));
    // A panicking enemy leaves its file.
    const float stagger = enemy.alight > 0 ? 0.35f * std::sin(0.09f * float(enemy.alight)) : 0;
    const Vec2 d = metres(direction);
    const Vec2 place = middle + Vec2{-d.y, d.x} * (0.001f * float(enemy.side) + stagger);
    const float high =
        village::groundHeight(place) + 0.1f + 0.09f * std::fabs(std::sin(step)) * going;
    return village::translate(place.x, high, place.y) * village::rotateY(std::atan2(d.x, d.y)) *
           village::scale(size) * village::rotateZ(0.07f * std::sin(step) * going) *
           village::rotateX(0.06f * going + 1.45f * down * down);
}

Battlefield makeBattlefield(uint32_t seed) {
    Battlefield field;
    field.scene = village::makeVillage(seed);
    std::vector<village::Instance>& instances = field.scene.instances;
    std::erase_if(instances, [](const village::Instance& instance) {
        return instance.roadMetres >= 0 || isAnyOf(kTowerKits, instance.model);
    });
    size_t house = 0;
    for (size_t i = 0; i < instances.size(); ++i) {
        if (!isHouse(instances[i].model) || house == game::kHouses) continue;
        const village::Vec3 at = instances[i].frame.origin;
        field.ground.houses[house] = millimetres({at.x, at.z});
        field.houses[house++] = i;
    }
    const float length = village::roadLength();
    Vec2 direction;
    for (float along = 0; along < length - 1; along += 0.001f * float(game::Ground::kRoadStep))
        field.ground.road.push_back(millimetres(village::roadPoint(along, &direction)));
    for (size_t plot = 0; plot < game::kPlots; ++plot) {
        const game::Point place = field.ground.plots[plot] = millimetres(kPlotPlaces[plot]);
        const village::Frame frame = towerFrame(place, game::nearestOfRoad(field.ground, place));
        for (size_t kind = 0; kind < game::kTowerKinds; ++kind)
            field.towers[plot][kind] = put(field.scene, kTowerKits[kind], frame);
    }
    for (size_t slot = 0; slot < game::kEnemySlots; ++slot) {
        field.enemies[slot] = put(field.scene, kEnemyKits[size_t(game::kindOf(slot))],
                                  enemyFrame(field.ground, game::Enemy{}, 1));
        instances[field.enemies[slot]].roadMetres = 0;
    }
    return field;
}

}  // namespace tower
