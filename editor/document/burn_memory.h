// What a live burn remembers of itself, so that a hand can scrub in it both ways: when each texel
// caught, and now and then the whole world as bytes.
//
// A preview at a time is made of the first alone: what has caught by then glows while its material
// chars, and is black after that. It is exact in where the fire has been. It leaves out
// flames, smoke and light, what a second material or water did to how long a texel burns, holes,
// what bent or fell, and wetness; those come with the exact picture, run on from the last kept
// moment once the hand lets go.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "document/burn.h"

namespace fwedit {

class BurnMemory {
 public:
    void begin(const Burn& burn);  // a world at time 0
    void forget();
    // Around fwWorld_RecordOutside: wishes what is due, takes what has come. `step` s are fed.
    void beforeFrame(Burn& burn, float step);
    void afterFrame(Burn& burn);
    // Something that was wished comes with a later frame.
    [[nodiscard]] bool waits() const { return asked_ || behind_; }
    // The fire until then is known.
    [[nodiscard]] bool knows(double time) const { return !ticks_.empty() && time <= known_ + 0.1; }
    [[nodiscard]] double known() const { return known_; }
    // Puts the world back to the latest kept moment until `time`. False: there is none.
    bool restore(Burn& burn, double time);

    // By texel: 0 not lit by then, 1 to 254 how much of its glow is over, 255 charred.
    bool agesAt(const Burn& burn, ObjectId mesh, const PaintSurface& surface, double time,
                std::vector<uint8_t>& values) const;
    // s at which that texel caught; < 0: not, as far as is known.
    [[nodiscard]] double caughtAt(ObjectId mesh, size_t texel) const;
    // By texel: 0 to 254 when it caught, over the scene's length; 255 not yet.
    bool timesOf(const Burn& burn, ObjectId mesh, std::vector<uint8_t>& values) const;

 private:
    struct Moment {
        double time = 0;  // s
        std::vector<char> bytes;
    };
    bool takeTicks(Burn& burn);
    void takeSave(Burn& burn);

    std::map<ObjectId, std::vector<uint32_t>> ticks_;
    uint64_t start_ = 0;  // tick of time 0
    double known_ = -1;   // s that ticks_ are of
    double longest_ = 0;  // s that were simulated
    double askedTime_ = 0, savingTime_ = 0;
    bool asked_ = false, behind_ = false, saving_ = false;
    std::vector<Moment> moments_;  // by time
};

}  // namespace fwedit
