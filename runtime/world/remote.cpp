// Who is where, as others see it: poses become integers at fixed ticks, neighbours and contacts are
// found when something moved, and all of it goes to the backend with the step that begins there.
// What fire does with it is the backend's.
#include "core/growth.h"
#include "fire/heat.h"
#include "mesh/remote_tiles.h"
#include "world/save.h"
#include "world/world.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <tuple>

namespace fw::world {
namespace {

using components::checkLengths;
using components::checkValue;
using components::checkValues;

static_assert(FW_WORLD_RADIATION == gpu::kRemoteRadiation && FW_WORLD_PLUME == gpu::kRemotePlume &&
              FW_WORLD_CONTACT == gpu::kRemoteContact && FW_WORLD_EMBERS == gpu::kRemoteEmbers);

constexpr double kGapSpeed = 0.05;        // m/s at which flames lick across a gap
constexpr double kBrandsPerJoule = 2e-6;  // embers that matter

mesh::Box boxOf(const gpu::RemoteObject& o) noexcept {
    mesh::Box box;
    const int low[3] = {o.turn0.w, o.turn1.w, o.turn2.w};
    for (int i = 0; i < 3; ++i) {
        box.low[i] = low[i];
        box.high[i] = o.high[i];
    }
    return box;
}

bool sameRecord(const gpu::RemoteObject& a, const gpu::RemoteObject& b) noexcept {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

bool before(const gpu::ContactLink& a, const gpu::ContactLink& b) noexcept {
    return std::tie(a.texel, a.fromObject, a.fromTexel) <
           std::tie(b.texel, b.fromObject, b.fromTexel);
}

}  // namespace

void World::setFlags(uint32_t given) {
    mayChange();
    if (given & ~kWorldFlags)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "flags is 0x%x; the known flags are 0x%x.", given,
                   kWorldFlags);
    const uint32_t flags = given & kWaysOfFire;
    remote_.objectFlags = given & ~kWaysOfFire;
    remote_.unsent |= flags != 0 && flags != remote_.flags;
    remote_.spreadKnown &= flags == remote_.flags;
    constexpr uint32_t kWarm = FW_WORLD_RADIATION | FW_WORLD_PLUME;
    remote_.warms |= (flags & kWarm) != 0;
    if (remote_.flags & ~flags & kWarm)
        remote_.fades = clock_.tick + 2 * gpu::kExchangeTurns * gpu::kExchangeTicks;
    remote_.flags = flags;
    record(SetFlags{given});
}

namespace {

// Their integers hold so much and no more; a larger one would stop less than the host sees of it.
void checkBlocker(const components::Pose& pose, const float halfSize[3], const char* field) {
    for (int i = 0; i < 3; ++i) {
        const float half = halfSize[i] * pose.scale * std::abs(pose.stretch[i]);
        if (half > 30.0f * 1.0001f)
            core::fail(FW_ERROR_INVALID_ARGUMENT,
                       "%s makes the blocker " FW_LENGTH " " FW_LENGTH_UNIT
                       " to each side along its axis %d; the limit is " FW_LENGTH " " FW_LENGTH_UNIT
                       ". Put several side by side.",
                       field, double(half), i, 30.0);
    }
}

}  // namespace

FwBlockerId World::addBlocker(const FwBlockerDef& def) {
    ++geometry_;
    if (def.flags != 0 || def.reserved != 0)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "FwBlockerDef::flags is 0x%x and reserved is %u; both are zero.", def.flags,
                   def.reserved);
    BlockerEntry entry;
    entry.pose = components::makePose(def.transform, "FwBlockerDef::transform");
    checkLengths(def.halfSize, 3, "FwBlockerDef::halfSize", 0.0f, 30.0f);
    checkBlocker(entry.pose, def.halfSize, "FwBlockerDef::transform");
    std::copy_n(def.halfSize, 3, entry.halfSize);
    if (blockers_.live() >= gpu::kMaxBlockers)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "%u blockers are in place; the limit is %u.",
                   blockers_.live(), gpu::kMaxBlockers);
    const FwBlockerId id = blockers_.create(entry);
    remote_.blockersDue = true;
    return id;
}

void World::moveBlocker(FwBlockerId id, const float transform[16]) {
    mayChange();
    ++geometry_;
    BlockerEntry& entry = blockers_.get(id);
    const components::Pose pose = components::makePose(transform, "transform");
    checkBlocker(pose, entry.halfSize, "transform");
    entry.pose = pose;
    remote_.blockersDue = true;
    record(MoveBlocker{id.index1 - 1, Transform(transform)});
}

void World::removeBlocker(FwBlockerId id) {
    ++geometry_;
    blockers_.destroy(id);
    remote_.blockersDue = true;
}

gpu::ExchangePush World::exchangeRules() const noexcept {
    gpu::ExchangePush rules{};
    rules.flags = remote_.flags;
    rules.warms = remote_.warms ? 1 : 0;
    const auto up = [&](int i) { return int(std::lround(double(def_.up[i]) * 4096)); };
    rules.upX = up(0);
    rules.upY = up(1);
    rules.upZ = up(2);
    const fire::WindVector wind = fire::windUnits(wind_);
    rules.windX = wind[0] * 1000 / 128;
    rules.windY = wind[1] * 1000 / 128;
    rules.windZ = wind[2] * 1000 / 128;
    rules.chance = components::chanceOf(remote_.governance.chance);
    rules.hopsMost = components::limitOf(remote_.governance.hopsMost);
    rules.tilesMost = components::limitOf(remote_.governance.tilesMost);
    rules.lifeTicks = components::lifeTicksOf(remote_.governance.life);
    rules.seed = def_.seed;
    rules.ambient = uint32_t(fire::kAmbient) * 16;  // 1/16 K
    const double perExchange = kBrandsPerJoule * double(def_.paceFactor) *
                               double(gpu::kExchangeTicks) / double(gpu::kTicksPerSecond);
    rules.brands = uint32_t(std::min(perExchange / 16 * 4294967296.0, 4e9));
    return rules;
}

// Whom another wind finds is where it was, and touches whom it did.
void World::takeRemoteWind(Object& object, int wind) noexcept {
    if (object.remoteVersion == 0 || wind == object.remote.high.w) return;
    object.remote.high.w = wind;
    markUnsent(object);
}

void World::markUnsent(Object& object) noexcept {
    remote_.unsent = true;
    if (!object.remoteSent) return;
    object.remoteSent = false;
    remote_.unsentSlots.push_back(object.slot);  // room was found at its creation
}

// An update that the frame has planned points to lists that are about to change.
void World::keepPlanned() {
    if (frame_.remoteUsed == 0) return;
    RemoteTables& tables = *frame_.remote[frame_.remoteUsed - 1];
    if (tables.update.neighbours.data() == remote_.neighbours.pool().all().data()) {
        tables.neighbours.assign(tables.update.neighbours.begin(), tables.update.neighbours.end());
        tables.update.neighbours = tables.neighbours;
    }
    if (tables.update.links.data() == remote_.links.all().data()) {
        tables.links.assign(tables.update.links.begin(), tables.update.links.end());
        tables.update.links = tables.links;
    }
}

// Poses and blockers as they are now.
void World::latchRemote(uint32_t now) {
    for (const uint32_t slot : remote_.due) {
        Object& object = **objects_.at(slot);
        const mesh::BurnDomain& domain = domainOf(object);
        gpu::RemoteObject record{};
        components::placeRemote(object.data.pose, domain, record);
        components::fillRemote(object.data, domain, object.governance, record);
        if (object.texels == 0) record.flags &= ~gpu::kRemoteLive;
        record.high.w = int(zoneWindOf(object, now));
        record.neighbourFirst = object.remote.neighbourFirst;
        record.neighbourCount = object.remote.neighbourCount;
        takeRemoteWind(object, record.high.w);
        if (object.remoteVersion != 0 && sameRecord(record, object.remote)) continue;
        keepPlanned();
        object.remote = record;
        object.reach = components::remoteReach(object.data, domain,
                                               meshes_.at(object.data.meshSlot)->texelsOf);
        // Room for these was found at its creation.
        if (object.remoteVersion == 0 && !object.touched) remote_.waiting.push_back(slot);
        object.remoteVersion = ++remote_.version;
        markUnsent(object);
        if (!(record.flags & gpu::kRemoteLive) || slot > Neighbours::kSlot) continue;
        if (!object.contactsDue) remote_.contactsDue.push_back(slot);
        object.contactsDue = true;
        if (def_.visibility && !object.seenDue) remote_.seenDue.push_back(slot);
        object.seenDue = def_.visibility != nullptr;
        try {
            remote_.neighbours.place(slot, boxOf(record), object.reach);
        } catch (...) {
            remote_.rebuild = true;
            throw;
        }
    }
    remote_.unsent |= !remote_.neighbours.changed().empty();
    for (uint32_t slot = 0; gusty() && slot < objects_.slotCount(); ++slot)
        if (auto* owned = objects_.at(slot)) takeRemoteWind(**owned, int(zoneWindOf(**owned, now)));
    if (!remote_.blockersDue) return;
    remote_.blockers.clear();
    for (uint32_t i = 0; i < blockers_.slotCount(); ++i)
        if (const BlockerEntry* entry = blockers_.at(i)) {
            gpu::Blocker blocker{};
            components::placeBlocker(entry->pose, entry->halfSize, blocker);
            remote_.blockers.push_back(blocker);
        }
    remote_.unsent = true;
}

// All of it from the latched records and the pairs that are known: the lists are those of another
// world, or memory ended while they changed.
void World::rebuildRemote() {
    RemoteBook& book = remote_;
    keepPlanned();
    book.unsent = true;
    book.spreadKnown = false;
    book.neighbours.clear();
    book.close.clear();
    book.links.clear();
    for (auto* lists : {&book.closeOf, &book.linksOf}) {
        core::growTo(*lists, objects_.slotCount());
        lists->assign(objects_.slotCount(), {});
    }
    for (auto* slots : {&book.unsentSlots, &book.contactsDue, &book.seenDue, &book.waiting})
        slots->clear();  // each keeps its room for all objects
    for (uint32_t slot = 0; slot < objects_.slotCount(); ++slot) {
        auto* owned = objects_.at(slot);
        if (!owned) continue;
        Object& object = **owned;
        const bool placed = object.remoteVersion != 0;
        const bool meets =
            placed && object.remote.flags & gpu::kRemoteLive && slot <= Neighbours::kSlot;
        object.remoteSent = !placed;
        object.contactsDue = meets;
        object.seenDue = meets && def_.visibility;
        if (placed) book.unsentSlots.push_back(slot);
        if (placed && !object.touched) book.waiting.push_back(slot);
        if (object.contactsDue) book.contactsDue.push_back(slot);
        if (object.seenDue) book.seenDue.push_back(slot);
        if (meets) book.neighbours.place(slot, boxOf(object.remote), object.reach);
    }
    std::erase_if(book.pairs, [&](const PairContacts& pair) {
        for (int k = 0; k < 2; ++k) {
            const auto* owned = objects_.at(pair.slots[k]);
            if (!owned || (*owned)->id.generation != pair.ids[k].generation) return true;
        }
        return false;
    });
    for (uint32_t i = 0; i < book.pairs.size(); ++i) {
        PairContacts& pair = book.pairs[i];
        pair.versions[0] = pair.versions[1] = 0;
        pair.stamp = 0;
        for (int k = 0; k < 2; ++k) addClose(pair.slots[k], pair.slots[1 - k], i);
    }
    seeAsLoaded();
    book.rebuild = false;
}

// The host's answers of saved pairs hold. An object without any was elsewhere since the host was
// asked about it: it is asked when the world awakes, as it would have been.
void World::seeAsLoaded() {
    RemoteBook& book = remote_;
    const auto before = [](const Seen& a, const Seen& b) {
        return std::tie(a.slots[0], a.slots[1]) < std::tie(b.slots[0], b.slots[1]);
    };
    std::erase_if(book.seenDue, [&](uint32_t slot) {
        bool due = false, holds = false;
        for (const uint32_t entry : book.neighbours.of(slot)) {
            const Seen wanted{{slot, entry & Neighbours::kSlot}};
            const auto known =
                std::lower_bound(book.loadedSeen.begin(), book.loadedSeen.end(), wanted, before);
            due = true;
            if (known == book.loadedSeen.end() || before(wanted, *known)) continue;
            holds = true;
            book.neighbours.see(slot, wanted.slots[1], known->part);
        }
        due &= !holds;
        (*objects_.at(slot))->seenDue = due;
        return !due;
    });
    book.loadedSeen.clear();
}

// Pairs of which the host has been asked since one of them was elsewhere, by slots.
void World::noteSeen(std::pmr::vector<Seen>& to) const {
    const RemoteBook& book = remote_;
    if (!def_.visibility) return;
    if (book.rebuild) {
        for (const Seen& seen : book.loadedSeen)
            if (objects_.at(seen.slots[0]) && objects_.at(seen.slots[1]))
                to.push_back({{seen.slots[0], seen.slots[1]}, seen.part});
        return;
    }
    for (uint32_t slot = 0; slot < objects_.slotCount(); ++slot) {
        const auto* owned = objects_.at(slot);
        if (!owned || (*owned)->seenDue) continue;
        for (const uint32_t entry : book.neighbours.of(slot)) {
            const uint32_t other = entry & Neighbours::kSlot;
            if (!(*objects_.at(other))->seenDue) to.push_back({{slot, other}, entry >> 24});
        }
    }
}

// What a fire of `from` sees of `to`, of 255.
uint32_t World::seenPart(const Object& from, const Object& to) const {
    const float answer = def_.visibility(def_.visibilityData, from.id, to.id);
    return answer > 0 ? uint32_t(std::lround(std::min(answer, 1.0f) * 255)) : 0u;
}

// Both ways between objects that are elsewhere and all their neighbours.
void World::askVisibility() {
    RemoteBook& book = remote_;
    for (const uint32_t slot : book.seenDue) {
        const Object& object = **objects_.at(slot);
        for (const uint32_t entry : book.neighbours.of(slot)) {
            const Object& other = **objects_.at(entry & Neighbours::kSlot);
            if (other.seenDue && other.slot < slot) continue;  // asked with that one
            book.neighbours.see(slot, other.slot, seenPart(other, object));
            book.neighbours.see(other.slot, slot, seenPart(object, other));
        }
    }
    for (const uint32_t slot : book.seenDue) (*objects_.at(slot))->seenDue = false;
    book.seenDue.clear();
}

namespace {

uint32_t burnMask(const components::BurnableMesh& object) noexcept {
    uint32_t mask = 0;
    for (uint32_t i = 0; i < components::kMaterials; ++i)
        if (components::burns(object, i)) mask |= 1u << i;
    return mask;
}

}  // namespace

// The links of one pair, one way.
void World::linkPair(const Object& to, const Object& from, std::span<const mesh::Contact> contacts,
                     uint32_t since, std::pmr::vector<gpu::ContactLink>& out) {
    for (const mesh::Contact& contact : contacts) {
        const FwMaterialDef& def =
            to.data.materials[domainOf(to).texels[contact.texel].materialFlags &
                              (gpu::kMaterialsPerObject - 1)];
        // An ordinary link of that length, and the flame's way across.
        const double metres = contact.gap / 1000.0;
        const double seconds =
            (metres / std::max(double(def.spreadRate), 1e-6) + metres / kGapSpeed) /
            double(def_.paceFactor);
        gpu::ContactLink link{};
        link.object = to.slot;
        link.texel = contact.texel;
        link.fromObject = from.slot;
        link.fromTexel = contact.fromTexel;
        link.delay = uint32_t(std::min(seconds * gpu::kTicksPerSecond, 1e9));
        link.since = since;
        out.push_back(link);
    }
}

// Of objects that were latched since the last time. What memory refuses comes with the next call.
void World::findLinks(uint32_t now) {
    RemoteBook& book = remote_;
    if (!(book.flags & FW_WORLD_CONTACT)) return;
    for (auto* lists : {&book.closeOf, &book.linksOf})
        if (lists->size() < objects_.slotCount()) {
            core::growTo(*lists, objects_.slotCount());
            lists->resize(objects_.slotCount());
        }
    for (const uint32_t slot : book.contactsDue) linkClose(**objects_.at(slot), now);
    for (const uint32_t slot : book.contactsDue) (*objects_.at(slot))->contactsDue = false;
    book.contactsDue.clear();
}

// The contacts of one object with all that are so near.
void World::linkClose(Object& object, uint32_t now) {
    RemoteBook& book = remote_;
    const uint64_t stamp = ++book.contactStamp;
    const auto meet = [&](uint32_t other) {
        if (mesh::gapOf(boxOf(object.remote), boxOf((*objects_.at(other))->remote)) >
            int(gpu::kContactGap))
            return;
        const Object& a = object.slot < other ? object : **objects_.at(other);
        const Object& b = object.slot < other ? **objects_.at(other) : object;
        PairContacts& pair = book.pairs[closePair(a.slot, b.slot)];
        pair.stamp = stamp;
        if (pair.versions[0] == a.remoteVersion && pair.versions[1] == b.remoteVersion) return;
        pair.versions[0] = pair.versions[1] = 0;  // until all of it is there
        // Objects that only shifted while they touch keep the tick of their first touch.
        const bool same = pair.ids[0].index1 != 0 && pair.ids[0].generation == a.id.generation &&
                          pair.ids[1].generation == b.id.generation;
        const uint32_t since = same && pair.touches ? pair.since : now;
        dropLinks(a.slot, b.slot);
        dropLinks(b.slot, a.slot);
        const Object* const both[2] = {&a, &b};
        mesh::findContacts({{&domainOf(a), &a.remote, burnMask(a.data)},
                            {&domainOf(b), &b.remote, burnMask(b.data)}},
                           book.contacts);
        for (int k = 0; k < 2; ++k) {
            book.pairLinks.clear();
            linkPair(*both[k], *both[1 - k], book.contacts.found[k], since, book.pairLinks);
            addLinks(both[k]->slot, book.pairLinks);
        }
        pair.since = since;
        pair.touches = !book.contacts.found[0].empty() || !book.contacts.found[1].empty();
        pair.ids[0] = a.id;
        pair.ids[1] = b.id;
        pair.versions[0] = a.remoteVersion;
        pair.versions[1] = b.remoteVersion;
        book.links.fit(book.linksOf[other]);
    };
    // Where all objects are latched as they stand now, the few that are so near are found among
    // all; else among its neighbours, which are many.
    if (book.due.empty() || frame_.remoteLatched) {
        const mesh::Box box = boxOf(object.remote);
        for (const uint32_t other : objectsNear(box, 0.001f * float(gpu::kContactGap))) {
            const Object& o = **objects_.at(other);
            if (other != object.slot && o.remoteVersion != 0 && o.remote.flags & gpu::kRemoteLive &&
                other <= Neighbours::kSlot)
                meet(other);
        }
    } else {
        for (const uint32_t entry : book.neighbours.of(object.slot))
            meet(entry & Neighbours::kSlot);
    }
    const ListPlace& close = book.closeOf[object.slot];
    for (uint32_t i = close.count; i-- > 0;)
        if (const CloseObject gone = book.close.of(close)[i];
            book.pairs[gone.pair].stamp != stamp) {
            dropPair(gone.pair);
            book.links.fit(book.linksOf[gone.slot]);
        }
    book.links.fit(book.linksOf[object.slot]);
}

namespace {

uint32_t closeIndex(std::span<const CloseObject> list, uint32_t slot) noexcept {
    const auto at =
        std::lower_bound(list.begin(), list.end(), slot,
                         [](const CloseObject& one, uint32_t wanted) { return one.slot < wanted; });
    return uint32_t(at - list.begin());
}

}  // namespace

void World::addClose(uint32_t slot, uint32_t other, uint32_t pair) {
    ListPlace& list = remote_.closeOf[slot];
    remote_.close.reserve(list, list.count + 1);
    remote_.close.insert(list, closeIndex(remote_.close.of(list), other), {other, pair});
}

// Their pair, which may be new.
uint32_t World::closePair(uint32_t a, uint32_t b) {
    RemoteBook& book = remote_;
    const std::span<const CloseObject> list = book.close.of(book.closeOf[a]);
    if (const uint32_t at = closeIndex(list, b); at < list.size() && list[at].slot == b)
        return list[at].pair;
    const auto pair = uint32_t(book.pairs.size());
    book.close.reserve(book.closeOf[b], book.closeOf[b].count + 1);  // the second then finds room
    core::growTo(book.pairs, pair + 1);
    addClose(a, b, pair);
    addClose(b, a, pair);
    book.pairs.push_back({{a, b}});
    return pair;
}

// They are apart, or one of them is gone.
void World::dropPair(uint32_t pair) noexcept {
    RemoteBook& book = remote_;
    const auto entryOf = [&](const PairContacts& of, int k) {
        return closeIndex(book.close.of(book.closeOf[of.slots[k]]), of.slots[1 - k]);
    };
    const PairContacts gone = book.pairs[pair];
    for (int k = 0; k < 2; ++k) {
        dropLinks(gone.slots[k], gone.slots[1 - k]);
        book.close.erase(book.closeOf[gone.slots[k]], entryOf(gone, k));
    }
    const PairContacts& last = book.pairs.back();  // takes its place
    if (pair + 1 != book.pairs.size())
        for (int k = 0; k < 2; ++k)
            book.close.of(book.closeOf[last.slots[k]])[entryOf(last, k)].pair = pair;
    book.pairs[pair] = last;
    book.pairs.pop_back();
}

void World::dropLinks(uint32_t to, uint32_t from) noexcept {
    ListPlace& place = remote_.linksOf[to];
    const std::span<gpu::ContactLink> list = remote_.links.of(place);
    const auto end = std::remove_if(list.begin(), list.end(), [&](const gpu::ContactLink& link) {
        return link.fromObject == from;
    });
    if (end == list.end()) return;
    std::fill(end, list.end(), RemoteBook::noLink());
    remote_.links.mark(place.first, place.count);
    place.count = uint32_t(end - list.begin());
}

void World::addLinks(uint32_t to, std::span<gpu::ContactLink> fresh) {
    if (fresh.empty()) return;
    RemoteBook& book = remote_;
    ListPlace& place = book.linksOf[to];
    std::sort(fresh.begin(), fresh.end(), before);
    const std::span<const gpu::ContactLink> list = book.links.of(place);
    book.mergedLinks.clear();
    std::merge(list.begin(), list.end(), fresh.begin(), fresh.end(),
               std::back_inserter(book.mergedLinks), before);
    book.links.reserve(place, uint32_t(book.mergedLinks.size()));
    book.links.assign(place, book.mergedLinks);
}

// The next object in its slot has no part in its contacts, and the backend hears of that before
// the next exchange.
void World::forgetRemote(const Object& object) noexcept {
    RemoteBook& book = remote_;
    book.unsent |= object.remoteVersion != 0;
    const uint32_t slot = object.slot;
    const auto leave = [&](std::pmr::vector<uint32_t>& slots, bool in) {
        if (in || book.rebuild) std::erase(slots, slot);
    };
    leave(book.due, object.remoteDue);
    leave(book.unsentSlots, !object.remoteSent);
    leave(book.waiting, object.remoteVersion != 0);
    leave(book.contactsDue, object.contactsDue);
    leave(book.seenDue, object.seenDue);
    if (book.rebuild) {  // its lists are none
        std::erase_if(book.pairs, [&](const PairContacts& pair) {
            return pair.slots[0] == slot || pair.slots[1] == slot;
        });
        std::erase_if(book.loadedSeen, [&](const Seen& seen) {
            return seen.slots[0] == slot || seen.slots[1] == slot;
        });
        return;
    }
    if (slot < book.closeOf.size()) {
        const ListPlace& close = book.closeOf[slot];
        while (close.count != 0) dropPair(book.close.of(close).back().pair);
        book.close.drop(book.closeOf[slot]);
        book.links.drop(book.linksOf[slot]);
    }
    book.neighbours.remove(slot);
}

// awake: the step will run.
void World::planRemote(gpu::StepPlan& step, uint32_t now, bool awake) {
    if (!remoteOn()) return;
    if (remote_.rebuild) rebuildRemote();
    step.rules = exchangeRules();
    step.exchange = step.reduce;
    step.governed = remote_.governed;
    step.capped = remote_.capped;
    if (now % gpu::kExchangeTicks == 0) {
        latchRemote(now);
        frame_.remoteLatched = true;
    }
    planShield(step, awake);
    if (!awake || !remote_.unsent) return;
    if (frame_.remoteFlushed && now % gpu::kExchangeTicks != 0) return;
    keepPlanned();
    askVisibility();
    findLinks(now);
    for (const uint32_t slot : remote_.neighbours.changed()) {
        auto* owned = objects_.at(slot);
        if (!owned) continue;
        Object& object = **owned;
        const ListPlace list = remote_.neighbours.listOf(slot);
        if (object.remote.neighbourFirst == list.first &&
            object.remote.neighbourCount == list.count)
            continue;
        object.remote.neighbourFirst = list.first;
        object.remote.neighbourCount = list.count;
        if (object.remoteVersion != 0) markUnsent(object);
    }
    if (frame_.remoteUsed == frame_.remote.size())
        frame_.remote.push_back(core::Owned<RemoteTables>::make(memory_, memory_));
    RemoteTables& tables = *frame_.remote[frame_.remoteUsed];
    tables.objects.clear();
    core::growTo(tables.objects, remote_.unsentSlots.size());
    for (const uint32_t slot : remote_.unsentSlots)
        tables.objects.push_back({slot, (*objects_.at(slot))->remote});
    remote_.neighbours.pool().listChanges(tables.neighbourRanges);
    remote_.links.listChanges(tables.linkRanges);
    tables.blockers.assign(remote_.blockers.begin(), remote_.blockers.end());
    tables.update = {tables.objects,         remote_.neighbours.pool().all(),
                     tables.neighbourRanges, remote_.links.all(),
                     tables.linkRanges,      tables.blockers};
    step.remote = &tables.update;
    ++frame_.remoteUsed;
    frame_.remoteFlushed = true;
}

// Whom fire may reach from those that an event touched must see the same wind on every backend, be
// the readback that tells of it late or not.
void World::touchNear(uint32_t now) {
    const auto add = [&](uint32_t slot) {
        auto* owned = objects_.at(slot);
        if (!owned || (*owned)->planStamp == planStamp_ || (*owned)->touched) return;
        Object& object = **owned;
        components::Latch latch = object.latch;
        components::resetLatch(object.data, driveInput(object, now), latch);
        latch.sent = object.latch.sent && components::sameDrive(object.data, latch, object.latch);
        addLatch(object, latch, true);
    };
    if (remote_.flags & FW_WORLD_EMBERS) {
        for (const uint32_t slot : remote_.waiting) add(slot);
        frame_.waitersTouched = true;
        return;
    }
    const auto addNear = [&](const Object& object) {
        for (const uint32_t entry : remote_.neighbours.of(object.slot))
            add(entry & Neighbours::kSlot);
    };
    // Once all neighbours of touched objects are touched, only other lists and other objects can
    // bring more.
    if (!remote_.spreadKnown)
        for (const Object* object : touched_) addNear(*object);
    else
        for (const uint32_t slot : remote_.neighbours.changed())
            if (const auto* owned = objects_.at(slot);
                owned && ((*owned)->touched || (*owned)->planStamp == planStamp_))
                addNear(**owned);
    for (; frame_.spreadFrom < frame_.latches.size(); ++frame_.spreadFrom)
        addNear(*frame_.latches[frame_.spreadFrom].object);
    frame_.spreadFound = true;
}

// After all that the frame reached was touched.
void World::commitRemote() noexcept {
    if (frame_.shieldSent) shield_.unsent = false;
    if (frame_.remoteLatched) {
        for (const uint32_t slot : remote_.due) (*objects_.at(slot))->remoteDue = false;
        remote_.due.clear();
        remote_.blockersDue = false;
    }
    remote_.spreadKnown |= frame_.spreadFound;
    if (frame_.waitersTouched)
        std::erase_if(remote_.waiting,
                      [&](uint32_t slot) { return (*objects_.at(slot))->touched; });
    if (!frame_.remoteFlushed) return;
    for (const uint32_t slot : remote_.unsentSlots) (*objects_.at(slot))->remoteSent = true;
    remote_.unsentSlots.clear();
    remote_.neighbours.settle();
    remote_.links.settle();
    remote_.unsent = false;
}

// The world is governed while one who asks for it is there.
void World::countGoverned(const Object& object, bool more) noexcept {
    remote_.cappedObjects += components::caps(object.governance) ? (more ? 1u : ~0u) : 0u;
    remote_.governedObjects += components::governs(object.governance) ? (more ? 1u : ~0u) : 0u;
    remote_.capped = remote_.cappedObjects != 0 || components::caps(remote_.governance);
    remote_.governed = remote_.governedObjects != 0 || components::governs(remote_.governance);
}

void World::tellSpread(Object& object, const gpu::Readback& readback) noexcept {
    const gpu::ObjectCounters& now = object.counters;
    if (now.litTick != object.story.litTold) {
        object.story.litTold = now.litTick;
        ++object.changes;
        const uint32_t giver = gpu::giverOf(now.litBy);
        // A slot may be another's since.
        const auto* by = giver < objects_.slotCount() ? objects_.at(giver) : nullptr;
        if (now.litTick != 0 && by && (*by)->firstFrame <= readback.frameIndex) {
            const gpu::RemoteObject& box = object.remote;
            const int low[3] = {box.turn0.w, box.turn1.w, box.turn2.w};
            float middle[3];
            for (int i = 0; i < 3; ++i)
                middle[i] = float(double(low[i]) + double(box.high[i])) / 2000.0f;
            raise(FW_EVENT_SPREAD_TO, &object, gpu::hopsOf(now.litBy), readback.frameIndex, middle,
                  float(double(now.litTick) / gpu::kTicksPerSecond), objects_.idOf(giver));
        }
    }
    if (now.spots != object.story.spotsTold) {
        float place[3];
        const uint32_t texel = now.spotTexel & ~gpu::kSpotFresh;
        texelPosition(object, std::min(texel, domainOf(object).texelCount() - 1), place);
        raise(FW_EVENT_SPOT_FIRE, &object, 0, readback.frameIndex, place,
              float(now.spots - object.story.spotsTold));
        object.story.spotsTold = now.spots;
        ++object.changes;
    }
}

}  // namespace fw::world
