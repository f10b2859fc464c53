// Shared by the ABI tests: a host that counts its memory and keeps its log, and small meshes.
// Includes public headers only.
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
#include <new>
#include <string>
#include <vector>

namespace host {

using Bytes = std::vector<unsigned char>;
using fw::test::addBurnable;
using fw::test::created;
using fw::test::getState;
using fw::test::lastMessage;
using fw::test::materialOf;

// Memory and log of a host. Fails allocation number `failAt`; with `failAlways` also every later
// one.
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
        void* memory = ::operator new(size, std::align_val_t(alignment), std::nothrow);
        if (memory) {
            host->bytes += int64_t(size);
            ++host->blocks;
        }
        return memory;
    }
    static void FW_CALL release(void* userData, void* memory, size_t size, size_t alignment) {
        auto* host = static_cast<Host*>(userData);
        host->bytes -= int64_t(size);
        --host->blocks;
        ::operator delete(memory, std::align_val_t(alignment), std::nothrow);
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

// Returns null if the backend is missing. A missing device fails the test where a device is
// required.
inline FwContext* createContext(Host& host, uint32_t backend) {
    FwContextDef def = fwDefaultContextDef();
    def.backend = backend;
    def.callbacks = host.callbacks();
    FwContext* context = nullptr;
    FwErrorInfo error{};
    if (fwCreateContext(&def, &context, &error) == FW_OK) return context;
    if (backend == FW_BACKEND_CPU || error.result != FW_ERROR_UNSUPPORTED_DEVICE ||
        std::getenv("FLAMEWRIGHT_REQUIRE_GPU"))
        ADD_FAILURE() << error.message;
    return nullptr;
}
inline FwContext* createCpuContext(Host& host) { return createContext(host, FW_BACKEND_CPU); }

// A flat sheet in the plane y = 0 of cells x cells quads with unique UVs.
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

// Fetches a requested answer. On a device it comes with a later frame, which may have deltaTime 0.
template <class Fetch>
void come(FwWorld* world, Fetch fetch) {
    FwResult result = fetch();
    for (int i = 0; i < 8 && result == FW_NOT_READY; ++i) {
        EXPECT_EQ(FW_OK, fwWorld_Step(world, 0)) << lastMessage(world);
        result = fetch();
    }
    EXPECT_EQ(FW_OK, result) << lastMessage(world);
}
inline Bytes saveOf(FwWorld* world) {
    EXPECT_EQ(FW_OK, fwWorld_RequestSave(world)) << lastMessage(world);
    uint64_t size = 0;
    come(world, [&] { return fwWorld_FetchSave(world, nullptr, &size); });
    Bytes bytes(size);
    EXPECT_EQ(FW_OK, fwWorld_FetchSave(world, bytes.data(), &size)) << lastMessage(world);
    return bytes;
}

// Hashes every texel of the objects, their heat and the tick.
template <class Ids>
uint64_t hashOf(FwWorld* world, const Ids& ids) {
    uint64_t all = 0;
    for (const FwBurnableMeshId id : ids)
        EXPECT_EQ(FW_OK, fwDebug_RequestBurnMap(world, id)) << lastMessage(world);
    for (const FwBurnableMeshId id : ids) {
        uint64_t one = 0, tick = 0;
        come(world,
             [&] { return fwDebug_FetchBurnMap(world, id, nullptr, 0, nullptr, &one, &tick); });
        all = all * 31 + one + tick;
    }
    return all;
}

// A host with a context and a world, which are null without the backend. Fails if memory leaks.
struct HostedWorld {
    explicit HostedWorld(uint32_t backend, const FwWorldDef& def = fwDefaultWorldDef(),
                         FwContext* given = nullptr)
        : isCpu(backend == FW_BACKEND_CPU && !given),
          context(given ? given : createContext(host, backend)) {
        if (context) {
            EXPECT_EQ(FW_OK, fwCreateWorld(context, &def, &world)) << lastMessage(context);
        }
    }
    HostedWorld(const HostedWorld&) = delete;
    HostedWorld& operator=(const HostedWorld&) = delete;
    ~HostedWorld() {
        fwDestroyContext(context);  // destroys the world too
        EXPECT_EQ(0, host.blocks);
        EXPECT_EQ(0, host.bytes);
    }

    void ok(FwResult result) { EXPECT_EQ(FW_OK, result) << lastMessage(world); }
    // Applies a ball to an object (null: to all); returns the reached texels.
    uint32_t touch(uint32_t kind, FwBurnableMeshId id, float x, float y, float z, float radius,
                   float delay = 0, FwResult* result = nullptr) {
        FwIgnitionDef def = fwDefaultIgnitionDef();
        def.kind = kind;
        def.object = id;
        def.position[0] = x;
        def.position[1] = y;
        def.position[2] = z;
        def.radius = radius;
        def.delay = delay;
        uint32_t texels = 0;
        const FwResult got = fwWorld_Ignite(world, &def, &texels);
        EXPECT_LE(FW_OK, got) << lastMessage(world);
        if (result) *result = got;
        return texels;
    }
    // As touch, which must succeed and reach texels.
    void touches(uint32_t kind, FwBurnableMeshId id, float x, float y, float z, float radius) {
        FwResult result{};
        EXPECT_LT(0u, touch(kind, id, x, y, z, radius, 0, &result));
        ok(result);
    }
    void ignite(FwBurnableMeshId id, float x, float y, float z, float radius = 0.02f) {
        touches(FW_IGNITE, id, x, y, z, radius);
    }
    void run(double seconds, float deltaTime = 1.0f / 32) {
        for (double t = 0; t < seconds - 1e-9; t += double(deltaTime))
            ASSERT_EQ(FW_OK, fwWorld_Step(world, deltaTime)) << lastMessage(world);
    }
    // An answer, which the cpu backend must have at once.
    template <class Fetch>
    void fetch(Fetch answer) {
        if (isCpu)
            ok(answer());
        else
            come(world, answer);
    }
    std::vector<FwEvent> poll() {
        std::vector<FwEvent> all(256);
        all.resize(fwWorld_PollEvents(world, all.data(), uint32_t(all.size())));
        return all;
    }
    FwObjectState state(FwBurnableMeshId id) { return getState(fwWorld_GetObjectState, world, id); }
    FwPointState point(FwBurnableMeshId id, float x, float y, float z) {
        const float position[3] = {x, y, z};
        FwQueryId query{};
        ok(fwWorld_RequestPoint(world, id, position, &query));
        FwPointState made{};
        made.structSize = sizeof made;
        fetch([&] { return fwWorld_FetchPoint(world, query, &made); });
        return made;
    }
    uint64_t hash(FwBurnableMeshId id, uint64_t* tick = nullptr) {
        ok(fwDebug_RequestBurnMap(world, id));
        uint64_t made = 0;
        fetch([&] { return fwDebug_FetchBurnMap(world, id, nullptr, 0, nullptr, &made, tick); });
        return made;
    }

    const bool isCpu;
    Host host;
    FwContext* context = nullptr;
    FwWorld* world = nullptr;
};

inline FwWorldDef pacedDef(float pace) {
    FwWorldDef def = fwDefaultWorldDef();
    def.paceFactor = pace;
    return def;
}
inline FwWorldDef worldDef(uint32_t flags, float pace = 1, uint32_t maxSteps = 64) {
    FwWorldDef def = fwDefaultWorldDef();
    def.flags = flags;
    def.paceFactor = pace;
    def.maxStepsPerFrame = maxSteps;
    return def;
}

// A cpu world with one sheet in it.
class SheetWorld : public HostedWorld {
 public:
    explicit SheetWorld(const FwMaterialDef& material, float width = 1.0f, float depth = 0.25f,
                        float texelsPerMetre = 64, const FwWorldDef& def = fwDefaultWorldDef())
        : HostedWorld(FW_BACKEND_CPU, def),
          sheet(width, depth),
          mesh(created(fwWorld_CreateMesh, world, sheet.def(texelsPerMetre))),
          materialId(created(fwWorld_CreateMaterial, world, material)),
          object(add(7)) {}

    FwBurnableMeshId add(uint64_t userData) {
        FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
        def.mesh = mesh;
        def.materials[0] = materialId;
        def.userData = userData;
        return created(fwWorld_CreateBurnableMesh, world, def);
    }
    uint32_t ball(uint32_t kind, float x, float y, float z, float radius, float delay = 0) {
        return touch(kind, object, x, y, z, radius, delay);
    }
    std::vector<FwEvent> events() { return poll(); }
    FwObjectState state() { return HostedWorld::state(object); }
    FwPointState point(float x, float y, float z) { return HostedWorld::point(object, x, y, z); }
    uint64_t hash(uint64_t* tick = nullptr) { return HostedWorld::hash(object, tick); }

    Sheet sheet;
    FwMeshId mesh{};
    FwMaterialId materialId{};
    FwBurnableMeshId object{};
};

}  // namespace host
