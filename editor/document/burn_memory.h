// Recording of a live burn for scrubbing in both directions: the ignition time of each texel, and
// periodic snapshots of the whole world.
//
// A preview uses the ignition times only: material glows after ignition while it chars, then turns
// black. Fire extents are exact. The preview omits flames, smoke, light, holes, deformation and
// wetness, and ignores second materials and water for burn times. The exact picture shows them: it
// runs on from the latest snapshot after the scrub ends.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "document/burn.h"

namespace fwedit {

class BurnMemory {
 public:
    void begin(const Burn& burn);  // expects a world at time 0
    void forget();
    // Call them around fwWorld_RecordOutside: they request due data and receive results. `step`: s
    // that were fed.
    void beforeFrame(Burn& burn, float step);
    void afterFrame(Burn& burn);
    // Requested data arrives with a later frame.
    [[nodiscard]] bool isPending() const { return isReading_ || isBehind_; }
    // The ignition map covers this time.
    [[nodiscard]] bool isKnown(double time) const {
        return !ticks_.empty() && time <= known_ + 0.1;
    }
    [[nodiscard]] double known() const { return known_; }
    // Restores the latest snapshot at or before `time`. Returns false if there is none.
    bool restore(Burn& burn, double time);

    // Per texel: 0 not ignited by then, 1 to 254 progress of its glow, 255 charred.
    bool agesAt(const Burn& burn, ObjectId mesh, const PaintSurface& surface, double time,
                std::vector<uint8_t>& values) const;
    // s at which that texel ignited; < 0: not yet, as far as recorded.
    [[nodiscard]] double caughtAt(ObjectId mesh, size_t texel) const;
    // Per texel: 0 to 254 ignition time relative to the scene's length; 255 not yet.
    bool timesOf(const Burn& burn, ObjectId mesh, std::vector<uint8_t>& values) const;

 private:
    struct Snapshot {
        double time = 0;  // s
        std::vector<char> bytes;
    };
    bool receiveTicks(Burn& burn);
    void receiveSave(Burn& burn);

    std::map<ObjectId, std::vector<uint32_t>> ticks_;
    uint64_t start_ = 0;  // tick at time 0
    double known_ = -1;   // s, time that ticks_ covers
    double longest_ = 0;  // s, simulated so far
    double readingTime_ = 0, savingTime_ = 0;
    bool isReading_ = false, isBehind_ = false, isSaving_ = false;
    std::vector<Snapshot> snapshots_;  // by time
};

}  // namespace fwedit
