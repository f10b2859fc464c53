// The village's colours: linear Rec.709 albedo. The hue identifies the type: cool grey road, brown
// houses, olive grass, yellow and crimson enemies, one saturated accent per tower. Orange is
// reserved for fire.
#pragma once

#include "village_math.h"

namespace village::palette {

constexpr Vec3 kLime{0.66f, 0.56f, 0.41f}, kTimber{0.105f, 0.056f, 0.030f};
constexpr Vec3 kWood{0.27f, 0.165f, 0.090f}, kOldWood{0.19f, 0.145f, 0.105f};
constexpr Vec3 kBarn{0.29f, 0.050f, 0.030f}, kTeal{0.045f, 0.185f, 0.19f};
constexpr Vec3 kMustard{0.50f, 0.29f, 0.05f}, kBlue{0.045f, 0.13f, 0.36f};
constexpr Vec3 kWhite{0.72f, 0.68f, 0.58f};
constexpr Vec3 kThatch{0.285f, 0.190f, 0.092f}, kGreyThatch{0.225f, 0.178f, 0.118f};
constexpr Vec3 kStraw{0.76f, 0.52f, 0.14f};  // the enemies' yellow: brightest on screen
constexpr Vec3 kHay{0.40f, 0.285f, 0.105f};  // must stay browner than kStraw
constexpr Vec3 kWicker{0.30f, 0.175f, 0.065f}, kPeeledLog{0.36f, 0.235f, 0.135f};
constexpr Vec3 kLeafOak{0.105f, 0.185f, 0.030f}, kLeafPoplar{0.165f, 0.205f, 0.035f};
constexpr Vec3 kLeafAutumn{0.40f, 0.15f, 0.018f}, kLeafPine{0.035f, 0.088f, 0.040f};
constexpr Vec3 kStone{0.34f, 0.315f, 0.275f}, kIron{0.075f, 0.076f, 0.080f};
constexpr Vec3 kBrass{0.62f, 0.37f, 0.11f}, kCopper{0.55f, 0.22f, 0.10f};
constexpr Vec3 kCrimson{0.40f, 0.014f, 0.045f};  // the enemies' accent
// One accent per tower: flamethrower, mortar, water cannon, wind fan.
constexpr Vec3 kVermilion{0.66f, 0.075f, 0.015f}, kOchre{0.50f, 0.26f, 0.03f};
constexpr Vec3 kSky{0.04f, 0.17f, 0.48f}, kMint{0.10f, 0.42f, 0.36f};

}  // namespace village::palette
