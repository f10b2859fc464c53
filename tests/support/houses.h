// A village of burning, refined low-poly houses: pine walls under thatch, each rotated and lit
// elsewhere, with a street for the camera. Shared by its test and its bench row.
#pragma once
#include "flamewright/flamewright_debug.h"
#include "support/mesh_def.h"
#include "support/refine_scene.h"
#include "support/views.h"

#include <vector>

namespace fw::test {

// Materials of a house of `house()` by side: the two roof sides and the gables have their own.
inline std::vector<uint8_t> houseMaterials(int ny, int nz) {
    const auto walls = size_t(8 * ny + 4 * ny * nz), roof = size_t(4 * nz), floor = size_t(4 * nz);
    std::vector<uint8_t> of(walls + roof + floor + 4, 0);
    std::fill_n(of.begin() + std::ptrdiff_t(walls), roof, uint8_t{1});
    return of;
}

struct Village {
    static constexpr float kWidth = 4, kHeight = 2.4, kLength = 5, kRoof = 1.8;  // m
    FwWorld* world = nullptr;
    std::vector<FwBurnableMeshId> houses;

    Village() = default;
    Village(const Village&) = delete;
    Village& operator=(const Village&) = delete;
    ~Village() { fwDestroyWorld(world); }

    // `count` houses in rows of ten, all burning from the first step for twenty seconds.
    bool make(FwContext* context, uint32_t count, uint32_t maxTriangles, float pixelsPerEdge,
              bool refined = true) {
        FwWorldDef worldDef = fwDefaultWorldDef();
        worldDef.maxStepsPerFrame = 64;
        worldDef.maxFlames = 0;
        worldDef.maxRefinedTriangles = maxTriangles;
        const Mesh mesh = house(kWidth, kHeight, kLength, kRoof, 2, 2);
        const std::vector<uint8_t> materials = houseMaterials(2, 2);
        FwMeshDef meshDef = meshDefOf(mesh);
        meshDef.triangleMaterials = materials.data();
        meshDef.mapSize = 256;
        meshDef.texelsPerMetre = 12;
        FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
        // Fire crosses a house within twenty seconds; burnt parts vanish after two and a half.
        FwMaterialDef walls = fwDefaultMaterialDef(), thatch = walls;
        if (materials.size() != mesh.triangleCount() ||
            fwInitMaterialPreset(&thatch, FW_MATERIAL_THATCH) != FW_OK)
            return false;
        for (FwMaterialDef* m : {&walls, &thatch}) {
            m->thickness = 0.12f;
            m->spreadRate = m == &walls ? 0.24f : 0.45f;
            m->windGain = m->upGain = m->headGain = m->ceilingGain = 0;
            m->burnTime = 2.5f;
        }
        if (fwCreateWorld(context, &worldDef, &world) != FW_OK ||
            fwWorld_CreateMesh(world, &meshDef, &def.mesh) != FW_OK ||
            fwWorld_CreateMaterial(world, &walls, &def.materials[0]) != FW_OK ||
            fwWorld_CreateMaterial(world, &thatch, &def.materials[1]) != FW_OK)
            return false;
        def.flags = FW_BURNABLE_LITE | (refined ? FW_BURNABLE_REFINE : 0);
        def.refineDepth = 3;
        def.refinePixelsPerEdge = pixelsPerEdge;
        std::mt19937 random(1);
        const auto share = [&] { return float(random() % 1024) / 1024; };
        for (uint32_t i = 0; i < count; ++i) {
            // Five on each side of the street, which runs along z at x = 0.
            const float across = 5.5f + 7.5f * float(i % 10 / 2), along = 7.5f * float(i / 10);
            glm::mat4 at = glm::translate(glm::mat4(1.0f), {i % 2 ? across : -across, 0, -along});
            at = glm::rotate(at, 6.2831853f * share(), glm::vec3(0, 1, 0));
            at = glm::translate(at, {-kWidth / 2, 0, -kLength / 2});
            std::memcpy(def.transform, glm::value_ptr(at), sizeof def.transform);
            def.tint[0] = 0.8f + 0.2f * share();
            houses.emplace_back();
            if (fwWorld_CreateBurnableMesh(world, &def, &houses.back()) != FW_OK) return false;
            for (uint32_t k = 0; k < 3; ++k) {  // at a different wall each time
                const float aside = 0.2f + 0.6f * share(), up = 0.4f + 1.4f * share();
                const uint32_t wall = (i + k) % 4;
                const glm::vec3 at0 = wall < 2
                                          ? glm::vec3(aside * kWidth, up, wall * kLength)
                                          : glm::vec3((wall - 2) * kWidth, up, aside * kLength);
                FwIgnitionDef match = fwDefaultIgnitionDef();
                const glm::vec4 start = at * glm::vec4(at0, 1);
                std::copy_n(&start.x, 3, match.position);
                match.radius = 0.3f;
                uint32_t texels = 0;
                if (fwWorld_Ignite(world, &match, &texels) != FW_OK || texels == 0) return false;
            }
        }
        return true;
    }

    [[nodiscard]] FwWorldStats stats() const {
        FwWorldStats s{};
        s.structSize = sizeof s;
        fwWorld_GetStats(world, &s);
        return s;
    }
};

// From `eye` down the street.
inline FwView streetView(glm::vec3 eye, glm::vec3 target, float aspect) {
    return viewAt(eye, target, aspect, 1.6f, 0.1f);
}

}  // namespace fw::test
