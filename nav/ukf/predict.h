// Where does the IMU say that the robot goes, and how sure is that?
//
// Readings are means over the interval, the force seen from the attitude half way (docs/imu.md):
//   w = gyro - gyro_bias - gyro_z turn,  q' = q Exp(w h)
//   v' = v + h (q Exp(w h / 2) (accel - accel_bias - accel_swing s) + g),  p' = p + h (v + v') / 2
// s: the force beside gravity of a level robot, whose share is in the biases.
// Curved along the attitude's error and that of the rate; linear, and so exact without sigma
// points, along all others (sigma_points.h).
#pragma once

#include "nav/api/calibration.h"
#include "nav/ukf/options.h"
#include "nav/ukf/state.h"

namespace polnav::nav::ukf {

// Densities: variances a second.
struct ProcessNoise {
  double gyro_rad2_s = 0.0;
  double accel_m2_s3 = 0.0;
  double gyro_bias_rad2_s3 = 0.0;
  double accel_bias_m2_s5 = 0.0;
  double terrain_m2_m = 0.0;  // a metre of the way
  double sky_time_s = 1.0;    // correlation of the sky's slow errors
};

// Flicker of the biases counts as a random walk that reaches it in half a minute.
[[nodiscard]] ProcessNoise NoiseOf(const ImuCalibration& imu, const UkfOptions& options,
                                   double sky_time_s);

// One interval of h_s seconds that ends at `stamp`. gyro, accel: as read, in I.
void Predict(const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& accel_m_s2, double h_s,
             TimeNs stamp, const ProcessNoise& noise, State& state);

}  // namespace polnav::nav::ukf
