// The land: road, pond, fields and heights as functions of a position in world metres. x runs east,
// z south (towards the camera). Positions are Vec2 {x, z}.
#pragma once

#include "model.h"
#include "textures.h"

namespace village {

constexpr Vec2 kPondCentre{13.2f, 7.2f};  // m
constexpr Vec2 kMillPlace{13.8f, -12.2f};
constexpr float kWaterLevel = -0.17f;  // m
constexpr float kRoadWidth = 3.3f;     // m

struct RoadPlace {
    float distance = 1e9f;  // m to the centre line
    float along = 0;        // m from the start of the road
    Vec2 direction{1, 0};   // unit, forwards
};

float roadLength();                            // m
RoadPlace nearestRoad(Vec2 place);             // searches every segment
Vec2 roadPoint(float along, Vec2* direction);  // clamped to the road's ends
float pondDistance(Vec2 place);                // < 1 inside, about 1 at the shore
float groundHeight(Vec2 place);                // m
float fieldAt(Vec2 place);                     // 1 in a wheat field, 0 outside
bool insideYard(Vec2 place, float share);      // within `share` of a house's yard
Splat groundSplat(Vec2 place, const RoadPlace& road);
// Returns how worn the road's verge is. Above 1, dirt replaces the cobbles.
float roadEdge(Vec2 place, const RoadPlace& road);

// The ground's models. The terrain's uv is its grid parameter, finer in the centre. The road's u
// runs across (0..1 of kRoadWidth by the chart), v along it.
Model makeTerrain();
Model makeRoad();
Model makePondWater();
Model makePondShore();
Model makeJetty();

}  // namespace village
