// How far do the two Kalman filters of a walking robot trust what? YAML keys = field names.
//
// docs/hexapod_estimators.md has the reasons. Sigmas of kinds that no data sheet states; what one
// states is in nav/api/calibration.h.
#pragma once

#include <Eigen/Core>

namespace polnav::nav {

// nav/ukf/ukf.h
struct UkfOptions {
  double output_rate_hz = 10.0;        // estimates a second
  double start_speed_sigma_m_s = 0.3;  // of the assumption that it starts at rest
  // Errors of a consumer MEMS in proportion to what is measured; larger trusts the IMU less.
  double gyro_scale_sigma = 0.01;
  double accel_scale_sigma = 0.01;
  double misalignment_sigma_deg = 0.5;
  double gyro_g_sensitivity_deg_s_g = 0.1;  // what gravity fakes on each axis, as a bias
  // The ground under the robot: how its height wanders along the way, and how rough it is where
  // two readings side by side look at it. Larger holds the height less tightly.
  double terrain_sigma_m_sqrt_m = 0.02;
  double roughness_sigma_m = 0.0005;
  double slope_sigma = 0.05;          // seen beside the nadir as the body tilts [-]
  double range_scale_sigma = 0.013;   // speed of sound and offset, as a share of the range
  double min_quality = 0.2;           // of a reading of the optical flow; below it is left out
  double sky_offset_sigma_deg = 0.2;  // what does not average away: mounting, gains, haze
  double gate_sigmas = 4.0;           // readings beyond are left out ...
  double doubt_after_s = 1.5;  // ... unless they agree with each other for so long: then the filter
                               // doubts itself
  double max_delay_s = 0.3;    // a measurement that comes later than this is left out

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("output_rate_hz", output_rate_hz, {.min = 0.1, .max = 500.0});
    v("start_speed_sigma_m_s", start_speed_sigma_m_s, {.min = 0.001, .max = 10.0});
    v("gyro_scale_sigma", gyro_scale_sigma, {.min = 0.0, .max = 0.2});
    v("accel_scale_sigma", accel_scale_sigma, {.min = 0.0, .max = 0.2});
    v("misalignment_sigma_deg", misalignment_sigma_deg, {.min = 0.0, .max = 10.0});
    v("gyro_g_sensitivity_deg_s_g", gyro_g_sensitivity_deg_s_g, {.min = 0.0, .max = 10.0});
    v("terrain_sigma_m_sqrt_m", terrain_sigma_m_sqrt_m, {.min = 0.0, .max = 1.0});
    v("roughness_sigma_m", roughness_sigma_m, {.min = 0.0, .max = 1.0});
    v("slope_sigma", slope_sigma, {.min = 0.0, .max = 1.0});
    v("range_scale_sigma", range_scale_sigma, {.min = 0.0, .max = 0.3});
    v("min_quality", min_quality, {.min = 0.0, .max = 1.0});
    v("sky_offset_sigma_deg", sky_offset_sigma_deg, {.min = 0.0, .max = 45.0});
    v("gate_sigmas", gate_sigmas, {.min = 1.0, .max = 100.0});
    v("doubt_after_s", doubt_after_s, {.min = 0.1, .max = 60.0});
    v("max_delay_s", max_delay_s, {.min = 0.02, .max = 2.0});
  }
};

// nav/ukf/paper_ukf.h. The first three are the paper's Q, the fourth its R of the heading.
struct PaperUkfOptions {
  double output_rate_hz = 10.0;
  bool noise_per_step = false;  // Q is of a step of the IMU; false: of a second
  double position_sigma_m = 0.1;
  double velocity_sigma_m_s = 0.06;
  double quaternion_sigma = 0.03;
  double heading_sigma_rad = 0.06;  // of a reading of the sky
  // Of a reading of the flow along B's axes; the paper prints none. Upwards it is a difference of
  // two ranges.
  double flow_sigma_m_s = 0.01;
  double climb_sigma_m_s = 0.3;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("output_rate_hz", output_rate_hz, {.min = 0.1, .max = 500.0});
    v("noise_per_step", noise_per_step);
    v("position_sigma_m", position_sigma_m, {.min = 1e-6, .max = 10.0});
    v("velocity_sigma_m_s", velocity_sigma_m_s, {.min = 1e-6, .max = 10.0});
    v("quaternion_sigma", quaternion_sigma, {.min = 1e-6, .max = 1.0});
    v("heading_sigma_rad", heading_sigma_rad, {.min = 1e-4, .max = 3.0});
    v("flow_sigma_m_s", flow_sigma_m_s, {.min = 1e-4, .max = 10.0});
    v("climb_sigma_m_s", climb_sigma_m_s, {.min = 1e-4, .max = 10.0});
  }
};

}  // namespace polnav::nav
