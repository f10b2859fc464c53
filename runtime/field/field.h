// Particle fields: fire, smoke and water as counts of particles on a small grid, for small devices
// and distant effects. The step (shaders/shared/field.h) uses integers and conserves every
// particle; this is its CPU form, with the designers' parameters.
#pragma once
#include "shared/field.h"

#include <array>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace fw::field {

using glm::ivec2;
using glm::vec2;
using gpu::FieldRules;
using gpu::FieldSource;

// One set of parameters for fire, smoke and water.
struct FieldAppearance {
    float amount = 1.0f;   // [0, 4]; 1 fills a cell of a source to white (255) in about 12 steps
    float rise = 0.9f;     // [-4, 4] cells a step, upwards; below 0 it falls
    float spread = 0.25f;  // [0, 1]; 1 is an eighth of a difference to each neighbour and step
    float memory = 0.5f;   // [0, 1]; share of its motion that a particle keeps, and its effect
    float chaos = 0.35f;   // [0, 4]; weight of a random direction
    float life = 0.7f;     // s, > 0, mean
    float detail = 0.7f;   // [0, 1]; drawn noise that the motion carries
    float body = 0.0f;     // [0, 2]; 0 emits light, 1 absorbs it, 2 refracts it
};

enum class FieldPreset : uint32_t { Fire, Smoke, Water };
constexpr uint32_t kFieldPresets = 3;
FieldAppearance fieldPreset(FieldPreset preset) noexcept;

struct FieldDef {
    uint32_t width = 64, height = 64;  // cells, [4, 256]; on a device the width in fours
    FieldAppearance appearance;
    uint32_t stepRate = 20;              // Hz, [1, 120]
    vec2 wind{0.0f};                     // cells a step
    uint32_t open = gpu::kFieldOpenTop;  // kFieldOpen bits, or kFieldRing
    uint32_t seed = 1;
};

// Rules without sources.
FieldRules fieldRules(const FieldDef& def) noexcept;

// Rate of a source: an amount of 1 fills a cell to white in about 12 steps.
uint32_t emissionRate(float amount) noexcept;

struct FieldCells {
    explicit FieldCells(std::pmr::memory_resource* memory) : cells(memory) {}
    uint32_t width = 0, height = 0;
    uint32_t step = 0;
    std::pmr::vector<uint32_t> cells;  // gpu::fieldCell, rows from the bottom
    // Invariant: total(field) + died + left == emitted + particles set from outside.
    uint64_t emitted = 0, died = 0, left = 0;

    template <class A>
    void serialize(A& a) {
        a(width, height, step, emitted, died, left);
        a.require(width - 1 < 256 && height - 1 < 256, "particle field");
        if constexpr (A::kReads) cells.resize(size_t(width) * height);
        a.plane(
            "particle field", cells.size(), width, {}, 0xFFFFFFFFu,
            [&](size_t i) { return cells[i]; }, [&](size_t i, uint32_t cell) { cells[i] = cell; });
    }
};

struct Field : FieldCells {
    explicit Field(std::pmr::memory_resource* memory)
        : FieldCells(memory), masks(memory), next(memory), given(memory) {}
    std::pmr::vector<uint8_t> masks;  // kFieldWall: holds no particle and takes none
    // Of the current step.
    std::pmr::vector<uint32_t> next;
    std::pmr::vector<std::array<uint16_t, 8>> given;
};

// Makes an empty field without walls. width and height as in FieldDef.
void startField(Field& field, uint32_t width, uint32_t height);
// Sets the masks. Particles in new walls die; cells of removed walls are empty.
void maskField(Field& field, std::span<const uint8_t> masks) noexcept;
void stepField(Field& field, const FieldRules& rules) noexcept;
uint32_t cellAt(const Field& field, uint32_t x, uint32_t y) noexcept;  // particles
uint64_t total(const Field& field) noexcept;

}  // namespace fw::field
