// A burnable mesh as plain data: pose, materials and the def's other values; and the functions that
// make a backend's records of it. It owns no ids and knows no device.
#pragma once
#include "components/pose.h"
#include "fire/heat.h"
#include "fire/spread_law.h"
#include "fire/wind_filter.h"
#include "flamewright/flamewright.h"
#include "mesh/burn_domain.h"
#include "shared/burn.h"

#include <array>
#include <span>

namespace fw::components {

constexpr uint32_t kMaterials = gpu::kMaterialsPerObject;

struct BurnableMesh {
    Pose pose;                   // of the stretched mesh
    float shape[3] = {1, 1, 1};  // stretch of the mesh at creation, see mesh::shaped
    std::array<FwMaterialDef, kMaterials> materials{};  // by triangle material
    uint32_t materialMask = 0;  // bit i: materials[i] is set; the others cannot burn
    uint32_t flags = 0;         // FwBurnableFlags
    float moisture = 0;         // kg/kg, added to the materials' own, [0, 2]
    float tint[3] = {1, 1, 1};
    uint32_t meshSlot = 0;
    std::array<uint32_t, kMaterials> imagesPlus1{};  // base-colour image slot + 1, 0: none
    uint64_t userData = 0;
};

struct DriveInput {           // of the world
    fire::WindVector wind{};  // 1/128 m/s, world space
    float up[3] = {0, 1, 0};
    float pace = 1;
};

struct Latch {  // the latched drive of an object's front, and the filters before it
    std::array<fire::WindFilter, kMaterials> filters{};
    Pose pose;                                      // latched; its translation is not used
    std::array<uint32_t, kMaterials> flameTicks{};  // of the latched records; kNoneTexel: no end
    uint32_t substepShift = 0;                      // of the latched records
    uint32_t window = 0;                            // ticks, of the latched records
    bool sent = true;                               // the backend has the records of this latch
};

struct Records {
    std::array<gpu::BurnMaterial, kMaterials> materials{};
    fire::FrontTiming timing;
};

// A def changed by its world's flags (FwWorldFlags): no feature shows damage where there is none.
[[nodiscard]] FwBurnableMeshDef applyWorldFlags(const FwBurnableMeshDef& given,
                                                uint32_t worldFlags) noexcept;
// Throws core::Error naming the field. Ids are the caller's: mesh, materials and image stay unset.
BurnableMesh makeBurnableMesh(const FwBurnableMeshDef& def);
// Sets a new pose. A shape other than the object's stretches only the drawn mesh: the front keeps
// the metric of its creation, times the pose's mean scale. Throws if exactly one of the two
// mirrors.
void poseOnShape(BurnableMesh& object, const Pose& pose, const char* field);
void setMaterial(BurnableMesh& object, uint32_t index, const FwMaterialDef& def) noexcept;
// Ticks from a texel's ignition until it burns through, in a world of this pace; 0: never.
[[nodiscard]] uint32_t holeTicks(const BurnableMesh& object, uint32_t material,
                                 float pace) noexcept;
// Whether the material can burn, possibly only after it dries.
[[nodiscard]] bool burns(const BurnableMesh& object, uint32_t material) noexcept;
// Whether the object has temperature, fuel and water per texel.
[[nodiscard]] bool hasHeat(const BurnableMesh& object) noexcept;
// Whether the world keeps an energy ledger of the object's fuel.
[[nodiscard]] bool tracksBurntFuel(const BurnableMesh& object) noexcept;

// The opaque pixels of a picture, by its alpha.
struct CutOut {
    uint32_t width = 0, height = 0;       // pixels; 0: opaque everywhere
    std::pmr::vector<uint8_t> pixelBits;  // bit x & 7 of byte y * ceil(width / 8) + x / 8: opaque
    explicit CutOut(std::pmr::memory_resource* memory) : pixelBits(memory) {}
    [[nodiscard]] bool at(int64_t x, int64_t y) const noexcept;  // the picture is repeated
};
// `def` has been checked.
CutOut makeCutOut(const FwImageDef& def, std::pmr::memory_resource* memory);
// 1 for each real texel without any opaque pixel; empty: all have some. pictures: by material
// index; null: no picture, or one that is opaque everywhere.
std::pmr::vector<uint8_t> makeCutOutMask(const mesh::BurnDomain& domain,
                                         std::span<const CutOut* const, kMaterials> pictures,
                                         std::pmr::memory_resource* memory);

// Q7 slowness per texel times the host's speed multiplier, 0 where the object is cut out. Empty
// without a multiplier and without `gone`.
std::pmr::vector<uint16_t> makeSlowness(const FwBurnableMeshDef& def,
                                        const mesh::BurnDomain& domain,
                                        std::span<const uint8_t> gone,
                                        std::pmr::memory_resource* memory);

// Sets the latch as if wind and pose had always been the present ones.
void resetLatch(const BurnableMesh& object, const DriveInput& drive, Latch& latch) noexcept;
// One step of the filters.
void filterLatch(const BurnableMesh& object, const mesh::BurnDomain& domain,
                 const DriveInput& drive, Latch& latch) noexcept;
// Latches the filtered wind and the pose; false: they are already latched.
bool latchDrive(const BurnableMesh& object, Latch& latch) noexcept;
[[nodiscard]] bool sameDrive(const BurnableMesh& object, const Latch& a, const Latch& b) noexcept;
// Whether filtering and latching would change nothing, and the backend has the latched records.
[[nodiscard]] bool atRest(const BurnableMesh& object, const mesh::BurnDomain& domain,
                          const DriveInput& drive, const Latch& latch) noexcept;
// Records under the latched drive; stores their flameTicks and substepShift in the latch.
Records makeRecords(const BurnableMesh& object, const mesh::BurnDomain& domain,
                    const DriveInput& drive, Latch& latch) noexcept;

// Of an object with heat; materials that are not set are stone.
std::array<gpu::HeatMaterial, kMaterials> makeHeatMaterials(const BurnableMesh& object,
                                                            const mesh::BurnDomain& domain,
                                                            float pace) noexcept;

struct Fuel {
    uint64_t energy = 0;  // 2^-20 J
    uint32_t texels = 0;  // texels with fuel
};
// The fuel of a new object. texelsOf: real texels of its mesh, by material.
[[nodiscard]] Fuel fuelOf(const BurnableMesh& object, const mesh::BurnDomain& domain,
                          std::span<const uint32_t, kMaterials> texelsOf, float pace) noexcept;

// The backend's record of an object; the backend sets its bases.
gpu::BurnObject makeObject(const BurnableMesh& object, const mesh::BurnDomain& domain,
                           const Records& records) noexcept;
void poseRows(const Pose& pose, gpu::vec4 (&rows)[3]) noexcept;
gpu::vec4 objectTint(const BurnableMesh& object, const mesh::BurnDomain& domain) noexcept;
uint32_t objectFlags(const BurnableMesh& object, const mesh::BurnDomain& domain) noexcept;

// W/m^2 of flaming texels, the mean over the materials' texels.
float powerPerArea(const BurnableMesh& object,
                   const std::array<uint32_t, kMaterials>& texelsOf) noexcept;

}  // namespace fw::components
