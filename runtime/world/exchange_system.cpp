// Objects as others see them: poses become integers at fixed ticks, neighbours and contacts are
// found when something moved, and all of it goes to the backend with the step that begins there.
// The backend computes the heat.
#include "world/exchange_system.h"

#include "core/growth.h"
#include "fire/heat.h"
#include "mesh/exchange_tiles.h"
#include "world/persistence.h"
#include "world/shift.h"
#include "world/wind_system.h"

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

static_assert(FW_WORLD_RADIATION == gpu::kExchangeRadiation &&
              FW_WORLD_PLUME == gpu::kExchangePlume && FW_WORLD_CONTACT == gpu::kExchangeContact &&
              FW_WORLD_EMBERS == gpu::kExchangeEmbers);

constexpr double kGapSpeed = 0.05;        // m/s at which flames lick across a gap
constexpr double kBrandsPerJoule = 2e-6;  // embers that matter

mesh::Box boxOf(const gpu::ExchangeObject& o) noexcept {
    mesh::Box box;
    const int low[3] = {o.turn0.w, o.turn1.w, o.turn2.w};
    for (int i = 0; i < 3; ++i) {
        box.low[i] = low[i];
        box.high[i] = o.high[i];
    }
    return box;
}

void moveRecord(gpu::ExchangeObject& record, const double (&by)[3]) noexcept {
    gpu::ivec4* rows[] = {&record.row0, &record.row1, &record.row2};
    gpu::ivec4* lows[] = {&record.turn0, &record.turn1, &record.turn2};
    for (int i = 0; i < 3; ++i) {
        movePast(rows[i]->w, by[i]);
        movePast(lows[i]->w, by[i]);
        movePast(record.high[i], by[i]);
    }
}

bool sameRecord(const gpu::ExchangeObject& a, const gpu::ExchangeObject& b) noexcept {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

bool before(const gpu::ContactLink& a, const gpu::ContactLink& b) noexcept {
    return std::tie(a.texel, a.fromObject, a.fromTexel) <
           std::tie(b.texel, b.fromObject, b.fromTexel);
}

}  // namespace

ExchangeSystem::ExchangeSystem(const WorldContext& context, Scene& scene, const WindSystem& wind)
    : context_(context), scene_(scene), wind_(wind) {
    TransferState& book = state_.book;
    const FwWorldDef& def = context.def;
    book.governance = {def.spreadChance, def.maxHops, def.maxBurningTiles, def.timeToLive};
    book.capped = components::caps(book.governance);
    book.governed = components::governs(book.governance);
}

void ExchangeSystem::setFlags(uint32_t given) {
    context_.recorder.mayChange();
    if (given & ~kWorldFlags)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "flags is 0x%x; the known flags are 0x%x.", given,
                   kWorldFlags);
    const uint32_t flags = given & kHeatTransferModes;
    state_.book.objectFlags = given & ~kHeatTransferModes;
    state_.book.unsent |= flags != 0 && flags != state_.book.flags;
    state_.book.spreadKnown &= flags == state_.book.flags;
    constexpr uint32_t kWarm = FW_WORLD_RADIATION | FW_WORLD_PLUME;
    state_.book.warms |= (flags & kWarm) != 0;
    if (state_.book.flags & ~flags & kWarm)
        state_.book.fades = context_.clock.tick + 2 * gpu::kExchangeRounds * gpu::kExchangeTicks;
    state_.book.flags = flags;
    context_.recorder.record(SetFlags{given});
}

namespace {

// Their integers hold so much and no more; a larger one would stop less than the host sees of it.
void checkHeatOccluder(const components::Pose& pose, const float halfSize[3], const char* field) {
    for (int i = 0; i < 3; ++i) {
        const float half = halfSize[i] * pose.scale * std::abs(pose.stretch[i]);
        if (half > 30.0f * 1.0001f)
            core::fail(FW_ERROR_INVALID_ARGUMENT,
                       "%s makes the occluder " FW_LENGTH " " FW_LENGTH_UNIT
                       " to each side along its axis %d; the limit is " FW_LENGTH " " FW_LENGTH_UNIT
                       ". Put several side by side.",
                       field, double(half), i, 30.0);
    }
}

}  // namespace

FwHeatOccluderId ExchangeSystem::addHeatOccluder(const FwHeatOccluderDef& def) {
    ++scene_.geometryVersion;
    if (def.flags != 0 || def.reserved != 0)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "FwHeatOccluderDef::flags is 0x%x and reserved is %u; both are zero.", def.flags,
                   def.reserved);
    HeatOccluderEntry entry;
    entry.pose = components::makePose(def.transform, "FwHeatOccluderDef::transform");
    checkLengths(def.halfSize, 3, "FwHeatOccluderDef::halfSize", 0.0f, 30.0f);
    checkHeatOccluder(entry.pose, def.halfSize, "FwHeatOccluderDef::transform");
    std::copy_n(def.halfSize, 3, entry.halfSize);
    if (state_.occluders.live() >= gpu::kMaxHeatOccluders)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "%u occluders are in place; the limit is %u.",
                   state_.occluders.live(), gpu::kMaxHeatOccluders);
    const FwHeatOccluderId id = state_.occluders.create(entry);
    state_.book.occludersDue = true;
    return id;
}

void ExchangeSystem::moveHeatOccluder(FwHeatOccluderId id, const float transform[16]) {
    context_.recorder.mayChange();
    ++scene_.geometryVersion;
    HeatOccluderEntry& entry = state_.occluders.get(id);
    const components::Pose pose = components::makePose(transform, "transform");
    checkHeatOccluder(pose, entry.halfSize, "transform");
    entry.pose = pose;
    state_.book.occludersDue = true;
    context_.recorder.record(MoveHeatOccluder{id.index1 - 1, Transform(transform)});
}

void ExchangeSystem::removeHeatOccluder(FwHeatOccluderId id) {
    ++scene_.geometryVersion;
    state_.occluders.destroy(id);
    state_.book.occludersDue = true;
}

gpu::ExchangePush ExchangeSystem::rules() const noexcept {
    gpu::ExchangePush rules{};
    rules.flags = state_.book.flags;
    rules.warms = state_.book.warms ? 1 : 0;
    const auto up = [&](int i) { return int(std::lround(double(context_.def.up[i]) * 4096)); };
    rules.upX = up(0);
    rules.upY = up(1);
    rules.upZ = up(2);
    const fire::WindVector wind = fire::windUnits(wind_.state().wind);
    rules.windX = wind[0] * 1000 / 128;
    rules.windY = wind[1] * 1000 / 128;
    rules.windZ = wind[2] * 1000 / 128;
    rules.chance = components::chanceOf(state_.book.governance.chance);
    rules.hopsMost = components::limitOf(state_.book.governance.hopsMost);
    rules.maxTiles = components::limitOf(state_.book.governance.maxTiles);
    rules.lifeTicks = components::lifeTicksOf(state_.book.governance.life);
    rules.seed = context_.def.seed;
    rules.ambient = uint32_t(fire::kAmbient) * 16;  // 1/16 K
    const double perExchange = kBrandsPerJoule * double(context_.def.paceFactor) *
                               double(gpu::kExchangeTicks) / double(gpu::kTicksPerSecond);
    rules.brands = uint32_t(std::min(perExchange / 16 * 4294967296.0, 4e9));
    return rules;
}

// An object under another wind keeps its place and its contacts.
void ExchangeSystem::updateWind(Object& object, int wind) noexcept {
    if (object.exchangeVersion == 0 || wind == object.remote.high.w) return;
    object.remote.high.w = wind;
    markUnsent(object);
}

void ExchangeSystem::markUnsent(Object& object) noexcept {
    state_.book.unsent = true;
    if (!object.exchangeSent) return;
    object.exchangeSent = false;
    state_.book.unsentSlots.push_back(object.slot);  // capacity was reserved at its creation
}

// Copies the lists that a planned update points to, before they change.
void ExchangeSystem::keepPlanned() {
    if (frame_.used == 0) return;
    ExchangeTables& tables = *frame_.tables[frame_.used - 1];
    if (tables.update.neighbours.data() == state_.book.neighbours.pool().all().data()) {
        tables.neighbours.assign(tables.update.neighbours.begin(), tables.update.neighbours.end());
        tables.update.neighbours = tables.neighbours;
    }
    if (tables.update.links.data() == state_.book.links.all().data()) {
        tables.links.assign(tables.update.links.begin(), tables.update.links.end());
        tables.update.links = tables.links;
    }
}

void ExchangeSystem::latchPoses(uint32_t now) {
    for (const uint32_t slot : state_.book.due) {
        Object& object = scene_.objectAt(slot);
        const mesh::BurnDomain& domain = scene_.domainOf(object);
        gpu::ExchangeObject record{};
        components::placeExchangeObject(object.data.pose, domain, record);
        components::fillExchangeObject(object.data, domain, object.governance, record);
        if (object.texels == 0) record.flags &= ~gpu::kExchangeLive;
        record.high.w = int(wind_.localWindOf(object, now));
        record.neighbourFirst = object.remote.neighbourFirst;
        record.neighbourCount = object.remote.neighbourCount;
        updateWind(object, record.high.w);
        if (object.exchangeVersion != 0 && sameRecord(record, object.remote)) continue;
        keepPlanned();
        object.remote = record;
        object.reach = components::exchangeReach(object.data, domain,
                                                 scene_.meshes.at(object.data.meshSlot)->texelsOf);
        // Capacity for these was reserved at its creation.
        if (object.exchangeVersion == 0 && !object.touched) state_.book.waiting.push_back(slot);
        object.exchangeVersion = ++state_.book.version;
        markUnsent(object);
        if (!(record.flags & gpu::kExchangeLive) || slot > Neighbours::kSlot) continue;
        if (!object.contactsDue) state_.book.contactsDue.push_back(slot);
        object.contactsDue = true;
        if (context_.def.visibility && !object.seenDue) state_.book.seenDue.push_back(slot);
        object.seenDue = context_.def.visibility != nullptr;
        try {
            state_.book.neighbours.place(slot, boxOf(record), object.reach);
        } catch (...) {
            state_.book.rebuild = true;
            throw;
        }
    }
    state_.book.unsent |= !state_.book.neighbours.changed().empty();
    for (uint32_t slot = 0; wind_.hasGusts() && slot < scene_.objects.slotCount(); ++slot)
        if (auto* owned = scene_.objects.at(slot))
            updateWind(**owned, int(wind_.localWindOf(**owned, now)));
    if (!state_.book.occludersDue) return;
    state_.book.occluders.clear();
    for (auto [i, entry] : state_.occluders.entries()) {
        gpu::HeatOccluder occluder{};
        components::placeHeatOccluder(entry.pose, entry.halfSize, occluder);
        state_.book.occluders.push_back(occluder);
    }
    state_.book.unsent = true;
}

// All of it from the latched records and the pairs that are known: the lists are those of another
// world, or memory ended while they changed.
void ExchangeSystem::rebuild() {
    TransferState& book = state_.book;
    keepPlanned();
    book.unsent = true;
    book.spreadKnown = false;
    book.neighbours.clear();
    book.close.clear();
    book.links.clear();
    for (auto* lists : {&book.closeOf, &book.linksOf}) {
        core::growTo(*lists, scene_.objects.slotCount());
        lists->assign(scene_.objects.slotCount(), {});
    }
    for (auto* slots : {&book.unsentSlots, &book.contactsDue, &book.seenDue, &book.waiting})
        slots->clear();  // each keeps its capacity
    for (auto [slot, object] : scene_.objects.entries()) {
        const bool placed = object.exchangeVersion != 0;
        const bool meets =
            placed && object.remote.flags & gpu::kExchangeLive && slot <= Neighbours::kSlot;
        object.exchangeSent = !placed;
        object.contactsDue = meets;
        object.seenDue = meets && context_.def.visibility;
        if (placed) book.unsentSlots.push_back(slot);
        if (placed && !object.touched) book.waiting.push_back(slot);
        if (object.contactsDue) book.contactsDue.push_back(slot);
        if (object.seenDue) book.seenDue.push_back(slot);
        if (meets) book.neighbours.place(slot, boxOf(object.remote), object.reach);
    }
    std::erase_if(book.pairs, [&](const PairContacts& pair) {
        for (int k = 0; k < 2; ++k) {
            const auto* owned = scene_.objects.at(pair.slots[k]);
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
    restoreSeen();
    book.rebuild = false;
}

// The host's answers of saved pairs hold. An object without any was elsewhere since the host was
// asked about it: it is asked when the world awakes, as it would have been.
void ExchangeSystem::restoreSeen() {
    TransferState& book = state_.book;
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
        scene_.objectAt(slot).seenDue = due;
        return !due;
    });
    book.loadedSeen.clear();
}

// Pairs of which the host has been asked since one of them was elsewhere, by slots.
void ExchangeSystem::recordSeen(std::pmr::vector<Seen>& to) const {
    const TransferState& book = state_.book;
    if (!context_.def.visibility) return;
    if (book.rebuild) {
        for (const Seen& seen : book.loadedSeen)
            if (scene_.objects.at(seen.slots[0]) && scene_.objects.at(seen.slots[1]))
                to.push_back({{seen.slots[0], seen.slots[1]}, seen.part});
        return;
    }
    for (auto [slot, owned] : scene_.objects.entries()) {
        if (owned.seenDue) continue;
        for (const uint32_t entry : book.neighbours.of(slot)) {
            const uint32_t other = entry & Neighbours::kSlot;
            if (!scene_.objectAt(other).seenDue) to.push_back({{slot, other}, entry >> 24});
        }
    }
}

// How much of `to` a fire of `from` sees, of 255.
uint32_t ExchangeSystem::seenPart(const Object& from, const Object& to) const {
    const float answer = context_.def.visibility(context_.def.visibilityData, from.id, to.id);
    return answer > 0 ? uint32_t(std::lround(std::min(answer, 1.0f) * 255)) : 0u;
}

// In both directions between objects that moved and all their neighbours.
void ExchangeSystem::queryVisibility() {
    TransferState& book = state_.book;
    for (const uint32_t slot : book.seenDue) {
        const Object& object = scene_.objectAt(slot);
        for (const uint32_t entry : book.neighbours.of(slot)) {
            const Object& other = scene_.objectAt(entry & Neighbours::kSlot);
            if (other.seenDue && other.slot < slot) continue;  // asked with that one
            book.neighbours.see(slot, other.slot, seenPart(other, object));
            book.neighbours.see(other.slot, slot, seenPart(object, other));
        }
    }
    for (const uint32_t slot : book.seenDue) scene_.objectAt(slot).seenDue = false;
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

// The links of one pair, in one direction.
void ExchangeSystem::linkPair(const Object& to, const Object& from,
                              std::span<const mesh::Contact> contacts, uint32_t since,
                              std::pmr::vector<gpu::ContactLink>& out) {
    for (const mesh::Contact& contact : contacts) {
        const FwMaterialDef& def =
            to.data.materials[scene_.domainOf(to).texels[contact.texel].materialFlags &
                              (gpu::kMaterialsPerObject - 1)];
        // An ordinary link of that length, and the flame's time across.
        const double metres = contact.gap / 1000.0;
        const double seconds =
            (metres / std::max(double(def.spreadRate), 1e-6) + metres / kGapSpeed) /
            double(context_.def.paceFactor);
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
void ExchangeSystem::findLinks(uint32_t now) {
    TransferState& book = state_.book;
    if (!(book.flags & FW_WORLD_CONTACT)) return;
    for (auto* lists : {&book.closeOf, &book.linksOf})
        if (lists->size() < scene_.objects.slotCount()) {
            core::growTo(*lists, scene_.objects.slotCount());
            lists->resize(scene_.objects.slotCount());
        }
    for (const uint32_t slot : book.contactsDue) linkClose(scene_.objectAt(slot), now);
    for (const uint32_t slot : book.contactsDue) scene_.objectAt(slot).contactsDue = false;
    book.contactsDue.clear();
}

// The contacts of one object with all that are so near.
void ExchangeSystem::linkClose(Object& object, uint32_t now) {
    TransferState& book = state_.book;
    const uint64_t stamp = ++book.contactStamp;
    const auto meet = [&](uint32_t other) {
        if (mesh::gapOf(boxOf(object.remote), boxOf(scene_.objectAt(other).remote)) >
            int(gpu::kContactGap))
            return;
        const Object& a = object.slot < other ? object : scene_.objectAt(other);
        const Object& b = object.slot < other ? scene_.objectAt(other) : object;
        PairContacts& pair = book.pairs[closePair(a.slot, b.slot)];
        pair.stamp = stamp;
        if (pair.versions[0] == a.exchangeVersion && pair.versions[1] == b.exchangeVersion) return;
        pair.versions[0] = pair.versions[1] = 0;  // until all of it is there
        // Objects that only shifted while they touch keep the tick of their first touch.
        const bool same = pair.ids[0].index1 != 0 && pair.ids[0].generation == a.id.generation &&
                          pair.ids[1].generation == b.id.generation;
        const uint32_t since = same && pair.touches ? pair.since : now;
        dropLinks(a.slot, b.slot);
        dropLinks(b.slot, a.slot);
        const Object* const both[2] = {&a, &b};
        mesh::findContacts({{&scene_.domainOf(a), &a.remote, burnMask(a.data)},
                            {&scene_.domainOf(b), &b.remote, burnMask(b.data)}},
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
        pair.versions[0] = a.exchangeVersion;
        pair.versions[1] = b.exchangeVersion;
        book.links.fit(book.linksOf[other]);
    };
    // Where all objects are latched as they stand now, the few that are so near are found among
    // all; else among its neighbours, which are many.
    if (book.due.empty() || frame_.latched) {
        const mesh::Box box = boxOf(object.remote);
        for (const uint32_t other : scene_.objectsNear(box, 0.001f * float(gpu::kContactGap))) {
            const Object& o = scene_.objectAt(other);
            if (other != object.slot && o.exchangeVersion != 0 &&
                o.remote.flags & gpu::kExchangeLive && other <= Neighbours::kSlot)
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

void ExchangeSystem::addClose(uint32_t slot, uint32_t other, uint32_t pair) {
    ListPlace& list = state_.book.closeOf[slot];
    state_.book.close.reserve(list, list.count + 1);
    state_.book.close.insert(list, closeIndex(state_.book.close.of(list), other), {other, pair});
}

// Their pair, which may be new.
uint32_t ExchangeSystem::closePair(uint32_t a, uint32_t b) {
    TransferState& book = state_.book;
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

// The two are apart, or one of them is gone.
void ExchangeSystem::dropPair(uint32_t pair) noexcept {
    TransferState& book = state_.book;
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

void ExchangeSystem::dropLinks(uint32_t to, uint32_t from) noexcept {
    ListPlace& place = state_.book.linksOf[to];
    const std::span<gpu::ContactLink> list = state_.book.links.of(place);
    const auto end = std::remove_if(list.begin(), list.end(), [&](const gpu::ContactLink& link) {
        return link.fromObject == from;
    });
    if (end == list.end()) return;
    std::fill(end, list.end(), TransferState::noLink());
    state_.book.links.mark(place.first, place.count);
    place.count = uint32_t(end - list.begin());
}

void ExchangeSystem::addLinks(uint32_t to, std::span<gpu::ContactLink> fresh) {
    if (fresh.empty()) return;
    TransferState& book = state_.book;
    ListPlace& place = book.linksOf[to];
    std::sort(fresh.begin(), fresh.end(), before);
    const std::span<const gpu::ContactLink> list = book.links.of(place);
    book.mergedLinks.clear();
    std::merge(list.begin(), list.end(), fresh.begin(), fresh.end(),
               std::back_inserter(book.mergedLinks), before);
    book.links.reserve(place, uint32_t(book.mergedLinks.size()));
    book.links.assign(place, book.mergedLinks);
}

// The next object in its slot does not inherit its contacts. The backend gets the change before the
// next exchange.
void ExchangeSystem::forgetObject(const Object& object) noexcept {
    countGoverned(object, false);
    removeFromShield(object.slot);
    TransferState& book = state_.book;
    book.unsent |= object.exchangeVersion != 0;
    const uint32_t slot = object.slot;
    const auto leave = [&](std::pmr::vector<uint32_t>& slots, bool in) {
        if (in || book.rebuild) std::erase(slots, slot);
    };
    leave(book.due, object.exchangeDue);
    leave(book.unsentSlots, !object.exchangeSent);
    leave(book.waiting, object.exchangeVersion != 0);
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
void ExchangeSystem::plan(gpu::StepPlan& step, uint32_t now, bool awake) {
    if (!isOn()) return;
    if (state_.book.rebuild) rebuild();
    step.rules = rules();
    step.exchange = step.reduce;
    step.governed = state_.book.governed;
    step.capped = state_.book.capped;
    if (now % gpu::kExchangeTicks == 0) {
        latchPoses(now);
        frame_.latched = true;
    }
    planOcclusion(step, awake);
    if (!awake || !state_.book.unsent) return;
    if (frame_.flushed && now % gpu::kExchangeTicks != 0) return;
    keepPlanned();
    queryVisibility();
    findLinks(now);
    for (const uint32_t slot : state_.book.neighbours.changed()) {
        auto* owned = scene_.objects.at(slot);
        if (!owned) continue;
        Object& object = **owned;
        const ListPlace list = state_.book.neighbours.listOf(slot);
        if (object.remote.neighbourFirst == list.first &&
            object.remote.neighbourCount == list.count)
            continue;
        object.remote.neighbourFirst = list.first;
        object.remote.neighbourCount = list.count;
        if (object.exchangeVersion != 0) markUnsent(object);
    }
    if (frame_.used == frame_.tables.size())
        frame_.tables.push_back(
            core::Owned<ExchangeTables>::make(context_.memory, context_.memory));
    ExchangeTables& tables = *frame_.tables[frame_.used];
    tables.objects.clear();
    core::growTo(tables.objects, state_.book.unsentSlots.size());
    for (const uint32_t slot : state_.book.unsentSlots)
        tables.objects.push_back({slot, scene_.objectAt(slot).remote});
    state_.book.neighbours.pool().listChanges(tables.neighbourRanges);
    state_.book.links.listChanges(tables.linkRanges);
    tables.occluders.assign(state_.book.occluders.begin(), state_.book.occluders.end());
    tables.update = {tables.objects,         state_.book.neighbours.pool().all(),
                     tables.neighbourRanges, state_.book.links.all(),
                     tables.linkRanges,      tables.occluders};
    step.remote = &tables.update;
    ++frame_.used;
    frame_.flushed = true;
}

// After all that the frame reached was touched.
void ExchangeSystem::commit(bool spreadFound, bool waitersTouched) noexcept {
    if (frame_.occlusionSent) state_.shield.unsent = false;
    if (frame_.latched) {
        for (const uint32_t slot : state_.book.due) scene_.objectAt(slot).exchangeDue = false;
        state_.book.due.clear();
        state_.book.occludersDue = false;
    }
    state_.book.spreadKnown |= spreadFound;
    if (waitersTouched)
        std::erase_if(state_.book.waiting,
                      [&](uint32_t slot) { return scene_.objectAt(slot).touched; });
    if (!frame_.flushed) return;
    for (const uint32_t slot : state_.book.unsentSlots) scene_.objectAt(slot).exchangeSent = true;
    state_.book.unsentSlots.clear();
    state_.book.neighbours.settle();
    state_.book.links.settle();
    state_.book.unsent = false;
}

// The world is governed while an object or its def limits fire.
void ExchangeSystem::countGoverned(const Object& object, bool more) noexcept {
    state_.book.cappedObjects += components::caps(object.governance) ? (more ? 1u : ~0u) : 0u;
    state_.book.governedObjects += components::governs(object.governance) ? (more ? 1u : ~0u) : 0u;
    state_.book.capped = state_.book.cappedObjects != 0 || components::caps(state_.book.governance);
    state_.book.governed =
        state_.book.governedObjects != 0 || components::governs(state_.book.governance);
}

void ExchangeSystem::onCounters(Object& object, const gpu::Readback& readback) noexcept {
    const gpu::ObjectCounters& now = object.counters;
    if (now.litTick != object.lifecycle.litReported) {
        object.lifecycle.litReported = now.litTick;
        ++object.changes;
        const uint32_t giver = gpu::igniterOf(now.litBy);
        // A slot may be another's since.
        const auto* by = giver < scene_.objects.slotCount() ? scene_.objects.at(giver) : nullptr;
        if (now.litTick != 0 && by && (*by)->firstFrame <= readback.frameIndex) {
            const gpu::ExchangeObject& box = object.remote;
            const int low[3] = {box.turn0.w, box.turn1.w, box.turn2.w};
            float middle[3];
            for (int i = 0; i < 3; ++i)
                middle[i] = float(double(low[i]) + double(box.high[i])) / 2000.0f;
            context_.raise(FW_EVENT_SPREAD_TO, &object, gpu::hopsOf(now.litBy), readback.frameIndex,
                           middle, float(double(now.litTick) / gpu::kTicksPerSecond),
                           scene_.objects.idOf(giver));
        }
    }
    if (now.spots != object.lifecycle.spotsReported) {
        float place[3];
        const uint32_t texel = now.spotTexel & ~gpu::kSpotFresh;
        scene_.texelPosition(object, std::min(texel, scene_.domainOf(object).texelCount() - 1),
                             place);
        context_.raise(FW_EVENT_SPOT_FIRE, &object, 0, readback.frameIndex, place,
                       float(now.spots - object.lifecycle.spotsReported));
        object.lifecycle.spotsReported = now.spots;
        ++object.changes;
    }
}

void ExchangeSystem::beginFrame() noexcept {
    frame_.used = 0;
    frame_.latched = frame_.flushed = frame_.occlusionSent = false;
}

void ExchangeSystem::markMoved(Object& object) noexcept {
    if (object.exchangeDue) return;  // at most once each: capacity was reserved at its creation
    object.exchangeDue = true;
    state_.book.due.push_back(object.slot);
}

void ExchangeSystem::addObject(const Object& object) noexcept {
    state_.book.due.push_back(object.slot);
    countGoverned(object, true);
}

void ExchangeSystem::reserveSlots() {
    TransferState& book = state_.book;
    for (auto* slots :
         {&book.due, &book.unsentSlots, &book.waiting, &book.contactsDue, &book.seenDue})
        core::growTo(*slots, scene_.objects.slotCount());
}

void ExchangeSystem::checkShift(const double (&by)[3]) const {
    for (auto [i, occluder] : state_.occluders.entries())
        checkMoved(occluder.pose.translation, by, "occluder", i);
    if (state_.shield.grid.shape.cells() != 0)
        checkMillimetres(state_.shield.grid.shape.origin, by, "heat shield", 0);
}

std::pmr::vector<Seen> ExchangeSystem::recordedSeen() const {
    std::pmr::vector<Seen> seen(context_.memory);
    recordSeen(seen);
    return seen;
}

// The host's answers about sight hold; the lists of neighbours are built again.
void ExchangeSystem::shiftOrigin(const double (&by)[3]) noexcept {
    for (auto [i, owned] : scene_.objects.entries())
        if (owned.exchangeVersion != 0) moveRecord(owned.remote, by);
    TransferState& book = state_.book;
    book.rebuild = book.unsent = true;  // its grid is of the places before
    for (auto [i, occluder] : state_.occluders.entries()) moveBy(occluder.pose.translation, by);
    for (gpu::HeatOccluder& occluder : book.occluders) {
        gpu::ivec4* turns[] = {&occluder.turn0, &occluder.turn1, &occluder.turn2};
        for (int i = 0; i < 3; ++i) movePast(turns[i]->w, by[i]);
    }
    if (state_.shield.grid.shape.cells() == 0) return;
    moveMillimetres(state_.shield.grid.shape.origin, by);
    state_.shield.unsent = state_.shield.unpacked = true;
}

ExchangeSystem::Memory ExchangeSystem::memory() const noexcept {
    Memory bytes;
    bytes.neighbours = state_.book.neighbours.bytes();
    for (const auto& tables : frame_.tables)
        bytes.neighbours += tables->objects.capacity() * sizeof(gpu::ExchangeUpdate::Placed) +
                            tables->neighbours.capacity() * sizeof(uint32_t);
    bytes.contacts = state_.book.links.bytes() + state_.book.close.bytes() +
                     state_.book.pairs.capacity() * sizeof(PairContacts);
    return bytes;
}

}  // namespace fw::world
