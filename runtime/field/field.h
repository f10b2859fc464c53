// Particle fields: fire, smoke and water as counts of particles on a small grid, for small devices
// and for what is far away. The step is integers (shaders/shared/field.h) and conserves every
// particle; this is its reference and what designers turn. Not the drawing.
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
struct FieldLook {
    float amount = 1.0f;   // [0, 4]; 1 fills a cell of a source to white (255) in about 12 steps
    float rise = 0.9f;     // [-4, 4] cells a step, upwards; below 0 it falls
    float spread = 0.25f;  // [0, 1]; 1 is an eighth of a difference to each neighbour and step
    float memory = 0.5f;   // [0, 1]; how much motion a particle keeps, and how much that moves it
    float chaos = 0.35f;   // [0, 4]; weight of a random direction
    float life = 0.7f;     // s, > 0, mean
    float detail = 0.7f;   // [0, 1]; of what is drawn: noise that the motion carries
    float body = 0.0f;     // [0, 2]; 0 emits light, 1 absorbs it, 2 refracts it
};

enum class FieldPreset : uint32_t { Fire, Smoke, Water };
constexpr uint32_t kFieldPresets = 3;
FieldLook fieldPreset(FieldPreset preset) noexcept;

struct FieldDef {
    uint32_t width = 64, height = 64;  // cells, [4, 256]; on a device the width in fours
    FieldLook look;
    uint32_t stepRate = 20;              // Hz, [1, 120]
    vec2 wind{0.0f};                     // cells a step
    uint32_t open = gpu::kFieldOpenTop;  // kFieldOpen bits, or kFieldRing
    uint32_t seed = 1;
};

// Throws a message with the field, its value and its limits.
void checkField(const FieldDef& def);
// Without sources. The def is one that checkField lets pass.
FieldRules fieldRules(const FieldDef& def) noexcept;

// Where it emits unless the host says otherwise: a bed along the bottom (fire, smoke), a spout at
// the top (what falls), a fifth of its width.
void addDefaultSource(FieldRules& rules, const FieldLook& look) noexcept;
// Of a source: an amount of 1 fills a cell to white in about 12 steps.
uint32_t emissionRate(float amount) noexcept;

struct FieldCells {
    explicit FieldCells(std::pmr::memory_resource* memory) : cells(memory) {}
    uint32_t width = 0, height = 0;
    uint32_t step = 0;
    std::pmr::vector<uint32_t> cells;  // gpu::fieldCell, rows from the bottom
    // total(field) + died + left == emitted + what was put there, always.
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
    std::pmr::vector<uint8_t> masks;  // kFieldWall: nothing is there, nothing goes there
    // Of the step under way.
    std::pmr::vector<uint32_t> next;
    std::pmr::vector<std::array<uint16_t, 8>> given;
};

// Empty, without walls. width and height as in FieldDef.
void startField(Field& field, uint32_t width, uint32_t height);
// Other masks; what is where a wall comes dies, where one goes nothing is.
void maskField(Field& field, std::span<const uint8_t> masks) noexcept;
// Particles of a cell become `n`, at most gpu::kFieldCellMost; they stand still.
void fillCell(Field& field, uint32_t x, uint32_t y, uint32_t n) noexcept;
void stepField(Field& field, const FieldRules& rules) noexcept;
uint32_t cellAt(const Field& field, uint32_t x, uint32_t y) noexcept;  // particles
uint64_t total(const Field& field) noexcept;

}  // namespace fw::field
