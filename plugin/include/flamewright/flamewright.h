/* flamewright/flamewright.h: the stable C ABI. Valid C11 and C++20. Contains no Vulkan and no C++.
 *
 * Units: seconds, kilograms and kelvins (degrees Celsius only where a name says so). Lengths and speeds (m and m/s in
 * comments) are in the world's unit, metres by default: see FwWorldDef::metersPerUnit. Comments give their limits and
 * defaults in metres; error messages give them in the world's unit. All other numbers (m^2, m^3, 1/m, W/m^2, kg/m^3, N)
 * and all of FwMaterialDef are SI in every world.
 * Matrices: column-major, column vectors, without jitter. Colours: linear Rec.709, scene-referred.
 * Field comments: unit, range, default, then the meaning. A field without a stated default starts at 0, null or identity.
 * Reserved fields are 0. An id whose words are all 0 is null. A bare number, factor or share has no unit.
 * Thread tags: [any] any thread; [world] one thread at a time per world; [record] as [world], and the caller owns the
 * command buffer. Callbacks may run on any thread and must not call back into the library.
 * Pointers: the library copies input before a call returns. Output goes to the caller's memory.
 * Results: a negative result means that the call failed and changed nothing. fw*_GetLastMessage and the log say why.
 *
 * Terms (more in plugin/docs/glossary.md):
 *   burn map    the surface of a mesh, unwrapped and cut into texels; a tile is 8 x 8 texels
 *   front       the line along which fire spreads over a burn map
 *   step, tick  the simulation advances in steps of 1/32 s; a tick is 2^-12 s
 *   exchange    heat transfer between objects, eight times a second
 *   rest pose   a mesh as it was created, without skinning or deformation
 *   readback    results that the device copies to the CPU; they arrive 1 to 3 frames later
 * Host checklist: plugin/docs/integration.md. */
/* Laid out by hand. */
/* clang-format off */
#ifndef FLAMEWRIGHT_FLAMEWRIGHT_H
#define FLAMEWRIGHT_FLAMEWRIGHT_H
#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#define FW_CALL __cdecl
#else
#define FW_CALL
#endif
#ifndef FW_API /* the library's build sets the export attribute; hosts define nothing */
#define FW_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define FW_ABI_VERSION 2u /* grows only when an older host can no longer work */
#define FW_VERSION_MAJOR 0u
#define FW_VERSION_MINOR 1u
#define FW_VERSION_PATCH 0u

/* ---- objects and ids --------------------------------------------------------------------- */

typedef struct FwContext FwContext; /* few and large: opaque pointers, which the host owns */
typedef struct FwWorld FwWorld;
struct FwVulkanHost; /* see flamewright_vulkan.h */

/* Many and small: generational ids, passed by value. All zero is null. */
typedef struct FwMaterialId { uint32_t index1, generation; } FwMaterialId;
typedef struct FwImageId { uint32_t index1, generation; } FwImageId;
typedef struct FwMeshId { uint32_t index1, generation; } FwMeshId;
typedef struct FwBurnableMeshId { uint32_t index1, generation; } FwBurnableMeshId;
typedef struct FwTargetId { uint32_t index1, generation; } FwTargetId;
typedef struct FwQueryId { uint32_t index1, generation; } FwQueryId;
typedef struct FwHeatOccluderId { uint32_t index1, generation; } FwHeatOccluderId;
typedef struct FwVolumetricFireId { uint32_t index1, generation; } FwVolumetricFireId;
typedef struct FwFireProfileId { uint32_t index1, generation; } FwFireProfileId;
typedef struct FwFireColliderId { uint32_t index1, generation; } FwFireColliderId;
typedef struct FwFireEmitterId { uint32_t index1, generation; } FwFireEmitterId;
typedef struct FwFlipbookId { uint32_t index1, generation; } FwFlipbookId;
typedef struct FwParticleFieldId { uint32_t index1, generation; } FwParticleFieldId;
typedef struct FwPeerId { uint32_t index1, generation; } FwPeerId;
typedef struct FwWindZoneId { uint32_t index1, generation; } FwWindZoneId;
typedef struct FwRoomId { uint32_t index1, generation; } FwRoomId;
typedef struct FwBurnId { uint32_t index1, generation; } FwBurnId;

/* ---- results, log, memory ------------------------------------------------------------------ */

typedef enum FwResult {
    FW_NOTHING_THERE = 2, /* the call is valid but changed nothing: no texel fits it */
    FW_NOT_READY = 1, /* pipelines or a readback are still pending; nothing was recorded */
    FW_OK = 0,
    FW_ERROR_INVALID_ARGUMENT = -1,
    FW_ERROR_STALE_ID = -2, /* the id is null, or its object was destroyed */
    FW_ERROR_VERSION = -3, /* this library cannot serve the structSize, abiVersion or file version */
    FW_ERROR_OUT_OF_MEMORY = -4,
    FW_ERROR_UNSUPPORTED_DEVICE = -5,
    FW_ERROR_DEVICE_LOST = -6,
    FW_ERROR_BAD_DATA = -7, /* a mesh, file or packet is unusable */
    FW_ERROR_WRONG_BACKEND = -8, /* the call needs another backend or another kind of device */
    FW_ERROR_INTERNAL = -9,
    FW_RESULT_FORCE32 = 0x7fffffff
} FwResult;

typedef struct FwErrorInfo { int32_t result; char message[508]; } FwErrorInfo; /* frozen; the caller owns it */

typedef enum FwLogLevel {
    FW_LOG_DEBUG = 0, FW_LOG_INFO = 1, FW_LOG_WARNING = 2, FW_LOG_ERROR = 3,
    FW_LOG_LEVEL_FORCE32 = 0x7fffffff
} FwLogLevel;

/* Frozen. The library copies it at context creation and uses its own functions for null members. `allocate` returns null
 * if there is no memory. `release` gets the size and alignment that were passed to `allocate`. */
typedef struct FwCallbacks {
    void* userData;
    void (FW_CALL* log)(void* userData, int32_t level, const char* message);
    void* (FW_CALL* allocate)(void* userData, size_t size, size_t alignment);
    void (FW_CALL* release)(void* userData, void* memory, size_t size, size_t alignment);
} FwCallbacks;

/* Returns the name of a result as static text, never null. [any] */
FW_API const char* FW_CALL fwResultName(int32_t result);
/* Returns major << 22 | minor << 12 | patch of the loaded library. [any] */
FW_API uint32_t FW_CALL fwGetVersion(void);

/* ---- defs ------------------------------------------------------------------------------------ */
/* Take a def from its fwDefault...() function, then change the fields that you need. structSize is the host's sizeof.
 * A newer library gives its default to each field that an older host does not have. An older library returns
 * FW_ERROR_VERSION if a byte that it does not know is not 0. */

typedef enum FwDefType {
    FW_DEF_CONTEXT = 1, FW_DEF_WORLD = 2, FW_DEF_MATERIAL = 3, FW_DEF_IMAGE = 4, FW_DEF_MESH = 5,
    FW_DEF_BURNABLE_MESH = 6, FW_DEF_IGNITION = 7, FW_DEF_VIEW = 8, FW_DEF_OFFSCREEN = 9,
    FW_DEF_HEAT_OCCLUDER = 10, FW_DEF_VOLUMETRIC_FIRE = 11, FW_DEF_FIRE_PROFILE = 12, FW_DEF_FIRE_COLLIDER = 13,
    FW_DEF_FIRE_TRACK = 14, FW_DEF_PARTICLE_FIELD = 15, FW_DEF_FIRE_EMITTER = 20,
    FW_DEF_FLIPBOOK = 21, FW_DEF_BUDGET = 22, FW_DEF_NET = 23, FW_DEF_WIND_ZONE = 24, FW_DEF_ROOM = 25,
    FW_DEF_WIND_GRID = 26, FW_DEF_GUSTS = 27, FW_DEF_TIMELINE = 28,
    FW_DEF_HEAT_OCCLUSION = 29,
    FW_DEF_VULKAN_HOST = 100, FW_DEF_VULKAN_TARGET = 101, FW_DEF_VULKAN_FRAME = 102,
    FW_DEF_VULKAN_REQUIREMENTS = 103, FW_DEF_VULKAN_COMPOSITE = 104, FW_DEF_VULKAN_VERTICES = 105,
    FW_DEF_TYPE_FORCE32 = 0x7fffffff
} FwDefType;
/* Writes the defaults of a def type to the first structSize bytes of `def`, and never a byte more. Bytes that this
 * library does not know become 0. If the type is unknown, all bytes but structSize become 0. [any] */
FW_API void FW_CALL fwInitDef(uint32_t defType, void* def, uint32_t structSize);

/* ---- context --------------------------------------------------------------------------------- */

typedef enum FwBackend {
    FW_BACKEND_VULKAN = 0, /* host device: FwContextDef::vulkan. Own device: the library creates one if that is null */
    FW_BACKEND_CPU = 1,    /* simulation only, without a device: servers, tools, tests */
    FW_BACKEND_FORCE32 = 0x7fffffff
} FwBackend;

typedef struct FwContextDef {
    uint32_t structSize, abiVersion; /* fwDefaultContextDef sets both */
    uint32_t backend;                /* FwBackend, default FW_BACKEND_VULKAN */
    uint32_t flags;                  /* 0 */
    FwCallbacks callbacks;
    const struct FwVulkanHost* vulkan; /* null: the library creates its own instance and device */
    uint64_t gpuMemoryBudget;          /* bytes, default 0: no limit. Creation beyond it fails: FW_ERROR_OUT_OF_MEMORY */
} FwContextDef;
static inline FwContextDef fwDefaultContextDef(void) {
    FwContextDef d; fwInitDef(FW_DEF_CONTEXT, &d, (uint32_t)sizeof d);
    d.abiVersion = FW_ABI_VERSION; return d;
}
/* Creates a context. If it fails, *context is null and *error (may be null) says why. [any] */
FW_API FwResult FW_CALL fwCreateContext(const FwContextDef* def, FwContext** context, FwErrorInfo* error);
/* Frees the context and all its worlds, even after a lost device. The host has waited for its last frame.
 * `context` may be null. [any, while no other call uses the context] */
FW_API void FW_CALL fwDestroyContext(FwContext* context);

typedef struct FwContextInfo {
    uint32_t structSize;
    uint32_t backend;                 /* FwBackend in use */
    uint32_t apiVersion;              /* Vulkan version that the host declared; 0 on the cpu backend */
    uint32_t ownDevice;               /* 1: the library created the device */
    uint32_t gpuTimers;               /* 1: pass timers are available */
    uint32_t debugLabels;             /* 1: debug-utils labels and names are in use */
    uint64_t gpuMemoryUsed, gpuMemoryBudget; /* bytes */
    uint64_t cpuMemoryUsed;           /* bytes that the allocator has given out */
    char deviceName[256];
} FwContextInfo;
/* Fills up to info->structSize bytes. [any] */
FW_API FwResult FW_CALL fwContext_GetInfo(FwContext* context, FwContextInfo* info);
/* Copies the text of this context's last failure. Returns the length that it needs, without the terminating zero. [any] */
FW_API size_t FW_CALL fwContext_GetLastMessage(FwContext* context, char* text, size_t capacity);
/* Builds all missing pipelines. Takes long: call it on a loading screen or on a worker thread. Returns FW_OK once
 * all are ready. Required on a host device, optional on an own device. [any] */
FW_API FwResult FW_CALL fwContext_Prepare(FwContext* context);

typedef struct FwMemoryRow {  /* memory of one component, buffer or pool */
    char name[48];            /* unique in a report */
    uint64_t bytes, capacity; /* bytes in use; bytes reserved */
} FwMemoryRow;
/* Writes at most `capacity` rows and returns how many there are. Vulkan backend, in order: one row for each component
 * ("meshes" to "targets", whatever the number of worlds); "blocks"; one row for each buffer, summed over all worlds.
 * "blocks": `bytes` is the sum of the components, `capacity` is FwContextInfo::gpuMemoryUsed. The components already
 * contain the bytes of the buffers. cpu backend: one row for each pool ("cpu texel states", ...) instead. Both backends
 * end with CPU memory of all worlds, "world objects" to "world contacts". Waits for no step and no recording. [any] */
FW_API uint32_t FW_CALL fwContext_GetMemoryReport(FwContext* context, FwMemoryRow* rows, uint32_t capacity);

/* ---- world ------------------------------------------------------------------------------------- */

typedef enum FwWorldFlags { /* how fire reaches other objects. Without the first four it does not */
    FW_WORLD_RADIATION = 1, /* flames heat the surfaces that they shine on, until these ignite */
    FW_WORLD_PLUME = 2,     /* hot gas heats the surfaces above a fire */
    FW_WORLD_CONTACT = 4,   /* flames cross gaps of up to 5 cm: to other objects, and between parts of a mesh that share no
                               edge (a roof on its walls, a cart's wheels) */
    FW_WORLD_EMBERS = 8,    /* burning fragments fly downwind and may ignite the surface on which they land */
    /* Each object that is created while one of these is set gets the FW_BURNABLE_ flag of the same name. */
    FW_WORLD_NO_SPREAD = 16,
    FW_WORLD_NO_DAMAGE = 32,
    FW_WORLD_NO_HOLES = 64,
    FW_WORLD_FLAGS_FORCE32 = 0x7fffffff
} FwWorldFlags;

typedef struct FwWorldDef {
    uint32_t structSize, flags; /* flags: FwWorldFlags, default 0; see fwWorld_SetFlags */
    float up[3];                /* unit vector, default 0,1,0 */
    float paceFactor;           /* factor, [0.1, 1000], default 1. How many times faster than real fire spreads and burns out.
                                   Games use 5 to 30 */
    float wind[3];              /* m/s, [-120, 120] each, default 0 */
    uint32_t reserved;          /* 0 */
    uint32_t seed;              /* default 1. Seeds noise and everything cosmetic */
    uint32_t maxStepsPerFrame;  /* [1, 64], default 8. Time beyond it is dropped and counted: FW_EVENT_TIME_DROPPED */
    uint32_t maxLights;         /* [0, 64], default 16 */
    uint32_t maxFlames;         /* [0, 65536], default 4096. Flame quads that are simulated; at most 4096 are drawn. 0:
                                   burning meshes show no flames */
    uint64_t userData;
    uint32_t maxRefinedTriangles; /* [1000, 16000000], default 400000. Target for all refined objects together.
                                     60000 suits software devices */
    uint32_t reserved1;         /* 0 */
    /* Spread limits of the world. Objects have limits of their own; the stricter limit applies. */
    float spreadChance;         /* [0, 1], default 1. Chance of each jump between objects (decided once for a pair and a fire)
                                   and of each ember */
    uint32_t maxHops;           /* default 0: no limit. Fire that made this many jumps reaches no other object */
    uint32_t maxBurningTiles;   /* default 0: no limit. Spreading fire never burns more tiles than this. If more would ignite,
                                   chance decides which do, the same on every backend; the others wait. Ignitions by
                                   fwWorld_Ignite, by FW_FIRE_IGNITES and by a jet on FW_BURNABLE_LITE may exceed it */
    float timeToLive;           /* s, [0, 1e6], default 0: no limit. An object's front stops this long after its ignition */
    /* Returns the share of `to` that a fire on `from` sees, [0, 1]. Null: 1. The thread that steps the world calls it when
     * one of the two has moved, and keeps the answer until then. Worlds that must stay equal need equal answers for equal
     * poses. */
    float (FW_CALL* visibility)(void* visibilityData, FwBurnableMeshId from, FwBurnableMeshId to);
    void* visibilityData;
    /* Ray march of volumetric fires before they are drawn: for the views of fwWorld_RecordOutside. */
    uint32_t volumePixelSize;        /* px, [1, 16], default 2. Side of a march pixel; 1: full resolution */
    uint32_t rayStepCount;       /* [6, 64], default 64. Most samples of a ray through a flame. Flames beyond the 32 largest get
                                   fewer samples, and never more than this */
    uint32_t maxParticles;      /* [0, 1048576], default 16384. Particles of all fire emitters. Each takes 48 bytes once used */
    uint32_t arrivalTiles;      /* [1, 1048576], default 1024. Tiles that fwWorld_RequestArrival may simulate per frame, for all
                                   queries together. Cost: about 2 us a tile; each tile of a map is visited about 25 times */
    uint32_t volumeOctaves;     /* [1, 4], default 4. Most noise octaves of a volumetric flame. Presets use 3, large fires 4.
                                   Fewer octaves are faster and smoother; height and brightness stay */
    uint32_t reserved2;         /* 0 */
    float metersPerUnit;        /* m, [0.0001, 1000], default 1; 0: 1. Length of the unit for every length of this world.
                                   0.01: centimetres (Unreal, Qt); 0.3048: feet */
    uint32_t reserved3;         /* 0 */
} FwWorldDef;
static inline FwWorldDef fwDefaultWorldDef(void) {
    FwWorldDef d; fwInitDef(FW_DEF_WORLD, &d, (uint32_t)sizeof d); return d;
}
/* Creates a world. If it fails, *world is null. [any] */
FW_API FwResult FW_CALL fwCreateWorld(FwContext* context, const FwWorldDef* def, FwWorld** world);
/* Converts the lengths of a def from metres to the world's unit. Use it for defaults (fwDefault...), presets
 * (fwInitFirePreset) and values that the host keeps in metres. Call it once for each def. `def` is a struct of FwDefType
 * `defType` with structSize set. Arrays behind pointers stay unchanged. Defaults of FwMeshDef and FwMaterialDef need no
 * conversion. FW_ERROR_INVALID_ARGUMENT: unknown defType. [any] */
FW_API FwResult FW_CALL fwWorld_ConvertDef(FwWorld* world, uint32_t defType, void* def);
/* Frees the world. `world` may be null. [world] */
FW_API void FW_CALL fwDestroyWorld(FwWorld* world);
/* Copies the text of this world's last failure. Returns the length that it needs, without the terminating zero. [any] */
FW_API size_t FW_CALL fwWorld_GetLastMessage(FwWorld* world, char* text, size_t capacity);

/* ---- deferred destruction: for scene-node destructors that run while frames are in flight ------ */

/* Schedules the destruction of the world: fwContext_Collect destroys it once its completedFrameIndex is at least
 * `frameIndex`. 0: the newest frame that the world has recorded or stepped, including one in progress. Another thread may
 * be recording with the world during the call. No call that begins later may use the world. A second call changes the
 * frame. fwDestroyContext destroys every world that still waits. [any] */
FW_API FwResult FW_CALL fwWorld_DestroyAfterFrame(FwWorld* world, uint64_t frameIndex);
/* Destroys the worlds and targets that wait for frames up to completedFrameIndex: the newest frame that the GPU has
 * finished together with all frames before it. UINT64_MAX: all of them, if the host has waited or on the cpu backend.
 * Returns how many worlds and targets still wait. Call it once a frame. [any, while no call uses what it destroys;
 * the calls of a completed frame have ended] */
FW_API uint32_t FW_CALL fwContext_Collect(FwContext* context, uint64_t completedFrameIndex);

typedef enum FwObjectKind { /* kind of an id, for fwWorld_DestroyLater */
    FW_OBJECT_MATERIAL = 1, FW_OBJECT_IMAGE = 2, FW_OBJECT_MESH = 3, FW_OBJECT_BURNABLE_MESH = 4,
    FW_OBJECT_HEAT_OCCLUDER = 5, FW_OBJECT_VOLUMETRIC_FIRE = 6, FW_OBJECT_FIRE_PROFILE = 7,
    FW_OBJECT_FIRE_COLLIDER = 8, FW_OBJECT_FIRE_EMITTER = 9, FW_OBJECT_FLIPBOOK = 10,
    FW_OBJECT_PARTICLE_FIELD = 11, FW_OBJECT_WIND_ZONE = 12, FW_OBJECT_ROOM = 13, FW_OBJECT_BURN = 14,
    FW_OBJECT_KIND_COUNT = 15, FW_OBJECT_KIND_FORCE32 = 0x7fffffff
} FwObjectKind;
typedef struct FwObjectRef { uint32_t kind, index1, generation, reserved; } FwObjectRef; /* FwObjectKind; words of the id; 0 */
/* Schedules the destruction of an object, in any order. The next fwWorld_Step or fwWorld_RecordOutside begins with it and
 * acts like the fwWorld_Destroy... or fwWorld_Remove... function of that kind. An object in use (mesh, profile, flipbook,
 * baked burn) waits until its last user is gone. Its memory waits for the frames in flight. If the id is stale by then,
 * the log has a warning. [any] */
FW_API FwResult FW_CALL fwWorld_DestroyLater(FwWorld* world, const FwObjectRef* object);

/* Sets the uniform wind: m/s, world space, [-120, 120] for each component. A low-pass filter delays its effect on a front by
 * the time that the front takes to cross a texel. [world] */
FW_API FwResult FW_CALL fwWorld_SetWind(FwWorld* world, const float wind[3]);
/* Sets FwWorldFlags. Heat-transfer flags take effect at the next exchange. The flags NO_SPREAD, NO_DAMAGE and NO_HOLES
 * apply to objects that are created later. [world] */
FW_API FwResult FW_CALL fwWorld_SetFlags(FwWorld* world, uint32_t flags);

/* Shifts the origin: every position p of the world becomes p + offset. For hosts that rebase their origin in large worlds.
 * `offset`: m, [-2e6, 2e6] each; the library rounds it to whole metres. *applied (may be null) gets the rounded offset.
 * Everything moves: objects and the heat between them, occluders, rooms, wind, gusts, fires, emitters with their particles,
 * fields, colliders, lights, pending answers and events. Burning and pictures continue as if nothing had moved. The library
 * calls FwFireColliderDef::distance at the new positions.
 * Saves contain the origin; fwWorld_Load and fwWorld_Seek restore it: see fwWorld_GetOrigin. Command logs, timelines and
 * networks carry the shift. A client's world has the origin of its server. Burning is exact, with one exception: hits of
 * jets, FW_FIRE_IGNITES and FW_FIELD_WETS are found in floats, to 0.1 mm at 1000 m.
 * FW_ERROR_INVALID_ARGUMENT: a position would leave [-1e6, 1e6] m, or the world follows a server. [world] */
FW_API FwResult FW_CALL fwWorld_ShiftOrigin(FwWorld*, const float offset[3], float applied[3]);
/* Gets the sum of all shifts since the world was created, in m. [world] */
FW_API FwResult FW_CALL fwWorld_GetOrigin(FwWorld*, double origin[3]);

typedef struct FwHeatOccluderDef { /* a box that stops radiation, plumes and embers: a wall, a door */
    uint32_t structSize, flags; /* flags: 0 */
    float transform[16];        /* box to world, default identity. Rigid, with a uniform scale */
    float halfSize[3];          /* m, [0, 30] each, default 0.5; the limit includes the scale. One 0 makes a quad */
    uint32_t reserved;          /* 0 */
} FwHeatOccluderDef;
static inline FwHeatOccluderDef fwDefaultHeatOccluderDef(void) {
    FwHeatOccluderDef d; fwInitDef(FW_DEF_HEAT_OCCLUDER, &d, (uint32_t)sizeof d); return d;
}
/* Adds an occluder box, at most 64 at a time. The box does not occlude points within 6 cm of its surface. [world] */
FW_API FwResult FW_CALL fwWorld_AddHeatOccluder(FwWorld*, const FwHeatOccluderDef* def, FwHeatOccluderId* id);
FW_API FwResult FW_CALL fwWorld_MoveHeatOccluder(FwWorld*, FwHeatOccluderId id, const float transform[16]); /* [world] */
FW_API FwResult FW_CALL fwWorld_RemoveHeatOccluder(FwWorld*, FwHeatOccluderId id); /* [world] */

typedef enum FwHeatOcclusionFlags {
    FW_HEAT_OCCLUSION_ALL_OBJECTS = 1, /* all existing burnable meshes fill cells, not only those in `objects` */
    FW_HEAT_OCCLUSION_FLAGS_FORCE32 = 0x7fffffff
} FwHeatOcclusionFlags;
/* Heat-occlusion grid: solid cells stop radiation, plumes and embers. For shapes beyond boxes: terrain and houses of the
 * host, walls and fences that are burnable meshes. A cell is solid if `cells`, `distance` or an object makes it solid. */
typedef struct FwHeatOcclusionDef {
    uint32_t structSize, flags; /* flags: FwHeatOcclusionFlags, default 0 */
    uint32_t counts[3];         /* [1, 256] each, default 1. Cells along the world's x, y, z; at most 2097152 in all */
    float origin[3];            /* m, [-1e6, 1e6], world. The grid's low corner; rounded to mm */
    float cellSize;             /* m, [0.05, 10], default 0.25. Choose it no larger than the gaps that fire must pass, and no
                                   smaller than the texels of the objects */
    uint32_t objectCount;       /* default 0 */
    const uint8_t* cells;       /* default null. One byte a cell, x fastest, then y, then z. Not 0: solid. Copied */
    float (FW_CALL* distance)(void* distanceData, const float place[3]); /* default null. Returns the distance in m from `place`
                                   (m, world) to the nearest surface, negative inside. The library calls it once for the
                                   middle of each cell, only during fwWorld_SetHeatOcclusion. A cell is solid below half of
                                   cellSize, so that walls of any thickness have no gaps. To keep solid ground below the
                                   objects that lie on it, return more there */
    void* distanceData;
    const FwBurnableMeshId* objects; /* default null. Objects whose surfaces fill cells, in their present rest pose. Such a
                                   cell opens when the texel at its middle has a hole, as jets and pictures see it */
} FwHeatOcclusionDef;
static inline FwHeatOcclusionDef fwDefaultHeatOcclusionDef(void) {
    FwHeatOcclusionDef d; fwInitDef(FW_DEF_HEAT_OCCLUSION, &d, (uint32_t)sizeof d); return d;
}
/* Replaces the heat-occlusion grid; null removes it. Takes effect at the next exchange, in addition to occluder boxes. Cells
 * of the host also stop jets; jets hit meshes without the grid. Nothing shades itself: the library ignores all cells within
 * one cell of a flame or of a heated surface. Cells of the host and of these two objects it ignores within a few cells. Burnt
 * holes let fire pass without another call. If an object moves, its cells stay until the next call; if it is destroyed, they
 * are gone. Objects fill at most 262144 cells. The result is the same on every backend and goes to saves, command logs and
 * networks. Size there: 9 bytes for each object, and 58 for each row of 384 cells in which a host's cell changed. If the grid
 * differs, all rows with solid cells count. Cost: about 5 ns a cell, the time of the callback, and about 40 ns a texel of the
 * objects. [world] */
FW_API FwResult FW_CALL fwWorld_SetHeatOcclusion(FwWorld*, const FwHeatOcclusionDef* def);

typedef enum FwWindShape { /* extent of a wind zone. Falloff runs from its middle to its edge */
    FW_WIND_BOX = 0,           /* along the world's axes; size: half of each side */
    FW_WIND_SPHERE = 1,        /* size[0]: radius */
    FW_WIND_CONE = 2,          /* a fan: from `position` along `axis`; size[0]: length, size[1]: radius at its end */
    FW_WIND_SHAPE_COUNT = 3, FW_WIND_SHAPE_FORCE32 = 0x7fffffff
} FwWindShape;
typedef enum FwWindFlow {
    FW_WIND_ALONG = 0,         /* along `axis` */
    FW_WIND_RADIAL = 1,        /* away from `position`; a negative speed blows towards it */
    FW_WIND_VORTEX = 2,        /* around `axis` through `position`, right-handed */
    FW_WIND_FLOW_COUNT = 3, FW_WIND_FLOW_FORCE32 = 0x7fffffff
} FwWindFlow;
typedef enum FwWindBlend {
    FW_WIND_ADD = 0,           /* adds to the wind that already blows there */
    FW_WIND_REPLACE = 1,       /* replaces that wind, by the share left after falloff; speed 0 makes a shelter */
    FW_WIND_BLEND_COUNT = 2, FW_WIND_BLEND_FORCE32 = 0x7fffffff
} FwWindBlend;
/* Local wind. An object takes the wind at the middle of its box (of the mesh in rest pose) for its fire, flames and embers:
 * split objects that are larger than a zone. Volumetric fires, emitters and fields take the wind at their position. */
typedef struct FwWindZoneDef {
    uint32_t structSize, flags; /* flags: 0 */
    uint32_t shape;             /* FwWindShape, default FW_WIND_BOX */
    uint32_t flow;              /* FwWindFlow, default FW_WIND_ALONG */
    uint32_t blend;             /* FwWindBlend, default FW_WIND_ADD */
    int32_t priority;           /* [-1000, 1000], default 0. Zones apply in ascending priority; ties in ascending id */
    float position[3];          /* m, [-1e6, 1e6], world */
    float axis[3];              /* direction of any length, default 1,0,0 */
    float size[3];              /* m, [0.01, 1000], default 1; see FwWindShape */
    float speed;                /* m/s, [-120, 120], default 5 */
    float falloff;              /* [0, 1], default 0.5. Outer share of the zone over which it fades; 0: full strength up to its
                                   edge */
    uint32_t reserved;          /* 0 */
} FwWindZoneDef;
static inline FwWindZoneDef fwDefaultWindZoneDef(void) {
    FwWindZoneDef d; fwInitDef(FW_DEF_WIND_ZONE, &d, (uint32_t)sizeof d); return d;
}
/* Creates a wind zone. Takes effect at the next step and is filtered like the world's wind. At most 64 at a time. [world] */
FW_API FwResult FW_CALL fwWorld_CreateWindZone(FwWorld*, const FwWindZoneDef* def, FwWindZoneId* id);
/* Replaces the whole def of a zone, for example to turn a fan or to switch it on and off. [world] */
FW_API FwResult FW_CALL fwWorld_SetWindZone(FwWorld*, FwWindZoneId id, const FwWindZoneDef* def);
FW_API FwResult FW_CALL fwWorld_DestroyWindZone(FwWorld*, FwWindZoneId id); /* [world] */
/* Wind on a grid: from a weather map or a solver of the host. Trilinear between its points, nothing outside. */
typedef struct FwWindGridDef {
    uint32_t structSize, flags; /* flags: 0 */
    uint32_t blend;             /* FwWindBlend with the world's wind, default FW_WIND_REPLACE. Zones apply after the grid */
    uint32_t counts[3];         /* [2, 64] each, default 2. Points along the world's x, y, z; at most 32768 in all */
    float origin[3];            /* m, [-1e6, 1e6], world. Position of the first point */
    float cellSize;             /* m, [0.01, 1000], default 1. Distance between points along each axis */
    float fade;                 /* m, [0, 1000], default 0. Distance inward from the grid's faces over which it fades */
    uint32_t reserved;          /* 0 */
    const float* velocities;    /* m/s, [-120, 120] each. 3 a point; x runs fastest, then y, then z. Copied */
} FwWindGridDef;
static inline FwWindGridDef fwDefaultWindGridDef(void) {
    FwWindGridDef d; fwInitDef(FW_DEF_WIND_GRID, &d, (uint32_t)sizeof d); return d;
}
/* Replaces the wind grid; null removes it. Takes effect at the next step and is filtered like the world's wind. Velocities
 * are rounded to 1/128 m/s. Meant for a few calls a second: a command log or network carries about 58 bytes for each eight
 * points in a row of which one changed. If the grid moves, it carries all points that are not calm. [world] */
FW_API FwResult FW_CALL fwWorld_SetWindGrid(FwWorld*, const FwWindGridDef* def);
/* Gusts: noise that drifts with the wind scales the world's wind and that of its grid. Gusts reach fronts, embers, plumes,
 * flames, volumetric fires and emitters. They change every quarter of a second, the same on every backend. They do not reach
 * particle fields, and they do not scale wind zones. An object that plays a baked burn goes live in gusts. */
typedef struct FwGustDef {
    uint32_t structSize, flags; /* flags: 0 */
    float strength;             /* [0, 1], default 0. The wind varies between (1 - strength) and (1 + strength) times itself */
    float size;                 /* m, [0.5, 1000], default 12. Grid size of the noise. A second octave has half the size and half
                                   the amplitude */
} FwGustDef;
static inline FwGustDef fwDefaultGustDef(void) {
    FwGustDef d; fwInitDef(FW_DEF_GUSTS, &d, (uint32_t)sizeof d); return d;
}
/* Sets the gusts from the next step on. Strength 0 switches them off. [world] */
FW_API FwResult FW_CALL fwWorld_SetGusts(FwWorld*, const FwGustDef* def);
/* Gets the wind in m/s at a point (m, [-1e6, 1e6], world), as objects there receive it now. [world] */
FW_API FwResult FW_CALL fwWorld_GetWindAt(FwWorld*, const float point[3], float wind[3]);

typedef enum FwRoomFlags {
    FW_ROOM_REFILL = 1,         /* fwWorld_SetRoom: sets the room's air to `oxygen`, as gas that puts fires out does */
    FW_ROOM_FLAGS_FORCE32 = 0x7fffffff
} FwRoomFlags;
/* A room (compartment) whose air fires use up. An object belongs to the room that contains the middle of its box (of the
 * mesh in rest pose). If several rooms contain it, the first one created counts. Outside all rooms air is unlimited.
 * Fire takes 1 kg of oxygen for each 13.1 MJ (Huggett 1980). Below 15 % of oxygen by volume it weakens linearly; at 12 %
 * nothing burns. Weak fire gives off less heat, spreads more slowly, ignites less and goes out as it cools. If air comes back,
 * what still burns grows again, and surfaces that are still hot enough reignite. Objects with FW_BURNABLE_LITE, volumetric
 * fires and emitters neither use nor need air.
 * Flashover raises FW_EVENT_FLASHED_OVER and changes nothing by itself. It occurs when the power of the room's fires, averaged
 * over about 1 s, reaches the limit of Thomas (1981): 7.8 kW for each m^2 of its box's sides plus 945 kW for each m^3/s of
 * `vent` (378 kW for each m^2.5 of A sqrt(h)). The event can repeat only after the power fell below half of the limit. */
typedef struct FwRoomDef {
    uint32_t structSize, flags; /* flags: FwRoomFlags, default 0 */
    float position[3];          /* m, [-1e6, 1e6], world. Its middle */
    float rotation[4];          /* unit quaternion x, y, z, w, default 0,0,0,1 */
    float halfSize[3];          /* m, [0.05, 1000], default 2, 1.25, 2.5. Half of each side */
    float volume;               /* m^3 of air, [0.1, 1e6], default 0: the volume of its box, which must be in that range */
    float vent;                 /* m^3/s of outside air, [0, 1e4], default 0.01: a leaky room. An opening of A m^2 and height
                                   h m lets in about 0.4 A sqrt(h) (Kawagoe); a door 0.9 */
    float oxygen;               /* share by volume, [0, 1], default 0.2095. Applies at creation and with FW_ROOM_REFILL */
    uint32_t reserved;          /* 0 */
} FwRoomDef;
static inline FwRoomDef fwDefaultRoomDef(void) {
    FwRoomDef d; fwInitDef(FW_DEF_ROOM, &d, (uint32_t)sizeof d); return d;
}
/* Creates a room. Takes effect at the next step. At most 64 at a time. [world] */
FW_API FwResult FW_CALL fwWorld_CreateRoom(FwWorld*, const FwRoomDef* def, FwRoomId* id);
/* Replaces the whole def of a room but keeps its air, for example when a door opens or a ship moves. [world] */
FW_API FwResult FW_CALL fwWorld_SetRoom(FwWorld*, FwRoomId id, const FwRoomDef* def);
/* Destroys a room. Its objects then have unlimited air, or that of another room around them. [world] */
FW_API FwResult FW_CALL fwWorld_DestroyRoom(FwWorld*, FwRoomId id);
typedef struct FwRoomState {
    uint32_t structSize;
    uint32_t objects;           /* burnable meshes in it now */
    uint64_t frameIndex;        /* frame of the values below, as in FwObjectState */
    float oxygen;               /* share by volume, [0, 1] */
    float strength;             /* [0, 1]. Strength of fire in it: 1 at 15 % of oxygen or more, 0 at 12 % or less */
    float power;                /* W at pace 1. Mean power of the last 1/8 s that uses its air */
    uint32_t flashedOver;       /* 1: it has flashed over and still burns so */
    float flashOverPower;       /* W. Power at which it flashes over */
    uint32_t reserved;
} FwRoomState;
FW_API FwResult FW_CALL fwWorld_GetRoomState(FwWorld*, FwRoomId id, FwRoomState* state); /* [world] */

/* ---- materials ------------------------------------------------------------------------------------ */

typedef enum FwMaterialPreset {
    FW_MATERIAL_NONCOMBUSTIBLE = 0, FW_MATERIAL_PINE = 1, FW_MATERIAL_PAINTED_WOOD = 2,
    FW_MATERIAL_NEWSPAPER = 3, FW_MATERIAL_PAPER = 4, FW_MATERIAL_COTTON = 5,
    FW_MATERIAL_POLYESTER = 6, FW_MATERIAL_DRY_LEAF = 7, FW_MATERIAL_GREEN_LEAF = 8,
    FW_MATERIAL_THATCH = 9, FW_MATERIAL_DRY_GRASS = 10, FW_MATERIAL_PLYWOOD = 11,
    FW_MATERIAL_LEATHER = 12, FW_MATERIAL_PLASTIC = 13, FW_MATERIAL_PRESET_COUNT = 14,
    FW_MATERIAL_PRESET_FORCE32 = 0x7fffffff
} FwMaterialPreset;

/* Spread law: plugin/docs/model.md. All values are SI in every world. Defaults are those of FW_MATERIAL_PINE. */
typedef struct FwMaterialDef {
    uint32_t structSize;
    uint32_t appearance;        /* FwMaterialPreset, default FW_MATERIAL_PINE. Selects the appearance */
    float spreadRate;     /* m/s, [0, 1], default 0.0003. Front speed on a flat horizontal sheet in still air; 0: cannot burn */
    float windGain;       /* drive for each m/s of wind along the surface, [0, 16], default 0.35 */
    float upGain;         /* drive of a vertical surface, [0, 16], default 1 */
    float headGain;       /* [0, 255], default 8. Head speed = spreadRate * (1 + headGain * min(drive, driveMax)) */
    float backGain;       /* [0, 255], default 2. Back speed = spreadRate / (1 + backGain * drive) */
    float driveMax;       /* [0, 63], default 4 */
    float lengthToBreadth;/* [1, 4], default 2. Largest length / breadth of the burnt ellipse */
    float ceilingGain;    /* [0, 4], default 0.3. Speed-up below a ceiling */
    float burnTime;       /* s at pace 1, [-1e6, 1e6], default 0. Time that a texel flames. 0 or less: thick fuel, which flames
                             while it is hot enough and its fuel (thickness * density, burning at burningFlux) lasts */
    float moisture;       /* kg of water per kg of dry fuel, [0, 2], default 0 */
    float extinctionMoisture; /* kg/kg, [0.001, 2], default 0.4. Moisture at which fire no longer spreads */
    float thickness;      /* m, [0, 100], default 0.02. Of the visible rim and of the consumption */
    float heatOfCombustion;   /* J/kg, [0, 2e8], default 15e6 */
    float burningFlux;    /* kg/m^2/s, [0, 10], default 0.0075. Mass loss while it flames */
    float baseColor[3];   /* linear albedo, [0, 1], default 0.50, 0.33, 0.18. Fresh material without an image */
    float baseRoughness;  /* [0, 1], default 0.7 */
    /* Heat and water: for objects without FW_BURNABLE_LITE. */
    float density;                 /* kg/m^3, [1, 20000], default 450 */
    float specificHeat;            /* J/kg/K, [100, 10000], default 2500 */
    float conductivity;            /* W/m/K, [0.001, 500], default 0.12 */
    float ignitionTemperature;     /* K, [300, 2000], default 623. Surface temperature of ignition near a flame */
    float autoIgnitionTemperature; /* K, [ignitionTemperature, 3000], default 873. Ignition without a flame */
    float flameFeedback;           /* W/m^2, [0, 200000], default 25000. Heat that its own flame returns to the surface. Below
                                      about 9000 a lone flame goes out, as on real planks */
    float charFloor;               /* share, [0.01, 1], default 0.38. Thick fuel: share of its burning rate that char cannot
                                      stop */
    float waterHeld;               /* g/m^2, [0, 1023], default 200. Water that stays on the surface; more runs off */
    float radiantFraction;         /* share, [0, 1], default 0.3. Share of its heat that leaves as radiation */
    float sootYield;               /* kg of soot per kg burnt, [0, 1], default 0.015 */
    float recede;         /* share, [0, 1], default 0.3. Share of the thickness that is gone once it is consumed; the rest stays
                             as char. For FW_BURNABLE_RECEDE */
    float shrink;         /* share, [0, 0.5], default 0. Shrinkage of the lengths of a charred sheet */
    float curl;           /* 1/m, [0, 200], default 0. Curvature of a charred sheet */
} FwMaterialDef;
static inline FwMaterialDef fwDefaultMaterialDef(void) { /* pine */
    FwMaterialDef d; fwInitDef(FW_DEF_MATERIAL, &d, (uint32_t)sizeof d); return d;
}
/* Overwrites all fields but structSize with a preset. [any] */
FW_API FwResult FW_CALL fwInitMaterialPreset(FwMaterialDef* def, uint32_t preset);
FW_API const char* FW_CALL fwMaterialPresetName(uint32_t preset); /* static text, never null [any] */
FW_API FwResult FW_CALL fwWorld_CreateMaterial(FwWorld*, const FwMaterialDef* def, FwMaterialId* id); /* [world] */
FW_API FwResult FW_CALL fwWorld_DestroyMaterial(FwWorld*, FwMaterialId id); /* its objects keep their copy [world] */

/* ---- images: base colours --------------------------------------------------------------------------- */

typedef struct FwImageDef {
    uint32_t structSize, flags; /* flags: 0 */
    uint32_t width, height;     /* px, [1, 8192] */
    const void* pixels;         /* RGBA8, rows top first, tightly packed; sRGB colour, linear alpha */
    float alphaCutoff;          /* [0, 1], default 0: alpha is ignored. Above 0 the image is a cut-out: objects that show it do
                                   not exist where its alpha is lower. There they draw nothing, hold no fuel (fire goes
                                   around) and carry nothing (see FW_EVENT_STRUCTURE_BROKE). A texel of the burn map can burn
                                   if any part of it exists. Costs such objects 2 bytes a texel */
    float reserved;             /* 0 */
} FwImageDef;
static inline FwImageDef fwDefaultImageDef(void) {
    FwImageDef d; fwInitDef(FW_DEF_IMAGE, &d, (uint32_t)sizeof d); return d;
}
FW_API FwResult FW_CALL fwWorld_CreateImage(FwWorld*, const FwImageDef* def, FwImageId* id); /* [world] */
FW_API FwResult FW_CALL fwWorld_DestroyImage(FwWorld*, FwImageId id); /* its objects fall back to their base colour [world] */

/* ---- meshes: baked once, shared by any number of objects ----------------------------------------------- */

typedef struct FwMeshDef {
    uint32_t structSize, flags;    /* flags: FwMeshFlags, default 0 */
    const float* positions;        /* 3 a vertex, in the mesh's unit (metersPerUnit). Required unless cooked */
    const float* normals;          /* 3 a vertex; null: computed */
    const float* uvs;              /* 2 a vertex, or null */
    const float* details;          /* 2 a vertex: m on the surface in the mesh's unit, y along the grain; or null */
    const uint32_t* colors;        /* RGBA8, linear, 1 a vertex; null: white */
    const void* indices;           /* 3 a triangle */
    const uint8_t* triangleMaterials; /* 1 a triangle, [0, 7]; null: 0 */
    uint32_t vertexCount, indexCount; /* [3, 16777216]; [3, 50331648], a multiple of 3 */
    uint32_t indexSize;            /* bytes, 2 or 4, default 4 */
    uint32_t mapSize;              /* texels, [8, 4096], default 512. Largest side of the burn map */
    float texelsPerMetre;          /* 1/m, (0, 4096], default 128. Requested density; lowered to fit mapSize */
    float noiseAmplitude;          /* [0, 0.5], default 0.15. Raggedness of the front */
    float noiseFeature;            /* metres in every unit, [0.0001, 1000], default 0.012. Size of that noise */
    uint32_t noiseSeed;            /* default 1 */
    const void* cooked;            /* bytes of fwCookMesh; if given, the library ignores the arrays above */
    uint64_t cookedSize;           /* bytes, [1, 2^32] */
    float metersPerUnit;           /* m, [0.0001, 1000], default 0: the world's unit; in fwCookMesh 0 means 1. Length of the
                                      mesh's unit: for the arrays above and all of its object space (transforms start from it;
                                      pins, skinned vertices and FwMeshInfo use it). Cooked bytes hold metres: for a cooked
                                      mesh this sets only the unit of its object space */
    uint32_t reserved;             /* 0 */
} FwMeshDef;
typedef enum FwMeshFlags {
    FW_MESH_TRUST_UVS = 1, /* use the UVs for the burn map, even if they overlap or stretch */
    FW_MESH_FLAGS_FORCE32 = 0x7fffffff
} FwMeshFlags;
static inline FwMeshDef fwDefaultMeshDef(void) {
    FwMeshDef d; fwInitDef(FW_DEF_MESH, &d, (uint32_t)sizeof d); return d;
}
typedef struct FwMeshInfo {
    uint32_t structSize;
    uint32_t mapWidth, mapHeight, texels, charts; /* texels: those that triangles cover */
    uint32_t vertices, triangles, degenerateTriangles, openEdges, nonManifoldEdges;
    uint32_t usedOwnUvs, reserved; /* 1: the burn map uses the UVs of the mesh */
    float area, texelArea;         /* m^2 */
    float boundsLow[3], boundsHigh[3]; /* m, object space */
    float texelsPerMetre, bakeMilliseconds; /* 1/m; ms */
} FwMeshInfo;
/* Creates a mesh and bakes its burn map. Takes up to seconds for 100k triangles; cooked bytes load quickly.
 * FW_ERROR_BAD_DATA: the mesh or the cooked bytes are unusable. [world] */
FW_API FwResult FW_CALL fwWorld_CreateMesh(FwWorld*, const FwMeshDef* def, FwMeshId* id);
FW_API FwResult FW_CALL fwWorld_DestroyMesh(FwWorld*, FwMeshId id); /* refused while an object uses it [world] */
FW_API FwResult FW_CALL fwWorld_GetMeshInfo(FwWorld*, FwMeshId id, FwMeshInfo* info); /* [world] */
/* Bakes a mesh to bytes: for tools, caches and worker threads. If `buffer` is null, *size gets the size needed; otherwise
 * *size is the capacity on entry and the bytes written on return. [any] */
FW_API FwResult FW_CALL fwCookMesh(FwContext* context, const FwMeshDef* def, void* buffer, uint64_t* size);

/* ---- burnable meshes: objects that burn ----------------------------------------------------------------- */

typedef enum FwBurnableFlags { /* 4, 64, 512 and 8192 are reserved */
    FW_BURNABLE_HIDDEN = 1,     /* simulated but not drawn by the library */
    FW_BURNABLE_TWO_SIDED = 2,  /* draws back faces too */
    FW_BURNABLE_NO_HOLES = 8,   /* the surface is never consumed */
    FW_BURNABLE_LITE = 16,      /* no temperature, fuel or water for each texel. Saves 8 bytes a texel and all work behind the
                                   front. The object burns by burnTime alone, and water stays until FW_DRY */
    FW_BURNABLE_REFINE = 32,    /* drawn with finer triangles where it burns, down to the texels of its burn map. The refined
                                   surface recedes as the material is consumed */
    FW_BURNABLE_RECEDE = 128,   /* for solids: the drawn surface recedes as it is consumed. Closed meshes of up to 65536
                                   triangles show inner walls behind holes; that needs no flag */
    FW_BURNABLE_SHELL = 256,    /* for thin sheets: the sheet hangs, flutters, curls and shrinks as it chars, and tears; see
                                   FwPin. Cosmetic: fire spreads and is queried in the rest pose */
    FW_BURNABLE_SKINNED = 1024, /* the host moves its vertices: fwWorld_SetVertexPositions */
    FW_BURNABLE_NO_SPREAD = 2048, /* its fire reaches no other object */
    FW_BURNABLE_NO_DAMAGE = 4096, /* it burns as usual but shows only flames: no char, holes, recession, curling or refinement */
    FW_BURNABLE_FLAGS_FORCE32 = 0x7fffffff
} FwBurnableFlags;

typedef struct FwPin { /* holds the points of a sheet that are within `radius` of a segment */
    float from[3], to[3], radius, reserved; /* m, [-1e6, 1e6], object space; radius: m, [0, 1e6]; reserved: 0 */
} FwPin;
typedef struct FwBurnableMeshDef {
    uint32_t structSize, flags;       /* flags: FwBurnableFlags, default 0. At most one of SKINNED, REFINE, RECEDE and
                                         SHELL */
    FwMeshId mesh;
    FwMaterialId materials[8];        /* by triangle material. All null: pine. If one is set, null ones are noncombustible */
    FwImageId baseColor;              /* null: the material's base colour and procedural detail */
    float transform[16];              /* mesh unit to world unit, default identity. Rotation, mirror and a scale for each axis;
                                         the largest scale is at most 16 times the smallest; no shear. Objects of one mesh
                                         share its buffers if the ratio of their scales is the same; each other ratio costs a
                                         copy */
    float moisture;                   /* kg/kg, [0, 2], default 0. Added to that of the materials */
    float tint[3];                    /* factor, [0, 100], default 1. Multiplies the base colour */
    const uint8_t* multiplier;        /* 128: factor 1, 0: cannot burn; or null. Factors of the front speed over the burn map */
    uint32_t multiplierWidth, multiplierHeight; /* [1, 8192] with a multiplier; resampled (nearest) to the burn map */
    uint64_t userData;                /* returned in events */
    FwImageId baseColors[8];          /* by triangle material; null: baseColor */
    uint32_t refineDepth;             /* [0, 5], default 5. FW_BURNABLE_REFINE...: how often an edge is halved */
    float refinePixelsPerEdge;        /* px, [1, 1000], default 8. Length of the finest edges on the screen */
    const FwPin* pins;                /* for FW_BURNABLE_SHELL; null: the sheet falls */
    uint32_t pinCount;                /* [0, 8] */
    float ground;                     /* m along up, world, [-1e9, 1e9], default -1e9. Sheets fall no deeper */
    float spreadChance;               /* [0, 1], default 1. As in FwWorldDef, for fire of this object; multiplied by the
                                         world's chance */
    uint32_t maxHops;                 /* default 0: no limit. As in FwWorldDef */
    uint32_t maxBurningTiles;         /* default 0: no limit. As in FwWorldDef, for this object */
    float timeToLive;                 /* s, [0, 1e6], default 0: no limit. As in FwWorldDef */
    float heatPsi, heatStep;          /* reserved, default 0 */
    /* FW_EVENT_STRUCTURE_BROKE. Checked twice a second of world time. Holes count as gone: burnt out or collapsed. Each check
     * costs about 25 ns a texel; on a device it copies the burn map, 12 bytes a texel. */
    float breakShare;                 /* share, [0, 1], default 0: never. Raises the event once this share of the surface is
                                        gone */
    float breakArea;                  /* m^2, [0, 1e6], default 0: never. Minimum area of a disconnected piece that raises the
                                         event. A piece is disconnected when no remaining surface connects it to its supports.
                                         Supports: texels of each connected part of the mesh that are at most two texel sides
                                         above its lowest, in the present orientation; for FW_BURNABLE_SHELL its pins */
} FwBurnableMeshDef;
static inline FwBurnableMeshDef fwDefaultBurnableMeshDef(void) {
    FwBurnableMeshDef d; fwInitDef(FW_DEF_BURNABLE_MESH, &d, (uint32_t)sizeof d); return d;
}
FW_API FwResult FW_CALL fwWorld_CreateBurnableMesh(FwWorld*, const FwBurnableMeshDef* def, FwBurnableMeshId* id); /* [world] */
FW_API FwResult FW_CALL fwWorld_DestroyBurnableMesh(FwWorld*, FwBurnableMeshId id); /* [world] */
/* Moves an object; `transform` is as FwBurnableMeshDef::transform. Wind, gravity and (for another size) the front's speed
 * follow when the next parameters are latched, at most a quarter of a second later. Another ratio of the scales than at
 * creation stretches pictures and queries; fire keeps the metric of its creation, times the mean scale. A mirror is fixed at
 * creation. [world] */
FW_API FwResult FW_CALL fwWorld_SetTransform(FwWorld*, FwBurnableMeshId id, const float transform[16]);
/* Sets the vertices of an object with FW_BURNABLE_SKINNED, from the next frame on: in the order and object space of its mesh.
 * `positions`: 3 a vertex, m, [-1e6, 1e6]. `normals`: 3 a vertex; null: computed from the triangles. Pictures, flames,
 * lights, ignitions, queries and tags follow. Fire still spreads in the metric and along the normals of the rest pose.
 * [world] */
FW_API FwResult FW_CALL fwWorld_SetVertexPositions(FwWorld*, FwBurnableMeshId id, const float* positions,
                                                   const float* normals, uint32_t vertexCount);
FW_API FwResult FW_CALL fwWorld_SetHidden(FwWorld*, FwBurnableMeshId id, uint32_t hidden); /* [world] */

typedef enum FwIgnitionKind {
    FW_IGNITE = 0,      /* unburnt, dry texels ignite now */
    FW_WET = 1,         /* wets texels. A burning texel goes out if water takes more heat than fire gives. A wet texel cannot
                           ignite until heat or air has dried it. FW_BURNABLE_LITE: goes out at once, stays wet until FW_DRY */
    FW_DRY = 2,         /* dries wet texels */
    FW_EXTINGUISH = 3,  /* puts out and leaves dry: a texel may reignite from a burning neighbour */
    FW_IGNITION_KIND_FORCE32 = 0x7fffffff
} FwIgnitionKind;
typedef struct FwIgnitionDef { /* a ball that acts on one object or on all of them */
    uint32_t structSize;
    uint32_t kind;            /* FwIgnitionKind, default FW_IGNITE */
    FwBurnableMeshId object;  /* null: every object that the ball touches */
    float position[3];        /* m, [-1e6, 1e6], world */
    float radius;             /* m, [0, 1e6], default 0. Includes at least the nearest texel within reach */
    float delay;              /* s from now, [0, 3600], default 0 */
    float water;              /* g/m^2, [0, 1023], default 0: as much as the material holds. For FW_WET; otherwise 0 */
    uint32_t reserved[2];
} FwIgnitionDef;
static inline FwIgnitionDef fwDefaultIgnitionDef(void) {
    FwIgnitionDef d; fwInitDef(FW_DEF_IGNITION, &d, (uint32_t)sizeof d); return d;
}
/* Queues an ignition, wetting, drying or extinction. Takes effect in the step whose window contains its time. *texels (may be
 * null) gets the number of texels that it addresses. FW_NOTHING_THERE: it addresses no texel, or FW_IGNITE addresses none that
 * can burn (noncombustible, cut out, multiplier 0, or wetted by a queued call). Then the log (FW_LOG_INFO) and
 * fwWorld_GetLastMessage name the cause: the nearest object and its distance, or the material. Water of earlier steps is
 * unknown here: see FW_POINT_WET of fwWorld_RequestPoint. [world] */
FW_API FwResult FW_CALL fwWorld_Ignite(FwWorld*, const FwIgnitionDef* def, uint32_t* texels);

/* Transfers the burn of `from` to `to`, an object with another mesh of the same shape: a level of detail. At the next step
 * each texel of `to` copies state, fuel, temperature and water of the nearest texel of `from`. Nearest: in object space, in
 * rest pose. Texels that face the same way (within 60 degrees) come first. A texel copies nothing if none is within 5 % of the
 * diagonal of `to`'s box plus two texels. The burnt share of the area stays, to within a texel along its edge. Noncombustible
 * texels stay unchanged. Events and FwObjectState of `to` continue those of `from`; tags and queries stay with their object.
 * `from` keeps its burn. Destroy it after the next step (fwWorld_DestroyLater waits for that), or hide it and put it out.
 * The result is bit-identical on every backend and in command logs, timelines and networks.
 * FW_ERROR_INVALID_ARGUMENT: one has FW_BURNABLE_LITE and the other not; either plays a baked burn or takes part in another transfer. FW_ERROR_BAD_DATA: less than half of `to` has a matching texel. [world] */
FW_API FwResult FW_CALL fwWorld_TransferBurn(FwWorld*, FwBurnableMeshId from, FwBurnableMeshId to);

/* ---- volumetric fires: flames without fuel ----------------------------------------------------------------- */

typedef enum FwFirePreset {
    FW_FIRE_CAMP = 0, FW_FIRE_CANDLE = 1, FW_FIRE_TORCH = 2, FW_FIRE_BONFIRE = 3, FW_FIRE_HOUSE = 4,
    FW_FIRE_GAS_BURNER = 5, FW_FIRE_MAGIC_BLUE = 6, FW_FIRE_MAGIC_GREEN = 7, FW_FIRE_DYING_EMBERS = 8,
    FW_FIRE_PRESET_COUNT = 9, FW_FIRE_PRESET_FORCE32 = 0x7fffffff
} FwFirePreset;
typedef enum FwVolumetricFireFlags {
    FW_FIRE_HIDDEN = 1,   /* neither drawn nor a light; its time continues */
    FW_FIRE_NO_SMOKE = 2,
    FW_FIRE_NO_LIGHT = 4, /* fwWorld_GetLights omits it */
    FW_FIRE_NO_COLLISION = 8, /* passes through colliders and occluder boxes */
    FW_FIRE_IGNITES = 16, /* ignites burnable meshes that it touches long enough; see FwVolumetricFireDef */
    FW_FIRE_FLAGS_FORCE32 = 0x7fffffff
} FwVolumetricFireFlags;
typedef enum FwFireTier { /* 4 is reserved. How the views of fwWorld_RecordOutside show a fire. Other views march all fires as they draw */
    FW_FIRE_TIER_AUTO = 0,       /* by size on the screen. Marches at most 32 flames, the 16 largest at high quality */
    FW_FIRE_TIER_MARCH_HIGH = 1, /* marched each frame with up to 64 samples a ray. If the host requests it, rays
                                    through thin regions take more samples than with AUTO: thin flame tongues show the least
                                    grain. Cost: about 1.5 times that of AUTO */
    FW_FIRE_TIER_MARCH_LOW = 2,  /* marched each frame with two thirds of those samples */
    FW_FIRE_TIER_IMPOSTOR = 3,   /* an impostor of its own: a billboard, marched at up to 24 march pixels across. Twelve
                                    impostors are marched in each frame, round-robin, whatever their number. Meant for flames
                                    less than 13 px across */
    FW_FIRE_TIER_SHARED_IMPOSTOR = 5,   /* an impostor that similar flames share. Each frame marches one of them into an atlas of
                                    the last 32 frames. Each flame shows the atlas up to 22 frames late, with its own width,
                                    height and lean; half of them are mirrored. Similar: the same appearance, nearly the same
                                    width, height for that width and view elevation, and no obstacle. There are 4 atlases. Without
                                    a complete atlas a flame has an impostor of its own. AUTO uses this tier for similar flames 10
                                    to 24 px across, and for those of any size beyond the 32 */
    FW_FIRE_TIER_FORCE32 = 0x7fffffff
} FwFireTier;
typedef struct FwFirePoint { /* a point of the line that a flame follows, base first */
    float position[3];       /* m, [-1e6, 1e6], world */
    float radius;            /* m, [0, 100]. Radius of the burning tube */
} FwFirePoint;
/* Power and width set the height of a flame (Heskestad); it pulses at its own rate. Its gas rises, leans in the wind, trails
 * behind a motion, and flows around colliders and occluder boxes. Fires near each other lean together and, merged, grow
 * taller. With too little power for its width a fire burns as many small flames. Floats, cosmetic: machines may differ.
 * Only FW_FIRE_IGNITES changes what burns. Eight times a second each burnable mesh within the flame counts its exposure.
 * Position, diameter, power, windResponse and the world's wind define the flame there (with points: their radius). After the
 * material's ignition time under 35 kW/m^2, at the world's pace, the covered surface ignites.
 * Fields with the unit "factor" multiply the value of the preset. */
typedef struct FwVolumetricFireDef {
    uint32_t structSize, flags; /* flags: FwVolumetricFireFlags, default 0 */
    uint32_t preset;            /* FwFirePreset, default FW_FIRE_CAMP. Its appearance; size and power are below */
    uint32_t seed;              /* default 0: a different seed for each fire of a world. Seeds its shapes */
    float position[3];          /* m, [-1e6, 1e6], world. Middle of its base */
    float diameter;             /* m, [0.002, 20], default 0.6. Of its base */
    float power;                /* kW, [0, 100000], default 60; 0: out */
    float windResponse;         /* factor of the wind, [0, 4], default 1 */
    float turbulence;           /* factor, [0, 3], default 1. How torn the flame is */
    float speed;                /* factor, [0, 4], default 1. Of all motion in the flame */
    float density;              /* factor, [0, 10], default 1. Opacity */
    float smoke;                /* factor, [0, 10], default 1 */
    float blue;                 /* factor, [0, 10], default 1. Blue at its foot */
    float tint[3];              /* linear colour, [0, 1], default 1. Replaces the black-body colour by tintWeight */
    float tintWeight;           /* share, [0, 1], default 0: the colour of the preset */
    uint32_t pointCount;        /* default 0: it rises freely. [2, 32]: it follows the points, as high as their line is long
                                   and as wide as the first point; wind has no effect */
    const FwFirePoint* points;
    uint64_t userData;          /* returned in its state */
    FwFireProfileId profile;    /* null: that of the preset */
    float blend;                /* s, [0, 60], default 0.3. Blend from free motion to points or a track, and back */
    uint32_t tier;              /* FwFireTier, default FW_FIRE_TIER_AUTO */
    float coreTint[3];          /* linear colour, [0, 1], default 1. Colour of the hottest gas if tintWeight is not 0; it fades
                                   to `tint` as the gas cools */
    float coreTintWeight;       /* share, [0, 1], default 0: a paler `tint` */
} FwVolumetricFireDef;
static inline FwVolumetricFireDef fwDefaultVolumetricFireDef(void) {
    FwVolumetricFireDef d; fwInitDef(FW_DEF_VOLUMETRIC_FIRE, &d, (uint32_t)sizeof d); return d;
}
/* Sets preset, diameter (in metres: see fwWorld_ConvertDef) and power of a def; other fields stay. structSize is set. [any] */
FW_API FwResult FW_CALL fwInitFirePreset(FwVolumetricFireDef* def, uint32_t preset);
FW_API const char* FW_CALL fwFirePresetName(uint32_t preset); /* static text, never null [any] */
/* Creates a volumetric fire. At most 256 at a time in a world, and at most 256 flames in all. [world] */
FW_API FwResult FW_CALL fwWorld_CreateVolumetricFire(FwWorld*, const FwVolumetricFireDef* def, FwVolumetricFireId* id);
FW_API FwResult FW_CALL fwWorld_DestroyVolumetricFire(FwWorld*, FwVolumetricFireId id); /* [world] */
/* Moves the base of a fire, from the next frame on; the flame trails behind. A motion faster than 100 m/s is a jump: the whole
 * flame moves at once and keeps its shape. [world] */
FW_API FwResult FW_CALL fwWorld_MoveVolumetricFire(FwWorld*, FwVolumetricFireId id, const float position[3]);
/* Sets the power: kW, [0, 100000]. The flame follows within a second. [world] */
FW_API FwResult FW_CALL fwWorld_SetVolumetricFirePower(FwWorld*, FwVolumetricFireId id, float power);
/* Sets FwVolumetricFireDef::points. pointCount 0: the fire rises freely again. [world] */
FW_API FwResult FW_CALL fwWorld_SetVolumetricFirePoints(FwWorld*, FwVolumetricFireId id, const FwFirePoint* points,
                                                        uint32_t pointCount);
FW_API FwResult FW_CALL fwWorld_SetVolumetricFireHidden(FwWorld*, FwVolumetricFireId id, uint32_t hidden); /* [world] */
/* Sets FwVolumetricFireDef::tier. Views change over within 16 frames. [world] */
FW_API FwResult FW_CALL fwWorld_SetVolumetricFireTier(FwWorld*, FwVolumetricFireId id, uint32_t tier);

typedef struct FwVolumetricFireState { /* state at the last frame; before the first frame, the state at its start */
    uint32_t structSize, flames; /* flames: number of separate flames; 0: out */
    uint64_t userData;
    float power;                /* kW, present value */
    float height;               /* m. Mean visible height */
    float pulseRate;            /* Hz */
    float contactPower;         /* kW into colliders and occluder boxes in its way, mean over a pulse */
    float boundsLow[3], boundsHigh[3]; /* m, world. Of everything visible, smoke included; empty while it is out */
    float tip[3];               /* m, world. End of its mean height */
    float lightPosition[3];     /* m, world */
    float lightIntensity;       /* W/sr of visible light, with flicker */
    float contact[3];           /* m, world. Middle of the touched surface; valid if contactPower > 0 */
} FwVolumetricFireState;
/* [world] */
FW_API FwResult FW_CALL fwWorld_GetVolumetricFireState(FwWorld*, FwVolumetricFireId id, FwVolumetricFireState* state);

/* Animation of a fire: keys of its line, with smooth interpolation. */
typedef struct FwFireTrackDef {
    uint32_t structSize, flags; /* flags: FwFireTrackFlags, default 0 */
    uint32_t keyCount;          /* [1, 4096] */
    uint32_t pointsPerKey;      /* [2, 32] */
    const float* times;         /* s, increasing; keyCount of them */
    const FwFirePoint* points;  /* key after key, relative to the fire's position, m, world axes. Copied */
    float weight;               /* share, [0, 1], default 1. Weight of the track; the rest is the fire's free motion */
    uint32_t reserved;          /* 0 */
} FwFireTrackDef;
typedef enum FwFireTrackFlags {
    FW_FIRE_TRACK_LOOP = 1, /* the last key equals the first, and the track repeats. Without it the fire stays at the last key */
    FW_FIRE_TRACK_FLAGS_FORCE32 = 0x7fffffff
} FwFireTrackFlags;
static inline FwFireTrackDef fwDefaultFireTrackDef(void) {
    FwFireTrackDef d; fwInitDef(FW_DEF_FIRE_TRACK, &d, (uint32_t)sizeof d); return d;
}
/* Plays a track from its first key, instead of points; blends in and out within FwVolumetricFireDef::blend. Null ends it: the
 * fire returns to its free motion or its points. [world] */
FW_API FwResult FW_CALL fwWorld_SetVolumetricFireTrack(FwWorld*, FwVolumetricFireId id, const FwFireTrackDef* def);

/* Temperature and soot of a flame, as an artist paints them: over the radius (x, from the axis to 1.25 radii) and the height
 * (y, base row first). Either texels or a cooked .fwprofile. */
typedef struct FwFireProfileDef {
    uint32_t structSize, flags; /* flags: 0 */
    uint32_t width, height;     /* texels, [8, 512]; resampled to 64 x 128 */
    const float* texels;        /* 2 each: temperature (K, [0, 3000]) and soot ([0, 2]). Below 1000 K soot does not glow; then
                                   K / 1000 is the amount of clean, blue-burning gas */
    const void* cooked;         /* bytes of a .fwprofile; if given, texels are ignored */
    uint64_t cookedSize;        /* bytes */
} FwFireProfileDef;
static inline FwFireProfileDef fwDefaultFireProfileDef(void) {
    FwFireProfileDef d; fwInitDef(FW_DEF_FIRE_PROFILE, &d, (uint32_t)sizeof d); return d;
}
/* Creates a fire profile. At most 23 at a time. [world] */
FW_API FwResult FW_CALL fwWorld_CreateFireProfile(FwWorld*, const FwFireProfileDef* def, FwFireProfileId* id);
FW_API FwResult FW_CALL fwWorld_DestroyFireProfile(FwWorld*, FwFireProfileId id); /* refused while a fire uses it [world] */
/* Converts a profile to .fwprofile bytes; `buffer` and `size` as in fwCookMesh. [any] */
FW_API FwResult FW_CALL fwCookFireProfile(FwContext* context, const FwFireProfileDef* def, void* buffer, uint64_t* size);

typedef enum FwFireColliderKind {
    FW_COLLIDER_SPHERE = 0, FW_COLLIDER_CAPSULE = 1, FW_COLLIDER_BOX = 2, FW_COLLIDER_PLANE = 3,
    FW_COLLIDER_HEIGHT_FIELD = 4, FW_COLLIDER_DISTANCE = 5,
    FW_COLLIDER_DEPTH = 6, /* a depth image of the scene. Visible surfaces bend and flatten flames. So do, if the world's up is
                              0,1,0, the underside of a slab whose top is visible and the space below it. Hidden surfaces have
                              no effect. It shades nothing and stops no jet, so that no pixel changes what burns */
    FW_COLLIDER_KIND_FORCE32 = 0x7fffffff
} FwFireColliderKind;
typedef struct FwFireColliderDef { /* an obstacle for flames, in addition to the world's occluder boxes; cosmetic */
    uint32_t structSize;
    uint32_t kind;         /* FwFireColliderKind */
    float position[3];     /* m, [-1e6, 1e6], world. Middle; capsule: one end; plane: a point; height field: corner of lowest x
                              and z */
    float end[3];          /* m, [-1e6, 1e6], world. Capsule: its other end */
    float normal[3];       /* default 0,1,0. Plane: direction towards the free side */
    float halfSize[3];     /* m, [1e-4, 1e5], default 0.5. Box */
    float rotation[4];     /* unit quaternion x, y, z, w, default 0,0,0,1. Box */
    float radius;          /* m, [1e-4, 1e5], default 0.5. Sphere, capsule. Depth image: [0.01, 100], the distance around flames
                              that the library tests; a tenth of it is the assumed thickness of surfaces */
    float cellSize;        /* m, [1e-3, 1e5], default 1. Height field: distance between two heights */
    uint32_t columns, rows;/* height field: heights along x and z, [2, 4096]; depth image: px, [2, 512] */
    const float* heights;  /* m, [-1e6, 1e6], above `position`. Row after row along x; for worlds whose up is 0,1,0. Copied */
    /* FW_COLLIDER_DISTANCE: returns the signed distance in m and writes its unit normal. The thread that steps or records the
     * world calls it many times. It must not call the world. The library reads a distance that is not finite as far away. */
    float (FW_CALL* distance)(void* distanceData, const float point[3], float normal[3]);
    void* distanceData;
    const float* depths;   /* [0, 1]. Depth image: clip z / w at the middle of each pixel, row after row, top first. A small
                              image (160 x 90) is enough, and so is a readback that is some frames old. Copied */
    float view[16], projection[16]; /* default identity. Depth image: its matrices, as in FwView */
} FwFireColliderDef;
static inline FwFireColliderDef fwDefaultFireColliderDef(void) {
    FwFireColliderDef d; fwInitDef(FW_DEF_FIRE_COLLIDER, &d, (uint32_t)sizeof d); return d;
}
/* Adds a collider. At most 64 at a time. [world] */
FW_API FwResult FW_CALL fwWorld_AddFireCollider(FwWorld*, const FwFireColliderDef* def, FwFireColliderId* id);
/* Replaces the whole def of a collider, from the next frame on. A height field keeps its heights if `heights` is null and
 * columns and rows are unchanged. [world] */
FW_API FwResult FW_CALL fwWorld_SetFireCollider(FwWorld*, FwFireColliderId id, const FwFireColliderDef* def);
FW_API FwResult FW_CALL fwWorld_RemoveFireCollider(FwWorld*, FwFireColliderId id); /* [world] */

typedef struct FwFireSample {   /* effect of all volumetric fires at a point, at the last frame */
    uint32_t structSize;
    uint32_t inside;            /* 1: within a mean flame */
    float temperature;          /* K. Gas temperature; 293 beyond the reach of fire */
    float heatFlux;             /* W/m^2 on a small cold body, by gas and radiation; nearby walls shade it */
    float gas[3];               /* m/s. Velocity of the fire's gas, without the wind */
    uint32_t reserved;
    FwVolumetricFireId fire;    /* the fire that heats the point most, or null */
} FwFireSample;
/* Samples all volumetric fires at a point (m, world). Answers at once, on every backend. [world] */
FW_API FwResult FW_CALL fwWorld_SampleVolumetricFires(FwWorld*, const float point[3], FwFireSample* sample);
typedef struct FwFireForce {     /* effect of all volumetric fires on a ball at rest */
    uint32_t structSize;
    float ignitionPower;        /* W into the ball */
    float force[3];             /* N */
    uint32_t reserved;
} FwFireForce;
/* Gets heat and force on a ball; centre: m, world; radius: m, [0, 100]. [world] */
FW_API FwResult FW_CALL fwWorld_GetVolumetricFireForce(FwWorld*, const float centre[3], float radius, FwFireForce* force);

/* ---- flipbooks: frames that particles and flames show ------------------------------------------------------- */

typedef enum FwFlipbookPreset { /* baked from flames of this library: 64 x 64 texels a frame, sparks 32 x 32 */
    FW_FLIPBOOK_CUSTOM = 0,  /* FwFlipbookDef::cooked */
    FW_FLIPBOOK_FLAME = 1,   /* fire: a standing flame, loop of 1.6 s */
    FW_FLIPBOOK_ROLL = 2,    /* fire: a ball that rolls up about a ring and tears */
    FW_FLIPBOOK_PUFF = 3,    /* fire: a ball torn by eddies */
    FW_FLIPBOOK_SMOKE = 4,   /* smoke: thick, in billows */
    FW_FLIPBOOK_HAZE = 5,    /* smoke: thin, drawn out */
    FW_FLIPBOOK_SPARK = 6,   /* sparks: a streak */
    FW_FLIPBOOK_PRESET_COUNT = 7, FW_FLIPBOOK_PRESET_FORCE32 = 0x7fffffff
} FwFlipbookPreset;
/* Frames of fire, smoke or sparks, with motion vectors between them: interpolated frames show one moving shape, not two
 * faded ones. Frames hold temperatures instead of colours; black-body radiation colours them, as in volumetric flames. */
typedef struct FwFlipbookDef {
    uint32_t structSize, flags; /* flags: 0 */
    uint32_t preset;            /* FwFlipbookPreset, default FW_FLIPBOOK_CUSTOM */
    uint32_t reserved;          /* 0 */
    const void* cooked;         /* bytes of a .fwbook file (from flamewright_flipbook); null with a preset */
    uint64_t cookedSize;        /* bytes */
} FwFlipbookDef;
static inline FwFlipbookDef fwDefaultFlipbookDef(void) {
    FwFlipbookDef d; fwInitDef(FW_DEF_FLIPBOOK, &d, (uint32_t)sizeof d); return d;
}
/* Creates a flipbook. At most 32 at a time; all of a world fit into one texture of 4096 x 4096 texels.
 * FW_ERROR_OUT_OF_MEMORY: they do not fit. FW_ERROR_BAD_DATA, FW_ERROR_VERSION: the file is unusable. [world] */
FW_API FwResult FW_CALL fwWorld_CreateFlipbook(FwWorld*, const FwFlipbookDef* def, FwFlipbookId* id);
FW_API FwResult FW_CALL fwWorld_DestroyFlipbook(FwWorld*, FwFlipbookId id); /* refused while in use [world] */
/* Sets the flipbooks of flames and smoke on burning meshes, from the next frame on. `fire` is a flipbook of fire, `smoke` one
 * of smoke; null: procedural noise. [world] */
FW_API FwResult FW_CALL fwWorld_SetFlameFlipbooks(FwWorld*, FwFlipbookId fire, FwFlipbookId smoke);

/* ---- fire emitters: particles ------------------------------------------------------------------------------- */

typedef enum FwEmitterShape {
    FW_EMITTER_POINT = 0,
    FW_EMITTER_DISC = 1,  /* perpendicular to `direction`, of `radius` */
    FW_EMITTER_LINE = 2,  /* from position - extent to position + extent */
    FW_EMITTER_MESH = 3,  /* on the flaming tiles of `object`, each with a chance proportional to its power. If the object's
                             power P is at least `power`, the emitter runs at full particle count. Below it, count scales
                             linearly; speed and lifetime scale with (P / power)^0.2, which gives flames the height of
                             that power. The mesh provides the light */
    FW_EMITTER_SHAPE_FORCE32 = 0x7fffffff
} FwEmitterShape;
typedef enum FwEmitterFlags {
    FW_EMITTER_HIDDEN = 1,   /* neither drawn nor a light; its time continues */
    FW_EMITTER_NO_SMOKE = 2,
    FW_EMITTER_NO_LIGHT = 4, /* fwWorld_GetLights omits it */
    FW_EMITTER_GROUND = 8,   /* particles stay above `ground` and spread out there */
    FW_EMITTER_JET = 16,     /* a flamethrower: a pressurised stream along `direction` that tears into flame, instead of a rising
                                fire. Colliders (fwWorld_AddFireCollider), occluder boxes and burnable meshes stop it: it
                                splashes and reaches nothing behind */
    FW_EMITTER_IGNITES = 32, /* for a jet: it heats the burnable meshes that it hits, until they ignite */
    FW_EMITTER_NO_COLLISION = 64, /* for a jet: nothing stops it */
    FW_EMITTER_FLAGS_FORCE32 = 0x7fffffff
} FwEmitterFlags;
/* Fire with its smoke and sparks, made of particles in world space: large soft quads that the device simulates and draws. CPU
 * cost is that of one emitter, whatever its particle count. Floats, cosmetic. Power drives it: 0 in rate, speed, cone, size0,
 * size1, life, drag and temperature means the value of a fire of that power. */
typedef struct FwFireEmitterDef {
    uint32_t structSize, flags; /* flags: FwEmitterFlags, default 0 */
    uint32_t shape;             /* FwEmitterShape, default FW_EMITTER_POINT */
    uint32_t seed;              /* default 0: a different seed for each emitter of a world */
    float position[3];          /* m, [-1e6, 1e6], world */
    float direction[3];         /* of any length but 0, default 0,1,0. Direction of particles at birth */
    float extent[3];            /* m, [-100, 100]. For FW_EMITTER_LINE */
    float radius;               /* m, [0, 50], default 0. For FW_EMITTER_DISC */
    float power;                /* kW, [0, 100000], default 60; 0: no births */
    float rate;                 /* births a second, [0, 200000], default 0 */
    float speed;                /* m/s, [0, 200], default 0 */
    float cone;                 /* rad, [0, 2], default 0. Spread about `direction`; contains two thirds of the particles */
    float size0, size1;         /* m, [0, 50], default 0. Width at birth, and when the flame ends */
    float life;                 /* s, [0, 60], default 0. Life of the flame; smoke follows it */
    float lifeVariance;         /* share, [0, 1], default 0.33 */
    float drag;                 /* s, [0, 60], default 0. Time in which a particle takes on the speed of the air */
    float buoyancy;             /* factor, [-4, 4], default 1 */
    float windResponse;         /* factor, [0, 4], default 1 */
    float turbulence;           /* factor, [0, 4], default 1 */
    float inherit;              /* share, [0, 1], default 0.5. Share of the emitter's velocity that particles get */
    float smoke;                /* share, [0, 1], default 0.32. Share of the particles that turn to smoke */
    float smokeLife;            /* times the life of the flame, [0, 20], default 2.2 */
    float smokeDensity;         /* factor, [0, 4], default 1 */
    float sparks;               /* 1/s for each kW, [0, 1], default 0.04. Births of sparks and embers, at most 2048 alive. They
                                   fly for up to 2.5 s, bounce off the ground and off walls that a jet hits, lie there and go out.
                                   FW_EMITTER_MESH: each tile throws its own */
    float temperature;          /* K, [0, 2500], default 0. At birth */
    float ground;               /* m along up, [-1e6, 1e6], default 0. With FW_EMITTER_GROUND */
    uint32_t maxParticles;      /* [0, 1048576], default 0: as many as this power needs. The oldest are replaced */
    uint32_t reserved;          /* 0 */
    uint64_t userData;          /* returned in its state */
    /* Jet. 16 rays sweep its cone. They start `behind` the nozzle, where its holder stands: a nozzle that is pushed into or
     * through a wall burns that wall and not the room beyond. The share `heat` of its power heats the surfaces that rays hit,
     * spread over the hit area, eight times a second. It arrives after the time of flight; a wall that moves in between is
     * hit. The host's numbers alone decide this, so it is the same on every backend. The jet passes holes of a mesh's shape. A
     * ray also passes at most two burnt walls, if FwBurnableMeshDef allows their holes. It does not pass burnt holes of
     * FW_BURNABLE_LITE, nor does it reach such objects through burnt holes. */
    float behind;               /* m, [0, 10], default 0.5 */
    float heat;                 /* share, [0, 1], default 0.35 */
    /* Flipbooks. Each particle picks one of those given, by chance, and its own phase. None given: procedural noise. */
    FwFlipbookId fireFlipbooks[3];
    FwFlipbookId smokeFlipbooks[2];
    FwFlipbookId sparkFlipbook;
    FwBurnableMeshId object;    /* for FW_EMITTER_MESH. Once it is destroyed, births end */
    /* Jet with FW_EMITTER_IGNITES: sticking fuel. The share `stick` of the power that hits a surface stays there as fuel, in at
     * most 16 patches 0.25 m wide. A patch burns evenly over stickTime after its last fuel arrived. It flames and heats its mesh
     * with that power, counted in integers without loss. Fuel heats at once if all patches are taken or if the surface may
     * have burnt through by then. Water (FW_WET) that falls on a patch takes 2600 J a gram from its fuel; FW_EXTINGUISH removes
     * all of it. */
    float stick;                /* share, [0, 1], default 0 */
    float stickTime;            /* s in steps of 1/8, [0.125, 120], default 6 */
} FwFireEmitterDef;
static inline FwFireEmitterDef fwDefaultFireEmitterDef(void) {
    FwFireEmitterDef d; fwInitDef(FW_DEF_FIRE_EMITTER, &d, (uint32_t)sizeof d); return d;
}
/* Creates an emitter. At most 256 at a time in a world; FwWorldDef::maxParticles limits their particles. [world] */
FW_API FwResult FW_CALL fwWorld_CreateFireEmitter(FwWorld*, const FwFireEmitterDef* def, FwFireEmitterId* id);
/* Destroys an emitter with its particles. To let them burn out, set its power to 0 and wait. [world] */
FW_API FwResult FW_CALL fwWorld_DestroyFireEmitter(FwWorld*, FwFireEmitterId id);
/* Moves an emitter, from the next frame on. Births lie along the straight path to the new position, unless that needs more
 * than 100 m/s. `direction` null: unchanged. [world] */
FW_API FwResult FW_CALL fwWorld_MoveFireEmitter(FwWorld*, FwFireEmitterId id, const float position[3],
                                                const float* direction);
/* Sets the power: kW, [0, 100000]. The particle count stays at most that of creation: create an emitter with its highest
 * power. [world] */
FW_API FwResult FW_CALL fwWorld_SetFireEmitterPower(FwWorld*, FwFireEmitterId id, float power);
FW_API FwResult FW_CALL fwWorld_SetFireEmitterHidden(FwWorld*, FwFireEmitterId id, uint32_t hidden); /* [world] */
typedef struct FwFireEmitterState { /* state at the last frame */
    uint32_t structSize, particles; /* particles: those that may still be visible; 0: all are gone */
    uint32_t capacity, reserved;    /* capacity: most particles that it may have */
    uint64_t userData;
    float power;                /* kW */
    float rate, life, speed;    /* 1/s, s, m/s: present values */
    float reach;                /* m. Approximate length of its fire */
    float lightIntensity;       /* W/sr of visible light, with flicker */
    float lightPosition[3];     /* m, world */
    uint32_t blockedRays;            /* jet: how many of its 16 rays hit something */
    float clearDistance;              /* m. Jet: distance from its nozzle to the nearest hit; otherwise `reach` */
    float heated;               /* W that reached burnable meshes in the last 1/8 s */
    float stuckFuel;            /* kJ of sticking fuel */
    float stuckPower;           /* kW that sticking fuel gave off in the last 1/8 s, on meshes or not */
    uint32_t stuckPatches;       /* [0, 16]. Patches of sticking fuel */
    uint32_t reserved1;
} FwFireEmitterState;
FW_API FwResult FW_CALL fwWorld_GetFireEmitterState(FwWorld*, FwFireEmitterId id, FwFireEmitterState* state); /* [world] */

/* ---- particle fields: fire, smoke and water on a 2D grid, for small devices and far fires --------------------- */

typedef enum FwFieldPreset {
    FW_FIELD_FIRE = 0, FW_FIELD_SMOKE = 1, FW_FIELD_WATER = 2, FW_FIELD_PRESET_COUNT = 3,
    FW_FIELD_PRESET_FORCE32 = 0x7fffffff
} FwFieldPreset;
typedef enum FwFieldShape {       /* the surface that shows the grid */
    FW_FIELD_BILLBOARD = 0,            /* a billboard: turns about its up axis to face the camera */
    FW_FIELD_SPHEROID = 1,        /* its left and right borders meet */
    FW_FIELD_DISPLACED = 2,       /* a spheroid that bulges where the grid is dense */
    FW_FIELD_SHAPE_FORCE32 = 0x7fffffff
} FwFieldShape;
typedef enum FwFieldSource {
    FW_FIELD_SOURCE_BASE = 0,     /* the lowest rows; if particles fall, the highest */
    FW_FIELD_SOURCE_DISC = 1,
    FW_FIELD_SOURCE_PAINTED = 2,  /* FwParticleFieldDef::paint */
    FW_FIELD_SOURCE_FORCE32 = 0x7fffffff
} FwFieldSource;
typedef enum FwFieldOpen {        /* borders through which particles leave; the others are walls */
    FW_FIELD_OPEN_LEFT = 1, FW_FIELD_OPEN_RIGHT = 2, FW_FIELD_OPEN_BOTTOM = 4, FW_FIELD_OPEN_TOP = 8,
    FW_FIELD_OPEN_FORCE32 = 0x7fffffff
} FwFieldOpen;
typedef enum FwParticleFieldFlags { /* 2 is reserved */
    FW_FIELD_HIDDEN = 1,          /* not drawn; its time continues */
    FW_FIELD_WETS = 4,            /* for water: wets the burnable meshes that it touches and so puts them out. Eight times a
                                     second, from the content of its cells, the same on every backend. Full cells give 320 g/m^2
                                     in a second. A billboard acts as a sheet across its own x axis, however it faces the
                                     camera. Costs the CPU one field step for each step of the field */
    FW_FIELD_FLAGS_FORCE32 = 0x7fffffff
} FwParticleFieldFlags;
/* Cells count particles in integers. Only sources, the end of a life and open borders change their number, and every backend
 * counts the same. Steps are at fixed times of the world. */
typedef struct FwParticleFieldDef {
    uint32_t structSize, flags; /* flags: FwParticleFieldFlags, default 0 */
    uint32_t shape;             /* FwFieldShape, default FW_FIELD_BILLBOARD */
    uint32_t seed;              /* default 0: a different seed for each field of a world */
    float position[3];          /* m, [-1e6, 1e6], world. Middle of its lower edge; spheroid: its lowest point */
    float size[3];              /* m, [0.001, 1000], default 1. Width, height and, for spheroids, depth */
    float rotation[4];          /* unit quaternion x, y, z, w, default 0,0,0,1 */
    uint32_t width, height;     /* cells, [32, 256], default 64. The width is a multiple of 4 */
    uint32_t stepRate;          /* 1/s, [20, 30], default 24 */
    uint32_t open;              /* FwFieldOpen, default all but the bottom. Spheroids use only top and bottom */
    /* Eight numbers set its behaviour, the same for fire, smoke and water. Defaults: FW_FIELD_FIRE; see fwInitFieldPreset. */
    float amount;               /* [0, 4]. Strength of its source; at 1 a source cell is full after 12 steps */
    float rise;                 /* cells a step, [-4, 4]. Upward speed; below 0 particles fall */
    float spread;               /* [0, 1]. How fast differences even out */
    float memory;               /* [0, 1]. Share of its motion that a particle keeps */
    float chaos;                /* [0, 4]. Strength of eddies */
    float life;                 /* s, [0.05, 1000]. Mean life */
    float detail;               /* [0, 1]. Fine structure in the drawing */
    float body;                 /* [0, 2]. 0 emits light, 1 absorbs it, 2 refracts it */
    float windResponse;         /* cells a step for each m/s of wind along its width, [0, 4], default 0.12. Spheroids ignore it */
    uint32_t source;            /* FwFieldSource, default FW_FIELD_SOURCE_BASE */
    float sourceSize;           /* share, [0.001, 1]. Base: of the width. Disc: its diameter, of the smaller side */
    float sourceAt[2];          /* shares of width and height, [0, 1], default 0.5, 0.2. Middle of a disc */
    uint32_t reserved;          /* 0 */
    /* Bytes of width x height cells, bottom row first. Null: none. Copied. */
    const uint8_t* paint;       /* [0, 255]. Share of the source's rate in each cell; 255: all of it */
    const uint8_t* walls;       /* not 0: a wall, without particles */
    float tint[3];              /* linear factor, [0, 10], default 1 */
    float opacity;              /* factor, [0, 10], default 1 */
    uint64_t userData;          /* returned in its state */
} FwParticleFieldDef;
static inline FwParticleFieldDef fwDefaultParticleFieldDef(void) { /* a fire on a billboard */
    FwParticleFieldDef d; fwInitDef(FW_DEF_PARTICLE_FIELD, &d, (uint32_t)sizeof d); return d;
}
/* Sets the eight numbers and sourceSize of a def; other fields stay. structSize is set. [any] */
FW_API FwResult FW_CALL fwInitFieldPreset(FwParticleFieldDef* def, uint32_t preset);
FW_API const char* FW_CALL fwFieldPresetName(uint32_t preset); /* static text, never null [any] */
/* Creates an empty field. At most 256 at a time in a world. [world] */
FW_API FwResult FW_CALL fwWorld_CreateParticleField(FwWorld*, const FwParticleFieldDef* def, FwParticleFieldId* id);
FW_API FwResult FW_CALL fwWorld_DestroyParticleField(FwWorld*, FwParticleFieldId id); /* [world] */
/* Moves a field. `rotation` null: unchanged. [world] */
FW_API FwResult FW_CALL fwWorld_MoveParticleField(FwWorld*, FwParticleFieldId id, const float position[3],
                                                  const float rotation[4]);
FW_API FwResult FW_CALL fwWorld_SetParticleFieldAmount(FwWorld*, FwParticleFieldId id, float amount); /* amount: [0, 4] [world] */
FW_API FwResult FW_CALL fwWorld_SetParticleFieldHidden(FwWorld*, FwParticleFieldId id, uint32_t hidden); /* [world] */
/* Replaces paint and walls, as in the def; null: unchanged. Particles where a wall appears die. [world] */
FW_API FwResult FW_CALL fwWorld_PaintParticleField(FwWorld*, FwParticleFieldId id, const uint8_t* paint,
                                                   const uint8_t* walls);
typedef struct FwParticleFieldState { /* state at `frameIndex`: 2 to 3 frames ago on a device, now on the cpu backend */
    uint32_t structSize, reserved;
    uint64_t userData;
    uint64_t frameIndex;
    uint64_t inside;            /* particles. Always inside + dead + out = emitted */
    uint64_t emitted, dead, out;/* particles since creation; out: left over open borders */
    uint64_t steps;
    uint64_t bytes;             /* bytes of the backend for this field */
} FwParticleFieldState;
FW_API FwResult FW_CALL fwWorld_GetParticleFieldState(FwWorld*, FwParticleFieldId id, FwParticleFieldState* state); /* [world] */

/* ---- running ---------------------------------------------------------------------------------------------- */

/* Advances the simulation by deltaTime: s, [0, 10]. cpu backend: simulates at once. Own device: submits and waits.
 * A world simulates at most 1048560 s (12 days); the log has a warning a day before that.
 * FW_ERROR_WRONG_BACKEND: host device; use fwWorld_RecordOutside. FW_ERROR_INVALID_ARGUMENT: the world is at its limit (0
 * is still accepted), or a client may not advance so far. [world] */
FW_API FwResult FW_CALL fwWorld_Step(FwWorld*, float deltaTime);

typedef struct FwView { /* a camera and its light; all lengths in m */
    uint32_t structSize, flags;       /* flags: 0 */
    float view[16], projection[16];   /* default identity. World to view space, rigid; view space to Vulkan clip space: y down,
                                         depth 0..1. For other clip spaces: fwConvertProjection */
    float sunDirection[3];            /* unit vector towards the sun, default 0.408, 0.816, 0.408 */
    float sunColor[3];                /* [0, 1e6], default 3.0, 2.9, 2.7. Irradiance of the sun: a Lambert surface that faces it
                                         reflects albedo / pi times this. Scale: pi / 2 times a radiance, like cd/m^2 */
    float ambientSky[3], ambientGround[3]; /* [0, 1e6], default 0.35, 0.42, 0.55 and 0.14, 0.12, 0.10. Hemisphere about the
                                         world's up */
    float exposure;                   /* factor, [1e-6, 1e6], default 1. Multiplies all light before any tone mapping */
    float emissionScale;              /* factor, [0, 1e6], default 1. Glow and flames against the light of the scene */
    float time;                       /* s, [-1e9, 1e9], default 0. Only for flicker and pulsing */
    float haze;                       /* factor, [0, 8], default 1; 0: none. How far heat haze bends the background of a fire, on
                                         targets with FW_TARGET_HAZE */
    uint32_t viewId;                  /* default 0. Identifies the camera from frame to frame, any number: see
                                         fwWorld_RecordOutsideViews. Keep 0 with one view a frame */
    float reserved;
} FwView;
static inline FwView fwDefaultView(void) {
    FwView d; fwInitDef(FW_DEF_VIEW, &d, (uint32_t)sizeof d); return d;
}
typedef enum FwClipSpace { /* how a host's clip space differs from Vulkan's; for fwConvertProjection */
    FW_CLIP_Y_UP = 1,           /* y points up: Direct3D, Metal, WebGPU, Unreal */
    FW_CLIP_SYMMETRIC_DEPTH = 2,/* depth is -1..1 instead of 0..1 */
    FW_CLIP_OPENGL = 3,         /* both: OpenGL, Qt, glm without GLM_FORCE_DEPTH_ZERO_TO_ONE */
    FW_CLIP_REVERSE_DEPTH = 4,  /* reverses the depth: for a matrix with near at 0 and a depth buffer with near at 1, or vice
                                   versa. A matrix that is already reversed needs only FwVulkanTargetDef::reversedDepth */
    FW_CLIP_SPACE_FORCE32 = 0x7fffffff
} FwClipSpace;
/* Converts a host's projection to Vulkan's clip space, in place. clipSpace: FwClipSpace bits; 0: no change. Each point keeps
 * its pixel and its value in the depth buffer. [any] */
static inline void fwConvertProjection(float projection[16], uint32_t clipSpace) {
    for (int c = 0; c < 16; c += 4) {
        if (clipSpace & FW_CLIP_Y_UP) projection[c + 1] = -projection[c + 1];
        if (clipSpace & FW_CLIP_SYMMETRIC_DEPTH) projection[c + 2] = 0.5f * (projection[c + 2] + projection[c + 3]);
        if (clipSpace & FW_CLIP_REVERSE_DEPTH) projection[c + 2] = projection[c + 3] - projection[c + 2];
    }
}

typedef struct FwOffscreenDef { /* own device only: the shortest path to a picture */
    uint32_t structSize, width, height, reserved; /* px, [1, 8192], default 1280 x 720; reserved: 0 */
    FwView view;
    float background[4];              /* linear, [0, 1e6], default 0, 0, 0, 1 */
    void* pixels;                     /* output: RGBA8 sRGB, rows top first, width * height * 4 bytes */
} FwOffscreenDef;
static inline FwOffscreenDef fwDefaultOffscreenDef(void) {
    FwOffscreenDef d; fwInitDef(FW_DEF_OFFSCREEN, &d, (uint32_t)sizeof d); return d;
}
/* Renders the world and waits for the result. FW_ERROR_WRONG_BACKEND: cpu backend or host device. [world] */
FW_API FwResult FW_CALL fwWorld_RenderOffscreen(FwWorld*, const FwOffscreenDef* def);

/* ---- events and queries --------------------------------------------------------------------------------------- */

typedef enum FwEventType {
    FW_EVENT_IGNITED = 1,       /* the object's first texel burns; value: s since world start */
    FW_EVENT_BURNT_OUT = 2,     /* no texel burns or is about to burn, and the last flames used up their fuel;
                                   value: burnt fraction */
    FW_EVENT_EXTINGUISHED = 3,  /* no texel burns or is about to burn, but the last flames went out with fuel left;
                                   tag: FwExtinguishCause; value: burnt fraction */
    FW_EVENT_TAG_REACHED = 4,   /* the front reached a tagged point; tag: the host's; value: s since world start */
    FW_EVENT_FRONT_LIMITED = 5, /* many arrivals are late: the front is faster than 8 substeps can follow; value: their number
                                   since the last such event */
    FW_EVENT_TIME_DROPPED = 6,  /* more steps were due than maxStepsPerFrame; value: s dropped */
    FW_EVENT_SPREAD_TO = 7,     /* `other` ignited `object`; tag: jumps since the first fire; position: middle of `object`'s box;
                                   value: s since world start */
    FW_EVENT_SPOT_FIRE = 8,     /* an ember ignited `object`; position: there; value: embers since the last such event */
    FW_EVENT_WENT_LIVE = 9,     /* the baked burn of `object` ended or was disturbed: from now on the object is simulated;
                                   value: s since world start */
    FW_EVENT_FLASHED_OVER = 10, /* a room flashed over, see FwRoomDef; tag: index1 of its FwRoomId; object: null;
                                   position: its middle; value: s since world start */
    FW_EVENT_STRUCTURE_BROKE = 11, /* for objects with breakShare or breakArea: the host may break `object`;
                                   tag: FwBreakKind; value: m^2 of affected surface */
    FW_EVENT_TYPE_FORCE32 = 0x7fffffff
} FwEventType;
typedef enum FwExtinguishCause {
    FW_EXTINGUISHED_BY_WATER = 1, /* FW_WET, or a field with FW_FIELD_WETS */
    FW_EXTINGUISHED_BY_CALL = 2,  /* FW_EXTINGUISH */
    FW_EXTINGUISHED_BY_AIR = 3,   /* its room had too little oxygen */
    FW_EXTINGUISHED_BY_COLD = 4,  /* it lost more heat than its flames returned, as a lone plank does */
    FW_EXTINGUISH_CAUSE_FORCE32 = 0x7fffffff
} FwExtinguishCause;
typedef enum FwBreakKind {
    FW_BREAK_PART = 1,          /* a piece lost its connection to all supports; position: middle of the piece */
    FW_BREAK_SHARE = 2,         /* the share breakShare is gone; position: middle of the object's box */
    FW_BREAK_KIND_FORCE32 = 0x7fffffff
} FwBreakKind;
typedef struct FwEvent {        /* frozen, 64 bytes */
    uint32_t type, tag;         /* FwEventType; tag: as the type says */
    uint64_t userData;          /* that of the object */
    FwBurnableMeshId object;
    uint64_t frameIndex;        /* frame whose work raised it */
    float position[3], value;   /* m, world; value: as the type says. `position` follows the object's pose at the time of the
                                   report: on a device up to 3 frames after `frameIndex` */
    FwBurnableMeshId other;     /* FW_EVENT_SPREAD_TO: the object that ignited it; otherwise null */
    uint64_t reserved;
} FwEvent;
/* Writes events, oldest first, and returns how many; 0: none left. Each event is written once: poll from one place. At most
 * 4096 events wait; if more come, the oldest are dropped and the log counts them. Waits for no step and no recording. [any] */
FW_API uint32_t FW_CALL fwWorld_PollEvents(FwWorld*, FwEvent* events, uint32_t capacity);
/* Raises FW_EVENT_TAG_REACHED once when the texel nearest to `position` (m, [-1e6, 1e6], world) burns. At most 4096 points of a
 * world may wait. [world] */
FW_API FwResult FW_CALL fwWorld_TagPoint(FwWorld*, FwBurnableMeshId id, const float position[3], uint32_t tag);
/* Cancels all points of the object with this tag that the front has not reached. FW_OK if there are none. [world] */
FW_API FwResult FW_CALL fwWorld_UntagPoint(FwWorld*, FwBurnableMeshId id, uint32_t tag);

typedef struct FwObjectState { /* state at `frameIndex`: 2 to 3 frames ago on a device, now on the cpu backend */
    uint32_t structSize, reserved;
    uint64_t frameIndex;
    uint32_t texels;           /* texels that can burn */
    uint32_t ignited;          /* texels that burn or have burnt out; its maximum so far. A texel that goes out in the step of its
                                  ignition does not count */
    uint32_t burning;          /* texels that flame now */
    uint32_t frontTiles;       /* tiles in which the front can still move */
    float burntFraction;       /* [0, 1]. ignited / texels */
    float burningArea;         /* m^2 */
    float power;               /* W at pace 1 */
    float reserved1;
    double energy;             /* J that its fuel gave off */
    uint32_t refinedTriangles; /* at the last draw, if it refines and has ignited; see FwWorldStats */
    uint32_t playsBakedBurn;            /* 1: it plays a baked burn (fwWorld_PlayBurn); 0: it is simulated */
} FwObjectState;
FW_API FwResult FW_CALL fwWorld_GetObjectState(FwWorld*, FwBurnableMeshId id, FwObjectState* state); /* [world] */
/* Reads the state that the last fwWorld_Step or fwWorld_RecordOutside left, without waiting for one that runs. The first
 * fwWorld_Read... call on a world starts this copying. Copying costs each frame about 0.1 us for each object that ever burnt,
 * and 2 ns for each other object. FW_NOT_READY: no frame has copied the object yet. FW_ERROR_STALE_ID: the object was
 * destroyed by that frame. [any] */
FW_API FwResult FW_CALL fwWorld_ReadObjectState(FwWorld*, FwBurnableMeshId id, FwObjectState* state);

typedef enum FwPointStateKind {
    FW_POINT_UNBURNT = 0, FW_POINT_BURNING = 1, FW_POINT_BURNT = 2, FW_POINT_WET = 3,
    FW_POINT_EXTINGUISHED = 4, FW_POINT_INERT = 5, FW_POINT_STATE_KIND_FORCE32 = 0x7fffffff
} FwPointStateKind;
typedef struct FwPointState {
    uint32_t structSize;
    uint32_t kind;             /* FwPointStateKind */
    uint64_t frameIndex;       /* frame of this state */
    float age;                 /* s since its ignition; below 0: not ignited */
    float distance;            /* m from the requested point to the texel */
    float position[3];         /* m, world. Of the texel */
    float reserved;
    float temperature;         /* K of the surface; 0: unknown (FW_BURNABLE_LITE) */
    float fuel;                /* share, [0, 1]. Remaining fuel */
    float charred;             /* [0, 1], cosmetic. From scorched to burnt */
    float water;               /* g/m^2 on the surface */
} FwPointState;
/* Requests the state of the texel nearest to `position` (m, [-1e6, 1e6], world). The answer arrives with the readback of a
 * later frame (at once on the cpu backend) and stays until it is fetched or cancelled. At most 1024 queries may be open.
 * Destroying the object ends its queries; their ids become stale. [world] */
FW_API FwResult FW_CALL fwWorld_RequestPoint(FwWorld*, FwBurnableMeshId id, const float position[3], FwQueryId* query);
/* Writes the answer and frees the query. FW_NOT_READY: it has not arrived yet. [world] */
FW_API FwResult FW_CALL fwWorld_FetchPoint(FwWorld*, FwQueryId query, FwPointState* state);

/* Ends a query of fwWorld_RequestPoint or fwWorld_RequestArrival. Its id becomes stale. [world] */
FW_API FwResult FW_CALL fwWorld_CancelQuery(FwWorld*, FwQueryId query);

typedef enum FwArrivalKind {
    FW_ARRIVAL_AHEAD = 0,      /* fire will arrive */
    FW_ARRIVAL_PAST = 1,       /* the texel burns or has burnt */
    FW_ARRIVAL_NEVER = 2,      /* fire will not arrive under present conditions */
    FW_ARRIVAL_KIND_FORCE32 = 0x7fffffff
} FwArrivalKind;
typedef struct FwArrivalState {
    uint32_t structSize;
    uint32_t kind;             /* FwArrivalKind */
    uint64_t frameIndex;       /* the prediction starts from the state after this frame */
    float seconds;             /* s from the world's present to the ignition; PAST: 0 or less; NEVER: FLT_MAX */
    float distance;            /* m from the requested point to the texel */
    float position[3];         /* m, world. Of the texel */
    float reserved;
} FwArrivalState;
/* Predicts when the object's own fire reaches the texel nearest to `position` (m, [-1e6, 1e6], world). Conditions are those of
 * the call and stay: the present fire, water, wind, pose and air of the room (if nothing burns in that air: never). It ignores
 * other objects, gusts, drying water and limits on burning tiles. Exact for a fire left alone; after a change of fire, water,
 * wind, pose or air, request again. The library runs the front ahead, at most FwWorldDef::arrivalTiles tiles a frame, once
 * for all queries on an object. Near points are answered first; on a device the first frames wait for the readback of the
 * state. Counts towards the 1024 open queries. An object's first query allocates about 5 bytes a texel. [world] */
FW_API FwResult FW_CALL fwWorld_RequestArrival(FwWorld*, FwBurnableMeshId id, const float position[3], FwQueryId* query);
/* Writes the answer and frees the query. FW_NOT_READY: it has not arrived yet. [world] */
FW_API FwResult FW_CALL fwWorld_FetchArrival(FwWorld*, FwQueryId query, FwArrivalState* state);

/* ---- saves: a burning world as bytes ----------------------------------------------------------------------- */

/* Takes a snapshot at the end of the next frame (deltaTime may be 0). On a device its bytes arrive some frames later, and no
 * frame waits for them. One save at a time: a second request restarts it.
 * The save contains: state, temperature, fuel and water of every texel; counters, clocks, wind, flags and wind filters;
 * transforms of objects and occluder boxes; waiting events, tags, contacts; jet streams in flight; pending ignitions of fires
 * and jets; cells of fields that wet; points of volumetric fires; answers of FwWorldDef::visibility; reported breaks. It also
 * contains all events up to that frame's that were not polled before it, including those that a device reports later. Events
 * of objects that are destroyed by then are left out.
 * It does not contain: cosmetic state (particles, flames, soot, moving sheets), queries, hidden flags, and objects of the host
 * (meshes, materials, burnable meshes).
 * The bytes are little-endian, versioned, checksummed and compressed. They are equal on every backend if polling was equal and
 * no object moved since (event positions are those of the poll). A loaded world continues like its original: state, events
 * and later saves are equal, except FwWorldStats::runTiles and flames, which count work. [world] */
FW_API FwResult FW_CALL fwWorld_RequestSave(FwWorld*);
/* Copies the save. If `buffer` is null, *size gets the size needed; otherwise *size is the capacity on entry and the bytes
 * written on return. The library keeps the save until the next fwWorld_RequestSave. Write it to a new file, then rename that
 * over the old one, so that a crash keeps the old file intact. FW_NOT_READY: it has not arrived yet. [world] */
FW_API FwResult FW_CALL fwWorld_FetchSave(FwWorld*, void* buffer, uint64_t* size);
/* Cancels a requested save, or frees a finished one. FW_OK if there is none. [world] */
FW_API FwResult FW_CALL fwWorld_CancelSave(FwWorld*);
/* Restores a saved world, on any backend. From then on both worlds burn bit-identically at any frame rate, if they get the
 * same calls. The world must hold the same things, created in the same order, so that index1 of all ids is equal: burnable
 * meshes with equal meshes, materials and defs (compared by hash), occluder boxes, wind zones, rooms, fires, emitters and
 * fields. Its FwWorldDef has the same paceFactor, up, seed and spread limits.
 * Everything returns to its saved place and state, unburnt objects included; ids stay valid. The first frame shows flames and
 * particles as if they had burnt for long. Unpolled events are those of the save, as of the frame before the next one: a host
 * that recorded what it had polled by the save's frame gets each event once. Open queries restart. Time is that of the save;
 * frame indices keep growing. The state is uploaded with the next frame.
 * FW_ERROR_BAD_DATA: the bytes are damaged, incomplete, or of another version or world; nothing changed, and the message
 * names the difference with both values. [world] */
FW_API FwResult FW_CALL fwWorld_Load(FwWorld*, const void* bytes, uint64_t size);

/* ---- command log: replay of a burn ---------------------------------------------------------------------------- */

/* Starts to record the commands that change the burn, each with the tick that it preceded. A save and the command log after it
 * reproduce any later time bit by bit, on any backend, at any frame rate. Load the save, open the log, then
 *     while (fwWorld_PlayCommandLog(world, untilTick, &seconds) == FW_OK && seconds > 0) fwWorld_Step(world, seconds);
 * The log contains the calls that a network sends by itself (see fwNet_Serve). The host repeats all else at its time:
 * creation, destruction, colliders, points of fires, painted fields, vertices. A call takes 20 to 60 bytes. Drops an earlier
 * recording. [world] */
FW_API FwResult FW_CALL fwWorld_StartCommandLog(FwWorld*);
/* Stops recording and drops the recorded commands. [world] */
FW_API FwResult FW_CALL fwWorld_StopCommandLog(FwWorld*);
/* Copies the recorded commands: little-endian, versioned, checksummed. Recording continues. If `buffer` is null, *size gets
 * the size needed; otherwise *size is the capacity on entry and the bytes written on return.
 * FW_ERROR_INVALID_ARGUMENT: nothing is being recorded. FW_ERROR_OUT_OF_MEMORY: memory ran out while recording. [world] */
FW_API FwResult FW_CALL fwWorld_FetchCommandLog(FwWorld*, void* buffer, uint64_t* size);
/* Opens a command log for replay, in place of an open one; size 0 closes it. FW_ERROR_BAD_DATA: the bytes are damaged,
 * incomplete, of another version, or of a world that holds other things; nothing changed. [world] */
FW_API FwResult FW_CALL fwWorld_OpenCommandLog(FwWorld*, const void* bytes, uint64_t size);
/* Applies the logged commands that precede the world's next step. *seconds gets the time to advance before the next call: to
 * the next command, or to the last whole step (1/32 s) at or before untilTick (see FwWorldStats::tick). It is never more than
 * one frame may advance. 0: the world is there. Skips commands before the world's present and those that the loaded save already
 * contains. Skips commands that the world refuses; the log has a warning.
 * FW_ERROR_INVALID_ARGUMENT: no log is open, or the world follows a server. [world] */
FW_API FwResult FW_CALL fwWorld_PlayCommandLog(FwWorld*, uint64_t untilTick, float* seconds);

/* ---- timeline: back and forth in a burn ------------------------------------------------------------------------ */

/* The world keeps keyframes (saves of itself, some time apart) and the commands since the first of them. It can return to any
 * time in between, bit by bit. For scrubbing, replays, kill cams and undo. Baked burns are included. */
typedef struct FwTimelineDef {
    uint32_t structSize;
    float interval;            /* s of world time, [1/32, 3600], default 2. Distance between keyframes */
    float maxInterval;             /* s, [interval, 3600], default 32. Largest distance to which they may be thinned out to fit */
    uint32_t reserved;         /* 0 */
    uint64_t bytes;            /* bytes, [65536, 2^64), default 67108864. Limit for keyframes and commands. Beyond it every second
                                  keyframe goes, as far as `maxInterval` allows; then the oldest, and with it the start of the
                                  timeline. The newest keyframe and the commands after it stay, whatever their size */
} FwTimelineDef;
static inline FwTimelineDef fwDefaultTimelineDef(void) {
    FwTimelineDef d; fwInitDef(FW_DEF_TIMELINE, &d, (uint32_t)sizeof d); return d;
}
/* Starts a timeline at the state after the next frame; drops an earlier one. A keyframe costs its frame as much as
 * fwWorld_RequestSave. fwWorld_Load restarts the timeline. [world] */
FW_API FwResult FW_CALL fwWorld_StartTimeline(FwWorld*, const FwTimelineDef* def);
FW_API FwResult FW_CALL fwWorld_StopTimeline(FwWorld*); /* the world stays as it is [world] */
/* Moves one part of the way to the last whole step (1/32 s) at or before untilTick (see FwWorldStats::tick), back or forth:
 *     while (fwWorld_Seek(world, untilTick, &seconds) == FW_OK && seconds > 0) fwWorld_Step(world, seconds);
 * or with one recorded frame for each. *seconds gets the time to advance before the next call; 0: the world is there. A jump
 * loads the nearest keyframe, as fwWorld_Load does: waiting events are those of the keyframe, and cosmetic state restarts.
 * Then the library applies the commands after it. Where it stops in the past, commands of that very tick are not applied yet.
 * Rising values of untilTick play the past again; events are raised again. If the host advances the world without Seek, or
 * changes the burn, another future begins and the timeline forgets what came after.
 * FW_ERROR_INVALID_ARGUMENT: there is no timeline, it lacks that time (see FwTimelineState), or the world follows a server.
 * FW_NOT_READY: its first keyframe has not arrived. FW_ERROR_BAD_DATA: the host created or destroyed something since, which a
 * timeline does not contain; start another one. [world] */
FW_API FwResult FW_CALL fwWorld_Seek(FwWorld*, uint64_t untilTick, float* seconds);
typedef struct FwTimelineState {
    uint32_t structSize;
    uint32_t keyframes;          /* keyframes; 0: the first has not arrived, or there is no timeline */
    uint64_t firstTick, endTick; /* ticks (2^-12 s). Range of fwWorld_Seek */
    uint64_t bytes;            /* bytes of keyframes and commands */
    float interval;            /* s. Present distance between keyframes */
    uint32_t reserved;
} FwTimelineState;
FW_API FwResult FW_CALL fwWorld_GetTimelineState(FwWorld*, FwTimelineState* state); /* [world] */

/* ---- baked burns: recorded fire that goes live when disturbed ------------------------------------------------- */

/* Requests the ignition time of each texel of an object, after the next frame. On a device it arrives some frames later, like
 * a save. Unburnt and extinguished texels are left out. [world] */
FW_API FwResult FW_CALL fwWorld_RequestBurn(FwWorld*, FwBurnableMeshId id);
/* Copies the burn as a .fwburn file: little-endian, versioned, checksummed, compressed. Times count from its first ignition.
 * If `buffer` is null, *size gets the size needed; otherwise *size is the capacity on entry and the bytes written on return.
 * FW_NOT_READY: it has not arrived yet. FW_ERROR_INVALID_ARGUMENT: nothing has burnt. [world] */
FW_API FwResult FW_CALL fwWorld_FetchBurn(FwWorld*, FwBurnableMeshId id, void* buffer, uint64_t* size);
/* Cancels fwWorld_RequestBurn, or frees its result. FW_OK if there is none. [world] */
FW_API FwResult FW_CALL fwWorld_CancelBurn(FwWorld*, FwBurnableMeshId id);
/* Creates a baked burn from bytes of fwWorld_FetchBurn, of this world or another one. Any number of objects may play it. Takes
 * 8 bytes a texel. FW_ERROR_BAD_DATA: the bytes are damaged, incomplete or of another version. [world] */
FW_API FwResult FW_CALL fwWorld_CreateBurn(FwWorld*, const void* bytes, uint64_t size, FwBurnId* id);
FW_API FwResult FW_CALL fwWorld_DestroyBurn(FwWorld*, FwBurnId id); /* refused while an object plays it [world] */
/* Plays a baked burn on an object, from the next step on, in place of one that it plays. Its first texel ignites after
 * `delay` (s, [0, 3600], at least one step), the others at `speed` times their recorded pace (factor, [1/16, 16]). Meant for
 * unburnt objects; texels that burn already continue. The object simulates no front. Fuel, heat, char, flames, lights, heat
 * to others, events, queries and saves work as usual, and fwWorld_RequestArrival answers from the burn.
 * The object goes live (FW_EVENT_WENT_LIVE) within two steps after a disturbance: its front is simulated from its present
 * state. Disturbances: the host or another object ignites, heats, wets, dries or extinguishes a texel; fire of others sends it
 * 4 kW/m^2 (see FW_WORLD_RADIATION), too little to ignite wood; its wind or pose changes enough to change its front;
 * fwWorld_StopBurn; the last texel of the burn ignites.
 * The result is the same on every backend and in command logs, networks and saves, which name burns by id and hash: create
 * them in the same order. FW_ERROR_INVALID_ARGUMENT: the burn is of another mesh or shape (by hash). [world] */
FW_API FwResult FW_CALL fwWorld_PlayBurn(FwWorld*, FwBurnableMeshId id, FwBurnId burn, float delay, float speed);
/* Makes an object that plays a burn go live. Otherwise does nothing. [world] */
FW_API FwResult FW_CALL fwWorld_StopBurn(FwWorld*, FwBurnableMeshId id);

/* ---- network: one burn on many machines -------------------------------------------------------------------- */

/* The server's world is authoritative. Clients hold worlds of the same things in the same order (see fwWorld_Load). They get
 * the server's state once, then each command of its host with the step that it precedes. Fire is integers, so all worlds burn
 * bit-identically. Hashes of each object, every few seconds, verify it: a client that differs gets the tiles that differ, or
 * the whole state. The host transports the packets, by any means: they may be lost, repeated, late and out of order. A packet
 * that is damaged, incomplete, or of another session or version is refused with a message and changes nothing. The checksum
 * detects damage, not attacks: encrypt where attacks are possible. No call waits.
 *
 * Sent automatically: fwWorld_Ignite, fwWorld_PlayBurn, fwWorld_StopBurn, fwWorld_TransferBurn, fwWorld_SetWind,
 * fwWorld_SetWindGrid, fwWorld_SetGusts, fwWorld_SetWindZone, fwWorld_SetRoom, fwWorld_SetFlags, fwWorld_SetTransform,
 * fwWorld_MoveHeatOccluder, fwWorld_SetHeatOcclusion and fwWorld_ShiftOrigin; position and power of volumetric fires with
 * FW_FIRE_IGNITES and of jets with FW_EMITTER_IGNITES; position and amount of fields with FW_FIELD_WETS. A client refuses
 * these calls, and fwWorld_Load. Each host repeats all else that changes the burn at the same step, when a message of
 * fwNet_SendMessage says so: creation, destruction, colliders, points of fires, painted fields, vertices. */
typedef struct FwNetDef {
    uint32_t structSize, flags; /* flags: 0 */
    uint32_t token;             /* [1, 2^32). A random number of the host, new each time: of the session, or of this client.
                                   Packets with another token are refused */
    uint32_t packetBytes;       /* bytes, [512, 1400], default 1200. Largest packet */
    uint32_t bytesPerSecond;    /* bytes/s, [4000, 100000000], default 262144. Server: most that it sends to each client; the
                                   capacity of a connection. A client that falls too far behind gets the whole state: see
                                   FwNetState::overloaded */
    float interval;             /* s, [1/64, 1], default 1/16. Time between packets; more are sent if there is more to send */
    float delay;                /* s, [0, 10], default 0.15. Client: how far it stays behind the newest known step. If it is below
                                   the latency of packets (or twice that after a loss), fire stutters */
    uint32_t reserved;          /* 0 */
} FwNetDef;
static inline FwNetDef fwDefaultNetDef(void) {
    FwNetDef d; fwInitDef(FW_DEF_NET, &d, (uint32_t)sizeof d); return d;
}
/* Makes the world a server, on any backend. FW_ERROR_INVALID_ARGUMENT: it is a server or a client already. [world] */
FW_API FwResult FW_CALL fwNet_Serve(FwWorld*, const FwNetDef* def);
/* Makes the world a client, on any backend. It starts with the server's state and advances no further than fwNet_NextAction says.
 * FW_ERROR_INVALID_ARGUMENT: it is a server or a client already. [world] */
FW_API FwResult FW_CALL fwNet_Join(FwWorld*, const FwNetDef* def);
/* Ends the role of server or client. The world stays as it is. [world] */
FW_API FwResult FW_CALL fwNet_Leave(FwWorld*);
/* Server: adds a peer from which packets come, at most 256 at a time. A client that returns with another token is another peer.
 * FwNetState::silent tells how long a peer has been silent; the host removes it. [world] */
FW_API FwResult FW_CALL fwNet_AddPeer(FwWorld*, FwPeerId* id);
FW_API FwResult FW_CALL fwNet_RemovePeer(FwWorld*, FwPeerId id); /* [world] */
/* Advances network time by deltaTime: s of real time, [0, 10]. Call it once in each frame of the host, after its steps.
 * [world] */
FW_API FwResult FW_CALL fwNet_Update(FwWorld*, float deltaTime);
/* Writes the next packet for a peer; on a client, for the server, with a null id. *size is the capacity on entry
 * (FwNetDef::packetBytes) and the bytes written on return. FW_NOT_READY: none before the next fwNet_Update. [world] */
FW_API FwResult FW_CALL fwNet_Write(FwWorld*, FwPeerId to, void* packet, uint32_t* size);
/* Reads a packet that arrived. A server reads at most 512 packets a second of one peer.
 * FW_ERROR_BAD_DATA, FW_ERROR_VERSION: the packet is damaged, of another session, or contains a number that contradicts what
 * this side has sent. It changes nothing, and FwNetState::packetsRefused counts it. The log of a server names the 1st, 2nd,
 * 4th, 8th... of each peer. [world] */
FW_API FwResult FW_CALL fwNet_Read(FwWorld*, FwPeerId from, const void* packet, uint32_t size);
/* Server: sends a message of the host to all clients. size: bytes, [0, 1024], and at most FwNetDef::packetBytes - 64. Each
 * client gets it between the same commands and before the same step, in order and without gaps. A client that gets the whole
 * state gets the messages that precede that state right before it. Clients that join later do not get it: their host must learn
 * by other means what was created since. [world] */
FW_API FwResult FW_CALL fwNet_SendMessage(FwWorld*, const void* message, uint32_t size);

typedef enum FwNetActionKind {
    FW_NET_ACTION_WAIT = 0,    /* nothing more to do in this frame of the host */
    FW_NET_ACTION_STEP = 1,    /* advance the world by deltaTime, with fwWorld_Step or a recorded frame, then call again */
    FW_NET_ACTION_MESSAGE = 2, /* a message of the server's host: act on it now, then call again */
    FW_NET_ACTION_KIND_FORCE32 = 0x7fffffff
} FwNetActionKind;
typedef struct FwNetAction {
    uint32_t structSize;
    uint32_t kind;             /* FwNetActionKind */
    float deltaTime;           /* s. For FW_NET_ACTION_STEP */
    uint32_t messageSize;      /* bytes */
    unsigned char message[1024];
} FwNetAction;
/* Client: gets the next action. Call it in a loop after fwNet_Update until FW_NET_ACTION_WAIT. A host that records one frame
 * of the world in each of its own takes one step each; the rest waits and arrives a little faster.
 * FW_ERROR_VERSION: structSize is below sizeof(FwNetAction). [world] */
FW_API FwResult FW_CALL fwNet_NextAction(FwWorld*, FwNetAction* action);

typedef enum FwNetRole { FW_NET_NONE = 0, FW_NET_SERVER = 1, FW_NET_CLIENT = 2, FW_NET_ROLE_FORCE32 = 0x7fffffff } FwNetRole;
typedef enum FwNetPhase {
    FW_NET_CALLING = 0,   /* no reply yet */
    FW_NET_REFUSED = 1,   /* the server's world holds other things, as the log says; the client retries each second */
    FW_NET_LOADING = 2,   /* the state is being transferred */
    FW_NET_FOLLOWING = 3,
    FW_NET_PHASE_FORCE32 = 0x7fffffff
} FwNetPhase;
typedef struct FwNetState {
    uint32_t structSize;
    uint32_t role, phase;      /* FwNetRole; FwNetPhase of a client, or of a server's peer */
    uint32_t peers;
    uint64_t step;             /* steps (1/32 s). Present of this world */
    uint64_t newestKnownStep;        /* steps. Newest step of the other side that this side knows */
    float behind;              /* s. How far the client is behind that step */
    float silent;              /* s since the last packet arrived */
    uint32_t records;          /* waiting records: for acknowledgement on a server, for their step on a client */
    uint32_t states;           /* states received from the server; the first is the one with which a client joins */
    uint32_t desyncs;           /* client: how often it was found to differ */
    uint32_t repairs;          /* client: states of which only the tiles that differed were sent */
    uint64_t hashes;           /* client: hashes compared */
    uint64_t bytesOut, bytesIn, packetsOut, packetsIn; /* without overhead of the transport */
    uint64_t packetsIgnored;   /* repeated packets, much too late ones, and those beyond 512 a second from one peer */
    uint64_t packetsRefused;   /* damaged packets and those with impossible numbers; for a server's peer: those of this peer */
    uint64_t messagesLost;     /* server: messages that peers miss because more than 4 MB of them waited */
    uint32_t resyncs;          /* server: how often a peer fell so far behind that it needs the whole state */
    uint32_t overloaded;       /* server: peers whose rate cannot carry the changes; client: 1 if its server reports that */
    float changeRate;          /* bytes/s. Server: rate of the changes of the last seconds */
    float backlog;             /* s. Server: age of the oldest change that a peer has not received */
    float roundTrip;           /* s. Server's peer: from a packet to its acknowledgement; 0: unknown */
    uint32_t reserved;         /* 0 */
} FwNetState;
/* Gets the state of a client or server. Server: `peer` selects a peer; null sums over all of them. [world] */
FW_API FwResult FW_CALL fwNet_GetState(FwWorld*, FwPeerId peer, FwNetState* state);

/* ---- lights and surroundings --------------------------------------------------------------------------------- */

typedef struct FwLight {       /* frozen, 64 bytes. A ball of fire for the host's own lighting */
    float position[3];         /* m, world */
    float radius;              /* m. Of the source */
    float color[3];            /* linear, luminance 1 */
    float intensity;           /* W/sr of visible light. Relative radiant intensity */
    float power;               /* W. Whole heat release */
    float reserved[3];
    uint32_t id, reserved1;    /* id: stable while the same fire burns */
    uint64_t frameIndex;
} FwLight;
/* Writes the strongest fires, strongest first, and returns how many: at most FwWorldDef::maxLights. They shine for all others
 * too: the sums of power and intensity are those of all fires, whatever the number of lights. Lights of burning meshes are as
 * of the last readback. They change smoothly: a filter of 0.1 s, flicker of at most 7 % in 1/60 s. Volumetric fires are as of
 * the last frame, or as they are about to be; bit 31 of their ids is set. Bit 30 marks fire emitters. Each backend clusters
 * burning tiles in its own way: positions, radii, ids and shares of the power differ, their sum does not. [world] */
FW_API uint32_t FW_CALL fwWorld_GetLights(FwWorld*, FwLight* lights, uint32_t capacity);
/* Reads the lights that the last fwWorld_Step or fwWorld_RecordOutside left: see fwWorld_ReadObjectState. *count is the
 * capacity of `lights` on entry and the number written on return. FW_NOT_READY: no frame has copied them yet; *count is 0.
 * [any] */
FW_API FwResult FW_CALL fwWorld_ReadLights(FwWorld*, FwLight* lights, uint32_t* count);

/* Effect of fire at a point: for damage, and for what characters feel and see. From burning meshes (their lights), fire emitters
 * and volumetric fires at the last frame; cosmetic. Plumes follow McCaffrey and lean with the wind. Occluder boxes, colliders
 * and the heat-occlusion grid shade radiation (cells of a burnable mesh until half of it has burnt). */
typedef struct FwSurroundings {
    uint32_t structSize;
    float heatFlux;            /* W/m^2, at most 150000. On a small cold body, by radiation and hot gas */
    float temperature;         /* K of the air; 293 without fire */
    float smoke;               /* 1/m. exp(-smoke) of the light passes through a metre; 0: clear */
    float danger;              /* 0 or more. 0: none; 1: the tolerance of people: 2.5 kW/m^2, 60 C or smoke of 1 1/m */
    float nearest;             /* m to the edge of the nearest flame; FLT_MAX: no fire */
    float nearestPosition[3];  /* m, world. Foot of that fire */
    float nearestPower;        /* W */
    uint32_t nearestLight;     /* its FwLight::id, if it has a light of its own */
    uint32_t reserved;
} FwSurroundings;
/* Samples the effect of fire at a point (m, [-1e6, 1e6], world). Answers at once, on every backend; costs some tens of
 * nanoseconds a fire. heatFlux and danger sum over the lights of fwWorld_GetLights and differ between backends as these do.
 * [world] */
FW_API FwResult FW_CALL fwWorld_SampleSurroundings(FwWorld*, const float point[3], FwSurroundings* surroundings);
/* Gets the visibility of one point from the other through smoke: [0, 1]. Walls are up to the host. [world] */
FW_API FwResult FW_CALL fwWorld_SampleVisibility(FwWorld*, const float from[3], const float to[3], float* seen);
/* Writes danger at columns x rows points, one byte each, row after row, for path-finding: 127 is a danger of 1; at most 255.
 * `corner` (m, world, at head height) is the first point; `columnStep` and `rowStep` (m, [-1e4, 1e4]) lead to the others.
 * columns and rows: [1, 4096] each. [world] */
FW_API FwResult FW_CALL fwWorld_MakeSafetyMask(FwWorld*, const float corner[3], const float columnStep[3],
                                               const float rowStep[3], uint32_t columns, uint32_t rows, uint8_t* mask);

/* ---- statistics and budgets ---------------------------------------------------------------------------------- */

typedef struct FwWorldStats {
    uint32_t structSize, reserved;
    uint64_t steps, tick;          /* of the simulation; a tick is 2^-12 s */
    uint64_t readbackFrame;        /* newest frame whose readback has arrived */
    uint32_t objects, burningObjects, meshes, materials;
    uint32_t frontTiles, runTiles; /* tiles that wait; tiles that ran in the last step */
    uint32_t burningTiles;
    uint32_t flames;               /* quads of flames, smoke, particles and sparks in the last view, as of the last readback;
                                      0 on the cpu backend */
    uint32_t lateClamps, droppedSteps; /* late arrivals (FW_EVENT_FRONT_LIMITED); steps beyond maxStepsPerFrame */
    uint64_t texels;               /* of all objects' burn maps */
    uint32_t hotTiles;             /* tiles whose temperature or water changes */
    uint32_t refinedTriangles;     /* of refined objects that have ignited, at the last draw; without pieces along mesh-cut
                                      holes. See FwWorldDef::maxRefinedTriangles */
} FwWorldStats;
FW_API FwResult FW_CALL fwWorld_GetStats(FwWorld*, FwWorldStats* stats); /* [world] */

/* Energy of all burnable meshes of the world, exact: fuel = unburnt + radiated + convected, always. In units of 2^-20 J, which
 * the simulation counts. At `frameIndex`, as in FwObjectState. FW_BURNABLE_LITE: a texel's fuel counts as a whole once it has
 * burnt out (if put out earlier, all of it is unburnt). */
typedef struct FwEnergyLedger {
    uint32_t structSize;
    uint32_t objects;          /* objects that keep a ledger */
    uint64_t frameIndex;
    uint64_t fuel;             /* 2^-20 J. Fuel of these objects at their creation */
    uint64_t unburnt;          /* 2^-20 J. Fuel that is left */
    uint64_t radiated;         /* 2^-20 J. 33 % of the heat of flames: the part that may heat others */
    uint64_t convected;        /* 2^-20 J. The rest, in hot gas */
    float power;               /* W at pace 1. Present heat release */
    float burningArea;         /* m^2. Flaming surface of all objects */
} FwEnergyLedger;
FW_API FwResult FW_CALL fwWorld_GetEnergyLedger(FwWorld*, FwEnergyLedger* ledger); /* [world] */

/* Cost limits of a frame. While a frame costs more, detail falls in eight levels; it rises when there is budget again. A level
 * sets how many volumetric flames have rays of their own (the largest on the screen keep them), and with how many samples. It
 * also sets the target of refined triangles, the quads of flames and particles (fewer are larger) and the lights (fewer shine
 * for all). With a limit of bytes it sets the resolution of marched flames too. Fires are never deleted, and the burn is
 * bit-identical at every level. A new load settles within 60 frames; a single slow frame changes nothing. */
typedef struct FwBudgetDef {
    uint32_t structSize, reserved;  /* 0 */
    float gpuMilliseconds;     /* ms, [0, 1000], default 0: no limit. All that is recorded for a frame */
    float cpuMilliseconds;     /* ms, [0, 1000], default 0: no limit. fwWorld_RecordOutside, RecordInside and RecordComposite of a
                                  frame; on the cpu backend fwWorld_Step */
    float measuredMilliseconds;/* ms, [-1e5, 1e5], default -1. GPU time of the library in the last frame, as the host measured it.
                                  Below 0: the library's own time stamps. Needed if the queue family has none */
    uint32_t reserved1;        /* 0 */
    uint64_t bytes;            /* bytes, default 0: no limit. Device memory that follows detail: marched flames and quads. The
                                  library recreates buffers when the level changes. Authoritative state, meshes and their
                                  refinement do not count: see FwContextDef::gpuMemoryBudget */
} FwBudgetDef;
static inline FwBudgetDef fwDefaultBudgetDef(void) {
    FwBudgetDef d; fwInitDef(FW_DEF_BUDGET, &d, (uint32_t)sizeof d); return d;
}
/* Sets the limits, from the next frame on. Cheap enough for every frame. Without limits (the initial state) detail returns in
 * full. [world] */
FW_API FwResult FW_CALL fwWorld_SetBudget(FwWorld*, const FwBudgetDef* def);
typedef struct FwBudgetState {
    uint32_t structSize;
    uint32_t level, levels;    /* 0: full detail; levels - 1: the least */
    uint32_t marchedFires;     /* most volumetric flames with rays of their own */
    uint32_t rayStepCount;      /* most samples of a ray */
    uint32_t refinedTriangles; /* target of refined meshes */
    float gpuMilliseconds, cpuMilliseconds; /* ms a frame, smoothed; 0: unknown */
    float quads;               /* share, [0, 1]. Visible share of the quads of flames and particles */
    uint32_t lights;           /* most lights; between half of FwWorldDef::maxLights and all of it */
    uint64_t bytes;            /* bytes that FwBudgetDef::bytes limits; 0 on the cpu backend */
} FwBudgetState;
FW_API FwResult FW_CALL fwWorld_GetBudgetState(FwWorld*, FwBudgetState* state); /* [world] */

#ifdef __cplusplus
} /* extern "C" */
static_assert(sizeof(FwErrorInfo) == 512 && sizeof(FwEvent) == 64 && sizeof(FwLight) == 64,
              "frozen sizes");
#endif
#endif
