// See burn_memory.h.
#include "document/burn_memory.h"

#include <algorithm>
#include <cmath>

#include "flamewright/flamewright_debug.h"

namespace fwedit {
namespace {

constexpr double kReadInterval = 1;  // s of burn time between two reads of the ignition map
constexpr double kLeastApart = 5, kSnapshotCount = 8;  // s; number of snapshots per scene

// Returns, per material of a mesh, the ticks that a texel glows before it looks charred. Thick fuel
// burns on for long below a crust that soon turns black.
std::array<float, 8> glowingOf(const Burn& burn, const Mesh& mesh) {
    std::array<float, 8> ticks{};
    for (size_t slot = 0; slot < ticks.size(); ++slot) {
        FwMaterialDef def = fwDefaultMaterialDef();
        fwInitMaterialPreset(&def, mesh.materials[slot]);
        const float thickness = mesh.thickness > 0 ? mesh.thickness : def.thickness;
        float seconds = def.burnTime;
        if (!(seconds > 0) && def.burningFlux > 0)
            seconds = thickness * def.density / def.burningFlux;
        constexpr float kCharring = 24;  // s at pace factor 1
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
    // Saves are expensive, so there are few of them. The first costs nothing.
    const double apart =
        std::max(kLeastApart, double(burn.scene.settings.duration) / kSnapshotCount);
    const bool due = snapshots_.empty() || burn.time >= snapshots_.back().time + apart;
    if (!isSaving_ && due && fwWorld_RequestSave(burn.world) >= 0) {
        isSaving_ = true;
        savingTime_ = burn.time;
    }
    isBehind_ = burn.time > known_ + 1e-4 && burn.time + 1e-4 >= longest_;
    if (isReading_ || !isBehind_ || (step > 0 && burn.time < known_ + kReadInterval)) return;
    isReading_ = true;
    readingTime_ = burn.time;
    for (const BurnMesh& mesh : burn.meshes)
        isReading_ = isReading_ && fwDebug_RequestBurnMap(burn.world, mesh.object) >= 0;
    if (!isReading_) known_ = burn.time;
}

void BurnMemory::afterFrame(Burn& burn) {
    if (isReading_ && receiveTicks(burn)) {
        isReading_ = false;
        known_ = readingTime_;
    }
    isBehind_ = burn.time > known_ + 1e-4 && burn.time + 1e-4 >= longest_;
    if (isSaving_) receiveSave(burn);
}

bool BurnMemory::receiveTicks(Burn& burn) {
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

void BurnMemory::receiveSave(Burn& burn) {
    uint64_t size = 0;
    const FwResult result = fwWorld_FetchSave(burn.world, nullptr, &size);
    if (result == FW_NOT_READY) return;
    isSaving_ = false;
    Snapshot snapshot;
    snapshot.time = savingTime_;
    snapshot.bytes.resize(size);
    if (result >= 0 && fwWorld_FetchSave(burn.world, snapshot.bytes.data(), &size) == FW_OK)
        snapshots_.push_back(std::move(snapshot));
}

bool BurnMemory::restore(Burn& burn, double time) {
    const Snapshot* latest = nullptr;
    for (const Snapshot& snapshot : snapshots_)
        if (snapshot.time <= time + 1e-6) latest = &snapshot;
    if (!latest || fwWorld_Load(burn.world, latest->bytes.data(), latest->bytes.size()) < 0)
        return false;
    burn.time = latest->time;
    isSaving_ = false;
    for (BurnPart& part : burn.parts) part.lastFactor = -1;
    return true;
}

bool BurnMemory::agesAt(const Burn& burn, ObjectId id, const PaintSurface& surface, double time,
                        std::vector<uint8_t>& values) const {
    const auto found = ticks_.find(id);
    const Mesh* mesh = findIn(burn.scene.meshes, id);
    if (found == ticks_.end() || !mesh || found->second.size() != surface.real.size()) return false;
    std::array<float, 8> share{};  // share of its glow per tick, in byte steps
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
