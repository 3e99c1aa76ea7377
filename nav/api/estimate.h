// What does an estimator answer, and what did it do with what it was given?
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "nav/api/geometry.h"
#include "nav/api/stage_times.h"
#include "nav/api/time.h"

namespace polnav::nav {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

// What a scenario grants at the start. Everything else an estimator finds out by itself.
struct StartPrior {
  Eigen::Vector3d p_WB_m = Eigen::Vector3d::Zero();
  double position_sigma_m = 0.01;
  double heading_rad = 0.0;
  double heading_sigma_rad = 0.0;
  double level_sigma_rad = 0.0;  // of the assumption that the vehicle starts level
  double standing_s = 0.0;       // it will not move for so long
};

// What an estimator believes of its IMU.
struct ImuBiases {
  Eigen::Vector3d gyro_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_m_s2 = Eigen::Vector3d::Zero();
  Matrix6d covariance = Matrix6d::Zero();  // of (gyro, accel)
};

struct Estimate {
  TimeNs stamp = 0;
  Pose T_WB;
  // Of (dp_W [m], dtheta_W [rad]): p_true = p + dp, q_true = Exp(dtheta) * q. Both in W.
  Matrix6d covariance = Matrix6d::Zero();
  bool tracked = false;             // false: coasting on the last motion, nothing seen
  std::optional<ImuBiases> biases;  // of those that estimate them
};

enum class Outcome {
  kUsed,
  kGated,     // inconsistent with the estimate
  kUnusable,  // no information: too dim, too few features, failed self-check
  kIgnored,   // this estimator has no use for it
};

// The heading that one reading of the sky gave, less the one expected, both at its stamp.
struct SkyResidual {
  TimeNs stamp = 0;
  double residual_rad = 0.0;
  double sigma_rad = 0.0;  // of the residual, as the gate believes
  bool gated = false;
};

// How far a reading was from what a filter expected.
struct Innovation {
  TimeNs stamp = 0;
  std::string_view sensor;  // "optical_flow", "range", "polarimeter", ...
  double nis = 0.0;         // squared, over its covariance
  int dof = 0;              // what nis is on average when the filter is consistent
  bool gated = false;
};

// What became of one measurement.
struct Report {
  Outcome outcome = Outcome::kIgnored;
  int features = 0;        // offered
  int inliers = 0;         // used
  int flow_rejected = 0;   // moved otherwise than the scene [Chu2021, eq. 12]
  int pose_rejected = 0;   // outliers of the pose
  int map_rejected = 0;    // landmarks that the bundle adjustment took out
  int imu_wrong = 0;       // 1 when the IMU contradicted what it and the pictures agreed on before
  int pictures_wrong = 0;  // 1 when the pictures did
  int gated_readings = 0;  // of polarization, kept until now, inconsistent after all
  int keyframes = 0;       // 1 when this measurement made one
  int returns = 0;         // 1 when a known place was recognized
  int failed_solves = 0;   // optimizations without a usable answer: the old one stays
  int window_keyframes = 0;  // in the map, when all is done
  int window_landmarks = 0;
  // Chi square of the pose's inliers over its degrees of freedom: 1 when their sigmas are honest
  // and the map is exact.
  std::optional<double> vision_nis;
  std::vector<SkyResidual> sky;         // readings that the frame's attitude made usable
  std::vector<Innovation> innovations;  // of a filter's updates
  StageTimes stage_s{};
  std::optional<Estimate> estimate;  // present when the measurement produced one
};

}  // namespace polnav::nav
