// A cube of 1 m: what boards, walls and posts that burn are made of, by their transforms.
#pragma once

#include "common/fire_host.h"

namespace sample {

FwMeshId makeCube(FireHost& fire);

}  // namespace sample
