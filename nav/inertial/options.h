// How far does an estimator trust its IMU beyond the data sheet? YAML keys = field names.
#pragma once

namespace polnav::nav {

// Of W's z axis, downwards. Local gravity departs by up to 0.03 m/s^2: accelerometer bias takes it.
inline constexpr double kGravity_m_s2 = 9.80665;

struct InertialOptions {
  // Errors in proportion to what is measured: scale factors, and axes that are not square to each
  // other. A calibrated industrial MEMS has about these; larger trusts the IMU less in turns.
  double scale_sigma = 0.003;
  double misalignment_sigma_deg = 0.1;
  double start_speed_sigma_m_s = 10.0;  // of the assumption that the vehicle starts at rest
  double keyframe_interval_s = 1.0;     // with an IMU, a keyframe at least so often

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("scale_sigma", scale_sigma, {.min = 0.0, .max = 0.2});
    v("misalignment_sigma_deg", misalignment_sigma_deg, {.min = 0.0, .max = 10.0});
    v("start_speed_sigma_m_s", start_speed_sigma_m_s, {.min = 0.01, .max = 300.0});
    v("keyframe_interval_s", keyframe_interval_s, {.min = 0.1, .max = 30.0});
  }
};

}  // namespace polnav::nav
