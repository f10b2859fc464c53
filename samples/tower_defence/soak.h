// Repeats one stretch of a game, and compares cost and result of the last round with the first.
#pragma once

#include <cstdint>
#include <ctime>
#include <vector>

#include "siege.h"

namespace tower {

class Soak {
 public:
    static constexpr uint32_t kRounds = 10;  // plus one warm-up round

    Soak(FwContext* context, FwWorld* world, Siege& siege, uint32_t framesOfRound)
        : context_(context), world_(world), siege_(siege), frames_(framesOfRound) {}

    // Includes the frame that ends the last round.
    static uint32_t framesOf(uint32_t framesOfRound) { return (kRounds + 1) * framesOfRound + 1; }
    // All frames have equal ticks. Each round restarts from the snapshot of the first one.
    void beginFrame();
    void afterAdvance();  // the siege's, before the world's step
    float share() const { return float(frame_) / float(frames_); }  // of the round
    // Prints a line per round. Returns non-zero if memory grew by over a tenth, or if a round had
    // another result.
    int report();

 private:
    struct Round {
        double milliseconds = 0;        // processor time per frame
        uint64_t device = 0, host = 0;  // bytes of the library
        uint64_t process = 0;           // resident bytes of the process
        uint64_t hash = 0;              // hash of the game
    };
    void endRound();

    FwContext* context_;
    FwWorld* world_;
    Siege& siege_;
    uint32_t frames_, frame_ = 0;  // the first one is 0; rounds then start at 1
    Siege::Snapshot first_;
    bool pending_ = false, saved_ = false;
    std::clock_t began_ = std::clock();
    std::vector<Round> rounds_;
};

}  // namespace tower
