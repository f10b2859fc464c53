// Sources and contents of particle fields in tests.
#pragma once
#include "field/field.h"

#include <algorithm>

namespace fw::field {

// A bed along the bottom (fire, smoke) or a spout at the top (a field that falls), a fifth of the
// width.
inline void addDefaultSource(FieldRules& rules, const FieldAppearance& look) noexcept {
    if (rules.sourceCount >= gpu::kFieldSources) return;
    const int w = int(rules.width), h = int(rules.height);
    const int half = std::max(w / 10, 1), rows = std::max(h / 32, 1);
    const bool falls = look.rise < 0;
    FieldSource& source = rules.sources[rules.sourceCount++];
    source.cells = {w / 2 - half, falls ? h - rows : 0, w / 2 + half, falls ? h : rows};
    source.rate = emissionRate(look.amount);
}

// Sets a cell to `n` particles, at most gpu::kMaxFieldCell, at rest.
inline void fillCell(Field& field, uint32_t x, uint32_t y, uint32_t n) noexcept {
    field.cells[size_t(y) * field.width + x] =
        gpu::fieldCell(std::min(n, gpu::kMaxFieldCell), gpu::uvec2(gpu::kFieldStill));
}

}  // namespace fw::field
