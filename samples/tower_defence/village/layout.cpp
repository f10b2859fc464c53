// The placement: by hand where it matters, by hash elsewhere.
#include "layout.h"

namespace village {

namespace {

class Placer {
 public:
    Placer(Scene& scene, uint32_t seed) : scene_(scene), seed_(1000 + seed * 4099) {}

    float random(float low, float high) {
        return low + (high - low) * random01(int(seed_++), 0, 77);
    }
    float turn() { return random(0, 6); }
    Vec3 shade(float low, float high) { return Vec3{1, 1, 1} * random(low, high); }

    void put(Kit model, Vec2 place, float yaw, float size = 1, Vec3 tint = {1, 1, 1}) {
        Instance instance;
        instance.model = int(model);
        instance.frame =
            translate(place.x, groundHeight(place), place.y) * rotateY(yaw) * scale(size);
        instance.seed = seed_++;
        instance.tint = tint;
        scene_.instances.push_back(instance);
    }
    void march(Kit model, float along, float side, float size) {
        Instance instance;
        instance.model = int(model);
        instance.frame = marchFrame(along, side, size) * rotateY(random(-0.15f, 0.15f));
        instance.seed = seed_++;
        instance.roadMetres = along;
        instance.roadSide = side;
        scene_.instances.push_back(instance);
    }

 private:
    Scene& scene_;
    uint32_t seed_;
};

struct Spot {
    Kit model;
    Vec2 place;
    float size = 1;
};

void placeHouses(Placer& p) {
    p.put(Kit::kCottage, {-4.6f, 5.0f}, 0.25f, 0.92f);
    p.put(Kit::kLonghouse, {-12.2f, 4.4f}, -0.12f, 0.92f);
    p.put(Kit::kRoundHut, {-18.0f, 2.6f}, 0.5f, 0.95f);
    p.put(Kit::kCottage, {-4.4f, -6.0f}, -0.3f, 0.92f, {0.95f, 1, 1});
    p.put(Kit::kBarn, {4.6f, -4.6f}, 0.3f, 0.92f);
    p.put(Kit::kCottage, {12.0f, -0.8f}, -0.45f, 0.95f, {1.05f, 0.96f, 0.9f});
    p.put(Kit::kRoundHut, {17.0f, -5.4f}, -0.6f, 0.95f);
    p.put(Kit::kWindmill, kMillPlace, -0.35f, 0.80f);
    p.put(Kit::kCottage, {-18.0f, -8.6f}, 0.5f, 0.92f);
    p.put(Kit::kGateArch, {-16.6f, 9.8f}, 0.95f, 0.95f);
}

void placeTowers(Placer& p) {
    p.put(Kit::kFlamePlinth, kFlamethrowerPlace, 0.9f);
    p.put(Kit::kFlamethrower, kFlamethrowerPlace, 0.9f);
    p.put(Kit::kEmberMortar, {-8.3f, -6.4f}, -0.5f);
    p.put(Kit::kWaterCannon, {8.8f, 4.6f}, -1.1f);
    p.put(Kit::kWindFan, {-15.0f, -3.6f}, 1.25f);
}

// Props between the houses carry the fire from one to the next.
void placeProps(Placer& p) {
    p.put(Kit::kWell, {0.8f, -5.2f}, 0.4f);
    p.put(Kit::kMarketStall, {-0.6f, -8.2f}, -0.1f);
    p.put(Kit::kHayCart, {-8.2f, 6.6f}, 0.9f);
    p.put(Kit::kHayCart, {8.6f, -6.0f}, 1.2f);
    p.put(Kit::kScarecrow, {-1.4f, -16.6f}, 0.2f);
    const Spot spots[] = {{Kit::kBarrel, {-7.6f, 3.6f}},
                          {Kit::kBarrel, {-8.2f, 4.2f}},
                          {Kit::kCrate, {2.2f, -7.4f}},
                          {Kit::kCrate, {2.9f, -7.2f}},
                          {Kit::kBarrel, {8.4f, -3.0f}},
                          {Kit::kWoodpile, {8.6f, -0.8f}},
                          {Kit::kWoodpile, {-14.2f, 6.9f}},
                          {Kit::kBrazier, {-9.6f, 7.6f}},
                          {Kit::kBrazier, {11.2f, -11.0f}},
                          {Kit::kLampPost, {-2.4f, 7.7f}},
                          {Kit::kLampPost, {-5.6f, -4.2f}},
                          {Kit::kLampPost, {6.8f, 7.6f}},
                          {Kit::kLampPost, {3.8f, -12.6f}},
                          {Kit::kHayrick, {-7.4f, -15.0f}},
                          {Kit::kHayrick, {6.6f, -15.4f}, 0.85f},
                          {Kit::kRoundBale, {7.6f, -13.0f}},
                          {Kit::kRoundBale, {9.2f, -13.6f}},
                          {Kit::kBales, {8.6f, -1.9f}},
                          {Kit::kBales, {-6.8f, 12.6f}},
                          {Kit::kRoundBale, {1.2f, 12.0f}, 1.05f},
                          {Kit::kRoundBale, {2.9f, 12.4f}, 0.95f},
                          {Kit::kRoundBale, {18.4f, -0.4f}},
                          {Kit::kHayrick, {17.2f, 1.8f}, 0.9f},
                          {Kit::kRoundBale, {1.2f, -3.8f}, 0.9f}};
    for (const Spot& spot : spots) p.put(spot.model, spot.place, p.turn(), spot.size);
}

void placeTrees(Placer& p) {
    const Spot spots[] = {
        {Kit::kOak, {-8.2f, 1.2f}, 0.7f},       {Kit::kAutumnOak, {9.4f, 1.4f}, 0.75f},
        {Kit::kAutumnOak, {15.4f, 2.6f}, 0.9f}, {Kit::kOak, {18.6f, 8.8f}},
        {Kit::kAutumnOak, {19.4f, 4.4f}},       {Kit::kPoplar, {10.4f, -14.2f}},
        {Kit::kPoplar, {17.6f, -9.6f}},         {Kit::kPoplar, {18.6f, -11.2f}, 0.9f},
        {Kit::kOak, {-15.0f, -11.6f}, 0.9f},    {Kit::kOak, {9.2f, 12.2f}, 0.75f},
        {Kit::kDeadTree, {-21.6f, 5.4f}},       {Kit::kAutumnOak, {-20.6f, -3.8f}, 0.95f},
        {Kit::kBush, {10.2f, 3.3f}, 0.8f},      {Kit::kBush, {-1.8f, 2.6f}, 0.8f},
        {Kit::kBush, {-1.6f, -4.6f}, 0.8f},     {Kit::kBush, {14.8f, -1.2f}},
        {Kit::kBush, {-9.2f, 6.6f}, 0.7f},      {Kit::kBush, {6.8f, 11.0f}},
        {Kit::kBush, {17.6f, 10.8f}, 0.9f}};
    for (const Spot& spot : spots) {
        const float yaw = p.turn(), size = spot.size * p.random(0.92f, 1.08f);
        p.put(spot.model, spot.place, yaw, size, p.shade(0.88f, 1.15f));
    }
}

// A ragged belt of trees frames the left, the back and the right.
void placeForest(Placer& p) {
    constexpr int kTrees = 42;
    for (int i = 0; i < kTrees; ++i) {
        const float t = float(i) / float(kTrees - 1);
        Vec2 place;
        if (t < 0.3f) {
            place.x = -21 - p.random(0, 5);
            place.y = mix(2.0f, -16.0f, t / 0.3f) + p.random(-1, 1);
        } else if (t < 0.78f) {
            place.x = mix(-20.0f, 22.0f, (t - 0.3f) / 0.48f) + p.random(-1, 1);
            place.y = -18.0f - p.random(0, 6);
        } else {
            place.x = 21.5f + p.random(0, 4);
            place.y = mix(-15.0f, 9.0f, (t - 0.78f) / 0.22f) + p.random(-1, 1);
        }
        const float pick = p.random(0, 1);
        const Kit model = pick < 0.60f   ? Kit::kFarPine
                          : pick < 0.86f ? Kit::kFarOak
                          : pick < 0.95f ? Kit::kFarAutumnOak
                                         : Kit::kPoplar;
        const float yaw = p.turn(), size = p.random(0.85f, 1.25f);
        p.put(model, place, yaw, size, p.shade(0.8f, 1.15f));
    }
}

void placeFences(Placer& p) {
    struct Run {
        Vec2 from, to;
        Kit model;
    };
    const Run runs[] = {{{-8.8f, 8.2f}, {-1.0f, 7.7f}, Kit::kRailFence},
                        {{-17.4f, 7.6f}, {-10.6f, 8.2f}, Kit::kWattle},
                        {{-8.8f, 8.0f}, {-8.8f, 4.0f}, Kit::kWattle},
                        {{-6.8f, -4.1f}, {-1.0f, -3.2f}, Kit::kWattle},
                        {{15.0f, 3.8f}, {18.6f, 3.2f}, Kit::kRailFence},
                        {{-7.0f, -13.4f}, {4.8f, -13.4f}, Kit::kRailFence},
                        {{10.4f, 2.4f}, {14.0f, 2.9f}, Kit::kRailFence},
                        {{-17.2f, 12.2f}, {-9.2f, 12.5f}, Kit::kWattle},
                        {{14.2f, -3.4f}, {18.4f, -2.4f}, Kit::kRailFence}};
    for (const Run& run : runs) {
        const Vec2 d = run.to - run.from;
        const int panels = std::max(1, int(length(d) / 2 + 0.5f));
        const float yaw = std::atan2(-d.y, d.x);
        for (int i = 0; i < panels; ++i) {
            const bool broken = run.model == Kit::kRailFence && i == panels / 2 && panels > 3;
            const Vec2 place = run.from + d * ((float(i) + 0.5f) / float(panels));
            p.put(broken ? Kit::kBrokenRail : run.model, place, yaw, length(d) / float(panels) / 2);
        }
    }
}

// Dry grass on dry ground, flowers on lush ground, reeds around the pond.
void placeTufts(Placer& p) {
    for (int i = 0; i < 420; ++i) {
        const float x = p.random(-21, 21), z = p.random(-15, 14);
        const Vec2 place{x, z};
        const RoadPlace road = nearestRoad(place);
        const Splat ground = groundSplat(place, road);
        const float pond = pondDistance(place);
        if (insideYard(place, 0.9f) || road.distance < 1.75f || ground.field > 0.2f) continue;
        Kit model = Kit::kCount;
        if (pond > 0.92f && pond < 1.12f)
            model = Kit::kReeds;
        else if (pond < 1)
            continue;
        else if (ground.dry > 0.55f && ground.dirt < 0.6f)
            model = Kit::kDryGrass;
        else if (ground.dry < 0.2f && ground.dirt < 0.1f && p.random(0, 1) < 0.25f)
            model = Kit::kFlowers;
        if (model == Kit::kCount) continue;
        const float yaw = p.turn(), size = p.random(0.8f, 1.35f);
        p.put(model, place, yaw, size, p.shade(0.8f, 1.2f));
    }
}

void placeWheat(Placer& p) {
    for (int j = 0; j < 5; ++j) {
        for (int i = 0; i < 5; ++i) {
            const Vec2 back{-4.6f + 2.05f * float(i) + p.random(-0.1f, 0.1f),
                            -18.2f + 0.85f * float(j)};
            const float yaw = p.random(-0.05f, 0.05f);
            p.put(Kit::kWheat, back, yaw, 1, p.shade(0.9f, 1.1f));
            if (j >= 3 || i >= 4) continue;
            const Vec2 front{-15.8f + 2.05f * float(i), 13.3f + 0.8f * float(j)};
            p.put(Kit::kWheat, front, p.random(-0.05f, 0.05f));
        }
    }
}

void placeMarchers(Placer& p) {
    struct Marcher {
        Kit model;
        float along, side, size;
    };
    const Marcher marchers[] = {
        {Kit::kStrawMan, 13.4f, 0.7f, 1},       {Kit::kStrawMan, 14.8f, -0.7f, 1},
        {Kit::kStrawMan, 17.0f, 0.5f, 1.05f},   {Kit::kStrawMan, 18.6f, -0.7f, 0.95f},
        {Kit::kStrawMan, 20.6f, 0.6f, 1},       {Kit::kYuleGoat, 26.2f, -0.7f, 1.05f},
        {Kit::kYuleGoat, 27.4f, 0.8f, 1.05f},   {Kit::kLogKnight, 33.2f, 0.5f, 1.15f},
        {Kit::kLogKnight, 37.2f, -0.5f, 1.15f}, {Kit::kWickerGiant, 44.6f, 0, 1},
        {Kit::kStrawMan, 49.0f, 0.7f, 1},       {Kit::kStrawMan, 50.6f, -0.6f, 1},
        {Kit::kYuleGoat, 63.5f, 0.4f, 1.05f},   {Kit::kStrawMan, 8.4f, 0.7f, 1},
        {Kit::kLogKnight, 6.6f, -0.2f, 1.15f}};
    for (const Marcher& m : marchers) p.march(m.model, m.along, m.side, m.size);
}

}  // namespace

Frame marchFrame(float along, float side, float size) {
    Vec2 d;
    const Vec2 centre = roadPoint(along, &d);
    const Vec2 place = centre + Vec2{-d.y, d.x} * side;
    return translate(place.x, groundHeight(place) + 0.1f, place.y) * rotateY(std::atan2(d.x, d.y)) *
           scale(size);
}

Scene makeVillage(uint32_t seed) {
    Scene scene;
    scene.models = makeKit();
    scene.models.push_back(makeJetty());
    scene.models.push_back(makePondShore());
    scene.terrain = makeTerrain();
    scene.road = makeRoad();
    scene.water = makePondWater();
    for (int model : {kJettyModel, kShoreModel}) {
        Instance instance;
        instance.model = model;
        scene.instances.push_back(instance);
    }
    Placer placer(scene, seed);
    placeHouses(placer);
    placeTowers(placer);
    placeProps(placer);
    placeTrees(placer);
    placeForest(placer);
    placeFences(placer);
    placeTufts(placer);
    placeWheat(placer);
    placeMarchers(placer);
    return scene;
}

}  // namespace village
