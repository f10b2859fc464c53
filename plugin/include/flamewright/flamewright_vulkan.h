/* flamewright/flamewright_vulkan.h: what a Vulkan host lends. Nothing here becomes ours; no handle
 * is remembered past the call it came with, but for the device, registered render passes and views
 * that you ask to keep (FW_COMPOSITE_KEEP).
 *
 * A frame: fwWorld_RecordOutside (compute, copies, barriers; outside any pass), then, in the host's
 * own render pass, fwWorld_RecordInside (draws only). Or fwWorld_RecordComposite: our own pass over
 * host images. After each of them treat as undefined, in that command buffer: bound graphics and
 * compute pipelines, all descriptor sets, push constants, vertex and index buffers (bindings
 * 0..1), and all dynamic state: viewport, scissor, and what our pipelines hold fixed (blend
 * constants, stencil masks and references, depth bias and bounds, line width). All else (render
 * pass, queries, labels, further vertex bindings) is as you left it. */
/* Laid out by hand, to be read. */
/* clang-format off */
#ifndef FLAMEWRIGHT_FLAMEWRIGHT_VULKAN_H
#define FLAMEWRIGHT_FLAMEWRIGHT_VULKAN_H
#include "flamewright/flamewright.h"
#ifndef VK_VERSION_1_0
#include <vulkan/vulkan_core.h> /* types only: we call through getInstanceProcAddr */
#endif
#ifdef __cplusplus
extern "C" {
#endif

/* Needs Vulkan 1.0 and nothing else. What else you enabled must be declared here, for Vulkan cannot
 * be asked; anything not declared counts as off. */
typedef struct FwVulkanHost {
    uint32_t structSize;
    uint32_t apiVersion;                 /* of the instance and device as created; 0: VK_API_VERSION_1_0 */
    PFN_vkGetInstanceProcAddr getInstanceProcAddr; /* required */
    VkInstance instance;
    VkPhysicalDevice physicalDevice;
    VkDevice device;
    uint32_t queueFamilyIndex;           /* family of the queue that will run our commands; graphics + compute */
    uint32_t enabledExtensionCount;
    const char* const* enabledExtensions;  /* device extensions */
    uint32_t enabledInstanceExtensionCount;
    uint32_t reserved;
    const char* const* enabledInstanceExtensions;
    const VkPhysicalDeviceFeatures* enabledFeatures; /* null: none */
    const void* enabledFeatureChain;     /* VkPhysicalDeviceFeatures2-style pNext chain, or null */
    VkPipelineCache pipelineCache;       /* optional; used, never destroyed */
    const VkAllocationCallbacks* allocationCallbacks; /* optional; must outlive the context */
} FwVulkanHost;
static inline FwVulkanHost fwDefaultVulkanHost(void) {
    FwVulkanHost d; fwInitDef(FW_DEF_VULKAN_HOST, &d, (uint32_t)sizeof d); return d;
}

/* For a host that makes its device after asking: what we would use if it were there. All optional. */
typedef struct FwVulkanWishes {
    uint32_t structSize;
    uint32_t minimumApiVersion;          /* VK_API_VERSION_1_0 */
    uint32_t extensionCount, instanceExtensionCount;
    const char* const* extensions;       /* static strings */
    const char* const* instanceExtensions;
    VkPhysicalDeviceFeatures features;   /* VK_TRUE where wished */
    VkQueueFlags queueFlags;             /* required of the queue family */
} FwVulkanWishes;
/* [any], before any context exists */
FW_API FwResult FW_CALL fwQueryVulkanWishes(FwVulkanWishes* wishes);

typedef enum FwDepthMode {
    FW_DEPTH_NONE = 0,      /* the target has no depth. Surfaces are drawn without one: right for flat sheets
                               that do not overlap; anything else shows its far sides (a warning says so) */
    FW_DEPTH_TEST = 1,      /* tested and written in the host's pass */
    FW_DEPTH_TEST_ONLY = 2, /* tested, never written by us: flames and smoke. Surfaces hide themselves by the
                               depth that they write, so this mode needs FW_TARGET_NO_SURFACES */
    FW_DEPTH_SAMPLED = 3,   /* sampled, not attached: flames and smoke, which fade softly where they
                               meet what the image holds. Surfaces need an attached depth: draw them
                               first, by a target of another mode with FW_TARGET_NO_FLAMES. */
    FW_DEPTH_MODE_FORCE32 = 0x7fffffff
} FwDepthMode;
typedef enum FwOutputEncoding {
    FW_OUTPUT_LINEAR = 0,  /* float format: scene-linear, times FwView::exposure; no tone mapping */
    FW_OUTPUT_SRGB_VIEW = 1,   /* sRGB format: times exposure, tone mapped by us; the format encodes */
    FW_OUTPUT_DISPLAY_UNORM = 2, /* UNORM format shown as it is: times exposure, tone mapped and sRGB-encoded by us */
    FW_OUTPUT_AUTO = 3,    /* default: the one of the three that colorFormat asks for. Registration refuses a format
                              that is not known to be float, sRGB or UNORM: name the encoding for it */
    FW_OUTPUT_ENCODING_FORCE32 = 0x7fffffff
} FwOutputEncoding;

typedef struct FwVulkanTargetDef {
    uint32_t structSize;
    uint32_t subpass;              /* 0 with FW_TARGET_COMPOSITE */
    VkRenderPass renderPass;       /* the host's; null only with FW_TARGET_COMPOSITE */
    VkFormat colorFormat;          /* of the attachment's view that the subpass writes (in its pColorAttachments[0], not
                                      of a resolve attachment) */
    VkFormat depthFormat;          /* of the subpass's depth attachment, or with FW_DEPTH_SAMPLED of the sampled image's
                                      view; UNDEFINED with FW_DEPTH_NONE */
    uint32_t samples;              /* 1, 2, 4, 8, 16: of the attachments, not of what was asked for; see renderPassInfo */
    uint32_t colorAttachmentCount; /* of the subpass, [1, 8]; we write the first and mask the others off: above 1 needs independentBlend declared */
    uint32_t viewMask;             /* 0; anything else is refused in this version */
    uint32_t depthMode;            /* FwDepthMode */
    uint32_t reversedDepth;        /* 1: near is 1 */
    uint32_t encoding;             /* FwOutputEncoding, default FW_OUTPUT_AUTO; refused if it contradicts colorFormat */
    uint32_t flags;                /* FwTargetFlags */
    uint32_t depthSamples;         /* of an image for FW_DEPTH_SAMPLED: 0 (default): as samples, or 1..16
                                      (of several its first sample counts) */
    const void* renderPassInfo;    /* default null. The VkRenderPassCreateInfo or VkRenderPassCreateInfo2 that made
                                      renderPass, read during the call alone. Vulkan cannot be asked what a pass holds: with
                                      this, registration checks subpass, colorFormat, depthFormat, samples and
                                      colorAttachmentCount against it. Without it only validation layers find a wrong one */
} FwVulkanTargetDef;
typedef enum FwTargetFlags {
    FW_TARGET_COMPOSITE = 1, /* for fwWorld_RecordComposite: we make the pass */
    FW_TARGET_NO_FLAMES = 2, /* surfaces alone */
    FW_TARGET_NO_SURFACES = 4, /* flames and smoke alone */
    FW_TARGET_HAZE = 8,      /* with FW_DEPTH_SAMPLED alone: hot gas in and above volumetric fires bends what is
                                behind it, in frames that lend FwVulkanFrame::sampledColor */
    FW_TARGET_HALF_EFFECTS = 16, /* with FW_TARGET_COMPOSITE and FW_DEPTH_SAMPLED alone: flames, smoke, particle fields
                                and volumetric fires are drawn at half resolution and laid over the picture at once,
                                along the edges of its depth. A third to two thirds of their time, and softer; sparks
                                stay as fine as the picture, and are seen through smoke before them. 2 bytes of device
                                memory a pixel, 3 of a float target, per world and size of target, from the first
                                frame on that has any */
    FW_TARGET_AS_NEEDED = 32, /* not all pipelines for surfaces at once: registration makes those for the kinds of
                                material that objects of the context had so far, and fwWorld_CreateBurnableMesh
                                those for a kind that is new, about a seventh of all (0.2 s on a software device);
                                fwWorld_DestroyImage, too, for objects that showed it. Never a record call.
                                renderPass must live until the target is unregistered */
    FW_TARGET_TRANSPARENCY = 64, /* frames may give FwVulkanFrame::transparency; one more pipeline, made at registration */
    FW_TARGET_FLAGS_FORCE32 = 0x7fffffff
} FwTargetFlags;
static inline FwVulkanTargetDef fwDefaultVulkanTargetDef(void) {
    FwVulkanTargetDef d; fwInitDef(FW_DEF_VULKAN_TARGET, &d, (uint32_t)sizeof d); return d;
}
/* Makes the target's pipelines, all of them or as FW_TARGET_AS_NEEDED says. Register again when the pass or sample
 * count changes. [any, also while recording: nothing is recorded] */
FW_API FwResult FW_CALL fwContext_RegisterTarget(FwContext*, const FwVulkanTargetDef* def, FwTargetId* id);
FW_API FwResult FW_CALL fwContext_UnregisterTarget(FwContext*, FwTargetId id); /* the host has waited [any] */
/* fwContext_Collect unregisters the target once its completedFrameIndex is at least `frameIndex`, the
 * last frame that draws with it. [any] */
FW_API FwResult FW_CALL fwContext_UnregisterTargetAfterFrame(FwContext*, FwTargetId id, uint64_t frameIndex);

typedef struct FwPipelineProgress {
    uint32_t structSize;
    uint32_t made, total;    /* pipelines: there now, and needed. total grows as registrations begin and, with
                                FW_TARGET_AS_NEEDED, as objects of new kinds of material are made */
    uint32_t reserved;
} FwPipelineProgress;
/* FW_OK: record calls on the target draw. FW_NOT_READY: fwContext_Prepare is not through (they would record
 * nothing), or pipelines that a target needs are still being made. `progress` may be null; it counts the pipelines of
 * fwContext_Prepare and of the target. Null id: of the context and all its targets, registrations in progress included:
 * for a loading bar, while workers prepare and register. FW_ERROR_STALE_ID. Waits for nobody. [any] */
FW_API FwResult FW_CALL fwTarget_IsReady(FwContext*, FwTargetId id, FwPipelineProgress* progress);

typedef enum FwFrameFlags {
    FW_FRAME_SECONDARY = 1,      /* commandBuffer is a secondary one */
    FW_FRAME_SLOT_PACING = 2,    /* frameSlot/framesInFlight are given instead of completedFrameIndex */
    FW_FRAME_FLAGS_FORCE32 = 0x7fffffff
} FwFrameFlags;
typedef struct FwVulkanFrame {
    uint32_t structSize, flags;      /* FwFrameFlags */
    VkCommandBuffer commandBuffer;   /* recording */
    uint64_t frameIndex;             /* starts at 1, grows by one for each frame; with FW_FRAME_SLOT_PACING, too */
    uint64_t completedFrameIndex;    /* the GPU is done with this one and all before: we may reuse */
    uint32_t frameSlot, framesInFlight; /* slot pacing: the slot's last use is done; 0 in flight is refused */
    float deltaTime;                 /* s, [0, 10]; RecordOutside only */
    VkImageLayout sampledDepthLayout; /* of the next while we draw: GENERAL or one of the READ_ONLY ones */
    VkImageView sampledDepth;        /* RecordInside on a target with FW_DEPTH_SAMPLED, where it is needed:
                                        its depth aspect alone, ready for our fragment shaders */
    VkImageView sampledColor;        /* optional, RecordInside and RecordComposite on a target with FW_TARGET_HAZE or
                                        FW_TARGET_TRANSPARENCY: a copy of what the target holds as we draw, of its size
                                        and with its encoding, one sample, ready for our fragment shaders. Null: no haze.
                                        Haze goes over the target before all flames; only fires that are marched with all
                                        their samples (FW_FIRE_TIER_MARCH_HIGH) have it */
    VkImageLayout sampledColorLayout; /* of it: GENERAL or SHADER_READ_ONLY_OPTIMAL */
    uint32_t reserved;               /* 0 */
    VkRect2D scissor;                /* RecordInside and RecordComposite: px of the target, drawn within it and the viewport
                                        alone; offset within [0, 32768]. Default: no extent, which is all of the viewport */
    float transparency;              /* RecordInside and RecordComposite: [0, 1], default 0; of an item of a user interface 1 less
                                        its opacity. So much of the host's picture shows through all that we draw, taken
                                        together: no surface is seen through another one, no flame is fainter than
                                        what it burns on. 1: nothing is drawn. Between 0 and 1 it needs a target with
                                        FW_TARGET_TRANSPARENCY, and sampledColor. All four channels are mixed as the target
                                        blends: as they are stored if it is UNORM or float, as light if it is sRGB. Our
                                        depth is written as without it. Else FW_ERROR_INVALID_ARGUMENT */
    uint32_t reserved1;              /* 0 */
} FwVulkanFrame;
static inline FwVulkanFrame fwDefaultVulkanFrame(void) {
    FwVulkanFrame d; fwInitDef(FW_DEF_VULKAN_FRAME, &d, (uint32_t)sizeof d); return d;
}

/* Simulates and prepares the drawing: uploads, compute, readback copies, all in `commandBuffer`,
 * outside any render pass, once per frame. A secondary buffer is fine. Ends with the barriers that
 * our draws need. Never submits, waits, maps with a stall, allocates or builds pipelines after
 * warm-up; FW_NOT_READY (nothing recorded) before fwContext_Prepare is through. [record] */
FW_API FwResult FW_CALL fwWorld_RecordOutside(FwWorld*, const FwVulkanFrame* frame, const FwView* view);
#define FW_MAX_VIEWS 4 /* of a frame */
/* The same for several views of one frame, as for the two eyes of a headset or the players of a split screen: the
 * world is simulated once, and for each view its volumetric fires are marched and its flames and particles ordered as
 * for the only one. viewCount: [1, FW_MAX_VIEWS]; the views lie views[0].structSize bytes apart. Each has a viewId of
 * its own, by which the library knows it again in the next frame (the march of a fire needs its last ones). Draws show
 * the view of the frame that has their camera and light, else the one with their viewId, else the first: with another
 * camera than any, volumetric fires are marched as they are drawn, at some six times the cost, and quads are in the
 * order of that view. Surfaces are refined for the view in which they are largest; lights flicker by the first view's
 * time, and FwWorldStats::flames counts its quads. A view has buffers of its own from its first frame on: as many bytes
 * as the rows "flame quads", "draw arguments", "marched volumes" and "volumes' work" of the memory report, which has
 * rows for them; after 60 frames without it they go, with what was known of it. A fifth viewId takes the place of the
 * one that was not given for longest. [record] */
FW_API FwResult FW_CALL fwWorld_RecordOutsideViews(FwWorld*, const FwVulkanFrame* frame, const FwView* views,
                                                  uint32_t viewCount);
/* Draws into the host's pass: no barrier, dispatch, copy or pass begins. Needs no same-frame
 * RecordOutside; then it shows the last one. Viewport in pixels. [record] */
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
    FW_COMPOSITE_KEEP = 1, /* our framebuffer over these views is kept for the next call with them */
    FW_COMPOSITE_FLAGS_FORCE32 = 0x7fffffff
} FwCompositeFlags;
typedef struct FwVulkanComposite {
    uint32_t structSize, flags;       /* FwCompositeFlags */
    uint32_t width, height;           /* pixels, >= 1; of both images */
    FwVulkanImage color;              /* usage COLOR_ATTACHMENT */
    FwVulkanImage depth;              /* usage DEPTH_STENCIL_ATTACHMENT, or SAMPLED in that mode: then
                                         the view has the depth aspect alone */
} FwVulkanComposite;
static inline FwVulkanComposite fwDefaultVulkanComposite(void) {
    FwVulkanComposite d; fwInitDef(FW_DEF_VULKAN_COMPOSITE, &d, (uint32_t)sizeof d); return d;
}
/* Our own pass over host images (primary buffer, outside any pass): we do the barriers from `before`
 * to our use and to `after`. Zero extents record nothing. Without FW_COMPOSITE_KEEP each call makes
 * a framebuffer and frees it when its frame is done. With it nothing is made after warm-up (16 are
 * kept); the views are remembered then, until the target is unregistered or a call on it comes
 * without the flag: do one of them when you destroy views, as on a resize. [record] */
FW_API FwResult FW_CALL fwWorld_RecordComposite(FwWorld*, const FwVulkanFrame* frame, FwTargetId target,
                                               const FwView* view, const FwVulkanComposite* images);
typedef struct FwVulkanVertices { /* skinned vertices in a buffer of yours, in the mesh's order */
    uint32_t structSize;
    uint32_t vertexCount;             /* the mesh's */
    VkBuffer buffer;                  /* usage TRANSFER_SRC */
    uint64_t offset;                  /* bytes, a multiple of 4: the first position, 3 floats, m, object space
                                         (in the mesh's unit) */
    uint32_t stride;                  /* bytes from vertex to vertex, a multiple of 4 in [12, 2048] */
    uint32_t normalOffset;            /* bytes from a position to its normal, 3 floats, a multiple of 4 in
                                         [12, 2048]; 0: none, they follow the triangles */
    VkPipelineStageFlags stageBefore, stageAfter; /* who wrote it, who uses it after us */
    VkAccessFlags accessBefore, accessAfter;
} FwVulkanVertices;
static inline FwVulkanVertices fwDefaultVulkanVertices(void) {
    FwVulkanVertices d; fwInitDef(FW_DEF_VULKAN_VERTICES, &d, (uint32_t)sizeof d); return d;
}
/* As fwWorld_SetVertexPositions, from a buffer: the next RecordOutside copies it, with the barriers
 * before and after, and forgets the handle. Call it for each frame in which they move. Ignitions,
 * queries and tags go by the last fwWorld_SetVertexPositions, or by the mesh at rest. [world] */
FW_API FwResult FW_CALL fwWorld_SetVertexBuffer(FwWorld*, FwBurnableMeshId id, const FwVulkanVertices* vertices);
/* Tell us the device is lost: nothing more is recorded, destroy still frees. We latch it, too, when a Vulkan call says
 * so. What then: the fire lives on in the last save (fwWorld_RequestSave; ask for one every few seconds and keep its
 * bytes: they are the mirror). Destroy the context, create one on a new device, a world and what it held in the same
 * order, and fwWorld_Load those bytes: the fire goes on from there, bit for bit, as if the device had never been lost.
 * fwWorld_FetchSave still works on the lost world. [any] */
FW_API void FW_CALL fwContext_NotifyDeviceLost(FwContext*);

#ifdef __cplusplus
} /* extern "C" */
#endif
#endif
