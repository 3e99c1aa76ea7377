// What would the GNSS/INS reference on the car say?
//
// The truth is in the simulator; this is what a test drive would have for it. Errors of each axis:
// a first-order Gauss-Markov process (a filter's error wanders, it does not flicker) plus small
// white noise. Without satellites it goes on by inertia alone, from the errors it has at that
// moment, s seconds long:
//   attitude   + w s                      w: gyroscopes' residual bias
//   velocity   + a s + j s^2 / 2          a: accelerometers' residual bias, and horizontally
//   gravity position   + v s + a s^2 / 2 + j s^3 / 6    through the tilt error; j: gravity through
//   w
// and when they are back the surplus decays. Not in it: multipath, delay; attitude, velocity and
// position errors are independent of each other, which those of a real filter are not.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "nav/api/measurements.h"
#include "sim/random.h"
#include "sim/truth.h"

namespace polnav::sim {

// YAML keys = field names.
struct ReferenceOutage {
  double start_s = 0.0;
  double duration_s = 10.0;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("start_s", start_s, {.min = 0.0, .max = 86400.0});
    v("duration_s", duration_s, {.min = 1e-3, .max = 86400.0});
  }
};

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
  std::vector<ReferenceOutage> outages;
  double outage_gyro_bias_deg_h = 1.0;  // what the filter has left of it, one sigma of each axis
  double outage_accel_bias_mg = 0.1;
  double recovery_time_s = 2.0;  // the surplus falls to 1/e of itself

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
    v("outages", outages);
    v("outage_gyro_bias_deg_h", outage_gyro_bias_deg_h, {.min = 0.0, .max = 1e4});
    v("outage_accel_bias_mg", outage_accel_bias_mg, {.min = 0.0, .max = 100.0});
    v("recovery_time_s", recovery_time_s, {.min = 1e-3, .max = 1e4});
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

  // Inertia alone, since when and from which errors.
  struct Coasting {
    std::size_t outage;
    Errors begin;
    Eigen::Vector3d turn_rad_s;
    Eigen::Vector3d acceleration_m_s2;
    Eigen::Vector3d jerk_m_s3;
  };

  [[nodiscard]] std::optional<std::size_t> OutageAt(double t_s) const;
  [[nodiscard]] Coasting BeginCoasting(std::size_t outage) const;
  [[nodiscard]] static Errors ErrorsAfter(const Coasting& coasting, double elapsed_s);
  void StepSurplus(double t_s);

  ReferenceOptions options_;
  RandomStream stream_;
  RandomStream outage_stream_;
  Errors sigma_;
  Errors wander_ = Errors::Zero();  // in units of sigma
  Errors surplus_ = Errors::Zero();
  std::optional<Coasting> coasting_;
  std::uint64_t next_index_ = 0;
};

}  // namespace polnav::sim
