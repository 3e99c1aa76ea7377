// How far does an estimator trust the polarized sky? YAML keys = field names.
#pragma once

namespace polnav::nav {

struct PolarizationOptions {
  double reading_sigma_deg = 1.0;      // white part of one reading's heading error
  double correlated_sigma_deg = 0.35;  // slow part: sky, tilt left over, instrument
  double correlation_time_s = 15.0;    // of the slow part; averaging within it gains nothing
  double min_dop = 0.10;               // below, a reading is unusable
  double max_pair_sum = 0.12;          // |p1 + p2 + p3|: zero for a healthy sensor
  double gate_sigmas = 4.0;            // innovations beyond are left out

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("reading_sigma_deg", reading_sigma_deg, {.min = 0.01, .max = 45.0});
    v("correlated_sigma_deg", correlated_sigma_deg, {.min = 0.0, .max = 45.0});
    v("correlation_time_s", correlation_time_s, {.min = 0.0, .max = 3600.0});
    v("min_dop", min_dop, {.min = 0.0, .max = 1.0});
    v("max_pair_sum", max_pair_sum, {.min = 0.0, .max = 3.0});
    v("gate_sigmas", gate_sigmas, {.min = 1.0, .max = 100.0});
  }
};

}  // namespace polnav::nav
