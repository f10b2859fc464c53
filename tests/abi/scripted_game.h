// A tower defence game played by a script. Figures walk along a road past houses and respawn in the
// slots of fallen ones. Jets, embers and water aim at them, fans turn, houses flash over and break.
// One house changes its level of detail, and the origin follows the camera. The commands of a frame
// depend only on its number.
#pragma once
#include "abi/random_session.h"

namespace host {

class ScriptedGame {
 public:
    static constexpr uint32_t kFrames = 240;

    static Session play() {
        ScriptedGame game;
        for (uint32_t frame = 0; frame < kFrames; ++frame) game.frame(frame);
        return game.made_;
    }

 private:
    static constexpr uint32_t kHouses = 3, kFigures = 5, kPlots = 3;
    static constexpr float kAway = -300;  // m below the ground: outside the game
    struct Place {
        float x, y, z;
    };
    static constexpr Place kHouseAt[kHouses] = {
        {-1.5f, 0, 1.25f}, {0.25f, 0, 1.25f}, {1.75f, 0, -1.25f}};
    static constexpr Place kPlotAt[kPlots] = {
        {-1.25f, 0.5f, -0.75f}, {0.5f, 0.5f, -0.75f}, {1.25f, 0.5f, 0.75f}};

    ScriptedGame() {
        made_.played = made_.sees = true;
        made_.world.flags =
            FW_WORLD_RADIATION | FW_WORLD_PLUME | FW_WORLD_CONTACT | FW_WORLD_EMBERS;
        made_.world.paceFactor = 14;
        made_.world.seed = 3;
        made_.world.maxBurningTiles = 220;
        made_.frames.resize(kFrames);
        made_.polls.assign(kFrames, true);
        for (uint32_t frame = 0; frame < kFrames; ++frame)
            made_.times.push_back(frame % 37 == 36   ? 0.0f  // the game is paused
                                  : frame % 23 == 22 ? 0.2f  // a slow frame
                                  : frame % 7 == 3   ? 1.0f / 60
                                                     : 1.0f / 16);
    }
    Act& act(Act::Kind kind, uint32_t name = 0, Place at = {0, 0, 0}) {
        Act& made = made_.frames[now_].emplace_back();
        made.kind = kind;
        made.name = name;
        made.numbers[0] = at.x, made.numbers[1] = at.y, made.numbers[2] = at.z;
        return made;
    }
    uint32_t make(Act::Kind kind, Place at, uint32_t other = 0) {
        act(kind, ++names_, at).other = other;
        return names_;
    }
    void ball(uint32_t kind, Place at, float radius, float delay, float water = 0) {
        Act& made = act(Act::ignite, 0, at);
        made.other = kind;
        made.numbers[3] = radius;
        made.numbers[4] = delay;
        made.numbers[5] = water;
    }
    // Position along the road, bobbing; fallen figures lie.
    [[nodiscard]] Place walks(uint32_t slot) const {
        if (now_ < born_[slot] || born_[slot] == 0) return {float(slot), kAway, 0};
        const float age = std::min(float(now_ - born_[slot]), 90.0f);
        return {-2.5f + 0.0625f * age, age < 90 ? 0.0625f * float(now_ % 3) : 0.0f,
                0.25f * float(slot % 2)};
    }
    // The figure nearest to a plot.
    [[nodiscard]] Place target(uint32_t plot) const {
        Place best = walks(0);
        for (uint32_t slot = 1; slot < kFigures; ++slot) {
            const Place at = walks(slot), from = kPlotAt[plot];
            if (at.y > kAway + 1 &&
                (best.y < kAway + 1 || std::abs(at.x - from.x) < std::abs(best.x - from.x)))
                best = at;
        }
        return best.y < kAway + 1 ? Place{0, 0.25f, 0} : best;
    }
    void begin() {
        for (uint32_t i = 0; i < kHouses; ++i) {
            houses_[i] = make(Act::makeObject, kHouseAt[i], Act::house);
            rooms_[i] = make(Act::makeRoom, {kHouseAt[i].x, kHouseAt[i].y + 0.5f, kHouseAt[i].z});
        }
        for (uint32_t slot = 0; slot < kFigures; ++slot)
            figures_[slot] = make(Act::makeObject, walks(slot), Act::figure);
        for (uint32_t plot = 0; plot < kPlots; ++plot) {
            jets_[plot] = make(Act::makeJet, kPlotAt[plot]);
            made_.frames[now_].back().numbers[3] = 250;
            made_.frames[now_].back().numbers[4] = 0.5f;
            act(Act::jetPower, jets_[plot]);
            if (plot == 0) continue;
            sprays_[plot] = make(Act::makeField, kPlotAt[plot]);
            fans_[plot] = make(Act::makeZone, kPlotAt[plot]);
        }
        for (const float x : {-0.75f, 1.0f})
            walls_.push_back(make(Act::makeOccluder, {x, 0, 0.75f}));
        make(Act::makeFire, {-2.0f, 0, -0.25f});  // a brazier by the road
        made_.frames[now_].back().numbers[3] = 40;
        for (uint32_t i = 0; i < kHouses; ++i) tag(i);
    }
    void tag(uint32_t house) {
        const Place at = kHouseAt[house];
        act(Act::tag, houses_[house], {at.x, at.y + 0.5f, at.z + 0.45f}).other = 10 + house;
    }
    void frame(uint32_t frame) {
        now_ = frame;
        if (frame == 0) begin();
        moveFigures();
        aim();
        world();
        change();
    }
    void moveFigures() {
        if (now_ % 16 == 4) {  // a new figure in the slot of a fallen one
            const uint32_t slot = now_ / 16 % kFigures;
            act(Act::dropObject, figures_[slot]);
            born_[slot] = now_;
            figures_[slot] = make(Act::makeObject, walks(slot), Act::figure);
        }
        for (uint32_t slot = 0; slot < kFigures; ++slot) {
            if (born_[slot] == 0) continue;
            Act& move = act(Act::moveObject, figures_[slot], walks(slot));
            move.numbers[3] = 0.0625f * float(now_ % 5);
            if (now_ >= 104 && now_ < 110 && slot == 1)  // it falls off the world
                move.numbers[0] = 1e6f;
        }
    }
    void aim() {
        for (uint32_t plot = 0; plot < kPlots; ++plot) {
            const uint32_t turn = now_ + 11 * plot;
            if (turn % 30 == 5) act(Act::jetPower, jets_[plot]).numbers[0] = 250;
            if (turn % 30 == 19) act(Act::jetPower, jets_[plot]).numbers[0] = 0;
            const Place at = target(plot), from = kPlotAt[plot];
            Act& move = act(Act::moveJet, jets_[plot], from);
            if (plot == 2 && now_ >= 100 && now_ < 112)  // at a limit of space
                move.numbers[0] = now_ < 106 ? 1e6f : -1e6f;
            const float aimed[3] = {at.x - from.x, at.y - from.y + 0.25f, at.z - from.z};
            std::copy_n(aimed, 3, move.numbers + 3);
            if (plot == 0) continue;
            if (turn % 24 == 3) act(Act::fieldAmount, sprays_[plot]).numbers[0] = 3;
            if (turn % 24 == 15) act(Act::fieldAmount, sprays_[plot]);
            if (now_ % 4 == plot) act(Act::moveField, sprays_[plot], {at.x, at.y, at.z + 0.125f});
            if (now_ % 10 == plot) {
                Act& fan = act(Act::setZone, fans_[plot], from);
                std::copy_n(aimed, 3, fan.numbers + 3);
                fan.numbers[6] = 2 + float(now_ % 4);
            }
        }
        const uint32_t slot = now_ / 16 % kFigures;
        if (now_ % 20 == 9) ball(FW_IGNITE, walks(slot), 0.3f, 0.7f);  // an ember lands
        const Place house = kHouseAt[now_ / 12 % kHouses];
        if (now_ % 40 == 14)  // a part of its roof falls
            ball(FW_IGNITE, {house.x + 0.4f, house.y + 0.25f, house.z + 0.4f}, 0.2f, 0);
        if (now_ > 120 && now_ % 12 == 7)
            ball(FW_WET, {house.x, house.y + 0.75f, house.z}, 0.5f, 0, 120);
        if (now_ == 160) ball(FW_EXTINGUISH, kHouseAt[0], 1.0f, 0);
    }
    void world() {
        if (now_ % 25 == 8) {
            const float turn = float(now_);
            act(Act::wind, 0, {2 * std::cos(turn), 0, 2 * std::sin(turn)});
        }
        if (now_ == 20 || now_ == 190) {
            Act& gusts = act(Act::gusts);
            gusts.numbers[0] = now_ == 20 ? 0.5f : 0.0f;
            gusts.numbers[1] = 1.5f;
        }
        if (now_ == 60 || now_ == 95) act(Act::grid).other = now_ == 60 ? 5 : 0;
        if (now_ == 40 || now_ == 130) act(Act::shield, houses_[1]).other = 7 + now_;
        if (now_ == 175) act(Act::shield);
        if (now_ == 118) act(Act::flags).other = FW_WORLD_RADIATION | FW_WORLD_CONTACT;
        if (now_ == 136) act(Act::flags).other = 15;
        if (now_ % 50 == 30)
            act(Act::moveHeatOccluder, walls_[now_ / 50 % walls_.size()], {0.25f, 0, 0.75f});
        if (now_ == 90 || now_ == 126) {  // a door opens
            const Place at = kHouseAt[1];
            act(Act::setRoom, rooms_[1], {at.x + 0.0625f, at.y + 0.5f, at.z});
        }
        // The camera goes far away and comes back. At frame 104 a figure is at a limit, so the
        // shift is refused.
        if (now_ == 45 || now_ == 46 || now_ == 104 || now_ == 185)
            act(Act::shift, 0, {2048, -16, float(now_) * 8});
        if (now_ == 84 || now_ == 215) act(Act::shift, 0, {-2048, 16, -360});
    }
    void change() {
        if (now_ == 145) {  // another level of detail of a burning house
            const uint32_t fine = make(Act::makeObject, kHouseAt[1], Act::house);
            act(Act::carry, houses_[1]).other = fine;
            coarse_ = std::exchange(houses_[1], fine);
        }
        if (now_ == 147) act(Act::dropObject, coarse_);
        if (now_ == 170) {  // a house is rebuilt
            act(Act::dropObject, houses_[0]);
            act(Act::dropRoom, rooms_[0]);
            houses_[0] = make(Act::makeObject, kHouseAt[0], Act::house);
            rooms_[0] = make(Act::makeRoom, {kHouseAt[0].x, 0.5f, kHouseAt[0].z});
            tag(0);
        }
        if (now_ == 180) {
            act(Act::dropOccluder, walls_[0]);
            walls_.erase(walls_.begin());
        }
        if (now_ == 200) {
            act(Act::dropZone, fans_[1]);
            fans_[1] = make(Act::makeZone, kPlotAt[1]);
            act(Act::dropField, sprays_[1]);
            sprays_[1] = make(Act::makeField, kPlotAt[1]);
            act(Act::dropJet, jets_[0]);
            jets_[0] = make(Act::makeJet, kPlotAt[0]);
            made_.frames[now_].back().numbers[3] = 250;
        }
    }

    Session made_;
    uint32_t now_ = 0, names_ = 0, coarse_ = 0;
    uint32_t houses_[kHouses] = {}, rooms_[kHouses] = {}, figures_[kFigures] = {};
    uint32_t born_[kFigures] = {};
    uint32_t jets_[kPlots] = {}, sprays_[kPlots] = {}, fans_[kPlots] = {};
    std::vector<uint32_t> walls_;
};

}  // namespace host
