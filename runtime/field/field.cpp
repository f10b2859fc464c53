// The step of a particle field on one thread, and from a designer's parameters to its integers.
#include "field/field.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>

namespace fw::field {
namespace {

using namespace gpu;

// Bit k: no way from cell (x, y) in direction k.
uint32_t closedWays(const Field& field, const FieldRules& rules, int x, int y) noexcept {
    const int w = int(field.width), h = int(field.height);
    uint32_t closed = 0;
    for (uint32_t k = 0; k < 8; ++k) {
        const ivec2 d = fieldNeighbour(k);
        const int i = x + d.x, j = y + d.y;
        const bool out = (i < 0 && !(rules.open & kFieldOpenLeft)) ||
                         (i >= w && !(rules.open & kFieldOpenRight)) ||
                         (j < 0 && !(rules.open & kFieldOpenBottom)) ||
                         (j >= h && !(rules.open & kFieldOpenTop));
        const bool inside = i >= 0 && i < w && j >= 0 && j < h;
        if (out || (inside && field.walls[size_t(j * w + i)])) closed |= 1u << k;
    }
    return closed;
}

void check(const char* name, float value, float low, float high) {
    if (!(value >= low && value <= high))
        core::fail(FW_ERROR_INVALID_ARGUMENT, "%s is %g; it must lie in [%g, %g].", name,
                   double(value), double(low), double(high));
}

uint32_t fixed(float value, float one, float most) noexcept {
    return uint32_t(std::clamp(value * one, 0.0f, most) + 0.5f);
}

}  // namespace

FieldLook fieldPreset(FieldPreset preset) noexcept {
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

void checkField(const FieldDef& def) {
    check("width", float(def.width), 4, float(kFieldSideMost));
    check("height", float(def.height), 4, float(kFieldSideMost));
    check("stepRate", float(def.stepRate), 1, 120);
    check("wind.x", def.wind.x, -4, 4);
    check("wind.y", def.wind.y, -4, 4);
    check("look.amount", def.look.amount, 0, 4);
    check("look.rise", def.look.rise, -4, 4);
    check("look.spread", def.look.spread, 0, 1);
    check("look.memory", def.look.memory, 0, 1);
    check("look.chaos", def.look.chaos, 0, 4);
    check("look.life", def.look.life, 0.01f, 1e6f);
    check("look.detail", def.look.detail, 0, 1);
    check("look.body", def.look.body, 0, 2);
    if (def.open > 15)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "open is %u; it holds four bits, up to 15.",
                   def.open);
}

FieldRules fieldRules(const FieldDef& def) noexcept {
    const FieldLook& look = def.look;
    FieldRules rules{};
    rules.forceX = int(std::lround(std::clamp(def.wind.x, -4.0f, 4.0f) * 128));
    rules.forceY = int(std::lround(std::clamp(look.rise + def.wind.y, -4.0f, 4.0f) * 128));
    // Half: with all of it, what moves would never slow down.
    rules.inertia = fixed(0.5f * look.memory, 256, 256);
    rules.chaos = fixed(look.chaos, 256, 1024);
    rules.spread = fixed(look.spread, float(kFieldSpreadMost), float(kFieldSpreadMost));
    rules.memory = fixed(look.memory, 256, 256);
    rules.death = fixed(1 - std::exp(-1 / (look.life * float(def.stepRate))), 65536, 65535);
    rules.seed = def.seed;
    rules.width = def.width;
    rules.height = def.height;
    rules.open = def.open;
    return rules;
}

void addDefaultSource(FieldRules& rules, const FieldLook& look) noexcept {
    if (rules.sourceCount >= kFieldSources) return;
    const int w = int(rules.width), h = int(rules.height);
    const int half = std::max(w / 10, 1), rows = std::max(h / 32, 1);
    const bool falls = look.rise < 0;
    FieldSource& source = rules.sources[rules.sourceCount++];
    source.cells = {w / 2 - half, falls ? h - rows : 0, w / 2 + half, falls ? h : rows};
    source.rate = fixed(look.amount * 255 / 12, 256, 1u << 20);
}

void startField(Field& field, uint32_t width, uint32_t height) {
    const size_t count = size_t(width) * height;
    std::pmr::memory_resource* memory = field.cells.get_allocator().resource();
    Field fresh(memory);
    fresh.cells.resize(count);
    fresh.next.resize(count);
    fresh.walls.resize(count);
    fresh.shares.resize(count);
    fresh.width = width, fresh.height = height;
    field = std::move(fresh);
}

void stepField(Field& field, const FieldRules& rules) noexcept {
    const int w = int(field.width), h = int(field.height);
    const auto at = [&](int x, int y) { return size_t(y * w + x); };
    const auto inside = [&](int x, int y) { return x >= 0 && y >= 0 && x < w && y < h; };
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            const FieldCell& cell = field.cells[at(x, y)];
            glm::uvec4& shares = field.shares[at(x, y)];
            shares = glm::uvec4(0);
            if (cell.n == 0) continue;
            uint around[8];
            for (uint k = 0; k < 8; ++k) {
                const ivec2 d = fieldNeighbour(k);
                // Nothing spreads over a border: beyond it is as much as here.
                around[k] = inside(x + d.x, y + d.y) ? field.cells[at(x + d.x, y + d.y)].n : cell.n;
            }
            const uint random = fieldRandom(uint(x), uint(y), field.step, rules.seed, 0);
            shares =
                fieldShares(cell.n, cell.mean, around, closedWays(field, rules, x, y), rules,
                            fieldChaos(uint(x), uint(y), field.step, rules.seed), random & 255);
            for (uint k = 0; k < 8; ++k) {
                const ivec2 d = fieldNeighbour(k);
                if (!inside(x + d.x, y + d.y)) field.left += fieldShare(shares, k);
            }
        }
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            const FieldCell& cell = field.cells[at(x, y)];
            FieldCell& next = field.next[at(x, y)];
            next = {};
            if (field.walls[at(x, y)]) continue;
            const uint stayed = cell.n - fieldShareSum(field.shares[at(x, y)]);
            uint came[8];
            ivec2 means[8];
            uint n = stayed;
            for (uint k = 0; k < 8; ++k) {
                const ivec2 d = fieldNeighbour(k);
                const bool is = inside(x + d.x, y + d.y);
                came[k] = is ? fieldShare(field.shares[at(x + d.x, y + d.y)], k ^ 4u) : 0;
                means[k] = is ? field.cells[at(x + d.x, y + d.y)].mean : ivec2(0);
                n += came[k];
            }
            next.mean = fieldMotion(stayed, cell.mean, came, means, rules.memory);
            const uint random = fieldRandom(uint(x), uint(y), field.step, rules.seed, 2);
            const uint dead = fieldDeaths(n, rules.death, random);
            const uint fresh = fieldEmission(uint(x), uint(y), n - dead, rules, random);
            next.n = n - dead + fresh;
            field.died += dead;
            field.emitted += fresh;
        }
    field.cells.swap(field.next);
    ++field.step;
}

uint64_t total(const Field& field) noexcept {
    uint64_t sum = 0;
    for (const FieldCell& cell : field.cells) sum += cell.n;
    return sum;
}

}  // namespace fw::field
