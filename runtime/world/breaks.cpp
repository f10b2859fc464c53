// Parts of objects that burnt away or hang on nothing, for hosts that break them. The world reads
// the states of such objects back twice a second and searches them in integers. The fire does not
// depend on it.
#include "mesh/hold.h"
#include "save/plane.h"
#include "world/burn_system.h"
#include "world/geometry.h"
#include "world/saved_object.h"

#include <algorithm>
#include <cmath>

namespace fw::world {
namespace {

constexpr uint64_t kBreaksTicks = gpu::kTicksPerSecond / 2;
constexpr float kFeetReach = 2;  // texels above the lowest

// m^2 of the object's for 1e-9 m^2 of its mesh.
double areaScale(const components::BurnableMesh& object) noexcept {
    return 1e-9 * double(object.pose.scale) * double(object.pose.scale);
}

uint64_t areaOf(const mesh::BurnDomain& domain, uint32_t texel) noexcept {
    return uint64_t(std::llround(double(domain.areas[texel]) * 1e9));
}

}  // namespace

// Null where the host does not ask.
core::Owned<Breaks> BurnSystem::makeBreaks(const FwBurnableMeshDef& def, MeshEntry& entry,
                                           std::span<const uint8_t> gone) {
    components::checkValue(def.breakShare, "FwBurnableMeshDef::breakShare", 0, 1);
    components::checkValue(def.breakArea, "FwBurnableMeshDef::breakArea", 0, 1e6f);
    if (def.breakShare == 0 && def.breakArea == 0) return {};
    const mesh::BurnDomain& domain = *entry.domain;
    auto breaks = core::Owned<Breaks>::make(context_.memory, context_.memory);
    core::Owned<mesh::Pieces>& pieces = gone.empty() ? entry.pieces : breaks->pieces;
    if (!pieces) {
        auto made = core::Owned<mesh::Pieces>::make(context_.memory, context_.memory);
        mesh::findPieces(domain, gone, *made);
        pieces = std::move(made);
    }
    mesh::reserveHold(domain, *pieces, holds_);
    breaks->share = def.breakShare;
    breaks->area = def.breakArea;
    if ((def.flags & FW_BURNABLE_SHELL) != 0) {
        breaks->hangs = true;
        breaks->pinCount = def.pinCount;
        std::copy_n(def.pins, def.pinCount, breaks->pins.begin());
    }
    breaks->lost.assign(domain.texelCount(), false);
    return breaks;
}

// Twice a second for each object, not for all in the same frame.
void BurnSystem::planBreaks(uint64_t end) noexcept {
    frame_.breaks.clear();
    for (const Object* object : scene_.touched) {
        const Breaks* breaks = object->breaks.get();
        if (!breaks || breaks->checkCount == breaks->checks.size() ||
            !(isActive(*object) || breaks->waits))
            continue;
        const uint64_t off = uint64_t(object->slot) * gpu::kStepTicks;
        if ((context_.clock.tick + off) / kBreaksTicks == (end + off) / kBreaksTicks) continue;
        FW_ASSERT(frame_.breaks.size() < frame_.breaks.capacity(), "%zu objects",
                  frame_.breaks.size());
        frame_.breaks.push_back(object->slot);
    }
}

void BurnSystem::commitBreaks(uint64_t frameIndex) noexcept {
    for (const uint32_t slot : frame_.breaks) {
        Breaks& breaks = *scene_.objectAt(slot).breaks;
        FW_ASSERT(breaks.checkCount < breaks.checks.size(), "%u checks", breaks.checkCount);
        breaks.checks[breaks.checkCount++] = frameIndex;
    }
}

const mesh::Pieces& BurnSystem::piecesOf(const Object& object) noexcept {
    return object.breaks->pieces ? *object.breaks->pieces
                                 : *scene_.meshes.at(object.data.meshSlot)->pieces;
}

// Marks texels that bear the rest: where the object is pinned, or what it stands on.
void BurnSystem::markBearers(const Object& object) noexcept {
    const mesh::BurnDomain& domain = scene_.domainOf(object);
    const Breaks& breaks = *object.breaks;
    if (!breaks.hangs) {
        // How much higher a metre along each axis of the object is.
        float zero[3] = {}, origin[3], most = 0, rises[3];
        components::toWorld(object.data.pose, zero, origin);
        for (size_t i = 0; i < 3; ++i) {
            float axis[3] = {}, end[3];
            axis[i] = 1;
            components::toWorld(object.data.pose, axis, end);
            rises[i] = 0;
            for (size_t k = 0; k < 3; ++k) rises[i] += context_.def.up[k] * (end[k] - origin[k]);
            most = std::max(most, std::abs(rises[i]));
        }
        int32_t up[3];
        for (size_t i = 0; i < 3; ++i) up[i] = int32_t(std::lround(rises[i] / most * 1024));
        const float reach = kFeetReach * 1024 * domain.texelSide / domain.quantum;
        mesh::markFeet(domain, piecesOf(object), up, int64_t(reach), holds_);
        return;
    }
    for (uint32_t i = 0; i < domain.texelCount(); ++i) {
        if (!domain.real(i)) continue;
        float at[3];
        restPlace(domain, i, at);
        for (uint32_t n = 0; n < breaks.pinCount; ++n) {
            const FwPin& pin = breaks.pins[n];
            float along = 0, length = 0, away = 0;
            for (int k = 0; k < 3; ++k) {
                along += (at[k] - pin.from[k]) * (pin.to[k] - pin.from[k]);
                length += (pin.to[k] - pin.from[k]) * (pin.to[k] - pin.from[k]);
            }
            const float part = length > 0 ? std::clamp(along / length, 0.0f, 1.0f) : 0.0f;
            for (int k = 0; k < 3; ++k) {
                const float off = at[k] - pin.from[k] - part * (pin.to[k] - pin.from[k]);
                away += off * off;
            }
            if (away <= pin.radius * pin.radius) holds_.marks[i] |= mesh::kHoldBears;
        }
    }
}

// `tells`: the frame of the events that it raises; null: it raises none.
void BurnSystem::findBreaks(Object& object, std::span<const uint32_t> ticks,
                            std::span<const gpu::uvec2> heat, uint32_t now,
                            const uint64_t* tells) noexcept {
    const mesh::BurnDomain& domain = scene_.domainOf(object);
    Breaks& breaks = *object.breaks;
    if (ticks.size() != domain.texelCount()) return;
    FW_ASSERT(breaks.lost.size() == ticks.size(), "%zu of %zu texels", breaks.lost.size(),
              ticks.size());
    std::array<uint32_t, gpu::kMaterialsPerObject> holes{};
    for (uint32_t i = 0; i < gpu::kMaterialsPerObject; ++i)
        holes[i] = components::holeTicks(object.data, i, context_.def.paceFactor);
    const bool heated = heat.size() == ticks.size();
    uint64_t all = 0, gone = 0;
    breaks.waits = false;
    holds_.marks.assign(domain.texelCount(), 0);
    const mesh::Pieces& pieces = piecesOf(object);
    for (uint32_t i = 0; i < domain.texelCount(); ++i) {
        if (pieces.of[i] == mesh::kNone) continue;
        const uint64_t area = areaOf(domain, i);
        all += area;
        const uint32_t t = ticks[i], opens = holes[scene_.texelMaterial(object, i)];
        bool open = false;
        if (opens != 0 && gpu::isSource(t)) {
            open = heated ? gpu::gateOpens(gpu::kEventGate, opens, gpu::unpackHeat(heat[i]), t, now)
                          : t <= now && now - t >= opens;
            breaks.waits = breaks.waits || !open;
        }
        if (open) gone += area;
        if (!open && !breaks.lost[i]) holds_.marks[i] = mesh::kHoldStands;
    }
    const double scale = areaScale(object.data);
    const bool much = breaks.share > 0 && double(gone) >= double(breaks.share) * double(all);
    if (much && !breaks.shareReported && tells) {
        float middle[3], place[3];
        middleOf(domain, middle);
        components::toWorld(object.data.pose, middle, place);
        context_.raise(FW_EVENT_STRUCTURE_BROKE, &object, FW_BREAK_SHARE, *tells, place,
                       float(double(gone) * scale));
    }
    breaks.shareReported = much;
    if (!(breaks.area > 0) || gone == 0 || (breaks.hangs && breaks.pinCount == 0)) return;
    markBearers(object);
    mesh::markHeld(domain, holds_);
    for (uint32_t from = 0; mesh::nextLost(domain, from, holds_);) {
        uint64_t area = 0;
        double sum[3] = {};
        for (const uint32_t texel : holds_.lost) {
            breaks.lost[texel] = true;
            area += areaOf(domain, texel);
            float place[3];
            scene_.texelPosition(object, texel, place);
            for (int k = 0; k < 3; ++k) sum[k] += double(place[k]);
        }
        if (!tells || double(area) * scale < double(breaks.area)) continue;
        float middle[3];
        for (int k = 0; k < 3; ++k) middle[k] = float(sum[k] / double(holds_.lost.size()));
        context_.raise(FW_EVENT_STRUCTURE_BROKE, &object, FW_BREAK_PART, *tells, middle,
                       float(double(area) * scale));
    }
}

void BurnSystem::onBurnMap(Object& object, const gpu::ObjectImage& map,
                           const gpu::Readback& readback) noexcept {
    if (!object.breaks) return;
    Breaks& breaks = *object.breaks;
    FW_ASSERT(breaks.checkCount <= breaks.checks.size(), "%u checks", breaks.checkCount);
    const auto end = breaks.checks.begin() + breaks.checkCount;
    const auto later = std::upper_bound(breaks.checks.begin(), end, readback.frameIndex);
    if (later == breaks.checks.begin()) return;
    breaks.checkCount =
        uint32_t(std::copy(later, end, breaks.checks.begin()) - breaks.checks.begin());
    findBreaks(object, map.ticks, map.heat, readback.endTick, &readback.frameIndex);
}

// `saved` is null, or of another def: what is gone by now counts as reported.
void BurnSystem::restoreBreaks(Object& object, const BreakState* saved, const ImageStore& store,
                               uint32_t now) noexcept {
    Breaks& breaks = *object.breaks;
    if (saved && saved->share == breaks.share && saved->area == breaks.area) {
        static_cast<BreakState&>(breaks) = *saved;
        std::copy(store.lost.begin(), store.lost.end(), breaks.lost.begin());
        return;
    }
    findBreaks(object, store.ticks, store.heat, now, nullptr);
}

}  // namespace fw::world
