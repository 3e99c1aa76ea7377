#include "nav/ukf/start.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "nav/inertial/options.h"
#include "nav/stereo/reprojection.h"

namespace polnav::nav::ukf {
namespace {

constexpr double kUnknownGround_m = 100.0;

double Square(double x) { return x * x; }

void Check(const char* name, double sigma) {
  if (sigma >= 0.0 && std::isfinite(sigma)) return;
  throw std::invalid_argument(std::string("Ukf: ") + name + " is " + std::to_string(sigma) +
                              ", expected a number not below 0");
}

}  // namespace

void CheckSigmas(const ImuCalibration& imu, const OpticalFlowCalibration& flow,
                 const StartPrior& start) {
  Check("gyro_noise_rad_s_sqrt_hz", imu.gyro_noise_rad_s_sqrt_hz);
  Check("accel_noise_m_s2_sqrt_hz", imu.accel_noise_m_s2_sqrt_hz);
  Check("gyro_bias_sigma_rad_s", imu.gyro_bias_sigma_rad_s);
  Check("accel_bias_sigma_m_s2", imu.accel_bias_sigma_m_s2);
  Check("gyro_bias_instability_rad_s", imu.gyro_bias_instability_rad_s);
  Check("accel_bias_instability_m_s2", imu.accel_bias_instability_m_s2);
  Check("gyro_bias_walk_rad_s_sqrt_s", imu.gyro_bias_walk_rad_s_sqrt_s);
  Check("accel_bias_walk_m_s2_sqrt_s", imu.accel_bias_walk_m_s2_sqrt_s);
  Check("flow_noise_rad_s_sqrt_hz", flow.flow_noise_rad_s_sqrt_hz);
  Check("flow_scale_sigma", flow.flow_scale_sigma);
  Check("mount_sigma_rad", flow.mount_sigma_rad);
  Check("range_sigma_m", flow.range_sigma_m);
  Check("position_sigma_m", start.position_sigma_m);
  Check("heading_sigma_rad", start.heading_sigma_rad);
  Check("level_sigma_rad", start.level_sigma_rad);
  if (!(imu.rate_hz > 0.0)) throw std::invalid_argument("Ukf: the IMU's rate_hz is not above 0");
}

Eigen::Vector3d FakedGyroBias(const UkfOptions& options) {
  return Eigen::Vector3d::Constant(DegToRad(options.gyro_g_sensitivity_deg_s_g));
}

Eigen::Vector3d FakedAccelBias(const UkfOptions& options) {
  const double aside = kGravity_m_s2 * DegToRad(options.misalignment_sigma_deg);
  return {aside, aside, kGravity_m_s2 * options.accel_scale_sigma};
}

State StartState(const UkfOptions& options, const ImuCalibration& imu,
                 const OpticalFlowCalibration& flow, const StartPrior& start, TimeNs stamp) {
  const Eigen::Quaterniond q_WB = LevelAttitude(start.heading_rad);
  State s{.stamp = stamp};
  s.q_WI = q_WB * imu.T_BI.q;
  const Eigen::Vector3d lever_W = q_WB * imu.T_BI.p;
  s.p_WI = start.p_WB_m + lever_W;

  Error variance = Error::Zero();
  variance.segment<2>(kTheta).setConstant(Square(start.level_sigma_rad));
  variance(kTheta + 2) = Square(start.heading_sigma_rad);
  variance.segment<3>(kVelocity).setConstant(Square(options.start_speed_sigma_m_s));
  variance.segment<3>(kPosition).setConstant(Square(start.position_sigma_m));
  variance.segment<3>(kGyroBias) =
      FakedGyroBias(options).cwiseAbs2().array() + Square(imu.gyro_bias_sigma_rad_s);
  variance.segment<3>(kAccelBias) =
      FakedAccelBias(options).cwiseAbs2().array() + Square(imu.accel_bias_sigma_m_s2);
  variance(kTerrain) = Square(kUnknownGround_m);
  const double crooked = DegToRad(options.misalignment_sigma_deg);
  variance.segment<2>(kGyroTurn).setConstant(Square(crooked));
  variance(kGyroTurn + 2) = Square(options.gyro_scale_sigma);
  const double along = Square(options.gyro_scale_sigma) + Square(flow.flow_scale_sigma) +
                       Square(options.range_scale_sigma);
  const double across = Square(crooked) + Square(flow.mount_sigma_rad);
  variance.segment<4>(kFlowTurn) << along, across, across, along;
  variance(kSkySlow) = variance(kSkyForeign) = 1.0;
  variance(kFlowScale) = Square(flow.flow_scale_sigma) + Square(options.range_scale_sigma);
  variance(kFlowYaw) = across;
  variance.segment<9>(kAccelSwing).setConstant(Square(crooked));
  for (const Eigen::Index axis : {0, 4, 8}) {
    variance(kAccelSwing + axis) = Square(options.accel_scale_sigma);
  }
  variance(kSkyOffset) = Square(DegToRad(options.sky_offset_sigma_deg));
  Covariance by = Covariance::Identity();  // IMU's position by the body's
  by.block<3, 3>(kPosition, kTheta) = -Skew(lever_W);
  s.P = by * variance.asDiagonal() * by.transpose();
  return s;
}

Estimate EstimateOf(const State& state, const UkfOptions& options, const Pose& T_BI) {
  const Pose T_IB = T_BI.Inverse();
  Estimate e{.stamp = state.stamp, .T_WB = Pose{state.q_WI, state.p_WI} * T_IB};
  Eigen::Matrix<double, 6, kNavigation> by = Eigen::Matrix<double, 6, kNavigation>::Zero();
  by.block<3, 3>(0, kPosition).setIdentity();
  by.block<3, 3>(0, kTheta) = -Skew(state.q_WI * T_IB.p);
  by.block<3, 3>(3, kTheta).setIdentity();
  e.covariance = by * state.P.topLeftCorner<kNavigation, kNavigation>() * by.transpose();
  ImuBiases biases{.gyro_rad_s = state.gyro_bias, .accel_m_s2 = state.accel_bias};
  biases.covariance = state.P.block<6, 6>(kGyroBias, kGyroBias);
  biases.covariance.diagonal().head<3>() += FakedGyroBias(options).cwiseAbs2();
  biases.covariance.diagonal().tail<3>() += FakedAccelBias(options).cwiseAbs2();
  e.biases = biases;
  return e;
}

}  // namespace polnav::nav::ukf
