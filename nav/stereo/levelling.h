// Which way is up, before the vehicle moves?
//
// While it stands, the accelerometer reads nothing but the support against gravity. Its bias is
// what remains: 3 mg is 0.17 degrees.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "nav/api/measurements.h"

namespace polnav::nav {

class Levelling {
 public:
  explicit Levelling(double time_s) : time_s_(time_s) {}

  // Returns "up" in B once, when the vehicle has stood for long enough; nothing before, after, and
  // when it moves first.
  [[nodiscard]] std::optional<Eigen::Vector3d> Add(const ImuSample& sample);

 private:
  double time_s_;
  std::optional<TimeNs> begin_;
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  bool finished_ = false;
};

}  // namespace polnav::nav
