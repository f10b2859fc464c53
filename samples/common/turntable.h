// A camera that orbits an object, and the frames of a run seen through it: drag turns, wheel zooms.
// Not for samples that move through a scene.
#pragma once

#include "common/camera.h"
#include "common/fire_host.h"
#include "common/stage.h"

namespace sample {

class Turntable {
 public:
    // Sets dusk light. `turn`: degrees per second without input.
    Turntable(Stage& stage, const OrbitCamera& from, float turn = 0);
    // Begins the next frame, applies the input, and sets the camera in `view`. Returns false when
    // the run is over.
    bool next(StageFrame& frame);

    OrbitCamera orbit;
    FwView view;

 private:
    Stage& stage_;
    float turn_;  // rad/s
};

}  // namespace sample
