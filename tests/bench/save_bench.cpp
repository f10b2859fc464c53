// Saves on the cpu backend. Rows: save/burnt1024 and load/burnt1024 (an object with a burnt map of
// 1024 texels a side: its save from a readback, and its load), net/latejoin_bytes (bytes that a
// late client receives).
#include "gpu/cpu/cpu_backend.h"
#include "support/world_defs.h"
#include "world/world.h"

#include "fire/presets.h"

#include <benchmark/benchmark.h>

#include <memory>

namespace fw::test {
namespace {

struct Burnt {
    std::pmr::memory_resource* memory = std::pmr::get_default_resource();
    core::Log log{FwCallbacks{}};
    gpu::cpu::CpuBackend backend{memory, 0};
    std::unique_ptr<world::World> world;
    FwBurnableMeshId id{};
    uint64_t frame = 0;

    explicit Burnt(bool burns) {
        FwWorldDef def = plainWorldDef(0);
        def.paceFactor = 50;
        world = std::make_unique<world::World>(def, backend, log, memory);
        const Mesh plane = makePlane(8 - 0.04, 8 - 0.04);
        FwMeshDef mesh = plainMeshDef(plane, 128);
        mesh.mapSize = 1024;
        mesh.noiseAmplitude = 0.15f;  // as the default has it
        mesh.noiseFeature = 0.012f;
        FwBurnableMeshDef object = plainBurnableDef(world->scene().createMesh(mesh));
        for (const int i : {0, 5, 10, 15}) object.transform[i] = 1;
        object.materials[0] = world->scene().createMaterial(fire::presetDef(FW_MATERIAL_PAPER));
        id = world->createBurnableMesh(object);
        if (!burns) return;
        FwIgnitionDef match{};
        match.position[0] = match.position[1] = 0.45f;
        match.radius = 0.05f;
        (void)world->burn().ignite(match);
        FwObjectState state{};
        do {
            world->advance(++frame, 0.5f);
            world->queries().objectState(id, state);
        } while (frame < 20 || (state.burning > 0 && frame < 4000));
        FwWorldStats stats{};
        do {  // until it is cold
            world->advance(++frame, 0.5f);
            world->stats(stats);
        } while (stats.hotTiles > 0 && frame < 8000);
    }
    void save() {
        world->persistence().requestSave();
        world->advance(++frame, 0);
    }
};

Burnt& burnt() {
    static Burnt one(true);
    return one;
}

void saves(benchmark::State& state) {
    Burnt& one = burnt();
    for (auto _ : state) one.save();
    state.counters["bytes"] = double(one.world->persistence().fetchSave()->size());
    FwObjectState object{};
    one.world->queries().objectState(one.id, object);
    state.counters["burnt"] = double(object.ignited) / double(object.texels);
    state.counters["texels"] = double(object.texels);
}

void loads(benchmark::State& state) {
    burnt().save();
    const std::pmr::vector<std::byte> bytes = *burnt().world->persistence().fetchSave();
    static Burnt other(false);
    for (auto _ : state) other.world->persistence().load(bytes);
    state.counters["bytes"] = double(bytes.size());
}

BENCHMARK(saves)->Name("save/burnt1024")->Unit(benchmark::kMillisecond);
BENCHMARK(saves)->Name("net/latejoin_bytes")->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(loads)->Name("load/burnt1024")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fw::test
