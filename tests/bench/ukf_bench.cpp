// The walker's filter: one IMU step, and one flow reading with its range.
#include <benchmark/benchmark.h>

#include "nav/ukf/correct.h"
#include "nav/ukf/ground_sensors.h"
#include "nav/ukf/predict.h"
#include "nav/ukf/start.h"

namespace polnav::nav::ukf {
namespace {

State Walking() {
  const ImuCalibration imu{.rate_hz = 100.0,
                           .gyro_noise_rad_s_sqrt_hz = 7e-5,
                           .accel_noise_m_s2_sqrt_hz = 1e-3,
                           .gyro_bias_sigma_rad_s = 0.017,
                           .accel_bias_sigma_m_s2 = 0.4};
  const OpticalFlowCalibration flow{.flow_noise_rad_s_sqrt_hz = 1e-4, .flow_scale_sigma = 0.01};
  State state = StartState({}, imu, flow, {.heading_sigma_rad = 0.02, .level_sigma_rad = 0.02}, 0);
  state.p_WI.z() = 0.1;
  state.v_WI = {0.1, 0.02, 0.0};
  state.P(kTerrain, kTerrain) = 1e-4;
  return state;
}

GroundSensor Sensor() {
  GroundSensor sensor;
  sensor.T_IF = {Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0), {0.2, 0.0, 0.3}};
  sensor.calibration.range_sigma_m = 0.003;
  sensor.calibration.flow_noise_rad_s_sqrt_hz = 1e-4;
  return sensor;
}

void BM_UkfPredict(benchmark::State& bench) {
  const State start = Walking();
  const ProcessNoise noise = NoiseOf({.rate_hz = 100.0}, {}, 15.0);
  for (auto _ : bench) {
    State state = start;
    Predict({0.1, -0.2, 0.3}, {0.3, -0.1, 9.8}, 0.01, 10'000'000, noise, state);
    benchmark::DoNotOptimize(state);
  }
}
BENCHMARK(BM_UkfPredict);

void BM_UkfUpdate(benchmark::State& bench) {
  const State start = Walking();
  const GroundSensor sensor = Sensor();
  const FlowInterval interval{.rate_rad_s = {0.1, -0.2, 0.3}, .duration_s = 0.02};
  for (auto _ : bench) {
    State state = start;
    const Expected<2> expected = ExpectFlow(state, sensor, interval);
    const Correction done = Correct<2>(expected, Eigen::Vector2d(1e-4, -1e-4),
                                       1e-6 * Eigen::Matrix2d::Identity(), 4.0, state);
    benchmark::DoNotOptimize(done);
    benchmark::DoNotOptimize(state);
  }
}
BENCHMARK(BM_UkfUpdate);

}  // namespace
}  // namespace polnav::nav::ukf
