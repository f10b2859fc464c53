/* flamewright/flamewright_debug.h: UNSTABLE. Timers, maps, counters and switches for editors, tests
 * and benches. May change with any version; never needed by a game. */
/* Laid out by hand, to be read. */
/* clang-format off */
#ifndef FLAMEWRIGHT_FLAMEWRIGHT_DEBUG_H
#define FLAMEWRIGHT_FLAMEWRIGHT_DEBUG_H
#include "flamewright/flamewright.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef struct FwPassTime { char name[32]; double milliseconds; uint64_t frameIndex; uint32_t count, reserved; } FwPassTime;
/* GPU (or cpu backend) time per pass of the newest timed frame (frameIndex 0: a picture of fwWorld_RenderOffscreen); returns
 * how many there are. [world] */
FW_API uint32_t FW_CALL fwDebug_GetPassTimes(FwWorld*, FwPassTime* times, uint32_t capacity);

/* Asks for the ignition ticks of an object. A later frame's readback brings them (cpu: at once). [world] */
FW_API FwResult FW_CALL fwDebug_RequestBurnMap(FwWorld*, FwBurnableMeshId id);
/* FW_NOT_READY until it is here. Writes min(capacity, texels) words, row-major; *count: all of them;
 * *hash: FNV-1a over the words, and over the heat plane where there is one; *tick: the simulation tick it was taken at. [world] */
FW_API FwResult FW_CALL fwDebug_FetchBurnMap(FwWorld*, FwBurnableMeshId id, uint32_t* ticks, uint64_t capacity,
                                             uint64_t* count, uint64_t* hash, uint64_t* tick);

typedef enum FwDebugSwitch {
    FW_DEBUG_DENSE = 1,             /* run every tile of burning objects each step */
    FW_DEBUG_SHUFFLE = 2,           /* cpu: run due tiles and embers in a random order */
    FW_DEBUG_NO_SEAM_WAKE = 4,      /* mutants: each must make a test fail */
    FW_DEBUG_WRONG_READERS = 8,
    FW_DEBUG_NO_WIND_WAKE = 16,
    FW_DEBUG_NEVER_IDLE = 32,       /* record the passes even when nothing burns */
    FW_DEBUG_REFINE_FULL = 64,      /* refined objects at their deepest everywhere, all of them moving */
    FW_DEBUG_CROSSING = 128,        /* no bounds on what recedes: walls cross, and open each by itself */
    FW_DEBUG_NO_Z_PASS = 256,       /* of objects with FW_BURNABLE_Z_PASS draw what faces the eye alone */
    FW_DEBUG_SWITCH_FORCE32 = 0x7fffffff
} FwDebugSwitch;
FW_API FwResult FW_CALL fwDebug_SetSwitches(FwWorld*, uint32_t switches); /* [world] */
/* Adds an event of one FwIgnitionKind at the next step to each of the `count` texels that are real (see
 * fwDebug_GetTexelPositions), without a ball. [world] */
FW_API FwResult FW_CALL fwDebug_PushTexels(FwWorld*, FwBurnableMeshId id, uint32_t kind, const uint32_t* texels, uint32_t count);
/* Rest positions (3 floats each, m, object space) and flags (1 = real) of the burn map. [world] */
FW_API FwResult FW_CALL fwDebug_GetTexelPositions(FwWorld*, FwMeshId id, float* positions, uint32_t* flags, uint64_t capacityTexels, uint64_t* count);
/* The triangles that are drawn, and where each lies in the burn map: three corners a triangle, five floats a corner:
 * rest position (m, object space) and place (texels; centres are at halves). Writes min(capacity, corners) corners;
 * *count: all of them. [world] */
FW_API FwResult FW_CALL fwDebug_GetUnwrap(FwWorld*, FwMeshId id, float* corners, uint64_t capacityCorners, uint64_t* count);

#ifdef __cplusplus
}
#endif
#endif
