// A camera that a hand turns around a thing, and the frames of a run seen through it: drag turns,
// wheel zooms. Not for samples that walk through a scene.
#pragma once

#include "common/camera.h"
#include "common/fire_host.h"
#include "common/stage.h"

namespace sample {

class Turntable {
 public:
    // In dusk light. `turn`: degrees a second, by itself.
    Turntable(Stage& stage, const OrbitCamera& from, float turn = 0);
    // The stage's next frame, steered by the hand, its camera in `view`. False: the run is over.
    bool next(StageFrame& frame);

    OrbitCamera orbit;
    FwView view;

 private:
    Stage& stage_;
    float turn_;  // rad/s
};

}  // namespace sample
