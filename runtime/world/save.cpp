// Saving and loading a world mid-burn. What the world knows is noted at the frame that was asked
// for, the objects' planes come with its readback, and then it is bytes. Loading checks all of it
// before anything changes; the backend goes first, since it alone may still fail.
#include "world/save.h"

#include "components/sparks.h"
#include "core/hash.h"
#include "save/plane.h"
#include "shared/field_draw.h"
#include "shared/heat.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

namespace fw::world {
namespace {

using components::checkValue;
using components::checkValues;

constexpr uint64_t kNoEvents = ~uint64_t(0);

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

void checkPose(const components::Pose& pose, uint32_t object, double far = 1e6) {
    bool good = pose.scale >= 1e-4f && pose.scale <= 1e4f;
    for (const auto& row : pose.rotation)
        for (const float value : row) good &= std::abs(value) <= 1.01f;
    for (const float value : pose.stretch) {
        const float size = std::abs(value);
        good &= size >= 1.0f / 64 && size <= 64;
    }
    for (const double value : pose.translation) good &= std::abs(value) <= far;
    if (!good)
        core::fail(FW_ERROR_BAD_DATA,
                   "The save has a transform that none can be for burnable mesh %u.", object + 1);
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
void checkCount(size_t saved, size_t mine, const char* name) {
    if (saved != mine)
        core::fail(FW_ERROR_BAD_DATA, "The save has %zu %s; this world has %zu.", saved, name,
                   mine);
}

// With the next frame?
bool startsSave(const core::Owned<Save>& save) noexcept {
    return save && save->wished && !save->pending;
}

SavedTouch savedTouch(const FireTouch& touch) noexcept {
    SavedTouch saved;
    saved.object1 = touch.object.index1;
    saved.since = touch.since;
    std::copy_n(touch.fireAt, 3, saved.fireAt);
    std::copy_n(touch.objectAt, 3, saved.objectAt);
    saved.flag = touch.lit;
    return saved;
}

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

// Ticks beyond which nobody asks when a tile last changed.
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

// ---- saving ------------------------------------------------------------------------------------

uint32_t PersistenceSystem::unsavable() noexcept {
    for (uint32_t i = 0; i < world_.scene_.objects.slotCount(); ++i)
        if (auto* object = world_.scene_.objects.at(i);
            object && ((*object)->data.flags & FW_BURNABLE_PUBLISHED) && (*object)->touched)
            return i + 1;
    return 0;
}

void PersistenceSystem::requestSave(SaveFor who) {
    if (const uint32_t object1 = unsavable())
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "Burnable mesh %u has FW_BURNABLE_PUBLISHED; such fires cannot be saved.",
                   object1);
    core::Owned<Save>& save = saves_[size_t(who)];
    if (!save) save = core::Owned<Save>::make(world_.context_.memory, world_.context_.memory);
    save->wished = true;
    save->ready = false;
}

void PersistenceSystem::cancelSave() noexcept { saves_[size_t(SaveFor::host)] = {}; }

const std::pmr::vector<std::byte>* PersistenceSystem::fetchSave(SaveFor who) {
    const core::Owned<Save>& save = saves_[size_t(who)];
    if (!save || (!save->wished && !save->pending && !save->ready))
        core::fail(FW_ERROR_INVALID_ARGUMENT, "No save was asked for; request it first.");
    if (save->failed) {
        save->failed = false;
        throw std::bad_alloc();
    }
    return save->ready && !save->wished ? &save->bytes : nullptr;
}

// Before a frame's plan: the objects that have something to save.
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
        save.wished = save.ready = false;
        try {
            noteSaved(save.saved);
            save.pending = true;
            save.frameIndex = frameIndex;
            // A network's are for who was not there: they are of no past of theirs.
            save.eventsFrom =
                who == size_t(SaveFor::net) ? kNoEvents : world_.context_.events.next();
        } catch (...) {
            save.failed = true;
        }
        if (who == size_t(SaveFor::host)) noteSaveInLog();
        if (who == size_t(SaveFor::timeline) && timeline_) timeline_->captured = timeline_->done;
        if (who != size_t(SaveFor::net) || !journal_) continue;
        journal_->captured = true;
        journal_->capturedAt = world_.context_.clock.tick;
        journal_->capturedBehind = journal_->deeds.size();
    }
}

void PersistenceSystem::noteSaved(SavedWorld& to) {
    to.pace = world_.context_.def.paceFactor;
    std::copy_n(world_.context_.def.up, 3, to.up);
    to.spreadChance = world_.context_.def.spreadChance;
    to.timeToLive = world_.context_.def.timeToLive;
    to.seed = world_.context_.def.seed;
    to.maxHops = world_.context_.def.maxHops;
    to.maxBurningTiles = world_.context_.def.maxBurningTiles;
    to.clock = world_.context_.clock;
    to.droppedSteps = world_.burn_.state_.droppedSteps;
    to.order = world_.burn_.state_.order;
    std::copy_n(world_.wind_.state_.wind, 3, to.wind);
    to.windGrid.shape = world_.wind_.state_.grid.shape;
    to.windGrid.points.assign(world_.wind_.state_.grid.points.begin(),
                              world_.wind_.state_.grid.points.end());
    to.heatShield.shape = world_.exchange_.state_.shield.grid.shape;
    to.heatShield.solid.assign(world_.exchange_.state_.shield.grid.solid.begin(),
                               world_.exchange_.state_.shield.grid.solid.end());
    to.heatShield.baked.assign(world_.exchange_.state_.shield.grid.baked.begin(),
                               world_.exchange_.state_.shield.grid.baked.end());
    to.gusts = world_.wind_.state_.gusts;
    std::copy_n(world_.context_.origin.moved, 3, to.origin);
    to.flags = world_.exchange_.state_.book.flags | world_.exchange_.state_.book.objectFlags;
    to.warms = world_.exchange_.state_.book.warms;
    to.blockersDue = world_.exchange_.state_.book.blockersDue;
    to.fades = world_.exchange_.state_.book.fades;
    to.gustsShown = world_.wind_.state_.gustsShown;
    to.objects.clear();
    for (uint32_t i = 0; i < world_.scene_.objects.slotCount(); ++i)
        if (auto* owned = world_.scene_.objects.at(i))
            noteObject(**owned, to.objects.emplace_back());
    to.pending.assign(world_.burn_.state_.pending.begin(), world_.burn_.state_.pending.end());
    to.tags.clear();
    for (const Tag& tag : world_.queries_.state_.tags)
        to.tags.push_back({tag.object.index1 - 1, tag.texel, tag.tag});
    to.pairs.clear();
    for (const PairContacts& pair : world_.exchange_.state_.book.pairs)
        if (pair.touches) to.pairs.push_back({{pair.slots[0], pair.slots[1]}, pair.since});
    std::sort(to.pairs.begin(), to.pairs.end(), [](const SavedPair& a, const SavedPair& b) {
        return std::tie(a.slots[0], a.slots[1]) < std::tie(b.slots[0], b.slots[1]);
    });
    to.seen.clear();
    world_.exchange_.recordSeen(to.seen);
    to.blockers.clear();
    for (uint32_t i = 0; i < world_.exchange_.state_.blockers.slotCount(); ++i)
        if (const BlockerEntry* entry = world_.exchange_.state_.blockers.at(i)) {
            SavedBlocker& saved = to.blockers.emplace_back();
            saved.slot = i;
            saved.pose = entry->pose;
            std::copy_n(entry->halfSize, 3, saved.halfSize);
        }
    to.latchedBlockers.assign(world_.exchange_.state_.book.blockers.begin(),
                              world_.exchange_.state_.book.blockers.end());
    to.windZones.clear();
    for (uint32_t i = 0; i < world_.wind_.state_.zones.slotCount(); ++i)
        if (const components::WindZone* zone = world_.wind_.state_.zones.at(i))
            to.windZones.push_back({i, *zone});
    to.rooms.clear();
    for (uint32_t i = 0; i < world_.rooms_.state_.rooms.slotCount(); ++i)
        if (const RoomEntry* entry = world_.rooms_.state_.rooms.at(i))
            to.rooms.push_back({i, entry->room, entry->air.oxygen, entry->air.power,
                                entry->air.flash, entry->air.drawn, entry->air.stirs,
                                entry->air.epoch});
    to.fires.clear();
    for (uint32_t i = 0; i < world_.flames_.state_.fires.slotCount(); ++i)
        if (const auto* fire = world_.flames_.state_.fires.at(i)) {
            SavedFire& saved = to.fires.emplace_back();
            saved.slot = i;
            saved.flags = (*fire)->data.flags & FW_FIRE_IGNITES;
            std::copy_n((*fire)->data.position, 3, saved.position);
            saved.power = (*fire)->data.power;
            saved.pointCount = (*fire)->data.pointCount;
            saved.points = (*fire)->data.points;
            for (size_t k = 0; k < saved.touches.size(); ++k)
                saved.touches[k] = savedTouch((*fire)->touches[k]);
        }
    to.emitters.clear();
    for (uint32_t i = 0; i < world_.emitters_.state_.emitters.slotCount(); ++i)
        if (const auto* emitter = world_.emitters_.state_.emitters.at(i))
            noteEmitter(i, *emitter, to.emitters);
    to.fields.clear();
    for (uint32_t i = 0; i < world_.fields_.state_.fields.slotCount(); ++i)
        if (const auto* field = world_.fields_.state_.fields.at(i)) {
            SavedField& saved = to.fields.emplace_back();
            saved.slot = i;
            saved.width = (*field)->data.def.width;
            saved.height = (*field)->data.def.height;
            saved.began = (*field)->began;
            std::copy_n((*field)->data.position, 3, saved.position);
            std::copy_n((*field)->data.rotation, 4, saved.rotation);
            saved.amount = (*field)->data.def.look.amount;
            saved.wets = bool((*field)->cells);
            if (!saved.wets) continue;
            const field::Field& cells = *(*field)->cells;
            saved.step = cells.step;
            saved.emitted = cells.emitted;
            saved.died = cells.died;
            saved.left = cells.left;
            saved.cells.assign(cells.cells.begin(), cells.cells.end());
        }
}

void PersistenceSystem::noteObject(Object& object, SavedObject& saved) noexcept {
    saved = {};
    saved.slot = object.slot;
    saved.asset = assetOf(object);
    saved.pose = object.data.pose;
    saved.firstEvent = object.firstEvent;
    saved.play = object.play;
    if (object.play.burn1 != 0)
        saved.burnHash = (*world_.burn_.state_.burns.at(object.play.burn1 - 1))->hash;
    saved.zoneWind = object.zoneWind;
    saved.placed = object.remoteVersion != 0;
    saved.due = object.remoteDue;
    saved.remote = object.remote;
    saved.remote.neighbourFirst = saved.remote.neighbourCount = 0;
    saved.touched = object.touched;
    if (!object.touched) return;
    saved.filters = object.latch.filters;
    saved.latched = object.latch.pose;
}

void PersistenceSystem::noteEmitter(uint32_t slot, const components::FireEmitter& emitter,
                                    std::pmr::vector<SavedEmitter>& to) const {
    SavedEmitter& saved = to.emplace_back();
    saved.slot = slot;
    saved.flags = emitter.def.flags & (FW_EMITTER_JET | FW_EMITTER_IGNITES);
    std::copy_n(emitter.position, 3, saved.position);
    std::copy_n(emitter.direction, 3, saved.direction);
    saved.power = emitter.def.power;
    for (size_t k = 0; k < saved.touches.size(); ++k) {
        saved.touches[k].object1 = emitter.touches[k].object.index1;
        saved.touches[k].since = emitter.touches[k].since;
        saved.touches[k].flag = emitter.touches[k].seen;
    }
    saved.streams = bool(emitter.stream);
    if (!saved.streams) return;
    saved.kept = emitter.stream->kept;
    saved.patchedAt = emitter.stream->patchedAt;
    saved.patches = emitter.stream->patches;
    for (uint32_t place = 0; place < components::kJetParcels; ++place) {
        const components::JetParcel& parcel = emitter.stream->parcels[place];
        if (parcel.launched == components::kJetNever) continue;
        saved.places.push_back(place);
        saved.parcels.push_back(parcel);
        for (components::JetRay& ray : saved.parcels.back().rays) {
            const bool swept = ray.version == world_.scene_.geometryVersion;
            saved.swept.push_back(swept ? 1 : 0);
            if (!swept) ray.hit = {};  // it is sought anew, and may be of what is gone
        }
    }
}

// With a readback, after the counters were taken.
void PersistenceSystem::takeSaves(const gpu::Readback& readback) noexcept {
    for (core::Owned<Save>& save : saves_) {
        if (!save || !save->pending || readback.frameIndex < save->frameIndex) continue;
        save->pending = false;
        try {
            takeSave(*save, readback);
        } catch (...) {
            save->failed = true;
        }
    }
    keepMoment();
}

void PersistenceSystem::takeSave(Save& save, const gpu::Readback& readback) {
    SavedWorld& saved = save.saved;
    size_t touched = 0;
    bool whole = readback.frameIndex == save.frameIndex;
    for (const SavedObject& object : saved.objects) {
        touched += object.touched ? 1 : 0;
        const auto* now = object.slot < world_.scene_.objects.slotCount()
                              ? world_.scene_.objects.at(object.slot)
                              : nullptr;
        whole = whole && now && (*now)->firstFrame <= save.frameIndex;
    }
    // What came is of less than was noted: objects went since. The next frame tries again.
    if (!whole || touched != readback.images.size()) {
        save.wished = true;
        return;
    }
    save.planes.clear();
    struct Ends {
        size_t image = 0, all = 0;
        SavedBreaks breaks;
    };
    std::pmr::vector<Ends> ends(world_.context_.memory);
    for (const gpu::ObjectImage& image : readback.images) {
        const Object& object = **world_.scene_.objects.at(image.object);
        writeImage(image, world_.scene_.domainOf(object), readback.endTick, windowOf(object),
                   save.scratch, save.planes);
        Ends& end = ends.emplace_back();
        end.image = save.planes.size();
        if (object.breaks) world_.burn_.noteBreaks(object, end.breaks, save.scratch, save.planes);
        end.all = save.planes.size();
    }
    noteEvents(save);
    size_t next = 0, from = 0;
    for (SavedObject& object : saved.objects) {
        if (!object.touched) {
            if (object.slot < readback.objects.size())
                object.air = readback.objects[object.slot].air;
            continue;
        }
        const gpu::ObjectImage& image = readback.images[next];
        if (image.object != object.slot) {
            save.wished = true;
            return;
        }
        const Ends& end = ends[next++];
        object.planes = std::span(save.planes).subspan(from, end.image - from);
        object.asksBreaks = bool((*world_.scene_.objects.at(object.slot))->breaks);
        object.breaks = end.breaks;
        object.breaks.lost = std::span(save.planes).subspan(end.image, end.all - end.image);
        from = end.all;
        object.carried = (*world_.scene_.objects.at(object.slot))->carried;
        object.story = (*world_.scene_.objects.at(object.slot))->story;
        object.counters = image.counters;
        object.counters.refined = 0;
        // Of what the backend alone knew at that frame.
        if (object.play.began != 0 &&
            !gpu::playsAt(image.counters.playsUntil, uint32_t(saved.clock.tick)))
            object.play = {};
    }
    for (SavedRoom& room : saved.rooms)  // its air goes on from what the frame left
        if (room.slot < readback.rooms.size() && readback.rooms[room.slot].epoch == room.epoch) {
            const gpu::RoomAir& air = readback.rooms[room.slot];
            room.oxygen = air.oxygen;
            room.power = air.power;
            room.flash = air.flash;
            room.drawn = air.drawn;
            room.stirs = air.stirs;
        }
    saved.steps = world_.burn_.state_.steps;
    saved.idle = world_.burn_.state_.seenIdle;
    saved.lastStimulus = world_.burn_.state_.seenStimulus;
    saved.roomsStirred = world_.rooms_.state_.seenStirred;
    saved.stats = {world_.burn_.state_.counts.front, world_.burn_.state_.counts.burning,
                   world_.burn_.state_.counts.hot, world_.burn_.state_.counts.receivers,
                   world_.burn_.state_.counts.lateClamps};
    writeSaved(saved, save.bytes);
    save.ready = true;
}

// A tag that the readback of a frame says is reached: its event is in the save, it is not.
void PersistenceSystem::forgetTag(Save& save, const Tag& tag, uint64_t frameIndex) noexcept {
    if (frameIndex > save.frameIndex) return;
    std::pmr::vector<SavedTag>& tags = save.saved.tags;
    const auto same = std::find_if(tags.begin(), tags.end(), [&](const SavedTag& one) {
        return one.object == tag.object.index1 - 1 && one.texel == tag.texel && one.tag == tag.tag;
    });
    if (same != tags.end()) tags.erase(same);
}

// What the host had not polled at the save's frame, and what came of that frame since.
void PersistenceSystem::noteEvents(Save& save) {
    std::pmr::vector<SavedEvent>& to = save.saved.events;
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
    std::sort(found.begin(), found.end());  // readbacks of a device are behind what is at hand
    for (size_t k = found.size() - std::min<size_t>(found.size(), kMostSavedEvents);
         k < found.size(); ++k) {
        const FwEvent& event = world_.context_.events.at(found[k].second);
        SavedEvent& saved = to.emplace_back();
        saved.type = event.type;
        saved.tag = event.tag;
        saved.object1 = event.object.index1;
        saved.other1 = world_.scene_.objects.find(event.other) ? event.other.index1 : 0;
        std::copy_n(event.position, 3, saved.position);
        for (int i = 0; event.type != FW_EVENT_TIME_DROPPED && i < 3; ++i)  // moved since
            saved.position[i] = float(double(saved.position[i]) + save.saved.origin[i] -
                                      world_.context_.origin.moved[i]);
        saved.value = event.value;
    }
}

// ---- loading -----------------------------------------------------------------------------------

void PersistenceSystem::checkSaved(const SavedWorld& saved) {
    checkRule(saved.pace, world_.context_.def.paceFactor, "paceFactor");
    for (int i = 0; i < 3; ++i) checkRule(saved.up[i], world_.context_.def.up[i], "up");
    checkRule(saved.spreadChance, world_.context_.def.spreadChance, "spreadChance");
    checkRule(saved.timeToLive, world_.context_.def.timeToLive, "timeToLive");
    checkRule(saved.seed, world_.context_.def.seed, "seed");
    checkRule(saved.maxHops, world_.context_.def.maxHops, "maxHops");
    checkRule(saved.maxBurningTiles, world_.context_.def.maxBurningTiles, "maxBurningTiles");
    const Clock& clock = saved.clock;
    if (clock.tick > Clock::kLastTick || clock.tick % gpu::kStepTicks != 0 ||
        clock.fraction >= Clock::kStepUnits)
        core::fail(FW_ERROR_BAD_DATA, "The save is of tick %llu, which no world has.",
                   static_cast<unsigned long long>(clock.tick));
    for (const float value : saved.wind)
        if (!(std::abs(value) <= fire::kMostWind))
            core::fail(FW_ERROR_BAD_DATA, "The save's wind is %g m/s; the limits are [%g, %g].",
                       double(value), double(-fire::kMostWind), double(fire::kMostWind));
    for (const double metres : saved.origin)
        if (!(std::abs(metres) <= 1e9) || metres != std::floor(metres))
            core::fail(FW_ERROR_BAD_DATA,
                       "The save's origin has moved by %g m; it moves by whole "
                       "metres, to +-1e9 m.",
                       metres);
    if ((saved.flags & ~kWorldFlags) != 0)
        core::fail(FW_ERROR_BAD_DATA, "The save's flags are 0x%x; the known flags are 0x%x.",
                   saved.flags, kWorldFlags);
    checkCount(saved.objects.size(), world_.scene_.objects.live(), "burnable meshes");
    checkCount(saved.blockers.size(), world_.exchange_.state_.blockers.live(), "blockers");
    checkCount(saved.windZones.size(), world_.wind_.state_.zones.live(), "wind zones");
    checkCount(saved.rooms.size(), world_.rooms_.state_.rooms.live(), "rooms");
    checkCount(saved.fires.size(), world_.flames_.state_.fires.live(), "volumetric fires");
    checkCount(saved.emitters.size(), world_.emitters_.state_.emitters.live(), "fire emitters");
    checkCount(saved.fields.size(), world_.fields_.state_.fields.live(), "particle fields");
    uint32_t next = 0;
    for (const SavedObject& object : saved.objects) {
        if (object.slot < next || object.slot >= world_.scene_.objects.slotCount() ||
            !world_.scene_.objects.at(object.slot))
            core::fail(FW_ERROR_BAD_DATA,
                       "The save has burnable mesh %u, which this world does not. Create what it "
                       "was made with in the same order.",
                       object.slot + 1);
        next = object.slot + 1;
        const uint64_t mine = assetOf(**world_.scene_.objects.at(object.slot));
        if (object.asset != mine)
            core::fail(FW_ERROR_BAD_DATA,
                       "Burnable mesh %u is not the save's: mesh, materials and def hash to "
                       "0x%016llX, the save's to 0x%016llX.",
                       object.slot + 1, static_cast<unsigned long long>(mine),
                       static_cast<unsigned long long>(object.asset));
        checkPose(object.pose, object.slot);
        if (object.touched) checkPose(object.latched, object.slot, kFarPast);
        for (const fire::WindFilter& filter : object.filters)
            for (int i = 0; i < 3; ++i)
                if (std::abs(int64_t(filter.latched[size_t(i)])) > fire::kMostWindUnits ||
                    std::abs(double(filter.value[size_t(i)])) >
                        double(fire::kMostWindUnits) * 16777216 + 1)
                    core::fail(FW_ERROR_BAD_DATA, "The save's wind at burnable mesh %u is absurd.",
                               object.slot + 1);
    }
    const auto checkObject = [&](uint32_t slot, const char* what) {
        if (slot >= world_.scene_.objects.slotCount() || !world_.scene_.objects.at(slot))
            core::fail(FW_ERROR_BAD_DATA,
                       "The save has %s of burnable mesh %u, which is not there.", what, slot + 1);
    };
    const auto checkTexel = [&](uint32_t slot, uint32_t texel, const char* what) {
        checkObject(slot, what);
        const mesh::BurnDomain& domain = world_.scene_.domainOf(**world_.scene_.objects.at(slot));
        if (texel >= domain.texelCount() || !domain.real(texel))
            core::fail(FW_ERROR_BAD_DATA,
                       "The save has %s at texel %u of burnable mesh %u, which is not there.", what,
                       texel, slot + 1);
    };
    if (saved.pending.size() > BurnSystem::kMaxPending)
        core::fail(FW_ERROR_BAD_DATA, "The save has %zu events that wait; the limit is %zu.",
                   saved.pending.size(), BurnSystem::kMaxPending);
    for (const PendingTexel& event : saved.pending) {
        if (event.texel == kAllTexels && event.kind <= gpu::kEventExtinguish)
            checkObject(event.object, "an event");
        else
            checkTexel(event.object, event.texel, "an event");
        if (gpu::eventKind(event.kind) == gpu::kEventCarry)
            world_.burn_.checkCarry(event, clock);
        else if (event.kind > gpu::kEventHeat)
            core::fail(FW_ERROR_BAD_DATA, "The save has an event of kind %u; the limit is %u.",
                       event.kind, gpu::kEventHeat);
        for (uint32_t g = 0; g < event.gateCount; ++g)
            checkTexel(event.gates[g].object, event.gates[g].texel, "a hole");
    }
    if (saved.tags.size() > QuerySystem::kMaxTags)
        core::fail(FW_ERROR_BAD_DATA, "The save has %zu tags; the limit is %u.", saved.tags.size(),
                   QuerySystem::kMaxTags);
    for (const SavedTag& tag : saved.tags) checkTexel(tag.object, tag.texel, "a tag");
    for (const SavedPair& pair : saved.pairs) {
        checkObject(pair.slots[0], "a contact");
        checkObject(pair.slots[1], "a contact");
    }
    uint64_t before = 0;
    for (const Seen& seen : saved.seen) {
        checkObject(seen.slots[0], "what is seen");
        checkObject(seen.slots[1], "what is seen");
        const uint64_t pair = (uint64_t(seen.slots[0]) << 32 | seen.slots[1]) + 1;
        if (pair <= before || seen.part > 255)
            core::fail(FW_ERROR_BAD_DATA, "The save has sights of objects that none can be.");
        before = pair;
    }
    if (saved.events.size() > kMostSavedEvents)
        core::fail(FW_ERROR_BAD_DATA, "The save has %zu events; the limit is %u.",
                   saved.events.size(), kMostSavedEvents);
    for (const SavedEvent& event : saved.events) {
        if (event.type < FW_EVENT_IGNITED || event.type > FW_EVENT_STRUCTURE_BROKE)
            core::fail(FW_ERROR_BAD_DATA,
                       "The save has an event of type %u; the limits are [1, %u].", event.type,
                       uint32_t(FW_EVENT_STRUCTURE_BROKE));
        if (event.object1 != 0) checkObject(event.object1 - 1, "an event");
        if (event.other1 != 0) checkObject(event.other1 - 1, "an event");
        for (const float value : event.position)
            if (!std::isfinite(value) || !std::isfinite(event.value))
                core::fail(FW_ERROR_BAD_DATA, "The save has an event at %g m of value %g.",
                           double(value), double(event.value));
    }
    for (const SavedBlocker& blocker : saved.blockers) {
        if (blocker.slot >= world_.exchange_.state_.blockers.slotCount() ||
            !world_.exchange_.state_.blockers.at(blocker.slot))
            core::fail(FW_ERROR_BAD_DATA, "The save has blocker %u, which this world does not.",
                       blocker.slot + 1);
        checkPose(blocker.pose, blocker.slot);
        for (const float half : blocker.halfSize)
            if (!(half >= 0 && half <= 30))
                core::fail(FW_ERROR_BAD_DATA,
                           "The save has a blocker of half size %g m; the limits are [0, 30].",
                           double(half));
    }
    if (saved.latchedBlockers.size() > gpu::kMaxBlockers)
        core::fail(FW_ERROR_BAD_DATA, "The save has %zu latched blockers; the limit is %u.",
                   saved.latchedBlockers.size(), gpu::kMaxBlockers);
    if (!components::plausible(saved.windGrid.shape) ||
        saved.windGrid.shape.points() != saved.windGrid.points.size() ||
        !components::plausible(saved.gusts, clock.tick))
        core::fail(FW_ERROR_BAD_DATA, "The save has a grid of wind or gusts that none can be.");
    for (const components::ShieldCell& cell : saved.heatShield.baked)
        checkTexel(cell.what & gpu::kShieldSlot, cell.texel, "a cell of the shield");
    for (const SavedWindZone& zone : saved.windZones)
        if (zone.slot >= world_.wind_.state_.zones.slotCount() ||
            !world_.wind_.state_.zones.at(zone.slot) || !components::plausible(zone.zone))
            core::fail(FW_ERROR_BAD_DATA,
                       "The save has wind zone %u, which is not here or is absurd.", zone.slot + 1);
    for (const SavedRoom& room : saved.rooms)
        if (room.slot >= world_.rooms_.state_.rooms.slotCount() ||
            !world_.rooms_.state_.rooms.at(room.slot) || !components::plausible(room.room) ||
            room.power > gpu::kFlashMost * (gpu::kRoomMeans - 1))
            core::fail(FW_ERROR_BAD_DATA, "The save has room %u, which is not here or is absurd.",
                       room.slot + 1);
    const auto checkTouches = [&](const std::array<SavedTouch, 8>& touches) {
        for (const SavedTouch& touch : touches)
            if (touch.object1 != 0) checkObject(touch.object1 - 1, "a flame");
    };
    const auto checkPlace = [](const float(&place)[3], const char* what, float most = 1e6f) {
        for (const float value : place)
            if (!(std::abs(value) <= most))
                core::fail(FW_ERROR_BAD_DATA, "The save has %s at %g m; the limits are +-%g.", what,
                           double(value), double(most));
    };
    constexpr float kReached = 4e6f;  // m: a jet, or a mesh, reaches beyond where it stands
    for (const SavedFire& fire : saved.fires) {
        const auto* mine = fire.slot < world_.flames_.state_.fires.slotCount()
                               ? world_.flames_.state_.fires.at(fire.slot)
                               : nullptr;
        if (!mine || ((*mine)->data.flags & FW_FIRE_IGNITES) != fire.flags)
            core::fail(FW_ERROR_BAD_DATA,
                       "The save has volumetric fire %u, which is none or another one here.",
                       fire.slot + 1);
        checkPlace(fire.position, "a volumetric fire");
        if (!(fire.power >= 0 && fire.power <= components::kMostPower))
            core::fail(FW_ERROR_BAD_DATA,
                       "The save has a volumetric fire of %g kW; the limits are [0, %g].",
                       double(fire.power), double(components::kMostPower));
        for (uint32_t i = 0; i < fire.pointCount; ++i) {
            const volume::ControlPoint& point = fire.points[i];
            checkPlace({point.position.x, point.position.y, point.position.z}, "a fire's point");
            if (!(point.radius >= 0 && point.radius <= 100))
                core::fail(FW_ERROR_BAD_DATA,
                           "The save has a fire's point of radius %g m; the limits are [0, 100].",
                           double(point.radius));
        }
        checkTouches(fire.touches);
    }
    for (const SavedEmitter& emitter : saved.emitters) {
        const auto* mine = emitter.slot < world_.emitters_.state_.emitters.slotCount()
                               ? world_.emitters_.state_.emitters.at(emitter.slot)
                               : nullptr;
        constexpr uint32_t kKind = FW_EMITTER_JET | FW_EMITTER_IGNITES;
        if (!mine || (mine->def.flags & kKind) != emitter.flags ||
            bool(mine->stream) != emitter.streams)
            core::fail(FW_ERROR_BAD_DATA,
                       "The save has fire emitter %u, which is none or another one here.",
                       emitter.slot + 1);
        checkPlace(emitter.position, "a fire emitter");
        checkPlace(emitter.direction, "a direction");
        if (!(emitter.power >= 0 && emitter.power <= 100000))
            core::fail(FW_ERROR_BAD_DATA,
                       "The save has an emitter of %g kW; the limits are [0, 100000].",
                       double(emitter.power));
        checkTouches(emitter.touches);
        for (const components::JetPatch& patch : emitter.patches) {
            if (patch.left == 0) continue;
            checkPlace(patch.place, "fuel that sticks", kReached);
            checkPlace(patch.normal, "fuel that sticks");
            if (patch.fuel > components::kPatchMost || patch.water > components::kPatchMost)
                core::fail(FW_ERROR_BAD_DATA, "The save has fuel that sticks and is too much.");
            if (patch.object.index1 != 0)
                checkTexel(patch.object.index1 - 1, patch.texel, "fuel that sticks");
        }
        for (const components::JetParcel& parcel : emitter.parcels) {
            checkPlace(parcel.from, "a jet's stream", float(kFarPast));
            if (!(parcel.wide >= 0 && parcel.wide <= 4) || parcel.most > 10000000 ||
                parcel.launched > clock.tick)
                core::fail(FW_ERROR_BAD_DATA, "The save has a jet's stream that none can be.");
            for (const components::JetRay& ray : parcel.rays) {
                checkPlace(ray.way, "a ray");
                checkPlace(ray.hit.place, "a ray", kReached);
                checkPlace(ray.hit.normal, "a ray");
                if (!(std::abs(ray.hit.distance) <= 1e6f))
                    core::fail(FW_ERROR_BAD_DATA, "The save has a ray that none can be.");
                if (ray.hit.object.index1 != 0)
                    checkTexel(ray.hit.object.index1 - 1, ray.hit.texel, "a ray");
                for (uint32_t g = 0; g < ray.gateCount; ++g)
                    checkTexel(ray.gates[g].object, ray.gates[g].texel, "a hole");
            }
        }
    }
    for (const SavedField& field : saved.fields) {
        const auto* mine = field.slot < world_.fields_.state_.fields.slotCount()
                               ? world_.fields_.state_.fields.at(field.slot)
                               : nullptr;
        if (!mine || bool((*mine)->cells) != field.wets || (*mine)->data.def.width != field.width ||
            (*mine)->data.def.height != field.height || field.began > clock.tick)
            core::fail(FW_ERROR_BAD_DATA,
                       "The save has particle field %u, which is none or another one here.",
                       field.slot + 1);
        checkPlace(field.position, "a particle field");
        float length = 0;
        for (const float value : field.rotation) length += value * value;
        if (!(std::abs(length - 1) <= 0.01f) || !(field.amount >= 0 && field.amount <= 4))
            core::fail(FW_ERROR_BAD_DATA,
                       "The save has particle field %u with amount %g and a rotation of length %g.",
                       field.slot + 1, double(field.amount), double(length));
    }
}

SavedRecords PersistenceSystem::recordsOf(const SavedWorld& saved, const SavedObject& from,
                                          components::Latch& latch) {
    const Object& object = **world_.scene_.objects.at(from.slot);
    const mesh::BurnDomain& domain = world_.scene_.domainOf(object);
    components::DriveInput drive = world_.wind_.driveInput(object, world_.context_.clock.tick);
    drive.wind =
        windOf({fire::windUnits(saved.wind), saved.windGrid, saved.gusts, saved.zones, saved.seed},
               windPlaceOf(from.pose, domain), saved.clock.tick);
    components::BurnableMesh posed = object.data;
    posed.pose = from.pose;
    components::resetLatch(posed, drive, latch);
    SavedRecords made;
    // What has not burnt yet: the backend may have records of another wind, of this world's past.
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
    SavedWorld saved(world_.context_.memory);
    readSaved(bytes, saved);
    checkSaved(saved);
    world_.burn_.settlePlays(saved);
    // The latches first: what the backend gets follows from them.
    std::pmr::vector<components::Latch> latches(world_.context_.memory);
    std::pmr::vector<ImageStore> stores(world_.context_.memory);
    std::pmr::vector<gpu::RestoredObject> restored(world_.context_.memory);
    latches.reserve(saved.objects.size());
    stores.reserve(saved.objects.size());
    restored.reserve(saved.objects.size());
    PlaneScratch scratch(world_.context_.memory);
    for (const SavedObject& from : saved.objects) {
        const SavedRecords made = recordsOf(saved, from, latches.emplace_back());
        if (!from.touched && from.air != 0) {
            gpu::RestoredObject& one = restored.emplace_back();
            one.image.object = from.slot;
            one.image.counters.air = from.air;
            one.rests = true;
        }
        if (!from.touched) continue;
        ImageStore& store = stores.emplace_back(world_.context_.memory);
        readImage(from.planes, world_.scene_.domainOf(**world_.scene_.objects.at(from.slot)),
                  uint32_t(saved.clock.tick), made.window, made.heatSpan(), scratch, store);
        if (from.asksBreaks && (*world_.scene_.objects.at(from.slot))->breaks) {
            const mesh::BurnDomain& domain =
                world_.scene_.domainOf(**world_.scene_.objects.at(from.slot));
            store.lost.resize(domain.texelCount());
            if (!save::readPlane(from.breaks.lost, domain.width, {}, store.lost))
                core::fail(FW_ERROR_BAD_DATA,
                           "The save's plane of what broke of burnable mesh %u is damaged.",
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
    std::pmr::vector<Tag> tags(world_.context_.memory);
    for (const SavedTag& tag : saved.tags)
        tags.push_back({world_.scene_.objects.idOf(tag.object), tag.texel, tag.tag});
    world_.scene_.touched.reserve(world_.scene_.objects.slotCount());
    world_.scene_.playing.reserve(world_.scene_.objects.slotCount());
    world_.exchange_.state_.book.due.reserve(world_.scene_.objects.slotCount());
    world_.exchange_.state_.book.blockers.reserve(saved.latchedBlockers.size());
    uint32_t flames = 0;
    for (const SavedFire& from : saved.fires)
        flames += components::mostParts(
            from.power, (*world_.flames_.state_.fires.at(from.slot))->data.diameter);
    world_.flames_.reserve(flames);
    world_.scene_.places.reserveMoves(world_.scene_.objects.live());
    world_.context_.backend.restore(restored, uint32_t(saved.clock.tick));

    // From here on nothing fails.
    double by[3];  // what is in no save goes along
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
    world_.exchange_.state_.shield.grid.shape = saved.heatShield.shape;
    world_.exchange_.state_.shield.grid.solid.swap(saved.heatShield.solid);
    world_.exchange_.state_.shield.grid.baked.swap(saved.heatShield.baked);
    world_.exchange_.state_.shield.commandSlots.clear();
    world_.exchange_.state_.shield.unsent = world_.exchange_.state_.shield.unpacked = true;
    applySaved(saved, latches);
    size_t next = 0;
    for (const SavedObject& from : saved.objects) {
        if (!from.touched) continue;
        const ImageStore& store = stores[next++];
        if (Object& object = **world_.scene_.objects.at(from.slot); object.breaks)
            world_.burn_.restoreBreaks(object, from.asksBreaks ? &from.breaks : nullptr, store,
                                       uint32_t(world_.context_.clock.tick));
    }
    world_.queries_.state_.tags.swap(tags);
    world_.burn_.state_.pending.swap(saved.pending);
    world_.burn_.settlePending();
    for (SavedField& field : saved.fields)
        if (field.wets)
            (*world_.fields_.state_.fields.at(field.slot))->cells->cells.swap(field.cells);
}

void PersistenceSystem::applySaved(const SavedWorld& saved,
                                   std::span<const components::Latch> latches) noexcept {
    world_.context_.clock = saved.clock;
    world_.burn_.state_.steps = saved.steps;
    world_.burn_.state_.droppedSteps = saved.droppedSteps;
    world_.burn_.state_.order = saved.order;
    std::copy_n(saved.wind, 3, world_.wind_.state_.wind);
    world_.wind_.state_.gusts = saved.gusts;
    for (const SavedWindZone& zone : saved.windZones)
        *world_.wind_.state_.zones.at(zone.slot) = zone.zone;
    world_.wind_.sortZones();
    world_.wind_.state_.kept = true;  // objects find theirs below, one by one
    world_.wind_.updateObjects();
    world_.wind_.state_.gustsShown = saved.gustsShown;
    world_.rooms_.state_.met = !saved.rooms.empty();
    for (const SavedRoom& from : saved.rooms) {
        RoomEntry& entry = *world_.rooms_.state_.rooms.at(from.slot);
        entry.room = from.room;
        world_.rooms_.fill(entry, from.oxygen, from.power, from.flash);
        entry.air.drawn = from.drawn;
        entry.air.stirs = from.stirs;
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
        save->pending = false;  // of the world that was
        save->wished = true;
    }
    if (timeline_) {
        const bool anew = !timeline_->seeks;  // it begins here, or is in its own past
        if (anew) timeline_->restart(world_.context_.clock.tick);
        saves_[size_t(SaveFor::timeline)]->wished = anew;
    }
    if (journal_) {
        journal_->loaded = true;
        journal_->captured = false;
        journal_->deeds.clear();
        journal_->hashes.clear();
    }
    // What was asked of frames before is asked anew.
    for (QuerySystem::ProbeFrame& frame : world_.queries_.probeFrames_) frame.frameIndex = 0;
    for (uint32_t i = 0; i < world_.queries_.state_.queries.slotCount(); ++i)
        if (Query* query = world_.queries_.state_.queries.at(i); query && !query->ready)
            query->asked = false;
    world_.context_.events.clear();
    for (const SavedEvent& event : saved.events)
        world_.context_.raise(
            event.type,
            event.object1 != 0 ? world_.scene_.objects.at(event.object1 - 1)->get() : nullptr,
            event.tag, world_.context_.lastFrame, event.position, event.value,
            event.other1 != 0 ? world_.scene_.objects.idOf(event.other1 - 1) : FwBurnableMeshId{});
    world_.context_.readbackTick = world_.context_.clock.tick;
    // Awake it would see the wind from here on, and not from where its first fire begins.
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
    // Who is where.
    world_.exchange_.state_.book.unsent = true;
    world_.exchange_.state_.book.blockersDue = saved.blockersDue;
    world_.exchange_.state_.book.blockers.assign(saved.latchedBlockers.begin(),
                                                 saved.latchedBlockers.end());
    world_.exchange_.state_.book.rebuild = true;
    world_.exchange_.state_.book.due.clear();
    for (const SavedBlocker& blocker : saved.blockers) {
        BlockerEntry& entry = *world_.exchange_.state_.blockers.at(blocker.slot);
        entry.pose = blocker.pose;
        std::copy_n(blocker.halfSize, 3, entry.halfSize);
    }
    world_.scene_.touched.clear();
    world_.scene_.playing.clear();
    for (size_t i = 0; i < saved.objects.size(); ++i)
        applyObject(saved.objects[i], latches[i],
                    **world_.scene_.objects.at(saved.objects[i].slot));
    world_.lights_.showSaved();
    world_.exchange_.state_.book.pairs.clear();
    for (const SavedPair& from : saved.pairs) {
        PairContacts pair{{from.slots[0], from.slots[1]}};
        for (int k = 0; k < 2; ++k) pair.ids[k] = world_.scene_.objects.idOf(pair.slots[k]);
        pair.since = from.since;  // of links that are found anew
        pair.touches = true;
        world_.exchange_.state_.book.pairs.push_back(pair);
    }
    world_.exchange_.state_.book.loadedSeen.assign(saved.seen.begin(), saved.seen.end());
    const auto idOf = [&](uint32_t plus1) {
        return plus1 != 0 ? world_.scene_.objects.idOf(plus1 - 1) : FwBurnableMeshId{};
    };
    for (const SavedFire& from : saved.fires) {
        Fire& fire = **world_.flames_.state_.fires.at(from.slot);
        const auto same = [](const volume::ControlPoint& a, const volume::ControlPoint& b) {
            return a.position == b.position && a.radius == b.radius;
        };
        const bool led = from.pointCount == fire.data.pointCount &&
                         std::equal(from.points.begin(), from.points.begin() + from.pointCount,
                                    fire.data.points.begin(), same);
        if (!led || !std::equal(from.position, from.position + 3, fire.data.position) ||
            from.power != fire.data.power) {  // as if it had always burnt so
            world_.flames_.burning_.drop(fire.data);
            fire.data.state = {};
            fire.data.points = from.points;
            fire.data.pointCount = from.pointCount;
            components::setFirePosition(fire.data, from.position);
            components::setFirePower(fire.data, from.power);
            world_.flames_.foresee(fire.data);
        }
        for (size_t k = 0; k < from.touches.size(); ++k) {
            FireTouch& touch = fire.touches[k];
            touch.object = idOf(from.touches[k].object1);
            touch.since = from.touches[k].since;
            std::copy_n(from.touches[k].fireAt, 3, touch.fireAt);
            std::copy_n(from.touches[k].objectAt, 3, touch.objectAt);
            touch.lit = from.touches[k].flag;
        }
    }
    world_.emitters_.state_.time =
        double(world_.context_.clock.tick) / double(gpu::kTicksPerSecond);
    for (const SavedEmitter& from : saved.emitters)
        applyEmitter(from, *world_.emitters_.state_.emitters.at(from.slot));
    for (const SavedField& from : saved.fields) {
        Field& field = **world_.fields_.state_.fields.at(from.slot);
        // The backend counts its own steps: what it shows goes on from where it is.
        const uint32_t ran = field.steps - field.shownBase;
        field.began = from.began;
        std::copy_n(from.position, 3, field.data.position);
        std::copy_n(from.rotation, 4, field.data.rotation);
        field.data.def.look.amount = from.amount;
        field.steps = components::fieldSteps(field.data, world_.context_.clock.tick - field.began);
        field.shownBase = field.steps - ran;
        if (!from.wets) continue;
        field.cells->step = from.step;
        field.cells->emitted = from.emitted;
        field.cells->died = from.died;
        field.cells->left = from.left;
    }
    world_.fields_.sendRules();
}

void PersistenceSystem::applyObject(const SavedObject& from, const components::Latch& latch,
                                    Object& object) noexcept {
    object.data.pose = from.pose;
    object.zoneWind = from.zoneWind;
    world_.context_.backend.setObjectWind(object.slot, object.zoneWind);
    world_.scene_.placeNow(object);
    object.restsUnder = 0;
    object.room1 = world_.rooms_.roomOf(object);
    world_.rooms_.state_.met |= (from.touched ? from.counters.air : from.air) != 0;
    world_.scene_.sendPose(object);
    object.latch = latch;
    object.firstEvent = from.firstEvent;
    object.play = from.play;
    if (object.play.burn1 != 0) world_.burn_.startPlay(object);
    object.firstFrame = world_.context_.lastFrame + 1;
    object.touched = from.touched;
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
        object.breaks->shareTold = object.breaks->waits = false;
        std::fill(object.breaks->lost.begin(), object.breaks->lost.end(), false);
    }
    object.remote = {};
    object.remoteSent = false;
    object.remoteDue = from.due;
    object.remoteVersion = from.placed ? ++world_.exchange_.state_.book.version : 0;
    if (from.due) world_.exchange_.state_.book.due.push_back(object.slot);
    if (from.placed) {
        const mesh::BurnDomain& domain = world_.scene_.domainOf(object);
        if (from.due) {
            object.remote = from.remote;
        } else {
            components::placeRemote(object.data.pose, domain, object.remote);
            components::fillRemote(object.data, domain, object.governance, object.remote);
            if (object.texels == 0) object.remote.flags &= ~gpu::kRemoteLive;
            object.remote.high.w = from.remote.high.w;
        }
        object.reach = components::remoteReach(
            object.data, domain, world_.scene_.meshes.at(object.data.meshSlot)->texelsOf);
    }
    object.story = from.story;
    object.carried = from.carried;
    object.carryEnd = 0;  // what the save carries is settled with its events
    object.stimuli = 0;
    object.ignites = false;
    object.counters = from.counters;
    if (!from.touched) return;
    world_.scene_.touched.push_back(&object);
    if (object.story.ignitionKnown)
        world_.context_.backend.startBoundary(object.slot, object.story.ignitionPoint,
                                              uint32_t(object.story.firstIgnition));
}

void PersistenceSystem::applyEmitter(const SavedEmitter& from,
                                     components::FireEmitter& emitter) noexcept {
    std::copy_n(from.position, 3, emitter.position);
    std::copy_n(from.direction, 3, emitter.direction);
    if (emitter.def.power != from.power) components::setEmitterPower(emitter, from.power);
    emitter.births = {};  // what flew belongs to another time
    emitter.births.warms = true;
    emitter.lastShields = {};
    components::settleSparks(emitter, world_.emitters_.state_.time);
    emitter.swept = 0;
    for (size_t k = 0; k < from.touches.size(); ++k) {
        components::JetTouch& touch = emitter.touches[k];
        const uint32_t object1 = from.touches[k].object1;
        touch.object = object1 != 0 ? world_.scene_.objects.idOf(object1 - 1) : FwBurnableMeshId{};
        touch.since = from.touches[k].since;
        touch.seen = from.touches[k].flag;
    }
    if (!emitter.stream) return;
    emitter.stream->kept = from.kept;
    emitter.stream->patches = from.patches;
    for (components::JetPatch& patch : emitter.stream->patches)
        patch.object = patch.object.index1 != 0
                           ? world_.scene_.objects.idOf(patch.object.index1 - 1)
                           : FwBurnableMeshId{};
    emitter.stream->before = emitter.stream->patches;
    emitter.stream->patchedAt = from.patchedAt;
    for (components::JetParcel& parcel : emitter.stream->parcels) parcel = {};
    for (size_t i = 0; i < from.parcels.size(); ++i) {
        components::JetParcel& parcel = emitter.stream->parcels[from.places[i]];
        parcel = from.parcels[i];
        for (uint32_t r = 0; r < components::kJetRays; ++r) {
            components::JetRay& ray = parcel.rays[r];
            const uint32_t object1 = ray.hit.object.index1;
            ray.hit.object =
                object1 != 0 ? world_.scene_.objects.idOf(object1 - 1) : FwBurnableMeshId{};
            ray.version =
                from.swept[i * components::kJetRays + r] != 0 ? world_.scene_.geometryVersion : 0;
        }
    }
}

}  // namespace fw::world
