// Sparks of a fire emitter: its path and power at steps of the clock over one turn, and the record
// from which the device makes sparks. Touches no spark. Cosmetic.
#pragma once
#include "components/fire_emitter.h"

namespace fw::gpu {
struct SparkSource;  // shared/spark.h
}

namespace fw::components {

// Computes the next frame, of `seconds`, into `next` and the record, after `advanceEmitter`. False:
// the emitter throws no sparks, and none fly.
bool advanceSparks(FireEmitter& emitter, const EmitterAir& air, float seconds,
                   gpu::SparkSource& record) noexcept;
// Sets the history as if place and power had always been the present ones. For seeks.
void settleSparks(FireEmitter& emitter, double now) noexcept;
// Most quads of a record.
uint32_t sparkQuads(const gpu::SparkSource& record) noexcept;

}  // namespace fw::components
