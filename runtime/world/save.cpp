// Saving a world mid-burn. The snapshot is captured at the frame that was asked for, the objects'
// images come with its readback.
#include "world/save.h"

#include "core/hash.h"
#include "core/reserved.h"

#include <algorithm>
#include <cstring>

namespace fw::world {
namespace {

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

// Whether the next frame takes the save.
bool startsSave(const core::Owned<Save>& save) noexcept {
    return save && save->requested && !save->pending;
}

}  // namespace

uint64_t Scene::meshHash(const Object& object) noexcept {
    MeshEntry& mesh = *meshes.at(object.data.meshSlot);
    if (mesh.hash == 0) mesh.hash = hashOf(*mesh.domain) | 1;
    return mesh.hash;
}

uint64_t PersistenceSystem::assetOf(const Object& object) noexcept {
    uint64_t hash = scene_.meshHash(object);
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

uint32_t PersistenceSystem::explainUnsavable() noexcept {
    for (const Object* object : scene_.touched)
        if (object->data.flags & core::reserved::kBurning) return object->id.index1;
    return 0;
}

void PersistenceSystem::requestSave(SaveFor who) {
    if (const uint32_t object1 = explainUnsavable())
        core::refuse("Burnable mesh %u burns by an extension; such fires cannot be saved.",
                     object1);
    core::Owned<Save>& save = saves_[size_t(who)];
    if (!save) save = core::Owned<Save>::make(context_.memory, context_.memory);
    save->requested = true;
    save->ready = false;
}

void PersistenceSystem::cancelSave() noexcept { saves_[size_t(SaveFor::host)] = {}; }

const std::pmr::vector<std::byte>* PersistenceSystem::fetchSave(SaveFor who) {
    const core::Owned<Save>& save = saves_[size_t(who)];
    if (!save || (!save->requested && !save->pending && !save->ready))
        core::refuse("No save was asked for; request it first.");
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
    images_.reserve(scene_.objects.slotCount());
    // All objects that an event of the frame addresses are among its latches.
    for (auto [slot, object] : scene_.objects.entries())
        if (object.touched || object.planStamp == world_.burn_.state().planStamp)
            images_.push_back(slot);
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
            save.eventsFrom = who == size_t(SaveFor::net) ? kNoEvents : context_.events.next();
        } catch (...) {
            save.failed = true;
        }
        if (who == size_t(SaveFor::host) && recorder_.log)
            recorder_.log->push({context_.clock.tick, true, {}});
        if (who == size_t(SaveFor::timeline) && recorder_.timeline)
            recorder_.timeline->captured = recorder_.timeline->applied;
        if (who != size_t(SaveFor::net) || !recorder_.network) continue;
        recorder_.network->captured = true;
        recorder_.network->capturedAt = context_.clock.tick;
        recorder_.network->capturedBehind = recorder_.network->commands.size();
    }
}

void PersistenceSystem::capture(Snapshot& to) {
    to.rules = context_.def;
    to.clock = context_.clock;
    std::copy_n(context_.origin.moved, 3, to.origin);
    to.objects.clear();
    for (auto [slot, object] : scene_.objects.entries()) {
        ObjectSnapshot& made = to.objects.emplace_back();
        made.slot = slot;
        captureObject(object, made);
    }
    to.tags = world_.queries_.tags();
    world_.burn_.capture(to.burn);
    world_.exchange_.capture(to.exchange);
    world_.wind_.capture(to.wind);
    world_.rooms_.capture(to.rooms);
    world_.flames_.capture(to.fires);
    world_.emitters_.capture(to.emitters);
    world_.fields_.capture(to.fields);
}

void PersistenceSystem::captureObject(Object& object, ObjectSnapshot& to) noexcept {
    static_cast<ObjectState&>(to) = object;
    to.asset = assetOf(object);
    to.pose = object.data.pose;
    if (object.play.burn1 != 0)
        to.burnHash = (*world_.burn_.state().burns.at(object.play.burn1 - 1))->hash;
    to.placed = object.exchangeVersion != 0;
    to.exchangeObject.neighbourFirst = to.exchangeObject.neighbourCount = 0;
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
        const auto* now = scene_.objects.findSlot(object.slot);
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
    std::pmr::vector<Ends> ends(context_.memory);
    std::pmr::vector<uint32_t> lost(context_.memory);
    for (const gpu::ObjectImage& image : readback.images) {
        const Object& object = scene_.objectAt(image.object);
        writeImage(image, scene_.domainOf(object), readback.endTick, windowOf(object), save.planes);
        Ends& end = ends.emplace_back();
        end.image = save.planes.size();
        if (object.breaks) {
            lost.assign(object.breaks->lost.begin(), object.breaks->lost.end());
            save::writePlane(lost, scene_.domainOf(object).width, {}, save.planes);
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
        FW_ASSERT(next < ends.size(), "%zu of %zu images", next, ends.size());
        const Ends& end = ends[next++];
        const Object& live = scene_.objectAt(object.slot);
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
    world_.rooms_.complete(saved.rooms, readback);
    world_.burn_.complete(saved.burn);
    writeSnapshot(saved, save.bytes);
    save.ready = true;
}

// Events that the host had not polled at the save's frame, and later ones of that frame.
void PersistenceSystem::captureEvents(Save& save) {
    std::pmr::vector<SavedEvent>& to = save.snapshot.events;
    to.clear();
    std::pmr::vector<std::pair<uint64_t, uint64_t>> found(context_.memory);  // frame and number
    for (uint64_t i = std::max(save.eventsFrom, context_.events.oldest());
         i < context_.events.end(); ++i) {
        const FwEvent& event = context_.events.at(i);
        if (event.frameIndex > save.frameIndex) continue;
        if (event.object.index1 != 0 && !scene_.objects.find(event.object)) continue;
        found.emplace_back(event.frameIndex, i);
    }
    std::sort(found.begin(),
              found.end());  // readbacks of a device come later than the world's own events
    for (size_t k = found.size() - std::min<size_t>(found.size(), kMaxSavedEvents);
         k < found.size(); ++k) {
        const FwEvent& event = context_.events.at(found[k].second);
        SavedEvent& saved = to.emplace_back();
        static_cast<FwEvent&>(saved) = event;
        if (!scene_.objects.find(event.other)) saved.other = {};
        for (int i = 0; event.type != FW_EVENT_TIME_DROPPED && i < 3; ++i)  // moved since
            saved.position[i] = float(double(saved.position[i]) + save.snapshot.origin[i] -
                                      context_.origin.moved[i]);
    }
}

}  // namespace fw::world
