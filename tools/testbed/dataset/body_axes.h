// Which way is forward on somebody else's vehicle?
//
// B of a EuRoC dataset is its IMU, however it is mounted. Polnav's body P looks forward along x,
// its z is up. P is B with its axes renamed (turned by right angles) so that cam0 looks forward as
// nearly as can be; the origin stays. Without cam0, P is B.
#pragma once

#include <Eigen/Geometry>

#include "nav/api/calibration.h"
#include "nav/api/measurements.h"
#include "sim/truth.h"

namespace polnav::testbed {

// q_BP for a camera mounted as q_BC.
[[nodiscard]] Eigen::Quaterniond RenamedAxes(const Eigen::Quaterniond& q_BC);

class BodyAxes {
 public:
  BodyAxes() = default;  // everything stays as it is, to the last bit
  // T_BS: of the body whose poses the truth gives.
  BodyAxes(const nav::Rig& rig, const nav::Pose& T_BS);

  [[nodiscard]] sim::Truth Of(sim::Truth truth) const;
  [[nodiscard]] nav::ReferencePose Of(nav::ReferencePose pose) const;
  void Apply(nav::Rig& rig) const;

 private:
  nav::Pose T_BP_;
  nav::Pose T_SP_;
  bool renamed_ = false;
};

}  // namespace polnav::testbed
