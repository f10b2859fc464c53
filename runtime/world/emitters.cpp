// Fire emitters: ids, where their particles are among the world's, and their frames. Looks alone;
// nothing here is done for each particle.
#include "world/world.h"

#include "components/sparks.h"
#include "shared/spark.h"

#include <algorithm>
#include <cmath>

namespace fw::world {

using components::FireEmitter;

components::EmitterAir World::emitterAir(const FireEmitter& emitter, float ahead) const noexcept {
    components::EmitterAir air;
    // That of a mesh is where its mesh is.
    const core::Owned<Object>* object =
        emitter.def.shape == FW_EMITTER_MESH ? objects_.find(emitter.def.object) : nullptr;
    float place[3];
    std::copy_n(emitter.position, 3, place);
    for (int i = 0; object && i < 3; ++i) place[i] = float((*object)->data.pose.translation[i]);
    const std::array<float, 3> wind = windAt(place, clock_.tick);
    std::copy_n(wind.data(), 3, air.wind);
    std::copy_n(def_.up, 3, air.up);
    air.now = emitterTime_ + double(ahead);
    return air;
}

// First room of so many particles between those of the others.
uint32_t World::emitterRoom(uint32_t particles) {
    emitterRings_.clear();
    emitterRings_.reserve(emitters_.live() + 1);
    for (uint32_t i = 0; i < emitters_.slotCount(); ++i)
        if (const FireEmitter* one = emitters_.at(i))
            emitterRings_.push_back({one->first, one->ring});
    std::sort(emitterRings_.begin(), emitterRings_.end());
    uint32_t first = 0;
    for (const auto& ring : emitterRings_) {
        if (ring.first - first >= particles) break;
        first = ring.first + ring.second;
    }
    if (first > def_.maxParticles || particles > def_.maxParticles - first)
        core::fail(
            FW_ERROR_INVALID_ARGUMENT,
            "The emitter needs %u particles in a row; FwWorldDef::maxParticles is %u, and %u "
            "of them are not free.",
            particles, def_.maxParticles, std::min(first, def_.maxParticles));
    return first;
}

FwFireEmitterId World::createFireEmitter(const FwFireEmitterDef& def) {
    if (emitters_.live() >= gpu::kMaxEmitters)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "%u fire emitters are there; the limit is %u.",
                   emitters_.live(), gpu::kMaxEmitters);
    FireEmitter emitter;
    components::makeFireEmitter(def, def_.seed * 0x9E3779B9u + 77u * (emittersMade_ + 1), emitter);
    emitter.books = emitterBooks(def);
    if (def.shape == FW_EMITTER_MESH) (void)objects_.get(def.object);
    emitter.ring = std::max(components::emitterNeeds(emitter), 1u);
    emitter.first = emitterRoom(emitter.ring);
    const size_t groups = emitterGroups_.capacity();
    size_t needed = (emitter.ring + gpu::kParticleGroup - 1) / gpu::kParticleGroup;
    for (const auto& ring : emitterRings_)
        needed += (ring.second + gpu::kParticleGroup - 1) / gpu::kParticleGroup;
    if (groups < needed) emitterGroups_.reserve(std::max(needed, 2 * groups));
    const size_t records = emitterRecords_.capacity(), live = emitters_.live() + 1;
    if (records < live) {
        emitterRecords_.reserve(std::max(live, 2 * records));
        sparkSources_.reserve(std::max(live, 2 * records));
    }
    findFireRoom(0);  // of shapes that jets are swept through
    if (components::isSwept(def)) {
        const size_t rays = (emitters_.live() + 1) * components::kJetRays;
        for (ProbeFrame& frame : probeFrames_) frame.refs.reserve(rays);
        frame_.probes.reserve(rays);
    }
    if (def.flags & FW_EMITTER_IGNITES)
        emitter.stream = core::Owned<components::JetStream>::make(memory_);
    const FwFireEmitterId id = emitters_.create(std::move(emitter));
    ++emittersMade_;
    countBookUsers(def, 1);
    return id;
}

void World::destroyFireEmitter(FwFireEmitterId id) {
    const FwFireEmitterDef def = emitters_.get(id).def;
    for (ProbeFrame& frame : probeFrames_)  // what they answer would be another jet's in the slot
        for (ProbeRef& ref : frame.refs)
            if (ref.jet == id.index1) ref.object = {};
    emitters_.destroy(id);
    countBookUsers(def, -1);
}

void World::moveFireEmitter(FwFireEmitterId id, const float position[3], const float* direction) {
    FireEmitter& emitter = emitters_.get(id);
    const bool burns = bool(emitter.stream);
    if (burns) mayChange();
    components::moveFireEmitter(emitter, position, direction);
    if (!burns) return;
    MoveEmitter command{id.index1 - 1, direction != nullptr};
    std::copy_n(position, 3, command.position);
    if (direction) std::copy_n(direction, 3, command.direction);
    record(command);
}

void World::setFireEmitterPower(FwFireEmitterId id, float power) {
    FireEmitter& emitter = emitters_.get(id);
    const bool burns = bool(emitter.stream);
    if (burns) mayChange();
    components::setEmitterPower(emitter, power);
    if (burns) record(SetEmitterPower{id.index1 - 1, power});
}

void World::setFireEmitterHidden(FwFireEmitterId id, bool hidden) {
    uint32_t& flags = emitters_.get(id).def.flags;
    flags = (flags & ~uint32_t(FW_EMITTER_HIDDEN)) | (hidden ? uint32_t(FW_EMITTER_HIDDEN) : 0u);
}

void World::fireEmitterState(FwFireEmitterId id, FwFireEmitterState& state) {
    FireEmitter& emitter = emitters_.get(id);
    components::fillEmitterState(emitter, emitterAir(emitter, 0), state);
}

// ---- frames -----------------------------------------------------------------------------------

// Of a mesh emitter's power that its mesh has, as of the last readback.
float World::burningShare(const FireEmitter& emitter) noexcept {
    const core::Owned<Object>* object = objects_.find(emitter.def.object);
    if (!object || !(emitter.def.power > 0)) return 0;
    return std::clamp(powerOf(**object) / (1000 * emitter.def.power), 0.0f, 1.0f);
}

// Of the host's height fields what lies about a source of sparks. In cells of the world: where it
// stands in them changes nothing.
void World::layGround(gpu::SparkSource& source) const noexcept {
    constexpr float kSide = gpu::kSparkCellSide;
    constexpr uint32_t kCells = gpu::kSparkCells, kCorners = kCells + 1;
    float low[2];
    for (int i = 0; i < 2; ++i)
        low[i] = std::floor(source.keys[0][2 * i] / kSide + 0.5f) * kSide - 0.5f * kCells * kSide;
    float heights[kCorners * kCorners] = {};
    bool any = false;
    for (uint32_t slot = 0; slot < fireColliders_.slotCount(); ++slot) {
        const auto* entry = fireColliders_.at(slot);
        if (!entry || (*entry)->shape.kind != volume::ColliderKind::HeightField) continue;
        const volume::Collider& field = (*entry)->shape;
        float height = 0;
        if (!volume::heightOf(field, source.keys[0].x, source.keys[0].z, height)) continue;
        for (uint32_t i = 0; i < kCorners * kCorners; ++i) {
            (void)volume::heightOf(field, low[0] + float(i % kCorners) * kSide,
                                   low[1] + float(i / kCorners) * kSide, height);
            heights[i] = any ? std::max(heights[i], height) : height;
        }
        any = true;
    }
    source.grid = {low[0], low[1], kSide, any ? 1.0f : 0.0f};
    for (uint32_t i = 0; any && i < kCells * kCells; ++i) {
        const float* corner = &heights[i / kCells * kCorners + i % kCells];
        source.cells[i] = {corner[0], corner[1], corner[kCorners], corner[kCorners + 1]};
    }
}

void World::planEmitters(float seconds) noexcept {
    emitterRecords_.clear();
    emitterGroups_.clear();
    sparkSources_.clear();
    uint32_t end = 0, particles = 0, lights = 0, sparks = 0;
    bool listed = false;
    for (uint32_t i = 0; i < emitters_.slotCount(); ++i) {
        FireEmitter* emitter = emitters_.at(i);
        gpu::ParticleEmitter record;
        if (emitter && emitter->def.shape == FW_EMITTER_MESH)
            emitter->share = burningShare(*emitter);
        if (emitter && components::isSwept(emitter->def)) {
            if (!listed) listFireColliders();
            listed = true;
            shieldJet(*emitter, emitterTime_ + double(seconds));
        }
        if (!emitter) continue;
        const components::EmitterAir air = emitterAir(*emitter, seconds);
        const bool shows = components::advanceEmitter(*emitter, air, seconds, record);
        const auto eddies = [&](int k) { return float(std::fmod(origin_[k], gpu::kEddyField)); };
        record.heat.w = eddies(0), record.stuck.z = eddies(1), record.stuck.w = eddies(2);
        gpu::SparkSource source;
        // Another object may have the slot of a mesh that is gone.
        const bool gone =
            emitter->def.shape == FW_EMITTER_MESH && !objects_.find(emitter->def.object);
        if (!gone && components::advanceSparks(*emitter, air, seconds, source)) {
            if (!(emitter->def.flags & FW_EMITTER_NO_COLLISION)) layGround(source);
            sparkSources_.push_back(source);
            sparks += components::sparkQuads(source);
        }
        if (!shows) continue;
        for (uint32_t first = 0; first < record.ring; first += gpu::kParticleGroup)
            emitterGroups_.push_back({uint32_t(emitterRecords_.size()), first});
        emitterRecords_.push_back(record);
        end = std::max(end, record.first + record.ring);
        const bool emits = (record.flags & gpu::kEmitterEmits) != 0;
        if (emits) lights += record.ring;
        if (!emits || record.life.w > 0) particles += record.ring;
    }
    gpu::EmitterUpdate& update = frame_.emitters;
    update.records = emitterRecords_.data();
    update.count = uint32_t(emitterRecords_.size());
    update.groups = emitterGroups_;
    update.particleEnd = end;
    update.particles = particles;
    update.lightParticles = lights;
    update.sparks = sparkSources_.data();
    update.sparkCount = uint32_t(sparkSources_.size());
    update.sparkQuads = sparks;
    frame_.emittersDue = showEmitters() || emittersShown_;
}

void World::commitEmitters(float seconds) noexcept {
    emittersShown_ = showEmitters();
    emitterTime_ += double(seconds);
    for (uint32_t i = 0; i < emitters_.slotCount(); ++i)
        if (FireEmitter* emitter = emitters_.at(i)) components::commitEmitter(*emitter);
}

}  // namespace fw::world
