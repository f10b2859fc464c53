/* flamewright/flamewright_debug.h: UNSTABLE. Timers, burn maps, counters and switches for editors, tests and benchmarks. May
 * change with any version. Games never need it. */
/* Laid out by hand. */
/* clang-format off */
#ifndef FLAMEWRIGHT_FLAMEWRIGHT_DEBUG_H
#define FLAMEWRIGHT_FLAMEWRIGHT_DEBUG_H
#include "flamewright/flamewright.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef struct FwPassTime { char name[32]; double milliseconds; uint64_t frameIndex; uint32_t count, reserved; } FwPassTime;
/* Writes the time of each pass of the newest timed frame, on the GPU or on the cpu backend, and returns how many there are.
 * frameIndex 0: a picture of fwWorld_RenderOffscreen. [world] */
FW_API uint32_t FW_CALL fwDebug_GetPassTimes(FwWorld*, FwPassTime* times, uint32_t capacity);

/* Requests the ignition ticks of an object. The readback of a later frame brings them (cpu backend: at once). [world] */
FW_API FwResult FW_CALL fwDebug_RequestBurnMap(FwWorld*, FwBurnableMeshId id);
/* Writes min(capacity, texels) words, row-major. *count: number of all words. *hash: FNV-1a over the words and, if the object has
 * one, over its heat buffer. *tick: simulation tick of the map. FW_NOT_READY: it has not arrived yet. [world] */
FW_API FwResult FW_CALL fwDebug_FetchBurnMap(FwWorld*, FwBurnableMeshId id, uint32_t* ticks, uint64_t capacity,
                                             uint64_t* count, uint64_t* hash, uint64_t* tick);

typedef enum FwDebugSwitch { /* 256 is reserved */
    FW_DEBUG_DENSE = 1,             /* runs every tile of burning objects each step */
    FW_DEBUG_SHUFFLE = 2,           /* cpu backend: runs due tiles and embers in a random order */
    FW_DEBUG_NO_SEAM_WAKE = 4,      /* mutant, which must make a test fail: tiles across a seam do not wake */
    FW_DEBUG_WRONG_DEPENDENTS = 8,     /* mutant: dependent tiles are wrong */
    FW_DEBUG_NO_WIND_WAKE = 16,     /* mutant: a change of wind or pose wakes no tiles */
    FW_DEBUG_NEVER_IDLE = 32,       /* records the passes even if nothing burns */
    FW_DEBUG_REFINE_FULL = 64,      /* refined objects have their deepest level everywhere, and all of it moves */
    FW_DEBUG_SELF_INTERSECTION = 128,        /* no bounds on recession: walls cross, and each opens by itself */
    FW_DEBUG_SWITCH_FORCE32 = 0x7fffffff
} FwDebugSwitch;
FW_API FwResult FW_CALL fwDebug_SetSwitches(FwWorld*, uint32_t switches); /* FwDebugSwitch bits [world] */
/* Adds an event of one FwIgnitionKind, without a ball, to each of `count` texels. Takes effect at the next step. Ignores texels
 * that no triangle covers (see fwDebug_GetTexelPositions). [world] */
FW_API FwResult FW_CALL fwDebug_PushTexels(FwWorld*, FwBurnableMeshId id, uint32_t kind, const uint32_t* texels, uint32_t count);
/* Writes rest positions (3 floats each, m, object space) and flags (1: a triangle covers the texel) of the burn map. [world] */
FW_API FwResult FW_CALL fwDebug_GetTexelPositions(FwWorld*, FwMeshId id, float* positions, uint32_t* flags, uint64_t capacityTexels, uint64_t* count);
/* Writes the drawn triangles with their places in the burn map: three corners a triangle, five floats a corner. A corner is its
 * rest position (m, object space) and its place (texels; centres are at halves). Writes min(capacity, corners) corners;
 * *count: number of all corners. [world] */
FW_API FwResult FW_CALL fwDebug_GetUnwrap(FwWorld*, FwMeshId id, float* corners, uint64_t capacityCorners, uint64_t* count);

#ifdef __cplusplus
}
#endif
#endif
