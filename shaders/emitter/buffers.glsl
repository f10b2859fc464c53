// Buffers of flame quads, particles and their display. A shader defines FW_EMITTER_<NAME> as the
// access it needs before it includes this.
#ifndef FW_EMITTER_BUFFERS_GLSL
#define FW_EMITTER_BUFFERS_GLSL
#include "shared/burn.h"
#include "shared/look.h"

layout(set = 0, binding = FW_BIND_VIEW, std140) uniform View { ViewParams view; };
#ifdef FW_EMITTER_LOOKS
layout(std430, set = 0, binding = FW_BIND_APPEARANCES) readonly buffer AppearancesBuffer { MaterialAppearance looks[]; };
#endif
#ifdef FW_EMITTER_FLAMES
layout(std430, set = 0, binding = FW_BIND_FLAMES) FW_EMITTER_FLAMES buffer FlamesBuffer { FlameQuad flameQuad[]; };
#endif
#ifdef FW_EMITTER_DRAW_ARGS
layout(std430, set = 0, binding = FW_BIND_DRAW_ARGS) FW_EMITTER_DRAW_ARGS buffer ArgsBuffer { uint drawArgs[]; };
#endif
#ifdef FW_EMITTER_BOOKS
#include "shared/flipbook.h"
layout(std430, set = 0, binding = FW_BIND_FLIPBOOKS) readonly buffer FlipbooksBuffer { uint books[]; };

// Makes a flipbook (`book` - 1; 0: none) show a quad. True: it loops. life, age, own: as
// flipbookTime's.
bool showByBook(inout FlameQuad quad, uint book, float life, float age, float own) {
    if (book == 0u) return false;
    uint at = (book - 1u) * kFlipbookRecordWords;
    bool loops = (books[at + 6u] & kFlipbookLoops) != 0u;
    quad.phase = flipbookTime(loops, uintBitsToFloat(books[at + 8u]), life, age, own);
    quad.kind |= book << kQuadFlipbookShift;
    return loops;
}
#endif
#ifdef FW_EMITTER_EMITTERS
#include "shared/particle.h"
layout(std430, set = 0, binding = FW_BIND_EMITTERS) readonly buffer EmittersBuffer { ParticleEmitter emitters[]; };
layout(std430, set = 0, binding = FW_BIND_EMITTER_GROUPS) readonly buffer GroupsBuffer {
    uvec2 groups[];  // emitter, first slot of its ring
};
#endif
#endif
