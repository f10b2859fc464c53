// Fire emitters: their ranges among the world's particles, and their frames. Nothing here loops
// over particles.
#include "world/emitter_system.h"

#include "components/sparks.h"
#include "core/growth.h"
#include "shared/spark.h"
#include "world/burn_system.h"
#include "world/flame_system.h"
#include "world/recording.h"
#include "world/shift.h"
#include "world/wind_system.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fw::world {

using components::FireEmitter;

namespace {

constexpr uint32_t kSavedFlags = FW_EMITTER_JET | FW_EMITTER_IGNITES;

template <class Stream, class Visit>
void eachRay(Stream& stream, const Visit& visit) {
    for (auto& parcel : stream.parcels)
        for (auto& ray : parcel.rays) visit(ray);
}

void moveJet(components::JetStream& stream, const double (&by)[3]) noexcept {
    for (components::JetPatches* patches : {&stream.patches, &stream.before})
        for (components::JetPatch& patch : *patches) movePast(patch.place, by);
    for (components::JetParcel& parcel : stream.parcels) movePast(parcel.from, by);
    eachRay(stream, [&](components::JetRay& ray) { movePast(ray.hit.place, by); });
}
void moveEmitter(components::FireEmitter& emitter, const double (&by)[3], double along) noexcept {
    emitter.def.ground += float(along);
    for (components::JetHit& hit : emitter.hits) moveBy(hit.place, by);
    for (auto* discs : {&emitter.obstacles, &emitter.lastObstacles})
        for (components::JetObstacle& disc : *discs) moveBy(disc.place, by);
    for (auto* births : {&emitter.births, &emitter.next}) {
        moveBy(births->position, by);
        for (auto& note : births->sparks.notes)
            for (size_t i = 0; i < 3; ++i) note[i] = float(double(note[i]) + by[i]);
    }
    if (emitter.stream) moveJet(*emitter.stream, by);
}

}  // namespace

EmitterSystem::EmitterSystem(const WorldContext& context, Scene& scene, const WindSystem& wind,
                             const ExchangeSystem& exchange, FlameSystem& flames, BurnSystem& burn)
    : context_(context),
      scene_(scene),
      wind_(wind),
      exchange_(exchange),
      flames_(flames),
      burn_(burn) {}

components::EmitterAir EmitterSystem::airOf(const FireEmitter& emitter,
                                            float ahead) const noexcept {
    components::EmitterAir air;
    // That of a mesh is where its mesh is.
    const core::Owned<Object>* object =
        emitter.def.shape == FW_EMITTER_MESH ? scene_.objects.find(emitter.def.object) : nullptr;
    float place[3];
    std::copy_n(emitter.position, 3, place);
    for (int i = 0; object && i < 3; ++i) place[i] = float((*object)->data.pose.translation[i]);
    const std::array<float, 3> wind = wind_.at(place, context_.clock.tick);
    std::copy_n(wind.data(), 3, air.wind);
    std::copy_n(context_.def.up, 3, air.up);
    air.now = time_ + double(ahead);
    return air;
}

// First room of so many particles between those of the others.
uint32_t EmitterSystem::findRing(uint32_t particles) {
    rings_.clear();
    rings_.reserve(emitters_.live() + 1);
    for (auto [i, one] : emitters_.entries()) rings_.push_back({one.first, one.ring});
    std::sort(rings_.begin(), rings_.end());
    uint32_t first = 0;
    for (const auto& ring : rings_) {
        if (ring.first - first >= particles) break;
        first = ring.first + ring.second;
    }
    if (first > context_.def.maxParticles || particles > context_.def.maxParticles - first)
        core::refuse(
            "The emitter needs %u particles in a row; FwWorldDef::maxParticles is %u, and %u "
            "of them are not free.",
            particles, context_.def.maxParticles, std::min(first, context_.def.maxParticles));
    return first;
}

FwFireEmitterId EmitterSystem::create(const FwFireEmitterDef& def) {
    checkRoom(emitters_, gpu::kMaxEmitters, "fire emitters");
    FireEmitter emitter;
    components::makeFireEmitter(def, context_.def.seed * 0x9E3779B9u + 77u * (made_ + 1), emitter);
    emitter.flipbooks = flames_.flipbooksOf(def);
    if (def.shape == FW_EMITTER_MESH) (void)scene_.objects.get(def.object);
    emitter.ring = std::max(components::particlesNeeded(emitter), 1u);
    emitter.first = findRing(emitter.ring);
    size_t needed = (emitter.ring + gpu::kParticleGroup - 1) / gpu::kParticleGroup;
    for (const auto& ring : rings_)
        needed += (ring.second + gpu::kParticleGroup - 1) / gpu::kParticleGroup;
    const size_t live = emitters_.live() + 1;
    // Each by its own capacity: an earlier call may have ended between two of them.
    core::growTo(groups_, needed);
    core::growTo(records_, live);
    core::growTo(sparks_, live);
    flames_.reserve(0);  // of shapes that jets are swept through
    if (components::isSwept(def)) core::growTo(probes_, live * components::kJetRays);
    if (def.flags & FW_EMITTER_IGNITES)
        emitter.stream = core::Owned<components::JetStream>::make(context_.memory);
    const FwFireEmitterId id = emitters_.create(std::move(emitter));
    ++made_;
    flames_.countFlipbookUsers(def, 1);
    return id;
}

void EmitterSystem::destroy(FwFireEmitterId id) {
    const FwFireEmitterDef def = emitters_.get(id).def;
    emitters_.destroy(id);
    flames_.countFlipbookUsers(def, -1);
}

void EmitterSystem::move(FwFireEmitterId id, const float position[3], const float* direction) {
    FireEmitter& emitter = emitters_.get(id);
    const bool burns = bool(emitter.stream);
    if (burns) context_.recorder.mayChange();
    components::moveFireEmitter(emitter, position, direction);
    if (burns) context_.recorder.record(MoveEmitter(id.index1 - 1, position, direction));
}

void EmitterSystem::setPower(FwFireEmitterId id, float power) {
    FireEmitter& emitter = emitters_.get(id);
    const bool burns = bool(emitter.stream);
    if (burns) context_.recorder.mayChange();
    components::setEmitterPower(emitter, power);
    if (burns) context_.recorder.record(SetEmitterPower{{id.index1 - 1, power}});
}

void EmitterSystem::fillState(FwFireEmitterId id, FwFireEmitterState& state) {
    FireEmitter& emitter = emitters_.get(id);
    components::fillEmitterState(emitter, airOf(emitter, 0), state);
}

// ---- frames -----------------------------------------------------------------------------------

// Of a mesh emitter's power that its mesh has, as of the last readback.
float EmitterSystem::burningShare(const FireEmitter& emitter) noexcept {
    const core::Owned<Object>* object = scene_.objects.find(emitter.def.object);
    if (!object || !(emitter.def.power > 0)) return 0;
    return std::clamp(scene_.powerOf(**object) / (1000 * emitter.def.power), 0.0f, 1.0f);
}

// Of the host's height fields what lies about a source of sparks. In cells of the world: where it
// stands in them changes nothing.
void EmitterSystem::sampleGround(gpu::SparkSource& source) const noexcept {
    constexpr float kSide = gpu::kSparkCellSide;
    constexpr uint32_t kCells = gpu::kSparkCells, kCorners = kCells + 1;
    float low[2];
    for (int i = 0; i < 2; ++i)
        low[i] = std::floor(source.keys[0][2 * i] / kSide + 0.5f) * kSide - 0.5f * kCells * kSide;
    float heights[kCorners * kCorners] = {};
    bool any = false;
    flames_.eachHeightField([&](const volume::Collider& field) {
        float height = 0;
        if (!volume::heightOf(field, source.keys[0].x, source.keys[0].z, height)) return;
        for (uint32_t i = 0; i < kCorners * kCorners; ++i) {
            (void)volume::heightOf(field, low[0] + float(i % kCorners) * kSide,
                                   low[1] + float(i / kCorners) * kSide, height);
            heights[i] = any ? std::max(heights[i], height) : height;
        }
        any = true;
    });
    source.grid = {low[0], low[1], kSide, any ? 1.0f : 0.0f};
    for (uint32_t i = 0; any && i < kCells * kCells; ++i) {
        const float* corner = &heights[i / kCells * kCorners + i % kCells];
        source.cells[i] = {corner[0], corner[1], corner[kCorners], corner[kCorners + 1]};
    }
}

void EmitterSystem::plan(const HostFrame& frame, gpu::FramePlan& plan) noexcept {
    const float seconds = frame.seconds;
    records_.clear();
    groups_.clear();
    sparks_.clear();
    uint32_t end = 0, particles = 0, lights = 0, sparks = 0;
    bool listed = false;
    for (auto [i, emitter] : emitters_.entries()) {
        // Another object may have the slot of a mesh that is gone.
        const bool onMesh = emitter.def.shape == FW_EMITTER_MESH;
        const bool gone = onMesh && !scene_.objects.find(emitter.def.object);
        if (onMesh) emitter.share = burningShare(emitter);
        if (components::isSwept(emitter.def)) {
            if (!std::exchange(listed, true)) flames_.listShapes();
            updateJetObstacles(emitter, time_ + double(seconds));
        }
        const components::EmitterAir air = airOf(emitter, seconds);
        gpu::ParticleEmitter record;
        const bool shows = components::advanceEmitter(emitter, air, seconds, record);
        const auto eddies = [&](int k) {
            return float(std::fmod(context_.origin.moved[k], gpu::kEddyField));
        };
        record.heat.w = eddies(0), record.stuck.z = eddies(1), record.stuck.w = eddies(2);
        gpu::SparkSource source;
        if (!gone && components::advanceSparks(emitter, air, seconds, source)) {
            if (!(emitter.def.flags & FW_EMITTER_NO_COLLISION)) sampleGround(source);
            FW_ASSERT(sparks_.size() < sparks_.capacity(), "%zu sources", sparks_.size());
            sparks_.push_back(source);
            sparks += components::sparkQuads(source);
        }
        if (!shows) continue;
        for (uint32_t first = 0; first < record.ring; first += gpu::kParticleGroup)
            groups_.push_back({uint32_t(records_.size()), first});
        FW_ASSERT(records_.size() < records_.capacity() && groups_.size() <= groups_.capacity(),
                  "%zu emitters", records_.size());
        records_.push_back(record);
        end = std::max(end, record.first + record.ring);
        const bool emits = (record.flags & gpu::kEmitterEmits) != 0;
        if (emits) lights += record.ring;
        if (!emits || record.life.w > 0) particles += record.ring;
    }
    update_.records = records_.data();
    update_.count = uint32_t(records_.size());
    update_.groups = groups_;
    update_.particleEnd = end;
    update_.particles = particles;
    update_.lightParticles = lights;
    update_.sparks = sparks_.data();
    update_.sparkCount = uint32_t(sparks_.size());
    update_.sparkQuads = sparks;
    if (shows() || shown_) plan.emitters = &update_;
}

void EmitterSystem::commit(const HostFrame& frame) noexcept {
    shown_ = shows();
    time_ += double(frame.seconds);
    for (auto [i, emitter] : emitters_.entries()) components::commitEmitter(emitter);
}

void EmitterSystem::onProbes(std::span<const JetProbe> answers) noexcept {
    for (const JetProbe& probe : answers) {
        FW_ASSERT(probe.ray < components::kJetRays, "ray %u", probe.ray);
        if (FireEmitter* emitter = emitters_.find(probe.emitter))
            emitter->holes[probe.ray] = {probe.gone ? probe.object : FwBurnableMeshId{},
                                         probe.texel};
    }
}

void EmitterSystem::reserveSlots() { core::growTo(jetSlots_, scene_.objects.slotCount()); }

// ---- saves ------------------------------------------------------------------------------------

void EmitterSystem::capture(SlottedList<EmitterSnapshot>& to) const {
    captureSlots(emitters_, to, [&](const FireEmitter& emitter, EmitterSnapshot& made) {
        made.flags = emitter.def.flags & kSavedFlags;
        std::copy_n(emitter.position, 3, made.position);
        std::copy_n(emitter.direction, 3, made.direction);
        made.power = emitter.def.power;
        made.touches = emitter.touches;
        if (!emitter.stream) return;
        made.stream = core::Owned<components::JetStream>::make(context_.memory, *emitter.stream);
        eachRay(*made.stream, [&](components::JetRay& ray) {
            ray.version = ray.version == scene_.geometryVersion ? 1 : 0;
            if (ray.version == 0) ray.hit = {};  // it may be of what is gone
        });
    });
}

void EmitterSystem::checkSnapshot(const SlottedList<EmitterSnapshot>& from, uint64_t tick) const {
    checkSlots(from, emitters_, "fire emitter", "fire emitters");
    for (const Slotted<EmitterSnapshot>& one : from) {
        const FireEmitter& mine = *emitters_.at(one.slot);
        bool fits =
            (mine.def.flags & kSavedFlags) == one.flags && bool(mine.stream) == bool(one.stream);
        if (one.stream)
            for (const components::JetParcel& parcel : one.stream->parcels)
                fits &= parcel.launched == components::kJetNever || parcel.launched <= tick;
        checkSame(fits, "fire emitter", one.slot);
    }
}

void EmitterSystem::restore(const SlottedList<EmitterSnapshot>& from) noexcept {
    time_ = double(context_.clock.tick) / double(gpu::kTicksPerSecond);
    for (const Slotted<EmitterSnapshot>& one : from) {
        FireEmitter& emitter = emitters_.get(emitters_.idOf(one.slot));
        std::copy_n(one.position, 3, emitter.position);
        std::copy_n(one.direction, 3, emitter.direction);
        if (emitter.def.power != one.power) components::setEmitterPower(emitter, one.power);
        emitter.births = {};  // particles in flight belong to another time
        emitter.births.warms = true;
        emitter.lastObstacles = {};
        components::settleSparks(emitter, time_);
        emitter.swept = 0;
        emitter.touches = one.touches;
        if (!emitter.stream) continue;
        *emitter.stream = *one.stream;
        emitter.stream->before = emitter.stream->patches;
        eachRay(*emitter.stream, [&](components::JetRay& ray) {
            ray.version = ray.version != 0 ? scene_.geometryVersion : 0;
        });
    }
}

void EmitterSystem::apply(const WetPatch& command) {
    FireEmitter& emitter = emitters_.get(emitters_.findId(command.emitter));
    if (!emitter.stream || command.patch >= components::kJetPatches)
        core::failData("A command wets patch %u of fire emitter %u.", command.patch,
                       command.emitter + 1);
    for (components::JetPatches* patches : {&emitter.stream->patches, &emitter.stream->before})
        components::wetPatch((*patches)[command.patch], command.grams, command.tick);
    context_.recorder.record(command);
}

void EmitterSystem::shiftOrigin(const double (&by)[3]) noexcept {
    double along = 0;  // m up
    for (int i = 0; i < 3; ++i) along += by[i] * double(context_.def.up[i]);
    for (auto [i, emitter] : emitters_.entries()) moveEmitter(emitter, by, along);
}

}  // namespace fw::world
