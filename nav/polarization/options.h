// How far does an estimator trust the polarized sky? YAML keys = field names.
#pragma once

namespace polnav::nav {

struct PolarizationOptions {
  double reading_sigma_deg = 1.0;  // white part of one reading's heading error, at half polarized
  double correlated_sigma_deg = 0.3;  // slow part: sky, tilt left over
  double correlation_time_s = 15.0;   // of the slow part; averaging within it gains nothing
  // Fixed and estimated on the way: how the instrument is turned in its mounting, and what it gets
  // wrong by the light's direction, each of four numbers (unequal channels, crooked polarizers).
  double mount_sigma_deg = 0.15;
  double harmonic_sigma_deg = 0.07;
  double min_dop = 0.10;       // below, a reading is unusable
  double max_pair_sum = 0.12;  // |p1 + p2 + p3|: zero for a healthy sensor
  // What light from elsewhere (cloud, leaves) fakes besides, where it is as much as the sky's own.
  double foreign_sigma_deg = 2.0;
  double clear_dop = 0.70;   // of a clear sky, 90 degrees from the sun; the least expected is 0.8
                             // of what that gives where the sensor looks
  double gate_sigmas = 4.0;  // readings beyond are left out
  double edge_gate_sigmas = 3.0;  // and means over the readings between two keyframes
  bool full_attitude = true;      // a tilt counts too; false: the heading alone [Chu2021, eq. 15]

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("reading_sigma_deg", reading_sigma_deg, {.min = 0.01, .max = 45.0});
    v("correlated_sigma_deg", correlated_sigma_deg, {.min = 0.0, .max = 45.0});
    v("correlation_time_s", correlation_time_s, {.min = 0.0, .max = 3600.0});
    v("mount_sigma_deg", mount_sigma_deg, {.min = 0.0, .max = 45.0});
    v("harmonic_sigma_deg", harmonic_sigma_deg, {.min = 0.0, .max = 45.0});
    v("min_dop", min_dop, {.min = 0.0, .max = 1.0});
    v("max_pair_sum", max_pair_sum, {.min = 0.0, .max = 3.0});
    v("foreign_sigma_deg", foreign_sigma_deg, {.min = 0.0, .max = 45.0});
    v("clear_dop", clear_dop, {.min = 0.05, .max = 1.0});
    v("gate_sigmas", gate_sigmas, {.min = 1.0, .max = 100.0});
    v("edge_gate_sigmas", edge_gate_sigmas, {.min = 1.0, .max = 100.0});
    v("full_attitude", full_attitude);
  }
};

}  // namespace polnav::nav
