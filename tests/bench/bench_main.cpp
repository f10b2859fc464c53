// Entry point of the bench.
#include <benchmark/benchmark.h>

BENCHMARK_MAIN();
