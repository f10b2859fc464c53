// A cube of 1 m. Scaled by transforms, it serves as burning boards, walls and posts.
#pragma once

#include "common/fire_host.h"

namespace sample {

FwMeshId makeCube(FireHost& fire);

}  // namespace sample
