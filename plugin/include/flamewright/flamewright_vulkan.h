/* flamewright/flamewright_vulkan.h: for hosts that provide a Vulkan device. The host keeps ownership of all that it passes. The
 * library forgets each handle when the call returns, with three exceptions: the device, registered render passes, and views
 * that you ask it to keep (FW_COMPOSITE_KEEP).
 *
 * A frame: fwWorld_RecordOutside (compute, copies, barriers; outside any pass), then, in the host's own render pass,
 * fwWorld_RecordInside (draws only). Alternative: fwWorld_RecordComposite, a pass of the library over host images.
 * After each record call the following state of that command buffer is undefined: bound graphics and compute pipelines, all
 * descriptor sets, push constants, index buffer, vertex buffer bindings 0 and 1, and all dynamic state. That includes viewport,
 * scissor and state that the library's pipelines fix: blend constants, stencil masks and references, depth bias and bounds,
 * line width. All other state stays: render pass, queries, labels, further vertex bindings. */
/* Laid out by hand. */
/* clang-format off */
#ifndef FLAMEWRIGHT_FLAMEWRIGHT_VULKAN_H
#define FLAMEWRIGHT_FLAMEWRIGHT_VULKAN_H
#include "flamewright/flamewright.h"
#ifndef VK_VERSION_1_0
#include <vulkan/vulkan_core.h> /* types only: the library calls Vulkan through getInstanceProcAddr */
#endif
#ifdef __cplusplus
extern "C" {
#endif

/* Vulkan 1.0 is enough. Declare here all else that you enabled, since Vulkan cannot be queried for it. Extensions and features
 * that are not declared count as off. */
typedef struct FwVulkanHost {
    uint32_t structSize;
    uint32_t apiVersion;                 /* of instance and device as created, default VK_API_VERSION_1_0; 0: the same */
    PFN_vkGetInstanceProcAddr getInstanceProcAddr; /* required */
    VkInstance instance;                 /* required */
    VkPhysicalDevice physicalDevice;     /* required */
    VkDevice device;                     /* required */
    uint32_t queueFamilyIndex;           /* family of the queue that will run the library's commands: graphics and compute */
    uint32_t enabledExtensionCount;      /* [0, 4096] */
    const char* const* enabledExtensions;  /* device extensions */
    uint32_t enabledInstanceExtensionCount; /* [0, 4096] */
    uint32_t reserved;
    const char* const* enabledInstanceExtensions;
    const VkPhysicalDeviceFeatures* enabledFeatures; /* null: none */
    const void* enabledFeatureChain;     /* pNext chain as of VkPhysicalDeviceFeatures2, or null */
    VkPipelineCache pipelineCache;       /* optional. Used, never destroyed */
    const VkAllocationCallbacks* allocationCallbacks; /* optional. Must outlive the context */
} FwVulkanHost;
static inline FwVulkanHost fwDefaultVulkanHost(void) {
    FwVulkanHost d; fwInitDef(FW_DEF_VULKAN_HOST, &d, (uint32_t)sizeof d); return d;
}

/* For a host that creates its device later: what the library can use. Only minimumApiVersion and queueFlags are required. */
typedef struct FwVulkanRequirements {
    uint32_t structSize;
    uint32_t minimumApiVersion;          /* VK_API_VERSION_1_0 */
    uint32_t extensionCount, instanceExtensionCount;
    const char* const* extensions;       /* static strings */
    const char* const* instanceExtensions;
    VkPhysicalDeviceFeatures features;   /* VK_TRUE: useful */
    VkQueueFlags queueFlags;             /* required of the queue family */
} FwVulkanRequirements;
/* Needs no context. [any] */
FW_API FwResult FW_CALL fwQueryVulkanRequirements(FwVulkanRequirements* requirements);

typedef enum FwDepthMode {
    FW_DEPTH_NONE = 0,      /* the target has no depth. Surfaces are drawn without it: right for flat sheets that do not
                               overlap. Other surfaces show their far sides; the log has a warning */
    FW_DEPTH_TEST = 1,      /* tested and written in the host's pass */
    FW_DEPTH_TEST_ONLY = 2, /* tested, never written: for flames and smoke. Needs FW_TARGET_NO_SURFACES, since surfaces hide
                               themselves by the depth that they write */
    FW_DEPTH_SAMPLED = 3,   /* sampled, not attached: for flames and smoke, which fade softly near the sampled depth. Surfaces
                               need an attached depth: draw them first, with a target of another mode and FW_TARGET_NO_FLAMES */
    FW_DEPTH_MODE_FORCE32 = 0x7fffffff
} FwDepthMode;
typedef enum FwOutputEncoding {
    FW_OUTPUT_LINEAR = 0,  /* float format: scene-linear, times FwView::exposure; no tone mapping */
    FW_OUTPUT_SRGB_VIEW = 1,   /* sRGB format: times exposure, tone mapped by the library; the format encodes */
    FW_OUTPUT_DISPLAY_UNORM = 2, /* UNORM format for display: times exposure, tone mapped and sRGB-encoded by the library */
    FW_OUTPUT_AUTO = 3,    /* the one of the three that fits colorFormat. For a format that is not known to be float, sRGB or
                              UNORM, registration fails: name the encoding */
    FW_OUTPUT_ENCODING_FORCE32 = 0x7fffffff
} FwOutputEncoding;

typedef struct FwVulkanTargetDef {
    uint32_t structSize;
    uint32_t subpass;              /* 0 with FW_TARGET_COMPOSITE */
    VkRenderPass renderPass;       /* of the host; null only with FW_TARGET_COMPOSITE */
    VkFormat colorFormat;          /* format of the view that the subpass writes: pColorAttachments[0], not a resolve
                                      attachment */
    VkFormat depthFormat;          /* format of the subpass's depth attachment; with FW_DEPTH_SAMPLED of the sampled view; with
                                      FW_DEPTH_NONE UNDEFINED */
    uint32_t samples;              /* 1, 2, 4, 8 or 16, default 1. Of the attachments, which may differ from the requested
                                      count; see renderPassInfo */
    uint32_t colorAttachmentCount; /* [1, 8], default 1. Of the subpass. The library writes the first and masks the others; more
                                      than 1 needs independentBlend, declared in FwVulkanHost */
    uint32_t viewMask;             /* 0. This version refuses any other */
    uint32_t depthMode;            /* FwDepthMode, default FW_DEPTH_TEST */
    uint32_t reversedDepth;        /* default 0. 1: near is 1 */
    uint32_t encoding;             /* FwOutputEncoding, default FW_OUTPUT_AUTO. Must not contradict colorFormat */
    uint32_t flags;                /* FwTargetFlags, default 0 */
    uint32_t depthSamples;         /* 0, 1, 2, 4, 8 or 16, default 0: as `samples`. Samples of the image of FW_DEPTH_SAMPLED; the
                                      first sample counts */
    const void* renderPassInfo;    /* default null. The VkRenderPassCreateInfo or VkRenderPassCreateInfo2 of renderPass; read only
                                      during the call. Vulkan cannot be queried for the content of a pass: with it, registration
                                      checks subpass, colorFormat, depthFormat, samples and colorAttachmentCount. Without it,
                                      only validation layers find a wrong one */
} FwVulkanTargetDef;
typedef enum FwTargetFlags {
    FW_TARGET_COMPOSITE = 1, /* for fwWorld_RecordComposite: the library creates the pass */
    FW_TARGET_NO_FLAMES = 2, /* draws only surfaces */
    FW_TARGET_NO_SURFACES = 4, /* draws only flames and smoke */
    FW_TARGET_HAZE = 8,      /* with FW_DEPTH_SAMPLED: hot gas in and above volumetric fires bends the background, in frames with
                                FwVulkanFrame::sampledColor */
    FW_TARGET_HALF_EFFECTS = 16, /* with FW_TARGET_COMPOSITE and FW_DEPTH_SAMPLED: flames, smoke, particle fields and volumetric
                                fires are drawn at half resolution and upsampled along depth edges. Takes a third to two thirds
                                of their time, and is softer. Sparks stay at full resolution and show through smoke in front
                                of them. Costs 2 bytes of device memory a pixel, 3 on a float target, for each world and
                                target size. Allocated in the first frame that needs it */
    FW_TARGET_AS_NEEDED = 32, /* creates surface pipelines on demand: registration creates those for the kinds of material that
                                objects of the context had so far. fwWorld_CreateBurnableMesh creates those of a new kind,
                                about a seventh of all (0.2 s on a software device). fwWorld_DestroyImage does so for objects
                                that showed it. Record calls never do. renderPass must live until the target is unregistered */
    FW_TARGET_TRANSPARENCY = 64, /* frames may set FwVulkanFrame::transparency. One more pipeline, created at registration */
    FW_TARGET_FLAGS_FORCE32 = 0x7fffffff
} FwTargetFlags;
static inline FwVulkanTargetDef fwDefaultVulkanTargetDef(void) {
    FwVulkanTargetDef d; fwInitDef(FW_DEF_VULKAN_TARGET, &d, (uint32_t)sizeof d); return d;
}
/* Registers a target and creates its pipelines: all of them, or as FW_TARGET_AS_NEEDED says. Register again when the pass or
 * its sample count changes. Records nothing. FW_ERROR_INVALID_ARGUMENT: fields contradict each other or renderPassInfo. [any,
 * also while the host records] */
FW_API FwResult FW_CALL fwContext_RegisterTarget(FwContext*, const FwVulkanTargetDef* def, FwTargetId* id);
/* Unregisters a target. The host has waited for its frames. [any] */
FW_API FwResult FW_CALL fwContext_UnregisterTarget(FwContext*, FwTargetId id);
/* Schedules the end of a target: fwContext_Collect unregisters it once its completedFrameIndex is at least `frameIndex`, the
 * last frame that draws with it. [any] */
FW_API FwResult FW_CALL fwContext_UnregisterTargetAfterFrame(FwContext*, FwTargetId id, uint64_t frameIndex);

typedef struct FwPipelineProgress {
    uint32_t structSize;
    uint32_t made, total;    /* pipelines that exist; pipelines that are needed. `total` grows when registrations begin and, with
                                FW_TARGET_AS_NEEDED, when objects of new kinds of material are created */
    uint32_t reserved;
} FwPipelineProgress;
/* Returns FW_OK if record calls on the target draw. `progress` (may be null) counts the pipelines of fwContext_Prepare and of
 * the target. A null id stands for the context and all its targets, including registrations in progress: for a loading bar
 * while workers prepare and register. Never waits. FW_NOT_READY: fwContext_Prepare has not finished (record calls record
 * nothing), or pipelines of the target are still being created. FW_ERROR_STALE_ID: the target is gone. [any] */
FW_API FwResult FW_CALL fwTarget_IsReady(FwContext*, FwTargetId id, FwPipelineProgress* progress);

typedef enum FwFrameFlags {
    FW_FRAME_SECONDARY = 1,      /* commandBuffer is a secondary one */
    FW_FRAME_SLOT_PACING = 2,    /* frameSlot and framesInFlight replace completedFrameIndex */
    FW_FRAME_FLAGS_FORCE32 = 0x7fffffff
} FwFrameFlags;
typedef struct FwVulkanFrame {
    uint32_t structSize, flags;      /* flags: FwFrameFlags, default 0 */
    VkCommandBuffer commandBuffer;   /* in the recording state */
    uint64_t frameIndex;             /* starts at 1 and grows by one a frame, also with FW_FRAME_SLOT_PACING */
    uint64_t completedFrameIndex;    /* below frameIndex, default 0. The GPU has finished this frame and all before it, so that
                                        the library may reuse their memory */
    uint32_t frameSlot, framesInFlight; /* slot pacing: [0, framesInFlight) and [1, 16]. The slot's last use has finished */
    float deltaTime;                 /* s, [0, 10], default 0. Only for RecordOutside */
    VkImageLayout sampledDepthLayout; /* layout of sampledDepth during the draws: GENERAL or one of the READ_ONLY ones */
    VkImageView sampledDepth;        /* RecordInside on a target with FW_DEPTH_SAMPLED: a view of the depth aspect alone,
                                        readable by fragment shaders */
    VkImageView sampledColor;        /* optional. RecordInside and RecordComposite on a target with FW_TARGET_HAZE or
                                        FW_TARGET_TRANSPARENCY: a copy of the target's content before the draws, of its size and
                                        encoding, one sample, readable by fragment shaders. Null: no haze. Haze is drawn before
                                        all flames, only by fires that are marched with all samples (FW_FIRE_TIER_MARCH_HIGH) */
    VkImageLayout sampledColorLayout; /* GENERAL or SHADER_READ_ONLY_OPTIMAL */
    uint32_t reserved;               /* 0 */
    VkRect2D scissor;                /* px, offset and extent in [0, 32768], default extent 0: the whole viewport. RecordInside
                                        and RecordComposite draw only within it and the viewport */
    float transparency;              /* [0, 1], default 0; 1: nothing is drawn. RecordInside and RecordComposite; 1 - opacity of
                                        an item of a user interface. This share of the host's picture shows through all draws of
                                        the library, taken together: no surface shows through another one, and no flame is fainter
                                        than its surface. Between 0 and 1 it needs a target with FW_TARGET_TRANSPARENCY and
                                        sampledColor; otherwise FW_ERROR_INVALID_ARGUMENT. All four channels mix as the target
                                        blends: stored values on UNORM and float, light on sRGB. Depth is written as without it */
    uint32_t reserved1;              /* 0 */
} FwVulkanFrame;
static inline FwVulkanFrame fwDefaultVulkanFrame(void) {
    FwVulkanFrame d; fwInitDef(FW_DEF_VULKAN_FRAME, &d, (uint32_t)sizeof d); return d;
}

/* Simulates and prepares the draws: records uploads, compute and readback copies to `commandBuffer`, outside any render pass.
 * Call it once a frame. A secondary buffer is fine. Ends with the barriers that the draws need. After warm-up it never submits,
 * waits, stalls on a map, allocates or creates pipelines. FW_NOT_READY: fwContext_Prepare has not finished; nothing was
 * recorded. FW_ERROR_WRONG_BACKEND: own device or cpu backend. [record] */
FW_API FwResult FW_CALL fwWorld_RecordOutside(FwWorld*, const FwVulkanFrame* frame, const FwView* view);
#define FW_MAX_VIEWS 4 /* of a frame */
/* As fwWorld_RecordOutside, for several views of one frame: the eyes of a headset, the players of a split screen. The world is
 * simulated once. For each view the library marches the volumetric fires and sorts flames and particles as for a single one.
 * viewCount: [1, FW_MAX_VIEWS]; the views lie views[0].structSize bytes apart. Each view has its own viewId, by which the
 * library finds it again in the next frame: the march of a fire reuses its last frames.
 * A draw uses the view of this frame with the same camera and light; else the one with its viewId; else the first. If its
 * camera differs from all of them, it marches volumetric fires while it draws (about 6 times the cost). Its quads then keep the
 * order of the view that it uses. Surfaces are refined for the view in which they are largest. Lights flicker by the time of the
 * first view, whose quads FwWorldStats::flames counts.
 * A view has buffers of its own from its first frame on: the rows "flame quads", "draw arguments", "marched volumes" and
 * "volumes' work" of the memory report. After 60 frames without the view they are freed, with its history. A fifth viewId
 * replaces the one that was absent longest. [record] */
FW_API FwResult FW_CALL fwWorld_RecordOutsideViews(FwWorld*, const FwVulkanFrame* frame, const FwView* views,
                                                  uint32_t viewCount);
/* Draws into the host's pass. Begins no barrier, dispatch, copy or pass. Shows the last fwWorld_RecordOutside, which need not
 * be of the same frame. The viewport is in px. At most 16 views a frame, and 16 draws a frame with a
 * sampled depth. FW_NOT_READY: nothing was recorded. [record] */
FW_API FwResult FW_CALL fwWorld_RecordInside(FwWorld*, const FwVulkanFrame* frame, FwTargetId target,
                                            const FwView* view, const VkViewport* viewport);

typedef struct FwVulkanImage { /* frozen */
    VkImage image;
    VkImageView view;
    VkImageLayout layoutBefore, layoutAfter;
    VkPipelineStageFlags stageBefore, stageAfter;
    VkAccessFlags accessBefore, accessAfter;
} FwVulkanImage;
typedef enum FwCompositeFlags {
    FW_COMPOSITE_KEEP = 1, /* the library keeps its framebuffer over these views for the next call with them */
    FW_COMPOSITE_FLAGS_FORCE32 = 0x7fffffff
} FwCompositeFlags;
typedef struct FwVulkanComposite {
    uint32_t structSize, flags;       /* flags: FwCompositeFlags, default 0 */
    uint32_t width, height;           /* px, of both images; 0 records nothing */
    FwVulkanImage color;              /* usage COLOR_ATTACHMENT */
    FwVulkanImage depth;              /* usage DEPTH_STENCIL_ATTACHMENT; with FW_DEPTH_SAMPLED usage SAMPLED and a view of the
                                         depth aspect alone */
} FwVulkanComposite;
static inline FwVulkanComposite fwDefaultVulkanComposite(void) {
    FwVulkanComposite d; fwInitDef(FW_DEF_VULKAN_COMPOSITE, &d, (uint32_t)sizeof d); return d;
}
/* Draws in a pass of the library over host images: primary buffer, outside any pass. Records the barriers from `...Before` to
 * its use and to `...After`. An extent of 0 records nothing. Without FW_COMPOSITE_KEEP each call creates a framebuffer, which
 * is freed when its frame has finished. With it nothing is created after warm-up: 16 framebuffers are
 * kept. The library then remembers the views until the target is unregistered or a call on it comes without the flag. Do one
 * of these before you destroy views, for example on a resize. [record] */
FW_API FwResult FW_CALL fwWorld_RecordComposite(FwWorld*, const FwVulkanFrame* frame, FwTargetId target,
                                               const FwView* view, const FwVulkanComposite* images);
typedef struct FwVulkanVertices { /* skinned vertices in a host buffer, in the order of the mesh */
    uint32_t structSize;
    uint32_t vertexCount;             /* that of the mesh */
    VkBuffer buffer;                  /* usage TRANSFER_SRC */
    uint64_t offset;                  /* bytes, a multiple of 4, default 0. First position: 3 floats, m, object space (in the
                                         mesh's unit) */
    uint32_t stride;                  /* bytes, a multiple of 4 in [12, 2048], default 12. From vertex to vertex */
    uint32_t normalOffset;            /* bytes, a multiple of 4 in [12, 2048], default 0: normals follow the triangles. From a
                                         position to its normal, 3 floats */
    VkPipelineStageFlags stageBefore, stageAfter; /* not 0. Stages that wrote the buffer; stages that use it afterwards */
    VkAccessFlags accessBefore, accessAfter;
} FwVulkanVertices;
static inline FwVulkanVertices fwDefaultVulkanVertices(void) {
    FwVulkanVertices d; fwInitDef(FW_DEF_VULKAN_VERTICES, &d, (uint32_t)sizeof d); return d;
}
/* Sets skinned vertices from a buffer, as fwWorld_SetVertexPositions does from memory. The next fwWorld_RecordOutside copies the
 * buffer, with barriers before and after, and forgets the handle. Call it for each frame in which vertices move. Ignitions,
 * queries and tags use the last fwWorld_SetVertexPositions, or the rest pose. [world] */
FW_API FwResult FW_CALL fwWorld_SetVertexBuffer(FwWorld*, FwBurnableMeshId id, const FwVulkanVertices* vertices);
/* Reports a lost device: nothing more is recorded; destroy functions still free. The library detects the loss by itself when a
 * Vulkan call reports it. To recover, keep the bytes of a save (fwWorld_RequestSave) every few seconds. Destroy the context,
 * create one on a new device, and create a world with the same things in the same order. Then fwWorld_Load those bytes: the fire
 * continues from there, bit for bit. fwWorld_FetchSave still works on the lost world. [any] */
FW_API void FW_CALL fwContext_NotifyDeviceLost(FwContext*);

#ifdef __cplusplus
} /* extern "C" */
#endif
#endif
