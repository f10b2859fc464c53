// What the ABI's tests share: a host that counts its memory and keeps its log, and small meshes.
// Public headers only.
#pragma once
#include "flamewright/flamewright.h"
#include "flamewright/flamewright_debug.h"
#include "flamewright/flamewright_vulkan.h"
#include "support/burnable.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string>
#include <vector>

namespace host {

using fw::test::addBurnable;

// Memory and log of a host. Fails the `failAt`-th allocation and, if `failAlways`, all after it.
struct Host {
    std::atomic<int64_t> bytes{0}, blocks{0}, allocations{0};
    int64_t failAt = -1;
    bool failAlways = false;
    std::mutex mutex;
    std::vector<std::string> errors, warnings;
    std::string lastError;

    static void* FW_CALL allocate(void* userData, size_t size, size_t alignment) {
        auto* host = static_cast<Host*>(userData);
        const int64_t number = host->allocations.fetch_add(1);
        if (host->failAt >= 0 &&
            (number == host->failAt || (host->failAlways && number > host->failAt)))
            return nullptr;
        const size_t step = alignment < sizeof(void*) ? sizeof(void*) : alignment;
        void* memory = std::aligned_alloc(step, (size + step - 1) / step * step);
        if (memory) {
            host->bytes += int64_t(size);
            ++host->blocks;
        }
        return memory;
    }
    static void FW_CALL release(void* userData, void* memory, size_t size, size_t) {
        auto* host = static_cast<Host*>(userData);
        host->bytes -= int64_t(size);
        --host->blocks;
        std::free(memory);
    }
    static void FW_CALL log(void* userData, int32_t level, const char* message) {
        auto* host = static_cast<Host*>(userData);
        const std::lock_guard lock(host->mutex);
        if (level == FW_LOG_WARNING) host->warnings.emplace_back(message);
        if (level >= FW_LOG_ERROR) {
            host->errors.emplace_back(message);
            host->lastError = message;
        }
    }
    [[nodiscard]] FwCallbacks callbacks() { return {this, log, allocate, release}; }
};

inline std::string lastMessage(FwWorld* world) {
    std::string text(fwWorld_GetLastMessage(world, nullptr, 0), '\0');
    (void)fwWorld_GetLastMessage(world, text.data(), text.size() + 1);
    return text;
}
inline std::string lastMessage(FwContext* context) {
    std::string text(fwContext_GetLastMessage(context, nullptr, 0), '\0');
    (void)fwContext_GetLastMessage(context, text.data(), text.size() + 1);
    return text;
}

// Null where there is no such backend, which is a failure where a device is required.
inline FwContext* createContext(Host& host, uint32_t backend) {
    FwContextDef def = fwDefaultContextDef();
    def.backend = backend;
    def.callbacks = host.callbacks();
    FwContext* context = nullptr;
    FwErrorInfo error{};
    if (fwCreateContext(&def, &context, &error) == FW_OK) return context;
    if (backend == FW_BACKEND_CPU || std::getenv("FLAMEWRIGHT_REQUIRE_GPU"))
        ADD_FAILURE() << error.message;
    return nullptr;
}
inline FwContext* createCpuContext(Host& host) { return createContext(host, FW_BACKEND_CPU); }

// A flat sheet in the plane y = 0, cells x cells, with unique UVs.
struct Sheet {
    std::vector<float> positions, uvs;
    std::vector<uint32_t> indices;

    Sheet(float width, float depth, int cells = 1) {
        for (int z = 0; z <= cells; ++z)
            for (int x = 0; x <= cells; ++x) {
                const float u = float(x) / float(cells), v = float(z) / float(cells);
                positions.insert(positions.end(), {u * width, 0.0f, v * depth});
                uvs.insert(uvs.end(), {u, v * depth / width});
            }
        const auto at = [&](int x, int z) { return uint32_t(z * (cells + 1) + x); };
        for (int z = 0; z < cells; ++z)
            for (int x = 0; x < cells; ++x)
                indices.insert(indices.end(), {at(x, z), at(x, z + 1), at(x + 1, z), at(x + 1, z),
                                               at(x, z + 1), at(x + 1, z + 1)});
    }
    [[nodiscard]] FwMeshDef def(float texelsPerMetre) const {
        FwMeshDef made = fwDefaultMeshDef();
        made.positions = positions.data();
        made.uvs = uvs.data();
        made.vertexCount = uint32_t(positions.size() / 3);
        made.indices = indices.data();
        made.indexCount = uint32_t(indices.size());
        made.texelsPerMetre = texelsPerMetre;
        made.noiseAmplitude = 0;
        return made;
    }
};

// A material that spreads equally in all directions.
inline FwMaterialDef evenMaterial(float spreadRate, float burnTime) {
    FwMaterialDef def = fwDefaultMaterialDef();
    def.spreadRate = spreadRate;
    def.windGain = 0;
    def.upGain = 0;
    def.headGain = 0;
    def.backGain = 0;
    def.ceilingGain = 0;
    def.moisture = 0;
    def.burnTime = burnTime;
    return def;
}

// A cpu world with one sheet in it.
class SheetWorld {
 public:
    explicit SheetWorld(const FwMaterialDef& material, float width = 1.0f, float depth = 0.25f,
                        float texelsPerMetre = 64, const FwWorldDef& def = fwDefaultWorldDef())
        : sheet(width, depth) {
        context = createCpuContext(host);
        EXPECT_EQ(FW_OK, fwCreateWorld(context, &def, &world)) << lastMessage(context);
        const FwMeshDef meshDef = sheet.def(texelsPerMetre);
        EXPECT_EQ(FW_OK, fwWorld_CreateMesh(world, &meshDef, &mesh)) << lastMessage(world);
        EXPECT_EQ(FW_OK, fwWorld_CreateMaterial(world, &material, &materialId))
            << lastMessage(world);
        object = add(7);
    }
    SheetWorld(const SheetWorld&) = delete;
    SheetWorld& operator=(const SheetWorld&) = delete;
    ~SheetWorld() {
        fwDestroyContext(context);  // and the world with it
        EXPECT_EQ(0, host.blocks);
        EXPECT_EQ(0, host.bytes);
    }

    FwBurnableMeshId add(uint64_t userData) {
        FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
        def.mesh = mesh;
        def.materials[0] = materialId;
        def.userData = userData;
        FwBurnableMeshId id{};
        EXPECT_EQ(FW_OK, fwWorld_CreateBurnableMesh(world, &def, &id)) << lastMessage(world);
        return id;
    }
    uint32_t ball(uint32_t kind, float x, float y, float z, float radius, float delay = 0) {
        FwIgnitionDef def = fwDefaultIgnitionDef();
        def.kind = kind;
        def.object = object;
        def.position[0] = x;
        def.position[1] = y;
        def.position[2] = z;
        def.radius = radius;
        def.delay = delay;
        uint32_t texels = 0;
        EXPECT_LE(FW_OK, fwWorld_Ignite(world, &def, &texels)) << lastMessage(world);
        return texels;
    }
    void run(double seconds, float deltaTime = 1.0f / 32.0f) {
        for (double t = 0; t < seconds - 1e-9; t += double(deltaTime))
            ASSERT_EQ(FW_OK, fwWorld_Step(world, deltaTime)) << lastMessage(world);
    }
    std::vector<FwEvent> events() {
        std::vector<FwEvent> all(256);
        all.resize(fwWorld_PollEvents(world, all.data(), uint32_t(all.size())));
        return all;
    }
    FwObjectState state() {
        FwObjectState made{};
        made.structSize = sizeof made;
        EXPECT_EQ(FW_OK, fwWorld_GetObjectState(world, object, &made)) << lastMessage(world);
        return made;
    }
    FwPointState point(float x, float y, float z) {
        const float position[3] = {x, y, z};
        FwQueryId query{};
        EXPECT_EQ(FW_OK, fwWorld_RequestPoint(world, object, position, &query))
            << lastMessage(world);
        FwPointState made{};
        made.structSize = sizeof made;
        EXPECT_EQ(FW_OK, fwWorld_FetchPoint(world, query, &made)) << lastMessage(world);
        return made;
    }
    uint64_t hash(uint64_t* tick = nullptr) {
        EXPECT_EQ(FW_OK, fwDebug_RequestBurnMap(world, object)) << lastMessage(world);
        uint64_t made = 0;
        EXPECT_EQ(FW_OK, fwDebug_FetchBurnMap(world, object, nullptr, 0, nullptr, &made, tick))
            << lastMessage(world);
        return made;
    }

    Host host;
    Sheet sheet;
    FwContext* context = nullptr;
    FwWorld* world = nullptr;
    FwMeshId mesh{};
    FwMaterialId materialId{};
    FwBurnableMeshId object{};
};

}  // namespace host
