// Cost of baking real meshes into 1024^2 texels, one thread. Rows need FLAMEWRIGHT_ASSETS.
#include <benchmark/benchmark.h>

#include "mesh/bake.h"
#include "support/meshes.h"

namespace {

void bakeMesh(benchmark::State& state, const char* name) {
    fw::test::Mesh mesh;
    std::string error;
    if (!fw::test::loadGlb(name, mesh, error)) {
        state.SkipWithError(error.c_str());
        return;
    }
    fw::mesh::BakeInput input = mesh.input(4096, 1024);  // as dense as 1024^2 holds
    input.noiseAmplitude = 0.15f;
    uint32_t texels = 0;
    for (auto _ : state) {
        const fw::mesh::BurnDomain domain = fw::mesh::bake(input, std::pmr::new_delete_resource());
        texels = domain.report.realTexels;
    }
    state.counters["texels"] = texels;
    state.counters["triangles"] = mesh.triangleCount();
}

BENCHMARK_CAPTURE(bakeMesh, bunny31k, "bunny_31k.glb")
    ->Name("bake/bunny31k/1024")
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);
BENCHMARK_CAPTURE(bakeMesh, bunny35kWithoutUvs, "bunny_35k_nouv.glb")
    ->Name("bake/bunny35k_nouv/1024")
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

}  // namespace
