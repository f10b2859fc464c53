// Sparks of a fire emitter: its way and its power over the last turn of them, noted at steps of the
// clock, and the record that a device makes them from. Never touches a spark. Looks alone.
#pragma once
#include "components/fire_emitter.h"

namespace fw::gpu {
struct SparkSource;  // shared/spark.h
}

namespace fw::components {

// Its next frame, of `seconds`, into `next` and the record, once `advanceEmitter` began it. False:
// it throws none, and none of its fly.
bool advanceSparks(FireEmitter& emitter, const EmitterAir& air, float seconds,
                   gpu::SparkSource& record) noexcept;
// From now on as if it had always been where it is, with the power that it has: what a seek needs.
void settleSparks(FireEmitter& emitter, double now) noexcept;
// Quads of the most that it may show.
uint32_t sparkQuads(const gpu::SparkSource& record) noexcept;

}  // namespace fw::components
