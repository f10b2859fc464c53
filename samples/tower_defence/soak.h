// The same stretch of a game, over and over: whether it costs at the end what it cost at first, and
// comes out alike.
#pragma once

#include <cstdint>
#include <ctime>
#include <vector>

#include "siege.h"

namespace tower {

class Soak {
 public:
    static constexpr uint32_t kRounds = 10;  // and one before them, to warm up

    Soak(FwContext* context, FwWorld* world, Siege& siege, uint32_t framesOfRound)
        : context_(context), world_(world), siege_(siege), frames_(framesOfRound) {}

    // With one that ends the last round.
    static uint32_t framesOf(uint32_t framesOfRound) { return (kRounds + 1) * framesOfRound + 1; }
    // Frames are of as many ticks each. After a round it goes back to where the first one began.
    void beginFrame();
    void afterAdvance();  // the siege's, before the world's step
    float share() const { return float(frame_) / float(frames_); }  // of the round
    // Prints a line for each round. Not 0: memory grew by over a tenth from the first to the last,
    // or one came out differently.
    int report();

 private:
    struct Round {
        double milliseconds = 0;        // of the processor, a frame
        uint64_t device = 0, host = 0;  // bytes of the library
        uint64_t process = 0;           // and all that is resident
        uint64_t hash = 0;              // of the game
    };
    void endRound();

    FwContext* context_;
    FwWorld* world_;
    Siege& siege_;
    uint32_t frames_, frame_ = 0;  // the first of all is 0, and of each round then 1
    Siege::Moment first_;
    bool wished_ = false, saved_ = false;
    std::clock_t began_ = std::clock();
    std::vector<Round> rounds_;
};

}  // namespace tower
