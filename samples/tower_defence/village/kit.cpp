// Assembles the kit in the order of Kit.
#include "kit.h"

#include "kit_parts.h"

namespace village {

static HutStyle longhouseStyle() {
    HutStyle s;
    s.length = 6.4f;
    s.width = 3.4f;
    s.wallHeight = 2.1f;
    s.rise = 2.35f;
    s.hip = 0.9f;
    s.wall = palette::kLime * 0.95f;
    s.trim = palette::kBlue * 1.2f;
    s.roof = palette::kThatch * 1.05f;
    s.bays = 3;
    return s;
}

std::vector<Model> makeKit() {
    std::vector<Model> kit;
    kit.reserve(size_t(Kit::kCount));
    kit.push_back(makeHut("cottage", {}, 11));
    kit.push_back(makeHut("longhouse", longhouseStyle(), 12));
    kit.push_back(makeRoundHut(13));
    kit.push_back(makeBarn(14));
    kit.push_back(makeWindmill(15));
    kit.push_back(makeRailFence(20, false));
    kit.push_back(makeWattle(21));
    kit.push_back(makeRailFence(22, true));
    kit.push_back(makeOak("oak", palette::kLeafOak, 30));
    kit.push_back(makePoplar(31));
    kit.push_back(makeDeadTree(33));
    kit.push_back(makeOak("autumn oak", palette::kLeafAutumn, 34));
    kit.push_back(makeBush(35));
    kit.push_back(makeRoundBale(40));
    kit.push_back(makeHayrick(41));
    kit.push_back(makeBales(42));
    kit.push_back(makeDryGrass(50));
    kit.push_back(makeWheat(51));
    kit.push_back(makeReeds(52));
    kit.push_back(makeFlowers(53));
    kit.push_back(makeBarrel(60));
    kit.push_back(makeCrate(61));
    kit.push_back(makeHayCart(62));
    kit.push_back(makeWell(63));
    kit.push_back(makeMarketStall(64));
    kit.push_back(makeScarecrow(65));
    kit.push_back(makeLampPost(66));
    kit.push_back(makeWoodpile(67));
    kit.push_back(makeGateArch(68));
    kit.push_back(makeBrazier(69));
    kit.push_back(makeStrawMan(80));
    kit.push_back(makeYuleGoat(81));
    kit.push_back(makeLogKnight(82));
    kit.push_back(makeWickerGiant(83));
    kit.push_back(makeFlamethrower(90));
    kit.push_back(makeEmberMortar(91));
    kit.push_back(makeWaterCannon(92));
    kit.push_back(makeWindFan(93));
    kit.push_back(makeFarOak("far oak", palette::kLeafOak, 36));
    kit.push_back(makeFarPine(37));
    kit.push_back(makeFarOak("far autumn oak", palette::kLeafAutumn, 38));
    kit.push_back(makeFlamePlinth(94));
    return kit;
}

}  // namespace village
