// What do the readings of an IMU that stands still say of its biases and of level?
//
// Means over that time. The gyroscopes read their bias (and the Earth's turn, 0.004 deg/s); the
// force points up, and what it has beyond gravity is the accelerometers' error along it. Level then
// errs by their bias across: 40 mg are 2.3 degrees, which no robot that stands can tell.
// Fails where it did not stand: readings that scatter as those of a moving robot say nothing.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

namespace polnav::nav::ukf {

// In B.
struct StandingErrors {
  Eigen::Vector3d gyro_bias_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_LB = Eigen::Quaterniond::Identity();  // L: level, B's heading
};

class Standing {
 public:
  void Add(const Eigen::Vector3d& gyro_B_rad_s, const Eigen::Vector3d& force_B_m_s2);

  // Nothing when there is too little, or it did not stand.
  [[nodiscard]] std::optional<StandingErrors> Errors() const;

 private:
  int count_ = 0;
  Eigen::Vector3d gyro_ = Eigen::Vector3d::Zero();  // sums
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
  double gyro_squares_ = 0.0;
};

}  // namespace polnav::nav::ukf
