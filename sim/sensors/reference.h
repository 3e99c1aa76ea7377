// What would the GNSS/INS reference on the car say?
//
// The truth is in the simulator; this is what a test drive would have for it. Errors of each axis:
// a first-order Gauss-Markov process (a filter's error wanders, it does not flicker) plus small
// white noise. Not in it: lost satellites, lever arms, delay; attitude, velocity and position
// errors are independent of each other, which those of a real filter are not.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "nav/api/measurements.h"
#include "sim/random.h"
#include "sim/truth.h"

namespace polnav::sim {

// Defaults: NovAtel SPAN-CPT with RTK [Chu2021, section 3]: pitch and roll 0.015, yaw 0.05 degrees.
// Sigmas are of the wandering part. YAML keys = field names.
struct ReferenceOptions {
  double rate_hz = 100.0;
  double tilt_sigma_deg = 0.015;  // pitch and roll
  double yaw_sigma_deg = 0.05;
  double horizontal_sigma_m = 0.02;
  double vertical_sigma_m = 0.03;
  double velocity_sigma_m_s = 0.02;
  double correlation_time_s = 60.0;
  double white_share = 0.05;  // white noise over the sigma above

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("rate_hz", rate_hz, {.min = 0.1, .max = 1000.0});
    v("tilt_sigma_deg", tilt_sigma_deg, {.min = 0.0, .max = 10.0});
    v("yaw_sigma_deg", yaw_sigma_deg, {.min = 0.0, .max = 10.0});
    v("horizontal_sigma_m", horizontal_sigma_m, {.min = 0.0, .max = 100.0});
    v("vertical_sigma_m", vertical_sigma_m, {.min = 0.0, .max = 100.0});
    v("velocity_sigma_m_s", velocity_sigma_m_s, {.min = 0.0, .max = 10.0});
    v("correlation_time_s", correlation_time_s, {.min = 1e-3, .max = 1e6});
    v("white_share", white_share, {.min = 0.0, .max = 10.0});
  }
};

class Reference {
 public:
  Reference(const ReferenceOptions& options, std::uint64_t seed, std::uint64_t trial);

  // index counts from 0 and must grow from call to call; sample k is the same whichever others
  // were taken.
  [[nodiscard]] nav::ReferencePose Sample(const Truth& truth, std::uint64_t index);

 private:
  // Roll, pitch (about B), yaw (about W's z) [rad]; position, velocity in W [m, m/s].
  using Errors = Eigen::Matrix<double, 9, 1>;

  ReferenceOptions options_;
  RandomStream stream_;
  Errors sigma_;
  Errors wander_ = Errors::Zero();  // in units of sigma
  std::uint64_t next_index_ = 0;
};

}  // namespace polnav::sim
