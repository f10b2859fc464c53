/* flamewright/flamewright.h: the stable C ABI. C11 and C++20; no Vulkan and no C++ in here.
 *
 * Units: second, kilogram, kelvin, degree Celsius only where a name says so. Lengths and speeds (m and m/s in comments) are
 * in the world's unit, metres by default: see FwWorldDef::metersPerUnit. Their limits and defaults are given in metres here,
 * in errors in that unit. All other numbers (m^2, m^3, 1/m, W/m^2, kg/m^3, N), and all of FwMaterialDef, are SI in every world.
 * Matrices: column-major, column vectors, not jittered. Colour: linear Rec.709, scene-referred.
 * Thread tags: [any] any thread; [world] one thread at a time per world; [record] as [world], and
 * the caller owns the command buffer. Callbacks may come from any thread and must not call back in.
 * Everything behind a pointer is copied before a call returns. Output goes to the caller's memory.
 * A negative result failed and changed nothing; fw*_GetLastMessage and the log say why.
 * Reserved fields are zero. Ids are null when zero. See plugin/docs for the host's checklist. */
/* Laid out by hand, to be read. */
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
#ifndef FW_API /* the build sets the export attribute; hosts need nothing */
#define FW_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define FW_ABI_VERSION 1u /* grows only when an old host can no longer work */
#define FW_VERSION_MAJOR 0u
#define FW_VERSION_MINOR 1u
#define FW_VERSION_PATCH 0u

/* ---- objects and ids --------------------------------------------------------------------- */

typedef struct FwContext FwContext; /* few, heavy, owned by the host: opaque pointers */
typedef struct FwWorld FwWorld;
struct FwVulkanHost; /* flamewright_vulkan.h */

/* many: generational ids by value; all-zero is null */
typedef struct FwMaterialId { uint32_t index1, generation; } FwMaterialId;
typedef struct FwImageId { uint32_t index1, generation; } FwImageId;
typedef struct FwMeshId { uint32_t index1, generation; } FwMeshId;
typedef struct FwBurnableMeshId { uint32_t index1, generation; } FwBurnableMeshId;
typedef struct FwTargetId { uint32_t index1, generation; } FwTargetId;
typedef struct FwQueryId { uint32_t index1, generation; } FwQueryId;
typedef struct FwBlockerId { uint32_t index1, generation; } FwBlockerId;
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
    FW_NOTHING_THERE = 2, /* the call is right and changes nothing: no texel is there for it */
    FW_NOT_READY = 1, /* pipelines or readback still on their way; nothing was recorded */
    FW_OK = 0,
    FW_ERROR_INVALID_ARGUMENT = -1,
    FW_ERROR_STALE_ID = -2,
    FW_ERROR_VERSION = -3, /* structSize or abiVersion that this library cannot serve */
    FW_ERROR_OUT_OF_MEMORY = -4,
    FW_ERROR_UNSUPPORTED_DEVICE = -5,
    FW_ERROR_DEVICE_LOST = -6,
    FW_ERROR_BAD_DATA = -7, /* a mesh or cooked file that cannot be used */
    FW_ERROR_WRONG_BACKEND = -8, /* the call needs another backend */
    FW_ERROR_INTERNAL = -9,
    FW_RESULT_FORCE32 = 0x7fffffff
} FwResult;

typedef struct FwErrorInfo { int32_t result; char message[508]; } FwErrorInfo; /* the caller's */

typedef enum FwLogLevel {
    FW_LOG_DEBUG = 0, FW_LOG_INFO = 1, FW_LOG_WARNING = 2, FW_LOG_ERROR = 3,
    FW_LOG_LEVEL_FORCE32 = 0x7fffffff
} FwLogLevel;

/* Frozen. Copied at context creation; null members take the library's own. `allocate` returns null
 * when there is no memory; `release` gets back what allocate was asked for. */
typedef struct FwCallbacks {
    void* userData;
    void (FW_CALL* log)(void* userData, int32_t level, const char* message);
    void* (FW_CALL* allocate)(void* userData, size_t size, size_t alignment);
    void (FW_CALL* release)(void* userData, void* memory, size_t size, size_t alignment);
} FwCallbacks;

/* Static text for a result, never null. [any] */
FW_API const char* FW_CALL fwResultName(int32_t result);
/* major << 22 | minor << 12 | patch of the library in use. [any] */
FW_API uint32_t FW_CALL fwGetVersion(void);

/* ---- defs ------------------------------------------------------------------------------------ */
/* Take a def from its fwDefault...() and change what you need. structSize is the host's sizeof; a
 * newer library gives fields it does not find their default, a newer host gets FW_ERROR_VERSION if
 * bytes that the library does not know are not zero. */

typedef enum FwDefType {
    FW_DEF_CONTEXT = 1, FW_DEF_WORLD = 2, FW_DEF_MATERIAL = 3, FW_DEF_IMAGE = 4, FW_DEF_MESH = 5,
    FW_DEF_BURNABLE_MESH = 6, FW_DEF_IGNITION = 7, FW_DEF_VIEW = 8, FW_DEF_OFFSCREEN = 9,
    FW_DEF_BLOCKER = 10, FW_DEF_VOLUMETRIC_FIRE = 11, FW_DEF_FIRE_PROFILE = 12, FW_DEF_FIRE_COLLIDER = 13,
    FW_DEF_FIRE_TRACK = 14, FW_DEF_PARTICLE_FIELD = 15, FW_DEF_FIRE_EMITTER = 20,
    FW_DEF_FLIPBOOK = 21, FW_DEF_BUDGET = 22, FW_DEF_NET = 23, FW_DEF_WIND_ZONE = 24, FW_DEF_ROOM = 25,
    FW_DEF_WIND_GRID = 26, FW_DEF_GUSTS = 27, FW_DEF_TIMELINE = 28,
    FW_DEF_HEAT_SHIELD = 29,
    FW_DEF_VULKAN_HOST = 100, FW_DEF_VULKAN_TARGET = 101, FW_DEF_VULKAN_FRAME = 102,
    FW_DEF_VULKAN_WISHES = 103, FW_DEF_VULKAN_COMPOSITE = 104, FW_DEF_VULKAN_VERTICES = 105,
    FW_DEF_TYPE_FORCE32 = 0x7fffffff
} FwDefType;
/* Writes defaults for the first structSize bytes, and zero for what this library does not know;
 * never a byte past structSize. Unknown types are zeroed but for structSize. [any] */
FW_API void FW_CALL fwInitDef(uint32_t defType, void* def, uint32_t structSize);

/* ---- context --------------------------------------------------------------------------------- */

typedef enum FwBackend {
    FW_BACKEND_VULKAN = 0, /* the device in FwContextDef::vulkan, or our own if that is null */
    FW_BACKEND_CPU = 1,    /* simulation only, no device: servers, tools, tests */
    FW_BACKEND_FORCE32 = 0x7fffffff
} FwBackend;

typedef struct FwContextDef {
    uint32_t structSize, abiVersion; /* set for you */
    uint32_t backend;                /* FwBackend, default FW_BACKEND_VULKAN */
    uint32_t flags;                  /* 0 */
    FwCallbacks callbacks;
    const struct FwVulkanHost* vulkan; /* null: the library makes its own instance and device */
    uint64_t gpuMemoryBudget;          /* bytes; 0: no cap. Creation fails beyond it. */
} FwContextDef;
static inline FwContextDef fwDefaultContextDef(void) {
    FwContextDef d; fwInitDef(FW_DEF_CONTEXT, &d, (uint32_t)sizeof d);
    d.abiVersion = FW_ABI_VERSION; return d;
}
/* On failure *context is null and *error (may be null) says why. [any] */
FW_API FwResult FW_CALL fwCreateContext(const FwContextDef* def, FwContext** context, FwErrorInfo* error);
/* Frees everything of it, worlds included, even after a lost device. The host has waited for its
 * last frame. Null is fine. [any, nothing else may use the context] */
FW_API void FW_CALL fwDestroyContext(FwContext* context);

typedef struct FwContextInfo {
    uint32_t structSize;
    uint32_t backend;                 /* FwBackend in use */
    uint32_t apiVersion;              /* Vulkan version declared by the host; 0 on the cpu backend */
    uint32_t ownDevice;               /* 1: we made the device */
    uint32_t gpuTimers;               /* 1: pass timers are available */
    uint32_t debugLabels;             /* 1: debug-utils labels and names are in use */
    uint64_t gpuMemoryUsed, gpuMemoryBudget; /* bytes */
    uint64_t cpuMemoryUsed;           /* bytes alive through the allocator */
    char deviceName[256];
} FwContextInfo;
/* Fills up to info->structSize bytes. [any] */
FW_API FwResult FW_CALL fwContext_GetInfo(FwContext* context, FwContextInfo* info);
/* Text of the last failure on this context; returns the length needed without the zero. [any] */
FW_API size_t FW_CALL fwContext_GetLastMessage(FwContext* context, char* text, size_t capacity);
/* Builds whatever pipelines are missing, may take long: a loading screen or a worker thread.
 * FW_OK when all is ready. Calling it is optional only on an own device. [any] */
FW_API FwResult FW_CALL fwContext_Prepare(FwContext* context);

typedef struct FwMemoryRow {  /* memory of one component, buffer or pool */
    char name[48];            /* unique in a report */
    uint64_t bytes, capacity; /* in use, and reserved for it */
} FwMemoryRow;
/* Writes at most capacity rows, returns how many there are. On the Vulkan backend a row for each
 * component comes first ("meshes" to "targets"), whatever the number of worlds. Row "blocks" follows:
 * `bytes` is the sum of the components, `capacity` is FwContextInfo::gpuMemoryUsed. Then a row for
 * each buffer of the worlds, summed over them; the components hold these bytes already.
 * On the cpu backend the rows of its pools ("cpu texel states", ...) come instead of all these. On both, rows
 * "world objects" to "world contacts" follow: memory of the CPU, of all worlds.
 * Waits for no step and no recording. [any] */
FW_API uint32_t FW_CALL fwContext_GetMemoryReport(FwContext* context, FwMemoryRow* rows, uint32_t capacity);

/* ---- world ------------------------------------------------------------------------------------- */

typedef enum FwWorldFlags { /* how fire reaches other objects; none of them: it does not */
    FW_WORLD_RADIATION = 1, /* flames heat what they shine on until it catches */
    FW_WORLD_PLUME = 2,     /* hot gas heats what is above */
    FW_WORLD_CONTACT = 4,   /* flames lick across gaps of up to 5 cm: to other objects, and from part to part of
                               a mesh whose parts share no edge (a roof on its walls, a cart's wheels) */
    FW_WORLD_EMBERS = 8,    /* burning bits fly downwind and may light what they land on */
    /* For every object that is created while they are set, as if it had the flag of that name. */
    FW_WORLD_NO_SPREAD = 16,
    FW_WORLD_NO_DAMAGE = 32,
    FW_WORLD_NO_HOLES = 64,
    FW_WORLD_FLAGS_FORCE32 = 0x7fffffff
} FwWorldFlags;

typedef struct FwWorldDef {
    uint32_t structSize, flags; /* FwWorldFlags, default 0; see fwWorld_SetFlags */
    float up[3];                /* unit vector, default 0,1,0 */
    float paceFactor;           /* [0.1, 1000], default 1: how much faster than wood fire spreads
                                   and burns out. Games use 5 to 30. */
    float wind[3];              /* m/s, default 0 */
    uint32_t reserved;          /* 0 */
    uint32_t seed;              /* of everything cosmetic and of noise */
    uint32_t maxStepsPerFrame;  /* [1, 64], default 8: time beyond it is dropped and counted */
    uint32_t maxLights;         /* [0, 64], default 16 */
    uint32_t maxFlames;         /* [0, 65536], default 4096 flame quads alive; drawn: at most 4096 */
    uint64_t userData;
    uint32_t maxRefinedTriangles; /* [1000, 16000000], default 400000: what refined objects aim to
                                     stay within, together; software devices do well with 60000 */
    uint32_t reserved1;         /* 0 */
    /* Limits of spread, for the world; objects have their own beside these. The stricter counts. */
    float spreadChance;         /* [0, 1], default 1: of each jump from object to object, decided once for
                                   a pair and a fire, and of each ember */
    uint32_t maxHops;           /* fire that came over this many jumps goes to no other object; 0: no limit */
    uint32_t maxBurningTiles;   /* never more tiles of 8 x 8 texels burn, however fire spreads: chance says which
                                   catch, alike on every backend, others wait. What fwWorld_Ignite, FW_FIRE_IGNITES
                                   and a jet on FW_BURNABLE_LITE light at once burns beyond it. 0: no limit */
    float timeToLive;           /* s that the front of an object moves after the object caught; 0: no limit */
    /* How much of `from` a fire of its sees `to`, 0 to 1: asked when one of them moved, kept until then.
       Null: all. Called from the thread that steps the world; it must give the same answer to the same
       poses wherever worlds are to be equal. */
    float (FW_CALL* visibility)(void* visibilityData, FwBurnableMeshId from, FwBurnableMeshId to);
    void* visibilityData;
    /* Volumetric fires where they are marched before they are drawn: the view of the outside part. */
    uint32_t volumeCell;        /* px, [1, 16], default 2: of the cells that are marched; 1: each pixel */
    uint32_t volumeSteps;       /* [6, 64], default 64: most samples of a ray through a flame's depth. The few
                                   that all but the largest 32 flames get are no more than these */
    uint32_t maxParticles;      /* [0, 1048576], default 16384: of all fire emitters; 48 bytes each, once there */
    uint32_t arrivalTiles;      /* [1, 1048576], default 1024: tiles of 8 x 8 texels that questions for arrivals
                                   look at in a frame, together; some 2 us each, and some 25 looks at each
                                   tile of a map. See fwWorld_RequestArrival */
    uint32_t volumeOctaves;     /* [1, 4], default 4: most octaves of noise of a volumetric flame; presets have
                                   3, large fires 4. Fewer are quicker and smoother, and as high and bright */
    uint32_t reserved2;         /* 0 */
    float metersPerUnit;        /* m, [0.0001, 1000], default 1: length of the unit in which the host gives and gets
                                   every length of this world. 0.01: centimetres (Unreal, Qt); 0.3048: feet. 0: 1 */
    uint32_t reserved3;         /* 0 */
} FwWorldDef;
static inline FwWorldDef fwDefaultWorldDef(void) {
    FwWorldDef d; fwInitDef(FW_DEF_WORLD, &d, (uint32_t)sizeof d); return d;
}
FW_API FwResult FW_CALL fwCreateWorld(FwContext* context, const FwWorldDef* def, FwWorld** world); /* [any] */
/* Turns the lengths of a def from metres into the world's unit. Defaults (fwDefault...), presets (fwInitFirePreset) and what
 * a host keeps in metres know no world. def: a struct of FwDefType `defType` whose structSize is set; what it points to stays
 * as it is. Once for each def. FW_ERROR_INVALID_ARGUMENT: defType is unknown. The defaults of
 * FwMeshDef and FwMaterialDef hold in every unit. [any] */
FW_API FwResult FW_CALL fwWorld_ConvertDef(FwWorld* world, uint32_t defType, void* def);
FW_API void FW_CALL fwDestroyWorld(FwWorld* world); /* null is fine [world] */
FW_API size_t FW_CALL fwWorld_GetLastMessage(FwWorld* world, char* text, size_t capacity); /* [any] */

/* ---- deferred destruction: for scene-node destructors, which run while frames are in flight ------ */

/* fwContext_Collect destroys the world once its completedFrameIndex is at least `frameIndex`. 0: the newest
 * frame that the world has recorded or stepped, the one in progress included. May be called while
 * another thread records with the world; no call that begins later may use it. A second call
 * changes the frame. fwDestroyContext destroys what still waits. [any] */
FW_API FwResult FW_CALL fwWorld_DestroyAfterFrame(FwWorld* world, uint64_t frameIndex);
/* Destroys what waits for frames up to completedFrameIndex: the frame of the host's that the GPU has
 * finished, with all before it. UINT64_MAX: everything, where the host has waited or the backend is the cpu's.
 * Returns how many worlds and targets still wait. Call it once a frame. [any, while no call uses what it
 * destroys: a frame that is complete has ended its calls] */
FW_API uint32_t FW_CALL fwContext_Collect(FwContext* context, uint64_t completedFrameIndex);

typedef enum FwObjectKind { /* of an id, for fwWorld_DestroyLater */
    FW_OBJECT_MATERIAL = 1, FW_OBJECT_IMAGE = 2, FW_OBJECT_MESH = 3, FW_OBJECT_BURNABLE_MESH = 4,
    FW_OBJECT_BLOCKER = 5, FW_OBJECT_VOLUMETRIC_FIRE = 6, FW_OBJECT_FIRE_PROFILE = 7,
    FW_OBJECT_FIRE_COLLIDER = 8, FW_OBJECT_FIRE_EMITTER = 9, FW_OBJECT_FLIPBOOK = 10,
    FW_OBJECT_PARTICLE_FIELD = 11, FW_OBJECT_WIND_ZONE = 12, FW_OBJECT_ROOM = 13, FW_OBJECT_BURN = 14,
    FW_OBJECT_KIND_COUNT = 15, FW_OBJECT_KIND_FORCE32 = 0x7fffffff
} FwObjectKind;
typedef struct FwObjectRef { uint32_t kind, index1, generation, reserved; } FwObjectRef; /* FwObjectKind; the id's; 0 */
/* As the fwWorld_Destroy... or fwWorld_Remove... function of that kind, at the beginning of the world's next
 * fwWorld_Step or fwWorld_RecordOutside. In any order: what something still uses (a mesh, a profile, a
 * flipbook, a baked burn) waits until its last user is gone. An id that is stale by then is a warning in the
 * log. Frames in flight may still use the object; its memory waits for them. [any] */
FW_API FwResult FW_CALL fwWorld_DestroyLater(FwWorld* world, const FwObjectRef* object);

/* Uniform wind, m/s, world space, each component within +-120. Filtered over a material's link
 * time before it reaches a front. [world] */
FW_API FwResult FW_CALL fwWorld_SetWind(FwWorld* world, const float wind[3]);
/* FwWorldFlags from the next exchange on: fire reaches other objects eight times a second. What
 * they say of objects counts for those created from now on. [world] */
FW_API FwResult FW_CALL fwWorld_SetFlags(FwWorld* world, uint32_t flags);

/* Moves all places of the world by `offset` m, each within +-2e6 m and rounded to whole metres: a place p is p + offset from
 * here on. For hosts that move their origin in large worlds. Everything goes along: objects, what burns and what they
 * give each other, blockers, shields, rooms, wind, gusts, fires with their history, emitters with their particles,
 * fields, colliders, lights, answers and events that wait; the fire burns on and looks as if nothing had moved.
 * Callbacks of the host's (FwFireColliderDef::distance) are asked in the new places. Saves keep the origin, and loading or
 * seeking goes back to theirs: see fwWorld_GetOrigin. In logs, timelines and networks. *applied (may be null) gets the
 * whole metres. Exact for what burns, but for what jets, FW_FIRE_IGNITES and FW_FIELD_WETS strike, which is found in
 * floats: to the tenth of a millimetre at 1000 m. A world that follows a server has the server's origin.
 * FW_ERROR_INVALID_ARGUMENT, and nothing moved: something would be beyond +-1e6 m, or the world follows a server. [world] */
FW_API FwResult FW_CALL fwWorld_ShiftOrigin(FwWorld*, const float offset[3], float applied[3]);
/* m that fwWorld_ShiftOrigin has moved all places since the world was created, in all. [world] */
FW_API FwResult FW_CALL fwWorld_GetOrigin(FwWorld*, double origin[3]);

typedef struct FwBlockerDef { /* a box that radiation, plumes and embers do not pass: a wall, a door */
    uint32_t structSize, flags; /* 0 */
    float transform[16];        /* box to world, rigid and uniform scale; default identity */
    float halfSize[3];          /* m, each [0, 30], also times the transform's scale; 0: a quad. Default 0.5 */
    uint32_t reserved;          /* 0 */
} FwBlockerDef;
static inline FwBlockerDef fwDefaultBlockerDef(void) {
    FwBlockerDef d; fwInitDef(FW_DEF_BLOCKER, &d, (uint32_t)sizeof d); return d;
}
/* At most 64 at a time. What is within 6 cm of a box's surface is not behind it. [world] */
FW_API FwResult FW_CALL fwWorld_AddBlocker(FwWorld*, const FwBlockerDef* def, FwBlockerId* id);
FW_API FwResult FW_CALL fwWorld_MoveBlocker(FwWorld*, FwBlockerId id, const float transform[16]); /* [world] */
FW_API FwResult FW_CALL fwWorld_RemoveBlocker(FwWorld*, FwBlockerId id); /* [world] */

typedef enum FwHeatShieldFlags {
    FW_HEAT_SHIELD_ALL_OBJECTS = 1, /* all burnable meshes that are there fill cells, not `objects` alone */
    FW_HEAT_SHIELD_FORCE32 = 0x7fffffff
} FwHeatShieldFlags;
/* A grid of solid cells that radiation, plumes and embers do not pass, for more than boxes give: terrain and houses of
 * the host's, walls and fences that are burnable meshes. A cell is solid if any of the three below says so. */
typedef struct FwHeatShieldDef {
    uint32_t structSize, flags; /* FwHeatShieldFlags, default 0 */
    uint32_t counts[3];         /* cells along the world's x, y, z, [1, 256] each, at most 2097152 in all; default 1 */
    float origin[3];            /* m, world, within +-1e6: the grid's low corner. Rounded to mm */
    float cellSize;             /* m, [0.05, 10], default 0.25. Not below what the gaps are that fire is to pass, nor
                                   below the side of the objects' texels */
    uint32_t objectCount;       /* default 0 */
    const uint8_t* cells;       /* default null. A byte each, x fastest, then y, then z; not 0: solid. Copied */
    float (FW_CALL* distance)(void* distanceData, const float place[3]); /* default null. m from a place (m, world) to the
                                   nearest surface, negative inside: called once for each cell's middle, within
                                   fwWorld_SetHeatShield alone. Below half of cellSize: solid, so that a wall of any
                                   thickness has no gap. Give more where ground is to stay below what lies on it */
    void* distanceData;
    const FwBurnableMeshId* objects; /* default null. Those whose surface fills cells, as they stand now, at rest. A cell of
                                   theirs opens as pictures and jets have it: with the hole at its middle */
} FwHeatShieldDef;
static inline FwHeatShieldDef fwDefaultHeatShieldDef(void) {
    FwHeatShieldDef d; fwInitDef(FW_DEF_HEAT_SHIELD, &d, (uint32_t)sizeof d); return d;
}
/* In place of the shield that was; null: none any more. Counts from the next exchange on (eight a second), beside blockers.
 * Cells of the host's stop jets, too, which strike meshes by themselves. What is within a cell of a flame or of what it
 * warms is not between them; of the cells of the two's own, and of the host's, what is within some cells: nothing shades
 * itself. What has burnt away lets fire pass by itself; what moved is where it was until the next call; what is destroyed
 * is gone. At most 262144 cells are objects'. The same on every backend, in saves, logs and networks: these have 58 bytes
 * for every 384 cells in a row of which one of the host's changed (all that are solid, where the grid is another), and 9
 * for each object. Takes some 5 ns per cell, the callback's own time and some 40 ns per texel of the objects. [world] */
FW_API FwResult FW_CALL fwWorld_SetHeatShield(FwWorld*, const FwHeatShieldDef* def);

typedef enum FwWindShape { /* where a wind zone is; what lies in it is measured from its middle to its edge */
    FW_WIND_BOX = 0,           /* along the world's axes: size is half of its sides */
    FW_WIND_SPHERE = 1,        /* size[0]: radius */
    FW_WIND_CONE = 2,          /* from `position` along `axis`; size[0]: length, size[1]: radius at its end. A fan */
    FW_WIND_SHAPE_COUNT = 3, FW_WIND_SHAPE_FORCE32 = 0x7fffffff
} FwWindShape;
typedef enum FwWindFlow {
    FW_WIND_ALONG = 0,         /* along `axis` */
    FW_WIND_RADIAL = 1,        /* away from `position`; a negative speed: towards it */
    FW_WIND_VORTEX = 2,        /* around `axis` through `position`, right-handed */
    FW_WIND_FLOW_COUNT = 3, FW_WIND_FLOW_FORCE32 = 0x7fffffff
} FwWindFlow;
typedef enum FwWindBlend {
    FW_WIND_ADD = 0,           /* to what blows there */
    FW_WIND_REPLACE = 1,       /* instead of it, as far as the zone has not faded; speed 0: shelter */
    FW_WIND_BLEND_COUNT = 2, FW_WIND_BLEND_FORCE32 = 0x7fffffff
} FwWindBlend;
/* Wind of a place's own. An object's fire, its flames and the embers from it have the wind at the middle of its box
 * (of its mesh at rest: split what is larger than a zone), volumetric fires, emitters and fields that at their position. */
typedef struct FwWindZoneDef {
    uint32_t structSize, flags; /* flags: 0 */
    uint32_t shape;             /* FwWindShape, default FW_WIND_BOX */
    uint32_t flow;              /* FwWindFlow, default FW_WIND_ALONG */
    uint32_t blend;             /* FwWindBlend, default FW_WIND_ADD */
    int32_t priority;           /* [-1000, 1000], default 0: higher ones count after lower ones, of the same those with
                                   the higher id */
    float position[3];          /* m, world, within +-1e6 */
    float axis[3];              /* direction, default 1,0,0; of any length */
    float size[3];              /* m, [0.01, 1000], default 1: see FwWindShape */
    float speed;                /* m/s, [-120, 120], default 5 */
    float falloff;              /* [0, 1], default 0.5: the part of the way from its middle to its edge on which it
                                   fades; 0: as strong up to its edge */
    uint32_t reserved;          /* 0 */
} FwWindZoneDef;
static inline FwWindZoneDef fwDefaultWindZoneDef(void) {
    FwWindZoneDef d; fwInitDef(FW_DEF_WIND_ZONE, &d, (uint32_t)sizeof d); return d;
}
/* At most 64 at a time. Counts from the next step on; filtered like the world's wind. [world] */
FW_API FwResult FW_CALL fwWorld_CreateWindZone(FwWorld*, const FwWindZoneDef* def, FwWindZoneId* id);
/* All of it anew: to turn a fan, or as it starts and stops. [world] */
FW_API FwResult FW_CALL fwWorld_SetWindZone(FwWorld*, FwWindZoneId id, const FwWindZoneDef* def);
FW_API FwResult FW_CALL fwWorld_DestroyWindZone(FwWorld*, FwWindZoneId id); /* [world] */
/* Wind on a grid: of a weather map, of the host's own solver. Trilinear between its points; none of it outside. */
typedef struct FwWindGridDef {
    uint32_t structSize, flags; /* flags: 0 */
    uint32_t blend;             /* FwWindBlend, default FW_WIND_REPLACE: with the world's wind. Zones count after it */
    uint32_t counts[3];         /* points along the world's x, y, z, [2, 64] each, at most 32768 in all; default 2 */
    float origin[3];            /* m, world, within +-1e6: where the first point is */
    float cellSize;             /* m, [0.01, 1000], default 1: from point to point, along each axis */
    float fade;                 /* m, [0, 1000], default 0: the way inward from its faces on which it fades */
    uint32_t reserved;          /* 0 */
    const float* velocities;    /* m/s, 3 of each point, each within +-120; x runs fastest, then y, then z. Copied */
} FwWindGridDef;
static inline FwWindGridDef fwDefaultWindGridDef(void) {
    FwWindGridDef d; fwInitDef(FW_DEF_WIND_GRID, &d, (uint32_t)sizeof d); return d;
}
/* In place of the grid that was; null: none any more. Rounded to 1/128 m/s. Counts from the next step on, filtered like
 * the world's wind; meant for a few times a second: a log or a network has some 58 bytes for every eight points in a
 * row of which one changed, where the grid stays where it is, else for all that are not calm. [world] */
FW_API FwResult FW_CALL fwWorld_SetWindGrid(FwWorld*, const FwWindGridDef* def);
/* Gusts: the world's wind and that of its grid are stronger here and weaker there, by noise that drifts with the wind.
 * They reach fronts, embers, plumes, flames, volumetric fires and emitters, a quarter of a second at a time, the same on
 * every backend; not particle fields, nor what zones add or shelter. What plays a baked burn goes live in them. */
typedef struct FwGustDef {
    uint32_t structSize, flags; /* flags: 0 */
    float strength;             /* [0, 1], default 0: it blows (1 - strength) to (1 + strength) times as strong */
    float size;                 /* m, [0.5, 1000], default 12: of a gust; half of it in half of its size */
} FwGustDef;
static inline FwGustDef fwDefaultGustDef(void) {
    FwGustDef d; fwInitDef(FW_DEF_GUSTS, &d, (uint32_t)sizeof d); return d;
}
/* From the next step on; strength 0: none. [world] */
FW_API FwResult FW_CALL fwWorld_SetGusts(FwWorld*, const FwGustDef* def);
/* m/s, at a point (m, world, within +-1e6), now, as all that is there has it. [world] */
FW_API FwResult FW_CALL fwWorld_GetWindAt(FwWorld*, const float point[3], float wind[3]);

typedef enum FwRoomFlags {
    FW_ROOM_REFILL = 1,         /* of fwWorld_SetRoom: its air becomes that of `oxygen`: gas that puts fires out */
    FW_ROOM_FLAGS_FORCE32 = 0x7fffffff
} FwRoomFlags;
/* A room whose air fires use up. An object is in the room where the middle of its box lies (of its mesh at rest), of
 * several in the one made first; outside of all there is air without end. Fire takes 1 kg of oxygen for 13.1 MJ
 * (Huggett 1980). Below 15 % of oxygen by volume it weakens evenly until nothing burns in 12 %: it gives off less,
 * spreads slower, lights others less, and goes out as it cools. What is still alight grows again when air comes, and
 * what went out lights again where it is still hot enough. Objects with FW_BURNABLE_LITE, volumetric fires and
 * emitters neither use air nor want it.
 * It flashes over (FW_EVENT_FLASHED_OVER) when its fires, in the mean of about a second, give off what Thomas (1981)
 * says that takes: 7.8 kW for each m^2 of its box's sides and 945 kW for each m^3/s of `vent` (378 kW for each m^2.5
 * of A sqrt(h)); once, until they have given off less than half of that. It is told, and changes nothing by itself. */
typedef struct FwRoomDef {
    uint32_t structSize, flags; /* FwRoomFlags */
    float position[3];          /* m, world, within +-1e6: its middle */
    float rotation[4];          /* unit quaternion x, y, z, w; default 0,0,0,1 */
    float halfSize[3];          /* m, half of its sides, [0.05, 1000], default 2, 1.25, 2.5 */
    float volume;               /* m^3 of air, [0.1, 1e6]; 0, the default: that of its box, which is then within that */
    float vent;                 /* m^3/s of air from outside, [0, 1e4], default 0.01: a leaky room. An opening of A m^2
                                   and height h m: about 0.4 A sqrt(h) (Kawagoe), a door 0.9 */
    float oxygen;               /* by volume, [0, 1], default 0.2095: as it is created, and with FW_ROOM_REFILL */
    uint32_t reserved;          /* 0 */
} FwRoomDef;
static inline FwRoomDef fwDefaultRoomDef(void) {
    FwRoomDef d; fwInitDef(FW_DEF_ROOM, &d, (uint32_t)sizeof d); return d;
}
/* At most 64 at a time. Counts from the next step on. [world] */
FW_API FwResult FW_CALL fwWorld_CreateRoom(FwWorld*, const FwRoomDef* def, FwRoomId* id);
/* All of it anew but its air: as a door opens or a ship moves. [world] */
FW_API FwResult FW_CALL fwWorld_SetRoom(FwWorld*, FwRoomId id, const FwRoomDef* def);
/* Who was in it has air without end, or that of another room. [world] */
FW_API FwResult FW_CALL fwWorld_DestroyRoom(FwWorld*, FwRoomId id);
typedef struct FwRoomState {
    uint32_t structSize;
    uint32_t objects;           /* burnable meshes that are in it now */
    uint64_t frameIndex;        /* the rest is as of it, like FwObjectState */
    float oxygen;               /* by volume, [0, 1] */
    float strength;             /* of fire in it, [0, 1]: 1 from 15 % of oxygen on, 0 up to 12 % */
    float power;                /* W that uses its air, mean of the last 1/8 s, at pace 1 */
    uint32_t flashedOver;       /* 1: it has flashed over and still burns so; 0: not */
    float flashOverPower;       /* W at which it does */
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

typedef struct FwMaterialDef { /* spread law: see plugin/docs/model.md. In SI units in every world */
    uint32_t structSize;
    uint32_t look;        /* FwMaterialPreset whose appearance is used */
    float spreadRate;     /* m/s on a flat horizontal sheet in still air, [0, 1]; 0: cannot burn */
    float windGain;       /* drive per m/s of wind along the surface, [0, 16] */
    float upGain;         /* drive of a vertical surface, [0, 16] */
    float headGain;       /* head speed = spreadRate * (1 + headGain * min(drive, driveMax)) [0, 255] */
    float backGain;       /* back speed = spreadRate / (1 + backGain * drive) [0, 255] */
    float driveMax;       /* [0, 63] */
    float lengthToBreadth;/* largest length/breadth of the burnt ellipse, [1, 4]; default 2 */
    float ceilingGain;    /* speed-up below a ceiling, [0, 4]; default 0.3 */
    float burnTime;       /* s a texel flames, at pace 1; <= 0: thick fuel, which flames while
                             thickness * density lasts at burningFlux, and while it is hot enough */
    float moisture;       /* kg water per kg dry fuel, [0, 2] */
    float extinctionMoisture; /* moisture at which it no longer spreads, (0, 2] */
    float thickness;      /* m, of the visible rim and of the consumption, >= 0 */
    float heatOfCombustion;   /* J/kg */
    float burningFlux;    /* kg/m^2/s while it flames */
    float baseColor[3];   /* linear albedo of the fresh material, where no image is given */
    float baseRoughness;  /* [0, 1] */
    /* Heat and water: of objects without FW_BURNABLE_LITE. */
    float density;                 /* kg/m^3, [1, 20000] */
    float specificHeat;            /* J/kg/K, [100, 10000] */
    float conductivity;            /* W/m/K, [0.001, 500] */
    float ignitionTemperature;     /* K of its surface, with a flame near, [300, 2000] */
    float autoIgnitionTemperature; /* K without one, [ignitionTemperature, 3000] */
    float flameFeedback;           /* W/m^2 that its own flame gives back to it, [0, 200000]; default
                                      25000. Below some 9000 a lone flame goes out, as real planks do */
    float charFloor;               /* thick fuel: share of its burning rate that no char stops, (0, 1] */
    float waterHeld;               /* g/m^2 of water that stay on it, [0, 1023]; more runs off */
    float radiantFraction;         /* of its heat that leaves as radiation, [0, 1] */
    float sootYield;               /* kg of soot per kg burnt, [0, 1] */
    float recede;         /* share of the thickness that is gone when it is consumed, [0, 1]; the
                             rest stays as char. Used by FW_BURNABLE_RECEDE */
    float shrink;         /* of lengths of a charred sheet, [0, 0.5] */
    float curl;           /* 1/m, of a charred sheet, [0, 200] */
} FwMaterialDef;
static inline FwMaterialDef fwDefaultMaterialDef(void) { /* pine */
    FwMaterialDef d; fwInitDef(FW_DEF_MATERIAL, &d, (uint32_t)sizeof d); return d;
}
/* Overwrites all but structSize with a preset. [any] */
FW_API FwResult FW_CALL fwInitMaterialPreset(FwMaterialDef* def, uint32_t preset);
FW_API const char* FW_CALL fwMaterialPresetName(uint32_t preset); /* [any] */
FW_API FwResult FW_CALL fwWorld_CreateMaterial(FwWorld*, const FwMaterialDef* def, FwMaterialId* id); /* [world] */
FW_API FwResult FW_CALL fwWorld_DestroyMaterial(FwWorld*, FwMaterialId id); /* users keep their copy [world] */

/* ---- images: base colours --------------------------------------------------------------------------- */

typedef struct FwImageDef {
    uint32_t structSize, flags; /* flags: 0 */
    uint32_t width, height;     /* [1, 8192] */
    const void* pixels;         /* RGBA8, rows top first, tightly packed; sRGB colour, linear alpha */
    float alphaCutoff;          /* [0, 1], default 0: alpha is ignored. Above 0 the image is a cut-out: where its
                                   alpha is below this, objects that show it are not there. They are not drawn
                                   there, hold no fuel that burns (fire goes around) and bear nothing (see
                                   FW_EVENT_STRUCTURE_BROKE). A texel of the burn map
                                   burns if any part of it is there. Costs such objects 2 bytes a texel */
    float reserved;             /* 0 */
} FwImageDef;
static inline FwImageDef fwDefaultImageDef(void) {
    FwImageDef d; fwInitDef(FW_DEF_IMAGE, &d, (uint32_t)sizeof d); return d;
}
FW_API FwResult FW_CALL fwWorld_CreateImage(FwWorld*, const FwImageDef* def, FwImageId* id); /* [world] */
FW_API FwResult FW_CALL fwWorld_DestroyImage(FwWorld*, FwImageId id); /* objects fall back to their base colour [world] */

/* ---- meshes: baked once, shared by any number of objects ----------------------------------------------- */

typedef struct FwMeshDef {
    uint32_t structSize, flags;    /* FwMeshFlags */
    const float* positions;        /* 3 per vertex, m, required unless cooked. Here m is the mesh's unit */
    const float* normals;          /* 3 per vertex, or null: computed */
    const float* uvs;              /* 2 per vertex, or null */
    const float* details;          /* 2 per vertex, m on the surface, y along the grain, or null */
    const uint32_t* colors;        /* RGBA8 linear per vertex, or null: white */
    const void* indices;           /* 3 per triangle */
    const uint8_t* triangleMaterials; /* 1 per triangle, [0, 7], or null: 0 */
    uint32_t vertexCount, indexCount;
    uint32_t indexSize;            /* bytes: 2 or 4 (default) */
    uint32_t mapSize;              /* largest side of the burn map in texels, [8, 4096], default 512 */
    float texelsPerMetre;          /* wished density, (0, 4096], default 128; lowered to fit mapSize */
    float noiseAmplitude;          /* raggedness of the front, [0, 0.5], default 0.15 */
    float noiseFeature;            /* metres in every unit, [0.0001, 1000], default 0.012 */
    uint32_t noiseSeed;
    const void* cooked;            /* from fwCookMesh; then the arrays above are not read */
    uint64_t cookedSize;           /* bytes */
    float metersPerUnit;           /* m, [0.0001, 1000]: length of the mesh's unit, in which are the arrays above and all of its
                                      object space: transforms lead from it, pins, skinned vertices and FwMeshInfo are in
                                      it. 0, default: the world's unit; with fwCookMesh: 1. Of a cooked mesh, whose bytes
                                      hold metres: the unit of its object space from here on */
    uint32_t reserved;             /* 0 */
} FwMeshDef;
typedef enum FwMeshFlags {
    FW_MESH_TRUST_UVS = 1, /* use the UVs as the burn map's even if they overlap or stretch */
    FW_MESH_FLAGS_FORCE32 = 0x7fffffff
} FwMeshFlags;
static inline FwMeshDef fwDefaultMeshDef(void) {
    FwMeshDef d; fwInitDef(FW_DEF_MESH, &d, (uint32_t)sizeof d); return d;
}
typedef struct FwMeshInfo {
    uint32_t structSize;
    uint32_t mapWidth, mapHeight, texels, charts;
    uint32_t vertices, triangles, degenerateTriangles, openEdges, nonManifoldEdges;
    uint32_t usedOwnUvs, reserved;
    float area, texelArea;         /* m^2 */
    float boundsLow[3], boundsHigh[3]; /* m, object space */
    float texelsPerMetre, bakeMilliseconds;
} FwMeshInfo;
/* Bakes the burn domain: up to seconds for 100k triangles. [world] */
FW_API FwResult FW_CALL fwWorld_CreateMesh(FwWorld*, const FwMeshDef* def, FwMeshId* id);
FW_API FwResult FW_CALL fwWorld_DestroyMesh(FwWorld*, FwMeshId id); /* refused while an object uses it [world] */
FW_API FwResult FW_CALL fwWorld_GetMeshInfo(FwWorld*, FwMeshId id, FwMeshInfo* info); /* [world] */
/* The bake alone, for a tool, a cache or a worker thread. Call with buffer null for the size, or
 * with enough room; *size is what is (or would be) written. [any] */
FW_API FwResult FW_CALL fwCookMesh(FwContext* context, const FwMeshDef* def, void* buffer, uint64_t* size);

/* ---- burnable meshes: what burns ------------------------------------------------------------------------ */

typedef enum FwBurnableFlags {
    FW_BURNABLE_HIDDEN = 1,     /* simulated, not drawn by us */
    FW_BURNABLE_TWO_SIDED = 2,  /* draw back faces too */
    FW_BURNABLE_PUBLISHED = 4,  /* spread by the published 16-tap kernel, for comparison */
    FW_BURNABLE_NO_HOLES = 8,   /* never consumed */
    FW_BURNABLE_LITE = 16,      /* no temperature, fuel and water per texel: 8 bytes a texel less, and
                                   nothing to do for what burns behind the front. It burns by
                                   burnTime alone, and water stays until it is dried */
    FW_BURNABLE_REFINE = 32,    /* drawn with finer triangles where it burns, down to its burn map's
                                   cells, which recede as the material is consumed */
    FW_BURNABLE_REFINE_PUBLISHED = 64, /* instead of FW_BURNABLE_REFINE: by the published scheme, for
                                   comparison. A template of four-way splits on each triangle, refined
                                   where a heat boundary has come to that grows from the first place
                                   a host lights (what another object lights stays coarse); burnt
                                   triangles vanish whole. It cracks where levels meet, and has no
                                   budget. Same fire, same mesh */
    FW_BURNABLE_RECEDE = 128,   /* what we draw recedes as it is consumed; for solids. Closed ones of up to
                                   65536 triangles show walls behind holes, as they do without it */
    FW_BURNABLE_SHELL = 256,    /* a thin sheet: hangs, flutters, curls and shrinks as it chars, tears;
                                   see pins. Cosmetic: fire spreads and is found where it rests */
    FW_BURNABLE_SPRINGS = 512,  /* deformed by the published mass-spring model, for comparison */
    FW_BURNABLE_SKINNED = 1024, /* the host moves its vertices: fwWorld_SetVertexPositions */
    FW_BURNABLE_NO_SPREAD = 2048, /* its fire reaches no other object */
    FW_BURNABLE_NO_DAMAGE = 4096, /* its fire takes its course, and nothing is seen of it but flames:
                                     no char, no holes, no recession, no curling, no refinement */
    FW_BURNABLE_Z_PASS = 8192,  /* with SPRINGS or RECEDE, for comparison: once it has caught, crossed
                                   walls are hidden as published. Costs a draw of its depth for each
                                   view, shows no insides, and needs a target of FW_DEPTH_TEST */
    FW_BURNABLE_FLAGS_FORCE32 = 0x7fffffff
} FwBurnableFlags;

typedef struct FwPin { /* holds the points of a sheet within radius m of a segment; object space, m */
    float from[3], to[3], radius, reserved; /* radius >= 0; reserved: 0 */
} FwPin;
typedef struct FwBurnableMeshDef {
    uint32_t structSize, flags;       /* FwBurnableFlags */
    FwMeshId mesh;
    FwMaterialId materials[8];        /* by triangle material, default all null: the object is pine.
                                         Once one is named, null ones are noncombustible */
    FwImageId baseColor;              /* null: the material's base colour and procedural detail */
    float transform[16];              /* the mesh's unit to the world's: rotation, a scale per axis (the largest at most
                                         16 times the smallest), a mirror; no shear. Default identity.
                                         Objects of one mesh and one shape share it; another shape costs a
                                         copy of the mesh's planes. */
    float moisture;                   /* added to the materials' own, [0, 2] */
    float tint[3];                    /* multiplies the base colour, default 1,1,1 */
    const uint8_t* multiplier;        /* speed multiplier over the burn map, 128 = 1, 0 = cannot burn */
    uint32_t multiplierWidth, multiplierHeight; /* resampled (nearest) to the burn map */
    uint64_t userData;                /* comes back in events */
    FwImageId baseColors[8];          /* by triangle material, default null: baseColor there too */
    uint32_t refineDepth;             /* FW_BURNABLE_REFINE..: halvings of an edge, [0, 5], default 5 */
    float refinePixelsPerEdge;        /* length on the screen of the finest edges, [1, 1000], default 8 */
    const FwPin* pins;                /* of FW_BURNABLE_SHELL, or null: it falls */
    uint32_t pinCount;                /* [0, 8] */
    float ground;                     /* m, world, along up: sheets fall no deeper; default -1e9 */
    float spreadChance;               /* as in FwWorldDef, of this object: the chance of its fire to jump,
                                         times the world's; default 1 */
    uint32_t maxHops;                 /* 0: no limit */
    uint32_t maxBurningTiles;         /* of this object, as FwWorldDef's; 0: no limit */
    float timeToLive;                 /* s, 0: no limit */
    /* Of FW_BURNABLE_REFINE_PUBLISHED: its heat boundary at a radius r is where
     * r^2 = |sin(pi Theta / heatStep) + sin(pi Theta) + heatPsi |x - x0|^2|, Theta random. */
    float heatPsi;                    /* 1/m^2, [0, 1e8]; 0, default: one over the square of the mean
                                         finest edge */
    float heatStep;                   /* delta r: what r grows by in a step of 1/32 s, [0, 1000]; 0,
                                         default: as fast as the materials' fastest fire */
    /* FW_EVENT_STRUCTURE_BROKE, looked for twice a second of the world's time. What is gone is where holes are:
     * what burnt out, and gave way. Costs some 25 ns a texel each time; with a device a copy of its burn map, 12 bytes a
     * texel. */
    float breakShare;                 /* (0, 1]: raise it once that much of its surface is gone; 0, default: never */
    float breakArea;                  /* m^2, (0, 1e6]: raise it for each part of so much or more that has lost its
                                         way, over what is left, to where it stands: the lowest two texels of what
                                         hung together when the mesh was made, as it is turned now; of
                                         FW_BURNABLE_SHELL to its pins. 0, default: never */
} FwBurnableMeshDef;
static inline FwBurnableMeshDef fwDefaultBurnableMeshDef(void) {
    FwBurnableMeshDef d; fwInitDef(FW_DEF_BURNABLE_MESH, &d, (uint32_t)sizeof d); return d;
}
FW_API FwResult FW_CALL fwWorld_CreateBurnableMesh(FwWorld*, const FwBurnableMeshDef* def, FwBurnableMeshId* id); /* [world] */
FW_API FwResult FW_CALL fwWorld_DestroyBurnableMesh(FwWorld*, FwBurnableMeshId id); /* [world] */
/* As FwBurnableMeshDef::transform; wind and gravity follow the new pose at the next latch, and so
 * does the front's speed under another size. Another ratio of the axes than at creation stretches what
 * is drawn and asked, while fire goes on in the metric of its creation (times the mean scale); a
 * mirror is settled at creation. [world] */
FW_API FwResult FW_CALL fwWorld_SetTransform(FwWorld*, FwBurnableMeshId id, const float transform[16]);
/* Of an object with FW_BURNABLE_SKINNED: where the vertices of its mesh (FwMeshDef's, in its order
 * and object space) are from the next frame on; 3 floats each, m, within +-1e6. normals: 3 each, or null:
 * they follow the triangles. Fire spreads in the metric and under the normals of the mesh at rest and
 * does not know of this; what is drawn, flames, lights, ignitions, queries and tags follow. [world] */
FW_API FwResult FW_CALL fwWorld_SetVertexPositions(FwWorld*, FwBurnableMeshId id, const float* positions,
                                                   const float* normals, uint32_t vertexCount);
FW_API FwResult FW_CALL fwWorld_SetHidden(FwWorld*, FwBurnableMeshId id, uint32_t hidden); /* [world] */

typedef enum FwIgnitionKind {
    FW_IGNITE = 0,      /* receptive texels catch fire now */
    FW_WET = 1,         /* wets: what burns goes out if the water takes more heat than the fire gives,
                           wet texels cannot catch until heat or air has dried them (FW_BURNABLE_LITE:
                           goes out at once, stays wet until FW_DRY) */
    FW_DRY = 2,         /* dries what was wetted */
    FW_EXTINGUISH = 3,  /* puts out, leaves dry: may catch again from a live neighbour */
    FW_IGNITION_KIND_FORCE32 = 0x7fffffff
} FwIgnitionKind;
typedef struct FwIgnitionDef { /* a ball against one object or all of them */
    uint32_t structSize;
    uint32_t kind;            /* FwIgnitionKind */
    FwBurnableMeshId object;  /* null: every object the ball touches */
    float position[3];        /* m, world */
    float radius;             /* m, >= 0; the nearest texel within reach counts at least */
    float delay;              /* s from now, [0, 3600] */
    float water;              /* FW_WET: g/m^2, [0, 1023]; 0: as much as the material holds */
    uint32_t reserved[2];
} FwIgnitionDef;
static inline FwIgnitionDef fwDefaultIgnitionDef(void) {
    FwIgnitionDef d; fwInitDef(FW_DEF_IGNITION, &d, (uint32_t)sizeof d); return d;
}
/* Queued; takes effect in the simulation step whose window holds its time. *texels (may be null) gets how
 * many texels it addresses. FW_NOTHING_THERE: it addresses none, or as FW_IGNITE none that can burn
 * (noncombustible, cut out, a multiplier of 0, or water that was queued before it). Then the log (FW_LOG_INFO) and
 * fwWorld_GetLastMessage say why FW_IGNITE lights nothing: the nearest object and its distance, or the
 * material. What earlier steps made wet is not known here: see FW_POINT_WET of fwWorld_RequestPoint. [world] */
FW_API FwResult FW_CALL fwWorld_Ignite(FwWorld*, const FwIgnitionDef* def, uint32_t* texels);

/* The burn of `from` goes on on `to`, an object of another mesh of the same shape: a level of detail. With the next step each
 * texel of `to` gets the state, fuel, temperature and water that the nearest texel of `from` has, in object space with both
 * at rest, of those that face the same way (within 60 degrees) before others; none, where none is within 5 % of the
 * diagonal of its box and two texels. So the share of the area that burnt stays what it is, to a texel along its edge. What
 * cannot burn stays as it is. Events and FwObjectState of `to` go on from those of `from`; tags and queries stay with their
 * object. `from` keeps its burn: destroy it from the next step on (fwWorld_DestroyLater waits for that), or hide it and put it out. Bit by bit the same on every
 * backend, in logs, timelines and networks. Refused: unless both have heat or both FW_BURNABLE_LITE; with
 * FW_BURNABLE_PUBLISHED; while either plays a baked burn or is part of another transfer; where less than half of `to` has
 * such a texel (FW_ERROR_BAD_DATA). [world] */
FW_API FwResult FW_CALL fwWorld_TransferBurn(FwWorld*, FwBurnableMeshId from, FwBurnableMeshId to);

/* ---- volumetric fires: flames without fuel ----------------------------------------------------------------- */

typedef enum FwFirePreset {
    FW_FIRE_CAMP = 0, FW_FIRE_CANDLE = 1, FW_FIRE_TORCH = 2, FW_FIRE_BONFIRE = 3, FW_FIRE_HOUSE = 4,
    FW_FIRE_GAS_BURNER = 5, FW_FIRE_MAGIC_BLUE = 6, FW_FIRE_MAGIC_GREEN = 7, FW_FIRE_DYING_EMBERS = 8,
    FW_FIRE_PRESET_COUNT = 9, FW_FIRE_PRESET_FORCE32 = 0x7fffffff
} FwFirePreset;
typedef enum FwVolumetricFireFlags {
    FW_FIRE_HIDDEN = 1,   /* not drawn, and no light; time passes for it */
    FW_FIRE_NO_SMOKE = 2,
    FW_FIRE_NO_LIGHT = 4, /* fwWorld_GetLights does not name it */
    FW_FIRE_NO_COLLISION = 8, /* goes through colliders and blockers */
    FW_FIRE_IGNITES = 16, /* lights burnable meshes that it touches for long enough, see below */
    FW_FIRE_FLAGS_FORCE32 = 0x7fffffff
} FwVolumetricFireFlags;
typedef enum FwFireTier { /* how a view shows it: the view that RecordOutside gets; others march what they show */
    FW_FIRE_TIER_AUTO = 0,       /* by its size on the screen; 32 flames are marched at most, the 16 largest high */
    FW_FIRE_TIER_MARCH_HIGH = 1, /* each frame, up to 64 samples a ray. Of one that asks for it rays that meet little
                                    flame take more than AUTO lets them: its thin tongues show the least grain,
                                    and it costs half as much again */
    FW_FIRE_TIER_MARCH_LOW = 2,  /* each frame, two thirds of them */
    FW_FIRE_TIER_IMPOSTOR = 3,   /* a card that faces the camera, up to 24 cells across the flame: marched as those
                                    are, but twelve in a frame, in turn, however many there are. Meant for flames
                                    of less than 13 px across */
    FW_FIRE_TIER_SLICES = 4,     /* planes across the view through the flame's lattice, a sample each: the published
                                    method, of use where little else may run before the pass. Layers may show.
                                    Where we tone map (FwOutputEncoding other than FW_OUTPUT_LINEAR) they would add
                                    up wrongly: there it is marched, low */
    FW_FIRE_TIER_FLIPBOOK = 5,   /* a card as those are, of pages that flames alike share: of one of them a page is
                                    marched in each frame, and the last 32 are a book. Each shows them up to 22
                                    frames late, half of them mirrored, as wide, high and leaning as it is itself.
                                    Alike: of the same look, nearly as wide, as high for that, and seen as steeply,
                                    with nothing in their way. There are 4 books; until one is whole, and where
                                    there is none, it is a card of its own. AUTO takes it for flames alike of 10
                                    to 24 px across, and of any size for those beyond the 32 */
    FW_FIRE_TIER_FORCE32 = 0x7fffffff
} FwFireTier;
typedef struct FwFirePoint { /* of the line that a flame follows, its base first */
    float position[3];       /* m, world, within +-1e6 */
    float radius;            /* m, [0, 100], of the tube that burns there */
} FwFirePoint;
/* A flame as high as its power and width make it (Heskestad), pulsing at its own rate. Its gas rises, leans in
 * the wind, trails behind a motion, flows around colliders and blockers; fires near each other lean together,
 * and as one they are taller. Too little power for its width burns as many small flames. Floats, for the eye:
 * no two machines need agree on them. Only FW_FIRE_IGNITES changes what burns: eight times a second each burnable
 * mesh within the flame, as position, diameter, power, windResponse and the world's wind make it (or within
 * radius of the points), counts how long it has been there; after its material's ignition time under 35 kW/m^2,
 * at the world's pace, what the flame covers catches. Factors multiply what the preset says. */
typedef struct FwVolumetricFireDef {
    uint32_t structSize, flags; /* FwVolumetricFireFlags */
    uint32_t preset;            /* FwFirePreset: its look; size and power are below */
    uint32_t seed;              /* of its shapes; 0: another one for each fire of a world */
    float position[3];          /* m, world: the middle of its base */
    float diameter;             /* m, of its base, [0.002, 20]; default 0.6 */
    float power;                /* kW, [0, 100000]; 0: out. Default 60 */
    float windResponse;         /* [0, 4], default 1 */
    float turbulence;           /* factor, [0, 3]: how torn it is; default 1 */
    float speed;                /* factor, [0, 4]: of everything that moves in it; default 1 */
    float density;              /* factor, [0, 10]: how hard it is to see through; default 1 */
    float smoke;                /* factor, [0, 10]; default 1 */
    float blue;                 /* factor, [0, 10]: of the blue at its foot; default 1 */
    float tint[3];              /* linear colour it takes instead of a hot body's, [0, 1] */
    float tintWeight;           /* [0, 1]; default 0: as the preset has it */
    uint32_t pointCount;        /* 0: it rises by itself; [2, 32]: it follows the points, as high as their
                                   line is long and as wide as the first of them; in no wind */
    const FwFirePoint* points;
    uint64_t userData;          /* comes back in its state */
    FwFireProfileId profile;    /* null: the preset's */
    float blend;                /* s, [0, 60]: from its own way to points or a track, and back; default 0.3 */
    uint32_t tier;              /* FwFireTier; default FW_FIRE_TIER_AUTO */
    float coreTint[3];          /* linear colour of its hottest gas, [0, 1], where tintWeight is not 0: from there
                                   it goes over into tint as it gets cooler */
    float coreTintWeight;       /* [0, 1]; default 0: a paler tint */
} FwVolumetricFireDef;
static inline FwVolumetricFireDef fwDefaultVolumetricFireDef(void) {
    FwVolumetricFireDef d; fwInitDef(FW_DEF_VOLUMETRIC_FIRE, &d, (uint32_t)sizeof d); return d;
}
/* Sets preset, diameter (in metres: see fwWorld_ConvertDef) and power of a whole def, whose structSize is set; the rest
 * stays. [any] */
FW_API FwResult FW_CALL fwInitFirePreset(FwVolumetricFireDef* def, uint32_t preset);
FW_API const char* FW_CALL fwFirePresetName(uint32_t preset); /* static, never null [any] */
/* At most 256 at a time in a world, as at most 256 flames. [world] */
FW_API FwResult FW_CALL fwWorld_CreateVolumetricFire(FwWorld*, const FwVolumetricFireDef* def, FwVolumetricFireId* id);
FW_API FwResult FW_CALL fwWorld_DestroyVolumetricFire(FwWorld*, FwVolumetricFireId id); /* [world] */
/* Where its base is from the next frame on; it trails behind a motion. Beyond 100 m/s it was put there: the whole flame
 * stands there at once as it stood before. [world] */
FW_API FwResult FW_CALL fwWorld_MoveVolumetricFire(FwWorld*, FwVolumetricFireId id, const float position[3]);
/* kW; the flame follows within a second. [world] */
FW_API FwResult FW_CALL fwWorld_SetVolumetricFirePower(FwWorld*, FwVolumetricFireId id, float power);
/* As FwVolumetricFireDef::points; 0: it rises by itself again. [world] */
FW_API FwResult FW_CALL fwWorld_SetVolumetricFirePoints(FwWorld*, FwVolumetricFireId id, const FwFirePoint* points,
                                                        uint32_t pointCount);
FW_API FwResult FW_CALL fwWorld_SetVolumetricFireHidden(FwWorld*, FwVolumetricFireId id, uint32_t hidden); /* [world] */
/* FwFireTier, as FwVolumetricFireDef::tier; views go over to it within 16 frames. [world] */
FW_API FwResult FW_CALL fwWorld_SetVolumetricFireTier(FwWorld*, FwVolumetricFireId id, uint32_t tier);

typedef struct FwVolumetricFireState { /* as of the last frame; before its first one as it is about to be */
    uint32_t structSize, flames; /* flames it burns as; 0: out */
    uint64_t userData;
    float power;                /* kW, now */
    float height;               /* m, mean of what is seen of it */
    float pulseRate;            /* Hz */
    float contactPower;         /* kW that go into colliders and blockers in its way, the mean of a pulse */
    float boundsLow[3], boundsHigh[3]; /* m, world: of all that shows, smoke too; empty while it is out */
    float tip[3];               /* m, world: where its mean height ends */
    float lightPosition[3];     /* m, world */
    float lightIntensity;       /* W/sr of the visible part, flickering */
    float contact[3];           /* m, world: the middle of what it touches; of use where contactPower > 0 */
} FwVolumetricFireState;
FW_API FwResult FW_CALL fwWorld_GetVolumetricFireState(FwWorld*, FwVolumetricFireId id, FwVolumetricFireState* state); /* [world] */

/* A script of a fire: keys of its line, smooth between them. */
typedef struct FwFireTrackDef {
    uint32_t structSize, flags; /* FwFireTrackFlags */
    uint32_t keyCount;          /* [1, 4096] */
    uint32_t pointsPerKey;      /* [2, 32] */
    const float* times;         /* s, keyCount of them, increasing */
    const FwFirePoint* points;  /* key after key; from the fire's position, m, world axes. Copied */
    float weight;               /* [0, 1]: of the script; the rest is the fire's own motion. Default 1 */
    uint32_t reserved;          /* 0 */
} FwFireTrackDef;
typedef enum FwFireTrackFlags {
    FW_FIRE_TRACK_LOOP = 1, /* the last key is the first again; without it the last stays */
    FW_FIRE_TRACK_FLAGS_FORCE32 = 0x7fffffff
} FwFireTrackFlags;
static inline FwFireTrackDef fwDefaultFireTrackDef(void) {
    FwFireTrackDef d; fwInitDef(FW_DEF_FIRE_TRACK, &d, (uint32_t)sizeof d); return d;
}
/* Plays from the first key on, instead of points; blends in and out within FwVolumetricFireDef::blend. Null:
 * back to the fire's own motion (or its points). [world] */
FW_API FwResult FW_CALL fwWorld_SetVolumetricFireTrack(FwWorld*, FwVolumetricFireId id, const FwFireTrackDef* def);

/* What burns where in a flame, as an artist paints it: over the radius (x, from the axis to 1.25 radii) and the
 * height (y, base row first). Either texels or a cooked .fwprofile. */
typedef struct FwFireProfileDef {
    uint32_t structSize, flags; /* flags: 0 */
    uint32_t width, height;     /* of texels, each [8, 512]; resampled to 64 x 128 */
    const float* texels;        /* 2 each: K, [0, 3000]; soot, [0, 2]. Below 1000 K soot does not glow: K / 1000
                                   is then how much clean gas burns (blue) */
    const void* cooked;         /* then texels are not read */
    uint64_t cookedSize;        /* bytes */
} FwFireProfileDef;
static inline FwFireProfileDef fwDefaultFireProfileDef(void) {
    FwFireProfileDef d; fwInitDef(FW_DEF_FIRE_PROFILE, &d, (uint32_t)sizeof d); return d;
}
/* At most 23 at a time. [world] */
FW_API FwResult FW_CALL fwWorld_CreateFireProfile(FwWorld*, const FwFireProfileDef* def, FwFireProfileId* id);
FW_API FwResult FW_CALL fwWorld_DestroyFireProfile(FwWorld*, FwFireProfileId id); /* refused while a fire uses it [world] */
/* To .fwprofile bytes; buffer and size as in fwCookMesh. [any] */
FW_API FwResult FW_CALL fwCookFireProfile(FwContext* context, const FwFireProfileDef* def, void* buffer, uint64_t* size);

typedef enum FwFireColliderKind {
    FW_COLLIDER_SPHERE = 0, FW_COLLIDER_CAPSULE = 1, FW_COLLIDER_BOX = 2, FW_COLLIDER_PLANE = 3,
    FW_COLLIDER_HEIGHT_FIELD = 4, FW_COLLIDER_DISTANCE = 5,
    FW_COLLIDER_DEPTH = 6, /* a picture of the scene's depth: what it shows bends and flattens flames, and so does the
                              underside of a slab whose top it shows, and the room below (for worlds whose up is
                              0,1,0); what else it does not show does not. Only that: it shades nothing and stops no
                              jet, so no pixel of it changes what burns */
    FW_COLLIDER_KIND_FORCE32 = 0x7fffffff
} FwFireColliderKind;
typedef struct FwFireColliderDef { /* what flames flow around, beside the world's blockers; cosmetic */
    uint32_t structSize;
    uint32_t kind;         /* FwFireColliderKind */
    float position[3];     /* m, world: middle; one end of a capsule; a point of a plane; corner of a height field
                              where x and z are lowest */
    float end[3];          /* m, world: the other end of a capsule */
    float normal[3];       /* of a plane, towards the free side; default 0,1,0 */
    float halfSize[3];     /* m, of a box, > 0; default 0.5 */
    float rotation[4];     /* of a box: unit quaternion x, y, z, w; default 0,0,0,1 */
    float radius;          /* m, > 0: sphere, capsule; of a picture of depth [0.01, 100]: how far around flames it is
                              looked at, and a tenth of it how thick it takes things to be; default 0.5 */
    float cellSize;        /* m, > 0: between two heights; default 1 */
    uint32_t columns, rows;/* heights along x and z, each [2, 4096]; of a picture of depth each [2, 512] */
    const float* heights;  /* m above position, row after row along x; for worlds whose up is 0,1,0. Copied */
    /* Signed distance in m, and its unit normal, for FW_COLLIDER_DISTANCE. Called by the thread that steps or
     * records the world, many times; it calls nothing of the world. What is not finite is far away. */
    float (FW_CALL* distance)(void* distanceData, const float point[3], float normal[3]);
    void* distanceData;
    const float* depths;   /* FW_COLLIDER_DEPTH: [0, 1], clip z over w in each middle, row after row, top first. Small
                              is enough (160 x 90), and so is one that is some frames old, as read back. Copied */
    float view[16], projection[16]; /* that it was drawn with, as FwView's; default identity */
} FwFireColliderDef;
static inline FwFireColliderDef fwDefaultFireColliderDef(void) {
    FwFireColliderDef d; fwInitDef(FW_DEF_FIRE_COLLIDER, &d, (uint32_t)sizeof d); return d;
}
/* At most 64 at a time. [world] */
FW_API FwResult FW_CALL fwWorld_AddFireCollider(FwWorld*, const FwFireColliderDef* def, FwFireColliderId* id);
/* Another shape or place, from the next frame on. A height field whose heights are null, with as many columns and
 * rows as before, keeps them. [world] */
FW_API FwResult FW_CALL fwWorld_SetFireCollider(FwWorld*, FwFireColliderId id, const FwFireColliderDef* def);
FW_API FwResult FW_CALL fwWorld_RemoveFireCollider(FwWorld*, FwFireColliderId id); /* [world] */

typedef struct FwFireAnswer {   /* of all volumetric fires at a point, as of the last frame */
    uint32_t structSize;
    uint32_t inside;            /* 1: within a flame, on the mean */
    float temperature;          /* K of the gas there; 293 where no fire reaches */
    float heatFlux;             /* W/m^2 on a small cold body there, by gas and radiation; walls around it shade it */
    float gas[3];               /* m/s: how the fire's gas moves there, without the wind */
    uint32_t reserved;
    FwVolumetricFireId fire;    /* that heats it most; null: none does */
} FwFireAnswer;
/* At once, on every backend. [world] */
FW_API FwResult FW_CALL fwWorld_AskVolumetricFires(FwWorld*, const float point[3], FwFireAnswer* answer);
typedef struct FwFirePush {     /* on a ball that stands still */
    uint32_t structSize;
    float ignitionPower;        /* W into it */
    float force[3];             /* N */
    uint32_t reserved;
} FwFirePush;
/* radius: m, [0, 100]. [world] */
FW_API FwResult FW_CALL fwWorld_GetVolumetricFirePush(FwWorld*, const float centre[3], float radius, FwFirePush* push);

/* ---- flipbooks: what particles and flames show --------------------------------------------------------------- */

typedef enum FwFlipbookPreset { /* our own, baked from our own flames: 64 x 64 texels a frame, sparks 32 x 32 */
    FW_FLIPBOOK_CUSTOM = 0,  /* FwFlipbookDef::cooked */
    FW_FLIPBOOK_FLAME = 1,   /* fire: a standing flame, a loop of 1.6 s */
    FW_FLIPBOOK_ROLL = 2,    /* fire: a ball that rolls up about a ring and is torn */
    FW_FLIPBOOK_PUFF = 3,    /* fire: a ball that eddies tear */
    FW_FLIPBOOK_SMOKE = 4,   /* smoke: thick, in billows */
    FW_FLIPBOOK_HAZE = 5,    /* smoke: thin, drawn out */
    FW_FLIPBOOK_SPARK = 6,   /* sparks: a streak */
    FW_FLIPBOOK_PRESET_COUNT = 7, FW_FLIPBOOK_PRESET_FORCE32 = 0x7fffffff
} FwFlipbookPreset;
/* Frames of fire, smoke or sparks with the motion between them: what moves between two frames is seen once, on its
 * way, not twice beside itself. Temperatures, not colours: black bodies colour them as they do volumetric flames. */
typedef struct FwFlipbookDef {
    uint32_t structSize, flags; /* flags: 0 */
    uint32_t preset;            /* FwFlipbookPreset, default FW_FLIPBOOK_CUSTOM */
    uint32_t reserved;          /* 0 */
    const void* cooked;         /* content of a .fwbook (flamewright_flipbook bakes them); null with a preset */
    uint64_t cookedSize;        /* bytes */
} FwFlipbookDef;
static inline FwFlipbookDef fwDefaultFlipbookDef(void) {
    FwFlipbookDef d; fwInitDef(FW_DEF_FLIPBOOK, &d, (uint32_t)sizeof d); return d;
}
/* At most 32 at a time; all of a world's lie in one picture of at most 4096 x 4096 texels (else
 * FW_ERROR_OUT_OF_MEMORY). FW_ERROR_BAD_DATA, FW_ERROR_VERSION: what is wrong with the file. [world] */
FW_API FwResult FW_CALL fwWorld_CreateFlipbook(FwWorld*, const FwFlipbookDef* def, FwFlipbookId* id);
FW_API FwResult FW_CALL fwWorld_DestroyFlipbook(FwWorld*, FwFlipbookId id); /* refused while something shows it [world] */
/* What the flames and the smoke of burning meshes show from the next frame on; null: as they are made without, by
 * noise. Books of fire and of smoke. [world] */
FW_API FwResult FW_CALL fwWorld_SetFlameFlipbooks(FwWorld*, FwFlipbookId fire, FwFlipbookId smoke);

/* ---- fire emitters: particles ------------------------------------------------------------------------------- */

typedef enum FwEmitterShape {
    FW_EMITTER_POINT = 0,
    FW_EMITTER_DISC = 1,  /* across direction, of radius */
    FW_EMITTER_LINE = 2,  /* from position - extent to position + extent */
    FW_EMITTER_MESH = 3,  /* on the tiles of `object` that flame, each as likely as it has power. At `power` or more
                             all its particles are there, at less as many fewer at once, which rise slower and burn
                             shorter, by power to the 0.2: flames as high as so much power has. Its light is the
                             mesh's */
    FW_EMITTER_SHAPE_FORCE32 = 0x7fffffff
} FwEmitterShape;
typedef enum FwEmitterFlags {
    FW_EMITTER_HIDDEN = 1,   /* not drawn, and no light; time passes for it */
    FW_EMITTER_NO_SMOKE = 2,
    FW_EMITTER_NO_LIGHT = 4, /* fwWorld_GetLights does not name it */
    FW_EMITTER_GROUND = 8,   /* nothing of it goes below ground: it spreads out there */
    FW_EMITTER_JET = 16,     /* a pressurised stream along direction that tears into flame, instead of a fire
                                that rises: a flamethrower. Colliders (fwWorld_AddFireCollider), blockers and
                                burnable meshes stop it: it splashes there, and nothing behind is reached */
    FW_EMITTER_IGNITES = 32, /* of a jet: heats the burnable meshes that it strikes, until they catch */
    FW_EMITTER_NO_COLLISION = 64, /* of a jet: nothing stops it */
    FW_EMITTER_FLAGS_FORCE32 = 0x7fffffff
} FwEmitterFlags;
/* Fire, the smoke it becomes and sparks, of particles that live in the world: large soft quads, simulated and
 * drawn on the device. The CPU's work is that of an emitter, however many particles it has. Floats, for the eye.
 * Power drives it: what is 0 below is as a fire of that power has it. */
typedef struct FwFireEmitterDef {
    uint32_t structSize, flags; /* FwEmitterFlags */
    uint32_t shape;             /* FwEmitterShape, default FW_EMITTER_POINT */
    uint32_t seed;              /* 0: another one for each emitter of a world */
    float position[3];          /* m, world */
    float direction[3];         /* of its particles at birth; any length but 0. Default 0,1,0 */
    float extent[3];            /* m, within +-100; of FW_EMITTER_LINE */
    float radius;               /* m, [0, 50], of FW_EMITTER_DISC */
    float power;                /* kW, [0, 100000]; 0: nothing is born. Default 60 */
    float rate;                 /* births a second, [0, 200000] */
    float speed;                /* m/s, [0, 200] */
    float cone;                 /* rad, [0, 2]: how far they stray from direction, two thirds of them */
    float size0, size1;         /* m, [0, 50]: width at birth, and when the fire ends */
    float life;                 /* s, [0, 60]: of the fire; smoke comes after it */
    float lifeVariance;         /* share, [0, 1], default 0.33 */
    float drag;                 /* s, [0, 60]: in which a particle takes on the speed of the air */
    float buoyancy;             /* factor, [-4, 4], default 1 */
    float windResponse;         /* factor, [0, 4], default 1 */
    float turbulence;           /* factor, [0, 4], default 1 */
    float inherit;              /* share of the emitter's own motion that particles get, [0, 1], default 0.5 */
    float smoke;                /* share of the particles that turn to smoke, [0, 1], default 0.32 */
    float smokeLife;            /* in lives of the fire, [0, 20], default 2.2 */
    float smokeDensity;         /* factor, [0, 4], default 1 */
    float sparks;               /* sparks and embers a second for each kW, [0, 1], default 0.04; 2048 at a time are
                                   the most. They fly up to 2.5 s, bounce off the ground and a jet's wall, rest and go
                                   out; of FW_EMITTER_MESH each tile throws its own */
    float temperature;          /* K at birth, [0, 2500] */
    float ground;               /* m along up, with FW_EMITTER_GROUND; default 0 */
    uint32_t maxParticles;      /* [0, 1048576], 0: as many as it needs at this power. The oldest make room */
    uint32_t reserved;          /* 0 */
    uint64_t userData;          /* comes back in its state */
    /* Of a jet: it is swept, by 16 rays over its cone, from `behind` its nozzle on, where its holder stands: a
     * nozzle that is pushed into a wall or through it burns that wall, not the room beyond. Of its power the
     * share `heat` goes into what it strikes, all of it, spread over where: eight times a second, when the stream
     * has flown there (a wall that comes between is met), by the host's numbers alone, the same on every backend.
     * It comes through holes: those of a mesh's shape, and those that have burnt, as long as FwBurnableMeshDef lets
     * holes burn and no two walls more are in the way; not those of FW_BURNABLE_LITE, nor to what is that. */
    float behind;               /* m, [0, 10], default 0.5 */
    float heat;                 /* [0, 1], default 0.35 */
    /* What its particles show, each by chance one of those given, at its own phase; none given: noise. */
    FwFlipbookId fireBooks[3];
    FwFlipbookId smokeBooks[2];
    FwFlipbookId sparkBook;
    FwBurnableMeshId object;    /* of FW_EMITTER_MESH; once it is gone nothing more is born */
    /* Of a jet with FW_EMITTER_IGNITES: fuel that sticks. Of the power that strikes something the share `stick` stays
     * there as fuel, in at most 16 places 0.25 m wide, and burns on evenly over stickTime from the last that came: it
     * flames, and heats the mesh it sticks to with that power, counted in integers, none lost. Fuel that finds no room
     * heats at once, and so does all that strikes what may have burnt through by then. Water (FW_WET) takes 2600 J a gram that falls
     * on it from its fuel; FW_EXTINGUISH takes all. */
    float stick;                /* [0, 1], default 0 */
    float stickTime;            /* s, [0.125, 120], in eighths of a second; default 6 */
} FwFireEmitterDef;
static inline FwFireEmitterDef fwDefaultFireEmitterDef(void) {
    FwFireEmitterDef d; fwInitDef(FW_DEF_FIRE_EMITTER, &d, (uint32_t)sizeof d); return d;
}
/* At most 256 at a time in a world, and FwWorldDef::maxParticles. [world] */
FW_API FwResult FW_CALL fwWorld_CreateFireEmitter(FwWorld*, const FwFireEmitterDef* def, FwFireEmitterId* id);
/* Its particles go with it; to let them burn out set its power to 0 and wait. [world] */
FW_API FwResult FW_CALL fwWorld_DestroyFireEmitter(FwWorld*, FwFireEmitterId id);
/* Where it is from the next frame on, having come there straight: births lie along the way, unless that is farther
 * than 100 m/s allow. direction null: as before. [world] */
FW_API FwResult FW_CALL fwWorld_MoveFireEmitter(FwWorld*, FwFireEmitterId id, const float position[3],
                                                const float* direction);
/* kW. No more particles than it was created with; create it with the most power it will have. [world] */
FW_API FwResult FW_CALL fwWorld_SetFireEmitterPower(FwWorld*, FwFireEmitterId id, float power);
FW_API FwResult FW_CALL fwWorld_SetFireEmitterHidden(FwWorld*, FwFireEmitterId id, uint32_t hidden); /* [world] */
typedef struct FwFireEmitterState { /* as of the last frame */
    uint32_t structSize, particles; /* that may still show; 0: nothing is left of it */
    uint32_t capacity, reserved;    /* the most it may have */
    uint64_t userData;
    float power;                /* kW */
    float rate, life, speed;    /* 1/s, s, m/s: as it has them now */
    float reach;                /* m that its fire comes, about */
    float lightIntensity;       /* W/sr of the visible part, flickering */
    float lightPosition[3];     /* m, world */
    uint32_t struck;            /* of a jet: rays of 16 that something stopped */
    float freeWay;              /* m from its nozzle to the nearest of it, 0: right there; else reach */
    float heated;               /* W that reached burnable meshes in the last eighth of a second */
    float stuckFuel;            /* kJ of fuel that sticks somewhere */
    float stuckPower;           /* kW that it gave in the last eighth of a second, to meshes or not */
    uint32_t stuckPlaces;       /* [0, 16] */
    uint32_t reserved1;
} FwFireEmitterState;
FW_API FwResult FW_CALL fwWorld_GetFireEmitterState(FwWorld*, FwFireEmitterId id, FwFireEmitterState* state); /* [world] */

/* ---- particle fields: fire, smoke and water by the cell, for small devices and for what is far away ---------- */

typedef enum FwFieldPreset {
    FW_FIELD_FIRE = 0, FW_FIELD_SMOKE = 1, FW_FIELD_WATER = 2, FW_FIELD_PRESET_COUNT = 3,
    FW_FIELD_PRESET_FORCE32 = 0x7fffffff
} FwFieldPreset;
typedef enum FwFieldShape {       /* what it is drawn on */
    FW_FIELD_CARD = 0,            /* turns about its up axis to face the eye */
    FW_FIELD_SPHEROID = 1,        /* its left and right border meet */
    FW_FIELD_DISPLACED = 2,       /* the same, bulging where it is dense */
    FW_FIELD_SHAPE_FORCE32 = 0x7fffffff
} FwFieldShape;
typedef enum FwFieldSource {
    FW_FIELD_SOURCE_BASE = 0,     /* the lowest rows, of what falls the highest */
    FW_FIELD_SOURCE_DISC = 1,
    FW_FIELD_SOURCE_PAINTED = 2,  /* paint */
    FW_FIELD_SOURCE_FORCE32 = 0x7fffffff
} FwFieldSource;
typedef enum FwFieldOpen {        /* borders over which particles leave; the others are walls */
    FW_FIELD_OPEN_LEFT = 1, FW_FIELD_OPEN_RIGHT = 2, FW_FIELD_OPEN_BOTTOM = 4, FW_FIELD_OPEN_TOP = 8,
    FW_FIELD_OPEN_FORCE32 = 0x7fffffff
} FwFieldOpen;
typedef enum FwParticleFieldFlags {
    FW_FIELD_HIDDEN = 1,          /* not drawn; time passes for it */
    FW_FIELD_AS_PUBLISHED = 2,    /* ten steps a second, and shown as they are */
    FW_FIELD_WETS = 4,            /* of water: wets the burnable meshes that it touches, and so puts them out: eight
                                     times a second, by what is in its cells, the same on every backend. Where cells
                                     are full that is 320 g/m^2 in a second. A card counts as a sheet across its own
                                     x axis, however it turns to the eye. It costs a step of the CPU's for each of
                                     the field's */
    FW_FIELD_FLAGS_FORCE32 = 0x7fffffff
} FwParticleFieldFlags;
/* Particles counted in cells, in integers: none is lost or made but by a source, by the end of its life and over
 * open borders, and every backend counts the same. Steps are at fixed times of the world. */
typedef struct FwParticleFieldDef {
    uint32_t structSize, flags; /* FwParticleFieldFlags */
    uint32_t shape;             /* FwFieldShape */
    uint32_t seed;              /* 0: another one for each field of a world */
    float position[3];          /* m, world: the middle of its lower edge; of a spheroid its lowest point */
    float size[3];              /* m: width, height, and of a spheroid depth, (0, 1000]; default 1 */
    float rotation[4];          /* unit quaternion x, y, z, w; default 0,0,0,1 */
    uint32_t width, height;     /* cells, each [32, 256], the width in fours; default 64 */
    uint32_t stepRate;          /* steps a second, [20, 30]; default 24 */
    uint32_t open;              /* FwFieldOpen; default all but the bottom. Spheroids: top and bottom count */
    /* What it is: eight numbers, the same for fire, smoke and water; see fwInitFieldPreset. */
    float amount;               /* of its source, [0, 4]; at 1 a cell there is full after 12 steps */
    float rise;                 /* cells a step, [-4, 4], upwards; below 0 it falls */
    float spread;               /* [0, 1]: how fast differences even out */
    float memory;               /* [0, 1]: how much of its motion a particle keeps */
    float chaos;                /* [0, 4]: of eddies */
    float life;                 /* s, mean, [0.05, 1000] */
    float detail;               /* [0, 1]: fine structure that it is drawn with */
    float body;                 /* 0 emits light, 1 absorbs it, 2 refracts it; [0, 2] */
    float windResponse;         /* cells a step for each m/s of wind along its width, [0, 4]; default 0.12; rings: none */
    uint32_t source;            /* FwFieldSource */
    float sourceSize;           /* of a base: share of the width; of a disc its diameter, share of the smaller side;
                                   (0, 1] */
    float sourceAt[2];          /* of a disc: its middle, shares of width and height, [0, 1]; default 0.5, 0.2 */
    uint32_t reserved;          /* 0 */
    /* Bytes of width x height cells, rows from the bottom; null: none. Copied. */
    const uint8_t* paint;       /* how much of the source's rate each cell has, 255: all */
    const uint8_t* walls;       /* not 0: nothing is there, nothing goes there */
    float tint[3];              /* linear, [0, 10]; default 1 */
    float opacity;              /* factor, [0, 10]; default 1 */
    uint64_t userData;          /* comes back in its state */
} FwParticleFieldDef;
static inline FwParticleFieldDef fwDefaultParticleFieldDef(void) { /* a fire on a card */
    FwParticleFieldDef d; fwInitDef(FW_DEF_PARTICLE_FIELD, &d, (uint32_t)sizeof d); return d;
}
/* Sets the eight numbers and sourceSize of a whole def, whose structSize is set; the rest stays. [any] */
FW_API FwResult FW_CALL fwInitFieldPreset(FwParticleFieldDef* def, uint32_t preset);
FW_API const char* FW_CALL fwFieldPresetName(uint32_t preset); /* static, never null [any] */
/* Empty at first. At most 256 at a time in a world. [world] */
FW_API FwResult FW_CALL fwWorld_CreateParticleField(FwWorld*, const FwParticleFieldDef* def, FwParticleFieldId* id);
FW_API FwResult FW_CALL fwWorld_DestroyParticleField(FwWorld*, FwParticleFieldId id); /* [world] */
/* Rotation: null: as before. [world] */
FW_API FwResult FW_CALL fwWorld_MoveParticleField(FwWorld*, FwParticleFieldId id, const float position[3],
                                                  const float rotation[4]);
FW_API FwResult FW_CALL fwWorld_SetParticleFieldAmount(FwWorld*, FwParticleFieldId id, float amount); /* [world] */
FW_API FwResult FW_CALL fwWorld_SetParticleFieldHidden(FwWorld*, FwParticleFieldId id, uint32_t hidden); /* [world] */
/* Other bytes as in the def; null: as before. What is where a wall comes dies. [world] */
FW_API FwResult FW_CALL fwWorld_PaintParticleField(FwWorld*, FwParticleFieldId id, const uint8_t* paint,
                                                   const uint8_t* walls);
typedef struct FwParticleFieldState { /* as of `frameIndex`: 2 to 3 frames ago on a GPU, now on the cpu */
    uint32_t structSize, reserved;
    uint64_t userData;
    uint64_t frameIndex;
    uint64_t inside;            /* particles; inside + dead + out = emitted, always */
    uint64_t emitted, dead, out;/* since it was created */
    uint64_t steps;
    uint64_t bytes;             /* of the backend's memory for it */
} FwParticleFieldState;
FW_API FwResult FW_CALL fwWorld_GetParticleFieldState(FwWorld*, FwParticleFieldId id, FwParticleFieldState* state); /* [world] */

/* ---- running ---------------------------------------------------------------------------------------------- */

/* Advances the simulation by deltaTime s, [0, 10]. cpu backend: at once. Own device: submits and
 * waits. Lent device: use fwWorld_RecordOutside instead (FW_ERROR_WRONG_BACKEND). A world simulates
 * at most 1048560 s (12 days, a warning comes a day before); then it refuses more time. [world] */
FW_API FwResult FW_CALL fwWorld_Step(FwWorld*, float deltaTime);

typedef struct FwView { /* what a camera and its light are; all lengths m */
    uint32_t structSize, flags;       /* 0 */
    float view[16], projection[16];   /* world to view space, rigid; view to Vulkan clip space: y down, depth 0..1.
                                         From another clip space: fwConvertProjection */
    float sunDirection[3];            /* towards the sun, unit */
    float sunColor[3];                /* radiance x pi/2 into a Lambert/pi surface; cd/m^2-like */
    float ambientSky[3], ambientGround[3]; /* hemisphere about world up */
    float exposure;                   /* times all light, before any tone mapping; [1e-6, 1e6], default 1 */
    float emissionScale;              /* of glow and flames against the scene's light, default 1 */
    float time;                       /* s, for flicker and breathing only */
    float haze;                       /* how far heat haze bends what is behind a fire, where a target has it
                                         (FW_TARGET_HAZE): [0, 8], default 1, 0 none */
    uint32_t viewId;                  /* of the views of a frame, see fwWorld_RecordOutsideViews: any number that stays
                                         with its camera from frame to frame, default 0. With one view a frame leave it */
    float reserved;
} FwView;
static inline FwView fwDefaultView(void) {
    FwView d; fwInitDef(FW_DEF_VIEW, &d, (uint32_t)sizeof d); return d;
}
typedef enum FwClipSpace { /* how a host's clip space differs from Vulkan's, for fwConvertProjection */
    FW_CLIP_Y_UP = 1,           /* y of clip space points up: Direct3D, Metal, WebGPU, Unreal */
    FW_CLIP_SYMMETRIC_DEPTH = 2,/* depth is -1..1 instead of 0..1 */
    FW_CLIP_OPENGL = 3,         /* both: OpenGL, Qt, glm without GLM_FORCE_DEPTH_ZERO_TO_ONE */
    FW_CLIP_REVERSE_DEPTH = 4,  /* turns the direction of depth: the matrix has near at 0 and the depth buffer at 1, or the
                                   other way. A matrix that is reversed already needs FwVulkanTargetDef::reversedDepth alone */
    FW_CLIP_SPACE_FORCE32 = 0x7fffffff
} FwClipSpace;
/* Turns the projection of a host's, in place, into one of Vulkan's clip space. clipSpace: FwClipSpace bits, 0: nothing
 * changes. The same points stay at the same pixel and the same depth of the depth buffer. [any] */
static inline void fwConvertProjection(float projection[16], uint32_t clipSpace) {
    for (int c = 0; c < 16; c += 4) {
        if (clipSpace & FW_CLIP_Y_UP) projection[c + 1] = -projection[c + 1];
        if (clipSpace & FW_CLIP_SYMMETRIC_DEPTH) projection[c + 2] = 0.5f * (projection[c + 2] + projection[c + 3]);
        if (clipSpace & FW_CLIP_REVERSE_DEPTH) projection[c + 2] = projection[c + 3] - projection[c + 2];
    }
}

typedef struct FwOffscreenDef { /* own device only: the smallest way to a picture */
    uint32_t structSize, width, height, reserved; /* pixels, [1, 8192] */
    FwView view;
    float background[4];              /* linear */
    void* pixels;                     /* out: RGBA8 sRGB, rows top first, width*height*4 bytes */
} FwOffscreenDef;
static inline FwOffscreenDef fwDefaultOffscreenDef(void) {
    FwOffscreenDef d; fwInitDef(FW_DEF_OFFSCREEN, &d, (uint32_t)sizeof d); return d;
}
/* Renders the world and waits for it. [world] */
FW_API FwResult FW_CALL fwWorld_RenderOffscreen(FwWorld*, const FwOffscreenDef* def);

/* ---- what a game asks ---------------------------------------------------------------------------------------- */

typedef enum FwEventType {
    FW_EVENT_IGNITED = 1,       /* the object's first texel burns; value: s since world start */
    FW_EVENT_BURNT_OUT = 2,     /* nothing of it burns or waits to burn: its last flames used up their fuel;
                                   value: burnt fraction */
    FW_EVENT_EXTINGUISHED = 3,  /* nothing of it burns or waits to burn, but its last flames went out with fuel
                                   left; tag: FwExtinguishCause; value: burnt fraction */
    FW_EVENT_TAG_REACHED = 4,   /* the front reached a tagged point; value: s since world start */
    FW_EVENT_FRONT_LIMITED = 5, /* many arrivals come late: the front is faster than 8 substeps
                                   can follow; value: how many since the last such event */
    FW_EVENT_TIME_DROPPED = 6,  /* more steps were due than maxStepsPerFrame; value: s dropped */
    FW_EVENT_SPREAD_TO = 7,     /* `object` was lit by `other`; tag: jumps since the first fire; value: s
                                   since world start; position: of `object`'s box's middle */
    FW_EVENT_SPOT_FIRE = 8,     /* an ember lit `object`; position: there; value: how many since the last */
    FW_EVENT_WENT_LIVE = 9,     /* the baked burn that `object` played is over, or was disturbed: from here on
                                   it is simulated; value: s since world start */
    FW_EVENT_FLASHED_OVER = 10, /* a room did, see FwRoomDef; tag: index1 of its FwRoomId; object: null;
                                   position: its middle; value: s since world start */
    FW_EVENT_STRUCTURE_BROKE = 11, /* of objects with breakShare or breakArea: the host may break `object`; tag:
                                   FwBreakKind; value: m^2 of its surface that are concerned */
    FW_EVENT_TYPE_FORCE32 = 0x7fffffff
} FwEventType;
typedef enum FwExtinguishCause {
    FW_EXTINGUISHED_BY_WATER = 1, /* FW_WET, or a field with FW_FIELD_WETS */
    FW_EXTINGUISHED_BY_CALL = 2,  /* FW_EXTINGUISH */
    FW_EXTINGUISHED_BY_AIR = 3,   /* its room had too little oxygen */
    FW_EXTINGUISHED_BY_COLD = 4,  /* it lost more heat than its flames gave back, as a lone plank does */
    FW_EXTINGUISH_CAUSE_FORCE32 = 0x7fffffff
} FwExtinguishCause;
typedef enum FwBreakKind {
    FW_BREAK_PART = 1,          /* a part of what is left of it hangs on nothing any more; position: the middle of it */
    FW_BREAK_SHARE = 2,         /* so much of it is gone; position: of its box's middle */
    FW_BREAK_KIND_FORCE32 = 0x7fffffff
} FwBreakKind;
typedef struct FwEvent {        /* 64 bytes for ever */
    uint32_t type, tag;         /* FwEventType; tag: of FW_EVENT_TAG_REACHED the host's number */
    uint64_t userData;          /* the object's */
    FwBurnableMeshId object;
    uint64_t frameIndex;        /* the frame whose work raised it */
    float position[3], value;   /* position: with the object where it stands when the event is reported, which with a
                                   device is up to 3 frames after `frameIndex` */
    FwBurnableMeshId other;     /* FW_EVENT_SPREAD_TO: who lit it; else null */
    uint64_t reserved;
} FwEvent;
/* Oldest first; returns how many were written, 0 when there are no more. At most 4096 wait; then
 * the oldest are dropped and the next one says so in the log. Each event is written once: poll from
 * one place. Waits for no step and no recording. [any] */
FW_API uint32_t FW_CALL fwWorld_PollEvents(FwWorld*, FwEvent* events, uint32_t capacity);
/* Raises FW_EVENT_TAG_REACHED once when the texel nearest to `position` (m, world) burns. [world] */
FW_API FwResult FW_CALL fwWorld_TagPoint(FwWorld*, FwBurnableMeshId id, const float position[3], uint32_t tag);
/* Cancels all points of the object with this tag that the front has not reached. None: FW_OK. [world] */
FW_API FwResult FW_CALL fwWorld_UntagPoint(FwWorld*, FwBurnableMeshId id, uint32_t tag);

typedef struct FwObjectState { /* as of `frameIndex`: 2 to 3 frames ago on a GPU, now on the cpu */
    uint32_t structSize, reserved;
    uint64_t frameIndex;
    uint32_t texels;           /* that can burn */
    uint32_t ignited;          /* texels alight or burnt out, the most ever: what goes out again within
                                  the step that it was lit in does not count */
    uint32_t burning;          /* texels that flame now */
    uint32_t frontTiles;       /* tiles on which the front can still move */
    float burntFraction;       /* ignited / texels */
    float burningArea;         /* m^2 */
    float power;               /* W, at pace 1 */
    float reserved1;
    double energy;             /* J that its fuel gave off; 0 with FW_BURNABLE_PUBLISHED */
    uint32_t refinedTriangles; /* as last drawn, if it refines and caught fire; see FwWorldStats */
    uint32_t plays;            /* 1: a baked burn, see fwWorld_PlayBurn; 0: it is simulated */
} FwObjectState;
FW_API FwResult FW_CALL fwWorld_GetObjectState(FwWorld*, FwBurnableMeshId id, FwObjectState* state); /* [world] */
/* The same from any thread, as the last fwWorld_Step or fwWorld_RecordOutside left it, without waiting for one
 * that runs. The first fwWorld_Read... call on a world begins this copying and returns FW_NOT_READY; so does
 * an object that no frame has copied yet. Copying costs each frame some 0.1 us an object that ever burnt, and
 * 2 ns an object that never did. FW_ERROR_STALE_ID: the object was gone by that frame. [any] */
FW_API FwResult FW_CALL fwWorld_ReadObjectState(FwWorld*, FwBurnableMeshId id, FwObjectState* state);

typedef enum FwPointStateKind {
    FW_POINT_UNBURNT = 0, FW_POINT_BURNING = 1, FW_POINT_BURNT = 2, FW_POINT_WET = 3,
    FW_POINT_EXTINGUISHED = 4, FW_POINT_INERT = 5, FW_POINT_STATE_KIND_FORCE32 = 0x7fffffff
} FwPointStateKind;
typedef struct FwPointState {
    uint32_t structSize;
    uint32_t kind;             /* FwPointStateKind */
    uint64_t frameIndex;       /* the answer is of this frame */
    float age;                 /* s since it caught; < 0: not yet */
    float distance;            /* m from the asked point to the texel */
    float position[3];         /* m, world, of the texel */
    float reserved;
    float temperature;         /* K of the surface; 0: not known (FW_BURNABLE_LITE) */
    float fuel;                /* [0, 1], that is left */
    float charred;             /* [0, 1], for looks: scorched to burnt */
    float water;               /* g/m^2 on the surface */
} FwPointState;
/* Asks for the texel nearest to `position` (m, world). The answer comes with a later frame's
 * readback (at once on the cpu backend) and stays until it is fetched once, or cancelled; at most 1024 are
 * open. Destroying the object ends its queries: their ids are stale from then on. [world] */
FW_API FwResult FW_CALL fwWorld_RequestPoint(FwWorld*, FwBurnableMeshId id, const float position[3], FwQueryId* query);
/* FW_NOT_READY until the answer is here; FW_OK writes it and frees the query. [world] */
FW_API FwResult FW_CALL fwWorld_FetchPoint(FwWorld*, FwQueryId query, FwPointState* state);

/* Ends a query of fwWorld_RequestPoint or fwWorld_RequestArrival; its id is stale from then on. [world] */
FW_API FwResult FW_CALL fwWorld_CancelQuery(FwWorld*, FwQueryId query);

typedef enum FwArrivalKind {
    FW_ARRIVAL_AHEAD = 0,      /* fire will be there */
    FW_ARRIVAL_PAST = 1,       /* it burns or has burnt */
    FW_ARRIVAL_NEVER = 2,      /* it will not, as things are */
    FW_ARRIVAL_KIND_FORCE32 = 0x7fffffff
} FwArrivalKind;
typedef struct FwArrivalState {
    uint32_t structSize;
    uint32_t kind;             /* FwArrivalKind */
    uint64_t frameIndex;       /* the fire was as after this frame */
    float seconds;             /* s from the world's present until it catches; PAST: since then, <= 0; NEVER: FLT_MAX */
    float distance;            /* m from the asked point to the texel */
    float position[3];         /* m, world, of the texel */
    float reserved;
} FwArrivalState;
/* When will the object's own fire be at the texel nearest to `position` (m, world)? As things are at the time of the
 * call: where it burns, what is wet, under the wind, pose and room's air of now as if they stayed (in air in which
 * nothing burns: never). Not what other objects, gusts, water that dries or limits on burning tiles will make of it.
 * The front is run ahead of itself, at most FwWorldDef::arrivalTiles a frame, for all questions about an object at
 * once; what is near is known first, and the first frames tell it where the state is read back later. Exact for a
 * fire left alone. After a change (fire, water, wind, pose, air) ask anew. Counts to the 1024 queries that may be
 * open. Allocates some 5 bytes a texel at an object's first question. Not for FW_BURNABLE_PUBLISHED. [world] */
FW_API FwResult FW_CALL fwWorld_RequestArrival(FwWorld*, FwBurnableMeshId id, const float position[3], FwQueryId* query);
/* FW_NOT_READY until the answer is here; FW_OK writes it and frees the query. [world] */
FW_API FwResult FW_CALL fwWorld_FetchArrival(FwWorld*, FwQueryId query, FwArrivalState* state);

/* ---- saves: a world mid-burn as bytes -------------------------------------------------------------------- */

/* Wishes a save of the world as it is after the next frame, be it of no time; with a device the bytes come some frames
 * later, and nothing waits for them. One at a time: a second wish begins anew. In a save: every texel's state, temperature, fuel
 * and water; counters, clocks, wind, flags and what the wind's filters hold; transforms of objects and blockers; events
 * that wait, tags, contacts; what jets have in the air, what fires and jets are about to light, cells of fields that
 * wet; points of volumetric fires; what FwWorldDef::visibility answered; which breaks were reported; all events up to that
 * frame's that were not polled before it (with a device those that it reports later, too), but for those about objects that
 * are destroyed by then. Not in it: what only shows (particles, flames, soot, sheets in motion), queries, hidden,
 * and what the host made: meshes, materials, objects. Refused while an object with FW_BURNABLE_PUBLISHED burns. The bytes
 * are the same on every backend, if as much was polled and nothing moved since (positions of events are those of the poll):
 * little-endian, versioned, with a checksum, compressed. A loaded world goes on as its original does: state, events and
 * later saves are alike. FwWorldStats::runTiles and flames alone are not: they count work. [world] */
FW_API FwResult FW_CALL fwWorld_RequestSave(FwWorld*);
/* FW_NOT_READY until it is there. Call with buffer null for the size, or with enough room; *size is what is (or would
 * be) written, in bytes. The library keeps them until the next fwWorld_RequestSave. To keep them, write them to a new
 * file, and rename that over the old one: then a crash leaves the old one whole. [world] */
FW_API FwResult FW_CALL fwWorld_FetchSave(FwWorld*, void* buffer, uint64_t* size);
/* Forgets a save that was requested, and frees one that is there. None: FW_OK. [world] */
FW_API FwResult FW_CALL fwWorld_CancelSave(FwWorld*);
/* The world as it was saved, on whatever backend: from here on both burn bit by bit alike, whatever frame rate each of
 * them has, if they hear the same calls. The world holds what the saved one did, made in the same order, so that the
 * ids' index1 are the same: burnable meshes of the same meshes and materials (by a hash of them and of their defs),
 * blockers, wind zones, rooms, fires, emitters and fields. Its FwWorldDef has the same paceFactor, up, seed and limits of spread. All in it
 * goes to where and what it was, also what has never burnt; ids stay valid. The first frame shows flames and particles as if
 * they had long burnt so. Unpolled events are the save's, as of the frame
 * before the next: a host that knew by the save's frame what it had polled hears each event once. Queries that
 * wait are asked anew. FW_ERROR_BAD_DATA, and nothing is changed: the bytes are damaged, cut, of another version, or of
 * another world; the message says of what, with both values. Time is that of the save; frame indices go on growing.
 * Uploads with the next frame. [world] */
FW_API FwResult FW_CALL fwWorld_Load(FwWorld*, const void* bytes, uint64_t size);

/* ---- a log: any moment of a burn, seen again -------------------------------------------------------------- */

/* What the host does to the burn, each with the tick it came before. With the last save before a moment it gives that moment
 * bit by bit, on any backend, whatever frame rate either has: load the save, open the log, then
 *     while (fwWorld_PlayLog(world, untilTick, &seconds) == FW_OK && seconds > 0) fwWorld_Step(world, seconds);
 * In it are the same calls that a network sends by itself (see fwNet_Serve); all else (what is made and destroyed, colliders,
 * points of fires, painted fields, vertices) the host does again at its time.
 * Notes from here on, some 20 to 60 bytes a call; a log that was noted before is dropped. [world] */
FW_API FwResult FW_CALL fwWorld_StartLog(FwWorld*);
/* Notes no more, and drops what was noted. [world] */
FW_API FwResult FW_CALL fwWorld_StopLog(FwWorld*);
/* All that was noted, little-endian, versioned, with a checksum. As fwWorld_FetchSave: buffer null for the size, or
 * with enough room; *size is what is (or would be) written, in bytes. The log goes on. [world] */
FW_API FwResult FW_CALL fwWorld_FetchLog(FwWorld*, void* buffer, uint64_t* size);
/* Reads a log to be played, in place of one that was; size 0: none any more. FW_ERROR_BAD_DATA, and nothing is changed: the
 * bytes are damaged, cut, of another version, or of a world that is made of other things. [world] */
FW_API FwResult FW_CALL fwWorld_OpenLog(FwWorld*, const void* bytes, uint64_t size);
/* Does what the log has before the world's next step. *seconds: how far the world is to be moved before the next call: to
 * the next thing in the log, or to the last whole step (1/32 s) at or before untilTick (see FwWorldStats::tick), but no
 * farther than a frame may go; 0: it is there. What lies before the world's present, or went into the save that was loaded
 * there, is passed over; what the world refuses, too, and its log says so. Refused without a log, and while the world
 * follows a server's. [world] */
FW_API FwResult FW_CALL fwWorld_PlayLog(FwWorld*, uint64_t untilTick, float* seconds);

/* ---- a timeline: forth and back in a burn ------------------------------------------------------------------ */

/* The world keeps saves of itself, some time apart, and what the host did since the first of them: any moment in between
 * can be had again, bit by bit, in the same world. For scrubbing, replays, kill cams, undo. Baked burns, be it that they
 * play or went live, are in it as any other fire. */
typedef struct FwTimelineDef {
    uint32_t structSize;
    float interval;            /* s of the world's time from one save to the next, [1/32, 3600], default 2 */
    float longest;             /* s, [interval, 3600], default 32: as far apart they may come to be, so that they fit */
    uint32_t reserved;         /* 0 */
    uint64_t bytes;            /* the most that saves and notes take, [65536, 2^64), default 67108864. Beyond that every second
                                  save goes, as long as `longest` allows; then the oldest, and with it the timeline's
                                  beginning. The newest save, and what was done since, stay whatever they take */
} FwTimelineDef;
static inline FwTimelineDef fwDefaultTimelineDef(void) {
    FwTimelineDef d; fwInitDef(FW_DEF_TIMELINE, &d, (uint32_t)sizeof d); return d;
}
/* From the world as it is after the next frame; one that was kept before is dropped. A save costs what fwWorld_RequestSave says,
 * in its frame. fwWorld_Load begins it anew. Refused while an object with FW_BURNABLE_PUBLISHED burns. [world] */
FW_API FwResult FW_CALL fwWorld_StartTimeline(FwWorld*, const FwTimelineDef* def);
FW_API FwResult FW_CALL fwWorld_StopTimeline(FwWorld*); /* the world stays where it is [world] */
/* One piece of the way to the last whole step (1/32 s) at or before untilTick (see FwWorldStats::tick), be that ahead or behind:
 *     while (fwWorld_Seek(world, untilTick, &seconds) == FW_OK && seconds > 0) fwWorld_Step(world, seconds);
 * or a recorded frame for each. Goes back, or leaps, to the nearest save by what fwWorld_Load does (events that wait are the save's, what
 * only shows begins anew), and does again what the host did from there on; *seconds: how far the world is to be moved before the
 * next call; 0: it is there. Where it stops in the past, what the host did at that very tick is not done yet. Called with more
 * and more it plays the past; events are raised again. Who moves the world on without it, or does anything to the burn, begins
 * another future: what came after is forgotten. FW_ERROR_INVALID_ARGUMENT: it has no such time, see FwTimelineState; or there is none.
 * FW_NOT_READY: its first save is not there yet. FW_ERROR_BAD_DATA: something was made or destroyed since, which is not on
 * timelines: start another one then. Refused while the world follows a server's. [world] */
FW_API FwResult FW_CALL fwWorld_Seek(FwWorld*, uint64_t untilTick, float* seconds);
typedef struct FwTimelineState {
    uint32_t structSize;
    uint32_t moments;          /* saves that are kept; 0: it is not there yet, or none is kept */
    uint64_t firstTick, endTick; /* where fwWorld_Seek may go; a tick is 2^-12 s */
    uint64_t bytes;            /* that saves and notes take */
    float interval;            /* s from one save to the next, now */
    uint32_t reserved;
} FwTimelineState;
FW_API FwResult FW_CALL fwWorld_GetTimelineState(FwWorld*, FwTimelineState* state); /* [world] */

/* ---- baked burns: fire that plays and goes live when disturbed ------------------------------------------------ */

/* Asks for when each texel of an object caught, as it will be after the next frame; fetched like a save, some frames later
 * with a device. What was put out, and what has not burnt, is not in it. [world] */
FW_API FwResult FW_CALL fwWorld_RequestBurn(FwWorld*, FwBurnableMeshId id);
/* FW_NOT_READY until it is there. Call with buffer null for the size, or with enough room; *size is what is (or would
 * be) written, in bytes: a .fwburn file, little-endian, versioned, with a checksum, compressed. Times count from the first
 * texel that caught. Refused where nothing has burnt. [world] */
FW_API FwResult FW_CALL fwWorld_FetchBurn(FwWorld*, FwBurnableMeshId id, void* buffer, uint64_t* size);
/* Forgets what fwWorld_RequestBurn asked for, and frees it where it is there. Nothing requested: FW_OK. [world] */
FW_API FwResult FW_CALL fwWorld_CancelBurn(FwWorld*, FwBurnableMeshId id);
/* Bytes of fwWorld_FetchBurn, of this world or another one, to be played by any number of objects. FW_ERROR_BAD_DATA: they
 * are damaged, cut or of another version. Takes 8 bytes a texel. [world] */
FW_API FwResult FW_CALL fwWorld_CreateBurn(FwWorld*, const void* bytes, uint64_t size, FwBurnId* id);
FW_API FwResult FW_CALL fwWorld_DestroyBurn(FwWorld*, FwBurnId id); /* refused while an object plays it [world] */
/* From the next step on the object plays the burn, whose first texel catches `delay` s from now ([0, 3600], at least one
 * step), and the others at `speed` times the pace at which they did ([1/16, 16], 1: as they did). Meant for what has not
 * burnt yet; what burns already goes on. No front is simulated on it; fuel, heat, char, flames, lights, what it does to
 * others, events, queries and saves are as ever, and fwWorld_RequestArrival tells what the burn says. The object goes live
 * (FW_EVENT_WENT_LIVE), that is, its front is simulated from the state that it then has, within two steps after: the host
 * or another object lights, heats, wets, dries or douses a texel of it; others' fire sends it 4 kW/m^2 (see
 * FW_WORLD_RADIATION), of which wood does not catch yet; its wind or pose turns so far that its front would hear of it;
 * fwWorld_StopBurn; the last texel of the burn caught. The same on every backend, in saves (which name burns by their id and
 * a hash: make them in the same order), logs and networks. Replaces a burn that the object plays. The burn is of the same
 * mesh (by a hash of what is baked of it, in the same shape), or it is refused; so is FW_BURNABLE_PUBLISHED. [world] */
FW_API FwResult FW_CALL fwWorld_PlayBurn(FwWorld*, FwBurnableMeshId id, FwBurnId burn, float delay, float speed);
/* Makes an object live that plays a burn; else nothing. [world] */
FW_API FwResult FW_CALL fwWorld_StopBurn(FwWorld*, FwBurnableMeshId id);

/* ---- a network: one burn on many machines ------------------------------------------------------------------ */

/* The server's world is the truth. Clients have worlds that are made of the same things in the same order (see fwWorld_Load);
 * they get the server's state once, and from there on what its host does to the burn, with the step that it came before. As
 * fire is integers, both then burn bit by bit alike; hashes of each object, every few seconds, show it, and a client that has
 * gone astray, whyever, gets the tiles that differ, or all again. The host moves the packets, by whatever way it has: they may be lost, come
 * twice, late and in any order. A packet that is damaged, cut, or of another session or version is refused with a message
 * and changes nothing; the checksum finds damage, not malice: encrypt where that is to be feared. Nothing here waits.
 *
 * Sent by itself is: fwWorld_Ignite, PlayBurn, StopBurn, SetWind, SetWindGrid, SetGusts, SetWindZone, SetRoom, SetFlags,
 * SetTransform, MoveBlocker, SetHeatShield;
 * of volumetric fires with FW_FIRE_IGNITES and jets with FW_EMITTER_IGNITES where they are and their power, of fields with
 * FW_FIELD_WETS where they are and their amount. On a client these calls are refused, as fwWorld_Load is. What is made and
 * destroyed, and all else that changes what burns (colliders, points of fires, painted fields, vertices), each host does by
 * itself: told by fwNet_Tell, at the same step. */
typedef struct FwNetDef {
    uint32_t structSize, flags; /* flags: 0 */
    uint32_t token;             /* [1, 2^32): a number of the host's by chance, another one each time: of the session, or of
                                   this client. Packets of others are refused */
    uint32_t packetBytes;       /* [512, 1400], default 1200: the most that a packet has */
    uint32_t bytesPerSecond;    /* [4000, 100000000], default 262144: of a server, to each client at most: what a connection
                                   carries. A client that falls too far behind gets the whole state; see
                                   FwNetState::overloaded */
    float interval;             /* s between packets, [1/64, 1], default 1/16; more are sent where there is more to say */
    float delay;                /* s, [0, 10], default 0.15: of a client, how far it stays behind the newest that it has heard
                                   of. Below what packets need on their way, and again where one is lost, its fire stutters */
    uint32_t reserved;          /* 0 */
} FwNetDef;
static inline FwNetDef fwDefaultNetDef(void) {
    FwNetDef d; fwInitDef(FW_DEF_NET, &d, (uint32_t)sizeof d); return d;
}
/* The world is a server's from here on, or a client's, which begins with the server's state and moves no further than
 * fwNet_TakeTurn says. On any backend. Refused while it is either already. [world] */
FW_API FwResult FW_CALL fwNet_Serve(FwWorld*, const FwNetDef* def);
FW_API FwResult FW_CALL fwNet_Join(FwWorld*, const FwNetDef* def); /* [world] */
/* Neither any more; the world stays as it is. [world] */
FW_API FwResult FW_CALL fwNet_Leave(FwWorld*);
/* Of a server: somebody from whom packets come, at most 256 at a time. A client that comes back with another token is another
 * peer. How long one has been silent says its state; dropping it is the host's. [world] */
FW_API FwResult FW_CALL fwNet_AddPeer(FwWorld*, FwPeerId* id);
FW_API FwResult FW_CALL fwNet_RemovePeer(FwWorld*, FwPeerId id); /* [world] */
/* Once in each of the host's frames, after its steps: deltaTime s, [0, 10], of real time have passed. [world] */
FW_API FwResult FW_CALL fwNet_Update(FwWorld*, float deltaTime);
/* The next packet for a peer; of a client: for the server, with a null id. *size: room for FwNetDef::packetBytes, then what
 * was written. FW_NOT_READY: there is none before the next fwNet_Update. [world] */
FW_API FwResult FW_CALL fwNet_Write(FwWorld*, FwPeerId to, void* packet, uint32_t* size);
/* A packet that came. FW_ERROR_BAD_DATA, FW_ERROR_VERSION: it is damaged, of another session, or has a number that cannot be
 * by what this side has sent. Such a packet changes nothing; FwNetState::packetsRefused counts it, and a server's log says the
 * first, second, fourth, eighth... of each peer. Of one peer a server looks at 512 packets a second. [world] */
FW_API FwResult FW_CALL fwNet_Read(FwWorld*, FwPeerId from, const void* packet, uint32_t size);
/* Of a server: bytes of the host's own, [0, 1024] and at most FwNetDef::packetBytes less 64, that each client gets between
 * the same calls and before the same step as here, in order, none left out; a client that gets the whole state, as it fell
 * behind or went wrong, gets those before that state right before it. Clients that join later do not get it: their
 * host has to know by another way what has been made since. [world] */
FW_API FwResult FW_CALL fwNet_Tell(FwWorld*, const void* message, uint32_t size);

typedef enum FwNetTurnKind {
    FW_TURN_WAIT = 0,    /* nothing more in this frame of the host's */
    FW_TURN_STEP = 1,    /* move the world on by deltaTime, with fwWorld_Step or a recorded frame, then ask again */
    FW_TURN_MESSAGE = 2, /* the server's host says so: do it now, then ask again */
    FW_TURN_FORCE32 = 0x7fffffff
} FwNetTurnKind;
typedef struct FwNetTurn {
    uint32_t structSize;
    uint32_t kind;             /* FwNetTurnKind */
    float deltaTime;           /* s */
    uint32_t messageSize;      /* bytes */
    unsigned char message[1024];
} FwNetTurn;
/* Of a client: what to do next, in a loop after fwNet_Update until FW_TURN_WAIT. A host that records one frame of the world's
 * in each of its own takes one step each: the rest waits, and comes a little faster. [world] */
FW_API FwResult FW_CALL fwNet_TakeTurn(FwWorld*, FwNetTurn* turn);

typedef enum FwNetRole { FW_NET_NONE = 0, FW_NET_SERVER = 1, FW_NET_CLIENT = 2, FW_NET_ROLE_FORCE32 = 0x7fffffff } FwNetRole;
typedef enum FwNetPhase {
    FW_NET_CALLING = 0,   /* no answer yet */
    FW_NET_REFUSED = 1,   /* the server's world is of other things, as the log says; it is asked again each second */
    FW_NET_LOADING = 2,   /* the state is on its way */
    FW_NET_FOLLOWING = 3,
    FW_NET_PHASE_FORCE32 = 0x7fffffff
} FwNetPhase;
typedef struct FwNetState {
    uint32_t structSize;
    uint32_t role, phase;      /* FwNetRole; FwNetPhase: of a client, or of a server's peer */
    uint32_t peers;
    uint64_t step;             /* of 1/32 s, that this world has come to */
    uint64_t heardStep;        /* that the other one has, as far as is known */
    float behind;              /* s that the client is behind that */
    float silent;              /* s since the last packet came */
    uint32_t records;          /* that wait: for answers on a server, for their step on a client */
    uint32_t states;           /* that were taken from the server; the first is how a client joins */
    uint32_t strays;           /* of a client: how often it was found to differ */
    uint32_t repairs;          /* of a client: of its states, those of which only tiles that differed came */
    uint64_t hashes;           /* of a client: that were compared */
    uint64_t bytesOut, bytesIn, packetsOut, packetsIn; /* without what the way adds */
    uint64_t packetsIgnored;   /* that had come before, came much too late, or faster than 512 a second from one peer */
    uint64_t packetsRefused;   /* that were damaged or had a number that cannot be; of a server's peer: those of this peer */
    uint64_t messagesLost;     /* of a server: messages of fwNet_Tell that peers miss, since more than 4 MB of them waited */
    uint32_t resyncs;          /* of a server: how often a peer fell so far behind that it needs the whole state */
    uint32_t overloaded;       /* of a server: peers whose rate cannot carry the changes; of a client: 1 if its server says so */
    float changeRate;          /* bytes/s, of a server: what its changes of the last seconds take */
    float backlog;             /* s, of a server: age of the oldest change that a peer has not got */
    float roundTrip;           /* s, of a server's peer: from a packet to its answer; 0: not known yet */
    uint32_t reserved;         /* 0 */
} FwNetState;
/* Of a server: peer null: of all of them. [world] */
FW_API FwResult FW_CALL fwNet_GetState(FwWorld*, FwPeerId peer, FwNetState* state);

typedef struct FwLight {       /* frozen, 64 bytes. A ball of fire for the host's own lighting */
    float position[3];         /* m, world */
    float radius;              /* m, of the source */
    float color[3];            /* linear, luminance 1 */
    float intensity;           /* relative radiant intensity, W/sr of the visible part */
    float power;               /* W, whole heat release */
    float reserved[3];
    uint32_t id, reserved1;    /* stable while the same fire burns */
    uint64_t frameIndex;
} FwLight;
/* The strongest fires, which shine for all others too: the sum of power and intensity is that of all fires, however
 * few lights there are. Of burning meshes as of the last readback, and smooth from frame to frame (a filter of 0.1 s,
 * and flicker of at most 7 % in 1/60 s); volumetric fires as of the last frame, or as they are about to be (their ids
 * have the highest bit set); fire emitters (the bit below it). At most FwWorldDef::maxLights; strongest first. Backends
 * gather burning tiles each in its own way: places, radii, ids and shares of the power differ between them, the sum of the
 * power does not. Returns how many were written. [world] */
FW_API uint32_t FW_CALL fwWorld_GetLights(FwWorld*, FwLight* lights, uint32_t capacity);
/* The same from any thread, as the last fwWorld_Step or fwWorld_RecordOutside left it: see
 * fwWorld_ReadObjectState. *count: room in `lights`, then how many were written. FW_NOT_READY: no frame has
 * copied them yet, *count is 0. [any] */
FW_API FwResult FW_CALL fwWorld_ReadLights(FwWorld*, FwLight* lights, uint32_t* count);

/* What fire does to a place: for damage, for what characters feel and see. Of burning meshes (their lights), fire
 * emitters and volumetric fires, as of the last frame; cosmetic. Plumes are McCaffrey's and lean with the wind;
 * blockers, colliders and the shield shade radiation (cells of a burnable mesh: until half of it has burnt). */
typedef struct FwSurroundings {
    uint32_t structSize;
    float heatFlux;            /* W/m^2 on a small cold body there, by radiation and hot gas; at most 150 kW/m^2 */
    float temperature;         /* K of the air; 293 where nothing warms it */
    float smoke;               /* 1/m: through a metre of it passes exp(-smoke) of the light; 0: clear */
    float danger;              /* 0: none. 1: as much as people bear: 2.5 kW/m^2, 60 C or smoke of 1 1/m. No upper end */
    float nearest;             /* m to the edge of the nearest flame; FLT_MAX: nothing burns */
    float nearestPosition[3];  /* m, world: foot of that fire */
    float nearestPower;        /* W */
    uint32_t nearestLight;     /* its FwLight::id, if it has a light of its own */
    uint32_t reserved;
} FwSurroundings;
/* At once, on every backend; some tens of nanoseconds a fire. heatFlux and danger add up the lights of fwWorld_GetLights, and
 * differ between backends as these do. [world] */
FW_API FwResult FW_CALL fwWorld_AskSurroundings(FwWorld*, const float point[3], FwSurroundings* surroundings);
/* How much of one point is seen from the other through smoke, [0, 1]. Walls are the host's business. [world] */
FW_API FwResult FW_CALL fwWorld_AskSight(FwWorld*, const float from[3], const float to[3], float* seen);
/* Where people may walk: danger at columns x rows points, row after row, as a byte each: 127 for a danger of 1, at
 * most 255. The first point is `corner` (m, world: at the height of heads), the others `columnStep` and `rowStep` (m)
 * apart. columns and rows: each [1, 4096]. [world] */
FW_API FwResult FW_CALL fwWorld_MakeSafetyMask(FwWorld*, const float corner[3], const float columnStep[3],
                                               const float rowStep[3], uint32_t columns, uint32_t rows, uint8_t* mask);

typedef struct FwWorldStats {
    uint32_t structSize, reserved;
    uint64_t steps, tick;          /* of the simulation; a tick is 2^-12 s */
    uint64_t readbackFrame;        /* newest frame whose readback has come */
    uint32_t objects, burningObjects, meshes, materials;
    uint32_t frontTiles, runTiles; /* waiting, and run in the last step */
    uint32_t burningTiles;
    uint32_t flames;               /* quads of flames, smoke, particles and sparks that the last view showed, as of
                                      the last readback; 0 on the cpu backend, which draws nothing */
    uint32_t lateClamps, droppedSteps;
    uint64_t texels;               /* of all objects' burn maps */
    uint32_t hotTiles;             /* whose temperature or water changes */
    uint32_t refinedTriangles;     /* of refined objects that caught fire, as last drawn; pieces along cut holes
                                      not counted. See FwWorldDef::maxRefinedTriangles */
} FwWorldStats;
FW_API FwResult FW_CALL fwWorld_GetStats(FwWorld*, FwWorldStats* stats); /* [world] */

/* Where the energy of all burnable meshes that the world holds is, to the joule: `fuel` is what they were made with,
 * and always the sum of `unburnt`, `radiated` and `convected`. All in units of 2^-20 J, as the simulation counts, so
 * that the sum is exact. As of `frameIndex`, like FwObjectState. With FW_BURNABLE_LITE a texel's fuel counts as a
 * whole, once it has burnt out (put out before, it has all of it); FW_BURNABLE_PUBLISHED keeps no book. */
typedef struct FwEnergyBook {
    uint32_t structSize;
    uint32_t objects;          /* that keep a book */
    uint64_t frameIndex;
    uint64_t fuel;             /* in them when they were created */
    uint64_t unburnt;          /* of it, that is left */
    uint64_t radiated;         /* 33 % of what flames gave off: what may heat others */
    uint64_t convected;        /* the rest, in hot gas */
    float power;               /* W that they give off now, at pace 1 */
    float burningArea;         /* m^2 that flames, of all objects */
} FwEnergyBook;
FW_API FwResult FW_CALL fwWorld_GetEnergyBook(FwWorld*, FwEnergyBook* book); /* [world] */

/* What a frame may cost. While it costs more, detail falls in eight levels, and rises when there is room: how many
 * volumetric flames have rays of their own and with how many samples, the largest on the screen last, how many
 * triangles refined meshes aim at, how many quads flames of burning meshes and particles show (the others are larger
 * for it), and how many lights shine for all (the others shine for them too); under a limit of bytes also how fine marched flames are. Fires are never deleted, and what burns is
 * the same bit by bit at every level. A new load settles within 60 frames; a single slow frame changes nothing. */
typedef struct FwBudgetDef {
    uint32_t structSize, reserved;  /* 0 */
    float gpuMilliseconds;     /* of all that is recorded for a frame, [0, 1000]; default 0: no limit */
    float cpuMilliseconds;     /* of fwWorld_RecordOutside, RecordInside and RecordComposite of a frame (of fwWorld_Step
                                  on the cpu backend), [0, 1000]; default 0: no limit */
    float measuredMilliseconds;/* what the host measured of our part of the last frame on its GPU, [0, 1e5]; < 0, the
                                  default: take the library's time stamps. Needed where the queue family has none */
    uint32_t reserved1;        /* 0 */
    uint64_t bytes;            /* of device memory that follows detail: of marched flames and of quads; default 0: no
                                  limit. Buffers are made anew when the level changes. Not what is authoritative, nor
                                  meshes and their refinement: see FwContextDef::gpuMemoryBudget */
} FwBudgetDef;
static inline FwBudgetDef fwDefaultBudgetDef(void) {
    FwBudgetDef d; fwInitDef(FW_DEF_BUDGET, &d, (uint32_t)sizeof d); return d;
}
/* From the next frame on; cheap enough for each. Without limits, as at first, all detail comes back. [world] */
FW_API FwResult FW_CALL fwWorld_SetBudget(FwWorld*, const FwBudgetDef* def);
typedef struct FwBudgetState {
    uint32_t structSize;
    uint32_t level, levels;    /* 0: all detail; levels - 1: the least */
    uint32_t marchedFires;     /* volumetric flames at most that have rays of their own */
    uint32_t volumeSteps;      /* samples of a ray at most */
    uint32_t refinedTriangles; /* that refined meshes aim to stay within */
    float gpuMilliseconds, cpuMilliseconds; /* of a frame, smooth; 0: not known */
    float quads;               /* share of flames' quads and particles that show, [0, 1] */
    uint32_t lights;           /* at most that shine for all fires; FwWorldDef::maxLights, and half of it at the least */
    uint64_t bytes;            /* that FwBudgetDef::bytes limits, now; 0 on the cpu backend */
} FwBudgetState;
FW_API FwResult FW_CALL fwWorld_GetBudgetState(FwWorld*, FwBudgetState* state); /* [world] */

#ifdef __cplusplus
} /* extern "C" */
static_assert(sizeof(FwErrorInfo) == 512 && sizeof(FwEvent) == 64 && sizeof(FwLight) == 64,
              "frozen sizes");
#endif
#endif
