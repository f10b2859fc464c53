// Functions that create or take a context.
#include "components/volumetric_fire.h"
#include "core/hash.h"
#include "core/owned.h"
#include "gpu/cpu/cpu_backend.h"
#include "objects.h"
#include "world/mesh_input.h"

#include <algorithm>

using namespace fw;
using edge::checkPointer;
using edge::onContext;

namespace {

void checkCallbacks(const FwCallbacks& callbacks) {
    if ((callbacks.allocate == nullptr) != (callbacks.release == nullptr))
        core::refuse("FwCallbacks::%s is null and %s is not; give both or neither.",
                     callbacks.allocate ? "release" : "allocate",
                     callbacks.allocate ? "allocate" : "release");
}

void freeContext(FwContext* context) noexcept {
    const FwCallbacks callbacks = context->callbacks;
    core::Memory last(callbacks);
    std::pmr::polymorphic_allocator<>(&last).delete_object(context);
}

// Bakes and burns a small mesh: true if it burns as in every exact build.
bool burnsExactly() {
    static constexpr float kPositions[] = {0, 0, 0, 0.31f, 0.02f, 0.07f, 0.05f, 0.23f, 0.11f};
    static constexpr uint16_t kIndices[] = {0, 1, 2};
    core::Memory memory({});
    const core::Log silent({});
    gpu::cpu::CpuBackend backend(&memory, 0);
    world::World world(fwDefaultWorldDef(), backend, silent, &memory);
    FwMeshDef mesh = fwDefaultMeshDef();
    mesh.positions = kPositions, mesh.vertexCount = 3, mesh.texelsPerMetre = 40;
    mesh.indices = kIndices, mesh.indexCount = 3, mesh.indexSize = 2;
    FwBurnableMeshDef object = fwDefaultBurnableMeshDef();
    object.mesh = world.scene().createMesh(mesh);
    object.materials[0] = world.scene().createMaterial(fwDefaultMaterialDef());
    FwIgnitionDef ball = fwDefaultIgnitionDef();
    ball.object = world.createBurnableMesh(object);
    world.burn().ignite(ball);
    world.advance(1, 0.5f);
    world.queries().requestBurnMap(ball.object);
    world.advance(2, 0);
    const world::BurnMapCopy* map = world.queries().fetchBurnMap(ball.object);
    const std::span areas(world.scene().objectDomain(ball.object).areas);  // m^2
    return map && core::hashBytes(std::as_bytes(areas), world::hashState(map->ticks, map->heat)) ==
                      0x27b5cedbe4665031;
}

// True: the cooked bytes are in `buffer`. *size: room in it, then what there is; a buffer that is
// too small is refused.
bool giveCooked(std::span<const std::byte> bytes, const char* what, void* buffer, uint64_t& size) {
    const bool fits = buffer && size >= bytes.size();
    if (buffer && !fits)
        core::refuse("*size is %llu and the cooked %s has %zu bytes.",
                     static_cast<unsigned long long>(size), what, bytes.size());
    if (fits) std::memcpy(buffer, bytes.data(), bytes.size());
    size = bytes.size();
    return fits;
}

void destroyWorlds(FwContext* context) noexcept {
    for (;;) {
        FwWorld* world = nullptr;
        {
            const std::lock_guard lock(context->mutex);
            if (context->worlds.empty()) return;
            world = context->worlds.back();
        }
        fwDestroyWorld(world);
    }
}

}  // namespace

extern "C" {

FwResult FW_CALL fwCreateContext(const FwContextDef* given, FwContext** out, FwErrorInfo* error) {
    if (out) *out = nullptr;
    FwCallbacks callbacks{};
    const auto report = [&](FwResult result, const char* text) {
        core::Log(callbacks).write(FW_LOG_ERROR, "%s", text);
        if (!error) return;
        error->result = result;
        std::snprintf(error->message, sizeof error->message, "%s", text);
    };
    if (error) {
        error->result = FW_OK;
        error->message[0] = 0;
    }
    return edge::guard(__func__, report, [&] {
        checkPointer(out, "context");
        const FwContextDef def = edge::readDef(given);
        if (def.abiVersion != FW_ABI_VERSION)
            core::fail(FW_ERROR_VERSION,
                       "FwContextDef::abiVersion is %u; this library serves version %u.",
                       def.abiVersion, FW_ABI_VERSION);
        checkCallbacks(def.callbacks);
        callbacks = def.callbacks;
        if (def.backend != FW_BACKEND_VULKAN && def.backend != FW_BACKEND_CPU)
            core::refuse(
                "FwContextDef::backend is %u; it is FW_BACKEND_VULKAN (0) or "
                "FW_BACKEND_CPU (1).",
                def.backend);
        if (def.flags != 0) core::refuse("FwContextDef::flags is 0x%x; it is zero.", def.flags);
        if (def.backend == FW_BACKEND_CPU && def.vulkan)
            core::refuse(
                "FwContextDef::vulkan is given and backend is FW_BACKEND_CPU; choose one.");
        if (static const bool isExact = burnsExactly(); !isExact)  // once in a process
            core::Log(callbacks).write(
                FW_LOG_WARNING,
                "This build is not exact: saves, replays and network games differ from those of "
                "others. Use -ffp-contract=off, rounding to nearest and no -ffast-math.");
        core::Memory first(callbacks);  // the context's own block precedes its counters
        auto* context = std::pmr::polymorphic_allocator<>(&first).new_object<FwContext>(callbacks);
        try {
            context->backend = def.backend;
            context->device = def.backend == FW_BACKEND_CPU
                                  ? edge::createCpuDevice(context->memory)
                                  : edge::createVulkanDevice(def.vulkan, def.gpuMemoryBudget,
                                                             context->memory, context->log);
        } catch (...) {
            freeContext(context);
            throw;
        }
        *out = context;
    });
}

void FW_CALL fwDestroyContext(FwContext* context) {
    if (!context) return;
    destroyWorlds(context);
    context->device->destroy();
    freeContext(context);
}

FwResult FW_CALL fwContext_GetInfo(FwContext* context, FwContextInfo* info) {
    return onContext(__func__, context, [&](FwContext& c) {
        const uint32_t size = edge::checkInfo(info);
        FwContextInfo filled{};
        c.device->fillInfo(filled);
        filled.backend = c.backend;
        filled.cpuMemoryUsed = c.memory.bytes();
        edge::writeInfo(info, size, filled);
    });
}

size_t FW_CALL fwContext_GetLastMessage(FwContext* context, char* text, size_t capacity) {
    return context ? context->message.copy(text, capacity) : 0;
}

FwResult FW_CALL fwContext_Prepare(FwContext* context) {
    return onContext(__func__, context, [&](FwContext& c) { c.device->prepare(); });
}

uint32_t FW_CALL fwContext_GetMemoryReport(FwContext* context, FwMemoryRow* rows,
                                           uint32_t capacity) {
    uint32_t count = 0;
    (void)onContext(__func__, context, [&](FwContext& c) {
        std::pmr::vector<FwMemoryRow> sums(&c.memory);
        std::pmr::vector<gpu::MemoryRow> given(&c.memory);
        const auto add = [&] {
            for (const gpu::MemoryRow& row : given) {
                auto sum = std::find_if(sums.begin(), sums.end(), [&](const FwMemoryRow& known) {
                    return std::strncmp(known.name, row.name, sizeof known.name - 1) == 0;
                });
                if (sum == sums.end()) {
                    sum = sums.insert(sums.end(), FwMemoryRow{});
                    std::snprintf(sum->name, sizeof sum->name, "%s", row.name);
                }
                sum->bytes += row.bytes;
                sum->capacity += row.capacity;
            }
            given.clear();
        };
        c.device->memoryRows(given);
        add();
        const std::lock_guard lock(c.mutex);
        for (const FwWorld* world : c.worlds) {
            world->backend->memoryRows(given);
            world->world->memoryRows(given);
            add();
        }
        count = uint32_t(sums.size());
        if (rows) std::copy_n(sums.begin(), std::min(count, capacity), rows);
        return FW_OK;
    });
    return count;
}

FwResult FW_CALL fwCookMesh(FwContext* context, const FwMeshDef* given, void* buffer,
                            uint64_t* size) {
    edge::Unit unit;
    const auto cookMesh = [&](FwContext& c) {
        FwMeshDef def = edge::readDef(given);
        checkPointer(size, "size");
        unit = edge::checkedUnit(def.metersPerUnit, "FwMeshDef::metersPerUnit", {});
        edge::MetreArrays arrays(unit, &c.memory);
        edge::visitArrays(def, arrays);
        if (def.cooked) core::refuse("FwMeshDef::cooked is given; only arrays can be cooked.");
        const uint64_t key = world::cookKey(def, &c.memory);
        std::pmr::vector<std::byte> bytes(&c.memory);
        {
            const std::lock_guard lock(c.mutex);
            if (!c.cooked.empty() && c.cookedKey == key) bytes.swap(c.cooked);
        }
        if (bytes.empty()) bytes = world::cook(def, &c.memory);
        const auto keep = [&] {  // the caller calls again with a larger buffer
            const std::lock_guard lock(c.mutex);
            c.cooked.swap(bytes);
            c.cookedKey = key;
        };
        try {
            if (!giveCooked(bytes, "mesh", buffer, *size)) keep();
        } catch (...) {
            keep();
            throw;
        }
    };
    return onContext(__func__, context, cookMesh, unit);
}

FwResult FW_CALL fwCookFireProfile(FwContext* context, const FwFireProfileDef* given, void* buffer,
                                   uint64_t* size) {
    return onContext(__func__, context, [&](FwContext& c) {
        const FwFireProfileDef def = edge::readDef(given);
        checkPointer(size, "size");
        const auto profile = core::Owned<volume::Profile>::make(&c.memory);
        components::readFireProfile(def, &c.memory, *profile);
        (void)giveCooked(volume::cookProfile(*profile, &c.memory), "fire profile", buffer, *size);
    });
}

}  // extern "C"
