// The makers behind kit.h, grouped by file. Internal to the village.
#pragma once

#include "kit.h"
#include "mesh_builder.h"
#include "palette.h"

namespace village {

inline void useTimber(MeshBuilder& b, Vec3 tint = palette::kTimber) {
    b.use(Texture::kTimber, Material::kWood, tint);
}

// kit_buildings.cpp
struct HutStyle {
    float length = 4, width = 3.2f;  // m, of the walls
    float wallHeight = 2.05f;        // m
    float rise = 2.15f;              // m, eave to ridge
    float hip = 0.75f;               // m, inset of the ridge's ends
    Vec3 wall = palette::kLime, trim = palette::kTeal, roof = palette::kThatch;
    int bays = 2;  // along the front; one of them is the door
};
Model makeHut(const char* name, const HutStyle& style, uint32_t seed);
Model makeRoundHut(uint32_t seed);
Model makeBarn(uint32_t seed);
Model makeWindmill(uint32_t seed);

// kit_nature.cpp
Model makeRailFence(uint32_t seed, bool broken);
Model makeWattle(uint32_t seed);
Model makeOak(const char* name, Vec3 leaf, uint32_t seed);
Model makePoplar(uint32_t seed);
Model makeDeadTree(uint32_t seed);
Model makeBush(uint32_t seed);
Model makeFarOak(const char* name, Vec3 leaf, uint32_t seed);
Model makeFarPine(uint32_t seed);
Model makeRoundBale(uint32_t seed);
Model makeHayrick(uint32_t seed);
Model makeBales(uint32_t seed);
Model makeDryGrass(uint32_t seed);
Model makeWheat(uint32_t seed);
Model makeReeds(uint32_t seed);
Model makeFlowers(uint32_t seed);

// kit_props.cpp
Model makeBarrel(uint32_t seed);
Model makeCrate(uint32_t seed);
Model makeHayCart(uint32_t seed);
Model makeWell(uint32_t seed);
Model makeMarketStall(uint32_t seed);
Model makeScarecrow(uint32_t seed);
Model makeLampPost(uint32_t seed);
Model makeWoodpile(uint32_t seed);
Model makeGateArch(uint32_t seed);
Model makeBrazier(uint32_t seed);

// kit_enemies.cpp
Model makeStrawMan(uint32_t seed);
Model makeYuleGoat(uint32_t seed);
Model makeLogKnight(uint32_t seed);
Model makeWickerGiant(uint32_t seed);

// kit_towers.cpp
Model makeFlamethrower(uint32_t seed);
Model makeFlamePlinth(uint32_t seed);
Model makeEmberMortar(uint32_t seed);
Model makeWaterCannon(uint32_t seed);
Model makeWindFan(uint32_t seed);

}  // namespace village
