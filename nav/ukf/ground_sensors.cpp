#include "nav/ukf/ground_sensors.h"

#include <algorithm>
#include <cmath>

#include "nav/inertial/options.h"

namespace polnav::nav::ukf {
namespace {

constexpr double kNearest_m = 0.02;   // a sigma point may fall through the ground
constexpr double kFlattest = 0.1;     // sine of the optical axis below the horizon
constexpr double kKnownHeight = 0.3;  // one sigma, as a share of the height

double Square(double x) { return x * x; }

// Sine of the optical axis below the horizon.
double Down(const Eigen::Quaterniond& q_WF) {
  return std::max(-(q_WF * Eigen::Vector3d::UnitZ()).z(), kFlattest);
}

// Velocity of F relative to the ground and its rate, both in F, of the nominal state.
struct Motion {
  Eigen::Vector3d v_F;
  Eigen::Vector3d rate_F;
  Eigen::Matrix3d R_FI;
};

Motion MotionOf(const State& state, const GroundSensor& sensor, const FlowInterval& interval,
                const Error& e) {
  Motion m{.R_FI = sensor.T_IF.q.conjugate().toRotationMatrix()};
  Eigen::Vector3d rate = interval.rate_rad_s - state.gyro_bias - e.segment<3>(kGyroBias);
  rate.z() -= (state.Slow(kGyroScale) + e(kGyroScale)) * interval.rate_rad_s.z();
  const Eigen::Vector3d v_I =
      state.q_WI.conjugate() * (state.v_WI + e.segment<3>(kVelocity) - interval.gained_m_s);
  // The velocity gained was reckoned with a bias and a level that err: half of the interval's.
  const Eigen::Vector3d missed_I =
      0.5 * interval.duration_s *
      (e.segment<3>(kAccelBias) +
       state.q_WI.conjugate() *
           e.segment<3>(kTheta).cross(Eigen::Vector3d(0.0, 0.0, -kGravity_m_s2)));
  m.v_F = m.R_FI * (v_I + missed_I + rate.cross(sensor.T_IF.p));
  m.rate_F = m.R_FI * rate;
  return m;
}

Eigen::Vector2d Flow(const Motion& m, double range) {
  return {m.rate_F.x() - m.v_F.y() / range, m.rate_F.y() + m.v_F.x() / range};
}

}  // namespace

double RangeOf(const State& state, const GroundSensor& sensor, const Error& error) {
  const Eigen::Quaterniond q_WI = Exp(error.segment<3>(kTheta)) * state.q_WI;
  const double height = state.p_WI.z() + error(kPosition + 2) + (q_WI * sensor.T_IF.p).z() -
                        state.Slow(kTerrain) - error(kTerrain);
  return height / Down(q_WI * sensor.T_IF.q);
}

Eigen::Vector2d FlowOf(const State& state, const GroundSensor& sensor, const FlowInterval& interval,
                       const Error& error) {
  const double range = std::max(RangeOf(state, sensor, error), kNearest_m);
  const Eigen::Vector2d flow = Flow(MotionOf(state, sensor, interval, error), range);
  const double scale = 1.0 + state.Slow(kFlowScale) + error(kFlowScale);
  const double yaw = state.Slow(kFlowYaw) + error(kFlowYaw);
  return scale * (Eigen::Rotation2Dd(-yaw) * flow);
}

Expected<1> ExpectRange(const State& state, const GroundSensor& sensor) {
  Covariance left = state.P;
  Columns<2> columns;
  for (int k = 0; k < 2; ++k) TakeColumn(kTheta + k, left, columns.col(k));
  Eigen::Matrix<double, 1, kSize> H = Eigen::Matrix<double, 1, kSize>::Zero();
  H(kPosition + 2) = 1.0 / Down(state.q_WI * sensor.T_IF.q);
  H(kTerrain) = -H(kPosition + 2);
  const auto h = [&](const Error& e) {
    return Eigen::Matrix<double, 1, 1>(RangeOf(state, sensor, e));
  };
  return Expect<1, 2>(h, H, columns, left);
}

Expected<2> ExpectFlow(const State& state, const GroundSensor& sensor,
                       const FlowInterval& interval) {
  Covariance left = state.P;
  Columns<3> columns;
  for (int k = 0; k < 2; ++k) TakeColumn(kTheta + k, left, columns.col(k));
  TakeColumn(kPosition + 2, kTerrain, -1.0, left, columns.col(2));

  const Motion m = MotionOf(state, sensor, interval, Error::Zero());
  const double range = std::max(RangeOf(state, sensor, Error::Zero()), kNearest_m);
  const Eigen::Vector2d flow = Flow(m, range);
  Eigen::Matrix<double, 2, 3> by_v_F;
  by_v_F << 0.0, -1.0 / range, 0.0, 1.0 / range, 0.0, 0.0;
  const Eigen::Matrix<double, 2, 3> by_v_I = by_v_F * m.R_FI;
  Eigen::Matrix3d lever;  // rate x p by the rate
  const Eigen::Vector3d& p = sensor.T_IF.p;
  lever << 0.0, p.z(), -p.y(), -p.z(), 0.0, p.x(), p.y(), -p.x(), 0.0;
  const Eigen::Matrix<double, 2, 3> by_rate = m.R_FI.topRows<2>() + by_v_I * lever;

  Eigen::Matrix<double, 2, kSize> H = Eigen::Matrix<double, 2, kSize>::Zero();
  H.middleCols<3>(kVelocity) = by_v_I * state.q_WI.conjugate().toRotationMatrix();
  H.middleCols<3>(kGyroBias) = -by_rate;
  H.middleCols<3>(kAccelBias) = 0.5 * interval.duration_s * by_v_I;
  H.col(kGyroScale) = -by_rate.col(2) * interval.rate_rad_s.z();
  H.col(kFlowScale) = flow;
  H.col(kFlowYaw) = Eigen::Vector2d(flow.y(), -flow.x());
  const auto h = [&](const Error& e) { return FlowOf(state, sensor, interval, e); };
  return Expect<2, 3>(h, H, columns, left);
}

double RangeNoise(const State& state, const GroundSensor& sensor, const UkfOptions& options) {
  const double down = Down(state.q_WI * sensor.T_IF.q);
  const double range = RangeOf(state, sensor, Error::Zero());
  const double aside2 = Square(range) * std::max(0.0, 1.0 - Square(down));
  return Square(sensor.calibration.range_sigma_m) + Square(options.roughness_sigma_m) +
         aside2 * Square(options.slope_sigma);
}

// White noise of the flow; a ground that is not as far as the beam says; a rate that the flow
// camera and the gyroscopes see differently, as their axes and scales are.
double FlowNoise(const State& state, const GroundSensor& sensor, const FlowInterval& interval,
                 double integration_s, const UkfOptions& options) {
  const Motion m = MotionOf(state, sensor, interval, Error::Zero());
  const double range = std::max(RangeOf(state, sensor, Error::Zero()), kNearest_m);
  const double translation2 = m.v_F.head<2>().squaredNorm() / Square(range);
  const double share2 =
      Square(options.gyro_scale_sigma) + Square(sensor.calibration.mount_sigma_rad);
  return Square(sensor.calibration.flow_noise_rad_s_sqrt_hz) / integration_s +
         translation2 * Square(options.roughness_sigma_m / range) + m.rate_F.squaredNorm() * share2;
}

bool KnowsHeight(const State& state, const GroundSensor& sensor) {
  const double variance = state.P(kTerrain, kTerrain) + state.P(kPosition + 2, kPosition + 2) -
                          2.0 * state.P(kTerrain, kPosition + 2);
  const double range = RangeOf(state, sensor, Error::Zero());
  return range > kNearest_m && variance < Square(kKnownHeight * range);
}

}  // namespace polnav::nav::ukf
