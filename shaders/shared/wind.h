// Packed wind of the zones at an object: three times 10 bits, 1/4 m/s.
// clang-format off
#ifndef FW_SHARED_WIND_H
#define FW_SHARED_WIND_H
#include "shared/types.h"

FW_SHARED_BEGIN

FW_CONST uint kWindBits = 10u;
FW_CONST int kWindZero = 512;
FW_CONST int kMaxWind = 511;

// mm/s. A word of 0 is no wind.
FW_FN ivec3 unpackWind(uint word) {
    if (word == 0u) return ivec3(0, 0, 0);
    return ivec3((int(word & 1023u) - kWindZero) * 250,
                 (int((word >> 10u) & 1023u) - kWindZero) * 250,
                 (int((word >> 20u) & 1023u) - kWindZero) * 250);
}

FW_SHARED_END
#endif
