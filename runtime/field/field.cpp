// The step of a particle field on one thread, and the conversion of its parameters to integers.
#include "field/field.h"

#include "core/assert.h"

#include <algorithm>
#include <cmath>

namespace fw::field {
namespace {

using namespace gpu;

// The column, wrapped in a ring.
int column(const Field& field, const FieldRules& rules, int x) noexcept {
    const int w = int(field.width);
    return (rules.open & kFieldRing) == 0 ? x : x < 0 ? x + w : x >= w ? x - w : x;
}

uint32_t fixed(float value, float one, float most) noexcept {
    return uint32_t(std::clamp(value * one, 0.0f, most) + 0.5f);
}

}  // namespace

FieldAppearance fieldPreset(FieldPreset preset) noexcept {
    switch (preset) {
        case FieldPreset::Smoke:
            return {0.6f, 0.5f, 0.5f, 0.6f, 0.3f, 3.0f, 0.4f, 1.0f};
        case FieldPreset::Water:
            return {1.0f, -1.0f, 0.3f, 0.8f, 0.1f, 6.0f, 0.3f, 2.0f};
        case FieldPreset::Fire:
            break;
    }
    return {};
}

FieldRules fieldRules(const FieldDef& def) noexcept {
    FW_ASSERT(def.stepRate > 0 && def.appearance.life > 0, "%u Hz, life %g s", def.stepRate,
              double(def.appearance.life));
    const FieldAppearance& appearance = def.appearance;
    FieldRules rules{};
    rules.forceX = int(std::lround(std::clamp(def.wind.x, -4.0f, 4.0f) * 128));
    rules.forceY = int(std::lround(std::clamp(appearance.rise + def.wind.y, -4.0f, 4.0f) * 128));
    // Half: with all of it, particles would never slow down.
    rules.inertia = fixed(0.5f * appearance.memory, 256, 256);
    rules.chaos = fixed(appearance.chaos, 256, 1024);
    rules.spread = fixed(appearance.spread, float(kMaxFieldSpread), float(kMaxFieldSpread));
    rules.memory = fixed(appearance.memory, 128, 128);
    rules.death = fixed(1 - float(std::exp(double(-1 / (appearance.life * float(def.stepRate))))),
                        65536, 65535);
    rules.seed = def.seed;
    rules.width = def.width;
    rules.height = def.height;
    rules.open = def.open;
    return rules;
}

uint32_t emissionRate(float amount) noexcept { return fixed(amount * 255 / 12, 256, 1u << 16); }

void startField(Field& field, uint32_t width, uint32_t height) {
    FW_ASSERT(width >= 4 && height >= 4 && width <= kMaxFieldSide && height <= kMaxFieldSide,
              "%u x %u cells", width, height);
    const size_t count = size_t(width) * height;
    std::pmr::memory_resource* memory = field.cells.get_allocator().resource();
    Field fresh(memory);
    fresh.cells.resize(count, fieldCell(0, uvec2(kFieldStill)));
    fresh.next.resize(count);
    fresh.masks.resize(count);
    fresh.given.resize(count);
    fresh.width = width, fresh.height = height;
    field = std::move(fresh);
}

void maskField(Field& field, std::span<const uint8_t> masks) noexcept {
    FW_ASSERT(masks.size() == field.cells.size(), "%zu of %zu cells", masks.size(),
              field.cells.size());
    for (size_t i = 0; i < field.cells.size(); ++i) {
        const bool wall = masks[i] == kFieldWall;
        if (wall) field.died += fieldNumber(field.cells[i]);
        if (wall)
            field.cells[i] = kFieldWallCell;
        else if (field.cells[i] == kFieldWallCell)
            field.cells[i] = fieldCell(0, uvec2(kFieldStill));
        field.masks[i] = masks[i];
    }
}

void stepField(Field& field, const FieldRules& rules) noexcept {
    const int w = int(field.width), h = int(field.height);
    FW_ASSERT(rules.width == field.width && rules.height == field.height,
              "%u x %u and %u x %u cells", rules.width, rules.height, field.width, field.height);
    FW_ASSERT(field.next.size() == field.cells.size() && field.given.size() == field.cells.size(),
              "%zu and %zu of %zu cells", field.next.size(), field.given.size(),
              field.cells.size());
    const FieldWeights weights = fieldWeights(rules);
    const uint giving = fieldKey(field.step, rules.seed, 0);
    const uint chance = fieldKey(field.step >> 2, rules.seed, 1);
    const uint dying = fieldKey(field.step, rules.seed, 2);
    const uint emitting = fieldKey(field.step, rules.seed, 3);
    const auto at = [&](int x, int y) { return size_t(y * w + column(field, rules, x)); };
    const auto inside = [&](int x, int y) {
        const int i = column(field, rules, x);
        return i >= 0 && y >= 0 && i < w && y < h;
    };
    const auto open = [&](int x, int y) {  // for places outside
        return (x >= 0 || (rules.open & kFieldOpenLeft)) &&
               (x < w || (rules.open & kFieldOpenRight)) &&
               (y >= 0 || (rules.open & kFieldOpenBottom)) &&
               (y < h || (rules.open & kFieldOpenTop));
    };
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            const uint cell = field.cells[at(x, y)], n = fieldNumber(cell);
            std::array<uint16_t, 8>& given = field.given[at(x, y)];
            given = {};
            if (n == 0) continue;
            FieldEight around, rooms;
            for (uint k = 0; k < 8; ++k) {
                const ivec2 d = fieldNeighbour(k);
                const int i = (rules.open & kFieldRing) ? column(field, rules, x + d.x) : x + d.x;
                const bool is = inside(x + d.x, y + d.y);
                // Walls are full, and no particle spreads over a border.
                const uint there =
                    is ? field.cells[at(x + d.x, y + d.y)] & kMaxFieldCell : kMaxFieldCell;
                around.k[k] = there * rules.spread;
                rooms.k[k] = is ? fieldRoom(there) : open(i, y + d.y) ? fieldRoom(0) : 0;
            }
            const uint random = fieldRandom(giving, uint(x) >> 2, uint(y));
            const ivec2 push = fieldChaos(fieldRandom(chance, uint(x) >> 2, uint(y + 1) >> 2));
            const FieldPushes pushes = fieldPushes(weights, push);
            const FieldGiver giver =
                fieldGiver(cell, pushes.sum, rules.spread, weights.inertia, weights.inertiaDiagonal,
                           fieldDither(random, uint(x)));
            FieldEight to;
            for (const uint first : {7u, 3u}) {
                uint sum = first == 7 ? giver.ahead : giver.behind;
                for (uint i = 0; i < 4; ++i) {
                    const uint k = (first + i) & 7, before = sum;
                    sum += fieldFlow(giver, k, pushes.to.k[k], around.k[k], rooms.k[k]);
                    to.k[k] = fieldGiven(before, sum);
                }
            }
            for (uint k = 0; k < 8; ++k) {
                const ivec2 d = fieldNeighbour(k);
                given[k] = uint16_t(to.k[k]);
                if (!inside(x + d.x, y + d.y)) field.left += to.k[k];
            }
        }
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            const uint cell = field.cells[at(x, y)];
            uint32_t& next = field.next[at(x, y)];
            next = kFieldWallCell;
            if (cell == kFieldWallCell) continue;
            uint n = fieldNumber(cell);
            for (const uint16_t to : field.given[at(x, y)]) {
                FW_ASSERT(to <= n, "%u of %u particles leave", to, n);
                n -= to;
            }
            const uvec2 motion = fieldMotionOf(cell);
            uint sumX = n * fieldCarried(motion.x, 0, rules.memory);
            uint sumY = n * fieldCarried(motion.y, 0, rules.memory);
            for (uint k = 0; k < 8; ++k) {
                const ivec2 d = fieldNeighbour(k);
                if (!inside(x + d.x, y + d.y)) continue;
                const size_t from = at(x + d.x, y + d.y);
                const uint came = field.given[from][k ^ 4u];
                const uvec2 theirs = fieldMotionOf(field.cells[from]);
                const ivec2 u = fieldDirection(k ^ 4u);
                n += came;
                sumX += came * fieldCarried(theirs.x, fieldSpeed(u.x), rules.memory);
                sumY += came * fieldCarried(theirs.y, fieldSpeed(u.y), rules.memory);
            }
            const uvec2 now{fieldMean(sumX, n), fieldMean(sumY, n)};
            const uint dead = fieldDeaths(
                n, rules.death, fieldWindow(fieldRandom(dying, uint(x) >> 2, uint(y)), uint(x)));
            n -= dead;
            const uint fresh = fieldEmission(uint(x), uint(y), n, field.masks[at(x, y)], rules,
                                             fieldRandom(emitting, uint(x), uint(y)));
            next = fieldCell(n + fresh, now);
            field.died += dead;
            field.emitted += fresh;
        }
    field.cells.swap(field.next);
    ++field.step;
}

uint32_t cellAt(const Field& field, uint32_t x, uint32_t y) noexcept {
    FW_ASSERT(x < field.width && y < field.height, "cell (%u, %u)", x, y);
    return fieldNumber(field.cells[size_t(y) * field.width + x]);
}

uint64_t total(const Field& field) noexcept {
    uint64_t sum = 0;
    for (const uint32_t cell : field.cells) sum += fieldNumber(cell);
    return sum;
}

}  // namespace fw::field
