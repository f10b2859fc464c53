#include "common/turntable.h"

#include "common/studio.h"

namespace sample {

Turntable::Turntable(Stage& stage, const OrbitCamera& from, float turn)
    : orbit(from), view(fwDefaultView()), stage_(stage), turn_(glm::radians(turn)) {
    duskLight(view);
}

bool Turntable::next(StageFrame& frame) {
    if (!stage_.next(frame)) return false;
    orbit.turn(frame.input.dragX, frame.input.dragY);
    orbit.zoom(frame.input.wheel);
    orbit.yaw += turn_ * frame.deltaTime;
    setCamera(view, orbit.camera(), frame, stage_.made.reversedDepth);
    return true;
}

}  // namespace sample
