#include "world/governor.h"

#include "components/pose.h"

#include <algorithm>
#include <cmath>

namespace fw::world {
namespace {

constexpr float kOver = 1.03f;     // of the budget: less is measurement
constexpr float kAim = 0.95f;      // of the budget, when detail falls
constexpr float kSmooth = 0.2f;    // share of a new measurement
constexpr float kJump = 0.3f;      // a cost that is so far from the smooth one is another load ...
constexpr float kMaxSaves = 3.0f;  // of a single level

float shareOf(const FrameCost& limit, const FrameCost& cost) noexcept {
    return std::max({limit.gpu > 0 ? cost.gpu / limit.gpu : 0.0f,
                     limit.cpu > 0 ? cost.cpu / limit.cpu : 0.0f,
                     limit.bytes > 0 ? float(cost.bytes / limit.bytes) : 0.0f});
}

float savesAt(const Governor& g, uint32_t level) noexcept {
    FW_ASSERT(level < kDetailLevels, "level %u", level);
    return g.saves[level] > 0 ? g.saves[level] : g.guess;
}

// A mean at first, then a filter.
template <class T>
void follow(T to, uint32_t seen, T& value) noexcept {
    value += T(std::max(kSmooth, 1.0f / float(seen + 1))) * (to - value);
}

// Saving of each level between two, as measured.
void learn(float share, Governor& g) noexcept {
    const uint32_t high = std::min(g.level, g.levelBefore), low = std::max(g.level, g.levelBefore);
    g.levelBefore = g.level;
    g.learnedAt = share;
    if (high == low || !(share > 0) || !(g.shareBefore > 0)) return;
    const float ratio = g.level == low ? g.shareBefore / share : share / g.shareBefore;
    const float each = std::pow(std::max(ratio, 1.0f), 1.0f / float(low - high));
    g.guess = std::min(each, kMaxSaves);
    for (uint32_t k = high + 1; k <= low; ++k) g.saves[k] = g.guess;
}

void turnTo(uint32_t level, float share, Governor& g) noexcept {
    g.levelBefore = g.level;
    g.shareBefore = share;
    g.level = level;
    g.wait = kDetailWait;
    g.over = g.room = g.seen = 0;
}

}  // namespace

gpu::Detail detailOf(uint32_t level) noexcept {
    // Many samples first, which is grain; then how many flames have their own rays, and lights;
    // triangles, quads and memory all along.
    static constexpr std::array<gpu::Detail, kDetailLevels> kLevels = {{
        {16, 32, 64, 1.0f, 1.0f, 1.0f, 1.0f},
        {12, 32, 48, 0.85f, 0.9f, 1.0f, 0.8f},
        {8, 24, 40, 0.7f, 0.8f, 1.0f, 0.65f},
        {4, 16, 32, 0.55f, 0.7f, 1.0f, 0.5f},
        {2, 8, 28, 0.4f, 0.6f, 0.875f, 0.4f},
        {1, 4, 24, 0.3f, 0.5f, 0.75f, 0.3f},
        {0, 2, 20, 0.2f, 0.42f, 0.625f, 0.2f},
        {0, 1, 16, 0.125f, 0.35f, 0.5f, 0.125f},
    }};
    return kLevels[std::min(level, kDetailLevels - 1)];
}

void govern(const FrameCost& limit, const FrameCost& spent, Governor& g) noexcept {
    if (g.wait > 0) {
        --g.wait;
        return;
    }
    const float now = shareOf(limit, spent);
    follow(spent.gpu, g.seen, g.cost.gpu);
    follow(spent.cpu, g.seen, g.cost.cpu);
    follow(spent.bytes, g.seen, g.cost.bytes);
    const float share = shareOf(limit, g.cost);
    g.overSum = now > kOver ? (g.over > 0 ? g.overSum : 0) + now : 0;
    g.over = now > kOver ? g.over + 1 : 0;
    if (g.seen < kDetailOverFrames) {
        if (++g.seen < kDetailOverFrames) return;
        learn(share, g);
    }
    // Another load: what was learned of the one before says nothing of it.
    if (std::abs(share - g.learnedAt) > kJump * g.learnedAt) {
        g.saves = {};
        g.guess = kDetailGuess;
        g.learnedAt = share;
    }

    if (g.over >= kDetailOverFrames && g.level + 1 < kDetailLevels) {
        uint32_t level = g.level;
        const float over = g.overSum / float(g.over);
        float predicted = over;
        while (predicted > kAim && level + 1 < kDetailLevels) predicted /= savesAt(g, ++level);
        turnTo(level, over, g);
        return;
    }
    uint32_t level = g.level;
    float predicted = share;
    while (level > 0 && predicted * savesAt(g, level) <= kDetailRoom)
        predicted *= savesAt(g, level--);
    g.room = level < g.level ? g.room + 1 : 0;
    if (g.room >= kDetailRoomFrames) turnTo(level, share, g);
}

void BudgetSystem::set(const FwBudgetDef& def) {
    components::checkValue(def.gpuMilliseconds, "FwBudgetDef::gpuMilliseconds", 0.0f, 1000.0f);
    components::checkValue(def.cpuMilliseconds, "FwBudgetDef::cpuMilliseconds", 0.0f, 1000.0f);
    components::checkValue(def.measuredMilliseconds, "FwBudgetDef::measuredMilliseconds", -1e5f,
                           1e5f);
    budget_ = {def.gpuMilliseconds, def.cpuMilliseconds, double(def.bytes)};
    measured_ = def.measuredMilliseconds >= 0;
    if (measured_) spent_.gpu = def.measuredMilliseconds;
}

void BudgetSystem::fillState(FwBudgetState& state) const noexcept {
    const gpu::Detail detail = detailOf(governor_.level);
    state.level = governor_.level;
    state.levels = kDetailLevels;
    state.marchedFires = detail.marched;
    state.rayStepCount = std::min(detail.rayStepCount, context_.def.rayStepCount);
    state.refinedTriangles = uint32_t(detail.triangles * float(context_.def.maxRefinedTriangles));
    state.gpuMilliseconds = governor_.cost.gpu;
    state.cpuMilliseconds = governor_.cost.cpu;
    state.quads = detail.quads;
    state.lights = gpu::lightsOf(detail, context_.def.maxLights);
    state.bytes = context_.backend.detailBytes();
}

void BudgetSystem::plan(gpu::FramePlan& plan) noexcept {
    spent_.bytes = double(context_.backend.detailBytes());
    govern(budget_, spent_, governor_);
    spent_.cpu = 0;
    plan.detail = detailOf(governor_.level);
    if (!(budget_.bytes > 0)) plan.detail.memory = 1;
}

}  // namespace fw::world
