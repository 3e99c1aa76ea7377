// How many stereo pairs a second, on one core?
//
// The whole of StereoCamera::Capture (render, read back, lens, noise) along one lap of five_laps,
// with shadows and the traffic of the scenario. The range is the number of meshes: 1 is the
// scene as it is, 10 adds nine more of everything where the camera does not look.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "sim/simulator.h"
#include "sim/world/scene_builder.h"

namespace polnav::sim {
namespace {

// The world of scenarios/five_laps.yaml.
SimulatorOptions FiveLaps() {
  SimulatorOptions options;
  options.site = {.latitude_deg = 38.832,
                  .longitude_deg = 121.503,
                  .altitude_m = 20.0,
                  .utc = "2020-11-11T07:00:00Z"};
  options.sky.clear.model = "berry";
  options.sky.thin_cloud_cover = 0.05;
  options.world.terrain = {.slope_deg = 1.0, .camber_deg = 1.5};
  options.world.traffic = {.cars = 6, .pedestrians = 24, .speed_m_s = 7.5};
  options.sensors.stereo = StereoCameraOptions{};
  return options;
}

// The same meshes again, beyond the far plane and all around.
void AddCopies(int copies, Scene& scene) {
  const std::size_t count = scene.meshes.size();
  for (int copy = 0; copy < copies; ++copy) {
    const double angle = 2.0 * M_PI * copy / copies;
    const Eigen::Vector3f shift(static_cast<float>(900.0 * std::cos(angle)),
                                static_cast<float>(900.0 * std::sin(angle)), 0.0F);
    for (std::size_t i = 0; i < count; ++i) {
      Mesh mesh = scene.meshes[i];
      for (Vertex& v : mesh.vertices) v.p_W_m += shift;
      scene.meshes.push_back(std::move(mesh));
    }
  }
}

std::vector<FrameRequest> OneLap(Simulator& simulator) {
  std::vector<FrameRequest> frames;
  while (simulator.truth().stamp < nav::FromSeconds(65.0)) {
    for (const Simulator::Emission& emission : simulator.Step()) {
      const auto* frame = std::get_if<FrameRequest>(&emission);
      if (frame != nullptr) frames.push_back(*frame);
    }
  }
  return frames;
}

// A second of frames here, a second there: what changes once a second is paid for as in a run, and
// few frames already come from all over the lap.
std::size_t PlaceOf(std::size_t n, std::size_t frames) {
  constexpr std::size_t kRate = 10;
  return n % kRate + kRate * (13 * (n / kRate) % (frames / kRate));
}

void RenderStereo(benchmark::State& state, int width_px, int height_px, double focal_px) {
  SimulatorOptions options = FiveLaps();
  options.sensors.stereo->width_px = width_px;
  options.sensors.stereo->height_px = height_px;
  options.sensors.stereo->focal_px = focal_px;
  Simulator simulator(options, {});
  Scene scene = simulator.scene();
  AddCopies(static_cast<int>(state.range(0)) - 1, scene);
  const std::vector<FrameRequest> lap = OneLap(simulator);
  StereoCamera camera(scene, simulator.sky(), *simulator.true_stereo(), *options.sensors.stereo, 1,
                      0);
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(camera.Capture(lap[PlaceOf(next++, lap.size())]));
  }
  state.counters["pairs_per_s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void BM_RenderStereo(benchmark::State& state, int width_px, int height_px, double focal_px) {
  RenderStereo(state, width_px, height_px, focal_px);
}
BENCHMARK_CAPTURE(BM_RenderStereo, vga, 672, 376, 350.0)
    ->Arg(1)
    ->Arg(10)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_RenderStereo, hd, 1280, 720, 667.0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace polnav::sim
