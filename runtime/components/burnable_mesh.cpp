#include "components/burnable_mesh.h"

#include "components/appearance_table.h"
#include "core/error.h"
#include "core/reserved.h"
#include "fire/presets.h"
#include "mesh/bake.h"
#include "shared/refine.h"

#include "core/assert.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace fw::components {
namespace {

fire::SpreadFacts facts(const BurnableMesh& object, const mesh::BurnDomain& domain,
                        const DriveInput& drive, const Pose& pose) noexcept {
    fire::SpreadFacts f;
    f.quantum = domain.quantum;
    f.texelSide = domain.texelSide;
    f.linkShort = domain.linkShort;
    f.scale = pose.scale;
    std::memcpy(f.rotation, pose.rotation, sizeof f.rotation);
    std::copy_n(drive.up, 3, f.up);
    f.pace = drive.pace;
    f.moisture = object.moisture;
    f.heat = hasHeat(object);
    return f;
}

// Stores the height, along up, of the ground that the object stands on.
void standOnGround(const mesh::BurnDomain& domain,
                   std::array<gpu::BurnMaterial, kMaterials>& materials) noexcept {
    const auto any = std::find_if(materials.begin(), materials.end(),
                                  [](const gpu::BurnMaterial& m) { return (m.flags & 1) != 0; });
    if (any == materials.end()) return;
    gpu::uvec4 up = any->upCeiling;
    int64_t low = INT64_MAX, high = INT64_MIN;
    // A few thousand texels are enough; an odd stride meets all columns.
    const uint32_t count = domain.texelCount(), stride = (count / 4096) | 1u;
    for (uint32_t i = 0; i < count; i += stride) {
        if (!domain.real(i)) continue;
        const mesh::TexelPosition& t = domain.texels[i];
        const int64_t rise = int64_t(int32_t(up.x)) * t.x + int64_t(int32_t(up.y)) * t.y +
                             int64_t(int32_t(up.z)) * t.z;
        low = std::min(low, rise);
        high = std::max(high, rise);
    }
    up.w = low > high ? 0 : uint32_t(int32_t(low + (high - low) / 25));
    for (gpu::BurnMaterial& m : materials) m.upCeiling = up;
}

bool sameTurn(const Pose& a, const Pose& b) noexcept {
    return a.scale == b.scale && std::memcmp(a.rotation, b.rotation, sizeof a.rotation) == 0;
}

// An appearance was tuned at its own spread rate: a material twice as fast ages twice as fast. 0:
// no ageing.
float timeScale(const FwMaterialDef& def, float pace) noexcept {
    const float tuned = materialAppearance(def.appearance).spreadRate;
    return tuned > 0 && def.spreadRate > 0 ? pace * def.spreadRate / tuned : 0.0f;
}

}  // namespace

FwBurnableMeshDef applyWorldFlags(const FwBurnableMeshDef& given, uint32_t worldFlags) noexcept {
    FwBurnableMeshDef def = given;
    if (worldFlags & FW_WORLD_NO_SPREAD) def.flags |= FW_BURNABLE_NO_SPREAD;
    if (worldFlags & FW_WORLD_NO_DAMAGE) def.flags |= FW_BURNABLE_NO_DAMAGE;
    if (worldFlags & FW_WORLD_NO_HOLES) def.flags |= FW_BURNABLE_NO_HOLES;
    if (!(def.flags & FW_BURNABLE_NO_DAMAGE)) return def;
    def.flags |= FW_BURNABLE_NO_HOLES;  // and no feature that only shows damage
    def.flags &= ~uint32_t(FW_BURNABLE_REFINE | core::reserved::kRefinement | FW_BURNABLE_RECEDE |
                           core::reserved::kSolver | core::reserved::kDepth);
    return def;
}

BurnableMesh makeBurnableMesh(const FwBurnableMeshDef& def) {
    constexpr uint32_t kKnown = FW_BURNABLE_HIDDEN | FW_BURNABLE_TWO_SIDED |
                                core::reserved::kBurning | FW_BURNABLE_NO_HOLES | FW_BURNABLE_LITE |
                                FW_BURNABLE_REFINE | FW_BURNABLE_RECEDE | FW_BURNABLE_SHELL |
                                core::reserved::kSolver | FW_BURNABLE_NO_SPREAD |
                                FW_BURNABLE_NO_DAMAGE | FW_BURNABLE_SKINNED |
                                core::reserved::kRefinement | core::reserved::kDepth;
    checkFlags(def.flags, "FwBurnableMeshDef::flags", kKnown);
    core::reserved::checkBurnable(def.flags);
    BurnableMesh object;
    object.flags = def.flags;
    object.pose = makePose(def.transform, "FwBurnableMeshDef::transform");
    std::copy_n(object.pose.stretch, 3, object.shape);  // the mesh is stretched, not the pose
    std::fill_n(object.pose.stretch, 3, 1.0f);
    checkValue(def.moisture, "FwBurnableMeshDef::moisture", 0, 2);
    object.moisture = def.moisture;
    checkValues(def.tint, 3, "FwBurnableMeshDef::tint", 0, 100);
    std::copy_n(def.tint, 3, object.tint);
    object.userData = def.userData;
    checkWhole(def.refineDepth, "FwBurnableMeshDef::refineDepth", 0, gpu::kRefineDepth);
    checkValue(def.refinePixelsPerEdge, "FwBurnableMeshDef::refinePixelsPerEdge", 1, 1000);
    checkValue(def.heatPsi, "FwBurnableMeshDef::heatPsi", 0, 1e8f);
    checkValue(def.heatStep, "FwBurnableMeshDef::heatStep", 0, 1000);
    if (def.multiplier) {
        checkWhole(def.multiplierWidth, "FwBurnableMeshDef::multiplierWidth", 1, 8192);
        checkWhole(def.multiplierHeight, "FwBurnableMeshDef::multiplierHeight", 1, 8192);
    }
    return object;
}

void setMaterial(BurnableMesh& object, uint32_t index, const FwMaterialDef& def) noexcept {
    FW_ASSERT(index < kMaterials, "material %u", index);
    object.materials[index] = def;
    object.materialMask |= 1u << index;
}

bool burns(const BurnableMesh& object, uint32_t material) noexcept {
    if (material >= kMaterials || !(object.materialMask >> material & 1)) return false;
    const FwMaterialDef& def = object.materials[material];
    return def.spreadRate > 0 &&
           (hasHeat(object) ||
            fire::moistureFactor(def.moisture + object.moisture, def.extinctionMoisture) > 0);
}

bool hasHeat(const BurnableMesh& object) noexcept {
    return (object.flags & (FW_BURNABLE_LITE | core::reserved::kBurning)) == 0;
}

bool tracksBurntFuel(const BurnableMesh& object) noexcept {
    return (object.flags & core::reserved::kBurning) == 0;
}

bool CutOut::at(int64_t x, int64_t y) const noexcept {
    const auto wrapped = [](int64_t i, uint32_t side) {
        const int64_t rest = i % int64_t(side);
        return size_t(rest < 0 ? rest + side : rest);
    };
    FW_ASSERT(width > 0 && height > 0 && pixelBits.size() == size_t((width + 7) / 8) * height,
              "%u x %u pixels in %zu bytes", width, height, pixelBits.size());
    const size_t column = wrapped(x, width), row = wrapped(y, height);
    return (pixelBits[row * ((width + 7) / 8) + column / 8] >> (column & 7) & 1) != 0;
}

CutOut makeCutOut(const FwImageDef& def, std::pmr::memory_resource* memory) {
    CutOut made(memory);
    if (!(def.alphaCutoff > 0)) return made;
    FW_ASSERT(def.pixels && def.width > 0 && def.height > 0, "%u x %u pixels", def.width,
              def.height);
    made.width = def.width;
    made.height = def.height;
    const size_t rowBytes = (def.width + 7) / 8;
    made.pixelBits.resize(rowBytes * def.height);
    const auto* pixels = static_cast<const uint8_t*>(def.pixels);
    for (size_t y = 0; y < def.height; ++y)
        for (size_t x = 0; x < def.width; ++x) {
            const uint8_t alpha = pixels[(y * def.width + x) * 4 + 3];
            if (float(alpha) >= def.alphaCutoff * 255)
                made.pixelBits[y * rowBytes + x / 8] |= uint8_t(1u << (x & 7));
        }
    return made;
}

namespace {

// Texture coordinates over the atlas within one triangle: at + du * x + dv * y.
struct TextureFrame {
    double at[2] = {}, perX[2] = {}, perY[2] = {};
    TextureFrame(const mesh::BurnDomain& domain, uint32_t triangle) noexcept {
        const mesh::RenderVertex* corners[3];
        for (size_t k = 0; k < 3; ++k)
            corners[k] = &domain.vertices[domain.indices[size_t(triangle) * 3 + k]];
        const auto side = [&](size_t k, int c) {
            return double(corners[k]->atlasUv[c]) - double(corners[0]->atlasUv[c]);
        };
        const double area = side(1, 0) * side(2, 1) - side(2, 0) * side(1, 1);
        for (int c = 0; c < 2; ++c) {
            const double base = double(corners[0]->textureUv[c]);
            const double a = double(corners[1]->textureUv[c]) - base;
            const double b = double(corners[2]->textureUv[c]) - base;
            if (std::abs(area) > 1e-9) {
                perX[c] = (a * side(2, 1) - b * side(1, 1)) / area;
                perY[c] = (b * side(1, 0) - a * side(2, 0)) / area;
            }
            at[c] = base - perX[c] * double(corners[0]->atlasUv[0]) -
                    perY[c] * double(corners[0]->atlasUv[1]);
        }
    }
};

// Is any part of a texel where the picture is? Pixels are looked at as far apart as they lie, no
// more than kMost a side.
bool isThere(const mesh::BurnDomain& domain, uint32_t texel, const CutOut& picture) {
    constexpr int kMost = 16;
    const uint32_t triangle = domain.triangleOf[texel];
    if (triangle == mesh::kNone) return true;
    const TextureFrame frame(domain, triangle);
    const double sides[2] = {double(picture.width), double(picture.height)};
    double middle[2] = {};
    float weights[3] = {};
    const bool forced = (domain.texels[texel].materialFlags & mesh::kTexelForced) != 0;
    if (forced) mesh::texelWeights(domain, texel, weights);
    int steps = 1;
    for (int c = 0; c < 2; ++c) {
        middle[c] = frame.at[c] + frame.perX[c] * (double(texel % domain.width) + 0.5) +
                    frame.perY[c] * (double(texel / domain.width) + 0.5);
        if (forced) {  // the texel's middle is outside the triangle
            middle[c] = 0;
            for (size_t k = 0; k < 3; ++k)
                middle[c] +=
                    double(weights[k]) *
                    double(domain.vertices[domain.indices[size_t(triangle) * 3 + k]].textureUv[c]);
        }
        const double pixels = std::max(std::abs(frame.perX[c]), std::abs(frame.perY[c])) * sides[c];
        steps = std::max(steps, int(std::min(std::ceil(pixels), double(kMost))));
    }
    for (int j = 0; j < steps; ++j)
        for (int i = 0; i < steps; ++i) {
            const double x = (i + 0.5) / steps - 0.5, y = (j + 0.5) / steps - 0.5;
            int64_t pixel[2];
            for (int c = 0; c < 2; ++c) {
                const double at = middle[c] + frame.perX[c] * x + frame.perY[c] * y;
                // Coordinates of any size: whole repetitions are removed first.
                pixel[c] = int64_t(std::floor((at - std::floor(at)) * sides[c]));
            }
            if (picture.at(pixel[0], pixel[1])) return true;
        }
    return false;
}

}  // namespace

std::pmr::vector<uint8_t> makeCutOutMask(const mesh::BurnDomain& domain,
                                         std::span<const CutOut* const, kMaterials> pictures,
                                         std::pmr::memory_resource* memory) {
    std::pmr::vector<uint8_t> gone(memory);
    if (std::all_of(pictures.begin(), pictures.end(), [](const CutOut* one) { return !one; }))
        return gone;
    gone.resize(domain.texelCount());
    for (uint32_t i = 0; i < domain.texelCount(); ++i) {
        const CutOut* picture = pictures[domain.texels[i].materialFlags & (kMaterials - 1)];
        if (domain.real(i) && picture) gone[i] = !isThere(domain, i, *picture);
    }
    return gone;
}

std::pmr::vector<uint16_t> makeSlowness(const FwBurnableMeshDef& def,
                                        const mesh::BurnDomain& domain,
                                        std::span<const uint8_t> gone,
                                        std::pmr::memory_resource* memory) {
    std::pmr::vector<uint16_t> slowness(memory);
    if (!def.multiplier && gone.empty()) return slowness;
    FW_ASSERT(gone.empty() || gone.size() == domain.slowness.size(), "%zu of %zu texels",
              gone.size(), domain.slowness.size());
    slowness.assign(domain.slowness.begin(), domain.slowness.end());
    for (size_t i = 0; i < gone.size(); ++i)
        if (gone[i]) slowness[i] = 0;
    if (!def.multiplier) return slowness;
    for (uint32_t y = 0; y < domain.height; ++y)
        for (uint32_t x = 0; x < domain.width; ++x) {
            const uint32_t texel = y * domain.width + x;
            const uint64_t fromX = uint64_t(x) * def.multiplierWidth / domain.width;
            const uint64_t fromY = uint64_t(y) * def.multiplierHeight / domain.height;
            const uint32_t speed = def.multiplier[fromY * def.multiplierWidth + fromX];
            const uint32_t noise = slowness[texel];
            const uint32_t slow = speed == 0 ? 0 : (noise * 128 + speed / 2) / speed;
            slowness[texel] =
                noise == 0 || speed == 0 ? 0 : uint16_t(std::clamp<uint32_t>(slow, 1, 65535));
        }
    return slowness;
}

void poseOnShape(BurnableMesh& object, const Pose& pose, const char* field) {
    Pose made = pose;
    if ((pose.stretch[0] < 0) != (object.shape[0] < 0))
        core::refuse(
            "%s %s and the object's own transform %s; a mirror is settled when the object "
            "is created.",
            field, pose.stretch[0] < 0 ? "mirrors" : "does not mirror",
            object.shape[0] < 0 ? "does" : "does not");
    bool even = true;
    for (int i = 0; i < 3; ++i) {
        FW_ASSERT(object.shape[i] != 0, "axis %d", i);
        made.stretch[i] = pose.stretch[i] / object.shape[i];
        even &= std::abs(made.stretch[i] - 1) <= 2e-3f;
    }
    if (even) std::fill_n(made.stretch, 3, 1.0f);
    object.pose = made;
}

// ---- drive ------------------------------------------------------------------------------------

void resetLatch(const BurnableMesh& object, const DriveInput& drive, Latch& latch) noexcept {
    for (fire::WindFilter& filter : latch.filters) fire::resetWind(filter, drive.wind);
    latch.pose = object.pose;
}

void filterLatch(const BurnableMesh& object, const mesh::BurnDomain& domain,
                 const DriveInput& drive, Latch& latch) noexcept {
    const fire::SpreadFacts f = facts(object, domain, drive, latch.pose);
    for (uint32_t i = 0; i < kMaterials; ++i)
        if (object.materialMask >> i & 1)
            fire::filterWind(latch.filters[i], drive.wind, fire::linkTicks(object.materials[i], f));
}

bool latchDrive(const BurnableMesh& object, Latch& latch) noexcept {
    bool changed = false;
    for (uint32_t i = 0; i < kMaterials; ++i)
        if (object.materialMask >> i & 1) changed |= fire::latchWind(latch.filters[i]);
    if (!sameTurn(latch.pose, object.pose)) {
        latch.pose = object.pose;
        changed = true;
    }
    return changed;
}

bool sameDrive(const BurnableMesh& object, const Latch& a, const Latch& b) noexcept {
    for (uint32_t i = 0; i < kMaterials; ++i)
        if ((object.materialMask >> i & 1) && a.filters[i].latched != b.filters[i].latched)
            return false;
    return sameTurn(a.pose, b.pose);
}

bool atRest(const BurnableMesh& object, const mesh::BurnDomain& domain, const DriveInput& drive,
            const Latch& latch) noexcept {
    if (!latch.sent || !sameTurn(latch.pose, object.pose)) return false;
    const fire::SpreadFacts f = facts(object, domain, drive, latch.pose);
    for (uint32_t i = 0; i < kMaterials; ++i)
        if ((object.materialMask >> i & 1) &&
            !fire::isWindSteady(latch.filters[i], drive.wind,
                                fire::linkTicks(object.materials[i], f)))
            return false;
    return true;
}

uint32_t holeTicks(const BurnableMesh& object, uint32_t material, float pace) noexcept {
    FW_ASSERT(material < kMaterials, "material %u", material);
    const FwMaterialDef& def = object.materials[material];
    const float holeTime = materialAppearance(def.appearance).holeTime;
    const float scale = timeScale(def, pace);
    if ((object.flags & FW_BURNABLE_NO_HOLES) || !(scale > 0) || !(holeTime > 0)) return 0;
    return uint32_t(std::min(holeTime * (float(gpu::kTicksPerSecond) / scale), 4.0e9f));
}

Records makeRecords(const BurnableMesh& object, const mesh::BurnDomain& domain,
                    const DriveInput& drive, Latch& latch) noexcept {
    const fire::SpreadFacts f = facts(object, domain, drive, latch.pose);
    Records records;
    std::array<const FwMaterialDef*, kMaterials> defs{};
    std::array<fire::WindVector, kMaterials> winds{};
    for (uint32_t i = 0; i < kMaterials; ++i) {
        records.materials[i] = fire::inertMaterial();
        if (!(object.materialMask >> i & 1)) continue;
        const FwMaterialDef& def = object.materials[i];
        defs[i] = &def;
        winds[i] = latch.filters[i].latched;
        gpu::BurnMaterial& record = records.materials[i];
        record = fire::burnMaterial(def, f, winds[i]);
        if (const float scale = timeScale(def, drive.pace); scale > 0) record.timeScale = scale;
        const gpu::MaterialAppearance appearance = materialAppearance(def.appearance);
        if (record.timeScale > 0 && appearance.holeTime > 0) {
            const float ticks = float(gpu::kTicksPerSecond) / record.timeScale;
            record.holeTicks = uint32_t(std::min(appearance.holeTime * ticks, 4.0e9f));
            record.baseColor.w = std::min(holeEndSeconds(appearance) * ticks, 4.0e8f);
        }
    }
    standOnGround(domain, records.materials);
    records.timing = fire::frontTiming(defs, f, winds, records.materials);
    FW_ASSERT(records.timing.substepShift < 32, "shift %u", records.timing.substepShift);
    for (uint32_t i = 0; i < kMaterials; ++i) latch.flameTicks[i] = records.materials[i].flameTicks;
    latch.substepShift = records.timing.substepShift;
    latch.window = records.timing.window;
    return records;
}

// ---- records ----------------------------------------------------------------------------------

std::array<gpu::HeatMaterial, kMaterials> makeHeatMaterials(const BurnableMesh& object,
                                                            const mesh::BurnDomain& domain,
                                                            float pace) noexcept {
    const FwMaterialDef stone = fire::presetDef(FW_MATERIAL_NONCOMBUSTIBLE);
    fire::HeatPlace place;
    place.texelArea = float(domain.texelArea()) * object.pose.scale * object.pose.scale;
    place.pace = pace;
    place.moisture = object.moisture;
    std::array<gpu::HeatMaterial, kMaterials> made;
    for (uint32_t i = 0; i < kMaterials; ++i)
        made[i] =
            fire::heatMaterial(object.materialMask >> i & 1 ? object.materials[i] : stone, place);
    return made;
}

Fuel fuelOf(const BurnableMesh& object, const mesh::BurnDomain& domain,
            std::span<const uint32_t, kMaterials> texelsOf, float pace) noexcept {
    const std::array<gpu::HeatMaterial, kMaterials> heat = makeHeatMaterials(object, domain, pace);
    Fuel fuel;
    for (uint32_t m = 0; m < kMaterials; ++m) {
        if (heat[m].energy == 0) continue;
        fuel.energy += uint64_t(texelsOf[m]) * gpu::kFuelFull * heat[m].energy;
        fuel.texels += texelsOf[m];
    }
    return fuel;
}

gpu::BurnObject makeObject(const BurnableMesh& object, const mesh::BurnDomain& domain,
                           const Records& records) noexcept {
    gpu::BurnObject made{};
    made.flags = objectFlags(object, domain);
    made.width = domain.width;
    made.height = domain.height;
    made.tilesX = domain.tilesX;
    made.tileCount = domain.tileCount();
    made.window = records.timing.window;
    made.substepShift = records.timing.substepShift;
    // Surfaces show a front that arrives within a minute of the appearance's own time.
    uint32_t horizon = 0;
    for (uint32_t i = 0; i < kMaterials; ++i) {
        const gpu::BurnMaterial& m = records.materials[i];
        if (!(m.flags & 1) || !(m.timeScale > 0)) continue;
        const float ticks = 60.0f * float(gpu::kTicksPerSecond) / m.timeScale;
        horizon = std::max(horizon, uint32_t(std::clamp(ticks, 512.0f, 4.0e6f)));
    }
    made.horizon = horizon;
    made.originQuantum =
        gpu::vec4(domain.origin[0], domain.origin[1], domain.origin[2], domain.quantum);
    gpu::vec4 rows[3];
    poseRows(object.pose, rows);
    made.worldRow0 = rows[0];
    made.worldRow1 = rows[1];
    made.worldRow2 = rows[2];
    made.tint = objectTint(object, domain);
    return made;
}

void poseRows(const Pose& pose, gpu::vec4 (&rows)[3]) noexcept {
    FW_ASSERT(pose.scale > 0, "scale %g", double(pose.scale));
    for (int r = 0; r < 3; ++r)
        rows[r] = gpu::vec4(pose.rotation[r][0] * pose.scale * pose.stretch[0],
                            pose.rotation[r][1] * pose.scale * pose.stretch[1],
                            pose.rotation[r][2] * pose.scale * pose.stretch[2],
                            float(pose.translation[r]));
}

gpu::vec4 objectTint(const BurnableMesh& object, const mesh::BurnDomain& domain) noexcept {
    const float scale = object.pose.scale;
    return gpu::vec4(object.tint[0], object.tint[1], object.tint[2],
                     float(domain.texelArea()) * scale * scale);
}

uint32_t objectFlags(const BurnableMesh& object, const mesh::BurnDomain& domain) noexcept {
    uint32_t flags = gpu::kObjectLive;
    if (object.flags & core::reserved::kBurning) flags |= gpu::kObjectExtended;
    if (object.flags & FW_BURNABLE_TWO_SIDED) flags |= gpu::kObjectTwoSided;
    if (object.flags & FW_BURNABLE_NO_HOLES) flags |= gpu::kObjectNoHoles;
    if (object.flags & FW_BURNABLE_HIDDEN) flags |= gpu::kObjectHidden;
    if (object.flags & FW_BURNABLE_NO_DAMAGE) flags |= gpu::kObjectNoDamage;
    if (domain.hasDetail) flags |= gpu::kObjectDetail;
    if (object.flags & (FW_BURNABLE_SKINNED | FW_BURNABLE_SHELL | core::reserved::kSolver))
        flags |= gpu::kObjectSkinned;
    if (hasHeat(object)) flags |= gpu::kObjectHeat;
    if (object.flags & core::reserved::kDepth) flags |= gpu::kObjectDepthFirst;
    return flags;
}

float powerPerArea(const BurnableMesh& object,
                   const std::array<uint32_t, kMaterials>& texelsOf) noexcept {
    double sum = 0, texels = 0;
    for (uint32_t i = 0; i < kMaterials; ++i) {
        if (!burns(object, i)) continue;
        const FwMaterialDef& def = object.materials[i];
        sum += double(texelsOf[i]) * double(def.heatOfCombustion) * double(def.burningFlux);
        texels += double(texelsOf[i]);
    }
    return texels > 0 ? float(sum / texels) : 0.0f;
}

}  // namespace fw::components
