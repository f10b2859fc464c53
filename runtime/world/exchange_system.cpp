// Objects as others see them: poses become integers at fixed ticks, neighbours and contacts are
// found when something moved, and all of it goes to the backend with the step that begins there.
// The backend computes the heat.
#include "world/exchange_system.h"

#include "core/growth.h"
#include "fire/heat.h"
#include "mesh/exchange_tiles.h"
#include "world/recording.h"
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
    const int low[3] = {o.rotation0.w, o.rotation1.w, o.rotation2.w};
    for (int i = 0; i < 3; ++i) {
        box.low[i] = low[i];
        box.high[i] = o.high[i];
    }
    return box;
}

void moveRecord(gpu::ExchangeObject& record, const double (&by)[3]) noexcept {
    gpu::ivec4* rows[] = {&record.row0, &record.row1, &record.row2};
    gpu::ivec4* lows[] = {&record.rotation0, &record.rotation1, &record.rotation2};
    for (int i = 0; i < 3; ++i) {
        movePast(rows[i]->w, by[i]);
        movePast(lows[i]->w, by[i]);
        movePast(record.high[i], by[i]);
    }
}

template <class T>
bool bySlots(const T& a, const T& b) noexcept {
    return std::tie(a.slots[0], a.slots[1]) < std::tie(b.slots[0], b.slots[1]);
}

bool before(const gpu::ContactLink& a, const gpu::ContactLink& b) noexcept {
    return std::tie(a.texel, a.fromObject, a.fromTexel) <
           std::tie(b.texel, b.fromObject, b.fromTexel);
}

}  // namespace

ExchangeSystem::ExchangeSystem(const WorldContext& context, Scene& scene, const WindSystem& wind)
    : context_(context), scene_(scene), wind_(wind) {
    const FwWorldDef& def = context.def;
    transfer_.governance = {def.spreadChance, def.maxHops, def.maxBurningTiles, def.timeToLive};
}

void ExchangeSystem::setFlags(uint32_t given) {
    context_.recorder.mayChange();
    if (given & ~kWorldFlags)
        core::refuse("flags is 0x%x; the known flags are 0x%x.", given, kWorldFlags);
    const uint32_t flags = given & kHeatTransferModes;
    transfer_.objectFlags = given & ~kHeatTransferModes;
    transfer_.unsent |= flags != 0 && flags != transfer_.flags;
    transfer_.spreadKnown &= flags == transfer_.flags;
    constexpr uint32_t kWarm = FW_WORLD_RADIATION | FW_WORLD_PLUME;
    transfer_.warms |= (flags & kWarm) != 0;
    if (transfer_.flags & ~flags & kWarm)
        transfer_.fades = context_.clock.tick + 2 * gpu::kExchangeRounds * gpu::kExchangeTicks;
    transfer_.flags = flags;
    context_.recorder.record(SetFlags{given});
}

namespace {

// Their integers hold so much and no more; a larger one would stop less than the host sees of it.
void checkHeatOccluder(const components::Pose& pose, const float halfSize[3], const char* field) {
    for (int i = 0; i < 3; ++i) {
        const float half = halfSize[i] * pose.scale * std::abs(pose.stretch[i]);
        if (half > 30.0f * 1.0001f)
            core::refuse("%s makes the occluder " FW_LENGTH " " FW_LENGTH_UNIT
                         " to each side along its axis %d; the limit is " FW_LENGTH
                         " " FW_LENGTH_UNIT ". Put several side by side.",
                         field, double(half), i, 30.0);
    }
}

}  // namespace

FwHeatOccluderId ExchangeSystem::addHeatOccluder(const FwHeatOccluderDef& def) {
    ++scene_.geometryVersion;
    if (def.flags != 0 || def.reserved != 0)
        core::refuse("FwHeatOccluderDef::flags is 0x%x and reserved is %u; both are zero.",
                     def.flags, def.reserved);
    HeatOccluderEntry entry;
    entry.pose = components::makePose(def.transform, "FwHeatOccluderDef::transform");
    checkLengths(def.halfSize, 3, "FwHeatOccluderDef::halfSize", 0.0f, 30.0f);
    checkHeatOccluder(entry.pose, def.halfSize, "FwHeatOccluderDef::transform");
    std::copy_n(def.halfSize, 3, entry.halfSize);
    checkRoom(occluders_, gpu::kMaxHeatOccluders, "occluders");
    const FwHeatOccluderId id = occluders_.create(entry);
    transfer_.occludersDue = true;
    return id;
}

void ExchangeSystem::moveHeatOccluder(FwHeatOccluderId id, const float transform[16]) {
    context_.recorder.mayChange();
    ++scene_.geometryVersion;
    HeatOccluderEntry& entry = occluders_.get(id);
    const components::Pose pose = components::makePose(transform, "transform");
    checkHeatOccluder(pose, entry.halfSize, "transform");
    entry.pose = pose;
    transfer_.occludersDue = true;
    context_.recorder.record(MoveHeatOccluder{{id.index1 - 1, Transform(transform)}});
}

void ExchangeSystem::removeHeatOccluder(FwHeatOccluderId id) {
    ++scene_.geometryVersion;
    occluders_.destroy(id);
    transfer_.occludersDue = true;
}

gpu::ExchangePush ExchangeSystem::rules() const noexcept {
    gpu::ExchangePush rules{};
    rules.flags = transfer_.flags;
    rules.warms = transfer_.warms ? 1 : 0;
    const auto up = [&](int i) { return int(std::lround(double(context_.def.up[i]) * 4096)); };
    rules.upX = up(0);
    rules.upY = up(1);
    rules.upZ = up(2);
    const fire::WindVector wind = fire::windUnits(wind_.state().wind);
    rules.windX = wind[0] * 1000 / 128;
    rules.windY = wind[1] * 1000 / 128;
    rules.windZ = wind[2] * 1000 / 128;
    rules.chance = components::chanceOf(transfer_.governance.chance);
    rules.hopsMost = components::limitOf(transfer_.governance.hopsMost);
    rules.maxTiles = components::limitOf(transfer_.governance.maxTiles);
    rules.lifeTicks = components::lifeTicksOf(transfer_.governance.life);
    rules.seed = context_.def.seed;
    rules.ambient = uint32_t(fire::kAmbient) * 16;  // 1/16 K
    const double perExchange = kBrandsPerJoule * double(context_.def.paceFactor) *
                               double(gpu::kExchangeTicks) / double(gpu::kTicksPerSecond);
    rules.brands = uint32_t(std::min(perExchange / 16 * 4294967296.0, 4e9));
    return rules;
}

// An object under another wind keeps its place and its contacts.
void ExchangeSystem::updateWind(Object& object, int wind) noexcept {
    if (object.exchangeVersion == 0 || wind == object.exchangeObject.high.w) return;
    object.exchangeObject.high.w = wind;
    markUnsent(object);
}

void ExchangeSystem::markUnsent(Object& object) noexcept {
    transfer_.unsent = true;
    transfer_.unsentSlots.add(object.slot);
}

// Copies the lists that a planned update points to, before they change.
void ExchangeSystem::keepPlanned() {
    if (frame_.used == 0) return;
    ExchangeTables& tables = *frame_.tables[frame_.used - 1];
    if (tables.update.neighbours.data() == transfer_.neighbours.pool().all().data()) {
        tables.neighbours.assign(tables.update.neighbours.begin(), tables.update.neighbours.end());
        tables.update.neighbours = tables.neighbours;
    }
    if (tables.update.links.data() == transfer_.links.all().data()) {
        tables.links.assign(tables.update.links.begin(), tables.update.links.end());
        tables.update.links = tables.links;
    }
}

gpu::ExchangeObject ExchangeSystem::recordOf(const Object& object) const noexcept {
    const mesh::BurnDomain& domain = scene_.domainOf(object);
    gpu::ExchangeObject record{};
    components::placeExchangeObject(object.data.pose, domain, record);
    components::fillExchangeObject(object.data, domain, object.governance, record);
    if (object.texels == 0) record.flags &= ~gpu::kExchangeLive;
    return record;
}

void ExchangeSystem::updateReach(Object& object) noexcept {
    object.reach = components::exchangeReach(object.data, scene_.domainOf(object),
                                             scene_.meshes.at(object.data.meshSlot)->texelsOf);
}

void ExchangeSystem::latchPoses(uint32_t now) {
    for (const uint32_t slot : scene_.moved) {
        Object& object = scene_.objectAt(slot);
        gpu::ExchangeObject record = recordOf(object);
        record.high.w = int(wind_.localWindOf(object, now));
        record.neighbourFirst = object.exchangeObject.neighbourFirst;
        record.neighbourCount = object.exchangeObject.neighbourCount;
        updateWind(object, record.high.w);
        if (object.exchangeVersion != 0 &&
            std::memcmp(&record, &object.exchangeObject, sizeof record) == 0)
            continue;
        keepPlanned();
        object.exchangeObject = record;
        updateReach(object);
        if (object.exchangeVersion == 0 && !object.touched) transfer_.waiting.add(slot);
        object.exchangeVersion = ++transfer_.version;
        markUnsent(object);
        if (!(record.flags & gpu::kExchangeLive) || slot > Neighbours::kSlot) continue;
        transfer_.contactsDue.add(slot);
        if (context_.def.visibility) transfer_.seenDue.add(slot);
        try {
            transfer_.neighbours.place(slot, boxOf(record), object.reach);
        } catch (...) {
            transfer_.rebuild = true;
            throw;
        }
    }
    transfer_.unsent |= !transfer_.neighbours.changed().empty();
    if (wind_.hasGusts())
        for (auto [slot, object] : scene_.objects.entries())
            updateWind(object, int(wind_.localWindOf(object, now)));
    if (!transfer_.occludersDue) return;
    transfer_.occluders.clear();
    for (auto [i, entry] : occluders_.entries()) {
        gpu::HeatOccluder occluder{};
        components::placeHeatOccluder(entry.pose, entry.halfSize, occluder);
        transfer_.occluders.push_back(occluder);
    }
    transfer_.unsent = true;
}

// All of it from the latched records and the pairs that are known: the lists are those of another
// world, or memory ended while they changed.
void ExchangeSystem::rebuild() {
    keepPlanned();
    transfer_.unsent = true;
    transfer_.spreadKnown = false;
    transfer_.neighbours.clear();
    transfer_.close.clear();
    transfer_.links.clear();
    addLinkLists();
    for (SlotSet* set : slotSets()) set->clear();
    for (auto [slot, object] : scene_.objects.entries()) {
        const bool placed = object.exchangeVersion != 0;
        const bool meets =
            placed && object.exchangeObject.flags & gpu::kExchangeLive && slot <= Neighbours::kSlot;
        if (placed) transfer_.unsentSlots.add(slot);
        if (placed && !object.touched) transfer_.waiting.add(slot);
        if (meets) transfer_.contactsDue.add(slot);
        if (meets && context_.def.visibility) transfer_.seenDue.add(slot);
        if (meets) transfer_.neighbours.place(slot, boxOf(object.exchangeObject), object.reach);
    }
    std::erase_if(transfer_.pairs, [&](const PairContacts& pair) {
        for (int k = 0; k < 2; ++k) {
            const auto* owned = scene_.objects.at(pair.slots[k]);
            if (!owned || (*owned)->id.generation != pair.ids[k].generation) return true;
        }
        return false;
    });
    for (uint32_t i = 0; i < transfer_.pairs.size(); ++i) {
        PairContacts& pair = transfer_.pairs[i];
        pair.versions[0] = pair.versions[1] = 0;
        pair.stamp = 0;
        addClose(i);
    }
    restoreSeen();
    transfer_.rebuild = false;
}

// The host's answers of saved pairs hold. An object without any was elsewhere since the host was
// asked about it: it is asked when the world awakes, as it would have been.
void ExchangeSystem::restoreSeen() {
    transfer_.seenDue.eraseIf([&](uint32_t slot) {
        bool due = false, holds = false;
        for (const uint32_t entry : transfer_.neighbours.of(slot)) {
            const Seen wanted{{slot, entry & Neighbours::kSlot}};
            const auto known = std::lower_bound(transfer_.loadedSeen.begin(),
                                                transfer_.loadedSeen.end(), wanted, bySlots<Seen>);
            due = true;
            if (known == transfer_.loadedSeen.end() || bySlots(wanted, *known)) continue;
            holds = true;
            transfer_.neighbours.see(slot, wanted.slots[1], known->part);
        }
        return !due || holds;
    });
    transfer_.loadedSeen.clear();
}

// Pairs of which the host has been asked since one of them was elsewhere, by slots.
void ExchangeSystem::recordSeen(std::pmr::vector<Seen>& to) const {
    if (!context_.def.visibility) return;
    if (transfer_.rebuild) {
        for (const Seen& seen : transfer_.loadedSeen)
            if (scene_.objects.at(seen.slots[0]) && scene_.objects.at(seen.slots[1]))
                to.push_back({{seen.slots[0], seen.slots[1]}, seen.part});
        return;
    }
    for (auto [slot, owned] : scene_.objects.entries()) {
        if (transfer_.seenDue.has(slot)) continue;
        for (const uint32_t entry : transfer_.neighbours.of(slot)) {
            const uint32_t other = entry & Neighbours::kSlot;
            if (!transfer_.seenDue.has(other)) to.push_back({{slot, other}, entry >> 24});
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
    for (const uint32_t slot : transfer_.seenDue.slots()) {
        const Object& object = scene_.objectAt(slot);
        for (const uint32_t entry : transfer_.neighbours.of(slot)) {
            const Object& other = scene_.objectAt(entry & Neighbours::kSlot);
            if (other.slot < slot && transfer_.seenDue.has(other.slot))
                continue;  // asked with that
            transfer_.neighbours.see(slot, other.slot, seenPart(other, object));
            transfer_.neighbours.see(other.slot, slot, seenPart(object, other));
        }
    }
    transfer_.seenDue.clear();
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
void ExchangeSystem::addLinks(const Object& to, const Object& from,
                              std::span<const mesh::Contact> contacts, uint32_t since) {
    std::pmr::vector<gpu::ContactLink>&fresh = transfer_.fresh, &merged = transfer_.merged;
    fresh.clear();
    for (const mesh::Contact& contact : contacts) {
        const FwMaterialDef& def = to.data.materials[scene_.texelMaterial(to, contact.texel)];
        // An ordinary link of that length, and the flame's time across.
        const double metres = contact.gap / 1000.0;
        const double seconds =
            (metres / std::max(double(def.spreadRate), 1e-6) + metres / kGapSpeed) /
            double(context_.def.paceFactor);
        FW_ASSERT(scene_.domainOf(to).real(contact.texel), "texel %u", contact.texel);
        gpu::ContactLink link{};
        link.object = to.slot;
        link.texel = contact.texel;
        link.fromObject = from.slot;
        link.fromTexel = contact.fromTexel;
        link.delay = uint32_t(std::min(seconds * gpu::kTicksPerSecond, 1e9));
        link.since = since;
        fresh.push_back(link);
    }
    if (fresh.empty()) return;
    std::sort(fresh.begin(), fresh.end(), before);
    merged.clear();
    std::ranges::merge(transfer_.links.of(to.slot), fresh, std::back_inserter(merged), before);
    transfer_.links.assign(to.slot, merged);
}

// Of objects that were latched since the last time. What memory refuses comes with the next call.
void ExchangeSystem::findLinks(uint32_t now) {
    if (!(transfer_.flags & FW_WORLD_CONTACT)) return;
    addLinkLists();
    for (const uint32_t slot : transfer_.contactsDue.slots()) linkClose(scene_.objectAt(slot), now);
    transfer_.contactsDue.clear();
}

// The contacts of one object with all that are so near.
void ExchangeSystem::linkClose(Object& object, uint32_t now) {
    const uint64_t stamp = ++transfer_.contactStamp;
    const auto meet = [&](uint32_t other) {
        if (mesh::gapOf(boxOf(object.exchangeObject),
                        boxOf(scene_.objectAt(other).exchangeObject)) > int(gpu::kContactGap))
            return;
        const Object& a = object.slot < other ? object : scene_.objectAt(other);
        const Object& b = object.slot < other ? scene_.objectAt(other) : object;
        PairContacts& pair = transfer_.pairs[closePair(a.slot, b.slot)];
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
        mesh::findContacts({{&scene_.domainOf(a), &a.exchangeObject, burnMask(a.data)},
                            {&scene_.domainOf(b), &b.exchangeObject, burnMask(b.data)}},
                           transfer_.contacts);
        for (int k = 0; k < 2; ++k)
            addLinks(*both[k], *both[1 - k], transfer_.contacts.found[k], since);
        pair.since = since;
        pair.touches = !transfer_.contacts.found[0].empty() || !transfer_.contacts.found[1].empty();
        pair.ids[0] = a.id;
        pair.ids[1] = b.id;
        pair.versions[0] = a.exchangeVersion;
        pair.versions[1] = b.exchangeVersion;
        transfer_.links.fit(other);
    };
    // Where all objects are latched as they stand now, the few that are so near are found among
    // all; else among its neighbours, which are many.
    if (scene_.moved.empty() || frame_.latched) {
        const mesh::Box box = boxOf(object.exchangeObject);
        for (const uint32_t other : scene_.objectsNear(box, 0.001f * float(gpu::kContactGap))) {
            const Object& o = scene_.objectAt(other);
            if (other != object.slot && o.exchangeVersion != 0 &&
                o.exchangeObject.flags & gpu::kExchangeLive && other <= Neighbours::kSlot)
                meet(other);
        }
    } else {
        for (const uint32_t entry : transfer_.neighbours.of(object.slot))
            meet(entry & Neighbours::kSlot);
    }
    for (size_t i = transfer_.close.of(object.slot).size(); i-- > 0;)
        if (const CloseObject gone = transfer_.close.of(object.slot)[i];
            transfer_.pairs[gone.pair].stamp != stamp) {
            dropPair(gone.pair);
            transfer_.links.fit(gone.slot);
        }
    transfer_.links.fit(object.slot);
}

void ExchangeSystem::addLinkLists() {
    transfer_.close.addLists(scene_.objects.slotCount());
    transfer_.links.addLists(scene_.objects.slotCount());
}

uint32_t ExchangeSystem::closeIndex(uint32_t slot, uint32_t other) const noexcept {
    return transfer_.close.indexOf(slot, other, &CloseObject::slot);
}

// Each of a pair to the list of the other. Throws std::bad_alloc, and then neither is in it.
void ExchangeSystem::addClose(uint32_t pair) {
    const auto [a, b] = transfer_.pairs[pair].slots;
    for (const uint32_t slot : {b, a})
        transfer_.close.reserve(slot, uint32_t(transfer_.close.of(slot).size()) + 1);
    transfer_.close.insert(a, closeIndex(a, b), {b, pair});
    transfer_.close.insert(b, closeIndex(b, a), {a, pair});
}

// Their pair, which may be new.
uint32_t ExchangeSystem::closePair(uint32_t a, uint32_t b) {
    const std::span<const CloseObject> list = transfer_.close.of(a);
    if (const uint32_t at = closeIndex(a, b); at < list.size() && list[at].slot == b)
        return list[at].pair;
    FW_ASSERT(a < b, "objects %u and %u", a, b);
    const auto pair = uint32_t(transfer_.pairs.size());
    transfer_.pairs.push_back({{a, b}});
    try {
        addClose(pair);
    } catch (...) {
        transfer_.pairs.pop_back();
        throw;
    }
    return pair;
}

// The two are apart, or one of them is gone.
void ExchangeSystem::dropPair(uint32_t pair) noexcept {
    FW_ASSERT(pair < transfer_.pairs.size(), "%u of %zu pairs", pair, transfer_.pairs.size());
    const PairContacts gone = transfer_.pairs[pair], last = transfer_.pairs.back();
    for (int k = 0; k < 2; ++k) {
        const uint32_t slot = gone.slots[k], other = gone.slots[1 - k];
        dropLinks(slot, other);
        transfer_.close.erase(slot, closeIndex(slot, other));
    }
    for (int k = 0; k < 2 && pair + 1 != transfer_.pairs.size(); ++k) {  // the last takes its place
        const uint32_t slot = last.slots[k], other = last.slots[1 - k];
        transfer_.close.set(slot, closeIndex(slot, other), {other, pair});
    }
    transfer_.pairs[pair] = last;
    transfer_.pairs.pop_back();
}

void ExchangeSystem::dropLinks(uint32_t to, uint32_t from) noexcept {
    transfer_.links.eraseIf(to,
                            [&](const gpu::ContactLink& link) { return link.fromObject == from; });
}

// The next object in its slot does not inherit its contacts. The backend gets the change before the
// next exchange.
void ExchangeSystem::forgetObject(const Object& object) noexcept {
    countGoverned(object, false);
    removeOccluderCells(object.slot);
    transfer_.unsent |= object.exchangeVersion != 0;
    const uint32_t slot = object.slot;
    for (SlotSet* set : slotSets()) set->erase(slot);
    if (transfer_.rebuild) {  // its lists are none
        std::erase_if(transfer_.pairs, [&](const PairContacts& pair) {
            return pair.slots[0] == slot || pair.slots[1] == slot;
        });
        std::erase_if(transfer_.loadedSeen, [&](const Seen& seen) {
            return seen.slots[0] == slot || seen.slots[1] == slot;
        });
        return;
    }
    while (!transfer_.close.of(slot).empty()) dropPair(transfer_.close.of(slot).back().pair);
    transfer_.close.drop(slot);
    transfer_.links.drop(slot);
    transfer_.neighbours.remove(slot);
}

// awake: the step will run.
void ExchangeSystem::plan(gpu::StepPlan& step, uint32_t now, bool awake) {
    if (!isOn()) return;
    if (transfer_.rebuild) rebuild();
    step.rules = rules();
    step.exchange = step.reduce;
    step.governed = transfer_.governed();
    step.capped = transfer_.cappedObjects != 0 || components::caps(transfer_.governance);
    if (now % gpu::kExchangeTicks == 0) {
        latchPoses(now);
        frame_.latched = true;
    }
    planOcclusion(step, awake);
    if (!awake || !transfer_.unsent) return;
    if (frame_.flushed && now % gpu::kExchangeTicks != 0) return;
    keepPlanned();
    queryVisibility();
    findLinks(now);
    for (const uint32_t slot : transfer_.neighbours.changed()) {
        auto* owned = scene_.objects.at(slot);
        if (!owned) continue;
        Object& object = **owned;
        const ListPlace list = transfer_.neighbours.pool().placeOf(slot);
        if (object.exchangeObject.neighbourFirst == list.first &&
            object.exchangeObject.neighbourCount == list.count)
            continue;
        object.exchangeObject.neighbourFirst = list.first;
        object.exchangeObject.neighbourCount = list.count;
        if (object.exchangeVersion != 0) markUnsent(object);
    }
    if (frame_.used == frame_.tables.size())
        frame_.tables.push_back(
            core::Owned<ExchangeTables>::make(context_.memory, context_.memory));
    ExchangeTables& tables = *frame_.tables[frame_.used];
    tables.objects.clear();
    core::growTo(tables.objects, transfer_.unsentSlots.slots().size());
    for (const uint32_t slot : transfer_.unsentSlots.slots())
        tables.objects.push_back({slot, scene_.objectAt(slot).exchangeObject});
    transfer_.neighbours.pool().listChanges(tables.neighbourRanges);
    transfer_.links.listChanges(tables.linkRanges);
    tables.occluders.assign(transfer_.occluders.begin(), transfer_.occluders.end());
    tables.update = {tables.objects,         transfer_.neighbours.pool().all(),
                     tables.neighbourRanges, transfer_.links.all(),
                     tables.linkRanges,      tables.occluders};
    step.exchangeUpdate = &tables.update;
    ++frame_.used;
    frame_.flushed = true;
}

// After all that the frame reached was touched.
void ExchangeSystem::commit(bool spreadFound, bool waitersTouched) noexcept {
    if (frame_.occlusionSent) heatOcclusion_.unsent = false;
    if (frame_.latched) {
        for (const uint32_t slot : scene_.moved) scene_.objectAt(slot).exchangeDue = false;
        scene_.moved.clear();
        transfer_.occludersDue = false;
    }
    transfer_.spreadKnown |= spreadFound;
    if (waitersTouched)
        transfer_.waiting.eraseIf([&](uint32_t slot) { return scene_.objectAt(slot).touched; });
    if (!frame_.flushed) return;
    transfer_.unsentSlots.clear();
    transfer_.neighbours.settle();
    transfer_.links.settle();
    transfer_.unsent = false;
}

void ExchangeSystem::countGoverned(const Object& object, bool more) noexcept {
    transfer_.cappedObjects += components::caps(object.governance) ? (more ? 1u : ~0u) : 0u;
    transfer_.governedObjects += components::governs(object.governance) ? (more ? 1u : ~0u) : 0u;
}

void ExchangeSystem::onCounters(Object& object, const gpu::Readback& readback) noexcept {
    const gpu::ObjectCounters& now = object.counters;
    if (now.litTick != object.lifecycle.litReported) {
        object.lifecycle.litReported = now.litTick;
        ++object.changes;
        const uint32_t giver = gpu::igniterOf(now.litBy);
        // A slot may be another's since.
        const auto* by = scene_.objects.findSlot(giver);
        if (now.litTick != 0 && by && (*by)->firstFrame <= readback.frameIndex) {
            const mesh::Box box = boxOf(object.exchangeObject);
            float middle[3];
            for (int i = 0; i < 3; ++i)
                middle[i] = float(double(box.low[i]) + double(box.high[i])) / 2000.0f;
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

void ExchangeSystem::addObject(const Object& object) noexcept { countGoverned(object, true); }

void ExchangeSystem::reserveSlots() {
    for (SlotSet* set : slotSets()) set->reserve(scene_.objects.slotCount());
}

// ---- saves ------------------------------------------------------------------------------------

void ExchangeSystem::capture(ExchangeSnapshot& to) const {
    to.flags = transfer_.flags | transfer_.objectFlags;
    to.warms = transfer_.warms;
    to.occludersDue = transfer_.occludersDue;
    to.fades = transfer_.fades;
    to.pairs.clear();
    std::ranges::copy_if(transfer_.pairs, std::back_inserter(to.pairs), &PairContacts::touches);
    std::sort(to.pairs.begin(), to.pairs.end(), bySlots<PairContacts>);
    to.seen.clear();
    recordSeen(to.seen);
    captureSlots(occluders_, to.occluders);
    to.latchedOccluders = transfer_.occluders;
    to.heatOcclusion = heatOcclusion_.grid;
}

void ExchangeSystem::checkSnapshot(const ExchangeSnapshot& from) {
    checkSlots(from.occluders, occluders_, "occluder", "occluders");
    if ((from.flags & ~kWorldFlags) != 0)
        core::failData("The save's flags are 0x%x; the known flags are 0x%x.", from.flags,
                       kWorldFlags);
    checkCount(from.latchedOccluders.size(), gpu::kMaxHeatOccluders, "latched occluders");
    if (std::ranges::adjacent_find(from.seen, [](const Seen& a, const Seen& b) {
            return !bySlots(a, b);
        }) != from.seen.end())
        core::failData("The save's order of lines of sight is out of its limits.");
    transfer_.pairs.reserve(from.pairs.size());
    transfer_.loadedSeen.reserve(from.seen.size());
    transfer_.occluders.reserve(from.latchedOccluders.size());
}

void ExchangeSystem::restore(ExchangeSnapshot& from) noexcept {
    transfer_.flags = from.flags & kHeatTransferModes;
    transfer_.objectFlags = from.flags & ~kHeatTransferModes;
    transfer_.warms = from.warms;
    transfer_.fades = from.fades;
    transfer_.unsent = transfer_.rebuild = true;
    transfer_.occludersDue = from.occludersDue;
    transfer_.occluders.assign(from.latchedOccluders.begin(), from.latchedOccluders.end());
    for (const auto& occluder : from.occluders) *occluders_.at(occluder.slot) = occluder;
    transfer_.pairs.clear();
    FW_ASSERT(from.pairs.size() <= transfer_.pairs.capacity() &&
                  from.seen.size() <= transfer_.loadedSeen.capacity() &&
                  from.latchedOccluders.size() <= transfer_.occluders.capacity(),
              "%zu pairs, %zu lines of sight", from.pairs.size(), from.seen.size());
    for (PairContacts pair : from.pairs) {
        for (int k = 0; k < 2; ++k) pair.ids[k] = scene_.objects.idOf(pair.slots[k]);
        pair.versions[0] = pair.versions[1] = 0;  // its links are found again
        pair.stamp = 0;
        pair.touches = true;
        transfer_.pairs.push_back(pair);
    }
    transfer_.loadedSeen.assign(from.seen.begin(), from.seen.end());
    heatOcclusion_.commandSlots.clear();
    adoptOcclusion(from.heatOcclusion);
}

// The record of one that no move made stale follows from its pose, but for the wind that it was
// latched in.
void ExchangeSystem::restoreObject(Object& object, bool placed) noexcept {
    object.exchangeVersion = placed ? ++transfer_.version : 0;
    if (object.exchangeDue) scene_.moved.push_back(object.slot);
    if (!placed) {
        object.exchangeObject = {};
        return;
    }
    const int wind = object.exchangeObject.high.w;
    if (!object.exchangeDue) object.exchangeObject = recordOf(object);
    object.exchangeObject.high.w = wind;
    updateReach(object);
}

std::pmr::vector<Seen> ExchangeSystem::recordedSeen() const {
    std::pmr::vector<Seen> seen(context_.memory);
    recordSeen(seen);
    return seen;
}

// The host's answers about sight hold; the lists of neighbours are built again.
void ExchangeSystem::shiftOrigin(const double (&by)[3]) noexcept {
    for (auto [i, owned] : scene_.objects.entries())
        if (owned.exchangeVersion != 0) moveRecord(owned.exchangeObject, by);
    transfer_.rebuild = transfer_.unsent = true;  // its grid is of the places before
    for (gpu::HeatOccluder& occluder : transfer_.occluders) {
        gpu::ivec4* rotations[] = {&occluder.rotation0, &occluder.rotation1, &occluder.rotation2};
        for (int i = 0; i < 3; ++i) movePast(rotations[i]->w, by[i]);
    }
    if (heatOcclusion_.grid.shape.cells() != 0)
        heatOcclusion_.unsent = heatOcclusion_.unpacked = true;
}

uint64_t ExchangeSystem::neighbourBytes() const noexcept {
    uint64_t bytes = transfer_.neighbours.bytes();
    for (const auto& tables : frame_.tables)
        bytes += tables->objects.capacity() * sizeof(gpu::ExchangeUpdate::Placed) +
                 tables->neighbours.capacity() * sizeof(uint32_t);
    return bytes;
}

uint64_t ExchangeSystem::contactBytes() const noexcept {
    return transfer_.links.bytes() + transfer_.close.bytes() +
           transfer_.pairs.capacity() * sizeof(PairContacts);
}

}  // namespace fw::world
