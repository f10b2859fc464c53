// Who is where, as others see it: poses become integers at fixed ticks, neighbours and contacts are
// found when something moved, and all of it goes to the backend with the step that begins there.
// What fire does with it is the backend's.
#include "fire/heat.h"
#include "mesh/remote_tiles.h"
#include "world/world.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

namespace fw::world {
namespace {

using components::checkValue;
using components::checkValues;

static_assert(FW_WORLD_RADIATION == gpu::kRemoteRadiation && FW_WORLD_PLUME == gpu::kRemotePlume &&
              FW_WORLD_CONTACT == gpu::kRemoteContact && FW_WORLD_EMBERS == gpu::kRemoteEmbers);

constexpr double kGapSpeed = 0.05;        // m/s at which flames lick across a gap
constexpr double kBrandsPerJoule = 2e-6;  // embers that matter
constexpr uint32_t kMaxNeighbourSlot = 0xFFFFFFu;

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

uint64_t pairOf(uint32_t a, uint32_t b) noexcept { return uint64_t(a) << 32 | b; }

}  // namespace

void World::setFlags(uint32_t given) {
    mayChange();
    if (given & ~kWorldFlags)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "flags is 0x%x; the known flags are 0x%x.", given,
                   kWorldFlags);
    const uint32_t flags = given & kWaysOfFire;
    remote_.objectFlags = given & ~kWaysOfFire;
    remote_.unsent |= flags != 0 && flags != remote_.flags;
    constexpr uint32_t kWarm = FW_WORLD_RADIATION | FW_WORLD_PLUME;
    remote_.warms |= (flags & kWarm) != 0;
    if (remote_.flags & ~flags & kWarm)
        remote_.fades = clock_.tick + 2 * gpu::kExchangeTurns * gpu::kExchangeTicks;
    remote_.flags = flags;
    note({Deed::Kind::flags, 0, 0, given, {}});
}

FwBlockerId World::addBlocker(const FwBlockerDef& def) {
    ++geometry_;
    if (def.flags != 0 || def.reserved != 0)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "FwBlockerDef::flags is 0x%x and reserved is %u; both are zero.", def.flags,
                   def.reserved);
    BlockerEntry entry;
    entry.pose = components::makePose(def.transform, "FwBlockerDef::transform");
    checkValues(def.halfSize, 3, "FwBlockerDef::halfSize", 0.0f, 30.0f);
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
    entry.pose = components::makePose(transform, "transform");
    remote_.blockersDue = true;
    notePose(Deed::Kind::moveBlocker, id.index1 - 1, transform);
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
    object.remoteSent = false;
    remote_.unsent = true;
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
        object.remote = record;
        object.reach = components::remoteReach(object.data, domain,
                                               meshes_.at(object.data.meshSlot)->texelsOf);
        object.remoteVersion = ++remote_.version;
        object.remoteSent = false;
        remote_.unsent = true;
    }
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

// Objects whose boxes come within the reach of one of the two, both ways, by slot.
void World::findNeighbours() {
    RemoteBook& book = remote_;
    book.order.clear();
    for (uint32_t slot = 0; slot < objects_.slotCount() && slot <= kMaxNeighbourSlot; ++slot)
        if (auto* owned = objects_.at(slot);
            owned && (*owned)->remoteVersion != 0 && (*owned)->remote.flags & gpu::kRemoteLive)
            book.order.push_back(slot);
    const auto from = [&](uint32_t slot) {
        const Object& object = **objects_.at(slot);
        return int64_t(object.remote.turn0.w) - object.reach;
    };
    std::sort(book.order.begin(), book.order.end(), [&](uint32_t a, uint32_t b) {
        const int64_t x = from(a), y = from(b);
        return x != y ? x < y : a < b;
    });
    book.near.clear();
    for (size_t i = 0; i < book.order.size(); ++i) {
        const Object& a = **objects_.at(book.order[i]);
        const mesh::Box box = boxOf(a.remote);
        const int64_t end = int64_t(box.high[0]) + a.reach;
        for (size_t j = i + 1; j < book.order.size() && from(book.order[j]) <= end; ++j) {
            const Object& b = **objects_.at(book.order[j]);
            if (mesh::gapOf(box, boxOf(b.remote)) > int(std::max(a.reach, b.reach))) continue;
            book.near.push_back(pairOf(a.slot, b.slot));
            book.near.push_back(pairOf(b.slot, a.slot));
        }
    }
    std::sort(book.near.begin(), book.near.end());
    book.neighbours.clear();
    size_t at = 0;
    for (uint32_t slot = 0; slot < objects_.slotCount(); ++slot) {
        auto* owned = objects_.at(slot);
        if (!owned || (*owned)->remoteVersion == 0) continue;
        Object& object = **owned;
        const auto first = uint32_t(book.neighbours.size());
        while (at < book.near.size() && book.near[at] >> 32 < slot) ++at;
        for (; at < book.near.size() && book.near[at] >> 32 == slot; ++at)
            book.neighbours.push_back(uint32_t(book.near[at]) |
                                      seenOf(uint32_t(book.near[at]), slot) << 24);
        const uint32_t count = uint32_t(book.neighbours.size()) - first;
        if (object.remote.neighbourFirst == first && object.remote.neighbourCount == count)
            continue;
        object.remote.neighbourFirst = first;
        object.remote.neighbourCount = count;
        object.remoteSent = false;
    }
    std::erase_if(book.seen, [](const Seen& seen) { return !seen.used; });
    for (Seen& seen : book.seen) seen.used = false;
}

// What a fire of `from` sees of `to`, of 255.
uint32_t World::seenOf(uint32_t from, uint32_t to) {
    if (!def_.visibility) return 255;
    const Object &a = **objects_.at(from), &b = **objects_.at(to);
    const uint64_t key = pairOf(from, to);
    auto known =
        std::lower_bound(remote_.seen.begin(), remote_.seen.end(), key,
                         [](const Seen& seen, uint64_t wanted) { return seen.pair < wanted; });
    if (known == remote_.seen.end() || known->pair != key)
        known = remote_.seen.insert(known, Seen{key, {}, 255, true});
    known->used = true;
    if (known->versions[0] != a.remoteVersion || known->versions[1] != b.remoteVersion) {
        const float told = def_.visibility(def_.visibilityData, a.id, b.id);
        known->part = told > 0 ? uint32_t(std::lround(std::min(told, 1.0f) * 255)) : 0u;
        known->versions[0] = a.remoteVersion;
        known->versions[1] = b.remoteVersion;
    }
    return known->part;
}

namespace {

uint32_t burnMask(const components::BurnableMesh& object) noexcept {
    uint32_t mask = 0;
    for (uint32_t i = 0; i < components::kMaterials; ++i)
        if (components::burns(object, i)) mask |= 1u << i;
    return mask;
}

}  // namespace

// The contacts of one pair, one way.
void World::linkPair(const Object& to, const Object& from, uint32_t since,
                     std::pmr::vector<gpu::ContactLink>& out) {
    remote_.contacts.clear();
    mesh::findContacts({&domainOf(to), &to.remote, burnMask(to.data)},
                       {&domainOf(from), &from.remote, burnMask(from.data)}, remote_.contactPlaces,
                       remote_.contacts);
    for (const mesh::Contact& contact : remote_.contacts) {
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

void World::findLinks(uint32_t now) {
    RemoteBook& book = remote_;
    book.links.clear();
    if (!(book.flags & FW_WORLD_CONTACT)) return;
    try {
        linkPairs(now);
    } catch (...) {  // what links they have is not known: all are found anew
        for (PairContacts& pair : book.pairs) pair.versions[0] = pair.versions[1] = 0;
        throw;
    }
    book.pairLinks.swap(book.nextLinks);
    book.links.assign(book.pairLinks.begin(), book.pairLinks.end());
    std::erase_if(book.pairs, [](const PairContacts& pair) { return !pair.used; });
    for (PairContacts& pair : book.pairs) pair.used = false;
    std::sort(book.links.begin(), book.links.end(),
              [](const gpu::ContactLink& a, const gpu::ContactLink& b) {
                  return std::tie(a.object, a.texel, a.fromObject, a.fromTexel) <
                         std::tie(b.object, b.texel, b.fromObject, b.fromTexel);
              });
}

// Contacts of all pairs into nextLinks. One list has those of all: lists of their own, for pairs
// that come and go, would each grow to the largest that ever was in it.
void World::linkPairs(uint32_t now) {
    RemoteBook& book = remote_;
    book.nextLinks.clear();
    for (const uint64_t pair : book.near) {
        const auto first = uint32_t(pair >> 32), second = uint32_t(pair);
        if (first > second) continue;
        const Object &a = **objects_.at(first), &b = **objects_.at(second);
        if (mesh::gapOf(boxOf(a.remote), boxOf(b.remote)) > int(gpu::kContactGap)) continue;
        auto known = std::find_if(book.pairs.begin(), book.pairs.end(), [&](const auto& entry) {
            return entry.slots[0] == first && entry.slots[1] == second;
        });
        if (known == book.pairs.end()) {
            book.pairs.push_back({{first, second}});
            known = book.pairs.end() - 1;
        }
        known->used = true;
        const auto begin = uint32_t(book.nextLinks.size());
        if (known->versions[0] != a.remoteVersion || known->versions[1] != b.remoteVersion) {
            // Who only shifted while they touch has touched since then.
            const bool same = known->ids[0].index1 != 0 &&
                              known->ids[0].generation == a.id.generation &&
                              known->ids[1].generation == b.id.generation;
            const uint32_t since = same && known->touches ? known->since : now;
            linkPair(a, b, since, book.nextLinks);
            linkPair(b, a, since, book.nextLinks);
            known->since = since;
            known->touches = book.nextLinks.size() != begin;
            known->versions[0] = a.remoteVersion;
            known->versions[1] = b.remoteVersion;
            known->ids[0] = a.id;
            known->ids[1] = b.id;
        } else {
            const auto kept = book.pairLinks.begin() + std::ptrdiff_t(known->first);
            book.nextLinks.insert(book.nextLinks.end(), kept, kept + std::ptrdiff_t(known->count));
        }
        known->first = begin;
        known->count = uint32_t(book.nextLinks.size()) - begin;
    }
}

// awake: the step will run.
void World::planRemote(gpu::StepPlan& step, uint32_t now, bool awake) {
    if (!remoteOn()) return;
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
    findNeighbours();
    findLinks(now);
    if (frame_.remoteUsed == frame_.remote.size())
        frame_.remote.push_back(core::Owned<RemoteTables>::make(memory_, memory_));
    RemoteTables& tables = *frame_.remote[frame_.remoteUsed];
    tables.objects.clear();
    for (uint32_t slot = 0; slot < objects_.slotCount(); ++slot)
        if (auto* object = objects_.at(slot);
            object && (*object)->remoteVersion != 0 && !(*object)->remoteSent)
            tables.objects.push_back({slot, (*object)->remote});
    tables.neighbours.assign(remote_.neighbours.begin(), remote_.neighbours.end());
    tables.links.assign(remote_.links.begin(), remote_.links.end());
    tables.blockers.assign(remote_.blockers.begin(), remote_.blockers.end());
    tables.update = {tables.objects, tables.neighbours, tables.links, tables.blockers};
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
        object.planStamp = planStamp_;
        components::Latch latch = object.latch;
        components::resetLatch(object.data, driveInput(object, now), latch);
        latch.sent = object.latch.sent && components::sameDrive(object.data, latch, object.latch);
        frame_.latches.push_back({&object, latch, true});
    };
    if (remote_.flags & FW_WORLD_EMBERS) {
        for (uint32_t slot = 0; slot < objects_.slotCount(); ++slot)
            if (auto* object = objects_.at(slot); object && (*object)->remoteVersion != 0)
                add(slot);
        return;
    }
    const auto addNear = [&](const Object& object) {
        for (uint32_t i = 0; i < object.remote.neighbourCount; ++i)
            add(remote_.neighbours[object.remote.neighbourFirst + i] & kMaxNeighbourSlot);
    };
    for (const Object* object : touched_) addNear(*object);
    for (size_t i = 0; i < frame_.latches.size(); ++i) addNear(*frame_.latches[i].object);
}

void World::commitRemote() noexcept {
    if (frame_.shieldSent) shield_.unsent = false;
    if (frame_.remoteLatched) {
        for (const uint32_t slot : remote_.due) (*objects_.at(slot))->remoteDue = false;
        remote_.due.clear();
        remote_.blockersDue = false;
    }
    if (!frame_.remoteFlushed) return;
    for (size_t i = 0; i < frame_.remoteUsed; ++i)
        for (const gpu::RemoteUpdate::Placed& placed : frame_.remote[i]->objects)
            (*objects_.at(placed.object))->remoteSent = true;
    remote_.unsent = false;
}

void World::tellSpread(Object& object, const gpu::Readback& readback) noexcept {
    const gpu::ObjectCounters& now = object.counters;
    if (now.litTick != object.story.litTold) {
        object.story.litTold = now.litTick;
        ++object.changes;
        const uint32_t giver = gpu::giverOf(now.litBy);
        if (now.litTick != 0 && giver < objects_.slotCount() && objects_.at(giver)) {
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
        texelPosition(object, std::min(now.spotTexel, domainOf(object).texelCount() - 1), place);
        raise(FW_EVENT_SPOT_FIRE, &object, 0, readback.frameIndex, place,
              float(now.spots - object.story.spotsTold));
        object.story.spotsTold = now.spots;
        ++object.changes;
    }
}

}  // namespace fw::world
