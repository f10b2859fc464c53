// A particle field as plain data: its checked def as rules and masks of its cells, and its draw
// record. The step is in field/field.h.
#pragma once
#include "field/field.h"
#include "flamewright/flamewright.h"
#include "shared/field.h"

namespace fw::components {

static_assert(field::kFieldPresets == FW_FIELD_PRESET_COUNT);

struct ParticleField : FwParticleFieldDef {
    explicit ParticleField(std::pmr::memory_resource* from)
        : FwParticleFieldDef{}, painted(from), walled(from), masks(from) {}

    field::FieldDef def;                        // without wind
    std::pmr::vector<uint8_t> painted, walled;  // the host's, one per cell
    std::pmr::vector<uint8_t> masks;            // both combined, for the backend
};

void setFieldPreset(FwParticleFieldDef& def, uint32_t preset) noexcept;
const char* fieldPresetName(uint32_t preset) noexcept;

// Throws core::Error if a value is out of its limits. `field` is new.
void makeParticleField(const FwParticleFieldDef& def, uint32_t ownSeed, ParticleField& field);
// Throw likewise, and then change nothing.
void setFieldPlace(ParticleField& field, const float position[3], const float rotation[4]);
void setFieldAmount(ParticleField& field, float amount);
// Null: unchanged. Updates the masks.
void paintField(ParticleField& field, const uint8_t* paint, const uint8_t* walls) noexcept;
// The field's rules in a wind, m/s.
[[nodiscard]] field::FieldRules rulesOf(const ParticleField& field, const float wind[3]) noexcept;
// Place of a point of the field, m, world; u, v: over the field, [0, 1]. A card is not turned to
// the camera here.
void cellPlace(const ParticleField& field, float u, float v, float (&out)[3]) noexcept;
// Number of steps in `ticks` after the field's start.
[[nodiscard]] uint32_t fieldSteps(const ParticleField& field, uint64_t ticks) noexcept;

// The draw record `ticks` after the field's start, after `steps` steps; `clock`: the world's ticks.
[[nodiscard]] gpu::FieldDraw fieldDraw(const ParticleField& field, double ticks, uint32_t steps,
                                       double clock) noexcept;

}  // namespace fw::components
