// Saving and loading a world mid-burn. The snapshot is captured at the frame that was asked for,
// the objects' images come with its readback. Loading checks all of a snapshot before anything
// changes; the backend goes first, since it alone may still fail.
#include "world/save.h"

#include "components/sparks.h"
#include "core/hash.h"
#include "core/reserved.h"
#include "shared/field_draw.h"
#include "shared/heat.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

namespace fw::world {
namespace {

constexpr uint64_t kNoEvents = ~uint64_t(0);
constexpr uint32_t kEmitterKind = FW_EMITTER_JET | FW_EMITTER_IGNITES;

void hashMore(uint64_t& hash, const void* data, size_t bytes) noexcept {
    const auto* from = static_cast<const unsigned char*>(data);
    for (size_t at = 0; at < bytes; at += sizeof(uint32_t)) {
        uint32_t word = 0;
        std::memcpy(&word, from + at, std::min(sizeof word, bytes - at));
        hash = core::hashWords(std::span(&word, 1), hash);
    }
}

uint64_t hashOf(const mesh::BurnDomain& domain) noexcept {
    uint64_t hash = core::kFnvOffset;
    const auto add = [&](const auto& array) {
        hashMore(hash, array.data(), array.size() * sizeof array[0]);
    };
    hashMore(hash, &domain.width, sizeof domain.width);
    hashMore(hash, &domain.height, sizeof domain.height);
    hashMore(hash, &domain.quantum, sizeof domain.quantum);
    add(domain.texels), add(domain.normals), add(domain.slowness), add(domain.links);
    return hash;
}

void checkRule(float saved, float mine, const char* name) {
    if (!(saved == mine))
        core::fail(FW_ERROR_BAD_DATA, "The save's FwWorldDef::%s is %g; this world's is %g.", name,
                   double(saved), double(mine));
}
void checkRule(uint32_t saved, uint32_t mine, const char* name) {
    if (saved != mine)
        core::fail(FW_ERROR_BAD_DATA, "The save's FwWorldDef::%s is %u; this world's is %u.", name,
                   saved, mine);
}
// The same things in the same slots.
template <class List, class Pool>
void checkSlots(const List& saved, const Pool& pool, const char* name, const char* names) {
    if (saved.size() != pool.live())
        core::fail(FW_ERROR_BAD_DATA, "The save has %zu %s; this world has %u.", saved.size(),
                   names, pool.live());
    uint32_t next = 0;
    for (const auto& one : saved) {
        if (one.slot < next || one.slot >= pool.slotCount() || !pool.at(one.slot))
            core::fail(FW_ERROR_BAD_DATA,
                       "The save has %s %u, which this world does not. Create the same things in "
                       "the same order.",
                       name, one.slot + 1);
        next = one.slot + 1;
    }
}
// Refuses one that the world has with another def.
void checkSame(bool same, const char* name, uint32_t slot) {
    if (!same)
        core::fail(FW_ERROR_BAD_DATA,
                   "The save's %s %u has another def here, or a time after the save's.", name,
                   slot + 1);
}
void checkLimit(size_t count, size_t limit, const char* name) {
    if (count > limit)
        core::fail(FW_ERROR_BAD_DATA, "The save has %zu %s; the limit is %zu.", count, name, limit);
}

// An entry for each that is there.
template <class Pool, class List, class Fill>
void captureEach(Pool& pool, List& to, const Fill& fill) {
    to.clear();
    for (uint32_t i = 0; i < pool.slotCount(); ++i)
        if (auto* entry = pool.at(i)) {
            auto& made = to.emplace_back();
            made.slot = i;
            fill(*entry, made);
        }
}

// Whether the next frame takes the save.
bool startsSave(const core::Owned<Save>& save) noexcept {
    return save && save->requested && !save->pending;
}

// Refuses values out of range and references to what this world does not have. Ids become this
// world's.
class SnapshotChecker : public save::Archive<SnapshotChecker> {
 public:
    static constexpr bool kReads = false;
    explicit SnapshotChecker(const Scene& scene) : scene_(scene) {}

    template <class T>
    void number(const T&) noexcept {}
    void blob(const char*, std::span<const std::byte>) noexcept {}
    template <class Get, class Set>
    void plane(const char*, size_t, uint32_t, save::PlaneMask, uint32_t, const Get&,
               const Set&) noexcept {}
    template <class List>
    void list(const char*, List& entries, size_t) {
        for (auto& entry : entries) (*this)(entry);
    }
    template <class T>
    void optional(core::Owned<T>& value) {
        if (value) (*this)(*value);
    }
    void object(const char* name, uint32_t slot) const {
        if (slot >= scene_.objects.slotCount() || !scene_.objects.at(slot))
            core::fail(FW_ERROR_BAD_DATA,
                       "The save has %s of burnable mesh %u, which is not there.", name, slot + 1);
    }
    void object(const char* name, FwBurnableMeshId& id) const {
        if (id.index1 == 0) return;
        object(name, id.index1 - 1);
        id = scene_.objects.idOf(id.index1 - 1);
    }
    void texel(const char* name, uint32_t slot, uint32_t texel) const {
        object(name, slot);
        const mesh::BurnDomain& domain = scene_.domainOf(scene_.objectAt(slot));
        if (texel >= domain.texelCount() || !domain.real(texel))
            core::fail(FW_ERROR_BAD_DATA,
                       "The save has %s at texel %u of burnable mesh %u, which is not there.", name,
                       texel, slot + 1);
    }
    void texel(const char* name, FwBurnableMeshId& id, uint32_t at) const {
        object(name, id);
        if (id.index1 != 0) texel(name, id.index1 - 1, at);
    }
    template <class T>
    void range(const char* name, const T& value, double low, double high) const {
        if constexpr (std::is_arithmetic_v<T>) {
            if (!(double(value) >= low && double(value) <= high))
                core::fail(FW_ERROR_BAD_DATA, "The save's %s is %.9g; the limits are [%.9g, %.9g].",
                           name, double(value), low, high);
        } else {
            for (const auto& one : value) range(name, one, low, high);
        }
    }
    void require(bool good, const char* name) const {
        if (!good) core::fail(FW_ERROR_BAD_DATA, "The save's %s is out of its limits.", name);
    }

 private:
    const Scene& scene_;
};

}  // namespace

uint64_t Scene::meshHash(const Object& object) noexcept {
    MeshEntry& mesh = *meshes.at(object.data.meshSlot);
    if (mesh.hash == 0) mesh.hash = hashOf(*mesh.domain) | 1;
    return mesh.hash;
}

uint64_t PersistenceSystem::assetOf(const Object& object) noexcept {
    uint64_t hash = world_.scene_.meshHash(object);
    const components::BurnableMesh& data = object.data;
    const uint32_t flags = data.flags & ~uint32_t(FW_BURNABLE_HIDDEN);
    hashMore(hash, &flags, sizeof flags);
    hashMore(hash, &data.moisture, sizeof data.moisture);
    hashMore(hash, data.shape, sizeof data.shape);
    hashMore(hash, &data.materialMask, sizeof data.materialMask);
    for (uint32_t i = 0; i < components::kMaterials; ++i)
        if ((data.materialMask >> i & 1) != 0)
            hashMore(hash, &data.materials[i], sizeof data.materials[i]);
    hashMore(hash, object.slowness.data(), object.slowness.size() * sizeof(uint16_t));
    static_assert(sizeof(components::Governance) == 16);
    hashMore(hash, &object.governance, sizeof object.governance);
    return hash;
}

// Ticks after which the time of a tile's last change does not matter.
uint32_t PersistenceSystem::windowOf(const Object& object) noexcept {
    components::Latch latch = object.latch;
    const components::Records records =
        components::makeRecords(object.data, world_.scene_.domainOf(object),
                                world_.wind_.driveInput(object, world_.context_.clock.tick), latch);
    uint32_t window = records.timing.window;
    for (const gpu::BurnMaterial& material : records.materials)
        window = std::max(window, material.windowMax);
    return std::min(window, 1u << 24) + 2 * gpu::kStepTicks;
}

uint32_t PersistenceSystem::explainUnsavable() noexcept {
    for (uint32_t i = 0; i < world_.scene_.objects.slotCount(); ++i)
        if (auto* object = world_.scene_.objects.at(i);
            object && ((*object)->data.flags & core::reserved::kBurning) && (*object)->touched)
            return i + 1;
    return 0;
}

void PersistenceSystem::requestSave(SaveFor who) {
    if (const uint32_t object1 = explainUnsavable())
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "Burnable mesh %u burns by an extension; such fires cannot be saved.", object1);
    core::Owned<Save>& save = saves_[size_t(who)];
    if (!save) save = core::Owned<Save>::make(world_.context_.memory, world_.context_.memory);
    save->requested = true;
    save->ready = false;
}

void PersistenceSystem::cancelSave() noexcept { saves_[size_t(SaveFor::host)] = {}; }

const std::pmr::vector<std::byte>* PersistenceSystem::fetchSave(SaveFor who) {
    const core::Owned<Save>& save = saves_[size_t(who)];
    if (!save || (!save->requested && !save->pending && !save->ready))
        core::fail(FW_ERROR_INVALID_ARGUMENT, "No save was asked for; request it first.");
    if (save->failed) {
        save->failed = false;
        throw std::bad_alloc();
    }
    return save->ready && !save->requested ? &save->bytes : nullptr;
}

// Before a frame is planned: lists the objects whose images a save needs.
void PersistenceSystem::planSave() {
    images_.clear();
    if (std::none_of(saves_.begin(), saves_.end(), startsSave)) return;
    images_.reserve(world_.scene_.objects.slotCount());
    for (uint32_t i = 0; i < world_.scene_.objects.slotCount(); ++i) {
        auto* owned = world_.scene_.objects.at(i);
        if (!owned) continue;
        // All objects that an event of the frame addresses are among its latches.
        if ((*owned)->touched || (*owned)->planStamp == world_.burn_.state_.planStamp)
            images_.push_back(i);
    }
}

// After it was committed.
void PersistenceSystem::commitSave(uint64_t frameIndex) noexcept {
    for (size_t who = 0; who < saves_.size(); ++who) {
        if (!startsSave(saves_[who])) continue;
        Save& save = *saves_[who];
        save.requested = save.ready = false;
        try {
            capture(save.snapshot);
            save.pending = true;
            save.frameIndex = frameIndex;
            // A network's saves have no events: they are not of the receiver's past.
            save.eventsFrom =
                who == size_t(SaveFor::net) ? kNoEvents : world_.context_.events.next();
        } catch (...) {
            save.failed = true;
        }
        if (who == size_t(SaveFor::host)) recordSave();
        if (who == size_t(SaveFor::timeline) && timeline_) timeline_->captured = timeline_->applied;
        if (who != size_t(SaveFor::net) || !recording_) continue;
        recording_->captured = true;
        recording_->capturedAt = world_.context_.clock.tick;
        recording_->capturedBehind = recording_->commands.size();
    }
}

void PersistenceSystem::capture(Snapshot& to) {
    to.rules = world_.context_.def;
    to.clock = world_.context_.clock;
    to.droppedSteps = world_.burn_.state_.droppedSteps;
    to.order = world_.burn_.state_.order;
    std::copy_n(world_.wind_.state_.wind, 3, to.wind);
    to.windGrid = world_.wind_.state_.grid;
    to.heatOcclusion = world_.exchange_.state_.shield.grid;
    to.gusts = world_.wind_.state_.gusts;
    std::copy_n(world_.context_.origin.moved, 3, to.origin);
    to.flags = world_.exchange_.state_.book.flags | world_.exchange_.state_.book.objectFlags;
    to.warms = world_.exchange_.state_.book.warms;
    to.occludersDue = world_.exchange_.state_.book.occludersDue;
    to.fades = world_.exchange_.state_.book.fades;
    to.gustsShown = world_.wind_.state_.gustsShown;
    captureEach(world_.scene_.objects, to.objects,
                [&](auto& object, ObjectSnapshot& made) { captureObject(*object, made); });
    to.pending = world_.burn_.state_.pending;
    to.tags = world_.queries_.state_.tags;
    to.pairs.clear();
    std::copy_if(world_.exchange_.state_.book.pairs.begin(),
                 world_.exchange_.state_.book.pairs.end(), std::back_inserter(to.pairs),
                 [](const PairContacts& pair) { return pair.touches; });
    std::sort(to.pairs.begin(), to.pairs.end(), [](const PairContacts& a, const PairContacts& b) {
        return std::tie(a.slots[0], a.slots[1]) < std::tie(b.slots[0], b.slots[1]);
    });
    to.seen.clear();
    world_.exchange_.recordSeen(to.seen);
    to.latchedOccluders = world_.exchange_.state_.book.occluders;
    const auto copy = [](const auto& from, auto& made) {
        static_cast<std::remove_cvref_t<decltype(from)>&>(made) = from;
    };
    captureEach(world_.exchange_.state_.occluders, to.occluders, copy);
    captureEach(world_.wind_.state_.zones, to.windZones, copy);
    captureEach(world_.rooms_.state_.rooms, to.rooms, copy);
    captureEach(world_.flames_.state_.fires, to.fires, [&](const auto& fire, FireSnapshot& made) {
        static_cast<components::FireControls&>(made) = fire->data;
        made.flags = fire->data.flags & FW_FIRE_IGNITES;
        made.touches = fire->touches;
    });
    captureEach(world_.emitters_.state_.emitters, to.emitters,
                [&](const components::FireEmitter& emitter, EmitterSnapshot& made) {
                    made.flags = emitter.def.flags & kEmitterKind;
                    std::copy_n(emitter.position, 3, made.position);
                    std::copy_n(emitter.direction, 3, made.direction);
                    made.power = emitter.def.power;
                    made.touches = emitter.touches;
                    if (!emitter.stream) return;
                    made.stream = core::Owned<components::JetStream>::make(world_.context_.memory,
                                                                           *emitter.stream);
                    for (components::JetParcel& parcel : made.stream->parcels)
                        for (components::JetRay& ray : parcel.rays) {
                            ray.version = ray.version == world_.scene_.geometryVersion ? 1 : 0;
                            if (ray.version == 0) ray.hit = {};  // it may be of what is gone
                        }
                });
    captureEach(world_.fields_.state_.fields, to.fields,
                [&](const auto& field, FieldSnapshot& made) {
                    made.width = field->data.def.width;
                    made.height = field->data.def.height;
                    made.began = field->began;
                    std::copy_n(field->data.position, 3, made.position);
                    std::copy_n(field->data.rotation, 4, made.rotation);
                    made.amount = field->data.def.look.amount;
                    if (!field->cells) return;
                    made.cells = core::Owned<field::FieldCells>::make(world_.context_.memory,
                                                                      world_.context_.memory);
                    *made.cells = *field->cells;
                });
}

void PersistenceSystem::captureObject(Object& object, ObjectSnapshot& to) noexcept {
    static_cast<ObjectState&>(to) = object;
    to.asset = assetOf(object);
    to.pose = object.data.pose;
    if (object.play.burn1 != 0)
        to.burnHash = (*world_.burn_.state_.burns.at(object.play.burn1 - 1))->hash;
    to.placed = object.exchangeVersion != 0;
    to.remote.neighbourFirst = to.remote.neighbourCount = 0;
    to.filters = object.latch.filters;
    to.latched = object.latch.pose;
}

// With a readback, after the counters were taken.
void PersistenceSystem::completeSaves(const gpu::Readback& readback) noexcept {
    for (core::Owned<Save>& save : saves_) {
        if (!save || !save->pending || readback.frameIndex < save->frameIndex) continue;
        save->pending = false;
        try {
            completeSave(*save, readback);
        } catch (...) {
            save->failed = true;
        }
    }
    keepKeyframe();
}

void PersistenceSystem::completeSave(Save& save, const gpu::Readback& readback) {
    Snapshot& saved = save.snapshot;
    size_t touched = 0;
    bool whole = readback.frameIndex == save.frameIndex;
    for (const ObjectSnapshot& object : saved.objects) {
        touched += object.touched ? 1 : 0;
        const auto* now = object.slot < world_.scene_.objects.slotCount()
                              ? world_.scene_.objects.at(object.slot)
                              : nullptr;
        whole = whole && now && (*now)->firstFrame <= save.frameIndex;
    }
    // Objects were destroyed since the capture: the next frame tries again.
    if (!whole || touched != readback.images.size()) {
        save.requested = true;
        return;
    }
    save.planes.clear();
    struct Ends {
        size_t image = 0, all = 0;
    };
    std::pmr::vector<Ends> ends(world_.context_.memory);
    std::pmr::vector<uint32_t> lost(world_.context_.memory);
    for (const gpu::ObjectImage& image : readback.images) {
        const Object& object = world_.scene_.objectAt(image.object);
        writeImage(image, world_.scene_.domainOf(object), readback.endTick, windowOf(object),
                   save.planes);
        Ends& end = ends.emplace_back();
        end.image = save.planes.size();
        if (object.breaks) {
            lost.assign(object.breaks->lost.begin(), object.breaks->lost.end());
            save::writePlane(lost, world_.scene_.domainOf(object).width, {}, save.planes);
        }
        end.all = save.planes.size();
    }
    captureEvents(save);
    size_t next = 0, from = 0;
    for (ObjectSnapshot& object : saved.objects) {
        if (!object.touched) {
            if (object.slot < readback.objects.size())
                object.counters.air = readback.objects[object.slot].air;
            continue;
        }
        const gpu::ObjectImage& image = readback.images[next];
        if (image.object != object.slot) {
            save.requested = true;
            return;
        }
        const Ends& end = ends[next++];
        const Object& live = world_.scene_.objectAt(object.slot);
        object.planes = std::span(save.planes).subspan(from, end.image - from);
        object.findsBreaks = bool(live.breaks);
        if (live.breaks) object.breaks = *live.breaks;
        object.lost = std::span(save.planes).subspan(end.image, end.all - end.image);
        from = end.all;
        object.carried = live.carried;
        object.lifecycle = live.lifecycle;
        object.counters = image.counters;
        object.counters.refined = 0;
        // Of what the backend alone knew at that frame.
        if (object.play.began != 0 &&
            !gpu::isPlayingBack(image.counters.playsUntil, uint32_t(saved.clock.tick)))
            object.play = {};
    }
    for (Slotted<RoomEntry>& room : saved.rooms)  // its air goes on from what the frame left
        if (room.slot < readback.rooms.size() && readback.rooms[room.slot].epoch == room.air.epoch)
            room.air = readback.rooms[room.slot];
    saved.steps = world_.burn_.state_.steps;
    saved.idle = world_.burn_.state_.seenIdle;
    saved.lastStimulus = world_.burn_.state_.seenStimulus;
    saved.roomsStirred = world_.rooms_.state_.seenStirred;
    saved.stats = {world_.burn_.state_.counts.front, world_.burn_.state_.counts.burning,
                   world_.burn_.state_.counts.hot, world_.burn_.state_.counts.receivers,
                   world_.burn_.state_.counts.lateClamps};
    writeSnapshot(saved, save.bytes);
    save.ready = true;
}

// Of a tag that was reached by the save's frame the save has the event alone.
void PersistenceSystem::forgetTag(Save& save, const Tag& tag, uint64_t frameIndex) noexcept {
    if (frameIndex > save.frameIndex) return;
    std::pmr::vector<Tag>& tags = save.snapshot.tags;
    const auto same = std::find_if(tags.begin(), tags.end(), [&](const Tag& one) {
        return one.object.index1 == tag.object.index1 && one.texel == tag.texel &&
               one.tag == tag.tag;
    });
    if (same != tags.end()) tags.erase(same);
}

// Events that the host had not polled at the save's frame, and later ones of that frame.
void PersistenceSystem::captureEvents(Save& save) {
    std::pmr::vector<SavedEvent>& to = save.snapshot.events;
    to.clear();
    std::pmr::vector<std::pair<uint64_t, uint64_t>> found(
        world_.context_.memory);  // frame and number
    for (uint64_t i = std::max(save.eventsFrom, world_.context_.events.oldest());
         i < world_.context_.events.end(); ++i) {
        const FwEvent& event = world_.context_.events.at(i);
        if (event.frameIndex > save.frameIndex) continue;
        if (event.object.index1 != 0 && !world_.scene_.objects.find(event.object)) continue;
        found.emplace_back(event.frameIndex, i);
    }
    std::sort(found.begin(),
              found.end());  // readbacks of a device come later than the world's own events
    for (size_t k = found.size() - std::min<size_t>(found.size(), kMaxSavedEvents);
         k < found.size(); ++k) {
        const FwEvent& event = world_.context_.events.at(found[k].second);
        SavedEvent& saved = to.emplace_back();
        static_cast<FwEvent&>(saved) = event;
        if (!world_.scene_.objects.find(event.other)) saved.other = {};
        for (int i = 0; event.type != FW_EVENT_TIME_DROPPED && i < 3; ++i)  // moved since
            saved.position[i] = float(double(saved.position[i]) + save.snapshot.origin[i] -
                                      world_.context_.origin.moved[i]);
    }
}

void PersistenceSystem::checkSnapshot(Snapshot& saved) {
    const FwWorldDef& rules = saved.rules;
    checkRule(rules.paceFactor, world_.context_.def.paceFactor, "paceFactor");
    for (int i = 0; i < 3; ++i) checkRule(rules.up[i], world_.context_.def.up[i], "up");
    checkRule(rules.spreadChance, world_.context_.def.spreadChance, "spreadChance");
    checkRule(rules.timeToLive, world_.context_.def.timeToLive, "timeToLive");
    checkRule(rules.seed, world_.context_.def.seed, "seed");
    checkRule(rules.maxHops, world_.context_.def.maxHops, "maxHops");
    checkRule(rules.maxBurningTiles, world_.context_.def.maxBurningTiles, "maxBurningTiles");
    checkSlots(saved.objects, world_.scene_.objects, "burnable mesh", "burnable meshes");
    checkSlots(saved.occluders, world_.exchange_.state_.occluders, "occluder", "occluders");
    checkSlots(saved.windZones, world_.wind_.state_.zones, "wind zone", "wind zones");
    checkSlots(saved.rooms, world_.rooms_.state_.rooms, "room", "rooms");
    checkSlots(saved.fires, world_.flames_.state_.fires, "volumetric fire", "volumetric fires");
    checkSlots(saved.emitters, world_.emitters_.state_.emitters, "fire emitter", "fire emitters");
    checkSlots(saved.fields, world_.fields_.state_.fields, "particle field", "particle fields");
    SnapshotChecker check(world_.scene_);
    check(saved);
    for (const double metres : saved.origin)
        check.require(metres == std::floor(metres), "origin, which moves by whole metres,");
    if ((saved.flags & ~kWorldFlags) != 0)
        core::fail(FW_ERROR_BAD_DATA, "The save's flags are 0x%x; the known flags are 0x%x.",
                   saved.flags, kWorldFlags);
    for (const ObjectSnapshot& object : saved.objects) {
        const uint64_t mine = assetOf(world_.scene_.objectAt(object.slot));
        if (object.asset != mine)
            core::fail(FW_ERROR_BAD_DATA,
                       "Burnable mesh %u is not the save's: mesh, materials and def hash to "
                       "0x%016llX, the save's to 0x%016llX.",
                       object.slot + 1, static_cast<unsigned long long>(mine),
                       static_cast<unsigned long long>(object.asset));
    }
    checkLimit(saved.pending.size(), BurnSystem::kMaxPending, "events that wait");
    for (const PendingTexel& event : saved.pending) {
        if (event.texel == kAllTexels && event.kind <= gpu::kEventExtinguish)
            check.object("an event", event.object);
        else
            check.texel("an event", event.object, event.texel);
        if (gpu::eventKind(event.kind) == gpu::kEventCarry)
            world_.burn_.checkCarry(event, saved.clock);
        else
            check.range("kind of an event", event.kind, 0, gpu::kEventHeat);
    }
    checkLimit(saved.tags.size(), QuerySystem::kMaxTags, "tags");
    checkLimit(saved.events.size(), kMaxSavedEvents, "events");
    checkLimit(saved.latchedOccluders.size(), gpu::kMaxHeatOccluders, "latched occluders");
    uint64_t before = 0;
    for (const Seen& seen : saved.seen) {
        const uint64_t pair = (uint64_t(seen.slots[0]) << 32 | seen.slots[1]) + 1;
        check.require(pair > before, "order of lines of sight");
        before = pair;
    }
    check.require(components::plausible(saved.gusts, saved.clock.tick), "state of gusts");
    for (const components::OcclusionCell& cell : saved.heatOcclusion.baked)
        check.texel("a cell of the shield", cell.what & gpu::kOcclusionSlotMask, cell.texel);
    for (const Slotted<FireSnapshot>& fire : saved.fires)
        checkSame(((*world_.flames_.state_.fires.at(fire.slot))->data.flags & FW_FIRE_IGNITES) ==
                      fire.flags,
                  "volumetric fire", fire.slot);
    for (const Slotted<EmitterSnapshot>& emitter : saved.emitters) {
        const components::FireEmitter& mine = *world_.emitters_.state_.emitters.at(emitter.slot);
        bool same = (mine.def.flags & kEmitterKind) == emitter.flags &&
                    bool(mine.stream) == bool(emitter.stream);
        if (emitter.stream)
            for (const components::JetParcel& parcel : emitter.stream->parcels)
                same &=
                    parcel.launched == components::kJetNever || parcel.launched <= saved.clock.tick;
        checkSame(same, "fire emitter", emitter.slot);
    }
    for (const Slotted<FieldSnapshot>& field : saved.fields) {
        const Field& mine = **world_.fields_.state_.fields.at(field.slot);
        checkSame(bool(mine.cells) == bool(field.cells) && mine.data.def.width == field.width &&
                      mine.data.def.height == field.height && field.began <= saved.clock.tick &&
                      (!field.cells ||
                       (field.cells->width == field.width && field.cells->height == field.height)),
                  "particle field", field.slot);
    }
}

BurnRecords PersistenceSystem::recordsOf(const Snapshot& saved, const ObjectSnapshot& from,
                                         components::Latch& latch) {
    const Object& object = world_.scene_.objectAt(from.slot);
    const mesh::BurnDomain& domain = world_.scene_.domainOf(object);
    components::DriveInput drive = world_.wind_.driveInput(object, world_.context_.clock.tick);
    drive.wind = windOf({fire::windUnits(saved.wind), saved.windGrid, saved.gusts, saved.zones,
                         world_.context_.def.seed},
                        windPlaceOf(from.pose, domain), saved.clock.tick);
    components::BurnableMesh posed = object.data;
    posed.pose = from.pose;
    components::resetLatch(posed, drive, latch);
    BurnRecords made;
    // The backend may have records of an unburnt object from this world's past, of another wind.
    latch.sent = from.touched;
    if (!from.touched) return made;
    latch.filters = from.filters;
    latch.pose = from.latched;
    made.records = components::makeRecords(posed, domain, drive, latch);
    made.heated = components::hasHeat(object.data);
    if (made.heated)
        made.heat = components::makeHeatMaterials(posed, domain, world_.context_.def.paceFactor);
    uint32_t window = made.records.timing.window;
    for (const gpu::BurnMaterial& material : made.records.materials)
        window = std::max(window, material.windowMax);
    made.window = std::min(window, 1u << 24) + 2 * gpu::kStepTicks;
    return made;
}

void PersistenceSystem::load(std::span<const std::byte> bytes) {
    mayChange();
    Snapshot saved(world_.context_.memory);
    readSnapshot(bytes, saved);
    checkSnapshot(saved);
    world_.burn_.settlePlays(saved);
    // The latches come first: the backend's records follow from them.
    std::pmr::vector<components::Latch> latches(world_.context_.memory);
    std::pmr::vector<ImageStore> stores(world_.context_.memory);
    std::pmr::vector<gpu::RestoredObject> restored(world_.context_.memory);
    latches.reserve(saved.objects.size());
    stores.reserve(saved.objects.size());
    restored.reserve(saved.objects.size());
    for (const ObjectSnapshot& from : saved.objects) {
        const BurnRecords made = recordsOf(saved, from, latches.emplace_back());
        if (!from.touched && from.counters.air != 0) {
            gpu::RestoredObject& one = restored.emplace_back();
            one.image.object = from.slot;
            one.image.counters.air = from.counters.air;
            one.rests = true;
        }
        if (!from.touched) continue;
        ImageStore& store = stores.emplace_back(world_.context_.memory);
        readImage(from.planes, world_.scene_.domainOf(world_.scene_.objectAt(from.slot)),
                  uint32_t(saved.clock.tick), made.window, made.heatSpan(), store);
        if (from.findsBreaks && (*world_.scene_.objects.at(from.slot))->breaks) {
            const mesh::BurnDomain& domain =
                world_.scene_.domainOf(world_.scene_.objectAt(from.slot));
            store.lost.resize(domain.texelCount());
            if (!save::readPlane(from.lost, domain.width, {}, store.lost))
                core::fail(FW_ERROR_BAD_DATA,
                           "The save's plane of broken texels of burnable mesh %u is damaged.",
                           from.slot + 1);
        }
        gpu::RestoredObject& one = restored.emplace_back();
        one.image = {from.slot,   store.ticks,    store.heat,
                     store.tiles, store.tileHeat, from.counters};
        std::copy(made.records.materials.begin(), made.records.materials.end(), one.materials);
        one.window = made.records.timing.window;
        one.substepShift = made.records.timing.substepShift;
    }
    world_.exchange_.state_.book.pairs.reserve(saved.pairs.size());
    world_.exchange_.state_.book.loadedSeen.reserve(saved.seen.size());
    world_.scene_.touched.reserve(world_.scene_.objects.slotCount());
    world_.scene_.playing.reserve(world_.scene_.objects.slotCount());
    world_.exchange_.state_.book.due.reserve(world_.scene_.objects.slotCount());
    world_.exchange_.state_.book.occluders.reserve(saved.latchedOccluders.size());
    uint32_t flames = 0;
    for (const Slotted<FireSnapshot>& from : saved.fires)
        flames += components::maxParts(from.power,
                                       (*world_.flames_.state_.fires.at(from.slot))->data.diameter);
    world_.flames_.reserve(flames);
    world_.scene_.places.reserveMoves(world_.scene_.objects.live());
    world_.context_.backend.restore(restored, uint32_t(saved.clock.tick));

    // From here on nothing fails.
    double by[3];  // the origin's move, for everything that no save has
    for (int i = 0; i < 3; ++i) by[i] = saved.origin[i] - world_.context_.origin.moved[i];
    world_.shiftBy(by);
    world_.context_.origin.count = 0;
    world_.burn_.state_.loaded.front = saved.stats.frontTiles;
    world_.burn_.state_.loaded.hot = saved.stats.hotTiles;
    for (const ImageStore& store : stores)
        for (const gpu::TileState& tile : store.tiles) {
            world_.burn_.state_.loaded.front -=
                (tile.flag & gpu::kTileListed) != 0 && world_.burn_.state_.loaded.front > 0 ? 1u
                                                                                            : 0u;
            world_.burn_.state_.loaded.hot -=
                (tile.flag & gpu::kTileHot) != 0 && world_.burn_.state_.loaded.hot > 0 ? 1u : 0u;
        }
    world_.wind_.state_.grid.shape = saved.windGrid.shape;
    world_.wind_.state_.grid.points.swap(saved.windGrid.points);
    world_.exchange_.state_.shield.grid.shape = saved.heatOcclusion.shape;
    world_.exchange_.state_.shield.grid.solid.swap(saved.heatOcclusion.solid);
    world_.exchange_.state_.shield.grid.baked.swap(saved.heatOcclusion.baked);
    world_.exchange_.state_.shield.commandSlots.clear();
    world_.exchange_.state_.shield.unsent = world_.exchange_.state_.shield.unpacked = true;
    apply(saved, latches);
    size_t next = 0;
    for (const ObjectSnapshot& from : saved.objects) {
        if (!from.touched) continue;
        const ImageStore& store = stores[next++];
        if (Object& object = world_.scene_.objectAt(from.slot); object.breaks)
            world_.burn_.restoreBreaks(object, from.findsBreaks ? &from.breaks : nullptr, store,
                                       uint32_t(world_.context_.clock.tick));
    }
    world_.queries_.state_.tags.swap(saved.tags);
    world_.burn_.state_.pending.swap(saved.pending);
    world_.burn_.settlePending();
    for (Slotted<FieldSnapshot>& field : saved.fields)
        if (field.cells)
            static_cast<field::FieldCells&>(
                *(*world_.fields_.state_.fields.at(field.slot))->cells) = std::move(*field.cells);
}

void PersistenceSystem::apply(const Snapshot& saved,
                              std::span<const components::Latch> latches) noexcept {
    world_.context_.clock = saved.clock;
    world_.burn_.state_.steps = saved.steps;
    world_.burn_.state_.droppedSteps = saved.droppedSteps;
    world_.burn_.state_.order = saved.order;
    std::copy_n(saved.wind, 3, world_.wind_.state_.wind);
    world_.wind_.state_.gusts = saved.gusts;
    for (const auto& zone : saved.windZones) *world_.wind_.state_.zones.at(zone.slot) = zone;
    world_.wind_.sortZones();
    world_.wind_.state_.kept = true;  // objects find theirs below, one by one
    world_.wind_.updateObjects();
    world_.wind_.state_.gustsShown = saved.gustsShown;
    world_.rooms_.state_.met = !saved.rooms.empty();
    for (const Slotted<RoomEntry>& from : saved.rooms) {
        RoomEntry& entry = *world_.rooms_.state_.rooms.at(from.slot);
        entry.room = from.room;
        world_.rooms_.fill(entry, from.air.oxygen, from.air.power, from.air.flash);
        entry.air.drawn = from.air.drawn;
        entry.air.stirs = from.air.stirs;
        world_.rooms_.send(from.slot);
    }
    world_.rooms_.state_.stirred = world_.rooms_.state_.seenStirred = saved.roomsStirred;
    world_.exchange_.state_.book.flags = saved.flags & kHeatTransferModes;
    world_.exchange_.state_.book.objectFlags = saved.flags & ~kHeatTransferModes;
    world_.exchange_.state_.book.warms = saved.warms;
    world_.exchange_.state_.book.fades = saved.fades;
    ++world_.wind_.state_.changes;
    ++world_.scene_.geometryVersion;
    world_.context_.loadedFrame = world_.context_.lastFrame;
    world_.context_.loadedTick = world_.context_.clock.tick;
    for (core::Owned<Save>& save : saves_) {
        if (!save || !save->pending) continue;
        save->pending = false;  // of the world before the load
        save->requested = true;
    }
    if (timeline_) {
        const bool restarts = !timeline_->seeks;  // it begins here, or is in its own past
        if (restarts) timeline_->restart(world_.context_.clock.tick);
        saves_[size_t(SaveFor::timeline)]->requested = restarts;
    }
    if (recording_) {
        recording_->loaded = true;
        recording_->captured = false;
        recording_->commands.clear();
        recording_->hashes.clear();
    }
    // Requests to earlier frames are made again.
    for (QuerySystem::ProbeFrame& frame : world_.queries_.probeFrames_) frame.frameIndex = 0;
    for (uint32_t i = 0; i < world_.queries_.state_.queries.slotCount(); ++i)
        if (Query* query = world_.queries_.state_.queries.at(i); query && !query->ready)
            query->asked = false;
    world_.context_.events.clear();
    for (const FwEvent& event : saved.events)
        world_.context_.raise(
            event.type,
            event.object.index1 != 0 ? world_.scene_.objects.at(event.object.index1 - 1)->get()
                                     : nullptr,
            event.tag, world_.context_.lastFrame, event.position, event.value, event.other);
    world_.context_.readbackTick = world_.context_.clock.tick;
    // An awake world would filter the wind from here on, not from its first ignition.
    world_.burn_.state_.idle = world_.burn_.state_.seenIdle = saved.idle;
    world_.burn_.state_.lastStimulus = world_.burn_.state_.seenStimulus = saved.lastStimulus;
    world_.burn_.state_.stimuli.clear();
    world_.burn_.state_.frameNotes.clear();
    world_.burn_.state_.counts.front = saved.stats.frontTiles;
    world_.burn_.state_.counts.run = 0;
    world_.burn_.state_.counts.burning = world_.burn_.state_.loaded.burning =
        saved.stats.burningTiles;
    world_.burn_.state_.counts.hot = saved.stats.hotTiles;
    world_.burn_.state_.counts.receivers = world_.burn_.state_.loaded.receivers =
        saved.stats.receivers;
    world_.burn_.state_.counts.lateClamps = saved.stats.lateClamps;
    world_.exchange_.state_.book.unsent = true;
    world_.exchange_.state_.book.occludersDue = saved.occludersDue;
    world_.exchange_.state_.book.occluders.assign(saved.latchedOccluders.begin(),
                                                  saved.latchedOccluders.end());
    world_.exchange_.state_.book.rebuild = true;
    world_.exchange_.state_.book.due.clear();
    for (const auto& occluder : saved.occluders)
        *world_.exchange_.state_.occluders.at(occluder.slot) = occluder;
    world_.scene_.touched.clear();
    world_.scene_.playing.clear();
    for (size_t i = 0; i < saved.objects.size(); ++i)
        applyObject(saved.objects[i], latches[i], world_.scene_.objectAt(saved.objects[i].slot));
    world_.lights_.showSaved();
    world_.exchange_.state_.book.pairs.clear();
    for (PairContacts pair : saved.pairs) {
        for (int k = 0; k < 2; ++k) pair.ids[k] = world_.scene_.objects.idOf(pair.slots[k]);
        pair.versions[0] = pair.versions[1] = 0;  // its links are found again
        pair.stamp = 0;
        pair.touches = true;
        world_.exchange_.state_.book.pairs.push_back(pair);
    }
    world_.exchange_.state_.book.loadedSeen.assign(saved.seen.begin(), saved.seen.end());
    for (const Slotted<FireSnapshot>& from : saved.fires) {
        Fire& fire = **world_.flames_.state_.fires.at(from.slot);
        if (!(from == fire.data)) {  // as if it had always burnt so
            world_.flames_.burning_.drop(fire.data);
            fire.data.state = {};
            fire.data.points = from.points;
            fire.data.pointCount = from.pointCount;
            components::setFirePosition(fire.data, from.position);
            components::setFirePower(fire.data, from.power);
            world_.flames_.predictAhead(fire.data);
        }
        for (size_t k = 0; k < from.touches.size(); ++k) {
            const bool seen = fire.touches[k].seen;
            fire.touches[k] = from.touches[k];
            fire.touches[k].seen = seen;
        }
    }
    world_.emitters_.state_.time =
        double(world_.context_.clock.tick) / double(gpu::kTicksPerSecond);
    for (const Slotted<EmitterSnapshot>& from : saved.emitters) {
        components::FireEmitter& emitter =
            world_.emitters_.state_.emitters.get(world_.emitters_.state_.emitters.idOf(from.slot));
        std::copy_n(from.position, 3, emitter.position);
        std::copy_n(from.direction, 3, emitter.direction);
        if (emitter.def.power != from.power) components::setEmitterPower(emitter, from.power);
        emitter.births = {};  // particles in flight belong to another time
        emitter.births.warms = true;
        emitter.lastObstacles = {};
        components::settleSparks(emitter, world_.emitters_.state_.time);
        emitter.swept = 0;
        emitter.touches = from.touches;
        if (!emitter.stream) continue;
        *emitter.stream = *from.stream;
        emitter.stream->before = emitter.stream->patches;
        for (components::JetParcel& parcel : emitter.stream->parcels)
            for (components::JetRay& ray : parcel.rays)
                ray.version = ray.version != 0 ? world_.scene_.geometryVersion : 0;
    }
    for (const Slotted<FieldSnapshot>& from : saved.fields) {
        Field& field = **world_.fields_.state_.fields.at(from.slot);
        // The backend counts its own steps, and continues from them.
        const uint32_t ran = field.steps - field.shownBase;
        field.began = from.began;
        std::copy_n(from.position, 3, field.data.position);
        std::copy_n(from.rotation, 4, field.data.rotation);
        field.data.def.look.amount = from.amount;
        field.steps = components::fieldSteps(field.data, world_.context_.clock.tick - field.began);
        field.shownBase = field.steps - ran;
    }
    world_.fields_.sendRules();
}

void PersistenceSystem::applyObject(const ObjectSnapshot& from, const components::Latch& latch,
                                    Object& object) noexcept {
    static_cast<ObjectState&>(object) = from;
    object.data.pose = from.pose;
    world_.context_.backend.setObjectWind(object.slot, object.zoneWind);
    world_.scene_.placeNow(object);
    object.sleepsUnder = 0;
    object.room1 = world_.rooms_.roomOf(object);
    world_.rooms_.state_.met |= from.counters.air != 0;
    world_.scene_.sendPose(object);
    object.latch = latch;
    if (object.play.burn1 != 0) world_.burn_.startPlay(object);
    object.firstFrame = world_.context_.lastFrame + 1;
    ++object.changes;
    // Readbacks on their way are lost: they are requested again.
    const auto again = [&](bool& requested, bool& pending) {
        if (!pending) return;
        pending = false;
        if (!requested) ++world_.queries_.mapsRequested_;
        requested = true;
    };
    again(object.map.requested, object.map.pending);
    if (object.forecast) {
        again(object.forecast->requested, object.forecast->pending);
        object.forecast->began = false;
    }
    if (object.breaks) {  // it has not burnt, or is restored next
        object.breaks->lookCount = 0;
        object.breaks->shareReported = object.breaks->waits = false;
        std::fill(object.breaks->lost.begin(), object.breaks->lost.end(), false);
    }
    object.remote = {};
    object.exchangeSent = false;
    object.exchangeVersion = from.placed ? ++world_.exchange_.state_.book.version : 0;
    if (from.exchangeDue) world_.exchange_.state_.book.due.push_back(object.slot);
    if (from.placed) {
        const mesh::BurnDomain& domain = world_.scene_.domainOf(object);
        if (from.exchangeDue) {
            object.remote = from.remote;
        } else {
            components::placeExchangeObject(object.data.pose, domain, object.remote);
            components::fillExchangeObject(object.data, domain, object.governance, object.remote);
            if (object.texels == 0) object.remote.flags &= ~gpu::kExchangeLive;
            object.remote.high.w = from.remote.high.w;
        }
        object.reach = components::exchangeReach(
            object.data, domain, world_.scene_.meshes.at(object.data.meshSlot)->texelsOf);
    }
    object.carryEnd = 0;  // what the save carries is settled with its events
    object.stimuli = 0;
    object.ignites = false;
    if (!from.touched) {
        object.counters = {};
        return;
    }
    world_.scene_.touched.push_back(&object);
    if (object.lifecycle.ignitionKnown)
        world_.context_.backend.startBoundary(object.slot, object.lifecycle.ignitionPoint,
                                              uint32_t(object.lifecycle.firstIgnition));
}

}  // namespace fw::world
