// How long does the stereo estimator take for a frame's features?
//
// 30 s along a synthetic street at 6 m/s, ten frames a second with some 200 features each and an
// IMU at 100 Hz: pose, and at every keyframe bundle adjustment, covariance and marginalization.
#include <benchmark/benchmark.h>

#include <vector>

#include "nav/stereo/estimator.h"
#include "tests/nav/synthetic_street.h"

namespace polnav::nav {
namespace {

constexpr double kRadius_m = 60.0;
constexpr double kSpeed_m_s = 6.0;
constexpr int kFrames = 300;

StereoEstimator MakeEstimator(bool with_imu) {
  std::optional<ImuCalibration> imu;
  if (with_imu) {
    imu = {.rate_hz = 100.0,
           .gyro_noise_rad_s_sqrt_hz = DegToRad(0.0025),
           .accel_noise_m_s2_sqrt_hz = 2.5e-4,
           .gyro_bias_sigma_rad_s = DegToRad(0.1),
           .accel_bias_sigma_m_s2 = 0.015};
  }
  const StartPrior start{.heading_sigma_rad = 0.02, .level_sigma_rad = 0.02};
  return {StereoOptions{}, TestCalibration(), imu, start, std::nullopt};
}

std::vector<StereoFeatures> DriveAlong() {
  const RectifiedCamera camera = StereoRectifier(TestCalibration()).camera();
  SyntheticStreet street(camera, kRadius_m, 7);
  std::vector<StereoFeatures> frames;
  for (int k = 0; k < kFrames; ++k) {
    frames.push_back(street.See(street.PoseAt(0.1 * kSpeed_m_s * k), k * kNsPerSecond / 10, 0.2));
  }
  return frames;
}

// A steady turn: the same reading all the time.
void FeelUntil(TimeNs stamp, StereoEstimator& estimator) {
  for (TimeNs t = stamp - 9 * kNsPerSecond / 100; t <= stamp; t += kNsPerSecond / 100) {
    ImuSample sample{.stamp = t};
    sample.gyro_rad_s.z() = kSpeed_m_s / kRadius_m;
    sample.accel_m_s2 = {0.0, kSpeed_m_s * kSpeed_m_s / kRadius_m, kGravity_m_s2};
    (void)estimator.Process(sample);
  }
}

void BM_GraphUpdate(benchmark::State& state, bool with_imu) {
  const std::vector<StereoFeatures> frames = DriveAlong();
  StereoEstimator estimator = MakeEstimator(with_imu);
  std::size_t next = 0;
  for (auto _ : state) {
    if (next == frames.size()) {
      state.PauseTiming();
      estimator = MakeEstimator(with_imu);
      next = 0;
      state.ResumeTiming();
    }
    FeelUntil(frames[next].stamp, estimator);
    benchmark::DoNotOptimize(estimator.Process(frames[next++]));
  }
}
BENCHMARK_CAPTURE(BM_GraphUpdate, vision, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_GraphUpdate, vision_and_imu, true)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace polnav::nav
