// Ten thousand crates, ten of them burning, on the cpu backend: cost of a step at rest, while one
// or a thousand walk, while crates are created and destroyed, at the first match, and in rain on
// all. A row that moves crates leaves them settled for the next. Time: this process's threads.
// Counters: texels per crate; burning: crates; slowest_ms: of all steps; bytes per crate in every
// pool of the memory report (objects10k/memory; device: objects1k/memory_on_device).
#include "bench/bench_device.h"
#include "flamewright/flamewright.h"
#include "support/meshes.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace fw::test::objects_bench {
namespace {

constexpr float kApart = 0.7f, kStep = 1.0f / 32;  // m, s
constexpr uint32_t kBurning = 10, kWalking = 1000;

struct Square {
    FwContext* context = nullptr;
    FwWorld* world = nullptr;
    FwBurnableMeshDef def{};
    std::vector<FwBurnableMeshId> ids;
    uint32_t side = 0, texels = 0;

    ~Square() {
        if (world) fwDestroyWorld(world);
        if (context) fwDestroyContext(context);
    }
    void place(uint32_t i, float shift) {
        def.transform[12] = kApart * float(i % side) + shift;
        def.transform[14] = kApart * float(i / side);
    }
    void move(uint32_t i, float shift) {
        place(i, shift);
        fwWorld_SetTransform(world, ids[i], def.transform);
    }
    void step(uint32_t count = 1) {
        for (uint32_t i = 0; i < count; ++i) fwWorld_Step(world, kStep);
    }
    // Returns null on success.
    const char* make(uint32_t count, uint32_t backend = FW_BACKEND_CPU) {
        FwContextDef contextDef = fwDefaultContextDef();
        contextDef.backend = backend;
        FwErrorInfo info{};
        if (fwCreateContext(&contextDef, &context, &info) != FW_OK) return "there is no context";
        FwWorldDef worldDef = fwDefaultWorldDef();
        worldDef.flags = FW_WORLD_RADIATION | FW_WORLD_PLUME | FW_WORLD_CONTACT | FW_WORLD_EMBERS;
        if (fwCreateWorld(context, &worldDef, &world) != FW_OK) return "there is no world";
        const Mesh crate = makeCube(0.4, 1);
        FwMeshDef mesh = fwDefaultMeshDef();
        mesh.positions = crate.positions.data();
        mesh.vertexCount = crate.vertexCount();
        mesh.indices = crate.indices.data();
        mesh.indexCount = uint32_t(crate.indices.size());
        mesh.texelsPerMetre = 36;
        def = fwDefaultBurnableMeshDef();
        FwMaterialDef pine = fwDefaultMaterialDef();
        fwInitMaterialPreset(&pine, FW_MATERIAL_PINE);
        if (fwWorld_CreateMesh(world, &mesh, &def.mesh) != FW_OK ||
            fwWorld_CreateMaterial(world, &pine, &def.materials[0]) != FW_OK)
            return "there is no mesh";
        FwMeshInfo meshInfo{};
        meshInfo.structSize = sizeof meshInfo;
        fwWorld_GetMeshInfo(world, def.mesh, &meshInfo);
        texels = meshInfo.texels;
        if (texels < 1024) return "the crate has too few texels";
        while (side * side < count) ++side;
        ids.resize(count);
        for (uint32_t i = 0; i < count; ++i) {
            place(i, 0);
            if (fwWorld_CreateBurnableMesh(world, &def, &ids[i]) != FW_OK)
                return "not all crates can be made";
        }
        step(8);
        return nullptr;
    }
    void light(uint32_t i) {
        FwIgnitionDef match = fwDefaultIgnitionDef();
        match.object = ids[i];
        match.position[0] = kApart * float(i % side);
        match.position[1] = 0.2f;
        match.position[2] = kApart * float(i / side);
        match.radius = 0.1f;
        fwWorld_Ignite(world, &match, nullptr);
    }
    const char* lightTen() {
        for (uint32_t i = 0; i < kBurning; ++i) light(uint32_t(ids.size()) / 2 + side / 2 + 3 * i);
        step(64);
        return burning() == kBurning ? nullptr : "other than ten crates burn";
    }
    uint32_t burning() {
        FwWorldStats stats{};
        stats.structSize = sizeof stats;
        fwWorld_GetStats(world, &stats);
        return stats.burningObjects;
    }
};

// One scene for all rows of that many crates that leave it unchanged.
Square* lit(uint32_t count, benchmark::State& state) {
    static std::unique_ptr<Square> squares[2];
    std::unique_ptr<Square>& one = squares[count == 10000 ? 0 : 1];
    if (!one) {
        one = std::make_unique<Square>();
        const char* why = one->make(count);
        if (!why) why = one->lightTen();
        if (why) {
            state.SkipWithError(why);
            one = nullptr;
        }
    }
    return one.get();
}

template <class Moves>
void run(benchmark::State& state, Square& square, const Moves& moves) {
    square.step(8);
    uint32_t i = 0;
    double slowest = 0;
    for (auto _ : state) {
        const double start = cpuSeconds();
        moves(square, i++);
        square.step();
        const double seconds = cpuSeconds() - start;
        state.SetIterationTime(seconds);
        slowest = std::max(slowest, seconds);
    }
    state.counters["slowest_ms"] = 1e3 * slowest;
    state.counters["burning"] = square.burning();
    state.counters["texels"] = square.texels;
}

template <class Moves>
void steps(benchmark::State& state, uint32_t count, const Moves& moves) {
    if (Square* square = lit(count, state)) run(state, *square, moves);
}

// m along a row at 1.5 m/s: `way` steps out and back. Four stay in the gap between two crates.
float shiftOf(uint32_t step, uint32_t way = 4) {
    const uint32_t at = step % (2 * way);
    return 1.5f * kStep * float(std::min(at, 2 * way - at));
}

void rest(benchmark::State& state) {
    steps(state, 10000, [](Square&, uint32_t) {});
}

void oneWalks(benchmark::State& state) {
    // Exchange periods of four steps, alternately walking and resting; reports their ratio.
    Square* square = lit(10000, state);
    if (!square) return;
    square->step(8);
    double walks = 0, rests = 0;
    uint32_t i = 0;
    for (auto _ : state) {
        const double start = cpuSeconds();
        for (uint32_t k = 0; k < 4; ++k) {
            square->move(0, -1 - shiftOf(i++, 64));
            square->step();
        }
        const double walked = cpuSeconds();
        square->step(4);
        rests += cpuSeconds() - walked;
        walks += walked - start;
        state.SetIterationTime((walked - start) / 4);
    }
    state.counters["of_rest"] = walks / rests;
    state.counters["burning"] = square->burning();
    state.counters["texels"] = square->texels;
}

void thousandWalk(benchmark::State& state) {
    steps(state, 10000, [](Square& s, uint32_t i) {
        for (uint32_t k = 0; k < kWalking; ++k)
            s.move(k * (uint32_t(s.ids.size()) / kWalking), shiftOf(i));
    });
}

// The same, but through each other: all of them approach, touch, or part.
void thousandTouch(benchmark::State& state) {
    Square square;  // its own scene: links remain where crates have met
    const char* why = square.make(10000);
    if (!why) why = square.lightTen();
    if (why) return state.SkipWithError(why);
    run(state, square, [](Square& s, uint32_t i) {
        for (uint32_t k = 0; k < kWalking; ++k)
            s.move(k * (uint32_t(s.ids.size()) / kWalking), shiftOf(i, 64));
    });
}

void allWalk(benchmark::State& state) {
    steps(state, 2000, [](Square& s, uint32_t i) {
        for (uint32_t k = 0; k < s.ids.size(); ++k) s.move(k, shiftOf(i));
    });
}

void spawn(benchmark::State& state) {
    FwBurnableMeshId last{};
    steps(state, 10000, [&](Square& s, uint32_t i) {
        if (last.index1 != 0) fwWorld_DestroyBurnableMesh(s.world, last);
        s.place(i % s.side, 0);
        s.def.transform[14] = -kApart;
        fwWorld_CreateBurnableMesh(s.world, &s.def, &last);
    });
    if (Square* square = last.index1 != 0 ? lit(10000, state) : nullptr)
        fwWorld_DestroyBurnableMesh(square->world, last);
}

void firstMatch(benchmark::State& state) {
    for (auto _ : state) {
        Square square;
        if (const char* why = square.make(10000)) return state.SkipWithError(why);
        const double start = cpuSeconds();
        square.light(5050);
        square.step();
        state.SetIterationTime(cpuSeconds() - start);
        state.counters["texels"] = square.texels;
    }
}

void rain(benchmark::State& state) {
    for (auto _ : state) {
        Square square;
        const char* why = square.make(10000);
        if (!why) why = square.lightTen();
        if (why) return state.SkipWithError(why);
        FwIgnitionDef ball = fwDefaultIgnitionDef();
        ball.kind = FW_WET;
        ball.water = 5;
        ball.radius = 1000;
        ball.position[0] = ball.position[2] = 35;
        uint32_t wetted = 0;
        const double start = cpuSeconds();
        fwWorld_Ignite(square.world, &ball, &wetted);
        const double called = cpuSeconds();
        square.step();
        state.SetIterationTime(cpuSeconds() - start);
        state.counters["call_ms"] = 1e3 * (called - start);
        state.counters["wetted"] = wetted;
        state.counters["texels"] = square.texels;
    }
}

// Bytes per crate by pool, none burning: all crates less one.
template <uint32_t kBackend, uint32_t kCount>
void memoryOf(benchmark::State& state) {
    constexpr uint32_t kRows = 256;
    const auto report = [&](uint32_t count, std::vector<FwMemoryRow>& rows) -> const char* {
        Square square;
        if (const char* why = square.make(count, kBackend)) return why;
        rows.resize(kRows);
        rows.resize(std::min(fwContext_GetMemoryReport(square.context, rows.data(), kRows), kRows));
        FwContextInfo info{};
        info.structSize = sizeof info;
        fwContext_GetInfo(square.context, &info);
        FwMemoryRow all{};  // includes bytes in no pool
        std::snprintf(all.name, sizeof all.name, "%s", "cpu memory in all");
        all.bytes = info.cpuMemoryUsed;
        rows.push_back(all);
        std::snprintf(all.name, sizeof all.name, "%s", "device memory in all");
        all.bytes = info.gpuMemoryUsed;
        rows.push_back(all);
        state.counters["texels"] = square.texels;
        return nullptr;
    };
    for (auto _ : state) {
        std::vector<FwMemoryRow> one, all;
        const double start = cpuSeconds();
        for (const bool many : {false, true})
            if (const char* why = report(many ? kCount : 1, many ? all : one))
                return state.SkipWithError(why);
        state.SetIterationTime(cpuSeconds() - start);
        for (const FwMemoryRow& row : all) {
            uint64_t before = 0;
            for (const FwMemoryRow& other : one)
                if (std::string(other.name) == row.name) before = other.bytes;
            if (row.bytes > before)
                state.counters[row.name] = double(row.bytes - before) / (kCount - 1);
        }
    }
}

void row(const char* name, void (*run)(benchmark::State&), int iterations) {
    benchmark::RegisterBenchmark(name, run)
        ->Unit(benchmark::kMillisecond)
        ->UseManualTime()
        ->Iterations(iterations);
}

const bool rows = [] {
    row("objects10k/rest", rest, 128);
    row("objects10k/one_walks", oneWalks, 32);
    row("objects10k/thousand_walk", thousandWalk, 64);
    row("objects10k/thousand_touch", thousandTouch, 64);
    row("objects10k/spawn", spawn, 64);
    row("objects10k/first_match", firstMatch, 3);
    row("objects10k/rain", rain, 3);
    row("objects10k/memory", memoryOf<FW_BACKEND_CPU, 10000>, 1);
    row("objects1k/memory_on_device", memoryOf<FW_BACKEND_VULKAN, 1000>, 1);
    row("objects2k/all_walk", allWalk, 64);
    return true;
}();

}  // namespace
}  // namespace fw::test::objects_bench
