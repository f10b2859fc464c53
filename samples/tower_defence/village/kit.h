// The kit: all models of the village, by name. Metres, y up, front = +z, origin on the ground. A
// short root reaches below it for slopes.
#pragma once

#include <vector>

#include "model.h"

namespace village {

enum class Kit : int {
    kCottage,
    kLonghouse,
    kRoundHut,
    kBarn,
    kWindmill,
    kRailFence,
    kWattle,
    kBrokenRail,
    kOak,
    kPoplar,
    kDeadTree,
    kAutumnOak,
    kBush,
    kRoundBale,
    kHayrick,
    kBales,
    kDryGrass,
    kWheat,
    kReeds,
    kFlowers,
    kBarrel,
    kCrate,
    kHayCart,
    kWell,
    kMarketStall,
    kScarecrow,
    kLampPost,
    kWoodpile,
    kGateArch,
    kBrazier,
    kStrawMan,
    kYuleGoat,
    kLogKnight,
    kWickerGiant,
    kFlamethrower,
    kEmberMortar,
    kWaterCannon,
    kWindFan,
    kFarOak,
    kFarPine,
    kFarAutumnOak,
    kFlamePlinth,
    kCount,
};

// Returns all models in the order of Kit. Deterministic.
std::vector<Model> makeKit();

}  // namespace village
