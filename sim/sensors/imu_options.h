// What kind of inertial measurement unit is it?
//
// A preset by name, and whatever is written besides it. docs/imu.md has the presets' figures with
// their sources, and what each error is. Sigmas are of a draw once a trial, each axis by itself.
#pragma once

#include <Eigen/Core>
#include <string>

namespace polnav::sim {

// The sensor's temperature over a run: start at turn-on, end after long. YAML keys = field names.
// Errors count from 25 degrees, where it was calibrated: with the defaults there are none.
struct ImuTemperatureOptions {
  double start_deg_c = 25.0;
  double end_deg_c = 25.0;
  double time_constant_s = 300.0;  // 63 percent of the way from start to end

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("start_deg_c", start_deg_c, {.min = -60.0, .max = 125.0});
    v("end_deg_c", end_deg_c, {.min = -60.0, .max = 125.0});
    v("time_constant_s", time_constant_s, {.min = 1e-3, .max = 1e6});
  }
};

struct ImuOptions;

// icm20602 (phones, drones), adis16475_2 (industrial), span_cpt (fibre-optic gyroscopes), hg4930
// (tactical), perfect (no error at all, no limit). Throws std::logic_error for any other name.
[[nodiscard]] ImuOptions ImuPreset(const std::string& name);

// Defaults: adis16475_2. YAML keys = field names; `preset` replaces the defaults of all others.
struct ImuOptions {
  std::string preset = "adis16475_2";
  double rate_hz = 100.0;
  Eigen::Vector3d position_m = {0.0, 0.0, 0.0};  // in B; its axes are B's

  double gyro_noise_deg_s_sqrt_hz = 0.0025;
  Eigen::Vector3d gyro_bias_deg_s = {0.0, 0.0, 0.0};  // known beforehand; the draw comes on top
  double gyro_bias_sigma_deg_s = 0.1;                 // turn-on to turn-on
  double gyro_bias_instability_deg_h = 2.5;           // floor of the Allan deviation
  double gyro_bias_walk_deg_s_sqrt_s = 3.8e-6;        // grows by this times the root of the seconds
  double gyro_scale_sigma = 0.002;                    // relative
  double gyro_g_sensitivity_deg_s_g = 0.009;          // rate by force along each of the axes
  double gyro_temperature_bias_deg_s_k = 0.002;
  double gyro_temperature_scale_1_k = 2e-5;
  double gyro_range_deg_s = 500.0;         // readings stop here
  double gyro_resolution_deg_s = 0.00625;  // step of the 16-bit output; 0: none

  double accel_noise_mg_sqrt_hz = 0.025;
  Eigen::Vector3d accel_bias_mg = {0.0, 0.0, 0.0};
  double accel_bias_sigma_mg = 1.5;
  double accel_bias_instability_mg = 0.0036;
  double accel_bias_walk_mg_sqrt_s = 2e-5;
  double accel_scale_sigma = 0.001;
  double accel_temperature_bias_mg_k = 0.03;
  double accel_temperature_scale_1_k = 1e-5;
  double accel_range_g = 8.0;
  double accel_resolution_mg = 0.25;

  double misalignment_sigma_deg = 0.1;  // of each axis of each triad towards the two others
  ImuTemperatureOptions temperature;

  template <typename Visitor>
  void Visit(Visitor& v) {
    const std::string known = preset;
    v("preset", preset, {"adis16475_2", "icm20602", "span_cpt", "hg4930", "perfect"});
    if (preset != known) *this = ImuPreset(preset);
    v("rate_hz", rate_hz, {.min = 1.0, .max = 2000.0});
    v("position_m", position_m, {.min = -10.0, .max = 10.0});
    VisitGyro(v);
    VisitAccel(v);
    v("misalignment_sigma_deg", misalignment_sigma_deg, {.min = 0.0, .max = 10.0});
    v("temperature", temperature);
  }

 private:
  template <typename Visitor>
  void VisitGyro(Visitor& v) {
    v("gyro_noise_deg_s_sqrt_hz", gyro_noise_deg_s_sqrt_hz, {.min = 0.0, .max = 1.0});
    v("gyro_bias_deg_s", gyro_bias_deg_s, {.min = -10.0, .max = 10.0});
    v("gyro_bias_sigma_deg_s", gyro_bias_sigma_deg_s, {.min = 0.0, .max = 10.0});
    v("gyro_bias_instability_deg_h", gyro_bias_instability_deg_h, {.min = 0.0, .max = 1000.0});
    v("gyro_bias_walk_deg_s_sqrt_s", gyro_bias_walk_deg_s_sqrt_s, {.min = 0.0, .max = 1.0});
    v("gyro_scale_sigma", gyro_scale_sigma, {.min = 0.0, .max = 0.1});
    v("gyro_g_sensitivity_deg_s_g", gyro_g_sensitivity_deg_s_g, {.min = 0.0, .max = 10.0});
    v("gyro_temperature_bias_deg_s_k", gyro_temperature_bias_deg_s_k, {.min = 0.0, .max = 1.0});
    v("gyro_temperature_scale_1_k", gyro_temperature_scale_1_k, {.min = 0.0, .max = 0.01});
    v("gyro_range_deg_s", gyro_range_deg_s, {.min = 1.0, .max = 1e5});
    v("gyro_resolution_deg_s", gyro_resolution_deg_s, {.min = 0.0, .max = 10.0});
  }

  template <typename Visitor>
  void VisitAccel(Visitor& v) {
    v("accel_noise_mg_sqrt_hz", accel_noise_mg_sqrt_hz, {.min = 0.0, .max = 100.0});
    v("accel_bias_mg", accel_bias_mg, {.min = -200.0, .max = 200.0});
    v("accel_bias_sigma_mg", accel_bias_sigma_mg, {.min = 0.0, .max = 200.0});
    v("accel_bias_instability_mg", accel_bias_instability_mg, {.min = 0.0, .max = 10.0});
    v("accel_bias_walk_mg_sqrt_s", accel_bias_walk_mg_sqrt_s, {.min = 0.0, .max = 10.0});
    v("accel_scale_sigma", accel_scale_sigma, {.min = 0.0, .max = 0.1});
    v("accel_temperature_bias_mg_k", accel_temperature_bias_mg_k, {.min = 0.0, .max = 10.0});
    v("accel_temperature_scale_1_k", accel_temperature_scale_1_k, {.min = 0.0, .max = 0.01});
    v("accel_range_g", accel_range_g, {.min = 1.0, .max = 1e4});
    v("accel_resolution_mg", accel_resolution_mg, {.min = 0.0, .max = 100.0});
  }
};

}  // namespace polnav::sim
