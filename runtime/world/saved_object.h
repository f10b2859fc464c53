// A burnable mesh of a save: the state that the world keeps, and the image of its texels and tiles.
#pragma once
#include "components/exchange_object.h"
#include "save/archive.h"
#include "world/object.h"

namespace fw::world {

struct ObjectSnapshot : ObjectState {
    uint32_t slot = 0;
    uint64_t asset = 0;  // hash of its mesh, materials and rules
    components::Pose pose;
    uint64_t burnHash = 0;  // of the baked burn that it plays
    bool placed = false;
    std::array<fire::WindFilter, components::kMaterials> filters{};
    components::Pose latched;
    bool findsBreaks = false;
    BreakState breaks;
    std::span<const std::byte> lost;    // plane of the texels that hung on nothing
    std::span<const std::byte> planes;  // of its image

    template <class A>
    void serialize(A& a) {
        a(slot, asset, pose, firstEvent, play, zoneWind, placed, exchangeDue);
        a.range("burnable mesh's place", pose.translation, -1e6, 1e6);
        if (play.burn1 != 0) a(burnHash);
        // A latched record follows from the pose, but for the wind that it was latched in.
        if (placed && exchangeDue) a(exchangeObject);
        if (placed && !exchangeDue) a(exchangeObject.high.w);
        a(touched, carried);
        if (!touched) {
            a(counters.air);
            return;
        }
        a(filters, latched, lifecycle, counters, findsBreaks);
        if (findsBreaks) {
            a(breaks);
            a.blob("bytes of broken texels", lost);
        }
        a.blob("bytes of a burnable mesh's planes", planes);
    }
};

struct ImageStore {  // the arrays of a read ObjectImage
    explicit ImageStore(std::pmr::memory_resource* memory)
        : ticks(memory), heat(memory), tiles(memory), tileHeat(memory), lost(memory) {}
    std::pmr::vector<uint32_t> ticks;
    std::pmr::vector<gpu::uvec2> heat;
    std::pmr::vector<gpu::TileState> tiles;
    std::pmr::vector<gpu::TileHeat> tileHeat;
    std::pmr::vector<uint32_t> lost;  // of its breaks, apart from the image; empty: none are saved
};
// `window`: ticks beyond which nobody asks when a tile last changed.
void writeImage(const gpu::ObjectImage& image, const mesh::BurnDomain& domain, uint32_t tick,
                uint32_t window, std::pmr::vector<std::byte>& out);
// Throws unless writeImage wrote the planes. `heat`: of its materials; empty: it has none.
void readImage(std::span<const std::byte> planes, const mesh::BurnDomain& domain, uint32_t tick,
               uint32_t window, std::span<const gpu::HeatMaterial> heat, ImageStore& store);

struct BurnRecords {  // with which a saved object's planes are read
    components::Records records;
    uint32_t window = 0;
    bool heated = false;
    std::array<gpu::HeatMaterial, gpu::kMaterialsPerObject> heat{};
    [[nodiscard]] std::span<const gpu::HeatMaterial> heatSpan() const noexcept {
        return std::span(heat).first(heated ? heat.size() : 0);
    }
};

}  // namespace fw::world
