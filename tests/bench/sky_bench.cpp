// How many directions of the sky a second, on one core?
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "sky/sky_batch.h"
#include "sky/sun.h"

namespace polnav::sky {
namespace {

void BM_SkyStokes(benchmark::State& state, const std::string& model) {
  constexpr std::size_t kRays = 4096;  // fits the first cache levels, as an image's row does
  std::vector<double> east, north, up;
  for (std::size_t i = 0; i < kRays; ++i) {
    const Eigen::Vector3d ray =
        DirectionEnu(2.4 * static_cast<double>(i),
                     std::asin((static_cast<double>(i) + 0.5) / static_cast<double>(kRays)));
    east.push_back(ray.x());
    north.push_back(ray.y());
    up.push_back(ray.z());
  }
  std::vector<double> radiance(kRays), q(kRays), u(kRays);
  const ClearSky sky({.model = model}, DirectionEnu(1.0, 0.5));
  for (auto _ : state) {
    LookAlong(sky, {east, north, up}, {radiance, q, u});
    benchmark::DoNotOptimize(radiance.data());
    benchmark::DoNotOptimize(q.data());
    benchmark::DoNotOptimize(u.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kRays));
}
BENCHMARK_CAPTURE(BM_SkyStokes, rayleigh, "rayleigh");
BENCHMARK_CAPTURE(BM_SkyStokes, berry, "berry");
BENCHMARK_CAPTURE(BM_SkyStokes, hazy, "hazy");

// What a new place of the sun costs before the first ray.
void BM_SkyPrepare(benchmark::State& state, const std::string& model) {
  double elevation_rad = 0.3;
  for (auto _ : state) {
    elevation_rad += 1e-9;
    const ClearSky sky({.model = model}, DirectionEnu(1.0, elevation_rad));
    benchmark::DoNotOptimize(&sky);
  }
}
BENCHMARK_CAPTURE(BM_SkyPrepare, berry, "berry");
BENCHMARK_CAPTURE(BM_SkyPrepare, hazy, "hazy");

}  // namespace
}  // namespace polnav::sky
