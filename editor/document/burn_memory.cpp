// See burn_memory.h.
#include "document/burn_memory.h"

#include <algorithm>
#include <cmath>

#include "flamewright/flamewright_debug.h"

namespace fwedit {
namespace {

constexpr double kAskEvery = 1;                  // s of the fire between looks at its map
constexpr double kLeastApart = 5, kMoments = 8;  // s; moments that are kept over a scene

// How long a texel of each of a mesh's materials glows until it looks charred, in ticks. Thick fuel
// flames for long, under a crust that is black soon.
std::array<float, 8> glowingOf(const Burn& burn, const Mesh& mesh) {
    std::array<float, 8> ticks{};
    for (size_t slot = 0; slot < ticks.size(); ++slot) {
        FwMaterialDef def = fwDefaultMaterialDef();
        fwInitMaterialPreset(&def, mesh.materials[slot]);
        const float thickness = mesh.thickness > 0 ? mesh.thickness : def.thickness;
        float seconds = def.burnTime;
        if (!(seconds > 0) && def.burningFlux > 0)
            seconds = thickness * def.density / def.burningFlux;
        constexpr float kCharring = 24;  // s at pace 1
        seconds = std::min(seconds, kCharring);
        seconds = std::max(seconds / std::max(burn.scene.settings.pace, 0.1f), 0.2f);
        ticks[slot] = seconds * float(kTicksPerSecond);
    }
    return ticks;
}

}  // namespace

void BurnMemory::begin(const Burn& burn) {
    forget();
    FwWorldStats stats{};
    stats.structSize = sizeof stats;
    fwWorld_GetStats(burn.world, &stats);
    start_ = stats.tick;
}

void BurnMemory::forget() { *this = {}; }

void BurnMemory::beforeFrame(Burn& burn, float step) {
    longest_ = std::max(longest_, burn.time);
    // Saves have their cost: few of them, and the first for nothing.
    const double apart = std::max(kLeastApart, double(burn.scene.settings.duration) / kMoments);
    const bool due = moments_.empty() || burn.time >= moments_.back().time + apart;
    if (!saving_ && due && fwWorld_RequestSave(burn.world) >= 0) {
        saving_ = true;
        savingTime_ = burn.time;
    }
    behind_ = burn.time > known_ + 1e-4 && burn.time + 1e-4 >= longest_;
    if (asked_ || !behind_ || (step > 0 && burn.time < known_ + kAskEvery)) return;
    asked_ = true;
    askedTime_ = burn.time;
    for (const BurnMesh& mesh : burn.meshes)
        asked_ = asked_ && fwDebug_RequestBurnMap(burn.world, mesh.object) >= 0;
    if (!asked_) known_ = burn.time;
}

void BurnMemory::afterFrame(Burn& burn) {
    if (asked_ && takeTicks(burn)) {
        asked_ = false;
        known_ = askedTime_;
    }
    behind_ = burn.time > known_ + 1e-4 && burn.time + 1e-4 >= longest_;
    if (saving_) takeSave(burn);
}

bool BurnMemory::takeTicks(Burn& burn) {
    for (const BurnMesh& mesh : burn.meshes) {
        uint64_t count = 0, hash = 0, tick = 0;
        std::vector<uint32_t>& ticks = ticks_[mesh.id];
        if (ticks.empty()) {
            FwMeshInfo info{};
            info.structSize = sizeof info;
            if (fwWorld_GetMeshInfo(burn.world, mesh.mesh, &info) < 0) continue;
            ticks.assign(size_t{info.mapWidth} * info.mapHeight, ~0u);
        }
        if (fwDebug_FetchBurnMap(burn.world, mesh.object, ticks.data(), ticks.size(), &count, &hash,
                                 &tick) == FW_NOT_READY)
            return false;
    }
    return true;
}

void BurnMemory::takeSave(Burn& burn) {
    uint64_t size = 0;
    const FwResult result = fwWorld_FetchSave(burn.world, nullptr, &size);
    if (result == FW_NOT_READY) return;
    saving_ = false;
    Moment moment;
    moment.time = savingTime_;
    moment.bytes.resize(size);
    if (result >= 0 && fwWorld_FetchSave(burn.world, moment.bytes.data(), &size) == FW_OK)
        moments_.push_back(std::move(moment));
}

bool BurnMemory::restore(Burn& burn, double time) {
    const Moment* latest = nullptr;
    for (const Moment& moment : moments_)
        if (moment.time <= time + 1e-6) latest = &moment;
    if (!latest || fwWorld_Load(burn.world, latest->bytes.data(), latest->bytes.size()) < 0)
        return false;
    burn.time = latest->time;
    saving_ = false;
    for (BurnPart& part : burn.parts) part.lastFactor = -1;
    return true;
}

bool BurnMemory::agesAt(const Burn& burn, ObjectId id, const PaintSurface& surface, double time,
                        std::vector<uint8_t>& values) const {
    const auto found = ticks_.find(id);
    const Mesh* mesh = findIn(burn.scene.meshes, id);
    if (found == ticks_.end() || !mesh || found->second.size() != surface.real.size()) return false;
    std::array<float, 8> share{};  // of its glow that a tick is, in steps of a byte
    const std::array<float, 8> glowing = glowingOf(burn, *mesh);
    for (size_t slot = 0; slot < share.size(); ++slot) share[slot] = 253 / glowing[slot];
    const auto now = int64_t(start_) + int64_t(std::llround(time * kTicksPerSecond));
    values.resize(found->second.size());
    for (size_t i = 0; i < values.size(); ++i) {
        const uint32_t tick = found->second[i];
        const int64_t age = now - int64_t{tick};
        values[i] =
            tick >= kFirstCode || age < 0
                ? uint8_t{0}
                : uint8_t(1 + std::min(254.0f, float(age) * share[surface.material[i] & 7]));
    }
    return true;
}

double BurnMemory::caughtAt(ObjectId mesh, size_t texel) const {
    const auto found = ticks_.find(mesh);
    if (found == ticks_.end() || texel >= found->second.size()) return -1;
    const uint32_t tick = found->second[texel];
    return tick >= kFirstCode ? -1 : double(int64_t{tick} - int64_t(start_)) / kTicksPerSecond;
}

bool BurnMemory::timesOf(const Burn& burn, ObjectId id, std::vector<uint8_t>& values) const {
    const auto found = ticks_.find(id);
    if (found == ticks_.end()) return false;
    const double step =
        254 / (kTicksPerSecond * std::max(0.1, double(burn.scene.settings.duration)));
    values.resize(found->second.size());
    for (size_t i = 0; i < values.size(); ++i) {
        const uint32_t tick = found->second[i];
        const double at = double(int64_t{tick} - int64_t(start_)) * step;
        values[i] = tick >= kFirstCode ? uint8_t{255} : uint8_t(std::clamp(at, 0.0, 254.0));
    }
    return true;
}

}  // namespace fwedit
