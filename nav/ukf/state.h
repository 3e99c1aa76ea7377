// What does the filter of a walking robot know, and in which coordinates does it err?
//
//   I     the IMU's axes and origin; the nominal state is a point on the manifold
//   error (37): truth = nominal moved by it, all in W unless said otherwise
//     theta    q_true = Exp(theta) q                  [rad]
//     u        v_true = Exp(theta) (v + u)            [m/s]
//     p        p_true = p + dp                        [m]
//     gyro_bias, accel_bias, and the slow ones below: sums
// The velocity's error turns with the attitude's [Hartley2020]: the velocity seen from the body,
// which optical flow measures, then does not depend on theta, and a heading that nothing has
// observed is never thought to be.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "nav/api/time.h"

namespace polnav::nav::ukf {

enum Index : Eigen::Index {
  kTheta = 0,
  kVelocity = 3,
  kPosition = 6,
  kGyroBias = 9,
  kAccelBias = 12,
  // Slow ones.
  kTerrain = 15,  // height of the ground below the sensor, in W [m]
  // What an upward turn of 1 rad/s adds to each gyroscope's reading, as axes lean and scales err.
  kGyroTurn = 16,
  // What the flow sees of the robot's own turn beyond what the gyroscopes make of it: by rows, per
  // flow that turns about F's x and y make.
  kFlowTurn = 19,
  kSkySlow = 23,     // sky's slow error, in sigmas
  kSkyForeign = 24,  // error that light from elsewhere makes, in sigmas
  // Considered: they widen every covariance they touch, and no measurement moves them.
  kFlowScale = 25,  // of the velocity that flow and range make together, relative
  kFlowYaw = 26,    // its turn about the optical axis [rad]
  kSkyOffset = 27,  // of a reading of the sky [rad]
  // By rows, what the accelerometers make of a force beside gravity: scales and leaning axes, whose
  // errors come again with every step.
  kAccelSwing = 28,
  kSize = 37
};
inline constexpr Eigen::Index kNavigation = 15;  // the first: position, motion and biases
inline constexpr Eigen::Index kSlow = kSize - kNavigation;
inline constexpr Eigen::Index kEstimated = 25;  // what measurements move

using Error = Eigen::Matrix<double, kSize, 1>;
using Covariance = Eigen::Matrix<double, kSize, kSize>;

struct State {
  TimeNs stamp = 0;
  Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v_WI = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_WI = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();   // in I [rad/s]
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();  // in I [m/s^2]
  Eigen::Matrix<double, kSlow, 1> slow = Eigen::Matrix<double, kSlow, 1>::Zero();
  // Sums since the start that no correction touches: means over an interval are their differences.
  Eigen::Vector3d turned_rad = Eigen::Vector3d::Zero();  // what the gyroscopes read
  Eigen::Vector3d gained_m_s = Eigen::Vector3d::Zero();  // velocity, in W
  Eigen::Vector3d gained_m = Eigen::Vector3d::Zero();    // integral of that over time
  Covariance P = Covariance::Zero();

  [[nodiscard]] double Slow(Eigen::Index i) const { return slow(i - kNavigation); }
  [[nodiscard]] Eigen::Vector3d GyroTurn() const {
    return slow.segment<3>(kGyroTurn - kNavigation);
  }
};

// Rotations of sigma points are small: a series to the ninth power below a quarter of a radian.
[[nodiscard]] inline Eigen::Quaterniond Exp(const Eigen::Vector3d& theta) {
  const double a2 = 0.25 * theta.squaredNorm();  // of the half angle
  double s = 0.0;
  double c = 0.0;
  if (a2 < 0.015625) {
    s = 1.0 - a2 / 6.0 * (1.0 - a2 / 20.0 * (1.0 - a2 / 42.0 * (1.0 - a2 / 72.0)));
    c = 1.0 - a2 / 2.0 * (1.0 - a2 / 12.0 * (1.0 - a2 / 30.0 * (1.0 - a2 / 56.0)));
  } else {
    const double a = std::sqrt(a2);
    s = std::sin(a) / a;
    c = std::cos(a);
  }
  const Eigen::Vector3d v = 0.5 * s * theta;
  return {c, v.x(), v.y(), v.z()};
}

// Inverse of Exp, the shorter way round.
[[nodiscard]] inline Eigen::Vector3d Log(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const double w = sign * q.w();
  const double s2 = q.vec().squaredNorm();
  if (s2 < 0.0025) {  // asin's series
    const double ratio =
        1.0 + s2 * (1.0 / 6.0 + s2 * (3.0 / 40.0 + s2 * (15.0 / 336.0 + s2 * 105.0 / 3456.0)));
    return 2.0 * sign * ratio * q.vec();
  }
  const double s = std::sqrt(s2);
  return 2.0 * sign * std::atan2(s, w) / s * q.vec();
}

// Moves the nominal state by an error, and the covariance into the coordinates of the new one.
void Move(const Error& by, State& state);

// Finite, and no variance below zero by more than rounding.
[[nodiscard]] bool IsSound(const Covariance& P);

// The nearest symmetric matrix without a negative eigenvalue, in units in which all are about
// alike. False when there are numbers in it that are none.
[[nodiscard]] bool Repair(Covariance& P);

}  // namespace polnav::nav::ukf
