// Relief pictures, painted with the village's surface functions and noise.
#pragma once

#include "common/relief.h"

namespace sample {

// A cobbled road, `metres` wide, with `side` texels each way.
ReliefPicture cobbles(uint32_t side, float metres);
// Charred wood with the grain along v: blocks between cracks. It tiles.
ReliefPicture charredWood(uint32_t side, float metres, uint32_t seed);

}  // namespace sample
