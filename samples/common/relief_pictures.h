// Pictures for reliefs, painted by the village's own functions and by noise.
#pragma once

#include "common/relief.h"

namespace sample {

// A cobbled road of so many metres, side texels each way.
ReliefPicture cobbles(uint32_t side, float metres);
// Charred wood, the grain along v: blocks between cracks. It repeats.
ReliefPicture charredWood(uint32_t side, float metres, uint32_t seed);

}  // namespace sample
