// Flame and smoke quads of one view: made from burning tiles, ordered, drawn.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kMakeUses[] = {
    {FW_BIND_OBJECTS, Access::read},     {FW_BIND_MATERIALS, Access::read},
    {FW_BIND_TEXELS, Access::read},      {FW_BIND_NORMALS, Access::read},
    {FW_BIND_STATE, Access::read},       {FW_BIND_COUNTERS, Access::read},
    {FW_BIND_BURN_TILES, Access::read},  {FW_BIND_LIGHT_CELLS, Access::read},
    {FW_BIND_TILE_STATE, Access::read},  {FW_BIND_LOOKS, Access::read},
    {FW_BIND_FLAMES, Access::write},     {FW_BIND_DRAW_ARGS, Access::write},
    {FW_BIND_VIEW, Access::uniformView}, {FW_BIND_SKIN_TEXELS, Access::read},
    {FW_BIND_SHOWN, Access::read},       {FW_BIND_BOOKS, Access::read},
};
constexpr Use kSortUses[] = {
    {FW_BIND_FLAMES, Access::read},
    {FW_BIND_DRAW_ARGS, Access::write},
    {FW_BIND_VIEW, Access::uniformView},
};
constexpr Use kDrawUses[] = {
    {FW_BIND_FLAMES, Access::drawRead},
    {FW_BIND_DRAW_ARGS, Access::drawRead},
    {FW_BIND_DRAW_ARGS, Access::indirect},
    {FW_BIND_VIEW, Access::uniformView},
};
constexpr Use kBookUses[] = {
    {FW_BIND_FLAMES, Access::drawRead},    {FW_BIND_DRAW_ARGS, Access::drawRead},
    {FW_BIND_DRAW_ARGS, Access::indirect}, {FW_BIND_BOOKS, Access::drawRead},
    {FW_BIND_VIEW, Access::uniformView},
};

constexpr DrawPass bookVariant(uint32_t pagesAlone) {
    return {.name = "book flames",
            .vertexShader = "book_flames.vert",
            .fragmentShader = "book_flames.frag",
            .uses = kBookUses,
            .vertexInput = VertexInput::none,
            .blend = Blend::premultiplied,
            .writeDepth = false,
            .pushBytes = 0,
            .variant = pagesAlone,
            .softShader = "book_flames_soft.frag",
            .softShaderMultisampled = "book_flames_soft_ms.frag",
            .atHalf = AtHalf::soft};
}
// Of `pass`: its sparks alone, over what was drawn at half resolution.
constexpr DrawPass halfSparks(DrawPass pass) {
    pass.name = "half sparks";
    pass.fragmentShader = nullptr;
    pass.atHalf = AtHalf::sparks;
    return pass;
}
constexpr DrawPass kFlames{.name = "flames",
                           .vertexShader = "flames.vert",
                           .fragmentShader = "flames.frag",
                           .uses = kDrawUses,
                           .vertexInput = VertexInput::none,
                           .blend = Blend::premultiplied,
                           .writeDepth = false,
                           .pushBytes = 0,
                           .softShader = "flames_soft.frag",
                           .softShaderMultisampled = "flames_soft_ms.frag",
                           .atHalf = AtHalf::soft};

}  // namespace

const ComputePass kFlameQuadsPass{"flame quads", "flames.comp", kMakeUses, sizeof(StepPush)};
const ComputePass kFlameSortPass{"flame sort", "flame_sort.comp", kSortUses, sizeof(SortPush)};
const DrawPass kFlamesPass = kFlames;
// Where the world has flipbooks: what is shown by none costs five texels more there, and where they
// show all of it the noise is saved.
const DrawPass kBookFlamesPasses[kBookVariants] = {bookVariant(0), bookVariant(1)};

const DrawPass kHalfSparksPasses[2] = {halfSparks(kFlames), halfSparks(bookVariant(1))};

void recordHalfSparks(DrawRecorder& recorder) {
    recorder.drawIndirect(FW_BIND_DRAW_ARGS, kFlameLightDraw * 4);
}

void recordFlames(DrawRecorder& recorder) { recorder.drawIndirect(FW_BIND_DRAW_ARGS, 0); }

}  // namespace fw::gpu
