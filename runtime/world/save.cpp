// Saving and loading a world mid-burn. The snapshot is captured at the frame that was asked for,
// the objects' images come with its readback. Loading checks all of a snapshot before anything
// changes; the backend goes first, since it alone may still fail.
#include "world/save.h"

#include "components/sparks.h"
#include "core/hash.h"
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

}  // namespace

// Refuses values out of range and references to what this world does not have. Ids become this
// world's.
class World::SnapshotChecker : public save::Archive<SnapshotChecker> {
 public:
    static constexpr bool kReads = false;
    explicit SnapshotChecker(const World& world) : world_(world) {}

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
        if (slot >= world_.objects_.slotCount() || !world_.objects_.at(slot))
            core::fail(FW_ERROR_BAD_DATA,
                       "The save has %s of burnable mesh %u, which is not there.", name, slot + 1);
    }
    void object(const char* name, FwBurnableMeshId& id) const {
        if (id.index1 == 0) return;
        object(name, id.index1 - 1);
        id = world_.objects_.idOf(id.index1 - 1);
    }
    void texel(const char* name, uint32_t slot, uint32_t texel) const {
        object(name, slot);
        const mesh::BurnDomain& domain = world_.domainOf(**world_.objects_.at(slot));
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
    const World& world_;
};

uint64_t World::meshHash(const Object& object) noexcept {
    MeshEntry& mesh = *meshes_.at(object.data.meshSlot);
    if (mesh.hash == 0) mesh.hash = hashOf(*mesh.domain) | 1;
    return mesh.hash;
}

uint64_t World::assetOf(const Object& object) noexcept {
    uint64_t hash = meshHash(object);
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
uint32_t World::windowOf(const Object& object) noexcept {
    components::Latch latch = object.latch;
    const components::Records records = components::makeRecords(
        object.data, domainOf(object), driveInput(object, clock_.tick), latch);
    uint32_t window = records.timing.window;
    for (const gpu::BurnMaterial& material : records.materials)
        window = std::max(window, material.windowMax);
    return std::min(window, 1u << 24) + 2 * gpu::kStepTicks;
}

uint32_t World::unsavable() noexcept {
    for (uint32_t i = 0; i < objects_.slotCount(); ++i)
        if (auto* object = objects_.at(i);
            object && ((*object)->data.flags & FW_BURNABLE_PUBLISHED) && (*object)->touched)
            return i + 1;
    return 0;
}

void World::requestSave(SaveFor who) {
    if (const uint32_t object1 = unsavable())
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "Burnable mesh %u has FW_BURNABLE_PUBLISHED; such fires cannot be saved.",
                   object1);
    core::Owned<Save>& save = saves_[size_t(who)];
    if (!save) save = core::Owned<Save>::make(memory_, memory_);
    save->requested = true;
    save->ready = false;
}

void World::cancelSave() noexcept { saves_[size_t(SaveFor::host)] = {}; }

const std::pmr::vector<std::byte>* World::fetchSave(SaveFor who) {
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
void World::planSave() {
    frame_.images.clear();
    if (std::none_of(saves_.begin(), saves_.end(), startsSave)) return;
    frame_.images.reserve(objects_.slotCount());
    for (uint32_t i = 0; i < objects_.slotCount(); ++i) {
        auto* owned = objects_.at(i);
        if (!owned) continue;
        // All objects that an event of the frame addresses are among its latches.
        if ((*owned)->touched || (*owned)->planStamp == planStamp_) frame_.images.push_back(i);
    }
}

// After it was committed.
void World::commitSave(uint64_t frameIndex) noexcept {
    for (size_t who = 0; who < saves_.size(); ++who) {
        if (!startsSave(saves_[who])) continue;
        Save& save = *saves_[who];
        save.requested = save.ready = false;
        try {
            capture(save.snapshot);
            save.pending = true;
            save.frameIndex = frameIndex;
            // A network's saves have no events: they are not of the receiver's past.
            save.eventsFrom = who == size_t(SaveFor::net) ? kNoEvents : events_.next();
        } catch (...) {
            save.failed = true;
        }
        if (who == size_t(SaveFor::host)) recordSave();
        if (who == size_t(SaveFor::timeline) && timeline_) timeline_->captured = timeline_->applied;
        if (who != size_t(SaveFor::net) || !recording_) continue;
        recording_->captured = true;
        recording_->capturedAt = clock_.tick;
        recording_->capturedBehind = recording_->commands.size();
    }
}

void World::capture(Snapshot& to) {
    to.rules = def_;
    to.clock = clock_;
    to.droppedSteps = droppedSteps_;
    to.order = order_;
    std::copy_n(wind_, 3, to.wind);
    to.windGrid = windGrid_;
    to.heatShield = shield_.grid;
    to.gusts = gusts_;
    std::copy_n(origin_, 3, to.origin);
    to.flags = remote_.flags | remote_.objectFlags;
    to.warms = remote_.warms;
    to.blockersDue = remote_.blockersDue;
    to.fades = remote_.fades;
    to.gustsShown = gustsShown_;
    captureEach(objects_, to.objects,
                [&](auto& object, ObjectSnapshot& made) { captureObject(*object, made); });
    to.pending = pending_;
    to.tags = tags_;
    to.pairs.clear();
    std::copy_if(remote_.pairs.begin(), remote_.pairs.end(), std::back_inserter(to.pairs),
                 [](const PairContacts& pair) { return pair.touches; });
    std::sort(to.pairs.begin(), to.pairs.end(), [](const PairContacts& a, const PairContacts& b) {
        return std::tie(a.slots[0], a.slots[1]) < std::tie(b.slots[0], b.slots[1]);
    });
    to.seen.clear();
    noteSeen(to.seen);
    to.latchedBlockers = remote_.blockers;
    const auto copy = [](const auto& from, auto& made) {
        static_cast<std::remove_cvref_t<decltype(from)>&>(made) = from;
    };
    captureEach(blockers_, to.blockers, copy);
    captureEach(windPool_, to.windZones, copy);
    captureEach(rooms_, to.rooms, copy);
    captureEach(fires_, to.fires, [&](const auto& fire, FireSnapshot& made) {
        static_cast<components::FireControls&>(made) = fire->data;
        made.flags = fire->data.flags & FW_FIRE_IGNITES;
        made.touches = fire->touches;
    });
    captureEach(
        emitters_, to.emitters, [&](const components::FireEmitter& emitter, EmitterSnapshot& made) {
            made.flags = emitter.def.flags & kEmitterKind;
            std::copy_n(emitter.position, 3, made.position);
            std::copy_n(emitter.direction, 3, made.direction);
            made.power = emitter.def.power;
            made.touches = emitter.touches;
            if (!emitter.stream) return;
            made.stream = core::Owned<components::JetStream>::make(memory_, *emitter.stream);
            for (components::JetParcel& parcel : made.stream->parcels)
                for (components::JetRay& ray : parcel.rays) {
                    ray.version = ray.version == geometry_ ? 1 : 0;
                    if (ray.version == 0) ray.hit = {};  // it may be of what is gone
                }
        });
    captureEach(fields_, to.fields, [&](const auto& field, FieldSnapshot& made) {
        made.width = field->data.def.width;
        made.height = field->data.def.height;
        made.began = field->began;
        std::copy_n(field->data.position, 3, made.position);
        std::copy_n(field->data.rotation, 4, made.rotation);
        made.amount = field->data.def.look.amount;
        if (!field->cells) return;
        made.cells = core::Owned<field::FieldCells>::make(memory_, memory_);
        *made.cells = *field->cells;
    });
}

void World::captureObject(Object& object, ObjectSnapshot& to) noexcept {
    static_cast<ObjectState&>(to) = object;
    to.asset = assetOf(object);
    to.pose = object.data.pose;
    if (object.play.burn1 != 0) to.burnHash = (*burns_.at(object.play.burn1 - 1))->hash;
    to.placed = object.remoteVersion != 0;
    to.remote.neighbourFirst = to.remote.neighbourCount = 0;
    to.filters = object.latch.filters;
    to.latched = object.latch.pose;
}

// With a readback, after the counters were taken.
void World::takeSaves(const gpu::Readback& readback) noexcept {
    for (core::Owned<Save>& save : saves_) {
        if (!save || !save->pending || readback.frameIndex < save->frameIndex) continue;
        save->pending = false;
        try {
            takeSave(*save, readback);
        } catch (...) {
            save->failed = true;
        }
    }
    keepKeyframe();
}

void World::takeSave(Save& save, const gpu::Readback& readback) {
    Snapshot& saved = save.snapshot;
    size_t touched = 0;
    bool whole = readback.frameIndex == save.frameIndex;
    for (const ObjectSnapshot& object : saved.objects) {
        touched += object.touched ? 1 : 0;
        const auto* now = object.slot < objects_.slotCount() ? objects_.at(object.slot) : nullptr;
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
    std::pmr::vector<Ends> ends(memory_);
    std::pmr::vector<uint32_t> lost(memory_);
    for (const gpu::ObjectImage& image : readback.images) {
        const Object& object = **objects_.at(image.object);
        writeImage(image, domainOf(object), readback.endTick, windowOf(object), save.planes);
        Ends& end = ends.emplace_back();
        end.image = save.planes.size();
        if (object.breaks) {
            lost.assign(object.breaks->lost.begin(), object.breaks->lost.end());
            save::writePlane(lost, domainOf(object).width, {}, save.planes);
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
        const Object& live = **objects_.at(object.slot);
        object.planes = std::span(save.planes).subspan(from, end.image - from);
        object.findsBreaks = bool(live.breaks);
        if (live.breaks) object.breaks = *live.breaks;
        object.lost = std::span(save.planes).subspan(end.image, end.all - end.image);
        from = end.all;
        object.carried = live.carried;
        object.story = live.story;
        object.counters = image.counters;
        object.counters.refined = 0;
        // Of what the backend alone knew at that frame.
        if (object.play.began != 0 &&
            !gpu::playsAt(image.counters.playsUntil, uint32_t(saved.clock.tick)))
            object.play = {};
    }
    for (Slotted<RoomEntry>& room : saved.rooms)  // its air goes on from what the frame left
        if (room.slot < readback.rooms.size() && readback.rooms[room.slot].epoch == room.air.epoch)
            room.air = readback.rooms[room.slot];
    saved.steps = steps_;
    saved.idle = seenIdle_;
    saved.lastStimulus = seenStimulus_;
    saved.roomsStirred = seenRoomsStirred_;
    saved.stats = {frontTiles_, burningTiles_, hotTiles_, receivers_, lateClamps_};
    writeSnapshot(saved, save.bytes);
    save.ready = true;
}

// Of a tag that was reached by the save's frame the save has the event alone.
void World::forgetTag(Save& save, const Tag& tag, uint64_t frameIndex) noexcept {
    if (frameIndex > save.frameIndex) return;
    std::pmr::vector<Tag>& tags = save.snapshot.tags;
    const auto same = std::find_if(tags.begin(), tags.end(), [&](const Tag& one) {
        return one.object.index1 == tag.object.index1 && one.texel == tag.texel &&
               one.tag == tag.tag;
    });
    if (same != tags.end()) tags.erase(same);
}

// Events that the host had not polled at the save's frame, and later ones of that frame.
void World::captureEvents(Save& save) {
    std::pmr::vector<SavedEvent>& to = save.snapshot.events;
    to.clear();
    std::pmr::vector<std::pair<uint64_t, uint64_t>> found(memory_);  // frame and number
    for (uint64_t i = std::max(save.eventsFrom, events_.oldest()); i < events_.end(); ++i) {
        const FwEvent& event = events_.at(i);
        if (event.frameIndex > save.frameIndex) continue;
        if (event.object.index1 != 0 && !objects_.find(event.object)) continue;
        found.emplace_back(event.frameIndex, i);
    }
    std::sort(found.begin(),
              found.end());  // readbacks of a device come later than the world's own events
    for (size_t k = found.size() - std::min<size_t>(found.size(), kMostSavedEvents);
         k < found.size(); ++k) {
        const FwEvent& event = events_.at(found[k].second);
        SavedEvent& saved = to.emplace_back();
        static_cast<FwEvent&>(saved) = event;
        if (!objects_.find(event.other)) saved.other = {};
        for (int i = 0; event.type != FW_EVENT_TIME_DROPPED && i < 3; ++i)  // moved since
            saved.position[i] =
                float(double(saved.position[i]) + save.snapshot.origin[i] - origin_[i]);
    }
}

void World::checkSnapshot(Snapshot& saved) {
    const FwWorldDef& rules = saved.rules;
    checkRule(rules.paceFactor, def_.paceFactor, "paceFactor");
    for (int i = 0; i < 3; ++i) checkRule(rules.up[i], def_.up[i], "up");
    checkRule(rules.spreadChance, def_.spreadChance, "spreadChance");
    checkRule(rules.timeToLive, def_.timeToLive, "timeToLive");
    checkRule(rules.seed, def_.seed, "seed");
    checkRule(rules.maxHops, def_.maxHops, "maxHops");
    checkRule(rules.maxBurningTiles, def_.maxBurningTiles, "maxBurningTiles");
    checkSlots(saved.objects, objects_, "burnable mesh", "burnable meshes");
    checkSlots(saved.blockers, blockers_, "blocker", "blockers");
    checkSlots(saved.windZones, windPool_, "wind zone", "wind zones");
    checkSlots(saved.rooms, rooms_, "room", "rooms");
    checkSlots(saved.fires, fires_, "volumetric fire", "volumetric fires");
    checkSlots(saved.emitters, emitters_, "fire emitter", "fire emitters");
    checkSlots(saved.fields, fields_, "particle field", "particle fields");
    SnapshotChecker check(*this);
    check(saved);
    for (const double metres : saved.origin)
        check.require(metres == std::floor(metres), "origin, which moves by whole metres,");
    if ((saved.flags & ~kWorldFlags) != 0)
        core::fail(FW_ERROR_BAD_DATA, "The save's flags are 0x%x; the known flags are 0x%x.",
                   saved.flags, kWorldFlags);
    for (const ObjectSnapshot& object : saved.objects) {
        const uint64_t mine = assetOf(**objects_.at(object.slot));
        if (object.asset != mine)
            core::fail(FW_ERROR_BAD_DATA,
                       "Burnable mesh %u is not the save's: mesh, materials and def hash to "
                       "0x%016llX, the save's to 0x%016llX.",
                       object.slot + 1, static_cast<unsigned long long>(mine),
                       static_cast<unsigned long long>(object.asset));
    }
    checkLimit(saved.pending.size(), kMaxPending, "events that wait");
    for (const PendingTexel& event : saved.pending) {
        if (event.texel == kAllTexels && event.kind <= gpu::kEventExtinguish)
            check.object("an event", event.object);
        else
            check.texel("an event", event.object, event.texel);
        if (gpu::eventKind(event.kind) == gpu::kEventCarry)
            checkCarry(event, saved.clock);
        else
            check.range("kind of an event", event.kind, 0, gpu::kEventHeat);
    }
    checkLimit(saved.tags.size(), kMaxTags, "tags");
    checkLimit(saved.events.size(), kMostSavedEvents, "events");
    checkLimit(saved.latchedBlockers.size(), gpu::kMaxBlockers, "latched blockers");
    uint64_t before = 0;
    for (const Seen& seen : saved.seen) {
        const uint64_t pair = (uint64_t(seen.slots[0]) << 32 | seen.slots[1]) + 1;
        check.require(pair > before, "order of lines of sight");
        before = pair;
    }
    check.require(components::plausible(saved.gusts, saved.clock.tick), "state of gusts");
    for (const components::ShieldCell& cell : saved.heatShield.baked)
        check.texel("a cell of the shield", cell.what & gpu::kShieldSlot, cell.texel);
    for (const Slotted<FireSnapshot>& fire : saved.fires)
        checkSame(((*fires_.at(fire.slot))->data.flags & FW_FIRE_IGNITES) == fire.flags,
                  "volumetric fire", fire.slot);
    for (const Slotted<EmitterSnapshot>& emitter : saved.emitters) {
        const components::FireEmitter& mine = *emitters_.at(emitter.slot);
        bool same = (mine.def.flags & kEmitterKind) == emitter.flags &&
                    bool(mine.stream) == bool(emitter.stream);
        if (emitter.stream)
            for (const components::JetParcel& parcel : emitter.stream->parcels)
                same &=
                    parcel.launched == components::kJetNever || parcel.launched <= saved.clock.tick;
        checkSame(same, "fire emitter", emitter.slot);
    }
    for (const Slotted<FieldSnapshot>& field : saved.fields) {
        const Field& mine = **fields_.at(field.slot);
        checkSame(bool(mine.cells) == bool(field.cells) && mine.data.def.width == field.width &&
                      mine.data.def.height == field.height && field.began <= saved.clock.tick &&
                      (!field.cells ||
                       (field.cells->width == field.width && field.cells->height == field.height)),
                  "particle field", field.slot);
    }
}

BurnRecords World::recordsOf(const Snapshot& saved, const ObjectSnapshot& from,
                             components::Latch& latch) {
    const Object& object = **objects_.at(from.slot);
    const mesh::BurnDomain& domain = domainOf(object);
    components::DriveInput drive = driveInput(object, clock_.tick);
    drive.wind =
        windOf({fire::windUnits(saved.wind), saved.windGrid, saved.gusts, saved.zones, def_.seed},
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
    if (made.heated) made.heat = components::makeHeatMaterials(posed, domain, def_.paceFactor);
    uint32_t window = made.records.timing.window;
    for (const gpu::BurnMaterial& material : made.records.materials)
        window = std::max(window, material.windowMax);
    made.window = std::min(window, 1u << 24) + 2 * gpu::kStepTicks;
    return made;
}

void World::load(std::span<const std::byte> bytes) {
    mayChange();
    Snapshot saved(memory_);
    readSnapshot(bytes, saved);
    checkSnapshot(saved);
    settlePlays(saved);
    // The latches come first: the backend's records follow from them.
    std::pmr::vector<components::Latch> latches(memory_);
    std::pmr::vector<ImageStore> stores(memory_);
    std::pmr::vector<gpu::RestoredObject> restored(memory_);
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
        ImageStore& store = stores.emplace_back(memory_);
        readImage(from.planes, domainOf(**objects_.at(from.slot)), uint32_t(saved.clock.tick),
                  made.window, made.heatSpan(), store);
        if (from.findsBreaks && (*objects_.at(from.slot))->breaks) {
            const mesh::BurnDomain& domain = domainOf(**objects_.at(from.slot));
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
    remote_.pairs.reserve(saved.pairs.size());
    remote_.loadedSeen.reserve(saved.seen.size());
    touched_.reserve(objects_.slotCount());
    playing_.reserve(objects_.slotCount());
    remote_.due.reserve(objects_.slotCount());
    remote_.blockers.reserve(saved.latchedBlockers.size());
    uint32_t flames = 0;
    for (const Slotted<FireSnapshot>& from : saved.fires)
        flames += components::mostParts(from.power, (*fires_.at(from.slot))->data.diameter);
    findFireRoom(flames);
    places_.reserveMoves(objects_.live());
    backend_.restore(restored, uint32_t(saved.clock.tick));

    // From here on nothing fails.
    double by[3];  // the origin's move, for everything that no save has
    for (int i = 0; i < 3; ++i) by[i] = saved.origin[i] - origin_[i];
    shiftBy(by);
    shiftCount_ = 0;
    loadedFront_ = saved.stats.frontTiles;
    loadedHot_ = saved.stats.hotTiles;
    for (const ImageStore& store : stores)
        for (const gpu::TileState& tile : store.tiles) {
            loadedFront_ -= (tile.flag & gpu::kTileListed) != 0 && loadedFront_ > 0 ? 1u : 0u;
            loadedHot_ -= (tile.flag & gpu::kTileHot) != 0 && loadedHot_ > 0 ? 1u : 0u;
        }
    windGrid_.shape = saved.windGrid.shape;
    windGrid_.points.swap(saved.windGrid.points);
    shield_.grid.shape = saved.heatShield.shape;
    shield_.grid.solid.swap(saved.heatShield.solid);
    shield_.grid.baked.swap(saved.heatShield.baked);
    shield_.told.clear();
    shield_.unsent = shield_.unpacked = true;
    apply(saved, latches);
    size_t next = 0;
    for (const ObjectSnapshot& from : saved.objects) {
        if (!from.touched) continue;
        const ImageStore& store = stores[next++];
        if (Object& object = **objects_.at(from.slot); object.breaks)
            restoreBreaks(object, from.findsBreaks ? &from.breaks : nullptr, store,
                          uint32_t(clock_.tick));
    }
    tags_.swap(saved.tags);
    pending_.swap(saved.pending);
    settlePending();
    for (Slotted<FieldSnapshot>& field : saved.fields)
        if (field.cells)
            static_cast<field::FieldCells&>(*(*fields_.at(field.slot))->cells) =
                std::move(*field.cells);
}

void World::apply(const Snapshot& saved, std::span<const components::Latch> latches) noexcept {
    clock_ = saved.clock;
    steps_ = saved.steps;
    droppedSteps_ = saved.droppedSteps;
    order_ = saved.order;
    std::copy_n(saved.wind, 3, wind_);
    gusts_ = saved.gusts;
    for (const auto& zone : saved.windZones) *windPool_.at(zone.slot) = zone;
    listWindZones();
    windKept_ = true;  // objects find theirs below, one by one
    windTurns();
    gustsShown_ = saved.gustsShown;
    roomsMet_ = !saved.rooms.empty();
    for (const Slotted<RoomEntry>& from : saved.rooms) {
        RoomEntry& entry = *rooms_.at(from.slot);
        entry.room = from.room;
        fillRoom(entry, from.air.oxygen, from.air.power, from.air.flash);
        entry.air.drawn = from.air.drawn;
        entry.air.stirs = from.air.stirs;
        sendRoom(from.slot);
    }
    roomsStirred_ = seenRoomsStirred_ = saved.roomsStirred;
    remote_.flags = saved.flags & kWaysOfFire;
    remote_.objectFlags = saved.flags & ~kWaysOfFire;
    remote_.warms = saved.warms;
    remote_.fades = saved.fades;
    ++driveChanges_;
    ++geometry_;
    loadedFrame_ = lastFrame_;
    loadedTick_ = clock_.tick;
    for (core::Owned<Save>& save : saves_) {
        if (!save || !save->pending) continue;
        save->pending = false;  // of the world before the load
        save->requested = true;
    }
    if (timeline_) {
        const bool restarts = !timeline_->seeks;  // it begins here, or is in its own past
        if (restarts) timeline_->restart(clock_.tick);
        saves_[size_t(SaveFor::timeline)]->requested = restarts;
    }
    if (recording_) {
        recording_->loaded = true;
        recording_->captured = false;
        recording_->commands.clear();
        recording_->hashes.clear();
    }
    // Requests to earlier frames are made again.
    for (ProbeFrame& frame : probeFrames_) frame.frameIndex = 0;
    for (uint32_t i = 0; i < queries_.slotCount(); ++i)
        if (Query* query = queries_.at(i); query && !query->ready) query->asked = false;
    events_.clear();
    for (const FwEvent& event : saved.events)
        raise(event.type,
              event.object.index1 != 0 ? objects_.at(event.object.index1 - 1)->get() : nullptr,
              event.tag, lastFrame_, event.position, event.value, event.other);
    readbackTick_ = clock_.tick;
    // An awake world would filter the wind from here on, not from its first ignition.
    idle_ = seenIdle_ = saved.idle;
    lastStimulus_ = seenStimulus_ = saved.lastStimulus;
    stimuli_.clear();
    frameNotes_.clear();
    frontTiles_ = saved.stats.frontTiles;
    runTiles_ = 0;
    burningTiles_ = loadedBurning_ = saved.stats.burningTiles;
    hotTiles_ = saved.stats.hotTiles;
    receivers_ = loadedReceivers_ = saved.stats.receivers;
    lateClamps_ = saved.stats.lateClamps;
    remote_.unsent = true;
    remote_.blockersDue = saved.blockersDue;
    remote_.blockers.assign(saved.latchedBlockers.begin(), saved.latchedBlockers.end());
    remote_.rebuild = true;
    remote_.due.clear();
    for (const auto& blocker : saved.blockers) *blockers_.at(blocker.slot) = blocker;
    touched_.clear();
    playing_.clear();
    for (size_t i = 0; i < saved.objects.size(); ++i)
        applyObject(saved.objects[i], latches[i], **objects_.at(saved.objects[i].slot));
    showSavedLights();
    remote_.pairs.clear();
    for (PairContacts pair : saved.pairs) {
        for (int k = 0; k < 2; ++k) pair.ids[k] = objects_.idOf(pair.slots[k]);
        pair.versions[0] = pair.versions[1] = 0;  // its links are found again
        pair.stamp = 0;
        pair.touches = true;
        remote_.pairs.push_back(pair);
    }
    remote_.loadedSeen.assign(saved.seen.begin(), saved.seen.end());
    for (const Slotted<FireSnapshot>& from : saved.fires) {
        Fire& fire = **fires_.at(from.slot);
        if (!(from == fire.data)) {  // as if it had always burnt so
            burning_.drop(fire.data);
            fire.data.state = {};
            fire.data.points = from.points;
            fire.data.pointCount = from.pointCount;
            components::setFirePosition(fire.data, from.position);
            components::setFirePower(fire.data, from.power);
            foresee(fire.data);
        }
        for (size_t k = 0; k < from.touches.size(); ++k) {
            const bool seen = fire.touches[k].seen;
            fire.touches[k] = from.touches[k];
            fire.touches[k].seen = seen;
        }
    }
    emitterTime_ = double(clock_.tick) / double(gpu::kTicksPerSecond);
    for (const Slotted<EmitterSnapshot>& from : saved.emitters) {
        components::FireEmitter& emitter = emitters_.get(emitters_.idOf(from.slot));
        std::copy_n(from.position, 3, emitter.position);
        std::copy_n(from.direction, 3, emitter.direction);
        if (emitter.def.power != from.power) components::setEmitterPower(emitter, from.power);
        emitter.births = {};  // particles in flight belong to another time
        emitter.births.warms = true;
        emitter.lastShields = {};
        components::settleSparks(emitter, emitterTime_);
        emitter.swept = 0;
        emitter.touches = from.touches;
        if (!emitter.stream) continue;
        *emitter.stream = *from.stream;
        emitter.stream->before = emitter.stream->patches;
        for (components::JetParcel& parcel : emitter.stream->parcels)
            for (components::JetRay& ray : parcel.rays)
                ray.version = ray.version != 0 ? geometry_ : 0;
    }
    for (const Slotted<FieldSnapshot>& from : saved.fields) {
        Field& field = **fields_.at(from.slot);
        // The backend counts its own steps, and continues from them.
        const uint32_t ran = field.steps - field.shownBase;
        field.began = from.began;
        std::copy_n(from.position, 3, field.data.position);
        std::copy_n(from.rotation, 4, field.data.rotation);
        field.data.def.look.amount = from.amount;
        field.steps = components::fieldSteps(field.data, clock_.tick - field.began);
        field.shownBase = field.steps - ran;
    }
    sendFieldRules();
}

void World::applyObject(const ObjectSnapshot& from, const components::Latch& latch,
                        Object& object) noexcept {
    static_cast<ObjectState&>(object) = from;
    object.data.pose = from.pose;
    backend_.setObjectWind(object.slot, object.zoneWind);
    placeNow(object);
    object.restsUnder = 0;
    object.room1 = roomOf(object);
    roomsMet_ |= from.counters.air != 0;
    sendPose(object);
    object.latch = latch;
    if (object.play.burn1 != 0) startPlay(object);
    object.firstFrame = lastFrame_ + 1;
    ++object.changes;
    // Requests whose readback is lost are made again.
    const auto again = [&](bool& requested, bool& pending) {
        if (!pending) return;
        pending = false;
        if (!requested) ++mapsWished_;
        requested = true;
    };
    again(object.map.wished, object.map.pending);
    if (object.forecast) {
        again(object.forecast->wished, object.forecast->pending);
        object.forecast->told = false;
    }
    if (object.breaks) {  // it has not burnt, or is restored next
        object.breaks->lookCount = 0;
        object.breaks->shareTold = object.breaks->waits = false;
        std::fill(object.breaks->lost.begin(), object.breaks->lost.end(), false);
    }
    object.remote = {};
    object.remoteSent = false;
    object.remoteVersion = from.placed ? ++remote_.version : 0;
    if (from.remoteDue) remote_.due.push_back(object.slot);
    if (from.placed) {
        const mesh::BurnDomain& domain = domainOf(object);
        if (from.remoteDue) {
            object.remote = from.remote;
        } else {
            components::placeRemote(object.data.pose, domain, object.remote);
            components::fillRemote(object.data, domain, object.governance, object.remote);
            if (object.texels == 0) object.remote.flags &= ~gpu::kRemoteLive;
            object.remote.high.w = from.remote.high.w;
        }
        object.reach = components::remoteReach(object.data, domain,
                                               meshes_.at(object.data.meshSlot)->texelsOf);
    }
    object.carryEnd = 0;  // what the save carries is settled with its events
    object.stimuli = 0;
    object.ignites = false;
    if (!from.touched) {
        object.counters = {};
        return;
    }
    touched_.push_back(&object);
    if (object.story.ignitionKnown)
        backend_.startBoundary(object.slot, object.story.ignitionPoint,
                               uint32_t(object.story.firstIgnition));
}

}  // namespace fw::world
