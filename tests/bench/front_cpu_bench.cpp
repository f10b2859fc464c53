// The front on the cpu backend, one thread.
// front/wide_cpu/1024: a front 1024 texels wide, about 150 due tiles.
// front/mapsize_smallfire_cpu/N: one small fire on growing maps.
// query/eta: a fire in the corner of a 1024 map is predicted until all has burnt; us_tile: a tile
// of a slice.
#include "support/front_rig.h"

#include <benchmark/benchmark.h>

#include <map>

namespace fw::test::front_cpu_bench {
namespace {

const mesh::BurnDomain& planeDomain(double width, double height) {
    static std::map<std::pair<double, double>, mesh::BurnDomain> known;
    const auto key = std::make_pair(width, height);
    const auto found = known.find(key);
    if (found != known.end()) return found->second;
    const Mesh plane = makePlane(width, height);
    mesh::BakeInput input = plane.input(128, 4096);
    input.trustUvs = true;
    return known.emplace(key, mesh::bake(input, std::pmr::get_default_resource())).first->second;
}

// One step at a time while the fire lives, then a new fire.
void steps(benchmark::State& state, const mesh::BurnDomain& d, const FrontRig::Material& material,
           Vec3 drive, uint32_t window, const std::function<bool(Vec3)>& lit, uint32_t warmUp,
           uint32_t most) {
    std::unique_ptr<FrontRig> rig;
    const auto start = [&] {
        rig = std::make_unique<FrontRig>(d, material, drive);
        rig->setTiming(window);
        rig->ignite([&](uint32_t i) { return lit(texelPosition(d, i)) ? 0.0 : -1.0; });
        while (rig->steps < warmUp) rig->step();
    };
    start();
    uint64_t tiles = 0, count = 0;
    for (auto _ : state) {
        if (rig->steps >= most) {
            state.PauseTiming();
            start();
            state.ResumeTiming();
        }
        rig->step();
        tiles += rig->runTiles;
        ++count;
    }
    state.counters["tiles"] = double(tiles) / double(std::max<uint64_t>(count, 1));
}

void wide(benchmark::State& state, double gain) {
    const mesh::BurnDomain& d = planeDomain(8 - 0.04, 2);
    const double rate = 0.1 / (1 + gain), h = double(d.texelSide);
    const uint32_t window = gain > 0 ? uint32_t(h / rate * 4096) : 512;
    steps(
        state, d, {.rate = rate, .headGain = gain, .backGain = gain},
        gain > 0 ? Vec3{0, 0.9, 0.1} : Vec3{}, window, [](Vec3 p) { return p.y < 0.02; }, 60, 500);
}

void smallFire(benchmark::State& state, double side) {
    const mesh::BurnDomain& d = planeDomain(side / 128 - 0.06, side / 128 - 0.06);
    steps(
        state, d, {.rate = 0.02}, {}, 512,
        [](Vec3 p) { return std::hypot(p.x - 0.45, p.y - 0.45) < 0.025; }, 320, 640);
}

void arrivals(benchmark::State& state) {
    const mesh::BurnDomain& d = planeDomain(8 - 0.04, 8 - 0.04);
    FrontRig rig(d, {.rate = 0.02});
    rig.ignite([&](uint32_t i) {
        const Vec3 p = texelPosition(d, i);
        return std::hypot(p.x - 0.45, p.y - 0.45) < 0.025 ? 0.0 : -1.0;
    });
    for (int i = 0; i < 320; ++i) rig.step();
    const mesh::ArrivalInput input = rig.arrivalInput();
    mesh::Arrivals ahead(std::pmr::get_default_resource());
    uint64_t tiles = 0;
    for (auto _ : state) {
        mesh::beginArrivals(ahead, input);
        while (!ahead.whole) tiles += 1024 - mesh::runArrivals(ahead, 1024);
    }
    state.counters["tiles"] = double(tiles) / double(state.iterations());
    state.counters["us_tile"] = benchmark::Counter(
        double(tiles) * 1e-6, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

BENCHMARK(arrivals)->Name("query/eta")->Unit(benchmark::kMillisecond)->Iterations(5);
BENCHMARK_CAPTURE(wide, still, 0.0)->Name("front/wide_cpu/1024")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(wide, wind, 2.732)
    ->Name("front/wide_cpu_wind/1024")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(smallFire, small, 256.0)
    ->Name("front/mapsize_smallfire_cpu/256")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(smallFire, large, 1024.0)
    ->Name("front/mapsize_smallfire_cpu/1024")
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fw::test::front_cpu_bench
