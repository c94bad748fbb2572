#include <benchmark/benchmark.h>
#include <hamel/hamel.hpp>
static void hat(benchmark::State& s) { for (auto _ : s) benchmark::DoNotOptimize(hamel::hat({1,2,3})); }
BENCHMARK(hat);
