// The template, its status rules and its heat boundary.
#include "reference/pattern.h"

#include <algorithm>
#include <cmath>

namespace fw::reference {
namespace {

constexpr float kPi = 3.14159265f;

PatternTriangle make(const uint8_t (&a)[2], const uint8_t (&b)[2], const uint8_t (&c)[2],
                     uint32_t setLevel, uint32_t parent) {
    return {{{a[0], a[1]}, {b[0], b[1]}, {c[0], c[1]}}, uint8_t(setLevel), parent, kPatternNone};
}

// The rules read `seen` and write `status`; serial sweeps hand over one array for both.
class Sweep {
 public:
    Sweep(std::span<const PatternTriangle> pattern, PatternRules rules,
          std::span<const int8_t> seen, std::span<int8_t> status)
        : pattern_(pattern),
          repaired_(rules == PatternRules::repaired),
          seen_(seen),
          status_(status) {}

    uint32_t run(std::span<const uint8_t> eligible) {
        const uint32_t finest = pattern_.back().setLevel;
        const uint32_t count = uint32_t(pattern_.size());
        for (uint32_t i = count; i-- > 1;)
            if (pattern_[i].setLevel == finest && seen_[i] == kPatternInitial && eligible[i] != 0) {
                const uint32_t child = pattern_[pattern_[i].parent].firstChild;
                for (uint32_t k = child; k < child + 4; ++k) set(k, kPatternActive);
                set(pattern_[i].parent, kPatternProcessed);
            }
        for (uint32_t i = count; i-- > 1;)
            if (pattern_[i].setLevel < finest && seen_[i] > kPatternInitial) raiseFamily(i);
        for (uint32_t i = count; i-- > 0;)
            if (pattern_[i].setLevel < finest && seen_[i] == kPatternProcessed && childrenDone(i))
                set(i, kPatternInactive);
        return changes_;
    }

 private:
    void set(uint32_t i, int8_t value) {
        if (status_[i] == value) return;
        status_[i] = value;
        ++changes_;
    }
    void raiseFamily(uint32_t i) {
        const uint32_t parent = pattern_[i].parent, child = pattern_[parent].firstChild;
        for (uint32_t k = child; k < child + 4; ++k) {
            const bool may = repaired_ ? seen_[k] == kPatternInitial : seen_[k] > kPatternInactive;
            if (k != i && may) set(k, kPatternActive);
        }
        const bool may =
            !repaired_ || seen_[parent] == kPatternInitial || seen_[parent] == kPatternActive;
        if (may) set(parent, kPatternProcessed);
    }
    [[nodiscard]] bool childrenDone(uint32_t i) const {
        const uint32_t child = pattern_[i].firstChild;
        for (uint32_t k = child; k < child + 4; ++k)
            if (repaired_ ? seen_[k] == kPatternInitial : seen_[k] != kPatternActive) return false;
        return true;
    }

    std::span<const PatternTriangle> pattern_;
    bool repaired_;
    std::span<const int8_t> seen_;
    std::span<int8_t> status_;
    uint32_t changes_ = 0;
};

}  // namespace

std::pmr::vector<PatternTriangle> makePatternTemplate(uint32_t depth,
                                                      std::pmr::memory_resource* memory) {
    std::pmr::vector<PatternTriangle> pattern(memory);
    const uint32_t coarse = kPatternLevels - std::min(depth, kPatternLevels);
    pattern.push_back(
        make({0, 0}, {kPatternLattice, 0}, {0, kPatternLattice}, coarse, kPatternNone));
    for (uint32_t i = 0; i < pattern.size(); ++i) {
        const PatternTriangle t = pattern[i];
        if (t.setLevel >= kPatternLevels) continue;
        uint8_t middle[3][2];
        for (int k = 0; k < 3; ++k)
            for (int c = 0; c < 2; ++c)
                middle[k][c] = uint8_t((t.corner[k][c] + t.corner[(k + 1) % 3][c]) / 2);
        pattern[i].firstChild = uint32_t(pattern.size());
        const uint32_t level = t.setLevel + 1u;
        pattern.push_back(make(t.corner[0], middle[0], middle[2], level, i));
        pattern.push_back(make(middle[0], t.corner[1], middle[1], level, i));
        pattern.push_back(make(middle[2], middle[1], t.corner[2], level, i));
        pattern.push_back(make(middle[0], middle[1], middle[2], level, i));
    }
    return pattern;
}

uint32_t sweepPattern(std::span<const PatternTriangle> pattern, PatternRules rules,
                      std::span<const uint8_t> eligible, bool serial, std::span<int8_t> status,
                      std::pmr::memory_resource* memory) {
    if (serial) return Sweep(pattern, rules, status, status).run(eligible);
    const std::pmr::vector<int8_t> before(status.begin(), status.end(), memory);
    return Sweep(pattern, rules, before, status).run(eligible);
}

bool isPatternDrawn(std::span<const int8_t> status, uint32_t triangle) noexcept {
    return status[triangle] > kPatternInitial || (triangle == 0 && status[0] == kPatternInitial);
}

float patternHeatDistance(const PatternHeat& heat, glm::vec3 point, float theta) {
    const glm::vec3 d = point - heat.origin;
    const float square = std::sin(kPi * theta / heat.step) + std::sin(kPi * theta) +
                         heat.psi * (d.x * d.x + d.y * d.y + d.z * d.z);
    return std::sqrt(std::abs(square));
}

}  // namespace fw::reference
