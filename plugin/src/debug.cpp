// Functions of flamewright_debug.h, for editors, tests and benches.
#include "flamewright/flamewright_debug.h"
#include "objects.h"

#include <algorithm>

using namespace fw;
using edge::checkPointer;
using edge::onWorld;

extern "C" {

uint32_t FW_CALL fwDebug_GetPassTimes(FwWorld* world, FwPassTime* times, uint32_t capacity) {
    uint32_t count = 0;
    (void)onWorld(__func__, world, [&](world::World&) {
        if (capacity > 0) checkPointer(times, "times");
        const std::span<const gpu::PassTime> given = world->backend->passTimes();
        count = uint32_t(given.size());
        for (uint32_t i = 0; i < std::min(count, capacity); ++i) {
            times[i] = {};
            std::snprintf(times[i].name, sizeof times[i].name, "%s", given[i].name);
            times[i].milliseconds = given[i].milliseconds;
            times[i].frameIndex = given[i].frameIndex;
            times[i].count = given[i].count;
        }
    });
    return count;
}

FwResult FW_CALL fwDebug_RequestBurnMap(FwWorld* world, FwBurnableMeshId id) {
    return onWorld(__func__, world, [&](world::World& w) {
        w.queries().requestBurnMap(id);
        edge::answerAtOnce(world);
    });
}

FwResult FW_CALL fwDebug_FetchBurnMap(FwWorld* world, FwBurnableMeshId id, uint32_t* ticks,
                                      uint64_t capacity, uint64_t* count, uint64_t* hash,
                                      uint64_t* tick) {
    return onWorld(__func__, world, [&](world::World& w) {
        if (capacity > 0) checkPointer(ticks, "ticks");
        const world::BurnMapCopy* map = w.queries().fetchBurnMap(id);
        if (!map) return FW_NOT_READY;
        if (ticks)
            std::copy_n(map->ticks.begin(), std::min<uint64_t>(capacity, map->ticks.size()), ticks);
        if (count) *count = map->ticks.size();
        if (hash) *hash = world::hashState(map->ticks, map->heat);
        if (tick) *tick = map->tick;
        return FW_OK;
    });
}

FwResult FW_CALL fwDebug_SetSwitches(FwWorld* world, uint32_t switches) {
    return onWorld(__func__, world, [&](world::World& w) { w.setSwitches(switches); });
}

FwResult FW_CALL fwDebug_PushTexels(FwWorld* world, FwBurnableMeshId id, uint32_t kind,
                                    const uint32_t* texels, uint32_t count) {
    return onWorld(__func__, world, [&](world::World& w) {
        if (count > 0) checkPointer(texels, "texels");
        w.burn().pushTexels(id, kind, {texels, count});
    });
}

FwResult FW_CALL fwDebug_GetTexelPositions(FwWorld* world, FwMeshId id, float* positions,
                                           uint32_t* flags, uint64_t capacityTexels,
                                           uint64_t* count) {
    return onWorld(__func__, world, [&](world::World& w) {
        const mesh::BurnDomain& domain = w.scene().domain(id);
        const edge::Scale host(edge::meshUnit(*world, id).inverse());
        const uint64_t given = std::min<uint64_t>(capacityTexels, domain.texelCount());
        for (uint64_t i = 0; i < given; ++i) {
            const mesh::TexelPosition& p = domain.texels[i];
            const uint16_t xyz[3] = {p.x, p.y, p.z};
            if (positions)
                for (int k = 0; k < 3; ++k) {
                    float& place = positions[3 * i + uint64_t(k)];
                    place = domain.origin[k] + domain.quantum * float(xyz[k]);
                    host(place);
                }
            if (flags) flags[i] = domain.real(uint32_t(i)) ? 1u : 0u;
        }
        if (count) *count = domain.texelCount();
    });
}

FwResult FW_CALL fwDebug_GetUnwrap(FwWorld* world, FwMeshId id, float* corners,
                                   uint64_t capacityCorners, uint64_t* count) {
    return onWorld(__func__, world, [&](world::World& w) {
        const mesh::BurnDomain& domain = w.scene().domain(id);
        const edge::Scale host(edge::meshUnit(*world, id).inverse());
        const uint64_t given = std::min<uint64_t>(capacityCorners, domain.indices.size());
        for (uint64_t i = 0; corners && i < given; ++i) {
            const mesh::RenderVertex& vertex = domain.vertices[domain.indices[i]];
            std::copy_n(vertex.position, 3, corners + 5 * i);
            for (int k = 0; k < 3; ++k) host(corners[5 * i + uint64_t(k)]);
            std::copy_n(vertex.atlasUv, 2, corners + 5 * i + 3);
        }
        if (count) *count = domain.indices.size();
    });
}

}  // extern "C"
