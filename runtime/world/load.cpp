// Loading a save. All of a snapshot is checked before anything changes; the backend goes first,
// since it alone may still fail.
#include "save/plane.h"
#include "world/save.h"

#include <algorithm>
#include <cmath>

namespace fw::world {
namespace {

template <class T>
void checkRule(T saved, T mine, const char* name) {
    constexpr int kDigits = std::is_integral_v<T> ? 10 : 6;
    if (!(saved == mine))
        core::failData("The save's FwWorldDef::%s is %.*g; this world's is %.*g.", name, kDigits,
                       double(saved), kDigits, double(mine));
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
        if (!scene_.objects.findSlot(slot))
            core::failData("The save has %s of burnable mesh %u, which is not there.", name,
                           slot + 1);
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
            core::failData("The save has %s at texel %u of burnable mesh %u, which is not there.",
                           name, texel, slot + 1);
    }
    void texel(const char* name, FwBurnableMeshId& id, uint32_t at) const {
        object(name, id);
        if (id.index1 != 0) texel(name, id.index1 - 1, at);
    }
    template <class T>
    void range(const char* name, const T& value, double low, double high) const {
        if constexpr (std::is_arithmetic_v<T>) {
            if (!(double(value) >= low && double(value) <= high))
                core::failData("The save's %s is %.9g; the limits are [%.9g, %.9g].", name,
                               double(value), low, high);
        } else {
            for (const auto& one : value) range(name, one, low, high);
        }
    }
    void require(bool good, const char* name) const {
        if (!good) core::failData("The save's %s is out of its limits.", name);
    }

 private:
    const Scene& scene_;
};

// Ticks after which the time of a tile's last change does not matter.
uint32_t windowOf(const components::Records& records) noexcept {
    uint32_t window = records.timing.window;
    for (const gpu::BurnMaterial& material : records.materials)
        window = std::max(window, material.windowMax);
    return std::min(window, 1u << 24) + 2 * gpu::kStepTicks;
}

}  // namespace

uint32_t PersistenceSystem::windowOf(const Object& object) noexcept {
    components::Latch latch = object.latch;
    return world::windowOf(
        components::makeRecords(object.data, scene_.domainOf(object),
                                world_.wind_.driveInput(object, context_.clock.tick), latch));
}

void PersistenceSystem::checkSnapshot(Snapshot& saved) {
    const FwWorldDef &rules = saved.rules, &mine = context_.def;
    checkRule(rules.paceFactor, mine.paceFactor, "paceFactor");
    for (int i = 0; i < 3; ++i) checkRule(rules.up[i], mine.up[i], "up");
    checkRule(rules.spreadChance, mine.spreadChance, "spreadChance");
    checkRule(rules.timeToLive, mine.timeToLive, "timeToLive");
    checkRule(rules.seed, mine.seed, "seed");
    checkRule(rules.maxHops, mine.maxHops, "maxHops");
    checkRule(rules.maxBurningTiles, mine.maxBurningTiles, "maxBurningTiles");
    checkSlots(saved.objects, scene_.objects, "burnable mesh", "burnable meshes");
    const uint64_t tick = saved.clock.tick;
    world_.exchange_.checkSnapshot(saved.exchange);
    checkSlots(saved.wind.zones, world_.wind_.state().zones, "wind zone", "wind zones");
    checkSlots(saved.rooms.rooms, world_.rooms_.state().rooms, "room", "rooms");
    world_.emitters_.checkSnapshot(saved.emitters, tick);
    world_.fields_.checkSnapshot(saved.fields, tick);
    SnapshotChecker check(scene_);
    check(saved);
    world_.flames_.checkSnapshot(saved.fires);
    for (const double metres : saved.origin)
        check.require(metres == std::floor(metres), "origin, which moves by whole metres,");
    for (const ObjectSnapshot& object : saved.objects) {
        const uint64_t asset = assetOf(scene_.objectAt(object.slot));
        if (object.asset != asset)
            core::failData(
                "Burnable mesh %u is not the save's: mesh, materials and def hash to "
                "0x%016llX, the save's to 0x%016llX.",
                object.slot + 1, static_cast<unsigned long long>(asset),
                static_cast<unsigned long long>(object.asset));
    }
    checkCount(saved.burn.pending.size(), BurnSystem::kMaxPending, "events that wait");
    for (const PendingTexel& event : saved.burn.pending) {
        if (event.texel == kAllTexels && event.kind <= gpu::kEventExtinguish)
            check.object("an event", event.object);
        else
            check.texel("an event", event.object, event.texel);
        if (gpu::eventKind(event.kind) == gpu::kEventCarry)
            world_.burn_.checkCarry(event, saved.clock);
        else
            check.range("kind of an event", event.kind, 0, gpu::kEventHeat);
    }
    checkCount(saved.tags.size(), QuerySystem::kMaxTags, "tags");
    checkCount(saved.events.size(), kMaxSavedEvents, "events");
    check.require(components::plausible(saved.wind.gusts, tick), "state of gusts");
    for (const components::OcclusionCell& cell : saved.exchange.heatOcclusion.baked)
        check.texel("a cell of the heat-occlusion grid", cell.what & gpu::kOcclusionSlotMask,
                    cell.texel);
}

BurnRecords PersistenceSystem::recordsOf(const Snapshot& saved, const ObjectSnapshot& from,
                                         components::Latch& latch) {
    const Object& object = scene_.objectAt(from.slot);
    const mesh::BurnDomain& domain = scene_.domainOf(object);
    components::DriveInput drive = world_.wind_.driveInput(object, context_.clock.tick);
    const WindSnapshot& wind = saved.wind;
    drive.wind = windOf(wind, wind.gusts, wind.ordered, context_.def.seed,
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
        made.heat = components::makeHeatMaterials(posed, domain, context_.def.paceFactor);
    made.window = world::windowOf(made.records);
    return made;
}

void PersistenceSystem::readObjects(const Snapshot& saved, RestoredObjects& out) {
    // Images point into the stores.
    out.latches.reserve(saved.objects.size());
    out.stores.reserve(saved.objects.size());
    out.images.reserve(saved.objects.size());
    for (const ObjectSnapshot& from : saved.objects) {
        const BurnRecords made = recordsOf(saved, from, out.latches.emplace_back());
        if (!from.touched && from.counters.air != 0) {
            gpu::RestoredObject& one = out.images.emplace_back();
            one.image.object = from.slot;
            one.image.counters.air = from.counters.air;
            one.sleeps = true;
        }
        if (!from.touched) continue;
        const Object& object = scene_.objectAt(from.slot);
        const mesh::BurnDomain& domain = scene_.domainOf(object);
        FW_ASSERT(out.stores.size() < out.stores.capacity(), "%zu images", out.stores.size());
        ImageStore& store = out.stores.emplace_back(context_.memory);
        readImage(from.planes, domain, uint32_t(saved.clock.tick), made.window, made.heatSpan(),
                  store);
        if (from.findsBreaks && object.breaks) {
            store.lost.resize(domain.texelCount());
            if (!save::readPlane(from.lost, domain.width, {}, store.lost))
                core::failData("The save's plane of broken texels of burnable mesh %u is damaged.",
                               from.slot + 1);
        }
        gpu::RestoredObject& one = out.images.emplace_back();
        one.image = {from.slot,   store.ticks,    store.heat,
                     store.tiles, store.tileHeat, from.counters};
        std::copy(made.records.materials.begin(), made.records.materials.end(), one.materials);
        one.window = made.records.timing.window;
        one.substepShift = made.records.timing.substepShift;
    }
}

void PersistenceSystem::load(std::span<const std::byte> bytes) {
    recorder_.mayChange();
    Snapshot saved(context_.memory);
    readSnapshot(bytes, saved);
    checkSnapshot(saved);
    world_.burn_.settlePlays(saved.burn, saved.objects, saved.clock);
    // The latches come first: the backend's records follow from them.
    RestoredObjects objects(context_.memory);
    readObjects(saved, objects);
    const size_t slots = scene_.objects.slotCount();
    scene_.touched.reserve(slots);
    scene_.playing.reserve(slots);
    scene_.moved.reserve(slots);
    scene_.places.reserveMoves(scene_.objects.live());
    context_.backend.restore(objects.images, uint32_t(saved.clock.tick));
    restore(saved, objects);
}

void PersistenceSystem::restore(Snapshot& saved, const RestoredObjects& objects) noexcept {
    double by[3];  // the origin's move, for everything that no save has
    for (int i = 0; i < 3; ++i) by[i] = saved.origin[i] - context_.origin.moved[i];
    world_.shiftBy(by);
    context_.origin.count = 0;
    context_.clock = saved.clock;
    context_.loadedFrame = context_.lastFrame;
    context_.loadedTick = context_.readbackTick = context_.clock.tick;
    world_.wind_.restore(saved.wind);
    world_.rooms_.restore(saved.rooms);
    world_.exchange_.restore(saved.exchange);
    scene_.touched.clear();
    scene_.playing.clear();
    scene_.moved.clear();
    ++scene_.geometryVersion;
    FW_ASSERT(objects.latches.size() == saved.objects.size(), "%zu latches of %zu objects",
              objects.latches.size(), saved.objects.size());
    for (size_t i = 0; i < saved.objects.size(); ++i)
        restoreObject(saved.objects[i], objects.latches[i], scene_.objectAt(saved.objects[i].slot));
    world_.lights_.showSaved();
    world_.flames_.restore(saved.fires);
    world_.emitters_.restore(saved.emitters);
    world_.fields_.restore(saved.fields);
    world_.queries_.restore(saved.tags);
    restoreBreaks(saved, objects);
    uint32_t listed = 0, hot = 0;
    for (const ImageStore& store : objects.stores)
        for (const gpu::TileState& tile : store.tiles) {
            listed += (tile.flag & gpu::kTileListed) != 0 ? 1u : 0u;
            hot += (tile.flag & gpu::kTileHot) != 0 ? 1u : 0u;
        }
    world_.burn_.restore(saved.burn, listed, hot);
    context_.events.clear();
    for (const FwEvent& event : saved.events)
        context_.raise(
            event.type,
            event.object.index1 != 0 ? &scene_.objectAt(event.object.index1 - 1) : nullptr,
            event.tag, context_.lastFrame, event.position, event.value, event.other);
    restoreRecords();
}

void PersistenceSystem::restoreRecords() noexcept {
    for (core::Owned<Save>& save : saves_) {
        if (!save || !save->pending) continue;
        save->pending = false;  // of the world before the load
        save->requested = true;
    }
    const uint64_t now = context_.clock.tick;
    if (Timeline* timeline = recorder_.timeline.get()) {
        const bool restarts = !timeline->seeks;  // it begins here, or is in its own past
        if (restarts) timeline->restart(now);
        saves_[size_t(SaveFor::timeline)]->requested = restarts;
    }
    if (Recording* network = recorder_.network.get()) {
        network->loaded = true;
        network->captured = false;
        network->commands.clear();
        network->hashes.clear();
    }
}

void PersistenceSystem::restoreObject(const ObjectSnapshot& from, const components::Latch& latch,
                                      Object& object) noexcept {
    static_cast<ObjectState&>(object) = from;
    object.data.pose = from.pose;
    object.latch = latch;
    context_.backend.setObjectWind(object.slot, object.zoneWind);
    scene_.placeNow(object);
    world_.rooms_.restoreObject(object);
    scene_.sendPose(object);
    world_.queries_.restoreObject(object);
    world_.exchange_.restoreObject(object, from.placed);
    world_.burn_.restoreObject(object);
}

void PersistenceSystem::restoreBreaks(const Snapshot& saved,
                                      const RestoredObjects& objects) noexcept {
    size_t next = 0;
    for (const ObjectSnapshot& from : saved.objects) {
        if (!from.touched) continue;
        FW_ASSERT(next < objects.stores.size(), "%zu of %zu images", next, objects.stores.size());
        const ImageStore& store = objects.stores[next++];
        if (Object& object = scene_.objectAt(from.slot); object.breaks)
            world_.burn_.restoreBreaks(object, from.findsBreaks ? &from.breaks : nullptr, store,
                                       uint32_t(context_.clock.tick));
    }
}

}  // namespace fw::world
