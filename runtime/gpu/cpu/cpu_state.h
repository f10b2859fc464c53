// State of the cpu backend, shared by its sources. Internal to runtime/gpu/cpu.
#pragma once
#include "field/field.h"
#include "gpu/cpu/cpu_backend.h"
#include "mesh/front/tile.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <utility>

namespace fw::gpu::cpu {

using mesh::FrontArrays;
using mesh::FrontTile;

struct CpuObject {
    explicit CpuObject(std::pmr::memory_resource* memory)
        : state(memory), slowness(memory), extended(memory), heat(memory), sources(memory) {}
    bool live = false;
    uint32_t mesh = 0;
    BurnObject record{};
    std::array<BurnMaterial, kMaterialsPerObject> materials{};
    ObjectCounters counters{};
    const mesh::BurnDomain* domain = nullptr;
    std::pmr::vector<uint32_t> state;     // one per texel
    std::pmr::vector<uint16_t> slowness;  // empty: the mesh's own
    std::pmr::vector<float> extended;     // of an extension that burns its texels; else empty
    std::pmr::vector<uvec2> heat;         // packed HeatTexel, one per texel; empty: none
    std::array<HeatMaterial, kMaterialsPerObject> heatMaterials{};
    uint32_t extensionParity = 0;
    ExchangeObject exchangeObject{};       // without kExchangeLive until its first update
    std::pmr::vector<FireSource> sources;  // by cell, see mesh/exchange_tiles.h
    bool gives = false;                    // some source differs from FireSource{}

    [[nodiscard]] uint32_t worldTileOf(uint32_t texel) const noexcept {
        return record.worldTileBase + domain->tileOf(texel);
    }
    [[nodiscard]] uint32_t localTileOf(uint32_t worldTile) const noexcept {
        FW_ASSERT(worldTile - record.worldTileBase < record.tileCount, "world tile %u, %u of %u",
                  worldTile, record.tileCount, record.worldTileBase);
        return worldTile - record.worldTileBase;
    }
    [[nodiscard]] const HeatMaterial& heatMaterialOf(uint32_t texel) const noexcept {
        FW_ASSERT(texel < heat.size(), "%u of %zu texels with heat", texel, heat.size());
        return heatMaterials[domain->texels[texel].materialFlags & (kMaterialsPerObject - 1)];
    }
    // Whether other objects' fires reach it, and its fire reaches them.
    [[nodiscard]] bool exchanges() const noexcept {
        return (exchangeObject.flags & kExchangeLive) != 0;
    }
    void addIgnitions(uint32_t texels, uint32_t tick) noexcept {
        counters.ignited += texels;
        counters.lastIgnition = std::max(counters.lastIgnition, tick);
    }
    [[nodiscard]] std::span<const uint16_t> slownessOf() const noexcept {
        return slowness.empty() ? std::span<const uint16_t>(domain->slowness) : slowness;
    }
};

// Adds to a sum of two words.
inline void addWide(uint32_t& low, uint32_t& high, uint64_t more) noexcept {
    const uint64_t sum = (uint64_t(high) << 32 | low) + more;
    low = uint32_t(sum);
    high = uint32_t(sum >> 32);
}

// Copies to the front of `to`, and drops that part of it. Returns the copy.
template <class T>
std::span<T> copyNext(std::span<const T> from, std::span<T>& to) noexcept {
    FW_ASSERT(from.size() <= to.size(), "%zu of %zu entries", from.size(), to.size());
    const std::span<T> copy = to.first(from.size());
    std::copy(from.begin(), from.end(), copy.begin());
    to = to.subspan(from.size());
    return copy;
}

// cpu_heat.cpp. Needs the states; makes those of wet texels wet.
void createHeat(CpuObject& object);

// Methods of an extension for objects with kObjectExtended.
struct CpuMethods {
    void (*create)(CpuObject& object);  // fills `extended`; needs the states
    void (*event)(CpuObject& object, uint32_t texel, bool burns) noexcept;
    void (*step)(CpuBackend::State& s, uint32_t now) noexcept;  // of all objects
};

struct CpuField {
    explicit CpuField(std::pmr::memory_resource* memory) : field(memory) {}
    field::Field field;
    FieldRules rules{};
};

struct ImageStore {  // images of objects, and what they refer to
    explicit ImageStore(std::pmr::memory_resource* memory)
        : ticks(memory), heat(memory), tiles(memory), tileHeat(memory), images(memory) {}
    std::pmr::vector<uint32_t> ticks;
    std::pmr::vector<uvec2> heat;
    std::pmr::vector<TileState> tiles;
    std::pmr::vector<TileHeat> tileHeat;
    std::pmr::vector<ObjectImage> images;
};

struct ReadbackStore {
    explicit ReadbackStore(std::pmr::memory_resource* of) : memory(of) {}
    std::pmr::memory_resource* memory;
    Readback readback;
    std::pmr::vector<ObjectCounters> objects{memory};
    std::pmr::vector<ProbeAnswer> answers{memory};
    ImageStore burnMaps{memory}, images{memory};
    std::pmr::vector<BurnLight> lights{memory};
    std::pmr::vector<FieldCounters> fields{memory};
    std::pmr::vector<RoomAir> rooms{memory};
};

// Figures of memoryRows, which any thread calls.
struct CpuCounts {
    std::atomic<uint64_t> texels{0}, objects{0}, exchange{0}, readbacks{0};  // bytes
    std::atomic<uint64_t> tiles{0}, tileCapacity{0};                         // world tiles
};

struct CpuBackend::State {
    State(std::pmr::memory_resource* memory_, uint32_t maxLights_)
        : memory(memory_), maxLights(maxLights_) {}

    // Null: the slot is empty, or there is none of this number.
    [[nodiscard]] CpuObject* find(uint32_t slot) const noexcept {
        return slot < objects.size() ? objects[slot].get() : nullptr;
    }
    [[nodiscard]] CpuObject& at(uint32_t slot) const noexcept {
        FW_ASSERT(slot < objects.size() && objects[slot], "object %u of %zu", slot, objects.size());
        return *objects[slot];
    }
    [[nodiscard]] CpuObject& ownerOf(uint32_t worldTile) const noexcept {
        FW_ASSERT(worldTile < tiles.size(), "world tile %u of %zu", worldTile, tiles.size());
        return at(tiles[worldTile].object);
    }
    [[nodiscard]] CpuField& fieldAt(uint32_t slot) const noexcept {
        FW_ASSERT(slot < fields.size() && fields[slot], "field %u of %zu", slot, fields.size());
        return *fields[slot];
    }
    // An object that takes part in the exchange, or null.
    [[nodiscard]] CpuObject* exchanging(uint32_t slot) const noexcept {
        CpuObject* object = find(slot);
        return object && object->exchanges() ? object : nullptr;
    }
    static void append(std::pmr::vector<uint32_t>& tileList, uint32_t worldTile) noexcept {
        FW_ASSERT(tileList.size() < tileList.capacity(), "a list of %zu tiles is full",
                  tileList.size());
        tileList.push_back(worldTile);
    }
    // Puts a tile without the flag `bit` on its list; sets that and `more`. Whether it was new.
    bool enlist(std::pmr::vector<uint32_t>& tileList, uint32_t worldTile, uint32_t bit,
                uint32_t more = 0) noexcept {
        FW_ASSERT(worldTile < tiles.size(), "world tile %u of %zu", worldTile, tiles.size());
        uint32_t& flag = tiles[worldTile].flag;
        const bool isNew = (flag & bit) == 0;
        if (isNew) append(tileList, worldTile);
        flag |= bit | more;
        return isNew;
    }
    void touch(uint32_t worldTile, uint32_t bits) noexcept {
        enlist(list, worldTile, kTileListed, bits);
    }
    void touchDependents(const CpuObject& object, uint32_t local, uint64_t mask) noexcept;
    void burning(uint32_t worldTile) noexcept {
        if (enlist(burnList, worldTile, kTileBurning)) ++ownerOf(worldTile).counters.burningTiles;
    }
    // Where a limit counts the burning tiles, as shaders/lib/burn_budget.glsl.
    [[nodiscard]] bool mayBurn(uint32_t worldTile) const noexcept {
        FW_ASSERT(worldTile < tiles.size(), "world tile %u of %zu", worldTile, tiles.size());
        return !capped || (tiles[worldTile].flag & kTileBurning) != 0;
    }
    void requestToBurn(uint32_t worldTile) noexcept;
    void allocateBurnBudget(uint32_t maxTiles, uint32_t now) noexcept;
    template <class Light>
    void requestThenBurn(uint32_t maxTiles, uint32_t now, const Light& light) noexcept;
    // Of objects with heat: the tile's temperature, water or flux changes from now on.
    void hot(uint32_t worldTile) noexcept { enlist(hotList, worldTile, kTileHot, kTileWarm); }
    // A frame: reserves what it needs (throws), runs a step, fills the readback.
    ReadbackStore& reserveReadback(const FramePlan& plan);
    void runStep(const StepPlan& step) noexcept;
    void answerProbes(std::span<const Probe> probes, std::span<ProbeAnswer> answers) const noexcept;
    void finishReadback(const FramePlan& plan, ReadbackStore& store) noexcept;
    void addTime(const char* pass, double milliseconds) noexcept;
    // For memoryRows, which any thread may call.
    void countObject(const CpuObject& object, bool comes) noexcept;
    void countLists() noexcept;
    void applyEvents(const StepPlan& step) noexcept;
    void wake(const StepPlan& step) noexcept;
    // cpu_heat.cpp
    void iterate(const StepPlan& step, uint32_t iteration) noexcept;
    void schedule(const StepPlan& step, uint32_t iteration) noexcept;
    void scheduleTile(const StepPlan& step, uint32_t iteration, uint32_t worldTile,
                      bool dense) noexcept;
    void shuffle(std::pmr::vector<uint32_t>& list) noexcept;
    void applyToAll(struct EventPass& pass, uint32_t first) noexcept;
    void airRooms(uint32_t now) noexcept;
    void heatStep(uint32_t now) noexcept;
    [[nodiscard]] uint32_t heatTurnOf(uint32_t worldTile, uint32_t now) const noexcept;
    void heatTile(uint32_t worldTile, uint32_t turn, uint32_t now) noexcept;
    // Returns the texel's state after a heat step of `work`; units: fuel that burnt.
    [[nodiscard]] uint32_t heatTexel(const CpuObject& object, uint32_t texel, uint32_t work,
                                     const TileHeat& comes, uint32_t now, HeatTexel& x,
                                     uint32_t& units) const noexcept;
    // Writes a texel's state and counts it. True: the texel is a source now, and was none.
    bool setState(CpuObject& object, uint32_t worldTile, uint32_t texel, uint32_t after,
                  uint32_t end) noexcept;
    // True of `burns`: the texel is a source now.
    void changedTexel(CpuObject& object, uint32_t texel, bool burns, uint32_t now) noexcept;
    void reduce(uint32_t now) noexcept;  // cpu_reduce.cpp
    [[nodiscard]] BurnTile burnTileOf(uint32_t worldTile, uint32_t now, bool nominal,
                                      float fire) const noexcept;
    void showRestored() noexcept;  // cpu_restore.cpp
    // cpu_exchange.cpp
    void reserveExchange(const ExchangeUpdate& update);  // throws std::bad_alloc
    void placeExchangeObject(const ExchangeUpdate& update) noexcept;
    void reserveOcclusion(const OcclusionUpdate& update);  // throws std::bad_alloc
    void setOcclusionPush(const OcclusionUpdate& update) noexcept;
    void exchange(const ExchangePush& given, uint32_t now) noexcept;
    [[nodiscard]] const ExchangeTile& exchangeTileOf(const CpuObject& object,
                                                     uint32_t local) const noexcept {
        FW_ASSERT(object.mesh < exchangeTiles.size() && local < exchangeTiles[object.mesh].size(),
                  "tile %u of mesh %u", local, object.mesh);
        return exchangeTiles[object.mesh][local];
    }
    template <class Each>
    void eachEmber(Each&& each) noexcept;
    void litFrom(CpuObject& object, uint32_t by) noexcept;
    // A baked burn that the object plays ends with the step or exchange that ends at `end`.
    static void disturb(CpuObject& object, uint32_t end) noexcept;
    void findLights(std::pmr::vector<BurnLight>& out) noexcept;  // reserved by the caller
    uint32_t allocateTiles(uint32_t count);
    void releaseTiles(uint32_t first, uint32_t count) noexcept;
    // cpu_restore.cpp
    // `whole`: with tiles and counters. reserveImages throws.
    void reserveImages(ImageStore& store, std::span<const uint32_t> slots, bool whole) const;
    void collectImages(ImageStore& store, std::span<const uint32_t> slots,
                       bool whole) const noexcept;
    void resetObject(CpuObject& object, uint32_t slot) noexcept;  // to its state after creation
    // cpu_field.cpp
    void stepFields(const FieldUpdate& update) noexcept;
    void countFields(std::span<FieldCounters> out) const noexcept;

    std::pmr::memory_resource* memory;
    uint32_t maxLights;
    std::pmr::vector<const mesh::BurnDomain*> meshes{memory};
    std::pmr::vector<core::Owned<CpuObject>> objects{memory};
    std::pmr::vector<core::Owned<CpuField>> fields{memory};
    // By world tile. A tile is in a list at most once, so all lists have room for all tiles.
    std::pmr::vector<TileState> tiles{memory};
    std::pmr::vector<uint32_t> list{memory}, listOut{memory}, runList{memory};
    std::pmr::vector<uint32_t> burnList{memory}, hotList{memory}, hotOut{memory};
    std::pmr::vector<uvec4> requests{
        memory};  // of requestToBurn: order, object, local tile, world tile
    std::pmr::vector<uint8_t> requested{memory};  // by world tile: `requests` holds it
    std::pmr::vector<TileHeat> tileHeat{memory};
    std::pmr::vector<float> tileFire{memory};     // W in the last heat step
    std::pmr::vector<FrontTile> results{memory};  // per due tile
    std::pmr::vector<uint32_t> scratch{memory};   // 64 words per due tile
    std::pmr::vector<BurnTile> burnTiles{memory};
    struct Range {
        uint32_t first = 0, count = 0;
    };
    std::pmr::vector<Range> freeTiles{memory};          // by first; room for objects + 1
    std::pmr::vector<ReadbackStore> readbacks{memory};  // ring: [head, head + waiting)
    size_t head = 0, waiting = 0;
    uint32_t switches = 0;
    bool capped = false;         // of the step
    bool isRequestPass = false;  // tiles that would be lit are requested, and none is lit
    uint32_t random = 1;         // of the shuffle switch
    uint64_t runTiles = 0;
    uint32_t extendedObjects = 0;
    CpuCounts counts;
    // Exchange between objects.
    std::pmr::vector<std::pmr::vector<ExchangeTile>> exchangeTiles{memory};  // by mesh
    std::pmr::vector<uint32_t> neighbours{memory};
    std::pmr::vector<ContactLink> links{memory};
    std::pmr::vector<HeatOccluder> occluders{memory};
    OcclusionUpdate occlusion;  // its words are in occlusionCells
    std::pmr::vector<uint32_t> occlusionCells{memory};
    std::array<Room, kMaxRooms> rooms{};
    std::array<RoomAir, kMaxRooms> roomAir{};
    bool airs = false;  // some step had rooms
    uint32_t receivers = 0;
    struct Warms {  // a source that warms the current receiver
        const FireSource* source = nullptr;
        uint32_t seen = 0;  // of 255
    };
    std::array<Warms, kSourcesPerReceiver> warms{};
    uint32_t warmCount = 0;
    uint32_t scheduledBurning = 0;  // burning tiles as an iteration begins
    bool showsDue = false;          // after `restore`: BurnTiles as of a tick
    uint32_t showsTick = 0;
    uint32_t reducedBurning = 0;  // as of the last reduce
    // Tiles of destroyed objects: they count until their list is walked again, as on a device.
    uint32_t goneBurning = 0, goneListed = 0, goneHot = 0;
    std::array<PassTime, 12> times{};  // of the last frame, by name
    uint32_t timesCount = 0;
};

// The backend as the bodies of passes (shared/exchange_pass.h, event_pass.h) see it: members have
// the names that these bodies use. A slot without an object takes no part.
struct PassBody {
    CpuBackend::State& backend;
    struct Counters {
        const CpuBackend::State& backend;
        ObjectCounters none{};
        ObjectCounters& operator[](uint32_t slot) noexcept {
            CpuObject* object = backend.find(slot);
            return object ? object->counters : none;
        }
    } objectCounters{backend};

    uint32_t inert = kInert;  // state of a slot without an object
    [[nodiscard]] uint32_t& stateOf(uint32_t slot, uint32_t texel) noexcept {
        CpuObject* object = backend.find(slot);
        FW_ASSERT(!object || texel < object->state.size(), "texel %u", texel);
        return object ? object->state[texel] : inert;
    }
    [[nodiscard]] bool hasHeat(uint32_t slot) const noexcept {
        return !backend.at(slot).heat.empty();
    }
    [[nodiscard]] uvec2& heatOf(uint32_t slot, uint32_t texel) const noexcept {
        FW_ASSERT(texel < backend.at(slot).heat.size(), "texel %u", texel);
        return backend.at(slot).heat[texel];
    }
    struct TexelPlace {
        uint32_t worldTile;
    };
    [[nodiscard]] TexelPlace placeOfTexel(uint32_t slot, uint32_t texel) const noexcept {
        FW_ASSERT(texel < backend.at(slot).state.size(), "texel %u", texel);
        return {backend.at(slot).worldTileOf(texel)};
    }
    [[nodiscard]] bool isRequestPass() const noexcept { return backend.isRequestPass; }
    [[nodiscard]] bool mayBurn(uint32_t worldTile) const noexcept {
        return backend.mayBurn(worldTile);
    }
    void requestToBurn(uint32_t worldTile) noexcept { backend.requestToBurn(worldTile); }
    void nowBurns(uint32_t slot, uint32_t worldTile, uint32_t end) noexcept {
        atomicMax(objectCounters[slot].lastIgnition, end);
        backend.burning(worldTile);
    }
    void hotTouch(uint32_t, uint32_t worldTile) noexcept { backend.hot(worldTile); }
    void litFrom(uint32_t slot, uint32_t by) noexcept { backend.litFrom(backend.at(slot), by); }
    static uint32_t atomicCompSwap(uint32_t& value, uint32_t expected, uint32_t wanted) noexcept {
        return value == expected ? std::exchange(value, wanted) : value;
    }
    static uint32_t atomicAdd(uint32_t& sum, uint32_t more) noexcept {
        return std::exchange(sum, sum + more);
    }
    static void atomicMax(uint32_t& most, uint32_t other) noexcept { most = std::max(most, other); }
    static void atomicMin(uint32_t& least, uint32_t other) noexcept {
        least = std::min(least, other);
    }
};

template <class Light>
void CpuBackend::State::requestThenBurn(uint32_t maxTiles, uint32_t now,
                                        const Light& light) noexcept {
    if (capped) {
        isRequestPass = true;
        light();
        isRequestPass = false;
        allocateBurnBudget(maxTiles, now);
    }
    light();
}

}  // namespace fw::gpu::cpu
